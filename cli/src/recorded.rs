//! The model of a record: the file that the record names, as its commands left it, unless its
//! markers are fixed otherwise now.

use super::setup::Asked;
use super::{Failure, complain_in_files, run};
use cognate::analysis::motion::{MarkerMeasure, Recorded, marker_digest};
use cognate::dataset::command::Command;
use cognate::diagnostic::Diagnostic;
use cognate::disk;
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
    let dataset = results.with_extension("adm");
    dataset.is_file().then_some(dataset)
}

/// Reads results; what is doubted about their file is said.
///
/// # Errors
/// As [`results::read`].
pub(super) fn read(file: &Path) -> Result<Run, Diagnostic> {
    let run = results::read(file)?;
    complain_in_files(&run.record.doubts);
    Ok(run)
}

/// Reads the record beside results.
pub(super) fn record_of(results: &Path) -> Option<Value> {
    let text = std::fs::read(results.with_extension("json")).ok()?;
    let record: Value = serde_json::from_slice(&text).ok()?;
    record["model"].is_string().then_some(record)
}

/// Finds a file that a record names: as it stands, else beside the results or one folder above.
fn beside(results: &Path, named: &Path) -> PathBuf {
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
    let absent = names.iter().filter(|name| results.find(name).is_none());
    let asked = absent.filter_map(|name| Some((*name, MarkerMeasure::of(name)?)));
    let asked: Vec<(&str, MarkerMeasure)> = asked.collect();
    // without a model these are names like any other
    let has_model = given.is_some() || record_of(file).is_some() || namesake(file).is_some();
    if asked.is_empty() || !has_model {
        return Ok(());
    }
    let model = model_of(file, given)?;
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
