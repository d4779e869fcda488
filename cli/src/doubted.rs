//! Doubts about a dataset, as a run tells them before it begins: a line each, with its place.

use super::remark;
use super::run::Job;
use cognate::diagnostic::{Diagnostic, Severity, counted};

/// Most warnings about a dataset that a run writes out, a line each.
const MOST_DOUBTS: usize = 5;

/// Remarks on the warnings about a dataset and on the notes about it and its commands; returns what
/// the reader doubts, and then what is doubted about the mechanism as a whole.
pub fn remark_on(job: &Job, quiet: bool) -> [Vec<Diagnostic>; 2] {
    let reports = || job.reading.diagnostics.iter().chain(&job.remarks);
    if !quiet {
        remark_on_notes(reports());
    }
    let is_warning = |d: &&Diagnostic| d.severity == Severity::Warning;
    let read: Vec<Diagnostic> = (reports().filter(is_warning).cloned()).collect();
    let about_mechanism = match job.changes_the_model() {
        // then it is not the mechanism that is solved
        true => Vec::new(),
        false => job.reading.model.doubts(),
    };
    let located = about_mechanism.into_iter();
    let located: Vec<Diagnostic> = located.map(|d| job.reading.dataset.locate(d)).collect();
    if quiet {
        return [read, located];
    }
    let all = || read.iter().chain(&located);
    for doubt in all().take(MOST_DOUBTS) {
        remark(in_a_line(doubt));
    }
    let rest = all().count().saturating_sub(MOST_DOUBTS);
    if rest > 0 {
        remark(format!(
            "{} about the dataset: cognate check shows all",
            counted(rest, "more warning")
        ));
    }
    [read, located]
}

/// Writes a warning in one line, with its place at the end.
fn in_a_line(doubt: &Diagnostic) -> String {
    let element = doubt
        .named()
        .map_or(String::new(), |name| format!("{name}: "));
    let file = doubt.file.as_deref().unwrap_or("line ");
    let colon = if doubt.file.is_some() { ":" } else { "" };
    let place = match doubt.line {
        0 => String::new(),
        line => format!(" ({file}{colon}{line})"),
    };
    format!("warning: {element}{}{place}", doubt.message)
}

/// Remarks on notes about a dataset or its commands.
fn remark_on_notes<'a>(found: impl Iterator<Item = &'a Diagnostic>) {
    for note in found.filter(|d| d.severity == Severity::Note) {
        let file = (note.file.as_deref()).map_or(String::new(), |file| format!("{file}: "));
        let element = note
            .named()
            .map_or(String::new(), |name| format!("{name}: "));
        remark(format!("{file}{element}{}", note.message));
    }
}
