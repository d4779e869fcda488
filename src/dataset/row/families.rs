//! The three families of statements, each with its two directions: those of which there are many,
//! settings of the whole model, and those that are only kept.

use super::{Argument, Binding, Given, Problem, Record, Statement, near_ids};
use crate::dataset::statement::STATEMENTS;
use crate::dataset::value::Value;
use crate::diagnostic::{Cause, Span};
use crate::model::{
    self, ById, ElementKind, EquilibriumSettings, IntegratorSettings, Model, Place, Settings,
    SettingsStatement, Units,
};

/// Needs of the table of whatever a statement fills: elements and settings.
pub trait Element: Clone + Default + PartialEq {
    /// Line and name, for elements that have them.
    fn place(&self) -> Option<&Place>;
    /// The same, to be set.
    fn place_mut(&mut self) -> Option<&mut Place>;
    /// Keeps an argument that carries no mechanics.
    fn keep(&mut self, keyword: &str, text: String) {
        if let Some(place) = self.place_mut() {
            place.extra.retain(|(k, _)| k != keyword);
            place.extra.push((keyword.to_owned(), text));
        }
    }
    /// Returns the arguments that were kept.
    fn kept(&self) -> Vec<(String, String)> {
        self.place().map(|p| p.extra.clone()).unwrap_or_default()
    }
}

impl<T: model::Element + Clone + Default + PartialEq> Element for T {
    fn place(&self) -> Option<&Place> {
        Some(model::Element::place(self))
    }
    fn place_mut(&mut self) -> Option<&mut Place> {
        Some(model::Element::place_mut(self))
    }
}

impl Element for Settings {
    fn place(&self) -> Option<&Place> {
        None
    }
    fn place_mut(&mut self) -> Option<&mut Place> {
        None
    }
    fn keep(&mut self, keyword: &str, text: String) {
        self.words.insert(keyword.to_owned(), text);
    }
    // What the table of this statement does not list is written by `Single::records`.
    fn kept(&self) -> Vec<(String, String)> {
        let words = self.words.iter();
        words.map(|(k, w)| (k.clone(), w.clone())).collect()
    }
}

macro_rules! placeless {
    ($($type:ty),+) => { $(
        impl Element for $type {
            fn place(&self) -> Option<&Place> {
                None
            }
            fn place_mut(&mut self) -> Option<&mut Place> {
                None
            }
        }
    )+ };
}
placeless!(
    IntegratorSettings,
    EquilibriumSettings,
    Option<Units>,
    [f64; 3]
);

/// A kind of statement of which there are many, each with its number.
pub struct Numbered<T: 'static> {
    /// which
    pub kind: ElementKind,
    /// where they are kept
    pub list: fn(&Model) -> &ById<T>,
    /// the same, to be changed
    pub list_mut: fn(&mut Model) -> &mut ById<T>,
    /// its arguments
    pub bindings: &'static [Binding<T>],
    /// what concerns several arguments at once
    pub finish: fn(&mut T) -> Result<(), String>,
}

