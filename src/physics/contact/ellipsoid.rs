//! The distance of a point from an ellipsoid.
//!
//! The foot x of a point p is the point of the surface where p − x is along the normal. With
//! semi-axes a, the smallest of them e, and u ≥ 0:
//!
//! ```text
//! x_k = a_k² p_k / (u + a_k² − e²)           Σ (a_k p_k / (u + a_k² − e²))² = 1          (1)
//! ```
//!
//! The left side of (1) decreases in u and is convex, so that Newton's iteration climbs to the root
//! from the left; u > e² means that the point is outside. Where p has no component along the
//! shortest axis (1) may have no root; then u = 0, and the foot is above the middle.

use crate::space::Vec3;

/// Returns the signed distance of a point from the surface, negative inside, and the outward normal
/// at its foot.
pub(super) fn distance(semi: [f64; 3], p: Vec3<f64>) -> (f64, Vec3<f64>) {
    let size = semi.into_iter().fold(0.0, f64::max);
    let a = semi.map(|x| x / size);
    let y = p.0.map(|x| (x / size).abs());
    let least = (0..3).fold(0, |m, k| if a[k] < a[m] { k } else { m });
    let more = a.map(|x| (x - a[least]) * (x + a[least]));
    let parts = |u: f64| {
        [0, 1, 2].map(|k| {
            if y[k] == 0.0 {
                0.0
            } else {
                a[k] * y[k] / (u + more[k])
            }
        })
    };
    let excess = |u: f64| parts(u).iter().map(|x| x * x).sum::<f64>() - 1.0;
    // one term alone is 1 at this u, so that the sum is no less
    let mut u = (0..3).map(|k| a[k] * y[k] - more[k]).fold(0.0, f64::max);
    let mut x;
    if u == 0.0 && excess(0.0) <= 0.0 {
        // as far as the other axes tell, and the rest along the shortest
        x = [0, 1, 2].map(|k| {
            if more[k] > 0.0 {
                a[k] * (a[k] * y[k] / more[k])
            } else {
                0.0
            }
        });
        let rest = 1.0 - (0..3).map(|k| (x[k] / a[k]).powi(2)).sum::<f64>();
        x[least] = a[least] * rest.max(0.0).sqrt();
    } else {
        for _ in 0..100 {
            let all = parts(u);
            let g = all.iter().map(|x| x * x).sum::<f64>() - 1.0;
            let slope: f64 = (0..3)
                .filter(|&k| y[k] != 0.0)
                .map(|k| -2.0 * all[k] * all[k] / (u + more[k]))
                .sum();
            let next = u - g / slope;
            if next.is_nan() || next <= u {
                break;
            }
            u = next;
        }
        let all = parts(u);
        x = [0, 1, 2].map(|k| a[k] * all[k]);
    }
    let sign = |k: usize, v: f64| if p.0[k] < 0.0 { -v } else { v };
    let foot = Vec3([0, 1, 2].map(|k| sign(k, x[k])));
    let normal = Vec3([0, 1, 2].map(|k| foot.0[k] / (a[k] * a[k])));
    let normal = normal.times(1.0 / normal.norm());
    ((p - foot.times(size)).dot(normal), normal)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEMI: [f64; 3] = [0.5, 2.0, 1.2];

    fn points() -> impl Iterator<Item = Vec3<f64>> {
        let golden = [0.754_877_666, 0.569_840_290, 0.430_159_709];
        (1..3000).map(move |n| Vec3(golden.map(|g| 6.0 * ((n as f64 * g) % 1.0) - 3.0)))
    }

    #[test]
    fn the_foot_lies_on_the_ellipsoid_and_its_normal_leads_back() {
        for p in points() {
            let (d, n) = distance(SEMI, p);
            let foot = p - n.times(d);
            let on: f64 = (0..3).map(|k| (foot.0[k] / SEMI[k]).powi(2)).sum();
            assert!((on - 1.0).abs() < 1e-12, "{p:?} {on}");
            let outside = (0..3).map(|k| (p.0[k] / SEMI[k]).powi(2)).sum::<f64>() > 1.0;
            assert_eq!(d > 0.0, outside, "{p:?}");
        }
    }

    #[test]
    fn no_point_of_the_ellipsoid_is_nearer_than_the_foot() {
        for p in points().step_by(37) {
            let (d, _) = distance(SEMI, p);
            for q in points() {
                let across = (0..3)
                    .map(|k| (q.0[k] / SEMI[k]).powi(2))
                    .sum::<f64>()
                    .sqrt();
                let on = q.times(1.0 / across);
                assert!((p - on).norm() >= d.abs() - 1e-12, "{p:?}");
            }
        }
    }

    #[test]
    fn points_on_the_axes_have_the_feet_that_symmetry_gives_them() {
        let close = |p: [f64; 3], expected: f64| {
            let (d, n) = distance(SEMI, Vec3(p));
            assert!((d - expected).abs() < 1e-14, "{p:?} {d}");
            assert!((n.norm() - 1.0).abs() < 1e-14);
        };
        close([0.0; 3], -0.5);
        close([1.5, 0.0, 0.0], 1.0);
        close([0.0, 0.0, -3.2], 2.0);
        close([0.0, -2.0, 0.0], 0.0);
        // within the evolute: y = b² c/(b² − a²), the foot of a symmetric pair: d² = a² (1 − c²/(b²
        // − a²))
        let c = 0.7f64;
        close([0.0, c, 0.0], -0.5 * (1.0 - c * c / 3.75).sqrt());
        // a point on a sphere's axis
        let (d, _) = distance([2.0; 3], Vec3([0.0, 0.0, 5.0]));
        assert_eq!(d, 3.0);
        for p in [[1e-300, 0.0, 0.0], [1e150, 0.0, 1e-150]] {
            let (d, n) = distance(SEMI, Vec3(p));
            assert!(d.is_finite() && (n.norm() - 1.0).abs() < 1e-14, "{p:?} {d}");
        }
    }
}
