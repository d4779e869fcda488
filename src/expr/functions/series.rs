//! Sums of powers, Chebyshev polynomials and harmonics.
//!
//! Coefficients are numbers of the same kind as the variable, or plain numbers that `of` turns into
//! such.
//!
//! Harmonics come from one sine and one cosine: `e^(i j θ)` are the powers of `e^(i θ)`. Four
//! powers proceed side by side, each by the fourth; the error of the j-th is that of rounding
//! `j θ`, for every θ. (The recurrence of Clenshaw takes fewer operations, but loses digits near θ
//! = 0 and π, and each of its steps waits for the one before.)

use crate::scalar::Scalar;

/// Returns `Σ aⱼ yʲ`.
#[inline(always)]
pub fn powers<S: Scalar, A: Copy>(y: S, a: &[A], of: impl Fn(A) -> S) -> S {
    let Some((&last, rest)) = a.split_last() else {
        return S::zero();
    };
    let mut sum = of(last);
    for &aj in rest.iter().rev() {
        sum = sum * y + of(aj);
    }
    sum
}

/// Returns `Σ aⱼ Tⱼ(y)`, by the recurrence of Clenshaw.
#[inline(always)]
pub fn chebyshev<S: Scalar, A: Copy>(y: S, a: &[A], of: impl Fn(A) -> S) -> S {
    let Some((&a0, rest)) = a.split_first() else {
        return S::zero();
    };
    let Some((&last, rest)) = rest.split_last() else {
        return of(a0);
    };
    let twice = y + y;
    let (mut b1, mut b2) = (of(last), S::zero());
    for &aj in rest.iter().rev() {
        (b1, b2) = (twice * b1 + (of(aj) - b2), b1);
    }
    y * b1 + (of(a0) - b2)
}

/// Returns `a₀ + Σ aⱼ cos(j θ)`.
#[inline(always)]
pub fn cosines<S: Scalar, A: Copy>(theta: S, a: &[A], of: impl Fn(A) -> S) -> S {
    harmonics(theta, a, of, |(cosine, _)| cosine)
}

/// Returns `a₀ + Σ aⱼ sin(j θ)`.
#[inline(always)]
pub fn sines<S: Scalar, A: Copy>(theta: S, a: &[A], of: impl Fn(A) -> S) -> S {
    harmonics(theta, a, of, |(_, sine)| sine)
}

/// Sums harmonics; `part` of each power of `e^(i θ)` counts, its real or imaginary part.
#[inline(always)]
fn harmonics<S: Scalar, A: Copy>(
    theta: S,
    a: &[A],
    of: impl Fn(A) -> S,
    part: impl Fn((S, S)) -> S,
) -> S {
    let Some((&a0, rest)) = a.split_first() else {
        return S::zero();
    };
    let (s, c) = theta.sin_cos();
    let first = (c, s);
    let second = product(first, first);
    let fourth = product(second, second);
    let mut turned = [first, second, product(second, first), fourth];
    let mut sums = [of(a0), S::zero(), S::zero(), S::zero()];
    let mut rest = rest.chunks(4);
    let mut next = rest.next();
    while let Some(terms) = next {
        for ((sum, &z), &aj) in sums.iter_mut().zip(&turned).zip(terms) {
            *sum += of(aj) * part(z);
        }
        next = rest.next();
        if let Some(terms) = next {
            for (z, _) in turned.iter_mut().zip(terms) {
                *z = product(*z, fourth);
            }
        }
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3])
}

/// Multiplies complex numbers.
#[inline(always)]
fn product<S: Scalar>(a: (S, S), b: (S, S)) -> (S, S) {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}
