//! From the text of `MODEL.toml` to a [`Setup`]: all mistakes at once, each at its line and column.

use super::function::{Ordinate, Shape, UserFunction, read_formula, read_points};
use super::group::{self, Group, Members};
use super::{Case, Named, Setup, Solve};
use crate::dataset::command::SimulationKind;
use crate::diagnostic::{Diagnostic, Span, near_names};
use crate::expr::spline::Ends;
use crate::results::format::Format;
use std::ops::Range;
use std::path::PathBuf;
use toml_edit::{Document, Item, TableLike, Value};

/// The tables of the file.
const TABLES: [&str; 5] = ["solve", "cases", "functions", "loads", "groups"];
/// The keys of `[solve]`.
const SOLVE: [&str; 11] = [
    "loads",
    "type",
    "end",
    "steps",
    "initial_static_equilibrium",
    "error",
    "method",
    "format",
    "only",
    "body_motion",
    "columns",
];
/// The keys of a function.
const FUNCTION: [&str; 7] = [
    "expression",
    "direct",
    "file",
    "points",
    "ends",
    "slopes",
    "ordinate",
];
/// The keys of a group.
const GROUP: [&str; 2] = ["functions", "groups"];

/// Reads the text of a file.
///
/// # Errors
/// All mistakes.
pub(super) fn setup(file: PathBuf, text: String) -> Result<Setup, Vec<Diagnostic>> {
    let mut reader = Reader {
        setup: Setup {
            file,
            text,
            ..Setup::default()
        },
        found: Vec::new(),
    };
    match Document::parse(reader.setup.text.clone()) {
        Ok(document) => reader.document(document.as_table()),
        Err(e) => {
            let place = e.span();
            reader.wrong(place, format!("this is no TOML: {}", e.message().trim()));
        }
    }
    let Reader { setup, mut found } = reader;
    if found.is_empty() {
        found = group::mistakes(&setup);
    }
    match found.is_empty() {
        true => Ok(setup),
        false => Err(found),
    }
}

/// Kinds of simulations by their words.
const KINDS: [(&str, SimulationKind); 5] = [
    ("dynamic", SimulationKind::Dynamic),
    ("kinematic", SimulationKind::Kinematic),
    ("static", SimulationKind::Static),
    ("transient", SimulationKind::Transient),
    ("initial-conditions", SimulationKind::InitialConditions),
];

/// Reads a kind of simulation.
fn kind_of(text: &str) -> Result<SimulationKind, String> {
    let found = KINDS
        .iter()
        .find(|(word, _)| word.eq_ignore_ascii_case(text));
    found.map(|(_, kind)| *kind).ok_or_else(|| {
        let words: Vec<&str> = KINDS.iter().map(|(word, _)| *word).collect();
        format!("`{text}` is no kind of simulation: {}", words.join(", "))
    })
}

/// A set-up that is being read, and the mistakes so far.
struct Reader {
    setup: Setup,
    found: Vec<Diagnostic>,
}

impl Reader {
    /// Notes a mistake; returns it for advice.
    fn wrong(
        &mut self,
        place: Option<Range<usize>>,
        message: impl Into<String>,
    ) -> &mut Diagnostic {
        let span = place.map_or(Span::default(), |p| Span::new(p.start, p.end));
        let d = self.setup.mistake(span, "bad_setup", message);
        let last = self.found.len();
        self.found.push(d);
        &mut self.found[last]
    }

    /// Notes keys that a table does not have.
    fn known(&mut self, table: &dyn TableLike, what: &str, known: &[&str]) {
        for (key, _) in table.iter().filter(|(key, _)| !known.contains(key)) {
            let place = table.key(key).and_then(|k| k.span());
            let near = near_names(key, known.iter().copied());
            let d = self.wrong(place, format!("{what} has no `{key}`"));
            if !near.is_empty() {
                d.help.push(format!("did you mean {}?", near.join(" or ")));
            }
            d.help.push(format!("{what} has {}", known.join(", ")));
        }
    }

    fn document(&mut self, root: &dyn TableLike) {
        self.known(root, "the file", &TABLES);
        let mut table = |name: &str| -> Option<&dyn TableLike> {
            let item = root.get(name)?;
            let found = item.as_table_like();
            if found.is_none() {
                self.wrong(item.span(), format!("`{name}` is a table: [{name}]"));
            }
            found
        };
        let [solve, cases, functions, loads, groups] = TABLES.map(&mut table);
        if let Some(table) = solve {
            self.solve(table);
        }
        for (name, item) in entries(cases) {
            let loads = self.names(item, "a load case is a list of loads");
            self.setup.cases.push(Case { name, loads });
        }
        for (name, item) in entries(functions) {
            let function = self.function(name, item);
            self.setup.functions.extend(function);
        }
        for (load, item) in entries(loads) {
            match item.as_str() {
                Some(_) => {
                    let driven = (load, named(item));
                    self.setup.driven.push(driven);
                }
                None => {
                    let what = "a load has the name of a function";
                    self.wrong(item.span(), what);
                }
            }
        }
        for (name, item) in entries(groups) {
            let group = self.group(name, item);
            self.setup.groups.extend(group);
        }
    }

