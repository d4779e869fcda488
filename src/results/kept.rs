//! Runs that a folder keeps: each has a record, which names its files and their sizes.
//!
//! Only what a record claims, in the size that it claims, belongs to a run. A file of that name and
//! another size was made or changed by somebody else since, and stays where it is.

use super::format::Format;
use super::output_folder::{BEING_WRITTEN, listed};
use super::part_file::unwritable;
use super::write_text;
use super::writing::is_kept;
use crate::arrange::Arrange;
use crate::diagnostic::{Diagnostic, near_names};
use crate::disk;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// A run as its record tells it.
#[derive(Clone, Debug)]
pub struct KeptRun {
    /// folder that the record is in
    pub folder: PathBuf,
    /// base name of its files
    pub name: String,
    /// the record, as [`super::json::record`] wrote it
    pub record: Value,
    /// files that the record claims, but itself: place relative to [`KeptRun::root`], and the sizes
    /// that it may have, in bytes
    claims: BTreeMap<String, Vec<u64>>,
}

/// The state of a run in its folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// all its files are there, as far as its record says
    Complete,
    /// a program is writing it
    BeingWritten,
    /// the program that wrote it was ended from outside: rows so far are in its parts
    CutOff,
}

/// A file that a record claims.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimedFile {
    /// its name in the record
    pub name: String,
    /// its place
    pub path: PathBuf,
    /// its size there, in bytes; `None`: there is no such file
    pub bytes: Option<u64>,
    /// whether it is as the run has written it
    pub is_own: bool,
}

/// Returns the runs of a folder and of the folders in it, by place and name.
///
/// # Errors
/// When the folder cannot be read.
pub fn runs_in(folder: &Path) -> Result<Vec<KeptRun>, Diagnostic> {
    let unreadable = |e: std::io::Error| {
        let what = format!("{}: cannot be read: {e}", disk::text(&folder));
        Diagnostic::error("file_unreadable", what)
    };
    let mut found = records_in(folder).map_err(unreadable)?;
    let entries = disk::read_dir(folder).map_err(unreadable)?.flatten();
    for entry in entries.filter(|e| e.file_type().is_ok_and(|t| t.is_dir())) {
        // a folder that may not be read has nothing to list
        found.extend(records_in(&folder.join(entry.file_name())).unwrap_or_default());
    }
    found.arrange_by(|a, b| (&a.folder, &a.name).cmp(&(&b.folder, &b.name)));
    Ok(found)
}

/// Returns the runs whose records are in a folder itself.
fn records_in(folder: &Path) -> std::io::Result<Vec<KeptRun>> {
    let paths = disk::read_dir(folder)?.flatten();
    let names = paths.map(|entry| folder.join(entry.file_name()));
    let is_json = |path: &PathBuf| path.extension().is_some_and(|e| e == "json");
    Ok(names.filter(is_json).filter_map(|p| read(&p)).collect())
}

/// Reads the contents of a record; `None`: the file is none.
fn record(path: &Path) -> Option<Value> {
    let record: Value = serde_json::from_slice(&disk::read_own(path).ok()?).ok()?;
    let is_record = record["versions"]["cognate"].is_string() && record["files"].is_object();
    is_record.then_some(record)
}

/// Returns whether a file is a record, or one that has made way for another.
pub(super) fn is_record(path: &Path) -> bool {
    let name = disk::text(path.file_name().unwrap_or_default());
    let before = name.rsplit_once('~').filter(|_| is_kept(&name));
    before.map_or(&*name, |(name, _)| name).ends_with(".json") && record(path).is_some()
}

/// Returns whether a file is a record, or a run in its folder claims it as it is.
pub(super) fn is_claimed(path: &Path) -> bool {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let name = path.file_name().unwrap_or_default();
    let is_it = |file: ClaimedFile| {
        let same = file.path.file_name() == Some(name) && file.path.parent() == Some(folder);
        same && file.is_own
    };
    let claims = |run: KeptRun| run.files().into_iter().any(is_it);
    is_record(path) || records_in(folder).is_ok_and(|runs| runs.into_iter().any(claims))
}

/// Reads a run; `None`: the file is no record.
fn read(path: &Path) -> Option<KeptRun> {
    let record = record(path)?;
    let own = disk::text(path.file_name()?);
    let mut claims = listed(path, &own);
    claims.remove(&own);
    Some(KeptRun {
        folder: path.parent()?.to_owned(),
        name: disk::text(path.file_stem()?),
        record,
        claims,
    })
}

