//! Functions of time: texts of several pieces, in which names of objects become their numbers.
//!
//! ```text
//! DX(.m.P.M3, .m.ground.M5) → DX(3, 5)    .m.measure → VARVAL(n)    .m.DV_1 → its value
//! ```

use super::{Draft, Maker, Want};
use crate::dataset::view::database::Datum;
use crate::dataset::view::term::Term;
use crate::diagnostic::Span;
use crate::expr::ast::Dialect;
use crate::expr::{Profile, symbol};
use crate::model::{Break, Formula};

/// A text with the places of its pieces in the file.
#[derive(Default)]
struct Typed {
    text: String,
    /// byte of the text, byte of the file
    places: Vec<(usize, usize)>,
    /// within the file's own text: places go on from byte to byte
    is_exact: bool,
}

impl Typed {
    fn place(&self, at: usize) -> usize {
        let last = self.places.iter().rev().find(|(start, _)| *start <= at);
        match last {
            Some((start, file)) if self.is_exact => file + (at - start),
            Some((_, file)) => *file,
            None => 0,
        }
    }
}

impl Maker<'_> {
    /// Gives an argument the function that an argument of the object holds; returns whether it has
    /// one.
    pub fn function(&self, draft: &mut Draft, argument: &str, keyword: &str) -> bool {
        let Some(k) = draft.object else {
            return false;
        };
        let Some(typed) = self.typed(k, argument) else {
            return false;
        };
        if typed.text.trim().is_empty() {
            return false;
        }
        match self.replaced(k, &typed) {
            Ok(formula) => {
                draft.give(keyword, Want::Formula(formula), self.db.span(k, argument));
            }
            Err((span, trouble)) => {
                self.db.trouble(Some(k), span, &trouble);
                draft.record.mistaken = true;
            }
        }
        true
    }

    /// Gives `USER(…)` with its routine; returns whether the object has one.
    pub fn user(&self, draft: &mut Draft, argument: &str, routine: &str, keyword: &str) -> bool {
        let Some(k) = draft.object else {
            return false;
        };
        let Some(constants) = self.db.numbers(k, argument) else {
            return false;
        };
        let routine = self.db.word(k, routine).filter(|r| !r.is_empty());
        let formula = Formula::User { constants, routine };
        draft.give(keyword, Want::Formula(formula), self.db.span(k, argument));
        true
    }

    /// Returns the pieces of a text, joined without anything between them.
    fn typed(&self, k: usize, argument: &str) -> Option<Typed> {
        let attribute = self.db.given(k, argument)?;
        let mut typed = Typed {
            is_exact: true,
            ..Typed::default()
        };
        for item in &attribute.items {
            let from = typed.text.len();
            match &*item.term {
                Term::Text(text) if self.source.slice(item.span).starts_with('"') => {
                    typed.places.push((from, item.span.start + 1));
                    typed.is_exact &= self.source.slice(item.span).len() == text.len() + 2;
                    typed.text += text;
                }
                Term::Text(text) | Term::Name(text) => {
                    typed.places.push((from, item.span.start));
                    typed.is_exact = false;
                    typed.text += text;
                }
                _ => {
                    typed.places.push((from, item.span.start));
                    typed.is_exact = false;
                    let values = self.db.data(k, argument)?;
                    let texts = values
                        .iter()
                        .map(|v| self.db.as_text(v).unwrap_or_default());
                    typed.text = texts.collect();
                    break;
                }
            }
        }
        // a text over several lines of the file is one line
        typed.text = typed.text.replace(['\n', '\r', '\t'], " ");
        Some(typed)
    }

    /// Returns a function with numbers in the place of names.
    fn replaced(&self, k: usize, typed: &Typed) -> Result<Formula, (Span, String)> {
        let text = typed.text.trim_end();
        let lead = text.len() - text.trim_start().len();
        let mut out = String::new();
        // byte of the text, byte of the function that is made
        let mut marks = vec![(lead, 0)];
        let mut done = lead;
        for name in names(text) {
            let written = &text[name.start..name.end];
            let called = text[name.end..].trim_start().starts_with('(');
            let by = self.meaning(k, written, called).map_err(|trouble| {
                let start = typed.place(name.start);
                let length = if typed.is_exact { written.len() } else { 1 };
                (Span::new(start, start + length), trouble)
            })?;
            let Some(by) = by else {
                continue;
            };
            out += &text[done.min(name.start)..name.start];
            out += &by;
            marks.push((name.end, out.len()));
            done = name.end;
        }
        out += &text[done.min(text.len())..];
        let pieces = typed
            .places
            .iter()
            .filter(|(at, _)| *at > lead && *at < text.len());
        let between: Vec<(usize, usize)> = pieces
            .filter_map(|(at, _)| {
                let before = marks.iter().rev().find(|(typed, _)| typed <= at)?;
                Some((*at, before.1 + at - before.0))
            })
            .collect();
        marks.extend(between);
        marks.sort_unstable();
        let marks: Vec<(usize, usize)> = marks
            .into_iter()
            .map(|(at, made)| (made, typed.place(at)))
            .collect();
        Ok(self.formula(out, &marks))
    }

    /// Returns an expression whose bytes stand at these bytes of the file.
    pub fn formula(&self, text: String, marks: &[(usize, usize)]) -> Formula {
        let (line, column) = self.source.place(marks.first().map_or(0, |m| m.1));
        let breaks = marks.iter().skip(1).map(|(offset, at)| {
            let (line, column) = self.source.place(*at);
            Break {
                offset: *offset,
                line,
                column,
            }
        });
        Formula::Expression {
            breaks: breaks.collect(),
            text: text.into(),
            line,
            column,
        }
    }

    /// Returns what stands in the place of a name; `None` for words of the language.
    fn meaning(&self, k: usize, name: &str, called: bool) -> Result<Option<String>, String> {
        let is_full = name.starts_with('.');
        if !is_full && (called || is_word(name)) {
            return Ok(None);
        }
        let found = self.db.find(name).or_else(|| {
            let (object, field) = name.rsplit_once('.')?;
            let object = self.db.find(object)?;
            let argument = match field.to_ascii_lowercase().as_str() {
                "i" => "i_marker_name",
                "j" => "j_marker_name",
                "id" | "adams_id" => return Some(object),
                _ => return None,
            };
            self.db.reference_of(object, argument)
        });
        let Some(object) = found else {
            if !is_full && !name.contains('.') {
                // the reader of the language says what it is not
                return Ok(None);
            }
            if self.db.is_within_unread(name) {
                return Err(String::new());
            }
            let near = self.db.near(name);
            return Err(match near.is_empty() {
                true => format!("there is no `{name}`"),
                false => format!("there is no `{name}`; did you mean {}?", near.join(" or ")),
            });
        };
        if object == k {
            let own = self.ids.get(&k).map(|id| id.number.to_string());
            return Ok(own);
        }
        let kind = self.db.objects[object].kind;
        if let Some(id) = self.ids.get(&object) {
            return Ok(Some(match kind.starts_with("measure") {
                true => format!("VARVAL({})", id.number),
                false => id.number.to_string(),
            }));
        }
        if kind == crate::dataset::view::VARIABLE {
            match self.db.variable(object)? {
                Datum::Object(other) if other != object => {
                    let name = self.db.objects[other].name.clone();
                    return self.meaning(k, &name, called);
                }
                Datum::Text(text) if self.db.find(&text).is_none() => return Ok(Some(text)),
                _ => {}
            }
            let value = self.db.as_number(&Datum::Object(object))?;
            return Ok(Some(super::elements::shown(value)));
        }
        let why = match self.db.objects[object].is_idle {
            true => "is switched off (active = off)",
            false => "has no number that a function could read",
        };
        Err(format!("{} {why}", self.db.inner_name(object)))
    }
}

