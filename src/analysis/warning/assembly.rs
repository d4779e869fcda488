//! Warnings of assembly: how the parts of a dataset fit together, before and after.

use super::Names;
use crate::analysis::direction::Axis;
use crate::analysis::quantity::{amount, length, short};
use crate::diagnostic::{Cause, Subject};
use crate::model::check::alignment::Misalignment;
use crate::model::{ElementId, ElementKind};

/// Turned parts that a sentence names beside the first, at most.
const MAX_NAMED: usize = 3;

/// Something that assembly made of the configuration of the dataset.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
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
    /// axes are not aligned as an element needs them, as the dataset places the parts
    Axes(Misalignment),
    /// parts are turned against the dataset
    Turned {
        /// the parts and their angles in rad, largest first; at least one
        parts: Vec<(ElementId, f64)>,
    },
    /// a joint is assembled the other way round
    WrongWayRound {
        /// the joint
        element: ElementId,
        /// users' numbers of its markers I and J
        markers: [u32; 2],
        /// the axes that point against each other: 0 x, 2 z
        axis: usize,
    },
    /// motions of angles hold at another angle than they ask for
    OppositeAngle {
        /// the first of the motions between the same markers
        element: ElementId,
        /// the angle in between, in rad
        angle: f64,
    },
    /// a force acts along the line between markers that coincide, but is zero there
    Coincident {
        /// the force
        element: ElementId,
        /// users' numbers of its markers I and J
        markers: [u32; 2],
    },
    /// the solids of a contact begin deep within each other
    Embedded {
        /// the contact
        element: ElementId,
        /// overlap of the solids
        depth: f64,
        /// unit of the depth
        unit: String,
    },
    /// an equation would follow from others if axes were aligned exactly, and is left out
    LeftOut {
        /// the joint
        element: ElementId,
        /// the equation that is off most
        equation: String,
        /// by how much, in rad or as a length
        off: f64,
        /// how much is permitted, likewise
        limit: f64,
        /// whether these are lengths
        is_length: bool,
        /// unit of lengths
        unit: String,
    },
    /// a part is not where the simulation before has left it
    Moved {
        /// the part that is farthest
        element: ElementId,
        /// its distance, zero where that is too small to be told
        offset: f64,
        /// its turn, in rad, likewise
        turn: f64,
        /// unit of the distance
        unit: String,
    },
    /// a part does not move as the simulation before has left it
    Struck {
        /// the part whose velocity has changed most
        element: ElementId,
        /// change of its velocity, zero where that is too small to be told
        speed: f64,
        /// change of its angular velocity, in rad per time, likewise
        spin: f64,
        /// unit of length
        unit: String,
    },
    /// displacements do not sum up to zero where they are assembled
    HeldSum {
        /// the COUPLER or GEAR
        element: ElementId,
        /// the sum, which is held
        sum: f64,
    },
    /// a motion begins elsewhere than where its joint is drawn
    DrivenStart {
        /// the motion
        element: ElementId,
        /// how far   [rad, length]
        by: f64,
        /// it drives an angle
        is_angle: bool,
        /// unit of length
        unit: String,
    },
    /// loads read a reaction that redundant equations leave open
    OpenReaction {
        /// the constraint
        element: ElementId,
    },
}

/// Code of a reaction that loads read and redundant equations leave open.
pub const OPEN_REACTION: &str = "open_reaction";

impl AssemblyWarning {
    /// Writes a distance and an angle with their directions: "2 mm along ground X and 3 deg about
    /// Z of MARKER/7".
    pub(in crate::analysis) fn apart(
        offset: &Option<(f64, Axis)>,
        unit: &str,
        turn: &Option<(f64, Axis)>,
    ) -> String {
        let offset =
            (offset.as_ref()).map(|(by, axis)| format!("{} along {axis}", length(*by, unit)));
        let turn = (turn.as_ref())
            .map(|(angle, axis)| format!("{} deg about {axis}", short(angle.to_degrees())));
        let off: Vec<String> = offset.into_iter().chain(turn).collect();
        off.join(" and ")
    }

    /// Returns the part that it says to leap between two simulations.
    pub(in crate::analysis) fn leaps(&self) -> Option<ElementId> {
        match *self {
            AssemblyWarning::Moved { element, .. } | AssemblyWarning::Struck { element, .. } => {
                Some(element)
            }
            AssemblyWarning::Misaligned { .. }
            | AssemblyWarning::Axes(_)
            | AssemblyWarning::Turned { .. }
            | AssemblyWarning::WrongWayRound { .. }
            | AssemblyWarning::OppositeAngle { .. }
            | AssemblyWarning::Coincident { .. }
            | AssemblyWarning::Embedded { .. }
            | AssemblyWarning::LeftOut { .. }
            | AssemblyWarning::HeldSum { .. }
            | AssemblyWarning::DrivenStart { .. }
            | AssemblyWarning::OpenReaction { .. } => None,
        }
    }

