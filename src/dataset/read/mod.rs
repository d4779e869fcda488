//! From the tokens of a statement to a record: which row, which number, which arguments.
//!
//! The row says what each argument takes; this file knows how each kind of value is written. A
//! mistake in one argument is reported with its place and the reading goes on at the next, so that
//! all mistakes of a file are found at once.

mod formula;
mod tokens;
mod values;

use super::row::{Argument, Given, Meaning, Record, Statement, canonical, element_name, meaning};
use super::syntax::{Source, Token, TokenKind, Tokens};
use super::value::{Kind, Number, Value};
use crate::diagnostic::{Cause, Diagnostic, Severity, Span, near_names};
use crate::model::{Break, Formula, Place};
use std::borrow::Cow;

/// A table of statements to read with.
#[derive(Clone, Copy)]
pub struct Table {
    /// the rows
    pub rows: &'static [&'static dyn Statement],
    /// what a keyword means among them
    pub find: fn(&str) -> Meaning,
}

/// Reads one statement; `None` when its head cannot be understood.
pub fn record(
    source: &Source,
    tokens: &Tokens,
    table: Table,
    out: &mut Vec<Diagnostic>,
) -> Option<Record> {
    let before = out.len();
    let is_spoken = |t: &&Token| !matches!(t.kind, TokenKind::Comment | TokenKind::Carry);
    let spoken = match tokens.tokens.iter().all(|t| is_spoken(&t)) {
        true => Cow::Borrowed(&tokens.tokens[..]),
        false => tokens.tokens.iter().filter(is_spoken).copied().collect(),
    };
    let mut reader = Reader {
        source,
        tokens: spoken,
        at: 0,
        row: None,
        id: None,
        out,
    };
    let mut record = reader.statement(tokens, table)?;
    record.mistaken = out[before..].iter().any(|d| d.severity == Severity::Error);
    Some(record)
}

/// Returns the element that a statement seems to make whose head cannot be understood, without its
/// arguments: what names it is right.
pub(crate) fn meant(source: &Source, tokens: &Tokens, table: Table) -> Option<Record> {
    let spoken = |t: &&Token| !matches!(t.kind, TokenKind::Comment | TokenKind::Carry);
    let mut words = tokens.tokens.iter().filter(spoken);
    let head = words.next()?;
    let text = |t: &Token| source.slice(t.span);
    let row = match (table.find)(text(head)) {
        Meaning::One(k) => table.rows[k],
        Meaning::Several(_) => return None,
        Meaning::Unknown => {
            let known: Vec<String> = table.rows.iter().map(|r| canonical(r.keyword())).collect();
            let near = near_names(text(head), known.iter().map(String::as_str));
            let k = known
                .iter()
                .position(|k| near.first().is_some_and(|n| n == k))?;
            table.rows[k]
        }
    };
    let number = words.find(|t| t.kind == TokenKind::Atom)?;
    let id = text(number).parse().ok().filter(|_| row.numbered())?;
    Some(Record {
        row,
        id: Some(id),
        given: Vec::new(),
        kept: Vec::new(),
        place: Place::default(),
        head: head.span,
        mistaken: true,
    })
}

struct Reader<'a> {
    source: &'a Source,
    /// comments left out
    tokens: Cow<'a, [Token]>,
    at: usize,
    /// the row, once it is known, and then the number
    row: Option<&'static dyn Statement>,
    id: Option<u32>,
    out: &'a mut Vec<Diagnostic>,
}

/// A mistake already reported; the argument is given up.
struct Reported;

impl<'a> Reader<'a> {
    fn statement(&mut self, tokens: &Tokens, table: Table) -> Option<Record> {
        let head = *self.tokens.first()?;
        let word = self.text(head);
        let row = match (head.kind, (table.find)(word)) {
            (TokenKind::Atom, Meaning::One(k)) => table.rows[k],
            (TokenKind::Atom, Meaning::Several(of)) => {
                let names: Vec<String> = of
                    .iter()
                    .map(|&k| canonical(table.rows[k].keyword()))
                    .collect();
                self.error(
                    "ambiguous_statement",
                    head.span,
                    format!("{word} may be {}", names.join(" or ")),
                );
                return None;
            }
            _ => {
                self.unknown_statement(head, table);
                return None;
            }
        };
        self.at = 1;
        self.row = Some(row);
        let slash = self.take(TokenKind::Slash).is_some();
        let id = self.identifier(row, head, slash)?;
        self.id = id;
        let head = Span::new(head.span.start, self.tokens[self.at - 1].span.end);
        let mut record = Record {
            row,
            id,
            given: Vec::with_capacity(self.n_arguments()),
            kept: Vec::new(),
            place: Place {
                line: self.source.place(head.start).0,
                name: tokens.name.clone(),
                extra: Vec::new(),
            },
            head,
            mistaken: false,
        };
        while self.next_argument() {
            if self.argument(&mut record).is_err() {
                self.recover();
            }
        }
        self.exclusions(&record);
        Some(record)
    }

