//! From straight code to steps: sides of selections jumped over, functions with constant parameters written out or prepared.

use super::super::code::{Code, Core, Instruction, Mark};
use super::super::operation::{BinaryOp, Comparison, UnaryOp};
use super::formula::{Formula, Number, Operation};
use super::prepared::PreparedCall;
use super::steps::{Extra, Step, Steps};
use crate::expr::functions::Function;
use crate::expr::functions::prepared::Prepared;
use std::collections::HashMap;

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
    Steps {
        steps: lowering.steps,
        prepared: lowering.prepared,
        n_registers: core.size,
        extras: lowering.extras,
    }
}

/// Where each instruction puts its result, and by whom that is read.
struct Results {
    /// registers, or those of the selections that alone read them
    to: Vec<u32>,
    /// by instruction: how often its result is an operand or an output
    n_reads: Vec<u32>,
    /// by member of a group: the instructions that yield what it chooses from
    chosen: Vec<[Option<u32>; 3]>,
    /// whether an instruction is done by jumps
    is_jumped: Vec<bool>,
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
    /// slots for what lies between the steps of one instruction
    between: Vec<u32>,
    open: Vec<Open>,
    /// exits of the group that was closed last, and where they lead
    closed: (Vec<usize>, usize),
}

impl Results {
    fn of(core: &Core) -> Self {
        let n = core.code.len();
        let mut results = Results {
            to: core.code.iter().map(|instruction| instruction.to).collect(),
            n_reads: vec![0; n],
            chosen: vec![[None; 3]; core.sides.members.len()],
            is_jumped: vec![false; n],
        };
        let mut members: HashMap<u32, usize> = HashMap::new();
        for (k, &member) in core.sides.members.iter().enumerate() {
            members.insert(member, k);
            results.is_jumped[member as usize] = true;
        }
        // by register: the instruction that wrote it last
        let mut writer: Vec<Option<u32>> = vec![None; core.size as usize];
        for (k, instruction) in (0u32..).zip(&core.code) {
            core.operands(instruction, |register| {
                if let Some(writer) = writer[register as usize] {
                    results.n_reads[writer as usize] += 1;
                }
            });
            if let Some(&member) = members.get(&k) {
                for side in 0..instruction.n_sides() {
                    let register = instruction.chosen(side) as usize;
                    results.chosen[member][side as usize] = writer[register];
                }
            }
            writer[instruction.to as usize] = Some(k);
        }
        for &register in &core.outputs {
            if let Some(writer) = writer[register as usize] {
                results.n_reads[writer as usize] += 1;
            }
        }
        results
    }
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

    /// a ? b : yes, no → to
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

    /// Lowers a call or a partial derivative, with those of the same call that follow where its parameters are constant.
    fn call(&mut self, k: usize, end: usize) -> usize {
        let core = self.core;
        let first = &core.code[k];
        let prepared = core.call(first).and_then(|(function, list)| {
            let known: Vec<Option<f64>> = list
                .iter()
                .map(|&r| core.constants.get(r as usize).copied())
                .collect();
            Some((Prepared::of(function, &known)?, function, list))
        });
        let Some(((prepared, parameters), function, list)) = prepared else {
            self.instruction(k, first);
            return 1;
        };
        let n_variables = prepared.n_variables();
        let (mut value, mut slopes) = (None, [None; 2]);
        let mut taken = 0;
        for (k, instruction) in (k..end).zip(&core.code[k..end]) {
            if core.call(instruction) != Some((function, list)) {
                break;
            }
            let to = Some(self.results.to[k]);
            match instruction.code {
                Code::Partial(_, _, which) if which as usize >= n_variables => break,
                Code::Partial(_, _, which) => slopes[which as usize] = to,
                _ => value = to,
            }
            taken += 1;
            if list[..n_variables].contains(&instruction.to) {
                // what follows reads something else there
                break;
            }
        }
        if taken == 0 {
            self.instruction(k, first);
            return 1;
        }
        self.prepared(PreparedCall {
            function: prepared,
            parameters,
            variables: [list[0], list[n_variables - 1]],
            value,
            slopes,
        });
        taken
    }

    fn prepared(&mut self, call: PreparedCall) {
        let slope = call.slopes[0].is_some();
        match Formula::of(call.function, &call.parameters, slope) {
            Some(formula) => self.formula(&formula, &call),
            None => {
                let number = self.prepared.len() as u32;
                self.prepared.push(call);
                self.steps.push(Step::Prepared { number });
            }
        }
    }

    /// Writes a formula out.
    fn formula(&mut self, formula: &Formula, call: &PreparedCall) {
        let x = call.variables[0];
        let mut exits = Vec::new();
        if let Some([x0, x1, h0, h1]) = formula.ends {
            let [x0, x1, h0, h1, zero] = [x0, x1, h0, h1, 0.0].map(|c| self.constant(c));
            // x ≤ x0, else x1 ≤ x, else between
            for (a, b, h) in [(x, x0, h0), (x1, x, h1)] {
                let unless = self.steps.len();
                self.steps.push(Step::Unless {
                    comparison: Comparison::Le,
                    a,
                    b,
                    target: 0,
                });
                self.formula_results(h, zero, call);
                exits.push(self.steps.len());
                self.steps.push(Step::Go { target: 0 });
                self.lands(unless, 0);
            }
        }
        let last = formula.operations.len().saturating_sub(1);
        let of_last = call
            .value
            .filter(|_| call.slopes[0].is_none() && formula.value == Number::Result(last));
        for (k, &operation) in formula.operations.iter().enumerate() {
            let step = match operation {
                Operation::Unary(op, a) => Step::Unary {
                    op,
                    a: self.number(a, x),
                    to: self.result(k, last, of_last),
                },
                Operation::Binary(op, a, b) => Step::Binary {
                    op,
                    a: self.number(a, x),
                    b: self.number(b, x),
                    to: self.result(k, last, of_last),
                },
            };
            self.steps.push(step);
        }
        if of_last.is_none() {
            let [value, slope] = [formula.value, formula.slope].map(|n| self.number(n, x));
            self.formula_results(value, slope, call);
        }
        for exit in exits {
            self.lands(exit, 0);
        }
    }

