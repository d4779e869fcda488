//! Elements that are read and written but not solved, and those left out where the user says so,
//! with all that hangs on them.
//!
//! A body that is left out takes with it what is attached to its markers, a joint what drives or
//! couples it, a contact on a curve its floating markers. What is left out exerts nothing, and
//! functions read zero of it; each such function is named in a warning. A kind that becomes solved
//! loses its line here.

use super::build::Builder;
use super::external_inputs::{Hook, closure_for};
use super::untouchable::Untouchable;
use crate::diagnostic::{Cause, Diagnostic};
use crate::expr::measures::{Family as MeasureFamily, Measure};
use crate::expr::program::Input;
use crate::model::{ElementId, ElementKind, Family, Formula, MarkerOwner, Model};
use std::collections::BTreeSet;
use std::fmt;

/// A constraint of which nobody knows what it holds.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// which
    pub id: ElementId,
    /// why nobody does
    pub hidden: Hidden,
}

/// The place where what a constraint holds stands, outside the dataset.
#[derive(Clone, Debug, PartialEq)]
pub enum Hidden {
    /// a routine computes its function
    InRoutine,
    /// a routine computes a CURVE
    CurveInRoutine(ElementId),
    /// the points of a CURVE stand in a file
    CurveInFile {
        /// which
        curve: ElementId,
        /// the file, as the dataset names it
        file: String,
    },
}

impl Hidden {
    /// Returns true if a routine would tell.
    pub fn is_routine(&self) -> bool {
        match self {
            Hidden::InRoutine | Hidden::CurveInRoutine(_) => true,
            Hidden::CurveInFile { .. } => false,
        }
    }
}

impl fmt::Display for Hidden {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Hidden::InRoutine => f.write_str("its function is computed by a routine"),
            Hidden::CurveInRoutine(curve) => write!(f, "{curve} is computed by a routine"),
            Hidden::CurveInFile { curve, file } => {
                write!(f, "the points of {curve} stand in the file {file}")
            }
        }
    }
}

/// The reason why an element is left out.
#[derive(Clone, Debug, PartialEq)]
pub enum Reason {
    /// elements of its kind are not solved
    NotSolved,
    /// a routine computes its force
    Routine,
    /// what it holds does not stand in the dataset
    Hidden(Hidden),
    /// the touches of a contact cannot be found
    Contact(Untouchable),
    /// an element that it cannot be without is left out
    Without(ElementId),
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reason::NotSolved => f.write_str("it is not solved"),
            Reason::Routine => f.write_str("its force is computed by a routine"),
            Reason::Hidden(hidden) => hidden.fmt(f),
            Reason::Contact(why) => why.fmt(f),
            Reason::Without(element) => write!(f, "{element} is left out"),
        }
    }
}

/// Constraints that a routine computes for which there is no closure, or whose curve does not stand
/// in the dataset; inactive ones do not count.
pub fn unknown_constraints(model: &Model, hooks: &[Hook]) -> Vec<Unknown> {
    let is_hidden = |id: ElementId, user: &Formula| closure_for(hooks, id, user).is_none();
    let curve = |id: u32| -> Option<Hidden> {
        let (given, curve) = (model.curves.get(&id)?, ElementKind::Curve.id(id));
        if let Some(user) = &given.function {
            return is_hidden(curve, user).then_some(Hidden::CurveInRoutine(curve));
        }
        let matrix = given.matrix.and_then(|m| model.matrices.get(&m));
        let file = matrix.and_then(|m| m.unread_file())?.to_string();
        Some(Hidden::CurveInFile { curve, file })
    };
    let mut found = Vec::new();
    let mut add = |kind: ElementKind, number, hidden| {
        let id = kind.id(number);
        found.push(Unknown { id, hidden });
    };
    for (&id, p) in &model.points_on_curves {
        if let Some(hidden) = curve(p.curve) {
            add(ElementKind::Ptcv, id, hidden);
        }
    }
    for (&id, c) in &model.curves_on_curves {
        if let Some(hidden) = curve(c.i.curve).or_else(|| curve(c.j.curve)) {
            add(ElementKind::Cvcv, id, hidden);
        }
    }
    for (&id, g) in &model.general_constraints {
        if matches!(g.function, Formula::User { .. }) {
            add(ElementKind::Gcon, id, Hidden::InRoutine);
        }
    }
    for (&id, c) in &model.couplers {
        let user = c.user.as_ref();
        if user.is_some_and(|user| is_hidden(ElementKind::Coupler.id(id), user)) {
            add(ElementKind::Coupler, id, Hidden::InRoutine);
        }
    }
    found.retain(|u| model.is_active(u.id));
    found
}

