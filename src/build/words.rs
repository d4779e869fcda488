//! The words by which programs in other languages add elements: a statement (`BUSHING`), or a type
//! of one (`REVOLUTE`, `INLINE`, `BOX`). They are read off the table of statements; the builders of
//! Python and C take them from here.

use super::{Element, End, ModelBuilder};
use crate::dataset::manual::{self, Effect, Entry, Page};
use crate::dataset::row::{Argument, Statement};
use crate::dataset::statement::STATEMENTS;
use crate::dataset::value::Kind;
use crate::diagnostic::{Diagnostic, near_names};
use crate::model::ElementKind;

/// A word that adds an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word {
    /// the word, in capitals
    pub word: String,
    /// the element that it adds
    pub kind: ElementKind,
    /// the type that it gives the element: `REVOLUTE` of a JOINT
    pub flag: Option<String>,
    /// the element acts between two markers, I and J
    pub has_ends: bool,
}

/// Groups of bare keywords each of which is a word by itself.
const TYPES: [&str; 2] = ["type", "shape"];

fn row(kind: ElementKind) -> &'static dyn Statement {
    let row = STATEMENTS.iter().find(|row| row.kind() == Some(kind));
    *row.unwrap_or_else(|| unreachable!("every kind has a row"))
}

/// Returns whether an argument is the type of its element.
fn is_type(argument: &Argument) -> bool {
    argument.group.is_some_and(|group| TYPES.contains(&group))
}

/// Returns whether an element has two markers between which it acts.
fn has_ends(row: &dyn Statement) -> bool {
    let is_end = |a: &&Argument| a.required && a.kind == Kind::Id && ["I", "J"].contains(&a.name);
    row.arguments().iter().filter(is_end).count() == 2
}

impl Word {
    /// Returns the words of all elements that are solved, in the order of the table of elements:
    /// each statement, and behind it its types. A type that has the name of a statement has that of
    /// its own before it: `GRAPHICS_CURVE`.
    pub fn all() -> Vec<Word> {
        let kinds = ElementKind::ALL.iter().filter(|kind| kind.is_solved());
        kinds.flat_map(|&kind| Self::of(kind)).collect()
    }

    /// Returns the words of one kind of element.
    fn of(kind: ElementKind) -> Vec<Word> {
        let row = row(kind);
        let statement = Word {
            word: kind.keyword().to_owned(),
            kind,
            flag: None,
            has_ends: has_ends(row),
        };
        let types = row.arguments().into_iter().filter(is_type).map(|argument| {
            let flag = argument.keyword();
            let word = match flag.parse::<ElementKind>() {
                Ok(_) => format!("{}_{flag}", kind.keyword()),
                Err(_) => flag.clone(),
            };
            let flag = Some(flag);
            Word {
                word,
                flag,
                ..statement.clone()
            }
        });
        let page = statement.page();
        let is_solved = |word: &Word| {
            let note = page
                .notes
                .iter()
                .find(|note| Some(note.name) == word.flag.as_deref());
            note.is_some_and(|note| note.effect == Effect::Solved)
        };
        let types: Vec<Word> = types.filter(is_solved).collect();
        [vec![statement], types].concat()
    }

    /// Finds a word, in capital or small letters; also a statement that is not solved.
    ///
    /// # Errors
    /// There is no such word; the advice lists near ones.
    pub fn find(word: &str) -> Result<Word, Diagnostic> {
        let known = Self::all();
        let found = known.iter().find(|w| w.word.eq_ignore_ascii_case(word));
        if let Some(found) = found {
            return Ok(found.clone());
        }
        if let Ok(kind) = word.parse::<ElementKind>() {
            return Ok(Self::of(kind).swap_remove(0));
        }
        let what = format!("`{word}` is no element");
        let said = Diagnostic::error("unknown_statement", what);
        let near = near_names(word, known.iter().map(|w| w.word.as_str()));
        Err(said.help(match near.is_empty() {
            true => "give the keyword of a statement, or a type of JOINT, JPRIM or GRAPHICS".into(),
            false => format!("did you mean {}?", near.join(" or ")),
        }))
    }

