//! The rates of the states downstream of the mechanism, `ẋ = g(t, y, x)`, and their derivatives by
//! x.
//!
//! ```text
//! s = read(t, y)        what the equations read of the mechanism: once for an instant
//! ẋ = rest(x, s)        the rest: as often as their method asks for it
//! ```
//!
//! They are evaluated aside, between two steps of the mechanism, at a state within the last one.
//! Where branches are held in that step, they are held here, too; where the motion stays at a
//! switch, what is read is the mean of its sides, as in results.

use super::System;
use super::branches::Branches;
use super::complaints;
use super::recording::Recording;
use crate::diagnostic::Diagnostic;
use crate::expr::program::{Program, Work};
use crate::numeric::Failure;
use crate::numeric::pattern::Pattern;
use crate::numeric::sparse::DENSE_LIMIT;
use crate::scalar::Dual;
use crate::scene::layout::Layout;
use crate::scene::programs;
use crate::scene::recorder::Recorder;
use crate::scene::slopes::WIDTH;
use std::sync::Arc;

/// Entries of a Jacobian that counts as mostly empty, at most, as a part of all places.
const MAX_DENSITY: f64 = 0.25;

/// Values that the equations downstream read of the mechanism at an instant.
#[derive(Clone, Debug)]
pub(in crate::analysis) struct Reading {
    /// when
    pub t: f64,
    /// with branches held
    is_held: bool,
    values: Vec<f64>,
}

impl Default for Reading {
    /// Has been taken at no time.
    fn default() -> Self {
        Self {
            t: f64::NAN,
            is_held: false,
            values: Vec::new(),
        }
    }
}

/// Rates that are evaluated in two parts.
#[derive(Clone, Debug)]
struct Parts {
    /// reads the numbers, and the sides after them where branches are held
    read: Recording,
    /// reads x, then what `read` has found
    rest: Recording,
}

impl Parts {
    fn new(rates: &Program, layout: &Layout) -> Self {
        let parted = rates.parted(layout.downstream());
        Self {
            read: Recording::new(parted.fixed),
            rest: Recording::new(parted.rest),
        }
    }
}

/// The rates of the states downstream, with what their derivatives take.
#[derive(Clone, Debug)]
pub(in crate::analysis) struct DownstreamRates {
    parts: Parts,
    /// the same with branches held
    held: Option<Parts>,
    /// whether they read anything of the mechanism but the time
    reads_mechanism: bool,
    /// entries of ∂g/∂x, whichever branches are held
    pattern: Arc<Pattern>,
    /// x, then what was read
    inputs: Vec<f64>,
    work: Work<Dual<WIDTH>>,
    duals: Vec<Dual<WIDTH>>,
    out: Vec<Dual<WIDTH>>,
}

impl DownstreamRates {
    /// Records the rates.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
    pub fn new(recorder: &Recorder<'_, '_>, branches: &Branches) -> Result<Self, Vec<Diagnostic>> {
        let switching = branches.switching.as_ref();
        let (rates, held) = programs::downstream(recorder, switching).map_err(complaints)?;
        let layout = recorder.scene().layout;
        let mut along = vec![Vec::new(); layout.len()];
        for (j, place) in (0..).zip(layout.downstream()) {
            along[place].push(j);
        }
        let mut rows = rates.dependence(&along);
        for (row, more) in rows
            .iter_mut()
            .zip(held.iter().flat_map(|h| h.dependence(&along)))
        {
            row.extend(more);
        }
        let reads = |program: &Program| {
            let mut read = (0..program.inputs().len()).filter(|&k| program.reads(k));
            read.any(|k| k != Layout::TIME && !layout.downstream().contains(&k))
        };
        Ok(Self {
            reads_mechanism: reads(&rates) || held.as_ref().is_some_and(reads),
            pattern: Arc::new(Pattern::of_rows(layout.n_downstream, &rows)),
            parts: Parts::new(&rates, &layout),
            held: held.map(|held| Parts::new(&held, &layout)),
            inputs: Vec::new(),
            work: Work::default(),
            duals: Vec::new(),
            out: Vec::new(),
        })
    }

    /// Returns the entries of the Jacobian; `None` where it is full, or small.
    pub fn pattern(&self) -> Option<Arc<Pattern>> {
        let n = self.pattern.n_columns();
        let is_sparse = self.pattern.n_entries() as f64 <= MAX_DENSITY * (n * n) as f64;
        (n > DENSE_LIMIT && is_sparse).then(|| Arc::clone(&self.pattern))
    }

    /// Returns the places of the entries that [`Self::jacobian`] yields, however many they are.
    pub fn entries(&self) -> Arc<Pattern> {
        Arc::clone(&self.pattern)
    }

    /// Reads the mechanism at a row of numbers, on the branches that are held.
    fn read(&mut self, branches: &mut Branches, numbers: &[f64], reading: &mut Reading) {
        reading.values.clear();
        let sides = branches.is_holding() && !branches.is_sliding();
        if let Some(held) = self.held.as_mut().filter(|_| sides)
            && let Some(row) = branches.with_sides(numbers)
        {
            let values = held.read.run(row);
            // beyond its end a branch may have no value
            if values.iter().all(|value| value.is_finite()) {
                reading.is_held = true;
                reading.values.extend_from_slice(values);
                return;
            }
        }
        reading.is_held = false;
        (reading.values).extend_from_slice(self.parts.read.run(numbers));
    }

