//! The stack of threads that work on models: deep models need much, and what is not used is not
//! taken; but where the system limits the addresses of a process, what is reserved counts.

use crate::disk;
use std::path::Path;

/// Bytes that are reserved where nothing limits them.
const USUAL: u64 = 256 << 20;
/// Bytes that a thread has anyway, and parts of the limit beyond which nothing is reserved.
const LEAST: u64 = 8 << 20;
const PARTS: u64 = 8;

/// Returns the bytes to reserve for the stack of each of so many threads.
pub fn bytes(threads: usize) -> usize {
    let mut text = [0; 4096];
    let n = disk::read_beginning(Path::new("/proc/self/limits"), &mut text).unwrap_or(0);
    let bytes = within(&String::from_utf8_lossy(&text[..n]), threads as u64);
    usize::try_from(bytes).unwrap_or(usize::MAX)
}

/// Returns the same where these limits hold, as the system lists them.
fn within(limits: &str, threads: u64) -> u64 {
    let of = |name: &str| {
        let mut lines = limits.lines();
        let line = lines.find_map(|line| line.strip_prefix(name))?;
        line.split_whitespace().next()?.parse::<u64>().ok()
    };
    let limits = ["Max address space", "Max data size"].into_iter();
    let limit = limits.filter_map(of).min().unwrap_or(u64::MAX);
    (limit / PARTS / threads.max(1)).clamp(LEAST, USUAL)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_of_addresses_leaves_room_for_the_work() {
        let limits = |data: &str, addresses: &str| {
            let text = format!(
                "Max data size   {data}   unlimited  bytes\nMax address space  {addresses}  9  bytes\n"
            );
            within(&text, 1)
        };
        assert_eq!(limits("unlimited", "unlimited"), USUAL);
        assert_eq!(limits("unlimited", "307200000"), 38_400_000);
        assert_eq!(limits("16000000", "307200000"), LEAST);
        assert_eq!((within("", 1), within("", 64)), (USUAL, USUAL));
    }
}
