//! Sums of powers, Chebyshev polynomials and harmonics, each by a recurrence with one term per coefficient.
//!
//! Harmonics come from the sine and cosine of half the angle by the recurrence of Clenshaw in the form of Reinsch:
//! with `λ = −4 sin²(θ/2)` near θ = 0 and `λ = 4 cos²(θ/2)` near θ = π no digits are lost where `cos θ` is close to ±1
//! (Stoer and Bulirsch, Introduction to Numerical Analysis, 2.3.2).

use crate::scalar::{Mask, Scalar};

/// `Σ aⱼ yʲ`
#[inline(always)]
pub fn powers<S: Scalar>(y: S, a: &[S]) -> S {
    let mut terms = a.iter().rev();
    let mut sum = *terms.next().unwrap_or(&S::zero());
    for &aj in terms {
        sum = sum * y + aj;
    }
    sum
}

/// `Σ aⱼ Tⱼ(y)`
#[inline(always)]
pub fn chebyshev<S: Scalar>(y: S, a: &[S]) -> S {
    let Some((&a0, rest)) = a.split_first() else {
        return S::zero();
    };
    let twice = y + y;
    let (mut b1, mut b2) = (S::zero(), S::zero());
    for &aj in rest.iter().rev() {
        (b1, b2) = (twice * b1 + (aj - b2), b1);
    }
    y * b1 + (a0 - b2)
}

/// `a₀ + Σ aⱼ cos(j θ)`
#[inline(always)]
pub fn cosines<S: Scalar>(theta: S, a: &[S]) -> S {
    let Some((&a0, rest)) = a.split_first() else {
        return S::zero();
    };
    let (s, c) = theta.scale(0.5).sin_cos();
    let (lambda, b, delta) = clenshaw(s, c, rest);
    // the last step, with δ₀ in place of a further b
    a0 + (delta + lambda.scale(0.5) * b)
}

/// `a₀ + Σ aⱼ sin(j θ)`
#[inline(always)]
pub fn sines<S: Scalar>(theta: S, a: &[S]) -> S {
    let Some((&a0, rest)) = a.split_first() else {
        return S::zero();
    };
    let (s, c) = theta.scale(0.5).sin_cos();
    let (_, b, _) = clenshaw(s, c, rest);
    a0 + b * (s * c).scale(2.0)
}

/// λ, `b₁`, and `±δ₁` (the sign of the case), from the sine and cosine of half the angle.
///
/// ```text
/// bⱼ = aⱼ + 2 cos θ bⱼ₊₁ − bⱼ₊₂,   δⱼ = bⱼ ∓ bⱼ₊₁ = aⱼ + λ bⱼ₊₁ ± δⱼ₊₁
/// ```
#[inline(always)]
fn clenshaw<S: Scalar>(s: S, c: S, a: &[S]) -> (S, S, S) {
    let (s2, c2) = (s * s, c * c);
    let near_zero = s2.lt(c2);
    match near_zero.known() {
        Some(true) => reinsch(s2.scale(-4.0), S::one(), a),
        Some(false) => reinsch(c2.scale(4.0), -S::one(), a),
        None => {
            let one = S::one();
            reinsch(
                S::select(near_zero, s2.scale(-4.0), c2.scale(4.0)),
                S::select(near_zero, one, -one),
                a,
            )
        }
    }
}

#[inline(always)]
fn reinsch<S: Scalar>(lambda: S, sign: S, a: &[S]) -> (S, S, S) {
    let (mut b, mut delta) = (S::zero(), S::zero());
    for &aj in a.iter().rev() {
        delta = aj + lambda * b + sign * delta;
        b = delta + sign * b;
    }
    (lambda, b, sign * delta)
}
