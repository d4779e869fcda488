//! Datasets (`.adm`): text ⇄ Model.
//!
//! ```text
//! bytes → Source → Syntax (statements, comments, tokens) → Records (rows of the table) → Model
//! ```
//!
//! [`Dataset`] keeps the first four, so that a file can be written again with its comments and its
//! order; the Model says what it means. The table of statements (`statement.rs`) is the only place
//! that knows arguments by name.

mod check;
mod clock;
pub mod command;
mod edit;
mod extension;
mod frequent;
mod idle;
mod include;
pub(crate) mod lens;
pub(crate) mod manual;
pub(crate) mod mesh;
mod overlooked;
mod places;
pub(crate) mod read;
pub(crate) mod row;
pub(crate) mod statement;
pub(crate) mod surface;
pub(crate) mod syntax;
pub(crate) mod value;
mod view;
pub(crate) mod write;

pub use syntax::{Encoding, Source};

use crate::arrange::Arrange;
use crate::diagnostic::{Cause, Diagnostic, Error, Severity, Span};
use crate::disk;
use crate::model::{ElementKind, MarkerOwner, Model};
use idle::Idle;
use places::Places;
use read::Table;
use row::{Given, Record};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use syntax::{Item, Syntax};

/// The statements of a dataset.
pub const TABLE: Table = Table {
    rows: statement::STATEMENTS,
    find: statement::find,
};

/// A dataset as written: text, comments, statements in order.
#[derive(Clone, Debug, Default)]
pub struct Dataset {
    /// text and file name
    pub source: Source,
    /// comments and statements, by tokens
    pub syntax: Syntax,
    /// one for each item: the statement as read, where its head could be understood
    pub records: Vec<Option<Record>>,
    places: Places,
}

impl Dataset {
    /// Adds the place of an element's statement to what is said about it; leaves it unchanged where
    /// that is not known, or a place has been given.
    pub fn locate(&self, d: Diagnostic) -> Diagnostic {
        let (None, Some(element)) = (&d.file, &d.element) else {
            return d;
        };
        match self.places.statement(&self.records, element) {
            Some(record) => Diagnostic {
                name: record.place.name.clone(),
                ..self.source.locate(d, record.head)
            },
            None => d,
        }
    }

    /// The statements that could not be understood, or not all of them.
    pub fn mistaken(&self) -> Vec<Span> {
        let all = self.syntax.items.iter().zip(&self.records);
        let wrong = all.filter(|(item, record)| match (item, record) {
            (Item::Comment(_), _) => false,
            (Item::Statement(_), record) => record.as_ref().is_none_or(|r| r.mistaken),
        });
        wrong.map(|(item, _)| item.span()).collect()
    }
}

/// The outcome of reading a dataset: always everything that could be understood, with all that was
/// found wrong.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// the file as written
    pub dataset: Dataset,
    /// what it means
    pub model: Model,
    /// errors, warnings and notes in the order of the file
    pub diagnostics: Vec<Diagnostic>,
    /// what a command file of Adams View asks the solver for, as commands of it
    pub commands: Option<String>,
    /// design variables of a command file of Adams View that are numbers, by their full names
    pub variables: BTreeMap<String, f64>,
}

impl Reading {
    /// Returns whether it was read from a command file of Adams View.
    pub fn is_view(&self) -> bool {
        is_view(&self.dataset.source)
    }

    /// Returns true if there is any error.
    pub fn failed(&self) -> bool {
        self.diagnostics
            .iter()
            .any(|d| d.severity == Severity::Error)
    }
}

/// Reads a dataset from a file.
///
/// # Errors
/// Only when the file cannot be opened; everything else is in [`Reading::diagnostics`].
pub fn read(path: impl AsRef<Path>) -> Result<Reading, Error> {
    open(path).map(read_source)
}

/// Opens a dataset: its text, not yet read.
///
/// # Errors
/// When the file cannot be opened.
pub fn open(path: impl AsRef<Path>) -> Result<Source, Error> {
    let path = path.as_ref();
    let file = disk::text(&path);
    Ok(Source::from_bytes(Some(&file), &load(path)?))
}

/// Returns whether a text is a command file of Adams View, by the name of its file.
pub fn is_view(source: &Source) -> bool {
    view::is_view(source.file.as_deref())
}

/// Reads a dataset from a text.
pub fn read_text(text: &str) -> Reading {
    read_source(Source::from_text(None, text))
}

/// The bytes of a file, which are a text.
fn load(path: &Path) -> Result<Vec<u8>, Error> {
    let bytes = disk::read(path).map_err(|e| {
        let mut d = Diagnostic::error("cannot_open", format!("cannot be opened: {e}"));
        d.file = Some(disk::text(&path));
        Error::from(d).with_source(e)
    })?;
    if !syntax::is_no_text(&bytes) {
        return Ok(bytes);
    }
    let mut d = Diagnostic::error("no_text", "is no text: too many bytes are no characters");
    d.file = Some(disk::text(&path));
    Err(Error::from(d.help(
        "datasets, command files and logs are lines of text; what a program keeps in a format of its \
         own it exports",
    )))
}

