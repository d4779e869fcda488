//! The implicit equations of one step of a DAE method: Newton's iteration with a kept matrix.
//!
//! ```text
//! F(t, ŷ + e, ẏ̂ + cj e) = 0                  ŷ, ẏ̂ predicted, cj of the method               (1)
//! (∂F/∂y + cj₀ ∂F/∂ẏ) Δ = −F,   e += 2/(1 + cj/cj₀) Δ       matrix of an earlier step         (2)
//! h^rowsᵢ Fᵢ,  h^unknownsⱼ yⱼ                 scaled by levels, h ≈ 1/cj a power of two        (3)
//! ```
//!
//! The matrix is kept until cj leaves [0.6, 1.67] cj₀ or the iteration converges too slowly with
//! it; then it is evaluated and factored anew and the iteration repeated, and only when that fails
//! too is the step at fault. The measured rate ρ of convergence predicts the error left,
//! ρ/(1−ρ) ‖Δ‖, which must be a small part of the error permitted in a step.
//!
//! *Unexplained corrections*: a large motion that converges must not hide an unknown beside it that
//! does not. (A mass that a steep friction held: with the slope of sticking, corrections are a
//! millionth of the missing acceleration, and every one is as large as the one before.) So with a
//! kept matrix each unknown whose correction hardly falls, by the ratio r, is judged alone: what
//! such corrections add up to, r/|1−r| of the last, must be small, too.
//!
//! Unknowns whose error is not controlled are judged loosely, multipliers of higher index not at
//! all: they are linear in the rest of the iteration and carry rounding errors of order 1/h², which
//! no iteration removes. Corrections of the size of rounding that fall no more end the iteration
//! too, as they go to and fro between neighbouring numbers: [`Trouble::stagnant`] says how large
//! they are, so that the permitted error can be raised above them.
//!
//! Source: Brenan, Campbell & Petzold, Numerical Solution of Initial-Value Problems in DAEs, 5.2.2;
//! Petzold & Lötstedt 1986 for (3).

use super::control::{worst, worst_index};
use super::sparse::Factors;
use super::{Dae, Failure, Kind, Options, Reason, Stats};
use crate::scalar::Scalar;

/// Error that the iteration may leave, as a part of the error permitted in a step.
const PERMITTED_REST: f64 = 0.1;
/// Smallest ratio cj/cj₀, and inverse of the largest, with which the matrix is kept.
const SMALLEST_CJ_RATIO: f64 = 0.6;
/// Rate of convergence ρ beyond which the iteration is given up.
const SLOWEST_RATE: f64 = 0.9;
/// Power of ρ/(1−ρ) from step to step: the rate measured with a kept matrix is trusted less and
/// less.
const RATE_AGEING: f64 = 0.7;
/// Ratio of two successive corrections of an unknown above which the matrix does not explain it.
const UNEXPLAINED: f64 = 0.9;
/// Size of a correction that is rounding, relative to the magnitudes of the unknowns.
pub(super) const ROUNDING: f64 = 1e-13;
/// Accuracy asked of uncontrolled algebraic unknowns, relative to their magnitude.
const UNCONTROLLED_TOLERANCE: f64 = 1e-3;
/// Weight in the norm of unknowns whose rate occurs, but whose error is not controlled.
const UNCONTROLLED_WEIGHT: f64 = 0.01;

/// Newton's iteration for (1).
#[derive(Clone, Debug)]
pub struct Corrector {
    /// corrections permitted in a step
    allowed: usize,
    factors: Factors,
    /// entries of the Jacobian   (entries)
    values: Vec<f64>,
    /// power of h in (3) of each entry, from −4 to 4   (entries)
    level: Vec<i8>,
    /// powers of h in (3) of the rows   (n)
    rows: Vec<u8>,
    /// powers of h in (3) of the unknowns   (n)
    unknowns: Vec<u8>,
    /// weight of each unknown in the norm: 1 controlled, less judged loosely, 0 ignored   (n)
    attention: Vec<f64>,
    /// residual, then correction   (n)
    delta: Vec<f64>,
    /// the correction before   (n)
    last: Vec<f64>,
    /// cj₀, the coefficient of the factors, in 1/s; 0 when there are none
    cj: f64,
    /// h of (3), the scaling step of the factors, in s
    h: f64,
    /// ρ/(1−ρ) of the last iteration with these factors
    rate_factor: f64,
    /// size of the first correction of that iteration
    measured: f64,
}

