//! Newton's method, damped, for square systems `F(x) = 0` far from their solution: [`Newton`].
//!
//! ```text
//! J(x) Δ = −F(x),   x ← x + λ Δ                                                         (1)
//! J(x) Δ̄ = −F(x + λ Δ)                    what is left, seen through the same matrix     (2)
//! accept when ‖Δ̄‖ ≤ (1 − λ/4) ‖Δ‖         the correction shrinks                         (3)
//! λ' = ½ ‖Δ‖ λ² / ‖Δ̄ − (1−λ) Δ‖           damping that the curvature just seen allows    (4)
//! ```
//!
//! Corrections are compared, not residuals: rows of any unit and scale may stand together, and no row can dominate. Sizes are in units of the
//! typical magnitude of each unknown. When a full step leaves less than a quarter, the factors are kept and Δ̄ is the next correction.
//!
//! *Singular*: a matrix without a pivot in a column ends the iteration and names the unknown. *No convergence* names the row that contributes most to the residual,
//! each measured by what its own unknowns could contribute; *failures* of the problem halve the step first.
//!
//! Source: Deuflhard, Newton Methods for Nonlinear Problems, 3.3 (NLEQ-ERR).

use super::control::worst;
use super::sparse::Factors;
use super::{Failure, Reason};

/// Least damping.
const LEAST: f64 = 1e-8;
/// Part left by a full step up to which the factors are kept.
const KEEP: f64 = 0.25;

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

/// A solution found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solved {
    /// corrections made
    pub iterations: usize,
    /// Jacobians factored
    pub factorizations: usize,
    /// size of the last correction, relative to typical magnitudes
    pub size: f64,
}

/// Why none was found; the unknowns are left at the best point reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotSolved {
    /// the cause, with the row or unknown at fault
    pub reason: Reason,
    /// corrections made
    pub iterations: usize,
    /// size of the last correction, relative to typical magnitudes
    pub size: f64,
}

/// Damped Newton; see the file's card. Solving again reuses the memory and, when it can, the pivot order.
#[derive(Clone, Debug)]
pub struct Newton {
    factors: Factors,
    pattern: Vec<(usize, usize)>,
    values: Vec<f64>,
    /// 1/typical   (n)
    scale: Vec<f64>,
    /// F, Δ, Δ̄, trial point   (n each)
    r: Vec<f64>,
    delta: Vec<f64>,
    left: Vec<f64>,
    trial: Vec<f64>,
}

impl Newton {
    /// For systems with the pattern of `problem`.
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

