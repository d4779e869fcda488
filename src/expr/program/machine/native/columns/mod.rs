//! Plain arithmetic over columns, translated into one loop that keeps its values in registers.
//!
//! A batch performs instruction after instruction over blocks of points. Where instructions that
//! the processor has follow each other, their values need not go through memory: this loop loads
//! each column once and stores what others read. The operations and their order are those of
//! [`Core::perform`], to the bit.
//!
//! # Safety
//!
//! The code reads and writes slots of the frame, whose length is asserted, and as many numbers of
//! each column as it is told; [`Columns::run`] says what the caller promises.

mod packed;
mod translate;

use super::super::super::batch::{BLOCK, Block};
use super::super::super::code::{Code, Core, Instruction};
use super::super::super::operation::{BinaryOp, UnaryOp};
use super::Mapping;
use crate::expr::functions::Function;
use translate::translate;

/// Numbers that an instruction works on.
const POINTS_AT_ONCE: usize = 4;
/// Most columns of a loop.
const MOST_COLUMNS: usize = 64;
/// Most instructions of a loop, so that it stays in the cache of decoded instructions.
const MOST_INSTRUCTIONS: usize = 1000;

/// A function that goes through columns; the length is in bytes.
type Entry = unsafe extern "sysv64" fn(frame: *mut f64, columns: *const *mut f64, length: usize);

/// Numbers that stand in the frame behind the registers of the program.
const EXTRAS: [f64; 5] = [-0.0, f64::from_bits(!(1 << 63)), 1.0, f64::NAN, 0.0];

/// A loop over columns.
pub(in crate::expr::program) struct Columns {
    entry: Entry,
    /// registers of the program that are read, each a column
    inputs: Vec<u32>,
    /// registers that are written, each a column; they stand behind the inputs
    outputs: Vec<u32>,
    n_registers: usize,
    frame_length: usize,
    _code: Mapping,
}

impl std::fmt::Debug for Columns {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Columns")
            .field("inputs", &self.inputs)
            .field("outputs", &self.outputs)
            .finish()
    }
}

impl Columns {
    /// Returns whether this machine has the instructions for such loops.
    pub(in crate::expr::program) fn are_to_be_had() -> bool {
        is_x86_feature_detected!("avx2")
    }

    /// Returns whether the processor has instructions for it.
    pub(in crate::expr::program) fn can(instruction: &Instruction) -> bool {
        use BinaryOp::{Add, Along, And, Div, Kept, Mul, Or, Sub};
        match instruction.code {
            Code::Unary(op) => {
                matches!(
                    op,
                    UnaryOp::Neg | UnaryOp::Abs | UnaryOp::Sqrt | UnaryOp::Not
                )
            }
            Code::Binary(op) => matches!(op, Add | Sub | Mul | Div | And | Or | Along | Kept),
            Code::Whole(_)
            | Code::HalfPower(_)
            | Code::Compare(_)
            | Code::Select
            | Code::CompareSelect(_)
            | Code::If
            | Code::Call(Function::Max | Function::Min, 2) => true,
            Code::Lookup { .. } | Code::Call(..) | Code::Partial(..) => false,
        }
    }

    /// Returns the numbers of a frame for these loops: constants, and room.
    pub(in crate::expr::program) fn frame(core: &Core) -> Vec<f64> {
        let mut frame = vec![f64::NAN; (core.size as usize + EXTRAS.len()) * POINTS_AT_ONCE];
        let (registers, extras) = frame.split_at_mut(core.size as usize * POINTS_AT_ONCE);
        for (slots, constants) in [(registers, &core.constants[..]), (extras, &EXTRAS)] {
            for (slot, c) in slots.chunks_exact_mut(POINTS_AT_ONCE).zip(constants) {
                slot.fill(*c);
            }
        }
        frame
    }

