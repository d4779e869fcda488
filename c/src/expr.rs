//! Expressions: parse, evaluate, differentiate, run over columns.

use crate::door::{changed, door, places, quiet, row, seen, text, usage, words};
use crate::error::CognateError;
use engine::Error;
use engine::diagnostic::Diagnostic;
use engine::expr::Expr;
use engine::expr::ast::Dialect;
use engine::expr::interpolation::Bindings;
use engine::expr::program::{Batch, Input, Program, Work};
use std::ffi::{CString, c_char};
use std::sync::{Mutex, OnceLock, PoisonError};

/// An expression of the function language, checked and compiled.
pub struct CognateExpr {
    expr: Expr,
    value: Compiled,
    slopes: OnceLock<Compiled>,
    inputs: Vec<Input>,
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

/// A program with the scratch that runs of it need, taken and given back, so that threads do not
/// wait for each other.
struct Compiled {
    program: Program,
    single: Mutex<Vec<Work>>,
    batches: Mutex<Vec<Batch>>,
}

impl Compiled {
    fn new(program: Program) -> Self {
        let (single, batches) = Default::default();
        Self {
            program,
            single,
            batches,
        }
    }

    fn run(&self, inputs: &[f64], out: &mut [f64]) {
        let mut work = take(&self.single).unwrap_or_default();
        self.program.run(inputs, &mut work, out);
        give(&self.single, work);
    }

    fn batch(&self, inputs: &[&[f64]], out: &mut [&mut [f64]]) -> Result<(), Error> {
        let mut batch = take(&self.batches).unwrap_or_else(|| self.program.batch());
        let outcome = batch.run(inputs, out);
        give(&self.batches, batch);
        outcome
    }
}

fn take<T>(pool: &Mutex<Vec<T>>) -> Option<T> {
    pool.lock().unwrap_or_else(PoisonError::into_inner).pop()
}

fn give<T>(pool: &Mutex<Vec<T>>, scratch: T) {
    pool.lock()
        .unwrap_or_else(PoisonError::into_inner)
        .push(scratch);
}

impl CognateExpr {
    fn parse(source: &str, dialect: u32) -> Result<Self, Error> {
        let dialect = match dialect {
            d if d == CognateDialect::Function as u32 => Dialect::Function,
            d if d == CognateDialect::Expression as u32 => Dialect::Expression,
            _ => return Err(usage("dialect is none of them", "see CognateDialect")),
        };
        let expr = Expr::parse_dialect(source, dialect)?;
        let program = expr.compile(&Bindings::default())?;
        let inputs = program.inputs().to_vec();
        if inputs.iter().any(|i| matches!(i, Input::Delayed(_))) {
            let what = "DELAY depends on the past, which an expression alone has not";
            let d = Diagnostic::error("needs_history", what);
            return Err(d
                .help("put it into a model, or ask for it as a column of a session")
                .into());
        }
        Ok(Self {
            names: inputs.iter().map(|i| words(i.to_string())).collect(),
            inputs,
            value: Compiled::new(program),
            slopes: OnceLock::new(),
            expr,
        })
    }

    fn slopes(&self) -> &Compiled {
        self.slopes
            .get_or_init(|| Compiled::new(self.value.program.with_gradient(&self.inputs)))
    }

    /// Complains of numbers in place of a value: the walker names the operation.
    fn complaint(&self, given: &[f64], point: Option<usize>) -> Error {
        let infinite = self.names.iter().zip(given).find(|(_, x)| !x.is_finite());
        let host = |input: Input| {
            let place = self.inputs.iter().position(|i| *i == input);
            place.map(|place| given[place])
        };
        let mut d = match (infinite, self.expr.eval_with(&host)) {
            (Some((name, x)), _) => {
                let name = name.to_string_lossy();
                Diagnostic::error(
                    "domain",
                    format!("{name} is {x}, which is not a finite number"),
                )
            }
            (None, Err(e)) => e.into_first(),
            (None, Ok(value)) => {
                let what = format!("a derivative is not finite where the value is {value}");
                Diagnostic::error("domain", what)
            }
        };
        if let Some(point) = point {
            d.message += &format!(" (point {point})");
        }
        d.into()
    }

    fn counted(&self, n: usize) -> Result<(), Error> {
        let wanted = self.inputs.len();
        if n == wanted {
            return Ok(());
        }
        let what = format!("{n} inputs are given, the expression reads {wanted}");
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
        Ok(Box::into_raw(Box::new(CognateExpr::parse(
            source, dialect,
        )?)))
    };
    // SAFETY: a place of the caller
    unsafe { door(error, std::ptr::null_mut(), work) }
}

/// Returns how many inputs an expression reads.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_expr_inputs(expr: *const CognateExpr) -> usize {
    // SAFETY: NULL or a handle
    unsafe { expr.as_ref() }.map_or(0, |expr| expr.inputs.len())
}

/// Returns the name of an input, counted from 0: "TIME", "DX(1, 2)"; NULL: there is none.
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
        expr.value.run(inputs, std::slice::from_mut(value));
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
        expr.slopes().run(inputs, &mut all);
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
        let compiled = if out.len() > 1 {
            expr.slopes()
        } else {
            &expr.value
        };
        compiled.batch(&columns, &mut out)?;
        let first = without_value(&columns, &mut out);
        let Some(first) = first else { return Ok(true) };
        let given: Vec<f64> = columns.iter().map(|c| c[first]).collect();
        Err(expr.complaint(&given, Some(first)))
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}

/// Makes NaN of what is no finite number; returns the first such point.
fn without_value(columns: &[&[f64]], out: &mut [&mut [f64]]) -> Option<usize> {
    let finite = |numbers: &[f64]| numbers.iter().fold(true, |all, x| all & x.is_finite());
    let inputs_are = columns.iter().fold(true, |all, c| all & finite(c));
    if inputs_are && out.iter().all(|c| finite(c)) {
        return None;
    }
    let mut first = None;
    for k in 0..out.first().map_or(0, |c| c.len()) {
        let given = columns.iter().all(|c| c[k].is_finite());
        for column in out.iter_mut() {
            if !given || !column[k].is_finite() {
                column[k] = f64::NAN;
                first.get_or_insert(k);
            }
        }
    }
    first
}

/// Gives an expression back.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_expr_free(expr: *mut CognateExpr) {
    if !expr.is_null() {
        // SAFETY: made by `cognate_expr_parse`, given back once
        quiet((), || drop(unsafe { Box::from_raw(expr) }));
    }
}
