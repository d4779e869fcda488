//! `cognate sweep`: one model many times, and a table of what came of it.

use super::arguments::{IntegrationArgs, LimitArgs, SpanArgs, UnsolvedArgs, threads};
use super::inputs::{InputArgs, refuse_driven};
use super::mistake::Mistake;
use super::progress::Progress;
use super::recorded;
use super::render::Sources;
use super::routines::RoutineArgs;
use super::run::{self, Job, Single};
use super::table::Table as Text;
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, interrupt, piped, remark, say, width};
use cognate::analysis::session::Options;
use cognate::analysis::sweep::design::{self, Values};
use cognate::analysis::sweep::{Follow, Parameter, Row, Sweep, Table};
use cognate::diagnostic::{Diagnostic, Error, counted};
use cognate::disk;
use cognate::model::Model;
use cognate::results::format::Style;
use cognate::results::{self, Status, digits_of_six};
use std::path::{Path, PathBuf};

/// Run a model many times with other numbers, and measure each run: one table, a row a run
///
/// Rows are in the table as soon as they are done. The same command again goes on with a table
/// that is not complete. A row depends on its numbers alone, not on the number of threads.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate sweep crank.acf --set 'PART/2.MASS=1,2,5' --measure 'max(abs(slider.ACCX))'
  cognate sweep crank.adm --end 2 --steps 400 --set 'VARIABLE/3=0.1:0.5:9' --set 'SPRINGDAMPER/1.K=50:200:4' \\
      --measure 'rms(FX(41,11))' --measure 'time_of_max(DX(41,22))'
  cognate sweep crank.acf --set 'PART/2.MASS=1:5' --set 'MARKER/22.QP(1)=40:60' --design latin --runs 200 \\
      --measure 'last(slider.X)' --out crank.parquet
  cognate sweep crank.acf --design points.csv --measure 'max(slider.X)'        a column a parameter
  cognate plot crank_sweep.csv --x PART/2.MASS --y 'max(slider.X)'

A parameter is an argument of a statement (PART/2.MASS), a number of a list (MARKER/22.QP(1)), or a FUNCTION that
becomes a number (VARIABLE/3). Measures are max, min, mean, rms, first, last, time_of_max and time_of_min of an
expression or of a column of the results, at the outputs.")]
pub struct Args {
    /// Command file (.acf), which every run obeys, or dataset (.adm); - reads a dataset from
    /// standard input
    #[arg(value_parser = piped::model())]
    model: PathBuf,
    /// Parameter and its values: A:B:N is N values from A to B, or a list with commas (repeatable)
    /// [default: none, unless a table is the design]
    #[arg(long, value_name = "NAME=VALUES")]
    set: Vec<String>,
    /// Number of each run, as max(DX(12,21)) (repeatable) [default: none, at least one is needed]
    #[arg(long, value_name = "MEASURE")]
    measure: Vec<String>,
    /// grid: all combinations; latin: a latin hypercube of --runs points; or a table (.csv) with a
    /// column a parameter
    #[arg(long, value_name = "DESIGN", default_value = "grid")]
    design: String,
    /// Runs of a latin hypercube [default: none, it needs them]
    #[arg(long, value_name = "N")]
    runs: Option<usize>,
    /// Seed of a latin hypercube: the same seed gives the same points
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Threads [default: as many as there are processors]
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Table to write or to go on with: .csv, or .parquet beside its .csv [default:
    /// MODEL_sweep.csv]
    #[arg(long, short, value_name = "FILE", value_parser = piped::refused(piped::GROWS))]
    out: Option<PathBuf>,
    #[command(flatten)]
    writing: WritingArgs,
    #[command(flatten)]
    inputs: InputArgs,
    #[command(flatten)]
    span: SpanArgs,
    #[command(flatten)]
    integration: IntegrationArgs,
    #[command(flatten)]
    unsolved: UnsolvedArgs,
    #[command(flatten)]
    routines: RoutineArgs,
    #[command(flatten)]
    limits: LimitArgs,
    /// Say nothing but mistakes
    #[arg(long)]
    quiet: bool,
}

/// Lets Ctrl-C end a sweep, and the mistake of a routine.
struct Terminal<'a>(&'a Mistake);

