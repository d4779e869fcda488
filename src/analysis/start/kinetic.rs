//! Kinetic energy as a sum of squares of velocities, which tells how far velocities are from rest
//! whatever the units and wherever the origin.

use crate::scene::Link;
use crate::scene::sweep::LinkState;
use crate::space::{Mat3, Vec3};
use nalgebra::Matrix3;

/// Part of the largest moment of inertia below which one is rounding.
const ROUNDING: f64 = 1e-9;

/// The energy of a link:
///
/// ```text
/// 2 T = m |v_C|² + Σ I_k (e_k · ω)²
/// ```
///
/// with C its centre of mass, I and e its principal moments of inertia and their axes there.
pub(super) struct Squares {
    /// √m
    mass: f64,
    /// centre of mass, in the link's frame
    center: Vec3<f64>,
    /// √I e, in the link's axes; none where there is no inertia about an axis
    axes: Vec<Vec3<f64>>,
}

impl Squares {
    /// Takes a link apart.
    pub fn of(link: &Link) -> Self {
        let mass = link.mass.max(0.0);
        let center = if mass > 0.0 {
            link.moment.times(1.0 / mass)
        } else {
            Vec3::zero()
        };
        let d = center.0;
        let about_center = Matrix3::from_fn(|i, j| {
            let own = if i == j { center.dot(center) } else { 0.0 };
            link.inertia.0[i][j] - mass * (own - d[i] * d[j])
        });
        let eigen = about_center.symmetric_eigen();
        let here = |m: &Mat3<f64>| (0..3).map(|k| m.0[k][k].abs()).fold(0.0, f64::max);
        let least = ROUNDING * here(&link.inertia);
        let axes = (0..3).filter(|&k| eigen.eigenvalues[k] > least).map(|k| {
            let (e, root) = (eigen.eigenvectors.column(k), eigen.eigenvalues[k].sqrt());
            Vec3([e[0] * root, e[1] * root, e[2] * root])
        });
        Self {
            mass: mass.sqrt(),
            center,
            axes: axes.collect(),
        }
    }

    /// Returns whether every velocity of the link has energy.
    pub fn is_definite(&self) -> bool {
        self.mass > 0.0 && self.axes.len() == 3
    }

    /// Returns the velocities whose squares add up to 2 T, each with the size of those that it is
    /// the sum of in a mechanism of the size `reach`: the same number of them at any state.
    pub fn at(&self, s: &LinkState<f64>, reach: f64) -> Vec<(f64, f64)> {
        let about = |axis: &Vec3<f64>| (axis.dot(s.w), axis.norm() * s.w.norm());
        let mut all: Vec<(f64, f64)> = self.axes.iter().map(about).collect();
        if self.mass > 0.0 {
            let v = s.v + s.w.cross(self.center);
            let size = s.v.norm() + s.w.norm() * (self.center.norm() + reach);
            all.extend(v.0.map(|x| (x * self.mass, size * self.mass)));
        }
        all
    }
}
