//! `cognate check`: the mistakes in datasets and command files, without running them.

use super::foreseen::Foreseen;
use super::render::Sources;
use super::setup::{self, Asked};
use super::{Exit, Failure, Outcome, complain, piped, remark, say};
use cognate::dataset::command::{Command, Script};
use cognate::dataset::{self, Reading};
use cognate::diagnostic::{Diagnostic, Error, Severity, counted};
use cognate::disk;
use cognate::model::Model;
use serde_json::json;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Find what is wrong with datasets and command files
///
/// All mistakes of all files at once, each with its place, its element and advice. A model without
/// mistakes is assembled as a run would do it, and what that refuses or doubts is told; nothing is
/// solved. What cannot be looked at is named. The last line says whether a run will begin, or where
/// it will stop. Exit code 3 when a file has an error, 4 when the model does; warnings, and what
/// is not solved here, are no failure.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate check model.adm
  cognate check models/*.adm run.acf --json")]
pub struct Args {
    /// Datasets (.adm) and command files (.acf); - reads a dataset from standard input
    #[arg(required = true, value_parser = piped::model())]
    files: Vec<PathBuf>,
    /// Print the findings as JSON on standard output
    #[arg(long)]
    json: bool,
}

/// Checks the files and prints their mistakes and warnings, and what a run of each will say.
pub fn run(args: &Args) -> Outcome {
    let mut sources = Sources::default();
    let mut told: BTreeSet<PathBuf> = args.files.iter().cloned().collect();
    let looks = args.files.iter().map(|file| {
        let ending = file.extension().map(|e| e.to_ascii_lowercase());
        match ending.as_deref().and_then(std::ffi::OsStr::to_str) {
            Some("acf") => check_script(file, &mut sources, &mut told),
            _ => check_dataset(file, &mut sources),
        }
    });
    let looks: Vec<Foreseen> = looks.collect();
    let all: Vec<Diagnostic> = looks.iter().flat_map(|l| l.found.iter().cloned()).collect();
    let count = |s: Severity| all.iter().filter(|d| d.severity == s).count();
    let counts = [Severity::Error, Severity::Warning, Severity::Note].map(count);
    let [errors, warnings, _] = counts;
    if args.json {
        let findings = cognate::results::json::findings(&all);
        let runs = args
            .files
            .iter()
            .zip(&looks)
            .map(|(file, look)| look.json(file));
        say(&format!(
            "{:#}\n",
            json!({
                "errors": errors,
                "warnings": warnings,
                "findings": findings,
                "runs": runs.collect::<Vec<_>>(),
            })
        ));
    } else {
        complain(&all, &sources);
        let is_whole = looks.iter().all(|look| look.stop.is_none());
        remark(format!(
            "{} in {}",
            tally(counts, is_whole),
            counted(looks.len(), "file")
        ));
        for (file, look) in args.files.iter().zip(&looks) {
            let name = match looks.len() {
                1 => String::new(),
                _ => format!("{}: ", file.display()),
            };
            (look.sentences().iter()).for_each(|line| remark(format!("{name}{line}")));
        }
    }
    Ok(match errors {
        0 => Exit::Done,
        _ if looks.iter().any(|look| look.model_fails) => Exit::Model,
        _ => Exit::Input,
    })
}

/// Returns the model with the loads and functions of the file beside its dataset, and the mistakes
/// in that file; with mistakes, the model is that of the dataset.
fn set_up(reading: &Reading, dataset: &Path, sources: &mut Sources) -> (Model, Vec<Diagnostic>) {
    let mut model = reading.model.clone();
    match setup::prepare(dataset, &mut model, Asked::Kept) {
        Ok(_) => (model, Vec::new()),
        Err(failure) => {
            let file = dataset.with_extension("toml");
            if let Ok(text) = std::fs::read_to_string(&file) {
                sources.add(disk::text(&file), text);
            }
            (reading.model.clone(), failure.diagnostics)
        }
    }
}

/// Checks a dataset, with the file beside it.
fn check_dataset(file: &Path, sources: &mut Sources) -> Foreseen {
    let reading = match dataset::read(file) {
        Ok(reading) => reading,
        Err(error) => return Foreseen::of_file(error.into()),
    };
    add(sources, &reading);
    let (model, mistaken) = set_up(&reading, file, sources);
    let begun = Foreseen::of_model(&reading, &model, file, None);
    let mut look = Foreseen::of_file(reading.diagnostics);
    look.append(Foreseen::of_file(mistaken));
    look.append(begun);
    look
}

/// Checks a command file, and the effect of its commands on the model it names; `told`: datasets
/// that are spoken of elsewhere.
fn check_script(file: &Path, sources: &mut Sources, told: &mut BTreeSet<PathBuf>) -> Foreseen {
    let script = match Script::read(file) {
        Ok(script) => script,
        Err(error) => return Foreseen::of_file(error.into()),
    };
    let mut look = Foreseen::of_file(script.diagnostics.clone());
    let Some(path) = script.model_file() else {
        // that is no mistake: the dataset may be given beside the commands, or be in a saved state
        let first = script.steps.first().map(|step| &step.command);
        if !matches!(first, Some(Command::Reload(Some(_)))) {
            look.stop = look
                .stop
                .or_else(|| Some(super::missing::names_no_dataset(file)));
        }
        return look;
    };
    let reading = match dataset::read(&path) {
        Ok(reading) => reading,
        Err(error) => {
            look.append(Foreseen::of_file(error.into()));
            return look;
        }
    };
    add(sources, &reading);
    let (mut model, mistaken) = set_up(&reading, &path, sources);
    look.append(Foreseen::of_file(mistaken));
    let mut begun = false;
    for step in &script.steps {
        if let Command::Simulate(simulate) = &step.command
            && !std::mem::replace(&mut begun, true)
        {
            look.append(Foreseen::of_model(&reading, &model, &path, Some(simulate)));
        }
        let Err(errors) = model.apply(&step.command) else {
            continue;
        };
        let errors = errors.into_iter().map(|d| Diagnostic {
            file: Some(disk::text(&file)),
            line: step.line,
            column: 1,
            ..d
        });
        look.append(Foreseen::of_file(errors.collect()));
    }
    // its mistakes stop a run, whoever tells them
    let mut read = Foreseen::of_file(reading.diagnostics.clone());
    if !told.insert(path) && !reading.failed() {
        read.found.clear();
    }
    look.append(read);
    look
}

fn tally([errors, warnings, notes]: [usize; 3], is_whole: bool) -> String {
    let nothing = match is_whole {
        true => "nothing wrong",
        false => "no mistake",
    };
    match (errors, warnings) {
        (0, 0) if notes > 0 => format!("{nothing}, {}", counted(notes, "note")),
        (0, 0) => nothing.into(),
        _ => format!(
            "{}, {}",
            counted(errors, "error"),
            counted(warnings, "warning")
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
    sources.add(source.file.clone().unwrap_or_default(), source.own_text());
    for file in source.included() {
        if let Ok(included) = dataset::open(disk::path(file)) {
            sources.add(file, included.text);
        }
    }
}

/// Turns mistakes of a file into the failure of a command.
pub fn failure(error: Error) -> Failure {
    Failure {
        exit: Exit::Input,
        diagnostics: error.into(),
        sources: Sources::default(),
    }
}
