//! The axes in which reactions are told.

use crate::analysis::direction::SAME_DIRECTION;
use crate::scene::equations::Equations;
use crate::space::Mat3;

/// The axes in which an element's reaction is told: those of its J marker, ground's when they are
/// parallel to these.
pub(super) fn axes(at: &Equations<'_, f64>, marker: Option<usize>) -> (String, Mat3<f64>) {
    let ground = ("ground".to_string(), Mat3::identity());
    let Some(m) = marker else { return ground };
    let R = at.marker(m).R_GM;
    let parallel = (0..3).all(|k| R.column(k).0[k].abs() > 1.0 - SAME_DIRECTION);
    if parallel {
        ground
    } else {
        (format!("MARKER/{}", at.marker_id(m)), R)
    }
}
