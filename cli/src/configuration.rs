//! `cognate configuration`: the configuration of a run at some time as a dataset that begins there.

use super::arguments::{IntegrationArgs, KindName, SpanArgs, UnsolvedArgs};
use super::inputs::InputArgs;
use super::moved::is_dataset;
use super::recorded::{model_file, record_of};
use super::run::{self, Single};
use super::setup::Asked;
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, complain_in_files, interrupt, piped, remark};
use cognate::analysis::session::script::obey;
use cognate::analysis::session::{Analysis, Options, Session};
use cognate::dataset;
use cognate::dataset::command::{Command, Simulate, SimulationKind, Step};
use cognate::diagnostic::{Cause, Diagnostic};
use cognate::disk;
use cognate::model::{ElementId, ElementKind, Model};
use cognate::results::{Status, digits_of_six};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Write the configuration of a run at some time as a dataset that begins there
///
/// Parts stand and move as they do then, equations and motions have their values, TIME in functions
/// is counted from there: the dataset begins at time zero, in any program. The run is solved up to
/// that time. What a dataset cannot tell is said.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate configuration crank.acf --at 0.3 -o later.adm
  cognate configuration crank.acf --at 0.3 -o later.adm --commands later.acf
  cognate configuration results/crank.res --at 0.3 -o later.adm
  cognate configuration drop.adm --at 0.1 --error 1e-9 -o later.adm")]
pub struct Args {
    /// Command file (.acf), log (.msg), dataset (.adm), or results of a run whose record names its
    /// model; - reads a dataset from standard input
    #[arg(value_parser = piped::model())]
    file: PathBuf,
    /// Time of the configuration
    #[arg(long, value_name = "TIME", allow_negative_numbers = true)]
    at: f64,
    /// Dataset to write
    #[arg(short = 'o', long = "out", value_name = "FILE.adm", value_parser = piped::output("adm"))]
    out: PathBuf,
    /// Write the commands that are left to this file, with ends that count from there [default:
    /// they are not written]
    #[arg(long, value_name = "FILE.acf")]
    commands: Option<PathBuf>,
    #[command(flatten)]
    writing: WritingArgs,
    /// Dataset or command file of the results [default: the one that their record names]
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    #[command(flatten)]
    inputs: InputArgs,
    #[command(flatten)]
    integration: IntegrationArgs,
    /// Kind of simulation, for a dataset without command file [default: that of MODEL.toml, else
    /// transient]
    #[arg(long = "type", value_name = "KIND", value_enum)]
    kind: Option<KindName>,
    #[command(flatten)]
    unsolved: UnsolvedArgs,
}

/// Writes a configuration as a dataset.
///
/// # Errors
/// When the model cannot be solved up to that time, or a file cannot be written.
pub fn run(args: &Args) -> Outcome {
    interrupt::install();
    let is_model = is_dataset(&args.file) || run::has_commands(&args.file);
    let (file, dataset) = match (is_model, &args.model) {
        (true, model) => (args.file.clone(), model.as_deref()),
        (false, model) => (model_file(&args.file, model.as_deref())?, None),
    };
    let recorded = record_of(&args.file).filter(|_| !is_model);
    let acting = recorded.as_ref().and_then(loads_of_record);
    let asked = match &acting {
        // a run with all loads, or a model with those of the last choice
        None if recorded.as_ref().is_some_and(|r| r.get("loads").is_some()) => Asked::All,
        None => Asked::Kept,
        Some(acting) => Asked::Recorded(acting),
    };
    let span = SpanArgs {
        kind: args.kind,
        end: None,
        steps: None,
    };
    if run::has_commands(&file) {
        span.refuse_beside(&file)?;
    }
    let mut job = match run::has_commands(&file) {
        true => run::script_with(&file, dataset, asked)?,
        false => run::alone_with(
            &Single {
                variables: &[],
                model: &file,
                dataset,
                span: SpanArgs {
                    // at the start there is nothing to solve
                    end: Some(if args.at == 0.0 { 1.0 } else { args.at }),
                    ..span
                },
            },
            asked,
        )?,
    };
    let inputs = args.inputs.or_recorded(recorded.as_ref(), &args.file);
    inputs.drive_told(&mut job.reading.model, false)?;
    disk::note_input(&args.file);
    (args.writing).check([&args.out].into_iter().chain(&args.commands))?;
    let options = args.integration.given_to(Options {
        named_only: true,
        ..Options::default()
    });
    let mut options = args.unsolved.given_to(options);
    // a run is gone through as it was solved
    let error = || recorded.and_then(|r| r["error"].as_f64());
    options.error = options.error.or_else(error);
    let mut session = Session::new(job.reading.model, &job.base, options);
    session.folders = file.parent().map(Path::to_path_buf).into_iter().collect();
    let reached = lead(&mut session, &job.steps, args.at);
    let left = reached
        .map_err(|errors| Failure::in_model(&job.reading.dataset, errors.into_diagnostics()))?;
    let Some(mut left) = left else {
        return Err(not_reached(&session, args.at));
    };
    if !run::has_commands(&file) {
        left.clear();
    }
    write(args, &session, &left)
}

