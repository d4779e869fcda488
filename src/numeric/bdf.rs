//! Backward differentiation of order 1 to 5 for `F(t, y, ẏ) = 0`: variable step, fixed leading
//! coefficient.
//!
//! ```text
//! φ₀ = yₙ,  φⱼ = ψ₁ … ψⱼ [yₙ, … yₙ₋ⱼ]      modified divided differences, ψⱼ = tₙ₊₁ − tₙ₊₁₋ⱼ  (1)
//! φ*ⱼ = βⱼ φⱼ                              for the step to come                               (2)
//! ŷ = Σ φ*ⱼ,  ẏ̂ = Σ γⱼ φ*ⱼ                prediction: polynomial of degree k through the past (3)
//! y = ŷ + e,  ẏ = ẏ̂ + cj e                cj = Σ_{j≤k} (1/j) / h, solved by `corrector.rs`    (4)
//! error = C ‖e‖,  C = max(αₖ₊₁, |αₖ₊₁ + αₛ − α₀|)     of the step and of the interpolant       (5)
//! order k ± 1  where the error terms ‖h^{j+1} y^{(j+1)}‖, from e and φ, fall or rise with j    (6)
//! ```
//!
//! *Start*: order 1 and a short step; the step is doubled and the order raised at every step until
//! the error estimate objects.
//!
//! *Interpolant*: the polynomial of degree k through the newest k + 1 points; continuous.
//!
//! *Index 3*: every change of step or order disturbs velocities by O(h) and multipliers by O(1) of
//! the error in positions, and the disturbed velocities are integrated on. Only positions are
//! controlled, so a run is far less accurate than the request. Stabilized index-2 rows have no such
//! loss: prefer them. Rows and unknowns are scaled by their levels; see `corrector.rs`.
//!
//! *Oscillations*: from order 3 on the region of stability leaves out modes of little damping;
//! where they are present they hold the step down. `max_order` 2 or Radau is the remedy.
//!
//! Source: Brenan, Campbell & Petzold, Numerical Solution of Initial-Value Problems in DAEs, 5.2
//! (program DASSL); Hindmarsh et al., ACM TOMS 31 (2005) (program IDA).
#![allow(clippy::needless_range_loop)] // many arrays at one index read best that way

use super::control::{
    self, Attempts, Permitted, Rejection, Stagnation, Weights, worst, worst_index,
};
use super::corrector::{self, Corrector, Iterate};
use super::{Dae, Failure, Method, Options, Reason, Stats, Step, Stop};
use crate::scalar::Scalar;

/// Highest order that is stable enough.
const MAX_ORDER: usize = 5;
/// Smallest error permitted in a step: beside it the rounding of differences counts for nothing.
const LEAST_TOLERANCE: f64 = 2e-13;

/// Backward differentiation; see the file's card.
#[derive(Clone, Debug)]
pub struct Bdf {
    options: Options,
    weights: Weights,
    stats: Stats,
    /// highest order permitted
    max_order: usize,
    /// permitted error of a step
    permitted: Permitted,
    /// the past after the last step
    past: Past,
    /// the past before the last step, for undo
    before: Past,
    /// beginning of the last step, in s
    t0: f64,
    /// whether there is a step to undo
    can_undo: bool,
    /// αⱼ of (5) for the step in work
    alpha: [f64; MAX_ORDER + 2],
    /// βⱼ of (2) for the step in work
    beta: [f64; MAX_ORDER + 2],
    /// γⱼ of (3) for the step in work
    gamma: [f64; MAX_ORDER + 2],
    /// factors of the error terms of (6) for the step in work
    sigma: [f64; MAX_ORDER + 2],
    /// 1 for each unknown whose error is controlled, 0 for the others   (n)
    controlled: Vec<f64>,
    /// the step in work
    next: Iterate,
    /// scratch   (n)
    work: Vec<f64>,
    corrector: Corrector,
}

