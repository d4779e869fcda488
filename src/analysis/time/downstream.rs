//! States downstream of the mechanism, integrated beside it: after each accepted step over that
//! step, by a method and in steps of their own.
//!
//! ```text
//! mechanism    |---------- step ----------|------ step ------|      its error alone
//! downstream   |--|---|-------|-----------|--|---------------|      reads the interpolant of the step
//! ```
//!
//! Their steps end where those of the mechanism do, and nowhere because of outputs: the interpolant
//! is smooth within a step only. Where the mechanism begins anew, so do they. The explicit method
//! begins, unless damped modes at the start are too fast for it, and the implicit one takes over
//! where stability limits its steps.

use crate::analysis::system::System;
use crate::analysis::system::downstream::{DownstreamRates, Reading};
use crate::analysis::time::leg::{Finished, Leg};
use crate::analysis::time::options::{self, Options};
use crate::analysis::trajectory::Ended;
use crate::analysis::watch::Watch;
use crate::numeric::pattern::Pattern;
use crate::numeric::{self, Dop853, Failure, Method, Ode, Radau, Reason, Step, Stop};
use crate::scene::layout::Layout;
use std::sync::Arc;

/// Attempted steps after which they must have come further by [`STALLED_PART`] of the duration.
const STALLED_STEPS: usize = 20_000;
/// Part of the duration, see [`STALLED_STEPS`].
const STALLED_PART: f64 = 1e-8;

/// Instants at which the mechanism has been read that are kept: the stages of an implicit step.
const READINGS: usize = 8;

/// The last readings of the mechanism, and its state at an instant.
#[derive(Default)]
struct Readings {
    all: [Reading; READINGS],
    /// the place of the next
    next: usize,
    /// scratch: the state of the mechanism
    y: Vec<f64>,
}

/// The states downstream as a system of their own, within a step of the mechanism.
struct Beside<'a> {
    system: &'a mut System,
    /// the method that has taken the step
    mechanism: &'a mut dyn Method<System>,
    readings: &'a mut Readings,
}

impl Beside<'_> {
    /// Evaluates the rates, where the mechanism has been read at a time within its step.
    fn with_reading<T>(
        &mut self,
        t: f64,
        evaluate: impl FnOnce(&mut DownstreamRates, &Reading) -> Result<T, Failure>,
    ) -> Result<T, Failure> {
        let known = self.readings.all.iter().position(|reading| reading.t == t);
        let place = match known {
            Some(place) => place,
            None => self.read(t)?,
        };
        let Some(rates) = self.system.recorded.downstream.as_deref_mut() else {
            unreachable!("there are states downstream");
        };
        evaluate(rates, &self.readings.all[place])
    }

    /// Reads the mechanism at a time within its step; the place of what was read.
    fn read(&mut self, t: f64) -> Result<usize, Failure> {
        let Readings { all, next, y } = &mut *self.readings;
        if self.system.reads_mechanism_downstream() {
            y.resize(self.mechanism.y().len(), 0.0);
            if t >= self.mechanism.t() {
                y.copy_from_slice(self.mechanism.y());
            } else {
                self.mechanism.interpolate(self.system, t, y)?;
            }
        }
        let place = *next;
        self.system.read_downstream(t, y, &mut all[place])?;
        *next = (place + 1) % READINGS;
        Ok(place)
    }
}

impl Ode for Beside<'_> {
    fn size(&self) -> usize {
        self.system.scene.layout.n_downstream
    }

    fn rate(&mut self, t: f64, x: &[f64], xdot: &mut [f64]) -> Result<(), Failure> {
        self.with_reading(t, |rates, reading| rates.rates(reading, x, xdot))
    }

    fn jacobian(
        &mut self,
        t: f64,
        x: &[f64],
        jacobian: &mut [f64],
        _dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        jacobian.fill(0.0);
        let n = x.len();
        let take = |_, (i, j): (usize, usize), slope| jacobian[i + n * j] = slope;
        self.with_reading(t, |rates, reading| rates.jacobian(reading, x, take))
    }

    fn pattern(&mut self) -> Option<Arc<Pattern>> {
        self.system.recorded.downstream.as_ref()?.pattern()
    }

    fn jacobian_entries(&mut self, t: f64, x: &[f64], entries: &mut [f64]) -> Result<(), Failure> {
        let take = |e: usize, _, slope| entries[e] = slope;
        self.with_reading(t, |rates, reading| rates.jacobian(reading, x, take))
    }

    fn typical(&self, typical: &mut [f64]) {
        typical.fill(1.0);
    }
}

