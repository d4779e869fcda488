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

mod batch;
mod breaks;
mod builder;
mod dependence;
mod display;
mod expand;
mod gradient;
mod guard;
mod machine;
mod operation;
mod order;
mod record;
mod schedule;
mod switching;
#[cfg(test)]
mod tests;
#[cfg(feature = "solver")]
mod timed;

pub use batch::Batch;
pub(crate) use breaks::{Break, Levels};
pub use builder::{Builder, Folding};
pub use operation::{BinaryOp, Comparison, UnaryOp, Value};
pub use record::{Condition, Sym};

use super::functions::Function;
use super::measures::Measure;
use crate::scalar::{Scalar, Table};
use operation::{arithmetic_if, from_mask, partial, truth};
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
    /// a·b = cⁿ √c, whose derivative at c = 0 is not the sum of those of its factors
    HalfPower(i32),
    Compare(Comparison),
    /// a: condition, b: where it holds, c: where not
    Select,
    /// a, b: what is compared, c: where it holds, d: where not
    CompareSelect(Comparison),
    /// a: selector, b: negative, c: zero, d: positive
    If,
    /// a: where
    Lookup {
        table: u32,
        order: u32,
    },
    /// a: position of the arguments in `lists`
    Call(Function, u32),
    /// a: position of the arguments in `lists`; derivative with respect to the last
    Partial(Function, u32, u32),
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
///
/// Copies share the code.
#[derive(Clone, Debug)]
pub struct Program {
    /// tells whose registers a [`Work`] holds
    id: u64,
    /// what the host supplies, in this order
    inputs: Vec<Input>,
    /// positions among `inputs` of those that are read, one register each
    used: Vec<u32>,
    /// registers
    outputs: Vec<u32>,
    core: Arc<Core>,
    machine: machine::Machine,
}

/// The operations and what they need; the registers are `constants | inputs | temporaries`.
#[derive(Debug)]
struct Core {
    constants: Vec<f64>,
    code: Vec<Instruction>,
    /// argument registers of calls
    lists: Vec<u32>,
    tables: Vec<Arc<dyn Table>>,
    /// number of registers
    size: u32,
}

/// The registers of a program while it runs. Any program may use any work; changing between them costs a preparation.
#[derive(Clone, Debug)]
pub struct Work<S = f64> {
    owner: u64,
    registers: Vec<S>,
}

/// Added to the owner of registers that are laid out for the machine, which needs more of them.
const FOR_THE_MACHINE: u64 = 1;

impl<S> Default for Work<S> {
    fn default() -> Self {
        Self {
            owner: 0,
            registers: Vec::new(),
        }
    }
}

