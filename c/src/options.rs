//! Choices of a session, beyond what its dataset says.

use crate::door::{changed, door, quiet, text, usage};
use crate::error::CognateError;
use engine::Error;
use engine::analysis::session::{Accuracy, Options};
use engine::model::ElementKind;
use std::ffi::c_char;

/// Choices of a session. What is not chosen is as the dataset says.
pub struct CognateOptions {
    pub(crate) options: Options,
    /// whether columns of all parts and joints are wanted; `None`: where the dataset asks for
    /// RESULTS, or nothing is asked for
    pub(crate) full: Option<bool>,
    pub(crate) name: String,
}

impl Default for CognateOptions {
    fn default() -> Self {
        let options = Options {
            repeat: 1,
            ..Options::default()
        };
        Self {
            options,
            full: None,
            name: "run".into(),
        }
    }
}

/// Gives options a choice that is a text.
unsafe fn choose(
    options: *mut CognateOptions,
    (given, name): (*const c_char, &str),
    error: *mut *mut CognateError,
    put: impl FnOnce(&mut CognateOptions, &str) -> Result<(), Error>,
) -> bool {
    let work = || {
        // SAFETY: a handle and a text of the caller
        let (options, text) = unsafe { (changed(options, "options")?, text(given, name)?) };
        put(options, text).map(|()| true)
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}

/// Gives options a choice that cannot be wrong; NULL: nothing happens.
unsafe fn set(options: *mut CognateOptions, put: impl FnOnce(&mut CognateOptions)) {
    // SAFETY: NULL or a handle
    if let Some(options) = unsafe { options.as_mut() } {
        quiet((), || put(options));
    }
}

/// Returns options of which none is chosen.
#[unsafe(no_mangle)]
pub extern "C" fn cognate_options_new() -> *mut CognateOptions {
    quiet(std::ptr::null_mut(), || Box::into_raw(Box::default()))
}

/// Asks for a further column: an expression of the function language, in which elements may have
/// their names ("DX(slider.cm, ground)"), or a component of a set of results ("crank_bearing.FX").
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_column(
    options: *mut CognateOptions,
    expression: *const c_char,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: a handle, a text and a place of the caller
    unsafe {
        choose(
            options,
            (expression, "expression"),
            error,
            |options, text| {
                options.options.columns.push(text.to_owned());
                Ok(())
            },
        )
    }
}

/// Chooses the permitted local error of the integration.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_error(options: *mut CognateOptions, permitted: f64) {
    // SAFETY: NULL or a handle
    unsafe { set(options, |o| o.options.error = Some(permitted)) }
}

/// Chooses the method of integration by its name; "AUTO" chooses by itself.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_method(
    options: *mut CognateOptions,
    name: *const c_char,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: a handle, a text and a place of the caller
    unsafe {
        choose(options, (name, "name"), error, |options, text| {
            options.options.method = Some(text.to_owned());
            Ok(())
        })
    }
}

/// Chooses the base name of results.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_name(
    options: *mut CognateOptions,
    name: *const c_char,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: a handle, a text and a place of the caller
    unsafe {
        choose(options, (name, "name"), error, |options, text| {
            text.clone_into(&mut options.name);
            Ok(())
        })
    }
}

/// Leaves out elements of a statement ("CONTACT") where they are not solved.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_skip(
    options: *mut CognateOptions,
    keyword: *const c_char,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: a handle, a text and a place of the caller
    unsafe {
        choose(options, (keyword, "keyword"), error, |options, text| {
            let kind = text.to_uppercase().parse::<ElementKind>();
            let what = format!("{text} is no statement");
            let kind = kind.map_err(|_| usage(what, "give a keyword of datasets: CONTACT"))?;
            options.options.skip.insert(kind);
            Ok(())
        })
    }
}

/// Asks for one way to say how far off a run is, or does so no longer.
fn ask(accuracy: &mut Accuracy, way: Accuracy, wanted: bool) {
    if wanted {
        *accuracy = way;
    } else if *accuracy == way {
        *accuracy = Accuracy::Unknown;
    }
}

/// Gives every column bars of error (a column "name±" each), from a further run at a smaller
/// permitted error.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_accuracy(options: *mut CognateOptions, wanted: bool) {
    // SAFETY: NULL or a handle
    unsafe {
        set(options, |o| {
            ask(&mut o.options.accuracy, Accuracy::Bars, wanted)
        })
    }
}

/// Says how many digits of the results to believe ("accuracy" in the record), from a further
/// integration of each dynamic simulation at a larger permitted error: about six tenths of its
/// time. Instead of bars of error, and they instead of it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_digits(options: *mut CognateOptions, wanted: bool) {
    // SAFETY: NULL or a handle
    unsafe {
        set(options, |o| {
            ask(&mut o.options.accuracy, Accuracy::Digits, wanted)
        })
    }
}

/// Asks for sets of results of all elements, or for what is asked for alone. Without a word a
/// session has all of them where the dataset asks for RESULTS, or where no column and no REQUEST is
/// asked for (of a model of more than 400 elements then the places of the bodies).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_full(options: *mut CognateOptions, wanted: bool) {
    // SAFETY: NULL or a handle
    unsafe { set(options, |o| o.full = Some(wanted)) }
}

/// Asks for positions and angles of all parts, whatever else is recorded.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_frames(options: *mut CognateOptions, wanted: bool) {
    // SAFETY: NULL or a handle
    unsafe { set(options, |o| o.options.frames = wanted) }
}

/// Takes what USER would compute as zero where no routine is given.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_zero_user(options: *mut CognateOptions, wanted: bool) {
    // SAFETY: NULL or a handle
    unsafe { set(options, |o| o.options.zero_user = wanted) }
}

/// Runs motions whose displacement or velocity jumps, piece by piece.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_piecewise(options: *mut CognateOptions, wanted: bool) {
    // SAFETY: NULL or a handle
    unsafe { set(options, |o| o.options.piecewise = wanted) }
}

/// Limits the processor time of a session [s] and the steps that an integration may try; 0: no
/// limit. Where one is reached the status is COGNATE_STATUS_LIMIT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_limit(
    options: *mut CognateOptions,
    seconds: f64,
    steps: usize,
) {
    // SAFETY: NULL or a handle
    unsafe {
        set(options, |o| {
            o.options.limit = (seconds > 0.0).then_some(seconds);
            o.options.max_steps = (steps > 0).then_some(steps);
        });
    }
}

/// Integrates mechanisms that nothing couples on so many threads, which change no result; 0: on the
/// one that calls.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_threads(options: *mut CognateOptions, threads: usize) {
    // SAFETY: NULL or a handle
    unsafe {
        set(options, |o| {
            o.options.threads = (threads > 0).then_some(threads)
        })
    }
}

/// Gives options back; sessions made with them go on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_options_free(options: *mut CognateOptions) {
    if !options.is_null() {
        // SAFETY: made by `cognate_options_new`, given back once
        quiet((), || drop(unsafe { Box::from_raw(options) }));
    }
}
