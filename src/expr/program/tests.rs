//! Promises of builder, schedule and machine, kept on small programs and on random ones.

use super::operation::arithmetic_if;
use super::*;
use crate::expr::functions::Function;
use crate::scalar::Scalar;
use crate::scalar::{Dual, Jet, Lanes};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use std::cell::RefCell;

/// Inputs of the random formulas.
const N: usize = 4;

/// A formula, so that the same one can be computed directly and recorded.
#[derive(Clone, Debug)]
enum Formula {
    Constant(f64),
    Input(usize),
    Unary(UnaryOp, Box<Formula>),
    Whole(i32, Box<Formula>),
    Binary(BinaryOp, Box<Formula>, Box<Formula>),
    Select(Comparison, Box<[Formula; 4]>),
    If(Box<[Formula; 4]>),
    Call(Function, Vec<Formula>),
}

impl Formula {
    fn eval<S: Scalar>(&self, inputs: &[S]) -> S {
        match self {
            Formula::Constant(c) => S::constant(*c),
            Formula::Input(k) => inputs[*k],
            Formula::Unary(op, x) => op.apply(x.eval(inputs)),
            Formula::Whole(n, x) => x.eval(inputs).powi(*n),
            Formula::Binary(op, a, b) => op.apply(a.eval(inputs), b.eval(inputs)),
            Formula::Select(op, x) => {
                let [a, b, yes, no] = &**x;
                S::select(
                    op.apply(a.eval(inputs), b.eval(inputs)),
                    yes.eval(inputs),
                    no.eval(inputs),
                )
            }
            Formula::If(x) => {
                let [selector, negative, zero, positive] = &**x;
                arithmetic_if(
                    selector.eval(inputs),
                    negative.eval(inputs),
                    zero.eval(inputs),
                    positive.eval(inputs),
                )
            }
            Formula::Call(f, args) => {
                f.eval(&args.iter().map(|a| a.eval(inputs)).collect::<Vec<_>>())
            }
        }
    }
}

fn formula() -> impl Strategy<Value = Formula> {
    let number = prop_oneof![
        prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 2.0, 0.5, 1.5, -2.0, 3.0]),
        -3.0..3.0f64
    ];
    let leaf = prop_oneof![
        number.prop_map(Formula::Constant),
        (0..N).prop_map(Formula::Input)
    ];
    leaf.prop_recursive(6, 60, 5, |inner| {
        let unary = prop::sample::select(vec![
            UnaryOp::Neg,
            UnaryOp::Abs,
            UnaryOp::Sqrt,
            UnaryOp::Sin,
            UnaryOp::Cos,
            UnaryOp::Exp,
            UnaryOp::Floor,
            UnaryOp::Tanh,
        ]);
        let binary = prop::sample::select(vec![
            BinaryOp::Add,
            BinaryOp::Sub,
            BinaryOp::Mul,
            BinaryOp::Div,
            BinaryOp::Pow,
            BinaryOp::Atan2,
            BinaryOp::Rem,
            BinaryOp::Kept,
        ]);
        let comparison = prop::sample::select(vec![Comparison::Lt, Comparison::Le, Comparison::Eq]);
        let function = prop::sample::select(Function::ALL.to_vec());
        let four = [inner.clone(), inner.clone(), inner.clone(), inner.clone()];
        let boxed = inner.clone().prop_map(Box::new);
        prop_oneof![
            2 => (unary, boxed.clone()).prop_map(|(op, x)| Formula::Unary(op, x)),
            1 => (-4..6, boxed.clone()).prop_map(|(n, x)| Formula::Whole(n, x)),
            6 => (binary, boxed.clone(), boxed).prop_map(|(op, a, b)| Formula::Binary(op, a, b)),
            1 => (comparison, four.clone()).prop_map(|(op, x)| Formula::Select(op, Box::new(x))),
            1 => four.prop_map(|x| Formula::If(Box::new(x))),
            2 => (function, prop::collection::vec(inner, 9)).prop_map(|(f, mut args)| {
                let (least, most) = (*f.arity().start(), *f.arity().end());
                args.truncate(least.max(args.len().min(most)));
                Formula::Call(f, args)
            }),
        ]
    })
}

