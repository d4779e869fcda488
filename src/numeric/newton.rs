//! Newton's method, damped, for square systems `F(x) = 0` far from their solution: [`Newton`].
//!
//! ```text
//! J(x) Δ = −F(x),   x ← x + λ Δ                                                        (1)
//! J(x) Δ̄ = −F(x + λ Δ)                    the next correction with the same matrix      (2)
//! accept when ‖Δ̄‖ ≤ (1 − λ/4) ‖Δ‖         the correction shrinks                        (3)
//! λ' = ½ ‖Δ‖ λ² / ‖Δ̄ − (1−λ) Δ‖           the damping that the measured curvature allows (4)
//! ```
//!
//! Corrections are compared, not residuals: rows of any unit and scale may stand together, and no
//! row can dominate. Sizes are in units of the typical magnitude of each unknown. When a full step
//! leaves less than a quarter, the factors are kept and Δ̄ is the next correction.
//!
//! *Singular*: a matrix without a pivot in a column ends the iteration and names the unknown.
//! *No convergence* names the row with the largest residual, relative to the changes that typical
//! changes of its unknowns would make. *Failures* of the problem first halve the step.
//!
//! Source: Deuflhard, Newton Methods for Nonlinear Problems, 3.3 (NLEQ-ERR).

use super::control::worst;
use super::sparse::Factors;
use super::{Failure, Reason};

/// Smallest damping λ; a shorter correction is given up.
const LEAST_DAMPING: f64 = 1e-8;
/// Ratio ‖Δ̄‖/‖Δ‖ after a full correction up to which the factors are kept.
const KEEP_FACTORS_RATIO: f64 = 0.25;

/// A square system of nonlinear equations.
pub trait System {
    /// Number of unknowns and rows.
    fn size(&self) -> usize;
    /// `r = F(x)`
    ///
    /// # Errors
    /// When `F` has no finite value there.
    fn residual(&mut self, x: &[f64], r: &mut [f64]) -> Result<(), Failure>;
    /// Rows and columns of the entries of the Jacobian, fixed for the whole life of the problem.
    fn pattern(&self) -> Vec<(usize, usize)>;
    /// `values[e] = ∂F/∂x` at the `e`-th entry of the pattern.
    ///
    /// # Errors
    /// When it has no finite value there.
    fn jacobian(&mut self, x: &[f64], values: &mut [f64]) -> Result<(), Failure>;
    /// Typical magnitude of each unknown   (n)
    fn typical(&self, typical: &mut [f64]);
}

/// The record of a solution found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solved {
    /// corrections made
    pub iterations: usize,
    /// Jacobians factored
    pub factorizations: usize,
    /// size of the last correction, relative to typical magnitudes
    pub size: f64,
}

/// The reason why no solution was found; the unknowns are left at the best point reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotSolved {
    /// the cause, with the row or unknown at fault
    pub reason: Reason,
    /// corrections made
    pub iterations: usize,
    /// size of the last correction, relative to typical magnitudes
    pub size: f64,
}

/// Damped Newton; see the file's card. Solving again reuses the memory and, when it can, the pivot
/// order.
#[derive(Clone, Debug)]
pub struct Newton {
    factors: Factors,
    /// rows and columns of the entries of J
    pattern: Vec<(usize, usize)>,
    /// entries of J
    values: Vec<f64>,
    /// 1/typical   (n)
    scale: Vec<f64>,
    /// F   (n)
    r: Vec<f64>,
    /// Δ   (n)
    delta: Vec<f64>,
    /// Δ̄   (n)
    left: Vec<f64>,
    /// trial point   (n)
    trial: Vec<f64>,
}

/// The iteration so far.
struct Progress {
    /// corrections made
    iterations: usize,
    /// Jacobians factored
    factorizations: usize,
    /// ‖Δ‖ of the correction in work
    size: f64,
    /// λ of the correction in work
    damping: f64,
    /// λ‖Δ‖ and ‖Δ̄‖ of the correction before, for a forecast of the damping
    before: Option<(f64, f64)>,
}

/// Limits a damping to its range; a full correction where none is computed.
fn damping_within(damping: f64) -> f64 {
    if damping.is_finite() {
        damping.clamp(LEAST_DAMPING, 1.0)
    } else {
        1.0
    }
}

