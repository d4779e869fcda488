//! Expressions: parse, evaluate, differentiate, run over columns.

use crate::door::{changed, door, places, quiet, row, seen, text, usage, words};
use crate::error::CognateError;
use crate::names::CognateNames;
use engine::Error;
use engine::expr::SharedEvaluator;
use engine::expr::ast::Dialect;
use std::ffi::{CString, c_char};

/// An expression of the function language, checked and compiled.
pub struct CognateExpr {
    shared: SharedEvaluator,
    names: Vec<CString>,
}

/// The language of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum CognateDialect {
    /// direct-entry functions: radians, TIME
    Function,
    /// expressions of the modelling language: degrees, t
    Expression,
}

/// Returns the language of a number that C gives.
///
/// # Errors
/// A number of none.
pub fn dialect_of(dialect: u32) -> Result<Dialect, Error> {
    match dialect {
        d if d == CognateDialect::Function as u32 => Ok(Dialect::Function),
        d if d == CognateDialect::Expression as u32 => Ok(Dialect::Expression),
        _ => Err(usage(
            format!("{dialect} is no dialect"),
            "the dialects are COGNATE_DIALECT_FUNCTION and COGNATE_DIALECT_EXPRESSION",
        )),
    }
}

impl CognateExpr {
    fn handle(shared: SharedEvaluator) -> *mut Self {
        Box::into_raw(Box::new(Self {
            names: shared.names().iter().map(|n| words(n.clone())).collect(),
            shared,
        }))
    }

    /// Complains of numbers in place of a value; `point`: the one of many.
    fn complaint(&self, given: &[f64], point: Option<usize>) -> Error {
        let mut said = self.shared.complaint(given);
        if let Some(point) = point {
            said.message += &format!(" (point {point})");
        }
        said.into()
    }

    fn counted(&self, n: usize) -> Result<(), Error> {
        let wanted = self.names.len();
        if n == wanted {
            return Ok(());
        }
        let what = format!(
            "the expression reads {}, not {n}",
            engine::diagnostic::counted(wanted, "input")
        );
        Err(usage(what, "cognate_expr_input names them, in their order"))
    }
}

/// Reads, checks and compiles an expression; NULL: it has a mistake. `dialect`: a CognateDialect.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_expr_parse(
    source: *const c_char,
    dialect: u32,
    error: *mut *mut CognateError,
) -> *mut CognateExpr {
    let work = || {
        // SAFETY: a text of the caller
        let source = unsafe { text(source, "source") }?;
        let shared = SharedEvaluator::parse(source, dialect_of(dialect)?)?;
        Ok(CognateExpr::handle(shared))
    };
    // SAFETY: a place of the caller
    unsafe { door(error, std::ptr::null_mut(), work) }
}

/// Reads an expression that uses names of the caller's own; NULL: it, or one of the names, has a
/// mistake. The names may be given back, or have more added, without changing it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_expr_parse_with(
    source: *const c_char,
    names: *const CognateNames,
    error: *mut *mut CognateError,
) -> *mut CognateExpr {
    let work = || {
        // SAFETY: a text and a handle of the caller
        let (source, names) = unsafe { (text(source, "source")?, seen(names, "names")?) };
        let shared = SharedEvaluator::parse_with(source, &names.names)?;
        Ok(CognateExpr::handle(shared))
    };
    // SAFETY: a place of the caller
    unsafe { door(error, std::ptr::null_mut(), work) }
}

/// Returns how many inputs an expression reads.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_expr_inputs(expr: *const CognateExpr) -> usize {
    // SAFETY: NULL or a handle
    unsafe { expr.as_ref() }.map_or(0, |expr| expr.names.len())
}

/// Returns the name of an input, counted from 0: "TIME", "DX(1, 2)", a variable; NULL: there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_expr_input(
    expr: *const CognateExpr,
    index: usize,
) -> *const c_char {
    // SAFETY: NULL or a handle
    let name = unsafe { expr.as_ref() }.and_then(|expr| expr.names.get(index));
    name.map_or(std::ptr::null(), |name| name.as_ptr())
}

