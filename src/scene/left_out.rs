//! What a model holds that is read and written, but not solved; and what is left out where the user says so, with all that hangs on it.
//!
//! A body that is left out takes with it what is attached to its markers, a joint what drives or couples it, a contact on a curve its
//! floating markers. What is left out exerts nothing, and functions read zero of it; each such function is named in a warning.
//! A kind that becomes solved loses its line here.

use super::build::Builder;
use crate::diagnostic::Diagnostic;
use crate::expr::measures::{Family, Measure};
use crate::expr::program::Input;
use crate::model::reference::Target;
use crate::model::{Formula, MarkerOwner, Model};
use std::collections::BTreeSet;

/// Statements that are not solved, whatever they say.
const UNSOLVED: [&str; 9] = [
    "FLEX_BODY",
    "FE_PART",
    "FE_LOAD",
    "MFORCE",
    "UCON",
    "TIRE",
    "WHEEL",
    "PTSF",
    "CVSF",
];

/// Statements that go on existing when a marker they name is gone: they ask, they are drawn, or they are the body itself.
const PASSIVE: [&str; 6] = [
    "PART",
    "POINT_MASS",
    "MARKER",
    "REQUEST",
    "MREQUEST",
    "SENSOR",
];

/// A constraint of which nobody knows what it holds.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// its statement
    pub keyword: &'static str,
    /// its number
    pub id: u32,
    /// how many equations it stands for
    pub equations: usize,
    /// why: "CURVE/3 is computed by a routine"
    pub why: String,
    /// a routine would tell
    pub routine: bool,
}

/// Constraints that a routine computes, or whose curve does not stand in the dataset; inactive ones do not count.
pub fn unknown_constraints(model: &Model) -> Vec<Unknown> {
    let curve = |id: u32| -> Option<(String, bool)> {
        let curve = model.curves.get(&id)?;
        if curve.function.is_some() {
            return Some((format!("CURVE/{id} is computed by a routine"), true));
        }
        let matrix = curve.matrix.and_then(|m| model.matrices.get(&m));
        let file = matrix.and_then(|m| m.file.as_ref())?;
        let why = format!("the points of CURVE/{id} stand in the file {file}");
        Some((why, false))
    };
    let mut found = Vec::new();
    let mut add = |keyword, id, equations, (why, routine): (String, bool)| {
        found.push(Unknown {
            keyword,
            id,
            equations,
            why,
            routine,
        });
    };
    for (&id, p) in &model.points_on_curves {
        if let Some(why) = curve(p.curve) {
            add("PTCV", id, 2, why);
        }
    }
    for (&id, c) in &model.curves_on_curves {
        if let Some(why) = curve(c.i.curve).or_else(|| curve(c.j.curve)) {
            add("CVCV", id, 2, why);
        }
    }
    let routine = || ("its function is computed by a routine".to_string(), true);
    for (&id, g) in &model.general_constraints {
        if matches!(g.function, Formula::User { .. }) {
            add("GCON", id, 1, routine());
        }
    }
    for (&id, c) in &model.couplers {
        if c.user.is_some() {
            add("COUPLER", id, 1, routine());
        }
    }
    found.retain(|u| !model.inactive.contains(&(u.keyword.to_string(), u.id)));
    found
}

/// What is left out of a model.
#[derive(Clone, Debug, Default)]
pub struct LeftOut {
    /// elements, by keyword and number
    pub elements: BTreeSet<(String, u32)>,
    /// markers without a frame
    pub markers: BTreeSet<u32>,
    /// errors for what is not solved, warnings for what is left out
    pub told: Vec<Diagnostic>,
}

