//! Derivatives of a program along many directions at once.
//!
//! ```text
//! y = p(x)        s = fixed(x)  once a state,        ẏ = L(s) ẋ  for all directions together
//! ```
//!
//! The program runs once over duals of recorded numbers. The factors s of their derivatives do not
//! depend on the direction: they become a program of their own, which runs as code of the
//! processor. What is left is linear: sums of two products, over [`LANES`] directions each. The
//! derivatives are those of the program over duals, to the bit, but for the sign of a zero.

use super::batch::Instructions;
use super::builder::{Builder, Folding};
use super::input::Input;
use super::node::{Node, Value};
use super::operation::{BinaryOp, UnaryOp};
use super::record::Sym;
use super::run::{Program, Work};
use crate::scalar::{Dual, Lanes, Scalar};
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

/// Directions that are followed together.
pub(crate) const LANES: usize = VECTORS * WIDTH;
/// Numbers that one vector operation works on.
const WIDTH: usize = 8;
/// Vectors of a lane.
const VECTORS: usize = 4;

/// A number's derivatives along some directions.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Lane([Lanes<WIDTH>; VECTORS]);

impl Lane {
    /// No derivative along any direction.
    pub(crate) const ZERO: Self = Lane([Lanes([0.0; WIDTH]); VECTORS]);

    /// Returns the derivative along a direction.
    pub(crate) fn get(&self, k: usize) -> f64 {
        self.0[k / WIDTH].0[k % WIDTH]
    }

    /// Sets the derivative along a direction.
    pub(crate) fn set(&mut self, k: usize, slope: f64) {
        self.0[k / WIDTH].0[k % WIDTH] = slope;
    }
}

/// The derivatives of a program, and the state that they were asked at last.
#[derive(Clone, Debug)]
pub(crate) struct Tangent {
    linear: Arc<Linear>,
    work: Work,
    /// constants, then what `fixed` has computed
    factors: Vec<f64>,
    /// whether all of these are
    are_finite: bool,
    registers: Vec<Lane>,
}

/// Straight code that is linear in its registers. The first of these is zero for ever.
#[derive(Debug)]
struct Linear {
    /// computes factors from the inputs of the program
    fixed: Program,
    constants: Vec<f64>,
    steps: Vec<Step>,
    /// inputs of the program with derivatives, and their registers
    seeds: Vec<(u32, u32)>,
    /// registers of the outputs
    outputs: Vec<u32>,
    n_registers: usize,
}

/// A factor, or what is opposite to it.
#[derive(Clone, Copy, Debug)]
struct Factor {
    index: u32,
    is_opposite: bool,
}

/// A step; its numbers are registers.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// to = p a
    Product { to: u32, p: Factor, a: u32 },
    /// to = a/p
    Quotient { to: u32, a: u32, p: Factor },
    /// to = p a + q b
    Sum {
        to: u32,
        p: Factor,
        a: u32,
        q: Factor,
        b: u32,
    },
    /// to = a where p is positive, else b
    Select { to: u32, p: Factor, a: u32, b: u32 },
}

impl Step {
    fn to(&mut self) -> &mut u32 {
        match self {
            Step::Product { to, .. }
            | Step::Quotient { to, .. }
            | Step::Sum { to, .. }
            | Step::Select { to, .. } => to,
        }
    }

    /// Calls `each` with the registers that it reads.
    fn operands(&mut self, mut each: impl FnMut(&mut u32)) {
        match self {
            Step::Product { a, .. } | Step::Quotient { a, .. } => each(a),
            Step::Sum { a, b, .. } | Step::Select { a, b, .. } => [a, b].into_iter().for_each(each),
        }
    }
}

