//! A model and its clock: one simulation after another, each from where the last one ended.
//!
//! A simulation compiles the model as it is now, takes over the state (or assembles the first one), computes, and appends its
//! rows to the run. What goes wrong in numbers is an outcome in the record, with the results so far; what is wrong in the
//! model is an error.

use super::assemble::{self, Assembly};
use super::columns::{self, Columns};
use super::drives;
use super::dynamics::{self, Ended, Trajectory, Watch};
use super::implicit::Formulation;
use super::kinematics;
use super::linear::{self, Linearization};
use super::misalignment;
use super::output::{self, Output};
use super::outside;
use super::placement;
use super::ranks;
use super::statics;
use super::system::{System, complaints};
use super::wishes;
use crate::diagnostic::Diagnostic;
use crate::expr::measures::Measure;
use crate::model::{Model, Orientation};
use crate::numeric::{Reason, Stop};
use crate::results::{self, Counts, Event, Kind, Run, Status};
use crate::scene::build::{self, unknown_names};
use crate::scene::compile::orientation;
use crate::scene::equations::{Equations, row_name};
use crate::scene::{Scene, Source};
use crate::space::kinematic::kinematic;
use crate::space::{MarkerState, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

/// What SIMULATE asks for.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Analysis {
    Kinematic,
    Dynamic,
    Static,
    /// kinematic without freedom, else dynamic
    Transient,
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

/// State carried from one simulation to the next, by the names of the unknowns.
#[derive(Clone, Debug)]
struct Carried {
    t: f64,
    /// numbers of the last row
    numbers: Vec<f64>,
    names: Vec<String>,
    /// it came to rest: velocities are those of the dataset again, not zero
    at_rest: bool,
    /// place and motion of every part (point masses: true), for when the unknowns are others
    parts: Vec<(bool, u32, MarkerState<f64>)>,
    /// turns that angles have counted
    turns: Vec<f64>,
    /// numbers from outside, and what was before
    supplied: Vec<f64>,
    past: Vec<outside::Past>,
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
    hooks: Vec<outside::Hook>,
    /// linear systems that commands asked for: name of their file where one was given, and whether matrices are wanted
    pub linear: Vec<(Option<String>, bool, Linearization)>,
    /// a sensor ended the run, not only its simulation
    halted: bool,
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
            hooks: Vec::new(),
            linear: Vec::new(),
            halted: false,
        }
    }

    /// Computes what `USER(…)` stands for by a closure.
    ///
    /// `name` is an element ("SFORCE/3"), the text of its ROUTINE, or the first number of `USER(…)`; `inputs` are expressions of the
    /// function language whose values the closure is given, in this order. They may not depend on what it computes. See [`outside::Law`]
    /// for what it has to fill in.
    pub fn register(
        &mut self,
        name: &str,
        inputs: &[&str],
        law: impl Fn(&outside::Call<'_>, &mut [f64]) + Send + Sync + 'static,
    ) {
        self.hooks.push(outside::Hook {
            name: name.to_string(),
            inputs: inputs.iter().map(ToString::to_string).collect(),
            law: std::sync::Arc::new(law),
        });
        if self.carried.is_none() {
            let names: Vec<_> = self.hooks.iter().map(outside::Hook::as_name).collect();
            let known = |id: u32, user: &crate::model::Formula| {
                let element = format!("REQUEST/{id}");
                names.iter().any(|n| n.stands_for(&element, user))
            };
            let (run, options) = (&mut self.run, &self.options);
            self.columns = Columns::new(&self.model, run, &options.columns, options.full, &known);
        }
    }

    /// Whether a sensor has ended the run.
    pub fn halted(&self) -> bool {
        self.halted
    }

    /// The clock.
    pub fn time(&self) -> f64 {
        self.carried.as_ref().map_or(0.0, |c| c.t)
    }

    /// Compiles the model for a MODE, with VARIABLEs that are inputs, and brings it into its state.
    fn prepare(
        &mut self,
        mode: u32,
        inputs: &[u32],
    ) -> Result<(System, Assembly), Vec<Diagnostic>> {
        let options = build::Options {
            mode,
            extra: self.columns.extra.clone(),
            variables: self.options.full,
            skip: self.options.skip.clone(),
            hooks: self.hooks.iter().map(outside::Hook::as_name).collect(),
            zero_user: self.options.zero_user,
            plant_inputs: inputs.to_vec(),
            ..build::Options::default()
        };
        let mut scene = Scene::compile(&self.model, &options)?;
        // Commands may have changed what carries a part: then its place is no unknown of before, and is told by the part.
        let moved = (self.carried.as_ref())
            .filter(|carried| has_new_unknowns(&scene, carried))
            .map(|carried| moved(&self.model, carried));
        if let Some(moved) = &moved {
            scene = Scene::compile(moved, &options)?;
        }
        let l = scene.layout;
        let t = self.time();
        let names = unknown_names(&scene);
        let mut x = vec![0.0; l.n_x];
        for d in &scene.differentials {
            if let Some(state) = d.state {
                x[state] = d.initial[0];
            }
        }
        let mut q = scene.initial_q.clone();
        let mut v = None;
        let mut turns = vec![0.0; l.n_turns];
        if let Some(carried) = &self.carried {
            let values: BTreeMap<&str, f64> = carried
                .names
                .iter()
                .map(String::as_str)
                .zip(carried.numbers[1..].iter().copied())
                .collect();
            let mut speeds = vec![0.0; l.n_v];
            let mut complete = true;
            for (k, name) in names.iter().enumerate() {
                match values.get(name.as_str()) {
                    Some(&value) if k < l.n_q => q[k] = value,
                    Some(&value) if k < l.n_q + l.n_v => speeds[k - l.n_q] = value,
                    Some(&value) => x[k - l.n_q - l.n_v] = value,
                    None => complete &= k >= l.n_q + l.n_v,
                }
            }
            for cam in &mut scene.cams {
                let name = &names[l.n_q + l.n_v + cam.state];
                cam.begun = values.contains_key(name.as_str());
            }
            if complete && !carried.at_rest {
                v = Some(speeds);
            }
            if carried.turns.len() == l.n_turns {
                turns.copy_from_slice(&carried.turns);
            }
        } else {
            if mode != KINEMATIC && mode != STATIC {
                self.initial_joints(&scene, &mut q);
            }
            for (m, motion) in scene.motions.iter().enumerate() {
                self.initial_motion(&scene, m, motion.state, &q, &mut x);
            }
        }
        scene.turns.clone_from(&turns);
        scene.supplied_values = self.supplied(&scene, t, &q, &x)?;
        let first = self.carried.is_none();
        let misaligned = if first {
            misalignment::misaligned(&scene, &self.model)
        } else {
            Vec::new()
        };
        let joints = mode == DYNAMIC || mode == INITIAL_CONDITIONS;
        let placed = first && placement::settle(&scene, &self.model, t, &mut q, &x, joints);
        // only what moves by itself has initial conditions
        let wishes = if first && mode != KINEMATIC && mode != STATIC {
            wishes::collect(&scene, &self.model)
        } else {
            Vec::new()
        };
        // where parts are too many to be weighed, or on curves, coordinates move as little as may be
        let starts = if first && !(placed && joints) {
            wishes::approach(&mut scene, &wishes, t, &mut q, &x)
        } else {
            Vec::new()
        };
        let mut assembly = assemble::positions(&mut scene, t, &mut q, &x)?;
        let unmet = wishes::unmet(&scene, &wishes, &starts, t, &q, &x);
        assembly.warnings.extend(unmet);
        assembly.warnings.splice(0..0, misaligned);
        if first {
            let numbers = assemble::numbers(&scene, t, &q, &vec![0.0; l.n_v], &x);
            let turned = misalignment::turned(&scene, &self.model, &numbers);
            assembly.warnings.extend(turned);
        }
        scene.begin_states(&mut x);
        let v = match v {
            _ if mode == STATIC || mode == LINEAR && self.is_at_rest() => vec![0.0; l.n_v],
            Some(v) => v,
            None => {
                let at_rest = self.carried.as_ref().is_some_and(|c| c.at_rest);
                let given = moved.as_ref().filter(|_| !at_rest).unwrap_or(&self.model);
                assemble::velocities(&scene, given, t, &q, &x)?
            }
        };
        let mut system = System::with_hooks(scene, &self.hooks)?;
        let past = self.carried.as_ref().map_or(&[][..], |c| &c.past);
        system.outside.begin(t, past);
        let mut y = q;
        y.extend(v);
        y.extend(x);
        system.numbers[l.turns()].copy_from_slice(&turns);
        system.numbers[0] = t;
        system.numbers[l.y()].copy_from_slice(&y);
        if let Err(k) = system.resolve() {
            let name = system.scene.loops[k].name.clone();
            return Err(vec![
                Diagnostic::error("loop", "it depends on itself, and no value solves that")
                    .element(name)
                    .help("give an IC near the solution, where it has one"),
            ]);
        }
        let row = system.row(t, &y);
        system.numbers.copy_from_slice(&row);
        let y = row[l.y()].to_vec();
        system.count_turns(t, &y);
        if mode != STATIC {
            system.begin_sensing();
        }
        Ok((system, assembly))
    }

    /// Numbers from outside where assembly begins: what sensors evaluated before, and what closures say of the configuration.
    fn supplied(
        &self,
        scene: &Scene,
        t: f64,
        q: &[f64],
        x: &[f64],
    ) -> Result<Vec<f64>, Vec<Diagnostic>> {
        let l = scene.layout;
        let mut numbers = vec![0.0; l.len()];
        let carried = self.carried.as_ref().map(|c| &c.supplied);
        if let Some(values) = carried.filter(|v| v.len() == l.n_supplied) {
            numbers[l.supplied()].copy_from_slice(values);
        }
        if !scene.hooks.is_empty() {
            numbers[0] = t;
            numbers[l.q()].copy_from_slice(q);
            numbers[l.x()].copy_from_slice(x);
            numbers[l.turns()].copy_from_slice(&scene.turns);
            let mut outside = outside::Outside::new(scene, &self.hooks).map_err(complaints)?;
            outside.evaluate(&mut numbers, true);
        }
        Ok(numbers[l.supplied()].to_vec())
    }

    fn is_at_rest(&self) -> bool {
        self.carried.as_ref().is_some_and(|c| c.at_rest)
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

    /// IC, ICTRAN, ICROT of joints that carry a part: where assembly begins.
    fn initial_joints(&self, scene: &Scene, q: &mut [f64]) {
        for c in &scene.coordinates {
            let Some(joint) = c.joint.and_then(|j| self.model.joints.get(&j)) else {
                continue;
            };
            let given = if c.angular {
                joint.ic_rotation[0]
            } else {
                joint.ic_translation[0]
            };
            if let (Some(value), Source::Free { q: place, .. }) = (given, c.source) {
                q[place] = value;
            }
        }
    }

    /// Start of motions given by their rate: ICDISP and ICVEL, else what the dataset's configuration and the joint's IC show; rows begin
    /// where the assembled configuration is.
    fn initial_motion(
        &self,
        scene: &Scene,
        m: usize,
        state: Option<usize>,
        _q: &[f64],
        x: &mut [f64],
    ) {
        let Some(state) = state else { return };
        let motion = &scene.motions[m];
        let Some(data) = self.model.motions.get(&motion.id) else {
            return;
        };
        let begins_there = scene.initial_displacement(m);
        x[state] = data.ic_displacement.or(begins_there).unwrap_or(0.0);
        if motion.level == crate::model::Level::Acceleration {
            let rate = scene.motions[m].coordinate.and_then(|c| {
                let coordinate = &scene.coordinates[c];
                let joint = self.model.joints.get(&coordinate.joint?)?;
                if coordinate.angular {
                    joint.ic_rotation[1]
                } else {
                    joint.ic_translation[1]
                }
            });
            x[state + 1] = data.ic_velocity.or(rate).unwrap_or(0.0);
        }
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
        let (program, complaints) = self.columns.program(&system.scene);
        for complaint in complaints {
            if self
                .options
                .columns
                .iter()
                .any(|c| complaint.starts_with(c.as_str()))
            {
                return Err(vec![Diagnostic::error("unavailable", complaint)]);
            }
            self.warn(&complaint);
        }
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
        let status = match analysis {
            Analysis::InitialConditions => Status::Completed,
            Analysis::Static => self.at_rest(&mut system, (start, end, output), &program, watch),
            _ => self.over_time(&mut system, analysis, (start, end, output), &program, watch),
        };
        if matches!(analysis, Analysis::InitialConditions) {
            self.keep(&system, first);
        }
        Ok(status)
    }

    /// A simulation over time.
    fn over_time(
        &mut self,
        system: &mut System,
        analysis: Analysis,
        (start, end, output): (f64, f64, Output),
        program: &crate::expr::program::Program,
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
            settings.first = dynamics::first_method(system, end - start).into();
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
            let moved = l.n_x > 0 || l.n_q > 0 && system.outside.remembers();
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
        let counts = counts(&trajectory.stats);
        let method = trajectory
            .methods
            .iter()
            .enumerate()
            .map(|(k, (t, name))| {
                if k == 0 {
                    name.clone()
                } else {
                    format!("{name} from {t}, where steps were limited by stiffness")
                }
            })
            .collect::<Vec<_>>()
            .join(", then ");
        let record = &mut self.run.record;
        record.counts += counts;
        record.solve_seconds += seconds;
        record.method.clone_from(&method);
        record.error = Some(settings.error);
        record.status = status;
        record.stop_reason.clone_from(&reason);
        record.simulations.push(results::Simulation {
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
        });
        status
    }

    /// An equilibrium now, or one at each output time up to an `end` that is still to come.
    fn at_rest(
        &mut self,
        system: &mut System,
        (start, end, output): (f64, f64, Output),
        program: &crate::expr::program::Program,
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
        let record = &mut self.run.record;
        record.counts += counts;
        record.solve_seconds += seconds;
        record.method = if words.is_empty() {
            "EQUILIBRIUM".into()
        } else {
            words
        };
        record.status = status;
        record.stop_reason.clone_from(&reason);
        record.simulations.push(results::Simulation {
            kind,
            start,
            end: reached,
            outputs: rows.len(),
            method: record.method.clone(),
            status,
            stop_reason: reason,
            solve_seconds: seconds,
            counts,
            worst,
        });
        status
    }

    /// Writes the equations as methods for implicit equations want them, if one is asked for.
    fn prepare_implicit(&mut self, system: &mut System, settings: &mut dynamics::Options) {
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

    /// INTEGRATOR, overruled by the options.
    fn integration(&self) -> dynamics::Options {
        let i = &self.model.integrator;
        let asked = self
            .options
            .method
            .as_deref()
            .or(i.method.as_deref())
            .unwrap_or("AUTO");
        dynamics::Options {
            error: self.options.error.or(i.error).unwrap_or(DEFAULT_ERROR),
            method: dynamics::method_named(asked),
            h_initial: i.hinit,
            h_max: i.hmax.unwrap_or(f64::INFINITY),
            h_min: i.hmin.unwrap_or(0.0),
            max_order: i.kmax.map(|k| k as usize),
            max_newton: i.maxit.map(|k| k as usize),
            ..dynamics::Options::default()
        }
    }

    fn rows(&mut self, kind: Kind, program: &crate::expr::program::Program, rows: &[Vec<f64>]) {
        self.run.begin(kind);
        columns::append(&mut self.run, program, rows);
        self.run.end();
    }

    /// The rows of a simulation, each with the columns of the rows that took part there.
    fn selected_rows(
        &mut self,
        kind: Kind,
        program: &crate::expr::program::Program,
        system: &System,
        trajectory: &Trajectory,
    ) {
        self.run.begin(kind);
        let mut from = 0;
        let mut program = program.clone();
        for (until, _, active) in &trajectory.selections {
            columns::append(&mut self.run, &program, &trajectory.rows[from..*until]);
            let mut scene = system.scene.clone();
            scene.active.clone_from(active);
            (program, from) = (self.columns.program(&scene).0, *until);
        }
        columns::append(&mut self.run, &program, &trajectory.rows[from..]);
        self.run.end();
    }

    /// Tells when and where the rank of the rows changed.
    fn rank_changes(&mut self, system: &System, chosen: Vec<bool>, trajectory: &Trajectory) {
        let names = |active: &[bool]| -> Vec<String> {
            let rows = system.scene.rows.iter().zip(active);
            rows.filter(|r| *r.1).map(|r| row_name(r.0)).collect()
        };
        let mut told = Vec::new();
        let mut scene = system.scene.clone();
        scene.active = chosen;
        let n = scene.layout.n_v as f64;
        // looking costs n³ per state
        if n.powi(3) * trajectory.weak.len() as f64 <= 1e9 {
            for pass in ranks::passes(&scene, &trajectory.weak) {
                told.push(results::RankChange {
                    time: pass.t,
                    what: "passes",
                    rows: pass.rows,
                    place: pass.place,
                });
            }
        }
        for (_, t, active) in &trajectory.selections {
            let before = names(&scene.active);
            let rows = names(active)
                .into_iter()
                .filter(|r| !before.contains(r))
                .collect();
            scene.active.clone_from(active);
            told.push(results::RankChange {
                time: *t,
                what: "other rows",
                rows,
                place: Vec::new(),
            });
        }
        for &(t, row) in &trajectory.restored {
            told.push(results::RankChange {
                time: t,
                what: "restored",
                rows: vec![row_name(&scene.rows[row])],
                place: Vec::new(),
            });
        }
        told.sort_by(|a, b| a.time.total_cmp(&b.time));
        for change in told.iter().take(20) {
            let rows = change.rows.join(", ");
            let time = change.time;
            self.warn(&match change.what {
                "passes" => format!(
                    "at time {time:.9} the rank of the constraints falls in passing: {rows} depends on others where {}",
                    ranks::words(&change.place)
                ),
                "restored" => format!("at time {time:.9} {rows} no longer follows from the others; it is kept from there"),
                _ => format!("at time {time:.9} other rows are kept: {rows} in place of what they make superfluous"),
            });
        }
        self.run.record.rank_changes.extend(told);
    }

    fn keep(&mut self, system: &System, numbers: Vec<f64>) {
        let at = Equations::new(&system.scene, &numbers);
        let parts = system.scene.parts.iter().enumerate();
        let parts = parts
            .map(|(k, p)| (p.point_mass, p.id, at.part(k, false)))
            .collect();
        self.carried = Some(Carried {
            t: numbers[0],
            turns: numbers[system.scene.layout.turns()].to_vec(),
            supplied: numbers[system.scene.layout.supplied()].to_vec(),
            past: system.outside.past(),
            names: unknown_names(&system.scene),
            at_rest: false,
            parts,
            numbers,
        });
    }

    fn warn(&mut self, what: &str) {
        if !self.run.record.warnings.iter().any(|w| w == what) {
            self.run.record.warnings.push(what.to_string());
            self.run.log.push(Event::Warning(what.to_string()));
        }
    }

    /// Freedom and redundancy, told once and whenever they change.
    fn first_facts(&mut self, system: &System, assembly: &Assembly) {
        let names: Vec<String> = assembly.redundant.iter().map(|r| r.name.clone()).collect();
        if self.run.record.redundant != names && !names.is_empty() {
            let rows = &system.scene.rows;
            let equations = assembly
                .redundant
                .iter()
                .map(|r| (rows[r.row].equation.clone(), rows[r.row].element.clone()))
                .collect();
            self.run.log.push(Event::Redundant {
                time: self.time(),
                equations,
            });
        }
        self.run.record.redundant = names;
        self.run.record.freedom = assembly.freedom as i64;
    }

    /// Status, a sentence, and the names of what was worst.
    fn outcome(&self, system: &System, trajectory: &Trajectory) -> (Status, String, Vec<String>) {
        match &trajectory.ended {
            None => (Status::Completed, String::new(), Vec::new()),
            Some(Ended::Interrupted) => (
                Status::Interrupted,
                "interrupted; the results so far are kept".into(),
                Vec::new(),
            ),
            Some(Ended::Sensor(k)) => {
                let name = format!("SENSOR/{}", system.scene.sensors[*k].id);
                let at = trajectory.t.last().copied().unwrap_or(self.time());
                let reason = format!("{name} ended the simulation at time {at}");
                (Status::Completed, reason, Vec::new())
            }
            Some(Ended::Broken { t, broken }) => (
                Status::Stopped,
                format!(
                    "stopped at time {t}: {}; {}",
                    broken.sentence, broken.advice
                ),
                vec![broken.element.clone()],
            ),
            Some(Ended::Stop(stop)) => {
                let (status, mut sentence, mut worst) = explain(system, stop);
                let stands = trajectory.rows.last().unwrap_or(&system.numbers);
                let rows = !matches!(stop.reason, Reason::TooManySteps | Reason::Singular(_));
                if let (true, Some(lock)) = (rows, ranks::locked(&system.scene, stands)) {
                    let why = match &lock.motion {
                        Some(motion) => format!(
                            "the mechanism is locked: {motion} drives it past its reach, {} cannot follow",
                            lock.row
                        ),
                        None => format!(
                            "the constraints can be kept no longer: {} has become dependent on others",
                            lock.row
                        ),
                    };
                    sentence = format!(
                        "stopped at time {}: {why}, where {}",
                        stop.t,
                        ranks::words(&lock.place)
                    );
                    worst = lock.row;
                }
                (status, sentence, vec![worst])
            }
        }
    }

    /// Energy and constraint drift over the rows of a simulation.
    fn drift(&mut self, system: &System, first: &[f64], rows: &[Vec<f64>]) {
        let scene = &system.scene;
        let n_rows = scene.rows.len();
        let program = crate::scene::programs::record(scene, |at| {
            let [kinetic, potential] = at.energy();
            let mut out = vec![kinetic, potential];
            out.extend((0..n_rows).map(|r| at.row(r).value));
            out
        });
        let Ok(program) = program else { return };
        let mut work = crate::expr::program::Work::default();
        let mut out = vec![0.0; 2 + n_rows];
        let (mut worst, mut scale, mut change, mut start) = (0.0_f64, 0.0_f64, 0.0_f64, None);
        for row in std::iter::once(first).chain(rows.iter().map(Vec::as_slice)) {
            program.run(row, &mut work, &mut out);
            let energy = out[0] + out[1];
            let begin = *start.get_or_insert(energy);
            change = change.max((energy - begin).abs());
            scale = scale.max(out[0].abs()).max(out[1].abs());
            worst = out[2..].iter().fold(worst, |m, g| m.max(g.abs()));
        }
        let conservative = scene.forces.is_empty() && scene.motions.is_empty();
        let record = &mut self.run.record;
        if conservative && scale > 0.0 {
            record.energy_drift = Some(record.energy_drift.unwrap_or(0.0).max(change / scale));
        }
        if n_rows > 0 {
            record.constraint_drift = Some(record.constraint_drift.unwrap_or(0.0).max(worst));
        }
    }
}

/// Whether a scene has positions or velocities among its unknowns that the last state does not tell by name.
fn has_new_unknowns(scene: &Scene, carried: &Carried) -> bool {
    let known: BTreeSet<&str> = carried.names.iter().map(String::as_str).collect();
    let l = scene.layout;
    let names = unknown_names(scene);
    names[..l.n_q + l.n_v]
        .iter()
        .any(|name| !known.contains(name.as_str()))
}

/// The model with its parts where they are, and moving as they do.
fn moved(model: &Model, carried: &Carried) -> Model {
    let mut model = model.clone();
    for joint in model.joints.values_mut() {
        (joint.ic_translation, joint.ic_rotation) = ([None; 2], [None; 2]);
    }
    let ground = MarkerState::ground();
    for (point_mass, id, state) in &carried.parts {
        let angle = |m| kinematic(m, state, &ground, &ground, &ground).unwrap_or(0.0);
        let parts = if *point_mass {
            &mut model.point_masses
        } else {
            &mut model.parts
        };
        let Some(part) = parts.get_mut(id) else {
            continue;
        };
        part.qg = state.p_GM.0;
        part.orientation =
            Orientation::Euler([Measure::Psi, Measure::Theta, Measure::Phi].map(angle));
        let cm = part.cm.and_then(|cm| model.markers.get(&cm));
        let cm_place = cm.map_or(Vec3::zero(), |cm| Vec3(cm.qp));
        let cm_axes = cm.and_then(|cm| orientation(&cm.orientation, cm.qp).ok());
        // The dataset tells the velocity of CM along ground axes, the angular velocity along those of CM.
        let v_cm = state.v_GM + state.w_GM.cross(state.R_GM.apply(cm_place));
        let w_part = state.R_GM.apply_transposed(state.w_GM);
        let w_cm = cm_axes.map_or(w_part, |axes| axes.apply_transposed(w_part));
        (part.vm, part.wm) = (None, None);
        (part.velocity, part.angular_velocity) = (v_cm.0.map(Some), w_cm.0.map(Some));
    }
    model
}

fn counts(stats: &crate::numeric::Stats) -> Counts {
    Counts {
        steps: stats.steps as u64,
        rejected_steps: stats.rejected as u64,
        evaluations: stats.evaluations as u64,
        jacobians: stats.jacobians as u64,
        factorizations: stats.factorizations as u64,
    }
}

/// A stop in words: status, sentence, and the name of the worst unknown or row.
fn explain(system: &System, stop: &Stop) -> (Status, String, String) {
    let scene = &system.scene;
    let mut names = unknown_names(scene);
    // what a method for implicit equations sees after the unknowns
    let multipliers = system.implicit_size().saturating_sub(names.len());
    let rows = (0..scene.rows.len()).filter(|&r| scene.active.get(r).copied().unwrap_or(true));
    let rows: Vec<String> = rows
        .map(|r| format!("multiplier of {}", row_name(&scene.rows[r])))
        .collect();
    names.extend(rows.iter().cycle().take(multipliers).cloned());
    let unknown = |k: usize| match (names.get(k), k.checked_sub(names.len())) {
        (Some(name), _) => name.clone(),
        (None, loops) => loops
            .and_then(|k| scene.loops.get(k))
            .map_or_else(|| format!("unknown {k}"), |u| u.name.clone()),
    };
    let n = names.len();
    let (status, what, worst) = match stop.reason {
        Reason::Evaluation(f) if f.what >= n => (
            Status::Stopped,
            "a function that depends on itself has no solution near",
            unknown(f.what),
        ),
        Reason::Evaluation(f) => (
            Status::Stopped,
            "the equations have no finite value",
            unknown(f.what),
        ),
        Reason::NotFinite(k) => (Status::Stopped, "a rate is not a number", unknown(k)),
        Reason::Projection(f) => {
            let name = scene
                .rows
                .get(f.what)
                .map_or_else(|| "the constraints".into(), row_name);
            (
                Status::Stopped,
                "the constraints cannot be kept: the mechanism is locked or folds",
                name,
            )
        }
        Reason::ErrorTest(k) => (
            Status::Stopped,
            "the error stays above its tolerance however short the step",
            unknown(k),
        ),
        Reason::Newton(k) => (
            Status::Stopped,
            "Newton's iteration does not converge however short the step",
            unknown(k),
        ),
        Reason::Singular(k) => (Status::Stopped, "nothing determines an unknown", unknown(k)),
        Reason::TooManySteps => (Status::Limit, "as many steps as permitted", String::new()),
    };
    let sentence = format!(
        "stopped at time {} with step {:.3e}: {what} ({worst})",
        stop.t, stop.h
    );
    (status, sentence, worst)
}

/// Units of a model as result files spell them.
fn units(model: &Model) -> results::Units {
    let mut units = results::Units::default();
    if let Some(u) = &model.units {
        let spell = |name: &str| {
            match name {
                "MILLIMETER" => "mm",
                "CENTIMETER" => "cm",
                "KILOGRAM" => "kg",
                "SECOND" => "sec",
                other => return other.to_ascii_lowercase(),
            }
            .to_string()
        };
        units.length = spell(&u.length);
        units.mass = spell(&u.mass);
        units.time = spell(&u.time);
        units.force = spell(&u.force);
    }
    units
}
