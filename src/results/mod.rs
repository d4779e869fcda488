//! Where numbers go: what a run produced, and one file per format it is written to or read from.
//!
//! A [`Run`] is a table with a story. The table has named [`Column`]s, all of one length, the first of which is time. The story
//! is the [`Record`] (status, counts, timings), the [`Sequence`]s (which rows belong to which simulation), the [`Entity`]s
//! (which columns are components of which element) and the log. Formats know this type and nothing of each other.

pub mod csv;
pub mod gra;
pub mod json;
pub mod msg;
pub mod output_folder;
pub mod res;
mod text_res;

use crate::diagnostic::Diagnostic;
use std::ops::Range;
use std::path::Path;

/// What a run produced.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// base name of the files a run writes
    pub name: String,
    /// title line of the dataset
    pub title: String,
    /// units of the model as result files spell them
    pub units: Units,
    /// all columns in the order of their identifiers in `.res` files; the first is time; all have one length
    pub columns: Vec<Column>,
    /// elements and the columns that are their components
    pub entities: Vec<Entity>,
    /// columns that tables (`.csv`, plots) show, in order; empty: all
    pub table: Vec<usize>,
    /// which rows belong to which simulation
    pub sequences: Vec<Sequence>,
    /// status, counts and timings
    pub record: Record,
    /// what happened, in order, as the `.msg` file tells it
    pub log: Vec<Event>,
}

/// One quantity over all rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    /// `time`, `PART_2_XFORM.X`, or the text of an expression
    pub name: String,
    /// `mm`, `rad/sec` …; empty: a pure number or unknown
    pub unit: String,
    /// one per row
    pub values: Vec<f64>,
}

/// An element of the model that results belong to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Entity {
    /// name of its result set, for example `PART_2_XFORM`
    pub name: String,
    /// name of the element, for example `PART_2`
    pub entity: String,
    /// `Part`, `Joint`, `Single_Component_Force`, `ADAMS_Variable`, `Request` …
    pub kind: String,
    /// number of the element in the dataset; 0 when unknown
    pub id: u64,
    /// its components, in the order shown
    pub components: Vec<Component>,
}

/// One component of an [`Entity`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Component {
    /// `X`, `PSI`, `FX`, `Q` …
    pub name: String,
    /// index in [`Run::columns`], whose unit it has
    pub column: usize,
}

/// What the rows of a sequence are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// the model as it was read, not assembled
    Input,
    /// after assembly, at the start of a simulation
    InitialConditions,
    /// an equilibrium
    Static,
    /// a row of equilibria
    QuasiStatic,
    /// moved by its motions alone
    Kinematic,
    /// integrated
    Dynamic,
}

impl Kind {
    /// Every kind with its name in `.res` files: of the data block, of its steps.
    pub const NAMES: [(Kind, &'static str, &'static str); 6] = [
        (Kind::Input, "modelInput", "input"),
        (
            Kind::InitialConditions,
            "initialConditions",
            "initialConditions",
        ),
        (Kind::Static, "static", "static"),
        (Kind::QuasiStatic, "quasiStatic", "quasiStatic"),
        (Kind::Kinematic, "kinematic", "kinematic"),
        (Kind::Dynamic, "dynamic", "dynamic"),
    ];

    /// The name of its data blocks in `.res` files, without the number.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize].1
    }
    /// The type of its steps in `.res` files.
    pub fn step(self) -> &'static str {
        Self::NAMES[self as usize].2
    }
}

/// Consecutive rows that one simulation produced.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence {
    /// `dynamic_001`
    pub name: String,
    /// what its rows are
    pub kind: Kind,
    /// which rows
    pub rows: Range<usize>,
}

/// Units of a model as result files spell them.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Units {
    pub angle: String,
    pub length: String,
    pub mass: String,
    pub time: String,
    pub force: String,
}

impl Default for Units {
    /// meter, kg, sec, newton, rad
    fn default() -> Self {
        let [angle, length, mass, time, force] =
            ["rad", "meter", "kg", "sec", "newton"].map(String::from);
        Self {
            angle,
            length,
            mass,
            time,
            force,
        }
    }
}

