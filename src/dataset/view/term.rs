//! Expressions of Adams View, `(LOC_RELATIVE_TO({0, .m.DV_1 / 2, 0}, .m.ground.M))`, as trees.
//!
//! ```text
//! ||   &&   == != < > <= >=   //   + -   * /   - + !   **   x(unit)  x[k]
//! ```
//!
//! from what binds least to what binds most; `//` joins texts. A number carries its unit,
//! `25.4mm`, `10(newton-mm/deg)`.

use super::syntax::grammar::{Rule, View};
use super::syntax::{DEEPEST, span_of};
use super::units;
use crate::diagnostic::{Diagnostic, Span};
use pest::Parser;
use std::rc::Rc;

/// An operation on two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Binary {
    Or,
    And,
    Equal,
    Unequal,
    Less,
    Greater,
    LessOrEqual,
    GreaterOrEqual,
    Join,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Term {
    /// a number in the units of the file
    Number(f64),
    Text(String),
    /// a word or the name of an object or a field, as written
    Name(String),
    Array(Vec<Term>),
    Call(String, Vec<Term>),
    Negative(Box<Term>),
    Not(Box<Term>),
    Two(Binary, Box<Term>, Box<Term>),
    /// an element of an array, counted from 1
    Element(Box<Term>, Box<Term>),
    /// a field of the object that is a value
    Field(Box<Term>, String),
    /// a value in units of its own
    InUnit(Box<Term>, units::Unit),
}

/// A tree that copies share.
pub(super) type Shared = Rc<Term>;

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    Number,
    Name,
    Text,
    Operator,
    Odd,
}

struct Token<'a> {
    kind: Kind,
    text: &'a str,
    span: Span,
}

/// Reads an expression; places count from the beginning of the text.
///
/// # Errors
/// The first mistake, with its place.
pub(super) fn parse(text: &str) -> Result<Term, Diagnostic> {
    let mistake = |what: &str, span| {
        let mut d = Diagnostic::error("view_expression", what.to_owned());
        d.span = Some(span);
        d
    };
    let pairs = View::parse(Rule::term, text)
        .map_err(|_| mistake("the expression cannot be taken apart", Span::default()))?;
    let mut tokens = Vec::new();
    for pair in pairs.flat_map(pest::iterators::Pair::into_inner) {
        let kind = match pair.as_rule() {
            Rule::number => Kind::Number,
            Rule::name => Kind::Name,
            Rule::text => Kind::Text,
            Rule::operator => Kind::Operator,
            Rule::odd => Kind::Odd,
            _ => continue,
        };
        let span = span_of(&pair);
        let text = &text[span.start..span.end];
        tokens.push(Token { kind, text, span });
    }
    let mut reader = Reader {
        tokens: &tokens,
        at: 0,
        depth: 0,
    };
    let term = reader.binary(0);
    match term {
        Some(term) if reader.at == tokens.len() => Ok(term),
        _ => {
            let at = tokens.get(reader.at).map(|t| (t.text, t.span));
            let end = Span::new(text.len(), text.len());
            Err(match at {
                Some((text, span)) => mistake(&format!("`{text}` is not expected here"), span),
                None => mistake("the expression ends too early", end),
            })
        }
    }
}

struct Reader<'a> {
    tokens: &'a [Token<'a>],
    at: usize,
    depth: usize,
}

/// Operators from what binds least.
const LEVELS: &[&[(&str, Binary)]] = &[
    &[("||", Binary::Or)],
    &[("&&", Binary::And)],
    &[
        ("==", Binary::Equal),
        ("!=", Binary::Unequal),
        ("<>", Binary::Unequal),
        ("<", Binary::Less),
        (">", Binary::Greater),
        ("<=", Binary::LessOrEqual),
        (">=", Binary::GreaterOrEqual),
    ],
    &[("//", Binary::Join)],
    &[("+", Binary::Add), ("-", Binary::Subtract)],
    &[("*", Binary::Multiply), ("/", Binary::Divide)],
];

