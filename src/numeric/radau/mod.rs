//! Radau IIA of order 5: three implicit stages, for stiff problems, projected onto invariants.
//!
//! ```text
//! Zᵢ = h Σ aᵢⱼ f(t + cⱼ h, y + Zⱼ)          i, j = 1 … 3: solved in `collocation.rs`           (1)
//! y₁ = project(y + Z₃)                                                                        (2)
//! error = (γ̂/h − J)⁻¹ (f(t, y) + Σ eᵢ Zᵢ/h)                                                   (3)
//!         when too large in a first or repeated attempt, once more with f(t, y + error)
//!         instead of f(t, y)
//! ```
//!
//! *Between the nodes*: the filter of (3) takes away what is stiff. A stiff part is exact at the
//! nodes, up to 1/λ, and between them what a cubic leaves of the slow solution, which outputs read.
//! Where (3) without its filter would have rejected the step, one more rate measures that error:
//!
//! ```text
//! e = (γ̂/h − J)⁻¹ (f(t + θ h, p(θ)) − p′(θ)/h)          θ = 0.85, where the cubic is worst    (4)
//! ```
//!
//! The filter is right only where the rate is about as steep as J says. So where (4) without it
//! would have rejected the step, the rate is evaluated again at p(θ) + e: what the filter takes
//! away must have fallen. Else it is the error itself (`estimate.rs`).
//!
//! *Newton*: simplified, started from the polynomial of the step before. The Jacobian is kept while
//! the iteration converges with Θ ≤ 0.02, its factors also while the step would grow by less than
//! a fifth.
//!
//! *Step*: Gustafsson's predictive control. The estimate (3) is of order 3, below that of the
//! method, so the inner tolerance is a power of the request.
//!
//! *Rates*: where the problem says that a velocity v is the rate of q, the error of v is measured
//! against 10⁻³ |q|/h wherever that is more than |v|. So undamped vibrations that no position shows
//! (480 kHz in the blades of a wind turbine) are damped by the method instead of being followed for
//! thousands of steps a millisecond; a motion of a thousand steps or fewer is followed in its
//! velocity as exactly as ever.
//!
//! *Failures*: a stage that fails, a singular matrix or a number that is not finite shortens the
//! step; when no sensible step is left the method ends with a [`Stop`].
//!
//! Source: Hairer & Wanner, Solving ODEs II, IV.8 (program RADAU5).
#![allow(clippy::needless_range_loop)] // many arrays at one index read best that way

mod collocation;
mod estimate;
mod full;
mod sparse;
mod systems;

use super::control::{self, Attempts, Rejection, Weights, worst, worst_index};
use super::quadrature::{Node, RADAU_3, over_interpolant};
use super::{Failure, Memory, Method, Ode, Options, Reason, Stats, Step, Stop};
use crate::scalar::Scalar;
use collocation::{
    ALPHA, BETA, Begin, Convergence, GAMMA, KEEP_JACOBIAN_RATE, Newton, Polynomial, Stages,
    solve_collocation_system,
};
use full::Full;
use systems::Systems;

/// Order of the method.
const ORDER: usize = 5;
/// Permitted value of the error estimate of a step that has not converged where rates are noisy: a
/// request of 1e-7.
const NOISY_TOLERANCE: f64 = 1.3e-7;
/// Widest part of a step without evaluations.
const STAGE_GAP: [f64; 2] = [collocation::C[0], collocation::C[1]];
/// Difference of two steps, as a part of them, that is rounding of the times between which they
/// lie: the factors of the matrices are the same.
const SAME_STEP: f64 = 1e-9;
/// Growth of the step, as a factor, up to which the factors of the matrices are kept.
const KEEP_STEP: f64 = 1.2;
/// Growth of the step, as a factor, over the one that the Jacobian was evaluated for, up to which
/// that is kept. Error control grows steps by 8 at most; a step that follows one that a limit cut
/// short may be longer by any factor.
const KEEP_GROWTH: f64 = 10.0;
/// Part of |q|/h against which the error of the rate of q may always be measured.
///
/// Chosen on a wind turbine that hums at 480 kHz (half a second in 4200 steps); 10⁻² and 10⁻¹ save
/// another two fifths of the steps at first, and lose digits in chains of links at 1e-9.
const RATE_SHARE_OF_POSITION: f64 = 1e-3;
/// Factor for the step after a stage has failed or has no finite value.
const FAILED_STAGE_FACTOR: f64 = 0.25;