/// Why a run, or one simulation of it, ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Status {
    /// everything that was asked for was done
    #[default]
    Completed,
    /// the model has no consistent configuration, or contradicts itself
    Model,
    /// no equilibrium was found
    NoEquilibrium,
    /// the integration could not go on
    Stopped,
    /// a limit of time, memory or steps was reached
    Limit,
    /// the user asked to stop
    Interrupted,
}

impl Status {
    /// Its word in the run record.
    pub fn word(self) -> &'static str {
        match self {
            Status::Completed => "completed",
            Status::Model => "model_error",
            Status::NoEquilibrium => "no_equilibrium",
            Status::Stopped => "stopped",
            Status::Limit => "limit",
            Status::Interrupted => "interrupted",
        }
    }
    /// The exit code of a program that ends this way.
    pub fn exit_code(self) -> u8 {
        match self {
            Status::Completed => 0,
            Status::Model => 4,
            Status::NoEquilibrium => 5,
            Status::Stopped => 6,
            Status::Limit => 7,
            Status::Interrupted => 130,
        }
    }
}

/// What a method did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// accepted steps
    pub steps: u64,
    /// rejected steps
    pub rejected_steps: u64,
    /// evaluations of rates or residuals
    pub evaluations: u64,
    /// evaluations of the Jacobian
    pub jacobians: u64,
    /// factorizations of a matrix
    pub factorizations: u64,
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.steps += other.steps;
        self.rejected_steps += other.rejected_steps;
        self.evaluations += other.evaluations;
        self.jacobians += other.jacobians;
        self.factorizations += other.factorizations;
    }
}

/// The facts about a run that its JSON record holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// why it ended
    pub status: Status,
    /// why it ended early, as a code that `cognate explain` knows; empty: everything was done
    pub stop_code: &'static str,
    /// the same in a sentence
    pub stop_reason: String,
    /// the file that was run, as the user named it
    pub model: String,
    /// the method that integrated, and why, when the program chose
    pub method: String,
    /// requested error
    pub error: Option<f64>,
    /// reading and compiling the model, in s
    pub read_seconds: f64,
    /// solving alone, median of the repeats, in s
    pub solve_seconds: f64,
    /// writing results, in s
    pub write_seconds: f64,
    /// how often it was solved to time it
    pub repeats: u32,
    /// totals of all simulations
    pub counts: Counts,
    /// degrees of freedom
    pub freedom: i64,
    /// rows left out because others imply them, by name
    pub redundant: Vec<String>,
    /// when and where the rank of the rows changed
    pub rank_changes: Vec<RankChange>,
    /// largest change of the energy balance, relative to its largest part; `None`: not watched
    pub energy_drift: Option<f64>,
    /// largest residual of a constraint row over the run; `None`: there are no rows
    pub constraint_drift: Option<f64>,
    /// what the user should know, one sentence each
    pub warnings: Vec<String>,
    /// jumps of what motions prescribe that were run all the same
    pub piecewise: Vec<Jump>,
    /// one per SIMULATE command
    pub simulations: Vec<Simulation>,
}

/// A jump of what a MOTION prescribes.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// user's number of the MOTION
    pub motion: u32,
    /// when
    pub at: f64,
    /// "displacement" or "velocity"
    pub of: &'static str,
    /// by how much
    pub by: f64,
}

/// A change of the rank of the rows during a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct RankChange {
    /// when
    pub time: f64,
    /// "passes": rows are dependent at that position alone; "other rows": others are kept from there; "restored": a row that followed from others no longer does
    pub what: &'static str,
    /// the rows concerned
    pub rows: Vec<String>,
    /// coordinates there: names and values
    pub place: Vec<(String, f64)>,
}