impl<T: Element> Statement for Numbered<T> {
    fn keyword(&self) -> &'static str {
        self.kind.keyword()
    }
    fn kind(&self) -> Option<ElementKind> {
        Some(self.kind)
    }
    fn open(&self) -> bool {
        false
    }
    fn argument(&self, k: usize) -> Option<&'static Argument> {
        self.bindings.get(k).map(|b| &b.argument)
    }

    fn enter(&self, model: &mut Model, record: &Record, change: bool) -> Vec<Problem> {
        let id = record.id.unwrap_or(0);
        let list = (self.list_mut)(model);
        let mut element = match (list.get(&id), change) {
            (Some(e), true) => e.clone(),
            (None, true) => {
                let mut p = Problem::new(
                    Cause::UnknownElement.code(),
                    format!("{} does not exist", record.element()),
                );
                p.help = near_ids(id, list.keys().copied());
                return vec![p];
            }
            (Some(e), false) => {
                let line = e.place().map_or(0, |p| p.line);
                let mut p = Problem::new("defined_twice", "is defined twice");
                p.help = (line > 0).then(|| format!("the first stands in line {line}"));
                return vec![p];
            }
            (None, false) => T::default(),
        };
        if let (false, Some(place)) = (change, element.place_mut()) {
            place.name.clone_from(&record.place.name);
        }
        let mut problems = apply(self.bindings, &mut element, record);
        if !change {
            if !record.mistaken {
                problems.extend(incomplete(self, record));
            }
            if let Some(place) = element.place_mut() {
                let extra = std::mem::take(&mut place.extra);
                *place = Place {
                    extra,
                    ..record.place.clone()
                };
            }
        }
        // what follows from what was given follows also where something else is wrong
        if let Err(message) = (self.finish)(&mut element)
            && problems.is_empty()
            && !record.mistaken
        {
            problems.push(Problem::new("contradiction", message));
        }
        // A new element with a mistake is entered all the same, so that nothing else seems to miss
        // it.
        if !change || problems.is_empty() {
            (self.list_mut)(model).insert(id, element);
        }
        problems
    }

    fn records(&self, model: &Model) -> Vec<Record> {
        let to_record = |(&id, e): (&u32, &T)| Record {
            row: row_of(self.kind.keyword()),
            id: Some(id),
            given: given(self.bindings, e),
            kept: e.kept(),
            place: e.place().cloned().unwrap_or_default(),
            head: Span::default(),
            mistaken: false,
        };
        (self.list)(model).iter().map(to_record).collect()
    }

    fn visit_values(&self, model: &Model, visit: &mut dyn FnMut(Option<u32>, usize, &Value)) {
        for (&id, element) in (self.list)(model) {
            let visit = |argument: usize, value: Value| visit(Some(id), argument, &value);
            visit_given(self.bindings, element, visit);
        }
    }
}

/// A statement without a number: settings of the whole model.
pub struct Single<T: 'static> {
    /// see [`Statement::keyword`]
    pub keyword: &'static str,
    /// what it sets; `None` when there is nothing to write
    pub value: fn(&Model) -> Option<T>,
    /// the same, to be changed
    pub value_mut: fn(&mut Model) -> &mut T,
    /// its arguments
    pub bindings: &'static [Binding<T>],
    /// which settings it keeps by keyword, and with them whatever no row describes; `None` for
    /// others
    pub settings: Option<SettingsStatement>,
    /// what concerns several arguments at once
    pub finish: fn(&mut T) -> Result<(), String>,
}

impl<T: Element> Statement for Single<T> {
    fn keyword(&self) -> &'static str {
        self.keyword
    }
    fn settings(&self) -> Option<SettingsStatement> {
        self.settings
    }
    fn is_idle(&self) -> bool {
        self.settings.is_some_and(SettingsStatement::is_idle)
    }
    fn open(&self) -> bool {
        self.settings.is_some()
    }
    fn argument(&self, k: usize) -> Option<&'static Argument> {
        self.bindings.get(k).map(|b| &b.argument)
    }

    fn enter(&self, model: &mut Model, record: &Record, _: bool) -> Vec<Problem> {
        let target = (self.value_mut)(model);
        let mut value = target.clone();
        let mut problems = apply(self.bindings, &mut value, record);
        if let Err(message) = (self.finish)(&mut value)
            && problems.is_empty()
            && !record.mistaken
        {
            problems.push(Problem::new("contradiction", message));
        }
        if problems.is_empty() {
            *target = value;
        }
        problems
    }

    fn reset(&self, model: &mut Model) {
        *(self.value_mut)(model) = T::default();
    }

    fn records(&self, model: &Model) -> Vec<Record> {
        let Some(value) = (self.value)(model) else {
            return Vec::new();
        };
        let given = given(self.bindings, &value);
        let listed = |k: &str| self.bindings.iter().any(|b| b.argument.keyword() == k);
        let mut kept = value.kept();
        kept.retain(|(k, _)| !listed(k));
        vec![Record {
            row: row_of(self.keyword),
            id: None,
            given,
            kept,
            place: Place::default(),
            head: Span::default(),
            mistaken: false,
        }]
    }

    fn visit_values(&self, model: &Model, visit: &mut dyn FnMut(Option<u32>, usize, &Value)) {
        if let Some(element) = (self.value)(model) {
            let visit = |argument: usize, value: Value| visit(None, argument, &value);
            visit_given(self.bindings, &element, visit);
        }
    }
}

/// A statement that is only kept, with whatever arguments it has.
pub struct Opaque {
    /// which
    pub kind: ElementKind,
}

