//! Angles are radians: numbers without the suffix D that read as degrees, in orientations, initial
//! angles, free angles of springs and motions that turn. One warning for each statement, with the
//! number and what it means.

use super::*;
use crate::expr::lint::{degrees_in_angle, degrees_in_speed, reads_as_degrees};

const CODE: &str = "degrees_or_radians";

pub(super) fn angles_are_radians(model: &Model, out: &mut Out) {
    for (&id, m) in &model.markers {
        orientation(out, (ElementKind::Marker.id(id), &m.place), &m.orientation);
    }
    for (&id, p) in &model.parts {
        orientation(out, (ElementKind::Part.id(id), &p.place), &p.orientation);
    }
    for (&id, p) in &model.point_masses {
        orientation(
            out,
            (ElementKind::PointMass.id(id), &p.place),
            &p.orientation,
        );
    }
    for (&id, j) in &model.joints {
        number(
            out,
            (ElementKind::Joint.id(id), &j.place),
            "IC",
            j.ic_rotation[0],
        );
    }
    for (&id, s) in model.spring_dampers.iter().filter(|(_, s)| s.rotational) {
        number(
            out,
            (ElementKind::SpringDamper.id(id), &s.place),
            "ANGLE",
            Some(s.free),
        );
    }
    for (&id, m) in model.motions.iter().filter(|(_, m)| turns(model, m)) {
        let who = (ElementKind::Motion.id(id), &m.place);
        number(out, who, "ICDISPLACEMENT", m.ic_displacement);
        drive(out, who, m);
    }
}

fn orientation(out: &mut Out, who: Who, orientation: &Orientation) {
    let Orientation::Euler(angles) = orientation else {
        return;
    };
    let doubted = angles
        .iter()
        .copied()
        .find(|&a| reads_as_degrees(a).is_some());
    number(out, who, "REULER", doubted);
}

fn number(out: &mut Out, who: Who, argument: &'static str, angle: Option<f64>) {
    let Some((angle, what)) = angle.and_then(|a| Some((a, reads_as_degrees(a)?))) else {
        return;
    };
    warn(out, CODE, who, format!("{argument}: {what}"));
    at_argument(out, argument);
    advise(
        out,
        format!("the suffix D makes degrees of a literal: {angle}D"),
    );
}

/// Returns true if a motion prescribes an angle.
pub(crate) fn turns(model: &Model, motion: &Motion) -> bool {
    match motion.driven {
        Driven::JointRotation(_) => true,
        Driven::JointTranslation(_) => false,
        Driven::Joint(id) => {
            (model.joints.get(&id)).is_some_and(|j| matches!(j.kind, JointKind::Revolute))
        }
        Driven::Markers { component, .. } => (3..6).contains(&component),
    }
}

/// The FUNCTION of a motion that turns.
fn drive(out: &mut Out, who: Who, motion: &Motion) {
    let Formula::Expression { text, .. } = &motion.function else {
        return;
    };
    let Ok(ast) = text.ast() else {
        return; // another rule says so
    };
    let doubts = match motion.level {
        Level::Displacement => degrees_in_angle(ast, text),
        Level::Velocity => degrees_in_speed(ast, text),
        Level::Acceleration => Vec::new(),
    };
    for d in doubts {
        let at = d.span.map_or(0, |s| s.start);
        warn(out, CODE, who, format!("FUNCTION: {}", d.message));
        d.help.into_iter().for_each(|advice| advise(out, advice));
        if let (Some(said), Some(place)) = (out.last_mut(), motion.function.file_place(at)) {
            (said.line, said.column) = place;
        }
    }
}
