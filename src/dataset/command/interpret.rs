//! One command: the table of commands with their arguments, and what each means.

use super::*;

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
pub(super) static COMMANDS: &[&dyn Statement] = commands! {
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

/// The arguments of a record by keyword.
struct Arguments(Vec<(String, Value)>);

impl Arguments {
    fn of(record: &Record) -> Self {
        let names = record.row.arguments();
        let named = |g: &super::super::row::Given| (names[g.argument].keyword(), g.value.clone());
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

pub(super) fn interpret(record: Record) -> Result<Command, Box<Diagnostic>> {
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
    let kind = match super::super::statement::find(word) {
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
