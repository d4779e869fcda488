//! Files of results: the extension of the name tells the format.

use super::{Run, csv, gra, json, msg, res};
use crate::diagnostic::{Cause, Diagnostic};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Reads a file of results; its name tells the format: `.res`, `.gra` or `.csv`.
///
/// # Errors
/// When the file cannot be read, its format is none of these, or its contents are not of that
/// format.
pub fn read(path: &Path) -> Result<Run, Diagnostic> {
    let file = path.display().to_string();
    let in_file = |mut d: Diagnostic| {
        d.file.get_or_insert(file.clone());
        d
    };
    let bytes = std::fs::read(path).map_err(|e| {
        in_file(Diagnostic::error(
            "file_unreadable",
            format!("cannot be read: {e}"),
        ))
    })?;
    let mut run = match extension(path).as_str() {
        "res" => res::read(&bytes),
        "gra" => gra::read(&bytes),
        "csv" => csv::read(&bytes),
        other => Err(unknown_format(
            other,
            "formats that can be read: res, gra, csv",
        )),
    }
    .map_err(in_file)?;
    if run.name.is_empty() {
        run.name = path
            .file_stem()
            .map(|s| s.to_string_lossy().into_owned())
            .unwrap_or_default();
    }
    Ok(run)
}

/// Writes a run to a file; its name tells the format: `.csv`, `.json`, `.res` or `.msg`.
///
/// # Errors
/// When the file cannot be written, or its format is none of these.
pub fn write(run: &Run, path: &Path) -> Result<(), Diagnostic> {
    let text = match extension(path).as_str() {
        "csv" => csv::write(run, true),
        "json" => json::document(run),
        "res" => res::write(run),
        "msg" => msg::write(run),
        other => {
            let known = "formats that can be written: csv, json, res, msg";
            return Err(unknown_format(other, known));
        }
    };
    write_text(path, &text)
}

/// Writes a text to a file, all or nothing.
///
/// The text is written beside the file, which is then renamed: no reader meets half a file.
///
/// # Errors
/// When the file cannot be written.
pub fn write_text(path: &Path, text: &str) -> Result<(), Diagnostic> {
    let beside = |k: u32| {
        let mut name = path.as_os_str().to_owned();
        name.push(format!(".part{k}"));
        PathBuf::from(name)
    };
    // a file of that name is somebody's
    let beside = (1..).map(beside).find(|p| p.symlink_metadata().is_err());
    let beside = beside.unwrap_or_else(|| path.to_owned());
    let written = std::fs::File::create_new(&beside)
        .and_then(|mut file| file.write_all(text.as_bytes()))
        .and_then(|()| std::fs::rename(&beside, path));
    written.map_err(|e| {
        // a rest that cannot be removed either adds nothing to say
        let _ = std::fs::remove_file(&beside);
        let mut d = Diagnostic::error(Cause::FileUnwritable, format!("cannot be written: {e}"));
        d.file = Some(path.display().to_string());
        d
    })
}

fn extension(path: &Path) -> String {
    path.extension()
        .map(|e| e.to_string_lossy().to_lowercase())
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