/// The past points of the solution, as differences, and the plan for the next step.
#[derive(Clone, Debug)]
struct Past {
    /// end of the last step, in s
    t: f64,
    /// length of the last step, in s
    h_used: f64,
    /// order of the last step
    k_used: usize,
    /// length of the next step, in s
    h: f64,
    /// order of the next step
    k: usize,
    /// steps taken with this length and order
    constant: usize,
    /// steps since the start
    steps: usize,
    /// steps before a longer one is tried: one has just been found too long
    wait: usize,
    /// still in the phase that doubles the step and raises the order
    rising: bool,
    /// ψ of (1)
    psi: [f64; MAX_ORDER + 2],
    /// φ of (1)   (7 × n)
    phi: [Vec<f64>; MAX_ORDER + 2],
    /// rate at t   (n)
    ydot: Vec<f64>,
}

impl Past {
    fn copy_from(&mut self, other: &Past) {
        for (a, b) in self.phi.iter_mut().zip(&other.phi) {
            a.copy_from_slice(b);
        }
        self.ydot.copy_from_slice(&other.ydot);
        (self.t, self.h_used, self.k_used) = (other.t, other.h_used, other.k_used);
        (self.h, self.k, self.constant) = (other.h, other.k, other.constant);
        (self.steps, self.wait) = (other.steps, other.wait);
        (self.rising, self.psi) = (other.rising, other.psi);
    }

    /// Sets ψ₁ and φ₁ for a first step of length `h`: it knows one rate only.
    fn set_first_step(&mut self, h: f64) {
        self.psi[0] = h;
        for (phi, rate) in self.phi[1].iter_mut().zip(&self.ydot) {
            *phi = h * rate;
        }
    }
}

/// The error of a step, and the error terms (6) that decide on its order.
struct Errors {
    /// error (5), as a part of that permitted
    step: f64,
    /// estimate at order k − 1
    below: f64,
    /// term of (6) at order k
    term: f64,
    /// term of (6) at order k − 1
    term_below: f64,
    /// the order to go down to, or k
    k_new: usize,
    /// the estimate at `k_new`
    estimate: f64,
}

/// The end of an attempt that is not acceptable.
struct Failed {
    rejection: Rejection,
    /// the order for the next attempt, after a failed error test
    order: Option<usize>,
    /// an error that may be rounding, as a part of that permitted
    rounding: Option<f64>,
}

impl Bdf {
    /// Prepares the method for `n` unknowns.
    pub fn new(n: usize, options: &Options) -> Self {
        let zeros = || vec![0.0; n];
        let weights = Weights::new(n, options);
        let permitted = Permitted::new(inner_tolerance(weights.tolerance()), LEAST_TOLERANCE);
        let weights = weights.for_steps(permitted.now());
        let past = Past {
            t: 0.0,
            h_used: 0.0,
            k_used: 0,
            h: 0.0,
            k: 1,
            constant: 0,
            steps: 0,
            wait: 0,
            rising: true,
            psi: [0.0; MAX_ORDER + 2],
            phi: std::array::from_fn(|_| zeros()),
            ydot: zeros(),
        };
        Bdf {
            options: options.clone(),
            permitted,
            weights,
            stats: Stats::default(),
            max_order: options.max_order.clamp(1, MAX_ORDER),
            before: past.clone(),
            past,
            t0: 0.0,
            can_undo: false,
            alpha: [0.0; MAX_ORDER + 2],
            beta: [0.0; MAX_ORDER + 2],
            gamma: [0.0; MAX_ORDER + 2],
            sigma: [0.0; MAX_ORDER + 2],
            controlled: vec![1.0; n],
            next: Iterate::new(n),
            work: zeros(),
            corrector: Corrector::new(n, options),
        }
    }

