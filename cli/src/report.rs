//! `cognate report`: a model at many requests by all methods, as error against time.

use super::arguments::{SpanArgs, UnsolvedArgs, methods};
use super::inputs::InputArgs;
use super::progress::Progress;
use super::run::{self, Single};
use super::writing::{WritingArgs, remark_on_kept};
use super::{Exit, Failure, Outcome, interrupt, limit, piped, remark, say};
use cognate::analysis::session::Options;
use cognate::analysis::watch::Watch;
use cognate::analysis::work_limit::ProcessorClock;
use cognate::disk;
use cognate::internals::results::output_folder::OutputFolder;
use cognate::internals::work_precision::{Follow, Question, Study, page, survey};
use cognate::model::{Model, RequestKind};
use cognate::results::json;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Error against time for a model: many requests, all methods, and which one to take
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate report crank.acf
  cognate report crank.acf --want 1e-4 --budget 2min
  cognate report crank.adm --end 2 --method RADAU5 --method DOP853 --out results")]
pub struct Args {
    /// Command file (.acf), log of an earlier run (.msg), or dataset (.adm); - reads a dataset from
    /// standard input
    #[arg(value_parser = piped::model())]
    model: PathBuf,
    /// Dataset that the commands are for, where it is not the one that they name
    dataset: Option<PathBuf>,
    /// Error for which a method and a request are recommended (repeatable) [default: 1e-2, 1e-4,
    /// 1e-6, 1e-8]
    #[arg(long, value_name = "E")]
    want: Vec<f64>,
    /// Processor time for all runs together: those that would not fit are left out
    #[arg(long, value_name = "TIME", value_parser = limit::seconds, default_value = "1min")]
    budget: f64,
    /// A method to try (repeatable) [default: all that fit]
    #[arg(long = "method", value_name = "NAME", value_parser = methods(), ignore_case = true)]
    methods: Vec<String>,
    /// A requested error (repeatable) [default: 1e-2 to 1e-12]
    #[arg(long = "error", value_name = "E")]
    requests: Vec<f64>,
    /// A further channel to compare: any expression (repeatable) [default: none]
    #[arg(long = "column", value_name = "EXPR")]
    columns: Vec<String>,
    #[command(flatten)]
    inputs: InputArgs,
    #[command(flatten)]
    span: SpanArgs,
    /// Folder that the report is written to [default: here]
    #[arg(short = 'o', long, value_name = "DIR", value_parser = piped::refused(piped::SEVERAL))]
    out: Option<PathBuf>,
    #[command(flatten)]
    writing: WritingArgs,
    #[command(flatten)]
    unsolved: UnsolvedArgs,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
}

/// Errors for which a run is recommended when nobody says.
const WANTED: [f64; 4] = [1e-2, 1e-4, 1e-6, 1e-8];
/// Parts whose places are compared where a model asks for no channel, at most.
const MOST_PARTS: usize = 100;

/// Shows progress, and listens for Ctrl-C, after which the study ends with what it has.
struct Terminal {
    progress: Progress,
    /// the run that goes on
    run: String,
    /// its clock, and the processor time of the runs before, in s
    clock: (ProcessorClock, f64),
}

impl Watch for Terminal {
    fn interrupted(&mut self) -> bool {
        let (clock, before) = &self.clock;
        self.progress.work(|| before + clock.seconds(), &self.run);
        interrupt::requested()
    }
}

impl Follow for Terminal {
    fn begins(&mut self, (method, request): (&str, f64), spent: f64) {
        self.run = format!("{method} at {request:.0e}");
        self.clock = (ProcessorClock::start(), spent);
    }
}

