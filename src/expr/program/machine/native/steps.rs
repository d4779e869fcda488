//! The operations of a machine taken apart: single steps over slots, and how soon each value is needed again.
//!
//! Slots are the registers of the frame and, behind them, places for values between the parts of one operation, which are never
//! stored. Jumps lead forward only, so that one pass from the end sees what is still needed.

use super::super::{Kind, Meaning, Op, Shape, handlers};
use super::Threaded;
use super::inline::{Formula, Slots, formula};
use crate::expr::program::{Code, Core};
use handlers::{ADD, BUS, DIV, MUL, SUB, VID};
use std::collections::HashMap;

/// One step. Targets are numbers of operations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    /// the operation begins here, and somebody jumps to it
    Label(u32),
    Input {
        number: u32,
        to: u32,
    },
    Arithmetic {
        code: u8,
        a: u32,
        b: u32,
        to: u32,
    },
    Copy {
        from: u32,
        to: u32,
    },
    /// a < b, a <= b, a = b ? yes : no
    Select {
        comparison: u8,
        a: u32,
        b: u32,
        yes: u32,
        no: u32,
        to: u32,
    },
    /// on where a < b, a <= b, a = b
    Unless {
        comparison: u8,
        a: u32,
        b: u32,
        target: u32,
    },
    /// by the sign; on where there is none
    Branch {
        selector: u32,
        negative: u32,
        zero: u32,
        positive: u32,
    },
    Go {
        target: u32,
    },
    /// the handler of an operation, which is given the value of a slot
    Call {
        op: u32,
        acc: Option<u32>,
    },
    End,
}

/// The value is not needed any more.
pub(super) const NEVER: u32 = u32::MAX;
/// It is perhaps needed behind a jump or a label.
const FAR: u32 = u32::MAX - 1;

/// How many values there are between the parts of fused arithmetic, at most.
const BETWEEN: usize = 2;

/// When slots are needed again behind a step: those that it reads, in order, and last the one that it writes.
pub(super) type Next = [u32; 5];

pub(super) struct Steps {
    pub(super) steps: Vec<Step>,
    pub(super) next: Vec<Next>,
    /// the slots from here on are these constants, which stand behind the code
    pub(super) first_constant: usize,
    pub(super) constants: Vec<f64>,
    pub(super) has_calls: bool,
}

impl Step {
    /// The slots that it reads one by one (calls and the end read others), at most four.
    pub(super) fn reads(&self) -> ([u32; 4], usize) {
        match *self {
            Step::Arithmetic { a, b, .. } | Step::Unless { a, b, .. } => ([a, b, 0, 0], 2),
            Step::Copy { from, .. } => ([from, 0, 0, 0], 1),
            Step::Select { a, b, yes, no, .. } => ([a, b, yes, no], 4),
            Step::Branch { selector, .. } => ([selector, 0, 0, 0], 1),
            _ => ([0; 4], 0),
        }
    }
    fn writes(&self) -> Option<u32> {
        match *self {
            Step::Input { to, .. }
            | Step::Arithmetic { to, .. }
            | Step::Copy { to, .. }
            | Step::Select { to, .. } => Some(to),
            _ => None,
        }
    }
    fn is_jump(&self) -> bool {
        matches!(
            self,
            Step::Label(_) | Step::Unless { .. } | Step::Branch { .. } | Step::Go { .. }
        )
    }
}

impl Steps {
    pub(super) fn of(threaded: &Threaded) -> Self {
        let Threaded {
            ops,
            kinds,
            meanings,
            core,
            n_registers,
            ..
        } = threaded;
        let mut is_target = vec![false; ops.len()];
        for (k, (op, kind)) in ops.iter().zip(kinds).enumerate() {
            if let Kind::Jumps(first, count) = *kind {
                for &distance in &op.operands[first as usize..(first + count) as usize] {
                    is_target[k + distance as usize] = true;
                }
            }
        }
        let mut parts = Parts {
            steps: Vec::with_capacity(2 * ops.len()),
            first_between: *n_registers as u32,
            formulas: formulas(threaded),
            n_between: BETWEEN,
            constants: Vec::new(),
            places: HashMap::new(),
            next_label: ops.len() as u32,
        };
        let longest = parts.formulas.values().map(|f| f.operations.len()).max();
        parts.n_between = longest.map_or(BETWEEN, |n| n.max(BETWEEN));
        for (k, op) in ops.iter().enumerate() {
            if is_target[k] {
                parts.steps.push(Step::Label(k as u32));
            }
            parts.take_apart(k as u32, op, kinds[k], meanings[k]);
        }
        let first_constant = n_registers + parts.n_between;
        let (steps, constants) = (parts.steps, parts.constants);
        let has_calls = steps.iter().any(|s| matches!(s, Step::Call { .. }));
        let (first_between, n_slots) = (*n_registers as u32, first_constant + constants.len());
        let next = needs(&steps, first_between, n_slots, |step, read| match step {
            Step::Call { op, acc } => {
                acc.into_iter().for_each(&mut *read);
                read_by_call(&ops[op as usize], kinds[op as usize], core, read);
            }
            Step::End => threaded.outputs.iter().for_each(|&slot| read(slot)),
            _ => {}
        });
        Self {
            steps,
            next,
            first_constant,
            constants,
            has_calls,
        }
    }
}