/// Returns whether a name is one of the language: a function, a constant.
fn is_word(name: &str) -> bool {
    symbol(name, Dialect::Function, Profile::Adams).is_some()
}

/// Returns the places of names in a function; numbers such as `1.5E-3D` are none.
fn names(text: &str) -> Vec<Span> {
    let bytes = text.as_bytes();
    let is_part = |b: u8| b.is_ascii_alphanumeric() || b == b'_' || b == b'$';
    let begins = |b: u8| b.is_ascii_alphabetic() || b == b'_' || b == b'$';
    let mut all = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let quoted = |at: usize| {
            let inner = text.get(at..)?.strip_prefix(".\"")?;
            inner.find('"').map(|length| at + length + 3)
        };
        let dotted = bytes[at] == b'.' && bytes.get(at + 1).is_some_and(|b| begins(*b));
        if begins(bytes[at]) || dotted || quoted(at).is_some() {
            let start = at;
            at = quoted(at).unwrap_or(at + 1);
            while at < bytes.len() {
                if let Some(end) = quoted(at) {
                    at = end;
                    continue;
                }
                let goes_on = bytes[at] == b'.' && bytes.get(at + 1).is_some_and(|b| is_part(*b));
                if !(is_part(bytes[at]) || goes_on) {
                    break;
                }
                at += 1;
            }
            all.push(Span::new(start, at));
        } else if bytes[at].is_ascii_digit() || bytes[at] == b'.' {
            at = end_of_number(bytes, at);
        } else {
            at += 1;
        }
    }
    all
}

fn end_of_number(bytes: &[u8], from: usize) -> usize {
    let digits = |mut at: usize| {
        while at < bytes.len() && bytes[at].is_ascii_digit() {
            at += 1;
        }
        at
    };
    let mut at = digits(from);
    if bytes.get(at) == Some(&b'.') {
        at = digits(at + 1);
    }
    let exponent = bytes
        .get(at)
        .is_some_and(|b| matches!(b, b'e' | b'E' | b'd' | b'D'));
    if exponent {
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        let end = digits(at + 1 + sign);
        at = if end > at + 1 + sign { end } else { at + 1 };
    }
    if bytes.get(at).is_some_and(|b| matches!(b, b'd' | b'D')) {
        at += 1;
    }
    at.max(from + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_told_from_numbers() {
        let text = "-1.5E-3D*.m.P.M_1+2.*TIME-3.e2*a.b(.m.x ) + .5D + 7d*q1.2";
        let found: Vec<&str> = names(text).iter().map(|s| &text[s.start..s.end]).collect();
        assert_eq!(found, [".m.P.M_1", "TIME", "a.b", ".m.x", "q1.2"]);
    }
}
