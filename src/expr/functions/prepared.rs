//! Functions with constant parameters, and the numbers that can be computed from these beforehand.
//!
//! `STEP(x, x0, h0, x1, h1)` with constant ends needs the reciprocal of `x1 − x0` once. Each
//! function here does the operations of its row in the same order, so that it yields the same bits;
//! tests compare the two.

use super::Function;
use super::contact;
use super::series;
use super::step::{cubic, haversine, quintic};
use crate::scalar::{Dual, Exponent, Lanes, Scalar, general_power};

/// A prepared function; each variant lists its variables, then its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Prepared {
    /// x; x0, x1, h0, h1, 1/(x1 − x0), h1 − h0
    Step,
    Step5,
    Havsin,
    /// x; x0, coefficients
    Poly,
    Cheby,
    /// x; x0, w, coefficients
    Forcos,
    Forsin,
    /// x, x_dot; x1, k, cmax, d, 1/d, e
    Impact(Exponent),
    /// x, x_dot; x1, x2, k, cmax, d, 1/d, e
    Bistop(Exponent),
}

impl Prepared {
    /// Returns the prepared form of a call and its parameters, or `None` if a parameter is not
    /// constant or out of range.
    pub(crate) fn of(function: Function, args: &[Option<f64>]) -> Option<(Prepared, Vec<f64>)> {
        let variable = match function {
            Function::Impact | Function::Bistop => 2,
            _ => 1,
        };
        let constants = args
            .get(variable..)?
            .iter()
            .copied()
            .collect::<Option<Vec<f64>>>()?;
        let mut known = vec![f64::NAN; variable];
        known.extend(&constants);
        if function.violation(&known).is_some() {
            return None;
        }
        let prepared = match (function, &constants[..]) {
            (Function::Step | Function::Step5 | Function::Havsin, &[x0, h0, x1, h1]) => {
                let kind = match function {
                    Function::Step => Prepared::Step,
                    Function::Step5 => Prepared::Step5,
                    _ => Prepared::Havsin,
                };
                (kind, vec![x0, x1, h0, h1, (x1 - x0).recip(), h1 - h0])
            }
            (Function::Poly, _) => (Prepared::Poly, constants),
            (Function::Cheby, _) => (Prepared::Cheby, constants),
            (Function::Forcos, _) => (Prepared::Forcos, constants),
            (Function::Forsin, _) => (Prepared::Forsin, constants),
            (Function::Impact, &[x1, k, e, cmax, d]) => (
                Prepared::Impact(Exponent::of(e)),
                vec![x1, k, cmax, d, d.recip(), e],
            ),
            (Function::Bistop, &[x1, x2, k, e, cmax, d]) => (
                Prepared::Bistop(Exponent::of(e)),
                vec![x1, x2, k, cmax, d, d.recip(), e],
            ),
            _ => return None,
        };
        Some(prepared)
    }

    /// Returns the number of variables.
    pub(crate) fn n_variables(self) -> usize {
        match self {
            Prepared::Impact(_) | Prepared::Bistop(_) => 2,
            _ => 1,
        }
    }
}

/// Evaluates a step; `p` as [`Prepared::Step`] lists it.
#[inline(always)]
pub(crate) fn step<S: Scalar>(x: S, p: &[f64; 6], shape: impl FnOnce(S) -> S) -> S {
    let [x0, x1, h0, h1, ..] = *p;
    S::choose(
        x.le(S::constant(x0)),
        || S::constant(h0),
        || {
            S::choose(
                S::constant(x1).le(x),
                || S::constant(h1),
                || rising(x, p, shape),
            )
        },
    )
}

/// Evaluates a step between its ends.
#[inline(always)]
pub(crate) fn rising<S: Scalar>(x: S, p: &[f64; 6], shape: impl FnOnce(S) -> S) -> S {
    let [x0, _, h0, _, per_length, rise] = *p;
    S::constant(h0) + shape((x - S::constant(x0)).scale(per_length)).scale(rise)
}

/// Evaluates all three pieces of a step and selects: faster for many samples at once.
#[inline(always)]
pub(crate) fn step_everywhere<S: Scalar>(x: S, p: &[f64; 6], shape: impl FnOnce(S) -> S) -> S {
    let [x0, x1, h0, h1, per_length, rise] = *p;
    let x0 = S::constant(x0);
    let x1 = S::constant(x1);
    let h0 = S::constant(h0);
    let h1 = S::constant(h1);
    let between = h0 + shape((x - x0).scale(per_length)).scale(rise);
    S::select(x.le(x0), h0, S::select(x1.le(x), h1, between))
}