/// Returns the loads that acted in a run; `None`: all.
fn loads_of_record(record: &Value) -> Option<Vec<String>> {
    let names = record["loads"]["acting"].as_array()?;
    let name = |v: &Value| v.as_str().map(str::to_owned);
    Some(names.iter().filter_map(name).collect())
}

/// Returns why a run does not reach a time.
pub(super) fn not_reached(session: &Session, at: f64) -> Failure {
    let reason = &session.run.record.stop_reason;
    let end = digits_of_six(session.time());
    let what = match reason.is_empty() {
        true => format!("the run ends at {end}, before {}", digits_of_six(at)),
        false => format!("the run ends at {end}: {reason}"),
    };
    let mut failure = Failure::usage(what);
    let status = session.run.record.status;
    if status != Status::Completed {
        failure.exit = run::exit(status);
    }
    complain_in_files(&session.model.doubts());
    failure
}

/// Leads a session to a time; returns the commands that are left, the one that was cut first, or
/// `None` where the run ends before.
pub(super) fn lead(
    session: &mut Session,
    steps: &[Step],
    at: f64,
) -> Result<Option<Vec<Step>>, cognate::diagnostic::Error> {
    for (k, step) in steps.iter().enumerate() {
        let now = session.time();
        if let Command::Simulate(simulate) = &step.command
            && let Some((analysis, end, count)) = over_time(simulate, now)
            && end >= at
        {
            if at < now {
                return Ok(None);
            }
            let share = (count as f64 * (at - now) / (end - now)).round();
            let status = match (at > now, session.run.rows() > 0) {
                // the state of this time is there already
                (false, true) => Status::Completed,
                (false, false) => session.simulate(
                    Analysis::InitialConditions,
                    at,
                    1,
                    &mut interrupt::Listener,
                )?,
                // conversion saturates
                (true, _) => session.simulate(
                    analysis,
                    at,
                    (share as usize).max(1),
                    &mut interrupt::Listener,
                )?,
            };
            if status != Status::Completed || session.halted() {
                return Ok(None);
            }
            let rest = Step {
                command: Command::Simulate(Simulate {
                    end: Some(end),
                    duration: None,
                    steps: simulate.dtout.is_none().then(|| {
                        let left = count.saturating_sub(share as usize).max(1);
                        u32::try_from(left).unwrap_or(u32::MAX)
                    }),
                    ..*simulate
                }),
                ..step.clone()
            };
            let rest = (end > at).then_some(rest);
            return Ok(Some(
                rest.into_iter().chain(steps[k + 1..].to_vec()).collect(),
            ));
        }
        let status = obey(
            session,
            std::slice::from_ref(step),
            |_, _| (),
            &mut interrupt::Listener,
        )?;
        let is_over = matches!(step.command, Command::Stop) || session.halted();
        if status != Status::Completed || is_over {
            return Ok(None);
        }
    }
    Ok(None)
}

/// Returns kind, end and number of output steps of a simulation over time; `None` for others.
fn over_time(simulate: &Simulate, now: f64) -> Option<(Analysis, f64, usize)> {
    let (analysis, end, output) = simulate.resolved(now).ok()?;
    let is_moment = matches!(analysis, Analysis::Static | Analysis::InitialConditions);
    (!is_moment).then(|| (analysis, end, output.count(now, end)))
}

