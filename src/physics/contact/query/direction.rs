//! The direction from one solid to another in which they overlap least.
//!
//! s(n) = n · (a(−n) − b(n)) is the gap along n, with a, b the farthest points of I's and J's
//! solid; the direction maximizes the gap.
//!
//! Where the solids are apart the algorithm of Gilbert, Johnson and Keerthi (parry) finds it. Where
//! they touch or overlap the gap is climbed: from the most promising of the axes of both solids,
//! I's solid is moved along n until there is a small gap, and the direction of that gap is better:
//!
//! ```text
//! n' = argmax s(m) − h (1 − m · n)      h: length of the move                         s(n') ≥ s(n)
//! ```
//!
//! That direction is good to some thousandths, as the algorithm stops at a part in 1e7 of the
//! distance. The features that face each other make it exact: faces have their normals, two edges
//! their product, an edge and a curved side or two curved sides a few steps of Newton's iteration.
//! The one with the largest gap is taken, so that a wrong guess does no harm.

use super::super::Solid;
use super::Query;
use super::body::vector;
use crate::scalar::{Scalar, hypot};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::gjk::{self, CsoPoint, GJKResult, VoronoiSimplex};
use parry3d_f64::query::sat;
use parry3d_f64::shape::{Cuboid, SupportMap};

/// Gap to which overlapping solids are moved apart, as a part of the smaller extents.
const SEPARATED_GAP: f64 = 1e-2;
/// Most directions from which the gap is climbed.
const MOST_STARTS: usize = 3;
/// Most steps of each climb.
const MOST_CLIMB_STEPS: usize = 12;
/// Change of a direction, in rad, above which an iteration has left its feature.
const LARGEST_STEP: f64 = 0.1;

impl Query {
    /// Returns I's farthest point against n and J's along it, in J's frame.
    pub(super) fn farthest(&self, pose: &Pose, n: Vector) -> (Vector, Vector) {
        (
            self.i.support_point(pose, -n),
            self.j.local_support_point(n),
        )
    }

    /// Returns the gap along a direction.
    fn gap(&self, pose: &Pose, n: Vector) -> f64 {
        let (a, b) = self.farthest(pose, n);
        (a - b).dot(n)
    }

    /// Returns the direction from J's solid to I's in which they overlap least, in J's frame.
    pub(super) fn direction(&self, pose: &Pose) -> Option<Vector> {
        let n = match (&self.i.solid, &self.j.solid) {
            (Solid::Box { low: li, high: hi }, Solid::Box { low: lj, high: hj }) => {
                boxes(pose, (vector(*li), vector(*hi)), (vector(*lj), vector(*hj)))
            }
            _ => self.roughly(pose)?,
        };
        let mut best = (self.gap(pose, n), n);
        let rounding = 1e-13 * (self.i.size[1] + self.j.size[1]);
        let mut consider = |m: Option<Vector>| {
            let Some(m) = m.filter(|m| m.is_finite()) else {
                return;
            };
            let gap = self.gap(pose, m);
            // features are exact where they are no worse
            if gap >= best.0 - rounding {
                best = (gap.max(best.0), m);
            }
        };
        let back = pose.inverse_transform_vector(-n);
        let edge_i = |n: Vector| {
            let edge = self.i.edge(pose.inverse_transform_vector(-n))?;
            Some(edge.map(|p| pose.transform_point(p)))
        };
        let edge_j = |n: Vector| self.j.edge(n);
        let point_i = |n: Vector| self.i.support_point(pose, -n);
        let point_j = |n: Vector| self.j.local_support_point(n);
        consider(points(n, |m| point_i(m) - point_j(m)));
        consider(edge_and_point(n, edge_i, point_j));
        consider(edge_and_point(-n, |m| edge_j(-m), |m| point_i(-m)).map(|m| -m));
        consider(edges(n, edge_i, edge_j));
        consider(self.j.face(n).normal);
        consider(self.i.face(back).normal.map(|m| -pose.transform_vector(m)));
        best.1.is_finite().then_some(best.1)
    }

