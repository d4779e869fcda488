//! The collocation equations of one step of Radau IIA, and the Newton iteration that solves them.
//!
//! ```text
//! Zᵢ = h Σ aᵢⱼ f(t + cⱼ h, y + Zⱼ)          i, j = 1 … 3,   c = (4−√6)/10, (4+√6)/10, 1       (1)
//! A⁻¹ = T diag(γ̂, [α̂ −β̂; β̂ α̂]) T⁻¹,   W = T⁻¹ Z                                           (2)
//!     (γ̂/h − J) ΔW₁ = …            (α̂/h + i β̂/h − J)(ΔW₂ + i ΔW₃) = …
//! ```
//!
//! One iteration solves one real and one complex system of the size of the problem instead of one
//! of three times that size.
//!
//! *Convergence*: the ratio Θ of successive corrections is measured. The iteration stops when the
//! next correction is predicted to be small against the permitted error, and is given up as soon
//! as Θ predicts that the permitted number of corrections will not suffice.
//!
//! *Rounding*: the rates of stiff forces are as exact as positions are rounded, times the
//! stiffness. An iteration that would be given up has ended where its corrections are no more than
//! that makes of them, and are permitted errors: a shorter step has the same rounding.
//!
//! ```text
//! ρ = ε |J| |y|        ‖Σ|T⁻¹| (γ − J)⁻¹ ρ‖                                           (4)
//! ```
//!
//! *Hidden residuals*: where J is stiff, corrections are small however large the residual is. (A
//! mass that a steep friction held: J is that of sticking, and the spring pulls already more than
//! the friction can. The residual is the missing acceleration, and corrections are 10⁻⁶ of it.) So
//! a residual that would be too large without J must be seen to fall in each of its unknowns; where
//! it does not, J is that of another place.
//!
//! Source: Hairer & Wanner, Solving ODEs II, IV.8.

use super::Systems;
use crate::numeric::{Failure, Ode, Stats};
use crate::scalar::Scalar;

/// √6
pub(super) const SQRT6: f64 = 2.449489742783178;
/// Nodes c of (1), as parts of the step.
pub(super) const C: [f64; 3] = [(4.0 - SQRT6) / 10.0, (4.0 + SQRT6) / 10.0, 1.0];
/// γ̂ of (2).
pub(super) const GAMMA: f64 = 3.637834252744496;
/// α̂ of (2).
pub(super) const ALPHA: f64 = 2.6810828736277523;
/// β̂ of (2).
pub(super) const BETA: f64 = 3.0504301992474105;
/// T of (2); its last row is (T₃₁, 1, 0).
const T: [[f64; 3]; 3] = [
    [
        0.09123239487089295,
        -0.1412552950209542,
        -0.030029194105147424,
    ],
    [0.241717932707107, 0.20412935229379994, 0.3829421127572619],
    [0.966048182615093, 1.0, 0.0],
];
/// T⁻¹ of (2).
const TI: [[f64; 3]; 3] = [
    [4.325579890063155, 0.33919925181580984, 0.5417705399358749],
    [
        -4.178718591551905,
        -0.32768282076106237,
        0.47662355450055044,
    ],
    [-0.5028726349457868, 2.571926949855605, -0.5960392048282249],
];

/// Θ up to which the Jacobian is kept for the next step.
pub(super) const KEEP_JACOBIAN_RATE: f64 = 0.02;
/// Θ from which the iteration counts as divergent.
const DIVERGENT_RATE: f64 = 0.99;

/// Ratio of two successive residuals of an unknown above which J does not explain them.
pub(super) const UNEXPLAINED: f64 = 0.5;
/// Ratio of a residual without J to its correction above which J hides it: what a smaller one hides
/// of an iteration that has converged is no more than the permitted error.
const HIDING: f64 = 30.0;
/// Size of a correction that may be rounding, relative to the magnitude of its unknown.
pub(super) const ROUNDING: f64 = 1e-13;