    /// Translates instructions that [`Columns::can`]; `wanted` are the registers of which others
    /// read what these instructions leave. `None` where the machine has no such instructions, or
    /// there are too many columns.
    #[allow(unsafe_code)]
    pub(in crate::expr::program) fn of(
        core: &Core,
        code: &[Instruction],
        wanted: &[u32],
    ) -> Option<Self> {
        if !Self::are_to_be_had()
            || code.len() > MOST_INSTRUCTIONS
            || core.size as usize >= super::MOST_NUMBERS / 8
        {
            return None;
        }
        let (bytes, inputs) = translate(core, code, wanted);
        if inputs.len() + wanted.len() > MOST_COLUMNS {
            return None;
        }
        let code = Mapping::of(&bytes)?;
        // SAFETY: the translation is a function of this kind, and `code` keeps it where it is
        let entry = unsafe { std::mem::transmute::<*const u8, Entry>(code.0.as_ptr()) };
        Some(Self {
            entry,
            inputs,
            outputs: wanted.to_vec(),
            n_registers: core.size as usize,
            frame_length: (core.size as usize + EXTRAS.len()) * POINTS_AT_ONCE,
            _code: code,
        })
    }

    /// Goes through blocks, one a register of the program.
    #[allow(unsafe_code)]
    pub(in crate::expr::program) fn over_blocks(&self, frame: &mut [f64], blocks: &mut [Block]) {
        assert!(
            blocks.len() >= self.n_registers,
            "a block for each register"
        );
        let first = blocks.as_mut_ptr().cast::<f64>();
        let mut columns = [std::ptr::null_mut(); MOST_COLUMNS];
        for (column, &r) in columns
            .iter_mut()
            .zip(self.inputs.iter().chain(&self.outputs))
        {
            // SAFETY: there is such a block, and before it blocks of nothing but numbers
            *column = unsafe { first.add(r as usize * BLOCK) };
        }
        // SAFETY: each column is a block
        unsafe { self.run(frame, &columns, BLOCK) }
    }

    /// Goes through columns of any length: those of the inputs, and those of the outputs, which
    /// are of one length.
    #[allow(unsafe_code)]
    pub(in crate::expr::program) fn over_columns<'a>(
        &self,
        frame: &mut [f64],
        inputs: impl Iterator<Item = &'a [f64]>,
        outputs: &mut [&mut [f64]],
    ) {
        let n = outputs.first().map_or(0, |out| out.len());
        let most = n - n % POINTS_AT_ONCE;
        let mut columns = [std::ptr::null_mut(); MOST_COLUMNS];
        // what is left at the end, in columns of their own
        let mut ends = [[0.0; POINTS_AT_ONCE]; MOST_COLUMNS];
        let mut n_columns = 0;
        for column in inputs {
            assert!(column.len() >= n, "columns as long as the outputs");
            ends[n_columns][..n - most].copy_from_slice(&column[most..n]);
            // inputs are read only
            columns[n_columns] = column.as_ptr().cast_mut();
            n_columns += 1;
        }
        for column in outputs.iter_mut() {
            assert!(column.len() >= n, "outputs of one length");
            columns[n_columns] = column.as_mut_ptr();
            n_columns += 1;
        }
        let n_columns_of_loop = self.inputs.len() + self.outputs.len();
        assert_eq!(
            n_columns, n_columns_of_loop,
            "as many columns as the loop has"
        );
        // SAFETY: each column has `n` numbers; outputs are borrowed for writing, so they are apart
        unsafe { self.run(frame, &columns, most) }
        if most < n {
            let columns = ends.each_mut().map(|end| end.as_mut_ptr());
            // SAFETY: each column is an array of four
            unsafe { self.run(frame, &columns, POINTS_AT_ONCE) }
            for (column, end) in outputs.iter_mut().zip(&ends[self.inputs.len()..]) {
                column[most..n].copy_from_slice(&end[..n - most]);
            }
        }
    }

    /// Goes through `n` points, a multiple of four.
    ///
    /// # Safety
    ///
    /// `columns` are the addresses of the columns of the inputs, then of the outputs. Each has `n`
    /// numbers, which may be read and, those of outputs, written. An output is no part of another
    /// column, but may be one.
    #[allow(unsafe_code)]
    unsafe fn run(&self, frame: &mut [f64], columns: &[*mut f64; MOST_COLUMNS], n: usize) {
        assert!(
            frame.len() >= self.frame_length && n.is_multiple_of(POINTS_AT_ONCE),
            "a frame and points as the loop was made for"
        );
        if n > 0 {
            // SAFETY: the code stays inside the frame, and the caller promises the rest
            unsafe { (self.entry)(frame.as_mut_ptr(), columns.as_ptr(), n * size_of::<f64>()) }
        }
    }

    /// Returns the registers whose columns are read, in their order.
    pub(in crate::expr::program) fn inputs(&self) -> &[u32] {
        &self.inputs
    }
}
