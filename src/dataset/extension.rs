//! Comment lines of ours: what datasets have no statement for, in lines that other programs skip.
//!
//! ```text
//! ! cognate: IC JOINT/3, X=0.1, X_RATE=2, ANGLE=30D       initial values of the variables of a joint
//! ! cognate: IC MARKER/20, X=1, VZ=-3                     and of the place and motion of a marker
//! ! cognate: RIGID arm = PART/2, PART/3                   parts that are one rigid body
//! ! cognate: RIGID arm                                    the parts whose names begin with `arm.`
//! ! cognate: JOINT/4 hinge = REVOLUTE, base, arm, AT=0,0,0, AXIS=0,0,1
//! ! cognate: INCLUDE arm.adm                              the statements of another dataset
//! ```
//!
//! Joints, markers, spring-dampers and curves that lines make are in `extension/made.rs`.
//!
//! Initial values become [`Model::beginnings`]. A rigid body becomes FIXED joints between its first
//! part and the others, with markers of their own; joints within it are switched off, for they have
//! nothing to hold. So a rigid body is part of the model for every other program, too, once it is
//! written: with its line, which finds its FIXED joints by their names when it is read again, and
//! switches off what is within. A part is in one rigid body at most, and no rigid body is in
//! another.

use made::Made;

use super::syntax::{Item, Source, Syntax, TokenKind};
use crate::diagnostic::{Diagnostic, Severity, Span, near_names};
use crate::model::geometry::orientation;
use crate::model::{
    Driven, ElementId, ElementKind, Joint, JointKind, Marker, MarkerOwner, Model, Orientation,
    Place,
};
use crate::space::{Frame, Vec3};
use std::collections::{BTreeMap, BTreeSet};

mod chain;
mod instance;
mod line;
mod made;

/// The word that such a comment begins with.
const MARK: &str = "cognate:";

/// A rigid body as it is written: its name, and its members with their places.
struct RigidBody {
    name: String,
    span: Span,
    members: Vec<(String, Span)>,
    /// no line says so: something was made on the instance
    implied: bool,
}

/// Reads the comment lines of a dataset whose statements have been read.
pub(super) fn read(source: &Source, syntax: &Syntax, model: &mut Model, out: &mut Vec<Diagnostic>) {
    let mut bodies: Vec<RigidBody> = Vec::new();
    let (mut made, mut beginnings) = (Vec::new(), Vec::new());
    for span in comments(syntax) {
        let Some(span) = after_mark(source, span) else {
            continue;
        };
        let text = source.slice(span);
        let word = text.split_whitespace().next().unwrap_or_default();
        let rest = Span::new(span.start + word.len(), span.end);
        match word.to_ascii_uppercase().as_str() {
            "IC" => beginnings.push(rest),
            "RIGID" => match rigid_body(source, rest, model) {
                Ok(body) => bodies.push(body),
                Err(d) => out.push(source.locate(d, rest)),
            },
            // read before, where it has a line of its own
            "INCLUDE" if source.begins_line(span.start) => {}
            "INCLUDE" => {
                let d = Diagnostic::error("include", "an INCLUDE stands on a line of its own");
                out.push(source.locate(d, span));
            }
            _ => match Made::of(word) {
                Some(what) => made.push((what, rest)),
                None => {
                    let d = bad(format!("`{word}` is no line of ours")).help(USAGE);
                    let word = Span::new(span.start, rest.start.max(span.start + 1));
                    out.push(source.locate(d, word));
                }
            },
        }
    }
    for (what, rest) in made {
        let done = made::make((source, rest), what, model, &mut bodies, out);
        out.extend(done.err());
    }
    for rest in beginnings {
        initial_values(source, rest, model, out);
    }
    // a single part is a rigid body by itself
    bodies.retain(|body| !body.implied || body.members.len() > 1);
    let mut of_part: BTreeMap<ElementId, String> = BTreeMap::new();
    for body in &bodies {
        match parts_of(source, body, &bodies, model, &mut of_part) {
            Ok(parts) => weld(&body.name, &parts, model, (source, body.span), out),
            Err(found) => out.extend(found),
        }
    }
}

const USAGE: &str = "lines are `! cognate: IC JOINT/3, ANGLE=30D`, `! cognate: RIGID arm = PART/2, PART/3` \
    and `! cognate: JOINT/4 hinge = REVOLUTE, base, arm, AT=0,0,0, AXIS=0,0,1`, with JOINT, MARKER, SPRINGDAMPER or CURVE; \
    `! cognate: INCLUDE leg.adm` has the statements of another dataset";

