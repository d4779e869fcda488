//! Generalized-α of order 2 for `F(t, y, ẏ) = 0`: HHT with damping of the highest frequencies,
//! Newmark without.
//!
//! ```text
//! F(tₙ₊₁, yₙ₊₁, ẏₙ₊₁) = 0                                                                (1)
//! yₙ₊₁ = yₙ + h ((1−γ) aₙ + γ aₙ₊₁)                                                      (2)
//! (1−αm) aₙ₊₁ + αm aₙ = (1−αf) ẏₙ₊₁ + αf ẏₙ        a: the rate at tₙ + Δh, Δ = αm − αf   (3)
//! αf = ρ/(1+ρ),  αm = (3ρ−1)/(2(1+ρ)),  γ = ½ + αf − αm                                   (4)
//! ŷ = yₙ + h ẏₙ + h²/(2 h₀) (ẏₙ − ẏₙ₋₁)                                                   (5)
//! y − y(t) = c h³ y‴,  y − ŷ = (c − c_p) h³ y‴,  error = |c/(c − c_p)| ‖y − ŷ‖            (6)
//! ```
//!
//! ρ is the part of an infinitely fast mode that is left after a step: 1 keeps all of it (Newmark's
//! rule of the average acceleration, γ = ½), 0 annihilates it. HHT takes ρ = 0.54, which is its
//! usual α = −0.3. Since (1) holds at the end of the step, constraints do too, whatever the
//! relation between y and ẏ.
//!
//! *Change of step*: a belongs to a place in the step, so it is moved along with it:
//! a ← ẏ + (a − ẏ) h_new/h_old.
//!
//! *Algebraic unknowns* have no rate in F. The one that (3) gives them is not used: they are
//! predicted unchanged and interpolated linearly.
//!
//! *Newmark and constraints*: without damping the multipliers of constraints on positions ring;
//! with stabilized rows or with HHT they do not.
//!
//! Source: Hilber, Hughes & Taylor 1977; Jansen, Whiting & Hulbert, CMAME 190 (2000), for
//! first-order systems; Arnold & Brüls, Multibody System Dynamics 18 (2007).
#![allow(clippy::needless_range_loop)] // many arrays at one index read best that way

use super::control::{
    self, Attempts, Permitted, Pi, Rejection, Stagnation, Weights, worst, worst_index,
};
use super::corrector::{self, Corrector, Iterate};
use super::{Dae, Failure, Kind, Method, Options, Reason, Stats, Step, Stop};
use crate::scalar::Scalar;

/// Order of the method.
const ORDER: usize = 2;
/// ρ of (4) for HHT, which is its usual α = −0.3.
const HHT_RHO: f64 = 0.7 / 1.3;
/// Smallest error permitted in a step: beside it the rounding of a prediction counts for nothing.
const LEAST_TOLERANCE: f64 = 5e-15;
/// Rounding of an unknown above which changes of it are not taken from it, over the error permitted
/// in a step.
const FELT_ROUNDING: f64 = 1e-3;
/// Growth of the step, as a factor, below which it stays as it is, for the sake of the matrix.
const KEEP_STEP: f64 = 1.25;

/// Generalized-α; see the file's card.
#[derive(Clone, Debug)]
pub struct Hht {
    options: Options,
    weights: Weights,
    control: Pi,
    stats: Stats,
    /// permitted error of a step
    permitted: Permitted,
    /// errors that rounding may keep from falling
    stagnation: Stagnation,
    /// αf of (4)
    alpha_f: f64,
    /// αm of (4)
    alpha_m: f64,
    /// γ of (4)
    gamma: f64,
    /// c of (6)
    c: f64,
    /// state at the end of the last accepted step
    now: State,
    /// state at its beginning
    before: State,
    /// whether there is a step to undo, or to interpolate in
    can_undo: bool,
    /// 1 for each unknown whose rate occurs, 0 for the others   (n)
    differential: Vec<f64>,
    /// 1 for each unknown whose error is controlled, 0 for the others   (n)
    controlled: Vec<f64>,
    /// the step in work
    next: Iterate,
    /// predicted changes of the unknowns in it   (n)
    rise: Vec<f64>,
    corrector: Corrector,
}