impl Tangent {
    /// Records the derivatives of a program with respect to the inputs at some positions; `None`
    /// where it has operations whose derivatives are not known to be linear.
    pub(crate) fn of(program: &Program, varies: impl Fn(usize) -> bool) -> Option<Self> {
        let builder = RefCell::new(Builder::new(Folding::Finite));
        let n = program.inputs().len();
        let mut seeds = Vec::new();
        let mut inputs = Vec::with_capacity(n);
        for (k, &input) in program.inputs().iter().enumerate() {
            let re = Sym::input(input, &builder);
            let mut eps = Sym::Constant(0.0);
            if varies(k) {
                // behind all that any layout has
                eps = Sym::input(Input::Slot(u32::MAX - k as u32), &builder);
                seeds.push((k as u32, eps.value(&mut builder.borrow_mut())));
            }
            inputs.push(Dual { re, eps: [eps] });
        }
        let zero = Dual::constant(0.0);
        let mut out: Vec<Dual<1, Sym<'_>>> = vec![zero; program.n_outputs()];
        program.eval(&inputs, &mut Work::default(), &mut out);
        let slopes: Vec<Value> = (out.iter())
            .map(|y| y.eps[0].value(&mut builder.borrow_mut()))
            .collect();
        drop((inputs, out));
        let linear = Linearizer::new(builder.into_inner(), &seeds, &slopes);
        let linear = linear.finish(program.inputs(), &seeds, &slopes)?;
        let mut factors = linear.constants.clone();
        factors.resize(factors.len() + linear.fixed.n_outputs(), f64::NAN);
        Some(Self {
            registers: vec![Lane::ZERO; linear.n_registers],
            linear: Arc::new(linear),
            work: Work::default(),
            factors,
            are_finite: false,
        })
    }

    /// Computes the factors at a state.
    pub(crate) fn see(&mut self, numbers: &[f64]) {
        let factors = &mut self.factors[self.linear.constants.len()..];
        self.linear.fixed.run(numbers, &mut self.work, factors);
        self.are_finite = self.factors.iter().all(|p| p.is_finite());
    }

    /// Follows the first `n` directions from the derivatives of the inputs, by position, to those
    /// of the outputs; what these say of others means nothing.
    pub(crate) fn along(&mut self, n: usize, seeds: &[Lane], out: &mut [Lane]) {
        for &(input, register) in &self.linear.seeds {
            self.registers[register as usize] = seeds[input as usize];
        }
        let code = Code {
            steps: &self.linear.steps,
            factors: &self.factors,
            are_finite: self.are_finite,
            n_vectors: n.div_ceil(WIDTH),
        };
        perform(code, &mut self.registers);
        for (out, &register) in out.iter_mut().zip(&self.linear.outputs) {
            *out = self.registers[register as usize];
        }
    }
}

/// Makes linear code of a recording.
struct Linearizer {
    whole: Builder,
    /// whether a node has derivatives along directions
    is_linear: Vec<bool>,
    is_needed: Vec<bool>,
    /// whether a node is zero, of either sign
    is_zero: Vec<bool>,
    /// how often a derivative is read
    uses: Vec<u32>,
    constants: Vec<f64>,
    /// values that `fixed` computes
    fixed: Vec<Value>,
    /// the factor that a value is
    factor_of: HashMap<Value, Factor>,
    /// each writes a register of its own: that of its place, behind zero and the seeds
    steps: Vec<Step>,
    n_seeds: u32,
    /// the register of a value
    register_of: HashMap<Value, u32>,
}

