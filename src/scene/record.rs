//! A number that writes down what is done with it.
//!
//! The equations of a scene are generic over the scalar. Run once over [`Sym`], they leave a straight-line program that
//! computes the same numbers: products with known zeros are gone, equal parts are computed once, and what no output
//! needs is dropped. That program is what the solver runs; a planar mechanism gets planar code without anybody having
//! written it.

use crate::expr::program::{BinaryOp, Builder, Comparison, Folding, Input, Program, UnaryOp, Value};
use crate::scalar::{Mask, Scalar, Table};
use std::cell::RefCell;
use std::sync::Arc;

/// Keeps the operations in the order in which they were done.
#[derive(Debug)]
pub struct Recorder {
    builder: RefCell<Builder>,
}

impl Default for Recorder {
    fn default() -> Self {
        Self::new()
    }
}

impl Recorder {
    /// An empty record that treats zero and one as structure.
    pub fn new() -> Self {
        Self { builder: RefCell::new(Builder::new(Folding::Structural)) }
    }
    /// A number that the host will supply.
    pub fn input(&self, input: Input) -> Sym<'_> {
        Sym::Node(self, self.builder.borrow_mut().input(input))
    }
    /// The program that computes `outputs`; its inputs come in the order of `layout`.
    pub fn finish(&self, outputs: &[Sym<'_>], layout: &[Input]) -> Program {
        let mut builder = self.builder.borrow_mut();
        let outputs: Vec<Value> = outputs
            .iter()
            .map(|s| match s {
                Sym::Known(x) => builder.constant(*x),
                Sym::Node(_, v) => *v,
            })
            .collect();
        builder.finish_with_inputs(&outputs, layout)
    }
    /// How much has been recorded.
    pub fn len(&self) -> usize {
        self.builder.borrow().len()
    }
    /// Whether nothing has been recorded.
    pub fn is_empty(&self) -> bool {
        self.builder.borrow().is_empty()
    }

    fn wrap(&self, v: Value) -> Sym<'_> {
        match self.builder.borrow().constant_of(v) {
            Some(x) => Sym::Known(x),
            None => Sym::Node(self, v),
        }
    }
}

/// A known number, or a node of a record.
#[derive(Clone, Copy)]
pub enum Sym<'r> {
    /// a constant
    Known(f64),
    /// the result of an operation
    Node(&'r Recorder, Value),
}

impl std::fmt::Debug for Sym<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Sym::Known(x) => write!(f, "{x}"),
            Sym::Node(_, v) => write!(f, "{v:?}"),
        }
    }
}

/// A recorded condition.
#[derive(Clone, Copy, Debug)]
pub enum SymMask<'r> {
    /// a known answer
    Known(bool),
    /// the result of a comparison
    Node(&'r Recorder, Value),
}

impl<'r> SymMask<'r> {
    fn from(s: Sym<'r>) -> Self {
        match s {
            Sym::Known(x) => SymMask::Known(x != 0.0),
            Sym::Node(r, v) => SymMask::Node(r, v),
        }
    }
}

impl Mask for SymMask<'_> {
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (SymMask::Known(false), _) | (_, SymMask::Known(false)) => SymMask::Known(false),
            (SymMask::Known(true), x) | (x, SymMask::Known(true)) => x,
            (SymMask::Node(r, a), SymMask::Node(_, b)) => {
                let v = r.builder.borrow_mut().and(a, b);
                SymMask::from(r.wrap(v))
            }
        }
    }
    fn or(self, other: Self) -> Self {
        match (self, other) {
            (SymMask::Known(true), _) | (_, SymMask::Known(true)) => SymMask::Known(true),
            (SymMask::Known(false), x) | (x, SymMask::Known(false)) => x,
            (SymMask::Node(r, a), SymMask::Node(_, b)) => {
                let v = r.builder.borrow_mut().or(a, b);
                SymMask::from(r.wrap(v))
            }
        }
    }
    fn not(self) -> Self {
        match self {
            SymMask::Known(x) => SymMask::Known(!x),
            SymMask::Node(r, a) => {
                let v = r.builder.borrow_mut().not(a);
                SymMask::from(r.wrap(v))
            }
        }
    }
    fn known(self) -> Option<bool> {
        match self {
            SymMask::Known(x) => Some(x),
            SymMask::Node(..) => None,
        }
    }
}