    /// Returns the direction between the nearest points of solids that are apart.
    fn apart(&self, pose: &Pose) -> Option<Vector> {
        let start = pose.translation.try_normalize().unwrap_or(Vector::Z);
        let mut simplex = VoronoiSimplex::new();
        simplex.reset(CsoPoint::from_shapes(pose, &self.j, &self.i, start));
        match gjk::closest_points(pose, &self.j, &self.i, f64::MAX, true, &mut simplex) {
            GJKResult::ClosestPoints(_, _, n) => n.try_normalize(),
            _ => None,
        }
    }

    /// Returns the direction to within some thousandths.
    fn roughly(&self, pose: &Pose) -> Option<Vector> {
        let small = self.i.size[0].min(self.j.size[0]);
        if let Some(n) = self.apart(pose)
            && self.gap(pose, n) > 1e-3 * SEPARATED_GAP * small
        {
            return Some(n);
        }
        let mut starts: Vec<(f64, Vector)> = Vec::new();
        let mut start = |n: Vector| {
            for n in [n, -n] {
                if let Some(n) = n.try_normalize() {
                    starts.push((self.gap(pose, n), n));
                }
            }
        };
        let axes = [Vector::X, Vector::Y, Vector::Z];
        start(pose.translation);
        start(self.middle(pose));
        for a in axes {
            start(a);
            let turned = pose.transform_vector(a);
            start(turned);
            for b in axes {
                start(turned.cross(b));
            }
        }
        for n in self.j.normals() {
            start(n);
        }
        for n in self.i.normals() {
            start(pose.transform_vector(n));
        }
        starts.retain(|s| s.0.is_finite());
        starts.sort_by(|a, b| b.0.total_cmp(&a.0));
        starts.truncate(MOST_STARTS);
        let climbed = starts.into_iter().map(|(gap, n)| {
            let mut best = (gap, n);
            for _ in 0..MOST_CLIMB_STEPS {
                let (gap, n) = best;
                let away = n * (SEPARATED_GAP * small - gap);
                let moved = Pose::from_parts(pose.translation + away, pose.rotation);
                let Some(m) = self.apart(&moved) else { break };
                let better = self.gap(pose, m);
                if better <= gap + 1e-9 * small {
                    break;
                }
                best = (better, m);
            }
            best
        });
        let best = climbed.max_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, n)| n)
    }

    /// Returns the direction from the middle of J's solid to that of I's.
    fn middle(&self, pose: &Pose) -> Vector {
        pose.transform_point(self.i.middle) - self.j.middle
    }
}

/// Finds the direction along which two points that depend on it are in line, by Newton's iteration
/// across it.
fn points(n: Vector, between: impl Fn(Vector) -> Vector) -> Option<Vector> {
    let (e, f) = n.any_orthonormal_pair();
    let at = |u: f64, v: f64| (n + e * u + f * v).normalize();
    let offset = |u: f64, v: f64| {
        let d = between(at(u, v));
        [d.dot(e) - u * d.dot(n), d.dot(f) - v * d.dot(n)]
    };
    let (mut u, mut v) = (0.0, 0.0);
    for _ in 0..12 {
        let [x, y] = offset(u, v);
        let h = 1e-6;
        let [a, b, c, d] = [
            offset(u + h, v),
            offset(u - h, v),
            offset(u, v + h),
            offset(u, v - h),
        ];
        let slope = |p: [f64; 2], q: [f64; 2]| [0, 1].map(|k| (p[k] - q[k]) / (2.0 * h));
        let (g, k) = (slope(a, b), slope(c, d));
        let det = g[0] * k[1] - g[1] * k[0];
        let (du, dv) = ((x * k[1] - y * k[0]) / det, (y * g[0] - x * g[1]) / det);
        (u, v) = (u - du, v - dv);
        if (u + v).is_nan() || hypot(u, v) > LARGEST_STEP {
            return None;
        }
        if du.abs() + dv.abs() < 1e-15 {
            break;
        }
    }
    Some(at(u, v))
}

