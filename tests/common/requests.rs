//! Reference problems by their names, and what the requests of a model ask for.
#![allow(dead_code)] // each binary uses its own part

use cognate::model::{Formula, Model, RequestKind};
use std::path::Path;

/// The expressions of the requests of a model.
pub fn expressions(model: &Model) -> Vec<String> {
    let mut all = Vec::new();
    for request in model.requests.values() {
        if let RequestKind::Functions(functions) = &request.kind {
            for f in functions.iter().flatten() {
                if let Formula::Expression { text, .. } = f {
                    all.push(text.to_string());
                }
            }
        }
    }
    all
}

/// The names of the problems of a folder, in order: command files that have a trusted table beside them.
pub fn problems(folder: &Path) -> Vec<String> {
    let files = std::fs::read_dir(folder).expect("the references");
    let names = files.filter_map(|file| {
        let path = file.ok()?.path();
        let is_commands = path.extension()? == "acf" && path.with_extension("csv").exists();
        is_commands.then(|| path.file_stem().map(|s| s.to_string_lossy().into_owned()))?
    });
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}
