//! Commands obeyed one after the other: objects made, changed and deleted, branches and loops.
//!
//! Nothing outside the file is read or run: macros, further files and the program's own settings
//! are told.

use super::commands::{self, Meaning, Row};
use super::database::{Coordinates, Database, Datum, Item, Sequence};
use super::frames::Reading;
use super::syntax::{Argument, Command, Form, Piece};
use super::term::{self, Term};
use crate::dataset::syntax::Source;
use crate::diagnostic::{Diagnostic, Span};
use std::rc::Rc;

/// Commands that a file may have obeyed, those of loops each time.
const MOST_COMMANDS: usize = 1_000_000;
/// Mistakes after which a file is read no further: a loop makes the same one each time.
const MOST_MISTAKES: usize = 500;
/// Branches and loops within one another.
const DEEPEST_BLOCK: usize = 64;

/// A simulation that a file asks for, its arguments by name.
#[derive(Clone, Debug)]
pub(super) struct Simulation {
    pub kind: &'static str,
    pub arguments: Vec<(&'static str, String)>,
    pub span: Span,
}

/// The way on behind a command.
#[derive(Clone, Copy, PartialEq)]
enum Flow {
    Next,
    Break,
    Continue,
    Return,
}

/// A file that is obeyed.
pub(super) struct Interpreter<'a> {
    pub source: &'a Source,
    pub db: Database,
    pub simulations: Vec<Simulation>,
    commands: &'a [Command],
    /// of each command that begins a block its end; of `else` the end as well
    ends: Vec<Option<usize>>,
    obeyed: usize,
    depth: usize,
    /// kinds of commands that were told not to be read
    unread: std::collections::BTreeMap<String, (usize, Span)>,
}

impl<'a> Interpreter<'a> {
    pub fn new(source: &'a Source, commands: &'a [Command], db: Database) -> Self {
        let mut this = Self {
            source,
            db,
            simulations: Vec::new(),
            commands,
            ends: vec![None; commands.len()],
            obeyed: 0,
            depth: 0,
            unread: std::collections::BTreeMap::new(),
        };
        this.db.is_saved = source.text.contains("Expression definitions");
        this.match_blocks();
        this
    }

    /// Obeys all commands.
    pub fn run(&mut self) {
        self.block(0, self.commands.len());
        let unread = std::mem::take(&mut self.unread);
        for (words, (count, span)) in unread {
            let times = match count {
                1 => String::new(),
                n => format!(" ({n} times)"),
            };
            let what = format!("`{words}` is not read{times}");
            self.say(Diagnostic::warning("view_left_out", what), span);
        }
    }

    /// Says something, once at a place.
    pub(super) fn say(&self, said: Diagnostic, span: Span) {
        if self.db.told.borrow_mut().insert(span.start) {
            self.db.say(self.source.locate(said, span));
        }
    }

