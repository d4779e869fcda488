//! Constraints: initial conditions of joints, what a motion drives, types of a coupler.

use super::*;
use crate::diagnostic::counted;

/// Returns displacement and velocity in the order of a statement, and back: a statement that Adams
/// View wrote carries the name it has there, and has the velocity first.
fn in_order(joint: &Joint, mut pair: [Option<f64>; 2]) -> [Option<f64>; 2] {
    if joint.place.name.is_some() && pair.iter().all(Option::is_some) {
        pair.reverse();
    }
    pair
}

/// ICTRAN: displacement and velocity along z.
pub fn put_ic_translation(joint: &mut Joint, value: Value) -> Done {
    joint.ic_translation.put(value)?;
    joint.ic_translation = in_order(joint, joint.ic_translation);
    Ok(())
}

/// See [`put_ic_translation`].
pub fn ic_translation(joint: &Joint) -> Option<Value> {
    in_order(joint, joint.ic_translation).written()
}

/// ICROT: angle and rate about z.
pub fn put_ic_rotation(joint: &mut Joint, value: Value) -> Done {
    joint.ic_rotation.put(value)?;
    joint.ic_rotation = in_order(joint, joint.ic_rotation);
    Ok(())
}

/// See [`put_ic_rotation`].
pub fn ic_rotation(joint: &Joint) -> Option<Value> {
    <Angle as Lens<_>>::get(&in_order(joint, joint.ic_rotation))
}

/// IC means the angle of a REVOLUTE, the distance of all others.
pub fn put_joint_ic(joint: &mut Joint, value: Value) -> Done {
    match joint.kind.displacements() {
        Displacements::Rotation => put_ic_rotation(joint, value),
        Displacements::Translation | Displacements::Both | Displacements::None => {
            put_ic_translation(joint, value)
        }
    }
}

/// See [`put_joint_ic`].
pub fn joint_ic(joint: &Joint) -> Option<Value> {
    match joint.kind.displacements() {
        Displacements::Rotation => ic_rotation(joint),
        Displacements::Translation => ic_translation(joint),
        Displacements::Both | Displacements::None => None,
    }
}

/// The marker component has not been said yet.
const UNSAID: usize = usize::MAX;

/// JOINT= of a MOTION.
pub fn put_motion_joint(motion: &mut Motion, value: Value) -> Done {
    if let Driven::Markers { component, .. } = motion.driven {
        let word = ["X", "Y", "Z", "B1", "B2", "B3"]
            .get(component)
            .unwrap_or(&"I");
        return Err(format!("{word} goes with I and J, not with JOINT"));
    }
    id(value, |n| {
        motion.driven = match motion.driven {
            Driven::JointTranslation(_) => Driven::JointTranslation(n),
            Driven::JointRotation(_) => Driven::JointRotation(n),
            _ => Driven::Joint(n),
        }
    })
}

/// See [`put_motion_joint`].
pub fn motion_joint(motion: &Motion) -> Option<Value> {
    match motion.driven {
        Driven::Joint(n) | Driven::JointTranslation(n) | Driven::JointRotation(n) => n.written(),
        Driven::Markers { .. } => None,
    }
}

/// TRANSLATIONAL or ROTATIONAL: which freedom of the joint.
pub fn motion_along(motion: &mut Motion, rotation: bool) {
    let joint = match motion.driven {
        Driven::Joint(n) | Driven::JointTranslation(n) | Driven::JointRotation(n) => n,
        Driven::Markers { .. } => 0,
    };
    motion.driven = match rotation {
        true => Driven::JointRotation(joint),
        false => Driven::JointTranslation(joint),
    };
}

