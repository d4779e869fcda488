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
//! options.rs     choices of a session
//! session.rs     simulations, columns, files, state
//! routines.rs    USER as C callbacks with Adams' argument lists
//! utilities.rs   SYSFNC and SYSARY, which those call
//! library.rs     a user's library, loaded at run time
//! ```
//!
//! `unsafe` stands where a pointer of the caller is followed, and where a callback is called.

mod door;
mod error;
mod expr;
mod library;
mod model;
mod names;
mod options;
mod routines;
mod session;
mod utilities;

use std::ffi::{CString, c_char};

/// Returns the version of the library: "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn cognate_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// Gives back a text that a function returned as `char *`; NULL is taken as well.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_string_free(text: *mut c_char) {
    if !text.is_null() {
        // SAFETY: such texts are made by `CString::into_raw` alone (header: given back once)
        drop(unsafe { CString::from_raw(text) });
    }
}
