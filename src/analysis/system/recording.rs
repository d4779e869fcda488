//! A recorded program with the scratch that it needs.

use crate::expr::program::{Program, Work};

/// A recorded program, its scratch and its outputs.
#[derive(Clone, Debug)]
pub(in crate::analysis) struct Recording {
    pub program: Program,
    work: Work,
    /// the outputs of the last run   (n_outputs)
    pub values: Vec<f64>,
}

impl Recording {
    /// Gives a program the places for its outputs.
    pub fn new(program: Program) -> Self {
        Self {
            values: vec![0.0; program.n_outputs()],
            program,
            work: Work::default(),
        }
    }

    /// Runs the program on a row of numbers; its outputs.
    pub fn run(&mut self, numbers: &[f64]) -> &[f64] {
        self.program.run(numbers, &mut self.work, &mut self.values);
        &self.values
    }

    /// Runs the program on a row of numbers, its outputs but for the last into `out`; returns the
    /// last, and whether the others are finite.
    #[inline]
    pub fn run_finite(&mut self, numbers: &[f64], out: &mut [f64]) -> (f64, bool) {
        self.program.run_finite(numbers, &mut self.work, out)
    }
}
