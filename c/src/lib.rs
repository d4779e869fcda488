//! C interface of cognate: `include/cognate.h` over a shared and a static library.
//!
//! Every function is a door ([`door`]): it looks at its pointers, does its work with the safe
//! library, and turns mistakes and panics into a `CognateError`. The rules for handles, texts,
//! mistakes and threads stand once, at the head of the header (`cbindgen.toml`).
//!
//! ```text
//! door.rs        pointers in, mistakes out; no panic leaves
//! error.rs       every mistake with code, place and advice
//! expr.rs        expressions
//! names.rs       variables, constants, functions of a caller's own in them
//! model.rs       datasets
//! builder.rs     models that a program makes
//! options.rs     choices of a session
//! session.rs     simulations, columns, files, state
//! rows.rs        rows of results while a simulation goes on
//! routines.rs    USER as C callbacks with Adams' argument lists
//! utilities.rs   SYSFNC and SYSARY, which those call
//! library.rs     a user's library, loaded at run time
//! version.rs     the version, as a text and as numbers
//! ```
//!
//! `unsafe` stands where a pointer of the caller is followed, and where a callback is called.

mod builder;
mod door;
mod error;
mod expr;
mod library;
mod model;
mod names;
mod options;
mod routines;
mod rows;
mod session;
mod utilities;
mod version;

pub use version::{
    COGNATE_VERSION_MAJOR, COGNATE_VERSION_MINOR, COGNATE_VERSION_NUMBER, COGNATE_VERSION_PATCH,
};

use std::ffi::{CString, c_char};

/// Gives back a text that a function returned as `char *`; NULL is taken as well.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_string_free(text: *mut c_char) {
    if !text.is_null() {
        // SAFETY: such texts are made by `CString::into_raw` alone (header: given back once)
        drop(unsafe { CString::from_raw(text) });
    }
}