    /// Returns its stable short name.
    pub(super) fn code(&self) -> &'static str {
        match self {
            AssemblyWarning::Misaligned { .. } => Cause::Misaligned.code(),
            AssemblyWarning::Axes(_) => "axes_not_aligned",
            AssemblyWarning::Turned { .. } => "turned",
            AssemblyWarning::WrongWayRound { .. } | AssemblyWarning::OppositeAngle { .. } => {
                "wrong_way_round"
            }
            AssemblyWarning::Coincident { .. } => "coincident",
            AssemblyWarning::Embedded { .. } => "embedded",
            AssemblyWarning::LeftOut { .. } => "redundant",
            AssemblyWarning::Moved { .. } | AssemblyWarning::Struck { .. } => "leap",
            AssemblyWarning::HeldSum { .. } => "held_sum",
            AssemblyWarning::DrivenStart { .. } => "driven_start",
            AssemblyWarning::OpenReaction { .. } => OPEN_REACTION,
        }
    }

    /// Returns the element that it is about.
    pub(super) fn subject(&self) -> Subject {
        let element = match *self {
            AssemblyWarning::Axes(ref found) => found.element,
            AssemblyWarning::Turned { ref parts } => {
                (parts.first()).map_or(ElementKind::Part.id(0), |first| first.0)
            }
            AssemblyWarning::Misaligned { element, .. }
            | AssemblyWarning::WrongWayRound { element, .. }
            | AssemblyWarning::OppositeAngle { element, .. }
            | AssemblyWarning::Coincident { element, .. }
            | AssemblyWarning::Embedded { element, .. }
            | AssemblyWarning::LeftOut { element, .. }
            | AssemblyWarning::Moved { element, .. }
            | AssemblyWarning::Struck { element, .. }
            | AssemblyWarning::HeldSum { element, .. }
            | AssemblyWarning::DrivenStart { element, .. }
            | AssemblyWarning::OpenReaction { element } => element,
        };
        element.into()
    }

    /// Returns the sentence after the subject.
    pub(super) fn rest(&self, names: &Names) -> String {
        match self {
            AssemblyWarning::Misaligned {
                offset, unit, turn, ..
            } => {
                let off = Self::apart(offset, unit, turn);
                format!(": in the dataset its markers are off by {off}; assembly moves the parts")
            }
            AssemblyWarning::Axes(found) => format!(": {}", found.rest(&|id| names.of(id))),
            AssemblyWarning::Turned { parts } => turned(parts, names),
            AssemblyWarning::WrongWayRound {
                markers: [i, j],
                axis,
                ..
            } => format!(
                " is assembled the wrong way round: \
                 the {} axes of {} and {} point against each other",
                ["x", "y", "z"][*axis],
                names.of(ElementKind::Marker.id(*i)),
                names.of(ElementKind::Marker.id(*j))
            ),
            AssemblyWarning::OppositeAngle { angle, .. } => format!(
                " is off by {} deg: its equation holds at that angle too, and the angle that it \
                 asks for cannot be reached",
                short(angle.to_degrees())
            ),
            AssemblyWarning::Coincident {
                markers: [i, j], ..
            } => format!(
                ": its markers {} and {} coincide: the line between them has no \
                 direction; its force is zero there, so that it can begin, but Adams refuses it",
                names.of(ElementKind::Marker.id(*i)),
                names.of(ElementKind::Marker.id(*j))
            ),
            AssemblyWarning::Embedded { depth, unit, .. } => {
                let depth = length(*depth, unit);
                format!(": its solids begin {depth} deep within each other")
            }
            AssemblyWarning::LeftOut {
                equation,
                off,
                limit,
                is_length,
                unit,
                ..
            } => {
                let [off, limit] = [off, limit].map(|x| amount(*x, *is_length, unit));
                format!(
                    ": {equation} is redundant but for a misalignment of {off}, and is left out \
                     (IC/ERROR permits {limit})"
                )
            }
            AssemblyWarning::Moved {
                offset, turn, unit, ..
            } => moved(*offset, *turn, unit),
            AssemblyWarning::Struck {
                speed, spin, unit, ..
            } => struck(*speed, *spin, unit),
            AssemblyWarning::HeldSum { sum, .. } => format!(
                ": its displacements sum up to {sum:.6e} where they are assembled; \
                 that sum is held, not zero"
            ),
            AssemblyWarning::DrivenStart {
                by, is_angle, unit, ..
            } => format!(
                " begins {} from where its joint is drawn; assembly moves the parts there",
                amount(by.abs(), !is_angle, unit)
            ),
            AssemblyWarning::OpenReaction { .. } => {
                ": redundant equations leave its reaction open, and a force or friction reads it: \
                 the smallest reactions are taken, and the motion depends on that choice"
                    .to_owned()
            }
        }
    }
}

/// Returns by how much a part is moved between two simulations.
fn moved(offset: f64, turn: f64, unit: &str) -> String {
    let moved = (offset > 0.0).then(|| format!("moved by {}", length(offset, unit)));
    let turned = (turn > 0.0).then(|| format!("turned by {} deg", short(turn.to_degrees())));
    let leap: Vec<String> = moved.into_iter().chain(turned).collect();
    format!(
        " is {} between two simulations, to satisfy what was switched on or changed there; \
         this is said once for each part",
        leap.join(" and ")
    )
}

/// Returns by how much the velocity of a part changes between two simulations.
fn struck(speed: f64, spin: f64, unit: &str) -> String {
    let speed = (speed > 0.0).then(|| length(speed, unit));
    let spin = (spin > 0.0).then(|| format!("{} rad", short(spin)));
    let rates: Vec<String> = speed.into_iter().chain(spin).collect();
    format!(
        ": its velocity jumps by {} per unit of time between two simulations, to satisfy what was \
         switched on or changed there; this is said once for each part",
        rates.join(" and ")
    )
}

/// Returns which parts are turned against the dataset, and by which angle.
fn turned(parts: &[(ElementId, f64)], names: &Names) -> String {
    let by = |angle: f64| format!("by {} deg", short(angle.to_degrees()));
    let first = parts.first().map_or(0.0, |p| p.1);
    let others = parts.iter().skip(1).take(MAX_NAMED);
    let others: Vec<String> = others
        .map(|&(part, angle)| format!("{} {}", names.of(part), by(angle)))
        .collect();
    let so_are = if others.is_empty() { "" } else { "; so are " };
    let more = match parts.len().saturating_sub(1 + MAX_NAMED) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!(
        " is turned {} against the dataset{so_are}{}{more}",
        by(first),
        others.join(", ")
    )
}
