//! `cognate convert`: results from one format into another.

use super::output::StyleArgs;
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, piped, recorded, remark};
use cognate::diagnostic::counted;
use cognate::disk;
use cognate::results::Run;
use std::path::PathBuf;

/// Convert results from one format into another
///
/// The names of the files tell the formats: .res (XML and old text form), .gra, .csv and
/// .parquet are read, also as parts of a run that was ended from outside (.part1); .csv,
/// .parquet, .json and .res are written.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate convert run.res run.csv
  cognate convert run.gra run.csv --column PART_2_XFORM.X --column PART_2_XFORM.Y
  cognate convert run.res run.json --sequence dynamic_001")]
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
