//! Ctrl-C and progress while a simulation goes on, with Python's lock released.

use cognate::analysis::watch::Watch;
use cognate::numeric::Stats;
use pyo3::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time between two looks for signals.
pub const BETWEEN_LOOKS: Duration = Duration::from_millis(20);
/// Time between two calls of a progress callback.
const BETWEEN_REPORTS: Duration = Duration::from_millis(100);

/// The first exception that something called from a simulation has raised: a signal handler, a
/// progress callback, a routine for USER.
#[derive(Clone, Debug, Default)]
pub struct Raised(Arc<Mutex<Option<PyErr>>>);

impl Raised {
    /// Keeps an exception, unless there is one.
    pub fn keep(&self, e: PyErr) {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .get_or_insert(e);
    }

    /// Returns true if there is an exception.
    pub fn is_set(&self) -> bool {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .is_some()
    }

    /// Returns the exception, and forgets it.
    pub fn take(&self) -> Option<PyErr> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

/// The hooks of a simulation that Python waits for.
#[derive(Debug)]
pub struct Attended {
    raised: Raised,
    /// called with the time that has been reached
    progress: Option<Py<PyAny>>,
    looked: Instant,
    reported: Instant,
}

impl Attended {
    /// Begins to attend; exceptions end the simulation and are kept in `raised`.
    pub fn new(raised: Raised, progress: Option<Py<PyAny>>) -> Self {
        let now = Instant::now();
        Self {
            raised,
            progress,
            looked: now,
            reported: now,
        }
    }
}

impl Watch for Attended {
    fn interrupted(&mut self) -> bool {
        if self.looked.elapsed() >= BETWEEN_LOOKS {
            if let Err(e) = Python::attach(|py| py.check_signals()) {
                self.raised.keep(e);
            }
            self.looked = Instant::now();
        }
        self.raised.is_set()
    }

    fn progress(&mut self, t: f64, _h: f64, _stats: &Stats) {
        let Some(progress) = &self.progress else {
            return;
        };
        if self.reported.elapsed() < BETWEEN_REPORTS {
            return;
        }
        if let Err(e) = Python::attach(|py| progress.call1(py, (t,))) {
            self.raised.keep(e);
        }
        self.reported = Instant::now();
    }
}
