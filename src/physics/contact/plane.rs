//! A solid on a plane: the points of the solid that can be deepest.
//!
//! Corners are fixed. On a rim the deepest point moves: it lies where the plane's normal, projected
//! into the plane of the rim, points down; the points a quarter and half a turn further support a
//! solid that stands flat. The four together depend on nothing but the tilt, even where the tilt
//! vanishes and any point is the deepest.

use super::ball::radial;
use super::{Solid, Touch};
use crate::scalar::{Mask, Scalar};
use crate::space::{MarkerState, Vec3};

type Bounds = [Option<f64>; 2];

/// Returns the touches of a solid of I with a plane of J, whose outside is along its z.
pub(super) fn touches<S: Scalar>(
    solid: &Solid,
    i: &MarkerState<S>,
    bounds: (Bounds, Bounds),
    j: &MarkerState<S>,
) -> Vec<Touch<S>> {
    let normal = j.R_GM.column(2);
    // the direction down, in the solid's axes
    let down = i.R_GM.apply_transposed(-normal);
    let mut out = Vec::new();
    for local in candidates(solid, down) {
        let p = i.p_GM + i.R_GM.apply(local);
        let at = p - j.p_GM;
        let z = at.dot(normal);
        let mut depth = -z;
        for (axis, [low, high]) in [bounds.0, bounds.1].into_iter().enumerate() {
            let x = at.dot(j.R_GM.column(axis));
            let mut within = None;
            let mut both = |m: S::Mask| {
                within = Some(within.map_or(m, |w: S::Mask| w.and(m)));
            };
            if let Some(low) = low {
                both(S::constant(low).le(x));
            }
            if let Some(high) = high {
                both(x.le(S::constant(high)));
            }
            if let Some(within) = within {
                depth = S::select(within, depth, S::constant(-1.0));
            }
        }
        out.push(Touch {
            depth,
            normal,
            point: p - normal.times(z.scale(0.5)),
            share: S::one(),
        });
    }
    out
}

/// Returns the points of a solid, in its frame, that can be deepest along `down`.
pub fn candidates<S: Scalar>(solid: &Solid, down: Vec3<S>) -> Vec<Vec3<S>> {
    let c = S::constant;
    match solid {
        Solid::Ball { radius } => vec![down.times(c(*radius))],
        Solid::Box { low, high } => (0..8)
            .map(|corner| {
                Vec3([0, 1, 2].map(|k| {
                    c(if corner >> k & 1 == 0 {
                        low[k]
                    } else {
                        high[k]
                    })
                }))
            })
            .collect(),
        Solid::Hull(points) => points.iter().map(|p| Vec3(p.map(c))).collect(),
        Solid::Frustum { z, radius } => {
            let mut out = Vec::new();
            for end in 0..2 {
                out.extend(rim(radius[end], z[end], down));
            }
            out
        }
        Solid::Torus { ring, tube } => {
            let tube = down.times(c(*tube));
            rim(*ring, 0.0, down)
                .into_iter()
                .map(|p| p + tube)
                .collect()
        }
        Solid::Ellipsoid { semi } => {
            let squares = semi.map(|a| a * a);
            let stretched = Vec3([0, 1, 2].map(|k| down.0[k].scale(squares[k])));
            let size = stretched.dot(down).sqrt();
            vec![stretched.times(size.recip())]
        }
        Solid::Plane { .. } => Vec::new(),
    }
}

/// Returns the deepest point of a circle about z, and those a quarter and half a turn further.
fn rim<S: Scalar>(radius: f64, z: f64, down: Vec3<S>) -> Vec<Vec3<S>> {
    if radius == 0.0 {
        return vec![Vec3([S::zero(), S::zero(), S::constant(z)])];
    }
    let (_, [x, y]) = radial(down, 1.0);
    [(x, y), (-y, x), (-x, -y), (y, -x)]
        .map(|(x, y)| Vec3([x.scale(radius), y.scale(radius), S::constant(z)]))
        .to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_point_of_a_solid_is_deeper_than_its_candidates() {
        let down = Vec3([0.48, -0.6, 0.64]);
        let deepest = |solid: &Solid| {
            candidates(solid, down)
                .iter()
                .map(|p| p.dot(down))
                .fold(f64::MIN, f64::max)
        };
        // (down_x a)² + (down_y b)² + (down_z c)² under the root: the support of an ellipsoid
        let e = Solid::Ellipsoid {
            semi: [1.0, 2.0, 3.0],
        };
        assert!((deepest(&e) - f64::sqrt(0.48 * 0.48 + 1.44 + 1.92 * 1.92)).abs() < 1e-14);
        let across = 0.48f64.hypot(0.6);
        let f = Solid::Frustum {
            z: [0.0, 1.0],
            radius: [2.0, 0.5],
        };
        assert!((deepest(&f) - 2.0 * across).abs() < 1e-14);
        let t = Solid::Torus {
            ring: 2.0,
            tube: 0.5,
        };
        assert!((deepest(&t) - (2.0 * across + 0.5)).abs() < 1e-14);
        let b = Solid::Box {
            low: [-1.0; 3],
            high: [1.0, 2.0, 3.0],
        };
        assert!((deepest(&b) - (0.48 + 0.6 + 1.92)).abs() < 1e-14);
    }
}
