//! Expressions of the model as programs: splines and arrays they name are found in the model.

use super::Formula;
use crate::diagnostic::Diagnostic;
use crate::expr::Profile;
use crate::expr::ast::Dialect;
use crate::expr::compile;
use crate::expr::interpolation::{Bindings, Spline};
use crate::expr::parse;
use crate::expr::program::Program;
use crate::expr::spline::{Ends, Extrapolation};
use crate::model::Model;
use std::sync::Arc;

/// The splines of a model, for the expressions that name them; what is wrong with those that cannot be used.
pub(super) fn bindings(model: &Model) -> (Bindings, Vec<Diagnostic>) {
    let mut bindings = Bindings::default();
    let mut errors = Vec::new();
    for (&id, s) in &model.splines {
        let extrapolation = if s.linear_extrapolate {
            Extrapolation::Linear
        } else {
            Extrapolation::Parabolic
        };
        match Spline::new(
            s.x.clone(),
            s.z.clone(),
            s.y.clone(),
            Ends::Natural,
            extrapolation,
        ) {
            Ok(spline) => {
                bindings.splines.insert(id, Arc::new(spline));
            }
            Err(why) => errors.push(
                Diagnostic::error("spline_data", why.to_string()).element(format!("SPLINE/{id}")),
            ),
        }
    }
    (bindings, errors)
}

/// An expression as programs.
pub(super) struct Compiled {
    /// its value
    pub program: Program,
    /// of each value of the past that it reads: what is remembered, how long ago, what it was before the start
    pub delays: Vec<[Program; 3]>,
}

/// Compiles the text of an expression.
///
/// # Errors
/// What the language has to say about it; columns count from the beginning of the text.
pub(super) fn compile(text: &str, bindings: &Bindings) -> Result<Compiled, Diagnostic> {
    let ast = parse(text, Dialect::Function, Profile::default())?;
    let mut compiler = compile::Compiler::new(bindings);
    let value = compiler.add(&ast)?;
    let delays = compiler.delays().iter();
    let delays = delays.map(|d| [d.expression, d.delay, d.history].map(|v| compiler.finish(&[v])));
    Ok(Compiled {
        program: compiler.finish(&[value]),
        delays: delays.collect(),
    })
}

/// A formula that is a number; `None` when it has no text because it is not finite.
pub(super) fn constant(value: f64) -> Option<Formula> {
    let text = format!("{value:e}");
    let program = compile(&text, &Bindings::default()).ok()?.program;
    Some(Formula {
        name: "a constant".into(),
        text,
        program,
        delayed: Vec::new(),
    })
}
