//! The translation of plain arithmetic into a loop: which values stay in registers, and the
//! instructions of each operation.

use super::super::super::super::code::{Code, Core, Instruction};
use super::super::super::super::operation::{BinaryOp, Comparison, UnaryOp};
use super::EXTRAS;
use super::packed::{Operation, Packed, Relation, Source, Ymm};
use crate::expr::functions::Function;

/// Registers that hold values; the rest are for one instruction.
const N_HOLDING: u8 = 13;
/// Most registers of one instruction: four operands and the result.
const MOST_OF_ONE: usize = 5;
const MASK: Ymm = 13;
const ONE: Ymm = 14;
const OTHER: Ymm = 15;

/// The value is not needed any more.
const NEVER: u32 = u32::MAX;

/// Returns for each instruction when its operands, in their order, and its result are needed next.
fn needs(core: &Core, code: &[Instruction], wanted: &[u32]) -> Vec<([u32; 4], u32)> {
    let mut next = vec![NEVER; core.size as usize];
    wanted
        .iter()
        .for_each(|&r| next[r as usize] = code.len() as u32);
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
    /// vector registers before this one change their values; the rest hold constants for good
    n_free: u8,
    /// vector registers of the instruction at hand
    pinned: u16,
}

/// Returns the code, and the registers whose columns it loads.
pub(super) fn translate(core: &Core, code: &[Instruction], wanted: &[u32]) -> (Vec<u8>, Vec<u32>) {
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
        n_free: N_HOLDING,
        pinned: 0,
    };
    translation.keep_constants(code);
    translation.packed.begin_loop();
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
    /// Loads constants before the loop, as many as other values leave room for.
    fn keep_constants(&mut self, code: &[Instruction]) {
        let n_constants = self.core.constants.len() as u32;
        let (mut constants, mut others) = (Vec::new(), Vec::new());
        let mut note = |r: u32| {
            let used = if r < n_constants {
                &mut constants
            } else {
                &mut others
            };
            // beyond these there is no room
            if used.len() < usize::from(N_HOLDING) && !used.contains(&r) {
                used.push(r);
            }
        };
        for instruction in code {
            self.core.operands(instruction, &mut note);
            note(instruction.to);
        }
        // constants that stay outside need places while an instruction reads them
        let room = usize::from(N_HOLDING) - others.len();
        let n_kept = match constants.len() <= room {
            true => room,
            false => room.saturating_sub(MOST_OF_ONE),
        };
        for &r in constants.iter().take(n_kept) {
            self.n_free -= 1;
            self.packed.load(self.n_free, Source::Slot(r));
            self.held[self.n_free as usize] = Some((r, 0));
        }
    }

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
        self.packed
            .compare(Relation::Less, mask, OTHER, Source::Ymm(x));
    }

    /// Emits one of three numbers by the sign of a selector; no number where that is none.
    fn by_sign(&mut self, to: Ymm, selector: Ymm, [negative, at_zero, positive]: [Source; 3]) {
        let [zero, nothing] = [0.0, f64::NAN].map(|c| self.extra(c));
        self.packed.load(OTHER, nothing);
        self.packed.compare(Relation::Equal, MASK, selector, zero);
        self.packed.blend(OTHER, MASK, at_zero, OTHER);
        self.packed.load(MASK, zero);
        self.packed
            .compare(Relation::Less, MASK, MASK, Source::Ymm(selector));
        self.packed.blend(OTHER, MASK, positive, OTHER);
        self.packed.compare(Relation::Less, MASK, selector, zero);
        self.packed.blend(to, MASK, negative, OTHER);
    }

    /// Emits `b` where the first of a pair is less than the second, `a` where it is not, and no
    /// number where either is none.
    fn extreme(&mut self, to: Ymm, [a, b]: [Ymm; 2], [less, more]: [Ymm; 2]) {
        let y = Source::Ymm;
        self.packed.operate(Operation::Add, OTHER, a, y(b));
        self.packed
            .compare(Relation::LessOrEqual, MASK, more, y(less));
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
                        self.packed
                            .operate(Multiply, ONE, product, Source::Ymm(square));
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
                self.packed
                    .operate(Multiply, OTHER, square, Source::Ymm(square));
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
        if let Some(x) = self.place(r).filter(|&x| x < self.n_free) {
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
        if let Some(x) = (0..self.n_free).find(is_free) {
            return x;
        }
        let next = |&x: &Ymm| self.held[x as usize].map(|(_, next)| next);
        let x = (0..self.n_free)
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
