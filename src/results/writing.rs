//! Files that commands write: what this program has not written stays as it is, what it has
//! written is kept once as `NAME~`, and an input of the same command is never replaced.
//!
//! The program knows its own files by what it noted of them: runs by their records, all others by
//! `.cognate.json` beside them, with size and digest. A file that was changed since is somebody's.

use super::digest::digest_of;
use super::format::{Finished, Style};
use super::part_file::{PartFile, beside, unwritable};
use super::{Run, file, kept};
use crate::diagnostic::{Cause, Diagnostic};
use crate::disk;
use serde_json::{Map, Value, json};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Name of the file with sizes and digests of what was written in its folder.
const NOTES: &str = ".cognate.json";

/// A command's leave to write.
#[derive(Clone, Copy, Debug, Default)]
pub struct Writing {
    overwrite: bool,
}

/// The thing that stands in the place of a file that is to be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Standing {
    /// nothing, or a file without a byte
    Nothing,
    /// a file as this program has written it
    Ours,
    /// a file of somebody else
    Others,
    /// a terminal, a pipe, a device: written to as it stands
    Stream,
}

impl Writing {
    /// Makes the leave of a command. `overwrite`: files of others may be replaced, too; they are
    /// kept as `NAME~`.
    pub fn new(overwrite: bool) -> Self {
        Self { overwrite }
    }

    /// Returns whether files of others may be replaced.
    pub fn overwrites(self) -> bool {
        self.overwrite
    }

    /// Refuses a place where nothing may be written, before the work begins.
    ///
    /// # Errors
    /// `file_exists` for a file of somebody else, `is_input` for an input of this command,
    /// `file_unwritable` for a folder.
    pub fn check(self, place: &Path) -> Result<(), Diagnostic> {
        self.standing(place, || is_ours(place)).map(drop)
    }

    /// Returns the thing in a place, if it may be replaced.
    pub(super) fn standing(
        self,
        place: &Path,
        is_ours: impl FnOnce() -> bool,
    ) -> Result<Standing, Diagnostic> {
        let standing = standing(place, is_ours)?;
        if standing != Standing::Others || self.overwrite {
            return Ok(standing);
        }
        let what = "is there already, and was not written by this program or has been changed";
        let mut d = Diagnostic::error(Cause::FileExists, what);
        d.file = Some(disk::text(&place));
        Err(d.help("name another file, or --overwrite replaces it and keeps it with a ~ behind"))
    }

    /// Writes bytes to a file, all or nothing; returns the place where a file of somebody else is
    /// kept.
    ///
    /// # Errors
    /// As [`Writing::check`], and when the file cannot be written.
    pub fn bytes(self, place: &Path, bytes: &[u8]) -> Result<Option<PathBuf>, Diagnostic> {
        if self.standing(place, || is_ours(place))? == Standing::Stream {
            let stream = disk::OpenOptions::new().write(true).open(place);
            let written = stream.and_then(|mut stream| stream.write_all(bytes));
            return written.map(|()| None).map_err(|e| unwritable(place, &e));
        }
        let mut part = PartFile::new(place);
        let finished = part.append(bytes).and_then(|()| part.finish());
        self.put(place, finished)
    }

    /// Writes a text to a file, as [`Writing::bytes`].
    ///
    /// # Errors
    /// The same.
    pub fn text(self, place: &Path, text: &str) -> Result<Option<PathBuf>, Diagnostic> {
        self.bytes(place, text.as_bytes())
    }

    /// Writes a run to a file whose name tells the format, as [`Writing::bytes`].
    ///
    /// # Errors
    /// The same; and a format that is not known.
    pub fn run(self, run: &Run, place: &Path, style: Style) -> Result<Option<PathBuf>, Diagnostic> {
        self.check(place)?;
        self.put(place, file::write_beside(run, place, style))
    }

    /// Writes a text over a file that other signs tell to be of this program, and keeps that.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn replace_own(self, place: &Path, text: &str) -> Result<PathBuf, Diagnostic> {
        let kept = keep(place, is_ours)?;
        note(&kept);
        self.text(place, text)?;
        Ok(kept)
    }

    /// Puts a complete file in its place, and notes that it is ours.
    fn put(
        self,
        place: &Path,
        finished: Result<Finished, Diagnostic>,
    ) -> Result<Option<PathBuf>, Diagnostic> {
        let part = finished?.part;
        let put = self.put_part(place, &part);
        if put.is_err() {
            // a rest that cannot be removed either adds nothing to say
            let _ = disk::remove_file(&part);
        }
        put
    }

    fn put_part(self, place: &Path, part: &Path) -> Result<Option<PathBuf>, Diagnostic> {
        let mut aside = None;
        match self.standing(place, || is_ours(place))? {
            Standing::Nothing => {}
            Standing::Stream => {
                let what = std::io::Error::other("it is no file, and takes no results");
                return Err(unwritable(place, &what));
            }
            Standing::Ours => {
                let kept = keep(place, is_ours)?;
                note(&kept);
            }
            Standing::Others => aside = Some(put_aside(place)?),
        }
        disk::put_new(part, place).map_err(|e| unwritable(place, &e))?;
        note(place);
        Ok(aside)
    }
}

