//! Arguments of objects as what is wanted of them: numbers, words, other objects.

use super::database::{Attribute, Database, Datum, Item};
use super::frames::Reading;
use super::term::Term;
use crate::diagnostic::Span;

impl Database {
    /// Returns an argument that has a value.
    pub fn given(&self, k: usize, argument: &str) -> Option<&Attribute> {
        let attribute = self.objects[k].attributes.get(argument)?;
        (!attribute.items.is_empty()).then_some(attribute)
    }

    /// Returns the values of an argument; what has none is told once.
    pub fn data(&self, k: usize, argument: &str) -> Option<Vec<Datum>> {
        let attribute = self.given(k, argument)?;
        let within = Reading {
            object: Some(k),
            frame: self.frame_of(attribute).clone(),
        };
        match self.values(attribute, &within) {
            Ok(values) => Some(values),
            Err(trouble) => {
                self.trouble(Some(k), attribute.span, &trouble);
                None
            }
        }
    }

    /// Returns the numbers of an argument, in units of the file.
    pub fn numbers(&self, k: usize, argument: &str) -> Option<Vec<f64>> {
        let values = self.data(k, argument)?;
        match self.as_numbers(&Datum::List(values)) {
            Ok(numbers) => Some(numbers),
            Err(trouble) => {
                self.trouble(Some(k), self.span(k, argument), &trouble);
                None
            }
        }
    }

    /// Returns the number of an argument.
    pub fn number(&self, k: usize, argument: &str) -> Option<f64> {
        let numbers = self.numbers(k, argument)?;
        match numbers[..] {
            [one] => Some(one),
            _ => {
                let what = format!("{argument} takes one number, not {}", numbers.len());
                self.trouble(Some(k), self.span(k, argument), &what);
                None
            }
        }
    }

    /// Returns the place of an argument, or of the object's command.
    pub fn span(&self, k: usize, argument: &str) -> Span {
        self.given(k, argument)
            .map_or(self.objects[k].head, |a| a.span)
    }

    /// Returns a word or a text, as written.
    pub fn word(&self, k: usize, argument: &str) -> Option<String> {
        let attribute = self.given(k, argument)?;
        if let [item] = &attribute.items[..]
            && let Term::Name(word) = &*item.term
            && item.is_bare
        {
            return Some(word.clone());
        }
        let values = self.data(k, argument)?;
        let texts: Vec<String> = values.iter().filter_map(|v| self.as_text(v).ok()).collect();
        Some(texts.concat())
    }

    /// Returns a word in lower case.
    pub fn choice(&self, k: usize, argument: &str) -> Option<String> {
        Some(self.word(k, argument)?.to_ascii_lowercase())
    }

    /// Returns whether an argument is `on` or `yes`; `None` where it is not given.
    pub fn is_on(&self, k: usize, argument: &str) -> Option<bool> {
        let word = self.choice(k, argument)?;
        match word.as_str() {
            "on" | "yes" | "true" | "1" => Some(true),
            "off" | "no" | "false" | "0" => Some(false),
            _ => None,
        }
    }

    /// Returns the texts of an argument, one for each value.
    pub fn texts(&self, k: usize, argument: &str) -> Vec<String> {
        let Some(attribute) = self.given(k, argument) else {
            return Vec::new();
        };
        let text = |item: &Item| match &*item.term {
            Term::Text(text) | Term::Name(text) if item.is_bare => Some(text.clone()),
            Term::Text(text) => Some(text.clone()),
            _ => None,
        };
        let as_written: Option<Vec<String>> = attribute.items.iter().map(text).collect();
        as_written.unwrap_or_else(|| {
            let values = self.data(k, argument).unwrap_or_default();
            values.iter().filter_map(|v| self.as_text(v).ok()).collect()
        })
    }

    /// Returns the objects that an argument names; a name that is none is told.
    pub fn references_of(&self, k: usize, argument: &str) -> Vec<usize> {
        let values = self.data(k, argument).unwrap_or_default();
        let mut all = Vec::new();
        for value in values {
            let object = match &value {
                Datum::Object(k) => match self.variable(*k) {
                    Ok(Datum::Object(k)) => Some(k),
                    Ok(Datum::Text(text)) => self.find(&text),
                    _ => Some(*k),
                },
                Datum::Text(text) => self.find(text),
                Datum::List(_) | Datum::Number(_) | Datum::Nothing => None,
            };
            if let Some(object) = object {
                all.push(object);
            } else if value != Datum::Nothing {
                let text = self.as_text(&value).unwrap_or_default();
                if self.is_within_unread(&text) {
                    continue;
                }
                let near = self.near(&text);
                let what = match near.is_empty() {
                    true => format!("there is no `{text}`"),
                    false => format!("there is no `{text}`; did you mean {}?", near.join(" or ")),
                };
                self.trouble(Some(k), self.span(k, argument), &what);
            }
        }
        all
    }

    /// Returns the object that an argument names.
    pub fn reference_of(&self, k: usize, argument: &str) -> Option<usize> {
        self.references_of(k, argument).into_iter().next()
    }
}
