//! From straight code to steps: sides of selections jumped over, functions with constant parameters
//! prepared.

mod calls;
mod circles;
mod formula;
mod results;
mod sides;
mod straight;

use super::super::code::{Code, Core, Instruction};
use super::super::operation::{BinaryOp, Comparison, UnaryOp};
use super::prepared::PreparedCall;
use super::steps::{Extra, Step, Steps};
use crate::expr::functions::Function;
use crate::expr::program::hashing::HashMap;
use results::Results;
use std::collections::BTreeSet;
use std::sync::Arc;
pub(in crate::expr::program) use straight::written_out;

/// Returns the steps of straight code.
pub(super) fn lower(core: &Core) -> Steps {
    let mut lowering = Lowering::new(core);
    for (&number, to) in core.used.iter().zip(core.constants.len() as u32..) {
        lowering.steps.push(Step::Input { number, to });
    }
    let ends = core.sides.ends();
    let mut marks = core.sides.marks.iter().zip(ends).peekable();
    let mut k = 0;
    loop {
        while let Some((&mark, end)) = marks.next_if(|(mark, _)| mark.at as usize <= k) {
            lowering.mark(mark, end);
        }
        if k == core.code.len() {
            break;
        }
        // instructions that one step performs stand between two marks
        let end = marks
            .peek()
            .map_or(core.code.len(), |(mark, _)| mark.at as usize);
        k += lowering.instructions(k, end);
    }
    circles::gathered(
        core,
        Steps {
            steps: lowering.steps,
            prepared: lowering.prepared,
            circles: Vec::new(),
            n_registers: core.size,
            extras: lowering.extras,
            asked: lowering.asked,
        },
    )
}

/// Returns whether the steps of a core are those of another core of its shape: where the numbers
/// that steps hold themselves stand at the same places among the constants, and calls read the
/// same.
pub(super) fn are_of(steps: &Steps, core: &Core, other: &Core) -> bool {
    let place = |core: &Core, bits| core.constants.iter().rposition(|c| c.to_bits() == bits);
    let bits = |core: &Core, r: u32| core.constants.get(r as usize).map(|c| c.to_bits());
    let same_tables = core.tables.len() == other.tables.len()
        && (core.tables.iter().zip(&other.tables)).all(|(x, y)| Arc::ptr_eq(x, y));
    // functions whose parameters are constant are prepared, some of them written out
    let same_parameters = || (core.lists.iter()).all(|&r| bits(core, r) == bits(other, r));
    Arc::ptr_eq(&core.shape, &other.shape)
        && same_tables
        && (steps.asked.iter()).all(|&bits| place(core, bits) == place(other, bits))
        && same_parameters()
}

/// A group of selections whose sides are being lowered.
struct Open {
    group: u32,
    /// the step that jumps to the sides
    branch: usize,
    /// steps that leave a side
    exits: Vec<usize>,
}

struct Lowering<'a> {
    core: &'a Core,
    results: Results,
    steps: Vec<Step>,
    prepared: Vec<PreparedCall>,
    extras: Vec<Extra>,
    /// slots of constants by their bits
    constants: HashMap<u64, u32>,
    /// constants that steps ask for, by their bits
    asked: BTreeSet<u64>,
    /// slots for what lies between the steps of one instruction
    between: Vec<u32>,
    open: Vec<Open>,
    /// exits of the group that was closed last, and where they lead
    closed: (Vec<usize>, usize),
}

impl<'a> Lowering<'a> {
    fn new(core: &'a Core) -> Self {
        let constants = core.constants.iter().zip(0u32..);
        Self {
            core,
            results: Results::of(core),
            steps: Vec::with_capacity(core.used.len() + core.code.len()),
            prepared: Vec::new(),
            extras: Vec::new(),
            constants: constants.map(|(c, k)| (c.to_bits(), k)).collect(),
            asked: BTreeSet::new(),
            between: Vec::new(),
            open: Vec::new(),
            closed: (Vec::new(), usize::MAX),
        }
    }

    fn extra(&mut self, extra: Extra) -> u32 {
        self.extras.push(extra);
        self.core.size + self.extras.len() as u32 - 1
    }

    /// Returns the slot of a constant.
    fn constant(&mut self, c: f64) -> u32 {
        self.asked.insert(c.to_bits());
        if let Some(&slot) = self.constants.get(&c.to_bits()) {
            return slot;
        }
        let slot = self.extra(Extra::Constant(c));
        self.constants.insert(c.to_bits(), slot);
        slot
    }

    /// Returns the `k`-th slot for what lies between the steps of one instruction.
    fn between(&mut self, k: usize) -> u32 {
        while self.between.len() <= k {
            let slot = self.extra(Extra::Between);
            self.between.push(slot);
        }
        self.between[k]
    }

    fn binary(&mut self, op: BinaryOp, a: u32, b: u32, to: u32) {
        self.steps.push(Step::Binary { op, a, b, to });
    }

