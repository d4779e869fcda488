//! The distance of two solids, or how deep they stand in each other: what a CONTACT between them
//! would act on, whether they touch or not.

use super::super::Solid;
use super::{Body, Query};
use crate::space::{Frame, Vec3};
use parry3d_f64::math::{Matrix, Pose, Rotation, Vector};
use parry3d_f64::shape::SupportMap;

/// A pair of solids whose distance can be found.
#[derive(Debug)]
pub struct Separation(How);

#[derive(Debug)]
enum How {
    Bodies(Box<Query>),
    /// a body against a plane, which is of I (true) or of J
    Plane(Box<Body>, bool),
}

/// The distance of two solids at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// along the direction in which they overlap least   (length); negative: they overlap
    pub distance: f64,
    /// between the points that are nearest along that direction, in ground
    pub place: Vec3<f64>,
}

impl Separation {
    /// Prepares for the solids of I and J; `None`: one of them is not convex or a point, or both
    /// are planes. A plane is a half space, whatever its bounds.
    pub fn new(i: &Solid, j: &Solid) -> Option<Self> {
        let body = |solid: &Solid| Body::new(solid).map(Box::new);
        let how = match (i, j) {
            (Solid::Plane { .. }, j) => How::Plane(body(j)?, true),
            (i, Solid::Plane { .. }) => How::Plane(body(i)?, false),
            _ => How::Bodies(Box::new(Query::new(i, j)?)),
        };
        Some(Self(how))
    }

    /// Returns the distance for frames of the two solids in ground; `None` where these are no
    /// frames.
    pub fn at(&self, X_GI: &Frame<f64>, X_GJ: &Frame<f64>) -> Option<Gap> {
        match &self.0 {
            How::Plane(body, is_of_i) => {
                let (plane, solid) = if *is_of_i { (X_GI, X_GJ) } else { (X_GJ, X_GI) };
                let X = plane.inverse().compose(solid);
                let down = X.rotation.transpose().column(2);
                let p = body.local_support_point(-Vector::new(down.0[0], down.0[1], down.0[2]));
                let lowest = X.point(Vec3([p.x, p.y, p.z]));
                let [x, y, z] = lowest.0;
                let place = plane.point(Vec3([x, y, 0.5 * z]));
                let distance = z;
                distance.is_finite().then_some(Gap { distance, place })
            }
            How::Bodies(query) => {
                let X_JI = X_GJ.inverse().compose(X_GI);
                let pose = pose(&X_JI)?;
                let n = query.direction(&pose)?;
                let (a, b) = query.farthest(&pose, n);
                let distance = (a - b).dot(n);
                let between = query.middle_of_touches(&pose, n).unwrap_or((a + b) * 0.5);
                let place = X_GJ.point(Vec3([between.x, between.y, between.z]));
                distance.is_finite().then_some(Gap { distance, place })
            }
        }
    }
}

pub(super) fn pose(X: &Frame<f64>) -> Option<Pose> {
    let vector = |v: Vec3<f64>| Vector::new(v.0[0], v.0[1], v.0[2]);
    let column = |k: usize| vector(X.rotation.column(k));
    let axes = Matrix::from_cols(column(0), column(1), column(2));
    let (place, turn) = (vector(X.position), Rotation::from_mat3(&axes).normalize());
    let is_finite = place.is_finite() && turn.is_finite();
    is_finite.then(|| Pose::from_parts(place, turn))
}

impl Query {
    /// Returns the middle between the faces that look at each other, where they cover each other.
    fn middle_of_touches(&self, pose: &Pose, n: Vector) -> Option<Vector> {
        let points = self.points(pose, n);
        let (mut sum, mut shares) = (Vector::ZERO, 0.0);
        for [p_i, p_j, share] in &points {
            sum += (*p_i + *p_j) * (0.5 * share.x);
            shares += share.x;
        }
        (shares > 0.0).then(|| sum / shares)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::rotation::about_axis;

    fn at(x: f64, y: f64, z: f64) -> Frame<f64> {
        Frame {
            position: Vec3([x, y, z]),
            ..Frame::identity()
        }
    }

    fn cube() -> Solid {
        let (low, high) = ([-1.0; 3], [1.0; 3]);
        Solid::Box { low, high }
    }

    #[test]
    fn distances_and_overlaps_of_simple_solids_are_exact() {
        let ball = Solid::Ball { radius: 0.5 };
        let balls = Separation::new(&ball, &ball).unwrap();
        let rod = Solid::Frustum {
            z: [0.0, 4.0],
            radius: [0.25; 2],
        };
        let plane = Solid::Plane {
            x: [None; 2],
            y: [None; 2],
        };
        for x in [3.0, 1.25, 0.75] {
            let gap = balls.at(&at(x, 0.0, 0.0), &at(0.0, 0.0, 0.0)).unwrap();
            assert!((gap.distance - (x - 1.0)).abs() < 1e-9, "{gap:?}");
            assert!((gap.place.0[0] - 0.5 * x).abs() < 1e-6, "{gap:?}");
            let boxes = Separation::new(&cube(), &cube()).unwrap();
            let gap = boxes
                .at(&at(1.0 + x, 0.3, 0.0), &at(0.0, 0.0, 0.0))
                .unwrap();
            assert!((gap.distance - (x - 1.0)).abs() < 1e-12, "{gap:?}");
            let lying = Frame {
                rotation: about_axis(1, std::f64::consts::FRAC_PI_2),
                ..at(0.0, 0.0, x)
            };
            for (pair, frames) in [
                (Separation::new(&rod, &plane), [lying, at(0.0, 0.0, 0.0)]),
                (Separation::new(&plane, &rod), [at(0.0, 0.0, 0.0), lying]),
            ] {
                let gap = pair.unwrap().at(&frames[0], &frames[1]).unwrap();
                assert!((gap.distance - (x - 0.25)).abs() < 1e-12, "{gap:?}");
            }
        }
        assert!(Separation::new(&plane, &plane).is_none());
        assert!(
            Separation::new(
                &Solid::Torus {
                    ring: 2.0,
                    tube: 0.5
                },
                &ball
            )
            .is_none()
        );
    }
}
