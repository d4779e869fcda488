//! `cognate functions`: the names of the language, with their descriptions.

use super::card::{self, Card};
use super::{Exit, Outcome, say};
use cognate::diagnostic::{Cause, Diagnostic, near_names};
use cognate::results::json;
use serde_json::Value;

/// List the functions of the language, or explain one
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate functions
  cognate functions STEP5
  cognate functions --json")]
pub struct Args {
    /// Name of a function, constant or variable
    name: Option<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Lists the functions of the language, or explains one.
///
/// # Errors
/// When there is no such name.
pub fn run(args: &Args) -> Outcome {
    let cards = match &args.name {
        None => card::all(),
        Some(name) => of_name(name)?,
    };
    match (args.json, &args.name) {
        (true, _) => say(&json::text(
            &cards.iter().map(Card::json).collect::<Value>(),
        )),
        (false, Some(_)) => say(&text(&cards)),
        (false, None) => say(&list(&cards)),
    }
    Ok(Exit::Done)
}

/// Returns the names of the languages that are near to another.
pub fn near(name: &str) -> Vec<&'static str> {
    near_names(name, card::all().iter().map(|c| c.name))
}

/// Returns the cards of a name; none when no language knows it.
pub fn known(name: &str) -> Vec<Card> {
    card::of(name.trim().trim_end_matches("()"))
}

/// Returns the cards of a name.
///
/// # Errors
/// When no language knows it; the advice lists near names.
pub fn of_name(name: &str) -> Result<Vec<Card>, Diagnostic> {
    let cards = known(name);
    if !cards.is_empty() {
        return Ok(cards);
    }
    let near = near(name);
    let unknown = Diagnostic::error(Cause::UnknownName, format!("the language has no `{name}`"));
    Err(if near.is_empty() {
        unknown.help("`cognate functions` lists all names")
    } else {
        unknown.help(format!("did you mean {}?", near.join(" or ")))
    })
}

/// Prints cards below each other; where both languages have the name, each names its language.
pub fn text(cards: &[Card]) -> String {
    let one = |c: &Card| {
        if cards.len() > 1 {
            format!("{}: {}", c.group, c.text())
        } else {
            c.text()
        }
    };
    cards.iter().map(one).collect::<Vec<_>>().join("\n")
}

/// Prints one line per name, by group.
fn list(cards: &[Card]) -> String {
    let mut text = String::new();
    for group in cards.chunk_by(|a, b| a.group == b.group) {
        text += &format!(
            "{}{}\n",
            if text.is_empty() { "" } else { "\n" },
            group[0].group
        );
        for card in group {
            text += &format!("  {:44}  {}\n", card.signature, card.summary());
        }
    }
    text
}
