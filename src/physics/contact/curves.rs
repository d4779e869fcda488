//! The touches of two outlines: all places at which one is deepest in the other.
//!
//! Everything is expressed in the plane of J. With D = P_I − P_J, tangents t, outward normals n,
//! curvature κ (positive where the side bulges), gap g:
//!
//! ```text
//! smooth sides    D · t_I = 0,   t_I × t_J = 0,   n_I · n_J < 0,   g = D · n_J                (1)
//!                 κ_I + κ_J + g κ_I κ_J > 0: the two curve away from each other               (2)
//! corner of I     the point of J nearest to it, g = (P − P_J) · n_J                           (3)
//! corner of J     the same with I and J exchanged
//! ```
//!
//! (1) is solved by Newton's iteration from each pair of cells that can hold a solution; circles
//! about cells and directions of their normals exclude nearly all others at the level of whole
//! pieces. Where (2) fails the sides fit into each other, as two straight ones do: then their
//! corners touch. A corner counts where the normal lies between those of its sides, and where
//! straight sides face each other a little farther, with a share that fades, so that a box stands
//! on both its lower corners. Touches that are near each other share the force of one.
//!
//! A solid is no deeper than `SOLID_DEPTH` of the smaller outline: anything deeper comes from the
//! other side. The line between the two points must not cross either outline elsewhere: then it
//! belongs to another touch. Two touches of smooth sides that merge, as those of a rounded edge do
//! that comes to lie in a hollow of its own radius, end as one: they share by the barrier between
//! them, as the nearest points of a wire do (`wire/`), so that the force of one of them does not
//! end at once.

use super::outline::{Corner, Flat, Node, Outline, Spot};
use super::outline::{along, cross, dot, length, minus, wrapped};
use super::{TOUCH_NUMBERS, TOUCHES};
use crate::scalar::Scalar;
use std::f64::consts::PI;
use std::sync::Arc;

/// Depth of a solid, as a part of the radius of the circle about the smaller outline; larger gaps
/// are not searched either.
pub(super) const SOLID_DEPTH: f64 = 0.5;
/// Angle beyond its normal, in rad, up to which a corner beside a straight side touches another
/// straight side.
const CORNER_FADE_ANGLE: f64 = 0.35;
/// Relative curvature, times the size, below which sides fit into each other.
const FITTING_CURVATURE: f64 = 1e-9;
/// Distance, as a part of the smaller outline, below which touches share.
const SHARING_DISTANCE: f64 = 0.02;
/// Distance, as a part of the smaller outline, below which touches are one.
const SAME_DISTANCE: f64 = 1e-9;
/// Parts into which the way between two touches is divided to find the barrier between them.
const BARRIER_PARTS: u32 = 12;
/// Distance, as a multiple of their size, above which outlines are not searched.
const SEARCH_DISTANCE: f64 = 1e6;
/// Most pairs of pieces that one search examines.
const MOST_PAIRS: usize = 1_000_000;

/// The search for the touches of a pair of outlines.
#[derive(Debug)]
pub struct Curves {
    /// outline of I
    i: Arc<Outline>,
    /// outline of J
    j: Arc<Outline>,
    /// radius of the smaller outline, in length units
    size: f64,
}

/// The position of I's plane relative to J's.
#[derive(Clone, Copy)]
struct Pose {
    /// origin of I's plane
    at: Flat,
    /// x axis of I's plane
    x: Flat,
    /// y axis of I's plane
    y: Flat,
}

impl Pose {
    fn turned(&self, v: Flat) -> Flat {
        [
            self.x[0] * v[0] + self.y[0] * v[1],
            self.x[1] * v[0] + self.y[1] * v[1],
        ]
    }
    fn point(&self, p: Flat) -> Flat {
        along(self.turned(p), 1.0, self.at)
    }
    /// Turns a vector of J's plane into I's.
    fn back(&self, v: Flat) -> Flat {
        [dot(self.x, v), dot(self.y, v)]
    }
    /// Turns the direction (an angle, in rad) of a vector of I's plane into J's.
    fn direction(&self, angle: f64) -> f64 {
        let (sin, cos) = Scalar::sin_cos(angle);
        let v = self.turned([cos, sin]);
        Scalar::atan2(v[1], v[0])
    }
    fn spot(&self, spot: &Spot) -> Spot {
        Spot {
            at: self.point(spot.at),
            tangent: self.turned(spot.tangent),
            bend: self.turned(spot.bend),
            normal: self.turned(spot.normal),
        }
    }
}

