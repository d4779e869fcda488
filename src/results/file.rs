//! Files of results: the extension of the name tells the format.

use super::format::{Finished, Format, Reader, Style};
use super::part_file::{PartFile, create_beside, unwritable};
use super::{Run, msg};
use crate::arrange::Arrange;
use crate::diagnostic::Diagnostic;
use crate::disk;
use crate::encoding::as_utf8;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Reads a file of results; its name tells the format, one of [`Format`] that can be read.
///
/// # Errors
/// When the file cannot be read, its format is none of these, or its contents are not of that
/// format.
pub fn read(path: &Path) -> Result<Run, Diagnostic> {
    let file = disk::text(&path);
    let in_file = |mut d: Diagnostic| {
        d.file.get_or_insert(file.clone());
        d
    };
    let extension = extension(&whole_name(path));
    let reader = Format::row(&extension).and_then(|row| row.read);
    let reader = reader.ok_or_else(|| {
        let known = format!(
            "formats that can be read: {}",
            Format::names(false).join(", ")
        );
        let unknown = unknown_format(&extension, &known);
        in_file(match extension.as_str() {
            "adm" | "acf" => unknown.help("a model has results once it has been run: cognate run"),
            _ => unknown,
        })
    })?;
    let mut run = if disk::is_folder(path) {
        read_parts(path, &extension, reader)
    } else {
        contents(path).and_then(|bytes| reader(&text(&extension, bytes)))
    }
    .map_err(in_file)?;
    if whole_name(path) != path {
        run.note_cut();
    }
    for doubt in &mut run.record.doubts {
        doubt.file.get_or_insert_with(|| file.clone());
    }
    run.find_bars();
    if run.name.is_empty() {
        run.name = path.file_stem().map(|s| disk::text(&s)).unwrap_or_default();
    }
    Ok(run)
}

/// Returns the contents of a file of text as UTF-8; of others as they are. A character that is cut
/// off at the end is left out: it would be taken for a sign of another encoding.
fn text(extension: &str, mut bytes: Vec<u8>) -> Vec<u8> {
    if extension == "parquet" {
        return bytes;
    }
    if let Err(e) = std::str::from_utf8(&bytes)
        && e.error_len().is_none()
    {
        bytes.truncate(e.valid_up_to());
    }
    as_utf8(bytes)
}

fn contents(path: &Path) -> Result<Vec<u8>, Diagnostic> {
    disk::read_results(path).map_err(|e| {
        let mut d = Diagnostic::error("file_unreadable", format!("cannot be read: {e}"));
        d.file = Some(disk::text(&path));
        d
    })
}

/// Reads the folder of parts that a run has left which was ended from outside, as one table.
fn read_parts(folder: &Path, extension: &str, reader: Reader) -> Result<Run, Diagnostic> {
    let unreadable =
        |e: std::io::Error| Diagnostic::error("file_unreadable", format!("cannot be read: {e}"));
    let entries = disk::read_dir(folder).map_err(unreadable)?;
    let entries = entries.map(|entry| entry.map(|e| e.path()));
    let mut parts = entries.collect::<Result<Vec<_>, _>>().map_err(unreadable)?;
    parts.retain(|part| self::extension(part) == extension);
    parts.arrange();
    let mut whole: Option<Run> = None;
    for part in parts {
        let run = reader(&contents(&part)?)?;
        match &mut whole {
            Some(whole) => whole.append(run),
            None => whole = Some(run),
        }
    }
    whole.ok_or_else(|| Diagnostic::error("result_syntax", "there are no parts in this folder"))
}

/// Returns the name that a part of a file is to have in the end: `run.csv` for `run.csv.part1`.
fn whole_name(path: &Path) -> PathBuf {
    let is_part = extension(path)
        .strip_prefix("part")
        .is_some_and(|number| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()));
    if is_part {
        path.with_extension("")
    } else {
        path.to_owned()
    }
}

/// Writes a run to a file; its name tells the format: one of [`Format`] that can be written, or
/// `.msg`.
///
/// # Errors
/// When the file cannot be written, or its format is none of these.
pub fn write(run: &Run, path: &Path, style: Style) -> Result<(), Diagnostic> {
    let finished = write_beside(run, path, style)?;
    disk::rename(&finished.part, path).map_err(|e| {
        // a rest that cannot be removed either adds nothing to say
        let _ = disk::remove_file(&finished.part);
        unwritable(path, &e)
    })
}

/// Writes a run beside the place of a file, in the format of its name.
pub(super) fn write_beside(run: &Run, path: &Path, style: Style) -> Result<Finished, Diagnostic> {
    let extension = extension(path);
    if extension == "msg" {
        let mut part = PartFile::new(path);
        part.append(msg::write(run).as_bytes())?;
        return part.finish();
    }
    let sink = Format::row(&extension).and_then(|row| row.sink);
    let sink = sink.ok_or_else(|| {
        let names = Format::names(true).join(", ");
        let known = format!("formats that can be written: {names}, msg");
        unknown_format(&extension, &known)
    })?;
    let mut sink = sink(style, path);
    sink.rows(run, run.held())?;
    sink.finish(run)
}

/// Writes a text to a file, all or nothing.
///
/// The text is written beside the file, which is then renamed: no reader meets half a file.
///
/// # Errors
/// When the file cannot be written.
pub fn write_text(path: &Path, text: &str) -> Result<(), Diagnostic> {
    write_bytes(path, text.as_bytes())
}

/// Writes bytes to a file, all or nothing, as [`write_text`] does.
///
/// # Errors
/// When the file cannot be written.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
    let (part, mut file) = create_beside(path).map_err(|e| unwritable(path, &e))?;
    let written = file
        .write_all(bytes)
        .and_then(|()| disk::rename(&part, path));
    written.map_err(|e| {
        // a rest that cannot be removed either adds nothing to say
        let _ = disk::remove_file(&part);
        unwritable(path, &e)
    })
}

fn extension(path: &Path) -> String {
    path.extension()
        .map(|e| disk::text(&e).to_lowercase())
        .unwrap_or_default()
}

fn unknown_format(given: &str, known: &str) -> Diagnostic {
    let message = if given.is_empty() {
        "the file name has no extension".into()
    } else {
        format!("no result format `.{given}`")
    };
    Diagnostic::error("result_format", message).help(known)
}
