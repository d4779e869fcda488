//! The germ of a function on one side of a point: its behaviour just beside that point.
//!
//! ```text
//! f(t₀ ± τ) = Σ cₑ τᵉ + O(τᵇ)      τ > 0 small
//! ```
//!
//! Exponents need not be integers: `p**1.5` at p = 0 is `τ^1.5`, and `1/p` is `τ⁻¹`. Comparisons
//! are decided by the leading term of the difference: just beside a switching point it is known
//! which side is taken. So any formula gives its one-sided limits and derivatives by running once,
//! and two runs, to the left and to the right, determine its jumps exactly.
//!
//! Every coefficient carries an estimate of its rounding error; one that is not clearly larger
//! counts as zero.

use super::hypot;
use super::{Scalar, Table};
use std::sync::Arc;

/// Number of derivatives that are known, the value included.
pub const ORDERS: usize = 6;

/// Exponent from which on terms are dropped.
const END_EXPONENT: f64 = ORDERS as f64;
/// Most terms of a germ.
const MOST_TERMS: usize = 24;
/// Difference below which two exponents are equal.
const SAME_EXPONENT: f64 = 1e-9;
/// Ratio of a coefficient to its estimated rounding error up to which it counts as zero.
const SIGNIFICANT_RATIO: f64 = 16.0;

#[derive(Clone, Copy, Debug, Default)]
struct Term {
    exponent: f64,
    coefficient: f64,
    /// estimate of the rounding error of the coefficient
    noise: f64,
}

/// A function just beside a point.
#[derive(Clone, Copy, Debug)]
pub struct Germ {
    /// number of terms that count
    len: usize,
    /// terms by increasing exponent; the first `n` count
    terms: [Term; MOST_TERMS],
    /// exponent below which all terms are known; −∞ where there is no function
    below: f64,
}

impl Germ {
    /// Returns the germ of no function: nothing is known of it.
    fn undefined() -> Self {
        Self {
            len: 0,
            terms: [Term::default(); MOST_TERMS],
            below: f64::NEG_INFINITY,
        }
    }

    fn zero_germ() -> Self {
        Self {
            below: f64::INFINITY,
            ..Self::undefined()
        }
    }

    fn of_term(exponent: f64, coefficient: f64, noise: f64) -> Self {
        if !coefficient.is_finite() || !noise.is_finite() {
            return Self::undefined();
        }
        let mut germ = Self::zero_germ();
        germ.push(exponent, coefficient, noise);
        germ
    }

    /// Returns the line through `at` with this slope in τ: a variable just beside a point.
    pub fn line(at: f64, slope: f64) -> Self {
        let mut germ = Self::of_term(0.0, at, at.abs() * f64::EPSILON);
        germ.push(1.0, slope, 0.0);
        germ
    }

    /// Returns whether there is a function at all, finite or not.
    pub fn is_defined(&self) -> bool {
        0.0 < self.below
    }

    fn terms(&self) -> &[Term] {
        &self.terms[..self.len]
    }

    /// Adds a term.
    fn push(&mut self, exponent: f64, coefficient: f64, noise: f64) {
        if exponent >= END_EXPONENT - SAME_EXPONENT {
            self.below = self.below.min(END_EXPONENT);
            return;
        }
        let at = self
            .terms()
            .partition_point(|t| t.exponent < exponent - SAME_EXPONENT);
        if at < self.len && (self.terms[at].exponent - exponent).abs() <= SAME_EXPONENT {
            let term = &mut self.terms[at];
            let sum = term.coefficient + coefficient;
            term.noise += noise + sum.abs() * f64::EPSILON;
            term.coefficient = sum;
            return;
        }
        if at >= MOST_TERMS {
            self.below = self.below.min(exponent);
            return;
        }
        if self.len == MOST_TERMS {
            self.len -= 1;
            self.below = self.below.min(self.terms[self.len].exponent);
        }
        self.terms.copy_within(at..self.len, at + 1);
        self.terms[at] = Term {
            exponent,
            coefficient,
            noise,
        };
        self.len += 1;
    }

    /// Sets insignificant coefficients to zero and drops terms that are no longer known.
    fn settled(mut self) -> Self {
        let below = self.below;
        self.len = self
            .terms()
            .partition_point(|t| t.exponent < below - SAME_EXPONENT);
        for term in &mut self.terms[..self.len] {
            if !term.coefficient.is_finite() || !term.noise.is_finite() {
                return Self::undefined();
            }
            if term.coefficient.abs() <= SIGNIFICANT_RATIO * term.noise {
                term.coefficient = 0.0;
            }
        }
        self
    }

