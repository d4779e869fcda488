//! Names of a caller's own in expressions: variables, constants, functions as formulas or callbacks.

use crate::door::{Data, changed, door, quiet, text, usage};
use crate::error::CognateError;
use crate::expr::dialect_of;
use engine::Error;
use engine::expr::Names;
use std::ffi::{c_char, c_void};

/// Names of the caller's own, which expressions may use beside those of the language.
pub struct CognateNames {
    pub(crate) names: Names,
}

/// A function of `n` arguments: puts its value into `*value`, and its partial derivatives, one for
/// each argument, into `slopes`, which is NULL where they are not asked for. Returns false where it
/// has no value.
pub type CognateFunction = Option<
    extern "C" fn(
        data: *mut c_void,
        arguments: *const f64,
        n: usize,
        value: *mut f64,
        slopes: *mut f64,
    ) -> bool,
>;

/// Adds something that is known by a text.
unsafe fn add(
    names: *mut CognateNames,
    (given, what): (*const c_char, &str),
    error: *mut *mut CognateError,
    put: impl FnOnce(Names, &str) -> Result<Names, Error>,
) -> bool {
    let work = || {
        // SAFETY: a handle and a text of the caller
        let (names, given) = unsafe { (changed(names, "names")?, text(given, what)?) };
        names.names = put(names.names.clone(), given)?;
        Ok(true)
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}

/// Returns names of which there are none, for expressions of a language (a CognateDialect); NULL:
/// there is no such language.
///
/// Upper and lower case are one. What is wrong with names (one that cannot be written, that hides
/// one of the language, or that is there already) is told by cognate_expr_parse_with, all at once.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_names_new(
    dialect: u32,
    error: *mut *mut CognateError,
) -> *mut CognateNames {
    let work = || {
        let names = Names::of(dialect_of(dialect)?);
        Ok(Box::into_raw(Box::new(CognateNames { names })))
    };
    // SAFETY: a place of the caller
    unsafe { door(error, std::ptr::null_mut(), work) }
}

/// Adds a variable: "x". Variables are the first inputs of an expression, in the order in which they
/// were added, also those that it does not read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_names_variable(
    names: *mut CognateNames,
    name: *const c_char,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: a handle, a text and a place of the caller
    unsafe {
        add(names, (name, "name"), error, |all, name| {
            Ok(all.variables([name]))
        })
    }
}

/// Adds a named number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_names_constant(
    names: *mut CognateNames,
    name: *const c_char,
    value: f64,
    error: *mut *mut CognateError,
) -> bool {
    let put = |all: Names, name: &str| Ok(all.constant(name, value));
    // SAFETY: a handle, a text and a place of the caller
    unsafe { add(names, (name, "name"), error, put) }
}

/// Adds a function by its head and a formula of the language: "hertz(x, k)", "k*MAX(x, 0)**1.5".
///
/// It may use constants and functions that were added before it. It is as fast as if it were written
/// out, and has all derivatives.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_names_define(
    names: *mut CognateNames,
    head: *const c_char,
    formula: *const c_char,
    error: *mut *mut CognateError,
) -> bool {
    let put = |all: Names, head: &str| {
        // SAFETY: a text of the caller
        let formula = unsafe { text(formula, "formula") }?;
        Ok(all.define(head, formula))
    };
    // SAFETY: a handle, a text and a place of the caller
    unsafe { add(names, (head, "head"), error, put) }
}

/// Adds a function of `n_arguments` arguments that a callback computes, which is given `data`.
///
/// `has_slopes`: it gives its derivatives, too. Without them, asking an expression for derivatives
/// along what the arguments depend on is a mistake that names the function. Expressions call it in
/// each thread that evaluates them; `data` must live as long as they do.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_names_function(
    names: *mut CognateNames,
    name: *const c_char,
    n_arguments: usize,
    function: CognateFunction,
    has_slopes: bool,
    data: *mut c_void,
    error: *mut *mut CognateError,
) -> bool {
    let put = |all: Names, name: &str| {
        let advice = "give the address of a function";
        let function = function.ok_or_else(|| usage("function is NULL", advice))?;
        let data = Data(data);
        let called = move |given: &[f64], slopes: &mut [f64]| {
            let mut value = f64::NAN;
            let to = match slopes.is_empty() {
                true => std::ptr::null_mut(),
                false => slopes.as_mut_ptr(),
            };
            let went = function(data.pointer(), given.as_ptr(), given.len(), &mut value, to);
            if went { value } else { f64::NAN }
        };
        Ok(match has_slopes {
            true => all.function_of_slice_with_slopes(name, n_arguments, called),
            false => {
                let value = move |given: &[f64]| called(given, &mut []);
                all.function_of_slice(name, n_arguments, value)
            }
        })
    };
    // SAFETY: a handle, a text and a place of the caller
    unsafe { add(names, (name, "name"), error, put) }
}

/// Gives names back; expressions that use them go on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_names_free(names: *mut CognateNames) {
    if !names.is_null() {
        // SAFETY: made by `cognate_names_new`, given back once
        quiet((), || drop(unsafe { Box::from_raw(names) }));
    }
}
