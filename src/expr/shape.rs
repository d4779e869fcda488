//! Shapes of expressions: texts that differ in their numbers, names and blanks alone have one tree.
//!
//! The grammar sees numbers and names as what they are, not which: which node is the child of which
//! follows from the kinds of the tokens. A model of a thousand variables has a handful of shapes.
//! So the grammar makes the tree of a shape when a thread meets it first; further texts of the
//! shape take it with the meanings and places of their own tokens. It is the tree that the grammar
//! would have made, to the last place.

use super::ast::{Dialect, Node};
use super::check::{Atom, Word};
use super::parse::Tree;
use super::token::Kind;
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

/// Most shapes that a thread remembers, and most tokens of one.
const MOST_SHAPES: usize = 256;
const MOST_WORDS: usize = 128;

thread_local! {
    /// the shapes that this thread has met
    static MET: RefCell<HashMap<Vec<u8>, Shape>> = RefCell::default();
}

/// The nodes of a tree, each with the index of the token at its place.
type Shape = Rc<[(Node, usize)]>;

/// Returns the tree of a text: that of its shape, or what the grammar makes of it; `None`: it
/// refuses the text.
pub(super) fn tree(
    dialect: Dialect,
    words: &[Word],
    by_grammar: impl FnOnce() -> Option<Tree>,
) -> Option<Tree> {
    if words.len() > MOST_WORDS {
        return by_grammar();
    }
    let key: Vec<u8> = std::iter::once(dialect as u8)
        .chain(words.iter().map(class))
        .collect();
    let met = MET.with_borrow(|met| met.get(&key).cloned());
    if let Some(tree) = met.and_then(|shape| filled(&shape, words)) {
        return Some(tree);
    }
    let tree = by_grammar()?;
    if let Some(shape) = shape(&tree, words) {
        MET.with_borrow_mut(|met| {
            if met.len() == MOST_SHAPES {
                met.clear();
            }
            met.insert(key, shape)
        });
    }
    Some(tree)
}

/// Returns the kind of a token, as far as the tree depends on it.
fn class(word: &Word) -> u8 {
    match (word.kind, word.atom) {
        (Kind::Number { .. }, _) => 0,
        (Kind::Name, None) => 1,
        (Kind::Name, Some(Atom::Constant(_))) => 2,
        (Kind::Name, Some(Atom::Named(_))) => 3,
        (Kind::Name, Some(Atom::Callee(_) | Atom::Number { .. })) => 4,
        (Kind::Plus, _) => 5,
        (Kind::Minus, _) => 6,
        (Kind::Times, _) => 7,
        (Kind::Over, _) => 8,
        (Kind::Power, _) => 9,
        (Kind::Open, _) => 10,
        (Kind::Close, _) => 11,
        (Kind::Comma, _) => 12,
        (Kind::Colon, _) => 13,
        (Kind::End, _) => 14,
    }
}

/// Returns the shape of a tree; `None`: a node does not stand at a token.
fn shape((nodes, spans): &Tree, words: &[Word]) -> Option<Shape> {
    let token = |start: usize| words.binary_search_by_key(&start, |w| w.span.start).ok();
    nodes
        .iter()
        .zip(spans)
        .map(|(node, span)| Some((node.clone(), token(span.start)?)))
        .collect()
}

/// Returns a shape with the meanings and places of these tokens.
fn filled(shape: &Shape, words: &[Word]) -> Option<Tree> {
    let mut spans = Vec::with_capacity(shape.len());
    let mut nodes = Vec::with_capacity(shape.len());
    for (node, token) in shape.iter() {
        let word = words.get(*token)?;
        spans.push(word.span);
        nodes.push(match (node, word.atom) {
            (Node::Number { .. }, Some(Atom::Number { literal, degrees })) => {
                Node::Number { literal, degrees }
            }
            (Node::Constant(_), Some(Atom::Constant(constant))) => Node::Constant(constant),
            (Node::Call { args, .. }, Some(Atom::Callee(callee))) => Node::Call {
                callee,
                args: args.clone(),
            },
            (Node::Named { args, .. }, Some(Atom::Named(entry))) => Node::Named {
                entry,
                args: args.clone(),
            },
            (Node::Number { .. } | Node::Constant(_), _) => return None,
            (Node::Call { .. } | Node::Named { .. }, _) => return None,
            (Node::Negate(_) | Node::Plus(_) | Node::Binary(..) | Node::If { .. }, _) => {
                node.clone()
            }
        });
    }
    Some((nodes, spans))
}
