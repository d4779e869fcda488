//! Solids: surfaces of flat faces, and the shapes that they are built from.
//!
//! A [`Solid`] is drawn by everybody: as triangles with normals in three dimensions, as sorted
//! faces on paper. Faces are convex and turn counter-clockwise as seen from outside. Lengths are in
//! the units of the model.

use crate::space::{Frame, Mat3, Vec3, rotation};
use std::f64::consts::TAU;

/// Sides of the polygon that stands for a circle.
pub const SIDES: usize = 36;

/// A surface of flat faces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solid {
    /// corners
    pub points: Vec<[f64; 3]>,
    /// indices of the corners of each face, counter-clockwise from outside
    pub faces: Vec<Vec<u32>>,
    /// whether a face belongs to a curved surface, which is drawn without edges
    pub smooth: Vec<bool>,
}

/// A solid as triangles, each corner with the normal of the surface there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    /// corners
    pub points: Vec<[f32; 3]>,
    /// unit normals, one per corner
    pub normals: Vec<[f32; 3]>,
    /// three corners each
    pub triangles: Vec<[u32; 3]>,
}

impl Solid {
    /// Returns a box between two corners.
    pub fn block(low: [f64; 3], high: [f64; 3]) -> Self {
        let corner = |k: usize| [0, 1, 2].map(|c| if k >> c & 1 == 0 { low[c] } else { high[c] });
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        Self {
            points: (0..8).map(corner).collect(),
            faces: faces.map(|f| f.to_vec()).to_vec(),
            smooth: vec![false; 6],
        }
    }

    /// Returns the solid of a profile that turns about z: points (radius, z) from the bottom to
    /// the top of its outside.
    pub fn turned(profile: &[(f64, f64)], sides: usize, smooth: bool) -> Self {
        let mut solid = Self::default();
        let ring = |k: usize, s: usize| (k * sides + s % sides) as u32;
        for &(radius, z) in profile {
            solid.points.extend((0..sides).map(|s| {
                let (sin, cos) = (TAU * s as f64 / sides as f64).sin_cos();
                [radius * cos, radius * sin, z]
            }));
        }
        for (k, pair) in profile.windows(2).enumerate() {
            for s in 0..sides {
                let face: Vec<u32> = match (pair[0].0 == 0.0, pair[1].0 == 0.0) {
                    (true, true) => continue,
                    (true, false) => vec![ring(k, s), ring(k + 1, s + 1), ring(k + 1, s)],
                    (false, true) => vec![ring(k, s), ring(k, s + 1), ring(k + 1, s)],
                    (false, false) => {
                        let upper = [ring(k + 1, s + 1), ring(k + 1, s)];
                        [[ring(k, s), ring(k, s + 1)], upper].concat()
                    }
                };
                solid.push(face, smooth);
            }
        }
        let last = profile.len().saturating_sub(1);
        for (k, up) in [(0, false), (last, true)] {
            if profile.get(k).is_some_and(|p| p.0 > 0.0) {
                let mut lid: Vec<u32> = (0..sides).map(|s| ring(k, s)).collect();
                if !up {
                    lid.reverse();
                }
                solid.push(lid, false);
            }
        }
        solid
    }

    /// Returns a cylinder or frustum about z between two heights.
    pub fn frustum(bottom: f64, top: f64, z: [f64; 2]) -> Self {
        let [low, high] = if z[0] <= z[1] {
            [(bottom, z[0]), (top, z[1])]
        } else {
            [(top, z[1]), (bottom, z[0])]
        };
        Self::turned(&[low, high], SIDES, true)
    }

    /// Returns an ellipsoid about the origin, of semi-axes along x, y, z.
    pub fn ellipsoid(semi: [f64; 3]) -> Self {
        let rings = SIDES / 2;
        let profile: Vec<(f64, f64)> = (0..=rings)
            .map(|k| match k {
                0 => (0.0, -1.0),
                k if k == rings => (0.0, 1.0),
                k => {
                    let (sin, cos) = (0.5 * TAU * k as f64 / rings as f64).sin_cos();
                    (sin, -cos)
                }
            })
            .collect();
        let mut ball = Self::turned(&profile, SIDES, true);
        for p in &mut ball.points {
            *p = [0, 1, 2].map(|c| p[c] * semi[c]);
        }
        ball
    }

