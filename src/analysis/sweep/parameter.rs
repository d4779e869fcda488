//! Parameters of a sweep: numbers of the model by their names, through the table of statements.

use crate::dataset::command::Command;
use crate::dataset::row::{
    Argument, Given, Meaning, Record, Statement, canonical, meaning, near_ids,
};
use crate::dataset::statement::{self, STATEMENTS};
use crate::dataset::value::{Kind, Number, Value};
use crate::diagnostic::{Cause, Diagnostic, Error, Span, counted, near_names};
use crate::model::{ElementId, ElementKind, Formula, Model, Place};

/// A number of the model that a sweep sets.
///
/// | name | is |
/// |---|---|
/// | `PART/2.MASS` | an argument of a statement with a number |
/// | `MARKER/21.QP(1)` | the first number of an argument that is a list |
/// | `ACCGRAV.JGRAV` | an argument of a statement without a number |
/// | `VARIABLE/3` | its FUNCTION, which becomes the number; of any statement that has one |
/// | `slider.MASS`, `slider.cm.QP(1)`, `gain` | the same by the name of the element |
///
/// Keywords may be abbreviated as in datasets. Numbers are in the units of the model, angles in
/// radians.
#[derive(Clone)]
pub struct Parameter {
    row: &'static dyn Statement,
    id: Option<u32>,
    /// index of the argument in its row
    argument: usize,
    kind: Kind,
    /// place in a list, from 0
    place: Option<usize>,
    name: String,
}

/// Makes the error of a name.
fn wrong(code: impl Into<&'static str>, name: &str, what: String) -> Diagnostic {
    Diagnostic::error(code, format!("`{name}`: {what}"))
}

/// Adds near names as advice.
fn with_near(d: Diagnostic, word: &str, known: &[String]) -> Diagnostic {
    let near = near_names(word, known.iter().map(String::as_str));
    match near.is_empty() {
        true => d,
        false => d.help(format!("did you mean {}?", near.join(" or "))),
    }
}

impl Parameter {
    /// Finds a number of a model by its name.
    ///
    /// # Errors
    /// Names of statements, elements and arguments that do not exist, with near names; arguments
    /// that hold no number or change nothing.
    pub fn new(model: &Model, name: &str) -> Result<Self, Error> {
        let name = name.trim();
        let placed = |error: Error| error.map(|d| d.at(name, Span::new(0, name.len())));
        Self::named(model, name).map_err(placed)
    }

    /// Stands for a design variable, which is set where the model is read.
    pub(super) fn of_design(name: &str) -> Self {
        Self {
            row: STATEMENTS[0],
            id: None,
            argument: usize::MAX,
            kind: Kind::Real { angle: false },
            place: None,
            name: name.to_owned(),
        }
    }

    fn named(model: &Model, name: &str) -> Result<Self, Error> {
        let (row, id, argument) = element(model, name)?;
        let arguments = row.arguments();
        let (argument, place) = match argument {
            Some(text) => listed(name, text)?,
            None => ("FUNCTION", None),
        };
        let index = found(row, name, &arguments, argument)?;
        let (kind, keyword) = (arguments[index].kind, arguments[index].keyword());
        if arguments[index].idle || row.is_idle() {
            let d = wrong("no_effect", name, format!("{keyword} changes nothing"));
            return Err(d.into());
        }
        let is_list = matches!(kind, Kind::Reals { .. });
        let is_number = matches!(kind, Kind::Real { .. } | Kind::Formula) || is_list;
        if !is_number || is_list != place.is_some() {
            let takes = kind.describe();
            let d = wrong("bad_sweep", name, format!("{keyword} takes {takes}"));
            return Err(match is_list {
                true => d.help(format!("{keyword}(1) is the first of them")).into(),
                false => d.help("a sweep sets numbers and functions").into(),
            });
        }
        let head = match id {
            Some(id) => format!("{}/{id}", canonical(row.keyword())),
            None => canonical(row.keyword()),
        };
        let shown = match (keyword.as_str(), place) {
            ("FUNCTION", _) => head,
            (keyword, None) => format!("{head}.{keyword}"),
            (keyword, Some(k)) => format!("{head}.{keyword}({})", k + 1),
        };
        let parameter = Self {
            row,
            id,
            argument: index,
            kind,
            place,
            name: shown,
        };
        if place.is_some() {
            parameter.value(model, 0.0)?;
        }
        Ok(parameter)
    }

