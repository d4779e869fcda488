//! The Jacobian of the rates: recorded, by duals, or, where most of it is empty, by duals along groups of columns.
//!
//! Parts that are free and tied to their neighbours by forces have rates that see their neighbours only. The pattern is read off the recorded rate; columns that
//! share no row are found along one direction together, eight directions at a time, and methods factor a sparse matrix.

use super::System;
use crate::analysis::system::algebraic_loops::WIDTH;
use crate::analysis::system::slopes;
use crate::expr::program::{Program, Work};
use crate::numeric::Failure;
use crate::numeric::pattern::Pattern;
use crate::numeric::sparse::DENSE_LIMIT;
use crate::scalar::Dual;
use crate::scene::programs::Switching;
use std::sync::Arc;

/// Entries of a Jacobian that counts as mostly empty, as a part of all places.
const SPARSE: f64 = 0.25;

/// Derivatives of all rates with respect to all unknowns, then to time.
#[derive(Debug)]
pub(super) enum Gradient {
    /// recorded: rate by rate
    Recorded(Box<Program>, Work, Vec<f64>),
    /// by duals
    Duals,
}

impl Gradient {
    /// Of the first `n` outputs of a program, by whichever way takes less.
    fn new(rate: &Program, n: usize) -> Self {
        // unknowns are numbers 1 … n of the row, time is number 0
        match slopes::recorded(rate, n, (1..=n).chain([0])) {
            Some(program) => {
                Gradient::Recorded(Box::new(program), Work::default(), vec![0.0; n * (n + 1)])
            }
            None => Gradient::Duals,
        }
    }
}

impl System {
    /// The program of the rates as they are taken now.
    fn present_rate(&self) -> &Program {
        match &self.switching {
            Some(Switching {
                held: Some(held), ..
            }) if self.holding => held,
            _ => &self.rate,
        }
    }

    /// The derivatives of the rates as they are taken now, recorded if that is worth it.
    fn gradient(&mut self, n: usize) -> &mut Gradient {
        let holding = usize::from(self.holding);
        if self.gradients[holding].is_none() {
            let outside = self.unknowns.is_some() || !self.external.is_empty();
            let gradient = if outside {
                Gradient::Duals
            } else {
                Gradient::new(self.present_rate(), n)
            };
            self.gradients[holding] = Some(gradient);
        }
        self.gradients[holding].get_or_insert(Gradient::Duals)
    }

    /// All of the Jacobian at the present numbers.
    pub(super) fn full_jacobian(
        &mut self,
        n: usize,
        jacobian: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        self.gradient(n);
        let (holding, sliding) = (usize::from(self.holding), self.is_sliding());
        match &mut self.gradients[holding] {
            Some(Gradient::Recorded(program, work, entries)) if !sliding => {
                let numbers = if self.holding {
                    let all = &mut self.switch_numbers;
                    all.clear();
                    all.extend(self.numbers.iter().chain(&self.sides));
                    &all[..]
                } else {
                    &self.numbers[..]
                };
                program.run(numbers, work, entries);
                for (i, row) in entries.chunks(n + 1).enumerate() {
                    for (j, &entry) in row[..n].iter().enumerate() {
                        jacobian[i + n * j] = entry;
                    }
                    dfdt[i] = row[n];
                }
            }
            _ => {
                // unknowns are numbers 1 … n of the row, time is number 0
                let columns: Vec<Vec<usize>> = (0..=n).map(|k| vec![k]).collect();
                self.along_sums(&columns, |k, slope| {
                    let column = if k == 0 {
                        &mut *dfdt
                    } else {
                        &mut jacobian[n * (k - 1)..n * k]
                    };
                    for (i, entry) in column.iter_mut().enumerate() {
                        *entry = slope(i);
                    }
                })?;
            }
        }
        match jacobian.iter().position(|x| !x.is_finite()) {
            Some(e) => Err(Failure {
                what: e % n.max(1),
                recoverable: true,
            }),
            None => Ok(()),
        }
    }

    /// Where the Jacobian has entries, whichever branches are held; `None` where it is full, or small.
    pub(super) fn jacobian_pattern(&mut self) -> Option<Arc<Pattern>> {
        if self.pattern.is_none() {
            self.pattern = Some(self.found_pattern().map(Arc::new));
        }
        self.pattern.clone().flatten()
    }

    fn found_pattern(&mut self) -> Option<Pattern> {
        let n = self.scene.layout.n_y();
        if n <= DENSE_LIMIT || matches!(self.gradient(n), Gradient::Recorded(..)) {
            return None;
        }
        let l = self.scene.layout;
        let mut along = vec![Vec::new(); l.len()];
        for j in 0..n {
            along[l.y_at(j)].push(j as u32);
        }
        self.depend_along(&mut along);
        let mut rows = self.rate.dependence(&along);
        rows.truncate(n);
        if let Some(held) = self.switching.as_ref().and_then(|s| s.held.as_ref()) {
            for (row, more) in rows.iter_mut().zip(held.dependence(&along)) {
                row.extend(more);
            }
        }
        let entries = |rows: &[Vec<u32>]| rows.iter().map(Vec::len).sum::<usize>() as f64;
        let pattern = Pattern::of_rows(n, &rows);
        (entries(&rows) <= 2.0 * SPARSE * (n * n) as f64
            && pattern.n_entries() as f64 <= SPARSE * (n * n) as f64)
            .then_some(pattern)
    }

    /// The entries of the pattern at the present numbers.
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

    /// Derivatives of the rates along sums of numbers, several sums at a time: `take` is given the index of the sum and the derivative of each rate.
    fn along_sums(
        &mut self,
        sums: &[Vec<usize>],
        mut take: impl FnMut(usize, &dyn Fn(usize) -> f64),
    ) -> Result<(), Failure> {
        if self.is_sliding() {
            return self.along_sums_sliding(sums, take);
        }
        let n = self.scene.layout.n_y();
        let constant = Dual {
            re: 0.0,
            eps: [0.0; WIDTH],
        };
        let sides = if self.holding { &self.sides[..] } else { &[] };
        let numbers = self.numbers.iter().chain(sides);
        self.dual_numbers.clear();
        self.dual_numbers
            .extend(numbers.map(|&re| Dual { re, ..constant }));
        self.dual_out.resize(n + 1, constant);
        for (chunk, some) in sums.chunks(WIDTH).enumerate() {
            let mark = |numbers: &mut [Dual<WIDTH>], slope: f64| {
                for (k, sum) in some.iter().enumerate() {
                    sum.iter().for_each(|&place| numbers[place].eps[k] = slope);
                }
            };
            mark(&mut self.dual_numbers, 1.0);
            self.follow(chunk == 0)?;
            let rate = match &self.switching {
                Some(Switching {
                    held: Some(held), ..
                }) if self.holding => held,
                _ => &self.rate,
            };
            rate.eval(&self.dual_numbers, &mut self.dual_work, &mut self.dual_out);
            mark(&mut self.dual_numbers, 0.0);
            let out = &self.dual_out;
            for k in 0..some.len() {
                take(chunk * WIDTH + k, &|i| out[i].eps[k]);
            }
            self.external.forget(&mut self.dual_numbers);
            if let Some(unknowns) = &self.unknowns {
                unknowns.forget(&mut self.dual_numbers);
            }
        }
        Ok(())
    }
}