/// Evaluates an expression for the values of its inputs, in the order of cognate_expr_input.
///
/// Returns false where it has no value; the error then names the operation that has none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_expr_eval(
    expr: *const CognateExpr,
    inputs: *const f64,
    n_inputs: usize,
    value: *mut f64,
    error: *mut *mut CognateError,
) -> bool {
    let work = || {
        // SAFETY: a handle, numbers and a place of the caller
        let (expr, value) = unsafe { (seen(expr, "expr")?, changed(value, "value")?) };
        // SAFETY: as before
        let inputs = unsafe { row(inputs, n_inputs, "inputs") }?;
        expr.counted(inputs.len())?;
        expr.shared.run(inputs, std::slice::from_mut(value));
        if value.is_finite() && inputs.iter().all(|x| x.is_finite()) {
            return Ok(true);
        }
        *value = f64::NAN;
        Err(expr.complaint(inputs, None))
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}

/// Evaluates an expression and its exact derivatives along all inputs, one number for each.
///
/// `value` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_expr_gradient(
    expr: *const CognateExpr,
    inputs: *const f64,
    n_inputs: usize,
    value: *mut f64,
    gradient: *mut f64,
    error: *mut *mut CognateError,
) -> bool {
    let work = || {
        // SAFETY: a handle, numbers and places of the caller
        let (expr, inputs) = unsafe { (seen(expr, "expr")?, row(inputs, n_inputs, "inputs")?) };
        expr.counted(inputs.len())?;
        // SAFETY: as before
        let gradient = unsafe { places(gradient, n_inputs, "gradient") }?;
        let mut all = vec![0.0; 1 + inputs.len()];
        expr.shared.run_slopes(inputs, &mut all);
        gradient.copy_from_slice(&all[1..]);
        // SAFETY: NULL or a place
        if let Some(value) = unsafe { value.as_mut() } {
            *value = all[0];
        }
        if all.iter().chain(inputs).all(|x| x.is_finite()) {
            return Ok(true);
        }
        Err(expr.complaint(inputs, None))
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}

/// Evaluates an expression over columns, one of `n` numbers for each input; for many points some
/// ten times as fast as one by one.
///
/// `gradients` is NULL, or holds a column of `n` places for each input, which the derivatives
/// along it go into. Points without a value become NaN in `values`; then false is returned and the
/// error names the first. Columns may not overlap those that are written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_expr_batch(
    expr: *const CognateExpr,
    inputs: *const *const f64,
    n_inputs: usize,
    n: usize,
    values: *mut f64,
    gradients: *const *mut f64,
    error: *mut *mut CognateError,
) -> bool {
    let work = || {
        // SAFETY: a handle and columns of the caller
        let (expr, inputs) = unsafe { (seen(expr, "expr")?, row(inputs, n_inputs, "inputs")?) };
        expr.counted(inputs.len())?;
        let columns = inputs.iter();
        // SAFETY: each of the columns has `n` numbers
        let columns = columns.map(|c| unsafe { row(*c, n, "a column of inputs") });
        let columns = columns.collect::<Result<Vec<_>, _>>()?;
        // SAFETY: `n` places of the caller
        let values = unsafe { places(values, n, "values") }?;
        let mut out = vec![values];
        if !gradients.is_null() {
            // SAFETY: a column for each input
            for column in unsafe { row(gradients, n_inputs, "gradients") }? {
                // SAFETY: each has `n` places
                out.push(unsafe { places(*column, n, "a column of gradients") }?);
            }
        }
        expr.shared.batch(&columns, &mut out)?;
        let first = SharedEvaluator::mark(&columns, &mut out);
        let Some(first) = first else { return Ok(true) };
        let given: Vec<f64> = columns.iter().map(|c| c[first]).collect();
        Err(expr.complaint(&given, Some(first)))
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}

/// Gives an expression back.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_expr_free(expr: *mut CognateExpr) {
    if !expr.is_null() {
        // SAFETY: made by `cognate_expr_parse`, given back once
        quiet((), || drop(unsafe { Box::from_raw(expr) }));
    }
}
