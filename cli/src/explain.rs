//! `cognate explain`: the meaning of a code or a name, or the outline of a model.

use super::setup;
use super::verify::model_with_loads;
use super::{Exit, Failure, Outcome, card, say, width};
use super::{functions, statements};
use cognate::diagnostic::codes::{all, code};
use cognate::diagnostic::{Cause, Diagnostic, counted, near_names};
use cognate::internals::dataset::manual;
use cognate::internals::verify::idle::Idle;
use cognate::internals::verify::outline::{Outline, outline};
use cognate::results::json as json_record;
use serde_json::{Value, json};
use std::path::Path;

/// Elements whose operations are printed one by one.
const MOST_COSTS: usize = 12;

/// Explain the code of a mistake, a statement, a name of the language, or what becomes of a model
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate explain
  cognate explain unexpected_token
  cognate explain IMPACT
  cognate explain CONTACT        the statement, and the function
  cognate explain slider_crank.adm")]
pub struct Args {
    /// Code as it stands in error[CODE], a statement, a name of the language, or a model (.adm,
    /// .acf); all codes when not given
    what: Option<String>,
    /// Of a model: print the outline as JSON
    #[arg(long)]
    json: bool,
    /// Print all codes as Markdown, as docs/codes.md
    #[arg(long, conflicts_with_all = ["what", "json"])]
    markdown: bool,
}

/// Explains a code, a name or a model.
///
/// # Errors
/// When there is no such code or name, or the model has mistakes.
pub fn run(args: &Args) -> Outcome {
    match &args.what {
        None if args.markdown => say(&markdown()),
        None => say(&list()),
        Some(what) if is_model(what) => {
            let (model, dataset, loads) = model_with_loads(Path::new(what))?;
            let found = outline(&model).map_err(|d| Failure::in_model(&dataset, d))?;
            if args.json {
                let mut told = as_json(&found);
                told["loads"] = json!(loads.as_ref().map(json_record::loads));
                say(&format!("{told:#}\n"));
            } else {
                say(&as_text(&found));
                if let Some(loads) = &loads {
                    say(&format!("{}\n", setup::loads_acting(loads)));
                }
            }
        }
        Some(what) => say(&explained(what)?),
    }
    Ok(Exit::Done)
}

fn list() -> String {
    let width = all().map(|c| c.name.len()).max().unwrap_or(0);
    all()
        .map(|c| format!("{:width$}  {}\n", c.name, c.summary))
        .collect()
}

/// Returns all codes as a page of Markdown.
fn markdown() -> String {
    let mut page = String::from(
        "# Codes of mistakes and warnings\n\n\
         Every message has a code: `error[bad_number]`. `cognate explain CODE` prints one of these,\n\
         with an example and its remedy. This page is made by `cognate explain --markdown`.\n",
    );
    for code in all() {
        page += &format!(
            "\n## {}\n\n{}.\n\n```text\n{}\n```\n",
            code.name,
            sentence(code.summary),
            code.explanation
        );
    }
    page
}

/// Returns a text with a capital at its beginning.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

/// Returns the explanation of a code, or else the page of a statement and the card of a name of the
/// language.
///
/// # Errors
/// When nobody knows it; the advice lists near names.
pub fn explained(what: &str) -> Result<String, Diagnostic> {
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
    let cards = functions::known(what);
    let statement = manual::page(what)
        .filter(|page| cards.is_empty() || page.keyword.eq_ignore_ascii_case(what))
        .map(statements::text);
    let function = (!cards.is_empty()).then(|| functions::text(&cards));
    let found = match (statement, function) {
        (Some(statement), Some(function)) => {
            Some(format!("statement {statement}\nfunction {function}"))
        }
        (statement, function) => statement.or(function),
    };
    if let Some(found) = found {
        return Ok(found);
    }
    let mut near = near_names(what, all().map(|c| c.name));
    if near.is_empty() {
        near = [manual::near(what), functions::near(what)].concat();
        near.dedup();
    }
    let message = format!("`{what}` is no code, no statement, and no name of the language");
    let unknown = Diagnostic::error(Cause::UnknownName, message);
    Err(if near.is_empty() {
        unknown.help("`cognate explain` lists all codes, `cognate statements` all statements, `cognate functions` all names")
    } else {
        unknown.help(format!("did you mean {}?", near.join(" or ")))
    })
}

fn is_model(what: &str) -> bool {
    let file = Path::new(what);
    super::moved::is_dataset(file) || super::moved::has_ending(file, "acf")
}