/// Why they go no further.
enum Halt {
    /// the caller asked
    Interrupted,
    /// their method could not go on
    Stop(Stop),
}

/// A method for them, whatever step they are within.
type Own = Box<dyn for<'a> Method<Beside<'a>>>;

/// The states downstream on their way.
pub(super) struct Downstream {
    method: Own,
    is_explicit: bool,
    settings: numeric::Options,
    duration: f64,
    /// the states where they are   (n_downstream)
    x: Vec<f64>,
    /// steps of the method before
    steps_before: usize,
    /// whether they have been integrated at all
    has_begun: bool,
    /// whether they begin anew with the next step of the mechanism
    anew: bool,
    readings: Readings,
    /// attempted steps, and the time, when they last came further
    progressed: (usize, f64),
}

impl Downstream {
    /// Prepares the integration up to `end`; `None`: there is nothing downstream.
    pub fn new(system: &System, end: f64, options: &Options) -> Option<Self> {
        let start = system.numbers[Layout::TIME];
        system.recorded.downstream.as_ref()?;
        let x = system.numbers[system.scene.layout.downstream()].to_vec();
        let settings = numeric::Options {
            h_initial: None,
            ..options.settings(end - start, usize::MAX)
        };
        Some(Self {
            method: Box::new(Dop853::new(x.len(), &settings)),
            is_explicit: true,
            settings,
            duration: end - start,
            x,
            steps_before: 0,
            has_begun: false,
            anew: true,
            readings: Readings::default(),
            progressed: (0, start),
        })
    }

    /// Lets them begin anew with the next step: what they read may jump before it.
    pub fn begin_anew(&mut self) {
        self.anew = true;
    }

    /// Returns the states at the end of the last step of the mechanism.
    pub fn states(&self) -> &[f64] {
        &self.x
    }

    /// Returns the method that worked last, and how many steps were taken.
    pub fn work(&self) -> (&'static str, usize) {
        let name = if self.is_explicit { "DOP853" } else { "RADAU5" };
        (name, self.steps_before + self.method.stats().steps)
    }

    /// Follows a step of the mechanism to its end; the states at the times within it, up to the one
    /// before which they could go no further.
    fn follow(
        &mut self,
        (system, mechanism): (&mut System, &mut dyn Method<System>),
        step: &Step,
        times: &[f64],
        watch: &mut dyn Watch,
    ) -> (Vec<Vec<f64>>, Result<(), Ended>) {
        let mut readings = std::mem::take(&mut self.readings);
        readings
            .all
            .iter_mut()
            .for_each(|reading| reading.t = f64::NAN);
        let mut beside = Beside {
            system,
            mechanism,
            readings: &mut readings,
        };
        let mut found = Vec::with_capacity(times.len());
        let halted = self.follow_within(&mut beside, step, times, (watch, &mut found));
        let outcome = halted.map_err(|halt| match halt {
            Halt::Interrupted => Ended::Interrupted,
            Halt::Stop(stop) => Ended::Downstream {
                stop,
                stands: self.stands(&mut beside),
                rates: self.method.ydot().to_vec(),
            },
        });
        self.readings = readings;
        (found, outcome)
    }

    /// Returns all numbers where these states stand, those of the mechanism as far as it is known.
    fn stands(&self, beside: &mut Beside<'_>) -> Vec<f64> {
        let Beside {
            system, mechanism, ..
        } = beside;
        let t = self.method.t();
        let mut y = mechanism.y().to_vec();
        if t < mechanism.t() && mechanism.interpolate(system, t, &mut y).is_err() {
            y.copy_from_slice(mechanism.y());
        }
        let mut numbers = system.numbers.clone();
        let layout = system.scene.layout;
        layout.set_state(&mut numbers, t, &y);
        numbers[layout.downstream()].copy_from_slice(self.method.y());
        numbers
    }

