//! External inputs: numbers that the programs read but do not compute.
//!
//! The past of delayed values comes first, as closures may read it; what sensors and samples leave
//! in the row stands there until they change it.

use super::closures::{Closures, Hook};
use super::past::Delays;
use crate::scene::configuration::Configured;
use crate::scene::equations::Unsupported;

/// The external inputs of a system that follow from its state and its past.
#[derive(Clone, Debug, Default)]
pub struct ExternalInputs {
    /// values of the past
    pub delays: Delays,
    /// results of closures
    pub closures: Closures,
}

impl ExternalInputs {
    /// Records the external inputs of a scene, with the closures that its hooks refer to.
    ///
    /// # Errors
    /// Whatever the equations cannot supply; closures that would read what depends on them.
    pub fn new(scene: Configured<'_>, hooks: &[Hook]) -> Result<Self, Vec<Unsupported>> {
        Ok(Self {
            delays: Delays::new(scene)?,
            closures: Closures::new(scene, hooks)?,
        })
    }

    /// Returns whether there is nothing to be computed.
    pub fn is_empty(&self) -> bool {
        self.delays.is_empty() && self.closures.is_empty()
    }

    /// Fills in the external inputs of a row of numbers; `output`: also those that only results
    /// show.
    pub fn evaluate(&mut self, numbers: &mut [f64], output: bool) {
        self.delays.evaluate(numbers);
        self.closures.evaluate(numbers, output);
    }
}