/// The unknowns of (1) in work, with the errors permitted in them.
#[derive(Clone, Debug)]
pub struct Iterate {
    /// solution: predicted, then corrected   (n)
    pub y: Vec<f64>,
    /// its rate: predicted, then corrected   (n)
    pub ydot: Vec<f64>,
    /// correction of the solution   (n)
    pub e: Vec<f64>,
    /// 1/(error permitted in a step)   (n)
    pub scale: Vec<f64>,
    /// whether that error was raised above rounding: corrections no larger need not fall
    pub is_eased: bool,
    /// size of a correction that is rounding, as a part of that error
    pub rounding: f64,
    /// predicted solution and rate, kept for a second iteration   (n each)
    predicted: [Vec<f64>; 2],
}

impl Iterate {
    /// Room for `n` unknowns.
    pub fn new(n: usize) -> Self {
        let zeros = || vec![0.0; n];
        Iterate {
            y: zeros(),
            ydot: zeros(),
            e: zeros(),
            scale: zeros(),
            is_eased: false,
            rounding: 0.0,
            predicted: [zeros(), zeros()],
        }
    }

    /// Keeps the prediction for a second iteration.
    fn keep_prediction(&mut self) {
        self.predicted[0].copy_from_slice(&self.y);
        self.predicted[1].copy_from_slice(&self.ydot);
    }

    /// Goes back to the prediction.
    fn restore_prediction(&mut self) {
        self.y.copy_from_slice(&self.predicted[0]);
        self.ydot.copy_from_slice(&self.predicted[1]);
    }
}

/// The cause why (1) was not solved.
#[derive(Clone, Copy, Debug)]
pub struct Trouble {
    /// the cause, for a [`super::Stop`]
    pub reason: Reason,
    /// whether a shorter step may help
    pub recoverable: bool,
    /// the size of corrections that grow no smaller, as a part of the permitted error
    pub stagnant: Option<f64>,
}

impl Trouble {
    /// Trouble from an evaluation of the problem.
    fn of(failure: Failure) -> Self {
        Trouble {
            reason: Reason::Evaluation(failure),
            recoverable: failure.recoverable,
            stagnant: None,
        }
    }

    /// Trouble that a shorter step may remove.
    fn may_pass(reason: Reason) -> Self {
        Trouble {
            reason,
            recoverable: true,
            stagnant: None,
        }
    }
}

