//! The places at which two faces that look at each other touch.

use super::super::TOUCHES;
use super::Query;
use super::body::Face;
use super::flat::{Flat, crossing, distance, edges, is_within, nearest};
use parry3d_f64::math::{Pose, Vector};

/// Points nearer than this part of the smaller solid share.
const NEIGHBOURS: f64 = 0.02;
/// Points nearer than this part of it are one.
const SAME: f64 = 1e-9;
/// Points of faces that touch elsewhere count up to this part of the smaller solid above the other one.
const ALOFT: f64 = 0.05;
/// Where the numbers of J's features begin: a hull has fewer.
const OTHER: usize = 1 << 20;
/// Edges of faces at a smaller angle cross in what is no corner of the overlap.
const BLUNT: f64 = 0.1;

impl Query {
    /// The places of touch: on I's face, on J's face (J's frame), and the share; the deepest first, at most [`TOUCHES`].
    pub(super) fn points(&self, pose: &Pose, n: Vector) -> Vec<[Vector; 3]> {
        let mut i = self.i.face(pose.inverse_transform_vector(-n));
        for p in &mut i.outline {
            *p = pose.transform_point(*p);
        }
        i.normal = i.normal.map(|m| pose.transform_vector(m));
        let j = self.j.face(n);
        let (e, f) = n.any_orthonormal_pair();
        let (flat_i, flat_j) = (i.laid(e, f), j.laid(e, f));
        let size = self.i.size[0].min(self.j.size[0]);
        let near = SAME * size;
        // where, how much, which
        let mut places: Vec<(Flat, f64, usize)> = Vec::new();
        let both = [(&i, &flat_i, &flat_j, 0), (&j, &flat_j, &flat_i, OTHER)];
        for (face, flat, other, first) in both {
            let corners = flat.iter().zip(&face.ids).step_by(face.stride);
            places.extend(
                corners
                    .filter(|(p, _)| is_within(**p, other, near))
                    .map(|(p, id)| (*p, 1.0, first + id)),
            );
        }
        for (p, q) in edges(&flat_i) {
            for (r, s) in edges(&flat_j) {
                places.extend(crossing(p, q, r, s).map(|(at, sine)| {
                    let blunt = (1.0 - (sine / BLUNT).powi(2)).max(0.0).powi(2);
                    let weight = match [flat_i.len(), flat_j.len()] {
                        // two lines: as many points as where they lie along each other
                        [2, 2] => 1.0 + blunt,
                        [2, _] | [_, 2] => 1.0,
                        _ => 1.0 - blunt,
                    };
                    (at, weight, 2 * OTHER)
                }));
            }
        }
        let mut found: Vec<(Flat, f64, [f64; 2], usize)> = Vec::new();
        for (at, weight, id) in places {
            let same = |other: &(Flat, f64, [f64; 2], usize)| distance(other.0, at) <= near;
            if found.iter().any(same) {
                continue;
            }
            let heights = [
                height(&i, &flat_i, at, (n, e, f)),
                height(&j, &flat_j, at, (n, e, f)),
            ];
            if heights.iter().all(|h| h.is_finite()) {
                found.push((at, weight, heights, id));
            }
        }
        if found.is_empty() {
            // curved sides beside each other by rounding
            let Some([p, q]) = nearest(&flat_i, &flat_j) else {
                return Vec::new();
            };
            let at = [0, 1].map(|k| 0.5 * (p[k] + q[k]));
            let on_i = height(&i, &flat_i, p, (n, e, f));
            let on_j = height(&j, &flat_j, q, (n, e, f));
            let base = e * at[0] + f * at[1];
            return vec![[base + n * on_i, base + n * on_j, Vector::ONE]];
        }
        let reach = NEIGHBOURS * size;
        let crowd = |at: Flat| -> f64 {
            let near = |other: &(Flat, f64, [f64; 2], usize)| {
                let part = 1.0 - (distance(other.0, at) / reach).powi(2);
                other.1 * part.max(0.0).powi(2)
            };
            found.iter().map(near).sum()
        };
        let touch = |&(at, weight, [on_i, on_j], _): &(Flat, f64, [f64; 2], usize)| {
            let base = e * at[0] + f * at[1];
            let share = Vector::splat(weight / crowd(at).max(1.0));
            [base + n * on_i, base + n * on_j, share]
        };
        // the deepest, in the order of their features, which two equally deep ones do not exchange, and which is the same whichever of two faces
        // beside an edge looks at the other solid: what reads them is differentiated. For the same reason those of one face that are far off are left
        // alone: those of the other face are elsewhere.
        let mut deepest: Vec<usize> = (0..found.len()).collect();
        let depth = |k: usize| found[k].2[1] - found[k].2[0];
        deepest.sort_by(|&a, &b| depth(b).total_cmp(&depth(a)));
        deepest.truncate(TOUCHES);
        let first = deepest[0];
        deepest.retain(|&k| k == first || depth(k) > -ALOFT * size);
        deepest.sort_by_key(|&k| (found[k].3, k));
        deepest.into_iter().map(|k| touch(&found[k])).collect()
    }
}

/// How far along n a face is at a place.
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
