//! From steps to machine code: results stay in vector registers as long as there is room, and are
//! stored when they must be.
//!
//! A result is stored before its register is given away, before a jump or its target, before a call
//! and at the end, and only if it is still needed. The register that is given away is the one whose
//! value is needed last. Constants, inputs that were stored and other numbers in the frame are
//! operands where they stand.

use super::super::super::code::Core;
use super::super::super::operation::{BinaryOp, Comparison, UnaryOp};
use super::super::steps::{Step, Steps};
use super::assembler::{self, Assembler, Instruction, Jump, Place, Relation, When, Xmm};
use super::calls;
use super::needs::{NEVER, Next, needs};
use crate::expr::program::hashing::HashMap;

/// Registers that hold values of slots; the two behind them are for what lies between two
/// instructions.
const N_HOLDING: usize = 14;
const ONE: Xmm = 14;
const OTHER: Xmm = 15;

/// In no register.
const NOWHERE: u8 = u8::MAX;

/// A value in a register.
#[derive(Clone, Copy, Debug)]
struct Held {
    slot: u32,
    /// the frame has it, too
    is_stored: bool,
    /// when it is needed again
    next: u32,
}

struct Translation<'a> {
    assembler: Assembler,
    held: [Option<Held>; N_HOLDING],
    /// registers that hold nothing, a bit each
    free: u16,
    /// by slot: the register
    places: Vec<u8>,
    /// registers that the step at hand still needs
    pinned: u16,
    /// by step: the jumps that lead there
    jumps: HashMap<u32, Vec<Jump>>,
    /// by step: what is called for it
    calls: &'a HashMap<u32, Call>,
}

/// A function that performs a step, given an address and the frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Call {
    pub(super) function: usize,
    pub(super) argument: usize,
}

/// Returns whether a step calls anything.
fn is_call(step: &Step) -> bool {
    match step {
        Step::Unary { op, .. } => !matches!(op, UnaryOp::Sqrt | UnaryOp::Abs),
        Step::Binary { op, .. } => {
            instruction(*op).is_none() && !matches!(op, BinaryOp::Along | BinaryOp::Kept)
        }
        Step::SineCosine { .. }
        | Step::Circle { .. }
        | Step::Instruction { .. }
        | Step::Prepared { .. } => true,
        Step::Input { .. }
        | Step::Copy { .. }
        | Step::Select { .. }
        | Step::Unless { .. }
        | Step::Branch { .. }
        | Step::Go { .. } => false,
    }
}

/// Returns the instruction of the processor for an operation, if there is one.
fn instruction(op: BinaryOp) -> Option<Instruction> {
    match op {
        BinaryOp::Add => Some(assembler::ADD),
        BinaryOp::Sub => Some(assembler::SUBTRACT),
        BinaryOp::Mul => Some(assembler::MULTIPLY),
        BinaryOp::Div => Some(assembler::DIVIDE),
        BinaryOp::Pow
        | BinaryOp::Atan2
        | BinaryOp::Rem
        | BinaryOp::And
        | BinaryOp::Or
        | BinaryOp::Along
        | BinaryOp::Kept => None,
    }
}

/// Returns the code of these steps; `calls` are the steps that are called, by number.
pub(super) fn translate(steps: &Steps, core: &Core, calls: &HashMap<u32, Call>) -> Vec<u8> {
    let is_target = steps.jumped_to();
    let needs = needs(steps, core, &is_target);
    let mut translation = Translation {
        assembler: Assembler::new(steps.steps.iter().any(is_call), steps.steps.len()),
        held: [None; N_HOLDING],
        free: (1 << N_HOLDING) - 1,
        places: vec![NOWHERE; steps.n_slots()],
        pinned: 0,
        jumps: HashMap::default(),
        calls,
    };
    for (k, (step, next)) in (0u32..).zip(steps.steps.iter().zip(&needs)) {
        if is_target[k as usize] {
            translation.target(k);
        }
        translation.step(k, *step, next);
    }
    let end = steps.steps.len();
    if is_target[end] {
        translation.target(end as u32);
    }
    translation.store_all();
    if let Some(&output) = core.outputs.first() {
        let place = translation.place(output);
        translation.assembler.load(0, place);
    }
    translation.assembler.finish()
}

