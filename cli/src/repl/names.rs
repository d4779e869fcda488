//! Names that a session gives to parts of expressions, and what they stand for.

use cognate::diagnostic::Span;
use cognate::expr::{Expansion, MOST_CHARACTERS};
use std::collections::BTreeMap;

/// Names, upper case, with the text that each stands for; earlier names are replaced in it.
#[derive(Clone, Debug, Default)]
pub struct Names(pub BTreeMap<String, String>);

impl Names {
    /// Replaces names by what they stand for, in parentheses.
    pub fn expand(&self, typed: &str) -> Expansion {
        if typed.len() > MOST_CHARACTERS {
            // no expression has so many characters: it is refused as it stands
            return Expansion::new(typed, Vec::new());
        }
        let (mut at, mut length) = (0, typed.len());
        let mut parts = Vec::new();
        for word in words(typed) {
            let body = self.0.get(&word.to_ascii_uppercase());
            if let Some(body) = body.filter(|body| length + body.len() < MOST_CHARACTERS) {
                length += body.len();
                parts.push((Span::new(at, at + word.len()), format!("({body})")));
            }
            at += word.len();
        }
        Expansion::new(typed, parts)
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
