//! Several samples of one number, evaluated side by side.

use super::{Mask, Scalar, operators};

/// `N` samples; every operation works on all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<const N: usize>(pub [f64; N]);

impl<const N: usize> Mask for [bool; N] {
    fn and(self, other: Self) -> Self {
        std::array::from_fn(|k| self[k] && other[k])
    }
    fn or(self, other: Self) -> Self {
        std::array::from_fn(|k| self[k] || other[k])
    }
    fn not(self) -> Self {
        self.map(|x| !x)
    }
    fn known(self) -> Option<bool> {
        let first = *self.first()?;
        self.iter().all(|&x| x == first).then_some(first)
    }
}

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(f))
    }
    #[inline(always)]
    fn zip(self, b: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|k| f(self.0[k], b.0[k])))
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

/// Functions of one number that each lane computes for itself.
macro_rules! lane_by_lane {
    ($($name:ident)*) => { $(
        fn $name(self) -> Self {
            self.map(f64::$name)
        }
    )* };
}

impl<const N: usize> Scalar for Lanes<N> {
    type Mask = [bool; N];

    fn constant(x: f64) -> Self {
        Self([x; N])
    }
    fn known(&self) -> Option<f64> {
        let first = *self.0.first()?;
        self.0.iter().all(|&x| x == first).then_some(first)
    }
    fn lt(self, other: Self) -> [bool; N] {
        std::array::from_fn(|k| self.0[k] < other.0[k])
    }
    fn le(self, other: Self) -> [bool; N] {
        std::array::from_fn(|k| self.0[k] <= other.0[k])
    }
    fn same(self, other: Self) -> [bool; N] {
        std::array::from_fn(|k| self.0[k] == other.0[k])
    }
    fn select(mask: [bool; N], yes: Self, no: Self) -> Self {
        Self(std::array::from_fn(|k| {
            if mask[k] { yes.0[k] } else { no.0[k] }
        }))
    }
    lane_by_lane!(sqrt sin cos tan asin acos atan sinh cosh tanh exp ln log10 abs trunc round floor);
    fn atan2(self, other: Self) -> Self {
        self.zip(other, f64::atan2)
    }
    fn powi(self, n: i32) -> Self {
        self.map(|x| Scalar::powi(x, n))
    }
    fn powf(self, exponent: Self) -> Self {
        self.zip(exponent, Scalar::powf)
    }
    fn rem(self, other: Self) -> Self {
        self.zip(other, |x, y| x % y)
    }
    fn lookup(self, table: &std::sync::Arc<dyn super::Table>, order: u32) -> Self {
        self.map(|x| table.at(x, order))
    }
}
