//! Marks that tell directions and distances: axes of markers, action vectors of joints, dimensions.
//!
//! A triad shows x, y and z of a marker. An action vector shows the axis of a joint: I turns about
//! it, or slides along it, relative to J. A dimension is the distance of two markers; its value
//! changes as the mechanism moves. Everything here stands in the frames of bodies.

use super::bodies::Anchor;
use super::{Bodies, Track};
use crate::diagnostic::{Diagnostic, Span};
use crate::model::{ElementId, ElementKind, Model};
use crate::space::Vec3;

/// The axes of a marker.
#[derive(Clone, Copy, Debug)]
pub struct Triad {
    /// the marker
    pub element: ElementId,
    /// its frame in its body
    pub at: Anchor,
}

/// The direction of the displacement of a joint.
#[derive(Clone, Copy, Debug)]
pub struct ActionVector {
    /// the joint
    pub element: ElementId,
    /// the frame of its marker J; its z is the direction
    pub at: Anchor,
}

/// The numbers of two markers whose distance is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    /// the marker that it is measured to
    pub i: u32,
    /// the marker that it is measured from
    pub j: u32,
}

impl Pair {
    /// Reads two markers of a model, `20,10` or `slider.cm,MARKER/10`.
    ///
    /// # Errors
    /// A text of another form, and names of no marker or of several, at their places.
    pub fn of(model: &Model, text: &str) -> Result<Self, Diagnostic> {
        let marker = |start: usize, end: usize| {
            let found = model.find_of(&[ElementKind::Marker], &text[start..end]);
            let id = found.map_err(|d| d.at(text, Span::new(start, end)))?;
            Ok::<u32, Diagnostic>(id.number)
        };
        let pair = |at: usize| {
            let (i, j) = (marker(0, at)?, marker(at + 1, text.len())?);
            Ok(Self { i, j })
        };
        // names may have commas
        let mut told = None;
        for (at, _) in text.match_indices(',').take(MOST_COMMAS) {
            match pair(at) {
                Ok(pair) => return Ok(pair),
                Err(d) => told = told.or(Some(d)),
            }
        }
        Err(told.unwrap_or_else(|| {
            let what = format!("`{text}` is not two markers, as 20,10");
            Diagnostic::error("unknown_marker", what)
        }))
    }
}

/// Commas of a text at which two markers may part.
const MOST_COMMAS: usize = 8;

/// The distance of two markers, shown as a line with its value.
#[derive(Clone, Copy, Debug)]
pub struct Dimension {
    /// the markers
    pub markers: Pair,
    /// their frames, in the order of the markers
    pub ends: [Anchor; 2],
}

impl Dimension {
    /// Returns the dimension between two markers.
    ///
    /// # Errors
    /// When one of them does not exist, or has no place of its own because it floats.
    pub fn new(bodies: &Bodies, markers: Pair) -> Result<Self, Diagnostic> {
        let place = |number: u32| {
            bodies.marker(number).ok_or_else(|| {
                let marker = ElementKind::Marker.id(number);
                let what = format!("{marker} has no place that a dimension can begin at");
                let near = bodies.markers().map(|(n, _)| n);
                let near = near.min_by_key(|n| n.abs_diff(number));
                let near = near.map(|n| ElementKind::Marker.id(n));
                let advice = near.map_or_else(
                    || "the model has no marker with a place of its own".to_owned(),
                    |near| format!("the nearest number with a place is {near}"),
                );
                Diagnostic::error("unknown_marker", what).help(advice)
            })
        };
        let ends = [place(markers.i)?, place(markers.j)?];
        Ok(Self { markers, ends })
    }

    /// Returns where its ends are at a row, in ground.
    pub fn places(&self, bodies: &Bodies, track: &Track, row: usize) -> [Vec3<f64>; 2] {
        let at = |a: Anchor| track.frame(bodies, a.body, row).point(a.frame.position);
        self.ends.map(at)
    }
}

/// Returns the axes of all markers that have a place.
pub(super) fn triads(bodies: &Bodies) -> Vec<Triad> {
    let triad = |(number, at)| Triad {
        element: ElementKind::Marker.id(number),
        at,
    };
    bodies.markers().map(triad).collect()
}

/// Returns the action vectors of the joints that act.
pub(super) fn action_vectors(model: &Model, bodies: &Bodies) -> Vec<ActionVector> {
    let vector = |(&number, joint): (&u32, &crate::model::Joint)| {
        let element = ElementKind::Joint.id(number);
        let displacements = joint.kind.displacements();
        let acts = displacements.turns() || displacements.slides();
        let at = bodies.marker(joint.j)?;
        (acts && !model.inactive.contains(&element)).then_some(ActionVector { element, at })
    };
    model.joints.iter().filter_map(vector).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_is_two_markers_in_either_spelling() {
        let model = "PAIR\nPART/1, GROUND\nMARKER/10, PART=1\nMARKER/20, PART=1\nEND\n";
        let model = Model::from_text(model).unwrap();
        let pair = |text: &str| Pair::of(&model, text).map(|p| (p.i, p.j)).ok();
        assert_eq!(pair("20,10"), Some((20, 10)));
        assert_eq!(pair("MARKER/20, 10"), Some((20, 10)));
        for wrong in ["20", "20,", "PART/2,10", "20,10,30", "a,b"] {
            assert_eq!(pair(wrong), None, "{wrong}");
        }
    }
}
