//! From the tokens of a statement to a record: which row, which number, which arguments.
//!
//! The row says what each argument takes; this file knows how each kind of value is written. A mistake in one argument
//! is reported with its place and the reading goes on at the next, so that all mistakes of a file are found at once.

use super::row::{Argument, Given, Meaning, Record, Statement, canonical, meaning};
use super::syntax::{Source, Token, TokenKind, Tokens};
use super::value::{Kind, Number, Value};
use crate::diagnostic::{Diagnostic, Severity, Span, near_names};
use crate::model::{Break, Formula, Place};

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
    let silent = |t: &&Token| !matches!(t.kind, TokenKind::Comment | TokenKind::Carry);
    let mut reader = Reader {
        source,
        tokens: tokens.tokens.iter().filter(silent).copied().collect(),
        at: 0,
        element: String::new(),
        arguments: Vec::new(),
        out,
    };
    let mut record = reader.statement(tokens, table)?;
    record.mistaken = out[before..].iter().any(|d| d.severity == Severity::Error);
    Some(record)
}

struct Reader<'a> {
    source: &'a Source,
    tokens: Vec<Token>,
    at: usize,
    element: String,
    arguments: Vec<Argument>,
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
        let keyword = canonical(row.keyword());
        self.element = keyword.clone();
        let slash = self.take(TokenKind::Slash).is_some();
        let id = self.identifier(row, &keyword, head, slash)?;
        if let Some(id) = id {
            self.element = format!("{keyword}/{id}");
        }
        let head = Span::new(head.span.start, self.tokens[self.at - 1].span.end);
        self.arguments = row.arguments();
        let mut record = Record {
            row,
            id,
            given: Vec::new(),
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

    /// Whether the statement looks like an argument whose leading comma was forgotten.
    fn argument_like(&self) -> bool {
        self.tokens
            .get(1)
            .is_some_and(|t| t.kind == TokenKind::Equals)
    }

    /// The number after the slash; `None` outside when it is missing where there must be one.
    fn identifier(
        &mut self,
        row: &dyn Statement,
        keyword: &str,
        head: Token,
        slash: bool,
    ) -> Option<Option<u32>> {
        let token = self.tokens.get(self.at).copied();
        let digits = token.filter(|t| slash && t.kind == TokenKind::Atom && self.numeric(*t));
        let Some(token) = digits else {
            if row.numbered() {
                self.error(
                    "missing_identifier",
                    head.span,
                    format!("{keyword} needs a number: {keyword}/id"),
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
                format!("{keyword} takes no number"),
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
            let separator = matches!(
                t.kind,
                TokenKind::Comma | TokenKind::Continuation | TokenKind::Backslash
            );
            // A slash may end an expression; it means nothing else between arguments.
            if !separator && t.kind != TokenKind::Slash {
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
        let argument = match meaning(word, self.arguments.iter().map(|a| a.name)) {
            Meaning::One(k) => k,
            Meaning::Several(of) => {
                let names: Vec<String> = of.iter().map(|&k| self.arguments[k].keyword()).collect();
                let message = format!("{word} may be {}", names.join(" or "));
                return self.fail("ambiguous_argument", name.span, message);
            }
            Meaning::Unknown if record.row.open() => {
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
        let Argument { kind, repeated, .. } = self.arguments[argument];
        let value = match (kind, equals) {
            (Kind::Flag, false) => Value::Flag,
            (Kind::Flag, true) => {
                let message = format!(
                    "{} stands alone, without a value",
                    self.arguments[argument].keyword()
                );
                return self.fail("unexpected_value", name.span, message);
            }
            (_, false) => {
                let message = format!(
                    "{} needs = {}",
                    self.arguments[argument].keyword(),
                    kind.describe()
                );
                return self.fail("missing_value", name.span, message);
            }
            (_, true) => self.value(kind, name)?,
        };
        let span = Span::new(start, self.tokens[self.at - 1].span.end);
        let given = Given {
            argument,
            value,
            span,
        };
        if !repeated && record.given.iter().any(|g| g.argument == argument) {
            let message = format!("{} is given twice", self.arguments[argument].keyword());
            self.error("given_twice", name.span, message);
        } else {
            record.given.push(given);
        }
        self.separated()
    }

    fn unknown_argument(&mut self, name: Token) -> Result<(), Reported> {
        let word = self.text(name);
        let known: Vec<String> = self.arguments.iter().map(Argument::keyword).collect();
        let near = near_names(word, known.iter().map(String::as_str));
        let keyword = self.element.split('/').next().unwrap_or_default();
        let mut d = Diagnostic::error(
            "unknown_argument",
            format!("{keyword} has no argument {word}"),
        );
        d = match near.is_empty() {
            false => d.help(format!("did you mean {}?", near.join(" or "))),
            true if known.is_empty() => d.help(format!("{keyword} takes no arguments")),
            true => d.help(format!("it has {}", known.join(", "))),
        };
        let d = self
            .source
            .locate(d.element(self.element.clone()), name.span);
        self.out.push(d);
        Err(Reported)
    }

    /// Bare keywords of which only one may be given.
    fn exclusions(&mut self, record: &Record) {
        for (k, g) in record.given.iter().enumerate() {
            let group = self.arguments[g.argument].group;
            let rival = record.given[..k]
                .iter()
                .find(|r| self.arguments[r.argument].group == group);
            if let (Some(group), Some(rival)) = (group, rival) {
                let [first, second] = [rival, g].map(|x| self.arguments[x.argument].keyword());
                let message = format!("{first} and {second} are both given as the {group}");
                self.error("excluded_argument", g.span, message);
            }
        }
    }

    // -------------------------------------------------------------------------------------------------------- values

    fn value(&mut self, kind: Kind, name: Token) -> Result<Value, Reported> {
        if self.at_end_of_value() {
            let message = format!("{} = what? It takes {}", self.text(name), kind.describe());
            return self.fail("missing_value", name.span, message);
        }
        Ok(match kind {
            Kind::Flag => Value::Flag,
            Kind::Id => Value::Id(self.whole()?),
            Kind::Ids { min, max } => {
                let all = self.list(min, Self::whole)?;
                self.count(name, all.len(), min, max, kind)?;
                Value::Ids(all)
            }
            Kind::Real { angle } => Value::Real(self.number(angle)?),
            Kind::Reals { min, max, angle } => {
                let all = self.list(min, |r| r.number(angle))?;
                self.count(name, all.len(), min, max, kind)?;
                Value::Reals(all)
            }
            Kind::Word(choices) => Value::Word(self.word(choices)?),
            Kind::Words(choices) => Value::Words(self.words(choices)?),
            Kind::Text => Value::Text(self.free_text()?),
            Kind::Texts => Value::Texts(self.texts()?),
            Kind::Formula => Value::Formula(self.formula(name)?),
            Kind::Raw => Value::Raw(self.raw(false)?),
        })
    }

    fn count(
        &mut self,
        name: Token,
        n: usize,
        min: usize,
        max: usize,
        kind: Kind,
    ) -> Result<(), Reported> {
        if (min..=max).contains(&n) {
            return Ok(());
        }
        let message = format!("{} takes {}, not {n}", self.text(name), kind.describe());
        self.error("wrong_count", name.span, message);
        Err(Reported)
    }

    /// Values with commas between them, as long as what follows a comma begins like a number; and in any case `min`,
    /// unless another argument begins.
    fn list<T>(
        &mut self,
        min: usize,
        mut one: impl FnMut(&mut Self) -> Result<T, Reported>,
    ) -> Result<Vec<T>, Reported> {
        let mut all = vec![one(self)?];
        loop {
            let next = self.after_separators(self.at);
            let atom = self
                .tokens
                .get(next)
                .filter(|t| next > self.at && t.kind == TokenKind::Atom);
            let expected = all.len() < min && !self.begins_argument(next);
            let more = atom.is_some_and(|t| self.numeric(*t) || expected);
            if !more || self.is_assignment(next) {
                return Ok(all);
            }
            self.at = next;
            all.push(one(self)?);
        }
    }

    fn whole(&mut self) -> Result<u32, Reported> {
        let token = self.atom()?;
        let text = self.text(token);
        match text.parse::<u32>() {
            Ok(n) if n <= i32::MAX as u32 => Ok(n),
            _ => self.fail(
                "not_a_whole_number",
                token.span,
                format!("`{text}` is not a whole number from 0 to 2147483647"),
            ),
        }
    }

    fn number(&mut self, angle: bool) -> Result<Number, Reported> {
        let token = self.atom()?;
        let mut span = token.span;
        let mut text = self.text(token).to_owned();
        if matches!(text.as_str(), "+" | "-") {
            let digits = self.atom()?;
            span.end = digits.span.end;
            text.push_str(self.text(digits));
        }
        let suffix = self
            .tokens
            .get(self.at)
            .filter(|t| t.kind == TokenKind::Atom);
        if let Some(&suffix) = suffix.filter(|t| self.text(**t).eq_ignore_ascii_case("D")) {
            self.at += 1;
            span.end = suffix.span.end;
            text.push('D');
            self.warning(
                "blank_before_suffix",
                span,
                "a blank stands between the number and its suffix D".into(),
            );
        }
        let Some(number) = Number::parse(&text) else {
            let d = Diagnostic::error("not_a_number", format!("`{text}` is not a number"));
            let exponent = text.contains(['D', 'd'])
                && Number::parse(&text.replace(['D', 'd'], "E")).is_some();
            let d = match exponent {
                true => d.help("D is the suffix of degrees; an exponent is written with E"),
                false => d,
            };
            let d = self.source.locate(d.element(self.element.clone()), span);
            self.out.push(d);
            return Err(Reported);
        };
        if number.degrees && !angle {
            let message = format!(
                "`{text}` means {} here: the suffix D turns degrees into radians",
                number.value()
            );
            self.warning("degrees_of_a_length", span, message);
        }
        Ok(number)
    }

    fn word(&mut self, choices: &'static [&'static str]) -> Result<String, Reported> {
        let token = self.atom()?;
        let word = self.text(token).to_owned();
        self.choose(&word, choices, token.span)
    }

    fn choose(
        &mut self,
        word: &str,
        choices: &'static [&'static str],
        span: Span,
    ) -> Result<String, Reported> {
        if choices.is_empty() {
            return Ok(word.to_owned());
        }
        let plural = word.strip_suffix(['S', 's']).unwrap_or(word);
        for word in [word, plural] {
            if let Meaning::One(k) = meaning(word, choices.iter().copied()) {
                return Ok(choices[k].to_owned());
            }
        }
        let near = near_names(word, choices.iter().copied());
        let d = Diagnostic::error(
            "unknown_word",
            format!("`{word}` is none of {}", choices.join(", ")),
        );
        let d = match near.is_empty() {
            true => d,
            false => d.help(format!("did you mean {}?", near.join(" or "))),
        };
        let d = self.source.locate(d.element(self.element.clone()), span);
        self.out.push(d);
        Err(Reported)
    }

    fn words(&mut self, choices: &'static [&'static str]) -> Result<Vec<String>, Reported> {
        let mut all = Vec::new();
        loop {
            let from = self.at;
            while let Some(t) = self.tokens.get(self.at) {
                if matches!(
                    t.kind,
                    TokenKind::Colon
                        | TokenKind::Comma
                        | TokenKind::Continuation
                        | TokenKind::Backslash
                ) {
                    break;
                }
                self.at += 1;
            }
            let span = self.between(from, self.at);
            let item = self.source.slice(span).to_owned();
            all.push(self.choose(&item, choices, span)?);
            if self.take(TokenKind::Colon).is_none() {
                return Ok(all);
            }
        }
    }

    /// The rest of the line, up to a comma that begins another argument.
    fn free_text(&mut self) -> Result<String, Reported> {
        let from = self.at;
        while let Some(t) = self.tokens.get(self.at) {
            let next = self.after_separators(self.at);
            let ends = match t.kind {
                TokenKind::Comma | TokenKind::Continuation => {
                    next >= self.tokens.len() || self.begins_argument(next)
                }
                TokenKind::Backslash => next >= self.tokens.len() || self.is_assignment(next),
                _ => false,
            };
            if ends {
                break;
            }
            self.at += 1;
        }
        Ok(self.joined(from, self.at, ", ").0)
    }

    /// Texts in quotes, or bare, with commas between them.
    fn texts(&mut self) -> Result<Vec<String>, Reported> {
        let mut all = Vec::new();
        loop {
            let from = self.at;
            while let Some(t) = self.tokens.get(self.at) {
                if matches!(
                    t.kind,
                    TokenKind::Comma | TokenKind::Continuation | TokenKind::Backslash
                ) {
                    break;
                }
                self.at += 1;
            }
            let text = self.source.slice(self.between(from, self.at));
            let inner = text.strip_prefix('"').and_then(|t| t.strip_suffix('"'));
            all.push(inner.unwrap_or(text).to_owned());
            let next = self.after_separators(self.at);
            let quoted = self
                .tokens
                .get(next)
                .is_some_and(|t| t.kind == TokenKind::Quoted);
            if next == self.at || next >= self.tokens.len() || !quoted && self.begins_argument(next)
            {
                return Ok(all);
            }
            self.at = next;
        }
    }

    /// Whatever stands there, up to what looks like another argument.
    fn raw(&mut self, open: bool) -> Result<String, Reported> {
        let from = self.at;
        while let Some(t) = self.tokens.get(self.at) {
            if matches!(
                t.kind,
                TokenKind::Comma | TokenKind::Continuation | TokenKind::Backslash
            ) {
                let next = self.after_separators(self.at);
                let word = self
                    .tokens
                    .get(next)
                    .filter(|t| t.kind == TokenKind::Atom && !self.numeric(**t));
                if next >= self.tokens.len()
                    || self.is_assignment(next)
                    || word.is_some() && (open || self.begins_argument(next))
                {
                    break;
                }
            }
            self.at += 1;
        }
        Ok(self.joined(from, self.at, ", ").0)
    }

    /// An expression: up to `\`, the end, or a comma (or slash) that is followed by `KEYWORD =`.
    fn formula(&mut self, name: Token) -> Result<Formula, Reported> {
        let from = self.at;
        let mut depth = 0usize;
        while let Some(&t) = self.tokens.get(self.at) {
            let next = self.after_separators(self.at);
            let ends = match t.kind {
                TokenKind::Open => {
                    depth += 1;
                    false
                }
                TokenKind::Close => {
                    depth = depth.saturating_sub(1);
                    false
                }
                TokenKind::Backslash => true,
                TokenKind::Slash => self.is_assignment(self.at + 1),
                TokenKind::Comma => depth == 0 || self.is_assignment(next),
                TokenKind::Continuation => {
                    self.is_assignment(next) || depth == 0 && self.forgotten_backslash(next, t.span)
                }
                _ => false,
            };
            if ends {
                break;
            }
            self.at += 1;
        }
        let mut to = self.at;
        while to > from
            && matches!(
                self.tokens[to - 1].kind,
                TokenKind::Slash | TokenKind::Comma | TokenKind::Continuation
            )
        {
            to -= 1;
        }
        if to == from {
            let message = format!("{} = what? It takes an expression", self.text(name));
            return self.fail("missing_value", name.span, message);
        }
        if let Some(user) = self.user(from, to)? {
            return Ok(user);
        }
        let (text, breaks) = self.joined(from, to, " ");
        let (line, column) = self.source.place(self.tokens[from].span.start);
        Ok(Formula::Expression {
            text: text.into(),
            line,
            column,
            breaks,
        })
    }

    /// Whether a line after an expression holds a bare keyword, before which a `\` belongs.
    fn forgotten_backslash(&mut self, at: usize, span: Span) -> bool {
        let Some(&t) = self.tokens.get(at) else {
            return false;
        };
        let word = self.text(t);
        let is_flag = self.arguments.iter().any(|a| {
            a.kind == Kind::Flag && word.len() > 1 && a.keyword().eq_ignore_ascii_case(word)
        });
        let alone = self.tokens.get(at + 1).is_none_or(|t| {
            matches!(
                t.kind,
                TokenKind::Comma | TokenKind::Continuation | TokenKind::Backslash
            )
        });
        if t.kind == TokenKind::Atom && is_flag && alone {
            let d = Diagnostic::warning(
                "missing_backslash",
                format!("the expression before {word} does not end with `\\`"),
            );
            let d = d.help("an expression ends with `\\` where another argument follows");
            let d = self.source.locate(d.element(self.element.clone()), span);
            self.out.push(d);
            return true;
        }
        false
    }

    /// `USER(r1, …)`, when the tokens are that and nothing else.
    fn user(&mut self, from: usize, to: usize) -> Result<Option<Formula>, Reported> {
        let tokens = self.tokens[from..to].to_vec();
        let [name, open, inner @ .., close] = tokens.as_slice() else {
            return Ok(None);
        };
        let kinds = (open.kind, close.kind);
        let nested = inner
            .iter()
            .any(|t| matches!(t.kind, TokenKind::Open | TokenKind::Close));
        let is_user = self.text(*name).eq_ignore_ascii_case("USER");
        if !is_user || kinds != (TokenKind::Open, TokenKind::Close) || nested {
            return Ok(None);
        }
        let mut constants = Vec::new();
        let mut sign = String::new();
        for &t in inner {
            match t.kind {
                TokenKind::Comma | TokenKind::Continuation => {}
                TokenKind::Atom if matches!(self.text(t), "+" | "-") => {
                    sign = self.text(t).to_owned()
                }
                _ => match Number::parse(&(std::mem::take(&mut sign) + self.text(t))) {
                    Some(x) => constants.push(x.value()),
                    None => {
                        let message = format!("`{}`: USER takes numbers only", self.text(t));
                        self.error("not_a_number", t.span, message);
                        return Err(Reported);
                    }
                },
            }
        }
        Ok(Some(Formula::User {
            constants,
            routine: None,
        }))
    }

    // ------------------------------------------------------------------------------------------------------- helpers

    /// The text of some tokens: lines joined by a blank; `between` stands for a comma that began a line, where the
    /// comma is part of the text. And where each further line begins.
    fn joined(&self, from: usize, to: usize, between: &str) -> (String, Vec<Break>) {
        let mut text = String::new();
        let mut breaks = Vec::new();
        let mut k = from;
        while k < to {
            if self.tokens[k].kind == TokenKind::Continuation {
                let bare = !text.ends_with(',');
                text.push_str(if bare { between } else { " " });
                k += 1;
                continue;
            }
            let mut last = k;
            while last + 1 < to
                && self.tokens[last + 1].kind != TokenKind::Continuation
                && self.same_line(last)
            {
                last += 1;
            }
            let start = self.tokens[k].span.start;
            if k > from {
                if !text.ends_with(' ') {
                    text.push(' ');
                }
                let (line, column) = self.source.place(start);
                breaks.push(Break {
                    offset: text.len(),
                    line,
                    column,
                });
            }
            text.push_str(
                self.source
                    .slice(Span::new(start, self.tokens[last].span.end)),
            );
            k = last + 1;
        }
        (text.trim_end().to_owned(), breaks)
    }

    /// Whether the next token stands on the same line as this one.
    fn same_line(&self, k: usize) -> bool {
        let gap = Span::new(self.tokens[k].span.end, self.tokens[k + 1].span.start);
        !self.source.slice(gap).contains(['\n', '\r'])
    }

    fn between(&self, from: usize, to: usize) -> Span {
        match (
            self.tokens.get(from),
            to.checked_sub(1).and_then(|k| self.tokens.get(k)),
        ) {
            (Some(a), Some(b)) if to > from => Span::new(a.span.start, b.span.end),
            (Some(a), _) => Span::new(a.span.start, a.span.start),
            _ => Span::default(),
        }
    }

    fn text(&self, token: Token) -> &'a str {
        self.source.slice(token.span)
    }

    fn take(&mut self, kind: TokenKind) -> Option<Token> {
        let token = self.tokens.get(self.at).filter(|t| t.kind == kind).copied();
        self.at += usize::from(token.is_some());
        token
    }

    fn atom(&mut self) -> Result<Token, Reported> {
        match self.take(TokenKind::Atom) {
            Some(token) => Ok(token),
            None => {
                let span = self
                    .tokens
                    .get(self.at)
                    .or(self.tokens.last())
                    .map_or(Span::default(), |t| t.span);
                let message = format!("a value is missing before `{}`", self.source.slice(span));
                self.fail("missing_value", span, message)
            }
        }
    }

    /// Whether a word begins like a number.
    fn numeric(&self, token: Token) -> bool {
        let text = self.text(token);
        text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-'))
    }

    /// The first token from here on that is neither comma nor backslash.
    fn after_separators(&self, from: usize) -> usize {
        let is = |t: &Token| {
            matches!(
                t.kind,
                TokenKind::Comma | TokenKind::Continuation | TokenKind::Backslash
            )
        };
        from + self.tokens[from.min(self.tokens.len())..]
            .iter()
            .take_while(|t| is(t))
            .count()
    }

    /// Whether a word and an equals sign stand here.
    fn is_assignment(&self, at: usize) -> bool {
        self.tokens
            .get(at)
            .is_some_and(|t| t.kind == TokenKind::Atom && !self.numeric(*t))
            && self
                .tokens
                .get(at + 1)
                .is_some_and(|t| t.kind == TokenKind::Equals)
    }

    /// Whether an argument of this statement stands here.
    fn begins_argument(&self, at: usize) -> bool {
        let Some(&t) = self.tokens.get(at) else {
            return false;
        };
        if self.is_assignment(at) {
            return true;
        }
        let alone = self.tokens.get(at + 1).is_none_or(|t| {
            matches!(
                t.kind,
                TokenKind::Comma | TokenKind::Continuation | TokenKind::Backslash
            )
        });
        let flag = |k: usize| self.arguments[k].kind == Kind::Flag;
        t.kind == TokenKind::Atom
            && alone
            && matches!(meaning(self.text(t), self.arguments.iter().map(|a| a.name)), Meaning::One(k) if flag(k))
    }

    fn at_end_of_value(&self) -> bool {
        let next = self.after_separators(self.at);
        next >= self.tokens.len() || next > self.at && self.is_assignment(next)
    }

    /// After a value comes a separator or the end.
    fn separated(&mut self) -> Result<(), Reported> {
        let Some(&t) = self.tokens.get(self.at) else {
            return Ok(());
        };
        match t.kind {
            TokenKind::Comma
            | TokenKind::Continuation
            | TokenKind::Backslash
            | TokenKind::Slash => Ok(()),
            _ => {
                let message = format!("`{}` does not belong to the value before it", self.text(t));
                let d = Diagnostic::error("unexpected_text", message)
                    .help("arguments are separated by commas");
                let d = self.source.locate(d.element(self.element.clone()), t.span);
                self.out.push(d);
                Err(Reported)
            }
        }
    }

    /// Goes to the next place where an argument may begin: a word after a comma, outside parentheses.
    fn recover(&mut self) {
        let mut depth = 0usize;
        while let Some(t) = self.tokens.get(self.at) {
            match t.kind {
                TokenKind::Open => depth += 1,
                TokenKind::Close => depth = depth.saturating_sub(1),
                _ => {}
            }
            let next = self.after_separators(self.at);
            let word = self
                .tokens
                .get(next)
                .is_none_or(|t| t.kind == TokenKind::Atom && !self.numeric(*t));
            if next > self.at && (depth == 0 && word || self.is_assignment(next)) {
                self.at = next;
                return;
            }
            self.at = next.max(self.at + 1);
        }
    }

    fn error(&mut self, code: &'static str, span: Span, message: String) {
        let mut d = Diagnostic::error(code, message);
        if !self.element.is_empty() {
            d = d.element(self.element.clone());
        }
        let d = self.source.locate(d, span);
        self.out.push(d);
    }

    fn warning(&mut self, code: &'static str, span: Span, message: String) {
        let d = Diagnostic::warning(code, message).element(self.element.clone());
        let d = self.source.locate(d, span);
        self.out.push(d);
    }

    fn fail<T>(&mut self, code: &'static str, span: Span, message: String) -> Result<T, Reported> {
        self.error(code, span, message);
        Err(Reported)
    }
}
