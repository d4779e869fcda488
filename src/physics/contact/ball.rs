//! A ball against a solid: the signed distance of its centre from the surface, negative inside.
//!
//! Each formula gives the distance of a point and the outward direction of the nearest surface
//! there. Outside of a corner or an edge that is the direction from the nearest point of the solid;
//! inside it is the normal of the nearest face.

use super::{Solid, Touch};
use crate::scalar::hypot;
use crate::scalar::{Mask, Scalar};
use crate::space::{MarkerState, Vec3};

/// Distance, as a part of a solid's size, below which it counts as none: the direction is that of
/// the face.
const ZERO_DISTANCE: f64 = 1e-12;

/// Returns the touch of a ball of I with a solid of J.
pub(super) fn touch<S: Scalar>(
    radius: f64,
    i: &MarkerState<S>,
    solid: &Solid,
    j: &MarkerState<S>,
) -> Touch<S> {
    let local = j.R_GM.apply_transposed(i.p_GM - j.p_GM);
    let (distance, direction) = distance(solid, local);
    let normal = j.R_GM.apply(direction);
    let depth = S::constant(radius) - distance;
    // in the middle of the overlap, so that both solids are treated alike
    let point = i.p_GM - normal.times(S::constant(radius) - depth.scale(0.5));
    Touch {
        depth,
        normal,
        point,
        share: S::one(),
    }
}

/// Returns the signed distance of a point from a solid's surface, and the direction in which it
/// grows.
pub fn distance<S: Scalar>(solid: &Solid, p: Vec3<S>) -> (S, Vec3<S>) {
    match solid {
        Solid::Ball { radius } => {
            let (r, direction) = from_origin(p, radius.max(f64::MIN_POSITIVE));
            (r - S::constant(*radius), direction)
        }
        Solid::Plane { x, y } => plane(*x, *y, p),
        Solid::Box { low, high } => cuboid(low, high, p),
        Solid::Frustum { z, radius } => frustum(*z, *radius, p),
        Solid::Torus { ring, tube } => {
            let (rho, radial) = radial(p, *ring);
            let across = rho - S::constant(*ring);
            let size2 = across.square() + p.0[2].square();
            let none = size2.le(S::constant((ZERO_DISTANCE * tube).powi(2)));
            let size = S::select(none, S::one(), size2).sqrt();
            let up = S::select(none, S::one(), p.0[2] / size);
            let out = S::select(none, S::zero(), across / size);
            let d = S::select(none, S::zero(), size) - S::constant(*tube);
            (d, Vec3([radial[0] * out, radial[1] * out, up]))
        }
        // these have no formula, and no caller asks for them
        Solid::Ellipsoid { .. } | Solid::Hull(_) => (S::constant(f64::NAN), Vec3::zero()),
    }
}

/// Returns the distance from the origin and its direction; z at the origin itself.
fn from_origin<S: Scalar>(p: Vec3<S>, size: f64) -> (S, Vec3<S>) {
    let n2 = p.norm2();
    let none = n2.le(S::constant((ZERO_DISTANCE * size).powi(2)));
    let length = S::select(none, S::one(), n2).sqrt();
    let part = |k: usize| {
        let fallback = if k == 2 { S::one() } else { S::zero() };
        S::select(none, fallback, p.0[k] / length)
    };
    (
        S::select(none, S::zero(), length),
        Vec3([0, 1, 2].map(part)),
    )
}

/// Returns the distance from the z axis and the direction across it; x on the axis itself.
pub(super) fn radial<S: Scalar>(p: Vec3<S>, size: f64) -> (S, [S; 2]) {
    let n2 = p.0[0].square() + p.0[1].square();
    let none = n2.le(S::constant((ZERO_DISTANCE * size).powi(2)));
    let rho = S::select(none, S::one(), n2).sqrt();
    let x = S::select(none, S::one(), p.0[0] / rho);
    let y = S::select(none, S::zero(), p.0[1] / rho);
    (S::select(none, S::zero(), rho), [x, y])
}

/// Returns the signed distance of a coordinate beyond its bounds.
fn beyond<S: Scalar>(x: S, [low, high]: [Option<f64>; 2]) -> S {
    let mut out = S::zero();
    if let Some(low) = low {
        let below = x - S::constant(low);
        out += S::select(below.lt(S::zero()), below, S::zero());
    }
    if let Some(high) = high {
        let above = x - S::constant(high);
        out += S::select(S::zero().lt(above), above, S::zero());
    }
    out
}

