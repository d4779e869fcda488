//! Energy of a system, and the powers of what acts on it, by a program of their own.

use super::System;
use super::branches::Branches;
use super::recording::Recording;
use crate::analysis::trajectory::{Energy, Powers};
use crate::model::ElementKind;
use crate::numeric::quadrature::Node;
use crate::scalar::Scalar;
use crate::scene::equations::Equations;
use crate::scene::layout::LongRow;
use crate::scene::programs::{self, record_more};
use crate::scene::{Row, RowKind, Scene};

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
    /// the powers on the branches that are held; `None`: nothing changes branch
    held: Option<HeldPowers>,
}

/// The program of powers with branches held, and what it reads: numbers, unknowns of loops,
/// accelerations, sides.
#[derive(Clone, Debug)]
struct HeldPowers {
    program: Recording,
    row: LongRow,
    inputs: Vec<f64>,
}

/// Returns whether anything but gravity changes the energy of a scene.
fn does_work(scene: &Scene) -> bool {
    !scene.forces.is_empty() || is_driven(scene)
}

/// Returns whether rows or coordinates may do work.
fn is_driven(scene: &Scene) -> bool {
    let general = |id: &crate::model::ElementId| id.kind == ElementKind::Gcon;
    let is_coupled =
        |row: &Row| matches!(&row.kind, RowKind::Displacements(sum) if sum.coupled.is_some());
    !scene.motions.is_empty()
        || scene.constraints.iter().any(|c| general(&c.id))
        || scene.rows.iter().any(is_coupled)
}

impl EnergyProgram {
    /// Tells that so many evaluations follow.
    pub fn expect_runs(&self, n: usize) {
        match &self.held {
            Some(held) => held.program.program.expect_runs(n),
            None => self.program.program.expect_runs(n),
        }
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
                out.extend(powers_at(at, vdot));
            }
            out
        });
        let switching = self
            .recorded
            .branches
            .switching
            .as_ref()
            .filter(|_| does_work);
        let held = switching.and_then(|switching| {
            programs::held_with(scene, switching, row.n_more, |at, vdot| powers_at(at, vdot))
        });
        let held = held.map(|(program, row)| HeldPowers {
            program: Recording::new(program),
            inputs: vec![0.0; row.len()],
            row,
        });
        self.energy = Some(Box::new(EnergyProgram {
            program: Recording::new(program),
            row,
            inputs: vec![0.0; row.len()],
            kept: self.numbers.clone(),
            does_work,
            held,
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

    /// Returns the powers at a node of a step, on the branches of the step; `None`: they are not
    /// watched, or have no value.
    pub(in crate::analysis) fn powers(&mut self, node: Node) -> Option<Powers> {
        let has_held = self.energy.as_ref()?.held.is_some();
        if has_held && self.recorded.branches.is_holding() {
            return self.aside(|system| system.held_powers(node));
        }
        let vdot = self.scene.layout.state(node.ydot).v;
        self.run_energy(node.t, node.y, vdot).map(powers_of)
    }

    /// Returns the powers on the branches that are held; where the motion stays between branches,
    /// their mean over these.
    fn held_powers(&mut self, node: Node) -> Option<Powers> {
        let mut energy = self.energy.take()?;
        energy.kept.copy_from_slice(&self.numbers);
        self.set(node.t, node.y);
        let vdot = self.scene.layout.state(node.ydot).v;
        let branches = &mut self.recorded.branches;
        let mean = energy.held.as_mut().and_then(|held| {
            if !branches.is_sliding() {
                return held.run(branches, &self.numbers, vdot);
            }
            let mut mean = [0.0; 4];
            let between = branches.between(&self.numbers, &vec![1.0; node.y.len()]);
            let has_any = !between.is_empty();
            for mut branch in between {
                branches.exchange_sides(&mut branch.sides);
                let powers = held.run(branches, &self.numbers, vdot);
                branches.exchange_sides(&mut branch.sides);
                (mean.iter_mut().zip(powers?)).for_each(|(m, power)| *m += branch.part * power);
            }
            has_any.then_some(mean)
        });
        self.numbers.copy_from_slice(&energy.kept);
        self.energy = Some(energy);
        mean
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

impl HeldPowers {
    /// Returns the powers at some numbers on the sides that are held there; `None`: a loop has no
    /// solution near.
    fn run(&mut self, branches: &mut Branches, numbers: &[f64], vdot: &[f64]) -> Option<Powers> {
        let (of_branches, row) = (branches.row, self.row);
        let read = branches.with_sides(numbers)?;
        let (more, sides) = (row.more(), row.sides());
        self.inputs[..row.numbers.len()].copy_from_slice(&read[..row.numbers.len()]);
        self.inputs[sides].copy_from_slice(&read[of_branches.sides()]);
        let (loops, accelerations) = self.inputs[more].split_at_mut(of_branches.n_more);
        loops.copy_from_slice(&read[of_branches.more()]);
        if accelerations.len() == vdot.len() {
            accelerations.copy_from_slice(vdot);
        }
        self.program.run(&self.inputs);
        Some(first_powers(&self.program.values))
    }
}

/// Returns the powers among the values of the program of energy.
fn powers_of(values: &[f64]) -> Powers {
    first_powers(values.get(2..).unwrap_or(&[]))
}

/// Returns the powers that stand first; those that are not there are zero.
fn first_powers(values: &[f64]) -> Powers {
    std::array::from_fn(|k| values.get(k).copied().unwrap_or(0.0))
}

/// Returns the powers of what acts on a scene; that of motions last, where accelerations are given.
fn powers_at<S: Scalar>(at: &Equations<'_, S>, vdot: &[S]) -> Vec<S> {
    let p = at.powers();
    let mut all = vec![p.stored, p.dissipated, p.functions];
    if !vdot.is_empty() {
        all.push(at.energy_rate(vdot) - p.stored - p.dissipated - p.functions);
    }
    all
}
