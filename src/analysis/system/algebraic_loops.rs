//! Numbers that stand beside the state and follow from it: unknowns of algebraic loops that are not
//! linear.
//!
//! ```text
//! ρ(z; t, y) = 0:   z ← z − (∂ρ/∂z)⁻¹ ρ,  shortened while ρ would grow        dz/dy = −(∂ρ/∂z)⁻¹ ∂ρ/∂y
//! ```
//!
//! The iteration begins where the last one ended, so that z follows its branch as the state moves.
//! The first one begins at the guesses; where that leads nowhere, as at a root that has no slope at
//! zero, at `z + ρ(z)`: what is read is taken to be what it turns out to be.
//! It ends at rounding, which is measured: reactions that nearly vanish are differences of large
//! loads, and ρ is rounded as these are. Where no step leads further, the residual counts as zero
//! if positions moved by a few units in their last place change it as much.

use super::loop_factors::LoopFactors;
use super::recording::Recording;
use super::tangents::Tangents;
use crate::expr::program::{LANES, Lane, Parted, Program, Work};
use crate::numeric::pattern::Pattern;
use crate::scalar::Dual;
use crate::scene::configuration::Configured;
use crate::scene::equations::Unsupported;
use crate::scene::loops;
use crate::scene::slopes::{self, WIDTH};
use crate::scene::{Scene, Source};
use std::ops::Range;

/// Iterations of a loop, at most: halving makes ε of 1 in 52.
const MAX_ITERATIONS: usize = 60;
/// Smallest part of a step that is tried.
const SHORTEST_PART: f64 = 1e-6;
/// Change of an unknown, relative to its size, that counts as rounding.
const ROUNDING: f64 = 1e-14;
/// The same for a step by factors from elsewhere that leads no further, relative to the largest
/// unknown.
const STALLED: f64 = 1e-13;
/// Part of the residual that a step by factors from elsewhere may leave: else new ones are
/// computed.
const CONTRACTION: f64 = 0.2;
/// Units in the last place by which positions are moved to measure rounding, of their size or of
/// the mechanism's.
const MOVED_BY: f64 = 2.0 * f64::EPSILON;
/// Directions along which positions are moved.
const MOVED_ALONG: usize = 4;
/// Residual that counts as rounding, as a multiple of the largest change so measured.
const ROUNDING_MARGIN: f64 = 8.0;

/// Solves the loops of a scene.
#[derive(Clone, Debug)]
pub(in crate::analysis) struct AlgebraicLoops {
    residual: Program,
    /// what ρ needs of a state, whatever z is, computed once for each
    fixed: Recording,
    /// ρ of z and of that
    rest: Program,
    /// z, then what `fixed` has computed for the state
    row: Vec<f64>,
    /// ∂ρ/∂z of `rest` by rows, where it is not too long   (n × n)
    gradient: Option<Recording>,
    places: Range<usize>,
    work: Work,
    dual_work: Work<Dual<WIDTH>>,
    follow_work: Work<Dual<WIDTH>>,
    dual_numbers: Vec<Dual<WIDTH>>,
    dual_out: Vec<Dual<WIDTH>>,
    /// derivatives of the residual along numbers of the state
    along_state: Tangents,
    /// derivatives of `rest` along z
    along_unknowns: Tangents,
    /// derivatives of `row`, and of ρ, along many directions
    lanes: [Vec<Lane>; 2],
    rho: Vec<f64>,
    trial: Vec<f64>,
    step: Vec<f64>,
    /// places of the entries of ∂ρ/∂z
    pattern: Pattern,
    factors: LoopFactors,
    /// `factors` are of ∂ρ/∂z here or where it was last solved
    factored: bool,
    /// the factors that are not in use, whether they were, and the rounding that belongs to them
    others: (LoopFactors, bool, f64),
    /// the factors in use are those for evaluations aside
    is_aside: bool,
    /// sizes of positions: angles count from one, lengths from that of the mechanism   (n_q)
    sizes: Vec<f64>,
    /// where positions stand
    positions: Range<usize>,
    /// rounding of ρ as it was measured since the last factors; zero: not yet
    rounding: f64,
    /// the loops were solved before
    follows: bool,
}

