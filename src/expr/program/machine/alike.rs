//! Components that are the same but for their constants: one machine for each kind, run for its
//! members one after the other.
//!
//! Their constants are read as parameters: those of a member are copied to the frame before its
//! run. A number that is the same for all members stays known to the code.
//!
//! ```text
//! frame   of each kind: frame of its machine | its inputs     then: numbers between | outputs
//! ```

use super::super::code::{Core, Shape};
use super::{Engine, Machine};
use std::sync::Arc;

/// Stands in the code for a constant that is not the same for all members: a number that no code
/// asks for.
const PARAMETER: f64 = f64::from_bits(0x7FF8_0C06_4A7E_0000);

/// A program as its components.
#[derive(Debug)]
pub(in crate::expr::program) struct Alike {
    kinds: Vec<Members>,
    /// numbers that components hand on to the last
    n_between: usize,
    /// outputs that are inputs: their positions
    passed: Vec<[u32; 2]>,
    n_inputs: usize,
    n_outputs: usize,
}

/// The code of a kind, and where its members stand in the program.
#[derive(Debug)]
pub(in crate::expr::program) struct KindOfCode<'a> {
    /// the code, with the constants of the first member
    pub core: &'a Core,
    /// by member and constant: its place among the constants of the program
    pub constants: Vec<u32>,
    /// by member and input: its place among the inputs of the program, then the numbers between
    pub inputs: Vec<u32>,
    /// by member and result: its place among the numbers between, then the outputs
    pub targets: Vec<u32>,
}

/// Members of a kind.
#[derive(Debug)]
struct Members {
    machine: Machine,
    places: Arc<Places>,
    /// by member: its constants
    constants: Vec<f64>,
    n_inputs: usize,
}

/// Where the members of a kind stand in the program, as in [`KindOfCode`].
#[derive(Debug)]
struct Places {
    constants: Vec<u32>,
    inputs: Vec<u32>,
    targets: Vec<u32>,
}

impl Alike {
    /// Takes kinds apart that were put together to a program, in the order in which they are run.
    pub(in crate::expr::program) fn new<'a>(
        kinds: impl Iterator<Item = KindOfCode<'a>>,
        n_between: usize,
        whole: &Core,
    ) -> Self {
        let n_constants = whole.constants.len();
        let passed = (0u32..).zip(&whole.outputs).filter_map(|(k, &r)| {
            let input = (r as usize).checked_sub(n_constants)?;
            Some([k, *whole.used.get(input)?])
        });
        Self {
            kinds: kinds.map(|kind| Members::new(kind, whole)).collect(),
            n_between,
            passed: passed.collect(),
            n_inputs: whole.n_inputs,
            n_outputs: whole.outputs.len(),
        }
    }

    /// Returns the components with the constants of another core of the same shape; `None` where
    /// other code is made of it.
    pub(super) fn with_core(&self, whole: &Core) -> Option<Self> {
        let kinds: Option<Vec<Members>> = (self.kinds.iter())
            .map(|kind| kind.with_core(whole))
            .collect();
        Some(Self {
            kinds: kinds?,
            passed: self.passed.clone(),
            ..*self
        })
    }

    /// Lays out a frame.
    pub(super) fn lay_out(&self, whole: &Core, frame: &mut Vec<f64>) {
        for kind in &self.kinds {
            kind.machine.lay_out(frame);
            frame.resize(frame.len() + kind.n_inputs, f64::NAN);
        }
        frame.resize(frame.len() + self.n_between, f64::NAN);
        // outputs that are constants stay for ever
        let constant = |&r: &u32| whole.constants.get(r as usize).copied();
        frame.extend((whole.outputs.iter()).map(|r| constant(r).unwrap_or(f64::NAN)));
    }

    /// Runs all members over a frame; the outputs are left at its end.
    pub(super) fn run(&self, frame: &mut [f64], inputs: &[f64]) {
        let n_targets = self.n_between + self.n_outputs;
        let (mut rest, targets) = frame.split_at_mut(frame.len() - n_targets);
        for kind in &self.kinds {
            let (own, others) = rest.split_at_mut(kind.frame_length() + kind.n_inputs);
            kind.run(own, &inputs[..self.n_inputs], targets);
            rest = others;
        }
        let outputs = &mut targets[self.n_between..];
        for &[output, input] in &self.passed {
            outputs[output as usize] = inputs[input as usize];
        }
    }

    pub(super) fn engine(&self) -> Engine {
        (self.kinds.first()).map_or(Engine::Interpreter, |kind| kind.machine.engine())
    }

    pub(super) fn n_steps(&self) -> usize {
        let steps = self.kinds.iter();
        steps
            .map(|kind| kind.n_members() * kind.machine.n_steps())
            .sum()
    }

    pub(super) fn n_steps_of_code(&self) -> usize {
        self.kinds.iter().map(|kind| kind.machine.n_steps()).sum()
    }

    /// Translates what so many further runs make worth it.
    #[cfg(feature = "solver")]
    pub(super) fn expect_runs(&self, n_runs: usize) {
        for kind in &self.kinds {
            kind.machine
                .expect_runs(n_runs.saturating_mul(kind.n_members()));
        }
    }
}

