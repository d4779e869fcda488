//! A text in which names have been replaced by what they stand for, and the way back from a place
//! in it to the text as it was typed.

use crate::diagnostic::{Diagnostic, Span};

/// A text as it was typed, and the same with names replaced.
#[derive(Clone, Debug)]
pub struct Expansion {
    /// as it was typed
    pub typed: String,
    /// with names replaced by what they stand for
    pub text: String,
    /// the names, in order
    pieces: Vec<Piece>,
}

/// A name in the typed text, and what stands in its place in the other.
#[derive(Clone, Copy, Debug)]
struct Piece {
    typed: Span,
    expanded: Span,
}

impl Expansion {
    /// Replaces parts of a text, which follow one another, by other texts.
    pub fn new(typed: &str, parts: impl IntoIterator<Item = (Span, String)>) -> Self {
        let (mut text, mut pieces, mut done) = (String::new(), Vec::new(), 0);
        for (span, by) in parts {
            text.push_str(typed.get(done..span.start).unwrap_or_default());
            let start = text.len();
            text.push_str(&by);
            pieces.push(Piece {
                typed: span,
                expanded: Span::new(start, text.len()),
            });
            done = span.end;
        }
        text.push_str(typed.get(done..).unwrap_or_default());
        Self {
            typed: typed.to_owned(),
            text,
            pieces,
        }
    }

    /// Returns the diagnostic about the expanded text as one about the text that was typed: a place
    /// inside a replaced name becomes that name, and advice says what the name stands for.
    pub fn as_typed(&self, said: Diagnostic) -> Diagnostic {
        if self.pieces.is_empty() {
            return said;
        }
        let mut inside: Vec<Piece> = Vec::new();
        let mut place = |span: Span| {
            let (start, first) = self.typed_at(span.start);
            let (end, last) = self.typed_at(span.end.saturating_sub(1).max(span.start));
            inside.extend([first, last].into_iter().flatten());
            let start = first.map_or(start, |name| name.typed.start);
            let one_past = usize::from(span.end > span.start);
            let end = last.map_or(end + one_past, |name| name.typed.end);
            Span::new(start, end.max(start))
        };
        let span = said.span.map(&mut place);
        let marks = said
            .marks
            .iter()
            .map(|(span, what)| (place(*span), what.clone()))
            .collect();
        let before = |span: Span| self.typed.get(..span.start).unwrap_or(&self.typed);
        let mut said = Diagnostic {
            column: span.map_or(said.column, |s| before(s).chars().count() + 1),
            span,
            marks,
            ..said
        };
        inside.dedup_by_key(|piece| piece.typed);
        for Piece { typed, expanded } in inside {
            let word = self.typed.get(typed.start..typed.end).unwrap_or_default();
            let by = self.text.get(expanded.start..expanded.end);
            let by = by.unwrap_or_default();
            let by = by
                .strip_prefix('(')
                .and_then(|b| b.strip_suffix(')'))
                .unwrap_or(by);
            said.help.push(format!("{word} stands for {by}"));
        }
        said
    }

    /// Returns the byte of the typed text for one of the expanded text, and the name that stands
    /// there, if one was replaced there.
    fn typed_at(&self, expanded: usize) -> (usize, Option<Piece>) {
        let before = self.pieces.iter().rev();
        match before.into_iter().find(|p| p.expanded.start <= expanded) {
            Some(p) if expanded < p.expanded.end => (p.typed.start, Some(*p)),
            Some(p) => {
                let at = p.typed.end + (expanded - p.expanded.end);
                (at.min(self.typed.len()), None)
            }
            None => (expanded.min(self.typed.len()), None),
        }
    }
}
