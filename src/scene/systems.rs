//! Equations of the user's: VARIABLE, DIFF, LSE, TFSISO, GSE, the arrays through which they read
//! each other, plants and sensors.
//!
//! Every state is a differential equation with a formula as its rate, whatever statement it comes
//! from; every output is a formula:
//!
//! ```text
//! LSE      ẋ = A x + B u,  y = C x + D u
//! TFSISO   y/u = (b₀ + b₁ s + …)/(a₀ + a₁ s + … + aₙ sⁿ):
//!          ẋᵢ = xᵢ₊₁,  ẋₙ = (u − Σ aᵢ xᵢ₊₁)/aₙ,  y = Σ (bᵢ − aᵢ bₙ/aₙ) xᵢ₊₁ + (bₙ/aₙ) u
//! ```
//!
//! So circles through inputs and outputs, derivatives, statics and messages are those of all
//! formulas.

use super::asker::{Asker, Part};
use super::build::Builder;
use super::compile::Compiler;
use super::external_inputs::closure_for;
use super::external_inputs::{ExternalInput, SceneSampler, SceneSensor};
use super::unknown::{DifferentialId, UnknownId};
use super::{Entry, Formula, SceneDifferential};
use crate::diagnostic::counted;
use crate::expr::measures::Measure;
use crate::expr::program::{Builder as Recorder, Folding, Input, Program, Sym};
use crate::model::{
    ArrayKind, ElementId, ElementKind, GeneralSystem, LinearSystem, TransferFunction,
};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// Values of a state at the beginning and at rest.
struct Start {
    value: f64,
    hold: bool,
}

/// A matrix of the model: numbers row after row.
struct Numbers {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

/// Returns the identity of the `i`-th state of an element, counted from 0.
fn state_of(element: ElementId, i: usize) -> DifferentialId {
    DifferentialId {
        element,
        number: Some(i + 1),
    }
}

/// A term of a sum: factor, array, entry.
type Term = (f64, u32, usize);

impl Builder<'_> {
    /// All system elements. `changing`: VARIABLEs whose functions, where these are numbers, are not
    /// written into the equations.
    pub(super) fn systems(&mut self, c: &mut Compiler, changing: &BTreeSet<u32>) {
        let model = self.model;
        for (id, variable) in model.active(ElementKind::Variable, &model.variables) {
            let owner = Asker::argument(ElementKind::Variable.id(id), "FUNCTION");
            let f = match variable.function.constant() {
                Some(_) if changing.contains(&id) => {
                    let place = self.supply(ExternalInput::Constant(id));
                    self.supplied_formula(&owner, "a number that commands change", place)
                }
                _ => self.formula(c, &owner, &variable.function),
            };
            self.scene.variables.insert(id, f);
        }
        self.input_arrays(c);
        for (id, d) in model.active(ElementKind::Diff, &model.differentials) {
            let name = ElementKind::Diff.id(id);
            let formula = self.formula(c, &Asker::argument(name, "FUNCTION"), &d.function);
            self.scene.diffs.insert(id, self.scene.differentials.len());
            self.scene.differentials.push(SceneDifferential {
                id: DifferentialId::diff(id),
                state: None,
                formula,
                initial: d.ic.map(|x| x.unwrap_or(0.0)),
                static_hold: d.static_hold,
                implicit: d.implicit,
            });
        }
        for d in 0..self.scene.differentials.len() {
            let equation = &self.scene.differentials[d];
            let (id, formula) = (equation.id, equation.formula);
            if !equation.implicit || self.reads_rate(formula, id) {
                let state = self.add_state(UnknownId::Differential(id));
                self.scene.differentials[d].state = Some(state);
            }
        }
        for (id, s) in model.active(ElementKind::Lse, &model.linear_systems) {
            if let Err(why) = self.linear_system(ElementKind::Lse.id(id), s) {
                c.error(ElementKind::Lse.id(id), why);
            }
        }
        for (id, s) in model.active(ElementKind::Tfsiso, &model.transfer_functions) {
            if let Err(why) = self.transfer_function(ElementKind::Tfsiso.id(id), s) {
                c.error(ElementKind::Tfsiso.id(id), why);
            }
        }
        for (id, s) in model.active(ElementKind::Gse, &model.general_systems) {
            if let Err(why) = self.general_system(c, ElementKind::Gse.id(id), s) {
                c.error(ElementKind::Gse.id(id), why);
            }
        }
        self.plants(c);
        self.sensors(c);
    }

