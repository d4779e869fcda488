//! Command files (`.acf`): a sequence of typed commands, each with its place; and the same from a
//! message log.
//!
//! A command that names a statement of the dataset changes that element through the same table of
//! statements; the few that control the run have a table of their own here. Both beginnings of a
//! file are understood: `FILE/MODEL=…`, and the answers to the old prompts (dataset, output name)
//! on the first two lines.

mod apply;
mod doubts;
mod interpret;
mod message_log;
mod outside;
mod unread;

use super::idle::Idle;
use super::read::{self, Table};
use super::row::{Argument, Meaning, Problem, Record, Statement, meaning, near_ids};
use super::statement::STATEMENTS;
use super::syntax::{self, Item, Source, Syntax};
use super::value::Kind;
use super::{enter, load};
use crate::arrange::Arrange;
use crate::diagnostic::{Diagnostic, Error, Severity, Span};
use crate::disk;
use crate::model::{ElementKind, Model, SettingsStatement};
use interpret::{COMMANDS, interpret};
use message_log::of_message_log;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// The kind of simulation that SIMULATE runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SimulationKind {
    /// motions alone move the mechanism
    Kinematic,
    /// forces move it
    Dynamic,
    /// it comes to rest
    Static,
    /// kinematic without freedom, else dynamic
    Transient,
    /// positions and velocities at the start, and nothing more
    InitialConditions,
}

/// SIMULATE: one simulation, from where the last one ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Simulate {
    /// which
    pub kind: SimulationKind,
    /// END: absolute time of the end
    pub end: Option<f64>,
    /// DURATION: time from here to the end
    pub duration: Option<f64>,
    /// STEPS: number of output steps
    pub steps: Option<u32>,
    /// DTOUT: time between output steps
    pub dtout: Option<f64>,
}

/// LINEAR: what to compute at the present state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Linear {
    /// EIGENSOL: eigenvalues and mode shapes
    pub eigensolution: bool,
    /// STATEMAT: the matrices A, B, C, D
    pub state_matrices: bool,
    /// without the damping of the model
    pub no_damping: bool,
    /// first and last mode whose shape is wanted
    pub coords: Vec<u32>,
    /// RM: the marker in whose frame the model is to be looked at
    pub rm: Option<u32>,
    /// FILE: where the matrices go
    pub file: Option<String>,
    /// FORMAT of that file
    pub format: Option<String>,
    /// PINPUT: whose VARIABLEs are the inputs
    pub pinput: Option<u32>,
    /// POUTPUT: whose VARIABLEs are the outputs
    pub poutput: Option<u32>,
}

/// One command.
#[derive(Clone, Debug)]
pub enum Command {
    /// FILE: which dataset to read, the base name of the results, another command file to run
    File {
        /// MODEL: the dataset
        model: Option<String>,
        /// OUTPUT_PREFIX: base name of the results
        output_prefix: Option<String>,
        /// COMMAND: a file of commands
        command: Option<String>,
    },
    /// SIMULATE
    Simulate(Simulate),
    /// a statement of the dataset: new values for an element or for settings
    Change(Record),
    /// ACTIVATE (`on`) or DEACTIVATE elements of one kind
    Activate {
        /// ACTIVATE rather than DEACTIVATE
        on: bool,
        /// of which kind
        kind: ElementKind,
        /// ID: numbers one by one
        ids: Vec<u32>,
        /// first and last number
        range: Option<[u32; 2]>,
    },
    /// LINEAR
    Linear(Linear),
    /// SAVE/SYSTEM=file
    Save(Option<String>),
    /// RELOAD/SYSTEM=file
    Reload(Option<String>),
    /// INFO, LIST, SHOW, TIME, HELP, MENU: ask for a print
    Show(String),
    /// STOP: the end, whatever follows
    Stop,
}

/// A command with its place.
#[derive(Clone, Debug)]
pub struct Step {
    /// what to do
    pub command: Command,
    /// as written, on one line
    pub text: String,
    /// 1-based line; 0 when built by a program
    pub line: usize,
}

/// A command file as a sequence of commands.
#[derive(Clone, Debug, Default)]
pub struct Script {
    /// file it came from
    pub path: Option<PathBuf>,
    /// dataset named at its beginning
    pub model: Option<String>,
    /// the dataset was named by the first line, as an answer to the old prompt, and not by
    /// FILE/MODEL
    pub answered: bool,
    /// base name of the results, where one is given
    pub output: Option<String>,
    /// 1-based line that gives it; 0: none of this file
    pub output_line: usize,
    /// the commands, in order; FILE at the beginning is not among them
    pub steps: Vec<Step>,
    /// warnings and notes
    pub diagnostics: Vec<Diagnostic>,
}

/// The two tables one after the other: commands, then statements.
static ROWS: LazyLock<Vec<&'static dyn Statement>> = LazyLock::new(|| {
    let commands = COMMANDS.iter().map(|&c| c as &dyn Statement);
    commands.chain(STATEMENTS.iter().copied()).collect()
});

