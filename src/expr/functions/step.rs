//! Steps from one level to another: the shared part of STEP, STEP5, HAVSIN and SWEEP.
//!
//! ```text
//! f = h0                            x ≤ x0
//! f = h0 + (h1 − h0) s(u)           u = (x − x0)/(x1 − x0)
//! f = h1                            x ≥ x1
//! ```
//!
//! The shape `s` rises from 0 to 1. The quotient is a product with `1/(x1 − x0)`, which costs one
//! more rounding and lets a program with constant ends compute the reciprocal once.

use crate::scalar::Scalar;

/// Steps from `h0` at `x0` to `h1` at `x1` along a shape.
#[inline(always)]
pub fn step<S: Scalar>(x: S, x0: S, h0: S, x1: S, h1: S, shape: impl FnOnce(S) -> S) -> S {
    S::choose(
        x.le(x0),
        || h0,
        || {
            S::choose(
                x1.le(x),
                || h1,
                || between(x, x0, h0, (x1 - x0).recip(), h1 - h0, shape),
            )
        },
    )
}

/// Returns the rising part: `h0 + rise·s((x − x0)·per_length)`.
#[inline(always)]
pub fn between<S: Scalar>(
    x: S,
    x0: S,
    h0: S,
    per_length: S,
    rise: S,
    shape: impl FnOnce(S) -> S,
) -> S {
    h0 + rise * shape((x - x0) * per_length)
}

/// Returns the shape of STEP, `u² (3 − 2u)`.
#[inline(always)]
pub fn cubic<S: Scalar>(u: S) -> S {
    u * u * (S::constant(3.0) - (u + u))
}

/// Returns the shape of STEP5, `u³ (10 − 15u + 6u²)`.
#[inline(always)]
pub fn quintic<S: Scalar>(u: S) -> S {
    u * u * u * (S::constant(10.0) + u * (u.scale(6.0) - S::constant(15.0)))
}

/// Returns the shape of HAVSIN, `sin²(π u/2) = (1 − cos π u)/2`.
#[inline(always)]
pub fn haversine<S: Scalar>(u: S) -> S {
    u.scale(std::f64::consts::FRAC_PI_2).sin().square()
}

/// Returns the turns made by a sweep at `x`; its frequency rises from `f0` to `f1` between `x0` and
/// `x1`.
///
/// ```text
/// P = f0 x                                              x ≤ x0
/// P = f0 x + (f1 − f0)/(2 (x1 − x0)) (x − x0)²
/// P = f1 x − (f1 − f0)/2 (x1 + x0)                      x ≥ x1
/// ```
#[inline(always)]
pub fn sweep_turns<S: Scalar>(x: S, x0: S, f0: S, x1: S, f1: S) -> S {
    S::choose(
        x.le(x0),
        || f0 * x,
        || {
            S::choose(
                x1.le(x),
                || f1 * x - (f1 - f0).scale(0.5) * (x1 + x0),
                || f0 * x + (f1 - f0).scale(0.5) / (x1 - x0) * (x - x0).square(),
            )
        },
    )
}
