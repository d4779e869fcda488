//! From a schedule to threaded code: arithmetic fused, functions prepared, costly sides jumped over.

mod arithmetic;
mod functions;
mod sides;

use super::handlers::{self, ABS, ADD, FIRST, MUL, REGISTERS, SQRT};
use super::native::Native;
use super::{Handler, Kind, LONGEST_CHAIN, Machine, Meaning, Op, Shape, Threaded};
use crate::expr::functions::Function;
use crate::expr::functions::prepared::Prepared;
use crate::expr::program::Core;
use crate::expr::program::operation::{Node, UnaryOp, Value};
use crate::expr::program::order::Item;
use crate::expr::program::schedule::Schedule;
use arithmetic::{Operand, Pending, code, reversed};
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::AtomicPtr;

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

/// Selections whose sides are being emitted.
#[derive(Debug)]
struct Sides {
    /// the operation that jumps to the sides
    branch: usize,
    /// operations that leave a side, and which operand says how far
    exits: Vec<(usize, usize)>,
    /// the node whose value is in `acc` when a side begins
    before: Option<Value>,
    /// the selection whose value is in `acc` when a side ends; `None` before the first has ended
    held: Option<Option<Value>>,
}

/// Selections that were just closed: their exits lead to `end`.
#[derive(Debug)]
struct Closed {
    exits: Vec<(usize, usize)>,
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
    meanings: Vec<Meaning>,
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
    /// inside sides: the operations that store the value of a node, and which operand names the register
    places: HashMap<Value, Vec<(usize, usize)>>,
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
            meanings: Vec::new(),
            parameters: Vec::new(),
            parameter_operands: Vec::new(),
            pending: Vec::new(),
            last: None,
            addable: None,
            produced: None,
            places: HashMap::new(),
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
            let op = self.emit(handlers::LOADS[n - 1], &operands, Kind::Inputs(n as u8));
            self.meanings[op] = Meaning::Inputs;
        }
    }

    fn finish(mut self, outputs: &[Value], used: &[u32]) -> Machine {
        self.flush();
        if let &[output] = outputs
            && self.last != Some(output)
        {
            // the last result shall be the output
            let register = self.register(output);
            let op = self.emit(
                handlers::copy,
                &[register, self.core.size],
                Kind::Registers(2),
            );
            self.meanings[op] = Meaning::Copy;
        }
        let end = self.emit(handlers::halt, &[], Kind::Halt);
        self.meanings[end] = Meaning::Halt;
        // behind the registers of the core: one scratch register, then parameters
        let first_parameter = self.core.size + 1;
        for &(op, operand) in &self.parameter_operands {
            self.ops[op].operands[operand] += first_parameter;
        }
        let n_registers = first_parameter as usize + self.parameters.len();
        let n_inputs = used.iter().map(|&k| k as usize + 1).max().unwrap_or(0);
        let ops: Arc<[Op]> = self.ops.into();
        let (parameters, core) = (self.parameters, self.core.clone());
        let yields_the_value_at_once = outputs.len() == 1 && !self.has_paused;
        let outputs: Vec<u32> = outputs
            .iter()
            .map(|&v| self.schedule.registers[v.index()])
            .collect();
        let machine = Machine {
            start: AtomicPtr::new(ops.as_ptr().cast_mut()),
            native: None,
            ops,
            parameters,
            n_registers,
            n_inputs,
            core,
            yields_the_value_at_once,
        };
        machine.check(&self.kinds);
        let native = Native::of(Threaded {
            ops: machine.ops.clone(),
            kinds: self.kinds,
            meanings: self.meanings,
            core: machine.core.clone(),
            parameters: machine.parameters.clone(),
            n_registers,
            outputs,
        });
        Machine { native, ..machine }
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
            // its sides have stored the value
            Node::Select(..) | Node::If(_) if self.schedule.order.is_jumped[v.index()] => return 1,
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
                match self.schedule.builder.nodes[condition.index()] {
                    Node::Compare(op, a, b) if self.schedule.order.inlined[condition.index()] => {
                        let handler = match handlers::comparison_code(op) {
                            0 => handlers::select::<0>,
                            1 => handlers::select::<1>,
                            _ => handlers::select::<2>,
                        };
                        let operands = [a, b, yes, no, v].map(|x| self.register(x));
                        let code = handlers::comparison_code(op);
                        let op = self.emit(handler, &operands, Kind::Registers(5));
                        self.meanings[op] = Meaning::Select(code);
                        self.stores(v, op, 4);
                    }
                    _ => {
                        let zero = self.constant(0.0).register;
                        let [condition, yes, no] = [condition, yes, no].map(|x| self.register(x));
                        let op = self.emit(
                            handlers::select::<0>,
                            &[zero, condition, yes, no, to],
                            Kind::Registers(5),
                        );
                        self.meanings[op] = Meaning::Select(0);
                        self.stores(v, op, 4);
                    }
                }
            }
            Node::If(_) => {
                let mut operands: Vec<u32> = Vec::new();
                self.schedule
                    .builder
                    .operands(&node, |x| operands.push(self.register(x)));
                operands.push(to);
                let op = self.emit(handlers::arithmetic_if, &operands, Kind::Registers(5));
                self.stores(v, op, 4);
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
                let op = self.emit(handler, &operands, Kind::Registers(3));
                self.stores(v, op, 2);
            }
            _ => self.instruction(v),
        }
        self.last = Some(v);
        1
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
        self.stores(node, op, operand);
    }

    /// An operand of the operation `op` is the register of a node.
    fn stores(&mut self, node: Value, op: usize, operand: usize) {
        if !self.sides.is_empty() {
            self.places.entry(node).or_default().push((op, operand));
        }
    }

    /// Appends an operation; its place.
    fn emit(&mut self, run: Handler, operands: &[u32], kind: Kind) -> usize {
        if self.chain >= LONGEST_CHAIN {
            self.ops.push(Op {
                run: handlers::pause,
                operands: [0; 6],
            });
            self.kinds.push(Kind::Registers(0));
            self.meanings.push(Meaning::Pause);
            self.chain = 0;
            self.has_paused = true;
        }
        self.chain += 1;
        self.addable = None;
        let mut all = [0; 6];
        all[..operands.len()].copy_from_slice(operands);
        self.ops.push(Op { run, operands: all });
        self.kinds.push(kind);
        self.meanings.push(Meaning::Handled);
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
