//! Warnings of assembly: how the parts of a dataset fit together, before and after.

use crate::analysis::direction::Axis;
use crate::analysis::quantity::{length, short};
use crate::model::{ElementId, ElementKind};
use std::fmt;

/// Something that assembly made of the configuration of the dataset.
#[derive(Clone, Debug, PartialEq)]
pub enum AssemblyWarning {
    /// the markers of a joint do not fit as the dataset places the parts
    Misaligned {
        /// the joint
        element: ElementId,
        /// distance and its direction, where that is worth telling
        offset: Option<(f64, Axis)>,
        /// unit of the distance
        unit: String,
        /// angle in rad and its axis, where that is worth telling
        turn: Option<(f64, Axis)>,
    },
    /// a part is assembled on another branch than it is drawn
    OtherBranch {
        /// the part
        element: ElementId,
        /// angle between the two in rad
        angle: f64,
    },
    /// a joint is assembled the other way round
    WrongWayRound {
        /// the joint
        element: ElementId,
        /// users' numbers of its markers I and J
        markers: [u32; 2],
    },
    /// a force acts along the line between markers that coincide, but is zero there
    Coincident {
        /// the force
        element: ElementId,
        /// users' numbers of its markers I and J
        markers: [u32; 2],
    },
    /// displacements do not sum up to zero where they are assembled
    HeldSum {
        /// the COUPLER or GEAR
        element: ElementId,
        /// the sum, which is held
        sum: f64,
    },
}

impl AssemblyWarning {
    /// Returns its stable short name.
    pub(super) fn code(&self) -> &'static str {
        match self {
            AssemblyWarning::Misaligned { .. } => "misaligned",
            AssemblyWarning::OtherBranch { .. } => "other_branch",
            AssemblyWarning::WrongWayRound { .. } => "wrong_way_round",
            AssemblyWarning::Coincident { .. } => "coincident",
            AssemblyWarning::HeldSum { .. } => "held_sum",
        }
    }

    /// Returns the element that it is about.
    pub(super) fn element(&self) -> ElementId {
        match *self {
            AssemblyWarning::Misaligned { element, .. }
            | AssemblyWarning::OtherBranch { element, .. }
            | AssemblyWarning::WrongWayRound { element, .. }
            | AssemblyWarning::Coincident { element, .. }
            | AssemblyWarning::HeldSum { element, .. } => element,
        }
    }
}

impl fmt::Display for AssemblyWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.element();
        match self {
            AssemblyWarning::Misaligned {
                offset, unit, turn, ..
            } => {
                let offset = offset.map(|(by, axis)| format!("{} along {axis}", length(by, unit)));
                let turn = turn
                    .map(|(angle, axis)| format!("{} deg about {axis}", short(angle.to_degrees())));
                let off: Vec<String> = offset.into_iter().chain(turn).collect();
                let off = off.join(" and ");
                write!(
                    f,
                    "{name}: in the dataset its markers are off by {off}; assembly moves the parts"
                )
            }
            AssemblyWarning::OtherBranch { angle, .. } => {
                let angle = short(angle.to_degrees());
                write!(
                    f,
                    "{name} is assembled on another branch: turned by {angle} deg against the dataset"
                )
            }
            AssemblyWarning::WrongWayRound {
                markers: [i, j], ..
            } => write!(
                f,
                "{name} is assembled the wrong way round: \
                 the z axes of {} and {} point against each other",
                ElementKind::Marker.id(*i),
                ElementKind::Marker.id(*j)
            ),
            AssemblyWarning::Coincident {
                markers: [i, j], ..
            } => write!(
                f,
                "{name}: its markers {} and {} coincide: the line between them has no \
                 direction; its force is zero there, so that it can begin, but Adams refuses it",
                ElementKind::Marker.id(*i),
                ElementKind::Marker.id(*j)
            ),
            AssemblyWarning::HeldSum { sum, .. } => write!(
                f,
                "{name}: its displacements sum up to {sum:.6e} where they are assembled; \
                 that sum is held, not zero"
            ),
        }
    }
}
