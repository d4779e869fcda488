//! Next needs of each value: what the translator keeps in registers and what it stores.
//!
//! Jumps lead forward only, so that one pass from the end sees what is still needed.

use super::super::super::code::Core;
use super::super::steps::{Extra, Step, Steps};

/// The value is not needed any more.
pub(super) const NEVER: u32 = u32::MAX;
/// It is perhaps needed behind a jump or a target.
pub(super) const FAR: u32 = u32::MAX - 1;

/// When the slots of a step are needed again behind it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Next {
    /// in the order of [`Step::operands`]
    pub(super) operands: [u32; 4],
    /// in the order of [`Step::results`]
    pub(super) results: [u32; 2],
}

/// Returns for each step when its slots are needed again; and by slot the last step behind a jump
/// or a target that may need it.
///
/// A value that is read behind a jump may be needed; slots for what lies between the steps of one
/// instruction never outlast it.
pub(super) fn needs(steps: &Steps, core: &Core, is_target: &[bool]) -> (Vec<Next>, Vec<u32>) {
    let nothing = Next {
        operands: [NEVER; 4],
        results: [NEVER; 2],
    };
    let mut needs = vec![nothing; steps.steps.len()];
    let mut future = Future {
        noted: vec![(u32::MAX, NEVER); steps.n_slots()],
        last_read: vec![0; steps.n_slots()],
        stretch: 0,
        steps,
    };
    let end = steps.steps.len();
    for &slot in &core.outputs {
        future.read(slot, end);
    }
    future.stretch += u32::from(is_target[end]);
    for (k, step) in steps.steps.iter().enumerate().rev() {
        if step.targets().next().is_some() {
            future.stretch += 1;
        }
        let (results, n) = step.results();
        for (slot, next) in results[..n].iter().zip(&mut needs[k].results) {
            *next = future.next(*slot);
        }
        for &slot in &results[..n] {
            future.noted[slot as usize] = (future.stretch, NEVER);
        }
        let (operands, n) = step.operands();
        for (slot, next) in operands[..n].iter().zip(&mut needs[k].operands) {
            *next = future.next(*slot);
        }
        operands[..n].iter().for_each(|&slot| future.read(slot, k));
        match *step {
            Step::Instruction { number } => {
                core.operands(&core.code[number as usize], |slot| future.read(slot, k));
            }
            Step::Circle { number } => {
                let circle = &steps.circles[number as usize];
                for &slot in circle.results().as_flattened() {
                    future.noted[slot as usize] = (future.stretch, NEVER);
                }
                (circle.angles().iter()).for_each(|&slot| future.read(slot, k));
            }
            Step::Prepared { number } => {
                let variables = steps.prepared[number as usize].variables;
                variables.iter().for_each(|&slot| future.read(slot, k));
            }
            _ => {}
        }
        future.stretch += u32::from(is_target[k]);
    }
    (needs, future.last_read)
}

/// The knowledge of the steps behind the one at hand.
struct Future<'a> {
    /// by slot: the stretch without jumps and targets in which this was noted, and the step
    noted: Vec<(u32, u32)>,
    /// by slot: the last step that reads it; the first, which reads an input, stands for none
    last_read: Vec<u32>,
    stretch: u32,
    steps: &'a Steps,
}

impl Future<'_> {
    fn read(&mut self, slot: u32, step: usize) {
        self.noted[slot as usize] = (self.stretch, step as u32);
        if self.last_read[slot as usize] == 0 && self.outlasts(slot) {
            self.last_read[slot as usize] = step as u32;
        }
    }

    /// Returns whether the value of a slot may be needed behind a jump.
    fn outlasts(&self, slot: u32) -> bool {
        let extra = slot.checked_sub(self.steps.n_registers);
        extra.is_none_or(|k| self.steps.extras[k as usize] != Extra::Between)
    }

    fn next(&self, slot: u32) -> u32 {
        let (stretch, step) = self.noted[slot as usize];
        if stretch == self.stretch {
            return step;
        }
        match self.last_read[slot as usize] {
            0 => NEVER,
            _ => FAR,
        }
    }
}
