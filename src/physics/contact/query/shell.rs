//! Shells that are not what their convex hull is: the distance of their surfaces.
//!
//! ```text
//! d = min over triangles of the distance to the other solid, or to its triangles
//! w(p) = Σ Ω / 4π        Ω: solid angle of a triangle seen from p; |w| > ½: p is inside
//! ```
//!
//! Triangles whose bounding spheres are farther than the least distance so far are not looked at.
//! Solids overlap where d = 0, or where one has a point inside the other. How deep they overlap is
//! not found here.

use super::body::{Body, vector};
use super::separation::{Gap, pose};
use crate::physics::contact::Solid;
use crate::space::{Frame, Vec3};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::gjk::{self, CsoPoint, GJKResult, VoronoiSimplex};
use parry3d_f64::shape::{SupportMap, Triangle};

/// Depth of a point within the hull, as a part of the extent, below which it lies on it.
const ON_HULL: f64 = 1e-5;
/// Most pairs of triangles that two shells may have.
const MOST_PAIRS: usize = 4_000_000;

/// The surface of a shell, which its hull does not show.
#[derive(Clone, Debug)]
pub struct Shell {
    triangles: Vec<Ball<Triangle>>,
    /// deepest point of the surface within the hull   (length); 0: it is convex
    pub hollow: f64,
}

/// A form within a sphere.
#[derive(Clone, Debug)]
struct Ball<T> {
    form: T,
    centre: Vector,
    radius: f64,
}

impl Shell {
    /// Makes the surface of polygons whose convex hull is `hull`; `None`: the hull shows it all, or
    /// it has no polygon.
    pub fn new(points: &[[f64; 3]], faces: &[Vec<u32>], hull: &Solid) -> Option<Self> {
        let body = Body::new(hull)?;
        let at = |k: u32| points.get(k as usize).map(|&p| vector(p));
        let mut triangles = Vec::new();
        let mut hollow = 0.0_f64;
        let mut outside = 0.0_f64;
        let mut see = |p: Vector| {
            let (d, _) = body.distance(Vec3([p.x, p.y, p.z]));
            hollow = hollow.max(-d);
            outside = outside.max(d);
        };
        for face in faces {
            for k in 1..face.len().saturating_sub(1) {
                let corners = [at(face[0]), at(face[k]), at(face[k + 1])];
                let [Some(a), Some(b), Some(c)] = corners else {
                    continue;
                };
                let centre = (a + b + c) / 3.0;
                [a, b, c, centre].into_iter().for_each(&mut see);
                let far = [a, b, c].map(|p| (p - centre).length());
                triangles.push(Ball {
                    form: Triangle::new(a, b, c),
                    centre,
                    radius: far[0].max(far[1]).max(far[2]),
                });
            }
        }
        let least = ON_HULL * body.size[1];
        if triangles.is_empty() || hollow.max(outside) <= least {
            return None;
        }
        let hollow = if hollow > least { hollow } else { 0.0 };
        Some(Self { triangles, hollow })
    }

    /// Returns whether a point lies inside, in the frame of the shell.
    fn holds(&self, p: Vector) -> bool {
        let of = |ball: &Ball<Triangle>| {
            let [a, b, c] = [ball.form.a - p, ball.form.b - p, ball.form.c - p];
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            2.0 * crate::scalar::Scalar::atan2(a.dot(b.cross(c)), below)
        };
        let angle: f64 = self.triangles.iter().map(of).sum();
        angle.abs() > std::f64::consts::TAU
    }
}

/// One of two solids: convex, or a shell of which the hull does not show all.
#[derive(Debug)]
enum Side {
    Convex(Box<Body>),
    Shell(Shell),
}

impl Side {
    /// Returns a point of it, in its frame.
    fn point(&self) -> Vector {
        match self {
            Side::Convex(body) => body.local_support_point(Vector::X),
            Side::Shell(shell) => shell.triangles[0].form.a,
        }
    }

    fn count(&self) -> usize {
        match self {
            Side::Convex(_) => 1,
            Side::Shell(shell) => shell.triangles.len(),
        }
    }
}

/// A pair of solids of which one at least is such a shell.
#[derive(Debug)]
pub struct Surfaces([Side; 2]);

