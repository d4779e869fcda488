//! Values that stay in registers across jumps.
//!
//! The first jump to a step leaves values where they are; that is how the step finds them. Whoever
//! leads there later, by a jump or by going on, brings values to the same places.

use super::assembler::{Place, When, Xmm};
use super::held::{Held, Holding, Landing, N_HOLDING, ONE};
use super::needs::FAR;
use super::translate::Translation;

/// Instructions that bring values to where a step finds them.
struct Way {
    /// registers whose values are stored, first
    stores: Vec<Xmm>,
    moves: Vec<Move>,
}

/// A value that is brought into a register.
#[derive(Clone, Copy)]
struct Move {
    from: Place,
    to: Xmm,
}

impl Translation<'_> {
    /// Jumps lead here.
    pub(super) fn target(&mut self, step: u32) {
        let Some(landing) = self.landings.remove(&step) else {
            unreachable!("a target has a jump before it");
        };
        if self.is_reached {
            let way = self.way_to(step, &landing.held);
            self.go(way);
        }
        self.forget();
        for (x, held) in (0..).zip(landing.held) {
            if let Some(held) = held {
                self.places[held.slot as usize] = x;
            }
        }
        self.held = landing.held;
        for jump in landing.jumps {
            self.assembler.lands(jump);
        }
        self.is_reached = true;
    }

    /// Jumps to a step.
    pub(super) fn jump(&mut self, when: When, target: u32) {
        let Some(mut landing) = self.landings.remove(&target) else {
            let landing = Landing {
                held: self.held.map(|held| self.still_needed(held, target)),
                jumps: vec![self.assembler.jump(when)],
            };
            self.landings.insert(target, landing);
            return;
        };
        let way = self.way_to(target, &landing.held);
        let around = match when {
            When::Always => None,
            _ if way.is_empty() => None,
            _ => {
                let aside = self.assembler.jump(when);
                let on = self.assembler.jump(When::Always);
                self.assembler.lands(aside);
                Some(on)
            }
        };
        self.go(way);
        let when = around.map_or(when, |_| When::Always);
        landing.jumps.push(self.assembler.jump(when));
        if let Some(on) = around {
            self.assembler.lands(on);
        }
        self.landings.insert(target, landing);
    }

    /// Returns a value as a step finds it, if that still needs it.
    fn still_needed(&self, held: Option<Held>, target: u32) -> Option<Held> {
        let held = held.filter(|held| self.is_needed(held.slot, target));
        held.map(|held| Held { next: FAR, ..held })
    }

    fn is_needed(&self, slot: u32, from: u32) -> bool {
        self.last_read[slot as usize] >= from
    }

    /// Returns what brings values to where a step finds them.
    fn way_to(&mut self, target: u32, landing: &Holding) -> Way {
        let mut moves = Vec::new();
        let mut is_expected = [false; N_HOLDING];
        for (to, place) in (0..).zip(landing) {
            let Some(value) = place else {
                continue;
            };
            let from = self.place(value.slot);
            if let Place::Xmm(x) = from {
                is_expected[x as usize] = true;
            }
            if from != Place::Xmm(to) {
                moves.push(Move { from, to });
            }
        }
        let is_left = |x: &Xmm| {
            let held = self.held[*x as usize];
            let is_needed = held.is_some_and(|held| self.is_needed(held.slot, target));
            is_needed && !is_expected[*x as usize]
        };
        let stores = (0..N_HOLDING as Xmm).filter(is_left).collect();
        Way { stores, moves }
    }

    /// Stores what is to be stored, and does all moves as if at once.
    fn go(&mut self, way: Way) {
        let Way { stores, mut moves } = way;
        for x in stores {
            self.store(x);
        }
        while !moves.is_empty() {
            let is_read = |to: Xmm| moves.iter().any(|other| other.from == Place::Xmm(to));
            match moves.iter().position(|m| !is_read(m.to)) {
                Some(k) => {
                    let Move { from, to } = moves.swap_remove(k);
                    self.assembler.load(to, from);
                }
                None => {
                    // they go round: one makes room
                    let room = moves[0].from;
                    self.assembler.load(ONE, room);
                    moves[0].from = Place::Xmm(ONE);
                }
            }
        }
    }
}

