//! Energy of a system, and the powers of what acts on it, by a program of their own.

use super::System;
use super::recording::Recording;
use crate::analysis::trajectory::{Energy, Powers};
use crate::model::ElementKind;
use crate::numeric::quadrature::Node;
use crate::scene::Scene;
use crate::scene::layout::LongRow;
use crate::scene::programs::record_more;

/// Parts of a step by which nodes at its ends are moved inwards: a force may jump where a step
/// ends, and the step lies on one side. The first is enough where no branch changes; the others
/// are tried where the branches there are not those of the step.
const INWARDS: [f64; 4] = [1e-8, 1e-6, 1e-4, 1e-2];

/// The program of energy and powers, and what it reads.
#[derive(Clone, Debug)]
pub(super) struct EnergyProgram {
    /// T, V, then the powers; those only where something does work
    program: Recording,
    /// places of the inputs: numbers, then accelerations of the free coordinates
    row: LongRow,
    inputs: Vec<f64>,
    /// numbers of the system before it was evaluated
    kept: Vec<f64>,
    does_work: bool,
}

/// Returns whether anything but gravity changes the energy of a scene.
fn does_work(scene: &Scene) -> bool {
    !scene.forces.is_empty() || is_driven(scene)
}

/// Returns whether rows or coordinates may do work.
fn is_driven(scene: &Scene) -> bool {
    let general = |id: &crate::model::ElementId| id.kind == ElementKind::Gcon;
    !scene.motions.is_empty() || scene.constraints.iter().any(|c| general(&c.id))
}

impl EnergyProgram {
    /// Tells that so many evaluations follow.
    pub fn expect_runs(&self, n: usize) {
        self.program.program.expect_runs(n);
    }
}

impl System {
    /// Records the program of energy and powers, where that has not been done.
    pub fn prepare_energy(&mut self) {
        if self.energy.is_some() {
            return;
        }
        let scene = self.configured();
        let (does_work, driven) = (does_work(&scene), is_driven(&scene));
        let row = LongRow {
            numbers: scene.layout,
            n_more: if driven { scene.layout.n_v } else { 0 },
            n_sides: 0,
        };
        // what cannot be supplied has been told by the rate, and is NaN here
        let (program, _) = record_more(scene, row.n_more, |at, vdot| {
            let mut out = at.energy().to_vec();
            if does_work {
                let p = at.powers();
                out.extend([p.stored, p.dissipated, p.functions]);
                if driven {
                    out.push(at.energy_rate(vdot) - p.stored - p.dissipated - p.functions);
                }
            }
            out
        });
        self.energy = Some(Box::new(EnergyProgram {
            program: Recording::new(program),
            row,
            inputs: vec![0.0; row.len()],
            kept: self.numbers.clone(),
            does_work,
        }));
    }

    /// Returns whether there are powers to be watched: false before [`System::prepare_energy`].
    pub(in crate::analysis) fn does_work(&self) -> bool {
        self.energy.as_ref().is_some_and(|e| e.does_work)
    }

    /// Returns the energy at a state, if that is watched.
    pub(in crate::analysis) fn energy(&mut self, t: f64, y: &[f64]) -> Option<Energy> {
        let values = self.run_energy(t, y, &[])?;
        Some([values[0], values[1]])
    }

    /// Returns the powers at a node of a step, if they are watched; `strictly`: and if it is on the
    /// branches of the step, or can be moved there.
    pub(in crate::analysis) fn powers(
        &mut self,
        [t0, t1]: [f64; 2],
        node: Node,
        strictly: bool,
    ) -> Option<Powers> {
        if self.recorded.branches.is_sliding() {
            return self.aside(|system| system.mean_powers(node));
        }
        let mut state = std::mem::take(&mut self.stage);
        let (mut t, mut is_held) = (node.t, false);
        for part in INWARDS {
            let inwards = part * (t1 - t0);
            let delta = (t0 + inwards - node.t).max(0.0) + (t1 - inwards - node.t).min(0.0);
            state.clear();
            state.extend(node.y.iter().zip(node.ydot).map(|(y, f)| y + delta * f));
            t = node.t + delta;
            is_held = self.is_on_held_branch(t, &state);
            if delta == 0.0 || is_held {
                break;
            }
        }
        if strictly && !is_held {
            self.stage = state;
            return None;
        }
        let vdot = self.scene.layout.state(node.ydot).v;
        let powers = self.run_energy(t, &state, vdot).map(powers_of);
        self.stage = state;
        powers
    }

    /// Returns the powers at a node of a step along which the motion stays where functions change
    /// branch: the mean of those of the branches.
    fn mean_powers(&mut self, node: Node) -> Option<Powers> {
        let kept = self.numbers.clone();
        let row = self.numbers_at(node.t, node.y);
        let branches = self.rows_of_branches(&row);
        let (y, vdot) = (self.scene.layout.y(), self.scene.layout.state(node.ydot).v);
        let mut mean = Some([0.0; 4]);
        for (part, row) in branches {
            let powers = self
                .run_energy(node.t, &row[y.clone()], vdot)
                .map(powers_of);
            mean = mean
                .zip(powers)
                .map(|(mut mean, powers): (Powers, Powers)| {
                    (mean.iter_mut().zip(powers)).for_each(|(m, power)| *m += part * power);
                    mean
                });
        }
        self.numbers.copy_from_slice(&kept);
        mean
    }

    /// Returns whether the functions are at a state on the branches that are held.
    fn is_on_held_branch(&mut self, t: f64, state: &[f64]) -> bool {
        let branches = &mut self.recorded.branches;
        let Some(energy) = self.energy.as_mut().filter(|_| branches.is_holding()) else {
            return true;
        };
        let numbers = &mut energy.kept;
        numbers.copy_from_slice(&self.numbers);
        self.scene.layout.set_state(numbers, t, state);
        branches.exchange_traces();
        let holds = branches.are_held_at(numbers);
        branches.exchange_traces();
        holds
    }

    /// Returns the powers of forces at a state: given back by what stores energy, of damping and
    /// friction, of functions; `None`: they are not watched.
    pub(in crate::analysis) fn powers_of_forces(&mut self, t: f64, y: &[f64]) -> Option<[f64; 3]> {
        let values = self.run_energy(t, y, &[])?;
        let powers = values.get(2..5)?;
        Some([powers[0], powers[1], powers[2]])
    }

    /// Runs the program at a state; the system stays where it is.
    fn run_energy(&mut self, t: f64, y: &[f64], vdot: &[f64]) -> Option<&[f64]> {
        let mut energy = self.energy.take()?;
        if self.follows_from_state() {
            energy.row.put(&mut energy.inputs, &self.numbers, &[]);
            self.scene.layout.set_state(&mut energy.inputs, t, y);
        } else {
            energy.kept.copy_from_slice(&self.numbers);
            self.set(t, y);
            energy.row.put(&mut energy.inputs, &self.numbers, &[]);
            self.numbers.copy_from_slice(&energy.kept);
        }
        let more = &mut energy.inputs[energy.row.more()];
        if more.len() == vdot.len() {
            more.copy_from_slice(vdot);
        }
        energy.program.run(&energy.inputs);
        let energy = self.energy.insert(energy);
        Some(&energy.program.values)
    }
}

/// Returns the powers among the values of the program.
fn powers_of(values: &[f64]) -> Powers {
    std::array::from_fn(|k| values.get(2 + k).copied().unwrap_or(0.0))
}
