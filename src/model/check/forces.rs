//! Forces: what their laws need.

use super::*;

pub(super) fn forces_have_data(model: &Model, out: &mut Out) {
    for (&id, f) in &model.fields {
        if f.stiffness.is_empty() && f.function.is_none() {
            error(
                out,
                "missing_argument",
                (ElementKind::Field.id(id), &f.place),
                "KMATRIX is needed".into(),
            );
        }
    }
    for (&id, b) in &model.beams {
        let who = (ElementKind::Beam.id(id), &b.place);
        if b.length <= 0.0 {
            error(out, "unfit_value", who, "LENGTH must be positive".into());
            at_argument(out, "LENGTH");
        }
        for (name, x) in [
            ("AREA", b.area),
            ("EMODULUS", b.youngs_modulus),
            ("GMODULUS", b.shear_modulus),
        ] {
            if x <= 0.0 {
                warn(out, "unfit_value", who, format!("{name} is not positive"));
                at_argument(out, name);
            }
        }
    }
    for (kind, list) in [
        (ElementKind::Vforce, &model.vforces),
        (ElementKind::Vtorque, &model.vtorques),
        (ElementKind::Gforce, &model.gforces),
    ] {
        for (&id, f) in list {
            let none = f.force.iter().chain(&f.torque).all(Option::is_none);
            if matches!(f.user, Some(Formula::Expression { .. })) {
                error(
                    out,
                    "unfit_value",
                    (kind.id(id), &f.place),
                    "FUNCTION takes USER(…); each component has an expression of its own".into(),
                );
            } else if f.user.is_some() && !none {
                error(
                    out,
                    "contradiction",
                    (kind.id(id), &f.place),
                    "FUNCTION=USER(…) says all components, and some are given".into(),
                );
            }
            if none && f.user.is_none() {
                warn(
                    out,
                    "no_effect",
                    (kind.id(id), &f.place),
                    "no component is given: it does nothing".into(),
                );
            }
        }
    }
    for (&id, f) in &model.frictions {
        let kind = model.joints.get(&f.joint).map(|j| j.kind);
        lengths_of_friction(f, kind, (ElementKind::Friction.id(id), &f.place), out);
        if let Some(kind) = kind.filter(|k| k.row().friction.is_none()) {
            let message = format!(
                "{} is {}: there is no friction law for it",
                model.called(ElementKind::Joint.id(f.joint)),
                kind.keyword()
            );
            error(
                out,
                "wrong_joint",
                (ElementKind::Friction.id(id), &f.place),
                message,
            );
        }
    }
}

/// Notes the radii and arms of friction that are not given, and for which 1 is taken.
fn lengths_of_friction(f: &Friction, kind: Option<JointKind>, who: Who, out: &mut Out) {
    let (pin, friction, bending) = (
        ("PIN_RADIUS", f.pin_radius),
        ("FRICTION_ARM", f.friction_arm),
        ("BENDING_REACTION_ARM", f.bending_reaction_arm),
    );
    let read = match kind {
        Some(JointKind::Revolute) => vec![pin, friction, bending],
        Some(JointKind::Universal | JointKind::Hooke) => vec![pin, friction],
        Some(JointKind::Cylindrical) => vec![pin],
        Some(JointKind::Spherical) => vec![("BALL_RADIUS", f.ball_radius)],
        Some(JointKind::Translational) => vec![("REACTION_ARM", f.reaction_arm)],
        _ => Vec::new(),
    };
    let all = f.inputs.is_empty() || f.inputs.iter().any(|i| i == "ALL");
    let takes = |input: &str| all || f.inputs.iter().any(|i| i == input);
    let reads = |length: &str| match length {
        "BENDING_REACTION_ARM" => takes("BENDING_MOMENT"),
        "REACTION_ARM" => takes("TORSIONAL_MOMENT"),
        _ => true,
    };
    let missing = (read.into_iter()).filter(|(name, x)| x.is_none() && reads(name));
    let missing: Vec<&str> = missing.map(|(name, _)| name).collect();
    if !missing.is_empty() {
        let message = format!("1 is taken for {}, which is not given", missing.join(", "));
        let note = Diagnostic {
            severity: crate::diagnostic::Severity::Note,
            ..Diagnostic::warning("default", message)
        };
        out.push(about(note, who));
    }
}
