//! Simulations one after another: run, columns, files, state.

use crate::door::{door, given, quiet, seen, text, usage, words};
use crate::error::CognateError;
use crate::model::{CognateModel, commands, located};
use crate::options::CognateOptions;
use crate::rows::Message;
use engine::Error;
use engine::analysis::linear::Wanted;
use engine::analysis::session::script::obey;
use engine::analysis::session::state::Saved;
use engine::analysis::session::{Accuracy, Options, Session, check_column};
use engine::analysis::watch::Watch;
use engine::dataset::Dataset;
use engine::dataset::command::{Simulate, SimulationKind};
use engine::diagnostic::Diagnostic;
use engine::internals::dataset::surface::Surfaces;
use engine::internals::report::mechanism::page::page_of_run;
use engine::model::SettingsStatement;
use engine::numeric::Stats;
use engine::results::format::Style;
use engine::results::{self, Event, Status, json};
use std::ffi::{CString, c_char, c_void};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};

/// A model and its clock: simulations one after another, each from where the last one ended.
pub struct CognateSession {
    inner: Mutex<Inner>,
    interrupted: AtomicBool,
}

/// All of a session but what other threads may touch.
pub struct Inner {
    /// the library's session
    pub session: Session,
    /// the dataset as written, which knows the places
    dataset: Arc<Dataset>,
    /// what a routine has done wrong
    pub failure: Failure,
    progress: Option<Progress>,
    /// every column has bars of error
    pub has_bars: bool,
    /// the receiver of rows has had enough of them
    pub enough: Arc<AtomicBool>,
    /// the reader that is told when a simulation has ended
    pub reader: Option<Sender<Message>>,
    /// names and units of columns, for C
    columns: Vec<(CString, CString)>,
    /// libraries whose routines it calls; they go after the session, which is declared above them
    pub libraries: Vec<libloading::Library>,
}

/// The first mistake of a routine, which ends the simulation.
#[derive(Clone, Debug, Default)]
pub struct Failure(Arc<Mutex<Option<Diagnostic>>>);

impl Failure {
    /// Keeps a mistake, unless there is one.
    pub fn keep(&self, d: Diagnostic) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .get_or_insert(d);
    }

    /// Returns true if there is a mistake.
    pub fn is_set(&self) -> bool {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .is_some()
    }

    fn take(&self) -> Option<Diagnostic> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// A callback after each step: called with `data` and the time that has been reached; returns
/// false to end the simulation, with the results so far.
pub type CognateProgress = Option<extern "C" fn(data: *mut c_void, time: f64) -> bool>;

/// A callback with its data.
#[derive(Clone, Copy)]
struct Progress {
    callback: extern "C" fn(*mut c_void, f64) -> bool,
    data: *mut c_void,
}

// SAFETY: the data are handed back to the caller's callback alone, in the thread that called; the
// caller moves a session between threads only between calls (header)
unsafe impl Send for Progress {}

/// The hooks of a simulation.
struct Watcher<'a> {
    interrupted: &'a AtomicBool,
    enough: Arc<AtomicBool>,
    failure: Failure,
    progress: Option<Progress>,
    stop: bool,
}

impl Watch for Watcher<'_> {
    fn interrupted(&mut self) -> bool {
        let is_set = |flag: &AtomicBool| flag.load(Ordering::Relaxed);
        self.stop || self.failure.is_set() || is_set(self.interrupted) || is_set(&self.enough)
    }
    fn progress(&mut self, t: f64, _h: f64, _stats: &Stats) {
        if let Some(Progress { callback, data }) = self.progress {
            self.stop |= !callback(data, t);
        }
    }
}

/// The kind of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum CognateKind {
    /// kinematic without freedom, else dynamic
    Transient,
    /// forces move it
    Dynamic,
    /// motions alone move it
    Kinematic,
    /// an equilibrium, or one at each output time
    Static,
    /// assembled positions and velocities
    InitialConditions,
}

/// The way in which a simulation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum CognateStatus {
    /// everything that was asked for was done
    Completed,
    /// the model has no consistent configuration, or contradicts itself
    Model,
    /// no equilibrium was found
    NoEquilibrium,
    /// the integration could not go on
    Stopped,
    /// a limit of time or steps was reached
    Limit,
    /// cognate_session_interrupt, or the callback for progress or for rows, ended it
    Interrupted,
}

impl From<Status> for CognateStatus {
    fn from(status: Status) -> Self {
        match status {
            Status::Completed => CognateStatus::Completed,
            Status::Model => CognateStatus::Model,
            Status::NoEquilibrium => CognateStatus::NoEquilibrium,
            Status::Stopped => CognateStatus::Stopped,
            Status::Limit => CognateStatus::Limit,
            Status::Interrupted => CognateStatus::Interrupted,
        }
    }
}

