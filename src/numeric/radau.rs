//! Radau IIA of order 5: three implicit stages, for stiff problems, projected onto invariants.
//!
//! ```text
//! Zᵢ = h Σ aᵢⱼ f(t + cⱼ h, y + Zⱼ)          i, j = 1 … 3,   c = (4−√6)/10, (4+√6)/10, 1            (1)
//! y₁ = project(y + Z₃)                                                                            (2)
//! A⁻¹ = T diag(γ̂, [α̂ −β̂; β̂ α̂]) T⁻¹,   W = T⁻¹ Z:  one real and one complex system per iteration      (3)
//!     (γ̂/h − J) ΔW₁ = …            (α̂/h + i β̂/h − J)(ΔW₂ + i ΔW₃) = …
//! error = (γ̂/h − J)⁻¹ (f(t, y) + Σ eᵢ Zᵢ/h);  when too large in a first or repeated attempt, once more
//!     with f(t, y + error) instead of f(t, y)                                                      (4)
//! y(t + h + s h) = y₁ + s (p₂ + s' …): the polynomial through the stages, and y₀                   (5)
//! ```
//!
//! *Newton*: simplified, started from the extrapolated polynomial (5) of the step before. Its rate of convergence Θ is measured; iterations stop when
//! the next correction is predicted to be small against the tolerance, and are given up as soon as Θ predicts that the permitted
//! number will not do. The Jacobian is kept while Θ ≤ 0.02, the factors of (3) also while the step would grow by less than a fifth.
//! *Step*: Gustafsson's predictive control. The estimate (4) is of order 3, below that of the method, so the inner tolerance is a power of the request.
//! *Rates*: the error of a velocity v, where the problem says of what it is the rate, is measured against 10⁻³ |q|/h where that is more than |v|. So undamped
//! vibrations that cannot be seen in q (a structure's at 480 kHz) are not followed for thousands of steps a millisecond, but damped as the method does; a
//! motion of a thousand steps or less is followed in its velocity as exactly as ever.
//! *Failures*: a stage that fails, a singular matrix or a number that is not finite shorten the step; no sensible step left is a [`Stop`].
//!
//! Source: Hairer & Wanner, Solving ODEs II, IV.8 (program RADAU5).
#![allow(clippy::needless_range_loop)] // many arrays at one index read best that way

use super::control::{self, Weights, worst, worst_index};
use super::radau_systems::Systems;
use super::{Failure, Method, Ode, Options, Reason, Stats, Step, Stop};

/// Order of the method.
const ORDER: usize = 5;
/// √6
const SQRT6: f64 = 2.449489742783178;
/// Nodes of (1).
const C: [f64; 3] = [(4.0 - SQRT6) / 10.0, (4.0 + SQRT6) / 10.0, 1.0];
/// eᵢ of (4).
const E: [f64; 3] = [
    -(13.0 + 7.0 * SQRT6) / 3.0,
    (-13.0 + 7.0 * SQRT6) / 3.0,
    -1.0 / 3.0,
];
/// γ̂, α̂, β̂ of (3).
const GAMMA: f64 = 3.637834252744496;
const ALPHA: f64 = 2.6810828736277523;
const BETA: f64 = 3.0504301992474105;
/// T of (3); its last row is (T31, 1, 0).
const T: [[f64; 3]; 3] = [
    [
        0.09123239487089295,
        -0.1412552950209542,
        -0.030029194105147424,
    ],
    [0.241717932707107, 0.20412935229379994, 0.3829421127572619],
    [0.966048182615093, 1.0, 0.0],
];
/// T⁻¹
const TI: [[f64; 3]; 3] = [
    [4.325579890063155, 0.33919925181580984, 0.5417705399358749],
    [
        -4.178718591551905,
        -0.32768282076106237,
        0.47662355450055044,
    ],
    [-0.5028726349457868, 2.571926949855605, -0.5960392048282249],
];
/// Convergence rate up to which the Jacobian is kept.
const KEEP_JACOBIAN: f64 = 0.02;
/// Growth of the step up to which the factors are kept.
const KEEP_STEP: f64 = 1.2;

/// Part of the magnitude of an unknown, per step, that the error of its rate is always allowed to be measured against.
const FELT: f64 = 1e-3;

