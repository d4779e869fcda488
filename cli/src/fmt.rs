//! `cognate fmt`: a dataset in the style of Adams View, comments and order kept.

use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, piped, remark, say};
use cognate::dataset::{self, Reading, Source};
use cognate::diagnostic::{Diagnostic, Severity};
use cognate::disk;
use std::path::PathBuf;

/// Write a dataset in the style of Adams View
///
/// One argument per line, at most 80 columns, full keywords, shortest numbers. Comments, names and
/// order stay. What the dataset means stays too: the formatted text is read again and compared
/// before it is written.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate fmt model.adm                  prints the formatted dataset
  cognate fmt model.adm -o tidy.adm
  cognate fmt model.adm --check          exit code 8 where the file is not formatted")]
pub struct Args {
    /// Dataset (.adm); - reads a dataset from standard input
    #[arg(value_parser = piped::model())]
    file: PathBuf,
    /// Write nothing; exit with code 8 when the file is not formatted
    #[arg(long)]
    check: bool,
    /// File to write [default: standard output]
    #[arg(short, long, value_name = "OUT", conflicts_with = "check", value_parser = piped::output("adm"))]
    output: Option<PathBuf>,
    #[command(flatten)]
    writing: WritingArgs,
}

/// Formats a dataset.
///
/// # Errors
/// When it cannot be read, has a statement that was not understood, or cannot be written.
pub fn run(args: &Args) -> Outcome {
    let source = dataset::open(&args.file).map_err(super::check::failure)?;
    let reading = match dataset::is_view(&source) {
        true => dataset::read_source(source),
        // each file is formatted by itself
        false => dataset::read_alone(source),
    };
    super::run::refuse_view(&reading, "is formatted")?;
    refuse_mistakes(&reading)?;
    for included in reading.dataset.source.includes() {
        disk::note_input(&included);
    }
    let text = reading.dataset.formatted();
    // as the same file: its name says which arguments it may have
    let file = reading.dataset.source.file.as_deref();
    let again = dataset::read_alone(Source::from_text(file, text.as_str()));
    if again.model.to_text() != reading.model.to_text() {
        return Err(Failure {
            exit: Exit::Bug,
            ..Failure::from(Diagnostic::error(
                "bug",
                "the formatted dataset does not mean the same; nothing was written",
            ))
        });
    }
    if args.check {
        let same = text == reading.dataset.to_text();
        if !same {
            remark(format!("{} is not formatted", disk::text(&args.file)));
        }
        return Ok(if same { Exit::Done } else { Exit::CheckFailed });
    }
    let Some(output) = &args.output else {
        say(&text);
        return Ok(Exit::Done);
    };
    let bytes = reading.dataset.source.encode(&text);
    args.writing.bytes(output, &bytes)?;
    Ok(Exit::Done)
}

/// Refuses a dataset with a statement that was not understood, since that cannot be written; other
/// mistakes do not matter.
fn refuse_mistakes(reading: &Reading) -> Result<(), Failure> {
    let spans = reading.dataset.mistaken();
    if spans.is_empty() {
        return Ok(());
    }
    let inside = |d: &Diagnostic| {
        d.span.is_some_and(|s| {
            // statements stand one after another, so only the last that begins before can hold it
            let begun = spans.partition_point(|i| i.start <= s.start);
            begun > 0 && s.start <= spans[begun - 1].end
        })
    };
    let mut diagnostics = reading.diagnostics.clone();
    diagnostics.retain(|d| d.severity == Severity::Error && inside(d));
    Err(Failure {
        exit: Exit::Input,
        diagnostics,
        sources: super::check::sources(reading),
    })
}
