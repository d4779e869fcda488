//! Comment lines that make elements: joints, markers and spring-dampers on instances of an
//! assembly, at a place of ground, with aligned markers; and curves of several pieces.
//!
//! ```text
//! ! cognate: JOINT/4 hinge = REVOLUTE, base, arm, AT=0,0,0, AXIS=0,0,1
//! ! cognate: MARKER tip = arm, AT=0.3,0,0
//! ! cognate: SPRINGDAMPER/1 return = base, arm, AT=0,0,0, AXIS=0,0,1, ROTATION, KT=2/D, ANGLE=30D
//! ! cognate: CURVE/9 cam = MATRIX/1, MATRIX/2, CURVE/3
//! ```
//!
//! Places and directions are in ground, as the parts are drawn. J is on the first instance, I on
//! the second. An instance that is not yet a rigid body becomes one. The elements are like others:
//! a written dataset has them as statements.

use super::line::Line;
use super::{RigidBody, USAGE, bad, chain, euler, instance, next};
use crate::dataset::syntax::Source;
use crate::diagnostic::{Diagnostic, Span};
use crate::model::geometry::orientation;
use crate::model::{
    ElementKind, Joint, JointKind, Marker, MarkerOwner, Model, Place, SpringDamper,
};
use crate::space::{Mat3, Vec3, rotation};

/// A kind of element that a line can make.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Made {
    Joint,
    Marker,
    Spring,
    Curve,
}

impl Made {
    const ALL: [Made; 4] = [Made::Joint, Made::Marker, Made::Spring, Made::Curve];

    /// Reads a first word such as `JOINT/4`: the kind of element, and the number that it asks for.
    pub fn of(word: &str) -> Option<(Made, Option<&str>)> {
        let (keyword, number) = match word.split_once('/') {
            Some((keyword, number)) => (keyword, Some(number)),
            None => (word, None),
        };
        let kind: ElementKind = keyword.parse().ok()?;
        let made = Made::ALL.into_iter().find(|made| made.kind() == kind);
        made.map(|made| (made, number))
    }

    fn kind(self) -> ElementKind {
        match self {
            Made::Joint => ElementKind::Joint,
            Made::Marker => ElementKind::Marker,
            Made::Spring => ElementKind::SpringDamper,
            Made::Curve => ElementKind::Curve,
        }
    }

    /// Returns the arguments of such a line.
    fn keys(self) -> &'static [&'static str] {
        match self {
            Made::Joint | Made::Marker => &["AT", "AXIS", "X_AXIS"],
            Made::Spring => &[
                "AT", "TO", "AXIS", "X_AXIS", "K", "C", "FORCE", "LENGTH", "KT", "CT", "TORQUE",
                "ANGLE",
            ],
            Made::Curve => &[],
        }
    }
}

/// Makes what a line says.
///
/// # Errors
/// When the line is not understood, or its instances do not exist or cannot be rigid.
pub(super) fn make(
    (source, rest): (&Source, Span),
    (made, number): (Made, Option<&str>),
    model: &mut Model,
    bodies: &mut Vec<RigidBody>,
    out: &mut Vec<Diagnostic>,
) -> Result<(), Diagnostic> {
    let id = match number.map(str::parse) {
        None => None,
        Some(Ok(id)) if id > 0 => Some(id),
        Some(_) => {
            return Err(source.locate(bad("a number from 1 on is expected").help(USAGE), rest));
        }
    };
    let line = Line::read(source, rest, made.keys())?;
    let kind = made.kind();
    if let Some(id) = id.map(|n| kind.id(n)).filter(|&id| model.has(id)) {
        let d = Diagnostic::error("defined_twice", format!("{id} is there already"));
        return Err(line.at(d, line.span));
    }
    let id = id.unwrap_or_else(|| next(model.numbers(kind).last()));
    match made {
        Made::Joint => joint(&line, id, model, bodies),
        Made::Marker => marker(&line, id, model, bodies),
        Made::Spring => spring(&line, id, model, bodies),
        Made::Curve => chain::make(&line, id, model, out),
    }
}

/// A frame in ground: place and axes.
#[derive(Clone, Copy)]
struct At {
    position: Vec3<f64>,
    rotation: Mat3<f64>,
}

