//! Command files (`.acf`): a sequence of typed commands, each with its place; and the same from a message log.
//!
//! A command that names a statement of the dataset changes that element through the same table of statements; the few
//! that control the run have a table of their own here. Both beginnings of a file are understood: `FILE/MODEL=…`, and
//! the answers to the old prompts (dataset, output name) on the first two lines.

use super::read::{self, Table};
use super::row::{Argument, Meaning, Problem, Record, Statement, meaning, near_ids};
use super::statement::STATEMENTS;
use super::syntax::{self, Item, Source, Syntax};
use super::value::{Kind, Value};
use super::{Errors, enter, load};
use crate::diagnostic::{Diagnostic, Severity, Span};
use crate::model::{ElementKind, Model};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// What SIMULATE runs.
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
    /// the dataset was named by the first line, as an answer to the old prompt, and not by FILE/MODEL
    pub answered: bool,
    /// base name of the results, where one is given
    pub output: Option<String>,
    /// the commands, in order; FILE at the beginning is not among them
    pub steps: Vec<Step>,
    /// warnings and notes
    pub diagnostics: Vec<Diagnostic>,
}

/// A command that is no statement: its arguments are picked out by [`interpret`].
struct CommandRow {
    keyword: &'static str,
    arguments: &'static [Argument],
    open: bool,
}

impl Statement for CommandRow {
    fn keyword(&self) -> &'static str {
        self.keyword
    }
    fn open(&self) -> bool {
        self.open
    }
    fn arguments(&self) -> Vec<Argument> {
        self.arguments.to_vec()
    }
    fn enter(&self, _: &mut Model, _: &Record, _: bool) -> Vec<Problem> {
        Vec::new()
    }
    fn records(&self, _: &Model) -> Vec<Record> {
        Vec::new()
    }
}

const fn flag(name: &'static str, group: Option<&'static str>) -> Argument {
    Argument {
        group,
        ..Argument::new(name, Kind::Flag)
    }
}
const fn real(name: &'static str) -> Argument {
    Argument::new(name, Kind::Real { angle: false })
}
const fn text(name: &'static str) -> Argument {
    Argument::new(name, Kind::Text)
}
const fn whole(name: &'static str) -> Argument {
    Argument::new(name, Kind::Id)
}
const fn ids(name: &'static str, min: usize, max: usize) -> Argument {
    Argument::new(name, Kind::Ids { min, max })
}

macro_rules! commands {
    ($($keyword:literal $open:literal { $($argument:expr),* $(,)? })+) => {
        &[$(&CommandRow { keyword: $keyword, arguments: &[$($argument),*], open: $open }),+]
    };
}

/// Commands that control the run. `true`: other arguments are let pass.
static COMMANDS: &[&dyn Statement] = commands! {
    "SIMULATE" false {
        flag("KINEMATICS", Some("kind")), flag("DYNAMICS", Some("kind")), flag("STATICS", Some("kind")),
        flag("TRANSIENT", Some("kind")), flag("INITIAL_CONDITIONS|IC", Some("kind")),
        real("END"), real("DURATION"), whole("STEPS"), real("DTOUT"),
    }
    "FILE" false { text("MODEL"), text("OUTPUT_PREFIX"), text("COMMAND") }
    "ACTIVATE" true { ids("ID", 1, usize::MAX), ids("RANGE", 2, 2) }
    "DEACTIVATE" true { ids("ID", 1, usize::MAX), ids("RANGE", 2, 2) }
    "LINEAR" true {
        flag("EIGENSOL", Some("task")), flag("STATEMAT", Some("task")), flag("NODAMPING", None),
        ids("COORDS", 1, 2), whole("RM"), text("FILE"), Argument::new("FORMAT", Kind::Word(&[])),
        whole("PINPUT"), whole("POUTPUT"),
    }
    "SAVE" true { text("SYSTEM") }
    "RELOAD" true { text("SYSTEM") }
    "INFO" true {}
    "SHOW" true {}
    "TIME" true {}
    "HELP" true {}
    "MENU" true {}
    "STOP" true {}
};