impl Follow for Terminal<'_> {
    fn interrupted(&self) -> bool {
        interrupt::requested() || self.0.is_there()
    }
}

/// Runs a sweep.
///
/// # Errors
/// Mistakes in the model, its commands, parameters, values and measures, before anything runs; a
/// table that is that of another sweep or cannot be written.
pub fn run(args: &Args) -> Outcome {
    interrupt::install_for_run();
    let (out, format) = table_path(args)?;
    let (mut sweep, Job { base, reading, .. }, before) = open(args)?;
    let zero_user = args.unsolved.zero_user;
    let mistake = (args.routines).compute_in(&mut sweep, &reading, zero_user)?;
    let points = prepare(args, &mut sweep)?;
    let changed = sweep.parameters().iter().filter_map(Parameter::changed);
    refuse_driven((&before, &reading.model), changed, "a parameter changes")?;
    let out = out.unwrap_or_else(|| disk::path(format!("{base}_sweep.csv")));
    if let Some(file) = &format {
        args.writing.check([file])?;
    }
    let mut table = Table::open_with(&out, &sweep, &points, args.writing.leave())?;
    let missing = table.missing();
    if !args.quiet && table.n_found() > 0 {
        let (found, all, out) = (table.n_found(), points.len(), disk::text(&out));
        remark(format!(
            "{out} has {found} of {} already",
            counted(all, "run")
        ));
    }
    interrupt::results_begin();

    // solve
    let threads = threads(args.threads);
    let progress = Progress::new(args.quiet, 0.0, points.len() as f64);
    let mut done = table.n_found();
    let outcome = sweep.run(&points, &missing, threads, &Terminal(&mistake), |row| {
        done += 1;
        progress.runs(done, points.len());
        table.push(row)
    });
    progress.done();
    (mistake.before(outcome)).map_err(|e| Failure::in_model(&reading.dataset, e))?;
    if interrupt::requested() && done < points.len() {
        let (all, out) = (points.len(), disk::text(&out));
        remark(format!(
            "interrupted: {out} has {done} of {}; the same command goes on",
            counted(all, "run")
        ));
        return Ok(Exit::Interrupted);
    }

    // write and report
    table.complete()?;
    if let Some(file) = &format {
        (args.writing).run(&table.numbers(), file, Style::default())?;
    }
    if !args.quiet {
        say(&overview(&sweep, table.rows()));
        let files = [&out].into_iter().chain(&format);
        let files: Vec<String> = files.map(|file| disk::text(&file)).collect();
        remark(format!(
            "{} in {}",
            counted(points.len(), "run"),
            files.join(", ")
        ));
    }
    Ok(told(args, table.rows()))
}

/// Returns the growing table that the command line names, and the file of another format.
fn table_path(args: &Args) -> Result<(Option<PathBuf>, Option<PathBuf>), Failure> {
    let Some(out) = &args.out else {
        return Ok((None, None));
    };
    let is = |ending| super::moved::has_ending(out, ending);
    if is("csv") {
        return Ok((Some(out.clone()), None));
    }
    if is("parquet") && results::format::Format::row("parquet").is_some() {
        return Ok((Some(out.with_extension("csv")), Some(out.clone())));
    }
    Err(Failure::usage(format!(
        "--out {}: the table of a sweep is .csv or .parquet",
        disk::text(&out)
    )))
}

