//! Where two convex solids touch for which there is no formula: box, cylinder, frustum, ellipsoid, hull, ball against each other.
//!
//! 1. **Direction.** parry finds the direction n from J's solid to I's in which they overlap least: for two boxes among the
//!    normals of faces and the products of edges, else by the algorithms of Gilbert, Johnson and Keerthi and of expanding
//!    polytopes. The normals of the nearest faces compete with what these found: the largest gap along its direction is the
//!    true one, so that faces are exact. Where two curved sides look at each other Newton's iteration makes it exact:
//!
//! ```text
//! s(n) = n · (a(−n) − b(n))        a, b: the farthest points of I's and J's solid; at the maximum a − b is parallel to n
//! ```
//!
//! Where an edge is pressed into a curved side it is good to about 1e-7.
//!
//! 2. **Points.** The face of each solid that looks at the other is laid along n onto a plane: the points are the corners of
//!    each that lie within the other, and where their outlines cross. At each the two faces say how deep it is. A rim is a
//!    circle of [`RIM`] points with four corners, one of them the deepest; the side of a cylinder is a line.
//! 3. **Shares.** Points that are near each other share what one point would do, so that the force does not jump
//!    where a corner of the overlap becomes two.
//!
//! Forces, damping and friction are those of every contact (`law.rs`). The points themselves jump where other faces come to look at each
//! other, and the force with them, if they are deep by then.

use super::{Solid, TOUCH_NUMBERS, TOUCHES};
use parry3d_f64::math::{Matrix, Pose, Rotation, Vector};
use parry3d_f64::query::details::contact_support_map_support_map_with_params;
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};
use parry3d_f64::query::sat;
use parry3d_f64::shape::{ConvexPolyhedron, Cuboid, SupportMap};

/// Points of a rim; every sixth is a corner.
pub const RIM: usize = 24;
/// Points nearer than this part of the smaller solid share.
const NEIGHBOURS: f64 = 0.02;
/// Points nearer than this part of it are one.
const SAME: f64 = 1e-9;
/// Lines at a smaller angle (its sine) lie along each other.
const PARALLEL: f64 = 1e-6;
/// How much a direction is corrected at most.
const POLISH: f64 = 1e-2;
/// Edges of faces at a smaller angle cross in what is no corner of the overlap.
const BLUNT: f64 = 0.1;
/// Solids farther apart than this many times their size are left alone.
const FAR: f64 = 1e6;

/// A solid as it is asked.
#[derive(Debug)]
struct Body {
    solid: Solid,
    /// its smallest and largest extent, roughly
    size: [f64; 2],
    /// of a hull: outward normals and corners
    faces: Vec<(Vector, Vec<Vector>)>,
}

/// The side of a solid that looks in some direction: a polygon, a line or a point.
struct Face {
    outline: Vec<Vector>,
    /// every how many-th point of the outline is a corner
    stride: usize,
    /// outwards; of polygons only
    normal: Option<Vector>,
}

impl Face {
    /// Its outline on the plane of two axes.
    fn laid(&self, e: Vector, f: Vector) -> Vec<Flat> {
        let outline = self.outline.iter();
        outline.map(|p| [p.dot(e), p.dot(f)]).collect()
    }
}

/// The question for a pair of solids.
#[derive(Debug)]
pub struct Query {
    i: Body,
    j: Body,
}

/// A point laid onto the plane across n.
type Flat = [f64; 2];

fn vector(p: [f64; 3]) -> Vector {
    Vector::new(p[0], p[1], p[2])
}

/// Unit vector across z, x where there is none.
fn azimuth(dir: Vector) -> (f64, f64) {
    let across = dir.x.hypot(dir.y);
    // a face that looks along z has no direction of its own
    if across <= 1e-12 * dir.z.abs() || across == 0.0 {
        (1.0, 0.0)
    } else {
        (dir.x / across, dir.y / across)
    }
}

