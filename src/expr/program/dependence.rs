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
use std::collections::HashMap;

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
                let (first, mut left) = ((w * BITS) as u32, *bits);
                std::iter::from_fn(move || {
                    let b = (left != 0).then(|| left.trailing_zeros())?;
                    left &= left - 1;
                    Some(first + b)
                })
            };
            set.iter().enumerate().flat_map(of_word).collect()
        };
        core.outputs.iter().map(members).collect()
    }

    /// Returns of each output whether it reads any of the inputs at some positions, be it to choose
    /// a branch.
    pub fn outputs_reading(&self, positions: &[usize]) -> Vec<bool> {
        let core = self.core();
        let mut reads = vec![false; core.size as usize];
        for (k, &input) in core.used.iter().enumerate() {
            reads[core.constants.len() + k] = positions.contains(&(input as usize));
        }
        for instruction in &core.code {
            let mut any = false;
            core.operands(instruction, |register| any |= reads[register as usize]);
            reads[instruction.to as usize] = any;
        }
        core.outputs.iter().map(|&r| reads[r as usize]).collect()
    }

    /// Returns of each position among the inputs whether an output depends on it otherwise than by
    /// straight pieces, of which each formula has a few: by a sine it may come back to a value for
    /// ever, by sums, multiples, comparisons and selections it may not.
    pub fn bends(&self, positions: &[usize]) -> Vec<bool> {
        let core = self.core();
        let words = positions.len().div_ceil(BITS);
        let mut shapes = Shapes {
            words,
            reads: vec![0; words * core.size as usize],
            bent: vec![0; words * core.size as usize],
        };
        let asked: HashMap<usize, usize> = (positions.iter().enumerate())
            .map(|(k, &position)| (position, k))
            .collect();
        for (k, &input) in core.used.iter().enumerate() {
            if let Some(&bit) = asked.get(&(input as usize)) {
                let register = core.constants.len() + k;
                shapes.reads[register * words + bit / BITS] |= 1 << (bit % BITS);
            }
        }
        for instruction in &core.code {
            core.shape(instruction, &mut shapes);
        }
        let bent = |&position: &usize| {
            let bit = asked[&position];
            let of = |&r: &u32| shapes.bent[r as usize * words + bit / BITS];
            let mut outputs = core.outputs.iter();
            outputs.any(|r| of(r) >> (bit % BITS) & 1 == 1)
        };
        positions.iter().map(bent).collect()
    }
}

/// The positions on which registers depend: a bit for each   (words × registers)
struct Shapes {
    words: usize,
    /// at all
    reads: Vec<u64>,
    /// otherwise than by straight pieces
    bent: Vec<u64>,
}

/// The way in which an operation passes its operands' shapes on.
enum Passing<'a> {
    /// by straight pieces
    Straight(&'a [u32]),
    /// by any function
    Bent(&'a [u32]),
    /// as a product: straight in each factor where the other does not depend on it
    Product(u32, u32),
    /// as a quotient: straight in the dividend where the divisor does not depend on it
    Quotient(u32, u32),
}

impl Shapes {
    /// Sets the shape of the result `to` of an operation.
    fn set(&mut self, to: u32, passing: &Passing) {
        for w in 0..self.words {
            let at = |r: u32| r as usize * self.words + w;
            let reads = |r: u32| self.reads[at(r)];
            let bent = |r: u32| self.bent[at(r)];
            let all_read = |all: &[u32]| all.iter().fold(0, |sum, &r| sum | reads(r));
            let (read, is_bent) = match *passing {
                Passing::Straight(all) => {
                    (all_read(all), all.iter().fold(0, |sum, &r| sum | bent(r)))
                }
                Passing::Bent(all) => (all_read(all), all_read(all)),
                Passing::Product(a, b) => {
                    (reads(a) | reads(b), bent(a) | bent(b) | reads(a) & reads(b))
                }
                Passing::Quotient(a, b) => (reads(a) | reads(b), bent(a) | reads(b)),
            };
            let to = at(to);
            (self.reads[to], self.bent[to]) = (read, is_bent);
        }
    }
}

impl Core {
    /// Sets the shape of the result of an instruction, from those of its operands.
    fn shape(&self, instruction: &Instruction, shapes: &mut Shapes) {
        let Instruction {
            code, a, b, c, d, ..
        } = *instruction;
        let mut set = |passing: Passing| shapes.set(instruction.to, &passing);
        match code {
            Code::Unary(UnaryOp::Neg | UnaryOp::Abs | UnaryOp::Not) => set(Passing::Straight(&[a])),
            Code::Binary(
                BinaryOp::Add | BinaryOp::Sub | BinaryOp::And | BinaryOp::Or | BinaryOp::Along,
            )
            | Code::Compare(_) => set(Passing::Straight(&[a, b])),
            Code::Binary(BinaryOp::Mul) => set(Passing::Product(a, b)),
            Code::Binary(BinaryOp::Div) => set(Passing::Quotient(a, b)),
            Code::Select => set(Passing::Straight(&[a, b, c])),
            Code::CompareSelect(_) | Code::If => set(Passing::Straight(&[a, b, c, d])),
            Code::Unary(_) | Code::Whole(_) | Code::Lookup { .. } => set(Passing::Bent(&[a])),
            Code::Binary(_) => set(Passing::Bent(&[a, b])),
            Code::HalfPower(_) => set(Passing::Bent(&[a, b, c])),
            Code::Call(_, count) | Code::Partial(_, count, _) => {
                set(Passing::Bent(self.arguments(a, count)));
            }
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
