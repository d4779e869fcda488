//! Programs as text, one operation per line, for people who want to see what is computed.

use super::{Code, Input, Program};
use std::fmt;

impl fmt::Display for Program {
    /// `r5 = sin r2` and so on; constants and inputs stand for themselves.
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
        for (k, &r) in self.outputs.iter().enumerate() {
            writeln!(f, "output {k} = {}", name(r))?;
        }
        Ok(())
    }
}

impl Program {
    fn names(&self, first: u32, count: u32) -> String {
        let list = &self.core().lists[first as usize..(first + count) as usize];
        list.iter()
            .map(|&r| self.name(r))
            .collect::<Vec<_>>()
            .join(", ")
    }

    /// A register as a reader would call it.
    fn name(&self, register: u32) -> String {
        let constants = &self.core().constants;
        let register = register as usize;
        if let Some(c) = constants.get(register) {
            return format!("{c}");
        }
        match self
            .used
            .get(register - constants.len())
            .map(|&k| &self.inputs[k as usize])
        {
            Some(Input::Slot(k)) => format!("slot{k}"),
            Some(input) => format!("{input}"),
            None => format!("r{}", register - constants.len() - self.used.len()),
        }
    }
}
