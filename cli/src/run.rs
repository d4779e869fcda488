//! `cognate run`: a model with its commands, from file to results.

use super::arguments::{IntegrationArgs, LimitArgs, SpanArgs, UnsolvedArgs, whole_from_one};
use super::attended::Attended;
use super::doubted;
use super::inputs::InputArgs;
use super::limit::Guard;
use super::missing::{missing, names_no_dataset};
use super::mistake::Mistake;
use super::render::Sources;
use super::setup::{self, Asked, Prepared, Setup};
use super::{Exit, Failure, Outcome, interrupt, linear, output, piped, remark, say, summary};
use cognate::analysis::session::state::{self, Saved};
use cognate::analysis::session::{Accuracy, Chosen, Options, Session, check_column};
use cognate::analysis::work_limit::ProcessClock;
use cognate::dataset::command::{Command, Script, SimulationKind, Step};
use cognate::dataset::{self, Dataset, Reading};
use cognate::diagnostic::{Cause, Diagnostic, Error, Severity};
use cognate::disk;
use cognate::model::{ElementKind, Family, Model, SettingsStatement};
use cognate::results::format::Format;
use cognate::results::{Event, Loads, Status, json};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Solve a model: a command file (.acf) with its dataset, or a dataset (.adm) alone
///
/// MODEL.toml beside the dataset, if there is one, says the rest: which loads act, their functions,
/// and the set-up of the run (`cognate loads`).
#[derive(clap::Args, Clone)]
#[command(after_help = "\
Examples:
  cognate run pendulum.acf
  cognate run Controls_Plant_1.msg plant.adm
  cognate run pendulum.adm --end 2 --steps 200 --column 'DX(12,21)'
  cognate run pendulum.acf --animate --open
  cognate run pendulum.acf --name stiff --out results
  cognate run crash.adm --loads braking,gravity --end 2
  cognate run pendulum.acf --error 1e-8 --method DOP853 --out results --json")]
pub struct Args {
    /// Command file (.acf), log of an earlier run whose commands are obeyed again (.msg), dataset
    /// (.adm), or command file of Adams View (.cmd); - reads a dataset from standard input
    #[arg(value_parser = piped::model())]
    model: PathBuf,
    /// Dataset that the commands are for, where it is not the one that they name
    dataset: Option<PathBuf>,
    #[command(flatten)]
    integration: IntegrationArgs,
    /// A further column of the table: any expression (repeatable) [default: none]
    #[arg(long = "column", value_name = "EXPR")]
    columns: Vec<String>,
    #[command(flatten)]
    span: SpanArgs,
    /// Load cases and loads that act, as SFORCE/3 or gravity; `all` for all loads. The choice is
    /// kept in MODEL.toml for the next runs [default: those of the last choice, else all]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    loads: Vec<String>,
    /// Value of a design variable of a command file of Adams View, as .model.DV_1=2.5 (repeatable);
    /// what depends on it is computed anew [default: those of the file]
    #[arg(long, value_name = "NAME=VALUE", value_parser = variable)]
    set: Vec<(String, f64)>,
    #[command(flatten)]
    inputs: InputArgs,
    /// Folder that results are written to, or - for the table alone on standard output, as .csv or
    /// by json:- and so on [default: here]
    #[arg(short = 'o', long, value_name = "DIR", value_parser = piped::run_folder())]
    out: Option<PathBuf>,
    /// Name of the run, which its files begin with [default: OUTPUT_PREFIX, else the model's]
    #[arg(long, value_name = "NAME", value_parser = run_name)]
    name: Option<String>,
    /// Solve N times and report the median time
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole_from_one)]
    repeat: usize,
    #[command(flatten)]
    unsolved: UnsolvedArgs,
    #[command(flatten)]
    routines: super::routines::RoutineArgs,
    #[command(flatten)]
    limits: LimitArgs,
    /// Threads for mechanisms that nothing couples, which change no result [default: as many as
    /// there are processors]
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    #[command(flatten)]
    output: output::FileArgs,
    /// Record only this element, as JOINT/3 or by its name, or this kind, as JOINT (repeatable);
    /// tables show it [default: all]
    #[arg(long, value_name = "ELEMENT", value_delimiter = ',')]
    only: Vec<Chosen>,
    /// Record velocities and accelerations of the bodies' centres of mass, eight each; tables show
    /// them
    #[arg(long)]
    body_motion: bool,
    /// Give every column bars of error (`name±`), from a further run at a smaller request
    #[arg(long)]
    accuracy: bool,
    /// Do not measure how far off the results are, which takes a further integration at a larger
    /// request
    #[arg(long, conflicts_with = "accuracy")]
    no_accuracy: bool,
    /// Say nothing but mistakes, and draw no picture of the table
    #[arg(long)]
    quiet: bool,
    /// Print the run record as JSON
    #[arg(long)]
    json: bool,
}