/// The state that the next step starts from.
#[derive(Clone, Debug)]
struct State {
    /// in s
    t: f64,
    /// length of the step before, in s; 0 at the start
    h_used: f64,
    /// proposed length of the next step, in s
    h: f64,
    /// solution   (n)
    y: Vec<f64>,
    /// rate   (n)
    ydot: Vec<f64>,
    /// a of (3)   (n)
    a: Vec<f64>,
    /// rate a step before   (n)
    ydot_before: Vec<f64>,
}

impl State {
    fn copy_from(&mut self, other: &State) {
        (self.t, self.h_used, self.h) = (other.t, other.h_used, other.h);
        self.y.copy_from_slice(&other.y);
        self.ydot.copy_from_slice(&other.ydot);
        self.a.copy_from_slice(&other.a);
        self.ydot_before.copy_from_slice(&other.ydot_before);
    }
}

impl Hht {
    /// Prepares Newmark's method for `n` unknowns: ρ = 1.
    pub fn newmark(n: usize, options: &Options) -> Self {
        Self::with_damping(n, options, 1.0)
    }

    /// Prepares HHT for `n` unknowns: α = −0.3.
    pub fn new(n: usize, options: &Options) -> Self {
        Self::with_damping(n, options, HHT_RHO)
    }

    /// Prepares the method that leaves the part `rho` of an infinitely fast mode after a step,
    /// 0 ≤ `rho` ≤ 1.
    pub fn with_damping(n: usize, options: &Options, rho: f64) -> Self {
        let zeros = || vec![0.0; n];
        let rho = rho.clamp(0.0, 1.0);
        let alpha_f = rho / (1.0 + rho);
        let alpha_m = (3.0 * rho - 1.0) / (2.0 * (1.0 + rho));
        let gamma = 0.5 + alpha_f - alpha_m;
        let d = alpha_m - alpha_f;
        // second moments of (3) and (2) about tₙ, in units of h² ÿ and h³ y‴
        let kappa = 0.5 * ((1.0 - alpha_f) - (1.0 - alpha_m) * (d + 1.0).powi(2) - alpha_m * d * d);
        let c = 0.5 * ((1.0 - gamma) * d * d + gamma * (d + 1.0).powi(2)) + kappa - 1.0 / 6.0;
        let weights = Weights::new(n, options);
        let permitted = Permitted::new(inner_tolerance(weights.tolerance()), LEAST_TOLERANCE);
        let weights = weights.for_steps(permitted.now());
        let now = State {
            t: 0.0,
            h_used: 0.0,
            h: 0.0,
            y: zeros(),
            ydot: zeros(),
            a: zeros(),
            ydot_before: zeros(),
        };
        Hht {
            options: options.clone(),
            permitted,
            stagnation: Stagnation::default(),
            weights,
            control: Pi::new(3.0, 0.0, 0.9, 0.2, 4.0),
            stats: Stats::default(),
            alpha_f,
            alpha_m,
            gamma,
            c,
            before: now.clone(),
            now,
            can_undo: false,
            differential: vec![1.0; n],
            controlled: vec![1.0; n],
            next: Iterate::new(n),
            rise: zeros(),
            corrector: Corrector::new(n, options),
        }
    }

    /// Begins at `(t, y)`: consistent values, first step, nothing known of the past.
    fn begin<P: Dae + ?Sized>(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        let stop = |reason| Stop { reason, t, h: 0.0 };
        self.can_undo = false;
        self.stagnation = Stagnation::default();
        let now = &mut self.now;
        now.y.copy_from_slice(y);
        problem
            .consistent(t, &mut now.y, &mut now.ydot)
            .map_err(|f| stop(Reason::Evaluation(f)))?;
        let all = now.y.iter().chain(&now.ydot);
        if !worst(all.clone().copied()).is_finite() {
            return Err(stop(Reason::NotFinite(
                worst_index(all.copied()) % y.len().max(1),
            )));
        }
        self.weights.see(t, &now.y);
        self.corrector.forget();
        self.control.reset();
        now.a.copy_from_slice(&now.ydot);
        now.ydot_before.copy_from_slice(&now.ydot);
        // the first step is of order 1, since a is taken for the rate
        let typical = self.weights.typical();
        let speed = worst((0..y.len()).map(|i| {
            let way = now.y[i] - self.weights.origin()[i];
            self.controlled[i] * now.ydot[i] / way.abs().max(typical[i])
        }));
        let guess = self.permitted.now().sqrt() * if speed > 1e-8 { 0.1 / speed } else { 1e-3 };
        (now.t, now.h_used) = (t, 0.0);
        let h = self.options.h_initial.unwrap_or(guess);
        now.h = control::first_length(t, h, &self.options);
        Ok(())
    }