/// Formulas of what the machine treats specially: arithmetic that fuses, branches that are jumped
/// over, sums of steps.
fn dense_formula() -> impl Strategy<Value = Formula> {
    let number = prop::sample::select(vec![0.5, 1.0, 2.0, -0.25, 3.0]);
    let leaf =
        prop_oneof![1 => number.prop_map(Formula::Constant), 3 => (0..N).prop_map(Formula::Input)];
    leaf.prop_recursive(12, 400, 4, |inner| {
        let binary = prop::sample::select(vec![BinaryOp::Add, BinaryOp::Sub, BinaryOp::Mul, BinaryOp::Div]);
        let unary = prop::sample::select(vec![UnaryOp::Neg, UnaryOp::Abs, UnaryOp::Sqrt, UnaryOp::Sin, UnaryOp::Cos]);
        let comparison = prop::sample::select(vec![Comparison::Lt, Comparison::Le, Comparison::Eq]);
        let function = prop::sample::select(vec![Function::Step, Function::Havsin, Function::Poly, Function::Forcos]);
        let four = [inner.clone(), inner.clone(), inner.clone(), inner.clone()];
        let boxed = inner.clone().prop_map(Box::new);
        let constants = [-1.0, 0.25, 0.5, 1.75].map(Formula::Constant);
        prop_oneof![
            8 => (binary, boxed.clone(), boxed.clone()).prop_map(|(op, a, b)| Formula::Binary(op, a, b)),
            2 => (unary, boxed.clone()).prop_map(|(op, x)| Formula::Unary(op, x)),
            1 => (2..6, boxed.clone()).prop_map(|(n, x)| Formula::Whole(n, x)),
            1 => (comparison, four.clone()).prop_map(|(op, x)| Formula::Select(op, Box::new(x))),
            3 => four.prop_map(|x| Formula::If(Box::new(x))),
            3 => (function, inner).prop_map(move |(f, x)| {
                let mut args = vec![x];
                args.extend(constants.clone());
                Formula::Call(f, args)
            }),
        ]
    })
}

/// Records a formula, its functions as calls.
fn record(formula: &Formula, builder: &mut Builder) -> Value {
    match formula {
        Formula::Constant(c) => builder.constant(*c),
        Formula::Input(k) => builder.input(Input::Slot(*k as u32)),
        Formula::Unary(op, x) => {
            let x = record(x, builder);
            builder.unary(*op, x)
        }
        Formula::Whole(n, x) => {
            let x = record(x, builder);
            builder.powi(x, *n)
        }
        Formula::Binary(op, a, b) => {
            let (a, b) = (record(a, builder), record(b, builder));
            builder.binary(*op, a, b)
        }
        Formula::Select(op, x) => {
            let [a, b, yes, no] = [0, 1, 2, 3].map(|k| record(&x[k], builder));
            let condition = builder.compare(*op, a, b);
            builder.select(condition, yes, no)
        }
        Formula::If(x) => {
            let [selector, negative, zero, positive] = [0, 1, 2, 3].map(|k| record(&x[k], builder));
            builder.arithmetic_if(selector, negative, zero, positive)
        }
        Formula::Call(f, args) => {
            let args: Vec<Value> = args.iter().map(|a| record(a, builder)).collect();
            builder.call(*f, &args)
        }
    }
}

