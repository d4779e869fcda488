//! Numbers that stand beside the state and follow from it: unknowns of algebraic loops that are not linear.
//!
//! ```text
//! ρ(z; t, y) = 0:   z ← z − (∂ρ/∂z)⁻¹ ρ,  shortened while ρ would grow        dz/dy = −(∂ρ/∂z)⁻¹ ∂ρ/∂y
//! ```
//!
//! The iteration begins where the last one ended, so that z follows its branch as the state moves.

use crate::analysis::system::slopes;
use crate::expr::program::{Program, Work};
use crate::numeric::dense::Lu;
use crate::scalar::Dual;
use crate::scene::configuration::Configured;
use crate::scene::equations::Unsupported;
use crate::scene::loops;
use std::ops::Range;

/// Directions of a dual number in one sweep.
pub(in crate::analysis) const WIDTH: usize = 8;
const ITERATIONS: usize = 60;
/// Change of an unknown, relative to its size, that counts as rounding.
const ROUNDING: f64 = 1e-14;
/// The same for a step by factors from elsewhere that leads no further, relative to the largest unknown.
const STALLED: f64 = 1e-13;
/// Factors from elsewhere serve as long as each step leaves no more than this part of the residual.
const SERVES: f64 = 0.2;

/// Solves the loops of a scene.
#[derive(Debug)]
pub(in crate::analysis) struct AlgebraicLoops {
    residual: Program,
    /// ∂ρ/∂z by rows, where it is not too long, and its values
    gradient: Option<(Program, Work, Vec<f64>)>,
    places: Range<usize>,
    work: Work,
    dual_work: Work<Dual<WIDTH>>,
    dual_numbers: Vec<Dual<WIDTH>>,
    dual_out: Vec<Dual<WIDTH>>,
    rho: Vec<f64>,
    trial: Vec<f64>,
    step: Vec<f64>,
    lu: Lu,
    /// `lu` holds factors, of ∂ρ/∂z here or where it was last solved
    factored: bool,
}

fn lift(x: f64) -> Dual<WIDTH> {
    Dual {
        re: x,
        eps: [0.0; WIDTH],
    }
}

/// What a step by factors from elsewhere came to.
enum Simplified {
    /// the residual it leaves
    Nearer(f64),
    /// as near as rounding lets
    Arrived,
    /// it needs factors of its own
    Fails,
}

impl AlgebraicLoops {
    /// Of a scene; `None` when it has no such unknowns.
    pub fn new(scene: Configured<'_>) -> Result<Option<Self>, Vec<Unsupported>> {
        let n = scene.layout.n_loops;
        let places = scene.layout.loops();
        Ok(loops::program(scene)?.map(|residual| Self {
            gradient: slopes::recorded(&residual, n, places.clone())
                .map(|program| (program, Work::default(), vec![0.0; n * n])),
            residual,
            places,
            work: Work::default(),
            dual_work: Work::default(),
            dual_numbers: Vec::new(),
            dual_out: vec![lift(0.0); n],
            rho: vec![0.0; n],
            trial: vec![0.0; n],
            step: vec![0.0; n],
            lu: Lu::new(n),
            factored: false,
        }))
    }

    fn evaluate(&mut self, numbers: &[f64]) -> f64 {
        self.residual.run(numbers, &mut self.work, &mut self.rho);
        self.rho.iter().map(|r| r * r).sum::<f64>().sqrt()
    }

    /// Factors ∂ρ/∂z.
    fn factor(&mut self, numbers: &[f64]) -> Result<(), usize> {
        let n = self.rho.len();
        if let Some((program, work, entries)) = &mut self.gradient {
            program.run(numbers, work, entries);
            for (i, row) in entries.chunks(n).enumerate() {
                for (k, &entry) in row.iter().enumerate() {
                    self.lu.matrix_mut()[i + n * k] = entry;
                }
            }
            return self.factors();
        }
        self.dual_numbers.clear();
        self.dual_numbers.extend(numbers.iter().map(|&x| lift(x)));
        for first in (0..n).step_by(WIDTH) {
            let last = (first + WIDTH).min(n);
            for k in first..last {
                self.dual_numbers[self.places.start + k].eps[k - first] = 1.0;
            }
            self.residual
                .eval(&self.dual_numbers, &mut self.dual_work, &mut self.dual_out);
            for k in first..last {
                self.dual_numbers[self.places.start + k].eps[k - first] = 0.0;
                for (i, out) in self.dual_out.iter().enumerate() {
                    self.lu.matrix_mut()[i + n * k] = out.eps[k - first];
                }
            }
        }
        self.factors()
    }

    fn factors(&mut self) -> Result<(), usize> {
        let outcome = self.lu.factor(1e-14);
        self.factored = outcome.is_ok();
        outcome
    }

