//! The card of a name of the language: all facts of its tables in one form, for
//! `cognate functions`, and for help and completion in the REPL.

use super::example;
use cognate::expr::Symbol;
use cognate::expr::ast::{Callee, Constant, Dialect};
use cognate::expr::functions::Continuity;
use cognate::expr::measures;
use cognate::expr::signature::{Argument, Kind};
use cognate::expr::{Profile, names, symbol};
use serde_json::{Value, json};

/// All facts about a name.
pub struct Card {
    /// the name as it is written
    pub name: &'static str,
    /// language it belongs to
    pub dialect: Dialect,
    /// heading in the list
    pub group: &'static str,
    /// `STEP(x, x0, h0, x1, h1)`
    pub signature: String,
    /// description: a sentence, then remarks
    pub doc: String,
    /// value as an equation; may be empty
    pub equation: String,
    /// dimension of the value; when empty, that of its arguments
    pub unit: String,
    /// arguments with their kinds
    pub arguments: Vec<(String, String)>,
    /// smoothness; `None`: as smooth as the motion it measures
    pub continuity: Option<Continuity>,
    /// expressions and their values
    pub examples: Vec<Example>,
    /// whether its value depends on the past
    pub needs_history: bool,
}

/// An expression and what it gives.
pub struct Example {
    /// the expression
    pub expression: String,
    /// its value; `None` where only a model has one
    pub value: Option<f64>,
    /// the value in words, where there is no number
    pub meaning: String,
}

impl Example {
    fn of_numbers(expression: &str, value: f64) -> Self {
        Self {
            expression: expression.to_owned(),
            value: Some(value),
            meaning: String::new(),
        }
    }
}

/// Headings in the order of the list.
const GROUPS: [&str; 12] = [
    "Constants and variables",
    "Arithmetic IF",
    "FORTRAN 77 intrinsics",
    "General utility functions",
    "Curves through data",
    "Displacement of markers",
    "Velocity of markers",
    "Acceleration of markers",
    "Forces between markers",
    "Forces of elements",
    "System elements",
    "Expression functions (degrees)",
];

/// Returns all cards of both languages, by group, in each group in the order of the tables.
pub fn all() -> Vec<Card> {
    let mut cards: Vec<Card> = [Dialect::Function, Dialect::Expression]
        .into_iter()
        .flat_map(|d| names(d).iter().map(move |n| card(n.0, n.1, d)))
        .collect();
    cards.sort_by_key(|c| GROUPS.iter().position(|g| *g == c.group));
    cards
}

/// Returns the cards of a name, one per language that knows it.
pub fn of(name: &str) -> Vec<Card> {
    let one = |dialect| {
        symbol(name, dialect, Profile::Ideas)
            .map(|meaning| card(written(meaning, dialect), meaning, dialect))
    };
    [Dialect::Function, Dialect::Expression]
        .into_iter()
        .filter_map(one)
        .collect()
}

fn written(meaning: Symbol, dialect: Dialect) -> &'static str {
    match meaning {
        Symbol::Constant(c) => c.name(dialect),
        Symbol::If => "IF",
        Symbol::Callee(c) => c.name(),
    }
}

/// Makes the card of a name.
fn card(name: &'static str, meaning: Symbol, dialect: Dialect) -> Card {
    let empty = Card {
        name,
        dialect,
        group: GROUPS[0],
        signature: name.to_owned(),
        doc: String::new(),
        equation: String::new(),
        unit: String::new(),
        arguments: Vec::new(),
        continuity: None,
        examples: Vec::new(),
        needs_history: false,
    };
    match meaning {
        Symbol::Constant(c) => Card { doc: constant(c).into(), ..empty },
        Symbol::If => Card {
            group: GROUPS[1],
            signature: "IF(selector: negative, zero, positive)".into(),
            doc: "The second, third or fourth expression, as the first is less than, equal to or greater than 0. Only the one that is \
                  selected is evaluated; the comparison is exact. There are no other comparisons in the language."
                .into(),
            continuity: Some(Continuity::Jump),
            arguments: [
                ("selector", "expression whose sign is asked"),
                ("negative", "value where the selector is less than 0"),
                ("zero", "value where it is 0"),
                ("positive", "value where it is greater than 0"),
            ]
            .map(|(name, what)| (name.to_owned(), what.to_owned()))
            .into(),
            examples: vec![
                Example::of_numbers("IF(-0.5: 1, 2, 3)", 1.0),
                Example::of_numbers("IF(2-2: 1, 2, 3)", 2.0),
            ],
            ..empty
        },
        Symbol::Callee(callee) => of_callee(callee, empty),
    }
}

