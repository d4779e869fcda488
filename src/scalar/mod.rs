//! The numbers that formulas are written in.
//!
//! Every formula of the crate is generic over [`Scalar`]: a plain `f64` gives the value, a [`Dual`]
//! the derivatives, a [`Jet`] the rates in time, [`Lanes`] a batch of samples, an [`Interval`]
//! bounds, a [`Germ`] the behaviour just beside a point. There is no second copy of a formula to
//! keep in step.
//!
//! A formula with cases compares, which gives a [`Mask`], and selects; it never inspects the
//! number. So the same lines run where a "number" is many samples at once, or a node of a program
//! that is being recorded.

mod arc;
mod circle;
mod dual;
mod elementary;
mod exponential;
mod germ;
mod interval;
mod jet;
mod lanes;
mod logarithm;
mod power;
mod quarters;

pub(crate) use circle::sines_and_cosines;
pub use dual::Dual;
pub use germ::{Germ, ORDERS};
pub use interval::Interval;
pub use jet::Jet;
pub use lanes::Lanes;
pub use power::Exponent;
pub(crate) use power::general as general_power;

use elementary::one;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Returns √(a² + b²) of two numbers of any size, off by two units in the last place at most.
pub fn hypot(a: f64, b: f64) -> f64 {
    let most = a.abs().max(b.abs());
    if most > 0.0 && most < f64::INFINITY {
        let [a, b] = [a / most, b / most];
        most * (a * a + b * b).sqrt()
    } else {
        // neither has a size, or one has none that is finite
        a.abs() + b.abs()
    }
}

/// The result of a comparison: one truth value, one per lane, or a recorded condition.
pub trait Mask: Copy + Debug {
    /// Returns true where both are true.
    fn and(self, other: Self) -> Self;
    /// Returns true where either is true.
    fn or(self, other: Self) -> Self;
    /// Returns true where this is false.
    fn not(self) -> Self;
    /// Returns the truth value, if it is the same everywhere and known now.
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

/// A table in which a number can be looked up: a curve through data, with its derivatives.
///
/// [`Scalar::lookup`] asks for `order` 0 and, for derivatives, for the next higher orders.
pub trait Table: Debug + Send + Sync {
    /// Returns the `order`-th derivative at `x`.
    fn at(&self, x: f64, order: u32) -> f64;
    /// Returns the places where pieces meet, increasing.
    fn knots(&self) -> &[f64] {
        &[]
    }
    /// Returns the `order`-th derivative at `x` of the piece just above or below it.
    fn beside(&self, x: f64, above: bool, order: u32) -> f64 {
        let _ = above;
        self.at(x, order)
    }
    /// Returns whether its value or its slope jumps where pieces meet.
    fn is_sharp(&self) -> bool {
        false
    }
}

/// A number: `f64`, or a type that carries more than a value and obeys the same rules.
///
/// Comparisons depend on the value part only. `sqrt`, `ln` and the like follow IEEE: outside their
/// domain the value is NaN, never a panic.
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
    /// The result of a comparison.
    type Mask: Mask;

    /// Tells whether programs call the functions of the table over this number as they are. Over
    /// others they run the operations that these consist of: each number that has the table costs a
    /// copy of it, and one over duals.
    const CALLS_FUNCTIONS: bool = false;

    /// Creates a number that depends on nothing.
    fn constant(x: f64) -> Self;
    /// Returns zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::constant(0.0)
    }
    /// Returns one.
    #[inline(always)]
    fn one() -> Self {
        Self::constant(1.0)
    }
    /// Returns the number if it is a constant known now. Formulas may leave out terms that are
    /// known to be zero.
    fn known(&self) -> Option<f64>;
    /// Returns whether the number is known to be zero, with all its derivatives.
    #[inline(always)]
    fn is_known_zero(&self) -> bool {
        self.known() == Some(0.0)
    }

    /// Compares `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// Compares `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// Compares `self == other`.
    fn same(self, other: Self) -> Self::Mask;
    /// Returns `yes` where the mask is true, `no` elsewhere. Both have been evaluated; the other
    /// one is dropped, NaN included.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Selects like [`Scalar::select`], but evaluates only one side where the mask is the same
    /// everywhere.
    #[inline(always)]
    fn choose(mask: Self::Mask, yes: impl FnOnce() -> Self, no: impl FnOnce() -> Self) -> Self {
        match mask.known() {
            Some(true) => yes(),
            Some(false) => no(),
            None => Self::select(mask, yes(), no()),
        }
    }

    /// Returns the rate of a value that is constant but for jumps: zero, or, of bounds that hold
    /// several such values, none.
    #[inline(always)]
    fn rate_of_steps(self) -> Self {
        Self::zero()
    }

    /// Multiplies by a plain number.
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self * Self::constant(factor)
    }
    /// Returns the square.
    #[inline(always)]
    fn square(self) -> Self {
        self * self
    }
    /// Returns 1/x.
    #[inline(always)]
    fn recip(self) -> Self {
        Self::one() / self
    }
    /// Returns the square root.
    fn sqrt(self) -> Self;
    /// Returns the sine of an angle in radians.
    fn sin(self) -> Self;
    /// Returns the cosine of an angle in radians.
    fn cos(self) -> Self;
    /// Returns sine and cosine of an angle in radians.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }
    /// Returns the tangent of an angle in radians.
    fn tan(self) -> Self;
    /// Returns the arc sine, in radians.
    fn asin(self) -> Self;
    /// Returns the arc cosine, in radians.
    fn acos(self) -> Self;
    /// Returns the arc tangent, in radians.
    fn atan(self) -> Self;
    /// Returns the angle of the point (x, y) = (`other`, `self`), in radians.
    fn atan2(self, other: Self) -> Self;
    /// Returns the hyperbolic sine.
    fn sinh(self) -> Self;
    /// Returns the hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Returns the hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Returns the exponential.
    fn exp(self) -> Self;
    /// Returns the natural logarithm.
    fn ln(self) -> Self;
    /// Returns the decimal logarithm.
    fn log10(self) -> Self;
    /// Returns the power with an integer exponent.
    fn powi(self, n: i32) -> Self;
    /// Returns the power with any exponent. A negative base needs an exponent that is an integer by
    /// value; its derivative drops the term of the exponent where the exponent does not vary.
    fn powf(self, exponent: Self) -> Self;
    /// Returns the absolute value; derivative 0 at 0.
    fn abs(self) -> Self;
    /// Rounds toward zero; derivative 0.
    fn trunc(self) -> Self;
    /// Rounds to the nearest integer, halves away from zero; derivative 0.
    fn round(self) -> Self;
    /// Rounds down; derivative 0.
    fn floor(self) -> Self;
    /// Returns the exact remainder with the sign of `self` (FORTRAN MOD); derivatives 1 and
    /// −trunc(self/other).
    fn rem(self, other: Self) -> Self;
    /// Returns the `order`-th derivative of a table at this number.
    fn lookup(self, table: &std::sync::Arc<dyn Table>, order: u32) -> Self;

    /// Returns this number, to the bit, where `x` is finite, and NaN elsewhere; derivatives are
    /// those of this number. So a result goes with an operand that its operation would lose.
    #[inline(always)]
    #[expect(clippy::eq_op, reason = "x − x is +0 where x is finite, NaN elsewhere")]
    fn kept_with(self, x: Self) -> Self {
        self - (x - x)
    }

    /// Returns the larger; the first on a tie.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }
    /// Returns the smaller; the first on a tie.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.lt(self), other, self)
    }
}

