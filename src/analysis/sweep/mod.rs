//! Many runs of one model: numbers of its statements change from run to run, measures of each run
//! fill one table.
//!
//! ```text
//! Parameter   a number of the model by its name: PART/2.MASS
//! design      the points: what each run sets the parameters to (grid, latin hypercube, list)
//! Measure     one number of a run: max(ABS(FX(10,20)))
//! Sweep       model, commands, parameters, measures; runs points on several threads
//! Table       a file that grows by a row as a run is done, and is gone on with
//! ```
//!
//! A run depends on its point alone: neither on the thread that computes it nor on the runs before
//! it, to the last bit.

pub mod design;
mod measure;
mod parameter;
mod table;

pub use measure::{Measure, is_measure};
pub use parameter::Parameter;
pub use table::Table;

use crate::analysis::session::script::obey;
use crate::analysis::session::{Analysis, Options, Session};
use crate::analysis::stack;
use crate::analysis::system::closures::{Call, Hook};
use crate::analysis::watch::Watch;
use crate::arrange::Arrange;
use crate::dataset::command::{Command, Simulate, SimulationKind, Step};
use crate::dataset::{self, Reading, Source};
use crate::diagnostic::{Diagnostic, Error, Severity, counted};
use crate::model::{ElementKind, Model};
use crate::results::{Status, digest};
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};

/// Many runs of one model.
///
/// ```
/// use cognate::analysis::sweep::{Sweep, design};
/// use cognate::{Analysis, Model};
/// let text = "a drop\nPART/1, GROUND\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n\
///     VARIABLE/3, FUNCTION=1\nVFORCE/1, I=2, JFLOAT=9, FX=VARVAL(3), FY=0, FZ=0\n\
///     MARKER/9, PART=1, FLOATING\nEND\n";
/// let mut sweep = Sweep::over(Model::from_text(text)?, Analysis::Dynamic, 1.0, 10);
/// sweep.parameter("VARIABLE/3")?;
/// sweep.parameter("PART/2.MASS")?;
/// sweep.measure("last(DX(2))")?;
/// let points = design::grid(&[vec![1.0, 2.0], vec![1.0, 4.0]])?;
/// for row in sweep.rows(&points, 2)? {
///     let [force, mass] = row.values[..] else { panic!("two parameters") };
///     assert!((row.measures[0] - 0.5 * force / mass).abs() < 1e-6);
/// }
/// # Ok::<(), cognate::Error>(())
/// ```
#[derive(Clone)]
pub struct Sweep {
    model: Model,
    commands: Vec<Step>,
    parameters: Vec<Parameter>,
    measures: Vec<Measure>,
    /// options of each run; its columns and its kept start are those that measures and speed need
    pub options: Options,
    /// folders in which commands look for files
    pub folders: Vec<PathBuf>,
    /// closures that compute what `USER(…)` stands for
    hooks: Vec<Hook>,
    /// what else the results depend on
    beside: Vec<String>,
    /// the command file of Adams View that the model is of, and its design variables
    view: Option<(Source, Vec<String>)>,
    /// which of the values are those of design variables, by their names
    designs: Vec<Option<String>>,
    idle: Idle,
}

/// Sessions that have done their runs: compiled, for the next call. A copy of a sweep begins
/// without any.
#[derive(Default)]
struct Idle(Mutex<Vec<Session>>);

impl Clone for Idle {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Idle {
    /// Takes a session that a caller could have begun with these options and folders.
    fn take(&self, options: &Options, folders: &[PathBuf]) -> Option<Session> {
        let mut sessions = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        sessions.retain(|s| s.options() == options && s.folders == folders);
        sessions.pop()
    }

    /// Keeps a session.
    fn give(&self, session: Session) {
        let mut sessions = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        sessions.push(session);
    }
}

/// One run of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// index of its point
    pub run: usize,
    /// what the parameters were set to
    pub values: Vec<f64>,
    /// the measures; NaN where the run was not completed
    pub measures: Vec<f64>,
    /// how it ended
    pub status: Status,
    /// number of warnings of the run
    pub warnings: usize,
    /// why it ended early; empty: everything was done
    pub reason: String,
}