    /// Returns the first term that is not zero.
    fn leading(&self) -> Option<Term> {
        self.terms().iter().copied().find(|t| t.coefficient != 0.0)
    }

    /// Returns the exponent of the leading term, or the one from which nothing is known.
    fn lead(&self) -> f64 {
        self.leading().map_or(self.below, |t| t.exponent)
    }

    /// Returns the sign just beside the point, or `None` where there is no function.
    fn sign(&self) -> Option<f64> {
        if self.below == f64::NEG_INFINITY {
            return None;
        }
        Some(self.leading().map_or(0.0, |t| t.coefficient.signum()))
    }

    /// Returns coefficient and rounding error of τ⁰.
    fn constant_term(&self) -> (f64, f64) {
        self.terms()
            .iter()
            .find(|t| t.exponent.abs() <= SAME_EXPONENT)
            .map_or((0.0, 0.0), |t| (t.coefficient, t.noise))
    }

    /// Returns the limit at the point: infinite at a pole, NaN where there is no function.
    pub fn limit(&self) -> f64 {
        self.derivative_at(0).0
    }

    /// Returns the one-sided derivative of order `k` with respect to τ, and an estimate of its
    /// rounding error. The derivative is infinite where it grows without bound, NaN where it is not
    /// known.
    pub fn derivative_at(&self, k: usize) -> (f64, f64) {
        let order = k as f64;
        let mut found = (0.0, 0.0);
        let falling = |e: f64| (0..k).map(|j| e - j as f64).product::<f64>();
        for term in self.terms() {
            let whole = (term.exponent - term.exponent.round()).abs() <= SAME_EXPONENT;
            if (term.exponent - order).abs() <= SAME_EXPONENT {
                found = (
                    term.coefficient * falling(order),
                    term.noise * falling(order),
                );
            } else if term.exponent < order
                && term.coefficient != 0.0
                && (!whole || term.exponent < -SAME_EXPONENT)
            {
                return (
                    (term.coefficient * falling(term.exponent)) * f64::INFINITY,
                    0.0,
                );
            }
        }
        if order >= self.below - SAME_EXPONENT {
            return (f64::NAN, 0.0);
        }
        found
    }

    fn sum(self, b: Self, sign: f64) -> Self {
        let mut germ = self;
        germ.below = self.below.min(b.below);
        for t in b.terms() {
            germ.push(t.exponent, sign * t.coefficient, t.noise);
        }
        germ.settled()
    }

    /// Returns the product.
    fn product(self, b: Self) -> Self {
        if self.below == f64::NEG_INFINITY || b.below == f64::NEG_INFINITY {
            return Self::undefined();
        }
        let mut germ = Self::zero_germ();
        germ.below = (self.below + b.lead()).min(b.below + self.lead());
        for s in self.terms() {
            for t in b.terms() {
                let c = s.coefficient * t.coefficient;
                let noise = s.coefficient.abs() * t.noise
                    + t.coefficient.abs() * s.noise
                    + s.noise * t.noise
                    + c.abs() * f64::EPSILON;
                if c != 0.0 || noise != 0.0 {
                    germ.push(s.exponent + t.exponent, c, noise);
                }
            }
        }
        germ.settled()
    }

    /// Returns τ to the power `by` times the germ.
    fn shifted(mut self, by: f64) -> Self {
        for term in &mut self.terms[..self.len] {
            term.exponent += by;
        }
        self.below += by;
        if self.below.is_nan() || self.below > END_EXPONENT && self.below.is_finite() {
            self.below = END_EXPONENT;
        }
        self.settled()
    }

    /// Returns the germ times a factor.
    fn scaled(mut self, factor: f64) -> Self {
        if !factor.is_finite() {
            return Self::undefined();
        }
        for term in &mut self.terms[..self.len] {
            term.coefficient *= factor;
            term.noise = term.noise * factor.abs() + term.coefficient.abs() * f64::EPSILON;
        }
        self.settled()
    }