/// A touch, expressed in J's plane.
#[derive(Clone, Copy, Debug)]
struct Found {
    /// point on I's outline
    on_i: Flat,
    /// point on J's outline
    on_j: Flat,
    /// from J's solid into I's
    normal: Flat,
    /// overlap, in length units
    depth: f64,
    /// weight before it shares with others
    weight: f64,
    /// parameter of I's outline, for a touch of smooth sides
    smooth: Option<f64>,
}

impl Curves {
    /// Prepares for the outlines of I and J; `None` if both are points.
    pub fn new(i: Arc<Outline>, j: Arc<Outline>) -> Option<Self> {
        let sizes = [&i, &j].into_iter().filter(|o| !o.is_point());
        let size = sizes.map(|o| o.size).fold(f64::INFINITY, f64::min);
        size.is_finite().then_some(Self { i, j, size })
    }

    /// Writes the touches for a pose of I's marker in J's, its position and the three columns of
    /// its axes, in the form that [`super::found`] reads   (TOUCHES × TOUCH_NUMBERS).
    pub fn ask(&self, pose: &[f64], out: &mut [f64]) {
        super::nothing(out);
        let reach = SEARCH_DISTANCE * (self.i.size + self.j.size);
        if pose.len() != 12 || !pose.iter().all(|x| x.abs() <= reach.max(2.0)) {
            return;
        }
        let (x, y) = ([pose[3], pose[4]], [pose[6], pose[7]]);
        // planes perpendicular to each other have no touch
        if cross(x, y).abs() < 0.5 {
            return;
        }
        let at = [pose[0], pose[1]];
        let pose = Pose { at, x, y };
        let mut found = self.touches(&pose);
        found.truncate(TOUCHES);
        // in an order that two equally deep touches do not exchange, since the result is
        // differentiated
        let place = |f: &Found| f.on_j[0] + 0.618 * f.on_j[1];
        found.sort_by(|a, b| place(a).total_cmp(&place(b)));
        for (touch, f) in out.chunks_mut(TOUCH_NUMBERS).zip(&found) {
            let p = pose.back(minus(f.on_i, pose.at));
            let all = [
                p[0],
                p[1],
                0.0,
                f.on_j[0],
                f.on_j[1],
                0.0,
                f.normal[0],
                f.normal[1],
                0.0,
                0.0,
                f.weight,
            ];
            touch.copy_from_slice(&all);
        }
    }

    /// Returns all touches, the deepest first, with their shares.
    fn touches(&self, pose: &Pose) -> Vec<Found> {
        let mut all = Vec::new();
        self.smooth(pose, &mut all);
        let limit = SOLID_DEPTH * self.size;
        let near = SHARING_DISTANCE * self.size;
        // the nearest point to one corner is close to that of the next one
        let mut hint = None;
        for corner in self.i.corners.iter().filter(|c| c.convex) {
            let p = pose.point(corner.at);
            if !self.j.may_hold(p, near, limit) {
                continue;
            }
            if let Some(Foot {
                at: on_j,
                normal,
                depth,
                straight,
            }) = nearest(&self.j, p, limit, hint)
            {
                hint = Some(on_j);
                let inward = [-normal[0], -normal[1]];
                let direction = Scalar::atan2(inward[1], inward[0]);
                let normals = corner.normals.map(|n| pose.direction(n));
                let weight = share(corner, self.i.is_point(), normals, (direction, straight));
                all.push(Found {
                    on_i: p,
                    on_j,
                    normal,
                    depth,
                    weight,
                    smooth: None,
                });
            }
        }
        let mut hint = None;
        for corner in self.j.corners.iter().filter(|c| c.convex) {
            let p = pose.back(minus(corner.at, pose.at));
            if !self.i.may_hold(p, near, limit) {
                continue;
            }
            if let Some(Foot {
                at: on_i,
                normal,
                depth,
                straight,
            }) = nearest(&self.i, p, limit, hint)
            {
                hint = Some(on_i);
                let inward = pose.turned([-normal[0], -normal[1]]);
                // from J's solid into I's
                let direction = Scalar::atan2(inward[1], inward[0]);
                let weight = share(
                    corner,
                    self.j.is_point(),
                    corner.normals,
                    (direction, straight),
                );
                all.push(Found {
                    on_i: pose.point(on_i),
                    on_j: corner.at,
                    normal: inward,
                    depth,
                    weight,
                    smooth: None,
                });
            }
        }
        self.shared(pose, all)
    }

