//! Functions whose parameters are constant, value and slopes together: written out as steps where
//! they are short, else called with what can be computed beforehand.

use super::super::super::code::Code;
use super::super::super::operation::Comparison;
use super::super::prepared::PreparedCall;
use super::super::steps::Step;
use super::Lowering;
use super::formula::{Formula, Number, Operation};
use crate::expr::functions::prepared::Prepared;

impl Lowering<'_> {
    /// Lowers a call or a partial derivative, with those of the same call that follow where its
    /// parameters are constant.
    pub(super) fn call(&mut self, k: usize, end: usize) -> usize {
        let core = self.core;
        let first = &core.code[k];
        let prepared = core.call(first).and_then(|(function, list)| {
            let known: Vec<Option<f64>> = list
                .iter()
                .map(|&r| core.constants.get(r as usize).copied())
                .collect();
            Some((Prepared::of(function, &known)?, function, list))
        });
        let Some(((prepared, parameters), function, list)) = prepared else {
            self.instruction(k, first);
            return 1;
        };
        let n_variables = prepared.n_variables();
        let (mut value, mut slopes) = (None, [None; 2]);
        let mut taken = 0;
        for (k, instruction) in (k..end).zip(&core.code[k..end]) {
            if core.call(instruction) != Some((function, list)) {
                break;
            }
            let to = Some(self.results.to[k]);
            match instruction.code {
                Code::Partial(_, _, which) if which as usize >= n_variables => break,
                Code::Partial(_, _, which) => slopes[which as usize] = to,
                _ => value = to,
            }
            taken += 1;
            if list[..n_variables].contains(&instruction.to) {
                // what follows reads something else there
                break;
            }
        }
        if taken == 0 {
            self.instruction(k, first);
            return 1;
        }
        self.prepared(PreparedCall {
            function: prepared,
            parameters,
            variables: [list[0], list[n_variables - 1]],
            value,
            slopes,
        });
        taken
    }

    fn prepared(&mut self, call: PreparedCall) {
        let slope = call.slopes[0].is_some();
        match Formula::of(call.function, &call.parameters, slope) {
            Some(formula) => self.formula(&formula, &call),
            None => {
                let number = self.prepared.len() as u32;
                self.prepared.push(call);
                self.steps.push(Step::Prepared { number });
            }
        }
    }

    /// Writes a formula out.
    fn formula(&mut self, formula: &Formula, call: &PreparedCall) {
        let x = call.variables[0];
        let mut exits = Vec::new();
        if let Some([x0, x1, h0, h1]) = formula.ends {
            let [x0, x1, h0, h1, zero] = [x0, x1, h0, h1, 0.0].map(|c| self.constant(c));
            // x ≤ x0, else x1 ≤ x, else between
            for (a, b, h) in [(x, x0, h0), (x1, x, h1)] {
                let unless = self.steps.len();
                self.steps.push(Step::Unless {
                    comparison: Comparison::Le,
                    a,
                    b,
                    target: 0,
                });
                self.formula_results(h, zero, call);
                exits.push(self.steps.len());
                self.steps.push(Step::Go { target: 0 });
                self.lands(unless, 0);
            }
        }
        let last = formula.operations.len().saturating_sub(1);
        let of_last = call
            .value
            .filter(|_| call.slopes[0].is_none() && formula.value == Number::Result(last));
        for (k, &operation) in formula.operations.iter().enumerate() {
            let step = match operation {
                Operation::Unary(op, a) => Step::Unary {
                    op,
                    a: self.number(a, x),
                    to: self.result(k, last, of_last),
                },
                Operation::Binary(op, a, b) => Step::Binary {
                    op,
                    a: self.number(a, x),
                    b: self.number(b, x),
                    to: self.result(k, last, of_last),
                },
            };
            self.steps.push(step);
        }
        if of_last.is_none() {
            let [value, slope] = [formula.value, formula.slope].map(|n| self.number(n, x));
            self.formula_results(value, slope, call);
        }
        for exit in exits {
            self.lands(exit, 0);
        }
    }

    /// Returns where the `k`-th result of a formula goes.
    fn result(&mut self, k: usize, last: usize, of_last: Option<u32>) -> u32 {
        match of_last {
            Some(to) if k == last => to,
            _ => self.between(k),
        }
    }

    /// Returns the slot of a number of a formula of `x`.
    fn number(&mut self, number: Number, x: u32) -> u32 {
        match number {
            Number::Variable => x,
            Number::Constant(c) => self.constant(c),
            Number::Result(k) => self.between(k),
        }
    }

    /// Copies value and slope to where they are wanted; either may go where the variable stands.
    fn formula_results(&mut self, value: u32, slope: u32, call: &PreparedCall) {
        let copies = [(value, call.value), (slope, call.slopes[0])];
        let in_order = match value == call.variables[0] {
            true => copies,
            false => [copies[1], copies[0]],
        };
        for (from, to) in in_order {
            if let Some(to) = to {
                self.steps.push(Step::Copy { from, to });
            }
        }
    }
}
