//! The implicit equations of one step of a DAE method: Newton with a kept matrix.
//!
//! ```text
//! F(t, ŷ + e, ẏ̂ + cj e) = 0                      ŷ, ẏ̂ predicted, cj of the method                   (1)
//! (∂F/∂y + cj₀ ∂F/∂ẏ) Δ = −F,   e += 2/(1 + cj/cj₀) Δ        matrix of an earlier step               (2)
//! h^rowsᵢ Fᵢ,  h^unknownsⱼ yⱼ                     scaled by levels, h ≈ 1/cj a power of two           (3)
//! ```
//!
//! The matrix is kept until cj leaves [0.6, 1.67] cj₀ or the iteration converges too slowly with it; then it is evaluated and factored anew and the
//! iteration repeated, and only when that fails too the step is at fault. The measured rate ρ of convergence predicts the error left, ρ/(1−ρ) ‖Δ‖,
//! which must be a small part of the error permitted in a step.
//!
//! Unknowns whose error is not controlled are looked at loosely, multipliers of higher index not at all: they are linear in the rest of the
//! iteration and carry rounding errors of order 1/h², which no iteration removes.
//!
//! Source: Brenan, Campbell & Petzold, Numerical Solution of Initial-Value Problems in DAEs, 5.2.2; Petzold & Lötstedt 1986 for (3).

use super::control::{worst, worst_index};
use super::sparse::Factors;
use super::{Dae, Failure, Kind, Options, Reason, Stats};

/// Error left in the iteration, as part of the error permitted in a step.
const SHARE: f64 = 0.1;
/// Change of cj beyond which the matrix is factored anew.
const CJ_RANGE: f64 = 0.6;
/// Rate of convergence beyond which the iteration is given up.
const SLOWEST: f64 = 0.9;
/// The rate of convergence with a kept matrix is trusted less from step to step: ρ/(1−ρ) to this power.
const AGEING: f64 = 0.7;
/// Least accuracy asked of uncontrolled algebraic unknowns, relative to their magnitude.
const LOOSE: f64 = 1e-3;

/// Newton's iteration for (1).
#[derive(Clone, Debug)]
pub struct Corrector {
    allowed: usize,
    factors: Factors,
    /// entries of the Jacobian; power of h of each, from −4 to 4   (entries)
    values: Vec<f64>,
    level: Vec<i8>,
    /// powers of h of rows and unknowns   (n each)
    rows: Vec<u8>,
    unknowns: Vec<u8>,
    /// which unknowns the norms look at, and how closely: 1 controlled, less loosely, 0 not   (n)
    attention: Vec<f64>,
    /// residual, then correction   (n)
    delta: Vec<f64>,
    /// coefficient and scaling step of the factors; 0 when there are none
    cj: f64,
    h: f64,
    /// ρ/(1−ρ) of the last iteration with these factors, and the first correction of it
    rate_factor: f64,
    measured: f64,
}

/// Why (1) was not solved.
#[derive(Clone, Copy, Debug)]
pub struct Trouble {
    /// the cause, for a [`super::Stop`]
    pub reason: Reason,
    /// whether a shorter step may help
    pub recoverable: bool,
}

impl Trouble {
    fn of(failure: Failure) -> Self {
        Trouble {
            reason: Reason::Evaluation(failure),
            recoverable: failure.recoverable,
        }
    }
    fn may_pass(reason: Reason) -> Self {
        Trouble {
            reason,
            recoverable: true,
        }
    }
}

impl Corrector {
    /// A corrector for `n` unknowns; [`Corrector::start`] learns the pattern.
    pub fn new(n: usize, options: &Options) -> Self {
        Corrector {
            allowed: options.max_newton.max(2),
            factors: Factors::new(0, &[]),
            values: Vec::new(),
            level: Vec::new(),
            rows: vec![0; n],
            unknowns: vec![0; n],
            attention: vec![1.0; n],
            delta: vec![0.0; n],
            cj: 0.0,
            h: 1.0,
            rate_factor: 1.0,
            measured: 1.0,
        }
    }

    /// Learns what is constant about a problem.
    pub fn start<P: Dae + ?Sized>(&mut self, problem: &P, tolerance: f64) {
        let (n, pattern, levels) = (self.delta.len(), problem.pattern(), problem.levels());
        self.factors = Factors::new(n, &pattern);
        self.values = vec![0.0; pattern.len()];
        (self.rows, self.unknowns) = (levels.rows, levels.unknowns);
        self.level = pattern
            .iter()
            .map(|(i, j)| self.rows[*i] as i8 - self.unknowns[*j] as i8)
            .collect();
        self.attention = problem
            .kinds()
            .iter()
            .zip(&self.unknowns)
            .map(|(kind, level)| match (kind, level) {
                (Kind::Differential | Kind::AlgebraicControlled, _) => 1.0,
                (Kind::DifferentialUncontrolled, _) => 0.01,
                (_, 0) => (tolerance / LOOSE).min(1.0),
                _ => 0.0,
            })
            .collect();
        self.forget();
    }

    /// Forgets the factors.
    pub fn forget(&mut self) {
        self.cj = 0.0;
    }

    /// `h` to the power of a level.
    fn power(h: f64, level: i8) -> f64 {
        match level {
            0 => 1.0,
            1 => h,
            -1 => 1.0 / h,
            2 => h * h,
            -2 => 1.0 / (h * h),
            other => h.powi(i32::from(other)),
        }
    }

