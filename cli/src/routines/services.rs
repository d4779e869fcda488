//! Functions that a routine calls: SYSFNC, SYSARY and their like, for Fortran (`sysfnc_`) and for
//! C (`c_sysfnc`).
//!
//! A library of routines is linked without them, and finds them in the program that loads it:
//! `build.rs` has the linker export these names and no others.

use cognate::internals::system::asked;
use std::ffi::{c_char, c_int};
use std::os::raw::c_ulong;

/// Letters of a name or a message that are read, at most.
const MOST_LETTERS: usize = 512;

/// Makes the linker take this file into the program, and keep the functions.
pub fn keep() {
    let all: [*const (); 12] = [
        sysfnc_ as *const (),
        sysary_ as *const (),
        syspar_ as *const (),
        errmes_ as *const (),
        usrmes_ as *const (),
        timget_ as *const (),
        c_sysfnc as *const (),
        c_sysary as *const (),
        c_syspar as *const (),
        c_errmes as *const (),
        c_usrmes as *const (),
        c_timget as *const (),
    ];
    std::hint::black_box(all);
}

/// Reads a text that ends after `most` letters, or earlier with a zero byte.
///
/// # Safety
/// As many letters can be read.
unsafe fn text(letters: *const c_char, most: usize) -> String {
    let mut bytes = Vec::new();
    for k in 0..most.min(MOST_LETTERS) {
        // SAFETY: the caller says so
        let byte = match letters.is_null() {
            true => 0,
            false => unsafe { *letters.add(k) }.cast_unsigned(),
        };
        if byte == 0 {
            break;
        }
        bytes.push(byte);
    }
    String::from_utf8_lossy(&bytes).trim().to_owned()
}

/// Reads the numbers that a caller gives.
///
/// # Safety
/// There are `n`, or none.
unsafe fn numbers<'a>(ids: *const c_int, n: c_int) -> &'a [c_int] {
    match usize::try_from(n) {
        // SAFETY: the caller says so
        Ok(n) if n > 0 && !ids.is_null() => unsafe { std::slice::from_raw_parts(ids, n) },
        _ => &[],
    }
}

/// Puts a number in its place, if there is one.
///
/// # Safety
/// A number may be written there.
unsafe fn put<T>(place: *mut T, value: T) {
    // SAFETY: the caller says so
    if let Some(place) = unsafe { place.as_mut() } {
        *place = value;
    }
}

/// Answers SYSFNC.
///
/// # Safety
/// The places are those of a number each, or none.
unsafe fn answer(name: &str, ids: &[c_int], value: *mut f64, failed: *mut c_int) {
    let found = asked::ask(name, ids);
    // SAFETY: the caller says so
    unsafe {
        put(value, found.unwrap_or(0.0));
        put(failed, c_int::from(found.is_none()));
    }
}

/// Answers SYSARY.
///
/// # Safety
/// There are as many places for values as the name has; the others are those of a number each.
unsafe fn answer_array(
    name: &str,
    ids: &[c_int],
    (values, n_values): (*mut f64, *mut c_int),
    failed: *mut c_int,
) {
    let answer = asked::ask_array(name, ids);
    let failure = c_int::from(answer.is_none());
    let found = answer.unwrap_or_default();
    // SAFETY: the caller says so
    unsafe {
        if !values.is_null() {
            std::slice::from_raw_parts_mut(values, found.len()).copy_from_slice(&found);
        }
        put(n_values, found.len() as c_int);
        put(failed, failure);
    }
}

/// Answers ERRMES: where there is a failure, it is told and with STOP ends the run.
fn complain(failed: c_int, message: &str, ends: &str) {
    if failed != 0 {
        asked::note(message, ends.eq_ignore_ascii_case("STOP"));
    }
}

/// Answers USRMES: what is wanted to be said is said; FAULT ends the run.
fn say(wanted: c_int, message: &str, kind: &str) {
    if wanted != 0 {
        asked::note(message, kind.eq_ignore_ascii_case("FAULT"));
    }
}