    /// ARRAY, U: values of VARIABLEs.
    fn input_arrays(&mut self, c: &mut Compiler) {
        for (&id, array) in &self.model.arrays {
            let ArrayKind::Inputs(variables) = &array.kind else {
                continue;
            };
            match self.values_of(variables) {
                Ok(entries) => {
                    let entries = entries.into_iter().map(Entry::Formula).collect();
                    self.scene.arrays.insert(id, entries);
                }
                Err(why) => c.error(ElementKind::Array.id(id), why),
            }
        }
    }

    /// Formulas of VARIABLEs.
    fn values_of(&self, variables: &[u32]) -> Result<Vec<usize>, String> {
        let found = variables.iter().map(|v| {
            let formula = self.scene.variables.get(v).copied();
            formula.ok_or_else(|| {
                format!(
                    "{} does not exist or is not active",
                    ElementKind::Variable.id(*v)
                )
            })
        });
        found.collect()
    }

    /// PINPUT, POUTPUT.
    fn plants(&mut self, c: &mut Compiler) {
        let model = self.model;
        for (kind, all) in [
            (ElementKind::Pinput, &model.plant_inputs),
            (ElementKind::Poutput, &model.plant_outputs),
        ] {
            for (id, plant) in model.active(kind, all) {
                match self.values_of(&plant.variables) {
                    Ok(entries) => {
                        self.scene.plants.insert(kind.id(id), entries);
                    }
                    Err(why) => c.error(kind.id(id), why),
                }
            }
        }
    }

    /// Places for what is added to VARIABLEs.
    pub(super) fn plant_inputs(&mut self, c: &mut Compiler, variables: &[u32]) {
        match self.values_of(variables) {
            Ok(formulas) => {
                for f in formulas {
                    if !self
                        .scene
                        .external_inputs
                        .contains(&ExternalInput::Input(f))
                    {
                        self.supply(ExternalInput::Input(f));
                    }
                }
            }
            Err(why) => c.error(ElementKind::Pinput.keyword(), why),
        }
    }

    fn sensors(&mut self, c: &mut Compiler) {
        let model = self.model;
        for (&id, s) in &model.sensors {
            if !model.is_active(ElementKind::Sensor.id(id)) {
                // it watches nothing, but keeps what it has seen
                self.supply(ExternalInput::Kept(id));
                continue;
            }
            let name = ElementKind::Sensor.id(id);
            let formula = self.formula(c, &Asker::argument(name, "FUNCTION"), &s.function);
            let evaluate = (s.evaluate.as_ref())
                .map(|e| self.formula(c, &Asker::argument(name, "EVALUATE"), e));
            let index = self.scene.sensors.len();
            self.supply(ExternalInput::Sensor(index));
            self.scene.sensors.push(SceneSensor {
                id,
                formula,
                comparison: s.comparison,
                value: s.value,
                error: s.error.unwrap_or(1e-3).abs(),
                angular: s.angular,
                evaluate,
                halt: s.halt,
                end_simulation: s.end_simulation,
                print: s.print,
                dt: s.dt.filter(|dt| *dt > 0.0),
                stepsize: s.stepsize.filter(|h| *h > 0.0),
                restart: s.restart,
            });
        }
    }

    /// Returns true if a formula reads DIF1 of an equation, itself or through VARIABLEs and other
    /// rates.
    fn reads_rate(&self, formula: usize, id: DifferentialId) -> bool {
        let mut seen = BTreeSet::new();
        let mut next = vec![formula];
        while let Some(f) = next.pop() {
            let Some(formula) = self.scene.formulas.get(f).filter(|_| seen.insert(f)) else {
                continue;
            };
            for input in formula.program.inputs() {
                match input {
                    Input::Measure(Measure::Dif1, [d, ..]) if DifferentialId::diff(*d) == id => {
                        return true;
                    }
                    Input::Measure(Measure::Dif1, [d, ..]) => {
                        let other = self.scene.differential(*d);
                        next.extend(other.map(|d| self.scene.differentials[d].formula));
                    }
                    Input::Measure(Measure::Varval, [v, ..]) => {
                        next.extend(self.scene.variables.get(v));
                    }
                    _ => {}
                }
            }
        }
        false
    }

    /// Adds a state with its rate; returns its index among the differential equations.
    fn state(&mut self, id: DifferentialId, formula: usize, start: &Start) -> usize {
        let state = self.add_state(UnknownId::Differential(id));
        self.scene.differentials.push(SceneDifferential {
            id,
            state: Some(state),
            formula,
            initial: [start.value, 0.0],
            static_hold: start.hold,
            implicit: false,
        });
        self.scene.differentials.len() - 1
    }

