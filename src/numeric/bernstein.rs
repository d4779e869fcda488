//! The unknowns within a step, bounded over any part of it.
//!
//! The interpolants of all methods are polynomials of the time of degree 7 at most. Through as many
//! values within the step there is one of them, and its control points over a part [a, b] of the
//! step bound it there:
//!
//! ```text
//! y(a + (b − a) x) = Σ (7 over i) cᵢ xⁱ (1 − x)⁷⁻ⁱ,   0 ≤ x ≤ 1        min cᵢ ≤ y ≤ max cᵢ
//! ```
//!
//! The bound shrinks with the square of b − a towards the range of y. So do those of the rates,
//! whose control points are 7 (cᵢ₊₁ − cᵢ)/h over the whole step. Rounding is not included.
//!
//! Source: Farouki, The Bernstein polynomial basis: a centennial retrospective, Computer Aided
//! Geometric Design 29 (2012).

use crate::scalar::{Interval, Scalar};
use std::sync::LazyLock;

/// Degree of the polynomials: that of the interpolant of DOP853, the highest.
const DEGREE: usize = 7;
/// Values that determine one.
pub const NODES: usize = DEGREE + 1;

/// Control points of the polynomials that are 1 at one of the nodes and 0 at the others.
static SHARES: LazyLock<[[f64; NODES]; NODES]> = LazyLock::new(|| {
    let nodes = Courses::nodes();
    let at_one = |i| std::array::from_fn(|j| f64::from(u8::from(i == j)));
    std::array::from_fn(|i| control_points(&nodes, at_one(i)))
});

/// Some unknowns within a step.
#[derive(Clone, Debug, Default)]
pub struct Courses {
    t0: f64,
    h: f64,
    /// values at the nodes   (n each)
    values: [Vec<f64>; NODES],
    /// control points over the whole step, and those of the rates, once they are wanted   (n)
    points: Vec<Option<([f64; NODES], [f64; DEGREE])>>,
}

impl Courses {
    /// Returns the parts of a step at which values are wanted: both ends are among them.
    pub fn nodes() -> [f64; NODES] {
        // dense at the ends, so that rounding is not magnified
        std::array::from_fn(|i| {
            let angle = std::f64::consts::PI * i as f64 / DEGREE as f64;
            0.5 * (1.0 - Scalar::cos(angle))
        })
    }

    /// Takes another step, from `t0` on, of `n` unknowns whose values are taken next.
    pub fn begin(&mut self, (t0, h): (f64, f64), n: usize) {
        (self.t0, self.h) = (t0, h);
        for values in &mut self.values {
            values.resize(n, 0.0);
        }
        self.points.clear();
        self.points.resize(n, None);
    }

    /// Returns the values at the `i`-th node, to be taken   (n)
    pub fn values_at(&mut self, i: usize) -> &mut [f64] {
        &mut self.values[i]
    }

    /// Returns bounds of the `k`-th unknown, and of its rate, between two times of the step.
    pub fn bound(&mut self, k: usize, from: f64, to: f64) -> [Interval; 2] {
        let (values, h) = (&self.values, self.h);
        let (points, rates) =
            self.points[k].get_or_insert_with(|| lead_through(values.each_ref().map(|v| v[k]), h));
        // what stands still does so in every part
        if rates == &[0.0; DEGREE] {
            return [points[0], 0.0].map(Interval::constant);
        }
        let [a, b] = [from, to].map(|t| ((t - self.t0) / h).clamp(0.0, 1.0));
        [over(*points, a, b), over(*rates, a, b)]
    }
}

/// Returns the control points, over a step of length `h`, of the polynomial through values at its
/// nodes, and those of its rate.
fn lead_through(values: [f64; NODES], h: f64) -> ([f64; NODES], [f64; DEGREE]) {
    // what stays as it is has no rate, not even by rounding
    let begin = values[0];
    let mut points = [begin; NODES];
    for (value, shares) in values.into_iter().zip(&*SHARES) {
        let way = value - begin;
        for (point, share) in points.iter_mut().zip(shares) {
            *point += way * share;
        }
    }
    let mut rates = [0.0; DEGREE];
    for (rate, ends) in rates.iter_mut().zip(points.windows(2)) {
        *rate = DEGREE as f64 * (ends[1] - ends[0]) / h;
    }
    (points, rates)
}