/// Elements of a model that are left out.
#[derive(Clone, Debug, Default)]
pub struct LeftOut {
    /// elements
    pub elements: BTreeSet<ElementId>,
    /// markers without a frame
    pub markers: BTreeSet<u32>,
    /// errors for what is not solved, warnings for what is left out
    pub told: Vec<Diagnostic>,
}

impl LeftOut {
    /// Of a model; `skip`: kinds of elements that are left out where they are not solved,
    /// `zero_user`: also constraints that routines compute for which there is no closure.
    pub fn of(
        model: &Model,
        skip: &BTreeSet<ElementKind>,
        hooks: &[Hook],
        zero_user: bool,
    ) -> Self {
        let mut this = Self::default();
        for &id in model.others.keys() {
            let kind = id.kind;
            if !model.is_active(id) || !kind.is_unsolved() {
                continue;
            }
            if skip.contains(&kind) {
                this.leave(id, &Reason::NotSolved);
                continue;
            }
            let error = Diagnostic::error(Cause::Unsupported, "is read, but not solved");
            this.told.push(error.element(id).help(format!(
                "--skip-unsupported {kind} leaves all of its kind out; the results are then those of another model"
            )));
        }
        this.old_friction(model, skip);
        for unknown in unknown_constraints(model, hooks) {
            let Unknown { id, hidden } = unknown;
            let on_curve = matches!(id.kind, ElementKind::Ptcv | ElementKind::Cvcv);
            let curve = on_curve && skip.contains(&ElementKind::Curve);
            if skip.contains(&id.kind) || curve || zero_user && hidden.is_routine() {
                this.leave(id, &Reason::Hidden(hidden));
            }
        }
        for (&id, marker) in &model.markers {
            if let MarkerOwner::Other(owner) = marker.owner
                && this.elements.contains(&owner)
            {
                this.markers.insert(id);
            }
        }
        this.spread(model);
        this
    }

    /// Tells of joints whose own argument FRICTION, of datasets older than the statement FRICTION,
    /// asks for friction: it is read, but not solved.
    fn old_friction(&mut self, model: &Model, skip: &BTreeSet<ElementKind>) {
        for (id, joint) in model.active(ElementKind::Joint, &model.joints) {
            let Some(value) = joint.friction.as_deref().filter(|value| *value != "OFF") else {
                continue;
            };
            let told = if skip.contains(&ElementKind::Friction) {
                let what = format!("moves without the friction of FRICTION={value}");
                Diagnostic::warning(Cause::Skipped, what)
            } else {
                let what = format!("FRICTION={value} of a joint is read, but not solved");
                Diagnostic::error(Cause::Unsupported, what)
                    .help("state its friction in a statement FRICTION, which is solved")
                    .help("--skip-unsupported FRICTION moves it without friction; the results are then those of another model")
            };
            self.told.push(told.element(ElementKind::Joint.id(id)));
        }
    }

    fn leave(&mut self, id: ElementId, why: &Reason) {
        if self.elements.insert(id) {
            let warning = Diagnostic::warning(Cause::Skipped, format!("is left out: {why}"));
            self.told.push(warning.element(id));
        }
    }

