//! Inputs of plants (PINPUT) from a table over time: a column becomes a SPLINE, and the FUNCTION of
//! the VARIABLE reads it.
//!
//! | a column is called | it gives |
//! |---|---|
//! | `u`, `VARIABLE/7`, `VARIABLE_7`, `VARIABLE_7.Q` | that VARIABLE |
//! | `IN2` | the second VARIABLE of the PINPUTs, which must agree about it |
//! | `PINPUT/3.IN2`, `plant.ctrl_pinput.IN2` | the second VARIABLE of that PINPUT |

use crate::diagnostic::{Diagnostic, Error, Severity, counted};
use crate::disk;
use crate::encoding::as_utf8;
use crate::model::{ElementKind, Formula, Model, SplineData};
use crate::results::csv::{Rows, plain_name};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Mistakes of a table that are written out, at most.
const MOST_MISTAKES: usize = 20;
/// Names of which none is left out of a sentence.
const MOST_NAMES: usize = 12;
/// Points that a SPLINE has at least.
const LEAST_POINTS: usize = 4;

/// The course of an input between two samples of its table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// a straight line
    #[default]
    Linear,
    /// the value of the sample before
    Held,
}

/// Drives inputs of a model's plants by a table over time (`.csv`): its first column is TIME, in
/// the unit of the model, each further column an input. Before the first sample and after the last
/// their values are held. Returns a note that says so.
///
/// # Errors
/// All mistakes of the table, at their lines: columns that are no input, times that do not
/// increase, cells without a number.
pub fn drive_inputs(model: &mut Model, file: &Path, between: Between) -> Result<Diagnostic, Error> {
    let name = disk::text(&file);
    let bytes = disk::read(file).map_err(|e| {
        let d = Diagnostic::error("cannot_open", format!("{name}: cannot be opened: {e}"));
        Error::from(d)
    })?;
    let mut mistakes = Mistakes::new(&name);
    let table = Table::read(&as_utf8(bytes), model, &mut mistakes);
    mistakes.none()?;
    for (&variable, samples) in table.variables.iter().zip(&table.samples) {
        let function = function_of(model, (&table.times, samples), between);
        if let Some(variable) = model.variables.get_mut(&variable) {
            variable.function = function;
        }
    }
    Ok(driven(
        model,
        &table.variables,
        (&name, &table.times),
        between,
    ))
}

/// Returns a note about inputs of plants that stay as their functions say: constants, and USER.
/// `None`: there are none.
pub fn undriven_inputs(model: &Model) -> Option<Diagnostic> {
    let inputs = inputs(model);
    let stays = |n: &&u32| {
        let function = model.variables.get(n).map(|v| &v.function);
        function.is_some_and(|f| matches!(f, Formula::User { .. }) || f.constant().is_some())
    };
    let staying: Vec<u32> = inputs.iter().filter(stays).copied().collect();
    let verb = match staying.len() {
        0 => return None,
        1 => "is an input of a plant and stays as its FUNCTION says",
        _ => "are inputs of a plant and stay as their FUNCTIONs say",
    };
    let what = format!("{} {verb}", listed(model, &staying));
    Some(note(what).help("--input FILE.csv gives inputs over time"))
}

fn note(what: String) -> Diagnostic {
    Diagnostic {
        severity: Severity::Note,
        ..Diagnostic::warning("plant_inputs", what)
    }
}

/// Returns the note about inputs that a table drives.
fn driven(
    model: &Model,
    variables: &[u32],
    (file, times): (&str, &[f64]),
    between: Between,
) -> Diagnostic {
    let course = match between {
        Between::Linear => "straight between",
        Between::Held => "held from one to the next of",
    };
    let ends = [times.first(), times.last()].map(|t| t.copied().unwrap_or_default());
    let given = listed(model, variables);
    let verb = if variables.len() == 1 {
        "follows"
    } else {
        "follow"
    };
    let samples = counted(times.len(), "sample");
    let [first, last] = ends;
    let mut what = format!(
        "{given} {verb} {file}, {course} {samples} from {first} to {last}; the first and the last \
         value hold outside"
    );
    let given: BTreeSet<u32> = variables.iter().copied().collect();
    let others: Vec<u32> = inputs(model).difference(&given).copied().collect();
    match others.len() {
        0 => {}
        1 => what += &format!("; {} has no column", listed(model, &others)),
        _ => what += &format!("; {} have no column", listed(model, &others)),
    }
    note(what)
}

