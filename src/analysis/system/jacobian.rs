//! The Jacobian of the rates: recorded, by duals, or, where most of it is empty, by duals along
//! groups of columns.
//!
//! Parts that are free and tied to their neighbours by forces have rates that see their neighbours
//! only. The pattern is read off the recorded rate; columns that share no row are found along one
//! direction together, eight directions at a time, and methods factor a sparse matrix.

use super::System;
use super::algebraic_loops::AlgebraicLoops;
use super::recording::Recording;
use super::tangents::Tangents;
use crate::expr::program::{LANES, Lane, Program, Work};
use crate::numeric::pattern::Pattern;
use crate::numeric::sparse::DENSE_LIMIT;
use crate::numeric::{Failure, Ode};
use crate::scalar::Dual;
use crate::scene::layout::Layout;
use crate::scene::slopes::{self, WIDTH};
use std::sync::Arc;

/// Entries of a Jacobian that counts as mostly empty, at most, as a part of all places.
const MAX_DENSITY: f64 = 0.25;
/// Operations that one on duals takes for each direction, about.
const DUALS: usize = 3;

/// Derivatives of all rates with respect to all unknowns, then to time.
#[derive(Clone, Debug)]
enum Gradient {
    /// recorded: rate by rate   (n × (n + 1))
    Recorded(Box<Recording>),
    /// by duals
    Duals,
}

impl Gradient {
    /// Chooses the way that takes less for the rates of a program.
    fn new(rate: &Program, layout: &Layout) -> Self {
        let places = layout.y().chain([Layout::TIME]);
        match slopes::recorded(rate, layout.n_y(), places) {
            Some(program) => Gradient::Recorded(Box::new(Recording::new(program))),
            None => Gradient::Duals,
        }
    }
}

/// The derivatives of the rates of a configuration, found when they are first asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct Derivatives {
    /// those of the rate, and of the one with branches held
    gradients: [Option<Gradient>; 2],
    /// entries of the Jacobian, whichever branches are held, where it is mostly empty
    pattern: Option<Option<Arc<Pattern>>>,
    work: Work<Dual<WIDTH>>,
    numbers: Vec<Dual<WIDTH>>,
    out: Vec<Dual<WIDTH>>,
    /// those of the rate along many directions, and of the one with branches held
    tangents: [Tangents; 2],
    /// the numbers that are read, and their derivatives, and those of the rates
    row: Vec<f64>,
    lanes: [Vec<Lane>; 2],
}

/// Fails where an entry of a Jacobian of `n` rates has no value.
fn find_gap(jacobian: &[f64], n: usize) -> Result<(), Failure> {
    match jacobian.iter().position(|x| !x.is_finite()) {
        Some(e) => Err(Failure {
            what: e % n.max(1),
            recoverable: true,
        }),
        None => Ok(()),
    }
}

impl System {
    /// Takes over the derivatives that a copy of this system has recorded for the same rates.
    pub(in crate::analysis) fn take_derivatives(&mut self, copy: &Self) {
        let (own, found) = (&mut self.recorded, &copy.recorded);
        if !own.rate.program.is_copy_of(&found.rate.program) {
            return;
        }
        let (own_ones, found_ones) = (&mut own.derivatives, &found.derivatives);
        let gradients = own_ones.gradients.iter_mut().zip(&found_ones.gradients);
        for (own, found) in gradients.filter(|(own, _)| own.is_none()) {
            own.clone_from(found);
        }
        if own_ones.pattern.is_none() {
            own_ones.pattern.clone_from(&found_ones.pattern);
        }
    }

    /// Returns the program of the rates as they are taken now.
    fn present_rate(&self) -> &Program {
        let held = self.recorded.branches.held_rate();
        held.filter(|_| self.recorded.branches.is_holding())
            .unwrap_or(&self.recorded.rate.program)
    }

