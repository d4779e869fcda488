//! Initial values that comment lines of ours give joints and markers.

use super::*;

/// Refuses initial values of what does not exist, has no such quantity, or has no place of its own.
pub(super) fn beginnings_have_their_elements(model: &Model, out: &mut Out) {
    for (&id, values) in &model.beginnings {
        let line = model.element(id).map_or(0, |e| e.place().line);
        let mut refuse = |message: String| {
            let mut d = Diagnostic::error("bad_extension", message).element(id);
            (d.line, d.column) = (line, usize::from(line > 0));
            out.push(d);
        };
        if !model.has(id) {
            refuse(format!("{id} does not exist: it has no initial values"));
            continue;
        }
        let known = model.initial_quantities(id);
        let is_unknown = |q: &InitialQuantity| known.iter().all(|(_, k)| k != q);
        if values.keys().any(is_unknown) {
            refuse("it has no such initial values".to_owned());
        }
        if let Some((_, x)) = values.iter().find(|(_, x)| !x.is_finite()) {
            refuse(format!("an initial value is {x}"));
        }
        let is_floating = |n: u32| model.markers.get(&n).is_some_and(|m| m.floating);
        if id.kind == ElementKind::Marker && is_floating(id.number) {
            refuse(
                "a floating marker is where its element sets it: it has no initial values".into(),
            );
        }
    }
}