fn same_bits(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

/// The program on each engine that there is here.
fn engines(program: &Program) -> impl Iterator<Item = Program> {
    [Engine::Interpreter, Engine::Native]
        .into_iter()
        .filter_map(|engine| program.with_engine(engine))
}

/// Returns true if all engines give the same bits.
fn engines_agree(program: &Program, x: &[f64]) -> bool {
    let outputs: Vec<Vec<f64>> = engines(program)
        .map(|program| {
            let (mut work, mut out) = (Work::default(), vec![0.0; program.n_outputs()]);
            program.run(x, &mut work, &mut out);
            out.push(program.value(x, &mut work));
            out
        })
        .collect();
    outputs.iter().all(|out| {
        let pairs = out.iter().zip(&outputs[0]);
        pairs.into_iter().all(|(a, b)| same_bits(*a, *b))
    })
}

fn layout() -> [Input; N] {
    std::array::from_fn(|k| Input::Slot(k as u32))
}

fn point() -> impl Strategy<Value = [f64; N]> {
    let number =
        prop_oneof![3 => -2.0..2.0f64, 1 => prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 2.0])];
    [number.clone(), number.clone(), number.clone(), number]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn strict_programs_keep_every_bit(formulas in prop::collection::vec(formula(), 1..4), x in point()) {
        let mut builder = Builder::new(Folding::Strict);
        let outputs: Vec<Value> = formulas.iter().map(|f| record(f, &mut builder)).collect();
        let program = builder.finish_with_inputs(&outputs, &layout());
        prop_assert_eq!(builder.count_operations(&outputs), program.n_operations());
        let mut out = vec![0.0; outputs.len()];
        let mut work = Work::default();
        for _ in 0..2 {
            program.run(&x, &mut work, &mut out);
            for (got, f) in out.iter().zip(&formulas) {
                let want = f.eval(&x);
                prop_assert!(same_bits(*got, want), "{got} {want}");
            }
        }
        // each by itself, reduced to what it needs of the same builder
        for (&output, f) in outputs.iter().zip(&formulas) {
            let program = builder.finish_with_inputs(&[output], &layout());
            prop_assert_eq!(builder.count_operations(&[output]), program.n_operations());
            let (got, want) = (program.value(&x, &mut work), f.eval(&x));
            prop_assert!(same_bits(got, want), "{got} {want}");
        }
    }

    #[test]
    fn fused_and_branching_programs_keep_every_bit(
        formulas in prop::collection::vec(dense_formula(), 1..3),
        x in point(),
        y in point(),
    ) {
        let mut builder = Builder::new(Folding::Strict);
        let outputs: Vec<Value> = formulas.iter().map(|f| record(f, &mut builder)).collect();
        let program = builder.finish_with_inputs(&outputs, &layout());
        let with_gradient = program.with_gradient(&layout());
        let (mut work, mut out) = (Work::default(), vec![0.0; outputs.len()]);
        let mut run = vec![0.0; with_gradient.n_outputs()];
        let mut evaluated = run.clone();
        for x in [x, y] {
            program.run(&x, &mut work, &mut out);
            for (got, f) in out.iter().zip(&formulas) {
                let want = f.eval(&x);
                prop_assert!(same_bits(*got, want), "{got} {want}");
            }
            if outputs.len() == 1 {
                prop_assert!(same_bits(program.value(&x, &mut work), out[0]));
            }
            with_gradient.eval(&x, &mut Work::default(), &mut evaluated);
            for engine in engines(&with_gradient) {
                engine.run(&x, &mut Work::default(), &mut run);
                for (got, want) in run.iter().zip(&evaluated) {
                    prop_assert!(same_bits(*got, *want) || got == want, "{got} {want}");
                }
            }
            prop_assert!(engines_agree(&with_gradient, &x) && engines_agree(&program, &x));
        }
    }

    #[test]
    fn recording_expands_functions_to_the_same_bits(f in formula(), x in point()) {
        let builder = RefCell::new(Builder::new(Folding::Strict));
        let inputs: Vec<Sym> = (0..N).map(|k| Sym::input(Input::Slot(k as u32), &builder)).collect();
        let result = f.eval(&inputs);
        let value = result.value(&mut builder.borrow_mut());
        let program = builder.borrow().finish_with_inputs(&[value], &layout());
        let mut out = [0.0];
        program.run(&x, &mut Work::default(), &mut out);
        prop_assert!(same_bits(out[0], f.eval(&x)), "{} {}", out[0], f.eval(&x));
    }

    #[test]
    fn structural_folding_agrees_where_all_is_finite(f in formula(), x in point()) {
        let builder = RefCell::new(Builder::new(Folding::Structural));
        let inputs: Vec<Sym> = (0..N).map(|k| Sym::input(Input::Slot(k as u32), &builder)).collect();
        let result = f.eval(&inputs);
        let value = result.value(&mut builder.borrow_mut());
        let program = builder.borrow().finish_with_inputs(&[value], &layout());
        let mut out = [0.0];
        program.run(&x, &mut Work::default(), &mut out);
        let want = f.eval(&x);
        // a structural zero hides what is not finite, and the sign of a zero may differ under a
        // division or atan2
        if want.is_finite() && out[0].is_finite() && x.iter().all(|x| x.abs() > 1e-3) && !has_sign_of_zero(&f) {
            prop_assert!((out[0] - want).abs() <= 1e-9 * want.abs().max(1.0), "{} {want}", out[0]);
        }
    }

    #[test]
    fn lanes_are_scalars_side_by_side(f in formula(), x in point(), y in point()) {
        let mut builder = Builder::new(Folding::Strict);
        let output = record(&f, &mut builder);
        let program = builder.finish_with_inputs(&[output], &layout());
        let lanes: Vec<Lanes<2>> = (0..N).map(|k| Lanes([x[k], y[k]])).collect();
        let mut out = [Lanes([0.0; 2])];
        program.eval(&lanes, &mut Work::default(), &mut out);
        prop_assert!(same_bits(out[0].0[0], f.eval(&x)));
        prop_assert!(same_bits(out[0].0[1], f.eval(&y)));
    }

    #[test]
    fn duals_and_jets_carry_the_value(f in formula(), x in point()) {
        let mut builder = Builder::new(Folding::Strict);
        let output = record(&f, &mut builder);
        let program = builder.finish_with_inputs(&[output], &layout());
        let duals: Vec<Dual<N>> = (0..N).map(|k| Dual::variable(x[k], k)).collect();
        let mut out = [Dual::constant(0.0)];
        program.eval(&duals, &mut Work::default(), &mut out);
        prop_assert!(same_bits(out[0].re, f.eval(&x)));
        let jets: Vec<Jet> = x.iter().map(|&x| Jet::variable(x)).collect();
        let mut out = [Jet::constant(0.0)];
        program.eval(&jets, &mut Work::default(), &mut out);
        prop_assert!(same_bits(out[0].value, f.eval(&x)));
    }
}

