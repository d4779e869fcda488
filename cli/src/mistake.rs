//! The first mistake of code of the user's that a run calls: it ends the run.

use cognate::diagnostic::{Diagnostic, Error};
use std::sync::{Arc, Mutex, PoisonError};

/// The first mistake of a routine, which ends the run.
#[derive(Clone, Debug, Default)]
pub struct Mistake(Arc<Mutex<Option<Diagnostic>>>);

impl Mistake {
    /// Keeps a mistake, unless there is one.
    #[cfg(all(unix, feature = "routines"))]
    pub fn keep(&self, d: Diagnostic) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.get_or_insert(d);
    }

    /// Returns true if there is one.
    pub fn is_there(&self) -> bool {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.is_some()
    }

    /// Returns it as the error that has come before whatever else has happened; without one, what
    /// has happened.
    ///
    /// # Errors
    /// It, and those of the outcome.
    pub fn before<T>(&self, outcome: Result<T, Error>) -> Result<T, Error> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        match kept {
            Some(mistake) => Err(mistake.into()),
            None => outcome,
        }
    }
}
