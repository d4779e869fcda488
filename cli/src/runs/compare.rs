//! `cognate runs compare`: the largest differences between two runs, channel by channel.

use crate::recorded;
use crate::table::Table;
use crate::{Exit, Outcome, piped, remark, say, width};
use cognate::diagnostic::{Diagnostic, counted};
use cognate::disk;
use cognate::internals::results::kept::{self, KeptRun};
use cognate::results::comparison::{Comparison, Difference, compare};
use cognate::results::format::Format;
use cognate::results::{digits_of_six, json};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Channels that are printed when nobody says.
const MOST_SHOWN: usize = 25;

/// Formats in the order in which a run is read that has several: those of the table first.
const PREFERRED: [&str; 5] = ["csv", "table.json", "parquet", "res", "gra"];

/// Compare two runs: the largest difference of every channel, with its time
///
/// At the output times that both have; other times are left out, which is said, or the second run
/// is interpolated.
#[derive(clap::Args)]
pub struct Args {
    /// Name of a run with its folder, or a file of results of any format; - reads .csv from
    /// standard input, gra:- and so on others
    #[arg(value_parser = piped::results())]
    first: PathBuf,
    /// The other; - reads .csv from standard input, gra:- and so on others
    #[arg(value_parser = piped::results())]
    second: PathBuf,
    /// Compare at all output times of the first; the second is taken as straight between its own
    #[arg(long)]
    interpolate: bool,
    /// End with exit code 8 where a channel differs by more than this part of its range [default:
    /// any difference is fine]
    #[arg(long, value_name = "PART", value_parser = part)]
    tolerance: Option<f64>,
    /// Show all channels, also those without difference
    #[arg(long)]
    all: bool,
    /// Print the comparison as JSON
    #[arg(long)]
    json: bool,
}

/// Reads a tolerance.
fn part(text: &str) -> Result<f64, String> {
    let x = text.parse().ok().filter(|x: &f64| *x >= 0.0);
    x.ok_or_else(|| format!("`{text}` is no positive number"))
}

/// Compares two runs.
///
/// # Errors
/// When one cannot be read, or they share no time.
pub fn run(args: &Args) -> Outcome {
    let [a, b] = files(&args.first, &args.second)?;
    let runs = [recorded::read(&a)?, recorded::read(&b)?];
    let found = compare(&runs[0], &runs[1], args.interpolate)?;
    match args.json {
        true => say(&json::text(&as_json(&found, [&a, &b]))),
        false => print(&found, [&a, &b], args.all, &runs[0].units.time),
    }
    let is_beyond = |tolerance: f64| {
        let differs = |d: &Difference| d.relative() > tolerance || d.missing > 0;
        let is_whole = found.alone.iter().all(Vec::is_empty) && found.other_units.is_empty();
        !is_whole || found.channels.iter().any(differs)
    };
    Ok(match args.tolerance.is_some_and(is_beyond) {
        true => Exit::CheckFailed,
        false => Exit::Done,
    })
}

/// Returns the files of results that two arguments name: themselves, or of two runs those of the
/// first format that both have.
fn files(first: &Path, second: &Path) -> Result<[PathBuf; 2], Diagnostic> {
    let tables = [first, second].map(tables_of);
    let [first, second] = tables;
    let (first, second) = (first?, second?);
    let same = first.iter().find_map(|(format, a)| {
        let (_, b) = second.iter().find(|(other, _)| other == format)?;
        Some([a.clone(), b.clone()])
    });
    let own = |tables: &[(usize, PathBuf)]| tables.first().map(|(_, file)| file.clone());
    let each = || Some([own(&first)?, own(&second)?]);
    same.or_else(each).ok_or_else(|| {
        let what = "a run has no table that can be read";
        Diagnostic::error("unknown_run", what).help("`cognate run --format csv` writes one")
    })
}

/// Returns the tables that an argument names: a file of results, or those of a run, by preference.
fn tables_of(named: &Path) -> Result<Vec<(usize, PathBuf)>, Diagnostic> {
    let ending = named.extension().unwrap_or_default().to_string_lossy();
    let is_both = |row: &cognate::results::format::Row| row.read.is_some() && row.sink.is_some();
    let is_table = Format::row(&ending.to_lowercase()).is_some_and(is_both);
    let run = kept::find(named);
    let is_record = |run: &KeptRun| run.record_file() == named;
    if cognate::disk::is_there(named)
        && (is_table || run.is_err())
        && !run.as_ref().is_ok_and(is_record)
    {
        // other formats of the run do not matter: this one was chosen
        return Ok(vec![(PREFERRED.len(), named.to_owned())]);
    }
    let run = run?;
    let table = |(k, ending): (usize, &&str)| {
        let name = format!("{}.{ending}", run.name);
        let mut files = run.files().into_iter();
        let file = files.find(|f| f.path.file_name().is_some_and(|n| *n == *name))?;
        file.bytes.is_some().then_some((k, file.path))
    };
    Ok(PREFERRED.iter().enumerate().filter_map(table).collect())
}