impl CognateSession {
    /// Returns the session behind a handle, unless another thread is at work in it.
    ///
    /// # Errors
    /// NULL; another thread at work; a panic before.
    pub unsafe fn of<'a>(session: *const Self) -> Result<MutexGuard<'a, Inner>, Error> {
        // SAFETY: NULL or a handle
        let session = unsafe { seen(session, "session") }?;
        session.inner.try_lock().map_err(|e| match e {
            TryLockError::WouldBlock => usage(
                "another thread is at work in this session",
                "a session belongs to one thread at a time; a routine cannot call it either",
            ),
            TryLockError::Poisoned(_) => usage(
                "this session has failed before by our mistake",
                "give it back and begin a new one",
            ),
        })
    }
}

impl Inner {
    /// Runs something long; tells how it ended.
    fn work(
        &mut self,
        interrupted: &AtomicBool,
        go: impl FnOnce(&mut Session, &mut Watcher<'_>) -> Result<Status, Error>,
    ) -> Result<Status, Error> {
        interrupted.store(false, Ordering::Relaxed);
        self.enough.store(false, Ordering::Relaxed);
        let (failure, progress) = (self.failure.clone(), self.progress);
        let mut watcher = Watcher {
            interrupted,
            enough: Arc::clone(&self.enough),
            failure,
            progress,
            stop: false,
        };
        let outcome = go(&mut self.session, &mut watcher);
        self.columns.clear();
        if let Some(reader) = &self.reader {
            // a reader that has gone need not be told
            let _ = reader.send(Message::Ended);
        }
        if let Some(d) = self.failure.take() {
            return Err(d.into());
        }
        outcome.map_err(|wrong| located(&self.dataset, wrong))
    }

    fn columns(&mut self) -> &[(CString, CString)] {
        let columns = &self.session.run.columns;
        if self.columns.len() != columns.len() {
            let told = columns
                .iter()
                .map(|c| (words(c.name.clone()), words(c.unit.clone())));
            self.columns = told.collect();
        }
        &self.columns
    }
}

/// Does something with a session; where it fails tells why and returns `failed`.
pub unsafe fn with<T>(
    session: *const CognateSession,
    error: *mut *mut CognateError,
    failed: T,
    go: impl FnOnce(&mut Inner) -> Result<T, Error>,
) -> T {
    let work = || {
        // SAFETY: a handle of the caller
        let mut inner = unsafe { CognateSession::of(session) }?;
        go(&mut inner)
    };
    // SAFETY: a place of the caller
    unsafe { door(error, failed, work) }
}

/// Looks at a session; where there is none, or it is at work, returns `none`.
unsafe fn look<T>(
    session: *const CognateSession,
    none: T,
    go: impl FnOnce(&mut Inner) -> Option<T>,
) -> T {
    let found = quiet(None, || {
        // SAFETY: a handle of the caller
        let inner = unsafe { CognateSession::of(session) };
        inner.ok().and_then(|mut inner| go(&mut inner))
    });
    found.unwrap_or(none)
}

/// Simulates, and tells by `status`, which may be NULL, how that ended.
unsafe fn simulated(
    session: *mut CognateSession,
    status: *mut CognateStatus,
    go: impl FnOnce(&mut Session, &mut Watcher<'_>) -> Result<Status, Error>,
) -> Result<bool, Error> {
    // SAFETY: a handle of the caller
    let (mut inner, handle) = unsafe { (CognateSession::of(session)?, seen(session, "session")?) };
    let ended = inner.work(&handle.interrupted, go)?;
    // SAFETY: NULL or a place
    if let Some(status) = unsafe { status.as_mut() } {
        *status = ended.into();
    }
    Ok(true)
}

/// Begins a session of a model, at time 0; NULL: an option is wrong. `options` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_new(
    model: *const CognateModel,
    options: *const CognateOptions,
    error: *mut *mut CognateError,
) -> *mut CognateSession {
    let work = || {
        // SAFETY: handles of the caller
        let (model, options) = unsafe { (seen(model, "model")?, options.as_ref()) };
        let default = CognateOptions::default();
        let CognateOptions {
            options,
            full,
            name,
        } = options.unwrap_or(&default);
        let mut wrong = Vec::new();
        for (k, column) in options.columns.iter().enumerate() {
            for mut d in check_column(&model.model, column) {
                d.file = Some(format!("column {}", k + 1));
                wrong.push(d);
            }
        }
        if !wrong.is_empty() {
            return Err(wrong.into());
        }
        let asked = model
            .model
            .settings
            .contains_key(&SettingsStatement::Results);
        let mut options = Options {
            full: full.unwrap_or(asked),
            named_only: *full == Some(false),
            ..options.clone()
        };
        model.prepared.setup.solve.complete(&mut options);
        let has_bars = options.accuracy == Accuracy::Bars;
        let mut session = Session::new(model.model.clone(), name, options);
        session.folders = model.folder().into_iter().collect();
        session.run.record.loads.clone_from(&model.prepared.loads);
        session.at_rest_first = model.prepared.setup.solve.at_rest_first;
        let title = Event::Title(session.run.title.clone());
        session.run.log.push(title);
        let inner = Inner {
            session,
            dataset: Arc::clone(&model.dataset),
            failure: Failure::default(),
            progress: None,
            has_bars,
            enough: Arc::default(),
            reader: None,
            columns: Vec::new(),
            libraries: Vec::new(),
        };
        let (inner, interrupted) = (Mutex::new(inner), AtomicBool::new(false));
        Ok(Box::into_raw(Box::new(CognateSession {
            inner,
            interrupted,
        })))
    };
    // SAFETY: a place of the caller
    unsafe { door(error, std::ptr::null_mut(), work) }
}

/// Sets the callback after each step; NULL: none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_progress(
    session: *mut CognateSession,
    callback: CognateProgress,
    data: *mut c_void,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: a handle and a place of the caller
    unsafe {
        with(session, error, false, |inner| {
            inner.progress = callback.map(|callback| Progress { callback, data });
            Ok(true)
        })
    }
}

