//! Datasets: read, changed, written, verified.

use crate::errors::{self, Kind};
use cognate::Error;
use cognate::analysis::verify;
use cognate::dataset::command::{Command, Script, SimulationKind};
use cognate::dataset::{self, Dataset, Reading};
use cognate::diagnostic::{Diagnostic, Severity};
use cognate::internals::dataset::syntax::Source;
use cognate::model::{self, ElementKind};
use cognate::results::json;
use cognate::setup::{self, Asked, Prepared, Setup};
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A model as its dataset says.
#[pyclass(module = "pycognate._core", frozen)]
pub struct Model {
    /// the model, with the changes since it was read
    pub(crate) model: model::Model,
    /// the dataset as written, which knows the places
    dataset: Arc<Dataset>,
    /// the commands that have changed it since
    changes: Vec<String>,
    doubts: Vec<Diagnostic>,
    /// the set-up beside it, and the loads that were chosen
    pub(crate) prepared: Prepared,
}

impl Model {
    fn of(py: Python<'_>, reading: Reading, setup: Option<Setup>) -> PyResult<Self> {
        let Reading {
            dataset,
            mut model,
            diagnostics,
            ..
        } = reading;
        let is_error = |d: &Diagnostic| d.severity == Severity::Error;
        let (wrong, doubts): (Vec<_>, Vec<_>) = diagnostics.into_iter().partition(is_error);
        if !wrong.is_empty() {
            return Err(errors::exception(py, Kind::Model, wrong, None));
        }
        let prepared = match setup {
            Some(setup) => setup::apply(setup, &mut model, Asked::Kept)
                .map_err(|e| errors::exception(py, Kind::Model, e, None))?,
            None => Prepared::default(),
        };
        let dataset = Arc::new(dataset);
        Ok(Self {
            model,
            dataset,
            changes: Vec::new(),
            doubts,
            prepared,
        })
    }

    /// Returns the exception for mistakes in the model, each with the place of its element.
    pub fn raise(&self, py: Python<'_>, all: Error) -> PyErr {
        let located = all.map(|d| self.dataset.locate(d));
        errors::exception(py, Kind::Model, located, None)
    }

    /// Returns the folder of its file.
    pub fn folder(&self) -> Option<PathBuf> {
        let file = self.dataset.source.file.as_ref().map(PathBuf::from)?;
        file.parent().map(ToOwned::to_owned)
    }
}

#[pymethods]
impl Model {
    /// Read a dataset from a file, with the set-up beside it unless `setup` is false.
    #[staticmethod]
    #[pyo3(signature = (path, setup = true))]
    fn read(py: Python<'_>, path: PathBuf, setup: bool) -> PyResult<Self> {
        let raised = |e: Error| errors::exception(py, Kind::Model, e, None);
        let reading = py.detach(|| dataset::read(&path)).map_err(raised)?;
        let setup = setup.then(|| Setup::beside(&path)).transpose();
        Self::of(py, reading, setup.map_err(raised)?)
    }

    /// Read a dataset from a text; `file`: the name it goes by; `setup`: the text of a set-up.
    #[staticmethod]
    #[pyo3(signature = (text, file = None, setup = None))]
    fn from_text(
        py: Python<'_>,
        text: &str,
        file: Option<&str>,
        setup: Option<String>,
    ) -> PyResult<Self> {
        let raised = |e: Error| errors::exception(py, Kind::Model, e, None);
        let reading = py.detach(|| dataset::read_source(Source::from_text(file, text)));
        let named = PathBuf::from(file.unwrap_or_default()).with_extension("toml");
        let setup = setup.map(|text| Setup::read(named, text)).transpose();
        Self::of(py, reading, setup.map_err(raised)?)
    }

    /// The text of the set-up beside it; empty where there is none.
    #[getter]
    fn setup(&self) -> &str {
        &self.prepared.setup.text
    }

    /// The set-up of a run: its kind, end and output steps.
    #[getter]
    fn solve(&self) -> (Option<&'static str>, Option<f64>, Option<usize>) {
        let solve = &self.prepared.setup.solve;
        let kind = solve.kind.map(|kind| match kind {
            SimulationKind::Kinematic => "kinematic",
            SimulationKind::Dynamic => "dynamic",
            SimulationKind::Static => "static",
            SimulationKind::Transient => "transient",
            SimulationKind::InitialConditions => "initial_conditions",
        });
        (kind, solve.end, solve.steps)
    }

    /// The loads that act where some were chosen, and those that are left out.
    #[getter]
    fn loads(&self) -> Option<(Vec<String>, Vec<String>)> {
        let loads = self.prepared.loads.as_ref()?;
        Some((loads.acting.clone(), loads.left_out.clone()))
    }

    /// The dataset as text: as written, or as the changes have left it.
    #[getter]
    fn text(&self) -> String {
        match self.changes.is_empty() {
            true => self.written(),
            false => self.model.to_text(),
        }
    }

    /// The dataset as text, as written.
    #[getter]
    fn written(&self) -> String {
        self.dataset.to_text().to_owned()
    }

    /// The commands that have changed it since it was read.
    #[getter]
    fn changes(&self) -> Vec<String> {
        self.changes.clone()
    }

    /// The file that it was read from.
    #[getter]
    fn file(&self) -> Option<&str> {
        self.dataset.source.file.as_deref()
    }

    /// The first line of the dataset.
    #[getter]
    fn title(&self) -> &str {
        &self.model.title
    }

    /// Every element that is solved: keyword, number, the name that the dataset gives.
    #[getter]
    fn elements(&self) -> Vec<(&'static str, u32, Option<String>)> {
        let mut all = Vec::new();
        for kind in ElementKind::ALL {
            for number in self.model.numbers(*kind) {
                let name = self.model.element(kind.id(number));
                let name = name.and_then(|element| element.place().name.clone());
                all.push((kind.keyword(), number, name));
            }
        }
        all
    }

    /// Warnings and notes about the dataset.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let doubts = self.model.doubts();
        let more = doubts.into_iter().map(|d| self.dataset.locate(d));
        let all: Vec<_> = self.doubts.iter().cloned().chain(more).collect();
        Ok(errors::diagnostics(py, &all)?.into_any())
    }

    /// Return a model changed by commands that change statements.
    fn changed(&self, py: Python<'_>, commands: &str) -> PyResult<Self> {
        let raised = |e: Error| errors::exception(py, Kind::Model, e, None);
        let mut model = self.model.clone();
        // a first line that is no command would be taken as the name of a dataset
        for step in Script::from_text(&format!("\n{commands}\n"))
            .map_err(raised)?
            .steps
        {
            match &step.command {
                Command::Change(_) | Command::Activate { .. } => {
                    model.apply(&step.command).map_err(raised)?;
                }
                _ => {
                    let what = format!("`{}` does not change the model", step.text);
                    let d = Diagnostic::error("usage", what);
                    let d = d.help("simulations are asked for by run, or by a command file");
                    return Err(errors::exception(py, Kind::Model, d, None));
                }
            }
        }
        let dataset = Arc::clone(&self.dataset);
        Ok(Self {
            model,
            dataset,
            changes: [&self.changes[..], &[commands.to_owned()]].concat(),
            doubts: self.doubts.clone(),
            prepared: self.prepared.clone(),
        })
    }

    /// Count the freedoms and explain them; returns JSON.
    fn verify(&self, py: Python<'_>) -> PyResult<String> {
        let found = py.detach(|| verify::verify(&self.model));
        let found = found.map_err(|all| self.raise(py, all))?;
        Ok(json::text(&found.json()))
    }
}