/// The two tables one after the other: commands, then statements.
static ROWS: LazyLock<Vec<&'static dyn Statement>> =
    LazyLock::new(|| COMMANDS.iter().chain(STATEMENTS).copied().collect());

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
    pub fn read(path: impl AsRef<Path>) -> Result<Script, Errors> {
        read_called(path.as_ref(), 0)
    }

    /// Reads commands from a text.
    ///
    /// # Errors
    /// As [`Script::read`].
    pub fn from_text(text: &str) -> Result<Script, Errors> {
        of_source(&Source::from_text(None, text))
    }

    /// Reads the commands that a message log (`.msg`) echoes.
    ///
    /// Simulations that were run without a command, as co-simulation does, become SIMULATE commands up to the last time
    /// their table shows.
    ///
    /// # Errors
    /// As [`Script::read`].
    pub fn from_message_log(path: impl AsRef<Path>) -> Result<Script, Errors> {
        let path = path.as_ref();
        let file = path.display().to_string();
        let log = Source::from_bytes(Some(&file), &load(path)?);
        let mut script = of_message_log(&log)?;
        script.path = Some(path.to_owned());
        Ok(script)
    }

    /// The same from the text of a log.
    ///
    /// # Errors
    /// As [`Script::read`].
    pub fn from_message_log_text(text: &str) -> Result<Script, Errors> {
        of_message_log(&Source::from_text(None, text))
    }

    /// The dataset that the file names, beside the command file, with the ending `.adm` where none is given; a file whose name differs in
    /// small and capital letters alone is taken where there is no other, as the systems do on which such files are written.
    pub fn model_file(&self) -> Option<PathBuf> {
        let name = self.model.as_deref()?;
        let mut name = PathBuf::from(name);
        if !name
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("adm"))
        {
            let mut with_ending = name.into_os_string();
            with_ending.push(".adm");
            name = PathBuf::from(with_ending);
        }
        let folder = self.path.as_deref().and_then(Path::parent);
        Some(existing(folder.map_or(name.clone(), |f| f.join(name))))
    }
}

