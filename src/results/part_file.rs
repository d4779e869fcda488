//! Files that are written beside their place, under names that nobody has, and renamed when they
//! are complete: no reader meets half a file, and a run that is ended from outside leaves its rows
//! in the part.

use super::Run;
use super::format::{Finished, Sink, TableText};
use crate::diagnostic::{Cause, Diagnostic};
use crate::disk;
use crate::disk::File;
use std::io::{ErrorKind, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Bytes of text that are collected before they go to the file: memory that stays in the caches.
const BUFFER: usize = 1 << 16;

/// A file beside its place.
#[derive(Debug)]
pub struct PartFile {
    /// where it is to be in the end
    place: PathBuf,
    /// where it is, once it has been made
    part: Option<(PathBuf, File)>,
    bytes: u64,
}

impl PartFile {
    /// Prepares the part of a file; it is made with the first bytes.
    pub fn new(place: &Path) -> Self {
        Self {
            place: place.to_owned(),
            part: None,
            bytes: 0,
        }
    }

    /// Appends bytes.
    ///
    /// # Errors
    /// `file_unwritable`.
    pub fn append(&mut self, bytes: &[u8]) -> Result<(), Diagnostic> {
        let Err(e) = self.try_to_append(bytes) else {
            return Ok(());
        };
        let d = unwritable(&self.place, &e);
        Err(match &self.part {
            Some((part, _)) if self.bytes > 0 => d.help(format!(
                "what has been written until then stands in {}",
                disk::text(&part)
            )),
            _ => d,
        })
    }

    fn try_to_append(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        if self.part.is_none() {
            self.part = Some(create_beside(&self.place)?);
        }
        let Some((_, file)) = &mut self.part else {
            return Ok(());
        };
        // piece by piece, so that those are counted that a full disk has taken
        let mut rest = bytes;
        while !rest.is_empty() {
            match file.write(rest) {
                Ok(0) => return Err(ErrorKind::WriteZero.into()),
                Ok(n) => {
                    self.bytes += n as u64;
                    rest = &rest[n..];
                }
                Err(e) if e.kind() == ErrorKind::Interrupted => {}
                Err(e) => return Err(e),
            }
        }
        Ok(())
    }

    /// Closes the file.
    ///
    /// # Errors
    /// `file_unwritable`.
    pub fn finish(&mut self) -> Result<Finished, Diagnostic> {
        self.append(&[])?;
        let (part, _) = self.part.take().unzip();
        Ok(Finished {
            part: part.unwrap_or_else(|| self.place.clone()),
            bytes: self.bytes,
        })
    }
}

impl Drop for PartFile {
    /// Removes a part that holds nothing.
    fn drop(&mut self) {
        if let (Some((part, _)), 0) = (&self.part, self.bytes) {
            // an empty file that cannot be removed either does no harm
            let _ = disk::remove_file(part);
        }
    }
}

/// Creates a file beside `path`, called `path.part1`, or by the next number that nobody has.
///
/// # Errors
/// When no file can be made there.
pub fn create_beside(path: &Path) -> std::io::Result<(PathBuf, File)> {
    let mut number = 1;
    loop {
        let part = beside(path, number);
        match File::create_new(&part) {
            Ok(file) => {
                // others see by it that somebody writes; where there are no locks, nobody does
                let _ = file.lock_shared();
                return Ok((part, file));
            }
            // a file of that name is somebody's
            Err(e) if e.kind() == ErrorKind::AlreadyExists => number += 1,
            Err(e) => return Err(e),
        }
    }
}

/// Returns `path.part1` or another number.
pub fn beside(path: &Path, number: u32) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".part{number}"));
    PathBuf::from(name)
}

/// Makes an error of a file that cannot be written.
pub fn unwritable(path: &Path, e: &std::io::Error) -> Diagnostic {
    let mut d = Diagnostic::error(Cause::FileUnwritable, format!("cannot be written: {e}"));
    d.file = Some(disk::text(&path));
    d
}

/// A file of text that grows with its run.
pub struct TextSink<T> {
    table: T,
    file: PartFile,
    /// text that has not been written yet
    text: Vec<u8>,
    has_begun: bool,
}

impl<T: TableText> TextSink<T> {
    /// Prepares the file of a table.
    pub fn new(table: T, place: &Path) -> Self {
        Self {
            table,
            file: PartFile::new(place),
            text: Vec::new(),
            has_begun: false,
        }
    }

    fn begin(&mut self, run: &Run) {
        if !std::mem::replace(&mut self.has_begun, true) {
            self.table.begin(run, &mut self.text);
        }
    }

    fn write(&mut self) -> Result<(), Diagnostic> {
        self.file.append(&self.text)?;
        self.text.clear();
        Ok(())
    }
}

/// Numbers that become text between two looks at its length, as whole rows.
const NUMBERS_AT_ONCE: usize = 2048;

impl<T: TableText> Sink for TextSink<T> {
    fn rows(&mut self, run: &Run, rows: Range<usize>) -> Result<(), Diagnostic> {
        self.begin(run);
        let at_once = (NUMBERS_AT_ONCE / run.columns.len().max(1)).max(1);
        for from in rows.clone().step_by(at_once) {
            let some = from..rows.end.min(from + at_once);
            self.table.rows(run, some, &mut self.text);
            if self.text.len() > BUFFER {
                self.write()?;
            }
        }
        Ok(())
    }

    fn flush(&mut self, _run: &Run) -> Result<(), Diagnostic> {
        self.write()
    }

    fn finish(&mut self, run: &Run) -> Result<Finished, Diagnostic> {
        self.begin(run);
        self.table.end(run, &mut self.text);
        self.write()?;
        self.file.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(target_os = "linux")]
    #[test]
    fn a_disk_that_is_full_is_told_with_the_file_that_holds_what_it_has_taken() {
        let full = || disk::OpenOptions::new().write(true).open("/dev/full");
        let part = PathBuf::from("out/run.csv.part1");
        for (bytes, is_named) in [(0, false), (4096, true)] {
            let mut file = PartFile::new(Path::new("out/run.csv"));
            file.part = Some((part.clone(), full().expect("Linux has it")));
            file.bytes = bytes;
            let told = file.append(b"1,2,3").expect_err("it is full");
            assert_eq!(told.file.as_deref(), Some("out/run.csv"));
            let help = told.help.concat();
            assert_eq!(help.contains("run.csv.part1"), is_named, "{help:?}");
            // which is no file of ours to remove
            file.part = None;
        }
    }
}