/// Runs a model with its commands and writes its results.
///
/// # Errors
/// When a file has mistakes or cannot be written, or the model cannot work.
pub fn run(args: &Args) -> Outcome {
    run_holding(args, &mut None)
}

/// Does the same as the last thing of a process: what the run holds is left to the system, which
/// takes it back at once, and not piece by piece.
///
/// # Errors
/// As [`run`].
pub fn run_last(args: &Args) -> Outcome {
    let mut held = None;
    let outcome = run_holding(args, &mut held);
    std::mem::forget(held);
    outcome
}

/// Runs a model; hands over what the run holds in the end.
fn run_holding(args: &Args, held: &mut Option<(Session, Dataset)>) -> Outcome {
    let clock = ProcessClock::start();
    interrupt::install_for_run();
    let guard = Guard::set(args.limits.limit, clock);

    // read
    let is_command = has_commands(&args.model);
    let job = job(args, is_command)?;
    let args = &args.completed(&job.setup)?;
    let [read, about_mechanism] = doubted::remark_on(&job, args.quiet);
    if !args.quiet {
        remark_on_loads(&job);
    }
    let is_as_read = job.is_as_read() && !args.inputs.is_given();
    let (Reading { model, dataset, .. }, steps) = (job.reading, job.steps);
    check_columns(args, &model, &steps)?;
    let name = args.name.as_ref().unwrap_or(&job.base);
    let mut session = open(args, (model, is_as_read), name);
    let mistake = (args.routines).compute(&mut session, &dataset, args.unsolved.zero_user)?;
    let seconds = &mut session.run.record.seconds;
    seconds.begin(clock.elapsed(), job.read_seconds);
    session.run.record.loads = job.loads;
    let doubts: Vec<_> = read.iter().chain(&about_mechanism).cloned().collect();
    note_doubts(&mut session, &doubts);
    let shown = !args.json && !args.quiet;
    let tables = tables_of(args, &mut session, &steps, clock)?;
    guard.follow(&session, &tables);

    // solve
    let outcome = attended(args, (&tables, &guard, &mistake)).solve(&mut session, &steps);
    let (status, failure) = told(&mut session, outcome);
    let elapsed = clock.elapsed().as_secs_f64();
    let cpu = clock.seconds();
    session.run.log.push(Event::Finished { elapsed, cpu });

    // write and report
    guard.done();
    let is_piped = args.out.as_deref().is_some_and(piped::is_output);
    let is_nothing = failure.is_some() || status == Status::Interrupted;
    let is_refused = is_nothing && session.run.rows() == 0;
    let (written, record) = if is_refused {
        // what an earlier run has written stays
        (Vec::new(), json::text(&json::record(&session.run)))
    } else {
        tables.complete(&mut session, shown && !is_piped)?
    };
    if args.output.open {
        open_pages(&written);
    }
    if args.json {
        say(&record);
    } else if shown && is_piped {
        remark(summary::facts(&session.run, &[]).trim_end());
    } else if shown && !is_refused {
        say(&tables.overview(&session.run));
        remark(summary::facts(&session.run, &written).trim_end());
    }
    if let Some(mut diagnostics) = failure {
        // a place without a file belongs to the commands
        let commands = disk::text(&args.model);
        for d in diagnostics
            .iter_mut()
            .filter(|d| is_command && d.file.is_none() && d.line > 0)
        {
            d.file = Some(commands.clone());
        }
        // what is doubted may be why
        let said = read.into_iter().chain(diagnostics);
        let all: Vec<_> = said.chain(session.model.doubts()).collect();
        return Err(Failure::in_model(&dataset, all));
    }
    if status != Status::Completed {
        super::complain_in_files(&doubts);
    }
    if status != Status::Completed && (args.quiet || args.json) {
        remark(&session.run.record.stop_reason);
    }
    *held = Some((session, dataset));
    Ok(exit(status))
}

