//! Expressions of the model as programs: splines and arrays they name are found in the model.

use super::external_inputs::{Call, Hook, closure_for};
use crate::diagnostic::{Cause, Diagnostic};
use crate::expr::compile;
use crate::expr::interpolation::{Bindings, Curve, CurvePoints, Spline};
use crate::expr::program::Program;
use crate::expr::spline::{Ends, Extrapolation};
use crate::model::{ElementId, ElementKind, Formula, Model, Text};
use std::sync::Arc;

/// The splines of a model, for the expressions that name them; what is wrong with those that cannot
/// be used.
pub(crate) fn bindings(model: &Model, hooks: &[Hook]) -> (Bindings, Vec<Diagnostic>) {
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
                Diagnostic::error("spline_data", why.to_string())
                    .element(ElementKind::Spline.id(id)),
            ),
        }
    }
    for &id in model.curves.keys() {
        match curve(model, hooks, id) {
            Ok(curve) => {
                bindings.curves.insert(id, curve);
            }
            Err(why) => errors.push(why),
        }
    }
    (bindings, errors)
}

/// A CURVE of a model, by a closure where a routine computes it.
///
/// # Errors
/// Why its data make none.
pub(crate) fn curve(model: &Model, hooks: &[Hook], id: u32) -> Result<Arc<Curve>, Diagnostic> {
    let unfit = |what: String| {
        Diagnostic::error(Cause::CurveData, what)
            .element(ElementKind::Curve.id(id))
            .help("give a MATRIX with one row x, y, z for each point")
    };
    let data = (model.curves.get(&id)).ok_or_else(|| unfit("does not exist".into()))?;
    if let Some(user) = &data.function {
        return curve_by_closure(data, hooks, (ElementKind::Curve.id(id), user));
    }
    let matrix = data.matrix.and_then(|m| model.matrices.get(&m));
    let matrix = matrix.ok_or_else(|| unfit("has no MATRIX with its points".into()))?;
    if let Some(file) = matrix.unread_file() {
        let what = format!("its points stand in the file {file}, which is not read");
        return Err(unfit(what));
    }
    let numbers = matrix.by_rows().filter(|_| matrix.columns == 3);
    let numbers =
        numbers.ok_or_else(|| unfit("its MATRIX does not have a row x, y, z per point".into()))?;
    let points: Vec<[f64; 3]> = (numbers.chunks_exact(3))
        .map(|p| [p[0], p[1], p[2]])
        .collect();
    let kind = if data.through_points == Some(true) {
        CurvePoints::OnCurve
    } else {
        CurvePoints::Control
    };
    let order = data.order.unwrap_or(4) as usize;
    Curve::new(&points, data.closed, order, kind)
        .map(Arc::new)
        .map_err(|why| unfit(why.to_string()))
}

/// A CURVE that a closure computes.
fn curve_by_closure(
    data: &crate::model::Curve,
    hooks: &[Hook],
    (element, user): (ElementId, &Formula),
) -> Result<Arc<Curve>, Diagnostic> {
    let unfit = |what: String, advice: &str| {
        let error = Diagnostic::error(Cause::CurveData, what);
        Err(error.element(element).help(advice))
    };
    let Some(closure) = closure_for(hooks, element, user) else {
        let what = "FUNCTION=USER needs a routine that is not part of the dataset";
        return unfit(
            what.into(),
            "load the library that has it (--routines), or give a MATRIX with one row x, y, z for each point",
        );
    };
    let hook = &hooks[closure];
    if let Some(input) = hook.inputs.first() {
        let what = format!("its routine reads {input}: a curve depends on its parameter alone");
        return unfit(what, "give what it needs as numbers of USER(…)");
    }
    let (law, constants) = (hook.law.clone(), user.user_numbers().to_vec());
    let point = move |parameter: f64, order: u32| {
        let mut out = [0.0; 3];
        let call = Call {
            time: 0.0,
            element,
            constants: &constants,
            values: &[parameter, f64::from(order)],
        };
        law(&call, &mut out);
        out
    };
    let range = [data.minpar.unwrap_or(-1.0), data.maxpar.unwrap_or(1.0)];
    Curve::computed(Arc::new(point), data.closed, range)
        .map(Arc::new)
        .or_else(|why| {
            unfit(
                why.to_string(),
                "for IORD 0, 1 and 2 CURSUB returns x, y, z, and their first and second derivatives along ALPHA",
            )
        })
}

/// An expression as programs.
pub(super) struct Compiled {
    /// its value
    pub program: Program,
    /// of each value of the past that it reads: what is remembered, how long ago, what it was
    /// before the start
    pub delays: Vec<[Program; 3]>,
}

/// Compiles an expression, as far as that has not been done before.
///
/// # Errors
/// The first mistake in the text, whose columns count from its beginning; splines or curves that do
/// not exist.
pub(super) fn compile(text: &Text, bindings: &Bindings) -> Result<Compiled, Diagnostic> {
    if let Some(program) = text.program() {
        return Ok(Compiled {
            program: program.clone(),
            delays: Vec::new(),
        });
    }
    let ast = text.ast()?;
    let mut compiler = compile::Compiler::new(bindings);
    let value = compiler.add(ast)?;
    let delays = compiler.delays().iter();
    let delays = delays.map(|d| [d.expression, d.delay, d.history].map(|v| compiler.finish(&[v])));
    Ok(Compiled {
        program: compiler.finish(&[value]),
        delays: delays.collect(),
    })
}
