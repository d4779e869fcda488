//! Straight-line code: constants, inputs, operations, outputs; the VM that runs it, and the builder that makes it.
//!
//! Two makers share it: the compiler of expressions, and the scene, which records its own equations as they run over a
//! recording scalar.

use super::measures::Measure;

/// What a program asks of its host.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Input {
    /// simulation time
    Time,
    /// code of the running analysis
    Mode,
    /// a function of the model; absent arguments are 0
    Measure(Measure, [u32; 4]),
    /// the `k`-th delayed value (DELAY), which needs history
    Delayed(u32),
    /// a number the host knows by position (used by recorded programs)
    Slot(u32),
}