/// I= (or J=) of a MOTION.
pub fn put_motion_marker(motion: &mut Motion, value: Value, second: bool) -> Done {
    let (mut i, mut j, component) = match motion.driven {
        Driven::Markers { i, j, component } => (i, j, component),
        Driven::Joint(0) => (0, 0, UNSAID),
        Driven::JointTranslation(_) | Driven::JointRotation(_) => {
            return Err("TRANSLATIONAL and ROTATIONAL go with JOINT; I and J take one of X, Y, Z, B1, B2, B3".into());
        }
        Driven::Joint(_) => return Err("JOINT and I, J exclude each other".into()),
    };
    id(value, |n| if second { j = n } else { i = n })?;
    motion.driven = Driven::Markers { i, j, component };
    Ok(())
}

/// See [`put_motion_marker`].
pub fn motion_marker(motion: &Motion, second: bool) -> Option<Value> {
    match motion.driven {
        Driven::Markers { i, j, .. } => if second { j } else { i }.written(),
        _ => None,
    }
}

/// X, Y, Z, B1, B2, B3.
pub fn put_component(motion: &mut Motion, component: usize) -> Done {
    let (i, j) = match motion.driven {
        Driven::Markers { i, j, .. } => (i, j),
        _ => (0, 0),
    };
    motion.driven = Driven::Markers { i, j, component };
    Ok(())
}

/// See [`put_component`].
pub fn component(motion: &Motion, component: usize) -> Option<Value> {
    matches!(motion.driven, Driven::Markers { component: c, .. } if c == component)
        .then_some(Value::Flag)
}

/// A MOTION drives a joint, or one component between two markers.
pub fn motion_form(motion: &mut Motion) -> Done {
    match motion.driven {
        Driven::Joint(0) => {
            Err("a MOTION needs JOINT, or I and J with one of X, Y, Z, B1, B2, B3".into())
        }
        Driven::JointRotation(0) | Driven::JointTranslation(0) => {
            Err("TRANSLATIONAL and ROTATIONAL need JOINT".into())
        }
        Driven::Markers {
            component: UNSAID, ..
        } => Err("a MOTION between markers needs one of X, Y, Z, B1, B2, B3".into()),
        Driven::Markers { i, j, .. } if i == 0 || j == 0 => {
            Err("a MOTION between markers needs both I and J".into())
        }
        _ => Ok(()),
    }
}

/// TYPE=T:R.
pub struct CouplerTypes;

impl Lens<Vec<Option<bool>>> for CouplerTypes {
    const KIND: Kind = Kind::Words(&["T", "R"]);
    fn put(field: &mut Vec<Option<bool>>, value: Value) -> Done {
        let Value::Words(words) = value else {
            return Err(MISFIT.into());
        };
        *field = words.iter().map(|w| Some(w == "R")).collect();
        Ok(())
    }
    fn get(field: &Vec<Option<bool>>) -> Option<Value> {
        let letter = |r: &Option<bool>| r.map(|r| if r { "R" } else { "T" }.to_owned());
        let letters: Option<Vec<String>> = field.iter().map(letter).collect();
        letters.and_then(|l| words(&l))
    }
}

/// Two or three joints, as many types; scales may leave out the first, which then is 1.
pub fn coupler_form(coupler: &mut Coupler) -> Done {
    let n = coupler.joints.len();
    if !(2..=3).contains(&n) {
        return Err(format!("a COUPLER joins two or three joints, not {n}"));
    }
    if coupler.rotational.is_empty() {
        coupler.rotational = vec![None; n];
    }
    if coupler.rotational.len() != n {
        return Err(format!(
            "TYPE names {} for {}",
            counted(coupler.rotational.len(), "kind"),
            counted(n, "joint")
        ));
    }
    if coupler.scales.len() + 1 == n {
        coupler.scales.insert(0, 1.0);
    }
    if coupler.scales.len() != n && coupler.user.is_none() {
        return Err(match coupler.scales.len() {
            0 => "a COUPLER needs SCALES".to_owned(),
            s => format!(
                "SCALES holds {} for {}",
                counted(s, "number"),
                counted(n, "joint")
            ),
        });
    }
    Ok(())
}
