//! `cognate run`: a model with its commands, from file to results.

use super::progress::Progress;

use super::{Exit, Failure, Outcome, interrupt, linear, remark, say, summary};
use crate::analysis::dynamics::Watch;
use crate::analysis::script::obey;
use crate::analysis::session::{Options, Session};
use crate::dataset::command::{Command, Script, Simulate, SimulationKind, Step};
use crate::dataset::{self, Reading};
use crate::diagnostic::{Diagnostic, Severity};
use crate::numeric::Stats;
use crate::results::{self, Event, Run, Status, csv, json, msg, res};
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
    /// Leave out elements of this kind where they are not solved (repeatable)
    #[arg(long = "skip-unsupported", value_name = "KEYWORD")]
    skip: Vec<String>,
    /// Take what USER(…) would compute as zero
    #[arg(long = "zero-user")]
    zero_user: bool,
    /// Run motions whose displacement or velocity jumps, piece by piece
    #[arg(long)]
    piecewise: bool,
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
    progress: &'a std::cell::RefCell<Progress>,
}

impl Watch for Terminal<'_> {
    fn interrupted(&mut self) -> bool {
        interrupt::requested()
    }
    fn progress(&mut self, t: f64, _h: f64, _stats: &Stats) {
        self.progress.borrow().at(t);
    }
}

pub fn run(args: &Args) -> Outcome {
    let clock = Instant::now();
    interrupt::install();
    let is_command = args
        .model
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("acf"));
    let Job {
        reading,
        base,
        steps,
    } = if is_command {
        script(&args.model)?
    } else {
        alone(args)?
    };
    let warnings: Vec<Diagnostic> = reading
        .diagnostics
        .iter()
        .filter(|d| d.severity == Severity::Warning)
        .cloned()
        .collect();
    if !args.quiet && !warnings.is_empty() {
        remark(format!(
            "{} warnings in the dataset: cognate check tells them",
            warnings.len()
        ));
    }
    let model = reading.model;
    let full = model.settings.contains_key("RESULTS");
    let options = Options {
        error: args.error,
        method: args.method.clone(),
        repeat: args.repeat,
        columns: args.columns.clone(),
        full,
        piecewise: args.piecewise,
        skip: args.skip.iter().map(|k| k.to_ascii_uppercase()).collect(),
        zero_user: args.zero_user,
    };
    let mut session = Session::new(model, &base, options);
    session.run.record.model = args.model.display().to_string();
    session
        .run
        .log
        .push(Event::Title(session.run.title.clone()));
    session.run.record.read_seconds = clock.elapsed().as_secs_f64();
    let progress = std::cell::RefCell::new(Progress::new(true, 0.0, 1.0));
    let begin = |start: f64, end: f64| {
        progress.borrow().done();
        *progress.borrow_mut() = Progress::new(args.quiet, start, end);
    };
    let outcome = obey(
        &mut session,
        &steps,
        begin,
        &mut Terminal {
            progress: &progress,
        },
    );
    progress.borrow().done();
    let record = &mut session.run.record;
    let (status, failure) = match outcome {
        Ok(status) => (status, None),
        Err(errors) => {
            record.status = Status::Model;
            record.stop_reason = errors.first().map(ToString::to_string).unwrap_or_default();
            session
                .run
                .log
                .extend(errors.iter().map(|e| Event::Error(e.to_string())));
            (Status::Model, Some(errors))
        }
    };
    let elapsed = clock.elapsed().as_secs_f64();
    session.run.log.push(Event::Finished {
        elapsed,
        cpu: cpu_seconds().unwrap_or(elapsed),
    });
    let dir = args.out.clone().unwrap_or_else(|| PathBuf::from("."));
    let mut written = write(&mut session.run, &dir, full)?;
    written.extend(linear::write(&session, &dir)?);
    if args.json {
        say(&json::text(&json::record(&session.run)));
    } else if !args.quiet {
        written.extend(summary::picture(&session.run, &dir));
        say(&summary::table(&session.run));
        remark(summary::facts(&session.run, &written).trim_end());
    }
    if let Some(diagnostics) = failure {
        return Err(Failure::in_files(Exit::Model, diagnostics));
    }
    if status != Status::Completed && (args.quiet || args.json) {
        remark(&session.run.record.stop_reason);
    }
    Ok(exit(status))
}