/// Reads a dataset, or by its name (`.cmd`) a command file of Adams View.
pub fn read_source(source: Source) -> Reading {
    read_with(source, &BTreeMap::new())
}

/// Does the same; `variables`: values that design variables of a command file of Adams View have
/// instead of those of the file, by their full names (`.model.DV_1`). Whatever depends on them is
/// computed anew.
pub fn read_with(source: Source, variables: &BTreeMap<String, f64>) -> Reading {
    match is_view(&source) {
        true => view::read(source, variables),
        false => read_dataset(source),
    }
}

fn read_dataset(source: Source) -> Reading {
    let mut mistakes = Vec::new();
    let (source, is_whole) = include::expanded(source, &mut mistakes);
    let mut reading = read_alone(source);
    if !is_whole {
        // what is not there may be in a file that was not included
        reading.diagnostics.retain(|d| !d.is(Cause::UnknownElement));
    }
    reading.diagnostics.splice(0..0, mistakes);
    reading
}

/// Reads a dataset without the files that it includes: to write it again as it stands.
pub fn read_alone(source: Source) -> Reading {
    let mut reading = Reading::default();
    let out = &mut reading.diagnostics;
    let syntax = syntax::dataset(&source, out);
    reading.model.title = source.slice(syntax.title).to_owned();
    check_title(&source, &syntax, out);
    let mut records = Vec::with_capacity(syntax.items.len());
    let mut last_part = None;
    let mut mistaken = BTreeSet::new();
    let mut not_understood = Vec::new();
    for item in &syntax.items {
        let record = match item {
            Item::Comment(_) => None,
            Item::Statement(tokens) => {
                let record = read::record(&source, tokens, TABLE, out);
                let guess = || read::meant(&source, tokens, TABLE);
                not_understood.extend(record.is_none().then(guess).flatten());
                record
            }
        };
        if let Some(record) = &record {
            if record.mistaken {
                mistaken.insert(record.element());
            }
            enter(&source, &mut reading.model, record, false, out);
            if record.row.kind() == Some(ElementKind::Part) {
                last_part = record.id;
            }
            adopt_marker(&source, &mut reading.model, record, last_part, out);
            out.extend(overlooked::two_orientations(&source, record));
        }
        records.push(record);
    }
    if syntax.end.is_none() && !source.text.trim().is_empty() {
        let at = source.text.trim_end().len();
        let d = Diagnostic::warning("missing_end", "the dataset does not end with END");
        out.push(source.locate(d, Span::new(at, at)));
    }
    out.extend(overlooked::after_end(&source, syntax.after));
    out.extend(overlooked::given_again(&source, &records));
    out.extend(overlooked::foreign(&source, &records));
    extension::read(&source, &syntax, &mut reading.model, out);
    let mistaken = reading.model.with_readers_of_data(mistaken);
    let places = Places::default();
    for d in contradictions(&reading.model, &not_understood) {
        // what seems to be missing may be what was not understood
        let excused = d.element.as_ref().is_some_and(|e| mistaken.contains(e));
        if excused && !d.is(Cause::UnknownElement) {
            continue;
        }
        let element = d.element.as_ref();
        let record = element.and_then(|e| places.statement(&records, e));
        if let Some(given) = record.and_then(|record| argument_of(record, &d)) {
            out.push(source.locate(d, given));
            continue;
        }
        match record.filter(|r| r.id.is_none() && d.line == 0) {
            Some(record) => out.push(source.locate(d, record.head)),
            None => out.push(source.located_in_file_of(record.map_or(0, |r| r.head.start), d)),
        }
    }
    let mut without_effect = Idle::default();
    records.iter().flatten().for_each(|r| without_effect.add(r));
    out.extend(without_effect.told(&source));
    name_elements(&records, out);
    // what is missing as a whole follows from mistakes that have a place
    let own = source.file.clone();
    out.arrange_by_key(|d| {
        let other = d.file.clone().filter(|_| d.file != own);
        (d.line == 0, other, d.line, d.column)
    });
    reading.dataset = Dataset {
        source,
        syntax,
        records,
        places,
    };
    reading
}

/// Returns what contradicts itself in a model, whatever the statements say of which nothing but
/// their element is understood: both without these elements and with them.
fn contradictions(model: &Model, not_understood: &[Record]) -> Vec<Diagnostic> {
    let mut found = model.contradictions();
    if not_understood.is_empty() {
        return found;
    }
    let mut whole = model.clone();
    for record in not_understood {
        // of two with one number the one that was read stands
        record.row.enter(&mut whole, record, false);
    }
    // a part of them may be the ground
    let part = |r: &Record| r.id.filter(|_| r.row.kind() == Some(ElementKind::Part));
    if whole.parts.values().all(|p| !p.ground)
        && let Some(id) = not_understood.iter().find_map(part)
        && let Some(ground) = whole.parts.get_mut(&id)
    {
        ground.ground = true;
    }
    let with = whole.contradictions();
    found.retain(|d| with.contains(d));
    found
}

