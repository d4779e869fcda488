//! Energy of a system, and the powers of what acts on it, by a program of their own.

use super::System;
use super::recording::Recording;
use crate::analysis::trajectory::{Energy, Powers};
use crate::model::ElementKind;
use crate::numeric::quadrature::Node;
use crate::scene::Scene;
use crate::scene::layout::LongRow;
use crate::scene::programs::record_more;

/// Part of a weight by which nodes at the ends of a step are moved inwards: a force may jump where
/// a step ends, and the step lies on one side.
const INWARDS: f64 = 1e-8;

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

    /// Returns the powers at a node of a step, if they are watched.
    pub(in crate::analysis) fn powers(&mut self, [t0, t1]: [f64; 2], node: Node) -> Option<Powers> {
        let inwards = INWARDS * (t1 - t0);
        let delta = (t0 + inwards - node.t).max(0.0) + (t1 - inwards - node.t).min(0.0);
        let moved = node.y.iter().zip(node.ydot).map(|(y, f)| y + delta * f);
        let mut state = std::mem::take(&mut self.stage);
        state.clear();
        state.extend(moved);
        let vdot = self.scene.layout.state(node.ydot).v;
        let values = self.run_energy(node.t + delta, &state, vdot);
        let power = |v: &[f64], k: usize| v.get(2 + k).copied().unwrap_or(0.0);
        let powers = values.map(|v| std::array::from_fn(|k| power(v, k)));
        self.stage = state;
        powers
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
        energy.kept.copy_from_slice(&self.numbers);
        self.set(t, y);
        energy.row.put(&mut energy.inputs, &self.numbers, &[]);
        self.numbers.copy_from_slice(&energy.kept);
        let more = &mut energy.inputs[energy.row.more()];
        if more.len() == vdot.len() {
            more.copy_from_slice(vdot);
        }
        energy.program.run(&energy.inputs);
        let energy = self.energy.insert(energy);
        Some(&energy.program.values)
    }
}
