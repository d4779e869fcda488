//! Where the files of a run go: results of an earlier run make way, files of anybody else are kept.
//!
//! A run record lists the files of its run and their sizes. A file that stands in the way and is
//! not on that list was made by somebody else, or changed since: it is renamed, never overwritten.
//! The list is written before each file, so that a run that is killed in between leaves no file
//! that the next one would take for somebody else's.

use super::write_text;
use crate::diagnostic::{Cause, Diagnostic};
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
}

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
        })
    }

    /// Writes a file into the folder, under a name that may contain folders of its own.
    ///
    /// # Errors
    /// When it cannot be written, or what is there cannot be moved.
    pub fn put(&mut self, name: &str, text: &str) -> Result<(), Diagnostic> {
        self.make_way(name)?;
        let bytes = text.len() as u64;
        if name != self.record {
            self.announce(name, bytes)?;
        }
        let path = self.dir.join(name);
        write_text(&path, text)?;
        self.written.insert(name.to_owned(), bytes);
        self.files.push(path);
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
                std::fs::remove_file(&path).map_err(|e| unwritable(&path, &e))?;
            }
        }
        Ok(())
    }

    /// Returns names and sizes of the files that were written, for the record.
    pub fn written(&self) -> &BTreeMap<String, u64> {
        &self.written
    }

    /// Returns the files that were written, in that order.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Returns the files of others that were in the way: where they were, and where they are now.
    pub fn kept(&self) -> &[(PathBuf, PathBuf)] {
        &self.kept
    }

    /// Makes the folder of a file, and moves what somebody else has put in its place.
    fn make_way(&mut self, name: &str) -> Result<(), Diagnostic> {
        let path = self.dir.join(name);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|e| unwritable(&path, &e))?;
        }
        let is_there = path.symlink_metadata().is_ok();
        if is_there && !self.is_earlier(name, &path) && !self.written.contains_key(name) {
            let aside = free_name(&path);
            std::fs::rename(&path, &aside).map_err(|e| unwritable(&path, &e))?;
            self.kept.push((path, aside));
        }
        Ok(())
    }

    /// Returns true if a file is one of the earlier run, as it was written.
    fn is_earlier(&self, name: &str, path: &Path) -> bool {
        let sizes = self.earlier.get(name);
        let there = path.symlink_metadata();
        there.is_ok_and(|there| sizes.is_some_and(|sizes| sizes.contains(&there.len())))
    }

    /// Writes a record that claims a file before it is written, beside those of the earlier run.
    fn announce(&mut self, name: &str, bytes: u64) -> Result<(), Diagnostic> {
        let record = self.record.clone();
        self.make_way(&record)?;
        let mut files = self.written.clone();
        files.insert(name.to_owned(), bytes);
        let text = json!({
            "status": "being written",
            "versions": {"cognate": env!("CARGO_PKG_VERSION")},
            "files": files,
            "replaced": self.earlier,
        });
        let text = format!("{text:#}\n");
        write_text(&self.dir.join(&record), &text)?;
        // from now on it is ours
        self.earlier.insert(record, vec![text.len() as u64]);
        Ok(())
    }
}

/// Returns the files that a record lists, with the sizes that they may have; none if it is no
/// record of this program.
fn listed(path: &Path, name: &str) -> BTreeMap<String, Vec<u64>> {
    let mut earlier: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    let value = std::fs::read(path).ok();
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
    if let Ok(about) = std::fs::metadata(path) {
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
    std::fs::File::create_new(&probe)?;
    std::fs::remove_file(&probe)
}

fn unwritable(path: &Path, e: &std::io::Error) -> Diagnostic {
    let mut d = Diagnostic::error(Cause::FileUnwritable, format!("cannot be written: {e}"));
    d.file = Some(path.display().to_string());
    d
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