    /// The name, in full.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the element that it changes; `None`: a setting, or all of a kind.
    pub fn changed(&self) -> Option<ElementId> {
        let (kind, id) = self.element();
        Some(kind?.id(id?))
    }

    /// The kind and number of the element.
    pub(super) fn element(&self) -> (Option<ElementKind>, Option<u32>) {
        (self.row.kind(), self.id)
    }

    /// Returns whether both are the same number.
    pub(super) fn is(&self, other: &Self) -> bool {
        self.name == other.name
    }

    /// Returns whether a command changes this number.
    pub(super) fn is_changed_by(&self, record: &Record) -> bool {
        let same = record.row.keyword() == self.row.keyword() && record.id == self.id;
        same && record.given.iter().any(|g| g.argument == self.argument)
    }

    /// Sets the number in a model.
    ///
    /// # Errors
    /// A list that is shorter, and what the statement refuses.
    pub fn set(&self, model: &mut Model, x: f64) -> Result<(), Error> {
        let given = Given {
            argument: self.argument,
            value: self.value(model, x)?,
            span: Span::default(),
        };
        model.apply(&Command::Change(Record {
            row: self.row,
            id: self.id,
            given: vec![given],
            kept: Vec::new(),
            place: Place::default(),
            head: Span::default(),
            mistaken: false,
        }))
    }

    /// Returns the value of the argument with the number in its place.
    fn value(&self, model: &Model, x: f64) -> Result<Value, Error> {
        let number = Number::plain(x);
        let Some(place) = self.place else {
            return Ok(match self.kind {
                Kind::Formula => Value::Formula(Formula::text(number.to_string())),
                _ => Value::Real(number),
            });
        };
        let records = self.row.records(model);
        let mine = records.into_iter().find(|record| record.id == self.id);
        let given = mine.into_iter().flat_map(|record| record.given);
        let mut lists = given.filter_map(|g| match g.value {
            Value::Reals(all) if g.argument == self.argument => Some(all),
            _ => None,
        });
        let mut all = lists.next().unwrap_or_default();
        let n = all.len();
        match all.get_mut(place) {
            Some(old) => *old = number,
            None => {
                let what = format!("the model gives {} there", counted(n, "number"));
                return Err(wrong("bad_sweep", &self.name, what).into());
            }
        }
        Ok(Value::Reals(all))
    }
}

/// A statement, the number of its element, and the argument that is named with it.
type Found<'a> = (&'static dyn Statement, Option<u32>, Option<&'a str>);

/// Finds the statement of `PART/2.MASS`, `slider.MASS`, `gain` or `ACCGRAV.JGRAV`.
fn element<'a>(model: &Model, name: &'a str) -> Result<Found<'a>, Error> {
    let of_element = |id: ElementId, argument| {
        let row = STATEMENTS.iter().find(|row| row.kind() == Some(id.kind));
        let row = *row.ok_or_else(|| model.no_element(id))?;
        Ok((row, Some(id.number), argument))
    };
    let (head, argument) = match name.rsplit_once('.') {
        Some((head, argument)) => (head.trim(), Some(argument.trim())),
        None => (name, None),
    };
    // of several elements of a name those count that have the argument
    let kinds = argument.map_or_else(Vec::new, kinds_with);
    let of_kinds = match kinds.is_empty() {
        true => model.find_element(head),
        false => model.find_of(&kinds, head),
    };
    let said = match of_kinds {
        Ok(id) => return of_element(id, argument),
        Err(said) => said,
    };
    // the name may have dots, and an element may lack the argument
    if let Ok(id) = model.find_element(name) {
        return of_element(id, None);
    }
    match model.find_element(head) {
        Ok(id) => of_element(id, argument),
        Err(_) => statement(model, name, (head, argument), said),
    }
}

