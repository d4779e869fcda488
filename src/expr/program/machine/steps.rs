//! The steps of the machine of plain numbers: one operation each, jumps forward only, over the
//! slots of a frame.
//!
//! The frame is `registers of the straight code | constants and intermediate results of the steps`.
//! Both engines work on this one list: the interpreter goes through it, the translator makes code
//! of the processor of it.

use super::super::code::Core;
use super::super::operation::{BinaryOp, Comparison, UnaryOp};
use super::prepared::PreparedCall;
use crate::scalar::sines_and_cosines;
use std::collections::BTreeSet;

/// One step; operands and results are slots, jumps are numbers of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    /// input → to
    Input { number: u32, to: u32 },
    /// from → to
    Copy { from: u32, to: u32 },
    /// op a → to
    Unary { op: UnaryOp, a: u32, to: u32 },
    /// a op b → to
    Binary {
        op: BinaryOp,
        a: u32,
        b: u32,
        to: u32,
    },
    /// sin a → sine, cos a → cosine
    SineCosine { a: u32, sine: u32, cosine: u32 },
    /// sines and cosines of several angles at once
    Circle { number: u32 },
    /// a ? b : yes, no → to
    Select {
        comparison: Comparison,
        a: u32,
        b: u32,
        yes: u32,
        no: u32,
        to: u32,
    },
    /// an instruction of the straight code
    Instruction { number: u32 },
    /// a function whose parameters are constant
    Prepared { number: u32 },
    /// goes on where a ? b holds, else at `target`
    Unless {
        comparison: Comparison,
        a: u32,
        b: u32,
        target: u32,
    },
    /// goes on by the sign of the selector; with the next step where it is NaN
    Branch {
        selector: u32,
        negative: u32,
        zero: u32,
        positive: u32,
    },
    /// goes on at `target`
    Go { target: u32 },
}

/// A slot behind the registers of the straight code.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Extra {
    /// holds this number for ever
    Constant(f64),
    /// holds a result between the steps of one instruction
    Between,
    /// holds a result until it is copied to where it belongs
    Ahead,
}

/// Angles whose sines and cosines one step finds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    /// how many there are
    n: u8,
    angles: [u32; N_ANGLES],
    /// sine and cosine of each
    results: [[u32; 2]; N_ANGLES],
}

/// Angles of a step, at most.
pub(super) const N_ANGLES: usize = 8;
/// Angles that a processor finds at once.
const N_AT_ONCE: usize = 4;

impl Circle {
    /// Holds angles, each with the slots of sine and cosine, up to [`N_ANGLES`].
    pub(super) fn of(all: &[(u32, [u32; 2])]) -> Self {
        let n = all.len().min(N_ANGLES);
        let mut circle = Self {
            n: n as u8,
            angles: [0; N_ANGLES],
            results: [[0; 2]; N_ANGLES],
        };
        for (k, &(angle, results)) in all[..n].iter().enumerate() {
            (circle.angles[k], circle.results[k]) = (angle, results);
        }
        circle
    }

    pub(super) fn angles(&self) -> &[u32] {
        &self.angles[..usize::from(self.n).min(N_ANGLES)]
    }

    pub(super) fn results(&self) -> &[[u32; 2]] {
        &self.results[..usize::from(self.n).min(N_ANGLES)]
    }

    /// Finds sines and cosines, the same bits as one by one.
    #[inline(always)]
    pub(super) fn perform(&self, frame: &mut [f64]) {
        let [mut angles, mut sines, mut cosines] = [[0.0; N_ANGLES]; 3];
        for (angle, &slot) in angles.iter_mut().zip(self.angles()) {
            *angle = frame[slot as usize];
        }
        // as many as are found at once, or a multiple
        let n = self.angles().len().next_multiple_of(N_AT_ONCE);
        sines_and_cosines(&angles[..n], &mut sines[..n], &mut cosines[..n]);
        for (k, &[sine, cosine]) in self.results().iter().enumerate() {
            frame[sine as usize] = sines[k];
            frame[cosine as usize] = cosines[k];
        }
    }
}

/// The steps of a program.
#[derive(Debug)]
pub(super) struct Steps {
    pub(super) steps: Vec<Step>,
    pub(super) prepared: Vec<PreparedCall>,
    pub(super) circles: Vec<Circle>,
    /// number of registers of the straight code
    pub(super) n_registers: u32,
    /// what stands behind them
    pub(super) extras: Vec<Extra>,
    /// numbers that the steps hold themselves, by their bits: constants of the straight code that
    /// are the same serve
    pub(super) asked: BTreeSet<u64>,
}

impl Step {
    /// Returns the steps that it may jump to.
    pub(super) fn targets(&self) -> impl Iterator<Item = u32> {
        let (targets, n) = match *self {
            Step::Unless { target, .. } | Step::Go { target } => ([target; 3], 1),
            Step::Branch {
                negative,
                zero,
                positive,
                ..
            } => ([negative, zero, positive], 3),
            Step::Input { .. }
            | Step::Copy { .. }
            | Step::Unary { .. }
            | Step::Binary { .. }
            | Step::SineCosine { .. }
            | Step::Circle { .. }
            | Step::Select { .. }
            | Step::Instruction { .. }
            | Step::Prepared { .. } => ([0; 3], 0),
        };
        targets.into_iter().take(n)
    }

