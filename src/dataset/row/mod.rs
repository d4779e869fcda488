//! Rows of the table of statements, and the two directions that they serve: from a record into the
//! Model and back.
//!
//! A [`Record`] is a statement read but not yet believed: which row, which number, which arguments
//! with their values. The rows themselves stand in `statement.rs`.
//!
//! ```text
//! families     the three families of statements: numbered, single, opaque
//! keyword      what a word of a file means among the names of a table
//! plain        fields whose type says how an argument fills them, and two whose type does not
//! ```

mod families;
mod keyword;
mod plain;

pub use families::{Element, Numbered, Opaque, Single, filled};
pub(super) use keyword::meaning_among;
pub use keyword::{Meaning, canonical, meaning, near_ids};
pub use plain::{Angle, Lens, Plain, Routine};

use super::value::{Kind, Value};
use crate::diagnostic::Span;
use crate::model::{ElementKind, Model, Place, SettingsStatement};
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
    /// numbers that it may have
    pub range: Range,
}

/// Numbers that an argument may have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Range {
    /// all
    #[default]
    All,
    /// those above zero
    Positive,
    /// those from zero on
    FromZero,
}

impl Range {
    /// Says what is wrong with a number that is not among these.
    fn misses(self, x: f64) -> Option<&'static str> {
        match self {
            Range::All => None,
            Range::Positive => (x.is_nan() || x <= 0.0).then_some("must be positive"),
            Range::FromZero => (x.is_nan() || x < 0.0).then_some("must not be negative"),
        }
    }
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
            range: Range::All,
        }
    }

    /// Checks that a value is in its range.
    ///
    /// # Errors
    /// A sentence that says what it must be.
    pub fn admits(&self, value: &Value) -> Result<(), String> {
        let number = match value {
            Value::Real(x) => x.value(),
            Value::Id(n) => f64::from(*n),
            _ => return Ok(()),
        };
        match self.range.misses(number) {
            None => Ok(()),
            Some(must) => Err(format!("{} {must}, not {number}", self.keyword())),
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
    /// Its number is above zero.
    pub const fn positive(mut self) -> Self {
        self.argument.range = Range::Positive;
        self
    }
    /// Its number is zero or more.
    pub const fn from_zero(mut self) -> Self {
        self.argument.range = Range::FromZero;
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
    /// One of its arguments; `None` beyond the last.
    fn argument(&self, k: usize) -> Option<&'static Argument>;
    /// Its arguments.
    fn arguments(&self) -> Vec<Argument> {
        (0..).map_while(|k| self.argument(k).copied()).collect()
    }
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
    /// Calls `visit` with the number of an element, an argument's place in the row and its value,
    /// for all that [`Statement::records`] would give: nothing else of a record is made.
    /// Statements without elements, or whose elements are only kept, have none.
    fn visit_values(&self, _: &Model, _: &mut dyn FnMut(Option<u32>, usize, &Value)) {}
}
