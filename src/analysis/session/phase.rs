//! Phases of a simulation, each with its time.

use crate::analysis::work_limit::ProcessorClock;
use crate::clock::Moment;
use crate::expr::program::translation_time;
use crate::results::Seconds;
use std::time::Duration;

/// A phase that has begun; translation of programs within it is told apart.
#[must_use]
pub(super) struct Phase {
    clock: Moment,
    processor: ProcessorClock,
    translation: Duration,
}

impl Phase {
    /// Begins a phase.
    pub(super) fn begin() -> Self {
        Phase {
            clock: Moment::now(),
            processor: ProcessorClock::start(),
            translation: translation_time(),
        }
    }

    /// Returns its time so far without that of translation, and the time of translation, in s.
    pub(super) fn elapsed(&self) -> (f64, f64) {
        let translation = translation_time().saturating_sub(self.translation);
        let own = self.clock.elapsed().saturating_sub(translation);
        (own.as_secs_f64(), translation.as_secs_f64())
    }

    /// Returns the processor time of this thread so far, in s, for `part` of all the time so far.
    ///
    /// The rest of a phase lies between its pieces of work: where others keep the processor busy,
    /// both wait for it alike.
    pub(super) fn processor_seconds(&self, part: f64) -> f64 {
        let passed = self.clock.elapsed().as_secs_f64();
        self.processor.seconds() * (part / passed.max(f64::MIN_POSITIVE)).min(1.0)
    }

    /// Ends a phase: adds its time to the one of its name.
    pub(super) fn end(self, seconds: &mut Seconds, name: impl Fn(&mut Seconds) -> &mut f64) {
        let (own, translation) = self.elapsed();
        *name(seconds) += own;
        seconds.translate += translation;
    }
}
