//! Powers of plain numbers, by one rule for all engines.
//!
//! Small integer exponents are products, and half-integral ones a product and a square root: three
//! to ten times faster than the general power and as exact. The rule depends on the value of the
//! exponent, not on its origin, so that a compiled program, which knows a constant exponent
//! beforehand, yields the same bits as everything else.

use super::elementary::one;
use super::logarithm::Power;

/// The kind of an exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exponent {
    /// n: a product
    Whole(i32),
    /// n + 1/2: the product for n, times the square root
    Half(i32),
    /// the general power
    Other,
}

impl Exponent {
    /// Largest magnitude of an integer exponent that becomes a product: the rounding errors of as
    /// many factors stay below 4e-15.
    const LARGEST_PRODUCT: f64 = 32.0;

    /// Classifies an exponent.
    #[inline]
    pub fn of(exponent: f64) -> Exponent {
        if exponent.abs() > Self::LARGEST_PRODUCT || exponent.is_nan() {
            return Exponent::Other;
        }
        // `as` truncates in one instruction; `trunc` is a call on old processors
        let n = exponent as i32;
        let rest = exponent - f64::from(n);
        if rest == 0.0 {
            Exponent::Whole(n)
        } else if rest == 0.5 && n <= 4 {
            Exponent::Half(n)
        } else {
            Exponent::Other
        }
    }
}

/// Returns `x` to an integer power, by repeated squaring; a negative one is the reciprocal.
#[inline]
pub(super) fn whole(x: f64, n: i32) -> f64 {
    let mut rest = n.unsigned_abs();
    let mut square = x;
    let mut product = 1.0;
    loop {
        if rest & 1 == 1 {
            product *= square;
        }
        rest >>= 1;
        if rest == 0 {
            break;
        }
        square *= square;
    }
    if n < 0 { 1.0 / product } else { product }
}

/// Returns `x` to any power, by its logarithm: part of the code that calls it, and so compiled for
/// the same instructions.
#[inline(always)]
pub(crate) fn general(x: f64, exponent: f64) -> f64 {
    one::<Power>([x, exponent])
}

/// Returns `x` to any power.
#[inline]
pub(super) fn real(x: f64, exponent: f64) -> f64 {
    match Exponent::of(exponent) {
        Exponent::Whole(n) => whole(x, n),
        Exponent::Half(n) => whole(x, n) * x.sqrt(),
        Exponent::Other => general(x, exponent),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_agree_with_the_general_power() {
        for x in [0.3, -1.7, 12.5, 1e-3, -0.0, 0.0] {
            for n in -32..=32 {
                let (got, want) = (real(x, f64::from(n)), f64::powf(x, f64::from(n)));
                assert!(
                    got == want || (got - want).abs() <= 4e-15 * want.abs(),
                    "{x}**{n}: {got} {want}"
                );
            }
        }
        for x in [0.0, 0.3, 12.5, 1e-3] {
            for e in [0.5, 1.5, 2.5, 3.5, -0.5, -1.5, 4.5, 0.25] {
                let (got, want) = (real(x, e), f64::powf(x, e));
                assert!(
                    got == want || (got - want).abs() <= 2e-15 * want.abs(),
                    "{x}**{e}: {got} {want}"
                );
            }
        }
        assert!(real(-8.0, 0.5).is_nan());
        assert_eq!(real(0.0, -1.0), f64::INFINITY);
        assert_eq!(real(0.0, 0.0), 1.0);
    }
}
