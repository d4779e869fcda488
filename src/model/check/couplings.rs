//! Couplers and gears: sums of displacements that their joints have, on a carrier that they share.

use super::*;

pub(super) fn couplers_fit_their_joints(model: &Model, out: &mut Out) {
    for (&id, c) in &model.couplers {
        let who = (ElementKind::Coupler.id(id), &c.place);
        for (k, joint) in c.joints.iter().enumerate() {
            if c.joints[..k].contains(joint) {
                error(
                    out,
                    "contradiction",
                    who,
                    format!("JOINT/{joint} stands twice in JOINTS"),
                );
            }
            let Some(kind) = model.joints.get(joint).map(|j| j.kind) else {
                continue;
            };
            let word = kind.keyword();
            match (kind, c.rotational.get(k).copied().flatten()) {
                (JointKind::Revolute, Some(false)) => {
                    error(
                        out,
                        "contradiction",
                        who,
                        format!("TYPE says T for JOINT/{joint}, which is REVOLUTE"),
                    );
                }
                (JointKind::Translational, Some(true)) => {
                    error(
                        out,
                        "contradiction",
                        who,
                        format!("TYPE says R for JOINT/{joint}, which is TRANSLATIONAL"),
                    );
                }
                (JointKind::Cylindrical, None) => {
                    error(
                        out,
                        "missing_argument",
                        who,
                        format!("JOINT/{joint} is CYLINDRICAL: TYPE must say R or T"),
                    );
                }
                (JointKind::Revolute | JointKind::Translational | JointKind::Cylindrical, _) => {}
                _ => error(
                    out,
                    "wrong_joint",
                    who,
                    format!("JOINT/{joint} is {word}: it cannot be coupled"),
                ),
            }
        }
        if c.user.is_none() && !c.scales.is_empty() && c.scales.iter().all(|&s| s == 0.0) {
            error(out, "unfit_value", who, "all SCALES are zero".into());
        }
    }
}

pub(super) fn gears_share_a_carrier(model: &Model, out: &mut Out) {
    for (&id, g) in &model.gears {
        let who = (ElementKind::Gear.id(id), &g.place);
        if g.joints[0] == g.joints[1] {
            error(
                out,
                "contradiction",
                who,
                format!("JOINT/{} stands twice in JOINTS", g.joints[0]),
            );
        }
        let carrier = model.body_of(g.cv);
        for n in g.joints {
            let Some(joint) = model.joints.get(&n) else {
                continue;
            };
            let geared = matches!(
                joint.kind,
                JointKind::Revolute | JointKind::Translational | JointKind::Cylindrical
            );
            if !geared {
                let message = format!("JOINT/{n} is {}: it cannot be geared", joint.kind.keyword());
                error(out, "wrong_joint", who, message);
            }
            let of_j = model.body_of(joint.j);
            if carrier.is_some() && of_j.is_some() && carrier != of_j {
                let message = format!(
                    "the J marker of JOINT/{n} and the CV marker {} belong to different parts",
                    g.cv
                );
                error(out, "no_common_carrier", who, message);
                advise(
                    out,
                    "the J markers of both joints and CV must belong to the part that carries the gears",
                );
            }
        }
    }
}
