//! An interval: a number that is only known to lie between two bounds.
//!
//! ```text
//! f([a, b]) ⊇ { f(x) : a ≤ x ≤ b }
//! ```
//!
//! Evaluating a formula over an interval of its argument bounds all its values there: where the
//! bound excludes zero the formula has no root. The bound is as wide as the true range, or wider
//! where an argument is used twice; it shrinks with the interval. Rounding errors are not included:
//! a bound may be off in the last place.
//!
//! Outside the domain of a function there is no value: only the part of an argument inside the
//! domain counts, and where there is none the result is NaN.
//!
//! Source: Moore, Kearfott, Cloud, Introduction to Interval Analysis, SIAM 2009, chapters 2 and 5.

use super::{Mask, Scalar, Table, operators};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// All numbers from `lo` to `hi`; both are NaN where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// least
    pub lo: f64,
    /// greatest
    pub hi: f64,
}

/// The answer to a comparison of intervals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// true everywhere
    Yes,
    /// true nowhere
    No,
    /// true in some places, or not decided by the bounds
    Perhaps,
}

use Answer::{No, Perhaps, Yes};

impl Mask for Answer {
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (No, _) | (_, No) => No,
            (Yes, Yes) => Yes,
            _ => Perhaps,
        }
    }
    fn or(self, other: Self) -> Self {
        self.not().and(other.not()).not()
    }
    fn not(self) -> Self {
        match self {
            Yes => No,
            No => Yes,
            Perhaps => Perhaps,
        }
    }
    fn known(self) -> Option<bool> {
        match self {
            Yes => Some(true),
            No => Some(false),
            Perhaps => None,
        }
    }
}

impl Interval {
    /// The interval of no value.
    const NONE: Self = Self {
        lo: f64::NAN,
        hi: f64::NAN,
    };
    /// The interval of all values.
    pub(crate) const ANY: Self = Self {
        lo: f64::NEG_INFINITY,
        hi: f64::INFINITY,
    };

    /// Returns the interval between two numbers, in any order.
    pub fn between(a: f64, b: f64) -> Self {
        if a.is_nan() || b.is_nan() {
            return Self::ANY;
        }
        Self {
            lo: a.min(b),
            hi: a.max(b),
        }
    }

    fn is_none(self) -> bool {
        self.lo.is_nan()
    }

    /// Returns the smallest interval around both.
    fn hull(self, other: Self) -> Self {
        // `min` and `max` drop NaN
        Self {
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
        }
    }

    /// Returns the image under a monotonic function.
    fn monotone(self, f: impl Fn(f64) -> f64) -> Self {
        if self.is_none() {
            return self;
        }
        Self::between(f(self.lo), f(self.hi))
    }

    /// Returns the interval of the values at all corners of the rectangle of two intervals.
    #[inline(always)]
    fn corners(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let (a, b) = (f(self.lo, other.lo), f(self.lo, other.hi));
        let (c, d) = (f(self.hi, other.lo), f(self.hi, other.hi));
        if !((a + b) + (c + d)).is_nan() {
            let least = |x: f64, y: f64| if x < y { x } else { y };
            let most = |x: f64, y: f64| if x > y { x } else { y };
            return Self {
                lo: least(least(a, b), least(c, d)),
                hi: most(most(a, b), most(c, d)),
            };
        }
        match self.is_none() || other.is_none() {
            true => Self::NONE,
            false => Self::between(a, b).hull(Self::between(c, d)),
        }
    }

    /// Returns the part inside a domain.
    fn inside(self, lo: f64, hi: f64) -> Self {
        if self.is_none() || self.hi < lo || hi < self.lo {
            return Self::NONE;
        }
        Self {
            lo: self.lo.max(lo),
            hi: self.hi.min(hi),
        }
    }

    fn holds(self, x: f64) -> bool {
        self.lo <= x && x <= self.hi
    }

    /// Returns the image under a wave between −1 and 1 that has its crests at `crest` + 2πk and its
    /// troughs half a turn further.
    fn wave(self, crest: f64, f: impl Fn(f64) -> f64) -> Self {
        if self.is_none() {
            return self;
        }
        let width = self.hi - self.lo;
        if width.is_nan() || width >= TAU {
            return Self::between(-1.0, 1.0);
        }
        let mut image = self.monotone(f);
        // whether `at` plus a whole number of turns lies inside
        let reaches = |at: f64| ((self.lo - at) / TAU).ceil() * TAU + at <= self.hi;
        if reaches(crest) {
            image.hi = 1.0;
        }
        if reaches(crest + PI) {
            image.lo = -1.0;
        }
        image
    }