impl At {
    /// Reads AT, AXIS and X_AXIS, which are the origin and the axes of ground where they are not
    /// given.
    fn read(line: &Line<'_>) -> Result<At, Diagnostic> {
        let z = line.vector("AXIS")?.unwrap_or(Vec3::axis(2));
        let usual = || {
            let along = |k: usize| z.cross(Vec3::axis(k)).norm() <= 1e-9 * z.norm();
            Vec3::axis(usize::from(along(0)))
        };
        let x = line.vector("X_AXIS")?.unwrap_or_else(usual);
        let rotation = rotation::from_z_and_x(z, x).ok_or_else(|| {
            let d = bad("AXIS and X_AXIS are two directions that are not parallel");
            line.at(d, line.span)
        })?;
        Ok(At {
            position: line.vector("AT")?.unwrap_or(Vec3::zero()),
            rotation: rotation::snapped(&rotation),
        })
    }
}

/// Adds a marker to the parts of an instance.
fn add(
    model: &mut Model,
    id: u32,
    name: String,
    (parts, at): (&[u32], At),
) -> Result<u32, Diagnostic> {
    let part = instance::carrier(model, parts).and_then(|n| Some((n, model.parts.get(&n)?)));
    let (n, part) = part.ok_or_else(|| bad("an instance has no parts"))?;
    let own = orientation(&part.orientation, part.qg).map_err(bad)?;
    // markers of ground are in ground
    let (position, turned) = match part.ground {
        true => (at.position, at.rotation),
        false => (
            own.apply_transposed(at.position - Vec3(part.qg)),
            own.transpose() * at.rotation,
        ),
    };
    let marker = Marker {
        place: named(name),
        owner: MarkerOwner::Part(n),
        qp: position.0,
        orientation: euler(turned),
        floating: false,
    };
    model.markers.insert(id, marker);
    Ok(id)
}

fn named(name: String) -> Place {
    Place {
        name: Some(name),
        ..Place::default()
    }
}

/// Makes two markers on the two instances that words name: J on the first, I on the second.
fn pair(
    line: &Line<'_>,
    words: &[(String, Span)],
    model: &mut Model,
    bodies: &mut Vec<RigidBody>,
    [at_i, at_j]: [At; 2],
) -> Result<[u32; 2], Diagnostic> {
    let [(first, first_at), (second, second_at)] = words else {
        let d = bad(format!("{} is between two instances", line.name)).help(USAGE);
        return Err(line.at(d, line.span));
    };
    let mut rigid = |name: &str, at: Span| {
        instance::rigidify(model, name, at, bodies).map_err(|d| line.at(d, at))
    };
    let (on_j, on_i) = (rigid(first, *first_at)?, rigid(second, *second_at)?);
    if on_i.iter().any(|part| on_j.contains(part)) {
        let d = bad(format!("both ends of {} are on {second}", line.name));
        return Err(line.at(d, *second_at));
    }
    let mut on = |letter: &str, parts: &[u32], at: At| {
        let id = next(model.markers.keys().next_back());
        let name = format!("{}_{letter}", line.name);
        add(model, id, name, (parts, at)).map_err(|d| line.at(d, line.span))
    };
    Ok([on("I", &on_i, at_i)?, on("J", &on_j, at_j)?])
}

/// Makes a joint of two instances, with markers that are aligned as its type wants.
fn joint(
    line: &Line<'_>,
    id: u32,
    model: &mut Model,
    bodies: &mut Vec<RigidBody>,
) -> Result<(), Diagnostic> {
    let [(word, word_at), instances @ ..] = &line.words[..] else {
        return Err(line.at(bad("a type of joint is expected").help(USAGE), line.span));
    };
    let of_type = |kind: &JointKind| kind.keyword().eq_ignore_ascii_case(word);
    let kind = JointKind::ALL.into_iter().find(of_type);
    let at = At::read(line)?;
    let axes = kind.and_then(|kind| axes_of_i(kind, &at.rotation));
    let (Some(kind), Some(axes)) = (kind, axes) else {
        let able = JointKind::ALL.into_iter();
        let able = able.filter(|&kind| axes_of_i(kind, &at.rotation).is_some());
        let able: Vec<&str> = able.map(JointKind::keyword).collect();
        let d = bad(format!("`{word}` is no joint that a line makes"));
        return Err(line.at(d.help(format!("it makes {}", able.join(", "))), *word_at));
    };
    let at_i = At {
        rotation: axes,
        ..at
    };
    let [i, j] = pair(line, instances, model, bodies, [at_i, at])?;
    let made = Joint {
        place: named(line.name.clone()),
        kind,
        i,
        j,
        ..Joint::default()
    };
    model.joints.insert(id, made);
    Ok(())
}

