//! The disk: the one door to files and folders. Nothing of a result depends on it but what a caller
//! asks to be read or written; a caller may also give the contents of files ([`give`]).
//!
//! Where a target has no files (WebAssembly without a host) each of these is an error, which
//! becomes the message that a file cannot be opened or written: models, commands and results in
//! memory need none of it.

use std::collections::{BTreeMap, BTreeSet};
pub(crate) use std::fs::{
    File, Metadata, OpenOptions, create_dir_all, metadata, read_dir, remove_dir_all, remove_file,
    rename,
};
#[cfg(feature = "parquet")]
pub(crate) use std::fs::{create_dir, remove_dir, write};
use std::io::{Error, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Bytes of the largest file that is read as a model, its commands or its data.
const MOST_BYTES: u64 = 1 << 28;
/// The same of results, and of results that come from a pipe or a device.
const MOST_OF_RESULTS: u64 = 1 << 36;
const MOST_OF_A_STREAM: u64 = 1 << 30;

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

/// Reads a file, which is an input from now on, or the contents that were given for it.
///
/// # Errors
/// When it cannot be read, or has more bytes than a model may have.
pub fn read(path: impl AsRef<Path>) -> std::io::Result<Vec<u8>> {
    input(path.as_ref(), |_| Ok(MOST_BYTES))
}

/// Reads a file of results, which is an input from now on and may be larger than others.
pub(crate) fn read_results(path: &Path) -> std::io::Result<Vec<u8>> {
    input(path, |path| match metadata(path)?.is_file() {
        true => Ok(MOST_OF_RESULTS),
        false => Ok(MOST_OF_A_STREAM),
    })
}

/// Reads an input of so many bytes at most, or returns what was given for it.
fn input(path: &Path, most: impl Fn(&Path) -> std::io::Result<u64>) -> std::io::Result<Vec<u8>> {
    if let Some(known) = given().get(path) {
        return Ok(known.clone());
    }
    note_input(path);
    bounded(path, most(path)?)
}

/// Reads a file that this program keeps for itself, which is no input.
pub(crate) fn read_own(path: &Path) -> std::io::Result<Vec<u8>> {
    bounded(path, MOST_OF_RESULTS)
}

/// Reads a file of so many bytes at most.
fn bounded(path: &Path, most: u64) -> std::io::Result<Vec<u8>> {
    let too_large = || {
        let what = format!("it has more than {} MB", most / 1_000_000);
        Error::new(ErrorKind::FileTooLarge, what)
    };
    let file = File::open(path)?;
    let size = file.metadata()?.len();
    if size > most {
        return Err(too_large());
    }
    // what the system makes up has no size
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(usize::try_from(size).map_err(|_| too_large())?)?;
    file.take(most + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > most {
        true => Err(too_large()),
        false => Ok(bytes),
    }
}

/// The identity of a file, whatever names lead to it: device and number, or its only name.
#[cfg(unix)]
type Identity = (u64, u64);
#[cfg(not(unix))]
type Identity = std::path::PathBuf;

/// Files that were read by this process; `None`: nobody wants to know.
static INPUTS: Mutex<Option<BTreeSet<Identity>>> = Mutex::new(None);

fn with_inputs<T>(f: impl FnOnce(&mut Option<BTreeSet<Identity>>) -> T) -> T {
    f(&mut INPUTS.lock().unwrap_or_else(PoisonError::into_inner))
}

#[cfg(unix)]
fn identity(path: &Path) -> Option<Identity> {
    use std::os::unix::fs::MetadataExt;
    let about = metadata(path).ok().filter(Metadata::is_file)?;
    Some((about.dev(), about.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<Identity> {
    path.canonicalize().ok()
}

/// Remembers from now on which files this process reads: they are the inputs of a command, which
/// it never replaces.
pub fn remember_inputs() {
    with_inputs(|inputs| {
        inputs.get_or_insert_default();
    });
}

/// Notes that a file is an input.
pub fn note_input(path: &Path) {
    with_inputs(|inputs| {
        if let (Some(inputs), Some(identity)) = (inputs, identity(path)) {
            inputs.insert(identity);
        }
    });
}

/// Returns whether a name leads to a file that this process has read as an input.
pub(crate) fn is_input(path: &Path) -> bool {
    let is_one = |inputs: &BTreeSet<Identity>| identity(path).is_some_and(|i| inputs.contains(&i));
    with_inputs(|inputs| inputs.as_ref().is_some_and(is_one))
}

/// Gives a file a name that nobody has, or that of a file without a byte; where links are possible,
/// no other program can take it in between.
pub(crate) fn put_new(from: &Path, to: &Path) -> std::io::Result<()> {
    let is_empty = |about: Metadata| about.is_file() && about.len() == 0;
    if to.symlink_metadata().is_ok_and(is_empty) {
        return rename(from, to);
    }
    match std::fs::hard_link(from, to) {
        Ok(()) => remove_file(from),
        Err(e) if e.kind() == ErrorKind::AlreadyExists => Err(e),
        Err(_) if is_there(to) => Err(ErrorKind::AlreadyExists.into()),
        Err(_) => rename(from, to),
    }
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

/// Returns whether a name of a file leads out of its folder, on this system or another.
pub fn leads_outside(name: &str) -> bool {
    let mut depth = 0_i32;
    for part in name.split(['/', '\\']) {
        match part {
            ".." => depth -= 1,
            "" | "." => {}
            _ => depth += 1,
        }
        if depth < 0 {
            return true;
        }
    }
    let has_drive = name.as_bytes().get(1) == Some(&b':');
    name.starts_with(['/', '\\']) || has_drive
}

/// First of the characters that stand for bytes of names that are no UTF-8: private ones, of the
/// last plane, a character a byte.
#[cfg(unix)]
const BYTE: u32 = 0x10_FF00;

/// Returns a name of a file as a text that [`path`] turns back into it, whatever bytes it has.
pub fn text<T: AsRef<std::ffi::OsStr> + ?Sized>(name: &T) -> String {
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStrExt;
        let mut text = String::new();
        let push_bytes = |text: &mut String, bytes: &[u8]| {
            text.extend(
                bytes
                    .iter()
                    .filter_map(|&b| char::from_u32(BYTE + u32::from(b))),
            );
        };
        for chunk in name.as_ref().as_bytes().utf8_chunks() {
            for c in chunk.valid().chars() {
                match byte_of(c) {
                    // a name that has such a character itself
                    Some(_) => push_bytes(&mut text, c.encode_utf8(&mut [0; 4]).as_bytes()),
                    None => text.push(c),
                }
            }
            push_bytes(&mut text, chunk.invalid());
        }
        text
    }
    #[cfg(not(unix))]
    name.as_ref().to_string_lossy().into_owned()
}

/// Returns the name of a file that a text of [`text`] stands for.
pub fn path(text: impl AsRef<str>) -> std::path::PathBuf {
    #[cfg(unix)]
    {
        use std::os::unix::ffi::OsStringExt;
        std::ffi::OsString::from_vec(bytes(text.as_ref()).into_owned()).into()
    }
    #[cfg(not(unix))]
    text.as_ref().into()
}

/// Returns the bytes of a text for a terminal, with those of names as they are.
pub fn bytes(text: &str) -> std::borrow::Cow<'_, [u8]> {
    #[cfg(unix)]
    if text.contains(|c| byte_of(c).is_some()) {
        let mut bytes = Vec::with_capacity(text.len());
        for c in text.chars() {
            match byte_of(c) {
                Some(byte) => bytes.push(byte),
                None => bytes.extend_from_slice(c.encode_utf8(&mut [0; 4]).as_bytes()),
            }
        }
        return bytes.into();
    }
    text.as_bytes().into()
}

/// Returns the byte that a character stands for.
#[cfg(unix)]
fn byte_of(c: char) -> Option<u8> {
    let above = u32::from(c).checked_sub(BYTE)?;
    u8::try_from(above).ok()
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::ffi::OsStrExt;

    #[test]
    fn names_of_any_bytes_come_back_as_they_were() {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1);
            (state >> 33) as u8
        };
        let mut names: Vec<Vec<u8>> = vec![b"plain".into(), "é±".into(), "\u{10FFE9}".into()];
        names.extend((0..2000).map(|k| (0..k % 9).map(|_| next() | 128).collect()));
        for name in names {
            let text = text(std::ffi::OsStr::from_bytes(&name));
            assert_eq!(path(&text).as_os_str().as_bytes(), name, "{text:?}");
            assert_eq!(&*bytes(&text), name, "{text:?}");
        }
        assert_eq!(text("é±"), "é±");
    }

    #[test]
    fn names_that_lead_outside_are_known() {
        for name in [
            "../x",
            "a/../../x",
            "/x",
            "C:\\x",
            "..\\x",
            "..",
            "\\x",
            "C:x",
        ] {
            assert!(leads_outside(name), "{name}");
        }
        for name in ["x", "a/x", "a/../x", "./x", "a..b", "x.y", "a\\x"] {
            assert!(!leads_outside(name), "{name}");
        }
    }
}
