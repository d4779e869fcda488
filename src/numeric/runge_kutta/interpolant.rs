//! The solution within a step of DOP853: the interpolant (4), or, where fast modes spoil that, a
//! step of its own from the same beginning.
//!
//! ```text
//! y(t + θh) = y + θ h Σ bᵢ k′ᵢ          k′ᵢ: the stages of a step of length θ h
//! ```
//!
//! Such a step is as exact as the one that was accepted, and it changes nothing of what follows:
//! the steps of a run do not depend on where a value is wanted.

#![allow(clippy::needless_range_loop)] // many arrays at one index read best that way

use super::{B, Dop853};
use crate::numeric::control::worst;
use crate::numeric::{Failure, Ode};

/// `h |λ|` from which on the interpolant is compared with the rate.
const CHECKED_EDGE: f64 = 2.0;
/// Error of the interpolant there, at most, in units of that permitted in a step.
const MISFIT_TOLERANCE: f64 = 1.0;

/// The solution within the last step, as far as it has been asked for.
#[derive(Clone, Debug)]
pub(super) struct Interpolant {
    /// how good `r` is
    fit: Fit,
    /// r₁ … r₇ of (4)   (7 × n)
    r: [Vec<f64>; 7],
    /// its last stage; the others take the places of k₂ and k₃   (n)
    k16: Vec<f64>,
    /// time and solution of the last step of its own   (n)
    t: f64,
    y: Vec<f64>,
    /// k₂ … k₁₂ of that step   (11 × n, once there has been one)
    k: [Vec<f64>; 11],
}

/// The quality of the interpolant (4) of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fit {
    /// it has not been asked for
    Unknown,
    /// its error is like that of the step
    Good,
    /// fast modes spoil it
    Bad,
}

impl Interpolant {
    /// Room for `n` unknowns.
    pub fn new(n: usize) -> Self {
        Self {
            fit: Fit::Unknown,
            r: std::array::from_fn(|_| vec![0.0; n]),
            k16: vec![0.0; n],
            t: f64::NAN,
            y: vec![0.0; n],
            k: std::array::from_fn(|_| Vec::new()),
        }
    }

    /// Forgets the step it belonged to.
    pub fn forget(&mut self) {
        (self.fit, self.t) = (Fit::Unknown, f64::NAN);
    }
}

