//! Statements back to text, the way Adams View writes them: one argument per line, at most eighty
//! columns.
//!
//! [`Dataset::formatted`] keeps comments, order and suffixes of a file; [`Model::to_text`] writes a
//! model that may never have been a file. Both print records of the table, so what is read is what
//! is written. Numbers are the shortest that read back to the same value.

use super::Dataset;
use super::row::{Given, Record};
use super::statement::STATEMENTS;
use super::syntax::{Item, Source, Token, TokenKind, Tokens};
use super::value::Value;
use crate::diagnostic::Span;
use crate::model::{ElementId, ElementKind, MarkerOwner, Model};
use std::collections::BTreeMap;

/// Columns that Adams View fills.
const WIDTH: usize = 80;

impl Dataset {
    /// The text as it was read, to the byte, without that of files that it includes.
    pub fn to_text(&self) -> &str {
        self.source.own_text()
    }

    /// The text in the style of Adams View; comments, order and title stay.
    ///
    /// Statements in which the reader found a mistake are kept as they stand.
    pub fn formatted(&self) -> String {
        let source = &self.source;
        let mut out = Lines::default();
        out.push(source.slice(self.syntax.title));
        let mut last = self.syntax.title.end;
        for (item, record) in self.syntax.items.iter().zip(&self.records) {
            let record = record.as_ref().filter(|r| !r.mistaken);
            let span = item.span();
            let gap = source.slice(Span::new(last, span.start));
            let new_lines = gap.matches('\n').count().max(gap.matches('\r').count());
            if new_lines > 1 {
                out.push("");
            }
            match (item, record) {
                (Item::Comment(_), _) if new_lines == 0 && last > 0 => {
                    out.append(source.slice(span))
                }
                (Item::Comment(_), _) => out.push(source.slice(span).trim_end()),
                (Item::Statement(tokens), Some(record)) => {
                    write_record(&mut out, record, &comments(source, tokens))
                }
                (Item::Statement(_), None) => out.push(source.slice(span)),
            }
            last = span.end;
        }
        if self.syntax.end.is_some() {
            out.push("END");
            let rest = source.slice(self.syntax.after).trim_end();
            let mut rest = rest.lines();
            if let Some(first) = rest.next().filter(|l| !l.trim().is_empty()) {
                out.append(first.trim_start());
            }
            rest.for_each(|line| out.push(line));
        }
        out.text(if source.text.contains("\r\n") {
            "\r\n"
        } else {
            "\n"
        })
    }
}

impl Model {
    /// The model as a dataset, in the style of Adams View.
    ///
    /// # Examples
    /// ```
    /// use cognate::model::{Model, Part};
    /// let mut model = Model { title: "one part".into(), ..Model::default() };
    /// model.parts.insert(1, Part { ground: true, ..Part::default() });
    /// assert_eq!(model.to_text(), "one part\n!\nPART/1\n, GROUND\n!\nEND\n");
    /// ```
    pub fn to_text(&self) -> String {
        let mut out = Lines::default();
        out.push(self.title.lines().next().unwrap_or_default());
        const MARKER: Option<ElementKind> = Some(ElementKind::Marker);
        let rows = STATEMENTS.iter().filter(|r| r.kind() == MARKER);
        let markers: Vec<Record> = rows.flat_map(|r| r.records(self)).collect();
        let owner = |r: &Record| r.id.and_then(|id| self.markers.get(&id)).map(|m| m.owner);
        let mut of_body: BTreeMap<ElementId, Vec<&Record>> = BTreeMap::new();
        for marker in &markers {
            if let Some(body) = owner(marker).and_then(MarkerOwner::body) {
                of_body.entry(body).or_default().push(marker);
            }
        }
        for row in STATEMENTS.iter().filter(|r| r.kind() != MARKER) {
            for record in row.records(self) {
                write_named(&mut out, &record);
                let body = match (row.kind(), record.id) {
                    (Some(kind @ (ElementKind::Part | ElementKind::PointMass)), Some(id)) => {
                        kind.id(id)
                    }
                    _ => continue,
                };
                let own = of_body.get(&body).into_iter().flatten();
                own.for_each(|marker| write_named(&mut out, marker));
            }
            if row.kind() == Some(ElementKind::PointMass) {
                // The rest: markers of bodies that are not solved, or of parts that do not exist.
                let homeless = |m: &&Record| match owner(m) {
                    Some(MarkerOwner::Part(n)) => !self.parts.contains_key(&n),
                    Some(MarkerOwner::PointMass(n)) => !self.point_masses.contains_key(&n),
                    _ => true,
                };
                markers
                    .iter()
                    .filter(homeless)
                    .for_each(|m| write_named(&mut out, m));
            }
        }
        for (&id, values) in &self.beginnings {
            let mut line = format!("! cognate: IC {id}");
            for (&quantity, value) in values {
                let name = self.initial_quantity_name(id, quantity);
                line += &format!(", {name}={value:?}");
            }
            out.push(&line);
        }
        for (name, parts) in &self.rigid_bodies {
            let parts = parts.iter().map(|&n| ElementKind::Part.id(n).to_string());
            let parts: Vec<String> = parts.collect();
            out.push(&format!("! cognate: RIGID {name} = {}", parts.join(", ")));
        }
        out.push("!");
        out.push("END");
        out.text("\n")
    }
}