    /// Attempts a step of length `h` to `t1`; returns its error, as a part of that permitted.
    ///
    /// # Errors
    /// The rejection, and an error that may be rounding, as a part of that permitted.
    fn attempt<P: Dae + ?Sized>(
        &mut self,
        problem: &mut P,
        (h, t1): (f64, f64),
    ) -> Result<f64, (Rejection, Option<f64>)> {
        let now = &self.now;
        let (af, am, gamma) = (self.alpha_f, self.alpha_m, self.gamma);
        let moved = if now.h_used > 0.0 {
            h / now.h_used
        } else {
            1.0
        };
        let bend = if now.h_used > 0.0 {
            0.5 * h * h / now.h_used
        } else {
            0.0
        };
        // ẏ = cj (y − yₙ) + …, from (2) and (3)
        let cj = (1.0 - am) / ((1.0 - af) * gamma * h);
        let tolerance = self.permitted.now();
        self.next.is_eased = self.permitted.is_raised();
        self.next.rounding = corrector::ROUNDING / tolerance;
        for i in 0..self.next.y.len() {
            let a = now.ydot[i] + (now.a[i] - now.ydot[i]) * moved;
            let rise = self.differential[i]
                * (h * now.ydot[i] + bend * (now.ydot[i] - now.ydot_before[i]));
            self.rise[i] = rise;
            self.next.y[i] = now.y[i] + rise;
            self.next.ydot[i] =
                cj * (rise - h * (1.0 - gamma) * a) + (am * a - af * now.ydot[i]) / (1.0 - af);
            let way = self.next.y[i] - self.weights.origin()[i];
            let (m, y) = (self.weights.magnitude()[i], way.abs());
            self.next.scale[i] = 1.0 / (tolerance * if y > m { y } else { m });
        }
        self.corrector
            .correct(problem, (t1, cj), &mut self.next, &mut self.stats)
            .map_err(|trouble| {
                let rejection = Rejection {
                    reason: trouble.reason,
                    recoverable: trouble.recoverable,
                    factor: 0.25,
                };
                (rejection, trouble.stagnant)
            })?;
        // (6); before the first step is done the prediction is of order 1
        let factor = if now.h_used > 0.0 {
            let c_p = -(1.0 / 6.0 + 0.25 * now.h_used / h);
            (self.c / (self.c - c_p)).abs().max(0.05)
        } else {
            0.5
        };
        let errors = self.next.e.iter().zip(&self.next.scale);
        let weighted = errors.zip(&self.controlled).map(|((e, s), c)| e * s * c);
        let error = factor * worst(weighted.clone());
        if error <= 1.0 {
            return Ok(error);
        }
        let rejection = Rejection {
            reason: Reason::ErrorTest(worst_index(weighted)),
            recoverable: true,
            factor: self.control.rejected(error),
        };
        let stagnates = self.stagnation.see(t1, h, error);
        Err((rejection, stagnates.then_some(error)))
    }

    /// Advances the state over an accepted step.
    fn complete(&mut self, t1: f64, h: f64) {
        let now = &mut self.now;
        let moved = if now.h_used > 0.0 {
            h / now.h_used
        } else {
            1.0
        };
        for i in 0..self.next.y.len() {
            let a = now.ydot[i] + (now.a[i] - now.ydot[i]) * moved;
            let y = self.next.y[i];
            // where the rounding of y is felt, which a short step would make large, without it
            let change = match f64::EPSILON * y.abs() * self.next.scale[i] > FELT_ROUNDING {
                true => self.rise[i] + self.next.e[i],
                false => y - now.y[i],
            };
            now.a[i] = (change - h * (1.0 - self.gamma) * a) / (h * self.gamma);
        }
        now.ydot_before.copy_from_slice(&now.ydot);
        now.y.copy_from_slice(&self.next.y);
        now.ydot.copy_from_slice(&self.next.ydot);
        (now.t, now.h_used) = (t1, h);
    }
}

/// Returns the permitted error of a step for a requested accuracy: a run of order 2 sums h⁻¹
/// errors of h³.
fn inner_tolerance(request: f64) -> f64 {
    0.3 * Scalar::powf(request, 1.5)
}

