//! Explicit Runge–Kutta of order 8 for what is not stiff, projected onto invariants: DOP853.
//!
//! ```text
//! kᵢ = f(t + cᵢ h, y + h Σ_{j<i} aᵢⱼ kⱼ)        i = 1 … 12                                 (1)
//! y₁ = project(y + h Σ bᵢ kᵢ)                                                             (2)
//! e₅ = h Σ eᵢ kᵢ,   e₃ = h Σ (bᵢ − b̂ᵢ) kᵢ,   error = s ‖e₅‖² / √(‖e₅‖² + ‖e₃‖²/100)       (3)
//! y(t + θh) = y + θ(r₁ + (1−θ)(r₂ + θ(r₃ + (1−θ)(r₄ + θ(r₅ + (1−θ)(r₆ + θ r₇))))))        (4)
//! ```
//!
//! The factor s = 20 in (3) is measured: over pendulum, double pendulum, Kepler and Euler top,
//! requests 1e-3 … 1e-11, it brings the error at the end of a run to about the request (0.1 to 10
//! times) and makes it fall in proportion; the work for a given true error does not depend on it.
//!
//! The error test (3) needs no rate at the new point. So the new point is projected first and its
//! rate, which is `k₁` of the next step, is evaluated once on the invariants: projection costs no
//! evaluation. The interpolant (4) is of order 7 and needs three more evaluations; they are made at
//! the first interpolation inside a step. Of order 6 is what the stages alone say of the middle of
//! a step: the weights fulfil the conditions of all trees up to there, with the least squares.
//!
//! *Stiffness*: when `h |λ| ≈ h |k₁₃ − k₁₂| / |y₁ − Y₁₂|` lies beyond 6.1, the edge of the
//! stability region, in most of the recent steps, stability holds the step down. [`Method::stiff`]
//! says so, and the integration goes on. There the interpolant (4), whose further stages magnify
//! what is left of fast modes by `(h λ)³`, is compared with the rate in the middle of the step;
//! where they do not fit, a value within the step is computed by a step of its own.
//!
//! *Rounding*: the part of an error that rounding explains (`noise.rs`) shortens no step, since a
//! shorter one would be no better. It is measured where an error is too large, and where the two
//! estimates, which are of different order, come out alike.
//!
//! *Failures*: a stage where the problem fails, or a number that is not finite, shortens the step;
//! when no sensible step is left the method ends with a [`Stop`].
//!
//! Source: Dormand & Prince 1980; coefficients, error and dense output of Hairer, Nørsett & Wanner,
//! Solving ODEs I, II.5–II.10 (program DOP853).
#![allow(clippy::needless_range_loop)] // many arrays at one index read best that way

use super::control::{self, Attempts, Pi, Rejection, Weights, worst, worst_index};
use super::noise::{Noise, Probed};
use super::quadrature::Node;
use super::{Failure, Memory, Method, Ode, Options, Reason, Stats, Step, Stop};
use interpolant::Interpolant;

/// Order of the method.
const ORDER: usize = 8;
/// s of (3); measured, see above.
const ERROR_SCALE: f64 = 20.0;
/// b₁ and b₆ … b₁₂ of (2); the others are zero.
const B: [f64; 8] = [
    0.054293734116568765,
    4.450312892752409,
    1.8915178993145003,
    -5.801203960010585,
    0.3111643669578199,
    -0.1521609496625161,
    0.20136540080403034,
    0.04471061572777259,
];
/// Stages between the first and the next with a weight b.
const UNWEIGHTED_STAGES: usize = 4;
/// cᵢ of the stages from there on.
const WEIGHTED_AT: [f64; 7] = [
    0.3333333333333333,
    0.25,
    0.3076923076923077,
    0.6512820512820513,
    0.6,
    0.8571428571428571,
    1.0,
];
/// `h |λ|` at the edge of the stability region.
const STABILITY_EDGE: f64 = 6.1;
/// Request below which steps are held shorter than the edge: there the errors that the fast modes
/// magnify count before they grow.
const FINE_REQUEST: f64 = 1e-10;
/// `h |λ|` from which on stability counts as the limit at such requests. A damper of 10⁶ is
/// stepped at 5.4, 4.3 and 3.7 at 1e-11, 1e-12 and 1e-13; a motion that is followed as exactly, at
/// less than 1.
const FINE_STABILITY_EDGE: f64 = 3.0;
/// Steps beyond the edge from which on the problem is called stiff.
const STIFF_STEPS: u32 = 15;
/// Steps within the edge, in a row, after which those beyond it are forgotten.
const CALM_STEPS: u32 = 6;