/// All commands, then all statements of the dataset.
pub(super) fn rows() -> &'static [&'static dyn Statement] {
    &ROWS
}

fn find(word: &str) -> Meaning {
    if word.len() < 3 && !word.eq_ignore_ascii_case("IC") {
        return Meaning::Unknown;
    }
    meaning(word, ROWS.iter().map(|r| r.keyword()))
}

fn table() -> Table {
    Table { rows: &ROWS, find }
}

impl Script {
    /// Reads a command file, and those it calls by FILE/COMMAND.
    ///
    /// # Errors
    /// Every mistake with its place. Warnings are in [`Script::diagnostics`].
    pub fn read(path: impl AsRef<Path>) -> Result<Script, Error> {
        let mut script = read_called(path.as_ref(), 0)?;
        script.doubt_the_whole();
        Ok(script)
    }

    /// Reads commands from a text.
    ///
    /// # Errors
    /// As [`Script::read`].
    pub fn from_text(text: &str) -> Result<Script, Error> {
        of_source(&Source::from_text(None, text))
    }

    /// Reads the commands that a message log (`.msg`) echoes.
    ///
    /// Simulations that were run without a command, as co-simulation does, become SIMULATE commands
    /// up to the last time their table shows.
    ///
    /// # Errors
    /// As [`Script::read`].
    pub fn from_message_log(path: impl AsRef<Path>) -> Result<Script, Error> {
        let path = path.as_ref();
        let file = disk::text(&path);
        let log = Source::from_bytes(Some(&file), &load(path)?);
        let mut script = of_message_log(&log)?;
        script.path = Some(path.to_owned());
        Ok(script)
    }

    /// The same from the text of a log.
    ///
    /// # Errors
    /// As [`Script::read`].
    pub fn from_message_log_text(text: &str) -> Result<Script, Error> {
        of_message_log(&Source::from_text(None, text))
    }

    /// The dataset that the file names, beside the command file, with the ending `.adm` where none
    /// is given. A path that does not exist here is that of another machine: the file of this name
    /// beside the command file is meant. A file whose name differs in small and capital letters
    /// alone is taken where there is no other, as the systems do on which such files are written.
    pub fn model_file(&self) -> Option<PathBuf> {
        let name = self.model.as_deref()?;
        let folder = self.path.as_deref().and_then(Path::parent);
        let beside = |name: &str| {
            let name = with_ending(name);
            existing(folder.map_or(name.clone(), |f| f.join(&name)))
        };
        let named = beside(name);
        let moved = beside(last_component(name));
        Some(if !disk::is_there(&named) && disk::is_there(&moved) {
            moved
        } else {
            named
        })
    }
}

/// Returns the name of a dataset with its ending.
fn with_ending(name: &str) -> PathBuf {
    let path = PathBuf::from(name);
    match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("adm") => path,
        _ => PathBuf::from(format!("{name}.adm")),
    }
}

/// Returns the last component of a path of any system: "test" of "C:\dir\test".
fn last_component(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}

