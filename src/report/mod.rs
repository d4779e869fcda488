//! Pictures of results: curves as SVG and as text for the terminal.

pub mod plot;
pub mod svg;
pub mod terminal;

pub use plot::{Curve, Plot};