/// Computes `out = y + h (a₁ k₁ + a₂ k₂ + …)`: a row of the tableau as one loop.
macro_rules! row {
    ($out:ident = $y:ident + $h:ident * ($k0:ident $a0:literal $(, $k:ident $a:literal)*)) => {{
        let n = $y.len();
        let ($out, $k0) = (&mut $out[..n], &$k0[..n]);
        $(let $k = &$k[..n];)*
        for i in 0..n {
            $out[i] = $y[i] + $h * ($a0 * $k0[i] $(+ $a * $k[i])*);
        }
    }};
}

// behind the macro that it uses
mod interpolant;

/// Explicit Runge–Kutta of order 8 with projection; see the file's card.
#[derive(Clone, Debug)]
pub struct Dop853 {
    options: Options,
    weights: Weights,
    control: Pi,
    noise: Noise,
    /// whether the error of the last attempt was too large, and explained by rounding
    noisy: bool,
    stats: Stats,
    /// beginning of the last step, in s
    t0: f64,
    /// length of the last step, in s
    h: f64,
    /// end of the last accepted step, in s
    t1: f64,
    /// whether (t1, y1, f1) is the state, or (t0, y0, f0)
    advanced: bool,
    /// step proposed for the next attempt, in s
    h_next: f64,
    /// the last attempt was rejected
    calm: bool,
    /// no step has been accepted since the start
    first: bool,
    /// steps beyond the edge of stability, not yet forgotten
    beyond_edge: u32,
    /// steps in a row within that edge
    within_edge: u32,
    /// h |λ| of the last accepted step
    h_lambda: f64,
    /// solution at t0   (n)
    y0: Vec<f64>,
    /// rate at t0, which is k₁   (n)
    f0: Vec<f64>,
    /// solution at t1   (n)
    y1: Vec<f64>,
    /// rate at t1, which is k₁₃   (n)
    f1: Vec<f64>,
    /// argument of a stage; after the step, that of the twelfth   (n)
    stage: Vec<f64>,
    /// arguments of the stages with a weight b after the first, where somebody integrates along
    /// steps   (7 × n; else empty)
    weighted: Vec<f64>,
    /// k₂ … k₁₂   (11 × n)
    k: [Vec<f64>; 11],
    /// changes of the length of the present step for [`Ode::place_step`]
    placed: usize,
    /// the solution within the last step
    interpolant: Interpolant,
}

/// The reason why an attempt was not accepted.
enum Trouble {
    /// the error, as a part of that permitted, is too large
    Error(f64),
    /// another length, in s, is better
    Place(f64),
    /// there is no value; the flag says whether a shorter step may help
    Reason(Reason, bool),
}

/// Widest interval without an evaluation, from and to these parts of a step.
const STAGE_GAP: [f64; 2] = [1.0 / 3.0, 0.6];

/// Relative error below which a filtered error is rounding, where invariants are nearly dependent;
/// a smaller request is not enforced there.
const INVARIANT_NOISE: f64 = 3e-10;

/// Ratio ‖e₃‖/‖e₅‖ of (3) below which both may be rounding: in smooth motion their different orders
/// keep them further apart.
const ALIKE_RATIO: f64 = 10.0;
/// Error, as a part of that permitted, from which it holds the next step back.
const SUSPECT_ERROR: f64 = 0.1;
/// Part of an error that counts although rounding explains it, lest the next step is much too long.
const REMAINING_SHARE: f64 = 0.02;

/// Returns `‖e₅‖² / √(‖e₅‖² + ‖e₃‖²/100)`.
fn blended(e5: f64, e3: f64) -> f64 {
    let blend = e5 * e5 + 0.01 * e3 * e3;
    if blend > 0.0 {
        e5 * e5 / blend.sqrt()
    } else {
        0.0
    }
}

