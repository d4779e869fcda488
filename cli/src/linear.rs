//! `cognate linear`: small motions of a model about a state, as eigenvalues and as a linear system.

use super::arguments::UnsolvedArgs;
use super::inputs::InputArgs;
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, interrupt, modes, piped, remark, run, say, summary, width};
use cognate::analysis::linear::Wanted;
use cognate::analysis::session::script::obey;
use cognate::analysis::session::state;
use cognate::analysis::session::{Analysis, Options, Session};
use cognate::analysis::watch::Watch;
use cognate::dataset::command::{Command, Linear, Step};
use cognate::diagnostic::{Cause, Diagnostic};
use cognate::disk;
use cognate::model::{ElementId, ElementKind};
use cognate::results::{Status, json};
use std::path::{Path, PathBuf};

/// Linearize a model: eigenvalues, mode shapes, and the matrices A, B, C, D between its plant
/// inputs and outputs
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate linear pendulum.adm
  cognate linear pendulum.adm --static --no-damping
  cognate linear plant.acf --out results        after the simulations of the command file")]
pub struct Args {
    /// Dataset (.adm), or command file (.acf) whose simulations lead to the state; - reads a
    /// dataset from standard input
    #[arg(value_parser = piped::model())]
    model: PathBuf,
    /// About the equilibrium next to the initial configuration
    #[arg(long = "static")]
    settle: bool,
    /// Leave out what depends on velocities
    #[arg(long)]
    no_damping: bool,
    /// PINPUT whose VARIABLEs are the inputs, by its number or name [default: all]
    #[arg(long, value_name = "ELEMENT")]
    pinput: Option<String>,
    /// POUTPUT whose VARIABLEs are the outputs, by its number or name [default: all]
    #[arg(long, value_name = "ELEMENT")]
    poutput: Option<String>,
    /// Folder that NAME_linear.json and NAME_linear.m are written to [default: they are not
    /// written]
    #[arg(short = 'o', long, value_name = "DIR", value_parser = piped::refused(piped::SEVERAL))]
    out: Option<PathBuf>,
    #[command(flatten)]
    inputs: InputArgs,
    #[command(flatten)]
    writing: WritingArgs,
    #[command(flatten)]
    unsolved: UnsolvedArgs,
    #[command(flatten)]
    routines: super::routines::RoutineArgs,
    /// Print everything as JSON
    #[arg(long)]
    json: bool,
}

struct Quiet;

impl Watch for Quiet {
    fn interrupted(&mut self) -> bool {
        interrupt::requested()
    }
}

/// Linearizes a model and writes the files of its linear system.
///
/// # Errors
/// When the model has mistakes, or has no state to linearize about.
pub fn run(args: &Args) -> Outcome {
    interrupt::install();
    let commands = run::has_commands(&args.model);
    let (mut reading, base, steps) = if commands {
        let job = run::script(&args.model, None)?;
        (job.reading, job.base, job.steps)
    } else {
        (run::read(&args.model)?, run::stem(&args.model), Vec::new())
    };
    args.inputs.drive_told(&mut reading.model, args.json)?;
    let options = args.unsolved.given_to(Options {
        named_only: true,
        ..Options::default()
    });
    let mut session = Session::new(reading.model, &base, options);
    session.folders = args
        .model
        .parent()
        .map(std::path::Path::to_path_buf)
        .into_iter()
        .collect();
    let dataset = reading.dataset;
    let in_model = |errors| Failure::in_model(&dataset, errors);
    let mistake = (args.routines).compute(&mut session, &dataset, args.unsolved.zero_user)?;
    let done = obey(&mut session, &steps, |_, _| (), &mut Quiet);
    let mut status = mistake.before(done).map_err(in_model)?;
    if args.settle && status == Status::Completed {
        let now = session.time();
        let done = session.simulate(Analysis::Static, now, 1, &mut Quiet);
        status = mistake.before(done).map_err(in_model)?;
    }
    if status != Status::Completed {
        remark(&session.run.record.stop_reason);
        return Ok(run::exit(status));
    }
    let number = |option: &str, kind: ElementKind, text: &Option<String>| {
        let found = text.as_ref().map(|text| {
            let found = session.model.find_of(&[kind], text);
            found.map_err(|d| Failure::at_argument(option, text, d))
        });
        let found: Option<ElementId> = found.transpose()?;
        Ok::<_, Failure>(found.map(|id| id.number))
    };
    let wanted = Wanted {
        inputs: number("--pinput", ElementKind::Pinput, &args.pinput)?,
        outputs: number("--poutput", ElementKind::Poutput, &args.poutput)?,
        no_damping: args.no_damping,
        shapes: None,
    };
    let found = session.linearize(&wanted);
    let found = mistake.before(found).map_err(in_model)?;
    let warnings = summary::warnings(&session.run.record.warnings);
    if args.json {
        let mut all = found.json();
        all["warnings"] = warnings.clone().into();
        say(&json::text(&all));
    } else {
        let time = &session.run.units.time;
        say(&modes::text(&found, time, width::columns()));
    }
    for warning in warnings {
        remark(format!("warning: {warning}"));
    }
    session.linear = vec![(None, true, found)];
    if let Some(dir) = &args.out {
        write(dir, files(&session), args.writing)?;
    }
    Ok(Exit::Done)
}

