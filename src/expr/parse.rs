//! The parser from text to [`Ast`]: first the ordered check, then the grammar, whose pairs become
//! nodes.
//!
//! The grammars (`grammar/function.pest`, `grammar/expression.pest`) define the languages and make
//! the tree. The check has determined the meaning of names and numbers in the order of the text;
//! the pairs take them in that order. Texts whose tokens are of the same kinds have the same tree
//! (`shape.rs`).

use super::advice;
use super::ast::{Ast, BinaryOp, Dialect, Node, NodeIx};
use super::check::{Atom, Limits, Word, check};
use super::names::Names;
use super::shape;
use super::symbols::Profile;
use crate::diagnostic::{Diagnostic, Span};
use pest::Parser;
use pest::iterators::{Pair, Pairs};
use std::iter::Peekable;
use std::sync::Arc;

/// Reads a text of one of the two languages.
///
/// # Errors
/// The first mistake in the text, from left to right: the code of the diagnostic is its kind, its
/// column counts all characters of the text from 1.
pub fn parse(text: &str, dialect: Dialect, profile: Profile) -> Result<Ast, Diagnostic> {
    read(
        text,
        dialect,
        profile,
        profile.limits(),
        &Arc::new(Names::of(dialect)),
    )
}

/// Reads like [`parse`], with limits of the caller's own.
///
/// # Errors
/// The first mistake in the text; exceeding a limit is one.
pub fn parse_with_limits(
    text: &str,
    dialect: Dialect,
    profile: Profile,
    limits: Limits,
) -> Result<Ast, Diagnostic> {
    read(
        text,
        dialect,
        profile,
        limits,
        &Arc::new(Names::of(dialect)),
    )
}

/// Reads like [`parse`], with names of the caller's own.
pub(super) fn parse_named(
    text: &str,
    dialect: Dialect,
    profile: Profile,
    names: &Arc<Names>,
) -> Result<Ast, Diagnostic> {
    read(text, dialect, profile, profile.limits(), names)
}

/// Reads a text: checks it, then makes the tree.
fn read(
    text: &str,
    dialect: Dialect,
    profile: Profile,
    limits: Limits,
    names: &Arc<Names>,
) -> Result<Ast, Diagnostic> {
    let words = check(text, dialect, profile, limits, names)
        .map_err(|fault| advice::explain(text, dialect, names, &fault))?;
    let tree = shape::tree(dialect, &words, || by_grammar(text, dialect, &words));
    let (nodes, spans) = tree.ok_or_else(|| {
        // The check and the grammar disagree: a bug of ours, yet the text cannot be read.
        debug_assert!(
            false,
            "the grammar refuses what the check accepts: {text:?}"
        );
        Diagnostic::error("unexpected_token", "this cannot be read as an expression")
            .at(text, Span::new(0, text.len()))
    })?;
    let root = (nodes.len() - 1) as NodeIx;
    Ok(Ast {
        dialect,
        nodes,
        spans,
        root,
        names: names.clone(),
    })
}

/// The nodes of a tree, children before parents, and their places.
pub(super) type Tree = (Vec<Node>, Vec<Span>);

/// Returns the tree of a text as its grammar makes it; `None`: the grammar refuses the text.
fn by_grammar(text: &str, dialect: Dialect, words: &[Word]) -> Option<Tree> {
    let atoms = words.iter().filter_map(|w| w.atom).collect();
    match dialect {
        Dialect::Function => function::tree(text, atoms),
        Dialect::Expression => expression::tree(text, atoms),
    }
}

/// The role of a pair of either grammar, as far as the tree depends on it.
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
    /// anything that leaves no trace in the tree
    Other,
}