/// Measures from the half space below z = 0, or from the rectangle within bounds.
fn plane<S: Scalar>(x: [Option<f64>; 2], y: [Option<f64>; 2], p: Vec3<S>) -> (S, Vec3<S>) {
    let z = p.0[2];
    if x == [None; 2] && y == [None; 2] {
        return (z, Vec3::axis(2));
    }
    // above the rectangle the plane is nearest, beside it an edge
    let (dx, dy) = (beyond(p.0[0], x), beyond(p.0[1], y));
    let aside2 = dx.square() + dy.square();
    let above = aside2.le(S::zero());
    let length = S::select(above, S::one(), aside2 + z.square()).sqrt();
    let part = |d: S, face: f64| S::select(above, S::constant(face), d / length);
    let direction = Vec3([part(dx, 0.0), part(dy, 0.0), part(z, 1.0)]);
    (S::select(above, z, length), direction)
}

/// Measures from a box between two corners.
fn cuboid<S: Scalar>(low: &[f64; 3], high: &[f64; 3], p: Vec3<S>) -> (S, Vec3<S>) {
    // beyond the faces along each axis, 0 within
    let out = Vec3([0, 1, 2].map(|k| beyond(p.0[k], [Some(low[k]), Some(high[k])])));
    let out2 = out.norm2();
    let size = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    let inside = out2.le(S::constant((ZERO_DISTANCE * size).powi(2)));
    let length = S::select(inside, S::one(), out2).sqrt();
    // inside: the nearest of the six faces
    let mut nearest = S::constant(f64::NEG_INFINITY);
    let mut face = Vec3::zero();
    for k in 0..3 {
        for (sign, bound) in [(-1.0, low[k]), (1.0, high[k])] {
            let d = (p.0[k] - S::constant(bound)).scale(sign);
            let nearer = if nearest.known() == Some(f64::NEG_INFINITY) {
                None
            } else {
                Some(nearest.lt(d))
            };
            for c in 0..3 {
                let normal = S::constant(if c == k { sign } else { 0.0 });
                face.0[c] = nearer.map_or(normal, |m| S::select(m, normal, face.0[c]));
            }
            nearest = nearer.map_or(d, |m| S::select(m, d, nearest));
        }
    }
    let direction = [0, 1, 2].map(|c| S::select(inside, face.0[c], out.0[c] / length));
    (S::select(inside, nearest, length), Vec3(direction))
}

