//! Where a program changes branch: the differences whose signs its comparisons and IFs ask for.

use super::Builder;
use super::operation::{BinaryOp, Comparison, Node, UnaryOp, Value};

impl Builder {
    /// Values that change sign where one of the outputs changes branch, each once, in the order of recording.
    ///
    /// For `a < b` and `a ≤ b` that is `a − b`, for IF its selector, for |x| its argument. Comparisons for equality are left
    /// out: they hold at isolated points only.
    pub fn switching(&mut self, outputs: &[Value]) -> Vec<Value> {
        let mut needed = vec![false; self.nodes.len()];
        for v in outputs {
            needed[v.index()] = true;
        }
        let mut found = Vec::new();
        for k in (0..self.nodes.len()).rev() {
            if !needed[k] {
                continue;
            }
            let node = self.nodes[k];
            self.operands(&node, |v| needed[v.index()] = true);
            match node {
                Node::Compare(Comparison::Lt | Comparison::Le, a, b) => found.push((a, Some(b))),
                Node::If(first) => found.push((self.arguments[first as usize], None)),
                Node::Unary(UnaryOp::Abs, x) => found.push((x, None)),
                _ => {}
            }
        }
        found.reverse();
        let mut values: Vec<Value> = Vec::new();
        for (a, b) in found {
            let difference = match b {
                Some(b) => self.binary(BinaryOp::Sub, a, b),
                None => a,
            };
            if self.constant_of(difference).is_none() && !values.contains(&difference) {
                values.push(difference);
            }
        }
        values
    }
}
