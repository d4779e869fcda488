//! Integration over time: one method after another, each as far as it is the right one.
//!
//! `Leg` is the loop over the steps of one method. Here it is decided with which method, and
//! with which rows, the next leg begins.

use crate::analysis::system::System;
use crate::analysis::time::downstream::Downstream;
use crate::analysis::time::energy;
use crate::analysis::time::leg::{Finished, Leg, Limits};
use crate::analysis::time::options::Options;
use crate::analysis::time::trial::{self, Trial};
use crate::analysis::trajectory::{Ended, Takeover, Trajectory};
use crate::analysis::watch::Watch;
use crate::numeric::{Memory, Method, Noise, Ode, Reason, Stop, Weights};
use crate::scene::layout::Layout;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Restarts with other rows before something is wrong.
const MAX_ROW_RESTARTS: usize = 10_000;
/// Steps of an explicit method after which stiffness is not what it found at once.
const STEPS_WITHOUT_STIFFNESS: usize = 60;

/// The method that works, and what decides on the next one.
struct Course<'a> {
    options: &'a Options,
    name: String,
    /// why it works
    why: Takeover,
    /// restarts with other rows so far
    restarts: usize,
    /// changes of branches after which the explicit method tries again; zero: never
    patience: usize,
    /// trials so far, of the implicit method and of the explicit one
    trials: [u32; 2],
    /// pace of the other method, where this one is tried
    pace: Option<f64>,
    /// what a trial leaves to the method that begins: what the other one left there, and the errors
    /// that were permitted
    tried: Option<(Memory, Weights)>,
    /// what the explicit method knows of rounding
    noise: Option<Noise>,
}

impl<'a> Course<'a> {
    /// Begins with the method that is asked for; without unknowns all are one, and any will do.
    fn new(options: &'a Options, n: usize) -> Self {
        let name = match n {
            0 => "DOP853".into(),
            _ => options.first_name(),
        };
        Course {
            options,
            name,
            why: Takeover::Begins,
            restarts: 0,
            patience: usize::from(options.goes_on_stiff),
            trials: [0; 2],
            pace: None,
            tried: None,
            noise: None,
        }
    }

    /// Returns what the simulation before leaves to the method that begins.
    fn memory(&self) -> Option<&Memory> {
        if let Some((memory, _)) = &self.tried {
            return Some(memory);
        }
        let begins = self.why == Takeover::Begins && self.restarts == 0;
        let (name, memory) = self.options.left.as_ref().filter(|_| begins)?;
        (*name == self.name).then_some(memory)
    }

    /// Returns whether the method is the explicit one.
    fn is_explicit(&self) -> bool {
        self.name == "DOP853"
    }

    /// Returns whether stiffness may change the method.
    fn may_change(&self) -> bool {
        self.options.is_auto() && self.is_explicit()
    }

    /// Returns what is tried.
    fn trial(&self) -> Trial {
        let trials = self.trials[usize::from(!self.is_explicit())];
        match self.pace {
            Some(pace) => Trial::Against(pace, trials),
            None if self.options.is_auto() => Trial::After(trials),
            None => Trial::No,
        }
    }

    /// Returns the name of the other method.
    fn other(&self) -> String {
        if self.is_explicit() {
            "RADAU5"
        } else {
            "DOP853"
        }
        .into()
    }

    /// Returns after how many changes of branches the explicit method tries again; zero: never.
    ///
    /// A body that touches is stiff while it does. Where the explicit method finds the same
    /// stiffness at once, it is let try half as often.
    fn returns_after(&self) -> usize {
        if !self.is_explicit() {
            self.patience
        } else {
            0
        }
    }

    /// Chooses the next method after one that has not come to the end.
    ///
    /// # Errors
    /// The reason why there is none.
    fn go_on(&mut self, finished: Finished, method: &mut dyn Method<System>) -> Result<(), Ended> {
        let (pace, tried) = (self.pace.take(), self.tried.take());
        if let Some(noise) = method.noise() {
            self.noise = Some(noise.clone());
        }
        (self.name, self.why) = match finished {
            Finished::Ended(why) => return Err(why),
            Finished::Parts => unreachable!("what is taken apart goes on elsewhere"),
            Finished::Rows(_) => {
                self.restarts += 1;
                if self.restarts > MAX_ROW_RESTARTS {
                    return Err(gave_up(method.t()));
                }
                self.pace = pace;
                return Ok(());
            }
            Finished::Tries(pace) => {
                self.trials[usize::from(!self.is_explicit())] += 1;
                self.pace = Some(pace);
                self.tried = method.leave().map(|left| (left, method.weights().clone()));
                (self.other(), Takeover::Cheaper)
            }
            Finished::Dearer => {
                self.tried = tried.map(|(left, _)| (left, method.weights().clone()));
                (self.other(), Takeover::Cheaper)
            }
            Finished::Stiff => {
                self.tried = method.leave().map(|left| (left, method.weights().clone()));
                self.patience = if method.stats().steps > STEPS_WITHOUT_STIFFNESS {
                    1
                } else {
                    (2 * self.patience).max(1)
                };
                ("RADAU5".into(), Takeover::Stiff)
            }
            Finished::Eased => ("DOP853".into(), Takeover::Eased),
        };
        Ok(())
    }
}

