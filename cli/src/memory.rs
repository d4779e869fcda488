//! The heap of the process: what serves a program in which one thread works.

pub use heap::serve_one_thread;

/// The heap of glibc, for a program in which one thread does the work.
#[cfg(all(feature = "native", target_os = "linux", target_env = "gnu"))]
mod heap {
    /// The parameter of `mallopt` that bounds the number of arenas.
    const M_ARENA_MAX: i32 = -8;

    // SAFETY: the signature is that of malloc.h; any values may be given.
    unsafe extern "C" {
        safe fn mallopt(parameter: i32, value: i32) -> i32;
    }

    /// Lets the thread that works use the arena of the process, which grows by many pages at a
    /// time: one of its own would grow page by page.
    pub fn serve_one_thread() {
        // where it is refused all is as it was
        let _ = mallopt(M_ARENA_MAX, 1);
    }
}

/// Another heap, as it is.
#[cfg(not(all(feature = "native", target_os = "linux", target_env = "gnu")))]
mod heap {
    pub fn serve_one_thread() {}
}
