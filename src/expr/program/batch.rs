//! Many points at once: every instruction runs over a block of points before the next one starts.
//!
//! A register is a block of 128 numbers; the working set of an expression stays in the innermost
//! cache, and the inner loops are what compilers turn into vector instructions. Where instructions
//! that the processor has follow each other, and it is one that we know, they are translated into
//! a loop of their own that keeps values in registers. The same code is compiled for several sets
//! of vector instructions; which one runs is decided when the batch is made. The result of each
//! point is that of [`Program::run`], to the bit.

use super::code::{Code, Core, Instruction, gathered};
use super::expand::Expand;
use super::machine::{Columns, written_out};
use super::operation::{BinaryOp, Comparison, UnaryOp, from_mask};
use super::run::Program;
use crate::diagnostic::{Cause, Diagnostic, Error, counted};
use crate::expr::functions::Function;
use crate::expr::functions::prepared::{self, Prepared};
use crate::expr::functions::step::{cubic, haversine, quintic};
use crate::scalar::{Lanes, Scalar};
use std::sync::Arc;

/// Numbers that one vector operation works on.
const WIDTH: usize = 8;
/// Vectors per block.
const VECTORS: usize = 16;
/// Points per block.
pub(super) const BLOCK: usize = WIDTH * VECTORS;

type Vector = Lanes<WIDTH>;

/// One register for some points. Aligned, so that no vector lies across two lines of the cache.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Block([Vector; VECTORS]);

/// A program that runs over columns of points.
///
/// ```
/// use cognate::expr::program::{BinaryOp, Builder, Folding, Input};
/// let mut builder = Builder::new(Folding::Strict);
/// let (x, y) = (builder.input(Input::Slot(0)), builder.input(Input::Slot(1)));
/// let product = builder.binary(BinaryOp::Mul, x, y);
/// let mut batch = builder.finish(&[product]).batch();
/// let mut out = [0.0; 3];
/// batch.run(&[&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0]], &mut [&mut out])?;
/// assert_eq!(out, [4.0, 10.0, 18.0]);
/// # Ok::<(), cognate::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Batch {
    program: Program,
    /// its code, with short functions written out where loops take them, and partial derivatives
    /// of all others as operations
    core: Arc<Core>,
    /// all of the program as one loop over the columns themselves
    whole: Option<Arc<Columns>>,
    /// what the loops need beside the columns
    frame: Vec<f64>,
    registers: Vec<Block>,
    steps: Vec<Step>,
    instructions: Instructions,
}

/// The vector instructions of this machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Instructions {
    Portable,
    #[cfg(all(feature = "native", target_arch = "x86_64"))]
    Avx2,
    #[cfg(all(feature = "native", target_arch = "x86_64"))]
    Avx512,
}

/// An instruction, prepared where its parameters are constant.
#[derive(Clone, Debug)]
enum Step {
    Plain(Instruction),
    /// plain arithmetic that follows each other, as a loop of its own
    Columns(Arc<Columns>),
    /// (a p b) q c, where nobody else needs the inner result
    Two(Arithmetic, Arithmetic, [u32; 4]),
    Prepared {
        what: Prepared,
        parameters: Vec<f64>,
        a: u32,
        b: u32,
        to: u32,
    },
}

/// Arithmetic that fuses; `Bus` is the difference the other way round.
#[derive(Clone, Copy, Debug)]
enum Arithmetic {
    Add,
    Sub,
    Bus,
    Mul,
}

impl Step {
    /// Returns this step and the next as one, where the next takes the result of this and puts its
    /// own in the same register.
    fn followed_by(&self, next: &Step) -> Option<Step> {
        let (Step::Plain(this), Step::Plain(next)) = (self, next) else {
            return None;
        };
        let (p, q) = (arithmetic(this.code)?, arithmetic(next.code)?);
        let (q, c) = match (next.a == this.to, next.b == this.to, q) {
            (true, false, q) => (q, next.b),
            (false, true, Arithmetic::Sub) => (Arithmetic::Bus, next.a),
            (false, true, q) => (q, next.a),
            _ => return None,
        };
        (next.to == this.to).then_some(Step::Two(p, q, [this.a, this.b, c, next.to]))
    }
}