/// Returns the sizes from which positions count when they are rounded   (n_q)
fn sizes_of_positions(scene: &Scene) -> Vec<f64> {
    let mut sizes = vec![1.0; scene.layout.n_q];
    for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
        if let Source::Free { q, .. } = c.source
            && !c.angular
            && !f.in_ball
        {
            sizes[q] = scene.length;
        }
    }
    sizes
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0_f64, |m, x| m.max(x.abs()))
}

fn lift(x: f64) -> Dual<WIDTH> {
    Dual {
        re: x,
        eps: [0.0; WIDTH],
    }
}

/// The result of a step by factors from elsewhere.
enum Simplified {
    /// the residual it leaves
    Nearer(f64),
    /// as near as rounding lets
    Arrived,
    /// it needs factors of its own
    Fails,
}

impl AlgebraicLoops {
    /// Records the loops of a scene; `None` when it has no such unknowns.
    pub fn new(scene: Configured<'_>) -> Result<Option<Self>, Vec<Unsupported>> {
        let places = scene.layout.loops();
        Ok(loops::program(scene)?.map(|residual| Self::of(&scene, residual, places)))
    }

    /// Prepares to solve for the unknowns at some places of a row, which zero a residual of it.
    pub(super) fn of(scene: &Scene, residual: Program, places: Range<usize>) -> Self {
        let n = places.len();
        let mut along = vec![Vec::new(); places.end];
        for (k, own) in along[places.clone()].iter_mut().enumerate() {
            own.push(k as u32);
        }
        let rows = residual.dependence(&along);
        let pattern = Pattern::of_rows(n, &rows);
        let Parted { fixed, rest } = residual.parted(places.clone());
        Self {
            factors: LoopFactors::new(&rows, &pattern),
            others: (LoopFactors::new(&rows, &pattern), false, 0.0),
            is_aside: false,
            pattern,
            gradient: slopes::recorded(&rest, n, 0..n).map(Recording::new),
            row: vec![0.0; n + fixed.n_outputs()],
            fixed: Recording::new(fixed),
            rest,
            residual,
            places,
            work: Work::default(),
            dual_work: Work::default(),
            follow_work: Work::default(),
            dual_numbers: Vec::new(),
            dual_out: vec![lift(0.0); n],
            along_state: Tangents::default(),
            along_unknowns: Tangents::default(),
            lanes: [Vec::new(), vec![Lane::ZERO; n]],
            rho: vec![0.0; n],
            trial: vec![0.0; n],
            step: vec![0.0; n],
            factored: false,
            sizes: sizes_of_positions(scene),
            positions: scene.layout.q(),
            rounding: 0.0,
            follows: false,
        }
    }

    /// Exchanges the factors with those for evaluations aside, which begin with none, or back.
    pub(super) fn exchange_factors(&mut self) {
        let (factors, factored, rounding) = &mut self.others;
        std::mem::swap(&mut self.factors, factors);
        std::mem::swap(&mut self.factored, factored);
        std::mem::swap(&mut self.rounding, rounding);
        self.is_aside = !self.is_aside;
        if self.is_aside {
            (self.factored, self.rounding) = (false, 0.0);
        }
    }

    /// Prepares the row for the state in `numbers`.
    fn see(&mut self, numbers: &[f64]) {
        let fixed = self.fixed.run(numbers);
        self.row[self.places.len()..].copy_from_slice(fixed);
    }

    /// Evaluates ρ of the unknowns in `numbers` at the state that was seen last; its size.
    fn evaluate(&mut self, numbers: &[f64]) -> f64 {
        self.row[..self.places.len()].copy_from_slice(&numbers[self.places.clone()]);
        self.rest.run(&self.row, &mut self.work, &mut self.rho);
        self.rho.iter().map(|r| r * r).sum::<f64>().sqrt()
    }