/// Reads the model and its commands; returns the job of which the sweep has the commands as well,
/// and the model before a table has driven it.
fn open(args: &Args) -> Result<(Sweep, Job, Model), Failure> {
    let mut job = if run::has_commands(&args.model) {
        args.span.refuse_beside(&args.model)?;
        run::script(&args.model, None)?
    } else {
        run::alone(&Single {
            variables: &[],
            model: &args.model,
            dataset: None,
            span: args.span,
        })?
    };
    let before = job.reading.model.clone();
    args.inputs.drive_told(&mut job.reading.model, args.quiet)?;
    let model = job.reading.model.clone();
    if let Err(error) = model.checked() {
        return Err(Failure::in_model(&job.reading.dataset, error));
    }
    let mut sweep = Sweep::new(model, std::mem::take(&mut job.steps));
    if job.loads.is_none() && !args.inputs.is_given() {
        sweep = sweep.with_design_variables(&job.reading);
    }
    let options = args.integration.given_to(Options::default());
    sweep.options = args.limits.given_to(args.unsolved.given_to(options));
    let folder = args.model.parent().map(Path::to_path_buf);
    sweep.folders.extend(folder);
    Ok((sweep, job, before))
}

/// Gives a sweep its parameters and measures, and returns its points.
///
/// # Errors
/// All mistakes in them at once.
fn prepare(args: &Args, sweep: &mut Sweep) -> Result<Vec<Vec<f64>>, Failure> {
    let mut failure = Failure {
        exit: Exit::Input,
        diagnostics: Vec::new(),
        sources: Sources::default(),
    };
    let mut note = |place: String, text: &str, error: Error| {
        for mut d in error.into_diagnostics() {
            d.file.get_or_insert_with(|| place.clone());
            failure.diagnostics.push(d);
        }
        failure.sources.add(place, text);
    };
    let points = design(args, sweep, &mut note);
    for (k, text) in args.measure.iter().enumerate() {
        if let Err(error) = sweep.measure(text) {
            note(numbered("--measure", k, args.measure.len()), text, error);
        }
    }
    if args.measure.is_empty() {
        let d = Diagnostic::error("bad_sweep", "a sweep needs a measure");
        note(
            "--measure".into(),
            "",
            d.help("--measure 'max(DX(12,21))'").into(),
        );
    }
    match (points, failure.diagnostics.is_empty()) {
        (Some(points), true) => Ok(points),
        _ => Err(failure),
    }
}

/// Returns the name of an option, with its number where there are several.
fn numbered(option: &str, k: usize, n: usize) -> String {
    match n {
        1 => option.to_owned(),
        _ => format!("{option} {}", k + 1),
    }
}

/// Adds the parameters to a sweep; returns the points of its design.
fn design(
    args: &Args,
    sweep: &mut Sweep,
    note: &mut impl FnMut(String, &str, Error),
) -> Option<Vec<Vec<f64>>> {
    let is_latin = args.design.eq_ignore_ascii_case("latin");
    let is_grid = args.design.eq_ignore_ascii_case("grid");
    let refuse = |what: &str| Error::from(Diagnostic::error("bad_sweep", what));
    if args.runs.is_some() != is_latin {
        let what = "--runs N goes with --design latin, and is needed there";
        note("--runs".into(), "", refuse(what));
        return None;
    }
    if !is_latin && !is_grid {
        if !args.set.is_empty() {
            let what = "a table names the parameters by its columns: --set does not go with it";
            note("--design".into(), &args.design, refuse(what));
            return None;
        }
        return listed(&args.design, sweep, note);
    }
    let mut values = Vec::new();
    for (k, text) in args.set.iter().enumerate() {
        match set(text, is_grid, sweep) {
            Ok(of) => values.push(of),
            Err(error) => note(numbered("--set", k, args.set.len()), text, error),
        }
    }
    if args.set.is_empty() {
        let what = "a sweep needs a parameter: --set 'PART/2.MASS=1,2,5'";
        note("--set".into(), "", refuse(what));
    }
    if values.is_empty() || values.len() < args.set.len() {
        return None;
    }
    let points = match args.runs {
        Some(runs) => design::latin(&values, runs, args.seed),
        None => {
            let all = values
                .iter()
                .map(Values::all)
                .collect::<Result<Vec<_>, _>>();
            all.and_then(|all| design::grid(&all))
        }
    };
    points
        .map_err(|e| note("--design".into(), &args.design, e))
        .ok()
}

