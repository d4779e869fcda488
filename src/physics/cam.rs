//! PTCV and CVCV: a point on a curve and a curve on a curve, as equations between two marker
//! frames.
//!
//! A curve `c(s)` is given in the coordinates of its marker. The parameter s of the contact follows
//! from the frames: it is found by Newton's iteration from a nearby value, over the number type of
//! the frames, so that derivatives are those of the implicit function. With `c' = dc/ds`, `p` the
//! point in the coordinates of the curve, and for two curves `D = P_I − P_J`, tangents T:
//!
//! ```text
//! PTCV    0 = (p − c) · c'                           s: the point of the curve next to I     (1)
//!         n₁ · (p − c) = 0,  n₂ · (p − c) = 0        n₁ ∥ c' × r,  n₂ = c'/|c'| × n₁         (2)
//! CVCV    0 = D · T_I,   0 = (T_I × T_J) · z_I       s_I, s_J: tangents are parallel         (3)
//!         D · n = 0,  D · z_I = 0                    n = z_I × T_I/|T_I|                     (4)
//! floating markers: x = T/|T|;  y of PTCV away from the centre of curvature                  (5)
//!                   of CVCV z × x with the z of its curve                                    (6)
//! contact placed at s₀:   PTCV  p − c(s₀) = 0                                                (7)
//!                         CVCV  D = 0 with parallel tangents                                 (8)
//! ```
//!
//! r is a fixed direction that no tangent of the curve comes near (z for a curve in the x–y plane),
//! so that the normals are smooth all along. The forces of (2) and (4) have no part along the
//! curve: contact without friction. An open curve is extended straight beyond its ends, so that a
//! step that overshoots has a value; a run does not keep such a step. The parameter of a closed
//! curve counts its turns.

use crate::expr::interpolation::Curve;
use crate::scalar::{Scalar, Table};
use crate::space::{Frame, Mat3, Vec3};
use std::sync::Arc;

/// A curve with its extension beyond its ends.
#[derive(Clone, Debug)]
pub struct Path {
    /// x, y, z over the parameter, from −1 to 1 and beyond
    tables: [Arc<dyn Table>; 3],
    /// whether it returns to its beginning
    pub closed: bool,
    /// parameters between which it is one polynomial
    pub knots: Vec<f64>,
    /// r: no tangent comes near this direction
    away: Vec3<f64>,
    /// length of the polygon through its samples, in length units
    pub length: f64,
    /// largest |z|, in length units
    pub height: f64,
}

/// Pieces into which a curve is divided for searches.
pub const SAMPLES: usize = 256;

/// A table extended straight beyond −1 and 1.
#[derive(Debug)]
struct Straight(Arc<dyn Table>);

impl Table for Straight {
    fn at(&self, x: f64, order: u32) -> f64 {
        let end = x.clamp(-1.0, 1.0);
        if x == end || x.is_nan() {
            return self.0.at(x, order);
        }
        match order {
            0 => self.0.at(end, 0) + (x - end) * self.0.at(end, 1),
            1 => self.0.at(end, 1),
            _ => 0.0,
        }
    }
}

/// A table over a range of its own, from −1 to 1.
#[derive(Debug)]
struct Ranged {
    table: Arc<dyn Table>,
    low: f64,
    high: f64,
}

impl Table for Ranged {
    fn at(&self, x: f64, order: u32) -> f64 {
        let half = 0.5 * (self.high - self.low);
        // the ends are those of the range, whatever rounding says
        let inside = (self.low + (x + 1.0) * half).clamp(self.low, self.high);
        self.table.at(inside, order) * half.powi(order as i32)
    }
}

/// A table repeated with period 2.
#[derive(Debug)]
struct Around(Arc<dyn Table>);

impl Table for Around {
    fn at(&self, x: f64, order: u32) -> f64 {
        self.0.at((x + 1.0).rem_euclid(2.0) - 1.0, order)
    }
}