/// Opens the tables of a run, where all of its files may be written.
fn tables_of(
    args: &Args,
    session: &mut Session,
    steps: &[Step],
    clock: ProcessClock,
) -> Result<output::Tables, Error> {
    let name = session.run.name.clone();
    let endings = [
        Some("msg"),
        (!args.json && !args.quiet).then_some("svg"),
        args.output.animate.then_some("html"),
    ];
    let own = endings.into_iter().flatten();
    let mut more = linear::named_by(&name, steps);
    more.extend(own.map(|ending| format!("{name}.{ending}")));
    output::Tables::open(&args.output, (args.out.as_deref(), &more), session, clock)
}

/// Opens the pages among files that were written.
fn open_pages(written: &[PathBuf]) {
    let is_page = |file: &&PathBuf| super::moved::has_ending(file, "html");
    (written.iter().filter(is_page)).for_each(|file| super::animate::open(file));
}

/// Reads the model of a run and its commands, with the loads and inputs that are asked for.
fn job(args: &Args, is_command: bool) -> Result<Job, Failure> {
    let mut job = loaded(args, is_command)?;
    args.inputs.drive_job(&mut job)?;
    Ok(job)
}

/// Reads the model of a run and its commands, with the loads that are asked for.
fn loaded(args: &Args, is_command: bool) -> Result<Job, Failure> {
    let asked = match args.loads.is_empty() {
        true => Asked::Kept,
        false => Asked::New(&args.loads),
    };
    if is_command {
        if !args.set.is_empty() {
            let what =
                "--set NAME=VALUE sets design variables of a command file of Adams View (.cmd)";
            return Err(Failure::usage(what));
        }
        args.span.refuse_beside(&args.model)?;
        let (dataset, trusting) = (args.dataset.as_deref(), args.output.trust_paths);
        return script_from(&args.model, dataset, asked, trusting);
    }
    let single = Single {
        model: &args.model,
        dataset: args.dataset.as_deref(),
        span: args.span,
        variables: &args.set,
    };
    alone_with(&single, asked)
}

impl Args {
    /// Returns these arguments, with those of a set-up where they are not given.
    ///
    /// # Errors
    /// More than one thing goes to standard output.
    fn completed(&self, setup: &Setup) -> Result<Self, Failure> {
        let mut all = self.clone();
        let solve = &setup.solve;
        let IntegrationArgs { error, method } = &mut all.integration;
        *error = error.or(solve.error);
        *method = method.take().or_else(|| solve.method.clone());
        all.body_motion |= solve.body_motion;
        if all.columns.is_empty() {
            all.columns.clone_from(&solve.columns);
        }
        if all.only.is_empty() {
            all.only.clone_from(&solve.only);
        }
        if all.output.formats.is_empty() {
            all.output.formats.clone_from(&solve.formats);
        }
        if let Some(format) = piped::run_format(self.out.as_deref(), &all.output.formats)? {
            if self.json || self.output.animate {
                let what = "standard output takes the table alone: -o DIR beside --json, --animate";
                return Err(Failure::usage(what));
            }
            all.output.formats = vec![format];
        }
        Ok(all)
    }
}

/// Notes what is doubted in the files in the log and the record.
fn note_doubts(session: &mut Session, doubts: &[Diagnostic]) {
    (session.run.log).extend(doubts.iter().map(|d| Event::Warning(d.to_string())));
    session.run.record.doubts = doubts.to_vec();
}

