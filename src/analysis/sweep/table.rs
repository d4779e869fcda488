//! The table of a sweep: a file that grows by a line as a run is done, in whatever order that is;
//! complete, its lines are in the order of the points.
//!
//! ```text
//! run, parameters …, measures …, status, warnings, reason
//! ```
//!
//! `status` is the exit code that the run alone would have. Beside the table stands
//! `NAME.sweep.json` with the digest of all that determines a row: by it a sweep that was killed is
//! gone on with, and rows of another model are not.

use super::{Parameter, Row, Sweep};
use crate::arrange::Arrange;
use crate::diagnostic::{Cause, Diagnostic, Error};
use crate::disk;
use crate::disk::{File, OpenOptions};
use crate::results::csv::safe_name;
use crate::results::{Column, Kind, Run, Sequence, Status, Writing, digest, digits, write_text};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Columns behind parameters and measures.
const ENDING: [&str; 3] = ["status", "warnings", "reason"];

/// The growing table of a sweep.
pub struct Table {
    path: PathBuf,
    file: File,
    names: Vec<String>,
    units: Vec<String>,
    rows: Vec<Row>,
    n_points: usize,
    n_found: usize,
}

impl Table {
    /// Begins a table, or goes on with the one that is there: rows whose parameters are a point of
    /// the design are kept, but those that ended at a limit, and a line that was cut off.
    ///
    /// # Errors
    /// A file that is not the table of this sweep, or has rows that are no points of the design;
    /// one that cannot be read, or may not be written.
    pub fn open(path: &Path, sweep: &Sweep, points: &[Vec<f64>]) -> Result<Self, Error> {
        Self::open_with(path, sweep, points, Writing::default())
    }

    /// Does the same with leave to write.
    ///
    /// # Errors
    /// As [`Table::open`].
    pub fn open_with(
        path: &Path,
        sweep: &Sweep,
        points: &[Vec<f64>],
        writing: Writing,
    ) -> Result<Self, Error> {
        let (names, units) = heads(sweep);
        let record = path.with_extension("sweep.json");
        let digest = recorded_digest(&record).filter(|_| disk::is_there(path));
        let is_this = digest.as_ref().is_some_and(|d| *d == digest_of(sweep));
        let is_of_this_sweep = is_this && !disk::is_input(path);
        if digest.is_some() && !is_of_this_sweep && !writing.overwrites() {
            let what = format!("{} is no table of this sweep", disk::text(&path));
            return Err(other(what).into());
        }
        let mut rows = Vec::new();
        if is_of_this_sweep {
            rows = read(path, &names, points)?;
        }
        let n_found = rows.len();
        let text = written(&names, &units, &rows);
        if !is_of_this_sweep {
            for place in [path, &record] {
                writing.check(place)?;
            }
            writing.text(&record, &record_text(sweep))?;
        }
        let before = disk::read_own(path).unwrap_or_default();
        match is_of_this_sweep {
            // at most a line that was cut off is lost
            true if before.starts_with(text.as_bytes()) => write_text(path, &text)?,
            true => drop(writing.replace_own(path, &text)?),
            false => drop(writing.text(path, &text)?),
        }
        let file = OpenOptions::new().append(true).open(path);
        Ok(Self {
            file: file.map_err(|e| unwritable(path, e))?,
            path: path.to_owned(),
            names,
            units,
            rows,
            n_points: points.len(),
            n_found,
        })
    }

    /// Returns the indices of the points that have no row so far.
    pub fn missing(&self) -> Vec<usize> {
        let mut is_done = vec![false; self.n_points];
        self.rows.iter().for_each(|row| is_done[row.run] = true);
        let missing = is_done.iter().enumerate().filter(|(_, done)| !**done);
        missing.map(|(k, _)| k).collect()
    }

    /// Returns how many rows were there when the table was opened.
    pub fn n_found(&self) -> usize {
        self.n_found
    }