/// What is to be run.
pub(super) struct Job {
    pub reading: Reading,
    pub base: String,
    pub steps: Vec<Step>,
}

pub(super) fn exit(status: Status) -> Exit {
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
fn alone(args: &Args) -> Result<Job, Failure> {
    let reading = read(&args.model)?;
    let kind = match args.kind.unwrap_or(KindName::Transient) {
        KindName::Dynamic => SimulationKind::Dynamic,
        KindName::Kinematic => SimulationKind::Kinematic,
        KindName::Static => SimulationKind::Static,
        KindName::Transient => SimulationKind::Transient,
        KindName::InitialConditions => SimulationKind::InitialConditions,
    };
    let over_time = !matches!(
        kind,
        SimulationKind::Static | SimulationKind::InitialConditions
    );
    if over_time && args.end.is_none() {
        return Err(Failure::usage(
            "a dataset without a command file needs --end TIME",
        ));
    }
    let steps = args.steps.map(|n| u32::try_from(n).unwrap_or(u32::MAX));
    let simulate = Simulate {
        kind,
        end: args.end,
        duration: None,
        steps,
        dtout: None,
    };
    let step = Step {
        command: Command::Simulate(simulate),
        text: "SIMULATE".into(),
        line: 0,
    };
    Ok(Job {
        reading,
        base: stem(&args.model),
        steps: vec![step],
    })
}

pub(super) fn stem(path: &Path) -> String {
    path.file_stem()
        .map_or_else(|| "run".into(), |s| s.to_string_lossy().into_owned())
}

pub(super) fn read(path: &Path) -> Result<Reading, Failure> {
    let reading = dataset::read(path).map_err(|e| Failure::in_files(Exit::Input, e.0))?;
    if reading.failed() {
        let errors = reading
            .diagnostics
            .into_iter()
            .filter(|d| d.severity == Severity::Error);
        return Err(Failure::in_files(Exit::Input, errors.collect()));
    }
    Ok(reading)
}

/// A command file and the dataset it names.
pub(super) fn script(path: &Path) -> Result<Job, Failure> {
    let script = Script::read(path).map_err(|e| Failure::in_files(Exit::Input, e.0))?;
    let Some(file) = script.model_file() else {
        let d = Diagnostic::error("no_model", format!("{} names no dataset", path.display()));
        return Err(d.help("begin it with FILE/MODEL=name").into());
    };
    let base = script.output.clone().unwrap_or_else(|| stem(path));
    Ok(Job {
        reading: read(&file)?,
        base,
        steps: script.steps,
    })
}

/// Writes everything the run produced; the names of the files. The record comes last: who sees it finds the others complete.
fn write(run: &mut Run, dir: &Path, full: bool) -> Result<Vec<PathBuf>, Failure> {
    let clock = Instant::now();
    std::fs::create_dir_all(dir)
        .map_err(|e| Diagnostic::error("file_unwritable", format!("{}: {e}", dir.display())))?;
    let path = |ending: &str| dir.join(format!("{}.{ending}", run.name));
    let mut texts = vec![(path("csv"), csv::write(run, true))];
    if full {
        texts.push((path("res"), res::write(run)));
    }
    texts.push((path("msg"), msg::write(run)));
    let record = path("json");
    for (file, text) in &texts {
        results::write_text(file, text)?;
    }
    run.record.write_seconds = clock.elapsed().as_secs_f64();
    results::write_text(&record, &json::text(&json::record(run)))?;
    Ok(texts.into_iter().map(|t| t.0).chain([record]).collect())
}

/// Time that this process has computed, where the system tells.
fn cpu_seconds() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}
