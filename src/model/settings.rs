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

/// EQUILIBRIUM, KINEMATICS, IC and the like: numbers and words by full keyword; empty = defaults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// arguments that are one number
    pub numbers: BTreeMap<String, f64>,
    /// all others, as text; empty for a bare keyword
    pub words: BTreeMap<String, String>,
}
