//! Work against precision: a model run at many requests by all methods that fit, each run beside
//! the best one.
//!
//! ```text
//! survey       which runs, in which order, and which are left out
//! attempt      one run: its results and its cost        profile   where solving spends its time
//! distance     errors between tables of results; the reference and its trust
//! write        terminal, CSV, JSON      page, chart   one self-contained HTML page      sheet   one picture
//! ```
//!
//! The *error* of a run is the difference of its table from the reference, each channel over its
//! own swing there: the root of the mean square over all channels and outputs, and the largest one.
//! The reference is a table that the caller trusts, or the better one of the two runs by different
//! methods that agree best; then their difference says how far it can be trusted.

mod attempt;
mod chart;
mod distance;
mod page;
mod profile;
mod sheet;
mod survey;
mod write;

pub use page::page;
pub use profile::Profile;
pub use sheet::sheet;
pub use survey::survey;

use crate::analysis::session;
use crate::dataset::command::Step;
use crate::model::Model;
use crate::results::{Counts, Run, Status};
use std::path::PathBuf;

/// Part of the trust of a reference below which an error is not told from it.
const TOLD_FROM_REFERENCE: f64 = 2.0;

/// Times of solving that differ by less than this factor are not told apart.
const AS_FAST: f64 = 1.1;

/// The question: a model with its commands, at which requests, by which methods.
pub struct Question<'a> {
    /// name of the model
    pub name: String,
    /// the model
    pub model: &'a Model,
    /// its commands
    pub steps: &'a [Step],
    /// options of every run; error, method, repeats and limit are set for each
    pub options: session::Options,
    /// folders in which commands and shells look for files
    pub folders: Vec<PathBuf>,
    /// requested errors, the largest first
    pub requests: Vec<f64>,
    /// names of methods; empty: all that fit
    pub methods: Vec<String>,
    /// processor time for all runs together, in s
    pub budget: f64,
    /// a table that is trusted: its columns bear the names of those of the runs
    pub trusted: Option<Run>,
}

/// The answer: all runs, with their errors and costs.
#[derive(Clone, Debug)]
pub struct Study {
    /// name of the model
    pub name: String,
    /// title line of its dataset
    pub title: String,
    /// names of the channels that are compared
    pub channels: Vec<String>,
    /// what errors are measured against; `None`: no run came to its end
    pub reference: Option<Reference>,
    /// all runs, by method and falling request
    pub rows: Vec<Row>,
    /// runs that were not started
    pub left_out: Vec<LeftOut>,
    /// processor time of all runs together, in s
    pub seconds: f64,
    /// the caller stopped it
    pub interrupted: bool,
}

/// The table that errors are measured against.
#[derive(Clone, Debug, PartialEq)]
pub enum Reference {
    /// a table of the caller's
    Trusted,
    /// the better of two runs
    Run {
        /// its method and request
        best: (String, f64),
        /// the run by another method that agrees with it best, and their largest difference;
        /// `None`: there is no other method
        other: Option<((String, f64), f64)>,
    },
}

impl Reference {
    /// Returns how far it can be trusted, as an error; 0 where nothing speaks against it.
    pub fn trust(&self) -> f64 {
        match self {
            Reference::Trusted | Reference::Run { other: None, .. } => 0.0,
            Reference::Run {
                other: Some((_, difference)),
                ..
            } => *difference,
        }
    }
}

/// One run.
#[derive(Clone, Debug)]
pub struct Row {
    /// name of the method that was asked for
    pub method: String,
    /// requested error
    pub request: f64,
    /// how it ended
    pub outcome: Outcome,
    /// its cost
    pub cost: Cost,
}

/// The end of a run.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// it came to its end
    Done(Error),
    /// it ended before, with a reason
    Ended(Status, String),
    /// it cannot be run in this way
    Refused(String),
}

/// The error of a run against the reference, each channel over its swing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Error {
    /// root of the mean square over channels and outputs
    pub rms: f64,
    /// largest over channels and outputs
    pub largest: f64,
    /// the channel that has the largest
    pub worst: usize,
}

/// The cost of a run, in processor time.
#[derive(Clone, Debug, Default)]
pub struct Cost {
    /// setting up: compiling, assembling, recording, in s
    pub set_up: f64,
    /// solving, in s
    pub solve: f64,
    /// making the text of the table of results, in s
    pub write: f64,
    /// what the method did
    pub counts: Counts,
    /// where solving spent its time, as far as that is known
    pub profile: Option<Profile>,
}

/// Runs that were not started.
#[derive(Clone, Debug, PartialEq)]
pub struct LeftOut {
    /// name of the method
    pub method: String,
    /// requests
    pub requests: Vec<f64>,
    /// why
    pub why: Reason,
}

/// The reason why a run was not started.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// it would probably have taken longer than the budget has left
    Budget {
        /// expected processor time, in s
        expected: f64,
    },
    /// the run before it, at a larger request, did not end in time
    Slower,
    /// the caller stopped the study
    Interrupted,
}

impl std::fmt::Display for Reason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Reason::Budget { expected } => {
                write!(
                    f,
                    "about {expected:.1} s expected, more than the budget has left"
                )
            }
            Reason::Slower => f.write_str("the run at a larger request did not end in time"),
            Reason::Interrupted => f.write_str("interrupted"),
        }
    }
}

impl Row {
    /// Returns the error of a run that came to its end.
    pub fn error(&self) -> Option<Error> {
        match &self.outcome {
            Outcome::Done(error) => Some(*error),
            Outcome::Ended(..) | Outcome::Refused(_) => None,
        }
    }
}

impl Study {
    /// Returns the run whose largest error is at most `wanted` and that solves fastest, where the
    /// reference can tell; of those that are as fast within `AS_FAST`, the best.
    pub fn recommended(&self, wanted: f64) -> Option<&Row> {
        let reference = self.reference.as_ref()?;
        if wanted < TOLD_FROM_REFERENCE * reference.trust() {
            return None;
        }
        let good = |row: &&Row| row.error().is_some_and(|e| e.largest <= wanted);
        let rows = || self.rows.iter().filter(good);
        let least = rows().fold(f64::INFINITY, |m, row| m.min(row.cost.solve));
        let fast = rows().filter(|row| row.cost.solve <= AS_FAST * least);
        let largest = |row: &Row| row.error().map_or(f64::INFINITY, |e| e.largest);
        fast.min_by(|a, b| largest(a).total_cmp(&largest(b)))
    }

    /// Returns whether an error is told from the error of the reference.
    fn is_told(&self, error: f64) -> bool {
        let trust = self.reference.as_ref().map_or(0.0, Reference::trust);
        error > TOLD_FROM_REFERENCE * trust
    }
}
