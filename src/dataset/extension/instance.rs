//! Instances of an assembly: parts, and subassemblies whose parts have names with dots (`arm.rod`
//! and `arm.pin` are in `arm`). A constraint that is made on an instance makes it a rigid body.

use super::{RigidBody, bad};
use crate::diagnostic::{Diagnostic, Span, near_names};
use crate::model::{ElementKind, Model};
use std::collections::BTreeSet;

/// Returns the parts of an instance: a part by its number or name, or all parts of a subassembly.
///
/// # Errors
/// When there is no such instance.
pub(super) fn parts(model: &Model, name: &str) -> Result<Vec<u32>, Diagnostic> {
    let part = model.find_of(&[ElementKind::Part], name);
    if let Ok(id) = part {
        return Ok(vec![id.number]);
    }
    let named = |n: &u32| model.parts.get(n).and_then(|p| p.place.name.as_deref());
    let within = |n: &u32| named(n).is_some_and(|part| lies_in(part, name));
    let members: Vec<u32> = model.parts.keys().copied().filter(within).collect();
    match (members.is_empty(), part) {
        (false, _) => Ok(members),
        // several of the name
        (true, Err(d)) if model.has_name(&[ElementKind::Part], name) => Err(d),
        (true, _) => Err(unknown(model, name)),
    }
}

/// Returns the part of an instance that carries what is made on it: ground, or the first.
pub(super) fn carrier(model: &Model, parts: &[u32]) -> Option<u32> {
    let is_ground = |n: &&u32| model.parts.get(n).is_some_and(|p| p.ground);
    parts.iter().find(is_ground).or(parts.first()).copied()
}

/// Makes an instance a rigid body, unless it is one.
///
/// # Errors
/// When what it lies in, or something in it, is a rigid body.
pub(super) fn rigidify(
    model: &Model,
    name: &str,
    span: Span,
    bodies: &mut Vec<RigidBody>,
) -> Result<Vec<u32>, Diagnostic> {
    let parts = parts(model, name)?;
    let of_part = |n: u32| model.parts.get(&n).and_then(|p| p.place.name.clone());
    let name = match parts[..] {
        [only] => of_part(only).unwrap_or_else(|| name.to_owned()),
        _ => name.to_owned(),
    };
    for body in bodies.iter() {
        let rigid = |what: &str, advice: &str| {
            let what = format!(
                "{name} cannot be a rigid body: {}, {what}, is one",
                body.name
            );
            Diagnostic::error("rigid_body", what).help(advice)
        };
        if lies_in(&name, &body.name) {
            let advice = format!("name {} instead", body.name);
            return Err(rigid("in which it lies", &advice));
        }
        if lies_in(&body.name, &name) {
            return Err(rigid(
                "which lies in it",
                "name one of its instances instead",
            ));
        }
    }
    if !bodies.iter().any(|b| b.name == name) {
        let members = parts
            .iter()
            .map(|&n| (ElementKind::Part.id(n).to_string(), span));
        bodies.push(RigidBody {
            members: members.collect(),
            name,
            span,
            implied: true,
        });
    }
    Ok(parts)
}

/// Returns whether an instance lies in another.
fn lies_in(inner: &str, outer: &str) -> bool {
    inner
        .strip_prefix(outer)
        .is_some_and(|rest| rest.starts_with('.'))
}

/// Returns the mistake about an instance that does not exist, with those that do.
fn unknown(model: &Model, name: &str) -> Diagnostic {
    let mut known = BTreeSet::new();
    for part in model.parts.values().filter_map(|p| p.place.name.as_deref()) {
        let dots = part
            .match_indices('.')
            .map(|(at, _)| at)
            .filter(|&at| at > 0);
        known.extend(dots.map(|at| &part[..at]));
        known.insert(part);
    }
    let d = bad(format!("there is no instance `{name}`"));
    let near = near_names(name, known.iter().copied());
    match near.is_empty() {
        true => d.help("an instance is PART/2, the name of a part, or what parts' names begin with: `arm` of `arm.rod`"),
        false => d.help(format!("did you mean {}?", near.join(" or "))),
    }
}
