//! Facts that routines are told of their elements, from the model.

use super::forms::{Asker, Form};
use super::structures::Structure;
use cognate::internals::physics::contact::{Pressing, Slipping};
use cognate::internals::scene::coupled::Partials;
use cognate::model::{
    ArrayKind, Comparison, Driven, ElementId, ElementKind as K, JointKind, Level, Model,
};
use std::ffi::{CString, c_int};

/// Returns a number of an element as C has it.
fn number(id: Option<u32>) -> c_int {
    id.and_then(|id| c_int::try_from(id).ok()).unwrap_or(0)
}

/// Returns what a routine is told of its element.
pub fn asker(model: &Model, element: ElementId, form: Form) -> Asker {
    let n = element.number;
    let vector = |f: &cognate::model::VectorForce| {
        Structure::Vector([Some(f.i), f.jfloat, f.rm].map(number))
    };
    let mut given = [0, 0];
    let mut results = match (element.kind, form) {
        (K::Vforce | K::Vtorque | K::Motion | K::Curve, _) | (_, Form::Friction) => 3,
        (K::Gforce, _) => 6,
        (K::Request, _) => 8,
        _ => 1,
    };
    let found = match element.kind {
        K::Vforce => model.vforces.get(&n).map(vector),
        K::Vtorque => model.vtorques.get(&n).map(vector),
        K::Gforce => (model.gforces.get(&n))
            .map(|f| Structure::General([Some(f.i), f.rm, f.jfloat].map(number))),
        K::Sforce => model.sforces.get(&n).map(|f| {
            let numbers = [number(Some(f.i)), number(Some(f.j)), f.action_only.into()];
            let kind = if f.rotational {
                c"ROTATION"
            } else {
                c"TRANSLATION"
            };
            Structure::Single(numbers, kind)
        }),
        K::Diff => model.differentials.get(&n).map(|d| {
            let ic = d.ic.map(Option::unwrap_or_default);
            Structure::Differential([d.static_hold.into(), d.implicit.into()], ic)
        }),
        K::Motion => model.motions.get(&n).map(motion),
        K::Request => model.requests.get(&n).map(request),
        K::Sensor => model.sensors.get(&n).map(|s| {
            let logic = match s.comparison {
                Comparison::Equal => *b"EQ",
                Comparison::GreaterOrEqual => *b"GE",
                Comparison::LessOrEqual => *b"LE",
            };
            Structure::Sensor([s.value, s.error.unwrap_or(1e-3)], logic)
        }),
        K::Gse => model.general_systems.get(&n).map(|g| {
            let inputs = g.u.and_then(|u| model.arrays.get(&u)).map(|a| &a.kind);
            if let Some(ArrayKind::Inputs(variables)) = inputs {
                given[1] = variables.len();
            }
            given[0] = g.ns;
            results = g.ns + g.no;
            system(g, given[1])
        }),
        K::Coupler => model.couplers.get(&n).map(|c| {
            given[0] = c.joints.len();
            results = Partials(given[0]).count();
            coupler(model, c)
        }),
        K::Curve => model.curves.get(&n).map(|c| {
            given[0] = 2;
            let order = number(c.order);
            let ends = [c.minpar.unwrap_or(-1.0), c.maxpar.unwrap_or(1.0)];
            Structure::Curve([c.closed.into(), order], ends)
        }),
        K::Contact => model.contacts.get(&n).map(|c| {
            given[0] = match form {
                Form::Friction => Slipping::LEN,
                _ => Pressing::LEN,
            };
            contact(c)
        }),
        _ => model
            .variables
            .get(&n)
            .map(|v| Structure::Variable(v.ic.unwrap_or(0.0))),
    };
    Asker {
        id: number(Some(n)),
        structure: found.unwrap_or(Structure::Variable(0.0)),
        given,
        results,
    }
}

/// Describes a CONTACT.
fn contact(c: &cognate::model::Contact) -> Structure {
    let both = [&c.i_geometry, &c.j_geometry];
    let numbers = both.map(|all| all.iter().map(|id| number(Some(*id))).collect());
    let flips = [0, 1].map(|k| vec![c_int::from(c.flip[k]); both[k].len()]);
    Structure::Contact(numbers, flips)
}

/// Describes a GSE.
fn system(g: &cognate::model::GeneralSystem, n_inputs: usize) -> Structure {
    let [ni, no, ns, nd] =
        [n_inputs, g.no, g.ns, g.nd].map(|n| c_int::try_from(n).unwrap_or(c_int::MAX));
    let [u, y, x, ic, xd, icd] = [g.u, g.y, g.x, g.ic, g.xd, g.icd].map(number);
    let hold = g.static_hold.into();
    Structure::System([ni, no, u, y, ns, x, ic, hold, 0, 0, nd, xd, icd])
}

/// Describes a COUPLER.
fn coupler(model: &Model, c: &cognate::model::Coupler) -> Structure {
    let mut joints = [0; 3];
    let mut types = [0; 3];
    for (k, (id, turn)) in c.joints.iter().zip(&c.rotational).take(3).enumerate() {
        let joint = model.joints.get(id);
        let slides = joint.is_some_and(|j| j.kind == JointKind::Translational);
        joints[k] = number(Some(*id));
        types[k] = if turn.unwrap_or(!slides) { b'R' } else { b'T' };
    }
    Structure::Coupler(c.joints.len() as c_int, joints, types)
}

/// Describes a MOTION.
fn motion(m: &cognate::model::Motion) -> Structure {
    let (joint, markers, which) = match m.driven {
        Driven::Joint(joint) => (Some(joint), [0, 0], [0, 0]),
        Driven::JointTranslation(joint) => (Some(joint), [0, 0], *b"T\0"),
        Driven::JointRotation(joint) => (Some(joint), [0, 0], *b"R\0"),
        Driven::Markers { i, j, component } => {
            let names = [*b"X\0", *b"Y\0", *b"Z\0", *b"B1", *b"B2", *b"B3"];
            let which = names.get(component).copied().unwrap_or_default();
            (None, [i, j].map(|id| number(Some(id))), which)
        }
    };
    let is_turn = matches!(m.driven, Driven::JointRotation(_)) || which[0] == b'B';
    Structure::Motion {
        joint: number(joint),
        kind: if is_turn { c"ROTATION" } else { c"TRANSLATION" },
        markers,
        which,
        level: match m.level {
            Level::Displacement => c"DISPLACEMENT",
            Level::Velocity => c"VELOCITY",
            Level::Acceleration => c"ACCELERATION",
        },
    }
}

/// Describes a REQUEST.
fn request(r: &cognate::model::Request) -> Structure {
    let text = |s: &str| CString::new(s.replace('\0', " ")).unwrap_or_default();
    let title = std::array::from_fn(|k| text(r.title.get(k).map_or("", String::as_str)));
    Structure::Request(text(r.comment.as_deref().unwrap_or_default()), title)
}
