//! The derivative of a program by one of its inputs, as a program.

use super::builder::{Builder, Folding};
use super::node::Value;
use super::record::Sym;
use super::run::{Program, Work};
use crate::scalar::{Dual, Scalar};
use std::cell::RefCell;

impl Program {
    /// Returns the program of the derivatives of all outputs by the input at a position; it reads
    /// the same inputs.
    pub(crate) fn rate(&self, position: usize) -> Program {
        let builder = RefCell::new(Builder::new(Folding::Finite));
        let mut inputs = Vec::with_capacity(self.inputs().len());
        for (k, &input) in self.inputs().iter().enumerate() {
            let eps = Sym::Constant(f64::from(u8::from(k == position)));
            let re = Sym::input(input, &builder);
            inputs.push(Dual { re, eps: [eps] });
        }
        let mut out: Vec<Dual<1, Sym<'_>>> = vec![Dual::constant(0.0); self.n_outputs()];
        self.eval(&inputs, &mut Work::default(), &mut out);
        let slope = |y: &Dual<1, Sym<'_>>| y.eps[0].value(&mut builder.borrow_mut());
        let slopes: Vec<Value> = out.iter().map(slope).collect();
        let recorder = builder.borrow();
        recorder.finish_with_inputs(&slopes, self.inputs())
    }
}
