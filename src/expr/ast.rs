//! The syntax tree of an expression: an arena of nodes with their places in the text, which prints
//! back to source.
//!
//! Nodes are indices into one vector, children before parents: traversal is a loop or a recursion
//! of bounded depth, and dropping never recurses.

use super::functions::Function;
use super::interpolation::Interpolation;
use super::measures::Measure;
use super::names::Names;
use crate::diagnostic::Span;
use std::sync::Arc;

/// Index of a node in its [`Ast`].
pub type NodeIx = u32;

/// The language of a text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Dialect {
    /// direct-entry functions: radians, `TIME`, degree suffix `D`, arithmetic IF
    #[default]
    Function,
    /// I-DEAS expression functions: degrees, `t`
    Expression,
}

/// A named number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Constant {
    /// simulation time (`TIME`; `t` in the expression dialect)
    Time,
    /// π
    Pi,
    /// π/180
    Dtor,
    /// 180/π
    Rtod,
    /// code of the running analysis (1 kinematic, 3 initial conditions, 4 dynamic, 5 static, 6
    /// quasi-static, 7 linear)
    Mode,
}

/// An operator with two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BinaryOp {
    /// `+`
    Add,
    /// `-`
    Sub,
    /// `*`
    Mul,
    /// `/`
    Div,
    /// `**`
    Pow,
}

/// The target of a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Callee {
    /// a function of numbers
    Function(Function),
    /// a function of the model, whose arguments are identifiers
    Measure(Measure),
    /// a curve through data: number arguments and an identifier
    Interpolation(Interpolation),
}

/// A node of the tree.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// A literal. With `degrees` it carried the suffix D, and its value is `literal·π/180`.
    Number {
        /// the number before the suffix
        literal: f64,
        /// whether the suffix D follows
        degrees: bool,
    },
    /// A named number.
    Constant(Constant),
    /// `-x`
    Negate(NodeIx),
    /// `+x`
    Plus(NodeIx),
    /// `a op b`
    Binary(BinaryOp, NodeIx, NodeIx),
    /// `IF(selector: negative, zero, positive)`
    If {
        /// e1
        selector: NodeIx,
        /// the value where e1 < 0
        negative: NodeIx,
        /// the value where e1 = 0
        zero: NodeIx,
        /// the value where e1 > 0
        positive: NodeIx,
    },
    /// `NAME(args)`; identifiers and selectors are `Number` nodes
    Call {
        /// the function, measure or interpolation
        callee: Callee,
        /// the arguments that were written
        args: Vec<NodeIx>,
    },
    /// a variable, a constant or a function of the caller's own
    Named {
        /// index in the names of the tree
        entry: u32,
        /// the arguments of a function
        args: Vec<NodeIx>,
    },
}

/// The syntax tree of an expression.
#[derive(Clone, Debug)]
pub struct Ast {
    /// language of the text
    pub dialect: Dialect,
    /// all nodes, children before parents
    pub nodes: Vec<Node>,
    /// place of each node in the text: of a binary operator the operator itself, of a call its name
    pub spans: Vec<Span>,
    /// node of the whole expression
    pub root: NodeIx,
    /// names of the caller's own
    pub names: Arc<Names>,
}

impl Ast {
    /// Returns whether its value needs one of the host for any numbers; false where an IF may pass
    /// it by.
    #[cfg(feature = "solver")]
    pub(crate) fn certainly_reads(&self) -> bool {
        let has_if = self.nodes.iter().any(|n| matches!(n, Node::If { .. }));
        let reads = |node: &Node| match node {
            Node::Constant(Constant::Time | Constant::Mode) => true,
            Node::Call { callee, .. } => matches!(callee, Callee::Measure(_)),
            _ => false,
        };
        !has_if && self.nodes.iter().any(reads)
    }

    /// Returns the node at an index.
    pub fn node(&self, ix: NodeIx) -> &Node {
        &self.nodes[ix as usize]
    }
}
