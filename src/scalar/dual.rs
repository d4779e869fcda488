//! A number with its derivatives along `N` directions (first order, forward mode).

use super::{Mask, Scalar, elementary_functions, operators, value_part_comparisons};

/// `re + Σ eps[k] εₖ` with εᵢ εⱼ = 0: a value and `N` partial derivatives.
///
/// Generic over its components, so that a dual of jets or of recorded nodes needs no code of its
/// own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize, S = f64> {
    /// value
    pub re: S,
    /// derivatives, one per direction   (N)
    pub eps: [S; N],
}

impl<const N: usize, S: Scalar> Dual<N, S> {
    /// Creates the variable of direction `k`: slope one along it, zero along the others.
    #[inline(always)]
    pub fn variable(re: S, k: usize) -> Self {
        let mut eps = [S::zero(); N];
        eps[k] = S::one();
        Self { re, eps }
    }

    #[inline(always)]
    fn map(self, re: S, f: impl Fn(S) -> S) -> Self {
        let mut eps = self.eps;
        for x in &mut eps {
            *x = f(*x);
        }
        Self { re, eps }
    }
    #[inline(always)]
    fn map2(self, other: Self, re: S, f: impl Fn(S, S) -> S) -> Self {
        // loops, not functions of arrays: those are not always inlined
        let mut eps = self.eps;
        for (x, y) in eps.iter_mut().zip(other.eps) {
            *x = f(*x, y);
        }
        Self { re, eps }
    }
    #[inline(always)]
    fn sum(self, b: Self) -> Self {
        self.map2(b, self.re + b.re, |x, y| x + y)
    }
    #[inline(always)]
    fn difference(self, b: Self) -> Self {
        self.map2(b, self.re - b.re, |x, y| x - y)
    }
    #[inline(always)]
    fn product(self, b: Self) -> Self {
        self.map2(b, self.re * b.re, |x, y| x * b.re + self.re * y)
    }
    #[inline(always)]
    fn quotient(self, b: Self) -> Self {
        let q = self.re / b.re;
        let per_b = b.re.recip();
        self.map2(b, q, |x, y| (x - q * y) * per_b)
    }
    #[inline(always)]
    fn negative(self) -> Self {
        self.map(-self.re, |x| -x)
    }
    #[inline(always)]
    fn chain(self, f: S, d1: S, _d2: impl FnOnce() -> S) -> Self {
        self.map(f, |x| if x.is_known_zero() { x } else { d1 * x })
    }
    #[inline(always)]
    fn value_part(&self) -> S {
        self.re
    }
    #[inline(always)]
    fn value_part_mut(&mut self) -> &mut S {
        &mut self.re
    }
    #[inline(always)]
    fn from_value(re: S) -> Self {
        Self {
            re,
            eps: [S::zero(); N],
        }
    }
    #[inline(always)]
    fn from_steps(re: S) -> Self {
        Self {
            re,
            eps: [re.rate_of_steps(); N],
        }
    }
    #[inline(always)]
    fn is_value_only(&self) -> bool {
        self.eps.iter().all(Scalar::is_known_zero)
    }
}

operators!([const N: usize, S: Scalar] Dual<N, S>);

impl<const N: usize, S: Scalar> Scalar for Dual<N, S> {
    value_part_comparisons!(S);

    #[inline(always)]
    fn select(mask: S::Mask, yes: Self, no: Self) -> Self {
        yes.map2(no, S::select(mask, yes.re, no.re), |x, y| {
            S::select(mask, x, y)
        })
    }
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        self.map(self.re.scale(factor), |x| x.scale(factor))
    }
    #[inline(always)]
    fn kept_with(self, x: Self) -> Self {
        Self {
            re: self.re.kept_with(x.re),
            eps: self.eps,
        }
    }
    elementary_functions!(S);
}
