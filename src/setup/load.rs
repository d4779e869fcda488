//! Loads of a model: what a load case chooses among. Gravity, motions, forces, contacts and initial
//! conditions; springs, dampers and the like belong to the mechanism and always act.

use crate::diagnostic::Diagnostic;
use crate::model::{ElementId, ElementKind, Model};
use std::fmt;

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

impl Load {
    /// Returns whether a text is what loads are called whatever the model: `gravity`, `MOTION/1`,
    /// `IC:PART/2`.
    pub fn is_written(text: &str) -> bool {
        let text = text.trim();
        let element = initial(text).unwrap_or(text);
        text.eq_ignore_ascii_case("gravity") || element.parse::<ElementId>().is_ok()
    }

    /// Returns the load of a model that a user calls so, and that acts: `gravity`; a motion, a
    /// force or a contact by any of its names; `IC:arm`, the initial conditions of a joint, a part
    /// or a marker.
    ///
    /// # Errors
    /// When the model has no such load, or several of the name.
    pub fn named(model: &Model, text: &str) -> Result<Self, Diagnostic> {
        let load = Self::of(model, text)?;
        match load.acts_in(model) {
            true => Ok(load),
            false => {
                let what = format!("the model has no load {load}");
                Err(Diagnostic::error("unknown_load", what))
            }
        }
    }

    /// Returns the load that a user calls so, as [`named`](Self::named) does, whether it acts or
    /// not.
    ///
    /// # Errors
    /// When the model has no such element, or several of the name.
    pub fn of(model: &Model, text: &str) -> Result<Self, Diagnostic> {
        let text = text.trim();
        let (kinds, element) = match initial(text) {
            _ if text.eq_ignore_ascii_case("gravity") => (&[][..], ""),
            Some(element) => (&BEGINNING[..], element),
            None => (&KINDS[..], text),
        };
        let found = match (kinds, initial(text)) {
            ([], _) => Ok(Load::Gravity),
            (_, Some(_)) => model.find_of(kinds, element).map(Load::Initial),
            (_, None) => model.find_of(kinds, element).map(Load::Element),
        };
        found.map_err(|d| no_load(model, kinds, (text, element), d))
    }
}

/// Says why an element is no load.
fn no_load(
    model: &Model,
    kinds: &[ElementKind],
    (text, element): (&str, &str),
    said: Diagnostic,
) -> Diagnostic {
    let wrong = |what: String| Diagnostic::error("unknown_load", what);
    let other = model.find_element(element).ok();
    match other.filter(|id| !kinds.contains(&id.kind)) {
        Some(id) if kinds == BEGINNING => wrong(format!("{} has no initial conditions", id.kind)),
        Some(id) => {
            let kinds = KINDS.map(ElementKind::keyword).join(", ");
            let what = format!(
                "{} is no load: loads are gravity, {kinds} and initial conditions (IC:PART/2)",
                id.kind
            );
            wrong(match element.parse::<ElementId>() {
                Ok(_) => what,
                Err(_) => format!("`{text}` is {id}: {what}"),
            })
        }
        None if model.has_name(kinds, element) => Diagnostic {
            code: "unknown_load",
            ..said
        },
        None if element.parse::<ElementId>().is_ok() => {
            wrong(format!("the model has no load {text}"))
        }
        None => wrong(format!("`{text}` is neither a load case nor a load")),
    }
}

/// Returns the element of `IC:PART/2`.
fn initial(text: &str) -> Option<&str> {
    let (word, element) = text.split_once(':')?;
    let is_initial = word.trim().eq_ignore_ascii_case("ic");
    is_initial.then_some(element.trim())
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
