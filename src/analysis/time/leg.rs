//! The loop over the steps of one method.
//!
//! ```text
//! step → rows that were left out still hold? same branch? → switched? → outputs on the interpolant
//!      → samples, memory, sensors → other rows? → begin anew where something changed
//! ```
//!
//! A step over a switch is never kept: it is undone and repeated so that it ends where the branch
//! changes, from where the method begins anew. Accuracy therefore does not fall when a kink lies
//! inside a step. [`switches`](crate::analysis::time::switches) locates it.

use crate::analysis::system::System;
use crate::analysis::system::past;
use crate::analysis::time::counting::Counting;
use crate::analysis::time::downstream::Downstream;
use crate::analysis::time::energy::Accountant;
use crate::analysis::time::leg_peaks::PeaksWithin;
use crate::analysis::time::output::Output;
use crate::analysis::time::ranks::{Side, Sides};
use crate::analysis::time::states::Node;
use crate::analysis::time::switches::{self, Switches, Verdict};
use crate::analysis::time::trial::{Trial, Watched};
use crate::analysis::trajectory::{Ended, Trajectory};
use crate::analysis::watch::Watch;
use crate::numeric::{Memory, Method, Noise, Reason, Step, Stop, Weights};
use crate::scene::broken::Broken;

/// Attempted steps after which a run must have come further by [`STALLED_PART`], at most and at
/// least.
const STALLED_STEPS: [usize; 2] = [20_000, 500];
/// The same for large models, as operations of evaluations of the rate: some seconds.
const STALLED_OPERATIONS: usize = 300_000_000;
/// Part of the duration, see [`STALLED_STEPS`]: a run that does not come further would not end.
const STALLED_PART: f64 = 1e-8;
/// Attempted steps, and operations in them over the evaluations in each, at least, before
/// mechanisms that nothing couples are taken apart: recording an operation costs as much as running
/// it some thousand times, and below some milliseconds nobody waits.
const STEPS_TOGETHER: usize = 300;
const OPERATIONS_TOGETHER: usize = 1_500_000;
/// Events from which on that is enough, and by how much more it has to be with fewer: then steps of
/// each may still be those of all.
const EVENTS_TOGETHER: usize = 32;
const WITHOUT_EVENTS: usize = 10;
/// Shortest way that is looked ahead for bodies and the past, as a part of the time left.
const LEAST_HORIZON: f64 = 1e-6;
/// The same for delays that shrink to nothing.
const LEAST_DELAY: f64 = 1e-9;

/// The reason why a method does not go on to the end.
pub(super) enum Finished {
    /// the analysis ends
    Ended(Ended),
    /// another method would do better from here
    Stiff,
    /// the other method may do better: this one's pace
    Tries(f64),
    /// the method that was tried does no better
    Dearer,
    /// branches have changed: what was stiff may be so no longer
    Eased,
    /// other rows are to be kept from here, or the state has been put onto all of them
    Rows(Vec<f64>),
    /// mechanisms that nothing couples would do better each by itself
    Parts,
}

impl From<Stop> for Finished {
    fn from(stop: Stop) -> Self {
        Finished::Ended(Ended::Stop(stop))
    }
}

/// Limits of a leg: they do not change while it lasts.
pub(super) struct Limits<'a> {
    /// where the method begins
    pub start: f64,
    /// where the analysis is to end
    pub end: f64,
    /// attempted steps permitted
    pub max_steps: usize,
    /// what a method of the same kind has left where this one begins; `None`: it begins anew
    pub memory: Option<&'a Memory>,
    /// errors that another method has permitted so far, where this one goes on with them
    pub weights: Option<&'a Weights>,
    /// what this one has known of rounding, where it works again
    pub noise: Option<&'a Noise>,
    /// whether another method may take over where stability limits the steps
    pub may_change: bool,
    /// whether another method is tried, or this one
    pub trial: Trial,
    /// whether this one is explicit
    pub is_explicit: bool,
    /// changes of branches after which the method before may try again; zero: never
    pub returns_after: usize,
    /// whether mechanisms that nothing couples may go on each by itself
    pub may_part: bool,
}

