//! The corners of the convex hull of many points, few enough for contacts.
//!
//! 1. The farthest points in many directions, none of which is along an axis or perpendicular to a
//!    likely face: these are corners, and all of them where few faces bound the solid. Points
//!    within a face are not corners.
//! 2. The hull of these (parry), and for each of its faces the point farthest outside: it is added,
//!    until no point is outside or there are [`MOST_CORNERS`]. The distance that then still stands
//!    out is reported.

use super::body::vector;
use crate::scalar::Scalar;
use parry3d_f64::math::Vector;
use parry3d_f64::shape::ConvexPolyhedron;

/// Most corners of a hull.
pub const MOST_CORNERS: usize = 160;
/// Number of directions in which farthest points are sought first.
const FIRST_DIRECTIONS: usize = 64;
/// Distance outside, as a part of the extent, below which points are on the hull: the single
/// precision of shell files.
const ON_HULL: f64 = 1e-6;

/// Corners of a convex hull.
#[derive(Clone, Debug, PartialEq)]
pub struct Corners {
    /// corners, in the coordinates of the points
    pub corners: Vec<[f64; 3]>,
    /// largest distance of a point outside the hull of these corners
    pub outside: f64,
}

/// Finds the corners of the convex hull of points; `None` if they span no volume.
pub fn corners(points: &[[f64; 3]]) -> Option<Corners> {
    let all: Vec<Vector> = points.iter().map(|&p| vector(p)).collect();
    let (mut low, mut high) = (*all.first()?, *all.first()?);
    for p in &all {
        (low, high) = (low.min(*p), high.max(*p));
    }
    let extent = (high - low).length();
    if !(extent > 0.0 && extent.is_finite()) {
        return None;
    }
    let farthest = |dir: Vector| -> usize {
        let along = |k: &usize| all[*k].dot(dir);
        (0..all.len())
            .max_by(|a, b| along(a).total_cmp(&along(b)))
            .unwrap_or(0)
    };
    let mut chosen: Vec<usize> = directions().map(farthest).collect();
    loop {
        chosen.sort_unstable_by(|&a, &b| {
            all[a]
                .to_array()
                .partial_cmp(&all[b].to_array())
                .unwrap_or(std::cmp::Ordering::Equal)
        });
        chosen.dedup_by(|a, b| (all[*a] - all[*b]).length() <= ON_HULL * extent);
        let corners: Vec<Vector> = chosen.iter().map(|&k| all[k]).collect();
        if corners.len() < 4 {
            return None;
        }
        let hull = ConvexPolyhedron::from_convex_hull(&corners)?;
        let mut outside = 0.0_f64;
        let mut more = Vec::new();
        for face in hull.faces() {
            let first = *hull
                .vertices_adj_to_face()
                .get(face.first_vertex_or_edge as usize)?;
            let height = hull.points()[first as usize].dot(face.normal);
            let thickness = corners.iter().map(|p| height - p.dot(face.normal));
            if thickness.fold(0.0, f64::max) <= ON_HULL * extent {
                return None;
            }
            let k = farthest(face.normal);
            let beyond = all[k].dot(face.normal) - height;
            outside = outside.max(beyond);
            if beyond > ON_HULL * extent {
                more.push(k);
            }
        }
        more.sort_unstable();
        more.dedup();
        more.retain(|k| !chosen.contains(k));
        more.truncate(MOST_CORNERS.saturating_sub(chosen.len()));
        if more.is_empty() {
            let corners = corners.iter().map(|p| p.to_array()).collect();
            return Some(Corners { corners, outside });
        }
        chosen.extend(more);
    }
}

/// Iterates over unit vectors spread over the sphere, turned away from the axes along which things
/// are usually built.
fn directions() -> impl Iterator<Item = Vector> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..FIRST_DIRECTIONS).map(move |k| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / FIRST_DIRECTIONS as f64;
        let r = (1.0 - z * z).sqrt();
        let (s, c) = Scalar::sin_cos(golden * k as f64 + 0.1234);
        // about x, by an arbitrary angle
        let (x, y) = (r * c, r * s);
        let (sa, ca) = Scalar::sin_cos(0.377_f64);
        Vector::new(x, y * ca - z * sa, y * sa + z * ca)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_of_many_points_has_eight_corners() {
        let mut points = Vec::new();
        let steps = [-1.0, -0.5, 0.0, 0.25, 1.0];
        for x in steps {
            for y in steps {
                for z in steps {
                    points.push([3.0 * x, 2.0 * y + 10.0, 0.1 * z]);
                }
            }
        }
        let found = corners(&points).expect("a volume");
        assert_eq!(found.corners.len(), 8, "{found:?}");
        assert!(found.outside < 1e-12);
    }

    #[test]
    fn a_fine_sphere_is_told_how_far_it_is_cut() {
        let n = 4000;
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let points: Vec<[f64; 3]> = (0..n)
            .map(|k| {
                let z = 1.0 - (2.0 * k as f64 + 1.0) / n as f64;
                let (s, c) = (golden * k as f64).sin_cos();
                let r = (1.0 - z * z).sqrt();
                [r * c, r * s, z]
            })
            .collect();
        let found = corners(&points).expect("a volume");
        assert!(found.corners.len() <= MOST_CORNERS);
        // a sphere of 160 corners: facets stand off by about 2/160 of the radius, and less than
        // five times that
        assert!(
            found.outside > 1e-3 && found.outside < 0.06,
            "{}",
            found.outside
        );
        let real = |k: usize| {
            let p = found.corners[k];
            (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt()
        };
        assert!((0..found.corners.len()).all(|k| (real(k) - 1.0).abs() < 1e-12));
    }

    #[test]
    fn points_in_a_plane_on_a_line_or_at_one_place_span_nothing() {
        let grid = |f: fn(f64, f64) -> [f64; 3]| -> Vec<[f64; 3]> {
            (0..49)
                .map(|k| f(f64::from(k % 7), f64::from(k / 7)))
                .collect()
        };
        assert_eq!(corners(&[]), None);
        assert_eq!(corners(&grid(|_, _| [1.0; 3])), None);
        assert_eq!(corners(&grid(|a, b| [a, b, 2.0])), None);
        assert_eq!(corners(&grid(|a, b| [a, b, 0.3 * a - 0.7 * b])), None);
        assert_eq!(corners(&grid(|a, _| [a, a, a])), None);
        assert_eq!(
            corners(&grid(|a, b| [a * 1e200, b * 1e200, a * b * 1e200])),
            None
        );
    }
}