/// Returns `Σ eᵢ kᵢ` of (3) from k₁ and k₆ … k₁₂.
#[inline(always)]
fn e5_slope([k1, k6, k7, k8, k9, k10, k11, k12]: [f64; 8]) -> f64 {
    0.01312004499419488 * k1 - 1.2251564463762044 * k6 - 0.4957589496572502 * k7
        + 1.6643771824549864 * k8
        - 0.35032884874997366 * k9
        + 0.3341791187130175 * k10
        + 0.08192320648511571 * k11
        - 0.022355307863886294 * k12
}

/// Returns `Σ b̂ᵢ kᵢ` of (3).
#[inline(always)]
fn b_hat_slope(k1: f64, k9: f64, k12: f64) -> f64 {
    0.2440944881889764 * k1 + 0.7338466882816118 * k9 + 0.022058823529411766 * k12
}

impl Dop853 {
    /// Prepares the method for `n` unknowns.
    pub fn new(n: usize, options: &Options) -> Self {
        let zeros = || vec![0.0; n];
        Dop853 {
            options: options.clone(),
            weights: Weights::new(n, options),
            control: Pi::new(8.0, 0.02, 0.85, 1.0 / 3.0, 6.0),
            noise: Noise::new(n),
            noisy: false,
            stats: Stats::default(),
            t0: 0.0,
            h: 0.0,
            t1: 0.0,
            advanced: false,
            h_next: 0.0,
            calm: false,
            first: true,
            beyond_edge: 0,
            within_edge: 0,
            h_lambda: 0.0,
            y0: zeros(),
            f0: zeros(),
            y1: zeros(),
            f1: zeros(),
            stage: zeros(),
            weighted: Vec::new(),
            k: std::array::from_fn(|_| zeros()),
            placed: 0,
            interpolant: Interpolant::new(n),
        }
    }

