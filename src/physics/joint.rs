//! The TABLE of joints: the motions that a joint leaves free, and those that it forbids.
//!
//! Two columns describe the same joint. *Motions*: the joint as a chain of primitives from the J
//! marker to the I marker, for a joint that carries a part of the forest. *Rows*: the joint as
//! scalar equations between the two marker frames, for a joint that closes a loop. A property test
//! moves every joint by random motions and finds its rows zero.

use super::coupler::Gauge;
use super::row::Law;
use crate::model::{JointKind, PrimitiveKind};
use crate::space::{Mat3, rotation};

/// One step of the chain from J to I.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// translation along axis 0 x, 1 y, 2 z
    Slide(usize),
    /// rotation about axis 0 x, 1 y, 2 z
    Turn(usize),
    /// any rotation, as a unit quaternion with the angular velocity in the turned axes
    Ball,
    /// a constant quarter turn about x, which brings the pins of a universal joint to z
    QuarterX,
}

/// A tie between two markers: a joint or a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tie {
    /// JOINT
    Joint(JointKind),
    /// JPRIM
    Primitive(PrimitiveKind),
}

use Law::{Along, Dot, Offset};
use Motion::{Ball, QuarterX, Slide, Turn};

/// `z_I` parallel to `z_J`
const PARALLEL: [Law; 2] = [Dot(2, 0), Dot(2, 1)];
/// all axes parallel
const ALIGNED: [Law; 3] = [Dot(2, 0), Dot(2, 1), Dot(0, 1)];
/// origins coincide
const COINCIDENT: [Law; 3] = [Offset(0), Offset(1), Offset(2)];

impl Tie {
    /// Returns the chain from J to I, or `None` when the tie is a row between bodies that other
    /// joints carry.
    pub fn motions(self) -> Option<&'static [Motion]> {
        use JointKind as J;
        use PrimitiveKind as P;
        Some(match self {
            Tie::Joint(J::Fixed) => &[],
            Tie::Joint(J::Revolute) => &[Turn(2)],
            Tie::Joint(J::Translational) => &[Slide(2)],
            Tie::Joint(J::Cylindrical) => &[Slide(2), Turn(2)],
            Tie::Joint(J::Spherical) | Tie::Primitive(P::Atpoint) => &[Ball],
            Tie::Joint(J::Planar) => &[Slide(0), Slide(1), Turn(2)],
            Tie::Joint(J::Universal) => &[Turn(2), QuarterX, Turn(2)],
            Tie::Joint(J::Hooke) => &[Turn(1), Turn(0)],
            Tie::Joint(J::Convel | J::Rackpin | J::Screw) => return None,
            Tie::Primitive(P::Inline) => &[Slide(2), Ball],
            Tie::Primitive(P::Inplane) => &[Slide(0), Slide(1), Ball],
            Tie::Primitive(P::Orientation) => &[Slide(0), Slide(1), Slide(2)],
            Tie::Primitive(P::ParallelAxes) => &[Slide(0), Slide(1), Slide(2), Turn(2)],
            Tie::Primitive(P::Perpendicular) => {
                &[Slide(0), Slide(1), Slide(2), Turn(2), QuarterX, Turn(2)]
            }
        })
    }

    /// Returns the equations between the marker frames.
    ///
    /// SCREW and RACKPIN are equations between displacements; they have none of this kind.
    pub fn rows(self) -> Vec<Law> {
        use JointKind as J;
        use PrimitiveKind as P;
        let all = |parts: &[&[Law]]| parts.concat();
        let inline: &[Law] = &[Along(0), Along(1)];
        match self {
            Tie::Joint(J::Fixed) => all(&[&COINCIDENT, &ALIGNED]),
            Tie::Joint(J::Revolute) => all(&[&COINCIDENT, &PARALLEL]),
            Tie::Joint(J::Translational) => all(&[inline, &ALIGNED]),
            Tie::Joint(J::Cylindrical) => all(&[inline, &PARALLEL]),
            Tie::Joint(J::Spherical) | Tie::Primitive(P::Atpoint) => COINCIDENT.to_vec(),
            Tie::Joint(J::Planar) => all(&[&[Along(2)], &PARALLEL]),
            Tie::Joint(J::Universal) => all(&[&COINCIDENT, &[Dot(2, 2)]]),
            Tie::Joint(J::Hooke) => all(&[&COINCIDENT, &[Dot(0, 1)]]),
            Tie::Joint(J::Convel) => all(&[&COINCIDENT, &[Law::EqualDots]]),
            Tie::Joint(J::Rackpin | J::Screw) => Vec::new(),
            Tie::Primitive(P::Inline) => inline.to_vec(),
            Tie::Primitive(P::Inplane) => vec![Along(2)],
            Tie::Primitive(P::Orientation) => ALIGNED.to_vec(),
            Tie::Primitive(P::ParallelAxes) => PARALLEL.to_vec(),
            Tie::Primitive(P::Perpendicular) => vec![Dot(2, 2)],
        }
    }

    /// Returns the number of freedoms that it removes between two bodies.
    pub fn removes(self) -> usize {
        match self {
            Tie::Joint(JointKind::Rackpin | JointKind::Screw) => 1,
            _ => self.rows().len(),
        }
    }
}

/// Returns the variables of a joint: names, and the displacements of I against J that they measure.
/// Lengths are along axes of J, angles right-handed in rad, turns counted. SPHERICAL and CONVEL
/// have no displacements that are single numbers, FIXED has none at all.
pub fn variables(kind: JointKind) -> &'static [(&'static str, Gauge)] {
    const DISTANCE: (&str, Gauge) = ("DISTANCE", Gauge::Distance);
    const ANGLE: (&str, Gauge) = ("ANGLE", Gauge::Angle(2));
    const fn pins(hooke: bool) -> [(&'static str, Gauge); 2] {
        let first = Gauge::Pin {
            hooke,
            second: false,
        };
        let second = Gauge::Pin {
            hooke,
            second: true,
        };
        [("ANGLE_1", first), ("ANGLE_2", second)]
    }
    match kind {
        JointKind::Revolute => &[ANGLE],
        JointKind::Translational => &[DISTANCE],
        JointKind::Cylindrical | JointKind::Screw => &[DISTANCE, ANGLE],
        JointKind::Rackpin => &[DISTANCE, ("ANGLE", Gauge::Angle(0))],
        JointKind::Planar => &[("X", Gauge::Across(0)), ("Y", Gauge::Across(1)), ANGLE],
        JointKind::Hooke => const { &pins(true) },
        JointKind::Universal => const { &pins(false) },
        JointKind::Fixed | JointKind::Spherical | JointKind::Convel => &[],
    }
}

impl Motion {
    /// Returns the number of velocity coordinates.
    pub fn freedoms(self) -> usize {
        match self {
            Slide(_) | Turn(_) => 1,
            Ball => 3,
            QuarterX => 0,
        }
    }
}

/// Returns the constant rotation of [`Motion::QuarterX`].
pub fn quarter_x() -> Mat3<f64> {
    rotation::snapped(&rotation::about_axis(0, std::f64::consts::FRAC_PI_2))
}