/// Finds a run by its name with its folder, as `results/crank`, or by one of its files.
///
/// # Errors
/// When there is none; the advice names those that are meant perhaps.
pub fn find(named: &Path) -> Result<KeptRun, Diagnostic> {
    let mut with_ending = named.as_os_str().to_owned();
    with_ending.push(".json");
    if let Some(run) = read(Path::new(&with_ending)) {
        return Ok(run);
    }
    let beside = read(&named.with_extension("json"));
    let is_of = |run: &KeptRun| {
        run.record_file() == named || run.files().iter().any(|file| file.path == named)
    };
    if let Some(run) = beside.filter(is_of) {
        return Ok(run);
    }
    let what = format!("there is no run {}", disk::text(&named));
    let said = Diagnostic::error("unknown_run", what);
    let folder = named.parent().filter(|f| !f.as_os_str().is_empty());
    let known = runs_in(folder.unwrap_or(Path::new("."))).unwrap_or_default();
    let known: Vec<String> = known.iter().map(KeptRun::place).collect();
    let wanted = disk::text(&named);
    let near = near_names(&wanted, known.iter().map(String::as_str));
    Err(match (near.is_empty(), known.is_empty()) {
        (false, _) => said.help(format!("did you mean {}?", near.join(" or "))),
        (true, false) => said.help(format!("there are {}", known.join(", "))),
        (true, true) => said.help("`cognate runs FOLDER` lists the runs of a folder"),
    })
}

/// Returns whether a text may name a run: a name of a file, without a folder.
pub fn is_run_name(text: &str) -> bool {
    let mut parts = Path::new(text).components();
    let is_one = matches!(
        (parts.next(), parts.next()),
        (Some(Component::Normal(_)), None)
    );
    is_one && !text.contains(['/', '\\'])
}

impl KeptRun {
    /// Returns its name with its folder, by which [`find`] finds it.
    pub fn place(&self) -> String {
        let folder = self.folder.strip_prefix(".").unwrap_or(&self.folder);
        disk::text(&folder.join(disk::path(&self.name)))
    }

    /// Returns the place of its record.
    pub fn record_file(&self) -> PathBuf {
        self.folder.join(disk::path(format!("{}.json", self.name)))
    }

    /// Returns the state of the run.
    pub fn state(&self) -> State {
        match self.record["status"].as_str() {
            Some(BEING_WRITTEN) if disk::is_held(&self.record_file()) => State::BeingWritten,
            Some(BEING_WRITTEN) => State::CutOff,
            _ => State::Complete,
        }
    }

    /// Returns the parts of its files, with their sizes in bytes: rows so far of a run that goes
    /// on, or rows that one has left which was ended from outside; each to be read by its name; of
    /// Parquet a folder.
    pub fn parts(&self) -> Vec<(PathBuf, u64)> {
        let own = format!("{}.", self.name);
        let is_part = |path: &Path| {
            let name = path.file_name().map(disk::text);
            let rest = name.as_ref().and_then(|name| name.strip_prefix(&own));
            rest.and_then(|rest| rest.rsplit_once(".part"))
                .is_some_and(|(table, number)| {
                    let format = table.strip_prefix("table.").unwrap_or(table);
                    Format::row(format).is_some() && number.parse::<u32>().is_ok()
                })
        };
        let entries = |folder: &Path| disk::read_dir(folder).into_iter().flatten().flatten();
        let bytes = |path: &Path| match disk::is_folder(path) {
            true => {
                let sizes = entries(path).filter_map(|e| e.metadata().ok());
                sizes.map(|about| about.len()).sum()
            }
            false => disk::metadata(path).map_or(0, |about| about.len()),
        };
        let mut all: Vec<(PathBuf, u64)> = entries(&self.folder)
            .map(|entry| self.folder.join(entry.file_name()))
            .filter(|path| is_part(path))
            .map(|path| (path.clone(), bytes(&path)))
            .collect();
        all.arrange();
        all
    }

    /// Returns the folder that names of files in the record start from: a run whose name has
    /// folders of its own is recorded with them.
    fn root(&self) -> &Path {
        let own = format!("{}.", self.name);
        let mine = (self.claims.keys().map(Path::new)).find(|claim| {
            let name = claim.file_name();
            name.is_some_and(|name| name.to_string_lossy().starts_with(&own))
        });
        let inside = mine.and_then(Path::parent).unwrap_or(Path::new(""));
        let is_below = self.folder.ends_with(inside);
        let above = self.folder.ancestors().nth(inside.components().count());
        above.filter(|_| is_below).unwrap_or(&self.folder)
    }

