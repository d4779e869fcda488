//! `cognate convert`: results from one format into another.

use super::moved::has_ending;
use super::output::StyleArgs;
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, complain_in_files, piped, recorded, remark, run};
use cognate::dataset;
use cognate::diagnostic::{Cause, Diagnostic, Severity, counted};
use cognate::disk;
use cognate::results::Run;
use std::path::PathBuf;

/// Convert results from one format into another, or a command file of Adams View into a dataset
///
/// The names of the files tell the formats: .res (XML and old text form), .gra, .csv and
/// .parquet are read, also as parts of a run that was ended from outside (.part1); .csv,
/// .parquet, .json and .res are written. A command file of Adams View (.cmd) becomes a dataset
/// (.adm).
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate convert run.res run.csv
  cognate convert run.gra run.csv --column PART_2_XFORM.X --column PART_2_XFORM.Y
  cognate convert run.res run.json --sequence dynamic_001
  cognate convert model.cmd model.adm
  cognate convert model.cmd longer.adm --set .model.DV_length=250")]
pub struct Args {
    /// Results to read; - reads .csv from standard input, gra:- and so on others
    #[arg(value_parser = piped::results())]
    input: PathBuf,
    /// File to write
    #[arg(value_parser = piped::output("csv"))]
    output: PathBuf,
    /// Keep this column (repeatable); time is always kept [default: all]
    #[arg(long = "column", value_name = "NAME")]
    columns: Vec<String>,
    /// Keep the rows of this sequence, such as static_001 or dynamic_001 (repeatable) [default:
    /// all]
    #[arg(long = "sequence", value_name = "NAME")]
    sequences: Vec<String>,
    /// Value of a design variable of a command file of Adams View, as .model.DV_1=2.5 (repeatable)
    /// [default: those of the file]
    #[arg(long, value_name = "NAME=VALUE", value_parser = run::variable)]
    set: Vec<(String, f64)>,
    #[command(flatten)]
    style: StyleArgs,
    #[command(flatten)]
    writing: WritingArgs,
}

/// Converts results from one file into another.
///
/// # Errors
/// When a file cannot be read or written, or has no such column or sequence.
pub fn run(args: &Args) -> Outcome {
    args.writing.check_beside(&args.input, [&args.output])?;
    if has_ending(&args.input, "cmd") {
        return convert_model(args);
    }
    let mut run = recorded::read(&args.input)?;
    select_columns(&mut run, &args.columns)?;
    select_sequences(&mut run, &args.sequences)?;
    args.writing.run(&run, &args.output, args.style.style())?;
    remark(format!(
        "{}, {} in {}",
        counted(run.table_columns().len(), "column"),
        counted(run.table_rows().count(), "row"),
        disk::text(&args.output)
    ));
    Ok(Exit::Done)
}

/// Writes the dataset that a command file of Adams View means. What it cannot say is told, and
/// stands in comments at its beginning; the exit code says that it is not the whole model.
///
/// # Errors
/// When the file cannot be read, has mistakes, or the dataset cannot be written.
fn convert_model(args: &Args) -> Outcome {
    if !has_ending(&args.output, "adm") {
        let what = "a command file of Adams View becomes a dataset: its name ends in .adm";
        return Err(Failure::usage(what));
    }
    let source =
        dataset::open(&args.input).map_err(|e| Failure::in_files(Exit::Input, e.into()))?;
    let reading = dataset::read_with(source, &args.set.iter().cloned().collect());
    let is_left_out = |d: &&Diagnostic| d.is(Cause::ViewUnsolved);
    let is_mistake = |d: &Diagnostic| d.severity == Severity::Error && !d.is(Cause::ViewUnsolved);
    if reading.diagnostics.iter().any(is_mistake) {
        return Err(Failure::in_files(Exit::Input, reading.diagnostics));
    }
    complain_in_files(&reading.diagnostics);
    let mut text = reading.model.to_text();
    let left_out: Vec<String> = (reading.diagnostics.iter().filter(is_left_out))
        .map(|d| format!("! not in this dataset: {}\n", d.message))
        .collect();
    let title = text.find('\n').map_or(text.len(), |end| end + 1);
    text.insert_str(title, &left_out.concat());
    args.writing.text(&args.output, &text)?;
    let elements = reading.model.elements().len();
    let (elements, output) = (counted(elements, "element"), disk::text(&args.output));
    remark(format!("{elements} in {output}"));
    Ok(match left_out.is_empty() {
        true => Exit::Done,
        false => Exit::Model,
    })
}

/// Keeps time and the named columns of the table; `.res` keeps all, as its elements refer to them.
fn select_columns(run: &mut Run, names: &[String]) -> Result<(), Failure> {
    if names.is_empty() {
        return Ok(());
    }
    let mut table = vec![0];
    for name in names {
        table.extend(run.resolve_all(name)?);
    }
    run.table = table;
    Ok(())
}

/// Keeps the rows of the named sequences.
fn select_sequences(run: &mut Run, names: &[String]) -> Result<(), Failure> {
    if names.is_empty() {
        return Ok(());
    }
    if let Some(unknown) = names
        .iter()
        .find(|n| run.sequences.iter().all(|s| s.name != **n))
    {
        let known: Vec<&str> = run.sequences.iter().map(|s| s.name.as_str()).collect();
        let d = cognate::diagnostic::Diagnostic::error(
            "unknown_sequence",
            format!("there is no sequence `{unknown}`"),
        );
        return Err(d.help(format!("sequences: {}", known.join("  "))).into());
    }
    run.keep_sequences(|s| names.contains(&s.name));
    Ok(())
}
