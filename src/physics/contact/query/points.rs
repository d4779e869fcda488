//! The touches of two faces that look at each other.

use super::super::TOUCHES;
use super::Query;
use super::body::Face;
use super::flat::{Flat, crossing, distance, edges, is_within, nearest};
use parry3d_f64::math::{Pose, Vector};

/// Distance, as a part of the smaller solid, below which points share.
const SHARING_DISTANCE: f64 = 0.02;
/// Distance, as a part of the smaller solid, below which points are one.
const SAME_DISTANCE: f64 = 1e-9;
/// Height above the other face, as a part of the smaller solid, up to which points count beside a
/// deeper touch.
const LARGEST_GAP: f64 = 0.05;
/// First number of J's features; a hull has fewer.
const FIRST_OF_J: usize = 1 << 20;
/// Sine of the angle below which the intersection of two edges fades as a corner of the overlap.
const BLUNT_SINE: f64 = 0.1;

/// A point at which two faces may touch.
#[derive(Clone, Copy)]
struct Place {
    /// in the plane perpendicular to n
    at: Flat,
    /// its weight before it shares with others
    weight: f64,
    /// number of its feature
    id: usize,
    /// of I's and of J's face along n, in length units
    heights: [f64; 2],
}

/// The two faces in J's frame, with their projections.
struct Faces {
    /// I's face that looks at J
    i: Face,
    /// J's face that looks at I
    j: Face,
    /// direction from J's solid to I's
    n: Vector,
    /// axes of the plane perpendicular to n
    axes: [Vector; 2],
    /// projected outline of I's face
    flat_i: Vec<Flat>,
    /// projected outline of J's face
    flat_j: Vec<Flat>,
}

impl Faces {
    /// Finds the faces of two bodies for a pose of I's, and projects them along n.
    fn new(query: &Query, pose: &Pose, n: Vector) -> Self {
        let mut i = query.i.face(pose.inverse_transform_vector(-n));
        for p in &mut i.outline {
            *p = pose.transform_point(*p);
        }
        i.normal = i.normal.map(|m| pose.transform_vector(m));
        let j = query.j.face(n);
        let (e, f) = n.any_orthonormal_pair();
        Faces {
            flat_i: i.laid(e, f),
            flat_j: j.laid(e, f),
            i,
            j,
            n,
            axes: [e, f],
        }
    }

    /// Returns the heights of I's and of J's face along n at a point of the plane.
    fn heights(&self, at: Flat) -> [f64; 2] {
        let axes = (self.n, self.axes[0], self.axes[1]);
        [
            height(&self.i, &self.flat_i, at, axes),
            height(&self.j, &self.flat_j, at, axes),
        ]
    }

    /// Returns the points on both faces, in J's frame, at points of the plane and their heights.
    fn lift(&self, at: Flat, [on_i, on_j]: [f64; 2]) -> [Vector; 2] {
        let base = self.axes[0] * at[0] + self.axes[1] * at[1];
        [base + self.n * on_i, base + self.n * on_j]
    }

    /// Collects the corners of each face within the other, and the intersections of their edges:
    /// point, weight and number of the feature.
    fn overlap(&self, near: f64) -> Vec<(Flat, f64, usize)> {
        let (flat_i, flat_j) = (&self.flat_i, &self.flat_j);
        let mut places = Vec::new();
        let both = [
            (&self.i, flat_i, flat_j, 0),
            (&self.j, flat_j, flat_i, FIRST_OF_J),
        ];
        for (face, flat, other, first) in both {
            let corners = flat.iter().zip(&face.ids).step_by(face.stride);
            places.extend(
                corners
                    .filter(|(p, _)| is_within(**p, other, near))
                    .map(|(p, id)| (*p, 1.0, first + id)),
            );
        }
        for (p, q) in edges(flat_i) {
            for (r, s) in edges(flat_j) {
                places.extend(crossing(p, q, r, s).map(|(at, sine)| {
                    let blunt = (1.0 - (sine / BLUNT_SINE).powi(2)).max(0.0).powi(2);
                    let weight = match [flat_i.len(), flat_j.len()] {
                        // two lines: as many points as where they are parallel
                        [2, 2] => 1.0 + blunt,
                        [2, _] | [_, 2] => 1.0,
                        _ => 1.0 - blunt,
                    };
                    (at, weight, 2 * FIRST_OF_J)
                }));
            }
        }
        places
    }