impl Linearizer {
    fn new(whole: Builder, seeds: &[(u32, Value)], slopes: &[Value]) -> Self {
        let inputs: Vec<Value> = seeds.iter().map(|&(_, v)| v).collect();
        let is_linear = whole.changes(&inputs);
        let is_needed = whole.read(slopes, whole.nodes.len());
        let mut uses = vec![0; whole.nodes.len()];
        slopes.iter().for_each(|v| uses[v.index()] += 1);
        for k in (0..whole.nodes.len()).filter(|&k| is_needed[k] && is_linear[k]) {
            whole.operands(&whole.nodes[k], |v| uses[v.index()] += 1);
        }
        let mut is_zero = vec![false; whole.nodes.len()];
        for (k, node) in whole.nodes.iter().enumerate() {
            is_zero[k] = match *node {
                Node::Constant(bits) => f64::from_bits(bits) == 0.0,
                Node::Select(_, yes, no) => is_zero[yes.index()] && is_zero[no.index()],
                _ => false,
            };
        }
        let register_of = inputs.iter().copied().zip(1..).collect();
        Self {
            whole,
            is_linear,
            is_needed,
            is_zero,
            uses,
            constants: vec![1.0],
            fixed: Vec::new(),
            factor_of: HashMap::new(),
            steps: Vec::new(),
            n_seeds: inputs.len() as u32,
            register_of,
        }
    }

    /// One, as a factor.
    const ONE: Factor = Factor {
        index: 0,
        is_opposite: false,
    };

    /// Returns a value that no direction changes as a factor; `fixed` counts behind the constants,
    /// whose number is not known so far.
    fn factor(&mut self, v: Value) -> Factor {
        if let Some(&known) = self.factor_of.get(&v) {
            return known;
        }
        let index = match self.whole.constant_of(v) {
            Some(c) => {
                self.constants.push(c);
                self.constants.len() as u32 - 1
            }
            None => {
                self.fixed.push(v);
                FIXED + self.fixed.len() as u32 - 1
            }
        };
        let factor = Factor {
            index,
            is_opposite: false,
        };
        self.factor_of.insert(v, factor);
        factor
    }

    /// Returns the register of a derivative; `None` for a number that is not zero.
    fn register(&self, v: Value) -> Option<u32> {
        match self.is_linear[v.index()] {
            true => self.register_of.get(&v).copied(),
            false => self.is_zero[v.index()].then_some(0),
        }
    }

    /// Returns factor and register of an operand of a sum: those of a product that nobody else
    /// reads.
    fn term(&self, v: Value) -> Option<(Factor, u32)> {
        let register = self.register(v)?;
        let made_by = register.checked_sub(1 + self.n_seeds);
        match made_by.map(|k| self.steps[k as usize]) {
            Some(Step::Product { p, a, .. }) if self.uses[v.index()] == 1 => Some((p, a)),
            _ => Some((Self::ONE, register)),
        }
    }

    fn step(&mut self, node: Node) -> Option<Step> {
        let to = 0;
        let is_linear = |v: Value| self.is_linear[v.index()];
        Some(match node {
            Node::Unary(UnaryOp::Neg, x) => Step::Product {
                to,
                p: Self::ONE.opposite(),
                a: self.register(x)?,
            },
            Node::Binary(BinaryOp::Mul, x, y) if is_linear(x) != is_linear(y) => {
                let (lane, number) = if is_linear(x) { (x, y) } else { (y, x) };
                Step::Product {
                    to,
                    p: self.factor(number),
                    a: self.register(lane)?,
                }
            }
            Node::Binary(BinaryOp::Div, x, y) if !is_linear(y) => Step::Quotient {
                to,
                a: self.register(x)?,
                p: self.factor(y),
            },
            Node::Binary(op @ (BinaryOp::Add | BinaryOp::Sub), x, y) => {
                let ((p, a), (q, b)) = (self.term(x)?, self.term(y)?);
                let q = match op {
                    BinaryOp::Sub => q.opposite(),
                    _ => q,
                };
                Step::Sum { to, p, a, q, b }
            }
            Node::Select(condition, yes, no) if !is_linear(condition) => Step::Select {
                to,
                p: self.factor(condition),
                a: self.register(yes)?,
                b: self.register(no)?,
            },
            _ => return None,
        })
    }

