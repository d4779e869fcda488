//! The tree of an assembly: parts under the subassemblies that their names begin with, and at each
//! the constraints that it is an end of.

use cognate::model::{Element, ElementId, ElementKind, Family, Model};
use std::collections::BTreeMap;

/// An instance: the parts of this name, and the instances in it.
#[derive(Default)]
struct Instance {
    parts: Vec<ElementId>,
    inner: BTreeMap<String, Instance>,
}

/// Returns the tree, a line an instance.
pub fn tree(model: &Model) -> String {
    let mut root = Instance::default();
    for (id, element) in model.elements() {
        if id.kind.family() != Family::Body || id.kind == ElementKind::Marker {
            continue;
        }
        let own = id.to_string();
        let name = element.place().name.as_deref().unwrap_or(&own);
        let mut at = &mut root;
        for piece in name.split('.').filter(|piece| !piece.is_empty()) {
            at = at.inner.entry(piece.to_owned()).or_default();
        }
        at.parts.push(id);
    }
    let mut text = String::new();
    write(model, &root, "", &mut text);
    text
}

/// Writes what is in an instance, each line behind the branches above it.
fn write(model: &Model, instance: &Instance, before: &str, text: &mut String) {
    let last = instance.inner.len().saturating_sub(1);
    for (k, (name, inner)) in instance.inner.iter().enumerate() {
        let [branch, below] = match k == last {
            true => ["└ ", "  "],
            false => ["├ ", "│ "],
        };
        let parts: Vec<String> = inner
            .parts
            .iter()
            .map(|&id| facts(model, id, name))
            .collect();
        let parts = parts.join("; ");
        *text += format!("{before}{branch}{name}  {parts}").trim_end();
        text.push('\n');
        write(model, inner, &format!("{before}{below}"), text);
    }
}

/// Returns the number of a part, if its name does not say it, and the constraints that it is an end
/// of.
fn facts(model: &Model, part: ElementId, name: &str) -> String {
    let is_on = |marker: u32| {
        let marker = model.markers.get(&marker);
        marker.and_then(|m| m.owner.body()) == Some(part)
    };
    let holds = |element: &dyn Element| {
        element
            .ends()
            .is_some_and(|ends| ends.into_iter().any(is_on))
    };
    let all = model.elements().into_iter();
    let on = all.filter(|(id, element)| {
        id.kind.family() == Family::Constraint && model.is_active(*id) && holds(*element)
    });
    let on = on.map(|(id, element)| match &element.place().name {
        Some(given) => format!("{id} '{given}'"),
        None => id.to_string(),
    });
    let mut facts: Vec<String> = Vec::new();
    if part.to_string() != name {
        facts.push(part.to_string());
    }
    if model
        .parts
        .get(&part.number)
        .is_some_and(|p| p.ground && part.kind == ElementKind::Part)
    {
        facts.push("ground".to_owned());
    }
    facts.extend(on);
    facts.join(", ")
}
