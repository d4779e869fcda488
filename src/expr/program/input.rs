//! The inputs of programs: what a program asks of its host.

use crate::expr::measures::Measure;

/// A number that a program asks of its host.
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
