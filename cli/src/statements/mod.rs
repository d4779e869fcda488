//! `cognate statements`: the statements of datasets and the commands, with all of their arguments.

mod json;
mod markdown;

use super::card::wrapped;
use super::writing::WritingArgs;
use super::{Exit, Failure, Outcome, piped, say, width};
use cognate::diagnostic::Diagnostic;
use cognate::disk;
use cognate::internals::dataset::manual::{self, Effect, Entry, Example, Page};
use cognate::internals::dataset::value::Kind;
use std::path::{Path, PathBuf};

/// List the statements and commands, or explain one
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  cognate statements
  cognate statements CONTACT
  cognate statements --model cam --out .     writes cam.adm and cam.acf
  cognate statements --json                  for editors")]
pub struct Args {
    /// Keyword of a statement or command; abbreviations are understood
    name: Option<String>,
    /// Print one of the models of the manual, dataset and commands [default: none]
    #[arg(long, value_name = "NAME", conflicts_with_all = ["name", "json"])]
    model: Option<String>,
    /// Of --model: write the two files into this folder instead [default: they are printed]
    #[arg(long, value_name = "DIR", requires = "model", value_parser = piped::refused(piped::SEVERAL))]
    out: Option<PathBuf>,
    #[command(flatten)]
    writing: WritingArgs,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Print the whole manual as Markdown, as docs/statements.md
    #[arg(long, conflicts_with_all = ["name", "json", "model"])]
    markdown: bool,
}

/// Lists the statements and commands, or explains one.
///
/// # Errors
/// When there is no such statement or model, or the files of a model exist already.
pub fn run(args: &Args) -> Outcome {
    match (&args.name, &args.model) {
        (Some(name), _) => {
            let page = of_name(name)?;
            let shown = if args.json {
                cognate::results::json::text(&json::page(page))
            } else {
                text(page)
            };
            say(&shown);
        }
        (None, Some(model)) => of_model(model, args.out.as_deref().map(|out| (out, args.writing)))?,
        (None, None) if args.json => say(&cognate::results::json::text(&json::all())),
        (None, None) if args.markdown => say(&markdown::manual()),
        (None, None) => say(&list()),
    }
    Ok(Exit::Done)
}

/// Returns the list of all statements, or what one of them is.
///
/// # Errors
/// When there is no such statement.
pub fn about(name: &str) -> Result<String, Diagnostic> {
    match name {
        "" => Ok(list()),
        name => of_name(name).map(text),
    }
}

/// Returns the page of a statement.
///
/// # Errors
/// When there is none; the advice lists near names.
fn of_name(name: &str) -> Result<&'static Page, Diagnostic> {
    manual::page(name).ok_or_else(|| {
        let message = format!("there is no statement or command `{name}`");
        unknown(
            message,
            &manual::near(name),
            "`cognate statements` lists all",
        )
    })
}

/// Makes an error of a name that is not known, with near ones as advice.
fn unknown(message: String, near: &[&str], otherwise: &str) -> Diagnostic {
    let error = Diagnostic::error("unknown_name", message);
    if near.is_empty() {
        error.help(otherwise)
    } else {
        error.help(format!("did you mean {}?", near.join(" or ")))
    }
}

/// Prints a model, or writes its two files.
fn of_model(name: &str, folder: Option<(&Path, WritingArgs)>) -> Result<(), Failure> {
    let Some(model) = manual::example(name) else {
        let names: Vec<&str> = manual::examples().iter().map(|e| e.name).collect();
        let near = cognate::diagnostic::near_names(name, names.iter().copied());
        let otherwise = format!("the models are {}", names.join(", "));
        return Err(Failure::from(unknown(
            format!("the manual has no model `{name}`"),
            &near,
            &otherwise,
        )));
    };
    match folder {
        None => say(&format!(
            "! {0}.adm\n{1}\n! {0}.acf\n{2}",
            model.name, model.dataset, model.commands
        )),
        Some((folder, writing)) => write(model, folder, writing)?,
    }
    Ok(())
}

/// Writes the two files of a model.
fn write(model: &Example, folder: &Path, writing: WritingArgs) -> Result<(), Failure> {
    let files = [("adm", model.dataset), ("acf", model.commands)];
    let files = files.map(|(ending, text)| (folder.join(format!("{}.{ending}", model.name)), text));
    writing.check(files.iter().map(|(file, _)| file))?;
    for (file, text) in files {
        writing.text(&file, text)?;
        super::remark(format!("wrote {}", disk::text(&file)));
    }
    Ok(())
}

/// Prints one line a statement, by heading.
fn list() -> String {
    let (mut text, mut last) = (String::new(), "");
    for (heading, page) in manual::all() {
        if heading != last {
            text += &format!("{}{heading}\n", if text.is_empty() { "" } else { "\n" });
            last = heading;
        }
        let effect = match page.effect {
            Effect::Solved => "",
            Effect::Kept => "(read, without effect) ",
            Effect::Refused => "(read, not solved) ",
        };
        text += &hanging(
            &format!("  {}", head(page)),
            18,
            &format!("{effect}{}", page.summary),
        );
    }
    text += "\nmodels that run, `cognate statements --model NAME`\n";
    for model in manual::examples() {
        text += &hanging(&format!("  {}", model.name), 18, model.about);
    }
    text
}

/// Returns the head of a statement: `PART/id`.
fn head(page: &Page) -> String {
    let number = if page.numbered() { "/id" } else { "" };
    format!("{}{number}", page.keyword)
}