fn arithmetic(code: Code) -> Option<Arithmetic> {
    match code {
        Code::Binary(BinaryOp::Add) => Some(Arithmetic::Add),
        Code::Binary(BinaryOp::Sub) => Some(Arithmetic::Sub),
        Code::Binary(BinaryOp::Mul) | Code::HalfPower(_) => Some(Arithmetic::Mul),
        _ => None,
    }
}

impl Program {
    /// Makes a batch, which runs over many points at once.
    pub fn batch(&self) -> Batch {
        let written = match Columns::are_to_be_had() {
            true => written_out(self.core()).map(Arc::new),
            false => None,
        };
        let core = written.unwrap_or_else(|| self.shared_core());
        let core = match core.expanded(Expand::Partials) {
            Some(expanded) => Arc::new(expanded),
            None => core,
        };
        let nothing = Block([Vector::constant(f64::NAN); VECTORS]);
        let mut registers = vec![nothing; core.size as usize];
        for (register, &c) in registers.iter_mut().zip(&core.constants) {
            *register = Block([Vector::constant(c); VECTORS]);
        }
        let whole = match core.code.iter().all(Columns::can) {
            true => Columns::of(&core, &core.code, &core.outputs).map(Arc::new),
            false => None,
        };
        let steps = match whole {
            Some(_) => fused(core.code.iter().map(|i| Step::Plain(*i)).collect()),
            None => batch_steps(&core),
        };
        Batch {
            program: self.clone(),
            whole,
            frame: Columns::frame(&core),
            core,
            registers,
            steps,
            instructions: Instructions::of_this_machine(),
        }
    }
}

/// Returns the steps, where plain arithmetic that follows each other is a loop of its own.
fn batch_steps(core: &Core) -> Vec<Step> {
    let pieces: Vec<&[Instruction]> = core
        .code
        .chunk_by(|a, b| Columns::can(a) && Columns::can(b))
        .flat_map(|piece| piece.chunks(MOST_IN_LOOP))
        .collect();
    // from the end, where it is known which registers are read behind a piece
    let mut is_needed = vec![false; core.size as usize];
    core.outputs
        .iter()
        .for_each(|&r| is_needed[r as usize] = true);
    let mut loops: Vec<Option<Columns>> = Vec::with_capacity(pieces.len());
    for piece in pieces.iter().rev() {
        let mut wanted: Vec<u32> = piece.iter().map(|i| i.to).collect();
        wanted.sort_unstable();
        wanted.dedup();
        wanted.retain(|&r| is_needed[r as usize]);
        loops.push(match piece.len() {
            1 => None,
            _ => Columns::of(core, piece, &wanted),
        });
        for instruction in piece.iter().rev() {
            is_needed[instruction.to as usize] = false;
            core.operands(instruction, |r| is_needed[r as usize] = true);
        }
    }
    let mut steps = Vec::with_capacity(pieces.len());
    for (piece, columns) in pieces.iter().zip(loops.into_iter().rev()) {
        match columns {
            Some(columns) => steps.push(Step::Columns(Arc::new(columns))),
            None => steps.extend(fused(piece.iter().map(|i| batch_step(core, i)).collect())),
        }
    }
    steps
}

fn batch_step(core: &Core, instruction: &Instruction) -> Step {
    if let Code::Call(function, count) = instruction.code {
        let list = core.arguments(instruction.a, count);
        let known: Vec<Option<f64>> = list
            .iter()
            .map(|&r| core.constants.get(r as usize).copied())
            .collect();
        if let Some((what, parameters)) = Prepared::of(function, &known) {
            let b = if what.n_variables() == 2 {
                list[1]
            } else {
                list[0]
            };
            return Step::Prepared {
                what,
                parameters,
                a: list[0],
                b,
                to: instruction.to,
            };
        }
    }
    Step::Plain(*instruction)
}

/// Most instructions of a loop over blocks; with few of them it has few columns.
const MOST_IN_LOOP: usize = 200;

/// Returns the steps with pairs of arithmetic joined.
fn fused(steps: Vec<Step>) -> Vec<Step> {
    let mut joined: Vec<Step> = Vec::with_capacity(steps.len());
    for step in steps {
        match joined.last().and_then(|last| last.followed_by(&step)) {
            Some(both) => joined.splice(joined.len() - 1.., [both]).for_each(drop),
            None => joined.push(step),
        }
    }
    joined
}

