//! Simulations of a model, one after another, each from where the last one ended.

use crate::errors::{self, Kind};
use crate::model::Model;
use crate::results::Results;
use crate::user::Routine;
use crate::watch::{Attended, Raised};
use cognate::Error;
use cognate::analysis::linear::Wanted;
use cognate::analysis::session::script::obey;
use cognate::analysis::session::state::Saved;
use cognate::analysis::session::{self, Accuracy, Options};
use cognate::dataset::command::{Command, Script, Simulate, SimulationKind, Step};
use cognate::model::{ElementKind, SettingsStatement};
use cognate::results::{Event, Status, json};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyString;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, TryLockError};

/// The choices of a user, as keywords of `run`.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Choices {
    name: String,
    columns: Vec<String>,
    error: Option<f64>,
    method: Option<String>,
    accuracy: Option<bool>,
    full: Option<bool>,
    frames: bool,
    max_steps: Option<usize>,
    limit: Option<f64>,
    threads: Option<usize>,
    skip: Vec<String>,
    zero_user: bool,
    piecewise: bool,
    user: Vec<Routine>,
}

impl Choices {
    /// Returns the options of the library, and the routines for USER.
    ///
    /// # Errors
    /// A keyword of `skip` that is no statement.
    pub fn options(self, of: &Model) -> PyResult<(Options, Vec<Routine>)> {
        let skip = self.skip.iter().map(|keyword| {
            let unknown = |_| PyValueError::new_err(format!("skip: {keyword} is no statement"));
            keyword
                .to_uppercase()
                .parse::<ElementKind>()
                .map_err(unknown)
        });
        let mut options = Options {
            skip: skip.collect::<PyResult<BTreeSet<_>>>()?,
            error: self.error,
            method: self.method,
            repeat: 1,
            columns: self.columns,
            full: (self.full)
                .unwrap_or_else(|| of.model.settings.contains_key(&SettingsStatement::Results)),
            named_only: self.full == Some(false),
            frames: self.frames,
            piecewise: self.piecewise,
            zero_user: self.zero_user,
            max_steps: self.max_steps,
            limit: self.limit,
            threads: self.threads,
            accuracy: match self.accuracy {
                Some(true) => Accuracy::Bars,
                // a routine of the caller's is not called again without being asked for
                None if self.user.is_empty() => Accuracy::Digits,
                _ => Accuracy::Unknown,
            },
            ..Options::default()
        };
        of.prepared.setup.solve.complete(&mut options);
        Ok((options, self.user))
    }
}

/// A simulation as Python asks for it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Simulation {
    kind: String,
    end: Option<f64>,
    duration: Option<f64>,
    steps: Option<u32>,
    dtout: Option<f64>,
}

impl Simulation {
    /// Returns the command.
    ///
    /// # Errors
    /// A word that is no kind of simulation.
    pub fn simulate(&self) -> PyResult<Simulate> {
        let kind = match self.kind.as_str() {
            "transient" => SimulationKind::Transient,
            "dynamic" => SimulationKind::Dynamic,
            "kinematic" => SimulationKind::Kinematic,
            "static" => SimulationKind::Static,
            "initial_conditions" => SimulationKind::InitialConditions,
            kind => {
                return Err(PyValueError::new_err(format!(
                    "kind={kind:?}: it is \"transient\", \"dynamic\", \"kinematic\", \
                     \"static\" or \"initial_conditions\""
                )));
            }
        };
        Ok(Simulate {
            kind,
            end: self.end,
            duration: self.duration,
            steps: self.steps,
            dtout: self.dtout,
        })
    }
}

/// A model and its clock.
#[pyclass(module = "pycognate._core", frozen)]
pub struct Session {
    model: Py<Model>,
    session: Mutex<session::Session>,
    raised: Raised,
}

impl Session {
    /// Returns the session, unless another thread is at work in it: waiting would stop that one,
    /// which needs Python now and then.
    fn locked(&self) -> PyResult<MutexGuard<'_, session::Session>> {
        match self.session.try_lock() {
            Ok(session) => Ok(session),
            Err(TryLockError::WouldBlock) => Err(PyRuntimeError::new_err(
                "another thread is at work in this session",
            )),
            Err(TryLockError::Poisoned(_)) => Err(PyRuntimeError::new_err(
                "a simulation of this session has failed by our mistake",
            )),
        }
    }

    /// Does something long with the session while other threads use Python.
    fn work<T: Send>(
        &self,
        py: Python<'_>,
        progress: Option<Py<PyAny>>,
        go: impl FnOnce(&mut session::Session, &mut Attended) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        let mut locked = self.locked()?;
        let session = &mut *locked;
        let mut attended = Attended::new(self.raised.clone(), progress);
        let outcome = py.detach(|| go(session, &mut attended));
        if let Some(e) = self.raised.take() {
            return Err(e);
        }
        outcome.map_err(|all| self.model.get().raise(py, all))
    }
}

