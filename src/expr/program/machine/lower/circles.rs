//! Sines and cosines of several angles at once.
//!
//! A mechanism evaluates little else, mostly of angles that are known before anything is computed;
//! of several at once the processor finds them in half of the time. So the steps for angles that
//! are known at the first of them are done there. Their results go where they belong, or wait where
//! the slot still holds something else.

use super::super::super::code::Core;
use super::super::steps::{Circle, Extra, N_ANGLES, Step, Steps};

/// Steps from the first of some angles to the last, at most.
const MOST_STEPS_AHEAD: usize = 2000;

/// Angles from which on it pays. In instructions of one call, beside those of as many: 3 angles 240
/// and 330, 4 260 and 440, 5 400 and 550, 8 450 and 880; two take 220 either way.
const WORTH_GATHERING: usize = 3;

/// A step, or what is done in its place.
#[derive(Clone, Copy, Debug)]
enum Instead {
    /// it stays
    Itself,
    /// sines and cosines of several angles
    Circle(u32),
    /// sine and cosine are copied, from → to, where they are not in place
    Copies([Option<[u32; 2]>; 2]),
}

/// Returns steps with the same results in which angles are gathered.
pub(super) fn gathered(core: &Core, mut steps: Steps) -> Steps {
    let is_angle = |step: &Step| matches!(step, Step::SineCosine { .. });
    if steps.steps.iter().filter(|step| is_angle(step)).count() < WORTH_GATHERING {
        return steps;
    }
    let end = (steps.steps.iter().rposition(is_angle)).map_or(0, |last| last + 1);
    let mut instead = vec![Instead::Itself; steps.steps.len()];
    let mut seen = Seen {
        is_target: steps.jumped_to(),
        read: vec![usize::MAX; steps.n_slots()],
        written: vec![usize::MAX; steps.n_slots()],
        all_read: false,
        first: 0,
        end,
    };
    for first in 0..end {
        if let (Step::SineCosine { .. }, Instead::Itself) = (&steps.steps[first], instead[first]) {
            let found = seen.known_at(core, &steps, &instead, first);
            if found.len() >= WORTH_GATHERING {
                gather(&mut steps, &mut instead, &found);
            }
        }
    }
    steps.steps = replaced(&steps.steps, &instead);
    steps
}

/// An angle, the step that finds its sine and cosine, and whether each slot is free before.
struct Angle {
    step: usize,
    slot: u32,
    results: [u32; 2],
    is_free: [bool; 2],
}

/// The slots that steps from a first one on have read and written.
struct Seen {
    is_target: Vec<bool>,
    /// by slot: the first step of the search in which it was last read
    read: Vec<usize>,
    /// the same, written
    written: Vec<usize>,
    /// whether a step has read what it does not say itself
    all_read: bool,
    first: usize,
    /// behind the last step for an angle
    end: usize,
}

impl Seen {
    /// Returns the angles that are known at a step for one of them, that one first.
    fn known_at(
        &mut self,
        core: &Core,
        steps: &Steps,
        instead: &[Instead],
        first: usize,
    ) -> Vec<Angle> {
        let mut found = Vec::new();
        (self.first, self.all_read) = (first, false);
        let ahead = steps.steps[..self.end].iter().enumerate().skip(first);
        for (k, step) in ahead.take(MOST_STEPS_AHEAD) {
            let ends = k > first && self.is_target[k] || step.targets().next().is_some();
            if ends || found.len() == N_ANGLES {
                break;
            }
            let angle = match (*step, instead[k]) {
                (Step::SineCosine { a, sine, cosine }, Instead::Itself) => Some(Angle {
                    step: k,
                    slot: a,
                    results: [sine, cosine],
                    is_free: [sine, cosine].map(|slot| self.is_free(slot)),
                }),
                _ => None,
            };
            let is_known = |angle: &Angle| self.written[angle.slot as usize] != first;
            found.extend(angle.filter(is_known));
            self.see(core, steps, step);
        }
        found
    }

    fn is_free(&self, slot: u32) -> bool {
        let slot = slot as usize;
        !self.all_read && self.read[slot] != self.first && self.written[slot] != self.first
    }

    /// Notes what a step reads and writes.
    fn see(&mut self, core: &Core, steps: &Steps, step: &Step) {
        let first = self.first;
        let (operands, n) = step.operands();
        (operands[..n].iter()).for_each(|&slot| self.read[slot as usize] = first);
        let (results, n) = step.results();
        let mut written = |slot: u32| self.written[slot as usize] = first;
        results[..n].iter().for_each(|&slot| written(slot));
        match *step {
            Step::Instruction { number } => {
                written(core.code[number as usize].to);
                self.all_read = true;
            }
            Step::Prepared { number } => {
                let call = &steps.prepared[number as usize];
                let results = call.slopes.iter().chain([&call.value]);
                results.flatten().for_each(|&slot| written(slot));
                self.all_read = true;
            }
            _ => {}
        }
    }
}

