//! The manual of statements and commands: rows of documentation beside the tables that read them.
//!
//! A [`Page`] says what a statement is, its equation or its frames, and of each argument its
//! meaning, unit and default. Kind, spelling and need of an argument come from the table itself
//! ([`Page::entries`]), so that they stand once. A test asks that every statement has a page and
//! every argument a note; `cognate statements`, `cognate explain`, the prompt and
//! `docs/statements.md` print them. Each page names a model of `models/`, which runs.

mod bodies;
mod commands;
mod constraints;
mod contacts;
mod forces;
mod models;
mod outputs;
mod settings;
mod systems;

pub use models::{Example, example, examples};

use super::command::rows;
use super::row::{Argument, Meaning, Statement, canonical, meaning};
use crate::diagnostic::near_names;

/// The part that a statement or an argument plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// it takes part in what is computed or written
    Solved,
    /// it is read and written again, and has no effect
    Kept,
    /// it is read and written again; a model that has it is refused unless it is left out by name
    Refused,
}

impl Effect {
    /// Returns its name in JSON.
    pub fn word(self) -> &'static str {
        match self {
            Effect::Solved => "solved",
            Effect::Kept => "kept",
            Effect::Refused => "refused",
        }
    }
}

/// The documentation of an argument.
#[derive(Clone, Copy, Debug)]
pub struct Note {
    /// keyword, in capitals
    pub name: &'static str,
    /// unit in the units of the model; empty where there is none
    pub unit: &'static str,
    /// value that holds without it; empty where there is none
    pub default: &'static str,
    /// one or two sentences
    pub meaning: &'static str,
    /// its part
    pub effect: Effect,
}

/// The documentation of a statement or a command.
#[derive(Debug)]
pub struct Page {
    /// keyword, in capitals
    pub keyword: &'static str,
    /// one sentence
    pub summary: &'static str,
    /// paragraphs, one a line; may be empty
    pub text: &'static str,
    /// equations, or a picture of the frames; may be empty
    pub equation: &'static str,
    /// its part
    pub effect: Effect,
    /// all of its arguments
    pub notes: &'static [Note],
    /// name of a model that has it; empty where none runs with it
    pub example: &'static str,
}

/// An argument with its note.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// spelling, kind and need, from the table of statements
    pub argument: Argument,
    /// meaning, unit and default
    pub note: &'static Note,
}

/// Writes the note of an argument with a value.
const fn n(
    name: &'static str,
    unit: &'static str,
    default: &'static str,
    meaning: &'static str,
) -> Note {
    Note {
        name,
        unit,
        default,
        meaning,
        effect: Effect::Solved,
    }
}

/// Writes the note of an argument without unit and default.
const fn f(name: &'static str, meaning: &'static str) -> Note {
    n(name, "", "", meaning)
}

/// Writes the note of an argument that is read and written again, without effect.
const fn k(name: &'static str, meaning: &'static str) -> Note {
    Note {
        effect: Effect::Kept,
        ..f(name, meaning)
    }
}

/// ROUTINE beside FUNCTION=USER(…), the same everywhere.
const ROUTINE: Note = f(
    "ROUTINE",
    "Library and entry, library::entry, of the routine behind FUNCTION=USER(…). `run --routines` loads libraries that have it; programs register closures.",
);
/// Marker I of an element between two markers.
const I: Note = f("I", "The I marker: the element acts on its part.");
/// Marker J of an element between two markers.
const J: Note = f("J", "The J marker: its part feels the reaction.");

/// The tables one after the other, in the order in which they are printed.
const TABLES: [&[Page]; 8] = [
    bodies::PAGES,
    constraints::PAGES,
    forces::PAGES,
    contacts::PAGES,
    systems::PAGES,
    outputs::PAGES,
    settings::PAGES,
    commands::PAGES,
];

/// Headings of the tables.
pub const HEADINGS: [&str; 8] = [
    "Bodies and frames",
    "Constraints",
    "Forces",
    "Contact",
    "Data and systems of equations",
    "Output and shapes",
    "Settings of the model",
    "Commands of a command file",
];

/// Returns all pages, each with its heading.
pub fn all() -> impl Iterator<Item = (&'static str, &'static Page)> {
    let tables = HEADINGS.into_iter().zip(TABLES);
    tables.flat_map(|(heading, pages)| pages.iter().map(move |page| (heading, page)))
}

/// Returns the page of a statement or command; abbreviations are those of the files.
pub fn page(word: &str) -> Option<&'static Page> {
    let word = word.trim().trim_end_matches('/');
    let rows = rows();
    let keyword = match meaning(word, rows.iter().map(|r| r.keyword())) {
        Meaning::One(k) if word.len() >= 3 || word.eq_ignore_ascii_case("IC") => rows[k].keyword(),
        _ => return None,
    };
    all()
        .map(|(_, page)| page)
        .find(|p| p.keyword == canonical(keyword))
}

