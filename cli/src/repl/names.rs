//! Names that a session gives to parts of expressions: what they stand for, and how a place in the
//! text with all names replaced leads back to the text as it was typed.

use cognate::diagnostic::{Diagnostic, Span};
use cognate::expr::MOST_CHARACTERS;
use std::collections::BTreeMap;

/// Names, upper case, with the text that each stands for; earlier names are replaced in it.
#[derive(Clone, Debug, Default)]
pub struct Names(pub BTreeMap<String, String>);

/// A text as it was typed, and the same with names replaced.
#[derive(Clone, Debug)]
pub struct Expansion {
    /// as it was typed
    pub typed: String,
    /// with names replaced by what they stand for, in parentheses
    pub text: String,
    /// pieces of both texts, in order
    pieces: Vec<Piece>,
}

/// A word, or what is between words, in both texts.
#[derive(Clone, Copy, Debug)]
struct Piece {
    typed: Span,
    expanded: Span,
    /// whether it is a name and what it stands for
    replaced: bool,
}

impl Names {
    /// Replaces names by what they stand for, in parentheses.
    pub fn expand(&self, typed: &str) -> Expansion {
        if typed.len() > MOST_CHARACTERS {
            // no expression has so many characters: it is refused as it stands
            return Expansion {
                typed: typed.to_owned(),
                text: typed.to_owned(),
                pieces: Vec::new(),
            };
        }
        let mut text = String::with_capacity(typed.len());
        let mut pieces = Vec::new();
        let mut at = 0;
        for word in words(typed) {
            let start = text.len();
            let body = self
                .0
                .get(&word.to_ascii_uppercase())
                .filter(|body| start + body.len() < MOST_CHARACTERS);
            match body {
                Some(body) => text.extend(["(", body, ")"]),
                None => text.push_str(word),
            }
            pieces.push(Piece {
                typed: Span::new(at, at + word.len()),
                expanded: Span::new(start, text.len()),
                replaced: body.is_some(),
            });
            at += word.len();
        }
        Expansion {
            typed: typed.to_owned(),
            text,
            pieces,
        }
    }
}

impl Expansion {
    /// The diagnostic about the expanded text as one about the text that was typed: a place inside
    /// a replaced name becomes that name, and advice says what the name stands for.
    pub fn as_typed(&self, said: Diagnostic) -> Diagnostic {
        if !self.pieces.iter().any(|p| p.replaced) {
            return said;
        }
        let mut inside: Vec<Span> = Vec::new();
        let mut place = |span: Span| {
            let (start, first) = self.typed_at(span.start);
            let (end, last) = self.typed_at(span.end.saturating_sub(1).max(span.start));
            inside.extend([first, last].into_iter().flatten());
            let start = first.map_or(start, |name| name.start);
            let one_past = usize::from(span.end > span.start);
            Span::new(
                start,
                last.map_or(end + one_past, |name| name.end).max(start),
            )
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
        inside.dedup();
        for name in inside {
            let word = self.typed.get(name.start..name.end).unwrap_or_default();
            if let Some(piece) = self.pieces.iter().find(|p| p.typed == name) {
                let body = self
                    .text
                    .get(piece.expanded.start + 1..piece.expanded.end - 1);
                said.help
                    .push(format!("{word} stands for {}", body.unwrap_or_default()));
            }
        }
        said
    }

    /// The byte of the typed text for one of the expanded text; the name that stands there, if a
    /// name was replaced there.
    fn typed_at(&self, expanded: usize) -> (usize, Option<Span>) {
        let piece = self
            .pieces
            .iter()
            .find(|p| (p.expanded.start..p.expanded.end).contains(&expanded));
        match piece {
            Some(p) if p.replaced => (p.typed.start, Some(p.typed)),
            Some(p) => (p.typed.start + (expanded - p.expanded.start), None),
            // one past the last character
            None => (self.typed.len(), None),
        }
    }
}

/// The text in pieces: words that begin with a letter, numbers with exponent and suffix, and what
/// is between them.
pub fn words(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let first = rest.chars().next()?;
        let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let length = match first {
            '!' => rest.find('\n').unwrap_or(rest.len()),
            c if c.is_ascii_alphanumeric() || c == '.' => rest
                .find(|c| !word(c) && c != '.')
                .unwrap_or(rest.len())
                .max(1),
            _ => rest
                .find(|c: char| c.is_ascii_alphanumeric() || c == '.' || c == '!')
                .unwrap_or(rest.len()),
        };
        let (piece, after) = rest.split_at(length);
        rest = after;
        Some(piece)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cognate::expr::Expr;

    fn names(list: &[(&str, &str)]) -> Names {
        let pairs = list.iter().map(|(n, b)| (n.to_string(), b.to_string()));
        Names(pairs.collect())
    }

    #[test]
    fn numbers_and_comments_keep_their_letters() {
        let pieces: Vec<&str> = words("2E5*e+30D!e\nx_1.").collect();
        assert_eq!(pieces, ["2E5", "*", "e", "+", "30D", "!e", "\n", "x_1."]);
    }

    #[test]
    fn a_place_behind_a_name_is_the_place_that_was_typed() {
        let typed = "w*FOO + w";
        let expansion = names(&[("W", "2*PI")]).expand(typed);
        assert_eq!(expansion.text, "(2*PI)*FOO + (2*PI)");
        let said = expansion.as_typed(Expr::parse(&expansion.text).unwrap_err().into_first());
        assert_eq!((said.span, said.column), (Some(Span::new(2, 5)), 3));
        assert!(!said.help.iter().any(|h| h.contains("stands for")));
    }

    #[test]
    fn a_place_inside_a_name_is_the_name_and_says_what_it_stands_for() {
        let typed = "1 + root*2";
        let expansion = names(&[("ROOT", "SQRT(TIME-1)")]).expand(typed);
        let expr = Expr::parse(&expansion.text).unwrap();
        let said = expansion.as_typed(expr.eval(&[("TIME", 0.0)]).unwrap_err().into_first());
        assert_eq!(said.span, Some(Span::new(4, 8)));
        assert_eq!(said.help, ["root stands for SQRT(TIME-1)"]);
    }

    #[test]
    fn the_end_of_the_text_stays_its_end() {
        for typed in ["2*(w", "2*(w +", "MAX(w, w"] {
            let expansion = names(&[("W", "1")]).expand(typed);
            let said = expansion.as_typed(Expr::parse(&expansion.text).unwrap_err().into_first());
            assert_eq!(said.span, Some(Span::new(typed.len(), typed.len())));
        }
    }
}
