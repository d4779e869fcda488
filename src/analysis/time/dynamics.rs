//! The only loop over time: steps, events, outputs.
//!
//! ```text
//! step → switched? → redo up to the switch, restart there → outputs on the interpolant → turns of counted angles
//! ```
//!
//! A step over a switch is never kept: it is undone and repeated so that it ends where the branch changes, from where the
//! method begins anew. Accuracy therefore does not fall when a kink lies inside a step. [`switches`](crate::analysis::time::switches) knows how.

use crate::analysis::system::System;
use crate::analysis::system::external_inputs;
use crate::analysis::time::output::Output;
use crate::analysis::time::ranks;
use crate::analysis::time::switches::{Switches, Verdict};
use crate::numeric::{self, Failure, Method, Ode, Reason, Stats, Step, Stop};
use crate::scene::cams::Broken;

/// What a caller may do while time passes.
pub trait Watch {
    /// Whether to stop now.
    fn interrupted(&mut self) -> bool {
        false
    }
    /// How far it is.
    fn progress(&mut self, _t: f64, _h: f64, _stats: &Stats) {}
}

/// Watches nothing.
pub struct Unwatched;
impl Watch for Unwatched {}

/// What is asked of an integration.
#[derive(Clone, Debug)]
pub struct Options {
    /// E, permitted local error
    pub error: f64,
    /// name of a method of [`numeric::METHODS`], or "AUTO"
    pub method: String,
    /// what AUTO begins with: see [`first_method`]
    pub first: String,
    /// first step
    pub h_initial: Option<f64>,
    /// longest step
    pub h_max: f64,
    /// shortest step
    pub h_min: f64,
    /// highest order
    pub max_order: Option<usize>,
    /// Newton iterations
    pub max_newton: Option<usize>,
    /// attempted steps
    pub max_steps: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            error: 1e-6,
            method: "AUTO".into(),
            first: "DOP853".into(),
            h_initial: None,
            h_max: f64::INFINITY,
            h_min: 0.0,
            max_order: None,
            max_newton: None,
            max_steps: usize::MAX,
        }
    }
}

/// The method that does what an INTEGRATOR name of Adams asks for, or the one so named here.
///
/// GSTIFF, WSTIFF and their kin are backward differentiation of low order; what they are taken for, stiff systems with modest requests,
/// RADAU5 does with fewer steps and without their damping (BDF is there by its own name). ABAM and RKF45 are explicit.
pub fn method_named(name: &str) -> String {
    match name.to_ascii_uppercase().as_str() {
        "GSTIFF" | "WSTIFF" | "HASTIFF" | "CONSTANT_BDF" => "RADAU5".into(),
        "ABAM" | "RKF45" => "DOP853".into(),
        other => other.to_string(),
    }
}

/// Why an integration ended before its time.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// the caller asked
    Interrupted,
    /// the method could not go on
    Stop(Stop),
    /// a sensor asked: its place in [`Scene::sensors`](crate::scene::Scene::sensors)
    Sensor(usize),
    /// a contact of curves ends
    Broken {
        /// when
        t: f64,
        /// which, and what to do
        broken: Broken,
    },
}

/// States at the output times that were reached.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// output times reached
    pub t: Vec<f64>,
    /// all numbers (t | q | v | x | turns) at each
    pub rows: Vec<Vec<f64>>,
    /// what it cost
    pub stats: Stats,
    /// the methods that worked, in order, with the time at which each took over
    pub methods: Vec<(f64, String)>,
    /// switches that were located: how many
    pub events: usize,
    /// sensors that were triggered: when, and their places in the scene
    pub triggered: Vec<(f64, usize)>,
    /// states (all numbers) about positions where rows are nearly dependent; `None` separates what does not follow on
    pub weak: Vec<Option<Vec<f64>>>,
    /// choices of rows after the first: the row of results from which each holds, when it was made, and which rows take part
    pub selections: Vec<(usize, f64, Vec<bool>)>,
    /// a row that was left out no longer followed from the others: when it was restored, and its index
    pub restored: Vec<(f64, usize)>,
    /// `None`: all output times were reached
    pub ended: Option<Ended>,
}

