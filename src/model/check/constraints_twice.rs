//! Joints that stand twice: of the same type, between the same parts, at the same place.

use super::*;
use crate::arrange::Arrange;
use crate::model::geometry::marker_frame;
use crate::physics::joint::Displacements;
use crate::space::Frame;

/// Difference of places, relative to their distance from the origin, and of axes that are the same.
const SAME: f64 = 1e-9;

/// Number of a joint, its type, and where it stands.
type Stands = (u32, JointKind, Frame<f64>);

pub(super) fn joints_stand_once(model: &Model, out: &mut Out) {
    let same = |a: &Frame<f64>, b: &Frame<f64>| {
        let scale = a.position.norm().max(b.position.norm());
        let axes = a.rotation.column(2).cross(b.rotation.column(2));
        (a.position - b.position).norm() <= SAME * scale && axes.norm() <= SAME
    };
    let mut seen: BTreeMap<[Option<ElementId>; 2], Vec<Stands>> = BTreeMap::new();
    for (id, joint) in model.active(ElementKind::Joint, &model.joints) {
        let Some(at) = marker_frame(model, joint.j) else {
            continue;
        };
        // couplings of rotation and translation may share a place
        if joint.kind.displacements() == Displacements::None && joint.kind != JointKind::Fixed {
            continue;
        }
        let mut bodies = [model.body_of(joint.i), model.body_of(joint.j)];
        bodies.arrange();
        let between = seen.entry(bodies).or_default();
        let mut between_them = between.iter();
        let alike = between_them.find(|(_, kind, there)| *kind == joint.kind && same(&at, there));
        if let Some(first) = alike {
            let first = model.called(ElementKind::Joint.id(first.0));
            let message =
                format!("{first} is the same joint between the same parts at the same place");
            let who = (ElementKind::Joint.id(id), &joint.place);
            warn(out, "stands_twice", who, message);
        }
        between.push((id, joint.kind, at));
    }
}
