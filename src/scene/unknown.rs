//! Identities of the unknowns: which position, velocity or state of which element a number is.
//!
//! The state of one simulation finds its place in the next by these. As texts they stand in
//! messages, among the results and in saved states, which read them back.

use crate::diagnostic::Subject;
use crate::model::{ElementId, ElementKind};
use std::fmt;
use std::str::FromStr;

/// A quantity that a coordinate of the forest measures. Axes are 0 x, 1 y, 2 z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Variable {
    /// place of a free part's centre of mass along an axis of ground
    Place(usize),
    /// rotation about an axis, of a free part or of a joint that turns about all three
    Rotation(usize),
    /// the only distance of a joint
    Distance,
    /// one of several distances of a joint: the one along an axis
    DistanceAlong(usize),
    /// the only angle of a joint
    Angle,
    /// one of several angles of a joint, counted from 1
    AngleNumber(usize),
}

/// A coordinate of the forest: the PART, POINT_MASS, JOINT or JPRIM it belongs to, and what it
/// measures. Prints as `JOINT/3 angle`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CoordinateId {
    /// the element it belongs to
    pub element: ElementId,
    /// what it measures
    pub variable: Variable,
}

/// A differential equation: that of a DIFF, or one of several of another element. Prints as
/// `DIFF/3` or `LSE/1 state 2`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DifferentialId {
    /// the element it belongs to
    pub element: ElementId,
    /// which of its states it is, counted from 1; `None` for a DIFF
    pub number: Option<usize>,
}

/// A state of a MOTION that is given by its velocity or acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MotionState {
    /// the displacement
    Displacement,
    /// the velocity, of a motion given by its acceleration
    Velocity,
}

/// A side of a contact on curves. The only curve of a PTCV is that of side I.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// the first body
    I,
    /// the second body
    J,
}

/// An unknown of the integrator: which number of `q | v | x` it is, in any scene of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum UnknownId {
    /// position of a coordinate that slides or turns
    Position(CoordinateId),
    /// one of the four numbers of a ball's quaternion
    EulerParameter {
        /// the first of the ball's three coordinates
        ball: CoordinateId,
        /// which of the four it is, counted from 0
        number: usize,
    },
    /// velocity of a coordinate
    Velocity(CoordinateId),
    /// state of a MOTION
    Motion {
        /// the MOTION
        motion: ElementId,
        /// which of its states it is
        state: MotionState,
    },
    /// state of a differential equation
    Differential(DifferentialId),
    /// place of a contact along a curve
    ContactPlace {
        /// the PTCV or CVCV
        contact: ElementId,
        /// user's number of the CURVE
        curve: u32,
        /// whose curve it is
        side: Side,
    },
}

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

impl Variable {
    /// Reads the printed form.
    fn read(text: &str) -> Option<Self> {
        let axis = |name: &str| AXES.iter().position(|a| *a == name);
        let words: Vec<&str> = text.split(' ').collect();
        Some(match words[..] {
            ["distance"] => Self::Distance,
            ["angle"] => Self::Angle,
            ["angle", number] => Self::AngleNumber(number.parse().ok()?),
            ["rotation", name] => Self::Rotation(axis(name)?),
            [name, "distance"] => Self::DistanceAlong(axis(name)?),
            [name] => Self::Place(axis(name)?),
            _ => return None,
        })
    }
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Place(axis) => f.write_str(AXES[axis]),
            Self::Rotation(axis) => write!(f, "rotation {}", AXES[axis]),
            Self::Distance => f.write_str("distance"),
            Self::DistanceAlong(axis) => write!(f, "{} distance", AXES[axis]),
            Self::Angle => f.write_str("angle"),
            Self::AngleNumber(number) => write!(f, "angle {number}"),
        }
    }
}

impl CoordinateId {
    /// Reads the printed form.
    fn read(text: &str) -> Option<Self> {
        let (element, variable) = text.split_once(' ')?;
        Some(Self {
            element: element.parse().ok()?,
            variable: Variable::read(variable)?,
        })
    }
}

impl fmt::Display for CoordinateId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Subject::from(*self).fmt(f)
    }
}

impl From<CoordinateId> for Subject {
    fn from(id: CoordinateId) -> Self {
        Self::part_of(id.element, id.variable.to_string())
    }
}

impl DifferentialId {
    /// Returns the equation of a DIFF by the user's number.
    pub const fn diff(id: u32) -> Self {
        Self {
            element: ElementKind::Diff.id(id),
            number: None,
        }
    }
}

impl fmt::Display for DifferentialId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Subject::from(*self).fmt(f)
    }
}

impl From<DifferentialId> for Subject {
    fn from(id: DifferentialId) -> Self {
        match id.number {
            None => id.element.into(),
            Some(number) => Self::part_of(id.element, format!("state {number}")),
        }
    }
}

impl UnknownId {
    /// Returns the element that it belongs to.
    pub fn element(&self) -> ElementId {
        match self {
            Self::Position(coordinate) | Self::Velocity(coordinate) => coordinate.element,
            Self::EulerParameter { ball, .. } => ball.element,
            Self::Motion { motion, .. } => *motion,
            Self::Differential(equation) => equation.element,
            Self::ContactPlace { contact, .. } => *contact,
        }
    }

