//! Values of formulas, and formulas of time with their rates.
//!
//! A formula may read a VARIABLE that reads another, thousands deep: what is read is evaluated
//! before what reads it, in the order in which a recursion would, but without its stack.

use super::{Equations, Lack, STATIC};
use crate::expr::measures::Measure;
use crate::expr::program::{Input, Work};
use crate::scalar::{Jet, Scalar};
use crate::scene::external_inputs::ExternalInput;
use crate::scene::loops::Key;
use crate::scene::{Entry, Formula};
use std::collections::{HashMap, HashSet};

/// The formulas that are being evaluated.
pub(super) struct Opened {
    /// by formula
    is_open: Vec<bool>,
    count: usize,
}

impl Opened {
    /// Creates the state before any of `n` formulas is evaluated.
    pub fn none(n: usize) -> Self {
        Self {
            is_open: vec![false; n],
            count: 0,
        }
    }
    /// Returns true while any formula is being evaluated.
    pub fn any(&self) -> bool {
        self.count > 0
    }
    fn set(&mut self, formula: usize, open: bool) {
        self.is_open[formula] = open;
        if open {
            self.count += 1;
        } else {
            self.count -= 1;
        }
    }
}

/// A formula on the way down to what it reads.
struct Descent<S> {
    formula: usize,
    /// the values of its first inputs
    inputs: Vec<S>,
}

