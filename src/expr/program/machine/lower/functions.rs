//! Functions of the table as operations of the machine: their constant arguments prepared, value and slopes together.

use super::super::handlers::{self, ADDED, FIRST, REGISTERS};
use super::super::{Handler, Kind, Meaning, halves};
use super::Lowering;
use crate::expr::functions::prepared::Prepared;
use crate::expr::program::operation::{Node, UnaryOp, Value};
use crate::expr::program::order::Item;
use crate::scalar::Exponent;
use std::sync::Arc;

impl Lowering<'_> {
    /// An operation that several nodes share, or a prepared function; how many items it took.
    pub(super) fn together(&mut self, v: Value, following: &[Item]) -> Option<usize> {
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
                        let op = self.emit(handler, &operands, Kind::Registers(3));
                        self.stores(sine, op, 1);
                        self.stores(cosine, op, 2);
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
                let op = self.with_parameters(
                    contact_handler(prepared, false),
                    &operands,
                    3,
                    n_parameters,
                );
                self.stores(v, op, 2);
            } else {
                let source = self.source(x);
                let operands = [self.register(x), self.register(v), place, length];
                let op = self.with_parameters(
                    prepared_handler(prepared, source),
                    &operands,
                    2,
                    n_parameters,
                );
                self.meanings[op] = Meaning::Prepared {
                    function: prepared,
                    slope: false,
                    added: None,
                };
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
            let op =
                self.with_parameters(contact_handler(prepared, true), &operands, 5, n_parameters);
            for (v, operand) in [value, slopes[0], slopes[1]].into_iter().zip(2..) {
                if let Some(v) = v {
                    self.stores(v, op, operand);
                }
            }
            self.last = slopes[1];
        } else {
            let operands = [
                self.register(x),
                to(self, value),
                to(self, slopes[0]),
                place,
                length,
            ];
            let op = self.with_parameters(slope_handler(prepared), &operands, 3, n_parameters);
            self.meanings[op] = Meaning::Prepared {
                function: prepared,
                slope: true,
                added: None,
            };
            for (v, operand) in [value, slopes[0]].into_iter().zip(1..) {
                if let Some(v) = v {
                    self.stores(v, op, operand);
                }
            }
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
    pub(super) fn instruction(&mut self, v: Value) {
        let instruction = self.schedule.instructions[v.index()];
        let [low, high] = halves(Arc::as_ptr(self.core));
        self.emit(
            handlers::instruction,
            &[instruction, low, high],
            Kind::Instruction,
        );
    }
}

pub(super) fn prepared_handler(prepared: Prepared, source: u8) -> Handler {
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
