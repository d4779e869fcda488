//! Standard input and standard output in the place of files: `-`, or with its format, `csv:-`.
//!
//! A command reads what came through the pipe as a file `stdin.csv`, and writes a file in a folder
//! of its own, which goes to standard output when the command is done: nobody is sent half a table.

use super::{Failure, say_bytes};
use clap::builder::{OsStringValueParser, TypedValueParser};
use cognate::diagnostic::{Cause, Diagnostic};
use cognate::disk;
use cognate::results::format::{FORMATS, Format};
use std::ffi::OsStr;
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Most bytes that are read from standard input: what a file may have, too.
const MOST_BYTES: u64 = 2 << 30;

/// Why a folder is none.
pub const SEVERAL: &str = "several files are written: this is a folder for them";
/// Why the table of a sweep is no pipe.
pub const GROWS: &str = "a sweep that is cut goes on with its table: this is a file";

/// The pipes that the arguments name.
#[derive(Clone)]
struct Pipes {
    /// the file that standard input is read as
    input: Option<PathBuf>,
    /// the file, or the folder of a run, whose contents go to standard output
    output: Option<Output>,
}

/// A file that goes to standard output.
#[derive(Clone)]
struct Output {
    /// the folder that holds it alone
    folder: PathBuf,
    /// its name, or the end of it
    ending: String,
}

static PIPES: Mutex<Pipes> = Mutex::new(Pipes {
    input: None,
    output: None,
});

fn pipes() -> MutexGuard<'static, Pipes> {
    PIPES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Reads the argument of a model: a file, or `-` for a dataset from standard input.
pub fn model() -> impl TypedValueParser<Value = PathBuf> {
    input("adm")
}

/// Reads the argument of results: a file, or `-` for a table from standard input.
pub fn results() -> impl TypedValueParser<Value = PathBuf> {
    input("csv")
}

fn input(usual: &'static str) -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(move |text| -> Result<PathBuf, String> {
        let Some(format) = format_of(&text, usual) else {
            return Ok(text.into());
        };
        let known: Vec<&str> = Format::names(false).into_iter().chain(MODELS).collect();
        if !known.contains(&format) {
            return Err(format!(
                "`{format}` is no format that is read: {}",
                known.join(", ")
            ));
        }
        let file = PathBuf::from(format!("stdin.{format}"));
        match pipes().input.replace(file.clone()) {
            None => Ok(file),
            Some(_) => Err("standard input is one file, and is named twice".into()),
        }
    })
}

/// Formats of models.
const MODELS: [&str; 3] = ["adm", "acf", "cmd"];

/// Reads the argument of a file to write: a file, or `-` for standard output in the usual format,
/// which others may stand in for (`json:-`).
pub fn output(usual: &'static str) -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(move |text| -> Result<PathBuf, String> {
        match format_of(&text, usual) {
            None => Ok(text.into()),
            Some(format) => Ok(to_standard_output(format!("stdout.{format}"))?.1),
        }
    })
}

/// Reads the argument of a folder for the files of a run: a folder, or `-` for its table on
/// standard output, as .csv if no format stands before it.
pub fn run_folder() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|text| -> Result<PathBuf, String> {
        let Some(name) = format_of(&text, "csv") else {
            return Ok(text.into());
        };
        let row = Format::row(name).filter(|row| row.sink.is_some());
        let known = || Format::names(true).join(", ");
        let row =
            row.ok_or_else(|| format!("`{name}` is no format that is written: {}", known()))?;
        Ok(to_standard_output(table_ending(row.format))?.0)
    })
}

/// Returns the end of the name that the table of a run has.
fn table_ending(format: Format) -> String {
    let row = FORMATS.iter().find(|row| row.format == format);
    super::output::table_name("", row.map_or("", |row| row.name))
}

/// Reads the argument of something that standard output cannot take, and says why.
pub fn refused(why: &'static str) -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(move |text| match format_of(&text, "") {
        None => Ok(PathBuf::from(text)),
        Some(_) => Err(why),
    })
}

/// Returns the format of `-` or `csv:-`; `None` for the name of a file.
fn format_of<'a>(text: &'a OsStr, usual: &'a str) -> Option<&'a str> {
    match text.to_str()? {
        "-" => Some(usual),
        text => {
            let is_name = |format: &&str| format.chars().all(|c| c.is_ascii_lowercase());
            text.strip_suffix(":-").filter(is_name)
        }
    }
}

