//! Random numbers and recordings for tests: the same ones on every run.

#[cfg(feature = "solver")]
use super::{BinaryOp, Builder, Comparison, UnaryOp, Value};
#[cfg(feature = "solver")]
use crate::expr::functions::Function;

/// Random numbers by a linear congruence, from a seed.
pub(super) struct Random(pub u64);

impl Random {
    /// Returns the next one below `n`.
    pub(super) fn below(&mut self, n: usize) -> usize {
        self.0 = (self.0)
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % n
    }
}

/// Records so many operations on values that there are.
#[cfg(feature = "solver")]
pub(super) fn extend(b: &mut Builder, random: &mut Random, values: &mut Vec<Value>, n: usize) {
    for _ in 0..n {
        let [x, y, z, w] = [(); 4].map(|()| values[random.below(values.len())]);
        let value = match random.below(11) {
            0 => b.unary(UnaryOp::Sin, x),
            1 => b.unary(UnaryOp::Sqrt, x),
            2 => b.binary(BinaryOp::Sub, x, y),
            3 => b.binary(BinaryOp::Div, x, y),
            4 => {
                let condition = b.compare(Comparison::Lt, x, y);
                b.select(condition, z, w)
            }
            5 => b.call(Function::Step, &[x, y, z, w, values[0]]),
            6 => {
                let call = [x, y, z, w, values[0]];
                b.partial_of(Function::Step, &call, 0)
            }
            7 => b.binary(BinaryOp::Mul, x, y),
            8 => b.binary(BinaryOp::Atan2, x, y),
            9 => b.unary(UnaryOp::Neg, x),
            _ => b.binary(BinaryOp::Add, x, y),
        };
        values.push(value);
    }
}
