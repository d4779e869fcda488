//! Generalized-α of order 2 for `F(t, y, ẏ) = 0`: HHT with damping of the highest frequencies, Newmark without.
//!
//! ```text
//! F(tₙ₊₁, yₙ₊₁, ẏₙ₊₁) = 0                                                                  (1)
//! yₙ₊₁ = yₙ + h ((1−γ) aₙ + γ aₙ₊₁)                                                        (2)
//! (1−αm) aₙ₊₁ + αm aₙ = (1−αf) ẏₙ₊₁ + αf ẏₙ         a: the rate at tₙ + Δh, Δ = αm − αf       (3)
//! αf = ρ/(1+ρ),  αm = (3ρ−1)/(2(1+ρ)),  γ = ½ + αf − αm                                     (4)
//! ŷ = yₙ + h ẏₙ + h²/(2 h₀) (ẏₙ − ẏₙ₋₁)                                                     (5)
//! y − y(t) = c h³ y‴,  y − ŷ = (c − c_p) h³ y‴,  error = |c/(c − c_p)| ‖y − ŷ‖              (6)
//! ```
//!
//! ρ is what is left of an infinitely fast mode after a step: 1 keeps all (Newmark's rule of the average acceleration, γ = ½), 0 annihilates it. HHT takes
//! ρ = 0.54, which is its usual α = −0.3. Since (1) holds at the end of the step, constraints do too, whatever the relation between y and ẏ.
//!
//! *Change of step*: a belongs to a place in the step, so it is moved along with it: a ← ẏ + (a − ẏ) h_new/h_old.
//! *Algebraic unknowns* have no rate in F; the one that (3) gives them is not used, they are predicted as they were and interpolated linearly.
//! *Newmark and constraints*: without damping the multipliers of constraints on positions ring; stabilized rows or HHT do not.
//!
//! Source: Hilber, Hughes & Taylor 1977; Jansen, Whiting & Hulbert, CMAME 190 (2000), for first-order systems; Arnold & Brüls, Multibody System Dynamics 18 (2007).
#![allow(clippy::needless_range_loop)] // many arrays at one index read best that way

use super::control::{self, Pi, Weights, worst, worst_index};
use super::corrector::Corrector;
use super::{Dae, Failure, Kind, Method, Options, Reason, Stats, Step, Stop};

/// What HHT leaves of an infinitely fast mode: α = −0.3.
const HHT: f64 = 0.7 / 1.3;
/// Growth of the step below which it is kept, for the sake of the matrix.
const KEEP_STEP: f64 = 1.25;

/// Generalized-α; see the file's card.
#[derive(Clone, Debug)]
pub struct Hht {
    options: Options,
    weights: Weights,
    control: Pi,
    stats: Stats,
    /// permitted error of a step
    tolerance: f64,
    /// αf, αm, γ of (4); c of (6)
    alpha_f: f64,
    alpha_m: f64,
    gamma: f64,
    c: f64,
    now: State,
    before: State,
    can_undo: bool,
    /// which unknowns have rates; are controlled: 1 or 0; that over the error permitted   (n)
    differential: Vec<f64>,
    controlled: Vec<f64>,
    scale: Vec<f64>,
    /// solution, rate and correction in work; rate minus cj y   (n each)
    y: Vec<f64>,
    ydot: Vec<f64>,
    e: Vec<f64>,
    predicted: [Vec<f64>; 2],
    corrector: Corrector,
}

/// What the next step builds on.
#[derive(Clone, Debug)]
struct State {
    t: f64,
    /// length of the step before, 0 at the start; proposed length of the next
    h_used: f64,
    h: f64,
    /// no growth after a rejection
    calm: bool,
    /// solution, rate, a of (3); rate a step before   (n each)
    y: Vec<f64>,
    ydot: Vec<f64>,
    a: Vec<f64>,
    ydot_before: Vec<f64>,
}

impl State {
    fn copy_from(&mut self, other: &State) {
        (self.t, self.h_used, self.h, self.calm) = (other.t, other.h_used, other.h, other.calm);
        self.y.copy_from_slice(&other.y);
        self.ydot.copy_from_slice(&other.ydot);
        self.a.copy_from_slice(&other.a);
        self.ydot_before.copy_from_slice(&other.ydot_before);
    }
}

impl Hht {
    /// Newmark's method for `n` unknowns: ρ = 1.
    pub fn newmark(n: usize, options: &Options) -> Self {
        Self::with_damping(n, options, 1.0)
    }

    /// HHT for `n` unknowns: α = −0.3.
    pub fn new(n: usize, options: &Options) -> Self {
        Self::with_damping(n, options, HHT)
    }

