//! Ctrl-C: the first asks the running analysis to stop and keep what it has, the second ends the
//! program at once.

use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);

/// Returns the flag that loops poll; Ctrl-C sets it once [`install`] has been called.
pub fn flag() -> &'static AtomicBool {
    &STOP
}

/// Returns whether the user asked to stop.
pub fn requested() -> bool {
    STOP.load(Ordering::Relaxed)
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