/// Notes a file that goes to standard output, by its name or the end of it; returns its folder and
/// the file.
fn to_standard_output(ending: String) -> Result<(PathBuf, PathBuf), String> {
    let new = RandomState::new().build_hasher().finish();
    let folder = std::env::temp_dir().join(format!("cognate-{new:016x}"));
    let file = folder.join(&ending);
    let output = Output {
        folder: folder.clone(),
        ending,
    };
    match pipes().output.replace(output) {
        None => Ok((folder, file)),
        Some(_) => Err("standard output is one file, and is named twice".into()),
    }
}

/// Reads standard input if an argument names it, and makes the folder for what goes to standard
/// output.
///
/// # Errors
/// When standard input cannot be read or is too long, or the folder cannot be made.
pub fn begin() -> Result<(), Failure> {
    let Pipes { input, output } = pipes().clone();
    if let Some(file) = input {
        let unreadable = |what: String| {
            let what = format!("standard input {what}");
            Failure::from(Diagnostic::error("file_unreadable", what))
        };
        let mut bytes = Vec::new();
        let read = std::io::stdin()
            .lock()
            .take(MOST_BYTES)
            .read_to_end(&mut bytes);
        read.map_err(|e| unreadable(format!("cannot be read: {e}")))?;
        if bytes.len() as u64 == MOST_BYTES {
            return Err(unreadable("has more than 2 GB".into()));
        }
        disk::give(file, bytes);
    }
    if let Some(Output { folder, .. }) = output {
        let mut new = std::fs::DirBuilder::new();
        #[cfg(unix)]
        std::os::unix::fs::DirBuilderExt::mode(&mut new, 0o700);
        // it must be new: nobody else has put anything there
        new.create(&folder).map_err(|e| {
            let what = format!("{}: no folder can be made: {e}", folder.display());
            Diagnostic::error(Cause::FileUnwritable, what)
        })?;
    }
    Ok(())
}

/// Sends what was written for it to standard output, whatever became of the command, and removes
/// it.
pub fn end() {
    let Some(Output { folder, ending }) = pipes().output.take() else {
        return;
    };
    let files = std::fs::read_dir(&folder).into_iter().flatten().flatten();
    let mut files = files.map(|entry| entry.path());
    let is_it = |file: &PathBuf| {
        let name = file.file_name().unwrap_or_default();
        name.to_string_lossy().ends_with(&ending)
    };
    let bytes = files.find(is_it).map(std::fs::read);
    // what cannot be removed lies among temporary files
    let _ = std::fs::remove_dir_all(&folder);
    match bytes {
        Some(Ok(bytes)) => say_bytes(&bytes),
        Some(Err(e)) => super::remark(format!("what was written cannot be read: {e}")),
        None => {}
    }
}

/// Returns whether what is written to a file, or a folder, goes to standard output.
pub fn is_output(place: &Path) -> bool {
    let pipes = pipes();
    (pipes.output.as_ref()).is_some_and(|output| place.starts_with(&output.folder))
}

/// Returns the format of the one table that a run writes for standard output, if its folder is
/// that: the one that `--format` names, else that of `-o`.
///
/// # Errors
/// Several formats.
pub fn run_format(folder: Option<&Path>, asked: &[Format]) -> Result<Option<Format>, Failure> {
    if !folder.is_some_and(is_output) {
        return Ok(None);
    }
    let mut pipes = pipes();
    let Some(output) = &mut pipes.output else {
        return Ok(None);
    };
    let own = FORMATS
        .iter()
        .find(|row| table_ending(row.format) == output.ending);
    match (asked, own) {
        ([], Some(own)) => Ok(Some(own.format)),
        ([one], Some(own)) if *one == own.format || own.format == Format::Csv => {
            output.ending = table_ending(*one);
            Ok(Some(*one))
        }
        _ => Err(Failure::usage(
            "standard output takes one table: one --format, or as json:-",
        )),
    }
}

/// Returns a message with the names that a user knows: standard output is no file.
pub fn named(message: String) -> String {
    let Some(Output { folder, ending }) = pipes().output.clone() else {
        return message;
    };
    let file = folder.join(ending).display().to_string();
    message.replace(&file, "standard output")
}