    fn sum(self, b: Self) -> Self {
        let all = Self {
            lo: self.lo + b.lo,
            hi: self.hi + b.hi,
        };
        if !(all.lo.is_nan() || all.hi.is_nan()) {
            all
        } else if self.is_none() || b.is_none() {
            Self::NONE
        } else {
            Self::ANY
        }
    }
    fn negative(self) -> Self {
        Self {
            lo: -self.hi,
            hi: -self.lo,
        }
    }
    fn difference(self, b: Self) -> Self {
        self.sum(b.negative())
    }
    fn product(self, b: Self) -> Self {
        let all = self.corners(b, |x, y| x * y);
        match all == Self::ANY {
            true => self.unbounded_product(b),
            false => all,
        }
    }
    /// Returns the product where a bound may be infinite: zero times a number between such bounds
    /// is zero.
    #[cold]
    fn unbounded_product(self, b: Self) -> Self {
        self.corners(b, |x, y| if x == 0.0 || y == 0.0 { 0.0 } else { x * y })
    }
    fn quotient(self, b: Self) -> Self {
        if b.is_none() || b.lo == 0.0 && b.hi == 0.0 {
            return Self::NONE;
        }
        if b.holds(0.0) {
            return if self.is_none() { self } else { Self::ANY };
        }
        self.corners(b, |x, y| x / y)
    }
}

operators!([] Interval);

impl Scalar for Interval {
    type Mask = Answer;

    fn constant(x: f64) -> Self {
        Self { lo: x, hi: x }
    }
    fn known(&self) -> Option<f64> {
        (self.lo == self.hi).then_some(self.lo)
    }

    fn lt(self, b: Self) -> Answer {
        if self.hi < b.lo {
            Yes
        } else if self.lo >= b.hi {
            No
        } else {
            Perhaps
        }
    }
    fn le(self, b: Self) -> Answer {
        b.lt(self).not()
    }
    fn same(self, b: Self) -> Answer {
        if self.hi < b.lo || b.hi < self.lo {
            No
        } else if self.lo == self.hi && self == b {
            Yes
        } else {
            Perhaps
        }
    }
    fn select(mask: Answer, yes: Self, no: Self) -> Self {
        match mask {
            Yes => yes,
            No => no,
            Perhaps => yes.hull(no),
        }
    }

    fn rate_of_steps(self) -> Self {
        match self.known() {
            Some(_) => Self::zero(),
            None => Self::ANY,
        }
    }

    fn square(self) -> Self {
        self.powi(2)
    }
    fn sqrt(self) -> Self {
        self.inside(0.0, f64::INFINITY).monotone(f64::sqrt)
    }
    fn sin(self) -> Self {
        self.wave(FRAC_PI_2, Scalar::sin)
    }
    fn cos(self) -> Self {
        self.wave(0.0, Scalar::cos)
    }
    fn tan(self) -> Self {
        let branch = |x: f64| (x / PI + 0.5).floor();
        if self.hi - self.lo < PI && branch(self.lo) == branch(self.hi) {
            self.monotone(Scalar::tan)
        } else if self.is_none() {
            self
        } else {
            Self::ANY
        }
    }
    fn asin(self) -> Self {
        self.inside(-1.0, 1.0).monotone(Scalar::asin)
    }
    fn acos(self) -> Self {
        self.inside(-1.0, 1.0).monotone(Scalar::acos)
    }
    fn atan(self) -> Self {
        self.monotone(Scalar::atan)
    }
    fn atan2(self, x: Self) -> Self {
        if self.holds(0.0) && x.lo <= 0.0 {
            return Self::between(-PI, PI);
        }
        self.corners(x, Scalar::atan2)
    }
    fn sinh(self) -> Self {
        self.monotone(Scalar::sinh)
    }
    fn cosh(self) -> Self {
        self.abs().monotone(Scalar::cosh)
    }
    fn tanh(self) -> Self {
        self.monotone(Scalar::tanh)
    }
    fn exp(self) -> Self {
        self.monotone(Scalar::exp)
    }
    fn ln(self) -> Self {
        self.inside(0.0, f64::INFINITY).monotone(Scalar::ln)
    }
    fn log10(self) -> Self {
        self.inside(0.0, f64::INFINITY).monotone(Scalar::log10)
    }
    fn powi(self, n: i32) -> Self {
        if n < 0 {
            // not −n, which the smallest integer does not have
            return Self::one() / (self.powi(-(n + 1)) * self);
        }
        let base = if n % 2 == 0 { self.abs() } else { self };
        base.monotone(|x| Scalar::powi(x, n))
    }
    fn powf(self, exponent: Self) -> Self {
        match exponent.known() {
            Some(e) if e.trunc() == e && e.abs() < f64::from(i32::MAX) => self.powi(e as i32),
            // a negative base has no such power
            Some(_) => self
                .inside(0.0, f64::INFINITY)
                .corners(exponent, Scalar::powf),
            None if self.lo > 0.0 => self.corners(exponent, Scalar::powf),
            None => Self::ANY,
        }
    }
    fn abs(self) -> Self {
        if self.holds(0.0) {
            Self::between(0.0, self.hi.max(-self.lo))
        } else {
            self.monotone(f64::abs)
        }
    }
    fn trunc(self) -> Self {
        self.monotone(f64::trunc)
    }
    fn round(self) -> Self {
        self.monotone(f64::round)
    }
    fn floor(self) -> Self {
        self.monotone(f64::floor)
    }
    fn rem(self, b: Self) -> Self {
        if self.is_none() || b.is_none() || b.lo == 0.0 && b.hi == 0.0 {
            return Self::NONE;
        }
        let times = (self / b).monotone(f64::trunc);
        if times.known().is_some_and(f64::is_finite) {
            return self.corners(b, |x, m| x % m);
        }
        // smaller than the divisor and no larger than the number, with its sign
        let most = b.lo.abs().max(b.hi.abs());
        Self::between(self.lo.min(0.0).max(-most), self.hi.max(0.0).min(most))
    }
    fn kept_with(self, x: Self) -> Self {
        if x.is_none() { x } else { self }
    }
    fn lookup(self, table: &Arc<dyn Table>, order: u32) -> Self {
        match self.known() {
            Some(x) => Self::constant(table.at(x, order)),
            None if self.is_none() => self,
            None => self.between_knots(&**table, order),
        }
    }
}

