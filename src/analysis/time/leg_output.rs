//! Output times within the steps of a leg, and the turns of angles that are counted on the way.

use crate::analysis::system::System;
use crate::analysis::system::turns::Look;
use crate::analysis::time::counting::Counting;
use crate::analysis::time::leg::{Finished, Leg};
use crate::numeric::{Method, Step};

impl Leg<'_> {
    /// Returns a time inside a step at which the interpolant has no value although somebody reads
    /// it: the first output time, or the middle where states downstream do. A step has to end
    /// there.
    pub(super) fn unreadable(
        &mut self,
        method: &mut dyn Method<System>,
        step: &Step,
    ) -> Option<f64> {
        let output = self.outputs.get(self.out.t.len()).copied();
        let reads = self.system.reads_mechanism_downstream();
        let middle = reads.then_some(step.t0 + 0.5 * (step.t1 - step.t0));
        let t = output.filter(|&t| t < step.t1).or(middle)?;
        let state = &mut self.between;
        state.resize(method.y().len(), 0.0);
        let found = (self.system).aside(|system| method.interpolate(system, t, state));
        let failed = found.is_err();
        (failed && t > step.t0).then_some(t)
    }

    /// Puts out the states at output times inside an accepted step, and up to `until` just behind
    /// it; counts turns up to its end, and lets what is downstream follow there.
    ///
    /// # Errors
    /// States downstream could not follow.
    pub(super) fn emit(
        &mut self,
        method: &mut dyn Method<System>,
        step: &Step,
        until: f64,
    ) -> Result<(), Finished> {
        let mut state = std::mem::take(&mut self.between);
        state.resize(method.y().len(), 0.0);
        let (found, outcome) = self.follow_downstream(method, step, until);
        let mut found = found.into_iter();
        self.begin_counting(method, step);
        while let Some(&t) = self.outputs.get(self.out.t.len()) {
            if t > until {
                break;
            }
            if self.downstream.is_some() {
                let Some(x) = found.next() else { break };
                self.system.put_downstream(&x);
            }
            self.count_turns(method, step, t);
            let (row, branches) = self.system.aside(|system| {
                if !state_at(method, step.t1)(system, t, &mut state) {
                    // tried before the step was accepted: a method that had a value once has it
                    // again
                    state.fill(f64::NAN);
                }
                let row = system.row(t, &state);
                let branches = system.rows_of_branches(&row);
                (row, branches)
            });
            if !branches.is_empty() {
                self.out.means.insert(self.out.t.len(), branches);
            }
            self.out.push(t, row);
        }
        self.between = state;
        self.count_turns(method, step, step.t1);
        if let Some(downstream) = &self.downstream {
            self.system.put_downstream(downstream.states());
        }
        outcome
    }

    /// Returns a bound of the turn of the markers of counted angles within a step, rad.
    fn turn_within(&mut self, method: &mut dyn Method<System>, step: &Step) -> f64 {
        turn_within(self.system, &mut self.counting, method, step)
    }

    /// Returns the time up to which the next step may go so that angles that decide forces keep
    /// their turns in it.
    pub(super) fn longest_turn(&mut self, t: f64, y: &[f64]) -> f64 {
        if !self.system.turns_decide() {
            return f64::INFINITY;
        }
        t + self.counting.longest_step(self.system, t, y)
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
            let counting = &mut self.counting;
            let turn = (self.system).aside(|system| turn_within(system, counting, method, step));
            self.counting.divide(turn);
        }
    }

    /// Counts angles up to a time in the step.
    fn count_turns(&mut self, method: &mut dyn Method<System>, step: &Step, until: f64) {
        if self.system.counts_turns() {
            let mut state_at = state_at(method, step.t1);
            let counting = &mut self.counting;
            (self.system).aside(|system| counting.count(system, until, &mut state_at));
        }
    }
}

/// Returns a bound of the turn of the markers of counted angles within a step, rad.
fn turn_within(
    system: &mut System,
    counting: &mut Counting,
    method: &mut dyn Method<System>,
    step: &Step,
) -> f64 {
    let mut acceleration = system.spin(method.ydot());
    let mut rate = method.y().to_vec();
    if (method.interpolate_rate(system, step.t0, &mut rate)).is_ok() {
        acceleration = acceleration.max(system.spin(&rate));
    }
    let ends = (step.t0, step.t1);
    let free = (rate.len(), acceleration);
    counting.turn_within(system, ends, free, &mut state_at(method, step.t1))
}

/// Returns the states of the step that a method has taken, which ends at `t1`.
fn state_at<'m>(
    method: &'m mut dyn Method<System>,
    t1: f64,
) -> impl FnMut(&mut System, f64, &mut [f64]) -> bool + 'm {
    move |system, t, state| {
        if t >= t1 {
            state.copy_from_slice(method.y());
            return true;
        }
        method.interpolate(system, t, state).is_ok()
    }
}
