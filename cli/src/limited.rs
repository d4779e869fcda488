//! The allocator of the program: that of the system; where it has no memory left, the program ends
//! with the exit code of a limit instead of a crash.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::Write;

struct Limited;

#[global_allocator]
static ALLOCATOR: Limited = Limited;

// SAFETY: every call is handed on to the allocator of the system as it is.
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the conditions of `alloc`.
        there(unsafe { System.alloc(layout) }, layout.size())
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the conditions of `alloc_zeroed`.
        there(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }
    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller keeps the conditions of `realloc`.
        there(unsafe { System.realloc(block, layout, size) }, size)
    }
    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the conditions of `dealloc`.
        unsafe { System.dealloc(block, layout) }
    }
}

#[inline]
fn there(block: *mut u8, bytes: usize) -> *mut u8 {
    if block.is_null() {
        none_left(bytes);
    }
    block
}

/// Says that there is no memory and ends the program; needs none itself.
#[cold]
fn none_left(bytes: usize) -> ! {
    let mut err = std::io::stderr();
    // there is nobody left to tell
    let _ = writeln!(
        err,
        "error[out_of_memory]: no memory for {bytes} more bytes"
    );
    let _ = writeln!(err, "  = help: fewer output steps or columns need less");
    std::process::exit(cognate_cli::Exit::Limit.code().into())
}
