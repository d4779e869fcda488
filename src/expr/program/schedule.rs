//! From the nodes of a builder to straight-line code: what is needed, in which order, in which registers.
//!
//! The frame is `constants | inputs | temporaries`. A register is free again after its last use, so that the working set
//! stays small.

use super::operation::{Node, Value};
use super::order::{Item, Order};
use super::{Builder, Code, Core, Input, Instruction, Program, machine};
use std::sync::Arc;

/// Register of a node that has none (yet).
const NONE: u32 = u32::MAX;

/// Where everything stands: what code is made from.
pub(super) struct Schedule<'a> {
    pub(super) builder: &'a Builder,
    pub(super) order: Order,
    /// register of each needed node
    pub(super) registers: Vec<u32>,
    /// place of each needed node in the code; `NONE` for constants and inputs
    pub(super) instructions: Vec<u32>,
}

/// The program that computes `outputs`.
pub(super) fn program(builder: &Builder, outputs: &[Value], layout: Option<&[Input]>) -> Program {
    let order = Order::new(builder, outputs);
    let mut registers = vec![NONE; builder.nodes.len()];
    let mut constants = Vec::new();
    let mut needed = Vec::new();
    for item in &order.items {
        let Item::Node(v) = *item else { continue };
        match builder.nodes[v.index()] {
            Node::Constant(bits) => {
                registers[v.index()] = constants.len() as u32;
                constants.push(f64::from_bits(bits));
            }
            Node::Input(input) => needed.push((input, v)),
            _ => {}
        }
    }
    // inputs in the order in which the builder was asked for them
    needed.sort_unstable();
    let mut inputs: Vec<Input> = layout.map(<[Input]>::to_vec).unwrap_or_default();
    let places: std::collections::HashMap<Input, usize> =
        inputs.iter().enumerate().map(|(k, &i)| (i, k)).collect();
    let mut used = Vec::with_capacity(needed.len());
    for &(input, v) in &needed {
        let input = builder.inputs[input as usize];
        let place = places.get(&input).copied().unwrap_or_else(|| {
            inputs.push(input);
            inputs.len() - 1
        });
        registers[v.index()] = (constants.len() + used.len()) as u32;
        used.push(place as u32);
    }
    let first_temporary = (constants.len() + used.len()) as u32;
    let instructions = vec![NONE; builder.nodes.len()];
    let mut schedule = Schedule {
        builder,
        order,
        registers,
        instructions,
    };
    let (code, lists, size) = schedule.allocate(outputs, first_temporary);
    let registers: Vec<u32> = outputs
        .iter()
        .map(|v| schedule.registers[v.index()])
        .collect();
    let core = Arc::new(Core {
        constants,
        code,
        lists,
        tables: builder.tables.clone(),
        size,
    });
    let machine = machine::lower(&schedule, &core, outputs, &used);
    Program::new(inputs, used, registers, core, machine)
}

impl Schedule<'_> {
    /// Gives every node a register and an instruction: the code, the argument lists, the number of registers.
    fn allocate(
        &mut self,
        outputs: &[Value],
        first_temporary: u32,
    ) -> (Vec<Instruction>, Vec<u32>, u32) {
        let builder = self.builder;
        let mut allocation = Allocation::new(&self.order, builder, outputs, first_temporary);
        let mut code = Vec::with_capacity(self.order.items.len());
        let mut lists = Vec::new();
        for (time, item) in self.order.items.iter().enumerate() {
            let v = match *item {
                Item::Node(v) => v,
                Item::Begin(first, 0) => {
                    // the values of all sides go to registers that are held for them from the first side on
                    for &member in &self.order.groups[&first] {
                        self.registers[member.index()] = allocation.take();
                    }
                    continue;
                }
                _ => continue,
            };
            let node = builder.nodes[v.index()];
            if matches!(node, Node::Constant(_) | Node::Input(_)) {
                continue;
            }
            let mut operands = [0; 4];
            let mut n = 0;
            let first_in_list = lists.len() as u32;
            let is_call = matches!(node, Node::Call { .. } | Node::Partial { .. });
            self.order.operands(builder, &node, |x| {
                let register = self.registers[x.index()];
                if is_call {
                    lists.push(register);
                } else {
                    operands[n] = register;
                    n += 1;
                }
            });
            if is_call {
                operands[0] = first_in_list;
            }
            // operands that end here free their registers before the result takes one
            self.order.operands(builder, &node, |x| {
                allocation.release(x, time as u32, &self.registers)
            });
            let to = match self.registers[v.index()] {
                NONE => allocation.take(),
                held => held,
            };
            self.registers[v.index()] = to;
            self.instructions[v.index()] = code.len() as u32;
            let [a, b, c, d] = operands;
            code.push(Instruction {
                code: self.code_of(&node),
                to,
                a,
                b,
                c,
                d,
            });
        }
        (code, lists, allocation.size)
    }

    fn code_of(&self, node: &Node) -> Code {
        match *node {
            Node::Unary(op, _) => Code::Unary(op),
            Node::Whole(_, n) => Code::Whole(n),
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
                order.operands(builder, &builder.nodes[v.index()], |x| {
                    last_use[x.index()] = time as u32
                });
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

    /// Frees the register of `v` if this is its last use. An operand that stands twice is freed once.
    fn release(&mut self, v: Value, time: u32, registers: &[u32]) {
        let register = registers[v.index()];
        if self.last_use[v.index()] == time && register >= self.first_temporary && register != NONE
        {
            self.free.push(register);
            self.last_use[v.index()] = NONE - 1;
        }
    }
}
