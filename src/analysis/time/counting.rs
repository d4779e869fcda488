//! Counts the turns of angles that no coordinate knows, by looks within a step.
//!
//! Looks stand at equal distances that follow from how fast the markers may turn, and twice as
//! close wherever one does not follow from the one before.

use crate::analysis::system::System;
use crate::analysis::system::turns::Look;

/// Part of a step between looks at which an angle is taken to jump.
const SHORTEST_INTERVAL: f64 = 1e-9;

/// Puts the state at a time of a step in place; returns false where there is none.
pub(in crate::analysis) type StateAt<'a> = dyn FnMut(&mut System, f64, &mut [f64]) -> bool + 'a;

/// The angles that are counted from look to look within a step.
#[derive(Clone, Debug, Default)]
pub(in crate::analysis) struct Counting {
    /// the last look whose angles were taken over
    from: Look,
    /// the look that is tried
    next: Look,
    /// length of the step
    h: f64,
    /// looks that are to come in the step, the latest first
    ahead: Vec<f64>,
    /// looks that are to be taken before one can be, the nearest last
    halves: Vec<f64>,
    /// the state at a look   (n)
    state: Vec<f64>,
}

impl Counting {
    /// Begins at a state, with no step taken.
    pub fn begin(&mut self, system: &mut System, t: f64, y: &[f64]) {
        self.ahead.clear();
        self.h = 0.0;
        self.state.clear();
        self.state.extend_from_slice(y);
        system.look_at_turns(t, y, &mut self.from);
    }

    /// Looks at the angles at a state from which a step is to begin; returns how long it may be so
    /// that the nearest angles are the right ones.
    pub fn longest_step(&mut self, system: &mut System, t: f64, y: &[f64]) -> f64 {
        system.look_at_turns(t, y, &mut self.from);
        self.from.longest_step()
    }

    /// Looks at the angles at both ends of a step; returns a bound of the turn of their markers
    /// within it, rad. `acceleration`: a bound of that of the free coordinates, rad per time².
    pub fn turn_within(
        &mut self,
        system: &mut System,
        (t0, t1): (f64, f64),
        (n, acceleration): (usize, f64),
        state_at: &mut StateAt<'_>,
    ) -> f64 {
        let (from, next, state) = (&mut self.from, &mut self.next, &mut self.state);
        state.resize(n, 0.0);
        self.h = t1 - t0;
        for (t, look) in [(t0, &mut *from), (t1, &mut *next)] {
            if state_at(system, t, state) {
                system.look_at_turns(t, state, look);
            }
        }
        let driven = from.driven_acceleration.max(next.driven_acceleration);
        // what grows and falls again within the step is at its largest near the middle
        let fastest = from.speed.max(next.speed) + 0.25 * self.h * (acceleration + driven);
        fastest * self.h
    }

    /// Divides the step at whose ends angles were looked at, by the bound of their turn in it.
    pub fn divide(&mut self, turn: f64) {
        let intervals = Look::intervals(turn);
        let (t0, h) = (self.from.t, self.h);
        let place = |k: usize| t0 + h * (k as f64 / intervals as f64);
        self.ahead.clear();
        self.ahead.extend((1..intervals).rev().map(place));
    }

    /// Counts angles up to a time in the step.
    pub fn count(&mut self, system: &mut System, until: f64, state_at: &mut StateAt<'_>) {
        while let Some(t) = self.ahead.pop_if(|t| *t < until) {
            self.follow(system, t, state_at);
        }
        self.follow(system, until, state_at);
    }

    /// Takes over the angles at a time, by as many looks on the way as that takes.
    fn follow(&mut self, system: &mut System, to: f64, state_at: &mut StateAt<'_>) {
        let (from, next, state) = (&mut self.from, &mut self.next, &mut self.state);
        self.halves.clear();
        self.halves.push(to);
        while let Some(&t) = self.halves.last() {
            if state_at(system, t, state) {
                system.look_at_turns(t, state, next);
                let interval = t - from.t;
                if !from.leads_to(next) && interval > SHORTEST_INTERVAL * self.h {
                    self.halves.push(from.t + 0.5 * interval);
                    continue;
                }
                system.take_turns(next);
                std::mem::swap(from, next);
            }
            self.halves.pop();
        }
    }
}