    fn follow_within(
        &mut self,
        beside: &mut Beside<'_>,
        step: &Step,
        times: &[f64],
        (watch, found): (&mut dyn Watch, &mut Vec<Vec<f64>>),
    ) -> Result<(), Halt> {
        self.begin(beside, step.t0)?;
        for &t in times {
            let t = t.min(step.t1);
            self.go_to(beside, t, step.t1, watch)?;
            let mut x = vec![0.0; self.x.len()];
            if t <= step.t0 {
                x.copy_from_slice(&self.x);
            } else if let Err(failure) = self.method.interpolate(beside, t, &mut x) {
                let (reason, t, h) = (Reason::Evaluation(failure), self.method.t(), 0.0);
                return Err(Halt::Stop(Stop { reason, t, h }));
            }
            found.push(x);
        }
        self.go_to(beside, step.t1, step.t1, watch)?;
        self.x.copy_from_slice(self.method.y());
        Ok(())
    }

    /// Begins, or begins anew, where a step of the mechanism does.
    fn begin(&mut self, beside: &mut Beside<'_>, t0: f64) -> Result<(), Halt> {
        if !self.has_begun {
            if self.is_stiff_at(beside, t0) {
                self.method = Box::new(Radau::new(self.x.len(), &self.settings));
                self.is_explicit = false;
            }
            let begun = self.method.start(beside, t0, &self.x);
            begun.map_err(Halt::Stop)?;
            self.has_begun = true;
        } else if self.anew || self.method.t() != t0 {
            let begun = self.method.reinitialize(beside, t0, &self.x);
            begun.map_err(Halt::Stop)?;
        }
        self.anew = false;
        Ok(())
    }

    /// Returns whether damped modes are too fast for an explicit method.
    fn is_stiff_at(&self, beside: &mut Beside<'_>, t: f64) -> bool {
        let Some(rates) = &beside.system.recorded.downstream else {
            return false;
        };
        let pattern = rates.entries();
        let mut entries = vec![0.0; pattern.n_entries()];
        let found = beside.jacobian_entries(t, &self.x, &mut entries);
        found.is_ok() && options::is_stiff_in_parts(&pattern, &entries, self.duration)
    }

    /// Takes steps until a time is reached or passed, none beyond `t1`.
    fn go_to(
        &mut self,
        beside: &mut Beside<'_>,
        t: f64,
        t1: f64,
        watch: &mut dyn Watch,
    ) -> Result<(), Halt> {
        while self.method.t() < t {
            if watch.interrupted() {
                return Err(Halt::Interrupted);
            }
            let now = self.method.t();
            if self.is_explicit && self.method.stiff() {
                self.x.copy_from_slice(self.method.y());
                self.steps_before = self.method.stats().steps;
                self.method = Box::new(Radau::new(self.x.len(), &self.settings));
                self.is_explicit = false;
                self.progressed = (0, now);
                let begun = self.method.start(beside, now, &self.x);
                begun.map_err(Halt::Stop)?;
            }
            let taken = self.method.step(beside, t1);
            taken.map_err(Halt::Stop)?;
            self.check()?;
        }
        Ok(())
    }

    /// Ends a run that comes no further.
    fn check(&mut self) -> Result<(), Halt> {
        let (stats, t) = (self.method.stats(), self.method.t());
        let attempted = stats.steps + stats.rejected;
        if t - self.progressed.1 >= STALLED_PART * self.duration {
            self.progressed = (attempted, t);
        } else if attempted > self.progressed.0 + STALLED_STEPS {
            let rates = self.method.ydot().iter().enumerate();
            let fastest = rates.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
            let reason = Reason::Stalled(fastest.map_or(0, |(k, _)| k));
            return Err(Halt::Stop(Stop { reason, t, h: 0.0 }));
        }
        Ok(())
    }
}

impl Leg<'_> {
    /// Lets the states downstream begin anew where the mechanism does.
    pub(super) fn downstream_begins_anew(&mut self) {
        if let Some(downstream) = &mut self.downstream {
            downstream.begin_anew();
        }
    }

    /// Integrates the states downstream over an accepted step; their values at the output times in
    /// it up to `until`, as far as they got.
    pub(super) fn follow_downstream(
        &mut self,
        method: &mut dyn Method<System>,
        step: &Step,
        until: f64,
    ) -> (Vec<Vec<f64>>, Result<(), Finished>) {
        let Some(downstream) = self.downstream.as_mut() else {
            return (Vec::new(), Ok(()));
        };
        let times = self.outputs.get(self.out.t.len()..).unwrap_or(&[]);
        let times = &times[..times.partition_point(|&t| t <= until)];
        let watch = &mut *self.watch;
        let (found, outcome) =
            (self.system).aside(|system| downstream.follow((system, method), step, times, watch));
        (found, outcome.map_err(Finished::Ended))
    }
}
