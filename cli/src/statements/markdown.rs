//! The manual as one page of Markdown: `docs/statements.md`.

use super::{form, head, meaning, warning};
use cognate::internals::dataset::manual::{self, Effect, Entry, Page};

const BEGINNING: &str = "\
# Statements and commands

Every statement of a dataset and every command, with its arguments. `cognate statements NAME` prints
one page of this, `cognate functions` lists the functions of expressions. This page is made by
`cognate statements --markdown`.

## Writing a dataset

The first line is a title. Then statements follow in any order, the last is `END`. Keywords may be
shortened to any beginning that is unambiguous, in capital or small letters.

```text
A title
! a comment
UNITS/SYSTEM=MMKS
PART/1, GROUND                      keyword/number, arguments in any order
MARKER/12, PART=1, QP=1,2,3         lists of numbers by commas
, REULER=90D,90D,0D                 a line that begins with a comma continues; D: degrees
SFORCE/3, TRANSLATIONAL, I=12, J=21
, FUNCTION=-10*(DM(12,21) - 5)\\     a backslash ends an expression where arguments follow it
END
```

*id* is the number of an element or a count, *x* a number, *angle* a number in radians (with the
suffix D in degrees). Units are those of `UNITS`.
";

/// Returns the whole manual.
pub fn manual() -> String {
    let (mut text, mut last) = (BEGINNING.to_owned(), "");
    for (heading, page) in manual::all() {
        if heading != last {
            text += &format!("\n## {heading}\n");
            last = heading;
        }
        text += &section(page);
    }
    text += "\n## Models\n\nEach runs as it stands; `cognate statements --model NAME --out .` writes its two files.\n";
    for model in manual::examples() {
        let mut command = format!("cognate run {}.acf", model.name);
        model
            .options
            .iter()
            .for_each(|o| command += &format!(" {o}"));
        text += &format!(
            "\n### Model {0}\n\n{1} `{command}`\n\n```text\n{2}```\n\n```text\n{3}```\n",
            model.name, model.about, model.dataset, model.commands
        );
    }
    text
}

/// Returns the section of a page.
fn section(page: &Page) -> String {
    let mut text = format!("\n### {}\n\n{}\n", head(page), page.summary);
    let warning = warning(page);
    for paragraph in page
        .text
        .lines()
        .chain([warning.as_str()])
        .filter(|p| !p.is_empty())
    {
        text += &format!("\n{paragraph}\n");
    }
    if !page.equation.is_empty() {
        text += &format!("\n```text\n{}\n```\n", page.equation);
    }
    let entries = page.entries();
    let (solved, kept): (Vec<Entry>, Vec<Entry>) = entries
        .into_iter()
        .partition(|e| e.note.effect == Effect::Solved);
    if !solved.is_empty() {
        text += "\n| argument | | meaning |\n|---|---|---|\n";
        for entry in &solved {
            text += &format!(
                "| `{}` | {} | {} |\n",
                form(entry).replace('|', "\\|"),
                need(entry),
                escaped(&meaning(entry))
            );
        }
    }
    if !kept.is_empty() {
        let names: Vec<String> = kept.iter().map(|e| format!("`{}`", e.note.name)).collect();
        text += &format!(
            "\nRead and written again, without effect: {}.\n",
            names.join(", ")
        );
    }
    let lines = page.lines_of_example();
    if !lines.is_empty() {
        text += &format!(
            "\nIn the model [{0}](#model-{0}):\n\n```text\n{lines}```\n",
            page.example
        );
    }
    text
}

/// Returns the need of an argument in words.
fn need(entry: &Entry) -> String {
    match (entry.argument.group, entry.argument.required) {
        (Some(group), true) => format!("needed: {group}"),
        (Some(group), false) => group.to_owned(),
        (None, true) => "needed".to_owned(),
        (None, false) => String::new(),
    }
}

/// Returns a text for a cell of a table: brackets and stars are meant as they are.
fn escaped(text: &str) -> String {
    text.replace('|', "\\|")
        .replace('[', "\\[")
        .replace('*', "\\*")
}
