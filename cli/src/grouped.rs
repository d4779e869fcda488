//! Groups and functions of the user's beside the columns of a run: what `cognate plot` can show.
//!
//! A name of a group means, in this order: a group of `MODEL.toml`; the run itself, whose group
//! holds all its columns; an element's set of results, such as `PART_2_XFORM`.

use super::setup::{self, Setup};
use super::{Failure, group, recorded, run};
use cognate::diagnostic::Diagnostic;
use cognate::results::{Column, Run, Units};
use std::path::Path;

/// Output times of functions that are shown without a run.
const TIMES: usize = 400;

/// Returns the set-up of the model of results: beside the model that is given or that the record
/// names, else beside the results.
///
/// # Errors
/// When it has mistakes.
pub(super) fn setup_of(results: &Path, model: Option<&Path>) -> Result<Setup, Failure> {
    let named = recorded::model_file(results, model).ok();
    if let Some(model) = named.filter(|file| file.is_file()) {
        let setup = setup::of_model(&model)?;
        if setup.exists() {
            return Ok(setup);
        }
    }
    setup::beside(results)
}

/// Returns the names of the columns that a group holds.
///
/// # Errors
/// When there is no such group.
pub(super) fn columns_of(
    setup: &Setup,
    results: &Run,
    name: &str,
) -> Result<Vec<String>, Diagnostic> {
    let named = |c: usize| results.columns.get(c).map(|c| c.name.clone());
    if let Some(functions) = setup.functions_of(name) {
        return Ok(functions);
    }
    if results.name == name {
        let columns = results.table_columns().into_iter().filter(|&c| c > 0);
        return Ok(columns.filter_map(named).collect());
    }
    match results.resolve_all(&format!("{name}.*")) {
        Ok(columns) => Ok(columns.into_iter().filter_map(named).collect()),
        Err(_) => Err(group::unknown(setup, name)
            .help("a run is a group too, by its name, and so is each set of results")),
    }
}

/// Adds functions of the user's as columns, where a run has no column of their names.
///
/// # Errors
/// When a function reads more than time, or has no value at an output time.
pub(super) fn add_functions(
    results: &mut Run,
    setup: &Setup,
    names: &[String],
) -> Result<(), Diagnostic> {
    let whole = results.table.is_empty();
    let asked = names.iter().filter_map(|name| setup.function(name));
    for function in asked {
        let name = &function.name.text;
        if results.find(name).is_some() {
            continue;
        }
        let times = results.columns.first().map(|t| t.values.clone());
        let values = function
            .values(&times.unwrap_or_default())?
            .ok_or_else(|| {
                let what = format!("the function {name} reads more than time");
                let d = Diagnostic::error("unavailable", what);
                d.help("only a run knows its values: cognate run --column, or a REQUEST")
            })?;
        let unit = function.unit(&results.units);
        if !whole {
            results.table.push(results.columns.len());
        }
        results.columns.push(Column {
            name: name.clone(),
            unit,
            values,
            bar_of: None,
        });
    }
    Ok(())
}

/// Returns a run without columns, from 0 to the end of the set-up (else 1): functions of a model
/// are shown over it.
pub(super) fn over_time(setup: &Setup, model: &Path, end: Option<f64>) -> Run {
    let end = end.or(setup.solve.end).unwrap_or(1.0);
    let mut times = Run::new(run::stem(model), "functions", Units::default());
    for k in 0..=TIMES {
        times.push(&[end * k as f64 / TIMES as f64]);
    }
    times
}
