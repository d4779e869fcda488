//! Messages to the user and their places: spans, diagnostics, near names.
//!
//! Every mistake a user can make becomes a [`Diagnostic`]: a stable code, a place, a sentence, and
//! advice. All mistakes of a text are collected; reading continues after a mistake wherever it can.
//! An [`Error`] holds them all.

mod cause;
pub mod codes;
mod count;
mod error;
mod subject;

pub use cause::Cause;
pub use count::counted;
pub use error::Error;
pub use subject::Subject;

use std::cmp::Reverse;
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
    /// Creates the span from `start` up to, not including, `end`.
    pub fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }
}

/// The severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// information
    Note,
    /// legal, but probably not as meant
    Warning,
    /// a mistake
    Error,
}

/// A message to the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// stable short name, for example `unknown_name`, which `cognate explain CODE` explains
    pub code: &'static str,
    /// severity
    pub severity: Severity,
    /// the mistake, in one sentence without a full stop
    pub message: String,
    /// its place, in bytes of the text that was given
    pub span: Option<Span>,
    /// file of the text
    pub file: Option<String>,
    /// 1-based line in that text; 0 when unknown
    pub line: usize,
    /// 1-based column, counted in characters (for an expression: of the whole expression text); 0
    /// when unknown
    pub column: usize,
    /// the element concerned, for example `SFORCE/3`
    pub element: Option<String>,
    /// the row, function or state of that element, for example `Zi.Xj`
    pub part: Option<String>,
    /// keyword of the argument concerned, for example `IP`; where the element was read from a file,
    /// the message stands at that argument
    pub argument: Option<&'static str>,
    /// the name that the file gives the element
    pub name: Option<String>,
    /// further places of the same text, and what stands there
    pub marks: Vec<(Span, String)>,
    /// reasons and advice, one sentence each
    pub help: Vec<String>,
}

impl Diagnostic {
    /// Creates an error without a place; `code` is a code, or a [`Cause`] on which the program
    /// acts.
    pub fn error(code: impl Into<&'static str>, message: impl Into<String>) -> Self {
        Self {
            code: code.into(),
            severity: Severity::Error,
            message: message.into(),
            span: None,
            file: None,
            line: 0,
            column: 0,
            element: None,
            part: None,
            argument: None,
            name: None,
            marks: Vec::new(),
            help: Vec::new(),
        }
    }
    /// Creates a warning without a place.
    pub fn warning(code: impl Into<&'static str>, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Warning,
            ..Self::error(code, message)
        }
    }
    /// Sets the place, in `text`.
    pub fn at(mut self, text: &str, span: Span) -> Self {
        let before = text.get(..span.start.min(text.len())).unwrap_or(text);
        self.line = before.matches('\n').count() + 1;
        self.column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
        self.span = Some(span);
        self
    }
    /// Adds a further place of the text, with what stands there.
    pub fn mark(mut self, span: Span, what: impl Into<String>) -> Self {
        self.marks.push((span, what.into()));
        self
    }
    /// Adds a sentence of advice.
    pub fn help(mut self, advice: impl Into<String>) -> Self {
        self.help.push(advice.into());
        self
    }
    /// Returns the element concerned, and the part of it, as the file names it: "JOINT/47 'hinge'
    /// Zi.Xj".
    pub fn named(&self) -> Option<String> {
        Some(self.subject()?.named(self.name.as_deref()))
    }
    /// Returns the element concerned and the part of it.
    pub fn subject(&self) -> Option<Subject> {
        let (element, part) = (self.element.clone()?, self.part.clone());
        Some(Subject { element, part })
    }
    /// Sets the element concerned, or the part of one.
    pub fn element(mut self, subject: impl Into<Subject>) -> Self {
        let Subject { element, part } = subject.into();
        (self.element, self.part) = (Some(element), part);
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
        if let Some(element) = self.named() {
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

/// Returns the names of `known` that are close to `name`, nearest first, of those that are as near
/// the one that begins alike for longer, at most three.
///
/// Close means an edit distance (with transpositions) of at most a third of the length, a common
/// beginning, or a fifth of the length from an abbreviation (`ROTATON` of `ROTATIONAL`).
pub fn near_names<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    near_words(name, &mut known.into_iter())
}

fn near_words<'a>(name: &str, known: &mut dyn Iterator<Item = &'a str>) -> Vec<&'a str> {
    let name = beginning(name, MOST_COMPARED).to_ascii_uppercase();
    let n = name.chars().count();
    let (limit, limit_abbreviated) = ((name.len() / 3).max(1), name.len() / 5);
    let mut found: Vec<(usize, Reverse<usize>, &str)> = known
        .filter_map(|k| {
            let upper = beginning(k, MOST_COMPARED).to_ascii_uppercase();
            let distance_to = |m| strsim::osa_distance(&name, beginning(&upper, m));
            let d = distance_to(MOST_COMPARED);
            let begins = name.len() >= 3
                && (upper.starts_with(&name) || name.starts_with(&upper) && upper.len() >= 3);
            // others differ in length by more
            let mut abbreviations = n - limit_abbreviated.min(n)..=n + limit_abbreviated;
            let abbreviates = |m| distance_to(m) <= limit_abbreviated;
            let is_near = d <= limit || begins;
            let both = name.bytes().zip(upper.bytes());
            let alike = Reverse(both.take_while(|(a, b)| a == b).count());
            (is_near || limit_abbreviated > 0 && abbreviations.any(abbreviates))
                .then_some((d, alike, k))
        })
        .collect();
    found.sort();
    found.dedup_by_key(|f| f.2);
    found.truncate(3);
    found.into_iter().map(|f| f.2).collect()
}

/// Letters of a name that are compared: the work grows with the cube.
const MOST_COMPARED: usize = 64;

/// Returns the first `n` letters of a word.
fn beginning(word: &str, n: usize) -> &str {
    let end = word.char_indices().nth(n).map(|(at, _)| at);
    end.and_then(|end| word.get(..end)).unwrap_or(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mistyped_word_is_near_the_whole_one_and_its_abbreviations() {
        let known = ["TRANSLATIONAL", "ROTATIONAL", "FUNCTION", "SIN"];
        for (typed, meant) in [
            ("ROTATON", "ROTATIONAL"),
            ("ROATION", "ROTATIONAL"),
            ("TRANSLATON", "TRANSLATIONAL"),
            ("FUNCITON", "FUNCTION"),
            ("SNI", "SIN"),
        ] {
            assert_eq!(near_names(typed, known), [meant], "{typed}");
        }
        assert!(near_names("RADIUS", known).is_empty());
    }
}
