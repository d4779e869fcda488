//! A number that records what is done to it: any formula generic over `Scalar` becomes part of a
//! program by running once.

use super::builder::{Builder, Trivial};
use super::input::Input;
use super::node::Value;
use super::operation::{BinaryOp, Comparison, UnaryOp, unary_operations};
use crate::scalar::{Mask, Scalar, Table};
use std::cell::RefCell;
use std::fmt;
use std::sync::Arc;

/// A constant, or a value in a builder.
#[derive(Clone, Copy)]
pub enum Sym<'b> {
    /// a number known now
    Constant(f64),
    /// a recorded value
    Recorded(Value, &'b RefCell<Builder>),
}

/// A comparison known now, or a recorded condition.
#[derive(Clone, Copy)]
pub enum Condition<'b> {
    /// known now
    Known(bool),
    /// a recorded condition
    Recorded(Value, &'b RefCell<Builder>),
}

impl<'b> Sym<'b> {
    /// Returns a value of a builder as a number.
    pub fn of(value: Value, builder: &'b RefCell<Builder>) -> Self {
        match builder.borrow().constant_of(value) {
            Some(c) => Sym::Constant(c),
            None => Sym::Recorded(value, builder),
        }
    }
    /// Returns an input of a builder as a number.
    pub fn input(input: Input, builder: &'b RefCell<Builder>) -> Self {
        let value = builder.borrow_mut().input(input);
        Sym::Recorded(value, builder)
    }
    /// Returns the value in the builder, where a constant may have to be recorded first.
    pub fn value(self, builder: &mut Builder) -> Value {
        match self {
            Sym::Constant(c) => builder.constant(c),
            Sym::Recorded(v, _) => v,
        }
    }

    fn unary(self, op: UnaryOp) -> Self {
        match self {
            Sym::Constant(c) => Sym::Constant(op.apply(c)),
            Sym::Recorded(v, builder) => {
                let value = builder.borrow_mut().unary(op, v);
                Sym::of(value, builder)
            }
        }
    }
    fn binary(self, op: BinaryOp, other: Self) -> Self {
        match (self, other) {
            (Sym::Constant(a), Sym::Constant(b)) => Sym::Constant(op.apply(a, b)),
            // most operations of recorded physics are with zeros and ones
            (Sym::Constant(c), Sym::Recorded(_, builder)) => {
                let folding = builder.borrow().folding();
                match folding.number_before(op, c) {
                    Some(Trivial::Operand) => other,
                    Some(Trivial::Number(c)) => Sym::Constant(c),
                    None => self.recorded(op, other, builder),
                }
            }
            (Sym::Recorded(_, builder), Sym::Constant(c)) => {
                let folding = builder.borrow().folding();
                match folding.number_behind(op, c) {
                    Some(Trivial::Operand) => self,
                    Some(Trivial::Number(c)) => Sym::Constant(c),
                    None => self.recorded(op, other, builder),
                }
            }
            (Sym::Recorded(_, builder), Sym::Recorded(..)) => self.recorded(op, other, builder),
        }
    }
    fn recorded(self, op: BinaryOp, other: Self, builder: &'b RefCell<Builder>) -> Self {
        let recorder = &mut *builder.borrow_mut();
        let (a, b) = (self.value(recorder), other.value(recorder));
        let value = recorder.binary(op, a, b);
        match recorder.constant_of(value) {
            Some(c) => Sym::Constant(c),
            None => Sym::Recorded(value, builder),
        }
    }
    fn compare(self, comparison: Comparison, other: Self) -> Condition<'b> {
        match (self, other) {
            (Sym::Constant(a), Sym::Constant(b)) => Condition::Known(comparison.apply(a, b)),
            (Sym::Recorded(_, builder), _) | (_, Sym::Recorded(_, builder)) => {
                let recorder = &mut *builder.borrow_mut();
                let (a, b) = (self.value(recorder), other.value(recorder));
                let value = recorder.compare(comparison, a, b);
                Condition::from_value(value, recorder, builder)
            }
        }
    }
}

impl<'b> Condition<'b> {
    fn from_value(value: Value, recorder: &Builder, builder: &'b RefCell<Builder>) -> Self {
        match recorder.constant_of(value) {
            Some(c) => Condition::Known(0.0 < c),
            None => Condition::Recorded(value, builder),
        }
    }
    /// Returns the condition in the builder, as 0 or 1.
    pub fn value(self, builder: &mut Builder) -> Value {
        match self {
            Condition::Known(holds) => builder.constant(f64::from(u8::from(holds))),
            Condition::Recorded(v, _) => v,
        }
    }
    fn combine(self, other: Self, op: impl FnOnce(&mut Builder, Value, Value) -> Value) -> Self {
        match (self, other) {
            (Condition::Recorded(a, builder), Condition::Recorded(b, _)) => {
                let recorder = &mut *builder.borrow_mut();
                let value = op(recorder, a, b);
                Condition::from_value(value, recorder, builder)
            }
            _ => unreachable!("known conditions are combined before"),
        }
    }
}