impl Body {
    fn new(solid: &Solid) -> Option<Self> {
        let mut faces = Vec::new();
        let size = match solid {
            Solid::Ball { radius } if *radius > 0.0 => [*radius; 2],
            Solid::Ellipsoid { semi } => extremes(*semi),
            Solid::Box { low, high } => extremes([0, 1, 2].map(|k| 0.5 * (high[k] - low[k]))),
            Solid::Frustum { z, radius } => {
                let wide = radius[0].max(radius[1]);
                extremes([wide, wide, 0.5 * (z[1] - z[0])])
            }
            Solid::Hull(points) => {
                let points: Vec<Vector> = points.iter().map(|&p| vector(p)).collect();
                let hull = ConvexPolyhedron::from_convex_hull(&points)?;
                for face in hull.faces() {
                    let first = face.first_vertex_or_edge as usize;
                    let around = &hull.vertices_adj_to_face()[first..]
                        [..face.num_vertices_or_edges as usize];
                    let corners = around.iter().map(|&v| hull.points()[v as usize]).collect();
                    faces.push((face.normal, corners));
                }
                let (low, high) = points.iter().fold(
                    (
                        Vector::splat(f64::INFINITY),
                        Vector::splat(f64::NEG_INFINITY),
                    ),
                    |(low, high), p| (low.min(*p), high.max(*p)),
                );
                extremes(((high - low) * 0.5).to_array())
            }
            Solid::Ball { .. } | Solid::Plane { .. } | Solid::Torus { .. } => return None,
        };
        let solid = solid.clone();
        Some(Self { solid, size, faces })
    }

    /// The face that looks along a unit vector.
    fn face(&self, dir: Vector) -> Face {
        let one = |p: Vector| Face {
            outline: vec![p],
            stride: 1,
            normal: None,
        };
        match &self.solid {
            Solid::Box { low, high } => {
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
                let corner = |ka: bool, kb: bool| {
                    let mut p = Vector::ZERO;
                    p[axis] = if up { high } else { low }[axis];
                    p[a] = if ka { high } else { low }[a];
                    p[b] = if kb { high } else { low }[b];
                    p
                };
                let mut normal = Vector::ZERO;
                normal[axis] = if up { 1.0 } else { -1.0 };
                Face {
                    outline: vec![
                        corner(false, false),
                        corner(true, false),
                        corner(true, true),
                        corner(false, true),
                    ],
                    stride: 1,
                    normal: Some(normal),
                }
            }
            Solid::Frustum { z, radius } => {
                let (c, s) = azimuth(dir);
                let (up, out) = (dir.z, dir.x * c + dir.y * s);
                let (height, taper) = (z[1] - z[0], radius[0] - radius[1]);
                let side = (out * height + up * taper) / height.hypot(taper);
                if side >= up.abs() {
                    let at = |end: usize| Vector::new(radius[end] * c, radius[end] * s, z[end]);
                    return Face {
                        outline: vec![at(0), at(1)],
                        stride: 1,
                        normal: None,
                    };
                }
                let end = usize::from(up > 0.0);
                if radius[end] == 0.0 {
                    return one(Vector::new(0.0, 0.0, z[end]));
                }
                let rim = (0..RIM).map(|k| {
                    let (sk, ck) = (std::f64::consts::TAU * k as f64 / RIM as f64).sin_cos();
                    Vector::new(
                        radius[end] * (c * ck - s * sk),
                        radius[end] * (s * ck + c * sk),
                        z[end],
                    )
                });
                Face {
                    outline: rim.collect(),
                    stride: RIM / 4,
                    normal: Some(Vector::new(0.0, 0.0, up.signum())),
                }
            }
            Solid::Hull(_) => {
                let along = |f: &&(Vector, Vec<Vector>)| f.0.dot(dir);
                let best = self
                    .faces
                    .iter()
                    .max_by(|a, b| along(a).total_cmp(&along(b)));
                match best {
                    Some((normal, corners)) => Face {
                        outline: corners.clone(),
                        stride: 1,
                        normal: Some(*normal),
                    },
                    None => one(Vector::ZERO),
                }
            }
            _ => one(self.local_support_point(dir)),
        }
    }
}

/// Least and largest.
fn extremes(x: [f64; 3]) -> [f64; 2] {
    [x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2])]
}

impl SupportMap for Body {
    /// The farthest point along a direction.
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
            Solid::Hull(points) => {
                let along = |p: &&[f64; 3]| vector(**p).dot(dir);
                let best = points.iter().max_by(|a, b| along(a).total_cmp(&along(b)));
                best.map_or(Vector::ZERO, |p| vector(*p))
            }
            Solid::Plane { .. } | Solid::Torus { .. } => Vector::ZERO,
        }
    }
}