/// Radau IIA of order 5 with projection; see the file's card.
#[derive(Clone, Debug)]
pub struct Radau {
    options: Options,
    weights: Weights,
    stats: Stats,
    /// permitted value of the error estimate (4), and of the next Newton correction relative to it
    tolerance: f64,
    newton_tolerance: f64,
    /// beginning, length and end of the last step
    t0: f64,
    h: f64,
    t1: f64,
    /// whether (t1, y1, f1) is the state, or (t0, y0, f0)
    advanced: bool,
    /// step proposed for the next attempt
    h_next: f64,
    /// nothing known yet of the error; the last attempt was rejected
    first: bool,
    calm: bool,
    /// the Jacobian was evaluated at t0; must be evaluated; the step for which the factors hold (0: none)
    jacobian_here: bool,
    jacobian_stale: bool,
    h_factored: f64,
    /// memory of the Newton iteration: Θ/(1 − Θ) and Θ
    rate_factor: f64,
    theta: f64,
    /// last accepted step and its error, for the predictive control
    h_accepted: f64,
    error_accepted: f64,
    /// state and rate at t0 and t1   (n each)
    y0: Vec<f64>,
    f0: Vec<f64>,
    y1: Vec<f64>,
    f1: Vec<f64>,
    /// 1/(tolerance · magnitude) for this step   (n)
    scale: Vec<f64>,
    /// stages Z, transformed stages W, right-hand sides   (3 × n each)
    z: [Vec<f64>; 3],
    w: [Vec<f64>; 3],
    g: [Vec<f64>; 3],
    /// argument of a rate; error estimate; argument-free part of it   (n each)
    stage: Vec<f64>,
    error: Vec<f64>,
    defect: Vec<f64>,
    /// divided differences of (5), of the last accepted step   (3 × n)
    p: [Vec<f64>; 3],
    /// the step that (5) describes: end and length (0: none)
    p_end: f64,
    p_h: f64,
    systems: Systems,
}

/// How the Newton iteration ended.
enum Newton {
    /// after so many iterations
    Converged(usize),
    /// give up: the step should be multiplied by this factor
    Slow(f64),
    Failed(Failure),
    NotFinite(usize),
}

impl Radau {
    /// The method for `n` unknowns.
    pub fn new(n: usize, options: &Options) -> Self {
        let zeros = || vec![0.0; n];
        let three = || [zeros(), zeros(), zeros()];
        let weights = Weights::new(n, options);
        let tolerance = inner_tolerance(weights.tolerance());
        Radau {
            options: options.clone(),
            weights,
            stats: Stats::default(),
            tolerance,
            newton_tolerance: (10.0 * f64::EPSILON / tolerance).max(tolerance.sqrt().min(0.03)),
            t0: 0.0,
            h: 0.0,
            t1: 0.0,
            advanced: false,
            h_next: 0.0,
            first: true,
            calm: false,
            jacobian_here: false,
            jacobian_stale: true,
            h_factored: 0.0,
            rate_factor: 1.0,
            theta: KEEP_JACOBIAN,
            h_accepted: 0.0,
            error_accepted: 1.0,
            y0: zeros(),
            f0: zeros(),
            y1: zeros(),
            f1: zeros(),
            scale: zeros(),
            z: three(),
            w: three(),
            g: three(),
            stage: zeros(),
            error: zeros(),
            defect: zeros(),
            p: three(),
            p_end: 0.0,
            p_h: 0.0,
            systems: Systems::new(n),
        }
    }

    fn begin<P: Ode + ?Sized>(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        self.t0 = t;
        self.advanced = false;
        self.y0.copy_from_slice(y);
        self.weights.see(y);
        (self.first, self.calm) = (true, false);
        (self.jacobian_here, self.jacobian_stale, self.h_factored) = (false, true, 0.0);
        (self.rate_factor, self.theta, self.p_h) = (1.0, KEEP_JACOBIAN, 0.0);
        self.stats.evaluations += 1;
        self.systems.shape(problem);
        let stop = |reason| Stop { reason, t, h: 0.0 };
        problem
            .rate(t, &self.y0, &mut self.f0)
            .map_err(|f| stop(Reason::Evaluation(f)))?;
        if let Some(i) = self.f0.iter().position(|x| !x.is_finite()) {
            return Err(stop(Reason::NotFinite(i)));
        }
        let starter = control::Starter {
            order: ORDER,
            options: &self.options,
            weights: &self.weights,
        };
        let evaluations = &mut self.stats.evaluations;
        self.h_next = starter.first_step(
            t,
            &self.y0,
            &self.f0,
            &mut self.stage,
            &mut self.f1,
            |t, y, f| {
                *evaluations += 1;
                problem.rate(t, y, f)
            },
        );
        Ok(())
    }

