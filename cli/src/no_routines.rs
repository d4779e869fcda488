//! `--routines` where there are none: the option is not there, and nothing is loaded.

use super::Failure;
use super::mistake::Mistake;
use cognate::analysis::session::Session;
use cognate::analysis::sweep::Sweep;
use cognate::dataset::{Dataset, Reading};

/// No libraries of routines.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct RoutineArgs {}

impl RoutineArgs {
    /// Does nothing.
    ///
    /// # Errors
    /// None.
    pub fn compute(&self, _: &mut Session, _: &Dataset, _: bool) -> Result<Mistake, Failure> {
        Ok(Mistake::default())
    }

    /// Does nothing.
    ///
    /// # Errors
    /// None.
    pub fn compute_in(&self, _: &mut Sweep, _: &Reading, _: bool) -> Result<Mistake, Failure> {
        Ok(Mistake::default())
    }
}