    /// Begins at `(t, y)`: rate, first step, nothing known of the past.
    fn begin<P: Ode + ?Sized>(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop> {
        self.t0 = t;
        self.advanced = false;
        self.y0.copy_from_slice(y);
        self.weights.see(t, y);
        self.control.reset();
        self.noise.forget();
        (self.calm, self.first) = (false, true);
        (self.beyond_edge, self.within_edge) = (0, 0);
        self.stats.evaluations += 1;
        let stop = |reason| Stop { reason, t, h: 0.0 };
        problem
            .rate(t, &self.y0, &mut self.f0)
            .map_err(|f| stop(Reason::Evaluation(f)))?;
        if !worst(self.f0.iter().copied()).is_finite() {
            return Err(stop(Reason::NotFinite(worst_index(
                self.f0.iter().copied(),
            ))));
        }
        let starter = control::Starter {
            order: ORDER,
            options: &self.options,
            weights: &self.weights,
        };
        self.h_next = starter.first_step(
            t,
            &self.y0,
            &self.f0,
            &mut self.stage,
            &mut self.f1,
            |t, y, f| {
                self.stats.evaluations += 1;
                problem.rate(t, y, f)
            },
        );
        Ok(())
    }

    /// Evaluates the stages (1) after the first; takes note of those with a weight where there is
    /// room for them.
    fn evaluate_stages<P: Ode + ?Sized>(&mut self, problem: &mut P, h: f64) -> Result<(), Failure> {
        let mut evaluations = 0;
        let mut weighted = std::mem::take(&mut self.weighted);
        let mut places = weighted.chunks_exact_mut(self.y0.len().max(1));
        let evaluated = self.each_stage(h, |t, stage, k| {
            evaluations += 1;
            if evaluations > UNWEIGHTED_STAGES
                && let Some(place) = places.next()
            {
                place.copy_from_slice(stage);
            }
            problem.rate(t, stage, k)
        });
        self.weighted = weighted;
        self.stats.evaluations += evaluations;
        evaluated
    }

    /// Visits the stages (1) after the first: time, argument, and its rate   (n).
    #[inline(always)]
    fn each_stage(
        &mut self,
        h: f64,
        mut visit: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let (t, n) = (self.t0, self.y0.len());
        let (y, stage) = (&self.y0[..n], &mut self.stage);
        let k1 = &self.f0;
        let [k2, k3, k4, k5, k6, k7, k8, k9, k10, k11, k12] = &mut self.k;
        macro_rules! stage {
            ($out:ident at $c:literal: $($row:tt)*) => {
                row!(stage = y + h * ($($row)*));
                visit(t + $c * h, &stage[..n], &mut $out[..n])?;
            };
        }
        stage!(k2 at 0.05260015195876773: k1 0.05260015195876773);
        stage!(k3 at 0.0789002279381516: k1 0.0197250569845379, k2 0.0591751709536137);
        stage!(k4 at 0.1183503419072274: k1 0.02958758547680685, k3 0.08876275643042054);
        stage!(k5 at 0.2816496580927726: k1 0.2413651341592667, k3 -0.8845494793282861, k4 0.924834003261792);
        stage!(k6 at 0.3333333333333333: k1 0.037037037037037035, k4 0.17082860872947386, k5 0.12546768756682242);
        stage!(k7 at 0.25: k1 0.037109375, k4 0.17025221101954405, k5 0.06021653898045596, k6 -0.017578125);
        stage!(k8 at 0.3076923076923077: k1 0.03709200011850479, k4 0.17038392571223998, k5 0.10726203044637328,
            k6 -0.015319437748624402, k7 0.008273789163814023);
        stage!(k9 at 0.6512820512820513: k1 0.6241109587160757, k4 -3.3608926294469414, k5 -0.868219346841726,
            k6 27.59209969944671, k7 20.154067550477894, k8 -43.48988418106996);
        stage!(k10 at 0.6: k1 0.47766253643826434, k4 -2.4881146199716677, k5 -0.590290826836843, k6 21.230051448181193,
            k7 15.279233632882423, k8 -33.28821096898486, k9 -0.020331201708508627);
        stage!(k11 at 0.8571428571428571: k1 -0.9371424300859873, k4 5.186372428844064, k5 1.0914373489967295,
            k6 -8.149787010746927, k7 -18.52006565999696, k8 22.739487099350505, k9 2.4936055526796523, k10 -3.0467644718982196);
        stage!(k12 at 1.0: k1 2.273310147516538, k4 -10.53449546673725, k5 -2.0008720582248625, k6 -17.9589318631188,
            k7 27.94888452941996, k8 -2.8589982771350235, k9 -8.87285693353063, k10 12.360567175794303, k11 0.6433927460157636);

        Ok(())
    }

    /// Computes the new point (2) before its projection; returns ‖e₅‖ and ‖e₃‖ of (3), or `None`
    /// when a number is not finite.
    fn combine(&mut self, h: f64) -> Option<[f64; 2]> {
        let n = self.y0.len();
        let y = &self.y0[..n];
        let [_, _, _, _, k6, k7, k8, k9, k10, k11, k12] = &self.k;
        let (k1, k6, k7, k8) = (&self.f0[..n], &k6[..n], &k7[..n], &k8[..n]);
        let (k9, k10, k11, k12) = (&k9[..n], &k10[..n], &k11[..n], &k12[..n]);
        let most = &self.weights.most()[..n];
        let magnitude = &self.weights.magnitude()[..n];
        let origin = &self.weights.origin()[..n];
        let y1 = &mut self.y1[..n];
        let (mut worst5, mut worst3, mut sum) = (0.0, 0.0, 0.0);
        for i in 0..n {
            let slope = B[0] * k1[i]
                + B[1] * k6[i]
                + B[2] * k7[i]
                + B[3] * k8[i]
                + B[4] * k9[i]
                + B[5] * k10[i]
                + B[6] * k11[i]
                + B[7] * k12[i];
            let e5 = e5_slope([k1[i], k6[i], k7[i], k8[i], k9[i], k10[i], k11[i], k12[i]]);
            let e3 = slope
                - 0.2440944881889764 * k1[i]
                - 0.7338466882816118 * k9[i]
                - 0.022058823529411766 * k12[i];
            y1[i] = y[i] + h * slope;
            let size = (y1[i] - origin[i]).abs();
            let size = if size < most[i] { size } else { most[i] };
            let w = h / if size > magnitude[i] {
                size
            } else {
                magnitude[i]
            };
            let (e5, e3) = ((e5 * w).abs(), (e3 * w).abs());
            sum += e3 + e5;
            worst5 = if e5 > worst5 { e5 } else { worst5 };
            worst3 = if e3 > worst3 { e3 } else { worst3 };
        }
        f64::is_finite(sum).then_some([worst5, worst3])
    }

    /// Computes stages, new point and error of a step of length `h`; returns the error as a part of
    /// that permitted, less what projection removes and rounding explains, or NaN.
    fn attempt<P: Ode + ?Sized>(&mut self, problem: &mut P, h: f64) -> Result<f64, Failure> {
        self.evaluate_stages(problem, h)?;
        let Some([worst5, worst3]) = self.combine(h) else {
            return Ok(f64::NAN);
        };
        let scale = ERROR_SCALE / self.weights.tolerance();
        let mut error = scale * blended(worst5, worst3);
        self.noisy = false;
        if error > 1.0 {
            let scale = ERROR_SCALE / self.weights.tolerance().max(INVARIANT_NOISE);
            error = error.min(scale * self.filtered(problem, self.t0 + h, h));
        }
        let alike = worst3 < ALIKE_RATIO * worst5 || self.noise.is_proven();
        let suspect = error > 1.0 || error > SUSPECT_ERROR && alike;
        let largest = self.noise.largest(alike, self.weights.tolerance());
        if suspect && error < scale * largest {
            // the rest is measured against rounding, where that is more than the request
            let explained =
                self.rounding(problem, (h, alike)) * ERROR_SCALE / self.weights.tolerance();
            self.noisy = error > 1.0 && explained > 1.0;
            error = (error - explained).max(REMAINING_SHARE * error) / explained.max(1.0);
        }
        Ok(error)
    }

    /// Returns the relative error estimate that rounding explains, for a step of some length whose
    /// estimates are alike or not.
    fn rounding<P: Ode + ?Sized>(&mut self, problem: &mut P, step: (f64, bool)) -> f64 {
        // k₂ and k₃ have done their work
        let [k2, k3, ..] = &mut self.k;
        let at = Probed {
            t: self.t0,
            y: &self.y0,
            f: &self.f0,
            weights: &self.weights,
        };
        self.noise
            .of_step(problem, at, step, [k2, k3], &mut self.stats)
    }

    /// Returns the error (3) of the step just attempted without the part that projection removes;
    /// infinite where that changes nothing.
    fn filtered<P: Ode + ?Sized>(&mut self, problem: &mut P, t1: f64, h: f64) -> f64 {
        let n = self.y0.len();
        let k1 = &self.f0;
        // k₂ and k₃ have done their work
        let [k2, k3, _, _, k6, k7, k8, k9, k10, k11, k12] = &mut self.k;
        let (e5, e3) = (&mut k2[..n], &mut k3[..n]);
        for i in 0..n {
            e5[i] = h * e5_slope([k1[i], k6[i], k7[i], k8[i], k9[i], k10[i], k11[i], k12[i]]);
            e3[i] = self.y1[i] - self.y0[i] - h * b_hat_slope(k1[i], k9[i], k12[i]);
        }
        let y1 = &self.y1[..n];
        if !problem.filter_errors(t1, y1, [&mut *e5, &mut *e3]) {
            return f64::INFINITY;
        }
        let (magnitude, most) = (self.weights.magnitude(), self.weights.most());
        let origin = self.weights.origin();
        let size = |e: &[f64]| {
            let relative = |(i, e): (usize, &f64)| {
                let size = (y1[i] - origin[i]).abs().min(most[i]);
                (e / size.max(magnitude[i])).abs()
            };
            worst(e.iter().enumerate().map(relative))
        };
        blended(size(e5), size(e3))
    }

    /// Attempts a step of length `h` to `t1` and returns its error; on success (t1, y1, f1) is the
    /// state.
    fn advance<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        h: f64,
        t1: f64,
    ) -> Result<f64, Trouble> {
        let evaluation = |f: Failure| Trouble::Reason(Reason::Evaluation(f), f.recoverable);
        let error = self.attempt(problem, h).map_err(evaluation)?;
        let better = problem.place_step(self.t0, h, STAGE_GAP, false);
        if let Some(better) = better.filter(|_| self.placed < super::MOST_PLACINGS) {
            return Err(Trouble::Place(better));
        }
        if error.is_nan() {
            // the first number that is not finite in the order of evaluation: the others follow
            // from it
            let bad = |row: &Vec<f64>| row.iter().position(|x| !x.is_finite());
            let index = self.k.iter().find_map(bad).or_else(|| bad(&self.y1));
            return Err(Trouble::Reason(Reason::NotFinite(index.unwrap_or(0)), true));
        }
        if error > 1.0 {
            return Err(Trouble::Error(error));
        }
        problem
            .project(t1, &mut self.y1)
            .map_err(|f| Trouble::Reason(Reason::Projection(f), f.recoverable))?;
        self.stats.evaluations += 1;
        problem
            .rate(t1, &self.y1, &mut self.f1)
            .map_err(evaluation)?;
        if !worst(self.f1.iter().copied()).is_finite() {
            return Err(Trouble::Reason(
                Reason::NotFinite(worst_index(self.f1.iter().copied())),
                true,
            ));
        }
        Ok(error)
    }