/// Remarks on the loads that were chosen, or that nothing acts at all.
fn remark_on_loads(job: &Job) {
    if let Some(loads) = &job.loads {
        return remark(setup::loads_acting(loads));
    }
    let model = &job.reading.model;
    let pushes = |kind| {
        model
            .numbers(kind)
            .into_iter()
            .any(|n| model.is_active(ElementKind::id(kind, n)))
    };
    let is_pushed = ElementKind::of(Family::Force).any(pushes);
    if !job.changes_the_model() && !is_pushed && setup::loads_of(model).is_empty() {
        remark("no load acts: no motion, no force, no gravity, no initial velocity");
    }
}

/// Reads the name of a run: that of a file.
pub(super) fn run_name(text: &str) -> Result<String, String> {
    match cognate::internals::results::kept::is_run_name(text) {
        true => Ok(text.to_owned()),
        false => Err("a run is named as a file is, without a folder: --out DIR".to_owned()),
    }
}

/// Notes in the record why a model could not be run; returns the status, and the mistakes.
fn told(
    session: &mut Session,
    outcome: Result<Status, Error>,
) -> (Status, Option<Vec<Diagnostic>>) {
    let errors = match outcome {
        Ok(status) => return (status, None),
        Err(error) => error.into_diagnostics(),
    };
    let record = &mut session.run.record;
    record.status = Status::Model;
    record.stop_code = errors.first().map_or("", |d| d.code);
    record.stop_reason = errors.first().map(ToString::to_string).unwrap_or_default();
    let events = errors.iter().map(|e| Event::Error(e.to_string()));
    session.run.log.extend(events);
    (Status::Model, Some(errors))
}

/// Checks the columns and elements that the command line asks for, before anything is solved or
/// written.
fn check_columns(args: &Args, model: &Model, steps: &[Step]) -> Result<(), Failure> {
    // commands may make what a column reads
    let changes = |s: &Step| matches!(s.command, Command::Change(_));
    let is_final = !steps.iter().any(changes);
    let mut failure = Failure {
        exit: Exit::Input,
        diagnostics: Vec::new(),
        sources: Sources::default(),
    };
    for (k, text) in args.columns.iter().enumerate() {
        let place = match args.columns.len() {
            1 => "--column".to_owned(),
            _ => format!("--column {}", k + 1),
        };
        for mut d in check_column(model, text) {
            if is_final || !d.is(Cause::UnknownElement) {
                d.file = Some(place.clone());
                failure.diagnostics.push(d);
            }
        }
        failure.sources.add(place, text.clone());
    }
    let chosen = args.only.iter().filter(|_| is_final);
    let unknown = chosen.filter_map(|chosen| chosen.in_model(model).err());
    failure.diagnostics.extend(unknown.map(|mut d| {
        d.file = Some("--only".into());
        d
    }));
    if failure.diagnostics.is_empty() {
        Ok(())
    } else {
        Err(failure)
    }
}

/// Opens the session of a model, with the options of the command line.
fn open(args: &Args, (model, is_as_read): (Model, bool), base: &str) -> Session {
    // formats for everything that was solved
    let complete = [Format::Res, Format::Parquet];
    let full = model.settings.contains_key(&SettingsStatement::Results)
        || complete.iter().any(|f| args.output.formats.contains(f))
        || args.body_motion
        || args.output.animate
        || !args.only.is_empty();
    let options = Options {
        repeat: args.repeat,
        columns: args.columns.clone(),
        full,
        frames: args.output.need(&model, Format::Gra),
        body_rates: args.body_motion,
        only: args.only.clone(),
        accuracy: match (args.accuracy, args.no_accuracy) {
            (true, _) => Accuracy::Bars,
            (_, true) => Accuracy::Unknown,
            _ => Accuracy::Digits,
        },
        threads: Some(args.threads.unwrap_or(0)),
        ..Options::default()
    };
    let options = args.integration.given_to(options);
    let options = args.limits.given_to(args.unsolved.given_to(options));
    let mut session = Session::new(model, base, options);
    if is_as_read {
        session.was_read();
    }
    session.end_with_commands();
    session.run.record.model = disk::text(&args.model);
    session.run.record.inputs = args.inputs.table();
    let folder = args.model.parent().map(Path::to_path_buf);
    session.folders = args.out.clone().into_iter().chain(folder).collect();
    let title = Event::Title(session.run.title.clone());
    session.run.log.push(title);
    session
}

