//! Memory that can be executed: written first, then closed for writing, given back when nobody needs it.

use std::ffi::{c_int, c_void};
use std::ptr::NonNull;
use std::sync::atomic::{AtomicUsize, Ordering};

const READ: c_int = 1;
const WRITE: c_int = 2;
const EXECUTE: c_int = 4;
const PRIVATE: c_int = 0x02;
const ANONYMOUS: c_int = 0x20;

unsafe extern "C" {
    fn mmap(
        address: *mut c_void,
        length: usize,
        protection: c_int,
        flags: c_int,
        file: c_int,
        offset: i64,
    ) -> *mut c_void;
    fn mprotect(address: *mut c_void, length: usize, protection: c_int) -> c_int;
    fn munmap(address: *mut c_void, length: usize) -> c_int;
}

/// A system allows some ten thousand mappings for a process; most are left to others.
const MOST: usize = 20_000;
static LIVE: AtomicUsize = AtomicUsize::new(0);

/// Pages with code.
#[derive(Debug)]
pub(super) struct Pages {
    address: NonNull<c_void>,
    length: usize,
}

// SAFETY: nobody writes to the pages any more
unsafe impl Send for Pages {}
// SAFETY: likewise
unsafe impl Sync for Pages {}

impl Pages {
    /// Pages that hold this code; `None` where the system does not give them.
    pub(super) fn new(code: &[u8]) -> Option<Self> {
        if LIVE.fetch_add(1, Ordering::Relaxed) >= MOST {
            LIVE.fetch_sub(1, Ordering::Relaxed);
            return None;
        }
        let length = code.len().max(1).next_multiple_of(4096);
        let flags = PRIVATE | ANONYMOUS;
        // SAFETY: new memory, wherever the system wants it
        let address = unsafe { mmap(std::ptr::null_mut(), length, READ | WRITE, flags, -1, 0) };
        // failure is the address −1
        let address = NonNull::new(address).filter(|a| a.as_ptr() as isize != -1);
        let Some(address) = address else {
            LIVE.fetch_sub(1, Ordering::Relaxed);
            return None;
        };
        let pages = Self { address, length };
        // SAFETY: the memory is ours, writable and long enough
        unsafe {
            std::ptr::copy_nonoverlapping(code.as_ptr(), address.as_ptr().cast(), code.len());
            (mprotect(address.as_ptr(), length, READ | EXECUTE) == 0).then_some(pages)
        }
    }

    /// Where the code begins.
    pub(super) fn start(&self) -> *const c_void {
        self.address.as_ptr()
    }
}

impl Drop for Pages {
    fn drop(&mut self) {
        // SAFETY: what `mmap` gave; nobody runs the code, since that needs the pages
        unsafe { munmap(self.address.as_ptr(), self.length) };
        LIVE.fetch_sub(1, Ordering::Relaxed);
    }
}
