//! Degrees of freedom that explain themselves: both counts, what is fixed twice, and what is free.
//!
//! ```text
//! Gruebler   6 per part + 3 per point mass − equations of all constraints
//! freedom    coordinates of the forest − rank of the rows that close loops, at the assembled position
//! ```
//!
//! An equation of velocities (a GCON that reads them) counts as the others do: freedom is that of
//! velocities, and positions have so many more. Both counts differ by the rows that depend on
//! others. Each of these is told with the elements that fix
//! the same direction already: those that can be stressed against it without any load
//! (`scene/equations/stress.rs`). Whether the dependence is one of this position only is found out
//! at positions nearby.

mod advice;
mod axes;
pub(in crate::analysis) mod culprit;
pub(in crate::analysis) mod driving;
mod free;
pub(crate) mod idle;
mod json;
pub(crate) mod massless;
pub(crate) mod outline;

pub use advice::{Advice, Change};
pub use axes::Axes;
pub use free::{Free, Moving};

use crate::analysis::direction::Direction;
use crate::analysis::start::assemble::{self, Assembly};
use crate::analysis::start::dataset::Dataset;
use crate::analysis::start::nearby::Place;
use crate::analysis::start::{initial_conditions, misalignment, velocities};
use crate::analysis::warning::{VerificationWarning, Warning};
use crate::diagnostic::{Diagnostic, Error};
use crate::expr::measures::Measure;
use crate::expr::program::Input;
use crate::model::{ElementId, ElementKind, Family, Formula, Level, Model};
use crate::scene::Scene;
use crate::scene::build::Options;
use crate::scene::configuration::{Configuration, Configured};
use crate::scene::equations::{Equations, row_name};
use crate::scene::left_out::{Unknown, unknown_constraints};
use std::collections::{BTreeMap, BTreeSet};

/// Stress in an element, relative to the largest in the state, below which it takes no part.
const LEAST_STRESS: f64 = 1e-7;

/// A row that depends on others.
#[derive(Clone, Debug, PartialEq)]
pub struct Dependent {
    /// "JOINT/4 Zi.Xj"
    pub row: String,
    /// its equation alone: "Zi.Xj"
    pub equation: String,
    /// the constraint whose row it is
    pub element: ElementId,
    /// the motion it forbids
    pub direction: Direction,
    /// elements that fix the same already, carriers first
    pub fixed_by: Vec<ElementId>,
    /// factors of the rows it is a combination of; rows of joints that carry parts are not among
    /// them
    pub combination: Vec<(String, f64)>,
    /// it depends on others at this position, but not nearby
    pub only_here: bool,
    /// it is the row of a MOTION, which drives rather than fixes
    pub drives: bool,
}

impl Dependent {
    /// Tells it in a sentence: "JOINT/4 fixes rotation about ground X, already fixed by JOINT/1,
    /// JOINT/2".
    pub fn sentence(&self) -> String {
        self.sentence_of(&[self], &|id| id.to_string())
    }

    /// Tells it of several rows of the same element that the same elements fix already; `called`
    /// names the elements.
    pub fn sentence_of(&self, rows: &[&Dependent], called: &dyn Fn(ElementId) -> String) -> String {
        let verb = if self.drives { "drives" } else { "fixes" };
        let directions: Vec<String> = rows.iter().map(|d| d.direction.to_string()).collect();
        let element = called(self.element);
        let mut text = format!("{element} {verb} {}", directions.join(", "));
        if self.fixed_by.is_empty() {
            text += ", though the parts it ties cannot move against each other";
        } else {
            text += &format!(", already fixed by {}", listed(&self.fixed_by, called));
        }
        if self.only_here {
            text += " (at this position only)";
        }
        text
    }
}

/// Returns the names of elements in a row, each as `called` says: "JOINT/1, JOINT/2".
pub fn listed<'a>(
    elements: impl IntoIterator<Item = &'a ElementId>,
    called: &dyn Fn(ElementId) -> String,
) -> String {
    let names: Vec<String> = elements.into_iter().map(|&id| called(id)).collect();
    names.join(", ")
}

/// An element whose reaction is not determined.
#[derive(Clone, Debug, PartialEq)]
pub struct Undetermined {
    /// the constraint
    pub element: ElementId,
    /// of FX FY FZ TX TY TZ
    pub components: Vec<&'static str>,
    /// in whose axes
    pub axes: Axes,
}

