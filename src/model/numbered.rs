//! Expressions that name elements, `DX(slider.cm, ground)`, as expressions of the language, which
//! knows their numbers only.

use super::{ElementKind, Model};
use crate::diagnostic::{Diagnostic, Span};
use crate::expr::ast::{Callee, Dialect};
use crate::expr::signature::Kind;
use crate::expr::{DEEPEST_NESTING, Expansion, Expr, MOST_CHARACTERS, Profile, Symbol, symbol};

impl Model {
    /// Returns an expression with the numbers of elements in the place of their names: wherever a
    /// function takes the number of an element, any name will do by which [`Model::find_of`] finds
    /// it. Names with commas or parentheses stand in quotation marks. `ground` is 0 where 0 stands
    /// for ground.
    ///
    /// # Errors
    /// All names that mean no element, or several, at their places.
    pub fn numbered(&self, typed: &str) -> Result<Expansion, Vec<Diagnostic>> {
        let mut search = Search {
            model: self,
            typed,
            found: Vec::new(),
            wrong: Vec::new(),
        };
        if typed.len() <= MOST_CHARACTERS {
            search.look(Span::new(0, typed.len()), 0);
        }
        match search.wrong.is_empty() {
            true => Ok(Expansion::new(typed, search.found)),
            false => Err(search.wrong),
        }
    }
}

/// A search for names in the arguments of an expression.
struct Search<'a> {
    model: &'a Model,
    typed: &'a str,
    /// names, in order, with the numbers that they stand for
    found: Vec<(Span, String)>,
    wrong: Vec<Diagnostic>,
}

impl Search<'_> {
    /// Looks for calls of functions that take elements.
    fn look(&mut self, within: Span, depth: usize) {
        let mut at = within.start;
        while let Some(start) = self.next_word(at, within.end) {
            let end = self.end_of_word(start, within.end);
            at = end;
            let rest = &self.typed[end..within.end];
            let open = end + rest.len() - rest.trim_start().len();
            let is_call = self.typed[open..within.end].starts_with('(');
            let meaning = symbol(&self.typed[start..end], Dialect::Function, Profile::Adams);
            let Some(Symbol::Callee(callee)) = meaning.filter(|_| is_call) else {
                continue;
            };
            let names_elements = |a: &_| matches!(kind_of(a), Kind::Identifier { .. });
            if depth > DEEPEST_NESTING || !callee.arguments().iter().any(names_elements) {
                continue;
            }
            let (arguments, after) = self.arguments(open + 1, within.end);
            for (k, span) in arguments.into_iter().enumerate() {
                self.argument(callee, k, span, depth);
            }
            at = after;
        }
    }

    /// Returns where the next word begins.
    fn next_word(&self, from: usize, end: usize) -> Option<usize> {
        let text = &self.typed[from..end];
        let mut before = ' ';
        for (at, c) in text.char_indices() {
            if c.is_ascii_alphabetic() && !(before.is_ascii_alphanumeric() || before == '_') {
                return Some(from + at);
            }
            before = c;
        }
        None
    }

    fn end_of_word(&self, start: usize, end: usize) -> usize {
        let text = &self.typed[start..end];
        let length = text.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
        length.map_or(end, |length| start + length)
    }

    /// Returns the arguments of a call without the blanks around them, and where the call ends.
    fn arguments(&self, from: usize, end: usize) -> (Vec<Span>, usize) {
        let text = &self.typed[from..end];
        let (mut spans, mut first, mut depth, mut quote) = (Vec::new(), from, 0_usize, None);
        let mut after = end;
        for (at, c) in text.char_indices() {
            let at = from + at;
            match (quote, c) {
                (Some(mark), c) => quote = Some(mark).filter(|mark| *mark != c),
                (None, '\'' | '"') => quote = Some(c),
                (None, '(') => depth += 1,
                (None, ')') if depth == 0 => {
                    after = at;
                    break;
                }
                (None, ')') => depth -= 1,
                (None, ',') if depth == 0 => {
                    spans.push(self.trimmed(first, at));
                    first = at + 1;
                }
                _ => {}
            }
        }
        spans.push(self.trimmed(first, after));
        (spans, after)
    }

    fn trimmed(&self, start: usize, end: usize) -> Span {
        let text = &self.typed[start..end];
        let first = start + text.len() - text.trim_start().len();
        Span::new(first, first + text.trim().len())
    }

    /// Notes the number of the element that an argument names.
    fn argument(&mut self, callee: Callee, k: usize, span: Span, depth: usize) {
        let text = &self.typed[span.start..span.end];
        let Kind::Identifier { element, zero } = callee.argument(k) else {
            return self.look(span, depth + 1);
        };
        let is_number = text.bytes().all(|b| b.is_ascii_digit());
        if is_number || text.starts_with(['-', '+', '(']) {
            return;
        }
        let kind = ElementKind::from(element);
        match self.model.find_of(&[kind], text) {
            Ok(id) => self.found.push((span, id.number.to_string())),
            Err(_) if zero && self.is_ground(text) => self.found.push((span, "0".to_owned())),
            // a number with a unit or a formula is no name, which the reader of expressions tells
            Err(_) if Expr::parse(text).is_ok() => {}
            Err(d) => self.wrong.push(d.at(self.typed, span)),
        }
    }

    fn is_ground(&self, text: &str) -> bool {
        let part = self.model.find_of(&[ElementKind::Part], text).ok();
        let part = part.and_then(|id| self.model.parts.get(&id.number));
        part.map_or(text.eq_ignore_ascii_case("ground"), |part| part.ground)
    }
}

fn kind_of(argument: &crate::expr::signature::Argument) -> Kind {
    argument.kind
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: &str = "names\nPART/1, GROUND\nMARKER/1, PART=1\n\
        !  adams_view_name='arm (left), bent'\nPART/2, MASS=1, CM=20, IP=1,1,1\nMARKER/20, PART=2\n\
        !  adams_view_name='tip'\nMARKER/21, PART=2\n\
        !  adams_view_name='gain'\nVARIABLE/3, FUNCTION=1\nEND\n";

    #[test]
    fn names_stand_where_numbers_do_and_nowhere_else() {
        let model = Model::from_text(MODEL).unwrap();
        let numbered = |text: &str| model.numbered(text).unwrap().text;
        for (typed, text) in [
            ("DX(tip, ground)", "DX(21, 0)"),
            ("2*dm( TIP ,MARKER/1)+TIME", "2*dm( 21 ,1)+TIME"),
            ("VARVAL(gain)*SIN(VARVAL(gain))", "VARVAL(3)*SIN(VARVAL(3))"),
            ("DX('arm (left), bent'.cm, PART_1)", "DX(20, 0)"),
            ("MAX(DX(tip), gain)", "MAX(DX(21), gain)"),
            ("DX(12,TIME)", "DX(12,TIME)"),
            ("DX(-1,2D", "DX(-1,2D"),
            ("DX(tip", "DX(21"),
        ] {
            assert_eq!(numbered(typed), text, "{typed}");
        }
        let wrong = model.numbered("DX(tpi, 1) + VARVAL(gian)").unwrap_err();
        let places: Vec<_> = wrong.iter().map(|d| (d.column, d.help.concat())).collect();
        assert_eq!(places[0], (4, "did you mean tip?".into()));
        assert_eq!(places[1], (21, "did you mean gain?".into()));
    }
}
