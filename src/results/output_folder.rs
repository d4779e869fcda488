//! Where the files of a run go: results of an earlier run make way, files of anybody else are kept.
//!
//! A run record lists the files of its run and their sizes. A file that stands in the way and is
//! not on that list was made by somebody else, or changed since: it is renamed, never overwritten.
//! Files are complete beside their places before any is put there, and the list is written before
//! that: a run that is killed in between leaves no file that the next one would take for somebody
//! else's.

use super::format::Finished;
use super::part_file::{PartFile, beside, unwritable};
use crate::diagnostic::Diagnostic;
use crate::disk;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files that are being written to a folder.
#[derive(Debug)]
pub struct OutputFolder {
    dir: PathBuf,
    /// name of the record in the folder
    record: String,
    /// files of the earlier run, as its record lists them: name and the sizes it may have, in bytes
    earlier: BTreeMap<String, Vec<u64>>,
    /// what has been written, with bytes
    written: BTreeMap<String, u64>,
    /// the same in the order of writing
    files: Vec<PathBuf>,
    /// files of others: where they were, and where they are now
    kept: Vec<(PathBuf, PathBuf)>,
    /// the record, while it says that the run is being written
    held: Option<disk::File>,
}

/// The status in the record of a run that is being written, or that was ended from outside.
pub(super) const BEING_WRITTEN: &str = "being written";

impl OutputFolder {
    /// Opens the folder `dir` for the run called `base`, and tries whether a file can be made
    /// there. A folder that does not exist is made with the first file.
    ///
    /// # Errors
    /// `file_unwritable` when no file can be made there.
    pub fn open(dir: &Path, base: &str) -> Result<Self, Diagnostic> {
        let place = if dir.as_os_str().is_empty() {
            Path::new(".")
        } else {
            dir
        };
        try_to_write(place).map_err(|e| unwritable(place, &e))?;
        let record = format!("{base}.json");
        Ok(Self {
            earlier: listed(&dir.join(&record), &record),
            dir: dir.to_owned(),
            record,
            written: BTreeMap::new(),
            files: Vec::new(),
            kept: Vec::new(),
            held: None,
        })
    }

