//! What holds for the whole model: UNITS, INTEGRATOR, EQUILIBRIUM and the like.

use std::collections::BTreeMap;

/// UNITS
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct Units {
    pub force: String,
    pub mass: String,
    pub length: String,
    pub time: String,
    /// Force·UCF = Mass·Acceleration, all in model units
    pub ucf: f64,
}

/// INTEGRATOR; `None` = not given
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct IntegratorSettings {
    /// GSTIFF, WSTIFF, HHT, ABAM … in full
    pub method: Option<String>,
    /// I3, SI2, SI1
    pub formulation: Option<String>,
    pub error: Option<f64>,
    pub hmax: Option<f64>,
    pub hmin: Option<f64>,
    pub hinit: Option<f64>,
    pub kmax: Option<u32>,
    pub maxit: Option<u32>,
    pub alpha: Option<f64>,
    pub beta: Option<f64>,
    pub gamma: Option<f64>,
    /// PATTERN, CORRECTOR, INTERPOLATE, ADAPTIVITY … by full keyword
    pub rest: Settings,
}

/// EQUILIBRIUM, KINEMATICS, IC and the like: numbers and words by full keyword; empty = defaults
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)]
pub struct Settings {
    pub numbers: BTreeMap<String, f64>,
    pub words: BTreeMap<String, String>,
}