impl Corrector {
    /// Creates a corrector for `n` unknowns; [`Corrector::start`] learns the pattern.
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
            last: vec![0.0; n],
            cj: 0.0,
            h: 1.0,
            rate_factor: 1.0,
            measured: 1.0,
        }
    }

    /// Reads the pattern, the levels and the kinds of unknowns of a problem, and forgets the
    /// factors.
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
                (Kind::DifferentialUncontrolled, _) => UNCONTROLLED_WEIGHT,
                (_, 0) => (tolerance / UNCONTROLLED_TOLERANCE).min(1.0),
                _ => 0.0,
            })
            .collect();
        self.forget();
    }

    /// Forgets the factors.
    pub fn forget(&mut self) {
        self.cj = 0.0;
    }

    /// Returns `h` to the power of a level.
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
        (t, cj): (f64, f64),
        at: &Iterate,
        stats: &mut Stats,
    ) -> Result<(), Trouble> {
        self.cj = 0.0;
        stats.jacobians += 1;
        problem
            .jacobian(t, &at.y, &at.ydot, cj, &mut self.values)
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

    /// Solves (1) at time `t` with coefficient `cj`. On entry `y` and `ydot` of the iterate are
    /// predicted; on success they satisfy (1), and `e` is the correction of `y`.
    ///
    /// # Errors
    /// When the problem fails, the matrix is singular, or the iteration does not converge with a
    /// fresh matrix.
    pub fn correct<P: Dae + ?Sized>(
        &mut self,
        problem: &mut P,
        (t, cj): (f64, f64),
        at: &mut Iterate,
        stats: &mut Stats,
    ) -> Result<(), Trouble> {
        let ratio = cj / self.cj;
        let mut fresh = false;
        if !(self.cj != 0.0 && ratio > SMALLEST_CJ_RATIO && ratio < 1.0 / SMALLEST_CJ_RATIO) {
            self.factor(problem, (t, cj), at, stats)?;
            fresh = true;
        }
        at.keep_prediction();
        loop {
            match self.iterate(problem, (t, cj, fresh), at, stats) {
                Ok(()) => return Ok(()),
                Err(trouble) if fresh || !trouble.recoverable => {
                    // a permitted error that was raised above rounding
                    let small = |size| size <= PERMITTED_REST && at.is_eased;
                    if trouble.stagnant.is_some_and(small) {
                        return Ok(());
                    }
                    if fresh {
                        self.forget();
                    }
                    return Err(trouble);
                }
                Err(_) => {
                    at.restore_prediction();
                    self.factor(problem, (t, cj), at, stats)?;
                    fresh = true;
                }
            }
        }
    }

    /// Repeats (2) until the error left is small; a matrix that is not `fresh` must be seen to
    /// make corrections smaller.
    fn iterate<P: Dae + ?Sized>(
        &mut self,
        problem: &mut P,
        (t, cj, fresh): (f64, f64, bool),
        at: &mut Iterate,
        stats: &mut Stats,
    ) -> Result<(), Trouble> {
        at.e.fill(0.0);
        self.last.fill(f64::INFINITY);
        // the matrix ages, so does what is known of its convergence
        self.rate_factor = Scalar::powf(self.rate_factor.max(f64::EPSILON), RATE_AGEING);
        let damping = if cj == self.cj {
            1.0
        } else {
            2.0 / (1.0 + cj / self.cj)
        };
        let (mut first, mut before, mut worst_row, mut stagnant) = (0.0, f64::INFINITY, 0, None);
        for iteration in 0..self.allowed {
            // residual and correction
            stats.evaluations += 1;
            problem
                .residual(t, &at.y, &at.ydot, &mut self.delta)
                .map_err(Trouble::of)?;
            if !worst(self.delta.iter().copied()).is_finite() {
                let index = worst_index(self.delta.iter().copied());
                return Err(Trouble::may_pass(Reason::NotFinite(index)));
            }
            for (r, level) in self.delta.iter_mut().zip(&self.rows) {
                *r *= -damping * Self::power(self.h, *level as i8);
            }
            worst_row = worst_index(self.delta.iter().copied());
            self.factors.solve(&mut self.delta);
            stats.newton_iterations += 1;
            let Some((size, is_explained)) = self.apply(cj, at) else {
                return Err(Trouble::may_pass(Reason::Newton(worst_row)));
            };

            // the error left
            let mut factor = self.rate_factor;
            if iteration == 0 {
                first = size;
                let rounding = at.rounding.min(PERMITTED_REST);
                if size <= rounding || fresh && size <= 1e-4 * PERMITTED_REST {
                    return Ok(());
                }
                // a Newton iteration converges quadratically: a correction larger than the measured
                // one leaves more in proportion
                factor *= (size / self.measured).max(1.0);
                // and with another cj no less than |1 − damping|
                factor = factor.max((1.0 - damping).abs());
            } else {
                let rate = Scalar::powf(size / first, 1.0 / iteration as f64);
                if rate > SLOWEST_RATE && size > at.rounding {
                    stagnant = Some(size);
                    break;
                }
                // corrections of the size of rounding that fall no more are all that it leaves
                if size <= at.rounding && size > SLOWEST_RATE * before {
                    stagnant = Some(size);
                    break;
                }
                factor = rate / (1.0 - rate);
                (self.rate_factor, self.measured) = (factor, first);
            }
            if factor * size <= PERMITTED_REST && (fresh || iteration > 0 && is_explained) {
                return Ok(());
            }
            before = size;
        }
        Err(Trouble {
            stagnant,
            ..Trouble::may_pass(Reason::Newton(worst_row))
        })
    }

    /// Adds the correction to the unknowns; returns its size, and whether those of all unknowns
    /// that hardly fall add up to little; or `None` if it is not finite.
    fn apply(&mut self, cj: f64, at: &mut Iterate) -> Option<(f64, bool)> {
        let (mut size, mut is_explained) = (0.0, true);
        let mut sum = 0.0;
        for i in 0..at.y.len() {
            let d = self.delta[i] * Self::power(self.h, -(self.unknowns[i] as i8));
            at.y[i] += d;
            at.ydot[i] += cj * d;
            at.e[i] += d;
            let change = (d * at.scale[i] * self.attention[i]).abs();
            sum += d.abs();
            size = if change > size { change } else { size };
            let last = std::mem::replace(&mut self.last[i], d);
            let ratio = d / last;
            // what corrections like these add up to
            let left = ratio / (1.0 - ratio).abs().max(f64::EPSILON) * change;
            let is_left = ratio > UNEXPLAINED && left > PERMITTED_REST;
            is_explained &= !(is_left && change > at.rounding);
        }
        (f64::is_finite(sum) && f64::is_finite(size)).then_some((size, is_explained))
    }

    /// Returns 1 for each unknown whose error is controlled, and 0 for the others   (n)
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
