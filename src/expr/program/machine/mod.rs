//! The fast machine for plain numbers: threaded code.
//!
//! Every operation holds the function that performs it, its handler. A handler ends by calling the handler of the next
//! operation, which an optimising compiler turns into a jump: there is no loop and no central dispatch. The result of an
//! operation travels to the next one in a floating-point register (`acc`), besides being stored. Up to three arithmetic
//! operations form one; functions with constant parameters have handlers of their own; what only one side of an IF needs is
//! jumped over where that pays.
//!
//! On processors that we know this code is translated once more when a program first runs (`native`): straight code of the
//! processor, which is one operation that does the work of all. The threaded code is what there is everywhere else, and the
//! reference in tests.
//!
//! # Safety
//!
//! Handlers read and write registers without bounds checks, through pointers. This is sound because
//!
//! - [`lower()`] emits only registers below `n_registers`, parameters inside the frame, and jumps inside the code;
//!   [`Machine::check`] verifies that for each operation before the code can run, and panics otherwise (our own mistake),
//! - the last operation of the code is `halt`, and no jump leads backwards, so that every run ends,
//! - the caller of [`Machine::run`] provides `n_registers` registers and as many inputs as the program says.
//!
//! Were the jumps of a build ordinary calls, each would take a stack frame; `pause` returns to the loop in `run` at least
//! every [`LONGEST_CHAIN`] operations, which bounds the stack in any build.

mod handlers;
mod lower;
#[cfg(all(target_arch = "x86_64", target_os = "linux", not(miri)))]
mod native;
#[cfg(not(all(target_arch = "x86_64", target_os = "linux", not(miri))))]
#[path = "threaded.rs"]
mod native;

pub(super) use lower::lower;

use super::Core;
use crate::expr::functions::prepared::Prepared;
use native::Native;
use std::sync::Arc;
use std::sync::atomic::{AtomicPtr, Ordering};

/// Most operations between two returns to the loop.
const LONGEST_CHAIN: usize = 128;

/// One operation.
#[repr(C)]
#[derive(Clone, Copy)]
struct Op {
    run: Handler,
    /// registers, parameters, jumps: what the handler says
    operands: [u32; 6],
}

/// Performs an operation and all that follow it.
type Handler =
    unsafe extern "C" fn(op: *const Op, registers: *mut f64, inputs: *const f64, acc: f64) -> Stop;

/// Where a chain of operations stopped.
#[repr(C)]
struct Stop {
    /// the operation to go on with; null at the end
    next: *const Op,
    /// the last result
    acc: f64,
}

/// What the operands of an operation mean, for the check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// this many registers
    Registers(u8),
    /// registers, then the place of parameters in the frame, then their number
    Parameters(u8),
    /// registers, then the place of this many parameters
    Fixed(u8, u8),
    /// registers, then jumps
    Jumps(u8, u8),
    /// the number of an instruction of the core
    Instruction,
    /// the first of some registers, then the numbers of this many inputs
    Inputs(u8),
    /// nothing follows
    Halt,
}

/// What an operation means to the translation into code of the processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Meaning {
    /// what its handler does; its first operand may be expected in `acc`
    Handled,
    /// a function of one variable, perhaps with its slope, perhaps added to a register
    Prepared {
        function: Prepared,
        slope: bool,
        added: Option<u32>,
    },
    Arithmetic(Shape, [u8; 3]),
    Inputs,
    /// a → o[1]
    Copy,
    /// a → o[1], to o[2]
    CopyAndGo,
    Go,
    /// by the code of a comparison
    Select(u8),
    Unless(u8),
    /// by the code of the operation that yields the selector
    Branch(u8),
    Pause,
    Halt,
}

/// How arithmetic is fused; p, q, r are its operations in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    /// a p b
    One,
    /// (a p b) q c
    Two,
    /// ((a p b) q c) r d
    Chain,
    /// (a p b) q (c r d)
    Balanced,
    /// ((a·b) q e) r (c·d), where e is the fifth operand
    Dot,
}

/// What is translated. Where nothing is, nobody reads it.
#[cfg_attr(
    not(all(target_arch = "x86_64", target_os = "linux", not(miri))),
    allow(dead_code)
)]
struct Threaded {
    ops: Arc<[Op]>,
    kinds: Vec<Kind>,
    meanings: Vec<Meaning>,
    core: Arc<Core>,
    /// the last of the registers
    parameters: Vec<f64>,
    n_registers: usize,
    /// registers of the outputs
    outputs: Vec<u32>,
}

/// Threaded code, and its translation into code of the processor where there is one.
pub(super) struct Machine {
    /// where a run begins: the first of `ops`, or the operation that is the translation of all of them
    start: AtomicPtr<Op>,
    native: Option<Arc<Native>>,
    ops: Arc<[Op]>,
    /// numbers behind the registers of the core: parameters of prepared functions
    parameters: Vec<f64>,
    /// registers of the core, scratch registers and parameters
    n_registers: usize,
    /// how many inputs there must be
    n_inputs: usize,
    /// what `instruction` operations point to
    core: Arc<Core>,
    /// there is one output, which is the last result, and no pause
    yields_the_value_at_once: bool,
}

