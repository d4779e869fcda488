//! `cognate plot`: columns of results as a picture, in the terminal or as a file.

use super::grouped;
use super::moved::{has_ending, is_dataset};
use super::recorded;
use super::recorded::add_measures;
use super::response::responses;
use super::setup::{self, Setup};
use super::table::Table;
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, piped, remark, render, run, say, width};
use cognate::diagnostic::Diagnostic;
use cognate::disk;
use cognate::internals::report::channels::{Channels, Shown, Source, channels};
use cognate::internals::report::terminal::{Style, terminal};
use cognate::internals::report::transform::{Statistics, statistics};
use cognate::internals::report::{Curve, Plot, picture, svg};
use cognate::results::{self, Run};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Plot columns of results in the terminal or as a file
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate plot run.csv --list
  cognate plot run.csv --y 'DX(12,21)'
  cognate plot run.csv --y slider.X --y slider.VX --out out.png       two units: an axis at either side
  cognate plot a/run.csv --over b/run.res --y slider.X                 two runs
  cognate plot run.csv --x slider.X --y slider.VX --out phase.svg      a phase plot
  cognate plot run.csv --y slider.VX --as spectrum
  cognate plot crank_sweep.csv --x PART/2.MASS                         a sweep: a curve for each choice of the others
  cognate plot run.csv --group Drives                                 a group of functions (cognate group)
  cognate plot crane.adm --y swing --end 4                            a function of the model, without a run
  cognate plot run.csv --statistics")]
pub struct Args {
    /// Results to read: .csv, .parquet, .json, .res, .req, .gra or .msg; or a model (.adm, .acf),
    /// whose functions are shown; - reads .csv from standard input, gra:- and so on others
    #[arg(value_parser = piped::results())]
    input: PathBuf,
    /// Column to show (repeatable), all of a pattern, as 'slider.*', a displacement, velocity or
    /// acceleration of markers, as 'VX(slider.cm,10)', or a function of the model [default: the
    /// first few]
    #[arg(long, value_name = "COLUMN")]
    y: Vec<String>,
    /// Group whose functions are shown (repeatable): of the model, the run by its name, or a set of
    /// results [default: none]
    #[arg(long = "group", value_name = "GROUP")]
    groups: Vec<String>,
    /// Last time for functions of a model [default: that of MODEL.toml, needed without it]
    #[arg(long, value_name = "TIME")]
    end: Option<f64>,
    /// Column to show them over [default: time, of a sweep its first parameter]
    #[arg(long, value_name = "COLUMN")]
    x: Option<String>,
    /// Results of another run, by its name or a file, shown over the first (repeatable) [default:
    /// none]
    #[arg(long, value_name = "FILE", value_parser = piped::results())]
    over: Vec<PathBuf>,
    /// Show the values, or what is made of them
    #[arg(long = "as", value_enum, default_value = "values", value_name = "WHAT")]
    shown: ShownName,
    /// Dataset or command file for motions of markers [default: the one that the record names]
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Draw each unit in a panel of its own
    #[arg(long)]
    panels: bool,
    /// Title above the picture [default: none]
    #[arg(long)]
    title: Option<String>,
    /// Write a file instead of drawing in the terminal: .svg, .png or .pdf [default: the terminal]
    #[arg(long, short, value_name = "FILE", alias = "svg", conflicts_with_all = ["statistics", "list"], value_parser = piped::output("svg"))]
    out: Option<PathBuf>,
    #[command(flatten)]
    writing: WritingArgs,
    /// Print ends, extremes and means of the columns instead
    #[arg(long)]
    statistics: bool,
    /// Print the names and units of all columns instead
    #[arg(long, conflicts_with = "statistics")]
    list: bool,
    /// Print the statistics as JSON
    #[arg(long, requires = "statistics")]
    json: bool,
}

/// The values of a column, or a curve made of them.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum ShownName {
    /// the values
    Values,
    /// the slope over x
    Derivative,
    /// the integral over x
    Integral,
    /// the amplitudes over frequency
    Spectrum,
}

impl From<ShownName> for Shown {
    fn from(name: ShownName) -> Self {
        match name {
            ShownName::Values => Shown::Values,
            ShownName::Derivative => Shown::Derivative,
            ShownName::Integral => Shown::Integral,
            ShownName::Spectrum => Shown::Spectrum,
        }
    }
}

