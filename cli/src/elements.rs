//! `cognate elements`: the elements of a model by their names; one of them with who names it; a
//! dataset with another name of an element, or without it.

use super::assembly;
use super::table::Table;
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, complain_in_files, piped, remark, run, say, width};
use cognate::dataset::{self, Dataset, Reading};
use cognate::diagnostic::{Diagnostic, Severity};
use cognate::disk;
use cognate::internals::dataset::manual;
use cognate::model::{ElementId, ElementKind, Model};
use cognate::results;
use serde_json::json;
use std::path::PathBuf;

/// List the elements of a model, show one of them, rename or delete one
///
/// Names are those of Adams View (`adams_view_name`); an element is called by its name, or by
/// keyword and number. A dataset is changed in its text: comments, order and numbers stay as they
/// are. An element that others name is not deleted.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate elements belt.adm
  cognate elements belt.adm --kind COUPLER
  cognate elements robot.adm --tree
  cognate elements belt.adm --show COUPLER/1
  cognate elements belt.adm --rename COUPLER/1=belt -o named.adm
  cognate elements belt.adm --delete COUPLER/1 -o without.adm")]
pub struct Args {
    /// Dataset (.adm); - reads a dataset from standard input
    #[arg(value_parser = piped::model())]
    model: PathBuf,
    /// List elements of this kind only (repeatable) [default: all]
    #[arg(long = "kind", value_name = "KEYWORD")]
    kinds: Vec<ElementKind>,
    /// Show the assembly: parts below what their names with dots begin with, and what each carries
    #[arg(long)]
    tree: bool,
    /// Show an element: its statement, whom it names and who names it [default: none, all are
    /// listed]
    #[arg(long, value_name = "ELEMENT")]
    show: Option<String>,
    /// Give an element another name (repeatable) [default: none]
    #[arg(long, value_name = "ELEMENT=NAME", value_parser = naming)]
    rename: Vec<(String, String)>,
    /// Take an element out (repeatable) [default: none]
    #[arg(long, value_name = "ELEMENT")]
    delete: Vec<String>,
    /// Dataset to write after --rename and --delete [default: none, they need it]
    #[arg(short = 'o', long = "out", value_name = "FILE.adm", value_parser = piped::output("adm"))]
    out: Option<PathBuf>,
    #[command(flatten)]
    writing: WritingArgs,
    /// Print the list as JSON
    #[arg(long)]
    json: bool,
}

/// Reads `COUPLER/1=belt`.
fn naming(text: &str) -> Result<(String, String), String> {
    let (element, name) = text.split_once('=').ok_or("it is ELEMENT=NAME")?;
    Ok((element.trim().to_owned(), name.trim().to_owned()))
}

/// Lists, shows or changes the elements of a dataset.
///
/// # Errors
/// When the dataset cannot be read, an element does not exist or is named by others, or a file
/// cannot be written.
pub fn run(args: &Args) -> Outcome {
    let (mut reading, _) = run::read_bare(&args.model)?;
    let changes = !args.rename.is_empty() || !args.delete.is_empty();
    if changes != args.out.is_some() {
        let what = "--rename and --delete write a dataset: -o FILE.adm";
        return Err(Failure::usage(what));
    }
    if let Some(out) = &args.out {
        args.writing.check([out])?;
        run::refuse_view(&reading, "is changed")?;
        for (element, name) in &args.rename {
            let id = reading.model.find_element(element)?;
            reading = renamed(&reading, id, name)?;
        }
        let model = &reading.model;
        let deleted = args
            .delete
            .iter()
            .map(|element| model.find_element(element));
        let deleted = deleted.collect::<Result<Vec<ElementId>, Diagnostic>>()?;
        reading = without(&reading, &deleted)?;
        let bytes = reading.dataset.source.encode(reading.dataset.to_text());
        args.writing.bytes(out, &bytes)?;
        remark(disk::text(&out));
        let is_error = |d: &&Diagnostic| d.severity == Severity::Error;
        let mistakes: Vec<Diagnostic> =
            (reading.diagnostics.iter().filter(is_error).cloned()).collect();
        complain_in_files(&mistakes);
        return Ok(match mistakes.is_empty() {
            true => Exit::Done,
            false => Exit::Input,
        });
    }
    if let Some(element) = &args.show {
        let id = reading.model.find_element(element)?;
        say(&shown(&reading.model, &reading.dataset, id)?);
    } else if args.tree {
        say(&assembly::tree(&reading.model));
    } else if args.json {
        say(&results::json::text(&as_json(&reading.model, &args.kinds)));
    } else {
        say(&list(&reading.model, &args.kinds));
    }
    Ok(Exit::Done)
}

/// Returns the elements of some kinds, or of all, with their names and whom they name.
fn of_kinds(model: &Model, kinds: &[ElementKind]) -> Vec<(ElementId, Option<String>, Vec<String>)> {
    let all = model.elements().into_iter();
    let wanted = all.filter(|(id, _)| kinds.is_empty() || kinds.contains(&id.kind));
    wanted
        .map(|(id, element)| {
            let references = element.references().into_iter();
            let references = references.filter(|(_, target)| target.number != 0);
            let names = references.map(|(argument, target)| format!("{argument}={target}"));
            (id, element.place().name.clone(), names.collect())
        })
        .collect()
}

