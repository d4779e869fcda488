//! A wire against a solid: a ball whose centre may be anywhere on a plane curve. A torus is the
//! wire of its ring; a circle, an arc or a curve is a wire without thickness, a point one without
//! length.
//!
//! With d(s) the distance of the curve from the solid and n its direction (`ball.rs`,
//! `ellipsoid.rs`), t the tangent, r the radius of the wire:
//!
//! ```text
//! d' = n · t = 0, rising: a nearest point of the wire        depth = r − d                       
//! (1)
//! ```
//!
//! - **Nearest points**, where (1) holds (`lows.rs`).
//! - **Anchors** are fixed points of the wire that support it where it lies along the solid and (1)
//!   does not determine a point: the whole ring on a plane, half of it on the end of a box.
//!   Together they weigh `ANCHORS_WEIGHT` touches, and they are lifted where the wire is inclined
//!   to the solid on both their sides,
//!
//!   ```text
//!   depth − ANCHOR_LIFT · size · q     1/q = 1/q₋ + 1/q₊,  q: mean of d'² up to the next anchor
//!   ```
//!
//!   so that an inclined wire touches at its nearest points alone. Half of the weight of an anchor
//!   belongs to either side, and vanishes where that side is inclined (`INCLINED_SLOPE_SQUARED`). A
//!   nearest point gets the weight that the anchors of equal depth do not use.

mod lows;

use super::ball::distance;
use super::outline::{Outline, Rim};
use super::{Question, Solid, TOUCH_NUMBERS, ellipsoid};
use crate::space::{Mat3, Vec3};
use lows::LOWS;
use std::f64::consts::TAU;

/// Number of stations at which the distance is evaluated, least and most.
const STATIONS: [usize; 2] = [48, 4096];
/// Number of fixed points that support a wire that lies along a solid.
const ANCHORS: usize = 12;
/// Touches of a wire with a length.
pub(super) const WIRE_TOUCHES: usize = ANCHORS + LOWS;
/// Weight of all anchors of a wire that lies along a plane, in touches: as many as the rim of a
/// cylinder has.
const ANCHORS_WEIGHT: f64 = 4.0;
/// Lift of the anchors of an inclined wire, as a multiple of the size, per mean of d'².
const ANCHOR_LIFT: f64 = 100.0;
/// Distance, as a part of the size, within which anchors take weight from a nearest point.
const ANCHOR_RANGE: f64 = 1.7;
/// Difference of depth, as a part of the size, below which a nearest point and an anchor are
/// equally deep.
const EQUAL_DEPTH: f64 = 1e-4;
/// Mean square of d' (a pure number) on one side of an anchor at which the weight of that side
/// falls to a quarter.
const INCLINED_SLOPE_SQUARED: f64 = 0.01;
/// Distance, as a multiple of its size, above which a wire is not searched.
const SEARCH_DISTANCE: f64 = 1e6;

/// A point of the wire at which the distance is evaluated.
#[derive(Clone, Copy, Debug)]
struct Station {
    /// parameter of the curve
    s: f64,
    /// the point, in the frame of the wire
    at: Vec3<f64>,
    /// length of the wire to the next station
    way: f64,
}

/// The solid, in the form that gives distances.
#[derive(Clone, Debug)]
enum Target {
    Formula(Solid),
    Ellipsoid([f64; 3]),
    #[cfg(feature = "geometry")]
    Hull(std::sync::Arc<super::query::Body>),
}

/// The search for the touches of a wire and a solid.
#[derive(Clone, Debug)]
pub struct Wire {
    /// the curve
    rim: Rim,
    /// radius of the wire, in length units
    tube: f64,
    /// radius of the curve about the middle of its marker, in length units
    size: f64,
    /// whether the curve returns to its beginning
    closed: bool,
    /// stations; none of a point
    stations: Vec<Station>,
    /// indices of the anchors among the stations, ascending
    anchors: Vec<usize>,
    /// the solid
    target: Target,
    /// whether the wire is J's
    turned: bool,
}

impl Target {
    /// Prepares a solid; `None` if it gives no distances.
    fn new(solid: &Solid) -> Option<Self> {
        match solid {
            Solid::Ellipsoid { semi } => Some(Self::Ellipsoid(*semi)),
            #[cfg(feature = "geometry")]
            Solid::Hull(_) => super::query::Body::new(solid).map(|b| Self::Hull(b.into())),
            #[cfg(not(feature = "geometry"))]
            Solid::Hull(_) => None,
            // two points, or a curve and a point, never touch
            Solid::Ball { radius: 0.0 } => None,
            _ => Some(Self::Formula(solid.clone())),
        }
    }
    /// Returns the signed distance of a point, and the direction in which it grows.
    fn distance(&self, p: Vec3<f64>) -> (f64, Vec3<f64>) {
        match self {
            Self::Formula(solid) => distance(solid, p),
            Self::Ellipsoid(semi) => ellipsoid::distance(*semi, p),
            #[cfg(feature = "geometry")]
            Self::Hull(body) => body.distance(p),
        }
    }
}

