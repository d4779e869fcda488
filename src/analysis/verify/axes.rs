//! The axes in which reactions are told.

use crate::analysis::direction::SAME_DIRECTION;
use crate::model::{ElementId, ElementKind};
use crate::scene::equations::Equations;
use crate::space::Mat3;
use std::fmt;

/// The axes in which a reaction is told. Prints as `ground` or `MARKER/12`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// those of ground
    Ground,
    /// those of a marker
    Marker(ElementId),
}

impl fmt::Display for Axes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Axes::Ground => f.write_str("ground"),
            Axes::Marker(marker) => marker.fmt(f),
        }
    }
}

/// Returns the axes in which an element's reaction is told: those of its J marker, ground's when
/// they are parallel to these.
pub(super) fn of(at: &Equations<'_, f64>, marker: Option<usize>) -> (Axes, Mat3<f64>) {
    let ground = (Axes::Ground, Mat3::identity());
    let Some(m) = marker else { return ground };
    let R = at.marker(m).R_GM;
    let parallel = (0..3).all(|k| R.column(k).0[k].abs() > 1.0 - SAME_DIRECTION);
    if parallel {
        ground
    } else {
        let marker = ElementKind::Marker.id(at.marker_id(m));
        (Axes::Marker(marker), R)
    }
}