impl Statement for Opaque {
    fn keyword(&self) -> &'static str {
        self.kind.keyword()
    }
    fn kind(&self) -> Option<ElementKind> {
        Some(self.kind)
    }
    fn open(&self) -> bool {
        true
    }
    fn is_idle(&self) -> bool {
        !self.kind.is_unsolved()
    }
    fn argument(&self, _: usize) -> Option<&'static Argument> {
        None
    }

    fn enter(&self, model: &mut Model, record: &Record, change: bool) -> Vec<Problem> {
        let id = self.kind.id(record.id.unwrap_or(0));
        let element = model.others.entry(id).or_default();
        if !change {
            element.place = record.place.clone();
        }
        for (keyword, text) in &record.kept {
            element.keep(keyword, text.clone());
        }
        Vec::new()
    }

    fn records(&self, model: &Model) -> Vec<Record> {
        let mine = model.others.range(self.kind.id(0)..=self.kind.id(u32::MAX));
        mine.map(|(id, e)| Record {
            row: row_of(self.kind.keyword()),
            id: Some(id.number),
            given: Vec::new(),
            kept: e.kept(),
            place: e.place.clone(),
            head: Span::default(),
            mistaken: false,
        })
        .collect()
    }
}

fn row_of(keyword: &'static str) -> &'static dyn Statement {
    let row = STATEMENTS.iter().find(|r| r.keyword() == keyword);
    *row.unwrap_or_else(|| unreachable!("records are made by rows of the table"))
}

/// Puts the arguments into an element: bare keywords first, for the meaning of others may depend on
/// them.
fn apply<T: Element>(
    bindings: &'static [Binding<T>],
    element: &mut T,
    record: &Record,
) -> Vec<Problem> {
    let mut problems = Vec::new();
    for flags in [true, false] {
        for (k, g) in record.given.iter().enumerate() {
            let Some(binding) = bindings.get(g.argument) else {
                continue;
            };
            if (g.value == Value::Flag) != flags {
                continue;
            }
            if let Err(message) = (binding.put)(element, binding.argument.name, g.value.clone()) {
                let mut p = Problem::new("unfit_value", message);
                p.given = Some(k);
                problems.push(p);
            }
        }
    }
    for (keyword, text) in &record.kept {
        element.keep(keyword, text.clone());
    }
    problems
}

/// Returns what the arguments of a record fill.
pub fn filled<T: Default>(bindings: &'static [Binding<T>], record: &Record) -> T {
    let mut filled = T::default();
    for g in &record.given {
        if let Some(b) = bindings.get(g.argument) {
            // the reader has checked that the value is of the kind that the argument accepts
            let done = (b.put)(&mut filled, b.argument.name, g.value.clone());
            debug_assert!(done.is_ok(), "{}: {done:?}", b.argument.name);
        }
    }
    filled
}

/// Returns the required arguments that a new element misses.
fn incomplete(row: &dyn Statement, record: &Record) -> Vec<Problem> {
    let arguments = || (0..).map_while(|k| row.argument(k)).enumerate();
    let mut problems = Vec::new();
    let has = |k: usize| record.given.iter().any(|g| g.argument == k);
    let mut groups_seen: Vec<&str> = Vec::new();
    for (k, argument) in arguments() {
        match argument.group {
            None if argument.required && !has(k) => problems.push(Problem::new(
                "missing_argument",
                format!(
                    "needs {} = {}",
                    argument.keyword(),
                    argument.kind.describe()
                ),
            )),
            Some(group) if argument.required && !groups_seen.contains(&group) => {
                groups_seen.push(group);
                let members = || arguments().filter(|(_, m)| m.group == Some(group));
                if !members().any(|(m, _)| has(m)) {
                    let words: Vec<String> = members().map(|(_, m)| m.keyword()).collect();
                    problems.push(Problem::new(
                        "missing_argument",
                        format!("does not say its {group}: one of {}", words.join(", ")),
                    ));
                }
            }
            _ => {}
        }
    }
    problems
}

/// The arguments to write for an element.
fn given<T>(bindings: &'static [Binding<T>], element: &T) -> Vec<Given> {
    let mut all = Vec::new();
    visit_given(bindings, element, |argument, value| {
        all.push(Given {
            argument,
            value,
            span: Span::default(),
        });
    });
    all
}

/// Visits the arguments to write for an element: their places in the row, and their values.
fn visit_given<T>(
    bindings: &'static [Binding<T>],
    element: &T,
    mut visit: impl FnMut(usize, Value),
) {
    for (argument, b) in bindings.iter().enumerate() {
        for value in (b.get)(element, b.argument.name) {
            visit(argument, value);
        }
    }
}
