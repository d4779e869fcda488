//! Times of a run: where the user's time goes, from the file of the model to the files of results.
//!
//! ```text
//! read → parse → compile → assemble → record → solve → evaluate → write
//!                                         └ translate ┘
//! ```
//!
//! Programs are translated when they have run often enough, while something else goes on: that is
//! taken out of the phase in which it happens, so that no second is counted twice.

use std::time::Duration;

/// Wall clock of the phases of a run, and of the whole, in s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seconds {
    /// bytes of the files of the model
    pub read: f64,
    /// text → model
    pub parse: f64,
    /// model → scene
    pub compile: f64,
    /// positions and velocities on the rows
    pub assemble: f64,
    /// equations → programs
    pub record: f64,
    /// programs → code of the processor
    pub translate: f64,
    /// integration, continuation or search for rest alone; the median where it is repeated
    pub solve: f64,
    /// the further runs that bars of error come from, with all their phases
    pub accuracy: f64,
    /// states → columns, facts of the record
    pub evaluate: f64,
    /// files of results, but for the record itself
    pub write: f64,
    /// from the start to the record
    pub total: f64,
    /// processor time of all threads from the start to the record; the wall clock where the system
    /// does not tell it
    pub processor: f64,
}

impl Seconds {
    /// Notes the time of reading, in s, and that of parsing: the rest of the time that has passed.
    pub fn begin(&mut self, passed: Duration, read: f64) {
        self.read = read;
        self.parse = passed.as_secs_f64() - read;
    }

    /// Returns the time from the model's text to the first step.
    pub fn set_up(&self) -> f64 {
        self.parse + self.compile + self.assemble + self.record + self.translate
    }

    /// Returns all fields with their names in the record, in the order in which they happen.
    pub fn named(&self) -> [(&'static str, f64); 13] {
        [
            ("read", self.read),
            ("set_up", self.set_up()),
            ("parse", self.parse),
            ("compile", self.compile),
            ("assemble", self.assemble),
            ("record", self.record),
            ("translate", self.translate),
            ("solve", self.solve),
            ("accuracy", self.accuracy),
            ("evaluate", self.evaluate),
            ("write", self.write),
            ("total", self.total),
            ("processor", self.processor),
        ]
    }
}