/// The part of an integration that one method does.
pub(super) struct Leg<'a> {
    pub(super) system: &'a mut System,
    pub(super) watch: &'a mut dyn Watch,
    pub(super) limits: Limits<'a>,
    /// results, and the output times: those that are still to come may change
    pub(super) out: &'a mut Trajectory,
    pub(super) outputs: &'a mut Vec<f64>,
    /// the states downstream of the mechanism; `None`: there are none
    pub(super) downstream: Option<&'a mut Downstream>,
    switches: Switches,
    /// end of the next step, when something has been located inside the one before
    pub(super) landing: f64,
    /// how often in a row the step was halved because of rows that are left out
    pub(super) halved: usize,
    /// the state before the step, where there are rows   (n)
    pub(super) before: Vec<f64>,
    /// a state at an output within the step   (n)
    pub(super) between: Vec<f64>,
    /// angles whose turns are counted
    pub(super) counting: Counting,
    /// what tells branches of loops from each other; `None`: not needed so far
    pub(super) sides: Option<Sides>,
    /// the end of the last step at which they were looked at, and the rows there
    pub(super) last_look: Option<(Node, Side)>,
    /// attempted steps, and the time, when the run last came further
    progressed: (usize, f64),
    /// attempted steps after which it must have come further
    stalled_steps: usize,
    /// changes of branches so far
    changes: usize,
    watched: Watched,
    /// narrow peaks within the step under way
    peaks: PeaksWithin,
    accountant: Accountant,
    /// how far the present step may go
    limit: f64,
    /// whether it has to end at an output time
    lands_for_output: bool,
}

/// The decision about a step that was taken.
enum Judged {
    /// it was undone; the next one ends at [`Leg::landing`]
    Undone,
    /// it stays
    Kept {
        /// a branch ends at its end
        switched: bool,
        /// the row among those left out that is violated, and by how much
        violated: Option<(usize, f64)>,
    },
}

fn attempted(method: &dyn Method<System>) -> usize {
    method.stats().steps + method.stats().rejected
}

/// Returns the unknown that changes fastest.
fn fastest(ydot: &[f64]) -> usize {
    let largest = (ydot.iter().enumerate()).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    largest.map_or(0, |(i, _)| i)
}