/// Value and derivatives of a formula by duals and by the adjoint, where both are numbers.
fn two_gradients(f: &Formula, x: &[f64; N]) -> Option<([f64; N], [f64; N])> {
    let duals: Vec<Dual<N>> = (0..N).map(|k| Dual::variable(x[k], k)).collect();
    let want = f.eval(&duals);
    let mut builder = Builder::new(Folding::Strict);
    let output = record(f, &mut builder);
    let program = builder
        .finish_with_inputs(&[output], &layout())
        .with_gradient(&layout());
    let mut out = [0.0; N + 1];
    program.run(x, &mut Work::default(), &mut out);
    assert!(same_bits(out[0], want.re), "{} {}", out[0], want.re);
    let got: [f64; N] = std::array::from_fn(|k| out[k + 1]);
    (want.re.is_finite() && want.eps.iter().chain(&got).all(|x| x.is_finite()))
        .then_some((got, want.eps))
}

/// Trees whose derivatives are compared: Miri takes half a second for one.
const COMPARED_TREES: usize = if cfg!(miri) { 40 } else { 4000 };

#[test]
fn adjoints_agree_with_duals() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let (mut compared, mut varying) = (0, 0);
    for _ in 0..COMPARED_TREES {
        let f = formula().new_tree(&mut runner).unwrap().current();
        let x = point().new_tree(&mut runner).unwrap().current();
        let Some((got, want)) = two_gradients(&f, &x) else {
            continue;
        };
        compared += 1;
        varying += usize::from(want.iter().any(|&d| d != 0.0));
        let scale = want.iter().chain(&got).fold(1.0f64, |m, d| m.max(d.abs()));
        for k in 0..N {
            assert!(
                (got[k] - want[k]).abs() <= 1e-9 * scale,
                "{f:?} at {x:?}: {got:?} {want:?}"
            );
        }
    }
    let enough = compared > COMPARED_TREES / 2 && varying > COMPARED_TREES * 7 / 40;
    assert!(enough, "{compared} {varying}");
}

#[test]
fn a_branch_without_a_value_does_not_spoil_derivatives() {
    // IF(x − 1: sqrt(1 − x), 0, sqrt(x − 1) y)
    let mut b = Builder::new(Folding::Strict);
    let (x, y) = (b.input(Input::Slot(0)), b.input(Input::Slot(1)));
    let [zero, one] = [0.0, 1.0].map(|c| b.constant(c));
    let (below, above) = (
        b.binary(BinaryOp::Sub, one, x),
        b.binary(BinaryOp::Sub, x, one),
    );
    let (low, high) = (b.unary(UnaryOp::Sqrt, below), b.unary(UnaryOp::Sqrt, above));
    let high = b.binary(BinaryOp::Mul, high, y);
    let f = b.arithmetic_if(above, low, zero, high);
    let program = b
        .finish(&[f])
        .with_gradient(&[Input::Slot(0), Input::Slot(1), Input::Time]);
    let mut out = [0.0; 4];
    program.run(&[1.25, 3.0], &mut Work::default(), &mut out);
    assert_eq!(out, [1.5, 3.0, 0.5, 0.0]);
    program.run(&[0.75, 3.0], &mut Work::default(), &mut out);
    assert_eq!(out, [0.5, -1.0, 0.0, 0.0]);
}