/// Returns bounds of a polynomial between two parts of its interval.
fn over<const N: usize>(mut points: [f64; N], a: f64, b: f64) -> Interval {
    // up to b, then of that from a on
    if b < 1.0 {
        part(&mut points, b, true);
    }
    if a > 0.0 {
        part(&mut points, a / b, false);
    }
    hull(&points)
}

/// Returns the bounds that control points are.
pub fn hull<const N: usize>(points: &[f64; N]) -> Interval {
    let (mut lo, mut hi, mut sum) = (points[0], points[0], 0.0);
    for &c in points {
        lo = if c < lo { c } else { lo };
        hi = if c > hi { c } else { hi };
        sum += c * 0.0;
    }
    // a number that is not finite leaves none
    match sum == 0.0 {
        true => Interval { lo, hi },
        false => Interval::ANY,
    }
}

/// Keeps the control points of a polynomial over the part of its interval up to `x`, or from there
/// on (de Casteljau).
fn part<const N: usize>(points: &mut [f64; N], x: f64, before: bool) {
    let n = points.len();
    for level in 1..n {
        if before {
            for i in (level..n).rev() {
                points[i] = points[i - 1] + x * (points[i] - points[i - 1]);
            }
        } else {
            for i in 0..n - level {
                points[i] += x * (points[i + 1] - points[i]);
            }
        }
    }
}

/// Returns the control points, over the whole interval, of the polynomial through values at nodes.
fn control_points(nodes: &[f64; NODES], mut values: [f64; NODES]) -> [f64; NODES] {
    // divided differences, then from the highest power down: p ← dᵢ + (x − xᵢ) p
    for level in 1..NODES {
        for i in (level..NODES).rev() {
            values[i] = (values[i] - values[i - 1]) / (nodes[i] - nodes[i - level]);
        }
    }
    let mut points = [0.0; NODES];
    points[0] = values[DEGREE];
    for degree in 0..DEGREE {
        let i = DEGREE - 1 - degree;
        // (x − xᵢ) has the control points −xᵢ and 1 − xᵢ; a product of forms of degrees n and 1
        let before = points;
        let n = (degree + 1) as f64;
        for (j, point) in points.iter_mut().enumerate().take(degree + 2) {
            let share = j as f64 / n;
            let low = if j <= degree {
                (1.0 - share) * before[j]
            } else {
                0.0
            };
            let high = if j > 0 { share * before[j - 1] } else { 0.0 };
            *point = values[i] - nodes[i] * low + (1.0 - nodes[i]) * high;
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_degree_seven_stays_in_its_bounds_which_shrink_to_its_range() {
        let p = |x: f64| 3.0 - x + 2.0 * x * x - 40.0 * (x - 0.3).powi(3) * (x - 0.9).powi(4);
        let (t0, h) = (5.0, 0.25);
        let mut courses = Courses::default();
        courses.begin((t0, h), 2);
        for (i, x) in Courses::nodes().into_iter().enumerate() {
            courses.values_at(i).copy_from_slice(&[0.0, p(x)]);
        }
        for (from, to) in [
            (0.0, 1.0),
            (0.1, 0.2),
            (0.55, 0.551),
            (0.0, 0.5),
            (0.9, 1.0),
        ] {
            let [bound, rate] = courses.bound(1, t0 + h * from, t0 + h * to);
            let mut range = [f64::INFINITY, f64::NEG_INFINITY];
            for j in 0..=200 {
                let y = p(from + (to - from) * f64::from(j) / 200.0);
                range = [range[0].min(y), range[1].max(y)];
            }
            assert!(bound.lo <= range[0] + 1e-12 && range[1] - 1e-12 <= bound.hi);
            // the rate, by differences of what has just been seen
            let slope = (p(to) - p(from)) / (to - from) / h;
            assert!(
                rate.lo - 1e-9 <= slope && slope <= rate.hi + 1e-9,
                "{rate:?} {slope}"
            );
            let more = (range[0] - bound.lo).max(bound.hi - range[1]);
            assert!(
                more < 30.0 * (to - from) * (to - from),
                "{from} {to} {more}"
            );
            assert_eq!(
                courses.bound(0, t0, t0 + h),
                [Interval::between(0.0, 0.0); 2]
            );
        }
    }
}