/// Plots columns of results.
///
/// # Errors
/// When the results cannot be read, have no such column, or no finite value.
pub fn run(args: &Args) -> Outcome {
    if args.end.is_some() && !is_model(&args.input) {
        let what = "--end is the last time for functions of a model; results end where they do";
        return Err(Failure::usage(what));
    }
    let setup = setup_of(args)?;
    let mut sources = sources(args, setup.as_ref())?;
    if args.list {
        say(&list(&sources[0].run));
        return Ok(Exit::Done);
    }
    let setup = match setup {
        Some(setup) => setup,
        None if is_needed(args, &sources[0].run) => {
            grouped::setup_of(&args.input, args.model.as_deref())?
        }
        None => Setup::default(),
    };
    let mut names = args.y.clone();
    for group in &args.groups {
        names.extend(grouped::columns_of(&setup, &sources[0].run, group)?);
    }
    if is_model(&args.input) && names.is_empty() {
        names.extend(setup.functions.iter().map(|f| f.name.text.clone()));
    }
    for Source { run, .. } in &mut sources {
        grouped::add_functions(run, &setup, &names)?;
    }
    if names.is_empty() && args.statistics {
        names = all_names(&sources[0].run, args.x.as_deref());
    }
    for (Source { run, .. }, file) in sources
        .iter_mut()
        .zip([&args.input].into_iter().chain(&args.over))
    {
        let asked: Vec<&str> = names.iter().chain(&args.x).map(String::as_str).collect();
        add_measures(run, file, args.model.as_deref(), &asked)?;
    }
    let mut found = shown(args, &sources, &names)?;
    if args.statistics {
        say(&statistics_of(&found, args.json));
        return Ok(Exit::Done);
    }
    if let Some(title) = &args.title {
        found.title = title.clone();
    }
    if names.is_empty() && args.x.is_none() {
        let (shown, all) = (found.curves.len(), all_names(&sources[0].run, None).len());
        if shown < all {
            remark(format!(
                "the first {shown} of {all} columns: --y chooses others, --list tells all"
            ));
        }
    }
    let plots = found.arranged(args.panels);
    match &args.out {
        Some(file) => {
            args.writing.check([file])?;
            write(&plots, file, args.writing)
        }
        None => draw_all(plots),
    }
}

/// Returns the curves: those of a sweep by its parameters, else the columns as they are.
fn shown(args: &Args, sources: &[Source], names: &[String]) -> Result<Channels, Diagnostic> {
    let (x, shown) = (args.x.as_deref(), Shown::from(args.shown));
    if let ([source], Shown::Values, false) = (sources, shown, args.statistics)
        && let Some(found) = responses(source, x, names)?
    {
        return Ok(found);
    }
    channels(sources, x, names, shown)
}

/// Returns whether a file is a model, whose functions are shown.
fn is_model(file: &Path) -> bool {
    is_dataset(file) || has_ending(file, "acf")
}

/// Returns the set-up of a model that is shown; `None`: results are shown.
fn setup_of(args: &Args) -> Result<Option<Setup>, Failure> {
    let model = is_model(&args.input).then(|| setup::of_model(&args.input));
    let setup = model.transpose()?;
    if setup.as_ref().is_some_and(|s| s.functions.is_empty()) {
        let what = format!("{} has no functions to show", disk::text(&args.input));
        let d = Diagnostic::error("empty_plot", what);
        let advice = "cognate group function makes one; a model has results once it has been run";
        return Err(d.help(advice).into());
    }
    Ok(setup)
}

/// Returns whether a plot of results shows what is not in them.
fn is_needed(args: &Args, run: &Run) -> bool {
    !args.groups.is_empty() || args.y.iter().any(|y| run.find(y).is_none())
}

/// Reads all runs, or the functions of a model; each run is named by its file, with its folder
/// where files are called alike.
fn sources(args: &Args, setup: Option<&Setup>) -> Result<Vec<Source>, Failure> {
    let Some(setup) = setup else {
        return Ok(runs(args)?);
    };
    let mut times = grouped::over_time(setup, &args.input, args.end);
    if args.list {
        let known = setup.functions.iter().map(|f| f.name.text.clone());
        grouped::add_functions(&mut times, setup, &known.collect::<Vec<_>>())?;
    }
    let label = run::stem(&args.input);
    Ok(vec![Source { label, run: times }])
}

