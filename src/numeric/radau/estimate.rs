//! The error of a step of Radau IIA: at its end, between its nodes, and what the filter hides.
//!
//! Equations (3) and (4) are those of [`super`]. The filter (γ̂/h − J)⁻¹ takes away what is stiff,
//! which is right where the rate is about as steep as J says: J is that of the beginning of this
//! step or of one before. A rate that is flat where J is steep has an error that no filter may take
//! away.

use super::collocation::{self, GAMMA, ROUNDING, SQRT6, UNEXPLAINED};
use super::{Failure, Ode, Radau, worst, worst_index};

/// eᵢ of (3).
const E: [f64; 3] = [
    -(13.0 + 7.0 * SQRT6) / 3.0,
    (-13.0 + 7.0 * SQRT6) / 3.0,
    -1.0 / 3.0,
];
/// θ of (4).
const BETWEEN_NODES: f64 = 0.85;
/// Ratio of an error without the filter of (4) to the one with it above which the filter is tried.
const HIDING_FILTER: f64 = 10.0;
/// Attempts at one step after which residuals that no Jacobian explains count as rounding.
const MOST_HIDDEN: usize = 12;

impl Radau {
    /// Estimates the error of the step, (3) or (4), as a part of that permitted.
    pub(super) fn estimate<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        h: f64,
    ) -> Result<f64, Failure> {
        let (error, unfiltered) = self.estimate_at_end(problem, h)?;
        if error >= 1.0 || unfiltered < 1.0 || error.is_nan() {
            return Ok(error);
        }
        Ok(error.max(self.estimate_between_nodes(problem, h)?))
    }

    /// Estimates the error (4), as a part of that permitted.
    fn estimate_between_nodes<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        h: f64,
    ) -> Result<f64, Failure> {
        const WEIGHTS: [[f64; 2]; 3] = collocation::cubic_weights(BETWEEN_NODES);
        let z = &self.stages.z;
        let argument = &mut self.stages.argument;
        for i in 0..argument.len() {
            let sum = |k: usize| (0..3).map(|j| WEIGHTS[j][k] * z[j][i]).sum::<f64>();
            argument[i] = self.begin.y[i] + sum(0);
            self.defect[i] = sum(1) / h;
        }
        self.stats.evaluations += 1;
        problem.rate(self.begin.t + BETWEEN_NODES * h, argument, &mut self.error)?;
        for (e, slope) in self.error.iter_mut().zip(&self.defect) {
            *e -= slope;
        }
        self.unexplained.copy_from_slice(&self.error);
        self.systems.solve(&mut self.error);
        let error = worst(self.error.iter().zip(&self.scale).map(|(e, s)| e * s));
        let rounding = self.rounding(problem);
        let is_hidden = |((d, e), s): ((&f64, &f64), &f64)| {
            let (unfiltered, error) = (h / GAMMA * d.abs() * s, (e * s).abs());
            unfiltered > 1.0_f64.max(HIDING_FILTER * error) && error > rounding
        };
        let defects = self.unexplained.iter().zip(&self.error).zip(&self.scale);
        if error >= 1.0 || error.is_nan() || !defects.clone().any(is_hidden) {
            return Ok(error);
        }

        // what the filter takes away is to vanish where it says
        let argument = &mut self.stages.argument;
        for (y, e) in argument.iter_mut().zip(&self.error) {
            *y += e;
        }
        let corrected = &mut self.stages.g[0];
        self.stats.evaluations += 1;
        problem.rate(self.begin.t + BETWEEN_NODES * h, argument, corrected)?;
        let mut hidden = 0.0_f64;
        let slopes = corrected.iter().zip(&self.defect);
        for (defect, (f, slope)) in defects.zip(slopes) {
            let ((before, _), s) = defect;
            let left = (f - slope).abs();
            if is_hidden(defect) && left > UNEXPLAINED * before.abs() {
                hidden = hidden.max(h / GAMMA * left * s);
            }
        }
        if hidden >= 1.0 {
            self.hidden += 1;
            // an error of no order; the step is shortened by as much as it ever is
            return Ok(hidden);
        }
        Ok(error)
    }

    /// Returns the unknown whose rate at the new point most contradicts the step by which that was
    /// found, `f(t + h, y₁) − ẏ(t + h)` filtered as (4), where it does by more than the permitted
    /// error: a law has changed within a step that took it for as linear as in the step before.
    pub(super) fn contradicted(&mut self, h: f64) -> Option<usize> {
        for (i, e) in self.error.iter_mut().enumerate() {
            *e = self.end.f[i] - self.polynomial.slope(i, 0.0) / h;
        }
        self.systems.solve(&mut self.error);
        let left = || self.error.iter().zip(&self.scale).map(|(e, s)| e * s);
        (worst(left()) >= 1.0).then(|| worst_index(left()))
    }

    /// Returns the size of a correction that may be rounding, over the permitted error.
    pub(super) fn rounding<P: Ode + ?Sized>(&self, problem: &P) -> f64 {
        let in_vain = self.eased || self.hidden >= MOST_HIDDEN || problem.is_noisy();
        if in_vain {
            f64::INFINITY
        } else {
            ROUNDING / self.tolerance
        }
    }

    /// Estimates the error (3) of the step, as a part of that permitted; the second number is the
    /// same without its filter.
    fn estimate_at_end<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        h: f64,
    ) -> Result<(f64, f64), Failure> {
        let n = self.begin.y.len();
        let z = &self.stages.z;
        for i in 0..n {
            self.defect[i] = (E[0] * z[0][i] + E[1] * z[1][i] + E[2] * z[2][i]) / h;
            self.error[i] = self.defect[i] + self.begin.f[i];
        }
        let norm = |e: &[f64], scale: &[f64]| worst(e.iter().zip(scale).map(|(e, s)| e * s));
        let unfiltered = h / GAMMA * norm(&self.error, &self.scale);
        self.systems.solve(&mut self.error);
        let mut error = norm(&self.error, &self.scale);
        if error >= 1.0 && (self.control.first || self.control.calm) {
            let argument = &mut self.stages.argument;
            for i in 0..n {
                argument[i] = self.begin.y[i] + self.error[i];
            }
            self.stats.evaluations += 1;
            problem.rate(self.begin.t, argument, &mut self.error)?;
            for i in 0..n {
                self.error[i] += self.defect[i];
            }
            self.systems.solve(&mut self.error);
            error = norm(&self.error, &self.scale);
        }
        Ok((error.max(1e-10), unfiltered))
    }
}
