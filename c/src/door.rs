//! Doors: pointers of the caller in, mistakes out; no panic leaves.

use crate::error::CognateError;
use engine::Error;
use engine::diagnostic::Diagnostic;
use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Does the work of a function; where it fails, or panics, returns `failed` and tells why.
pub unsafe fn door<T>(
    error: *mut *mut CognateError,
    failed: T,
    work: impl FnOnce() -> Result<T, Error>,
) -> T {
    // what a panic leaves half done belongs to a handle that is to be given back
    let outcome = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(bug(&panic)));
    let (result, told) = match outcome {
        Ok(result) => (result, std::ptr::null_mut()),
        Err(wrong) => (failed, CognateError::handle(wrong.into())),
    };
    if error.is_null() {
        // SAFETY: made in this function, and nobody else has it
        unsafe { crate::error::cognate_error_free(told) };
    } else {
        // SAFETY: the caller gives NULL or a place for a pointer
        unsafe { *error = told };
    }
    result
}

/// The same for a function that cannot fail but by a panic.
pub fn quiet<T>(failed: T, work: impl FnOnce() -> T) -> T {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or(failed)
}

fn bug(panic: &(dyn std::any::Any + Send)) -> Error {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
    let what = format!("our mistake: {}", text.unwrap_or("a panic"));
    usage_as(
        "bug",
        what,
        "please report it with the model; give the handle back",
    )
}

/// Returns a mistake in the use of a function.
pub fn usage(what: impl Into<String>, advice: &str) -> Error {
    usage_as("usage", what, advice)
}

fn usage_as(code: &'static str, what: impl Into<String>, advice: &str) -> Error {
    Diagnostic::error(code, what).help(advice).into()
}

/// Returns what a pointer points at.
///
/// # Errors
/// NULL.
pub unsafe fn seen<'a, T>(pointer: *const T, name: &str) -> Result<&'a T, Error> {
    // SAFETY: the caller gives NULL or a handle that lives until it is given back
    unsafe { pointer.as_ref() }.ok_or_else(|| null(name))
}

/// The same, to be changed.
///
/// # Errors
/// NULL.
pub unsafe fn changed<'a, T>(pointer: *mut T, name: &str) -> Result<&'a mut T, Error> {
    // SAFETY: as for `seen`; such handles belong to one thread at a time (header)
    unsafe { pointer.as_mut() }.ok_or_else(|| null(name))
}

fn null(name: &str) -> Error {
    usage(
        format!("{name} is NULL"),
        "a function before this one may have failed; see its error",
    )
}

/// Returns a text.
///
/// # Errors
/// NULL, or bytes that are no UTF-8.
pub unsafe fn text<'a>(pointer: *const c_char, name: &str) -> Result<&'a str, Error> {
    if pointer.is_null() {
        return Err(null(name));
    }
    // SAFETY: texts end with a zero byte (header)
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str()
        .map_err(|_| usage(format!("{name} is no UTF-8"), "texts are UTF-8"))
}

/// Returns `n` things that stand in a row; none need no pointer.
///
/// # Errors
/// NULL.
pub unsafe fn row<'a, T>(pointer: *const T, n: usize, name: &str) -> Result<&'a [T], Error> {
    if n == 0 {
        return Ok(&[]);
    }
    if pointer.is_null() {
        return Err(null(name));
    }
    // SAFETY: the caller says that `n` of them stand there
    Ok(unsafe { std::slice::from_raw_parts(pointer, n) })
}

/// The same, to be filled.
///
/// # Errors
/// NULL.
pub unsafe fn places<'a, T>(pointer: *mut T, n: usize, name: &str) -> Result<&'a mut [T], Error> {
    if n == 0 {
        return Ok(&mut []);
    }
    if pointer.is_null() {
        return Err(null(name));
    }
    // SAFETY: the caller says that there are `n` places, which nobody else uses meanwhile
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer, n) })
}

/// Returns a text that the caller gives back by `cognate_string_free`.
pub fn given(text: impl Into<String>) -> *mut c_char {
    words(text).into_raw()
}

/// Returns a text for C; it ends where a zero byte stands in it.
pub fn words(text: impl Into<String>) -> CString {
    let mut text: String = text.into();
    if let Some(end) = text.find('\0') {
        text.truncate(end);
    }
    CString::new(text).unwrap_or_default()
}

/// The caller's data, as a callback is given them.
#[derive(Clone, Copy)]
pub struct Data(pub *mut c_void);

// SAFETY: handed back to the caller's callback alone, in the thread that called; the caller says
// that it may be called there (header)
unsafe impl Send for Data {}
// SAFETY: as before
unsafe impl Sync for Data {}

impl Data {
    /// Returns the pointer. (A closure that takes the field alone would not be `Send`.)
    pub fn pointer(&self) -> *mut c_void {
        self.0
    }
}