impl Question {
    /// Prepares for a torus or a point of I or J and the other's solid; `None` if neither is one,
    /// or the other gives no distances.
    pub fn wire(i: &Solid, j: &Solid) -> Option<Self> {
        let one = |wire: &Solid, solid: &Solid, turned: bool| match *wire {
            Solid::Torus { ring, tube } => Wire::new(Rim::Circle(ring, TAU), tube, solid, turned),
            Solid::Ball { radius } => Wire::new(Rim::Point, radius, solid, turned),
            _ => None,
        };
        let wire = one(i, j, false).or_else(|| one(j, i, true))?;
        Some(Question::Wire(Box::new(wire)))
    }

    /// Prepares for a plane curve and a solid; the curve is I's or, `turned`, J's.
    pub fn curve(outline: &Outline, solid: &Solid, turned: bool) -> Option<Self> {
        let wire = Wire::new(outline.rim().clone(), 0.0, solid, turned)?;
        Some(Question::Wire(Box::new(wire)))
    }
}

impl Wire {
    /// Prepares a wire around a curve, with stations and anchors.
    fn new(rim: Rim, tube: f64, solid: &Solid, turned: bool) -> Option<Self> {
        let target = Target::new(solid)?;
        let closed = rim.is_closed();
        let mut this = Self {
            rim,
            tube,
            size: tube,
            closed,
            stations: Vec::new(),
            anchors: Vec::new(),
            target,
            turned,
        };
        if !matches!(this.rim, Rim::Point) {
            this.divide();
            if this.stations.len() < 3 {
                return None;
            }
        }
        Some(this)
    }

    /// Returns the largest number of touches.
    pub fn touches(&self) -> usize {
        if self.stations.is_empty() {
            1
        } else {
            WIRE_TOUCHES
        }
    }

    /// Returns a point of the curve.
    fn at(&self, s: f64) -> Vec3<f64> {
        let p = self.rim.at(s, 0);
        Vec3([p[0], p[1], 0.0])
    }

    /// Places stations and anchors.
    fn divide(&mut self) {
        let knots = self.rim.knots();
        let pieces =
            |a: f64, b: f64, n: usize| (0..n).map(move |k| a + (b - a) * k as f64 / n as f64);
        let length = |a: f64, b: f64| -> f64 {
            let ends = pieces(a, b, 8).chain([b]).map(|s| self.at(s));
            let points: Vec<Vec3<f64>> = ends.collect();
            points.windows(2).map(|p| (p[1] - p[0]).norm()).sum()
        };
        let lengths: Vec<f64> = knots.windows(2).map(|k| length(k[0], k[1])).collect();
        let whole: f64 = lengths.iter().sum();

        // stations: as many in each smooth piece as its length demands
        let mut places = Vec::new();
        for (pair, length) in knots.windows(2).zip(&lengths) {
            let n = (STATIONS[0] as f64 * length / whole).ceil();
            if n >= 1.0 {
                places.extend(pieces(pair[0], pair[1], (n as usize).min(STATIONS[0])));
            }
        }
        if places.len() > STATIONS[1] {
            let stride = places.len().div_ceil(STATIONS[1]);
            places = places.into_iter().step_by(stride).collect();
        }
        if !self.closed {
            places.extend(knots.last());
        }
        let points: Vec<Vec3<f64>> = places.iter().map(|&s| self.at(s)).collect();
        let n = points.len();
        let way = |k: usize| (points[(k + 1) % n] - points[k]).norm();
        self.stations = (0..n)
            .map(|k| Station {
                s: places[k],
                at: points[k],
                way: way(k),
            })
            .collect();
        self.size = points.iter().map(|p| p.norm()).fold(self.tube, f64::max);

        // anchors: the stations at equal ways along the wire
        let gaps = if self.closed { ANCHORS } else { ANCHORS - 1 } as f64;
        let last = if self.closed { n } else { n.saturating_sub(1) };
        let whole: f64 = self.stations[..last].iter().map(|s| s.way).sum();
        let (mut k, mut gone) = (0, 0.0);
        for anchor in 0..ANCHORS {
            // a little less than the exact place, for rounding
            let next = whole * (anchor as f64 / gaps - 1e-9);
            while k + 1 < n && gone < next {
                gone += self.stations[k].way;
                k += 1;
            }
            self.anchors.push(k);
        }
    }