/// Writes where a session stands, and the commands that are left.
fn write(args: &Args, session: &Session, left: &[Step]) -> Outcome {
    let Some(beginning) = session.state().beginning() else {
        return Err(Failure::usage("nothing has been simulated"));
    };
    let text = beginning.model.to_text();
    let again = dataset::read_text(&text);
    if again.failed() || again.model.to_text() != text {
        return Err(Failure {
            exit: Exit::Bug,
            ..Failure::from(Diagnostic::error(
                "bug",
                "the dataset does not read back as it was written; nothing was written",
            ))
        });
    }
    args.writing.text(&args.out, &text)?;
    let at = digits_of_six(beginning.time);
    let out = disk::text(&args.out);
    remark(format!("{out} begins at time 0, which is {at} of the run"));
    for change in &beginning.changes {
        remark(change);
    }
    let model = &beginning.model;
    let has_left = left.iter().any(|s| !matches!(s.command, Command::Stop));
    match &args.commands {
        Some(file) => {
            let text = commands(&args.out, model, left, beginning.time);
            args.writing.text(file, &text)?;
            remark(format!(
                "{} holds the commands that are left",
                disk::text(&file)
            ));
        }
        None if !untold(model).is_empty() => {
            let names: Vec<String> = untold(model).iter().map(ToString::to_string).collect();
            let d = Diagnostic::warning(
                Cause::Approximate,
                format!(
                    "a dataset does not tell what is switched off: {}",
                    names.join(", ")
                ),
            );
            let advice = "--commands FILE.acf switches it off and holds the commands that are left";
            complain_in_files(&[d.help(advice)]);
        }
        None if has_left => {
            remark("--commands FILE.acf writes the commands that are left");
        }
        None => {}
    }
    Ok(Exit::Done)
}

/// Returns the elements that are switched off, which a dataset does not tell; but for those within
/// rigid bodies, which it does.
fn untold(model: &Model) -> Vec<ElementId> {
    let within = model.within_rigid_bodies();
    model.inactive.difference(&within).copied().collect()
}

/// Returns a command file for what is left of a run from a time on.
pub(super) fn commands(out: &Path, model: &Model, left: &[Step], at: f64) -> String {
    let name = run::stem(out);
    let mut text = format!("FILE/MODEL={name}, OUTPUT_PREFIX={name}\n");
    let mut off: BTreeMap<ElementKind, Vec<String>> = BTreeMap::new();
    for id in &model.inactive {
        off.entry(id.kind).or_default().push(id.number.to_string());
    }
    for (kind, numbers) in off {
        for numbers in numbers.chunks(10) {
            let numbers = numbers.join(",");
            text += &["DEACTIVATE/", kind.keyword(), ", ID=", &numbers, "\n"].concat();
        }
    }
    for step in left {
        match &step.command {
            Command::Simulate(simulate) => text += &simulate_line(simulate, at),
            Command::Change(record) if at != 0.0 && record.reads_time() => remark(format!(
                "{} is left out: it reads TIME, which is counted from zero now",
                step.text
            )),
            Command::Change(_)
            | Command::Activate { .. }
            | Command::Linear(_)
            | Command::Save(_)
            | Command::Reload(_)
            | Command::Show(_) => text += &format!("{}\n", step.text),
            Command::File { .. } => {}
            Command::Stop => break,
        }
    }
    text + "STOP\n"
}

/// Returns a SIMULATE whose end is counted from a time.
fn simulate_line(simulate: &Simulate, at: f64) -> String {
    let kind = match simulate.kind {
        SimulationKind::Kinematic => "KINEMATIC",
        SimulationKind::Dynamic => "DYNAMIC",
        SimulationKind::Static => "STATIC",
        SimulationKind::Transient => "TRANSIENT",
        SimulationKind::InitialConditions => "INITIAL_CONDITIONS",
    };
    let given = [
        simulate.end.map(|end| format!(", END={:?}", end - at)),
        simulate.duration.map(|d| format!(", DURATION={d:?}")),
        simulate.steps.map(|n| format!(", STEPS={n}")),
        simulate.dtout.map(|dt| format!(", DTOUT={dt:?}")),
    ];
    let given: String = given.into_iter().flatten().collect();
    ["SIMULATE/", kind, &given, "\n"].concat()
}