impl Newton {
    /// Prepares for systems with the pattern of `problem`.
    pub fn new<P: System + ?Sized>(problem: &P) -> Self {
        let (n, pattern) = (problem.size(), problem.pattern());
        let zeros = || vec![0.0; n];
        let mut scale = zeros();
        problem.typical(&mut scale);
        scale.iter_mut().for_each(|s| {
            *s = if s.is_finite() && *s != 0.0 {
                1.0 / s.abs()
            } else {
                1.0
            }
        });
        Newton {
            factors: Factors::new(n, &pattern),
            values: vec![0.0; pattern.len()],
            pattern,
            scale,
            r: zeros(),
            delta: zeros(),
            left: zeros(),
            trial: zeros(),
        }
    }

    /// Moves `x` to a solution: until the correction is below `tolerance` times the typical
    /// magnitudes, in at most `allowed` corrections.
    ///
    /// # Errors
    /// When the problem fails at `x`, the matrix is singular, or the iteration does not get there.
    pub fn solve<P: System + ?Sized>(
        &mut self,
        problem: &mut P,
        x: &mut [f64],
        tolerance: f64,
        allowed: usize,
    ) -> Result<Solved, NotSolved> {
        let mut progress = Progress {
            iterations: 0,
            factorizations: 0,
            size: f64::INFINITY,
            damping: 1.0,
            before: None,
        };
        let outcome = self.iterate(problem, x, (tolerance, allowed), &mut progress);
        let iterations = progress.iterations;
        match outcome {
            Ok(size) => Ok(Solved {
                iterations,
                factorizations: progress.factorizations,
                size,
            }),
            Err(reason) => Err(NotSolved {
                reason,
                iterations,
                size: progress.size,
            }),
        }
    }

    /// Alternates between new factors and the corrections that they are good for; returns the size
    /// of the last correction.
    fn iterate<P: System + ?Sized>(
        &mut self,
        problem: &mut P,
        x: &mut [f64],
        (tolerance, allowed): (f64, usize),
        progress: &mut Progress,
    ) -> Result<f64, Reason> {
        self.evaluate(problem, x)?;
        while progress.iterations < allowed {
            self.linearize(problem, x, progress)?;
            let limits = (tolerance, allowed);
            if let Some(size) = self.correct(problem, x, limits, progress)? {
                return Ok(size);
            }
        }
        Err(Reason::Newton(self.worst_row()))
    }

    /// Computes the correction (1) at `x` with new factors, and forecasts its damping.
    fn linearize<P: System + ?Sized>(
        &mut self,
        problem: &mut P,
        x: &[f64],
        progress: &mut Progress,
    ) -> Result<(), Reason> {
        problem
            .jacobian(x, &mut self.values)
            .map_err(Reason::Evaluation)?;
        progress.factorizations += 1;
        self.factors
            .factor(&self.values)
            .map_err(Reason::Singular)?;
        self.delta.copy_from_slice(&self.r);
        self.factors.solve(&mut self.delta);
        self.delta.iter_mut().for_each(|d| *d = -*d);
        progress.size = self.norm(&self.delta);
        if !progress.size.is_finite() {
            return Err(Reason::Newton(self.worst_row()));
        }
        if let Some((moved, left)) = progress.before {
            let change = self.distance(1.0);
            progress.damping = damping_within(moved * left / (change * progress.size));
        }
        Ok(())
    }

    /// Corrects `x` for as long as the factors are good; returns the size of the last correction
    /// once it is small enough.
    fn correct<P: System + ?Sized>(
        &mut self,
        problem: &mut P,
        x: &mut [f64],
        (tolerance, allowed): (f64, usize),
        progress: &mut Progress,
    ) -> Result<Option<f64>, Reason> {
        loop {
            progress.iterations += 1;
            if progress.size <= tolerance {
                x.iter_mut().zip(&self.delta).for_each(|(x, d)| *x += d);
                return Ok(Some(progress.size));
            }
            let (left, allowance) = self.damp(problem, x, progress)?;
            x.copy_from_slice(&self.trial);
            let full = progress.damping == 1.0;
            if left <= tolerance && full {
                x.iter_mut().zip(&self.left).for_each(|(x, l)| *x += l);
                return Ok(Some(left));
            }
            let quick = full && left <= KEEP_FACTORS_RATIO * progress.size;
            progress.before = Some((progress.damping * progress.size, left));
            progress.damping = damping_within(allowance);
            if !quick || progress.iterations >= allowed {
                return Ok(None);
            }
            // the same factors serve again
            std::mem::swap(&mut self.delta, &mut self.left);
            (progress.size, progress.damping) = (left, 1.0);
        }
    }