/// Hooks of a caller who looks at the rows as they are done.
pub trait Follow: Sync {
    /// Returns whether to stop now: runs that go on are given up.
    fn interrupted(&self) -> bool {
        false
    }
}

/// The hooks of a caller who lets it go on.
pub struct Unfollowed;
impl Follow for Unfollowed {}

impl Sweep {
    /// Begins a sweep of a model and the commands that each run obeys.
    pub fn new(model: Model, commands: Vec<Step>) -> Self {
        Self {
            model,
            commands,
            parameters: Vec::new(),
            measures: Vec::new(),
            options: Options::default(),
            folders: Vec::new(),
            hooks: Vec::new(),
            beside: Vec::new(),
            view: None,
            designs: Vec::new(),
            idle: Idle::default(),
        }
    }

    /// Lets design variables of a command file of Adams View be parameters, by their full names
    /// (`.model.DV_1`); the model of each run is then read anew with their values.
    #[must_use]
    pub fn with_design_variables(mut self, reading: &Reading) -> Self {
        if reading.is_view() {
            let names = reading.variables.keys().cloned().collect();
            self.view = Some((reading.dataset.source.clone(), names));
        }
        self
    }

    /// Returns the design variable that a name means.
    fn design_variable(&self, name: &str) -> Option<String> {
        let (_, names) = self.view.as_ref()?;
        let mut found = names.iter().filter(|n| n.eq_ignore_ascii_case(name.trim()));
        found.next().cloned()
    }

    /// Begins a sweep in which each run is one simulation up to `end`, with output at equal
    /// distances.
    pub fn over(model: Model, analysis: Analysis, end: f64, steps: usize) -> Self {
        let kind = match analysis {
            Analysis::Kinematic => SimulationKind::Kinematic,
            Analysis::Dynamic => SimulationKind::Dynamic,
            Analysis::Static => SimulationKind::Static,
            Analysis::Transient => SimulationKind::Transient,
            Analysis::InitialConditions => SimulationKind::InitialConditions,
        };
        let simulate = Simulate {
            kind,
            end: Some(end),
            duration: None,
            steps: Some(u32::try_from(steps).unwrap_or(u32::MAX)),
            dtout: None,
        };
        let step = Step {
            command: Command::Simulate(simulate),
            text: "SIMULATE".into(),
            line: 0,
        };
        Self::new(model, vec![step])
    }

    /// Adds a parameter by its name; see [`Parameter`].
    ///
    /// # Errors
    /// A name that means nothing in the model, with near names; a parameter that is there already,
    /// or that a command of the runs changes.
    pub fn parameter(&mut self, name: &str) -> Result<(), Error> {
        let design = self.design_variable(name);
        let parameter = match &design {
            Some(name) => Parameter::of_design(name),
            None => Parameter::new(&self.model, name)?,
        };
        if self.parameters.iter().any(|p| p.is(&parameter)) {
            let what = format!("{} is set twice", parameter.name());
            return Err(Diagnostic::error("bad_sweep", what).into());
        }
        let changing = |step: &&Step| match &step.command {
            Command::Change(record) => parameter.is_changed_by(record),
            _ => false,
        };
        if let Some(step) = self.commands.iter().find(changing) {
            let what = format!(
                "{} is set by the sweep, and changed by `{}` in line {} of the commands",
                parameter.name(),
                step.text.trim(),
                step.line
            );
            let d = Diagnostic::error("bad_sweep", what);
            return Err(d.help("take the command away, or the parameter").into());
        }
        self.parameters.push(parameter);
        self.designs.push(design);
        self.idle = Idle::default();
        Ok(())
    }

    /// Adds a measure by its text; see [`Measure`].
    ///
    /// # Errors
    /// A text that is no measure, and mistakes in its expression.
    pub fn measure(&mut self, text: &str) -> Result<(), Error> {
        let plain = self.session(Vec::new());
        let mut measure = Measure::new(text, &plain)?;
        if self.measures.iter().any(|m| m.name() == measure.name()) {
            let what = format!("{} is measured twice", measure.name());
            return Err(Diagnostic::error("bad_sweep", what).into());
        }
        let column = measure.column().map(String::from);
        measure.take_unit(&self.session(column.into_iter().collect()));
        self.measures.push(measure);
        Ok(())
    }