/// Values and slopes at `theta` of the cubics that are one at a node, and zero at the others and at
/// the beginning of the step.
pub(super) const fn cubic_weights(theta: f64) -> [[f64; 2]; 3] {
    let nodes = [0.0, C[0], C[1], C[2]];
    let mut weights = [[0.0; 2]; 3];
    let mut i = 1;
    while i < 4 {
        let (mut value, mut slope, mut j) = (1.0, 0.0, 0);
        while j < 4 {
            if j != i {
                let width = nodes[i] - nodes[j];
                slope = (slope * (theta - nodes[j]) + value) / width;
                value *= (theta - nodes[j]) / width;
            }
            j += 1;
        }
        weights[i - 1] = [value, slope];
        i += 1;
    }
    weights
}

/// The unknowns of (1), as they are and transformed, and room for the residual.
#[derive(Clone, Debug)]
pub(super) struct Stages {
    /// Z of (1)   (3 × n)
    pub z: [Vec<f64>; 3],
    /// W of (2)   (3 × n)
    w: [Vec<f64>; 3],
    /// rates at the stages, then the residual, then the corrections ΔW   (3 × n)
    pub g: [Vec<f64>; 3],
    /// argument of a rate   (n)
    pub argument: Vec<f64>,
    /// sizes of the first residual, and of the last   (n)
    residual: [Vec<f64>; 2],
}

/// A correction of the stages, against the permitted errors.
struct Correction {
    /// the size of the largest
    size: f64,
    /// whether J makes an unknown's correction small whose residual is not
    is_hidden: bool,
    /// whether such a residual has not become smaller
    is_unexplained: bool,
}

/// Convergence of the iteration: its limits, and the rate measured last.
#[derive(Clone, Debug)]
pub(super) struct Convergence {
    /// permitted size of the next correction, as a part of the permitted error
    tolerance: f64,
    /// corrections permitted in a step
    pub allowed: usize,
    /// Θ/(1 − Θ) of the last iteration that converged
    rate_factor: f64,
    /// Θ of the last iteration
    pub theta: f64,
    /// size of the last correction, over the permitted error
    size: f64,
}

/// The beginning of a step and its length.
#[derive(Clone, Copy)]
pub(super) struct Begin<'a> {
    /// beginning of the step, in s
    pub t: f64,
    /// solution there   (n)
    pub y: &'a [f64],
    /// length of the step, in s
    pub h: f64,
}

/// The end of a Newton iteration.
pub(super) enum Newton {
    /// converged after so many corrections
    Converged(usize),
    /// given up: the step should be multiplied by this factor
    Slow(f64),
    /// the problem has no rate at a stage
    Failed(Failure),
    /// a rate or correction with this index is not a number
    NotFinite(usize),
}

/// Sizes of the corrections made so far in one iteration.
struct Progress {
    /// Θ/(1 − Θ), as known so far
    rate_factor: f64,
    /// size of the correction before
    previous_size: f64,
    /// ratio of the two corrections before
    previous_ratio: f64,
}

impl Stages {
    /// Room for `n` unknowns; all stages zero.
    pub fn new(n: usize) -> Self {
        let three = || std::array::from_fn(|_| vec![0.0; n]);
        Stages {
            z: three(),
            w: three(),
            g: three(),
            argument: vec![0.0; n],
            residual: std::array::from_fn(|_| vec![0.0; n]),
        }
    }

    /// Sets all stages to zero.
    pub fn clear(&mut self) {
        self.z.iter_mut().for_each(|z| z.fill(0.0));
        self.w.iter_mut().for_each(|w| w.fill(0.0));
    }

    /// Sets stage values of unknown `i`, and their transforms.
    #[inline]
    pub fn set(&mut self, i: usize, [z1, z2, z3]: [f64; 3]) {
        for (k, z) in [z1, z2, z3].into_iter().enumerate() {
            self.z[k][i] = z;
            self.w[k][i] = TI[k][0] * z1 + TI[k][1] * z2 + TI[k][2] * z3;
        }
    }

