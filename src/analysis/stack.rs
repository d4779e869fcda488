//! The stack of threads that work on models: deep models need much, and what is not used is not
//! taken; but where the system limits the addresses of a process, what is reserved counts.

/// Bytes that are reserved where nothing limits them.
const USUAL: u64 = 256 << 20;
/// Bytes that a thread has anyway, and parts of the limit beyond which nothing is reserved.
const LEAST: u64 = 8 << 20;
const PARTS: u64 = 8;

/// Returns the bytes to reserve for the stack of each of so many threads.
pub fn bytes(threads: usize) -> usize {
    usize::try_from(within(limit(), threads as u64)).unwrap_or(usize::MAX)
}

/// Returns the bytes that a process may address here.
#[cfg(target_os = "linux")]
fn limit() -> u64 {
    use rustix::process::{Resource, getrlimit};
    let limits = [Resource::As, Resource::Data].map(|what| getrlimit(what).current);
    limits.into_iter().flatten().min().unwrap_or(u64::MAX)
}

/// Returns the same where nobody asks.
#[cfg(not(target_os = "linux"))]
fn limit() -> u64 {
    u64::MAX
}

/// Returns the same where a process may address so many bytes.
fn within(limit: u64, threads: u64) -> u64 {
    (limit / PARTS / threads.max(1)).clamp(LEAST, USUAL)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_of_addresses_leaves_room_for_the_work() {
        assert_eq!(within(u64::MAX, 1), USUAL);
        assert_eq!(within(307_200_000, 1), 38_400_000);
        assert_eq!(within(16_000_000, 1), LEAST);
        assert_eq!(within(u64::MAX, 64), USUAL);
    }
}
