//! `cognate draw`: one configuration of a model as a picture.

use super::moved::{Dimensions, Moved, Source, pictured};
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, interrupt, piped, remark};
use cognate::analysis::session::Session;
use cognate::disk;
use cognate::internals::report::mechanism::drawing::{Names, SymbolKind, Wanted, drawing};
use cognate::internals::report::mechanism::{Pictured, View, drawing_svg};
use cognate::internals::report::picture::{self, PictureFormat};
use cognate::model::ElementId;
use cognate::results::{Run, digits_of_six};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Width of a picture when nobody says, in px.
const WIDTH: u32 = 720;

/// Draw a model as it stands: in its plane or in perspective, with symbols of joints and names
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate draw examples/slider_crank.adm -o crank.svg
  cognate draw examples/slider_crank.acf --at 0.3 --names all -o crank.svg
  cognate draw four_bar.acf --at 0.2 --pale 5 --paths -o four_bar.png
  cognate draw crank.adm --symbols markers --names all -o markers.svg
  cognate draw crank.acf --at 0.3 --dimension 41,11 -o stroke.svg       the distance of two markers
  cognate draw loop.adm --highlight JOINT/3 --highlight JOINT/4 -o loop.svg")]
pub struct Args {
    #[command(flatten)]
    source: Source,
    /// Time of the configuration: the nearest output [default: the last]
    #[arg(long, value_name = "TIME")]
    at: Option<f64>,
    /// File to write: .svg, .png or .pdf [default: NAME_drawing.svg, here]
    #[arg(short = 'o', long = "out", value_name = "FILE", value_parser = piped::output("svg"))]
    out: Option<PathBuf>,
    #[command(flatten)]
    writing: WritingArgs,
    /// Symbols that are drawn
    #[arg(long, value_enum, default_value = "joints")]
    symbols: SymbolsArg,
    #[command(flatten)]
    dimensions: Dimensions,
    /// Names that are written: of bodies, or of joints (or the markers that are shown), too
    #[arg(long, value_enum, default_value = "bodies")]
    names: NamesArg,
    /// Element that stands out, by JOINT/3 or its name (repeatable) [default: none]
    #[arg(long, value_name = "ELEMENT")]
    highlight: Vec<String>,
    /// Draw N further configurations of the run, pale
    #[arg(long, value_name = "N", default_value_t = 0)]
    pale: usize,
    /// Draw the paths of the markers that requests ask for
    #[arg(long)]
    paths: bool,
    /// Leave out the arrows of forces
    #[arg(long)]
    no_forces: bool,
    /// Direction to look from: an axis of ground, or from the side and above
    #[arg(long, value_enum, default_value = "best")]
    from: From,
    /// Width of the picture, in px
    #[arg(long, value_name = "PX", default_value_t = WIDTH)]
    width: u32,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum NamesArg {
    None,
    Bodies,
    All,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum SymbolsArg {
    None,
    /// pins, rails and balls of joints
    Joints,
    /// those, and arrows along the directions in which joints turn and slide
    Actions,
    /// x (red), y (green) and z (blue) of markers, in the place of joints
    Markers,
}

impl SymbolsArg {
    fn kind(self) -> SymbolKind {
        match self {
            Self::None => SymbolKind::None,
            Self::Joints => SymbolKind::Joints,
            Self::Actions => SymbolKind::Actions,
            Self::Markers => SymbolKind::Markers,
        }
    }
}

/// A direction to look from.
#[derive(Clone, Copy, clap::ValueEnum)]
pub enum From {
    /// square to the plane of the mechanism; in perspective where it has none
    Best,
    X,
    Y,
    Z,
    /// in perspective
    Side,
}

/// Draws a configuration.
///
/// # Errors
/// When the model cannot be assembled or solved, an element does not exist, or the file cannot be
/// written.
pub fn run(args: &Args) -> Outcome {
    interrupt::install();
    (args.writing).check_beside(&args.source.file, &args.out)?;
    let Moved {
        model,
        run,
        folders,
    } = args.source.get()?;
    let highlighted = args.highlight.iter().map(|element| {
        let found = model.find_element(element);
        found.map_err(|d| Failure::at_argument("--highlight", element, d))
    });
    let highlighted = highlighted.collect::<Result<BTreeSet<ElementId>, Failure>>()?;
    let pictured = args
        .dimensions
        .added_to(&model, pictured(&model, &run, &folders)?)?;
    let out = args.out.clone();
    // NAME.svg is the picture of the requests of a run
    let out = out.unwrap_or_else(|| disk::path(format!("{}_drawing.svg", run.name)));
    let times = &pictured.track.times;
    let last = times.len() - 1;
    let row = match args.at {
        Some(at) => row_at(times, at)?,
        None => last,
    };
    let wanted = Wanted {
        pale: (0..args.pale).map(|k| k * last / args.pale).collect(),
        names: match args.names {
            NamesArg::None => Names::None,
            NamesArg::Bodies => Names::Bodies,
            NamesArg::All => Names::All,
        },
        symbols: args.symbols.kind(),
        highlighted,
        paths: args.paths,
        forces: !args.no_forces,
        view: view(args.from, &pictured.view),
        ..Wanted::at_row(row, &run.units.length)
    };
    write(&pictured, &wanted, args.width, &run, (&out, args.writing))?;
    Ok(Exit::Done)
}

/// Draws the configuration of a run that is nearest to a time.
///
/// # Errors
/// When the run has no positions, or the file cannot be written.
pub fn draw_at(session: &Session, at: f64, file: &Path) -> Result<(), Failure> {
    let run = &session.run;
    let pictured = pictured(&session.model, run, &session.folders)?;
    let wanted = Wanted::at_row(nearest(&pictured.track.times, at), &run.units.length);
    write(
        &pictured,
        &wanted,
        WIDTH,
        run,
        (file, WritingArgs::default()),
    )
}

/// Draws a configuration in which some elements stand out.
///
/// # Errors
/// When the run has no positions, or the file cannot be written.
pub fn draw_standing_out(
    moved: &Moved,
    highlighted: BTreeSet<ElementId>,
    (file, writing): (&Path, WritingArgs),
) -> Result<(), Failure> {
    let Moved {
        model,
        run,
        folders,
    } = moved;
    let pictured = pictured(model, run, folders)?;
    let wanted = Wanted {
        names: Names::All,
        highlighted,
        forces: false,
        ..Wanted::at_row(pictured.track.times.len() - 1, &run.units.length)
    };
    write(&pictured, &wanted, WIDTH, run, (file, writing))
}

/// Writes a drawing.
fn write(
    pictured: &Pictured,
    wanted: &Wanted,
    width: u32,
    run: &Run,
    (file, writing): (&Path, WritingArgs),
) -> Result<(), Failure> {
    if PictureFormat::of(file).is_none() {
        let what = format!("{}: drawings are .svg, .png and .pdf", disk::text(&file));
        return Err(Failure::usage(what));
    }
    let text = drawing_svg::svg(
        &drawing(pictured, wanted),
        self::width(width),
        &run.units.length,
    );
    writing.bytes(file, &picture::bytes(&text, file)?)?;
    remark(disk::text(&file));
    Ok(())
}

/// Returns the row whose time is nearest, of several the last.
///
/// # Errors
/// The time lies before the first or after the last.
fn row_at(times: &[f64], at: f64) -> Result<usize, Failure> {
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else {
        return Ok(0);
    };
    let near = 1e-9 * (last - first).abs().max(last.abs());
    if at >= first - near && at <= last + near {
        return Ok(nearest(times, at));
    }
    let [at, first, last] = [at, first, last].map(digits_of_six);
    Err(Failure::usage(format!(
        "--at {at}: the run goes from {first} to {last}; --end TIME gives a dataset alone a later end"
    )))
}

/// Returns the row whose time is nearest; of several the last.
fn nearest(times: &[f64], at: f64) -> usize {
    let off = |row: usize| (times[row] - at).abs();
    (0..times.len()).fold(
        0,
        |best, row| if off(row) <= off(best) { row } else { best },
    )
}

/// Returns a width that pictures may have, in px.
pub fn width(px: u32) -> f64 {
    f64::from(px.clamp(200, 8000))
}

/// Returns the view from a direction; `None`: that of the mechanism.
pub fn view(from: From, own: &View) -> Option<View> {
    match from {
        From::Best => None,
        From::X => Some(own.along(0)),
        From::Y => Some(own.along(1)),
        From::Z => Some(own.along(2)),
        From::Side => Some(own.slanted()),
    }
}