// SAFETY of all below: a routine keeps to the arguments that the manual gives, as it does with
// Adams. Compilers of Fortran put the length of each text behind all arguments.

#[unsafe(no_mangle)]
unsafe extern "C" fn sysfnc_(
    name: *const c_char,
    ids: *const c_int,
    n: *const c_int,
    value: *mut f64,
    failed: *mut c_int,
    length: c_ulong,
) {
    // SAFETY: see above
    unsafe {
        answer(
            &text(name, length as usize),
            numbers(ids, *n),
            value,
            failed,
        )
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn sysary_(
    name: *const c_char,
    ids: *const c_int,
    n: *const c_int,
    values: *mut f64,
    n_values: *mut c_int,
    failed: *mut c_int,
    length: c_ulong,
) {
    // SAFETY: see above
    unsafe {
        let name = text(name, length as usize);
        answer_array(&name, numbers(ids, *n), (values, n_values), failed);
    }
}

/// Takes derivatives, which nobody needs: they are found by differences.
#[unsafe(no_mangle)]
unsafe extern "C" fn syspar_(
    _name: *const c_char,
    _ids: *const c_int,
    _n: *const c_int,
    _slopes: *const f64,
    _n_slopes: *const c_int,
    failed: *mut c_int,
    _length: c_ulong,
) {
    // SAFETY: see above
    unsafe { put(failed, 0) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn errmes_(
    failed: *const c_int,
    message: *const c_char,
    _id: *const c_int,
    ends: *const c_char,
    length: c_ulong,
    length_of_ends: c_ulong,
) {
    // SAFETY: see above
    unsafe {
        let ends = text(ends, length_of_ends as usize);
        complain(*failed, &text(message, length as usize), &ends);
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn usrmes_(
    wanted: *const c_int,
    message: *const c_char,
    _id: *const c_int,
    kind: *const c_char,
    length: c_ulong,
    length_of_kind: c_ulong,
) {
    // SAFETY: see above
    unsafe {
        let kind = text(kind, length_of_kind as usize);
        say(*wanted, &text(message, length as usize), &kind);
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn timget_(time: *mut f64) {
    // SAFETY: see above
    unsafe { put(time, asked::time().unwrap_or(0.0)) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn c_sysfnc(
    name: *const c_char,
    ids: *const c_int,
    n: c_int,
    value: *mut f64,
    failed: *mut c_int,
) {
    // SAFETY: see above
    unsafe { answer(&text(name, MOST_LETTERS), numbers(ids, n), value, failed) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn c_sysary(
    name: *const c_char,
    ids: *const c_int,
    n: c_int,
    values: *mut f64,
    n_values: *mut c_int,
    failed: *mut c_int,
) {
    // SAFETY: see above
    unsafe {
        let name = text(name, MOST_LETTERS);
        answer_array(&name, numbers(ids, n), (values, n_values), failed);
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn c_syspar(
    _name: *const c_char,
    _ids: *const c_int,
    _n: c_int,
    _slopes: *const f64,
    _n_slopes: c_int,
    failed: *mut c_int,
) {
    // SAFETY: see above
    unsafe { put(failed, 0) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn c_errmes(
    failed: c_int,
    message: *const c_char,
    _id: c_int,
    ends: *const c_char,
) {
    // SAFETY: see above
    unsafe {
        complain(
            failed,
            &text(message, MOST_LETTERS),
            &text(ends, MOST_LETTERS),
        )
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn c_usrmes(
    wanted: c_int,
    message: *const c_char,
    _id: c_int,
    kind: *const c_char,
) {
    // SAFETY: see above
    unsafe {
        say(
            wanted,
            &text(message, MOST_LETTERS),
            &text(kind, MOST_LETTERS),
        )
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn c_timget(time: *mut f64) {
    // SAFETY: see above
    unsafe { put(time, asked::time().unwrap_or(0.0)) }
}
