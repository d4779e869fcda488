//! Curves that are computed point by point, by code that is no formula.
//!
//! Whoever computes one gives the points and their first two derivatives along the parameter; those
//! of higher order, which equations of contact ask for, are differences of the second.

use super::super::spline::UnfitData;
use crate::scalar::Table;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

/// Computes x, y and z at a parameter, or their derivatives of order 1 or 2.
pub type Point = dyn Fn(f64, u32) -> [f64; 3] + Send + Sync;

/// Step of differences, as a part of what counts as one: the range of the parameter.
pub const STEP: f64 = 1e-3;
/// Places at which derivatives are compared with differences.
const CHECKS: usize = 9;
/// Difference between a derivative and a difference at which they disagree, as a part of the
/// largest derivative.
pub const DISAGREEMENT: f64 = 1e-3;

/// Returns the derivative at zero by differences of fourth order, with steps of `h`.
pub fn slope(at: &dyn Fn(f64) -> f64, h: f64) -> f64 {
    let across = |steps: f64| at(steps * h) - at(-steps * h);
    (8.0 * across(1.0) - across(2.0)) / (12.0 * h)
}

/// Returns the second derivative at zero by differences of fourth order, with steps of `h`.
pub fn curvature(at: &dyn Fn(f64) -> f64, h: f64) -> f64 {
    let middle = 2.0 * at(0.0);
    let around = |steps: f64| at(steps * h) - middle + at(-steps * h);
    (16.0 * around(1.0) - around(2.0)) / (12.0 * h * h)
}

/// A computed curve, and the last point that was asked for.
pub(super) struct Computed {
    point: Arc<Point>,
    range: [f64; 2],
    last: Mutex<Option<(u64, u32, [f64; 3])>>,
}

/// A component of a computed curve.
#[derive(Debug)]
pub(super) struct Component {
    pub source: Arc<Computed>,
    pub axis: usize,
}

impl fmt::Debug for Computed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Computed({:?})", self.range)
    }
}

impl Computed {
    pub fn new(point: Arc<Point>, range: [f64; 2]) -> Self {
        Self {
            point,
            range,
            last: Mutex::default(),
        }
    }

    /// Returns a point, or a derivative of order 1 or 2: the three components are asked for one
    /// after the other.
    fn at(&self, x: f64, order: u32) -> [f64; 3] {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        match *last {
            Some((bits, of, point)) if (bits, of) == (x.to_bits(), order) => point,
            _ => {
                let point = (self.point)(x, order);
                *last = Some((x.to_bits(), order, point));
                point
            }
        }
    }
}

impl Table for Component {
    fn at(&self, x: f64, order: u32) -> f64 {
        let [low, high] = self.source.range;
        if !(low..=high).contains(&x) {
            return f64::NAN;
        }
        if order <= 2 {
            return self.source.at(x, order)[self.axis];
        }
        // differences stay within the range
        let h = STEP * (high - low);
        let middle = x.clamp(low + 2.0 * h, high - 2.0 * h);
        let at = |x: f64| self.source.at(middle + x, 2)[self.axis];
        match order {
            3 => slope(&at, h),
            4 => curvature(&at, h),
            // no equation of motion asks for more
            _ => 0.0,
        }
    }
}

/// Checks what a curve is computed by.
///
/// # Errors
/// Points that are no numbers, derivatives that are not theirs, ends of a closed curve that do not
/// meet.
pub(super) fn check(point: &Point, closed: bool, [low, high]: [f64; 2]) -> Result<(), UnfitData> {
    let range = high - low;
    let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let minus = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|k| a[k] - b[k]);
    let h = STEP * range;
    let places: Vec<f64> = (0..CHECKS)
        .map(|k| low + 2.0 * h + (range - 4.0 * h) * k as f64 / (CHECKS - 1) as f64)
        .collect();
    // as if the range were one
    let mut sizes = [0.0f64; 3];
    for &x in &places {
        for (order, size) in (0..).zip(&mut sizes) {
            let at = point(x, order);
            if at.iter().any(|x| !x.is_finite()) {
                return Err(UnfitData(format!(
                    "at parameter {x} it is no finite number"
                )));
            }
            *size = size.max(norm(at) * range.powi(order as i32));
        }
    }
    for &x in &places {
        for order in [1, 2] {
            let found = [0, 1, 2].map(|k| slope(&|dx| point(x + dx, order - 1)[k], h));
            let told = point(x, order);
            let largest = sizes[1].max(sizes[order as usize]);
            if norm(minus(told, found)) * range.powi(order as i32) > DISAGREEMENT * largest {
                return Err(UnfitData(format!(
                    "at parameter {x} its derivative of order {order} is {told:?}, but differences of order {} give {found:?}",
                    order - 1
                )));
            }
        }
    }
    for (order, size) in (0..).zip(sizes).filter(|_| closed) {
        let gap = norm(minus(point(low, order), point(high, order))) * range.powi(order as i32);
        let allowed = match order {
            0 => super::CLOSING_TOLERANCE,
            _ => DISAGREEMENT,
        };
        if gap > allowed * size.max(sizes[1]) {
            return Err(UnfitData(match order {
                0 => "a closed curve must end where it begins".into(),
                n => format!(
                    "at the end of a closed curve its derivative of order {n} must be that of its beginning"
                ),
            }));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Scalar;

    /// A circle over a parameter from 0 to 2π.
    fn circle(x: f64, order: u32) -> [f64; 3] {
        let (s, c) = Scalar::sin_cos(x);
        match order {
            0 => [c, s, 0.0],
            1 => [-s, c, 0.0],
            _ => [-c, -s, 0.0],
        }
    }

    const ROUND: [f64; 2] = [0.0, std::f64::consts::TAU];

    #[test]
    fn derivatives_of_higher_order_are_those_of_the_curve() {
        let component = Component {
            source: Arc::new(Computed::new(Arc::new(circle), ROUND)),
            axis: 0,
        };
        for x in [0.0, 1.0, 6.25] {
            let exact = [Scalar::cos(x), -Scalar::sin(x), -Scalar::cos(x)];
            for (order, exact) in (0..).zip(exact) {
                assert_eq!(component.at(x, order), exact);
            }
        }
        assert!((component.at(1.0, 3) - Scalar::sin(1.0)).abs() < 1e-9);
        assert!((component.at(1.0, 4) - Scalar::cos(1.0)).abs() < 1e-4);
        assert!(component.at(-0.1, 0).is_nan());
    }

    #[test]
    fn curves_that_contradict_themselves_are_refused() {
        assert!(check(&circle, true, ROUND).is_ok());
        assert!(check(&circle, true, [0.0, 3.0]).is_err());
        let wrong = |order: u32| move |x: f64, n: u32| circle(x, if n == order { 0 } else { n });
        assert!(check(&wrong(1), false, ROUND).is_err());
        assert!(check(&wrong(2), false, ROUND).is_err());
        let nan = |x: f64, n: u32| circle(x, n).map(|x| x / 0.0);
        assert!(check(&nan, false, ROUND).is_err());
    }
}
