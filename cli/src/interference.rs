//! `cognate interference`: how near solids come to each other during a run, and whether they
//! overlap.

use super::output::StyleArgs;
use super::recorded;
use super::recorded::model_of;
use super::table::Table;
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, piped, remark, say, width};
use cognate::diagnostic::Diagnostic;
use cognate::disk;
use cognate::internals::interference::{Interference, Pair, interference};
use cognate::internals::motion::Recorded;
use cognate::internals::physics::contact::query::separation::Gap;
use cognate::internals::report::mechanism::Overlap;
use cognate::model::{ElementId, Model};
use cognate::results::{self, Component, Entity, Run, digits_of_six};
use serde_json::{Value, json};
use std::path::PathBuf;

/// Find where solids of GRAPHICS come near each other or overlap, from the results of a run
///
/// Nothing is solved again. Distances are those at the outputs, along the direction in which two
/// solids overlap least; negative where they overlap.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate interference out/run.res
  cognate interference out/run.res --pair PART/2,PART/5 --pair GRAPHICS/7,PART/1
  cognate interference out/run.res --clearance 2            ends with 8 where a pair comes nearer
  cognate interference out/run.res --out distances.csv      all distances over time")]
pub struct Args {
    /// Results of the run: .res, .parquet, or .csv and .json with all parts; - reads .csv from
    /// standard input, gra:- and so on others
    #[arg(value_parser = piped::results())]
    results: PathBuf,
    /// Two parts or GRAPHICS to look at, with a comma (repeatable) [default: all pairs]
    #[arg(long = "pair", value_name = "A,B", value_parser = pair)]
    pairs: Vec<[String; 2]>,
    /// Distance that must remain; a pair that comes nearer ends the command with exit code 8
    /// [default: nothing is demanded]
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    clearance: Option<f64>,
    /// Dataset or command file [default: the one that the record of the run names]
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Write all distances over time to a file: .csv, .res, .parquet or .json [default: they are
    /// not written]
    #[arg(long, short, value_name = "FILE", value_parser = piped::output("csv"))]
    out: Option<PathBuf>,
    /// Print the pairs as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    style: StyleArgs,
    #[command(flatten)]
    writing: WritingArgs,
}

/// Reads `PART/2,GRAPHICS/3`, or two names.
fn pair(text: &str) -> Result<[String; 2], String> {
    let (a, b) = text
        .split_once(',')
        .ok_or_else(|| format!("`{text}` is not A,B"))?;
    Ok([a, b].map(str::to_owned))
}

/// Finds the interference of a run.
///
/// # Errors
/// When the results or their model cannot be read, or lack the motion of parts.
pub fn run(args: &Args) -> Outcome {
    args.writing.check_beside(&args.results, &args.out)?;
    let run = recorded::read(&args.results)?;
    let model = model_of(&args.results, args.model.as_deref())?;
    let recorded = Recorded::new(&run, &model);
    let folders = folders(args);
    let of_pair = |[a, b]: &[String; 2]| Ok([model.find_element(a)?, model.find_element(b)?]);
    let pairs = args.pairs.iter().map(of_pair);
    let pairs = pairs.collect::<Result<Vec<_>, Diagnostic>>()?;
    let mut found = interference(&recorded, &model, &pairs, &folders)?;
    let distance = |p: &Pair| p.nearest().map_or(f64::INFINITY, |(_, gap)| gap.distance);
    found
        .pairs
        .sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    for (graphics, why) in &found.left_out {
        remark(format!("{graphics} is not looked at: {why}"));
    }
    tell_of_hulls(&found);
    if let Some(out) = &args.out {
        let table = over_time(&run, &model, &found);
        args.writing.run(&table, out, args.style.style())?;
        remark(format!(
            "{} pairs in {}",
            found.pairs.len(),
            disk::text(&out)
        ));
    }
    match args.json {
        _ if args.out.as_deref().is_some_and(piped::is_output) => {}
        true => say(&results::json::text(&as_json(&run, &found))),
        false if found.pairs.is_empty() => say("no pair of solids on different parts\n"),
        false => say(&table(&run, &model, &found)),
    }
    let too_near = |clearance: f64| found.pairs.iter().any(|p| distance(p) < clearance);
    Ok(match args.clearance.is_some_and(too_near) {
        true => Exit::CheckFailed,
        false => Exit::Done,
    })
}

/// Returns where solids of different bodies overlap at the rows of a run that tables show.
///
/// # Errors
/// When the run lacks the motion of parts.
pub fn overlaps(model: &Model, run: &Run, folders: &[PathBuf]) -> Result<Vec<Overlap>, Failure> {
    let recorded = Recorded::new(run, model);
    let found = interference(&recorded, model, &[], folders)?;
    tell_of_hulls(&found);
    let shown: Vec<usize> = run.table_places(run.held()).collect();
    let mut all = Vec::new();
    for pair in found.pairs {
        let gaps: Vec<_> = shown
            .iter()
            .map(|&row| pair.gaps.get(row).copied().flatten())
            .collect();
        let overlapping = |gap: &Option<Gap>| gap.filter(|gap| gap.distance < 0.0);
        let deepest = gaps.iter().enumerate();
        let deepest = deepest.filter_map(|(row, gap)| Some((row, overlapping(gap)?.distance)));
        let Some((deepest, distance)) = deepest.min_by(|a, b| a.1.total_cmp(&b.1)) else {
            continue;
        };
        all.push(Overlap {
            elements: pair.graphics,
            places: gaps
                .iter()
                .map(|gap| overlapping(gap).map(|gap| gap.place.0))
                .collect(),
            depth: -distance,
            deepest,
        });
    }
    Ok(all)
}

/// Says of which shells something is known of their convex hull alone.
fn tell_of_hulls(found: &Interference) {
    for (graphics, what) in &found.hulls {
        remark(format!("{graphics} {what}"));
    }
}

/// Returns the folders in which files of shells are looked for: those of the model and of the
/// results, and the one that the latter stands in.
fn folders(args: &Args) -> Vec<PathBuf> {
    let folder = |path: &PathBuf| path.parent().map(std::path::Path::to_path_buf);
    let of_results = folder(&args.results);
    let above = of_results.as_ref().map(|folder| folder.join(".."));
    let all = [args.model.as_ref().and_then(folder), of_results, above];
    all.into_iter().flatten().collect()
}

/// Returns the name of an element with its statement, if it has one.
fn named(model: &Model, id: ElementId) -> String {
    let name = model.element(id).and_then(|e| e.place().name.clone());
    name.map_or_else(|| id.to_string(), |name| format!("{id} ({name})"))
}

/// Returns a coordinate of a place, or zero where it is rounding beside the farthest of all places.
fn without_noise(x: f64, size: f64) -> f64 {
    /// Part of the size below which a coordinate is rounding.
    const ROUNDING: f64 = 1e-12;
    if x.abs() < ROUNDING * size { 0.0 } else { x }
}

/// Prints the pairs, the nearest first, with the spans in which they overlap.
fn table(run: &Run, model: &Model, found: &Interference) -> String {
    let heads = [
        "solids", "of", "nearest", "at time", "at x", "y", "z", "overlap",
    ];
    let mut table = Table::new(heads);
    let nearest = found.pairs.iter().filter_map(Pair::nearest);
    let size = nearest.fold(0.0_f64, |size, (_, gap)| size.max(gap.place.norm()));
    for pair in &found.pairs {
        let Some((row, gap)) = pair.nearest() else {
            continue;
        };
        let time = |row: usize| digits_of_six(run.columns[0].values[row]);
        let spans = pair.spans_nearer_than(0.0).into_iter();
        let spans = spans.map(|[first, last]| match first == last {
            true => time(first),
            false => format!("{} to {}", time(first), time(last)),
        });
        let [x, y, z] = gap.place.0.map(|x| digits_of_six(without_noise(x, size)));
        let [of_i, of_j] = pair.bodies.map(|id| named(model, id));
        let [i, j] = pair.graphics;
        table.push([
            format!("{i}, {j}"),
            format!("{of_i}, {of_j}"),
            digits_of_six(gap.distance),
            time(row),
            x,
            y,
            z,
            spans.collect::<Vec<_>>().join(", "),
        ]);
    }
    table.text(width::columns())
}

fn as_json(run: &Run, found: &Interference) -> Value {
    let time = |row: usize| run.columns[0].values[row];
    let pair = |p: &Pair| {
        let nearest = p.nearest().map(|(row, gap)| {
            json!({ "distance": gap.distance, "time": time(row), "place": gap.place.0 })
        });
        let spans = p.spans_nearer_than(0.0).into_iter();
        json!({
            "graphics": p.graphics.map(|id| id.to_string()),
            "bodies": p.bodies.map(|id| id.to_string()),
            "nearest": nearest,
            "overlaps": spans.map(|span| span.map(time)).collect::<Vec<_>>(),
        })
    };
    let left_out = found.left_out.iter();
    json!({
        "length": run.units.length,
        "pairs": found.pairs.iter().map(pair).collect::<Vec<_>>(),
        "hulls": found.hulls.iter().map(|(id, what)| json!({ "element": id.to_string(), "what": what })).collect::<Vec<_>>(),
        "left_out": left_out.map(|(id, why)| json!({ "element": id.to_string(), "why": why })).collect::<Vec<_>>(),
    })
}

/// Returns the distances and places of all pairs as results over time.
fn over_time(run: &Run, model: &Model, found: &Interference) -> Run {
    let mut out = Run::new(&run.name, &run.title, run.units.clone());
    out.columns[0] = run.columns.first().cloned().unwrap_or_default();
    out.sequences.clone_from(&run.sequences);
    for pair in &found.pairs {
        let name = |id: ElementId| {
            let named = model.element(id).and_then(|e| e.place().name.clone());
            named.unwrap_or_else(|| format!("{}_{}", id.kind, id.number))
        };
        let set = pair.graphics.map(name).join("_TO_");
        let mut components = Vec::new();
        for (k, component) in ["DISTANCE", "X", "Y", "Z"].into_iter().enumerate() {
            let column = out.add_column(format!("{set}.{component}"), &run.units.length);
            let value = |gap: &Option<_>| match gap {
                Some(Gap { distance, place }) => {
                    if k == 0 {
                        *distance
                    } else {
                        place.0[k - 1]
                    }
                }
                None => f64::NAN,
            };
            out.columns[column].values = pair.gaps.iter().map(value).collect();
            let name = component.to_owned();
            components.push(Component { name, column });
        }
        out.entities.push(Entity {
            name: set.clone(),
            entity: set,
            kind: "Interference".into(),
            id: pair.graphics[0].number.into(),
            components,
        });
    }
    out
}