    pub(super) fn slice(&self, span: Span) -> &'a str {
        self.source.slice(span)
    }

    fn word(&self, k: usize) -> String {
        let first = self.commands[k].words.first();
        first.map_or(String::new(), |w| self.slice(*w).to_ascii_lowercase())
    }

    fn begins_block(&self, k: usize) -> bool {
        let has = |name: &str| {
            let mut names = self.commands[k].arguments.iter();
            names.any(|a| begins(name, self.slice(a.name)))
        };
        match self.word(k).as_str() {
            "if" | "while" => has("condition"),
            "for" => has("variable_name"),
            _ => false,
        }
    }

    fn match_blocks(&mut self) {
        let mut open = Vec::new();
        for k in 0..self.commands.len() {
            if self.begins_block(k) {
                open.push(k);
            } else if self.word(k) == "end" {
                match open.pop() {
                    Some(begin) => self.ends[begin] = Some(k),
                    None => {
                        let d = Diagnostic::error("view_syntax", "`end` ends nothing");
                        let d = d.help("if, for and while begin what `end` ends");
                        self.say(d, self.commands[k].span);
                    }
                }
            }
        }
        for begin in open {
            let what = format!("`{}` has no `end`", self.word(begin));
            self.say(
                Diagnostic::error("view_syntax", what),
                self.commands[begin].span,
            );
        }
    }

    fn block(&mut self, from: usize, to: usize) -> Flow {
        self.depth += 1;
        let mut at = from;
        let mut flow = Flow::Next;
        while at < to && flow == Flow::Next && self.depth < DEEPEST_BLOCK {
            self.obeyed += 1;
            if self.obeyed > MOST_COMMANDS {
                if self.obeyed == MOST_COMMANDS + 1 {
                    let what = format!("more than {MOST_COMMANDS} commands: a loop does not end");
                    self.say(
                        Diagnostic::error("view_syntax", what),
                        self.commands[at].span,
                    );
                }
                flow = Flow::Return;
                break;
            }
            if self.db.said.borrow().len() > MOST_MISTAKES {
                flow = Flow::Return;
                break;
            }
            let end = self.ends[at].filter(|end| *end < to);
            match (self.word(at).as_str(), end) {
                ("if", Some(end)) => {
                    flow = self.branch(at, end);
                    at = end;
                }
                ("while", Some(end)) => {
                    flow = self.repeat_while(at, end);
                    at = end;
                }
                ("for", Some(end)) => {
                    flow = self.repeat(at, end);
                    at = end;
                }
                ("break", _) => flow = Flow::Break,
                ("continue", _) => flow = Flow::Continue,
                ("return", _) => flow = Flow::Return,
                ("end" | "else" | "elseif", _) => {}
                _ => self.obey(at),
            }
            at += 1;
        }
        self.depth -= 1;
        flow
    }

    /// Returns the places of `elseif` and `else` of a branch itself, and its end.
    fn alternatives(&self, begin: usize, end: usize) -> Vec<usize> {
        let mut all = Vec::new();
        let mut at = begin + 1;
        while at < end {
            match (self.ends[at], self.word(at).as_str()) {
                (Some(inner), _) => at = inner,
                (None, "else" | "elseif") => all.push(at),
                _ => {}
            }
            at += 1;
        }
        all.push(end);
        all
    }

    fn branch(&mut self, begin: usize, end: usize) -> Flow {
        let mut from = begin;
        for next in self.alternatives(begin, end) {
            let holds = match self.word(from).as_str() {
                "else" => true,
                _ => self.condition(from),
            };
            if holds {
                return self.block(from + 1, next);
            }
            from = next;
        }
        Flow::Next
    }

    /// Returns whether the condition of a command holds; one without a value does not, which is
    /// told.
    fn condition(&self, k: usize) -> bool {
        let command = &self.commands[k];
        let Some(piece) = command.arguments.first().and_then(|a| a.values.first()) else {
            self.say(
                Diagnostic::error("view_syntax", "a condition is missing"),
                command.span,
            );
            return false;
        };
        let value = self.item(*piece).and_then(|item| {
            let value = self.db.evaluate(&item.term, &Reading::default());
            let value = value.and_then(|value| self.db.as_number(&value));
            value.map_err(|trouble| self.trouble(&trouble, piece.span))
        });
        match value {
            Ok(value) => value != 0.0,
            Err(d) => {
                self.db
                    .say(d.help("the commands of this branch are left out"));
                false
            }
        }
    }

    fn trouble(&self, trouble: &str, span: Span) -> Diagnostic {
        let d = Diagnostic::error("view_expression", trouble.to_owned());
        self.source.locate(d, span)
    }

    fn repeat_while(&mut self, begin: usize, end: usize) -> Flow {
        while self.condition(begin) {
            match self.block(begin + 1, end) {
                Flow::Break => break,
                Flow::Return => return Flow::Return,
                Flow::Next | Flow::Continue => {}
            }
            // an empty loop counts as well
            self.obeyed += 1;
            if self.obeyed > MOST_COMMANDS {
                return Flow::Return;
            }
        }
        Flow::Next
    }

    fn repeat(&mut self, begin: usize, end: usize) -> Flow {
        let (commands, source) = (self.commands, self.source);
        let command = &commands[begin];
        let of = |name: &str| {
            let mut all = command.arguments.iter();
            let argument = all.find(|a| begins(name, source.slice(a.name)));
            argument.and_then(|a| a.values.first()).copied()
        };
        let Some(variable) = of("variable_name") else {
            return Flow::Next;
        };
        let variable = self
            .slice(variable.span)
            .trim_matches('"')
            .to_ascii_lowercase();
        if of("start_value").is_none() {
            let what = "a loop over objects is not read";
            let d = Diagnostic::warning("view_left_out", what)
                .help("loops over numbers are, with start_value and end_value");
            self.say(d, command.span);
            return Flow::Next;
        }
        let number = |name: &str, default: f64| match of(name) {
            None => Ok(default),
            Some(piece) => self.number(piece),
        };
        let range = number("start_value", 1.0).and_then(|from| {
            let to = number("end_value", from)?;
            Ok((from, to, number("increment_value", 1.0)?))
        });
        let (from, to, step) = match range {
            Ok(range) if range.2 != 0.0 => range,
            Ok(_) => (1.0, 0.0, 1.0),
            Err(d) => {
                self.db.say(d);
                return Flow::Next;
            }
        };
        let before = self.db.loops.remove(&variable);
        let turns = ((to - from) / step + 1e-9).floor();
        let mut flow = Flow::Next;
        let mut k = 0.0;
        while k <= turns && self.obeyed <= MOST_COMMANDS {
            let value = Datum::Number(from + k * step);
            self.db.loops.insert(variable.clone(), value);
            flow = self.block(begin + 1, end);
            if matches!(flow, Flow::Break | Flow::Return) {
                break;
            }
            k += 1.0;
            self.obeyed += 1;
        }
        self.db.loops.remove(&variable);
        if let Some(before) = before {
            self.db.loops.insert(variable, before);
        }
        match flow {
            Flow::Return => Flow::Return,
            _ => Flow::Next,
        }
    }

    fn number(&self, piece: Piece) -> Result<f64, Diagnostic> {
        let item = self.item(piece)?;
        let value = self.db.evaluate(&item.term, &Reading::default());
        let value = value.and_then(|value| self.db.as_number(&value));
        value.map_err(|trouble| self.trouble(&trouble, piece.span))
    }

    /// Obeys one command.
    fn obey(&mut self, k: usize) {
        let commands = self.commands;
        let command = &commands[k];
        if command.words.is_empty() {
            if let Some(argument) = command.arguments.first() {
                let d = Diagnostic::error("view_syntax", "an argument stands without a command");
                let d = d.help(
                    "a command that goes on in the next line needs `&` at the end of this one",
                );
                self.say(d, argument.name);
            }
            return;
        }
        let words: Vec<&str> = command.words.iter().map(|w| self.slice(*w)).collect();
        if let [file, what, ..] = words[..]
            && file.eq_ignore_ascii_case("file")
            && what.to_ascii_lowercase().starts_with("par")
        {
            return self.import(command);
        }
        match commands::meaning(&words) {
            // groups and whatever else is switched off as one
            Meaning::Showing if self.switches(command) => self.note_unread(&words, command),
            Meaning::Showing => {}
            Meaning::Row(row, verb) => self.make(row, verb, command),
            Meaning::Objects(verb) => self.change_objects(verb, command, &words),
            Meaning::Unread => self.note_unread(&words, command),
            Meaning::Unknown(near) => {
                let what = format!("there is no command `{}`", words.join(" "));
                let d = Diagnostic::error("unknown_command", what);
                let d = match advice(&words.join(" ").to_lowercase()) {
                    Some(advice) => d.help(advice),
                    None if near.is_empty() => d,
                    None => d.help(format!("did you mean {}?", near.join(" or "))),
                };
                self.say(d, command.head());
            }
        }
    }

    /// Counts a command that is not read.
    fn note_unread(&mut self, words: &[&str], command: &Command) {
        let told = self.unread.entry(words.join(" ").to_lowercase());
        told.or_insert((0, command.head())).0 += 1;
    }

    /// Returns whether a command switches something on or off.
    fn switches(&self, command: &Command) -> bool {
        let mut names = command.arguments.iter().map(|a| self.slice(a.name));
        names.any(|name| name.to_ascii_lowercase().ends_with("active"))
    }

    /// Notes the file that solids are imported from.
    fn import(&mut self, command: &Command) {
        let mut all = command.arguments.iter();
        let file = all.find(|a| self.slice(a.name).to_ascii_lowercase().starts_with("fi"));
        let file = file.and_then(|a| a.values.first()).copied();
        self.db.solids_file = file.and_then(|value| self.name(value).ok());
    }

    /// Deletes objects, or makes them no part of the model.
    fn change_objects(&mut self, verb: &str, command: &Command, words: &[&str]) {
        if matches!(verb, "copy" | "rename") {
            return self.note_unread(words, command);
        }
        let argument = |name: &str| {
            let mut all = command.arguments.iter();
            all.find(|a| self.slice(a.name).eq_ignore_ascii_case(name))
        };
        let is_off = argument("active").and_then(|a| a.values.first());
        let is_off = is_off.map(|v| self.slice(v.span).eq_ignore_ascii_case("off"));
        let Some(named) = command.arguments.first() else {
            return;
        };
        let mut found = Vec::new();
        for value in &named.values {
            let name = self.name(*value).unwrap_or_default();
            match self.db.find(&name) {
                Some(k) => found.push(k),
                None if words[0].to_ascii_lowercase().starts_with("geo") => {
                    let full = self.db.full_name(&name, None);
                    self.db.imported.insert(full.to_ascii_lowercase());
                }
                None => {}
            }
        }
        for k in found {
            match verb {
                "delete" => self.db.delete(k),
                _ => {
                    let idle = is_off.unwrap_or(self.db.objects[k].is_idle);
                    self.db.objects[k].is_idle = idle;
                }
            }
        }
    }

    /// Makes or changes an object, or sets what holds by default.
    fn make(&mut self, row: &'static Row, verb: &str, command: &Command) {
        let mut given = Vec::new();
        for argument in &command.arguments {
            let typed = self.slice(argument.name);
            match commands::argument(row, typed) {
                Ok(name) => given.push((name, argument)),
                Err(near) => self.unknown_argument(row, argument, &near),
            }
        }
        match row.words[0] {
            "defaults" => self.set_defaults(row, &given),
            "simulation" if row.kind.starts_with("simulation single_run") => {
                self.simulate(row, &given, command);
            }
            "file" => {
                let what = "the commands of another file are not read";
                let d = Diagnostic::warning("view_left_out", what)
                    .help("put them into this file, or join both to one");
                self.say(d, command.head());
            }
            _ => self.make_object(row, verb, &given, command),
        }
    }

    fn unknown_argument(&self, row: &Row, argument: &Argument, near: &[&str]) {
        let typed = self.slice(argument.name);
        let words = row.words.join(" ");
        let what = format!("`{words}` has no argument `{typed}`");
        let d = match near.is_empty() {
            true => Diagnostic::warning("view_left_out", what + "; it is left out"),
            false => {
                let help = format!("did you mean {}?", near.join(" or "));
                Diagnostic::error("unknown_argument", what).help(help)
            }
        };
        self.say(d, argument.name);
    }

    fn set_defaults(&mut self, row: &Row, given: &[(&'static str, &Argument)]) {
        for (name, argument) in given {
            let Some(value) = argument.values.first().copied() else {
                continue;
            };
            let text = self.name(value).unwrap_or_default();
            match (row.kind.as_str(), *name) {
                ("defaults coordinate_system", _) => {
                    let found = self.db.find(&text).map(|k| self.db.objects[k].name.clone());
                    self.db.frame = Some(found.unwrap_or(text));
                }
                ("defaults model", "part_name") => {
                    let found = self.db.find(&text).map(|k| self.db.objects[k].name.clone());
                    self.db.part = found.or(self.db.part.take());
                }
                ("defaults units", "orientation_type") => match sequence(&text) {
                    Some(sequence) => self.db.sequence = sequence,
                    None => self.refuse_word(&text, "an orientation_type", value.span),
                },
                ("defaults units", "coordinate_system_type") => {
                    let known = [
                        ("cartesian", Coordinates::Cartesian),
                        ("cylindrical", Coordinates::Cylindrical),
                        ("spherical", Coordinates::Spherical),
                    ];
                    let lower = text.to_ascii_lowercase();
                    match known.iter().find(|(word, _)| word.starts_with(&lower)) {
                        Some((_, kind)) => self.db.coordinates = *kind,
                        None => self.refuse_word(&text, "a coordinate_system_type", value.span),
                    }
                }
                ("defaults units", kind @ ("length" | "mass" | "force" | "time" | "angle"))
                    if !self.db.units.set(kind, &text) =>
                {
                    self.refuse_word(&text, &format!("a unit of {kind}"), value.span);
                }
                _ => {}
            }
        }
    }

    fn refuse_word(&self, word: &str, what: &str, span: Span) {
        let what = format!("`{word}` is not {what}");
        self.say(Diagnostic::error("view_syntax", what), span);
    }

    fn simulate(
        &mut self,
        row: &'static Row,
        given: &[(&'static str, &Argument)],
        command: &Command,
    ) {
        let mut arguments = Vec::new();
        for (name, argument) in given {
            let texts = argument.values.iter().map(|value| match value.form {
                Form::Group => self.number(*value).map(|number| number.to_string()),
                _ => Ok(self.slice(value.span).trim_matches('"').to_owned()),
            });
            match texts.collect::<Result<Vec<String>, Diagnostic>>() {
                Ok(texts) => arguments.push((*name, texts.join(","))),
                Err(d) => self.db.say(d),
            }
        }
        self.simulations.push(Simulation {
            kind: row.kind.as_str(),
            arguments,
            span: command.span,
        });
    }

    /// Returns the name or word that a value is.
    pub(super) fn name(&self, piece: Piece) -> Result<String, Diagnostic> {
        let text = self.slice(piece.span);
        match piece.form {
            Form::Bare => Ok(text.to_owned()),
            Form::Quoted => Ok(term::unquoted(text)),
            Form::Group => {
                let item = self.item(piece)?;
                let value = self.db.evaluate(&item.term, &Reading::default());
                let value = value.and_then(|value| self.db.as_text(&value));
                value.map_err(|trouble| self.trouble(&trouble, piece.span))
            }
        }
    }

    /// Returns a value as an expression, in which what is fixed now is fixed.
    pub(super) fn item(&self, piece: Piece) -> Result<Item, Diagnostic> {
        let text = self.slice(piece.span);
        let span = piece.span;
        let is_bare = piece.form == Form::Bare;
        let term = match piece.form {
            Form::Quoted => Term::Text(term::unquoted(text)),
            // a number, maybe with its unit; else a word
            Form::Bare => match term::parse(text) {
                Ok(term @ (Term::Number(_) | Term::InUnit(..) | Term::Negative(_))) => term,
                _ => Term::Name(text.to_owned()),
            },
            Form::Group => term::parse(text).map_err(|d| {
                let inner = d.span.unwrap_or_default();
                let from = span.start + inner.start;
                self.source
                    .locate(d, Span::new(from, span.start + inner.end))
            })?,
        };
        let settled = self.db.settled(&Rc::new(term), &Reading::default());
        let term = settled.map_err(|trouble| self.trouble(&trouble, span))?;
        Ok(Item {
            term,
            span,
            is_bare,
        })
    }
}

/// Returns whether a word of a file is the beginning of another, in either case.
fn begins(word: &str, typed: &str) -> bool {
    let start = word.as_bytes().get(..typed.len());
    start.is_some_and(|start| start.eq_ignore_ascii_case(typed.as_bytes()))
}

/// Returns the sequence of angles of `body313`, `space123`.
fn sequence(word: &str) -> Option<Sequence> {
    let lower = word.to_ascii_lowercase();
    let (is_body, digits) = match lower.strip_prefix("body") {
        Some(digits) => (true, digits),
        None => (false, lower.strip_prefix("space")?),
    };
    let axes: Vec<usize> = digits.chars().filter_map(|c| "123".find(c)).collect();
    let axes = <[usize; 3]>::try_from(axes).ok()?;
    Some(Sequence { axes, is_body })
}

/// Returns what to write instead of a command that there is not.
fn advice(words: &str) -> Option<&'static str> {
    const KNOWN: &[(&str, &str)] = &[
        ("motion", "a motion is `constraint create motion_generator`"),
        ("gravity", "gravity is `force create body gravitational`"),
        ("joint", "a joint is `constraint create joint revolute`"),
        ("spline", "a spline is `data_element create spline`"),
        ("request", "a request is `output_control create request`"),
        ("sensor", "a sensor is `executive_control create sensor`"),
        ("end", "`end` alone ends a loop or a branch"),
    ];
    let first = words.split(' ').next()?;
    KNOWN
        .iter()
        .find(|(word, _)| *word == first)
        .map(|(_, advice)| *advice)
}
