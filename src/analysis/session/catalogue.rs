//! Columns by what a user calls them: an expression of the language, in which elements may have
//! their names, or a component of a set of results, which need not be recorded for it.

use super::columns::Columns;
use super::outcome::units;
use super::selection::Selection;
use super::shown::What;
use crate::diagnostic::{Diagnostic, Span};
use crate::model::{ElementId, Labels, Model, Text};
use crate::results::{Run, Units};
use std::collections::HashMap;

/// Names of sets and columns that are taken while columns are declared.
#[derive(Debug, Default)]
pub(super) struct Names {
    /// names of elements in results
    pub labels: Labels,
    sets: Taken,
    columns: Taken,
}

/// Names that are taken, each with the last number that was put behind it.
#[derive(Debug, Default)]
pub(super) struct Taken(HashMap<String, u32>);

impl Taken {
    /// Takes a name; where it is taken, with the first number behind it that is free.
    pub fn take(&mut self, name: String) -> String {
        let Some(last) = self.0.get(&name) else {
            self.0.insert(name.clone(), 1);
            return name;
        };
        let mut n = *last;
        loop {
            n += 1;
            let numbered = format!("{name}_{n}");
            if !self.0.contains_key(&numbered) {
                self.0.insert(name, n);
                self.0.insert(numbered.clone(), 1);
                return numbered;
            }
        }
    }
}

impl Names {
    /// Begins with the names of the elements of a model.
    pub fn of(model: &Model) -> Self {
        Self {
            labels: model.labels(),
            ..Self::default()
        }
    }

    /// Returns the name of an element in results.
    pub fn element(&self, model: &Model, id: ElementId) -> String {
        self.labels.name(model, id)
    }

    /// Takes the name of a set.
    pub fn set(&mut self, name: String) -> String {
        self.sets.take(name)
    }

    /// Takes the name of a column.
    pub fn column(&mut self, name: String) -> String {
        self.columns.take(name)
    }
}

/// A component of a set of results, as it is computed.
pub(super) enum Piece {
    Text(Text),
    Scene(What),
}

/// All sets of results that a model has, whatever is recorded of them.
pub(super) struct Catalogue {
    run: Run,
    columns: Columns,
}

impl Catalogue {
    /// Declares all sets of a model.
    pub fn of(model: &Model, units: &Units) -> Self {
        let mut run = Run::new("", "", units.clone());
        let selection = Selection {
            full: true,
            frames: true,
            body_rates: true,
            only: &[],
            by_default: false,
        };
        let none = |_: u32, _: &_| false;
        let before = Columns::default();
        let columns = Columns::chosen(model, &mut run, &[], &selection, &none, before);
        Self { run, columns }
    }

    /// Finds a component: its unit, and how it is computed.
    ///
    /// # Errors
    /// When there is none of this name, with near names, or there are several.
    pub fn find(&self, name: &str) -> Result<(String, Piece), Diagnostic> {
        let column = self.run.resolve(name)?;
        let piece = self.columns.piece(column);
        let piece = piece.ok_or_else(|| self.run.unknown_column(name))?;
        Ok((self.run.columns[column].unit.clone(), piece))
    }
}

/// Returns an expression with the numbers of elements in the place of their names; `None`: it is
/// no expression of the language, or names what is not there.
pub(super) fn expression_of(model: &Model, text: &str) -> Option<Text> {
    let text = Text::from(model.numbered(text).ok()?.text);
    text.ast().is_ok().then_some(text)
}

/// Returns the mistakes in the name of a column: an expression that reads the model, in which
/// elements may have their names, or a component of a set of results, as `crank_bearing.FX`.
/// Places count in the text.
pub fn check_column(model: &Model, text: &str) -> Vec<Diagnostic> {
    let mut wrong = model.check_expression(text);
    if wrong.is_empty() || !text.contains('.') {
        return wrong;
    }
    match Catalogue::of(model, &units(model)).find(text) {
        Ok(_) => Vec::new(),
        Err(d) if text.contains('(') => {
            let advice = d.help.into_iter();
            let advice = advice.filter(|h| !h.starts_with("columns:"));
            wrong[0].help.extend(advice);
            wrong
        }
        Err(d) => vec![d.at(text, Span::new(0, text.len()))],
    }
}
