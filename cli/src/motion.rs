//! `cognate motion`: the motion of markers and joints relative to a marker, after a run.

use super::output::StyleArgs;
use super::recorded::model_of;
use super::writing::WritingArgs;
use super::{Exit, Outcome, piped, recorded, remark, say, summary, width};
use cognate::diagnostic::{Cause, Diagnostic, counted};
use cognate::disk;
use cognate::internals::motion::{MarkerMeasure, Recorded};
use cognate::model::{ElementId, ElementKind, Model};
use cognate::results::{Component, Entity, Run};
use std::path::PathBuf;

/// Show the motion of markers or joints relative to a marker, from the results of a run
///
/// Nothing is solved again. The results need the motion of all parts: RESULTS in the dataset, or
/// --format res or parquet. Components are along the axes of the marker that the motion is relative
/// to, and rates are those that an observer on it sees, unless --in and --seen-from say otherwise;
/// REQUEST takes ground for both. Where the model has changed since the run it is refused.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate motion out/run.res --of MARKER/20 --relative-to MARKER/10
  cognate motion out/run.res --of JOINT/3 --relative-to MARKER/10 --as velocity --out motion.csv
  cognate motion out/run.parquet --of MARKER/20 --relative-to MARKER/10 --in ground --seen-from ground
  cognate plot out/run.res --y 'VX(20,10,10,10)'          one of them as a column")]
pub struct Args {
    /// Results of the run: .res, .parquet, or .csv and .json with all parts; - reads .csv from
    /// standard input, gra:- and so on others
    #[arg(value_parser = piped::results())]
    results: PathBuf,
    /// Marker that moves, as MARKER/20, or joint, as JOINT/3 or by its name: its I marker
    /// (repeatable)
    #[arg(long = "of", value_name = "ELEMENT", required = true)]
    of: Vec<String>,
    /// Marker that the motion is relative to
    #[arg(long, value_name = "MARKER")]
    relative_to: String,
    /// Marker along whose axes components are, or ground [default: that of --relative-to]
    #[arg(long = "in", value_name = "MARKER")]
    axes: Option<String>,
    /// Marker from which rates are seen, or ground [default: that of --relative-to]
    #[arg(long, value_name = "MARKER")]
    seen_from: Option<String>,
    /// Kind of motion (repeatable) [default: all that the results have]
    #[arg(long = "as", value_enum, value_name = "KIND")]
    kinds: Vec<KindName>,
    /// Dataset or command file [default: the one that the record of the run names]
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Write the motion to a file: .csv, .res, .parquet or .json [default: a few rows are shown]
    #[arg(long, short, value_name = "FILE", value_parser = piped::output("csv"))]
    out: Option<PathBuf>,
    #[command(flatten)]
    style: StyleArgs,
    #[command(flatten)]
    writing: WritingArgs,
}

/// A kind of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum KindName {
    /// DX DY DZ DM, and 3-1-3 angles PSI THETA PHI
    Displacement,
    /// VX VY VZ VM WX WY WZ WM
    Velocity,
    /// ACCX ACCY ACCZ ACCM WDTX WDTY WDTZ WDTM
    Acceleration,
}

impl KindName {
    const ALL: [KindName; 3] = [Self::Displacement, Self::Velocity, Self::Acceleration];

    /// Returns the functions of the kind, and the markers that each takes after I.
    fn functions(self) -> &'static [(&'static str, Takes)] {
        use Takes::{J, Jk, Jkl, Jl};
        match self {
            Self::Displacement => &[
                ("DX", Jk),
                ("DY", Jk),
                ("DZ", Jk),
                ("DM", J),
                ("PSI", J),
                ("THETA", J),
                ("PHI", J),
            ],
            Self::Velocity => &[
                ("VX", Jkl),
                ("VY", Jkl),
                ("VZ", Jkl),
                ("VM", Jl),
                ("WX", Jk),
                ("WY", Jk),
                ("WZ", Jk),
                ("WM", J),
            ],
            Self::Acceleration => &[
                ("ACCX", Jkl),
                ("ACCY", Jkl),
                ("ACCZ", Jkl),
                ("ACCM", Jl),
                ("WDTX", Jkl),
                ("WDTY", Jkl),
                ("WDTZ", Jkl),
                ("WDTM", Jl),
            ],
        }
    }
}

/// Markers that a function takes after I: J, K whose axes resolve it, L from which rates are seen.
#[derive(Clone, Copy)]
enum Takes {
    J,
    Jk,
    Jl,
    Jkl,
}

