//! A convex hull as searches use it: its farthest corner, the face in a direction, the distance of
//! a point from it.
//!
//! On a convex polytope a corner without a farther neighbour is the farthest. So the search climbs
//! from corner to corner, beginning at the farthest of a few directions.

use parry3d_f64::math::Vector;
use parry3d_f64::shape::ConvexPolyhedron;

/// A face of a polytope.
#[derive(Debug)]
pub(super) struct Side {
    /// outward normal
    pub normal: Vector,
    /// its corners, in order around it
    pub ids: Vec<usize>,
}

/// A convex polytope.
#[derive(Debug)]
pub(super) struct Polytope {
    /// corners, in the frame of the solid
    pub corners: Vec<Vector>,
    /// faces
    pub sides: Vec<Side>,
    /// for each corner, those that share an edge with it
    beside: Vec<Vec<usize>>,
    /// the farthest corner along each vector of −1, 0, 1
    farthest: [usize; 27],
}

/// Rounds a direction to one of 27.
fn coarse(dir: Vector) -> usize {
    let part = 0.4 * dir.abs().max_element();
    let digit = |x: f64| {
        if x > part { 2 } else { usize::from(x >= -part) }
    };
    9 * digit(dir.x) + 3 * digit(dir.y) + digit(dir.z)
}

impl Polytope {
    /// Builds the hull of points; `None` if they span no volume.
    pub fn new(points: &[Vector]) -> Option<Self> {
        let hull = ConvexPolyhedron::from_convex_hull(points)?;
        let sides = hull.faces().iter().map(|face| {
            let first = face.first_vertex_or_edge as usize;
            let n = face.num_vertices_or_edges as usize;
            let around = &hull.vertices_adj_to_face()[first..][..n];
            Side {
                normal: face.normal,
                ids: around.iter().map(|&v| v as usize).collect(),
            }
        });
        let mut this = Self {
            corners: hull.points().to_vec(),
            sides: sides.collect(),
            beside: vec![Vec::new(); hull.points().len()],
            farthest: [0; 27],
        };
        for side in &this.sides {
            for (k, &a) in side.ids.iter().enumerate() {
                let b = side.ids[(k + 1) % side.ids.len()];
                for (a, b) in [(a, b), (b, a)] {
                    if !this.beside[a].contains(&b) {
                        this.beside[a].push(b);
                    }
                }
            }
        }
        for k in 0..27 {
            let digit = |n: usize| (k / n % 3) as f64 - 1.0;
            let dir = Vector::new(digit(9), digit(3), digit(1));
            let along = |&a: &usize| this.corners[a].dot(dir);
            // points that parry found within have no faces
            let real = (0..this.corners.len()).filter(|&a| !this.beside[a].is_empty());
            this.farthest[k] = real.max_by(|a, b| along(a).total_cmp(&along(b)))?;
        }
        Some(this)
    }

    /// Returns the farthest corner in a direction.
    pub fn support(&self, dir: Vector) -> usize {
        let mut best = self.farthest[coarse(dir)];
        let mut height = self.corners[best].dot(dir);
        loop {
            let mut next = best;
            for &k in &self.beside[best] {
                let h = self.corners[k].dot(dir);
                if h > height {
                    (next, height) = (k, h);
                }
            }
            if next == best {
                return best;
            }
            best = next;
        }
    }

    /// Returns, of the edges at the farthest corner, the one that stays farthest along the
    /// direction.
    pub fn edge(&self, dir: Vector) -> Option<[Vector; 2]> {
        let corner = self.support(dir);
        let along = |&k: &usize| self.corners[k].dot(dir);
        let other = self.beside[corner].iter().copied();
        let other = other.max_by(|a, b| along(a).total_cmp(&along(b)))?;
        Some([self.corners[corner], self.corners[other]])
    }

    /// Returns the face whose normal is closest to a direction.
    pub fn side(&self, dir: Vector) -> Option<&Side> {
        let along = |side: &&Side| side.normal.dot(dir);
        let sides = self.sides.iter();
        sides.max_by(|a, b| along(a).total_cmp(&along(b)))
    }