    /// Returns `Σ fₖ rᵏ` with `r` = this germ without its limit; `f(k, limit)` yields the Taylor
    /// coefficients.
    fn compose(self, f: impl Fn(usize, f64) -> f64) -> Self {
        if !self.is_defined() || self.lead() < -SAME_EXPONENT {
            return Self::undefined();
        }
        let (at, noise) = self.constant_term();
        let mut r = self;
        if let Some(t) = r.terms[..r.len]
            .iter_mut()
            .find(|t| t.exponent.abs() <= SAME_EXPONENT)
        {
            t.coefficient = 0.0;
        }
        let term = |k: usize| {
            let c = f(k, at);
            Self::of_term(0.0, c, c.abs() * f64::EPSILON)
        };
        if r.leading().is_none() && r.below == f64::INFINITY {
            let value = f(0, at);
            let steep = f(1, at);
            let steep = if steep.is_finite() { steep.abs() } else { 0.0 };
            return Self::of_term(0.0, value, value.abs() * f64::EPSILON + steep * noise).settled();
        }
        // terms of rᵏ begin at k·lead
        let lead = r.lead();
        let last = ((END_EXPONENT / lead).ceil() as usize).clamp(1, 2 * ORDERS);
        let mut sum = term(last);
        for k in (0..last).rev() {
            sum = sum.product(r).sum(term(k), 1.0);
        }
        sum.below = sum.below.min((last + 1) as f64 * lead);
        sum.settled()
    }

    /// Returns the power with a constant exponent; a negative base needs an integer one.
    fn power(self, e: f64) -> Self {
        let Some(sign) = self.sign() else {
            return Self::undefined();
        };
        if e == 0.0 {
            return Self::of_term(0.0, 1.0, 0.0);
        }
        let Some(first) = self.leading() else {
            // zero as far as known
            return if e > 0.0 {
                let mut zero = Self::zero_germ();
                zero.below = self.below * e;
                zero
            } else {
                Self::undefined()
            };
        };
        if sign < 0.0 && e != e.trunc() {
            return Self::undefined();
        }
        // c τᵅ (1 + u)
        let (c, alpha) = (first.coefficient, first.exponent);
        let mut u = self;
        for t in &mut u.terms[..u.len] {
            // everything before the leading term is rounding
            if t.exponent <= alpha + SAME_EXPONENT {
                (t.coefficient, t.noise) = (0.0, 0.0);
            }
        }
        let u = u.shifted(-alpha).scaled(1.0 / c);
        let one = Self::of_term(0.0, 1.0, 0.0);
        let (mut sum, mut term, mut k) = (one, one, 0.0);
        let lead = u.lead();
        while u.leading().is_some() && k < 2.0 * END_EXPONENT && k * lead < END_EXPONENT {
            term = term.product(u).scaled((e - k) / (k + 1.0));
            sum = sum.sum(term, 1.0);
            k += 1.0;
            if e == k {
                break;
            }
        }
        let complete = e == k && e > 0.0 || u.leading().is_none();
        sum.below = sum.below.min(u.below);
        if !complete {
            sum.below = sum.below.min((k + 1.0) * lead).min(END_EXPONENT);
        }
        let outer = Scalar::powf(c, e);
        let mut result = sum.scaled(outer);
        let relative = (e * first.noise / c).abs();
        for t in &mut result.terms[..result.len] {
            t.noise += t.coefficient.abs() * relative;
        }
        result.shifted(alpha * e)
    }

    /// Returns the derivative with respect to τ.
    fn derivative(self) -> Self {
        let mut germ = Self::zero_germ();
        germ.below = self.below - 1.0;
        for t in self
            .terms()
            .iter()
            .filter(|t| t.exponent.abs() > SAME_EXPONENT)
        {
            germ.push(
                t.exponent - 1.0,
                t.coefficient * t.exponent,
                t.noise * t.exponent.abs(),
            );
        }
        germ.settled()
    }

    /// Returns the function with this derivative and this limit.
    fn integral(self, limit: f64, noise: f64) -> Self {
        let mut germ = Self::of_term(0.0, limit, noise + limit.abs() * f64::EPSILON);
        germ.below = germ.below.min(self.below + 1.0);
        for t in self.terms() {
            let e = t.exponent + 1.0;
            if t.coefficient != 0.0 && e.abs() <= SAME_EXPONENT {
                // the integral of τ⁻¹ is a logarithm, which is no germ
                return Self::undefined();
            }
            if t.coefficient != 0.0 || e.abs() > SAME_EXPONENT {
                germ.push(e, t.coefficient / e, t.noise / e.abs());
            }
        }
        germ.settled()
    }