fn add(sum: &mut Stats, more: &Stats) {
    sum.steps += more.steps;
    sum.rejected += more.rejected;
    sum.evaluations += more.evaluations;
    sum.jacobians += more.jacobians;
    sum.factorizations += more.factorizations;
    sum.newton_iterations += more.newton_iterations;
    sum.below_rounding += more.below_rounding;
}

/// Integrates from the state in `system.numbers` through all `outputs` (ascending, after the state's time).
pub fn integrate(
    system: &mut System,
    outputs: &[f64],
    options: &Options,
    watch: &mut dyn Watch,
) -> Trajectory {
    let mut out = Trajectory::default();
    let n = Ode::size(system);
    let t0 = system.numbers[0];
    let mut y = system.numbers[system.scene.layout.y()].to_vec();
    let Some(&end) = outputs.last() else {
        return out;
    };
    let mut outputs = outputs.to_vec();
    system.precision = options.error;
    system.external.begin(t0, &[]);
    system.restart_sampling();
    system.begin_sensing();
    if n == 0 {
        timeless(system, &outputs, options.max_steps, &mut out);
        return out;
    }
    let settings = numeric::Options {
        tolerance: options.error,
        h_initial: options.h_initial,
        h_max: options.h_max,
        h_min: options.h_min,
        max_order: options.max_order.unwrap_or(5),
        max_newton: options.max_newton.unwrap_or(10),
        max_steps: options.max_steps,
        ..numeric::Options::default()
    };
    let landings = system.landings(t0, end);
    let auto = options.method.eq_ignore_ascii_case("AUTO");
    let mut name = if auto {
        options.first.clone()
    } else {
        options.method.to_ascii_uppercase()
    };
    let mut t = t0;
    let mut restarts = 0;
    loop {
        let size = system.implicit_size();
        y.resize(n.max(size), 0.0);
        let Some(mut method) = numeric::ode_method::<System>(&name, n, &settings)
            .or_else(|| numeric::dae_method::<System>(&name, size, &settings))
        else {
            out.ended = Some(Ended::Stop(Stop {
                reason: Reason::TooManySteps,
                t,
                h: 0.0,
            }));
            return out;
        };
        if out.methods.last().is_none_or(|m| m.1 != name) {
            out.methods.push((t, name.clone()));
        }
        let mut leg = Leg {
            system,
            outputs: &mut outputs,
            landings: &landings,
            end,
            most: options.max_steps,
            out: &mut out,
            watch,
        };
        let state = if numeric::is_implicit(&name) {
            &y[..]
        } else {
            &y[..n]
        };
        let explicit = auto && name == "DOP853";
        let finished = leg.run(
            method.as_mut(),
            t,
            state,
            explicit,
            !numeric::is_implicit(&name),
        );
        add(&mut out.stats, method.stats());
        system.release();
        match finished {
            Finished::Done => return out,
            Finished::Ended(why) => {
                // where it stopped is part of the results
                let t = method.t();
                if matches!(why, Ended::Stop(_))
                    && out.t.last().is_none_or(|&last| last < t)
                    && t > t0
                {
                    out.t.push(t);
                    out.rows.push(system.row(t, method.y()));
                }
                out.ended = Some(why);
                return out;
            }
            Finished::Rows(state) => {
                restarts += 1;
                if restarts > RESTARTS {
                    let (reason, t, h) = (Reason::TooManySteps, method.t(), 0.0);
                    out.ended = Some(Ended::Stop(Stop { reason, t, h }));
                    return out;
                }
                t = method.t();
                // multipliers are found anew
                y.resize(n, 0.0);
                y.copy_from_slice(&state[..n]);
            }
            Finished::Stiff | Finished::Slides => {
                t = method.t();
                y.resize(n, 0.0);
                y.copy_from_slice(&method.y()[..n]);
                name = "RADAU5".into();
            }
        }
    }
}

/// A model without unknowns: time passes, and what is sampled changes.
fn timeless(system: &mut System, outputs: &[f64], most: usize, out: &mut Trajectory) {
    for &t in outputs {
        loop {
            let due = system.samples.due();
            if due > t {
                break;
            }
            out.stats.steps += 1;
            if out.stats.steps > most {
                let (reason, h) = (Reason::TooManySteps, 0.0);
                out.ended = Some(Ended::Stop(Stop { reason, t: due, h }));
                return;
            }
            system.sample(due, &[]);
        }
        out.t.push(t);
        out.rows.push(system.row(t, &[]));
    }
}