impl Translation<'_> {
    /// Jumps lead here.
    fn target(&mut self, step: u32) {
        self.store_all();
        self.forget();
        for jump in self.jumps.remove(&step).unwrap_or_default() {
            self.assembler.lands(jump);
        }
    }

    fn step(&mut self, k: u32, step: Step, next: &Next) {
        self.pinned = 0;
        let result = next.results[0];
        match step {
            Step::Input { number, to } => {
                let x = self.take();
                self.assembler.load(x, Place::Input(number));
                self.hold(x, to, result);
            }
            Step::Copy { from, to } => {
                let x = self.own(from, next.operands[0]);
                self.hold(x, to, result);
            }
            Step::Unary { op, a, to } => match op {
                UnaryOp::Sqrt => self.root(a, to, next),
                UnaryOp::Abs => self.magnitude(a, to, next),
                op => {
                    self.call(calls::of_one_number(op), [a], next);
                    self.hold(0, to, result);
                }
            },
            Step::Binary { op, a, b, to } => match instruction(op) {
                Some(instruction) => self.arithmetic(op, instruction, [a, b], to, next),
                None if op == BinaryOp::Along => self.along(a, b, to, next),
                None if op == BinaryOp::Kept => self.kept(a, b, to, next),
                None => {
                    self.call(calls::of_two_numbers(op), [a, b], next);
                    self.hold(0, to, result);
                }
            },
            Step::SineCosine { a, sine, cosine } => {
                self.call(calls::of_sine_and_cosine(), [a], next);
                self.hold(0, sine, result);
                self.hold(1, cosine, next.results[1]);
            }
            Step::Select {
                comparison,
                a,
                b,
                yes,
                no,
                to,
            } => self.select(comparison, [a, b, yes, no], to, next),
            Step::Circle { .. } | Step::Instruction { .. } | Step::Prepared { .. } => {
                self.store_all();
                self.forget();
                let Call { function, argument } = self.calls[&k];
                self.assembler.call_with_frame(function, argument);
            }
            Step::Unless {
                comparison,
                a,
                b,
                target,
            } => self.unless(comparison, [a, b], target, next),
            Step::Branch {
                selector,
                negative,
                zero,
                positive,
            } => self.branch(selector, [negative, zero, positive], next),
            Step::Go { target } => {
                self.store_all();
                self.jump(When::Always, target);
                self.forget();
            }
        }
    }

    /// Calls a function of one or two numbers; what is still needed is stored before.
    fn call<const N: usize>(&mut self, function: usize, slots: [u32; N], next: &Next) {
        for (scratch, &slot) in [ONE, OTHER].into_iter().zip(&slots) {
            let place = self.place(slot);
            self.assembler.load(scratch, place);
        }
        self.used(slots, next);
        self.store_all();
        self.forget();
        for (argument, scratch) in (0..N as Xmm).zip([ONE, OTHER]) {
            self.assembler.copy(argument, scratch);
        }
        self.assembler.call(function);
    }

    fn unless(&mut self, comparison: Comparison, [a, b]: [u32; 2], target: u32, next: &Next) {
        // a < b is b > a, which does not hold where one of them is no number
        let (first, second) = match comparison {
            Comparison::Eq => (a, b),
            Comparison::Lt | Comparison::Le => (b, a),
        };
        let x = self.readable(first, ONE);
        let second = self.place(second);
        self.used([a, b], next);
        self.store_all();
        self.assembler.operate(assembler::COMPARE, x, second);
        match comparison {
            Comparison::Lt => self.jump(When::BelowOrEqual, target),
            Comparison::Le => self.jump(When::Below, target),
            Comparison::Eq => {
                self.jump(When::NotEqual, target);
                self.jump(When::Unordered, target);
            }
        }
    }

    fn branch(&mut self, selector: u32, [negative, zero, positive]: [u32; 3], next: &Next) {
        let x = self.readable(selector, ONE);
        self.used([selector], next);
        self.store_all();
        self.bits(assembler::XOR, OTHER, OTHER);
        self.assembler
            .operate(assembler::COMPARE, x, Place::Xmm(OTHER));
        let on = self.assembler.jump(When::Unordered);
        self.jump(When::Below, negative);
        self.jump(When::Above, positive);
        self.jump(When::Always, zero);
        self.assembler.lands(on);
    }

    fn arithmetic(
        &mut self,
        op: BinaryOp,
        instruction: Instruction,
        [mut a, mut b]: [u32; 2],
        to: u32,
        next: &Next,
    ) {
        let [mut next_of_a, mut next_of_b, ..] = next.operands;
        // the result takes the place of an operand that is not needed any more
        let goes =
            |this: &Self, slot: u32, next: u32| next == NEVER && this.register(slot) != NOWHERE;
        let is_symmetric = matches!(op, BinaryOp::Add | BinaryOp::Mul);
        if is_symmetric && goes(self, b, next_of_b) && !goes(self, a, next_of_a) {
            (a, b) = (b, a);
            (next_of_a, next_of_b) = (next_of_b, next_of_a);
        }
        let second = self.place(b);
        let x = self.own(a, next_of_a);
        self.assembler.operate(instruction, x, second);
        self.used_once(b, next_of_b);
        self.hold(x, to, next.results[0]);
    }

    fn root(&mut self, a: u32, to: u32, next: &Next) {
        let x = self.own(a, next.operands[0]);
        self.assembler.operate(assembler::ROOT, x, Place::Xmm(x));
        self.hold(x, to, next.results[0]);
    }

    fn magnitude(&mut self, a: u32, to: u32, next: &Next) {
        let x = self.own(a, next.operands[0]);
        self.assembler.all_but_sign_bit(OTHER);
        self.bits(assembler::AND, x, OTHER);
        self.hold(x, to, next.results[0]);
    }

    /// Emits −a, 0 or a by the sign of b; no number where b is none.
    fn along(&mut self, a: u32, b: u32, to: u32, next: &Next) {
        let sign = self.place(b);
        let x = self.own(a, next.operands[0]);
        // a with the sign of b reversed or not
        self.assembler.load(ONE, sign);
        self.assembler.sign_bit(OTHER);
        self.bits(assembler::AND, OTHER, ONE);
        self.bits(assembler::XOR, x, OTHER);
        // nothing where b is zero
        self.bits(assembler::XOR, OTHER, OTHER);
        self.assembler
            .mask(OTHER, Relation::NotEqual, Place::Xmm(ONE));
        self.bits(assembler::AND, x, OTHER);
        // all bits set are no number
        self.assembler
            .mask(ONE, Relation::Unordered, Place::Xmm(ONE));
        self.bits(assembler::OR, x, ONE);
        self.used_once(b, next.operands[1]);
        self.hold(x, to, next.results[0]);
    }

    /// Emits a − (b − b): a where b is finite.
    fn kept(&mut self, a: u32, b: u32, to: u32, next: &Next) {
        let watched = self.place(b);
        let x = self.own(a, next.operands[0]);
        self.assembler.load(ONE, watched);
        let itself = Place::Xmm(ONE);
        self.assembler.operate(assembler::SUBTRACT, ONE, itself);
        self.assembler.operate(assembler::SUBTRACT, x, itself);
        self.used_once(b, next.operands[1]);
        self.hold(x, to, next.results[0]);
    }

    fn select(&mut self, comparison: Comparison, [a, b, yes, no]: [u32; 4], to: u32, next: &Next) {
        let relation = match comparison {
            Comparison::Lt => Relation::Less,
            Comparison::Le => Relation::LessOrEqual,
            Comparison::Eq => Relation::Equal,
        };
        let [a_at, b_at, yes_at, no_at] = [a, b, yes, no].map(|slot| self.place(slot));
        let x = self.take();
        self.assembler.load(OTHER, a_at);
        self.assembler.mask(OTHER, relation, b_at);
        self.assembler.load(ONE, yes_at);
        self.bits(assembler::AND, ONE, OTHER);
        self.assembler.load(x, no_at);
        self.bits(assembler::AND_NOT, OTHER, x);
        self.bits(assembler::OR, OTHER, ONE);
        self.assembler.copy(x, OTHER);
        self.used([a, b, yes, no], next);
        self.hold(x, to, next.results[0]);
    }

    fn bits(&mut self, op: Instruction, x: Xmm, y: Xmm) {
        self.assembler.operate(op, x, Place::Xmm(y));
    }

    fn jump(&mut self, when: When, target: u32) {
        let jump = self.assembler.jump(when);
        self.jumps.entry(target).or_default().push(jump);
    }

    /// Returns the register of a slot.
    fn register(&self, slot: u32) -> u8 {
        self.places[slot as usize]
    }

    /// Returns where the value of a slot stands. It stays there for this step.
    fn place(&mut self, slot: u32) -> Place {
        match self.register(slot) {
            NOWHERE => Place::Slot(slot),
            x => {
                self.pinned |= 1 << x;
                Place::Xmm(x)
            }
        }
    }

    /// Brings the value of a slot into a register that must not be changed: its own, or `scratch`.
    fn readable(&mut self, slot: u32, scratch: Xmm) -> Xmm {
        match self.place(slot) {
            Place::Xmm(x) => x,
            place => {
                self.assembler.load(scratch, place);
                scratch
            }
        }
    }

    /// Brings the value of a slot into a register that may be changed: its own if it is not needed
    /// any more.
    fn own(&mut self, slot: u32, next: u32) -> Xmm {
        let place = self.place(slot);
        if let (Place::Xmm(x), NEVER) = (place, next) {
            self.release(x);
            return x;
        }
        let x = self.take();
        self.assembler.load(x, place);
        self.used_once(slot, next);
        x
    }

    /// Takes a free register, if need be one whose value is needed late.
    fn take(&mut self) -> Xmm {
        let free = self.free & !self.pinned;
        let free = (free != 0).then(|| free.trailing_zeros() as Xmm);
        let x = free.unwrap_or_else(|| {
            let next = |x: &u8| self.held[*x as usize].map(|held| held.next);
            let x = (0..N_HOLDING as u8)
                .filter(|x| self.pinned & 1 << x == 0)
                .max_by_key(next)
                .unwrap_or_else(|| unreachable!("a step needs few registers"));
            self.store(x);
            self.release(x);
            x
        });
        self.pinned |= 1 << x;
        x
    }

    /// Notes that a register holds the new value of a slot.
    fn hold(&mut self, x: Xmm, slot: u32, next: u32) {
        let before = self.places[slot as usize];
        if before != NOWHERE {
            self.release(before);
        }
        if next == NEVER {
            return;
        }
        self.places[slot as usize] = x;
        self.free &= !(1 << x);
        self.held[x as usize] = Some(Held {
            slot,
            is_stored: false,
            next,
        });
    }

    /// Notes when slots that were read are needed again.
    fn used<const N: usize>(&mut self, slots: [u32; N], next: &Next) {
        for (slot, next) in slots.into_iter().zip(&next.operands) {
            self.used_once(slot, *next);
        }
    }

    fn used_once(&mut self, slot: u32, next: u32) {
        let x = self.register(slot);
        if x == NOWHERE {
            return;
        }
        if next == NEVER {
            self.release(x);
        } else if let Some(held) = &mut self.held[x as usize] {
            held.next = next;
        }
    }

    fn release(&mut self, x: Xmm) {
        if let Some(held) = self.held[x as usize].take() {
            self.places[held.slot as usize] = NOWHERE;
            self.free |= 1 << x;
        }
    }

    /// Stores a value that the frame does not have.
    fn store(&mut self, x: Xmm) {
        if let Some(held) = &mut self.held[x as usize]
            && !held.is_stored
        {
            held.is_stored = true;
            self.assembler.store(x, held.slot);
        }
    }

    fn store_all(&mut self) {
        let mut left = !self.free & ((1 << N_HOLDING) - 1);
        while left != 0 {
            self.store(left.trailing_zeros() as Xmm);
            left &= left - 1;
        }
    }

    fn forget(&mut self) {
        let mut left = !self.free & ((1 << N_HOLDING) - 1);
        while left != 0 {
            self.release(left.trailing_zeros() as Xmm);
            left &= left - 1;
        }
    }
}
