//! The data that expressions read: splines, families of curves over z, and curves in space.

use super::computed::{self, Component, Computed, Point};
use crate::diagnostic::counted;
use crate::expr::spline::{Ends, Extrapolation, Piecewise, UnfitData, check};
use crate::scalar::{Scalar, Table};
use std::sync::{Arc, OnceLock};

/// The data of a spline: one curve, or a family of curves over z.
///
/// ```
/// use cognate::expr::interpolation::Spline;
/// use cognate::expr::spline::{Ends, Extrapolation};
/// let y = vec![vec![0.0, 2.0, 1.0, 3.0]];
/// let x = vec![1.0, 2.0, 3.0, 4.0];
/// let spline = Spline::new(x, vec![], y, Ends::Natural, Extrapolation::Parabolic)?;
/// assert_eq!(spline.cubic().at(1.25, 0.0, 0), 0.734375);
/// # Ok::<(), cognate::expr::spline::UnfitData>(())
/// ```
#[derive(Debug)]
pub struct Spline {
    /// abscissae, increasing   (n)
    pub(super) x: Vec<f64>,
    /// parameters of a family of curves, increasing; empty for a single curve
    z: Vec<f64>,
    /// values of each curve   (curves × n)
    pub(super) y: Vec<Vec<f64>>,
    ends: Ends,
    extrapolation: Extrapolation,
    /// Akima's curve, once it has been fitted
    akima: OnceLock<Arc<Surface>>,
    /// cubic spline, once it has been fitted
    cubic: OnceLock<Arc<Surface>>,
    /// straight lines, once they have been fitted
    linear: OnceLock<Arc<Surface>>,
    /// steps, once they have been built
    steps: OnceLock<Arc<Surface>>,
}

impl Spline {
    /// Creates it from x (at least 4, increasing), z (empty for a single curve, else increasing)
    /// and the values of each curve.
    ///
    /// # Errors
    ///
    /// When the counts differ, points do not increase, something is not a number, or the ends do
    /// not fit the data.
    pub fn new(
        x: Vec<f64>,
        z: Vec<f64>,
        y: Vec<Vec<f64>>,
        ends: Ends,
        extrapolation: Extrapolation,
    ) -> Result<Self, UnfitData> {
        if y.len() != z.len().max(1) {
            return Err(UnfitData(format!(
                "{} for {} of z",
                counted(y.len(), "curve"),
                counted(z.len(), "value")
            )));
        }
        if z.iter().any(|z| !z.is_finite()) || z.windows(2).any(|w| w[0] >= w[1]) {
            return Err(UnfitData("z must increase".to_string()));
        }
        for curve in &y {
            check(&x, curve, 4)?;
            Piecewise::cubic(&x, curve, ends, extrapolation)?;
        }
        let (akima, cubic, linear, steps) = Default::default();
        Ok(Self {
            x,
            z,
            y,
            ends,
            extrapolation,
            akima,
            cubic,
            linear,
            steps,
        })
    }

    /// Returns whether it is a single curve.
    pub fn is_single(&self) -> bool {
        self.y.len() == 1
    }
    /// Returns local cubics with Akima's slopes, fitted at the first call.
    pub fn akima(&self) -> &Arc<Surface> {
        self.akima
            .get_or_init(|| self.fit(|y| Piecewise::akima(&self.x, y, self.extrapolation)))
    }
    /// Returns the cubic spline, fitted at the first call.
    pub fn cubic(&self) -> &Arc<Surface> {
        self.cubic.get_or_init(|| {
            self.fit(|y| Piecewise::cubic(&self.x, y, self.ends, self.extrapolation))
        })
    }
    /// Returns straight lines from point to point, fitted at the first call.
    pub fn linear(&self) -> &Arc<Surface> {
        self.linear
            .get_or_init(|| self.fit(|y| Piecewise::linear(&self.x, y)))
    }
    /// Returns steps from point to point, built at the first call.
    pub fn steps(&self) -> &Arc<Surface> {
        self.steps
            .get_or_init(|| self.fit(|y| Piecewise::steps(&self.x, y)))
    }

    /// Fits each curve of the family.
    fn fit(&self, curve: impl Fn(&[f64]) -> Result<Piecewise, UnfitData>) -> Arc<Surface> {
        let curves = self
            .y
            .iter()
            .filter_map(|y| curve(y).ok())
            .map(|c| Arc::new(c) as Arc<dyn Table>)
            .collect();
        Arc::new(Surface {
            z: self.z.clone(),
            curves,
        })
    }
}

/// One curve, or curves between which values run linearly in z.
#[derive(Debug)]
pub struct Surface {
    /// parameters of the curves, increasing; empty for a single curve
    z: Vec<f64>,
    pub(super) curves: Vec<Arc<dyn Table>>,
}

impl Surface {
    /// Returns the value, or a derivative with respect to x, at (x, z); beyond the first and last z
    /// the nearest two curves continue.
    pub fn at<S: Scalar>(&self, x: S, z: S, order: u32) -> S {
        if self.curves.len() == 1 {
            return x.lookup(&self.curves[0], order);
        }
        self.between(x, z, order, 0, self.curves.len() - 1)
    }

    /// Interpolates linearly in z between two neighbours of the curves `first` to `last`.
    fn between<S: Scalar>(&self, x: S, z: S, order: u32, first: usize, last: usize) -> S {
        if last - first > 1 {
            let middle = (first + last) / 2;
            return S::choose(
                z.lt(S::constant(self.z[middle])),
                || self.between(x, z, order, first, middle),
                || self.between(x, z, order, middle, last),
            );
        }
        let (low, high) = (
            x.lookup(&self.curves[first], order),
            x.lookup(&self.curves[last], order),
        );
        let w = (z - S::constant(self.z[first])).scale(1.0 / (self.z[last] - self.z[first]));
        low + (high - low) * w
    }
}

