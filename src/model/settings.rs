//! Settings of the whole model: UNITS, INTEGRATOR, EQUILIBRIUM and the like.

use std::collections::BTreeMap;

/// UNITS: names of the units, and the factor that makes them consistent.
#[derive(Clone, Debug, PartialEq)]
pub struct Units {
    /// FORCE
    pub force: String,
    /// MASS
    pub mass: String,
    /// LENGTH
    pub length: String,
    /// TIME
    pub time: String,
    /// Force·UCF = Mass·Acceleration, all in model units
    pub ucf: f64,
}

/// INTEGRATOR; `None` = not given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IntegratorSettings {
    /// GSTIFF, WSTIFF, HHT, ABAM … in full
    pub method: Option<String>,
    /// I3, SI2, SI1
    pub formulation: Option<String>,
    /// ERROR: permitted local error
    pub error: Option<f64>,
    /// HMAX: longest step
    pub hmax: Option<f64>,
    /// HMIN: shortest step
    pub hmin: Option<f64>,
    /// HINIT: first step
    pub hinit: Option<f64>,
    /// KMAX: highest order
    pub kmax: Option<u32>,
    /// MAXIT: most iterations in a step
    pub maxit: Option<u32>,
    /// ALPHA: damping of HHT
    pub alpha: Option<f64>,
    /// BETA of NEWMARK
    pub beta: Option<f64>,
    /// GAMMA of NEWMARK
    pub gamma: Option<f64>,
    /// PATTERN, CORRECTOR, INTERPOLATE, ADAPTIVITY … by full keyword
    pub rest: Settings,
}

/// EQUILIBRIUM; `None` = not given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EquilibriumSettings {
    /// ERROR: largest change of a coordinate in the last iteration
    pub error: Option<f64>,
    /// IMBALANCE: largest force or torque that may remain
    pub imbalance: Option<f64>,
    /// TLIMIT: largest translation in one iteration   \[length\]
    pub tlimit: Option<f64>,
    /// ALIMIT: largest rotation in one iteration   \[rad\]
    pub alimit: Option<f64>,
    /// MAXIT: most iterations
    pub maxit: Option<f64>,
    /// STABILITY: least part of the mass matrix that is added to the stiffness
    pub stability: Option<f64>,
    /// STATICS, DYNAMICS, PATTERN, AERROR … by full keyword
    pub rest: Settings,
}

macro_rules! settings_statements {
    ($($(#[$doc:meta])* $statement:ident $keyword:literal;)*) => {
        /// Statements without a number whose arguments are kept by their keywords.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum SettingsStatement {
            $($(#[$doc])* $statement,)*
        }

        impl SettingsStatement {
            /// Returns its keyword, in capitals.
            pub const fn keyword(self) -> &'static str {
                match self {
                    $(Self::$statement => $keyword,)*
                }
            }
        }
    };
}
settings_statements! {
    /// numbers of threads, tolerances of facets …
    Preferences "PREFERENCES";
    /// prints of the solver's work
    Debug "DEBUG";
    /// the linear solver
    Lsolver "LSOLVER";
    /// variables of the environment
    Environment "ENVIRONMENT";
    /// which files are written, and scales of their columns
    Output "OUTPUT";
    /// what the file of results holds
    Results "RESULTS";
    /// which statements are printed
    List "LIST";
    /// which are not
    Nolist "NOLIST";
}

impl SettingsStatement {
    /// Returns true if nothing that is computed or written depends on it.
    pub const fn is_idle(self) -> bool {
        match self {
            Self::Preferences
            | Self::Debug
            | Self::Lsolver
            | Self::Environment
            | Self::List
            | Self::Nolist => true,
            Self::Output | Self::Results => false,
        }
    }
}

/// KINEMATICS, IC and the like: numbers and words by full keyword; empty = defaults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// arguments that are one number
    pub numbers: BTreeMap<String, f64>,
    /// all others, as text; empty for a bare keyword
    pub words: BTreeMap<String, String>,
}