/// Lets the first of some steps do what all do.
fn gather(steps: &mut Steps, instead: &mut [Instead], found: &[Angle]) {
    let mut all = Vec::with_capacity(found.len());
    for (k, angle) in found.iter().enumerate() {
        let (mut results, mut copies) = (angle.results, [None; 2]);
        for (side, &to) in angle.results.iter().enumerate() {
            if k > 0 && !angle.is_free[side] {
                let from = steps.n_slots() as u32;
                steps.extras.push(Extra::Ahead);
                results[side] = from;
                copies[side] = Some([from, to]);
            }
        }
        all.push((angle.slot, results));
        instead[angle.step] = Instead::Copies(copies);
    }
    instead[found[0].step] = Instead::Circle(steps.circles.len() as u32);
    steps.circles.push(Circle::of(&all));
}

/// Puts into the place of steps what is done instead, and lets jumps lead where they led.
fn replaced(steps: &[Step], instead: &[Instead]) -> Vec<Step> {
    let mut new = Vec::with_capacity(steps.len());
    let mut places = Vec::with_capacity(steps.len() + 1);
    for (&step, &instead) in steps.iter().zip(instead) {
        places.push(new.len() as u32);
        match instead {
            Instead::Itself => new.push(step),
            Instead::Circle(number) => new.push(Step::Circle { number }),
            Instead::Copies(copies) => {
                let copies = copies.into_iter().flatten();
                new.extend(copies.map(|[from, to]| Step::Copy { from, to }));
            }
        }
    }
    places.push(new.len() as u32);
    for step in &mut new {
        match step {
            Step::Unless { target, .. } | Step::Go { target } => *target = places[*target as usize],
            Step::Branch {
                negative,
                zero,
                positive,
                ..
            } => {
                for target in [negative, zero, positive] {
                    *target = places[*target as usize];
                }
            }
            _ => {}
        }
    }
    new
}

#[cfg(test)]
mod tests {
    use super::super::super::super::code::Shape;
    use super::super::super::super::operation::{BinaryOp, Comparison};
    use super::super::super::super::random::Random;
    use super::super::super::native::Native;
    use super::*;
    use std::collections::BTreeSet;
    use std::sync::Arc;

    const N_SLOTS: u32 = 12;
    const N_INPUTS: u32 = 5;

    /// A step over few slots, so that these are soon used again.
    fn step(random: &mut Random, k: usize, n: usize) -> Step {
        let mut slot = || random.below(N_SLOTS as usize) as u32;
        let (a, b, to) = (slot(), slot(), slot());
        let cosine = (to + 1 + random.below(N_SLOTS as usize - 1) as u32) % N_SLOTS;
        let target = (k + 1 + random.below(n - k)) as u32;
        match random.below(20) {
            0 => Step::Go { target },
            1 => Step::Unless {
                comparison: Comparison::Lt,
                a,
                b,
                target,
            },
            2..6 => Step::Copy { from: a, to },
            6..10 => Step::Binary {
                op: [BinaryOp::Add, BinaryOp::Mul][random.below(2)],
                a,
                b,
                to,
            },
            _ => Step::SineCosine {
                a,
                sine: to,
                cosine,
            },
        }
    }

    #[test]
    fn gathered_angles_leave_the_same_bits_in_all_slots() {
        let mut random = Random(7);
        let mut n_gathered = 0;
        for length in 0..600 {
            let n = N_INPUTS as usize + length % 60;
            let inputs = (0..N_INPUTS).map(|number| Step::Input { number, to: number });
            let steps = Steps {
                steps: inputs
                    .chain((N_INPUTS as usize..n).map(|k| step(&mut random, k, n)))
                    .collect(),
                prepared: Vec::new(),
                circles: Vec::new(),
                n_registers: N_SLOTS,
                extras: Vec::new(),
                asked: BTreeSet::new(),
            };
            let core = Arc::new(Core {
                constants: Vec::new(),
                tables: Vec::new(),
                shape: Arc::new(Shape {
                    n_inputs: N_INPUTS as usize,
                    used: (0..N_INPUTS).collect(),
                    size: N_SLOTS,
                    outputs: (0..N_SLOTS).collect(),
                    ..Shape::default()
                }),
            });
            let inputs: Vec<f64> = (0..N_INPUTS).map(|k| f64::from(k) - 1.3).collect();
            let mut frame = vec![0.0; N_SLOTS as usize];
            steps.run(&core, &mut frame, &inputs);
            let gathered = gathered(&core, steps);
            assert!(gathered.are_sound(&core));
            n_gathered += gathered.circles.len();
            let bits = |frame: &[f64]| -> Vec<u64> {
                let slots = frame[..N_SLOTS as usize].iter();
                slots.map(|x| x.to_bits()).collect()
            };
            let start: Vec<f64> = (0..gathered.n_slots())
                .map(|k| if k < N_SLOTS as usize { 0.0 } else { f64::NAN })
                .collect();
            let mut own = start.clone();
            gathered.run(&core, &mut own, &inputs);
            assert_eq!(bits(&own), bits(&frame), "{gathered:?}");
            if let Some(native) = Native::of(&gathered, &core) {
                let mut own = start;
                // steps read what none has written: zero, in the frame and where outputs stand
                let mut out = [0.0; N_SLOTS as usize];
                native.run(&mut own, &inputs, &mut out).unwrap();
                assert_eq!(bits(&out), bits(&frame), "{gathered:?}");
            }
        }
        assert!(n_gathered > 100, "{n_gathered}");
    }
}
