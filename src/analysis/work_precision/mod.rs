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
#[allow(clippy::disallowed_methods, reason = "pictures have few digits")]
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
use crate::analysis::watch::{Unwatched, Watch};
use crate::dataset::command::Step;
use crate::model::Model;
use crate::results::{Counts, Run, Status};
use std::path::PathBuf;

/// Part of the trust of a reference below which an error is not told from it.
const TOLD_FROM_REFERENCE: f64 = 2.0;

/// Times of solving that differ by less than this factor are not told apart: runs of a millisecond
/// differ by as much when they are repeated.
const AS_FAST: f64 = 1.25;

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
    /// errors for which a run will be recommended
    pub wanted: Vec<f64>,
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
    /// whether a method integrates: otherwise the only run is right to rounding
    pub is_integrated: bool,
}

/// Hooks called while a study goes on.
pub trait Follow: Watch {
    /// Takes note of the method and the request of a run that begins, and of the processor time of
    /// the runs before, in s.
    fn begins(&mut self, _run: (&str, f64), _spent: f64) {}
}

impl Follow for Unwatched {}

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
    /// a request would probably have taken longer than the budget has left
    Budget {
        /// the request: the next one, or the next of those that are wanted
        to: f64,
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
            Reason::Budget { to, expected } => {
                write!(
                    f,
                    "{to:.0e} would take about {}, more than the budget has left",
                    write::duration(*expected)
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
    /// reference can tell.
    ///
    /// Of runs that are as fast within `AS_FAST` it is the one of the largest request, and among
    /// those of the same request the one of the least error: a clock that is off does not recommend
    /// more than is needed.
    pub fn recommended(&self, wanted: f64) -> Option<&Row> {
        let reference = self.reference.as_ref()?;
        if wanted < TOLD_FROM_REFERENCE * reference.trust() {
            return None;
        }
        let largest = |row: &Row| row.error().map_or(f64::INFINITY, |e| e.largest);
        let rows = || self.rows.iter().filter(|row| largest(row) <= wanted);
        let least = rows().fold(f64::INFINITY, |m, row| m.min(row.cost.solve));
        let fast = rows().filter(|row| row.cost.solve <= AS_FAST * least);
        fast.min_by(|a, b| {
            let by_request = b.request.total_cmp(&a.request);
            by_request.then(largest(a).total_cmp(&largest(b)))
        })
    }

    /// Returns whether an error is told from the error of the reference.
    fn is_told(&self, error: f64) -> bool {
        let trust = self.reference.as_ref().map_or(0.0, Reference::trust);
        error > TOLD_FROM_REFERENCE * trust
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A study whose runs are (method, request, error, time of solving in s).
    fn study(runs: &[(&str, f64, f64, f64)]) -> Study {
        let row = |&(method, request, largest, solve): &(&str, f64, f64, f64)| Row {
            method: method.into(),
            request,
            outcome: Outcome::Done(Error {
                largest,
                ..Error::default()
            }),
            cost: Cost {
                solve,
                ..Cost::default()
            },
        };
        Study {
            name: String::new(),
            title: String::new(),
            channels: Vec::new(),
            reference: Some(Reference::Trusted),
            rows: runs.iter().map(row).collect(),
            left_out: Vec::new(),
            seconds: 0.0,
            interrupted: false,
            is_integrated: true,
        }
    }

    fn recommended(runs: &[(&str, f64, f64, f64)], wanted: f64) -> Option<(String, f64)> {
        let study = study(runs);
        let row = study.recommended(wanted)?;
        Some((row.method.clone(), row.request))
    }

    #[test]
    fn noise_of_the_clock_recommends_no_finer_request_and_no_other_method() {
        // every run takes the same, off by up to an eighth
        let noise = [0.0, 0.12, 0.03, 0.11, 0.06, 0.01, 0.09, 0.04];
        for shift in 0..noise.len() {
            let mut runs = Vec::new();
            for (m, method) in ["AUTO", "DOP853"].iter().enumerate() {
                for k in 2..12 {
                    let request = 10f64.powi(-k);
                    let late = noise[(shift + 3 * m + k as usize) % noise.len()];
                    runs.push((*method, request, 0.5 * request, 9e-5 * (1.0 + late)));
                }
            }
            for k in [2, 5, 9] {
                let wanted = 10f64.powi(-k);
                let found = recommended(&runs, wanted);
                assert_eq!(found, Some(("AUTO".into(), wanted)), "{shift}");
            }
        }
    }

    #[test]
    fn a_run_that_is_faster_by_more_than_noise_is_recommended_however_exact_it_is() {
        let runs = [
            ("AUTO", 1e-3, 5e-4, 4.0),
            ("AUTO", 1e-4, 5e-5, 3.0),
            ("RADAU5", 1e-6, 1e-7, 1.0),
            ("RADAU5", 1e-3, 2e-2, 0.5),
        ];
        assert_eq!(recommended(&runs, 1e-3), Some(("RADAU5".into(), 1e-6)));
        assert_eq!(recommended(&runs, 0.1), Some(("RADAU5".into(), 1e-3)));
        assert_eq!(recommended(&runs, 1e-9), None);
    }
}
