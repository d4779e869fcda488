//! Sliding: where both branches of a function lead back to the place at which it changes, the
//! motion stays there.
//!
//! Friction −μ sign(v) brings a body to rest and holds it, but neither of its branches is a force
//! that holds. The rate there is the mean of those of the branches that keeps the switching
//! functions σ at zero (Filippov):
//!
//! ```text
//! ẏ = f + Σ αₖ dₖ        f: all that slide on their negative sides
//!                        dₖ: the change of the rates when k is on its positive side
//! Σⱼ (∂σₖ/∂y dⱼ) αⱼ = −(∂σₖ/∂t + ∂σₖ/∂y f)
//! ```
//!
//! A switch slides while 0 ≤ αₖ ≤ 1; min(αₖ, 1 − αₖ) is its switching function meanwhile.
//! Branches of several functions that slide at once are taken to add up, as forces do. Where there
//! are algebraic loops, each branch has their unknowns as it solves them: friction that reads the
//! reaction it depends on.
//!
//! Source: Filippov, *Differential Equations with Discontinuous Righthand Sides* (1988), §4;
//! Piiroinen & Kuznetsov, ACM TOMS 34 (2008).

use super::bounds::Watched;
use super::branches::{self, Branches};
use crate::expr::program::Work;
use crate::numeric::dense::Lu;
use crate::scalar::Dual;
use crate::scene::layout::Layout;
use crate::scene::programs::Switching;
use crate::scene::slopes::WIDTH;

/// Distance of the states on either side of what slides, as a part of their sizes.
const BESIDE: f64 = 1e-12;
/// Change of the rates at a switch, as a part of the largest rate, that is a jump.
const JUMP: f64 = 1e-6;

/// One of the branches between which the motion stays.
#[derive(Clone, Debug)]
pub(super) struct Branch {
    /// how much of it there is in the mean
    pub part: f64,
    /// the way from the state to one nearby on which it holds   (n)
    pub shift: Vec<f64>,
    /// the sides of all switches   (n_switches)
    pub sides: Vec<f64>,
}

/// The switches that slide, and the part of each branch that holds.
#[derive(Clone, Debug, Default)]
pub(super) struct Slides {
    /// their indices   (m)
    which: Vec<usize>,
    /// the part of the positive branch of each   (m)
    alpha: Vec<f64>,
    /// rates where all that slide are on their negative sides; changes of the rates when one is on
    /// its
    /// positive side   (n + 1; m × (n + 1))
    base: Vec<f64>,
    changes: Vec<f64>,
    /// rates of σ along the base, then along each change   (m each)
    slopes: Vec<f64>,
    lu: Option<Lu>,
    /// unknowns of loops on each branch, where their solution began last   ((m + 1) × n_loops)
    unknowns: Vec<f64>,
    /// those of the steps while evaluations are made aside
    unknowns_of_steps: Vec<f64>,
    work: Work<Dual<WIDTH>>,
    numbers: Vec<Dual<WIDTH>>,
    out: Vec<Dual<WIDTH>>,
}

impl Slides {
    /// Copies the unknowns of loops before evaluations aside, or puts them back.
    pub(super) fn exchange_unknowns(&mut self, is_aside: bool) {
        if is_aside {
            self.unknowns_of_steps.clone_from(&self.unknowns);
        } else {
            self.unknowns.clone_from(&self.unknowns_of_steps);
        }
    }
}

impl Branches {
    /// Returns whether anything slides.
    pub(super) fn is_sliding(&self) -> bool {
        self.is_holding() && !self.slides.which.is_empty()
    }

    /// Lets these switches slide from now on, all others held on their sides; to be called after
    /// [`Branches::hold`].
    pub fn slide(&mut self, which: impl IntoIterator<Item = usize>) {
        self.slides.which.clear();
        self.slides.which.extend(which);
    }

    /// Returns whether the motion would stay where switch `k` changes, while those slide that do:
    /// both of its branches lead back there.
    pub(super) fn attracts(&mut self, numbers: &[f64], k: usize) -> bool {
        self.slides.which.push(k);
        let m = self.slides.which.len();
        let mut attracts = self.weigh(numbers) && (0.0..=1.0).contains(&self.slides.alpha[m - 1]);
        if let (true, Some(lu)) = (attracts, &self.slides.lu) {
            // the rate of σ as α grows, the others sliding on
            let mut inverse = vec![0.0; m];
            inverse[m - 1] = 1.0;
            lu.solve(&mut inverse);
            attracts = inverse[m - 1] < 0.0;
        }
        self.slides.which.pop();
        attracts
    }

