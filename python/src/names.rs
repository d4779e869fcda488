//! Variables, constants and functions of one's own in expressions.

use crate::watch::Raised;
use cognate::expr::Names;
use cognate::expr::ast::Dialect;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// The names that a caller gives, as Python has them.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub struct Given {
    variables: Vec<String>,
    constants: Vec<(String, f64)>,
    /// heads, and formulas or callables
    functions: Vec<(String, Py<PyAny>)>,
}

impl Given {
    /// Returns the names. What a callable raises is kept in `raised`, and its value is NaN.
    ///
    /// # Errors
    /// A function that is neither a text nor can be called.
    pub fn names(&self, py: Python<'_>, dialect: Dialect, raised: &Raised) -> PyResult<Names> {
        let variables = self.variables.iter().map(String::as_str);
        let mut names = Names::of(dialect).variables(variables);
        for (name, value) in &self.constants {
            names = names.constant(name, *value);
        }
        for (head, function) in &self.functions {
            let function = function.bind(py);
            names = match function.extract::<String>() {
                Ok(formula) => names.define(head, &formula),
                Err(_) => called(names, head, function, raised)?,
            };
        }
        Ok(names)
    }
}

/// Adds a callable, or one with another that gives its derivatives.
fn called(
    names: Names,
    head: &str,
    function: &Bound<'_, PyAny>,
    raised: &Raised,
) -> PyResult<Names> {
    let (name, n) = arguments(head)?;
    let raised = raised.clone();
    if let Ok(pair) = function.cast::<PyTuple>() {
        let (value, slopes): (Py<PyAny>, Py<PyAny>) = pair.extract()?;
        let law = move |given: &[f64], out: &mut [f64]| {
            let asked = Python::attach(|py| -> PyResult<f64> {
                let given = PyTuple::new(py, given)?;
                if !out.is_empty() {
                    let found: Vec<f64> = slopes.call1(py, given.clone())?.extract(py)?;
                    if found.len() != out.len() {
                        let (n, wanted) = (found.len(), out.len());
                        let counted = cognate::diagnostic::counted::<usize>;
                        let what = format!(
                            "{} for {}",
                            counted(n, "derivative"),
                            counted(wanted, "argument")
                        );
                        return Err(PyValueError::new_err(what));
                    }
                    out.copy_from_slice(&found);
                }
                value.call1(py, given)?.extract(py)
            });
            kept(asked, &raised)
        };
        return Ok(names.function_of_slice_with_slopes(name, n, law));
    }
    if !function.is_callable() {
        let what = format!("{head} is a text, a callable, or a tuple of two callables");
        return Err(PyTypeError::new_err(what));
    }
    let value = function.clone().unbind();
    Ok(names.function_of_slice(name, n, move |given| {
        let asked = Python::attach(|py| {
            let given = PyTuple::new(py, given)?;
            value.call1(py, given)?.extract(py)
        });
        kept(asked, &raised)
    }))
}

/// Returns a value, or NaN and keeps the exception.
fn kept(asked: PyResult<f64>, raised: &Raised) -> f64 {
    asked.unwrap_or_else(|e| {
        raised.keep(e);
        f64::NAN
    })
}

/// Returns the name and the number of arguments of a head: `f(x, y)`.
fn arguments(head: &str) -> PyResult<(&str, usize)> {
    let parts = head.split_once('(');
    let parts =
        parts.and_then(|(name, rest)| Some((name.trim(), rest.trim_end().strip_suffix(')')?)));
    match parts {
        Some((name, list)) => Ok((name, list.split(',').count())),
        None => {
            let what =
                format!("a function is given with its arguments, as in \"f(x, y)\": {head:?}");
            Err(PyValueError::new_err(what))
        }
    }
}

/// Returns true if no list holds a name.
pub fn is_empty(given: &Bound<'_, PyDict>) -> PyResult<bool> {
    for list in given.values() {
        if !list.is_empty()? {
            return Ok(false);
        }
    }
    Ok(true)
}
