//! `cognate run`: a model with its commands, from file to results.

use super::progress::Progress;
use super::{Exit, Failure, Outcome, interrupt, remark};
use crate::analysis::dynamics::Watch;
use crate::analysis::session::{Analysis, Options, Session};
use crate::diagnostic::Diagnostic;
use crate::model::Model;
use crate::numeric::Stats;
use crate::results::{self, Event, Status, csv, json, msg, res};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Solve a model: a command file (.acf) with its dataset, or a dataset (.adm) alone
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate run pendulum.acf
  cognate run pendulum.adm --end 2 --steps 200 --column 'DX(12,21)'
  cognate run pendulum.acf --error 1e-8 --method DOP853 --out results --json")]
pub struct Args {
    /// Command file (.acf) or dataset (.adm)
    model: PathBuf,
    /// Permitted local error of the integration, relative to the magnitude of each unknown
    #[arg(long, value_name = "E")]
    error: Option<f64>,
    /// Method of integration (AUTO chooses by itself)
    #[arg(long, value_name = "NAME")]
    method: Option<String>,
    /// A further column of the table: any expression (repeatable)
    #[arg(long = "column", value_name = "EXPR")]
    columns: Vec<String>,
    /// End of the simulation, for a dataset without command file
    #[arg(long, value_name = "TIME")]
    end: Option<f64>,
    /// Output steps, for a dataset without command file
    #[arg(long, value_name = "N")]
    steps: Option<usize>,
    /// Kind of simulation, for a dataset without command file
    #[arg(long = "type", value_name = "KIND", value_enum)]
    kind: Option<KindName>,
    /// Folder that results are written to
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Solve N times and report the median time
    #[arg(long, value_name = "N", default_value_t = 1)]
    repeat: usize,
    /// Say nothing but mistakes
    #[arg(long)]
    quiet: bool,
    /// Print the run record as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum KindName {
    Dynamic,
    Kinematic,
    Static,
    Transient,
    InitialConditions,
}

/// Shows progress and listens for Ctrl-C.
struct Terminal<'a> {
    progress: &'a Progress,
}

impl Watch for Terminal<'_> {
    fn interrupted(&mut self) -> bool {
        interrupt::requested()
    }
    fn progress(&mut self, t: f64, _h: f64, _stats: &Stats) {
        self.progress.at(t);
    }
}

/// One SIMULATE.
struct Step {
    analysis: Analysis,
    end: f64,
    steps: usize,
}

pub fn run(args: &Args) -> Outcome {
    let clock = Instant::now();
    interrupt::install();
    let is_command = args
        .model
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("acf"));
    let (model, base, steps) = if is_command {
        script(&args.model)?
    } else {
        alone(args)?
    };
    let full = model.settings.contains_key("RESULTS");
    let options = Options {
        error: args.error,
        method: args.method.clone(),
        repeat: args.repeat,
        columns: args.columns.clone(),
        full,
    };
    let mut session = Session::new(model, &base, options);
    session.run.record.model = args.model.display().to_string();
    session
        .run
        .log
        .push(Event::Title(session.run.title.clone()));
    session.run.record.read_seconds = clock.elapsed().as_secs_f64();
    let mut status = Status::Completed;
    let mut failure = None;
    for step in steps {
        let progress = Progress::new(args.quiet, session.time(), step.end);
        let outcome = session.simulate(
            step.analysis,
            step.end,
            step.steps,
            &mut Terminal {
                progress: &progress,
            },
        );
        progress.done();
        match outcome {
            Ok(Status::Completed) => {}
            Ok(other) => {
                status = other;
                break;
            }
            Err(errors) => {
                failure = Some(errors);
                break;
            }
        }
    }
    let dir = args.out.clone().unwrap_or_else(|| PathBuf::from("."));
    if let Some(errors) = &failure {
        let record = &mut session.run.record;
        record.status = Status::Model;
        record.stop_reason = errors.first().map(ToString::to_string).unwrap_or_default();
        session
            .run
            .log
            .extend(errors.iter().map(|e| Event::Error(e.to_string())));
    }
    let written = write(&mut session.run, &dir, full)?;
    if args.json {
        println!("{}", json::text(&json::record(&session.run)));
    } else if !args.quiet {
        report(&session.run, &written);
    }
    if let Some(diagnostics) = failure {
        return Err(Failure {
            exit: Exit::Model,
            diagnostics,
            sources: super::render::Sources::default(),
        });
    }
    if status != Status::Completed && !args.quiet {
        remark(&session.run.record.stop_reason);
    }
    Ok(exit(status))
}

