//! Axes that must be aligned: pins of universal joints that cross, a rack along its pinion,
//! threads, pitch points of gears, and torques about an axis that both their parts share.
//!
//! The statements themselves contradict where pins are parallel or a rack runs along the pinion's
//! axis; elsewhere an angle of more than a degree as the dataset places the parts is told. What is
//! told of is data: `check` makes a finding of it, an analysis a warning.

use super::*;
use crate::arrange::Arrange;
use crate::model::geometry::marker_frame;
use crate::physics::joint::{JointKind, Relation, Tie};
use crate::scalar::Scalar;
use crate::space::{Frame, Vec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Angle that is told, in rad: a degree.
const TOLD: f64 = PI / 180.0;
/// Sine of an angle below which a direction is not there.
const NO_DIRECTION: f64 = 1e-9;

/// Axes of two markers that are not aligned as an element needs them.
#[derive(Clone, Debug, PartialEq)]
pub struct Misalignment {
    /// the element
    pub element: ElementId,
    /// how they should be aligned
    pub needed: Needed,
    /// users' numbers of the markers I and J, or of CV and J
    pub markers: [u32; 2],
    /// the angle between the axes, 0 to 180 degrees, in rad
    pub angle: f64,
}

/// The alignment that an element needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needed {
    /// pins of a UNIVERSAL, the z axes, are square to each other
    UniversalPins,
    /// pins of a HOOKE, x of I and y of J, are square to each other
    HookePins,
    /// x of the rack's marker J is the pinion's axis, z of I
    Rack,
    /// z of the pinion's marker I is the axis of the joint about which its part turns
    Pinion {
        /// user's number of the JOINT
        joint: u32,
    },
    /// the part of I turns, not that of J: the rack is given as I
    Exchanged {
        /// user's number of the JOINT about which the part of J turns
        joint: u32,
    },
    /// the z axes of a SCREW are one
    Thread,
    /// z of CV is the direction in which a geared body moves there
    PitchPoint {
        /// user's number of the JOINT
        joint: u32,
    },
    /// the z axes of a torsion spring are parallel
    TorsionSpring,
    /// the z axes of a torque are parallel
    Torque,
}

impl Misalignment {
    /// Returns whether the statement cannot mean anything so.
    fn is_contradiction(&self) -> bool {
        match self.needed {
            // the pins are parallel
            Needed::UniversalPins | Needed::HookePins => Scalar::sin(self.angle) < TOLD,
            // the rack does not move with the pinion
            Needed::Rack | Needed::Pinion { .. } => (self.angle - FRAC_PI_2).abs() < TOLD,
            Needed::Exchanged { .. } => true,
            Needed::Thread | Needed::PitchPoint { .. } | Needed::TorsionSpring | Needed::Torque => {
                false
            }
        }
    }

    /// Returns the advice that goes with it.
    pub fn advice(&self) -> &'static str {
        match self.needed {
            Needed::UniversalPins => {
                "turn one of the markers: z of I and z of J are the pins of a UNIVERSAL, square to each other"
            }
            Needed::HookePins => {
                "turn one of the markers: x of I and y of J are the pins of a HOOKE, square to each other; z axes lie along the shafts"
            }
            Needed::Rack | Needed::Pinion { .. } | Needed::Exchanged { .. } => {
                "I is the pinion, which turns about its z axis; J is the rack, which moves along z and has x along that axis: exchange them if they are the other way round"
            }
            Needed::Thread => "turn one of the markers, so that both z axes lie along the thread",
            Needed::PitchPoint { .. } => {
                "turn the CV marker: its z axis is the common velocity of both bodies where they mesh"
            }
            Needed::TorsionSpring | Needed::Torque => {
                "turn one of the markers, so that both z axes lie along the axis of the rotation"
            }
        }
    }
}

impl Misalignment {
    /// Returns the sentence after the element; `called` names others.
    pub fn rest(&self, called: &dyn Fn(ElementId) -> String) -> String {
        let [i, j] = self.markers.map(|m| called(ElementKind::Marker.id(m)));
        let degrees = |angle: f64| {
            let rounded = (angle.to_degrees() * 100.0).round() / 100.0;
            format!("{rounded} deg")
        };
        let apart = degrees(self.angle);
        match self.needed {
            Needed::UniversalPins => format!(
                "its pins, z of {i} and z of {j}, are {apart} apart and should cross at 90 deg"
            ),
            Needed::HookePins => format!(
                "its pins, x of {i} and y of {j}, are {apart} apart and should cross at 90 deg"
            ),
            Needed::Rack => format!(
                "x of {j} (the rack) is {apart} off the axis of the pinion, z of {i}, and should lie along it"
            ),
            Needed::Pinion { joint } => format!(
                "z of {i}, the axis of the pinion, is {apart} off the axis of {}, about which it turns",
                called(ElementKind::Joint.id(joint))
            ),
            Needed::Exchanged { joint } => format!(
                "the rack is given as I: the part of J, not that of I, turns, about {}; \
                 z of {i} is {apart} off that axis",
                called(ElementKind::Joint.id(joint))
            ),
            Needed::Thread => {
                format!("the z axes of {i} and {j} are {apart} apart: its thread needs one axis")
            }
            Needed::PitchPoint { joint } => format!(
                "z of {i} (CV) is {apart} off the way in which {} moves its body there, square to {j}",
                called(ElementKind::Joint.id(joint))
            ),
            Needed::TorsionSpring => format!(
                "the z axes of {i} and {j} are {apart} apart: its angle is read about z of {j}, and is not that of a rotation"
            ),
            Needed::Torque => {
                format!("the z axes of {i} and {j} are {apart} apart: its torque is about z of {j}")
            }
        }
    }
}

