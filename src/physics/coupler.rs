//! Equations between displacements: COUPLER, GEAR, SCREW, RACKPIN.
//!
//! Each equation keeps a weighted sum of displacements constant. A displacement is a distance or an
//! angle of a marker I against a marker J, with `d = p_I − p_J`:
//!
//! ```text
//! Distance    d · z_J                                            (1)
//! Angle(a)    angle of x_I about axis a of J, turns counted      (2)
//!
//! COUPLER     Σ rₖ qₖ = c                                        (3)
//! SCREW       d·z_J − PITCH/(2π) θ = c      θ = Angle(z)         (4)
//! RACKPIN     d·z_J − PD/2 θ = c            θ = Angle(x)         (5)
//! GEAR        a₁ θ₁ + b₁ s₁ − a₂ θ₂ − b₂ s₂ = c                  (6)
//!             aₖ = (z_Jk × (p_c − p_Jk)) · z_c,   bₖ = z_Jk · z_c
//! ```
//!
//! *Signs*: a positive PITCH is a right-hand thread. A positive PD puts the pinion's centre on the
//! +y_J side of the pitch line: turning by +θ about x_J it rolls by +PD/2 θ along z_J. In (6) the
//! two geared bodies have, in the frame of their carrier, the same velocity at the origin of CV
//! along its z axis; CV between the axes makes them turn oppositely, CV outside makes an internal
//! gear.
//!
//! *Constant*: the manuals write zero, but a marker may be set anywhere along an axis only if the
//! constant is not zero. c is therefore taken from the assembled configuration, and a SCREW,
//! RACKPIN or COUPLER whose c is not zero is reported. The option `strict` of a scene takes zero.
//!
//! *Reactions*: a coupler turns or pushes I of each joint along its axis and J oppositely. The
//! force of a gear pair (pressure angle zero) acts at CV along z_c on the first body and oppositely
//! on the second; it loads the bearings as the teeth would.

use crate::scalar::Scalar;
use crate::space::{Frame, Vec3};

/// The quantity that a displacement measures; lengths in model units, angles in rad, right-handed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Gauge {
    /// distance along z of J (1)
    Distance,
    /// angle of x of I about an axis of J: 0 x, 1 y, 2 z (2)
    Angle(usize),
    /// distance along x (0) or y (1) of J, as PLANAR has them
    Across(usize),
    /// angle about a pin of a universal joint
    Pin {
        /// HOOKE (pins x of I and y of J) rather than UNIVERSAL (pins z of I and z of J)
        hooke: bool,
        /// the pin of I rather than that of J
        second: bool,
    },
}

impl Gauge {
    /// Evaluates the displacement; an angle as its principal value.
    pub fn value<S: Scalar>(self, i: &Frame<S>, j: &Frame<S>) -> S {
        match self {
            Gauge::Distance => (i.position - j.position).dot(j.rotation.column(2)),
            Gauge::Angle(about) => {
                let x_i = i.rotation.column(0);
                let across = x_i.dot(j.rotation.column((about + 2) % 3));
                let along = x_i.dot(j.rotation.column((about + 1) % 3));
                across.atan2(along)
            }
            Gauge::Across(axis) => (i.position - j.position).dot(j.rotation.column(axis)),
            Gauge::Pin { hooke, second } => {
                // R_JI = Ry(a) Rx(b) of HOOKE, Rz(a) Q Rz(b) of UNIVERSAL, Q a quarter turn about x
                let dot =
                    |of_i: usize, of_j: usize| i.rotation.column(of_i).dot(j.rotation.column(of_j));
                match (hooke, second) {
                    (true, false) => (-dot(0, 2)).atan2(dot(0, 0)),
                    (true, true) => (-dot(2, 1)).atan2(dot(1, 1)),
                    (false, false) => dot(2, 0).atan2(-dot(2, 1)),
                    (false, true) => dot(0, 2).atan2(dot(1, 2)),
                }
            }
        }
    }

