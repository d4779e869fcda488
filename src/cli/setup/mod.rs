//! The file beside a model, `MODEL.toml`: load cases, functions, groups of functions and the set-up
//! of a run.
//!
//! ```text
//! MODEL.toml ── read ──▶ Setup ── apply ──▶ Model with chosen loads and functions
//!                          ▲                     │ what was chosen
//!                          └──────── edit ◀──────┘
//! ```
//!
//! The file is the user's: only what a command is asked to change is changed, comments and order
//! stay.

mod apply;
pub mod edit;
mod function;
mod group;
mod load;
mod read;

pub use apply::{Asked, Prepared, check_loads, chosen_loads, loads_acting, prepare};
pub use function::{Ordinate, UserFunction};
pub use group::{Group, Members, USER_DEFINED};
pub use load::{Load, loads_of};

use super::run::{self, KindName};
use super::{Exit, Failure};
use crate::analysis::session::Chosen;
use crate::dataset::command::Script;
use crate::diagnostic::{Diagnostic, Span};
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
    pub kind: Option<KindName>,
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
    pub fn beside(dataset: &Path) -> Result<Self, Failure> {
        let file = dataset.with_extension("toml");
        let text = match std::fs::read_to_string(&file) {
            Ok(text) => text,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => {
                return Ok(Self {
                    file,
                    ..Self::default()
                });
            }
            Err(e) => {
                let mut d = Diagnostic::error("file_unreadable", format!("cannot be read: {e}"));
                d.file = Some(file.display().to_string());
                return Err(d.into());
            }
        };
        read::setup(file, text).map_err(|found| Failure::in_files(Exit::Input, found))
    }

    /// Reads the file beside a model: beside the dataset that a command file names.
    ///
    /// # Errors
    /// When the command file or the file beside the dataset has mistakes.
    pub fn of_model(model: &Path) -> Result<Self, Failure> {
        Self::beside(&dataset_of(model)?)
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

    /// Returns a mistake at a place of the file.
    fn mistake(&self, span: Span, code: &'static str, message: impl Into<String>) -> Diagnostic {
        let mut d = Diagnostic::error(code, message).at(&self.text, span);
        d.file = Some(self.file.display().to_string());
        d
    }
}

/// Returns the dataset of a model: that which a command file names.
///
/// # Errors
/// When the command file cannot be read, or names none.
pub fn dataset_of(model: &Path) -> Result<PathBuf, Failure> {
    if !run::has_commands(model) {
        return Ok(model.to_owned());
    }
    let is_log = super::moved::has_ending(model, "msg");
    let script = match is_log {
        true => Script::from_message_log(model),
        false => Script::read(model),
    };
    let script = script.map_err(|e| Failure::in_files(Exit::Input, e.into()))?;
    let named = script.model_file();
    let named = named.or_else(|| is_log.then(|| model.with_extension("adm")));
    named.ok_or_else(|| {
        let what = format!("{} names no dataset", model.display());
        let d = Diagnostic::error("no_model", what);
        d.help("begin it with FILE/MODEL=name").into()
    })
}
