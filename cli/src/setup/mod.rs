//! The set-up beside a model, as commands use it: read with its mistakes shown in the file, and
//! edited. The file is the user's: only what a command is asked to change is changed, comments and
//! order stay.

pub mod edit;

pub use cognate::setup::{
    Asked, Case, LAST_USED, Load, Members, Ordinate, Prepared, Setup, USER_DEFINED, UserFunction,
    loads_of, target_of,
};

use super::{Exit, Failure, remark, run};
use cognate::dataset::command::Script;
use cognate::diagnostic::{Diagnostic, Error};
use cognate::disk;
use cognate::model::Model;
use cognate::results::Loads;
use std::path::{Path, PathBuf};

/// Returns the failure of mistakes in the file.
fn in_file(error: Error) -> Failure {
    Failure::in_files(Exit::Input, error.into())
}

/// Reads the file beside a dataset; one without contents where there is none.
///
/// # Errors
/// All mistakes in the file, each at its line and column.
pub fn beside(dataset: &Path) -> Result<Setup, Failure> {
    Setup::beside(dataset).map_err(in_file)
}

/// Reads the file beside a model: beside the dataset that a command file names.
///
/// # Errors
/// When the command file or the file beside the dataset has mistakes.
pub fn of_model(model: &Path) -> Result<Setup, Failure> {
    beside(&dataset_of(model)?)
}

/// Prepares a model for a run, as [`cognate::setup::prepare`] does; a new choice of loads is kept
/// in the file.
///
/// # Errors
/// All mistakes in that file, at their lines and columns, and names that are no loads.
pub fn prepare(dataset: &Path, model: &mut Model, asked: Asked) -> Result<Prepared, Failure> {
    let prepared = cognate::setup::prepare(dataset, model, asked).map_err(in_file)?;
    if let Asked::New(names) = asked {
        keep(&prepared.setup, names, prepared.loads.as_ref());
    }
    Ok(prepared)
}

/// Returns the loads that names of loads and load cases mean.
///
/// # Errors
/// All names that mean none.
pub fn check_loads(setup: &Setup, model: &Model, names: &[String]) -> Result<Vec<Load>, Failure> {
    cognate::setup::check_loads(setup, model, names).map_err(in_file)
}

/// Returns the loads of the choice that is kept; `None`: all loads.
///
/// # Errors
/// All names that mean none, at their places.
pub fn chosen_loads(setup: &Setup, model: &Model) -> Result<Option<Vec<Load>>, Failure> {
    cognate::setup::chosen_loads(setup, model).map_err(in_file)
}

/// Keeps a choice in the file beside the model. That it cannot be kept is no reason not to run.
fn keep(setup: &Setup, names: &[String], loads: Option<&Loads>) {
    let are_cases = names.iter().all(|name| setup.case(name).is_some());
    let kept = match loads {
        None => edit::choose(setup, &[]),
        Some(_) if are_cases => edit::choose(setup, names),
        Some(loads) => edit::keep_last_used(setup, &loads.acting)
            .and_then(|new| edit::choose(&new, &[LAST_USED.to_owned()])),
    };
    match kept {
        Ok(_) if loads.is_some() => remark(format!(
            "the choice is kept in {}; --loads all takes all loads again",
            disk::text(&setup.file)
        )),
        Ok(_) => {}
        Err(d) => remark(format!("the choice of loads is not kept: {}", d.message)),
    }
}

/// Writes which loads act, for a person.
pub fn loads_acting(loads: &Loads) -> String {
    let mut text = format!("loads: {}", loads.chosen.join(", "));
    if loads.chosen != loads.acting {
        text += &format!(" ({})", loads.acting.join(", "));
    }
    if !loads.left_out.is_empty() {
        text += &format!("; left out: {}", loads.left_out.join(", "));
    }
    text
}

/// Returns the dataset of a model: that which a command file names.
///
/// # Errors
/// When the command file cannot be read, or names none.
pub fn dataset_of(model: &Path) -> Result<PathBuf, Failure> {
    if !run::has_commands(model) {
        return Ok(model.to_owned());
    }
    let is_log = super::moved::has_ending(model, "msg");
    let script = match is_log {
        true => Script::from_message_log(model),
        false => Script::read(model),
    };
    let script = script.map_err(in_file)?;
    let named = script.model_file();
    let named = named.or_else(|| is_log.then(|| model.with_extension("adm")));
    named.ok_or_else(|| {
        let what = format!("{} names no dataset", disk::text(&model));
        let d = Diagnostic::error("no_model", what);
        d.help("begin it with FILE/MODEL=name").into()
    })
}
