//! From a schedule to threaded code: arithmetic fused, functions prepared, costly sides jumped over.

use super::handlers::{
    self, ABS, ADD, ADDED, BUS, DIV, FIRST, LAST, MUL, REGISTERS, SQRT, SUB, VID,
};
use super::{Handler, Kind, LONGEST_CHAIN, Machine, Op, halves};
use crate::expr::functions::Function;
use crate::expr::functions::prepared::Prepared;
use crate::expr::program::Core;
use crate::expr::program::operation::{BinaryOp, Node, UnaryOp, Value};
use crate::expr::program::order::{Item, side_operands};
use crate::expr::program::schedule::Schedule;
use crate::scalar::Exponent;
use std::collections::HashMap;
use std::sync::Arc;

/// The threaded code of a schedule.
///
/// `used` are the numbers of the inputs that are read, in the order of their registers.
pub(in crate::expr::program) fn lower(
    schedule: &Schedule,
    core: &Arc<Core>,
    outputs: &[Value],
    used: &[u32],
) -> Machine {
    let mut lowering = Lowering::new(schedule, core);
    lowering.load(used);
    let items = &schedule.order.items;
    let mut k = 0;
    while k < items.len() {
        k += lowering.item(&items[k..]);
    }
    lowering.finish(outputs, used)
}

/// Arithmetic that is not emitted yet, because what follows may join it.
#[derive(Clone, Copy, Debug)]
struct Pending {
    /// the node whose value it is
    node: Value,
    shape: Shape,
    codes: [u8; 3],
    /// registers of the operands
    operands: [Operand; 5],
}

/// A register, and the node whose value it holds (to see whether that is still in `acc`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Operand {
    register: u32,
    node: Option<Value>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    /// a p b
    One,
    /// (a p b) q c
    Two,
    /// ((a p b) q c) r d
    Chain,
    /// (a p b) q (c r d)
    Balanced,
    /// ((a·b) q e) r (c·d), where e is the fifth operand
    Dot,
}

/// A selection whose sides are being emitted.
#[derive(Debug)]
struct Sides {
    selection: Value,
    /// the operation that jumps to the sides
    branch: usize,
    /// the operations that store the value of a side and jump to the end
    exits: Vec<usize>,
}

/// A selection that was just closed: its exits lead to `end`.
#[derive(Debug)]
struct Closed {
    selection: Value,
    exits: Vec<usize>,
    end: usize,
}

/// The last operation, when its value is that of one node: its place, and which operand is its register.
#[derive(Clone, Copy, Debug)]
struct Produced {
    node: Value,
    op: usize,
    operand: usize,
    /// the node whose value was in `acc` before
    before: Option<Value>,
}

struct Lowering<'a> {
    schedule: &'a Schedule<'a>,
    core: &'a Arc<Core>,
    ops: Vec<Op>,
    kinds: Vec<Kind>,
    parameters: Vec<f64>,
    /// operations by the place of their parameters, to be placed when the number of registers is known
    parameter_operands: Vec<(usize, usize)>,
    pending: Vec<Pending>,
    /// the node whose value is in `acc`
    last: Option<Value>,
    /// the last operation, if it is a function of one variable to which `acc` may be added
    addable: Option<(usize, Prepared)>,
    /// how that value came about, if by the last operation
    produced: Option<Produced>,
    sides: Vec<Sides>,
    closed: Option<Closed>,
    /// operations since the last pause
    chain: usize,
    has_paused: bool,
    /// registers of constants by their bits
    constants: HashMap<u64, u32>,
}

impl<'a> Lowering<'a> {
    fn new(schedule: &'a Schedule<'a>, core: &'a Arc<Core>) -> Self {
        let constants = core
            .constants
            .iter()
            .zip(0u32..)
            .map(|(c, k)| (c.to_bits(), k))
            .collect();
        Self {
            schedule,
            core,
            ops: Vec::new(),
            kinds: Vec::new(),
            parameters: Vec::new(),
            parameter_operands: Vec::new(),
            pending: Vec::new(),
            last: None,
            addable: None,
            produced: None,
            sides: Vec::new(),
            closed: None,
            chain: 0,
            has_paused: false,
            constants,
        }
    }