/// The prepared functions that are written out, by operation.
fn formulas(threaded: &Threaded) -> HashMap<u32, Formula> {
    let mut formulas = HashMap::new();
    for (k, &meaning) in threaded.meanings.iter().enumerate() {
        let Meaning::Prepared {
            function, slope, ..
        } = meaning
        else {
            continue;
        };
        let operands = &threaded.ops[k].operands;
        let first = if slope { 3 } else { 2 };
        let parameters = threaded.parameters(operands[first], operands[first + 1]);
        if let Some(formula) = formula(function, parameters, slope) {
            formulas.insert(k as u32, formula);
        }
    }
    formulas
}

/// Calls `read` with all slots that an operation may read.
fn read_by_call(op: &Op, kind: Kind, core: &Core, read: &mut dyn FnMut(u32)) {
    match kind {
        Kind::Registers(n) | Kind::Parameters(n) | Kind::Fixed(n, _) => {
            op.operands[..n as usize]
                .iter()
                .for_each(|&slot| read(slot));
        }
        Kind::Instruction => {
            let instruction = &core.code[op.operands[0] as usize];
            match instruction.code {
                Code::Call(_, count) | Code::Partial(_, count, _) => {
                    let first = instruction.a as usize;
                    core.lists[first..first + count as usize]
                        .iter()
                        .for_each(|&slot| read(slot));
                }
                _ => [instruction.a, instruction.b, instruction.c, instruction.d]
                    .into_iter()
                    .for_each(read),
            }
        }
        Kind::Jumps(..) | Kind::Inputs(_) | Kind::Halt => {}
    }
}

/// When each slot of each step is needed again.
///
/// What is read behind a jump may be needed; slots from `first_between` on never outlast their operation.
fn needs(
    steps: &[Step],
    first_between: u32,
    n_slots: usize,
    mut others: impl FnMut(Step, &mut dyn FnMut(u32)),
) -> Vec<Next> {
    let mut next = vec![[NEVER; 5]; steps.len()];
    // by slot: the stretch without jumps in which this was noted, and the step
    let mut noted = vec![(u32::MAX, NEVER); n_slots];
    let mut is_read_later = vec![false; n_slots];
    let mut stretch = 0;
    for (k, &step) in steps.iter().enumerate().rev() {
        if step.is_jump() {
            stretch += 1;
        }
        let when = |noted: &[(u32, u32)], is_read_later: &[bool], slot: u32| {
            let (noted_in, step) = noted[slot as usize];
            match noted_in == stretch {
                true => step,
                false if slot < first_between && is_read_later[slot as usize] => FAR,
                false => NEVER,
            }
        };
        if let Some(to) = step.writes() {
            next[k][4] = when(&noted, &is_read_later, to);
            noted[to as usize] = (stretch, NEVER);
        }
        let (reads, n) = step.reads();
        for (slot, next) in reads[..n].iter().zip(&mut next[k]) {
            *next = when(&noted, &is_read_later, *slot);
        }
        let mut read = |slot: u32| {
            noted[slot as usize] = (stretch, k as u32);
            is_read_later[slot as usize] = true;
        };
        reads[..n].iter().for_each(|&slot| read(slot));
        others(step, &mut read);
    }
    next
}

