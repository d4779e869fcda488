//! Phases of a simulation, each with its time.

use crate::clock::Moment;
use crate::expr::program::translation_time;
use crate::results::Seconds;
use std::time::Duration;

/// A phase that has begun; translation of programs within it is told apart.
#[must_use]
pub(super) struct Phase {
    clock: Moment,
    translation: Duration,
}

impl Phase {
    /// Begins a phase.
    pub(super) fn begin() -> Self {
        Phase {
            clock: Moment::now(),
            translation: translation_time(),
        }
    }

    /// Returns its time so far without that of translation, and the time of translation, in s.
    pub(super) fn elapsed(&self) -> (f64, f64) {
        let translation = translation_time().saturating_sub(self.translation);
        let own = self.clock.elapsed().saturating_sub(translation);
        (own.as_secs_f64(), translation.as_secs_f64())
    }

    /// Ends a phase: adds its time to the one of its name.
    pub(super) fn end(self, seconds: &mut Seconds, name: impl Fn(&mut Seconds) -> &mut f64) {
        let (own, translation) = self.elapsed();
        *name(seconds) += own;
        seconds.translate += translation;
    }
}