/// Finds the direction perpendicular to an edge of I's solid along which a point of J's lies below
/// it, by secants.
fn edge_and_point(
    n: Vector,
    edge: impl Fn(Vector) -> Option<[Vector; 2]>,
    point: impl Fn(Vector) -> Vector,
) -> Option<Vector> {
    let across = |n: Vector, along: Vector| (n - along * n.dot(along)).try_normalize();
    let along = |n: Vector| {
        let [p, q] = edge(n)?;
        (q - p).try_normalize()
    };
    let start = across(n, along(n)?)?;
    if (start - n).length() > LARGEST_STEP {
        return None;
    }
    let at = |angle: f64| {
        // an edge may turn with the direction, as the side of a cone does
        let mut m = start;
        for _ in 0..4 {
            let u = along(m)?;
            let square = across(start, u)?;
            m = square * Scalar::cos(angle) + u.cross(square) * Scalar::sin(angle);
        }
        Some(m)
    };
    let offset = |angle: f64| {
        let m = at(angle)?;
        let [p, q] = edge(m)?;
        let side = (q - p).try_normalize()?.cross(m);
        Some((p - point(m)).dot(side))
    };
    let (mut a, mut b) = (0.0, 1e-4);
    let (mut fa, mut fb) = (offset(a)?, offset(b)?);
    for _ in 0..20 {
        let next = b - fb * (b - a) / (fb - fa);
        if !next.is_finite() {
            break;
        }
        if next.abs() > LARGEST_STEP {
            return None;
        }
        (a, fa) = (b, fb);
        b = next;
        fb = offset(b)?;
        if (b - a).abs() < 1e-15 {
            break;
        }
    }
    at(b)
}

/// Returns the direction perpendicular to an edge of each.
fn edges(
    n: Vector,
    i: impl Fn(Vector) -> Option<[Vector; 2]>,
    j: impl Fn(Vector) -> Option<[Vector; 2]>,
) -> Option<Vector> {
    let mut m = n;
    for _ in 0..6 {
        let ([p, q], [r, s]) = (i(m)?, j(m)?);
        let square = (q - p).normalize().cross((s - r).normalize());
        // parallel edges have no product
        if square.length() < 1e-3 {
            return None;
        }
        let next = square.normalize() * square.dot(n).signum();
        let still = (next - m).length() < 1e-16;
        m = next;
        if still {
            break;
        }
    }
    ((m - n).length() < LARGEST_STEP).then_some(m)
}

/// Returns the direction from box J to box I, in J's frame, in which they overlap least, from lower
/// and upper corners.
fn boxes(pose: &Pose, i: (Vector, Vector), j: (Vector, Vector)) -> Vector {
    let cuboid =
        |(low, high): (Vector, Vector)| (Cuboid::new((high - low) * 0.5), (high + low) * 0.5);
    let ((box_i, middle_i), (box_j, middle_j)) = (cuboid(i), cuboid(j));
    let i_in_j = Pose::from_parts(pose.transform_point(middle_i) - middle_j, pose.rotation);
    let j_in_i = i_in_j.inverse();
    let of_j = sat::cuboid_cuboid_find_local_separating_normal_oneway(&box_j, &box_i, &i_in_j);
    let of_i = sat::cuboid_cuboid_find_local_separating_normal_oneway(&box_i, &box_j, &j_in_i);
    let edges = sat::cuboid_cuboid_find_local_separating_edge_twoway(&box_j, &box_i, &i_in_j);
    let mut best = (of_j.0, of_j.1);
    if of_i.0 > best.0 {
        best = (of_i.0, i_in_j.transform_vector(-of_i.1));
    }
    if edges.0 > best.0 {
        best = edges;
    }
    best.1
}
