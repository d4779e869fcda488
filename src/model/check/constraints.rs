//! Joints, primitives and motions: between two parts, complete, and driving what there is to drive.

use super::*;
use crate::physics::joint::Unclear;

pub(super) fn constraints_join_two_parts(model: &Model, out: &mut Out) {
    for (id, element) in model.elements() {
        let Some([i, j]) = element.ends() else {
            continue;
        };
        let Some(body) = model.body_of(i).filter(|&b| model.body_of(j) == Some(b)) else {
            continue;
        };
        let who = (id, element.place());
        let both = format!("both its markers belong to {}", model.called(body));
        if id.kind.family() == Family::Constraint {
            error(
                out,
                "same_part",
                who,
                format!("{both}: it constrains nothing"),
            );
        } else {
            warn(out, "same_part", who, format!("{both}: it never acts"));
        }
    }
}

pub(super) fn joints_are_complete(model: &Model, out: &mut Out) {
    for (&id, j) in &model.joints {
        let who = (ElementKind::Joint.id(id), &j.place);
        match j.kind {
            JointKind::Screw if j.pitch.is_none() => {
                error(
                    out,
                    "missing_argument",
                    who,
                    "a SCREW needs PITCH = translation per turn".into(),
                );
            }
            JointKind::Screw if j.pitch == Some(0.0) => {
                let message = "the PITCH is zero: it turns without advancing";
                warn(out, "unfit_value", who, message.into());
                at_argument(out, "PITCH");
            }
            JointKind::Rackpin if j.pd.is_none() => {
                error(
                    out,
                    "missing_argument",
                    who,
                    "a RACKPIN needs PD = pitch diameter".into(),
                );
            }
            JointKind::Rackpin if j.pd == Some(0.0) => {
                error(
                    out,
                    "unfit_value",
                    who,
                    "the pitch diameter PD is zero".into(),
                );
                at_argument(out, "PD");
            }
            _ => {}
        }
        let has = j.kind.displacements();
        let (turns, slides) = (has.turns(), has.slides());
        if !turns && j.ic_rotation != [None; 2] || !slides && j.ic_translation != [None; 2] {
            let message = format!(
                "{} has no such freedom: its initial condition is not used",
                j.kind.keyword()
            );
            warn(out, "unused_initial_condition", who, message);
        }
    }
}

pub(super) fn motions_fit_their_joints(model: &Model, out: &mut Out) {
    let mut driven: BTreeMap<(u32, bool), u32> = BTreeMap::new();
    for (&id, m) in &model.motions {
        let who = (ElementKind::Motion.id(id), &m.place);
        let (joint, rotation) = match m.driven {
            Driven::Joint(n) => (n, None),
            Driven::JointRotation(n) => (n, Some(true)),
            Driven::JointTranslation(n) => (n, Some(false)),
            Driven::Markers { component, .. } => {
                // The reader has said so already.
                if component > 5 && m.place.line == 0 {
                    error(
                        out,
                        "missing_argument",
                        who,
                        "one of X, Y, Z, B1, B2, B3 is needed".into(),
                    );
                }
                continue;
            }
        };
        let Some(kind) = model.joints.get(&joint).map(|j| j.kind) else {
            continue;
        };
        let turns = match kind.displacements().chosen(rotation) {
            Ok(turns) => turns,
            Err(why) => {
                let joint = model.called(ElementKind::Joint.id(joint));
                undriven(out, who, (&joint, kind), why);
                continue;
            }
        };
        let on = |n: u32| model.is_active(ElementKind::Motion.id(n));
        if let Some(&first) = driven.get(&(joint, turns)).filter(|&&f| on(f) && on(id)) {
            error(
                out,
                "driven_twice",
                who,
                format!(
                    "{} drives {} already",
                    model.called(ElementKind::Motion.id(first)),
                    model.called(ElementKind::Joint.id(joint))
                ),
            );
        }
        driven.entry((joint, turns)).or_insert(id);
    }
}

/// Tells why a motion cannot drive a joint.
fn undriven(out: &mut Out, who: Who, (joint, kind): (&str, JointKind), why: Unclear) {
    let is = format!("{joint} is {}", kind.keyword());
    match why {
        Unclear::Several => {
            let message = format!("{is}: ROTATION or TRANSLATION is needed");
            error(out, "missing_argument", who, message);
        }
        Unclear::Other { turns } => {
            let what = if turns { "rotation" } else { "translation" };
            error(
                out,
                "motion_on_wrong_joint",
                who,
                format!("{is} and has no {what}"),
            );
        }
        Unclear::None => {
            let message = format!("{is}: no motion can drive it");
            error(out, "motion_on_wrong_joint", who, message);
            advise(
                out,
                "a motion drives a REVOLUTE, TRANSLATIONAL or CYLINDRICAL joint, or one component between two markers (I, J)",
            );
        }
    }
}

/// Tells once of initial conditions that are read in the order of Adams View.
pub(super) fn initial_conditions_say_what_is_first(model: &Model, out: &mut Out) {
    let pairs = |j: &Joint| {
        let both = |pair: [Option<f64>; 2]| pair.iter().all(|x| x.is_some_and(|x| x != 0.0));
        [j.ic_translation, j.ic_rotation]
            .into_iter()
            .find(|&pair| both(pair))
    };
    let by_order = |j: &Joint| j.place.name.is_some() && !j.has_named_ic;
    let named = model.joints.iter().filter(|(_, j)| by_order(j));
    let mut found = named.filter_map(|(&id, j)| Some((id, j, pairs(j)?)));
    if let Some((id, joint, [Some(displacement), Some(velocity)])) = found.next() {
        let message = format!(
            "its initial condition {velocity}, {displacement} is read as velocity {velocity} and \
             displacement {displacement}, as Adams View writes it"
        );
        let who = (ElementKind::Joint.id(id), &joint.place);
        warn(out, "initial_condition", who, message);
        advise(
            out,
            "it carries View's name; without adams_view_name the displacement is first",
        );
    }
}
