//! Statements that do not count, which their author may not see: those after END, settings that a
//! later statement overrides, the first of two forms of one orientation.

use super::row::{Given, Meaning, Record};
use super::statement;
use super::syntax::Source;
use crate::diagnostic::{Diagnostic, Severity, Span};
use std::collections::{BTreeMap, BTreeSet};

/// Doubts statements behind the END of a dataset: they are not read.
pub(super) fn after_end(source: &Source, after: Span) -> Option<Diagnostic> {
    let is_known = |word: &str| statement::find(word) != Meaning::Unknown;
    let heads = heads(source, after, is_known);
    told(source, &heads, ["statement", "END"])
}

/// Says that statements or commands stand where nothing is read, at the first of them.
pub(super) fn told(source: &Source, heads: &[Span], [what, end]: [&str; 2]) -> Option<Diagnostic> {
    let first = *heads.first()?;
    let more = match heads.len() - 1 {
        0 => format!("stands after {end} and is not read"),
        1 => format!("and 1 more {what} stand after {end} and are not read"),
        n => format!("and {n} more {what}s stand after {end} and are not read"),
    };
    let message = format!("{} {more}", source.slice(first).trim());
    let d = Diagnostic::warning("beyond_end", message);
    Some(source.locate(
        d.help(format!("{end} belongs behind the last {what}")),
        first,
    ))
}

/// Returns the heads of lines that begin with a known word and a slash: `SFORCE/1`.
pub(super) fn heads(source: &Source, span: Span, is_known: impl Fn(&str) -> bool) -> Vec<Span> {
    let mut found = Vec::new();
    let mut at = span.start;
    for line in source.slice(span).split_inclusive(['\n', '\r']) {
        let start = at + (line.len() - line.trim_start().len());
        at += line.len();
        let word = line.trim_start().split('/').next().unwrap_or_default();
        let rest = line.trim_start().get(word.len()..).unwrap_or_default();
        let is_word = |w: &str| w.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !rest.starts_with('/') || !is_word(word.trim()) || !is_known(word.trim()) {
            continue;
        }
        let number = rest[1..].bytes().take_while(u8::is_ascii_digit).count();
        found.push(Span::new(start, start + word.len() + 1 + number));
    }
    found
}

/// Doubts settings that are given again by a later statement, with another value: the last counts.
pub(super) fn given_again(source: &Source, records: &[Option<Record>]) -> Vec<Diagnostic> {
    let all = records.iter().flatten().filter(|r| !r.row.numbered());
    let mut settings: Vec<&Record> = all.collect();
    let mut times: BTreeMap<&str, usize> = BTreeMap::new();
    for record in &settings {
        *times.entry(record.row.keyword()).or_default() += 1;
    }
    settings.retain(|record| times.get(record.row.keyword()).is_some_and(|n| *n > 1));
    let mut first: BTreeMap<(&str, String), (&Record, &Given)> = BTreeMap::new();
    let mut found = Vec::new();
    for record in settings {
        for given in &record.given {
            let Some(argument) = record.row.argument(given.argument) else {
                continue;
            };
            let what = argument.group.map_or(argument.keyword(), str::to_owned);
            let key = (record.row.keyword(), what);
            let before = first.insert(key, (record, given));
            let Some((of, other)) = before.filter(|b| !std::ptr::eq(b.0, record)) else {
                continue;
            };
            let is_same = other.argument == given.argument && other.value == given.value;
            if is_same || argument.repeated {
                continue;
            }
            let file = source.file_at(of.head.start);
            let other = file.filter(|_| file != source.file_at(given.span.start));
            let message = format!(
                "{} stands here, and the statement in line {}{} no longer counts for it",
                source.slice(given.span),
                of.place.line,
                other.map_or_else(String::new, |file| format!(" of {file}"))
            );
            let d = Diagnostic::warning("given_twice", message).element(record.element());
            found.push(source.locate(d, given.span));
        }
    }
    found
}

/// Says once which arguments a file of RecurDyn has that no statement here reads, at the first.
pub(super) fn foreign(source: &Source, records: &[Option<Record>]) -> Option<Diagnostic> {
    if !source.is_of_recurdyn() {
        return None;
    }
    let closed = records.iter().flatten().filter(|r| !r.row.open());
    let mut at = closed.filter(|r| !r.kept.is_empty()).peekable();
    let first = at.peek()?.head;
    let words: BTreeSet<&str> = at
        .flat_map(|r| &r.kept)
        .map(|(word, _)| &word[..])
        .collect();
    let words: Vec<&str> = words.into_iter().collect();
    let what = format!(
        "arguments of RecurDyn are accepted here, and not read: {}",
        words.join(", ")
    );
    let note = Diagnostic {
        severity: Severity::Note,
        ..Diagnostic::warning("ignored", what)
    };
    Some(source.locate(note, first))
}

/// The two forms of an orientation: angles, and points on axes.
const ANGLES: &str = "REULER";
const POINTS: [&str; 4] = ["ZP", "XP", "ZG", "XG"];

/// Doubts a statement with both forms of an orientation: the one that stands last counts.
pub(super) fn two_orientations(source: &Source, record: &Record) -> Option<Diagnostic> {
    let keyword = |g: &Given| record.row.argument(g.argument).map_or("", |a| a.name);
    let angles = record.given.iter().rfind(|g| keyword(g) == ANGLES)?;
    let points = (record.given.iter()).rfind(|g| POINTS.contains(&keyword(g)))?;
    let (counts, other) = match angles.span.start > points.span.start {
        true => (angles, points),
        false => (points, angles),
    };
    let [counts_name, other_name] = [counts, other].map(keyword);
    let message = format!(
        "{other_name} and {counts_name} both say how it is turned: {counts_name}, the last, is taken"
    );
    let d = Diagnostic::warning("excluded_argument", message).element(record.element());
    Some(source.locate(d.help("keep one of them"), counts.span))
}