impl Instructions {
    pub(super) fn of_this_machine() -> Self {
        #[cfg(all(feature = "native", target_arch = "x86_64"))]
        {
            if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl") {
                return Instructions::Avx512;
            }
            if is_x86_feature_detected!("avx2") {
                return Instructions::Avx2;
            }
        }
        Instructions::Portable
    }
}

impl Batch {
    /// Returns the program.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Runs over columns: one per input of the program, in its order, and one per output wanted.
    /// Allocates nothing. A point without a value is NaN or infinite.
    ///
    /// # Errors
    /// Fewer input columns or more output columns than the program has, or an input column that is
    /// shorter than the longest output column.
    pub fn run(&mut self, inputs: &[&[f64]], outputs: &mut [&mut [f64]]) -> Result<(), Error> {
        let n = outputs.iter().map(|out| out.len()).max().unwrap_or(0);
        self.program.check_counts(inputs.len(), outputs.len())?;
        let mut used = self.core.used.iter().map(|&k| k as usize);
        if let Some(k) = used.find(|&k| inputs[k].len() < n) {
            let (input, had) = (self.program.inputs()[k], inputs[k].len());
            let what = format!(
                "the column of {input} has {} for {}",
                counted(had, "value"),
                counted(n, "point")
            );
            return Err(Diagnostic::error(Cause::MissingValue, what).into());
        }
        if let Some(whole) = &self.whole
            && outputs.len() == self.core.outputs.len()
            && outputs.iter().all(|out| out.len() == n)
        {
            let core = &self.core;
            let column = |&r: &u32| inputs[core.used[r as usize - core.constants.len()] as usize];
            let read = whole.inputs().iter().map(column);
            whole.over_columns(&mut self.frame, read, outputs);
            return Ok(());
        }
        for start in (0..n).step_by(BLOCK) {
            self.enter(inputs, start, n);
            self.run_block();
            self.leave(outputs, start);
        }
        Ok(())
    }

    /// Copies the inputs of a block into their registers.
    fn enter(&mut self, inputs: &[&[f64]], start: usize, n: usize) {
        let first = self.core.constants.len();
        let end = n.min(start + BLOCK);
        for (register, &k) in self.registers[first..].iter_mut().zip(&self.core.used) {
            let column = &inputs[k as usize][start..end];
            let (vectors, rest) = column.as_chunks::<WIDTH>();
            for (to, from) in register.0.iter_mut().zip(vectors) {
                to.0 = *from;
            }
            if let (Some(to), false) = (register.0.get_mut(vectors.len()), rest.is_empty()) {
                to.0[..rest.len()].copy_from_slice(rest);
            }
        }
    }

    /// Copies the results of a block out.
    fn leave(&self, outputs: &mut [&mut [f64]], start: usize) {
        for (out, &r) in outputs.iter_mut().zip(&self.core.outputs) {
            let end = out.len().min(start + BLOCK);
            let Some(column) = out.get_mut(start..end) else {
                continue;
            };
            let register = &self.registers[r as usize];
            let (vectors, rest) = column.as_chunks_mut::<WIDTH>();
            let n = vectors.len();
            for (to, from) in vectors.iter_mut().zip(&register.0) {
                *to = from.0;
            }
            if let (Some(from), false) = (register.0.get(n), rest.is_empty()) {
                rest.copy_from_slice(&from.0[..rest.len()]);
            }
        }
    }

    /// Runs over the block in the registers, with the vector instructions of this machine.
    #[cfg(all(feature = "native", target_arch = "x86_64"))]
    #[allow(unsafe_code)]
    fn run_block(&mut self) {
        match self.instructions {
            Instructions::Portable => self.steps(),
            // SAFETY: the machine has these instructions, see `of_this_machine`
            Instructions::Avx2 => unsafe { self.steps_avx2() },
            // SAFETY: as before
            Instructions::Avx512 => unsafe { self.steps_avx512() },
        }
    }

    /// Runs over the block in the registers.
    #[cfg(not(all(feature = "native", target_arch = "x86_64")))]
    fn run_block(&mut self) {
        match self.instructions {
            Instructions::Portable => self.steps(),
        }
    }

    #[cfg(all(feature = "native", target_arch = "x86_64"))]
    #[target_feature(enable = "avx2")]
    fn steps_avx2(&mut self) {
        self.steps();
    }

