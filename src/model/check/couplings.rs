//! Couplers and gears: sums of displacements that their joints have, on a carrier that they share.

use super::*;
use crate::physics::joint::{Displacements, Unclear};

pub(super) fn couplers_fit_their_joints(model: &Model, out: &mut Out) {
    for (&id, c) in &model.couplers {
        let who = (ElementKind::Coupler.id(id), &c.place);
        for (k, joint) in c.joints.iter().enumerate() {
            if c.joints[..k].contains(joint) {
                error(
                    out,
                    "contradiction",
                    who,
                    format!(
                        "{} stands twice in JOINTS",
                        model.called(ElementKind::Joint.id(*joint))
                    ),
                );
                at_argument(out, "JOINTS");
            }
            let Some(kind) = model.joints.get(joint).map(|j| j.kind) else {
                continue;
            };
            let said = c.rotational.get(k).copied().flatten();
            if let Err(why) = kind.displacements().chosen(said) {
                let joint = model.called(ElementKind::Joint.id(*joint));
                uncoupled(out, who, (&joint, kind), why);
            }
        }
        if c.user.is_none() && !c.scales.is_empty() && c.scales.iter().all(|&s| s == 0.0) {
            error(out, "unfit_value", who, "all SCALES are zero".into());
            at_argument(out, "SCALES");
        } else if let ([one], true) = (scaled(c).as_slice(), c.user.is_none()) {
            let message = format!(
                "SCALES couples nothing to {0}, the only joint whose scale is not zero: it locks {0}",
                model.called(ElementKind::Joint.id(*one))
            );
            warn(out, "unfit_value", who, message);
            at_argument(out, "SCALES");
        }
    }
}

/// Returns the joints of a coupler whose scales are not zero; none where there are no scales.
fn scaled(coupler: &Coupler) -> Vec<u32> {
    let joints = coupler.joints.iter().zip(&coupler.scales);
    joints
        .filter(|(_, s)| **s != 0.0)
        .map(|(&j, _)| j)
        .collect()
}

/// Tells why a displacement of a joint cannot be coupled.
fn uncoupled(out: &mut Out, who: Who, (joint, kind): (&str, JointKind), why: Unclear) {
    let word = kind.keyword();
    let (code, message) = match why {
        Unclear::Several => (
            "missing_argument",
            format!("{joint} is {word}: TYPE must say R or T"),
        ),
        Unclear::Other { turns } => {
            let said = if turns { "R" } else { "T" };
            let message = format!("TYPE says {said} for {joint}, which is {word}");
            ("contradiction", message)
        }
        Unclear::None => (
            "wrong_joint",
            format!("{joint} is {word}: it cannot be coupled"),
        ),
    };
    error(out, code, who, message);
}

pub(super) fn gears_share_a_carrier(model: &Model, out: &mut Out) {
    for (&id, g) in &model.gears {
        let who = (ElementKind::Gear.id(id), &g.place);
        if g.joints[0] == g.joints[1] {
            error(
                out,
                "contradiction",
                who,
                format!(
                    "{} stands twice in JOINTS",
                    model.called(ElementKind::Joint.id(g.joints[0]))
                ),
            );
        }
        let carrier = model.body_of(g.cv);
        for n in g.joints {
            let Some(joint) = model.joints.get(&n) else {
                continue;
            };
            let id = model.called(ElementKind::Joint.id(n));
            if joint.kind.displacements() == Displacements::None {
                let message = format!("{id} is {}: it cannot be geared", joint.kind.keyword());
                error(out, "wrong_joint", who, message);
            }
            let of_j = model.body_of(joint.j);
            if carrier.is_some() && of_j.is_some() && carrier != of_j {
                let message = format!(
                    "the J marker of {id} and the CV marker, {}, belong to different parts",
                    model.called(ElementKind::Marker.id(g.cv))
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