    /// Returns a function from its value at the limit and its derivative as a formula.
    fn through_derivative(self, value: impl Fn(f64) -> f64, slope: impl Fn(Self) -> Self) -> Self {
        if !self.is_defined() || self.lead() < -SAME_EXPONENT {
            return Self::undefined();
        }
        let (at, noise) = self.constant_term();
        let steep = slope(Self::of_term(0.0, at, 0.0)).limit();
        let noise = if steep.is_finite() {
            noise * steep.abs()
        } else {
            noise.sqrt()
        };
        let rate = self.derivative();
        if rate.leading().is_none() && self.below == f64::INFINITY {
            return Self::of_term(0.0, value(at), noise);
        }
        slope(self).product(rate).integral(value(at), noise)
    }

    /// Returns whether the absolute value is at most 1 beside the point.
    fn is_cosine(self) -> bool {
        (Self::one() - self * self).sign().is_some_and(|s| s >= 0.0)
    }

    /// Returns the limit rounded to an integer, and, if the limit is an integer as far as known,
    /// the sign of the rest.
    fn whole(&self) -> (f64, Option<f64>) {
        let (c, noise) = self.constant_term();
        let n = c.round();
        if (c - n).abs() > (SIGNIFICANT_RATIO * noise).max(4.0 * f64::EPSILON * c.abs()) {
            return (c, None);
        }
        let mut rest = *self;
        for t in &mut rest.terms[..rest.len] {
            if t.exponent.abs() <= SAME_EXPONENT {
                t.coefficient = 0.0;
            }
        }
        (n, Some(rest.sign().unwrap_or(0.0)))
    }

    /// Rounds: by `of` where the limit is not an integer, by `beside` just beside an integer.
    fn rounded(self, of: impl Fn(f64) -> f64, beside: impl Fn(f64, f64) -> f64) -> Self {
        if !self.is_defined() || self.lead() < -SAME_EXPONENT {
            return Self::undefined();
        }
        // rounding so large leaves the integer unknown
        if SIGNIFICANT_RATIO * self.constant_term().1 >= 0.5 {
            return Self::undefined();
        }
        let value = match self.whole() {
            (c, None) => of(c),
            (n, Some(sign)) => beside(n, sign),
        };
        Self::of_term(0.0, value, 0.0)
    }
}

impl std::ops::Add for Germ {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        self.sum(b, 1.0)
    }
}
impl std::ops::Sub for Germ {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self.sum(b, -1.0)
    }
}
impl std::ops::Mul for Germ {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        self.product(b)
    }
}
impl std::ops::Div for Germ {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        self.product(b.power(-1.0))
    }
}
impl std::ops::Neg for Germ {
    type Output = Self;
    fn neg(self) -> Self {
        self.scaled(-1.0)
    }
}
impl std::ops::AddAssign for Germ {
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
impl std::ops::SubAssign for Germ {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

fn factorial(k: usize) -> f64 {
    (1..=k).map(|j| j as f64).product()
}

/// Returns the `k`-th of four derivatives that repeat in turn.
fn turning(k: usize, four: [f64; 4]) -> f64 {
    four[k % 4] / factorial(k)
}

impl Scalar for Germ {
    type Mask = bool;