/// The freedoms of a model, explained.
#[derive(Clone, Debug, Default)]
pub struct Verification {
    /// moving parts
    pub parts: usize,
    /// moving point masses
    pub point_masses: usize,
    /// constraint elements and equations, by statement: (keyword or type, how many, equations of
    /// all of them)
    pub counted: Vec<(String, usize, usize)>,
    /// the count
    pub gruebler: i64,
    /// from the rank at the assembled position; `None` when there is none
    pub freedom: Option<usize>,
    /// from the rank near it
    pub freedom_nearby: Option<usize>,
    /// positions that are free near it: more than velocities by the equations of velocities
    pub freedom_of_position: Option<usize>,
    /// rows that depend on others at the assembled position
    pub dependent: Vec<Dependent>,
    /// reactions that are not unique
    pub undetermined: Vec<Undetermined>,
    /// what could be changed
    pub advice: Vec<Advice>,
    /// free directions
    pub free: Vec<Free>,
    /// rows that cannot be satisfied
    pub inconsistent: Vec<Diagnostic>,
    /// what else the user should know
    pub warnings: Vec<Warning>,
    /// iterations of the assembly, and the largest change of a coordinate
    pub assembly: (usize, f64),
}

impl Verification {
    fn warn(&mut self, warnings: impl IntoIterator<Item = impl Into<Warning>>) {
        self.warnings.extend(warnings.into_iter().map(Into::into));
    }

    /// Returns the sentences of its warnings.
    pub fn warned(&self) -> Vec<String> {
        self.warnings.iter().map(ToString::to_string).collect()
    }

    /// Names of the rows that depend on others.
    pub fn redundant(&self) -> Vec<&str> {
        self.dependent.iter().map(|d| d.row.as_str()).collect()
    }
}

/// Returns the model without all that has no influence on its freedoms.
fn skeleton(model: &Model) -> Model {
    let mut model = model.clone();
    let idle = |kind: &ElementKind| match kind.family() {
        // what motions and constraints read
        Family::Body | Family::Constraint | Family::Data => false,
        Family::System => *kind != ElementKind::Variable,
        Family::Force | Family::Output => true,
    };
    let solved = ElementKind::ALL.iter().copied().filter(|k| k.is_solved());
    for kind in solved.filter(idle) {
        model.clear(kind);
    }
    for joint in model.joints.values_mut() {
        joint.friction = None;
    }
    model
}

/// Sets variables that routines compute to zero, as their values are not known; motions that depend
/// on them keep the place that the dataset shows.
fn stand_still(model: &mut Model, warnings: &mut Vec<Warning>) {
    let mut unknown: BTreeSet<u32> = BTreeSet::new();
    for (&id, variable) in &mut model.variables {
        if matches!(variable.function, Formula::User { .. }) {
            variable.function = Formula::text("0");
            unknown.insert(id);
        }
    }
    let reads = |function: &Formula, unknown: &BTreeSet<u32>| match function {
        Formula::User { .. } => true,
        Formula::Expression { text, .. } => text.expression().is_ok_and(|expr| {
            let mut inputs = expr.inputs().into_iter();
            inputs.any(|input| match input {
                Input::Measure(Measure::Varval, [id, ..]) => unknown.contains(&id),
                _ => false,
            })
        }),
    };
    // variables of such variables
    loop {
        let more: Vec<u32> = (model.variables.iter())
            .filter(|(id, v)| !unknown.contains(id) && reads(&v.function, &unknown))
            .map(|(id, _)| *id)
            .collect();
        if more.is_empty() {
            break;
        }
        unknown.extend(more);
    }
    for (id, motion) in &mut model.motions {
        if reads(&motion.function, &unknown) {
            motion.function = Formula::text("0");
            motion.level = Level::Velocity;
            (motion.ic_displacement, motion.ic_velocity) = (None, None);
            let motion = ElementKind::Motion.id(*id);
            warnings.push(VerificationWarning::StandsStill(motion).into());
        }
    }
}

/// Constraints that a routine computes, or whose curve does not stand in the dataset, are counted,
/// but cannot be among the rows: nobody knows what they hold.
fn leave_out_unknown(model: &mut Model, warnings: &mut Vec<Warning>) {
    for unknown in unknown_constraints(model, &[]) {
        let Unknown { id, hidden } = unknown;
        let counted = VerificationWarning::UnknownConstraint {
            element: id,
            equations: equations(model, id).unwrap_or(0),
            hidden,
        };
        warnings.push(counted.into());
        model.inactive.insert(id);
    }
}

/// Returns how many equations a constraint stands for; `None` for what is no constraint, or not
/// solved.
fn equations(model: &Model, id: ElementId) -> Option<usize> {
    model.element(id)?.equations()
}

/// The statement of a constraint, with its type where it has several.
fn statement(model: &Model, id: ElementId) -> String {
    let joint = model.joints.get(&id.number);
    let primitive = model.primitives.get(&id.number);
    match (id.kind, joint, primitive) {
        (ElementKind::Joint, Some(joint), _) => format!("{} {}", id.kind, joint.kind.keyword()),
        (ElementKind::Jprim, _, Some(p)) => format!("{} {}", id.kind, p.kind.row().keyword),
        _ => id.kind.to_string(),
    }
}