    #[cfg(all(feature = "native", target_arch = "x86_64"))]
    #[target_feature(enable = "avx512f,avx512vl,avx512dq")]
    fn steps_avx512(&mut self) {
        self.steps();
    }

    /// Performs all instructions over the block in the registers.
    #[inline(always)]
    fn steps(&mut self) {
        let r = &mut self.registers[..];
        for step in &self.steps {
            match step {
                Step::Plain(instruction) => plain(&self.core, instruction, r),
                Step::Columns(columns) => columns.over_blocks(&mut self.frame, r),
                Step::Two(p, q, registers) => two(*p, *q, *registers, r),
                Step::Prepared {
                    what,
                    parameters,
                    a,
                    b,
                    to,
                } => prepared(*what, parameters, [*a, *b, *to], r),
            }
        }
    }
}

/// `to = f(a, …)` for all points of the block. A macro, because what it calls must be compiled for
/// the vector instructions of its surroundings.
macro_rules! each {
    ($r:ident, $to:ident = |$($x:ident = $register:ident),+| $value:expr) => {{
        let to = $to as usize;
        for k in 0..VECTORS {
            $(let $x = $r[$register as usize].0[k];)+
            $r[to].0[k] = $value;
        }
    }};
}

/// Sample by sample.
macro_rules! lanes {
    (|$k:ident| $value:expr) => {{
        let mut result = [0.0; WIDTH];
        for $k in 0..WIDTH {
            result[$k] = $value;
        }
        Lanes(result)
    }};
}

/// Computes (a p b) q c → to.
#[inline(always)]
fn two(p: Arithmetic, q: Arithmetic, [a, b, c, to]: [u32; 4], r: &mut [Block]) {
    use Arithmetic::{Add, Bus, Mul, Sub};
    macro_rules! inner {
        (|$inner:ident, $z:ident| $value:expr) => {
            match p {
                Add => each!(r, to = |x = a, y = b, $z = c| { let $inner = x + y; $value }),
                Sub | Bus => each!(r, to = |x = a, y = b, $z = c| { let $inner = x - y; $value }),
                Mul => each!(r, to = |x = a, y = b, $z = c| { let $inner = x * y; $value }),
            }
        };
    }
    match q {
        Add => inner!(|v, z| v + z),
        Sub => inner!(|v, z| v - z),
        Bus => inner!(|v, z| z - v),
        Mul => inner!(|v, z| v * z),
    }
}

#[inline(always)]
fn plain(core: &Core, instruction: &Instruction, r: &mut [Block]) {
    let Instruction {
        code,
        to,
        a,
        b,
        c,
        d,
    } = *instruction;
    match code {
        Code::Binary(BinaryOp::Add) => each!(r, to = |x = a, y = b| x + y),
        Code::Binary(BinaryOp::Sub) => each!(r, to = |x = a, y = b| x - y),
        Code::Binary(BinaryOp::Mul) | Code::HalfPower(_) => each!(r, to = |x = a, y = b| x * y),
        Code::Binary(BinaryOp::Div) => each!(r, to = |x = a, y = b| x / y),
        Code::Unary(UnaryOp::Neg) => each!(r, to = |x = a| -x),
        Code::Unary(UnaryOp::Abs) => each!(r, to = |x = a| Scalar::abs(x)),
        Code::Unary(UnaryOp::Sqrt) => each!(r, to = |x = a| Scalar::sqrt(x)),
        Code::Unary(UnaryOp::Sin) => each!(r, to = |x = a| Scalar::sin(x)),
        Code::Unary(UnaryOp::Cos) => each!(r, to = |x = a| Scalar::cos(x)),
        Code::CompareSelect(Comparison::Lt) => each!(r, to = |x = a, y = b, yes = c, no = d| {
            lanes!(|k| if x.0[k] < y.0[k] { yes.0[k] } else { no.0[k] })
        }),
        Code::CompareSelect(Comparison::Le) => each!(r, to = |x = a, y = b, yes = c, no = d| {
            lanes!(|k| if x.0[k] <= y.0[k] { yes.0[k] } else { no.0[k] })
        }),
        Code::CompareSelect(Comparison::Eq) => each!(r, to = |x = a, y = b, yes = c, no = d| {
            lanes!(|k| if x.0[k] == y.0[k] { yes.0[k] } else { no.0[k] })
        }),
        Code::Select => each!(r, to = |condition = a, yes = b, no = c| {
            lanes!(|k| if 0.0 < condition.0[k] { yes.0[k] } else { no.0[k] })
        }),
        Code::If => each!(r, to = |selector = a, negative = b, zero = c, positive = d| {
            lanes!(|k| {
                let other = if selector.0[k] == 0.0 { zero.0[k] } else { f64::NAN };
                let other = if selector.0[k] > 0.0 { positive.0[k] } else { other };
                if selector.0[k] < 0.0 { negative.0[k] } else { other }
            })
        }),
        Code::Whole(3) => each!(r, to = |x = a| x * (x * x)),
        Code::Whole(n) => each!(r, to = |x = a| x.powi(n)),
        Code::Call(function @ (Function::Max | Function::Min), 2) => {
            let (a, b) = (core.lists[a as usize], core.lists[a as usize + 1]);
            each!(r, to = |x = a, y = b| function.eval(&[x, y]));
        }
        Code::Unary(op) => each!(r, to = |x = a| op.apply(x)),
        Code::Binary(op) => each!(r, to = |x = a, y = b| op.apply(x, y)),
        Code::Compare(op) => each!(r, to = |x = a, y = b| from_mask(op.apply(x, y))),
        Code::Lookup { table, order } => {
            each!(r, to = |x = a| x.lookup(&core.tables[table as usize], order))
        }
        Code::Call(function, count) => {
            let arguments = core.arguments(a, count);
            for k in 0..VECTORS {
                let register = |x: u32| r[x as usize].0[k];
                r[to as usize].0[k] = gathered(arguments, register, |args| function.eval(args));
            }
        }
        Code::Partial(..) => unreachable!("a batch has partial derivatives expanded"),
    }
}

