//! `cognate animate`: a run as a page that moves, as a film, or as an animated `.glb` file.

use super::draw::From;
use super::moved::{Dimensions, Moved, Source, has_ending, is_dataset, pictured};
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, interrupt, piped, recorded, remark, run};
#[cfg(feature = "gif")]
use super::{draw, progress::Progress};
use cognate::diagnostic::Diagnostic;
use cognate::disk;
use cognate::internals::report::mechanism::page::{Shown, page};
use cognate::internals::report::mechanism::{Bodies, Pictured, Track, glb};
use cognate::model::Model;
use cognate::results::Run;
use std::path::{Path, PathBuf};

/// Show a run in motion: one page for any browser, a film (.gif), or an animated .glb file
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate animate examples/slider_crank.acf --open
  cognate animate pendulum.adm --end 2 --steps 200 -o pendulum.html -o pendulum.glb
  cognate animate examples/slider_crank.acf -o crank.gif --width 640
  cognate animate run.res --model pendulum.adm
  cognate animate pendulum.acf --over earlier.res
  cognate animate examples/slider_crank.acf --dimension 41,11 --open
  cognate animate press.acf --interference --open")]
pub struct Args {
    #[command(flatten)]
    source: Source,
    /// File to write: .html, a page that needs nothing else, .gif, a film, or .glb (repeatable)
    /// [default: a page of the name of the run, here]
    #[arg(short = 'o', long = "out", value_name = "FILE", value_parser = piped::output("html"))]
    out: Vec<PathBuf>,
    #[command(flatten)]
    writing: WritingArgs,
    /// A further run of the same mechanism, shown pale over the first: by its name, or a file of
    /// its results (.res, .parquet, .json, .gra) [default: none]
    #[arg(long, value_name = "RUN", value_parser = piped::results())]
    over: Option<PathBuf>,
    #[command(flatten)]
    dimensions: Dimensions,
    /// Width of a film, in px [default: 480]
    #[arg(long, value_name = "PX")]
    width: Option<u32>,
    /// Direction from which a film looks: an axis of ground, or from the side and above [default:
    /// that of the drawing]
    #[arg(long, value_enum)]
    from: Option<From>,
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
    let known = |file: &PathBuf| ENDINGS.iter().any(|ending| has_ending(file, ending));
    if let Some(wrong) = args.out.iter().find(|file| !known(file)) {
        let what = format!(
            "{}: pictures that move are .html, .gif and .glb",
            disk::text(wrong)
        );
        return Err(Failure::usage(what));
    }
    let has_film = args.out.iter().any(|file| has_ending(file, "gif"));
    if (args.width.is_some() || args.from.is_some()) && !has_film {
        let what = "--width and --from are for a film: -o NAME.gif writes one";
        return Err(Failure::usage(what));
    }
    args.writing.check_beside(&args.source.file, &args.out)?;
    let is_solved = run::has_commands(&args.source.file) || is_dataset(&args.source.file);
    let Moved {
        model,
        run,
        folders,
    } = args.source.get()?;
    let over = args.over.as_deref().map(recorded::read).transpose()?;
    let mut out = args.out.clone();
    if out.is_empty() {
        out.push(disk::path(format!("{}.html", run.name)));
    }
    let pictured = args
        .dimensions
        .added_to(&model, pictured(&model, &run, &folders)?)?;
    #[cfg(feature = "geometry")]
    let pictured = match args.interference {
        true => marked(pictured, &model, &run, &folders)?,
        false => pictured,
    };
    if pictured.track.times.len() < 2 {
        remark(still(args));
    }
    for file in &out {
        if has_ending(file, "glb") {
            args.writing.bytes(file, &glb::glb(&pictured))?;
        } else if has_ending(file, "gif") {
            let Some(bytes) = film(args, &pictured, &run)? else {
                return Ok(Exit::Interrupted);
            };
            args.writing.bytes(file, &bytes)?;
        } else {
            (args.writing).text(file, &page_of(&model, &pictured, &run, over.as_ref())?)?;
        }
        remark(disk::text(&file));
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

/// Endings of the names of what moves.
const ENDINGS: [&str; 3] = ["html", "gif", "glb"];
/// Width of a film when nobody says, in px.
#[cfg(feature = "gif")]
const FILM_WIDTH: u32 = 480;

/// Returns why nothing moves, and what helps.
fn still(args: &Args) -> String {
    let file = args.source.file.display();
    let is_dataset = is_dataset(&args.source.file);
    if is_dataset && args.source.span.end.is_none() {
        return format!(
            "nothing moves: a dataset without command file is assembled and stands still; \
             cognate animate {file} --end 2 runs it to time 2"
        );
    }
    format!("nothing moves: {file} gives a single output")
}

/// Returns a run as a film; `None`: the user interrupted.
#[cfg(feature = "gif")]
fn film(args: &Args, pictured: &Pictured, run: &Run) -> Result<Option<Vec<u8>>, Failure> {
    use cognate::internals::report::mechanism::film::Film;
    let view = args.from.and_then(|from| draw::view(from, &pictured.view));
    let width = draw::width(args.width.unwrap_or(FILM_WIDTH));
    let units = [run.units.length.as_str(), run.units.time.as_str()];
    let film = Film::new(pictured, view, width, units);
    let progress = Progress::new(false, 0.0, film.len() as f64);
    let mut goes_on = |done: usize| {
        progress.pictures(done, film.len());
        !interrupt::requested()
    };
    let made = film.gif(&mut goes_on);
    progress.done();
    Ok(made?)
}

#[cfg(not(feature = "gif"))]
fn film(_: &Args, _: &Pictured, _: &Run) -> Result<Option<Vec<u8>>, Failure> {
    let what = "this program was built without the feature gif";
    Err(Diagnostic::error("picture_format", what)
        .help("write an .html")
        .into())
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
    if open::that_detached(file).is_err() {
        let file = disk::text(file);
        remark(format!("no browser was found; open {file} in one"));
    }
}