impl Way {
    fn is_empty(&self) -> bool {
        self.stores.is_empty() && self.moves.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::super::Native;
    use crate::expr::program::code::{Core, Shape};
    use crate::expr::program::machine::steps::{Step, Steps};
    use crate::expr::program::operation::{BinaryOp, Comparison, UnaryOp};
    use crate::expr::program::random::Random;
    use std::collections::BTreeSet;
    use std::sync::Arc;

    const N_CONSTANTS: u32 = 4;
    const N_INPUTS: u32 = 3;

    /// A step over slots of which none is a constant, and a jump as often as not.
    fn step(random: &mut Random, k: usize, n: usize, n_slots: u32) -> Step {
        let mut below = |n: u32| random.below(n as usize) as u32;
        let [a, b, yes, no] = [0; 4].map(|_| below(n_slots));
        let to = N_CONSTANTS + below(n_slots - N_CONSTANTS);
        let comparison = [Comparison::Lt, Comparison::Le, Comparison::Eq][below(3) as usize];
        // near targets are those of many jumps
        let mut target = || (k as u32 + 1 + below(8)).min(n as u32);
        let [target, zero, positive] = [0; 3].map(|_| target());
        match below(24) {
            0 => Step::Go { target },
            1..4 => Step::Unless {
                comparison,
                a,
                b,
                target,
            },
            4 => Step::Branch {
                selector: a,
                negative: target,
                zero,
                positive,
            },
            5 | 6 => Step::Select {
                comparison,
                a,
                b,
                yes,
                no,
                to,
            },
            7 => Step::Unary {
                op: [UnaryOp::Abs, UnaryOp::Sqrt, UnaryOp::Sin][below(3) as usize],
                a,
                to,
            },
            8..12 => Step::Copy { from: a, to },
            _ => {
                use BinaryOp::{Add, Along, Kept, Mul, Sub};
                let op = [Add, Add, Sub, Sub, Mul, Along, Kept][below(7) as usize];
                Step::Binary { op, a, b, to }
            }
        }
    }

    #[test]
    fn jumps_of_any_kind_leave_the_outputs_that_the_interpreter_finds() {
        let mut random = Random(11);
        for round in 0..4000 {
            // few slots meet often; many do not find room
            let n_slots = N_CONSTANTS + N_INPUTS + [2, 6, 12, 30][round / 2 % 4];
            let n = N_INPUTS as usize + random.below(70);
            let inputs = (0..N_INPUTS).map(|number| Step::Input {
                number,
                to: N_CONSTANTS + number,
            });
            let steps = Steps {
                steps: inputs
                    .chain((N_INPUTS as usize..n).map(|k| step(&mut random, k, n, n_slots)))
                    .collect(),
                prepared: Vec::new(),
                circles: Vec::new(),
                n_registers: n_slots,
                extras: Vec::new(),
                asked: BTreeSet::new(),
            };
            let n_outputs = 1 + random.below(12);
            let core = Arc::new(Core {
                constants: vec![0.0, 1.0, -0.75, f64::NAN],
                tables: Vec::new(),
                shape: Arc::new(Shape {
                    n_inputs: N_INPUTS as usize,
                    used: (0..N_INPUTS).collect(),
                    size: n_slots,
                    outputs: (0..n_outputs)
                        .map(|_| random.below(n_slots as usize) as u32)
                        .collect(),
                    ..Shape::default()
                }),
            });
            let has_avx = round % 2 == 0 && is_x86_feature_detected!("avx");
            let Some(native) = Native::with(&steps, &core, has_avx) else {
                return;
            };
            // steps read what none has written: zero
            let mut start = core.constants.clone();
            start.resize(n_slots as usize, 0.0);
            for _ in 0..4 {
                let inputs = [0; 3].map(|_| random.below(7) as f64 * 0.5 - 1.5);
                let (mut frame, mut own) = (start.clone(), start.clone());
                let mut out = vec![0.0; n_outputs];
                steps.run(&core, &mut frame, &inputs);
                let first = native.run(&mut own, &inputs, &mut out).unwrap();
                let want: Vec<f64> = (core.outputs.iter())
                    .map(|&slot| frame[slot as usize])
                    .collect();
                let is_same =
                    |(x, y): (&f64, &f64)| x.to_bits() == y.to_bits() || x.is_nan() && y.is_nan();
                assert!(
                    out.iter().zip(&want).all(is_same) && is_same((&first, &want[0])),
                    "{inputs:?}: {out:?}, not {want:?}: {steps:#?} {core:?}"
                );
            }
        }
    }
}