/// Equations of the constraints of a model: (what, how many elements, equations of all).
fn counted(model: &Model) -> Vec<(String, usize, usize)> {
    let mut found: BTreeMap<String, (usize, usize)> = BTreeMap::new();
    let mut add = |what: String, equations: usize| {
        let entry = found.entry(what).or_default();
        *entry = (entry.0 + 1, entry.1 + equations);
    };
    for kind in ElementKind::of(Family::Constraint) {
        let all = model.numbers(kind).into_iter().map(|n| kind.id(n));
        for id in all.filter(|&id| model.is_active(id)) {
            if let Some(equations) = equations(model, id) {
                add(statement(model, id), equations);
            }
        }
    }
    found.into_iter().map(|(k, (n, e))| (k, n, e)).collect()
}

/// Verifies a model: counts, assembles, and explains its freedoms.
///
/// # Errors
/// Mistakes that keep the model from being assembled at all. Rows that contradict each other are no
/// such error.
pub fn verify(model: &Model) -> Result<Verification, Error> {
    model.checked()?;
    // the model without all that has no influence on its freedoms
    let mut model = skeleton(model);
    let mut warnings = Vec::new();
    stand_still(&mut model, &mut warnings);
    let counted = counted(&model);
    leave_out_unknown(&mut model, &mut warnings);
    let options = Options {
        mode: 4,
        skip: outline::pushing(),
        ..Options::default()
    };
    let scene = Scene::compile(&model, &options)?;
    warnings.extend(scene.warnings.iter().cloned().map(Warning::Scene));
    // its assembled position
    let mut found = count(&model, counted, warnings);
    let misaligned = misalignment::misaligned(&scene, &model);
    found.warn(misaligned);
    let mut configuration = Configuration::new(&scene);
    let mut q = scene.initial_q.clone();
    let x = start(&scene, &model, &mut q);
    let drawn = Dataset::drawn(&scene, &model, &x);
    let (assembly, starts) = match drawn.assemble(&mut configuration, &mut q) {
        Ok(assembled) => assembled,
        Err(contradictions) => {
            found.inconsistent = culprit::traced(&model, contradictions);
            return Ok(found);
        }
    };
    // its freedoms there
    let scene = scene.within(&configuration);
    match velocities::velocities(scene, &model, 0.0, &q, &x) {
        // a motion by acceleration may begin at any velocity: a run finds that of the mechanism
        Ok(_) if begins_at_any_velocity(&model) => {}
        Ok(v) => found.warn(velocities::unmet(scene, &model, 0.0, (&q, &v, &x))),
        Err(contradictions) => found.inconsistent = culprit::traced(&model, contradictions),
    }
    found.warn(assembly.warnings.iter().cloned());
    found.warn(misalignment::orders(&scene, &model));
    let conditions = initial_conditions::collect(&scene, &model);
    let unmet = initial_conditions::unmet(scene, &conditions, &starts, 0.0, &q, &x);
    found.warn(unmet);
    found.examine(scene, &model, &assembly, (&q, &x));
    Ok(found)
}

/// Returns whether a motion gives an acceleration, and nothing says with which velocity it begins.
fn begins_at_any_velocity(model: &Model) -> bool {
    let motions = model.active(ElementKind::Motion, &model.motions);
    let mut waits = motions.map(|m| m.1.level == Level::Acceleration && m.1.ic_velocity.is_none());
    waits.any(|waits| waits)
}

/// Counts parts and equations.
fn count(
    model: &Model,
    counted: Vec<(String, usize, usize)>,
    warnings: Vec<Warning>,
) -> Verification {
    let moving = |kind: ElementKind| {
        let bodies = model.bodies().filter(|(id, _)| id.kind == kind);
        let moving = bodies.filter(|(id, part)| !part.ground && model.is_active(*id));
        moving.count()
    };
    let parts = moving(ElementKind::Part);
    let point_masses = moving(ElementKind::PointMass);
    let equations: usize = counted.iter().map(|c| c.2).sum();
    Verification {
        parts,
        point_masses,
        counted,
        gruebler: (6 * parts + 3 * point_masses) as i64 - equations as i64,
        warnings,
        ..Verification::default()
    }
}

impl Verification {
    /// Examines the freedoms of an assembled model.
    fn examine(
        &mut self,
        scene: Configured<'_>,
        model: &Model,
        assembly: &Assembly,
        (q, x): (&[f64], &[f64]),
    ) {
        self.assembly = (assembly.iterations, assembly.moved);
        self.freedom = Some(assembly.freedom_here);
        self.freedom_nearby = Some(assembly.freedom);
        self.freedom_of_position = Some(assembly.freedom + assembly.of_velocities);
        let numbers = assemble::numbers(scene, 0.0, q, &vec![0.0; scene.layout.n_v], x);
        let turned = misalignment::turned(scene, model, &numbers, true);
        self.warn(turned);
        explain(scene, &numbers, assembly, self);
        self.free = free::motions(scene, model, 0.0, q, x);
        self.advice = advice::advice(scene, &numbers, assembly);
        let massless = massless::massless(scene, model, 0.0, q, x);
        self.warn(massless.into_iter().map(VerificationWarning::Massless));
        let (here, nearby) = (assembly.freedom_here, assembly.freedom);
        if here != nearby {
            self.warn([VerificationWarning::FreedomNearby { here, nearby }]);
        }
    }
}