    /// Emits a ? b : yes, no → to.
    fn select(&mut self, comparison: Comparison, [a, b]: [u32; 2], [yes, no]: [u32; 2], to: u32) {
        self.steps.push(Step::Select {
            comparison,
            a,
            b,
            yes,
            no,
            to,
        });
    }

    /// Lowers an instruction, perhaps with others before `end` that follow it; returns how many.
    fn instructions(&mut self, k: usize, end: usize) -> usize {
        let core = self.core;
        let instruction = core.code[k];
        match instruction.code {
            _ if self.results.is_jumped[k] => 1,
            Code::Unary(UnaryOp::Sin | UnaryOp::Cos) => self.sine_or_cosine(k, end),
            Code::Call(..) | Code::Partial(..) => self.call(k, end),
            _ => {
                self.instruction(k, &instruction);
                1
            }
        }
    }

    /// Lowers an instruction by itself.
    fn instruction(&mut self, k: usize, instruction: &Instruction) {
        use Comparison::{Eq, Le, Lt};
        let Instruction { a, b, c, d, .. } = *instruction;
        let to = self.results.to[k];
        let [zero, one] = match instruction.code {
            Code::Unary(UnaryOp::Not)
            | Code::Binary(BinaryOp::And | BinaryOp::Or)
            | Code::Compare(_)
            | Code::Select
            | Code::If => [0.0, 1.0].map(|c| self.constant(c)),
            _ => [0; 2],
        };
        match instruction.code {
            Code::Unary(UnaryOp::Neg) => {
                // −a is a·(−1), to the bit
                let minus = self.constant(-1.0);
                self.binary(BinaryOp::Mul, a, minus, to);
            }
            Code::Unary(UnaryOp::Not) => self.select(Lt, [zero, a], [zero, one], to),
            Code::Unary(op) => self.steps.push(Step::Unary { op, a, to }),
            Code::Whole(3) => {
                let square = self.between(0);
                self.binary(BinaryOp::Mul, a, a, square);
                self.binary(BinaryOp::Mul, square, a, to);
            }
            Code::Whole(4) => {
                let square = self.between(0);
                self.binary(BinaryOp::Mul, a, a, square);
                self.binary(BinaryOp::Mul, square, square, to);
            }
            Code::Binary(op @ (BinaryOp::And | BinaryOp::Or)) => {
                let second = self.between(0);
                self.select(Lt, [zero, b], [one, zero], second);
                let sides = match op {
                    BinaryOp::And => [second, zero],
                    _ => [one, second],
                };
                self.select(Lt, [zero, a], sides, to);
            }
            Code::Binary(op) => self.binary(op, a, b, to),
            Code::HalfPower(_) => self.binary(BinaryOp::Mul, a, b, to),
            Code::Compare(op) => self.select(op, [a, b], [one, zero], to),
            Code::Select => self.select(Lt, [zero, a], [b, c], to),
            Code::CompareSelect(op) => self.select(op, [a, b], [c, d], to),
            Code::If => {
                let nothing = self.constant(f64::NAN);
                let (at_zero, not_negative) = (self.between(0), self.between(1));
                self.select(Eq, [a, zero], [c, nothing], at_zero);
                self.select(Lt, [zero, a], [d, at_zero], not_negative);
                self.select(Lt, [a, zero], [b, not_negative], to);
            }
            Code::Call(function @ (Function::Max | Function::Min), 2) => {
                // the larger is b where a < b, a where b ≤ a, else a number that is none
                let list = self.core.arguments(a, 2);
                let (a, b) = (list[0], list[1]);
                let (sum, other) = (self.between(0), self.between(1));
                let (below, above) = match function {
                    Function::Max => (a, b),
                    _ => (b, a),
                };
                self.binary(BinaryOp::Add, a, b, sum);
                self.select(Le, [above, below], [a, sum], other);
                self.select(Lt, [below, above], [b, other], to);
            }
            Code::Whole(_) | Code::Lookup { .. } | Code::Call(..) | Code::Partial(..) => {
                self.steps.push(Step::Instruction { number: k as u32 });
                if to != instruction.to {
                    let from = instruction.to;
                    self.steps.push(Step::Copy { from, to });
                }
            }
        }
    }

    /// Lowers a sine or a cosine, with the other of the same angle if that is next.
    fn sine_or_cosine(&mut self, k: usize, end: usize) -> usize {
        let this = self.core.code[k];
        let next = self.core.code[k + 1..end].first();
        let both = match (this.code, next) {
            (Code::Unary(UnaryOp::Sin), Some(next)) => {
                (next.code == Code::Unary(UnaryOp::Cos)).then_some([k, k + 1])
            }
            (Code::Unary(UnaryOp::Cos), Some(next)) => {
                (next.code == Code::Unary(UnaryOp::Sin)).then_some([k + 1, k])
            }
            _ => None,
        };
        let same = next.is_some_and(|next| next.a == this.a && this.to != this.a);
        let Some([sine, cosine]) = both.filter(|_| same) else {
            self.instruction(k, &this);
            return 1;
        };
        self.steps.push(Step::SineCosine {
            a: this.a,
            sine: self.results.to[sine],
            cosine: self.results.to[cosine],
        });
        2
    }
}
