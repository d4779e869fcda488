//! The start of every analysis: positions that satisfy all rows, velocities that fit, initial
//! conditions.

pub mod alignment;
pub mod assemble;
pub mod branch;
pub(super) mod coincident;
pub mod dataset;
pub(super) mod driven_start;
pub(super) mod embedded;
mod given_velocities;
pub(super) mod initial_conditions;
mod kinetic;
pub mod leap;
mod mechanisms;
pub mod misalignment;
pub mod nearby;
mod nearest;
pub(super) mod open_reactions;
pub(super) mod tangents;
pub mod velocities;