impl Mask for Condition<'_> {
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (Condition::Known(true), c) | (c, Condition::Known(true)) => c,
            (Condition::Known(false), _) | (_, Condition::Known(false)) => Condition::Known(false),
            _ => self.combine(other, Builder::and),
        }
    }
    fn or(self, other: Self) -> Self {
        match (self, other) {
            (Condition::Known(false), c) | (c, Condition::Known(false)) => c,
            (Condition::Known(true), _) | (_, Condition::Known(true)) => Condition::Known(true),
            _ => self.combine(other, Builder::or),
        }
    }
    fn not(self) -> Self {
        match self {
            Condition::Known(holds) => Condition::Known(!holds),
            Condition::Recorded(v, builder) => {
                let recorder = &mut *builder.borrow_mut();
                let value = recorder.not(v);
                Condition::from_value(value, recorder, builder)
            }
        }
    }
    fn known(self) -> Option<bool> {
        match self {
            Condition::Known(holds) => Some(holds),
            Condition::Recorded(..) => None,
        }
    }
}

impl fmt::Debug for Sym<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Sym::Constant(c) => write!(f, "{c}"),
            Sym::Recorded(v, _) => write!(f, "%{}", v.0),
        }
    }
}

impl fmt::Debug for Condition<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Condition::Known(holds) => write!(f, "{holds}"),
            Condition::Recorded(v, _) => write!(f, "%{}", v.0),
        }
    }
}

/// Makes the operators, of which those on two numbers need no builder.
macro_rules! operators {
    ($($trait:ident $method:ident $operator:tt,)+) => { $(
        impl std::ops::$trait for Sym<'_> {
            type Output = Self;
            #[inline]
            fn $method(self, b: Self) -> Self {
                match (self, b) {
                    (Sym::Constant(x), Sym::Constant(y)) => Sym::Constant(x $operator y),
                    _ => self.binary(BinaryOp::$trait, b),
                }
            }
        }
    )+ };
}
operators!(Add add +, Sub sub -, Mul mul *, Div div /,);

impl std::ops::Neg for Sym<'_> {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(UnaryOp::Neg)
    }
}
impl std::ops::AddAssign for Sym<'_> {
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}
impl std::ops::SubAssign for Sym<'_> {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}

/// Makes the methods of `Scalar` that are operations on one number.
macro_rules! recorded {
    (
        methods {
            $(
                $(#[$doc:meta])*
                $method_op:ident $method:ident, $method_cost:literal, $method_edges:ident, $_r:expr;
            )+
        }
        bodies { $($others:tt)+ }
    ) => { $(
        fn $method(self) -> Self {
            self.unary(UnaryOp::$method_op)
        }
    )+ };
}

impl<'b> Scalar for Sym<'b> {
    type Mask = Condition<'b>;
    /// what is recorded follows the order of the rows
    const CALLS_FUNCTIONS: bool = true;

    fn constant(x: f64) -> Self {
        Sym::Constant(x)
    }
    fn known(&self) -> Option<f64> {
        match *self {
            Sym::Constant(c) => Some(c),
            Sym::Recorded(..) => None,
        }
    }
    fn lt(self, other: Self) -> Condition<'b> {
        self.compare(Comparison::Lt, other)
    }
    fn le(self, other: Self) -> Condition<'b> {
        self.compare(Comparison::Le, other)
    }
    fn same(self, other: Self) -> Condition<'b> {
        self.compare(Comparison::Eq, other)
    }
    fn select(mask: Condition<'b>, yes: Self, no: Self) -> Self {
        match mask {
            Condition::Known(holds) => {
                if holds {
                    yes
                } else {
                    no
                }
            }
            Condition::Recorded(condition, builder) => {
                let recorder = &mut *builder.borrow_mut();
                let (yes, no) = (yes.value(recorder), no.value(recorder));
                let value = recorder.select(condition, yes, no);
                match recorder.constant_of(value) {
                    Some(c) => Sym::Constant(c),
                    None => Sym::Recorded(value, builder),
                }
            }
        }
    }
    unary_operations!(recorded);
    fn atan2(self, other: Self) -> Self {
        self.binary(BinaryOp::Atan2, other)
    }
    fn powi(self, n: i32) -> Self {
        match self {
            Sym::Constant(c) => Sym::Constant(Scalar::powi(c, n)),
            Sym::Recorded(v, builder) => {
                let value = builder.borrow_mut().powi(v, n);
                Sym::of(value, builder)
            }
        }
    }
    fn powf(self, exponent: Self) -> Self {
        self.binary(BinaryOp::Pow, exponent)
    }
    fn rem(self, other: Self) -> Self {
        self.binary(BinaryOp::Rem, other)
    }
    fn kept_with(self, x: Self) -> Self {
        self.binary(BinaryOp::Kept, x)
    }
    fn lookup(self, table: &Arc<dyn Table>, order: u32) -> Self {
        match self {
            Sym::Constant(c) => Sym::Constant(table.at(c, order)),
            Sym::Recorded(v, builder) => {
                let value = builder.borrow_mut().lookup(table, order, v);
                Sym::of(value, builder)
            }
        }
    }
}
