//! Stiffness that the simulations of a session have met so far: a replay of many short ones begins
//! each of them with the method that one long simulation would go on with.
//!
//! A short simulation may end before it is worth a change of the method. So the steps that
//! stability held short are counted from one simulation to the next, and the first method is chosen
//! for all the time since the first simulation. Whether the implicit method takes so few steps that
//! these are cheaper is seen in the first simulation that begins with it.

use crate::analysis::trajectory::{Takeover, Trajectory};

/// Steps that stability held short, in simulations one after the other, from which on the next one
/// begins with an implicit method: about as many as a long simulation spends before it changes.
const ENOUGH_STEPS: usize = 100;
/// Share of the steps of a simulation that stability holds short from which on it is stiff: each
/// begins with shorter ones, and every other one is shorter than the edge permits.
const LEAST_SHARE: f64 = 0.25;

/// Stiffness that simulations have met.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MetStiffness {
    /// when the first simulation began, in s
    began: Option<f64>,
    /// steps of the explicit method that stability held short, in the last simulations
    limited: usize,
    /// its operations per second in the last simulation
    explicit_rate: f64,
    is_stiff: bool,
    /// the implicit method has been tried, and was no cheaper
    is_in_vain: bool,
}

impl MetStiffness {
    /// Takes note of a simulation of some duration in which the program chose the methods.
    pub(super) fn see(&mut self, trajectory: &Trajectory, duration: f64) {
        let Some((_, name, why)) = trajectory.methods.last() else {
            return;
        };
        let stats = trajectory.stats;
        let rate = trajectory.operations / duration;
        match why {
            Takeover::Stiff => self.is_stiff = true,
            Takeover::Cheaper => self.is_stiff = name != "DOP853",
            // the stiffness was that of a branch
            Takeover::Eased => (self.limited, self.is_stiff) = (0, false),
            Takeover::Begins if name == "DOP853" => {
                self.explicit_rate = rate;
                let is_held_short = stats.at_edge as f64 > LEAST_SHARE * stats.steps as f64;
                self.limited = match is_held_short {
                    true => self.limited + stats.at_edge,
                    false => 0,
                };
                self.is_stiff = self.limited >= ENOUGH_STEPS;
            }
            Takeover::Begins => {
                let explicit = self.explicit_rate;
                self.is_in_vain |= explicit > 0.0 && rate > explicit;
            }
        }
    }

    /// Returns the time from which on a method is chosen for a simulation that begins at `start`.
    pub(super) fn since(&mut self, start: f64) -> f64 {
        let began = *self.began.get_or_insert(start);
        if self.is_in_vain { start } else { began }
    }

    /// Returns whether the next simulation goes on where it is stiff.
    pub(super) fn goes_on(self) -> bool {
        self.is_stiff && !self.is_in_vain
    }
}