impl Model {
    /// Returns the statement of each element, as [`Model::to_text`] writes it, without its name.
    pub fn statements(&self) -> Vec<(ElementId, String)> {
        let mut all = Vec::new();
        for row in STATEMENTS {
            let Some(kind) = row.kind() else {
                continue;
            };
            for record in row.records(self) {
                let mut lines = Lines::default();
                write_record(&mut lines, &record, &[]);
                all.extend(record.id.map(|id| (kind.id(id), lines.text("\n"))));
            }
        }
        all
    }
}

/// A statement under a comment with its name, centred as Adams View does.
fn write_named(out: &mut Lines, record: &Record) {
    out.push("!");
    if let Some(name) = &record.place.name {
        let key = format!("adams_view_name='{name}'");
        let blanks = WIDTH.saturating_sub(key.chars().count()) / 2;
        out.push(&format!("!{}{key}", " ".repeat(blanks)));
    }
    write_record(out, record, &[]);
}

/// Lines being written, each with its end.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn push(&mut self, line: &str) {
        self.0.push_str(line);
        self.0.push('\n');
    }
    /// Adds to the end of the last line, after a blank.
    fn append(&mut self, text: &str) {
        if self.0.pop().is_some() {
            self.0.push(' ');
        }
        self.push(text.trim_end());
    }
    /// Returns the text with these ends of lines.
    fn text(self, end: &str) -> String {
        match end {
            "\n" => self.0,
            _ => self.0.replace('\n', end),
        }
    }
}

/// A comment inside a statement.
struct Inside<'a> {
    /// where it begins
    at: usize,
    text: &'a str,
    /// whether it stands after something on its line
    trailing: bool,
}

fn comments<'a>(source: &'a Source, tokens: &Tokens) -> Vec<Inside<'a>> {
    let inside = |(k, t): (usize, &Token)| {
        let before = k.checked_sub(1).and_then(|p| tokens.tokens.get(p));
        let gap = before.map(|b| source.slice(Span::new(b.span.end, t.span.start)));
        Inside {
            at: t.span.start,
            text: source.slice(t.span).trim_end(),
            trailing: gap.is_some_and(|g| !g.contains(['\n', '\r'])),
        }
    };
    let all = tokens.tokens.iter().enumerate();
    all.filter(|(_, t)| t.kind == TokenKind::Comment)
        .map(inside)
        .collect()
}

/// The lines of one statement, comments after the argument they follow.
fn write_record(out: &mut Lines, record: &Record, comments: &[Inside]) {
    let slash = record.id.is_none();
    out.push(&format!(
        "{}{}",
        record.element(),
        if slash { "/" } else { "" }
    ));
    let mut comments = comments.iter().peekable();
    let arguments = record.row.arguments();
    let ends = record.given.iter().skip(1).map(|g| g.span.start);
    let ends: Vec<usize> = ends.chain([usize::MAX]).collect();
    let first = record.given.first().map_or(usize::MAX, |g| g.span.start);
    let mut put_comments = |out: &mut Lines, before: usize| {
        while let Some(c) = comments.next_if(|c| c.at < before) {
            if c.trailing {
                out.append(c.text);
            } else {
                out.push(c.text);
            }
        }
    };
    put_comments(out, first);
    let count = record.given.len() + record.kept.len();
    for (k, (g, &end)) in record.given.iter().zip(&ends).enumerate() {
        write_argument(out, &arguments[g.argument].keyword(), g, k + 1 < count);
        put_comments(out, end);
    }
    for (keyword, text) in &record.kept {
        match text.is_empty() {
            true => out.push(&format!(", {keyword}")),
            false => write_list(out, &format!(", {keyword} = "), text.split(", ")),
        }
    }
}