    /// Factors ∂ρ/∂z at the unknowns in `numbers` and the state that was seen last.
    fn factor(&mut self, numbers: &[f64]) -> Result<(), usize> {
        let n = self.rho.len();
        self.row[..n].copy_from_slice(&numbers[self.places.clone()]);
        if let Some(gradient) = &mut self.gradient {
            let entries = gradient.run(&self.row);
            for (entry, (i, k)) in self.factors.entries.iter_mut().zip(self.pattern.entries()) {
                *entry = entries[i * n + k];
            }
            return self.factors();
        }
        if (self.along_unknowns)
            .at(&self.row, &self.rest, |k| k < n)
            .is_some()
        {
            self.entries_together();
            return self.factors();
        }
        self.dual_numbers.clear();
        self.dual_numbers.extend(self.row.iter().map(|&x| lift(x)));
        for some in self.pattern.groups().chunks(WIDTH) {
            for (k, group) in some.iter().enumerate() {
                for &place in group {
                    self.dual_numbers[place].eps[k] = 1.0;
                }
            }
            self.rest
                .eval(&self.dual_numbers, &mut self.dual_work, &mut self.dual_out);
            for (k, group) in some.iter().enumerate() {
                for &place in group {
                    self.dual_numbers[place].eps[k] = 0.0;
                    for (entry, i) in self.pattern.column(place) {
                        self.factors.entries[entry] = self.dual_out[i].eps[k];
                    }
                }
            }
        }
        self.factors()
    }

    /// Computes the entries of ∂ρ/∂z by recorded derivatives, at the row that was seen.
    fn entries_together(&mut self) {
        let Some(tangent) = self.along_unknowns.here() else {
            return;
        };
        let [row, rho] = &mut self.lanes;
        row.resize(self.row.len(), Lane::ZERO);
        for some in self.pattern.groups().chunks(LANES) {
            for (k, group) in some.iter().enumerate() {
                group.iter().for_each(|&place| row[place].set(k, 1.0));
            }
            tangent.along(some.len(), row, rho);
            for (k, group) in some.iter().enumerate() {
                for &place in group {
                    row[place].set(k, 0.0);
                    for (entry, i) in self.pattern.column(place) {
                        self.factors.entries[entry] = rho[i].get(k);
                    }
                }
            }
        }
    }

    fn factors(&mut self) -> Result<(), usize> {
        let outcome = self.factors.factor();
        self.rounding = 0.0;
        self.factored = outcome.is_ok();
        outcome
    }

    /// Solves for the unknowns in a row of numbers.
    ///
    /// # Errors
    /// The index of an unknown whose loop has no solution near.
    pub fn solve(&mut self, numbers: &mut [f64]) -> Result<(), usize> {
        if self.follows {
            return self.iterate(numbers);
        }
        let guess = numbers[self.places.clone()].to_vec();
        let mut outcome = self.iterate(numbers);
        if let Err(first) = outcome {
            numbers[self.places.clone()].copy_from_slice(&guess);
            self.see(numbers);
            self.evaluate(numbers);
            let all = numbers[self.places.clone()].iter_mut().zip(&self.rho);
            all.for_each(|(z, rho)| *z += rho);
            outcome = self.iterate(numbers).map_err(|_| first);
        }
        self.follows = outcome.is_ok();
        outcome
    }

