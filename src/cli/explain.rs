//! `cognate explain`: what a code or a name means.

use super::functions;
use super::{Exit, Outcome, say};
use crate::diagnostic::codes::{CODES, code};
use crate::diagnostic::{Diagnostic, near_names};

/// Explain the code of a mistake, or a name of the language
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate explain
  cognate explain unexpected_token
  cognate explain IMPACT")]
pub struct Args {
    /// Code as it stands in error[CODE], or a name of the language; all codes when not given
    what: Option<String>,
}

pub fn run(args: &Args) -> Outcome {
    match &args.what {
        None => say(&list()),
        Some(what) => say(&explained(what)?),
    }
    Ok(Exit::Done)
}

fn list() -> String {
    let width = CODES.iter().map(|c| c.name.len()).max().unwrap_or(0);
    CODES
        .iter()
        .map(|c| format!("{:width$}  {}\n", c.name, c.summary))
        .collect()
}

/// The explanation of a code; else the card of a name of the language.
fn explained(what: &str) -> Result<String, Diagnostic> {
    let what = what
        .trim()
        .trim_start_matches("error[")
        .trim_end_matches(']');
    if let Some(code) = code(what) {
        return Ok(format!(
            "{}: {}\n\n{}\n",
            code.name, code.summary, code.explanation
        ));
    }
    functions::of_name(what)
        .map(|cards| functions::text(&cards))
        .map_err(|of_names| {
            let near = near_names(what, CODES.iter().map(|c| c.name));
            let unknown = Diagnostic::error(
                "unknown_name",
                format!("`{what}` is no code, and the language has no such name"),
            );
            match (near.is_empty(), of_names.help.first()) {
                (false, _) => unknown.help(format!("did you mean {}?", near.join(" or "))),
                (true, Some(help)) if help.starts_with("did you mean") => {
                    unknown.help(help.clone())
                }
                _ => {
                    unknown.help("`cognate explain` lists all codes, `cognate functions` all names")
                }
            }
        })
}