/// A time with the solution and its rate there.
#[derive(Clone, Debug)]
struct Point {
    /// in s
    t: f64,
    /// solution   (n)
    y: Vec<f64>,
    /// rate   (n)
    f: Vec<f64>,
}

/// The length of the next step, by predictive control.
#[derive(Clone, Debug)]
struct StepControl {
    /// length of the last attempt, in s
    h: f64,
    /// length proposed for the next attempt, in s
    h_next: f64,
    /// no step has been accepted since the start
    first: bool,
    /// the last attempt was rejected: the step must not grow
    calm: bool,
    /// length of the last accepted step, in s; 0: none
    h_accepted: f64,
    /// error of the last accepted step, as a part of that permitted
    error_accepted: f64,
}

/// The age of the Jacobian and of its factors.
#[derive(Clone, Copy, Debug)]
struct Freshness {
    /// the Jacobian was evaluated at the beginning of the present step
    here: bool,
    /// the Jacobian must be evaluated before the next attempt
    stale: bool,
    /// step for which the matrices are factored, in s; 0: none
    h_factored: f64,
    /// step for which the Jacobian was evaluated, in s
    h_evaluated: f64,
}

/// The Jacobian of an integration that has ended, with its age.
///
/// Another one that goes on in the same system may begin with it, even if constants have changed:
/// its first iteration must show how it converges, and where J hides a residual it is evaluated
/// anew, as within an integration.
#[derive(Clone, Debug)]
pub(super) struct Derivatives {
    jacobian: Vec<f64>,
    dfdt: Vec<f64>,
    freshness: Freshness,
    /// full systems of this Jacobian with their factors; `None`: they are made anew
    factored: Option<Box<Full>>,
}

impl Derivatives {
    /// Returns all numbers of it: the Jacobian, the derivatives by time, its age.
    pub fn numbers(&self) -> [Vec<f64>; 3] {
        let f = self.freshness;
        let flags = [f.here, f.stale].map(|is| f64::from(u8::from(is)));
        let age = [flags[0], flags[1], f.h_factored, f.h_evaluated];
        [self.jacobian.clone(), self.dfdt.clone(), age.to_vec()]
    }

    /// Takes them back; `None`: they are none of it.
    pub fn of_numbers([jacobian, dfdt, age]: [Vec<f64>; 3]) -> Option<Self> {
        let [here, stale, h_factored, h_evaluated] = age[..] else {
            return None;
        };
        let is_finite = |x: &f64| x.is_finite();
        let is_sound = jacobian.iter().chain(&dfdt).chain(&age).all(is_finite);
        is_sound.then_some(Self {
            jacobian,
            dfdt,
            freshness: Freshness {
                here: here == 1.0,
                stale: stale == 1.0,
                h_factored,
                h_evaluated,
            },
            factored: None,
        })
    }
}

/// Radau IIA of order 5 with projection; see the file's card.
#[derive(Clone, Debug)]
pub struct Radau {
    options: Options,
    weights: Weights,
    stats: Stats,
    /// permitted value of the error estimate (3)
    tolerance: f64,
    /// beginning of the last step
    begin: Point,
    /// end of the last step, if `advanced`
    end: Point,
    /// whether `end` is the state, or `begin`
    advanced: bool,
    /// changes of the length of the present step
    placing: Placing,
    /// attempts at the present step whose residuals no Jacobian explained
    hidden: usize,
    /// f − p′ of (4)   (n)
    unexplained: Vec<f64>,
    /// the present step need not be better than noise
    eased: bool,
    /// length of the next step
    control: StepControl,
    /// 1/(tolerance · magnitude) for this step   (n)
    scale: Vec<f64>,
    /// stages of the step in work
    stages: Stages,
    /// limits and rate of the Newton iteration
    convergence: Convergence,
    /// the last accepted step, for guesses and interpolation
    polynomial: Polynomial,
    /// the linear systems of the iteration
    systems: Systems,
    /// age of the matrices
    freshness: Freshness,
    /// estimate (3)   (n)
    error: Vec<f64>,
    /// Σ eᵢ Zᵢ/h of (3)   (n)
    defect: Vec<f64>,
}

impl StepControl {
    fn new() -> Self {
        StepControl {
            h: 0.0,
            h_next: 0.0,
            first: true,
            calm: false,
            h_accepted: 0.0,
            error_accepted: 1.0,
        }
    }