impl Query {
    /// For the solids of I and J; `None`: one of them is no convex solid of finite size.
    pub fn new(i: &Solid, j: &Solid) -> Option<Self> {
        Some(Self {
            i: Body::new(i)?,
            j: Body::new(j)?,
        })
    }

    /// The touches for a pose of I's marker in J's, its position and the three columns of its axes, as [`super::found`] reads
    /// them   (TOUCHES × TOUCH_NUMBERS).
    pub fn ask(&self, pose: &[f64], out: &mut [f64]) {
        super::nothing(out);
        let reach = FAR * (self.i.size[1] + self.j.size[1]);
        if pose.len() != 12 || !pose.iter().all(|x| x.abs() <= reach.max(2.0)) {
            return;
        }
        let column = |k: usize| Vector::new(pose[3 * k], pose[3 * k + 1], pose[3 * k + 2]);
        let axes = Matrix::from_cols(column(1), column(2), column(3));
        let turn = Rotation::from_mat3(&axes).normalize();
        if !turn.is_finite() {
            return;
        }
        let pose = Pose::from_parts(column(0), turn);
        let Some(n) = self.direction(&pose) else {
            return;
        };
        let points = self.points(&pose, n);
        for (touch, [p_i, p_j, share]) in out.chunks_mut(TOUCH_NUMBERS).zip(&points) {
            let p_i = pose.inverse_transform_point(*p_i);
            let all = [
                p_i.x, p_i.y, p_i.z, p_j.x, p_j.y, p_j.z, n.x, n.y, n.z, 0.0, share.x,
            ];
            touch.copy_from_slice(&all);
        }
    }

    /// I's farthest point against n and J's along it, in J's frame.
    fn farthest(&self, pose: &Pose, n: Vector) -> (Vector, Vector) {
        (
            self.i.support_point(pose, -n),
            self.j.local_support_point(n),
        )
    }

    /// The gap along a direction.
    fn gap(&self, pose: &Pose, n: Vector) -> f64 {
        let (a, b) = self.farthest(pose, n);
        (a - b).dot(n)
    }

    /// The direction from J's solid to I's, in J's frame.
    fn direction(&self, pose: &Pose) -> Option<Vector> {
        let mut n = match (&self.i.solid, &self.j.solid) {
            (Solid::Box { low: li, high: hi }, Solid::Box { low: lj, high: hj }) => {
                boxes(pose, (vector(*li), vector(*hi)), (vector(*lj), vector(*hj)))
            }
            _ => {
                let middle = pose.translation.try_normalize();
                let starts = [middle, Some(Vector::Z), Some(Vector::X), Some(Vector::Y)];
                starts.into_iter().flatten().find_map(|start| {
                    let found = contact_support_map_support_map_with_params(
                        pose,
                        &self.j,
                        &self.i,
                        f64::MAX,
                        &mut VoronoiSimplex::new(),
                        Some(start),
                    );
                    match found {
                        GJKResult::ClosestPoints(_, _, n) => n.try_normalize(),
                        _ => None,
                    }
                })?
            }
        };
        let mut gap = self.gap(pose, n);
        let rounding = 1e-13 * (self.i.size[1] + self.j.size[1]);
        let back = pose.inverse_transform_vector(-n);
        let faces = [
            self.j.face(n).normal,
            self.i.face(back).normal.map(|m| -pose.transform_vector(m)),
        ];
        for face in faces.into_iter().flatten() {
            let other = self.gap(pose, face);
            if other >= gap - rounding {
                (n, gap) = (face, other.max(gap));
            }
        }
        n = self.polished(pose, n);
        n.is_finite().then_some(n)
    }

    /// How far, across n, I's curved side lies beside J's; `None` where one of them is flat.
    fn offset(&self, pose: &Pose, n: Vector) -> Option<Vector> {
        let mut i = self.i.face(pose.inverse_transform_vector(-n));
        let j = self.j.face(n);
        if i.normal.is_some() || j.normal.is_some() {
            return None;
        }
        for p in &mut i.outline {
            *p = pose.transform_point(*p);
        }
        let (e, f) = n.any_orthonormal_pair();
        let [p, q] = nearest(&i.laid(e, f), &j.laid(e, f))?;
        Some(e * (p[0] - q[0]) + f * (p[1] - q[1]))
    }

