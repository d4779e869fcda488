//! Rows of the table of statements, and the two directions that they serve: from a record into the
//! Model and back.
//!
//! A [`Record`] is a statement read but not yet believed: which row, which number, which arguments
//! with their values. The rows themselves stand in `statement.rs`.

use super::value::{Field, Kind, Value};
use crate::diagnostic::{Cause, Span, near_names};
use crate::model::{
    self, ById, ElementKind, EquilibriumSettings, Formula, IntegratorSettings, Model, Place,
    Settings, SettingsStatement, Units,
};
use std::fmt::Debug;

/// An argument of a statement, whatever field it fills.
#[derive(Clone, Copy, Debug)]
pub struct Argument {
    /// Full keyword; the capitals at its beginning are the shortest form that wins against longer
    /// keywords that begin alike (`Comment` is meant by `C`). Other spellings follow after `|`.
    pub name: &'static str,
    /// what it accepts
    pub kind: Kind,
    /// the statement is incomplete without it
    pub required: bool,
    /// it may be given several times
    pub repeated: bool,
    /// bare keywords of one group exclude each other
    pub group: Option<&'static str>,
    /// it is accepted and changes nothing, which is said
    pub idle: bool,
}

impl Argument {
    /// An optional argument.
    pub const fn new(name: &'static str, kind: Kind) -> Self {
        Self {
            name,
            kind,
            required: false,
            repeated: false,
            group: None,
            idle: false,
        }
    }

    /// The keyword in capitals.
    pub fn keyword(&self) -> String {
        canonical(self.name)
    }
}

/// An argument bound to a field of `T`.
pub struct Binding<T: 'static> {
    /// name and kind
    pub argument: Argument,
    /// fills the field; the second parameter is the keyword
    pub put: fn(&mut T, &'static str, Value) -> Result<(), String>,
    /// the values to write, none for what is absent or default
    pub get: fn(&T, &'static str) -> Vec<Value>,
}

impl<T> Clone for Binding<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Binding<T> {}

impl<T> Binding<T> {
    /// The statement is incomplete without it.
    pub const fn required(mut self) -> Self {
        self.argument.required = true;
        self
    }
    /// It may be given several times.
    pub const fn repeated(mut self) -> Self {
        self.argument.repeated = true;
        self
    }
    /// It is accepted and changes nothing, which is said.
    pub const fn idle(mut self) -> Self {
        self.argument.idle = true;
        self
    }
    /// It excludes the other keywords of this group.
    pub const fn group(mut self, group: &'static str) -> Self {
        self.argument.group = Some(group);
        self
    }
}

/// A value of an argument, with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Given {
    /// index of the argument in its row
    pub argument: usize,
    /// its value
    pub value: Value,
    /// from the keyword to the end of the value
    pub span: Span,
}

/// A statement as read: row, number, arguments in the order written.
#[derive(Clone)]
pub struct Record {
    /// the row of the table
    pub row: &'static dyn Statement,
    /// number of the element
    pub id: Option<u32>,
    /// arguments the row knows
    pub given: Vec<Given>,
    /// others, where the row keeps whatever it meets: keyword, text (empty for a bare keyword)
    pub kept: Vec<(String, String)>,
    /// line and name
    pub place: Place,
    /// of the head, `JOINT/3`
    pub head: Span,
    /// some of it could not be understood, and is missing here
    pub mistaken: bool,
}

impl Record {
    /// `JOINT/3`, `UNITS`
    pub fn element(&self) -> String {
        element_name(&canonical(self.row.keyword()), self.id)
    }
}

impl Debug for Record {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {:?} {:?}", self.element(), self.given, self.kept)
    }
}

/// `JOINT/3`, `UNITS`
pub fn element_name(keyword: &str, id: Option<u32>) -> String {
    match id {
        Some(id) => format!("{keyword}/{id}"),
        None => keyword.to_owned(),
    }
}

/// Something wrong with a record.
#[derive(Clone, Debug)]
pub struct Problem {
    /// index in `given`; the head of the statement when absent
    pub given: Option<usize>,
    /// stable code
    pub code: &'static str,
    /// one sentence
    pub message: String,
    /// advice
    pub help: Option<String>,
}

impl Problem {
    fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self {
            given: None,
            code,
            message: message.into(),
            help: None,
        }
    }
}

