//! Causes: the kinds of mistakes on which the program itself acts.
//!
//! Most codes are for the reader alone. Those that decide anything (an exit code, further advice,
//! whether to look on) are values of this type where they are given and where they are asked for,
//! so that the two cannot drift apart.

use super::Diagnostic;

/// A kind of mistake on which the program acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Cause {
    /// something stands for a model that is not quite the one written
    Approximate,
    /// parts and joints do not fit together
    Assembly,
    /// a curve or surface is given by what cannot be read
    CurveData,
    /// a file of results ends too early
    CutOff,
    /// an operation has no value for what it is given
    Domain,
    /// a file of somebody else stands where one is to be written
    FileExists,
    /// a file or folder cannot be written
    FileUnwritable,
    /// a simulation that needs a mechanism without freedom
    Freedom,
    /// inertias that no body has
    ImpossibleInertia,
    /// a file that is to be written is an input of the same command
    IsInput,
    /// a column cannot be computed for the rows so far
    LateColumn,
    /// axes of a loop are parallel within tolerance, not exactly
    Misaligned,
    /// a formula asks for a value that is not given
    MissingValue,
    /// results lack functions from which a motion follows
    NoMotionSet,
    /// an element is left out on request
    Skipped,
    /// a statement that another one of the same element replaces
    Superseded,
    /// a text ends before the expression does
    UnexpectedEnd,
    /// an element that does not exist is referred to
    UnknownElement,
    /// a name that the language does not have
    UnknownName,
    /// an element or argument that is read, but not solved
    Unsupported,
    /// a routine of the user's that is not there
    UserRoutine,
    /// an element of a command file of Adams View that is not solved
    ViewUnsolved,
}

impl Cause {
    /// Returns the code of a diagnostic with this cause.
    pub const fn code(self) -> &'static str {
        match self {
            Self::Approximate => "approximate",
            Self::Assembly => "assembly",
            Self::CurveData => "curve_data",
            Self::CutOff => "cut_off",
            Self::Domain => "domain",
            Self::FileExists => "file_exists",
            Self::FileUnwritable => "file_unwritable",
            Self::Freedom => "freedom",
            Self::ImpossibleInertia => "impossible_inertia",
            Self::IsInput => "is_input",
            Self::LateColumn => "late_column",
            Self::Misaligned => "misaligned",
            Self::MissingValue => "missing_value",
            Self::NoMotionSet => "no_motion_set",
            Self::Skipped => "skipped",
            Self::Superseded => "superseded",
            Self::UnexpectedEnd => "unexpected_end",
            Self::UnknownElement => "unknown_element",
            Self::UnknownName => "unknown_name",
            Self::Unsupported => "unsupported",
            Self::UserRoutine => "user_routine",
            Self::ViewUnsolved => "view_unsolved",
        }
    }
}

impl From<Cause> for &'static str {
    fn from(cause: Cause) -> Self {
        cause.code()
    }
}

impl Diagnostic {
    /// Returns whether this is a diagnostic with a cause.
    pub fn is(&self, cause: Cause) -> bool {
        self.code == cause.code()
    }
    /// Returns whether this is a diagnostic with one of some causes.
    pub fn is_any(&self, causes: &[Cause]) -> bool {
        causes.iter().any(|&cause| self.is(cause))
    }
}