    /// The method that leaves the part `rho` of an infinitely fast mode after a step, 0 ≤ `rho` ≤ 1.
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
        let now = State {
            t: 0.0,
            h_used: 0.0,
            h: 0.0,
            calm: false,
            y: zeros(),
            ydot: zeros(),
            a: zeros(),
            ydot_before: zeros(),
        };
        Hht {
            options: options.clone(),
            tolerance: inner_tolerance(weights.tolerance()),
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
            scale: zeros(),
            y: zeros(),
            ydot: zeros(),
            e: zeros(),
            predicted: [zeros(), zeros()],
            corrector: Corrector::new(n, options),
        }
    }

    fn begin<P: Dae + ?Sized>(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        let stop = |reason| Stop { reason, t, h: 0.0 };
        self.can_undo = false;
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
        self.weights.see(&now.y);
        self.corrector.forget();
        self.control.reset();
        now.a.copy_from_slice(&now.ydot);
        now.ydot_before.copy_from_slice(&now.ydot);
        // the first step is of order 1, since a is taken for the rate
        let typical = self.weights.typical();
        let speed = worst(
            (0..y.len()).map(|i| self.controlled[i] * now.ydot[i] / now.y[i].abs().max(typical[i])),
        );
        let guess = self.tolerance.sqrt() * if speed > 1e-8 { 0.1 / speed } else { 1e-3 };
        (now.t, now.h_used, now.calm) = (t, 0.0, false);
        now.h = self
            .options
            .h_initial
            .unwrap_or(guess)
            .min(self.options.h_max);
        Ok(())
    }

    /// One attempt; gives the error, or the reason, whether a shorter step may help, and the factor for it.
    fn attempt<P: Dae + ?Sized>(
        &mut self,
        problem: &mut P,
        h: f64,
        t1: f64,
    ) -> Result<f64, (Reason, bool, f64)> {
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
        for i in 0..self.y.len() {
            let a = now.ydot[i] + (now.a[i] - now.ydot[i]) * moved;
            let rise = self.differential[i]
                * (h * now.ydot[i] + bend * (now.ydot[i] - now.ydot_before[i]));
            self.y[i] = now.y[i] + rise;
            self.ydot[i] =
                cj * (rise - h * (1.0 - gamma) * a) + (am * a - af * now.ydot[i]) / (1.0 - af);
            let (m, y) = (self.weights.magnitude()[i], self.y[i].abs());
            self.scale[i] = 1.0 / (self.tolerance * if y > m { y } else { m });
        }
        self.corrector
            .correct(
                problem,
                (t1, cj),
                &mut self.y,
                &mut self.ydot,
                &mut self.e,
                &self.scale,
                &mut self.predicted,
                &mut self.stats,
            )
            .map_err(|trouble| (trouble.reason, trouble.recoverable, 0.25))?;
        // (6); before the first step is done the prediction is of order 1
        let factor = if now.h_used > 0.0 {
            let c_p = -(1.0 / 6.0 + 0.25 * now.h_used / h);
            (self.c / (self.c - c_p)).abs().max(0.05)
        } else {
            0.5
        };
        let weighted = self
            .e
            .iter()
            .zip(&self.scale)
            .zip(&self.controlled)
            .map(|((e, s), c)| e * s * c);
        let error = factor * worst(weighted.clone());
        if error <= 1.0 {
            return Ok(error);
        }
        Err((
            Reason::ErrorTest(worst_index(weighted)),
            true,
            self.control.rejected(error),
        ))
    }

    /// The state after an accepted step.
    fn complete(&mut self, t1: f64, h: f64) {
        let now = &mut self.now;
        let moved = if now.h_used > 0.0 {
            h / now.h_used
        } else {
            1.0
        };
        for i in 0..self.y.len() {
            let a = now.ydot[i] + (now.a[i] - now.ydot[i]) * moved;
            now.a[i] = (self.y[i] - now.y[i] - h * (1.0 - self.gamma) * a) / (h * self.gamma);
        }
        now.ydot_before.copy_from_slice(&now.ydot);
        now.y.copy_from_slice(&self.y);
        now.ydot.copy_from_slice(&self.ydot);
        (now.t, now.h_used) = (t1, h);
    }
}

/// The permitted error of a step for a requested accuracy: a run of order 2 sums h⁻¹ errors of h³.
fn inner_tolerance(request: f64) -> f64 {
    0.3 * request.powf(1.5)
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
        let t0 = self.now.t;
        self.before.copy_from(&self.now);
        let shortest = control::shortest(t0, &self.options);
        let mut cause = None;
        let mut rejected = 0;
        loop {
            let proposed = self.now.h.min(self.options.h_max);
            let (h, at_limit) = control::fit(t0, proposed, t_limit);
            let stop = |reason| Err(Stop { reason, t: t0, h });
            if self.stats.steps + self.stats.rejected >= self.options.max_steps {
                return stop(Reason::TooManySteps);
            }
            if h < shortest && (rejected > 0 || !at_limit) {
                return stop(
                    cause.unwrap_or_else(|| control::too_fast(&self.now.ydot, &self.weights)),
                );
            }
            let t1 = if at_limit { t_limit } else { t0 + h };
            match self.attempt(problem, h, t1) {
                Ok(error) => {
                    let factor = self.control.accepted(error, rejected > 0, false);
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
                    self.weights.see(&self.y);
                    self.stats.steps += 1;
                    self.can_undo = true;
                    return Ok(Step {
                        t0,
                        t1,
                        h,
                        order: 2,
                        rejected,
                    });
                }
                Err((reason, recoverable, factor)) => {
                    cause = Some(reason);
                    if !recoverable {
                        return stop(reason);
                    }
                    self.now.h = h * factor;
                }
            }
            rejected += 1;
            self.stats.rejected += 1;
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
