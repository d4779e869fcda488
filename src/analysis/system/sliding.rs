//! Sliding: where both branches of a function lead back to the place at which it changes, the motion stays there.
//!
//! Friction −μ sign(v) brings a body to rest and holds it, but neither of its branches is a force that holds. The rate there is the mean of
//! those of the branches that keeps the switching functions σ at zero (Filippov):
//!
//! ```text
//! ẏ = f + Σ αₖ dₖ        f: all that slide on their negative sides, dₖ: what changes when k is on its positive side
//! Σⱼ (∂σₖ/∂y dⱼ) αⱼ = −(∂σₖ/∂t + ∂σₖ/∂y f)
//! ```
//!
//! What slides does so while 0 ≤ αₖ ≤ 1; min(αₖ, 1 − αₖ) is its switching function meanwhile. Branches of several functions that slide at once are taken
//! to add up, as forces do.
//!
//! Source: Filippov, *Differential Equations with Discontinuous Righthand Sides* (1988), §4; Piiroinen & Kuznetsov, ACM TOMS 34 (2008).

use super::System;
use crate::analysis::system::algebraic_loops::WIDTH;
use crate::expr::program::Work;
use crate::numeric::dense::Lu;
use crate::numeric::{Failure, Ode};
use crate::scalar::Dual;
use crate::scene::layout::Layout;
use crate::scene::programs::Switching;

/// The switches that slide, and how much of each branch holds.
#[derive(Debug, Default)]
pub(super) struct Slides {
    /// which   (m)
    which: Vec<usize>,
    /// the part of the positive branch of each   (m)
    alpha: Vec<f64>,
    /// rates where all that slide are on their negative sides; what changes when one is on its positive side   (n + 1; m × (n + 1))
    base: Vec<f64>,
    changes: Vec<f64>,
    /// how fast σ goes along the base, then along each change   (m each)
    slopes: Vec<f64>,
    lu: Option<Lu>,
    work: Work<Dual<WIDTH>>,
    numbers: Vec<Dual<WIDTH>>,
    out: Vec<Dual<WIDTH>>,
}

impl System {
    /// Whether anything slides.
    pub(super) fn is_sliding(&self) -> bool {
        self.holding && !self.slides.which.is_empty()
    }

    /// From now on these switches slide, all others are held on their sides; to be called after [`System::hold`].
    pub fn slide(&mut self, which: impl IntoIterator<Item = usize>) {
        self.slides.which.clear();
        self.slides.which.extend(which);
    }

    /// Whether the motion would stay where switch `k` changes, while those slide that do: both of its branches lead back there.
    pub fn attracts(&mut self, t: f64, y: &[f64], k: usize) -> bool {
        if !self.can_hold() || !self.external.is_empty() {
            return false;
        }
        self.set(t, y);
        self.slides.which.push(k);
        let m = self.slides.which.len();
        let mut attracts = self.weigh() && (0.0..=1.0).contains(&self.slides.alpha[m - 1]);
        if let (true, Some(lu)) = (attracts, &self.slides.lu) {
            // how fast σ goes as α grows, the others sliding on
            let mut inverse = vec![0.0; m];
            inverse[m - 1] = 1.0;
            lu.solve(&mut inverse);
            attracts = inverse[m - 1] < 0.0;
        }
        self.slides.which.pop();
        attracts
    }

    /// Puts a state where steps have ended near it onto the place at which the motion stays, along what the branches change: an impulse of friction.
    pub fn stay(&mut self, t: f64, y: &mut [f64]) {
        let mut values = vec![0.0; self.n_switches()];
        let which = std::mem::take(&mut self.slides.which);
        self.switches(t, y, &mut values);
        self.slides.which = which;
        if !self.weigh() {
            return;
        }
        let s = &self.slides;
        let mut impulses: Vec<f64> = s.which.iter().map(|&k| -values[k]).collect();
        if let Some(lu) = &s.lu {
            lu.solve(&mut impulses);
        }
        for (impulse, change) in impulses.iter().zip(s.changes.chunks_exact(s.base.len())) {
            for (y, d) in y.iter_mut().zip(&change[..s.base.len() - 1]) {
                *y += impulse * d;
            }
        }
    }

    /// The side on which a switch that slid goes on: that of the branch of which there is more.
    pub fn side_left_to(&mut self, t: f64, y: &[f64], k: usize) -> i8 {
        self.set(t, y);
        let place = self.slides.which.iter().position(|&j| j == k);
        match place {
            Some(place) if self.weigh() && self.slides.alpha[place] < 0.5 => -1,
            _ => 1,
        }
    }

    /// The unknown whose rate changes most where switch `k` does.
    pub fn changed_most_by(&mut self, t: f64, y: &[f64], k: usize) -> usize {
        self.set(t, y);
        self.slides.which.push(k);
        self.weigh();
        self.slides.which.pop();
        let n = self.slides.base.len();
        let change = self.slides.changes.rchunks_exact(n.max(1)).next();
        let change = change.unwrap_or_default().iter().take(n.saturating_sub(1));
        let largest = change
            .enumerate()
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        largest.map_or(0, |(i, _)| i)
    }

