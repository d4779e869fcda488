//! Functions of the model that have no value where a simulation cannot go on, or grow without
//! bound: the operation, with its numbers.
//!
//! A step that fails is shortened until it ends just before the place where a function loses its
//! value. So all functions are evaluated there and a little later, along the rates that were found
//! there. Before a pole a function has values all the time; its divisor has nearly gone to zero
//! against that of a little later.

use crate::diagnostic::Cause;
use crate::expr::Expr;
use crate::expr::ast::{Ast, BinaryOp, Callee, Node, NodeIx};
use crate::expr::functions::Function;
use crate::expr::program::{Input, Work};
use crate::expr::walk;
use crate::model::ElementId;
use crate::scalar::Scalar;
use crate::scene::asker::Asker;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::scene::layout::Layout;
use std::fmt;

/// Times after the last state at which functions are evaluated, as parts of its time, or of a unit
/// of time.
const LATER: [f64; 6] = [0.0, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3];

/// Divisor at a pole, at most, as a part of the divisor a little later.
const VANISHING_DIVISOR: f64 = 1e-8;

/// A function that has no value, or soon none.
#[derive(Clone, Debug, PartialEq)]
pub struct Valueless {
    /// "SFORCE/1 FUNCTION"
    pub function: Asker,
    /// the way in which it loses its value
    pub loss: Loss,
}

/// The way in which a function loses its value.
#[derive(Clone, Debug, PartialEq)]
pub enum Loss {
    /// an operation is asked for what it has no value for: "SQRT of -0.01 has no value"
    Domain(String),
    /// no operation is to blame
    NotFinite,
    /// an operation divides by what goes to zero
    Pole {
        /// its text
        operation: String,
        /// the value it has reached
        value: f64,
        /// when
        at: f64,
    },
}

impl fmt::Display for Valueless {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.function;
        match &self.loss {
            Loss::Domain(why) => write!(f, "{name}: {why}"),
            Loss::NotFinite => write!(f, "{name} has no finite value"),
            Loss::Pole {
                operation,
                value,
                at,
            } => write!(
                f,
                "{name}: {operation} grows without bound, to {value:.3e} at TIME = {at}"
            ),
        }
    }
}

/// Finds the function that has no value at the numbers of the last state or just after it; `None`:
/// all have values that stay bounded. States downstream of the mechanism have the rates that are
/// given, or none.
pub fn find(scene: Configured<'_>, numbers: &[f64], downstream: &[f64]) -> Option<Valueless> {
    let mut rates = Equations::new(scene, numbers).rates();
    rates.extend(downstream);
    let unit = numbers[Layout::TIME].abs().max(1.0);
    let then = |later: f64| {
        let dt = later * unit;
        let mut then = numbers.to_vec();
        then[Layout::TIME] += dt;
        for (y, rate) in then[scene.layout.states()].iter_mut().zip(&rates) {
            *y += if rate.is_finite() { rate * dt } else { 0.0 };
        }
        then
    };
    let lost = LATER
        .iter()
        .find_map(|&later| there(scene, &then(later), |_| true));
    // where the rates grow as well, time alone tells more
    lost.or_else(|| {
        let mut passed = numbers.to_vec();
        passed[Layout::TIME] += LATER[LATER.len() - 1] * unit;
        let poles = [then(1e-6), passed];
        poles.iter().find_map(|then| pole(scene, numbers, then))
    })
}

/// Finds the first operation that divides by what is nearly zero now, but not then.
fn pole(scene: Configured<'_>, now: &[f64], then: &[f64]) -> Option<Valueless> {
    let [at_now, at_then] = [now, then].map(|numbers| Equations::new(scene, numbers));
    scene.formulas.iter().find_map(|f| {
        let expr = Expr::parse(&f.text).ok()?;
        let values = [&at_now, &at_then].map(|at| {
            let host = |input: Input| match input {
                Input::Delayed(_) | Input::Slot(_) => None,
                _ => Some(at.input(input, &f.owner)),
            };
            walk::values(expr.ast(), &host).ok()
        });
        let [Some(here), Some(later)] = values else {
            return None;
        };
        let ix = (0..here.len() as NodeIx).find(|&ix| {
            let divisor = |values: &[Option<f64>]| divisor(expr.ast(), ix, values);
            match (divisor(&here), divisor(&later)) {
                (Some(here), Some(later)) => here.abs() < VANISHING_DIVISOR * later.abs(),
                _ => false,
            }
        })?;
        Some(Valueless {
            function: f.owner.clone(),
            loss: Loss::Pole {
                operation: expr.ast().written(ix),
                value: here[ix as usize].unwrap_or(f64::NAN),
                at: now[Layout::TIME],
            },
        })
    })
}

/// Returns the divisor of an operation, also of one that could be written as a quotient.
fn divisor(ast: &Ast, ix: NodeIx, values: &[Option<f64>]) -> Option<f64> {
    let value = |ix: NodeIx| values[ix as usize];
    match *ast.node(ix) {
        Node::Binary(BinaryOp::Div, _, b) => value(b),
        Node::Binary(BinaryOp::Pow, a, b) => value(b).filter(|&b| b < 0.0).and(value(a)),
        Node::Call {
            callee: Callee::Function(Function::Tan),
            ref args,
        } => args.first().and_then(|&x| value(x)).map(Scalar::cos),
        _ => None,
    }
}

/// Finds the first function that has no value at these numbers, among those whose elements are
/// `asked` for.
pub fn there(
    scene: Configured<'_>,
    numbers: &[f64],
    asked: impl Fn(Option<ElementId>) -> bool,
) -> Option<Valueless> {
    let at = Equations::new(scene, numbers);
    let formulas = scene.formulas.iter().filter(|f| asked(f.owner.owner()));
    formulas.into_iter().find_map(|f| {
        let inputs = f.program.inputs();
        if inputs
            .iter()
            .any(|i| matches!(i, Input::Delayed(_) | Input::Slot(_)))
        {
            return None;
        }
        let values: Vec<f64> = inputs.iter().map(|&i| at.input(i, &f.owner)).collect();
        // what it reads has no value: that is the one to blame
        if !values.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut out = [0.0];
        f.program.eval(&values, &mut Work::default(), &mut out);
        if out[0].is_finite() {
            return None;
        }
        let host = |input: Input| {
            let k = inputs.iter().position(|&i| i == input)?;
            Some(values[k])
        };
        let said = Expr::parse(&f.text)
            .ok()
            .and_then(|e| e.eval_with(&host).err());
        let loss = match said {
            Some(d) if d.is(Cause::Domain) => Loss::Domain(d.into_first().message),
            _ => Loss::NotFinite,
        };
        Some(Valueless {
            function: f.owner.clone(),
            loss,
        })
    })
}
