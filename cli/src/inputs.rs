//! `--input`: inputs of plants from a table over time.

use super::recorded::beside;
use super::run::Job;
use super::{Exit, Failure, remark};
use cognate::dataset::command::Command;
use cognate::diagnostic::Diagnostic;
use cognate::disk;
use cognate::model::{ElementId, ElementKind, Model};
use cognate::results::InputTable;
use cognate::setup::{Between, drive_inputs, undriven_inputs};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The table that drives the inputs of plants.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct InputArgs {
    /// Table (.csv) of inputs over time: TIME, then a column for each VARIABLE of a PINPUT, by its
    /// name or as IN1; straight lines between samples, and held outside [default: none, inputs stay
    /// as their FUNCTIONs say]
    #[arg(long, value_name = "FILE")]
    input: Option<PathBuf>,
    /// Hold every sample until the next, as co-simulation does [default: straight lines]
    #[arg(long, requires = "input")]
    input_hold: bool,
}

impl InputArgs {
    /// Returns whether a table is given.
    pub fn is_given(&self) -> bool {
        self.input.is_some()
    }

    /// Returns the table for the record of a run.
    pub fn table(&self) -> Option<InputTable> {
        let file = self.input.as_ref()?;
        let (file, held) = (disk::text(file), self.input_hold);
        Some(InputTable { file, held })
    }

    /// Returns these options, else those of a run with this record, which lies beside the results.
    pub fn or_recorded(&self, record: Option<&Value>, results: &Path) -> Self {
        let inputs = record.map(|record| &record["inputs"]);
        let Some(file) = inputs.and_then(|inputs| inputs["file"].as_str()) else {
            return self.clone();
        };
        match self.is_given() {
            true => self.clone(),
            false => Self {
                input: Some(beside(results, &disk::path(file))),
                input_hold: inputs.is_some_and(|inputs| inputs["held"] == true),
            },
        }
    }

    /// Gives a model its inputs; returns a note of where they come from, if it has any that are
    /// given or stay constant.
    ///
    /// # Errors
    /// All mistakes of the table.
    pub fn drive(&self, model: &mut Model) -> Result<Option<Diagnostic>, Failure> {
        let between = match self.input_hold {
            true => Between::Held,
            false => Between::Linear,
        };
        match &self.input {
            None => Ok(undriven_inputs(model)),
            Some(file) => {
                let driven = drive_inputs(model, file, between);
                Ok(Some(
                    driven.map_err(|e| Failure::in_files(Exit::Input, e.into()))?,
                ))
            }
        }
    }

    /// Gives the model of a job its inputs; the note is one of its remarks. Where commands change
    /// the model they may drive what has no table.
    ///
    /// # Errors
    /// As [`InputArgs::drive`].
    pub fn drive_job(&self, job: &mut Job) -> Result<(), Failure> {
        let before = job.reading.model.clone();
        let note = self.drive(&mut job.reading.model)?;
        let changed = job.steps.iter().filter_map(|step| match &step.command {
            Command::Change(record) => Some(record.row.kind()?.id(record.id?)),
            _ => None,
        });
        refuse_driven((&before, &job.reading.model), changed, "a command changes")?;
        let is_true = self.is_given() || !job.changes_the_model();
        job.remarks.extend(note.filter(|_| is_true));
        Ok(())
    }

    /// Gives a model its inputs, and remarks on a table that gives them.
    ///
    /// # Errors
    /// As [`InputArgs::drive`].
    pub fn drive_told(&self, model: &mut Model, quiet: bool) -> Result<(), Failure> {
        let note = self.drive(model)?.filter(|_| self.is_given() && !quiet);
        note.iter().for_each(|note| remark(&note.message));
        Ok(())
    }
}

/// Refuses to change a VARIABLE that a table drives: it would follow the one or the other.
///
/// # Errors
/// The first that is changed.
pub fn refuse_driven(
    (before, driven): (&Model, &Model),
    mut changed: impl Iterator<Item = ElementId>,
    how: &str,
) -> Result<(), Failure> {
    let function = |model: &Model, id: ElementId| {
        let variable = (id.kind == ElementKind::Variable).then(|| model.variables.get(&id.number));
        variable.flatten().map(|v| v.function.clone())
    };
    let Some(id) = changed.find(|id| function(before, *id) != function(driven, *id)) else {
        return Ok(());
    };
    let what = format!("{how} {id}, which the table of --input drives");
    let d = Diagnostic::error("input_table", what);
    Err(d
        .help("leave out its column of the table, or the change")
        .into())
}