    fn finish(
        mut self,
        inputs: &[Input],
        seeds: &[(u32, Value)],
        slopes: &[Value],
    ) -> Option<Linear> {
        for k in 0..self.whole.nodes.len() {
            let node = self.whole.nodes[k];
            if !self.is_needed[k] || !self.is_linear[k] || matches!(node, Node::Input(_)) {
                continue;
            }
            let mut step = self.step(node)?;
            let register = 1 + self.n_seeds + self.steps.len() as u32;
            *step.to() = register;
            self.register_of.insert(Value(k as u32), register);
            self.steps.push(step);
        }
        let outputs: Option<Vec<u32>> = slopes.iter().map(|&v| self.register(v)).collect();
        let outputs = outputs?;
        let steps = self.numbered();
        let (steps, outputs, n_registers) = allocated(steps, outputs, self.n_seeds);
        Some(Linear {
            fixed: self.whole.finish_with_inputs(&self.fixed, inputs),
            constants: self.constants,
            steps,
            seeds: seeds.iter().map(|&(k, _)| k).zip(1..).collect(),
            outputs,
            n_registers,
        })
    }

    /// Returns the steps with the factors of `fixed` behind the constants.
    fn numbered(&mut self) -> Vec<Step> {
        let n = self.constants.len() as u32;
        let place = |p: &mut Factor| {
            if let Some(k) = p.index.checked_sub(FIXED) {
                p.index = n + k;
            }
        };
        for step in &mut self.steps {
            match step {
                Step::Product { p, .. } | Step::Quotient { p, .. } | Step::Select { p, .. } => {
                    place(p)
                }
                Step::Sum { p, q, .. } => [p, q].into_iter().for_each(place),
            }
        }
        std::mem::take(&mut self.steps)
    }
}

/// First index of a factor that `fixed` computes, while constants are still counted.
const FIXED: u32 = 1 << 31;

impl Factor {
    fn opposite(self) -> Self {
        Self {
            is_opposite: !self.is_opposite,
            ..self
        }
    }

    #[inline(always)]
    fn of(self, factors: &[f64]) -> f64 {
        let factor = factors[self.index as usize];
        if self.is_opposite { -factor } else { factor }
    }
}

/// Drops steps that nobody reads and gives the others as few registers as they need; zero and the
/// seeds keep theirs. Returns steps, outputs, and the number of registers.
fn allocated(
    steps: Vec<Step>,
    mut outputs: Vec<u32>,
    n_seeds: u32,
) -> (Vec<Step>, Vec<u32>, usize) {
    let n_kept = 1 + n_seeds as usize;
    // the step behind which nobody reads a register
    let mut last = vec![0; n_kept + steps.len()];
    outputs.iter().for_each(|&r| last[r as usize] = usize::MAX);
    for (k, mut step) in steps.iter().copied().enumerate().rev() {
        if last[n_kept + k] > 0 {
            step.operands(|r| last[*r as usize] = last[*r as usize].max(k + 1));
        }
    }
    let mut place: Vec<u32> = (0..n_kept as u32).collect();
    place.resize(n_kept + steps.len(), 0);
    let (mut free, mut n_registers) = (Vec::new(), n_kept);
    let mut kept = Vec::new();
    for (k, mut step) in steps.into_iter().enumerate() {
        if last[n_kept + k] == 0 {
            continue;
        }
        let mut ended = [0; 2];
        let mut n_ended = 0;
        step.operands(|r| {
            let own = *r as usize;
            *r = place[own];
            if own >= n_kept && last[own] == k + 1 {
                last[own] = 0;
                ended[n_ended] = place[own];
                n_ended += 1;
            }
        });
        free.extend(&ended[..n_ended]);
        let register = free.pop().unwrap_or_else(|| {
            n_registers += 1;
            n_registers as u32 - 1
        });
        place[n_kept + k] = register;
        *step.to() = register;
        kept.push(step);
    }
    for r in &mut outputs {
        *r = place[*r as usize];
    }
    (kept, outputs, n_registers)
}