impl<'a> Leg<'a> {
    /// Prepares a leg of a method whose state has `size` numbers.
    pub fn new(
        system: &'a mut System,
        watch: &'a mut dyn Watch,
        limits: Limits<'a>,
        (out, outputs): (&'a mut Trajectory, &'a mut Vec<f64>),
        (downstream, size): (Option<&'a mut Downstream>, usize),
    ) -> Self {
        let has_rows = !system.scene.rows.is_empty();
        let [most, least] = STALLED_STEPS;
        let affordable = STALLED_OPERATIONS / system.operations().max(1);
        Self {
            switches: Switches::new(system, size, limits.end - limits.start),
            landing: limits.end,
            halved: 0,
            before: vec![0.0; if has_rows { size } else { 0 }],
            between: Vec::new(),
            counting: Counting::default(),
            sides: None,
            last_look: None,
            progressed: (0, limits.start),
            stalled_steps: affordable.clamp(least, most),
            changes: 0,
            watched: Watched::new(limits.trial, limits.is_explicit, system),
            peaks: PeaksWithin::new(system, limits.end - limits.start),
            accountant: Accountant::default(),
            limit: limits.end,
            lands_for_output: false,
            system,
            watch,
            limits,
            out,
            outputs,
            downstream,
        }
    }

    /// Integrates from `y` to the end, or until something else has to be done first.
    pub fn run(&mut self, method: &mut dyn Method<System>, y: &[f64]) -> Result<(), Finished> {
        self.start(method, y)?;
        while method.t() < self.limits.end {
            self.check(method)?;
            let Some(step) = self.step(method)? else {
                continue;
            };
            let Judged::Kept { switched, violated } = self.judge(method, &step)? else {
                continue;
            };
            let anew = self.accept(method, &step)?;
            let mut switched = switched || anew > step.t1;
            // before a sample changes what held during the step
            switched |= self.remember(method, &step);
            switched |= self.sample(method, &step);
            let (reacted, stepsize) = self.sense(method, &step, switched)?;
            switched |= reacted;
            self.keep_rows(method, &step, violated)?;
            if switched && step.t1 < self.limits.end {
                self.begin_anew(method, &step, anew, stepsize)?;
                self.changes += 1;
                if self.changes == self.limits.returns_after && !self.switches.slide() {
                    return Err(Finished::Eased);
                }
            }
            if self.parts(method) && step.t1 < self.limits.end {
                return Err(Finished::Parts);
            }
            if step.t1 < self.limits.end {
                if self.limits.may_change && method.stiff() {
                    return Err(Finished::Stiff);
                }
                if let Some(other) = self.watched.judge(self.system, method) {
                    return Err(other);
                }
            }
        }
        Ok(())
    }

    /// Returns whether mechanisms that nothing couples had better go on each by itself: that all
    /// take the steps of each, and begin anew at its events, has cost what taking them apart does.
    fn parts(&self, method: &dyn Method<System>) -> bool {
        // outputs cost evaluations, but no step
        let steps = self.out.stats.steps + self.out.stats.rejected + attempted(method);
        let more = match self.out.events >= EVENTS_TOGETHER {
            true => 1,
            false => WITHOUT_EVENTS,
        };
        self.limits.may_part
            && steps >= more * STEPS_TOGETHER
            && steps.saturating_mul(self.system.operations_of_a_step())
                >= more * OPERATIONS_TOGETHER
    }

    /// Starts the method on the branches that hold at the state.
    fn start(&mut self, method: &mut dyn Method<System>, y: &[f64]) -> Result<(), Finished> {
        let t = self.limits.start;
        self.switches.start(self.system, t, y);
        method.start(self.system, t, y)?;
        if let Some(memory) = self.limits.memory {
            method.go_on(memory);
        }
        if let Some(weights) = self.limits.weights {
            method.take_weights(weights.clone());
        }
        if let Some(noise) = self.limits.noise {
            method.take_noise(noise.clone());
        }
        self.look_ahead(method)?;
        if let Some(h) = self.sense_beginning(method)? {
            method.propose(h);
        }
        self.peaks.begin(self.system, method);
        self.downstream_begins_anew();
        self.system.take_weak();
        self.progressed = (attempted(method), method.t());
        self.out.runaway.begin();
        Ok(())
    }

    /// Ends a run that comes no further or runs away, that the caller ends, or that slides where it
    /// must not.
    fn check(&mut self, method: &dyn Method<System>) -> Result<(), Finished> {
        if attempted(method) > self.progressed.0 + self.stalled_steps {
            let duration = self.limits.end - self.limits.start;
            if method.t() - self.progressed.1 < STALLED_PART * duration {
                let (t, h) = (method.t(), 0.0);
                let reason = Reason::Stalled(fastest(method.ydot()));
                return Err(Stop { reason, t, h }.into());
            }
            let steps = attempted(method) - self.progressed.0;
            let advanced = method.t() - self.progressed.1;
            let span = (method.t(), self.limits.end);
            if let Some(away) = self.out.runaway.judge(span, steps, advanced) {
                return Err(Finished::Ended(Ended::RunsAway(away)));
            }
            self.progressed = (attempted(method), method.t());
        }
        if self.watch.interrupted() {
            return Err(Finished::Ended(Ended::Interrupted));
        }
        Ok(())
    }

    /// Takes one step, no further than anything asks; `None`: none was possible while branches were
    /// held, and they were let go.
    fn step(&mut self, method: &mut dyn Method<System>) -> Result<Option<Step>, Finished> {
        let horizon = self.horizon(method);
        let horizon = horizon.min(method.t() + self.switches.longest_step());
        let limit = std::mem::replace(&mut self.landing, self.limits.end).min(horizon);
        self.limit = limit;
        if !self.before.is_empty() {
            self.before.copy_from_slice(method.y());
        }
        match method.step(self.system, limit) {
            Ok(step) => Ok(Some(step)),
            Err(stop) => {
                let may_try = attempted(method) < self.limits.max_steps;
                if may_try && self.switches.let_go(self.system) {
                    let state = method.y().to_vec();
                    if (method.reinitialize(self.system, stop.t, &state)).is_ok() {
                        return Ok(None);
                    }
                }
                Err(stop.into())
            }
        }
    }

    /// Returns how far a step may go: no further than values of the past are known, not over a
    /// sample, not over a time event, and not through a body.
    fn horizon(&mut self, method: &dyn Method<System>) -> f64 {
        let (t, y, end) = (method.t(), method.y(), self.limits.end);
        let turn = self.system.branches().longest_turn(y, method.ydot());
        let unseen = self.system.longest_unseen(t, y).min(turn);
        let unseen = unseen.max(LEAST_HORIZON * (end - t));
        // however near, it must be further on
        let event =
            (self.system.recorded.time_events.next(t, end)).max(t + 4.0 * f64::EPSILON * t.abs());
        let turned = self.longest_turn(t, y);
        let due = self
            .system
            .recorded
            .samples
            .due()
            .min(t + unseen)
            .min(event)
            .min(turned);
        if self.system.recorded.external.delays.is_empty() {
            return due;
        }
        self.system.set(t, y);
        let delay = self
            .system
            .recorded
            .external
            .delays
            .shortest_delay(&self.system.numbers);
        due.min(t + delay.max(LEAST_DELAY * (end - t)))
    }

    /// Keeps a step, or undoes it so that the next one ends where something changes within it.
    fn judge(&mut self, method: &mut dyn Method<System>, step: &Step) -> Result<Judged, Finished> {
        // rows that are left out
        let violated = self.violated(method, step);
        if self.shortens(violated, step) {
            method.undo();
            self.halve(step)?;
            return Ok(Judged::Undone);
        }
        // branches that only come near each other
        if self.leaves_branch(method, step) {
            method.undo();
            self.go_nearer(step)?;
            return Ok(Judged::Undone);
        }
        self.halved = 0;
        // angles that decide forces by the wrong turn, and narrow peaks
        let lost = self.loses_turn(method, step);
        if let Some(t) = lost.or_else(|| self.peaks.hidden(self.system, method, step)) {
            method.undo();
            self.landing = t;
            return Ok(Judged::Undone);
        }
        // switches
        let verdict = self.switches.judge(self.system, method, step);
        if let Verdict::Redo(at) = verdict {
            method.undo();
            self.landing = at;
            return Ok(Judged::Undone);
        }
        // output times at which the method cannot say what the state was
        if let Some(t) = self.unreadable(method, step) {
            method.undo();
            (self.landing, self.lands_for_output) = (t, true);
            return Ok(Judged::Undone);
        }
        // contacts of curves that end
        if let Some((t, broken)) = self.broken(method, step) {
            self.emit(method, &Step { t1: t, ..*step }, t)?;
            return Err(Finished::Ended(Ended::Broken { t, broken }));
        }
        let switched = verdict == Verdict::Switched;
        Ok(Judged::Kept { switched, violated })
    }

    /// Returns when in an accepted step a contact of curves ends, and which.
    fn broken(&mut self, method: &mut dyn Method<System>, step: &Step) -> Option<(f64, Broken)> {
        let end = self.limits.end;
        let mut found = self.system.broken(step.t1, method.y(), end)?;
        let (mut whole, mut ended) = (step.t0, step.t1);
        let mut state = method.y().to_vec();
        // to rounding
        while ended - whole > 4.0 * f64::EPSILON * ended.abs().max(step.h) {
            let middle = 0.5 * (whole + ended);
            if middle <= whole || middle >= ended {
                break;
            }
            if method.interpolate(self.system, middle, &mut state).is_err() {
                break;
            }
            match self.system.broken(middle, &state, end) {
                Some(broken) => (ended, found) = (middle, broken),
                None => whole = middle,
            }
        }
        Some((whole, found))
    }

    /// Puts out what lies within a step; the time from which it goes on: the first one behind a
    /// time event at its end.
    fn accept(&mut self, method: &mut dyn Method<System>, step: &Step) -> Result<f64, Finished> {
        let behind = self.system.recorded.time_events.behind(step.t1);
        let anew = behind.unwrap_or(step.t1).min(self.limits.end);
        self.peaks.keep(method);
        self.emit(method, step, anew)?;
        self.account(method, step);
        self.out.last_step = Some((step.t1, step.h));
        self.watch.progress(step.t1, step.h, method.stats());
        self.watch.visit(self.system, step.t1, method.y());
        self.watch.collect(self.system, self.out);
        Ok(anew)
    }

    /// Adds an accepted step to the accounts of energy and of what limited steps.
    fn account(&mut self, method: &mut dyn Method<System>, step: &Step) {
        let duration = (self.limits.start, self.limits.end);
        let looked =
            (self.accountant).account(&mut self.out.energy, self.system, method, step, duration);
        let (now, duration) = ((attempted(method), step.t1), duration.1 - duration.0);
        let system = &mut *self.system;
        let kinetic = || {
            let energy = looked.or_else(|| system.energy(now.1, method.y()))?;
            Some(energy[0])
        };
        self.out.runaway.see(now, duration, kinetic);
        if step.t1 >= self.limit && self.limit < self.limits.end {
            let limited = &mut self.out.limited;
            match self.lands_for_output {
                true => limited.outputs += 1,
                false => limited.events += 1,
            }
        }
        self.lands_for_output = false;
    }

    /// Takes the samples that are due; whether a discrete state has changed.
    fn sample(&mut self, method: &dyn Method<System>, step: &Step) -> bool {
        if !(self.system.recorded.samples.is_due(step.t1)
            && self.system.sample(step.t1, method.y()))
        {
            return false;
        }
        // discrete states are new from the sample on, the sample itself included
        if let (Some(&t), Some(row)) = (self.out.t.last(), self.out.rows.last_mut())
            && self.system.recorded.samples.is_together(t, step.t1)
        {
            *row = self.system.row(t, method.y());
        }
        true
    }

    /// Keeps what is asked of the past; whether the interpolant had no value.
    fn remember(&mut self, method: &mut dyn Method<System>, step: &Step) -> bool {
        !self.system.recorded.external.delays.is_empty()
            && (self.system).aside(|system| past::remember(system, method, step).is_err())
    }

    /// Does what triggered sensors ask for; whether the method is to begin anew, and with which
    /// step.
    fn sense(
        &mut self,
        method: &dyn Method<System>,
        step: &Step,
        switched: bool,
    ) -> Result<(bool, Option<f64>), Finished> {
        let triggered = self.system.sense(step.t1, method.y(), switched);
        self.react_to(&triggered, method, step.t1)
    }

    /// Does what triggered sensors ask for at a time; returns as [`sense`](Self::sense) does.
    fn react_to(
        &mut self,
        triggered: &[usize],
        method: &dyn Method<System>,
        t: f64,
    ) -> Result<(bool, Option<f64>), Finished> {
        let (mut reacted, mut stepsize) = (false, None);
        for &k in triggered {
            if let Some(h) = self.system.scene.sensors[k].stepsize {
                stepsize = Some(stepsize.map_or(h, |other: f64| other.min(h)));
            }
            reacted |= self.react(k, method, t)?;
        }
        Ok((reacted, stepsize))
    }

    /// Does what a triggered sensor asks for; whether the integration is to begin anew.
    fn react(&mut self, k: usize, method: &dyn Method<System>, t: f64) -> Result<bool, Finished> {
        let sensor = self.system.scene.sensors[k].clone();
        let ends = sensor.halt || sensor.end_simulation;
        if (ends || sensor.print) && self.out.t.last() != Some(&t) {
            let row = self.system.row(t, method.y());
            self.out.push(t, row);
            // outputs are counted: one that was not foreseen takes a place
            self.outputs.insert(self.out.t.len() - 1, t);
        }
        self.out.triggered.push((t, k));
        if let Some(dt) = sensor.dt {
            self.outputs.truncate(self.out.t.len());
            let times = Output::Every(dt).times(t, self.limits.end);
            self.outputs.extend(times);
        }
        if ends {
            return Err(Finished::Ended(Ended::Sensor(k)));
        }
        Ok(sensor.restart || sensor.stepsize.is_some() || sensor.evaluate.is_some())
    }

    /// Begins anew at the end of a step, on the branches that hold from there on.
    fn begin_anew(
        &mut self,
        method: &mut dyn Method<System>,
        step: &Step,
        anew: f64,
        stepsize: Option<f64>,
    ) -> Result<(), Finished> {
        self.out.events += 1;
        self.out.event_times.push(step.t1);
        let mut state = method.y().to_vec();
        let without_end = switches::never_end(&self.out.event_times, self.limits.end)
            .then(|| self.switches.changes_most(self.system, anew, &state));
        self.switches.change(self.system, anew, &mut state);
        if let Some(worst) = without_end
            .flatten()
            .or(self.switches.endless(anew, self.limits.end))
        {
            let (reason, t, h) = (Reason::Endless(worst), step.t1, step.h);
            return Err(Stop { reason, t, h }.into());
        }
        method.reinitialize(self.system, anew, &state)?;
        self.look_ahead(method)?;
        let stepsize = self.sense_beginning(method)?.or(stepsize);
        self.peaks.begin(self.system, method);
        self.downstream_begins_anew();
        // after the method has begun anew, which chooses a step of its own
        if let Some(h) = stepsize {
            method.propose(h);
        }
        Ok(())
    }

    /// Does what sensors ask for that are triggered by the branches on which a method begins;
    /// returns the step that they ask for.
    fn sense_beginning(
        &mut self,
        method: &mut dyn Method<System>,
    ) -> Result<Option<f64>, Finished> {
        let (t, y) = (method.t(), method.y().to_vec());
        let triggered = self.system.sense_beginning(t, &y);
        let (reacted, stepsize) = self.react_to(&triggered, method, t)?;
        if reacted {
            method.reinitialize(self.system, t, &y)?;
            self.look_ahead(method)?;
        }
        Ok(stepsize)
    }

    /// Looks ahead where a method begins, and lets it begin again when the branches turn out to be
    /// others.
    fn look_ahead(&mut self, method: &mut dyn Method<System>) -> Result<(), Stop> {
        let (t, y) = (method.t(), method.y().to_vec());
        if (self.switches).look_ahead(self.system, t, &y, method.ydot()) {
            method.reinitialize(self.system, t, &y)?;
        }
        Ok(())
    }
}