    /// Returns the files that the record claims, but itself. A name that leads out of the folder is
    /// never one of its own.
    pub fn files(&self) -> Vec<ClaimedFile> {
        let root = self.root();
        let file = |(name, sizes): (&String, &Vec<u64>)| {
            let inside = |c: Component| matches!(c, Component::Normal(_));
            let path = root.join(disk::path(name));
            let about = path.symlink_metadata().ok();
            let bytes = about.as_ref().map(disk::Metadata::len);
            let is_file = about.is_some_and(|a| a.is_file());
            let is_own = is_file && Path::new(name).components().all(inside);
            ClaimedFile {
                name: name.clone(),
                path,
                bytes,
                is_own: is_own && bytes.is_some_and(|b| sizes.contains(&b)),
            }
        };
        self.claims.iter().map(file).collect()
    }

    /// Refuses to touch a run that a program is writing.
    fn is_at_rest(&self) -> Result<(), Diagnostic> {
        if self.state() != State::BeingWritten {
            return Ok(());
        }
        let what = format!("{} is being written", self.place());
        Err(Diagnostic::error("run_in_use", what).help("wait until it has ended, or end it"))
    }

    /// Removes the files of the run, its parts where it was cut off, and its record at last;
    /// returns the files that are there and not as the run wrote them, which stay.
    ///
    /// # Errors
    /// When a program is writing it, or a file cannot be removed. The record then stays, and claims
    /// the others.
    pub fn delete(&self) -> Result<Vec<PathBuf>, Diagnostic> {
        self.is_at_rest()?;
        let left = self.parts().into_iter().map(|(part, _)| part);
        for part in left.filter(|part| !disk::is_held(part)) {
            let removed = match disk::is_folder(&part) {
                true => disk::remove_dir_all(&part),
                false => disk::remove_file(&part),
            };
            removed.map_err(|e| unwritable(&part, &e))?;
        }
        let (own, others): (Vec<_>, Vec<_>) = self.files().into_iter().partition(|f| f.is_own);
        let own = own.into_iter().map(|f| f.path);
        for path in own.chain([self.record_file()]) {
            disk::remove_file(&path).map_err(|e| unwritable(&path, &e))?;
        }
        let kept = others.into_iter().filter(|f| f.bytes.is_some());
        Ok(kept.map(|f| f.path).collect())
    }

    /// Gives the run another name: its record and its files that begin with the old name. Returns
    /// the files that are there and not as the run wrote them, which keep their names.
    ///
    /// # Errors
    /// When the name is none of a file, a file of the new name is there already, or a file cannot
    /// be renamed. Until all are, both records claim them.
    pub fn rename(&self, name: &str) -> Result<Vec<PathBuf>, Diagnostic> {
        self.is_at_rest()?;
        if !is_run_name(name) {
            let what = format!("`{name}` is no name of a run: a run stays in its folder");
            return Err(Diagnostic::error("unknown_run", what));
        }
        let renamed = |claim: &str| {
            let path = Path::new(claim);
            let rest = path.file_name()?.to_str()?.strip_prefix(&self.name)?;
            let is_named_after = rest.starts_with('.') || rest.starts_with("_linear");
            let new = path.with_file_name(format!("{name}{rest}"));
            is_named_after.then(|| new.to_string_lossy().into_owned())
        };
        let (own, others): (Vec<_>, Vec<_>) = self.files().into_iter().partition(|f| f.is_own);
        let new_record = self.folder.join(disk::path(format!("{name}.json")));
        let moves: Vec<(PathBuf, PathBuf)> = (own.iter())
            .filter_map(|f| {
                Some((
                    f.path.clone(),
                    self.root().join(disk::path(renamed(&f.name)?)),
                ))
            })
            .collect();
        let targets = moves.iter().map(|(_, to)| to).chain([&new_record]);
        let mut there = targets.filter(|to| to.symlink_metadata().is_ok());
        if let Some(there) = there.next() {
            let what = format!("{} is there already", disk::text(&there));
            let said = Diagnostic::error("run_exists", what);
            return Err(said.help("choose another name, or delete that run"));
        }
        let mut record = self.record.clone();
        for list in ["files", "kept"] {
            let Some(files) = record.get_mut(list).and_then(Value::as_object_mut) else {
                continue;
            };
            // a file that somebody has changed is no longer one of the run
            files.retain(|claimed, _| own.iter().any(|f| f.name == *claimed));
            let old = std::mem::take(files);
            let claim = |(old, size): (String, Value)| (renamed(&old).unwrap_or(old), size);
            *files = old.into_iter().map(claim).collect();
        }
        write_text(&new_record, &super::json::text(&record))?;
        for (from, to) in &moves {
            disk::rename(from, to).map_err(|e| unwritable(to, &e))?;
        }
        let old = self.record_file();
        disk::remove_file(&old).map_err(|e| unwritable(&old, &e))?;
        let kept = others.into_iter().filter(|f| f.bytes.is_some());
        Ok(kept.map(|f| f.path).collect())
    }
}
