//! Narrow peaks of forces within a step: whether one is hidden between its ends.
//!
//! ```text
//! L(t) < max(L(t₀), L(t₁), NEGLIGIBLE) + HIDDEN         L: the logarithm of a factor
//! ```
//!
//! Where a factor is between the ends of a step no more than e^[`HIDDEN`] times larger than at one
//! of them, error control sees it. Whether it is, is shown by bounds, as for switches
//! (`bounded_switches.rs`). Where it becomes larger, the step is undone and ends on the way to the
//! peak: [`DEPTH`] below a level that it passes at first, then in stairs of [`HIDDEN`], up and down
//! again.

use crate::analysis::system::System;
use crate::analysis::system::bounds::What;
use crate::analysis::time::bounded_switches::{Asked, BoundedSwitches, Whole, shortest};
use crate::analysis::time::switches::SHORTEST_STEP;
use crate::numeric::{Method, Step};

/// Growth of a logarithm above its values at the ends of a step up to which a step feels its
/// factor: seven times.
const HIDDEN: f64 = 2.0;
/// Depth below its peak from which on a factor is felt: a three thousandth of it.
const DEPTH: f64 = 8.0;
/// Logarithm of a factor that is felt nowhere, whatever it multiplies.
const NEGLIGIBLE: f64 = -100.0;
/// Levels that are tried in search of the height of a peak, at most: a pole has none.
const MAX_LEVELS: usize = 32;
/// Steps that are repeated at one time because of peaks, at most.
const MAX_REPEATED: usize = 20;

/// The logarithms at the ends of a step, and what is asked of them.
#[derive(Debug)]
struct Ends {
    /// which are asked for: they are to stay below their levels   (n)
    sides: Vec<i8>,
    levels: Vec<f64>,
    /// values at the beginning of the step and at its end   (n each)
    before: Vec<f64>,
    after: Vec<f64>,
}

impl Ends {
    fn asked<'a>(&'a self, step: &'a Step) -> Asked<'a> {
        Asked {
            step,
            sides: &self.sides,
            levels: &self.levels,
            values: [&self.before, &self.after],
            slopes: None,
        }
    }
}

/// Narrow peaks within the step under way.
#[derive(Debug)]
pub(super) struct PeaksWithin {
    watched: BoundedSwitches,
    ends: Ends,
    /// the largest value of each whose peak is being crossed; else −∞   (n)
    tops: Vec<f64>,
    /// how often in a row the step was repeated
    repeated: usize,
    /// shortest step because of a peak, in s
    shortest: f64,
}

impl PeaksWithin {
    /// Finds the logarithms of a system, for a run of some duration.
    pub fn new(system: &mut System, duration: f64) -> Self {
        let n = system.recorded.peaks.len();
        Self {
            watched: BoundedSwitches::new(system, What::Peaks, n),
            ends: Ends {
                sides: vec![0; n],
                levels: vec![0.0; n],
                before: vec![0.0; n],
                after: vec![0.0; n],
            },
            tops: vec![f64::NEG_INFINITY; n],
            repeated: 0,
            shortest: SHORTEST_STEP * duration,
        }
    }

    /// Looks at them where a method begins.
    pub fn begin(&mut self, system: &mut System, method: &dyn Method<System>) {
        if self.ends.sides.is_empty() {
            return;
        }
        system.watch(What::Peaks, (method.t(), method.y()), &mut self.ends.after);
        self.keep(method);
    }

    /// Makes the end of a step the beginning of the next.
    pub fn keep(&mut self, method: &dyn Method<System>) {
        if self.ends.sides.is_empty() {
            return;
        }
        self.repeated = 0;
        self.watched.begin(method.y(), method.ydot());
        std::mem::swap(&mut self.ends.before, &mut self.ends.after);
        for (top, &now) in self.tops.iter_mut().zip(&self.ends.before) {
            *top = match *top > f64::NEG_INFINITY && now > *top - DEPTH {
                true => top.max(now),
                false => f64::NEG_INFINITY,
            };
        }
    }

