//! The table of result sets: for every kind of element the name of its kind in files, the
//! components that it has among the results, and the word of RESULTS that leaves them out.
//!
//! | components | meaning | frame |
//! |---|---|---|
//! | `FX` … `TZ` | force and torque on I, about the origin of I | ground |
//! | `Q`, `QD`, `QDD` | prescribed displacement of a MOTION and its rates | along its joint or marker J |
//! | `F1` … | force or torque of a COUPLER on the variable of its first, second … joint | – |
//! | `LAMBDA` | multiplier of a GCON: what it exerts is this times the gradient of its function | – |
//! | `X`, `Y`, `Z` | of CONTACT, PTCV and CVCV: where they touch | ground |
//! | `DEPTH`, `COUNT` | deepest overlap of the solids of a CONTACT, number of places | – |
//! | `S1`, `S2` | parameters of the curves where they touch | – |
//! | `VX` … `WZ` of FRICTION | velocity and angular velocity of the slip | marker I |
//! | `FX_12` … | of NFORCE: on each of its I markers | ground |
//!
//! Names and order of those sets that real results of Adams have are theirs.

use super::selection::{Omission, Selection, omits};
use super::shown::{ENERGIES, Unit, What};
use crate::model::{BALL, Driven, ElementId, ElementKind, Model};
use crate::results;

/// A group of components of a set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Group {
    /// the six components on I
    Action,
    /// what a MOTION prescribes
    Prescribed,
    /// what a COUPLER exerts on its joints
    Transmitted,
    /// the multiplier of a GCON
    Multiplier,
    /// where a PTCV or CVCV touches
    CurveContact,
    /// where and how deep solids touch
    Touch,
    /// how fast surfaces slip
    Slip,
    /// the six components on each I marker of an NFORCE
    Nodes,
    /// the value of a VARIABLE
    Value,
    /// the value of a DIFF and its rate
    State,
    /// states and outputs of LSE, TFSISO and GSE
    Arrays,
    /// the entries of PINPUT or POUTPUT
    Entries,
}