/// Returns the kinds of elements whose statements have an argument, with or without a place in its
/// list.
fn kinds_with(argument: &str) -> Vec<ElementKind> {
    let word = argument.split('(').next().unwrap_or_default().trim();
    let has = |row: &&&'static dyn Statement| {
        let arguments = row.arguments();
        matches!(
            meaning(word, arguments.iter().map(|a| a.name)),
            Meaning::One(_)
        )
    };
    let rows = STATEMENTS.iter().filter(has);
    rows.filter_map(|row| row.kind()).collect()
}

/// Finds the statement of `ACCGRAV`, or of `PA/2`, whose keyword is abbreviated; `said`: no element
/// has the name.
fn statement<'a>(
    model: &Model,
    name: &str,
    (head, argument): (&str, Option<&'a str>),
    said: Diagnostic,
) -> Result<Found<'a>, Error> {
    let (word, number) = match head.split_once('/') {
        Some((word, number)) => (word.trim(), Some(number.trim())),
        None => (head, None),
    };
    let Meaning::One(k) = statement::find(word) else {
        if number.is_none() && argument.is_some() {
            return Err(said.into());
        }
        let d = wrong(
            "unknown_statement",
            name,
            format!("there is no statement {word}"),
        );
        let known: Vec<String> = STATEMENTS.iter().map(|s| canonical(s.keyword())).collect();
        let mut d = with_near(d, word, &known);
        d.help.extend(
            said.help
                .into_iter()
                .filter(|h| h.starts_with("did you mean")),
        );
        return Err(d.into());
    };
    let row = STATEMENTS[k];
    let keyword = canonical(row.keyword());
    let Some(kind) = row.kind() else {
        return match number {
            None => Ok((row, None, argument)),
            Some(_) => Err(wrong("bad_sweep", name, format!("{keyword} has no number")).into()),
        };
    };
    let Some(id) = number.and_then(|n| n.parse().ok()) else {
        let d = wrong(
            "bad_sweep",
            name,
            format!("{keyword} needs the number of its element"),
        );
        return Err(d.help(format!("{keyword}/1.ARGUMENT")).into());
    };
    let known = model.numbers(kind);
    if !known.contains(&id) {
        let mut d = wrong(
            Cause::UnknownElement,
            name,
            format!("{} does not exist", kind.id(id)),
        );
        d.help.extend(near_ids(id, known.into_iter()));
        return Err(d.into());
    }
    Ok((row, Some(id), argument))
}

/// Splits `QP(2)` into the keyword and its place from 0.
fn listed<'a>(name: &str, text: &'a str) -> Result<(&'a str, Option<usize>), Error> {
    let Some((keyword, rest)) = text.split_once('(') else {
        return Ok((text, None));
    };
    let number = rest.strip_suffix(')').and_then(|n| n.trim().parse().ok());
    match number.and_then(|n: usize| n.checked_sub(1)) {
        Some(place) => Ok((keyword.trim(), Some(place))),
        None => {
            let what = format!("({rest} is no place in a list, counted from 1");
            Err(wrong("bad_sweep", name, what).into())
        }
    }
}

/// Finds an argument of a statement.
fn found(
    row: &'static dyn Statement,
    name: &str,
    arguments: &[Argument],
    word: &str,
) -> Result<usize, Error> {
    if let Meaning::One(k) = meaning(word, arguments.iter().map(|a| a.name)) {
        return Ok(k);
    }
    let keyword = canonical(row.keyword());
    let d = wrong(
        "unknown_argument",
        name,
        format!("{keyword} has no argument {word}"),
    );
    let known: Vec<String> = arguments.iter().map(Argument::keyword).collect();
    let d = with_near(d, word, &known);
    Err(d
        .help(format!("cognate statements {keyword} lists its arguments"))
        .into())
}