/// Evaluates STEP.
#[inline(always)]
pub(crate) fn step3<S: Scalar>(x: S, p: &[f64; 6]) -> S {
    step(x, p, cubic)
}
/// Evaluates STEP5.
#[inline(always)]
pub(crate) fn step5<S: Scalar>(x: S, p: &[f64; 6]) -> S {
    step(x, p, quintic)
}
/// Evaluates HAVSIN.
#[inline(always)]
pub(crate) fn havsin<S: Scalar>(x: S, p: &[f64; 6]) -> S {
    step(x, p, haversine)
}

/// Evaluates POLY.
#[inline(always)]
pub(crate) fn poly<S: Scalar>(x: S, p: &[f64]) -> S {
    series::powers(x - S::constant(p[0]), &p[1..], S::constant)
}
/// Evaluates CHEBY.
#[inline(always)]
pub(crate) fn cheby<S: Scalar>(x: S, p: &[f64]) -> S {
    series::chebyshev(x - S::constant(p[0]), &p[1..], S::constant)
}
/// Evaluates FORCOS.
#[inline(always)]
pub(crate) fn forcos<S: Scalar>(x: S, p: &[f64]) -> S {
    series::cosines((x - S::constant(p[0])).scale(p[1]), &p[2..], S::constant)
}
/// Evaluates FORSIN.
#[inline(always)]
pub(crate) fn forsin<S: Scalar>(x: S, p: &[f64]) -> S {
    series::sines((x - S::constant(p[0])).scale(p[1]), &p[2..], S::constant)
}

/// Evaluates IMPACT.
#[inline(always)]
pub(crate) fn impact<S: Power>(x: S, x_dot: S, p: &[f64; 6], exponent: Exponent) -> S {
    let [x1, k, cmax, d, per_depth, e] = *p;
    let x1 = S::constant(x1);
    let k = S::constant(k);
    let cmax = S::constant(cmax);
    let d = S::constant(d);
    let per_depth = S::constant(per_depth);
    contact::impact(x, x_dot, x1, k, cmax, d, per_depth, Known(exponent, e))
}

/// Evaluates BISTOP.
#[inline(always)]
pub(crate) fn bistop<S: Power>(x: S, x_dot: S, p: &[f64; 7], exponent: Exponent) -> S {
    let [x1, x2, k, cmax, d, per_depth, e] = *p;
    let x1 = S::constant(x1);
    let x2 = S::constant(x2);
    let k = S::constant(k);
    let cmax = S::constant(cmax);
    let d = S::constant(d);
    let per_depth = S::constant(per_depth);
    contact::bistop(x, x_dot, x1, x2, k, cmax, d, per_depth, Known(exponent, e))
}

/// A power whose exponent is known.
struct Known(Exponent, f64);

impl<S: Power> contact::Elastic<S> for Known {
    #[inline(always)]
    fn of(self, p: S) -> S {
        p.power(self.0, self.1)
    }
}

/// A number that can be raised to a power whose kind is known.
pub(crate) trait Power: Scalar {
    /// Returns `self**e`, where `exponent` is the kind of `e`.
    fn power(self, exponent: Exponent, e: f64) -> Self;
}

impl Power for f64 {
    #[inline(always)]
    fn power(self, exponent: Exponent, e: f64) -> f64 {
        match exponent {
            Exponent::Whole(n) => Scalar::powi(self, n),
            Exponent::Half(n) => Scalar::powi(self, n) * self.sqrt(),
            Exponent::Other => general_power(self, e),
        }
    }
}

impl<const N: usize> Power for Lanes<N> {
    #[inline(always)]
    fn power(self, exponent: Exponent, e: f64) -> Self {
        match exponent {
            Exponent::Whole(n) => Scalar::powi(self, n),
            Exponent::Half(n) => Scalar::powi(self, n) * Scalar::sqrt(self),
            // the base of a contact is positive; samples without contact do not count
            Exponent::Other => {
                let is_positive = Self::zero().lt(self);
                let base = Self::select(is_positive, self, Self::one());
                Self::select(
                    is_positive,
                    base.general_power(Self::constant(e)),
                    Self::zero(),
                )
            }
        }
    }
}

impl<const N: usize> Power for Dual<N> {
    #[inline(always)]
    fn power(self, exponent: Exponent, e: f64) -> Self {
        // like `Dual::powf`; the base of a contact is not zero
        let value = self.re.power(exponent, e);
        let slope = match exponent {
            Exponent::Whole(n) => e * Scalar::powi(self.re, n - 1),
            Exponent::Half(n) if n > 0 => e * self.re.power(Exponent::Half(n - 1), e - 1.0),
            Exponent::Half(_) => e * Scalar::powf(self.re, e - 1.0),
            Exponent::Other => e * (value / self.re),
        };
        let mut eps = self.eps;
        for x in &mut eps {
            *x *= slope;
        }
        Self { re: value, eps }
    }
}
