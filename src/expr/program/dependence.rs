//! The directions along which an output has a derivative: the pattern of a program's Jacobian, seen
//! from its code without running it.
//!
//! ```text
//! D(input) = the directions that change it        D(a ∘ b) = D(a) ∪ D(b)
//! D(c ? a : b) = D(a) ∪ D(b)                      D(a < b) = ∅
//! ```
//!
//! A superset of what any numbers can give: products that happen to be zero count. Conditions have
//! no derivative.

use super::code::{Code, Core, Instruction};
use super::operation::{BinaryOp, UnaryOp};
use super::run::Program;

/// Directions per word.
const BITS: usize = u64::BITS as usize;

impl Program {
    /// Returns for each output the directions, ascending, along which its derivative is not zero
    /// whatever the numbers are. `along`: for each position among the inputs the directions that
    /// change it; positions beyond its end have none.
    pub fn dependence(&self, along: &[Vec<u32>]) -> Vec<Vec<u32>> {
        let core = self.core();
        let n = along.iter().flatten().map(|&d| d as usize + 1).max();
        let words = n.unwrap_or(0).div_ceil(BITS);
        let mut sets = vec![0u64; words * core.size as usize];
        let first = core.constants.len();
        for (k, &input) in core.used.iter().enumerate() {
            for &d in along.get(input as usize).map_or(&[][..], Vec::as_slice) {
                sets[(first + k) * words + d as usize / BITS] |= 1 << (d as usize % BITS);
            }
        }
        let mut sum = vec![0u64; words];
        for instruction in &core.code {
            sum.fill(0);
            core.differentiated(instruction, |register| {
                let from = register as usize * words;
                for (s, x) in sum.iter_mut().zip(&sets[from..from + words]) {
                    *s |= x;
                }
            });
            let to = instruction.to as usize * words;
            sets[to..to + words].copy_from_slice(&sum);
        }
        let members = |r: &u32| -> Vec<u32> {
            let set = &sets[*r as usize * words..][..words];
            let of_word = |(w, bits): (usize, &u64)| {
                let (first, bits) = ((w * BITS) as u32, *bits);
                (0..u64::BITS)
                    .filter(move |b| bits >> b & 1 == 1)
                    .map(move |b| first + b)
            };
            set.iter().enumerate().flat_map(of_word).collect()
        };
        core.outputs.iter().map(members).collect()
    }

    /// Returns whether an output depends on the input at a position otherwise than by straight
    /// pieces, of which each formula has a few: by a sine it may come back to a value for ever, by
    /// sums, multiples, comparisons and selections it may not.
    pub fn bends(&self, position: usize) -> bool {
        let core = self.core();
        let mut shapes = vec![Shape::Free; core.size as usize];
        let first = core.constants.len();
        for (k, &input) in core.used.iter().enumerate() {
            if input as usize == position {
                shapes[first + k] = Shape::Straight;
            }
        }
        for instruction in &core.code {
            shapes[instruction.to as usize] = core.shape(instruction, |r| shapes[r as usize]);
        }
        let mut outputs = core.outputs.iter();
        outputs.any(|&r| shapes[r as usize] == Shape::Bent)
    }
}

/// The form in which a register depends on an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Shape {
    /// not at all
    Free,
    /// by straight pieces
    Straight,
    /// by any function
    Bent,
}

impl Core {
    /// Returns the shape of the result of an instruction, from those of its operands.
    fn shape(&self, instruction: &Instruction, of: impl Fn(u32) -> Shape) -> Shape {
        let Instruction {
            code, a, b, c, d, ..
        } = *instruction;
        let joined = |all: &[u32]| all.iter().map(|&r| of(r)).fold(Shape::Free, Shape::max);
        let bent = |all: &[u32]| match joined(all) {
            Shape::Free => Shape::Free,
            Shape::Straight | Shape::Bent => Shape::Bent,
        };
        match code {
            Code::Unary(UnaryOp::Neg | UnaryOp::Abs | UnaryOp::Not) => joined(&[a]),
            Code::Binary(
                BinaryOp::Add | BinaryOp::Sub | BinaryOp::And | BinaryOp::Or | BinaryOp::Along,
            )
            | Code::Compare(_) => joined(&[a, b]),
            Code::Binary(BinaryOp::Mul) if of(a) == Shape::Free => joined(&[b]),
            Code::Binary(BinaryOp::Mul | BinaryOp::Div) if of(b) == Shape::Free => joined(&[a]),
            Code::Select => joined(&[a, b, c]),
            Code::CompareSelect(_) | Code::If => joined(&[a, b, c, d]),
            Code::Unary(_) | Code::Whole(_) | Code::Lookup { .. } => bent(&[a]),
            Code::Binary(_) => bent(&[a, b]),
            Code::HalfPower(_) => bent(&[a, b, c]),
            Code::Call(_, count) | Code::Partial(_, count, _) => bent(self.arguments(a, count)),
        }
    }

    /// Returns the registers by which the result of an instruction has derivatives.
    fn differentiated(&self, instruction: &Instruction, mut each: impl FnMut(u32)) {
        let Instruction {
            code, a, b, c, d, ..
        } = *instruction;
        match code {
            Code::Compare(_) | Code::Binary(BinaryOp::And | BinaryOp::Or) => {}
            Code::Unary(_)
            | Code::Whole(_)
            | Code::Lookup { .. }
            | Code::Binary(BinaryOp::Along | BinaryOp::Kept) => each(a),
            Code::Binary(_) => [a, b].into_iter().for_each(each),
            Code::HalfPower(_) => each(c),
            Code::Select => [b, c].into_iter().for_each(each),
            Code::CompareSelect(_) => [c, d].into_iter().for_each(each),
            Code::If => [b, c, d].into_iter().for_each(each),
            Code::Call(_, count) | Code::Partial(_, count, _) => {
                self.arguments(a, count).iter().copied().for_each(each);
            }
        }
    }
}
