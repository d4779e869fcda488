//! Statements on their way into the model: each keeps its arguments, and the mistakes in them,
//! until the model is made.

use super::pose::Stand;
use super::{Element, Inner, ModelBuilder, Setting};
use crate::dataset::row::{Argument, Given, Meaning, Record, Statement, canonical, meaning};
use crate::dataset::statement::{STATEMENTS, find};
use crate::diagnostic::{Cause, Diagnostic, Error, Severity, Span, near_names};
use crate::model::check::names::names_twice;
use crate::model::{ElementId, ElementKind, Model, Place};
use std::collections::BTreeSet;

/// A statement that has not been entered yet.
pub(super) struct Draft {
    pub row: &'static dyn Statement,
    pub id: Option<u32>,
    pub name: Option<String>,
    given: Vec<Given>,
    kept: Vec<(String, String)>,
    wrong: Vec<Diagnostic>,
    /// where a marker stands in ground, and on which draft
    pub stand: Option<Stand>,
    /// there is no such statement, which has been told
    is_lost: bool,
}

impl Draft {
    fn new(row: &'static dyn Statement, id: Option<u32>, name: &str) -> Self {
        Self {
            row,
            id,
            name: (!name.is_empty()).then(|| name.to_string()),
            given: Vec::new(),
            kept: Vec::new(),
            wrong: Vec::new(),
            stand: None,
            is_lost: false,
        }
    }

    /// Takes note of a mistake.
    pub fn refuse(&mut self, said: Diagnostic) {
        self.wrong.push(said);
    }

    /// Returns the element, where it is one.
    pub fn element(&self) -> Option<ElementId> {
        Some(self.row.kind()?.id(self.id?))
    }

    /// Returns the draft of a statement that there is not: it takes arguments, and nothing becomes
    /// of it.
    fn lost() -> Self {
        let title = STATEMENTS[0];
        Self {
            is_lost: true,
            ..Self::new(title, None, "")
        }
    }

    /// Gives an argument its value.
    pub fn give(&mut self, keyword: &str, setting: &Setting) {
        if self.is_lost {
            return;
        }
        let arguments = self.row.arguments();
        let k = match meaning(keyword, arguments.iter().map(|a| a.name)) {
            Meaning::One(k) => k,
            Meaning::Unknown if self.row.open() => {
                match setting {
                    Setting::Flag => self.kept.push((keyword.to_uppercase(), String::new())),
                    Setting::Text(text) => self.kept.push((keyword.to_uppercase(), text.clone())),
                    Setting::Real(x) => self.kept.push((keyword.to_uppercase(), x.to_string())),
                    Setting::Whole(n) => self.kept.push((keyword.to_uppercase(), n.to_string())),
                    _ => self.wrong.push(unknown(self.row, &arguments, keyword)),
                }
                return;
            }
            Meaning::Several(of) => {
                let names: Vec<String> = of.iter().map(|&k| arguments[k].keyword()).collect();
                let what = format!("{keyword} may be {}", names.join(" or "));
                self.wrong
                    .push(Diagnostic::error("ambiguous_argument", what));
                return;
            }
            Meaning::Unknown => {
                self.wrong.push(unknown(self.row, &arguments, keyword));
                return;
            }
        };
        let argument = &arguments[k];
        if !argument.repeated && self.given.iter().any(|g| g.argument == k) {
            let what = format!("{} is given twice", argument.keyword());
            self.wrong.push(Diagnostic::error("given_twice", what));
            return;
        }
        let group = argument.group;
        let rival = (self.given.iter()).find(|g| arguments[g.argument].group == group);
        if let (Some(group), Some(rival)) = (group, rival) {
            let [first, second] = [&arguments[rival.argument], argument].map(Argument::keyword);
            let what = format!("{first} and {second} are both given as the {group}");
            self.wrong
                .push(Diagnostic::error("excluded_argument", what));
            return;
        }
        match setting.fitted(argument) {
            Ok(value) => self.given.push(Given {
                argument: k,
                value,
                span: Span::default(),
            }),
            Err(said) => self.wrong.push(said),
        }
    }

    fn record(&self) -> Record {
        Record {
            row: self.row,
            id: self.id,
            given: self.given.clone(),
            kept: self.kept.clone(),
            place: Place {
                name: self.name.clone(),
                ..Place::default()
            },
            head: Span::default(),
            mistaken: !self.wrong.is_empty(),
        }
    }

    /// Says that a mistake is about this statement.
    fn about(&self, mut said: Diagnostic) -> Diagnostic {
        said.element = Some(self.record().element());
        said.name.clone_from(&self.name);
        said
    }

    /// Enters the statement; returns what is wrong with it.
    fn enter(&self, model: &mut Model) -> Vec<Diagnostic> {
        let mut record = self.record();
        let mut found: Vec<Diagnostic> = self.wrong.clone();
        if let Some(stand) = &self.stand {
            match stand.arguments(model, self.row) {
                Ok(more) => record.given.extend(more),
                Err(said) => found.push(said),
            }
        }
        for problem in self.row.enter(model, &record, false) {
            let mut said = Diagnostic::error(problem.code, problem.message);
            said.help.extend(problem.help);
            found.push(said);
        }
        found.into_iter().map(|said| self.about(said)).collect()
    }
}