impl Program {
    fn new(
        inputs: Vec<Input>,
        used: Vec<u32>,
        outputs: Vec<u32>,
        core: Arc<Core>,
        machine: machine::Machine,
    ) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(2);
        let id = NEXT.fetch_add(2, Ordering::Relaxed);
        Self {
            id,
            inputs,
            used,
            outputs,
            core,
            machine,
        }
    }

    fn core(&self) -> &Core {
        &self.core
    }

    /// The same program as threaded code, where it would run as code of the processor.
    #[cfg(test)]
    fn threaded(&self) -> Self {
        let mut program = self.clone();
        program.machine.do_without_translation();
        program
    }

    /// What the host supplies, in this order.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }
    /// Whether the input at a position among them is read at all.
    pub fn reads(&self, position: usize) -> bool {
        self.used.iter().any(|&k| k as usize == position)
    }
    /// How many numbers come out.
    pub fn n_outputs(&self) -> usize {
        self.outputs.len()
    }
    /// How many operations it takes.
    pub fn n_operations(&self) -> usize {
        self.core().code.len()
    }
    /// How many steps the machine takes for them, at most.
    pub fn n_steps(&self) -> usize {
        self.machine.len()
    }
    /// How many registers it takes.
    pub fn work_size(&self) -> usize {
        self.core().size as usize
    }
    /// The numbers that come out, if they depend on no input.
    pub fn constant_outputs(&self) -> Option<Vec<f64>> {
        self.outputs
            .iter()
            .map(|&r| self.core().constants.get(r as usize).copied())
            .collect()
    }

    /// Records this program into a builder: the values of its outputs there.
    pub fn record(&self, builder: &mut Builder) -> Vec<Value> {
        let core = self.core();
        let mut values: Vec<Value> = core
            .constants
            .iter()
            .map(|&c| builder.constant(c))
            .collect();
        values.extend(
            self.used
                .iter()
                .map(|&k| builder.input(self.inputs[k as usize])),
        );
        let none = values
            .first()
            .copied()
            .unwrap_or_else(|| builder.constant(f64::NAN));
        values.resize(core.size as usize, none);
        let mut arguments = Vec::new();
        for instruction in &core.code {
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
            if let Code::Call(_, count) | Code::Partial(_, count, _) = code {
                arguments.extend(
                    core.lists[a as usize..(a + count) as usize]
                        .iter()
                        .map(|&k| r(k)),
                );
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
                    builder.lookup(&core.tables[table as usize], order, r(a))
                }
                Code::Call(function, _) => builder.call(function, &arguments),
                Code::Partial(function, _, k) => builder.partial_of(function, &arguments, k),
            };
        }
        self.outputs.iter().map(|&r| values[r as usize]).collect()
    }

    /// The same outputs, then for each of them its partial derivatives with respect to `inputs`, in that order.
    ///
    /// One reverse sweep per output is appended at once; it costs about as much as the value. The layout of the inputs stays.
    pub fn with_gradient(&self, inputs: &[Input]) -> Program {
        let mut builder = Builder::new(Folding::Strict);
        let layout = &self.inputs;
        let mut outputs = self.record(&mut builder);
        let variables: Vec<Value> = inputs.iter().map(|&i| builder.input(i)).collect();
        for k in 0..outputs.len() {
            let gradient = builder.gradient(outputs[k], &variables);
            outputs.extend(gradient);
        }
        builder.finish_with_inputs(&outputs, layout)
    }

    /// Runs over plain numbers. Allocates nothing once `work` has been used with this program.
    ///
    /// # Panics
    ///
    /// When there are fewer inputs or more places for outputs than the program has.
    #[inline]
    pub fn run(&self, inputs: &[f64], work: &mut Work, out: &mut [f64]) {
        assert!(
            out.len() <= self.outputs.len(),
            "the program has {} outputs",
            self.outputs.len()
        );
        self.start(inputs, work);
        for (out, &r) in out.iter_mut().zip(&self.outputs) {
            *out = work.registers[r as usize];
        }
    }

    /// The first output, over plain numbers: as [`Program::run`], a little faster for a single number.
    ///
    /// # Panics
    ///
    /// When there are fewer inputs than the program has, or no output.
    #[inline]
    pub fn value(&self, inputs: &[f64], work: &mut Work) -> f64 {
        self.enter_machine(inputs, work);
        if self.machine.yields_the_value_at_once() {
            // SAFETY: `enter_machine` has seen to there being enough inputs, and to the registers being those of this program
            unsafe {
                self.machine
                    .value(work.registers.as_mut_ptr(), inputs.as_ptr())
            }
        } else {
            self.first_of_several(inputs, work)
        }
    }

    /// The first output of a program with several, or of a long one.
    #[inline(never)]
    fn first_of_several(&self, inputs: &[f64], work: &mut Work) -> f64 {
        self.start(inputs, work);
        work.registers[self.outputs[0] as usize]
    }

    /// Runs the machine.
    #[inline(always)]
    fn start(&self, inputs: &[f64], work: &mut Work) {
        self.enter_machine(inputs, work);
        // SAFETY: `enter_machine` has seen to there being enough inputs, and to the registers being those of this program
        unsafe {
            self.machine
                .run(work.registers.as_mut_ptr(), inputs.as_ptr())
        }
    }

    /// Runs over any number.
    ///
    /// # Panics
    ///
    /// When there are fewer inputs or more places for outputs than the program has.
    pub fn eval<S: Scalar>(&self, inputs: &[S], work: &mut Work<S>, out: &mut [S]) {
        assert!(
            out.len() <= self.outputs.len(),
            "the program has {} outputs",
            self.outputs.len()
        );
        self.enter(inputs, work);
        let core = self.core();
        let registers = &mut work.registers[..];
        for (register, &k) in registers[core.constants.len()..].iter_mut().zip(&self.used) {
            *register = inputs[k as usize];
        }
        for instruction in &core.code {
            core.step(instruction, registers);
        }
        for (out, &r) in out.iter_mut().zip(&self.outputs) {
            *out = registers[r as usize];
        }
    }

    /// Checks the inputs, and lays out the registers unless they are those of this program.
    #[inline(always)]
    fn enter<S: Scalar>(&self, inputs: &[S], work: &mut Work<S>) {
        if inputs.len() < self.inputs.len() {
            self.lacks_inputs(inputs.len());
        }
        if work.owner != self.id {
            self.prepare(work);
        }
    }

    /// As [`Program::enter`], for the machine.
    #[inline(always)]
    fn enter_machine(&self, inputs: &[f64], work: &mut Work) {
        if inputs.len() < self.inputs.len() {
            self.lacks_inputs(inputs.len());
        }
        if work.owner != self.id + FOR_THE_MACHINE {
            self.prepare_machine(work);
        }
    }

    #[cold]
    #[inline(never)]
    fn lacks_inputs(&self, n: usize) {
        panic!("the program reads {} inputs, not {n}", self.inputs.len());
    }

    /// Lays out the registers for this program.
    #[cold]
    fn prepare<S: Scalar>(&self, work: &mut Work<S>) {
        let core = self.core();
        // whatever happens here, these registers belong to nobody until they are complete
        work.owner = 0;
        work.registers.clear();
        work.registers
            .extend(core.constants.iter().map(|&c| S::constant(c)));
        work.registers
            .resize(core.size as usize, S::constant(f64::NAN));
        work.registers.extend(self.machine.tail().map(S::constant));
        assert!(work.registers.len() >= self.machine.n_registers());
        work.owner = self.id;
    }

    /// Lays out the registers, and has the machine made ready.
    #[cold]
    fn prepare_machine(&self, work: &mut Work) {
        self.prepare(work);
        work.owner = 0;
        let n = work.registers.len() + self.machine.prepare();
        work.registers.resize(n, f64::NAN);
        work.owner = self.id + FOR_THE_MACHINE;
    }
}

