//! A limit of work: processor time that may be used, and the clock that measures it.

use super::system::System;
use super::trajectory::Trajectory;
use super::watch::Watch;
use crate::clock::{self, Moment};
use crate::numeric::Stats;
use crate::results::Run;
use std::thread::ThreadId;
use std::time::Duration;

/// Shortest time between two looks at the clock of the processor.
const SHORTEST_LOOK: Duration = Duration::from_millis(1);

/// The processor time that all threads of this process use from some moment on. The account of a
/// process begins before the program where it took the place of another, as `cargo run` ends.
#[derive(Clone, Copy, Debug)]
pub struct ProcessClock {
    /// processor time of the process at the beginning; `None`: not known here
    start: Option<Duration>,
    begin: Moment,
}

impl ProcessClock {
    /// Starts a clock.
    pub fn start() -> Self {
        Self {
            start: clock::process_time(),
            begin: Moment::now(),
        }
    }

    /// Returns the time that has passed since the start.
    pub fn elapsed(&self) -> Duration {
        self.begin.elapsed()
    }

    /// Returns the processor time since the start, in s; where the system does not tell it, the
    /// time that has passed.
    pub fn seconds(&self) -> f64 {
        let used = || Some(clock::process_time()?.saturating_sub(self.start?));
        used().unwrap_or_else(|| self.elapsed()).as_secs_f64()
    }
}

/// The processor time that a thread uses from some moment on. Where the system does not tell it,
/// time that passes is taken for it.
#[derive(Clone, Copy, Debug)]
pub struct ProcessorClock {
    thread: ThreadId,
    /// processor time of the thread at the beginning; `None`: not known here
    start: Option<Duration>,
    begin: Moment,
}

impl ProcessorClock {
    /// Starts a clock for the thread that asks.
    pub fn start() -> Self {
        Self {
            thread: std::thread::current().id(),
            start: clock::thread_time(),
            begin: Moment::now(),
        }
    }

    /// Returns the processor time since the start, in s; asked by another thread, the time that has
    /// passed.
    pub fn seconds(&self) -> f64 {
        let own = std::thread::current().id() == self.thread;
        let used = || Some(clock::thread_time()?.saturating_sub(self.start?));
        let used = own.then(used).flatten();
        used.unwrap_or_else(|| self.begin.elapsed()).as_secs_f64()
    }
}

/// Processor time that may be used from some moment on.
#[derive(Clone, Copy, Debug)]
pub struct WorkLimit {
    /// permitted processor time, in s
    pub seconds: f64,
    clock: ProcessorClock,
}

impl WorkLimit {
    /// Permits so many seconds of processor time to the thread that asks, from now on.
    pub fn begin(seconds: f64) -> Self {
        let clock = ProcessorClock::start();
        Self { seconds, clock }
    }

    /// Returns the processor time that is left at least, in s; zero or less: none. A thread uses no
    /// more of it than passes: before that much has, the clock of the processor is not looked at.
    pub fn left(&self) -> f64 {
        let left = self.seconds - self.clock.begin.elapsed().as_secs_f64();
        match left > 0.0 {
            true => left,
            false => self.seconds - self.clock.seconds(),
        }
    }
}

/// The hooks of a caller, who is asked to stop when a limit is reached as well.
pub(in crate::analysis) struct Limited<'a> {
    caller: &'a mut dyn Watch,
    limit: WorkLimit,
    /// when the limit can be reached at the earliest
    look: Moment,
}

impl<'a> Limited<'a> {
    /// Adds a limit to the hooks of a caller.
    pub(in crate::analysis) fn new(caller: &'a mut dyn Watch, limit: WorkLimit) -> Self {
        let look = Moment::now();
        Self {
            caller,
            limit,
            look,
        }
    }

    /// Looks at the clock, no earlier than the limit can have been reached: a thread uses no more
    /// processor time than passes.
    fn is_reached(&mut self) -> bool {
        let now = Moment::now();
        if now < self.look {
            return false;
        }
        let left = self.limit.left();
        if left <= 0.0 {
            return true;
        }
        let left = Duration::try_from_secs_f64(left).unwrap_or(Duration::MAX);
        self.look = now + left.max(SHORTEST_LOOK);
        false
    }
}

impl Watch for Limited<'_> {
    fn interrupted(&mut self) -> bool {
        self.caller.interrupted() || self.is_reached()
    }
    fn progress(&mut self, t: f64, h: f64, stats: &Stats) {
        self.caller.progress(t, h, stats);
    }
    fn collect(&mut self, system: &System, trajectory: &mut Trajectory) {
        self.caller.collect(system, trajectory);
    }
    fn simulated(&mut self, run: &Run) {
        self.caller.simulated(run);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::watch::Unwatched;

    #[test]
    fn a_limit_is_reached_by_work_and_not_by_waiting() {
        let limit = WorkLimit::begin(0.05);
        std::thread::sleep(Duration::from_millis(80));
        // where the system does not tell processor time, waiting counts
        let told = clock::thread_time().is_some();
        assert_eq!(limit.left() > 0.0, told);
        let mut caller = Unwatched;
        let mut limited = Limited::new(&mut caller, limit);
        let clock = Moment::now();
        while !limited.interrupted() {
            assert!(clock.elapsed().as_secs_f64() < 60.0, "a limit ends work");
        }
        assert!(limit.left() <= 0.0);
    }

    #[test]
    fn work_of_a_millisecond_is_told() {
        let told = clock::thread_time().is_some();
        for _ in 0..20 {
            // a clock of the process would see the threads of other tests end
            let clock = ProcessorClock::start();
            let moment = Moment::now();
            while moment.elapsed() < Duration::from_millis(1) {}
            assert!(!told || clock.seconds() > 0.0);
        }
    }

    #[test]
    fn a_limit_of_any_size_can_be_kept() {
        for seconds in [0.0, 1e-300, 1e300, f64::INFINITY] {
            let mut caller = Unwatched;
            let mut limited = Limited::new(&mut caller, WorkLimit::begin(seconds));
            assert_eq!(limited.interrupted(), seconds < 1.0);
        }
    }
}