    /// Begins at `(t, y)`: consistent values, first step, order 1.
    fn begin<P: Dae + ?Sized>(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        let stop = |reason| Stop { reason, t, h: 0.0 };
        self.can_undo = false;
        self.next.y.copy_from_slice(y);
        problem
            .consistent(t, &mut self.next.y, &mut self.next.ydot)
            .map_err(|f| stop(Reason::Evaluation(f)))?;
        let all = self.next.y.iter().chain(&self.next.ydot);
        if !worst(all.clone().copied()).is_finite() {
            return Err(stop(Reason::NotFinite(
                worst_index(all.copied()) % self.next.y.len().max(1),
            )));
        }
        self.weights.see(t, &self.next.y);
        self.corrector.forget();
        // a first step of order 1: its error h² ÿ/2 is a guess from the time scale y/ẏ
        let typical = self.weights.typical();
        let speed = worst((0..y.len()).map(|i| {
            let way = self.next.y[i] - self.weights.origin()[i];
            self.controlled[i] * self.next.ydot[i] / way.abs().max(typical[i])
        }));
        let guess = self.permitted.now().sqrt() * if speed > 1e-8 { 0.1 / speed } else { 1e-3 };
        let h = self.options.h_initial.unwrap_or(guess);
        let h = control::first_length(t, h, &self.options);
        let past = &mut self.past;
        (past.t, past.h, past.k, past.h_used, past.k_used) = (t, h, 1, 0.0, 0);
        (past.constant, past.steps, past.wait, past.rising) = (0, 0, 0, true);
        past.psi = [h; MAX_ORDER + 2];
        past.phi.iter_mut().for_each(|phi| phi.fill(0.0));
        past.phi[0].copy_from_slice(&self.next.y);
        past.ydot.copy_from_slice(&self.next.ydot);
        for (phi, rate) in past.phi[1].iter_mut().zip(&self.next.ydot) {
            *phi = h * rate;
        }
        Ok(())
    }

    /// Sets the coefficients for a step of length `h` at order k, and turns φ into φ* (2). Returns
    /// cj and C of (5).
    fn set_coefficients(&mut self, h: f64) -> (f64, f64) {
        let past = &mut self.past;
        let k = past.k;
        if h != past.h_used || k != past.k_used {
            past.constant = 0;
        }
        past.constant = (past.constant + 1).min(past.k_used + 2);
        if k + 1 >= past.constant {
            (self.alpha[0], self.beta[0], self.gamma[0], self.sigma[0]) = (1.0, 1.0, 0.0, 1.0);
            let mut reach = h;
            for i in 1..=k {
                let old = past.psi[i - 1];
                past.psi[i - 1] = reach;
                self.beta[i] = self.beta[i - 1] * reach / old;
                reach = old + h;
                self.alpha[i] = h / reach;
                self.sigma[i] = i as f64 * self.sigma[i - 1] * self.alpha[i];
                self.gamma[i] = self.gamma[i - 1] + self.alpha[i - 1] / h;
            }
            past.psi[k] = reach;
        }
        let alpha_s: f64 = -(1..=k).map(|j| 1.0 / j as f64).sum::<f64>();
        let alpha_0: f64 = -self.alpha[..k].iter().sum::<f64>();
        let c = (self.alpha[k] + alpha_s - alpha_0).abs().max(self.alpha[k]);
        for i in past.constant..=k {
            let beta = self.beta[i];
            past.phi[i].iter_mut().for_each(|phi| *phi *= beta);
        }
        (-alpha_s / h, c)
    }

    /// Undoes the changes that `set_coefficients` made to ψ and φ.
    fn restore(&mut self, h: f64) {
        let past = &mut self.past;
        for j in 1..=past.k {
            past.psi[j - 1] = past.psi[j] - h;
        }
        for j in past.constant..=past.k {
            let beta = self.beta[j].recip();
            past.phi[j].iter_mut().for_each(|phi| *phi *= beta);
        }
    }

