//! A convex solid as searches use it: its farthest point in a direction, and the face there.

use super::super::Solid;
use super::flat::Flat;
use super::polytope::Polytope;
use crate::scalar::{Scalar, hypot};
use crate::space::Vec3;
use parry3d_f64::math::Vector;
use parry3d_f64::shape::SupportMap;

/// Points that represent a rim; every sixth is a corner.
pub const RIM_POINTS: usize = 24;

/// A convex solid, prepared for searches.
#[derive(Debug)]
pub struct Body {
    pub(super) solid: Solid,
    /// smallest and largest extent, approximately
    pub(super) size: [f64; 2],
    /// middle of its extents, in its frame
    pub(super) middle: Vector,
    /// the polytope of a hull
    hull: Option<Polytope>,
}

/// The side of a solid that faces some direction: a polygon, a line or a point.
pub(super) struct Face {
    /// points of its outline, in order around it
    pub outline: Vec<Vector>,
    /// numbers of the corners, the same in whichever face of the solid they are
    pub ids: Vec<usize>,
    /// distance of corners among the points of the outline: 1 if each is one
    pub stride: usize,
    /// outward normal; of polygons only
    pub normal: Option<Vector>,
}

impl Face {
    /// Projects the outline onto the plane of two axes.
    pub fn laid(&self, e: Vector, f: Vector) -> Vec<Flat> {
        let outline = self.outline.iter();
        outline.map(|p| [p.dot(e), p.dot(f)]).collect()
    }
}

pub(super) fn vector(p: [f64; 3]) -> Vector {
    Vector::new(p[0], p[1], p[2])
}

/// Returns cosine and sine of the azimuth about z; (1, 0) where there is none.
fn azimuth(dir: Vector) -> (f64, f64) {
    let across = hypot(dir.x, dir.y);
    // a face that looks along z has no direction of its own
    if across <= 1e-12 * dir.z.abs() || across == 0.0 {
        (1.0, 0.0)
    } else {
        (dir.x / across, dir.y / across)
    }
}

impl Body {
    /// Prepares a solid; `None` if it is not convex or not of finite size.
    pub fn new(solid: &Solid) -> Option<Self> {
        let mut hull = None;
        let mut middle = Vector::ZERO;
        let size = match solid {
            Solid::Ball { radius } if *radius > 0.0 => [*radius; 2],
            Solid::Ellipsoid { semi } => extremes(*semi),
            Solid::Box { low, high } => {
                middle = (vector(*low) + vector(*high)) * 0.5;
                extremes([0, 1, 2].map(|k| 0.5 * (high[k] - low[k])))
            }
            Solid::Frustum { z, radius } => {
                middle = Vector::Z * (0.5 * (z[0] + z[1]));
                let wide = radius[0].max(radius[1]);
                extremes([wide, wide, 0.5 * (z[1] - z[0])])
            }
            Solid::Hull(points) => {
                let points: Vec<Vector> = points.iter().map(|&p| vector(p)).collect();
                hull = Some(Polytope::new(&points)?);
                let (low, high) = points.iter().fold(
                    (
                        Vector::splat(f64::INFINITY),
                        Vector::splat(f64::NEG_INFINITY),
                    ),
                    |(low, high), p| (low.min(*p), high.max(*p)),
                );
                middle = (high + low) * 0.5;
                extremes(((high - low) * 0.5).to_array())
            }
            Solid::Ball { .. } | Solid::Plane { .. } | Solid::Torus { .. } => return None,
        };
        let solid = solid.clone();
        Some(Self {
            solid,
            size,
            middle,
            hull,
        })
    }

    /// Returns the signed distance of a point from a hull, negative inside, and the direction in
    /// which it grows; NaN for other solids.
    pub fn distance(&self, p: Vec3<f64>) -> (f64, Vec3<f64>) {
        let (d, n) = match &self.hull {
            Some(hull) => hull.distance(vector(p.0), self.size[1]),
            None => (f64::NAN, Vector::ZERO),
        };
        (d, Vec3([n.x, n.y, n.z]))
    }