/// Says that a statement has no such argument, and which it has.
fn unknown(row: &dyn Statement, arguments: &[Argument], keyword: &str) -> Diagnostic {
    let known: Vec<String> = arguments.iter().map(Argument::keyword).collect();
    let statement = canonical(row.keyword());
    let what = format!("{statement} has no argument {keyword}");
    let said = Diagnostic::error("unknown_argument", what);
    let near = near_names(keyword, known.iter().map(String::as_str));
    match near.is_empty() {
        true => said.help(format!("{statement} has {}", known.join(", "))),
        false => said.help(format!("did you mean {}?", near.join(" or "))),
    }
}

impl Inner {
    /// Returns the place of the draft of a new element, with the next number of its kind.
    pub fn add(&mut self, kind: ElementKind, name: &str) -> usize {
        let last = self.last.entry(kind).or_insert(0);
        *last += 1;
        let row = STATEMENTS.iter().find(|row| row.kind() == Some(kind));
        let row = *row.unwrap_or_else(|| unreachable!("every kind has a row"));
        self.drafts.push(Draft::new(row, Some(*last), name));
        self.drafts.len() - 1
    }

    /// Makes the model of all drafts: bodies first, for markers stand on them.
    pub fn model(&self) -> Result<Model, Error> {
        let mut model = Model {
            title: self.title.clone(),
            ..Model::default()
        };
        let is_body = |draft: &&Draft| {
            let kind = draft.row.kind();
            matches!(kind, Some(ElementKind::Part | ElementKind::PointMass))
        };
        let bodies = self.drafts.iter().filter(is_body);
        let rest = self.drafts.iter().filter(|draft| !is_body(draft));
        let mut wrong = self.wrong.clone();
        for draft in bodies.chain(rest).filter(|draft| !draft.is_lost) {
            wrong.extend(draft.enter(&mut model));
        }
        wrong.extend(
            names_twice(&model)
                .into_iter()
                .map(|ids| twice(&model, ids)),
        );
        // what seems to be missing may be what was not understood
        let mistaken: BTreeSet<String> = wrong.iter().filter_map(|d| d.element.clone()).collect();
        let mistaken = model.with_readers_of_data(mistaken);
        let mut found = model.check();
        found.retain(|d| {
            let excused = d.element.as_ref().is_some_and(|e| mistaken.contains(e));
            d.severity == Severity::Error && (!excused || d.is(Cause::UnknownElement))
        });
        wrong.extend(found.into_iter().map(|d| named(&model, d)));
        if wrong.is_empty() {
            Ok(model)
        } else {
            Err(wrong.into())
        }
    }
}

/// Says that two elements of a kind have one name, as a cell of a notebook that has run twice makes
/// them.
fn twice(model: &Model, (first, second): (ElementId, ElementId)) -> Diagnostic {
    let what = format!("{first} has this name already");
    let said = Diagnostic::error("name_twice", what).element(second);
    named(model, said).help(
        "each element of a kind needs a name of its own; a notebook begins a new builder in the cell that adds to it",
    )
}

/// Adds the name of the element that a mistake is about.
fn named(model: &Model, mut said: Diagnostic) -> Diagnostic {
    let name = said.subject().and_then(|s| model.name_of(&s));
    said.name = name.map(str::to_owned);
    said
}

impl ModelBuilder {
    /// Adds a statement with a number by the kind of its element; it gets the next number of its
    /// kind. `name` may be empty.
    pub fn element(&self, kind: ElementKind, name: &str) -> Element<'_> {
        let draft = self.inner.borrow_mut().add(kind, name);
        Element::new(self, draft)
    }

    /// Returns the statement without a number that has this keyword, to be given arguments:
    /// `settings("INTEGRATOR").set("ERROR", 1e-8)`.
    pub fn settings(&self, keyword: &str) -> Element<'_> {
        let mut inner = self.inner.borrow_mut();
        let row = match find(keyword) {
            Meaning::One(k) if !STATEMENTS[k].numbered() => STATEMENTS[k],
            _ => {
                let known = STATEMENTS.iter().filter(|row| !row.numbered());
                let known: Vec<String> = known.map(|row| canonical(row.keyword())).collect();
                let what = format!("`{keyword}` is no statement of settings");
                let said = Diagnostic::error("unknown_statement", what);
                inner
                    .wrong
                    .push(said.help(format!("there are {}", known.join(", "))));
                inner.drafts.push(Draft::lost());
                let draft = inner.drafts.len() - 1;
                drop(inner);
                return Element::new(self, draft);
            }
        };
        let is_it = |d: &Draft| !d.is_lost && d.id.is_none() && d.row.keyword() == row.keyword();
        let there = inner.drafts.iter().position(is_it);
        let draft = there.unwrap_or_else(|| {
            inner.drafts.push(Draft::new(row, None, ""));
            inner.drafts.len() - 1
        });
        drop(inner);
        Element::new(self, draft)
    }

    /// Gives an argument of a draft its value.
    pub(super) fn give(&self, draft: usize, keyword: &str, setting: Setting) {
        let setting = setting.numbered(keyword, self);
        let mut inner = self.inner.borrow_mut();
        let draft = &mut inner.drafts[draft];
        match setting {
            Ok(setting) => draft.give(keyword, &setting),
            Err(said) => draft.refuse(said),
        }
    }
}