    /// Collects the touches of smooth sides, where (1) and (2) hold.
    fn smooth(&self, pose: &Pose, all: &mut Vec<Found>) {
        let (Some(root_i), Some(root_j)) = (self.i.root(), self.j.root()) else {
            return;
        };
        let reach = SOLID_DEPTH * self.size;
        let mirrored = cross(pose.x, pose.y) < 0.0;
        let turn = Scalar::atan2(pose.x[1], pose.x[0]);
        let towards = |n: &Node| {
            if mirrored {
                turn - n.normal
            } else {
                turn + n.normal
            }
        };
        let mut waiting = vec![(root_i, root_j)];
        let mut seen = 0;
        while let Some((a, b)) = waiting.pop() {
            seen += 1;
            if seen > MOST_PAIRS {
                break;
            }
            let (i, j) = (&self.i.nodes[a], &self.j.nodes[b]);
            if i.straight && j.straight {
                continue;
            }
            let spread = i.spread + j.spread;
            let direction = towards(i);
            if wrapped(direction - j.normal - PI).abs() > spread {
                continue;
            }
            let between = minus(pose.point(i.centre), j.centre);
            let (distance, radii) = (length(between), i.radius + j.radius);
            if distance > radii + reach {
                continue;
            }
            // the vector between them is along both normals
            let aside = |angle: f64, spread: f64| {
                let (sin, cos) = Scalar::sin_cos(angle);
                spread < 1.5
                    && cross(between, [cos, sin]).abs() > radii + distance * Scalar::sin(spread)
            };
            if aside(j.normal, j.spread) || aside(direction, i.spread) {
                continue;
            }
            match (i.halves, j.halves) {
                (Some([p, q]), None) => waiting.extend([(p, b), (q, b)]),
                (None, Some([p, q])) => waiting.extend([(a, p), (a, q)]),
                (Some([p, q]), Some([r, s])) => {
                    if i.radius * (1.0 + i.spread) > j.radius * (1.0 + j.spread) {
                        waiting.extend([(p, b), (q, b)]);
                    } else {
                        waiting.extend([(a, r), (a, s)]);
                    }
                }
                (None, None) => {
                    all.extend(self.common_normal(pose, i.cells.start, j.cells.start));
                }
            }
        }
    }