    /// Predicts solution and rate (3), and sets the errors permitted in them.
    fn predict(&mut self) {
        let past = &self.past;
        self.next.y.copy_from_slice(&past.phi[0]);
        self.next.ydot.fill(0.0);
        for j in 1..=past.k {
            let gamma = self.gamma[j];
            let next = &mut self.next;
            for ((y, ydot), phi) in next.y.iter_mut().zip(&mut next.ydot).zip(&past.phi[j]) {
                *y += phi;
                *ydot += gamma * phi;
            }
        }
        let tolerance = self.permitted.now();
        self.next.is_eased = self.permitted.is_raised();
        self.next.rounding = corrector::ROUNDING / tolerance;
        let Iterate { y, scale, .. } = &mut self.next;
        for (i, scale) in scale.iter_mut().enumerate() {
            let way = y[i] - self.weights.origin()[i];
            let (m, y) = (self.weights.magnitude()[i], way.abs());
            *scale = 1.0 / (tolerance * if y > m { y } else { m });
        }
    }

    /// Returns `‖x‖` over the controlled unknowns.
    fn norm(&self, x: &[f64]) -> f64 {
        worst(
            x.iter()
                .zip(&self.next.scale)
                .zip(&self.controlled)
                .map(|((x, s), c)| x * s * c),
        )
    }

    /// Estimates the error (5), and the terms (6) at order k and below.
    fn errors(&mut self, c: f64) -> Errors {
        let k = self.past.k;
        let size = self.norm(&self.next.e);
        let at_k = self.sigma[k] * size;
        let term = (k + 1) as f64 * at_k;
        let mut errors = Errors {
            step: c * size,
            below: 0.0,
            term,
            term_below: 0.0,
            k_new: k,
            estimate: at_k,
        };
        if k > 1 {
            for ((w, e), phi) in self
                .work
                .iter_mut()
                .zip(&self.next.e)
                .zip(&self.past.phi[k])
            {
                *w = e + phi;
            }
            errors.below = self.sigma[k - 1] * self.norm(&self.work);
            errors.term_below = k as f64 * errors.below;
            let lower = if k > 2 {
                for (w, phi) in self.work.iter_mut().zip(&self.past.phi[k - 1]) {
                    *w += phi;
                }
                let second = (k - 1) as f64 * self.sigma[k - 2] * self.norm(&self.work);
                errors.term_below.max(second) <= term
            } else {
                errors.term_below <= 0.5 * term
            };
            if lower {
                (errors.k_new, errors.estimate) = (k - 1, errors.below);
            }
        }
        errors
    }

    /// Chooses order and length of the step after an accepted one, and updates φ.
    fn complete(&mut self, t1: f64, h: f64, errors: &Errors) {
        let k = self.past.k;
        let rise = k as isize - self.past.k_used as isize;
        let raised_norm = (k < self.max_order).then(|| {
            for ((w, e), phi) in self
                .work
                .iter_mut()
                .zip(&self.next.e)
                .zip(&self.past.phi[k + 1])
            {
                *w = e - phi;
            }
            self.norm(&self.work)
        });
        let past = &mut self.past;
        past.steps += 1;
        past.wait = past.wait.saturating_sub(1);
        (past.k_used, past.h_used, past.t) = (k, h, t1);
        if errors.k_new < k || k == self.max_order {
            past.rising = false;
        }
        let mut h_next = h;
        if past.rising {
            if past.steps > 1 {
                past.k = k + 1;
                h_next = 2.0 * h;
            }
        } else {
            let may_rise = errors.k_new == k && k + 1 < past.constant && rise != 1;
            let (mut k_next, mut estimate) = (errors.k_new, errors.estimate);
            if let (true, Some(size)) = (may_rise, raised_norm) {
                let above = size / (k + 2) as f64;
                let term_above = size;
                if k > 1 && errors.term_below <= errors.term.min(term_above) {
                    (k_next, estimate) = (k - 1, errors.below);
                } else if term_above
                    < if k > 1 {
                        errors.term
                    } else {
                        0.5 * errors.term
                    }
                {
                    (k_next, estimate) = (k + 1, above);
                }
            }
            past.k = k_next;
            let factor = Scalar::powf(2.0 * estimate + 1e-4, -1.0 / (k_next + 1) as f64);
            if factor >= 2.0 && past.wait == 0 {
                h_next = 2.0 * h;
            } else if factor <= 1.0 {
                h_next = h * factor.clamp(0.5, 0.9);
            }
        }
        past.h = h_next;
        if k < self.max_order {
            past.phi[k + 1].copy_from_slice(&self.next.e);
        }
        for (phi, e) in past.phi[k].iter_mut().zip(&self.next.e) {
            *phi += e;
        }
        for j in (0..k).rev() {
            let (low, high) = past.phi.split_at_mut(j + 1);
            for (phi, above) in low[j].iter_mut().zip(&high[0]) {
                *phi += above;
            }
        }
        past.ydot.copy_from_slice(&self.next.ydot);
    }