    /// The rows so far, in the order in which they were done.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Adds a row; when it returns, the line is in the file.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn push(&mut self, row: Row) -> Result<(), Error> {
        let line = lines([cells(&row)]);
        let done = self.file.write_all(&line).and_then(|()| self.file.flush());
        done.map_err(|e| unwritable(&self.path, e))?;
        self.rows.push(row);
        Ok(())
    }

    /// Puts the lines into the order of the points.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn complete(&mut self) -> Result<(), Error> {
        self.rows.arrange_by_key(|row| row.run);
        let text = written(&self.names, &self.units, &self.rows);
        Ok(write_text(&self.path, &text)?)
    }

    /// Returns the numbers of the table as results, for other formats: all but the reasons.
    pub fn numbers(&self) -> Run {
        let n = self.names.len() - 1;
        let mut run = Run {
            name: "sweep".into(),
            ..Run::default()
        };
        for (name, unit) in self.names.iter().zip(&self.units).take(n) {
            let unit = if unit == "-" { "" } else { unit };
            run.columns.push(Column {
                name: name.clone(),
                unit: unit.into(),
                ..Column::default()
            });
        }
        for row in &self.rows {
            let ends = [f64::from(row.status.exit_code()), row.warnings as f64];
            let numbers = [row.run as f64].into_iter();
            let numbers = numbers.chain(row.values.iter().chain(&row.measures).copied());
            let columns = run.columns.iter_mut();
            columns
                .zip(numbers.chain(ends))
                .for_each(|(c, x)| c.values.push(x));
        }
        let (name, rows) = (String::from("sweep"), 0..self.rows.len());
        run.sequences.push(Sequence {
            name,
            kind: Kind::Dynamic,
            rows,
        });
        run
    }
}

impl Sweep {
    /// Returns rows as the text of a table: names, units, then a line each.
    pub fn table(&self, rows: &[Row]) -> String {
        let (names, units) = heads(self);
        written(&names, &units, rows)
    }
}

/// Returns the names and units of the columns.
fn heads(sweep: &Sweep) -> (Vec<String>, Vec<String>) {
    let parameters = sweep.parameters.iter().map(Parameter::name);
    let measures = sweep.measures.iter().map(|m| (m.name(), m.unit()));
    let heads = [("run", "")].into_iter();
    let heads = heads.chain(parameters.map(|name| (name, "")));
    let heads = heads.chain(measures).chain(ENDING.map(|name| (name, "")));
    let unit = |unit: &str| if unit.is_empty() { "-" } else { unit }.to_owned();
    heads.map(|(name, of)| (name.to_owned(), unit(of))).unzip()
}

/// Returns the cells of a row.
fn cells(row: &Row) -> Vec<String> {
    let number = |x: &f64| digits(*x);
    let mut cells = vec![row.run.to_string()];
    cells.extend(row.values.iter().chain(&row.measures).map(number));
    cells.push(row.status.exit_code().to_string());
    cells.push(row.warnings.to_string());
    // a row is a line
    cells.push(row.reason.replace(['\n', '\r'], " "));
    cells
}

/// Returns rows of cells as lines of a table.
fn lines(rows: impl IntoIterator<Item = Vec<String>>) -> Vec<u8> {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    for row in rows {
        // writing rows of equal length to memory cannot fail
        let written = writer.write_record(&row);
        debug_assert!(written.is_ok(), "rows have equal length");
    }
    writer.into_inner().unwrap_or_default()
}

