//! A batch: several samples of one number, evaluated side by side.

use super::elementary::several;
use super::{Exponent, Mask, Scalar, operators};
use super::{arc, circle, exponential, logarithm};

/// `N` samples; every operation works on all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct Lanes<const N: usize>(pub [f64; N]);

impl<const N: usize> Mask for [bool; N] {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        std::array::from_fn(|k| self[k] && other[k])
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        std::array::from_fn(|k| self[k] || other[k])
    }
    #[inline(always)]
    fn not(self) -> Self {
        self.map(|x| !x)
    }
    #[inline(always)]
    fn known(self) -> Option<bool> {
        let first = *self.first()?;
        self.iter().all(|&x| x == first).then_some(first)
    }
}

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        // a loop, not `array::map`: this must become vector instructions wherever it is used
        let mut result = self.0;
        for x in &mut result {
            *x = f(*x);
        }
        Self(result)
    }
    #[inline(always)]
    fn zip(self, b: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let mut result = self.0;
        for (x, y) in result.iter_mut().zip(b.0) {
            *x = f(*x, y);
        }
        Self(result)
    }
    /// Returns the power by the logarithm, also for exponents that have a shorter way.
    #[inline(always)]
    pub(crate) fn general_power(self, exponent: Self) -> Self {
        Self(several::<logarithm::Power, N>(|k| {
            [self.0[k], exponent.0[k]]
        }))
    }
    #[inline(always)]
    fn sum(self, b: Self) -> Self {
        self.zip(b, |x, y| x + y)
    }
    #[inline(always)]
    fn difference(self, b: Self) -> Self {
        self.zip(b, |x, y| x - y)
    }
    #[inline(always)]
    fn product(self, b: Self) -> Self {
        self.zip(b, |x, y| x * y)
    }
    #[inline(always)]
    fn quotient(self, b: Self) -> Self {
        self.zip(b, |x, y| x / y)
    }
    #[inline(always)]
    fn negative(self) -> Self {
        self.map(|x| -x)
    }
}

operators!([const N: usize] Lanes<N>);

/// Implements functions of one number by their formulas.
macro_rules! formulas {
    ($($name:ident $function:path;)*) => { $(
        #[inline(always)]
        fn $name(self) -> Self {
            Self(several::<$function, N>(|k| self.0[k]))
        }
    )* };
}

/// Implements functions of one number lane by lane.
macro_rules! lane_by_lane {
    ($($name:ident)*) => { $(
        #[inline(always)]
        fn $name(self) -> Self {
            self.map(f64::$name)
        }
    )* };
}

impl<const N: usize> Scalar for Lanes<N> {
    type Mask = [bool; N];

    #[inline(always)]
    fn constant(x: f64) -> Self {
        Self([x; N])
    }
    #[inline(always)]
    fn known(&self) -> Option<f64> {
        let first = *self.0.first()?;
        self.0.iter().all(|&x| x == first).then_some(first)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> [bool; N] {
        std::array::from_fn(|k| self.0[k] < other.0[k])
    }
    #[inline(always)]
    fn le(self, other: Self) -> [bool; N] {
        std::array::from_fn(|k| self.0[k] <= other.0[k])
    }
    #[inline(always)]
    fn same(self, other: Self) -> [bool; N] {
        std::array::from_fn(|k| self.0[k] == other.0[k])
    }
    #[inline(always)]
    fn select(mask: [bool; N], yes: Self, no: Self) -> Self {
        Self(std::array::from_fn(|k| {
            if mask[k] { yes.0[k] } else { no.0[k] }
        }))
    }
    lane_by_lane!(sqrt abs trunc round floor);
    formulas! {
        tan circle::Tan;
        asin arc::Asin;
        acos arc::Acos;
        atan arc::Atan;
        sinh exponential::Sinh;
        cosh exponential::Cosh;
        tanh exponential::Tanh;
        exp exponential::Exp;
        ln logarithm::Ln;
        log10 logarithm::Log10;
    }
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sines, cosines) = circle::of_several(self.0);
        (Self(sines), Self(cosines))
    }
    #[inline(always)]
    fn atan2(self, other: Self) -> Self {
        Self(several::<arc::Atan2, N>(|k| [self.0[k], other.0[k]]))
    }
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        // as for a single number, on all samples at once
        let mut rest = n.unsigned_abs();
        let (mut square, mut product) = (self, Self::constant(1.0));
        loop {
            if rest & 1 == 1 {
                product = product * square;
            }
            rest >>= 1;
            if rest == 0 {
                break;
            }
            square = square * square;
        }
        if n < 0 {
            Self::constant(1.0) / product
        } else {
            product
        }
    }
    #[inline(always)]
    fn powf(self, exponent: Self) -> Self {
        match exponent.known().map(Exponent::of) {
            Some(Exponent::Whole(n)) => self.powi(n),
            Some(Exponent::Half(n)) => self.powi(n) * self.sqrt(),
            Some(Exponent::Other) => self.general_power(exponent),
            None => self.zip(exponent, Scalar::powf),
        }
    }
    #[inline(always)]
    fn rem(self, other: Self) -> Self {
        self.zip(other, |x, y| x % y)
    }
    #[inline(always)]
    fn lookup(self, table: &std::sync::Arc<dyn super::Table>, order: u32) -> Self {
        self.map(|x| table.at(x, order))
    }
}
