//! The elementary operations, one row each, meaning the same over every number.
//!
//! A row of [`unary_operations`] says all that this folder knows of an operation on one number. To
//! add one is to add its row (and its method to `Scalar`): enum, evaluation, recording, adjoint,
//! printing, breaks and calls from generated code follow.

use crate::scalar::{Mask, Scalar};

/// Hands the table of operations on one number to the macro `$make`.
///
/// Columns: name and doc; the method of `Scalar`, or the body; cost in additions; where it may stop
/// being smooth; the adjoint: its part of `bar` for the operand `x`, where `y` is the result and
/// `d` writes operations down.
macro_rules! unary_operations {
    ($make:ident) => {
        $make! {
            methods {
                /// magnitude
                Abs abs, 1, Zero, |d, x, _y, bar| d.op(Along, bar, x);
                /// square root; the quotient need not wait for the bar
                Sqrt sqrt, 5, Zero, |d, _x, y, bar| {
                    let half = d.constant(0.5);
                    let slope = d.op(Div, half, y);
                    d.op(Mul, bar, slope)
                };
                /// sine of an angle in radians
                Sin sin, 20, Nowhere, |d, x, _y, bar| {
                    let slope = d.apply(UnaryOp::Cos, x);
                    d.op(Mul, bar, slope)
                };
                /// cosine of an angle in radians
                Cos cos, 20, Nowhere, |d, x, _y, bar| {
                    let sine = d.apply(UnaryOp::Sin, x);
                    let slope = d.negative(sine);
                    d.op(Mul, bar, slope)
                };
                /// tangent of an angle in radians
                Tan tan, 20, Poles, |d, _x, y, bar| {
                    let square = d.op(Mul, y, y);
                    let one = d.constant(1.0);
                    let slope = d.op(Add, one, square);
                    d.op(Mul, bar, slope)
                };
                /// angle in radians whose sine this is
                Asin asin, 20, PlusMinusOne, |d, x, _y, bar| {
                    let root = d.root_of_one_less_square(x);
                    d.op(Div, bar, root)
                };
                /// angle in radians whose cosine this is
                Acos acos, 20, PlusMinusOne, |d, x, _y, bar| {
                    let root = d.root_of_one_less_square(x);
                    let part = d.op(Div, bar, root);
                    d.negative(part)
                };
                /// angle in radians whose tangent this is
                Atan atan, 20, Nowhere, |d, x, _y, bar| {
                    let square = d.op(Mul, x, x);
                    let one = d.constant(1.0);
                    let denominator = d.op(Add, one, square);
                    d.op(Div, bar, denominator)
                };
                /// hyperbolic sine
                Sinh sinh, 20, Nowhere, |d, x, _y, bar| {
                    let slope = d.apply(UnaryOp::Cosh, x);
                    d.op(Mul, bar, slope)
                };
                /// hyperbolic cosine
                Cosh cosh, 20, Nowhere, |d, x, _y, bar| {
                    let slope = d.apply(UnaryOp::Sinh, x);
                    d.op(Mul, bar, slope)
                };
                /// hyperbolic tangent
                Tanh tanh, 20, Nowhere, |d, _x, y, bar| {
                    let square = d.op(Mul, y, y);
                    let one = d.constant(1.0);
                    let slope = d.op(Sub, one, square);
                    d.op(Mul, bar, slope)
                };
                /// exponential function
                Exp exp, 20, Nowhere, |d, _x, y, bar| d.op(Mul, bar, y);
                /// natural logarithm
                Ln ln, 20, Zero, |d, x, _y, bar| d.op(Div, bar, x);
                /// logarithm to the base 10
                Log10 log10, 20, Zero, |d, x, _y, bar| {
                    let scaled = d.times(bar, LOG10_E);
                    d.op(Div, scaled, x)
                };
                /// whole number toward zero
                Trunc trunc, 2, Whole, |d, _x, _y, _bar| d.constant(0.0);
                /// nearest whole number, halves away from zero
                Round round, 2, Halves, |d, _x, _y, _bar| d.constant(0.0);
                /// whole number downward
                Floor floor, 2, Whole, |d, _x, _y, _bar| d.constant(0.0);
            }
            bodies {
                /// −x
                Neg |x| -x, 1, Nowhere, |d, _x, _y, bar| d.negative(bar);
                /// 1 where a condition is 0, else 0
                Not |x| from_mask(truth(x).not()), 1, Nowhere, |d, _x, _y, _bar| d.constant(0.0);
            }
        }
    };
}
pub(super) use unary_operations;

/// Where an operation on one number may stop being smooth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Edges {
    /// smooth wherever it has a value
    Nowhere,
    /// at zero
    Zero,
    /// at whole numbers
    Whole,
    /// halfway between whole numbers
    Halves,
    /// at odd multiples of a right angle
    Poles,
    /// at 1 and −1
    PlusMinusOne,
}

/// Makes a function of numbers of an operation, with the instructions of this machine: those of AVX
/// name a result beside their operands and save the copies.
#[cfg(all(
    feature = "native",
    target_arch = "x86_64",
    target_os = "linux",
    not(miri)
))]
macro_rules! callable {
    ($op:path, $($x:ident),+) => {{
        extern "sysv64" fn called($($x: f64),+) -> f64 {
            $op.apply($($x),+)
        }
        #[target_feature(enable = "avx2")]
        extern "sysv64" fn called_with_avx($($x: f64),+) -> f64 {
            $op.apply($($x),+)
        }
        if is_x86_feature_detected!("avx2") {
            called_with_avx as *const () as usize
        } else {
            called as *const () as usize
        }
    }};
}