/// Describes a constant.
fn constant(c: Constant) -> &'static str {
    match c {
        Constant::Time => "Time of the simulation.",
        Constant::Pi => "The ratio of circumference to diameter, 3.14159…",
        Constant::Dtor => "Degrees to radians: PI/180.",
        Constant::Rtod => "Radians to degrees: 180/PI.",
        Constant::Mode => {
            "Code of the running analysis: 1 kinematic, 3 initial conditions, 4 dynamic, 5 static, 6 quasi-static, 7 linear."
        }
    }
}

/// Fills the card of a function from its table.
fn of_callee(callee: Callee, empty: Card) -> Card {
    let card = Card {
        signature: callee.signature(),
        arguments: callee.arguments().iter().map(argument).collect(),
        needs_history: callee.needs_history(),
        ..empty
    };
    match callee {
        Callee::Function(f) => {
            let row = f.row();
            let mut card = card;
            card.arguments.extend(row.further.map(|further| {
                let name = match further.least {
                    0 => "…".to_owned(),
                    _ => format!("{}0, …", further.name),
                };
                (name, further.meaning.to_owned())
            }));
            Card {
                group: row.family.title(),
                doc: paragraphs(row.doc),
                equation: row.equation.to_owned(),
                continuity: Some(row.continuity),
                examples: row
                    .examples
                    .iter()
                    .map(|e| Example::of_numbers(e.source, e.value))
                    .collect(),
                ..card
            }
        }
        Callee::Interpolation(f) => {
            let row = f.row();
            Card {
                group: GROUPS[4],
                doc: paragraphs(row.doc),
                equation: row.equation.to_owned(),
                continuity: Some(row.continuity),
                ..card
            }
        }
        Callee::Measure(m) => {
            let row = m.row();
            Card {
                group: group(row.family),
                doc: paragraphs(row.doc),
                equation: row.formula.to_owned(),
                unit: row.dimension.to_string(),
                examples: vec![example::of_measure(m)],
                ..card
            }
        }
    }
}

/// Returns the name of an argument, with its kind and its part in the value in words.
fn argument(a: &Argument) -> (String, String) {
    let default = a
        .default
        .map_or(String::new(), |d| format!("; {d} when left out"));
    let what = match a.kind {
        Kind::Number => a.meaning.to_owned(),
        kind => format!("{}: {}", in_words(kind), a.meaning),
    };
    (a.name.to_owned(), what + &default)
}

/// Returns the heading of a group of measures.
fn group(family: measures::Family) -> &'static str {
    match family {
        measures::Family::Displacement => GROUPS[5],
        measures::Family::Velocity => GROUPS[6],
        measures::Family::Acceleration => GROUPS[7],
        measures::Family::GenericForce => GROUPS[8],
        measures::Family::ElementForce => GROUPS[9],
        measures::Family::System => GROUPS[10],
    }
}

/// Describes the kind of an argument in words.
fn in_words(kind: Kind) -> String {
    match kind {
        Kind::Number => "expression".into(),
        Kind::Identifier { element, zero } => {
            let name = format!("{element:?}").to_uppercase();
            let article = if name.starts_with('A') { "an" } else { "a" };
            format!(
                "number of {article} {name}{}",
                if zero { ", or 0" } else { "" }
            )
        }
        Kind::Selector(choice) => format!("whole number, {choice}"),
    }
}

/// Turns a documentation comment into paragraphs: line breaks within one go.
fn paragraphs(doc: &str) -> String {
    let lines = doc.lines().map(str::trim);
    let text = lines.fold(String::new(), |text, line| match line {
        "" if text.is_empty() || text.ends_with('\n') => text,
        "" => text + "\n",
        line if text.is_empty() || text.ends_with('\n') => text + line,
        line => text + " " + line,
    });
    text.trim_end().to_owned()
}

/// Describes the smoothness in words.
pub fn continuity_in_words(continuity: Continuity) -> &'static str {
    match continuity {
        Continuity::Jump => "the value may jump",
        Continuity::C0 => "continuous; the slope may jump",
        Continuity::C1 => "continuous with its slope; the curvature may jump",
        Continuity::C2 => "continuous with slope and curvature; a higher derivative may jump",
        Continuity::Smooth => "smooth: all derivatives are continuous",
    }
}

impl Card {
    /// Returns the description in one line: the first sentence, or its first part where it is long.
    pub fn summary(&self) -> &str {
        let first = self.doc.lines().next().unwrap_or_default();
        let sentence = first
            .split_inclusive(". ")
            .next()
            .unwrap_or(first)
            .trim_end();
        let part = sentence.split("; ").next().unwrap_or(sentence);
        if sentence.chars().count() > 96 {
            part
        } else {
            sentence
        }
    }

