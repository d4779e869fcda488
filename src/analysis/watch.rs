//! Hooks through which a caller follows a long analysis and can end it.

use super::system::System;
use super::trajectory::Trajectory;
use crate::numeric::Stats;
use crate::results::Run;

/// Hooks called while an analysis goes on, after each step of it.
pub trait Watch {
    /// Returns whether to stop now; results so far are kept.
    fn interrupted(&mut self) -> bool {
        false
    }
    /// Takes note of the time that has been reached, of the last step, and of what it all has cost.
    fn progress(&mut self, _t: f64, _h: f64, _stats: &Stats) {}
    /// Takes note of the time that the integration has reached which measures the error.
    fn measures(&mut self, _t: f64, _stats: &Stats) {}
    /// Takes note of the state at the end of a step   (n_y, or more)
    fn visit(&mut self, _system: &System, _t: f64, _y: &[f64]) {}
    /// Takes states that have been put out; all but the last may be
    /// released.
    fn collect(&mut self, _system: &System, _trajectory: &mut Trajectory) {}
    /// Takes note of the results after a simulation.
    fn simulated(&mut self, _run: &Run) {}
}

/// The hooks of a caller who does not look.
pub struct Unwatched;
impl Watch for Unwatched {}
