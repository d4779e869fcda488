//! A torus against another solid: a ball whose centre may be anywhere on the ring.
//!
//! With d(p) the distance of a point from the solid and n its direction (`ball.rs`), c(φ) the ring, t its tangent, r the tube:
//!
//! ```text
//! d' = n(c(φ)) · t(φ) = 0, rising: the ring is nearest here        depth = r − d
//! ```
//!
//! All such places are touches; they are found between samples by bisection and secants. Beside the deepest come those a quarter and half a turn
//! further, as on a plane, so that a ring may lie flat. Near each other they share.

use super::ball::distance;
use super::{Solid, TOUCH_NUMBERS, TOUCHES};
use crate::space::{Mat3, Vec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Places of the ring that are looked at first.
const SAMPLES: usize = 48;
/// Touches nearer than this angle share.
const NEIGHBOURS: f64 = 0.05;
/// A ring farther off than this many times its size is left alone.
const FAR: f64 = 1e6;

/// The question for a torus and another solid.
#[derive(Clone, Debug)]
pub struct Ring {
    /// of the ring and of the tube
    radii: [f64; 2],
    solid: Solid,
    /// the torus is J's
    turned: bool,
}

/// Whether a distance from a solid is known everywhere.
pub fn is_met(solid: &Solid) -> bool {
    match solid {
        Solid::Box { .. } | Solid::Frustum { .. } | Solid::Torus { .. } => true,
        // a ball and a plane have formulas of their own
        Solid::Ball { .. } | Solid::Plane { .. } | Solid::Ellipsoid { .. } | Solid::Hull(_) => {
            false
        }
    }
}

impl Ring {
    /// For I's and J's solid; `None`: neither is a torus, or the other cannot be asked for distances.
    pub fn new(i: &Solid, j: &Solid) -> Option<Self> {
        let ring = |torus: &Solid, solid: &Solid, turned: bool| match torus {
            Solid::Torus { ring, tube } if is_met(solid) => Some(Self {
                radii: [*ring, *tube],
                solid: solid.clone(),
                turned,
            }),
            _ => None,
        };
        ring(i, j, false).or_else(|| ring(j, i, true))
    }

    /// The touches for a pose of I's marker in J's, its position and the three columns of its axes, as [`super::found`] reads
    /// them   (TOUCHES × TOUCH_NUMBERS).
    pub fn ask(&self, pose: &[f64], out: &mut [f64]) {
        super::nothing(out);
        let far = FAR * (self.radii[0] + self.radii[1]).max(1.0);
        if pose.len() != 12 || !pose.iter().all(|x| x.abs() <= far) {
            return;
        }
        let vector = |k: usize| Vec3([pose[3 * k], pose[3 * k + 1], pose[3 * k + 2]]);
        let axes = Mat3::from_columns(vector(1), vector(2), vector(3));
        // of the torus in the frame of the solid
        let (place, axes) = if self.turned {
            let back = Mat3::from_columns(axes.row(0), axes.row(1), axes.row(2));
            (-back.apply(vector(0)), back)
        } else {
            (vector(0), axes)
        };
        let (angles, shares) = self.angles(place, axes);
        for ((touch, angle), share) in out.chunks_mut(TOUCH_NUMBERS).zip(angles).zip(shares) {
            let c = self.centre(angle);
            let (d, n) = distance(&self.solid, place + axes.apply(c));
            let on_solid = place + axes.apply(c) - n.times(d);
            // the normal in the torus' frame
            let own = axes.apply_transposed(n);
            let on_torus = c - own.times(self.radii[1]);
            // the direction from J's solid to I's, in J's frame
            let (on_i, on_j, normal) = if self.turned {
                (on_solid, on_torus, -own)
            } else {
                (on_torus, on_solid, n)
            };
            let all = [on_i.0, on_j.0, normal.0].concat();
            touch[..9].copy_from_slice(&all);
            touch[9] = 0.0;
            touch[10] = share;
        }
    }

    /// A point of the ring.
    fn centre(&self, angle: f64) -> Vec3<f64> {
        let (sin, cos) = angle.sin_cos();
        Vec3([self.radii[0] * cos, self.radii[0] * sin, 0.0])
    }

    /// Where the ring is nearest, the nearest first, and the shares of these places.
    fn angles(&self, place: Vec3<f64>, axes: Mat3<f64>) -> (Vec<f64>, Vec<f64>) {
        let at = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let (d, n) = distance(&self.solid, place + axes.apply(self.centre(angle)));
            (d, n.dot(axes.apply(Vec3([-sin, cos, 0.0]))))
        };
        let step = TAU / SAMPLES as f64;
        let samples: Vec<f64> = (0..=SAMPLES).map(|k| at(step * k as f64).1).collect();
        let mut found: Vec<(f64, f64)> = Vec::new();
        for k in 0..SAMPLES {
            let (a, b) = (samples[k], samples[k + 1]);
            // rounding is no slope
            if a < -1e-12 && b >= 0.0 || a <= 1e-12 && b > 1e-12 && a > -1e-12 {
                let angle = root(|x| at(x).1, step * k as f64, step * (k + 1) as f64);
                found.push((at(angle).0, angle));
            }
        }
        if found.is_empty() {
            // the same all around
            found.push((at(0.0).0, 0.0));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.truncate(TOUCHES - 3);
        let deepest = found[0].1;
        for quarter in [FRAC_PI_2, -FRAC_PI_2, 2.0 * FRAC_PI_2] {
            let angle = deepest + quarter;
            found.push((at(angle).0, angle));
        }
        let apart = |a: f64, b: f64| {
            let d = a - b;
            (d - TAU * (d / TAU).round()).abs()
        };
        let shares = found.iter().map(|(_, a)| {
            let near = |b: f64| (1.0 - (apart(*a, b) / NEIGHBOURS).powi(2)).max(0.0).powi(2);
            1.0 / found.iter().map(|(_, b)| near(*b)).sum::<f64>().max(1.0)
        });
        let shares = shares.collect();
        (found.into_iter().map(|f| f.1).collect(), shares)
    }
}

/// Where a function that is not positive at `a` and not negative at `b` vanishes: secants, halved where these stay on one side.
fn root(f: impl Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    let (mut fa, mut fb) = (f(a), f(b));
    for _ in 0..100 {
        if b - a <= 1e-15 || fb <= 0.0 {
            return b;
        }
        if fa >= 0.0 {
            return a;
        }
        let x = (a * fb - b * fa) / (fb - fa);
        let x = if x > a && x < b { x } else { 0.5 * (a + b) };
        let y = f(x);
        if y == 0.0 {
            return x;
        }
        // the value at the end that stays counts half (Illinois)
        if y > 0.0 {
            (b, fb) = (x, y);
            fa *= 0.5;
        } else {
            (a, fa) = (x, y);
            fb *= 0.5;
        }
    }
    0.5 * (a + b)
}
