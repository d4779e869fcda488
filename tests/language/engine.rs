//! The engines agree: walker, machine, batch, duals, jets, germs and the adjoint compute one thing from random expressions.

use crate::counting;
use crate::expressions;

use cognate::expr::ast::{Ast, Dialect};
use cognate::expr::compile::compile;
use cognate::expr::program::{Engine, Input, Program, Work};
use cognate::expr::walk::{self, Host};
use cognate::scalar::{Dual, Germ, Jet, Scalar};
use counting::allocations_so_far;
use expressions::{Anything, Contents, ENGINES, bindings, engines_agree, tree};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use std::cell::Cell;

const DIALECTS: [Dialect; 2] = [Dialect::Function, Dialect::Expression];

/// Some hundred trees that compile, the same each time, with a time.
fn trees(n: usize) -> Vec<(Ast, f64)> {
    let mut runner = TestRunner::deterministic();
    let strategy = (
        prop::collection::vec(any::<u8>(), 1..150),
        -3.0..3.0,
        any::<bool>(),
    );
    std::iter::repeat_with(|| strategy.new_tree(&mut runner).unwrap().current())
        .map(|(bytes, time, second)| {
            (
                tree(&bytes, Contents::all(DIALECTS[usize::from(second)])),
                time,
            )
        })
        .filter(|(ast, _)| compile(&[ast], &bindings()).is_ok())
        .take(n)
        .collect()
}

fn host(time: f64) -> Anything {
    Anything {
        time,
        bindings: bindings(),
    }
}

fn values(program: &Program, time: f64) -> Vec<f64> {
    let host = host(time);
    program
        .inputs()
        .iter()
        .map(|&i| host.input(i).unwrap_or(f64::NAN))
        .collect()
}

fn over<S: Scalar>(program: &Program, inputs: &[S]) -> S {
    let mut out = [S::constant(f64::NAN)];
    program.eval(inputs, &mut Work::default(), &mut out);
    out[0]
}

/// Limit, slope and curvature along one input, with error estimates, where both sides agree: where derivatives have a meaning.
fn smooth_derivatives(program: &Program, inputs: &[f64], k: usize) -> Option<[(f64, f64); 3]> {
    let side = |sign: f64| {
        let germs: Vec<Germ> = inputs
            .iter()
            .enumerate()
            .map(|(j, &x)| Germ::line(x, if j == k { sign } else { 0.0 }))
            .collect();
        let germ = over(program, &germs);
        [0, 1, 2].map(|order| {
            let (d, noise) = germ.derivative_at(order);
            (if order == 1 { sign * d } else { d }, noise)
        })
    };
    let (after, before) = (side(1.0), side(-1.0));
    let agree = after.iter().zip(&before).all(|(a, b)| {
        (a.0 - b.0).abs() <= 100.0 * (a.1 + b.1) + 1e-9 * a.0.abs() && a.0.is_finite()
    });
    agree.then_some(after)
}

/// Whether a number agrees with a derivative of a germ: to 1e-9, which leaves seven digits for the roundings of long chains, or to
/// what the germ thinks they may be.
fn near(x: f64, (d, noise): (f64, f64)) -> bool {
    (x - d).abs() <= 1e-9 * d.abs() + 1e4 * noise + f64::MIN_POSITIVE
}

#[test]
fn duals_jets_and_batches_carry_the_value_to_the_bit() {
    for (ast, time) in trees(1500) {
        let program = compile(&[&ast], &bindings()).unwrap();
        let inputs = values(&program, time);
        let mut out = [0.0];
        program.run(&inputs, &mut Work::default(), &mut out);
        let value = out[0];
        let same = |other: f64| other == value || other.is_nan() && value.is_nan();
        assert!(same(program.value(&inputs, &mut Work::default())), "{ast}");
        let duals: Vec<Dual<2>> = inputs
            .iter()
            .map(|&x| Dual {
                re: x,
                eps: [1.0, 0.5],
            })
            .collect();
        assert!(same(over(&program, &duals).re), "{ast}: dual");
        let jets: Vec<Jet> = inputs.iter().map(|&x| Jet::variable(x)).collect();
        assert!(same(over(&program, &jets).value), "{ast}: jet");
        // a batch of seventy points, of which this is the last
        let columns: Vec<Vec<f64>> = {
            let rows: Vec<Vec<f64>> = (0..70)
                .map(|k| values(&program, time + f64::from(69 - k) / 16.0))
                .collect();
            (0..inputs.len())
                .map(|j| rows.iter().map(|r| r[j]).collect())
                .collect()
        };
        let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let mut results = [f64::NAN; 70];
        (program.batch().run(&columns, &mut [&mut results])).expect("columns that fit");
        assert!(
            same(results[69]),
            "{ast}: batch {} and {value}",
            results[69]
        );
        if let Ok(walked) = walk::value(&ast, &host(time)) {
            assert_eq!(walked.to_bits(), value.to_bits(), "{ast}: walker");
        }
    }
}