    /// Takes note of what the results depend on beside the model, as the library that computes a
    /// closure: a table of other contents is that of another sweep.
    pub fn depends_on(&mut self, contents: &[u8]) {
        self.beside.push(digest(contents.iter().copied()));
    }

    /// Computes what `USER(…)` stands for by a closure, which the threads share; see
    /// [`Session::register`].
    pub fn register(
        &mut self,
        name: &str,
        inputs: &[&str],
        law: impl Fn(&Call<'_>, &mut [f64]) + Send + Sync + 'static,
    ) {
        self.idle = Idle::default();
        self.hooks.push(Hook {
            name: name.to_string(),
            inputs: inputs.iter().map(ToString::to_string).collect(),
            law: Arc::new(law),
        });
    }

    /// The parameters, in the order of the values of a point.
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// The measures, in the order of those of a row.
    pub fn measures(&self) -> &[Measure] {
        &self.measures
    }

    /// Runs all points on so many threads; returns their rows, in the order of the points.
    ///
    /// # Errors
    /// No parameters or measures, a point of another length or that is not finite.
    pub fn rows(&self, points: &[Vec<f64>], threads: usize) -> Result<Vec<Row>, Error> {
        let mut rows = Vec::with_capacity(points.len());
        let all: Vec<usize> = (0..points.len()).collect();
        self.run(points, &all, threads, &Unfollowed, |row| {
            rows.push(row);
            Ok(())
        })?;
        rows.arrange_by_key(|row| row.run);
        Ok(rows)
    }

    /// Runs some of the points on so many threads (at least one) and hands over each row as it is
    /// done, on the thread of the caller. Runs that the caller interrupts have no row.
    ///
    /// # Errors
    /// No parameters or measures, a point of another length or that is not finite, a wanted run
    /// without a point; the error of `each`, which ends the sweep.
    pub fn run(
        &self,
        points: &[Vec<f64>],
        wanted: &[usize],
        threads: usize,
        follow: &dyn Follow,
        mut each: impl FnMut(Row) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.check(points)?;
        if let Some(run) = wanted.iter().find(|&&run| run >= points.len()) {
            let what = format!(
                "there is no run {run} among {}",
                counted(points.len(), "point")
            );
            return Err(Diagnostic::error("bad_sweep", what).into());
        }
        let wanted = &self.in_groups(points, wanted);
        let crew = Crew {
            sweep: self,
            points,
            wanted,
            next: AtomicUsize::new(0),
            stopped: AtomicBool::new(false),
            follow,
        };
        let threads = threads.clamp(1, wanted.len().max(1));
        let stack_bytes = stack::bytes(threads);
        let mut outcome = Ok(());
        std::thread::scope(|scope| {
            let (sender, rows) = channel();
            let mut begun = 0;
            for _ in 0..threads {
                let (crew, sender) = (&crew, sender.clone());
                let builder = std::thread::Builder::new().stack_size(stack_bytes);
                let work = move || crew.work(&sender);
                begun += usize::from(builder.spawn_scoped(scope, work).is_ok());
            }
            if begun == 0 {
                // a system that has no room for a thread runs them here
                crew.work(&sender);
            }
            drop(sender);
            for row in rows {
                if outcome.is_ok() {
                    outcome = each(row);
                    crew.stopped.fetch_or(outcome.is_err(), Ordering::Relaxed);
                }
            }
        });
        outcome
    }

    /// Returns the wanted runs, those together whose parameters differ by VARIABLEs alone: a thread
    /// compiles once for all of them.
    fn in_groups(&self, points: &[Vec<f64>], wanted: &[usize]) -> Vec<usize> {
        let is_variable = |p: &Parameter| p.element().0 == Some(ElementKind::Variable);
        let mut groups: HashMap<Vec<u64>, usize> = HashMap::new();
        let group = |&run: &usize| {
            let values = self.parameters.iter().zip(&points[run]);
            let compiled = values.filter(|(p, _)| !is_variable(p));
            let key = compiled.map(|(_, x)| x.to_bits()).collect();
            let next = groups.len();
            *groups.entry(key).or_insert(next)
        };
        let mut wanted = wanted.to_vec();
        wanted.sort_by_cached_key(group);
        wanted
    }

    /// Checks that there is something to do, and that points fit the parameters.
    fn check(&self, points: &[Vec<f64>]) -> Result<(), Error> {
        let refuse = |what: String| Err(Diagnostic::error("bad_sweep", what).into());
        if self.parameters.is_empty() {
            return refuse("a sweep needs a parameter to set".into());
        }
        if self.measures.is_empty() {
            return refuse("a sweep needs a measure".into());
        }
        let n = self.parameters.len();
        for (k, point) in points.iter().enumerate() {
            if point.len() != n {
                let given = point.len();
                return refuse(format!(
                    "point {k} has {} for {}",
                    counted(given, "value"),
                    counted(n, "parameter")
                ));
            }
            if let Some(at) = point.iter().position(|x| !x.is_finite()) {
                let (name, x) = (self.parameters[at].name(), point[at]);
                return refuse(format!("point {k} sets {name} to {x}"));
            }
        }
        Ok(())
    }

    /// Returns the options of a session with these columns.
    fn options_with(&self, columns: Vec<String>) -> Options {
        Options {
            columns,
            keep_start: true,
            named_only: true,
            ..self.options.clone()
        }
    }

    /// Begins the session of a thread.
    fn session(&self, columns: Vec<String>) -> Session {
        let options = self.options_with(columns);
        let mut session = Session::new(self.model.clone(), "sweep", options);
        session.folders.clone_from(&self.folders);
        for hook in &self.hooks {
            session.register_hook(hook.clone());
        }
        let variables = self.parameters.iter().map(Parameter::element);
        let variables = variables.filter_map(|(kind, id)| match kind {
            Some(ElementKind::Variable) => id,
            _ => None,
        });
        session.will_change(variables);
        session
    }

    /// Runs one point; `None`: it was interrupted.
    fn one(
        &self,
        session: &mut Session,
        (run, values): (usize, &[f64]),
        crew: &Crew,
    ) -> Option<Row> {
        let mut row = Row {
            run,
            values: values.to_vec(),
            measures: vec![f64::NAN; self.measures.len()],
            status: Status::Model,
            warnings: 0,
            reason: String::new(),
        };
        match self.solve(session, values, crew) {
            Ok(Status::Interrupted) => return None,
            Ok(status) => row.status = status,
            Err(error) => {
                row.reason = error.first().to_string();
                return Some(row);
            }
        }
        row.warnings = session.run.record.warnings.len();
        if row.status == Status::Completed {
            let of_run = self.measures.iter().map(|m| m.of(&session.run));
            row.measures = of_run.collect();
        } else {
            row.reason.clone_from(&session.run.record.stop_reason);
        }
        Some(row)
    }

    /// Returns whether commands may leave a model that differs from the one of the sweep in more
    /// than the parameters, which the next run sets anew.
    fn changes_more(&self) -> bool {
        let simulates = |step: &Step| {
            matches!(
                step.command,
                Command::Simulate(_) | Command::Stop | Command::Show(_)
            )
        };
        !self.commands.iter().all(simulates)
    }

    /// Returns the model with other values of design variables; `None`: none is a parameter.
    fn designed(&self, values: &[f64]) -> Result<Option<Model>, Error> {
        let of = values.iter().zip(&self.designs);
        let changed = of.filter_map(|(x, design)| Some((design.clone()?, *x)));
        let changed: BTreeMap<String, f64> = changed.collect();
        let Some((source, _)) = self.view.as_ref().filter(|_| !changed.is_empty()) else {
            return Ok(None);
        };
        let reading = dataset::read_with(source.clone(), &changed);
        let is_error = |d: &Diagnostic| d.severity == Severity::Error;
        match reading.diagnostics.iter().find(|d| is_error(d)) {
            Some(d) => Err(d.clone().into()),
            None => Ok(Some(reading.model)),
        }
    }

    /// Sets the parameters and obeys the commands from the start.
    fn solve(&self, session: &mut Session, values: &[f64], crew: &Crew) -> Result<Status, Error> {
        let set = |model: &mut Model| {
            let all = self.parameters.iter().zip(values).zip(&self.designs);
            let mut all = all.filter(|(_, design)| design.is_none());
            all.try_for_each(|((parameter, &x), _)| parameter.set(model, x))
        };
        if let Some(model) = self.designed(values)? {
            session.model = model;
            set(&mut session.model)?;
            session.reset();
            let mut hooks = Hooks(crew);
            return obey(session, &self.commands, |_, _| {}, &mut hooks);
        }
        // a list that became zero in an earlier run is not given any more
        if self.changes_more() || set(&mut session.model).is_err() {
            session.model.clone_from(&self.model);
            set(&mut session.model)?;
        }
        session.reset();
        let mut hooks = Hooks(crew);
        obey(session, &self.commands, |_, _| {}, &mut hooks)
    }
}

/// The threads of a sweep and what they share.
struct Crew<'a> {
    sweep: &'a Sweep,
    points: &'a [Vec<f64>],
    /// indices of the points to run
    wanted: &'a [usize],
    /// place in `wanted` of the next run
    next: AtomicUsize,
    /// the caller could not take a row
    stopped: AtomicBool,
    follow: &'a dyn Follow,
}

