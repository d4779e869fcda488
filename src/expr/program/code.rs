//! Straight code: the operations of a program in order, their operands and results in registers.
//!
//! It runs over any number: both sides of every selection are computed, then one is chosen. Which
//! instructions only one side needs is noted beside it ([`Sides`]), for the machine of plain
//! numbers, which jumps.

use super::operation::{BinaryOp, Comparison, UnaryOp, arithmetic_if, from_mask, truth};
use crate::expr::functions::Function;
use crate::scalar::{Dual, Exponent, Scalar, Table};
use std::ops::{Deref, Range};
use std::sync::Arc;

/// The operation of an instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Code {
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
pub(super) struct Instruction {
    pub(super) code: Code,
    pub(super) to: u32,
    pub(super) a: u32,
    pub(super) b: u32,
    pub(super) c: u32,
    pub(super) d: u32,
}

/// The operations of a program and what they need; the registers are `constants | inputs |
/// temporaries`.
#[derive(Debug)]
pub(super) struct Core {
    pub(super) constants: Vec<f64>,
    pub(super) tables: Vec<Arc<dyn Table>>,
    pub(super) shape: Arc<Shape>,
}

/// The operations of a program on its constants and inputs, whatever these are; programs that
/// differ in their constants alone share them.
#[derive(Debug, Default)]
pub(super) struct Shape {
    /// how many inputs the host supplies
    pub(super) n_inputs: usize,
    /// positions among the inputs of those that are read, one register each
    pub(super) used: Vec<u32>,
    pub(super) code: Vec<Instruction>,
    /// argument registers of calls
    pub(super) lists: Vec<u32>,
    pub(super) sides: Sides,
    /// number of registers
    pub(super) size: u32,
    /// registers of the outputs
    pub(super) outputs: Vec<u32>,
}

impl Deref for Core {
    type Target = Shape;

    fn deref(&self) -> &Shape {
        &self.shape
    }
}

/// Which instructions are needed only where a selection takes one of its sides, if skipping them is
/// worth a jump.
#[derive(Debug, Default)]
pub(super) struct Sides {
    /// in the order of the code, nested like parentheses
    pub(super) marks: Vec<Mark>,
    /// selections that share their sides, by the number in the marks: their places in `members`
    pub(super) groups: Vec<Range<usize>>,
    /// the instructions that select, all behind the last side of their group
    pub(super) members: Vec<u32>,
}

/// The beginning or the end of a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Mark {
    /// the instruction before which it stands
    pub(super) at: u32,
    pub(super) group: u32,
    /// selection: 0 yes, 1 no; IF: 0 negative, 1 zero, 2 positive
    pub(super) side: u8,
    pub(super) is_end: bool,
}

impl Instruction {
    /// Returns the register of the value that a selection takes on one of its sides.
    pub(super) fn chosen(&self, side: u8) -> u32 {
        let operands = [self.a, self.b, self.c, self.d];
        let first = match self.code {
            Code::CompareSelect(_) => 2,
            _ => 1,
        };
        operands[first + side as usize]
    }

    /// Returns how many sides a selection has; 0 for what is none.
    pub(super) fn n_sides(&self) -> u8 {
        match self.code {
            Code::Select | Code::CompareSelect(_) => 2,
            Code::If => 3,
            Code::Unary(_)
            | Code::Whole(_)
            | Code::Binary(_)
            | Code::HalfPower(_)
            | Code::Compare(_)
            | Code::Lookup { .. }
            | Code::Call(..)
            | Code::Partial(..) => 0,
        }
    }
}

impl Sides {
    /// Returns for each mark that begins a side the instruction before which that side ends.
    pub(super) fn ends(&self) -> Vec<u32> {
        let mut ends = vec![0; self.marks.len()];
        let mut open = Vec::new();
        for (k, mark) in self.marks.iter().enumerate() {
            if !mark.is_end {
                open.push(k);
            } else if let Some(begin) = open.pop() {
                ends[begin] = mark.at;
            }
        }
        ends
    }
}

impl Core {
    /// Returns function and argument registers of a call, or of a partial derivative of one.
    pub(super) fn call(&self, instruction: &Instruction) -> Option<(Function, &[u32])> {
        match instruction.code {
            Code::Call(function, count) | Code::Partial(function, count, _) => {
                Some((function, self.arguments(instruction.a, count)))
            }
            _ => None,
        }
    }

    /// Calls `each` with the registers that an instruction reads.
    #[inline]
    pub(super) fn operands(&self, instruction: &Instruction, mut each: impl FnMut(u32)) {
        let Instruction {
            code, a, b, c, d, ..
        } = *instruction;
        match code {
            Code::Unary(_) | Code::Whole(_) | Code::Lookup { .. } => each(a),
            Code::Binary(_) | Code::Compare(_) => [a, b].into_iter().for_each(each),
            Code::HalfPower(_) | Code::Select => [a, b, c].into_iter().for_each(each),
            Code::CompareSelect(_) | Code::If => [a, b, c, d].into_iter().for_each(each),
            Code::Call(_, count) | Code::Partial(_, count, _) => {
                self.arguments(a, count).iter().copied().for_each(each);
            }
        }
    }

