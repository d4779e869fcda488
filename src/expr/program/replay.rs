//! A finished program recorded into a builder again, alone or with its gradient.

use super::builder::{Builder, Folding};
use super::code::{Code, Core, Instruction};
use super::input::Input;
use super::node::Value;
use super::operation::BinaryOp;
use super::run::Program;

impl Program {
    /// Records this program into a builder; returns the values of its outputs there.
    pub fn record(&self, builder: &mut Builder) -> Vec<Value> {
        self.core().record(builder, self.inputs())
    }

    /// Returns the same outputs, then for each of them its partial derivatives with respect to
    /// `inputs`, in that order.
    ///
    /// One reverse sweep per output is appended at once; it costs about as much as the value. The
    /// layout of the inputs stays.
    pub fn with_gradient(&self, inputs: &[Input]) -> Program {
        let mut builder = Builder::new(Folding::Strict);
        let mut outputs = self.record(&mut builder);
        let variables: Vec<Value> = inputs.iter().map(|&i| builder.input(i)).collect();
        for k in 0..outputs.len() {
            let gradient = builder.gradient(outputs[k], &variables);
            outputs.extend(gradient);
        }
        builder.finish_with_inputs(&outputs, self.inputs())
    }
}

impl Core {
    /// Records this code into a builder, over inputs that stand for those of the host; returns the
    /// values of its outputs there.
    pub(super) fn record(&self, builder: &mut Builder, inputs: &[Input]) -> Vec<Value> {
        let mut values: Vec<Value> = self
            .constants
            .iter()
            .map(|&c| builder.constant(c))
            .collect();
        values.extend(self.used.iter().map(|&k| builder.input(inputs[k as usize])));
        let none = values
            .first()
            .copied()
            .unwrap_or_else(|| builder.constant(f64::NAN));
        values.resize(self.size as usize, none);
        let mut arguments = Vec::new();
        for instruction in &self.code {
            let Instruction {
                code,
                to,
                a,
                b,
                c,
                d,
            } = *instruction;
            let r = |k: u32| values[k as usize];
            arguments.clear();
            if let Some((_, list)) = self.call(instruction) {
                arguments.extend(list.iter().map(|&k| r(k)));
            }
            values[to as usize] = match code {
                Code::Unary(op) => builder.unary(op, r(a)),
                Code::Whole(n) => builder.powi(r(a), n),
                Code::Binary(op) => builder.binary(op, r(a), r(b)),
                Code::HalfPower(_) => builder.binary(BinaryOp::Mul, r(a), r(b)),
                Code::Compare(op) => builder.compare(op, r(a), r(b)),
                Code::Select => builder.select(r(a), r(b), r(c)),
                Code::CompareSelect(op) => {
                    let condition = builder.compare(op, r(a), r(b));
                    builder.select(condition, r(c), r(d))
                }
                Code::If => builder.arithmetic_if(r(a), r(b), r(c), r(d)),
                Code::Lookup { table, order } => {
                    builder.lookup(&self.tables[table as usize], order, r(a))
                }
                Code::Call(function, _) => builder.call(function, &arguments),
                Code::Partial(function, _, k) => builder.partial_of(function, &arguments, k),
            };
        }
        self.outputs.iter().map(|&r| values[r as usize]).collect()
    }
}