    /// Chooses the derivatives of the rates as they are taken now: recorded, if that is worth it.
    fn gradient(&mut self) -> &mut Gradient {
        let holding = usize::from(self.recorded.branches.is_holding());
        if self.recorded.derivatives.gradients[holding].is_none() {
            let loops =
                self.recorded.loops.is_some() || holding == 1 && self.recorded.branches.has_loops();
            let beside = loops || !self.recorded.external.is_empty();
            let gradient = if beside {
                Gradient::Duals
            } else {
                Gradient::new(self.present_rate(), &self.scene.layout)
            };
            self.recorded.derivatives.gradients[holding] = Some(gradient);
        }
        self.recorded.derivatives.gradients[holding].get_or_insert(Gradient::Duals)
    }

    /// Evaluates all of the Jacobian at the present numbers.
    pub(super) fn full_jacobian(
        &mut self,
        n: usize,
        jacobian: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        self.gradient();
        let branches = &mut self.recorded.branches;
        let (holding, sliding) = (branches.is_holding(), branches.is_sliding());
        match &mut self.recorded.derivatives.gradients[usize::from(holding)] {
            Some(Gradient::Recorded(recording)) if !sliding => {
                let entries = if holding {
                    branches.put(&self.numbers);
                    recording.run(&branches.numbers)
                } else {
                    recording.run(&self.numbers)
                };
                for (i, row) in entries.chunks(n + 1).enumerate() {
                    let Some((&by_time, by_y)) = row.split_last() else {
                        continue;
                    };
                    for (j, &entry) in by_y.iter().enumerate() {
                        jacobian[i + n * j] = entry;
                    }
                    dfdt[i] = by_time;
                }
            }
            _ => self.jacobian_by_duals(n, jacobian, dfdt)?,
        }
        find_gap(jacobian, n)
    }

    /// Evaluates all of the Jacobian at the present numbers by duals: for one that is needed once,
    /// recording its program would take longer.
    pub(in crate::analysis) fn jacobian_once(
        &mut self,
        jacobian: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        self.jacobian_by_duals(dfdt.len(), jacobian, dfdt)?;
        find_gap(jacobian, dfdt.len())
    }

    fn jacobian_by_duals(
        &mut self,
        n: usize,
        jacobian: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        let places = [Layout::TIME].into_iter().chain(self.scene.layout.y());
        let columns: Vec<Vec<usize>> = places.map(|place| vec![place]).collect();
        self.along_sums(&columns, |k, slope| {
            let column = match k.checked_sub(1) {
                None => &mut *dfdt,
                Some(j) => &mut jacobian[n * j..n * (j + 1)],
            };
            for (i, entry) in column.iter_mut().enumerate() {
                *entry = slope(i);
            }
        })
    }

    /// Returns about how many operations the Jacobian takes.
    pub(in crate::analysis) fn operations_of_a_jacobian(&mut self) -> usize {
        let along = match self.jacobian_pattern() {
            Some(pattern) => pattern.groups().len(),
            None => self.scene.layout.n_y() + 1,
        };
        let operations = self.operations();
        match self.gradient() {
            Gradient::Recorded(recording) => recording.program.n_operations(),
            Gradient::Duals => DUALS * along * operations,
        }
    }

    /// Returns about how many operations the Jacobian takes at most, which need not be recorded.
    pub(in crate::analysis) fn most_operations_of_a_jacobian(&self) -> usize {
        DUALS * (self.scene.layout.n_y() + 1) * self.operations()
    }

    /// Returns the entries of the Jacobian, whichever branches are held; `None` where it is full,
    /// or small.
    pub(super) fn jacobian_pattern(&mut self) -> Option<Arc<Pattern>> {
        if self.recorded.derivatives.pattern.is_none() {
            self.recorded.derivatives.pattern = Some(self.found_pattern().map(Arc::new));
        }
        self.recorded.derivatives.pattern.clone().flatten()
    }

