//! What generated code calls: operations that the processor has no instruction for, and whole
//! steps.

use super::super::super::code::Core;
use super::super::super::operation::{BinaryOp, UnaryOp, binary_operations, unary_operations};
use super::super::steps::{Step, Steps};
use crate::scalar::Scalar;
use std::sync::Arc;

/// Two results, in the vector registers 0 and 1.
#[repr(C)]
pub(super) struct Pair {
    first: f64,
    second: f64,
}

/// A step that generated code has performed by the interpreter.
pub(super) struct CalledStep {
    pub(super) step: Step,
    pub(super) steps: Arc<Steps>,
    pub(super) core: Arc<Core>,
}

/// Performs a step over the frame.
///
/// # Safety
///
/// `called` is valid, and `frame` has the slots of its steps, which nobody else reads or writes
/// meanwhile.
#[allow(unsafe_code)]
pub(super) unsafe extern "sysv64" fn perform(called: *const CalledStep, frame: *mut f64) {
    // SAFETY: as the caller says
    let (called, frame) = unsafe {
        let called = &*called;
        let n_slots = called.steps.n_slots();
        (called, std::slice::from_raw_parts_mut(frame, n_slots))
    };
    called.steps.perform(called.step, &called.core, frame);
}

/// Returns sine and cosine.
pub(super) extern "sysv64" fn sine_and_cosine(x: f64) -> Pair {
    let (first, second) = Scalar::sin_cos(x);
    Pair { first, second }
}

/// Makes the functions that operations on one number are called by.
macro_rules! unary_functions {
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
        /// Returns the address of the function of one number that is this operation.
        pub(super) fn of_one_number(op: UnaryOp) -> usize {
            let function: extern "sysv64" fn(f64) -> f64 = match op {
                $(UnaryOp::$method_op => {
                    extern "sysv64" fn called(x: f64) -> f64 {
                        UnaryOp::$method_op.apply(x)
                    }
                    called
                })+
                $(UnaryOp::$body_op => {
                    extern "sysv64" fn called(x: f64) -> f64 {
                        UnaryOp::$body_op.apply(x)
                    }
                    called
                })+
            };
            function as usize
        }
    };
}
unary_operations!(unary_functions);

/// Makes the functions that operations on two numbers are called by.
macro_rules! binary_functions {
    ($($(#[$doc:meta])* $op:ident |$a:ident, $b:ident| $body:expr, $cost:literal;)+) => {
        /// Returns the address of the function of two numbers that is this operation.
        pub(super) fn of_two_numbers(op: BinaryOp) -> usize {
            let function: extern "sysv64" fn(f64, f64) -> f64 = match op {
                $(BinaryOp::$op => {
                    extern "sysv64" fn called(a: f64, b: f64) -> f64 {
                        BinaryOp::$op.apply(a, b)
                    }
                    called
                })+
            };
            function as usize
        }
    };
}
binary_operations!(binary_functions);
