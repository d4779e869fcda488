//! The grammars themselves (`grammar/function.pest`, `grammar/expression.pest`), read by pest: they define the languages.
//!
//! Every text that is parsed in a debug build, by a test or by a fuzz target is read by them as well, and must give the same tree
//! as the reader that is used (`parse.rs`), which is several times as fast.

use super::ast::{BinaryOp, Dialect, Node, NodeIx};
use super::check::{Meaning, Word};
use crate::diagnostic::Span;
use pest::Parser;
use pest::iterators::{Pair, Pairs};
use std::iter::Peekable;

/// Nodes and places of a text that has passed the check, by its grammar. `None`: the grammar refuses it.
pub(super) fn tree(text: &str, dialect: Dialect, words: &[Word]) -> Option<(Vec<Node>, Vec<Span>)> {
    match dialect {
        Dialect::Function => function::tree(text, words),
        Dialect::Expression => expression::tree(text, words),
    }
}

/// What a pair of either grammar is, where the tree needs to know.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    /// a whole expression, or one in parentheses or between separators: a flat list
    Sum,
    SumOperator,
    ProductOperator,
    PowerOperator,
    Sign,
    Number,
    /// a name with or without arguments
    Reference,
    Conditional,
    /// what the tree does not need
    Other,
}

/// One grammar: its parser, and what its rules are.
macro_rules! grammar {
    ($module:ident, $file:literal, $($conditional:ident)?) => {
        mod $module {
            use super::*;

            #[derive(pest_derive::Parser)]
            #[grammar = $file]
            struct Grammar;

            pub fn tree(text: &str, words: &[Word]) -> Option<(Vec<Node>, Vec<Span>)> {
                let whole = Grammar::parse(Rule::whole, text).ok()?.next()?;
                let mut builder = Builder::new(words, role);
                builder.operand(whole.into_inner().next()?)?;
                Some((builder.nodes, builder.spans))
            }

            fn role(rule: Rule) -> Role {
                match rule {
                    Rule::sum => Role::Sum,
                    Rule::sum_operator => Role::SumOperator,
                    Rule::product_operator => Role::ProductOperator,
                    Rule::power_operator => Role::PowerOperator,
                    Rule::sign => Role::Sign,
                    Rule::number => Role::Number,
                    Rule::reference => Role::Reference,
                    $(Rule::$conditional => Role::Conditional,)?
                    _ => Role::Other,
                }
            }
        }
    };
}
grammar!(function, "../grammar/function.pest", conditional);
grammar!(expression, "../grammar/expression.pest",);

/// The pairs of one level that are still to be read.
type Level<'i, R> = Peekable<Pairs<'i, R>>;

/// Makes nodes of pairs, children before parents. `None` anywhere: the pairs are not those of the grammar.
struct Builder<R> {
    meanings: std::vec::IntoIter<Meaning>,
    role: fn(R) -> Role,
    nodes: Vec<Node>,
    spans: Vec<Span>,
}

impl<R: pest::RuleType> Builder<R> {
    fn new(words: &[Word], role: fn(R) -> Role) -> Self {
        let named = |m: &Meaning| !matches!(m, Meaning::Sign(_) | Meaning::If);
        let meanings: Vec<Meaning> = words.iter().map(|w| w.meaning).filter(named).collect();
        Self {
            meanings: meanings.into_iter(),
            role,
            nodes: Vec::new(),
            spans: Vec::new(),
        }
    }

    fn is(&self, pair: &Pair<R>, role: Role) -> bool {
        (self.role)(pair.as_rule()) == role
    }

    fn push(&mut self, node: Node, span: Span) -> NodeIx {
        self.nodes.push(node);
        self.spans.push(span);
        (self.nodes.len() - 1) as NodeIx
    }

    /// The pairs of a sum: products with operators between them, from the left.
    fn sum(&mut self, pairs: &mut Level<R>) -> Option<NodeIx> {
        let mut left = self.product(pairs)?;
        while let Some(operator) = pairs.next_if(|p| self.is(p, Role::SumOperator)) {
            let op = if operator.as_str() == "+" {
                BinaryOp::Add
            } else {
                BinaryOp::Sub
            };
            let right = self.product(pairs)?;
            left = self.push(Node::Binary(op, left, right), place(&operator));
        }
        Some(left)
    }

    fn product(&mut self, pairs: &mut Level<R>) -> Option<NodeIx> {
        let mut left = self.unary(pairs)?;
        while let Some(operator) = pairs.next_if(|p| self.is(p, Role::ProductOperator)) {
            let op = if operator.as_str() == "*" {
                BinaryOp::Mul
            } else {
                BinaryOp::Div
            };
            let right = self.unary(pairs)?;
            left = self.push(Node::Binary(op, left, right), place(&operator));
        }
        Some(left)
    }

    fn unary(&mut self, pairs: &mut Level<R>) -> Option<NodeIx> {
        if let Some(sign) = pairs.next_if(|p| self.is(p, Role::Sign)) {
            let x = self.unary(pairs)?;
            let node = if sign.as_str() == "-" {
                Node::Negate(x)
            } else {
                Node::Plus(x)
            };
            return Some(self.push(node, place(&sign)));
        }
        let base = self.operand(pairs.next()?)?;
        let Some(operator) = pairs.next_if(|p| self.is(p, Role::PowerOperator)) else {
            return Some(base);
        };
        let exponent = self.unary(pairs)?;
        Some(self.push(
            Node::Binary(BinaryOp::Pow, base, exponent),
            place(&operator),
        ))
    }

    fn operand(&mut self, pair: Pair<R>) -> Option<NodeIx> {
        match (self.role)(pair.as_rule()) {
            Role::Sum => self.sum(&mut pair.into_inner().peekable()),
            Role::Number => {
                let Meaning::Number { literal, degrees } = self.meanings.next()? else {
                    return None;
                };
                Some(self.push(Node::Number { literal, degrees }, place(&pair)))
            }
            Role::Reference => self.reference(pair),
            Role::Conditional => self.conditional(pair),
            _ => None,
        }
    }

    /// A constant, or a call.
    fn reference(&mut self, pair: Pair<R>) -> Option<NodeIx> {
        let mut pairs = pair.into_inner();
        let span = place(&pairs.next()?);
        let callee = match self.meanings.next()? {
            Meaning::Constant(c) => return Some(self.push(Node::Constant(c), span)),
            Meaning::Callee(callee) => callee,
            _ => return None,
        };
        let args = pairs.map(|a| self.operand(a)).collect::<Option<Vec<_>>>()?;
        Some(self.push(Node::Call { callee, args }, span))
    }

    fn conditional(&mut self, pair: Pair<R>) -> Option<NodeIx> {
        let mut pairs = pair.into_inner();
        let span = place(&pairs.next()?);
        let selector = self.operand(pairs.next()?)?;
        let negative = self.operand(pairs.next()?)?;
        let zero = self.operand(pairs.next()?)?;
        let positive = self.operand(pairs.next()?)?;
        Some(self.push(
            Node::If {
                selector,
                negative,
                zero,
                positive,
            },
            span,
        ))
    }
}

fn place<R: pest::RuleType>(pair: &Pair<R>) -> Span {
    let span = pair.as_span();
    Span::new(span.start(), span.end())
}
