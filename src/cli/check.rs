//! `cognate check`: the mistakes in datasets and command files, without running them.

use super::render::{self, Sources};
use super::{Exit, Failure, Outcome, complain, remark, say};
use crate::dataset::command::Script;
use crate::dataset::{self, Errors, Reading};
use crate::diagnostic::{Diagnostic, Severity};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Find what is wrong with datasets and command files
///
/// All mistakes of all files at once, each with its place, its element and advice. Exit code 3 when
/// there is an error; warnings alone are no failure.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate check model.adm
  cognate check models/*.adm run.acf --json")]
pub struct Args {
    /// Datasets (.adm) and command files (.acf)
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Print the findings as JSON on standard output
    #[arg(long)]
    json: bool,
}

/// Checks the files and prints their mistakes and warnings.
pub fn run(args: &Args) -> Outcome {
    let mut all = Vec::new();
    let mut sources = Sources::default();
    for file in &args.files {
        let ending = file.extension().map(|e| e.to_ascii_lowercase());
        match ending.as_deref().and_then(std::ffi::OsStr::to_str) {
            Some("acf") => all.extend(check_script(file)),
            _ => match dataset::read(file) {
                Ok(reading) => {
                    add(&mut sources, &reading);
                    all.extend(reading.diagnostics);
                }
                Err(errors) => all.extend(errors.0),
            },
        }
    }
    let count = |s: Severity| all.iter().filter(|d| d.severity == s).count();
    let (errors, warnings) = (count(Severity::Error), count(Severity::Warning));
    if args.json {
        let findings = render::as_json(&all);
        say(&format!(
            "{:#}\n",
            json!({ "errors": errors, "warnings": warnings, "findings": findings })
        ));
    } else {
        complain(&all, &sources);
        remark(format!(
            "{} in {}",
            tally(errors, warnings),
            number(args.files.len(), "file")
        ));
    }
    Ok(if errors > 0 { Exit::Input } else { Exit::Done })
}

/// Checks a command file, and the effect of its commands on the model it names.
fn check_script(file: &Path) -> Vec<Diagnostic> {
    let script = match Script::read(file) {
        Ok(script) => script,
        Err(errors) => return errors.0,
    };
    let mut all = script.diagnostics.clone();
    let Some(model) = script.model_file() else {
        return all;
    };
    match dataset::read(&model) {
        Ok(reading) => {
            let mut model = reading.model;
            for step in &script.steps {
                let Err(errors) = model.apply(&step.command) else {
                    continue;
                };
                all.extend(errors.0.into_iter().map(|d| Diagnostic {
                    file: Some(file.display().to_string()),
                    line: step.line,
                    column: 1,
                    ..d
                }));
            }
        }
        Err(errors) => all.extend(errors.0),
    }
    all
}

fn number(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn tally(errors: usize, warnings: usize) -> String {
    match (errors, warnings) {
        (0, 0) => "nothing wrong".into(),
        _ => format!(
            "{}, {}",
            number(errors, "error"),
            number(warnings, "warning")
        ),
    }
}

/// Returns the texts of a dataset, for excerpts.
pub fn sources(reading: &Reading) -> Sources {
    let mut sources = Sources::default();
    add(&mut sources, reading);
    sources
}

fn add(sources: &mut Sources, reading: &Reading) {
    let source = &reading.dataset.source;
    sources.add(source.file.clone().unwrap_or_default(), source.text.clone());
}

/// Turns mistakes of a file into the failure of a command.
pub fn failure(errors: Errors) -> Failure {
    Failure {
        exit: Exit::Input,
        diagnostics: errors.0,
        sources: Sources::default(),
    }
}
