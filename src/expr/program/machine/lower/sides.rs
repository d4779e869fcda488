//! Selections by jumps: what only one side needs is computed only where that side is taken.
//!
//! Selections by the same condition share their sides. A value of a side goes where the selection has its register as soon as
//! it is computed; only what was there before (an input, a constant, a value with other users) is copied.

use super::super::handlers::{self, FIRST, REGISTERS, VID};
use super::super::{Kind, Meaning, Shape};
use super::{Closed, Lowering, Sides, reversed};
use crate::expr::program::operation::{Node, Value};
use crate::expr::program::order::side_operands;

impl Lowering<'_> {
    pub(super) fn begin(&mut self, v: Value, side: u8) {
        if side == 0 {
            let branch = self.branch(v);
            self.sides.push(Sides {
                branch,
                exits: Vec::new(),
                before: self.last,
                held: None,
            });
            if self.is_if(v) {
                self.no_side(v);
                self.set_jump(v, side);
            }
        } else {
            self.flush();
            self.set_jump(v, side);
        }
        self.forget();
        // the branch leaves the last result alone
        self.last = self.sides.last().and_then(|open| open.before);
    }

    /// Where the selector is no number, no value is one.
    fn no_side(&mut self, v: Value) {
        let nothing = self.constant(f64::NAN).register;
        let (others, last) = self.members(v);
        for m in others {
            self.copy(handlers::copy, nothing, m);
        }
        self.exit(handlers::fetch, nothing, last);
    }

    /// The selections whose sides stand together with those of `v`: the last, and the others.
    fn members(&self, v: Value) -> (Vec<Value>, Value) {
        let mut members = self.schedule.order.groups[&v].clone();
        let last = members.pop().unwrap_or(v);
        (members, last)
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

    /// Emits an operation that stores a number as the value of a selection.
    fn copy(&mut self, handler: super::Handler, from: u32, m: Value) {
        let to = self.register(m);
        let op = self.emit(handler, &[from, to], Kind::Registers(2));
        self.meanings[op] = Meaning::Copy;
        self.stores(m, op, 1);
    }

    /// Emits an operation that stores the value of a selection and jumps to the end.
    fn exit(&mut self, handler: super::Handler, from: u32, m: Value) {
        let to = self.register(m);
        let op = self.emit(handler, &[from, to, 1], Kind::Jumps(2, 1));
        self.meanings[op] = Meaning::CopyAndGo;
        self.stores(m, op, 1);
        self.leaves_by(op, 2);
    }

    /// An operand of the operation is to lead to the end of the open selection.
    fn leaves_by(&mut self, op: usize, operand: usize) {
        if let Some(open) = self.sides.last_mut() {
            open.exits.push((op, operand));
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
                        let branch = self.emit(
                            handler,
                            &[self.register(a), self.register(b), 1],
                            Kind::Jumps(2, 1),
                        );
                        self.meanings[branch] = Meaning::Unless(handlers::comparison_code(op));
                        branch
                    }
                    _ => {
                        let zero = self.constant(0.0).register;
                        let branch = self.emit(
                            handlers::unless::<0>,
                            &[zero, self.register(condition), 1],
                            Kind::Jumps(2, 1),
                        );
                        self.meanings[branch] = Meaning::Unless(0);
                        branch
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
                    && self.is_only_for(selector, v)
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
                    let branch = self.emit(
                        handler,
                        &[a.register, b.register, 1, 1, 1],
                        Kind::Jumps(2, 3),
                    );
                    self.meanings[branch] = Meaning::Branch(code);
                    return branch;
                }
                self.flush();
                let handler = handlers::BRANCHES[handlers::BRANCHES.len() - 1]
                    [self.source(selector) as usize];
                let register = self.register(selector);
                let branch = self.emit(handler, &[register, register, 1, 1, 1], Kind::Jumps(2, 3));
                self.meanings[branch] = Meaning::Branch(handlers::PLAIN);
                branch
            }
        }
    }

    /// Whether nothing but the selections that stand together with `v` needs their selector.
    fn is_only_for(&self, selector: Value, v: Value) -> bool {
        let members = &self.schedule.order.groups[&v];
        self.schedule.order.uses[selector.index()] as usize == members.len()
    }

    pub(super) fn end(&mut self, v: Value, side: u8) {
        self.flush();
        let builder = self.schedule.builder;
        let members = self.schedule.order.groups[&v].clone();
        let branch = self.sides.last().map_or(0, |open| open.branch);
        let operand_of = |m: Value| {
            side_operands(builder, &builder.nodes[m.index()])
                .get(side as usize)
                .copied()
                .unwrap_or(m)
        };
        let is_last =
            usize::from(side) + 1 == side_operands(builder, &builder.nodes[v.index()]).len();
        // which of the values is in `acc`, and which must be copied
        let mut held = None;
        let mut copies: Vec<Value> = Vec::new();
        for &m in &members {
            let x = operand_of(m);
            let places = self
                .places
                .get(&x)
                .filter(|places| self.is_single(x) && places.iter().all(|&(op, _)| op > branch));
            let Some(places) = places.cloned() else {
                copies.push(m);
                continue;
            };
            let to = self.register(m);
            for (op, operand) in places {
                self.ops[op].operands[operand] = to;
                self.stores(m, op, operand);
            }
            if self.last == Some(x) {
                held = Some(m);
            }
        }
        if let Some(closed) = self.closed.take()
            && closed.end == self.ops.len()
            && copies.is_empty()
            && let Some(open) = self.sides.last_mut()
        {
            // what leaves an inner selection here has nothing left to do
            open.exits.extend(closed.exits);
        }
        // what is in `acc` is stored before a copy takes its place
        if let Some(first) = copies
            .iter()
            .position(|&m| self.last == Some(operand_of(m)))
        {
            let m = copies.remove(first);
            held = Some(m);
            // where it is stored already, too
            let from = self.register(operand_of(m));
            if copies.is_empty() && !is_last {
                self.exit(handlers::leave, from, m);
            } else {
                self.copy(handlers::keep, from, m);
            }
        }
        for (k, &m) in copies.iter().enumerate() {
            let from = self.register(operand_of(m));
            held = Some(m);
            if k + 1 == copies.len() && !is_last {
                self.exit(handlers::fetch, from, m);
            } else {
                self.copy(handlers::copy, from, m);
            }
        }
        let has_left = self
            .sides
            .last()
            .is_some_and(|open| open.exits.iter().any(|&(op, _)| op + 1 == self.ops.len()));
        if !is_last && !has_left {
            let op = self.emit(handlers::go, &[1], Kind::Jumps(0, 1));
            self.meanings[op] = Meaning::Go;
            self.leaves_by(op, 0);
        }
        if let Some(open) = self.sides.last_mut() {
            open.held = match (open.held, held) {
                (None, here) => Some(here),
                (Some(before), here) if before == here => Some(here),
                _ => Some(None),
            };
        }
        self.forget();
        if is_last {
            self.close();
        }
    }

    /// Ends the open selection: its values are in their registers, one of them perhaps in `acc`.
    fn close(&mut self) {
        let Some(open) = self.sides.pop() else {
            return;
        };
        let end = self.ops.len();
        for &(exit, operand) in &open.exits {
            self.ops[exit].operands[operand] = (end - exit) as u32;
        }
        self.closed = Some(Closed {
            exits: open.exits,
            end,
        });
        self.last = open.held.flatten();
        if self.sides.is_empty() {
            self.places.clear();
        }
    }

    /// What is in `acc` is not known.
    fn forget(&mut self) {
        self.last = None;
        self.produced = None;
        self.addable = None;
    }
}
