//! Models of a few lines of text, with MARKER/1 on ground: run, and their columns.
#![allow(dead_code)] // each test binary uses its own part

pub use cognate::analysis::session::{Analysis, Options, Session};
use cognate::analysis::watch::Unwatched;
use cognate::model::Model;
use cognate::results::Status;

/// What stands before the text of every model.
pub const GROUND: &str = "TEST\nPART/1, GROUND\nMARKER/1, PART=1\n";

/// The model of a text, with ground.
pub fn model(text: &str) -> Model {
    Model::from_text(&format!("{GROUND}{text}END\n")).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Options with columns and a permitted error.
pub fn options(columns: &[&str], error: f64) -> Options {
    Options {
        columns: columns.iter().map(ToString::to_string).collect(),
        error: Some(error),
        ..Options::default()
    }
}

/// A model with columns and a permitted error, at its beginning.
pub fn session(text: &str, columns: &[&str], error: f64) -> Session {
    Session::new(model(text), "test", options(columns, error))
}

/// Goes on to a time in so many steps of output, and must arrive.
pub fn go(s: &mut Session, analysis: Analysis, end: f64, steps: usize) {
    let status = s
        .simulate(analysis, end, steps, &mut Unwatched)
        .unwrap_or_else(|e| panic!("{e:?}"));
    assert_eq!(status, Status::Completed, "{}", s.run.record.stop_reason);
}

/// The first thing that is said about a model that cannot be run.
pub fn refused(text: &str, analysis: Analysis) -> cognate::diagnostic::Diagnostic {
    let mut s = session(text, &[], 1e-6);
    let errors = s.simulate(analysis, 1.0, 1, &mut Unwatched);
    errors.expect_err("a mistake").remove(0)
}

/// A column.
pub fn values<'s>(s: &'s Session, column: &str) -> &'s [f64] {
    s.run.column(column).expect("the column")
}

/// What it begins with.
pub fn first(s: &Session, column: &str) -> f64 {
    values(s, column)[0]
}

/// What it ends with.
pub fn last(s: &Session, column: &str) -> f64 {
    *values(s, column).last().expect("a row")
}