impl Crew<'_> {
    fn is_over(&self) -> bool {
        self.stopped.load(Ordering::Relaxed) || self.follow.interrupted()
    }

    /// Runs points one after another until none is left.
    fn work(&self, rows: &Sender<Row>) {
        let columns = self.sweep.measures.iter().filter_map(Measure::column);
        let columns: Vec<String> = columns.map(String::from).collect();
        let options = self.sweep.options_with(columns.clone());
        let idle = self.sweep.idle.take(&options, &self.sweep.folders);
        let mut session = idle.unwrap_or_else(|| self.sweep.session(columns));
        if self.run_with(&mut session, rows) {
            self.sweep.idle.give(session);
        }
    }

    /// Runs points in a session; returns whether it has ended its last run.
    fn run_with(&self, session: &mut Session, rows: &Sender<Row>) -> bool {
        while !self.is_over() {
            let place = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(&run) = self.wanted.get(place) else {
                return true;
            };
            let point = (run, self.points[run].as_slice());
            let Some(row) = self.sweep.one(session, point, self) else {
                return false;
            };
            if rows.send(row).is_err() {
                return true;
            }
        }
        true
    }
}

/// The hooks of a run of a sweep.
struct Hooks<'a>(&'a Crew<'a>);

impl Watch for Hooks<'_> {
    fn interrupted(&mut self) -> bool {
        self.0.is_over()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_later_call_goes_on_with_the_sessions_of_the_one_before() {
        let text = "a drop\nPART/1, GROUND\nPART/2, MASS=1, CM=2, IP=1,1,1\nMARKER/2, PART=2\n\
            VARIABLE/3, FUNCTION=1\nVFORCE/1, I=2, JFLOAT=9, FX=VARVAL(3), FY=0, FZ=0\n\
            MARKER/9, PART=1, FLOATING\nEND\n";
        let model = Model::from_text(text).unwrap();
        let mut sweep = Sweep::over(model, Analysis::Dynamic, 1.0, 10);
        sweep.parameter("VARIABLE/3").unwrap();
        sweep.measure("last(DX(2))").unwrap();
        let points: Vec<Vec<f64>> = (1..6).map(|k| vec![f64::from(k)]).collect();
        let compiled = |sweep: &Sweep| sweep.idle.0.lock().unwrap().len();
        let first = sweep.rows(&points, 1).unwrap();
        assert_eq!(compiled(&sweep), 1);
        assert_eq!(sweep.rows(&points, 1).unwrap(), first);
        assert_eq!(compiled(&sweep), 1);
        assert_eq!(sweep.clone().rows(&points, 2).unwrap(), first);

        // another request: nothing of before is used
        sweep.options.error = Some(1e-9);
        let finer = sweep.rows(&points[..1], 1).unwrap();
        assert_eq!(finer, sweep.clone().rows(&points[..1], 1).unwrap());
        assert_eq!(compiled(&sweep), 1);
        sweep.measure("max(DX(2))").unwrap();
        let more = sweep.rows(&points[..1], 1).unwrap();
        assert_eq!(more[0].measures.len(), 2);
        assert_eq!(compiled(&sweep), 1);
    }
}