fn bad(message: impl Into<String>) -> Diagnostic {
    Diagnostic::error("bad_extension", message)
}

/// Returns the places of all comments, those within statements too.
fn comments(syntax: &Syntax) -> Vec<Span> {
    let mut found = Vec::new();
    for item in &syntax.items {
        match item {
            Item::Comment(span) => found.push(*span),
            Item::Statement(tokens) => {
                let comments = tokens
                    .tokens
                    .iter()
                    .filter(|t| t.kind == TokenKind::Comment);
                found.extend(comments.map(|t| t.span));
            }
        }
    }
    found
}

/// Returns what stands in a comment after our mark.
pub(super) fn after_mark(source: &Source, span: Span) -> Option<Span> {
    let text = source.slice(span);
    let inner = text.trim_start_matches(|c: char| c == '!' || c.is_whitespace());
    let head = inner.get(..MARK.len())?;
    if !head.eq_ignore_ascii_case(MARK) {
        return None;
    }
    let after = &inner[MARK.len()..];
    let rest = after.trim_start();
    let start = span.end - rest.len();
    Some(Span::new(start, start + rest.trim_end().len()))
}

/// Returns the pieces between commas, without blanks around them, with their places.
fn pieces(source: &Source, span: Span) -> Vec<(String, Span)> {
    let text = source.slice(span);
    let mut at = span.start;
    let mut found = Vec::new();
    for piece in text.split(',') {
        let inner = piece.trim();
        let start = at + (piece.len() - piece.trim_start().len());
        found.push((inner.to_owned(), Span::new(start, start + inner.len())));
        at += piece.len() + 1;
    }
    found
}

/// Reads initial values of a joint or a marker.
fn initial_values(source: &Source, span: Span, model: &mut Model, out: &mut Vec<Diagnostic>) {
    let pieces = pieces(source, span);
    let Some(((element, at), values)) = pieces.split_first() else {
        return;
    };
    let id = match model.find_of(&[ElementKind::Joint, ElementKind::Marker], element) {
        Ok(id) => id,
        Err(d) => {
            let d = match model.find_of(&[ElementKind::Part, ElementKind::PointMass], element) {
                Ok(id) => bad(format!("{id}: joints and markers have initial values here"))
                    .help("those of a PART are its VX, VY, VZ, WX, WY, WZ and EXACT"),
                Err(_) if element.is_empty() => bad("a joint or a marker is expected").help(USAGE),
                Err(_) => d,
            };
            return out.push(source.locate(d, *at));
        }
    };
    let known = model.initial_quantities(id);
    if values.is_empty() || known.is_empty() {
        let d = match known.is_empty() {
            true => bad(format!("{id} has no variables of its own"))
                .help("give a marker of the part that it carries initial values"),
            false => bad(format!("{id} is given no initial values")).help(USAGE),
        };
        return out.push(source.locate(d, *at));
    }
    for (piece, at) in values {
        let (name, value) = piece.split_once('=').unwrap_or((piece.as_str(), ""));
        let name = name.trim();
        let quantity = known.iter().find(|(n, _)| n.eq_ignore_ascii_case(name));
        let Some(&(_, quantity)) = quantity else {
            let names = known.iter().map(|(n, _)| *n);
            let near = near_names(name, names.clone());
            let d = bad(format!("{id} has no `{name}`"));
            let all: Vec<&str> = names.collect();
            let d = match near.is_empty() {
                true => d,
                false => d.help(format!("did you mean {}?", near.join(" or "))),
            };
            out.push(source.locate(d.help(format!("it has {}", all.join(", "))), *at));
            continue;
        };
        let Some(value) = number(value) else {
            let d = bad(format!(
                "{name} = a number is expected, of radians or with D for degrees"
            ));
            out.push(source.locate(d, *at));
            continue;
        };
        let own = model.beginnings.entry(id).or_default();
        if own.insert(quantity, value).is_some() {
            let d = Diagnostic::error("given_twice", format!("{name} of {id} is given twice"));
            out.push(source.locate(d, *at));
        }
    }
}

/// Reads a number; with the suffix D it is an angle in degrees.
fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    let (digits, factor) = match text.strip_suffix(['D', 'd']) {
        Some(digits) => (digits, std::f64::consts::PI / 180.0),
        None => (text, 1.0),
    };
    let value: f64 = digits.parse().ok()?;
    (value * factor).is_finite().then_some(value * factor)
}