impl<S: Scalar> Equations<'_, S> {
    /// Value of a formula.
    pub fn formula(&self, f: usize) -> S {
        if let Some(value) = self.evaluated(f) {
            return value;
        }
        if self.scratch.open.borrow().is_open[f] {
            let owner = &self.scene.formulas[f].owner;
            return self.too_early(Key::Formula(f), owner, Lack::OwnValue);
        }
        let mut path = vec![self.descend(f)];
        while let Some(here) = path.last_mut() {
            let formula = &self.scene.formulas[here.formula];
            let Some(&input) = formula.program.inputs().get(here.inputs.len()) else {
                let value = self.apply(here.formula, &here.inputs);
                self.scratch.open.borrow_mut().set(here.formula, false);
                self.scratch.formulas.borrow_mut()[here.formula] = Some(value);
                path.pop();
                continue;
            };
            match self.read_by(input).filter(|&g| self.is_untouched(g)) {
                Some(g) => path.push(self.descend(g)),
                None => here.inputs.push(self.input_of(formula, input)),
            }
        }
        self.evaluated(f).unwrap_or_else(S::zero)
    }

    /// Value of a formula that is known.
    fn evaluated(&self, f: usize) -> Option<S> {
        self.unknown(Key::Formula(f))
            .or(self.scratch.formulas.borrow()[f])
    }

    /// Returns true if a formula is neither known nor being evaluated.
    fn is_untouched(&self, f: usize) -> bool {
        !self.scratch.open.borrow().is_open[f] && self.evaluated(f).is_none()
    }

    fn descend(&self, formula: usize) -> Descent<S> {
        self.scratch.open.borrow_mut().set(formula, true);
        Descent {
            formula,
            inputs: Vec::new(),
        }
    }

    /// Evaluates a formula, also where it closes a loop.
    pub(super) fn evaluate(&self, f: usize) -> S {
        let was_open = self.scratch.open.borrow().is_open[f];
        if !was_open {
            self.scratch.open.borrow_mut().set(f, true);
        }
        let formula = &self.scene.formulas[f];
        let inputs = formula.program.inputs().iter();
        let inputs: Vec<S> = inputs.map(|&i| self.input_of(formula, i)).collect();
        if !was_open {
            self.scratch.open.borrow_mut().set(f, false);
        }
        self.apply(f, &inputs)
    }

    /// Value of an input of a formula.
    fn input_of(&self, formula: &Formula, input: Input) -> S {
        match input {
            Input::Delayed(k) => self.delayed(formula.delayed.get(k as usize).copied()),
            other => self.input(other, &formula.owner),
        }
    }

    /// Applies the program of a formula to its inputs.
    fn apply(&self, f: usize, inputs: &[S]) -> S {
        let mut out = [S::zero()];
        let program = &self.scene.formulas[f].program;
        program.eval(inputs, &mut Work::default(), &mut out);
        out[0] + self.added(f)
    }

    /// Returns the formula whose value an input is.
    fn read_by(&self, input: Input) -> Option<usize> {
        let Input::Measure(measure, ids @ [id, k, ..]) = input else {
            return None;
        };
        let scene = self.scene;
        if scene
            .loops
            .iter()
            .any(|u| u.key == Key::Measure(measure, ids))
        {
            return None;
        }
        match measure {
            Measure::Varval | Measure::Aryval => self.written_as(input),
            Measure::Pinval | Measure::Pouval => scene.plant_formula(measure, id, k),
            Measure::Dif1 => {
                let equation = &scene.differentials[scene.differential(id)?];
                (!equation.implicit).then_some(equation.formula)
            }
            _ => None,
        }
    }

    /// Returns the formula of the VARIABLE or of the entry of an ARRAY that an input is.
    pub(super) fn written_as(&self, input: Input) -> Option<usize> {
        match input {
            Input::Measure(Measure::Varval, [id, ..]) => self.scene.variables.get(&id).copied(),
            Input::Measure(Measure::Aryval, [id, k, ..]) => match self.entry(id, k)? {
                Entry::Formula(f) => Some(f),
                Entry::Number(_) | Entry::State(_) => None,
            },
            _ => None,
        }
    }

    /// Returns the value that `of` finds for a formula, given the values of the formulas that it
    /// reads as VARIABLEs and entries of ARRAYs; each is found once. Where a formula reads itself
    /// there is no value.
    pub(super) fn found_in_order<T>(
        &self,
        root: usize,
        of: impl Fn(usize, &HashMap<usize, T>) -> T,
    ) -> Option<T> {
        let mut found = HashMap::new();
        let mut is_open = HashSet::from([root]);
        // each with the input that is looked at next
        let mut path = vec![(root, 0)];
        while let Some((formula, next)) = path.last_mut() {
            let inputs = self.scene.formulas[*formula].program.inputs();
            let read = inputs.get(*next).map(|&input| self.written_as(input));
            *next += 1;
            match read {
                Some(Some(formula)) if is_open.insert(formula) => path.push((formula, 0)),
                Some(_) => {}
                None => {
                    let value = of(*formula, &found);
                    found.insert(*formula, value);
                    path.pop();
                }
            }
        }
        found.remove(&root)
    }

    /// Returns what is added to a formula from outside, where it is a plant input.
    fn added(&self, f: usize) -> S {
        match self.scene.plant_inputs.get(&f) {
            Some(&place) => self.now.external[place],
            None => S::zero(),
        }
    }

    /// A number from outside; at rest the past is like the present.
    fn delayed(&self, place: Option<usize>) -> S {
        let Some(place) = place else {
            return S::constant(f64::NAN);
        };
        match self.scene.external_inputs[place] {
            ExternalInput::Delay(k) if self.scene.mode == STATIC => {
                self.formula(self.scene.delays[k].expression)
            }
            _ => self.now.external[place],
        }
    }

    /// A formula of time and of differential equations that depend on nothing else, with its rates
    /// up to `order`.
    pub(super) fn in_time(&self, formula: usize, order: usize) -> Jet<S> {
        let found = self.found_in_order(formula, |formula, read| {
            let program = &self.scene.formulas[formula].program;
            let inputs = program.inputs().iter();
            let inputs: Vec<Jet<S>> = inputs
                .map(|&i| self.input_in_time(i, order, read))
                .collect();
            let mut out = [Jet::zero()];
            program.eval(&inputs, &mut Work::default(), &mut out);
            out[0] + Jet::new(self.added(formula), S::zero(), S::zero())
        });
        found.unwrap_or_else(nothing)
    }

    fn input_in_time(&self, input: Input, order: usize, read: &HashMap<usize, Jet<S>>) -> Jet<S> {
        if let Some(formula) = self.written_as(input) {
            return read.get(&formula).copied().unwrap_or_else(nothing);
        }
        match input {
            Input::Time => Jet::variable(self.now.t),
            Input::Mode => Jet::constant(self.scene.mode),
            Input::Measure(Measure::Aryval, [id, k, ..]) => match self.entry(id, k) {
                Some(Entry::Number(x)) => Jet::constant(x),
                Some(Entry::State(d)) => self.state_in_time(d, order),
                Some(Entry::Formula(_)) | None => nothing(),
            },
            Input::Measure(Measure::Dif, [id, ..]) => match self.scene.differential(id) {
                Some(d) => self.state_in_time(d, order),
                None => nothing(),
            },
            Input::Measure(..) | Input::Delayed(_) | Input::Slot(_) => nothing(),
        }
    }

    /// A state of a differential equation with its rates up to `order`: each order needs its
    /// formula one order lower.
    fn state_in_time(&self, d: usize, order: usize) -> Jet<S> {
        let equation = &self.scene.differentials[d];
        let Some(value) = equation.state.map(|s| self.now.x[s]) else {
            return Jet::constant(f64::NAN);
        };
        if order == 0 {
            return Jet::new(value, S::zero(), S::zero());
        }
        if equation.implicit {
            return Jet::constant(f64::NAN);
        }
        let rate = self.in_time(equation.formula, order - 1);
        Jet::new(value, rate.value, rate.first)
    }

    pub(super) fn entry(&self, id: u32, k: u32) -> Option<Entry> {
        let entries = self.scene.arrays.get(&id)?;
        entries.get((k as usize).checked_sub(1)?).copied()
    }
}

/// No value, with no rates.
pub(super) fn nothing<S: Scalar>() -> Jet<S> {
    Jet::constant(f64::NAN)
}
