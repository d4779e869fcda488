//! Models that a Python program makes: the builder of the library, its statements as handles.

use crate::errors::{self, Kind};
use cognate::ModelBuilder;
use cognate::build::{Element, End, Key, Setting, Word};
use cognate::internals::dataset::manual::Entry;
use cognate::model::ElementKind;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A statement of a builder.
#[pyclass(module = "pycognate._core", frozen)]
pub struct Statement {
    key: Key,
    #[pyo3(get)]
    number: u32,
    /// "PART/2"; of settings the empty text
    #[pyo3(get)]
    element: String,
}

/// A value of an argument.
#[derive(FromPyObject)]
enum Given {
    Whole(i64),
    Real(f64),
    Text(String),
    Wholes(Vec<i64>),
    Reals(Vec<f64>),
    Texts(Vec<String>),
}

impl From<Given> for Setting {
    fn from(given: Given) -> Self {
        match given {
            Given::Whole(n) => Setting::Whole(n),
            Given::Real(x) => Setting::Real(x),
            Given::Text(text) => Setting::Text(text),
            Given::Wholes(all) => Setting::Wholes(all),
            Given::Reals(all) => Setting::Reals(all),
            Given::Texts(all) => Setting::Texts(all),
        }
    }
}

/// A model that a program makes.
#[pyclass(module = "pycognate._core", frozen)]
pub struct Builder {
    model: Mutex<ModelBuilder>,
}

impl Builder {
    fn model(&self) -> MutexGuard<'_, ModelBuilder> {
        self.model.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn foreign() -> PyErr {
    PyValueError::new_err("this statement belongs to another model, or is of another kind")
}

fn kind_of(keyword: &str) -> PyResult<ElementKind> {
    keyword.parse().map_err(PyValueError::new_err)
}

/// Returns the handle of a statement.
fn handle<K>(element: &Element<'_, K>) -> Statement {
    let (kind, number) = (element.kind(), element.number());
    Statement {
        key: element.key(),
        number,
        element: kind.map_or_else(String::new, |kind| kind.id(number).to_string()),
    }
}

/// Returns a statement as the end of a joint or force.
fn end(model: &ModelBuilder, of: &Statement) -> PyResult<End> {
    model.end(of.key).ok_or_else(foreign)
}

/// Returns the word that adds an element.
fn word_of(word: &str) -> PyResult<Word> {
    Word::find(word).map_err(|said| PyValueError::new_err(said.to_string()))
}

/// An argument of an element: keyword, kind of its value, unit, default, whether it is needed and
/// may be given several times, a sentence about it.
type Told = (
    String,
    &'static str,
    &'static str,
    &'static str,
    bool,
    bool,
    &'static str,
);

/// The words that add elements: word, keyword of the statement, whether it has two ends, a sentence
/// about it, its arguments.
#[pyfunction]
pub fn words() -> Vec<(String, &'static str, bool, &'static str, Vec<Told>)> {
    let all = Word::all().into_iter().map(|word| {
        let arguments = word
            .arguments()
            .into_iter()
            .map(|Entry { argument: a, note }| {
                let kind = a.kind.name();
                let (unit, default, meaning) = (note.unit, note.default, note.meaning);
                (
                    a.keyword(),
                    kind,
                    unit,
                    default,
                    a.required,
                    a.repeated,
                    meaning,
                )
            });
        let arguments = arguments.collect();
        let (summary, keyword) = (word.summary(), word.kind.keyword());
        (word.word, keyword, word.has_ends, summary, arguments)
    });
    all.collect()
}

#[pymethods]
impl Builder {
    #[new]
    fn new(title: &str) -> Self {
        Self {
            model: Mutex::new(ModelBuilder::new(title)),
        }
    }

    /// The part that does not move.
    #[getter]
    fn ground(&self) -> Statement {
        handle(&self.model().ground())
    }

    /// Add a statement with a number.
    fn element(&self, keyword: &str, name: &str) -> PyResult<Statement> {
        Ok(handle(&self.model().element(kind_of(keyword)?, name)))
    }

    /// Add an element by a word of the table.
    fn add(&self, word: &str, name: &str) -> PyResult<Statement> {
        Ok(handle(&self.model().add(&word_of(word)?, name)))
    }

    /// Add an element between two ends by a word of the table.
    fn add_between(
        &self,
        word: &str,
        name: &str,
        i: &Statement,
        j: &Statement,
    ) -> PyResult<Statement> {
        let model = self.model();
        let (i, j) = (end(&model, i)?, end(&model, j)?);
        Ok(handle(&model.add_between(&word_of(word)?, name, i, j)))
    }

    /// Return the statement without a number that has this keyword.
    fn settings(&self, keyword: &str) -> Statement {
        handle(&self.model().settings(keyword))
    }

    /// Add an element between two ends.
    fn between(
        &self,
        keyword: &str,
        name: &str,
        i: &Statement,
        j: &Statement,
    ) -> PyResult<Statement> {
        let model = self.model();
        let (i, j) = (end(&model, i)?, end(&model, j)?);
        Ok(handle(&model.between(kind_of(keyword)?, name, i, j)))
    }

    /// Give an argument of a statement its value.
    fn set(&self, of: &Statement, keyword: &str, value: Given) -> PyResult<()> {
        let model = self.model();
        let element = model.statement(of.key).ok_or_else(foreign)?;
        element.set(keyword, Setting::from(value));
        Ok(())
    }

    /// Give an argument that stands alone.
    fn flag(&self, of: &Statement, keyword: &str) -> PyResult<()> {
        let model = self.model();
        model.statement(of.key).ok_or_else(foreign)?.flag(keyword);
        Ok(())
    }

    /// Give FUNCTION as USER(), which a callable computes.
    fn user(&self, of: &Statement) -> PyResult<()> {
        let model = self.model();
        let element = model.statement(of.key).ok_or_else(foreign)?;
        element.set("FUNCTION", Setting::User(Vec::new()));
        Ok(())
    }

    /// Make a marker on a body at a place in ground.
    fn at(&self, body: &Statement, place: [f64; 3]) -> PyResult<Statement> {
        let model = self.model();
        let body = model.body(body.key).ok_or_else(foreign)?;
        Ok(handle(&body.at(place)))
    }

    /// Turn a marker: its z axis, and a direction in the half plane of its x axis.
    #[pyo3(signature = (marker, z, x))]
    fn turn(&self, marker: &Statement, z: [f64; 3], x: Option<[f64; 3]>) -> PyResult<()> {
        let model = self.model();
        let marker = model.frame(marker.key).ok_or_else(foreign)?;
        match x {
            Some(x) => marker.axes(z, x),
            None => marker.z(z),
        };
        Ok(())
    }

    /// Name a marker.
    fn rename(&self, marker: &Statement, name: &str) -> PyResult<()> {
        let model = self.model();
        model.frame(marker.key).ok_or_else(foreign)?.named(name);
        Ok(())
    }

    /// Make the model; return its dataset.
    fn build(&self, py: Python<'_>) -> PyResult<String> {
        let built = self.model().build();
        let model = built.map_err(|all| errors::exception(py, Kind::Model, all, None))?;
        Ok(model.to_text())
    }
}
