//! cognate: the ADAMS function language and the multibody solver that speaks it.

#![warn(missing_docs)]
// names follow the monogram notation: capitals are frames and only frames (`p_JI_K`, `R_GP`)
#![allow(non_snake_case)]

// floor 0
pub mod diagnostic;
pub mod scalar;
// floor 1
pub mod expr;
#[cfg(feature = "solver")]
pub mod numeric;
pub mod space;
// floor 2
#[cfg(feature = "solver")]
pub mod model;
// floor 3
#[cfg(feature = "solver")]
pub mod dataset;
pub mod physics;
// floor 4
#[cfg(feature = "solver")]
pub mod scene;
// floor 5
#[cfg(feature = "solver")]
pub mod analysis;
#[cfg(feature = "cli")]
pub mod report;
#[cfg(feature = "solver")]
pub mod results;
// floor 6
#[cfg(feature = "cli")]
pub mod cli;