/// The results of a kind of element.
#[derive(Clone, Copy, Debug)]
pub(super) enum Contents {
    /// motion of a body: made for all bodies together, level by level
    Body,
    /// groups of components, each with the word that leaves it out
    Groups(&'static [(Group, Omission)]),
    /// there is no set, for this reason
    None(&'static str),
}

/// A row of the table of result sets.
#[derive(Clone, Copy, Debug)]
pub(super) struct Set {
    /// the kind of element
    pub kind: ElementKind,
    /// its results
    pub contents: Contents,
}

use Contents::{Body, Groups, None as No};
use ElementKind as E;
use Omission as O;

const REACTION: Contents = Groups(&[(Group::Action, O::ReactionForces)]);
const FORCE: Contents = Groups(&[(Group::Action, O::AppliedForces)]);
const CURVES: Contents = Groups(&[
    (Group::Action, O::ReactionForces),
    (Group::CurveContact, O::FloatingMarkers),
]);
const SYSTEM: Contents = Groups(&[(Group::Arrays, O::SystemElements)]);
const ENTRIES: Contents = Groups(&[(Group::Entries, O::SystemElements)]);
const DRIVE: Contents = Groups(&[
    (Group::Action, O::ReactionForces),
    (Group::Prescribed, O::Displacements),
]);
const COUPLING: Contents = Groups(&[(Group::Transmitted, O::ReactionForces)]);
const GENERAL: Contents = Groups(&[
    (Group::Action, O::ReactionForces),
    (Group::Multiplier, O::ReactionForces),
]);
const NODES: Contents = Groups(&[(Group::Nodes, O::AppliedForces)]);
const VALUE: Contents = Groups(&[(Group::Value, O::SystemElements)]);
const STATE: Contents = Groups(&[(Group::State, O::SystemElements)]);
const SLIDING: Contents = Groups(&[
    (Group::Action, O::AppliedForces),
    (Group::Slip, O::AppliedForces),
]);
const TOUCHING: Contents = Groups(&[(Group::Action, O::Contacts), (Group::Touch, O::Contacts)]);
const DATA: Contents = No("others read it");
const OWN_COLUMNS: Contents = No("its components are columns of its own");

const fn set(kind: ElementKind, contents: Contents) -> Set {
    Set { kind, contents }
}

impl Set {
    /// Returns the word for the kind in files.
    pub fn word(&self) -> &'static str {
        results::word_of(self.kind)
    }
}

/// The table: all kinds of elements that are solved, in the order of their sets in files.
pub(super) const SETS: &[Set] = &[
    set(E::Part, Body),
    set(E::PointMass, Body),
    set(E::Joint, REACTION),
    set(E::Jprim, REACTION),
    set(E::Motion, DRIVE),
    set(E::Coupler, COUPLING),
    set(E::Gear, REACTION),
    set(E::Gcon, GENERAL),
    set(E::Ptcv, CURVES),
    set(E::Cvcv, CURVES),
    set(E::Sforce, FORCE),
    set(E::Vforce, FORCE),
    set(E::Vtorque, FORCE),
    set(E::Gforce, FORCE),
    set(E::SpringDamper, FORCE),
    set(E::Bushing, FORCE),
    set(E::Field, FORCE),
    set(E::Beam, FORCE),
    set(E::Nforce, NODES),
    set(E::Variable, VALUE),
    set(E::Diff, STATE),
    set(E::Lse, SYSTEM),
    set(E::Tfsiso, SYSTEM),
    set(E::Gse, SYSTEM),
    set(E::Pinput, ENTRIES),
    set(E::Poutput, ENTRIES),
    set(E::Friction, SLIDING),
    set(E::Contact, TOUCHING),
    set(
        E::Marker,
        No("its motion follows from that of its part: cognate motion"),
    ),
    set(
        E::Sensor,
        No("the log tells when it acts; a REQUEST shows its function"),
    ),
    set(E::Array, DATA),
    set(E::Curve, DATA),
    set(E::Spline, DATA),
    set(E::String, DATA),
    set(E::Matrix, DATA),
    set(E::Request, OWN_COLUMNS),
    set(E::Mrequest, OWN_COLUMNS),
    set(E::Graphics, No("it is drawn")),
];

/// Returns why elements of a kind have no results of their own; `None`: they have.
pub(super) fn why_without(kind: ElementKind) -> Option<&'static str> {
    match SETS.iter().find(|set| set.kind == kind)?.contents {
        No(reason) => Some(reason),
        Body | Groups(_) => None,
    }
}

/// A component of a set before it is a column.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub name: String,
    pub unit: Unit,
    pub source: Source,
}

/// The value of a component: an expression, or a quantity of the scene.
#[derive(Clone, Debug)]
pub(super) enum Source {
    Text(String),
    Scene(What),
}

/// Names and units of the components of an action.
pub(super) const ACTION: [(&str, Unit); 6] = [
    ("FX", Unit::Force),
    ("FY", Unit::Force),
    ("FZ", Unit::Force),
    ("TX", Unit::Torque),
    ("TY", Unit::Torque),
    ("TZ", Unit::Torque),
];

fn of_scene(name: impl Into<String>, unit: Unit, what: What) -> Piece {
    let (name, source) = (name.into(), Source::Scene(what));
    Piece { name, unit, source }
}

fn of_text(name: impl Into<String>, unit: Unit, text: String) -> Piece {
    let (name, source) = (name.into(), Source::Text(text));
    Piece { name, unit, source }
}

/// Returns the components of an element that are recorded.
pub(super) fn pieces(
    model: &Model,
    selection: &Selection<'_>,
    set: &Set,
    number: u32,
) -> Vec<Piece> {
    let Groups(groups) = set.contents else {
        return Vec::new();
    };
    if !selection.has(set.kind.id(number)) {
        return Vec::new();
    }
    let kept = groups
        .iter()
        .filter(|(_, omission)| !omits(model, *omission));
    kept.flat_map(|(group, _)| group.pieces(model, set.kind.id(number)))
        .collect()
}