/// A row of the table of statements.
pub trait Statement: Sync {
    /// Full keyword, written like [`Argument::name`].
    fn keyword(&self) -> &'static str;
    /// The kind of element it makes; `None` for statements without a number.
    fn kind(&self) -> Option<ElementKind> {
        None
    }
    /// Returns true if each has a number.
    fn numbered(&self) -> bool {
        self.kind().is_some()
    }
    /// Returns true if arguments that no row describes are kept rather than refused.
    fn open(&self) -> bool;
    /// Its arguments.
    fn arguments(&self) -> Vec<Argument>;
    /// Puts a record into the model: a new element, or (`change`) new values for arguments of one
    /// that is there.
    fn enter(&self, model: &mut Model, record: &Record, change: bool) -> Vec<Problem>;
    /// Which settings it keeps by keyword; `None` for other statements.
    fn settings(&self) -> Option<SettingsStatement> {
        None
    }
    /// Returns true if arguments that no row describes have a meaning all the same.
    fn reads_others(&self) -> bool {
        false
    }
    /// Returns true if it is accepted and does nothing, whatever its arguments are.
    fn is_idle(&self) -> bool {
        false
    }
    /// Sets what a statement without a number sets back to what holds without it.
    fn reset(&self, _: &mut Model) {}
    /// All elements of this kind as records, for writing.
    fn records(&self, model: &Model) -> Vec<Record>;
}

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
    fn arguments(&self) -> Vec<Argument> {
        self.bindings.iter().map(|b| b.argument).collect()
    }

    fn enter(&self, model: &mut Model, record: &Record, change: bool) -> Vec<Problem> {
        let name = record.element();
        let id = record.id.unwrap_or(0);
        let list = (self.list_mut)(model);
        let mut element = match (list.get(&id), change) {
            (Some(e), true) => e.clone(),
            (None, true) => {
                let mut p = Problem::new(
                    Cause::UnknownElement.code(),
                    format!("{name} does not exist"),
                );
                p.help = near_ids(id, list.keys().copied());
                return vec![p];
            }
            (Some(e), false) => {
                let line = e.place().map_or(0, |p| p.line);
                let mut p = Problem::new("defined_twice", format!("{name} is defined twice"));
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
                problems.extend(incomplete(self.bindings, record, &name));
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
    fn arguments(&self) -> Vec<Argument> {
        self.bindings.iter().map(|b| b.argument).collect()
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
    fn arguments(&self) -> Vec<Argument> {
        Vec::new()
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
    let row = super::statement::STATEMENTS
        .iter()
        .find(|r| r.keyword() == keyword);
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
fn incomplete<T>(bindings: &'static [Binding<T>], record: &Record, name: &str) -> Vec<Problem> {
    let mut problems = Vec::new();
    let has = |k: usize| record.given.iter().any(|g| g.argument == k);
    let mut groups_seen: Vec<&str> = Vec::new();
    for (k, b) in bindings.iter().enumerate() {
        match b.argument.group {
            None if b.argument.required && !has(k) => problems.push(Problem::new(
                "missing_argument",
                format!(
                    "{name} needs {} = {}",
                    b.argument.keyword(),
                    b.argument.kind.describe()
                ),
            )),
            Some(group) if b.argument.required && !groups_seen.contains(&group) => {
                groups_seen.push(group);
                let members = bindings.iter().enumerate();
                let members: Vec<_> = members
                    .filter(|(_, m)| m.argument.group == Some(group))
                    .collect();
                if !members.iter().any(|(m, _)| has(*m)) {
                    let words: Vec<String> =
                        members.iter().map(|(_, m)| m.argument.keyword()).collect();
                    problems.push(Problem::new(
                        "missing_argument",
                        format!(
                            "{name} does not say its {group}: one of {}",
                            words.join(", ")
                        ),
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
    for (argument, b) in bindings.iter().enumerate() {
        for value in (b.get)(element, b.argument.name) {
            all.push(Given {
                argument,
                value,
                span: Span::default(),
            });
        }
    }
    all
}

/// "did you mean 12 or 121" for a number that is not among those known.
pub fn near_ids(id: u32, known: impl Iterator<Item = u32>) -> Option<String> {
    let known: Vec<String> = known.map(|k| k.to_string()).collect();
    let near = near_names(&id.to_string(), known.iter().map(String::as_str));
    (!near.is_empty()).then(|| format!("did you mean {}?", near.join(" or ")))
}

/// The first spelling of a name of the table, in capitals.
pub fn canonical(name: &str) -> String {
    name.split('|').next().unwrap_or(name).to_ascii_uppercase()
}

/// The meaning of a word of a file among the names of the table.
#[derive(Clone, Debug, PartialEq)]
pub enum Meaning {
    /// this one
    One(usize),
    /// an abbreviation of several
    Several(Vec<usize>),
    /// none
    Unknown,
}

/// Which of the names a word means: itself, else the only one it begins, else the first whose
/// shortest form it has.
pub fn meaning<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> Meaning {
    let word = word.as_bytes();
    let mut begins = Vec::new();
    let mut wins = None;
    for (k, name) in names.enumerate() {
        for spelling in name.split('|').map(str::as_bytes) {
            if spelling.eq_ignore_ascii_case(word) {
                return Meaning::One(k);
            }
            let Some(beginning) = spelling.get(..word.len()) else {
                continue;
            };
            if beginning.eq_ignore_ascii_case(word) && !word.is_empty() {
                if begins.last() != Some(&k) {
                    begins.push(k);
                }
                let capitals = spelling
                    .iter()
                    .take_while(|b| !b.is_ascii_lowercase())
                    .count();
                if capitals < spelling.len() && word.len() >= capitals {
                    wins = wins.or(Some(k));
                }
            }
        }
    }
    match (begins.as_slice(), wins) {
        ([one], _) => Meaning::One(*one),
        ([], _) => Meaning::Unknown,
        (_, Some(k)) => Meaning::One(k),
        _ => Meaning::Several(begins),
    }
}

/// The place of one kind of argument in a field whose type alone does not say it.
pub trait Lens<F> {
    /// what the argument accepts
    const KIND: Kind;
    /// fills the field
    fn put(field: &mut F, value: Value) -> Result<(), String>;
    /// the value to write
    fn get(field: &F) -> Option<Value>;
}

/// The field as its type says.
pub struct Plain;

impl<F: Field> Lens<F> for Plain {
    const KIND: Kind = F::KIND;
    fn put(field: &mut F, value: Value) -> Result<(), String> {
        field.put(value)
    }
    fn get(field: &F) -> Option<Value> {
        field.written()
    }
}

/// The same numbers, as angles.
pub struct Angle;

impl<F: Field> Lens<F> for Angle {
    const KIND: Kind = match F::KIND {
        Kind::Reals { min, max, .. } => Kind::Reals {
            min,
            max,
            angle: true,
        },
        Kind::Real { .. } => Kind::Real { angle: true },
        other => other,
    };
    fn put(field: &mut F, value: Value) -> Result<(), String> {
        field.put(value)
    }
    fn get(field: &F) -> Option<Value> {
        Some(match field.written()? {
            Value::Real(x) => Value::Real(super::value::Number::angle(x.literal)),
            Value::Reals(xs) => {
                super::value::angles(&xs.iter().map(|x| x.literal).collect::<Vec<_>>())
            }
            other => other,
        })
    }
}

/// ROUTINE of a FUNCTION=USER(…).
pub struct Routine;

impl Lens<Formula> for Routine {
    const KIND: Kind = Kind::Text;
    fn put(field: &mut Formula, value: Value) -> Result<(), String> {
        let Value::Text(name) = value else {
            return Err("ROUTINE takes library::entry".into());
        };
        match field {
            Formula::User { routine, .. } => *routine = Some(name),
            Formula::Expression { text, .. } if text.is_empty() => {
                *field = Formula::User {
                    constants: Vec::new(),
                    routine: Some(name),
                }
            }
            Formula::Expression { .. } => return Err("ROUTINE goes with FUNCTION=USER(…)".into()),
        }
        Ok(())
    }
    fn get(field: &Formula) -> Option<Value> {
        match field {
            Formula::User { routine, .. } => routine.clone().map(Value::Text),
            Formula::Expression { .. } => None,
        }
    }
}

impl Lens<Option<Formula>> for Routine {
    const KIND: Kind = Kind::Text;
    fn put(field: &mut Option<Formula>, value: Value) -> Result<(), String> {
        <Routine as Lens<Formula>>::put(field.get_or_insert_default(), value)
    }
    fn get(field: &Option<Formula>) -> Option<Value> {
        field.as_ref().and_then(<Routine as Lens<Formula>>::get)
    }
}