/// The facts about one simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// what it was
    pub kind: Kind,
    /// clock at its start and end
    pub start: f64,
    /// see `start`
    pub end: f64,
    /// rows it wrote
    pub outputs: usize,
    /// the method
    pub method: String,
    /// why it ended
    pub status: Status,
    /// why it ended early, as a code that `cognate explain` knows; empty: everything was done
    pub stop_code: &'static str,
    /// the same in a sentence
    pub stop_reason: String,
    /// solving alone, in s
    pub solve_seconds: f64,
    /// what the method did
    pub counts: Counts,
    /// names of the worst rows or elements where it stopped
    pub worst: Vec<String>,
}

impl Simulation {
    /// A simulation that has not done anything yet.
    pub fn new(kind: Kind, start: f64) -> Self {
        Self {
            kind,
            start,
            end: start,
            outputs: 0,
            method: String::new(),
            status: Status::Completed,
            stop_code: "",
            stop_reason: String::new(),
            solve_seconds: 0.0,
            counts: Counts::default(),
            worst: Vec::new(),
        }
    }
}

/// One thing that happened, as the log tells it.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// a command was obeyed; its text
    Command(String),
    /// the title of the model that was read
    Title(String),
    /// rows left out at a time, because others imply them: names of equations and elements
    Redundant {
        /// clock
        time: f64,
        /// such as (`Zi.Xj`, `JOINT_2`)
        equations: Vec<(String, String)>,
    },
    /// something happened
    Info(String),
    /// worth knowing; may have several lines
    Warning(String),
    /// could not be done; may have several lines
    Error(String),
    /// the model was assembled at a time: worst residuals of position, velocity, and how often was iterated
    InitialConditions {
        /// clock
        time: f64,
        /// of Newton
        iterations: u32,
    },
    /// an equilibrium was found
    Static {
        /// clock
        time: f64,
        /// of Newton
        iterations: u32,
        /// largest remaining force
        imbalance: f64,
    },
    /// a simulation over time begins
    Begin {
        /// kinematic or dynamic
        kind: Kind,
        /// such as `GSTIFF`
        integrator: String,
        /// such as `I3`; empty when there is no choice
        formulation: String,
        /// requested error
        error: f64,
    },
    /// how far a simulation is
    Progress {
        /// clock
        time: f64,
        /// last step
        step: f64,
        /// evaluations so far
        evaluations: u64,
        /// steps so far
        steps: u64,
        /// order of the method
        order: u32,
        /// seconds since the start of the run
        seconds: f64,
    },
    /// a simulation over time ends
    End,
    /// the run is over
    Finished {
        /// wall clock, in s
        elapsed: f64,
        /// processor, in s
        cpu: f64,
    },
}

