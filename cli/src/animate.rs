//! `cognate animate`: a run as a page that moves, or as an animated `.glb` file.

use super::moved::{Dimensions, Moved, Source, has_ending, pictured};
use super::{Exit, Failure, Outcome, interrupt, recorded, remark, run};
use cognate::diagnostic::Diagnostic;
use cognate::model::Model;
use cognate::report::mechanism::page::{Shown, page};
use cognate::report::mechanism::{Bodies, Pictured, Track, glb};
use cognate::results::{self, Run};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Show a run in motion: one page for any browser, or an animated .glb file
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate animate examples/slider_crank.acf --open
  cognate animate pendulum.adm --end 2 --steps 200 -o pendulum.html -o pendulum.glb
  cognate animate run.res --model pendulum.adm
  cognate animate pendulum.acf --over earlier.res
  cognate animate examples/slider_crank.acf --dimension 41,11 --open
  cognate animate press.acf --interference --open")]
pub struct Args {
    #[command(flatten)]
    source: Source,
    /// File to write: .html, a page that needs nothing else, or .glb (repeatable); without it a
    /// page of the name of the run, here
    #[arg(short = 'o', long = "out", value_name = "FILE")]
    out: Vec<PathBuf>,
    /// A further run of the same mechanism, shown pale over the first: by its name, or a file of
    /// its results (.res, .parquet, .json, .gra)
    #[arg(long, value_name = "RUN")]
    over: Option<PathBuf>,
    #[command(flatten)]
    dimensions: Dimensions,
    /// Mark on the page where solids overlap
    #[cfg(feature = "geometry")]
    #[arg(long)]
    interference: bool,
    /// Open the page in the browser
    #[arg(long)]
    open: bool,
}

/// Writes the pictures of a run.
///
/// # Errors
/// When the model cannot be solved, the run does not say where its parts are, or a file cannot be
/// written.
pub fn run(args: &Args) -> Outcome {
    interrupt::install();
    let known = |file: &PathBuf| has_ending(file, "glb") || has_ending(file, "html");
    if let Some(wrong) = args.out.iter().find(|file| !known(file)) {
        let what = format!("{}: pictures that move are .html and .glb", wrong.display());
        return Err(Failure::usage(what));
    }
    let is_solved = run::has_commands(&args.source.file) || has_ending(&args.source.file, "adm");
    let Moved {
        model,
        run,
        folders,
    } = args.source.get()?;
    let over = args
        .over
        .as_deref()
        .map(recorded::results_file)
        .transpose()?;
    let over = over.as_deref().map(results::read).transpose()?;
    let mut out = args.out.clone();
    if out.is_empty() {
        out.push(PathBuf::from(format!("{}.html", run.name)));
    }
    let pictured = args
        .dimensions
        .added_to(&model, pictured(&model, &run, &folders)?)?;
    #[cfg(feature = "geometry")]
    let pictured = match args.interference {
        true => marked(pictured, &model, &run, &folders)?,
        false => pictured,
    };
    for file in &out {
        if has_ending(file, "glb") {
            results::write_bytes(file, &glb::glb(&pictured))?;
        } else {
            results::write_text(file, &page_of(&model, &pictured, &run, over.as_ref())?)?;
        }
        remark(file.display());
    }
    if args.open {
        let pages = out.iter().filter(|file| has_ending(file, "html"));
        pages.for_each(|file| open(file));
    }
    Ok(if is_solved {
        run::exit(run.record.status)
    } else {
        Exit::Done
    })
}

/// Marks where solids overlap; says so where none do.
#[cfg(feature = "geometry")]
fn marked(
    pictured: Pictured,
    model: &Model,
    run: &Run,
    folders: &[PathBuf],
) -> Result<Pictured, Failure> {
    let overlaps = super::interference::overlaps(model, run, folders)?;
    if overlaps.is_empty() {
        remark("no solids overlap");
    }
    Ok(Pictured {
        overlaps,
        ..pictured
    })
}

/// Returns the page of a run, with another one over it.
fn page_of(
    model: &Model,
    pictured: &Pictured,
    run: &Run,
    over: Option<&Run>,
) -> Result<String, Diagnostic> {
    let shown = |run, track| Shown { run, track };
    let track = over.map(|run| Track::new(model, &Bodies::new(model), run));
    let track = track.transpose()?;
    let second = over
        .zip(track.as_ref())
        .map(|(run, track)| shown(run, track));
    let runs: Vec<Shown<'_>> = [shown(run, &pictured.track)]
        .into_iter()
        .chain(second)
        .collect();
    Ok(page(model, pictured, &runs))
}

/// Returns the page of a run that has just been solved.
///
/// # Errors
/// When the run does not say where its parts are.
pub fn page_of_run(model: &Model, run: &Run, folders: &[PathBuf]) -> Result<String, Diagnostic> {
    page_of(model, &pictured(model, run, folders)?, run, None)
}

/// Opens a page in the browser, without waiting for it; says where the page is when there is none.
pub fn open(file: &Path) {
    let openers: &[&[&str]] = if cfg!(target_os = "macos") {
        &[&["open"]]
    } else if cfg!(windows) {
        &[&["cmd", "/C", "start", ""]]
    } else {
        &[&["xdg-open"], &["sensible-browser"]]
    };
    let opened = openers.iter().any(|words| {
        let mut command = Command::new(words[0]);
        command.args(&words[1..]).arg(file);
        let quiet = command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        quiet.spawn().is_ok()
    });
    if !opened {
        remark(format!(
            "no browser was found; open {} in one",
            file.display()
        ));
    }
}
