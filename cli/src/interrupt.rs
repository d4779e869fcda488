//! Ctrl-C and other requests to end (SIGTERM, SIGHUP): the first asks the running analysis to stop
//! and keep what it has, the second ends the program at once.
//!
//! Where nothing polls (while a large model is put together), a run that has no results yet ends by
//! itself a moment later; one that has them is ended by its guard (`limit.rs`), which keeps them.

use cognate::analysis::watch::Watch;
use signal_hook::consts::signal::SIGINT;
#[cfg(unix)]
use signal_hook::consts::signal::{SIGHUP, SIGTERM};
use signal_hook::flag;
use std::collections::BTreeSet;
#[cfg(unix)]
use std::io::Read;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// the flag that loops poll; Ctrl-C sets it once [`install`] has been called
static STOP: AtomicBool = AtomicBool::new(false);
/// somebody has seen that the user asked to stop
static SEEN: AtomicBool = AtomicBool::new(false);
/// there are results, which must be written
static HAS_RESULTS: AtomicBool = AtomicBool::new(false);

/// Time that a run without results may go on without seeing the request to stop.
pub const PATIENCE: Duration = Duration::from_millis(700);
/// Time between two looks at the flag.
const LOOK: Duration = Duration::from_millis(50);

/// Returns true if the user asked to stop.
pub fn requested() -> bool {
    let stop = STOP.load(Ordering::Relaxed);
    if stop {
        SEEN.store(true, Ordering::Relaxed);
    }
    stop
}

/// Hears Ctrl-C for an analysis.
pub struct Listener;

impl Watch for Listener {
    fn interrupted(&mut self) -> bool {
        requested()
    }
}

/// Returns whether the user has asked to stop and nothing has seen it.
pub fn is_unseen() -> bool {
    STOP.load(Ordering::Relaxed) && !SEEN.load(Ordering::Relaxed)
}

/// Forgets that the user asked to stop: what was going on has ended, and the program goes on.
pub fn forget() {
    STOP.store(false, Ordering::Relaxed);
    SEEN.store(false, Ordering::Relaxed);
}

/// Notes that there are results from now on, which are kept when the user interrupts.
pub fn results_begin() {
    HAS_RESULTS.store(true, Ordering::Relaxed);
}

/// Lets Ctrl-C set the flag from now on; where that is not possible it ends the program, as before.
pub fn install() {
    hear(SIGINT);
}

/// Lets Ctrl-C and other requests to end (SIGTERM, SIGHUP) set the flag from now on, and ends a run
/// that has no results and does not see it.
///
/// One of the others that whoever started this program wants it to ignore (`nohup`) stays ignored.
pub fn install_for_run() {
    hear(SIGINT);
    #[cfg(unix)]
    {
        let ignored = ignored_signals();
        let is_heard = |signal: &i32| ignored & (1 << (signal - 1)) == 0;
        ([SIGTERM, SIGHUP].into_iter().filter(is_heard)).for_each(hear);
    }
    // where no thread can be had, a run ends where it looks
    let _ = std::thread::Builder::new().spawn(end_unless_seen);
}

/// Lets a signal set the flag; the second one ends the program at once.
fn hear(signal: i32) {
    /// signals that are heard: heard twice, the first would be the second
    static HEARD: Mutex<BTreeSet<i32>> = Mutex::new(BTreeSet::new());
    let mut heard = HEARD.lock().unwrap_or_else(PoisonError::into_inner);
    if heard.insert(signal) {
        let ends = flag::register_conditional_shutdown(signal, 130, &STOP);
        // where that is not possible it ends the program, as before
        let _ = ends.and_then(|_| flag::register(signal, &STOP));
    }
}

/// Returns the signals that this process ignores, a bit each from the lowest; none where the system
/// does not tell.
#[cfg(unix)]
fn ignored_signals() -> u64 {
    let mut bytes = [0; 4096];
    // one question of the system instead of five
    let status = std::fs::File::open("/proc/self/status");
    let n = status
        .and_then(|mut file| file.read(&mut bytes))
        .unwrap_or(0);
    let status = String::from_utf8_lossy(&bytes[..n]);
    let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    line.and_then(|bits| u64::from_str_radix(bits.trim(), 16).ok())
        .unwrap_or(0)
}

/// Waits for a request to stop; ends a run that does not see it.
fn end_unless_seen() {
    while !STOP.load(Ordering::Relaxed) {
        std::thread::sleep(LOOK);
    }
    std::thread::sleep(PATIENCE);
    if SEEN.load(Ordering::Relaxed) {
        return;
    }
    if HAS_RESULTS.load(Ordering::Relaxed) {
        super::remark("interrupted: ends with the next step; Ctrl-C again ends at once");
    } else {
        super::remark("interrupted before there were results: nothing was written");
        super::piped::end();
        std::process::exit(130);
    }
}
