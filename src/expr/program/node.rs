//! The nodes of a recording: what was done to which values.

use super::operation::{BinaryOp, Comparison, UnaryOp};
use crate::expr::functions::Function;

/// A value in a [`Builder`](super::Builder): the index of the node that yields it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Value(pub(crate) u32);

impl Value {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// One node of a builder. Operands stand before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Node {
    /// bits of the number
    Constant(u64),
    /// position among the inputs of the builder
    Input(u32),
    Unary(UnaryOp, Value),
    Whole(Value, i32),
    Binary(BinaryOp, Value, Value),
    Compare(Comparison, Value, Value),
    Select(Value, Value, Value),
    /// position of (selector, negative, zero, positive) in the list of arguments
    If(u32),
    Lookup {
        table: u32,
        order: u32,
        x: Value,
    },
    /// position and number of the arguments in the list of arguments
    Call {
        function: Function,
        first: u32,
        count: u32,
    },
    /// the `k`-th partial derivative of a call
    Partial {
        call: Value,
        k: u32,
    },
}

impl Node {
    /// Returns where its operands stand in the list of arguments.
    pub(super) fn list(&self) -> Option<std::ops::Range<usize>> {
        match *self {
            Node::If(first) => Some(first as usize..first as usize + 4),
            Node::Call { first, count, .. } => Some(first as usize..(first + count) as usize),
            _ => None,
        }
    }
}

/// Returns whether two nodes differ as constants do, or not at all.
pub(super) fn is_alike((a, b): (&Node, &Node)) -> bool {
    matches!((a, b), (Node::Constant(_), Node::Constant(_))) || a == b
}

/// Returns a number in which structures differ that are not alike: operands of the nodes, whose
/// kinds are compared.
pub(super) fn hash(nodes: &[Node], outputs: &[Value]) -> u64 {
    let mix = |h: u64, word: u32| {
        (h.rotate_left(5) ^ u64::from(word)).wrapping_mul(0x9E37_79B9_7F4A_7C15)
    };
    let mut h = nodes.len() as u64;
    for node in nodes {
        match *node {
            Node::Binary(_, a, b) => h = mix(mix(h, a.0), b.0),
            Node::Unary(_, a) | Node::Whole(a, _) => h = mix(h, a.0),
            Node::Select(c, yes, no) => h = mix(mix(mix(h, c.0), yes.0), no.0),
            _ => {}
        }
    }
    outputs.iter().fold(h, |h, v| mix(h, v.0))
}