/// Holds many trees to a law that counts what it compared; a failure names the smallest part that breaks it.
fn hold(least: usize, law: impl Fn(&Ast, f64) -> Result<usize, String>) {
    let mut compared = 0;
    for (ast, time) in trees(1500) {
        match law(&ast, time) {
            Ok(n) => compared += n,
            Err(said) => {
                let part = |k: usize| Ast {
                    nodes: ast.nodes[..=k].to_vec(),
                    spans: ast.spans[..=k].to_vec(),
                    root: k as u32,
                    dialect: ast.dialect,
                    names: ast.names.clone(),
                };
                let parts = (0..ast.nodes.len()).map(part);
                let broken = |part: Ast| {
                    let known = compile(&[&part], &bindings()).is_ok();
                    let said = law(&part, time).err().filter(|_| known)?;
                    Some(format!("{part}: {said}"))
                };
                let smallest = parts
                    .filter(|p| compile(&[p], &bindings()).is_ok())
                    .find_map(broken);
                panic!(
                    "at {time}: {}\nin {ast}: {said}",
                    smallest.unwrap_or_default()
                );
            }
        }
    }
    assert!(compared >= least, "{compared} numbers that are not zero");
}

#[test]
fn adjoint_and_forward_derivatives_are_those_of_the_germ() {
    let edges = Cell::new(0);
    hold(500, |ast, time| {
        let program = compile(&[ast], &bindings()).unwrap();
        let inputs = values(&program, time);
        let gradient = program.with_gradient(program.inputs());
        let mut out = vec![0.0; 1 + inputs.len()];
        gradient.run(&inputs, &mut Work::default(), &mut out);
        let mut compared = 0;
        // arguments without a value have no derivative either, though a function may ignore them
        if walk::value(ast, &host(time)).is_err() {
            return Ok(0);
        }
        for k in 0..inputs.len() {
            let Some(derivatives) = smooth_derivatives(&program, &inputs, k) else {
                continue;
            };
            let dual = |j: usize| Dual {
                re: inputs[j],
                eps: [f64::from(u8::from(j == k))],
            };
            let duals: Vec<Dual<1>> = (0..inputs.len()).map(dual).collect();
            let forward = over(&program, &duals).eps[0];
            for (engine, slope) in [("dual", forward), ("adjoint", out[1 + k])] {
                // an adjoint multiplies out 0·∞ where an operation stands at the edge of its domain, as ACOS at 1
                if slope.is_nan() && engine == "adjoint" {
                    edges.set(edges.get() + 1);
                    continue;
                }
                if !near(slope, derivatives[1]) {
                    return Err(format!(
                        "{engine} {slope}, germ {:?} by {}",
                        derivatives[1],
                        program.inputs()[k]
                    ));
                }
            }
            compared += usize::from(derivatives[1].0 != 0.0);
        }
        Ok(compared)
    });
    assert!(edges.get() < 10, "{} adjoints without a value", edges.get());
}

#[test]
fn jets_have_the_rate_and_acceleration_of_the_germ() {
    hold(150, |ast, time| {
        let program = compile(&[ast], &bindings()).unwrap();
        let Some(k) = program.inputs().iter().position(|&i| i == Input::Time) else {
            return Ok(0);
        };
        let inputs = values(&program, time);
        let Some(derivatives) = smooth_derivatives(&program, &inputs, k) else {
            return Ok(0);
        };
        let jet = |j: usize| {
            if j == k {
                Jet::variable(inputs[j])
            } else {
                Jet::constant(inputs[j])
            }
        };
        let jet = over(&program, &(0..inputs.len()).map(jet).collect::<Vec<_>>());
        if near(jet.first, derivatives[1]) && near(jet.second, derivatives[2]) {
            Ok(usize::from(derivatives[2].0 != 0.0))
        } else {
            Err(format!(
                "jet {} {}, germ {:?}",
                jet.first,
                jet.second,
                &derivatives[1..]
            ))
        }
    });
}

