//! Straight-line code: constants, inputs, operations, outputs; the builder that records it and the machines that run it.
//!
//! Two makers share it: the compiler of expressions, and the scene, which records its own equations as they run over the
//! recording scalar [`Sym`].
//!
//! ```
//! use cognate::expr::program::{BinaryOp, Builder, Folding, Input, Work};
//! let mut builder = Builder::new(Folding::Strict);
//! let t = builder.input(Input::Time);
//! let square = builder.binary(BinaryOp::Mul, t, t);
//! let program = builder.finish(&[square]);
//! let mut out = [0.0];
//! program.run(&[3.0], &mut Work::default(), &mut out);
//! assert_eq!(out, [9.0]);
//! ```

mod builder;
mod operation;
mod record;
mod schedule;
#[cfg(test)]
mod tests;

pub use builder::{Builder, Folding};
pub use operation::{BinaryOp, Comparison, UnaryOp, Value};
pub use record::{Condition, Sym};

use super::functions::Function;
use super::measures::Measure;
use crate::scalar::{Scalar, Table};
use operation::{Node, arithmetic_if, from_mask, truth};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What a program asks of its host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Input {
    /// simulation time
    Time,
    /// code of the running analysis
    Mode,
    /// a function of the model; absent arguments are 0
    Measure(Measure, [u32; 4]),
    /// the `k`-th delayed value (DELAY), which needs history
    Delayed(u32),
    /// a number the host knows by position (used by recorded programs)
    Slot(u32),
}

/// What an instruction does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Code {
    Unary(UnaryOp),
    /// power with a whole exponent
    Whole(i32),
    Binary(BinaryOp),
    Compare(Comparison),
    /// a: condition, b: where it holds, c: where not
    Select,
    /// a: selector, b: negative, c: zero, d: positive
    If,
    /// a: where
    Lookup {
        table: u32,
        order: u32,
    },
    /// a: position of the arguments in `lists`
    Call(Function, u32),
}

impl Code {
    fn of(node: &Node) -> Code {
        match *node {
            Node::Unary(op, _) => Code::Unary(op),
            Node::Whole(_, n) => Code::Whole(n),
            Node::Binary(op, ..) => Code::Binary(op),
            Node::Compare(op, ..) => Code::Compare(op),
            Node::Select(..) => Code::Select,
            Node::If(_) => Code::If,
            Node::Lookup { table, order, .. } => Code::Lookup { table, order },
            Node::Call {
                function, count, ..
            } => Code::Call(function, count),
            Node::Constant(_) | Node::Input(_) => {
                unreachable!("constants and inputs are registers, not instructions")
            }
        }
    }
}

/// One operation: operands and result are registers.
#[derive(Clone, Copy, Debug)]
struct Instruction {
    code: Code,
    to: u32,
    a: u32,
    b: u32,
    c: u32,
    d: u32,
}

/// Straight-line code with several outputs. Made by [`Builder::finish`]; never changes.
#[derive(Clone, Debug)]
pub struct Program {
    /// tells whose registers a [`Work`] holds
    id: u64,
    constants: Vec<f64>,
    /// what the host supplies, in this order
    inputs: Vec<Input>,
    /// positions among `inputs` of those that are read, one register each
    used: Vec<u32>,
    code: Vec<Instruction>,
    /// argument registers of calls
    lists: Vec<u32>,
    tables: Vec<Arc<dyn Table>>,
    /// registers
    outputs: Vec<u32>,
    /// number of registers
    size: u32,
}

/// The registers of a program while it runs. Any program may use any work; changing between them costs a preparation.
#[derive(Clone, Debug)]
pub struct Work<S = f64> {
    owner: u64,
    registers: Vec<S>,
}

impl<S> Default for Work<S> {
    fn default() -> Self {
        Self {
            owner: 0,
            registers: Vec::new(),
        }
    }
}

