//! Arithmetic fused: up to three operations whose results nobody else needs become one.

use super::super::handlers::{
    self, ADD, ADDED, ALONG, BUS, DIV, FIRST, LAST, MUL, REGISTERS, SQRT, SUB, VID,
};
use super::super::{Handler, Kind, Meaning, Shape};
use super::functions::prepared_handler;
use super::{Lowering, Produced};
use crate::expr::program::operation::{BinaryOp, Value};

/// Arithmetic that is not emitted yet, because what follows may join it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pending {
    /// the node whose value it is
    pub(super) node: Value,
    pub(super) shape: Shape,
    pub(super) codes: [u8; 3],
    /// registers of the operands
    pub(super) operands: [Operand; 5],
}

/// A register, and the node whose value it holds (to see whether that is still in `acc`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Operand {
    pub(super) register: u32,
    pub(super) node: Option<Value>,
}

impl Lowering<'_> {
    /// Joins an operation with those before it, where nobody else needs their results.
    pub(super) fn arithmetic(&mut self, v: Value, op: u8, a: Operand, b: Operand) {
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
        } else if is(last, b) && op != ALONG {
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
        self.meanings[op] = Meaning::Prepared {
            function: prepared,
            slope: false,
            added: Some(self.register(before)),
        };
        self.ops[op].operands[produced.operand] = self.register(v);
        self.addable = None;
        self.produced = Some(Produced {
            node: v,
            before: None,
            ..produced
        });
        self.last = Some(v);
        self.stores(v, produced.op, produced.operand);
        true
    }

    pub(super) fn push_one(&mut self, node: Value, op: u8, a: Operand, b: Operand) {
        self.flush_if_full();
        self.pending.push(Pending {
            node,
            shape: Shape::One,
            codes: [op, 0, 0],
            operands: [a, b, a, a, a],
        });
    }

    pub(super) fn flush_if_full(&mut self) {
        if self.pending.len() == 2 {
            let oldest = self.pending.remove(0);
            self.emit_arithmetic(oldest);
        }
    }

    pub(super) fn flush(&mut self) {
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
        if in_acc(b) && !in_acc(a) && p != ALONG {
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
        let meaning = Meaning::Arithmetic(shape, [p, q, r]);
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
        self.meanings[op] = meaning;
        self.produced(node, op, operands.len() - 1);
    }
}

/// The code of an arithmetic operation.
pub(super) fn code(op: BinaryOp) -> Option<u8> {
    match op {
        BinaryOp::Add => Some(ADD),
        BinaryOp::Sub => Some(SUB),
        BinaryOp::Mul => Some(MUL),
        BinaryOp::Div => Some(DIV),
        BinaryOp::Along => Some(ALONG),
        _ => None,
    }
}

/// The operation with its operands exchanged; there is none of `ALONG`.
pub(super) fn reversed(code: u8) -> u8 {
    match code {
        SUB => BUS,
        BUS => SUB,
        DIV => VID,
        VID => DIV,
        same => same,
    }
}
