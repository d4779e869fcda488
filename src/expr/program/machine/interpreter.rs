//! The interpreter: goes through the steps one by one, in safe Rust.
//!
//! It runs programs that are not worth a translation, all programs where there is none, and is the
//! reference in tests.

use super::super::code::Core;
use super::super::operation::Comparison;
use super::steps::{Step, Steps};
use crate::scalar::Scalar;

impl Steps {
    /// Performs all steps over a frame whose constants are in place.
    pub(super) fn run(&self, core: &Core, frame: &mut [f64], inputs: &[f64]) {
        let mut k = 0;
        while let Some(step) = self.steps.get(k) {
            k += 1;
            match *step {
                Step::Input { number, to } => frame[to as usize] = inputs[number as usize],
                Step::Unless {
                    comparison,
                    a,
                    b,
                    target,
                } => {
                    if !holds(comparison, frame[a as usize], frame[b as usize]) {
                        k = target as usize;
                    }
                }
                Step::Branch {
                    selector,
                    negative,
                    zero,
                    positive,
                } => {
                    let selector = frame[selector as usize];
                    if selector < 0.0 {
                        k = negative as usize;
                    } else if selector > 0.0 {
                        k = positive as usize;
                    } else if selector == 0.0 {
                        k = zero as usize;
                    }
                }
                Step::Go { target } => k = target as usize,
                step => self.perform(step, core, frame),
            }
        }
    }

    /// Performs a step that is no jump and reads no input.
    #[inline(always)]
    pub(super) fn perform(&self, step: Step, core: &Core, frame: &mut [f64]) {
        match step {
            Step::Copy { from, to } => frame[to as usize] = frame[from as usize],
            Step::Unary { op, a, to } => frame[to as usize] = op.apply(frame[a as usize]),
            Step::Binary { op, a, b, to } => {
                frame[to as usize] = op.apply(frame[a as usize], frame[b as usize]);
            }
            Step::SineCosine { a, sine, cosine } => {
                let pair = Scalar::sin_cos(frame[a as usize]);
                (frame[sine as usize], frame[cosine as usize]) = pair;
            }
            Step::Select {
                comparison,
                a,
                b,
                yes,
                no,
                to,
            } => {
                let chosen = match holds(comparison, frame[a as usize], frame[b as usize]) {
                    true => yes,
                    false => no,
                };
                frame[to as usize] = frame[chosen as usize];
            }
            Step::Instruction { number } => {
                core.perform(
                    &core.code[number as usize],
                    &mut frame[..core.size as usize],
                );
            }
            Step::Circle { number } => self.circles[number as usize].perform(frame),
            Step::Prepared { number } => self.prepared[number as usize].perform(frame),
            Step::Input { .. } | Step::Unless { .. } | Step::Branch { .. } | Step::Go { .. } => {
                unreachable!("inputs and jumps belong to the run")
            }
        }
    }
}

#[inline(always)]
fn holds(comparison: Comparison, a: f64, b: f64) -> bool {
    comparison.apply(a, b)
}