    /// The Jacobian at t0.
    fn evaluate_jacobian<P: Ode + ?Sized>(&mut self, problem: &mut P) -> Result<(), Reason> {
        self.stats.jacobians += 1;
        (self.systems.evaluate(problem, self.t0, &self.y0)).map_err(Reason::Evaluation)?;
        if let Some(row) = self.systems.not_finite() {
            return Err(Reason::NotFinite(row));
        }
        (self.jacobian_here, self.jacobian_stale, self.h_factored) = (true, false, 0.0);
        Ok(())
    }

    /// The two matrices of (3) for step `h`.
    fn factor(&mut self, h: f64) -> Result<(), usize> {
        self.stats.factorizations += 1;
        self.h_factored = 0.0;
        self.systems.factor(GAMMA / h, ALPHA / h, BETA / h)?;
        self.h_factored = h;
        Ok(())
    }

    /// First guess of the stages, from the polynomial of the step before.
    fn guess(&mut self, h: f64) {
        let n = self.y0.len();
        let [z1, z2, z3] = &mut self.z;
        let [w1, w2, w3] = &mut self.w;
        if self.p_h == 0.0 {
            for x in [z1, z2, z3, w1, w2, w3] {
                x.fill(0.0);
            }
            return;
        }
        let s = |c: f64| (self.t0 + c * h - self.p_end) / self.p_h;
        let (s0, s1, s2, s3) = (s(0.0), s(C[0]), s(C[1]), s(C[2]));
        let [p1, p2, p3] = &self.p;
        for i in 0..n {
            let at =
                |s: f64| s * (p1[i] + (s - (C[1] - 1.0)) * (p2[i] + (s - (C[0] - 1.0)) * p3[i]));
            let begin = at(s0);
            (z1[i], z2[i], z3[i]) = (at(s1) - begin, at(s2) - begin, at(s3) - begin);
            w1[i] = TI[0][0] * z1[i] + TI[0][1] * z2[i] + TI[0][2] * z3[i];
            w2[i] = TI[1][0] * z1[i] + TI[1][1] * z2[i] + TI[1][2] * z3[i];
            w3[i] = TI[2][0] * z1[i] + TI[2][1] * z2[i] + TI[2][2] * z3[i];
        }
    }

