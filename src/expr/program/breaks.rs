//! Where a program may stop being smooth: comparisons, roundings, knots of tables, poles and edges
//! of domains.

use super::builder::Builder;
use super::expand::Expand;
use super::input::Input;
use super::node::{Node, Value};
use super::operation::{BinaryOp, Edges};
use crate::scalar::Table;
use std::sync::Arc;

/// A value at which a program may stop being smooth.
#[derive(Clone, Debug)]
pub(crate) struct Break {
    /// what must reach a level
    pub(crate) value: Value,
    /// the levels
    pub(crate) levels: Levels,
}

/// Where a value makes a program break.
#[derive(Clone, Debug)]
pub(crate) enum Levels {
    /// at zero
    Zero,
    /// at every whole number
    Whole,
    /// halfway between whole numbers
    Halves,
    /// where the pieces of a table meet
    Knots(Arc<dyn Table>),
}

impl Builder {
    /// Returns the output with calls expanded into operations, and all values at whose levels it
    /// may break: where a comparison turns, at steps of roundings, at knots of tables, at poles and
    /// at the edges of domains. More than enough: not all of them are breaks.
    pub(crate) fn breaks(&mut self, output: Value) -> (Value, Vec<Break>) {
        let output = self.expanded(&[output], Expand::Calls)[0];
        let mut needed = vec![false; output.index() + 1];
        needed[output.index()] = true;
        let mut found = Vec::new();
        for k in (0..=output.index()).rev() {
            if !needed[k] {
                continue;
            }
            let node = self.nodes[k];
            self.operands(&node, |v| needed[v.index()] = true);
            self.breaks_of(&node, &mut found);
        }
        found.reverse();
        let mut breaks: Vec<Break> = Vec::new();
        for new in found {
            let constant = self.constant_of(new.value).is_some();
            if !constant
                && !breaks
                    .iter()
                    .any(|b| self.has_level_with(b, &new) && b.levels.are(&new.levels))
            {
                breaks.push(new);
            }
        }
        (output, breaks)
    }

    /// Returns whether two values are at their levels together: they are one value, or a difference
    /// and its contrary.
    fn has_level_with(&self, one: &Break, other: &Break) -> bool {
        let difference = |v: Value| match self.nodes[v.index()] {
            Node::Binary(BinaryOp::Sub, a, b) => Some((a, b)),
            _ => None,
        };
        one.value == other.value
            || !matches!(one.levels, Levels::Knots(_))
                && difference(one.value)
                    .is_some_and(|(a, b)| difference(other.value) == Some((b, a)))
    }

    pub(super) fn breaks_of(&mut self, node: &Node, found: &mut Vec<Break>) {
        let mut at = |value: Value, levels: Levels| found.push(Break { value, levels });
        match *node {
            Node::Compare(_, a, b) => at(self.binary(BinaryOp::Sub, a, b), Levels::Zero),
            Node::If(first) => at(self.arguments[first as usize], Levels::Zero),
            Node::Unary(op, x) => match op.edges() {
                Edges::Nowhere => {}
                Edges::Zero => at(x, Levels::Zero),
                Edges::Whole => at(x, Levels::Whole),
                Edges::Halves => at(x, Levels::Halves),
                Edges::Poles => {
                    let half_turns = self.constant(std::f64::consts::FRAC_1_PI);
                    at(self.binary(BinaryOp::Mul, x, half_turns), Levels::Halves);
                }
                Edges::PlusMinusOne => {
                    let one = self.constant(1.0);
                    at(self.binary(BinaryOp::Sub, x, one), Levels::Zero);
                    at(self.binary(BinaryOp::Add, x, one), Levels::Zero);
                }
            },
            Node::Binary(op, a, b) => match op {
                BinaryOp::Atan2 | BinaryOp::Pow => at(a, Levels::Zero),
                BinaryOp::Rem => at(self.binary(BinaryOp::Div, a, b), Levels::Whole),
                BinaryOp::Div | BinaryOp::Along => at(b, Levels::Zero),
                BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::And | BinaryOp::Or => {}
                BinaryOp::Kept => {}
            },
            Node::Whole(x, n) => {
                if n < 0 {
                    at(x, Levels::Zero);
                }
            }
            Node::Lookup { table, x, .. } => {
                let table = self.tables[table as usize].clone();
                if !table.knots().is_empty() {
                    at(x, Levels::Knots(table));
                }
            }
            // calls are expanded before, and a selection breaks where its condition does
            Node::Constant(_)
            | Node::Input(_)
            | Node::Select(..)
            | Node::Call { .. }
            | Node::Partial { .. } => {}
        }
    }

    /// Returns the inputs that values read, in the order of asking.
    pub(crate) fn inputs_of(&self, values: &[Value]) -> Vec<Input> {
        let n = values.iter().map(|v| v.index() + 1).max().unwrap_or(0);
        let mut needed = vec![false; n];
        for v in values {
            needed[v.index()] = true;
        }
        let mut read = Vec::new();
        for k in (0..n).rev() {
            if needed[k] {
                match self.nodes[k] {
                    Node::Input(input) => read.push(input),
                    node => self.operands(&node, |v| needed[v.index()] = true),
                }
            }
        }
        read.sort_unstable();
        read.dedup();
        read.iter().map(|&k| self.inputs[k as usize]).collect()
    }
}

impl Levels {
    pub(super) fn are(&self, other: &Levels) -> bool {
        match (self, other) {
            (Levels::Zero, Levels::Zero)
            | (Levels::Whole, Levels::Whole)
            | (Levels::Halves, Levels::Halves) => true,
            (Levels::Knots(a), Levels::Knots(b)) => a.knots() == b.knots(),
            _ => false,
        }
    }

    /// Returns which place between the levels a number has: odd between two of them, even on one.
    pub(crate) fn place(&self, x: f64) -> f64 {
        let whole = |x: f64| 2.0 * x.floor() + f64::from(u8::from(x != x.floor()));
        match self {
            _ if x.is_nan() => f64::NAN,
            Levels::Zero if x == 0.0 => 0.0,
            Levels::Zero => x.signum(),
            Levels::Whole => whole(x),
            Levels::Halves => whole(x - 0.5),
            Levels::Knots(table) => {
                let knots = table.knots();
                let below = knots.partition_point(|&k| k < x);
                let on = knots.get(below) == Some(&x);
                2.0 * below as f64 + if on { 0.0 } else { -1.0 }
            }
        }
    }

    /// Returns the nearest level.
    pub(crate) fn nearest(&self, x: f64) -> f64 {
        match self {
            Levels::Zero => 0.0,
            Levels::Whole => x.round(),
            Levels::Halves => x.floor() + 0.5,
            Levels::Knots(table) => {
                let distance = |k: &f64| (k - x).abs();
                let near = |a: &&f64, b: &&f64| distance(a).total_cmp(&distance(b));
                table
                    .knots()
                    .iter()
                    .min_by(near)
                    .copied()
                    .unwrap_or(f64::NAN)
            }
        }
    }
}

/// The words behind the switching function: nothing for zero.
impl std::fmt::Display for Levels {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Levels::Zero => "",
            Levels::Whole => " at whole numbers",
            Levels::Halves => " halfway between whole numbers",
            Levels::Knots(_) => " at the knots of a table",
        })
    }
}
