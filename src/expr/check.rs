//! One ordered pass over a text: it finds the first mistake, or the meaning of every name and
//! number.
//!
//! The grammar defines the language and makes the tree; but a grammar that fails knows neither the
//! kind nor the cause of a mistake. So the tokens first pass through an automaton with a stack of
//! open calls and groups, from left to right, without recursion. It reports the first mistake by
//! the rules of the language reference: names as they are read, the syntax of a whole argument list
//! before the number of its arguments, and that before the kinds of its identifiers. A text that
//! passes is one that the grammar accepts (the fuzz target `parse` checks that), and is nested no
//! deeper than recursion can go.

use super::ast::{Callee, Constant, Dialect};
use super::names::Names;
use super::signature::{Choice, Element, Kind as ArgumentKind, LARGEST_IDENTIFIER};
use super::symbols::{Profile, Symbol, symbol};
use super::token::{About, Fault, FaultKind, Kind, Lexer, Open, Token};
use crate::diagnostic::Span;
use std::collections::BTreeSet;

/// Most characters of a text.
pub const MOST_CHARACTERS: usize = 1_000_000;
/// Most calls, IFs and groups inside one another.
pub const DEEPEST_NESTING: usize = 256;
/// Most levels of the tree that recursion follows: the nesting, and chains of signs and powers.
const DEEPEST_TREE: usize = 512;
/// Words for which there is room before the first is read.
const USUAL_WORDS: usize = 32;

/// The limits of I-DEAS, so that hosts may apply them too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// most calls, IFs and groups inside one another
    pub nesting: usize,
    /// most operators, brackets, names, numbers and separators
    pub symbols: usize,
    /// most different identifiers of one kind of element
    pub elements: usize,
    /// most lines
    pub lines: usize,
    /// most characters
    pub characters: usize,
}

impl Limits {
    /// The limits that keep the reader safe, and no others.
    pub const NONE: Limits = Limits {
        nesting: DEEPEST_NESTING,
        symbols: usize::MAX,
        elements: usize::MAX,
        lines: usize::MAX,
        characters: MOST_CHARACTERS,
    };
    /// The limits of I-DEAS Mechanism Design.
    pub const IDEAS: Limits = Limits {
        nesting: 10,
        symbols: 1000,
        elements: 25,
        lines: 20,
        characters: 500,
    };
}

impl Profile {
    /// Returns the limits of this profile.
    pub fn limits(self) -> Limits {
        match self {
            Profile::Adams => Limits::NONE,
            Profile::Ideas => Limits::IDEAS,
        }
    }
}

/// The meaning of a number or a name, collected in the order of the text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Atom {
    Number {
        literal: f64,
        degrees: bool,
    },
    Constant(Constant),
    Callee(Callee),
    /// an entry of the caller's own names
    Named(u32),
}

/// A token of a text, its end left out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Word {
    pub span: Span,
    pub kind: Kind,
    /// its meaning; of marks and of IF there is none
    pub atom: Option<Atom>,
}

/// An open parenthesis and the argument that is being read inside it.
#[derive(Clone, Copy, Debug)]
struct Frame {
    open: Open,
    /// the name; of a group its parenthesis
    name: Span,
    /// index of its first argument in `Check::arguments`
    first: usize,
    /// levels of the tree above it
    depth: usize,
}

/// An argument, as far as the check of identifiers needs it.
#[derive(Clone, Copy, Debug)]
struct Argument {
    /// first byte
    start: usize,
    /// byte behind it
    end: usize,
    /// number of its tokens
    tokens: u32,
}

struct Check<'a> {
    text: &'a str,
    lexer: Lexer<'a>,
    dialect: Dialect,
    profile: Profile,
    names: &'a Names,
    limits: Limits,
    /// tokens read so far
    words: Vec<Word>,
    /// open calls and groups, outermost first
    frames: Vec<Frame>,
    /// arguments of all open calls, those of inner calls last
    arguments: Vec<Argument>,
    /// levels of the tree above the next operand
    depth: usize,
    /// different identifiers so far
    elements: BTreeSet<(Element, u32)>,
    /// symbols counted so far
    symbols: usize,
    /// lines and characters counted so far
    counted: Counted,
}

/// A count of lines and characters up to a place in the text.
#[derive(Clone, Copy, Debug, Default)]
struct Counted {
    bytes: usize,
    characters: usize,
    line_breaks: usize,
}