/// Returns what a run is attended by.
fn attended<'a>(
    args: &Args,
    (tables, guard, mistake): (&'a output::Tables, &'a Guard, &'a Mistake),
) -> Attended<'a> {
    Attended {
        is_quiet: args.quiet,
        has_bars: args.accuracy,
        tables,
        guard,
        mistake,
    }
}

/// The model and the commands of a run.
pub(super) struct Job {
    /// the model and its dataset
    pub reading: Reading,
    /// base of the names of the files
    pub base: String,
    /// the commands
    pub steps: Vec<Step>,
    /// the file beside the dataset
    pub setup: Setup,
    /// the loads that were chosen; `None`: all loads act
    pub loads: Option<Loads>,
    /// warnings and notes about the commands
    pub remarks: Vec<Diagnostic>,
    /// time that the bytes of the dataset took, in s
    pub read_seconds: f64,
}

impl Job {
    /// Returns whether commands change the model, or what is active in it.
    pub fn changes_the_model(&self) -> bool {
        let changes = |s: &Step| matches!(s.command, Command::Change(_) | Command::Activate { .. });
        self.steps.iter().any(changes)
    }

    /// Returns whether the model is that of the dataset: a file beside it may change it.
    fn is_as_read(&self) -> bool {
        self.setup.text.is_empty() && self.loads.is_none() && !self.reading.failed()
    }
}

/// Returns the exit of a status.
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

/// A dataset with one simulation that the command line describes.
pub(super) struct Single<'a> {
    /// the dataset
    pub model: &'a Path,
    /// a second file, which is a mistake
    pub dataset: Option<&'a Path>,
    /// its kind, its end and its output steps
    pub span: SpanArgs,
    /// values of design variables
    pub variables: &'a [(String, f64)],
}

/// Prepares a dataset with one simulation given by options, else by its set-up, and the loads of
/// the last choice.
pub(super) fn alone(args: &Single<'_>) -> Result<Job, Failure> {
    alone_with(args, Asked::Kept).inspect(remark_on_choice)
}

/// Remarks on the loads that were chosen before, where a command takes them.
fn remark_on_choice(job: &Job) {
    if let Some(loads) = &job.loads {
        remark(setup::loads_acting(loads));
    }
}

/// Prepares a dataset with one simulation given by options, else by its set-up.
pub(super) fn alone_with(args: &Single<'_>, asked: Asked<'_>) -> Result<Job, Failure> {
    let job = standing_with(args, asked)?;
    match job.steps.is_empty() {
        true => Err(no_end()),
        false => Ok(job),
    }
}

/// Returns the failure of a dataset that nobody says when to end.
fn no_end() -> Failure {
    let what = "no end is given: --end TIME says when the simulation of a dataset ends";
    Failure::usage(format!("{what}, or a set-up (cognate loads setup)"))
}

/// Prepares a dataset with the simulation given by options or by its set-up, if one is.
pub(super) fn standing_with(args: &Single<'_>, asked: Asked<'_>) -> Result<Job, Failure> {
    if args.dataset.is_some() {
        let what = "a second file is the dataset of a command file (.acf) or of a log (.msg)";
        return Err(Failure::usage(what));
    }
    let (reading, read_seconds, Prepared { setup, loads }) =
        timed_read_with(args.model, asked, args.variables)?;
    let mut steps = single_simulation(args, &setup).unwrap_or_default();
    let mut remarks = Vec::new();
    if let Some(commands) = reading.commands.as_ref().filter(|_| steps.is_empty()) {
        // what a command file of Adams View asks for
        let script =
            Script::from_text(commands).map_err(|e| Failure::in_files(Exit::Input, e.into()))?;
        let what = commands.trim_end().replace('\n', "; ");
        let what = format!("no --end is given: what the file asks for is run: {what}");
        remarks = script.diagnostics;
        remarks.push(Diagnostic {
            severity: Severity::Note,
            ..Diagnostic::warning("view_script", what)
        });
        steps = script.steps;
    }
    Ok(Job {
        reading,
        base: stem(args.model),
        steps,
        setup,
        loads,
        remarks,
        read_seconds,
    })
}