    /// Evaluates the rates at the stages into `g`.
    fn evaluate<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        begin: Begin,
        stats: &mut Stats,
    ) -> Result<(), Newton> {
        for (k, z) in self.z.iter().enumerate() {
            for (argument, (y, z)) in self.argument.iter_mut().zip(begin.y.iter().zip(z)) {
                *argument = y + z;
            }
            stats.evaluations += 1;
            problem
                .rate(begin.t + C[k] * begin.h, &self.argument, &mut self.g[k])
                .map_err(Newton::Failed)?;
        }
        let mut rates = self.g.iter();
        match rates.find_map(|g| g.iter().position(|x| !x.is_finite())) {
            Some(index) => Err(Newton::NotFinite(index)),
            None => Ok(()),
        }
    }

    /// Replaces the rates in `g` by the transformed residual of (1).
    fn transform_residual(&mut self, h: f64) {
        let n = self.argument.len();
        let (gamma, alpha, beta) = (GAMMA / h, ALPHA / h, BETA / h);
        let ([g1, g2, g3], [w1, w2, w3]) = (&mut self.g, &self.w);
        let (g1, g2, g3) = (&mut g1[..n], &mut g2[..n], &mut g3[..n]);
        let (w1, w2, w3) = (&w1[..n], &w2[..n], &w3[..n]);
        let last = &mut self.residual[1][..n];
        for i in 0..n {
            let (f1, f2, f3) = (g1[i], g2[i], g3[i]);
            g1[i] = TI[0][0] * f1 + TI[0][1] * f2 + TI[0][2] * f3 - gamma * w1[i];
            g2[i] = TI[1][0] * f1 + TI[1][1] * f2 + TI[1][2] * f3 - alpha * w2[i] + beta * w3[i];
            g3[i] = TI[2][0] * f1 + TI[2][1] * f2 + TI[2][2] * f3 - alpha * w3[i] - beta * w2[i];
            last[i] = g1[i].abs() + g2[i].abs() + g3[i].abs();
        }
    }

    /// Keeps the sizes of the residual as those of the first.
    fn keep_residual(&mut self) {
        let [first, last] = &mut self.residual;
        first.copy_from_slice(last);
    }

    /// Returns how large corrections may be that are made of rounding alone (4), against the
    /// permitted errors. `rounding`: as for [`Stages::correct`].
    fn rounding(&mut self, systems: &mut Systems, (scale, rounding): (&[f64], f64)) -> f64 {
        let (magnitudes, rates) = (&mut self.argument, &mut self.residual[0]);
        for (m, scale) in magnitudes.iter_mut().zip(scale) {
            *m = f64::EPSILON * rounding / (ROUNDING * scale);
        }
        systems.times_sizes(magnitudes, rates);
        systems.solve(rates);
        let sizes = rates.iter().zip(scale).map(|(x, scale)| (x * scale).abs());
        let all: f64 = TI.iter().flatten().map(|x| x.abs()).sum();
        all * sizes.fold(0.0, f64::max)
    }

    /// Adds the corrections in `g` to the stages; `h`: length of the step, in s; `rounding`: size
    /// of a correction that may be rounding, scaled.
    fn correct(&mut self, scale: &[f64], (h, rounding): (f64, f64)) -> Result<Correction, Newton> {
        let n = self.argument.len();
        let [g1, g2, g3] = &self.g;
        let ([w1, w2, w3], [z1, z2, z3]) = (&mut self.w, &mut self.z);
        let (g1, g2, g3) = (&g1[..n], &g2[..n], &g3[..n]);
        let (w1, w2, w3) = (&mut w1[..n], &mut w2[..n], &mut w3[..n]);
        let (z1, z2, z3) = (&mut z1[..n], &mut z2[..n], &mut z3[..n]);
        let [first, last] = &self.residual;
        let (scale, first, last) = (&scale[..n], &first[..n], &last[..n]);
        let (mut size, mut sum) = (0.0, 0.0);
        let (mut is_hidden, mut is_unexplained) = (false, false);
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
            let unfiltered = h / GAMMA * last[i] * scale[i];
            let hides = unfiltered > 1.0_f64.max(HIDING * change) && change > rounding;
            is_hidden |= hides;
            is_unexplained |= hides && last[i] > UNEXPLAINED * first[i];
        }
        if f64::is_finite(sum) {
            Ok(Correction {
                size,
                is_hidden,
                is_unexplained,
            })
        } else {
            let index = g1.iter().position(|x| !x.is_finite());
            Err(Newton::NotFinite(index.unwrap_or(0)))
        }
    }
}

