//! Warnings of verifications: what is taken for granted, and what a simulation would need.

use super::owner;
use crate::diagnostic::{Cause, Diagnostic};
use crate::model::ElementId;
use crate::scene::left_out::Hidden;
use std::fmt;

/// Something that a verification takes for granted, or that a simulation would need.
#[derive(Clone, Debug, PartialEq)]
pub enum VerificationWarning {
    /// a direction has no mass, which only dynamics asks for
    Massless(Diagnostic),
    /// a motion that a routine computes is taken to stand still
    StandsStill(ElementId),
    /// a constraint is counted, but nobody knows what it holds
    UnknownConstraint {
        /// the constraint
        element: ElementId,
        /// number of its equations
        equations: usize,
        /// where that stands
        hidden: Hidden,
    },
    /// the freedom at this position is not that nearby
    FreedomNearby {
        /// freedom at this position
        here: usize,
        /// freedom near it
        nearby: usize,
    },
}

impl VerificationWarning {
    /// Returns its stable short name.
    pub(super) fn code(&self) -> &'static str {
        match self {
            VerificationWarning::Massless(d) => d.code,
            VerificationWarning::StandsStill(_) => Cause::UserRoutine.code(),
            VerificationWarning::UnknownConstraint { .. } => "unknown_constraint",
            VerificationWarning::FreedomNearby { .. } => "freedom",
        }
    }

    /// Returns the element that it is about.
    pub(super) fn element(&self) -> Option<String> {
        match self {
            VerificationWarning::Massless(d) => d.element.clone(),
            VerificationWarning::StandsStill(element)
            | VerificationWarning::UnknownConstraint { element, .. } => Some(element.to_string()),
            VerificationWarning::FreedomNearby { .. } => None,
        }
    }
}

impl fmt::Display for VerificationWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            VerificationWarning::Massless(d) => {
                let (owner, what) = (owner(d), &d.message);
                write!(f, "{owner}: {what}; a dynamic simulation needs it")
            }
            VerificationWarning::StandsStill(element) => write!(
                f,
                "{element} is computed by a routine: it is taken to stand still"
            ),
            VerificationWarning::UnknownConstraint {
                element,
                equations: n,
                hidden,
            } => {
                let plural = if *n == 1 { "" } else { "s" };
                write!(
                    f,
                    "{element} is counted with {n} equation{plural}, but what it holds is unknown: \
                     {hidden}; the freedom from the rank is that without it, and up to {n} too large"
                )
            }
            VerificationWarning::FreedomNearby { here, nearby } => write!(
                f,
                "at this position {} of the free directions lead nowhere, or to another branch: \
                 nearby the freedom is {nearby}",
                here.abs_diff(*nearby)
            ),
        }
    }
}
