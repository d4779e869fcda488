//! Prepared functions as single steps: their rows, recorded, in place of a call.
//!
//! Value and slope are recorded by running the row over recording numbers and over duals of them. The ends of a step are jumped
//! to, as its row does over plain numbers.

use super::steps::Step;
use crate::expr::functions::prepared::{self, Prepared};
use crate::expr::functions::step::{cubic, quintic};
use crate::expr::program::operation::{BinaryOp, Node, UnaryOp, Value};
use crate::expr::program::{Builder, Folding, Input, Sym};
use crate::scalar::Dual;
use std::cell::RefCell;
use std::collections::HashMap;

use super::super::handlers::{ABS, ADD, DIV, MUL, SQRT, SUB};

/// Longest series that is written out.
const LONGEST: usize = 32;

/// A number in a formula of one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    Variable,
    Constant(f64),
    /// the result of the k-th operation
    Result(usize),
}

/// A formula of one variable: operations in order (code, operands), value and slope.
#[derive(Debug)]
pub(super) struct Formula {
    pub(super) operations: Vec<(u8, Number, Number)>,
    pub(super) value: Number,
    pub(super) slope: Number,
    /// before and behind which it is constant: x0, x1, h0, h1
    pub(super) ends: Option<[f64; 4]>,
}

/// The formula of a prepared function; `None` where it is called.
pub(super) fn formula(function: Prepared, parameters: &[f64], slope: bool) -> Option<Formula> {
    if parameters.len() > LONGEST {
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
        _ => return None,
    };
    let ends = if has_ends {
        let [x0, x1, h0, h1, ..] = *step?;
        Some([x0, x1, h0, h1])
    } else {
        None
    };
    let [value, slope] = [value, slope].map(|y| y.value(&mut cell.borrow_mut()));
    let builder = cell.into_inner();
    let mut list = List {
        builder: &builder,
        operations: Vec::new(),
        known: HashMap::new(),
    };
    let (value, slope) = (list.number(value)?, list.number(slope)?);
    Some(Formula {
        operations: list.operations,
        value,
        slope,
        ends,
    })
}

struct List<'a> {
    builder: &'a Builder,
    operations: Vec<(u8, Number, Number)>,
    known: HashMap<Value, Number>,
}

impl List<'_> {
    /// The number that a node is, its operations listed. Series are short, so that this may go as deep as they are long.
    fn number(&mut self, v: Value) -> Option<Number> {
        if let Some(&number) = self.known.get(&v) {
            return Some(number);
        }
        let number = match self.builder.nodes[v.index()] {
            Node::Constant(bits) => Number::Constant(f64::from_bits(bits)),
            Node::Input(_) => Number::Variable,
            Node::Binary(op, a, b) => {
                let code = match op {
                    BinaryOp::Add => ADD,
                    BinaryOp::Sub => SUB,
                    BinaryOp::Mul => MUL,
                    BinaryOp::Div => DIV,
                    _ => return None,
                };
                let (a, b) = (self.number(a)?, self.number(b)?);
                self.result(code, a, b)
            }
            Node::Unary(UnaryOp::Neg, a) => {
                let a = self.number(a)?;
                self.result(MUL, a, Number::Constant(-1.0))
            }
            Node::Unary(op @ (UnaryOp::Sqrt | UnaryOp::Abs), a) => {
                let a = self.number(a)?;
                self.result(if op == UnaryOp::Sqrt { SQRT } else { ABS }, a, a)
            }
            _ => return None,
        };
        self.known.insert(v, number);
        Some(number)
    }

    fn result(&mut self, code: u8, a: Number, b: Number) -> Number {
        self.operations.push((code, a, b));
        Number::Result(self.operations.len() - 1)
    }
}

/// Where the numbers of a formula are to be.
pub(super) struct Slots {
    pub(super) x: u32,
    pub(super) value: u32,
    /// where the slope is wanted
    pub(super) slope: Option<u32>,
    /// the value is added to what stands here
    pub(super) added: Option<u32>,
    /// first of the slots for results
    pub(super) between: u32,
    /// first of two labels that nobody else has
    pub(super) label: u32,
}

impl Formula {
    /// The steps that compute it; `constant` says where a number stands.
    pub(super) fn steps(
        &self,
        slots: &Slots,
        steps: &mut Vec<Step>,
        mut constant: impl FnMut(f64) -> u32,
    ) {
        let (middle, end) = (slots.label, slots.label + 1);
        if let Some([x0, x1, h0, h1]) = self.ends {
            let [x0, x1, h0, h1, zero] = [x0, x1, h0, h1, 0.0].map(&mut constant);
            let inner = slots.label + 2;
            // x ≤ x0, else x1 ≤ x, else between
            for (a, b, h, on) in [(slots.x, x0, h0, inner), (x1, slots.x, h1, middle)] {
                steps.push(Step::Unless {
                    comparison: 1,
                    a,
                    b,
                    target: on,
                });
                slots.results(h, zero, steps);
                steps.push(Step::Go { target: end });
                steps.push(Step::Label(on));
            }
        }
        for (k, &(code, a, b)) in self.operations.iter().enumerate() {
            let [a, b] = [a, b].map(|n| slots.of(n, &mut constant));
            let to = slots.between + k as u32;
            steps.push(Step::Arithmetic { code, a, b, to });
        }
        let [value, slope] = [self.value, self.slope].map(|n| slots.of(n, &mut constant));
        slots.results(value, slope, steps);
        if self.ends.is_some() {
            steps.push(Step::Label(end));
        }
    }
}

impl Slots {
    fn of(&self, number: Number, mut constant: impl FnMut(f64) -> u32) -> u32 {
        match number {
            Number::Variable => self.x,
            Number::Constant(c) => constant(c),
            Number::Result(k) => self.between + k as u32,
        }
    }

    /// Brings value and slope to where they are wanted; either may go where the variable stands.
    fn results(&self, value: u32, slope: u32, steps: &mut Vec<Step>) {
        let to = self.value;
        let value_step = match self.added {
            Some(a) => Step::Arithmetic {
                code: ADD,
                a,
                b: value,
                to,
            },
            None => Step::Copy { from: value, to },
        };
        let slope_step = self.slope.map(|to| Step::Copy { from: slope, to });
        if value == self.x {
            steps.push(value_step);
            steps.extend(slope_step);
        } else {
            steps.extend(slope_step);
            steps.push(value_step);
        }
    }
}