    /// Returns where the step has to end instead, if a narrow peak is hidden in it.
    pub fn hidden(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
    ) -> Option<f64> {
        if self.ends.sides.is_empty() {
            return None;
        }
        system.watch(What::Peaks, (step.t1, method.y()), &mut self.ends.after);
        if self.repeated >= MAX_REPEATED || step.h <= self.shortest {
            return None;
        }
        let ends = &mut self.ends;
        let asked = ends.levels.iter_mut().zip(&mut ends.sides);
        for ((level, side), (a, b)) in asked.zip(ends.before.iter().zip(&ends.after)) {
            *level = a.max(*b).max(NEGLIGIBLE) + HIDDEN;
            // what has no value is no peak
            *side = -i8::from(level.is_finite() && !a.is_nan() && !b.is_nan());
        }
        let asked = self.ends.asked(step);
        let is_free = self.watched.are_far(system, method, asked)
            || self.watched.look_at_whole(system, method, asked) == Whole::Free;
        let falls = |&k: &usize| {
            self.tops[k] > f64::NEG_INFINITY && self.ends.after[k] < self.ends.before[k] - HIDDEN
        };
        let falling: Vec<usize> = (0..self.ends.sides.len()).filter(falls).collect();
        if is_free && falling.is_empty() {
            return None;
        }
        // a peak at which the interpolant has no value is left to error control
        self.watched.follow(system, method, step).ok()?;
        let mut at = f64::INFINITY;
        if !is_free {
            for k in self.watched.open().to_vec() {
                if let Some(found) = self.approach(system, method, (step, k)) {
                    self.tops[k] = self.tops[k].max(self.ends.before[k]);
                    at = at.min(found);
                }
            }
        }
        for k in falling {
            at = at.min(self.leave(system, method, (step, k)));
        }
        let at = at.max(step.t0 + self.shortest);
        self.repeated += 1;
        (at < step.t1).then_some(at)
    }

    /// Returns where to end on the way down from a peak: where a logarithm has fallen by
    /// [`HIDDEN`], or nearly so.
    fn leave(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        (step, k): (&Step, usize),
    ) -> f64 {
        self.ends.levels[k] = self.ends.before[k] - HIDDEN;
        let asked = self.ends.asked(step);
        self.watched.forget_values();
        let [mut a, mut b] = [step.t0, step.t1];
        while b - a > shortest(step) {
            let middle = 0.5 * (a + b);
            match self.watched.value(system, method, asked, (k, middle)) {
                Some(above) if above > 0.5 * HIDDEN => a = middle,
                Some(above) if above >= 0.0 => return middle,
                _ => b = middle,
            }
        }
        b
    }

    /// Returns where to end on the way to the first peak of a logarithm.
    fn approach(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        (step, k): (&Step, usize),
    ) -> Option<f64> {
        let stair = self.ends.levels[k];
        let mut found = self.first_above(system, method, (step, k))?;
        let mut last = found;
        for _ in 0..MAX_LEVELS {
            self.ends.levels[k] += DEPTH;
            let Some(higher) = self.first_above(system, method, (step, k)) else {
                break;
            };
            (found, last) = (last, higher);
        }
        self.ends.levels[k] = stair;
        Some(found)
    }

    /// Returns a time of the step at which a logarithm is above its level, and not by much.
    fn first_above(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        (step, k): (&Step, usize),
    ) -> Option<f64> {
        let asked = self.ends.asked(step);
        let watched = &mut self.watched;
        let found = watched.first_of_one(system, method, asked, (k, step.t1));
        let Some([mut a, mut b]) = found.event else {
            let is_looked_at = found.free_to >= step.t1;
            return (!is_looked_at && found.free_to > step.t0).then_some(found.free_to);
        };
        while b - a > shortest(step) {
            let mut above = |t| watched.value(system, method, asked, (k, t));
            if above(b).is_none_or(|above| above <= HIDDEN) {
                break;
            }
            let middle = 0.5 * (a + b);
            match above(middle).is_some_and(|above| above > 0.0) {
                true => b = middle,
                false => a = middle,
            }
        }
        Some(b)
    }
}
