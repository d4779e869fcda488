//! Functions with constant parameters written out in straight code, for loops over columns: these
//! keep values in registers where a function would go through memory.
//!
//! The formulas are those of the steps; the ends of a step are selected, as there is no jump.

use super::super::super::code::{Code, Core, Instruction, Shape, Sides};
use super::super::super::operation::Comparison;
use super::formula::{Formula, Number, Operation};
use crate::expr::functions::prepared::Prepared;
use crate::expr::program::hashing::HashMap;
use std::sync::Arc;

/// Returns the code with short functions of constant parameters written out; `None` where there
/// are none.
pub(in crate::expr::program) fn written_out(core: &Core) -> Option<Core> {
    let written: Vec<Option<Written>> = (core.code.iter())
        .map(|instruction| Written::of(core, instruction))
        .collect();
    if written.iter().all(Option::is_none) {
        return None;
    }
    let mut writing = Writing::new(core, written.iter().flatten());
    let mut lists = core.lists.clone();
    lists.iter_mut().for_each(|r| *r = writing.register(*r));
    for (instruction, written) in core.code.iter().zip(&written) {
        match written {
            Some(written) => writing.write(written, writing.register(instruction.to)),
            None => writing.copy(instruction),
        }
    }
    let shape = Shape {
        n_inputs: core.n_inputs,
        used: core.used.clone(),
        lists,
        // whoever jumps has functions written out as steps
        sides: Sides::default(),
        size: writing.first_between + writing.n_between,
        outputs: (core.outputs.iter())
            .map(|&r| writing.register(r))
            .collect(),
        code: writing.code,
    };
    Some(Core {
        constants: writing.constants,
        tables: core.tables.clone(),
        shape: Arc::new(shape),
    })
}

/// A function of one variable that is written out.
struct Written {
    variable: u32,
    operations: Vec<Operation>,
    result: Number,
    /// before and behind which it is constant: there, and the number that it is
    ends: Option<[[f64; 2]; 2]>,
}

impl Written {
    fn of(core: &Core, instruction: &Instruction) -> Option<Self> {
        let (function, list) = core.call(instruction)?;
        let known: Vec<Option<f64>> = list
            .iter()
            .map(|&r| core.constants.get(r as usize).copied())
            .collect();
        let (prepared, parameters) = Prepared::of(function, &known)?;
        let is_slope = match instruction.code {
            Code::Partial(_, _, 0) => true,
            Code::Partial(..) => return None,
            _ => false,
        };
        let formula = Formula::of(prepared, &parameters, is_slope)?;
        let result = match is_slope {
            true => formula.slope,
            false => formula.value,
        };
        // nothing copies a number from register to register
        let Number::Result(last) = result else {
            return None;
        };
        let ends = formula.ends.map(|[x0, x1, h0, h1]| match is_slope {
            true => [[x0, 0.0], [x1, 0.0]],
            false => [[x0, h0], [x1, h1]],
        });
        Some(Self {
            variable: list[0],
            operations: formula.operations[..=last].to_vec(),
            result,
            ends,
        })
    }

    /// Returns which operations the result is made of.
    fn needed(&self) -> Vec<bool> {
        let mut needed = vec![false; self.operations.len()];
        let need = |number: Number, needed: &mut [bool]| {
            if let Number::Result(k) = number {
                needed[k] = true;
            }
        };
        need(self.result, &mut needed);
        for (k, operation) in self.operations.iter().enumerate().rev() {
            if needed[k] {
                operation.operands().for_each(|n| need(n, &mut needed));
            }
        }
        needed
    }

    /// Returns the numbers that it asks for.
    fn constants(&self) -> impl Iterator<Item = f64> {
        let operands = self.operations.iter().flat_map(Operation::operands);
        let own = operands.filter_map(|number| match number {
            Number::Constant(c) => Some(c),
            Number::Variable | Number::Result(_) => None,
        });
        own.chain(self.ends.into_iter().flatten().flatten())
    }
}

/// Code in the making.
struct Writing {
    constants: Vec<f64>,
    /// registers of constants by their bits
    of_constants: HashMap<u64, u32>,
    n_constants_before: u32,
    /// the first register for what lies between the operations of one function
    first_between: u32,
    n_between: u32,
    code: Vec<Instruction>,
}

impl Writing {
    fn new<'a>(core: &Core, written: impl Iterator<Item = &'a Written>) -> Self {
        let mut constants = core.constants.clone();
        let numbered = core.constants.iter().zip(0u32..);
        let mut of_constants: HashMap<u64, u32> = numbered.map(|(c, r)| (c.to_bits(), r)).collect();
        let mut n_between = 0;
        for function in written {
            for c in function.constants() {
                of_constants.entry(c.to_bits()).or_insert_with(|| {
                    constants.push(c);
                    constants.len() as u32 - 1
                });
            }
            // one for each operation, one for the nearer end
            n_between = n_between.max(function.operations.len() as u32 + 1);
        }
        let n_constants_before = core.constants.len() as u32;
        Self {
            first_between: core.size + constants.len() as u32 - n_constants_before,
            constants,
            of_constants,
            n_constants_before,
            n_between,
            code: Vec::with_capacity(core.code.len()),
        }
    }

    /// Returns what has become of a register: there are more constants.
    fn register(&self, r: u32) -> u32 {
        match r < self.n_constants_before {
            true => r,
            false => r + self.constants.len() as u32 - self.n_constants_before,
        }
    }

    fn copy(&mut self, instruction: &Instruction) {
        let [to, b, c, d] =
            [instruction.to, instruction.b, instruction.c, instruction.d].map(|r| self.register(r));
        let a = match instruction.code {
            // a place in the lists
            Code::Call(..) | Code::Partial(..) => instruction.a,
            _ => self.register(instruction.a),
        };
        let code = instruction.code;
        self.code.push(Instruction {
            code,
            to,
            a,
            b,
            c,
            d,
        });
    }

    fn write(&mut self, function: &Written, to: u32) {
        let x = self.register(function.variable);
        let last = function.operations.len() - 1;
        let needed = function.needed();
        for (k, operation) in function.operations.iter().enumerate() {
            if needed[k] {
                let to = match function.ends {
                    None if k == last => to,
                    _ => self.first_between + k as u32,
                };
                let (code, [a, b]) = match *operation {
                    Operation::Unary(op, a) => (Code::Unary(op), [a, a]),
                    Operation::Binary(op, a, b) => (Code::Binary(op), [a, b]),
                };
                let [a, b] = [a, b].map(|number| self.number(number, x));
                self.push(code, to, [a, b, 0, 0]);
            }
        }
        if let Some([[x0, h0], [x1, h1]]) = function.ends {
            let [x0, h0, x1, h1] = [x0, h0, x1, h1].map(|c| self.number(Number::Constant(c), x));
            let rising = self.number(function.result, x);
            let near = self.first_between + last as u32 + 1;
            // x ≤ x0, else x1 ≤ x, else between
            let code = Code::CompareSelect(Comparison::Le);
            self.push(code, near, [x1, x, h1, rising]);
            self.push(code, to, [x, x0, h0, near]);
        }
    }

    fn push(&mut self, code: Code, to: u32, [a, b, c, d]: [u32; 4]) {
        self.code.push(Instruction {
            code,
            to,
            a,
            b,
            c,
            d,
        });
    }

    /// Returns the register of a number of a formula of `x`.
    fn number(&self, number: Number, x: u32) -> u32 {
        match number {
            Number::Variable => x,
            Number::Constant(c) => self.of_constants[&c.to_bits()],
            Number::Result(k) => self.first_between + k as u32,
        }
    }
}
