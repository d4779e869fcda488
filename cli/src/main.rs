//! The program `cognate`: the command line, in a process with a heap of its own.

#![cfg_attr(not(feature = "native"), forbid(unsafe_code))]

#[cfg(feature = "native")]
mod limited;

use std::process::ExitCode;

/// Runs the command that the arguments of the process name.
fn main() -> ExitCode {
    // what has no file is found by its name
    let program = std::env::current_exe().unwrap_or_else(|_| "cognate".into());
    let arguments = std::env::args_os().skip(1).collect();
    ExitCode::from(cognate_cli::obey(&[program.into()], arguments).code())
}
