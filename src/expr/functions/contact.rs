//! The force of a one-sided contact: the shared part of IMPACT and BISTOP.
//!
//! ```text
//! f = max(0, k pᵉ + c(p) ṗ)          p > 0
//! c = cmax w² (3 − 2w), w = p/d      p < d, else cmax
//! ```
//!
//! `p` is the penetration. `STEP(x, x1−d, cmax, x1, 0)` of the manuals is the same ramp, seen from the other end.

use crate::scalar::Scalar;

/// Force at penetration `p > 0` and penetration rate `p_dot`; never attractive. `per_depth` is `1/d`.
#[inline(always)]
pub fn contact<S: Scalar>(p: S, p_dot: S, k: S, e: S, cmax: S, d: S, per_depth: S) -> S {
    let elastic = k * p.powf(e);
    let c = S::choose(
        d.le(p),
        || cmax,
        || cmax * super::step::cubic(p * per_depth),
    );
    let force = elastic + c * p_dot;
    S::choose(force.le(S::zero()), S::zero, || force)
}