impl Run {
    /// A run without rows, whose first column is time.
    pub fn new(name: impl Into<String>, title: impl Into<String>, units: Units) -> Self {
        let time = Column {
            name: "time".into(),
            unit: units.time.clone(),
            values: Vec::new(),
        };
        Self {
            name: name.into(),
            title: title.into(),
            units,
            columns: vec![time],
            ..Self::default()
        }
    }
    /// Adds a column; its index. All columns are added before the first row.
    pub fn add_column(&mut self, name: impl Into<String>, unit: impl Into<String>) -> usize {
        self.columns.push(Column {
            name: name.into(),
            unit: unit.into(),
            values: Vec::new(),
        });
        self.columns.len() - 1
    }
    /// Adds a row: time and one value for each further column, in order; what is missing is NaN.
    pub fn push(&mut self, row: &[f64]) {
        for (column, index) in self.columns.iter_mut().zip(0..) {
            column
                .values
                .push(row.get(index).copied().unwrap_or(f64::NAN));
        }
    }
    /// Begins a sequence at the next row; it is named by its kind and number.
    pub fn begin(&mut self, kind: Kind) {
        let number = self.sequences.iter().filter(|s| s.kind == kind).count() + 1;
        let rows = self.rows()..self.rows();
        self.sequences.push(Sequence {
            name: format!("{}_{number:03}", kind.name()),
            kind,
            rows,
        });
    }
    /// Ends the last sequence after the last row.
    pub fn end(&mut self) {
        let rows = self.rows();
        if let Some(last) = self.sequences.last_mut() {
            last.rows.end = rows;
        }
    }
    /// Keeps the rows of some sequences; all others go.
    pub fn keep_sequences(&mut self, keep: impl Fn(&Sequence) -> bool) {
        self.sequences.retain(keep);
        for column in &mut self.columns {
            let kept = self
                .sequences
                .iter()
                .filter_map(|s| column.values.get(s.rows.clone()));
            column.values = kept.flatten().copied().collect();
        }
        let mut at = 0;
        for sequence in &mut self.sequences {
            let length = sequence.rows.len();
            sequence.rows = at..at + length;
            at += length;
        }
    }
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |c| c.values.len())
    }
    /// Indices of the columns that tables show: [`Run::table`], or all.
    pub fn table_columns(&self) -> Vec<usize> {
        if self.table.is_empty() {
            (0..self.columns.len()).collect()
        } else {
            self.table.clone()
        }
    }
    /// Rows that tables show: all but the model as it was read.
    pub fn table_rows(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.rows()).filter(|row| {
            !self
                .sequences
                .iter()
                .any(|s| s.kind == Kind::Input && s.rows.contains(row))
        })
    }
    /// Index of the column with this name; blanks and case do not count.
    pub fn find(&self, name: &str) -> Option<usize> {
        let plain = |text: &str| {
            text.chars()
                .filter(|c| !c.is_whitespace())
                .flat_map(char::to_lowercase)
                .collect::<String>()
        };
        let wanted = plain(name);
        let exact = self.columns.iter().position(|c| c.name == name);
        exact.or_else(|| self.columns.iter().position(|c| plain(&c.name) == wanted))
    }
    /// Values of the column with this name.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        self.find(name).map(|i| self.columns[i].values.as_slice())
    }
}

/// Unit of a part's or element's component as result files spell it, from the kind of quantity.
///
/// `X` and `VX` are lengths, `PSI` and `WX` angles, `FX` a force, `TX` a torque; the rest is a pure number.
pub fn component_unit(component: &str, units: &Units) -> String {
    let Units {
        angle,
        length,
        time,
        force,
        ..
    } = units;
    match component {
        "TIME" => time.clone(),
        "X" | "Y" | "Z" | "DM" => length.clone(),
        "PSI" | "THETA" | "PHI" | "YAW" | "PITCH" | "ROLL" => angle.clone(),
        "VX" | "VY" | "VZ" | "VM" => format!("{length}/{time}"),
        "WX" | "WY" | "WZ" | "WM" => format!("{angle}/{time}"),
        "ACCX" | "ACCY" | "ACCZ" | "ACCM" => format!("{length}/{time}**2"),
        "WDX" | "WDY" | "WDZ" | "WDTX" | "WDTY" | "WDTZ" | "WDTM" => format!("{angle}/{time}**2"),
        "FX" | "FY" | "FZ" | "FM" => force.clone(),
        "TX" | "TY" | "TZ" | "TM" => format!("{force}-{length}"),
        _ => String::new(),
    }
}

/// Reads a file of results; its name tells the format: `.res`, `.gra` or `.csv`.
///
/// # Errors
/// When the file cannot be read, its format is none of these, or its contents are not of that format.
pub fn read(path: &Path) -> Result<Run, Diagnostic> {
    let file = path.display().to_string();
    let in_file = |mut d: Diagnostic| {
        d.file.get_or_insert(file.clone());
        d
    };
    let bytes = std::fs::read(path).map_err(|e| {
        in_file(Diagnostic::error(
            "file_unreadable",
            format!("cannot be read: {e}"),
        ))
    })?;
    let mut run = match extension(path).as_str() {
        "res" => res::read(&bytes),
        "gra" => gra::read(&bytes),
        "csv" => csv::read(&bytes),
        other => Err(unknown_format(other, "read", "res, gra, csv")),
    }
    .map_err(in_file)?;
    if run.name.is_empty() {
        run.name = path
            .file_stem()
            .map(|s| s.to_string_lossy().into_owned())
            .unwrap_or_default();
    }
    Ok(run)
}

