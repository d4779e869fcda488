//! Pictures of results: curves as SVG and as text for the terminal, and mechanisms that move.

pub mod channels;
pub mod mechanism;
pub mod picture;
pub mod plot;
pub mod svg;
pub mod terminal;
pub mod transform;

pub use plot::{Curve, Plot};