/// One argument; `more` when another follows.
fn write_argument(out: &mut Lines, keyword: &str, given: &Given, more: bool) {
    let head = format!(", {keyword} = ");
    match &given.value {
        Value::Flag => out.push(&format!(", {keyword}")),
        Value::Ids(all) => write_list(out, &head, all.iter().map(u32::to_string)),
        Value::Reals(all) => write_list(out, &head, all.iter().map(ToString::to_string)),
        Value::Texts(all) => write_list(out, &head, all.iter().map(|t| format!("\"{t}\""))),
        Value::Raw(text) | Value::Text(text) => write_list(out, &head, text.split(", ")),
        Value::Formula(_) => write_formula(out, &head, &given.value.to_string(), more),
        Value::Id(_) | Value::Real(_) | Value::Word(_) | Value::Words(_) => {
            out.push(&format!("{head}{}", given.value));
        }
    }
}

/// Values with commas between them; a line that is full ends before a comma.
fn write_list<T: AsRef<str>>(out: &mut Lines, head: &str, items: impl Iterator<Item = T>) {
    let mut line = head.to_owned();
    for (k, item) in items.enumerate() {
        let item = item.as_ref();
        if k > 0 && line.chars().count() + 2 + item.chars().count() > WIDTH {
            out.push(&line);
            line = format!(", {item}");
        } else {
            line.push_str(if k > 0 { ", " } else { "" });
            line.push_str(item);
        }
    }
    out.push(&line);
}

/// An expression, broken where blanks do not matter.
fn write_formula(out: &mut Lines, head: &str, text: &str, more: bool) {
    let mut rest = text;
    let mut head = head;
    loop {
        // One column is left for the backslash.
        let room = WIDTH - 1 - head.chars().count().min(WIDTH / 2);
        let Some(at) = break_at(rest, room) else {
            out.push(&format!("{head}{rest}{}", if more { "\\" } else { "" }));
            return;
        };
        let (line, after) = rest.split_at(at);
        out.push(&format!("{head}{}", line.trim_end()));
        (rest, head) = (after.trim_start(), ", ");
    }
}

/// Where to break an expression that does not fit into `room` columns: at a blank, else after a
/// mark; `None` when it fits or cannot be broken.
fn break_at(text: &str, room: usize) -> Option<usize> {
    if text.chars().count() <= room {
        return None;
    }
    let bytes = text.as_bytes();
    let mut blank = None;
    let mut mark = None;
    for (column, (at, c)) in text.char_indices().enumerate() {
        if column > room && (blank.is_some() || mark.is_some()) {
            break;
        }
        if at == 0 || text[at..].trim_start().is_empty() {
            continue;
        }
        if c == ' ' && column <= room {
            blank = Some(at);
        } else if c == ' ' || after_mark(bytes, at) {
            mark = Some(at);
        }
    }
    blank.or(mark)
}

/// Returns true if the byte before `at` ends something after which blanks do not matter: `,`, `(`,
/// an operator that is not the sign of an exponent, nor half of `**`, nor a division (which at the
/// end of a line looks like the end of the function).
fn after_mark(bytes: &[u8], at: usize) -> bool {
    let before = |k: usize| {
        at.checked_sub(k)
            .and_then(|k| bytes.get(k))
            .copied()
            .unwrap_or(b' ')
    };
    match before(1) {
        b',' | b'(' | b':' => true,
        b'*' => bytes.get(at) != Some(&b'*'),
        b'+' | b'-' => {
            let exponent = before(2).eq_ignore_ascii_case(&b'e')
                && (before(3).is_ascii_digit() || before(3) == b'.');
            !exponent
        }
        _ => false,
    }
}