/// Writes files into a folder, which is made if it is not there.
fn write(dir: &Path, files: Vec<(String, String)>, writing: WritingArgs) -> Result<(), Failure> {
    let place = |(name, text)| (dir.join(disk::path(name)), text);
    let files: Vec<(PathBuf, String)> = files.into_iter().map(place).collect();
    writing.check(files.iter().map(|(path, _)| path))?;
    for (path, text) in files {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|e| {
                let what = format!("{}: {e}", disk::text(&folder));
                Diagnostic::error(Cause::FileUnwritable, what)
            })?;
        }
        writing.text(&path, &text)?;
        remark(format!("wrote {}", disk::text(&path)));
    }
    Ok(())
}

/// Returns names and texts of the files of the linear systems that a session has found.
pub fn files(session: &Session) -> Vec<(String, String)> {
    let mut files = Vec::new();
    let named = session.linear.iter().map(|(file, ..)| file.as_deref());
    let names = names(&session.run.name, named);
    for (name, (_, matrices, found)) in names.into_iter().zip(&session.linear) {
        let mut texts = vec![("json", json::text(&found.json()))];
        if *matrices {
            texts.push(("m", found.matlab()));
        }
        for (ending, text) in texts {
            files.push((format!("{name}.{ending}"), text));
        }
    }
    files
}

/// Returns the names of the files of linear systems, without their endings: those that commands
/// give, else that of the run with a number.
fn names<'f>(run: &str, files: impl Iterator<Item = Option<&'f str>>) -> Vec<String> {
    let mut own = 0;
    files
        .map(|file| match file {
            Some(file) if file != run => file.to_owned(),
            _ => {
                own += 1;
                let number = if own > 1 {
                    own.to_string()
                } else {
                    String::new()
                };
                format!("{run}_linear{number}")
            }
        })
        .collect()
}

/// Returns the names of the files that commands of a run ask for: linear systems, saved states.
pub fn named_by(run: &str, steps: &[Step]) -> Vec<String> {
    let linear = steps.iter().filter_map(|step| match &step.command {
        Command::Linear(linear) => Some(linear),
        _ => None,
    });
    let named = names(run, linear.clone().map(|linear| linear.file.as_deref()));
    let matrices = |linear: &Linear| linear.state_matrices || !linear.eigensolution;
    let endings = linear.map(|linear| {
        if matrices(linear) {
            &["json", "m"][..]
        } else {
            &["json"]
        }
    });
    let files = named
        .iter()
        .zip(endings)
        .flat_map(|(name, endings)| endings.iter().map(move |ending| format!("{name}.{ending}")));
    let saved = steps.iter().filter_map(|step| match &step.command {
        Command::Save(Some(name)) => Some(state::file_name(name)),
        _ => None,
    });
    files.chain(saved).collect()
}