#[test]
fn gradients_have_gradients() {
    // STEP(x, 0, 0, 1, y): second derivatives through the partials of the call
    let mut b = Builder::new(Folding::Strict);
    let (x, y) = (b.input(Input::Slot(0)), b.input(Input::Slot(1)));
    let [zero, one] = [0.0, 1.0].map(|c| b.constant(c));
    let step = b.call(Function::Step, &[x, zero, zero, one, y]);
    let slope = b.gradient(step, &[x])[0];
    let second = b.gradient(slope, &[x, y]);
    let mut out = [0.0; 4];
    b.finish(&[step, slope, second[0], second[1]]).run(
        &[0.25, 2.0],
        &mut Work::default(),
        &mut out,
    );
    let u = 0.25;
    let want = [
        2.0 * u * u * (3.0 - 2.0 * u),
        12.0 * u * (1.0 - u),
        2.0 * (6.0 - 12.0 * u),
        6.0 * u * (1.0 - u),
    ];
    assert!(
        out.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-14),
        "{out:?} {want:?}"
    );
}

/// Returns true if the value may depend on the sign of a zero or on an exact comparison with one.
fn has_sign_of_zero(f: &Formula) -> bool {
    match f {
        Formula::Constant(_) | Formula::Input(_) => false,
        Formula::Unary(op, x) => matches!(op, UnaryOp::Floor) || has_sign_of_zero(x),
        Formula::Whole(n, x) => *n < 0 || has_sign_of_zero(x),
        Formula::Binary(op, a, b) => {
            matches!(
                op,
                BinaryOp::Atan2 | BinaryOp::Div | BinaryOp::Rem | BinaryOp::Pow
            ) || has_sign_of_zero(a)
                || has_sign_of_zero(b)
        }
        Formula::Select(..) | Formula::If(_) | Formula::Call(..) => true,
    }
}

#[test]
fn equal_parts_are_computed_once() {
    let mut b = Builder::new(Folding::Strict);
    let (x, y) = (b.input(Input::Slot(0)), b.input(Input::Slot(1)));
    let sum = b.binary(BinaryOp::Add, x, y);
    let again = b.binary(BinaryOp::Add, y, x);
    assert_eq!(sum, again);
    let sine = b.unary(UnaryOp::Sin, sum);
    let product = b.binary(BinaryOp::Mul, sine, sine);
    let program = b.finish(&[product, sine, product]);
    assert_eq!(program.n_operations(), 3);
    assert_eq!(program.n_outputs(), 3);
    let mut out = [0.0; 3];
    program.run(&[0.25, 0.5], &mut Work::default(), &mut out);
    let s = Scalar::sin(0.75f64);
    assert_eq!(out, [s * s, s, s * s]);
}

#[test]
fn what_is_not_needed_is_absent() {
    let mut b = Builder::new(Folding::Strict);
    let (x, y) = (b.input(Input::Slot(7)), b.input(Input::Time));
    let _unused = b.unary(UnaryOp::Exp, x);
    let two = b.constant(2.0);
    let wanted = b.binary(BinaryOp::Mul, y, two);
    let program = b.finish(&[wanted]);
    assert_eq!(program.inputs(), [Input::Time]);
    assert_eq!((program.n_operations(), program.work_size()), (1, 3));
    let placed = b.finish_with_inputs(&[wanted], &[Input::Slot(7), Input::Time]);
    let mut out = [0.0];
    placed.run(&[9.0, 4.0], &mut Work::default(), &mut out);
    assert_eq!(out, [8.0]);
}

#[test]
fn zeros_and_ones_are_structure_when_asked() {
    let mut b = Builder::new(Folding::Structural);
    let x = b.input(Input::Slot(0));
    let [zero, one, minus] = [0.0, 1.0, -1.0].map(|c| b.constant(c));
    assert_eq!(b.binary(BinaryOp::Mul, zero, x), zero);
    assert_eq!(b.binary(BinaryOp::Add, x, zero), x);
    assert_eq!(b.binary(BinaryOp::Mul, one, x), x);
    assert_eq!(b.binary(BinaryOp::Sub, x, x), zero);
    assert_eq!(b.binary(BinaryOp::Div, zero, x), zero);
    let negative = b.unary(UnaryOp::Neg, x);
    assert_eq!(b.binary(BinaryOp::Mul, x, minus), negative);
    assert_eq!(b.unary(UnaryOp::Neg, negative), x);
    let mut strict = Builder::new(Folding::Strict);
    let x = strict.input(Input::Slot(0));
    let zero = strict.constant(0.0);
    assert_ne!(strict.binary(BinaryOp::Mul, zero, x), zero);
    assert_ne!(strict.binary(BinaryOp::Add, x, zero), x);
}

