//! The method that costs less: where one has cost much, the other one is tried.
//!
//! ```text
//! pace       time that passed / operations that it took
//! one        |------ c ------|         |----------- 2c -----------|         and so on
//!                   its pace |         |
//! the other                  |- trial -|  goes on where its pace is the greater one,
//!                                         and tries the first one after a cost of c
//! ```
//!
//! The reason for short steps need not be known: it may be modes that decay, which the explicit
//! method notices itself (`runge_kutta.rs`), or fast ones that vibrate, hardly damped, and less
//! than any error that is asked for. A method waits twice as long before each further
//! trial, so that all of them cost a small part of the run. Operations are counted, not timed, so
//! that there are the same bits on every run.

use super::leg::Finished;
use crate::analysis::system::System;
use crate::numeric::{Dop853, Method, Stats};

/// Cost of a method over that of a trial, from which on the other one is tried for the first time.
const COSTS_BEFORE: f64 = 40.0;
/// Steps of a trial: the first half finds their length, the second is compared.
const STEPS: usize = 10;
/// Finest request at which another method is tried: at finer ones the errors of the implicit
/// method, which is of a lower order, add up to more than those of the explicit one.
const FINEST_REQUEST: f64 = 1e-7;

/// A method's task: whether another one is tried, or it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Trial {
    /// it goes on
    No,
    /// the other one is tried when it is worth it, after so many trials
    After(u32),
    /// it is tried against the pace of the other one, in s per operation; going on, it tries that
    /// one after so many trials
    Against(f64, u32),
}

/// A method that is watched: where it stood when its pace began to count.
#[derive(Clone, Copy, Debug)]
pub(super) struct Watched {
    trial: Trial,
    is_explicit: bool,
    /// operations that are worth a first trial
    worth: f64,
    /// operations so far when it began, or was found to cost less
    begun: f64,
    /// operations so far, and the time
    since: Option<(f64, f64)>,
}

impl Watched {
    /// Watches a method from its beginning on.
    pub fn new(trial: Trial, is_explicit: bool, system: &System) -> Self {
        let is_fine = system.precision < FINEST_REQUEST;
        Self {
            trial: if is_fine { Trial::No } else { trial },
            is_explicit,
            worth: COSTS_BEFORE * STEPS as f64 * cost_of_a_step(system),
            begun: 0.0,
            since: None,
        }
    }

    /// Judges a method after a step: whether another one has to go on.
    pub fn judge(&mut self, system: &mut System, method: &dyn Method<System>) -> Option<Finished> {
        let stats = method.stats();
        match self.trial {
            Trial::No => None,
            Trial::After(trials) => {
                let all = cost(system, self.is_explicit, stats);
                let part =
                    (all - self.begun) / (self.worth * f64::from(2_u32.saturating_pow(trials)));
                if part < 0.5 {
                    return None;
                }
                let pace = self.pace(all, method.t());
                (part >= 1.0).then_some(Finished::Tries(pace))
            }
            Trial::Against(other, trials) => {
                let is_lost = stats.rejected > STEPS;
                if !is_lost && stats.steps < STEPS / 2 {
                    return None;
                }
                let all = cost(system, self.is_explicit, stats);
                let pace = self.pace(all, method.t());
                if !is_lost && stats.steps < STEPS {
                    return None;
                }
                if pace.is_nan() || pace <= other {
                    return Some(Finished::Dearer);
                }
                (self.trial, self.begun, self.since) = (Trial::After(trials), all, None);
                None
            }
        }
    }

    /// Returns the pace since it began to count, which may be now.
    fn pace(&mut self, cost: f64, t: f64) -> f64 {
        let (cost_before, t_before) = *self.since.get_or_insert((cost, t));
        (t - t_before) / (cost - cost_before)
    }
}

/// Returns what a step of an implicit method costs at most, about: with a Jacobian, a factorization
/// and few corrections.
fn cost_of_a_step(system: &System) -> f64 {
    let n = system.scene.layout.n_y();
    // positions are eliminated first
    let m = n.div_ceil(2);
    let evaluations = Dop853::stages() * system.operations_of_a_step();
    let jacobian = system.most_operations_of_a_jacobian();
    (evaluations + jacobian + 5 * m * m * m / 3) as f64
}

/// Returns what a method has cost, in operations.
pub(super) fn cost(system: &mut System, is_explicit: bool, stats: &Stats) -> f64 {
    match is_explicit {
        true => explicit_cost(system, stats),
        false => implicit_cost(system, stats),
    }
}

/// Returns what the explicit method has cost so far: outputs, which may cost evaluations, count for
/// nothing.
fn explicit_cost(system: &System, stats: &Stats) -> f64 {
    let steps = stats.steps + stats.rejected;
    (steps * Dop853::stages() * system.operations_of_a_step()) as f64
}

/// Returns what an implicit method has cost so far.
fn implicit_cost(system: &mut System, stats: &Stats) -> f64 {
    let evaluations = stats.evaluations * system.operations_of_a_step();
    let jacobians = stats.jacobians * system.operations_of_a_jacobian();
    (evaluations + jacobians + stats.algebra) as f64
}