/// Restarts with other rows before something is wrong.
const RESTARTS: usize = 10_000;
/// Looks at angles within a step, at most.
const MOST_LOOKS: f64 = 1e6;
/// States kept to find positions where rows become dependent.
const MOST_KEPT: f64 = 2000.0;
/// Most velocities of a mechanism all of whose states are kept for that.
const SMALL: usize = 30;
/// A row that is left out follows from the others when it is smaller than this, relative to what counts as one.
const FOLLOWS: f64 = 1e-8;
/// A step that violates one by more than this is shortened.
const CLOSE: f64 = 1e-6;

/// Steps tried that have to bring a run further than this part of its duration, or it would not end.
const STALLED: (usize, f64) = (20_000, 1e-8);

/// Steps of an explicit method that stability may force before an implicit one is taken from the start.
const STABLE_STEPS: f64 = 2000.0;
/// Largest system whose eigenvalues are looked at.
const LARGEST_LOOK: usize = 120;

/// The method to begin with when the choice is ours: an implicit one where damped modes at the start are so fast that
/// stability, not accuracy, would set the steps of an explicit one.
///
/// Only modes that decay count: an undamped oscillation has to be followed anyway.
pub fn first_method(system: &mut System, duration: f64) -> &'static str {
    let n = Ode::size(system);
    if n == 0 || n > LARGEST_LOOK {
        return "DOP853";
    }
    let t = system.numbers[0];
    let y = system.numbers[system.scene.layout.y()].to_vec();
    let (mut jacobian, mut dfdt) = (vec![0.0; n * n], vec![0.0; n]);
    if Ode::jacobian(system, t, &y, &mut jacobian, &mut dfdt).is_err() {
        return "DOP853";
    }
    let matrix = nalgebra::DMatrix::from_vec(n, n, jacobian);
    let Some(schur) = nalgebra::linalg::Schur::try_new(matrix, f64::EPSILON, 1000) else {
        return "DOP853";
    };
    let fastest = schur
        .complex_eigenvalues()
        .iter()
        .filter(|l| -l.re > 0.03 * l.norm())
        .fold(0.0, |m: f64, l| m.max(l.norm()));
    if fastest * duration > 5.0 * STABLE_STEPS {
        "RADAU5"
    } else {
        "DOP853"
    }
}

/// The unknown that changes fastest.
fn fastest(ydot: &[f64]) -> usize {
    let largest = (ydot.iter().enumerate()).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    largest.map_or(0, |(i, _)| i)
}

enum Finished {
    Done,
    Ended(Ended),
    /// another method would do better from here
    Stiff,
    /// the motion stays where a branch changes, which the method does not know how to do
    Slides,
    /// other rows are to be kept from here, or the state has been put onto all of them
    Rows(Vec<f64>),
}

/// The part of an integration that one method does.
struct Leg<'a> {
    system: &'a mut System,
    outputs: &'a mut Vec<f64>,
    /// times at which steps have to end
    landings: &'a [f64],
    end: f64,
    /// attempted steps permitted
    most: usize,
    out: &'a mut Trajectory,
    watch: &'a mut dyn Watch,
}

