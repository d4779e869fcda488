//! Arguments of former releases that are read, kept, and do nothing.

use super::*;
use crate::diagnostic::Cause;

pub(super) fn joints_have_no_old_friction(model: &Model, out: &mut Out) {
    for (&id, joint) in &model.joints {
        let old = |name: &str| name.starts_with("MU_") || name.starts_with("MAX_FRIC");
        let given: Vec<String> = (joint.place.extra.iter())
            .filter(|(name, _)| old(name))
            .map(|(name, value)| format!("{name} = {value}"))
            .collect();
        if given.is_empty() {
            continue;
        }
        let who = (ElementKind::Joint.id(id), &joint.place);
        let message = format!(
            "{}: friction given with a joint is not computed",
            given.join(", ")
        );
        warn(out, Cause::Superseded.code(), who, message);
        advise(
            out,
            format!("FRICTION/…, JOINT={id}, MU_STATIC=…, MU_DYNAMIC=… is computed"),
        );
    }
}
