//! One command: the table of commands, each with its arguments as fields, and what it means.

use super::*;
use crate::dataset::row::{Binding, filled};
use crate::dataset::value::Field;

/// Makes a command of what its arguments have filled.
type Meant<T> = fn(T, &Record) -> Result<Command, Box<Diagnostic>>;

/// A row of the table of commands: read like a statement, and made a command.
pub(super) trait Interpret: Statement {
    /// Makes a command of a record of this row.
    ///
    /// # Errors
    /// Arguments that do not fit each other.
    fn interpret(&self, record: &Record) -> Result<Command, Box<Diagnostic>>;
}

/// The treatment of arguments that no row describes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Others {
    Refused,
    /// they are let pass, which is said
    Dropped,
    /// they have a meaning: the kind of element
    Read,
}

/// A command that is no statement: its arguments fill a `T`, of which it is made.
struct CommandRow<T: 'static> {
    keyword: &'static str,
    bindings: &'static [Binding<T>],
    others: Others,
    /// it asks for a print, and changes nothing
    prints: bool,
    meant: Meant<T>,
}

impl<T: Default> Statement for CommandRow<T> {
    fn keyword(&self) -> &'static str {
        self.keyword
    }
    fn open(&self) -> bool {
        self.others != Others::Refused
    }
    fn reads_others(&self) -> bool {
        self.others == Others::Read
    }
    fn is_idle(&self) -> bool {
        self.prints
    }
    fn argument(&self, k: usize) -> Option<&'static Argument> {
        self.bindings.get(k).map(|b| &b.argument)
    }
    fn enter(&self, _: &mut Model, _: &Record, _: bool) -> Vec<Problem> {
        Vec::new()
    }
    fn records(&self, _: &Model) -> Vec<Record> {
        Vec::new()
    }
}

impl<T: Default> Interpret for CommandRow<T> {
    fn interpret(&self, record: &Record) -> Result<Command, Box<Diagnostic>> {
        (self.meant)(filled(self.bindings, record), record)
    }
}

/// The numbers that ACTIVATE and DEACTIVATE name.
#[derive(Default)]
struct Named {
    ids: Vec<u32>,
    range: Vec<u32>,
}

/// The arguments of FILE.
#[derive(Default)]
struct Files {
    model: Option<String>,
    output_prefix: Option<String>,
    command: Option<String>,
}

/// The arguments of SIMULATE.
#[derive(Default)]
struct Simulation {
    kind: Option<SimulationKind>,
    end: Option<f64>,
    duration: Option<f64>,
    steps: Option<u32>,
    dtout: Option<f64>,
}

/// Writes a row of the table: keyword, what it fills, whether other arguments are let pass, its
/// arguments with what they accept and the field that each fills, and what it means.
macro_rules! command {
    ($keyword:literal, $t:ty, others: $others:ident, { $($how:ident $name:literal ($($rest:tt)*) $(.$modifier:ident())*;)* }, $meant:expr) => {
        &CommandRow::<$t> {
            keyword: $keyword,
            bindings: &[$($how!($t, $name, $($rest)*)$(.$modifier())*),*],
            others: Others::$others,
            prints: false,
            meant: $meant,
        }
    };
}
macro_rules! argument {
    ($t:ty, $name:literal, $kind:expr, $field:ident) => {
        Binding::<$t> {
            argument: Argument::new($name, $kind),
            put: |filled, _, value| filled.$field.put(value),
            get: |_, _| Vec::new(),
        }
    };
}
macro_rules! text {
    ($t:ty, $name:literal, $kind:expr, $field:ident) => {
        Binding::<$t> {
            argument: Argument::new($name, $kind),
            put: |filled, _, value| {
                filled.$field = Some(value.to_string());
                Ok(())
            },
            get: |_, _| Vec::new(),
        }
    };
}
macro_rules! one_of {
    ($t:ty, $name:literal, $group:literal, $field:ident = $value:expr) => {
        Binding::<$t> {
            argument: Argument {
                group: Some($group),
                ..Argument::new($name, Kind::Flag)
            },
            put: |filled, _, _| {
                filled.$field = $value;
                Ok(())
            },
            get: |_, _| Vec::new(),
        }
    };
}
macro_rules! system {
    ($t:ty, $name:literal,) => {
        Binding::<$t> {
            argument: Argument::new($name, Kind::Text),
            put: |file, _, value| {
                *file = Some(value.to_string());
                Ok(())
            },
            get: |_, _| Vec::new(),
        }
    };
}
/// Writes the row of a command that asks for a print, whatever its arguments are.
macro_rules! print {
    ($keyword:literal) => {
        &CommandRow::<()> {
            keyword: $keyword,
            bindings: &[],
            others: Others::Dropped,
            prints: true,
            meant: show,
        }
    };
}
const REAL: Kind = Kind::Real { angle: false };