impl Leg<'_> {
    fn run(
        &mut self,
        method: &mut dyn Method<System>,
        t: f64,
        y: &[f64],
        may_change: bool,
        may_slide: bool,
    ) -> Finished {
        let mut switches = Switches::new(self.system, y.len(), self.end - t);
        switches.start(self.system, t, y);
        if let Err(stop) = method.start(self.system, t, y) {
            return Finished::Ended(Ended::Stop(stop));
        }
        if let Err(stop) = self.begin(method, &mut switches) {
            return Finished::Ended(Ended::Stop(stop));
        }
        // end of the next step, when a switch has been located inside the one before
        let mut landing = self.end;
        let mut halved = 0;
        let has_rows = !self.system.scene.rows.is_empty();
        let mut before = vec![0.0; if has_rows { y.len() } else { 0 }];
        self.system.take_weak();
        let duration = self.end - t;
        let tried = |method: &dyn Method<System>| method.stats().steps + method.stats().rejected;
        let mut was_at = (tried(method), method.t());
        while method.t() < self.end {
            if tried(method) > was_at.0 + STALLED.0 {
                if method.t() - was_at.1 < STALLED.1 * duration {
                    let (t, h) = (method.t(), 0.0);
                    let reason = Reason::Stalled(fastest(method.ydot()));
                    return Finished::Ended(Ended::Stop(Stop { reason, t, h }));
                }
                was_at = (tried(method), method.t());
            }
            if self.watch.interrupted() {
                return Finished::Ended(Ended::Interrupted);
            }
            // also where it begins
            if switches.slide() && !may_slide {
                return Finished::Slides;
            }
            let horizon = self.horizon(method);
            let limit = std::mem::replace(&mut landing, self.end).min(horizon);
            let passed = self.landings.partition_point(|&l| l <= method.t());
            let limit = self.landings.get(passed).map_or(limit, |&l| limit.min(l));
            if has_rows {
                before.copy_from_slice(method.y());
            }
            let step = match method.step(self.system, limit) {
                Ok(step) => step,
                Err(stop) => {
                    let spent = method.stats().steps + method.stats().rejected;
                    if spent < self.most && switches.let_go(self.system) {
                        let state = method.y().to_vec();
                        if method.reinitialize(self.system, stop.t, &state).is_ok() {
                            continue;
                        }
                    }
                    return Finished::Ended(Ended::Stop(stop));
                }
            };
            let off = self.system.worst_left_out(step.t1, method.y());
            let off = off.filter(|off| off.1.is_nan() || off.1 > FOLLOWS);
            if let Some((_, size)) = off
                && size > CLOSE
                && step.t1 - step.t0 > 1e-12 * self.end.abs().max(step.t1.abs())
                && halved < 40
            {
                // beyond a position where the others leave two ways and this row one
                halved += 1;
                method.undo();
                if self.choose(step.t0, &before) {
                    return Finished::Rows(before);
                }
                landing = step.t0 + 0.5 * (step.t1 - step.t0);
                continue;
            }
            halved = 0;
            let verdict = switches.judge(self.system, method, &step);
            if let Verdict::Redo(at) = verdict {
                method.undo();
                landing = at;
                continue;
            }
            if let Some(t) = self.unreadable(method, &step) {
                method.undo();
                landing = t;
                continue;
            }
            if let Some((t, broken)) = self.broken(method, &step) {
                self.emit(method, &Step { t1: t, ..step }, t);
                return Finished::Ended(Ended::Broken { t, broken });
            }
            // what breaks here at a fixed time: the state stays, the time is the first one behind
            let behind = self.system.time_events.behind(step.t1);
            let anew = behind.unwrap_or(step.t1).min(self.end);
            self.emit(method, &step, anew);
            self.watch.progress(step.t1, step.h, method.stats());
            let mut switched = verdict == Verdict::Switched || anew > step.t1;
            if self.system.is_sampled(step.t1) && self.system.sample(step.t1, method.y()) {
                switched = true;
                // discrete states are new from the sample on, the sample itself included
                if let (Some(&t), Some(row)) = (self.out.t.last(), self.out.rows.last_mut())
                    && self.system.is_together(t, step.t1)
                {
                    *row = self.system.row(t, method.y());
                }
            }
            if self.system.external.remembers()
                && external_inputs::remember(self.system, method, &step).is_err()
            {
                switched = true;
            }
            let mut stepsize: Option<f64> = None;
            for k in self.system.sense(step.t1, method.y(), switched) {
                if let Some(h) = self.system.scene.sensors[k].stepsize {
                    stepsize = Some(stepsize.map_or(h, |other| other.min(h)));
                }
                switched |= self.react(k, method, step.t1);
                if let Some(why) = self.out.ended.take() {
                    return Finished::Ended(why);
                }
            }
            if has_rows && let Some(finished) = self.rows(method, &before, step.t0, off) {
                return finished;
            }
            if switched && step.t1 < self.end {
                self.out.events += 1;
                let mut state = method.y().to_vec();
                switches.change(self.system, anew, &mut state);
                if let Some(worst) = switches.endless() {
                    let (reason, t, h) = (Reason::Endless(worst), step.t1, step.h);
                    return Finished::Ended(Ended::Stop(Stop { reason, t, h }));
                }
                if let Err(stop) = method
                    .reinitialize(self.system, anew, &state)
                    .and_then(|()| self.begin(method, &mut switches))
                {
                    return Finished::Ended(Ended::Stop(stop));
                }
                // after the method has begun anew, which chooses a step of its own
                if let Some(h) = stepsize {
                    method.propose(h);
                }
            }
            if may_change && method.stiff() && method.t() < self.end {
                return Finished::Stiff;
            }
        }
        Finished::Done
    }

    /// How far a step may go: no further than values of the past are known, not over a sample, not over what time alone
    /// brings, and not through a body.
    fn horizon(&mut self, method: &dyn Method<System>) -> f64 {
        let (t, y) = (method.t(), method.y());
        let turn = self.system.longest_turn(y, method.ydot());
        let unseen = self.system.longest_unseen(t, y).min(turn);
        let unseen = unseen.max(1e-6 * (self.end - t));
        // however near, it must be further on
        let moment = self
            .system
            .time_events
            .next(t, self.end)
            .max(t + 4.0 * f64::EPSILON * t.abs());
        let due = self.system.samples.due().min(t + unseen).min(moment);
        if !self.system.external.remembers() {
            return due;
        }
        self.system.set(t, y);
        let delay = self.system.external.shortest_delay(&self.system.numbers);
        due.min(t + delay.max(1e-9 * (self.end - t)))
    }

    /// Does what a triggered sensor asks for; whether the integration is to begin anew.
    fn react(&mut self, k: usize, method: &mut dyn Method<System>, t: f64) -> bool {
        let sensor = self.system.scene.sensors[k].clone();
        let ends = sensor.halt || sensor.end_simulation;
        if (ends || sensor.print) && self.out.t.last() != Some(&t) {
            self.out.t.push(t);
            self.out.rows.push(self.system.row(t, method.y()));
            // outputs are counted: one that was not foreseen takes a place
            self.outputs.insert(self.out.t.len() - 1, t);
        }
        self.out.triggered.push((t, k));
        if ends {
            self.out.ended = Some(Ended::Sensor(k));
        }
        if let Some(dt) = sensor.dt {
            self.outputs.truncate(self.out.t.len());
            self.outputs.extend(Output::Every(dt).times(t, self.end));
        }
        sensor.restart || sensor.stepsize.is_some() || sensor.evaluate.is_some()
    }

    /// The first output time inside an accepted step at which the method cannot say what the state was: a step has to end there.
    fn unreadable(&mut self, method: &mut dyn Method<System>, step: &Step) -> Option<f64> {
        let t = *self
            .outputs
            .get(self.out.t.len())
            .filter(|&&t| t < step.t1)?;
        let mut state = method.y().to_vec();
        let failed = method.interpolate(self.system, t, &mut state).is_err();
        (failed && t > step.t0).then_some(t)
    }

    /// When in an accepted step a contact of curves ends, and which.
    fn broken(&mut self, method: &mut dyn Method<System>, step: &Step) -> Option<(f64, Broken)> {
        let mut found = self.system.broken(step.t1, method.y(), self.end)?;
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
            match self.system.broken(middle, &state, self.end) {
                Some(broken) => (ended, found) = (middle, broken),
                None => whole = middle,
            }
        }
        Some((whole, found))
    }

    /// Looks after the rows at the end of an accepted step: notes where they are nearly dependent, chooses others, restores one that no longer follows.
    fn rows(
        &mut self,
        method: &dyn Method<System>,
        before: &[f64],
        t0: f64,
        off: Option<(usize, f64)>,
    ) -> Option<Finished> {
        let (t, weak) = (method.t(), self.system.take_weak());
        let l = self.system.scene.layout;
        let mut numbers = self.system.numbers.clone();
        let mut at = |t: f64, y: &[f64]| {
            numbers[0] = t;
            numbers[l.y()].copy_from_slice(&y[..l.y().len()]);
            numbers.clone()
        };
        let kept = &mut self.out.weak;
        // all states of small mechanisms, else those where an evaluation has found rows nearly dependent; looking at one costs n³
        let most = (1e8 / (l.n_v as f64).powi(3)).clamp(60.0, MOST_KEPT) as usize;
        if kept.len() < most && (weak || l.n_v <= SMALL) {
            let follows = kept
                .last()
                .and_then(Option::as_ref)
                .is_some_and(|n| n[0] == t0);
            if !follows {
                kept.push(None);
                kept.push(Some(at(t0, before)));
            }
            kept.push(Some(at(t, method.y())));
        }
        if let Some((row, _)) = off {
            let mut numbers = at(t, method.y());
            if !ranks::repair(&self.system.scene, &mut numbers) {
                let what = Failure {
                    what: row,
                    recoverable: false,
                };
                let (reason, h) = (Reason::Projection(what), method.t() - t0);
                return Some(Finished::Ended(Ended::Stop(Stop { reason, t, h })));
            }
            self.out.restored.push((t, row));
            let y = numbers[l.y()].to_vec();
            self.choose(t, &y);
            return Some(Finished::Rows(numbers[l.y()].to_vec()));
        }
        if weak && self.system.watches_rows() && self.choose(t, method.y()) {
            return Some(Finished::Rows(method.y().to_vec()));
        }
        None
    }

    /// Chooses other rows where they are better; tells whether it did.
    fn choose(&mut self, t: f64, y: &[f64]) -> bool {
        let l = self.system.scene.layout;
        self.system.numbers[0] = t;
        self.system.numbers[l.y()].copy_from_slice(&y[..l.y().len()]);
        let Some(active) = ranks::better_rows(&self.system.scene, &self.system.numbers) else {
            return false;
        };
        let chosen = (self.out.rows.len(), t, active.clone());
        if self.system.reselect(active).is_err() {
            return false;
        }
        self.out.selections.push(chosen);
        true
    }

    /// Looks ahead where a method begins, and lets it begin again when the branches turn out to be others.
    fn begin(
        &mut self,
        method: &mut dyn Method<System>,
        switches: &mut Switches,
    ) -> Result<(), Stop> {
        let (t, y) = (method.t(), method.y().to_vec());
        if switches.look_ahead(self.system, t, &y, method.ydot()) {
            method.reinitialize(self.system, t, &y)?;
        }
        Ok(())
    }

    /// A bound of how fast any angle turns within a step, rad per time: at its ends it may stand still.
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

    /// Output times inside an accepted step, and up to `until` just behind it; the turns at its end.
    fn emit(&mut self, method: &mut dyn Method<System>, step: &numeric::Step, until: f64) {
        let counts = self.system.counts_turns();
        let mut state = method.y().to_vec();
        // while an angle is followed it must not turn by more than half a turn between looks
        let mut looks = if counts {
            (self.spin_within(method, step) * step.h / 1.5)
                .ceil()
                .min(MOST_LOOKS) as usize
        } else {
            0
        };
        if looks > 0 {
            looks += 1;
        }
        let mut look = 1;
        while let Some(&t) = self.outputs.get(self.out.t.len()) {
            if t > until {
                break;
            }
            while look < looks && step.t0 + step.h * look as f64 / looks as f64 <= t {
                let at = step.t0 + step.h * look as f64 / looks as f64;
                if method.interpolate(self.system, at, &mut state).is_ok() {
                    self.system.count_turns(at, &state);
                }
                look += 1;
            }
            if t >= step.t1 {
                state.copy_from_slice(method.y());
            } else if method.interpolate(self.system, t, &mut state).is_err() {
                // tried before the step was accepted: a method that could say it once can say it again
                state.fill(f64::NAN);
            }
            if counts {
                self.system.count_turns(t, &state);
            }
            self.out.t.push(t);
            self.out.rows.push(self.system.row(t, &state));
        }
        if counts {
            while look < looks {
                let at = step.t0 + step.h * look as f64 / looks as f64;
                if method.interpolate(self.system, at, &mut state).is_ok() {
                    self.system.count_turns(at, &state);
                }
                look += 1;
            }
            self.system.count_turns(step.t1, method.y());
        }
    }
}
