//! The disk: the one door to files and folders. Nothing of a result depends on it but what a caller
//! asks to be read or written; a caller may also give the contents of files ([`give`]).
//!
//! Where a target has no files (WebAssembly without a host) each of these is an error, which
//! becomes the message that a file cannot be opened or written: models, commands and results in
//! memory need none of it.

use std::collections::BTreeMap;
#[cfg(feature = "setup")]
pub(crate) use std::fs::read_to_string;
pub(crate) use std::fs::{
    File, Metadata, OpenOptions, create_dir_all, metadata, read_dir, remove_dir_all, remove_file,
    rename,
};
#[cfg(feature = "parquet")]
pub(crate) use std::fs::{create_dir, remove_dir, write};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Contents that were given, by their paths.
static GIVEN: Mutex<BTreeMap<PathBuf, Vec<u8>>> = Mutex::new(BTreeMap::new());

fn given() -> MutexGuard<'static, BTreeMap<PathBuf, Vec<u8>>> {
    GIVEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Gives the contents of a file: whoever reads this path from now on reads these bytes.
///
/// For what came through a pipe, and for models with their meshes and command files where there is
/// no disk.
///
/// # Examples
/// ```
/// cognate::disk::give("bar.adm", "bar\nPART/1, GROUND\nEND\n");
/// assert_eq!(cognate::Model::read("bar.adm")?.title, "bar");
/// # Ok::<(), cognate::Error>(())
/// ```
pub fn give(path: impl Into<PathBuf>, bytes: impl Into<Vec<u8>>) {
    given().insert(path.into(), bytes.into());
}

/// Reads a file, or the contents that were given for it.
///
/// # Errors
/// When it cannot be read.
pub fn read(path: impl AsRef<Path>) -> std::io::Result<Vec<u8>> {
    let path = path.as_ref();
    let known = given().get(path).cloned();
    known.map_or_else(|| std::fs::read(path), Ok)
}

/// Reads what stands at the beginning of a file, as much as fits; returns how many bytes. For files
/// that the system makes up: one question of three instead of five.
pub(crate) fn read_beginning(path: &Path, bytes: &mut [u8]) -> std::io::Result<usize> {
    File::open(path)?.read(bytes)
}

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

/// Returns whether there is a file or a folder at a path, or contents that were given for it.
pub fn is_there(path: &Path) -> bool {
    given().contains_key(path) || path.exists()
}

/// Returns whether there is a folder at a path.
pub(crate) fn is_folder(path: &Path) -> bool {
    path.is_dir()
}
