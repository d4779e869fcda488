//! Where the files of a run go: results of an earlier run make way, files of anybody else are kept.
//!
//! A run record lists the files of its run and their sizes. A file that stands in the way and is
//! not on that list was made by somebody else, or changed since: it is renamed, never overwritten.

use super::write_text;
use crate::diagnostic::Diagnostic;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files that are being written to a folder.
#[derive(Debug)]
pub struct OutputFolder {
    dir: PathBuf,
    record: PathBuf,
    /// what the record of the earlier run lists: name and bytes
    earlier: BTreeMap<String, u64>,
    /// what has been written, with bytes
    written: BTreeMap<String, u64>,
    /// the same in the order of writing
    files: Vec<PathBuf>,
    /// files of others: where they were, and where they are now
    kept: Vec<(PathBuf, PathBuf)>,
}

impl OutputFolder {
    /// Opens the folder `dir` for the run called `base`.
    pub fn new(dir: &Path, base: &str) -> Self {
        let name = format!("{base}.json");
        let record = dir.join(&name);
        let mut earlier = BTreeMap::new();
        let value = std::fs::read(&record).ok();
        let value = value.and_then(|text| serde_json::from_slice::<Value>(&text).ok());
        if let Some(value) = value.filter(|v| v["versions"]["cognate"].is_string()) {
            let files = value["files"].as_object().into_iter().flatten();
            earlier.extend(files.filter_map(|(name, bytes)| Some((name.clone(), bytes.as_u64()?))));
            // a record cannot contain its own size
            if let Ok(about) = std::fs::metadata(&record) {
                earlier.insert(name, about.len());
            }
        }
        Self {
            dir: dir.to_owned(),
            record,
            earlier,
            written: BTreeMap::new(),
            files: Vec::new(),
            kept: Vec::new(),
        }
    }

    /// Writes a file into the folder, under a name that may contain folders of its own.
    ///
    /// # Errors
    /// When it cannot be written, or what is there cannot be moved.
    pub fn put(&mut self, name: &str, text: &str) -> Result<(), Diagnostic> {
        let path = self.dir.join(name);
        let refused = |e: std::io::Error| {
            let mut d = Diagnostic::error("file_unwritable", format!("cannot be written: {e}"));
            d.file = Some(path.display().to_string());
            d
        };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(refused)?;
        }
        if let Ok(there) = std::fs::symlink_metadata(&path)
            && self.earlier.get(name) != Some(&there.len())
            && !self.written.contains_key(name)
        {
            let aside = free_name(&path);
            std::fs::rename(&path, &aside).map_err(refused)?;
            self.kept.push((path.clone(), aside));
        }
        write_text(&path, text)?;
        self.written.insert(name.to_owned(), text.len() as u64);
        self.files.push(path);
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

    /// Returns the path of the record.
    pub fn record(&self) -> &Path {
        &self.record
    }
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
