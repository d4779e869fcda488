//! Joints, primitives and motions: between two parts, complete, and driving what there is to drive.

use super::*;

/// The two markers of an element with their owner.
pub(super) type Pair<'a> = (&'static str, u32, &'a Place, u32, u32);

pub(super) fn constraint_pairs(model: &Model) -> Vec<Pair<'_>> {
    let joints = model
        .joints
        .iter()
        .map(|(&id, j)| ("JOINT", id, &j.place, j.i, j.j));
    let primitives = model
        .primitives
        .iter()
        .map(|(&id, j)| ("JPRIM", id, &j.place, j.i, j.j));
    let motions = model.motions.iter().filter_map(|(&id, m)| match m.driven {
        Driven::Markers { i, j, .. } => Some(("MOTION", id, &m.place, i, j)),
        _ => None,
    });
    let cams = model
        .points_on_curves
        .iter()
        .map(|(&id, p)| ("PTCV", id, &p.place, p.i, p.rm));
    let rolls = model
        .curves_on_curves
        .iter()
        .map(|(&id, c)| ("CVCV", id, &c.place, c.i.rm, c.j.rm));
    joints
        .chain(primitives)
        .chain(motions)
        .chain(cams)
        .chain(rolls)
        .collect()
}

pub(super) fn spring_pairs(model: &Model) -> Vec<Pair<'_>> {
    let springs = model
        .spring_dampers
        .iter()
        .map(|(&id, f)| ("SPRINGDAMPER", id, &f.place, f.i, f.j));
    let bushings = model
        .bushings
        .iter()
        .map(|(&id, f)| ("BUSHING", id, &f.place, f.i, f.j));
    let fields = model
        .fields
        .iter()
        .map(|(&id, f)| ("FIELD", id, &f.place, f.i, f.j));
    let beams = model
        .beams
        .iter()
        .map(|(&id, f)| ("BEAM", id, &f.place, f.i, f.j));
    springs.chain(bushings).chain(fields).chain(beams).collect()
}

pub(super) fn constraints_join_two_parts(model: &Model, out: &mut Out) {
    let same = |i, j| {
        model
            .body_of(i)
            .is_some_and(|b| model.body_of(j) == Some(b))
    };
    let body = |i| match model.body_of(i) {
        Some((false, n)) => format!("PART/{n}"),
        Some((true, n)) => format!("POINT_MASS/{n}"),
        None => "the same body".into(),
    };
    for (keyword, id, place, i, j) in constraint_pairs(model) {
        if same(i, j) {
            let message = format!(
                "both its markers belong to {}: it constrains nothing",
                body(i)
            );
            error(out, "same_part", (keyword, id, place), message);
        }
    }
    for (keyword, id, place, i, j) in spring_pairs(model) {
        if same(i, j) {
            let message = format!("both its markers belong to {}: it never acts", body(i));
            warn(out, "same_part", (keyword, id, place), message);
        }
    }
}

pub(super) fn joints_are_complete(model: &Model, out: &mut Out) {
    for (&id, j) in &model.joints {
        let who = ("JOINT", id, &j.place);
        match j.kind {
            JointKind::Screw if j.pitch.is_none() => {
                error(
                    out,
                    "missing_argument",
                    who,
                    "a SCREW needs PITCH = translation per turn".into(),
                );
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
            }
            _ => {}
        }
        let turns = matches!(j.kind, JointKind::Revolute | JointKind::Cylindrical);
        let slides = matches!(j.kind, JointKind::Translational | JointKind::Cylindrical);
        if !turns && j.ic_rotation != [None; 2] || !slides && j.ic_translation != [None; 2] {
            let message = format!(
                "{} has no such freedom: its initial condition is not used",
                joint_word(j.kind)
            );
            warn(out, "unused_initial_condition", who, message);
        }
    }
}

pub(super) fn joint_word(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Fixed => "FIXED",
        JointKind::Revolute => "REVOLUTE",
        JointKind::Translational => "TRANSLATIONAL",
        JointKind::Cylindrical => "CYLINDRICAL",
        JointKind::Spherical => "SPHERICAL",
        JointKind::Planar => "PLANAR",
        JointKind::Universal => "UNIVERSAL",
        JointKind::Hooke => "HOOKE",
        JointKind::Convel => "CONVEL",
        JointKind::Rackpin => "RACKPIN",
        JointKind::Screw => "SCREW",
    }
}

pub(super) fn motions_fit_their_joints(model: &Model, out: &mut Out) {
    let mut driven: BTreeMap<(u32, bool), u32> = BTreeMap::new();
    for (&id, m) in &model.motions {
        let who = ("MOTION", id, &m.place);
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
        let word = joint_word(kind);
        let turns = match (kind, rotation) {
            (JointKind::Revolute, None | Some(true)) => true,
            (JointKind::Translational, None | Some(false)) => false,
            (JointKind::Cylindrical, Some(turns)) => turns,
            (JointKind::Cylindrical, None) => {
                let message =
                    format!("JOINT/{joint} is CYLINDRICAL: ROTATION or TRANSLATION is needed");
                error(out, "missing_argument", who, message);
                continue;
            }
            (JointKind::Revolute | JointKind::Translational, Some(turns)) => {
                let what = if turns { "rotation" } else { "translation" };
                error(
                    out,
                    "motion_on_wrong_joint",
                    who,
                    format!("JOINT/{joint} is {word} and has no {what}"),
                );
                continue;
            }
            _ => {
                error(
                    out,
                    "motion_on_wrong_joint",
                    who,
                    format!("JOINT/{joint} is {word}: no motion can drive it"),
                );
                advise(
                    out,
                    "a motion drives a REVOLUTE, TRANSLATIONAL or CYLINDRICAL joint, or one component between two markers (I, J)",
                );
                continue;
            }
        };
        let inactive = |n: u32| model.inactive.contains(&("MOTION".to_owned(), n));
        if let Some(&first) = driven
            .get(&(joint, turns))
            .filter(|&&f| !inactive(f) && !inactive(id))
        {
            error(
                out,
                "driven_twice",
                who,
                format!("MOTION/{first} drives JOINT/{joint} already"),
            );
        }
        driven.entry((joint, turns)).or_insert(id);
    }
}