/// Commands that control the run.
#[rustfmt::skip]
pub(super) static COMMANDS: &[&dyn Interpret] = &[
    command!("SIMULATE", Simulation, others: Refused, {
        one_of "KINEMATICS" ("kind", kind = Some(SimulationKind::Kinematic));
        one_of "DYNAMICS" ("kind", kind = Some(SimulationKind::Dynamic));
        one_of "STATICS" ("kind", kind = Some(SimulationKind::Static));
        one_of "TRANSIENT" ("kind", kind = Some(SimulationKind::Transient));
        one_of "INITIAL_CONDITIONS|IC" ("kind", kind = Some(SimulationKind::InitialConditions));
        argument "END" (REAL, end);
        argument "DURATION" (REAL, duration).positive();
        argument "STEPS" (Kind::Id, steps).positive();
        argument "DTOUT" (REAL, dtout).positive();
    }, |given, _| simulate(&given).map(Command::Simulate)),
    command!("FILE", Files, others: Refused, {
        text "MODEL" (Kind::Text, model);
        text "OUTPUT_PREFIX" (Kind::Text, output_prefix);
        text "COMMAND" (Kind::Text, command);
    }, |Files { model, output_prefix, command }, _| Ok(Command::File { model, output_prefix, command })),
    command!("ACTIVATE", Named, others: Read, {
        argument "ID" (Kind::Ids { min: 1, max: usize::MAX }, ids);
        argument "RANGE" (Kind::Ids { min: 2, max: 2 }, range);
    }, |named, record| activate(record, named, true)),
    command!("DEACTIVATE", Named, others: Read, {
        argument "ID" (Kind::Ids { min: 1, max: usize::MAX }, ids);
        argument "RANGE" (Kind::Ids { min: 2, max: 2 }, range);
    }, |named, record| activate(record, named, false)),
    command!("LINEAR", Linear, others: Dropped, {
        one_of "EIGENSOL" ("task", eigensolution = true);
        one_of "STATEMAT" ("task", state_matrices = true);
        argument "NODAMPING" (Kind::Flag, no_damping);
        argument "COORDS" (Kind::Ids { min: 1, max: 2 }, coords);
        argument "RM" (Kind::Id, rm).idle();
        text "FILE" (Kind::Text, file);
        text "FORMAT" (Kind::Word(&[]), format).idle();
        argument "PINPUT" (Kind::Id, pinput);
        argument "POUTPUT" (Kind::Id, poutput);
    }, linear),
    command!("SAVE", Option<String>, others: Dropped, { system "SYSTEM" (); }, |system, record| named(system, record).map(Command::Save)),
    command!("RELOAD", Option<String>, others: Dropped, { system "SYSTEM" (); }, |system, record| named(system, record).map(Command::Reload)),
    print!("INFO"),
    print!("SHOW"),
    print!("TIME"),
    print!("HELP"),
    print!("MENU"),
    command!("STOP", (), others: Dropped, {}, |(), _| Ok(Command::Stop)),
];

/// The file of SAVE or RELOAD, without which there is nothing to do.
fn named(system: Option<String>, record: &Record) -> Result<Option<String>, Box<Diagnostic>> {
    let bare = |s: &String| !s.trim_matches(['"', ' ']).is_empty();
    let is_named = system.as_ref().is_some_and(bare);
    let missing = || Diagnostic::error("missing_argument", "SYSTEM = file is needed");
    match is_named {
        true => Ok(system),
        false => Err(Box::new(missing().element(record.element()))),
    }
}

/// A command that asks for a print.
fn show((): (), record: &Record) -> Result<Command, Box<Diagnostic>> {
    Ok(Command::Show(record.element()))
}

/// Returns the command that a record is: one that controls the run, or a change of the model.
pub(super) fn interpret(record: Record) -> Result<Command, Box<Diagnostic>> {
    let prints = [SettingsStatement::List, SettingsStatement::Nolist];
    let keyword = record.row.keyword();
    match COMMANDS.iter().find(|c| c.keyword() == keyword) {
        Some(command) => command.interpret(&record),
        None if prints.into_iter().any(|s| record.row.settings() == Some(s)) => show((), &record),
        None => Ok(Command::Change(record)),
    }
}

fn simulate(given: &Simulation) -> Result<Simulate, Box<Diagnostic>> {
    let refuse = |code, message: &str| {
        Err(Box::new(
            Diagnostic::error(code, message).element("SIMULATE"),
        ))
    };
    let Some(kind) = given.kind else {
        return refuse(
            "missing_argument",
            "SIMULATE does not say what: KINEMATIC, DYNAMIC, STATIC, TRANSIENT or INITIAL_CONDITIONS",
        );
    };
    let s = Simulate {
        kind,
        end: given.end,
        duration: given.duration,
        steps: given.steps,
        dtout: given.dtout,
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
    Ok(s)
}

/// Returns LINEAR, whose modes are counted from 1, the first before the last.
fn linear(given: Linear, record: &Record) -> Result<Command, Box<Diagnostic>> {
    let what = match given.coords[..] {
        [0, ..] => "COORDS counts modes from 1".to_owned(),
        [first, last] if last < first => from_last("COORDS", first, last),
        _ => return Ok(Command::Linear(given)),
    };
    let refused = Diagnostic::error("unfit_value", what);
    Err(Box::new(refused.element(record.element())))
}

/// Says that of two numbers that go from the first to the last the last comes first.
fn from_last(argument: &str, first: u32, last: u32) -> String {
    format!("{argument} = {first}, {last} has nothing between its first and its last number")
}

fn activate(record: &Record, named: Named, on: bool) -> Result<Command, Box<Diagnostic>> {
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
    let kind = match super::super::statement::find(word) {
        Meaning::One(k) => STATEMENTS[k].kind(),
        Meaning::Several(_) | Meaning::Unknown => None,
    };
    let Some(kind) = kind else {
        let message = format!("`{word}` is not a kind of element");
        return refuse("unknown_statement", message);
    };
    let range = <[u32; 2]>::try_from(named.range).ok();
    let ids = named.ids;
    if ids.is_empty() && range.is_none() {
        return refuse(
            "missing_argument",
            "ID = numbers or RANGE = first, last is needed".into(),
        );
    }
    if let Some([first, last]) = range.filter(|[first, last]| last < first) {
        return refuse("unfit_value", from_last("RANGE", first, last));
    }
    Ok(Command::Activate {
        on,
        kind,
        ids,
        range,
    })
}