/// Returns the VARIABLEs that are inputs of plants.
fn inputs(model: &Model) -> BTreeSet<u32> {
    let active = model.active(ElementKind::Pinput, &model.plant_inputs);
    active
        .flat_map(|(_, plant)| plant.variables.clone())
        .collect()
}

/// Names VARIABLEs in a sentence.
fn listed(model: &Model, variables: &[u32]) -> String {
    let shown = variables.iter().take(MOST_NAMES);
    let mut names: Vec<String> = shown
        .map(|&n| model.called(ElementKind::Variable.id(n)))
        .collect();
    if let Some(more) = variables.len().checked_sub(MOST_NAMES).filter(|n| *n > 0) {
        names.push(format!("{more} more"));
    }
    match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => names.join(""),
    }
}

/// Returns the FUNCTION that takes these values at these times; makes the SPLINE that it reads.
fn function_of(model: &mut Model, (times, values): (&[f64], &[f64]), between: Between) -> Formula {
    let (mut x, mut y) = (times.to_vec(), values.to_vec());
    let (Some(&first), Some(&last), Some(&end)) = (x.first(), x.last(), y.last()) else {
        return Formula::text("0");
    };
    // further points after the last, with its value
    let beyond = |k: f64| last + k * last.abs().max(1.0);
    let missing = LEAST_POINTS.saturating_sub(x.len());
    x.extend((1..=missing).map(|k| beyond(k as f64)));
    y.resize(x.len(), end);
    let is_free = |id: &u32| !model.splines.contains_key(id);
    let id = (1..=u32::MAX).find(is_free).unwrap_or(u32::MAX);
    let spline = SplineData {
        x,
        y: vec![y],
        ..SplineData::default()
    };
    model.splines.insert(id, spline);
    Formula::text(match between {
        Between::Linear => format!("INTERP(MAX({first:E}, MIN(TIME, {last:E})), 1, {id})"),
        Between::Held => format!("INTERP(TIME, 0, {id})"),
    })
}

/// The mistakes of a table.
struct Mistakes<'a> {
    file: &'a str,
    found: Vec<Diagnostic>,
    further: usize,
}

impl<'a> Mistakes<'a> {
    fn new(file: &'a str) -> Self {
        Self {
            file,
            found: Vec::new(),
            further: 0,
        }
    }

    /// Notes a mistake in a line.
    fn add(&mut self, line: usize, mut d: Diagnostic) {
        if self.found.len() >= MOST_MISTAKES {
            self.further += 1;
            return;
        }
        d.file = Some(self.file.to_owned());
        (d.line, d.column) = (line, usize::from(line > 0));
        self.found.push(d);
    }

    fn say(&mut self, line: usize, what: impl Into<String>) {
        self.add(line, Diagnostic::error("input_table", what));
    }

    /// Ends the reading.
    ///
    /// # Errors
    /// The mistakes, if there are any.
    fn none(mut self) -> Result<(), Error> {
        if let (Some(last), true) = (self.found.last_mut(), self.further > 0) {
            let further = counted(self.further, "further mistake");
            last.help.push(format!("the table has at least {further}"));
        }
        match self.found.is_empty() {
            true => Ok(()),
            false => Err(self.found.into()),
        }
    }
}

/// A table of inputs over time.
#[derive(Default)]
struct Table {
    /// line of the names
    line: usize,
    /// names of the inputs
    names: Vec<String>,
    /// numbers of the VARIABLEs that they name
    variables: Vec<u32>,
    times: Vec<f64>,
    /// by input
    samples: Vec<Vec<f64>>,
}

