//! Pictures of results: curves as SVG and as text for the terminal.

pub mod channels;
pub mod plot;
pub mod svg;
pub mod terminal;
pub mod transform;

pub use plot::{Curve, Plot};
