//! The version: for the preprocessor of the program that is compiled, and of the library that it
//! meets when it runs.

use std::ffi::c_char;

/// The first number of the version; it is that of the shared library, too (libcognate.so.0).
pub const COGNATE_VERSION_MAJOR: u32 = 0;
/// The second number of the version.
pub const COGNATE_VERSION_MINOR: u32 = 1;
/// The third number of the version.
pub const COGNATE_VERSION_PATCH: u32 = 0;
/// The version as a number that grows, 10203 for 1.2.3.
pub const COGNATE_VERSION_NUMBER: u32 =
    COGNATE_VERSION_MAJOR * 10000 + COGNATE_VERSION_MINOR * 100 + COGNATE_VERSION_PATCH;

// the header cannot read Cargo.toml: whoever raises the version there raises it here
const _: () = {
    assert!(number(env!("CARGO_PKG_VERSION_MAJOR")) == COGNATE_VERSION_MAJOR);
    assert!(number(env!("CARGO_PKG_VERSION_MINOR")) == COGNATE_VERSION_MINOR);
    assert!(number(env!("CARGO_PKG_VERSION_PATCH")) == COGNATE_VERSION_PATCH);
};

/// Returns the number that a text of digits says.
const fn number(text: &str) -> u32 {
    let (digits, mut n, mut k) = (text.as_bytes(), 0, 0);
    while k < digits.len() {
        n = n * 10 + (digits[k] - b'0') as u32;
        k += 1;
    }
    n
}

/// Returns the version of the library: "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn cognate_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// Returns the version of the library as a number: COGNATE_VERSION_NUMBER of its header. A program
/// that finds another than its own COGNATE_VERSION_NUMBER runs with another library than it was
/// compiled for.
#[unsafe(no_mangle)]
pub extern "C" fn cognate_version_number() -> u32 {
    COGNATE_VERSION_NUMBER
}
