//! Pictures of results: curves as SVG and as text for the terminal, and mechanisms that move.

#[cfg(feature = "cli")]
pub mod channels;
pub mod mechanism;
#[cfg(feature = "cli")]
pub mod picture;
#[cfg(feature = "cli")]
pub mod plot;
#[cfg(feature = "cli")]
pub mod svg;
#[cfg(feature = "cli")]
pub mod terminal;
#[cfg(feature = "cli")]
pub mod transform;

#[cfg(feature = "cli")]
pub use plot::{Curve, Plot};