impl Reader<'_> {
    fn peek(&self) -> Option<&str> {
        let token = self.tokens.get(self.at)?;
        (token.kind == Kind::Operator).then_some(token.text)
    }

    fn take(&mut self, mark: &str) -> bool {
        let is = self.peek() == Some(mark);
        self.at += usize::from(is);
        is
    }

    fn binary(&mut self, level: usize) -> Option<Term> {
        let Some(operators) = LEVELS.get(level) else {
            return self.signed();
        };
        let mut left = self.binary(level + 1)?;
        while let Some((_, operator)) = self
            .peek()
            .and_then(|mark| operators.iter().find(|(text, _)| *text == mark))
        {
            self.at += 1;
            let right = self.binary(level + 1)?;
            left = Term::Two(*operator, left.into(), right.into());
        }
        Some(left)
    }

    fn signed(&mut self) -> Option<Term> {
        self.depth += 1;
        if self.depth > 4 * DEEPEST {
            return None;
        }
        let term = match self.peek() {
            Some("-") => {
                self.at += 1;
                Term::Negative(self.signed()?.into())
            }
            Some("+") => {
                self.at += 1;
                self.signed()?
            }
            Some("!") => {
                self.at += 1;
                Term::Not(self.signed()?.into())
            }
            _ => self.power()?,
        };
        self.depth -= 1;
        Some(term)
    }

    fn power(&mut self) -> Option<Term> {
        let base = self.postfix()?;
        if self.take("**") || self.take("^") {
            let exponent = self.signed()?;
            return Some(Term::Two(Binary::Power, base.into(), exponent.into()));
        }
        Some(base)
    }

    fn postfix(&mut self) -> Option<Term> {
        let mut term = self.primary()?;
        loop {
            if self.peek() == Some("(")
                && let Some(unit) = self.unit_in_parentheses()
            {
                term = Term::InUnit(term.into(), unit);
            } else if self.take("[") {
                let index = self.binary(0)?;
                if !self.take("]") {
                    return None;
                }
                term = Term::Element(term.into(), index.into());
            } else if let Some(field) = self.field() {
                term = Term::Field(term.into(), field);
            } else if let Some(unit) = self.glued_unit() {
                term = Term::InUnit(term.into(), unit);
            } else {
                return Some(term);
            }
        }
    }

    /// Reads a field behind a parenthesis: `STOO(name).adams_id`.
    fn field(&mut self) -> Option<String> {
        let token = self.tokens.get(self.at)?;
        let field = token.text.strip_prefix('.')?.to_owned();
        let before = self.tokens.get(self.at.checked_sub(1)?)?;
        let is = token.kind == Kind::Name && matches!(before.text, ")" | "]");
        self.at += usize::from(is);
        is.then_some(field)
    }

    /// Reads a unit that follows: `25.4mm`, `ACOS(x)d`, `.m.angle d`.
    fn glued_unit(&mut self) -> Option<units::Unit> {
        let token = self.tokens.get(self.at)?;
        if token.kind != Kind::Name {
            return None;
        }
        let unit = units::unit(token.text)?;
        self.at += 1;
        Some(unit)
    }

    /// Reads `(newton-mm/deg)`, if it is a unit and nothing else.
    fn unit_in_parentheses(&mut self) -> Option<units::Unit> {
        let start = self.at + 1;
        let rest = self.tokens.get(start..)?;
        let length = rest.iter().position(|t| t.text == ")")?;
        let inside = &rest[..length];
        let words = inside.iter().map(|t| t.text);
        let unit = units::compound(words)?;
        self.at = start + length + 1;
        Some(unit)
    }

    fn list(&mut self, end: &str) -> Option<Vec<Term>> {
        let mut all = Vec::new();
        if self.take(end) {
            return Some(all);
        }
        loop {
            all.push(self.binary(0)?);
            if self.take(end) {
                return Some(all);
            }
            if !self.take(",") {
                return None;
            }
        }
    }

    fn primary(&mut self) -> Option<Term> {
        let token = self.tokens.get(self.at)?;
        let (kind, text) = (token.kind.clone(), token.text);
        self.at += 1;
        let term = match (kind, text) {
            (Kind::Number, _) => text.parse().ok().map(Term::Number),
            (Kind::Text, _) => Some(Term::Text(unquoted(text))),
            (Kind::Name, _) => {
                let is_call = self.peek() == Some("(") && !text.contains('.');
                if is_call {
                    self.at += 1;
                    let arguments = self.list(")")?;
                    return Some(Term::Call(text.to_ascii_lowercase(), arguments));
                }
                Some(Term::Name(text.to_owned()))
            }
            (Kind::Operator, "(") => {
                let inner = self.binary(0)?;
                self.take(")").then_some(inner)
            }
            (Kind::Operator, "{") => self.list("}").map(Term::Array),
            _ => None,
        };
        if term.is_none() {
            self.at = self.at.saturating_sub(1);
        }
        term
    }
}

/// Returns a text without its quotation marks.
pub(super) fn unquoted(text: &str) -> String {
    let mark = text.chars().next().filter(|c| matches!(c, '"' | '\''));
    let inner = mark.and_then(|mark| text.strip_prefix(mark)?.strip_suffix(mark));
    let inner = inner.unwrap_or(text);
    match mark {
        Some('"') => inner.replace("\\\"", "\""),
        _ => inner.to_owned(),
    }
}
