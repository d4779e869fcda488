//! Outline of a model as it is compiled: what carries what, the unknowns, the rows, what is
//! left out, and how much there is to compute.

use crate::analysis::start::dataset::Dataset;
use crate::analysis::start::{assemble, misalignment, velocities};
use crate::analysis::system::System;
use crate::analysis::verify::culprit::blamed;
use crate::analysis::verify::idle::{Idle, idle};
use crate::analysis::verify::{stand_still, start};
use crate::analysis::warning::{AssemblyWarning, Warning};
use crate::arrange::Arrange;
use crate::diagnostic::Error;
use crate::model::{ElementId, ElementKind, Family, Formula, Model};
use crate::scene::build::Options;
use crate::scene::configuration::{Configuration, Way};
use crate::scene::equations::row_name;
use crate::scene::programs;
use crate::scene::{Scene, Source};
use std::collections::BTreeSet;

/// The link that carries a part, and its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Carried {
    /// "PART/3"
    pub part: String,
    /// "JOINT/2"; `None`: it is free
    pub by: Option<String>,
    /// "PART/2" or "ground"
    pub carrier: String,
    /// coordinates between the two
    pub coordinates: Vec<String>,
}

/// The outline of a model.
#[derive(Clone, Debug, Default)]
pub struct Outline {
    /// parts, carriers first
    pub forest: Vec<Carried>,
    /// parts that a FIXED joint makes one with their carrier
    pub welded: Vec<String>,
    /// unknowns of the integrator with their values at the start
    pub unknowns: Vec<(String, f64)>,
    /// states that are integrated beside these: the mechanism does not read them
    pub downstream: Vec<String>,
    /// coordinates that motions prescribe
    pub prescribed: Vec<String>,
    /// rows that close loops
    pub rows: Vec<String>,
    /// functions that routines compute, which the results depend on: "SFORCE/1 FUNCTION"
    pub inputs: Vec<String>,
    /// rows that depend on others, elements that are switched off or not solved
    pub left_out: Vec<String>,
    /// elements that take no part in the motion
    pub idle: Vec<Idle>,
    /// operations that each element adds to one evaluation of the rates, the most first; those that
    /// it shares with an earlier one count there
    pub costs: Vec<(ElementId, usize)>,
    /// operations of one evaluation of the rates, and of one projection onto the rows
    pub operations: (usize, usize),
    /// values watched for a change of sign
    pub switches: usize,
    /// "mass matrix" or "articulated bodies"
    pub elimination: &'static str,
    /// what else the user should know
    pub warnings: Vec<Warning>,
}

/// Returns the kinds of elements that a model may hold without being solved, where only its
/// freedoms are asked for.
pub(in crate::analysis) fn pushing() -> BTreeSet<ElementKind> {
    let families = [Family::Body, Family::Force, Family::System];
    families.into_iter().flat_map(ElementKind::of).collect()
}

