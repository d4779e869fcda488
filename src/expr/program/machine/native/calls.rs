//! Functions that generated code calls: operations that the processor has no instruction for, and
//! whole steps.

use super::super::super::code::Core;
use super::super::super::operation::{BinaryOp, UnaryOp};
use super::super::prepared::PreparedCall;
use super::super::steps::{Circle, Step, Steps};
use crate::expr::functions::prepared::Prepared;
use crate::scalar::{Exponent, Scalar};
use std::sync::Arc;

/// Two results, in the vector registers 0 and 1.
#[repr(C)]
pub(super) struct Pair {
    first: f64,
    second: f64,
}

/// A step that generated code does not do itself.
pub(super) struct CalledStep {
    operation: Operation,
    n_slots: usize,
}

enum Operation {
    Instruction { number: u32, core: Arc<Core> },
    Prepared(PreparedCall),
    Circle(Circle),
}

impl CalledStep {
    /// Returns what there is to call for a step; `None` where generated code does the step itself.
    pub(super) fn of(step: &Step, steps: &Steps, core: &Arc<Core>) -> Option<Self> {
        let operation = match *step {
            Step::Instruction { number } => {
                let core = core.clone();
                Operation::Instruction { number, core }
            }
            Step::Prepared { number } => {
                Operation::Prepared(steps.prepared[number as usize].clone())
            }
            Step::Circle { number } => Operation::Circle(steps.circles[number as usize]),
            Step::Input { .. }
            | Step::Copy { .. }
            | Step::Unary { .. }
            | Step::Binary { .. }
            | Step::SineCosine { .. }
            | Step::Select { .. }
            | Step::Unless { .. }
            | Step::Branch { .. }
            | Step::Go { .. } => return None,
        };
        Some(Self {
            operation,
            n_slots: steps.n_slots(),
        })
    }

    /// Returns the address of the function that performs it, given its own address and that of the
    /// frame.
    pub(super) fn function(&self) -> usize {
        /// A function made for one prepared function, with slopes or without.
        macro_rules! made_for {
            ($function:expr) => {
                match self.has_slopes() {
                    true => made_for!($function, true),
                    false => made_for!($function, false),
                }
            };
            ($function:expr, $has_slopes:literal) => {{
                #[allow(unsafe_code)]
                unsafe extern "sysv64" fn made(called: *const CalledStep, frame: *mut f64) {
                    // SAFETY: as for `perform`
                    let (called, frame) = unsafe { referenced(called, frame) };
                    if let Operation::Prepared(call) = &called.operation {
                        call.perform_as($function, $has_slopes, frame);
                    }
                }
                #[target_feature(enable = "avx2")]
                #[allow(unsafe_code)]
                unsafe extern "sysv64" fn made_with_avx(
                    called: *const CalledStep,
                    frame: *mut f64,
                ) {
                    // SAFETY: as for `perform`
                    let (called, frame) = unsafe { referenced(called, frame) };
                    if let Operation::Prepared(call) = &called.operation {
                        call.perform_as($function, $has_slopes, frame);
                    }
                }
                // instructions of AVX name a result beside their operands and save the copies
                match is_x86_feature_detected!("avx2") {
                    true => made_with_avx,
                    false => made,
                }
            }};
        }
        use Exponent::{Half, Other, Whole};
        use Prepared::{Bistop, Cheby, Forcos, Forsin, Havsin, Impact, Poly, Step, Step5};
        let function: unsafe extern "sysv64" fn(*const CalledStep, *mut f64) = match &self.operation
        {
            Operation::Instruction { .. } => perform,
            Operation::Circle(_) => of_circle(),
            Operation::Prepared(call) => match call.function {
                Havsin => made_for!(Havsin),
                Forcos => made_for!(Forcos),
                Forsin => made_for!(Forsin),
                Impact(Whole(1)) => made_for!(Impact(Whole(1))),
                Impact(Half(1)) => made_for!(Impact(Half(1))),
                Impact(Whole(2)) => made_for!(Impact(Whole(2))),
                Impact(Other) => made_for!(Impact(Other)),
                Bistop(Whole(1)) => made_for!(Bistop(Whole(1))),
                Bistop(Half(1)) => made_for!(Bistop(Half(1))),
                Bistop(Whole(2)) => made_for!(Bistop(Whole(2))),
                Bistop(Other) => made_for!(Bistop(Other)),
                Impact(Whole(_) | Half(_)) | Bistop(Whole(_) | Half(_)) => perform,
                Step | Step5 | Poly | Cheby => perform,
            },
        };
        function as usize
    }

    fn has_slopes(&self) -> bool {
        match &self.operation {
            Operation::Instruction { .. } | Operation::Circle(_) => false,
            Operation::Prepared(call) => call.has_slopes(),
        }
    }
}

/// Performs a step over the frame.
///
/// # Safety
///
/// `called` is valid, and `frame` has the slots that it says, which nobody else reads or writes
/// meanwhile.
#[allow(unsafe_code)]
unsafe extern "sysv64" fn perform(called: *const CalledStep, frame: *mut f64) {
    // SAFETY: as the caller says
    let (called, frame) = unsafe { referenced(called, frame) };
    match &called.operation {
        Operation::Instruction { number, core } => {
            core.perform(&core.code[*number as usize], frame);
        }
        Operation::Prepared(call) => call.perform(frame),
        Operation::Circle(circle) => circle.perform(frame),
    }
}

/// Returns the function for several angles.
fn of_circle() -> unsafe extern "sysv64" fn(*const CalledStep, *mut f64) {
    #[target_feature(enable = "avx2")]
    #[allow(unsafe_code)]
    unsafe extern "sysv64" fn with_avx(called: *const CalledStep, frame: *mut f64) {
        // SAFETY: as for `perform`
        let (called, frame) = unsafe { referenced(called, frame) };
        if let Operation::Circle(circle) = &called.operation {
            circle.perform(frame);
        }
    }
    match is_x86_feature_detected!("avx2") {
        true => with_avx,
        false => perform,
    }
}

/// Returns the step and the frame that generated code passes.
///
/// # Safety
///
/// As for [`perform`].
#[inline(always)]
#[allow(unsafe_code)]
unsafe fn referenced<'a>(
    called: *const CalledStep,
    frame: *mut f64,
) -> (&'a CalledStep, &'a mut [f64]) {
    // SAFETY: as the caller says
    unsafe {
        let called = &*called;
        (
            called,
            std::slice::from_raw_parts_mut(frame, called.n_slots),
        )
    }
}

/// Returns the address of the function that is sine and cosine.
pub(super) fn of_sine_and_cosine() -> usize {
    extern "sysv64" fn called(x: f64) -> Pair {
        let (first, second) = Scalar::sin_cos(x);
        Pair { first, second }
    }
    #[target_feature(enable = "avx2")]
    extern "sysv64" fn called_with_avx(x: f64) -> Pair {
        let (first, second) = Scalar::sin_cos(x);
        Pair { first, second }
    }
    if is_x86_feature_detected!("avx2") {
        called_with_avx as *const () as usize
    } else {
        called as *const () as usize
    }
}

/// Returns the address of the function of one number that is this operation.
pub(super) fn of_one_number(op: UnaryOp) -> usize {
    op.callable()
}

/// Returns the address of the function of two numbers that is this operation.
pub(super) fn of_two_numbers(op: BinaryOp) -> usize {
    op.callable()
}