/// Returns the tokens of a text with the meanings of numbers and names, or its first mistake.
pub(crate) fn check(
    text: &str,
    dialect: Dialect,
    profile: Profile,
    limits: Limits,
    names: &Names,
) -> Result<Vec<Word>, Fault> {
    if let Some(span) = character_after(text, MOST_CHARACTERS) {
        return Err(Fault::new(FaultKind::Characters, span).about(About::Limit(MOST_CHARACTERS)));
    }
    let mut check = Check {
        text,
        lexer: Lexer::new(text, dialect == Dialect::Function),
        dialect,
        profile,
        names,
        limits,
        words: Vec::with_capacity(text.len().min(USUAL_WORDS)),
        frames: Vec::new(),
        arguments: Vec::new(),
        depth: 0,
        elements: BTreeSet::new(),
        symbols: 0,
        counted: Counted::default(),
    };
    check.run()?;
    Ok(check.words)
}

/// Returns the place of the character after the first `n`, if there is one.
fn character_after(text: &str, n: usize) -> Option<Span> {
    if text.len() <= n {
        return None;
    }
    let (at, c) = text.char_indices().nth(n)?;
    Some(Span::new(at, at + c.len_utf8()))
}

impl Check<'_> {
    /// Checks the whole text.
    fn run(&mut self) -> Result<(), Fault> {
        let mut token = self.next()?;
        loop {
            // an operand: signs and opening parentheses, then a number, a constant, or F(
            token = match token.kind {
                Kind::Plus | Kind::Minus => self.deeper(token)?,
                Kind::Open => {
                    self.open(Open::Group, token.span)?;
                    self.next()?
                }
                Kind::Number { literal, degrees } => {
                    self.means(Atom::Number { literal, degrees });
                    let after = self.next()?;
                    match self.after_operand(after)? {
                        Some(token) => token,
                        None => return Ok(()),
                    }
                }
                Kind::Name => match self.name(token)? {
                    Some(token) => token,
                    None => return Ok(()),
                },
                Kind::End => return Err(self.unexpected_end(false)),
                Kind::Comma | Kind::Close if self.at_start_of_argument() => {
                    let about = self.unexpected(token.span, false).about;
                    return Err(Fault::new(FaultKind::EmptyArgument, token.span).about(about));
                }
                _ => return Err(self.unexpected(token.span, false)),
            };
        }
    }

    /// Gives the token that was read last its meaning.
    fn means(&mut self, atom: Atom) {
        if let Some(word) = self.words.last_mut() {
            word.atom = Some(atom);
        }
    }

    /// Reads a constant with its suffix, or the beginning of a call; returns the token that the
    /// next operand begins with.
    fn name(&mut self, name: Token) -> Result<Option<Token>, Fault> {
        let text = &self.text[name.span.start..name.span.end];
        if let Some(entry) = self.names.find(text) {
            self.means(Atom::Named(entry));
            return match self.names.entry(entry).arguments.len() {
                0 => self.after_constant(),
                _ => self.call(Open::Named(entry), name),
            };
        }
        let Some(meaning) = symbol(text, self.dialect, self.profile) else {
            return Err(Fault::new(FaultKind::UnknownName, name.span));
        };
        let open = match meaning {
            Symbol::Constant(c) => {
                self.means(Atom::Constant(c));
                return self.after_constant();
            }
            Symbol::If => Open::If(0),
            Symbol::Callee(callee) => {
                self.means(Atom::Callee(callee));
                Open::Call(callee)
            }
        };
        self.call(open, name)
    }

    /// Reads what follows a named number.
    fn after_constant(&mut self) -> Result<Option<Token>, Fault> {
        let after = self.next()?;
        match after.kind {
            Kind::Open => Err(Fault::new(FaultKind::NotCallable, after.span)),
            _ => self.after_operand(after),
        }
    }

    /// Reads the beginning of a call; returns the token that its first argument begins with.
    fn call(&mut self, open: Open, name: Token) -> Result<Option<Token>, Fault> {
        self.open(open, name.span)?;
        let inside = Some((open, name.span));
        let missing = Fault::new(FaultKind::MissingArguments, name.span).about(About::Token {
            after_operand: false,
            inside,
        });
        if self.next()?.kind != Kind::Open {
            return Err(missing);
        }
        self.begin_argument();
        let first = self.next()?;
        match (first.kind, open) {
            (Kind::Close, Open::Call(callee)) => {
                Err(Fault::new(FaultKind::Arity, name.span).about(About::Count(callee, 0)))
            }
            (Kind::Close, Open::Named(entry)) => {
                Err(Fault::new(FaultKind::Arity, name.span).about(About::NamedCount(entry, 0)))
            }
            _ => Ok(Some(first)),
        }
    }

    /// Reads closing parentheses, then an operator, a separator or the end; returns the token that
    /// the next operand begins with.
    fn after_operand(&mut self, mut token: Token) -> Result<Option<Token>, Fault> {
        loop {
            let unexpected = Err(self.unexpected(token.span, true));
            match token.kind {
                Kind::Plus | Kind::Minus | Kind::Times | Kind::Over => {
                    self.depth = self.level();
                    return self.next().map(Some);
                }
                Kind::Power => return self.deeper(token).map(Some),
                Kind::Comma | Kind::Colon => {
                    match (self.frames.last_mut().map(|f| &mut f.open), token.kind) {
                        (Some(Open::Call(_) | Open::Named(_)), Kind::Comma) => {}
                        (Some(Open::If(part @ 0)), Kind::Colon) => *part = 1,
                        (Some(Open::If(part @ (1 | 2))), Kind::Comma) => *part += 1,
                        _ => return unexpected,
                    }
                    self.begin_argument();
                    return self.next().map(Some);
                }
                Kind::Close => {
                    let Some(frame) = self.frames.pop() else {
                        return unexpected;
                    };
                    match frame.open {
                        Open::If(part) if part < 3 => return unexpected,
                        Open::Call(callee) => self.close_call(callee, &frame)?,
                        Open::Named(entry) => self.close_named(entry, &frame)?,
                        Open::If(_) | Open::Group => {}
                    }
                    self.arguments.truncate(frame.first);
                    self.depth = frame.depth;
                    token = self.next()?;
                }
                Kind::End if self.frames.is_empty() => return Ok(None),
                Kind::End => return Err(self.unexpected_end(true)),
                Kind::Number { .. } | Kind::Name | Kind::Open => return unexpected,
            }
        }
    }

    /// Checks the number of arguments, then identifiers and selectors from left to right.
    fn close_call(&mut self, callee: Callee, frame: &Frame) -> Result<(), Fault> {
        let count = self.arguments.len() - frame.first;
        let (least, most) = callee.arity();
        if !(least..=most).contains(&count) {
            return Err(Fault::new(FaultKind::Arity, frame.name).about(About::Count(callee, count)));
        }
        for k in 0..count {
            self.integer(callee.argument(k), self.arguments[frame.first + k])
                .map_err(|fault| match fault.about {
                    About::Place => fault.about(About::Argument(callee, k)),
                    _ => fault,
                })?;
        }
        Ok(())
    }

    /// Checks the number of arguments of a function of the caller's own.
    fn close_named(&self, entry: u32, frame: &Frame) -> Result<(), Fault> {
        let count = self.arguments.len() - frame.first;
        match self.names.entry(entry).arguments.len() == count {
            true => Ok(()),
            false => {
                let about = About::NamedCount(entry, count);
                Err(Fault::new(FaultKind::Arity, frame.name).about(about))
            }
        }
    }

    /// Checks that an argument is an integer literal of its kind and range.
    fn integer(&mut self, kind: ArgumentKind, argument: Argument) -> Result<(), Fault> {
        if kind == ArgumentKind::Number {
            return Ok(());
        }
        let span = Span::new(argument.start, argument.end);
        let text = &self.text[argument.start..argument.end];
        if argument.tokens != 1 || !text.bytes().all(|b| b.is_ascii_digit()) {
            return Err(Fault::new(FaultKind::IntegerRequired, span));
        }
        let out_of_range = Fault::new(FaultKind::OutOfRange, span);
        let Ok(n) = text.parse::<u32>() else {
            return Err(out_of_range);
        };
        let fits = match kind {
            ArgumentKind::Number => true,
            ArgumentKind::Selector(choice) => choice.allows(n),
            ArgumentKind::Identifier { zero: true, .. } => {
                Choice::Range(0, LARGEST_IDENTIFIER).allows(n)
            }
            ArgumentKind::Identifier { zero: false, .. } => {
                Choice::Range(1, LARGEST_IDENTIFIER).allows(n)
            }
        };
        if !fits {
            return Err(out_of_range);
        }
        if let ArgumentKind::Identifier { element, .. } = kind
            && n > 0
            && self.limits.elements < usize::MAX
        {
            self.elements.insert((element, n));
            let of_this_kind = self
                .elements
                .range((element, 0)..=(element, u32::MAX))
                .count();
            if of_this_kind > self.limits.elements {
                return Err(
                    Fault::new(FaultKind::Elements, span).about(About::Limit(self.limits.elements))
                );
            }
        }
        Ok(())
    }

    /// Opens a call or a group.
    fn open(&mut self, open: Open, name: Span) -> Result<(), Fault> {
        if self.frames.len() >= self.limits.nesting.min(DEEPEST_NESTING)
            || self.depth >= DEEPEST_TREE
        {
            return Err(Fault::new(FaultKind::Nesting, name)
                .about(About::Limit(self.limits.nesting.min(DEEPEST_NESTING))));
        }
        self.frames.push(Frame {
            open,
            name,
            first: self.arguments.len(),
            depth: self.depth,
        });
        self.depth += 1;
        Ok(())
    }

    /// Returns the tree level of a new term here.
    fn level(&self) -> usize {
        self.frames.last().map_or(0, |f| f.depth + 1)
    }

    /// Notes a sign or `**`: the next operand lies one level deeper.
    fn deeper(&mut self, token: Token) -> Result<Token, Fault> {
        self.depth += 1;
        if self.depth > DEEPEST_TREE {
            return Err(
                Fault::new(FaultKind::Nesting, token.span).about(About::Limit(DEEPEST_TREE))
            );
        }
        self.next()
    }

    fn begin_argument(&mut self) {
        self.depth = self.level();
        self.arguments.push(Argument {
            start: 0,
            end: 0,
            tokens: 0,
        });
    }

    /// Returns whether the token just read, and counted, is the first of an argument.
    fn at_start_of_argument(&self) -> bool {
        let in_call = matches!(
            self.frames.last(),
            Some(Frame {
                open: Open::Call(_) | Open::Named(_) | Open::If(_),
                ..
            })
        );
        in_call && self.arguments.last().is_some_and(|a| a.tokens == 1)
    }

    fn unexpected_end(&self, after_operand: bool) -> Fault {
        let end = self.text.trim_end_matches([' ', '\t', '\r', '\n']).len();
        let about = self.unexpected(Span::new(end, end), after_operand).about;
        Fault::new(FaultKind::UnexpectedEnd, Span::new(end, end)).about(about)
    }

    fn unexpected(&self, span: Span, after_operand: bool) -> Fault {
        let inside = self.frames.last().map(|f| (f.open, f.name));
        Fault::new(FaultKind::UnexpectedToken, span).about(About::Token {
            after_operand,
            inside,
        })
    }

    /// Reads and counts the next token.
    fn next(&mut self) -> Result<Token, Fault> {
        let token = self.lexer.next();
        self.keep_to_length(
            token
                .as_ref()
                .map_or_else(|fault| fault.span, |token| token.span),
        )?;
        let token = token?;
        if token.kind != Kind::End {
            self.words.push(Word {
                span: token.span,
                kind: token.kind,
                atom: None,
            });
            self.symbols += 1;
            if self.symbols > self.limits.symbols {
                return Err(Fault::new(FaultKind::Symbols, token.span)
                    .about(About::Limit(self.limits.symbols)));
            }
        }
        // only the argument being read counts tokens, and it belongs to the innermost call
        if let Some(argument) = self.arguments.last_mut() {
            if argument.tokens == 0 {
                argument.start = token.span.start;
            }
            if !matches!(token.kind, Kind::Comma | Kind::Colon | Kind::Close)
                || argument.tokens == 0
            {
                argument.end = token.span.end;
                argument.tokens = argument.tokens.saturating_add(1);
            }
        }
        Ok(token)
    }

    /// Counts lines and characters up to the end of this token.
    fn keep_to_length(&mut self, span: Span) -> Result<(), Fault> {
        if self.limits.lines == usize::MAX && self.limits.characters >= MOST_CHARACTERS {
            return Ok(());
        }
        for c in self.text[self.counted.bytes..span.end].chars() {
            let place = Span::new(self.counted.bytes, self.counted.bytes + c.len_utf8());
            if self.counted.characters >= self.limits.characters {
                return Err(Fault::new(FaultKind::Characters, place)
                    .about(About::Limit(self.limits.characters)));
            }
            if self.counted.line_breaks >= self.limits.lines {
                return Err(
                    Fault::new(FaultKind::Lines, place).about(About::Limit(self.limits.lines))
                );
            }
            self.counted.bytes = place.end;
            self.counted.characters += 1;
            self.counted.line_breaks += usize::from(c == '\n');
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(text: &str, limits: Limits) -> (&'static str, usize) {
        let found = check(
            text,
            Dialect::Function,
            Profile::Adams,
            limits,
            &Names::new(),
        );
        let fault = found.expect_err(text);
        (fault.kind.code(), fault.span.start + 1)
    }

    #[test]
    fn the_first_mistake_from_the_left_is_reported() {
        for (text, code, column) in [
            ("FOO+2^3", "unknown_name", 1),
            ("2^3+FOO", "bad_char", 2),
            ("SIN(1,2)+FOO", "arity", 1),
            ("MAX(FOO(1,2),^)", "unknown_name", 5),
            ("2 FOO", "unexpected_token", 3),
            ("2 3.4.5", "bad_number", 3),
        ] {
            assert_eq!(fault(text, Limits::NONE), (code, column), "{text}");
        }
    }

    #[test]
    fn a_call_is_checked_syntax_first_then_count_then_identifiers() {
        for (text, code, column) in [
            ("DX(1.5,2,^)", "bad_char", 10),
            ("DX(1.5,,2)", "empty_argument", 8),
            ("DX(1.5,2,3,4)", "arity", 1),
            ("DX(1.5,0,-3)", "integer_required", 4),
            ("DX(0,1.5)", "out_of_range", 4),
            ("SIN(DX(1.5),2)", "integer_required", 8),
            ("DX((1))", "integer_required", 4),
            ("DX(2147483647)", "out_of_range", 4),
            ("DX(99999999999999999999)", "out_of_range", 4),
            ("CURVE(TIME,3,4,0)", "out_of_range", 12),
        ] {
            assert_eq!(fault(text, Limits::NONE), (code, column), "{text}");
        }
    }

    #[test]
    fn parts_of_an_if_are_counted_and_not_empty() {
        for (text, code, column) in [
            ("IF()", "empty_argument", 4),
            ("IF(,1,2,3)", "empty_argument", 4),
            ("IF(1)", "unexpected_token", 5),
            ("IF(1:)", "empty_argument", 6),
            ("IF(1:2)", "unexpected_token", 7),
            ("IF(1:2,3:4)", "unexpected_token", 9),
            ("IF(1:2,3,4", "unexpected_end", 11),
            ("IF", "missing_arguments", 1),
            ("IF(1:(2,3),4,5)", "unexpected_token", 8),
        ] {
            assert_eq!(fault(text, Limits::NONE), (code, column), "{text}");
        }
    }

    #[test]
    fn every_limit_is_met_exactly() {
        let limits = |change: fn(&mut Limits)| {
            let mut limits = Limits::NONE;
            change(&mut limits);
            limits
        };
        let accepted = |text, limits| {
            check(
                text,
                Dialect::Function,
                Profile::Adams,
                limits,
                &Names::new(),
            )
            .is_ok()
        };
        let nesting = limits(|l| l.nesting = 2);
        assert!(accepted("ABS(IF(1:2,3,4))", nesting));
        assert_eq!(fault("ABS(IF(1:2,3,(4)))", nesting), ("limit_nesting", 14));
        let symbols = limits(|l| l.symbols = 4);
        assert!(accepted("SIN(1)", symbols));
        assert_eq!(fault("SIN(1)+1", symbols), ("limit_symbols", 7));
        let elements = limits(|l| l.elements = 2);
        assert!(accepted("DX(1,2)+DY(2,1,0)+VARVAL(1)+VARVAL(3)", elements));
        assert_eq!(
            fault("DX(1,2)+VARVAL(1)+DX(2,3)", elements),
            ("limit_elements", 24)
        );
        let lines = limits(|l| l.lines = 2);
        assert!(accepted("1\n+1\n", lines));
        assert_eq!(fault("1\n+1 \n +1", lines), ("limit_lines", 7));
        let characters = limits(|l| l.characters = 5);
        assert!(accepted("1+1  ", characters));
        assert_eq!(fault("1+1   ", characters), ("limit_length", 6));
        assert_eq!(fault("1+1+TIME", characters), ("limit_length", 6));
    }
}