/// A finding of every element whose axes are not aligned as it needs them.
pub(super) fn axes_are_aligned(model: &Model, out: &mut Out) {
    for found in misaligned(model) {
        let Some((_, element)) = model
            .elements()
            .into_iter()
            .find(|(id, _)| *id == found.element)
        else {
            continue;
        };
        let who = (found.element, element.place());
        let said = found.rest(&|id| model.called(id));
        if found.is_contradiction() {
            error(out, "axes_not_aligned", who, said);
        } else {
            warn(out, "axes_not_aligned", who, said);
        }
        advise(out, found.advice());
    }
}

/// A warning of every RACKPIN whose pinion lies on the other side of the rack than its PD says.
pub(super) fn pinions_lie_on_their_side(model: &Model, out: &mut Out) {
    /// Part of the radius within which the side of the centre is open.
    const OPEN: f64 = 0.1;
    for (id, joint) in model.active(ElementKind::Joint, &model.joints) {
        let Some(pd) = joint.pd.filter(|_| joint.kind == JointKind::Rackpin) else {
            continue;
        };
        let markers = [joint.i, joint.j].map(|m| marker_frame(model, m));
        let [Some(pinion), Some(rack)] = markers else {
            continue;
        };
        let height = (pinion.position - rack.position).dot(rack.rotation.column(1));
        let is_open = height.abs() <= OPEN * pd.abs() / 2.0;
        if is_open || height * pd >= 0.0 || !height.is_finite() {
            continue;
        }
        let [i, j] = [joint.i, joint.j].map(|m| model.called(ElementKind::Marker.id(m)));
        let [pd, height, other] = [pd, height, -pd].map(magnitudes::short);
        let who = (ElementKind::Joint.id(id), &joint.place);
        let said = format!(
            "PD={pd} puts the pinion on the {} side of {j} (the rack), but the origin of {i} stands at y = {height} there: \
             the rack moves against the rim of its pinion",
            if joint.pd > Some(0.0) { "+y" } else { "-y" },
        );
        warn(out, "pinion_on_other_side", who, said);
        at_argument(out, "PD");
        advise(
            out,
            format!("write PD={other}, or turn {j} by 180 deg about its x axis"),
        );
    }
}

/// Returns all that is not aligned as the dataset places the parts.
pub(crate) fn misaligned(model: &Model) -> Vec<Misalignment> {
    let mut found = Vec::new();
    joints(model, &mut found);
    gears(model, &mut found);
    for (id, s) in model.active(ElementKind::SpringDamper, &model.spring_dampers) {
        if s.rotational {
            let element = ElementKind::SpringDamper.id(id);
            found.extend(parallel(model, element, Needed::TorsionSpring, [s.i, s.j]));
        }
    }
    for (id, s) in model.active(ElementKind::Sforce, &model.sforces) {
        if s.rotational && !s.action_only {
            let element = ElementKind::Sforce.id(id);
            found.extend(parallel(model, element, Needed::Torque, [s.i, s.j]));
        }
    }
    found
}

fn joints(model: &Model, found: &mut Vec<Misalignment>) {
    for (id, joint) in model.active(ElementKind::Joint, &model.joints) {
        let (element, markers) = (ElementKind::Joint.id(id), [joint.i, joint.j]);
        match (joint.kind, Tie::Joint(joint.kind).relation()) {
            (JointKind::Universal, _) => {
                found.extend(square(
                    model,
                    element,
                    Needed::UniversalPins,
                    markers,
                    [2, 2],
                ));
            }
            (JointKind::Hooke, _) => {
                found.extend(square(model, element, Needed::HookePins, markers, [0, 1]));
            }
            (_, Some(Relation::Rack)) => {
                found.extend(rack(model, element, markers));
            }
            (_, Some(Relation::Screw)) => {
                found.extend(parallel(model, element, Needed::Thread, markers));
            }
            (_, None) => {}
        }
    }
}

