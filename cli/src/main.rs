//! The command line: one command, one verb, one file.
//!
//! A verb collects its messages and returns its outcome; only this file knows exit codes and
//! streams. Results go to standard output, everything about them (mistakes, warnings, progress) to
//! standard error.

#![cfg_attr(not(feature = "native"), forbid(unsafe_code))]

mod anatomy;
mod animate;
mod arguments;
mod assembly;
mod card;
mod check;
mod configuration;
mod convert;
mod data;
mod doubted;
mod draw;
mod elements;
mod eval;
mod example;
mod explain;
mod export;
mod fmt;
mod formula;
mod functions;
mod group;
mod grouped;
#[cfg(feature = "geometry")]
mod interference;
mod interrupt;
mod limit;
mod linear;
mod loads;
mod mdi;
mod memory;
mod modes;
mod motion;
mod moved;
mod output;
mod plot;
mod progress;
mod recorded;
mod render;
mod repl;
mod report;
mod response;
mod run;
mod runs;
mod setup;
mod statements;
mod summary;
mod sweep;
mod table;
mod verify;
mod width;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use cognate::dataset::Dataset;
use cognate::diagnostic::{Cause, Diagnostic, Error, Span};
use render::Sources;
use std::io::Write;
use std::process::ExitCode;

/// The ADAMS function language and the multibody solver that speaks it.
#[derive(Parser)]
#[command(name = "cognate", version, arg_required_else_help = true, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

/// The arguments of a verb are described where it is asked for: those of all of them were a
/// millisecond of every run.
#[derive(Subcommand)]
#[command(defer = true)]
enum Verb {
    Animate(animate::Args),
    Check(check::Args),
    Configuration(configuration::Args),
    Convert(convert::Args),
    Draw(draw::Args),
    Elements(elements::Args),
    Eval(eval::Args),
    Explain(explain::Args),
    Export(export::Args),
    Fmt(fmt::Args),
    Functions(functions::Args),
    Group(group::Args),
    #[cfg(feature = "geometry")]
    Interference(interference::Args),
    Linear(linear::Args),
    Loads(loads::Args),
    Mdi(mdi::Args),
    Motion(motion::Args),
    #[command(aliases = ["graph", "chart"])]
    Plot(plot::Args),
    Repl(repl::Args),
    Report(report::Args),
    #[command(aliases = ["solve", "simulate"])]
    Run(run::Args),
    Runs(runs::Args),
    Statements(statements::Args),
    Sweep(sweep::Args),
    Verify(verify::Args),
}

const EXIT_CODES: &str = "\
Exit codes: 0 done, 1 our mistake, 2 usage, 3 input (syntax, names), 4 model (freedom, contradiction, inertia),
5 no equilibrium, 6 integration stopped early, 7 limit (time, memory, steps), 8 a check failed,
9 results could not be written, 130 interrupted.";

/// The outcome of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// everything was done
    Done,
    /// a mistake of ours
    Bug,
    /// the command was not understood
    Usage,
    /// the input has mistakes: syntax, names, files
    Input,
    /// the model cannot work: freedom, contradiction, inertia
    Model,
    /// no equilibrium was found
    NoEquilibrium,
    /// the integration stopped early
    Stopped,
    /// a limit of time, memory or steps was reached
    Limit,
    /// a check that was asked for failed
    CheckFailed,
    /// results could not be written
    Unwritable,
    /// the user interrupted it
    Interrupted,
}

impl Exit {
    /// Returns its number.
    pub fn code(self) -> u8 {
        match self {
            Exit::Done => 0,
            Exit::Bug => 1,
            Exit::Usage => 2,
            Exit::Input => 3,
            Exit::Model => 4,
            Exit::NoEquilibrium => 5,
            Exit::Stopped => 6,
            Exit::Limit => 7,
            Exit::CheckFailed => 8,
            Exit::Unwritable => 9,
            Exit::Interrupted => 130,
        }
    }
}

/// The reason why a command could not be done: its exit code, its messages, and the texts they
/// refer to.
pub struct Failure {
    /// the exit code
    pub exit: Exit,
    /// all mistakes
    pub diagnostics: Vec<Diagnostic>,
    /// texts that the places refer to
    pub sources: Sources,
}

impl From<Diagnostic> for Failure {
    /// A mistake in the input, or a file that cannot be written.
    fn from(diagnostic: Diagnostic) -> Self {
        let exit = match diagnostic.is(Cause::FileUnwritable) {
            true => Exit::Unwritable,
            false => Exit::Input,
        };
        Self {
            exit,
            diagnostics: vec![diagnostic],
            sources: Sources::default(),
        }
    }
}

impl From<Error> for Failure {
    /// All mistakes of a caller of the library.
    fn from(error: Error) -> Self {
        let first = Self::from(error.first().clone());
        Self {
            diagnostics: error.into_diagnostics(),
            ..first
        }
    }
}