impl Scalar for f64 {
    type Mask = bool;
    const CALLS_FUNCTIONS: bool = true;

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
        one::<circle::Tan>(self)
    }
    #[inline(always)]
    fn asin(self) -> f64 {
        one::<arc::Asin>(self)
    }
    #[inline(always)]
    fn acos(self) -> f64 {
        one::<arc::Acos>(self)
    }
    #[inline(always)]
    fn atan(self) -> f64 {
        one::<arc::Atan>(self)
    }
    #[inline(always)]
    fn atan2(self, other: f64) -> f64 {
        one::<arc::Atan2>([self, other])
    }
    #[inline(always)]
    fn sinh(self) -> f64 {
        one::<exponential::Sinh>(self)
    }
    #[inline(always)]
    fn cosh(self) -> f64 {
        one::<exponential::Cosh>(self)
    }
    #[inline(always)]
    fn tanh(self) -> f64 {
        one::<exponential::Tanh>(self)
    }
    #[inline(always)]
    fn exp(self) -> f64 {
        one::<exponential::Exp>(self)
    }
    #[inline(always)]
    fn ln(self) -> f64 {
        one::<logarithm::Ln>(self)
    }
    #[inline(always)]
    fn log10(self) -> f64 {
        one::<logarithm::Log10>(self)
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

/// Implements the operators of a number type that carries a value and derivative parts, from five
/// functions.
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

/// Implements constants and comparisons of a number type over its value part of type `$S`.
macro_rules! value_part_comparisons {
    ($S:ty) => {
        type Mask = <$S as Scalar>::Mask;

        #[inline(always)]
        fn constant(x: f64) -> Self {
            Self::from_value(<$S>::constant(x))
        }
        #[inline(always)]
        fn known(&self) -> Option<f64> {
            if self.is_value_only() {
                self.value_part().known()
            } else {
                None
            }
        }
        #[inline(always)]
        fn lt(self, other: Self) -> Self::Mask {
            self.value_part().lt(other.value_part())
        }
        #[inline(always)]
        fn le(self, other: Self) -> Self::Mask {
            self.value_part().le(other.value_part())
        }
        #[inline(always)]
        fn same(self, other: Self) -> Self::Mask {
            self.value_part().same(other.value_part())
        }
    };
}

/// Implements the elementary functions of a number type from one chain rule: `chain(f, f′, f″)` at
/// the value part.
///
/// The derivatives are written here once, for every type that carries derivatives.
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
            Self::from_steps(self.value_part().trunc())
        }
        #[inline]
        fn round(self) -> Self {
            Self::from_steps(self.value_part().round())
        }
        #[inline]
        fn floor(self) -> Self {
            Self::from_steps(self.value_part().floor())
        }
        #[inline]
        fn rem(self, other: Self) -> Self {
            // a − trunc(a/b) b, whose value is taken from the exact remainder
            let (a, b) = (self.value_part(), other.value_part());
            let exact = a.rem(b);
            let turns = ((a - exact) / b).round();
            let mut result = self - other * Self::from_steps(turns);
            *result.value_part_mut() = exact;
            result
        }
        #[inline]
        fn atan2(self, other: Self) -> Self {
            // dφ = (x dy − y dx)/(x² + y²): the derivative parts of atan2 are those of atan of the
            // quotient that is well conditioned there; the value is the four-quadrant one.
            let (y, x) = (self.value_part(), other.value_part());
            // The operands are chosen before they are divided: the quotient of the other side is
            // infinite where y is zero, and a derivative of it times zero no number.
            let steep = x.abs().lt(y.abs());
            let quotient = Self::select(steep, other, self) / Self::select(steep, self, other);
            let angle = quotient.atan();
            let mut result = Self::select(steep, -angle, angle);
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
                    // reuse the power, which is expensive: aᵇ⁻¹ = aᵇ/a, except at a = 0
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
use value_part_comparisons;