    /// Emits the operations that read the inputs.
    fn load(&mut self, used: &[u32]) {
        let first = self.core.constants.len() as u32;
        for (k, numbers) in used.chunks(handlers::LOADS.len()).enumerate() {
            let register = first + (k * handlers::LOADS.len()) as u32;
            let operands: Vec<u32> = std::iter::once(register)
                .chain(numbers.iter().copied())
                .collect();
            let n = numbers.len();
            self.emit(handlers::LOADS[n - 1], &operands, Kind::Inputs(n as u8));
        }
    }

    fn finish(mut self, outputs: &[Value], used: &[u32]) -> Machine {
        self.flush();
        if let &[output] = outputs
            && self.last != Some(output)
        {
            // the last result shall be the output
            let register = self.register(output);
            self.emit(
                handlers::copy,
                &[register, self.core.size],
                Kind::Registers(2),
            );
        }
        self.emit(handlers::halt, &[], Kind::Halt);
        // behind the registers of the core: one scratch register, then parameters
        let first_parameter = self.core.size + 1;
        for &(op, operand) in &self.parameter_operands {
            self.ops[op].operands[operand] += first_parameter;
        }
        let n_registers = first_parameter as usize + self.parameters.len();
        let n_inputs = used.iter().map(|&k| k as usize + 1).max().unwrap_or(0);
        let (ops, parameters, core) = (self.ops.into(), self.parameters, self.core.clone());
        let yields_the_value_at_once = outputs.len() == 1 && !self.has_paused;
        let machine = Machine {
            ops,
            parameters,
            n_registers,
            n_inputs,
            core,
            yields_the_value_at_once,
        };
        machine.check(&self.kinds);
        machine
    }

    /// Emits the first of these items, perhaps with those that follow; how many it took.
    fn item(&mut self, items: &[Item]) -> usize {
        match items[0] {
            Item::Begin(v, side) => self.begin(v, side),
            Item::End(v, side) => self.end(v, side),
            Item::Node(v) => return self.node(v, &items[1..]),
        }
        1
    }

    fn node(&mut self, v: Value, following: &[Item]) -> usize {
        let node = self.schedule.builder.nodes[v.index()];
        match node {
            Node::Constant(_) | Node::Input(_) => return 1,
            Node::Compare(..) if self.schedule.order.inlined[v.index()] => return 1,
            Node::Binary(op, a, b) if code(op).is_some() => {
                let (a, b) = (self.operand(a), self.operand(b));
                self.arithmetic(v, code(op).unwrap_or(ADD), a, b);
                return 1;
            }
            Node::Unary(UnaryOp::Neg, x) => {
                // −x is x·(−1), to the bit
                let (x, minus) = (self.operand(x), self.constant(-1.0));
                self.arithmetic(v, MUL, x, minus);
                return 1;
            }
            Node::Unary(op @ (UnaryOp::Sqrt | UnaryOp::Abs), x) => {
                let x = self.operand(x);
                let code = if op == UnaryOp::Sqrt { SQRT } else { ABS };
                self.arithmetic(v, code, x, Operand { node: None, ..x });
                return 1;
            }
            Node::Whole(x, n @ (3 | 4)) => {
                let x = self.operand(x);
                self.flush_if_full();
                let shape = if n == 3 { Shape::Two } else { Shape::Balanced };
                self.pending.push(Pending {
                    node: v,
                    shape,
                    codes: [MUL; 3],
                    operands: [x; 5],
                });
                return 1;
            }
            _ => {}
        }
        self.flush();
        if let Some(taken) = self.together(v, following) {
            return taken;
        }
        let to = self.register(v);
        match node {
            Node::Unary(op, x) => {
                let source = self.source(x);
                let op = self.emit(
                    handlers::unary_handler(op, source),
                    &[self.register(x), to],
                    Kind::Registers(2),
                );
                self.produced(v, op, 1);
                return 1;
            }
            Node::Select(condition, yes, no) => {
                if self.close(v) {
                    return 1;
                }
                match self.schedule.builder.nodes[condition.index()] {
                    Node::Compare(op, a, b) if self.schedule.order.inlined[condition.index()] => {
                        let handler = match handlers::comparison_code(op) {
                            0 => handlers::select::<0>,
                            1 => handlers::select::<1>,
                            _ => handlers::select::<2>,
                        };
                        let operands = [a, b, yes, no, v].map(|x| self.register(x));
                        self.emit(handler, &operands, Kind::Registers(5));
                    }
                    _ => {
                        let zero = self.constant(0.0).register;
                        let [condition, yes, no] = [condition, yes, no].map(|x| self.register(x));
                        self.emit(
                            handlers::select::<0>,
                            &[zero, condition, yes, no, to],
                            Kind::Registers(5),
                        );
                    }
                }
            }
            Node::If(_) => {
                if self.close(v) {
                    return 1;
                }
                let mut operands: Vec<u32> = Vec::new();
                self.schedule
                    .builder
                    .operands(&node, |x| operands.push(self.register(x)));
                operands.push(to);
                self.emit(handlers::arithmetic_if, &operands, Kind::Registers(5));
            }
            Node::Call {
                function: function @ (Function::Max | Function::Min),
                count: 2,
                ..
            } => {
                let mut operands: Vec<u32> = Vec::new();
                self.schedule
                    .builder
                    .operands(&node, |x| operands.push(self.register(x)));
                operands.push(to);
                let handler = if function == Function::Max {
                    handlers::larger
                } else {
                    handlers::smaller
                };
                self.emit(handler, &operands, Kind::Registers(3));
            }
            _ => self.instruction(v),
        }
        self.last = Some(v);
        1
    }

