//! Doubts about commands as a whole: what follows STOP, no simulation at all, settings whose
//! numbers cannot be meant.

use super::{Command, Record, Script, Step, find};
use crate::dataset::overlooked;
use crate::dataset::row::Meaning;
use crate::dataset::syntax::Source;
use crate::diagnostic::{Diagnostic, Span};
use crate::model::{Model, check};

/// Doubts commands behind the line that says STOP: they are not read.
pub(super) fn after_stop(source: &Source, after: Span) -> Option<Diagnostic> {
    let is_known = |word: &str| find(word) != Meaning::Unknown;
    let heads = overlooked::heads(source, after, is_known);
    overlooked::told(source, &heads, ["command", "STOP"])
}

/// Doubts the numbers of a command that changes settings.
pub(super) fn of_settings(command: &Command) -> Vec<Diagnostic> {
    match command {
        Command::Change(record) if record.id.is_none() => doubts(record),
        _ => Vec::new(),
    }
}

fn doubts(record: &Record) -> Vec<Diagnostic> {
    let mut alone = Model::default();
    record.row.enter(&mut alone, record, true);
    check::doubted_settings(&alone)
}

impl Script {
    /// Adds what is doubted of the commands together, those of called files among them.
    pub(super) fn doubt_the_whole(&mut self) {
        let is_stop = |step: &Step| matches!(step.command, Command::Stop);
        let stop = self.steps.iter().position(is_stop);
        let behind = stop.map_or(&[][..], |k| &self.steps[k + 1..]);
        let lost: Vec<&Step> = behind.iter().filter(|s| !is_stop(s)).collect();
        if let Some(first) = lost.first() {
            let message = format!(
                "STOP ends the run, also in a file that is called: {} of the commands behind it \
                 are not obeyed, {} and so on",
                lost.len(),
                first.text
            );
            self.diagnostics
                .push(Diagnostic::warning("beyond_end", message));
        }
        let obeyed = &self.steps[..stop.unwrap_or(self.steps.len())];
        let acts = |step: &Step| {
            matches!(
                step.command,
                Command::Simulate(_) | Command::Linear(_) | Command::Save(_)
            )
        };
        if !obeyed.iter().any(acts) {
            let message = "there is no SIMULATE among the commands: nothing is solved";
            self.diagnostics
                .push(Diagnostic::warning("no_simulation", message));
        }
    }
}
