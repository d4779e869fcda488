//! Many runs of one model, with Python's lock released.

use crate::errors::{self, Kind};
use crate::model::Model;
use crate::session::{Choices, Commands, Simulation, check_columns};
use crate::watch::{BETWEEN_LOOKS, Raised};
use cognate::Error;
use cognate::analysis::sweep::design::{self, Values};
use cognate::analysis::sweep::{self, Follow, Parameter, Row};
use cognate::dataset::command::{Command, Step};
use cognate::results::Status;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// Index of the point, parameters, measures, word of the status, number of warnings, reason.
type Told = (usize, Vec<f64>, Vec<f64>, &'static str, usize, String);

/// The same, as Python gives it back.
type Given = (usize, Vec<f64>, Vec<f64>, String, usize, String);

fn told(row: Row) -> Told {
    let Row {
        run,
        values,
        measures,
        status,
        warnings,
        reason,
    } = row;
    (run, values, measures, status.word(), warnings, reason)
}

fn row((run, values, measures, word, warnings, reason): Given) -> PyResult<Row> {
    let status = Status::ALL.into_iter().find(|s| s.word() == word);
    Ok(Row {
        run,
        values,
        measures,
        status: status.ok_or_else(|| PyValueError::new_err(format!("{word} is no status")))?,
        warnings,
        reason,
    })
}

/// A model, its parameters and measures, and the commands that each run obeys.
#[pyclass(module = "pycognate._core", frozen)]
pub struct Sweep {
    sweep: sweep::Sweep,
    raised: Raised,
}

/// Values of a parameter: a text as `--set` takes it, or numbers.
#[derive(FromPyObject)]
pub enum Listed {
    Text(String),
    Numbers(Vec<f64>),
}

/// Stops the threads of a sweep.
struct Stop(AtomicBool);

impl Follow for Stop {
    fn interrupted(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Returns a closure that raises the mistakes of a library call.
fn raised(py: Python<'_>) -> impl Fn(Error) -> PyErr {
    move |all| errors::exception(py, Kind::Model, all, None)
}

#[pymethods]
impl Sweep {
    /// `commands` are obeyed by each run; without them it does `simulation`.
    #[new]
    fn new(
        py: Python<'_>,
        model: &Model,
        choices: Choices,
        simulation: Simulation,
        commands: Option<&Commands>,
        parameters: Vec<String>,
        measures: Vec<String>,
    ) -> PyResult<Self> {
        let steps = match commands {
            Some(commands) => commands.steps().to_vec(),
            None => vec![Step {
                command: Command::Simulate(simulation.simulate()?),
                text: "SIMULATE".into(),
                line: 0,
            }],
        };
        let mut sweep = sweep::Sweep::new(model.model.clone(), steps);
        let (options, user) = choices.options(model)?;
        check_columns(py, model, &options.columns)?;
        sweep.options = options;
        sweep.folders = model.folder().into_iter().collect();
        let raised = Raised::default();
        for routine in user {
            let (name, inputs, law) = routine.law(&raised);
            let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
            sweep.register(&name, &inputs, law);
        }
        let mut wrong = Vec::new();
        let asked = parameters.iter().map(|name| sweep.parameter(name));
        let asked: Vec<_> = asked.collect();
        let asked = asked.into_iter();
        wrong.extend(asked.filter_map(Result::err).flatten());
        let asked: Vec<_> = measures.iter().map(|text| sweep.measure(text)).collect();
        wrong.extend(asked.into_iter().filter_map(Result::err).flatten());
        if wrong.is_empty() {
            Ok(Self { sweep, raised })
        } else {
            Err(errors::exception(py, Kind::Model, wrong, None))
        }
    }

    /// Names of the parameters, as tables have them.
    #[getter]
    fn parameters(&self) -> Vec<&str> {
        let all = self.sweep.parameters();
        all.iter().map(Parameter::name).collect()
    }

    /// Names and units of the measures.
    #[getter]
    fn measures(&self) -> Vec<(&str, &str)> {
        let all = self.sweep.measures();
        all.iter().map(|m| (m.name(), m.unit())).collect()
    }

    /// Run some of the points; hand each row over as it is done.
    fn run(
        &self,
        py: Python<'_>,
        points: Vec<Vec<f64>>,
        wanted: Vec<usize>,
        threads: usize,
        each: Py<PyAny>,
    ) -> PyResult<()> {
        if wanted.iter().any(|&run| run >= points.len()) {
            return Err(PyValueError::new_err("there is no such point"));
        }
        let (stop, refused) = (Stop(AtomicBool::new(false)), self.raised.clone());
        let outcome = py.detach(|| {
            let (sender, rows) = channel();
            std::thread::scope(|scope| {
                let (points, wanted, stop) = (&points, &wanted, &stop);
                let work = scope.spawn(move || {
                    self.sweep.run(points, wanted, threads, stop, |row| {
                        // where nobody listens, the sweep has been stopped
                        let _ = sender.send(row);
                        Ok(())
                    })
                });
                let mut looked = Instant::now();
                loop {
                    let next = rows.recv_timeout(BETWEEN_LOOKS);
                    let look = looked.elapsed() >= BETWEEN_LOOKS;
                    let seen = match next {
                        Err(RecvTimeoutError::Disconnected) => break,
                        // what a routine has raised ends the sweep; its row is not one
                        _ if refused.is_set() => {
                            stop.0.store(true, Ordering::Relaxed);
                            continue;
                        }
                        Ok(row) => Python::attach(|py| each.call1(py, (told(row),)).map(drop)),
                        Err(RecvTimeoutError::Timeout) => Ok(()),
                    };
                    let checked = match look {
                        true => Python::attach(|py| py.check_signals()),
                        false => Ok(()),
                    };
                    if look {
                        looked = Instant::now();
                    }
                    if let Err(e) = seen.and(checked) {
                        refused.keep(e);
                    }
                }
                work.join()
            })
        });
        if let Some(e) = self.raised.take() {
            return Err(e);
        }
        match outcome {
            Ok(done) => done.map_err(raised(py)),
            Err(_) => Err(PyValueError::new_err("the sweep has failed by our mistake")),
        }
    }

    /// Return rows as the text of a table, as `cognate sweep` writes it.
    fn table(&self, rows: Vec<Given>) -> PyResult<String> {
        let rows: Vec<Row> = rows.into_iter().map(row).collect::<PyResult<_>>()?;
        Ok(self.sweep.table(&rows))
    }
}

/// The growing table of a sweep, with which an interrupted one is gone on.
#[pyclass(module = "pycognate._core", frozen)]
pub struct Table {
    table: Mutex<sweep::Table>,
}

impl Table {
    fn table(&self) -> std::sync::MutexGuard<'_, sweep::Table> {
        self.table.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Table {
    /// Begin a table, or go on with the one that is there.
    #[new]
    fn new(py: Python<'_>, path: PathBuf, of: &Sweep, points: Vec<Vec<f64>>) -> PyResult<Self> {
        let table = sweep::Table::open(&path, &of.sweep, &points).map_err(raised(py))?;
        Ok(Self {
            table: Mutex::new(table),
        })
    }

    /// Indices of the points that have no row so far.
    #[getter]
    fn missing(&self) -> Vec<usize> {
        self.table().missing()
    }

    /// The rows so far.
    #[getter]
    fn rows(&self) -> Vec<Told> {
        self.table().rows().iter().cloned().map(told).collect()
    }

    /// Add a row; when it returns, the line is in the file.
    fn push(&self, py: Python<'_>, row: Given) -> PyResult<()> {
        let pushed = self.table().push(self::row(row)?);
        pushed.map_err(raised(py))
    }

    /// Put the lines into the order of the points.
    fn complete(&self, py: Python<'_>) -> PyResult<()> {
        let completed = self.table().complete();
        completed.map_err(raised(py))
    }
}

/// Return the points of a design: "grid", or "latin" with `runs` points of a seed.
#[pyfunction]
pub fn design_points(
    py: Python<'_>,
    design: &str,
    values: Vec<Listed>,
    runs: Option<usize>,
    seed: u64,
) -> PyResult<Vec<Vec<f64>>> {
    let values = values.into_iter().map(|listed| match listed {
        Listed::Text(text) => text.parse::<Values>(),
        Listed::Numbers(all) => Ok(Values::List(all)),
    });
    let values: Vec<Values> = values.collect::<Result<_, _>>().map_err(raised(py))?;
    let points = match (design, runs) {
        ("grid", None) => {
            let all = values
                .iter()
                .map(Values::all)
                .collect::<Result<Vec<_>, _>>();
            all.and_then(|all| design::grid(&all))
        }
        ("latin", Some(runs)) => design::latin(&values, runs, seed),
        ("latin", None) => return Err(PyValueError::new_err("design=\"latin\" needs runs=")),
        ("grid", Some(_)) => return Err(PyValueError::new_err("runs= goes with design=\"latin\"")),
        _ => {
            let what = format!("design={design:?}: it is \"grid\" or \"latin\"");
            return Err(PyValueError::new_err(what));
        }
    };
    points.map_err(raised(py))
}
