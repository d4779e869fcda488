//! The limit of work: where a session was when its processor time had been used, and what made it
//! slow.

use super::stop_reason::StopReason;
use super::{Analysis, Session};
use crate::analysis::look::Look;
use crate::analysis::system::System;
use crate::analysis::time::output::Output;
use crate::analysis::trajectory::{SETS_STEPS, Trajectory};
use crate::analysis::watch::Watch;
use crate::analysis::work_limit::{Limited, WorkLimit};
use crate::diagnostic::{Diagnostic, Error, counted};
use crate::numeric::{Ode, Stats};
use crate::results::{self, Kind, Status};
use crate::scene::layout::Layout;
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A phase of setting up a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SetUp {
    /// the model is read
    Reading,
    /// the scene is compiled
    Compiling,
    /// positions are assembled
    Assembling,
    /// velocities are found
    Velocities,
    /// the equations are written as programs
    Recording,
    /// the columns of results are written as programs
    Columns,
}

impl SetUp {
    /// All phases, in their order.
    const ALL: [SetUp; 6] = [
        SetUp::Reading,
        SetUp::Compiling,
        SetUp::Assembling,
        SetUp::Velocities,
        SetUp::Recording,
        SetUp::Columns,
    ];
}

impl fmt::Display for SetUp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            SetUp::Reading => "the model was read",
            SetUp::Compiling => "the model was compiled",
            SetUp::Assembling => "its positions were assembled",
            SetUp::Velocities => "its velocities were found",
            SetUp::Recording => "its equations were recorded",
            SetUp::Columns => "the columns of its results were compiled",
        })
    }
}

/// The last phase of setting up that a session has done, for other threads to see.
#[derive(Clone, Debug, Default)]
pub struct Activity(Arc<AtomicUsize>);

impl Activity {
    fn set(&self, done: SetUp) {
        self.0.store(done as usize, Ordering::Relaxed);
    }
}

impl fmt::Display for Activity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match SetUp::ALL.get(self.0.load(Ordering::Relaxed)) {
            Some(done) => write!(f, "the last that had been done is that {done}"),
            None => f.write_str("nothing had been done"),
        }
    }
}

/// The place that a session had reached when its limit of work ended it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Reached {
    /// it was setting up a simulation, and had just done this
    SetUp(SetUp),
    /// it looked for an equilibrium
    Rest {
        /// at this time
        at: f64,
        /// steps of the search
        steps: usize,
    },
    /// it moved
    Motion {
        /// end of the last step
        at: f64,
        /// time at which the simulation was to end
        end: f64,
        /// name of the method
        method: String,
        /// length of the last step
        step: f64,
        /// accepted steps
        steps: usize,
        /// why these were short, if that is known
        slow: Option<Slow>,
        /// name of the unknown that changes fastest
        fastest: String,
    },
}

/// A reason for short steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Slow {
    /// part of the steps that stability limited
    Stability(f64),
    /// part of the attempts that were rejected
    Rejected(f64),
    /// part of the steps at whose end a branch changed
    Events(f64),
}

impl fmt::Display for Slow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |share: f64| 100.0 * share;
        match self {
            Slow::Stability(share) => write!(
                f,
                "stability limited {:.0} % of them: the model is stiff, RADAU5 may take longer ones",
                percent(*share)
            ),
            Slow::Rejected(share) => write!(f, "{:.0} % of the attempts failed", percent(*share)),
            Slow::Events(share) => write!(
                f,
                "a function changed its branch in {:.0} % of them",
                percent(*share)
            ),
        }
    }
}

impl fmt::Display for Reached {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reached::SetUp(done) => write!(f, "when {done}; the simulation had not begun"),
            Reached::Rest { at, steps } => {
                write!(
                    f,
                    "in the search for an equilibrium at time {at}, after {}",
                    counted(*steps, "step")
                )
            }
            Reached::Motion {
                at,
                end,
                method,
                step,
                steps,
                slow,
                fastest,
            } => {
                write!(
                    f,
                    "at time {at} of {end} with {method}, after {}, the last of {step:.3e}",
                    counted(*steps, "step")
                )?;
                if let Some(slow) = slow {
                    write!(f, "; {slow}")?;
                }
                if !fastest.is_empty() {
                    write!(f, "; {fastest} changes fastest")?;
                }
                Ok(())
            }
        }
    }
}

impl Session {
    /// Runs one simulation up to `end` with output steps as they are asked for.
    ///
    /// Where [`Options::limit`](super::Options::limit) has been used up it ends with
    /// [`Status::Limit`].
    ///
    /// # Errors
    /// Those of [`Session::simulate`], and distances of output times that are not positive.
    pub fn simulate_with(
        &mut self,
        analysis: Analysis,
        end: f64,
        output: Output,
        watch: &mut dyn Watch,
    ) -> Result<Status, Error> {
        let outcome = match self.limit {
            Some(limit) => {
                let mut limited = Limited::new(watch, limit);
                self.simulate_within(analysis, end, output, &mut limited)
            }
            None => self.simulate_within(analysis, end, output, watch),
        };
        match self.ended_early.take() {
            Some(why) => Ok(self.close_set_up(analysis, why)),
            None => outcome,
        }
    }

