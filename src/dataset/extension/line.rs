//! A comment line that makes an element, `JOINT/4 hinge = REVOLUTE, base, arm, AT=0,0,0`, taken
//! apart into its name, its words and its arguments with their numbers.

use super::{USAGE, bad, number, pieces};
use crate::dataset::syntax::Source;
use crate::diagnostic::{Diagnostic, Span, near_names};
use crate::space::Vec3;

/// Degrees of a radian: a stiffness per degree times this is one per radian.
const DEGREES_PER_RADIAN: f64 = 180.0 / std::f64::consts::PI;

/// An argument of a line, with its numbers.
struct Argument {
    key: String,
    span: Span,
    numbers: Vec<f64>,
}

/// A line that makes an element.
pub(super) struct Line<'a> {
    source: &'a Source,
    /// all of it
    pub span: Span,
    /// the name of what is made
    pub name: String,
    /// words without a value, with their places
    pub words: Vec<(String, Span)>,
    arguments: Vec<Argument>,
}

impl<'a> Line<'a> {
    /// Takes a line apart, behind its first word.
    ///
    /// # Errors
    /// When it has no name, an argument has no numbers, or is none of `keys`.
    pub fn read(source: &'a Source, span: Span, keys: &[&str]) -> Result<Self, Diagnostic> {
        let text = source.slice(span);
        let (name, rest) = text
            .split_once('=')
            .filter(|(name, rest)| !name.trim().is_empty() && !rest.trim().is_empty())
            .ok_or_else(|| source.locate(bad("a name and `=` are expected").help(USAGE), span))?;
        let mut line = Line {
            source,
            span,
            name: name.trim().to_owned(),
            words: Vec::new(),
            arguments: Vec::new(),
        };
        for (piece, at) in pieces(source, Span::new(span.end - rest.len(), span.end)) {
            line.take(&piece, at, keys)
                .map_err(|d| source.locate(d, at))?;
        }
        Ok(line)
    }

    /// Takes a piece between two commas: an argument, a further number of the last one, or a word.
    fn take(&mut self, piece: &str, at: Span, keys: &[&str]) -> Result<(), Diagnostic> {
        let Some((key, value)) = piece.split_once('=') else {
            match (self.arguments.last_mut(), number(piece)) {
                (Some(argument), Some(value)) => {
                    argument.numbers.push(value);
                    argument.span.end = at.end;
                }
                _ => self.words.push((piece.to_owned(), at)),
            }
            return Ok(());
        };
        let key = key.trim().to_ascii_uppercase();
        if !keys.contains(&key.as_str()) {
            let near = near_names(&key, keys.iter().copied());
            let d = bad(format!("`{key}` is no argument here"));
            return Err(match near.is_empty() {
                true => d.help(format!("there are {}", keys.join(", "))),
                false => d.help(format!("did you mean {}?", near.join(" or "))),
            });
        }
        if self.argument(&key).is_some() {
            let what = format!("{key} of {} is given twice", self.name);
            return Err(Diagnostic::error("given_twice", what));
        }
        let value = value.trim();
        let parsed = match value.strip_suffix("/D").or(value.strip_suffix("/d")) {
            Some(per_degree) => number(per_degree).map(|x| x * DEGREES_PER_RADIAN),
            None => number(value),
        };
        let wrong = || {
            bad(format!(
                "{key} = a number is expected, with D in degrees, with /D per degree"
            ))
        };
        let numbers = vec![parsed.ok_or_else(wrong)?];
        self.arguments.push(Argument {
            key,
            span: at,
            numbers,
        });
        Ok(())
    }

    fn argument(&self, key: &str) -> Option<&Argument> {
        self.arguments.iter().find(|a| a.key == key)
    }

    /// Returns the number of an argument, or `None` where it is not given.
    ///
    /// # Errors
    /// When it has several numbers.
    pub fn number(&self, key: &str) -> Result<Option<f64>, Diagnostic> {
        let Some(argument) = self.argument(key) else {
            return Ok(None);
        };
        match argument.numbers[..] {
            [value] => Ok(Some(value)),
            _ => Err(self.at(bad(format!("{key} is one number")), argument.span)),
        }
    }

    /// Returns the three numbers of an argument, or `None` where it is not given.
    ///
    /// # Errors
    /// When it has not three numbers.
    pub fn vector(&self, key: &str) -> Result<Option<Vec3<f64>>, Diagnostic> {
        let Some(argument) = self.argument(key) else {
            return Ok(None);
        };
        match argument.numbers[..] {
            [x, y, z] => Ok(Some(Vec3([x, y, z]))),
            _ => Err(self.at(
                bad(format!("{key} is three numbers, x, y, z")),
                argument.span,
            )),
        }
    }

    /// Returns a mistake with its place.
    pub fn at(&self, d: Diagnostic, span: Span) -> Diagnostic {
        self.source.locate(d, span)
    }
}