    /// Reads the printed form.
    fn read(text: &str) -> Option<Self> {
        if let Some(coordinate) = text.strip_prefix("rate of ") {
            return CoordinateId::read(coordinate).map(Self::Velocity);
        }
        if let Some((ball, number)) = text.split_once(" (Euler parameter ") {
            return Some(Self::EulerParameter {
                ball: CoordinateId::read(ball)?,
                number: number.strip_suffix(')')?.parse().ok()?,
            });
        }
        let words: Vec<&str> = text.split(' ').collect();
        let (first, rest) = words.split_first()?;
        let element: ElementId = first.parse().ok()?;
        let motion = |state| Self::Motion {
            motion: element,
            state,
        };
        let differential = |number| Self::Differential(DifferentialId { element, number });
        Some(match rest {
            [] => differential(None),
            ["state", number] => differential(Some(number.parse().ok()?)),
            ["displacement"] => motion(MotionState::Displacement),
            ["velocity"] => motion(MotionState::Velocity),
            ["place", "on", curve, "of", side] => {
                let curve: ElementId = curve.parse().ok()?;
                Self::ContactPlace {
                    contact: element,
                    curve: (curve.kind == ElementKind::Curve).then_some(curve.number)?,
                    side: match *side {
                        "I" => Side::I,
                        "J" => Side::J,
                        _ => return None,
                    },
                }
            }
            _ => Self::Position(CoordinateId::read(text)?),
        })
    }
}

impl fmt::Display for UnknownId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Position(coordinate) => coordinate.fmt(f),
            Self::EulerParameter { ball, number } => write!(f, "{ball} (Euler parameter {number})"),
            Self::Velocity(coordinate) => write!(f, "rate of {coordinate}"),
            Self::Motion { motion, state } => match state {
                MotionState::Displacement => write!(f, "{motion} displacement"),
                MotionState::Velocity => write!(f, "{motion} velocity"),
            },
            Self::Differential(differential) => differential.fmt(f),
            Self::ContactPlace {
                contact,
                curve,
                side,
            } => {
                let curve = ElementKind::Curve.id(*curve);
                let side = match side {
                    Side::I => "I",
                    Side::J => "J",
                };
                write!(f, "{contact} place on {curve} of {side}")
            }
        }
    }
}

impl FromStr for UnknownId {
    type Err = String;

    /// Reads the printed form, as saved states have it.
    fn from_str(text: &str) -> Result<Self, String> {
        Self::read(text).ok_or_else(|| format!("`{text}` is no unknown of a model"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One unknown of each form with its text.
    fn all() -> Vec<(UnknownId, &'static str)> {
        let of = |kind: ElementKind, variable| CoordinateId {
            element: kind.id(3),
            variable,
        };
        let joint = |variable| UnknownId::Position(of(ElementKind::Joint, variable));
        let ball = of(ElementKind::Part, Variable::Rotation(0));
        let motion = |state| UnknownId::Motion {
            motion: ElementKind::Motion.id(4),
            state,
        };
        let lse = DifferentialId {
            element: ElementKind::Lse.id(1),
            number: Some(2),
        };
        let place = |side| UnknownId::ContactPlace {
            contact: ElementKind::Cvcv.id(7),
            curve: 12,
            side,
        };
        let mass = of(ElementKind::PointMass, Variable::Place(2));
        vec![
            (UnknownId::Position(mass), "POINT_MASS/3 z"),
            (joint(Variable::Distance), "JOINT/3 distance"),
            (joint(Variable::DistanceAlong(1)), "JOINT/3 y distance"),
            (joint(Variable::Angle), "JOINT/3 angle"),
            (joint(Variable::AngleNumber(2)), "JOINT/3 angle 2"),
            (
                UnknownId::EulerParameter { ball, number: 3 },
                "PART/3 rotation x (Euler parameter 3)",
            ),
            (UnknownId::Velocity(ball), "rate of PART/3 rotation x"),
            (motion(MotionState::Displacement), "MOTION/4 displacement"),
            (motion(MotionState::Velocity), "MOTION/4 velocity"),
            (UnknownId::Differential(DifferentialId::diff(5)), "DIFF/5"),
            (UnknownId::Differential(lse), "LSE/1 state 2"),
            (place(Side::I), "CVCV/7 place on CURVE/12 of I"),
            (place(Side::J), "CVCV/7 place on CURVE/12 of J"),
        ]
    }

    #[test]
    fn unknowns_print_as_saved_states_have_them_and_read_back() {
        for (unknown, text) in all() {
            assert_eq!(unknown.to_string(), text);
            assert_eq!(text.parse(), Ok(unknown), "{text}");
        }
    }

    #[test]
    fn other_texts_are_no_unknowns() {
        for text in [
            "",
            "x",
            "PART",
            "PART/3 w",
            "PART/3 x y z",
            "JOINT/3 angle one",
            "rate of MOTION/4 displacement",
            "PART/3 rotation x (Euler parameter 3",
            "CVCV/7 place on PART/12 of I",
            "CVCV/7 place on CURVE/12 of K",
        ] {
            assert!(text.parse::<UnknownId>().is_err(), "{text}");
        }
    }
}