/// Integrates from the state in `system.numbers` through all `outputs` (ascending, after the
/// state's time).
pub fn integrate(
    system: &mut System,
    outputs: &[f64],
    options: &Options,
    watch: &mut dyn Watch,
) -> Trajectory {
    let mut out = Trajectory::default();
    let Some(&end) = outputs.last() else {
        return out;
    };
    let mut downstream = Downstream::new(system, end, options);
    go(
        (system, downstream.as_mut()),
        (outputs, end),
        options,
        watch,
        &mut out,
    );
    out.downstream = downstream.map(|downstream| downstream.work());
    out
}

/// Integrates from the state in `system.numbers` through further `outputs`, behind what a
/// trajectory has; states downstream of the mechanism there may be none.
pub(in crate::analysis) fn go_on(
    system: &mut System,
    outputs: &[f64],
    options: &Options,
    watch: &mut dyn Watch,
    out: &mut Trajectory,
) {
    let Some(&end) = outputs.last() else { return };
    let before = std::mem::take(&mut out.energy);
    go((system, None), (outputs, end), options, watch, out);
    out.energy = before.followed_by(&out.energy);
}

/// Integrates a mechanism to the end, and what is downstream beside it.
fn go(
    (system, mut downstream): (&mut System, Option<&mut Downstream>),
    (outputs, end): (&[f64], f64),
    options: &Options,
    watch: &mut dyn Watch,
    out: &mut Trajectory,
) {
    let n = Ode::size(system);
    let t0 = system.numbers[Layout::TIME];
    let mut y = system.numbers[system.scene.layout.y()].to_vec();
    system.precision = options.error;
    system.recorded.external.delays.begin(t0, &BTreeMap::new());
    system.restart_sampling();
    system.begin_sensing();
    // steps without unknowns are too long for works along them
    if n > 0 {
        energy::begin(&mut out.energy, system, t0, &y);
    }
    let first = out.t.len();
    let mut outputs = [&out.t[..], outputs].concat();
    let mut course = Course::new(options, n);
    system.expect_outputs(outputs.len() - first, false);
    let mut t = t0;
    loop {
        let attempted = out.stats.steps + out.stats.rejected;
        let max_steps = options.max_steps.saturating_sub(attempted);
        let limited = (end - t0, max_steps);
        let Some(mut method) = options.new_method(&course.name, system, limited) else {
            out.ended = Some(gave_up(t));
            return;
        };
        out.begin_method(t, &course.name, course.why);
        // steps, as far as it goes
        let limits = Limits {
            start: t,
            end,
            max_steps,
            memory: course.memory(),
            weights: course.tried.as_ref().map(|tried| &tried.1),
            noise: course.tried.as_ref().and(course.noise.as_ref()),
            may_change: course.may_change(),
            returns_after: course.returns_after(),
            may_part: options.may_part,
            trial: course.trial(),
            is_explicit: course.is_explicit(),
        };
        let beside = (downstream.as_deref_mut(), y.len());
        let mut leg = Leg::new(system, watch, limits, (out, &mut outputs), beside);
        let finished = leg.run(method.as_mut(), &y);
        out.add_cost(method.stats());
        out.operations += trial::cost(system, course.is_explicit(), method.stats());
        system.branches_mut().release();
        // another method, or other rows
        let Err(mut finished) = finished else {
            let memory = method.leave();
            out.left = memory.map(|memory| (course.name, Arc::new(memory)));
            return;
        };
        y.copy_from_slice(match &finished {
            Finished::Rows(state) => &state[..n],
            _ => &method.y()[..n],
        });
        if matches!(finished, Finished::Parts) {
            out.parted = Some(system.row(method.t(), &y));
            return;
        }
        // a method that was tried leaves it to the other one to go on
        if course.pace.is_some() && matches!(finished, Finished::Ended(Ended::Stop(_))) {
            finished = Finished::Dearer;
        }
        if matches!(finished, Finished::Dearer) {
            out.forget_method();
        }
        if let Err(why) = course.go_on(finished, method.as_mut()) {
            end_there(system, method.as_ref(), why, t0, out);
            return;
        }
        t = method.t();
    }
}

fn gave_up(t: f64) -> Ended {
    let (reason, h) = (Reason::TooManySteps, 0.0);
    Ended::Stop(Stop { reason, t, h })
}

/// Ends a trajectory; the place where a method could not go on is part of the results.
fn end_there(
    system: &mut System,
    method: &dyn Method<System>,
    why: Ended,
    t0: f64,
    out: &mut Trajectory,
) {
    let t = method.t();
    if matches!(why, Ended::Stop(_)) && out.ends_before(t) && t > t0 {
        let row = system.row(t, method.y());
        out.push(t, row);
    }
    out.ended = Some(why);
}