/// The place of the argument that a finding is about, if it stands in its element's statement.
fn argument_of(record: &Record, d: &Diagnostic) -> Option<Span> {
    let argument = d.argument?;
    let mut given = record.given.iter();
    let is_meant = |g: &&Given| {
        let known = record.row.argument(g.argument);
        known.is_some_and(|a| a.keyword() == argument)
    };
    given.find(is_meant).map(|g| g.span)
}

/// Gives the elements that diagnostics are about the names that stand above their statements.
fn name_elements(records: &[Option<Record>], out: &mut [Diagnostic]) {
    if out.is_empty() {
        return;
    }
    let named = records.iter().flatten().filter(|r| r.place.name.is_some());
    let names: BTreeMap<String, &Record> = named.map(|r| (r.element(), r)).collect();
    for d in out.iter_mut().filter(|d| d.name.is_none()) {
        let record = d.element.as_ref().and_then(|e| names.get(e));
        d.name = record.and_then(|r| r.place.name.clone());
    }
}

/// The first line is a title, whatever it holds: one that holds a statement is a mistake, for the
/// statement is lost.
fn check_title(source: &Source, syntax: &Syntax, out: &mut Vec<Diagnostic>) {
    let title = source.slice(syntax.title);
    let head = title
        .trim_start()
        .split(['/', ' ', ','])
        .next()
        .unwrap_or_default();
    let after = title.trim_start().get(head.len()..).unwrap_or_default();
    let is_written = after.strip_prefix('/').is_some_and(|rest| {
        let numbered = rest.trim_start().starts_with(|c: char| c.is_ascii_digit());
        numbered || rest.contains('=')
    });
    if is_written && statement::find(head) != row::Meaning::Unknown {
        let d = Diagnostic::error(
            "statement_as_title",
            format!("the first line is the title: {head} there is not read"),
        );
        let d = d.help("put a line with a title above it");
        out.push(source.locate(d, syntax.title));
    }
}

/// Puts a record into a model and reports what is wrong with it.
pub(crate) fn enter(
    source: &Source,
    model: &mut Model,
    record: &Record,
    change: bool,
    out: &mut Vec<Diagnostic>,
) {
    for p in record.row.enter(model, record, change) {
        let span = p
            .given
            .and_then(|k| record.given.get(k))
            .map_or(record.head, |g| g.span);
        let mut d = Diagnostic::error(p.code, p.message).element(record.element());
        d.help.extend(p.help);
        out.push(source.locate(d, span));
    }
}

/// A marker that names no owner belongs to the part before it.
fn adopt_marker(
    source: &Source,
    model: &mut Model,
    record: &Record,
    part: Option<u32>,
    out: &mut Vec<Diagnostic>,
) {
    if record.row.kind() != Some(ElementKind::Marker) {
        return;
    }
    let Some(marker) = record.id.and_then(|id| model.markers.get_mut(&id)) else {
        return;
    };
    if marker.owner != MarkerOwner::Part(0) {
        return;
    }
    let d = match part {
        Some(part) => {
            marker.owner = MarkerOwner::Part(part);
            Diagnostic::warning(
                "marker_without_part",
                format!(
                    "no PART is named; {}, the last before it, is taken",
                    ElementKind::Part.id(part)
                ),
            )
        }
        None => Diagnostic::error(
            "missing_argument",
            "no PART is named, and none stands before it",
        ),
    };
    out.push(source.locate(d.element(record.element()), record.head));
}

impl Model {
    /// Reads a dataset; all mistakes at once.
    ///
    /// # Errors Every mistake with its place and advice; printing the error prints them all.
    /// Warnings alone are no error: see [`read()`] for them.
    pub fn read(path: impl AsRef<Path>) -> Result<Model, Error> {
        into_model(read(path)?)
    }

    /// The same from a text.
    ///
    /// # Errors
    /// As [`Model::read`].
    ///
    /// # Examples
    /// ```
    /// use cognate::model::Model;
    /// let model = Model::from_text("a falling ball\nPART/1, GROUND\nPART/2, MASS=1, CM=2\nMARKER/2, PART=2\nEND\n")?;
    /// assert_eq!(model.parts[&2].mass, 1.0);
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn from_text(text: &str) -> Result<Model, Error> {
        into_model(read_text(text))
    }
}

fn into_model(reading: Reading) -> Result<Model, Error> {
    if reading.failed() {
        let mut all = reading.diagnostics;
        all.retain(|d| d.severity == Severity::Error);
        return Err(all.into());
    }
    Ok(reading.model)
}
