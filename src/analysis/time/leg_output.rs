//! Output times within the steps of a leg, and the turns of angles that are counted on the way.

use crate::analysis::system::System;
use crate::analysis::time::leg::Leg;
use crate::numeric::{Method, Step};

/// Looks at counted angles within a step, at most.
const MAX_LOOKS: f64 = 1e6;
/// Angle by which a counted angle may turn between looks, rad: it must not be half a turn.
const TURN_BETWEEN_LOOKS: f64 = 1.5;

/// The looks at counted angles within a step, at equal distances.
struct Looks {
    /// intervals between them; zero: none
    intervals: usize,
    /// the next one
    next: usize,
}

impl Looks {
    /// Returns the time of the next look, if it is inside the step.
    fn next(&self, step: &Step) -> Option<f64> {
        (self.next < self.intervals)
            .then(|| step.t0 + step.h * self.next as f64 / self.intervals as f64)
    }
}

impl Leg<'_> {
    /// Returns the first output time inside a step at which the interpolant has no value: a step
    /// has to end there.
    pub(super) fn unreadable(
        &mut self,
        method: &mut dyn Method<System>,
        step: &Step,
    ) -> Option<f64> {
        let t = *self
            .outputs
            .get(self.out.t.len())
            .filter(|&&t| t < step.t1)?;
        let mut state = method.y().to_vec();
        let failed = method.interpolate(self.system, t, &mut state).is_err();
        (failed && t > step.t0).then_some(t)
    }

    /// Puts out the states at output times inside an accepted step, and up to `until` just behind
    /// it; counts turns up to its end.
    pub(super) fn emit(&mut self, method: &mut dyn Method<System>, step: &Step, until: f64) {
        let mut state = method.y().to_vec();
        let mut looks = self.looks(method, step);
        while let Some(&t) = self.outputs.get(self.out.t.len()) {
            if t > until {
                break;
            }
            self.count_turns(method, step, &mut looks, t, &mut state);
            if t >= step.t1 {
                state.copy_from_slice(method.y());
            } else if method.interpolate(self.system, t, &mut state).is_err() {
                // tried before the step was accepted: a method that had a value once has it again
                state.fill(f64::NAN);
            }
            if self.system.counts_turns() {
                self.system.count_turns(t, &state);
            }
            let row = self.system.row(t, &state);
            self.out.push(t, row);
        }
        if self.system.counts_turns() {
            self.count_turns(method, step, &mut looks, f64::INFINITY, &mut state);
            self.system.count_turns(step.t1, method.y());
        }
    }

    /// Returns how often counted angles are looked at within a step.
    fn looks(&mut self, method: &mut dyn Method<System>, step: &Step) -> Looks {
        let mut intervals = 0;
        if self.system.counts_turns() {
            let turn = self.spin_within(method, step) * step.h;
            intervals = (turn / TURN_BETWEEN_LOOKS).ceil().min(MAX_LOOKS) as usize;
        }
        if intervals > 0 {
            intervals += 1;
        }
        Looks { intervals, next: 1 }
    }

    /// Follows counted angles up to a time.
    fn count_turns(
        &mut self,
        method: &mut dyn Method<System>,
        step: &Step,
        looks: &mut Looks,
        until: f64,
        state: &mut [f64],
    ) {
        while let Some(at) = looks.next(step).filter(|&at| at <= until) {
            if method.interpolate(self.system, at, state).is_ok() {
                self.system.count_turns(at, state);
            }
            looks.next += 1;
        }
    }

    /// Returns a bound of how fast any angle turns within a step, rad per time: at its ends it may
    /// stand still.
    fn spin_within(&mut self, method: &mut dyn Method<System>, step: &Step) -> f64 {
        let (mut speed, mut acceleration) = (
            self.system.spin(method.y()),
            self.system.spin(method.ydot()),
        );
        let mut before = method.y().to_vec();
        if method
            .interpolate(self.system, step.t0, &mut before)
            .is_ok()
        {
            speed = speed.max(self.system.spin(&before));
        }
        if method
            .interpolate_rate(self.system, step.t0, &mut before)
            .is_ok()
        {
            acceleration = acceleration.max(self.system.spin(&before));
        }
        // what grows and falls again within the step is at its largest near the middle
        speed + 0.25 * step.h * acceleration
    }
}