    /// The direction at which two curved sides look at each other, by Newton's iteration.
    fn polished(&self, pose: &Pose, n: Vector) -> Vector {
        let (e, f) = n.any_orthonormal_pair();
        let at = |u: f64, v: f64| (n + e * u + f * v).normalize();
        let offset = |u: f64, v: f64| {
            let d = self.offset(pose, at(u, v))?;
            Some([d.dot(e), d.dot(f)])
        };
        let (mut u, mut v) = (0.0, 0.0);
        let mut best = (f64::INFINITY, n);
        for _ in 0..12 {
            let Some([x, y]) = offset(u, v) else {
                break;
            };
            let size = x.hypot(y);
            if size >= 0.5 * best.0 || size.is_nan() {
                break;
            }
            best = (size, at(u, v));
            let h = 1e-6;
            let ends = [
                offset(u + h, v),
                offset(u - h, v),
                offset(u, v + h),
                offset(u, v - h),
            ];
            let [Some(a), Some(b), Some(c), Some(d)] = ends else {
                break;
            };
            let [g, k] =
                [(a, b), (c, d)].map(|(up, down)| [0, 1].map(|r| (up[r] - down[r]) / (2.0 * h)));
            // least squares: along a line nothing changes
            let (gg, gk, kk) = (
                g[0] * g[0] + g[1] * g[1],
                g[0] * k[0] + g[1] * k[1],
                k[0] * k[0] + k[1] * k[1],
            );
            let flat = 1e-12 * (gg + kk);
            let (gg, kk) = (gg + flat, kk + flat);
            let (gx, kx) = (g[0] * x + g[1] * y, k[0] * x + k[1] * y);
            let det = gg * kk - gk * gk;
            let (du, dv) = ((gx * kk - kx * gk) / det, (gg * kx - gk * gx) / det);
            (u, v) = (u - du, v - dv);
            // far away is another place
            if (u + v).is_nan() || u.abs().max(v.abs()) >= POLISH {
                break;
            }
        }
        best.1
    }

    /// The places of touch: on I's face, on J's face (J's frame), and the share; the deepest first, at most [`TOUCHES`].
    fn points(&self, pose: &Pose, n: Vector) -> Vec<[Vector; 3]> {
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
        let mut places: Vec<(Flat, f64)> = Vec::new();
        for (face, flat, other) in [(&i, &flat_i, &flat_j), (&j, &flat_j, &flat_i)] {
            let corners = flat.iter().step_by(face.stride);
            places.extend(
                corners
                    .filter(|p| is_within(**p, other, near))
                    .map(|p| (*p, 1.0)),
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
                    (at, weight)
                }));
            }
        }
        let mut found: Vec<(Flat, f64, [f64; 2])> = Vec::new();
        for (at, weight) in places {
            let same = |other: &(Flat, f64, [f64; 2])| distance(other.0, at) <= near;
            if found.iter().any(same) {
                continue;
            }
            let heights = [
                height(&i, &flat_i, at, (n, e, f)),
                height(&j, &flat_j, at, (n, e, f)),
            ];
            if heights.iter().all(|h| h.is_finite()) {
                found.push((at, weight, heights));
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
            let near = |other: &(Flat, f64, [f64; 2])| {
                let part = 1.0 - (distance(other.0, at) / reach).powi(2);
                other.1 * part.max(0.0).powi(2)
            };
            found.iter().map(near).sum()
        };
        let mut all: Vec<(f64, [Vector; 3])> = found
            .iter()
            .map(|&(at, weight, [on_i, on_j])| {
                let base = e * at[0] + f * at[1];
                let share = Vector::splat(weight / crowd(at).max(1.0));
                (on_j - on_i, [base + n * on_i, base + n * on_j, share])
            })
            .collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.truncate(TOUCHES);
        all.into_iter().map(|(_, touch)| touch).collect()
    }
}