    /// Returns the argument registers of a call, or of its partial derivative.
    pub(super) fn arguments(&self, first: u32, count: u32) -> &[u32] {
        &self.lists[first as usize..(first + count) as usize]
    }

    /// Performs one instruction; over numbers that do not call functions, none that does.
    #[inline(always)]
    pub(super) fn perform<S: Scalar>(&self, instruction: &Instruction, registers: &mut [S]) {
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
            Code::HalfPower(n) => half_power(n, r(a) * r(b), r(c)),
            Code::Compare(op) => from_mask(op.apply(r(a), r(b))),
            Code::Select => S::select(truth(r(a)), r(b), r(c)),
            Code::CompareSelect(op) => S::select(op.apply(r(a), r(b)), r(c), r(d)),
            Code::If => arithmetic_if(r(a), r(b), r(c), r(d)),
            Code::Lookup { table, order } => r(a).lookup(&self.tables[table as usize], order),
            Code::Call(function, count) if S::CALLS_FUNCTIONS => {
                gathered(self.arguments(a, count), r, |args| function.eval(args))
            }
            Code::Partial(function, count, k) if S::CALLS_FUNCTIONS => {
                gathered(self.arguments(a, count), r, |args| {
                    partial(function, args, k as usize)
                })
            }
            Code::Call(..) | Code::Partial(..) => {
                unreachable!("calls are expanded for numbers that do not call functions")
            }
        };
    }
}

/// Returns `product` = xⁿ √x, n ≥ 1, with derivatives at x = 0, too, where those of the root are
/// not finite. The value is the product's to the bit, also where a power of the exponent n + 1/2
/// would be rounded otherwise.
#[inline(always)]
fn half_power<S: Scalar>(n: i32, product: S, x: S) -> S {
    let exponent = f64::from(n) + 0.5;
    if Exponent::of(exponent) == Exponent::Half(n) {
        return x.powf(S::constant(exponent));
    }
    // as flat at 0 as the product, and with the sign of its zero
    S::choose(x.same(S::constant(0.0)), || x.powi(n) * x, || product)
}

/// Evaluates a function of arguments that are gathered from the registers.
#[inline(always)]
pub(super) fn gathered<S: Scalar>(
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

/// Evaluates the `k`-th partial derivative of a function: its row over a dual.
#[inline]
pub(super) fn partial<S: Scalar>(function: Function, args: &[S], k: usize) -> S {
    fn over_duals<S: Scalar, const N: usize>(function: Function, args: &[S], k: usize) -> S {
        let mut duals = [Dual::<1, S>::constant(0.0); N];
        for (dual, &x) in duals.iter_mut().zip(args) {
            *dual = Dual {
                re: x,
                eps: [S::zero()],
            };
        }
        if let Some(dual) = duals.get_mut(k) {
            dual.eps = [S::one()];
        }
        function.eval(&duals[..args.len().min(N)]).eps[0]
    }
    if args.len() <= 8 {
        over_duals::<S, 8>(function, args, k)
    } else {
        over_duals::<S, 40>(function, args, k)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::program::{Builder, Folding, Input, Work};
    use crate::scalar::Lanes;

    #[test]
    fn a_power_times_the_root_of_its_base_is_their_product_in_every_evaluation() {
        for n in 1..40 {
            let mut builder = Builder::new(Folding::Strict);
            let input = builder.input(Input::Slot(0));
            let (whole, root) = (builder.powi(input, n), builder.unary(UnaryOp::Sqrt, input));
            let product = builder.binary(BinaryOp::Mul, whole, root);
            let program = builder.finish(&[product]);
            for x in [0.0, -0.0, 0.5603884774161568, 1.0, 1.3, 2.0, -1.0] {
                let want = Scalar::powi(x, n) * f64::sqrt(x);
                let is_it =
                    |got: f64| got.to_bits() == want.to_bits() || got.is_nan() && want.is_nan();
                assert!(is_it(program.value(&[x], &mut Work::default())), "{n} {x}");
                let mut out = [Lanes([0.0; 2])];
                program.eval(&[Lanes([x, 1.0])], &mut Work::default(), &mut out);
                assert!(is_it(out[0].0[0]), "{n} {x}: {} {want}", out[0].0[0]);
                let mut out = [Dual::<1>::constant(0.0)];
                program.eval(&[Dual::variable(x, 0)], &mut Work::default(), &mut out);
                assert!(is_it(out[0].re), "{n} {x}: {} {want}", out[0].re);
                let (exponent, got) = (f64::from(n) + 0.5, out[0].eps[0]);
                let slope = exponent * f64::powf(x, exponent - 1.0);
                let is_slope = x < 0.0 || (got - slope).abs() <= 1e-13 * slope;
                assert!(is_slope, "{n} {x}: {got} {slope}");
            }
        }
    }
}