    /// Solves (1) by (3).
    fn newton<P: Ode + ?Sized>(&mut self, problem: &mut P, h: f64) -> Newton {
        let n = self.y0.len();
        let (t, allowed) = (self.t0, self.options.max_newton.max(3));
        let (gamma, alpha, beta) = (GAMMA / h, ALPHA / h, BETA / h);
        let mut rate_factor = self.rate_factor.max(f64::EPSILON).powf(0.8);
        let (mut previous, mut previous_quotient) = (0.0, 0.0);
        self.theta = KEEP_JACOBIAN;
        for iteration in 0..allowed {
            // rates at the stages
            for stage in 0..3 {
                for i in 0..n {
                    self.stage[i] = self.y0[i] + self.z[stage][i];
                }
                self.stats.evaluations += 1;
                if let Err(failure) =
                    problem.rate(t + C[stage] * h, &self.stage, &mut self.g[stage])
                {
                    return Newton::Failed(failure);
                }
            }
            if let Some(bad) = self
                .g
                .iter()
                .find_map(|g| g.iter().position(|x| !x.is_finite()))
            {
                return Newton::NotFinite(bad);
            }
            // the residual, transformed
            let [g1, g2, g3] = &mut self.g;
            let [w1, w2, w3] = &mut self.w;
            let (g1, g2, g3) = (&mut g1[..n], &mut g2[..n], &mut g3[..n]);
            let (w1, w2, w3) = (&mut w1[..n], &mut w2[..n], &mut w3[..n]);
            for i in 0..n {
                let (f1, f2, f3) = (g1[i], g2[i], g3[i]);
                g1[i] = TI[0][0] * f1 + TI[0][1] * f2 + TI[0][2] * f3 - gamma * w1[i];
                g2[i] =
                    TI[1][0] * f1 + TI[1][1] * f2 + TI[1][2] * f3 - alpha * w2[i] + beta * w3[i];
                g3[i] =
                    TI[2][0] * f1 + TI[2][1] * f2 + TI[2][2] * f3 - alpha * w3[i] - beta * w2[i];
            }
            self.systems.solve(g1);
            self.systems.solve_complex(g2, g3);
            self.stats.newton_iterations += 1;
            // the corrections
            let [z1, z2, z3] = &mut self.z;
            let (z1, z2, z3) = (&mut z1[..n], &mut z2[..n], &mut z3[..n]);
            let scale = &self.scale[..n];
            let (mut size, mut sum) = (0.0, 0.0);
            for i in 0..n {
                w1[i] += g1[i];
                w2[i] += g2[i];
                w3[i] += g3[i];
                z1[i] = T[0][0] * w1[i] + T[0][1] * w2[i] + T[0][2] * w3[i];
                z2[i] = T[1][0] * w1[i] + T[1][1] * w2[i] + T[1][2] * w3[i];
                z3[i] = T[2][0] * w1[i] + w2[i];
                let change = (g1[i].abs() + g2[i].abs() + g3[i].abs()) * scale[i];
                sum += change;
                size = if change > size { change } else { size };
            }
            if !sum.is_finite() {
                return Newton::NotFinite(g1.iter().position(|x| !x.is_finite()).unwrap_or(0));
            }
            // does it converge, and soon enough?
            if iteration > 0 && size > 0.0 {
                let quotient = size / previous;
                self.theta = if iteration == 1 {
                    quotient
                } else {
                    f64::sqrt(quotient * previous_quotient)
                };
                previous_quotient = quotient;
                if self.theta >= 0.99 {
                    return Newton::Slow(0.5);
                }
                rate_factor = self.theta / (1.0 - self.theta);
                let left = (allowed - 1 - iteration) as f64;
                let predicted = rate_factor * size * self.theta.powf(left) / self.newton_tolerance;
                if predicted >= 1.0 && left > 0.0 {
                    let excess = predicted.clamp(1e-4, 20.0);
                    return Newton::Slow(0.8 * excess.powf(-1.0 / (4.0 + left)));
                }
            }
            previous = size.max(f64::MIN_POSITIVE);
            if rate_factor * size <= self.newton_tolerance {
                self.rate_factor = rate_factor;
                return Newton::Converged(iteration + 1);
            }
        }
        Newton::Slow(0.5)
    }

    /// The error estimate (4).
    fn estimate<P: Ode + ?Sized>(&mut self, problem: &mut P, h: f64) -> Result<f64, Failure> {
        let n = self.y0.len();
        for i in 0..n {
            self.defect[i] = (E[0] * self.z[0][i] + E[1] * self.z[1][i] + E[2] * self.z[2][i]) / h;
            self.error[i] = self.defect[i] + self.f0[i];
        }
        self.systems.solve(&mut self.error);
        let norm = |e: &[f64], scale: &[f64]| worst(e.iter().zip(scale).map(|(e, s)| e * s));
        let mut error = norm(&self.error, &self.scale);
        if error >= 1.0 && (self.first || self.calm) {
            for i in 0..n {
                self.stage[i] = self.y0[i] + self.error[i];
            }
            self.stats.evaluations += 1;
            problem.rate(self.t0, &self.stage, &mut self.error)?;
            for i in 0..n {
                self.error[i] += self.defect[i];
            }
            self.systems.solve(&mut self.error);
            error = norm(&self.error, &self.scale);
        }
        Ok(error.max(1e-10))
    }

