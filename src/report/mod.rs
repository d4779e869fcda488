//! Pictures of results: curves as SVG and as text for the terminal, and mechanisms that move.

#[cfg(feature = "plots")]
pub mod channels;
pub mod mechanism;
pub mod picture;
#[cfg(feature = "plots")]
pub mod plot;
#[cfg(feature = "plots")]
pub mod svg;
#[cfg(feature = "plots")]
pub mod terminal;
#[cfg(feature = "plots")]
pub mod transform;

#[cfg(feature = "plots")]
pub use plot::{Curve, Plot};

/// Returns a text of no more letters than `most`: of a longer one the beginning and the end.
fn cut(text: &str, most: usize) -> String {
    let n = text.chars().count();
    if n <= most {
        return text.to_owned();
    }
    let before = most / 2;
    let after = most.saturating_sub(before + 1);
    let first: String = text.chars().take(before).collect();
    let last: String = text.chars().skip(n - after).collect();
    format!("{first}…{last}")
}