#[pymethods]
impl Session {
    #[new]
    fn new(py: Python<'_>, model: Py<Model>, choices: Choices) -> PyResult<Self> {
        let of = model.get();
        let name = choices.name.clone();
        let (options, user) = choices.options(of)?;
        check_columns(py, of, &options.columns)?;
        let raised = Raised::default();
        let mut session = session::Session::new(of.model.clone(), &name, options);
        session.folders = of.folder().into_iter().collect();
        session.run.record.loads.clone_from(&of.prepared.loads);
        session.at_rest_first = of.prepared.setup.solve.at_rest_first;
        let title = Event::Title(session.run.title.clone());
        session.run.log.push(title);
        for routine in user {
            routine.register(&mut session, &raised);
        }
        Ok(Self {
            model,
            session: Mutex::new(session),
            raised,
        })
    }

    /// Simulate once. Returns the word of its status.
    #[pyo3(signature = (simulation, progress))]
    fn simulate(
        &self,
        py: Python<'_>,
        simulation: Simulation,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<&'static str> {
        let simulate = simulation.simulate()?;
        let status = self.work(py, progress, |session, watch| {
            session.simulate_as(&simulate, watch)
        });
        status.map(Status::word)
    }

    /// Obey a command file, or commands given as a text. Returns the word of the last status.
    #[pyo3(signature = (script, progress))]
    fn obey(
        &self,
        py: Python<'_>,
        script: &Commands,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<&'static str> {
        let steps = &script.script.steps;
        let status = self.work(py, progress, |session, watch| {
            obey(session, steps, |_, _| (), watch)
        });
        status.map(Status::word)
    }

    /// Linearize about the present state. Returns JSON.
    #[pyo3(signature = (inputs, outputs, no_damping))]
    fn linearize(
        &self,
        py: Python<'_>,
        inputs: Option<u32>,
        outputs: Option<u32>,
        no_damping: bool,
    ) -> PyResult<String> {
        let wanted = Wanted {
            inputs,
            outputs,
            no_damping,
            shapes: None,
        };
        let found = self.work(py, None, |session, _| session.linearize(&wanted))?;
        Ok(json::text(&found.json()))
    }

    /// The clock.
    #[getter]
    fn time(&self) -> PyResult<f64> {
        Ok(self.locked()?.time())
    }

    /// The state as a text, from which another session goes on.
    #[getter]
    fn state(&self) -> PyResult<String> {
        Ok(self.locked()?.save())
    }

    /// Go on from a state.
    fn reload(&self, py: Python<'_>, state: &str) -> PyResult<()> {
        let raised = |e: Error| errors::exception(py, Kind::Model, e, None);
        let saved = Saved::read(state.as_bytes()).map_err(raised)?;
        self.locked()?.reload(saved).map_err(raised)
    }

    /// Return a copy of the results so far.
    fn results(&self) -> PyResult<Results> {
        Ok(Results::new(self.locked()?.run.clone()))
    }

    /// Return the results without copying them; the session has none afterwards.
    fn finish(&self) -> PyResult<Results> {
        Ok(Results::new(std::mem::take(&mut self.locked()?.run)))
    }
}

/// Complains of columns that cannot be had, all at once.
pub fn check_columns(py: Python<'_>, model: &Model, columns: &[String]) -> PyResult<()> {
    let mut wrong = Vec::new();
    for (k, text) in columns.iter().enumerate() {
        for mut d in session::check_column(&model.model, text) {
            d.file = Some(format!("columns[{k}]"));
            wrong.push(d);
        }
    }
    if wrong.is_empty() {
        return Ok(());
    }
    let only = columns.len() == 1;
    let source = columns.first().filter(|_| only).map(String::as_str);
    Err(errors::exception(py, Kind::Model, wrong, source))
}

/// Commands of a file or a text.
#[pyclass(module = "pycognate._core", frozen)]
pub struct Commands {
    script: Script,
}

impl Commands {
    /// The commands.
    pub fn steps(&self) -> &[Step] {
        &self.script.steps
    }
}

#[pymethods]
impl Commands {
    /// Read a command file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let script = py.detach(|| Script::read(&path));
        let raised = |e: Error| errors::exception(py, Kind::Model, e, None);
        Ok(Self {
            script: script.map_err(raised)?,
        })
    }

    /// Read commands from a text.
    #[staticmethod]
    fn from_text(py: Python<'_>, text: &Bound<'_, PyString>) -> PyResult<Self> {
        // a first line that is no command would be taken as the name of a dataset
        let script = Script::from_text(&format!("\n{}\n", text.to_cow()?));
        let raised = |e: Error| errors::exception(py, Kind::Model, e, None);
        Ok(Self {
            script: script.map_err(raised)?,
        })
    }

    /// The dataset that the file names.
    #[getter]
    fn model_file(&self) -> Option<PathBuf> {
        self.script.model_file()
    }

    /// The time at which the last simulation ends, where all say it.
    #[getter]
    fn end(&self) -> Option<f64> {
        let simulations = self
            .script
            .steps
            .iter()
            .filter_map(|step| match &step.command {
                Command::Simulate(simulate) => Some((simulate.end, simulate.duration)),
                _ => None,
            });
        let mut last = Some(0.0);
        for (end, duration) in simulations {
            last = end.or_else(|| Some(last? + duration?)).or(last);
        }
        last.filter(|&end| end > 0.0)
    }

    /// The base name of results that the file gives.
    #[getter]
    fn output(&self) -> Option<&str> {
        self.script.output.as_deref()
    }
}
