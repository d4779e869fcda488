//! Datasets: read from files and from memory, changed, written, verified.

use crate::door::{changed, door, given, quiet, row, seen, text, usage};
use crate::error::CognateError;
use engine::Error;
use engine::analysis::verify::verify;
use engine::dataset::Source;
use engine::dataset::command::{Command, Script};
use engine::dataset::{self, Dataset, Reading};
use engine::diagnostic::{Diagnostic, Severity};
use engine::model::Model;
use engine::results::json;
use engine::setup::{self, Asked, Prepared, Setup};
use std::ffi::c_char;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A multibody model as its dataset (.adm) says.
pub struct CognateModel {
    pub(crate) model: Model,
    /// the dataset as written, which knows the places
    pub(crate) dataset: Arc<Dataset>,
    doubts: Vec<Diagnostic>,
    /// the set-up beside it, and the loads that were chosen
    pub(crate) prepared: Prepared,
}

impl CognateModel {
    /// Returns the handle of a model that has been read, with its set-up.
    ///
    /// # Errors
    /// Mistakes in either.
    pub fn of(reading: Reading, setup: Setup) -> Result<*mut Self, Error> {
        let Reading {
            dataset,
            mut model,
            diagnostics,
            ..
        } = reading;
        let is_error = |d: &Diagnostic| d.severity == Severity::Error;
        let (wrong, doubts): (Vec<_>, Vec<_>) = diagnostics.into_iter().partition(is_error);
        if !wrong.is_empty() {
            return Err(wrong.into());
        }
        let prepared = setup::apply(setup, &mut model, Asked::Kept)?;
        let dataset = Arc::new(dataset);
        Ok(Box::into_raw(Box::new(Self {
            model,
            dataset,
            doubts,
            prepared,
        })))
    }

    /// Returns the folder of its file.
    pub fn folder(&self) -> Option<PathBuf> {
        let file = self.dataset.source.file.as_ref()?;
        Path::new(file).parent().map(Path::to_path_buf)
    }
}

/// Gives mistakes the places of their elements in a dataset.
pub fn located(dataset: &Dataset, wrong: Error) -> Error {
    wrong.map(|d| dataset.locate(d))
}

/// Reads commands from a text.
///
/// # Errors
/// Mistakes in it.
pub fn commands(source: &str) -> Result<Script, Error> {
    // a first line that is no command would be taken as the name of a dataset
    Script::from_text(&format!("\n{source}\n"))
}

/// Reads a dataset from a file, with the set-up that belongs to it.
unsafe fn read_with(
    path: *const c_char,
    error: *mut *mut CognateError,
    setup: impl FnOnce(&Path) -> Result<Setup, Error>,
) -> *mut CognateModel {
    let work = || {
        // SAFETY: a text of the caller
        let path = unsafe { text(path, "path") }?;
        CognateModel::of(dataset::read(path)?, setup(Path::new(path))?)
    };
    // SAFETY: a place of the caller
    unsafe { door(error, std::ptr::null_mut(), work) }
}

/// Returns a text about a model, to be given back by the caller.
unsafe fn told(
    model: *const CognateModel,
    error: *mut *mut CognateError,
    tell: impl FnOnce(&CognateModel) -> Result<String, Error>,
) -> *mut c_char {
    // SAFETY: a handle of the caller
    let work = || tell(unsafe { seen(model, "model") }?).map(given);
    // SAFETY: a place of the caller
    unsafe { door(error, std::ptr::null_mut(), work) }
}

/// Reads a dataset from a file, and the set-up in the file of the same name with the ending .toml:
/// chosen loads, functions that give them, error and method of runs. NULL: one of them has mistakes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_model_read(
    path: *const c_char,
    error: *mut *mut CognateError,
) -> *mut CognateModel {
    // SAFETY: a text and a place of the caller
    unsafe { read_with(path, error, Setup::beside) }
}

/// Reads a dataset from a file, whatever stands beside it; NULL: it has mistakes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_model_read_alone(
    path: *const c_char,
    error: *mut *mut CognateError,
) -> *mut CognateModel {
    // SAFETY: a text and a place of the caller
    unsafe { read_with(path, error, |_| Ok(Setup::default())) }
}

/// Reads a dataset from `length` bytes in memory; NULL: it has mistakes.
///
/// `file` is NULL, or the file that the bytes stand for: in messages, and for the folder of files
/// that the dataset names.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_model_from_memory(
    bytes: *const c_char,
    length: usize,
    file: *const c_char,
    error: *mut *mut CognateError,
) -> *mut CognateModel {
    let work = || {
        // SAFETY: bytes of the caller
        let bytes = unsafe { row(bytes.cast::<u8>(), length, "bytes") }?;
        let file = match file.is_null() {
            true => None,
            // SAFETY: a text of the caller
            false => Some(unsafe { text(file, "file") }?),
        };
        let reading = dataset::read_source(Source::from_bytes(file, bytes));
        CognateModel::of(reading, Setup::default())
    };
    // SAFETY: a place of the caller
    unsafe { door(error, std::ptr::null_mut(), work) }
}

/// Returns warnings and notes about a model, to be given back by cognate_error_free; NULL for NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_model_warnings(model: *const CognateModel) -> *mut CognateError {
    // SAFETY: NULL or a handle
    let Some(model) = (unsafe { model.as_ref() }) else {
        return std::ptr::null_mut();
    };
    quiet(std::ptr::null_mut(), || {
        let more = model
            .model
            .doubts()
            .into_iter()
            .map(|d| model.dataset.locate(d));
        CognateError::handle(model.doubts.iter().cloned().chain(more).collect())
    })
}

/// Changes a model by statements, one a line, as command files hold them: "PART/2, MASS=3",
/// "DEACTIVATE/MOTION, ID=1". Where one of them is wrong the model stays as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_model_change(
    model: *mut CognateModel,
    statements: *const c_char,
    error: *mut *mut CognateError,
) -> bool {
    let work = || {
        // SAFETY: a handle and a text of the caller
        let (model, source) =
            unsafe { (changed(model, "model")?, text(statements, "statements")?) };
        let mut new = model.model.clone();
        for step in commands(source)?.steps {
            if !matches!(step.command, Command::Change(_) | Command::Activate { .. }) {
                let what = format!("`{}` does not change the model", step.text);
                return Err(usage(what, "commands are obeyed by cognate_session_obey"));
            }
            new.apply(&step.command)?;
        }
        model.model = new;
        Ok(true)
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}

/// Returns the dataset of a model as it is now, to be given back by cognate_string_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_model_text(
    model: *const CognateModel,
    error: *mut *mut CognateError,
) -> *mut c_char {
    // SAFETY: a handle and a place of the caller
    unsafe { told(model, error, |model| Ok(model.model.to_text())) }
}

/// Counts the freedoms of a model and tells what is fixed twice and what is free, as JSON, to be
/// given back by cognate_string_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_model_verify(
    model: *const CognateModel,
    error: *mut *mut CognateError,
) -> *mut c_char {
    let tell = |model: &CognateModel| {
        let found = verify(&model.model).map_err(|wrong| located(&model.dataset, wrong))?;
        Ok(json::text(&found.json()))
    };
    // SAFETY: a handle and a place of the caller
    unsafe { told(model, error, tell) }
}

/// Gives a model back; sessions of it go on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_model_free(model: *mut CognateModel) {
    if !model.is_null() {
        // SAFETY: made by `CognateModel::of`, given back once
        quiet((), || drop(unsafe { Box::from_raw(model) }));
    }
}