impl Clone for Machine {
    fn clone(&self) -> Self {
        Self {
            start: AtomicPtr::new(self.start.load(Ordering::Acquire)),
            native: self.native.clone(),
            ops: self.ops.clone(),
            parameters: self.parameters.clone(),
            core: self.core.clone(),
            ..*self
        }
    }
}

impl std::fmt::Debug for Machine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Machine")
            .field("n_ops", &self.ops.len())
            .field("n_registers", &self.n_registers)
            .finish()
    }
}

impl Machine {
    /// How many operations it has.
    pub(super) fn len(&self) -> usize {
        self.ops.len()
    }
    /// How many registers a frame has.
    pub(super) fn n_registers(&self) -> usize {
        self.n_registers
    }

    /// The numbers that stand behind the registers of the core, scratch registers first.
    pub(super) fn tail(&self) -> impl Iterator<Item = f64> + '_ {
        let scratch = self.n_registers - self.core.size as usize - self.parameters.len();
        std::iter::repeat_n(f64::NAN, scratch).chain(self.parameters.iter().copied())
    }

    /// Has the translation run from now on, if there is one; how many registers it needs besides.
    pub(super) fn prepare(&self) -> usize {
        let Some((native, op)) = self.native.as_ref().and_then(|n| Some((n, n.start()?))) else {
            return 0;
        };
        self.start.store(op.cast_mut(), Ordering::Release);
        native.n_spare()
    }

    /// Whether the translation is what runs.
    #[cfg(test)]
    pub(super) fn is_translated(&self) -> bool {
        self.start.load(Ordering::Acquire).cast_const() != self.ops.as_ptr()
    }

    /// Has the threaded code run from now on.
    #[cfg(test)]
    pub(super) fn do_without_translation(&mut self) {
        self.native = None;
        self.start = AtomicPtr::new(self.ops.as_ptr().cast_mut());
    }

    /// Runs over a frame whose constants and parameters are in place.
    ///
    /// # Safety
    ///
    /// There are at least `n_registers` registers, and as many inputs as the program says.
    #[inline(always)]
    pub(super) unsafe fn run(&self, registers: *mut f64, inputs: *const f64) {
        let op: *const Op = self.start.load(Ordering::Acquire);
        // SAFETY: see the head of this file
        let mut stop = unsafe { ((*op).run)(op, registers, inputs, 0.0) };
        while !stop.next.is_null() {
            // SAFETY: `next` is an operation that `pause` named
            stop = unsafe { ((*stop.next).run)(stop.next, registers, inputs, stop.acc) };
        }
    }

    /// Whether [`Machine::value`] can be asked: there is one output and no pause.
    #[inline(always)]
    pub(super) fn yields_the_value_at_once(&self) -> bool {
        self.yields_the_value_at_once
    }

    /// The only output.
    ///
    /// # Safety
    ///
    /// As [`Machine::run`].
    #[inline(always)]
    pub(super) unsafe fn value(&self, registers: *mut f64, inputs: *const f64) -> f64 {
        let op: *const Op = self.start.load(Ordering::Acquire);
        // SAFETY: see the head of this file
        unsafe { ((*op).run)(op, registers, inputs, 0.0) }.acc
    }

    /// That no operation reaches outside the frame or the code.
    fn check(&self, kinds: &[Kind]) {
        let (n, end) = (self.n_registers, self.ops.len());
        assert_eq!((kinds.len(), kinds.last()), (end, Some(&Kind::Halt)));
        for (k, (op, kind)) in self.ops.iter().zip(kinds).enumerate() {
            let registers_are_inside = |count: u8| {
                op.operands[..count as usize]
                    .iter()
                    .all(|&r| (r as usize) < n)
            };
            let sound = match *kind {
                Kind::Registers(count) => registers_are_inside(count),
                Kind::Parameters(count) => {
                    let [place, length] = [0, 1].map(|i| op.operands[count as usize + i] as usize);
                    registers_are_inside(count) && place + length <= n
                }
                Kind::Fixed(count, length) => {
                    registers_are_inside(count)
                        && op.operands[count as usize] as usize + length as usize <= n
                }
                Kind::Jumps(count, jumps) => {
                    let jumps = &op.operands[count as usize..(count + jumps) as usize];
                    registers_are_inside(count)
                        && jumps.iter().all(|&j| j >= 1 && k + (j as usize) < end)
                }
                Kind::Instruction => {
                    (op.operands[0] as usize) < self.core.code.len()
                        && n >= self.core.size as usize
                        && [op.operands[1], op.operands[2]] == halves(Arc::as_ptr(&self.core))
                }
                Kind::Inputs(count) => {
                    let numbers = &op.operands[1..=count as usize];
                    op.operands[0] as usize + count as usize <= n
                        && numbers.iter().all(|&k| (k as usize) < self.n_inputs)
                }
                Kind::Halt => k + 1 == end,
            };
            assert!(
                sound,
                "operation {k} reaches outside: {kind:?} {:?}",
                op.operands
            );
        }
    }
}

/// An address as two operands.
fn halves(core: *const Core) -> [u32; 2] {
    let address = core.expose_provenance() as u64;
    [address as u32, (address >> 32) as u32]
}

/// The address that two operands are.
#[inline(always)]
fn pointer(halves: [u32; 2]) -> *const Core {
    std::ptr::with_exposed_provenance((u64::from(halves[0]) | u64::from(halves[1]) << 32) as usize)
}