#[test]
fn registers_are_used_again() {
    // a long sum needs few registers, in whatever order it was recorded
    let mut b = Builder::new(Folding::Strict);
    let terms: Vec<Value> = (0..1000)
        .map(|k| {
            let x = b.input(Input::Slot(k % 5));
            let c = b.constant(f64::from(k));
            b.binary(BinaryOp::Mul, x, c)
        })
        .collect();
    let sum = terms
        .into_iter()
        .reduce(|s, t| b.binary(BinaryOp::Add, s, t))
        .unwrap();
    let program = b.finish(&[sum]);
    let fixed = 5 + 999;
    assert!(program.work_size() <= fixed + 3, "{}", program.work_size());
}

/// Where there is no translation, this says nothing of it.
#[test]
fn programs_that_run_often_are_translated() {
    let mut builder = Builder::new(Folding::Strict);
    let t = builder.input(Input::Time);
    let square = builder.binary(BinaryOp::Mul, t, t);
    let program = builder.finish(&[square]);
    let best = match program.with_engine(Engine::Native) {
        Some(native) => native.engine(),
        None => Engine::Interpreter,
    };
    let copy = program.clone();
    let mut work = Work::default();
    assert_eq!(program.value(&[3.0], &mut work), 9.0);
    assert_eq!(program.engine(), Engine::Interpreter);
    for k in 0..10_000 {
        assert_eq!(program.value(&[f64::from(k)], &mut work), f64::from(k * k));
    }
    assert_eq!(program.engine(), best);
    // copies share the translation, and run over the same registers
    assert_eq!(copy.engine(), best);
    drop(program);
    assert_eq!(copy.value(&[4.0], &mut work), 16.0);
}

#[cfg(feature = "solver")]
#[test]
fn a_program_of_which_many_runs_are_expected_is_translated_before_the_first() {
    let square = || {
        let mut builder = Builder::new(Folding::Strict);
        let t = builder.input(Input::Time);
        let square = builder.binary(BinaryOp::Mul, t, t);
        builder.finish(&[square])
    };
    let best = match square().with_engine(Engine::Native) {
        Some(native) => native.engine(),
        None => Engine::Interpreter,
    };
    let (few, many) = (square(), square());
    few.expect_runs(10);
    assert_eq!(few.engine(), Engine::Interpreter);
    many.expect_runs(1_000_000);
    assert_eq!(many.engine(), best);
    let run = |program: &Program| program.value(&[1.1], &mut Work::default()).to_bits();
    assert_eq!(run(&few), run(&many));
}

#[test]
fn a_program_without_outputs_runs() {
    let builder = Builder::new(Folding::Strict);
    let program = builder.finish(&[]);
    program.run(&[], &mut Work::default(), &mut []);
    assert!(program.with_engine(Engine::Native).is_none());
}

#[test]
fn more_values_than_the_processor_has_registers_are_kept() {
    // all sums are needed until the end, in the order in which they were made and in the contrary
    // one
    let n = 60;
    let mut builder = Builder::new(Folding::Strict);
    let inputs: Vec<Value> = (0..n).map(|k| builder.input(Input::Slot(k))).collect();
    let sums: Vec<Value> = inputs
        .windows(2)
        .map(|pair| builder.binary(BinaryOp::Add, pair[0], pair[1]))
        .collect();
    let mut there = sums[0];
    for &sum in &sums {
        there = builder.binary(BinaryOp::Sub, sum, there);
    }
    let mut back = there;
    for &sum in sums.iter().rev() {
        back = builder.binary(BinaryOp::Mul, back, sum);
    }
    let program = builder.finish(&[back, there]);
    let numbers: Vec<f64> = (0..n).map(|k| 0.2 + 0.01 * f64::from(k * k % 17)).collect();
    let (mut run, mut evaluated) = ([0.0; 2], [0.0; 2]);
    program.eval(&numbers, &mut Work::default(), &mut evaluated);
    for engine in engines(&program) {
        engine.run(&numbers, &mut Work::default(), &mut run);
        assert_eq!(run, evaluated);
    }
}

