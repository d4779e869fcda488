//! Output times within the steps of a leg, and the turns of angles that are counted on the way.

use crate::analysis::system::System;
use crate::analysis::system::turns::Look;
use crate::analysis::time::leg::Leg;
use crate::numeric::{Method, Step};

/// Part of a step between looks at which an angle is taken to jump.
const SHORTEST_INTERVAL: f64 = 1e-9;

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
        self.begin_counting(method, step);
        while let Some(&t) = self.outputs.get(self.out.t.len()) {
            if t > until {
                break;
            }
            self.count_turns(method, step, t);
            if !state_at(self.system, method, step, t, &mut state) {
                // tried before the step was accepted: a method that had a value once has it again
                state.fill(f64::NAN);
            }
            let row = self.system.row(t, &state);
            let branches = self.system.rows_of_branches(&row);
            if !branches.is_empty() {
                self.out.means.insert(self.out.t.len(), branches);
            }
            self.out.push(t, row);
        }
        self.count_turns(method, step, step.t1);
    }

    /// Looks at the counted angles at both ends of a step; returns a bound of the turn of their
    /// markers within it, rad.
    pub(super) fn turn_within(&mut self, method: &mut dyn Method<System>, step: &Step) -> f64 {
        let Counting {
            from, next, state, ..
        } = &mut self.counting;
        state.resize(method.y().len(), 0.0);
        let mut acceleration = self.system.spin(method.ydot());
        if state_at(self.system, method, step, step.t0, state) {
            self.system.look_at_turns(step.t0, state, from);
        }
        if (method.interpolate_rate(self.system, step.t0, state)).is_ok() {
            acceleration = acceleration.max(self.system.spin(state));
        }
        self.system.look_at_turns(step.t1, method.y(), next);
        acceleration += from.driven_acceleration.max(next.driven_acceleration);
        // what grows and falls again within the step is at its largest near the middle
        (from.speed.max(next.speed) + 0.25 * step.h * acceleration) * step.h
    }

    /// Returns the time up to which the next step may go so that angles that decide forces keep
    /// their turns in it.
    pub(super) fn longest_turn(&mut self, t: f64, y: &[f64]) -> f64 {
        if !self.system.turns_decide() {
            return f64::INFINITY;
        }
        self.system.look_at_turns(t, y, &mut self.counting.from);
        t + self.counting.from.longest_step()
    }

    /// Returns where a step should have ended in which angles that decide forces turn by so much
    /// that they were taken with the wrong turns.
    pub(super) fn loses_turn(
        &mut self,
        method: &mut dyn Method<System>,
        step: &Step,
    ) -> Option<f64> {
        if !self.system.turns_decide() || step.h <= 1e-12 * step.t1.abs() {
            return None;
        }
        let turn = self.turn_within(method, step);
        let part = Look::part_of_step(turn)?;
        Some(step.t0 + part * step.h)
    }

    /// Begins to count the angles of a step, which is divided by how much they turn at most.
    fn begin_counting(&mut self, method: &mut dyn Method<System>, step: &Step) {
        if self.system.counts_turns() {
            let intervals = Look::intervals(self.turn_within(method, step));
            let place = |k: usize| step.t0 + step.h * (k as f64 / intervals as f64);
            self.counting.ahead.clear();
            self.counting.ahead.extend((1..intervals).rev().map(place));
        }
    }

    /// Counts angles up to a time in the step.
    fn count_turns(&mut self, method: &mut dyn Method<System>, step: &Step, until: f64) {
        if !self.system.counts_turns() {
            return;
        }
        while let Some(t) = self.counting.ahead.pop_if(|t| *t < until) {
            self.counting.follow(self.system, method, step, t);
        }
        self.counting.follow(self.system, method, step, until);
    }
}

/// The angles that are counted from look to look within a step.
#[derive(Debug, Default)]
pub(super) struct Counting {
    /// the last look whose angles were taken over
    from: Look,
    /// the look that is tried
    next: Look,
    /// looks that are to come in the step, the latest first
    ahead: Vec<f64>,
    /// looks that are to be taken before one can be, the nearest last
    halves: Vec<f64>,
    /// the state at a look   (n)
    state: Vec<f64>,
}

impl Counting {
    /// Takes over the angles at a time, by as many looks on the way as that takes.
    fn follow(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
        to: f64,
    ) {
        let Self {
            from,
            next,
            halves,
            state,
            ..
        } = self;
        halves.clear();
        halves.push(to);
        while let Some(&t) = halves.last() {
            if state_at(system, method, step, t, state) {
                system.look_at_turns(t, state, next);
                let interval = t - from.t;
                if !from.leads_to(next) && interval > SHORTEST_INTERVAL * step.h {
                    halves.push(from.t + 0.5 * interval);
                    continue;
                }
                system.take_turns(next);
                std::mem::swap(from, next);
            }
            halves.pop();
        }
    }
}

/// Puts the state at a time of a step in place; returns false where the interpolant has no value.
fn state_at(
    system: &mut System,
    method: &mut dyn Method<System>,
    step: &Step,
    t: f64,
    state: &mut [f64],
) -> bool {
    if t >= step.t1 {
        state.copy_from_slice(method.y());
        return true;
    }
    method.interpolate(system, t, state).is_ok()
}