    /// Proposes the step after an accepted one of the given error.
    ///
    /// `iterations` of `allowed` corrections were made; `proposed` is the length that the accepted
    /// step would have had without a limit; `keep` says whether the matrices may be kept.
    fn accept(&mut self, error: f64, iterations: usize, allowed: usize, proposed: f64, keep: bool) {
        let h = self.h;
        let allowed = 2.0 * allowed as f64;
        let safety = 0.9 * (1.0 + allowed) / (iterations as f64 + allowed);
        let root = |x: f64| x.sqrt().sqrt();
        let mut divisor = root(error) / safety.min(0.9);
        if !self.first && self.h_accepted > 0.0 {
            divisor =
                divisor.max(self.h_accepted / h * root(error * error / self.error_accepted) / 0.9);
        }
        let divisor = divisor.clamp(1.0 / 8.0, 5.0);
        (self.h_accepted, self.error_accepted) = (h, error.max(1e-2));
        let mut h_next = h / divisor;
        if self.calm {
            h_next = h_next.min(h);
        }
        if h < proposed {
            // a step that the limit cut short says little against the one that was proposed
            h_next = h_next.max(proposed);
        }
        if keep && h_next >= h && h_next <= KEEP_STEP * h {
            h_next = h;
        }
        self.h_next = h_next;
        (self.first, self.calm) = (false, false);
    }
}

impl Radau {
    /// Prepares the method for `n` unknowns.
    pub fn new(n: usize, options: &Options) -> Self {
        let zeros = || vec![0.0; n];
        let point = || Point {
            t: 0.0,
            y: zeros(),
            f: zeros(),
        };
        let weights = Weights::new(n, options);
        let tolerance = inner_tolerance(weights.tolerance());
        Radau {
            options: options.clone(),
            weights,
            stats: Stats::default(),
            tolerance,
            begin: point(),
            end: point(),
            advanced: false,
            placing: Placing::default(),
            hidden: 0,
            unexplained: zeros(),
            eased: false,
            control: StepControl::new(),
            scale: zeros(),
            stages: Stages::new(n),
            convergence: Convergence::new(tolerance, options.max_newton),
            polynomial: Polynomial::new(n),
            systems: Systems::new(n),
            freshness: Freshness {
                here: false,
                stale: true,
                h_factored: 0.0,
                h_evaluated: 0.0,
            },
            error: zeros(),
            defect: zeros(),
        }
    }

    /// Begins at `(t, y)`: rate, first step, nothing known of the past.
    fn begin<P: Ode + ?Sized>(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        self.begin.t = t;
        self.advanced = false;
        self.begin.y.copy_from_slice(y);
        self.weights.see(t, y);
        (self.control.first, self.control.calm) = (true, false);
        self.freshness = Freshness {
            here: false,
            stale: true,
            h_factored: 0.0,
            h_evaluated: 0.0,
        };
        self.convergence.reset();
        self.polynomial.forget();
        self.stats.evaluations += 1;
        self.systems.shape(problem);
        let stop = |reason| Stop { reason, t, h: 0.0 };
        let Point { y, f, .. } = &mut self.begin;
        problem
            .rate(t, y, f)
            .map_err(|f| stop(Reason::Evaluation(f)))?;
        if let Some(i) = f.iter().position(|x| !x.is_finite()) {
            return Err(stop(Reason::NotFinite(i)));
        }
        let starter = control::Starter {
            order: ORDER,
            options: &self.options,
            weights: &self.weights,
        };
        let evaluations = &mut self.stats.evaluations;
        self.control.h_next = starter.first_step(
            t,
            y,
            f,
            &mut self.stages.argument,
            &mut self.end.f,
            |t, y, f| {
                *evaluations += 1;
                problem.rate(t, y, f)
            },
        );
        Ok(())
    }

    /// Evaluates the Jacobian at the beginning of the step.
    fn evaluate_jacobian<P: Ode + ?Sized>(&mut self, problem: &mut P) -> Result<(), Reason> {
        self.stats.jacobians += 1;
        self.systems
            .evaluate(problem, self.begin.t, &self.begin.y)
            .map_err(Reason::Evaluation)?;
        if let Some(row) = self.systems.not_finite() {
            return Err(Reason::NotFinite(row));
        }
        self.freshness = Freshness {
            here: true,
            stale: false,
            h_factored: 0.0,
            h_evaluated: self.control.h,
        };
        Ok(())
    }

