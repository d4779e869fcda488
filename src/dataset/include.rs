//! Datasets in several files: `! cognate: INCLUDE leg.adm` on a line of its own stands for the
//! statements of another dataset, without its title and its END.
//!
//! Adams has no such statement. The texts are put together before anything is read, so that all
//! that holds for one text holds for several; a [`Source`] knows the file of each of its pieces.
//! Names of files are relative to the file that includes. A text without a file includes nothing.

use super::extension::after_mark;
use super::syntax::{self, Piece, Source};
use super::{check_title, overlooked, view};
use crate::diagnostic::{Diagnostic, Span};
use crate::disk;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

/// The word of such a line.
const WORD: &str = "INCLUDE";
/// Files within each other, at most.
const MOST_WITHIN: usize = 16;
/// Files of a dataset, at most.
const MOST_FILES: usize = 1000;
/// Bytes of all files of a dataset, at most.
const MOST_BYTES: usize = 1 << 28;

/// Returns a source with the texts of all files that it includes, and whether all were found; what
/// cannot be included is reported at its line.
pub(super) fn expanded(source: Source, out: &mut Vec<Diagnostic>) -> (Source, bool) {
    let mentions = |line: Span| named(&source, line).is_some();
    if !source.lines().skip(1).any(mentions) {
        return (source, true);
    }
    let mut spliced = Spliced {
        text: String::new(),
        pieces: Vec::new(),
        open: source
            .file
            .iter()
            .map(|file| plain(Path::new(file)))
            .collect(),
        n_files: 1,
        is_whole: true,
        out,
    };
    let syntax = syntax::dataset(&source, &mut Vec::new());
    let last = syntax.end.map_or(source.text.len(), |end| end.start);
    spliced.add(&source, 0..last);
    spliced.put(&source, last..source.text.len());
    let Spliced {
        text,
        pieces,
        is_whole,
        ..
    } = spliced;
    (source.within(text, pieces), is_whole)
}

/// Returns the name of the file that a line includes, with its place; `None`: it is no such line.
pub(super) fn named(source: &Source, line: Span) -> Option<Span> {
    let text = source.slice(line);
    let inner = text.trim_start();
    if !inner.starts_with('!') {
        return None;
    }
    let start = line.start + (text.len() - inner.len());
    let span = after_mark(source, Span::new(start, start + inner.trim_end().len()))?;
    let (word, rest) = source.slice(span).split_at_checked(WORD.len())?;
    let is_it = word.eq_ignore_ascii_case(WORD) && !rest.starts_with(|c: char| c.is_alphanumeric());
    is_it.then(|| {
        let name = rest.trim_start();
        Span::new(span.end - name.len(), span.end)
    })
}

impl Source {
    /// Returns the files that lines of this text include, by their names alone.
    pub fn includes(&self) -> Vec<PathBuf> {
        let folder = self
            .file
            .as_deref()
            .and_then(|file| Path::new(file).parent());
        let names = self.lines().skip(1).filter_map(|line| named(self, line));
        let names = names.map(|name| self.slice(name).trim_matches(['\'', '"']).trim());
        let path = |name| plain(&folder.unwrap_or(Path::new("")).join(disk::path(name)));
        names.map(path).collect()
    }
}

/// A line that includes a file.
struct Include {
    /// the name of the file
    name: Span,
    /// where the line ends
    end: usize,
    /// why it cannot stand there
    wrong: Option<&'static str>,
}

/// Returns the lines of a part of a file that include others.
fn includes(source: &Source, body: &Range<usize>) -> Vec<Include> {
    let mut found: Vec<Include> = Vec::new();
    // the first of those since the last statement
    let mut first = 0;
    // the name that stands above the next statement, and how the last line of one ended
    let (mut is_named, mut is_carried) = (false, false);
    let lines = source.lines().skip(1);
    for line in lines.filter(|line| body.contains(&line.start)) {
        let text = source.slice(line).trim();
        if let Some(name) = named(source, line) {
            found.push(Include {
                name,
                end: line.end.min(body.end),
                wrong: match is_named {
                    _ if is_carried => Some(WITHIN),
                    true => Some("a name stands above it, which belongs to a statement"),
                    false => None,
                },
            });
        } else if text.starts_with('!') {
            is_named |= syntax::view_name(text).is_some();
        } else if !text.is_empty() {
            let above = found[first..].iter_mut().filter(|_| text.starts_with(','));
            above.for_each(|include| include.wrong = Some(WITHIN));
            first = found.len();
            (is_named, is_carried) = (false, text.ends_with('&'));
        }
    }
    found
}

const WITHIN: &str = "it stands within a statement";

/// Texts that are put together.
struct Spliced<'o> {
    text: String,
    pieces: Vec<Piece>,
    /// the files that lead to what is read now
    open: Vec<PathBuf>,
    n_files: usize,
    is_whole: bool,
    out: &'o mut Vec<Diagnostic>,
}