fn written(names: &[String], units: &[String], rows: &[Row]) -> String {
    let safe = |names: &[String]| names.iter().map(|name| safe_name(name)).collect();
    let heads = [safe(names), safe(units)].into_iter();
    let bytes = lines(heads.chain(rows.iter().map(cells)));
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Reads the rows of a table, each as that of a point of the design that has no row yet.
fn read(path: &Path, names: &[String], points: &[Vec<f64>]) -> Result<Vec<Row>, Error> {
    let bytes = disk::read_own(path).map_err(|e| {
        let what = format!("{}: cannot be opened: {e}", disk::text(&path));
        Error::from(Diagnostic::error("cannot_open", what)).with_source(e)
    })?;
    // a line that was cut off is no row
    let end = bytes.iter().rposition(|&b| b == b'\n').map_or(0, |k| k + 1);
    let mut reader = ::csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .from_reader(&bytes[..end]);
    let mut lines = reader.records();
    let is_head = |line: &::csv::StringRecord| line.iter().eq(names.iter().map(|n| safe_name(n)));
    if end > 0
        && !lines
            .next()
            .and_then(Result::ok)
            .is_some_and(|l| is_head(&l))
    {
        let what = format!("{} has other columns than this sweep", disk::text(&path));
        return Err(other(what).into());
    }
    let key = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
    let mut free: BTreeMap<Vec<u64>, Vec<usize>> = BTreeMap::new();
    for (k, point) in points.iter().enumerate().rev() {
        free.entry(key(point)).or_default().push(k);
    }
    let n_values = points.first().map_or(0, Vec::len);
    let mut rows = Vec::new();
    // the second line has the units
    for line in lines.skip(1).filter_map(Result::ok) {
        let row = parsed(&line, names.len(), n_values);
        let Some(mut row) = row.filter(|row| row.status != Status::Limit) else {
            continue;
        };
        let Some(run) = free.get_mut(&key(&row.values)).and_then(Vec::pop) else {
            let what = format!(
                "{} has a run {} that the design has not",
                disk::text(&path),
                row.run
            );
            return Err(other(what).into());
        };
        row.run = run;
        rows.push(row);
    }
    Ok(rows)
}

/// Returns the row that a line holds; `None`: it holds none.
fn parsed(line: &::csv::StringRecord, n_cells: usize, n_values: usize) -> Option<Row> {
    if line.len() != n_cells {
        return None;
    }
    let numbers = line.iter().take(n_cells - 1);
    let numbers: Vec<f64> = numbers.map(|c| c.parse().ok()).collect::<Option<_>>()?;
    let [run, of_point @ .., status, warnings] = numbers.as_slice() else {
        return None;
    };
    let (values, measures) = of_point.split_at_checked(n_values)?;
    let mut known = Status::ALL.into_iter();
    let status = known.find(|s| f64::from(s.exit_code()) == *status)?;
    Some(Row {
        run: *run as usize,
        values: values.to_vec(),
        measures: measures.to_vec(),
        status,
        warnings: *warnings as usize,
        reason: line.get(n_cells - 1)?.to_owned(),
    })
}

/// Returns the digest of all that determines a row.
fn digest_of(sweep: &Sweep) -> String {
    let mut text = format!("{}\n{}\n", env!("CARGO_PKG_VERSION"), sweep.model.to_text());
    for step in &sweep.commands {
        text += &format!("{:?}\n", step.command);
    }
    let mut options = sweep.options.clone();
    // limits decide whether there is a result, not which
    (options.limit, options.max_steps) = (None, None);
    text += &format!("{options:?}\n{:?}\n", heads(sweep));
    text += &sweep.beside.join("\n");
    digest(text.into_bytes())
}

fn record_text(sweep: &Sweep) -> String {
    let (names, _) = heads(sweep);
    let record = serde_json::json!({ "digest": digest_of(sweep), "columns": names });
    format!("{record:#}\n")
}

fn recorded_digest(record: &Path) -> Option<String> {
    let text = disk::read_own(record).ok()?;
    let record: serde_json::Value = serde_json::from_slice(&text).ok()?;
    Some(record["digest"].as_str()?.to_owned())
}

fn other(what: String) -> Diagnostic {
    let d = Diagnostic::error("other_sweep", what);
    d.help("name another file with --out, or remove this one and the .sweep.json beside it")
}

fn unwritable(path: &Path, e: std::io::Error) -> Error {
    let what = format!("{}: cannot be written: {e}", disk::text(&path));
    Error::from(Diagnostic::error(Cause::FileUnwritable, what)).with_source(e)
}