impl Table {
    /// Reads a table: a row of names, a row of units or none, and a row for each time.
    fn read(bytes: &[u8], model: &Model, mistakes: &mut Mistakes<'_>) -> Self {
        let mut rows = Rows::new(bytes);
        let mut table = Self::default();
        let mut is_second = false;
        loop {
            let (line, cells) = match rows.next() {
                Ok(Some(row)) => row,
                Ok(None) => break,
                Err(d) => {
                    mistakes.say(d.line, d.message);
                    break;
                }
            };
            if table.line == 0 {
                table.begin(line, cells, mistakes);
                table.variables = table.named(model, mistakes);
                is_second = true;
                continue;
            }
            let numbers: Vec<Option<f64>> = cells.iter().map(|cell| rows.number(cell)).collect();
            let is_units = is_second && numbers.iter().all(Option::is_none);
            is_second = false;
            if cells.len() != table.names.len() + 1 {
                let (here, first) = (counted(cells.len(), "cell"), table.names.len() + 1);
                mistakes.say(line, format!("{here} where the first row has {first}"));
            } else if is_units {
                check_unit_of_time(model, (line, &cells[0]), mistakes);
            } else {
                table.take(line, (&cells, &numbers), mistakes);
            }
        }
        if table.line == 0 {
            mistakes.say(0, "there is no row of names");
        } else if table.times.is_empty() && mistakes.found.is_empty() {
            mistakes.say(table.line, "there is no sample below the names");
        }
        table
    }

    /// Takes the names of the columns.
    fn begin(&mut self, line: usize, cells: Vec<String>, mistakes: &mut Mistakes<'_>) {
        let mut names = cells.into_iter().map(plain_name);
        let first = names.next().unwrap_or_default();
        if !first.eq_ignore_ascii_case("time") {
            let what = format!("the first column is `{first}`, not TIME");
            let d = Diagnostic::error("input_table", what);
            let advice = "the first row has the names: TIME, then the inputs";
            mistakes.add(line, d.help(advice));
        }
        self.line = line;
        self.names = names.collect();
        self.samples = vec![Vec::new(); self.names.len()];
        if self.names.is_empty() {
            mistakes.say(line, "there is no column behind TIME");
        }
    }

    /// Takes a sample.
    fn take(
        &mut self,
        line: usize,
        (cells, numbers): (&[String], &[Option<f64>]),
        mistakes: &mut Mistakes<'_>,
    ) {
        for (k, cell) in cells.iter().enumerate() {
            if !numbers[k].is_some_and(f64::is_finite) {
                let column = match k {
                    0 => "TIME",
                    k => &self.names[k - 1],
                };
                let what = format!("`{cell}` in column `{column}` is no finite number");
                mistakes.say(line, what);
            }
        }
        let mut numbers = numbers.iter().map(|x| x.filter(|x| x.is_finite()));
        if let Some(time) = numbers.next().flatten() {
            if let Some(before) = self.times.last().filter(|before| **before >= time) {
                let what = format!("times must increase, but {time} follows {before}");
                mistakes.say(line, what);
            }
            self.times.push(time);
        }
        for (column, value) in self.samples.iter_mut().zip(numbers) {
            column.push(value.unwrap_or_default());
        }
    }

    /// Returns the VARIABLEs that the columns name.
    fn named(&self, model: &Model, mistakes: &mut Mistakes<'_>) -> Vec<u32> {
        let inputs = inputs(model);
        if inputs.is_empty() {
            let d = Diagnostic::error("input_table", "the model has no inputs: it has no PINPUT");
            mistakes.add(
                0,
                d.help("PINPUT/1, VARIABLES=… names the VARIABLEs that are inputs"),
            );
            return Vec::new();
        }
        let mut found: BTreeMap<u32, &str> = BTreeMap::new();
        let mut all = Vec::new();
        for name in &self.names {
            if mistakes.found.len() >= MOST_MISTAKES {
                break;
            }
            match input_called(model, &inputs, name) {
                Err(d) => mistakes.add(self.line, d),
                Ok(n) => match found.insert(n, name) {
                    Some(other) => {
                        let variable = model.called(ElementKind::Variable.id(n));
                        let what = format!("columns `{other}` and `{name}` are both {variable}");
                        mistakes.say(self.line, what);
                    }
                    None => all.push(n),
                },
            }
        }
        all
    }
}