/// Runs a model at many requests by all methods that fit, and writes what came out.
///
/// # Errors
/// When a file has mistakes or cannot be written, or the model cannot work.
pub fn run(args: &Args) -> Outcome {
    interrupt::install();
    let clock = Instant::now();
    let mut job = if run::has_commands(&args.model) {
        args.span.refuse_beside(&args.model)?;
        run::script(&args.model, args.dataset.as_deref())?
    } else {
        run::alone(&Single {
            variables: &[],
            model: &args.model,
            dataset: args.dataset.as_deref(),
            span: args.span,
        })?
    };
    args.inputs.drive_told(&mut job.reading.model, false)?;
    let read = clock.elapsed().as_secs_f64();
    let (model, dataset) = (job.reading.model, job.reading.dataset);
    let name = format!("{}_report", job.base);
    let dir = args.out.clone().unwrap_or_else(|| PathBuf::from("."));
    let folder = OutputFolder::open(&dir, &name)?.with_leave(args.writing.leave(), false);
    let names = ["csv", "html"].map(|ending| format!("{name}.{ending}"));
    folder.check(&names)?;
    let parent = args.model.parent().map(Path::to_path_buf);
    let wanted = match args.want.is_empty() {
        true => WANTED.to_vec(),
        false => args.want.clone(),
    };
    let question = Question {
        name: job.base,
        options: args.unsolved.given_to(Options {
            columns: columns(args, &model),
            named_only: true,
            ..Options::default()
        }),
        model: &model,
        steps: &job.steps,
        folders: args.out.clone().into_iter().chain(parent).collect(),
        requests: requests(args)?,
        wanted: wanted.clone(),
        methods: args.methods.iter().map(|m| m.to_uppercase()).collect(),
        budget: args.budget,
        trusted: None,
    };
    let mut terminal = Terminal {
        progress: Progress::new(false, 0.0, args.budget),
        run: String::new(),
        clock: (ProcessorClock::start(), 0.0),
    };
    let study = survey(&question, &mut terminal);
    terminal.progress.done();
    let study = study.map_err(|e| Failure::in_model(&dataset, e))?;
    let files = write(folder, &name, &study, &wanted, read)?;
    if args.json {
        say(&json::text(&study.json(&wanted)));
    } else {
        say(&study.text(&wanted));
        for file in files {
            remark(disk::text(&file));
        }
    }
    Ok(if study.interrupted {
        Exit::Interrupted
    } else if study.rows.iter().all(|row| row.error().is_none()) {
        Exit::Stopped
    } else {
        Exit::Done
    })
}

/// Returns the requested errors, the largest first.
fn requests(args: &Args) -> Result<Vec<f64>, Failure> {
    let mut requests = args.requests.clone();
    if requests.is_empty() {
        requests = (2..=12).map(|k| 10f64.powi(-k)).collect();
    }
    if let Some(wrong) = requests.iter().find(|r| !(**r > 0.0 && r.is_finite())) {
        return Err(Failure::usage(format!(
            "--error must be positive, not {wrong}"
        )));
    }
    requests.sort_by(|a, b| b.total_cmp(a));
    requests.dedup();
    Ok(requests)
}

/// Returns the channels to compare: those of the command line beside those of the model, or the
/// places of all parts where there are none.
fn columns(args: &Args, model: &Model) -> Vec<String> {
    let asks = |kind: &RequestKind| matches!(kind, RequestKind::Functions(_));
    if !args.columns.is_empty() || model.requests.values().any(|r| asks(&r.kind)) {
        return args.columns.clone();
    }
    let centres = model.parts.values().filter(|part| !part.ground);
    let centres = centres.filter_map(|part| part.cm).take(MOST_PARTS);
    let places = centres.flat_map(|cm| ["DX", "DY", "DZ"].map(|f| format!("{f}({cm})")));
    let states = model.differentials.keys().map(|id| format!("DIF({id})"));
    places.chain(states).collect()
}

/// Writes the report; returns its files. The JSON comes last: it lists the others.
fn write(
    mut folder: OutputFolder,
    name: &str,
    study: &Study,
    wanted: &[f64],
    read: f64,
) -> Result<Vec<PathBuf>, Failure> {
    let table = format!("{name}.csv");
    let mut files = vec![(table.clone(), folder.prepare(&table, &study.csv())?)];
    let title = format!("Error against time: {}", study.name);
    let about = format!(
        "<p>Each run at a requested error, by each method that fits: its error against the best run, and what it costs. \
         Reading took {:.2} ms, once.</p>",
        1e3 * read
    );
    let html = page(&title, &about, std::slice::from_ref(study), wanted);
    let picture = format!("{name}.html");
    let prepared = folder.prepare(&picture, &html)?;
    files.push((picture, prepared));
    folder.put(&files)?;
    let mut record = study.json(wanted);
    record["read_seconds"] = read.into();
    let record = json::with_files(record, &folder);
    folder.put_record(&json::text(&record))?;
    for (was, is) in folder.kept() {
        remark_on_kept(was, is);
    }
    Ok(folder.files().to_vec())
}
