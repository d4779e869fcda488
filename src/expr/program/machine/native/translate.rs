//! From steps to machine code: results stay in vector registers as long as there is room, and are
//! stored when they must be.
//!
//! A result is stored before its register is given away, before a call and at the end, and only if
//! it is still needed; jumps leave it where it is (`joins.rs`). The register that is
//! given away is the one whose value is needed last. Constants, inputs that were stored and other
//! numbers in the frame are operands where they stand. Outputs have their places outside.

use super::super::super::code::Core;
use super::super::super::operation::{BinaryOp, Comparison, UnaryOp};
use super::super::steps::{Step, Steps};
use super::assembler::{self, Assembler, Instruction, Place, Relation, When, Xmm};
use super::calls;
use super::held::{Held, Holding, Landing, N_HOLDING, ONE, OTHER};
use super::needs::{NEVER, Next, needs};
use crate::expr::program::hashing::HashMap;

/// In no register.
const NOWHERE: u8 = u8::MAX;

pub(super) struct Translation<'a> {
    pub(super) assembler: Assembler,
    pub(super) held: Holding,
    /// by slot: the register
    pub(super) places: Vec<u8>,
    /// by slot: where it stands in memory
    homes: Vec<Place>,
    /// by slot: the last step behind a jump that may need it
    pub(super) last_read: Vec<u32>,
    /// registers that the step at hand still needs
    pinned: u16,
    /// by step: what leads there
    pub(super) landings: HashMap<u32, Landing>,
    /// whether the processor has AVX
    has_avx: bool,
    /// whether one gets here by going on
    pub(super) is_reached: bool,
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

/// Returns the code of these steps, with AVX or without; `calls` are the steps that are called, by
/// number.
pub(super) fn translate(
    steps: &Steps,
    core: &Core,
    calls: &HashMap<u32, Call>,
    has_avx: bool,
) -> Vec<u8> {
    let is_target = steps.jumped_to();
    let (needs, last_read) = needs(steps, core, &is_target);
    let mut translation = Translation {
        assembler: Assembler::new(steps.steps.iter().any(is_call), steps.steps.len()),
        held: [None; N_HOLDING],
        places: vec![NOWHERE; steps.n_slots()],
        homes: homes(steps, core),
        last_read,
        pinned: 0,
        landings: HashMap::default(),
        has_avx,
        is_reached: true,
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
    translation.outputs(&core.outputs);
    translation.assembler.finish()
}

/// Returns by slot where it stands in memory: outputs in their places, the rest in the frame, and
/// there as well what is called for.
fn homes(steps: &Steps, core: &Core) -> Vec<Place> {
    let mut homes: Vec<Place> = (0..steps.n_slots() as u32).map(Place::Slot).collect();
    for (k, &slot) in (0u32..).zip(&core.outputs) {
        let home = &mut homes[slot as usize];
        let is_constant = (slot as usize) < core.constants.len();
        if !is_constant && *home == Place::Slot(slot) {
            *home = Place::Output(k);
        }
    }
    for step in &steps.steps {
        steps.slots_of_called(step, core, |slot| homes[slot as usize] = Place::Slot(slot));
    }
    homes
}

impl Translation<'_> {
    /// Leaves the outputs in their places, and the first as the result.
    fn outputs(&mut self, outputs: &[u32]) {
        self.store_all();
        for (k, &slot) in (0u32..).zip(outputs) {
            if self.homes[slot as usize] != Place::Output(k) {
                let x = self.readable(slot, ONE);
                self.assembler.store(x, Place::Output(k));
            }
        }
        if let Some(&first) = outputs.first() {
            let place = self.place(first);
            self.assembler.load(0, place);
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
                Some(instruction) if self.has_avx => {
                    self.arithmetic_by_avx(op, instruction, [a, b], to, next);
                }
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
                self.jump(When::Always, target);
                self.forget();
                self.is_reached = false;
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

    fn arithmetic_by_avx(
        &mut self,
        op: BinaryOp,
        instruction: Instruction,
        [mut a, mut b]: [u32; 2],
        to: u32,
        next: &Next,
    ) {
        let [mut next_of_a, mut next_of_b, ..] = next.operands;
        // the first operand is in a register
        let is_symmetric = matches!(op, BinaryOp::Add | BinaryOp::Mul);
        if is_symmetric && self.register(a) == NOWHERE {
            (a, b) = (b, a);
            (next_of_a, next_of_b) = (next_of_b, next_of_a);
        }
        let second = self.place(b);
        let first = self.readable(a, ONE);
        // the result may take the place of an operand
        self.used_once(a, next_of_a);
        self.used_once(b, next_of_b);
        self.pinned = 0;
        for place in [Place::Xmm(first), second] {
            if let Place::Xmm(x) = place
                && self.held.get(usize::from(x)).is_some_and(Option::is_some)
            {
                self.pinned |= 1 << x;
            }
        }
        let x = self.take();
        self.assembler.operate_on(instruction, x, first, second);
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
        if self.has_avx {
            let first = self.readable(a, ONE);
            self.assembler.mask_on(OTHER, relation, first, b_at);
            let [yes, no] = [self.readable(yes, ONE), self.readable(no, x)];
            self.assembler.blend(x, OTHER, yes, no);
        } else {
            self.assembler.load(OTHER, a_at);
            self.assembler.mask(OTHER, relation, b_at);
            self.assembler.load(ONE, yes_at);
            self.bits(assembler::AND, ONE, OTHER);
            self.assembler.load(x, no_at);
            self.bits(assembler::AND_NOT, OTHER, x);
            self.bits(assembler::OR, OTHER, ONE);
            self.assembler.copy(x, OTHER);
        }
        self.used([a, b, yes, no], next);
        self.hold(x, to, next.results[0]);
    }

    fn bits(&mut self, op: Instruction, x: Xmm, y: Xmm) {
        self.assembler.operate(op, x, Place::Xmm(y));
    }

    /// Returns the register of a slot.
    fn register(&self, slot: u32) -> u8 {
        self.places[slot as usize]
    }

    /// Returns where the value of a slot stands. It stays there for this step.
    pub(super) fn place(&mut self, slot: u32) -> Place {
        match self.register(slot) {
            NOWHERE => self.homes[slot as usize],
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
        let free = (0..N_HOLDING as u8)
            .find(|&x| self.held[x as usize].is_none() && self.pinned & 1 << x == 0);
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
        self.held[x as usize] = Some(Held { slot, next });
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
        }
    }

    /// Stores a value in its place in memory.
    pub(super) fn store(&mut self, x: Xmm) {
        if let Some(held) = self.held[x as usize] {
            let home = self.homes[held.slot as usize];
            self.assembler.store(x, home);
        }
    }

    fn store_all(&mut self) {
        for x in 0..N_HOLDING as u8 {
            self.store(x);
        }
    }

    pub(super) fn forget(&mut self) {
        for x in 0..N_HOLDING as u8 {
            self.release(x);
        }
    }
}