impl Path {
    /// Builds the path of a curve, with its extension beyond its ends.
    pub fn new(curve: &Curve) -> Self {
        let closed = curve.is_closed();
        let [low, high] = curve.range();
        let is_usual = [low, high] == [-1.0, 1.0];
        let beyond = |t: &Arc<dyn Table>| -> Arc<dyn Table> {
            let table = match is_usual {
                true => t.clone(),
                false => Arc::new(Ranged {
                    table: t.clone(),
                    low,
                    high,
                }),
            };
            if closed {
                Arc::new(Around(table))
            } else {
                Arc::new(Straight(table))
            }
        };
        let mut path = Self {
            tables: [0, 1, 2].map(|k| beyond(&curve.components()[k])),
            closed,
            knots: match is_usual {
                true => curve.knots().to_vec(),
                false => vec![-1.0, 1.0],
            },
            away: Vec3::axis(2),
            length: 0.0,
            height: 0.0,
        };
        let points: Vec<Vec3<f64>> = samples().map(|s| path.at(s, 0)).collect();
        path.length = points.windows(2).map(|p| (p[1] - p[0]).norm()).sum();
        path.height = points.iter().map(|p| p.0[2].abs()).fold(0.0, f64::max);
        path.away = path.far_from_tangents();
        path
    }

    /// Returns, of 200 directions, the one that stays farthest from all tangents; z where that is
    /// good enough.
    fn far_from_tangents(&self) -> Vec3<f64> {
        let tangents: Vec<Vec3<f64>> = samples()
            .map(|s| self.at(s, 1))
            .filter(|t: &Vec3<f64>| t.norm() > 0.0)
            .map(|t| t.times(1.0 / t.norm()))
            .collect();
        let nearest = |r: Vec3<f64>| {
            let sines = tangents.iter().map(|t| t.cross(r).norm());
            sines.fold(f64::INFINITY, f64::min)
        };
        let z = Vec3::axis(2);
        let mut best = (nearest(z), z);
        if best.0 > 0.5 {
            return z;
        }
        // spread evenly over half a sphere: a spiral with the golden angle
        for k in 0..200 {
            let height = (f64::from(k) + 0.5) / 200.0;
            let (sin, cos) = Scalar::sin_cos(f64::from(k) * 2.399_963_229_728_653);
            let width = (1.0 - height * height).sqrt();
            let r = Vec3([width * cos, width * sin, height]);
            let apart = nearest(r);
            if apart > best.0 + 1e-9 {
                best = (apart, r);
            }
        }
        best.1
    }

    /// Returns the derivative of some order with respect to the parameter, in the coordinates of
    /// the curve.
    pub fn at<S: Scalar>(&self, s: S, order: u32) -> Vec3<S> {
        Vec3([0, 1, 2].map(|k| s.lookup(&self.tables[k], order)))
    }

    /// Returns the length by which a parameter lies beyond an end of an open curve; zero or
    /// negative on the curve.
    pub fn beyond(&self, s: f64) -> f64 {
        if self.closed {
            return f64::NEG_INFINITY;
        }
        let end = if s < 0.0 { -1.0 } else { 1.0 };
        let tangent: Vec3<f64> = self.at(end, 1);
        (s.abs() - 1.0) * tangent.norm()
    }

    /// Returns the parameter of the sample nearest to a point in the coordinates of the curve.
    pub fn nearest(&self, p: Vec3<f64>) -> f64 {
        let distance = |s: f64| (self.at(s, 0) - p).norm2();
        samples()
            .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
            .unwrap_or(0.0)
    }

    /// Returns the parameter of the point nearest to `p`; on an open curve that point is between
    /// its ends.
    pub fn foot(&self, p: Vec3<f64>) -> f64 {
        let start = self.nearest(p);
        let mut s = start;
        for _ in 0..20 {
            let [c, t, bend] = [0, 1, 2].map(|k| self.at::<f64>(s, k));
            let d = p - c;
            let step = d.dot(t) / (t.dot(t) - d.dot(bend));
            s += step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        // the solution lies between the samples beside the nearest one
        let near = (s - start).abs() <= 2.0 / SAMPLES as f64;
        let s = if near { s } else { start };
        if self.closed { s } else { s.clamp(-1.0, 1.0) }
    }
}

/// Iterates over the parameters of the samples.
pub fn samples() -> impl Iterator<Item = f64> {
    (0..=SAMPLES).map(|k| 2.0 * k as f64 / SAMPLES as f64 - 1.0)
}

/// The two sides of a contact.
#[derive(Clone, Debug)]
pub enum Contact {
    /// PTCV: the origin of I lies on a curve of J
    Point(Path),
    /// CVCV: a curve of I and a curve of J have a common tangent
    Curves(Path, Path),
}

/// Names of the two rows, of PTCV and of CVCV.
pub const ROWS: [[&str; 2]; 2] = [["across 1", "across 2"], ["gap", "out of plane"]];

impl Contact {
    /// Returns the number of parameters.
    pub fn n_parameters(&self) -> usize {
        self.paths().len()
    }

