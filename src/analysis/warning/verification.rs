//! Warnings of verifications: what is taken for granted, and what a simulation would need.

use super::owner;
use crate::diagnostic::{Cause, Diagnostic, Subject, counted};
use crate::model::ElementId;
use crate::scene::left_out::Hidden;

/// Something that a verification takes for granted, or that a simulation would need.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
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
    pub(super) fn subject(&self) -> Option<Subject> {
        match self {
            VerificationWarning::Massless(d) => Some(owner(d)),
            VerificationWarning::StandsStill(element)
            | VerificationWarning::UnknownConstraint { element, .. } => Some((*element).into()),
            VerificationWarning::FreedomNearby { .. } => None,
        }
    }

    /// Returns the sentence after the subject.
    pub(super) fn rest(&self) -> String {
        match self {
            VerificationWarning::Massless(d) => {
                format!(": {}; a dynamic simulation needs it", d.message)
            }
            VerificationWarning::StandsStill(_) => {
                String::from(" is computed by a routine: it is taken to stand still")
            }
            VerificationWarning::UnknownConstraint {
                equations: n,
                hidden,
                ..
            } => {
                format!(
                    " is counted with {}, but what it holds is unknown: {hidden}; the freedom from \
                     the rank is that without it, and up to {n} too large",
                    counted(*n, "equation")
                )
            }
            VerificationWarning::FreedomNearby { here, nearby } => format!(
                "at this position {} of the free directions lead nowhere, or to another branch: \
                 nearby the freedom is {nearby}",
                here.abs_diff(*nearby)
            ),
        }
    }
}