    /// An operation that several nodes share, or a prepared function; how many items it took.
    fn together(&mut self, v: Value, following: &[Item]) -> Option<usize> {
        let builder = self.schedule.builder;
        match builder.nodes[v.index()] {
            Node::Unary(op @ (UnaryOp::Sin | UnaryOp::Cos), x) => {
                let Some(&Item::Node(w)) = following.first() else {
                    return None;
                };
                match (op, builder.nodes[w.index()]) {
                    (UnaryOp::Sin, Node::Unary(UnaryOp::Cos, y))
                    | (UnaryOp::Cos, Node::Unary(UnaryOp::Sin, y))
                        if x == y =>
                    {
                        let (sine, cosine) = if op == UnaryOp::Sin { (v, w) } else { (w, v) };
                        let handler = match self.source(x) {
                            FIRST => handlers::sine_and_cosine::<FIRST>,
                            _ => handlers::sine_and_cosine::<REGISTERS>,
                        };
                        let operands = [x, sine, cosine].map(|v| self.register(v));
                        // the register of the angle may be that of the first result
                        self.emit(handler, &operands, Kind::Registers(3));
                        self.last = Some(cosine);
                        Some(2)
                    }
                    _ => None,
                }
            }
            Node::Call { .. } | Node::Partial { .. } => self.prepared(v, following),
            _ => None,
        }
    }

