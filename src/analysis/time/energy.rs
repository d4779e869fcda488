//! The account of energy along an integration.
//!
//! ```text
//! T + V  =  T₀ + V₀ + Σ ∫ P dt          up to the error of the balance
//! ```
//!
//! The integrals are taken step by step at the nodes of the method
//! ([`Method::quadrature`]), so that the balance is as good as
//! the solution: what it lacks is an error of the solution. Nothing is integrated where gravity
//! alone acts.

use crate::analysis::system::System;
use crate::analysis::trajectory::{Energy, EnergyFlow};
use crate::numeric::{Method, Step};
use std::time::Instant;

/// Looks at the balance during a simulation, at most about.
const LOOKS: f64 = 200.0;

/// Begins the account at a state, unless it has begun.
pub(super) fn begin(flow: &mut EnergyFlow, system: &mut System, t: f64, y: &[f64]) {
    if flow.start.is_none() {
        flow.start = system.energy(t, y);
        flow.end = flow.start.unwrap_or_default();
    }
}

/// The account of a mechanism whose motions say where it is: works of forces by the trapezoidal
/// rule over its states, those of motions from the balance. The error is that of the rule: what
/// changes when every second state is left out.
#[derive(Clone, Copy, Debug, Default)]
pub struct DrivenFlow {
    flow: EnergyFlow,
    /// states seen
    n: usize,
    /// the last state, and the last one that the coarse rule has: time and powers of forces
    ends: [(f64, [f64; 3]); 2],
    /// works of forces by the fine rule and by the coarse one
    works: [[f64; 3]; 2],
}

impl DrivenFlow {
    /// Adds a state: its time, energy, and the powers of forces.
    pub fn see(&mut self, t: f64, energy: Energy, powers: [f64; 3]) {
        if self.n == 0 {
            self.flow.start = Some(energy);
        }
        self.flow.end = energy;
        let rules = if self.n.is_multiple_of(2) { 0..2 } else { 0..1 };
        for rule in rules {
            let (before, last) = self.ends[rule];
            if self.n > 0 {
                let trapezoid = |k: usize| 0.5 * (t - before) * (last[k] + powers[k]);
                let works = self.works[rule].iter_mut().enumerate();
                works.for_each(|(k, work)| *work += trapezoid(k));
            }
            self.ends[rule] = (t, powers);
        }
        if self.n.is_multiple_of(2) {
            let [fine, coarse] = self.works;
            let off: f64 = fine.iter().zip(coarse).map(|(f, c)| (f - c).abs()).sum();
            self.flow.imbalance = self.flow.imbalance.max(off);
        }
        self.n += 1;
    }

    /// Returns the account so far.
    pub fn flow(&self) -> EnergyFlow {
        let mut flow = self.flow;
        let Some(start) = flow.start else {
            return flow;
        };
        let fine = self.works[0];
        let change: f64 = (0..2).map(|k| flow.end[k] - start[k]).sum();
        let by_motions = change - fine.iter().sum::<f64>();
        flow.works = [fine[0], fine[1], fine[2], by_motions];
        let sizes = [start[0], flow.end[0], flow.end[1] - start[1]];
        let sizes = sizes.iter().chain(&flow.works);
        flow.scale = sizes.fold(0.0, |m, x| m.max(x.abs()));
        flow
    }
}

/// The account of a leg: scratch, and when the balance is looked at next.
#[derive(Debug, Default)]
pub(super) struct Accountant {
    work: [Vec<f64>; 2],
    due: f64,
}

impl Accountant {
    /// Adds an accepted step to the account.
    pub(super) fn account(
        &mut self,
        flow: &mut EnergyFlow,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
        (start, end): (f64, f64),
    ) {
        if flow.start.is_none() {
            return;
        }
        if system.does_work() {
            let clock = Instant::now();
            let ends = [step.t0, step.t1];
            let works = &mut flow.works;
            let visited = method.quadrature(system, ends, &mut self.work, &mut |system, node| {
                let powers = system.powers(ends, node).unwrap_or([f64::NAN; 4]);
                for (work, power) in works.iter_mut().zip(powers) {
                    *work += node.weight * power;
                }
            });
            if visited.is_err() {
                works.fill(f64::NAN);
            }
            flow.spent += clock.elapsed();
        }
        if step.t1 >= self.due || step.t1 >= end {
            self.due = step.t1 + (end - start) / LOOKS;
            if let Some(energy) = system.energy(step.t1, method.y()) {
                flow.look(energy);
            }
        }
    }
}
