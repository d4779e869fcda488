//! The compiled half of the Python package `pycognate`: expressions, models, sessions, results.
//!
//! Everything that costs time happens here, with Python's lock released; `pycognate/*.py` dresses it
//! for Python. Arrays of results are views of the memory of a [`results::Results`], without a copy.
//! A mistake of the user becomes one of the exceptions of `pycognate/_errors.py`, which hold every
//! diagnostic.
//!
//! ```text
//! arrays.rs    numbers of Python: scalars, lists, arrays of any layout
//! errors.rs    diagnostics as exceptions
//! expr.rs      one expression over arrays
//! names.rs     variables, constants and functions of one's own in it
//! model.rs     datasets
//! session.rs   simulations, one after another
//! watch.rs     Ctrl-C and progress while they go on
//! user.rs      USER(…) as Python callables
//! results.rs   tables of results, and files
//! builder.rs   models that a program makes
//! command.rs   the command line
//! sweep.rs     many runs of one model
//! ```

mod arrays;
mod builder;
mod command;
mod errors;
mod expr;
mod model;
mod names;
mod results;
mod session;
mod sweep;
mod user;
mod watch;

use pyo3::pymodule;

/// Compiled part of cognate.
#[pymodule]
mod _core {
    #[pymodule_export]
    use super::builder::{Builder, Statement, words};
    #[pymodule_export]
    use super::command::command;
    #[pymodule_export]
    use super::expr::Expr;
    #[pymodule_export]
    use super::model::Model;
    #[pymodule_export]
    use super::results::Results;
    #[pymodule_export]
    use super::session::{Commands, Session};
    #[pymodule_export]
    use super::sweep::{Sweep, Table, design_points};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn add_version(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