    /// Returns the points of overlap, one for each place, with finite heights.
    fn places(&self, near: f64) -> Vec<Place> {
        let mut found: Vec<Place> = Vec::new();
        for (at, weight, id) in self.overlap(near) {
            if found.iter().any(|other| distance(other.at, at) <= near) {
                continue;
            }
            let heights = self.heights(at);
            if heights.iter().all(|h| h.is_finite()) {
                found.push(Place {
                    at,
                    weight,
                    id,
                    heights,
                });
            }
        }
        found
    }
}

impl Query {
    /// Returns the touches along n: on I's face, on J's face (J's frame), and the share; in the
    /// order of their features, at most [`TOUCHES`].
    pub(super) fn points(&self, pose: &Pose, n: Vector) -> Vec<[Vector; 3]> {
        let faces = Faces::new(self, pose, n);
        let size = self.i.size[0].min(self.j.size[0]);
        let found = faces.places(SAME_DISTANCE * size);
        if found.is_empty() {
            // curved sides beside each other by rounding
            let Some([p, q]) = nearest(&faces.flat_i, &faces.flat_j) else {
                return Vec::new();
            };
            let at = [0, 1].map(|k| 0.5 * (p[k] + q[k]));
            let heights = [faces.heights(p)[0], faces.heights(q)[1]];
            let [on_i, on_j] = faces.lift(at, heights);
            return vec![[on_i, on_j, Vector::ONE]];
        }

        // divide among points that are near each other
        let sharing = SHARING_DISTANCE * size;
        let crowd = |at: Flat| -> f64 {
            let near = |other: &Place| {
                let part = 1.0 - (distance(other.at, at) / sharing).powi(2);
                other.weight * part.max(0.0).powi(2)
            };
            found.iter().map(near).sum()
        };
        let touch = |place: &Place| {
            let [on_i, on_j] = faces.lift(place.at, place.heights);
            let share = place.weight / crowd(place.at).max(1.0);
            [on_i, on_j, Vector::splat(share)]
        };

        // The result is differentiated. So the deepest are kept in the order of their features,
        // which two equally deep ones do not exchange, and which is the same whichever of two faces
        // beside an edge looks at the other solid; points of one face high above the other solid
        // are left out, since those of the other face would be elsewhere.
        let mut deepest: Vec<usize> = (0..found.len()).collect();
        let depth = |k: usize| found[k].heights[1] - found[k].heights[0];
        deepest.sort_by(|&a, &b| depth(b).total_cmp(&depth(a)));
        deepest.truncate(TOUCHES);
        let first = deepest[0];
        deepest.retain(|&k| k == first || depth(k) > -LARGEST_GAP * size);
        deepest.sort_by_key(|&k| (found[k].id, k));
        deepest.into_iter().map(|k| touch(&found[k])).collect()
    }
}

/// Returns the height of a face along n at a point of the plane.
fn height(face: &Face, flat: &[Flat], at: Flat, (n, e, f): (Vector, Vector, Vector)) -> f64 {
    match (face.normal, flat) {
        (Some(m), _) => {
            let p = face.outline[0];
            (p.dot(m) - at[0] * e.dot(m) - at[1] * f.dot(m)) / n.dot(m)
        }
        (None, &[q, r]) => {
            let along = [r[0] - q[0], r[1] - q[1]];
            let length2 = along[0] * along[0] + along[1] * along[1];
            let u = (along[0] * (at[0] - q[0]) + along[1] * (at[1] - q[1])) / length2;
            let u = if u.is_finite() {
                u.clamp(0.0, 1.0)
            } else {
                0.0
            };
            (face.outline[0] + (face.outline[1] - face.outline[0]) * u).dot(n)
        }
        _ => face.outline[0].dot(n),
    }
}
