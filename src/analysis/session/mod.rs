//! A model and its clock: one simulation after another, each from where the last one ended.
//!
//! A simulation compiles the model as it is now, takes over the state (or assembles the first one), computes, and appends its
//! rows to the run. What goes wrong in numbers is an outcome in the record, with the results so far; what is wrong in the
//! model is an error.

pub mod columns;
mod outcome;
pub mod script;
mod shells;
mod start;
pub mod state;

use super::statics;
use super::system::external_inputs;
use super::time::{drives, kinematics};
use crate::analysis::linear::{self, Linearization};
use crate::analysis::session::columns::Columns;
use crate::analysis::system::System;
use crate::analysis::system::implicit::Formulation;
use crate::analysis::time::dynamics;
use crate::analysis::time::options;
use crate::analysis::time::output::{self, Output};
use crate::analysis::time::trajectory::{Ended, Trajectory};
use crate::analysis::verify::massless::massless;
use crate::analysis::watch::Watch;
use crate::diagnostic::Diagnostic;
use crate::expr::program::Program;
use crate::model::Model;
use crate::numeric;
use crate::results::{self, Event, Kind, Run, Status};
use crate::scene::Scene;
use crate::scene::contacts::Shell;
use outcome::{counts, units};
use start::{Carried, Kept};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::Instant;

/// What SIMULATE asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Analysis {
    /// motions alone move it: position, velocity and acceleration at each output time
    Kinematic,
    /// forces move it
    Dynamic,
    /// an equilibrium, or one at each output time
    Static,
    /// kinematic without freedom, else dynamic
    Transient,
    /// assembled positions and velocities
    InitialConditions,
}

/// How to solve, beyond what the model says. `None`: as the model says, else our default.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// permitted local error
    pub error: Option<f64>,
    /// name of a method
    pub method: Option<String>,
    /// how often to solve, for timing
    pub repeat: usize,
    /// further columns
    pub columns: Vec<String>,
    /// columns of all parts and joints
    pub full: bool,
    /// run motions whose displacement or velocity jumps, piece by piece
    pub piecewise: bool,
    /// keywords of statements that are left out where they are not solved
    pub skip: std::collections::BTreeSet<String>,
    /// take what `USER(…)` would compute as zero
    pub zero_user: bool,
}

/// A model and its clock.
pub struct Session {
    /// the model as it is now
    pub model: Model,
    /// results so far
    pub run: Run,
    options: Options,
    columns: Columns,
    carried: Option<Carried>,
    /// VARIABLEs that commands will change
    changing: BTreeSet<u32>,
    /// what the last simulation ran, for the next one
    kept: Option<Box<Kept>>,
    /// programs of the present scene: of the columns; of energies and rows
    columns_program: Option<Program>,
    account: Option<Program>,
    hooks: Vec<external_inputs::Hook>,
    /// linear systems that commands asked for: name of their file where one was given, and whether matrices are wanted
    pub linear: Vec<(Option<String>, bool, Linearization)>,
    /// states that commands saved, by the names of their files
    pub saved: std::collections::BTreeMap<String, String>,
    /// folders in which RELOAD, and GRAPHICS that contacts name, look for files
    pub folders: Vec<std::path::PathBuf>,
    /// a sensor ended the run, not only its simulation
    halted: bool,
    shells: Option<Arc<BTreeMap<u32, Result<Shell, String>>>>,
}

/// Values of MODE.
const KINEMATIC: u32 = 1;
const INITIAL_CONDITIONS: u32 = 3;
const DYNAMIC: u32 = 4;
const STATIC: u32 = 5;
const LINEAR: u32 = 7;

/// Default error of the integration when nobody says.
const DEFAULT_ERROR: f64 = 1e-6;

impl Session {
    /// Begins with a model; `name` is the base name of its results.
    pub fn new(model: Model, name: &str, options: Options) -> Self {
        let units = units(&model);
        let mut run = Run::new(name, model.title.clone(), units);
        let columns = Columns::new(&model, &mut run, &options.columns, options.full, &|_, _| {
            false
        });
        run.record.repeats = options.repeat.max(1) as u32;
        Self {
            model,
            run,
            options,
            columns,
            carried: None,
            changing: BTreeSet::new(),
            kept: None,
            columns_program: None,
            account: None,
            hooks: Vec::new(),
            linear: Vec::new(),
            saved: std::collections::BTreeMap::new(),
            folders: Vec::new(),
            halted: false,
            shells: None,
        }
    }