#[test]
fn long_programs_need_no_stack() {
    // an alternating sum of products, an IF now and then
    let mut b = Builder::new(Folding::Strict);
    let inputs = [0, 1, 2].map(|k| b.input(Input::Slot(k)));
    let mut v = inputs[0];
    let want = |x: &[f64; 3]| {
        let mut v = x[0];
        for k in 0..50_000usize {
            let (a, c) = (x[k % 3], (k % 17) as f64 * 0.125 - 1.0);
            v = (v * a - c) * 0.25;
            if k % 7 == 0 {
                v = if v < 0.0 {
                    v * v + a
                } else if v > 0.0 {
                    v - a * a
                } else {
                    1.0
                };
            }
        }
        v
    };
    for k in 0..50_000usize {
        let (a, c) = (inputs[k % 3], b.constant((k % 17) as f64 * 0.125 - 1.0));
        let quarter = b.constant(0.25);
        v = b.binary(BinaryOp::Mul, v, a);
        v = b.binary(BinaryOp::Sub, v, c);
        v = b.binary(BinaryOp::Mul, v, quarter);
        if k % 7 == 0 {
            let square = b.binary(BinaryOp::Mul, v, v);
            let negative = b.binary(BinaryOp::Add, square, a);
            let square = b.binary(BinaryOp::Mul, a, a);
            let positive = b.binary(BinaryOp::Sub, v, square);
            let one = b.constant(1.0);
            v = b.arithmetic_if(v, negative, one, positive);
        }
    }
    let program = b.finish(&[v]);
    let run = std::thread::Builder::new()
        .stack_size(128 * 1024)
        .spawn(move || {
            let mut work = Work::default();
            engines(&program)
                .flat_map(|program| {
                    [[0.5, -1.5, 0.75], [-2.0, 0.3, 1.9]]
                        .map(|x| (program.value(&x, &mut work), want(&x)))
                })
                .collect::<Vec<_>>()
        });
    for (got, want) in run.unwrap().join().unwrap() {
        assert_eq!(got, want);
    }
}

#[test]
fn recording_looks_at_few_places_per_node() {
    let mut b = Builder::new(Folding::Structural);
    let mut v = b.input(Input::Time);
    let n = 100_000;
    for k in 0..n {
        // numbers with many zeros in their last bits are the hard case for a hash
        let c = b.constant(f64::from(k) + 0.5);
        let w = b.binary(BinaryOp::Mul, v, c);
        v = b.binary(BinaryOp::Add, w, c);
    }
    assert_eq!(b.finish(&[v]).n_operations(), 2 * n as usize);
    let (probes, most) = (b.known.probes, 3 * 5 * n as u64);
    assert!(probes < most, "{probes} probes");
}
/// Value and derivatives choose by the same two conditions, and the derivative by each needs the
/// value of the other.
#[test]
fn selections_that_need_each_other_crosswise_are_not_placed_together() {
    let mut b = Builder::new(Folding::Strict);
    let (x, half) = (b.input(Input::Slot(0)), b.constant(0.5));
    let sum = b.binary(BinaryOp::Add, x, half);
    let condition = b.compare(Comparison::Lt, half, sum);
    let quotient = b.binary(BinaryOp::Div, half, x);
    let first = b.select(condition, half, quotient);
    let inner = b.arithmetic_if(x, half, half, half);
    let second = b.arithmetic_if(x, inner, half, x);
    let product = b.binary(BinaryOp::Mul, first, second);
    let program = b.finish(&[product]).with_gradient(&[Input::Slot(0)]);
    let mut out = [0.0; 2];
    // x > 0: x/2; x < 0: 1/(4x)
    for (x, want) in [(2.0, [1.0, 0.5]), (-0.25, [-1.0, -4.0])] {
        program.run(&[x], &mut Work::default(), &mut out);
        assert_eq!(out, want);
        program.eval(&[x], &mut Work::default(), &mut out);
        assert_eq!(out, want);
    }
}

#[test]
fn a_held_magnitude_has_a_held_derivative() {
    let mut b = Builder::new(Folding::Strict);
    let x = b.input(Input::Slot(0));
    let magnitude = b.unary(UnaryOp::Abs, x);
    let outputs = [magnitude, b.gradient(magnitude, &[x])[0]];
    let (held, differences) = b.held(&outputs, &outputs, |_| Input::Slot(1));
    assert_eq!((differences.len(), differences[0]), (1, x));
    let program = b.finish_with_inputs(&held, &[Input::Slot(0), Input::Slot(1)]);
    let mut out = [0.0; 2];
    for (point, want) in [([-0.1, 1.0], [-0.1, 1.0]), ([-0.1, -1.0], [0.1, -1.0])] {
        program.run(&point, &mut Work::default(), &mut out);
        assert_eq!(out, want);
    }
}

#[test]
fn a_difference_and_its_contrary_are_one_switch() {
    let mut b = Builder::new(Folding::Strict);
    let (x, y) = (b.input(Input::Slot(0)), b.input(Input::Slot(1)));
    let larger = b.call(Function::Max, &[x, y]);
    let larger = b.expanded(&[larger], expand::Expand::Calls)[0];
    assert_eq!(b.switching(&[larger]).len(), 1);
    let (held, _) = b.held(&[larger], &[larger], |_| Input::Slot(2));
    let program = b.finish_with_inputs(&held, &layout());
    let mut out = [0.0];
    for (side, want) in [(1.0, 3.0), (-1.0, 4.0)] {
        program.run(&[3.0, 4.0, side, 0.0], &mut Work::default(), &mut out);
        assert_eq!(out, [want], "held on the side {side}");
    }
}