    /// Solves from where the unknowns in a row of numbers are.
    fn iterate(&mut self, numbers: &mut [f64]) -> Result<(), usize> {
        let begun = largest(&numbers[self.places.clone()]);
        self.see(numbers);
        let mut size = self.evaluate(numbers);
        for _ in 0..MAX_ITERATIONS {
            if size <= self.rounding {
                return Ok(());
            }
            if !size.is_finite() {
                break;
            }
            // by factors from elsewhere
            if self.factored {
                match self.simplified(numbers, size) {
                    Simplified::Nearer(next) => {
                        size = next;
                        continue;
                    }
                    Simplified::Arrived => return Ok(()),
                    Simplified::Fails => {}
                }
            }
            // by factors of its own
            self.factor(numbers)?;
            self.step.copy_from_slice(&self.rho);
            self.factors.solve(&mut self.step);
            let z = &numbers[self.places.clone()];
            let small = |(z, d): (&f64, &f64)| d.abs() <= ROUNDING * z.abs();
            let arrived = z.iter().zip(&self.step).all(small);
            let better = self.search(numbers, size, arrived);
            if arrived {
                return Ok(());
            }
            match better {
                Some(next) => size = next,
                // no better number: rounding, or no solution
                None => {
                    self.evaluate(numbers);
                    if self.is_rounding(&numbers[self.places.clone()])
                        || size <= self.measure_rounding(numbers)
                    {
                        return Ok(());
                    }
                    break;
                }
            }
        }
        // a solution that is zero is approached for ever: what is left is nothing beside its
        // beginning
        let about = begun.max(largest(&numbers[self.places.clone()]));
        if size.is_finite() && largest(&self.step) <= ROUNDING * about {
            return Ok(());
        }
        Err(self.worst())
    }

    /// Goes along the step, shortened while the residual would grow; the residual there, or `None`
    /// where it is nowhere smaller and the unknowns are what they were.
    fn search(&mut self, numbers: &mut [f64], size: f64, arrived: bool) -> Option<f64> {
        let places = self.places.clone();
        self.trial.copy_from_slice(&numbers[places.clone()]);
        let mut part = 1.0;
        loop {
            let z = numbers[places.clone()].iter_mut();
            for ((z, old), d) in z.zip(&self.trial).zip(&self.step) {
                *z = old - part * d;
            }
            let next = self.evaluate(numbers);
            if next < size {
                return Some(next);
            }
            part *= 0.5;
            if part < SHORTEST_PART || arrived {
                numbers[places].copy_from_slice(&self.trial);
                return None;
            }
        }
    }

    /// Returns whether the step is rounding of the unknowns `z`; one that is zero but for rounding
    /// is as exact as the others make it.
    fn is_rounding(&self, z: &[f64]) -> bool {
        let largest = z.iter().fold(1e-300, |m: f64, z| m.max(z.abs()));
        let rounding =
            |(z, d): (&f64, &f64)| d.abs() <= 1e-9 * z.abs() || d.abs() <= 1e-13 * largest;
        z.iter().zip(&self.step).all(rounding)
    }

    /// Measures the rounding of ρ, whose present value is left in place.
    fn measure_rounding(&mut self, numbers: &mut [f64]) -> f64 {
        let here = numbers[self.positions.clone()].to_vec();
        let rho = self.rho.clone();
        let mut largest = 0.0_f64;
        for along in 0..MOVED_ALONG {
            let moved = numbers[self.positions.clone()].iter_mut();
            for (k, (q, size)) in moved.zip(&self.sizes).enumerate() {
                // four directions at right angles: signs of a Hadamard matrix
                let side = if (k & along).count_ones() % 2 == 0 {
                    1.0
                } else {
                    -1.0
                };
                *q += side * MOVED_BY * q.abs().max(*size);
            }
            self.see(numbers);
            self.evaluate(numbers);
            let change = self.rho.iter().zip(&rho).map(|(a, b)| (a - b) * (a - b));
            largest = largest.max(change.sum::<f64>().sqrt());
            numbers[self.positions.clone()].copy_from_slice(&here);
        }
        self.see(numbers);
        self.rho = rho;
        self.rounding = ROUNDING_MARGIN * largest;
        self.rounding
    }

    /// Returns the unknown with the largest residual.
    fn worst(&self) -> usize {
        let size = |k: usize| {
            if self.rho[k].is_finite() {
                self.rho[k].abs()
            } else {
                f64::INFINITY
            }
        };
        let worst = (0..self.rho.len()).max_by(|&a, &b| size(a).total_cmp(&size(b)));
        worst.unwrap_or(0)
    }