/// Writes a run to a file; its name tells the format: `.csv`, `.json`, `.res` or `.msg`.
///
/// # Errors
/// When the file cannot be written, or its format is none of these.
pub fn write(run: &Run, path: &Path) -> Result<(), Diagnostic> {
    let text = match extension(path).as_str() {
        "csv" => csv::write(run, true),
        "json" => json::document(run),
        "res" => res::write(run),
        "msg" => msg::write(run),
        other => return Err(unknown_format(other, "write", "csv, json, res, msg")),
    };
    write_text(path, &text)
}

/// Writes a text to a file, all or nothing: first beside it, then renamed, so that no reader meets half a file.
///
/// # Errors
/// When the file cannot be written.
pub fn write_text(path: &Path, text: &str) -> Result<(), Diagnostic> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    let done = std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, path));
    done.map_err(|e| {
        // What is left beside it is of no use; that it cannot be removed either adds nothing.
        let _ = std::fs::remove_file(&beside);
        let mut d = Diagnostic::error("file_unwritable", format!("cannot be written: {e}"));
        d.file = Some(path.display().to_string());
        d
    })
}

fn extension(path: &Path) -> String {
    path.extension()
        .map(|e| e.to_string_lossy().to_lowercase())
        .unwrap_or_default()
}

fn unknown_format(given: &str, verb: &str, known: &str) -> Diagnostic {
    let message = if given.is_empty() {
        "the file name has no extension".into()
    } else {
        format!("no result format `.{given}`")
    };
    Diagnostic::error("result_format", message).help(format!(
        "formats that can be {}: {known}",
        if verb == "read" { "read" } else { "written" }
    ))
}

/// A mistake in the contents of a result file, at a 1-based line (0: of the whole file).
fn malformed(line: usize, message: impl Into<String>) -> Diagnostic {
    let mut d = Diagnostic::error("result_syntax", message);
    d.line = line;
    d.column = usize::from(line > 0);
    d
}

/// The shortest decimal digits that read back as the same number.
pub fn digits(x: f64) -> String {
    let text = format!("{x:?}");
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

/// A number as result files of every age write it: `1.5`, `-2.18E-014`, `1.0D+00`, `Infinity`.
fn number(text: &str) -> Option<f64> {
    text.parse()
        .ok()
        .or_else(|| text.replace(['D', 'd'], "E").parse().ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sequences_are_numbered_by_kind_and_hold_their_rows() {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("x", "mm");
        for (kind, rows) in [(Kind::Dynamic, 2), (Kind::Static, 1), (Kind::Dynamic, 3)] {
            run.begin(kind);
            (0..rows).for_each(|i| run.push(&[i as f64, 0.0]));
            run.end();
        }
        let names: Vec<_> = run
            .sequences
            .iter()
            .map(|s| (s.name.as_str(), s.rows.clone()))
            .collect();
        assert_eq!(
            names,
            [
                ("dynamic_001", 0..2),
                ("static_001", 2..3),
                ("dynamic_002", 3..6)
            ]
        );
    }

    #[test]
    fn columns_are_found_without_regard_to_blanks_and_case() {
        let mut run = Run::new("r", "t", Units::default());
        run.add_column("DX(12, 21)", "mm");
        run.push(&[0.0, 4.5]);
        assert_eq!(run.column("dx(12,21)"), Some(&[4.5][..]));
        assert_eq!(run.column("DX(12,22)"), None);
    }

    #[test]
    fn digits_are_the_shortest_that_read_back() {
        let written = [0.1 + 0.2, 1.0, -0.0, 1e300, 5e-324, 1234567.0].map(digits);
        assert_eq!(
            written,
            [
                "0.30000000000000004",
                "1",
                "-0",
                "1e300",
                "5e-324",
                "1234567"
            ]
        );
    }

    #[test]
    fn names_of_kinds_stand_in_the_order_of_the_kinds() {
        for (kind, block, step) in Kind::NAMES {
            assert_eq!((kind.name(), kind.step()), (block, step));
        }
    }
}