impl Spliced<'_> {
    /// Adds the lines of a file from one byte to another, and what they include.
    fn add(&mut self, source: &Source, body: Range<usize>) {
        let mut from = body.start;
        for include in includes(source, &body) {
            self.put(source, from..include.end);
            from = include.end;
            let done = match include.wrong {
                Some(what) => Err(mistake(what)),
                None => self.follow(source, include.name),
            };
            if let Err(d) = done {
                self.is_whole = false;
                self.out.push(match d.file {
                    Some(_) => d,
                    None => source.locate(d, include.name),
                });
            }
        }
        self.put(source, from..body.end);
    }

    /// Adds lines as they stand.
    fn put(&mut self, source: &Source, range: Range<usize>) {
        if range.is_empty() {
            return;
        }
        if !self.text.is_empty() && !self.text.ends_with(['\n', '\r']) {
            self.text.push('\n');
        }
        self.pieces.push(Piece {
            start: self.text.len(),
            at: range.start,
            line: source.place(range.start).0,
            file: source.file.clone(),
        });
        self.text.push_str(&source.text[range]);
    }

    /// Adds the statements of the file that a line names.
    fn follow(&mut self, source: &Source, name: Span) -> Result<(), Diagnostic> {
        let name = source.slice(name).trim_matches(['\'', '"']).trim();
        if name.is_empty() {
            return Err(mistake("the name of a file is expected").help(USAGE));
        }
        let Some(of) = &source.file else {
            let d = mistake("a text without a file includes none");
            return Err(
                d.help("read the dataset from its file, or put the statements into the text")
            );
        };
        let folder = Path::new(of).parent().unwrap_or(Path::new(""));
        let path = plain(&folder.join(disk::path(name)));
        if self.open.contains(&path) {
            let chain = self.open.iter().chain([&path]);
            let chain: Vec<String> = chain.map(disk::text).collect();
            return Err(mistake(format!("{name} includes itself")).help(chain.join(" includes ")));
        }
        if self.open.len() > MOST_WITHIN || self.n_files >= MOST_FILES {
            return Err(mistake(format!(
                "there are more than {MOST_WITHIN} files within each other, or {MOST_FILES} in all"
            )));
        }
        self.n_files += 1;
        let file = disk::text(&path);
        if view::is_view(Some(&file)) {
            let d = mistake(format!(
                "{name} is a command file of Adams View, no dataset"
            ));
            return Err(d.help(format!(
                "cognate convert {name} NAME.adm writes the dataset"
            )));
        }
        let included = super::open(&path).map_err(|e| {
            let d = e.into_first();
            mistake(format!("{file} {}", d.message))
                .help("names are relative to the file that includes")
        })?;
        if self.text.len() + included.text.len() > MOST_BYTES {
            return Err(mistake("the files of the dataset are too large together"));
        }
        let syntax = syntax::dataset(&included, self.out);
        check_title(&included, &syntax, self.out);
        self.out
            .extend(overlooked::after_end(&included, syntax.after));
        let end = syntax.end.map_or(included.text.len(), |end| end.start);
        let first = included
            .lines()
            .nth(1)
            .map_or(end, |line| line.start.min(end));
        if continues(&included.text[first..end]) {
            let d = mistake(
                "the first line below the title continues a statement, but none stands above it",
            );
            return Err(included.locate(d, Span::new(first, first)));
        }
        if let Some((line, what)) = unfinished(&included, first..end) {
            return Err(included.locate(mistake(what), line));
        }
        self.open.push(path);
        self.add(&included, first..end);
        self.open.pop();
        Ok(())
    }
}

const USAGE: &str =
    "`! cognate: INCLUDE leg.adm` on a line of its own has the statements of that dataset";

fn mistake(what: impl Into<String>) -> Diagnostic {
    Diagnostic::error("include", what)
}

/// Returns the last line of a part of a file that waits for something behind it, and for what.
fn unfinished(source: &Source, body: Range<usize>) -> Option<(Span, &'static str)> {
    let mut found = None;
    for line in source.lines().filter(|line| body.contains(&line.start)) {
        let text = source.slice(line).trim();
        if text.starts_with('!') {
            if syntax::view_name(text).is_some() {
                found = Some((line, "no statement of this file stands below this name"));
            }
        } else if text.ends_with('&') {
            found = Some((line, "the statement goes on beyond the end of this file"));
        } else if !text.is_empty() {
            found = None;
        }
    }
    found
}

/// Returns whether the first line of a text that is no comment continues a statement.
fn continues(text: &str) -> bool {
    let mut lines = text.split(['\n', '\r']).map(str::trim_start);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with('!'));
    first.is_some_and(|line| line.starts_with(','))
}

/// Returns a path without `.` and, where that is possible by its words, without `..`.
fn plain(path: &Path) -> PathBuf {
    let mut found = PathBuf::new();
    for component in path.components() {
        match (component, found.components().next_back()) {
            (Component::CurDir, _) => {}
            (Component::ParentDir, Some(Component::Normal(_))) => drop(found.pop()),
            (component, _) => found.push(component),
        }
    }
    found
}