    /// A step by the factors from where it was last solved.
    fn simplified(&mut self, numbers: &mut [f64], size: f64) -> Simplified {
        self.step.copy_from_slice(&self.rho);
        self.factors.solve(&mut self.step);
        let z = &mut numbers[self.places.clone()];
        self.trial.copy_from_slice(z);
        for (z, d) in z.iter_mut().zip(&self.step) {
            *z -= d;
        }
        let next = self.evaluate(numbers);
        if next <= CONTRACTION * size {
            return Simplified::Nearer(next);
        }
        let arrived = largest(&self.step) <= STALLED * largest(&self.trial);
        if !arrived || next > size || next.is_nan() {
            numbers[self.places.clone()].copy_from_slice(&self.trial);
            self.evaluate(numbers);
        }
        if arrived {
            Simplified::Arrived
        } else {
            self.factored = false;
            Simplified::Fails
        }
    }

    /// Puts dz along the directions of the other numbers into the places of the unknowns, whose own
    /// derivatives are zero; the loops are solved at these numbers.
    ///
    /// # Errors
    /// The index of an unknown that nothing determines.
    pub fn follow(&mut self, numbers: &mut [Dual<WIDTH>], first: bool) -> Result<(), usize> {
        if first {
            let plain: Vec<f64> = numbers.iter().map(|x| x.re).collect();
            self.see(&plain);
            self.factor(&plain)?;
        }
        self.residual
            .eval(numbers, &mut self.follow_work, &mut self.dual_out);
        for direction in 0..WIDTH {
            for (s, out) in self.step.iter_mut().zip(&self.dual_out) {
                *s = -out.eps[direction];
            }
            self.factors.solve(&mut self.step);
            for (z, s) in numbers[self.places.clone()].iter_mut().zip(&self.step) {
                z.eps[direction] = *s;
            }
        }
        Ok(())
    }

    /// Prepares to follow many directions at once from a row of numbers at which the loops are
    /// solved; returns whether that is possible. `varies`: the numbers that directions may change.
    ///
    /// # Errors
    /// The index of an unknown that nothing determines.
    pub fn look_along(
        &mut self,
        numbers: &[f64],
        varies: impl Fn(usize) -> bool,
    ) -> Result<bool, usize> {
        let recorded = self.along_state.at(numbers, &self.residual, varies);
        if recorded.is_none() {
            return Ok(false);
        }
        self.see(numbers);
        self.factor(numbers)?;
        Ok(true)
    }

    /// Does for the first `n` directions of a row of lanes what [`Self::follow`] does for duals,
    /// where [`Self::look_along`] has looked.
    pub fn follow_together(&mut self, lanes: &mut [Lane], n: usize) {
        let Some(tangent) = self.along_state.here() else {
            return;
        };
        let rho = &mut self.lanes[1];
        tangent.along(n, lanes, rho);
        for direction in 0..n {
            for (s, rho) in self.step.iter_mut().zip(rho.iter()) {
                *s = -rho.get(direction);
            }
            self.factors.solve(&mut self.step);
            for (z, s) in lanes[self.places.clone()].iter_mut().zip(&self.step) {
                z.set(direction, *s);
            }
        }
    }

    /// Returns where the unknowns stand in a row of numbers.
    pub fn places(&self) -> Range<usize> {
        self.places.clone()
    }

    /// Puts into the places of the unknowns along which directions they change: those along which
    /// any loop does that is solved with theirs.
    pub fn depend(&self, along: &mut [Vec<u32>]) {
        let rows = self.residual.dependence(along);
        for part in self.factors.parts() {
            let own = part.rows.iter().flat_map(|&r| &rows[r]);
            let mut all: Vec<u32> = own.copied().collect();
            all.sort_unstable();
            all.dedup();
            for column in &part.columns {
                along[self.places.clone()][*column].clone_from(&all);
            }
        }
    }

    /// Takes the derivatives of the unknowns away again.
    pub fn forget(&self, numbers: &mut [Dual<WIDTH>]) {
        for z in &mut numbers[self.places.clone()] {
            z.eps = [0.0; WIDTH];
        }
    }
}