    /// Shortens the correction until the problem has a value at the trial point and (3) holds
    /// there.
    ///
    /// Returns ‖Δ̄‖, and the damping (4) for the next correction.
    fn damp<P: System + ?Sized>(
        &mut self,
        problem: &mut P,
        x: &[f64],
        progress: &mut Progress,
    ) -> Result<(f64, f64), Reason> {
        loop {
            let (size, damping) = (progress.size, progress.damping);
            for ((trial, x), d) in self.trial.iter_mut().zip(x).zip(&self.delta) {
                *trial = x + damping * d;
            }
            let mut trial = std::mem::take(&mut self.trial);
            let outcome = self.evaluate(problem, &trial);
            std::mem::swap(&mut self.trial, &mut trial);
            let verdict = match outcome {
                Ok(()) => {
                    let (left, allowance) = self.remaining(size, damping);
                    if left <= (1.0 - 0.25 * damping) * size {
                        return Ok((left, allowance));
                    }
                    Ok(allowance)
                }
                Err(
                    reason @ Reason::Evaluation(Failure {
                        recoverable: false, ..
                    }),
                ) => return Err(reason),
                Err(reason) => Err(reason),
            };
            progress.damping = match verdict {
                Ok(allowance) if allowance > 0.0 => (0.5 * damping).min(allowance),
                _ => 0.5 * damping,
            };
            if progress.damping < LEAST_DAMPING || progress.damping.is_nan() {
                // the residual of the point that is kept
                let kept = self.evaluate(problem, x).err();
                let cause = verdict.err().or(kept);
                return Err(cause.unwrap_or_else(|| Reason::Newton(self.worst_row())));
            }
        }
    }

    /// Computes Δ̄ of (2) from the residual at the trial point; returns ‖Δ̄‖ and the damping (4).
    fn remaining(&mut self, size: f64, damping: f64) -> (f64, f64) {
        self.left.copy_from_slice(&self.r);
        self.factors.solve(&mut self.left);
        self.left.iter_mut().for_each(|l| *l = -*l);
        let left = self.norm(&self.left);
        let curved = self.distance(1.0 - damping);
        (left, 0.5 * size * damping * damping / curved)
    }

    /// Returns `‖Δ̄ − part Δ‖`.
    fn distance(&self, part: f64) -> f64 {
        let both = self.left.iter().zip(&self.delta).zip(&self.scale);
        worst(both.map(|((l, d), s)| (l - part * d) * s))
    }

    /// Sets `r = F(x)`.
    ///
    /// # Errors
    /// When it is not finite.
    fn evaluate<P: System + ?Sized>(&mut self, problem: &mut P, x: &[f64]) -> Result<(), Reason> {
        problem
            .residual(x, &mut self.r)
            .map_err(Reason::Evaluation)?;
        self.r
            .iter()
            .position(|r| !r.is_finite())
            .map_or(Ok(()), |i| Err(Reason::NotFinite(i)))
    }

    /// Returns ‖x‖, in units of typical magnitudes.
    fn norm(&self, x: &[f64]) -> f64 {
        worst(x.iter().zip(&self.scale).map(|(x, s)| x * s))
    }