    /// Returns where the `k`-th result of a formula goes.
    fn result(&mut self, k: usize, last: usize, of_last: Option<u32>) -> u32 {
        match of_last {
            Some(to) if k == last => to,
            _ => self.between(k),
        }
    }

    /// Returns the slot of a number of a formula of `x`.
    fn number(&mut self, number: Number, x: u32) -> u32 {
        match number {
            Number::Variable => x,
            Number::Constant(c) => self.constant(c),
            Number::Result(k) => self.between(k),
        }
    }

    /// Copies value and slope to where they are wanted; either may go where the variable stands.
    fn formula_results(&mut self, value: u32, slope: u32, call: &PreparedCall) {
        let copies = [(value, call.value), (slope, call.slopes[0])];
        let in_order = match value == call.variables[0] {
            true => copies,
            false => [copies[1], copies[0]],
        };
        for (from, to) in in_order {
            if let Some(to) = to {
                self.steps.push(Step::Copy { from, to });
            }
        }
    }

    /// Lets the jump of a step lead to the next step; `side` is that of a branch.
    fn lands(&mut self, step: usize, side: u8) {
        let here = self.steps.len() as u32;
        match &mut self.steps[step] {
            Step::Unless { target, .. } | Step::Go { target } => *target = here,
            Step::Branch {
                negative,
                zero,
                positive,
                ..
            } => match side {
                0 => *negative = here,
                1 => *zero = here,
                _ => *positive = here,
            },
            step => unreachable!("{step:?} is no jump"),
        }
    }

    /// Begins or ends a side of some selections.
    fn mark(&mut self, mark: Mark, end_of_side: u32) {
        if mark.is_end {
            return self.end(mark);
        }
        if mark.side == 0 {
            self.open(mark.group);
        } else if let Some(branch) = self.open.last().map(|open| open.branch) {
            self.lands(branch, mark.side);
        }
        // what is computed here for one of the selections alone goes where that has its result
        for member in self.core.sides.groups[mark.group as usize].clone() {
            let to = self.results.to[self.core.sides.members[member] as usize];
            let chosen = &mut self.results.chosen[member][mark.side as usize];
            if let Some(x) = *chosen
                && (mark.at..end_of_side).contains(&x)
                && self.results.n_reads[x as usize] == 1
            {
                self.results.to[x as usize] = to;
            } else {
                *chosen = None;
            }
        }
    }

    /// Begins a group: emits the jump to its sides.
    fn open(&mut self, group: u32) {
        let core = self.core;
        let members = &core.sides.members[core.sides.groups[group as usize].clone()];
        let Instruction { code, a, b, .. } = core.code[members[0] as usize];
        let zero = self.constant(0.0);
        let branch = self.steps.len();
        self.steps.push(match code {
            Code::CompareSelect(comparison) => Step::Unless {
                comparison,
                a,
                b,
                target: 0,
            },
            Code::If => Step::Branch {
                selector: a,
                negative: 0,
                zero: 0,
                positive: 0,
            },
            _ => Step::Unless {
                comparison: Comparison::Lt,
                a: zero,
                b: a,
                target: 0,
            },
        });
        let mut exits = Vec::new();
        if code == Code::If {
            // where the selector is no number, no value is one
            let from = self.constant(f64::NAN);
            for &member in members {
                let to = self.results.to[member as usize];
                self.steps.push(Step::Copy { from, to });
            }
            exits.push(self.steps.len());
            self.steps.push(Step::Go { target: 0 });
            self.lands(branch, 0);
        }
        self.open.push(Open {
            group,
            branch,
            exits,
        });
    }

    /// Ends a side: copies the values that are not where the selections have their results, and leaves.
    fn end(&mut self, mark: Mark) {
        let core = self.core;
        let range = core.sides.groups[mark.group as usize].clone();
        let first = self.steps.len();
        for member in range.clone() {
            if self.results.chosen[member][mark.side as usize].is_none() {
                let instruction = core.sides.members[member] as usize;
                let from = core.code[instruction].chosen(mark.side);
                let to = self.results.to[instruction];
                self.steps.push(Step::Copy { from, to });
            }
        }
        let Some(mut open) = self.open.pop() else {
            return;
        };
        debug_assert_eq!(open.group, mark.group, "sides are nested");
        let (exits, end) = std::mem::take(&mut self.closed);
        if end == self.steps.len() && end == first {
            // what leaves an inner selection here has nothing left to do
            open.exits.extend(exits);
        }
        let instruction = core.code[core.sides.members[range.start] as usize];
        if mark.side + 1 < instruction.n_sides() {
            open.exits.push(self.steps.len());
            self.steps.push(Step::Go { target: 0 });
            self.open.push(open);
            return;
        }
        for &exit in &open.exits {
            self.lands(exit, 0);
        }
        self.closed = (open.exits, self.steps.len());
    }
}