/// The meaning of the points of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurvePoints {
    /// the curve goes through them
    OnCurve,
    /// they are the control points of a B-spline
    Control,
}

/// Distance of the ends of a closed curve, as a part of its size, at which they meet.
pub const CLOSING_TOLERANCE: f64 = 1e-9;

/// A curve in space over a parameter, from −1 to 1 unless it is computed; outside it has no value.
///
/// A curve through its points is a cubic spline over the length of the polygon of the points,
/// natural or (closed) periodic.
#[derive(Debug)]
pub struct Curve {
    /// x, y and z over the parameter
    pub(super) components: [Arc<dyn Table>; 3],
    /// whether it returns to its beginning
    closed: bool,
    /// parameters between which it is smooth
    knots: Vec<f64>,
}

impl Curve {
    /// Creates it from at least 4 points; a closed curve ends with its first point. `order` is that
    /// of the polynomials plus one.
    ///
    /// # Errors
    ///
    /// When there are too few points, neighbouring points coincide, a closed curve is not closed,
    /// or the order is unknown (through points: 2 or 4).
    pub fn new(
        points: &[[f64; 3]],
        closed: bool,
        order: usize,
        kind: CurvePoints,
    ) -> Result<Self, UnfitData> {
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return Err(UnfitData("a curve without points".to_string()));
        };
        if points.len() < 4 {
            return Err(UnfitData(format!(
                "{}, but at least 4 are needed",
                counted(points.len(), "point")
            )));
        }
        let gap = |a: &[f64; 3], b: &[f64; 3]| {
            let squares = (0..3).map(|k| (a[k] - b[k]).powi(2));
            squares.sum::<f64>().sqrt()
        };
        let size = points.iter().map(|p| gap(p, first)).fold(0.0, f64::max);
        if closed && gap(first, last) > CLOSING_TOLERANCE * size {
            return Err(UnfitData(
                "the last point of a closed curve must repeat the first".to_string(),
            ));
        }
        // its ends differ by rounding, at most
        let mut points = points.to_vec();
        if let (true, [first, .., last]) = (closed, &mut points[..]) {
            *last = *first;
        }
        let mut lengths = vec![0.0];
        for pair in points.windows(2) {
            let chord = (0..3)
                .map(|k| (pair[1][k] - pair[0][k]).powi(2))
                .sum::<f64>()
                .sqrt();
            lengths.push(lengths[lengths.len() - 1] + chord);
        }
        let total = lengths[lengths.len() - 1];
        let mut alpha: Vec<f64> = lengths.iter().map(|l| 2.0 * l / total - 1.0).collect();
        if let Some(end) = alpha.last_mut() {
            *end = 1.0;
        }
        let component = |k: usize| -> Result<Piecewise, UnfitData> {
            let y: Vec<f64> = points.iter().map(|p| p[k]).collect();
            let ends = if closed {
                Ends::Periodic
            } else {
                Ends::Natural
            };
            Ok(match (kind, order) {
                (CurvePoints::Control, _) => Piecewise::b_spline(&y, order, closed, -1.0, 1.0)?,
                (CurvePoints::OnCurve, 4) => {
                    Piecewise::cubic(&alpha, &y, ends, Extrapolation::None)?
                }
                (CurvePoints::OnCurve, 2) => Piecewise::linear(&alpha, &y)?.without_extrapolation(),
                _ => {
                    return Err(UnfitData(format!(
                        "a curve of order {order} through points; use 2 or 4"
                    )));
                }
            })
        };
        let x = component(0)?;
        let knots = x.knots().to_vec();
        Ok(Self {
            components: [
                Arc::new(x),
                Arc::new(component(1)?),
                Arc::new(component(2)?),
            ],
            closed,
            knots,
        })
    }

    /// Creates it from what computes its points and their first two derivatives, between two
    /// parameters.
    ///
    /// # Errors
    /// When the parameters do not ascend, a closed curve is not closed, or the derivatives are not
    /// those of the points.
    pub fn computed(
        point: Arc<Point>,
        closed: bool,
        [low, high]: [f64; 2],
    ) -> Result<Self, UnfitData> {
        let range = high - low;
        if !(range.is_finite() && range > 0.0) {
            return Err(UnfitData(format!(
                "its parameter goes from {low} to {high}; MINPAR must be smaller than MAXPAR"
            )));
        }
        computed::check(&*point, closed, [low, high])?;
        let source = Arc::new(Computed::new(point, [low, high]));
        let component = |axis: usize| -> Arc<dyn Table> {
            Arc::new(Component {
                source: source.clone(),
                axis,
            })
        };
        Ok(Self {
            components: [0, 1, 2].map(component),
            closed,
            knots: vec![low, high],
        })
    }

    /// Returns the first and the last parameter.
    pub fn range(&self) -> [f64; 2] {
        let ends = [self.knots.first(), self.knots.last()];
        [
            ends[0].copied().unwrap_or(-1.0),
            ends[1].copied().unwrap_or(1.0),
        ]
    }

    /// Returns the parameters, ascending, between which it is smooth.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Returns x, y and z over the parameter.
    pub fn components(&self) -> &[Arc<dyn Table>; 3] {
        &self.components
    }
    /// Returns whether it returns to its beginning.
    pub fn is_closed(&self) -> bool {
        self.closed
    }
}