/// Returns starting values of the states, and puts in those of joints.
pub(super) fn start(scene: &Scene, model: &Model, q: &mut [f64]) -> Vec<f64> {
    initial_conditions::initial_joints(scene, model, q);
    let mut x = vec![0.0; scene.layout.n_x];
    for (m, motion) in scene.motions.iter().enumerate() {
        let given = model
            .motions
            .get(&motion.id)
            .and_then(|m| m.ic_displacement);
        if let Some(state) = motion.state {
            x[state] = given
                .or_else(|| scene.initial_displacement(m))
                .unwrap_or(0.0);
        }
    }
    x
}

/// Explains dependent rows, and finds the reactions that they leave undetermined.
fn explain(scene: Configured<'_>, numbers: &[f64], assembly: &Assembly, found: &mut Verification) {
    let at = Equations::new(scene, numbers);
    let permanent: Vec<usize> = assembly.redundant.iter().map(|r| r.row).collect();
    let extra = assembly.dependent.len().saturating_sub(permanent.len());
    let mut here_only: Vec<usize> = assembly
        .dependent
        .iter()
        .map(|d| d.row)
        .filter(|r| !permanent.contains(r))
        .collect();
    here_only.truncate(extra);
    let mut open: Vec<[bool; 6]> = vec![[false; 6]; scene.constraints.len()];
    for d in &assembly.dependent {
        let mut lambda = vec![0.0; scene.rows.len()];
        lambda[d.row] = 1.0;
        for &(r, factor) in &d.combination {
            lambda[r] = -factor;
        }
        let stress = at.stress(&lambda);
        let size = |f: f64, t: f64| f.abs().max(t.abs() / scene.length);
        let largest = stress
            .iter()
            .map(|a| size(a.force.norm(), a.torque.norm()))
            .fold(0.0, f64::max);
        let own = scene
            .constraints
            .iter()
            .position(|c| c.rows.contains(&d.row));
        let mut fixed_by = Vec::new();
        for (c, action) in stress.iter().enumerate() {
            let element = &scene.constraints[c];
            let takes_part = size(action.force.norm(), action.torque.norm())
                > LEAST_STRESS * largest
                || element.rows.clone().any(|r| lambda[r] != 0.0);
            if !takes_part {
                continue;
            }
            let (_, R) = axes::of(&at, element.markers.map(|m| m.1));
            for k in 0..3 {
                let e = R.column(k);
                open[c][k] |= e.dot(action.force).abs() > LEAST_STRESS * largest;
                open[c][k + 3] |=
                    e.dot(action.torque).abs() > LEAST_STRESS * largest * scene.length;
            }
            if own != Some(c) {
                fixed_by.push(element.id);
            }
        }
        let row = &scene.rows[d.row];
        found.dependent.push(Dependent {
            row: d.name.clone(),
            equation: row.equation.clone(),
            element: row.element,
            direction: Direction::of_row(&scene, &at, d.row),
            fixed_by,
            combination: (d.combination.iter())
                .map(|&(r, f)| (row_name(&scene.rows[r]), f))
                .collect(),
            only_here: here_only.contains(&d.row),
            drives: own.is_some_and(|c| scene.constraints[c].id.kind == ElementKind::Motion),
        });
    }
    const COMPONENTS: [&str; 6] = ["FX", "FY", "FZ", "TX", "TY", "TZ"];
    for (element, open) in scene.constraints.iter().zip(open) {
        let components: Vec<&str> = (0..6).filter(|&k| open[k]).map(|k| COMPONENTS[k]).collect();
        if !components.is_empty() {
            found.undetermined.push(Undetermined {
                element: element.id,
                components,
                axes: axes::of(&at, element.markers.map(|m| m.1)).0,
            });
        }
    }
}

/// Returns the configuration and the numbers of a place nearby.
fn numbers_at(scene: Configured<'_>, place: &Place) -> (Configuration, Vec<f64>) {
    let there = scene.configuration.with_motions_at(&place.motions);
    let l = scene.layout;
    let (v, x) = (vec![0.0; l.n_v], vec![0.0; l.n_x]);
    let numbers = assemble::numbers(scene.within(&there), 0.0, &place.q, &v, &x);
    (there, numbers)
}
