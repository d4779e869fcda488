//! The element at fault where a model cannot be assembled: the one without which the rest can.
//!
//! In a loop that does not close, the row that stays open is that of any joint around it, and the
//! rest assembles without any of them. The one whose markers are apart where the dataset draws the
//! parts comes first; where all fit as drawn, motions do; then that without which the parts move
//! least.

use super::{leave_out_unknown, skeleton, stand_still, start};
use crate::analysis::start::dataset::Dataset;
use crate::analysis::start::{assemble, misalignment, velocities};
use crate::analysis::warning::AssemblyWarning;
use crate::arrange::Arrange;
use crate::diagnostic::{Cause, Diagnostic};
use crate::model::{ElementId, ElementKind, Family, Model};
use crate::scene::Scene;
use crate::scene::build::Options;
use crate::scene::configuration::Configuration;
use crate::scene::equations::Equations;
use std::collections::BTreeMap;

/// Most constraints that are left out in turn.
const MOST_TRIED: usize = 40;
/// Velocities of the largest scene that is assembled so often.
const MOST_VELOCITIES: usize = 120;
/// Other suspects that a sentence names, at most.
const MOST_NAMED: usize = 5;

/// A constraint without which the rest of the model can be assembled.
struct Suspect {
    id: ElementId,
    /// distance and angle of its markers as drawn, in words
    apart: Option<String>,
    /// largest motion of a part from where it is drawn, relative to the mechanism
    moved: f64,
}

/// Names the element at fault for what assembly says about a model; `said` unchanged where none is
/// found.
pub(in crate::analysis) fn blamed(model: &Model, said: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut model = skeleton(model);
    let mut taken_for_granted = Vec::new();
    stand_still(&mut model, &mut taken_for_granted);
    leave_out_unknown(&mut model, &mut taken_for_granted);
    traced(&model, said)
}

/// The same of a model without what has no influence on its freedoms.
pub(super) fn traced(model: &Model, said: Vec<Diagnostic>) -> Vec<Diagnostic> {
    // a curve that is left, or that has no tangent in common, is fault enough
    if said.iter().any(|d| !d.is(Cause::Assembly)) {
        return said;
    }
    let mut suspects = suspects(model);
    if suspects.is_empty() {
        return said;
    }
    let fits = suspects.iter().all(|s| s.apart.is_none());
    let locked = fits.then(|| locked_without_motions(model)).flatten();
    let blames_motions = fits && locked.is_none();
    let drives = |s: &Suspect| blames_motions && s.id.kind == ElementKind::Motion;
    suspects.arrange_by(|a, b| {
        let first = |s: &Suspect| (s.apart.is_none(), !drives(s));
        // rounding decides nothing
        let moved = |s: &Suspect| (1e6 * s.moved).round();
        let by_number = || (b.id.kind == a.id.kind).then(|| b.id.cmp(&a.id));
        first(a)
            .cmp(&first(b))
            .then(moved(a).total_cmp(&moved(b)))
            // of several motions, the last is the one too many
            .then(by_number().unwrap_or(a.id.cmp(&b.id)))
    });
    vec![accused(model, &suspects, locked.unwrap_or(said))]
}

/// Finds the constraints that lock a mechanism whatever its motions prescribe: those that assembly
/// refuses without them. `None`: there are none, or there are no motions.
pub(in crate::analysis) fn locked_without_motions(model: &Model) -> Option<Vec<Diagnostic>> {
    let motions: Vec<ElementId> = (model.active(ElementKind::Motion, &model.motions))
        .map(|(id, _)| ElementKind::Motion.id(id))
        .collect();
    if motions.is_empty() {
        return None;
    }
    let mut model = skeleton(model);
    model.inactive.extend(motions);
    let scene = Scene::compile(&model, &options()).ok()?;
    let mut q = scene.initial_q.clone();
    let x = start(&scene, &model, &mut q);
    let drawn = Dataset::drawn(&scene, &model, &x);
    let refused = drawn.assemble(&mut Configuration::new(&scene), &mut q);
    let said = refused.err()?;
    said.iter().all(|d| d.is(Cause::Assembly)).then_some(said)
}

