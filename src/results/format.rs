//! The table of formats: names, who reads, who writes, and the styles that users choose from.
//!
//! A format that is written row by row is a [`TableText`] or a container of blocks ([`Sink`]); it
//! reads the columns, their names and units from the [`Run`] alone, so a new column is in all of
//! them.

use super::part_file::TextSink;
use super::{Run, csv, gra, json, msg_table, req, res};
use crate::diagnostic::Diagnostic;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A format of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Format {
    /// comma-separated values
    Csv,
    /// columns in compressed blocks
    Parquet,
    /// every element's components, as pre- and postprocessors read them
    Res,
    /// one document
    Json,
    /// positions of parts
    Gra,
    /// components of requests
    Req,
    /// steps of the integration in the log, read only
    Msg,
}

/// Reads a file from its bytes.
pub type Reader = fn(&[u8]) -> Result<Run, Diagnostic>;

/// Prepares a file at a place.
pub type NewSink = fn(Style, &Path) -> Box<dyn Sink>;

/// A row of the table of formats.
#[derive(Debug)]
pub struct Row {
    /// the format
    pub format: Format,
    /// its name, which is the extension of its files
    pub name: &'static str,
    /// reads a file
    pub read: Option<Reader>,
    /// begins to write a file
    pub sink: Option<NewSink>,
}

/// The formats.
pub const FORMATS: &[Row] = &[
    Row {
        format: Format::Csv,
        name: "csv",
        read: Some(csv::read),
        sink: Some(|style, path| Box::new(TextSink::new(csv::Table::new(style), path))),
    },
    #[cfg(feature = "parquet")]
    Row {
        format: Format::Parquet,
        name: "parquet",
        read: Some(super::parquet::read),
        sink: Some(|_, path| Box::new(super::parquet::Blocks::new(path))),
    },
    Row {
        format: Format::Res,
        name: "res",
        read: Some(res::read),
        sink: Some(|_, path| Box::new(TextSink::new(res::Steps::default(), path))),
    },
    Row {
        format: Format::Json,
        name: "json",
        read: Some(json::read),
        sink: Some(|_, path| Box::new(TextSink::new(json::Rows::default(), path))),
    },
    Row {
        format: Format::Gra,
        name: "gra",
        read: Some(gra::read),
        sink: Some(|_, path| Box::new(TextSink::new(gra::Frames::default(), path))),
    },
    Row {
        format: Format::Req,
        name: "req",
        read: Some(req::read),
        sink: Some(|_, path| Box::new(TextSink::new(req::Components, path))),
    },
    Row {
        format: Format::Msg,
        name: "msg",
        read: Some(msg_table::read),
        sink: None,
    },
];

impl Format {
    /// Returns the row of a name; `None`: there is no such format, or it is not built in.
    pub fn row(name: &str) -> Option<&'static Row> {
        FORMATS.iter().find(|row| row.name == name)
    }
    /// Returns the names of those formats that are written, or of those that are read.
    pub fn names(written: bool) -> Vec<&'static str> {
        let does = |row: &&Row| match written {
            true => row.sink.is_some(),
            false => row.read.is_some(),
        };
        FORMATS.iter().filter(does).map(|row| row.name).collect()
    }
}

/// The choices of a user about the look of tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// a row of units below the names
    pub units: bool,
    /// a comma in numbers, and `;` between them
    pub decimal_comma: bool,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            units: true,
            decimal_comma: false,
        }
    }
}

impl Style {
    /// Returns the character between cells.
    pub fn separator(self) -> u8 {
        if self.decimal_comma { b';' } else { b',' }
    }
}

/// A text that a table becomes, written in order as rows come.
pub trait TableText: Send {
    /// Appends everything before the first row.
    fn begin(&mut self, run: &Run, text: &mut Vec<u8>);
    /// Appends rows, all of which the run holds; calls come in the order of the rows.
    fn rows(&mut self, run: &Run, rows: Range<usize>, text: &mut Vec<u8>);
    /// Appends everything after the last row.
    fn end(&mut self, run: &Run, text: &mut Vec<u8>);
}

/// Returns the whole text of a run that holds all of its rows.
pub fn text(table: &mut dyn TableText, run: &Run) -> String {
    let mut text = Vec::new();
    table.begin(run, &mut text);
    table.rows(run, run.held(), &mut text);
    table.end(run, &mut text);
    String::from_utf8(text).unwrap_or_else(|e| String::from_utf8_lossy(e.as_bytes()).into_owned())
}

/// A file that is being written while its run goes on.
///
/// Rows come in order, each once. Whatever the calls of [`Sink::flush`], the file is the same in
/// the end.
pub trait Sink: Send {
    /// Takes rows, all of which the run holds.
    ///
    /// # Errors
    /// When they cannot be written.
    fn rows(&mut self, run: &Run, rows: Range<usize>) -> Result<(), Diagnostic>;
    /// Writes what has been taken to a part of the file, where it can be read whatever becomes of
    /// this process.
    ///
    /// # Errors
    /// When it cannot be written.
    fn flush(&mut self, run: &Run) -> Result<(), Diagnostic>;
    /// Completes the file beside its place.
    ///
    /// # Errors
    /// When it cannot be written.
    fn finish(&mut self, run: &Run) -> Result<Finished, Diagnostic>;
}

/// A complete file, still beside its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Finished {
    /// where it is
    pub part: PathBuf,
    /// its size
    pub bytes: u64,
}
