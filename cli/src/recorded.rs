//! The model of a record: the file that the record names, as its commands left it, unless its
//! markers are fixed otherwise now.

use super::setup::Asked;
use super::{Failure, complain_in_files, run};
use cognate::dataset::command::Command;
use cognate::diagnostic::Diagnostic;
use cognate::disk;
use cognate::expr::ast::{Callee, Dialect};
use cognate::expr::{Profile, Symbol, symbol};
use cognate::internals::motion::{MarkerMeasure, Recorded, marker_digest};
use cognate::internals::results::kept;
use cognate::model::Model;
use cognate::results::{self, Run};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Returns the model of results in a file: the `given` one, else that which their record names.
///
/// # Errors
/// When there is no such file, it has mistakes, or it has changed since the run.
pub(super) fn model_of(results: &Path, given: Option<&Path>) -> Result<Model, Failure> {
    let file = model_file(results, given)?;
    let record = record_of(results);
    let text = |key: &str| record.as_ref().and_then(|r| r[key].as_str());
    let model = as_commands_leave_it(&file)?;
    let expected = text("markers");
    if expected.is_some_and(|digest| digest != marker_digest(&model)) {
        let what = format!(
            "the markers of {} are not those of the run: it has been changed since, or is another model",
            disk::text(&file)
        );
        let d = Diagnostic::error("other_model", what);
        return Err(d.help("--model FILE names the model of the run").into());
    }
    Ok(model)
}

/// Returns the file that was run: the `given` one, else that which the record of results names; of
/// results of other programs the dataset of their name beside them.
///
/// # Errors
/// When there is neither a record that names one nor such a dataset.
pub(super) fn model_file(results: &Path, given: Option<&Path>) -> Result<PathBuf, Failure> {
    let record = record_of(results);
    let named = record.as_ref().and_then(|r| r["model"].as_str());
    match (given, named) {
        (Some(given), _) => Ok(given.to_owned()),
        (None, Some(named)) => Ok(beside(results, Path::new(named))),
        (None, None) => namesake(results).ok_or_else(|| {
            let what = format!(
                "{} has no record that names its model, nor a dataset of its name beside it",
                disk::text(&results)
            );
            let d = Diagnostic::error("no_model", what);
            d.help("--model FILE names it").into()
        }),
    }
}

/// Returns the dataset beside results that has their name.
fn namesake(results: &Path) -> Option<PathBuf> {
    super::moved::model_beside(results)
}

/// Reads results, by their file or the name of their run; what is doubted about their file is said.
///
/// # Errors
/// As [`results_file`] and [`results::read`].
pub(super) fn read(file: &Path) -> Result<Run, Diagnostic> {
    let run = results::read(&results_file(file)?)?;
    complain_in_files(&run.record.doubts);
    Ok(run)
}

/// Returns the file of results that an argument names: the file itself, or of a run that it names,
/// as `results/crank`, the one that has most.
///
/// # Errors
/// When there is neither, with runs that are named nearly so.
fn results_file(named: &Path) -> Result<PathBuf, Diagnostic> {
    if named.is_file() {
        return Ok(named.to_owned());
    }
    let run = match kept::find(named) {
        Ok(run) => run,
        // a file with an ending is told as one that cannot be opened
        Err(_) if named.extension().is_some() => return Ok(named.to_owned()),
        Err(d) => return Err(d),
    };
    let files = run.files();
    let of_ending = |ending: &&str| {
        let name = format!("{}.{ending}", run.name);
        let is_it = |path: &Path| path.file_name().is_some_and(|n| *n == *name);
        let mut files = files.iter().filter(|f| f.bytes.is_some());
        files.find(|f| is_it(&f.path)).map(|f| f.path.clone())
    };
    let endings = ["parquet", "res", "csv", "gra", "req"];
    endings.iter().find_map(of_ending).ok_or_else(|| {
        let what = format!("the run {} has no table that can be read", run.place());
        let d = Diagnostic::error("unknown_run", what);
        d.help("`cognate run --format res` writes one")
    })
}

/// Reads the record beside results.
pub(super) fn record_of(results: &Path) -> Option<Value> {
    let text = std::fs::read(results.with_extension("json")).ok()?;
    let record: Value = serde_json::from_slice(&text).ok()?;
    record["model"].is_string().then_some(record)
}

/// Finds a file that a record names: as it stands, else beside the results or one folder above.
pub(super) fn beside(results: &Path, named: &Path) -> PathBuf {
    let folder = results.parent().unwrap_or(Path::new(""));
    let name = named.file_name().unwrap_or_default();
    let places = [
        named.to_owned(),
        folder.join(name),
        folder.join("..").join(name),
    ];
    let found = places.iter().find(|file| file.is_file());
    found.cloned().unwrap_or_else(|| named.to_owned())
}

/// Reads a dataset, or that of a command file with all changes that its commands make.
fn as_commands_leave_it(file: &Path) -> Result<Model, Failure> {
    if !run::has_commands(file) {
        return Ok(run::read_with(file, Asked::All)?.model);
    }
    let job = run::script_with(file, None, Asked::All)?;
    let mut model = job.reading.model;
    for step in &job.steps {
        if matches!(step.command, Command::Change(_)) {
            let applied = model.apply(&step.command);
            applied.map_err(|e| Failure::in_files(super::Exit::Input, e.into()))?;
        }
    }
    Ok(model)
}

/// Adds the columns of those names that a run does not have and that are measures of markers, such
/// as `DX(20,10)`, where the model is known. The others are left to the caller.
///
/// # Errors
/// When the model cannot be found, or a marker or its motion is not there.
pub(super) fn add_measures(
    results: &mut Run,
    file: &Path,
    given: Option<&Path>,
    names: &[&str],
) -> Result<(), Failure> {
    let is_call = |name: &str| {
        let word = name.split_once('(').map(|(word, _)| word.trim());
        let meaning = word.and_then(|w| symbol(w, Dialect::Function, Profile::Adams));
        matches!(meaning, Some(Symbol::Callee(Callee::Measure(_))))
    };
    let absent = names.iter().filter(|name| results.find(name).is_none());
    let asked: Vec<&str> = absent.copied().filter(|name| is_call(name)).collect();
    // without a model these are names like any other
    let has_model = given.is_some() || record_of(file).is_some() || namesake(file).is_some();
    if asked.is_empty() || !has_model {
        return Ok(());
    }
    let model = model_of(file, given)?;
    let mut measures = Vec::new();
    for name in asked {
        let measure = MarkerMeasure::of(&model, name);
        let measure = measure.map_err(|wrong| Failure::at_arguments("--y", name, wrong))?;
        measures.extend(measure.map(|measure| (name, measure)));
    }
    let asked = measures;
    let recorded = Recorded::new(results, &model);
    let columns = asked
        .iter()
        .map(|(name, measure)| recorded.column(name, measure));
    let columns = columns.collect::<Result<Vec<_>, _>>()?;
    let whole = results.table.is_empty();
    for column in columns {
        if !whole {
            results.table.push(results.columns.len());
        }
        results.columns.push(column);
    }
    Ok(())
}