    /// Iterates over the outward normals of its faces, except those along its axes.
    pub(super) fn normals(&self) -> impl Iterator<Item = Vector> + '_ {
        let sides = self.hull.iter().flat_map(|hull| &hull.sides);
        sides.map(|side| side.normal)
    }

    /// Returns the edge, or the line on a curved side, that comes nearest to being the farthest in
    /// a direction; none for a solid that is round in all directions.
    pub(super) fn edge(&self, dir: Vector) -> Option<[Vector; 2]> {
        match &self.solid {
            Solid::Box { low, high } => {
                let corner = self.local_support_point(dir);
                let lost = |k: usize| dir[k].abs() * (high[k] - low[k]);
                let axis = (0..3).min_by(|&a, &b| lost(a).total_cmp(&lost(b)))?;
                let (mut p, mut q) = (corner, corner);
                (p[axis], q[axis]) = (low[axis], high[axis]);
                Some([p, q])
            }
            Solid::Frustum { z, radius } => {
                let (c, s) = azimuth(dir);
                let at = |end: usize| Vector::new(radius[end] * c, radius[end] * s, z[end]);
                Some([at(0), at(1)])
            }
            Solid::Hull(_) => self.hull.as_ref()?.edge(dir),
            Solid::Ball { .. }
            | Solid::Ellipsoid { .. }
            | Solid::Plane { .. }
            | Solid::Torus { .. } => None,
        }
    }

    /// Returns the face that looks along a unit vector.
    pub(super) fn face(&self, dir: Vector) -> Face {
        match &self.solid {
            Solid::Box { low, high } => Face::of_box(low, high, dir),
            Solid::Frustum { z, radius } => Face::of_frustum(z, radius, dir),
            Solid::Hull(_) => match self.hull.as_ref().and_then(|h| Some((h, h.side(dir)?))) {
                Some((hull, side)) => Face {
                    outline: side.ids.iter().map(|&k| hull.corners[k]).collect(),
                    ids: side.ids.clone(),
                    stride: 1,
                    normal: Some(side.normal),
                },
                None => Face::of_point(Vector::ZERO),
            },
            Solid::Ball { .. }
            | Solid::Ellipsoid { .. }
            | Solid::Plane { .. }
            | Solid::Torus { .. } => Face::of_point(self.local_support_point(dir)),
        }
    }
}

impl Face {
    /// Returns the face of a single point.
    fn of_point(p: Vector) -> Face {
        Face {
            outline: vec![p],
            ids: vec![0],
            stride: 1,
            normal: None,
        }
    }

    /// Returns the rectangle of a box between two corners that looks along `dir`.
    fn of_box(low: &[f64; 3], high: &[f64; 3], dir: Vector) -> Face {
        let size = dir.abs();
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let up = dir[axis] >= 0.0;
        let corner = |(ka, kb): (bool, bool)| {
            let mut p = Vector::ZERO;
            p[axis] = if up { high } else { low }[axis];
            p[a] = if ka { high } else { low }[a];
            p[b] = if kb { high } else { low }[b];
            p
        };
        let id = |(ka, kb): (bool, bool)| {
            usize::from(up) << axis | usize::from(ka) << a | usize::from(kb) << b
        };
        let corners = [(false, false), (true, false), (true, true), (false, true)];
        let mut normal = Vector::ZERO;
        normal[axis] = if up { 1.0 } else { -1.0 };
        Face {
            outline: corners.map(corner).to_vec(),
            ids: corners.map(id).to_vec(),
            stride: 1,
            normal: Some(normal),
        }
    }

    /// Returns the line on the side of a frustum, or its end, that looks along `dir`.
    fn of_frustum(z: &[f64; 2], radius: &[f64; 2], dir: Vector) -> Face {
        let (c, s) = azimuth(dir);
        let (up, out) = (dir.z, dir.x * c + dir.y * s);
        let (height, taper) = (z[1] - z[0], radius[0] - radius[1]);
        let side = (out * height + up * taper) / hypot(height, taper);
        if side >= up.abs() {
            let at = |end: usize| Vector::new(radius[end] * c, radius[end] * s, z[end]);
            return Face {
                outline: vec![at(0), at(1)],
                ids: vec![0, RIM_POINTS],
                stride: 1,
                normal: None,
            };
        }
        let end = usize::from(up > 0.0);
        if radius[end] == 0.0 {
            return Face::of_point(Vector::new(0.0, 0.0, z[end]));
        }
        let rim = (0..RIM_POINTS).map(|k| {
            let (sk, ck) = Scalar::sin_cos(std::f64::consts::TAU * k as f64 / RIM_POINTS as f64);
            Vector::new(
                radius[end] * (c * ck - s * sk),
                radius[end] * (s * ck + c * sk),
                z[end],
            )
        });
        Face {
            outline: rim.collect(),
            ids: (0..RIM_POINTS).map(|k| k + RIM_POINTS * end).collect(),
            stride: RIM_POINTS / 4,
            normal: Some(Vector::new(0.0, 0.0, up.signum())),
        }
    }
}

/// Returns the smallest and the largest.
fn extremes(x: [f64; 3]) -> [f64; 2] {
    [x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2])]
}

impl SupportMap for Body {
    /// Returns the farthest point along a direction.
    fn local_support_point(&self, dir: Vector) -> Vector {
        match &self.solid {
            Solid::Ball { radius } => dir.normalize_or(Vector::X) * *radius,
            Solid::Ellipsoid { semi } => {
                let a = vector(*semi);
                let stretched = a * dir;
                a * stretched.normalize_or(Vector::X)
            }
            Solid::Box { low, high } => {
                let at = |k: usize| if dir[k] >= 0.0 { high[k] } else { low[k] };
                Vector::new(at(0), at(1), at(2))
            }
            Solid::Frustum { z, radius } => {
                let (c, s) = azimuth(dir);
                let at = |end: usize| Vector::new(radius[end] * c, radius[end] * s, z[end]);
                if at(1).dot(dir) > at(0).dot(dir) {
                    at(1)
                } else {
                    at(0)
                }
            }
            Solid::Hull(_) => {
                (self.hull.as_ref()).map_or(Vector::ZERO, |hull| hull.corners[hull.support(dir)])
            }
            Solid::Plane { .. } | Solid::Torus { .. } => Vector::ZERO,
        }
    }
}