    /// Returns the part of the axis whose angle is read that stands square to the plane in which
    /// it is read; 0 for distances. The angle leaps by half a turn where the rest of the axis
    /// vanishes.
    pub fn out_of_plane(self, i: &Frame<f64>, j: &Frame<f64>) -> f64 {
        let dot = |of_i: usize, of_j: usize| i.rotation.column(of_i).dot(j.rotation.column(of_j));
        match self {
            Gauge::Distance | Gauge::Across(_) => 0.0,
            Gauge::Angle(about) => dot(0, about),
            Gauge::Pin { hooke: true, .. } => dot(0, 1),
            Gauge::Pin { hooke: false, .. } => dot(2, 2),
        }
    }

    /// Returns whether the displacement is an angle.
    pub fn is_angle(self) -> bool {
        matches!(self, Gauge::Angle(_) | Gauge::Pin { .. })
    }
}

/// A joint of a gear: the axis of J and whether it turns, slides or does both.
#[derive(Clone, Copy, Debug)]
pub struct GearedJoint {
    /// frame of J in the carrier
    pub j: Frame<f64>,
    /// whether it turns about z_J
    pub turns: bool,
    /// whether it slides along z_J
    pub slides: bool,
}

/// Returns the factors a (of the angle) and b (of the distance) of (6) for one joint, or `None` if
/// CV does not take part in its motion because its z axis is perpendicular to every motion of the
/// body there.
pub fn gear_factors(joint: &GearedJoint, cv: &Frame<f64>) -> Option<[f64; 2]> {
    let (axis, line) = (joint.j.rotation.column(2), cv.rotation.column(2));
    let arm: Vec3<f64> = cv.position - joint.j.position;
    let a = if joint.turns {
        axis.cross(arm).dot(line)
    } else {
        0.0
    };
    let b = if joint.slides { axis.dot(line) } else { 0.0 };
    let clean = |x: f64, scale: f64| if x.abs() <= 1e-9 * scale { 0.0 } else { x };
    let (a, b) = (clean(a, arm.norm()), clean(b, 1.0));
    (a != 0.0 || b != 0.0).then_some([a, b])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{Mat3, rotation};

    fn at(x: f64, y: f64, rotation: Mat3<f64>) -> Frame<f64> {
        Frame {
            rotation,
            position: Vec3([x, y, 0.0]),
        }
    }
    const TURNS: fn(Frame<f64>) -> GearedJoint = |j| GearedJoint {
        j,
        turns: true,
        slides: false,
    };

    /// Two wheels of radius 1 and 3 touching at (1, 0), line of action along y.
    #[test]
    fn between_the_axes_gears_turn_oppositely_and_outside_alike() {
        let straight = rotation::about_axis(0, 0.0);
        let line = rotation::about_axis(0, -std::f64::consts::FRAC_PI_2); // z → y
        let first = TURNS(at(0.0, 0.0, straight));
        let cv = at(1.0, 0.0, line);
        let a1 = gear_factors(&first, &cv).unwrap()[0];
        let external = gear_factors(&TURNS(at(4.0, 0.0, straight)), &cv).unwrap()[0];
        let internal = gear_factors(&TURNS(at(-2.0, 0.0, straight)), &cv).unwrap()[0];
        approx::assert_relative_eq!(a1 / external, -1.0 / 3.0, max_relative = 1e-14);
        approx::assert_relative_eq!(a1 / internal, 1.0 / 3.0, max_relative = 1e-14);
    }

    #[test]
    fn a_line_of_action_along_the_axis_or_through_it_is_no_gear() {
        let straight = rotation::about_axis(0, 0.0);
        let joint = TURNS(at(0.0, 0.0, straight));
        assert_eq!(gear_factors(&joint, &at(1.0, 0.0, straight)), None);
        let outward = rotation::about_axis(1, std::f64::consts::FRAC_PI_2); // z → x
        assert_eq!(gear_factors(&joint, &at(1.0, 0.0, outward)), None);
    }

    #[test]
    fn angles_are_about_the_axis_they_name() {
        for about in 0..3 {
            // x of I must not lie along the axis
            let start = if about == 0 {
                rotation::about_axis(1, std::f64::consts::FRAC_PI_2)
            } else {
                rotation::about_axis(0, 0.0)
            };
            let angle = |turn: f64| {
                let i = at(0.3, 0.2, rotation::about_axis(about, turn) * start);
                Gauge::Angle(about).value(&i, &Frame::identity())
            };
            approx::assert_relative_eq!(angle(0.4) - angle(0.1), 0.3, max_relative = 1e-13);
        }
    }
}