/// The file, or the one beside it whose name has other capital letters.
fn existing(path: PathBuf) -> PathBuf {
    if disk::is_there(&path) {
        return path;
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let alike = |other: &std::ffi::OsStr| {
        (path.file_name()).is_some_and(|name| name.eq_ignore_ascii_case(other))
    };
    let entries = disk::read_dir(folder).into_iter().flatten().flatten();
    let mut found = entries.filter(|e| alike(&e.file_name()));
    found.next().map_or_else(|| path.clone(), |e| e.path())
}

/// Files that call each other endlessly stop here.
const MAX_CALLS: usize = 16;

fn read_called(path: &Path, depth: usize) -> Result<Script, Error> {
    let file = disk::text(&path);
    let source = Source::from_bytes(Some(&file), &load(path)?);
    let mut script = of_source(&source)?;
    script.path = Some(path.to_owned());
    let mut steps = Vec::with_capacity(script.steps.len());
    for step in std::mem::take(&mut script.steps) {
        let Command::File {
            command: Some(called),
            ..
        } = &step.command
        else {
            steps.push(step);
            continue;
        };
        if depth == MAX_CALLS {
            let mut d =
                Diagnostic::error("endless_calls", "command files call each other too deeply");
            (d.file, d.line, d.column) = (Some(file), step.line, 1);
            return Err(Error::from(d));
        }
        let called = path.parent().unwrap_or(Path::new("")).join(called);
        let inner = read_called(&called, depth + 1)?;
        script.model = script.model.or(inner.model);
        script.output = script.output.or(inner.output);
        script.diagnostics.extend(inner.diagnostics);
        steps.extend(inner.steps);
    }
    script.steps = steps;
    Ok(script)
}

fn of_source(source: &Source) -> Result<Script, Error> {
    let mut script = Script::default();
    let mut body = source.clone();
    if let Some(spans) = prompt_answers(source) {
        let answer = |k: usize| -> Option<String> {
            let text = source.slice(*spans.get(k)?).trim();
            let text = text.trim_start_matches('\u{FEFF}').trim_start();
            (!text.is_empty() && !text.starts_with('!')).then(|| text.to_owned())
        };
        (script.model, script.output) = (answer(0), answer(1));
        script.output_line = if script.output.is_some() { 2 } else { 0 };
        script.answered = script.model.is_some();
        // no answer to the second prompt: results are named like the dataset
        let blank = spans
            .get(1)
            .is_some_and(|s| source.slice(*s).trim().is_empty());
        if blank && let Some(model) = &script.model {
            let name = last_component(model);
            let ending = name.len().saturating_sub(4);
            let has_ending = (name.get(ending..)).is_some_and(|e| e.eq_ignore_ascii_case(".adm"));
            let stem = name.get(..ending).filter(|_| has_ending).unwrap_or(name);
            script.output = Some(stem.to_owned());
        }
        // The answers are no commands: blanked, so that all places stay.
        for span in spans {
            body.text
                .replace_range(span.start..span.end, &" ".repeat(span.end - span.start));
        }
    }
    let mut out = Vec::new();
    if let Some(end) = end_of_stop(&body.text) {
        let after = Span::new(end, body.text.len());
        out.extend(doubts::after_stop(&body, after));
        body.text.truncate(end);
    }
    let syntax = syntax::script(&body, &mut out);
    take_steps(&body, &syntax, &mut script, &mut out);
    finish(script, out)
}

/// Returns where a line that says STOP ends: what follows are notes and whatever else, which need
/// not be commands.
fn end_of_stop(text: &str) -> Option<usize> {
    let (mut at, mut continued) = (0, false);
    for line in text.split_inclusive('\n') {
        at += line.len();
        let command = line.split('!').next().unwrap_or_default().trim();
        if command.eq_ignore_ascii_case("STOP") && !continued {
            return Some(at);
        }
        continued = command.ends_with('&');
    }
    None
}

fn finish(mut script: Script, mut out: Vec<Diagnostic>) -> Result<Script, Error> {
    out.arrange_by_key(|d| (d.line, d.column));
    if out.iter().any(|d| d.severity == Severity::Error) {
        out.retain(|d| d.severity == Severity::Error);
        return Err(out.into());
    }
    script.diagnostics.extend(out);
    Ok(script)
}

fn take_steps(source: &Source, syntax: &Syntax, script: &mut Script, out: &mut Vec<Diagnostic>) {
    let mut without_effect = Idle::default();
    for item in &syntax.items {
        let Item::Statement(tokens) = item else {
            continue;
        };
        let record = read::record(source, tokens, table(), out);
        let Some(record) = record.filter(|r| !r.mistaken) else {
            continue;
        };
        let (line, span) = (record.place.line, record.head);
        without_effect.add(&record);
        let others = unread::words(&record);
        let command = match interpret(record) {
            Ok(command) => command,
            Err(d) => {
                out.push(source.locate(*d, span));
                continue;
            }
        };
        let doubt = unread::arguments(&command, &others);
        out.extend(doubt.map(|d| source.locate(d, span)));
        let doubted = doubts::of_settings(&command).into_iter();
        out.extend(doubted.map(|d| source.locate(d, span)));
        if let Command::File {
            model,
            output_prefix,
            command: None,
        } = &command
            && script.steps.is_empty()
        {
            script.answered &= model.is_none();
            script.model = model.clone().or(script.model.take());
            if output_prefix.is_some() {
                script.output_line = line;
            }
            script.output = output_prefix.clone().or(script.output.take());
            continue;
        }
        let written = source
            .slice(tokens.span)
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        script.steps.push(Step {
            command,
            text: written,
            line,
        });
    }
    out.extend(without_effect.told(source));
}

/// The first two lines, where they answer the old prompts instead of being commands.
fn prompt_answers(source: &Source) -> Option<Vec<Span>> {
    let lines = syntax::headings(source);
    let is_command = |span: &Span| {
        let line = source.slice(*span).trim().trim_start_matches('\u{FEFF}');
        let word = line
            .split(['/', ' ', '\t', ',', '!'])
            .next()
            .unwrap_or_default();
        let rest = line.get(word.len()..).unwrap_or_default().trim_start();
        let slash = rest.starts_with('/') && matches!(find(word), Meaning::One(_));
        slash || rest.is_empty() && word.eq_ignore_ascii_case("STOP")
    };
    let first = source.slice(*lines.first()?).trim();
    let first = first.trim_start_matches('\u{FEFF}');
    if first.is_empty() || first.starts_with('!') || is_command(&lines[0]) {
        return None;
    }
    let second_is_command = lines.get(1).is_some_and(is_command);
    Some(if second_is_command {
        vec![lines[0]]
    } else {
        lines
    })
}
