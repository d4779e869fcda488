//! `cognate linear`: small motions of a model about a state, as eigenvalues and as a linear system.

use super::arguments::UnsolvedArgs;
use super::{Exit, Failure, Outcome, interrupt, modes, remark, run, say, summary, width};
use cognate::analysis::linear::Wanted;
use cognate::analysis::session::script::obey;
use cognate::analysis::session::{Analysis, Options, Session};
use cognate::analysis::watch::Watch;
use cognate::diagnostic::{Cause, Diagnostic};
use cognate::model::{ElementId, ElementKind};
use cognate::results::{self, Status, json};
use std::path::PathBuf;

/// Linearize a model: eigenvalues, mode shapes, and the matrices A, B, C, D between its plant
/// inputs and outputs
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate linear pendulum.adm
  cognate linear pendulum.adm --static --no-damping
  cognate linear plant.acf --out results        after the simulations of the command file")]
pub struct Args {
    /// Dataset (.adm), or command file (.acf) whose simulations lead to the state
    model: PathBuf,
    /// About the equilibrium next to the initial configuration
    #[arg(long = "static")]
    settle: bool,
    /// Leave out what depends on velocities
    #[arg(long)]
    no_damping: bool,
    /// PINPUT whose VARIABLEs are the inputs, by its number or name (all when not given)
    #[arg(long, value_name = "ELEMENT")]
    pinput: Option<String>,
    /// POUTPUT whose VARIABLEs are the outputs, by its number or name (all when not given)
    #[arg(long, value_name = "ELEMENT")]
    poutput: Option<String>,
    /// Folder that NAME_linear.json and NAME_linear.m are written to
    #[arg(short = 'o', long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    unsolved: UnsolvedArgs,
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
    let (reading, base, steps) = if commands {
        let job = run::script(&args.model, None)?;
        (job.reading, job.base, job.steps)
    } else {
        (run::read(&args.model)?, run::stem(&args.model), Vec::new())
    };
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
    let mut status = obey(&mut session, &steps, |_, _| (), &mut Quiet).map_err(in_model)?;
    if args.settle && status == Status::Completed {
        let now = session.time();
        status = session
            .simulate(Analysis::Static, now, 1, &mut Quiet)
            .map_err(in_model)?;
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
    let found = session.linearize(&wanted).map_err(in_model)?;
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
        for (name, text) in files(&session) {
            let path = dir.join(name);
            if let Some(folder) = path.parent() {
                std::fs::create_dir_all(folder).map_err(|e| {
                    Diagnostic::error(Cause::FileUnwritable, format!("{}: {e}", folder.display()))
                })?;
            }
            results::write_text(&path, &text)?;
            remark(format!("wrote {}", path.display()));
        }
    }
    Ok(Exit::Done)
}

/// Returns names and texts of the files of the linear systems that a session has found.
pub fn files(session: &Session) -> Vec<(String, String)> {
    let mut files = Vec::new();
    let mut own = 0;
    for (file, matrices, found) in &session.linear {
        let name = match file {
            Some(file) if *file != session.run.name => file.clone(),
            _ => {
                own += 1;
                let number = if own > 1 {
                    own.to_string()
                } else {
                    String::new()
                };
                format!("{}_linear{number}", session.run.name)
            }
        };
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