    fn solve(&mut self, table: &dyn TableLike) {
        self.known(table, "[solve]", &SOLVE);
        let loads = table.get("loads");
        self.setup.solve = Solve {
            loads: loads.map(|item| self.names(item, "loads are a list of names")),
            kind: self.word(table, "type", kind_of),
            end: self.number(table, "end"),
            steps: self.number(table, "steps").map(|n| n as usize),
            at_rest_first: self.switch(table, "initial_static_equilibrium"),
            error: self.number(table, "error"),
            method: self.word(table, "method", |text| Ok(text.to_owned())),
            formats: self.words(table, "format", table_format),
            only: self.words(table, "only", str::parse),
            body_motion: self.switch(table, "body_motion"),
            columns: self.words(table, "columns", |text| Ok(text.to_owned())),
        };
    }

    /// Reads a positive number.
    fn number(&mut self, table: &dyn TableLike, key: &str) -> Option<f64> {
        let item = table.get(key)?;
        let found = number(item).filter(|x| x.is_finite() && *x > 0.0);
        let is_count = key == "steps";
        match found.filter(|x| !is_count || x.fract() == 0.0 && *x < 4e9) {
            Some(x) => Some(x),
            None => {
                let kind = if is_count { "a whole" } else { "a" };
                self.wrong(item.span(), format!("{key} is {kind} number above zero"));
                None
            }
        }
    }

    fn switch(&mut self, table: &dyn TableLike, key: &str) -> bool {
        let Some(item) = table.get(key) else {
            return false;
        };
        item.as_bool().unwrap_or_else(|| {
            self.wrong(item.span(), format!("{key} is true or false"));
            false
        })
    }

    /// Reads a text with a meaning.
    fn word<T>(
        &mut self,
        table: &dyn TableLike,
        key: &str,
        meaning: impl Fn(&str) -> Result<T, String>,
    ) -> Option<T> {
        let item = table.get(key)?;
        let read = item.as_str().ok_or_else(|| format!("{key} is a text"));
        match read.and_then(meaning) {
            Ok(found) => Some(found),
            Err(why) => {
                self.wrong(item.span(), why);
                None
            }
        }
    }

    /// Reads a list of texts with a meaning.
    fn words<T>(
        &mut self,
        table: &dyn TableLike,
        key: &str,
        meaning: impl Fn(&str) -> Result<T, String>,
    ) -> Vec<T> {
        let Some(item) = table.get(key) else {
            return Vec::new();
        };
        let names = self.names(item, &format!("{key} is a list of texts"));
        let mut all = Vec::new();
        for name in names {
            match meaning(&name.text) {
                Ok(found) => all.push(found),
                Err(why) => {
                    self.wrong(Some(name.span.start..name.span.end), why);
                }
            }
        }
        all
    }

    /// Reads a list of names, or a single one.
    fn names(&mut self, item: &Item, what: &str) -> Vec<Named> {
        if item.is_str() {
            return vec![named(item)];
        }
        let Some(list) = item.as_array() else {
            self.wrong(item.span(), format!("{what}: [\"…\", \"…\"]"));
            return Vec::new();
        };
        let mut names = Vec::new();
        for value in list {
            match value.as_str() {
                Some(_) => names.push(named_value(value)),
                None => {
                    self.wrong(value.span(), "a name in quotation marks is expected");
                }
            }
        }
        names
    }

    fn function(&mut self, name: Named, item: &Item) -> Option<UserFunction> {
        let Some(table) = item.as_table_like() else {
            let what = format!("a function is a table: [functions.{}]", name.text);
            self.wrong(item.span(), what);
            return None;
        };
        self.known(table, "a function", &FUNCTION);
        let ordinate = self.word(table, "ordinate", Ordinate::of);
        let forms = ["expression", "direct", "file", "points"];
        let given: Vec<&str> = (forms.into_iter())
            .filter(|form| table.contains_key(form))
            .collect();
        let &[form] = given.as_slice() else {
            let place = Some(name.span.start..name.span.end);
            let what = format!(
                "the function {} is given in {} ways; it has one of {}",
                name.text,
                given.len(),
                forms.join(", ")
            );
            self.wrong(place, what);
            return None;
        };
        let item = table.get(form)?;
        for key in ["ends", "slopes"] {
            if let Some(item) = table.get(key).filter(|_| form != "points") {
                self.wrong(item.span(), format!("{key} belong to points"));
            }
        }
        let shape = match form {
            "points" => self.points(table, item)?,
            "file" => {
                let read = item.as_str().ok_or_else(|| "file is a name".to_owned());
                let folder = self.setup.file.parent().map(PathBuf::from);
                let beside = |name: &str| folder.unwrap_or_default().join(name);
                match read.and_then(|name| read_formula(&beside(name))) {
                    Ok(text) => Shape::Direct(Named {
                        text,
                        span: named(item).span,
                    }),
                    Err(why) => {
                        self.wrong(item.span(), why);
                        return None;
                    }
                }
            }
            _ if item.as_str().is_none() => {
                self.wrong(item.span(), format!("{form} is a text"));
                return None;
            }
            "expression" => Shape::Expression(named(item)),
            _ => Shape::Direct(named(item)),
        };
        Some(UserFunction {
            name,
            shape,
            ordinate: ordinate.unwrap_or_default(),
        })
    }

