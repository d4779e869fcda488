//! Numbers that physics is written in.
//!
//! Every formula of the crate is generic over [`Scalar`]: a plain `f64` gives the value, a [`Dual`] the derivatives,
//! a [`Jet`] the rates in time, [`Lanes`] a batch of samples, a [`Germ`] what
//! the formula is like just beside a point. There is no second copy of a formula to keep in step.
//!
//! A formula that has cases asks for a [`Mask`] and selects; it never looks at the number. So the same lines run where
//! a "number" is many samples at once, or a node of a program that is being recorded.

mod circle;
mod dual;
mod germ;
mod interval;
mod jet;
mod lanes;
mod power;

pub use dual::Dual;
pub use germ::{Germ, ORDERS};
pub use interval::Interval;
pub use jet::Jet;
pub use lanes::Lanes;
pub use power::Exponent;

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// The answer to a comparison: one truth value, one per lane, or a recorded condition.
pub trait Mask: Copy + Debug {
    /// True where both are.
    fn and(self, other: Self) -> Self;
    /// True where either is.
    fn or(self, other: Self) -> Self;
    /// True where this is not.
    fn not(self) -> Self;
    /// The answer, when it is the same everywhere and known now.
    fn known(self) -> Option<bool>;
}

impl Mask for bool {
    fn and(self, other: bool) -> bool {
        self && other
    }
    fn or(self, other: bool) -> bool {
        self || other
    }
    fn not(self) -> bool {
        !self
    }
    fn known(self) -> Option<bool> {
        Some(self)
    }
}

/// A table that a number can be looked up in: a curve through data with its derivatives.
///
/// `Scalar::lookup` asks for `order` 0 and, for derivatives, for the next higher orders.
pub trait Table: Debug + Send + Sync {
    /// The `order`-th derivative at `x`.
    fn at(&self, x: f64, order: u32) -> f64;
    /// Where pieces meet, increasing.
    fn knots(&self) -> &[f64] {
        &[]
    }
    /// The `order`-th derivative at `x` of the piece just above or below it.
    fn beside(&self, x: f64, above: bool, order: u32) -> f64 {
        let _ = above;
        self.at(x, order)
    }
}