/// Returns the axes of the I marker of a joint, from those of J; `None` for joints whose two
/// markers no single place gives.
fn axes_of_i(kind: JointKind, j: &Mat3<f64>) -> Option<Mat3<f64>> {
    let [x, y, z] = [0, 1, 2].map(|k| j.column(k));
    match kind {
        JointKind::Revolute
        | JointKind::Translational
        | JointKind::Cylindrical
        | JointKind::Planar
        | JointKind::Fixed => Some(*j),
        // a quarter of a turn about y keeps the angles of the joint off their pole
        JointKind::Spherical => Some(Mat3::from_columns(-z, y, x)),
        // the pin of I lies along x of J
        JointKind::Universal => Some(Mat3::from_columns(y, z, x)),
        JointKind::Convel | JointKind::Hooke | JointKind::Rackpin | JointKind::Screw => None,
    }
}

/// Makes a marker on an instance.
fn marker(
    line: &Line<'_>,
    id: u32,
    model: &mut Model,
    bodies: &mut Vec<RigidBody>,
) -> Result<(), Diagnostic> {
    let [(on, on_at)] = &line.words[..] else {
        let d = bad(format!("{} is on one instance", line.name)).help(USAGE);
        return Err(line.at(d, line.span));
    };
    let parts = instance::rigidify(model, on, *on_at, bodies).map_err(|d| line.at(d, *on_at))?;
    let at = At::read(line)?;
    add(model, id, line.name.clone(), (&parts, at)).map_err(|d| line.at(d, line.span))?;
    Ok(())
}

/// Makes a spring-damper at a joint, or between two instances at a place.
fn spring(
    line: &Line<'_>,
    id: u32,
    model: &mut Model,
    bodies: &mut Vec<RigidBody>,
) -> Result<(), Diagnostic> {
    let is = |word: &str, (text, _): &(String, Span)| text.eq_ignore_ascii_case(word);
    let is_said = |word: &str| line.words.iter().any(|w| is(word, w));
    let ends: Vec<(String, Span)> = (line.words.iter())
        .filter(|w| !is("ROTATION", w) && !is("TRANSLATION", w))
        .cloned()
        .collect();
    let at_joint = match &ends[..] {
        [(one, at)] => Some(joint_named(model, one).map_err(|d| line.at(d, *at))?),
        _ => None,
    };
    let said = match (is_said("ROTATION"), is_said("TRANSLATION")) {
        (false, false) => None,
        (rotation, _) => Some(rotation),
    };
    let unclear = || {
        let d = bad(format!(
            "{}: ROTATION or TRANSLATION is expected",
            line.name
        ));
        line.at(d, line.span)
    };
    let (rotational, [i, j]) = match at_joint {
        Some(joint) => {
            let chosen = joint.kind.displacements().chosen(said);
            (chosen.map_err(|_| unclear())?, [joint.i, joint.j])
        }
        None => {
            let rotational = said.ok_or_else(unclear)?;
            let at = At::read(line)?;
            let position = line.vector("TO")?.unwrap_or(at.position);
            let ends = pair(line, &ends, model, bodies, [At { position, ..at }, at])?;
            (rotational, ends)
        }
    };
    let [stiffness, damping, preload, free] = match rotational {
        true => ["KT", "CT", "TORQUE", "ANGLE"],
        false => ["K", "C", "FORCE", "LENGTH"],
    };
    let value = |key: &str| Ok::<f64, Diagnostic>(line.number(key)?.unwrap_or(0.0));
    let made = SpringDamper {
        place: named(line.name.clone()),
        rotational,
        i,
        j,
        stiffness: value(stiffness)?,
        damping: value(damping)?,
        preload: value(preload)?,
        free: value(free)?,
    };
    model.spring_dampers.insert(id, made);
    Ok(())
}

/// Returns a joint that is named.
fn joint_named(model: &Model, name: &str) -> Result<Joint, Diagnostic> {
    let joint = || {
        let id = model.find_of(&[ElementKind::Joint], name)?;
        let joint = model.joints.get(&id.number).cloned();
        joint.ok_or_else(|| model.no_element(id))
    };
    joint().map_err(|d| d.help("a spring-damper is at a joint, or between two instances"))
}