impl Core {
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
            Code::HalfPower(n) => r(c).powf(S::constant(f64::from(n) + 0.5)),
            Code::Compare(op) => from_mask(op.apply(r(a), r(b))),
            Code::Select => S::select(truth(r(a)), r(b), r(c)),
            Code::CompareSelect(op) => S::select(op.apply(r(a), r(b)), r(c), r(d)),
            Code::If => arithmetic_if(r(a), r(b), r(c), r(d)),
            Code::Lookup { table, order } => r(a).lookup(&self.tables[table as usize], order),
            Code::Call(function, count) => {
                let arguments = &self.lists[a as usize..(a + count) as usize];
                gathered(arguments, r, |args| function.eval(args))
            }
            Code::Partial(function, count, k) => {
                let arguments = &self.lists[a as usize..(a + count) as usize];
                gathered(arguments, r, |args| partial(function, args, k as usize))
            }
        };
    }
}

/// A function of arguments that are gathered from the registers.
#[inline(always)]
fn gathered<S: Scalar>(
    arguments: &[u32],
    register: impl Fn(u32) -> S,
    function: impl FnOnce(&[S]) -> S,
) -> S {
    #[inline(always)]
    fn few<S: Scalar, const N: usize>(
        arguments: &[u32],
        register: impl Fn(u32) -> S,
        function: impl FnOnce(&[S]) -> S,
    ) -> S {
        let mut numbers = [S::zero(); N];
        for (number, &k) in numbers.iter_mut().zip(arguments) {
            *number = register(k);
        }
        function(&numbers[..arguments.len().min(N)])
    }
    match arguments.len() {
        0..=8 => few::<S, 8>(arguments, register, function),
        9..=40 => few::<S, 40>(arguments, register, function),
        _ => function(&arguments.iter().map(|&k| register(k)).collect::<Vec<S>>()),
    }
}