/// Returns the simulation that options describe, as a command.
pub(super) fn alone_step(args: &Single<'_>) -> Result<Step, Failure> {
    let steps = single_simulation(args, &Setup::default()).unwrap_or_default();
    steps.into_iter().next_back().ok_or_else(no_end)
}

/// Returns the simulation that options describe, else a set-up, after one at rest where it asks for
/// that.
fn single_simulation(args: &Single<'_>, setup: &Setup) -> Option<Vec<Step>> {
    let SpanArgs { end, steps, kind } = args.span;
    let kind = kind.map(SimulationKind::from);
    setup.solve.simulations(kind, end, steps)
}

pub(super) fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "run".into(), disk::text)
}

/// Reads a dataset, with the loads of the last choice.
pub(super) fn read(path: &Path) -> Result<Reading, Failure> {
    read_with(path, Asked::Kept)
}

/// Reads a dataset, with loads.
pub(super) fn read_with(path: &Path, asked: Asked<'_>) -> Result<Reading, Failure> {
    timed_read(path, asked).map(|(reading, ..)| reading)
}

/// Reads a dataset and the file beside it; also returns the time that the bytes of the dataset
/// took, in s.
pub(super) fn timed_read(
    path: &Path,
    asked: Asked<'_>,
) -> Result<(Reading, f64, Prepared), Failure> {
    timed_read_with(path, asked, &[])
}

/// Does the same with values for design variables of a command file of Adams View.
pub(super) fn timed_read_with(
    path: &Path,
    asked: Asked<'_>,
    variables: &[(String, f64)],
) -> Result<(Reading, f64, Prepared), Failure> {
    let (mut reading, seconds) = read_bare_with(path, variables)?;
    let prepared = setup::prepare(path, &mut reading.model, asked)?;
    Ok((reading, seconds, prepared))
}

/// Reads a dataset alone, whatever stands beside it; also returns the time that its bytes took, in
/// s.
pub(super) fn read_bare(path: &Path) -> Result<(Reading, f64), Failure> {
    read_bare_with(path, &[])
}

fn read_bare_with(path: &Path, variables: &[(String, f64)]) -> Result<(Reading, f64), Failure> {
    let clock = Instant::now();
    let source = dataset::open(path).map_err(|e| Failure::in_files(Exit::Input, e.into()))?;
    let seconds = clock.elapsed().as_secs_f64();
    let reading = dataset::read_with(source, &variables.iter().cloned().collect());
    if !variables.is_empty() && !reading.is_view() {
        let what = "--set NAME=VALUE sets design variables of a command file of Adams View (.cmd)";
        return Err(Failure::usage(what));
    }
    if reading.failed() {
        let errors = reading
            .diagnostics
            .into_iter()
            .filter(|d| d.severity == Severity::Error);
        return Err(Failure::in_files(Exit::Input, errors.collect()));
    }
    Ok((reading, seconds))
}

/// Refuses what only datasets can have done to them for a command file of Adams View.
pub(super) fn refuse_view(reading: &Reading, what: &str) -> Result<(), Failure> {
    if !reading.is_view() {
        return Ok(());
    }
    let file = reading.dataset.source.file.clone().unwrap_or_default();
    let d = Diagnostic::error(
        "view_is_left",
        format!("{file}: only a dataset {what}; a command file of Adams View stays as it is"),
    );
    let written = PathBuf::from(&file).with_extension("adm");
    let help = format!(
        "cognate convert {file} {} writes the dataset",
        written.display()
    );
    Err(Failure {
        exit: Exit::Usage,
        ..Failure::from(d.help(help))
    })
}