    /// A function with constant parameters, with those of its partial derivatives that follow.
    fn prepared(&mut self, v: Value, following: &[Item]) -> Option<usize> {
        let builder = self.schedule.builder;
        let call_of = |v: Value| match builder.nodes[v.index()] {
            Node::Call { .. } => Some((v, None)),
            Node::Partial { call, k } => Some((call, Some(k))),
            _ => None,
        };
        let (call, _) = call_of(v)?;
        let node = builder.nodes[call.index()];
        let Node::Call { function, .. } = node else {
            return None;
        };
        let mut args = Vec::new();
        builder.operands(&node, |x| args.push(x));
        let known: Vec<Option<f64>> = args.iter().map(|&x| builder.constant_of(x)).collect();
        let (prepared, parameters) = Prepared::of(function, &known)?;
        // which of value and slopes are wanted here
        let mut value = None;
        let mut slopes = [None; 2];
        let mut taken = 0;
        let group = std::iter::once(v).chain(following.iter().map_while(|item| match item {
            Item::Node(w) => Some(*w),
            _ => None,
        }));
        for w in group {
            match call_of(w) {
                Some((c, None)) if c == call => value = Some(w),
                Some((c, Some(k))) if c == call && (k as usize) < prepared.n_variables() => {
                    slopes[k as usize] = Some(w);
                }
                _ => break,
            }
            taken += 1;
        }
        if taken == 0 {
            return None;
        }
        let place = self.parameters.len() as u32;
        let n_parameters = parameters.len();
        let length = n_parameters as u32;
        self.parameters.extend(&parameters);
        let scratch = self.core.size;
        let to = |this: &Self, v: Option<Value>| v.map_or(scratch, |v| this.register(v));
        let x = args[0];
        if slopes == [None; 2] {
            let v = value?;
            if prepared.n_variables() == 2 {
                let operands = [
                    self.register(x),
                    self.register(args[1]),
                    self.register(v),
                    place,
                    length,
                ];
                self.with_parameters(contact_handler(prepared, false), &operands, 3, n_parameters);
            } else {
                let source = self.source(x);
                let operands = [self.register(x), self.register(v), place, length];
                let op = self.with_parameters(
                    prepared_handler(prepared, source),
                    &operands,
                    2,
                    n_parameters,
                );
                self.produced(v, op, 1);
                if source == REGISTERS {
                    self.addable = Some((op, prepared));
                }
            }
            self.last = value;
        } else if prepared.n_variables() == 2 {
            let [p, q] = slopes.map(|v| to(self, v));
            let operands = [
                self.register(x),
                self.register(args[1]),
                to(self, value),
                p,
                q,
                place,
            ];
            self.with_parameters(contact_handler(prepared, true), &operands, 5, n_parameters);
            self.last = slopes[1];
        } else {
            let operands = [
                self.register(x),
                to(self, value),
                to(self, slopes[0]),
                place,
                length,
            ];
            self.with_parameters(slope_handler(prepared), &operands, 3, n_parameters);
            self.last = slopes[0];
        }
        Some(taken)
    }

    /// Emits an operation whose parameters stand at `operands[at]`, counted from the first parameter.
    fn with_parameters(
        &mut self,
        handler: Handler,
        operands: &[u32],
        at: u8,
        length: usize,
    ) -> usize {
        let kind = match operands.len() {
            n if n == at as usize + 2 => Kind::Parameters(at),
            _ => Kind::Fixed(at, length as u8),
        };
        let op = self.emit(handler, operands, kind);
        self.parameter_operands.push((op, at as usize));
        op
    }

    /// The instruction of the core as it is.
    fn instruction(&mut self, v: Value) {
        let instruction = self.schedule.instructions[v.index()];
        let [low, high] = halves(Arc::as_ptr(self.core));
        self.emit(
            handlers::instruction,
            &[instruction, low, high],
            Kind::Instruction,
        );
    }

    // arithmetic