    /// Factors the real and the complex matrix of the iteration for step `h`.
    ///
    /// # Errors
    /// The unknown that nothing determines.
    fn factor(&mut self, h: f64) -> Result<(), usize> {
        self.stats.factorizations += 1;
        self.freshness.h_factored = 0.0;
        self.systems.factor(GAMMA / h, ALPHA / h, BETA / h)?;
        self.stats.algebra += self.systems.operations()[0];
        self.freshness.h_factored = h;
        Ok(())
    }

    /// Sets the errors that the unknowns are permitted in a step of length `h`.
    fn set_scale(&mut self, h: f64) {
        let magnitudes = self.weights.magnitude();
        let tolerance = if self.eased {
            self.tolerance.max(NOISY_TOLERANCE)
        } else {
            self.tolerance
        };
        for ((scale, m), f) in self.scale.iter_mut().zip(magnitudes).zip(&self.begin.f) {
            let reached = (h * f).abs();
            *scale = 1.0 / (tolerance * if reached > *m { reached } else { *m });
        }
        for (i, j) in self.weights.rates() {
            let most = h / (RATE_SHARE_OF_POSITION * tolerance * magnitudes[j]);
            self.scale[i] = self.scale[i].min(most);
        }
    }

    /// Computes the new point (2), its rate, and the polynomial of the step.
    fn finish<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        h: f64,
        t1: f64,
    ) -> Result<(), Rejection> {
        let reject = |reason, recoverable| Rejection {
            reason,
            recoverable,
            factor: FAILED_STAGE_FACTOR,
        };
        let unprojected = &mut self.stages.argument;
        for i in 0..unprojected.len() {
            unprojected[i] = self.begin.y[i] + self.stages.z[2][i];
        }
        let Point { y, f, .. } = &mut self.end;
        y.copy_from_slice(unprojected);
        let moved = problem
            .project(t1, y)
            .map_err(|f| reject(Reason::Projection(f), f.recoverable))?;
        self.stats.evaluations += 1;
        problem
            .rate(t1, y, f)
            .map_err(|f| reject(Reason::Evaluation(f), f.recoverable))?;
        if let Some(i) = f.iter().position(|x| !x.is_finite()) {
            return Err(reject(Reason::NotFinite(i), true));
        }
        self.polynomial.fit(&self.stages.z, t1, h);
        if moved {
            self.polynomial.spread(y, unprojected);
        }
        Ok(())
    }

    /// Attempts a step of length `h` to `t1`: stages, error, new point.
    ///
    /// Returns the error, as a part of that permitted, and the number of Newton corrections.
    fn attempt<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        h: f64,
        t1: f64,
    ) -> Result<(f64, usize), Rejection> {
        // stages
        self.set_scale(h);
        self.polynomial
            .extrapolate(self.begin.t, h, &mut self.stages);
        let solved = self.solve_stages(problem, h);
        let better = problem.place_step(self.begin.t, h, STAGE_GAP, solved.is_err());
        if let Some(better) = better.filter(|_| self.placing.count < super::MOST_PLACINGS) {
            self.placing.better = Some(better);
            return Err(eased(better / h));
        }
        if solved.is_err() && !self.eased && problem.is_noisy() {
            self.eased = true;
            return Err(eased(1.0));
        }
        let iterations = solved?;

        // error
        let error = self.estimate(problem, h).map_err(failed_stage)?;
        if error.is_nan() {
            let index = worst_index(self.error.iter().copied());
            return Err(not_finite(index));
        }
        if error >= 1.0 {
            let row = worst_index(self.error.iter().zip(&self.scale).map(|(e, s)| e * s));
            let factor = if self.control.first {
                0.1
            } else {
                (0.9 / error.sqrt().sqrt()).clamp(0.125, 0.9)
            };
            return Err(Rejection {
                reason: Reason::ErrorTest(row),
                recoverable: true,
                factor,
            });
        }

        // new point
        self.finish(problem, h, t1)?;
        if self.convergence.is_untried(iterations)
            && let Some(row) = self.contradicted(h)
        {
            self.convergence.reset();
            return Err(Rejection {
                reason: Reason::Newton(row),
                recoverable: true,
                factor: FAILED_STAGE_FACTOR,
            });
        }
        Ok((error, iterations))
    }

    /// Solves for the stages; returns the number of Newton corrections.
    fn solve_stages<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        h: f64,
    ) -> Result<usize, Rejection> {
        let begin = Begin {
            t: self.begin.t,
            y: &self.begin.y,
            h,
        };
        let rounding = self.rounding(problem);
        let end = solve_collocation_system(
            problem,
            begin,
            (&self.scale, rounding),
            &mut self.stages,
            &mut self.systems,
            &mut self.convergence,
            &mut self.stats,
        );
        match end {
            Newton::Converged(iterations) => Ok(iterations),
            Newton::Slow(factor) => {
                self.hidden += usize::from(self.freshness.here);
                let g = self.stages.g[0].iter().zip(&self.scale);
                Err(Rejection {
                    reason: Reason::Newton(worst_index(g.map(|(g, s)| g * s))),
                    recoverable: true,
                    factor,
                })
            }
            Newton::Failed(failure) => Err(failed_stage(failure)),
            Newton::NotFinite(index) => Err(not_finite(index)),
        }
    }

    /// Factors the matrices if the step has changed, then attempts the step.
    fn factor_and_attempt<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        h: f64,
        t1: f64,
    ) -> Result<(f64, usize), Rejection> {
        if (h - self.freshness.h_factored).abs() > SAME_STEP * h {
            self.factor(h).map_err(|column| Rejection {
                reason: Reason::Singular(column),
                recoverable: true,
                factor: 0.5,
            })?;
        }
        self.attempt(problem, h, t1)
    }
}

