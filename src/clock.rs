//! The clock: the one place where time that passes is read. No result depends on it.
//!
//! Where a target has no clock (WebAssembly without a host), no time passes: timings are zero, and
//! limits of time are not reached.

use std::ops::Add;
use std::time::Duration;

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
mod reading {
    use super::Duration;
    use std::sync::OnceLock;
    use std::time::Instant;

    /// Returns the time since the first reading.
    pub fn now() -> Duration {
        static FIRST: OnceLock<Instant> = OnceLock::new();
        FIRST.get_or_init(Instant::now).elapsed()
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
mod reading {
    use super::Duration;

    /// Returns no time: there is no clock.
    pub fn now() -> Duration {
        Duration::ZERO
    }
}

/// The clocks of the processor, where the system has them.
#[cfg(feature = "solver")]
mod processor {
    use super::Duration;

    /// Returns the processor time that this process has used.
    pub fn process_time() -> Option<Duration> {
        reading::process_time()
    }

    /// Returns the processor time that the thread that asks has used.
    pub fn thread_time() -> Option<Duration> {
        reading::thread_time()
    }

    #[cfg(any(
        target_os = "linux",
        target_os = "android",
        target_os = "freebsd",
        target_vendor = "apple"
    ))]
    mod reading {
        use super::Duration;
        use rustix::time::{ClockId, clock_gettime};

        fn time(clock: ClockId) -> Option<Duration> {
            Duration::try_from(clock_gettime(clock)).ok()
        }

        pub fn process_time() -> Option<Duration> {
            time(ClockId::ProcessCPUTime)
        }

        pub fn thread_time() -> Option<Duration> {
            time(ClockId::ThreadCPUTime)
        }
    }

    #[cfg(not(any(
        target_os = "linux",
        target_os = "android",
        target_os = "freebsd",
        target_vendor = "apple"
    )))]
    mod reading {
        use super::Duration;

        pub fn process_time() -> Option<Duration> {
            None
        }

        pub fn thread_time() -> Option<Duration> {
            None
        }
    }
}

#[cfg(feature = "solver")]
pub(crate) use processor::{process_time, thread_time};

/// A moment on a clock that does not go back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Moment(Duration);

impl Moment {
    /// Reads the clock.
    pub fn now() -> Self {
        Self(reading::now())
    }

    /// Returns the time that has passed since.
    pub fn elapsed(self) -> Duration {
        reading::now().saturating_sub(self.0)
    }
}

/// Questions that are answered without reading the clock, while they come fast.
const UNREAD: u8 = 15;

/// A time that is waited for, and asked about so often that reading the clock each time would cost:
/// while questions come fast it is read at every sixteenth.
#[derive(Clone, Copy, Debug)]
pub struct Wait {
    begun: Moment,
    longest: Duration,
    /// when the clock was read last
    read: Moment,
    /// questions until it is read again
    left: u8,
}

impl Wait {
    /// Begins to wait.
    pub fn begin(longest: Duration) -> Self {
        let now = Moment::now();
        Self {
            begun: now,
            longest,
            read: now,
            left: 0,
        }
    }

    /// Returns whether it is over: late by a quarter of the time at most, where questions do not
    /// suddenly come more slowly.
    #[inline]
    pub fn is_over(&mut self) -> bool {
        match self.left.checked_sub(1) {
            Some(left) => {
                self.left = left;
                false
            }
            None => self.look(),
        }
    }

    fn look(&mut self) -> bool {
        let now = Moment::now();
        let between = now.0.saturating_sub(self.read.0);
        let is_fast = between < self.longest / (4 * u32::from(UNREAD + 1));
        self.left = if is_fast { UNREAD } else { 0 };
        self.read = now;
        now.0.saturating_sub(self.begun.0) >= self.longest
    }
}

impl Add<Duration> for Moment {
    type Output = Self;
    fn add(self, time: Duration) -> Self {
        Self(self.0.saturating_add(time))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(feature = "solver")]
    #[test]
    fn work_uses_processor_time_and_waiting_uses_none() {
        // begun before those that are compared with it
        let (moment, millisecond) = (Moment::now(), Duration::from_millis(1));
        let (Some(process), Some(thread)) = (process_time(), thread_time()) else {
            return;
        };
        let since = |now: Option<Duration>, begin: Duration| now.unwrap_or_default() - begin;
        while since(thread_time(), thread) < millisecond {
            assert!(moment.elapsed() < Duration::from_secs(60), "time is told");
        }
        // a thread uses no more than passes, the process at least what the thread uses
        assert!(since(thread_time(), thread) <= moment.elapsed());
        assert!(since(process_time(), process) >= millisecond);
        // clocks of threads do not tick while these sleep
        let thread = thread_time().unwrap_or_default();
        std::thread::sleep(Duration::from_millis(30));
        assert!(since(thread_time(), thread) < Duration::from_millis(15));
    }

    #[test]
    fn a_wait_ends_however_often_it_is_asked_about() {
        assert!(Wait::begin(Duration::ZERO).is_over());
        let mut long = Wait::begin(Duration::from_secs(3600));
        assert!((0..1000).all(|_| !long.is_over()));
        let (begun, longest) = (Moment::now(), Duration::from_millis(2));
        let mut short = Wait::begin(longest);
        while !short.is_over() {}
        assert!(begun.elapsed() >= longest);
    }
}