    /// Returns the slots that it names as operands, at most four, and their number.
    pub(super) fn operands(&self) -> ([u32; 4], usize) {
        match *self {
            Step::Unary { a, .. } | Step::SineCosine { a, .. } => ([a, 0, 0, 0], 1),
            Step::Binary { a, b, .. } | Step::Unless { a, b, .. } => ([a, b, 0, 0], 2),
            Step::Copy { from, .. } => ([from, 0, 0, 0], 1),
            Step::Select { a, b, yes, no, .. } => ([a, b, yes, no], 4),
            Step::Branch { selector, .. } => ([selector, 0, 0, 0], 1),
            Step::Input { .. }
            | Step::Circle { .. }
            | Step::Instruction { .. }
            | Step::Prepared { .. }
            | Step::Go { .. } => ([0; 4], 0),
        }
    }

    /// Returns the slots that it names as results, at most two, and their number.
    pub(super) fn results(&self) -> ([u32; 2], usize) {
        match *self {
            Step::Input { to, .. }
            | Step::Copy { to, .. }
            | Step::Unary { to, .. }
            | Step::Binary { to, .. }
            | Step::Select { to, .. } => ([to, 0], 1),
            Step::SineCosine { sine, cosine, .. } => ([sine, cosine], 2),
            Step::Circle { .. }
            | Step::Instruction { .. }
            | Step::Prepared { .. }
            | Step::Unless { .. }
            | Step::Branch { .. }
            | Step::Go { .. } => ([0; 2], 0),
        }
    }
}

impl Steps {
    /// Returns how many slots a frame has.
    pub(super) fn n_slots(&self) -> usize {
        self.n_registers as usize + self.extras.len()
    }

    /// Calls `each` with the slots that a step reads or writes of which it does not say so itself:
    /// what is called for it works on the frame.
    pub(super) fn slots_of_called(&self, step: &Step, core: &Core, mut each: impl FnMut(u32)) {
        match *step {
            Step::Instruction { number } => {
                let instruction = &core.code[number as usize];
                each(instruction.to);
                core.operands(instruction, each);
            }
            Step::Prepared { number } => {
                let call = &self.prepared[number as usize];
                let results = call.slopes.iter().chain([&call.value]).flatten();
                call.variables.iter().chain(results).for_each(|&s| each(s));
            }
            Step::Circle { number } => {
                let circle = &self.circles[number as usize];
                let results = circle.results().as_flattened();
                circle.angles().iter().chain(results).for_each(|&s| each(s));
            }
            Step::Input { .. }
            | Step::Copy { .. }
            | Step::Unary { .. }
            | Step::Binary { .. }
            | Step::SineCosine { .. }
            | Step::Select { .. }
            | Step::Unless { .. }
            | Step::Branch { .. }
            | Step::Go { .. } => {}
        }
    }

    /// Returns which steps are jumped to; the last element stands for the end.
    pub(super) fn jumped_to(&self) -> Vec<bool> {
        let mut is_target = vec![false; self.steps.len() + 1];
        for target in self.steps.iter().flat_map(Step::targets) {
            is_target[target as usize] = true;
        }
        is_target
    }
}

impl Steps {
    /// Returns whether all slots are inside the frame, all inputs are among those that the program
    /// reads and come first, and all jumps lead forward and not beyond the end.
    pub(super) fn are_sound(&self, core: &Core) -> bool {
        let (n_slots, end) = (self.n_slots(), self.steps.len());
        let is_slot = |slot: &u32| (*slot as usize) < n_slots;
        let is_sound = |(k, step): (usize, &Step)| {
            let (operands, n) = step.operands();
            let (results, m) = step.results();
            let mut sound = operands[..n].iter().chain(&results[..m]).all(is_slot)
                && step.targets().all(|t| k < t as usize && t as usize <= end);
            let (is_there, n_slots) = match *step {
                Step::Input { number, .. } => (core.used.get(k) == Some(&number), n_slots),
                Step::Instruction { number } => {
                    ((number as usize) < core.code.len(), core.size as usize)
                }
                Step::Prepared { number } => ((number as usize) < self.prepared.len(), n_slots),
                Step::Circle { number } => ((number as usize) < self.circles.len(), n_slots),
                Step::Copy { .. }
                | Step::Unary { .. }
                | Step::Binary { .. }
                | Step::SineCosine { .. }
                | Step::Select { .. }
                | Step::Unless { .. }
                | Step::Branch { .. }
                | Step::Go { .. } => (true, n_slots),
            };
            sound &= is_there;
            if is_there {
                self.slots_of_called(step, core, |slot| sound &= (slot as usize) < n_slots);
            }
            sound
        };
        self.n_registers == core.size
            && core.used.iter().all(|&k| (k as usize) < core.n_inputs)
            && core.outputs.iter().all(is_slot)
            && self.steps.iter().enumerate().all(is_sound)
    }
}
