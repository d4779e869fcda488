//! The manual as JSON, for editors.

use cognate::internals::dataset::manual::{self, Effect, Entry, Page};
use cognate::internals::dataset::value::Kind;
use serde_json::{Value, json};

/// Returns all pages and all models.
pub fn all() -> Value {
    let pages: Vec<Value> = (manual::all())
        .map(|(heading, found)| {
            let mut value = page(found);
            value["heading"] = json!(heading);
            value
        })
        .collect();
    let models: Vec<Value> = (manual::examples().iter())
        .map(|m| json!({ "name": m.name, "about": m.about, "dataset": m.dataset, "commands": m.commands, "options": m.options }))
        .collect();
    json!({ "statements": pages, "models": models })
}

/// Returns a page.
pub fn page(page: &Page) -> Value {
    json!({
        "keyword": page.keyword,
        "numbered": page.numbered(),
        "summary": page.summary,
        "text": page.text,
        "equation": page.equation,
        "effect": page.effect.word(),
        "arguments": page.entries().iter().map(argument).collect::<Vec<_>>(),
        "example": page.lines_of_example(),
        "model": (!page.example.is_empty()).then_some(page.example),
    })
}

fn argument(entry: &Entry) -> Value {
    let (a, note) = (&entry.argument, entry.note);
    let first = a.name.split('|').next().unwrap_or(a.name);
    let capitals: String = first
        .chars()
        .take_while(|c| !c.is_ascii_lowercase())
        .collect();
    let others: Vec<String> = a
        .name
        .split('|')
        .skip(1)
        .map(str::to_ascii_uppercase)
        .collect();
    json!({
        "name": note.name,
        "shortest": (capitals.len() < first.len()).then_some(capitals),
        "other_spellings": others,
        "type": a.kind.name(),
        "takes": a.kind.describe(),
        "words": words(&a.kind),
        "unit": (!note.unit.is_empty()).then_some(note.unit),
        "default": (!note.default.is_empty()).then_some(note.default),
        "required": a.required,
        "repeated": a.repeated,
        "one_of": a.group,
        "has_effect": note.effect == Effect::Solved,
        "meaning": note.meaning,
    })
}

/// Returns the words that an argument takes.
fn words(kind: &Kind) -> &'static [&'static str] {
    match kind {
        Kind::Word(words) | Kind::Words(words) => words,
        Kind::Flag
        | Kind::Id
        | Kind::Ids { .. }
        | Kind::Real { .. }
        | Kind::Reals { .. }
        | Kind::Text
        | Kind::Texts
        | Kind::Formula
        | Kind::Raw => &[],
    }
}