    fn constant(x: f64) -> Self {
        if x == 0.0 {
            Self::zero_germ()
        } else {
            Self::of_term(0.0, x, x.abs() * f64::EPSILON)
        }
    }
    fn known(&self) -> Option<f64> {
        let constant = self.below == f64::INFINITY
            && self
                .terms()
                .iter()
                .all(|t| t.coefficient == 0.0 || t.exponent.abs() <= SAME_EXPONENT);
        constant.then(|| self.constant_term().0)
    }
    fn lt(self, other: Self) -> bool {
        (self - other).sign().is_some_and(|s| s < 0.0)
    }
    fn le(self, other: Self) -> bool {
        (self - other).sign().is_some_and(|s| s <= 0.0)
    }
    fn same(self, other: Self) -> bool {
        (self - other).sign() == Some(0.0)
    }
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    fn sqrt(self) -> Self {
        self.power(0.5)
    }
    fn sin(self) -> Self {
        self.compose(|k, x| {
            let (s, c) = Scalar::sin_cos(x);
            turning(k, [s, c, -s, -c])
        })
    }
    fn cos(self) -> Self {
        self.compose(|k, x| {
            let (s, c) = Scalar::sin_cos(x);
            turning(k, [c, -s, -c, s])
        })
    }
    fn tan(self) -> Self {
        self.sin() / self.cos()
    }
    fn asin(self) -> Self {
        if !self.is_cosine() {
            return Self::undefined();
        }
        self.through_derivative(
            |x| Scalar::asin(x.clamp(-1.0, 1.0)),
            |x| (Self::one() - x * x).power(-0.5),
        )
    }
    fn acos(self) -> Self {
        if !self.is_cosine() {
            return Self::undefined();
        }
        self.through_derivative(
            |x| Scalar::acos(x.clamp(-1.0, 1.0)),
            |x| -(Self::one() - x * x).power(-0.5),
        )
    }
    fn atan(self) -> Self {
        self.through_derivative(Scalar::atan, |x| (Self::one() + x * x).power(-1.0))
    }
    fn atan2(self, x: Self) -> Self {
        let y = self;
        let (Some(y_sign), Some(_)) = (y.sign(), x.sign()) else {
            return Self::undefined();
        };
        let lead = y.lead().min(x.lead());
        let part = |g: &Self| {
            g.leading()
                .filter(|t| t.exponent <= lead + SAME_EXPONENT)
                .map_or(0.0, |t| t.coefficient)
        };
        let (y0, x0) = (part(&y), part(&x));
        // a zero y counts as positive
        let limit = if y0 == 0.0 && y_sign < 0.0 {
            Scalar::atan2(-0.0f64, x0)
        } else {
            Scalar::atan2(y0 + 0.0, x0)
        };
        if y0 == 0.0 && x0 == 0.0 {
            return Self::undefined();
        }
        let rate = (x * y.derivative() - y * x.derivative()) / (x * x + y * y);
        if rate.leading().is_none() {
            return Self::of_term(0.0, limit, limit.abs() * f64::EPSILON);
        }
        let noise = hypot(y.constant_term().1, x.constant_term().1) / hypot(y0, x0);
        rate.integral(limit, noise)
    }
    fn sinh(self) -> Self {
        self.compose(|k, x| {
            let (s, c) = (Scalar::sinh(x), Scalar::cosh(x));
            turning(k, [s, c, s, c])
        })
    }
    fn cosh(self) -> Self {
        self.compose(|k, x| {
            let (s, c) = (Scalar::sinh(x), Scalar::cosh(x));
            turning(k, [c, s, c, s])
        })
    }
    fn tanh(self) -> Self {
        self.through_derivative(Scalar::tanh, |x| x.cosh().power(-2.0))
    }
    fn exp(self) -> Self {
        self.compose(|k, x| Scalar::exp(x) / factorial(k))
    }
    fn ln(self) -> Self {
        if self.sign().is_none_or(|s| s <= 0.0) {
            return Self::undefined();
        }
        self.through_derivative(Scalar::ln, |x| x.power(-1.0))
    }
    fn log10(self) -> Self {
        self.ln().scaled(std::f64::consts::LOG10_E)
    }
    fn powi(self, n: i32) -> Self {
        self.power(f64::from(n))
    }
    fn powf(self, exponent: Self) -> Self {
        match exponent.known() {
            Some(e) => self.power(e),
            None => (exponent * self.ln()).exp(),
        }
    }
    fn abs(self) -> Self {
        match self.sign() {
            None => Self::undefined(),
            Some(s) if s < 0.0 => -self,
            Some(_) => self,
        }
    }
    fn trunc(self) -> Self {
        self.rounded(f64::trunc, |n, side| {
            if n > 0.0 && side < 0.0 {
                n - 1.0
            } else if n < 0.0 && side > 0.0 {
                n + 1.0
            } else {
                n
            }
        })
    }
    fn floor(self) -> Self {
        self.rounded(f64::floor, |n, side| if side < 0.0 { n - 1.0 } else { n })
    }
    fn round(self) -> Self {
        let half = Self::constant(0.5);
        let negative = self.sign().is_some_and(|s| s < 0.0);
        let away = self.abs() + half;
        let rounded = away.floor();
        if negative { -rounded } else { rounded }
    }
    fn rem(self, other: Self) -> Self {
        self - (self / other).trunc() * other
    }
    fn kept_with(self, x: Self) -> Self {
        if x.is_defined() { self } else { x }
    }
    fn lookup(self, table: &Arc<dyn Table>, order: u32) -> Self {
        if !self.is_defined() || self.lead() < -SAME_EXPONENT {
            return Self::undefined();
        }
        let (x, noise) = self.constant_term();
        let knots = table.knots();
        let right = knots.partition_point(|&k| k < x);
        let near = |k: &&f64| {
            (x - **k).abs() <= (SIGNIFICANT_RATIO * noise).max(4.0 * f64::EPSILON * x.abs())
        };
        let around = &knots[right.saturating_sub(1)..(right + 1).min(knots.len())];
        let x = around.iter().find(near).copied().unwrap_or(x);
        let mut rest = self;
        for t in &mut rest.terms[..rest.len] {
            if t.exponent.abs() <= SAME_EXPONENT {
                t.coefficient = 0.0;
            }
        }
        let above = rest.sign().is_none_or(|s| s >= 0.0);
        self.compose(|k, _| table.beside(x, above, order + k as u32) / factorial(k))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn derivatives(g: Germ) -> Vec<f64> {
        (0..4).map(|k| g.derivative_at(k).0).collect()
    }

    #[test]
    fn elementary_functions_have_their_taylor_series() {
        let x = Germ::line(0.5, 1.0);
        let e = 0.5f64.exp();
        for (got, want) in [
            (x.exp(), [e, e, e, e]),
            (x * x * x, [0.125, 0.75, 3.0, 6.0]),
            (x.recip(), [2.0, -4.0, 16.0, -96.0]),
            (x.ln(), [0.5f64.ln(), 2.0, -4.0, 16.0]),
            (x.powi(-2), [4.0, -16.0, 96.0, -768.0]),
            (x.atan(), [0.5f64.atan(), 0.8, -0.64, -0.256]),
            (x.tanh(), {
                let (t, s) = (0.5f64.tanh(), 1.0 - 0.5f64.tanh().powi(2));
                [t, s, -2.0 * t * s, -2.0 * s * s + 4.0 * t * t * s]
            }),
        ] {
            for (g, w) in derivatives(got).into_iter().zip(want) {
                assert!((g - w).abs() < 1e-12 * w.abs().max(1.0), "{g} {w}");
            }
        }
        let identity = x.sin().asin();
        assert!((identity.limit() - 0.5).abs() < 1e-15);
        assert!((identity.derivative_at(1).0 - 1.0).abs() < 1e-14);
        assert!(identity.derivative_at(3).0.abs() < 1e-12);
    }

    #[test]
    fn powers_that_are_not_whole_keep_their_exponent() {
        let p = Germ::line(0.0, 1.0);
        assert_eq!(
            derivatives(p.powf(Germ::constant(1.5))),
            [0.0, 0.0, f64::INFINITY, -f64::INFINITY]
        );
        assert_eq!(
            derivatives(p.sqrt() * p),
            [0.0, 0.0, f64::INFINITY, -f64::INFINITY]
        );
        assert_eq!(derivatives(p.sqrt() * p.sqrt()), [0.0, 1.0, 0.0, 0.0]);
        assert!(!Germ::line(0.0, -1.0).sqrt().is_defined());
        assert_eq!(p.recip().limit(), f64::INFINITY);
        assert_eq!((p.sin() / p).limit(), 1.0);
        let near = Germ::line(1.0, -1.0).acos();
        assert_eq!(near.derivative_at(1).0, f64::INFINITY);
        assert_eq!(near.limit(), 0.0);
    }

    #[test]
    fn comparisons_and_roundings_know_the_side() {
        let (after, before) = (Germ::line(2.0, 1.0), Germ::line(2.0, -1.0));
        let two = Germ::constant(2.0);
        assert!(two.lt(after) && before.lt(two) && !two.same(after));
        assert_eq!((after.floor().limit(), before.floor().limit()), (2.0, 1.0));
        assert_eq!((after.trunc().limit(), before.trunc().limit()), (2.0, 1.0));
        let half = |s| Germ::line(-2.5, s).round().limit();
        assert_eq!((half(1.0), half(-1.0)), (-2.0, -3.0));
        // sin π is zero but for rounding
        assert!(Germ::line(std::f64::consts::PI, 1.0).sin().lt(Germ::zero()));
        assert!(Germ::zero().lt(Germ::line(std::f64::consts::PI, -1.0).sin()));
        let angle = |slope: f64| Germ::line(0.0, slope).atan2(Germ::constant(-1.0));
        assert_eq!(angle(1.0).limit(), std::f64::consts::PI);
        assert_eq!(angle(-1.0).limit(), -std::f64::consts::PI);
        assert_eq!(angle(1.0).derivative_at(1).0, -1.0);
    }
}
