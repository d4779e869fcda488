//! Loads of a model: what a load case chooses among. Gravity, motions, forces, contacts and initial
//! conditions; springs, dampers and the like belong to the mechanism and always act.

use crate::model::{ElementId, ElementKind, Model};
use std::fmt;
use std::str::FromStr;

/// A load.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Load {
    /// gravity on the whole model
    Gravity,
    /// a motion, a force or a contact
    Element(ElementId),
    /// the initial conditions of a joint, a part or a marker
    Initial(ElementId),
}

/// Kinds of elements that are loads.
const KINDS: [ElementKind; 6] = [
    ElementKind::Motion,
    ElementKind::Sforce,
    ElementKind::Vforce,
    ElementKind::Vtorque,
    ElementKind::Gforce,
    ElementKind::Contact,
];

/// Kinds of elements that have initial conditions.
const BEGINNING: [ElementKind; 4] = [
    ElementKind::Joint,
    ElementKind::Part,
    ElementKind::PointMass,
    ElementKind::Marker,
];

impl fmt::Display for Load {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Load::Gravity => f.write_str("gravity"),
            Load::Element(id) => id.fmt(f),
            Load::Initial(id) => write!(f, "IC:{id}"),
        }
    }
}

impl FromStr for Load {
    type Err = String;

    /// Reads `gravity`, `MOTION/1`, or `IC:PART/2`.
    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        if text.eq_ignore_ascii_case("gravity") {
            return Ok(Load::Gravity);
        }
        if let Some((word, element)) = text.split_once(':')
            && word.trim().eq_ignore_ascii_case("ic")
        {
            let id: ElementId = element.parse()?;
            return match BEGINNING.contains(&id.kind) {
                true => Ok(Load::Initial(id)),
                false => Err(format!("{} has no initial conditions", id.kind)),
            };
        }
        let id: ElementId = text.parse()?;
        match KINDS.contains(&id.kind) {
            true => Ok(Load::Element(id)),
            false => Err(format!(
                "{} is no load: loads are gravity, {} and initial conditions (IC:PART/2)",
                id.kind,
                KINDS.map(ElementKind::keyword).join(", ")
            )),
        }
    }
}

impl Load {
    /// Returns whether a model has the load, switched on.
    pub fn acts_in(self, model: &Model) -> bool {
        match self {
            Load::Gravity => model.gravity != [0.0; 3],
            Load::Element(id) => model.has(id) && model.is_active(id),
            Load::Initial(id) => begins(model, id),
        }
    }

    /// Takes the load away from a model.
    pub fn leave_out(self, model: &mut Model) {
        match self {
            Load::Gravity => model.gravity = [0.0; 3],
            Load::Element(id) => {
                model.inactive.insert(id);
            }
            Load::Initial(id) => {
                model.beginnings.remove(&id);
                if let Some(joint) = model.joints.get_mut(&id.number)
                    && id.kind == ElementKind::Joint
                {
                    (joint.ic_translation, joint.ic_rotation) = ([None; 2], [None; 2]);
                }
                let bodies = match id.kind {
                    ElementKind::Part => &mut model.parts,
                    ElementKind::PointMass => &mut model.point_masses,
                    _ => return,
                };
                if let Some(body) = bodies.get_mut(&id.number) {
                    (body.velocity, body.angular_velocity) = ([None; 3], [None; 3]);
                }
            }
        }
    }
}

/// Returns whether an element has initial conditions.
fn begins(model: &Model, id: ElementId) -> bool {
    if model.beginnings.contains_key(&id) {
        return true;
    }
    if id.kind == ElementKind::Joint {
        let joint = model.joints.get(&id.number);
        return joint.is_some_and(|j| [j.ic_translation, j.ic_rotation] != [[None; 2]; 2]);
    }
    let body = model.body(id);
    body.is_some_and(|b| [b.velocity, b.angular_velocity] != [[None; 3]; 2])
}

/// Returns all loads of a model, gravity first, then in the order of the table of elements.
pub fn loads_of(model: &Model) -> Vec<Load> {
    let elements = KINDS.iter().flat_map(|&kind| {
        let ids = model.numbers(kind).into_iter().map(move |n| kind.id(n));
        ids.map(Load::Element)
    });
    let beginning = BEGINNING.iter().flat_map(|&kind| {
        let ids = model.numbers(kind).into_iter().map(move |n| kind.id(n));
        ids.map(Load::Initial)
    });
    let all = std::iter::once(Load::Gravity)
        .chain(elements)
        .chain(beginning);
    all.filter(|load| load.acts_in(model)).collect()
}