impl LeftOut {
    /// Of a model; `skip`: keywords of statements that are left out where they are not solved, `zero_user`: also constraints that
    /// routines compute.
    pub fn of(model: &Model, skip: &BTreeSet<String>, zero_user: bool) -> Self {
        let mut this = Self::default();
        for (keyword, id) in model.others.keys() {
            let off = model.inactive.contains(&(keyword.clone(), *id));
            if off || !UNSOLVED.contains(&keyword.as_str()) {
                continue;
            }
            if skip.contains(keyword) {
                this.leave(keyword, *id, "it is not solved");
                continue;
            }
            let error = Diagnostic::error("unsupported", "is read, but not solved yet")
                .element(format!("{keyword}/{id}"));
            this.told.push(error.help(format!(
                "--skip-unsupported {keyword} leaves all of its kind out; the results are then those of another model"
            )));
        }
        for unknown in unknown_constraints(model) {
            let Unknown {
                keyword, id, why, ..
            } = &unknown;
            let curve = matches!(*keyword, "PTCV" | "CVCV") && skip.contains("CURVE");
            if skip.contains(*keyword) || curve || zero_user && unknown.routine {
                this.leave(keyword, *id, why);
            }
        }
        for (&id, marker) in &model.markers {
            let MarkerOwner::Other(owner) = marker.owner else {
                continue;
            };
            let gone = |k: &str| this.elements.contains(&(k.to_string(), owner));
            if UNSOLVED.iter().any(|k| gone(k)) {
                this.markers.insert(id);
            }
        }
        this.spread(model);
        this
    }

    fn leave(&mut self, keyword: &str, id: u32, why: &str) {
        if self.elements.insert((keyword.to_string(), id)) {
            let warning = Diagnostic::warning("skipped", format!("is left out: {why}"));
            self.told.push(warning.element(format!("{keyword}/{id}")));
        }
    }

    /// What cannot be without what is left out.
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
                let element = (r.keyword.to_string(), r.id);
                if PASSIVE.contains(&r.keyword) || model.inactive.contains(&element) {
                    continue;
                }
                let target = r.target.keyword();
                let gone = if target == Target::Marker.keyword() {
                    self.markers.contains(&r.number)
                } else {
                    self.elements.contains(&(target.to_string(), r.number))
                };
                if gone && r.keyword == "GRAPHICS" {
                    // what is drawn there; contacts ask for it
                    self.elements.insert(element);
                } else if gone {
                    let why = format!("{target}/{} is left out", r.number);
                    self.leave(r.keyword, r.id, &why);
                }
            }
            if self.elements.len() == before {
                return;
            }
        }
    }
}

/// The floating markers that contacts of curves place.
fn floats(model: &Model) -> Vec<((String, u32), Vec<u32>)> {
    let floating = |m: Option<u32>| m.filter(|m| model.markers.get(m).is_some_and(|m| m.floating));
    let points = model.points_on_curves.iter().map(|(&id, p)| {
        let all = floating(p.jfloat).into_iter().collect();
        (("PTCV".to_string(), id), all)
    });
    let curves = model.curves_on_curves.iter().map(|(&id, c)| {
        let all = [c.i.float, c.j.float].into_iter().filter_map(floating);
        (("CVCV".to_string(), id), all.collect())
    });
    points.chain(curves).collect()
}

/// The markers among the numbers of a measure.
fn markers_of(measure: Measure, ids: &[u32; 4]) -> &[u32] {
    match measure.row().family {
        Family::Displacement | Family::Velocity | Family::Acceleration | Family::GenericForce => {
            let first = if measure == Measure::Orient { 2 } else { 0 };
            &ids[first..]
        }
        Family::ElementForce | Family::System => &[],
    }
}

impl super::Scene {
    /// What of a measure is left out: "CONTACT/3", "MARKER/12"; it is zero then.
    pub(super) fn gone(&self, measure: Measure, ids: &[u32; 4]) -> Option<String> {
        if let Some(keyword) = super::equations::keyword_of(measure) {
            let left = self.left_out.elements.contains(&(keyword.into(), ids[0]));
            return left.then(|| format!("{keyword}/{}", ids[0]));
        }
        let mut markers = markers_of(measure, ids).iter();
        let gone = markers.find(|m| self.left_out.markers.contains(m));
        gone.map(|m| format!("MARKER/{m}"))
    }
}

impl Builder<'_> {
    /// Leaves out one more element, for a reason that only compiling it tells.
    pub(super) fn leave_out(&mut self, keyword: &str, id: u32, why: &str) {
        self.scene.left_out.leave(keyword, id, why);
        self.scene.inactive.insert((keyword.to_string(), id));
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
                    let warning = Diagnostic::warning("skipped", what).element(&formula.name);
                    if !told.contains(&warning) {
                        told.push(warning);
                    }
                }
            }
        }
        self.scene.warnings.append(&mut told);
    }
}