impl<'r> Sym<'r> {
    fn value(self, r: &Recorder) -> Value {
        match self {
            Sym::Known(x) => r.builder.borrow_mut().constant(x),
            Sym::Node(_, v) => v,
        }
    }
    fn unary(self, op: UnaryOp) -> Self {
        match self {
            Sym::Known(x) => Sym::Known(op.apply(x)),
            Sym::Node(r, v) => {
                let v = r.builder.borrow_mut().unary(op, v);
                r.wrap(v)
            }
        }
    }
    fn binary(self, op: BinaryOp, other: Self) -> Self {
        let r = match (self, other) {
            (Sym::Known(a), Sym::Known(b)) => return Sym::Known(op.apply(a, b)),
            (Sym::Node(r, _), _) | (_, Sym::Node(r, _)) => r,
        };
        let (a, b) = (self.value(r), other.value(r));
        let v = r.builder.borrow_mut().binary(op, a, b);
        r.wrap(v)
    }
    fn compare(self, comparison: Comparison, other: Self) -> SymMask<'r> {
        let r = match (self, other) {
            (Sym::Known(a), Sym::Known(b)) => return SymMask::Known(comparison.apply(a, b)),
            (Sym::Node(r, _), _) | (_, Sym::Node(r, _)) => r,
        };
        let (a, b) = (self.value(r), other.value(r));
        let v = r.builder.borrow_mut().compare(comparison, a, b);
        SymMask::from(r.wrap(v))
    }
}

/// Implements the operators of [`Sym`].
macro_rules! operators {
    ($($trait:ident $method:ident $op:ident),*) => { $(
        impl std::ops::$trait for Sym<'_> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.binary(BinaryOp::$op, other)
            }
        }
    )* };
}
operators!(Add add Add, Sub sub Sub, Mul mul Mul, Div div Div);

impl std::ops::Neg for Sym<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(UnaryOp::Neg)
    }
}
impl std::ops::AddAssign for Sym<'_> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl std::ops::SubAssign for Sym<'_> {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// Functions of one number, one operation each.
macro_rules! one_operation {
    ($($method:ident $op:ident),*) => { $(
        fn $method(self) -> Self {
            self.unary(UnaryOp::$op)
        }
    )* };
}

impl<'r> Scalar for Sym<'r> {
    type Mask = SymMask<'r>;

    fn constant(x: f64) -> Self {
        Sym::Known(x)
    }
    fn known(&self) -> Option<f64> {
        match self {
            Sym::Known(x) => Some(*x),
            Sym::Node(..) => None,
        }
    }
    fn lt(self, other: Self) -> SymMask<'r> {
        self.compare(Comparison::Lt, other)
    }
    fn le(self, other: Self) -> SymMask<'r> {
        self.compare(Comparison::Le, other)
    }
    fn same(self, other: Self) -> SymMask<'r> {
        self.compare(Comparison::Eq, other)
    }
    fn select(mask: SymMask<'r>, yes: Self, no: Self) -> Self {
        match mask {
            SymMask::Known(true) => yes,
            SymMask::Known(false) => no,
            SymMask::Node(r, condition) => {
                let (yes, no) = (yes.value(r), no.value(r));
                let v = r.builder.borrow_mut().select(condition, yes, no);
                r.wrap(v)
            }
        }
    }
    one_operation!(
        sqrt Sqrt, sin Sin, cos Cos, tan Tan, asin Asin, acos Acos, atan Atan, sinh Sinh, cosh Cosh, tanh Tanh,
        exp Exp, ln Ln, log10 Log10, abs Abs, trunc Trunc, round Round, floor Floor
    );
    fn atan2(self, other: Self) -> Self {
        self.binary(BinaryOp::Atan2, other)
    }
    fn powi(self, n: i32) -> Self {
        match self {
            Sym::Known(x) => Sym::Known(Scalar::powi(x, n)),
            Sym::Node(r, v) => {
                let v = r.builder.borrow_mut().powi(v, n);
                r.wrap(v)
            }
        }
    }
    fn powf(self, exponent: Self) -> Self {
        self.binary(BinaryOp::Pow, exponent)
    }
    fn rem(self, other: Self) -> Self {
        self.binary(BinaryOp::Rem, other)
    }
    fn lookup(self, table: &Arc<dyn Table>, order: u32) -> Self {
        match self {
            Sym::Known(x) => Sym::Known(table.at(x, order)),
            Sym::Node(r, v) => {
                let v = r.builder.borrow_mut().lookup(table, order, v);
                r.wrap(v)
            }
        }
    }
}