    /// Returns what the rest reads, and the rest.
    fn with_inputs(&mut self, reading: &Reading, x: &[f64]) -> (&[f64], &mut Recording) {
        self.inputs.clear();
        self.inputs.extend_from_slice(x);
        self.inputs.extend_from_slice(&reading.values);
        let parts = match &mut self.held {
            Some(held) if reading.is_held => held,
            _ => &mut self.parts,
        };
        (&self.inputs, &mut parts.rest)
    }

    /// Evaluates the rates of the states `x`.
    ///
    /// # Errors
    /// They have no finite value there.
    pub fn rates(
        &mut self,
        reading: &Reading,
        x: &[f64],
        rates: &mut [f64],
    ) -> Result<(), Failure> {
        let (inputs, rest) = self.with_inputs(reading, x);
        rates.copy_from_slice(rest.run(inputs));
        match rates.iter().position(|rate| !rate.is_finite()) {
            None => Ok(()),
            Some(what) => Err(no_value(what)),
        }
    }

    /// Evaluates the derivatives of these rates by x: `take` is given index, row and column, and
    /// value of each entry of the pattern.
    ///
    /// # Errors
    /// They have no finite value there.
    pub fn jacobian(
        &mut self,
        reading: &Reading,
        x: &[f64],
        mut take: impl FnMut(usize, (usize, usize), f64),
    ) -> Result<(), Failure> {
        let constant = |re: f64| Dual {
            re,
            eps: [0.0; WIDTH],
        };
        let (mut duals, mut out) = (
            std::mem::take(&mut self.duals),
            std::mem::take(&mut self.out),
        );
        let (mut work, pattern) = (std::mem::take(&mut self.work), Arc::clone(&self.pattern));
        let (inputs, rest) = self.with_inputs(reading, x);
        duals.clear();
        duals.extend(inputs.iter().map(|&re| constant(re)));
        out.resize(rest.program.n_outputs(), constant(0.0));
        let mut gap = None;
        for some in pattern.groups().chunks(WIDTH) {
            for (k, group) in some.iter().enumerate() {
                group.iter().for_each(|&j| duals[j].eps[k] = 1.0);
            }
            rest.program.eval(&duals, &mut work, &mut out);
            for (k, group) in some.iter().enumerate() {
                for &j in group {
                    duals[j].eps[k] = 0.0;
                    for (e, i) in pattern.column(j) {
                        let slope = out[i].eps[k];
                        gap = gap.or((!slope.is_finite()).then_some(i));
                        take(e, (i, j), slope);
                    }
                }
            }
        }
        (self.duals, self.out, self.work) = (duals, out, work);
        gap.map_or(Ok(()), |what| Err(no_value(what)))
    }
}

impl System {
    /// Returns whether states downstream read the state of the mechanism, and not the time alone.
    pub(in crate::analysis) fn reads_mechanism_downstream(&self) -> bool {
        let rates = self.recorded.downstream.as_ref();
        rates.is_some_and(|rates| rates.reads_mechanism)
    }

    /// Puts the states downstream into the numbers, which rows of results are made of.
    pub(in crate::analysis) fn put_downstream(&mut self, x: &[f64]) {
        let places = self.scene.layout.downstream();
        self.numbers[places].copy_from_slice(x);
    }

    /// Reads what the equations downstream read of the mechanism in the state `y`.
    ///
    /// # Errors
    /// It has no finite value there.
    pub(in crate::analysis) fn read_downstream(
        &mut self,
        t: f64,
        y: &[f64],
        reading: &mut Reading,
    ) -> Result<(), Failure> {
        if self.reads_mechanism_downstream() {
            self.set(t, y);
        } else {
            self.numbers[Layout::TIME] = t;
        }
        // taken out, as branches are evaluated by all of the system
        let Some(mut own) = self.recorded.downstream.take() else {
            return Ok(());
        };
        own.read(&mut self.recorded.branches, &self.numbers, reading);
        if own.reads_mechanism && self.recorded.branches.is_sliding() {
            let row = self.numbers.clone();
            let on_sides = self.rows_of_branches(&row);
            if !on_sides.is_empty() {
                reading.values.fill(0.0);
            }
            for (part, numbers) in on_sides {
                let of_side = own.parts.read.run(&numbers).iter();
                let sums = reading.values.iter_mut().zip(of_side);
                sums.for_each(|(sum, value)| *sum += part * value);
            }
        }
        self.recorded.downstream = Some(own);
        let is_solved = self.unsolved.is_none() || !self.reads_mechanism_downstream();
        if is_solved && reading.values.iter().all(|value| value.is_finite()) {
            reading.t = t;
            return Ok(());
        }
        reading.t = f64::NAN;
        Err(no_value(0))
    }
}

fn no_value(what: usize) -> Failure {
    let recoverable = true;
    Failure { what, recoverable }
}