impl Convergence {
    /// Limits for a permitted `error` of a step and at most `allowed` corrections.
    pub fn new(error: f64, allowed: usize) -> Self {
        Convergence {
            tolerance: (10.0 * f64::EPSILON / error).max(error.sqrt().min(0.03)),
            allowed: allowed.max(3),
            rate_factor: 1.0,
            theta: KEEP_JACOBIAN_RATE,
            size: 0.0,
        }
    }

    /// Returns whether an iteration that has ended after so many corrections trusted in the rate of
    /// the step before: its only correction is larger than the permitted error.
    pub fn is_untried(&self, iterations: usize) -> bool {
        iterations == 1 && self.size > 1.0
    }

    /// Forgets the rates measured so far.
    pub fn reset(&mut self) {
        (self.rate_factor, self.theta) = (1.0, KEEP_JACOBIAN_RATE);
    }

    /// Decides after a correction of the given size: whether the iteration has ended, and how.
    fn judge(&mut self, progress: &mut Progress, iteration: usize, size: f64) -> Option<Newton> {
        self.size = size;
        if iteration > 0 && size > 0.0 {
            // the rate of convergence; the geometric mean of two ratios once there are two
            let ratio = size / progress.previous_size;
            self.theta = if iteration == 1 {
                ratio
            } else {
                f64::sqrt(ratio * progress.previous_ratio)
            };
            progress.previous_ratio = ratio;
            // the correction that would be left after the last one permitted
            progress.rate_factor = self.theta / (1.0 - self.theta);
            let left = (self.allowed - 1 - iteration) as f64;
            let predicted =
                progress.rate_factor * size * Scalar::powf(self.theta, left) / self.tolerance;
            let diverges = self.theta >= DIVERGENT_RATE;
            if diverges || predicted >= 1.0 && left > 0.0 {
                let excess = predicted.clamp(1e-4, 20.0);
                return Some(Newton::Slow(match diverges {
                    true => 0.5,
                    false => 0.8 * Scalar::powf(excess, -1.0 / (4.0 + left)),
                }));
            }
        }
        progress.previous_size = size.max(f64::MIN_POSITIVE);
        if progress.rate_factor * size > self.tolerance {
            return None;
        }
        self.rate_factor = progress.rate_factor;
        Some(Newton::Converged(iteration + 1))
    }
}

/// Solves (1) by (2), from the guess in `stages`; `systems` hold the factors for this step.
///
/// `scale`: 1/(permitted error) of each unknown   (n); `rounding`: size of a correction that may be
/// rounding, scaled; infinite where residuals are rounding themselves.
pub(super) fn solve_collocation_system<P: Ode + ?Sized>(
    problem: &mut P,
    begin: Begin,
    (scale, rounding): (&[f64], f64),
    stages: &mut Stages,
    systems: &mut Systems,
    convergence: &mut Convergence,
    stats: &mut Stats,
) -> Newton {
    let mut progress = Progress {
        rate_factor: Scalar::powf(convergence.rate_factor.max(f64::EPSILON), 0.8),
        previous_size: 0.0,
        previous_ratio: 0.0,
    };
    convergence.theta = KEEP_JACOBIAN_RATE;
    for iteration in 0..convergence.allowed {
        if let Err(end) = stages.evaluate(problem, begin, stats) {
            return end;
        }
        stages.transform_residual(begin.h);
        if iteration == 0 {
            stages.keep_residual();
        }
        let [g1, g2, g3] = &mut stages.g;
        systems.solve(g1);
        systems.solve_complex(g2, g3);
        stats.newton_iterations += 1;
        stats.algebra += systems.operations()[1];
        let correction = match stages.correct(scale, (begin.h, rounding)) {
            Ok(correction) => correction,
            Err(end) => return end,
        };
        match convergence.judge(&mut progress, iteration, correction.size) {
            Some(Newton::Converged(1)) if correction.is_hidden => (),
            Some(Newton::Converged(2..)) if correction.is_unexplained => {
                return Newton::Slow(0.5);
            }
            Some(Newton::Slow(factor)) => {
                let (size, rounding) = (correction.size, (scale, rounding));
                return match size <= 1.0 && size <= stages.rounding(systems, rounding) {
                    true => Newton::Converged(iteration + 1),
                    false => Newton::Slow(factor),
                };
            }
            Some(end) => return end,
            None => (),
        }
    }
    Newton::Slow(0.5)
}

