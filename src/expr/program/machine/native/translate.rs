//! From steps to machine code: results stay in vector registers as long as there is room, and are stored when they must be.
//!
//! A result is stored before its register is given away, before a jump, a label, a call and at the end, and only if it is still
//! needed. The register that is given away is the one whose value is needed last. Constants, inputs that were stored and other
//! numbers in the frame are operands where they stand.

use super::super::{Op, handlers};
use super::assembler::{self, Assembler, Instruction, Jump, Place, Relation, When, Xmm};
use super::steps::{NEVER, Next, Step, Steps};
use handlers::{ADD, ALONG, DIV, MUL, SQRT, SUB};
use std::collections::HashMap;

/// Registers that hold values of slots; the two behind them are for what lies between two instructions.
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
    /// by slot: the register
    places: Vec<u8>,
    /// slots from here on are constants
    first_constant: usize,
    /// registers that the step at hand still needs
    pinned: u16,
    /// by operation: the jumps that lead there
    jumps: HashMap<u32, Vec<Jump>>,
    /// by operation: the address of what is called
    calls: &'a HashMap<u32, *const Op>,
}

/// The code of these steps; `calls` are the operations that are called.
pub(super) fn translate(
    steps: &Steps,
    calls: &HashMap<u32, *const Op>,
    outputs: &[u32],
) -> Vec<u8> {
    let mut translation = Translation {
        assembler: Assembler::new(steps.has_calls),
        held: [None; N_HOLDING],
        places: vec![NOWHERE; steps.first_constant],
        first_constant: steps.first_constant,
        pinned: 0,
        jumps: HashMap::new(),
        calls,
    };
    for (&step, next) in steps.steps.iter().zip(&steps.next) {
        translation.step(step, next, outputs);
    }
    translation.assembler.finish(&steps.constants)
}

