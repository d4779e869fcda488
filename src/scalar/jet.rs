//! A number with its first and second derivative in time: value, rate, acceleration.

use super::{Mask, Scalar, elementary_functions, operators, value_part_comparisons};

/// A value with its first two derivatives along one direction, usually time.
///
/// Not scaled by factorials: `second` is the second derivative itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<S = f64> {
    /// value
    pub value: S,
    /// first derivative
    pub first: S,
    /// second derivative
    pub second: S,
}

impl<S: Scalar> Jet<S> {
    /// Creates the variable itself: slope one, no curvature.
    #[inline(always)]
    pub fn variable(value: S) -> Self {
        Self {
            value,
            first: S::one(),
            second: S::zero(),
        }
    }
    /// Creates a jet from a value and its two derivatives.
    #[inline(always)]
    pub fn new(value: S, first: S, second: S) -> Self {
        Self {
            value,
            first,
            second,
        }
    }

    #[inline(always)]
    fn sum(self, b: Self) -> Self {
        Self::new(
            self.value + b.value,
            self.first + b.first,
            self.second + b.second,
        )
    }
    #[inline(always)]
    fn difference(self, b: Self) -> Self {
        Self::new(
            self.value - b.value,
            self.first - b.first,
            self.second - b.second,
        )
    }
    #[inline(always)]
    fn product(self, b: Self) -> Self {
        let a = self;
        Self::new(
            a.value * b.value,
            a.first * b.value + a.value * b.first,
            a.second * b.value + (a.first * b.first).scale(2.0) + a.value * b.second,
        )
    }
    #[inline(always)]
    fn quotient(self, b: Self) -> Self {
        // from a = q b, differentiated twice
        let a = self;
        let q = a.value / b.value;
        let q1 = (a.first - q * b.first) / b.value;
        let q2 = (a.second - (q1 * b.first).scale(2.0) - q * b.second) / b.value;
        Self::new(q, q1, q2)
    }
    #[inline(always)]
    fn negative(self) -> Self {
        Self::new(-self.value, -self.first, -self.second)
    }
    /// Applies a function by the chain rule, from its value, first and second derivative at the
    /// value part.
    #[inline(always)]
    fn chain(self, f: S, d1: S, d2: impl FnOnce() -> S) -> Self {
        if self.is_value_only() {
            return Self::from_value(f);
        }
        let second = if self.second.is_known_zero() {
            S::zero()
        } else {
            d1 * self.second
        };
        let curvature = if self.first.is_known_zero() {
            S::zero()
        } else {
            d2() * self.first * self.first
        };
        let first = if self.first.is_known_zero() {
            S::zero()
        } else {
            d1 * self.first
        };
        Self::new(f, first, second + curvature)
    }
    #[inline(always)]
    fn value_part(&self) -> S {
        self.value
    }
    #[inline(always)]
    fn value_part_mut(&mut self) -> &mut S {
        &mut self.value
    }
    #[inline(always)]
    fn from_value(value: S) -> Self {
        Self::new(value, S::zero(), S::zero())
    }
    #[inline(always)]
    fn from_steps(value: S) -> Self {
        Self::new(value, value.rate_of_steps(), S::zero())
    }
    #[inline(always)]
    fn is_value_only(&self) -> bool {
        self.first.is_known_zero() && self.second.is_known_zero()
    }
}

operators!([S: Scalar] Jet<S>);

impl<S: Scalar> Scalar for Jet<S> {
    value_part_comparisons!(S);

    #[inline(always)]
    fn select(mask: S::Mask, yes: Self, no: Self) -> Self {
        Self::new(
            S::select(mask, yes.value, no.value),
            S::select(mask, yes.first, no.first),
            S::select(mask, yes.second, no.second),
        )
    }
    #[inline(always)]
    fn scale(self, factor: f64) -> Self {
        Self::new(
            self.value.scale(factor),
            self.first.scale(factor),
            self.second.scale(factor),
        )
    }
    #[inline(always)]
    fn kept_with(self, x: Self) -> Self {
        Self::new(self.value.kept_with(x.value), self.first, self.second)
    }
    elementary_functions!(S);
}
