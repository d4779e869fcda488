//! Rows that are written as expressions: what a function of places does when its markers move.
//!
//! ```text
//! e = e(m₁ … m_k)     δe = Σ ∂e/∂mᵢ δmᵢ      δmᵢ = wrenchᵢ · twists of its markers
//! ```
//!
//! The partial derivatives come from the gradient of the function's program, the wrenches from each
//! measure over duals along the twists of the markers it reads, the rates from both over jets.

use super::rows::{seed, twist};
use super::{Equations, RowValue, formulas};
use crate::expr::measures::Measure;
use crate::expr::program::{Input, Work};
use crate::physics::action::Action;
use crate::physics::kinematic;
use crate::scalar::{Jet, Scalar};
use crate::scene::Entry;
use crate::scene::history::AngleId;
use crate::space::MarkerState;
use std::collections::HashMap;

/// Most markers that one measure reads.
const MAX_MARKERS: usize = 3;

/// A function of places: its value with rates in time, and what a unit multiplier on it exerts.
#[derive(Clone)]
struct Traced<S> {
    jet: Jet<S>,
    actions: Vec<(usize, Action<S>)>,
}

impl<S: Scalar> Traced<S> {
    fn nothing() -> Self {
        Self::of_time(formulas::nothing())
    }
    fn of_time(jet: Jet<S>) -> Self {
        Self {
            jet,
            actions: Vec::new(),
        }
    }
}

impl<S: Scalar> Equations<'_, S> {
    /// A row that says that a formula of places is zero.
    pub(super) fn formula_row(&self, formula: usize) -> RowValue<S> {
        let Traced { jet, actions } = self.traced(formula);
        let gradient = self.gradient_of(&actions);
        RowValue {
            value: jet.value,
            drift: jet.first - self.along(&gradient),
            gradient,
            gamma: -jet.second,
            actions,
        }
    }

    fn traced(&self, formula: usize) -> Traced<S> {
        let found = self.found_in_order(formula, |formula, read: &HashMap<usize, Traced<S>>| {
            let program = &self.scene.formulas[formula].program;
            let inputs = program.inputs().iter();
            let inputs: Vec<Traced<S>> = inputs
                .map(|&input| match self.written_as(input) {
                    Some(formula) => read.get(&formula).cloned(),
                    None => self.traced_input(input),
                })
                .map(|traced| traced.unwrap_or_else(Traced::nothing))
                .collect();
            let jets: Vec<Jet<S>> = inputs.iter().map(|i| i.jet).collect();
            let mut out = [Jet::zero()];
            program.eval(&jets, &mut Work::default(), &mut out);
            Traced {
                jet: out[0],
                actions: self.chained(formula, &inputs),
            }
        });
        found.unwrap_or_else(Traced::nothing)
    }

    /// An input that is no formula; `None`: it is no function of places.
    fn traced_input(&self, input: Input) -> Option<Traced<S>> {
        match input {
            Input::Time => Some(Traced::of_time(Jet::variable(self.now.t))),
            Input::Mode => Some(Traced::of_time(Jet::constant(self.scene.mode))),
            Input::Measure(Measure::Aryval, [id, k, ..]) => match self.entry(id, k)? {
                Entry::Number(x) => Some(Traced::of_time(Jet::constant(x))),
                Entry::State(_) | Entry::Formula(_) => None,
            },
            Input::Measure(measure, ids) => self.traced_measure(measure, ids),
            Input::Delayed(_) | Input::Slot(_) => None,
        }
    }

    /// `Σ ∂e/∂mᵢ wrenchᵢ`, by markers.
    fn chained(&self, formula: usize, inputs: &[Traced<S>]) -> Vec<(usize, Action<S>)> {
        let Some(program) = &self.scene.formulas[formula].gradient else {
            return Vec::new();
        };
        let values: Vec<S> = inputs.iter().map(|i| i.jet.value).collect();
        let mut out = vec![S::zero(); 1 + inputs.len()];
        program.eval(&values, &mut Work::default(), &mut out);
        let mut sum: Vec<(usize, Action<S>)> = Vec::new();
        for (input, &partial) in inputs.iter().zip(&out[1..]) {
            for (m, action) in &input.actions {
                let part = Action {
                    force: action.force.times(partial),
                    torque: action.torque.times(partial),
                };
                match sum.iter_mut().find(|s| s.0 == *m) {
                    Some(entry) => entry.1 = entry.1.plus(&part),
                    None => sum.push((*m, part)),
                }
            }
        }
        sum
    }

    /// A displacement or an angle with its rates; `None`: a marker is missing, or it is no function
    /// of places.
    pub(super) fn place_in_time(&self, measure: Measure, ids: [u32; 4]) -> Option<Jet<S>> {
        let index = |id: u32| self.scene.marker_of.get(&id).copied();
        let mut jet = kinematic::kinematic_of(measure, ids, |id| {
            Some(MarkerState::at_rest(self.marker(index(id)?).in_time()))
        })?;
        if measure.counts_turns() {
            jet.value = self.turned(AngleId::Measure(measure, ids), jet.value);
        }
        Some(jet)
    }

    /// A displacement or an angle; `None`: a marker is missing, or it is no function of places.
    fn traced_measure(&self, measure: Measure, ids: [u32; 4]) -> Option<Traced<S>> {
        let index = |id: u32| self.scene.marker_of.get(&id).copied();
        let jet = self.place_in_time(measure, ids)?;
        let mut read: Vec<usize> = Vec::new();
        let seeded = kinematic::kinematic_of(measure, ids, |id| {
            let m = index(id)?;
            let k = read.iter().position(|&r| r == m).unwrap_or_else(|| {
                read.push(m);
                read.len() - 1
            });
            (k < MAX_MARKERS).then(|| {
                MarkerState::at_rest(seed::<{ 6 * MAX_MARKERS }, S>(&self.marker(m), 6 * k))
            })
        })?;
        let actions = read
            .iter()
            .enumerate()
            .map(|(k, &m)| (m, twist(&seeded, 6 * k)))
            .collect();
        Some(Traced { jet, actions })
    }
}