    /// Leaves out an element that names one that is gone, unless it goes on existing without it.
    fn without(&mut self, element: ElementId, target: ElementId) {
        match element.kind.family() {
            // shapes are gone silently: contacts ask for them
            Family::Output if element.kind == ElementKind::Graphics => {
                self.elements.insert(element);
            }
            // these ask, or are the body itself
            Family::Body | Family::Output => {}
            Family::Constraint | Family::Force | Family::System | Family::Data => {
                self.leave(element, &Reason::Without(target));
            }
        }
    }

    /// Finds the elements that cannot be without those left out.
    fn spread(&mut self, model: &Model) {
        if self.elements.is_empty() {
            return;
        }
        let references = model.references();
        loop {
            for (id, jfloat) in floats(model) {
                if self.elements.contains(&id) {
                    self.markers.extend(jfloat);
                }
            }
            let before = self.elements.len();
            for r in &references {
                let gone = if r.target.kind == ElementKind::Marker {
                    self.markers.contains(&r.target.number)
                } else {
                    self.elements.contains(&r.target)
                };
                if gone && model.is_active(r.element) {
                    self.without(r.element, r.target);
                }
            }
            if self.elements.len() == before {
                return;
            }
        }
    }
}

/// The floating markers that contacts of curves place.
fn floats(model: &Model) -> Vec<(ElementId, Vec<u32>)> {
    let floating = |m: Option<u32>| m.filter(|m| model.markers.get(m).is_some_and(|m| m.floating));
    let points = model.points_on_curves.iter().map(|(&id, p)| {
        let all = floating(p.jfloat).into_iter().collect();
        (ElementKind::Ptcv.id(id), all)
    });
    let curves = model.curves_on_curves.iter().map(|(&id, c)| {
        let all = [c.i.float, c.j.float].into_iter().filter_map(floating);
        (ElementKind::Cvcv.id(id), all.collect())
    });
    points.chain(curves).collect()
}

/// The markers among the numbers of a measure.
fn markers_of(measure: Measure, ids: &[u32; 4]) -> &[u32] {
    match measure.row().family {
        MeasureFamily::Displacement
        | MeasureFamily::Velocity
        | MeasureFamily::Acceleration
        | MeasureFamily::GenericForce => {
            let first = if measure == Measure::Orient { 2 } else { 0 };
            &ids[first..]
        }
        MeasureFamily::ElementForce | MeasureFamily::System => &[],
    }
}

impl super::Scene {
    /// Returns the element of a measure that is left out; the measure is zero then.
    pub(super) fn gone(&self, measure: Measure, ids: &[u32; 4]) -> Option<ElementId> {
        if let Some(element) = super::equations::element_of(measure, ids[0]) {
            return Some(element).filter(|e| self.left_out.elements.contains(e));
        }
        let mut markers = markers_of(measure, ids).iter();
        let gone = markers.find(|m| self.left_out.markers.contains(m));
        gone.map(|&m| ElementKind::Marker.id(m))
    }
}

impl Builder<'_> {
    /// Leaves out one more element, for a reason that only compiling it tells.
    pub(super) fn leave_out(&mut self, id: ElementId, why: &Reason) {
        self.scene.left_out.leave(id, why);
        self.scene.inactive.insert(id);
        self.scene.warnings.append(&mut self.scene.left_out.told);
    }

    /// Names the functions that read something of what is left out.
    pub(super) fn read_zero(&mut self) {
        if self.scene.left_out.elements.is_empty() {
            return;
        }
        let mut told = Vec::new();
        for formula in &self.scene.formulas {
            for input in formula.program.inputs() {
                let Input::Measure(measure, ids) = input else {
                    continue;
                };
                if let Some(what) = self.scene.gone(*measure, ids) {
                    let what = format!(
                        "reads {} of {what}, which is left out: zero",
                        measure.name()
                    );
                    let warning = Diagnostic::warning("reads_zero", what).element(&formula.owner);
                    if !told.contains(&warning) {
                        told.push(warning);
                    }
                }
            }
        }
        self.scene.warnings.append(&mut told);
    }
}
