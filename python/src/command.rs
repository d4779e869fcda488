//! The command line: what the program `cognate` does, in this process.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the command of these arguments; returns its exit code.
///
/// The process is the command's own (`pycognate/__main__.py`): output goes to its streams, and a
/// limit or a second Ctrl-C ends it. `program` are the words by which a shell calls it.
#[pyfunction]
pub fn command(py: Python<'_>, program: Vec<OsString>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| cognate_cli::obey(&program, arguments).code())
}
