//! The log of a run: what happened, in order.

use super::Kind;

/// An event of a run, as the log tells it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
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
    /// the model was assembled
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