/// Changes of the length of a step for [`Ode::place_step`].
#[derive(Clone, Copy, Debug, Default)]
struct Placing {
    /// how many there were
    count: usize,
    /// the length that the problem asks for now
    better: Option<f64>,
    /// the length that it was asked with at first, which the next step has, in s
    wanted: f64,
}

impl Placing {
    /// Takes the length that the problem asks for in place of `h`.
    fn take(&mut self, h: f64) -> f64 {
        self.count += 1;
        self.wanted = self.wanted.max(h);
        self.better.take().unwrap_or(h)
    }
}

/// Repeats an attempt with a length that is `factor` as long, or with the permitted error of a step
/// whose rates are noisy.
fn eased(factor: f64) -> Rejection {
    Rejection {
        reason: Reason::Newton(0),
        recoverable: true,
        factor,
    }
}

/// Rejects an attempt in which the problem could not be evaluated.
fn failed_stage(failure: Failure) -> Rejection {
    Rejection {
        reason: Reason::Evaluation(failure),
        recoverable: failure.recoverable,
        factor: FAILED_STAGE_FACTOR,
    }
}

/// Rejects an attempt in which the number with this index is not finite.
fn not_finite(index: usize) -> Rejection {
    Rejection {
        reason: Reason::NotFinite(index),
        recoverable: true,
        factor: FAILED_STAGE_FACTOR,
    }
}

/// Returns the permitted value of the error estimate for a requested accuracy.
///
/// The estimate behaves like h⁴ and the error of a run like h⁵, so the power 4/5 makes that error
/// fall in proportion to the request. The factor is measured: over pendulum, Kepler, van der Pol,
/// Robertson and HIRES, requests 1e-3 … 1e-11, the error is 0.01 to 20 times the request.
fn inner_tolerance(request: f64) -> f64 {
    0.05 * Scalar::powf(request, 0.8)
}

impl<P: Ode + ?Sized> Method<P> for Radau {
    fn start(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        self.stats = Stats::default();
        self.weights.reset(|typical| problem.typical(typical));
        self.weights
            .relate(|relations| problem.relations(relations));
        self.begin(problem, t, y)
    }

    fn reinitialize(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        self.begin(problem, t, y)
    }

