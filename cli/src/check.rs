//! `cognate check`: the mistakes in datasets and command files, without running them.

use super::render::Sources;
use super::setup::{self, Asked};
use super::{Exit, Failure, Outcome, complain, remark, say};
use cognate::analysis::session::{Analysis, Options, Session};
use cognate::dataset::command::{Command, Script, Simulate};
use cognate::dataset::{self, Reading};
use cognate::diagnostic::{Cause, Diagnostic, Error, Severity};
use cognate::model::{ElementKind, Model};
use serde_json::json;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Find what is wrong with datasets and command files
///
/// All mistakes of all files at once, each with its place, its element and advice. A model without
/// mistakes is assembled as a run would do it, and what that refuses or doubts is told; nothing is
/// solved. Exit code 3 when a file has an error, 4 when the model does; warnings alone are no
/// failure.
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
    let mut model_fails = false;
    let mut told: BTreeSet<PathBuf> = args.files.iter().cloned().collect();
    for file in &args.files {
        let ending = file.extension().map(|e| e.to_ascii_lowercase());
        match ending.as_deref().and_then(std::ffi::OsStr::to_str) {
            Some("acf") => all.extend(check_script(
                file,
                &mut sources,
                &mut told,
                &mut model_fails,
            )),
            _ => match dataset::read(file) {
                Ok(reading) => {
                    add(&mut sources, &reading);
                    let (model, mistaken) = set_up(&reading, file, &mut sources);
                    let begun = assembled(&reading, model, file, None);
                    model_fails |= begun.iter().any(is_error);
                    all.extend(reading.diagnostics);
                    all.extend(mistaken);
                    all.extend(begun);
                }
                Err(error) => all.extend(error),
            },
        }
    }
    let count = |s: Severity| all.iter().filter(|d| d.severity == s).count();
    let (errors, warnings) = (count(Severity::Error), count(Severity::Warning));
    if args.json {
        let findings = cognate::results::json::findings(&all);
        say(&format!(
            "{:#}\n",
            json!({ "errors": errors, "warnings": warnings, "findings": findings })
        ));
    } else {
        complain(&all, &sources);
        remark(format!(
            "{} in {}",
            tally(errors, warnings, count(Severity::Note)),
            number(args.files.len(), "file")
        ));
    }
    Ok(match (errors, model_fails) {
        (0, _) => Exit::Done,
        (_, true) => Exit::Model,
        (_, false) => Exit::Input,
    })
}

fn is_error(d: &Diagnostic) -> bool {
    d.severity == Severity::Error
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
                sources.add(file.display().to_string(), text);
            }
            (reading.model.clone(), failure.diagnostics)
        }
    }
}

/// Time up to which motions are looked at where no command says when the run ends.
const HORIZON: f64 = 10.0;

/// Reasons why a model is not solved, or not as it is meant, that are no mistakes in it.
const NOT_SOLVED_HERE: [Cause; 5] = [
    Cause::Unsupported,
    Cause::UserRoutine,
    Cause::CurveData,
    Cause::Skipped,
    Cause::Approximate,
];

/// Finds what a run would refuse or doubt before its first step, of a model as commands leave it
/// before their first simulation; nothing where the dataset has mistakes.
fn assembled(
    reading: &Reading,
    model: Model,
    file: &Path,
    simulate: Option<&Simulate>,
) -> Vec<Diagnostic> {
    if reading.failed() {
        return Vec::new();
    }
    let (analysis, end) = match simulate.map(|s| s.resolved(0.0)) {
        Some(Ok((analysis, end, _))) => (analysis, end),
        Some(Err(error)) => return error.into(),
        None => (Analysis::Transient, HORIZON),
    };
    let begin = |options: Options| {
        let mut session = Session::new(model.clone(), "check", options);
        session.folders = file.parent().map(Path::to_path_buf).into_iter().collect();
        session.preview(analysis, end)
    };
    let mut found = begin(Options {
        named_only: true,
        ..Options::default()
    });
    let ours = |d: &Diagnostic| d.is_any(&NOT_SOLVED_HERE);
    if found.iter().any(|d| is_error(d) && ours(d)) {
        // told, and left out to see the rest
        let unsolved = ElementKind::ALL.iter().copied().filter(|k| k.is_unsolved());
        let rest = begin(Options {
            zero_user: true,
            skip: unsolved.collect(),
            named_only: true,
            ..Options::default()
        });
        found.retain(|d| ours(d) || is_error(d));
        let new = rest.into_iter().filter(|d| !ours(d));
        found.extend(new);
    }
    for d in found.iter_mut().filter(|d| ours(d)) {
        d.severity = Severity::Note;
    }
    // where something cannot be, that comes before what is doubted
    let doubts = model.doubts();
    if found.iter().any(is_error) {
        found.extend(doubts);
    } else {
        found.splice(0..0, doubts);
    }
    found.dedup();
    // the reader has told, with more advice, what can be seen without assembly
    let told = |d: &Diagnostic| {
        let what = |d: &Diagnostic| (d.code, d.subject(), d.argument);
        reading.diagnostics.iter().any(|r| what(r) == what(d))
    };
    found.retain(|d| !told(d));
    (found.into_iter().map(|d| reading.dataset.locate(d))).collect()
}

/// Checks a command file, and the effect of its commands on the model it names; `told`: datasets
/// that are spoken of elsewhere.
fn check_script(
    file: &Path,
    sources: &mut Sources,
    told: &mut BTreeSet<PathBuf>,
    model_fails: &mut bool,
) -> Vec<Diagnostic> {
    let script = match Script::read(file) {
        Ok(script) => script,
        Err(error) => return error.into(),
    };
    let mut all = script.diagnostics.clone();
    let Some(path) = script.model_file() else {
        return all;
    };
    let reading = match dataset::read(&path) {
        Ok(reading) => reading,
        Err(errors) => {
            all.extend(errors);
            return all;
        }
    };
    add(sources, &reading);
    let (mut model, mistaken) = set_up(&reading, &path, sources);
    all.extend(mistaken);
    let mut begun = false;
    for step in &script.steps {
        if let Command::Simulate(simulate) = &step.command
            && !std::mem::replace(&mut begun, true)
        {
            let found = assembled(&reading, model.clone(), &path, Some(simulate));
            *model_fails |= found.iter().any(is_error);
            all.extend(found);
        }
        let Err(errors) = model.apply(&step.command) else {
            continue;
        };
        all.extend(errors.into_iter().map(|d| Diagnostic {
            file: Some(file.display().to_string()),
            line: step.line,
            column: 1,
            ..d
        }));
    }
    if told.insert(path) || reading.failed() {
        all.extend(reading.diagnostics);
    }
    all
}

fn number(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn tally(errors: usize, warnings: usize, notes: usize) -> String {
    match (errors, warnings) {
        (0, 0) if notes > 0 => format!("nothing wrong, {}", number(notes, "note")),
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
pub fn failure(error: Error) -> Failure {
    Failure {
        exit: Exit::Input,
        diagnostics: error.into(),
        sources: Sources::default(),
    }
}
