//! Text to [`Ast`]: the ordered check first, then its words become nodes, by precedence.
//!
//! The grammars (`grammar/function.pest`, `grammar/expression.pest`) are the definition of the languages. Reading by them takes
//! four fifths of the time between text and program, so they are the second opinion: debug builds, and with them all tests and
//! fuzz targets, read every text both ways and insist on the same tree.

use super::advice;
use super::ast::{Ast, BinaryOp, Dialect, Node, NodeIx};
use super::check::{Limits, Meaning, Word, check};
use super::grammar;
use super::symbols::Profile;
use super::token::Kind;
use crate::diagnostic::{Diagnostic, Span};

/// Reads a text of one of the two languages.
///
/// # Errors
/// The first mistake in the text, from left to right: its kind is the diagnostic's code, its column counts all characters of
/// the text from 1.
pub fn parse(text: &str, dialect: Dialect, profile: Profile) -> Result<Ast, Diagnostic> {
    parse_with_limits(text, dialect, profile, profile.limits())
}

/// As [`parse`], with limits of the caller's own.
///
/// # Errors
/// The first mistake in the text; exceeding a limit is one.
pub fn parse_with_limits(
    text: &str,
    dialect: Dialect,
    profile: Profile,
    limits: Limits,
) -> Result<Ast, Diagnostic> {
    let words = check(text, dialect, profile, limits)
        .map_err(|fault| advice::explain(text, dialect, &fault))?;
    let tree = Builder::new(&words).whole();
    if cfg!(debug_assertions) {
        let defined = grammar::tree(text, dialect, &words);
        assert_eq!(tree, defined, "the grammar reads it otherwise: {text:?}");
        assert!(tree.is_some(), "the check accepts it: {text:?}");
    }
    let (nodes, spans) = tree.ok_or_else(|| {
        // The check and the builder disagree: our mistake, but the user's text is not readable all the same.
        Diagnostic::error("unexpected_token", "this cannot be read as an expression")
            .at(text, Span::new(0, text.len()))
    })?;
    let root = (nodes.len() - 1) as NodeIx;
    Ok(Ast {
        dialect,
        nodes,
        spans,
        root,
    })
}

/// Makes nodes of words, children before parents. `None` anywhere: the words are not those of an expression.
///
/// Recursion is as deep as the check allows.
struct Builder<'a> {
    words: std::slice::Iter<'a, Word>,
    nodes: Vec<Node>,
    spans: Vec<Span>,
}

impl<'a> Builder<'a> {
    fn new(words: &'a [Word]) -> Self {
        Self {
            words: words.iter(),
            nodes: Vec::with_capacity(words.len()),
            spans: Vec::with_capacity(words.len()),
        }
    }

    /// One expression, and nothing behind it.
    fn whole(mut self) -> Option<(Vec<Node>, Vec<Span>)> {
        self.sum()?;
        self.words
            .next()
            .is_none()
            .then_some((self.nodes, self.spans))
    }

    fn push(&mut self, node: Node, span: Span) -> NodeIx {
        self.nodes.push(node);
        self.spans.push(span);
        (self.nodes.len() - 1) as NodeIx
    }

    /// The next sign, if it is one that has a value here.
    fn next_sign<T>(&mut self, of: impl FnOnce(Kind) -> Option<T>) -> Option<(T, Span)> {
        let word = self.words.as_slice().first()?;
        let Meaning::Sign(sign) = word.meaning else {
            return None;
        };
        let found = of(sign)?;
        self.words.next();
        Some((found, word.span))
    }

    /// The next word must be this sign.
    fn expect(&mut self, sign: Kind) -> Option<()> {
        (self.words.next()?.meaning == Meaning::Sign(sign)).then_some(())
    }

    /// Products with `+` and `-` between them, from the left.
    fn sum(&mut self) -> Option<NodeIx> {
        let mut left = self.product()?;
        while let Some((op, span)) = self.next_sign(|sign| match sign {
            Kind::Plus => Some(BinaryOp::Add),
            Kind::Minus => Some(BinaryOp::Sub),
            _ => None,
        }) {
            let right = self.product()?;
            left = self.push(Node::Binary(op, left, right), span);
        }
        Some(left)
    }

    fn product(&mut self) -> Option<NodeIx> {
        let mut left = self.unary()?;
        while let Some((op, span)) = self.next_sign(|sign| match sign {
            Kind::Times => Some(BinaryOp::Mul),
            Kind::Over => Some(BinaryOp::Div),
            _ => None,
        }) {
            let right = self.unary()?;
            left = self.push(Node::Binary(op, left, right), span);
        }
        Some(left)
    }

    /// `-a**-b**c` is `-(a**(-(b**c)))`.
    fn unary(&mut self) -> Option<NodeIx> {
        if let Some((sign, span)) = self.next_sign(|sign| match sign {
            Kind::Minus => Some(Node::Negate as fn(NodeIx) -> Node),
            Kind::Plus => Some(Node::Plus as fn(NodeIx) -> Node),
            _ => None,
        }) {
            let x = self.unary()?;
            return Some(self.push(sign(x), span));
        }
        let base = self.operand()?;
        let power = self.next_sign(|sign| (sign == Kind::Power).then_some(BinaryOp::Pow));
        let Some((op, span)) = power else {
            return Some(base);
        };
        let exponent = self.unary()?;
        Some(self.push(Node::Binary(op, base, exponent), span))
    }

    fn operand(&mut self) -> Option<NodeIx> {
        let &Word { meaning, span } = self.words.next()?;
        match meaning {
            Meaning::Number { literal, degrees } => {
                Some(self.push(Node::Number { literal, degrees }, span))
            }
            Meaning::Constant(c) => Some(self.push(Node::Constant(c), span)),
            Meaning::Sign(Kind::Open) => {
                let inside = self.sum()?;
                self.expect(Kind::Close)?;
                Some(inside)
            }
            Meaning::Callee(callee) => {
                self.expect(Kind::Open)?;
                let mut args = vec![self.sum()?];
                while self
                    .next_sign(|sign| (sign == Kind::Comma).then_some(()))
                    .is_some()
                {
                    args.push(self.sum()?);
                }
                self.expect(Kind::Close)?;
                Some(self.push(Node::Call { callee, args }, span))
            }
            Meaning::If => {
                self.expect(Kind::Open)?;
                let selector = self.sum()?;
                self.expect(Kind::Colon)?;
                let negative = self.sum()?;
                self.expect(Kind::Comma)?;
                let zero = self.sum()?;
                self.expect(Kind::Comma)?;
                let positive = self.sum()?;
                self.expect(Kind::Close)?;
                let node = Node::If {
                    selector,
                    negative,
                    zero,
                    positive,
                };
                Some(self.push(node, span))
            }
            Meaning::Sign(_) => None,
        }
    }
}