impl Group {
    fn pieces(self, model: &Model, id: ElementId) -> Vec<Piece> {
        let n = id.number;
        match self {
            // without I the reaction of a GCON belongs to no marker
            Group::Action if lacks_i(model, id) => Vec::new(),
            Group::Action => numbered(ACTION, |component| What::Action { id, component }),
            Group::Prescribed => {
                let units = match drives_an_angle(model, n) {
                    true => [0, 1, 2].map(Unit::Angle),
                    false => [0, 1, 2].map(Unit::Length),
                };
                let names = ["Q", "QD", "QDD"].into_iter().zip(units);
                numbered(names, |derivative| What::Prescribed {
                    motion: n,
                    derivative,
                })
            }
            Group::Transmitted => transmitted(model, n),
            Group::Multiplier => vec![of_scene("LAMBDA", Unit::Number, What::Multiplier(n))],
            Group::CurveContact => {
                let place = ["X", "Y", "Z"].map(|name| (name, Unit::Length(0)));
                let parameters = ["S1", "S2"].map(|name| (name, Unit::Number));
                let curves = if id.kind == E::Cvcv { 2 } else { 1 };
                let all = place.into_iter().chain(parameters.into_iter().take(curves));
                numbered(all, |component| What::CurveContact { id, component })
            }
            Group::Touch => {
                let place = ["X", "Y", "Z", "DEPTH"].map(|name| (name, Unit::Length(0)));
                let all = place.into_iter().chain([("COUNT", Unit::Number)]);
                numbered(all, |component| What::Touch {
                    contact: n,
                    component,
                })
            }
            Group::Slip => {
                let translation = ["VX", "VY", "VZ"].map(|name| (name, Unit::Length(1)));
                let rotation = ["WX", "WY", "WZ"].map(|name| (name, Unit::Angle(1)));
                let all = translation.into_iter().chain(rotation);
                numbered(all, |component| What::Slip {
                    friction: n,
                    component,
                })
            }
            Group::Nodes => nodes(model, n),
            Group::Value => vec![of_text("Q", Unit::Number, format!("VARVAL({n})"))],
            Group::State => vec![
                of_text("Q", Unit::Number, format!("DIF({n})")),
                of_text("QD", Unit::Number, format!("DIF1({n})")),
            ],
            Group::Arrays => arrays(model, id),
            Group::Entries => entries(model, id),
        }
    }
}