/// Prints a comparison.
fn print(found: &Comparison, files: [&Path; 2], all: bool, time_unit: &str) {
    let differing = found.channels.iter().filter(|d| d.largest > 0.0).count();
    let shown = match all {
        true => found.channels.len(),
        false => differing.min(MOST_SHOWN),
    };
    if shown > 0 {
        say(&table(&found.channels[..shown]));
    }
    let [a, b] = files.map(|f| disk::text(&f));
    let mut facts = vec![format!(
        "{differing} of {} differ between {a} and {b}",
        counted(found.channels.len(), "channel")
    )];
    if differing > shown {
        facts.push(format!(
            "{} more differ by less: --all shows them",
            differing - shown
        ));
    }
    let missing = found.channels.iter().filter(|d| d.missing > 0).count();
    if missing > 0 {
        facts.push(format!(
            "in {}, one run alone has values at some outputs",
            counted(missing, "channel")
        ));
    }
    facts.push(match found.interpolated {
        true => format!(
            "at {} of {a}; {b} is taken as straight between its outputs",
            counted(found.outputs, "output time")
        ),
        false => format!(
            "at {} that both have",
            counted(found.outputs, "output time")
        ),
    });
    for (file, n) in [&a, &b].into_iter().zip(found.left_out) {
        if n > 0 && !(found.interpolated && file == &b) {
            facts.push(format!(
                "left out: {} of {file} at times that the other has not",
                counted(n, "output")
            ));
        }
    }
    for (file, names) in [&a, &b].into_iter().zip(&found.alone) {
        if !names.is_empty() {
            facts.push(format!("only in {file}: {}", names.join(", ")));
        }
    }
    for (name, [ua, ub]) in &found.other_units {
        facts.push(format!("{name} is in {ua} and {ub}: not compared"));
    }
    if !time_unit.is_empty() && shown > 0 {
        facts.push(format!("times in {time_unit}"));
    }
    facts.iter().for_each(remark);
}

/// Prints the differences, the largest first.
fn table(channels: &[Difference]) -> String {
    let has_bars = channels.iter().any(|d| d.bars.is_some());
    let heads = [
        "channel", "unit", "largest", "of range", "at time", "first", "second",
    ];
    let bar_heads = has_bars.then_some(["bars", "beyond bars"]);
    let mut table = Table::new(heads.into_iter().chain(bar_heads.into_iter().flatten()));
    for d in channels {
        let relative = d.relative();
        let mut cells = vec![
            d.channel.clone(),
            d.unit.clone(),
            digits_of_six(d.largest),
            match relative.is_finite() {
                true => format!("{relative:.2e}"),
                false => String::new(),
            },
            digits_of_six(d.time),
            digits_of_six(d.values[0]),
            digits_of_six(d.values[1]),
        ];
        if has_bars {
            cells.push(d.bars.map_or(String::new(), digits_of_six));
            cells.push(d.beyond_bars.map_or(String::new(), |n| n.to_string()));
        }
        table.push(cells);
    }
    table.text(width::columns())
}

fn as_json(found: &Comparison, files: [&Path; 2]) -> Value {
    let channel = |d: &Difference| {
        json!({
            "channel": d.channel,
            "unit": d.unit,
            "largest": d.largest,
            "relative": d.relative(),
            "range": d.range,
            "time": d.time,
            "values": d.values,
            "bars": d.bars,
            "beyond_bars": d.beyond_bars,
            "missing": d.missing,
        })
    };
    json!({
        "files": files.map(|f| disk::text(&f)),
        "outputs": found.outputs,
        "left_out": found.left_out,
        "interpolated": found.interpolated,
        "channels": found.channels.iter().map(channel).collect::<Vec<_>>(),
        "alone": found.alone,
        "other_units": found.other_units.iter().map(|(name, units)| json!({ "channel": name, "units": units })).collect::<Vec<_>>(),
    })
}
