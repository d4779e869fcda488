//! SYSFNC and SYSARY: the functions by which a routine reads the model.
//!
//! A routine says what it reads by asking: it is called once with `iflag` = 1 before anything is
//! computed, and what it asks for then becomes the inputs of its element. Later it is told their
//! values. It must ask for all it reads in that first call, as Adams wants it to.

use engine::expr;
use engine::expr::ast::Dialect;
use std::cell::RefCell;
use std::ffi::{CStr, c_char, c_int};
use std::sync::Arc;

/// The call of a routine that is going on in this thread.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// inputs of its element: expressions
    pub inputs: Arc<Vec<String>>,
    /// their values; empty while inputs are being found out
    pub values: Vec<f64>,
    /// inputs that it has asked for in the first call
    pub found: Vec<String>,
    /// it is the first call
    pub finding: bool,
    /// an input that it has asked for, but not in the first call
    pub lacking: Option<String>,
}

thread_local! {
    static CALL: RefCell<Option<Asked>> = const { RefCell::new(None) };
}

/// Calls a routine that may ask; returns what it has asked.
pub fn within(call: Asked, routine: impl FnOnce()) -> Asked {
    let before = CALL.with(|c| c.replace(Some(call)));
    routine();
    CALL.with(|c| c.replace(before)).unwrap_or_default()
}

impl Asked {
    fn value(&mut self, input: String) -> f64 {
        if self.finding {
            if !self.found.contains(&input) {
                self.found.push(input);
            }
            return 0.0;
        }
        match self.inputs.iter().position(|known| *known == input) {
            Some(k) => self.values.get(k).copied().unwrap_or(0.0),
            None => {
                self.lacking.get_or_insert(input);
                0.0
            }
        }
    }
}

/// Names of SYSARY: their functions, and how many markers each takes.
const ARRAYS: &[(&str, &[(&str, usize)])] = &[
    ("TDISP", &[("DX", 3), ("DY", 3), ("DZ", 3)]),
    ("RDISP", &[("PSI", 2), ("THETA", 2), ("PHI", 2)]),
    (
        "DISP",
        &[
            ("DX", 3),
            ("DY", 3),
            ("DZ", 3),
            ("PSI", 2),
            ("THETA", 2),
            ("PHI", 2),
        ],
    ),
    ("TVEL", &[("VX", 4), ("VY", 4), ("VZ", 4)]),
    ("RVEL", &[("WX", 3), ("WY", 3), ("WZ", 3)]),
    (
        "VEL",
        &[
            ("VX", 4),
            ("VY", 4),
            ("VZ", 4),
            ("WX", 3),
            ("WY", 3),
            ("WZ", 3),
        ],
    ),
    ("TACC", &[("ACCX", 4), ("ACCY", 4), ("ACCZ", 4)]),
    ("RACC", &[("WDTX", 4), ("WDTY", 4), ("WDTZ", 4)]),
    (
        "ACC",
        &[
            ("ACCX", 4),
            ("ACCY", 4),
            ("ACCZ", 4),
            ("WDTX", 4),
            ("WDTY", 4),
            ("WDTZ", 4),
        ],
    ),
    ("TFORCE", &[("FX", 3), ("FY", 3), ("FZ", 3)]),
    ("RFORCE", &[("TX", 3), ("TY", 3), ("TZ", 3)]),
    (
        "FORCE",
        &[
            ("FX", 3),
            ("FY", 3),
            ("FZ", 3),
            ("TX", 3),
            ("TY", 3),
            ("TZ", 3),
        ],
    ),
];

/// Writes a call: `DX(1, 2)`, trailing zeros left out; `None`: the language has no such function.
fn written(name: &str, ids: &[c_int]) -> Option<String> {
    let all: Vec<String> = ids.iter().map(ToString::to_string).collect();
    let given = ids.iter().rposition(|id| *id != 0).map_or(0, |k| k + 1);
    let text = format!("{}({})", name.to_uppercase(), all[..given].join(","));
    let input = expr::input_named(&text, Dialect::Function).ok()?;
    Some(input.to_string())
}

fn ask(name: &str, ids: &[c_int]) -> Option<f64> {
    let text = written(name, ids)?;
    CALL.with(|c| c.borrow_mut().as_mut().map(|call| call.value(text)))
}

/// Puts the values of an array into their places; returns how many there are.
fn ask_array(name: &str, ids: &[c_int], states: &mut [f64; 6]) -> Option<usize> {
    let row = ARRAYS.iter().find(|row| row.0.eq_ignore_ascii_case(name))?;
    for (place, (function, most)) in states.iter_mut().zip(row.1) {
        *place = ask(function, &ids[..ids.len().min(*most)])?;
    }
    Some(row.1.len())
}

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
    let mut states = [0.0; 6];
    let found = name.and_then(|name| ask_array(name.to_str().ok()?.trim(), ids, &mut states));
    let count = found.unwrap_or(0);
    if !values.is_null() {
        // SAFETY: there are as many places as the name has values
        unsafe { std::slice::from_raw_parts_mut(values, count) }.copy_from_slice(&states[..count]);
    }
    if let Some(n_values) = n_values {
        *n_values = count as c_int;
    }
    if let Some(failed) = failed {
        *failed = c_int::from(found.is_none());
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