impl Failure {
    /// Creates a failure from mistakes in files; their texts are read again, to show the places.
    pub fn in_files(exit: Exit, diagnostics: Vec<Diagnostic>) -> Self {
        let sources = Sources::of_files(&diagnostics);
        Self {
            exit,
            diagnostics,
            sources,
        }
    }
    /// Creates a failure from mistakes in a model, each at the statement of its element.
    pub fn in_model(dataset: &Dataset, diagnostics: impl Into<Vec<Diagnostic>>) -> Self {
        let located = diagnostics.into().into_iter().map(|d| dataset.locate(d));
        Self::in_files(Exit::Model, located.collect())
    }
    /// Creates a failure from a mistake in an argument of the command line, which is shown with its
    /// place.
    pub fn at_argument(argument: &str, text: &str, mistake: Diagnostic) -> Self {
        Self::at_arguments(argument, text, vec![mistake])
    }
    /// Creates a failure from mistakes in an argument of the command line.
    pub fn at_arguments(argument: &str, text: &str, mistakes: Vec<Diagnostic>) -> Self {
        let placed = |d: Diagnostic| {
            let d = match d.span {
                Some(_) => d,
                None => d.at(text, Span::new(0, text.len())),
            };
            Diagnostic {
                file: Some(argument.to_owned()),
                ..d
            }
        };
        let mut sources = Sources::default();
        sources.add(argument, text);
        Self {
            exit: Exit::Input,
            diagnostics: mistakes.into_iter().map(placed).collect(),
            sources,
        }
    }
    /// Creates a failure for a command that contradicts itself.
    pub fn usage(message: impl Into<String>) -> Self {
        Self {
            exit: Exit::Usage,
            ..Self::from(Diagnostic::error("usage", message))
        }
    }
}

/// The result of a verb.
pub type Outcome = Result<Exit, Failure>;

/// Stack of the thread that does the work, in bytes; what is not used is not taken.
const STACK_BYTES: usize = 256 << 20;

/// Runs the command that the arguments of the process name.
fn main() -> ExitCode {
    let cli = parsed();
    if !matches!(cli.verb, Verb::Sweep(_)) {
        memory::serve_one_thread();
    }
    // the process ends where its work does: nobody waits until the stack is taken down
    let work = || -> Exit { std::process::exit(obey(&cli).code().into()) };
    let exit = std::thread::scope(|scope| {
        let worker = std::thread::Builder::new().stack_size(STACK_BYTES);
        match worker.spawn_scoped(scope, work) {
            Ok(worker) => worker.join().unwrap_or(Exit::Bug),
            // a system that has no room for the stack has room for most models
            Err(_) => obey(&cli),
        }
    });
    ExitCode::from(exit.code())
}

/// Returns the arguments of the process; ends it where they are not understood or ask for help.
fn parsed() -> Cli {
    let mut command = Cli::command();
    let first = std::env::args_os().nth(1).unwrap_or_default();
    if !command
        .get_subcommands()
        .any(|verb| first == *verb.get_name())
    {
        // the list of verbs says what each is for
        command.build();
    }
    let found = Cli::from_arg_matches(&command.get_matches_mut());
    found.unwrap_or_else(|e| e.format(&mut command).exit())
}

/// Runs a command.
fn obey(cli: &Cli) -> Exit {
    let verb = std::panic::AssertUnwindSafe(|| match &cli.verb {
        Verb::Animate(args) => animate::run(args),
        Verb::Check(args) => check::run(args),
        Verb::Configuration(args) => configuration::run(args),
        Verb::Convert(args) => convert::run(args),
        Verb::Draw(args) => draw::run(args),
        Verb::Elements(args) => elements::run(args),
        Verb::Eval(args) => eval::run(args),
        Verb::Explain(args) => explain::run(args),
        Verb::Export(args) => export::run(args),
        Verb::Fmt(args) => fmt::run(args),
        Verb::Functions(args) => functions::run(args),
        Verb::Group(args) => group::run(args),
        #[cfg(feature = "geometry")]
        Verb::Interference(args) => interference::run(args),
        Verb::Linear(args) => linear::run(args),
        Verb::Loads(args) => loads::run(args),
        Verb::Mdi(args) => mdi::run(args),
        Verb::Motion(args) => motion::run(args),
        Verb::Plot(args) => plot::run(args),
        Verb::Repl(args) => repl::run(args),
        Verb::Report(args) => report::run(args),
        Verb::Run(args) => run::run_last(args),
        Verb::Runs(args) => runs::run(args),
        Verb::Statements(args) => statements::run(args),
        Verb::Sweep(args) => sweep::run(args),
        Verb::Verify(args) => verify::run(args),
    });
    match std::panic::catch_unwind(verb) {
        Ok(Ok(exit)) => exit,
        Ok(Err(failure)) => {
            complain(&failure.diagnostics, &failure.sources);
            failure.exit
        }
        Err(_) => {
            complain(
                &[Diagnostic::error("bug", "this is a mistake in cognate")
                    .help("please report what you ran and what stands above")],
                &Sources::default(),
            );
            Exit::Bug
        }
    }
}

/// Prints diagnostics on standard error.
pub fn complain(diagnostics: &[Diagnostic], sources: &Sources) {
    let text = render::render(diagnostics, sources, render::colour_on_stderr());
    // a closed stream is no mistake
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Prints diagnostics about files on standard error, with their places.
pub fn complain_in_files(diagnostics: &[Diagnostic]) {
    complain(diagnostics, &Sources::of_files(diagnostics));
}

/// Prints on standard error a remark about what was done.
pub fn remark(message: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr(), "{message}");
}

/// Prints results on standard output. When the reader is gone (`| head`), the program ends quietly;
/// when they cannot be written otherwise (a full disk), it says so and ends with
/// [`Exit::Unwritable`].
pub fn say(text: &str) {
    let mut out = std::io::stdout().lock();
    let Err(e) = out.write_all(text.as_bytes()).and_then(|()| out.flush()) else {
        return;
    };
    if e.kind() == std::io::ErrorKind::BrokenPipe {
        std::process::exit(Exit::Done.code().into());
    }
    let what = format!("results cannot be written to standard output: {e}");
    complain(
        &[Diagnostic::error(Cause::FileUnwritable, what)],
        &Sources::default(),
    );
    std::process::exit(Exit::Unwritable.code().into());
}