/// Operations being taken apart.
struct Parts {
    steps: Vec<Step>,
    first_between: u32,
    formulas: HashMap<u32, Formula>,
    n_between: usize,
    /// constants of formulas, and where they are by their bits
    constants: Vec<f64>,
    places: HashMap<u64, u32>,
    /// labels that are no operations
    next_label: u32,
}

impl Parts {
    fn arithmetic(&mut self, code: u8, a: u32, b: u32, to: u32) {
        let (code, a, b) = match code {
            BUS => (SUB, b, a),
            VID => (DIV, b, a),
            _ => (code, a, b),
        };
        self.steps.push(Step::Arithmetic { code, a, b, to });
    }

    fn take_apart(&mut self, k: u32, op: &Op, kind: Kind, meaning: Meaning) {
        let o = &op.operands;
        let (x, y) = (self.first_between, self.first_between + 1);
        match meaning {
            Meaning::Arithmetic(shape, [p, q, r]) => match shape {
                Shape::One => self.arithmetic(p, o[0], o[1], o[2]),
                Shape::Two => {
                    self.arithmetic(p, o[0], o[1], x);
                    self.arithmetic(q, x, o[2], o[3]);
                }
                Shape::Chain => {
                    self.arithmetic(p, o[0], o[1], x);
                    self.arithmetic(q, x, o[2], x);
                    self.arithmetic(r, x, o[3], o[4]);
                }
                Shape::Balanced => {
                    self.arithmetic(p, o[0], o[1], x);
                    self.arithmetic(r, o[2], o[3], y);
                    self.arithmetic(q, x, y, o[4]);
                }
                Shape::Dot => {
                    self.arithmetic(p, o[0], o[1], x);
                    self.arithmetic(q, x, o[4], x);
                    self.arithmetic(MUL, o[2], o[3], y);
                    self.arithmetic(r, x, y, o[5]);
                }
            },
            Meaning::Inputs => {
                if let Kind::Inputs(n) = kind {
                    for (number, to) in o[1..=n as usize].iter().zip(o[0]..) {
                        self.steps.push(Step::Input {
                            number: *number,
                            to,
                        });
                    }
                }
            }
            Meaning::Copy => self.steps.push(Step::Copy {
                from: o[0],
                to: o[1],
            }),
            Meaning::CopyAndGo => {
                self.steps.push(Step::Copy {
                    from: o[0],
                    to: o[1],
                });
                self.steps.push(Step::Go { target: k + o[2] });
            }
            Meaning::Go => self.steps.push(Step::Go { target: k + o[0] }),
            Meaning::Select(comparison) => self.steps.push(Step::Select {
                comparison,
                a: o[0],
                b: o[1],
                yes: o[2],
                no: o[3],
                to: o[4],
            }),
            Meaning::Unless(comparison) => self.steps.push(Step::Unless {
                comparison,
                a: o[0],
                b: o[1],
                target: k + o[2],
            }),
            Meaning::Branch(code) => {
                let selector = match code {
                    ADD..=VID => {
                        self.arithmetic(code, o[0], o[1], x);
                        x
                    }
                    _ => o[0],
                };
                self.steps.push(Step::Branch {
                    selector,
                    negative: k + o[2],
                    zero: k + o[3],
                    positive: k + o[4],
                });
            }
            Meaning::Prepared { slope, added, .. } => {
                let Some(formula) = self.formulas.remove(&k) else {
                    let acc = Some(added.unwrap_or(o[0]));
                    self.steps.push(Step::Call { op: k, acc });
                    return;
                };
                let slots = Slots {
                    x: o[0],
                    value: o[1],
                    slope: slope.then_some(o[2]),
                    added,
                    between: self.first_between,
                    label: self.next_label,
                };
                self.next_label += 3;
                let first_constant = self.first_between + self.n_between as u32;
                let (constants, places) = (&mut self.constants, &mut self.places);
                formula.steps(&slots, &mut self.steps, |c| {
                    *places.entry(c.to_bits()).or_insert_with(|| {
                        constants.push(c);
                        first_constant + constants.len() as u32 - 1
                    })
                });
            }
            Meaning::Handled => {
                let acc = match kind {
                    Kind::Registers(n) | Kind::Parameters(n) | Kind::Fixed(n, _) if n > 0 => {
                        Some(o[0])
                    }
                    _ => None,
                };
                self.steps.push(Step::Call { op: k, acc });
            }
            Meaning::Pause => {}
            Meaning::Halt => self.steps.push(Step::End),
        }
    }
}