#[inline(always)]
fn prepared(what: Prepared, p: &[f64], [a, b, to]: [u32; 3], r: &mut [Block]) {
    match (what, p) {
        (Prepared::Step, &[x0, x1, h0, h1, l, h]) => {
            each!(r, to = |x = a| prepared::step_everywhere(x, &[x0, x1, h0, h1, l, h], cubic));
        }
        (Prepared::Step5, &[x0, x1, h0, h1, l, h]) => {
            each!(r, to = |x = a| prepared::step_everywhere(x, &[x0, x1, h0, h1, l, h], quintic));
        }
        (Prepared::Havsin, &[x0, x1, h0, h1, l, h]) => {
            each!(r, to = |x = a| prepared::step_everywhere(x, &[x0, x1, h0, h1, l, h], haversine));
        }
        (Prepared::Poly, _) => each!(r, to = |x = a| prepared::poly(x, p)),
        (Prepared::Cheby, _) => each!(r, to = |x = a| prepared::cheby(x, p)),
        (Prepared::Forcos, _) => each!(r, to = |x = a| prepared::forcos(x, p)),
        (Prepared::Forsin, _) => each!(r, to = |x = a| prepared::forsin(x, p)),
        (Prepared::Impact(e), &[x1, k, c, d, w, n]) => {
            each!(r, to = |x = a, v = b| prepared::impact(x, v, &[x1, k, c, d, w, n], e));
        }
        (Prepared::Bistop(e), &[x1, x2, k, c, d, w, n]) => {
            each!(r, to = |x = a, v = b| prepared::bistop(x, v, &[x1, x2, k, c, d, w, n], e));
        }
        _ => unreachable!("a prepared function comes with as many parameters as it says"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::program::{Builder, Folding, Input, Work};

    #[test]
    fn batches_of_any_length_are_single_runs() {
        let mut b = Builder::new(Folding::Strict);
        let (x, y) = (b.input(Input::Slot(0)), b.input(Input::Slot(1)));
        let constants = [0.2, 0.0, 0.9, 3.0, 1.5, 40.0, 0.3].map(|c| b.constant(c));
        let [x0, h0, x1, h1, e, k, d] = constants;
        let step = b.call(Function::Step, &[x, x0, h0, x1, h1]);
        let impact = b.call(Function::Impact, &[x, y, x1, k, e, h1, d]);
        let sine = b.unary(UnaryOp::Sin, y);
        let branch = b.arithmetic_if(y, step, impact, sine);
        let larger = b.call(Function::Max, &[branch, impact]);
        let harmonic = b.call(Function::Forsin, &[x, x0, k, h1, e, d]);
        let slope = b.gradient(impact, &[x])[0];
        let program = b.finish(&[branch, larger, harmonic, slope]);
        let mut batch = program.batch();
        for n in [0, 1, 7, 8, 127, 128, 129, 300] {
            let columns: Vec<Vec<f64>> = (0..2)
                .map(|c| {
                    (0..n)
                        .map(|k| ((k * 37 + c * 11) % 101) as f64 / 50.0 - 1.0)
                        .collect()
                })
                .collect();
            let mut out = vec![vec![0.0; n]; 4];
            let mut outputs: Vec<&mut [f64]> = out.iter_mut().map(|o| &mut o[..]).collect();
            (batch.run(&[&columns[0], &columns[1]], &mut outputs)).unwrap();
            let (mut work, mut single) = (Work::default(), [0.0; 4]);
            for k in 0..n {
                program.run(&[columns[0][k], columns[1][k]], &mut work, &mut single);
                for (column, want) in out.iter().zip(single) {
                    assert_eq!(column[k].to_bits(), want.to_bits(), "point {k} of {n}");
                }
            }
        }
    }

    #[test]
    fn functions_that_are_written_out_for_loops_are_single_runs() {
        let mut b = Builder::new(Folding::Strict);
        let (x, y) = (b.input(Input::Slot(0)), b.input(Input::Slot(1)));
        let parameters = [0.2, -0.3, 0.9, 3.0, 1.5].map(|c| b.constant(c));
        let [x0, h0, x1, h1, _] = parameters;
        // the same function twice, of one that is computed, and one whose rise is one
        let product = b.binary(BinaryOp::Mul, x, y);
        let one = b.constant(1.0);
        let mut outputs = Vec::new();
        for x in [x, product] {
            for (function, parameters) in [
                (Function::Step, vec![x0, h0, x1, h1]),
                (Function::Step5, vec![x0, h0, x1, h1]),
                (Function::Step, vec![h0, one, one, h1]),
                (Function::Havsin, vec![x0, h0, x1, h1]),
                (Function::Poly, parameters.to_vec()),
                (Function::Poly, parameters[..2].to_vec()),
                (Function::Cheby, parameters.to_vec()),
            ] {
                let call = b.call(function, &[vec![x], parameters].concat());
                outputs.push(call);
                outputs.extend(b.gradient(call, &[x]));
            }
        }
        // one by one, so that all of a program is a loop, and all together
        let mut programs: Vec<Program> = outputs.iter().map(|&v| b.finish(&[v])).collect();
        programs.push(b.finish(&outputs));
        let n = 131;
        let mut points: Vec<[f64; 2]> = (0..n)
            .map(|k| {
                [
                    f64::from(k * 37 % 101) / 50.0 - 1.0,
                    f64::from(k * 11 % 19) / 8.0 - 1.0,
                ]
            })
            .collect();
        points.extend([
            [0.2, 1.0],
            [0.9, 1.0],
            [-0.3, 1.0],
            [f64::NAN, 1.0],
            [f64::INFINITY, 1.0],
        ]);
        for program in programs {
            let columns: Vec<Vec<f64>> = (program.inputs().iter())
                .map(|input| {
                    let k = usize::from(*input == Input::Slot(1));
                    points.iter().map(|p| p[k]).collect()
                })
                .collect();
            let views: Vec<&[f64]> = columns.iter().map(|c| &c[..]).collect();
            let mut out = vec![vec![0.0; points.len()]; program.n_outputs()];
            let mut outputs: Vec<&mut [f64]> = out.iter_mut().map(|o| &mut o[..]).collect();
            program.batch().run(&views, &mut outputs).unwrap();
            let (mut work, mut single) = (Work::default(), vec![0.0; program.n_outputs()]);
            for k in 0..points.len() {
                let inputs: Vec<f64> = columns.iter().map(|c| c[k]).collect();
                program.run(&inputs, &mut work, &mut single);
                for (column, want) in out.iter().zip(&single) {
                    let is_same = column[k].to_bits() == want.to_bits();
                    let are_none = column[k].is_nan() && want.is_nan();
                    assert!(
                        is_same || are_none,
                        "{inputs:?}: {}, not {want}: {program}",
                        column[k]
                    );
                }
            }
        }
    }
}
