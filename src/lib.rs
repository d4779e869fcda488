//! cognate: the ADAMS function language and the multibody solver that speaks it.

#![warn(missing_docs)]

pub mod diagnostic;
pub mod expr;
pub mod scalar;
pub mod space;

#[cfg(feature = "solver")]
pub mod model;
#[cfg(feature = "solver")]
pub mod numeric;
#[cfg(feature = "solver")]
pub mod results;

#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "cli")]
pub mod report;