/// Pieces of a table that are bounded one by one, at most.
const MOST_PIECES: usize = 64;
/// Highest degree of the pieces of a table that are bounded.
const DEGREE: u32 = 3;

impl Interval {
    /// Returns bounds of a derivative of a table of cubic pieces: by the control points of each.
    fn between_knots(self, table: &dyn Table, order: u32) -> Self {
        let knots = table.knots();
        let first = knots.partition_point(|&k| k <= self.lo);
        let inner = knots[first..].iter().take_while(|&&k| k < self.hi).count();
        if knots.is_empty() || inner > MOST_PIECES {
            return Self::ANY;
        }
        let ends = knots[first..first + inner].iter().copied();
        let ends = ends.chain([self.hi]);
        let mut from = self.lo;
        let mut all = Self::NONE;
        for to in ends {
            let h = to - from;
            let [value, slope, bend, third, more] =
                [0, 1, 2, 3, DEGREE + 1].map(|k| table.beside(from, true, order + k));
            if !(h.is_finite() && more == 0.0) {
                return Self::ANY;
            }
            let points = [
                value,
                value + h * slope / 3.0,
                value + h * (2.0 * slope / 3.0 + h * bend / 6.0),
                value + h * (slope + h * (0.5 * bend + h * third / 6.0)),
            ];
            for point in points {
                all = all.hull(Self::between(point, point));
            }
            from = to;
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Formulas with all operations, over any number.
    fn formulas<S: Scalar>(x: S) -> Vec<S> {
        let c = S::constant;
        let shifted = x - c(0.3);
        vec![
            x + x * x,
            x / (x - c(4.0)),
            c(2.0) / shifted,
            x.sin() * (x * c(7.0)).cos(),
            x.tan(),
            x.sqrt() + (x + c(2.0)).ln(),
            (x * c(0.4)).asin() - (x * c(0.4)).acos(),
            x.atan2(shifted),
            c(1.0).atan2(x),
            x.sinh() + x.cosh() + x.tanh(),
            x.exp().log10(),
            shifted.powi(2) - shifted.powi(-3),
            x.powf(c(1.5)),
            (x.abs() + c(0.1)).powf(x),
            x.abs() - x.trunc() + x.round() - x.floor(),
            x.rem(c(0.7)) + c(5.0).rem(x),
            x.max(shifted.square()).min(c(1.0)),
            S::select(x.lt(c(0.5)).and(c(-1.0).le(x)).not(), x, -x),
            S::select(x.same(c(0.25)), c(3.0), x),
        ]
    }

    #[test]
    fn every_value_in_an_interval_is_in_the_bound() {
        for k in -40..40 {
            for width in [0.0, 0.01, 0.3, 1.0, 7.0] {
                let lo = 0.083 * f64::from(k);
                let bounds = formulas(Interval::between(lo, lo + width));
                for j in 0..=100 {
                    let x = lo + width * f64::from(j) / 100.0;
                    for (which, (bound, value)) in bounds.iter().zip(formulas(x)).enumerate() {
                        // a rounding more or less
                        let room = 1e-12 * (1.0 + value.abs());
                        let held = bound.lo - room <= value && value <= bound.hi + room;
                        assert!(held || value.is_nan(), "{which}: {x} {value} {bound:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_bound_shrinks_with_the_interval() {
        for x in [-2.3, 0.13, 1.77] {
            for (bound, value) in formulas(Interval::between(x, x + 1e-9))
                .iter()
                .zip(formulas(x))
            {
                let near = (bound.hi - bound.lo).abs() < 1e-6 * (1.0 + value.abs());
                assert!(near || value.is_nan(), "{x} {bound:?}");
            }
        }
    }
}