/// Steps, and what is known of them.
#[derive(Clone, Copy)]
struct Code<'a> {
    steps: &'a [Step],
    factors: &'a [f64],
    are_finite: bool,
    /// vectors of a lane in which anybody asks for directions
    n_vectors: usize,
}

/// Returns p x; nothing changes along a direction in which x does not, however steep p is.
#[inline(always)]
fn times<const FINITE: bool>(x: Lanes<WIDTH>, p: Lanes<WIDTH>) -> Lanes<WIDTH> {
    let mut product = x * p;
    if !FINITE && !p.0[0].is_finite() {
        for (y, x) in product.0.iter_mut().zip(x.0) {
            *y = if x == 0.0 { 0.0 } else { *y };
        }
    }
    product
}

/// Performs all steps, with the vector instructions of this machine.
#[cfg(all(feature = "native", target_arch = "x86_64"))]
#[allow(unsafe_code)]
fn perform(code: Code<'_>, r: &mut [Lane]) {
    match Instructions::of_this_machine() {
        Instructions::Portable => perform_any(code, r),
        // SAFETY: the machine has these instructions, see `of_this_machine`
        Instructions::Avx2 => unsafe { perform_avx2(code, r) },
        // SAFETY: as before
        Instructions::Avx512 => unsafe { perform_avx512(code, r) },
    }
}

/// Performs all steps.
#[cfg(not(all(feature = "native", target_arch = "x86_64")))]
fn perform(code: Code<'_>, r: &mut [Lane]) {
    match Instructions::of_this_machine() {
        Instructions::Portable => perform_any(code, r),
    }
}

#[cfg(all(feature = "native", target_arch = "x86_64"))]
#[target_feature(enable = "avx2")]
fn perform_avx2(code: Code<'_>, r: &mut [Lane]) {
    perform_any(code, r);
}

#[cfg(all(feature = "native", target_arch = "x86_64"))]
#[target_feature(enable = "avx512f,avx512vl,avx512dq")]
fn perform_avx512(code: Code<'_>, r: &mut [Lane]) {
    perform_any(code, r);
}

/// Performs all steps, compiled for the vector instructions of its surroundings.
#[inline(always)]
fn perform_any(code: Code<'_>, r: &mut [Lane]) {
    match (code.n_vectors, code.are_finite) {
        (1, true) => perform_on::<1, true>(code, r),
        (2, true) => perform_on::<2, true>(code, r),
        (3, true) => perform_on::<3, true>(code, r),
        (_, true) => perform_on::<VECTORS, true>(code, r),
        (_, false) => perform_on::<VECTORS, false>(code, r),
    }
}

/// `to = f(a, …)` in the first `N` vectors; all of these are known before any of them is written.
macro_rules! each {
    ($r:ident, $to:ident = |$($x:ident = $register:ident),+| $value:expr) => {{
        $(let $x = &$r[$register as usize].0;)+
        let mut all = [Lanes([0.0; WIDTH]); N];
        for k in 0..N {
            $(let $x = $x[k];)+
            all[k] = $value;
        }
        $r[$to as usize].0[..N].copy_from_slice(&all);
    }};
}