    /// Solves for the touch of two cells by Newton's iteration.
    fn common_normal(&self, pose: &Pose, cell_i: usize, cell_j: usize) -> Option<Found> {
        let [ci, cj] = [&self.i.cells[cell_i], &self.j.cells[cell_j]];
        let width = [ci.s[1] - ci.s[0], cj.s[1] - cj.s[0]];
        let [mut a, mut b] = [0.5 * (ci.s[0] + ci.s[1]), 0.5 * (cj.s[0] + cj.s[1])];
        let keep =
            |s: f64, range: [f64; 2], width: f64| s.clamp(range[0] - width, range[1] + width);
        let mut done = false;
        for _ in 0..25 {
            let p = pose.spot(&self.i.spot(a));
            let q = self.j.spot(b);
            let d = minus(p.at, q.at);
            let f = dot(d, p.tangent);
            let g = cross(p.tangent, q.tangent);
            let fa = dot(p.tangent, p.tangent) + dot(d, p.bend);
            let fb = -dot(q.tangent, p.tangent);
            let ga = cross(p.bend, q.tangent);
            let gb = cross(p.tangent, q.bend);
            let det = fa * gb - fb * ga;
            let (da, db) = ((f * gb - g * fb) / det, (g * fa - f * ga) / det);
            if !(da.is_finite() && db.is_finite()) {
                return None;
            }
            // the curves are extended beyond their cells only as far as their polynomials are
            // usable
            a = keep(a - da, ci.s, width[0]);
            b = keep(b - db, cj.s, width[1]);
            if done {
                break;
            }
            done = da.abs() < 1e-9 * width[0] && db.abs() < 1e-9 * width[1];
        }
        let inside = |s: f64, range: [f64; 2], width: f64| {
            s >= range[0] - 1e-9 * width && s <= range[1] + 1e-9 * width
        };
        if !done || !inside(a, ci.s, width[0]) || !inside(b, cj.s, width[1]) {
            return None;
        }
        let p = pose.spot(&self.i.spot(a));
        let q = self.j.spot(b);
        let gap = dot(minus(p.at, q.at), q.normal);
        let (k, l) = (p.curvature(), q.curvature());
        let apart = k + l + gap * k * l;
        if dot(p.normal, q.normal) >= 0.0
            || apart.is_nan()
            || apart <= FITTING_CURVATURE / self.size
            || gap.abs() > SOLID_DEPTH * self.size
        {
            return None;
        }
        if gap < 0.0 {
            let (u, v) = (
                [p.at, q.at],
                [p.at, q.at].map(|x| pose.back(minus(x, pose.at))),
            );
            if self.j.is_crossed(u[0], u[1], cell_j) || self.i.is_crossed(v[0], v[1], cell_i) {
                return None;
            }
        }
        Some(Found {
            on_i: p.at,
            on_j: q.at,
            normal: q.normal,
            depth: -gap,
            weight: 1.0,
            smooth: Some(a),
        })
    }

    /// Divides between touches of smooth sides with a barrier between them that is lower than they
    /// are deep.
    fn grow_together(&self, pose: &Pose, found: &mut [Found]) {
        let mut along: Vec<(f64, usize)> = (0..found.len())
            .filter(|&k| found[k].depth > 0.0)
            .filter_map(|k| Some((found[k].smooth?, k)))
            .collect();
        along.sort_by(|a, b| a.0.total_cmp(&b.0));
        let n = along.len();
        let pairs = match n {
            0 | 1 => 0,
            2 => 1,
            _ if self.i.closed => n,
            _ => n - 1,
        };
        for k in 0..pairs {
            let ((a, i), (mut b, j)) = (along[k], along[(k + 1) % n]);
            // once around is 2; the shorter of the two ways
            if self.i.closed && b - a > 1.0 {
                b -= 2.0;
            } else if self.i.closed && b < a - 1.0 {
                b += 2.0;
            }
            let (high, low) = if found[i].depth < found[j].depth {
                (i, j)
            } else {
                (j, i)
            };
            let (ground, base) = (-found[high].depth, -found[low].depth);
            let mut wall = ground;
            for step in 1..BARRIER_PARTS {
                let s = a + (b - a) * f64::from(step) / f64::from(BARRIER_PARTS);
                let p = pose.point(self.i.spot(s).at);
                let foot = nearest(&self.j, p, SOLID_DEPTH * self.size, None);
                wall = wall.max(foot.map_or(0.0, |foot| -foot.depth));
                if wall >= 0.0 {
                    break;
                }
            }
            let (height, step) = (wall - ground, ground - base);
            let together = (1.0 - height / -ground).max(0.0);
            let apart = step / (step + height).max(f64::MIN_POSITIVE);
            found[high].weight *= 1.0 - 0.5 * together * (1.0 + apart);
            found[low].weight *= 1.0 - 0.5 * together * (1.0 - apart);
        }
    }