/// Returns the list of the elements of some kinds, or of all, as a table.
pub fn list(model: &Model, kinds: &[ElementKind]) -> String {
    let mut table = Table::new(["element", "name", "names", ""]);
    for (id, name, names) in of_kinds(model, kinds) {
        let off = match model.is_active(id) {
            true => "",
            false => "switched off",
        };
        table.push([
            id.to_string(),
            name.unwrap_or_default(),
            names.join(" "),
            off.to_owned(),
        ]);
    }
    table.text(width::columns())
}

fn as_json(model: &Model, kinds: &[ElementKind]) -> serde_json::Value {
    let all = of_kinds(model, kinds).into_iter();
    let mut named_by = model.each_named_by();
    let all = all.map(|(id, name, names)| {
        let by = named_by.remove(&id).unwrap_or_default();
        let by: Vec<String> = by.iter().map(ToString::to_string).collect();
        json!({
            "element": id.to_string(), "name": name, "names": names, "named_by": by,
            "active": model.is_active(id),
        })
    });
    json!(all.collect::<Vec<_>>())
}

/// Returns an element: its statement, its meaning, whom it names and who names it.
///
/// # Errors
/// When it does not exist.
pub fn shown(model: &Model, dataset: &Dataset, id: ElementId) -> Result<String, Diagnostic> {
    let element = model.element(id).ok_or_else(|| model.no_element(id))?;
    let mut text = String::new();
    let place = element.place();
    let name = place.name.as_ref().map(|name| format!(" '{name}'"));
    text += &format!("{id}{}", name.unwrap_or_default());
    if place.line > 0 {
        text += &format!(", line {}", place.line);
        if let Some(file) = dataset.included_file_of(id) {
            text += &format!(" of {file}");
        }
    }
    text.push('\n');
    // of what commands of Adams View made, the statement that it becomes
    let made = || {
        let all = model.statements().into_iter();
        let mut all = all.filter(|(of, _)| *of == id);
        all.next().map(|(_, text)| text).unwrap_or_default()
    };
    let statement = dataset.statement(id).map_or_else(made, str::to_owned);
    for line in statement.trim_end().lines() {
        text += &format!("  {}\n", line.trim_end());
    }
    if let Some(page) = manual::page(id.kind.keyword()) {
        text += &format!("{}\n", page.summary);
    }
    let mut tell = |words: &str, all: Vec<String>| {
        if !all.is_empty() {
            text += &format!("{words} {}\n", all.join(", "));
        }
    };
    let named = element.references().into_iter().map(|(_, target)| target);
    let named = named.filter(|target| target.number != 0);
    tell("it names", named.map(|id| id.to_string()).collect());
    let by = model.named_by(id).into_iter();
    tell("it is named by", by.map(|id| id.to_string()).collect());
    if !model.is_active(id) {
        text += "it is switched off\n";
    }
    Ok(text)
}

/// Returns a dataset in which an element has another name, read again.
///
/// # Errors
/// When it does not exist, or the name cannot be written.
pub fn renamed(reading: &Reading, id: ElementId, name: &str) -> Result<Reading, Diagnostic> {
    if name.is_empty() || name.contains(['\'', '\n', '\r']) {
        let what = format!("`{name}` is no name: it stands between quotes, on one line");
        return Err(Diagnostic::error("bad_definition", what));
    }
    let text = reading.dataset.renamed(id, name);
    text.map(|text| again(reading, &text))
        .ok_or_else(|| not_here(reading, id))
}

/// Returns the mistake about an element that the text of a dataset does not hold.
fn not_here(reading: &Reading, id: ElementId) -> Diagnostic {
    let Some(file) = reading.dataset.included_file_of(id) else {
        return reading.model.no_element(id);
    };
    let what = format!("{id} stands in {file}, which this dataset includes");
    Diagnostic::error("include", what).help("change it in that file")
}

/// Returns a dataset without some elements, read again.
///
/// # Errors
/// When one does not exist, or others name it that stay.
pub fn without(reading: &Reading, ids: &[ElementId]) -> Result<Reading, Diagnostic> {
    let mut now = reading.clone();
    let mut named_by = reading.model.each_named_by();
    for &id in ids {
        let mut by = named_by.remove(&id).unwrap_or_default();
        by.retain(|other| !ids.contains(other));
        if !by.is_empty() {
            let by: Vec<String> = by.iter().map(ToString::to_string).collect();
            let what = format!("{id} is named by {}", by.join(", "));
            let d = Diagnostic::error("element_in_use", what);
            return Err(d.help("delete these first, or let them name others"));
        }
        let text = now.dataset.without(id);
        let text = text.ok_or_else(|| not_here(reading, id))?;
        now = again(&now, &text);
    }
    Ok(now)
}

/// Reads a changed text under the name of the file that it came from.
fn again(reading: &Reading, text: &str) -> Reading {
    let before = &reading.dataset.source;
    let mut source = cognate::dataset::Source::from_text(before.file.as_deref(), text);
    source.encoding = before.encoding;
    dataset::read_source(source)
}
