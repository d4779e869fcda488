//! SYSFNC and SYSARY: the functions by which a routine reads the model.
//!
//! A routine says what it reads by asking: it is called once with `iflag` = 1 before anything is
//! computed, and what it asks for then becomes the inputs of its element. Later it is told their
//! values. It must ask for all it reads in that first call, as Adams wants it to.

use engine::internals::system::asked::{ask, ask_array};
use std::ffi::{CStr, c_char, c_int};

/// Reads a function of the model (DX, VM, VARVAL …) from within a routine, as SYSFNC of Adams.
///
/// `ids`: `n` numbers, as they stand in parentheses in the function language. `failed` becomes 1
/// where there is no such function, or no routine is being called, else 0. NULL is a failure.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_sysfnc(
    name: *const c_char,
    ids: *const c_int,
    n: c_int,
    value: *mut f64,
    failed: *mut c_int,
) {
    // SAFETY: NULL, or a text that ends with a zero byte
    let name = (!name.is_null()).then(|| unsafe { CStr::from_ptr(name) });
    // SAFETY: NULL or `n` numbers; NULL or places
    let (ids, value, failed) = unsafe { (numbers(ids, n), value.as_mut(), failed.as_mut()) };
    let found = name.and_then(|name| ask(name.to_str().ok()?.trim(), ids));
    if let Some(value) = value {
        *value = found.unwrap_or(0.0);
    }
    if let Some(failed) = failed {
        *failed = c_int::from(found.is_none());
    }
}

/// Reads several functions of the model from within a routine, as SYSARY of Adams.
///
/// `name`: TDISP, RDISP, DISP, TVEL, RVEL, VEL, TACC, RACC, ACC, TFORCE, RFORCE or FORCE; 3 or 6
/// numbers go into `values`, and how many into `n_values`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_sysary(
    name: *const c_char,
    ids: *const c_int,
    n: c_int,
    values: *mut f64,
    n_values: *mut c_int,
    failed: *mut c_int,
) {
    // SAFETY: NULL, or a text that ends with a zero byte
    let name = (!name.is_null()).then(|| unsafe { CStr::from_ptr(name) });
    // SAFETY: NULL or `n` numbers; NULL or places
    let (ids, n_values, failed) = unsafe { (numbers(ids, n), n_values.as_mut(), failed.as_mut()) };
    let found = name.and_then(|name| ask_array(name.to_str().ok()?.trim(), ids));
    let is_lacking = found.is_none();
    let found = found.unwrap_or_default();
    if !values.is_null() {
        // SAFETY: there are as many places as the name has values
        unsafe { std::slice::from_raw_parts_mut(values, found.len()) }.copy_from_slice(&found);
    }
    if let Some(n_values) = n_values {
        *n_values = found.len() as c_int;
    }
    if let Some(failed) = failed {
        *failed = c_int::from(is_lacking);
    }
}

/// Returns the numbers that a caller gives.
unsafe fn numbers<'a>(ids: *const c_int, n: c_int) -> &'a [c_int] {
    let n = usize::try_from(n).unwrap_or(0);
    if ids.is_null() || n == 0 {
        return &[];
    }
    // SAFETY: the caller says that `n` numbers stand there
    unsafe { std::slice::from_raw_parts(ids, n) }
}

/// cognate_sysfnc under the name that C routines for Adams call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn c_sysfnc(
    name: *const c_char,
    ids: *const c_int,
    n: c_int,
    value: *mut f64,
    failed: *mut c_int,
) {
    // SAFETY: the caller keeps the same promises
    unsafe { cognate_sysfnc(name, ids, n, value, failed) }
}

/// cognate_sysary under the name that C routines for Adams call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn c_sysary(
    name: *const c_char,
    ids: *const c_int,
    n: c_int,
    values: *mut f64,
    n_values: *mut c_int,
    failed: *mut c_int,
) {
    // SAFETY: the caller keeps the same promises
    unsafe { cognate_sysary(name, ids, n, values, n_values, failed) }
}
