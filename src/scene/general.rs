//! GCON: a constraint that is written as an expression, zero where it holds.
//!
//! ```text
//! e(places, t) = 0                (1)   holonomic
//! e(places, velocities, t) = 0    (2)   an equation of velocities: rolling, a knife edge
//! ```
//!
//! The expression may read displacements, angles and velocities of markers, TIME, MODE, numbers of
//! ARRAYs and VARIABLEs of these. The gradient of (1) is the chain of ∂e/∂(what it reads) and what
//! each of these does along the twists of its markers; that of (2) is the same along their
//! velocities. The rates are jets in time.
//!
//! An equation of velocities holds the velocities and no position, whether or not it is the rate of
//! something. It is one of the rows: its rate is an equation of accelerations, as the second rate
//! of (1) is. At rest it says nothing where it is zero without velocities; where it is not, nothing
//! can rest.
//!
//! *Reaction*: λ ∂e/∂(twist), and of (2) λ ∂e/∂(velocity) (Chetaev), which does no work where (2)
//! is linear in the velocities without a further term. The unit is that of force where e is a
//! length, or a speed. The reaction of a GCON is what acts on the part of its I marker, about that
//! marker, and is read as FX(I, J) … with J the other marker that e reads.

use super::asker::Asker;
use super::build::Builder;
use super::compile::Compiler;
use super::configuration::Configuration;
use super::equations::{Equations, STATIC};
use super::reads::{Allowed, offence};
use super::{ConstraintElement, Entry, Row, RowKind, Scene};
use crate::diagnostic::Diagnostic;
use crate::expr::measures::{Family, Measure};
use crate::expr::program::Input;
use crate::model::ElementKind;
use std::collections::BTreeSet;

/// Change of a GCON's expression that is rounding, as a part of the mechanism's length or of
/// 1 rad.
const IDLE_CHANGE: f64 = 1e-11;

impl Builder<'_> {
    /// One row for each GCON.
    pub(super) fn general(&mut self, c: &mut Compiler) {
        let model = self.model;
        for (id, gcon) in model.active(ElementKind::Gcon, &model.general_constraints) {
            let name = ElementKind::Gcon.id(id);
            let formula = self.formula(c, &Asker::argument(name, "FUNCTION"), &gcon.function);
            if formula >= self.scene.formulas.len() {
                continue;
            }
            if let Some(offence) = offence(&self.scene, formula, Allowed::Motion) {
                c.errors.push(
                    Diagnostic::error("gcon_reads", offence.rest(model))
                        .element(name)
                        .help("a GCON relates places or velocities: displacements, angles and velocities of markers, TIME, and VARIABLEs of these"),
                );
                continue;
            }
            for f in formulas_read(&self.scene, formula) {
                let f = &mut self.scene.formulas[f];
                f.gradient = Some(f.program.with_gradient(f.program.inputs()));
            }
            let read = markers_read(&self.scene, formula);
            let of_velocities = reads_velocities(&self.scene, formula);
            if of_velocities && self.scene.mode == STATIC {
                let what = "at rest it holds nothing, as it is an equation of velocities: what it would keep from moving is moved by its load";
                let warning = Diagnostic::warning("gcon_at_rest", what).element(name);
                self.scene.warnings.push(warning);
            }
            let about = match gcon.i {
                Some(i) => c.marker(i, name),
                None => None,
            };
            let part = |m: usize| self.scene.markers[m].part;
            let acts_on: Vec<usize> = match about {
                Some(i) => read
                    .iter()
                    .copied()
                    .filter(|&m| part(m) == part(i))
                    .collect(),
                None => Vec::new(),
            };
            let mut others = read.iter().copied().filter(|m| !acts_on.contains(m));
            let markers = match (about, others.next(), others.next()) {
                (Some(i), Some(j), None) => Some((i, j)),
                _ => None,
            };
            let first = self.scene.rows.len();
            self.scene.rows.push(Row {
                element: name,
                equation: "FUNCTION".into(),
                kind: RowKind::Formula {
                    formula,
                    scale: 1.0,
                    of_velocities,
                },
            });
            let read = read.into_iter().filter(|_| of_velocities);
            self.scene.constraints.push(ConstraintElement {
                joins: read.collect(),
                id: name,
                markers,
                acts_on,
                about,
                carries: None,
                laws: &[],
                rows: first..first + 1,
                coordinate: None,
            });
        }
    }

    /// Finds what counts as one for the expressions of GCON and the routines of COUPLER: how much
    /// they change as coordinates (or velocities) change by one (angles) or by the size of the
    /// mechanism (lengths).
    pub(super) fn natural_sizes(&mut self) {
        let scene = &self.scene;
        let is_asked = |row: &Row| match &row.kind {
            RowKind::Formula { .. } => true,
            RowKind::Displacements(sum) => sum.coupled.is_some(),
            RowKind::Markers { .. } | RowKind::Cam { .. } => false,
        };
        if !scene.rows.iter().any(is_asked) {
            return;
        }
        let mut numbers = vec![0.0; scene.layout.len()];
        numbers[scene.layout.q()].copy_from_slice(&scene.initial_q);
        numbers[scene.layout.v()].copy_from_slice(&scene.velocities_of_rows());
        let undecided = Configuration::new(scene);
        let at = Equations::<f64>::new(scene.within(&undecided), &numbers);
        let weights = super::programs::weights(scene);
        let sizes: Vec<Option<f64>> = (scene.rows.iter().enumerate())
            .map(|(r, row)| {
                if !is_asked(row) {
                    return None;
                }
                let gradient = at.row(r).gradient.clone();
                let size = gradient
                    .iter()
                    .map(|&(v, g)| g.abs() * weights[v].sqrt())
                    .fold(0.0, f64::max);
                // what moves nothing changes by rounding alone
                let idle = scene.length.max(1.0);
                Some(if size > IDLE_CHANGE * idle && size.is_finite() {
                    size
                } else {
                    idle
                })
            })
            .collect();
        for (row, size) in self.scene.rows.iter_mut().zip(sizes) {
            match (&mut row.kind, size) {
                (RowKind::Formula { scale, .. }, Some(size)) => *scale = size,
                (RowKind::Displacements(sum), Some(size)) => {
                    sum.coupled.iter_mut().for_each(|c| c.scale = size);
                }
                _ => {}
            }
        }
    }
}