    /// Accepts the step to `t1` with its error: proposes the next one and notes magnitudes.
    fn accept(&mut self, error: f64, guessed: bool, t1: f64) {
        let factor = self.control.accepted(error, self.calm, guessed);
        // a step that the limit cut short says little against the one that was proposed
        self.h_next = if self.h < self.h_next {
            (self.h * factor).max(self.h_next)
        } else {
            self.h * factor
        };
        (self.calm, self.first) = (false, false);
        self.placed = 0;
        self.t1 = t1;
        self.advanced = true;
        self.weights.see(t1, &self.y1);
        self.watch_stiffness();
        if self.noisy {
            self.noise.in_vain();
        }
        self.stats.below_rounding += usize::from(self.noisy || self.weights.is_raised());
    }

    /// Counts the steps in which `h |λ|` lies beyond the edge of the stability region, and those
    /// that stability holds short.
    fn watch_stiffness(&mut self) {
        let k12 = &self.k[10];
        let (mut rates, mut states) = (0.0, 0.0);
        for i in 0..self.y1.len() {
            let m = 1.0 / self.weights.magnitude()[i];
            let (df, dy) = ((self.f1[i] - k12[i]) * m, (self.y1[i] - self.stage[i]) * m);
            rates += df * df;
            states += dy * dy;
        }
        self.h_lambda = if states > 0.0 {
            self.h * (rates / states).sqrt()
        } else {
            0.0
        };
        if self.h_lambda > STABILITY_EDGE {
            self.beyond_edge += 1;
            self.within_edge = 0;
            self.stats.at_edge += 1;
        } else {
            self.within_edge += 1;
            if self.within_edge >= CALM_STEPS {
                self.beyond_edge = 0;
            }
        }
        let fine = self.weights.tolerance() < FINE_REQUEST;
        let limited =
            self.beyond_edge >= STIFF_STEPS || fine && self.h_lambda > FINE_STABILITY_EDGE;
        self.stats.stability_limited += usize::from(limited);
    }