/// The first fault of a RACKPIN: exchanged, the pinion off its axis, or the rack off the pinion.
fn rack(model: &Model, element: ElementId, markers: [u32; 2]) -> Option<Misalignment> {
    let misaligned = |needed, angle| Misalignment {
        element,
        needed,
        markers,
        angle,
    };
    let [pinion, rack] = markers.map(|m| model.body_of(m));
    let z = marker_frame(model, markers[0])?.rotation.column(2);
    let off = |joint: &Joint| {
        let axis = marker_frame(model, joint.j)?.rotation.column(2);
        // either way along it
        angle_of(z, axis).map(|a| a.min(PI - a))
    };
    let (own, others) = (carriers(model, pinion?), carriers(model, rack?));
    let turning = |joints: &[(u32, &Joint)]| {
        let turns = |(id, j): &(u32, &Joint)| Some((*id, off(j)?)).filter(|_| turns(j.kind));
        let mut all: Vec<(u32, f64)> = joints.iter().filter_map(turns).collect();
        all.arrange_by(|a, b| a.1.total_cmp(&b.1));
        all.first().copied()
    };
    let slides = own.iter().any(|(_, j)| j.kind == JointKind::Translational);
    match (turning(&own), turning(&others)) {
        (None, Some((joint, angle))) if slides => {
            return Some(misaligned(Needed::Exchanged { joint }, angle));
        }
        (Some((joint, angle)), _) if angle > TOLD => {
            return Some(misaligned(Needed::Pinion { joint }, angle));
        }
        _ => {}
    }
    let angle = between(model, markers, [2, 0]).filter(|&a| a > TOLD)?;
    Some(misaligned(Needed::Rack, angle))
}

/// Returns whether a joint of a type turns about one axis, or about it and along it.
fn turns(kind: JointKind) -> bool {
    matches!(kind, JointKind::Revolute | JointKind::Cylindrical)
}

/// Returns the joints between two frames that hold a part.
fn carriers(model: &Model, part: ElementId) -> Vec<(u32, &Joint)> {
    let joints = model.active(ElementKind::Joint, &model.joints);
    let holds = |(_, j): &(u32, &Joint)| {
        let ends = [j.i, j.j].map(|m| model.body_of(m));
        !j.kind.row().rows.is_empty() && ends.contains(&Some(part))
    };
    joints.filter(holds).collect()
}

/// CV of a GEAR whose z axis is not along the motion of a geared body there.
fn gears(model: &Model, found: &mut Vec<Misalignment>) {
    for (id, gear) in model.active(ElementKind::Gear, &model.gears) {
        let Some(cv) = marker_frame(model, gear.cv) else {
            continue;
        };
        for n in gear.joints {
            let Some(joint) = model.joints.get(&n) else {
                continue;
            };
            let has = joint.kind.displacements();
            let Some(j) = marker_frame(model, joint.j).filter(|_| has.turns() != has.slides())
            else {
                continue;
            };
            let axis = j.rotation.column(2);
            let moves = if has.turns() {
                axis.cross(cv.position - j.position)
            } else {
                axis
            };
            let line = cv.rotation.column(2);
            // either way along it
            let angle = angle_of(line, moves).map(|a| a.min(PI - a));
            if let Some(angle) = angle.filter(|&a| a > TOLD) {
                found.push(Misalignment {
                    element: ElementKind::Gear.id(id),
                    needed: Needed::PitchPoint { joint: n },
                    markers: [gear.cv, joint.j],
                    angle,
                });
            }
        }
    }
}

/// Returns the angle between two directions; `None` where one has no length.
fn angle_of(a: Vec3<f64>, b: Vec3<f64>) -> Option<f64> {
    let (sine, cosine) = (a.cross(b).norm(), a.dot(b));
    (a.norm() > NO_DIRECTION && b.norm() > NO_DIRECTION).then(|| Scalar::atan2(sine, cosine))
}

/// Returns the angle between an axis of the first marker and one of the second.
fn between(model: &Model, markers: [u32; 2], axes: [usize; 2]) -> Option<f64> {
    let [i, j]: [Option<Frame<f64>>; 2] = markers.map(|m| marker_frame(model, m));
    angle_of(i?.rotation.column(axes[0]), j?.rotation.column(axes[1]))
}

fn parallel(
    model: &Model,
    element: ElementId,
    needed: Needed,
    markers: [u32; 2],
) -> Option<Misalignment> {
    let angle = between(model, markers, [2, 2]).filter(|&a| a > TOLD)?;
    Some(Misalignment {
        element,
        needed,
        markers,
        angle,
    })
}

fn square(
    model: &Model,
    element: ElementId,
    needed: Needed,
    markers: [u32; 2],
    axes: [usize; 2],
) -> Option<Misalignment> {
    let angle = between(model, markers, axes).filter(|&a| (a - FRAC_PI_2).abs() > TOLD)?;
    Some(Misalignment {
        element,
        needed,
        markers,
        angle,
    })
}