    /// Returns the signed distance of a point, negative inside, and the direction in which it
    /// grows; `size`: of the whole polytope.
    pub fn distance(&self, p: Vector, size: f64) -> (f64, Vector) {
        let above = |side: &Side| (p - self.corners[side.ids[0]]).dot(side.normal);
        let mut best = (f64::NEG_INFINITY, Vector::ZERO);
        for side in &self.sides {
            let d = above(side);
            if d > best.0 {
                best = (d, side.normal);
            }
        }
        if best.0 <= 0.0 {
            return best;
        }
        let nearer =
            |a: &Vector, b: &Vector| a.distance_squared(p).total_cmp(&b.distance_squared(p));
        // the foot lies on a face that is visible from the point: inside it, or on an edge
        let seen = self.sides.iter().filter(|side| above(side) > 0.0);
        let feet = seen.filter_map(|side| {
            let corners = side.ids.iter().map(|&k| self.corners[k]);
            let ends = corners.clone().zip(corners.cycle().skip(1));
            let ends = ends.take(side.ids.len());
            let within = p - side.normal * above(side);
            let inside =
                |(a, b): (Vector, Vector)| (b - a).cross(within - a).dot(side.normal) >= 0.0;
            if ends.clone().all(inside) {
                return Some(within);
            }
            let on_edge = |(a, b): (Vector, Vector)| {
                let along = b - a;
                let u = (p - a).dot(along) / along.length_squared();
                if u > 0.0 { a + along * u.min(1.0) } else { a }
            };
            ends.map(on_edge).min_by(nearer)
        });
        let foot = feet.min_by(nearer);
        match foot.map(|foot| (foot.distance(p), (p - foot).try_normalize())) {
            Some((d, Some(n))) if d > 1e-12 * size => (d, n),
            _ => best,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points on a sphere, or on a grid of a cube, the same on every run.
    fn hull(n: usize, f: impl Fn(Vector) -> Vector) -> Polytope {
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let points: Vec<Vector> = (0..n)
            .map(|k| {
                let z = 1.0 - (2.0 * k as f64 + 1.0) / n as f64;
                let (s, c) = (golden * k as f64).sin_cos();
                let r = (1.0 - z * z).sqrt();
                f(Vector::new(r * c, r * s, z))
            })
            .collect();
        Polytope::new(&points).expect("a volume")
    }

    #[test]
    fn the_farthest_corner_is_climbed_to_from_anywhere() {
        let flat = hull(150, |p| Vector::new(p.x, 0.2 * p.y, 3.0 * p.z));
        let directions = hull(500, |p| p);
        for dir in &directions.corners {
            let climbed = flat.corners[flat.support(*dir)].dot(*dir);
            let all = flat.corners.iter().map(|p| p.dot(*dir));
            let farthest = all.fold(f64::MIN, f64::max);
            assert!(climbed >= farthest - 1e-15, "{dir:?}");
        }
    }

    #[test]
    fn a_hull_of_a_box_is_as_far_as_the_box() {
        use super::super::super::{Solid, ball};
        use crate::space::Vec3;
        let solid = Solid::Box {
            low: [-1.0, -2.0, -0.5],
            high: [1.0, 2.0, 0.5],
        };
        let corners: Vec<Vector> = (0..8)
            .map(|k| {
                let sign = |bit: usize| if k >> bit & 1 == 0 { -1.0 } else { 1.0 };
                Vector::new(sign(0), 2.0 * sign(1), 0.5 * sign(2))
            })
            .collect();
        let hull = Polytope::new(&corners).expect("a volume");
        for p in hull_points() {
            let (d, n) = hull.distance(p, 2.0);
            let (expected, m) = ball::distance(&solid, Vec3([p.x, p.y, p.z]));
            assert!((d - expected).abs() < 1e-12, "{p:?} {d} {expected}");
            // the same side; where two are as near either
            let m = Vector::new(m.0[0], m.0[1], m.0[2]);
            assert!(n.distance(m) < 1e-9, "{p:?} {n:?} {m:?}");
        }
    }

    fn hull_points() -> impl Iterator<Item = Vector> {
        let golden = [0.754_877_666, 0.569_840_290, 0.430_159_709];
        (1..3000)
            .map(move |n| Vector::from_array(golden.map(|g| 6.0 * ((n as f64 * g) % 1.0) - 3.0)))
    }
}