    fn step(&mut self, problem: &mut P, t_limit: f64) -> Result<Step, Stop> {
        if self.advanced {
            std::mem::swap(&mut self.begin, &mut self.end);
            self.advanced = false;
        }
        let mut attempts = Attempts::new(self.begin.t, t_limit, &self.options);
        self.control.calm = false;
        (self.placing, self.eased) = (Placing::default(), false);
        self.hidden = 0;
        loop {
            let proposed = self.control.h_next.min(self.options.h_max);
            let too_fast = || control::too_fast(&self.begin.f, &self.weights);
            let (h, t1) = attempts.next(proposed, &self.options, &self.stats, too_fast)?;
            self.control.h = h;
            // a Jacobian that a short step hardly felt says nothing about a long one
            let grown = h > KEEP_GROWTH * self.freshness.h_evaluated;
            if self.freshness.stale || grown && !self.freshness.here {
                self.evaluate_jacobian(problem)
                    .map_err(|reason| attempts.stop(reason, h))?;
            }
            match self.factor_and_attempt(problem, h, t1) {
                Ok((error, iterations)) => {
                    let keep = self.convergence.theta <= KEEP_JACOBIAN_RATE;
                    let allowed = self.convergence.allowed;
                    if self.freshness.here {
                        self.freshness.h_evaluated = h;
                    }
                    self.control
                        .accept(error, iterations, allowed, proposed, keep);
                    self.control.h_next = self.control.h_next.max(self.placing.wanted);
                    (self.freshness.here, self.freshness.stale) = (false, !keep);
                    self.end.t = t1;
                    self.advanced = true;
                    let in_vain = self.eased || self.weights.is_raised();
                    self.stats.below_rounding += usize::from(in_vain);
                    self.weights.see(t1, &self.end.y);
                    return Ok(attempts.accepted(h, t1, ORDER, &mut self.stats));
                }
                Err(_) if self.placing.better.is_some() => {
                    self.control.h_next = self.placing.take(h);
                    attempts.repeat(&mut self.stats);
                    continue;
                }
                Err(rejection) => {
                    attempts.reject(rejection, h, &mut self.stats)?;
                    self.control.h_next = h * rejection.factor;
                    if !matches!(rejection.reason, Reason::ErrorTest(_)) && !self.freshness.here {
                        self.freshness.stale = true;
                    }
                }
            }
            self.control.calm = true;
        }
    }

    fn undo(&mut self) {
        if self.advanced {
            self.advanced = false;
            self.control.h_next = self.control.h;
            self.freshness.here = false;
        }
    }

    fn interpolate(&mut self, _problem: &mut P, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        if !self.advanced {
            y.copy_from_slice(&self.begin.y);
            return Ok(());
        }
        let s = (t - self.end.t) / self.control.h;
        for i in 0..y.len() {
            y[i] = self.end.y[i] + self.polynomial.rise(i, s);
        }
        Ok(())
    }

    fn interpolate_rate(
        &mut self,
        _problem: &mut P,
        t: f64,
        ydot: &mut [f64],
    ) -> Result<(), Failure> {
        if !self.advanced {
            ydot.copy_from_slice(&self.begin.f);
            return Ok(());
        }
        let s = (t - self.end.t) / self.control.h;
        for (i, rate) in ydot.iter_mut().enumerate() {
            *rate = self.polynomial.slope(i, s) / self.control.h;
        }
        Ok(())
    }

    fn quadrature(
        &mut self,
        problem: &mut P,
        ends: [f64; 2],
        work: &mut [Vec<f64>; 2],
        visit: &mut dyn FnMut(&mut P, Node<'_>),
    ) -> Result<(), Failure> {
        over_interpolant(self, problem, ends, &RADAU_3, work, visit)
    }

    fn leave(&mut self) -> Option<Memory> {
        let (jacobian, dfdt, factored) = self.systems.leave();
        let radau = Derivatives {
            jacobian,
            dfdt,
            freshness: self.freshness,
            factored,
        };
        self.freshness.stale = true;
        self.advanced.then_some(Memory {
            step: self.control.h_next,
            radau: Some(radau),
        })
    }

    fn go_on(&mut self, memory: &Memory) {
        self.control.h_next = memory.step;
        let Some(kept) = &memory.radau else { return };
        if self.systems.take(&kept.jacobian, &kept.dfdt) {
            self.freshness = kept.freshness;
            if self.systems.take_factors(kept.factored.as_deref()) {
                return;
            }
            // they follow from the Jacobian and the step
            self.systems.begin();
            let h = kept.freshness.h_factored;
            self.freshness.stale |= h != 0.0 && self.factor(h).is_err();
        }
    }

    fn weights(&self) -> &Weights {
        &self.weights
    }

    fn take_weights(&mut self, weights: Weights) {
        self.weights = weights;
    }

    fn propose(&mut self, h: f64) {
        self.control.h_next = h;
    }

    fn t(&self) -> f64 {
        if self.advanced {
            self.end.t
        } else {
            self.begin.t
        }
    }

    fn y(&self) -> &[f64] {
        if self.advanced {
            &self.end.y
        } else {
            &self.begin.y
        }
    }

    fn ydot(&self) -> &[f64] {
        if self.advanced {
            &self.end.f
        } else {
            &self.begin.f
        }
    }

    fn stats(&self) -> &Stats {
        &self.stats
    }
}
