//! Where solving spends its time: counts of what a method did, times what each costs.
//!
//! Runs carry no clocks for it. At the state that a run has left, an evaluation of the rates and
//! one of their derivatives are timed; within an evaluation the operations of the recorded programs
//! are counted, from positions to forces to accelerations:
//!
//! ```text
//! sweeps         positions and velocities of all parts
//! language       functions and the laws of forces      beyond those operations
//! contact        solids that touch                     beyond those
//! accelerations  masses, rows, elimination             beyond those
//! derivatives    Jacobians
//! steps          the rest: matrices of the method, its sums, projection, events, outputs
//! ```

use crate::analysis::system::System;
use crate::clock::Moment;
use crate::model::ElementKind;
use crate::numeric::Ode;
use crate::results::Counts;
use crate::scalar::Scalar;
use crate::scene::equations::Equations;
use crate::scene::layout::Layout;
use crate::scene::programs::record;

/// Evaluations of a batch, and batches, of which the fastest counts.
const BATCH: [usize; 2] = [20, 8];
/// Time that a measurement may take at most, in s.
const MOST_MEASURING: f64 = 0.1;

/// Parts of the time of solving, in s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Profile {
    /// positions and velocities of all parts
    pub sweeps: f64,
    /// functions, and the laws of forces
    pub language: f64,
    /// solids that touch
    pub contact: f64,
    /// masses, rows, and their elimination
    pub accelerations: f64,
    /// derivatives of the rates
    pub derivatives: f64,
    /// the rest: matrices and sums of the method, projection, events, outputs
    pub steps: f64,
}

impl Profile {
    /// Returns all parts with their names.
    pub fn parts(&self) -> [(&'static str, f64); 6] {
        [
            ("sweeps", self.sweeps),
            ("language", self.language),
            ("contact", self.contact),
            ("accelerations", self.accelerations),
            ("derivatives", self.derivatives),
            ("steps", self.steps),
        ]
    }
}

/// Returns where a run that did so much spent the time `solve`, in s.
pub(super) fn of(system: &mut System, counts: &Counts, solve: f64) -> Profile {
    let evaluation = evaluation(system);
    let jacobian = if counts.jacobians > 0 {
        jacobian(system)
    } else {
        0.0
    };
    let rates = evaluation * counts.evaluations as f64;
    let derivatives = jacobian * counts.jacobians as f64;
    // what was timed warm is no more than all of it
    let fits = (solve / (rates + derivatives).max(f64::MIN_POSITIVE)).min(1.0);
    let [sweeps, language, contact, accelerations] = parts(system).map(|part| part * rates * fits);
    Profile {
        sweeps,
        language,
        contact,
        accelerations,
        derivatives: derivatives * fits,
        steps: (solve - (rates + derivatives) * fits).max(0.0),
    }
}

/// Returns the parts of the operations of an evaluation: sweeps, language, contact, the rest.
fn parts(system: &System) -> [f64; 4] {
    let scene = system.configured();
    let whole = system.operations().max(1) as f64;
    let is_contact = |kind: ElementKind| kind == ElementKind::Contact;
    let counted = |forces: &dyn Fn(ElementKind) -> bool| {
        let program = record(scene, |at| {
            let mut out = places(at, scene.parts.len());
            for force in scene.forces.iter().filter(|f| forces(f.id.kind)) {
                if let Some(action) = at.action_of(force.id) {
                    out.extend(action.force.0);
                    out.extend(action.torque.0);
                }
            }
            out
        });
        program.map_or(0.0, |p| p.n_operations() as f64 / whole)
    };
    let sweeps = counted(&|_| false).min(1.0);
    let language = counted(&|kind| !is_contact(kind)).clamp(sweeps, 1.0);
    let contact = counted(&|_| true).clamp(language, 1.0);
    [sweeps, language - sweeps, contact - language, 1.0 - contact]
}

/// Returns positions and velocities of all parts.
fn places<S: Scalar>(at: &Equations<'_, S>, n_parts: usize) -> Vec<S> {
    let mut out = Vec::with_capacity(9 * n_parts);
    for part in 0..n_parts {
        let state = at.part(part, false);
        for vector in [state.p_GM, state.v_GM, state.w_GM] {
            out.extend(vector.0);
        }
    }
    out
}

/// Returns the time of one evaluation of the rates, in s.
fn evaluation(system: &mut System) -> f64 {
    let (t, y) = state(system);
    let mut ydot = vec![0.0; y.len()];
    timed(|| {
        let _ = Ode::rate(system, t, &y, &mut ydot);
    })
}

/// Returns the time of one evaluation of the derivatives of the rates, in s.
fn jacobian(system: &mut System) -> f64 {
    let (t, y) = state(system);
    if let Some(pattern) = Ode::pattern(system) {
        let mut entries = vec![0.0; pattern.n_entries()];
        return timed(|| {
            let _ = Ode::jacobian_entries(system, t, &y, &mut entries);
        });
    }
    let n = y.len();
    let (mut jacobian, mut dfdt) = (vec![0.0; n * n], vec![0.0; n]);
    timed(|| {
        let _ = Ode::jacobian(system, t, &y, &mut jacobian, &mut dfdt);
    })
}

fn state(system: &System) -> (f64, Vec<f64>) {
    let y = system.numbers[system.scene.layout.y()].to_vec();
    (system.numbers[Layout::TIME], y)
}

/// Returns the time of one call, from the fastest of several batches, in s.
fn timed(mut call: impl FnMut()) -> f64 {
    let (begun, mut least) = (Moment::now(), f64::INFINITY);
    let [calls, batches] = BATCH;
    for _ in 0..batches {
        let clock = Moment::now();
        let mut done = 0;
        while done < calls && (done == 0 || begun.elapsed().as_secs_f64() < MOST_MEASURING) {
            call();
            done += 1;
        }
        least = least.min(clock.elapsed().as_secs_f64() / done as f64);
        if begun.elapsed().as_secs_f64() > MOST_MEASURING {
            break;
        }
    }
    least
}
