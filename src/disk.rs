//! The disk: the one door to files and folders. Nothing of a result depends on it but what a caller
//! asks to be read or written.
//!
//! Where a target has no files (WebAssembly without a host) each of these is an error, which
//! becomes the message that a file cannot be opened or written: models, commands and results in
//! memory need none of it.

#[cfg(feature = "setup")]
pub(crate) use std::fs::read_to_string;
pub(crate) use std::fs::{
    File, Metadata, OpenOptions, create_dir_all, metadata, read, read_dir, remove_dir_all,
    remove_file, rename,
};
#[cfg(feature = "parquet")]
pub(crate) use std::fs::{create_dir, remove_dir, write};
use std::path::Path;

/// Holds a file until the result is dropped, or this process ends in whatever way: others see by
/// [`is_held`] that somebody is at work. `None` where that is not possible.
pub(crate) fn hold(path: &Path) -> Option<File> {
    let file = File::open(path).ok()?;
    file.lock_shared().ok()?;
    Some(file)
}

/// Returns whether a process holds a file; where nobody can tell, as on some file systems, it may.
pub(crate) fn is_held(path: &Path) -> bool {
    let tried = File::open(path).map(|file| file.try_lock());
    tried.is_ok_and(|locked| locked.is_err())
}

/// Returns whether there is a file or a folder at a path.
pub(crate) fn is_there(path: &Path) -> bool {
    path.exists()
}

/// Returns whether there is a folder at a path.
pub(crate) fn is_folder(path: &Path) -> bool {
    path.is_dir()
}
