//! Programs as text, one operation per line, for people who want to see what is computed.

use super::builder::Builder;
use super::code::Code;
use super::input::Input;
use super::node::{Node, Value};
use super::operation::{BinaryOp, Comparison, UnaryOp};
use super::run::Program;
use std::fmt;

impl fmt::Display for Program {
    /// Writes `r5 = Sin r2` and so on; constants and inputs stand for themselves.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let core = self.core();
        let name = |r: u32| self.name(r);
        for instruction in &core.code {
            let [a, b, c, d] = [instruction.a, instruction.b, instruction.c, instruction.d];
            write!(f, "{} = ", name(instruction.to))?;
            match instruction.code {
                Code::Unary(op) => write!(f, "{op:?} {}", name(a))?,
                Code::Whole(n) => write!(f, "{}**{n}", name(a))?,
                Code::Binary(op) => write!(f, "{op:?} {}, {}", name(a), name(b))?,
                Code::HalfPower(_) => write!(f, "Mul {}, {}", name(a), name(b))?,
                Code::Compare(op) => write!(f, "{op:?} {}, {}", name(a), name(b))?,
                Code::Select => write!(f, "{} ? {} : {}", name(a), name(b), name(c))?,
                Code::CompareSelect(op) => {
                    write!(
                        f,
                        "{op:?} {}, {} ? {} : {}",
                        name(a),
                        name(b),
                        name(c),
                        name(d)
                    )?;
                }
                Code::If => write!(f, "IF({}: {}, {}, {})", name(a), name(b), name(c), name(d))?,
                Code::Lookup { table, order } => {
                    write!(f, "table {table} order {order} at {}", name(a))?
                }
                Code::Call(function, count) => {
                    write!(f, "{}({})", function.name(), self.names(a, count))?;
                }
                Code::Partial(function, count, k) => {
                    write!(f, "∂{}/∂{k} ({})", function.name(), self.names(a, count))?;
                }
            }
            writeln!(f)?;
        }
        for (k, &r) in core.outputs.iter().enumerate() {
            writeln!(f, "output {k} = {}", name(r))?;
        }
        Ok(())
    }
}

impl Program {
    fn names(&self, first: u32, count: u32) -> String {
        let list = self.core().arguments(first, count);
        list.iter()
            .map(|&r| self.name(r))
            .collect::<Vec<_>>()
            .join(", ")
    }

    /// Returns a register as a reader would call it.
    fn name(&self, register: u32) -> String {
        let constants = &self.core().constants;
        let register = register as usize;
        if let Some(c) = constants.get(register) {
            return format!("{c}");
        }
        match self
            .core()
            .used
            .get(register - constants.len())
            .map(|&k| &self.inputs()[k as usize])
        {
            Some(Input::Slot(k)) => format!("slot{k}"),
            Some(input) => format!("{input}"),
            None => format!("r{}", register - constants.len() - self.core().used.len()),
        }
    }
}

/// Longest text of a value; what is deeper is left out.
const LONGEST: usize = 80;

impl Builder {
    /// Returns a value as a formula, shortened when it is long.
    pub(crate) fn text(&self, v: Value) -> String {
        let mut text = String::new();
        self.write(v, 0, &mut text);
        if text.chars().count() > LONGEST {
            text = text.chars().take(LONGEST).collect::<String>() + "…";
        }
        text
    }

    /// Writes a value; `above`: how strongly the surroundings bind (1 sum, 2 product, 3 power).
    fn write(&self, v: Value, above: u8, text: &mut String) {
        if text.len() > 2 * LONGEST {
            return;
        }
        let mut infix = |strength: u8, a: Value, sign: &str, b: Value| {
            let open = strength < above;
            text.push_str(if open { "(" } else { "" });
            self.write(a, strength, text);
            text.push_str(sign);
            self.write(b, strength + 1, text);
            text.push_str(if open { ")" } else { "" });
        };
        let node = self.nodes[v.index()];
        match node {
            Node::Constant(bits) => *text += &f64::from_bits(bits).to_string(),
            Node::Input(k) => *text += &self.inputs[k as usize].to_string(),
            Node::Binary(BinaryOp::Add, a, b) => infix(1, a, " + ", b),
            Node::Binary(BinaryOp::Sub, a, b) => infix(1, a, " - ", b),
            Node::Binary(BinaryOp::Mul, a, b) => infix(2, a, "*", b),
            Node::Binary(BinaryOp::Div, a, b) => infix(2, a, "/", b),
            Node::Binary(BinaryOp::Pow, a, b) => infix(3, a, "**", b),
            Node::Compare(comparison, a, b) => {
                let sign = match comparison {
                    Comparison::Lt => " < ",
                    Comparison::Le => " <= ",
                    Comparison::Eq => " = ",
                };
                infix(0, a, sign, b);
            }
            Node::Unary(UnaryOp::Neg, x) => {
                *text += "-";
                self.write(x, 3, text);
            }
            Node::Whole(x, n) => {
                self.write(x, 3, text);
                *text += &format!("**{n}");
            }
            _ => {
                *text += &match node {
                    Node::Unary(op, _) => format!("{op:?}").to_uppercase(),
                    Node::Binary(op, ..) => format!("{op:?}").to_uppercase(),
                    Node::Call { function, .. } => function.name().to_string(),
                    Node::Lookup { table, .. } => format!("table{table}"),
                    Node::Partial { k, .. } => format!("partial{k}"),
                    _ => "IF".to_string(),
                };
                let mut first = true;
                self.operands(&node, |x| {
                    *text += if std::mem::take(&mut first) {
                        "("
                    } else {
                        ", "
                    };
                    self.write(x, 0, text);
                });
                *text += ")";
            }
        }
    }
}