    /// Returns a rod along z from the origin on, with round ends.
    pub fn capsule(radius: f64, length: f64) -> Self {
        const SIDES_OF_ROD: usize = 14;
        const RINGS_OF_END: u32 = 4;
        let quarter = |k: u32| (0.25 * TAU * f64::from(k) / f64::from(RINGS_OF_END)).sin_cos();
        let lower = (0..=RINGS_OF_END).map(|k| match k {
            0 => (0.0, -radius),
            k => (radius * quarter(k).0, -radius * quarter(k).1),
        });
        let upper = (0..=RINGS_OF_END).rev().map(|k| match k {
            0 => (0.0, length + radius),
            k => (radius * quarter(k).0, length + radius * quarter(k).1),
        });
        let profile: Vec<(f64, f64)> = lower.chain(upper).collect();
        Self::turned(&profile, SIDES_OF_ROD, true)
    }

    /// Returns a torus about z.
    pub fn torus(ring: f64, tube: f64) -> Self {
        let circle: Vec<[f64; 3]> = (0..SIDES)
            .map(|k| {
                let (sin, cos) = (TAU * k as f64 / SIDES as f64).sin_cos();
                [ring * cos, ring * sin, 0.0]
            })
            .collect();
        Self::tube(&circle, true, tube, 14)
    }

    /// Returns a tube along a line of points; one that is not closed has flat ends.
    pub fn tube(path: &[[f64; 3]], closed: bool, radius: f64, sides: usize) -> Self {
        let mut solid = Self::default();
        let n = path.len();
        if n < 2 {
            return solid;
        }
        let at = |k: usize| Vec3(path[k % n]);
        let mut across = None;
        for k in 0..n {
            let before = if k > 0 || closed {
                at(k + n - 1)
            } else {
                at(k)
            };
            let after = if k + 1 < n || closed {
                at(k + 1)
            } else {
                at(k)
            };
            let along = after - before;
            let frame = match across {
                Some(x) => rotation::from_z_and_x(along, x),
                None => None,
            };
            let frame = frame.unwrap_or_else(|| along_z(along));
            across = Some(frame.column(0));
            solid.points.extend((0..sides).map(|s| {
                let (sin, cos) = (TAU * s as f64 / sides as f64).sin_cos();
                (at(k) + frame.apply(Vec3([radius * cos, radius * sin, 0.0]))).0
            }));
        }
        let ring = |k: usize, s: usize| (k % n * sides + s % sides) as u32;
        for k in 0..(if closed { n } else { n - 1 }) {
            for s in 0..sides {
                let upper = [ring(k + 1, s + 1), ring(k + 1, s)];
                solid.push([[ring(k, s), ring(k, s + 1)], upper].concat(), true);
            }
        }
        if !closed {
            solid.push((0..sides).rev().map(|s| ring(0, s)).collect(), false);
            solid.push((0..sides).map(|s| ring(n - 1, s)).collect(), false);
        }
        solid
    }

    /// Returns a prism about z over a convex polygon of points (x, y), counter-clockwise.
    pub fn prism(outline: &[[f64; 2]], z: [f64; 2]) -> Self {
        let n = outline.len() as u32;
        let mut solid = Self::default();
        for z in z {
            solid.points.extend(outline.iter().map(|p| [p[0], p[1], z]));
        }
        for k in 0..n {
            let next = (k + 1) % n;
            solid.push(vec![k, next, n + next, n + k], false);
        }
        solid.push((0..n).rev().collect(), false);
        solid.push((n..2 * n).collect(), false);
        solid
    }