/// Returns components of these names and units, each the quantity of its place among them.
fn numbered(
    names: impl IntoIterator<Item = (&'static str, Unit)>,
    what: impl Fn(usize) -> What,
) -> Vec<Piece> {
    let all = names.into_iter().enumerate();
    all.map(|(k, (name, unit))| of_scene(name, unit, what(k)))
        .collect()
}

/// Returns the entries of a PINPUT or POUTPUT.
fn entries(model: &Model, id: ElementId) -> Vec<Piece> {
    let (list, measure, name) = match id.kind {
        E::Poutput => (&model.plant_outputs, "POUVAL", "OUT"),
        _ => (&model.plant_inputs, "PINVAL", "IN"),
    };
    let n = list
        .get(&id.number)
        .map_or(0, |plant| plant.variables.len());
    let entry = |k: usize| {
        let text = format!("{measure}({},{k})", id.number);
        of_text(format!("{name}{k}"), Unit::Number, text)
    };
    (1..=n).map(entry).collect()
}

fn lacks_i(model: &Model, id: ElementId) -> bool {
    let gcon = model.general_constraints.get(&id.number);
    id.kind == E::Gcon && gcon.is_none_or(|gcon| gcon.i.is_none())
}

/// Returns whether a MOTION prescribes an angle.
fn drives_an_angle(model: &Model, motion: u32) -> bool {
    match model.motions.get(&motion).map(|m| m.driven) {
        Some(Driven::JointRotation(_)) => true,
        Some(Driven::Markers { component, .. }) => component >= 3,
        Some(Driven::Joint(joint)) => turns(model, joint),
        Some(Driven::JointTranslation(_)) | None => false,
    }
}

/// Returns whether the only variable of a joint is an angle.
fn turns(model: &Model, joint: u32) -> bool {
    let joint = model.joints.get(&joint);
    joint.is_some_and(|j| j.kind.displacements().turns())
}

fn transmitted(model: &Model, n: u32) -> Vec<Piece> {
    let Some(coupler) = model.couplers.get(&n) else {
        return Vec::new();
    };
    let joints = coupler.joints.iter().zip(&coupler.rotational);
    let pieces = joints.enumerate().map(|(term, (&joint, rotational))| {
        let unit = match rotational.unwrap_or_else(|| turns(model, joint)) {
            true => Unit::Torque,
            false => Unit::Force,
        };
        let what = What::Transmitted { coupler: n, term };
        of_scene(format!("F{}", term + 1), unit, what)
    });
    pieces.collect()
}

fn nodes(model: &Model, n: u32) -> Vec<Piece> {
    let markers = model.nodal_forces.get(&n).map_or(&[][..], |f| &f.i);
    let node = |&marker: &u32| {
        let components = ACTION.into_iter().zip([2, 3, 4, 6, 7, 8]);
        components.map(move |((name, unit), component)| {
            let text = format!("NFORCE({n},{marker},{component},0)");
            of_text(format!("{name}_{marker}"), unit, text)
        })
    };
    markers.iter().flat_map(node).collect()
}

/// Returns the states and outputs of a system, as entries of its arrays.
fn arrays(model: &Model, id: ElementId) -> Vec<Piece> {
    let rows = |matrix: u32| model.matrices.get(&matrix).map_or(0, |m| m.rows);
    let lists: Vec<(&str, Option<u32>, usize)> = match id.kind {
        E::Lse => (model.linear_systems.get(&id.number)).map_or_else(Vec::new, |s| {
            let outputs = s.c.or(s.d).map_or(0, rows);
            vec![("X", Some(s.x), rows(s.a)), ("Y", s.y, outputs)]
        }),
        E::Tfsiso => (model.transfer_functions.get(&id.number)).map_or_else(Vec::new, |s| {
            let states = s.denominator.len().saturating_sub(1);
            vec![("X", Some(s.x), states), ("Y", Some(s.y), 1)]
        }),
        E::Gse => (model.general_systems.get(&id.number)).map_or_else(Vec::new, |s| {
            vec![("X", s.x, s.ns), ("XD", s.xd, s.nd), ("Y", s.y, s.no)]
        }),
        _ => Vec::new(),
    };
    let mut pieces = Vec::new();
    for (name, array, n) in lists {
        let Some(array) = array else { continue };
        pieces.extend((1..=n).map(|k| {
            let text = format!("ARYVAL({array},{k})");
            of_text(format!("{name}{k}"), Unit::Number, text)
        }));
    }
    pieces
}

/// Returns the variables of a joint: one for each of its freedoms, angles in degrees.
pub(super) fn joint_variables(model: &Model, joint: u32) -> Vec<Piece> {
    let Some(data) = model.joints.get(&joint) else {
        return Vec::new();
    };
    if data.kind.is_ball() {
        // a ball has no angles of its own: those between the axes of its markers
        let between = |(name, axis)| {
            let (i, j) = (data.i, data.j);
            of_scene(name, Unit::Degree, What::BetweenAxes { i, j, axis })
        };
        return BALL.into_iter().zip(0..).map(between).collect();
    }
    let variables = data.kind.row().variables.iter();
    let pieces = variables.map(|&(variable, gauge)| {
        let unit = match gauge.is_angle() {
            true => Unit::Degree,
            false => Unit::Length(0),
        };
        of_scene(variable, unit, What::JointVariable { joint, variable })
    });
    pieces.collect()
}

/// Returns the energies of the model, and the powers that change them.
pub(super) fn energies() -> Vec<Piece> {
    let all = ENERGIES.into_iter().enumerate();
    all.map(|(k, (name, unit))| of_scene(name, unit, What::Energy(k)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_that_is_solved_has_one_row_and_contents_or_a_reason() {
        for &kind in ElementKind::ALL {
            let rows: Vec<&Set> = SETS.iter().filter(|set| set.kind == kind).collect();
            assert_eq!(rows.len(), usize::from(kind.is_solved()), "{kind}");
        }
        for set in SETS {
            match set.contents {
                Groups(groups) => assert!(!groups.is_empty(), "{}", set.kind),
                No(_) => assert!(why_without(set.kind).is_some_and(|why| why.len() > 4)),
                Body => {}
            }
        }
    }
}
