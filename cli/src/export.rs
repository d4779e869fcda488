//! `cognate export`: a model as it stands, with chosen loads and its set-up, as a dataset and a
//! command file for any program that reads them.

use super::arguments::SpanArgs;
use super::configuration::commands;
use super::run::{self, Single};
use super::setup::{self, Asked, Setup};
use super::verify::before_simulation;
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, piped, remark};
use cognate::dataset;
use cognate::dataset::command::{Command, Step};
use cognate::diagnostic::{Diagnostic, Severity};
use cognate::disk;
use cognate::model::{ElementId, ElementKind, Model, SettingsStatement};
use std::path::PathBuf;

/// Write a model as it stands, with chosen loads, as a dataset and a command file
///
/// The dataset holds what the commands before the first simulation have made of the model, the
/// functions that give loads, and the loads that act; the command file the simulations. Loads that
/// do not act are left out, or switched off by the command file where others name them. Comments of
/// the dataset are not part of the model and are left out. Nothing is overwritten.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate export crane.acf --name handed_over --out exchange
  cognate export crane.adm --loads lift,gravity --end 2 --steps 200
  cognate export crane.adm --name lift --overwrite -o exchange")]
pub struct Args {
    /// Dataset (.adm), or command file (.acf); - reads a dataset from standard input
    #[arg(value_parser = piped::model())]
    model: PathBuf,
    /// Name of the run: of the two files, and of the results of who runs them [default: that of the
    /// model]
    #[arg(long, value_name = "NAME", value_parser = run::run_name)]
    name: Option<String>,
    /// Folder that the files are written to [default: here]
    #[arg(short = 'o', long, value_name = "DIR", value_parser = piped::refused(piped::SEVERAL))]
    out: Option<PathBuf>,
    /// Load cases and loads, as SFORCE/3 or gravity; `all` for all loads [default: those of the
    /// last choice]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    loads: Vec<String>,
    #[command(flatten)]
    span: SpanArgs,
    #[command(flatten)]
    writing: WritingArgs,
}

/// Writes the dataset and the command file.
///
/// # Errors
/// When the model has mistakes, a load is unknown, or files of these names are there.
pub fn run(args: &Args) -> Outcome {
    let asked = match args.loads.is_empty() {
        true => Asked::Kept,
        false => Asked::New(&args.loads),
    };
    let is_command = run::has_commands(&args.model);
    if is_command {
        args.span.refuse_beside(&args.model)?;
    }
    let job = match is_command {
        true => run::script_with(&args.model, None, asked)?,
        false => run::standing_with(&args.single(), asked)?,
    };
    let name = args
        .name
        .clone()
        .unwrap_or_else(|| format!("{}_export", job.base));
    let folder = args.out.clone().unwrap_or_default();
    let files = ["adm", "acf"].map(|ending| folder.join(disk::path(format!("{name}.{ending}"))));
    args.writing.check(&files)?;
    let is_simulation = |s: &Step| matches!(s.command, Command::Simulate(_));
    let first = job
        .steps
        .iter()
        .position(is_simulation)
        .unwrap_or(job.steps.len());
    let left = job.steps[first..].to_vec();
    let (loads, setup) = (job.loads.clone(), job.setup.clone());
    let (mut model, _) = before_simulation(job)?;
    complete(&mut model, &setup);
    let absent = loads
        .iter()
        .flat_map(|l| &l.left_out)
        .filter_map(|l| setup::Load::of(&model, l).ok());
    let absent: Vec<setup::Load> = absent.collect();
    leave_out(&mut model, absent);
    let text = model.to_text();
    let again = dataset::read_text(&text);
    if again.failed() || again.model.to_text() != text {
        let what = "the dataset does not read back as it was written; nothing was written";
        return Err(Failure {
            exit: Exit::Bug,
            ..Failure::from(Diagnostic::error("bug", what))
        });
    }
    std::fs::create_dir_all(&folder).map_err(|e| {
        let what = format!("{}: {e}", disk::text(&folder));
        Diagnostic::error("file_unwritable", what)
    })?;
    args.writing.text(&files[0], &text)?;
    let commands = commands(&files[0], &model, &left, 0.0);
    args.writing.text(&files[1], &commands)?;
    if let Some(loads) = &loads {
        remark(setup::loads_acting(loads));
    }
    remark(format!(
        "{} and {}",
        disk::text(&files[0]),
        disk::text(&files[1])
    ));
    if left.is_empty() {
        remark(match is_command {
            true => "the commands hold no simulation",
            false => "the commands hold no simulation: --end TIME adds one",
        });
    }
    Ok(Exit::Done)
}

impl Args {
    fn single(&self) -> Single<'_> {
        Single {
            variables: &[],
            model: &self.model,
            dataset: None,
            span: self.span,
        }
    }
}

/// Adds what the set-up says beside loads: the permitted error, and a file of results for whoever
/// reads it back.
fn complete(model: &mut Model, setup: &Setup) {
    if let Some(error) = setup.solve.error {
        model.integrator.error = Some(error);
    }
    model
        .settings
        .entry(SettingsStatement::Results)
        .or_default();
}

/// Removes elements that do not act, where nothing else names them; the others stay switched off.
fn leave_out(model: &mut Model, loads: Vec<setup::Load>) {
    let ids = loads.into_iter().filter_map(|load| match load {
        setup::Load::Element(id) => Some(id),
        // taken away already
        setup::Load::Gravity | setup::Load::Initial(_) => None,
    });
    let ids: Vec<ElementId> = ids.collect();
    let before = mistakes(model);
    let mut without = model.clone();
    ids.iter().for_each(|&id| remove(&mut without, id));
    if mistakes(&without) <= before {
        *model = without;
        return;
    }
    for id in ids {
        let mut without = model.clone();
        remove(&mut without, id);
        if mistakes(&without) <= before {
            *model = without;
        }
    }
}

/// Counts the errors of a model.
fn mistakes(model: &Model) -> usize {
    let found = model.check();
    found
        .iter()
        .filter(|d| d.severity == Severity::Error)
        .count()
}

/// Removes a load.
fn remove(model: &mut Model, id: ElementId) {
    let n = id.number;
    match id.kind {
        ElementKind::Motion => drop(model.motions.remove(&n)),
        ElementKind::Sforce => drop(model.sforces.remove(&n)),
        ElementKind::Vforce => drop(model.vforces.remove(&n)),
        ElementKind::Vtorque => drop(model.vtorques.remove(&n)),
        ElementKind::Gforce => drop(model.gforces.remove(&n)),
        ElementKind::Contact => drop(model.contacts.remove(&n)),
        // no load, so that it is never left out
        _ => return,
    }
    model.inactive.remove(&id);
}
