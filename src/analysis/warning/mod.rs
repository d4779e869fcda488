//! Warnings: what the user should know although the analysis goes on. Each is data, and becomes a
//! sentence here and nowhere else.
//!
//! ```text
//! scene          the compiler took something for something else, or left it out
//! assembly       what assembly made of the configuration of the dataset
//! condition      initial conditions that are not met, or read in another way
//! run            what a simulation met
//! verification   what a verification takes for granted
//! ```

mod assembly;
mod condition;
mod run;
mod verification;

pub use assembly::AssemblyWarning;
pub use condition::ConditionWarning;
pub use run::{RunWarning, jumps};
pub use verification::VerificationWarning;

use crate::diagnostic::Diagnostic;
use crate::results;
use std::fmt;

/// Something that the user should know although the analysis goes on.
#[derive(Clone, Debug, PartialEq)]
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

    /// Returns the element or column that it is about, as sentences name it.
    pub fn element(&self) -> Option<String> {
        match self {
            Warning::Scene(d) => d.element.clone(),
            Warning::Assembly(w) => Some(w.element().to_string()),
            Warning::Condition(w) => Some(w.element().to_string()),
            Warning::Run(w) => w.element(),
            Warning::Verification(w) => w.element(),
        }
    }

    /// Returns it as the record of a run keeps it.
    pub fn record(&self) -> results::Warning {
        results::Warning {
            code: self.code(),
            element: self.element(),
            name: None,
            sentence: self.to_string(),
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::Scene(d) => write!(f, "{}: {}", owner(d), d.message),
            Warning::Assembly(w) => w.fmt(f),
            Warning::Condition(w) => w.fmt(f),
            Warning::Run(w) => w.fmt(f),
            Warning::Verification(w) => w.fmt(f),
        }
    }
}

/// Returns the name of the element that a diagnostic is about.
fn owner(d: &Diagnostic) -> &str {
    d.element.as_deref().unwrap_or("the model")
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
