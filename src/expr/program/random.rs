//! Random numbers and recordings for tests: the same ones on every run.

#[cfg(feature = "solver")]
use super::{BinaryOp, Builder, Comparison, Folding, Input, UnaryOp, Value};
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

/// Records so many operations on six inputs, with values wherever these have: the inputs come first
/// among the values, the last operations last.
#[cfg(feature = "solver")]
pub(super) fn recorded(seed: u64, n: usize) -> (Builder, Vec<Value>) {
    let mut random = Random(seed);
    let mut b = Builder::new(Folding::Structural);
    let mut values: Vec<Value> = (0..6).map(|k| b.input(Input::Slot(k))).collect();
    let [low, high] = [0.3, 0.9].map(|c| b.constant(c));
    values.push(low);
    for _ in 0..n {
        let [x, y, z, w] = [(); 4].map(|()| values[random.below(values.len())]);
        let value = match random.below(12) {
            0 => b.unary(UnaryOp::Sin, x),
            1 => b.unary(UnaryOp::Atan, x),
            2 => b.binary(BinaryOp::Sub, x, y),
            3 => b.binary(BinaryOp::Div, x, y),
            4 => {
                let condition = b.compare(Comparison::Lt, x, y);
                b.select(condition, z, w)
            }
            5 => b.call(Function::Step, &[x, y, z, w, values[0]]),
            6 => b.binary(BinaryOp::Atan2, x, y),
            7 => b.binary(BinaryOp::Mul, x, y),
            8 => b.unary(UnaryOp::Neg, x),
            9 => b.binary(BinaryOp::Add, x, y),
            10 => {
                let square = b.binary(BinaryOp::Mul, x, x);
                let positive = b.binary(BinaryOp::Add, square, low);
                b.unary(UnaryOp::Sqrt, positive)
            }
            _ => b.partial_of(Function::Step, &[x, low, y, high, z], 0),
        };
        values.push(value);
    }
    (b, values)
}