/// Reads `.model.DV_1=2.5`: a design variable of a command file of Adams View, and its value.
pub(super) fn variable(text: &str) -> Result<(String, f64), String> {
    let (name, value) = text.split_once('=').ok_or("it is NAME=NUMBER")?;
    let number: f64 = value
        .trim()
        .parse()
        .map_err(|_| format!("`{value}` is no number"))?;
    match number.is_finite() {
        true => Ok((name.trim().to_owned(), number)),
        false => Err(format!("`{value}` is no finite number")),
    }
}

/// Returns whether a file holds commands: a command file, or the log of a run.
pub(super) fn has_commands(path: &Path) -> bool {
    let is = |e: &std::ffi::OsStr| e.eq_ignore_ascii_case("acf") || e.eq_ignore_ascii_case("msg");
    path.extension().is_some_and(is)
}

/// Reads a command file and the dataset it names, or the commands that a log echoes and the dataset
/// beside it; `dataset`: this one instead. The loads are those of the last choice.
pub(super) fn script(path: &Path, dataset: Option<&Path>) -> Result<Job, Failure> {
    script_with(path, dataset, Asked::Kept).inspect(remark_on_choice)
}

/// Reads a command file and its dataset, with loads.
///
/// # Errors
/// As [`script`].
pub(super) fn script_with(
    path: &Path,
    dataset: Option<&Path>,
    asked: Asked<'_>,
) -> Result<Job, Failure> {
    script_from(path, dataset, asked, false)
}

/// Does the same; `trusting`: names of results may lead out of their folder.
///
/// # Errors
/// As [`script`].
fn script_from(
    path: &Path,
    dataset: Option<&Path>,
    asked: Asked<'_>,
    trusting: bool,
) -> Result<Job, Failure> {
    let failed = |e: Error| Failure::in_files(Exit::Input, e.into());
    if path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("msg"))
    {
        let mut script = Script::from_message_log(path).map_err(failed)?;
        if !trusting {
            script.keep_inside();
        }
        let file = (dataset.map(Path::to_path_buf))
            .or_else(|| script.model_file())
            .unwrap_or_else(|| path.with_extension("adm"));
        let (reading, read_seconds, Prepared { setup, loads }) = timed_read(&file, asked)?;
        return Ok(Job {
            reading,
            base: format!("{}_replay", stem(path)),
            steps: script.steps,
            setup,
            loads,
            remarks: script.diagnostics,
            read_seconds,
        });
    }
    let mut script = Script::read(path).map_err(failed)?;
    if !trusting {
        script.keep_inside();
    }
    let file = dataset.map(Path::to_path_buf);
    let Some(file) = file.or_else(|| script.model_file()) else {
        if let Some(Step {
            command: Command::Reload(Some(name)),
            ..
        }) = script.steps.first()
        {
            // a state file holds its model
            let folder = path.parent().unwrap_or(Path::new(""));
            let file = folder.join(state::file_name(name));
            let bytes = disk::read(&file).map_err(|e| {
                let what = format!("{}: cannot be opened: {e}", disk::text(&file));
                Diagnostic::error("cannot_open", what)
            })?;
            let saved = Saved::read(&bytes).map_err(Error::into_first)?;
            return Ok(Job {
                reading: dataset::read_text(&saved.model().to_text()),
                base: script.output.clone().unwrap_or_else(|| stem(path)),
                steps: script.steps,
                setup: Setup::default(),
                loads: None,
                remarks: script.diagnostics,
                read_seconds: 0.0,
            });
        }
        return Err(names_no_dataset(path).into());
    };
    let base = script.output.clone().unwrap_or_else(|| stem(path));
    if !file.exists() {
        return Err(missing(&script, path, &file));
    }
    let (reading, read_seconds, Prepared { setup, loads }) = timed_read(&file, asked)?;
    Ok(Job {
        reading,
        base,
        steps: script.steps,
        setup,
        loads,
        remarks: script.diagnostics,
        read_seconds,
    })
}
