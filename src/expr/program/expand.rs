//! Rewriting recorded values: calls of table functions, and their partial derivatives, as the
//! operations of their rows.

use super::builder::{Builder, Folding};
use super::code::{Code, Core, Instruction, partial};
use super::input::Input;
use super::node::{Node, Value};
use super::record::Sym;
use super::schedule;
use std::cell::RefCell;

/// The nodes that are expanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Expand {
    /// partial derivatives of calls
    Partials,
    /// calls and their partial derivatives
    Calls,
}

impl Builder {
    /// Returns the same values with calls or their partial derivatives expanded.
    pub(super) fn expanded(&mut self, values: &[Value], what: Expand) -> Vec<Value> {
        let n = values.iter().map(|v| v.index() + 1).max().unwrap_or(0);
        let mut needed = vec![false; n];
        for v in values {
            needed[v.index()] = true;
        }
        let mut any = false;
        for k in (0..n).rev() {
            if needed[k] {
                let node = self.nodes[k];
                any |= what.concerns(&node);
                self.operands(&node, |v| needed[v.index()] = true);
            }
        }
        if !any {
            return values.to_vec();
        }
        // the recording scalar needs the builder in a cell
        let cell = RefCell::new(std::mem::replace(self, Builder::new(Folding::Strict)));
        let mut images: Vec<Value> = (0..n as u32).map(Value).collect();
        for k in (0..n).filter(|&k| needed[k]) {
            images[k] = image(&cell, Value(k as u32), &images, what);
        }
        *self = cell.into_inner();
        values.iter().map(|v| images[v.index()]).collect()
    }
}

impl Builder {
    /// Returns the same operation over the images of its operands.
    pub(super) fn again(&mut self, v: Value, of: impl Fn(Value) -> Value) -> Value {
        let node = self.nodes[v.index()];
        let arguments = |builder: &Self| {
            let mut arguments = Vec::new();
            builder.operands(&node, |v| arguments.push(of(v)));
            arguments
        };
        match node {
            Node::Constant(_) | Node::Input(_) => v,
            Node::Unary(op, x) => self.unary(op, of(x)),
            Node::Whole(x, n) => self.powi(of(x), n),
            Node::Binary(op, a, b) => self.binary(op, of(a), of(b)),
            Node::Compare(op, a, b) => self.compare(op, of(a), of(b)),
            Node::Select(c, yes, no) => self.select(of(c), of(yes), of(no)),
            Node::If(_) => {
                let of = arguments(self);
                self.arithmetic_if(of[0], of[1], of[2], of[3])
            }
            Node::Lookup { table, order, x } => {
                let table = self.tables[table as usize].clone();
                self.lookup(&table, order, of(x))
            }
            Node::Call { function, .. } => {
                let of = arguments(self);
                self.call(function, &of)
            }
            Node::Partial { call, k } => {
                let Node::Call { function, .. } = self.nodes[call.index()] else {
                    unreachable!("only calls have partial derivatives as nodes")
                };
                let of = arguments(self);
                self.partial_of(function, &of, k)
            }
        }
    }
}

impl Core {
    /// Returns the same code with calls or their partial derivatives expanded; `None` where there
    /// are none.
    pub(super) fn expanded(&self, what: Expand) -> Option<Core> {
        let is_concerned = |instruction: &Instruction| match instruction.code {
            Code::Partial(..) => true,
            Code::Call(..) => what == Expand::Calls,
            _ => false,
        };
        if !self.code.iter().any(is_concerned) {
            return None;
        }
        let mut builder = Builder::new(Folding::Strict);
        let inputs: Vec<Input> = (0..self.n_inputs as u32).map(Input::Slot).collect();
        let outputs = self.record(&mut builder, &inputs);
        let outputs = builder.expanded(&outputs, what);
        let (_, core, _) = schedule::core(&builder, &outputs, Some(&inputs));
        Some(core)
    }
}

impl Expand {
    fn concerns(self, node: &Node) -> bool {
        match node {
            Node::Partial { .. } => true,
            Node::Call { .. } => self == Expand::Calls,
            _ => false,
        }
    }
}

/// Returns the node over the images of its operands.
fn image(cell: &RefCell<Builder>, v: Value, images: &[Value], what: Expand) -> Value {
    let of = |v: Value| images[v.index()];
    let mut builder = cell.borrow_mut();
    let node = builder.nodes[v.index()];
    let mut arguments = Vec::new();
    builder.operands(&node, |v| arguments.push(of(v)));
    match node {
        Node::Call { function, .. } if what == Expand::Calls => {
            drop(builder);
            record(cell, &arguments, |args| function.eval(args))
        }
        Node::Partial { call, k } => {
            let Node::Call { function, .. } = builder.nodes[call.index()] else {
                unreachable!("only calls have partial derivatives as nodes")
            };
            drop(builder);
            record(cell, &arguments, |args| partial(function, args, k as usize))
        }
        _ => builder.again(v, of),
    }
}

/// Records what a formula does with these values.
fn record(
    cell: &RefCell<Builder>,
    args: &[Value],
    formula: impl for<'b> Fn(&[Sym<'b>]) -> Sym<'b>,
) -> Value {
    let args: Vec<Sym> = args.iter().map(|&a| Sym::of(a, cell)).collect();
    let result = formula(&args);
    result.value(&mut cell.borrow_mut())
}
