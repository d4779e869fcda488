//! Warnings: what the user should know although the analysis goes on. Each is data, and becomes a
//! sentence here and nowhere else: the element that it is about, as the dataset names it, and the
//! rest.
//!
//! ```text
//! scene          the compiler took something for something else, or left it out
//! assembly       what assembly made of the configuration of the dataset
//! condition      initial conditions that are not met, or read in another way
//! run            what a simulation met
//! unrest         what moves where a model is linearized
//! verification   what a verification takes for granted
//! ```

mod assembly;
mod condition;
mod run;
mod unrest;
mod verification;

pub use assembly::{AssemblyWarning, OPEN_REACTION};
pub use condition::ConditionWarning;
pub use run::{RunWarning, Within, jumps};
pub use unrest::{Rate, Unrest};
pub use verification::VerificationWarning;

use crate::diagnostic::{Diagnostic, Subject};
use crate::model::{ElementId, Model};
use crate::results;
use std::fmt;

/// Something that the user should know although the analysis goes on.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// of the compiler of the scene
    Scene(Diagnostic),
    /// of assembly
    Assembly(AssemblyWarning),
    /// of initial conditions
    Condition(ConditionWarning),
    /// of a simulation
    Run(RunWarning),
    /// of a verification
    Verification(VerificationWarning),
}

impl Warning {
    /// Returns its stable short name, which `cognate explain` explains.
    pub fn code(&self) -> &'static str {
        match self {
            Warning::Scene(d) => d.code,
            Warning::Assembly(w) => w.code(),
            Warning::Condition(_) => ConditionWarning::CODE,
            Warning::Run(w) => w.code(),
            Warning::Verification(w) => w.code(),
        }
    }

    /// Returns the element or column that its sentence begins with.
    pub fn subject(&self) -> Option<Subject> {
        match self {
            Warning::Scene(d) => Some(owner(d)),
            Warning::Assembly(w) => Some(w.subject()),
            Warning::Condition(w) => Some(w.subject()),
            Warning::Run(w) => w.subject(),
            Warning::Verification(w) => w.subject(),
        }
    }

    /// Returns the sentence after the subject, with elements as the dataset names them.
    fn rest(&self, names: &Names) -> String {
        match self {
            Warning::Scene(d) => format!(": {}", d.message),
            Warning::Assembly(w) => w.rest(names),
            Warning::Condition(w) => w.rest(names),
            Warning::Run(w) => w.rest(names),
            Warning::Verification(w) => w.rest(),
        }
    }

    /// Returns it as the record of a run of that model keeps it.
    pub fn record(&self, model: &Model) -> results::Warning {
        let names = Names(Some(model));
        results::Warning {
            code: self.code(),
            subject: self.subject(),
            name: self
                .subject()
                .and_then(|s| model.name_of(&s))
                .map(str::to_owned),
            rest: self.rest(&names),
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let subject = self.subject().map_or_else(String::new, |s| s.to_string());
        write!(f, "{subject}{}", self.rest(&Names(None)))
    }
}

/// The names that a dataset gives its elements; `None`: of no dataset.
struct Names<'m>(Option<&'m Model>);

impl<'m> Names<'m> {
    /// Returns the name of an element.
    fn name(&self, id: ElementId) -> Option<&'m str> {
        self.0?.element(id)?.place().name.as_deref()
    }

    /// Returns an element as sentences name it: "JOINT/47 'hinge'".
    fn of(&self, id: ElementId) -> String {
        Subject::from(id).named(self.name(id))
    }
}

/// Returns the subject of a diagnostic.
fn owner(d: &Diagnostic) -> Subject {
    d.subject().unwrap_or_else(|| "the model".into())
}

/// Makes each family a case of [`Warning`].
macro_rules! cases {
    ($($case:ident: $family:ty;)*) => { $(
        impl From<$family> for Warning {
            fn from(warning: $family) -> Self {
                Warning::$case(warning)
            }
        }
    )* };
}
cases! {
    Assembly: AssemblyWarning;
    Condition: ConditionWarning;
    Run: RunWarning;
    Verification: VerificationWarning;
}