    /// Writes the touches for a pose of I's marker in J's, its position and the three columns of
    /// its axes, in the form that [`super::found`] reads   ([`Wire::touches`] × TOUCH_NUMBERS).
    pub fn ask(&self, pose: &[f64], out: &mut [f64]) {
        super::nothing(out);
        let far = SEARCH_DISTANCE * self.size.max(1.0);
        if pose.len() != 12 || !pose.iter().all(|x| x.abs() <= far) {
            return;
        }
        let vector = |k: usize| Vec3([pose[3 * k], pose[3 * k + 1], pose[3 * k + 2]]);
        let axes = Mat3::from_columns(vector(1), vector(2), vector(3));
        // position and axes of the wire in the frame of the solid
        let (place, axes) = if self.turned {
            let back = Mat3::from_columns(axes.row(0), axes.row(1), axes.row(2));
            (-back.apply(vector(0)), back)
        } else {
            (vector(0), axes)
        };
        let distance = |c: Vec3<f64>| self.target.distance(place + axes.apply(c));
        let all = if self.stations.is_empty() {
            vec![(Vec3::zero(), 0.0, 1.0)]
        } else {
            self.places(&|c| distance(c).0, &|s| {
                let t = self.rim.at(s, 1);
                let t = axes.apply(Vec3([t[0], t[1], 0.0]));
                distance(self.at(s)).1.dot(t)
            })
        };
        for (touch, (c, lift, share)) in out.chunks_mut(TOUCH_NUMBERS).zip(all) {
            let (d, n) = distance(c);
            let on_solid = place + axes.apply(c) - n.times(d);
            // the normal in the wire's frame
            let own = axes.apply_transposed(n);
            let on_wire = c - own.times(self.tube);
            // the direction from J's solid to I's, in J's frame
            let (on_i, on_j, normal) = if self.turned {
                (on_solid, on_wire, -own)
            } else {
                (on_wire, on_solid, n)
            };
            let all = [on_i.0, on_j.0, normal.0].concat();
            touch[..9].copy_from_slice(&all);
            touch[9] = lift;
            touch[10] = share;
        }
    }

    /// Returns the centres of touches with their lift and their shares: the anchors, then the
    /// nearest points along the wire.
    fn places(
        &self,
        distance: &dyn Fn(Vec3<f64>) -> f64,
        slope: &dyn Fn(f64) -> f64,
    ) -> Vec<(Vec3<f64>, f64, f64)> {
        let d: Vec<f64> = self.stations.iter().map(|s| distance(s.at)).collect();
        let held = self.held(&d);
        let anchor =
            |(&k, &(lift, share)): (&usize, &(f64, f64))| (self.stations[k].at, lift, share);
        let mut all: Vec<_> = self.anchors.iter().zip(&held).map(anchor).collect();
        for low in self.lows(&d, distance, slope) {
            let c = self.at(low.s);
            let depth = self.tube - low.d;
            let scale = depth.max(EQUAL_DEPTH * self.size);
            let taken = self.anchors.iter().zip(&held).map(|(&k, (lift, share))| {
                let as_deep = 1.0 - (d[k] + lift - low.d) / scale;
                let apart = (self.stations[k].at - c).norm() / (ANCHOR_RANGE * self.size);
                share * as_deep.clamp(0.0, 1.0) * (1.0 - apart * apart).max(0.0).powi(2)
            });
            let left = (1.0 - taken.sum::<f64>()).max(0.0);
            all.push((c, 0.0, low.share * left * self.sharpness(&d, low.station)));
        }
        all
    }

    /// Returns lift and share of each anchor, from the distances of the stations.
    fn held(&self, d: &[f64]) -> Vec<(f64, f64)> {
        let n = d.len();
        // no anchors beyond the ends of an open wire
        let after = |k: usize| match self.anchors.get(k + 1) {
            Some(&to) => self.inclined(d, self.anchors[k], to - self.anchors[k]),
            None if self.closed => {
                self.inclined(d, self.anchors[k], self.anchors[0] + n - self.anchors[k])
            }
            None => f64::INFINITY,
        };
        let q: Vec<f64> = (0..ANCHORS).map(after).collect();
        let lift = |k: usize| {
            let before = match k {
                0 if !self.closed => f64::INFINITY,
                _ => q[(k + ANCHORS - 1) % ANCHORS],
            };
            let lift =
                (ANCHOR_LIFT * self.size * both(before, q[k])).min(SEARCH_DISTANCE * self.size);
            // half of it belongs to either side
            let share = [before, q[k]].map(|q| 0.5 * (1.0 + q / INCLINED_SLOPE_SQUARED).powi(-2));
            let gaps = ANCHORS - usize::from(!self.closed);
            (lift, ANCHORS_WEIGHT / gaps as f64 * (share[0] + share[1]))
        };
        (0..ANCHORS).map(lift).collect()
    }

    /// Returns the mean of d'² from a station over a number of ways.
    fn inclined(&self, d: &[f64], from: usize, ways: usize) -> f64 {
        let n = d.len();
        let (mut sum, mut way) = (0.0, 0.0);
        for k in from..from + ways {
            let w = self.stations[k % n].way;
            if w > 0.0 {
                sum += (d[(k + 1) % n] - d[k % n]).powi(2) / w;
                way += w;
            }
        }
        if way > 0.0 { sum / way } else { f64::INFINITY }
    }
}

/// Returns half the harmonic mean.
fn both(a: f64, b: f64) -> f64 {
    let least = |x: f64| 1.0 / x.max(f64::MIN_POSITIVE);
    1.0 / (least(a) + least(b))
}