/// The direction from box J to box I, in J's frame, in which they overlap least: lower and upper corners.
fn boxes(pose: &Pose, i: (Vector, Vector), j: (Vector, Vector)) -> Vector {
    let cuboid =
        |(low, high): (Vector, Vector)| (Cuboid::new((high - low) * 0.5), (high + low) * 0.5);
    let ((box_i, middle_i), (box_j, middle_j)) = (cuboid(i), cuboid(j));
    let i_in_j = Pose::from_parts(pose.transform_point(middle_i) - middle_j, pose.rotation);
    let j_in_i = i_in_j.inverse();
    let of_j = sat::cuboid_cuboid_find_local_separating_normal_oneway(&box_j, &box_i, &i_in_j);
    let of_i = sat::cuboid_cuboid_find_local_separating_normal_oneway(&box_i, &box_j, &j_in_i);
    let edges = sat::cuboid_cuboid_find_local_separating_edge_twoway(&box_j, &box_i, &i_in_j);
    let mut best = (of_j.0, of_j.1);
    if of_i.0 > best.0 {
        best = (of_i.0, i_in_j.transform_vector(-of_i.1));
    }
    if edges.0 > best.0 {
        best = edges;
    }
    best.1
}

fn distance(p: Flat, q: Flat) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// The point of a line that is nearest to another.
fn foot(at: Flat, p: Flat, q: Flat) -> Flat {
    let along = [q[0] - p[0], q[1] - p[1]];
    let length2 = along[0] * along[0] + along[1] * along[1];
    let u = (along[0] * (at[0] - p[0]) + along[1] * (at[1] - p[1])) / length2;
    let u = if u.is_finite() {
        u.clamp(0.0, 1.0)
    } else {
        0.0
    };
    [p[0] + u * along[0], p[1] + u * along[1]]
}

/// The nearest points of two outlines, the same twice where they cross.
fn nearest(i: &[Flat], j: &[Flat]) -> Option<[Flat; 2]> {
    for (p, q) in edges(i) {
        for (r, s) in edges(j) {
            if let Some((at, _)) = crossing(p, q, r, s) {
                return Some([at, at]);
            }
        }
    }
    let mut pairs: Vec<[Flat; 2]> = Vec::new();
    for &p in i {
        pairs.extend(j.iter().map(|&q| [p, q]));
        pairs.extend(edges(j).map(|(r, s)| [p, foot(p, r, s)]));
    }
    for &q in j {
        pairs.extend(edges(i).map(|(r, s)| [foot(q, r, s), q]));
    }
    let apart = |pair: &[Flat; 2]| distance(pair[0], pair[1]);
    pairs
        .into_iter()
        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
}

/// Twice the area of the triangle p, q, r.
fn area(p: Flat, q: Flat, r: Flat) -> f64 {
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}

/// Edges of an outline.
fn edges(outline: &[Flat]) -> impl Iterator<Item = (Flat, Flat)> + '_ {
    let n = if outline.len() > 2 {
        outline.len()
    } else {
        outline.len().saturating_sub(1)
    };
    (0..n).map(move |k| (outline[k], outline[(k + 1) % outline.len()]))
}

/// Whether a point lies within an outline, or within `near` of it.
fn is_within(p: Flat, outline: &[Flat], near: f64) -> bool {
    match *outline {
        [] => false,
        [q] => distance(p, q) <= near,
        [q, r] => {
            let length = distance(q, r);
            let along = (r[0] - q[0]) * (p[0] - q[0]) + (r[1] - q[1]) * (p[1] - q[1]);
            area(q, r, p).abs() <= near * length
                && along >= -near * length
                && along <= length * (length + near)
        }
        _ => {
            let sides = edges(outline).map(|(q, r)| {
                let length = distance(q, r);
                if length > 0.0 {
                    area(q, r, p) / length
                } else {
                    0.0
                }
            });
            let (low, high) = sides.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            });
            low >= -near || high <= near
        }
    }
}

/// Where two lines cross, and the sine of the angle between them.
fn crossing(p: Flat, q: Flat, r: Flat, s: Flat) -> Option<(Flat, f64)> {
    let (d, g) = ([q[0] - p[0], q[1] - p[1]], [s[0] - r[0], s[1] - r[1]]);
    let cross = d[0] * g[1] - d[1] * g[0];
    let sine = cross.abs() / (d[0].hypot(d[1]) * g[0].hypot(g[1]));
    // lines along each other have their corners instead
    if sine.is_nan() || sine < PARALLEL {
        return None;
    }
    let apart = [r[0] - p[0], r[1] - p[1]];
    let u = (apart[0] * g[1] - apart[1] * g[0]) / cross;
    let v = (apart[0] * d[1] - apart[1] * d[0]) / cross;
    let inside = |x: f64| (0.0..=1.0).contains(&x);
    (inside(u) && inside(v)).then(|| ([p[0] + u * d[0], p[1] + u * d[1]], sine))
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
