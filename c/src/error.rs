//! Mistakes, all at once, each with code, place and advice.

use crate::door::{quiet, words};
use engine::diagnostic::{Diagnostic, Severity};
use std::ffi::{CString, c_char};

/// Every mistake that a function has found.
#[derive(Debug)]
pub struct CognateError(Vec<Told>);

/// A diagnostic with its texts for C.
#[derive(Debug)]
struct Told {
    severity: CognateSeverity,
    line: usize,
    column: usize,
    code: CString,
    message: CString,
    file: Option<CString>,
    element: Option<CString>,
    name: Option<CString>,
    advice: CString,
    text: CString,
}

/// The severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum CognateSeverity {
    /// information
    Note,
    /// legal, but probably not as meant
    Warning,
    /// a mistake
    Error,
}

/// A mistake, a warning or a note. Its texts belong to the CognateError that it comes from.
#[derive(Debug)]
#[repr(C)]
pub struct CognateDiagnostic {
    /// severity
    pub severity: CognateSeverity,
    /// stable short name, which `cognate explain CODE` explains
    pub code: *const c_char,
    /// one sentence without a full stop
    pub message: *const c_char,
    /// file of the text; NULL: none
    pub file: *const c_char,
    /// line in that text, from 1; 0: unknown
    pub line: usize,
    /// column, from 1, in characters; 0: unknown
    pub column: usize,
    /// the element concerned, for example "SFORCE/3"; NULL: none
    pub element: *const c_char,
    /// the name that the dataset gives that element; NULL: none
    pub name: *const c_char,
    /// what to do, a sentence a line
    pub advice: *const c_char,
    /// all of it as the command line prints it
    pub text: *const c_char,
}

impl CognateError {
    /// Returns the handle of some diagnostics.
    pub fn handle(all: Vec<Diagnostic>) -> *mut Self {
        Box::into_raw(Box::new(Self(all.into_iter().map(told).collect())))
    }
}

fn told(d: Diagnostic) -> Told {
    let text = words(d.to_string());
    Told {
        severity: match d.severity {
            Severity::Note => CognateSeverity::Note,
            Severity::Warning => CognateSeverity::Warning,
            Severity::Error => CognateSeverity::Error,
        },
        line: d.line,
        column: d.column,
        code: words(d.code),
        message: words(d.message),
        file: d.file.map(words),
        element: d.element.map(words),
        name: d.name.map(words),
        advice: words(d.help.join("\n")),
        text,
    }
}

/// Returns how many mistakes, warnings and notes there are; 0 for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_error_count(error: *const CognateError) -> usize {
    // SAFETY: NULL or a handle
    unsafe { error.as_ref() }.map_or(0, |error| error.0.len())
}

/// Puts one of them, counted from 0, into `diagnostic`; returns false where there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_error_get(
    error: *const CognateError,
    index: usize,
    diagnostic: *mut CognateDiagnostic,
) -> bool {
    // SAFETY: NULL or a handle; NULL or a place
    let (error, place) = unsafe { (error.as_ref(), diagnostic.as_mut()) };
    let (Some(told), Some(place)) = (error.and_then(|e| e.0.get(index)), place) else {
        return false;
    };
    let or_null = |text: &Option<CString>| text.as_ref().map_or(std::ptr::null(), |t| t.as_ptr());
    *place = CognateDiagnostic {
        severity: told.severity,
        code: told.code.as_ptr(),
        message: told.message.as_ptr(),
        file: or_null(&told.file),
        line: told.line,
        column: told.column,
        element: or_null(&told.element),
        name: or_null(&told.name),
        advice: told.advice.as_ptr(),
        text: told.text.as_ptr(),
    };
    true
}

/// Gives an error back.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_error_free(error: *mut CognateError) {
    if !error.is_null() {
        // SAFETY: made by `CognateError::handle`, given back once
        quiet((), || drop(unsafe { Box::from_raw(error) }));
    }
}
