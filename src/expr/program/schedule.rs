//! From the nodes of a builder to straight-line code: what is needed, in which order, in which registers.
//!
//! Operands are computed near their first use, the more demanding one first (Sethi and Ullman), and a register is free
//! again after its last use, so that the working set stays small. The frame is `constants | inputs | temporaries`.

use super::operation::{Node, Value};
use super::{Builder, Code, Input, Instruction, Program};

/// Register of a node that has none (yet).
const NONE: u32 = u32::MAX;

/// The program that computes `outputs`.
pub(super) fn program(builder: &Builder, outputs: &[Value], layout: Option<&[Input]>) -> Program {
    let order = order(builder, outputs);
    let mut registers = vec![NONE; builder.nodes.len()];
    let mut constants = Vec::new();
    for &k in &order {
        if let Node::Constant(bits) = builder.nodes[k as usize] {
            registers[k as usize] = constants.len() as u32;
            constants.push(f64::from_bits(bits));
        }
    }
    // inputs in the order in which the builder was asked for them
    let mut needed: Vec<(u32, u32)> = order
        .iter()
        .filter_map(|&k| match builder.nodes[k as usize] {
            Node::Input(input) => Some((input, k)),
            _ => None,
        })
        .collect();
    needed.sort_unstable();
    let mut inputs: Vec<Input> = layout.map(<[Input]>::to_vec).unwrap_or_default();
    let places: std::collections::HashMap<Input, usize> =
        inputs.iter().enumerate().map(|(k, &i)| (i, k)).collect();
    let mut used = Vec::with_capacity(needed.len());
    for &(input, k) in &needed {
        let input = builder.inputs[input as usize];
        let place = places.get(&input).copied().unwrap_or_else(|| {
            inputs.push(input);
            inputs.len() - 1
        });
        registers[k as usize] = (constants.len() + used.len()) as u32;
        used.push(place as u32);
    }
    let mut allocation = Allocation::new(
        builder,
        &order,
        outputs,
        (constants.len() + used.len()) as u32,
    );
    let mut code = Vec::with_capacity(order.len());
    let mut lists = Vec::new();
    for (time, &k) in order.iter().enumerate() {
        let node = builder.nodes[k as usize];
        if matches!(node, Node::Constant(_) | Node::Input(_)) {
            continue;
        }
        let mut operands = [0; 4];
        let mut n = 0;
        let first_in_list = lists.len() as u32;
        let is_call = matches!(node, Node::Call { .. } | Node::Partial { .. });
        builder.operands(&node, |v| {
            let register = registers[v.index()];
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
        builder.operands(&node, |v| {
            allocation.release(v, time as u32, &mut registers)
        });
        let to = allocation.take();
        registers[k as usize] = to;
        let [a, b, c, d] = operands;
        code.push(Instruction {
            code: code_of(builder, &node),
            to,
            a,
            b,
            c,
            d,
        });
    }
    let outputs = outputs.iter().map(|v| registers[v.index()]).collect();
    Program::new(
        constants,
        inputs,
        used,
        code,
        lists,
        builder.tables.clone(),
        outputs,
        allocation.size,
    )
}

/// Needed nodes, operands before users, each near its first use.
fn order(builder: &Builder, outputs: &[Value]) -> Vec<u32> {
    let demand = demand(builder);
    let mut placed = vec![false; builder.nodes.len()];
    let mut order = Vec::new();
    // (node, whether its operands are placed)
    let mut stack: Vec<(Value, bool)> = Vec::new();
    let mut operands: Vec<Value> = Vec::new();
    for &output in outputs {
        stack.push((output, false));
        while let Some((v, ready)) = stack.pop() {
            if placed[v.index()] {
                continue;
            }
            if ready {
                placed[v.index()] = true;
                order.push(v.0);
                continue;
            }
            stack.push((v, true));
            operands.clear();
            builder.operands(&builder.nodes[v.index()], |o| {
                if !placed[o.index()] {
                    operands.push(o);
                }
            });
            // the last pushed is placed first: least demanding below
            operands.reverse();
            operands.sort_by_key(|o| demand[o.index()]);
            stack.extend(operands.iter().map(|&o| (o, false)));
        }
    }
    order
}

/// How many registers the tree below each node would need.
fn demand(builder: &Builder) -> Vec<u16> {
    let mut demand = vec![0u16; builder.nodes.len()];
    let mut below: Vec<u16> = Vec::new();
    for (k, node) in builder.nodes.iter().enumerate() {
        below.clear();
        builder.operands(node, |v| below.push(demand[v.index()]));
        below.sort_unstable_by(|a, b| b.cmp(a));
        demand[k] = below
            .iter()
            .zip(0u16..)
            .map(|(d, held)| d.saturating_add(held))
            .max()
            .map_or(0, |most| most.max(1));
    }
    demand
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
    fn new(builder: &Builder, order: &[u32], outputs: &[Value], first_temporary: u32) -> Self {
        let mut last_use = vec![0; builder.nodes.len()];
        for (time, &k) in order.iter().enumerate() {
            last_use[k as usize] = time as u32;
            builder.operands(&builder.nodes[k as usize], |v| {
                last_use[v.index()] = time as u32
            });
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
    fn release(&mut self, v: Value, time: u32, registers: &mut [u32]) {
        let register = registers[v.index()];
        if self.last_use[v.index()] == time && register >= self.first_temporary && register != NONE
        {
            self.free.push(register);
            self.last_use[v.index()] = NONE - 1;
        }
    }
}

fn code_of(builder: &Builder, node: &Node) -> Code {
    match *node {
        Node::Unary(op, _) => Code::Unary(op),
        Node::Whole(_, n) => Code::Whole(n),
        Node::Binary(op, ..) => Code::Binary(op),
        Node::Compare(op, ..) => Code::Compare(op),
        Node::Select(..) => Code::Select,
        Node::If(_) => Code::If,
        Node::Lookup { table, order, .. } => Code::Lookup { table, order },
        Node::Call {
            function, count, ..
        } => Code::Call(function, count),
        Node::Partial { call, k } => match builder.nodes[call.index()] {
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