/// Returns the outline of a model as JSON.
fn as_json(o: &Outline) -> Value {
    let forest: Vec<Value> = (o.forest.iter())
        .map(|c| json!({ "part": c.part, "by": c.by, "carrier": c.carrier, "coordinates": c.coordinates }))
        .collect();
    let unknowns: Vec<Value> = (o.unknowns.iter())
        .map(|(name, value)| json!({ "name": name, "value": value }))
        .collect();
    json!({
        "forest": forest,
        "welded": o.welded,
        "unknowns": unknowns,
        "downstream": o.downstream,
        "prescribed": o.prescribed,
        "rows": o.rows,
        "inputs": o.inputs,
        "left_out": o.left_out,
        "idle": o.idle.iter().map(idle_as_json).collect::<Vec<_>>(),
        "costs": o.costs.iter().map(|(id, n)| json!({ "element": id.to_string(), "operations": n })).collect::<Vec<_>>(),
        "operations": { "rate": o.operations.0, "projection": o.operations.1 },
        "elimination": o.elimination,
        "switches": o.switches,
        "warnings": o.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
}

/// Returns the elements of a kind that take no part, as JSON.
fn idle_as_json(idle: &Idle) -> Value {
    let elements: Vec<String> = idle.elements.iter().map(ToString::to_string).collect();
    json!({ "kind": idle.kind.keyword(), "why": idle.why.to_string(), "elements": elements })
}

/// Says in words what becomes of a model.
fn in_words(o: &Outline) -> String {
    let count = |n: usize, one: &str, many: &str| match n {
        0 => format!("no {many}"),
        1 => format!("1 {one}"),
        n => format!("{n} {many}"),
    };
    let moving = o
        .forest
        .iter()
        .filter(|c| c.by.is_none() || !c.coordinates.is_empty())
        .count();
    let coordinates: usize = o.forest.iter().map(|c| c.coordinates.len()).sum();
    let mut text = format!(
        "{}, with {} between them.",
        count(moving, "part moves", "parts move"),
        count(coordinates, "coordinate of joints", "coordinates of joints"),
    );
    text += &match o.prescribed.len() {
        0 => String::new(),
        1 => " A motion prescribes one of these.".to_owned(),
        n => format!(" Motions prescribe {n} of these."),
    };
    text += &match o.rows.len() {
        0 => " There is no closed loop.".to_owned(),
        n => format!(
            " Loops are closed by {}.",
            count(n, "equation", "equations")
        ),
    };
    card::wrapped(&text, 0, width::reading()) + "\n"
}

/// Prints the outline of a model.
fn as_text(o: &Outline) -> String {
    let mut out = in_words(o);
    out += "forest: what carries what\n";
    for c in &o.forest {
        let how = match &c.by {
            None => "moves freely in ground".to_string(),
            Some(by) if c.coordinates.is_empty() => format!("is one with {} ({by})", c.carrier),
            Some(_) => format!("on {} by {}", c.carrier, c.coordinates.join(", ")),
        };
        out += &format!("  {} {how}\n", c.part);
    }
    let mut list = |title: &str, lines: &[String]| {
        if !lines.is_empty() {
            out += &format!("{title}\n");
            for line in lines {
                out += &format!("  {line}\n");
            }
        }
    };
    let unknowns: Vec<String> = (o.unknowns.iter())
        // without the sign of a zero
        .map(|(name, value)| format!("{name} = {}", value + 0.0))
        .collect();
    list(
        "unknowns that are integrated, with their values at the start",
        &unknowns,
    );
    list(
        "integrated beside these, as the mechanism does not read them",
        &o.downstream,
    );
    list("prescribed by motions", &o.prescribed);
    list(
        "rows: equations that close loops (D.Xg: offset of I from J along x of ground; Zi.Xj: z of I against x of J)",
        &o.rows,
    );
    list("inputs that routines compute, zero here", &o.inputs);
    list("left out", &o.left_out);
    let idle: Vec<String> = o.idle.iter().map(ToString::to_string).collect();
    list("cost nothing while it moves", &idle);
    let warnings: Vec<String> = o.warnings.iter().map(ToString::to_string).collect();
    list("warnings", &warnings);
    out += &format!(
        "recorded\n  {} for the rates, by {}\n",
        counted(o.operations.0, "operation"),
        o.elimination
    );
    for (element, operations) in o.costs.iter().take(MOST_COSTS) {
        out += &format!("  {} of {element}\n", counted(*operations, "operation"));
    }
    if let Some(rest) = o.costs.get(MOST_COSTS..).filter(|rest| !rest.is_empty()) {
        let operations: usize = rest.iter().map(|cost| cost.1).sum();
        out += &format!(
            "  {} of {}\n",
            counted(operations, "operation"),
            counted(rest.len(), "other element")
        );
    }
    if o.operations.1 > 0 {
        out += &format!(
            "  {} to project onto the rows\n",
            counted(o.operations.1, "operation")
        );
    }
    if o.switches > 0 {
        out += &format!(
            "  {} watched for a change of branch\n",
            counted(o.switches, "value")
        );
    }
    out
}
