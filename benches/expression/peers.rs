//! The public evaluators, each as fast as its interface allows.
//!
//! fasteval: compiled, with bound variables (the used inputs are copied into them) and native callbacks for functions it lacks.
//! exmex: flat expressions with custom operators for clamping; it has no comparison and no functions of two arguments.

use super::{CHEBY, Case, Contestant, FORCOS, SLOTS, dual};
use exmex::prelude::*;
use exmex::{MakeOperators, Operator};
use fasteval::{Compiler as _, Evaler as _};

const NAMES: [&str; SLOTS] = ["t", "dx", "dy", "dz", "vx", "vy", "vz", "vr"];

/// fasteval 0.2; `None` where the case cannot be said in its language.
pub fn fasteval<'a>(case: &Case, points: &'a [[f64; SLOTS]]) -> Option<Contestant<'a>> {
    let text = case.peers[0];
    if text.is_empty() {
        return None;
    }
    let mut slab = fasteval::Slab::with_capacity(4096);
    let variables: Box<[f64; SLOTS]> = Box::new([0.0; SLOTS]);
    let variables = Box::into_raw(variables);
    for (k, name) in NAMES.iter().enumerate() {
        // SAFETY: the variables live as long as the process
        unsafe {
            slab.ps
                .add_unsafe_var((*name).to_string(), &(*variables)[k])
        };
    }
    let parsed = fasteval::Parser::new().parse(text, &mut slab.ps);
    let parsed = parsed.unwrap_or_else(|e| panic!("fasteval: {text}: {e}"));
    let compiled = parsed.from(&slab.ps).compile(&slab.ps, &mut slab.cs);
    let slots = case.slots.to_vec();
    Some(Box::new(move |k| {
        for &slot in &slots {
            // SAFETY: only this closure and the evaluation that it runs use the variables
            unsafe { (*variables)[slot] = points[k][slot] };
        }
        compiled.eval(&slab, &mut callback).unwrap_or(f64::NAN)
    }))
}

/// The functions that fasteval lacks, constant arguments built in.
fn callback(name: &str, args: Vec<f64>) -> Option<f64> {
    let x = *args.first()?;
    Some(match name {
        "sqrt" => x.sqrt(),
        "atan" => x.atan(),
        "step_a" => dual::step(x, 0.5, 0.0, 1.0, 1.0),
        "step_b" => dual::step(x, 1.0, 0.0, 2.0, -2.0),
        "step_c" => dual::step(x, 2.5, 0.0, 3.2, 1.5),
        "step_d" => dual::step(x, 3.5, 0.0, 4.1, -0.5),
        "impact" => dual::impact(x, *args.get(1)?, 1.0, 1.0e5, 1.5, 50.0, 0.1),
        "bistop" => dual::bistop(x, *args.get(1)?, -0.5, 0.5, 1.0e5, 2.2, 50.0, 0.1),
        "cheby" => dual::cheby(x, 1.0, &CHEBY),
        "forcos" => dual::forcos(x, 0.1, 2.0 * std::f64::consts::PI, &FORCOS),
        _ => return None,
    })
}

/// exmex with operators of our own.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Operators;

impl MakeOperators<f64> for Operators {
    fn make<'a>() -> Vec<Operator<'a, f64>> {
        let mut operators = exmex::FloatOpsFactory::<f64>::make();
        operators.push(Operator::make_unary("relu", |x: f64| x.max(0.0)));
        operators.push(Operator::make_unary("smooth", |x: f64| {
            let u = x.clamp(0.0, 1.0);
            u * u * (3.0 - 2.0 * u)
        }));
        operators
    }
}

/// exmex 0.21; `None` where the case cannot be said in its language.
pub fn exmex<'a>(case: &Case, points: &'a [[f64; SLOTS]]) -> Option<Contestant<'a>> {
    let text = case.peers[1];
    if text.is_empty() {
        return None;
    }
    let flat = exmex::FlatEx::<f64, Operators>::parse(text)
        .unwrap_or_else(|e| panic!("exmex: {text}: {e}"));
    let slots: Vec<usize> = flat
        .var_names()
        .iter()
        .filter_map(|name| NAMES.iter().position(|n| n == name))
        .collect();
    let mut values = vec![0.0; slots.len()];
    Some(Box::new(move |k| {
        for (value, &slot) in values.iter_mut().zip(&slots) {
            *value = points[k][slot];
        }
        flat.eval(&values).unwrap_or(f64::NAN)
    }))
}
