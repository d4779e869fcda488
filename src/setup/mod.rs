//! The file beside a model, `MODEL.toml`: load cases, functions, groups of functions and the set-up
//! of a run (docs/loads.md).
//!
//! ```text
//! MODEL.toml ── read ──▶ Setup ── prepare ──▶ Model with chosen loads and functions
//! ```
//!
//! [`prepare`] does to a model what every command of the shell does before it runs one.
//!
//! ```
//! # fn main() -> Result<(), cognate::Error> {
//! use cognate::setup::{Asked, prepare};
//! let mut model = cognate::Model::read("examples/slider_crank.adm")?;
//! let prepared = prepare("examples/slider_crank.adm".as_ref(), &mut model, Asked::Kept)?;
//! assert!(prepared.loads.is_none()); // nothing was chosen: all loads act
//! # Ok(()) }
//! ```

mod apply;
mod function;
mod group;
mod inputs;
mod load;
mod read;

pub use apply::{Asked, Prepared, apply, check_loads, chosen_loads, prepare, target_of};
pub use function::{Ordinate, Shape, UserFunction};
pub use group::{Group, Members, USER_DEFINED};
pub use inputs::{Between, drive_inputs, undriven_inputs};
pub use load::{Load, loads_of};

use crate::analysis::session::{Chosen, Options};
use crate::dataset::command::{Command, Simulate, SimulationKind, Step};
use crate::diagnostic::{Diagnostic, Error, Span};
use crate::disk;
use crate::results::format::Format;
use std::path::{Path, PathBuf};

/// The load case that keeps loads which were chosen one by one.
pub const LAST_USED: &str = "9999 Last_Used_Loadcase";

/// A text of the file, with its place.
#[derive(Clone, Debug, Default)]
pub struct Named {
    /// the text
    pub text: String,
    /// where it stands
    pub span: Span,
}

/// A load case: a named set of loads, or of other load cases.
#[derive(Clone, Debug)]
pub struct Case {
    /// its name
    pub name: Named,
    /// loads, or names of load cases
    pub loads: Vec<Named>,
}

/// The set-up of a run: what is not said where it is started.
#[derive(Clone, Debug, Default)]
pub struct Solve {
    /// load cases and loads that act; `None`: all loads
    pub loads: Option<Vec<Named>>,
    /// kind of simulation
    pub kind: Option<SimulationKind>,
    /// end of the simulation
    pub end: Option<f64>,
    /// output steps
    pub steps: Option<usize>,
    /// static equilibrium before a simulation over time
    pub at_rest_first: bool,
    /// permitted local error
    pub error: Option<f64>,
    /// method of integration
    pub method: Option<String>,
    /// formats of the tables
    pub formats: Vec<Format>,
    /// elements that are recorded
    pub only: Vec<Chosen>,
    /// whether velocities and accelerations of bodies are recorded
    pub body_motion: bool,
    /// further columns
    pub columns: Vec<String>,
}

impl Solve {
    /// Gives options what they leave open: error, method, columns, and what is recorded.
    pub fn complete(&self, options: &mut Options) {
        options.error = options.error.or(self.error);
        if options.method.is_none() {
            options.method.clone_from(&self.method);
        }
        if options.columns.is_empty() {
            options.columns.clone_from(&self.columns);
        }
        if options.only.is_empty() {
            options.only.clone_from(&self.only);
        }
        options.body_rates |= self.body_motion;
        options.full |= self.body_motion || !self.only.is_empty();
    }

    /// Returns the simulations of a run: of a kind, to an end, with output steps, each as the
    /// set-up says where it is `None`, after one at rest where the set-up asks for that.
    ///
    /// `None`: neither says when the run ends.
    pub fn simulations(
        &self,
        kind: Option<SimulationKind>,
        end: Option<f64>,
        steps: Option<usize>,
    ) -> Option<Vec<Step>> {
        let kind = kind.or(self.kind).unwrap_or(SimulationKind::Transient);
        let end = end.or(self.end);
        let over_time = !matches!(
            kind,
            SimulationKind::Static | SimulationKind::InitialConditions
        );
        if over_time && end.is_none() {
            return None;
        }
        let steps = steps.or(self.steps);
        let simulate = Simulate {
            kind,
            end,
            duration: None,
            steps: steps.map(|n| u32::try_from(n).unwrap_or(u32::MAX)),
            dtout: None,
        };
        let at_rest = Simulate {
            kind: SimulationKind::Static,
            end: None,
            steps: None,
            ..simulate
        };
        let first = (over_time && self.at_rest_first).then_some(at_rest);
        let step = |simulate| Step {
            command: Command::Simulate(simulate),
            text: "SIMULATE".into(),
            line: 0,
        };
        Some(first.into_iter().chain([simulate]).map(step).collect())
    }
}

/// The contents of the file beside a model.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// the file
    pub file: PathBuf,
    /// its text
    pub text: String,
    /// set-up of a run
    pub solve: Solve,
    /// load cases
    pub cases: Vec<Case>,
    /// functions of the user's
    pub functions: Vec<UserFunction>,
    /// loads, and the functions that give them
    pub driven: Vec<(Named, Named)>,
    /// groups of functions
    pub groups: Vec<Group>,
}

impl Setup {
    /// Reads the file beside a dataset; one without contents where there is none.
    ///
    /// # Errors
    /// All mistakes in the file, each at its line and column.
    pub fn beside(dataset: &Path) -> Result<Self, Error> {
        let file = dataset.with_extension("toml");
        let text = disk::read(&file).and_then(|bytes| {
            String::from_utf8(bytes).map_err(|e| std::io::Error::other(e.utf8_error()))
        });
        let text = match text {
            Ok(text) => text,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                return Ok(Self {
                    file,
                    ..Self::default()
                });
            }
            Err(e) => {
                let mut d = Diagnostic::error("file_unreadable", format!("cannot be read: {e}"));
                d.file = Some(disk::text(&file));
                return Err(d.into());
            }
        };
        Self::read(file, text)
    }

    /// Reads the text of such a file; `file`: its name.
    ///
    /// # Errors
    /// All mistakes, each at its line and column.
    pub fn read(file: PathBuf, text: String) -> Result<Self, Error> {
        read::setup(file, text).map_err(Error::from)
    }

    /// Returns whether there is a file.
    pub fn exists(&self) -> bool {
        !self.text.is_empty()
    }

    /// Returns the load case of a name.
    pub fn case(&self, name: &str) -> Option<&Case> {
        self.cases.iter().find(|case| case.name.text == name)
    }

    /// Returns the function of a name.
    pub fn function(&self, name: &str) -> Option<&UserFunction> {
        self.functions.iter().find(|f| f.name.text == name)
    }

    /// Gives a mistake its place in the file.
    fn placed(&self, span: Span, said: Diagnostic) -> Diagnostic {
        let mut d = said.at(&self.text, span);
        d.file = Some(disk::text(&self.file));
        d
    }

    /// Returns a mistake at a place of the file.
    fn mistake(&self, span: Span, code: &'static str, message: impl Into<String>) -> Diagnostic {
        self.placed(span, Diagnostic::error(code, message))
    }
}
