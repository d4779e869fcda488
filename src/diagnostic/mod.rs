//! What is said to the user, and about which place: spans, diagnostics, near names.
//!
//! Every mistake a user can make becomes a [`Diagnostic`]: a stable code, a place, what is wrong, and what to do.
//! All mistakes of a text are collected; none ends the reading of the rest where that can be helped.

pub mod codes;

use std::fmt;

/// A range of bytes in a source text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Span {
    /// first byte
    pub start: usize,
    /// one past the last byte
    pub end: usize,
}

impl Span {
    /// From `start` up to, not including, `end`.
    pub fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }
}

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// worth knowing
    Note,
    /// works, but probably not as meant
    Warning,
    /// does not work
    Error,
}

/// One thing to say to the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// stable short name, for example `unknown_name`; `cognate explain CODE` tells more
    pub code: &'static str,
    /// how bad it is
    pub severity: Severity,
    /// what is wrong, one sentence without a full stop
    pub message: String,
    /// where, in bytes of the text that was given
    pub span: Option<Span>,
    /// file that the text stands in
    pub file: Option<String>,
    /// 1-based line in that text; 0 when unknown
    pub line: usize,
    /// 1-based column, counted in characters (for an expression: of the whole expression text); 0 when unknown
    pub column: usize,
    /// the element concerned, for example `SFORCE/3`
    pub element: Option<String>,
    /// reasons and advice, one sentence each
    pub help: Vec<String>,
}

impl Diagnostic {
    /// An error without a place yet.
    pub fn error(code: &'static str, message: impl Into<String>) -> Self {
        Self {
            code,
            severity: Severity::Error,
            message: message.into(),
            span: None,
            file: None,
            line: 0,
            column: 0,
            element: None,
            help: Vec::new(),
        }
    }
    /// A warning without a place yet.
    pub fn warning(code: &'static str, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(code, message)
        }
    }
    /// The same, about this place of `text`.
    pub fn at(mut self, text: &str, span: Span) -> Self {
        let before = text.get(..span.start.min(text.len())).unwrap_or(text);
        self.line = before.matches('\n').count() + 1;
        self.column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
        self.span = Some(span);
        self
    }
    /// The same, with a sentence of advice.
    pub fn help(mut self, advice: impl Into<String>) -> Self {
        self.help.push(advice.into());
        self
    }
    /// The same, about this element.
    pub fn element(mut self, element: impl Into<String>) -> Self {
        self.element = Some(element.into());
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{file}:")?;
        }
        if self.line > 0 {
            write!(f, "{}:{}: ", self.line, self.column)?;
        }
        if let Some(element) = &self.element {
            write!(f, "{element}: ")?;
        }
        let severity = match self.severity {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        };
        write!(f, "{severity}[{}]: {}", self.code, self.message)?;
        for advice in &self.help {
            write!(f, "\n  help: {advice}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostic {}

/// The names of `known` that are close to `name`, nearest first, at most three.
///
/// Close means an edit distance (with transpositions) of at most a third of the length, or a common beginning.
pub fn near_names<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let name = name.to_ascii_uppercase();
    let limit = (name.len() / 3).max(1);
    let mut found: Vec<(usize, &str)> = known
        .into_iter()
        .filter_map(|k| {
            let upper = k.to_ascii_uppercase();
            let d = edit_distance(&name, &upper);
            let begins = name.len() >= 3
                && (upper.starts_with(&name) || name.starts_with(&upper) && upper.len() >= 3);
            (d <= limit || begins).then_some((d, k))
        })
        .collect();
    found.sort();
    found.dedup_by_key(|f| f.1);
    found.truncate(3);
    found.into_iter().map(|f| f.1).collect()
}

/// Insertions, deletions, replacements and swaps of neighbours between two words (optimal string alignment).
fn edit_distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) =
        (a.chars().take(64).collect(), b.chars().take(64).collect());
    let mut rows = vec![(0..=b.len()).collect::<Vec<usize>>()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replace = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut d = replace.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                d = d.min(rows[i - 2][j - 2] + 1);
            }
            row.push(d);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}