    /// Returns the curves; that of I first where there are two.
    pub fn paths(&self) -> Vec<&Path> {
        match self {
            Contact::Point(path) => vec![path],
            Contact::Curves(i, j) => vec![i, j],
        }
    }

    /// Evaluates the conditions that determine the parameters of the contact (1), (3), and their
    /// derivatives with respect to the parameters.
    fn conditions<S: Scalar>(
        &self,
        i: &Frame<S>,
        j: &Frame<S>,
        s: [S; 2],
    ) -> ([S; 2], [[S; 2]; 2]) {
        match self {
            Contact::Point(path) => {
                let p = j.rotation.apply_transposed(i.position - j.position);
                let [c, t, bend] = [0, 1, 2].map(|k| path.at(s[0], k));
                let d = p - c;
                let (one, zero) = (S::one(), S::zero());
                (
                    [d.dot(t), zero],
                    [[d.dot(bend) - t.dot(t), zero], [zero, one]],
                )
            }
            Contact::Curves(path_i, path_j) => {
                let [p_i, t_i, b_i] = in_ground(path_i, i, s[0]);
                let [p_j, t_j, b_j] = in_ground(path_j, j, s[1]);
                let (d, z) = (p_i - p_j, i.rotation.column(2));
                (
                    [d.dot(t_i), t_i.cross(t_j).dot(z)],
                    [
                        [t_i.dot(t_i) + d.dot(b_i), -t_j.dot(t_i)],
                        [b_i.cross(t_j).dot(z), t_i.cross(b_j).dot(z)],
                    ],
                )
            }
        }
    }

    /// Returns the parameters after some steps of Newton's iteration.
    pub fn refined<S: Scalar>(
        &self,
        i: &Frame<S>,
        j: &Frame<S>,
        s: [S; 2],
        steps: usize,
    ) -> [S; 2] {
        let mut s = s;
        for _ in 0..steps {
            let ([f, g], [[a, b], [c, d]]) = self.conditions(i, j, s);
            if let Contact::Point(_) = self {
                s[0] -= f / a;
                continue;
            }
            let per = (a * d - b * c).recip();
            s[0] -= (d * f - b * g) * per;
            s[1] -= (a * g - c * f) * per;
        }
        s
    }

    /// Returns the violation of the conditions as a pure number: 0 at the parameters of the
    /// contact.
    pub fn missing(&self, i: &Frame<f64>, j: &Frame<f64>, s: [f64; 2]) -> f64 {
        let ([f, g], _) = self.conditions(i, j, s);
        let size = |path: &Path, s: f64| path.at::<f64>(s, 1).norm().max(f64::MIN_POSITIVE);
        match self {
            Contact::Point(path) => (f / (size(path, s[0]) * path.length)).abs(),
            Contact::Curves(a, b) => {
                let (t_i, t_j) = (size(a, s[0]), size(b, s[1]));
                let length = a.length.max(b.length);
                (f / (t_i * length)).abs().max((g / (t_i * t_j)).abs())
            }
        }
    }

    /// Evaluates the rows (2), (4) at given parameters, as lengths.
    pub fn gaps<S: Scalar>(&self, i: &Frame<S>, j: &Frame<S>, s: [S; 2]) -> [S; 2] {
        match self {
            Contact::Point(path) => {
                let d = j.rotation.apply_transposed(i.position - j.position) - path.at(s[0], 0);
                let t: Vec3<S> = path.at(s[0], 1);
                let across = t.cross(Vec3::constant(path.away));
                let n1 = across.times(across.norm2().sqrt().recip());
                let n2 = t.times(t.norm2().sqrt().recip()).cross(n1);
                [d.dot(n1), d.dot(n2)]
            }
            Contact::Curves(path_i, path_j) => {
                let [p_i, t_i, _] = in_ground(path_i, i, s[0]);
                let [p_j, _, _] = in_ground(path_j, j, s[1]);
                let (d, z) = (p_i - p_j, i.rotation.column(2));
                let n = z.cross(t_i);
                [d.dot(n) * n.norm2().sqrt().recip(), d.dot(z)]
            }
        }
    }