    /// Returns one flat face with two sides.
    pub fn sheet(outline: &[[f64; 3]]) -> Self {
        let n = outline.len() as u32;
        Self {
            points: outline.to_vec(),
            faces: vec![(0..n).collect(), (0..n).rev().collect()],
            smooth: vec![false; 2],
        }
    }

    /// Returns a toothed ring about z between two radii: a gear wheel without its middle.
    pub fn gear(inner: f64, pitch: f64, thickness: f64, teeth: usize) -> Self {
        let (half, depth) = (thickness / 2.0, 0.05 * pitch);
        let radius = |k: usize| pitch + if k % 4 < 2 { depth } else { -depth };
        let n = 4 * teeth;
        let mut solid = Self::default();
        let at = |k: usize| TAU * (k as f64 + 0.5 * (k % 2) as f64) / n as f64;
        for z in [-half, half] {
            for of in [&|_| inner, &radius as &dyn Fn(usize) -> f64] {
                solid.points.extend((0..n).map(|k| {
                    let (sin, cos) = at(k).sin_cos();
                    [of(k) * cos, of(k) * sin, z]
                }));
            }
        }
        let corner = |ring: usize, k: usize| (ring * n + k % n) as u32;
        for k in 0..n {
            for (a, b) in [(1, 0), (2, 3), (3, 1), (0, 2)] {
                let face = [
                    corner(a, k),
                    corner(b, k),
                    corner(b, k + 1),
                    corner(a, k + 1),
                ];
                solid.push(face.to_vec(), false);
            }
        }
        solid
    }

    fn push(&mut self, face: Vec<u32>, smooth: bool) {
        self.faces.push(face);
        self.smooth.push(smooth);
    }

    /// Returns the same solid, placed by a frame.
    pub fn placed(mut self, frame: &Frame<f64>) -> Self {
        for p in &mut self.points {
            *p = frame.point(Vec3(*p)).0;
        }
        self
    }

    /// Adds another solid.
    pub fn join(&mut self, other: Solid) {
        let first = self.points.len() as u32;
        self.points.extend(other.points);
        let faces = other.faces.into_iter();
        (self.faces).extend(faces.map(|f| f.into_iter().map(|k| k + first).collect()));
        self.smooth.extend(other.smooth);
    }

    /// Returns the outward normal of a face, of the length of twice its area; summed over its
    /// corners (Newell), so that no corner need be a good one.
    pub fn normal(&self, face: usize) -> Vec3<f64> {
        let corners = &self.faces[face];
        let at = |k: usize| Vec3(self.points[corners[k % corners.len()] as usize]);
        (0..corners.len()).fold(Vec3::zero(), |sum, k| sum + at(k).cross(at(k + 1)))
    }

    /// Returns the triangles, with normals that are smooth within curved surfaces.
    pub fn triangles(&self) -> Triangles {
        let unit = |n: Vec3<f64>| {
            let length = n.norm();
            if length > 0.0 {
                n.times(1.0 / length)
            } else {
                Vec3::axis(2)
            }
        };
        let mut around = vec![Vec3::zero(); self.points.len()];
        for (f, face) in self
            .faces
            .iter()
            .enumerate()
            .filter(|(f, _)| self.smooth[*f])
        {
            let normal = self.normal(f);
            face.iter().for_each(|&k| around[k as usize] += normal);
        }
        let mut out = Triangles::default();
        let mut shared = vec![None; self.points.len()];
        let single = |v: [f64; 3]| v.map(|x| x as f32);
        for (f, face) in self.faces.iter().enumerate() {
            let flat = unit(self.normal(f));
            let corners: Vec<u32> = face
                .iter()
                .map(|&k| {
                    let k = k as usize;
                    if let Some(at) = shared[k].filter(|_| self.smooth[f]) {
                        return at;
                    }
                    let at = out.points.len() as u32;
                    out.points.push(single(self.points[k]));
                    let normal = if self.smooth[f] {
                        unit(around[k])
                    } else {
                        flat
                    };
                    out.normals.push(single(normal.0));
                    if self.smooth[f] {
                        shared[k] = Some(at);
                    }
                    at
                })
                .collect();
            let fan = corners.windows(2).skip(1);
            (out.triangles).extend(fan.map(|pair| [corners[0], pair[0], pair[1]]));
        }
        out
    }
}