    /// Returns the page of its statement.
    pub fn page(&self) -> &'static Page {
        let page = manual::page(self.kind.keyword());
        page.unwrap_or_else(|| unreachable!("every statement has a page"))
    }

    /// Returns a sentence about it.
    pub fn summary(&self) -> &'static str {
        let page = self.page();
        let note = page
            .notes
            .iter()
            .find(|n| Some(n.name) == self.flag.as_deref());
        note.map_or(page.summary, |note| note.meaning)
    }

    /// Returns the arguments that it takes and that have an effect, but for its type and its ends.
    ///
    /// A note that begins with types (`SCREW: …`) is about an argument of these alone.
    pub fn arguments(&self) -> Vec<Entry> {
        let types: Vec<String> = (row(self.kind).arguments().iter())
            .filter(|a| is_type(a))
            .map(Argument::keyword)
            .collect();
        let belongs = |entry: &Entry| {
            let (of, rest) = entry.note.meaning.split_once(": ").unwrap_or_default();
            let of: Vec<&str> = of.split(", ").collect();
            let is_about_types =
                !rest.is_empty() && of.iter().all(|w| types.iter().any(|t| t == w));
            let flag = self.flag.as_deref();
            !is_about_types || flag.is_none_or(|flag| of.contains(&flag))
        };
        let mut all = self.page().entries();
        all.retain(|entry| {
            let keyword = entry.argument.keyword();
            let is_end = self.has_ends && ["I", "J"].contains(&keyword.as_str());
            let is_own_type = self.flag.is_some() && is_type(&entry.argument);
            let has_effect = entry.note.effect == Effect::Solved;
            has_effect && !is_end && !is_own_type && belongs(entry)
        });
        all
    }
}

impl ModelBuilder {
    /// Adds the element of a word.
    pub fn add(&self, word: &Word, name: &str) -> Element<'_> {
        typed(word, self.element(word.kind, name))
    }

    /// Adds the element of a word between two ends, as [`between`](Self::between) does.
    pub fn add_between(
        &self,
        word: &Word,
        name: &str,
        i: impl Into<End>,
        j: impl Into<End>,
    ) -> Element<'_> {
        typed(word, self.between(word.kind, name, i, j))
    }
}

fn typed<'m>(word: &Word, element: Element<'m>) -> Element<'m> {
    match &word.flag {
        Some(flag) => element.flag(flag),
        None => element,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{JointKind, PrimitiveKind};
    use std::collections::BTreeSet;

    #[test]
    fn every_solved_element_joint_and_primitive_has_one_word_of_its_own() {
        let all = Word::all();
        let words: BTreeSet<&str> = all.iter().map(|w| w.word.as_str()).collect();
        assert_eq!(words.len(), all.len(), "a word means two things");
        let joints = JointKind::ALL.iter().map(|kind| kind.row().keyword);
        let primitives = PrimitiveKind::ALL.iter().map(|kind| kind.row().keyword);
        let kinds = ElementKind::ALL.iter().filter(|kind| kind.is_solved());
        for wanted in joints
            .chain(primitives)
            .chain(kinds.map(|kind| kind.keyword()))
        {
            let found = Word::find(&wanted.to_lowercase()).expect("a word");
            assert_eq!(found.word, wanted);
        }
    }

    #[test]
    fn a_shape_takes_its_own_arguments_and_a_joint_those_of_its_type() {
        let keywords = |word: &str| -> Vec<String> {
            let found = Word::find(word).expect("a word").arguments();
            found.iter().map(|entry| entry.argument.keyword()).collect()
        };
        assert_eq!(keywords("box"), ["CORNER", "X", "Y", "Z"]);
        assert_eq!(keywords("TORUS"), ["CM", "MAJOR_RADIUS", "MINOR_RADIUS"]);
        assert_eq!(keywords("GRAPHICS_CURVE"), ["CID", "CRM"]);
        assert_eq!(keywords("SCREW"), ["IC", "ICTRAN", "ICROT", "PITCH"]);
        assert!(keywords("INLINE").is_empty());
        assert!(keywords("GRAPHICS").contains(&"BOX".to_owned()));
    }

    #[test]
    fn a_word_that_is_none_gets_near_ones() {
        let said = Word::find("REVOLUT").expect_err("no word").to_string();
        assert!(said.contains("REVOLUTE"), "{said}");
        let said = Word::find("").expect_err("no word").to_string();
        assert!(said.contains("is no element"), "{said}");
        // what is not solved can be said, and is refused when it is run
        assert_eq!(Word::find("TIRE").expect("a statement").word, "TIRE");
    }
}