/// Checks that times are in the unit of the model, where the table says their unit.
fn check_unit_of_time(model: &Model, (line, cell): (usize, &str), mistakes: &mut Mistakes<'_>) {
    let Some(units) = &model.units else { return };
    let cell = cell.trim();
    let is_it = |unit: &str| {
        let unit = unit.to_ascii_lowercase();
        let cell = cell.to_ascii_lowercase();
        cell == unit || unit == "second" && (cell == "sec" || cell == "s")
    };
    if !cell.is_empty() && cell != "-" && !is_it(&units.time) {
        let what = format!(
            "TIME is in `{cell}`, but {} is the unit of the model",
            units.time
        );
        mistakes.say(line, what);
    }
}

/// Returns the VARIABLE of an input that a column names.
fn input_called(model: &Model, inputs: &BTreeSet<u32>, name: &str) -> Result<u32, Diagnostic> {
    let wrong = |what: String| Diagnostic::error("input_table", what);
    let variable = match entry_called(model, name)? {
        Some(variable) => variable,
        None => {
            let of_results = name.strip_suffix(".Q").unwrap_or(name);
            let id = model.find_of(&[ElementKind::Variable], name);
            let id = id.or_else(|d| {
                let of_results = model.find_of(&[ElementKind::Variable], of_results);
                of_results.map_err(|_| d)
            });
            let of_table = |d: Diagnostic| Diagnostic {
                code: "input_table",
                message: format!("column `{name}` is no input: {}", d.message),
                ..d
            };
            id.map_err(of_table)?.number
        }
    };
    if inputs.contains(&variable) {
        return Ok(variable);
    }
    let called = model.called(ElementKind::Variable.id(variable));
    let all: Vec<u32> = inputs.iter().copied().collect();
    let d = wrong(format!(
        "column `{name}` is no input: no PINPUT has {called}"
    ));
    Err(d.help(format!("inputs are {}", listed(model, &all))))
}

/// Returns the VARIABLE at a place of a PINPUT: `IN2`, `PINPUT/3.IN2`. `None`: the name is none of
/// a place.
fn entry_called(model: &Model, name: &str) -> Result<Option<u32>, Diagnostic> {
    let (plant, entry) = match name.rsplit_once('.') {
        Some((plant, entry)) => (Some(plant), entry),
        None => (None, name),
    };
    let is_in = entry.get(..2).is_some_and(|s| s.eq_ignore_ascii_case("IN"));
    let place = entry.get(2..).filter(|_| is_in);
    let Some(place) = place.and_then(|s| s.parse::<usize>().ok()) else {
        return Ok(None);
    };
    if model.has_name(&[ElementKind::Variable], name) {
        return Ok(None);
    }
    let plants: Vec<u32> = match plant {
        Some(plant) => match model.find_of(&[ElementKind::Pinput], plant) {
            Ok(id) => vec![id.number],
            Err(d) => {
                return Err(Diagnostic {
                    code: "input_table",
                    message: format!("column `{name}` is no input: {}", d.message),
                    ..d
                });
            }
        },
        None => {
            let active = model.active(ElementKind::Pinput, &model.plant_inputs);
            active.map(|(n, _)| n).collect()
        }
    };
    let at_place = |n: &u32| {
        let variables = &model.plant_inputs.get(n)?.variables;
        variables.get(place.checked_sub(1)?).copied()
    };
    let found: BTreeSet<u32> = plants.iter().filter_map(at_place).collect();
    let found: Vec<u32> = found.into_iter().collect();
    let what = match found[..] {
        [only] => return Ok(Some(only)),
        [] => format!("column `{name}` is no input: no PINPUT has so many"),
        _ => format!(
            "column `{name}` is {} of several PINPUTs",
            listed(model, &found)
        ),
    };
    let advice = "name the VARIABLE, or its PINPUT as PINPUT/1.IN1";
    Err(Diagnostic::error("input_table", what).help(advice))
}
