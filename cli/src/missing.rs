//! Mistakes of commands whose dataset is not there.

use super::{Exit, Failure};
use cognate::dataset::command::Script;
use cognate::diagnostic::Diagnostic;
use cognate::disk;
use std::path::Path;

/// Returns the mistake of commands that name no dataset, where none is given beside them.
pub fn names_no_dataset(path: &Path) -> Diagnostic {
    let what = format!("{} names no dataset", path.display());
    Diagnostic::error("no_model", what)
        .help("begin it with FILE/MODEL=name, or give the dataset behind the command file")
}

/// Creates the failure for a missing dataset of a command file: names the line, and the files that
/// may be meant.
pub fn missing(script: &Script, path: &Path, file: &Path) -> Failure {
    let name = script.model.as_deref().unwrap_or_default();
    let mut d = Diagnostic::error(
        "cannot_open",
        format!("there is no dataset {}", disk::text(&file)),
    );
    d.file = Some(disk::text(&path));
    if !script.answered {
        return Failure::in_files(Exit::Input, vec![d]);
    }
    (d.line, d.column) = (1, 1);
    let d = match name.split_once('=') {
        Some((_, model)) => d.help(format!("FILE/MODEL={} is meant?", model.trim())),
        None => d,
    };
    let d = d.help(
        "a first line that is no command is taken as the name of the dataset; the command is FILE/MODEL=name",
    );
    Failure::in_files(Exit::Input, vec![d])
}