    /// Unites touches at the same place and sets shares; returns the deepest first, at most
    /// [`TOUCHES`].
    fn shared(&self, pose: &Pose, mut all: Vec<Found>) -> Vec<Found> {
        all.retain(|f| f.weight > 0.0 && f.depth.is_finite());
        all.sort_by(|a, b| b.depth.total_cmp(&a.depth));
        let near = SAME_DISTANCE * self.size;
        let mut found: Vec<Found> = Vec::new();
        for f in all {
            let same = |other: &Found| {
                length(minus(other.on_i, f.on_i)) <= near
                    && length(minus(other.on_j, f.on_j)) <= near
            };
            if !found.iter().any(same) {
                found.push(f);
            }
            // touches less deep than these hardly ever number as many
            if found.len() == 2 * TOUCHES {
                break;
            }
        }
        self.grow_together(pose, &mut found);
        let reach = SHARING_DISTANCE * self.size;
        let crowd = |f: &Found| -> f64 {
            let part = |other: &Found| {
                let near = 1.0 - (length(minus(other.on_j, f.on_j)) / reach).powi(2);
                let alike = dot(other.normal, f.normal).max(0.0);
                // a shallower touch takes less from the others, and nothing while it is above the
                // surface
                let deep = if f.depth > 0.0 {
                    (other.depth / f.depth).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                other.weight * near.max(0.0).powi(2) * alike * alike * deep
            };
            found.iter().map(part).sum()
        };
        let shares: Vec<f64> = found.iter().map(|f| f.weight / crowd(f).max(1.0)).collect();
        for (f, share) in found.iter_mut().zip(shares) {
            f.weight = share;
        }
        found.truncate(TOUCHES);
        found
    }
}

/// Returns the share of a corner in a touch along an outward direction, with a side that is
/// straight or not.
fn share(
    corner: &Corner,
    is_point: bool,
    normals: [f64; 2],
    (direction, straight): (f64, bool),
) -> f64 {
    if is_point {
        return 1.0;
    }
    let width = wrapped(normals[1] - normals[0]);
    let offset = wrapped(direction - normals[0] - 0.5 * width) * width.signum();
    let beyond = offset.abs() - 0.5 * width.abs();
    if beyond <= 0.0 {
        return 1.0;
    }
    // a curved side touches by itself; 1e-9 is for rounding at its end
    let lies = straight && corner.straight[usize::from(offset > 0.0)];
    let allowed = if lies { CORNER_FADE_ANGLE } else { 1e-9 };
    (1.0 - (beyond / allowed).powi(2)).max(0.0).powi(2)
}

/// The point of an outline that is nearest to another point.
struct Foot {
    /// the point
    at: Flat,
    /// outward
    normal: Flat,
    /// depth of the other point below it, in length units
    depth: f64,
    /// whether it lies on a straight side
    straight: bool,
}

/// Finds the point of an outline nearest to `p`, within `limit`; `hint` is a point that may be
/// close.
fn nearest(outline: &Outline, p: Flat, limit: f64, hint: Option<Flat>) -> Option<Foot> {
    let (cell, s, at) = outline.nearest(p, limit, hint)?;
    let c = &outline.cells[cell];
    let apart = minus(p, at);
    let distance = length(apart);
    // a little inside its cell, where the tangent is that of this side
    let width = c.s[1] - c.s[0];
    let inside = s.clamp(c.s[0] + 1e-9 * width, c.s[1] - 1e-9 * width);
    let side = if c.straight {
        outline.normal(minus(c.ends[1], c.ends[0]))
    } else {
        outline.spot(inside).normal
    };
    let end = if s <= c.s[0] {
        c.corner[0]
    } else if s >= c.s[1] {
        c.corner[1]
    } else {
        None
    };
    let aside = cross(apart, side).abs() > 1e-9 * distance;
    match end {
        // the nearest point is a corner itself
        Some(corner) if distance > 1e-9 * outline.size && aside => {
            let sign = if outline.corners[corner].convex {
                1.0
            } else {
                -1.0
            };
            Some(Foot {
                at,
                normal: [sign * apart[0] / distance, sign * apart[1] / distance],
                depth: -sign * distance,
                straight: false,
            })
        }
        _ => Some(Foot {
            at,
            normal: side,
            depth: -dot(apart, side),
            straight: c.straight,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::super::outline::Rim;
    use super::*;
    use crate::expr::interpolation::{Curve, CurvePoints};
    use crate::physics::cam::Path;
    use std::f64::consts::TAU;

    fn circle(radius: f64, flipped: bool) -> Arc<Outline> {
        Arc::new(Outline::new(Rim::Circle(radius, TAU), flipped).unwrap())
    }

    fn depths(c: &Curves, at: Flat, angle: f64) -> Vec<f64> {
        let (sin, cos) = angle.sin_cos();
        let pose = Pose {
            at,
            x: [cos, sin],
            y: [-sin, cos],
        };
        c.touches(&pose).iter().map(|f| f.depth).collect()
    }

    #[test]
    fn circles_touch_once_as_deep_as_their_centres_tell() {
        let outside = Curves::new(circle(1.0, false), circle(2.0, false)).unwrap();
        let inside = Curves::new(circle(1.0, false), circle(2.0, true)).unwrap();
        for k in 0..100 {
            let angle = f64::from(k) * 0.7;
            for (c, distance, depth) in [
                (&outside, 2.9, 0.1),
                (&outside, 3.01, -0.01),
                (&outside, 2.6, 0.4),
                (&inside, 1.01, 0.01),
                (&inside, 0.9, -0.1),
            ] {
                let found = depths(
                    c,
                    [distance * angle.cos(), distance * angle.sin()],
                    1.3 * angle,
                );
                assert_eq!(found.len(), 1, "{distance} {k}");
                assert!((found[0] - depth).abs() < 1e-14, "{distance} {k} {found:?}");
            }
        }
    }

    /// Force and torque of linear springs of stiffness 1 on I, in J's plane about J's origin.
    fn springs(c: &Curves, at: Flat, angle: f64) -> [f64; 3] {
        let (sin, cos) = angle.sin_cos();
        let pose = Pose {
            at,
            x: [cos, sin],
            y: [-sin, cos],
        };
        let mut sum = [0.0; 3];
        for f in c.touches(&pose) {
            let n = f.depth.max(0.0) * f.weight;
            sum[0] += n * f.normal[0];
            sum[1] += n * f.normal[1];
            sum[2] += n * cross(f.on_j, f.normal);
        }
        sum
    }

    #[test]
    fn two_touches_that_grow_together_leave_no_jump() {
        // an ellipse of half axes 1 and 0.6 in a round hole of radius 1.2: its blunt side, of
        // radius 1.67, touches twice, 0.12 and 0.19 deep where the one ends
        let points: Vec<[f64; 3]> = (0..=200)
            .map(|k| {
                let (sin, cos) = (TAU * f64::from(k % 200) / 200.0).sin_cos();
                [cos, 0.6 * sin, 0.0]
            })
            .collect();
        let curve = Curve::new(&points, true, 4, CurvePoints::OnCurve).expect("a curve");
        let path = Path::new(&curve);
        let ellipse = Arc::new(Outline::new(Rim::Path(Box::new(path)), false).unwrap());
        let c = Curves::new(ellipse, circle(1.2, true)).unwrap();
        let jump = |parts: u32| {
            let at = |k: u32| {
                let u = f64::from(k) / f64::from(parts);
                springs(&c, [0.02, -0.73], -0.1 + 0.4 * u)
            };
            (0..parts)
                .flat_map(|k| {
                    let (a, b) = (at(k), at(k + 1));
                    (0..3).map(move |c| (a[c] - b[c]).abs())
                })
                .fold(0.0, f64::max)
        };
        let (coarse, fine) = (jump(50), jump(500));
        assert!(fine < 0.35 * coarse, "{coarse:e} {fine:e}");
    }

    #[test]
    fn a_circle_in_another_circles_depth_limit_is_left_alone() {
        let c = Curves::new(circle(1.0, false), circle(2.0, false)).unwrap();
        assert!(depths(&c, [2.4, 0.0], 0.0).is_empty());
        assert!(depths(&c, [1e9, 0.0], 0.0).is_empty());
    }
}