/// Reads a rigid body: `name = PART/2, PART/3`, or the name of an instance.
fn rigid_body(source: &Source, span: Span, model: &Model) -> Result<RigidBody, Diagnostic> {
    let text = source.slice(span);
    let name = text.trim();
    if let Ok(parts) = instance::parts(model, name) {
        let members = parts
            .iter()
            .map(|&n| (ElementKind::Part.id(n).to_string(), span));
        return Ok(RigidBody {
            name: name.to_owned(),
            span,
            members: members.collect(),
            implied: false,
        });
    }
    let (name, members) = text
        .split_once('=')
        .filter(|(name, members)| !name.trim().is_empty() && !members.trim().is_empty())
        .ok_or_else(|| bad("a rigid body is `name = PART/2, PART/3`").help(USAGE))?;
    let start = span.end - members.len();
    Ok(RigidBody {
        name: name.trim().to_owned(),
        span,
        members: pieces(source, Span::new(start, span.end)),
        implied: false,
    })
}

/// Returns the parts of a rigid body.
///
/// # Errors
/// Parts that do not exist or are in another rigid body, and rigid bodies in it.
fn parts_of(
    source: &Source,
    body: &RigidBody,
    all: &[RigidBody],
    model: &Model,
    of_part: &mut BTreeMap<ElementId, String>,
) -> Result<Vec<u32>, Vec<Diagnostic>> {
    let (mut parts, mut found) = (Vec::new(), Vec::new());
    let rigid = |message: String| Diagnostic::error("rigid_body", message);
    if all.iter().filter(|b| b.name == body.name).count() > 1 {
        let d = rigid(format!("two rigid bodies are called {}", body.name));
        found.push(source.locate(d, body.span));
    }
    for (member, at) in &body.members {
        let is_body = all.iter().any(|b| b.name == *member);
        let id = model.find_of(&[ElementKind::Part], member);
        let wrong = match id {
            _ if is_body => Some(
                rigid(format!(
                    "{} cannot be rigid: {member}, which is in it, is rigid already",
                    body.name
                ))
                .help(format!("name the parts of {member} instead, in one line")),
            ),
            Ok(id) => match of_part.insert(id, body.name.clone()) {
                None => {
                    parts.push(id.number);
                    None
                }
                Some(other) if other == body.name => {
                    Some(rigid(format!("{id} is named twice in {other}")))
                }
                Some(other) => Some(
                    rigid(format!(
                        "{} cannot be rigid: {id} is in the rigid body {other}",
                        body.name
                    ))
                    .help("a part is in one rigid body at most"),
                ),
            },
            Err(d) if model.find_element(member).is_ok() => Some(rigid(format!(
                "{}: a rigid body is made of parts",
                d.message
            ))),
            Err(d) => Some(d),
        };
        found.extend(wrong.map(|d| source.locate(d, *at)));
    }
    if found.is_empty() && parts.len() < 2 {
        let d = rigid(format!("{} needs at least two parts", body.name));
        found.push(source.locate(d, body.span));
    }
    match found.is_empty() {
        true => Ok(parts),
        false => Err(found),
    }
}

/// Fixes the parts of a rigid body to its first one (ground, if that is among them), and switches
/// off the constraints between them.
fn weld(
    name: &str,
    parts: &[u32],
    model: &mut Model,
    (source, span): (&Source, Span),
    out: &mut Vec<Diagnostic>,
) {
    let frame = |model: &Model, n: u32| {
        let part = model.parts.get(&n)?;
        let rotation = orientation(&part.orientation, part.qg).ok()?;
        let position = Vec3(part.qg);
        Some(Frame { rotation, position })
    };
    model.rigid_bodies.insert(name.to_owned(), parts.to_vec());
    held_within(name, parts, model, (source, span), out);
    let is_ground = |n: &&u32| model.parts.get(n).is_some_and(|p| p.ground);
    let base = parts.iter().find(is_ground).or(parts.first()).copied();
    // an orientation that is none has been told
    let Some((base, base_frame)) = base.and_then(|b| Some((b, frame(model, b)?))) else {
        return;
    };
    for &part in parts.iter().filter(|&&p| p != base) {
        let Some(own) = frame(model, part).filter(|_| !is_welded(model, name, part)) else {
            continue;
        };
        let turned = base_frame.rotation.transpose() * own.rotation;
        let away = base_frame
            .rotation
            .apply_transposed(own.position - base_frame.position);
        let on_base = Marker {
            owner: MarkerOwner::Part(base),
            qp: away.0,
            orientation: euler(turned),
            ..Marker::default()
        };
        let on_part = Marker {
            owner: MarkerOwner::Part(part),
            ..Marker::default()
        };
        let i = next(model.markers.keys().next_back());
        model.markers.insert(i, on_part);
        let j = next(model.markers.keys().next_back());
        model.markers.insert(j, on_base);
        let joint = Joint {
            place: Place {
                name: Some(name_of_weld(name, part)),
                ..Place::default()
            },
            kind: JointKind::Fixed,
            i,
            j,
            ..Joint::default()
        };
        let id = next(model.joints.keys().next_back());
        model.joints.insert(id, joint);
    }
}

