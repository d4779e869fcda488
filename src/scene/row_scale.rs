//! Scales of rows: residuals of lengths, angles and formulas are compared as parts of one.

use super::{RowKind, Scene};
use crate::space::Vec3;

/// Part of the distance from the origin below which a diameter is its rounding.
const EXTENT_OF_ROUNDING: f64 = 1e-13;

impl Scene {
    /// Returns the residual of a row that counts as one: the reach of its mechanism for lengths, a
    /// radian for angles.
    pub fn row_scale(&self, r: usize) -> f64 {
        let link = match &self.rows[r].kind {
            RowKind::Markers { i, j, .. } => self.markers[*i].link.or(self.markers[*j].link),
            RowKind::Displacements(sum) => (sum.terms.iter())
                .find_map(|(_, d)| self.markers[d.i].link.or(self.markers[d.j].link)),
            RowKind::Cam { cam, .. } => {
                let cam = &self.cams[*cam];
                self.markers[cam.i].link.or(self.markers[cam.j].link)
            }
            RowKind::Formula { .. } => None,
        };
        let reach = link
            .and_then(|l| self.memberships.get(l))
            .map_or(self.length, |of| of.reach);
        self.row_scale_at(r, reach)
    }

    /// Returns the same for a mechanism of this size.
    pub fn row_scale_at(&self, r: usize, size: f64) -> f64 {
        match &self.rows[r].kind {
            RowKind::Markers { law, .. } if law.is_length() => size,
            RowKind::Markers { .. } => 1.0,
            RowKind::Displacements(sum) => sum.scale(size),
            RowKind::Formula { scale, .. } => *scale,
            RowKind::Cam { .. } => size,
        }
    }

    /// Returns the diameter of the places of markers as the dataset has them, 0 where that is
    /// rounding of how far they are from the origin. Those of ground do not count.
    pub(in crate::scene) fn diameter(&self, markers: impl Iterator<Item = usize>) -> f64 {
        let moving = markers.filter(|&m| self.markers[m].part.is_some());
        let points = moving.map(|m| self.drawn(m).position);
        let points = points.filter(|p| p.norm().is_finite());
        let points: Vec<Vec3<f64>> = points.collect();
        // about the middle, so that a model that is turned keeps its size
        let share = 1.0 / points.len().max(1) as f64;
        let middle = (points.iter()).fold(Vec3::zero(), |sum, p| sum + p.times(share));
        let farthest = |from: Vec3<f64>| {
            let ways = points.iter().map(|p| (*p - from).norm());
            ways.fold(0.0, f64::max)
        };
        let diameter = 2.0 * farthest(middle);
        // the rounding of places far away is no extent
        let noise = EXTENT_OF_ROUNDING * farthest(Vec3::zero());
        if diameter > noise { diameter } else { 0.0 }
    }

    /// Returns the size of a mechanism of these parts and markers, as the dataset places it: its
    /// diameter, else its largest radius of gyration, else how far it is from the origin; 1 where
    /// it has none of these; and how far it reaches from the origin, at least its size.
    pub fn size_and_reach(&self, parts: &[usize], markers: &[usize]) -> [f64; 2] {
        let diameter = self.diameter(markers.iter().copied());
        let gyration = parts.iter().filter_map(|&p| {
            let link = &self.links[self.parts[p].link?];
            let [x, y, z] = [0, 1, 2].map(|k| link.inertia.0[k][k]);
            Some((x.max(y).max(z) / link.mass).sqrt())
        });
        let reach = (parts.iter()).map(|&p| self.parts[p].initial.position.norm());
        let largest =
            |all: &mut dyn Iterator<Item = f64>| all.filter(|x| x.is_finite()).fold(0.0, f64::max);
        let sizes = [
            diameter,
            largest(&mut { gyration }),
            largest(&mut { reach }),
            1.0,
        ];
        let size = sizes.into_iter().find(|&x| x > 0.0).unwrap_or(1.0);
        let places = markers.iter().map(|&m| self.drawn(m).position.norm());
        [size, largest(&mut { places }).max(size)]
    }

    /// Returns the displacement of a motion that counts as one: a radian, or the size of the
    /// mechanism.
    pub fn unit_of_motion(&self, motion: usize) -> f64 {
        if self.drives_an_angle(motion) {
            1.0
        } else {
            self.length
        }
    }
}
