//! Sessions as tests run them: models of a few lines of text, with MARKER/1 on ground, and their columns.
//!
//! Every session of a test is begun here, because here it gets its limit of steps: a mistake that makes a motion grow
//! without bound then ends a test within seconds instead of keeping the whole suite from ending.
#![allow(dead_code)] // each test binary uses its own part

use cognate::analysis::session::script::obey;
pub use cognate::analysis::session::{Analysis, Options, Session};
use cognate::analysis::sweep::Sweep;
use cognate::analysis::watch::Unwatched;
use cognate::dataset::command::Script;
use cognate::diagnostic::Diagnostic;
use cognate::model::Model;
use cognate::results::Status;

/// The beginning of every model that is given as a few statements.
pub const GROUND: &str = "TEST\nPART/1, GROUND\nMARKER/1, PART=1\n";

/// Steps that one integration of a test may try. The longest of all tests tries 70 000.
pub const MAX_STEPS: usize = 100_000;

/// Begins a session as [`Session::new`] does, with a limit of steps; it records what the test names.
pub fn begin(model: Model, name: &str, options: Options) -> Session {
    let max_steps = options.max_steps.or(Some(MAX_STEPS));
    let options = Options {
        max_steps,
        named_only: true,
        ..options
    };
    Session::new(model, name, options)
}

/// The model of a whole dataset.
pub fn whole(text: &str) -> Model {
    Model::from_text(text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The model of a few statements, with ground.
pub fn model(text: &str) -> Model {
    whole(&format!("{GROUND}{text}END\n"))
}

/// Options with columns and a permitted error.
pub fn options(columns: &[&str], error: f64) -> Options {
    Options {
        columns: columns.iter().map(ToString::to_string).collect(),
        error: Some(error),
        ..Options::default()
    }
}

/// Options with columns, a method and a permitted error.
pub fn options_by(columns: &[&str], method: &str, error: f64) -> Options {
    let method = Some(method.to_string());
    Options {
        method,
        ..options(columns, error)
    }
}

/// A model with columns and a permitted error, at its beginning.
pub fn session(text: &str, columns: &[&str], error: f64) -> Session {
    begin(model(text), "test", options(columns, error))
}

/// The same by a method.
pub fn session_by(text: &str, columns: &[&str], method: &str, error: f64) -> Session {
    begin(model(text), "test", options_by(columns, method, error))
}

/// Tries to go on to a time in so many steps of output, and says how that ended.
pub fn try_to(s: &mut Session, analysis: Analysis, end: f64, steps: usize) -> Status {
    s.simulate(analysis, end, steps, &mut Unwatched)
        .unwrap_or_else(|e| panic!("{}: {e:?}", s.run.name))
}

/// Goes on to a time in so many steps of output, and must arrive.
pub fn go(s: &mut Session, analysis: Analysis, end: f64, steps: usize) {
    let status = try_to(s, analysis, end, steps);
    arrived(s, status);
}

/// Finds an equilibrium where it stands.
pub fn rest(s: &mut Session) {
    let now = s.time();
    go(s, Analysis::Static, now, 1);
}

/// Obeys all commands of a script, each of which must be done.
pub fn obeys(s: &mut Session, script: &Script) {
    let status = obey(s, &script.steps, |_, _| (), &mut Unwatched)
        .unwrap_or_else(|e| panic!("{}: {}", s.run.name, e.first()));
    arrived(s, status);
}

fn arrived(s: &Session, status: Status) {
    // shown with a test that fails
    println!("{}: {:?}", s.run.name, s.run.record.counts);
    let (name, reason) = (&s.run.name, &s.run.record.stop_reason);
    assert_eq!(status, Status::Completed, "{name}: {reason}");
}

/// A simulation from the beginning of a model to a time, in so many steps of output.
pub fn run(
    text: &str,
    columns: &[&str],
    analysis: Analysis,
    (end, steps): (f64, usize),
    error: f64,
) -> Session {
    let mut s = session(text, columns, error);
    go(&mut s, analysis, end, steps);
    s
}

/// All that is said about a session that must be refused, asked for ten units of time.
pub fn mistakes(s: &mut Session, analysis: Analysis) -> Vec<Diagnostic> {
    let end = s.time() + 10.0;
    let refused = s.simulate(analysis, end, 10, &mut Unwatched);
    refused.expect_err("a mistake").into_diagnostics()
}

/// All that is said about a script of which a command cannot be obeyed.
pub fn mistakes_of(s: &mut Session, script: &Script) -> Vec<Diagnostic> {
    let refused = obey(s, &script.steps, |_, _| (), &mut Unwatched);
    refused.expect_err("a mistake").into_diagnostics()
}

/// The first thing that is said about a model that cannot be run.
pub fn refused(text: &str, analysis: Analysis) -> Diagnostic {
    mistakes(&mut session(text, &[], 1e-6), analysis).remove(0)
}

/// A column.
pub fn values<'s>(s: &'s Session, column: &str) -> &'s [f64] {
    s.run
        .column(column)
        .unwrap_or_else(|| panic!("no column {column}"))
}

/// The value of a column at the beginning.
pub fn first(s: &Session, column: &str) -> f64 {
    values(s, column)[0]
}

/// The value of a column at the end.
pub fn last(s: &Session, column: &str) -> f64 {
    *values(s, column).last().expect("a row")
}

/// The largest difference of a column from a function of time.
pub fn off(s: &Session, column: &str, exact: impl Fn(f64) -> f64) -> f64 {
    let rows = values(s, "time").iter().zip(values(s, column));
    rows.map(|(&t, x)| (x - exact(t)).abs()).fold(0.0, f64::max)
}

/// A sweep over the runs of a whole dataset up to `end`.
pub fn sweep(text: &str, end: f64, steps: usize) -> Sweep {
    let mut sweep = Sweep::over(whole(text), Analysis::Transient, end, steps);
    sweep.options.max_steps = Some(MAX_STEPS);
    sweep
}