    /// Attempts a step of length `h` to `t1`; returns the errors of an acceptable one.
    ///
    /// # Errors
    /// The reason why it is not; the past is restored.
    fn attempt<P: Dae + ?Sized>(
        &mut self,
        problem: &mut P,
        (h, t1): (f64, f64),
        stagnation: &mut Stagnation,
    ) -> Result<Errors, Failed> {
        let (cj, c) = self.set_coefficients(h);
        self.predict();
        let corrected = self
            .corrector
            .correct(problem, (t1, cj), &mut self.next, &mut self.stats);
        if let Err(trouble) = corrected {
            self.restore(h);
            let rejection = Rejection {
                reason: trouble.reason,
                recoverable: trouble.recoverable,
                factor: 0.25,
            };
            return Err(Failed {
                rejection,
                order: None,
                rounding: trouble.stagnant,
            });
        }
        let errors = self.errors(c);
        if errors.step <= 1.0 {
            return Ok(errors);
        }
        self.restore(h);
        let unknown = worst_index(
            self.next
                .e
                .iter()
                .zip(&self.next.scale)
                .zip(&self.controlled)
                .map(|((x, s), c)| x * s * c),
        );
        let factor = 0.9
            * Scalar::powf(
                2.0 * errors.estimate + 1e-4,
                -1.0 / (errors.k_new + 1) as f64,
            );
        let factor = if factor.is_finite() {
            factor.clamp(0.25, 0.9)
        } else {
            0.25
        };
        let rejection = Rejection {
            reason: Reason::ErrorTest(unknown),
            recoverable: true,
            factor,
        };
        // errors of several orders cannot be compared
        let stagnates = self.past.k == 1 && stagnation.see(t1, h, errors.step);
        Err(Failed {
            rejection,
            order: Some(errors.k_new),
            rounding: stagnates.then_some(errors.step),
        })
    }

    /// Calls `term(j, value, slope)` for the factor of each φⱼ in the interpolant at `t`.
    fn basis(&self, t: f64, mut term: impl FnMut(usize, f64, f64)) {
        let past = &self.past;
        let k = past.k_used.max(1);
        let d = t - past.t;
        let (mut value, mut slope) = (1.0, 0.0);
        let mut factor = d / past.psi[0];
        term(0, 1.0, 0.0);
        for j in 1..=k {
            slope = slope * factor + value / past.psi[j - 1];
            value *= factor;
            factor = (d + past.psi[j - 1]) / past.psi[j];
            term(j, value, slope);
        }
    }
}

/// Returns the permitted error of a step for a requested accuracy.
///
/// A run of order k sums some h⁻¹ errors of h^(k+1), so the permitted one must fall a little faster
/// than the request. Measured over pendulum, van der Pol, Robertson, HIRES and the stabilized
/// index-2 pendulum, requests 1e-3 … 1e-10: the error at the end is 0.01 to 25 times the request.
fn inner_tolerance(request: f64) -> f64 {
    0.05 * Scalar::powf(request, 1.1)
}

impl<P: Dae + ?Sized> Method<P> for Bdf {
    fn start(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        self.stats = Stats::default();
        self.weights.reset(|typical| problem.typical(typical));
        self.weights
            .relate(|relations| problem.relations(relations));
        self.controlled = Corrector::controlled(&problem.kinds());
        self.corrector.start(problem, self.weights.tolerance());
        self.begin(problem, t, y)
    }

