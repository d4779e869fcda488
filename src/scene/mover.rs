//! Positions and their tangents: quaternions have four numbers, and three directions to move in.

use super::layout::{replace, several};
use super::{LinkMotion, Scene, Source};
use crate::arrange::Arrange;
use crate::space::Vec3;
use crate::space::rotation::quaternion_rate;

/// The moves of positions along tangents.
#[derive(Clone, Debug)]
pub struct Mover {
    /// coordinates that are their own rate: places in q and v
    simple: Vec<(usize, usize)>,
    /// places of quaternions in q, and of their angular velocities in v
    balls: Vec<(usize, usize)>,
}

impl Mover {
    /// Finds the coordinates of a scene.
    pub fn new(scene: &Scene) -> Self {
        let mut this = Self {
            simple: Vec::new(),
            balls: Vec::new(),
        };
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let (Source::Free { q, v }, false) = (c.source, f.in_ball) {
                this.simple.push((q, v));
            }
        }
        for link in &scene.links {
            if let LinkMotion::Ball {
                coordinate,
                quaternion,
            } = link.motion
                && let Some(v) = scene.freedoms[coordinate].v
            {
                this.balls.push((quaternion, v));
            }
        }
        this
    }

    /// Moves positions, `q ← q ⊕ Δ`; Δ are velocities over a unit of time   (n_v)
    pub fn displace(&self, q: &mut [f64], change: &[f64]) {
        for &(k, v) in &self.simple {
            q[k] += change[v];
        }
        for &(k, v) in &self.balls {
            let [w, x, y, z] = several(q, k);
            let [a, b, c] = several(change, v).map(|x: f64| 0.5 * x);
            let turned = [
                w - x * a - y * b - z * c,
                x + w * a + y * c - z * b,
                y + w * b + z * a - x * c,
                z + w * c + x * b - y * a,
            ];
            replace(q, k, turned);
        }
        self.normalize(q);
    }

    /// Takes over the positions of which a velocity is not zero.
    pub fn take_over(&self, q: &mut [f64], moved: &[f64], change: &[f64]) {
        for &(k, v) in &self.simple {
            if change[v] != 0.0 {
                q[k] = moved[k];
            }
        }
        for &(k, v) in &self.balls {
            if change[v..v + 3].iter().any(|x| *x != 0.0) {
                q[k..k + 4].copy_from_slice(&moved[k..k + 4]);
            }
        }
    }

    /// Returns the changes of positions along each velocity: (velocity, position, slope), by
    /// velocities.
    pub fn tangents(&self, q: &[f64]) -> Vec<(usize, usize, f64)> {
        let mut all: Vec<(usize, usize, f64)> =
            self.simple.iter().map(|&(k, v)| (v, k, 1.0)).collect();
        for &(k, v) in &self.balls {
            let [w, x, y, z] = several(q, k);
            let columns = [[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]];
            for (c, column) in columns.iter().enumerate() {
                all.extend(
                    column
                        .iter()
                        .enumerate()
                        .map(|(i, slope)| (v + c, k + i, 0.5 * slope)),
                );
            }
        }
        all.arrange_by_key(|t| t.0);
        all
    }

    /// Returns the tangent of a small change of positions   (n_v)
    pub fn tangent(&self, q: &[f64], change: &[f64], n_v: usize) -> Vec<f64> {
        let mut out = vec![0.0; n_v];
        self.find_tangent(q, change, &mut out);
        out
    }

    /// Finds the tangent of a small change of positions   (n_v)
    pub fn find_tangent(&self, q: &[f64], change: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for &(k, v) in &self.simple {
            out[v] = change[k];
        }
        for &(k, v) in &self.balls {
            // 2 q* ∘ δq
            let [w, x, y, z] = several(q, k);
            let [a, b, c, d] = several(change, k);
            let turn = [
                2.0 * (w * b - x * a - y * d + z * c),
                2.0 * (w * c + x * d - y * a - z * b),
                2.0 * (w * d - x * c + y * b - z * a),
            ];
            replace(out, v, turn);
        }
    }

    /// Adds `part` ω × x to the rates of some numbers x that stand for velocities, where these are
    /// turns ω at velocities `v`, written in a frame that turns along.
    pub fn add_turning(&self, v: &[f64], x: &[f64], part: f64, rates: &mut [f64]) {
        for &(_, at) in &self.balls {
            let [own, spin] = [x, v].map(|x| Vec3(several(x, at)));
            let rate: [f64; 3] = several(rates, at);
            let turn = spin.cross(own).times(part);
            replace(rates, at, [0, 1, 2].map(|c| rate[c] + turn.0[c]));
        }
    }

    /// Finds the small change of positions that a tangent stands for   (n_q)
    pub fn untangent(&self, q: &[f64], tangent: &[f64], change: &mut [f64]) {
        for &(k, v) in &self.simple {
            change[k] = tangent[v];
        }
        for &(k, v) in &self.balls {
            let rate = quaternion_rate(several(q, k), Vec3(several(tangent, v)));
            replace(change, k, rate);
        }
    }

    /// Scales quaternions to unit length; returns whether that changed any.
    pub fn normalize(&self, q: &mut [f64]) -> bool {
        let mut changed = false;
        for &(k, _) in &self.balls {
            let quaternion: [f64; 4] = several(q, k);
            let n2: f64 = quaternion.iter().map(|x| x * x).sum();
            if (n2 - 1.0).abs() > 4.0 * f64::EPSILON {
                let f = 1.0 / n2.sqrt();
                replace(q, k, quaternion.map(|x| x * f));
                changed = true;
            }
        }
        changed
    }
}