/// Performs all steps on the first `N` vectors of each lane.
#[inline(always)]
fn perform_on<const N: usize, const FINITE: bool>(code: Code<'_>, r: &mut [Lane]) {
    let factors = code.factors;
    for step in code.steps {
        match *step {
            Step::Product { to, p, a } => {
                let p = Lanes::constant(p.of(factors));
                each!(r, to = |x = a| times::<FINITE>(x, p));
            }
            Step::Quotient { to, a, p } => {
                let p = Lanes::constant(p.of(factors));
                each!(r, to = |x = a| x / p);
            }
            Step::Sum { to, p, a, q, b } => {
                let (p, q) = (p.of(factors), q.of(factors));
                let (p, q) = (Lanes::constant(p), Lanes::constant(q));
                each!(r, to = |x = a, y = b| times::<FINITE>(x, p) + times::<FINITE>(y, q));
            }
            Step::Select { to, p, a, b } => {
                let from = if p.of(factors) > 0.0 { a } else { b };
                each!(r, to = |x = from| x);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::random;
    use super::*;

    /// Records operations that `seed` says on six inputs.
    fn recorded(seed: u64) -> Program {
        let (b, mut values) = random::recorded(seed, 60);
        let mut outputs = values.split_off(values.len() - 5);
        outputs.push(values[1]);
        b.finish_with_inputs(&outputs, &[0, 1, 2, 3, 4, 5].map(Input::Slot))
    }

    #[test]
    fn derivatives_along_many_directions_are_those_of_duals_to_the_bit() {
        let (mut compared, mut refused) = (0, 0);
        for seed in 0..400 {
            let program = recorded(seed);
            let varies = |k: usize| k != 2;
            // where a constant derivative is no number
            let Some(mut tangent) = Tangent::of(&program, varies) else {
                refused += 1;
                continue;
            };
            for state in 0..3 {
                let numbers: Vec<f64> = (0..6).map(|k| f64::from(state * 6 + k).cos()).collect();
                let slope = |k: usize, d: usize| ((k * LANES + d) as f64 * 0.7).sin().max(-0.5);
                let mut seeds = vec![Lane::ZERO; 6];
                for k in (0..6).filter(|&k| varies(k)) {
                    (0..LANES).for_each(|d| seeds[k].set(d, slope(k, d)));
                }
                tangent.see(&numbers);
                let mut out = vec![Lane::ZERO; 6];
                tangent.along(LANES, &seeds, &mut out);
                for d in 0..LANES {
                    let dual = |k: usize| Dual {
                        re: numbers[k],
                        eps: [seeds[k].get(d)],
                    };
                    let duals: Vec<Dual<1>> = (0..6).map(dual).collect();
                    let mut by_duals = [Dual::constant(0.0); 6];
                    program.eval(&duals, &mut Work::default(), &mut by_duals);
                    for (lane, y) in out.iter().zip(&by_duals) {
                        let (own, known) = (lane.get(d), y.eps[0]);
                        if known.is_finite() {
                            compared += 1;
                            assert!(own == known, "{seed}, {d}: {own} {known}\n{program}");
                        }
                    }
                }
                // fewer directions
                for n in [
                    1,
                    WIDTH,
                    WIDTH + 1,
                    LANES - WIDTH - 1,
                    LANES - WIDTH,
                    LANES - 1,
                ] {
                    let mut some = vec![Lane::ZERO; 6];
                    tangent.along(n, &seeds, &mut some);
                    for (some, all) in some.iter().zip(&out) {
                        let bits = |lane: &Lane| (0..n).map(|d| lane.get(d).to_bits()).collect();
                        let [some, all]: [Vec<u64>; 2] = [some, all].map(bits);
                        assert_eq!(some, all, "{seed}, {n} directions\n{program}");
                    }
                }
            }
        }
        assert!(compared > 100_000 && refused < 40, "{compared}, {refused}");
    }

    #[test]
    fn a_direction_that_a_steep_number_does_not_know_changes_nothing() {
        let mut b = Builder::new(Folding::Structural);
        let [x, y] = [0, 1].map(|k| b.input(Input::Slot(k)));
        let root = b.unary(UnaryOp::Sqrt, x);
        let sum = b.binary(BinaryOp::Add, root, y);
        let program = b.finish(&[sum]);
        let mut tangent = Tangent::of(&program, |_| true).expect("all of it is linear");
        tangent.see(&[0.0, 1.0]);
        let (mut seeds, mut out) = ([Lane::ZERO; 2], [Lane::ZERO]);
        seeds[0].set(0, 1.0);
        seeds[1].set(1, 1.0);
        tangent.along(2, &seeds, &mut out);
        assert_eq!([out[0].get(0), out[0].get(1)], [f64::INFINITY, 1.0]);
    }
}
