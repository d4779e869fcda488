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

impl Add<Duration> for Moment {
    type Output = Self;
    fn add(self, time: Duration) -> Self {
        Self(self.0.saturating_add(time))
    }
}