/// Returns keywords that are near to a word.
pub fn near(word: &str) -> Vec<&'static str> {
    near_names(word, all().map(|(_, page)| page.keyword))
}

impl Page {
    /// Returns its row in the table of statements or commands.
    pub fn row(&self) -> Option<&'static dyn Statement> {
        rows()
            .iter()
            .copied()
            .find(|r| canonical(r.keyword()) == self.keyword)
    }

    /// Returns true if each of its kind has a number.
    pub fn numbered(&self) -> bool {
        self.row().is_some_and(Statement::numbered)
    }

    /// Returns its arguments with their notes, in the order of the table.
    pub fn entries(&self) -> Vec<Entry> {
        let arguments = self.row().map(Statement::arguments).unwrap_or_default();
        let noted = arguments.into_iter().filter_map(|argument| {
            let keyword = argument.keyword();
            let note = self.notes.iter().find(|n| n.name == keyword)?;
            Some(Entry { argument, note })
        });
        noted.collect()
    }

    /// Returns its statements in its example, as they stand there.
    pub fn lines_of_example(&self) -> String {
        let Some(example) = example(self.example) else {
            return String::new();
        };
        let texts = [example.dataset, example.commands];
        texts.iter().map(|text| self.statements_in(text)).collect()
    }

    /// Returns the lines of its statements in a text, with those that continue them.
    fn statements_in(&self, text: &str) -> String {
        let (mut kept, mut within) = (String::new(), false);
        for line in text.lines() {
            within = match line.chars().next() {
                Some(',') => within,
                _ => self.begins(line),
            };
            if within {
                kept.extend([line, "\n"]);
            }
        }
        kept
    }

    /// Returns true if a line begins one of its statements.
    fn begins(&self, line: &str) -> bool {
        let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let head = line.split(|c| !word(c)).next().unwrap_or_default();
        let statement = line
            .get(head.len()..)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
        statement && page(head).is_some_and(|p| p.keyword == self.keyword)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_statement_and_command_has_a_page() {
        for row in rows().iter() {
            let keyword = canonical(row.keyword());
            let n_pages = all().filter(|(_, p)| p.keyword == keyword).count();
            assert_eq!(n_pages, 1, "give {keyword} a page in src/dataset/manual");
        }
        assert_eq!(all().count(), rows().len());
    }

    #[test]
    fn every_argument_has_a_note_and_every_note_an_argument() {
        for (_, page) in all() {
            let row = page.row().expect("a row of the tables");
            let arguments: Vec<String> = row.arguments().iter().map(Argument::keyword).collect();
            let notes: Vec<&str> = page.notes.iter().map(|n| n.name).collect();
            for argument in &arguments {
                let n_notes = notes.iter().filter(|n| *n == argument).count();
                assert_eq!(
                    n_notes, 1,
                    "{}: give {argument} a note in src/dataset/manual",
                    page.keyword
                );
            }
            for note in notes {
                assert!(
                    arguments.iter().any(|a| a == note),
                    "{} has no argument {note}",
                    page.keyword
                );
            }
        }
    }

    #[test]
    fn notes_are_sentences() {
        for (_, page) in all() {
            for text in page.notes.iter().map(|n| n.meaning).chain([page.summary]) {
                assert!(
                    text.len() > 8 && text.ends_with('.'),
                    "{}: {text}",
                    page.keyword
                );
            }
        }
    }

    #[test]
    fn every_solved_statement_stands_in_its_example() {
        for (_, page) in all() {
            let shown = page.lines_of_example();
            match page.effect {
                Effect::Solved => assert!(!shown.is_empty(), "{} has no example", page.keyword),
                Effect::Kept | Effect::Refused => {}
            }
        }
    }

    #[test]
    fn what_is_refused_is_told_so() {
        for (_, page) in all() {
            let kind = page.row().and_then(Statement::kind);
            let refused = kind.is_some_and(|kind| kind.is_unsolved());
            assert_eq!(page.effect == Effect::Refused, refused, "{}", page.keyword);
        }
    }

    #[test]
    fn abbreviations_find_their_page() {
        assert_eq!(page("simu").map(|p| p.keyword), Some("SIMULATE"));
        assert_eq!(page("contact/").map(|p| p.keyword), Some("CONTACT"));
        assert!(page("nonsense").is_none() && page("").is_none());
        assert!(near("CONTAKT").contains(&"CONTACT"));
    }
}