/// Makes the enum of operations on one number, their evaluation, cost, edges and calls.
macro_rules! define_unary {
    (
        methods {
            $(
                $(#[$doc:meta])*
                $method_op:ident $method:ident, $method_cost:literal, $method_edges:ident, $_r:expr;
            )+
        }
        bodies {
            $(
                $(#[$body_doc:meta])*
                $body_op:ident |$x:ident| $body:expr,
                $body_cost:literal, $body_edges:ident, $_s:expr;
            )+
        }
    ) => {
        /// An operation on one number.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum UnaryOp {
            $($(#[$body_doc])* $body_op,)+
            $($(#[$doc])* $method_op,)+
        }

        impl UnaryOp {
            /// Applies the operation to a number.
            #[inline(always)]
            pub fn apply<S: Scalar>(self, x: S) -> S {
                match self {
                    $(UnaryOp::$body_op => { let $x = x; $body })+
                    $(UnaryOp::$method_op => x.$method(),)+
                }
            }

            /// Returns the address of a function of one number, for generated code.
            #[cfg(all(feature = "native", target_arch = "x86_64", target_os = "linux", not(miri)))]
            pub(super) fn callable(self) -> usize {
                match self {
                    $(UnaryOp::$body_op => callable!(UnaryOp::$body_op, x),)+
                    $(UnaryOp::$method_op => callable!(UnaryOp::$method_op, x),)+
                }
            }

            /// Returns about how many additions it costs.
            pub(super) fn cost(self) -> u32 {
                match self {
                    $(UnaryOp::$body_op => $body_cost,)+
                    $(UnaryOp::$method_op => $method_cost,)+
                }
            }

            /// Returns where it may stop being smooth.
            pub(super) fn edges(self) -> Edges {
                match self {
                    $(UnaryOp::$body_op => Edges::$body_edges,)+
                    $(UnaryOp::$method_op => Edges::$method_edges,)+
                }
            }
        }
    };
}
unary_operations!(define_unary);

/// Makes the enum of operations on two numbers, their evaluation and cost.
macro_rules! define_binary {
    ($($(#[$doc:meta])* $op:ident |$a:ident, $b:ident| $body:expr, $cost:literal;)+) => {
        /// An operation on two numbers.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum BinaryOp {
            $($(#[$doc])* $op,)+
        }

        impl BinaryOp {
            /// Applies the operation to two numbers.
            #[inline(always)]
            pub fn apply<S: Scalar>(self, a: S, b: S) -> S {
                match self {
                    $(BinaryOp::$op => { let ($a, $b) = (a, b); $body })+
                }
            }

            /// Returns the address of a function of two numbers, for generated code.
            #[cfg(all(feature = "native", target_arch = "x86_64", target_os = "linux", not(miri)))]
            pub(super) fn callable(self) -> usize {
                match self {
                    $(BinaryOp::$op => callable!(BinaryOp::$op, a, b),)+
                }
            }

            /// Returns about how many additions it costs.
            pub(super) fn cost(self) -> u32 {
                match self {
                    $(BinaryOp::$op => $cost,)+
                }
            }
        }
    };
}
// name and doc, body, cost in additions
define_binary! {
    /// a + b
    Add |a, b| a + b, 1;
    /// a − b
    Sub |a, b| a - b, 1;
    /// a·b
    Mul |a, b| a * b, 1;
    /// a/b
    Div |a, b| a / b, 4;
    /// `a**b` as `Scalar::powf`
    Pow |a, b| a.powf(b), 30;
    /// angle in radians of the point (b, a)
    Atan2 |a, b| a.atan2(b), 30;
    /// exact remainder with the sign of a
    Rem |a, b| a.rem(b), 30;
    /// both conditions
    And |a, b| from_mask(truth(a).and(truth(b))), 1;
    /// either condition
    Or |a, b| from_mask(truth(a).or(truth(b))), 1;
    /// −a, 0 or a by the sign of b; NaN where b is
    Along |a, b| arithmetic_if(b, -a, S::zero(), a), 1;
    /// a where b is finite, else NaN
    Kept |a, b| a.kept_with(b), 2;
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

impl Comparison {
    /// Compares two numbers.
    #[inline(always)]
    pub fn apply<S: Scalar>(self, a: S, b: S) -> S::Mask {
        match self {
            Comparison::Lt => a.lt(b),
            Comparison::Le => a.le(b),
            Comparison::Eq => a.same(b),
        }
    }
}

/// Returns a condition that is kept as a number, as a mask.
#[inline(always)]
pub(crate) fn truth<S: Scalar>(condition: S) -> S::Mask {
    S::zero().lt(condition)
}

/// Returns a mask as a number, 1 or 0.
#[inline(always)]
pub(crate) fn from_mask<S: Scalar>(mask: S::Mask) -> S {
    S::select(mask, S::one(), S::zero())
}

/// Evaluates `IF(selector: negative, zero, positive)`: NaN where the selector is NaN.
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