    /// Joins an operation with those before it, where nobody else needs their results.
    fn arithmetic(&mut self, v: Value, op: u8, a: Operand, b: Operand) {
        let (before, last) = match &self.pending[..] {
            [.., before, last] => (Some(*before), Some(*last)),
            [last] => (None, Some(*last)),
            [] => (None, None),
        };
        if op == ADD && self.pending.is_empty() && self.add_to_function(v, a, b) {
            return;
        }
        let is = |p: Option<Pending>, x: Operand| {
            p.is_some_and(|p| x.node == Some(p.node) && self.is_single(p.node))
        };
        let simple = |codes: &[u8]| codes.iter().all(|&c| c <= MUL);
        let short = |codes: &[u8]| codes.iter().all(|&c| c <= MUL || c >= SQRT);
        // (a p b) op (c r d)
        if let (Some(p), Some(q)) = (before, last)
            && (p.shape, q.shape) == (Shape::One, Shape::One)
            && simple(&[p.codes[0], q.codes[0], op])
        {
            let joined = if is(before, a) && is(last, b) {
                Some((p, op, q))
            } else if is(last, a) && is(before, b) {
                Some((p, reversed(op), q))
            } else {
                None
            };
            if let Some((p, op, q)) = joined {
                self.pending.truncate(self.pending.len() - 2);
                self.pending.push(Pending {
                    node: v,
                    shape: Shape::Balanced,
                    codes: [p.codes[0], op, q.codes[0]],
                    operands: [
                        p.operands[0],
                        p.operands[1],
                        q.operands[0],
                        q.operands[1],
                        p.operands[0],
                    ],
                });
                return;
            }
        }
        // ((a·b) q e) ± (c·d)
        if let (Some(p), Some(m)) = (before, last)
            && (p.shape, m.shape) == (Shape::Two, Shape::One)
            && (p.codes[0], m.codes[0]) == (MUL, MUL)
            && p.codes[1] < MUL
            && op < MUL
        {
            let code = if is(before, a) && is(last, b) {
                Some(op)
            } else if is(last, a) && is(before, b) {
                Some(reversed(op))
            } else {
                None
            };
            if let Some(code) = code {
                self.pending.truncate(self.pending.len() - 2);
                let [x, y, e, ..] = p.operands;
                self.pending.push(Pending {
                    node: v,
                    shape: Shape::Dot,
                    codes: [MUL, p.codes[1], code],
                    operands: [x, y, m.operands[0], m.operands[1], e],
                });
                return;
            }
        }
        // the last operation continued
        let continued = if a == b {
            None
        } else if is(last, a) {
            last.map(|p| (p, op, b))
        } else if is(last, b) {
            last.map(|p| (p, reversed(op), a))
        } else {
            None
        };
        if let Some((p, op, other)) = continued {
            let mut joined = Pending { node: v, ..p };
            match p.shape {
                Shape::One => {
                    joined.shape = Shape::Two;
                    joined.codes[1] = op;
                    joined.operands[2] = other;
                }
                Shape::Two if short(&[p.codes[0], p.codes[1], op]) => {
                    joined.shape = Shape::Chain;
                    joined.codes[2] = op;
                    joined.operands[3] = other;
                }
                _ => {
                    return self.push_one(
                        v,
                        op,
                        Operand {
                            register: self.register(p.node),
                            node: Some(p.node),
                        },
                        other,
                    );
                }
            }
            self.pending.pop();
            self.pending.push(joined);
            return;
        }
        self.push_one(v, op, a, b);
    }

    /// A function that was just emitted, and the result before it: one operation.
    fn add_to_function(&mut self, v: Value, a: Operand, b: Operand) -> bool {
        let (Some((op, prepared)), Some(produced)) = (self.addable, self.produced) else {
            return false;
        };
        let Some(before) = produced.before else {
            return false;
        };
        let these = [a.node, b.node];
        let fits = these == [Some(before), Some(produced.node)]
            || these == [Some(produced.node), Some(before)];
        if op != produced.op || !fits || before == produced.node || !self.is_single(produced.node) {
            return false;
        }
        self.ops[op].run = prepared_handler(prepared, ADDED);
        self.ops[op].operands[produced.operand] = self.register(v);
        self.addable = None;
        self.produced = Some(Produced {
            node: v,
            before: None,
            ..produced
        });
        self.last = Some(v);
        true
    }

    fn push_one(&mut self, node: Value, op: u8, a: Operand, b: Operand) {
        self.flush_if_full();
        self.pending.push(Pending {
            node,
            shape: Shape::One,
            codes: [op, 0, 0],
            operands: [a, b, a, a, a],
        });
    }

    fn flush_if_full(&mut self) {
        if self.pending.len() == 2 {
            let oldest = self.pending.remove(0);
            self.emit_arithmetic(oldest);
        }
    }

    fn flush(&mut self) {
        for pending in std::mem::take(&mut self.pending) {
            self.emit_arithmetic(pending);
        }
    }