    /// Returns the number of evaluations in a step.
    pub fn stages() -> usize {
        UNWEIGHTED_STAGES + B.len()
    }

    /// Returns the unknown with the largest error estimate e₃.
    fn worst_unknown(&self) -> usize {
        let [.., k9, _, _, k12] = &self.k;
        let e = self
            .y1
            .iter()
            .zip(&self.y0)
            .zip(self.weights.magnitude())
            .zip(self.f0.iter().zip(k9).zip(k12));
        let h = self.h;
        worst_index(e.map(|(((y1, y0), m), ((k1, k9), k12))| {
            ((y1 - y0) - h * b_hat_slope(*k1, *k9, *k12)) / m
        }))
    }
}

impl<P: Ode + ?Sized> Method<P> for Dop853 {
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
        self.interpolant.forget();
        let mut attempts = Attempts::new(self.t0, t_limit, &self.options);
        loop {
            let proposed = self.h_next.min(self.options.h_max);
            let too_fast = || control::too_fast(&self.f0, &self.weights);
            let (h, t1) = attempts.next(proposed, &self.options, &self.stats, too_fast)?;
            self.h = h;
            let rejection = match self.advance(problem, h, t1) {
                Ok(error) => {
                    let guessed = self.first && attempts.rejected() == 0;
                    self.accept(error, guessed, t1);
                    return Ok(attempts.accepted(h, t1, ORDER, &mut self.stats));
                }
                Err(Trouble::Place(better)) => {
                    self.h_next = better;
                    self.placed += 1;
                    attempts.repeat(&mut self.stats);
                    continue;
                }
                Err(Trouble::Error(error)) => Rejection {
                    reason: Reason::ErrorTest(self.worst_unknown()),
                    recoverable: true,
                    factor: self.control.rejected(error),
                },
                Err(Trouble::Reason(reason, recoverable)) => Rejection {
                    reason,
                    recoverable,
                    factor: 0.25,
                },
            };
            attempts.reject(rejection, h, &mut self.stats)?;
            self.h_next = h * rejection.factor;
            self.calm = true;
        }
    }

    fn undo(&mut self) {
        if self.advanced {
            self.advanced = false;
            self.h_next = self.h;
            self.interpolant.forget();
        }
    }

    fn interpolate(&mut self, problem: &mut P, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        if t == self.t1 && self.advanced {
            y.copy_from_slice(&self.y1);
            return Ok(());
        }
        if t == self.t0 || !self.advanced {
            y.copy_from_slice(&self.y0);
            return Ok(());
        }
        self.within_step(problem, t, y)
    }

    fn middle(&self, y: &mut [f64]) -> bool {
        self.middle_of_step(y)
    }

    fn interpolate_rate(
        &mut self,
        problem: &mut P,
        t: f64,
        ydot: &mut [f64],
    ) -> Result<(), Failure> {
        if !self.advanced {
            ydot.copy_from_slice(&self.f0);
            return Ok(());
        }
        self.rate_within_step(problem, t, ydot)
    }

    fn quadrature(
        &mut self,
        problem: &mut P,
        _ends: [f64; 2],
        _work: &mut [Vec<f64>; 2],
        visit: &mut dyn FnMut(&mut P, Node<'_>),
    ) -> Result<(), Failure> {
        if !self.advanced {
            return Ok(());
        }
        let h = self.h;
        visit(
            problem,
            Node {
                weight: B[0] * h,
                t: self.t0,
                y: &self.y0,
                ydot: &self.f0,
            },
        );
        let n = self.y0.len();
        if self.weighted.is_empty() {
            let mut weighted = Vec::with_capacity(WEIGHTED_AT.len() * n);
            let mut stages = 0;
            self.each_stage(h, |_, y, _| {
                stages += 1;
                if stages > UNWEIGHTED_STAGES {
                    weighted.extend_from_slice(y);
                }
                Ok(())
            })?;
            self.weighted = weighted;
        }
        let rates = &self.k[UNWEIGHTED_STAGES..];
        let stages = self.weighted.chunks_exact(n.max(1)).zip(rates);
        for ((b, c), (y, ydot)) in B[1..].iter().zip(WEIGHTED_AT).zip(stages) {
            let (weight, t) = (b * h, self.t0 + c * h);
            visit(problem, Node { weight, t, y, ydot });
        }
        Ok(())
    }

    fn leave(&mut self) -> Option<Memory> {
        let (step, radau) = (self.h_next, None);
        self.advanced.then_some(Memory { step, radau })
    }

    fn go_on(&mut self, memory: &Memory) {
        self.h_next = memory.step;
    }

    fn weights(&self) -> &Weights {
        &self.weights
    }

    fn take_weights(&mut self, weights: Weights) {
        self.weights = weights;
    }

    fn noise(&self) -> Option<&Noise> {
        Some(&self.noise)
    }

    fn take_noise(&mut self, noise: Noise) {
        self.noise = noise;
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

    fn stiff(&self) -> bool {
        self.beyond_edge >= STIFF_STEPS
    }
}