    /// Puts a state where steps have ended near it onto the place at which the motion stays, along
    /// the changes of the rates: an impulse of friction.
    pub(super) fn stay(&mut self, numbers: &[f64], y: &mut [f64]) {
        let mut values = vec![0.0; self.len()];
        let which = std::mem::take(&mut self.slides.which);
        self.values(numbers, &mut values);
        self.slides.which = which;
        if !self.weigh(numbers) {
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

    /// Returns the branches between which the motion stays, with states where they hold. Where a
    /// quantity changes with the branch, its mean over these is what it is; the mean of the states
    /// themselves is the state. `sizes`: of the unknowns   (n). Empty: nothing slides.
    pub(super) fn between(&mut self, numbers: &[f64], sizes: &[f64]) -> Vec<Branch> {
        if !self.is_sliding() {
            return Vec::new();
        }
        let mut values = vec![0.0; self.len()];
        let which = std::mem::take(&mut self.slides.which);
        self.values(numbers, &mut values);
        self.slides.which = which;
        if !self.weigh(numbers) {
            return Vec::new();
        }
        let s = &self.slides;
        let (m, n) = (s.which.len(), s.base.len());
        let Some(lu) = &s.lu else { return Vec::new() };
        // ways along which one σ changes by one, the others not at all   (m of n)
        let ways: Vec<Vec<f64>> = (0..m)
            .map(|k| {
                let mut impulses = vec![0.0; m];
                impulses[k] = 1.0;
                lu.solve(&mut impulses);
                let mut way = vec![0.0; n - 1];
                for (impulse, change) in impulses.iter().zip(s.changes.chunks_exact(n)) {
                    for (way, d) in way.iter_mut().zip(change) {
                        *way += impulse * d;
                    }
                }
                way
            })
            .collect();
        let steps: Vec<f64> = ways
            .iter()
            .map(|way| {
                let parts = way.iter().zip(sizes).map(|(w, size)| w.abs() / size);
                BESIDE / parts.fold(f64::MIN_POSITIVE, f64::max)
            })
            .collect();
        let mut base = vec![0.0; n - 1];
        for k in 0..m {
            let to = -values[s.which[k]] - 2.0 * s.alpha[k].clamp(0.1, 0.9) * steps[k];
            for (shift, way) in base.iter_mut().zip(&ways[k]) {
                *shift += to * way;
            }
        }
        let mut sides = self.sides().to_vec();
        s.which.iter().for_each(|&k| sides[k] = -1.0);
        let mut found = vec![Branch {
            part: 1.0 - s.alpha.iter().sum::<f64>(),
            shift: base.clone(),
            sides: sides.clone(),
        }];
        for k in 0..m {
            let mut shift = base.clone();
            for (shift, way) in shift.iter_mut().zip(&ways[k]) {
                *shift += 2.0 * steps[k] * way;
            }
            sides[s.which[k]] = 1.0;
            found.push(Branch {
                part: s.alpha[k],
                shift,
                sides: sides.clone(),
            });
            sides[s.which[k]] = -1.0;
        }
        found
    }

    /// Returns the side on which a switch that slid goes on: that of the branch of which there is
    /// more.
    pub(super) fn side_left_to(&mut self, numbers: &[f64], k: usize) -> i8 {
        let place = self.slides.which.iter().position(|&j| j == k);
        match place {
            Some(place) if self.weigh(numbers) && self.slides.alpha[place] < 0.5 => -1,
            _ => 1,
        }
    }

    /// Returns the change of the rates where switch `k` does   (n)
    fn change_by(&mut self, numbers: &[f64], k: usize) -> &[f64] {
        self.slides.which.push(k);
        self.weigh(numbers);
        self.slides.which.pop();
        let n = self.slides.base.len();
        let change = self.slides.changes.rchunks_exact(n.max(1)).next();
        change.map_or(&[], |change| &change[..n.saturating_sub(1)])
    }

    /// Returns whether the rate jumps where switch `k` changes.
    pub(super) fn rate_jumps(&mut self, numbers: &[f64], k: usize) -> bool {
        let largest = |all: &[f64]| all.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let change = largest(self.change_by(numbers, k));
        change > JUMP * largest(&self.slides.base)
    }

    /// Returns the unknown whose rate changes most where switch `k` does.
    pub(super) fn changed_most_by(&mut self, numbers: &[f64], k: usize) -> usize {
        let change = self.change_by(numbers, k).iter();
        let largest = change
            .enumerate()
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        largest.map_or(0, |(i, _)| i)
    }

    /// Evaluates the mean of the branches' rates; false where there is none.
    pub(super) fn run_sliding(&mut self, numbers: &[f64], rates: &mut [f64]) -> bool {
        if !self.weigh(numbers) {
            return false;
        }
        let s = &self.slides;
        let n = s.base.len();
        rates.copy_from_slice(&s.base);
        for (alpha, change) in s.alpha.iter().zip(s.changes.chunks_exact(n)) {
            for (rate, d) in rates[..n - 1].iter_mut().zip(change) {
                *rate += alpha * d;
            }
        }
        true
    }

    /// Puts the values of the switches that slide into their places.
    pub(super) fn sliding_values(&mut self, numbers: &[f64], values: &mut [f64]) {
        let found = self.weigh(numbers);
        for (&k, &alpha) in self.slides.which.iter().zip(&self.slides.alpha) {
            values[k] = if found {
                alpha.min(1.0 - alpha)
            } else {
                f64::NAN
            };
        }
    }

    /// Finds α; false where it is not determined.
    fn weigh(&mut self, numbers: &[f64]) -> bool {
        if !self.can_hold() {
            return false;
        }
        if !self.rates_of_branches(numbers) {
            return false;
        }
        // rates that a switch does not change do not say how much there is of its branches
        let n = self.slides.base.len();
        let mut changes = self.slides.changes.chunks_exact(n.max(1));
        let is_alike = changes.any(|change| change.iter().all(|d| *d == 0.0));
        if is_alike || !self.slopes_of_switches() {
            return false;
        }
        let s = &mut self.slides;
        let m = s.which.len();
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

    /// Evaluates f and each dₖ; all that slide are left on their negative sides. False: a loop has
    /// no solution on one of them.
    fn rates_of_branches(&mut self, numbers: &[f64]) -> bool {
        let (row, n) = (self.row, self.row.numbers.n_rates());
        self.put(numbers);
        let m = self.slides.which.len();
        let known = row.more();
        if self.slides.unknowns.len() != known.len() * (m + 1) {
            self.slides.unknowns = self.numbers[known].repeat(m + 1);
        }
        self.slides.base.resize(n, 0.0);
        self.slides.changes.resize(n * m, 0.0);
        self.slides.alpha.resize(m, 0.0);
        self.row_has_sides = false;
        for place in 0..m {
            self.numbers[row.side_at(self.slides.which[place])] = -1.0;
        }
        for place in 0..m {
            let side = row.side_at(self.slides.which[place]);
            self.numbers[side] = 1.0;
            if !self.run_branch(place + 1) {
                return false;
            }
            self.numbers[side] = -1.0;
        }
        if !self.run_branch(0) {
            return false;
        }
        let s = &mut self.slides;
        for change in s.changes.chunks_exact_mut(n) {
            for (d, f) in change.iter_mut().zip(&s.base) {
                *d -= f;
            }
        }
        true
    }

    /// Evaluates the rates on the sides that the row says: f as branch 0, those of the others into
    /// the places of their changes. False: a loop has no solution.
    fn run_branch(&mut self, branch: usize) -> bool {
        let places = self.row.more();
        let known = places.len() * branch..places.len() * (branch + 1);
        self.numbers[places.clone()].copy_from_slice(&self.slides.unknowns[known.clone()]);
        if self.solve_held().is_err() {
            self.slides.unknowns.clear();
            return false;
        }
        let s = &mut self.slides;
        s.unknowns[known].copy_from_slice(&self.numbers[places]);
        let n = s.base.len();
        let rates = match branch.checked_sub(1) {
            Some(k) => &mut s.changes[n * k..n * (k + 1)],
            None => &mut s.base[..],
        };
        branches::run(
            self.switching.as_ref(),
            &self.numbers,
            &mut self.held_work,
            rates,
        )
    }

    /// Evaluates the rates of σ along the base, with time, and along each change. False: a loop
    /// determines nothing there.
    fn slopes_of_switches(&mut self) -> bool {
        let Some(Switching { switches, .. }) = &self.switching else {
            return false;
        };
        let constant = |re: f64| Dual {
            re,
            eps: [0.0; WIDTH],
        };
        let s = &mut self.slides;
        let (n, m) = (s.base.len(), s.which.len());
        s.slopes.resize(m * (m + 1), 0.0);
        s.out.resize(switches.n_outputs(), constant(0.0));
        for first in (0..=m).step_by(WIDTH) {
            s.numbers.clear();
            s.numbers
                .extend(self.numbers.iter().map(|&re| constant(re)));
            let some = first..(first + WIDTH).min(m + 1);
            for j in some.clone() {
                let along = if j == 0 {
                    s.numbers[Layout::TIME].eps[0] = 1.0;
                    &s.base
                } else {
                    &s.changes[n * (j - 1)..n * j]
                };
                for (place, d) in self.row.numbers.y().zip(along) {
                    s.numbers[place].eps[j - first] = *d;
                }
            }
            if let Some(loops) = &mut self.loops
                && loops.follow(&mut s.numbers, first == 0).is_err()
            {
                return false;
            }
            switches.eval(&s.numbers, &mut s.work, &mut s.out);
            for j in some {
                for (slope, &k) in s.slopes[m * j..m * (j + 1)].iter_mut().zip(&s.which) {
                    *slope = s.out[k].eps[j - first];
                }
            }
        }
        true
    }
}