/// The nearest points of two solids.
struct Nearest {
    distance: f64,
    /// between them, in the frame of the first
    middle: Vector,
}

impl Surfaces {
    /// Prepares a pair of solids with their shells; `None` where their hulls say it all, where one
    /// has no distance, or where both have too many triangles.
    pub fn new(solids: [&Solid; 2], shells: [Option<&Shell>; 2]) -> Option<Self> {
        let side = |k: usize| match shells[k] {
            Some(shell) => Some(Side::Shell(shell.clone())),
            None => Some(Side::Convex(Box::new(Body::new(solids[k])?))),
        };
        let sides = [side(0)?, side(1)?];
        let pairs = sides[0].count().saturating_mul(sides[1].count());
        let has_shell = shells.iter().any(Option::is_some);
        (has_shell && pairs <= MOST_PAIRS).then_some(Self(sides))
    }

    /// Returns the distance for frames of the two solids in ground; `None` where they overlap, or
    /// where these are no frames.
    pub fn apart(&self, X_GI: &Frame<f64>, X_GJ: &Frame<f64>) -> Option<Gap> {
        let to_j = pose(&X_GI.inverse().compose(X_GJ))?;
        let nearest = self.nearest(&to_j)?;
        let Nearest { distance, middle } = nearest;
        let is_apart = distance > 0.0 && distance.is_finite() && !self.one_holds_the_other(&to_j);
        is_apart.then(|| Gap {
            distance,
            place: X_GI.point(Vec3([middle.x, middle.y, middle.z])),
        })
    }

    fn one_holds_the_other(&self, to_j: &Pose) -> bool {
        let [i, j] = &self.0;
        let in_i = to_j.transform_point(j.point());
        let in_j = to_j.inverse_transform_point(i.point());
        let holds = |side: &Side, p: Vector| match side {
            Side::Shell(shell) => shell.holds(p),
            // triangles within a convex solid have no distance to it
            Side::Convex(_) => false,
        };
        holds(i, in_i) || holds(j, in_j)
    }

    fn nearest(&self, to_j: &Pose) -> Option<Nearest> {
        let mut best = Nearest {
            distance: f64::INFINITY,
            middle: Vector::ZERO,
        };
        match &self.0 {
            [Side::Shell(i), Side::Shell(j)] => {
                for b in &j.triangles {
                    let centre = to_j.transform_point(b.centre);
                    nearer(&i.triangles, (centre, b.radius), &b.form, to_j, &mut best)?;
                }
            }
            [Side::Shell(i), Side::Convex(j)] => {
                let sphere = sphere_of(j);
                let sphere = (to_j.transform_point(sphere.0), sphere.1);
                nearer(&i.triangles, sphere, j.as_ref(), to_j, &mut best)?;
            }
            [Side::Convex(i), Side::Shell(j)] => {
                let to_i = to_j.inverse();
                let sphere = sphere_of(i);
                let sphere = (to_i.transform_point(sphere.0), sphere.1);
                nearer(&j.triangles, sphere, i.as_ref(), &to_i, &mut best)?;
                best.middle = to_j.transform_point(best.middle);
            }
            [Side::Convex(_), Side::Convex(_)] => return None,
        }
        Some(best)
    }
}

/// Returns a sphere about a convex solid, in its frame.
fn sphere_of(body: &Body) -> (Vector, f64) {
    (body.middle, 3.0_f64.sqrt() * body.size[1])
}

