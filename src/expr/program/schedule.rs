//! From the nodes of a builder to straight-line code: what is needed, in which order, in which
//! registers.
//!
//! The frame is `constants | inputs | temporaries`. A register is free again after its last use, so
//! that the working set stays small.

use super::builder::Builder;
use super::code::{Code, Core, Instruction, Mark, Shape, Sides};
use super::hashing::HashMap;
use super::input::Input;
use super::node::{Node, Value};
use super::order::{Item, Order};
use super::run::Program;
use std::sync::Arc;

/// Register of a node that has none (yet).
const NONE: u32 = u32::MAX;

/// Where everything stands: what code is made from.
struct Schedule<'a> {
    builder: &'a Builder,
    order: Order,
    /// register of each needed node
    registers: Vec<u32>,
}

/// Returns the program that computes `outputs`, and the nodes that its constants are. But for the
/// values of the constants it follows from the kinds of the nodes and from their operands.
pub(super) fn program(
    builder: &Builder,
    outputs: &[Value],
    layout: Option<&[Input]>,
) -> (Program, Vec<Value>) {
    let (inputs, core, constants) = core(builder, outputs, layout);
    (Program::new(inputs, core), constants)
}

/// Returns the straight code that computes `outputs`, the inputs that the host supplies, and the
/// nodes that the constants are.
pub(super) fn core(
    builder: &Builder,
    outputs: &[Value],
    layout: Option<&[Input]>,
) -> (Vec<Input>, Core, Vec<Value>) {
    let order = Order::new(builder, outputs);
    let mut registers = vec![NONE; builder.nodes.len()];
    let mut constants = Vec::new();
    let mut needed = Vec::new();
    for item in &order.items {
        let Item::Node(v) = *item else { continue };
        match builder.nodes[v.index()] {
            Node::Constant(_) => {
                registers[v.index()] = constants.len() as u32;
                constants.push(v);
            }
            Node::Input(input) => needed.push((input, v)),
            _ => {}
        }
    }
    let (inputs, used) = supplied(builder, &mut needed, layout);
    for (register, &(_, v)) in (constants.len() as u32..).zip(&needed) {
        registers[v.index()] = register;
    }
    let first_temporary = (constants.len() + used.len()) as u32;
    let mut schedule = Schedule {
        builder,
        order,
        registers,
    };
    let shape = schedule.allocate(outputs, first_temporary);
    let registers = outputs.iter().map(|v| schedule.registers[v.index()]);
    let core = Core {
        constants: numbers(builder, &constants),
        tables: builder.tables.clone(),
        shape: Arc::new(Shape {
            n_inputs: inputs.len(),
            used,
            outputs: registers.collect(),
            ..shape
        }),
    };
    (inputs, core, constants)
}

/// Returns what the host supplies, and where among it those inputs stand that are needed, each with
/// its node: these are sorted in the order in which the builder was asked for them.
pub(super) fn supplied(
    builder: &Builder,
    needed: &mut [(u32, Value)],
    layout: Option<&[Input]>,
) -> (Vec<Input>, Vec<u32>) {
    needed.sort_unstable();
    let mut inputs: Vec<Input> = layout.map(<[Input]>::to_vec).unwrap_or_default();
    let places: HashMap<Input, usize> = inputs.iter().enumerate().map(|(k, &i)| (i, k)).collect();
    let mut used = Vec::with_capacity(needed.len());
    for &(input, _) in &*needed {
        let input = builder.inputs[input as usize];
        let place = places.get(&input).copied().unwrap_or_else(|| {
            inputs.push(input);
            inputs.len() - 1
        });
        used.push(place as u32);
    }
    (inputs, used)
}

/// Returns the numbers that some values of a builder are; what is no constant is NaN.
pub(super) fn numbers(builder: &Builder, constants: &[Value]) -> Vec<f64> {
    let number = |&v: &Value| builder.constant_of(v).unwrap_or(f64::NAN);
    constants.iter().map(number).collect()
}