    /// Notes that a phase of setting up is done; refuses to go on when the limit of work has been
    /// reached, or the caller asks to stop.
    ///
    /// # Errors
    /// The reason, of which [`Session::simulate_with`] makes a status.
    pub(super) fn may_go_on(
        &mut self,
        done: SetUp,
        watch: &mut dyn Watch,
    ) -> Result<(), Vec<Diagnostic>> {
        self.looking(done, watch, |_, look| look())
    }

    /// Does a part of setting up after the phase `done`, which lets the caller look on its way.
    ///
    /// # Errors
    /// Those of the work; or the reason why it is not to go on, once that was the answer to a look.
    pub(super) fn looking<T>(
        &mut self,
        done: SetUp,
        watch: &mut dyn Watch,
        work: impl FnOnce(&mut Self, Look<'_>) -> Result<T, Vec<Diagnostic>>,
    ) -> Result<T, Vec<Diagnostic>> {
        self.activity.set(done);
        let limit = self.limit;
        let mut ended: Option<StopReason> = None;
        let refusal = |why: &StopReason| vec![Diagnostic::error(why.code(), why.to_string())];
        let outcome = work(self, &mut || {
            if ended.is_none() {
                ended = match limit.filter(|limit| limit.left() <= 0.0) {
                    Some(WorkLimit { seconds, .. }) => {
                        let reached = Reached::SetUp(done);
                        Some(StopReason::WorkLimit { seconds, reached })
                    }
                    None => watch.interrupted().then_some(StopReason::Interrupted),
                };
            }
            ended.as_ref().map_or(Ok(()), |why| Err(refusal(why)))
        });
        match ended {
            None => outcome,
            Some(why) => {
                let refused = refusal(&why);
                self.ended_early = Some(why);
                Err(refused)
            }
        }
    }

    /// Adds a simulation to the record that ended before it began.
    fn close_set_up(&mut self, analysis: Analysis, why: StopReason) -> Status {
        let kind = match analysis {
            Analysis::Kinematic => Kind::Kinematic,
            Analysis::Dynamic | Analysis::Transient => Kind::Dynamic,
            Analysis::Static => Kind::Static,
            Analysis::InitialConditions => Kind::InitialConditions,
        };
        self.close(results::Simulation::new(kind, self.time()), Some(why))
    }

    fn is_over_limit(&self) -> bool {
        self.limit.is_some_and(|limit| limit.left() <= 0.0)
    }

    fn over(&self, reached: Reached) -> StopReason {
        let seconds = self.limit.map_or(0.0, |limit: WorkLimit| limit.seconds);
        StopReason::WorkLimit { seconds, reached }
    }

    /// Returns why a search for an equilibrium was interrupted.
    pub(super) fn ended_at_rest(&self, at: f64, stats: &Stats) -> StopReason {
        if !self.is_over_limit() {
            return StopReason::Interrupted;
        }
        let steps = stats.steps;
        self.over(Reached::Rest { at, steps })
    }

    /// Returns why a simulation over time to `end` was interrupted.
    pub(super) fn ended_on_the_way(
        &self,
        system: &mut System,
        trajectory: &Trajectory,
        end: f64,
    ) -> StopReason {
        if !self.is_over_limit() {
            return StopReason::Interrupted;
        }
        let stats = &trajectory.stats;
        let (at, step) = trajectory.last_step.unwrap_or((self.time(), 0.0));
        let method = trajectory.methods.last();
        self.over(Reached::Motion {
            at,
            end,
            method: method.map_or_else(String::new, |m| m.1.clone()),
            step,
            steps: stats.steps,
            slow: slow(stats, trajectory.events),
            fastest: fastest(system),
        })
    }
}

/// Returns why steps were short, as far as their counts tell it.
fn slow(stats: &Stats, events: usize) -> Option<Slow> {
    let share = |count: usize, of: usize| count as f64 / of.max(1) as f64;
    let reasons = [
        Slow::Stability(share(stats.stability_limited, stats.steps)),
        Slow::Events(share(events, stats.steps)),
        Slow::Rejected(share(stats.rejected, stats.steps + stats.rejected)),
    ];
    reasons.into_iter().find(|reason| match reason {
        Slow::Stability(share) | Slow::Events(share) | Slow::Rejected(share) => *share > SETS_STEPS,
    })
}

/// Returns the name of the unknown that changes fastest, over its own size, where the system
/// stands; empty: nothing moves, or nobody can tell.
fn fastest(system: &mut System) -> String {
    let l = system.scene.layout;
    let there = system.numbers[l.y()].to_vec();
    let (mut typical, mut rates) = (vec![0.0; there.len()], vec![0.0; there.len()]);
    Ode::typical(system, &mut typical);
    let t = system.numbers[Layout::TIME];
    if Ode::rate(system, t, &there, &mut rates).is_err() {
        return String::new();
    }
    let paces = rates.iter().zip(&there).zip(&typical);
    let paces = paces.map(|((rate, y), typical)| rate.abs() / y.abs().max(*typical));
    let largest = paces
        .enumerate()
        .filter(|(_, pace)| *pace > 0.0 && pace.is_finite())
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let name = largest.and_then(|(k, _)| system.scene.unknown_names().get(k).cloned());
    name.unwrap_or_default()
}