/// Measures in the half plane (ρ, z), where a frustum is a polygon of three edges: bottom, side,
/// top.
fn frustum<S: Scalar>(z: [f64; 2], r: [f64; 2], p: Vec3<S>) -> (S, Vec3<S>) {
    let c = S::constant;
    let size = r[0].max(r[1]).max(z[1] - z[0]);
    let (rho, across) = radial(p, size);
    let (height, widening) = (z[1] - z[0], r[1] - r[0]);
    let slant = hypot(height, widening);
    let (n_rho, n_z) = (height / slant, -widening / slant);
    // distance from each face, positive outwards
    let faces = [
        (c(z[0]) - p.0[2], [0.0, -1.0]),
        (
            (rho - c(r[0])).scale(n_rho) + (p.0[2] - c(z[0])).scale(n_z),
            [n_rho, n_z],
        ),
        (p.0[2] - c(z[1]), [0.0, 1.0]),
    ];
    let mut inner = faces[0].0;
    let mut face = faces[0].1.map(c);
    for (d, normal) in &faces[1..] {
        let nearer = inner.lt(*d);
        inner = S::select(nearer, *d, inner);
        for k in 0..2 {
            face[k] = S::select(nearer, c(normal[k]), face[k]);
        }
    }
    // nearest point of each edge
    let clamped = |x: S, low: f64, high: f64| {
        let x = S::select(x.lt(c(low)), c(low), x);
        S::select(c(high).lt(x), c(high), x)
    };
    let along = ((rho - c(r[0])).scale(widening) + (p.0[2] - c(z[0])).scale(height))
        .scale(1.0 / (slant * slant));
    let u = clamped(along, 0.0, 1.0);
    let edges = [
        [clamped(rho, 0.0, r[0]), c(z[0])],
        [c(r[0]) + u.scale(widening), c(z[0]) + u.scale(height)],
        [clamped(rho, 0.0, r[1]), c(z[1])],
    ];
    let to = |e: &[S; 2]| [rho - e[0], p.0[2] - e[1]];
    let mut d = to(&edges[0]);
    let mut d2 = d[0].square() + d[1].square();
    for e in &edges[1..] {
        let other = to(e);
        let other2 = other[0].square() + other[1].square();
        let nearer = other2.lt(d2);
        d2 = S::select(nearer, other2, d2);
        for k in 0..2 {
            d[k] = S::select(nearer, other[k], d[k]);
        }
    }
    let inside = inner
        .le(S::zero())
        .or(d2.le(c((ZERO_DISTANCE * size).powi(2))));
    let length = S::select(inside, S::one(), d2).sqrt();
    let direction = [0, 1].map(|k| S::select(inside, face[k], d[k] / length));
    let normal = Vec3([
        across[0] * direction[0],
        across[1] * direction[0],
        direction[1],
    ]);
    (S::select(inside, inner, length), normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Dual;

    fn solids() -> Vec<Solid> {
        vec![
            Solid::Ball { radius: 0.7 },
            Solid::Plane {
                x: [None; 2],
                y: [None; 2],
            },
            Solid::Plane {
                x: [Some(-0.5), Some(0.4)],
                y: [None, Some(0.3)],
            },
            Solid::Box {
                low: [-0.5, -0.2, 0.1],
                high: [0.4, 0.6, 0.9],
            },
            Solid::Frustum {
                z: [-0.3, 0.5],
                radius: [0.6, 0.6],
            },
            Solid::Frustum {
                z: [-0.3, 0.5],
                radius: [0.6, 0.2],
            },
            Solid::Frustum {
                z: [0.0, 0.5],
                radius: [0.0, 0.4],
            },
            Solid::Torus {
                ring: 0.8,
                tube: 0.2,
            },
        ]
    }

    /// Points in a cube about the solids, the same on every run.
    fn points() -> impl Iterator<Item = Vec3<f64>> {
        let golden = [
            0.754_877_666_246_693,
            0.569_840_290_998_053,
            0.430_159_709_001_947,
        ];
        (1..2000).map(move |n| Vec3(golden.map(|g| 3.0 * ((n as f64 * g) % 1.0) - 1.5)))
    }

    #[test]
    fn the_direction_is_the_gradient_of_the_distance() {
        for solid in solids() {
            for p in points() {
                let dual = Vec3([0, 1, 2].map(|k| Dual::<3>::variable(p.0[k], k)));
                let (d, n) = distance(&solid, dual);
                // below a bounded plane the nearest edge is not what counts
                for k in 0..3 {
                    assert!((d.eps[k] - n.0[k].re).abs() < 1e-9, "{solid:?} {p:?}");
                }
                assert!((n.norm2().re - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn going_back_by_the_distance_ends_on_the_surface() {
        for solid in solids() {
            for p in points() {
                let (d, n) = distance(&solid, p);
                let foot = p - n.times(d);
                if d > 0.0 {
                    assert!(
                        distance(&solid, foot).0.abs() < 1e-12,
                        "{solid:?} {p:?} {d}"
                    );
                }
            }
        }
    }

    #[test]
    fn distances_from_corners_and_edges_are_those_of_pythagoras() {
        let near = |solid: &Solid, p: [f64; 3], expected: f64| {
            let (d, _) = distance(solid, Vec3(p));
            assert!((d - expected).abs() < 1e-15, "{solid:?} {p:?}: {d}");
        };
        let cuboid = Solid::Box {
            low: [0.0; 3],
            high: [1.0, 2.0, 3.0],
        };
        near(&cuboid, [3.0, 4.0, 4.0], 3.0);
        near(&cuboid, [4.0, 6.0, 1.0], 5.0);
        near(&cuboid, [0.5, 0.9, 2.8], -0.2);
        let cylinder = Solid::Frustum {
            z: [0.0, 2.0],
            radius: [1.0, 1.0],
        };
        near(&cylinder, [0.0, 4.0, 6.0], 5.0);
        near(&cylinder, [0.0, 0.0, 5.0], 3.0);
        near(&cylinder, [0.0, 0.9, 1.0], -0.1);
        let plane = Solid::Plane {
            x: [Some(0.0), None],
            y: [None; 2],
        };
        near(&plane, [-3.0, 7.0, 4.0], 5.0);
        near(&plane, [3.0, 7.0, 4.0], 4.0);
    }
}
