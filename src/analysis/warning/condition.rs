//! Warnings of initial conditions: not met, or read in another way than documented.

use super::Names;
use crate::analysis::quantity::{length, short};
use crate::diagnostic::Subject;
use crate::model::{ElementId, ElementKind};
use crate::results::digits_of_six;

/// Something about an initial condition.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ConditionWarning {
    /// its two numbers fit the parts better when they are exchanged
    Exchanged {
        /// the joint
        element: ElementId,
        /// the numbers as they stand in the dataset
        given: [f64; 2],
        /// where the parts stand
        stands: f64,
    },
    /// numbers are read as velocity and displacement, as Adams View writes them
    ViewOrder {
        /// the joints, with their numbers as they stand in the dataset; at least one
        joints: Vec<(ElementId, [f64; 2])>,
    },
    /// an angle beyond half a turn begins within it
    WholeTurns {
        /// the joint or motion
        element: ElementId,
        /// its argument: "IC", "ICDISP"
        argument: &'static str,
        /// the angle in the dataset   \[rad\]
        given: f64,
        /// the angle that is measured at the start   \[rad\]
        begins: f64,
    },
    /// assembly leaves a joint another rate
    UnmetRate {
        /// the joint
        element: ElementId,
        /// the rate that is left
        found: f64,
        /// the rate that was asked for
        wanted: f64,
    },
    /// assembly leaves a quantity another value
    Unmet {
        /// the element
        element: ElementId,
        /// its argument: "IC", "EXACT X"
        argument: &'static str,
        /// the value that is left
        found: f64,
        /// the value that was asked for
        wanted: f64,
    },
    /// assembly leaves a contact elsewhere on its curve
    UnmetContact {
        /// the PTCV or CVCV
        element: ElementId,
        /// its argument: "DISP"
        argument: &'static str,
        /// user's number of the CURVE
        curve: u32,
        /// distance between the two points
        off: f64,
        /// unit of that
        unit: String,
    },
}

impl ConditionWarning {
    /// The stable short name of all of them.
    pub(super) const CODE: &'static str = "initial_condition";

    /// Returns the element that it is about.
    pub(super) fn subject(&self) -> Subject {
        let element = match *self {
            ConditionWarning::ViewOrder { ref joints } => {
                (joints.first()).map_or(ElementKind::Joint.id(0), |first| first.0)
            }
            ConditionWarning::Exchanged { element, .. }
            | ConditionWarning::WholeTurns { element, .. }
            | ConditionWarning::UnmetRate { element, .. }
            | ConditionWarning::Unmet { element, .. }
            | ConditionWarning::UnmetContact { element, .. } => element,
        };
        element.into()
    }

    /// Returns the sentence after the subject.
    pub(super) fn rest(&self, names: &Names) -> String {
        match self {
            ConditionWarning::Exchanged { given, stands, .. } => {
                let [first, second, stands] = [given[0], given[1], *stands].map(short);
                format!(
                    ": its initial condition {first}, {second} is read as \
                     displacement {first} and velocity {second}, but the parts stand at {stands}; \
                     Adams View writes velocity, displacement: exchange the two if that is meant"
                )
            }
            ConditionWarning::ViewOrder { joints } => {
                let [first, second] = joints.first().map_or([0.0; 2], |j| j.1).map(short);
                let second_joint = joints.get(1).map(|j| names.of(j.0)).unwrap_or_default();
                let others = match joints.len().saturating_sub(1) {
                    0 => String::new(),
                    1 => format!("; so is that of {second_joint}"),
                    n => format!("; so are those of {second_joint} and {} more", n - 1),
                };
                format!(
                    ": its initial condition {first}, {second} is read as \
                     velocity {first} and displacement {second}, as Adams View writes it{others}"
                )
            }
            ConditionWarning::WholeTurns {
                argument,
                given,
                begins,
                ..
            } => {
                let [given, begins] = [given, begins].map(|x| digits_of_six(*x));
                format!(
                    ": {argument} is {given} rad, more than half a turn: whole turns do not count, \
                     so that its angle begins at {begins}"
                )
            }
            ConditionWarning::UnmetRate { found, wanted, .. } => {
                let [found, wanted] = apart(*found, *wanted);
                format!(
                    " IC cannot be met: the constraints leave a velocity of {found} instead of {wanted}"
                )
            }
            ConditionWarning::Unmet {
                argument,
                found,
                wanted,
                ..
            } => {
                let [found, wanted] = apart(*found, *wanted);
                format!(
                    " {argument} cannot be met: constraints and other initial values leave {found} \
                     instead of {wanted}"
                )
            }
            ConditionWarning::UnmetContact {
                argument,
                curve,
                off,
                unit,
                ..
            } => {
                let off = length(*off, unit);
                format!(
                    " {argument} cannot be met: the constraints put the contact {off} away from \
                     the point of {} next to it",
                    names.of(ElementKind::Curve.id(*curve))
                )
            }
        }
    }
}

/// Writes two numbers that differ, with as many digits as it takes to see that.
fn apart(a: f64, b: f64) -> [String; 2] {
    let few = [a, b].map(digits_of_six);
    if few[0] == few[1] {
        return [a, b].map(|x| format!("{x:e}"));
    }
    few
}