    /// Prints the card as help shows it.
    pub fn text(&self) -> String {
        let mut text = format!("{}\n", self.signature);
        for paragraph in self.doc.lines() {
            text += &wrapped(paragraph, 2, 92);
        }
        if !self.equation.is_empty() {
            text += "\n";
            for line in self.equation.lines() {
                text += &format!("    {line}\n");
            }
        }
        let mut facts: Vec<(String, String)> = self
            .arguments
            .iter()
            .map(|(name, what)| (name.clone(), what.clone()))
            .collect();
        facts.extend((!self.unit.is_empty()).then(|| ("unit".into(), self.unit.clone())));
        facts.extend(
            self.continuity
                .map(|c| ("continuity".into(), continuity_in_words(c).into())),
        );
        facts.extend(self.needs_history.then(|| {
            (
                "history".into(),
                "its value depends on what was before".into(),
            )
        }));
        let width = facts.iter().map(|f| f.0.chars().count()).max().unwrap_or(0);
        if !facts.is_empty() {
            text += "\n";
        }
        for (name, what) in facts {
            text += &format!("  {name:width$}  {what}\n");
        }
        if !self.examples.is_empty() {
            text += "\n";
        }
        let mut of_markers = false;
        for example in &self.examples {
            let value = match example.value {
                Some(value) => cognate::results::digits(value),
                None => example.meaning.clone(),
            };
            text += &format!("  {} = {value}\n", example.expression);
            of_markers |= !example.meaning.is_empty() && example.value.is_some();
        }
        if of_markers {
            text += &format!("\n  for these --markers:\n  {}\n", example::markers());
        }
        text
    }

    /// Returns the card as JSON.
    pub fn json(&self) -> Value {
        let argument = |(name, what): &(String, String)| json!({ "name": name, "what": what });
        let example = |e: &Example| json!({ "expression": e.expression, "value": e.value, "meaning": e.meaning });
        json!({
            "name": self.name,
            "dialect": match self.dialect { Dialect::Function => "function", Dialect::Expression => "expression" },
            "group": self.group,
            "signature": self.signature,
            "doc": self.doc,
            "equation": self.equation,
            "unit": self.unit,
            "arguments": self.arguments.iter().map(argument).collect::<Vec<_>>(),
            "continuity": self.continuity.map(|c| format!("{c:?}").to_lowercase()),
            "needs_history": self.needs_history,
            "examples": self.examples.iter().map(example).collect::<Vec<_>>(),
        })
    }
}

/// A paragraph in lines of at most `width`, each behind some blanks.
pub fn wrapped(text: &str, indent: usize, width: usize) -> String {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let at = lines.len() - 1;
        if !lines[at].is_empty() && lines[at].chars().count() + 1 + word.chars().count() > width {
            lines.push(word.to_owned());
        } else {
            if !lines[at].is_empty() {
                lines[at].push(' ');
            }
            lines[at].push_str(word);
        }
    }
    lines
        .into_iter()
        .map(|line| format!("{:indent$}{line}\n", ""))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_has_a_card_with_a_group_and_a_sentence() {
        let cards = all();
        assert!(cards.len() > 120, "{}", cards.len());
        for card in &cards {
            assert!(
                GROUPS.contains(&card.group),
                "{} stands under `{}`",
                card.name,
                card.group
            );
            assert!(card.summary().len() > 5, "{} says nothing", card.name);
            assert!(card.text().starts_with(&card.signature));
            assert!(
                of(card.name).iter().any(|c| c.signature == card.signature),
                "{}",
                card.name
            );
        }
        for group in GROUPS {
            assert!(cards.iter().any(|c| c.group == group), "{group} is empty");
        }
    }

    #[test]
    fn every_argument_says_what_it_is_and_every_function_shows_an_example() {
        for card in all().iter().filter(|c| c.signature.contains('(')) {
            for (name, what) in &card.arguments {
                assert!(
                    what.len() > 3 && !what.ends_with(": "),
                    "{} {name}: {what}",
                    card.name
                );
            }
            let needs_data = ["Curves through data"].contains(&card.group) || card.name == "DELAY";
            assert!(needs_data || !card.examples.is_empty(), "{}", card.name);
            for e in &card.examples {
                assert!(e.value.is_some() || e.meaning.len() > 5, "{}", card.name);
            }
        }
    }

    #[test]
    fn long_paragraphs_are_wrapped() {
        assert_eq!(wrapped("one two three", 2, 7), "  one two\n  three\n");
    }
}