/// Returns a rotation whose z has a direction; of nothing the identity.
pub fn along_z(z: Vec3<f64>) -> Mat3<f64> {
    let smallest = (0..3).fold(0, |best, k| {
        if z.0[k].abs() < z.0[best].abs() {
            k
        } else {
            best
        }
    });
    rotation::from_z_and_x(z, Vec3::axis(smallest)).unwrap_or_else(Mat3::identity)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Volume by the divergence theorem: positive only where faces look outwards.
    fn volume(solid: &Solid) -> f64 {
        let of = |f: usize| Vec3(solid.points[solid.faces[f][0] as usize]).dot(solid.normal(f));
        (0..solid.faces.len()).map(of).sum::<f64>() / 6.0
    }

    #[test]
    fn faces_look_outwards_and_enclose_the_volume() {
        let ring = 0.5 * SIDES as f64 * (TAU / SIDES as f64).sin();
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let cases = [
            ("block", Solid::block([-1.0; 3], [1.0, 2.0, 3.0]), 24.0),
            (
                "cylinder",
                Solid::frustum(2.0, 2.0, [1.0, 4.0]),
                12.0 * ring,
            ),
            (
                "downwards",
                Solid::frustum(2.0, 2.0, [1.0, -2.0]),
                12.0 * ring,
            ),
            ("cone", Solid::frustum(3.0, 0.0, [0.0, 1.0]), 3.0 * ring),
            ("prism", Solid::prism(&square, [-1.0, 1.0]), 8.0),
        ];
        for (name, solid, expected) in cases {
            let found = volume(&solid);
            assert!((found / expected - 1.0).abs() < 1e-12, "{name}: {found}");
        }
        for (name, solid) in [
            ("ellipsoid", Solid::ellipsoid([1.0, 2.0, 3.0])),
            ("torus", Solid::torus(3.0, 1.0)),
            ("gear", Solid::gear(1.0, 3.0, 0.5, 12)),
        ] {
            assert!(volume(&solid) > 0.0, "{name}");
        }
        let ball = volume(&Solid::ellipsoid([1.0, 2.0, 3.0])) / (8.0 * std::f64::consts::PI);
        assert!((0.95..1.0).contains(&ball), "{ball}");
    }

    #[test]
    fn every_edge_belongs_to_two_faces_that_run_along_it_in_turn() {
        let path = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5]];
        for (name, solid) in [
            ("block", Solid::block([0.0; 3], [1.0; 3])),
            ("frustum", Solid::frustum(1.0, 0.5, [0.0, 1.0])),
            ("torus", Solid::torus(3.0, 1.0)),
            ("tube", Solid::tube(&path, false, 0.1, 8)),
            ("gear", Solid::gear(1.0, 3.0, 0.5, 12)),
        ] {
            let mut edges = std::collections::BTreeMap::new();
            for face in &solid.faces {
                for k in 0..face.len() {
                    let (a, b) = (face[k], face[(k + 1) % face.len()]);
                    *edges.entry((a, b)).or_insert(0) += 1;
                }
            }
            let closed =
                |(&(a, b), &n): (&(u32, u32), &i32)| n == 1 && edges.get(&(b, a)) == Some(&1);
            assert!(edges.iter().all(closed), "{name}");
        }
    }

    #[test]
    fn normals_of_triangles_have_unit_length() {
        let solid = Solid::ellipsoid([1.0, 2.0, 0.5]);
        let triangles = solid.triangles();
        assert_eq!(triangles.points.len(), triangles.normals.len());
        for n in &triangles.normals {
            let length = n.iter().map(|x| x * x).sum::<f32>().sqrt();
            assert!((length - 1.0).abs() < 1e-5);
        }
    }
}
