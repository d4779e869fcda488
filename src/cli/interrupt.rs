//! Ctrl-C: the first asks the running analysis to stop and keep what it has, the second ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

static STOP: AtomicBool = AtomicBool::new(false);

/// The flag that loops poll; set by Ctrl-C once [`install`] has been called.
pub fn flag() -> &'static AtomicBool {
    &STOP
}

/// Whether the user asked to stop.
pub fn requested() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// From now on Ctrl-C sets the flag; where that is not possible it ends the program, as before.
pub fn install() {
    // A second installation, or a system without signals, leaves the usual behaviour.
    let _ = ctrlc::set_handler(|| {
        if STOP.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
}