/// Returns the thing that stands in a place.
fn standing(place: &Path, is_ours: impl FnOnce() -> bool) -> Result<Standing, Diagnostic> {
    let Ok(about) = place.symlink_metadata() else {
        return Ok(Standing::Nothing);
    };
    if disk::is_input(place) {
        let what = "is an input of this command, which is never overwritten";
        let mut d = Diagnostic::error(Cause::IsInput, what);
        d.file = Some(disk::text(&place));
        return Err(d.help("name another file"));
    }
    if disk::is_folder(place) {
        let what = std::io::Error::other("it is a folder");
        return Err(unwritable(place, &what));
    }
    let is_of_the_system = place.starts_with("/dev") || place.starts_with("/proc");
    Ok(match (about.is_symlink(), about.is_file()) {
        (true, _) if is_of_the_system => Standing::Stream,
        (true, _) => Standing::Others,
        (false, false) => Standing::Stream,
        // a name that somebody has taken for this command, as mktemp does
        (false, true) if about.len() == 0 => Standing::Nothing,
        (false, true) if is_ours() => Standing::Ours,
        (false, true) => Standing::Others,
    })
}

/// Renames a file to the first of `NAME~`, `NAME~2` … that is free or ours, which makes way;
/// returns the new place.
pub(super) fn keep(place: &Path, is_ours: impl Fn(&Path) -> bool) -> Result<PathBuf, Diagnostic> {
    let is_earlier = |aside: &Path| {
        let is_file = aside.symlink_metadata().is_ok_and(|about| about.is_file());
        is_file && !disk::is_input(aside) && is_ours(aside)
    };
    let may_be = |aside: &PathBuf| aside.symlink_metadata().is_err() || is_earlier(aside);
    let mut names = (1..).map(|k| with_tilde(place, k));
    let aside = names.find(may_be).unwrap_or_else(|| beside(place, 0));
    if aside.symlink_metadata().is_ok() {
        disk::remove_file(&aside).map_err(|e| unwritable(&aside, &e))?;
    }
    disk::rename(place, &aside).map_err(|e| unwritable(place, &e))?;
    Ok(aside)
}

/// Returns whether a name is one of [`keep`].
pub(super) fn is_kept(name: &str) -> bool {
    let behind = name.rsplit_once('~').map(|(_, number)| number);
    behind.is_some_and(|number| number.bytes().all(|b| b.is_ascii_digit()))
}

/// Returns `path~`, or the first of `path~2`, `path~3` … that is free.
pub(super) fn free_name(path: &Path) -> PathBuf {
    let is_free = |p: &PathBuf| p.symlink_metadata().is_err();
    let mut names = (1..).map(|k| with_tilde(path, k));
    names.find(is_free).unwrap_or_else(|| beside(path, 0))
}

/// Renames a file of somebody else to a name that nobody has.
pub(super) fn put_aside(place: &Path) -> Result<PathBuf, Diagnostic> {
    let aside = free_name(place);
    disk::rename(place, &aside).map_err(|e| unwritable(place, &e))?;
    Ok(aside)
}

fn with_tilde(path: &Path, k: u32) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(if k == 1 { "~".into() } else { format!("~{k}") });
    PathBuf::from(name)
}

/// Returns whether a file is as this program has written it.
pub(super) fn is_ours(place: &Path) -> bool {
    is_noted(place).unwrap_or(false) || kept::is_claimed(place)
}

/// Returns whether the notes of its folder have a file as it is; `None`: they have none.
fn is_noted(place: &Path) -> Option<bool> {
    let bytes = disk::read_own(&place.with_file_name(NOTES)).ok()?;
    let notes: Value = serde_json::from_slice(&bytes).ok()?;
    let noted = notes["written"].get(name(place)?)?;
    let about = place.symlink_metadata().ok()?;
    if noted["bytes"].as_u64() != Some(about.len()) {
        return Some(false);
    }
    let (_, digest) = digest_of(&mut disk::File::open(place).ok()?).ok()?;
    Some(noted["digest"].as_str() == Some(&digest))
}

fn name(place: &Path) -> Option<String> {
    Some(disk::text(place.file_name()?))
}

/// Notes a file that this program has written. Where that is not possible, it is taken for
/// somebody's later, and stays.
fn note(place: &Path) {
    let noted = || -> Option<()> {
        let (bytes, digest) = digest_of(&mut disk::File::open(place).ok()?).ok()?;
        let notes = place.with_file_name(NOTES);
        let mut options = disk::OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false);
        let mut file = options.open(&notes).ok()?;
        file.lock().ok()?;
        let mut text = Vec::new();
        file.read_to_end(&mut text).ok()?;
        let written = match text.is_empty() {
            true => Map::new(),
            // a file that is none of ours stays as it is
            false => match serde_json::from_slice::<Value>(&text)
                .ok()?
                .get_mut("written")?
            {
                Value::Object(written) => std::mem::take(written),
                _ => return None,
            },
        };
        let is_there = |name: &String| disk::is_there(&place.with_file_name(disk::path(name)));
        let mut written: Map<String, Value> = written
            .into_iter()
            .filter(|(name, _)| is_there(name))
            .collect();
        written.insert(name(place)?, json!({ "bytes": bytes, "digest": digest }));
        let about = "files that cognate has written here, by which it knows them as its own";
        let text = format!("{:#}\n", json!({ "about": about, "written": written }));
        file.seek(SeekFrom::Start(0)).ok()?;
        file.set_len(0).ok()?;
        file.write_all(text.as_bytes()).ok()
    };
    noted();
}
