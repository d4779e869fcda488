//! Diagnostics as Python exceptions: the classes stand in `pycognate/_errors.py`.

use cognate::Error;
use cognate::diagnostic::{Diagnostic, Severity};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use std::path::Path;

/// The exception that tells about mistakes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// a mistake in an expression, or a value that it does not have
    Expr,
    /// mistakes in a dataset, in commands, or in a model
    Model,
    /// a file of results that cannot be read or written
    Results,
    /// a column that a run does not have
    Column,
}

impl Kind {
    fn class(self) -> &'static str {
        match self {
            Kind::Expr => "ExprError",
            Kind::Model => "ModelError",
            Kind::Results => "ResultsError",
            Kind::Column => "ColumnError",
        }
    }
}

/// Options of the command line, and the keywords for the same in Python; `*` stands for the word
/// behind.
const KEYWORDS: [(&str, &str); 6] = [
    ("--skip-unsupported *", "skip=[\"*\"]"),
    ("--zero-user", "zero_user=True"),
    ("--piecewise", "piecewise=True"),
    ("--method *", "method=\"*\""),
    ("--error", "error"),
    (
        "load the library that has it (--routines), register a closure for it in a program",
        "register a function for it (Model.user)",
    ),
];

/// Returns a text with the keywords of Python in place of the options of the command line.
fn in_keywords(text: &str) -> String {
    let mut text = text.to_owned();
    for (option, keyword) in KEYWORDS {
        let head = option.trim_end_matches('*');
        let Some((before, after)) = text.split_once(head) else {
            continue;
        };
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let end = match option == head {
            true => 0,
            false => after.find(|c| !is_word(c)).unwrap_or(after.len()),
        };
        let (word, rest) = after.split_at(end);
        text = format!("{before}{}{rest}", keyword.replace('*', word));
    }
    text
}

/// Returns a diagnostic as a `pycognate.Diagnostic`.
///
/// # Errors
/// Whatever Python raises when the object is made.
pub fn diagnostic<'py>(py: Python<'py>, d: &Diagnostic) -> PyResult<Bound<'py, PyAny>> {
    let mut d = d.clone();
    d.message = in_keywords(&d.message);
    d.help.iter_mut().for_each(|help| *help = in_keywords(help));
    d.element = d.element.map(|element| in_keywords(&element));
    let severity = match d.severity {
        Severity::Note => "note",
        Severity::Warning => "warning",
        Severity::Error => "error",
    };
    let known = |place: usize| (place > 0).then_some(place);
    let fields = PyDict::new(py);
    fields.set_item("code", d.code)?;
    fields.set_item("severity", severity)?;
    fields.set_item("message", &d.message)?;
    fields.set_item("file", &d.file)?;
    fields.set_item("line", known(d.line))?;
    fields.set_item("column", known(d.column))?;
    fields.set_item("element", &d.element)?;
    fields.set_item("name", &d.name)?;
    fields.set_item("argument", d.argument)?;
    fields.set_item("advice", PyTuple::new(py, &d.help)?)?;
    fields.set_item("text", d.to_string())?;
    let class = module(py)?.getattr("Diagnostic")?;
    class.call((), Some(&fields))
}

/// Returns diagnostics as a list of `pycognate.Diagnostic`.
///
/// # Errors
/// Whatever Python raises when the objects are made.
pub fn diagnostics<'py>(py: Python<'py>, all: &[Diagnostic]) -> PyResult<Bound<'py, PyList>> {
    let all: Vec<_> = (all.iter())
        .map(|d| diagnostic(py, d))
        .collect::<PyResult<_>>()?;
    PyList::new(py, all)
}

/// Codes of mistakes that name a file which cannot be read.
const NO_FILE: [&str; 2] = ["cannot_open", "file_unreadable"];

/// Returns whether the first mistake is a file that is not there.
fn is_missing(all: &Error) -> bool {
    let first = all.first();
    let file = first
        .file
        .as_ref()
        .filter(|_| NO_FILE.contains(&first.code));
    file.is_some_and(|file| !Path::new(file).exists())
}

/// Returns the exception for mistakes, all of them in its `errors`; `source`: the text of the
/// expression that they are in. Where a file is not there it is a `FileNotFoundError` as well.
pub fn exception(py: Python<'_>, kind: Kind, all: impl Into<Error>, source: Option<&str>) -> PyErr {
    let all = all.into();
    let raised = || -> PyResult<PyErr> {
        let class = match (kind, is_missing(&all)) {
            (Kind::Model, true) => "ModelFileNotFound",
            (Kind::Results, true) => "ResultsFileNotFound",
            (kind, _) => kind.class(),
        };
        let class = module(py)?.getattr(class)?;
        let value = class.call1((diagnostics(py, all.diagnostics())?, source))?;
        Ok(PyErr::from_value(value))
    };
    raised().unwrap_or_else(|failure| failure)
}

fn module(py: Python<'_>) -> PyResult<Bound<'_, PyModule>> {
    py.import("pycognate._errors")
}