impl Translation<'_> {
    fn step(&mut self, step: Step, next: &Next, outputs: &[u32]) {
        self.pinned = 0;
        match step {
            Step::Label(op) => {
                self.store_all();
                self.forget();
                for jump in self.jumps.remove(&op).unwrap_or_default() {
                    self.assembler.lands(jump);
                }
            }
            Step::Input { number, to } => {
                let x = self.take();
                self.assembler.load(x, Place::Input(number));
                self.hold(x, to, next[4]);
            }
            Step::Arithmetic { code, a, b, to } => self.arithmetic(code, [a, b], to, next),
            Step::Copy { from, to } => {
                let x = self.own(from, next[0]);
                self.hold(x, to, next[4]);
            }
            Step::Select {
                comparison,
                a,
                b,
                yes,
                no,
                to,
            } => self.select(comparison, [a, b, yes, no], to, next),
            Step::Unless {
                comparison,
                a,
                b,
                target,
            } => {
                // a < b is b > a, which does not hold where one of them is no number
                let (first, second) = if comparison == 2 { (a, b) } else { (b, a) };
                let x = self.readable(first, ONE);
                let second = self.place(second);
                self.used([a, b], next);
                self.store_all();
                self.assembler.operate(assembler::COMPARE, x, second);
                match comparison {
                    0 => self.jump(When::BelowOrEqual, target),
                    1 => self.jump(When::Below, target),
                    _ => {
                        self.jump(When::NotEqual, target);
                        self.jump(When::Unordered, target);
                    }
                }
            }
            Step::Branch {
                selector,
                negative,
                zero,
                positive,
            } => {
                let x = self.readable(selector, ONE);
                self.used([selector], next);
                self.store_all();
                let op = assembler::XOR;
                self.assembler.operate(op, OTHER, Place::Xmm(OTHER));
                self.assembler
                    .operate(assembler::COMPARE, x, Place::Xmm(OTHER));
                let on = self.assembler.jump(When::Unordered);
                self.jump(When::Below, negative);
                self.jump(When::Above, positive);
                self.jump(When::Always, zero);
                self.assembler.lands(on);
            }
            Step::Go { target } => {
                self.store_all();
                self.jump(When::Always, target);
                self.forget();
            }
            Step::Call { op, acc } => {
                self.store_all();
                if let Some(acc) = acc {
                    let place = self.place(acc);
                    self.assembler.load(0, place);
                }
                self.forget();
                let op = self.calls[&op];
                // SAFETY: the operation is among those that are kept for the code
                let handler = unsafe { (*op).run } as usize;
                self.assembler.call(handler, op.expose_provenance());
            }
            Step::End => {
                self.store_all();
                if let &[output] = outputs {
                    let place = self.place(output);
                    self.assembler.load(0, place);
                }
                self.assembler.end();
            }
        }
    }

    fn arithmetic(&mut self, code: u8, [mut a, mut b]: [u32; 2], to: u32, next: &Next) {
        let [mut next_of_a, mut next_of_b, ..] = *next;
        let op = match code {
            SQRT => return self.root(a, to, next),
            ADD => assembler::ADD,
            SUB => assembler::SUBTRACT,
            MUL => assembler::MULTIPLY,
            DIV => assembler::DIVIDE,
            ALONG => return self.along(a, b, to, next),
            _ => return self.magnitude(a, to, next),
        };
        // the result takes the place of an operand that is not needed any more
        let goes =
            |this: &Self, slot: u32, next: u32| next == NEVER && this.register(slot) != NOWHERE;
        let is_symmetric = matches!(code, ADD | MUL);
        if is_symmetric && goes(self, b, next_of_b) && !goes(self, a, next_of_a) {
            (a, b) = (b, a);
            (next_of_a, next_of_b) = (next_of_b, next_of_a);
        }
        let second = self.place(b);
        let x = self.own(a, next_of_a);
        self.assembler.operate(op, x, second);
        self.used_once(b, next_of_b);
        self.hold(x, to, next[4]);
    }

    fn root(&mut self, a: u32, to: u32, next: &Next) {
        let x = self.own(a, next[0]);
        self.assembler.operate(assembler::ROOT, x, Place::Xmm(x));
        self.hold(x, to, next[4]);
    }

    fn magnitude(&mut self, a: u32, to: u32, next: &Next) {
        let x = self.own(a, next[0]);
        self.assembler.all_but_sign_bit(OTHER);
        self.bits(assembler::AND, x, OTHER);
        self.hold(x, to, next[4]);
    }

    /// −a, 0 or a by the sign of b; no number where b is none.
    fn along(&mut self, a: u32, b: u32, to: u32, next: &Next) {
        let sign = self.place(b);
        let x = self.own(a, next[0]);
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
        self.used_once(b, next[1]);
        self.hold(x, to, next[4]);
    }

    fn select(&mut self, comparison: u8, [a, b, yes, no]: [u32; 4], to: u32, next: &Next) {
        let relation = match comparison {
            0 => Relation::Less,
            1 => Relation::LessOrEqual,
            _ => Relation::Equal,
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
        self.hold(x, to, next[4]);
    }

    fn bits(&mut self, op: Instruction, x: Xmm, y: Xmm) {
        self.assembler.operate(op, x, Place::Xmm(y));
    }

    fn jump(&mut self, when: When, target: u32) {
        let jump = self.assembler.jump(when);
        self.jumps.entry(target).or_default().push(jump);
    }

    /// The register of a slot.
    fn register(&self, slot: u32) -> u8 {
        self.places.get(slot as usize).copied().unwrap_or(NOWHERE)
    }

    /// Where the value of a slot stands. It stays there for this step.
    fn place(&mut self, slot: u32) -> Place {
        match self.register(slot) {
            _ if slot as usize >= self.first_constant => {
                Place::Constant(slot - self.first_constant as u32)
            }
            NOWHERE => Place::Slot(slot),
            x => {
                self.pinned |= 1 << x;
                Place::Xmm(x)
            }
        }
    }

    /// The value of a slot in a register that must not be changed: its own, or `scratch`.
    fn readable(&mut self, slot: u32, scratch: Xmm) -> Xmm {
        match self.place(slot) {
            Place::Xmm(x) => x,
            place => {
                self.assembler.load(scratch, place);
                scratch
            }
        }
    }

    /// The value of a slot in a register that may be changed: its own if it is not needed any more.
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

    /// A free register, if need be one whose value is needed late.
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

    /// A register holds the new value of a slot.
    fn hold(&mut self, x: Xmm, slot: u32, next: u32) {
        let before = self.places[slot as usize];
        if before != NOWHERE {
            self.release(before);
        }
        if next == NEVER {
            return;
        }
        self.places[slot as usize] = x;
        self.held[x as usize] = Some(Held {
            slot,
            is_stored: false,
            next,
        });
    }

    /// Notes when slots that were read are needed again.
    fn used<const N: usize>(&mut self, slots: [u32; N], next: &Next) {
        for (slot, next) in slots.into_iter().zip(next) {
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
        for x in 0..N_HOLDING as u8 {
            self.store(x);
        }
    }

    fn forget(&mut self) {
        for x in 0..N_HOLDING as u8 {
            self.release(x);
        }
    }
}