impl Scene {
    /// Returns whether there are equations of velocities.
    pub fn has_rows_of_velocities(&self) -> bool {
        self.rows.iter().any(Row::is_of_velocities)
    }

    /// Returns velocities at which it is asked what rows say: zero, or where some are equations of
    /// velocities about one radian and one size of the mechanism per unit of time, no two alike, so
    /// that nothing that they read vanishes unless it always does   (n_v)
    pub(crate) fn velocities_of_rows(&self) -> Vec<f64> {
        let n = self.layout.n_v;
        if !self.has_rows_of_velocities() {
            return vec![0.0; n];
        }
        let weights = super::programs::weights(self).into_iter().enumerate();
        let velocity = |(k, w): (usize, f64)| w.sqrt() * (1.0 + k as f64 / n as f64);
        weights.map(velocity).collect()
    }
}

/// A formula and those of the VARIABLEs it reads.
fn formulas_read(scene: &Scene, formula: usize) -> BTreeSet<usize> {
    let (mut seen, mut next) = (BTreeSet::new(), vec![formula]);
    while let Some(f) = next.pop() {
        if f >= scene.formulas.len() || !seen.insert(f) {
            continue;
        }
        for input in scene.formulas[f].program.inputs() {
            match input {
                Input::Measure(Measure::Varval, [v, ..]) => next.extend(scene.variables.get(v)),
                Input::Measure(Measure::Aryval, [a, k, ..]) => {
                    let entries = scene.arrays.get(a).map_or(&[][..], Vec::as_slice);
                    let entry = (*k as usize).checked_sub(1).and_then(|k| entries.get(k));
                    if let Some(Entry::Formula(f)) = entry {
                        next.push(*f);
                    }
                }
                _ => {}
            }
        }
    }
    seen
}

/// Returns the inputs of a formula and of the VARIABLEs that it reads.
fn inputs_read(scene: &Scene, formula: usize) -> Vec<Input> {
    let all = formulas_read(scene, formula).into_iter();
    let inputs = all.flat_map(|f| scene.formulas[f].program.inputs().iter().copied());
    inputs.collect()
}

/// Returns whether a formula reads velocities of markers.
fn reads_velocities(scene: &Scene, formula: usize) -> bool {
    let is_velocity = |input: &Input| match input {
        Input::Measure(m, _) => m.row().family == Family::Velocity,
        _ => false,
    };
    inputs_read(scene, formula).iter().any(is_velocity)
}

/// The markers that a formula of places and velocities reads; ground as such (identifier 0) is
/// none.
fn markers_read(scene: &Scene, formula: usize) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    for input in inputs_read(scene, formula) {
        if let Input::Measure(m, ids) = input
            && matches!(m.row().family, Family::Displacement | Family::Velocity)
        {
            // the first two arguments of ORIENT are no markers
            let first = if m == Measure::Orient { 2 } else { 0 };
            found.extend(ids[first..].iter().filter_map(|id| scene.marker_of.get(id)));
        }
    }
    found
}