/// Ends the simulation that is going on in another thread, with the results so far.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_interrupt(session: *const CognateSession) {
    // SAFETY: NULL or a handle
    if let Some(session) = unsafe { session.as_ref() } {
        session.interrupted.store(true, Ordering::Relaxed);
    }
}

/// Simulates on to `end`, a time of the clock, with `steps` output steps. `kind`: a CognateKind. A
/// first simulation over time begins at equilibrium where the set-up beside the model asks for that.
///
/// Returns false where the model or the call is wrong. A numerical failure is no mistake: it is
/// told by `status`, which may be NULL, and results so far are kept.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_simulate(
    session: *mut CognateSession,
    kind: u32,
    end: f64,
    steps: u32,
    status: *mut CognateStatus,
    error: *mut *mut CognateError,
) -> bool {
    let work = || {
        let kind = match kind {
            k if k == CognateKind::Transient as u32 => SimulationKind::Transient,
            k if k == CognateKind::Dynamic as u32 => SimulationKind::Dynamic,
            k if k == CognateKind::Kinematic as u32 => SimulationKind::Kinematic,
            k if k == CognateKind::Static as u32 => SimulationKind::Static,
            k if k == CognateKind::InitialConditions as u32 => SimulationKind::InitialConditions,
            _ => return Err(usage("kind is none of them", "see CognateKind")),
        };
        let simulate = Simulate {
            kind,
            end: Some(end),
            duration: None,
            steps: Some(steps),
            dtout: None,
        };
        let go =
            |session: &mut Session, watch: &mut Watcher<'_>| session.simulate_as(&simulate, watch);
        // SAFETY: a handle and a place of the caller
        unsafe { simulated(session, status, go) }
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}

/// Obeys commands, one a line, as a command file (.acf) holds them. `status`, which may be NULL:
/// how the last simulation ended.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_obey(
    session: *mut CognateSession,
    script: *const c_char,
    status: *mut CognateStatus,
    error: *mut *mut CognateError,
) -> bool {
    let work = || {
        // SAFETY: a text of the caller
        let script = commands(unsafe { text(script, "script") }?)?;
        let go = |session: &mut Session, watch: &mut Watcher<'_>| {
            obey(session, &script.steps, |_, _| (), watch)
        };
        // SAFETY: a handle and a place of the caller
        unsafe { simulated(session, status, go) }
    };
    // SAFETY: a place of the caller
    unsafe { door(error, false, work) }
}

/// Returns the clock of a session; NaN where it cannot be told.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_time(session: *const CognateSession) -> f64 {
    // SAFETY: a handle of the caller
    unsafe { look(session, f64::NAN, |inner| Some(inner.session.time())) }
}

/// Returns the number of columns of the results so far; the first is time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_columns(session: *const CognateSession) -> usize {
    // SAFETY: a handle of the caller
    unsafe { look(session, 0, |inner| Some(inner.session.run.columns.len())) }
}

/// Returns the name of a column, until the next simulation; NULL: there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_name(
    session: *const CognateSession,
    column: usize,
) -> *const c_char {
    let told = |inner: &mut Inner| Some(inner.columns().get(column)?.0.as_ptr());
    // SAFETY: a handle of the caller
    unsafe { look(session, std::ptr::null(), told) }
}