    fn found_pattern(&mut self) -> Option<Pattern> {
        let n = self.scene.layout.n_y();
        if n <= DENSE_LIMIT || matches!(self.gradient(), Gradient::Recorded(..)) {
            return None;
        }
        let l = self.scene.layout;
        let mut along = vec![Vec::new(); l.len()];
        for j in 0..n {
            along[l.y_at(j)].push(j as u32);
        }
        self.depend_along(&mut along);
        let mut rows = self.recorded.rate.program.dependence(&along);
        rows.truncate(n);
        let branches = &self.recorded.branches;
        if let Some(held) = branches.held_rate() {
            along.resize(branches.row.sides().start, Vec::new());
            if let Some(loops) = &branches.loops {
                loops.depend(&mut along);
            }
            for (row, more) in rows.iter_mut().zip(held.dependence(&along)) {
                row.extend(more);
            }
        }
        let entries = |rows: &[Vec<u32>]| rows.iter().map(Vec::len).sum::<usize>() as f64;
        let most = MAX_DENSITY * (n * n) as f64;
        let pattern = Pattern::of_rows(n, &rows);
        (entries(&rows) <= 2.0 * most && pattern.n_entries() as f64 <= most).then_some(pattern)
    }

    /// Evaluates the entries of the pattern at the present numbers.
    pub(super) fn jacobian_by_groups(&mut self, entries: &mut [f64]) -> Result<(), Failure> {
        let Some(pattern) = self.jacobian_pattern() else {
            unreachable!("entries are asked for where there is a pattern");
        };
        let sums: Vec<Vec<usize>> = (pattern.groups().iter())
            .map(|group| group.iter().map(|&j| self.scene.layout.y_at(j)).collect())
            .collect();
        self.along_sums(&sums, |k, slope| {
            for &j in &pattern.groups()[k] {
                for (e, i) in pattern.column(j) {
                    entries[e] = slope(i);
                }
            }
        })
    }

    /// Evaluates the derivatives of the rates along sums of numbers, several sums at a time: `take`
    /// is given the index of the sum and the derivative of each rate.
    fn along_sums(
        &mut self,
        sums: &[Vec<usize>],
        mut take: impl FnMut(usize, &dyn Fn(usize) -> f64),
    ) -> Result<(), Failure> {
        if self.recorded.branches.is_sliding() {
            return self.along_sums_sliding(sums, take);
        }
        let n = self.scene.layout.n_y();
        let constant = Dual {
            re: 0.0,
            eps: [0.0; WIDTH],
        };
        // the derivatives are taken out, as those of loops and closures come from all of the system
        let mut own = std::mem::take(&mut self.recorded.derivatives);
        let branches = &mut self.recorded.branches;
        let numbers = if branches.is_holding() {
            // solved just now, where the rates were evaluated
            let _ = branches.with_sides(&self.numbers);
            &branches.numbers[..]
        } else {
            &self.numbers[..]
        };
        own.row.clear();
        own.row.extend_from_slice(numbers);
        match self.look_along(&mut own) {
            Ok(true) => {
                self.along_sums_together(sums, take, &mut own);
                self.recorded.derivatives = own;
                return Ok(());
            }
            Ok(false) => {}
            Err(k) => {
                self.recorded.derivatives = own;
                return Err(Failure {
                    what: n + k,
                    recoverable: true,
                });
            }
        }
        own.numbers.clear();
        (own.numbers).extend(own.row.iter().map(|&re| Dual { re, ..constant }));
        own.out.resize(self.scene.layout.n_rates(), constant);
        let mut outcome = Ok(());
        for (chunk, some) in sums.chunks(WIDTH).enumerate() {
            let mark = |numbers: &mut [Dual<WIDTH>], slope: f64| {
                for (k, sum) in some.iter().enumerate() {
                    sum.iter().for_each(|&place| numbers[place].eps[k] = slope);
                }
            };
            mark(&mut own.numbers, 1.0);
            if let Err(k) = self.follow_along(&mut own.numbers, chunk == 0) {
                outcome = Err(Failure {
                    what: n + k,
                    recoverable: true,
                });
                break;
            }
            (self.present_rate()).eval(&own.numbers, &mut own.work, &mut own.out);
            mark(&mut own.numbers, 0.0);
            for k in 0..some.len() {
                take(chunk * WIDTH + k, &|i| own.out[i].eps[k]);
            }
            self.recorded.external.closures.forget(&mut own.numbers);
            let recorded = &self.recorded;
            let loops = if recorded.branches.is_holding() {
                &recorded.branches.loops
            } else {
                &recorded.loops
            };
            if let Some(loops) = loops {
                loops.forget(&mut own.numbers);
            }
        }
        self.recorded.derivatives = own;
        outcome
    }

