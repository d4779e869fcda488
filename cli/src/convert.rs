//! `cognate convert`: results from one format into another.

use super::output::StyleArgs;
use super::{Exit, Failure, Outcome, remark};
use cognate::results::{self, Run};
use std::path::{Path, PathBuf};

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
    /// Results to read
    input: PathBuf,
    /// File to write
    output: PathBuf,
    /// Keep this column (repeatable); time is always kept
    #[arg(long = "column", value_name = "NAME")]
    columns: Vec<String>,
    /// Keep the rows of this sequence, such as static_001 or dynamic_001 (repeatable)
    #[arg(long = "sequence", value_name = "NAME")]
    sequences: Vec<String>,
    #[command(flatten)]
    style: StyleArgs,
}

/// Converts results from one file into another.
///
/// # Errors
/// When a file cannot be read or written, or has no such column or sequence.
pub fn run(args: &Args) -> Outcome {
    if same_file(&args.input, &args.output) {
        return Err(Failure::usage(
            "the output is the input, which is never overwritten",
        ));
    }
    let mut run = results::read(&args.input)?;
    select_columns(&mut run, &args.columns)?;
    select_sequences(&mut run, &args.sequences)?;
    results::write(&run, &args.output, args.style.style())?;
    remark(format!(
        "{} columns, {} rows in {}",
        run.table_columns().len(),
        run.table_rows().count(),
        args.output.display()
    ));
    Ok(Exit::Done)
}

/// Returns whether two names are of one file that exists.
pub fn same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
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