/// Returns the unit of a column as result files spell it, until the next simulation; "": a pure
/// number; NULL: there is no such column.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_unit(
    session: *const CognateSession,
    column: usize,
) -> *const c_char {
    let told = |inner: &mut Inner| Some(inner.columns().get(column)?.1.as_ptr());
    // SAFETY: a handle of the caller
    unsafe { look(session, std::ptr::null(), told) }
}

/// Finds a column by its name, without regard to blanks and case, or by its element
/// ("JOINT/1.FX"); SIZE_MAX: there is none, or there are several.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_find(
    session: *const CognateSession,
    name: *const c_char,
) -> usize {
    // SAFETY: a handle and a text of the caller
    unsafe {
        look(session, usize::MAX, |inner| {
            inner.session.run.find(text(name, "name").ok()?)
        })
    }
}

/// Returns the numbers of a column, until the next simulation, and puts how many there are into
/// `n`; NULL: there is no such column.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_column(
    session: *const CognateSession,
    column: usize,
    n: *mut usize,
) -> *const f64 {
    // SAFETY: NULL or a place
    let mut n = unsafe { n.as_mut() };
    if let Some(n) = n.as_deref_mut() {
        *n = 0;
    }
    let values = |inner: &mut Inner| {
        let column = inner.session.run.columns.get(column)?;
        if let Some(n) = n {
            *n = column.values.len();
        }
        Some(column.values.as_ptr())
    };
    // SAFETY: a handle of the caller
    unsafe { look(session, std::ptr::null(), values) }
}

/// Returns the run record as JSON: status, reason, counts, timings, energy, warnings. To be given
/// back by cognate_string_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_record(
    session: *const CognateSession,
    error: *mut *mut CognateError,
) -> *mut c_char {
    let record = |inner: &mut Inner| Ok(given(json::text(&json::record(&inner.session.run))));
    // SAFETY: a handle and a place of the caller
    unsafe { with(session, error, std::ptr::null_mut(), record) }
}

/// Linearizes about the present state, between all plant inputs and outputs: matrices A, B, C, D,
/// names, eigenvalues and mode shapes as JSON, to be given back by cognate_string_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_linearize(
    session: *mut CognateSession,
    error: *mut *mut CognateError,
) -> *mut c_char {
    // SAFETY: a handle and a place of the caller
    unsafe {
        with(session, error, std::ptr::null_mut(), |inner| {
            let found = inner.session.linearize(&Wanted::default());
            let found = found.map_err(|wrong| located(&inner.dataset, wrong))?;
            Ok(given(json::text(&found.json())))
        })
    }
}

/// Writes the results so far to a file; the ending of its name tells the format: .csv, .parquet,
/// .res, .json, .msg.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_write(
    session: *const CognateSession,
    path: *const c_char,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: a handle, a text and a place of the caller
    unsafe {
        with(session, error, false, |inner| {
            let path = Path::new(text(path, "path")?);
            results::write(&inner.session.run, path, Style::default())?;
            Ok(true)
        })
    }
}

/// Writes a page (.html) that shows the run in motion in any browser, and needs nothing else. The
/// session wants cognate_options_frames. Shells whose files cannot be read are left out.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_page(
    session: *const CognateSession,
    path: *const c_char,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: a handle, a text and a place of the caller
    unsafe {
        with(session, error, false, |inner| {
            let path = Path::new(text(path, "path")?);
            let session = &inner.session;
            let surfaces = Surfaces::read(&session.model, &session.folders);
            let page = page_of_run(&session.model, &session.run, &surfaces)?;
            results::write_text(path, &page)?;
            Ok(true)
        })
    }
}

/// Returns the state of a session as a text, from which another one goes on, also elsewhere. To be
/// given back by cognate_string_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_state(
    session: *const CognateSession,
    error: *mut *mut CognateError,
) -> *mut c_char {
    // SAFETY: a handle and a place of the caller
    unsafe {
        with(session, error, std::ptr::null_mut(), |inner| {
            Ok(given(inner.session.save()))
        })
    }
}

/// Goes on from a state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_reload(
    session: *mut CognateSession,
    state: *const c_char,
    error: *mut *mut CognateError,
) -> bool {
    // SAFETY: a handle, a text and a place of the caller
    unsafe {
        with(session, error, false, |inner| {
            let saved = Saved::read(text(state, "state")?.as_bytes())?;
            inner.columns.clear();
            inner.session.reload(saved)?;
            Ok(true)
        })
    }
}

/// Gives a session back.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cognate_session_free(session: *mut CognateSession) {
    if !session.is_null() {
        // SAFETY: made by `cognate_session_new`, given back once
        quiet((), || drop(unsafe { Box::from_raw(session) }));
    }
}