    /// Returns the row with the largest residual, relative to the largest change of it that typical
    /// changes of its unknowns would make.
    fn worst_row(&mut self) -> usize {
        self.left.fill(0.0);
        for ((i, j), v) in self.pattern.iter().zip(&self.values) {
            self.left[*i] = self.left[*i].max((v / self.scale[*j]).abs());
        }
        super::control::worst_index(
            self.r
                .iter()
                .zip(&self.left)
                .map(|(r, m)| if *r == 0.0 { 0.0 } else { r / m.max(1e-300) }),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `F` of two unknowns with a full Jacobian.
    struct Two<F, J> {
        f: F,
        j: J,
        calls: usize,
    }

    impl<F: Fn(&[f64]) -> [f64; 2], J: Fn(&[f64]) -> [f64; 4]> System for Two<F, J> {
        fn size(&self) -> usize {
            2
        }
        fn residual(&mut self, x: &[f64], r: &mut [f64]) -> Result<(), Failure> {
            self.calls += 1;
            r.copy_from_slice(&(self.f)(x));
            Ok(())
        }
        fn pattern(&self) -> Vec<(usize, usize)> {
            vec![(0, 0), (0, 1), (1, 0), (1, 1)]
        }
        fn jacobian(&mut self, x: &[f64], values: &mut [f64]) -> Result<(), Failure> {
            values.copy_from_slice(&(self.j)(x));
            Ok(())
        }
        fn typical(&self, typical: &mut [f64]) {
            typical.fill(1.0);
        }
    }

    #[test]
    fn a_steep_valley_is_descended() {
        // exp rows: undamped Newton overshoots by e^20 from here
        let mut problem = Two {
            f: |x: &[f64]| [x[0].exp() - 1.0 + x[1], x[1] - 0.5 * x[0]],
            j: |x: &[f64]| [x[0].exp(), 1.0, -0.5, 1.0],
            calls: 0,
        };
        for start in [[-20.0, 3.0], [20.0, -7.0], [0.1, 0.1]] {
            let mut x = start;
            let solved = Newton::new(&problem)
                .solve(&mut problem, &mut x, 1e-12, 100)
                .unwrap();
            assert!(
                x[0].abs() < 1e-11 && x[1].abs() < 1e-11,
                "{x:?} after {solved:?}"
            );
        }
        assert!(problem.calls < 150, "{} calls", problem.calls);
    }

    #[test]
    fn factors_are_kept_near_the_solution() {
        let mut problem = Two {
            f: |x: &[f64]| {
                [
                    x[0] + 0.01 * x[1] * x[1] - 1.0,
                    x[1] + 0.01 * x[0] * x[0] - 2.0,
                ]
            },
            j: |x: &[f64]| [1.0, 0.02 * x[1], 0.02 * x[0], 1.0],
            calls: 0,
        };
        let mut x = [0.0; 2];
        let solved = Newton::new(&problem)
            .solve(&mut problem, &mut x, 1e-13, 30)
            .unwrap();
        assert_eq!(solved.factorizations, 1);
        assert!(solved.iterations < 12);
    }

    #[test]
    fn rows_of_any_scale_stand_together() {
        let solve = |s: f64| {
            let mut problem = Two {
                f: move |x: &[f64]| [s * (x[0] * x[0] + x[1] * x[1] - 4.0), x[0] * x[1] - 1.0],
                j: move |x: &[f64]| [s * 2.0 * x[0], s * 2.0 * x[1], x[1], x[0]],
                calls: 0,
            };
            let mut x = [3.0, 0.1];
            Newton::new(&problem)
                .solve(&mut problem, &mut x, 1e-12, 50)
                .unwrap();
            (x, problem.calls)
        };
        let ((x, calls), (y, others)) = (solve(1.0), solve(1e12));
        assert!((x[0] - y[0]).abs() < 1e-12 && (x[1] - y[1]).abs() < 1e-12);
        assert_eq!(calls, others);
    }

    #[test]
    fn what_cannot_be_solved_names_its_row_or_unknown() {
        // x² + 1 = 0
        let mut problem = Two {
            f: |x: &[f64]| [x[0] - 1.0, x[1] * x[1] + 1.0],
            j: |x: &[f64]| [1.0, 0.0, 0.0, 2.0 * x[1]],
            calls: 0,
        };
        let mut x = [5.0, 3.0];
        let no = Newton::new(&problem)
            .solve(&mut problem, &mut x, 1e-10, 60)
            .unwrap_err();
        assert!(
            matches!(no.reason, Reason::Newton(1) | Reason::Singular(1)),
            "{no:?}"
        );
        assert!(problem.calls < 400);
        // nothing determines the second unknown
        let mut problem = Two {
            f: |x: &[f64]| [x[0], x[0]],
            j: |_: &[f64]| [1.0, 0.0, 1.0, 0.0],
            calls: 0,
        };
        let no = Newton::new(&problem)
            .solve(&mut problem, &mut [1.0, 1.0], 1e-10, 60)
            .unwrap_err();
        assert_eq!(no.reason, Reason::Singular(1));
        // no number
        let mut problem = Two {
            f: |x: &[f64]| [x[0].ln(), x[1]],
            j: |x: &[f64]| [1.0 / x[0], 0.0, 0.0, 1.0],
            calls: 0,
        };
        let no = Newton::new(&problem)
            .solve(&mut problem, &mut [-1.0, 1.0], 1e-10, 60)
            .unwrap_err();
        assert_eq!(no.reason, Reason::NotFinite(0));
        let mut x = [50.0, 1.0];
        Newton::new(&problem)
            .solve(&mut problem, &mut x, 1e-10, 60)
            .unwrap();
        assert!((x[0] - 1.0).abs() < 1e-9);
    }
}