    /// The new point (2), its rate, and the polynomial (5).
    fn finish<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        h: f64,
        t1: f64,
    ) -> Result<(), (Reason, bool)> {
        let n = self.y0.len();
        for i in 0..n {
            self.y1[i] = self.y0[i] + self.z[2][i];
        }
        self.stage.copy_from_slice(&self.y1);
        let moved = problem
            .project(t1, &mut self.y1)
            .map_err(|f| (Reason::Projection(f), f.recoverable))?;
        self.stats.evaluations += 1;
        problem
            .rate(t1, &self.y1, &mut self.f1)
            .map_err(|f| (Reason::Evaluation(f), f.recoverable))?;
        if let Some(i) = self.f1.iter().position(|x| !x.is_finite()) {
            return Err((Reason::NotFinite(i), true));
        }
        let [p1, p2, p3] = &mut self.p;
        for i in 0..n {
            let (z1, z2, z3) = (self.z[0][i], self.z[1][i], self.z[2][i]);
            let d12 = (z1 - z2) / (C[0] - C[1]);
            let d23 = (z2 - z3) / (C[1] - 1.0);
            let d01 = (d12 - z1 / C[0]) / C[1];
            p1[i] = d23;
            p2[i] = (d12 - d23) / (C[0] - 1.0);
            p3[i] = p2[i] - d01;
        }
        if moved {
            // spread the projection over the step, so that the polynomial still begins at y₀
            for i in 0..n {
                p1[i] += self.y1[i] - self.stage[i];
            }
        }
        (self.p_end, self.p_h) = (t1, h);
        Ok(())
    }

    /// After an accepted step: the next one by predictive control, and what can be kept for it.
    fn plan(&mut self, h: f64, error: f64, iterations: usize, proposed: f64) {
        let allowed = 2.0 * self.options.max_newton.max(3) as f64;
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
        let keep = self.theta <= KEEP_JACOBIAN;
        if keep && h_next >= h && h_next <= KEEP_STEP * h {
            h_next = h;
        }
        self.h_next = h_next;
        self.jacobian_here = false;
        self.jacobian_stale = !keep;
    }
}

/// The permitted value of the error estimate for a requested accuracy.
///
/// The estimate behaves like h⁴ and the error of a run like h⁵, so the power 4/5 makes that error fall in proportion to the request. The factor
/// is measured: over pendulum, Kepler, van der Pol, Robertson and HIRES, requests 1e-3 … 1e-11, the error is 0.01 to 20 times the request.
fn inner_tolerance(request: f64) -> f64 {
    0.05 * request.powf(0.8)
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
            std::mem::swap(&mut self.y0, &mut self.y1);
            std::mem::swap(&mut self.f0, &mut self.f1);
            self.t0 = self.t1;
            self.advanced = false;
        }
        let t0 = self.t0;
        let shortest = control::shortest(t0, &self.options);
        let mut cause = None;
        let mut rejected = 0;
        self.calm = false;
        loop {
            let proposed = self.h_next.min(self.options.h_max);
            let (h, at_limit) = control::fit(t0, proposed, t_limit);
            let stop = |reason| Err(Stop { reason, t: t0, h });
            if self.stats.steps + self.stats.rejected >= self.options.max_steps {
                return stop(Reason::TooManySteps);
            }
            if h < shortest && (rejected > 0 || !at_limit) {
                return stop(cause.unwrap_or_else(|| control::too_fast(&self.f0, &self.weights)));
            }
            let t1 = if at_limit { t_limit } else { t0 + h };
            self.h = h;

            // matrices
            if self.jacobian_stale
                && let Err(reason) = self.evaluate_jacobian(problem)
            {
                return stop(reason);
            }
            let attempt = if h != self.h_factored
                && let Err(column) = self.factor(h)
            {
                Err((Reason::Singular(column), true, 0.5))
            } else {
                self.attempt(problem, h, t1)
            };
            match attempt {
                Ok((error, iterations)) => {
                    self.plan(h, error, iterations, proposed);
                    (self.first, self.calm) = (false, false);
                    self.t1 = t1;
                    self.advanced = true;
                    self.weights.see(&self.y1);
                    self.stats.steps += 1;
                    return Ok(Step {
                        t0,
                        t1,
                        h,
                        order: ORDER,
                        rejected,
                    });
                }
                Err((reason, recoverable, factor)) => {
                    cause = Some(reason);
                    if !recoverable {
                        return stop(reason);
                    }
                    self.h_next = h * factor;
                    if !matches!(reason, Reason::ErrorTest(_)) && !self.jacobian_here {
                        self.jacobian_stale = true;
                    }
                }
            }
            self.calm = true;
            rejected += 1;
            self.stats.rejected += 1;
        }
    }

    fn undo(&mut self) {
        if self.advanced {
            self.advanced = false;
            self.h_next = self.h;
            self.jacobian_here = false;
        }
    }

    fn interpolate(&mut self, _problem: &mut P, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        if !self.advanced {
            y.copy_from_slice(&self.y0);
            return Ok(());
        }
        let s = (t - self.t1) / self.h;
        let [p1, p2, p3] = &self.p;
        for i in 0..y.len() {
            y[i] = self.y1[i]
                + s * (p1[i] + (s - (C[1] - 1.0)) * (p2[i] + (s - (C[0] - 1.0)) * p3[i]));
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
            ydot.copy_from_slice(&self.f0);
            return Ok(());
        }
        let s = (t - self.t1) / self.h;
        let (a, b) = (s - (C[1] - 1.0), s - (C[0] - 1.0));
        let [p1, p2, p3] = &self.p;
        for i in 0..ydot.len() {
            ydot[i] = (p1[i] + (a + s) * p2[i] + (a * b + s * b + s * a) * p3[i]) / self.h;
        }
        Ok(())
    }

    fn propose(&mut self, h: f64) {
        self.h_next = h;
    }

    fn t(&self) -> f64 {
        if self.advanced { self.t1 } else { self.t0 }
    }

    fn y(&self) -> &[f64] {
        if self.advanced { &self.y1 } else { &self.y0 }
    }

    fn ydot(&self) -> &[f64] {
        if self.advanced { &self.f1 } else { &self.f0 }
    }

    fn stats(&self) -> &Stats {
        &self.stats
    }
}