    /// Number of arguments, at most: words that follow a separator.
    fn n_arguments(&self) -> usize {
        let begins = |pair: &&[Token]| {
            pair[0].kind.separates() && pair[1].kind == TokenKind::Atom && !self.numeric(pair[1])
        };
        self.tokens.windows(2).filter(begins).count()
    }

    /// The arguments of the row, once it is known.
    fn arguments(&self) -> impl Iterator<Item = &'static Argument> + Clone + use<> {
        let row = self.row;
        (0..).map_while(move |k| row?.argument(k))
    }

    /// Which argument a word means.
    fn argument_meant(&self, word: &str) -> Meaning {
        meaning(word, self.arguments().map(|a| a.name))
    }

    /// An argument of a record.
    fn argument_of(record: &Record, k: usize) -> &'static Argument {
        let argument = record.row.argument(k);
        argument.unwrap_or_else(|| unreachable!("the place was found among the arguments"))
    }

    /// Says which statement a finding is about, once its row is known.
    fn about(&self, d: Diagnostic) -> Diagnostic {
        match self.row {
            Some(row) => d.element(element_name(&canonical(row.keyword()), self.id)),
            None => d,
        }
    }

    fn unknown_statement(&mut self, head: Token, table: Table) {
        let word = self.text(head);
        let known: Vec<String> = table.rows.iter().map(|r| canonical(r.keyword())).collect();
        let near = near_names(word, known.iter().map(String::as_str));
        let mut d = Diagnostic::error("unknown_statement", format!("`{word}` is not a statement"));
        if head.kind == TokenKind::Comma {
            d = d.help(
                "a line that begins with a comma continues a statement, but none stands before it",
            );
        } else if !near.is_empty() {
            d = d.help(format!("did you mean {}?", near.join(" or ")));
        } else if self.argument_like() {
            d = d.help("a line that continues a statement begins with a comma");
        }
        let d = self.source.locate(d, head.span);
        self.out.push(d);
    }

    /// Returns true if the statement looks like an argument whose leading comma was forgotten.
    fn argument_like(&self) -> bool {
        self.tokens
            .get(1)
            .is_some_and(|t| t.kind == TokenKind::Equals)
    }

    /// The number after the slash; `None` outside when it is missing where there must be one.
    fn identifier(&mut self, row: &dyn Statement, head: Token, slash: bool) -> Option<Option<u32>> {
        let keyword = || canonical(row.keyword());
        let token = self.tokens.get(self.at).copied();
        let digits = token.filter(|t| slash && t.kind == TokenKind::Atom && self.numeric(*t));
        let Some(token) = digits else {
            if row.numbered() {
                self.error(
                    "missing_identifier",
                    head.span,
                    format!("{0} needs a number: {0}/id", keyword()),
                );
                return None;
            }
            return Some(None);
        };
        self.at += 1;
        if !row.numbered() {
            self.error(
                "unexpected_identifier",
                token.span,
                format!("{} takes no number", keyword()),
            );
            return Some(None);
        }
        match self.text(token).parse::<u32>() {
            Ok(id) if (1..=i32::MAX as u32).contains(&id) => Some(Some(id)),
            _ => {
                let message = format!("`{}` is not a number an element can have", self.text(token));
                self.error("not_an_identifier", token.span, message);
                None
            }
        }
    }

    /// Goes to the next argument; false at the end.
    fn next_argument(&mut self) -> bool {
        while let Some(t) = self.tokens.get(self.at) {
            // A slash may end an expression; it means nothing else between arguments.
            if !t.kind.separates() && t.kind != TokenKind::Slash {
                return true;
            }
            self.at += 1;
        }
        false
    }

    fn argument(&mut self, record: &mut Record) -> Result<(), Reported> {
        let name = self.tokens[self.at];
        let start = name.span.start;
        let word = self.text(name);
        if name.kind != TokenKind::Atom {
            let message = format!("`{word}` is not an argument");
            return self.fail("unexpected_text", name.span, message);
        }
        self.at += 1;
        let kind_at = |k: usize| self.tokens.get(k).map(|t| t.kind);
        if kind_at(self.at) == Some(TokenKind::Continuation)
            && kind_at(self.at + 1) == Some(TokenKind::Equals)
        {
            self.at += 1;
        }
        let equals = self.take(TokenKind::Equals).is_some();
        // The value may begin on the next line, whose comma then only continues.
        while equals && self.take(TokenKind::Continuation).is_some() {}
        let argument = match self.argument_meant(word) {
            Meaning::One(k) => k,
            Meaning::Several(of) => {
                let keyword = |&k: &usize| Self::argument_of(record, k).keyword();
                let names: Vec<String> = of.iter().map(keyword).collect();
                let message = format!("{word} may be {}", names.join(" or "));
                return self.fail("ambiguous_argument", name.span, message);
            }
            Meaning::Unknown if record.row.open() || self.source.is_of_recurdyn() => {
                let text = if equals {
                    self.raw(true)?
                } else {
                    String::new()
                };
                record.kept.push((word.to_ascii_uppercase(), text));
                return self.separated();
            }
            Meaning::Unknown => return self.unknown_argument(name),
        };
        let meant = Self::argument_of(record, argument);
        let (kind, first) = (meant.kind, self.at);
        let value = match (kind, equals) {
            (Kind::Flag, false) => Value::Flag,
            (Kind::Flag, true) => {
                let message = format!("{} stands alone, without a value", meant.keyword());
                return self.fail("unexpected_value", name.span, message);
            }
            (_, false) => {
                let message = format!("{} needs a value: {}", meant.keyword(), kind.describe());
                return self.fail(Cause::MissingValue.code(), name.span, message);
            }
            (_, true) => self.value(kind, name)?,
        };
        let span = Span::new(start, self.tokens[self.at - 1].span.end);
        if let Err(message) = meant.admits(&value) {
            return self.fail("unfit_value", self.between(first, self.at), message);
        }
        let given = Given {
            argument,
            value,
            span,
        };
        if !meant.repeated && record.given.iter().any(|g| g.argument == argument) {
            let message = format!("{} is given twice", meant.keyword());
            self.error("given_twice", name.span, message);
        } else {
            record.given.push(given);
        }
        self.separated()
    }

    fn unknown_argument(&mut self, name: Token) -> Result<(), Reported> {
        let word = self.text(name);
        let known: Vec<String> = self.arguments().map(Argument::keyword).collect();
        let near = near_names(word, known.iter().map(String::as_str));
        let keyword = self.row.map(|row| canonical(row.keyword()));
        let keyword = keyword.unwrap_or_default();
        let mut d = Diagnostic::error(
            "unknown_argument",
            format!("{keyword} has no argument {word}"),
        );
        if !near.is_empty() {
            d = d.help(format!("did you mean {}?", near.join(" or ")));
        }
        if let Some(number) = self.cut_by_comma(name) {
            d = d.help(format!("a decimal mark is a point: {number}"));
        }
        d = if known.is_empty() {
            d.help(format!("{keyword} takes no arguments"))
        } else {
            d.help(format!("{keyword} has {}", known.join(", ")))
        };
        let d = self.source.locate(self.about(d), name.span);
        self.out.push(d);
        Err(Reported)
    }

    /// Returns the number that was meant where digits follow a comma behind a whole number: `2.5`
    /// of `2,5`.
    fn cut_by_comma(&self, after: Token) -> Option<String> {
        let text = &self.source.text;
        let digits = |t: &str| !t.is_empty() && t.bytes().all(|b| b.is_ascii_digit());
        let before = text.get(..after.span.start)?.strip_suffix(',')?;
        let from = before.trim_end_matches(|c: char| c.is_ascii_digit()).len();
        let whole = &before[from..];
        let is_value = before[..from].ends_with(['=', '-', '+', '(', '*', '/', ' ']);
        let word = self.text(after);
        let behind = word.trim_start_matches(|c: char| c.is_ascii_digit());
        let part = &word[..word.len() - behind.len()];
        (digits(whole) && digits(part) && is_value).then(|| format!("{whole}.{part}"))
    }

    /// Bare keywords of which only one may be given.
    fn exclusions(&mut self, record: &Record) {
        let argument = |g: &Given| Self::argument_of(record, g.argument);
        for (k, g) in record.given.iter().enumerate() {
            let Some(group) = argument(g).group else {
                continue;
            };
            let mut before = record.given[..k].iter();
            if let Some(rival) = before.find(|r| argument(r).group == Some(group)) {
                let [first, second] = [rival, g].map(|x| argument(x).keyword());
                let message = format!("{first} and {second} are both given as the {group}");
                self.error("excluded_argument", g.span, message);
            }
        }
    }
}