fn exit(status: Status) -> Exit {
    match status {
        Status::Completed => Exit::Done,
        Status::Model => Exit::Model,
        Status::NoEquilibrium => Exit::NoEquilibrium,
        Status::Stopped => Exit::Stopped,
        Status::Limit => Exit::Limit,
        Status::Interrupted => Exit::Interrupted,
    }
}

/// A dataset with one simulation given by options.
fn alone(args: &Args) -> Result<(Model, String, Vec<Step>), Failure> {
    let model = read(&args.model)?;
    let analysis = match args.kind.unwrap_or(KindName::Transient) {
        KindName::Dynamic => Analysis::Dynamic,
        KindName::Kinematic => Analysis::Kinematic,
        KindName::Static => Analysis::Static,
        KindName::Transient => Analysis::Transient,
        KindName::InitialConditions => Analysis::InitialConditions,
    };
    let needs_end = !matches!(analysis, Analysis::Static | Analysis::InitialConditions);
    if needs_end && args.end.is_none() {
        return Err(Failure::usage(
            "a dataset without a command file needs --end TIME",
        ));
    }
    let step = Step {
        analysis,
        end: args.end.unwrap_or(0.0),
        steps: args.steps.unwrap_or(50),
    };
    Ok((model, stem(&args.model), vec![step]))
}

fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or_else(|| "run".into(), |s| s.to_string_lossy().into_owned())
}

fn read(path: &Path) -> Result<Model, Failure> {
    Model::read(path).map_err(|errors| Failure {
        exit: Exit::Input,
        diagnostics: errors.0,
        sources: super::render::Sources::default(),
    })
}

/// A command file and the dataset it names.
fn script(path: &Path) -> Result<(Model, String, Vec<Step>), Failure> {
    let text = std::fs::read_to_string(path)
        .map_err(|e| Diagnostic::error("cannot_open", format!("{}: {e}", path.display())))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut steps = Vec::new();
    let mut lines = text.lines().map(str::trim);
    let first = lines.next().unwrap_or_default().to_string();
    let mut name = first.clone();
    for line in text.lines().map(str::trim) {
        let upper = line.to_ascii_uppercase();
        if let Some(rest) = upper.strip_prefix("FILE/MODEL=") {
            name = line[line.len() - rest.len()..].to_string();
        }
        let Some(rest) = upper.strip_prefix("SIM") else {
            continue;
        };
        let Some((_, rest)) = rest.split_once('/') else {
            continue;
        };
        let value = |key: &str| {
            rest.split(',').find_map(|p| {
                p.trim()
                    .strip_prefix(key)?
                    .trim_start_matches('=')
                    .trim()
                    .parse::<f64>()
                    .ok()
            })
        };
        let analysis = if rest.starts_with("STAT") {
            Analysis::Static
        } else if rest.starts_with("KIN") {
            Analysis::Kinematic
        } else if rest.starts_with("TRAN") {
            Analysis::Transient
        } else {
            Analysis::Dynamic
        };
        let end = value("END").unwrap_or(0.0);
        let steps_given = value("STEPS").or_else(|| value("DTOUT").map(|d| (end / d).round()));
        steps.push(Step {
            analysis,
            end,
            steps: steps_given.unwrap_or(50.0) as usize,
        });
    }
    let mut file = folder.join(&name);
    if file.extension().is_none() {
        file.set_extension("adm");
    }
    Ok((read(&file)?, stem(path), steps))
}

/// Writes everything the run produced; the names of the files.
fn write(run: &mut results::Run, dir: &Path, full: bool) -> Result<Vec<PathBuf>, Failure> {
    let clock = Instant::now();
    std::fs::create_dir_all(dir)
        .map_err(|e| Diagnostic::error("cannot_write", format!("{}: {e}", dir.display())))?;
    let path = |ending: &str| dir.join(format!("{}.{ending}", run.name));
    let mut written = Vec::new();
    let mut save = |ending: &str, text: String| -> Result<(), Failure> {
        let p = path(ending);
        results::write_text(&p, &text)?;
        written.push(p);
        Ok(())
    };
    save("csv", csv::write(run, true))?;
    if full {
        save("res", res::write(run))?;
    }
    save("msg", msg::write(run))?;
    let seconds = clock.elapsed().as_secs_f64();
    run.record.write_seconds = seconds;
    let p = dir.join(format!("{}.json", run.name));
    results::write_text(&p, &json::text(&json::record(run)))?;
    written.push(p);
    Ok(written)
}

/// What happened, in a few lines.
fn report(run: &results::Run, written: &[PathBuf]) {
    let r = &run.record;
    remark(format!(
        "{}: {} rows, {} steps of {}, {:.3} ms",
        r.status.word(),
        run.table_rows().count(),
        r.counts.steps,
        r.method,
        1e3 * r.solve_seconds
    ));
    for p in written {
        remark(p.display().to_string());
    }
}