/// A number: `f64`, or something that carries more than a value and obeys the same rules.
///
/// Comparisons look at the value part only. `sqrt`, `ln` and the like follow IEEE: outside their domain the value is NaN,
/// never a panic.
pub trait Scalar:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// What a comparison yields.
    type Mask: Mask;

    /// A number that depends on nothing.
    fn constant(x: f64) -> Self;
    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::constant(0.0)
    }
    /// One.
    #[inline(always)]
    fn one() -> Self {
        Self::constant(1.0)
    }
    /// The number, when it is a constant and known now. Physics may leave out what is a known zero.
    fn known(&self) -> Option<f64>;
    /// Whether the number is known to be zero, with all its derivatives.
    #[inline(always)]
    fn is_known_zero(&self) -> bool {
        self.known() == Some(0.0)
    }

    /// `self < other`
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`
    fn le(self, other: Self) -> Self::Mask;
    /// `self == other`
    fn same(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, `no` elsewhere. Both have been evaluated; the other one is dropped, NaN included.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// As [`Scalar::select`], evaluating only what is needed where the answer is the same everywhere.
    #[inline(always)]
    fn choose(mask: Self::Mask, yes: impl FnOnce() -> Self, no: impl FnOnce() -> Self) -> Self {
        match mask.known() {
            Some(true) => yes(),
            Some(false) => no(),
            None => Self::select(mask, yes(), no()),
        }
    }

    /// Product with a plain number.
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self * Self::constant(factor)
    }
    /// Square.
    #[inline(always)]
    fn square(self) -> Self {
        self * self
    }
    /// 1/x
    #[inline(always)]
    fn recip(self) -> Self {
        Self::one() / self
    }
    /// Square root.
    fn sqrt(self) -> Self;
    /// Sine, of radians.
    fn sin(self) -> Self;
    /// Cosine, of radians.
    fn cos(self) -> Self;
    /// Sine and cosine together.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }
    /// Tangent, of radians.
    fn tan(self) -> Self;
    /// Arc sine.
    fn asin(self) -> Self;
    /// Arc cosine.
    fn acos(self) -> Self;
    /// Arc tangent.
    fn atan(self) -> Self;
    /// Angle of the point (x, y) = (`other`, `self`).
    fn atan2(self, other: Self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Decimal logarithm.
    fn log10(self) -> Self;
    /// Power with a whole exponent.
    fn powi(self, n: i32) -> Self;
    /// Power with any exponent. A negative base needs an exponent that is integral by value; its derivative drops the
    /// term of the exponent where the exponent does not vary.
    fn powf(self, exponent: Self) -> Self;
    /// Absolute value; derivative 0 at 0.
    fn abs(self) -> Self;
    /// Toward zero; derivative 0.
    fn trunc(self) -> Self;
    /// Nearest, halves away from zero; derivative 0.
    fn round(self) -> Self;
    /// Downward; derivative 0.
    fn floor(self) -> Self;
    /// Exact remainder with the sign of `self` (FORTRAN MOD); derivative 1, −trunc(self/other).
    fn rem(self, other: Self) -> Self;
    /// Value of a table at this number.
    fn lookup(self, table: &std::sync::Arc<dyn Table>, order: u32) -> Self;

    /// The larger; the first on a tie.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }
    /// The smaller; the first on a tie.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.lt(self), other, self)
    }
}

impl Scalar for f64 {
    type Mask = bool;

    #[inline(always)]
    fn constant(x: f64) -> f64 {
        x
    }
    #[inline(always)]
    fn known(&self) -> Option<f64> {
        Some(*self)
    }
    #[inline(always)]
    fn lt(self, other: f64) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: f64) -> bool {
        self <= other
    }
    #[inline(always)]
    fn same(self, other: f64) -> bool {
        self == other
    }
    #[inline(always)]
    fn select(mask: bool, yes: f64, no: f64) -> f64 {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn sin(self) -> f64 {
        circle::sin_cos(self).0
    }
    #[inline(always)]
    fn cos(self) -> f64 {
        circle::sin_cos(self).1
    }
    #[inline(always)]
    fn sin_cos(self) -> (f64, f64) {
        circle::sin_cos(self)
    }
    #[inline(always)]
    fn tan(self) -> f64 {
        f64::tan(self)
    }
    #[inline(always)]
    fn asin(self) -> f64 {
        f64::asin(self)
    }
    #[inline(always)]
    fn acos(self) -> f64 {
        f64::acos(self)
    }
    #[inline(always)]
    fn atan(self) -> f64 {
        f64::atan(self)
    }
    #[inline(always)]
    fn atan2(self, other: f64) -> f64 {
        f64::atan2(self, other)
    }
    #[inline(always)]
    fn sinh(self) -> f64 {
        f64::sinh(self)
    }
    #[inline(always)]
    fn cosh(self) -> f64 {
        f64::cosh(self)
    }
    #[inline(always)]
    fn tanh(self) -> f64 {
        f64::tanh(self)
    }
    #[inline(always)]
    fn exp(self) -> f64 {
        f64::exp(self)
    }
    #[inline(always)]
    fn ln(self) -> f64 {
        f64::ln(self)
    }
    #[inline(always)]
    fn log10(self) -> f64 {
        f64::log10(self)
    }
    #[inline]
    fn powi(self, n: i32) -> f64 {
        power::whole(self, n)
    }
    #[inline]
    fn powf(self, exponent: f64) -> f64 {
        power::real(self, exponent)
    }
    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }
    #[inline(always)]
    fn trunc(self) -> f64 {
        f64::trunc(self)
    }
    #[inline(always)]
    fn round(self) -> f64 {
        f64::round(self)
    }
    #[inline(always)]
    fn floor(self) -> f64 {
        f64::floor(self)
    }
    #[inline(always)]
    fn rem(self, other: f64) -> f64 {
        self % other
    }
    fn lookup(self, table: &std::sync::Arc<dyn Table>, order: u32) -> f64 {
        table.at(self, order)
    }
}

/// Implements the operators of a number type that carries a value and some derivative parts, from five functions.
macro_rules! operators {
    ([$($generics:tt)*] $type:ty) => {
        impl<$($generics)*> std::ops::Add for $type {
            type Output = Self;
            #[inline(always)]
            fn add(self, b: Self) -> Self {
                self.sum(b)
            }
        }
        impl<$($generics)*> std::ops::Sub for $type {
            type Output = Self;
            #[inline(always)]
            fn sub(self, b: Self) -> Self {
                self.difference(b)
            }
        }
        impl<$($generics)*> std::ops::Mul for $type {
            type Output = Self;
            #[inline(always)]
            fn mul(self, b: Self) -> Self {
                self.product(b)
            }
        }
        impl<$($generics)*> std::ops::Div for $type {
            type Output = Self;
            #[inline(always)]
            fn div(self, b: Self) -> Self {
                self.quotient(b)
            }
        }
        impl<$($generics)*> std::ops::Neg for $type {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                self.negative()
            }
        }
        impl<$($generics)*> std::ops::AddAssign for $type {
            #[inline(always)]
            fn add_assign(&mut self, b: Self) {
                *self = *self + b;
            }
        }
        impl<$($generics)*> std::ops::SubAssign for $type {
            #[inline(always)]
            fn sub_assign(&mut self, b: Self) {
                *self = *self - b;
            }
        }
    };
}
use operators;

/// The elementary functions of a number type from one chain rule: `chain(f, f′, f″)` at the value part.
///
/// The derivatives stand here once, for every type that carries derivatives.
macro_rules! elementary_functions {
    ($S:ty) => {
        #[inline]
        fn sqrt(self) -> Self {
            let r = self.value_part().sqrt();
            let d = <$S>::constant(0.5) / r;
            self.chain(r, d, || -(d / self.value_part()).scale(0.5))
        }
        #[inline]
        fn sin(self) -> Self {
            let (s, c) = self.value_part().sin_cos();
            self.chain(s, c, || -s)
        }
        #[inline]
        fn cos(self) -> Self {
            let (s, c) = self.value_part().sin_cos();
            self.chain(c, -s, || -c)
        }
        #[inline]
        fn sin_cos(self) -> (Self, Self) {
            let (s, c) = self.value_part().sin_cos();
            (self.chain(s, c, || -s), self.chain(c, -s, || -c))
        }
        #[inline]
        fn tan(self) -> Self {
            let t = self.value_part().tan();
            let d = <$S>::one() + t * t;
            self.chain(t, d, || (t * d).scale(2.0))
        }
        #[inline]
        fn asin(self) -> Self {
            let x = self.value_part();
            let w = <$S>::one() / (<$S>::one() - x * x).sqrt();
            self.chain(x.asin(), w, || x * w * w * w)
        }
        #[inline]
        fn acos(self) -> Self {
            let x = self.value_part();
            let w = <$S>::one() / (<$S>::one() - x * x).sqrt();
            self.chain(x.acos(), -w, || -(x * w * w * w))
        }
        #[inline]
        fn atan(self) -> Self {
            let x = self.value_part();
            let w = <$S>::one() / (<$S>::one() + x * x);
            self.chain(x.atan(), w, || -(x * w * w).scale(2.0))
        }
        #[inline]
        fn sinh(self) -> Self {
            let (s, c) = (self.value_part().sinh(), self.value_part().cosh());
            self.chain(s, c, || s)
        }
        #[inline]
        fn cosh(self) -> Self {
            let (s, c) = (self.value_part().sinh(), self.value_part().cosh());
            self.chain(c, s, || c)
        }
        #[inline]
        fn tanh(self) -> Self {
            let t = self.value_part().tanh();
            let d = <$S>::one() - t * t;
            self.chain(t, d, || -(t * d).scale(2.0))
        }
        #[inline]
        fn exp(self) -> Self {
            let e = self.value_part().exp();
            self.chain(e, e, || e)
        }
        #[inline]
        fn ln(self) -> Self {
            let w = <$S>::one() / self.value_part();
            self.chain(self.value_part().ln(), w, || -(w * w))
        }
        #[inline]
        fn log10(self) -> Self {
            let w = <$S>::constant(std::f64::consts::LOG10_E) / self.value_part();
            self.chain(self.value_part().log10(), w, || -(w / self.value_part()))
        }
        #[inline]
        fn powi(self, n: i32) -> Self {
            let x = self.value_part();
            let k = f64::from(n);
            let d1 = if n == 0 {
                <$S>::zero()
            } else {
                x.powi(n - 1).scale(k)
            };
            self.chain(x.powi(n), d1, || {
                if n == 0 || n == 1 {
                    <$S>::zero()
                } else {
                    x.powi(n - 2).scale(k * (k - 1.0))
                }
            })
        }
        #[inline]
        fn abs(self) -> Self {
            let x = self.value_part();
            let sign = <$S>::select(
                x.lt(<$S>::zero()),
                -<$S>::one(),
                <$S>::select(x.same(<$S>::zero()), <$S>::zero(), <$S>::one()),
            );
            self.chain(x.abs(), sign, <$S>::zero)
        }
        #[inline]
        fn trunc(self) -> Self {
            Self::from_value(self.value_part().trunc())
        }
        #[inline]
        fn round(self) -> Self {
            Self::from_value(self.value_part().round())
        }
        #[inline]
        fn floor(self) -> Self {
            Self::from_value(self.value_part().floor())
        }
        #[inline]
        fn rem(self, other: Self) -> Self {
            // a − trunc(a/b) b, whose value is taken from the exact remainder
            let (a, b) = (self.value_part(), other.value_part());
            let exact = a.rem(b);
            let turns = ((a - exact) / b).round();
            let mut result = self - other * Self::from_value(turns);
            *result.value_part_mut() = exact;
            result
        }
        #[inline]
        fn atan2(self, other: Self) -> Self {
            // dφ = (x dy − y dx)/(x² + y²): the derivative parts of atan2 are those of atan of whichever quotient is
            // well conditioned there; the value is the four-quadrant one.
            let (y, x) = (self.value_part(), other.value_part());
            let steep = x.abs().lt(y.abs());
            let mut result =
                Self::choose(steep, || -(other / self).atan(), || (self / other).atan());
            *result.value_part_mut() = y.atan2(x);
            result
        }
        #[inline]
        fn lookup(self, table: &std::sync::Arc<dyn $crate::scalar::Table>, order: u32) -> Self {
            let x = self.value_part();
            self.chain(x.lookup(table, order), x.lookup(table, order + 1), || {
                x.lookup(table, order + 2)
            })
        }
        #[inline]
        fn powf(self, exponent: Self) -> Self {
            // d(aᵇ) = b aᵇ⁻¹ da + aᵇ ln a db, the second term only where b varies
            let (a, b) = (self.value_part(), exponent.value_part());
            if exponent.is_value_only() {
                let zero = <$S>::zero();
                let one = <$S>::one();
                let value = a.powf(b);
                if b.known().is_some_and(|b| {
                    $crate::scalar::Exponent::of(b) == $crate::scalar::Exponent::Other
                }) {
                    // a power that costs is not computed again: aᵇ⁻¹ = aᵇ/a, except at a = 0
                    let at_zero = a.same(zero);
                    let d1 = <$S>::choose(at_zero, || b * a.powf(b - one), || b * (value / a));
                    return self.chain(value, d1, || {
                        <$S>::choose(
                            at_zero,
                            || b * (b - one) * a.powf(b - one - one),
                            || (b - one) * (d1 / a),
                        )
                    });
                }
                // b = 0 and b = 1 have derivatives 0 and 1, also at a = 0
                let d1 = <$S>::choose(b.same(zero), || zero, || b * a.powf(b - one));
                return self.chain(value, d1, || {
                    <$S>::choose(
                        b.same(zero).or(b.same(one)),
                        || zero,
                        || b * (b - one) * a.powf(b - one - one),
                    )
                });
            }
            let mut result = (exponent * self.ln()).exp();
            *result.value_part_mut() = a.powf(b);
            result
        }
    };
}
use elementary_functions;