#[test]
fn duals_have_the_slope_of_the_walkers_differences() {
    hold(200, |ast, time| {
        let program = compile(&[ast], &bindings()).unwrap();
        let h = 1e-4;
        // all inputs of `Anything` that vary run with time
        let walked = |t: f64| walk::value(ast, &host(t)).ok();
        let quotient = |h: f64| Some((walked(time + h)? - walked(time - h)?) / (2.0 * h));
        let duals: Vec<Dual<1>> = program
            .inputs()
            .iter()
            .zip(values(&program, time))
            .map(|(&i, re)| Dual {
                re,
                eps: [f64::from(u8::from(i != Input::Mode))],
            })
            .collect();
        let slope = over(&program, &duals).eps[0];
        let along = |sign: f64| {
            let line = |d: &Dual<1>| Germ::line(d.re, sign * d.eps[0]);
            over(&program, &duals.iter().map(line).collect::<Vec<_>>())
        };
        // a place where differences drown in rounding
        let (limit, noise) = along(1.0).derivative_at(0);
        if limit.is_nan() || noise / h > 1e-6 {
            return Ok(0);
        }
        let (before, after) = (
            -along(-1.0).derivative_at(1).0,
            along(1.0).derivative_at(1).0,
        );
        let kink = before.is_nan() || after.is_nan();
        let (Some(wide), Some(middle), Some(narrow), Some(value)) = (
            quotient(h),
            quotient(h / 2.0),
            quotient(h / 4.0),
            walked(time),
        ) else {
            return Ok(0);
        };
        // differences that have settled, no kink right here, and numbers whose neighbours are near
        let tolerance = 1e-5 * (1.0 + narrow.abs());
        let settled = (wide - middle).abs() < tolerance && (middle - narrow).abs() < tolerance;
        if !settled || kink || (before - after).abs() > tolerance || value.abs() > 1e6 {
            return Ok(0);
        }
        if (slope - narrow).abs() < 20.0 * tolerance {
            Ok(usize::from(slope != 0.0))
        } else {
            Err(format!("dual {slope}, differences {narrow}"))
        }
    });
}

#[test]
fn expressions_compiled_together_give_what_each_gives_alone() {
    for group in trees(900).chunks(3) {
        let asts: Vec<&Ast> = group.iter().map(|(ast, _)| ast).collect();
        let time = group[0].1;
        let together = compile(&asts, &bindings()).unwrap();
        let mut out = vec![0.0; asts.len()];
        together.run(&values(&together, time), &mut Work::default(), &mut out);
        let mut alone = 0;
        for (ast, shared) in asts.iter().zip(&out) {
            let program = compile(&[ast], &bindings()).unwrap();
            let single = program.value(&values(&program, time), &mut Work::default());
            assert!(
                single == *shared || single.is_nan() && shared.is_nan(),
                "{ast}: {single} alone, {shared} together"
            );
            alone += program.n_operations();
        }
        assert!(
            together.n_operations() <= alone,
            "{} and {alone} operations",
            together.n_operations()
        );
    }
}

#[test]
fn evaluating_allocates_nothing() {
    for (ast, time) in trees(300) {
        let program = compile(&[&ast], &bindings()).unwrap();
        let gradient = program.with_gradient(program.inputs());
        let inputs = values(&program, time);
        let duals: Vec<Dual<3>> = inputs
            .iter()
            .map(|&x| Dual {
                re: x,
                eps: [1.0; 3],
            })
            .collect();
        let jets: Vec<Jet> = inputs.iter().map(|&x| Jet::variable(x)).collect();
        let columns: Vec<[f64; 64]> = inputs.iter().map(|&x| [x; 64]).collect();
        let columns: Vec<&[f64]> = columns.iter().map(|c| &c[..]).collect();
        let mut batch = program.batch();
        let (mut plain, mut other, mut dual, mut jet) = (
            Work::default(),
            Work::default(),
            Work::default(),
            Work::default(),
        );
        let (mut one, mut all) = ([0.0], vec![0.0; 1 + inputs.len()]);
        let (mut dual_out, mut jet_out) = ([Dual::constant(0.0)], [Jet::constant(0.0)]);
        let mut column = [0.0; 64];
        let mut round = |program: &Program, gradient: &Program| {
            program.run(&inputs, &mut plain, &mut one);
            gradient.run(&inputs, &mut other, &mut all);
            program.eval(&duals, &mut dual, &mut dual_out);
            program.eval(&jets, &mut jet, &mut jet_out);
            batch
                .run(&columns, &mut [&mut column])
                .expect("columns that fit");
        };
        for engine in ENGINES {
            let of = |program: &Program| program.with_engine(engine);
            let (Some(program), Some(gradient)) = (of(&program), of(&gradient)) else {
                continue;
            };
            round(&program, &gradient);
            let before = allocations_so_far();
            round(&program, &gradient);
            assert_eq!(allocations_so_far() - before, 0, "{ast}: {engine:?}");
        }
    }
}

/// A program allocates when its work is laid out and, once, when it is translated.
#[test]
fn a_translation_is_made_once() {
    let (ast, time) = &trees(1)[0];
    let program = compile(&[ast], &bindings()).unwrap();
    let inputs = values(&program, *time);
    let (mut work, mut out) = (Work::default(), [0.0]);
    program.run(&inputs, &mut work, &mut out);
    let mut busy = 0;
    for _ in 0..20_000 {
        let before = allocations_so_far();
        program.run(&inputs, &mut work, &mut out);
        busy += usize::from(allocations_so_far() > before);
    }
    assert_eq!(busy == 1, program.engine() == Engine::Native);
    assert!(busy <= 1, "{busy} runs that allocate");
}

#[test]
fn both_engines_give_the_same_bits() {
    for (ast, time) in trees(1500) {
        engines_agree(&ast, time);
    }
}