/// Adds the parameter of `NAME=VALUES` to a sweep; returns its values.
fn set(text: &str, is_grid: bool, sweep: &mut Sweep) -> Result<Values, Error> {
    let Some((name, values)) = text.split_once('=') else {
        let d = Diagnostic::error("bad_sweep", format!("`{text}` is not NAME=VALUES"));
        return Err(d.help("--set 'PART/2.MASS=1,2,5'").into());
    };
    sweep.parameter(name)?;
    let values: Values = values.parse()?;
    if is_grid {
        values.all()?;
    }
    Ok(values)
}

/// Reads the points of a table, whose columns are parameters.
fn listed(
    file: &str,
    sweep: &mut Sweep,
    note: &mut impl FnMut(String, &str, Error),
) -> Option<Vec<Vec<f64>>> {
    let path = Path::new(file);
    if !super::moved::has_ending(path, "csv") {
        let what = format!("the design `{file}` is neither grid nor latin nor a table (.csv)");
        let d = Diagnostic::error("bad_sweep", what);
        note("--design".into(), file, d.into());
        return None;
    }
    let run = match recorded::read(path) {
        Ok(run) => run,
        Err(d) => {
            note("--design".into(), file, d.into());
            return None;
        }
    };
    let mut is_sound = true;
    for column in &run.columns {
        if let Err(error) = sweep.parameter(&column.name) {
            note("--design".into(), file, error);
            is_sound = false;
        }
    }
    let point = |k| {
        run.columns
            .iter()
            .map(|c| c.values[k])
            .collect::<Vec<f64>>()
    };
    let points: Vec<Vec<f64>> = (0..run.rows()).map(point).collect();
    let is_finite = |point: &Vec<f64>| point.iter().all(|x| x.is_finite());
    if points.is_empty() || !points.iter().all(is_finite) {
        let what = format!("{file} has no rows, or numbers that are not finite");
        note(
            "--design".into(),
            file,
            Diagnostic::error("bad_sweep", what).into(),
        );
        return None;
    }
    is_sound.then_some(points)
}

/// Prints the range of each measure, and where it ends.
fn overview(sweep: &Sweep, rows: &[Row]) -> String {
    let mut text = Text::new(["measure", "unit", "least", "at run", "largest", "at run"]);
    for (k, measure) in sweep.measures().iter().enumerate() {
        let found = rows.iter().filter(|row| row.measures[k].is_finite());
        let of = |a: &&Row, b: &&Row| a.measures[k].total_cmp(&b.measures[k]);
        let ends = [found.clone().min_by(of), found.min_by(|a, b| of(b, a))];
        let cells = ends.into_iter().flat_map(|row| match row {
            Some(row) => [digits_of_six(row.measures[k]), row.run.to_string()],
            None => [String::new(), String::new()],
        });
        let head = [measure.name(), measure.unit()].map(String::from);
        text.push(head.into_iter().chain(cells));
    }
    text.text(width::columns())
}

/// Remarks on runs that failed or have warnings; returns the exit code, that of a failure where
/// every run failed.
fn told(args: &Args, rows: &[Row]) -> Exit {
    let failed = rows.iter().filter(|row| row.status != Status::Completed);
    let (n_failed, n) = (failed.clone().count(), rows.len());
    if let Some(first) = failed.clone().next() {
        let (run, reason) = (first.run, &first.reason);
        remark(format!(
            "{n_failed} of {} failed; run {run}: {reason}",
            counted(n, "run")
        ));
    }
    let warned = rows.iter().filter(|row| row.warnings > 0);
    if let (false, Some(first)) = (args.quiet, warned.clone().next()) {
        let (n_warned, run) = (warned.count(), first.run);
        remark(format!(
            "{n_warned} of {} have warnings; to see those of run {run}, put its numbers into the model and use cognate run",
            counted(n, "run")
        ));
    }
    match failed.into_iter().next() {
        Some(first) if n_failed == n => run::exit(first.status),
        _ => Exit::Done,
    }
}