    /// Evaluates and factors the matrix of (2) at the prediction.
    fn factor<P: Dae + ?Sized>(
        &mut self,
        problem: &mut P,
        (t, y, ydot, cj): (f64, &[f64], &[f64], f64),
        stats: &mut Stats,
    ) -> Result<(), Trouble> {
        self.cj = 0.0;
        stats.jacobians += 1;
        problem
            .jacobian(t, y, ydot, cj, &mut self.values)
            .map_err(Trouble::of)?;
        // 1/cj rounded to a power of two, so that scaling is exact
        self.h = f64::from_bits(cj.recip().to_bits() & 0x7ff0_0000_0000_0000);
        for (value, level) in self.values.iter_mut().zip(&self.level) {
            if *level != 0 {
                *value *= Self::power(self.h, *level);
            }
        }
        stats.factorizations += 1;
        self.factors
            .factor(&self.values)
            .map_err(|unknown| Trouble::may_pass(Reason::Singular(unknown)))?;
        self.cj = cj;
        (self.rate_factor, self.measured) = (100.0, 1.0);
        Ok(())
    }

    /// Solves (1). On entry `y` and `ydot` are predicted; on success they satisfy it, and `e` is the correction of `y`.
    ///
    /// `scale` holds 1/(error permitted in a step) per unknown, `predicted` room to keep the prediction for another try   (n; 2 × n)
    ///
    /// # Errors
    /// When the problem fails, the matrix is singular, or the iteration does not converge with a fresh matrix.
    #[allow(clippy::too_many_arguments)] // the state of a step has many arrays
    pub fn correct<P: Dae + ?Sized>(
        &mut self,
        problem: &mut P,
        (t, cj): (f64, f64),
        y: &mut [f64],
        ydot: &mut [f64],
        e: &mut [f64],
        scale: &[f64],
        predicted: &mut [Vec<f64>; 2],
        stats: &mut Stats,
    ) -> Result<(), Trouble> {
        let ratio = cj / self.cj;
        let mut fresh = false;
        if !(self.cj != 0.0 && ratio > CJ_RANGE && ratio < 1.0 / CJ_RANGE) {
            self.factor(problem, (t, y, ydot, cj), stats)?;
            fresh = true;
        }
        predicted[0].copy_from_slice(y);
        predicted[1].copy_from_slice(ydot);
        loop {
            match self.iterate(problem, (t, cj), y, ydot, e, scale, stats) {
                Ok(()) => return Ok(()),
                Err(trouble) if fresh || !trouble.recoverable => {
                    if fresh {
                        self.forget();
                    }
                    return Err(trouble);
                }
                Err(_) => {
                    y.copy_from_slice(&predicted[0]);
                    ydot.copy_from_slice(&predicted[1]);
                    self.factor(problem, (t, y, ydot, cj), stats)?;
                    fresh = true;
                }
            }
        }
    }

    /// (2) until the error left is small.
    #[allow(clippy::too_many_arguments)]
    fn iterate<P: Dae + ?Sized>(
        &mut self,
        problem: &mut P,
        (t, cj): (f64, f64),
        y: &mut [f64],
        ydot: &mut [f64],
        e: &mut [f64],
        scale: &[f64],
        stats: &mut Stats,
    ) -> Result<(), Trouble> {
        e.fill(0.0);
        // the matrix ages, so does what is known of its convergence
        self.rate_factor = self.rate_factor.max(f64::EPSILON).powf(AGEING);
        let damping = if cj == self.cj {
            1.0
        } else {
            2.0 / (1.0 + cj / self.cj)
        };
        let (mut first, mut worst_row) = (0.0, 0);
        for iteration in 0..self.allowed {
            stats.evaluations += 1;
            problem
                .residual(t, y, ydot, &mut self.delta)
                .map_err(Trouble::of)?;
            if !worst(self.delta.iter().copied()).is_finite() {
                return Err(Trouble::may_pass(Reason::NotFinite(worst_index(
                    self.delta.iter().copied(),
                ))));
            }
            for (r, level) in self.delta.iter_mut().zip(&self.rows) {
                *r *= -damping * Self::power(self.h, *level as i8);
            }
            worst_row = worst_index(self.delta.iter().copied());
            self.factors.solve(&mut self.delta);
            stats.newton_iterations += 1;
            let mut size = 0.0;
            let mut sum = 0.0;
            for i in 0..y.len() {
                let d = self.delta[i] * Self::power(self.h, -(self.unknowns[i] as i8));
                y[i] += d;
                ydot[i] += cj * d;
                e[i] += d;
                let change = (d * scale[i] * self.attention[i]).abs();
                sum += d.abs();
                size = if change > size { change } else { size };
            }
            if !sum.is_finite() || !f64::is_finite(size) {
                return Err(Trouble::may_pass(Reason::Newton(worst_row)));
            }
            let mut factor = self.rate_factor;
            if iteration == 0 {
                first = size;
                // nothing to correct
                if size <= 1e-4 * SHARE {
                    return Ok(());
                }
                // what a Newton iteration leaves is quadratic: a larger correction than the measured one converges worse
                factor *= (size / self.measured).max(1.0);
                // and with another cj no better than |1 − damping|
                factor = factor.max((1.0 - damping).abs());
            } else {
                let rate = (size / first).powf(1.0 / iteration as f64);
                if rate > SLOWEST {
                    break;
                }
                factor = rate / (1.0 - rate);
                (self.rate_factor, self.measured) = (factor, first);
            }
            if factor * size <= SHARE {
                return Ok(());
            }
        }
        Err(Trouble::may_pass(Reason::Newton(worst_row)))
    }

    /// Whether the error of each unknown is controlled: 1, or 0   (n)
    pub fn controlled(kinds: &[Kind]) -> Vec<f64> {
        kinds
            .iter()
            .map(|k| {
                f64::from(u8::from(matches!(
                    k,
                    Kind::Differential | Kind::AlgebraicControlled
                )))
            })
            .collect()
    }
}
