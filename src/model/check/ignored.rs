//! Arguments that the kind of their element does not read: a PITCH of a hinge, a stiffness of a
//! contact by restitution.

use super::*;
use crate::physics::joint::JointKind as Kind;

/// An argument that may be given, and whether it is.
type Given = (&'static str, bool);

/// Warns of arguments that are given although `why` they are not read.
fn not_read(out: &mut Out, who: Who, given: &[Given], why: &str) {
    let all: Vec<&str> = given.iter().filter(|g| g.1).map(|g| g.0).collect();
    if !all.is_empty() {
        let verb = if all.len() == 1 { "is" } else { "are" };
        let message = format!("{} {verb} not read: {why}", all.join(", "));
        warn(out, "ignored", who, message);
    }
}

pub(super) fn arguments_are_read(model: &Model, out: &mut Out) {
    joints(model, out);
    motions(model, out);
    contacts(model, out);
    frictions(model, out);
    damping(model, out);
    data(model, out);
    grounds(model, out);
    integrator(model, out);
}

/// The methods have orders and damping of their own.
fn integrator(model: &Model, out: &mut Out) {
    let mut note = |message: String| {
        let note = Diagnostic {
            severity: crate::diagnostic::Severity::Note,
            ..Diagnostic::warning("ignored", message)
        };
        out.push(note.element("INTEGRATOR"));
    };
    let asked = &model.integrator;
    if let Some(kmax) = asked.kmax {
        note(format!(
            "KMAX = {kmax} changes nothing: the methods have a fixed order"
        ));
    }
    if let Some(method @ ("HHT" | "NEWMARK")) = asked.method.as_deref() {
        note(format!(
            "{method} is done by RADAU5, of order 5 instead of 2: it damps what is too fast to follow, and takes no energy from the rest"
        ));
    }
}

fn joints(model: &Model, out: &mut Out) {
    for (&id, j) in &model.joints {
        let who = (ElementKind::Joint.id(id), &j.place);
        let given = [
            ("PITCH", j.pitch.is_some() && j.kind != Kind::Screw),
            ("PD", j.pd.is_some() && j.kind != Kind::Rackpin),
        ];
        not_read(out, who, &given, "PITCH is for SCREW, PD for RACKPIN");
    }
}

/// ICDISP and ICVEL begin what is prescribed by its rates.
fn motions(model: &Model, out: &mut Out) {
    for (&id, m) in &model.motions {
        let who = (ElementKind::Motion.id(id), &m.place);
        let [disp, vel] = [m.ic_displacement.is_some(), m.ic_velocity.is_some()];
        match m.level {
            Level::Displacement => {
                let given = [("ICDISP", disp), ("ICVEL", vel)];
                not_read(out, who, &given, "FUNCTION says the displacement itself");
            }
            Level::Velocity => {
                not_read(out, who, &[("ICVEL", vel)], "FUNCTION says the velocity");
            }
            Level::Acceleration => {}
        }
    }
}

/// Each law of contact has arguments of its own, and friction has.
fn contacts(model: &Model, out: &mut Out) {
    for (&id, c) in &model.contacts {
        let who = || (ElementKind::Contact.id(id), &c.place);
        let impact = [
            ("STIFFNESS", c.stiffness != 0.0),
            ("DAMPING", c.damping != 0.0),
            ("DMAX", c.dmax != 0.0),
            ("EXPONENT", c.exponent != 0.0),
        ];
        let poisson = [
            ("PENALTY", c.penalty != 0.0),
            ("RESTITUTION_COEFFICIENT", c.restitution != 0.0),
        ];
        match c.law {
            ContactLaw::Impact => not_read(out, who(), &poisson, "they are for POISSON"),
            ContactLaw::Poisson => not_read(out, who(), &impact, "they are for IMPACT"),
            ContactLaw::User => {}
        }
        if c.friction == CoulombFriction::Off && c.friction_function.is_none() {
            let friction = [
                ("MU_STATIC", c.mu_static != 0.0),
                ("MU_DYNAMIC", c.mu_dynamic != 0.0),
                (
                    "STICTION_TRANSITION_VELOCITY",
                    c.stiction_transition_velocity != 0.0,
                ),
                (
                    "FRICTION_TRANSITION_VELOCITY",
                    c.friction_transition_velocity != 0.0,
                ),
            ];
            not_read(out, who(), &friction, "COULOMB_FRICTION is not ON");
        }
    }
}

/// FRICTION has arguments for each kind of joint.
fn frictions(model: &Model, out: &mut Out) {
    for (&id, f) in &model.frictions {
        let Some(kind) = model.joints.get(&f.joint).map(|j| j.kind) else {
            continue;
        };
        let slides = kind == Kind::Translational;
        let ball = kind == Kind::Spherical;
        let both = kind == Kind::Cylindrical;
        let pin = kind == Kind::Revolute;
        let pins = matches!(kind, Kind::Universal | Kind::Hooke);
        let given = [
            ("PIN_RADIUS", f.pin_radius.is_some(), pin || pins || both),
            ("BALL_RADIUS", f.ball_radius.is_some(), ball),
            ("FRICTION_ARM", f.friction_arm.is_some(), pin || pins),
            (
                "BENDING_REACTION_ARM",
                f.bending_reaction_arm.is_some(),
                pin,
            ),
            ("REACTION_ARM", f.reaction_arm.is_some(), slides),
            (
                "INITIAL_OVERLAP",
                f.initial_overlap.is_some(),
                slides || both,
            ),
            ("OVERLAP_DELTA", f.overlap_delta.is_some(), slides || both),
            (
                "FRICTION_FORCE_PRELOAD",
                f.force_preload.is_some(),
                slides || both,
            ),
            (
                "FRICTION_TORQUE_PRELOAD",
                f.torque_preload.is_some(),
                !slides,
            ),
        ];
        let given = given.map(|(name, given, read)| (name, given && !read));
        let joint = model.called(ElementKind::Joint.id(f.joint));
        let why = format!("{joint} is {}", kind.keyword());
        not_read(out, (ElementKind::Friction.id(id), &f.place), &given, &why);
    }
}

/// CMATRIX says the damping that CRATIO would make of the stiffness.
fn damping(model: &Model, out: &mut Out) {
    let mut twice = |who: Who, ratio: Option<f64>, matrix: bool| {
        let given = [("CRATIO", ratio.is_some() && matrix)];
        not_read(out, who, &given, "CMATRIX says the damping");
    };
    for (&id, f) in &model.fields {
        let who = (ElementKind::Field.id(id), &f.place);
        twice(who, f.damping_ratio, !f.damping.is_empty());
    }
    for (&id, b) in &model.beams {
        let who = (ElementKind::Beam.id(id), &b.place);
        twice(who, b.damping_ratio, !b.damping.is_empty());
    }
    for (&id, f) in &model.nodal_forces {
        let who = (ElementKind::Nforce.id(id), &f.place);
        twice(who, f.damping_ratio, f.damping.is_some());
    }
}

/// Ground does not move.
fn grounds(model: &Model, out: &mut Out) {
    for (&id, part) in model.parts.iter().filter(|(_, p)| p.ground) {
        let [vx, vy, vz] = part.velocity.map(|v| v.is_some_and(|v| v != 0.0));
        let [wx, wy, wz] = part.angular_velocity.map(|w| w.is_some_and(|w| w != 0.0));
        let given = [
            ("VX", vx),
            ("VY", vy),
            ("VZ", vz),
            ("WX", wx),
            ("WY", wy),
            ("WZ", wz),
        ];
        let who = (ElementKind::Part.id(id), &part.place);
        not_read(out, who, &given, "ground does not move");
    }
}

/// Numbers stand in the dataset or in a file, a curve's parameter where a routine computes it.
fn data(model: &Model, out: &mut Out) {
    for (&id, s) in &model.splines {
        let given = [("FILE", s.file.is_some() && !s.x.is_empty())];
        let who = (ElementKind::Spline.id(id), &s.place);
        not_read(out, who, &given, "X and Y are given");
    }
    for (&id, m) in &model.matrices {
        let given = [("FILE", m.file.is_some() && !m.values.is_empty())];
        let who = (ElementKind::Matrix.id(id), &m.place);
        not_read(out, who, &given, "VALUES is given");
    }
    for (&id, c) in &model.curves {
        let by_points = c.matrix.is_some();
        let given = [
            ("MINPAR", c.minpar.is_some() && by_points),
            ("MAXPAR", c.maxpar.is_some() && by_points),
        ];
        let who = (ElementKind::Curve.id(id), &c.place);
        not_read(
            out,
            who,
            &given,
            "the curve goes through the points of a MATRIX",
        );
    }
}
