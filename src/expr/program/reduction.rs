//! A builder reduced to what some values need, in the same order.
//!
//! Several programs may be recorded into one builder, and each needs a part of its nodes. What
//! follows a recording takes time for each node that there is.

use super::builder::Builder;
use super::node::{Node, Value};

/// Part of the nodes from which on nothing is gained by leaving the others out.
const NEARLY_ALL: f64 = 0.8;
/// Place of a node that is not needed.
const NONE: Value = Value(u32::MAX);

/// The part of a builder that some values need. Its nodes stand in the same order; it is there to
/// be read, as it does not find equal nodes again.
pub(super) struct Part {
    pub builder: Builder,
    /// these values in it
    pub values: Vec<Value>,
    /// what its nodes are in the whole
    pub origins: Vec<Value>,
}

impl Builder {
    /// Returns the part of the builder that some values need. `None`: they need nearly all of it.
    pub(super) fn reduced(&self, values: &[Value]) -> Option<Part> {
        let n = values.iter().map(|v| v.index() + 1).max().unwrap_or(0);
        let needed = self.read(values, n);
        let n_needed = needed.iter().filter(|&&n| n).count();
        if n_needed as f64 >= NEARLY_ALL * self.nodes.len() as f64 {
            return None;
        }
        let mut part = Builder::new(self.folding());
        part.inputs.clone_from(&self.inputs);
        part.tables.clone_from(&self.tables);
        part.n_components = self.n_components;
        part.nodes.reserve(n_needed);
        let mut places = vec![NONE; n];
        let mut origins = Vec::with_capacity(n_needed);
        for k in (0..n).filter(|&k| needed[k]) {
            let node = self.copied(&self.nodes[k], &places, &mut part.arguments);
            places[k] = Value(part.nodes.len() as u32);
            part.nodes.push(node);
            origins.push(Value(k as u32));
        }
        Some(Part {
            builder: part,
            values: values.iter().map(|v| places[v.index()]).collect(),
            origins,
        })
    }

    /// Returns how many operations a value takes.
    #[cfg(feature = "solver")]
    pub(crate) fn cost(&self, value: Value) -> usize {
        let needed = self.needed(&[value], value.index() + 1);
        let is_free = |node: &Node| matches!(node, Node::Constant(_) | Node::Input(_));
        let nodes = needed.iter().zip(&self.nodes);
        nodes.filter(|(n, node)| **n && !is_free(node)).count()
    }

    /// Returns which of the first `n` nodes some values need, calls included of which they need a
    /// derivative alone.
    pub(super) fn read(&self, values: &[Value], n: usize) -> Vec<bool> {
        let mut needed = vec![false; n];
        for v in values {
            needed[v.index()] = true;
        }
        for k in (0..n).rev() {
            if !needed[k] {
                continue;
            }
            if let Node::Partial { call, .. } = self.nodes[k] {
                // what it is a derivative of is read, though it need not be computed
                needed[call.index()] = true;
            }
            self.operands(&self.nodes[k], |v| needed[v.index()] = true);
        }
        needed
    }

    /// Returns a node with its operands at their new places, and lists its arguments.
    pub(super) fn copied(&self, node: &Node, places: &[Value], arguments: &mut Vec<Value>) -> Node {
        let of = |v: Value| places[v.index()];
        let listed = arguments.len() as u32;
        if let Some(range) = node.list() {
            arguments.extend(self.arguments[range].iter().map(|&v| of(v)));
        }
        match *node {
            Node::Constant(_) | Node::Input(_) => *node,
            Node::Unary(op, x) => Node::Unary(op, of(x)),
            Node::Whole(x, n) => Node::Whole(of(x), n),
            Node::Binary(op, a, b) => Node::Binary(op, of(a), of(b)),
            Node::Compare(op, a, b) => Node::Compare(op, of(a), of(b)),
            Node::Select(c, yes, no) => Node::Select(of(c), of(yes), of(no)),
            Node::If(_) => Node::If(listed),
            Node::Lookup { table, order, x } => Node::Lookup {
                table,
                order,
                x: of(x),
            },
            Node::Call {
                function, count, ..
            } => Node::Call {
                function,
                first: listed,
                count,
            },
            Node::Partial { call, k } => Node::Partial { call: of(call), k },
        }
    }
}