impl Program {
    #[allow(clippy::too_many_arguments)]
    fn new(
        constants: Vec<f64>,
        inputs: Vec<Input>,
        used: Vec<u32>,
        code: Vec<Instruction>,
        lists: Vec<u32>,
        tables: Vec<Arc<dyn Table>>,
        outputs: Vec<u32>,
        size: u32,
    ) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        let id = NEXT.fetch_add(1, Ordering::Relaxed);
        Self {
            id,
            constants,
            inputs,
            used,
            code,
            lists,
            tables,
            outputs,
            size,
        }
    }

    /// What the host supplies, in this order.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }
    /// How many numbers come out.
    pub fn n_outputs(&self) -> usize {
        self.outputs.len()
    }
    /// How many operations it takes.
    pub fn n_operations(&self) -> usize {
        self.code.len()
    }
    /// How many registers it takes.
    pub fn work_size(&self) -> usize {
        self.size as usize
    }
    /// The numbers that come out, if they depend on no input.
    pub fn constant_outputs(&self) -> Option<Vec<f64>> {
        self.outputs
            .iter()
            .map(|&r| self.constants.get(r as usize).copied())
            .collect()
    }

    /// Runs over plain numbers. Allocates nothing once `work` has been used with this program.
    ///
    /// # Panics
    ///
    /// When there are fewer inputs or more places for outputs than the program has.
    pub fn run(&self, inputs: &[f64], work: &mut Work, out: &mut [f64]) {
        self.eval(inputs, work, out);
    }

    /// Runs over any number.
    ///
    /// # Panics
    ///
    /// When there are fewer inputs or more places for outputs than the program has.
    pub fn eval<S: Scalar>(&self, inputs: &[S], work: &mut Work<S>, out: &mut [S]) {
        assert!(
            inputs.len() >= self.inputs.len(),
            "the program reads {} inputs",
            self.inputs.len()
        );
        assert!(
            out.len() <= self.outputs.len(),
            "the program has {} outputs",
            self.outputs.len()
        );
        self.prepare(work);
        let registers = &mut work.registers[..];
        for (register, &k) in registers[self.constants.len()..].iter_mut().zip(&self.used) {
            *register = inputs[k as usize];
        }
        for instruction in &self.code {
            self.step(instruction, registers);
        }
        for (out, &r) in out.iter_mut().zip(&self.outputs) {
            *out = registers[r as usize];
        }
    }

    /// Lays the constants into the registers, unless they are there already.
    fn prepare<S: Scalar>(&self, work: &mut Work<S>) {
        if work.owner == self.id {
            return;
        }
        work.owner = self.id;
        work.registers.clear();
        work.registers
            .extend(self.constants.iter().map(|&c| S::constant(c)));
        work.registers
            .resize(self.size as usize, S::constant(f64::NAN));
    }

    #[inline(always)]
    fn step<S: Scalar>(&self, instruction: &Instruction, registers: &mut [S]) {
        let Instruction {
            code,
            to,
            a,
            b,
            c,
            d,
        } = *instruction;
        let r = |k: u32| registers[k as usize];
        registers[to as usize] = match code {
            Code::Unary(op) => op.apply(r(a)),
            Code::Whole(n) => r(a).powi(n),
            Code::Binary(op) => op.apply(r(a), r(b)),
            Code::Compare(op) => from_mask(op.apply(r(a), r(b))),
            Code::Select => S::select(truth(r(a)), r(b), r(c)),
            Code::If => arithmetic_if(r(a), r(b), r(c), r(d)),
            Code::Lookup { table, order } => r(a).lookup(&self.tables[table as usize], order),
            Code::Call(function, count) => {
                let arguments = &self.lists[a as usize..(a + count) as usize];
                call(function, arguments, registers)
            }
        };
    }
}

/// A function of the table, its arguments gathered from the registers.
fn call<S: Scalar>(function: Function, arguments: &[u32], registers: &[S]) -> S {
    fn gathered<S: Scalar, const N: usize>(
        function: Function,
        arguments: &[u32],
        registers: &[S],
    ) -> S {
        let mut numbers = [S::zero(); N];
        for (number, &k) in numbers.iter_mut().zip(arguments) {
            *number = registers[k as usize];
        }
        function.eval(&numbers[..arguments.len().min(N)])
    }
    match arguments.len() {
        0..=8 => gathered::<S, 8>(function, arguments, registers),
        9..=40 => gathered::<S, 40>(function, arguments, registers),
        _ => function.eval(
            &arguments
                .iter()
                .map(|&k| registers[k as usize])
                .collect::<Vec<S>>(),
        ),
    }
}