impl<P: Dae + ?Sized> Method<P> for Hht {
    fn start(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        self.stats = Stats::default();
        self.weights.reset(|typical| problem.typical(typical));
        self.weights
            .relate(|relations| problem.relations(relations));
        let kinds = problem.kinds();
        self.controlled = Corrector::controlled(&kinds);
        let has_rate =
            |kind: &Kind| matches!(kind, Kind::Differential | Kind::DifferentialUncontrolled);
        self.differential = kinds
            .iter()
            .map(|kind| f64::from(u8::from(has_rate(kind))))
            .collect();
        self.corrector.start(problem, self.weights.tolerance());
        self.begin(problem, t, y)
    }

    fn reinitialize(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        self.begin(problem, t, y)
    }

    fn step(&mut self, problem: &mut P, t_limit: f64) -> Result<Step, Stop> {
        self.before.copy_from(&self.now);
        let mut attempts = Attempts::new(self.now.t, t_limit, &self.options);
        loop {
            let proposed = self.now.h.min(self.options.h_max);
            let too_fast = || control::too_fast(&self.now.ydot, &self.weights);
            let (h, t1) = attempts.next(proposed, &self.options, &self.stats, too_fast)?;
            match self.attempt(problem, (h, t1)) {
                Ok(error) => {
                    let calm = attempts.rejected() > 0;
                    let factor = self.control.accepted(error, calm, false);
                    self.complete(t1, h);
                    let grown = if (1.0..KEEP_STEP).contains(&factor) {
                        h
                    } else {
                        h * factor
                    };
                    // a step that the limit cut short says little against the one that was proposed
                    self.now.h = if h < proposed {
                        grown.max(proposed)
                    } else {
                        grown
                    };
                    self.weights.see(t1, &self.next.y);
                    let in_vain = self.permitted.accepted(h) | self.weights.is_raised();
                    self.stats.below_rounding += usize::from(in_vain);
                    self.can_undo = true;
                    return Ok(attempts.accepted(h, t1, ORDER, &mut self.stats));
                }
                Err((_, Some(size))) if self.permitted.may_be_rounding(size) => {
                    attempts.repeat(&mut self.stats);
                    self.permitted.raise(size, self.stagnation.take_length(h));
                    self.now.h = h;
                }
                Err((rejection, _)) => {
                    attempts.reject(rejection, h, &mut self.stats)?;
                    self.now.h = h * rejection.factor;
                }
            }
        }
    }

    fn undo(&mut self) {
        if self.can_undo {
            std::mem::swap(&mut self.now, &mut self.before);
            self.now.h = self.now.h.min(self.before.h_used);
            self.can_undo = false;
        }
    }

    fn interpolate(&mut self, _problem: &mut P, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        let (end, h) = (&self.now, self.now.h_used);
        if !self.can_undo || t == end.t {
            y.copy_from_slice(&end.y);
            return Ok(());
        }
        // cubic through values and rates; a line where there is no rate
        let begin = &self.before;
        let s = (t - begin.t) / h;
        for i in 0..y.len() {
            let rise = end.y[i] - begin.y[i];
            let (d0, d1) = (h * begin.ydot[i] - rise, h * end.ydot[i] - rise);
            let bend = self.differential[i] * (1.0 - s) * (d0 * (1.0 - s) - d1 * s);
            y[i] = begin.y[i] + s * (rise + bend);
        }
        Ok(())
    }

    fn interpolate_rate(
        &mut self,
        _problem: &mut P,
        t: f64,
        ydot: &mut [f64],
    ) -> Result<(), Failure> {
        let (end, h) = (&self.now, self.now.h_used);
        if !self.can_undo || t == end.t {
            ydot.copy_from_slice(&end.ydot);
            return Ok(());
        }
        let begin = &self.before;
        let s = (t - begin.t) / h;
        for i in 0..ydot.len() {
            let rise = end.y[i] - begin.y[i];
            let (d0, d1) = (h * begin.ydot[i] - rise, h * end.ydot[i] - rise);
            let slope = (1.0 - s) * (1.0 - 3.0 * s) * d0 - s * (2.0 - 3.0 * s) * d1;
            ydot[i] = (rise + self.differential[i] * slope) / h;
        }
        Ok(())
    }

    fn propose(&mut self, h: f64) {
        self.now.h = h;
    }

    fn t(&self) -> f64 {
        self.now.t
    }

    fn y(&self) -> &[f64] {
        &self.now.y
    }

    fn ydot(&self) -> &[f64] {
        &self.now.ydot
    }

    fn stats(&self) -> &Stats {
        &self.stats
    }
}
