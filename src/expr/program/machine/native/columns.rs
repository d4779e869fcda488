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

use super::super::super::batch::{BLOCK, Block};
use super::super::super::code::{Code, Core, Instruction};
use super::super::super::operation::{BinaryOp, Comparison, UnaryOp};
use super::packed::{Operation, Packed, Relation, Source, Ymm};
use super::Mapping;
use crate::expr::functions::Function;

/// Numbers that an instruction works on.
const POINTS_AT_ONCE: usize = 4;
/// Most columns of a loop.
const MOST_COLUMNS: usize = 64;
/// Most instructions of a loop, so that it stays in the cache of decoded instructions.
const MOST_INSTRUCTIONS: usize = 1000;

/// A function that goes through columns; the length is in bytes.
type Entry = unsafe extern "sysv64" fn(frame: *mut f64, columns: *const *mut f64, length: usize);

/// Registers that hold values; the rest are for one instruction.
const N_HOLDING: u8 = 13;
const MASK: Ymm = 13;
const ONE: Ymm = 14;
const OTHER: Ymm = 15;

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
    /// Returns whether the processor has instructions for it.
    pub(in crate::expr::program) fn can(instruction: &Instruction) -> bool {
        use BinaryOp::{Add, Along, And, Div, Kept, Mul, Or, Sub};
        match instruction.code {
            Code::Unary(op) => {
                matches!(op, UnaryOp::Neg | UnaryOp::Abs | UnaryOp::Sqrt | UnaryOp::Not)
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
        if !is_x86_feature_detected!("avx2")
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
        assert!(blocks.len() >= self.n_registers, "a block for each register");
        let first = blocks.as_mut_ptr().cast::<f64>();
        let mut columns = [std::ptr::null_mut(); MOST_COLUMNS];
        for (column, &r) in columns.iter_mut().zip(self.inputs.iter().chain(&self.outputs)) {
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
        assert_eq!(n_columns, n_columns_of_loop, "as many columns as the loop has");
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
            frame.len() >= self.frame_length && n % POINTS_AT_ONCE == 0,
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

/// The value is not needed any more.
const NEVER: u32 = u32::MAX;

/// Returns for each instruction when its operands, in their order, and its result are needed next.
fn needs(core: &Core, code: &[Instruction], wanted: &[u32]) -> Vec<([u32; 4], u32)> {
    let mut next = vec![NEVER; core.size as usize];
    wanted.iter().for_each(|&r| next[r as usize] = code.len() as u32);
    let mut needs = vec![([NEVER; 4], NEVER); code.len()];
    for (k, instruction) in code.iter().enumerate().rev() {
        let result = std::mem::replace(&mut next[instruction.to as usize], NEVER);
        let mut of_operands = [NEVER; 4];
        let mut n = 0;
        core.operands(instruction, |r| {
            of_operands[n] = next[r as usize];
            n += 1;
        });
        core.operands(instruction, |r| next[r as usize] = k as u32);
        needs[k] = (of_operands, result);
    }
    needs
}

/// Where the value of a register is, if not in a vector register.
#[derive(Clone, Copy, PartialEq)]
enum Home {
    /// its slot of the frame
    Frame,
    /// not there yet, but among the columns
    Column(u32),
    /// nowhere: its vector register is the only place
    Nowhere,
}

struct Translation<'a> {
    packed: Packed,
    core: &'a Core,
    /// by vector register: the register of the program, and when that is needed next
    held: [Option<(u32, u32)>; N_HOLDING as usize],
    homes: Vec<Home>,
    inputs: Vec<u32>,
    /// vector registers of the instruction at hand
    pinned: u16,
}

/// Returns the code, and the registers whose columns it loads.
fn translate(core: &Core, code: &[Instruction], wanted: &[u32]) -> (Vec<u8>, Vec<u32>) {
    let needs = needs(core, code, wanted);
    let mut homes = vec![Home::Nowhere; core.size as usize];
    homes[..core.constants.len()].fill(Home::Frame);
    // what is read before it is written comes from a column
    let mut inputs = Vec::new();
    let mut is_written = vec![false; core.size as usize];
    let mut read = |r: u32, is_written: &[bool]| {
        let home = &mut homes[r as usize];
        if !is_written[r as usize] && *home == Home::Nowhere {
            *home = Home::Column(inputs.len() as u32);
            inputs.push(r);
        }
    };
    for instruction in code {
        core.operands(instruction, |r| read(r, &is_written));
        is_written[instruction.to as usize] = true;
    }
    wanted.iter().for_each(|&r| read(r, &is_written));

    let mut translation = Translation {
        packed: Packed::new(),
        core,
        held: [None; N_HOLDING as usize],
        homes,
        inputs,
        pinned: 0,
    };
    for (instruction, (operands, result)) in code.iter().zip(&needs) {
        translation.instruction(instruction, operands, *result);
    }
    for (&r, column) in wanted.iter().zip(translation.inputs.len() as u32..) {
        translation.pinned = 0;
        let x = translation.register(r);
        translation.packed.store_column(x, column);
    }
    (translation.packed.finish(), translation.inputs)
}

impl Translation<'_> {
    fn extra(&self, number: f64) -> Source {
        let is_it = |c: &f64| c.to_bits() == number.to_bits();
        let k = EXTRAS.iter().position(is_it).unwrap_or(0);
        Source::Slot(self.core.size + k as u32)
    }

    fn instruction(&mut self, instruction: &Instruction, operands: &[u32; 4], result: u32) {
        self.pinned = 0;
        // all operands where they can be read, until the last instruction has read them
        let (mut registers, mut n) = ([0; 4], 0);
        self.core.operands(instruction, |r| {
            registers[n] = r;
            n += 1;
        });
        let mut at = [0; 4];
        for (at, &r) in at.iter_mut().zip(&registers[..n]) {
            *at = self.register(r);
        }
        for (&r, &next) in registers[..n].iter().zip(operands) {
            self.needed_next(r, next);
        }
        let to = self.result(instruction.to, result);
        self.emit(instruction.code, to, at);
    }

    fn emit(&mut self, code: Code, to: Ymm, [a, b, c, d]: [Ymm; 4]) {
        use Operation::{Add, And, AndNot, Divide, Multiply, Or, Subtract, Xor};
        let [zero, one] = [0.0, 1.0].map(|c| self.extra(c));
        let y = Source::Ymm;
        match code {
            Code::Binary(BinaryOp::Add) => self.packed.operate(Add, to, a, y(b)),
            Code::Binary(BinaryOp::Sub) => self.packed.operate(Subtract, to, a, y(b)),
            Code::Binary(BinaryOp::Mul) | Code::HalfPower(_) => {
                self.packed.operate(Multiply, to, a, y(b));
            }
            Code::Binary(BinaryOp::Div) => self.packed.operate(Divide, to, a, y(b)),
            Code::Binary(BinaryOp::Kept) => {
                self.packed.operate(Subtract, ONE, b, y(b));
                self.packed.operate(Subtract, to, a, y(ONE));
            }
            Code::Binary(op @ (BinaryOp::And | BinaryOp::Or)) => {
                let joined = if op == BinaryOp::And { And } else { Or };
                self.truth(a, MASK);
                self.truth(b, ONE);
                self.packed.operate(joined, MASK, MASK, y(ONE));
                self.packed.operate(And, to, MASK, one);
            }
            Code::Binary(BinaryOp::Along) => {
                let sign = self.extra(-0.0);
                self.packed.operate(Xor, ONE, a, sign);
                self.by_sign(to, b, [y(ONE), zero, y(a)]);
            }
            Code::Unary(UnaryOp::Neg) => {
                let sign = self.extra(-0.0);
                self.packed.operate(Xor, to, a, sign);
            }
            Code::Unary(UnaryOp::Abs) => {
                let others = self.extra(EXTRAS[1]);
                self.packed.operate(And, to, a, others);
            }
            Code::Unary(UnaryOp::Sqrt) => self.packed.root(to, y(a)),
            Code::Unary(UnaryOp::Not) => {
                self.truth(a, MASK);
                self.packed.operate(AndNot, to, MASK, one);
            }
            Code::Whole(n) => self.power(to, a, n),
            Code::Compare(op) => {
                self.packed.compare(relation(op), MASK, a, y(b));
                self.packed.operate(And, to, MASK, one);
            }
            Code::Select => {
                self.truth(a, MASK);
                self.packed.blend(to, MASK, y(b), c);
            }
            Code::CompareSelect(op) => {
                self.packed.compare(relation(op), MASK, a, y(b));
                self.packed.blend(to, MASK, y(c), d);
            }
            Code::If => self.by_sign(to, a, [y(b), y(c), y(d)]),
            Code::Call(Function::Max, _) => self.extreme(to, [a, b], [a, b]),
            Code::Call(Function::Min, _) => self.extreme(to, [a, b], [b, a]),
            Code::Unary(_)
            | Code::Binary(_)
            | Code::Lookup { .. }
            | Code::Call(..)
            | Code::Partial(..) => unreachable!("only what `can` names is translated"),
        }
    }

    /// Emits `mask ← 0 < x`.
    fn truth(&mut self, x: Ymm, mask: Ymm) {
        let zero = self.extra(0.0);
        self.packed.load(OTHER, zero);
        self.packed.compare(Relation::Less, mask, OTHER, Source::Ymm(x));
    }

    /// Emits one of three numbers by the sign of a selector; no number where that is none.
    fn by_sign(&mut self, to: Ymm, selector: Ymm, [negative, at_zero, positive]: [Source; 3]) {
        let [zero, nothing] = [0.0, f64::NAN].map(|c| self.extra(c));
        self.packed.load(OTHER, nothing);
        self.packed.compare(Relation::Equal, MASK, selector, zero);
        self.packed.blend(OTHER, MASK, at_zero, OTHER);
        self.packed.load(MASK, zero);
        self.packed.compare(Relation::Less, MASK, MASK, Source::Ymm(selector));
        self.packed.blend(OTHER, MASK, positive, OTHER);
        self.packed.compare(Relation::Less, MASK, selector, zero);
        self.packed.blend(to, MASK, negative, OTHER);
    }

    /// Emits `b` where the first of a pair is less than the second, `a` where it is not, and no
    /// number where either is none.
    fn extreme(&mut self, to: Ymm, [a, b]: [Ymm; 2], [less, more]: [Ymm; 2]) {
        let y = Source::Ymm;
        self.packed.operate(Operation::Add, OTHER, a, y(b));
        self.packed.compare(Relation::LessOrEqual, MASK, more, y(less));
        self.packed.blend(OTHER, MASK, y(a), OTHER);
        self.packed.compare(Relation::Less, MASK, less, y(more));
        self.packed.blend(to, MASK, y(b), OTHER);
    }

    /// Emits a power by repeated squaring, in the order of `Scalar::powi`.
    fn power(&mut self, to: Ymm, x: Ymm, n: i32) {
        use Operation::{Divide, Multiply};
        let one = self.extra(1.0);
        let mut rest = n.unsigned_abs();
        let (mut square, mut product) = (x, None);
        while rest > 0 {
            if rest & 1 == 1 {
                product = Some(match product {
                    Some(product) => {
                        self.packed.operate(Multiply, ONE, product, Source::Ymm(square));
                        ONE
                    }
                    // one times a number; its place must outlast the next square
                    None if square == OTHER => {
                        self.packed.load(ONE, Source::Ymm(square));
                        ONE
                    }
                    None => square,
                });
            }
            rest >>= 1;
            if rest > 0 {
                self.packed.operate(Multiply, OTHER, square, Source::Ymm(square));
                square = OTHER;
            }
        }
        match product {
            None => self.packed.load(to, one),
            Some(product) if n < 0 => {
                self.packed.load(MASK, one);
                self.packed.operate(Divide, to, MASK, Source::Ymm(product));
            }
            Some(product) => self.packed.load(to, Source::Ymm(product)),
        }
    }

    fn place(&self, r: u32) -> Option<Ymm> {
        let is_it = |held: &Option<(u32, u32)>| held.is_some_and(|(slot, _)| slot == r);
        self.held.iter().position(is_it).map(|x| x as Ymm)
    }

    /// Brings a value into a vector register, where it stays for this instruction.
    fn register(&mut self, r: u32) -> Ymm {
        let x = self.place(r).unwrap_or_else(|| {
            let x = self.free();
            match self.homes[r as usize] {
                Home::Column(k) => self.packed.load_column(x, k),
                Home::Frame | Home::Nowhere => self.packed.load(x, Source::Slot(r)),
            }
            // until it is said when it is needed
            self.held[x as usize] = Some((r, 0));
            x
        });
        self.pinned |= 1 << x;
        x
    }

    /// Notes when a value is needed next.
    fn needed_next(&mut self, r: u32, next: u32) {
        if let Some(x) = self.place(r) {
            self.held[x as usize] = (next != NEVER).then_some((r, next));
        }
    }

    /// Returns the vector register for a result; it may be that of an operand.
    fn result(&mut self, r: u32, next: u32) -> Ymm {
        if let Some(before) = self.place(r) {
            self.held[before as usize] = None;
        }
        let x = self.free();
        self.homes[r as usize] = Home::Nowhere;
        self.held[x as usize] = (next != NEVER).then_some((r, next));
        x
    }

    /// Returns a vector register that holds nothing, if need be one whose value is needed last.
    fn free(&mut self) -> Ymm {
        let is_free = |&x: &Ymm| self.held[x as usize].is_none();
        if let Some(x) = (0..N_HOLDING).find(is_free) {
            return x;
        }
        let next = |&x: &Ymm| self.held[x as usize].map(|(_, next)| next);
        let x = (0..N_HOLDING)
            .filter(|x| self.pinned & 1 << x == 0)
            .max_by_key(next)
            .unwrap_or_else(|| unreachable!("an instruction has few operands"));
        if let Some((r, _)) = self.held[x as usize].take()
            && self.homes[r as usize] == Home::Nowhere
        {
            self.packed.store(x, r);
            self.homes[r as usize] = Home::Frame;
        }
        x
    }
}

fn relation(comparison: Comparison) -> Relation {
    match comparison {
        Comparison::Lt => Relation::Less,
        Comparison::Le => Relation::LessOrEqual,
        Comparison::Eq => Relation::Equal,
    }
}
