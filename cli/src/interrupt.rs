//! Ctrl-C and other requests to end (SIGTERM, SIGHUP): the first asks the running analysis to stop
//! and keep what it has, the second ends the program at once.
//!
//! Where nothing polls (while a large model is put together), a run that has no results yet ends by
//! itself a moment later; one that has them is ended by its guard (`limit.rs`), which keeps them.

use cognate::analysis::watch::Watch;
#[cfg(unix)]
use std::io::Read;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// the flag that loops poll; Ctrl-C sets it once [`install`] has been called
static STOP: AtomicBool = AtomicBool::new(false);
/// somebody has seen that the user asked to stop
static SEEN: AtomicBool = AtomicBool::new(false);
/// there are results, which must be written
static HAS_RESULTS: AtomicBool = AtomicBool::new(false);

/// Time that a run without results may go on without seeing the request to stop.
pub const PATIENCE: Duration = Duration::from_millis(700);

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
    // a second installation, or a system without signals, keeps the usual behaviour
    let _ = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
}

/// Lets Ctrl-C and other requests to end set the flag from now on, as [`install`], and ends a run
/// that has no results and does not see it.
pub fn install_for_run() {
    #[cfg(unix)]
    listen_for_ends();
    #[cfg(not(unix))]
    let _ = ctrlc::set_handler(ask_to_stop);
}

fn ask_to_stop() {
    if STOP.swap(true, Ordering::Relaxed) {
        std::process::exit(130);
    }
    // where no thread can be had, only what looks by itself ends
    let _ = std::thread::Builder::new().spawn(end_unless_seen);
}

/// Listens for Ctrl-C, and for SIGTERM and SIGHUP, but for one of these that whoever started this
/// program wants it to ignore (`nohup`).
#[cfg(unix)]
fn listen_for_ends() {
    use signal_hook::consts::signal::{SIGHUP, SIGINT, SIGTERM};
    let ignored = ignored_signals();
    let heard = [SIGINT, SIGTERM, SIGHUP].into_iter();
    let heard = heard.filter(move |&signal| signal == SIGINT || ignored & (1 << (signal - 1)) == 0);
    // where that is not possible, or no thread can be had, they end the program, as before
    let (ready, is_ready) = std::sync::mpsc::channel();
    let listen = move || {
        let signals = signal_hook::iterator::Signals::new(heard);
        // whoever waits is there until this comes
        let _ = ready.send(());
        if let Ok(mut signals) = signals {
            signals.forever().for_each(|_| ask_to_stop());
        }
    };
    if std::thread::Builder::new().spawn(listen).is_ok() {
        let _ = is_ready.recv();
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

fn end_unless_seen() {
    std::thread::sleep(PATIENCE);
    if SEEN.load(Ordering::Relaxed) {
        return;
    }
    if HAS_RESULTS.load(Ordering::Relaxed) {
        super::remark("interrupted: ends with the next step; Ctrl-C again ends at once");
    } else {
        super::remark("interrupted before there were results: nothing was written");
        std::process::exit(130);
    }
}
