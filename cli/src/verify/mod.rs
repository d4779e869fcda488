//! `cognate verify`: the freedoms of a model, its redundant constraints, and its free motions.

pub mod text;

use super::run::{Job, has_commands, script_with, timed_read};
use super::setup::{Asked, loads_acting};
use super::{Exit, Failure, Outcome, complain_in_files, draw, moved, piped, remark, say};
use crate::writing::WritingArgs;
use cognate::analysis::verify::{Verification, verify};
use cognate::dataset::Dataset;
use cognate::dataset::command::{Command, Step};
use cognate::diagnostic::{Diagnostic, Error, Severity};
use cognate::disk;
use cognate::model::Model;
use cognate::results::{Loads, json};
use std::path::{Path, PathBuf};

/// Count the freedoms of a model and explain what is fixed twice and what is free
///
/// Exit code 4 when the constraints contradict each other; redundancy alone is no failure.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate verify slider_crank.adm
  cognate verify four_bar.adm --draw four_bar.svg
  cognate verify robot.acf --json")]
pub struct Args {
    /// Dataset (.adm), or command file (.acf): then the model as it is before the first simulation;
    /// - reads a dataset from standard input
    #[arg(value_parser = piped::model())]
    model: PathBuf,
    /// Print the findings as JSON on standard output
    #[arg(long)]
    json: bool,
    /// Draw the mechanism (.svg, .png, .pdf); what fixes the same twice stands out [default: no
    /// picture]
    #[arg(long, value_name = "FILE")]
    draw: Option<PathBuf>,
    #[command(flatten)]
    writing: WritingArgs,
}

/// Counts the freedoms of a model and prints the findings.
///
/// # Errors
/// When a file cannot be read, or has mistakes.
pub fn run(args: &Args) -> Outcome {
    let (model, dataset) = model_of(&args.model)?;
    // what is doubted in the dataset may be why freedoms are not those that were meant
    let doubted = model.check().into_iter();
    let doubted = doubted.filter(|d| d.severity == Severity::Warning);
    let doubted = doubted.chain(model.doubts());
    let doubted: Vec<Diagnostic> = doubted.map(|d| dataset.locate(d)).collect();
    let found = verify(&model).map_err(|d| Failure::in_model(&dataset, d))?;
    if args.json {
        say(&json::text(&found.json()));
    } else {
        say(&text::of(&found, &model));
    }
    complain_in_files(&doubted);
    if let Some(file) = args.draw.as_ref().filter(|_| found.inconsistent.is_empty()) {
        draw_redundant(model, &dataset, &found, (file, args.writing))?;
    }
    if found.inconsistent.is_empty() {
        return Ok(Exit::Done);
    }
    let located = found.inconsistent.into_iter().map(|d| dataset.locate(d));
    complain_in_files(&located.collect::<Vec<_>>());
    Ok(Exit::Model)
}

/// Draws a model as it is assembled; elements that fix what others fix already stand out, and these
/// others.
///
/// # Errors
/// When the file cannot be written, or is no picture.
fn draw_redundant(
    model: Model,
    dataset: &Dataset,
    found: &Verification,
    file: (&Path, WritingArgs),
) -> Result<(), Failure> {
    let redundant = found.dependent.iter();
    let elements = redundant.flat_map(|d| d.fixed_by.iter().copied().chain([d.element]));
    let source = dataset.source.file.as_deref().map(disk::path);
    let folder = source
        .as_deref()
        .and_then(Path::parent)
        .map(Path::to_path_buf);
    let folders = folder.into_iter().collect();
    let assembled = moved::assembled(model, "verify", folders);
    let moved = assembled.map_err(|errors| Failure::in_model(dataset, errors))?;
    draw::draw_standing_out(&moved, elements.collect(), file)
}

/// Returns the model of a dataset, or of a command file as its commands leave it before the first
/// simulation, and the dataset as written.
///
/// # Errors
/// When a file cannot be read, or has mistakes.
pub fn model_of(path: &Path) -> Result<(Model, Dataset), Failure> {
    let (model, dataset, loads) = model_with_loads(path)?;
    loads.iter().for_each(|l| remark(loads_acting(l)));
    Ok((model, dataset))
}

/// Returns the same, and the loads that were chosen.
///
/// # Errors
/// When a file cannot be read, or has mistakes.
pub fn model_with_loads(path: &Path) -> Result<(Model, Dataset, Option<Loads>), Failure> {
    if !has_commands(path) {
        let (reading, _, prepared) = timed_read(path, Asked::Kept)?;
        return Ok((reading.model, reading.dataset, prepared.loads));
    }
    let job = script_with(path, None, Asked::Kept)?;
    let loads = job.loads.clone();
    let (model, dataset) = before_simulation(job)?;
    Ok((model, dataset, loads))
}

/// Returns the model of commands as they leave it before the first simulation, and the dataset as
/// written.
///
/// # Errors
/// When a command does not fit the model.
pub fn before_simulation(job: Job) -> Result<(Model, Dataset), Failure> {
    let mut model = job.reading.model;
    for step in &job.steps {
        match &step.command {
            Command::Simulate(_) => break,
            command => {
                let wrong = |e: Error| Failure::in_files(Exit::Input, e.into());
                model.apply(command).map_err(wrong)?;
            }
        }
    }
    let simulates = |s: &Step| matches!(s.command, Command::Simulate(_));
    if !job.steps.is_empty() && !job.steps.iter().any(simulates) {
        remark("no SIMULATE in the command file: this is the model after all its commands");
    }
    Ok((model, job.reading.dataset))
}