impl Radau {
    /// One attempt: stages, error, new point. Gives the error and the number of iterations; or the reason, whether a shorter step may help, and the factor for it.
    fn attempt<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        h: f64,
        t1: f64,
    ) -> Result<(f64, usize), (Reason, bool, f64)> {
        for ((scale, m), f) in self
            .scale
            .iter_mut()
            .zip(self.weights.magnitude())
            .zip(&self.f0)
        {
            let reached = (h * f).abs();
            *scale = 1.0 / (self.tolerance * if reached > *m { reached } else { *m });
        }
        for (i, j) in self.weights.rates() {
            let most = h / (FELT * self.tolerance * self.weights.magnitude()[j]);
            self.scale[i] = self.scale[i].min(most);
        }
        self.guess(h);
        let iterations = match self.newton(problem, h) {
            Newton::Converged(iterations) => iterations,
            Newton::Slow(factor) => {
                let row = worst_index(self.g[0].iter().zip(&self.scale).map(|(g, s)| g * s));
                return Err((Reason::Newton(row), true, factor));
            }
            Newton::Failed(failure) => {
                return Err((Reason::Evaluation(failure), failure.recoverable, 0.25));
            }
            Newton::NotFinite(i) => return Err((Reason::NotFinite(i), true, 0.25)),
        };
        let evaluation = |f: Failure| (Reason::Evaluation(f), f.recoverable, 0.25);
        let error = self.estimate(problem, h).map_err(evaluation)?;
        if error.is_nan() {
            return Err((
                Reason::NotFinite(worst_index(self.error.iter().copied())),
                true,
                0.25,
            ));
        }
        if error >= 1.0 {
            let row = worst_index(self.error.iter().zip(&self.scale).map(|(e, s)| e * s));
            let factor = if self.first {
                0.1
            } else {
                (0.9 / error.sqrt().sqrt()).clamp(0.125, 0.9)
            };
            return Err((Reason::ErrorTest(row), true, factor));
        }
        self.finish(problem, h, t1)
            .map_err(|(reason, recoverable)| (reason, recoverable, 0.25))?;
        Ok((error, iterations))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Radau IIA's matrix A in closed form (Butcher 1964).
    fn butcher() -> nalgebra::Matrix3<f64> {
        let r = SQRT6;
        nalgebra::Matrix3::new(
            (88.0 - 7.0 * r) / 360.0,
            (296.0 - 169.0 * r) / 1800.0,
            (-2.0 + 3.0 * r) / 225.0,
            (296.0 + 169.0 * r) / 1800.0,
            (88.0 + 7.0 * r) / 360.0,
            (-2.0 - 3.0 * r) / 225.0,
            (16.0 - r) / 36.0,
            (16.0 + r) / 36.0,
            1.0 / 9.0,
        )
    }

    #[test]
    fn the_transformation_diagonalizes_the_method() {
        let t = nalgebra::Matrix3::from_fn(|i, j| T[i][j]);
        let ti = nalgebra::Matrix3::from_fn(|i, j| TI[i][j]);
        assert!((t * ti - nalgebra::Matrix3::identity()).abs().max() < 1e-13);
        let inverse = butcher().try_inverse().unwrap();
        let block = ti * inverse * t;
        let expected = nalgebra::Matrix3::new(GAMMA, 0.0, 0.0, 0.0, ALPHA, -BETA, 0.0, BETA, ALPHA);
        assert!((block - expected).abs().max() < 1e-12, "{block}");
    }
}
