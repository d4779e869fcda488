//! Where the files of a run go: results of an earlier run make way and are kept once, as `NAME~`;
//! files of anybody else stay as they are.
//!
//! A run record lists the files of its run and their sizes. A file that stands in the way and is
//! not on that list was made by somebody else, or changed since: [`Writing`] says what may be done.
//! Files are complete beside their places before any is put there, and the list is written before
//! that: a run that is killed in between leaves no file that the next one would take for somebody
//! else's.

use super::format::Finished;
use super::part_file::{PartFile, beside, unwritable};
use super::writing::{Standing, free_name, is_kept, is_ours, keep, put_aside};
use super::{Writing, kept};
use crate::diagnostic::{Diagnostic, Error};
use crate::disk;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
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
    /// files of the earlier run that made way, under their new names, with bytes
    kept_own: BTreeMap<String, u64>,
    /// names of files that this run has put in their places
    placed: BTreeSet<String>,
    writing: Writing,
    /// whether names may lead out of the folder
    is_trusting: bool,
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
            earlier: listed(&dir.join(disk::path(&record)), &record),
            dir: dir.to_owned(),
            record,
            written: BTreeMap::new(),
            files: Vec::new(),
            kept: Vec::new(),
            kept_own: BTreeMap::new(),
            placed: BTreeSet::new(),
            writing: Writing::default(),
            is_trusting: false,
            held: None,
        })
    }

    /// Gives leave to write: over which files, and to names that lead out of the folder.
    #[must_use]
    pub fn with_leave(self, writing: Writing, is_trusting: bool) -> Self {
        Self {
            writing,
            is_trusting,
            ..self
        }
    }

    /// Refuses names under which nothing may be written, before the work begins.
    ///
    /// # Errors
    /// All of them: files of somebody else, inputs of this command, folders.
    pub fn check(&self, names: &[String]) -> Result<(), Error> {
        let names = names.iter().chain([&self.record]);
        let refused = names.filter_map(|name| {
            let path = self.dir.join(disk::path(name));
            let inside = self.stays_inside(name);
            inside.and_then(|()| self.standing(name, &path)).err()
        });
        match refused.collect::<Vec<_>>() {
            refused if refused.is_empty() => Ok(()),
            refused => Err(Error::from(refused)),
        }
    }

    /// Refuses a name that leads out of the folder, also by links.
    fn stays_inside(&self, name: &str) -> Result<(), Diagnostic> {
        let path = self.dir.join(disk::path(name));
        let there = |path: &Path| {
            let above = path.ancestors().skip(1);
            let mut real = above.filter_map(|a| match a.as_os_str().is_empty() {
                true => Path::new(".").canonicalize().ok(),
                false => a.canonicalize().ok(),
            });
            real.next()
        };
        // a folder that is not there yet has nothing in it that leads out
        let dir = self.dir.join(".").canonicalize().ok();
        let leads_out = match (dir, there(&path)) {
            (Some(dir), Some(real)) => !real.starts_with(dir),
            _ => disk::leads_outside(name),
        };
        if !leads_out || self.is_trusting {
            return Ok(());
        }
        let what = std::io::Error::other("it is outside of the folder of the results");
        Err(unwritable(&path, &what).help("--trust-paths follows such names"))
    }

    /// Returns the thing in the place of a file, if it may be replaced.
    fn standing(&self, name: &str, path: &Path) -> Result<Standing, Diagnostic> {
        let is_own = || self.is_earlier(name, path) || is_ours(path);
        self.writing.standing(path, is_own)
    }

    /// Returns the place of a file, under a name that may contain folders of its own.
    pub fn path(&self, name: &str) -> PathBuf {
        self.dir.join(disk::path(name))
    }

    /// Returns the place of a file, whose folders are made.
    ///
    /// # Errors
    /// When a folder cannot be made.
    pub fn place(&self, name: &str) -> Result<PathBuf, Diagnostic> {
        self.stays_inside(name)?;
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

    /// Puts complete files in their places, after a list that claims them: all that can be.
    ///
    /// # Errors
    /// The first file that cannot be put there, and where it stands.
    pub fn put(&mut self, files: &[(String, Finished)]) -> Result<(), Diagnostic> {
        self.claim(files)?;
        let mut outcome = Ok(());
        for (name, file) in files {
            if let Err(d) = self.put_in_place(name, file) {
                let part = disk::text(&file.part);
                outcome = outcome.and(Err(d.help(format!("its contents stand in {part}"))));
                continue;
            }
            self.written.insert(name.clone(), file.bytes);
            self.files.push(self.dir.join(disk::path(name)));
        }
        outcome
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
        self.files.push(self.dir.join(disk::path(&record)));
        // from now on it is ours
        self.earlier.insert(record, vec![file.bytes]);
        Ok(())
    }

    /// Puts those of these files aside that an earlier run has written and this one has not.
    ///
    /// # Errors
    /// When one cannot be renamed.
    pub fn put_stale_aside(&mut self, names: &[String]) -> Result<(), Diagnostic> {
        // what is kept already stays under its name
        for name in names.iter().filter(|name| !is_kept(name)) {
            let path = self.dir.join(disk::path(name));
            let is_stale = !self.written.contains_key(name) && self.is_earlier(name, &path);
            if is_stale && !disk::is_input(&path) {
                self.keep_own(name, &path)?;
            }
        }
        Ok(())
    }

    /// Renames a file of the earlier run to its name with a `~` behind.
    fn keep_own(&mut self, name: &str, path: &Path) -> Result<(), Diagnostic> {
        let bytes = path.symlink_metadata().map_or(0, |about| about.len());
        let own = disk::text(path);
        let aside_name = |aside: &Path| {
            let aside = disk::text(aside);
            [name, aside.strip_prefix(&own).unwrap_or_default()].concat()
        };
        let is_earlier = |aside: &Path| self.is_earlier(&aside_name(aside), aside);
        let aside = keep(path, |aside| is_earlier(aside) || is_ours(aside))?;
        self.kept_own.insert(aside_name(&aside), bytes);
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
        let names = names.filter(|name| !self.kept_own.contains_key(*name));
        let standing = names.filter_map(|name| {
            let path = self.dir.join(disk::path(name));
            let stands = self.is_earlier(name, &path);
            let about = path.symlink_metadata().ok().filter(|_| stands)?;
            Some((name.clone(), about.len()))
        });
        for (name, size) in standing.collect::<Vec<_>>() {
            let list = match is_kept(&name) {
                true => &mut self.kept_own,
                false => &mut self.written,
            };
            list.entry(name).or_insert(size);
        }
    }

    /// Returns names and sizes of the files that were written, for the record.
    pub fn written(&self) -> &BTreeMap<String, u64> {
        &self.written
    }

    /// Returns names and sizes of the files of the earlier run that are kept, for the record.
    pub fn kept_own(&self) -> &BTreeMap<String, u64> {
        &self.kept_own
    }

    /// Returns the files that were written, in that order.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Returns the part of a file that another run has left, which was ended from outside.
    pub fn left_part(&self, name: &str) -> Option<PathBuf> {
        let place = self.dir.join(disk::path(name));
        let parts = (1..).map(|number| beside(&place, number));
        let mut there = parts.take_while(|part| part.symlink_metadata().is_ok());
        there.find(|part| !disk::is_held(part))
    }

    /// Returns the files of others that were in the way: where they were, and where they are now.
    pub fn kept(&self) -> &[(PathBuf, PathBuf)] {
        &self.kept
    }

    /// Gives a complete file its place. What an earlier run has put there goes first.
    fn put_in_place(&mut self, name: &str, file: &Finished) -> Result<(), Diagnostic> {
        let path = self.dir.join(disk::path(name));
        self.stays_inside(name)?;
        if self.placed.contains(name) {
            disk::remove_file(&path).map_err(|e| unwritable(&path, &e))?;
        }
        match self.standing(name, &path)? {
            Standing::Nothing => {}
            Standing::Ours => self.keep_own(name, &path)?,
            Standing::Others => {
                let aside = put_aside(&path)?;
                self.kept.push((path.clone(), aside));
            }
            Standing::Stream => {
                let what = std::io::Error::other("it is no file, and takes no results");
                return Err(unwritable(&path, &what));
            }
        }
        disk::put_new(&file.part, &path).map_err(|e| unwritable(&path, &e))?;
        self.placed.insert(name.to_owned());
        Ok(())
    }

    /// Returns true if a file is one of the earlier run, as it was written.
    fn is_earlier(&self, name: &str, path: &Path) -> bool {
        let sizes = self.earlier.get(name);
        let there = path.symlink_metadata().ok().filter(disk::Metadata::is_file);
        let is_one = |bytes| sizes.is_some_and(|sizes| sizes.contains(&bytes));
        there.is_some_and(|there| is_one(there.len()) || kept::is_record(path))
    }

    /// Writes a record that claims files before they are put in their places, beside those of the
    /// earlier run.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn claim(&mut self, more: &[(String, Finished)]) -> Result<(), Diagnostic> {
        // another run of this name may have ended in the meantime
        for (name, sizes) in listed(&self.dir.join(disk::path(&self.record)), &self.record) {
            let known = self.earlier.entry(name).or_default();
            known.extend(sizes);
            known.sort_unstable();
            known.dedup();
        }
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
        self.held = disk::hold(&self.dir.join(disk::path(&self.record)));
        // the record of the run is still to come
        self.files.truncate(shown);
        Ok(())
    }
}

/// Returns the files that a record lists, with the sizes that they may have; none if it is no
/// record of this program.
pub(super) fn listed(path: &Path, name: &str) -> BTreeMap<String, Vec<u64>> {
    let mut earlier: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    let value = disk::read_own(path).ok();
    let value = value.and_then(|text| serde_json::from_slice::<Value>(&text).ok());
    let Some(value) = value.filter(|v| v["versions"]["cognate"].is_string()) else {
        return earlier;
    };
    for list in [&value["files"], &value["kept"], &value["replaced"]] {
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