    /// Returns the frame of the floating marker of a curve: origin at the contact, x along the
    /// tangent (5), (6).
    ///
    /// `side`: index in [`Contact::paths`].
    pub fn floating<S: Scalar>(
        &self,
        side: usize,
        i: &Frame<S>,
        j: &Frame<S>,
        s: [S; 2],
    ) -> Frame<S> {
        let unit = |v: Vec3<S>| v.times(v.norm2().sqrt().recip());
        let (path, marker, s) = match self {
            Contact::Point(path) => (path, j, s[0]),
            Contact::Curves(path, _) if side == 0 => (path, i, s[0]),
            Contact::Curves(_, path) => (path, j, s[1]),
        };
        let t: Vec3<S> = path.at(s, 1);
        let x = unit(t);
        let y = match self {
            Contact::Curves(..) => Vec3::axis(2).cross(x),
            Contact::Point(_) => {
                let bend: Vec3<S> = path.at(s, 2);
                let inward = bend - x.times(bend.dot(x));
                let (n2, t2) = (inward.norm2(), t.norm2());
                // curvature · length; a straight piece has no centre of curvature
                let straight = (n2.scale(path.length * path.length)).le((t2 * t2).scale(1e-18));
                let beside = t.cross(Vec3::constant(path.away));
                unit(Vec3(std::array::from_fn(|k| {
                    S::select(straight, beside.0[k], -inward.0[k])
                })))
            }
        };
        let axes = Mat3::from_columns(x, y, x.cross(y));
        Frame {
            rotation: marker.rotation * axes,
            position: marker.point(path.at(s, 0)),
        }
    }

    /// Evaluates the conditions (7), (8) for the contact to be at given parameters: one per curve,
    /// or `None` where the place on that curve is free.
    ///
    /// `near`: a guess of the parameters of curves whose place is free.
    pub fn placed<S: Scalar>(
        &self,
        i: &Frame<S>,
        j: &Frame<S>,
        given: [Option<f64>; 2],
        near: [f64; 2],
    ) -> Vec<S> {
        match self {
            Contact::Point(path) => {
                let Some(s) = given[0] else { return Vec::new() };
                let p = j.rotation.apply_transposed(i.position - j.position);
                (p - Vec3::constant(path.at(s, 0))).0.to_vec()
            }
            Contact::Curves(path_i, path_j) => {
                let z = i.rotation.column(2);
                let mut s = [0, 1].map(|k| S::constant(given[k].unwrap_or(near[k])));
                // a curve whose place is free touches with its point next to the other curve's
                for _ in 0..2 {
                    let [p_i, t_i, b_i] = in_ground(path_i, i, s[0]);
                    let [p_j, t_j, b_j] = in_ground(path_j, j, s[1]);
                    let d = p_i - p_j;
                    match given {
                        [Some(_), None] => s[1] += d.dot(t_j) / (t_j.norm2() - d.dot(b_j)),
                        [None, Some(_)] => s[0] -= d.dot(t_i) / (t_i.norm2() + d.dot(b_i)),
                        _ => {}
                    }
                }
                let [p_i, t_i, _] = in_ground(path_i, i, s[0]);
                let [p_j, t_j, _] = in_ground(path_j, j, s[1]);
                if given == [None; 2] {
                    return Vec::new();
                }
                let size = (t_i.norm2() * t_j.norm2()).sqrt();
                let mut all = (p_i - p_j).0.to_vec();
                all.push(t_i.cross(t_j).dot(z).scale(path_i.length) / size);
                all
            }
        }
    }

    /// Returns the point of contact, in ground.
    pub fn place<S: Scalar>(&self, i: &Frame<S>, j: &Frame<S>, s: [S; 2]) -> Vec3<S> {
        match self {
            Contact::Point(path) => j.point(path.at(s[0], 0)),
            Contact::Curves(path_i, _) => i.point(path_i.at(s[0], 0)),
        }
    }
}

/// Returns place, first and second derivative of a curve, in ground axes.
fn in_ground<S: Scalar>(path: &Path, marker: &Frame<S>, s: S) -> [Vec3<S>; 3] {
    let turned = |order: u32| marker.rotation.apply(path.at(s, order));
    [marker.position + turned(0), turned(1), turned(2)]
}