/// Returns the number of a marker; 0 of `ground`.
fn marker(model: &Model, text: &str) -> Result<u32, Diagnostic> {
    if text.eq_ignore_ascii_case("ground") || text == "0" {
        return Ok(0);
    }
    let found = model.find_of(&[ElementKind::Marker], text);
    found.map(|id| id.number)
}

/// Shows or writes the motion of markers.
///
/// # Errors
/// When the results or their model cannot be read, have no such marker, or lack the motion of its
/// part.
pub fn run(args: &Args) -> Outcome {
    let written = args.out.as_ref();
    args.writing.check_beside(&args.results, written)?;
    let run = recorded::read(&args.results)?;
    let model = model_of(&args.results, args.model.as_deref())?;
    let group = group(args, &run, &model)?;
    match written {
        Some(out) => {
            args.writing.run(&group, out, args.style.style())?;
            let n = group.columns.len() - 1;
            remark(format!(
                "{} in {}",
                counted(n, "function"),
                disk::text(&out)
            ));
        }
        None => {
            let n_rows = group.table_rows().count();
            say(&summary::table(
                &group,
                n_rows,
                width::columns(),
                "--out FILE writes all",
            ));
        }
    }
    Ok(Exit::Done)
}

/// Makes the group of functions.
fn group(args: &Args, run: &Run, model: &Model) -> Result<Run, Diagnostic> {
    let mut group = Run::new(&run.name, &run.title, run.units.clone());
    group.columns[0] = run.columns.first().cloned().unwrap_or_default();
    group.sequences.clone_from(&run.sequences);
    let recorded = Recorded::new(run, model);
    let j = marker(model, &args.relative_to)?;
    let or_j = |text: &Option<String>| text.as_ref().map_or(Ok(j), |text| marker(model, text));
    let (k, l) = (or_j(&args.axes)?, or_j(&args.seen_from)?);
    for of in &args.of {
        let of = model.find_element(of)?;
        let i = moving_marker(model, of)?;
        let name = format!(
            "{}_TO_{}",
            name(model, of),
            name(model, ElementKind::Marker.id(j))
        );
        let mut components = Vec::new();
        for kind in KindName::ALL {
            if !args.kinds.is_empty() && !args.kinds.contains(&kind) {
                continue;
            }
            for (function, takes) in kind.functions() {
                let text = match takes {
                    Takes::J => format!("{function}({i},{j})"),
                    Takes::Jk => format!("{function}({i},{j},{k})"),
                    Takes::Jl => format!("{function}({i},{j},{l})"),
                    Takes::Jkl => format!("{function}({i},{j},{k},{l})"),
                };
                let Ok(Some(measure)) = MarkerMeasure::of(model, &text) else {
                    continue;
                };
                let mut column = match recorded.column(&text, &measure) {
                    Ok(column) => column,
                    // of kinds that nobody asked for, those are shown that the results have
                    Err(d) if d.is(Cause::NoMotionSet) && is_optional(args, kind) => break,
                    Err(d) => return Err(d),
                };
                column.name = format!("{name}.{function}");
                components.push(Component {
                    name: (*function).to_owned(),
                    column: group.columns.len(),
                });
                group.columns.push(column);
            }
        }
        group.entities.push(Entity {
            name: name.clone(),
            entity: name,
            kind: "Motion_Analysis".into(),
            id: of.number.into(),
            components,
        });
    }
    Ok(group)
}

fn is_optional(args: &Args, kind: KindName) -> bool {
    args.kinds.is_empty() && kind != KindName::Displacement
}

/// Returns the marker whose motion is that of a marker or joint: itself, or the I marker.
fn moving_marker(model: &Model, of: ElementId) -> Result<u32, Diagnostic> {
    match of.kind {
        ElementKind::Marker => Ok(of.number),
        ElementKind::Joint => {
            let joint = model.joints.get(&of.number).map(|joint| joint.i);
            joint.ok_or_else(|| {
                let what = format!("{of} does not exist in the model");
                Diagnostic::error(Cause::UnknownElement, what)
            })
        }
        _ => {
            let what = format!("{of} is neither a marker nor a joint");
            Err(Diagnostic::error("unfit_value", what)
                .help("--of MARKER/20 or --of JOINT/3; a part moves with its CM marker"))
        }
    }
}

/// Returns the name of an element, or KEYWORD_number; ground for marker 0.
fn name(model: &Model, id: ElementId) -> String {
    if id.number == 0 {
        return "ground".into();
    }
    model.labels().name(model, id)
}