/// Finds the triangles that are nearer to a form than the nearest so far; `None`: one touches it.
fn nearer<G: SupportMap>(
    triangles: &[Ball<Triangle>],
    (centre, radius): (Vector, f64),
    form: &G,
    to_form: &Pose,
    best: &mut Nearest,
) -> Option<()> {
    let bound = |ball: &Ball<Triangle>| (ball.centre - centre).length() - ball.radius - radius;
    let mut order: Vec<(f64, usize)> = (triangles.iter().map(bound).zip(0..))
        .filter(|(bound, _)| *bound < best.distance)
        .collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (bound, k) in order {
        if bound >= best.distance {
            break;
        }
        let triangle = &triangles[k].form;
        let start = (centre - triangles[k].centre).try_normalize();
        let mut simplex = VoronoiSimplex::new();
        let start = start.unwrap_or(Vector::X);
        simplex.reset(CsoPoint::from_shapes(to_form, triangle, form, start));
        match gjk::closest_points(to_form, triangle, form, f64::MAX, true, &mut simplex) {
            GJKResult::ClosestPoints(a, b, _) => {
                let distance = (a - b).length();
                if distance < best.distance {
                    let middle = (a + b) * 0.5;
                    *best = Nearest { distance, middle };
                }
            }
            GJKResult::Intersection => return None,
            GJKResult::Proximity(_) | GJKResult::NoIntersection(_) => {}
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An L of boxes: 3 by 3 by 1 with a notch of 2 by 2.
    fn angle() -> (Shell, Solid) {
        let outline = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ];
        let points: Vec<[f64; 3]> = [0.0, 1.0]
            .iter()
            .flat_map(|z| outline.iter().map(move |[x, y]| [*x, *y, *z]))
            .collect();
        let mut faces: Vec<Vec<u32>> = (0..6_u32)
            .map(|k| vec![k, (k + 1) % 6, (k + 1) % 6 + 6, k + 6])
            .collect();
        faces.extend([
            vec![0, 3, 2, 1],
            vec![0, 5, 4, 3],
            vec![6, 7, 8, 9],
            vec![6, 9, 10, 11],
        ]);
        let hull = super::super::hull::corners(&points).unwrap();
        let hull = Solid::Hull(hull.corners);
        (Shell::new(&points, &faces, &hull).unwrap(), hull)
    }

    fn at(x: f64, y: f64, z: f64) -> Frame<f64> {
        Frame {
            position: Vec3([x, y, z]),
            ..Frame::identity()
        }
    }

    #[test]
    fn a_ball_in_a_notch_is_as_far_from_its_walls_as_it_is() {
        let (shell, hull) = angle();
        assert!(shell.hollow > 0.3, "{}", shell.hollow);
        let ball = Solid::Ball { radius: 0.2 };
        let pair = Surfaces::new([&hull, &ball], [Some(&shell), None]).unwrap();
        let back = Surfaces::new([&ball, &hull], [None, Some(&shell)]).unwrap();
        for (x, y, distance) in [
            (1.6, 1.6, 0.4),
            (1.3, 2.0, 0.1),
            (3.5, 0.5, 0.3),
            (2.9, 2.9, 1.7),
        ] {
            let ball = at(x, y, 0.5);
            let gap = pair.apart(&at(0.0, 0.0, 0.0), &ball).unwrap();
            assert!((gap.distance - distance).abs() < 1e-6, "{x} {y}: {gap:?}");
            let same = back.apart(&ball, &at(0.0, 0.0, 0.0)).unwrap();
            assert!((same.distance - gap.distance).abs() < 1e-6);
            assert!((same.place - gap.place).norm() < 1e-5, "{same:?} {gap:?}");
        }
        // across a wall, and inside without touching the surface
        for ball in [at(1.1, 2.0, 0.5), at(0.5, 0.5, 0.5)] {
            assert!(pair.apart(&at(0.0, 0.0, 0.0), &ball).is_none());
        }
    }

    #[test]
    fn two_shells_that_hook_into_each_other_are_free_where_their_hulls_are_not() {
        let (shell, hull) = angle();
        let pair = Surfaces::new([&hull, &hull], [Some(&shell), Some(&shell)]).unwrap();
        let turned = Frame {
            rotation: crate::space::rotation::about_axis(2, std::f64::consts::PI),
            ..at(2.5, 4.3, 0.0)
        };
        let gap = pair.apart(&at(0.0, 0.0, 0.0), &turned).unwrap();
        assert!((gap.distance - 0.3).abs() < 1e-6, "{gap:?}");
        let nearer = Frame {
            position: Vec3([2.5, 3.9, 0.0]),
            ..turned
        };
        assert!(pair.apart(&at(0.0, 0.0, 0.0), &nearer).is_none());
    }

    #[test]
    fn what_its_hull_shows_is_no_shell() {
        let points = [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ];
        let faces = [vec![0, 2, 1], vec![0, 1, 3], vec![0, 3, 2], vec![1, 2, 3]];
        let hull = Solid::Hull(points.to_vec());
        assert!(Shell::new(&points, &faces, &hull).is_none());
    }
}