/// Returns the name of the joint that fixes a part in a rigid body.
fn name_of_weld(body: &str, part: u32) -> String {
    format!("{body}_{part}")
}

/// Returns whether a joint of that name fixes a part in a rigid body: the body has been written.
fn is_welded(model: &Model, body: &str, part: u32) -> bool {
    let mut joints = model.joints.values();
    joints.any(|joint| is_weld(joint, body, &[part]))
}

/// Returns whether a joint is one of those that fix some parts in a rigid body.
fn is_weld(joint: &Joint, body: &str, parts: &[u32]) -> bool {
    let named = |&part: &u32| joint.place.name == Some(name_of_weld(body, part));
    joint.kind == JointKind::Fixed && parts.iter().any(named)
}

/// Returns the joints and primitives between parts of a rigid body, but for those that fix them.
fn within(name: &str, parts: &[u32], model: &Model) -> Vec<ElementId> {
    let is_within = |marker: &u32| match model.markers.get(marker).map(|m| m.owner) {
        Some(MarkerOwner::Part(part)) => parts.contains(&part),
        Some(MarkerOwner::PointMass(_) | MarkerOwner::Other(_)) | None => false,
    };
    let joints = model.joints.iter();
    let joints = joints.filter(|(_, j)| is_within(&j.i) && is_within(&j.j));
    let joints = joints.filter(|(_, j)| !is_weld(j, name, parts));
    let joints = joints.map(|(&n, _)| ElementKind::Joint.id(n));
    let primitives = model.primitives.iter();
    let primitives = primitives.filter(|(_, p)| is_within(&p.i) && is_within(&p.j));
    let primitives = primitives.map(|(&n, _)| ElementKind::Jprim.id(n));
    joints.chain(primitives).collect()
}

impl Model {
    /// Returns the joints and primitives between parts of one rigid body each, which have nothing
    /// to hold: reading the line of the body switches them off.
    pub fn within_rigid_bodies(&self) -> BTreeSet<ElementId> {
        let bodies = self.rigid_bodies.iter();
        bodies
            .flat_map(|(name, parts)| within(name, parts, self))
            .collect()
    }
}

/// Returns the number after the last one in use.
fn next(last: Option<&u32>) -> u32 {
    last.map_or(1, |n| n.saturating_add(1))
}

/// Returns the 3-1-3 angles of a rotation.
fn euler(rotation: crate::space::Mat3<f64>) -> Orientation {
    Orientation::Euler(crate::space::rotation::to_313(&rotation))
}

/// Switches off joints and primitives between parts of a rigid body; refuses motions between them.
fn held_within(
    name: &str,
    parts: &[u32],
    model: &mut Model,
    (source, span): (&Source, Span),
    out: &mut Vec<Diagnostic>,
) {
    let is_within = |marker: u32| match model.markers.get(&marker).map(|m| m.owner) {
        Some(MarkerOwner::Part(part)) => parts.contains(&part),
        Some(MarkerOwner::PointMass(_) | MarkerOwner::Other(_)) | None => false,
    };
    let held = within(name, parts, model);
    for (&n, motion) in &model.motions {
        let drives = match motion.driven {
            Driven::Joint(j) | Driven::JointRotation(j) | Driven::JointTranslation(j) => {
                held.contains(&ElementKind::Joint.id(j))
            }
            Driven::Markers { i, j, .. } => is_within(i) && is_within(j),
        };
        if drives {
            let what = format!("it moves parts of the rigid body {name} against each other");
            let d = Diagnostic::error("rigid_body", what).element(ElementKind::Motion.id(n));
            out.push(source.locate(d, span));
        }
    }
    for id in held {
        let what = format!("it lies within the rigid body {name} and is left out");
        let d = Diagnostic {
            severity: Severity::Note,
            ..Diagnostic::error("rigid_body", what).element(id)
        };
        out.push(source.locate(d, span));
        model.inactive.insert(id);
    }
}