    /// The mean of the branches' rates at the present numbers; false where there is none.
    pub(super) fn run_sliding(&mut self) -> bool {
        if !self.weigh() {
            return false;
        }
        let s = &self.slides;
        let n = s.base.len();
        self.rates.copy_from_slice(&s.base);
        for (alpha, change) in s.alpha.iter().zip(s.changes.chunks_exact(n)) {
            for (rate, d) in self.rates[..n - 1].iter_mut().zip(change) {
                *rate += alpha * d;
            }
        }
        true
    }

    /// Puts the values of the switches that slide into their places.
    pub(super) fn sliding_values(&mut self, values: &mut [f64]) {
        let found = self.weigh();
        for (&k, &alpha) in self.slides.which.iter().zip(&self.slides.alpha) {
            values[k] = if found {
                alpha.min(1.0 - alpha)
            } else {
                f64::NAN
            };
        }
    }

    /// Finds α at the present numbers.
    fn weigh(&mut self) -> bool {
        let Some(Switching {
            held: Some(held),
            switches,
            ..
        }) = &self.switching
        else {
            return false;
        };
        let s = &mut self.slides;
        let (n_numbers, n, m) = (self.numbers.len(), self.rates.len(), s.which.len());
        let all = &mut self.switch_numbers;
        all.clear();
        all.extend(self.numbers.iter().chain(&self.sides));
        for &k in &s.which {
            all[n_numbers + k] = -1.0;
        }
        s.base.resize(n, 0.0);
        s.changes.resize(n * m, 0.0);
        s.alpha.resize(m, 0.0);
        held.run(all, &mut self.held_work, &mut s.base);
        for (&k, change) in s.which.iter().zip(s.changes.chunks_exact_mut(n)) {
            all[n_numbers + k] = 1.0;
            held.run(all, &mut self.held_work, change);
            all[n_numbers + k] = -1.0;
            for (d, f) in change.iter_mut().zip(&s.base) {
                *d -= f;
            }
        }
        // σ along the base, with time, and along each change
        let constant = |re: f64| Dual {
            re,
            eps: [0.0; WIDTH],
        };
        let places = self.scene.layout.y();
        s.slopes.resize(m * (m + 1), 0.0);
        s.out.resize(switches.n_outputs(), constant(0.0));
        for first in (0..=m).step_by(WIDTH) {
            s.numbers.clear();
            s.numbers.extend(all.iter().map(|&re| constant(re)));
            let some = first..(first + WIDTH).min(m + 1);
            for j in some.clone() {
                let along = if j == 0 {
                    s.numbers[Layout::TIME].eps[0] = 1.0;
                    &s.base
                } else {
                    &s.changes[n * (j - 1)..n * j]
                };
                for (place, d) in places.clone().zip(along) {
                    s.numbers[place].eps[j - first] = *d;
                }
            }
            switches.eval(&s.numbers, &mut s.work, &mut s.out);
            for j in some {
                for (slope, &k) in s.slopes[m * j..m * (j + 1)].iter_mut().zip(&s.which) {
                    *slope = s.out[k].eps[j - first];
                }
            }
        }
        let (along_base, matrix) = s.slopes.split_at(m);
        let lu = s.lu.take().filter(|lu| lu.size() == m);
        let lu = s.lu.insert(lu.unwrap_or_else(|| Lu::new(m)));
        lu.matrix_mut().copy_from_slice(matrix);
        if lu.factor(0.0).is_err() {
            return false;
        }
        for (alpha, slope) in s.alpha.iter_mut().zip(along_base) {
            *alpha = -slope;
        }
        lu.solve(&mut s.alpha);
        s.alpha.iter().all(|alpha| alpha.is_finite())
    }

    /// Derivatives of the rates along sums of numbers while something slides, by differences: α changes with the state. `take` is given the index of the sum
    /// and the derivative of each rate.
    pub(super) fn along_sums_sliding(
        &mut self,
        sums: &[Vec<usize>],
        mut take: impl FnMut(usize, &dyn Fn(usize) -> f64),
    ) -> Result<(), Failure> {
        let mut typical = vec![1.0; self.numbers.len()];
        let places = self.scene.layout.y();
        Ode::typical(self, &mut typical[places]);
        self.run_rate();
        let here = self.rates.clone();
        let numbers = self.numbers.clone();
        for (k, sum) in sums.iter().enumerate() {
            let size = |&place: &usize| numbers[place].abs().max(typical[place]);
            let h = f64::EPSILON.sqrt() * sum.iter().map(size).fold(0.0, f64::max);
            sum.iter().for_each(|&place| self.numbers[place] += h);
            self.run_rate();
            let rates = &self.rates;
            take(k, &|i| (rates[i] - here[i]) / h);
            self.numbers.copy_from_slice(&numbers);
        }
        self.rates.copy_from_slice(&here);
        Ok(())
    }
}