    /// Returns the loops that the rates as they are taken now read.
    fn present_loops(&mut self) -> Option<&mut AlgebraicLoops> {
        match self.recorded.branches.is_holding() {
            true => self.recorded.branches.loops.as_mut(),
            false => self.recorded.loops.as_mut(),
        }
    }

    /// Prepares to follow many directions at once from the numbers in `own.row`; returns whether
    /// that is possible: closures are asked along a few directions.
    fn look_along(&mut self, own: &mut Derivatives) -> Result<bool, usize> {
        if !self.recorded.external.closures.is_empty() {
            return Ok(false);
        }
        let y = self.scene.layout.y();
        let is_state = |k: usize| k == Layout::TIME || y.contains(&k);
        let mut places = 0..0;
        if let Some(loops) = self.present_loops() {
            places = loops.places();
            if !loops.look_along(&own.row, is_state)? {
                return Ok(false);
            }
        }
        let holding = usize::from(self.recorded.branches.is_holding());
        let varies = |k: usize| is_state(k) || places.contains(&k);
        let tangent = own.tangents[holding].at(&own.row, self.present_rate(), varies);
        Ok(tangent.is_some())
    }

    /// Evaluates the derivatives along sums of numbers by recorded ones; see
    /// [`Self::along_sums`].
    fn along_sums_together(
        &mut self,
        sums: &[Vec<usize>],
        mut take: impl FnMut(usize, &dyn Fn(usize) -> f64),
        own: &mut Derivatives,
    ) {
        let holding = usize::from(self.recorded.branches.is_holding());
        let Some(tangent) = own.tangents[holding].here() else {
            unreachable!("it was asked for where it is at hand");
        };
        let [row, rates] = &mut own.lanes;
        row.clear();
        row.resize(own.row.len(), Lane::ZERO);
        rates.resize(self.scene.layout.n_rates(), Lane::ZERO);
        for (chunk, some) in sums.chunks(LANES).enumerate() {
            let mark = |row: &mut [Lane], slope: f64| {
                for (k, sum) in some.iter().enumerate() {
                    sum.iter().for_each(|&place| row[place].set(k, slope));
                }
            };
            mark(row, 1.0);
            if let Some(loops) = self.present_loops() {
                loops.follow_together(row, some.len());
            }
            tangent.along(some.len(), row, rates);
            for k in 0..some.len() {
                take(chunk * LANES + k, &|i| rates[i].get(k));
            }
            mark(row, 0.0);
        }
    }

    /// Evaluates the same while something slides, by differences, as α changes with the state.
    fn along_sums_sliding(
        &mut self,
        sums: &[Vec<usize>],
        mut take: impl FnMut(usize, &dyn Fn(usize) -> f64),
    ) -> Result<(), Failure> {
        let mut typical = vec![1.0; self.numbers.len()];
        let places = self.scene.layout.y();
        Ode::typical(self, &mut typical[places]);
        let recorded = &mut self.recorded;
        recorded.run_rate(&self.numbers);
        let here = recorded.rate.values.clone();
        let numbers = self.numbers.clone();
        for (k, sum) in sums.iter().enumerate() {
            let size = |&place: &usize| numbers[place].abs().max(typical[place]);
            let h = f64::EPSILON.sqrt() * sum.iter().map(size).fold(0.0, f64::max);
            sum.iter().for_each(|&place| self.numbers[place] += h);
            recorded.run_rate(&self.numbers);
            let rates = &recorded.rate.values;
            take(k, &|i| (rates[i] - here[i]) / h);
            self.numbers.copy_from_slice(&numbers);
        }
        recorded.rate.values.copy_from_slice(&here);
        Ok(())
    }
}