/// Makes the message about the first of the suspects.
fn accused(model: &Model, suspects: &[Suspect], said: Vec<Diagnostic>) -> Diagnostic {
    let (first, others) = (&suspects[0], &suspects[1..]);
    let alike = |s: &&Suspect| s.apart.is_some() == first.apart.is_some();
    let alike = others.iter().filter(alike).filter(|s| {
        first.apart.is_some() || s.id.kind == first.id.kind || first.id.kind != ElementKind::Motion
    });
    let mut names: Vec<String> = alike.map(|s| model.called(s.id)).collect();
    let more = names.len().saturating_sub(MOST_NAMED);
    names.truncate(MOST_NAMED);
    let mut names = names.join(", ");
    if more > 0 {
        names += &format!(" and {more} more");
    }
    let message = match (&first.apart, ends(model, first.id)) {
        (Some(apart), Some([i, j])) => format!(
            "its markers {} and {} are off by {apart} where the dataset places the parts, \
             and the mechanism cannot make up for it; without it the rest assembles",
            model.called(ElementKind::Marker.id(i)),
            model.called(ElementKind::Marker.id(j))
        ),
        _ if first.id.kind == ElementKind::Motion && !names.is_empty() => {
            format!("it contradicts {names}: without one of them the rest assembles")
        }
        _ => "it contradicts the others: without it the rest of the model assembles".to_owned(),
    };
    let mut d = Diagnostic::error(Cause::Assembly, message).element(first.id);
    if first.id.kind != ElementKind::Motion && !names.is_empty() {
        d = d.help(format!("so it does without {names}"));
    }
    for said in said.iter().take(MOST_NAMED) {
        let element = said.subject().unwrap_or_default();
        let name = element
            .element
            .parse()
            .ok()
            .and_then(|id| model.element(id));
        let element = element.named(name.and_then(|e| e.place().name.as_deref()));
        d = d.help(format!("with it {element} {}", said.message));
    }
    d.help
        .extend(said.into_iter().next().into_iter().flat_map(|s| s.help));
    d
}

/// The numbers of the two markers of a tie.
fn ends(model: &Model, id: ElementId) -> Option<[u32; 2]> {
    model.element(id)?.ends()
}

/// Finds the constraints without which the rest assembles.
fn suspects(model: &Model) -> Vec<Suspect> {
    let Ok(scene) = Scene::compile(model, &options()) else {
        return Vec::new();
    };
    let apart: BTreeMap<ElementId, String> = misalignment::misaligned(&scene, model)
        .iter()
        .filter_map(|w| match w {
            AssemblyWarning::Misaligned {
                element,
                offset,
                unit,
                turn,
            } => Some((*element, AssemblyWarning::apart(offset, unit, turn))),
            _ => None,
        })
        .collect();
    let of = |kind: ElementKind| model.numbers(kind).into_iter().map(move |n| kind.id(n));
    let mut all: Vec<ElementId> = ElementKind::of(Family::Constraint)
        .flat_map(of)
        .filter(|&id| model.is_active(id))
        .collect();
    if all.len() > MOST_TRIED {
        all.retain(|id| apart.contains_key(id));
    }
    if scene.layout.n_v > MOST_VELOCITIES || all.len() > MOST_TRIED {
        return Vec::new();
    }
    let suspect = |id: ElementId| {
        Some(Suspect {
            id,
            apart: apart.get(&id).cloned(),
            moved: moved_without(model, id)?,
        })
    };
    all.into_iter().filter_map(suspect).collect()
}

fn options() -> Options {
    Options {
        mode: 4,
        skip: super::outline::pushing(),
        ..Options::default()
    }
}

/// Assembles a model without one of its constraints, and those that name it; returns the largest
/// motion of a part from where it is drawn. `None`: the rest contradicts itself.
fn moved_without(model: &Model, id: ElementId) -> Option<f64> {
    let mut model = model.clone();
    let naming: Vec<ElementId> = (model.references().iter())
        .filter(|r| r.target == id)
        .map(|r| r.element)
        .collect();
    model.inactive.insert(id);
    model.inactive.extend(naming);
    let scene = Scene::compile(&model, &options()).ok()?;
    let mut configuration = Configuration::new(&scene);
    let mut q = scene.initial_q.clone();
    let x = start(&scene, &model, &mut q);
    let drawn = Dataset::drawn(&scene, &model, &x);
    drawn.assemble(&mut configuration, &mut q).ok()?;
    let here = scene.within(&configuration);
    velocities::velocities(here, &model, 0.0, &q, &x).ok()?;
    let numbers = assemble::numbers(here, 0.0, &q, &vec![0.0; scene.layout.n_v], &x);
    let at = Equations::new(here, &numbers);
    let moved = (scene.parts.iter().enumerate()).map(|(k, part)| {
        let now = at.part(k, false);
        let by = (now.p_GM - part.initial.position).norm() / scene.length;
        let turned = (0..3).map(|k| (now.R_GM.column(k) - part.initial.rotation.column(k)).norm());
        turned.fold(by, f64::max)
    });
    Some(moved.fold(0.0, f64::max))
}