impl Schedule<'_> {
    /// Gives every node a register and an instruction; returns the code, without inputs and
    /// outputs.
    fn allocate(&mut self, outputs: &[Value], first_temporary: u32) -> Shape {
        let builder = self.builder;
        let mut allocation = Allocation::new(&self.order, builder, outputs, first_temporary);
        let mut shape = Shape {
            code: Vec::with_capacity(self.order.items.len()),
            ..Shape::default()
        };
        let mut groups = Groups::default();
        for (time, item) in self.order.items.iter().enumerate() {
            let v = match *item {
                Item::Node(v) => v,
                Item::Begin(first, side) => {
                    if side == 0 {
                        // the values of all sides go to registers that are held for them from the
                        // first side on
                        for &member in &self.order.groups[&first] {
                            self.registers[member.index()] = allocation.take();
                        }
                    }
                    groups.mark(first, side, false, shape.code.len());
                    continue;
                }
                Item::End(first, side) => {
                    groups.mark(first, side, true, shape.code.len());
                    continue;
                }
            };
            let node = builder.nodes[v.index()];
            if matches!(node, Node::Constant(_) | Node::Input(_)) {
                continue;
            }
            let reads = self.order.reads(v);
            let operands = self.operands(&node, reads, &mut shape.lists);
            // operands that end here free their registers before the result takes one
            for &x in reads {
                allocation.release(x, time as u32, &self.registers);
            }
            let to = match self.registers[v.index()] {
                NONE => allocation.take(),
                held => held,
            };
            self.registers[v.index()] = to;
            if self.order.is_jumped[v.index()] {
                groups.members.insert(v, shape.code.len() as u32);
            }
            let [a, b, c, d] = operands;
            shape.code.push(Instruction {
                code: self.code_of(&node, reads),
                to,
                a,
                b,
                c,
                d,
            });
        }
        shape.size = allocation.size;
        shape.sides = groups.finish(&self.order);
        shape
    }

    /// Returns the operands of an instruction: registers, or the place of the arguments of a call,
    /// which are listed.
    fn operands(&self, node: &Node, reads: &[Value], lists: &mut Vec<u32>) -> [u32; 4] {
        let mut operands = [0; 4];
        let registers = reads.iter().map(|x| self.registers[x.index()]);
        if matches!(node, Node::Call { .. } | Node::Partial { .. }) {
            operands[0] = lists.len() as u32;
            lists.extend(registers);
        } else {
            for (place, register) in operands.iter_mut().zip(registers) {
                *place = register;
            }
        }
        operands
    }

    fn code_of(&self, node: &Node, reads: &[Value]) -> Code {
        match *node {
            Node::Unary(op, _) => Code::Unary(op),
            Node::Whole(_, n) => Code::Whole(n),
            // only powers read a third
            Node::Binary(op, ..) if reads.len() == 2 => Code::Binary(op),
            Node::Binary(op, ..) => match self.builder.half_power(node) {
                Some((_, n)) => Code::HalfPower(n),
                None => Code::Binary(op),
            },
            Node::Compare(op, ..) => Code::Compare(op),
            Node::Select(condition, ..) => match self.builder.nodes[condition.index()] {
                Node::Compare(op, ..) if self.order.inlined[condition.index()] => {
                    Code::CompareSelect(op)
                }
                _ => Code::Select,
            },
            Node::If(_) => Code::If,
            Node::Lookup { table, order, .. } => Code::Lookup { table, order },
            Node::Call {
                function, count, ..
            } => Code::Call(function, count),
            Node::Partial { call, k } => match self.builder.nodes[call.index()] {
                Node::Call {
                    function, count, ..
                } => Code::Partial(function, count, k),
                _ => unreachable!("only calls have partial derivatives as nodes"),
            },
            Node::Constant(_) | Node::Input(_) => {
                unreachable!("constants and inputs are registers, not instructions")
            }
        }
    }
}

/// The sides of selections while their instructions are being placed.
#[derive(Default)]
struct Groups {
    marks: Vec<Mark>,
    /// number of the group of each selection that marks name
    numbers: HashMap<Value, u32>,
    /// selections that marks name, by number
    named: Vec<Value>,
    /// the instruction of each selection
    members: HashMap<Value, u32>,
}

impl Groups {
    fn mark(&mut self, first: Value, side: u8, is_end: bool, at: usize) {
        let group = *self.numbers.entry(first).or_insert_with(|| {
            self.named.push(first);
            self.named.len() as u32 - 1
        });
        self.marks.push(Mark {
            at: at as u32,
            group,
            side,
            is_end,
        });
    }

    fn finish(self, order: &Order) -> Sides {
        let mut sides = Sides {
            marks: self.marks,
            ..Sides::default()
        };
        for first in &self.named {
            let begin = sides.members.len();
            let instructions = order.groups[first].iter().map(|v| self.members[v]);
            sides.members.extend(instructions);
            sides.groups.push(begin..sides.members.len());
        }
        sides
    }
}

/// Which registers are in use.
struct Allocation {
    /// time of the last use of each node; the outputs are used for ever
    last_use: Vec<u32>,
    free: Vec<u32>,
    first_temporary: u32,
    size: u32,
}

impl Allocation {
    fn new(order: &Order, builder: &Builder, outputs: &[Value], first_temporary: u32) -> Self {
        let mut last_use = vec![0; builder.nodes.len()];
        for (time, item) in order.items.iter().enumerate() {
            if let Item::Node(v) = item {
                for x in order.reads(*v) {
                    last_use[x.index()] = time as u32;
                }
            }
        }
        for v in outputs {
            last_use[v.index()] = NONE;
        }
        Self {
            last_use,
            free: Vec::new(),
            first_temporary,
            size: first_temporary,
        }
    }

    fn take(&mut self) -> u32 {
        self.free.pop().unwrap_or_else(|| {
            self.size += 1;
            self.size - 1
        })
    }

    /// Frees the register of `v` if this is its last use. An operand that stands twice is freed
    /// once.
    fn release(&mut self, v: Value, time: u32, registers: &[u32]) {
        let register = registers[v.index()];
        if self.last_use[v.index()] == time && register >= self.first_temporary && register != NONE
        {
            self.free.push(register);
            self.last_use[v.index()] = NONE - 1;
        }
    }
}
