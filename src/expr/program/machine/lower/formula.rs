//! Prepared functions written out as steps: their rows, recorded, in place of a call.
//!
//! Value and slope are recorded by running the row over recording numbers and over duals of them.
//! The ends of a step are jumped to, as its row does over plain numbers.

use super::super::super::builder::{Builder, Folding};
use super::super::super::input::Input;
use super::super::super::node::{Node, Value};
use super::super::super::operation::{BinaryOp, UnaryOp};
use super::super::super::record::Sym;
use crate::expr::functions::prepared::{self, Prepared};
use crate::expr::functions::step::{cubic, quintic};
use crate::expr::program::hashing::HashMap;
use crate::scalar::Dual;
use std::cell::RefCell;

/// Longest list of parameters of a function that is written out.
const MOST_PARAMETERS: usize = 32;

/// A number in a formula of one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    Variable,
    Constant(f64),
    /// the result of the k-th operation
    Result(usize),
}

/// An operation of a formula.
#[derive(Clone, Copy, Debug)]
pub(super) enum Operation {
    Unary(UnaryOp, Number),
    Binary(BinaryOp, Number, Number),
}

impl Operation {
    pub(super) fn operands(&self) -> impl Iterator<Item = Number> {
        let (operands, n) = match *self {
            Operation::Unary(_, a) => ([a, a], 1),
            Operation::Binary(_, a, b) => ([a, b], 2),
        };
        operands.into_iter().take(n)
    }
}

/// A formula of one variable: operations in order, value and slope.
#[derive(Debug)]
pub(super) struct Formula {
    pub(super) operations: Vec<Operation>,
    pub(super) value: Number,
    pub(super) slope: Number,
    /// before and behind which it is constant: x0, x1, h0, h1
    pub(super) ends: Option<[f64; 4]>,
}

impl Formula {
    /// Returns the formula of a prepared function, and of its slope if that is wanted; `None` where
    /// it is called.
    pub(super) fn of(function: Prepared, parameters: &[f64], slope: bool) -> Option<Formula> {
        if parameters.len() > MOST_PARAMETERS {
            return None;
        }
        let step: Option<&[f64; 6]> = parameters.try_into().ok();
        let cell = RefCell::new(Builder::new(Folding::Strict));
        let x = Sym::input(Input::Slot(0), &cell);
        macro_rules! record {
            ($row:path, $p:expr $(, $shape:ident)?) => {
                if slope {
                    let y = $row(Dual::<1, Sym>::variable(x, 0), $p $(, $shape)?);
                    [y.re, y.eps[0]]
                } else {
                    let y = $row(x, $p $(, $shape)?);
                    [y, y]
                }
            };
        }
        let ([value, slope], has_ends) = match function {
            Prepared::Step => (record!(prepared::rising, step?, cubic), true),
            Prepared::Step5 => (record!(prepared::rising, step?, quintic), true),
            Prepared::Poly => (record!(prepared::poly, parameters), false),
            Prepared::Cheby => (record!(prepared::cheby, parameters), false),
            Prepared::Havsin
            | Prepared::Forcos
            | Prepared::Forsin
            | Prepared::Impact(_)
            | Prepared::Bistop(_) => return None,
        };
        let ends = if has_ends {
            let [x0, x1, h0, h1, ..] = *step?;
            Some([x0, x1, h0, h1])
        } else {
            None
        };
        let [value, slope] = [value, slope].map(|y| y.value(&mut cell.borrow_mut()));
        let mut list = List {
            builder: &cell.into_inner(),
            operations: Vec::new(),
            known: HashMap::default(),
        };
        let (value, slope) = (list.number(value)?, list.number(slope)?);
        Some(Formula {
            operations: list.operations,
            value,
            slope,
            ends,
        })
    }
}

struct List<'a> {
    builder: &'a Builder,
    operations: Vec<Operation>,
    known: HashMap<Value, Number>,
}

impl List<'_> {
    /// Lists the operations of a node; they are few, so that this may go as deep as they are many.
    fn number(&mut self, v: Value) -> Option<Number> {
        if let Some(&number) = self.known.get(&v) {
            return Some(number);
        }
        let number = match self.builder.nodes[v.index()] {
            Node::Constant(bits) => Number::Constant(f64::from_bits(bits)),
            Node::Input(_) => Number::Variable,
            Node::Binary(op, a, b) => {
                let (a, b) = (self.number(a)?, self.number(b)?);
                self.result(Operation::Binary(op, a, b))
            }
            Node::Unary(UnaryOp::Neg, a) => {
                // −a is a·(−1), to the bit
                let a = self.number(a)?;
                self.result(Operation::Binary(BinaryOp::Mul, a, Number::Constant(-1.0)))
            }
            Node::Unary(op, a) => {
                let a = self.number(a)?;
                self.result(Operation::Unary(op, a))
            }
            Node::Whole(..)
            | Node::Compare(..)
            | Node::Select(..)
            | Node::If(_)
            | Node::Lookup { .. }
            | Node::Call { .. }
            | Node::Partial { .. } => return None,
        };
        self.known.insert(v, number);
        Some(number)
    }

    fn result(&mut self, operation: Operation) -> Number {
        self.operations.push(operation);
        Number::Result(self.operations.len() - 1)
    }
}