/// Returns the words for what is not solved.
fn warning(page: &Page) -> String {
    match page.effect {
        Effect::Solved => String::new(),
        Effect::Kept => "It is read and written again, and has no effect.".into(),
        Effect::Refused => format!(
            "It is read and written again, but not solved: a model that has it is refused, unless \
             `--skip-unsupported {}` leaves it out.",
            page.keyword
        ),
    }
}

/// Prints the page of a statement.
pub fn text(page: &Page) -> String {
    let width = width::reading().saturating_sub(4);
    let mut text = format!("{}\n", head(page));
    let paragraphs = [page.summary].into_iter().chain(page.text.lines());
    for paragraph in paragraphs
        .chain([warning(page).as_str()])
        .filter(|p| !p.is_empty())
    {
        text += &wrapped(paragraph, 2, width);
    }
    if !page.equation.is_empty() {
        text.push('\n');
        for line in page.equation.lines() {
            text += format!("    {line}").trim_end();
            text.push('\n');
        }
    }
    for (heading, entries) in groups(page) {
        text += &format!("\n  {heading}\n");
        for entry in entries {
            text += &hanging(&format!("    {}", form(&entry)), 34, &meaning(&entry));
        }
    }
    let lines = page.lines_of_example();
    if !lines.is_empty() {
        text += &format!(
            "\n  in a model that runs (`cognate statements --model {}`)\n",
            page.example
        );
        lines
            .lines()
            .for_each(|line| text += &format!("    {line}\n"));
    }
    text
}

/// Returns the arguments by need: heading, arguments.
fn groups(page: &Page) -> Vec<(String, Vec<Entry>)> {
    let mut groups: Vec<(String, Vec<Entry>)> = Vec::new();
    let mut add =
        |heading: String, entry: Entry| match groups.iter_mut().find(|(h, _)| *h == heading) {
            Some((_, entries)) => entries.push(entry),
            None => groups.push((heading, vec![entry])),
        };
    let entries = page.entries();
    let (kept, others): (Vec<Entry>, Vec<Entry>) = (entries.into_iter())
        .partition(|e| e.note.effect != Effect::Solved && e.argument.group.is_none());
    let (needed, rest): (Vec<Entry>, Vec<Entry>) =
        others.into_iter().partition(|e| e.argument.required);
    for entry in needed.into_iter().chain(rest) {
        let heading = match (entry.argument.group, entry.argument.required) {
            (Some(group), true) => format!("its {group}: one of these is needed"),
            (Some(group), false) => format!("its {group}: one of these"),
            (None, true) => "needed".to_owned(),
            (None, false) => "optional".to_owned(),
        };
        add(heading, entry);
    }
    for entry in kept {
        add("read and kept, without effect".to_owned(), entry);
    }
    groups
}

/// Returns how an argument is written: `QG=x,x,x`.
pub fn form(entry: &Entry) -> String {
    let value = value(&entry.argument.kind);
    let keyword = entry.argument.keyword();
    if value.is_empty() {
        keyword
    } else {
        format!("{keyword}={value}")
    }
}

/// Returns a value as it is written: `x,x,x` for three numbers.
fn value(kind: &Kind) -> String {
    let listed = |one: &str, min: usize, max: usize| match (min, max) {
        (a, b) if a == b && b <= 3 => vec![one; a].join(","),
        (a, b) if a == b => format!("{a} times {one}"),
        (_, usize::MAX) => format!("{one},{one},…"),
        (1, 2) => format!("{one}[,{one}]"),
        (a, b) => format!("{a} to {b} times {one}"),
    };
    match kind {
        Kind::Flag => String::new(),
        Kind::Id => "id".into(),
        Kind::Ids { min, max } => listed("id", *min, *max),
        Kind::Real { angle: false } => "x".into(),
        Kind::Real { angle: true } => "angle".into(),
        Kind::Reals { min, max, angle } => listed(if *angle { "angle" } else { "x" }, *min, *max),
        Kind::Word(words) if words.is_empty() || words.len() > 4 => "WORD".into(),
        Kind::Word(words) => words.join("|"),
        Kind::Words(_) => "WORD:WORD:…".into(),
        Kind::Text | Kind::Raw => "text".into(),
        Kind::Texts => "\"text\",…".into(),
        Kind::Formula => "expression".into(),
    }
}

/// Returns the meaning of an argument with its words, its unit and its default.
pub fn meaning(entry: &Entry) -> String {
    let (note, kind) = (entry.note, &entry.argument.kind);
    let mut text = note.meaning.to_owned();
    if let Kind::Word(words) = kind
        && words.len() > 4
    {
        text += &format!(" One of {}.", words.join(", "));
    }
    if !note.unit.is_empty() {
        text += &format!(" [{}]", note.unit);
    }
    if !note.default.is_empty() {
        text += &match kind {
            Kind::Flag => format!(" ({})", note.default),
            _ => format!(" Default: {}.", note.default),
        };
    }
    text
}

/// Prints a head and a text beside it that is indented; below it where the head is long.
fn hanging(head: &str, indent: usize, text: &str) -> String {
    let width = width::reading().saturating_sub(indent).max(30);
    let block = wrapped(text, indent, width);
    if head.chars().count() + 1 < indent {
        let padding = indent - head.chars().count();
        format!("{head}{:padding$}{}", "", block.trim_start())
    } else {
        format!("{head}\n{block}")
    }
}