    /// Reads the points of a spline and its end conditions.
    fn points(&mut self, table: &dyn TableLike, item: &Item) -> Option<Shape> {
        let read = match item.as_str() {
            Some(name) => {
                let folder = self.setup.file.parent().map(PathBuf::from);
                read_points(&folder.unwrap_or_default().join(name))
            }
            None => pairs(item),
        };
        let points = match read {
            Ok(points) => points,
            Err(why) => {
                self.wrong(item.span(), why);
                return None;
            }
        };
        let slopes = table.get("slopes");
        let ends = table.get("ends");
        let ends = match (ends.map(|item| item.as_str()), slopes) {
            (None | Some(Some("natural")), None) => Ends::Natural,
            (Some(Some("not-a-knot")), None) => Ends::NotAKnot,
            (Some(Some("periodic")), None) => Ends::Periodic,
            (None, Some(item)) => match numbers(item).as_deref() {
                Some(&[first, last]) => Ends::Clamped(first, last),
                _ => {
                    let what = "slopes are two numbers, at the first and the last point";
                    self.wrong(item.span(), what);
                    return None;
                }
            },
            _ => {
                let what =
                    "ends are \"natural\", \"not-a-knot\" or \"periodic\", or slopes are given";
                self.wrong(ends.and_then(Item::span), what);
                return None;
            }
        };
        let span = item
            .span()
            .map_or(Span::default(), |p| Span::new(p.start, p.end));
        Some(Shape::Points { points, ends, span })
    }

    fn group(&mut self, name: Named, item: &Item) -> Option<Group> {
        let Some(table) = item.as_table_like() else {
            let what = format!("a group is a table: [groups.{}]", name.text);
            self.wrong(item.span(), what);
            return None;
        };
        self.known(table, "a group", &GROUP);
        let members = match GROUP.map(|key| table.get(key)) {
            [Some(item), None] => {
                Members::Functions(self.names(item, "functions are a list of names"))
            }
            [None, Some(item)] => Members::Groups(self.names(item, "groups are a list of names")),
            _ => {
                let what = format!(
                    "the group {} is one of functions or one of groups",
                    name.text
                );
                self.wrong(Some(name.span.start..name.span.end), what);
                return None;
            }
        };
        Some(Group { name, members })
    }
}

/// Returns the entries of a table with the places of their keys.
fn entries(table: Option<&dyn TableLike>) -> Vec<(Named, &Item)> {
    let Some(table) = table else {
        return Vec::new();
    };
    let entry = |(key, item): (&str, _)| {
        let place = table.key(key).and_then(|k| k.span());
        let span = place.map_or(Span::default(), |p| Span::new(p.start, p.end));
        let text = key.to_owned();
        (Named { text, span }, item)
    };
    table.iter().map(entry).collect()
}

/// Returns a text of the file with its place.
fn named(item: &Item) -> Named {
    item.as_value().map(named_value).unwrap_or_default()
}

fn named_value(value: &Value) -> Named {
    Named {
        text: value.as_str().unwrap_or_default().to_owned(),
        span: (value.span()).map_or(Span::default(), |p| Span::new(p.start, p.end)),
    }
}

fn number(item: &Item) -> Option<f64> {
    let whole = item.as_integer().map(|n| n as f64);
    item.as_float().or(whole)
}

/// Returns the numbers of a list.
fn numbers(item: &Item) -> Option<Vec<f64>> {
    let list = item.as_array()?;
    list.iter().map(value_as_number).collect()
}

fn value_as_number(value: &Value) -> Option<f64> {
    let whole = value.as_integer().map(|n| n as f64);
    value.as_float().or(whole)
}

/// Reads points as `[[time, value], …]`.
fn pairs(item: &Item) -> Result<Vec<[f64; 2]>, String> {
    let pair = |value: &Value| {
        let list = value.as_array()?;
        let pair: Option<Vec<f64>> = list.iter().map(value_as_number).collect();
        pair?.try_into().ok()
    };
    let points = item.as_array().map(|list| list.iter().map(pair).collect());
    let points: Option<Vec<[f64; 2]>> = points.flatten();
    points.ok_or_else(|| {
        "points are a list of pairs of time and value, [[0, 0], [1, 2.5]], or a file of two columns"
            .to_owned()
    })
}

/// Returns the format of a name.
fn table_format(name: &str) -> Result<Format, String> {
    let row = Format::row(&name.to_lowercase()).filter(|row| row.sink.is_some());
    row.map(|row| row.format)
        .ok_or_else(|| format!("formats: {}", Format::names(true).join(", ")))
}