    fn reinitialize(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        self.begin(problem, t, y)
    }

    fn step(&mut self, problem: &mut P, t_limit: f64) -> Result<Step, Stop> {
        let t0 = self.past.t;
        self.before.copy_from(&self.past);
        let mut attempts = Attempts::new(t0, t_limit, &self.options);
        let mut failed_tests = 0;
        let mut stagnation = Stagnation::default();
        loop {
            let proposed = self.past.h.min(self.options.h_max);
            let too_fast = || control::too_fast(&self.past.ydot, &self.weights);
            let (h, t1) = attempts.next(proposed, &self.options, &self.stats, too_fast)?;
            if self.past.steps == 0 {
                self.past.set_first_step(h);
            }
            match self.attempt(problem, (h, t1), &mut stagnation) {
                Ok(errors) => {
                    let order = self.past.k;
                    self.complete(t1, h, &errors);
                    if h < proposed && self.past.h >= h {
                        // a step that the limit cut short says little against the one proposed
                        self.past.h = self.past.h.max(proposed);
                    }
                    self.weights.see(t1, &self.next.y);
                    let in_vain = self.permitted.accepted(h) | self.weights.is_raised();
                    self.stats.below_rounding += usize::from(in_vain);
                    (self.t0, self.can_undo) = (t0, true);
                    return Ok(attempts.accepted(h, t1, order, &mut self.stats));
                }
                Err(Failed {
                    rounding: Some(size),
                    ..
                }) if self.permitted.may_be_rounding(size) => {
                    attempts.repeat(&mut self.stats);
                    // not held: at singular positions it would be for long
                    self.permitted.raise(size, 0.0);
                    stagnation = Stagnation::default();
                }
                Err(failed) => {
                    attempts.reject(failed.rejection, h, &mut self.stats)?;
                    self.past.rising = false;
                    let mut factor = failed.rejection.factor;
                    if let Some(k) = failed.order {
                        failed_tests += 1;
                        // long enough that a higher order is tried at steps of one length: at
                        // order 1 every other step was too long, and the order never rose
                        self.past.wait = k + 2;
                        (self.past.k, factor) = match failed_tests {
                            1 => (k, factor),
                            2 => (k, 0.25),
                            _ => (1, 0.25),
                        };
                    }
                    self.past.h = h * factor;
                }
            }
        }
    }

    fn undo(&mut self) {
        if self.can_undo {
            std::mem::swap(&mut self.past, &mut self.before);
            self.past.h = self.past.h.min(self.before.h_used);
            self.next.y.copy_from_slice(&self.past.phi[0]);
            self.next.ydot.copy_from_slice(&self.past.ydot);
            self.can_undo = false;
        }
    }

    fn interpolate(&mut self, _problem: &mut P, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        if t == self.past.t || self.past.steps == 0 {
            y.copy_from_slice(&self.past.phi[0]);
            return Ok(());
        }
        y.fill(0.0);
        self.basis(t, |j, value, _| {
            for (y, phi) in y.iter_mut().zip(&self.past.phi[j]) {
                *y += value * phi;
            }
        });
        Ok(())
    }

    fn interpolate_rate(
        &mut self,
        _problem: &mut P,
        t: f64,
        ydot: &mut [f64],
    ) -> Result<(), Failure> {
        if t == self.past.t || self.past.steps == 0 {
            ydot.copy_from_slice(&self.past.ydot);
            return Ok(());
        }
        ydot.fill(0.0);
        self.basis(t, |j, _, slope| {
            for (ydot, phi) in ydot.iter_mut().zip(&self.past.phi[j]) {
                *ydot += slope * phi;
            }
        });
        Ok(())
    }

    fn propose(&mut self, h: f64) {
        self.past.h = h;
    }

    fn t(&self) -> f64 {
        self.past.t
    }

    fn y(&self) -> &[f64] {
        &self.past.phi[0]
    }

    fn ydot(&self) -> &[f64] {
        &self.past.ydot
    }

    fn stats(&self) -> &Stats {
        &self.stats
    }
}