    /// Moves `x` to a solution: until the correction is below `tolerance` times the typical magnitudes, in at most `allowed` corrections.
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
        let (mut iterations, mut factorizations) = (0, 0);
        let mut size = f64::INFINITY;
        let mut damping = 1.0f64;
        // λ‖Δ‖ and Δ̄ of the step before, for a forecast of the damping
        let mut before: Option<(f64, f64)> = None;
        let fail = |reason, iterations, size| {
            Err(NotSolved {
                reason,
                iterations,
                size,
            })
        };
        if let Err(reason) = self.evaluate(problem, x) {
            return fail(reason, iterations, size);
        }
        while iterations < allowed {
            // (1)
            if let Err(failure) = problem.jacobian(x, &mut self.values) {
                return fail(Reason::Evaluation(failure), iterations, size);
            }
            factorizations += 1;
            if let Err(unknown) = self.factors.factor(&self.values) {
                return fail(Reason::Singular(unknown), iterations, size);
            }
            self.delta.copy_from_slice(&self.r);
            self.factors.solve(&mut self.delta);
            self.delta.iter_mut().for_each(|d| *d = -*d);
            size = self.norm(&self.delta);
            if !size.is_finite() {
                return fail(Reason::Newton(self.worst_row()), iterations, size);
            }
            if let Some((reach, left)) = before {
                let change = worst(
                    self.left
                        .iter()
                        .zip(&self.delta)
                        .zip(&self.scale)
                        .map(|((l, d), s)| (l - d) * s),
                );
                let forecast = reach * left / (change * size);
                damping = if forecast.is_finite() {
                    forecast.clamp(LEAST, 1.0)
                } else {
                    1.0
                };
            }
            loop {
                iterations += 1;
                if size <= tolerance {
                    x.iter_mut().zip(&self.delta).for_each(|(x, d)| *x += d);
                    return Ok(Solved {
                        iterations,
                        factorizations,
                        size,
                    });
                }
                // (2), shorter while the problem fails or the correction does not shrink (3)
                let (left, allowance) = loop {
                    for ((trial, x), d) in self.trial.iter_mut().zip(&*x).zip(&self.delta) {
                        *trial = x + damping * d;
                    }
                    let mut trial = std::mem::take(&mut self.trial);
                    let outcome = self.evaluate(problem, &trial);
                    std::mem::swap(&mut self.trial, &mut trial);
                    let verdict = match outcome {
                        Ok(()) => {
                            self.left.copy_from_slice(&self.r);
                            self.factors.solve(&mut self.left);
                            self.left.iter_mut().for_each(|l| *l = -*l);
                            let left = self.norm(&self.left);
                            let keep = 1.0 - damping;
                            let curved = worst(
                                self.left
                                    .iter()
                                    .zip(&self.delta)
                                    .zip(&self.scale)
                                    .map(|((l, d), s)| (l - keep * d) * s),
                            );
                            let allowance = 0.5 * size * damping * damping / curved;
                            if left <= (1.0 - 0.25 * damping) * size {
                                break (left, allowance);
                            }
                            Ok(allowance)
                        }
                        Err(
                            reason @ Reason::Evaluation(Failure {
                                recoverable: false, ..
                            }),
                        ) => {
                            return fail(reason, iterations, size);
                        }
                        Err(reason) => Err(reason),
                    };
                    damping = match verdict {
                        Ok(allowance) if allowance > 0.0 => (0.5 * damping).min(allowance),
                        _ => 0.5 * damping,
                    };
                    if damping < LEAST || damping.is_nan() {
                        // the residual of the point that is kept
                        let kept = self.evaluate(problem, x).err();
                        let reason = verdict
                            .err()
                            .or(kept)
                            .unwrap_or_else(|| Reason::Newton(self.worst_row()));
                        return fail(reason, iterations, size);
                    }
                };
                x.copy_from_slice(&self.trial);
                if left <= tolerance && damping == 1.0 {
                    x.iter_mut().zip(&self.left).for_each(|(x, l)| *x += l);
                    return Ok(Solved {
                        iterations,
                        factorizations,
                        size: left,
                    });
                }
                let quick = damping == 1.0 && left <= KEEP * size;
                before = Some((damping * size, left));
                damping = if allowance.is_finite() {
                    allowance.clamp(LEAST, 1.0)
                } else {
                    1.0
                };
                if !quick || iterations >= allowed {
                    break;
                }
                // the same factors serve again
                std::mem::swap(&mut self.delta, &mut self.left);
                (size, damping) = (left, 1.0);
            }
        }
        fail(Reason::Newton(self.worst_row()), iterations, size)
    }

    /// `r = F(x)`, all of it finite.
    fn evaluate<P: System + ?Sized>(&mut self, problem: &mut P, x: &[f64]) -> Result<(), Reason> {
        problem
            .residual(x, &mut self.r)
            .map_err(Reason::Evaluation)?;
        self.r
            .iter()
            .position(|r| !r.is_finite())
            .map_or(Ok(()), |i| Err(Reason::NotFinite(i)))
    }

    fn norm(&self, x: &[f64]) -> f64 {
        worst(x.iter().zip(&self.scale).map(|(x, s)| x * s))
    }

    /// The row whose residual is largest, measured by what typical changes of its unknowns would contribute.
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
