//! Statements and arguments that are accepted and change nothing, told once for a file.

use super::row::{Given, Record, canonical};
use super::syntax::Source;
use crate::diagnostic::{Diagnostic, Severity};

/// Statements that change nothing, and arguments that do not, in the order in which they are met.
#[derive(Clone, Debug, Default)]
pub(super) struct Idle {
    /// keyword of a statement, with the arguments of it that are idle; none: all of it
    found: Vec<(String, Vec<String>)>,
    /// place of the first
    first: Option<crate::diagnostic::Span>,
}

impl Idle {
    /// Adds whatever of a record changes nothing.
    pub(super) fn add(&mut self, record: &Record) {
        let idle = |g: &Given| record.row.argument(g.argument).filter(|a| a.idle);
        let mut words: Vec<String> = record
            .given
            .iter()
            .filter_map(idle)
            .map(|a| a.keyword())
            .collect();
        if !record.row.numbered() && !record.row.reads_others() {
            words.extend(
                record
                    .kept
                    .iter()
                    .map(|(word, _)| word.to_ascii_uppercase()),
            );
        }
        let whole = record.row.is_idle();
        if words.is_empty() && !whole {
            return;
        }
        self.first.get_or_insert(record.head);
        let keyword = canonical(record.row.keyword());
        let at = match self.found.iter().position(|(k, _)| *k == keyword) {
            Some(at) => at,
            None => {
                self.found.push((keyword, Vec::new()));
                self.found.len() - 1
            }
        };
        let known = &mut self.found[at].1;
        for word in words.into_iter().filter(|_| !whole) {
            if !known.contains(&word) {
                known.push(word);
            }
        }
    }

    /// Returns what is to be said of them, at the first; `None`: there are none.
    pub(super) fn told(self, source: &Source) -> Option<Diagnostic> {
        let first = self.first?;
        let one = |(keyword, words): (String, Vec<String>)| match words.as_slice() {
            [] => keyword,
            words => format!("{keyword} {}", words.join(", ")),
        };
        let all: Vec<String> = self.found.into_iter().map(one).collect();
        let what = format!("accepted, and without effect here: {}", all.join("; "));
        let note = Diagnostic {
            severity: Severity::Note,
            ..Diagnostic::warning("ignored", what)
        };
        Some(source.locate(note, first))
    }
}
