//! Warnings of initial conditions: not met, or read in another way than documented.

use crate::analysis::quantity::{length, short};
use crate::model::{ElementId, ElementKind};
use std::fmt;

/// Something about an initial condition.
#[derive(Clone, Debug, PartialEq)]
pub enum ConditionWarning {
    /// its two numbers fit the parts better when they are exchanged
    Exchanged {
        /// the joint
        element: ElementId,
        /// the numbers as they stand in the dataset
        given: [f64; 2],
        /// where the parts stand
        stands: f64,
        /// the numbers are read as velocity and displacement
        believed: bool,
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
    pub(super) fn element(&self) -> ElementId {
        match *self {
            ConditionWarning::Exchanged { element, .. }
            | ConditionWarning::Unmet { element, .. }
            | ConditionWarning::UnmetContact { element, .. } => element,
        }
    }
}

impl fmt::Display for ConditionWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.element();
        match self {
            ConditionWarning::Exchanged {
                given,
                stands,
                believed,
                ..
            } => {
                let [first, second, stands] = [given[0], given[1], *stands].map(short);
                write!(
                    f,
                    "{name}: its initial condition {first}, {second} is read as "
                )?;
                if *believed {
                    write!(
                        f,
                        "velocity {first} and displacement {second}, as Adams View writes it: \
                         the parts stand at {stands}"
                    )
                } else {
                    write!(
                        f,
                        "displacement {first} and velocity {second}, but the parts stand at {stands}; \
                         Adams View writes velocity, displacement: exchange the two if that is meant"
                    )
                }
            }
            ConditionWarning::Unmet {
                argument,
                found,
                wanted,
                ..
            } => write!(
                f,
                "{name} {argument} cannot be met: \
                 the constraints leave {found:.6e} instead of {wanted:.6e}"
            ),
            ConditionWarning::UnmetContact {
                argument,
                curve,
                off,
                unit,
                ..
            } => {
                let off = length(*off, unit);
                write!(
                    f,
                    "{name} {argument} cannot be met: the constraints put the contact {off} away from \
                     the point of {} next to it",
                    ElementKind::Curve.id(*curve)
                )
            }
        }
    }
}
