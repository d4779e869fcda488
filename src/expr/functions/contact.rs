//! The force of a one-sided contact: the shared part of IMPACT and BISTOP.
//!
//! ```text
//! f = max(0, k pᵉ + c(p) ṗ)          p > 0
//! c = cmax w² (3 − 2w), w = p/d      p < d, else cmax
//! ```
//!
//! `p` is the penetration. `STEP(x, x1−d, cmax, x1, 0)` of the manuals is the same ramp, measured
//! from the other end.

use super::step::cubic;
use crate::scalar::{Mask, Scalar};

/// The power of a penetration: a closure, or a type of its own whose code becomes part of the loop
/// around it, which is compiled for the vector instructions of the machine.
pub trait Elastic<S> {
    /// Returns `pᵉ`.
    fn of(self, p: S) -> S;
}

impl<S, F: FnOnce(S) -> S> Elastic<S> for F {
    #[inline(always)]
    fn of(self, p: S) -> S {
        self(p)
    }
}

/// The power with any exponent.
pub struct AnyExponent<S>(pub S);

impl<S: Scalar> Elastic<S> for AnyExponent<S> {
    #[inline(always)]
    fn of(self, p: S) -> S {
        p.powf(self.0)
    }
}

/// Evaluates `IMPACT(x, x_dot, x1, k, e, cmax, d)`; `per_depth` is 1/d.
#[allow(clippy::too_many_arguments)]
#[inline(always)]
pub fn impact<S: Scalar>(
    x: S,
    x_dot: S,
    x1: S,
    k: S,
    cmax: S,
    d: S,
    per_depth: S,
    power: impl Elastic<S>,
) -> S {
    let free = x1.le(x);
    if free.known() == Some(true) {
        return S::zero();
    }
    pushing(free, contact(x1 - x, -x_dot, k, cmax, d, per_depth, power))
}

/// Evaluates `BISTOP(x, x_dot, x1, x2, k, e, cmax, d)`; `per_depth` is 1/d.
#[allow(clippy::too_many_arguments)]
#[inline(always)]
pub fn bistop<S: Scalar>(
    x: S,
    x_dot: S,
    x1: S,
    x2: S,
    k: S,
    cmax: S,
    d: S,
    per_depth: S,
    power: impl Elastic<S>,
) -> S {
    let free = x1.le(x).and(x.le(x2));
    if free.known() == Some(true) {
        return S::zero();
    }
    // one law for both stops; the upper one pushes back
    let low = x.lt(x1);
    let p = S::select(low, x1 - x, x - x2);
    let p_dot = S::select(low, -x_dot, x_dot);
    let force = pushing(free, contact(p, p_dot, k, cmax, d, per_depth, power));
    S::select(low, force, S::zero() - force)
}

/// Limits a force to one that never attracts, and is none where bodies are apart.
///
/// In this order, so that the switching value is zero while bodies are apart, not the sign of the
/// force that would be there.
#[inline(always)]
fn pushing<S: Scalar>(free: S::Mask, force: S) -> S {
    let force = S::select(free, S::zero(), force);
    S::select(force.le(S::zero()), S::zero(), force)
}

/// Returns elastic and damping force at penetration `p > 0` and penetration rate `p_dot`. `power`
/// is `pᵉ`.
#[inline(always)]
fn contact<S: Scalar>(
    p: S,
    p_dot: S,
    k: S,
    cmax: S,
    d: S,
    per_depth: S,
    power: impl Elastic<S>,
) -> S {
    let elastic = k * power.of(p);
    let c = S::choose(d.le(p), || cmax, || cmax * cubic(p * per_depth));
    elastic + c * p_dot
}
