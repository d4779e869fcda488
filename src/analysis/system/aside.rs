//! Evaluations aside: for outputs and values of the past, after a step has been taken. They leave
//! nothing behind that the next step or another output would notice, so that neither depends on how
//! many outputs there are.
//!
//! Steps leave traces on purpose: the unknowns of algebraic loops, from which the next iteration
//! begins; the factors by which they were found; whether states come to lie on the rows by
//! themselves; and evaluations near dependent rows. An evaluation aside begins with the traces of
//! the step, but for the factors, and gives them back.

use super::System;

/// The traces of a step while evaluations are made aside.
#[derive(Clone, Debug, Default)]
pub(super) struct Traces {
    /// unknowns of algebraic loops   (n_loops)
    unknowns: Vec<f64>,
    /// whether the last state that was to be projected was on the rows
    clean: bool,
}

impl System {
    /// Makes evaluations aside.
    pub(in crate::analysis) fn aside<T>(&mut self, evaluate: impl FnOnce(&mut Self) -> T) -> T {
        let places = self.scene.layout.loops();
        self.traces.unknowns.clear();
        (self.traces.unknowns).extend_from_slice(&self.numbers[places.clone()]);
        self.traces.clean = self.recorded.rows.clean;
        self.singular_steps.pause(true);
        self.exchange_traces();
        let result = evaluate(self);
        self.exchange_traces();
        self.singular_steps.pause(false);
        self.recorded.rows.clean = self.traces.clean;
        self.numbers[places].copy_from_slice(&self.traces.unknowns);
        result
    }

    /// Exchanges the factors of the steps' loops with others, and the unknowns of loops with held
    /// branches with a copy.
    fn exchange_traces(&mut self) {
        if let Some(loops) = &mut self.recorded.loops {
            loops.exchange_factors();
        }
        self.recorded.branches.exchange_traces();
    }
}