    /// Returns the place of a file, under a name that may contain folders of its own.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(name)
    }

    /// Returns the place of a file, whose folders are made.
    ///
    /// # Errors
    /// When a folder cannot be made.
    pub fn place(&self, name: &str) -> Result<PathBuf, Diagnostic> {
        let path = self.path(name);
        match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() && !disk::is_folder(folder) => {
                disk::create_dir_all(folder).map_err(|e| unwritable(&path, &e))?;
            }
            _ => {}
        }
        Ok(path)
    }

    /// Writes a text beside its place.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn prepare(&self, name: &str, text: &str) -> Result<Finished, Diagnostic> {
        let mut file = PartFile::new(&self.place(name)?);
        file.append(text.as_bytes())?;
        file.finish()
    }

    /// Puts complete files in their places, after a list that claims them.
    ///
    /// # Errors
    /// When one cannot be put there, or what is there cannot be moved.
    pub fn put(&mut self, files: &[(String, Finished)]) -> Result<(), Diagnostic> {
        self.claim(files)?;
        for (name, file) in files {
            self.put_in_place(name, file)?;
            self.written.insert(name.clone(), file.bytes);
            self.files.push(self.dir.join(name));
        }
        Ok(())
    }

    /// Puts the record in its place.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn put_record(&mut self, text: &str) -> Result<(), Diagnostic> {
        let record = self.record.clone();
        self.held = None;
        let file = self.prepare(&record, text)?;
        self.put_in_place(&record, &file)?;
        self.files.push(self.dir.join(&record));
        // from now on it is ours
        self.earlier.insert(record, vec![file.bytes]);
        Ok(())
    }

    /// Removes those of these files that an earlier run has written and this one has not.
    ///
    /// # Errors
    /// When one cannot be removed.
    pub fn remove_stale(&mut self, names: &[String]) -> Result<(), Diagnostic> {
        for name in names.iter().filter(|n| !self.written.contains_key(*n)) {
            let path = self.dir.join(name);
            if self.is_earlier(name, &path) {
                disk::remove_file(&path).map_err(|e| unwritable(&path, &e))?;
            }
        }
        Ok(())
    }

    /// Returns the names of the files of the earlier run.
    pub fn earlier(&self) -> impl Iterator<Item = &String> {
        self.earlier.keys()
    }

    /// Claims what an earlier run has written that still stands there, as saved states do: a run
    /// after this one may replace it.
    pub fn keep_claims(&mut self) {
        let names = self.earlier.keys().filter(|name| **name != self.record);
        let standing = names.filter_map(|name| {
            let path = self.dir.join(name);
            let stands = self.is_earlier(name, &path);
            let about = path.symlink_metadata().ok().filter(|_| stands)?;
            Some((name.clone(), about.len()))
        });
        for (name, size) in standing.collect::<Vec<_>>() {
            self.written.entry(name).or_insert(size);
        }
    }

    /// Returns names and sizes of the files that were written, for the record.
    pub fn written(&self) -> &BTreeMap<String, u64> {
        &self.written
    }

    /// Returns the files that were written, in that order.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Returns the part of a file that another run has left, which was ended from outside.
    pub fn left_part(&self, name: &str) -> Option<PathBuf> {
        let part = beside(&self.dir.join(name), 1);
        part.symlink_metadata().is_ok().then_some(part)
    }

    /// Returns the files of others that were in the way: where they were, and where they are now.
    pub fn kept(&self) -> &[(PathBuf, PathBuf)] {
        &self.kept
    }

    /// Renames a complete file to its place. What an earlier run has put there goes first: a file
    /// system that replaces a file by another waits for the disk.
    fn put_in_place(&mut self, name: &str, file: &Finished) -> Result<(), Diagnostic> {
        let path = self.dir.join(name);
        if path.symlink_metadata().is_ok() {
            if self.is_earlier(name, &path) || self.written.contains_key(name) {
                disk::remove_file(&path).map_err(|e| unwritable(&path, &e))?;
            } else {
                let aside = free_name(&path);
                disk::rename(&path, &aside).map_err(|e| unwritable(&path, &e))?;
                self.kept.push((path.clone(), aside));
            }
        }
        disk::rename(&file.part, &path).map_err(|e| unwritable(&path, &e))
    }

    /// Returns true if a file is one of the earlier run, as it was written.
    fn is_earlier(&self, name: &str, path: &Path) -> bool {
        let sizes = self.earlier.get(name);
        let there = path.symlink_metadata();
        there.is_ok_and(|there| sizes.is_some_and(|sizes| sizes.contains(&there.len())))
    }

    /// Writes a record that claims files before they are put in their places, beside those of the
    /// earlier run.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn claim(&mut self, more: &[(String, Finished)]) -> Result<(), Diagnostic> {
        let mut files = self.written.clone();
        files.extend(more.iter().map(|(name, file)| (name.clone(), file.bytes)));
        let text = json!({
            "status": BEING_WRITTEN,
            "versions": {"cognate": env!("CARGO_PKG_VERSION")},
            "files": files,
            "replaced": self.earlier,
        });
        let shown = self.files.len();
        self.put_record(&format!("{text:#}\n"))?;
        self.held = disk::hold(&self.dir.join(&self.record));
        // the record of the run is still to come
        self.files.truncate(shown);
        Ok(())
    }
}

/// Returns the files that a record lists, with the sizes that they may have; none if it is no
/// record of this program.
pub(super) fn listed(path: &Path, name: &str) -> BTreeMap<String, Vec<u64>> {
    let mut earlier: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    let value = disk::read(path).ok();
    let value = value.and_then(|text| serde_json::from_slice::<Value>(&text).ok());
    let Some(value) = value.filter(|v| v["versions"]["cognate"].is_string()) else {
        return earlier;
    };
    for list in [&value["files"], &value["replaced"]] {
        for (name, sizes) in list.as_object().into_iter().flatten() {
            let several = sizes.as_array().into_iter().flatten();
            let sizes = several.chain([sizes]).filter_map(Value::as_u64);
            earlier.entry(name.clone()).or_default().extend(sizes);
        }
    }
    // a record cannot contain its own size
    if let Ok(about) = disk::metadata(path) {
        earlier.insert(name.to_owned(), vec![about.len()]);
    }
    earlier
}

/// Makes a file in a folder, or in the first folder above it that exists, and removes it again.
fn try_to_write(dir: &Path) -> std::io::Result<()> {
    let mut folder = dir;
    while folder.symlink_metadata().is_err() {
        match folder.parent() {
            Some(above) if above.as_os_str().is_empty() => folder = Path::new("."),
            Some(above) => folder = above,
            None => break,
        }
    }
    let probe = free_name(&folder.join(format!(".cognate-{}", std::process::id())));
    disk::File::create_new(&probe)?;
    disk::remove_file(&probe)
}

/// Returns `path~`, or the first of `path~2`, `path~3` … that is free.
fn free_name(path: &Path) -> PathBuf {
    let named = |k: u32| {
        let mut name = path.as_os_str().to_owned();
        name.push(if k == 1 { "~".into() } else { format!("~{k}") });
        PathBuf::from(name)
    };
    (1..)
        .map(named)
        .find(|p| p.symlink_metadata().is_err())
        .unwrap_or_else(|| named(0))
}