    /// Computes what `USER(…)` stands for by a closure.
    ///
    /// `name` is an element ("SFORCE/3"), the text of its ROUTINE, or the first number of `USER(…)`; `inputs` are expressions of the
    /// function language whose values the closure is given, in this order. They may not depend on what it computes. See [`external_inputs::Law`]
    /// for what it has to fill in.
    pub fn register(
        &mut self,
        name: &str,
        inputs: &[&str],
        law: impl Fn(&external_inputs::Call<'_>, &mut [f64]) + Send + Sync + 'static,
    ) {
        self.hooks.push(external_inputs::Hook {
            name: name.to_string(),
            inputs: inputs.iter().map(ToString::to_string).collect(),
            law: std::sync::Arc::new(law),
        });
        if self.carried.is_none() {
            self.choose_columns();
        }
    }

    /// The columns of the results, before there are any.
    fn choose_columns(&mut self) {
        let names: Vec<_> = self
            .hooks
            .iter()
            .map(external_inputs::Hook::as_name)
            .collect();
        let known = |id: u32, user: &crate::model::Formula| {
            let element = format!("REQUEST/{id}");
            names.iter().any(|n| n.stands_for(&element, user))
        };
        let (run, options) = (&mut self.run, &self.options);
        self.columns = Columns::new(&self.model, run, &options.columns, options.full, &known);
    }

    /// Tells which VARIABLEs will be changed between simulations: where their functions are numbers, these stay outside the equations, which then
    /// need not be written anew.
    pub fn will_change(&mut self, variables: impl IntoIterator<Item = u32>) {
        self.changing.extend(variables);
    }

    /// Whether a sensor has ended the run.
    pub fn halted(&self) -> bool {
        self.halted
    }

    /// The clock.
    pub fn time(&self) -> f64 {
        self.carried.as_ref().map_or(0.0, |c| c.t)
    }

    /// Linearizes the model about its present state; before any simulation, about its initial conditions.
    ///
    /// # Errors
    /// What is wrong in the model, and what has no derivatives.
    pub fn linearize(&mut self, wanted: &linear::Wanted) -> Result<Linearization, Vec<Diagnostic>> {
        let inputs = linear::inputs(&self.model, wanted).map_err(|d| vec![d])?;
        let (mut system, assembly) = self.prepare(LINEAR, &inputs)?;
        self.first_facts(&system, &assembly);
        let found = linear::linearize(&mut system, &self.model, wanted)?;
        for line in found.table().lines() {
            self.run.log.push(Event::Info(line.to_string()));
        }
        Ok(found)
    }

    /// Runs one simulation up to `end` with `steps` output steps.
    ///
    /// # Errors
    /// What is wrong in the model. A numerical failure is no error: see the record.
    pub fn simulate(
        &mut self,
        analysis: Analysis,
        end: f64,
        steps: usize,
        watch: &mut dyn Watch,
    ) -> Result<Status, Vec<Diagnostic>> {
        self.simulate_with(analysis, end, Output::Steps(steps), watch)
    }

    /// As [`simulate`](Self::simulate), with output steps as they are asked for.
    ///
    /// # Errors
    /// What is wrong in the model.
    pub fn simulate_with(
        &mut self,
        analysis: Analysis,
        end: f64,
        output: Output,
        watch: &mut dyn Watch,
    ) -> Result<Status, Vec<Diagnostic>> {
        let mode = match analysis {
            Analysis::Kinematic => KINEMATIC,
            Analysis::InitialConditions => INITIAL_CONDITIONS,
            Analysis::Static => STATIC,
            Analysis::Dynamic | Analysis::Transient => DYNAMIC,
        };
        let method = self.integration().method;
        let known = crate::numeric::METHODS.iter().map(|m| m.name);
        if method != "AUTO" && !known.clone().any(|name| name == method) {
            let names: Vec<&str> = known.chain(["AUTO"]).collect();
            return Err(vec![
                Diagnostic::error("method", format!("there is no method `{method}`"))
                    .help(format!("the methods are {}", names.join(", "))),
            ]);
        }
        self.check_settings()?;
        let asked = output.count(self.time(), end);
        if asked > output::MOST {
            return Err(vec![
                Diagnostic::error("unfit_value", format!("{asked} output steps are too many"))
                    .help(format!("a simulation has {} at most", output::MOST)),
            ]);
        }
        let (mut system, assembly) = self.prepare(mode, &[])?;
        let mut analysis = analysis;
        if analysis == Analysis::Transient {
            analysis = if assembly.freedom == 0 {
                Analysis::Kinematic
            } else {
                Analysis::Dynamic
            };
        }
        if analysis == Analysis::Kinematic && assembly.freedom > 0 {
            return Err(vec![
                Diagnostic::error(
                    "freedom",
                    format!(
                        "a kinematic simulation needs a mechanism without freedom; this one has {}",
                        assembly.freedom
                    ),
                )
                .help("drive the remaining freedoms by MOTION, or simulate dynamically"),
            ]);
        }
        if analysis == Analysis::Dynamic && assembly.freedom == 0 {
            self.warn("the mechanism has no freedom: it is moved by its motions alone");
            analysis = Analysis::Kinematic;
        }
        if analysis == Analysis::Kinematic && mode != KINEMATIC {
            (system, _) = self.prepare(KINEMATIC, &[])?;
        }
        if analysis == Analysis::Dynamic && self.carried.is_none() && may_ask(&system.scene) {
            let numbers = &system.numbers;
            let l = system.scene.layout;
            let (q, x) = (&numbers[l.q()], &numbers[l.x()]);
            let massless = massless(&system.scene, &self.model, numbers[0], q, x);
            if !massless.is_empty() {
                return Err(massless);
            }
        }
        if matches!(analysis, Analysis::Kinematic | Analysis::Dynamic) {
            let breaks = drives::breaks(&system.scene, self.time(), end)?;
            let refused = drives::refused(&breaks);
            if !refused.is_empty() && !self.options.piecewise {
                return Err(refused);
            }
            for warning in drives::warnings(&breaks, self.options.piecewise) {
                self.warn(&warning);
            }
            let jumps = breaks.into_iter().filter(|b| b.order < 2);
            self.run.record.piecewise.extend(jumps.map(|b| b.into()));
        }
        self.first_facts(&system, &assembly);
        for warning in &assembly.warnings {
            self.warn(warning);
        }
        for told in &system.scene.warnings {
            let element = told.element.as_deref().unwrap_or("the model");
            self.warn(&format!("{element}: {}", told.message));
        }
        let program = self.columns_program(&system)?;
        let start = self.time();
        let first = system.numbers.clone();
        if self.carried.is_none() || analysis == Analysis::InitialConditions {
            self.run.log.push(Event::InitialConditions {
                time: start,
                iterations: assembly.iterations as u32,
            });
            self.rows(
                Kind::InitialConditions,
                &program,
                std::slice::from_ref(&first),
            );
        }
        let active = system.scene.active.clone();
        let status = match analysis {
            Analysis::InitialConditions => Status::Completed,
            Analysis::Static => self.at_rest(&mut system, (start, end, output), &program, watch),
            _ => self.over_time(&mut system, analysis, (start, end, output), &program, watch),
        };
        if matches!(analysis, Analysis::InitialConditions) {
            self.keep(&system, first);
        }
        if system.scene.active != active {
            // reactions are others
            self.columns_program = None;
        }
        if self.hooks.is_empty() && analysis == Analysis::Dynamic && status == Status::Completed {
            self.kept = Some(Box::new(Kept::new(&self.model, mode, system, assembly)));
        }
        Ok(status)
    }

    /// The program of the columns.
    fn columns_program(&mut self, system: &System) -> Result<Program, Vec<Diagnostic>> {
        if let Some(program) = &self.columns_program {
            return Ok(program.clone());
        }
        let (program, complaints) = self.columns.program(&system.scene);
        for complaint in complaints {
            let mut wanted = self.options.columns.iter();
            if wanted.any(|c| complaint.starts_with(c.as_str())) {
                return Err(vec![Diagnostic::error("unavailable", complaint)]);
            }
            self.warn(&complaint);
        }
        self.columns_program = Some(program.clone());
        Ok(program)
    }

    /// A simulation over time.
    fn over_time(
        &mut self,
        system: &mut System,
        analysis: Analysis,
        (start, end, output): (f64, f64, Output),
        program: &Program,
        watch: &mut dyn Watch,
    ) -> Status {
        let kind = if analysis == Analysis::Kinematic {
            Kind::Kinematic
        } else {
            Kind::Dynamic
        };
        let outputs = output.times(start, end);
        let mut settings = self.integration();
        if settings.method == "AUTO" && kind == Kind::Dynamic {
            settings.first = options::first_method(system, end - start).into();
        }
        self.prepare_implicit(system, &mut settings);
        let name = self
            .model
            .integrator
            .method
            .clone()
            .unwrap_or_else(|| settings.method.clone());
        let formulation = self
            .model
            .integrator
            .formulation
            .clone()
            .unwrap_or_default();
        self.run.log.push(Event::Begin {
            kind,
            integrator: name,
            formulation,
            error: settings.error,
        });
        let first = system.numbers.clone();
        let mut seconds = Vec::new();
        let mut trajectory = Trajectory::default();
        let chosen = system.scene.active.clone();
        for _ in 0..self.options.repeat.max(1) {
            if !trajectory.selections.is_empty() && system.reselect(chosen.clone()).is_err() {
                break;
            }
            system.numbers.copy_from_slice(&first);
            let clock = Instant::now();
            // states go on by integration, which keeps positions on the rows as well
            let l = system.scene.layout;
            let moved =
                l.n_x > 0 || l.n_q > 0 && system.external.remembers() || !system.samples.is_empty();
            trajectory = if kind == Kind::Kinematic && !moved {
                kinematics::trace(system, &outputs, settings.h_max, watch)
            } else {
                dynamics::integrate(system, &outputs, &settings, watch)
            };
            seconds.push(clock.elapsed().as_secs_f64());
        }
        seconds.sort_by(f64::total_cmp);
        let seconds = seconds[seconds.len() / 2];
        self.selected_rows(kind, program, system, &trajectory);
        self.run.log.push(Event::End);
        self.rank_changes(system, chosen, &trajectory);
        let reached = trajectory.t.last().copied().unwrap_or(start);
        for &(t, k) in &trajectory.triggered {
            let sensor = &system.scene.sensors[k];
            let message = format!("SENSOR/{} is triggered at time {t}", sensor.id);
            self.run.log.push(Event::Info(message));
        }
        if let Some(Ended::Sensor(k)) = trajectory.ended {
            self.halted |= system.scene.sensors[k].halt;
        }
        let (status, reason, worst) = self.outcome(system, &trajectory);
        self.drift(system, &first, &trajectory.rows);
        let last = trajectory.rows.last().cloned().unwrap_or(first);
        self.keep(system, last);
        let (below, steps) = (trajectory.stats.below_rounding, trajectory.stats.steps);
        if below > 0 {
            self.warn(&format!(
                "an error of {} is below rounding: it was asked for in vain in {below} of {steps} steps, which are as exact as rounding permits",
                settings.error
            ));
        }
        let counts = counts(&trajectory.stats);
        let mut method = String::new();
        for (k, (t, name)) in trajectory.methods.iter().enumerate() {
            if k > 0 {
                let why = if numeric::is_implicit(&trajectory.methods[k - 1].1) {
                    "the motion stays where a function changes its branch"
                } else {
                    "steps were limited by stiffness"
                };
                method += &format!(", then {name} from {t}, where {why}");
            } else {
                method += name;
            }
        }
        self.run.record.error = Some(settings.error);
        self.close(results::Simulation {
            kind,
            start,
            end: reached,
            outputs: trajectory.rows.len(),
            method,
            status,
            stop_reason: reason,
            solve_seconds: seconds,
            counts,
            worst,
        })
    }

    /// An equilibrium now, or one at each output time up to an `end` that is still to come.
    fn at_rest(
        &mut self,
        system: &mut System,
        (start, end, output): (f64, f64, Output),
        program: &Program,
        watch: &mut dyn Watch,
    ) -> Status {
        let (kind, times) = if end > start {
            (Kind::QuasiStatic, output.times(start, end))
        } else {
            (Kind::Static, vec![start])
        };
        let settings = statics::Settings::of(&self.model.equilibrium);
        let first = system.numbers.clone();
        let clock = Instant::now();
        let mut stats = crate::numeric::Stats::default();
        let mut rows = Vec::new();
        let mut words = String::new();
        let mut failed = None;
        for &t in &times {
            let y = system.numbers[system.scene.layout.y()].to_vec();
            let numbers = system.row(t, &y);
            system.numbers.copy_from_slice(&numbers);
            match statics::settle(system, &settings, watch, &mut stats) {
                Ok(found) => {
                    self.run.log.push(Event::Static {
                        time: t,
                        iterations: found.iterations as u32,
                        imbalance: found.imbalance,
                    });
                    words = format!("EQUILIBRIUM, {}", found.stability.words());
                    if found.stability.unstable > 0 {
                        self.warn(&format!(
                            "the equilibrium at time {t} is {}",
                            found.stability.words()
                        ));
                    }
                    rows.push(system.numbers.clone());
                }
                Err(why) => {
                    failed = Some((t, why));
                    break;
                }
            }
        }
        let seconds = clock.elapsed().as_secs_f64();
        self.rows(kind, program, &rows);
        let (status, reason, worst) = match failed {
            None => (Status::Completed, String::new(), Vec::new()),
            Some((_, statics::NoEquilibrium::Interrupted)) => {
                let reason = "interrupted; the results so far are kept".to_string();
                (Status::Interrupted, reason, Vec::new())
            }
            Some((t, statics::NoEquilibrium::Unbalanced(sentence, name))) => {
                let reason = format!("at time {t} {sentence}");
                (Status::NoEquilibrium, reason, vec![name])
            }
        };
        let last = rows.last().cloned().unwrap_or(first);
        let reached = last[0];
        self.keep(system, last);
        if let Some(carried) = &mut self.carried {
            carried.at_rest = true;
        }
        let counts = counts(&stats);
        let method = if words.is_empty() {
            "EQUILIBRIUM".into()
        } else {
            words
        };
        self.close(results::Simulation {
            kind,
            start,
            end: reached,
            outputs: rows.len(),
            method,
            status,
            stop_reason: reason,
            solve_seconds: seconds,
            counts,
            worst,
        })
    }

    /// Writes the equations as methods for implicit equations want them, if one is asked for.
    fn prepare_implicit(&mut self, system: &mut System, settings: &mut options::Options) {
        if !crate::numeric::is_implicit(&settings.method) {
            return;
        }
        let asked = self.model.integrator.formulation.as_deref();
        // HHT holds positions alone; BDF and Newmark's rule are better off with velocities too
        let formulation = match (asked, settings.method.as_str()) {
            (Some("I3"), _) | (None, "HHT") => Formulation::Index3,
            _ => Formulation::Stabilized,
        };
        if let Err(why) = system.make_implicit(formulation) {
            for d in why {
                self.warn(&format!("{}: RADAU5 takes its place", d.message));
            }
            settings.method = "RADAU5".into();
        }
    }

    /// Whether INTEGRATOR and the options have numbers that an integration can keep.
    fn check_settings(&self) -> Result<(), Vec<Diagnostic>> {
        let i = &self.model.integrator;
        let positive = |x: f64| x > 0.0 && !x.is_nan();
        let whole = |k: Option<u32>| k.map(f64::from);
        let given = [
            (
                "--error",
                "the permitted error",
                self.options
                    .error
                    .filter(|e| !(positive(*e) && e.is_finite())),
            ),
            (
                "INTEGRATOR",
                "ERROR",
                i.error.filter(|e| !(positive(*e) && e.is_finite())),
            ),
            ("INTEGRATOR", "HMAX", i.hmax.filter(|h| !positive(*h))),
            ("INTEGRATOR", "HINIT", i.hinit.filter(|h| !positive(*h))),
            (
                "INTEGRATOR",
                "KMAX",
                whole(i.kmax).filter(|k| !positive(*k)),
            ),
            (
                "INTEGRATOR",
                "MAXIT",
                whole(i.maxit).filter(|k| !positive(*k)),
            ),
            (
                "INTEGRATOR",
                "HMIN",
                i.hmin.filter(|h| h.is_nan() || *h < 0.0),
            ),
        ];
        let wrong = given.into_iter().filter_map(|(element, name, value)| {
            let what = format!("{name} must be positive, not {}", value?);
            Some(Diagnostic::error("unfit_value", what).element(element))
        });
        let mut wrong: Vec<Diagnostic> = wrong.collect();
        if let (Some(least), Some(most)) = (i.hmin, i.hmax)
            && least > most
        {
            let what = format!("HMIN = {least} is larger than HMAX = {most}");
            wrong.push(Diagnostic::error("unfit_value", what).element("INTEGRATOR"));
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }

    /// INTEGRATOR, overruled by the options.
    fn integration(&self) -> options::Options {
        let i = &self.model.integrator;
        let asked = self
            .options
            .method
            .as_deref()
            .or(i.method.as_deref())
            .unwrap_or("AUTO");
        options::Options {
            error: self.options.error.or(i.error).unwrap_or(DEFAULT_ERROR),
            method: options::method_named(asked),
            h_initial: i.hinit,
            h_max: i.hmax.unwrap_or(f64::INFINITY),
            h_min: i.hmin.unwrap_or(0.0),
            max_order: i.kmax.map(|k| k as usize),
            max_newton: i.maxit.map(|k| k as usize),
            ..options::Options::default()
        }
    }
}

/// Whether the free directions of a scene are few enough to look for those without mass before each run.
fn may_ask(scene: &Scene) -> bool {
    // a motion of all links takes about a microsecond per link
    const MOST: usize = 200_000;
    scene.layout.n_v * scene.links.len() <= MOST
}