    fn emit_arithmetic(&mut self, pending: Pending) {
        let Pending {
            node,
            shape,
            codes: [mut p, mut q, mut r],
            operands: [mut a, mut b, mut c, mut d, e],
        } = pending;
        let in_acc = |x: Operand| x.node.is_some() && x.node == self.last;
        // bring the last result to the first place, or else to the last
        if in_acc(b) && !in_acc(a) {
            (a, b, p) = (b, a, reversed(p));
        }
        if shape == Shape::Balanced && !in_acc(a) && (in_acc(c) || in_acc(d)) {
            (a, b, c, d) = (c, d, a, b);
            (p, q, r) = (r, reversed(q), p);
            if in_acc(b) && !in_acc(a) {
                (a, b, p) = (b, a, reversed(p));
            }
        }
        let to = self.register(node);
        let short = [p, q, r].map(|code| {
            usize::from(if code >= SQRT {
                code - SQRT + MUL + 1
            } else {
                code
            })
        });
        let [p, q, r] = [p, q, r].map(usize::from);
        let first = in_acc(a);
        let source = |last: Operand| match (first, in_acc(last)) {
            (true, _) => FIRST as usize,
            (false, true) => LAST as usize,
            _ => REGISTERS as usize,
        };
        let [ra, rb, rc, rd, re] = [a, b, c, d, e].map(|x| x.register);
        let (handler, operands): (Handler, &[u32]) = match shape {
            Shape::One => (handlers::ONES[p][usize::from(first)], &[ra, rb, to]),
            Shape::Two => (handlers::TWOS[p][q][source(c)], &[ra, rb, rc, to]),
            Shape::Chain => {
                let [p, q, r] = short;
                (handlers::CHAINS[p][q][r][source(d)], &[ra, rb, rc, rd, to])
            }
            Shape::Balanced => (
                handlers::BALANCED[p][q][r][source(d)],
                &[ra, rb, rc, rd, to],
            ),
            Shape::Dot => (handlers::DOTS[q][r][source(e)], &[ra, rb, rc, rd, re, to]),
        };
        let op = self.emit(handler, operands, Kind::Registers(operands.len() as u8));
        self.produced(node, op, operands.len() - 1);
    }

    // sides

    fn begin(&mut self, v: Value, side: u8) {
        if side == 0 {
            let branch = self.branch(v);
            self.sides.push(Sides {
                selection: v,
                branch,
                exits: Vec::new(),
            });
            if self.is_if(v) {
                // where the selector is no number
                let nothing = self.constant(f64::NAN).register;
                self.exit(handlers::fetch, nothing, v);
                self.set_jump(v, side);
            }
        } else {
            self.flush();
            self.set_jump(v, side);
        }
        self.forget();
    }

    fn is_if(&self, v: Value) -> bool {
        matches!(self.schedule.builder.nodes[v.index()], Node::If(_))
    }

    /// Lets the branch of the open selection lead here for a side.
    fn set_jump(&mut self, v: Value, side: u8) {
        let Some(branch) = self.sides.last().map(|open| open.branch) else {
            return;
        };
        let operand = if self.is_if(v) { 2 + side as usize } else { 2 };
        self.ops[branch].operands[operand] = (self.ops.len() - branch) as u32;
    }

    /// Emits an operation that stores the value of a side and jumps to the end.
    fn exit(&mut self, handler: Handler, from: u32, v: Value) {
        let to = self.register(v);
        let exit = self.emit(handler, &[from, to, 1], Kind::Jumps(2, 1));
        if let Some(open) = self.sides.last_mut() {
            open.exits.push(exit);
        }
    }