impl Dop853 {
    /// Computes the solution at a time inside the last step.
    ///
    /// # Errors
    /// The problem has no rate that it needs.
    pub(super) fn within_step<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        t: f64,
        y: &mut [f64],
    ) -> Result<(), Failure> {
        if self.fit(problem) == Fit::Bad {
            self.step_to(problem, t)?;
            y.copy_from_slice(&self.interpolant.y);
            return Ok(());
        }
        let s = (t - self.t0) / self.h;
        let c = 1.0 - s;
        let n = y.len();
        let y0 = &self.y0[..n];
        let [r1, r2, r3, r4, r5, r6, r7] = &self.interpolant.r;
        let (r1, r2, r3, r4) = (&r1[..n], &r2[..n], &r3[..n], &r4[..n]);
        let (r5, r6, r7) = (&r5[..n], &r6[..n], &r7[..n]);
        for i in 0..n {
            y[i] = y0[i]
                + s * (r1[i]
                    + c * (r2[i]
                        + s * (r3[i] + c * (r4[i] + s * (r5[i] + c * (r6[i] + s * r7[i]))))));
        }
        Ok(())
    }

    /// Computes the solution in the middle of the last step to order 6, from its stages alone;
    /// false where there is none, or where fast modes spoil it.
    pub(super) fn middle_of_step(&self, y: &mut [f64]) -> bool {
        if !self.advanced || self.h_lambda > CHECKED_EDGE {
            return false;
        }
        let (y0, h, k1, k13) = (&self.y0, self.h, &self.f0, &self.f1);
        let [_, _, _, _, k6, k7, k8, k9, k10, k11, k12] = &self.k;
        row!(y = y0 + h * (k1 0.0725403300432803, k6 -0.1087899077407418, k7 0.4478016201061576, k8 -0.0136093412232683,
            k9 -0.1193377777214717, k10 0.2308255626314797, k11 -0.0151066184310830, k12 -0.0186294232198731,
            k13 0.0243055555555200));
        true
    }

    /// Computes the rate at a time inside the last step.
    ///
    /// # Errors
    /// The problem has no rate that it needs.
    pub(super) fn rate_within_step<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        t: f64,
        ydot: &mut [f64],
    ) -> Result<(), Failure> {
        if self.fit(problem) == Fit::Bad {
            if t == self.t0 {
                ydot.copy_from_slice(&self.f0);
                return Ok(());
            }
            self.step_to(problem, t)?;
            self.stats.evaluations += 1;
            return problem.rate(t, &self.interpolant.y, ydot);
        }
        let s = (t - self.t0) / self.h;
        for (i, rate) in ydot.iter_mut().enumerate() {
            *rate = self.polynomial_at(i, s).1 / self.h;
        }
        Ok(())
    }

    /// Takes a step of its own from the beginning of the last step to a time inside it.
    ///
    /// # Errors
    /// The problem has no rate at a stage.
    fn step_to<P: Ode + ?Sized>(&mut self, problem: &mut P, t: f64) -> Result<(), Failure> {
        if self.interpolant.t == t {
            return Ok(());
        }
        let (h, n) = (t - self.t0, self.y0.len());
        self.interpolant.k.iter_mut().for_each(|k| k.resize(n, 0.0));
        let weighted = std::mem::take(&mut self.weighted);
        std::mem::swap(&mut self.k, &mut self.interpolant.k);
        let evaluated = self.evaluate_stages(problem, h);
        std::mem::swap(&mut self.k, &mut self.interpolant.k);
        self.weighted = weighted;
        evaluated?;
        let [_, _, _, _, k6, k7, k8, k9, k10, k11, k12] = &self.interpolant.k;
        for i in 0..n {
            let k = [
                self.f0[i], k6[i], k7[i], k8[i], k9[i], k10[i], k11[i], k12[i],
            ];
            let slope: f64 = B.iter().zip(k).map(|(b, k)| b * k).sum();
            self.interpolant.y[i] = self.y0[i] + h * slope;
        }
        self.interpolant.t = t;
        Ok(())
    }

    /// Returns how good the interpolant (4) is, which is computed at the first question.
    fn fit<P: Ode + ?Sized>(&mut self, problem: &mut P) -> Fit {
        if self.interpolant.fit == Fit::Unknown {
            // a polynomial through stages without a rate is none
            let fit = match self.compute_polynomial(problem) {
                Ok(()) if self.h_lambda > CHECKED_EDGE => self.compare(problem),
                Ok(()) => Ok(Fit::Good),
                Err(failure) => Err(failure),
            };
            self.interpolant.fit = fit.unwrap_or(Fit::Bad);
        }
        self.interpolant.fit
    }

    /// Computes the coefficients of (4), with three evaluations.
    ///
    /// # Errors
    /// The problem has no rate at a stage.
    fn compute_polynomial<P: Ode + ?Sized>(&mut self, problem: &mut P) -> Result<(), Failure> {
        let (t, h, n) = (self.t0, self.h, self.y0.len());
        let (y, stage) = (&self.y0[..n], &mut self.stage);
        let (k1, k13) = (&self.f0, &self.f1);
        // k₂ and k₃ are not needed any more
        let (k16, polynomial) = (&mut self.interpolant.k16, &mut self.interpolant.r);
        let [k14, k15, _, _, k6, k7, k8, k9, k10, k11, k12] = &mut self.k;
        macro_rules! stage {
            ($out:ident at $c:literal: $($row:tt)*) => {
                row!(stage = y + h * ($($row)*));
                self.stats.evaluations += 1;
                problem.rate(t + $c * h, &stage[..n], &mut $out[..n])?;
            };
        }
        stage!(k14 at 0.1: k1 0.056167502283047954, k7 0.25350021021662483, k8 -0.2462390374708025, k9 -0.12419142326381637,
            k10 0.15329179827876568, k11 0.00820105229563469, k12 0.007567897660545699, k13 -0.008298);
        stage!(k15 at 0.2: k1 0.03183464816350214, k6 0.028300909672366776, k7 0.053541988307438566, k8 -0.05492374857139099,
            k11 -0.00010834732869724932, k12 0.0003825710908356584, k13 -0.00034046500868740456, k14 0.1413124436746325);
        stage!(k16 at 0.7777777777777778: k1 -0.42889630158379194, k6 -4.697621415361164, k7 7.683421196062599, k8 4.06898981839711,
            k9 0.3567271874552811, k13 -0.0013990241651590145, k14 2.9475147891527724, k15 -9.15095847217987);

        let [r1, r2, r3, r4, r5, r6, r7] = polynomial;
        for i in 0..n {
            let rise = self.y1[i] - y[i];
            r1[i] = rise;
            r2[i] = h * k1[i] - rise;
            r3[i] = rise - h * k13[i] - r2[i];
        }
        stage[..n].fill(0.0);
        let zero = &stage[..n];
        row!(r4 = zero + h * (k1 -8.428938276109013, k6 0.5667149535193777, k7 -3.0689499459498917, k8 2.38466765651207,
            k9 2.117034582445028, k10 -0.871391583777973, k11 2.2404374302607883, k12 0.6315787787694688, k13 -0.08899033645133331,
            k14 18.148505520854727, k15 -9.194632392478356, k16 -4.436036387594894));
        row!(r5 = zero + h * (k1 10.427508642579134, k6 242.28349177525817, k7 165.20045171727028, k8 -374.5467547226902,
            k9 -22.113666853125306, k10 7.733432668472264, k11 -30.674084731089398, k12 -9.332130526430229, k13 15.697238121770845,
            k14 -31.139403219565178, k15 -9.35292435884448, k16 35.81684148639408));
        row!(r6 = zero + h * (k1 19.985053242002433, k6 -387.0373087493518, k7 -189.17813819516758, k8 527.8081592054236,
            k9 -11.57390253995963, k10 6.8812326946963, k11 -1.0006050966910838, k12 0.7777137798053443, k13 -2.778205752353508,
            k14 -60.19669523126412, k15 84.32040550667716, k16 11.99229113618279));
        row!(r7 = zero + h * (k1 -25.69393346270375, k6 -154.18974869023643, k7 -231.5293791760455, k8 357.6391179106141,
            k9 93.40532418362432, k10 -37.45832313645163, k11 104.0996495089623, k12 29.8402934266605, k13 -43.53345659001114,
            k14 96.32455395918828, k15 -39.17726167561544, k16 -149.72683625798564));
        Ok(())
    }

    /// Compares the slope of (4) in the middle of the step with the rate there: the difference is
    /// about λ times the error of the interpolant.
    ///
    /// # Errors
    /// The problem has no rate there.
    fn compare<P: Ode + ?Sized>(&mut self, problem: &mut P) -> Result<Fit, Failure> {
        /// Place in the step at which two interpolants are compared.
        const MIDDLE: f64 = 0.5;
        let n = self.y0.len();
        // k₂ and k₃ have done their work
        let (mut y, mut slope) = (
            std::mem::take(&mut self.k[0]),
            std::mem::take(&mut self.k[1]),
        );
        for i in 0..n {
            (y[i], slope[i]) = self.polynomial_at(i, MIDDLE);
        }
        self.stats.evaluations += 1;
        let evaluated = problem.rate(self.t0 + MIDDLE * self.h, &y, &mut self.stage);
        let defects = self.stage.iter().zip(&slope).zip(self.weights.magnitude());
        let worst = worst(defects.map(|((f, slope), m)| (self.h * f - slope) / m));
        (self.k[0], self.k[1]) = (y, slope);
        evaluated?;
        let permitted = MISFIT_TOLERANCE * self.h_lambda * self.weights.tolerance();
        Ok(match worst <= permitted {
            true => Fit::Good,
            false => Fit::Bad,
        })
    }

    /// Returns value and slope, per step, of (4) for unknown `i` at the part `s` of the step.
    fn polynomial_at(&self, i: usize, s: f64) -> (f64, f64) {
        // Horner's rule; the factors alternate between θ and 1 − θ
        let (mut p, mut slope) = (0.0, 0.0);
        for (j, r) in self.interpolant.r.iter().enumerate().rev() {
            p += r[i];
            let (factor, sign) = if j % 2 == 0 {
                (s, 1.0)
            } else {
                (1.0 - s, -1.0)
            };
            slope = slope * factor + p * sign;
            p *= factor;
        }
        (self.y0[i] + p, slope)
    }
}
