//! Directions and axes: what a row fixes, as data, and as a sentence writes it.

use super::quantity::point;
use crate::model::ElementKind;
use crate::scene::equations::Equations;
use crate::scene::{RowKind, Scene};
use crate::space::{Mat3, Vec3};
use std::fmt;

/// Two directions are the same when their cosine differs from one by less than this.
pub(in crate::analysis) const SAME_DIRECTION: f64 = 1e-9;
/// Forces and torques of a unit multiplier below this are rounding.
const NO_ACTION: f64 = 1e-9;

/// An axis in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    /// an axis of ground: 0 x, 1 y, 2 z
    Ground(usize),
    /// an axis of a marker, whose number the user gave: 0 x, 1 y, 2 z
    Marker(u32, usize),
    /// none of these: a unit vector in ground axes
    Vector(Vec3<f64>),
}

impl Axis {
    /// Finds the axis along a vector in ground: ground's, one of the `frames` (numbers of markers,
    /// orientations), or none of these.
    pub fn along(vector: Vec3<f64>, frames: &[(u32, Mat3<f64>)]) -> Self {
        let unit = vector.times(1.0 / vector.norm());
        let parallel = |frame: &Mat3<f64>| {
            (0..3).find(|&k| frame.column(k).dot(unit).abs() > 1.0 - SAME_DIRECTION)
        };
        if let Some(k) = parallel(&Mat3::identity()) {
            return Axis::Ground(k);
        }
        let of = |(marker, frame): &(u32, Mat3<f64>)| Some(Axis::Marker(*marker, parallel(frame)?));
        frames.iter().find_map(of).unwrap_or(Axis::Vector(unit))
    }
}

/// The letters of three axes.
pub(in crate::analysis) const AXIS_LETTERS: [&str; 3] = ["X", "Y", "Z"];

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Axis::Ground(k) => write!(f, "ground {}", AXIS_LETTERS[k]),
            Axis::Marker(id, k) => {
                let marker = ElementKind::Marker.id(id);
                write!(f, "{} of {marker}", AXIS_LETTERS[k])
            }
            Axis::Vector(unit) => f.write_str(&point(unit)),
        }
    }
}

/// The motion that a row forbids.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Direction {
    /// along an axis
    Translation(Axis),
    /// about an axis
    Rotation(Axis),
    /// a sum of this many displacements, as of a COUPLER
    Sum(usize),
    /// some combination of coordinates, as of a GCON
    Combination,
    /// none: the row does not change with any motion at this position
    Nothing,
}

impl Direction {
    /// Finds the motion that a row forbids at an instant.
    pub(in crate::analysis) fn of_row(scene: &Scene, at: &Equations<'_, f64>, row: usize) -> Self {
        let value = at.row(row);
        if let RowKind::Displacements(sum) = &scene.rows[row].kind {
            return Direction::Sum(sum.terms.len());
        }
        let Some((_, action)) = value.actions.first() else {
            return Direction::Combination;
        };
        let frame = |(m, _): &(usize, _)| (scene.markers[*m].id, at.marker(*m).R_GM);
        let frames: Vec<_> = value.actions.iter().rev().map(frame).collect();
        if action.force.norm() > NO_ACTION {
            Direction::Translation(Axis::along(action.force, &frames))
        } else if action.torque.norm() > NO_ACTION {
            Direction::Rotation(Axis::along(action.torque, &frames))
        } else {
            Direction::Nothing
        }
    }

    /// Writes which way it leads, without what kind of motion it is: "along ground X", "about
    /// ground X".
    pub(in crate::analysis) fn way(&self) -> String {
        match self {
            Direction::Translation(axis) => format!("along {axis}"),
            Direction::Rotation(axis) => format!("about {axis}"),
            Direction::Sum(_) | Direction::Combination | Direction::Nothing => self.to_string(),
        }
    }

    /// Tells whether it is a rotation.
    pub fn is_rotation(&self) -> bool {
        matches!(self, Direction::Rotation(_))
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Direction::Translation(axis) => write!(f, "translation along {axis}"),
            Direction::Rotation(axis) => write!(f, "rotation about {axis}"),
            Direction::Sum(n) => write!(f, "a sum of {n} displacements"),
            Direction::Combination => f.write_str("a combination of coordinates"),
            Direction::Nothing => f.write_str("nothing at this position"),
        }
    }
}
