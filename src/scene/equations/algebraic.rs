//! The rate of a DIFF that has none of its own: an implicit equation without DIF1 holds at every
//! instant, so it holds with its first rate.
//!
//! ```text
//! 0 = e(y, z(t))        y' = −(∂e/∂z · z') / (∂e/∂y)
//! ```
//!
//! Both derivatives come from the program of e over jets: once with z moving and y at rest, once
//! with y alone moving. What e reads may be time, other equations, VARIABLEs and ARRAYs of these,
//! and places of markers; what has no rate that is known without accelerations is named.

use super::formulas::nothing;
use super::{Equations, Lack};
use crate::expr::measures::{Family, Measure};
use crate::expr::program::{Input, Work};
use crate::scalar::{Jet, Scalar};
use crate::scene::Entry;
use crate::scene::asker::Asker;

/// The quantities that move while a formula is differentiated in time.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Moving {
    /// all but the unknown of this equation
    Others(usize),
    /// the unknown of this equation alone, at rate one
    Only(usize),
}

impl<S: Scalar> Equations<'_, S> {
    /// Rate of the unknown of an equation that does not read its rate.
    pub(super) fn algebraic_rate(&self, d: usize) -> S {
        let equation = &self.scene.differentials[d];
        if self.scratch.rates_open.borrow().contains(&d) {
            return self.complain(&Asker::Rate(equation.id.element.number), Lack::OwnValue);
        }
        self.scratch.rates_open.borrow_mut().push(d);
        let along = self.moved(equation.formula, Moving::Others(d));
        let own = self.moved(equation.formula, Moving::Only(d));
        self.scratch.rates_open.borrow_mut().pop();
        -(along.first / own.first)
    }

    /// A formula with its rate while some of what it reads moves.
    fn moved(&self, formula: usize, moving: Moving) -> Jet<S> {
        let found = self.found_in_order(formula, |formula, read| {
            let f = &self.scene.formulas[formula];
            let inputs = f.program.inputs().iter();
            let inputs: Vec<Jet<S>> = inputs
                .map(|&input| match self.written_as(input) {
                    Some(formula) => read.get(&formula).copied().unwrap_or_else(nothing),
                    None => self.moved_input(input, moving, &f.owner),
                })
                .collect();
            let mut out = [Jet::zero()];
            f.program.eval(&inputs, &mut Work::default(), &mut out);
            out[0]
        });
        found.unwrap_or_else(nothing)
    }

    fn moved_input(&self, input: Input, moving: Moving, asked_by: &Asker) -> Jet<S> {
        match input {
            Input::Time => at_rate(self.now.t, if own(moving) { S::zero() } else { S::one() }),
            Input::Mode => Jet::constant(self.scene.mode),
            Input::Measure(Measure::Varval, _) => nothing(),
            Input::Measure(Measure::Aryval, [id, k, ..]) => match self.entry(id, k) {
                Some(Entry::Number(x)) => Jet::constant(x),
                Some(Entry::State(d)) => self.moved_state(d, moving),
                Some(Entry::Formula(_)) | None => nothing(),
            },
            Input::Measure(Measure::Dif, [id, ..]) => match self.scene.differential(id) {
                Some(d) => self.moved_state(d, moving),
                None => nothing(),
            },
            Input::Measure(measure, ids) => self.moved_measure(asked_by, measure, ids, moving),
            Input::Delayed(_) | Input::Slot(_) => nothing(),
        }
    }

    fn moved_state(&self, d: usize, moving: Moving) -> Jet<S> {
        let rate = match moving {
            Moving::Others(own) if own == d => S::zero(),
            Moving::Others(_) => self.rate_of(d),
            Moving::Only(own) if own == d => S::one(),
            Moving::Only(_) => S::zero(),
        };
        at_rate(self.state_of(d), rate)
    }

    fn moved_measure(
        &self,
        asked_by: &Asker,
        measure: Measure,
        ids: [u32; 4],
        moving: Moving,
    ) -> Jet<S> {
        if own(moving) {
            return at_rate(self.measure(measure, ids, asked_by), S::zero());
        }
        let places = measure.row().family == Family::Displacement;
        match places.then(|| self.place_in_time(measure, ids)).flatten() {
            Some(jet) => at_rate(jet.value, jet.first),
            None => Jet::new(
                S::zero(),
                self.complain(asked_by, Lack::Rate(measure)),
                S::zero(),
            ),
        }
    }
}

fn own(moving: Moving) -> bool {
    matches!(moving, Moving::Only(_))
}

fn at_rate<S: Scalar>(value: S, rate: S) -> Jet<S> {
    Jet::new(value, rate, S::zero())
}
