//! The disk: the one door to files and folders. Nothing of a result depends on it but what a caller
//! asks to be read or written.
//!
//! Where a target has no files (WebAssembly without a host) each of these is an error, which
//! becomes the message that a file cannot be opened or written: models, commands and results in
//! memory need none of it.

pub(crate) use std::fs::{
    File, Metadata, OpenOptions, create_dir_all, metadata, read, read_dir, read_to_string,
    remove_file, rename,
};
#[cfg(feature = "parquet")]
pub(crate) use std::fs::{create_dir, remove_dir, write};
use std::path::Path;

/// Returns whether there is a file or a folder at a path.
pub(crate) fn is_there(path: &Path) -> bool {
    path.exists()
}

/// Returns whether there is a folder at a path.
pub(crate) fn is_folder(path: &Path) -> bool {
    path.is_dir()
}