/// Reads all runs.
fn runs(args: &Args) -> Result<Vec<Source>, Diagnostic> {
    let files: Vec<&PathBuf> = [&args.input].into_iter().chain(&args.over).collect();
    let stem = |file: &Path| {
        let stem = file.file_stem().unwrap_or_default();
        disk::text(&stem)
    };
    let alike = |file: &Path| files.iter().filter(|f| stem(f) == stem(file)).count() > 1;
    (files.iter())
        .map(|file| {
            let folder = file.parent().filter(|_| alike(file));
            let folder = folder
                .map(|f| format!("{}/", disk::text(&f)))
                .unwrap_or_default();
            Ok(Source {
                run: recorded::read(file)?,
                label: folder + &stem(file),
            })
        })
        .collect()
}

/// Returns the names of the columns of a table, but that of x.
fn all_names(run: &Run, x: Option<&str>) -> Vec<String> {
    let x = x.and_then(|x| run.find(x)).unwrap_or(0);
    let is_shown = |c: &usize| *c != x && run.columns[*c].bar_of.is_none();
    let columns = run.table_columns().into_iter().filter(is_shown);
    columns
        .filter_map(|c| Some(run.columns.get(c)?.name.clone()))
        .collect()
}

/// Prints the names and units of all columns, with their ranges.
fn list(run: &Run) -> String {
    let mut table = Table::new(["column", "unit", "least", "largest"]);
    for column in &run.columns {
        let points: Vec<(f64, f64)> = (column.values.iter().enumerate())
            .map(|(k, &y)| (k as f64, y))
            .collect();
        let range = statistics(&points).map(|s| [s.least.0, s.largest.0]);
        let range = range.map_or([String::new(), String::new()], |r| {
            r.map(results::digits_of_six)
        });
        let [least, largest] = range;
        table.push([column.name.clone(), column.unit.clone(), least, largest]);
    }
    table.text(width::columns())
}

/// Prints the statistics of channels.
fn statistics_of(found: &Channels, as_json: bool) -> String {
    let of = |c: &Curve| statistics(&c.points);
    if as_json {
        let all: Vec<Value> = (found.curves.iter())
            .map(|c| statistics_as_json(c, of(c)))
            .collect();
        return results::json::text(&json!(all));
    }
    let heads = [
        "column", "unit", "first", "last", "least", "at", "largest", "at", "mean", "rms",
    ];
    let mut table = Table::new(heads);
    for curve in &found.curves {
        let numbers = of(curve).map(|s| {
            [
                s.ends[0],
                s.ends[1],
                s.least.0,
                s.least.1,
                s.largest.0,
                s.largest.1,
                s.mean,
                s.rms,
            ]
        });
        let cells = numbers
            .map(|all| all.map(results::digits_of_six))
            .unwrap_or_default();
        let mut row = vec![curve.name.clone(), curve.unit.clone()];
        row.extend(cells);
        table.push(row);
    }
    format!("over {}\n{}", found.x_label, table.text(width::columns()))
}

fn statistics_as_json(curve: &Curve, found: Option<Statistics>) -> Value {
    let point = |p: (f64, f64)| json!({ "value": p.0, "at": p.1 });
    json!({
        "name": curve.name,
        "unit": curve.unit,
        "first": found.map(|s| s.ends[0]),
        "last": found.map(|s| s.ends[1]),
        "least": found.map(|s| point(s.least)),
        "largest": found.map(|s| point(s.largest)),
        "mean": found.map(|s| s.mean),
        "rms": found.map(|s| s.rms),
    })
}

/// Writes a picture of plots below each other to a file.
///
/// # Errors
/// When there is nothing to draw, or the file cannot be written.
fn write(plots: &[Plot], file: &Path, writing: WritingArgs) -> Outcome {
    writing.bytes(file, &picture::bytes(&svg::panels(plots)?, file)?)?;
    remark(format!("plot in {}", disk::text(&file)));
    Ok(Exit::Done)
}

/// Writes the picture to a file.
///
/// # Errors
/// When there is nothing to draw, or the file cannot be written.
pub fn write_one(plot: &Plot, file: &Path, writing: WritingArgs) -> Outcome {
    write(std::slice::from_ref(plot), file, writing)
}

/// Draws plots below each other on standard output; an axis at the right becomes a plot of its own.
fn draw_all(plots: Vec<Plot>) -> Outcome {
    let mut text = String::new();
    for plot in plots.into_iter().flat_map(Plot::split) {
        text += &terminal(&plot, terminal_style())?;
    }
    say(&text);
    Ok(Exit::Done)
}

/// Returns the style of a picture that fits the terminal.
pub fn terminal_style() -> Style {
    Style {
        columns: width::picture(),
        lines: 16,
        colour: render::colour_on_stdout(),
    }
}
