//! Initial values that comment lines of ours give joints and markers.

use super::*;
use crate::space::Vec3;
use crate::space::rotation::with_angles_between_axes;

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
        if (model.joints.get(&id.number)).is_some_and(|j| j.kind.is_ball())
            && id.kind == ElementKind::Joint
        {
            let angles = [0, 1, 2].map(|k| values.get(&InitialQuantity::Variable(k)).copied());
            match angles {
                [Some(x), Some(y), Some(z)] => {
                    if with_angles_between_axes([x, y, z], Vec3::zero()).is_none() {
                        refuse(
                            "no turn has these three angles between axes and what they become: \
                                for a turn by A about x give X=0, Y=A, Z=A"
                                .to_owned(),
                        );
                    }
                }
                _ => refuse(
                    "of X, Y and Z, the angles between the axes of a ball's markers, all \
                             are given or none"
                        .to_owned(),
                ),
            }
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