/// Compiles and assembles a model, and tells what came out.
///
/// # Errors
/// Mistakes that keep the model from being solved.
pub fn outline(model: &Model) -> Result<Outline, Error> {
    model.checked()?;
    let mut model = model.clone();
    let mut taken_for_granted = Vec::new();
    let inputs = inputs(&model);
    let idle = idle(&model);
    stand_still(&mut model, &mut taken_for_granted);
    let model = &model;
    let options = Options {
        mode: 4,
        skip: pushing(),
        zero_user: true,
        ..Options::default()
    };
    let scene = Scene::compile(model, &options)?;
    let mut configuration = Configuration::new(&scene);
    let mut out = Outline {
        inputs,
        idle,
        warnings: warnings(misalignment::misaligned(&scene, model)),
        ..Outline::default()
    };
    for d in &scene.warnings {
        let element = d.subject().unwrap_or_default();
        out.left_out.push(format!("{element} {}", d.message));
    }
    for id in &model.inactive {
        out.left_out.push(format!("{id} is switched off"));
    }
    let mut q = scene.initial_q.clone();
    let x = start(&scene, model, &mut q);
    let drawn = Dataset::drawn(&scene, model, &x);
    let (assembly, _) =
        (drawn.assemble(&mut configuration, &mut q)).map_err(|said| blamed(model, said))?;
    let here = scene.within(&configuration);
    out.warnings.extend(assembly.warnings.iter().cloned());
    let numbers = assemble::numbers(here, 0.0, &q, &vec![0.0; scene.layout.n_v], &x);
    let turned = misalignment::turned(here, model, &numbers, true);
    out.warnings.extend(warnings(turned));
    for r in &assembly.redundant {
        let on: Vec<String> = (r.combination.iter().take(4))
            .map(|c| row_name(&scene.rows[c.0]))
            .collect();
        let words = if on.is_empty() {
            "says nothing in this mechanism".to_string()
        } else {
            format!("follows from {}", on.join(", "))
        };
        out.left_out.push(format!("{} {words}", r.name));
    }
    out.rows = (configuration.active_rows())
        .map(|r| row_name(&scene.rows[r]))
        .collect();
    forest(&scene, &mut out);
    let v = velocities::velocities(here, model, 0.0, &q, &x)?;
    let names = scene.unknown_names();
    out.unknowns = names
        .into_iter()
        .zip(q.into_iter().chain(v).chain(x))
        .collect();
    out.downstream = scene.downstream().iter().map(ToString::to_string).collect();
    out.prescribed = prescribed(&scene);
    let system = System::new(scene, configuration)?;
    out.operations = (
        system.operations(),
        system.projection_operations().unwrap_or(0),
    );
    out.costs = programs::costs(system.configured());
    out.switches = system.branches().len();
    out.elimination = match system.configuration.elimination.way {
        Way::MassMatrix => "mass matrix",
        Way::ArticulatedBodies => "articulated bodies",
        Way::RowsWhereLoopsClose => "articulated bodies, rows where loops close",
    };
    Ok(out)
}

/// Returns the coordinates that motions prescribe, and which motion does.
fn prescribed(scene: &Scene) -> Vec<String> {
    let driven = scene.coordinates.iter().filter_map(|c| match c.source {
        Source::Driven(m) => {
            let motion = ElementKind::Motion.id(scene.motions[m].id);
            Some(format!("{} by {motion}", c.id))
        }
        Source::Free { .. } => None,
    });
    driven.collect()
}

/// Returns the functions of a model that routines compute.
fn inputs(model: &Model) -> Vec<String> {
    let formulas = model.formulas().into_iter();
    let computed = formulas.filter(|f| {
        matches!(f.formula, Formula::User { .. })
            && f.element.kind.family() != Family::Output
            && model.is_active(f.element)
    });
    let names = computed.map(|f| format!("{} {}", f.element, f.argument));
    names.collect()
}

/// Returns the carrier of each part, in the order of the links.
fn forest(scene: &Scene, out: &mut Outline) {
    let mut order: Vec<usize> = (0..scene.parts.len()).collect();
    order.arrange_by_key(|&k| scene.parts[k].link);
    for k in order {
        let part = &scene.parts[k];
        let name = part.id.to_string();
        let carrying = scene
            .constraints
            .iter()
            .find(|c| c.carries.is_some_and(|(link, _)| Some(link) == part.link));
        let carrier = carrying.and_then(|c| {
            let (i, j) = c.markers?;
            let backward = c.carries.is_some_and(|x| x.1);
            scene.markers[if backward { i } else { j }].part
        });
        let end = carrier.and_then(|p| scene.parts[p].link);
        let mut coordinates = Vec::new();
        let mut at = part.link;
        while at != end {
            let Some(l) = at else { break };
            let own = scene.coordinates.iter().filter(|c| c.link == l);
            coordinates.splice(0..0, own.map(|c| c.id.to_string()));
            at = scene.links[l].parent;
        }
        let carrier =
            carrier.map_or_else(|| "ground".to_string(), |p| scene.parts[p].id.to_string());
        let by = carrying.map(|c| c.id.to_string());
        if let (Some(by), true) = (&by, coordinates.is_empty()) {
            out.welded.push(format!("{name} to {carrier} by {by}"));
        }
        out.forest.push(Carried {
            part: name,
            by,
            carrier,
            coordinates,
        });
    }
}

fn warnings(of_assembly: Vec<AssemblyWarning>) -> Vec<Warning> {
    of_assembly.into_iter().map(Warning::from).collect()
}