impl Members {
    fn new(kind: KindOfCode<'_>, whole: &Core) -> Self {
        let places = Places {
            constants: kind.constants,
            inputs: kind.inputs,
            targets: kind.targets,
        };
        let constants = places.constants_of(whole);
        let core = Core {
            constants: known(&constants, kind.core.constants.len()),
            tables: kind.core.tables.clone(),
            shape: Arc::clone(&kind.core.shape),
        };
        Self {
            n_inputs: core.n_inputs,
            machine: Machine::new(Arc::new(core)),
            places: Arc::new(places),
            constants,
        }
    }

    fn with_core(&self, whole: &Core) -> Option<Self> {
        let constants = self.places.constants_of(whole);
        let shape: &Arc<Shape> = &self.machine.core.shape;
        let known = known(&constants, self.machine.core.constants.len());
        // functions are prepared with their parameters
        let is_parameter = |r: &u32| {
            let number = known.get(*r as usize);
            number.is_some_and(|c| c.to_bits() == PARAMETER.to_bits())
        };
        if shape.lists.iter().any(is_parameter) {
            return None;
        }
        let core = Core {
            constants: known,
            tables: whole.tables.clone(),
            shape: Arc::clone(shape),
        };
        Some(Self {
            machine: self.machine.with_core(core),
            places: Arc::clone(&self.places),
            constants,
            n_inputs: self.n_inputs,
        })
    }

    fn n_members(&self) -> usize {
        self.places.targets.len() / self.machine.core.outputs.len().max(1)
    }

    fn frame_length(&self) -> usize {
        self.machine.steps().n_slots() + self.machine.core.outputs.len()
    }

    fn run(&self, frame: &mut [f64], inputs: &[f64], targets: &mut [f64]) {
        let core = &self.machine.core;
        let n_results = core.outputs.len();
        let (frame, gathered) = frame.split_at_mut(frame.len() - self.n_inputs);
        let results = frame.len() - n_results;
        for m in 0..self.n_members() {
            let constants = &self.constants[m * core.constants.len()..][..core.constants.len()];
            frame[..constants.len()].copy_from_slice(constants);
            let from = &self.places.inputs[m * self.n_inputs..];
            for (x, &k) in gathered.iter_mut().zip(from) {
                let k = k as usize;
                *x = inputs
                    .get(k)
                    .copied()
                    .unwrap_or_else(|| targets[k - inputs.len()]);
            }
            if self.machine.run_native_inside(frame, gathered).is_none() {
                self.machine.interpret(frame, gathered);
            }
            let to = &self.places.targets[m * n_results..];
            for (x, &k) in frame[results..].iter().zip(to) {
                targets[k as usize] = *x;
            }
        }
    }
}

impl Places {
    fn constants_of(&self, whole: &Core) -> Vec<f64> {
        let places = self.constants.iter();
        places.map(|&k| whole.constants[k as usize]).collect()
    }
}

/// Returns the constants that all members have, [`PARAMETER`] where they differ.
fn known(constants: &[f64], n: usize) -> Vec<f64> {
    let Some((first, others)) = constants.split_at_checked(n) else {
        return Vec::new();
    };
    let mut known = first.to_vec();
    for other in others.chunks_exact(n.max(1)) {
        for (x, y) in known.iter_mut().zip(other) {
            if x.to_bits() != y.to_bits() {
                *x = PARAMETER;
            }
        }
    }
    known
}
