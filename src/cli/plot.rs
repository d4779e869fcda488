//! `cognate plot`: columns of results as a picture, in the terminal or as SVG.

use super::convert::same_file;
use super::{Exit, Failure, Outcome, remark, render, say};
use crate::report::terminal::{Style, terminal};
use crate::report::{Plot, svg::svg};
use crate::results;
use std::path::{Path, PathBuf};

/// Plot columns of results in the terminal or as SVG
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate plot run.csv --y 'DX(12,21)'
  cognate plot run.res --y PART_2_XFORM.X --y PART_2_XFORM.Y --svg out.svg
  cognate plot run.csv --x 'DX(12,21)' --y 'VX(12,21)' --svg phase.svg")]
pub struct Args {
    /// Results to read: .csv, .res or .gra
    input: PathBuf,
    /// Column to show (repeatable); the first few when none is given
    #[arg(long, value_name = "COLUMN")]
    y: Vec<String>,
    /// Column to show them over; time when not given
    #[arg(long, value_name = "COLUMN")]
    x: Option<String>,
    /// Title above the picture
    #[arg(long)]
    title: Option<String>,
    /// Write an SVG file instead of drawing in the terminal
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
}

/// Plots columns of results.
///
/// # Errors
/// When the results cannot be read, have no such column, or no finite value.
pub fn run(args: &Args) -> Outcome {
    let run = results::read(&args.input)?;
    let mut plot = Plot::of_run(&run, args.x.as_deref(), &args.y)?;
    if let Some(title) = &args.title {
        plot.title = title.clone();
    }
    match &args.svg {
        Some(file) if same_file(file, &args.input) => Err(Failure::usage(
            "the output is the input, which is never overwritten",
        )),
        Some(file) => write_svg(&plot, file),
        None => draw(&plot),
    }
}

/// Writes the picture to a file.
///
/// # Errors
/// When there is nothing to draw, or the file cannot be written.
pub fn write_svg(plot: &Plot, file: &Path) -> Outcome {
    results::write_text(file, &svg(plot)?)?;
    remark(format!("plot in {}", file.display()));
    Ok(Exit::Done)
}

/// Draws the picture on standard output.
///
/// # Errors
/// When there is nothing to draw.
pub fn draw(plot: &Plot) -> Outcome {
    say(&terminal(plot, terminal_style())?);
    Ok(Exit::Done)
}

/// Returns the style of a picture that fits an ordinary terminal; COLUMNS may make it narrower.
pub fn terminal_style() -> Style {
    let columns = std::env::var("COLUMNS")
        .ok()
        .and_then(|c| c.parse().ok())
        .unwrap_or(80);
    Style {
        columns: usize::clamp(columns, 40, 120),
        lines: 16,
        colour: render::colour_on_stdout(),
    }
}
