//! What a program can do: the operations, each meaning the same over every number.

use crate::expr::functions::Function;
use crate::scalar::{Dual, Mask, Scalar};

/// A value in a [`super::Builder`]: the index of the node that yields it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Value(pub(crate) u32);

impl Value {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// An operation on one number.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[rustfmt::skip]
pub enum UnaryOp {
    Neg, Abs, Sqrt, Sin, Cos, Tan, Asin, Acos, Atan, Sinh, Cosh, Tanh, Exp, Ln, Log10,
    /// toward zero
    Trunc,
    /// nearest, halves away from zero
    Round,
    /// downward
    Floor,
    /// 1 where a condition is 0, else 0
    Not,
}

/// An operation on two numbers.
#[allow(missing_docs)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BinaryOp {
    Add,
    Sub,
    Mul,
    Div,
    /// `a**b` as `Scalar::powf`
    Pow,
    /// angle of the point (b, a)
    Atan2,
    /// exact remainder with the sign of a
    Rem,
    /// both conditions
    And,
    /// either condition
    Or,
    /// −a, 0 or a by the sign of b; NaN where b is
    Along,
}

/// A comparison of two numbers; it yields a condition, 1 or 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comparison {
    /// a < b
    Lt,
    /// a <= b
    Le,
    /// a = b
    Eq,
}

impl UnaryOp {
    /// The operation itself.
    #[inline(always)]
    pub fn apply<S: Scalar>(self, x: S) -> S {
        match self {
            UnaryOp::Neg => -x,
            UnaryOp::Abs => x.abs(),
            UnaryOp::Sqrt => x.sqrt(),
            UnaryOp::Sin => x.sin(),
            UnaryOp::Cos => x.cos(),
            UnaryOp::Tan => x.tan(),
            UnaryOp::Asin => x.asin(),
            UnaryOp::Acos => x.acos(),
            UnaryOp::Atan => x.atan(),
            UnaryOp::Sinh => x.sinh(),
            UnaryOp::Cosh => x.cosh(),
            UnaryOp::Tanh => x.tanh(),
            UnaryOp::Exp => x.exp(),
            UnaryOp::Ln => x.ln(),
            UnaryOp::Log10 => x.log10(),
            UnaryOp::Trunc => x.trunc(),
            UnaryOp::Round => x.round(),
            UnaryOp::Floor => x.floor(),
            UnaryOp::Not => from_mask(truth(x).not()),
        }
    }
}

impl BinaryOp {
    /// The operation itself.
    #[inline(always)]
    pub fn apply<S: Scalar>(self, a: S, b: S) -> S {
        match self {
            BinaryOp::Add => a + b,
            BinaryOp::Sub => a - b,
            BinaryOp::Mul => a * b,
            BinaryOp::Div => a / b,
            BinaryOp::Pow => a.powf(b),
            BinaryOp::Atan2 => a.atan2(b),
            BinaryOp::Rem => a.rem(b),
            BinaryOp::And => from_mask(truth(a).and(truth(b))),
            BinaryOp::Or => from_mask(truth(a).or(truth(b))),
            BinaryOp::Along => arithmetic_if(b, -a, S::zero(), a),
        }
    }
}

impl Comparison {
    /// The comparison itself.
    #[inline(always)]
    pub fn apply<S: Scalar>(self, a: S, b: S) -> S::Mask {
        match self {
            Comparison::Lt => a.lt(b),
            Comparison::Le => a.le(b),
            Comparison::Eq => a.same(b),
        }
    }
}

/// A condition kept as a number, as a mask.
#[inline(always)]
pub(crate) fn truth<S: Scalar>(condition: S) -> S::Mask {
    S::zero().lt(condition)
}

/// A mask as a number, 1 or 0.
#[inline(always)]
pub(crate) fn from_mask<S: Scalar>(mask: S::Mask) -> S {
    S::select(mask, S::one(), S::zero())
}

/// `IF(selector: negative, zero, positive)`: NaN where the selector is NaN.
#[inline(always)]
pub(crate) fn arithmetic_if<S: Scalar>(selector: S, negative: S, zero: S, positive: S) -> S {
    let origin = S::zero();
    S::choose(
        selector.lt(origin),
        || negative,
        || {
            S::choose(
                origin.lt(selector),
                || positive,
                || S::choose(selector.same(origin), || zero, || S::constant(f64::NAN)),
            )
        },
    )
}

/// The `k`-th partial derivative of a function: its row over a dual.
#[inline]
pub(crate) fn partial<S: Scalar>(function: Function, args: &[S], k: usize) -> S {
    fn over_duals<S: Scalar, const N: usize>(function: Function, args: &[S], k: usize) -> S {
        let mut duals = [Dual::<1, S>::constant(0.0); N];
        for (dual, &x) in duals.iter_mut().zip(args) {
            *dual = Dual {
                re: x,
                eps: [S::zero()],
            };
        }
        if let Some(dual) = duals.get_mut(k) {
            dual.eps = [S::one()];
        }
        function.eval(&duals[..args.len().min(N)]).eps[0]
    }
    if args.len() <= 8 {
        over_duals::<S, 8>(function, args, k)
    } else {
        over_duals::<S, 40>(function, args, k)
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