    /// `Σ factor · entry` as a formula.
    fn sum(&mut self, owner: Asker, terms: &[Term]) -> usize {
        let program = sum(terms);
        let shown = terms
            .iter()
            .map(|(f, array, k)| format!("{f:+}*ARYVAL({array},{k})"));
        let text = shown.collect();
        self.scene.formulas.push(Formula {
            owner,
            text,
            program,
            gradient: None,
            delayed: Vec::new(),
        });
        self.scene.formulas.len() - 1
    }

    /// An array that an element fills, `n` long: whether its kind and size are right.
    fn filled(&mut self, id: u32, states: bool, entries: Vec<Entry>) -> Result<(), String> {
        let name = ElementKind::Array.id(id);
        let Some(array) = self.model.arrays.get(&id) else {
            return Err(format!("{name} does not exist"));
        };
        let (kind, expected) = if states {
            ("X", ArrayKind::States)
        } else {
            ("Y", ArrayKind::Outputs)
        };
        if array.kind != expected {
            return Err(format!("{name} should be of the kind {kind}"));
        }
        if array.size.is_some_and(|n| n != entries.len()) {
            let (given, n) = (array.size.unwrap_or(0), entries.len());
            return Err(format!(
                "{name} has SIZE = {given}, but {}",
                counted(n, "entry")
            ));
        }
        if self.scene.arrays.insert(id, entries).is_some() {
            return Err(format!("{name} is already filled by another element"));
        }
        Ok(())
    }

    fn length_of_inputs(&self, u: Option<u32>) -> Result<usize, String> {
        let Some(u) = u else { return Ok(0) };
        let name = ElementKind::Array.id(u);
        match self.model.arrays.get(&u).map(|a| &a.kind) {
            Some(ArrayKind::Inputs(variables)) => Ok(variables.len()),
            Some(_) => Err(format!("{name} should be of the kind U")),
            None => Err(format!("{name} does not exist")),
        }
    }

    /// Values at the start: the numbers of an IC array, zeros without one.
    fn initial(&self, ic: Option<u32>, n: usize) -> Result<Vec<f64>, String> {
        let Some(ic) = ic else {
            return Ok(vec![0.0; n]);
        };
        let name = ElementKind::Array.id(ic);
        match self.model.arrays.get(&ic).map(|a| &a.kind) {
            Some(ArrayKind::Ic(numbers)) if numbers.len() == n => Ok(numbers.clone()),
            Some(ArrayKind::Ic(numbers)) => Err(format!(
                "{name} gives {} for {}",
                counted(numbers.len(), "initial value"),
                counted(n, "state")
            )),
            Some(_) => Err(format!("{name} should be of the kind IC")),
            None => Err(format!("{name} does not exist")),
        }
    }

    /// The numbers of a MATRIX; how many rows and columns are wanted, where that is known.
    fn matrix(
        &self,
        id: u32,
        rows: Option<usize>,
        columns: Option<usize>,
    ) -> Result<Numbers, String> {
        let name = ElementKind::Matrix.id(id);
        let Some(matrix) = self.model.matrices.get(&id) else {
            return Err(format!("{name} does not exist"));
        };
        let values = matrix.by_rows().ok_or_else(|| {
            format!("{name} does not hold as many numbers as its ROWS and COLUMNS say")
        })?;
        let found = Numbers {
            rows: matrix.rows,
            columns: matrix.columns,
            values,
        };
        let fits = |wanted: Option<usize>, n: usize| wanted.is_none_or(|w| w == n);
        if fits(rows, found.rows) && fits(columns, found.columns) {
            return Ok(found);
        }
        let wanted = |n: Option<usize>| n.map_or_else(|| "any".to_string(), |n| n.to_string());
        Err(format!(
            "{name} is {} by {}, but {} by {} are wanted here",
            found.rows,
            found.columns,
            wanted(rows),
            wanted(columns)
        ))
    }