    /// Solves for the unknowns in a row of numbers.
    ///
    /// # Errors
    /// The index of an unknown whose loop has no solution near.
    pub fn solve(&mut self, numbers: &mut [f64]) -> Result<(), usize> {
        let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let begun = largest(&numbers[self.places.clone()]);
        let mut size = self.evaluate(numbers);
        for _ in 0..ITERATIONS {
            if size == 0.0 {
                return Ok(());
            }
            if !size.is_finite() {
                break;
            }
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
            self.factor(numbers)?;
            self.step.copy_from_slice(&self.rho);
            self.lu.solve(&mut self.step);
            let z = &numbers[self.places.clone()];
            let small = z.iter().zip(&self.step);
            let arrived = small.fold(true, |all, (z, d)| all && d.abs() <= ROUNDING * z.abs());
            self.trial.copy_from_slice(z);
            let mut part = 1.0;
            let better = loop {
                for ((z, old), d) in numbers[self.places.clone()]
                    .iter_mut()
                    .zip(&self.trial)
                    .zip(&self.step)
                {
                    *z = old - part * d;
                }
                let next = self.evaluate(numbers);
                if next < size {
                    size = next;
                    break true;
                }
                part *= 0.5;
                if part < 1e-6 || arrived {
                    numbers[self.places.clone()].copy_from_slice(&self.trial);
                    break false;
                }
            };
            if arrived {
                return Ok(());
            }
            if !better {
                // no better number: rounding, or no solution
                self.evaluate(numbers);
                let z = &numbers[self.places.clone()];
                let largest = z.iter().fold(1e-300, |m: f64, z| m.max(z.abs()));
                // a number that is zero but for rounding is as exact as the others make it
                let rounding =
                    |(z, d): (&f64, &f64)| d.abs() <= 1e-9 * z.abs() || d.abs() <= 1e-13 * largest;
                if z.iter().zip(&self.step).all(rounding) {
                    return Ok(());
                }
                break;
            }
        }
        // a solution that is zero is approached for ever: what is left is nothing beside where it began
        let about = begun.max(largest(&numbers[self.places.clone()]));
        if size.is_finite() && largest(&self.step) <= 1e-14 * about {
            return Ok(());
        }
        let worst = (0..self.rho.len()).max_by(|&a, &b| {
            let size = |k: usize| {
                if self.rho[k].is_finite() {
                    self.rho[k].abs()
                } else {
                    f64::INFINITY
                }
            };
            size(a).total_cmp(&size(b))
        });
        Err(worst.unwrap_or(0))
    }

    /// A step by the factors from where it was last solved.
    fn simplified(&mut self, numbers: &mut [f64], size: f64) -> Simplified {
        self.step.copy_from_slice(&self.rho);
        self.lu.solve(&mut self.step);
        let z = &mut numbers[self.places.clone()];
        self.trial.copy_from_slice(z);
        for (z, d) in z.iter_mut().zip(&self.step) {
            *z -= d;
        }
        let next = self.evaluate(numbers);
        if next <= SERVES * size {
            return Simplified::Nearer(next);
        }
        let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
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

    /// Puts dz along the directions of the other numbers into the places of the unknowns, whose own derivatives are zero;
    /// the loops are solved at these numbers.
    ///
    /// # Errors
    /// The index of an unknown that nothing determines.
    pub fn follow(&mut self, numbers: &mut [Dual<WIDTH>], first: bool) -> Result<(), usize> {
        if first {
            let plain: Vec<f64> = numbers.iter().map(|x| x.re).collect();
            self.factor(&plain)?;
        }
        self.residual
            .eval(numbers, &mut self.dual_work, &mut self.dual_out);
        for direction in 0..WIDTH {
            for (s, out) in self.step.iter_mut().zip(&self.dual_out) {
                *s = -out.eps[direction];
            }
            self.lu.solve(&mut self.step);
            for (z, s) in numbers[self.places.clone()].iter_mut().zip(&self.step) {
                z.eps[direction] = *s;
            }
        }
        Ok(())
    }

    /// Tells along which directions the unknowns change: as they are solved for together, those along which any loop does.
    pub fn depend(&self, along: &mut [Vec<u32>]) {
        let mut all: Vec<u32> = self.residual.dependence(along).concat();
        all.sort_unstable();
        all.dedup();
        along[self.places.clone()].fill(all);
    }

    /// Takes the derivatives of the unknowns away again.
    pub fn forget(&self, numbers: &mut [Dual<WIDTH>]) {
        for z in &mut numbers[self.places.clone()] {
            z.eps = [0.0; WIDTH];
        }
    }
}
