//! Narrow peaks of forces within a step of a leg: located on the interpolant, and crossed with
//! steps that see them.

use crate::analysis::system::System;
use crate::analysis::time::leg::Leg;
use crate::numeric::{Failure, Method, Step};

/// Looks at a logarithm within a step, before its maximum is closed in.
const LOOKS: usize = 5;
/// Golden sections that close in on a maximum, at most: to 1e-14 of the step.
const SECTIONS: usize = 70;
/// Halvings of the way from a maximum on which the logarithm falls by one.
const HALVINGS: usize = 60;
/// Logarithm of a factor that is felt nowhere, whatever it multiplies.
const NEGLIGIBLE: f64 = -100.0;
/// Part of a step that a peak must be narrower than to be hidden in it.
const NARROW: f64 = 0.5;
/// Shortest width of a peak, as a part of the duration of the run.
const NARROWEST: f64 = 1e-13;
/// Fall of the logarithm beyond which steps may grow again: to 2e-9 of the peak.
const DEPTH: f64 = 20.0;
/// Distance from a maximum, in widths, beyond which they may grow whatever is left.
const FARTHEST: f64 = 20.0;
/// Growth of the distance at which that is looked for.
const GROWTH: f64 = 1.3;
/// Fall of the logarithm on the bracket of a maximum that is known well enough.
const CLOSED_IN: f64 = 0.1;
/// Steps that are repeated at one time because of peaks, at most.
const MAX_REPEATED: usize = 20;

/// A narrow peak, in time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Peak {
    /// where steps begin to be short, and where they may grow again
    from: f64,
    to: f64,
    /// time in which the logarithm falls by one
    width: f64,
}

impl Leg<'_> {
    /// Looks at the narrow peaks where a method begins.
    pub(super) fn begin_peaks(&mut self, method: &dyn Method<System>) {
        if self.system.recorded.peaks.is_empty() {
            return;
        }
        let delta = 1e-9 * (self.limits.end - self.limits.start);
        let (t, y) = (method.t(), method.y());
        self.system.look_at_peaks(t, y, method.ydot(), delta);
        self.system.recorded.peaks.keep();
    }

    /// Returns how far a step from `t` may go because of narrow peaks.
    pub(super) fn peak_horizon(&mut self, t: f64) -> f64 {
        if self.system.recorded.peaks.is_empty() {
            return f64::INFINITY;
        }
        let turned = t + self.system.recorded.peaks.longest_turn();
        self.peak = self.peak.filter(|p| t < p.to);
        match self.peak {
            Some(p) if t < p.from - p.width => turned.min(p.from),
            Some(p) => turned.min(t + p.width),
            None => turned,
        }
    }

    /// Returns where the step has to end instead, if a narrow peak is hidden in it.
    pub(super) fn hidden_peak(
        &mut self,
        method: &mut dyn Method<System>,
        step: &Step,
    ) -> Option<f64> {
        if self.system.recorded.peaks.is_empty() {
            return None;
        }
        let (y, ydot) = (method.y(), method.ydot());
        self.system.look_at_peaks(step.t1, y, ydot, 1e-4 * step.h);
        if self.repeated >= MAX_REPEATED {
            return None;
        }
        let hidden = self.system.recorded.peaks.hidden(step.h).into_iter();
        // a peak at which the interpolant has no value is left to error control
        let found = hidden.filter_map(|k| self.locate(method, step, k).ok().flatten());
        let first = found.min_by(|a, b| a.from.total_cmp(&b.from))?;
        self.repeated += 1;
        self.peak = Some(first);
        Some(first.from.max(step.t0 + first.width))
    }

    /// Locates the maximum of a logarithm within a step; `None`: it is not narrow, or not felt.
    fn locate(
        &mut self,
        method: &mut dyn Method<System>,
        step: &Step,
        k: usize,
    ) -> Result<Option<Peak>, Failure> {
        let mut state = method.y().to_vec();
        let mut at = |t: f64| {
            method.interpolate(self.system, t, &mut state)?;
            let value = self.system.peak_at(t, &state, k);
            // what has no value is no peak
            Ok::<f64, Failure>(if value.is_nan() {
                f64::NEG_INFINITY
            } else {
                value
            })
        };
        // the highest of some looks
        let time = |j: usize| step.t0 + step.h * j as f64 / (LOOKS + 1) as f64;
        let mut highest = (1, at(time(1))?);
        for j in 2..=LOOKS {
            let value = at(time(j))?;
            highest = if value > highest.1 {
                (j, value)
            } else {
                highest
            };
        }
        let (mut a, mut b) = (time(highest.0 - 1), time(highest.0 + 1).min(step.t1));
        // golden sections
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let (mut at_a, mut at_b) = (at(a)?, at(b)?);
        let (mut c, mut d) = (b - golden * (b - a), a + golden * (b - a));
        let (mut at_c, mut at_d) = (at(c)?, at(d)?);
        for _ in 0..SECTIONS {
            if at_c.max(at_d) - at_a.min(at_b) < CLOSED_IN {
                break;
            }
            if at_c > at_d {
                (b, d, at_b, at_d) = (d, c, at_d, at_c);
                c = b - golden * (b - a);
                at_c = at(c)?;
            } else {
                (a, c, at_a, at_c) = (c, d, at_c, at_d);
                d = a + golden * (b - a);
                at_d = at(d)?;
            }
        }
        let (summit, height) = if at_c > at_d { (c, at_c) } else { (d, at_d) };
        if !self.system.recorded.peaks.stands_out(k, height) || height < NEGLIGIBLE {
            return Ok(None);
        }
        self.width(method, step, (summit, height, k))
    }

    /// Returns the extent of a peak about the maximum of a logarithm; `None`: it is not narrow.
    fn width(
        &mut self,
        method: &mut dyn Method<System>,
        step: &Step,
        (summit, height, k): (f64, f64, usize),
    ) -> Result<Option<Peak>, Failure> {
        let mut state = method.y().to_vec();
        let mut fall = |distance: f64| {
            let mut lowest = 0.0_f64;
            let sides = [summit - distance, summit + distance];
            for t in sides
                .into_iter()
                .filter(|t| (step.t0..=step.t1).contains(t))
            {
                method.interpolate(self.system, t, &mut state)?;
                lowest = lowest.max(height - self.system.peak_at(t, &state, k));
            }
            Ok::<f64, Failure>(lowest)
        };
        // inside the step whatever its rounding
        let most = 0.99 * (summit - step.t0).max(step.t1 - summit);
        let mut width = most;
        for _ in 0..HALVINGS {
            if fall(width)? <= 1.0 {
                break;
            }
            width *= 0.5;
        }
        let mut reach = width;
        while reach < (FARTHEST * width).min(most) && fall(reach)? < DEPTH {
            reach *= GROWTH;
        }
        let duration = self.limits.end - self.limits.start;
        let is_narrow = width < NARROW * step.h && width > NARROWEST * duration;
        Ok(is_narrow.then_some(Peak {
            from: summit - reach,
            to: summit + reach,
            width,
        }))
    }
}