    /// Emits the operation that chooses a side; its jumps are set when the sides are there.
    fn branch(&mut self, v: Value) -> usize {
        let builder = self.schedule.builder;
        match builder.nodes[v.index()] {
            Node::Select(condition, ..) => {
                self.flush();
                match builder.nodes[condition.index()] {
                    Node::Compare(op, a, b) if self.schedule.order.inlined[condition.index()] => {
                        let handler = match handlers::comparison_code(op) {
                            0 => handlers::unless::<0>,
                            1 => handlers::unless::<1>,
                            _ => handlers::unless::<2>,
                        };
                        self.emit(
                            handler,
                            &[self.register(a), self.register(b), 1],
                            Kind::Jumps(2, 1),
                        )
                    }
                    _ => {
                        let zero = self.constant(0.0).register;
                        self.emit(
                            handlers::unless::<0>,
                            &[zero, self.register(condition), 1],
                            Kind::Jumps(2, 1),
                        )
                    }
                }
            }
            node => {
                let mut selector = None;
                builder.operands(&node, |x| selector = selector.or(Some(x)));
                let selector = selector.unwrap_or(v);
                // an operation that only the selector needs joins the branch
                if let Some(last) = self.pending.last().copied()
                    && last.node == selector
                    && last.shape == Shape::One
                    && last.codes[0] <= VID
                    && self.is_single(selector)
                {
                    self.pending.pop();
                    self.flush();
                    let [mut a, mut b, ..] = last.operands;
                    let mut code = last.codes[0];
                    if self.last.is_some() && b.node == self.last {
                        (a, b, code) = (b, a, reversed(code));
                    }
                    let source = if self.last.is_some() && a.node == self.last {
                        FIRST
                    } else {
                        REGISTERS
                    };
                    let handler = handlers::BRANCHES[code as usize][source as usize];
                    return self.emit(
                        handler,
                        &[a.register, b.register, 1, 1, 1],
                        Kind::Jumps(2, 3),
                    );
                }
                self.flush();
                let handler = handlers::BRANCHES[handlers::BRANCHES.len() - 1]
                    [self.source(selector) as usize];
                let register = self.register(selector);
                self.emit(handler, &[register, register, 1, 1, 1], Kind::Jumps(2, 3))
            }
        }
    }

    fn end(&mut self, v: Value, side: u8) {
        self.flush();
        let node = self.schedule.builder.nodes[v.index()];
        let sides = side_operands(self.schedule.builder, &node);
        let Some(&x) = sides.get(side as usize) else {
            return;
        };
        let (from, to) = (self.register(x), self.register(v));
        let is_here = self.last == Some(x);
        // the value of an inner selection goes from its sides straight to where it is wanted
        if let Some(closed) = self.closed.take()
            && (closed.selection, closed.end) == (x, self.ops.len())
            && self.is_single(x)
        {
            for &exit in &closed.exits {
                self.ops[exit].operands[1] = to;
            }
            if let Some(open) = self.sides.last_mut() {
                open.exits.extend(closed.exits);
            }
        }
        let is_last = usize::from(side) + 1 == sides.len();
        match self.produced {
            Some(p)
                if is_last && p.node == x && p.op + 1 == self.ops.len() && self.is_single(x) =>
            {
                self.ops[p.op].operands[p.operand] = to;
                self.produced = Some(Produced { node: v, ..p });
            }
            _ if is_last => {
                let handler = if is_here {
                    handlers::keep
                } else {
                    handlers::copy
                };
                let op = self.emit(handler, &[from, to], Kind::Registers(2));
                self.produced(v, op, 1);
            }
            _ => {
                self.exit(
                    if is_here {
                        handlers::leave
                    } else {
                        handlers::fetch
                    },
                    from,
                    v,
                );
                self.forget();
            }
        }
    }

    /// Ends a selection whose sides were emitted: the value is in its register and in `acc`.
    fn close(&mut self, v: Value) -> bool {
        if self.sides.last().is_none_or(|side| side.selection != v) {
            return false;
        }
        if let Some(sides) = self.sides.pop() {
            let end = self.ops.len();
            for &exit in &sides.exits {
                self.ops[exit].operands[2] = (end - exit) as u32;
            }
            self.closed = Some(Closed {
                selection: v,
                exits: sides.exits,
                end,
            });
        }
        self.last = Some(v);
        self.addable = None;
        true
    }

    /// What is in `acc` is not known.
    fn forget(&mut self) {
        self.last = None;
        self.produced = None;
        self.addable = None;
    }

    /// The operation `op` yields the value of a node and stores it where an operand says.
    fn produced(&mut self, node: Value, op: usize, operand: usize) {
        self.produced = Some(Produced {
            node,
            op,
            operand,
            before: self.last,
        });
        self.last = Some(node);
    }

    // emission

    /// Appends an operation; its place.
    fn emit(&mut self, run: Handler, operands: &[u32], kind: Kind) -> usize {
        if self.chain >= LONGEST_CHAIN {
            self.ops.push(Op {
                run: handlers::pause,
                operands: [0; 6],
            });
            self.kinds.push(Kind::Registers(0));
            self.chain = 0;
            self.has_paused = true;
        }
        self.chain += 1;
        self.addable = None;
        let mut all = [0; 6];
        all[..operands.len()].copy_from_slice(operands);
        self.ops.push(Op { run, operands: all });
        self.kinds.push(kind);
        self.ops.len() - 1
    }

