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
