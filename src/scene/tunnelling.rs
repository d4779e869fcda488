//! The bound of a step within which bodies of a contact cannot pass through each other.

use super::equations::Equations;
use crate::physics::contact::extent::Extent;
use crate::scalar::Scalar;
use crate::space::Vec3;

/// Two bodies of a contact that both have an end.
#[derive(Clone, Copy, Debug)]
pub struct ThicknessBound {
    /// the markers in whose frames they stand
    markers: [usize; 2],
    extents: [Extent; 2],
    /// way on which they overlap, at least
    overlap: f64,
    /// whether touches are found from near by only: farther away nothing says that one comes
    sudden: bool,
}

impl ThicknessBound {
    /// Of two bodies, both solids or both `outlines`: touches of these are found from near by only.
    pub fn new(markers: [usize; 2], extents: [Extent; 2], outlines: bool) -> Self {
        let [a, b] = &extents;
        Self {
            markers,
            overlap: a.overlap(b, outlines),
            extents,
            sudden: outlines,
        }
    }

    /// Gap between the balls about the bodies (negative where they overlap), and bounds of the
    /// speed and of the acceleration with which any point of one may move against any of the other.
    pub fn motion<S: Scalar>(&self, at: &Equations<S>) -> [S; 3] {
        let of = |k: usize| {
            let (m, e) = (at.accelerated_marker(self.markers[k]), &self.extents[k]);
            let arm = m.R_GM.apply(Vec3(e.centre.map(S::constant)));
            let (w, spin) = (m.w_GM, m.w_GM.norm());
            let velocity = m.v_GM + w.cross(arm);
            let acceleration = m.a_GM + m.alpha_GM.cross(arm) + w.cross(w.cross(arm));
            let turn = m.alpha_GM.norm() + spin * spin;
            (
                m.p_GM + arm,
                velocity,
                acceleration,
                spin.scale(e.radius),
                turn.scale(e.radius),
            )
        };
        let (i, j) = (of(0), of(1));
        let radii: f64 = self.extents.iter().map(|e| e.radius).sum();
        [
            (i.0 - j.0).norm() - S::constant(radii),
            (i.1 - j.1).norm() + i.3 + j.3,
            (i.2 - j.2).norm() + i.4 + j.4,
        ]
    }

    /// From the middle of the second body to that of the first.
    pub fn apart(&self, at: &Equations<f64>) -> Vec3<f64> {
        let middle = |k: usize| {
            let m = at.marker(self.markers[k]);
            m.p_GM + m.R_GM.apply(Vec3(self.extents[k].centre))
        };
        middle(0) - middle(1)
    }

    /// Returns the way between two places over the way after which one body may have come through
    /// the other: at most 1 is permitted.
    pub fn excess(&self, from: Vec3<f64>, to: Vec3<f64>) -> f64 {
        let radii: f64 = self.extents.iter().map(|e| e.radius).sum();
        let gap = from.norm() - radii;
        (to - from).norm() / (gap.max(0.0) + 0.5 * self.overlap)
    }

    /// Returns how long a step from that motion may be so that neither is through the other unseen,
    /// when it is looked for them `looks` times on the way.
    ///
    /// ```text
    /// d = half the way on which they overlap
    /// gap + d  = u h + a h²/2      it ends where they overlap, at the latest, or
    /// looks·d  = (u + a h) h       they overlap between no two looks only
    /// ```
    pub fn time(&self, [gap, speed, acceleration]: [f64; 3], looks: f64) -> f64 {
        let d = 0.5 * self.overlap;
        let until = |way: f64, a: f64| until(way, speed, a);
        until(gap.max(0.0) + d, acceleration).max(until(looks * d, 2.0 * acceleration))
    }

    /// Returns how long a step from that motion may be before a touch can begin of which nothing
    /// told at its beginning: the balls about the bodies are apart until then, and touches are
    /// found from as far away as they are deep; half of that counts.
    pub fn surprise(&self, [gap, speed, acceleration]: [f64; 3]) -> f64 {
        match self.sudden {
            true => until(gap.max(0.5 * self.overlap), speed, acceleration),
            false => f64::INFINITY,
        }
    }
}

/// Returns the time in which a way is covered from a speed under an acceleration.
fn until(way: f64, speed: f64, acceleration: f64) -> f64 {
    2.0 * way / (speed + (speed * speed + 2.0 * acceleration * way).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_falls_from_rest_is_looked_for_before_it_is_through() {
        let plate = Extent {
            centre: [0.0; 3],
            radius: 1.0,
            thickness: 0.1,
        };
        let reach = ThicknessBound::new([0, 1], [plate; 2], false);
        // 2 + 0.1 = 10 h²/2
        assert!((reach.time([2.0, 0.0, 10.0], 5.0) - 0.42f64.sqrt()).abs() < 1e-15);
        // 5·0.1 = 10 h²
        assert!((reach.time([0.1, 0.0, 10.0], 5.0) - 0.05f64.sqrt()).abs() < 1e-15);
        assert!((reach.time([-1.0, 2.0, 0.0], 5.0) - 0.25).abs() < 1e-15);
        // the gap of 3 − 2 and 0.1 are permitted
        let [from, to] = [3.0, 0.8].map(|z| Vec3([0.0, 0.0, z]));
        assert!((reach.excess(from, to) - 2.0).abs() < 1e-12);
        assert_eq!(reach.time([1.0, 0.0, 0.0], 5.0), f64::INFINITY);
    }
}