    fn linear_system(&mut self, id: ElementId, s: &LinearSystem) -> Result<(), String> {
        let a = self.matrix(s.a, None, None)?;
        let n = a.rows;
        if a.columns != n {
            return Err(format!(
                "{} is {n} by {}, not square",
                ElementKind::Matrix.id(s.a),
                a.columns
            ));
        }
        let m = self.length_of_inputs(s.u)?;
        let u = s.u.unwrap_or(0);
        let optional = |matrix: Option<u32>, rows, columns| {
            matrix.map(|id| self.matrix(id, rows, columns)).transpose()
        };
        let b = optional(s.b, Some(n), Some(m))?;
        let cc = optional(s.c, None, Some(n))?;
        let d = optional(s.d, cc.as_ref().map(|c| c.rows), Some(m))?;
        let initial = self.initial(s.ic, n)?;
        let row = |matrix: &Option<Numbers>, i: usize, array: u32| -> Vec<Term> {
            let Some(matrix) = matrix else {
                return Vec::new();
            };
            let values = &matrix.values[i * matrix.columns..(i + 1) * matrix.columns];
            let terms = values.iter().enumerate().filter(|(_, f)| **f != 0.0);
            terms.map(|(k, &f)| (f, array, k + 1)).collect()
        };
        let outputs = cc.as_ref().or(d.as_ref()).map_or(0, |c| c.rows);
        let a = Some(a);
        let mut states = Vec::with_capacity(n);
        for (i, &value) in initial.iter().enumerate() {
            let mut terms = row(&a, i, s.x);
            terms.extend(row(&b, i, u));
            let owner = Asker::Function(id, Part::State(i + 1));
            let rate = self.sum(owner, &terms);
            let start = Start {
                value,
                hold: s.static_hold,
            };
            states.push(Entry::State(self.state(state_of(id, i), rate, &start)));
        }
        self.filled(s.x, true, states)?;
        let mut values = Vec::with_capacity(outputs);
        for i in 0..outputs {
            let mut terms = row(&cc, i, s.x);
            terms.extend(row(&d, i, u));
            let owner = Asker::Function(id, Part::Output(i + 1));
            values.push(Entry::Formula(self.sum(owner, &terms)));
        }
        match s.y {
            Some(y) => self.filled(y, false, values),
            None => Ok(()),
        }
    }

    fn transfer_function(&mut self, id: ElementId, s: &TransferFunction) -> Result<(), String> {
        let trimmed = |c: &[f64]| c.iter().rposition(|x| *x != 0.0).map_or(0, |k| k + 1);
        let a = &s.denominator[..trimmed(&s.denominator)];
        let b = &s.numerator[..trimmed(&s.numerator)];
        let Some((&an, lower)) = a.split_last() else {
            return Err("its DENOMINATOR is zero".into());
        };
        let n = lower.len();
        if b.len() > a.len() {
            return Err(format!(
                "its numerator has degree {}, more than the {n} of its denominator: such a system would differentiate its input",
                b.len() - 1
            ));
        }
        if self.length_of_inputs(Some(s.u))? != 1 {
            let inputs = ElementKind::Array.id(s.u);
            return Err(format!("{inputs} should hold the one input"));
        }
        let at = |k: usize| b.get(k).copied().unwrap_or(0.0);
        let mut states = Vec::with_capacity(n);
        for i in 0..n {
            let terms = if i + 1 < n {
                vec![(1.0, s.x, i + 2)]
            } else {
                let own = lower.iter().enumerate().filter(|(_, a)| **a != 0.0);
                let mut terms: Vec<Term> = own.map(|(k, a)| (-a / an, s.x, k + 1)).collect();
                terms.push((1.0 / an, s.u, 1));
                terms
            };
            let owner = Asker::Function(id, Part::State(i + 1));
            let rate = self.sum(owner, &terms);
            let start = Start {
                value: 0.0,
                hold: s.static_hold,
            };
            states.push(Entry::State(self.state(state_of(id, i), rate, &start)));
        }
        self.filled(s.x, true, states)?;
        let through = at(n) / an;
        let mut terms: Vec<Term> = (0..n)
            .map(|k| (at(k) - lower[k] * through, s.x, k + 1))
            .filter(|t| t.0 != 0.0)
            .collect();
        if through != 0.0 {
            terms.push((through, s.u, 1));
        }
        let y = Entry::Formula(self.sum(Asker::Function(id, Part::OnlyOutput), &terms));
        self.filled(s.y, false, vec![y])
    }