/// Defines one grammar: its parser, and the roles of its rules.
macro_rules! grammar {
    ($module:ident, $file:literal, $($conditional:ident)?) => {
        mod $module {
            use super::*;

            #[derive(pest_derive::Parser)]
            #[grammar = $file]
            struct Grammar;

            pub fn tree(text: &str, atoms: Vec<Atom>) -> Option<Tree> {
                let whole = Grammar::parse(Rule::whole, text).ok()?.next()?;
                let mut builder = Builder::new(atoms, role);
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

/// The pairs of one level that remain to be read.
type Level<'i, R> = Peekable<Pairs<'i, R>>;

/// The construction of nodes from pairs, children before parents. `None` anywhere: the pairs are
/// not those of the grammar.
struct Builder<R> {
    /// meanings of names and numbers that have not been used yet
    atoms: std::vec::IntoIter<Atom>,
    /// role of a rule
    role: fn(R) -> Role,
    nodes: Vec<Node>,
    spans: Vec<Span>,
}

impl<R: pest::RuleType> Builder<R> {
    fn new(atoms: Vec<Atom>, role: fn(R) -> Role) -> Self {
        let capacity = 2 * atoms.len();
        Self {
            atoms: atoms.into_iter(),
            role,
            nodes: Vec::with_capacity(capacity),
            spans: Vec::with_capacity(capacity),
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

    /// Reads the pairs of a sum: products with operators between them, from the left.
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

    /// Reads a product: unary terms with operators between them, from the left.
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

    /// Reads signs, and a power from the right.
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

    /// Reads an operand: a number, a name, or a group.
    fn operand(&mut self, pair: Pair<R>) -> Option<NodeIx> {
        match (self.role)(pair.as_rule()) {
            Role::Sum => self.sum(&mut pair.into_inner().peekable()),
            Role::Number => {
                let Atom::Number { literal, degrees } = self.atoms.next()? else {
                    return None;
                };
                Some(self.push(Node::Number { literal, degrees }, place(&pair)))
            }
            Role::Reference => self.reference(pair),
            Role::Conditional => self.conditional(pair),
            _ => None,
        }
    }

    /// Reads a constant, or a call.
    fn reference(&mut self, pair: Pair<R>) -> Option<NodeIx> {
        let mut pairs = pair.into_inner();
        let span = place(&pairs.next()?);
        let callee = match self.atoms.next()? {
            Atom::Constant(c) => return Some(self.push(Node::Constant(c), span)),
            Atom::Callee(callee) => callee,
            Atom::Named(entry) => {
                let args = pairs.map(|a| self.operand(a)).collect::<Option<Vec<_>>>()?;
                return Some(self.push(Node::Named { entry, args }, span));
            }
            Atom::Number { .. } => return None,
        };
        let args = pairs.map(|a| self.operand(a)).collect::<Option<Vec<_>>>()?;
        Some(self.push(Node::Call { callee, args }, span))
    }

    /// Reads an IF.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Random legal texts, made of bytes of a generator: numbers, names and blanks vary, so that
    /// shapes come by again.
    struct Texts(u64);

    impl Texts {
        fn pick(&mut self, n: u64) -> u64 {
            let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
            self.0 = next.wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 33) % n
        }

        fn one_of(&mut self, words: &[&str]) -> String {
            words[self.pick(words.len() as u64) as usize].to_string()
        }

        fn sum(&mut self, depth: u64) -> String {
            let mut text = self.operand(depth);
            for _ in 0..self.pick(3) {
                text += &self.one_of(&[" + ", "-", "*", " /", "**", "*-", "** - "]);
                text += &self.operand(depth);
            }
            text
        }

        fn operand(&mut self, depth: u64) -> String {
            let kinds = if depth == 0 { 3 } else { 8 };
            let inner = |texts: &mut Self| texts.sum(depth - 1);
            match self.pick(kinds) {
                0 => self.one_of(&["1", "2.5", ".5E-3", "30D", "7.e2", "0", "1D"]),
                1 => self.one_of(&["TIME", "PI", "dtor", "MODE"]),
                2 => self.one_of(&["WM(3)", "DX(1, 2)", "VZ(1,2,3,4)", "varval(7)"]),
                3 => format!("({} )", inner(self)),
                4 => format!("-{}", self.operand(0)),
                5 => {
                    let (a, b) = (inner(self), inner(self));
                    self.one_of(&["MOD", "sign", "ATAN2"]) + &format!("({a},{b})")
                }
                6 => self.one_of(&["SIN", "ABS", "sqrt "]) + &format!("({})", inner(self)),
                _ => {
                    let parts = [(); 4].map(|()| self.sum(depth - 1));
                    let [a, b, c, d] = parts;
                    format!("IF({a}: {b},{c}\n, {d})")
                }
            }
        }
    }

    #[test]
    fn trees_of_shapes_are_those_of_the_grammar() {
        let (mut texts, names) = (Texts(7), Arc::new(Names::of(Dialect::Function)));
        for k in 0..3000 {
            let text = texts.sum(k % 3);
            let limits = Limits::NONE;
            let words = check(&text, Dialect::Function, Profile::Adams, limits, &names);
            let grammar = words
                .ok()
                .and_then(|w| by_grammar(&text, Dialect::Function, &w));
            let found = parse(&text, Dialect::Function, Profile::Adams).ok();
            let found = found.map(|tree| (tree.nodes, tree.spans));
            assert_eq!(found, grammar, "{text}");
            assert!(grammar.is_some(), "{text}");
        }
    }
}