/// The polynomial through the stages of an accepted step and its beginning.
///
/// ```text
/// y(t + h + s h) = y₁ + s (p₁ + (s + 1 − c₂) (p₂ + (s + 1 − c₁) p₃))        −1 ≤ s ≤ 0      (3)
/// ```
#[derive(Clone, Debug)]
pub(super) struct Polynomial {
    /// divided differences p₁, p₂, p₃   (3 × n)
    p: [Vec<f64>; 3],
    /// end of the step it describes, in s
    end: f64,
    /// length of that step, in s; 0: none yet
    h: f64,
}

impl Polynomial {
    /// Room for `n` unknowns.
    pub fn new(n: usize) -> Self {
        Polynomial {
            p: std::array::from_fn(|_| vec![0.0; n]),
            end: 0.0,
            h: 0.0,
        }
    }

    /// Forgets the step it described.
    pub fn forget(&mut self) {
        self.h = 0.0;
    }

    /// Takes the stages of the step of length `h` that ends at `end`.
    pub fn fit(&mut self, z: &[Vec<f64>; 3], end: f64, h: f64) {
        let [p1, p2, p3] = &mut self.p;
        for i in 0..p1.len() {
            let (z1, z2, z3) = (z[0][i], z[1][i], z[2][i]);
            let d12 = (z1 - z2) / (C[0] - C[1]);
            let d23 = (z2 - z3) / (C[1] - 1.0);
            let d01 = (d12 - z1 / C[0]) / C[1];
            p1[i] = d23;
            p2[i] = (d12 - d23) / (C[0] - 1.0);
            p3[i] = p2[i] - d01;
        }
        (self.end, self.h) = (end, h);
    }

    /// Spreads what projection changed at the end, `to − from`, over the step, so that the
    /// polynomial still begins at y₀.
    pub fn spread(&mut self, to: &[f64], from: &[f64]) {
        for (p, (to, from)) in self.p[0].iter_mut().zip(to.iter().zip(from)) {
            *p += to - from;
        }
    }

    /// Its value less y₁, for unknown `i` at `s` of (3).
    #[inline]
    pub fn rise(&self, i: usize, s: f64) -> f64 {
        let [p1, p2, p3] = &self.p;
        s * (p1[i] + (s - (C[1] - 1.0)) * (p2[i] + (s - (C[0] - 1.0)) * p3[i]))
    }

    /// Its derivative with respect to s, for unknown `i` at `s` of (3).
    #[inline]
    pub fn slope(&self, i: usize, s: f64) -> f64 {
        let (a, b) = (s - (C[1] - 1.0), s - (C[0] - 1.0));
        let [p1, p2, p3] = &self.p;
        p1[i] + (a + s) * p2[i] + (a * b + s * b + s * a) * p3[i]
    }

    /// Guesses the stages of the next step, of length `h` from `t`, by extrapolation.
    pub fn extrapolate(&self, t: f64, h: f64, stages: &mut Stages) {
        if self.h == 0.0 {
            return stages.clear();
        }
        let s = |c: f64| (t + c * h - self.end) / self.h;
        let (s0, s1, s2, s3) = (s(0.0), s(C[0]), s(C[1]), s(C[2]));
        for i in 0..self.p[0].len() {
            let begin = self.rise(i, s0);
            let rise = |s| self.rise(i, s) - begin;
            stages.set(i, [rise(s1), rise(s2), rise(s3)]);
        }
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