    /// States and outputs that a closure of the user's computes, from its own inputs, the states,
    /// the entries of U and the discrete states.
    fn general_system(
        &mut self,
        c: &mut Compiler,
        id: ElementId,
        s: &GeneralSystem,
    ) -> Result<(), String> {
        let initial = self.initial(s.ic, s.ns)?;
        let m = self.length_of_inputs(s.u)?;
        let discrete = if s.xd.is_some() { s.nd } else { 0 };
        let numbers = |values: Vec<f64>| values.into_iter().map(Entry::Number).collect();
        let is_known = |f| closure_for(self.hooks, id, f).is_some();
        if self.zero_user && !s.function.as_ref().is_some_and(is_known) {
            // nothing moves: what would be computed is zero
            if let Some(x) = s.x {
                self.filled(x, true, numbers(initial))?;
            }
            if let Some(xd) = s.xd {
                let values = self.initial(s.icd, discrete)?;
                self.filled(xd, true, numbers(values))?;
            }
            if let Some(y) = s.y {
                self.filled(y, false, numbers(vec![0.0; s.no]))?;
            }
            return Ok(());
        }
        let (Some(function), true) = (&s.function, s.ns + s.no + s.nd > 0) else {
            return Ok(());
        };
        let held = self.discrete_states(id, s)?;
        let array = |id: Option<u32>, n: usize| {
            (1..=n).filter_map(move |k| id.map(|id| format!("ARYVAL({id},{k})")))
        };
        let reads: Vec<String> = array(s.x, s.ns).chain(array(s.u, m)).collect();
        let n = s.ns + s.no + s.nd;
        let results = self.user_reading(
            c,
            &Asker::argument(id, "FUNCTION"),
            function,
            n,
            &reads,
            &held,
        );
        if s.nd > 0 && !results.contains(&usize::MAX) {
            self.sampler(c, id, s, &held, &results[s.ns + s.no..])?;
        }
        let mut states = Vec::with_capacity(s.ns);
        for (i, value) in initial.into_iter().enumerate() {
            let start = Start {
                value,
                hold: s.static_hold,
            };
            states.push(Entry::State(self.state(
                state_of(id, i),
                results[i],
                &start,
            )));
        }
        if let Some(x) = s.x {
            self.filled(x, true, states)?;
        }
        let outputs = results[s.ns..s.ns + s.no]
            .iter()
            .copied()
            .map(Entry::Formula)
            .collect();
        match s.y {
            Some(y) => self.filled(y, false, outputs),
            None => Ok(()),
        }
    }
}

impl Builder<'_> {
    /// Places for the discrete states of a GSE, as formulas.
    fn discrete_states(&mut self, id: ElementId, s: &GeneralSystem) -> Result<Vec<usize>, String> {
        if s.nd == 0 {
            return Ok(Vec::new());
        }
        let sampler = self.scene.samplers.len();
        let owner = |k: usize| Asker::Function(id, Part::DiscreteState(k + 1));
        let places: Vec<usize> = (0..s.nd)
            .map(|k| self.supply(ExternalInput::Sample(sampler, k)))
            .collect();
        let states = places.into_iter().enumerate();
        let held: Vec<usize> = states
            .map(|(k, place)| self.supplied_formula(&owner(k), "XD", place))
            .collect();
        if let Some(xd) = s.xd {
            let entries = held.iter().copied().map(Entry::Formula).collect();
            self.filled(xd, true, entries)?;
        }
        Ok(held)
    }

    /// When and from what the discrete states of a GSE are computed.
    fn sampler(
        &mut self,
        c: &mut Compiler,
        id: ElementId,
        s: &GeneralSystem,
        held: &[usize],
        results: &[usize],
    ) -> Result<(), String> {
        let Some(period) = &s.sample_period else {
            return Err("its discrete states need a SAMPLE_PERIOD".into());
        };
        let period = self.formula(c, &Asker::argument(id, "SAMPLE_PERIOD"), period);
        let place = |f: &usize| self.scene.formulas[*f].delayed[0];
        let (states, results) = (place(&held[0]), place(&results[0]));
        let initial = self.initial(s.icd, s.nd)?;
        self.scene.samplers.push(SceneSampler {
            id,
            period,
            n: s.nd,
            states,
            results,
            initial,
        });
        Ok(())
    }
}

/// The program of a sum.
fn sum(terms: &[Term]) -> Program {
    let builder = RefCell::new(Recorder::new(Folding::Strict));
    let mut total: Option<Sym<'_>> = None;
    for &(factor, array, k) in terms {
        let input = Input::Measure(Measure::Aryval, [array, k as u32, 0, 0]);
        let entry = Sym::input(input, &builder);
        let term = if factor == 1.0 {
            entry
        } else {
            Sym::Constant(factor) * entry
        };
        total = Some(total.map_or(term, |sum| sum + term));
    }
    let total = total.unwrap_or(Sym::Constant(0.0));
    let recorder = &mut *builder.borrow_mut();
    let value = total.value(recorder);
    recorder.finish(&[value])
}