#[test]
fn sums_of_which_a_part_goes_and_constants_that_meet_are_one_operation() {
    let mut b = Builder::new(Folding::Structural);
    let (x, y) = (b.input(Input::Slot(0)), b.input(Input::Slot(1)));
    let (two, three) = (b.constant(2.0), b.constant(3.0));
    let minus_y = b.unary(UnaryOp::Neg, y);
    let sum = b.binary(BinaryOp::Add, x, y);
    let difference = b.binary(BinaryOp::Sub, x, y);
    for (op, left, right, want) in [
        (BinaryOp::Sub, sum, x, y),
        (BinaryOp::Sub, sum, y, x),
        (BinaryOp::Sub, x, sum, minus_y),
        (BinaryOp::Sub, difference, x, minus_y),
        (BinaryOp::Sub, x, difference, y),
        (BinaryOp::Add, difference, y, x),
        (BinaryOp::Add, y, difference, x),
    ] {
        assert_eq!(b.binary(op, left, right), want, "{op:?}");
    }
    let (six, five, one, minus_one) = (
        b.constant(6.0),
        b.constant(5.0),
        b.constant(1.0),
        b.constant(-1.0),
    );
    let more = b.binary(BinaryOp::Add, x, three);
    let less = b.binary(BinaryOp::Sub, three, x);
    let twice = b.binary(BinaryOp::Mul, two, x);
    for (op, left, right, (want, c, v)) in [
        (BinaryOp::Mul, three, twice, (BinaryOp::Mul, six, x)),
        (BinaryOp::Add, more, two, (BinaryOp::Add, five, x)),
        (BinaryOp::Sub, more, two, (BinaryOp::Add, one, x)),
        (BinaryOp::Sub, two, more, (BinaryOp::Sub, minus_one, x)),
        (BinaryOp::Add, less, two, (BinaryOp::Sub, five, x)),
        (BinaryOp::Sub, two, less, (BinaryOp::Add, minus_one, x)),
    ] {
        assert_eq!(b.binary(op, left, right), b.binary(want, c, v), "{op:?}");
    }
    // to the bit, nothing of this holds
    b.set_folding(Folding::Strict);
    assert_ne!(b.binary(BinaryOp::Sub, sum, x), y);
}

#[test]
fn an_output_depends_on_what_it_has_a_derivative_by() {
    let mut b = Builder::new(Folding::Strict);
    let slots = [0, 1, 2, 3].map(|k| b.input(Input::Slot(k)));
    let [x, y, z, w] = slots;
    let product = b.binary(BinaryOp::Mul, x, y);
    let smaller = b.compare(Comparison::Lt, w, x);
    let either = b.select(smaller, product, z);
    let larger = b.call(Function::Max, &[z, w]);
    let program = b.finish_with_inputs(&[product, smaller, either, larger, y], &layout());
    // directions: of x alone, of y and z together, of w
    let along = [vec![0], vec![1], vec![1], vec![70]];
    let dependence = program.dependence(&along);
    let wanted: [&[u32]; 5] = [&[0, 1], &[], &[0, 1], &[1, 70], &[1]];
    for (found, wanted) in dependence.iter().zip(wanted) {
        assert_eq!(found, wanted);
    }
}

#[test]
fn straight_pieces_are_told_from_functions_that_come_back() {
    let mut b = Builder::new(Folding::Strict);
    let slots = [0, 1, 2].map(|k| b.input(Input::Slot(k)));
    let [x, y, z] = slots;
    let [two, level] = [2.0, 100.0].map(|c| b.constant(c));
    let double = b.binary(BinaryOp::Mul, two, x);
    let beyond = b.binary(BinaryOp::Sub, double, level);
    let magnitude = b.unary(UnaryOp::Abs, beyond);
    let scaled = b.binary(BinaryOp::Div, magnitude, y);
    let sine = b.unary(UnaryOp::Sin, z);
    let either = b.arithmetic_if(scaled, two, sine, beyond);
    let program = b.finish_with_inputs(&[either], &layout());
    assert_eq!(program.bends(&[0, 1, 2, 3]), [false, true, true, false]);
    assert_eq!(program.bends(&[2, 0]), [true, false]);
}