/// The file, or the one beside it whose name has other capital letters.
fn existing(path: PathBuf) -> PathBuf {
    if path.exists() {
        return path;
    }
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let alike = |other: &std::ffi::OsStr| {
        (path.file_name()).is_some_and(|name| name.eq_ignore_ascii_case(other))
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found = entries.filter(|e| alike(&e.file_name()));
    found.next().map_or_else(|| path.clone(), |e| e.path())
}

/// Files that call each other endlessly stop here.
const MAX_CALLS: usize = 16;

fn read_called(path: &Path, depth: usize) -> Result<Script, Errors> {
    let file = path.display().to_string();
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
            return Err(Errors(vec![d]));
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

fn of_source(source: &Source) -> Result<Script, Errors> {
    let mut script = Script::default();
    let mut body = source.clone();
    if let Some(spans) = prompt_answers(source) {
        let answer = |k: usize| -> Option<String> {
            let text = source.slice(*spans.get(k)?).trim();
            let text = text.trim_start_matches('\u{FEFF}').trim_start();
            (!text.is_empty() && !text.starts_with('!')).then(|| text.to_owned())
        };
        (script.model, script.output) = (answer(0), answer(1));
        script.answered = script.model.is_some();
        // The answers are no commands: blanked, so that all places stay.
        for span in spans {
            body.text
                .replace_range(span.start..span.end, &" ".repeat(span.end - span.start));
        }
    }
    let mut out = Vec::new();
    let syntax = syntax::script(&body, &mut out);
    take_steps(&body, &syntax, &mut script, &mut out);
    finish(script, out)
}

fn finish(mut script: Script, mut out: Vec<Diagnostic>) -> Result<Script, Errors> {
    out.sort_by_key(|d| (d.line, d.column));
    if out.iter().any(|d| d.severity == Severity::Error) {
        out.retain(|d| d.severity == Severity::Error);
        return Err(Errors(out));
    }
    script.diagnostics.extend(out);
    Ok(script)
}

fn take_steps(source: &Source, syntax: &Syntax, script: &mut Script, out: &mut Vec<Diagnostic>) {
    for item in &syntax.items {
        let Item::Statement(tokens) = item else {
            continue;
        };
        let record = read::record(source, tokens, table(), out);
        let Some(record) = record.filter(|r| !r.mistaken) else {
            continue;
        };
        let (line, span) = (record.place.line, record.head);
        let command = match interpret(record) {
            Ok(command) => command,
            Err(d) => {
                out.push(source.locate(*d, span));
                continue;
            }
        };
        if let Command::File {
            model,
            output_prefix,
            command: None,
        } = &command
            && script.steps.is_empty()
        {
            script.answered &= model.is_none();
            script.model = model.clone().or(script.model.take());
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

// ---------------------------------------------------------------------------------------------------- one command

/// The arguments of a record by keyword.
struct Arguments(Vec<(String, Value)>);

impl Arguments {
    fn of(record: &Record) -> Self {
        let names = record.row.arguments();
        let named = |g: &super::row::Given| (names[g.argument].keyword(), g.value.clone());
        Self(record.given.iter().map(named).collect())
    }
    fn get(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|(n, _)| n == name).map(|(_, v)| v)
    }
    fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }
    fn real(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Real(x) => Some(x.value()),
            _ => None,
        }
    }
    fn whole(&self, name: &str) -> Option<u32> {
        match self.get(name)? {
            Value::Id(n) => Some(*n),
            _ => None,
        }
    }
    fn ids(&self, name: &str) -> Vec<u32> {
        match self.get(name) {
            Some(Value::Ids(all)) => all.clone(),
            _ => Vec::new(),
        }
    }
    fn text(&self, name: &str) -> Option<String> {
        self.get(name).map(Value::to_string)
    }
}

fn interpret(record: Record) -> Result<Command, Box<Diagnostic>> {
    let a = Arguments::of(&record);
    Ok(match record.row.keyword() {
        "SIMULATE" => Command::Simulate(simulate(&a)?),
        "FILE" => Command::File {
            model: a.text("MODEL"),
            output_prefix: a.text("OUTPUT_PREFIX"),
            command: a.text("COMMAND"),
        },
        "ACTIVATE" => activate(&record, &a, true)?,
        "DEACTIVATE" => activate(&record, &a, false)?,
        "LINEAR" => Command::Linear(Linear {
            eigensolution: a.has("EIGENSOL"),
            state_matrices: a.has("STATEMAT"),
            no_damping: a.has("NODAMPING"),
            coords: a.ids("COORDS"),
            rm: a.whole("RM"),
            file: a.text("FILE"),
            format: a.text("FORMAT"),
            pinput: a.whole("PINPUT"),
            poutput: a.whole("POUTPUT"),
        }),
        "SAVE" => Command::Save(a.text("SYSTEM")),
        "RELOAD" => Command::Reload(a.text("SYSTEM")),
        "STOP" => Command::Stop,
        "INFO" | "SHOW" | "TIME" | "HELP" | "MENU" | "LIST" | "NOLIST" => {
            Command::Show(record.element())
        }
        _ => Command::Change(record),
    })
}

fn simulate(a: &Arguments) -> Result<Simulate, Box<Diagnostic>> {
    let kinds = [
        ("KINEMATICS", SimulationKind::Kinematic),
        ("DYNAMICS", SimulationKind::Dynamic),
        ("STATICS", SimulationKind::Static),
        ("TRANSIENT", SimulationKind::Transient),
        ("INITIAL_CONDITIONS", SimulationKind::InitialConditions),
    ];
    let refuse = |code, message: &str| {
        Err(Box::new(
            Diagnostic::error(code, message).element("SIMULATE"),
        ))
    };
    let Some((_, kind)) = kinds.into_iter().find(|(word, _)| a.has(word)) else {
        return refuse(
            "missing_argument",
            "SIMULATE does not say what: KINEMATIC, DYNAMIC, STATIC, TRANSIENT or INITIAL_CONDITIONS",
        );
    };
    let s = Simulate {
        kind,
        end: a.real("END"),
        duration: a.real("DURATION"),
        steps: a.whole("STEPS"),
        dtout: a.real("DTOUT"),
    };
    let timed = matches!(
        kind,
        SimulationKind::Kinematic | SimulationKind::Dynamic | SimulationKind::Transient
    );
    if s.end.is_some() && s.duration.is_some() {
        return refuse("excluded_argument", "END and DURATION exclude each other");
    }
    if s.steps.is_some() && s.dtout.is_some() {
        return refuse("excluded_argument", "STEPS and DTOUT exclude each other");
    }
    if timed && s.end.is_none() && s.duration.is_none() {
        return refuse(
            "missing_argument",
            "SIMULATE needs END = time, or DURATION = time",
        );
    }
    if s.steps == Some(0)
        || s.dtout.is_some_and(|h| h <= 0.0)
        || s.duration.is_some_and(|t| t <= 0.0)
    {
        return refuse("unfit_value", "STEPS, DTOUT and DURATION must be positive");
    }
    Ok(s)
}

fn activate(record: &Record, a: &Arguments, on: bool) -> Result<Command, Box<Diagnostic>> {
    let refuse = |code, message: String| {
        Err(Box::new(
            Diagnostic::error(code, message).element(record.element()),
        ))
    };
    let word = record
        .kept
        .iter()
        .find(|(_, value)| value.is_empty())
        .map(|(word, _)| word.as_str());
    let Some(word) = word else {
        return refuse(
            "missing_argument",
            "no kind of element is named, as in DEACTIVATE/JOINT, ID=3".into(),
        );
    };
    let kind = match super::statement::find(word) {
        Meaning::One(k) => STATEMENTS[k].kind(),
        Meaning::Several(_) | Meaning::Unknown => None,
    };
    let Some(kind) = kind else {
        let message = format!("`{word}` is not a kind of element");
        return refuse("unknown_statement", message);
    };
    let range = <[u32; 2]>::try_from(a.ids("RANGE")).ok();
    let ids = a.ids("ID");
    if ids.is_empty() && range.is_none() {
        return refuse(
            "missing_argument",
            "ID = numbers or RANGE = first, last is needed".into(),
        );
    }
    Ok(Command::Activate {
        on,
        kind,
        ids,
        range,
    })
}

// ------------------------------------------------------------------------------------------------ effect on a model

impl Model {
    /// Does to the model what a command says: changes an element or settings, switches elements on or off.
    ///
    /// Commands that control the run (SIMULATE, STOP …) leave the model as it is.
    ///
    /// # Errors
    /// An element that does not exist, or values that do not fit; the model is then unchanged.
    ///
    /// # Examples
    /// ```
    /// use cognate::{dataset::command::Script, model::Model};
    /// let mut model = Model::from_text("t\nPART/1, GROUND\nVARIABLE/5, FUNCTION=0\nEND\n")?;
    /// for step in Script::from_text("\nVAR/5, FUN=TIME**2\n")?.steps {
    ///     model.apply(&step.command)?;
    /// }
    /// assert!(format!("{:?}", model.variables[&5].function).contains("TIME**2"));
    /// # Ok::<(), cognate::dataset::Errors>(())
    /// ```
    pub fn apply(&mut self, command: &Command) -> Result<(), Errors> {
        match command {
            Command::Change(record) => self.change(record),
            Command::Activate {
                on,
                kind,
                ids,
                range,
            } => self.activate(*on, *kind, ids, *range),
            Command::File { .. }
            | Command::Simulate(_)
            | Command::Linear(_)
            | Command::Save(_)
            | Command::Reload(_)
            | Command::Show(_)
            | Command::Stop => Ok(()),
        }
    }

    fn change(&mut self, record: &Record) -> Result<(), Errors> {
        let arguments = record.row.arguments();
        let mut record = record.clone();
        // LIST asks for a print, DEFAULT for the documented values; neither is a setting.
        let word = |g: &super::row::Given| arguments[g.argument].keyword();
        let reset = !record.row.numbered() && record.given.iter().any(|g| word(g) == "DEFAULT");
        if !record.row.numbered() {
            record
                .given
                .retain(|g| !matches!(word(g).as_str(), "LIST" | "DEFAULT"));
        }
        let before = reset.then(|| self.clone());
        if reset {
            record.row.reset(self);
        }
        let mut out = Vec::new();
        enter(&Source::default(), self, &record, true, &mut out);
        if out.is_empty() {
            return Ok(());
        }
        if let Some(before) = before {
            *self = before;
        }
        for d in &mut out {
            (d.span, d.line, d.column) =
                (None, record.place.line, usize::from(record.place.line > 0));
        }
        Err(Errors(out))
    }

    fn activate(
        &mut self,
        on: bool,
        kind: ElementKind,
        ids: &[u32],
        range: Option<[u32; 2]>,
    ) -> Result<(), Errors> {
        let known = self.numbers(kind);
        let missing = |id: &&u32| !known.contains(id);
        let mut out = Vec::new();
        for &id in ids.iter().filter(missing) {
            let message = format!("{} does not exist", kind.id(id));
            let mut d = Diagnostic::error("unknown_element", message);
            d.help.extend(near_ids(id, known.iter().copied()));
            out.push(d);
        }
        if !out.is_empty() {
            return Err(Errors(out));
        }
        let in_range = |id: &u32| range.is_some_and(|[a, b]| (a..=b).contains(id));
        let of_range = known.iter().copied().filter(in_range);
        for id in ids.iter().copied().chain(of_range) {
            let key = kind.id(id);
            if on {
                self.inactive.remove(&key);
            } else {
                self.inactive.insert(key);
            }
        }
        Ok(())
    }
}

// ----------------------------------------------------------------------------------------------------- message logs

/// What a line of a log begins or shows.
enum Note {
    Begin,
    /// the table of steps shows this time
    Time(f64),
    Kind(SimulationKind),
    End,
}

fn of_message_log(log: &Source) -> Result<Script, Errors> {
    // Commands stay where they are, everything else is blanked: all places stay.
    let mut text = String::with_capacity(log.text.len());
    let mut notes = Vec::new();
    for (k, line) in log.text.split_inclusive('\n').enumerate() {
        let bare = line.trim_end_matches(['\n', '\r']);
        let command = bare.trim_start().strip_prefix("command:");
        let nested = |c: &str| {
            c.trim_start()
                .get(..5)
                .is_some_and(|s| s.eq_ignore_ascii_case("FILE/"))
        };
        match command.filter(|c| !nested(c)) {
            Some(command) => {
                text.push_str(&" ".repeat(bare.len() - command.len()));
                text.push_str(command);
            }
            None => {
                text.push_str(&" ".repeat(bare.len()));
                notes.extend(note(bare).map(|n| (k + 1, n)));
            }
        }
        text.push_str(&line[bare.len()..]);
    }
    let body = Source::from_text(log.file.as_deref(), text);
    let mut script = Script::default();
    let mut out = Vec::new();
    let syntax = syntax::script(&body, &mut out);
    take_steps(&body, &syntax, &mut script, &mut out);
    script.steps = merged(std::mem::take(&mut script.steps), simulations(&notes));
    finish(script, out)
}

/// Commands and simulations by line; the first simulation after a SIMULATE command is what that command asked for.
fn merged(commands: Vec<Step>, simulations: Vec<(usize, Simulate)>) -> Vec<Step> {
    let mut all: Vec<Step> = Vec::with_capacity(commands.len() + simulations.len());
    let mut commands = commands.into_iter().peekable();
    let mut asked = false;
    for (line, simulate) in simulations {
        while let Some(step) = commands.next_if(|s| s.line < line) {
            asked |= matches!(&step.command, Command::Simulate(s) if s.kind == simulate.kind);
            all.push(step);
        }
        if !std::mem::take(&mut asked) {
            let command = Command::Simulate(simulate);
            all.push(Step {
                command,
                text: String::new(),
                line,
            });
        }
    }
    all.extend(commands);
    all
}

fn note(line: &str) -> Option<Note> {
    let line = line.trim();
    if line == "Begin Simulation" {
        return Some(Note::Begin);
    }
    if line == "End Simulation" {
        return Some(Note::End);
    }
    if let Some(what) = line.strip_prefix("****** Performing ") {
        let kinds = [
            ("Dynamic", SimulationKind::Dynamic),
            ("Kinematic", SimulationKind::Kinematic),
            ("Quasi", SimulationKind::Static),
            ("Static", SimulationKind::Static),
        ];
        return kinds
            .into_iter()
            .find(|(w, _)| what.starts_with(w))
            .map(|(_, k)| Note::Kind(k));
    }
    // time, step, evaluations, steps, order, CPU time (which may be 3:09)
    let words: Vec<&str> = line.split_whitespace().collect();
    let numbers: Option<Vec<f64>> = words.iter().take(5).map(|w| w.parse().ok()).collect();
    numbers
        .filter(|n| n.len() == 5 && words.len() == 6)
        .map(|n| Note::Time(n[0]))
}

/// The simulations a log shows: the line they begin in and what they ran.
fn simulations(notes: &[(usize, Note)]) -> Vec<(usize, Simulate)> {
    let mut all = Vec::new();
    let mut begun = None;
    let (mut kind, mut first, mut last) = (SimulationKind::Dynamic, None, None);
    for (line, note) in notes {
        match note {
            Note::Begin => {
                begun = Some(*line);
                (kind, first, last) = (SimulationKind::Dynamic, None, None);
            }
            Note::Kind(k) => kind = *k,
            Note::Time(t) => {
                first = first.or(Some(*t));
                last = Some(*t);
            }
            Note::End => {
                let moved = first.zip(last).is_some_and(|(a, b): (f64, f64)| b > a);
                if let (Some(line), true) = (begun.take(), moved) {
                    let simulate = Simulate {
                        kind,
                        end: last,
                        duration: None,
                        steps: Some(1),
                        dtout: None,
                    };
                    all.push((line, simulate));
                }
            }
        }
    }
    all
}
