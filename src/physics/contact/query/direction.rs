//! The direction from one solid to another in which they overlap least.

use super::super::Solid;
use super::Query;
use super::body::vector;
use super::flat::nearest;
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::details::contact_support_map_support_map_with_params;
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};
use parry3d_f64::query::sat;
use parry3d_f64::shape::{Cuboid, SupportMap};

/// How much a direction is corrected at most.
const POLISH: f64 = 1e-2;
/// A direction is doubted where the gap along it is not what was claimed, by this part of the solids' size.
const CLAIM: f64 = 1e-6;

impl Query {
    /// I's farthest point against n and J's along it, in J's frame.
    fn farthest(&self, pose: &Pose, n: Vector) -> (Vector, Vector) {
        (
            self.i.support_point(pose, -n),
            self.j.local_support_point(n),
        )
    }

    /// The gap along a direction.
    fn gap(&self, pose: &Pose, n: Vector) -> f64 {
        let (a, b) = self.farthest(pose, n);
        (a - b).dot(n)
    }

    /// The direction from J's solid to I's, in J's frame.
    pub(super) fn direction(&self, pose: &Pose) -> Option<Vector> {
        let mut n = match (&self.i.solid, &self.j.solid) {
            (Solid::Box { low: li, high: hi }, Solid::Box { low: lj, high: hj }) => {
                boxes(pose, (vector(*li), vector(*hi)), (vector(*lj), vector(*hj)))
            }
            _ => self.separated(pose)?,
        };
        let mut gap = self.gap(pose, n);
        let rounding = 1e-13 * (self.i.size[1] + self.j.size[1]);
        let back = pose.inverse_transform_vector(-n);
        let faces = [
            self.j.face(n).normal,
            self.i.face(back).normal.map(|m| -pose.transform_vector(m)),
        ];
        for face in faces.into_iter().flatten() {
            let other = self.gap(pose, face);
            if other >= gap - rounding {
                (n, gap) = (face, other.max(gap));
            }
        }
        n = self.polished(pose, n);
        n.is_finite().then_some(n)
    }

    /// The direction by the algorithms for convex solids in general. Where solids just touch, these may take any: then solids that are
    /// moved a little from each other, or into each other, tell.
    fn separated(&self, pose: &Pose) -> Option<Vector> {
        let size = self.i.size[1] + self.j.size[1];
        let (n, claimed) = self.claimed(pose)?;
        let mut best = (self.gap(pose, n), n);
        if (best.0 - claimed).abs() <= CLAIM * size {
            return Some(n);
        }
        let middle = pose.translation.try_normalize();
        for away in [middle.unwrap_or(Vector::Z), n] {
            for shift in [1e-7, -1e-7] {
                let moved =
                    Pose::from_parts(pose.translation + away * (shift * size), pose.rotation);
                if let Some((n, _)) = self.claimed(&moved) {
                    let gap = self.gap(pose, n);
                    if gap > best.0 {
                        best = (gap, n);
                    }
                }
            }
        }
        Some(best.1)
    }

    /// What the first start that works leads to: a direction, and the gap that it is said to have.
    fn claimed(&self, pose: &Pose) -> Option<(Vector, f64)> {
        let middle = pose.translation.try_normalize();
        let starts = [middle, Some(Vector::Z), Some(Vector::X), Some(Vector::Y)];
        starts.into_iter().flatten().find_map(|start| {
            let found = contact_support_map_support_map_with_params(
                pose,
                &self.j,
                &self.i,
                f64::MAX,
                &mut VoronoiSimplex::new(),
                Some(start),
            );
            match found {
                GJKResult::ClosestPoints(p, q, n) => {
                    let n = n.try_normalize()?;
                    Some((n, (q - p).dot(n)))
                }
                _ => None,
            }
        })
    }

    /// How far, across n, I's curved side lies beside J's; `None` where one of them is flat.
    fn offset(&self, pose: &Pose, n: Vector) -> Option<Vector> {
        let mut i = self.i.face(pose.inverse_transform_vector(-n));
        let j = self.j.face(n);
        if i.normal.is_some() || j.normal.is_some() {
            return None;
        }
        for p in &mut i.outline {
            *p = pose.transform_point(*p);
        }
        let (e, f) = n.any_orthonormal_pair();
        let [p, q] = nearest(&i.laid(e, f), &j.laid(e, f))?;
        Some(e * (p[0] - q[0]) + f * (p[1] - q[1]))
    }

    /// The direction at which two curved sides look at each other, by Newton's iteration.
    fn polished(&self, pose: &Pose, n: Vector) -> Vector {
        let (e, f) = n.any_orthonormal_pair();
        let at = |u: f64, v: f64| (n + e * u + f * v).normalize();
        let offset = |u: f64, v: f64| {
            let d = self.offset(pose, at(u, v))?;
            Some([d.dot(e), d.dot(f)])
        };
        let (mut u, mut v) = (0.0, 0.0);
        let mut best = (f64::INFINITY, n);
        for _ in 0..12 {
            let Some([x, y]) = offset(u, v) else {
                break;
            };
            let size = x.hypot(y);
            if size >= 0.5 * best.0 || size.is_nan() {
                break;
            }
            best = (size, at(u, v));
            let h = 1e-6;
            let ends = [
                offset(u + h, v),
                offset(u - h, v),
                offset(u, v + h),
                offset(u, v - h),
            ];
            let [Some(a), Some(b), Some(c), Some(d)] = ends else {
                break;
            };
            let [g, k] =
                [(a, b), (c, d)].map(|(up, down)| [0, 1].map(|r| (up[r] - down[r]) / (2.0 * h)));
            // least squares: along a line nothing changes
            let (gg, gk, kk) = (
                g[0] * g[0] + g[1] * g[1],
                g[0] * k[0] + g[1] * k[1],
                k[0] * k[0] + k[1] * k[1],
            );
            let flat = 1e-12 * (gg + kk);
            let (gg, kk) = (gg + flat, kk + flat);
            let (gx, kx) = (g[0] * x + g[1] * y, k[0] * x + k[1] * y);
            let det = gg * kk - gk * gk;
            let (du, dv) = ((gx * kk - kx * gk) / det, (gg * kx - gk * gx) / det);
            (u, v) = (u - du, v - dv);
            // far away is another place
            if (u + v).is_nan() || u.abs().max(v.abs()) >= POLISH {
                break;
            }
        }
        best.1
    }
}

/// The direction from box J to box I, in J's frame, in which they overlap least: lower and upper corners.
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