    fn register(&self, v: Value) -> u32 {
        self.schedule.registers[v.index()]
    }
    fn operand(&self, v: Value) -> Operand {
        Operand {
            register: self.register(v),
            node: Some(v),
        }
    }
    /// The register of a constant of our own.
    fn constant(&mut self, c: f64) -> Operand {
        if let Some(&register) = self.constants.get(&c.to_bits()) {
            return Operand {
                register,
                node: None,
            };
        }
        let place = self.parameters.len() as u32;
        self.parameters.push(c);
        let register = self.core.size + 1 + place;
        self.constants.insert(c.to_bits(), register);
        Operand {
            register,
            node: None,
        }
    }
    fn is_single(&self, v: Value) -> bool {
        self.schedule.order.uses[v.index()] == 1
    }
    fn source(&self, x: Value) -> u8 {
        if self.last == Some(x) {
            FIRST
        } else {
            REGISTERS
        }
    }
}

/// The code of an arithmetic operation.
fn code(op: BinaryOp) -> Option<u8> {
    match op {
        BinaryOp::Add => Some(ADD),
        BinaryOp::Sub => Some(SUB),
        BinaryOp::Mul => Some(MUL),
        BinaryOp::Div => Some(DIV),
        _ => None,
    }
}

/// The operation with its operands exchanged.
fn reversed(code: u8) -> u8 {
    match code {
        SUB => BUS,
        BUS => SUB,
        DIV => VID,
        VID => DIV,
        same => same,
    }
}

fn prepared_handler(prepared: Prepared, source: u8) -> Handler {
    macro_rules! by_source {
        ($f:ident) => {
            match source {
                FIRST => handlers::$f::<FIRST>,
                ADDED => handlers::$f::<ADDED>,
                _ => handlers::$f::<REGISTERS>,
            }
        };
    }
    match prepared {
        Prepared::Step => by_source!(step),
        Prepared::Step5 => by_source!(step5),
        Prepared::Havsin => by_source!(havsin),
        Prepared::Poly => by_source!(poly),
        Prepared::Cheby => by_source!(cheby),
        Prepared::Forcos => by_source!(forcos),
        Prepared::Forsin => by_source!(forsin),
        Prepared::Impact(_) | Prepared::Bistop(_) => unreachable!("contacts have two variables"),
    }
}

fn slope_handler(prepared: Prepared) -> Handler {
    match prepared {
        Prepared::Step => handlers::step_slope,
        Prepared::Step5 => handlers::step5_slope,
        Prepared::Havsin => handlers::havsin_slope,
        Prepared::Poly => handlers::poly_slope,
        Prepared::Cheby => handlers::cheby_slope,
        Prepared::Forcos => handlers::forcos_slope,
        Prepared::Forsin => handlers::forsin_slope,
        Prepared::Impact(_) | Prepared::Bistop(_) => unreachable!("contacts have two variables"),
    }
}

fn contact_handler(prepared: Prepared, slopes: bool) -> Handler {
    use handlers::{ONE, OTHER, THREE_HALVES, TWO, WHOLE_OR_HALF};
    macro_rules! by_exponent {
        ($f:ident, $e:expr) => {
            match $e {
                Exponent::Whole(1) => handlers::$f::<ONE>,
                Exponent::Half(1) => handlers::$f::<THREE_HALVES>,
                Exponent::Whole(2) => handlers::$f::<TWO>,
                Exponent::Other => handlers::$f::<OTHER>,
                _ => handlers::$f::<WHOLE_OR_HALF>,
            }
        };
    }
    match (prepared, slopes) {
        (Prepared::Impact(e), false) => by_exponent!(impact, e),
        (Prepared::Impact(e), true) => by_exponent!(impact_slope, e),
        (Prepared::Bistop(e), false) => by_exponent!(bistop, e),
        (Prepared::Bistop(e), true) => by_exponent!(bistop_slope, e),
        _ => unreachable!("only contacts have two variables"),
    }
}
