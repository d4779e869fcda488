//! BUSHING: six uncoupled springs and dampers between two markers, in the axes of J.
//!
//! | parameter | symbol | keyword | unit | default |
//! |---|---|---|---|---|
//! | stiffness | K, Kₜ | K, KT | force/length, torque/rad | 0 |
//! | damping | C, Cₜ | C, CT | force·time/length, torque·time/rad | 0 |
//! | preload | F₀, T₀ | FORCE, TORQUE | force, torque | 0 |
//!
//! ```text
//! F = −K x − C ẋ + F₀         x: I from J in J axes;  ẋ its rate as J sees it
//! T = −Kₜ (a, b, c) − Cₜ ω + T₀   a, b, c: AX, AY, AZ of I in J;  ω: angular velocity of I in J
//! ```
//!
//! Two of the three angles must stay small: only then are a, b, c rotations about the axes of J.

use super::action::{ALL_ANGLES, Action, Law};
use crate::expr::measures::Measure;
use crate::scalar::Scalar;
use crate::space::{MarkerState, Vec3};

/// The parameters of a bushing: three for translations, three for rotations.
#[derive(Clone, Copy, Debug)]
pub struct Bushing {
    /// K, Kₜ
    pub stiffness: [f64; 6],
    /// C, Cₜ
    pub damping: [f64; 6],
    /// F₀, T₀
    pub preload: [f64; 6],
}

/// Returns displacement and velocity of I against J in J axes: x, y, z, a, b, c and their rates.
pub fn deformation<S: Scalar>(
    i: &MarkerState<S>,
    j: &MarkerState<S>,
    angles: [S; 3],
) -> ([S; 6], [S; 6]) {
    let R_JG = j.R_GM.transpose();
    let d = i.p_GM - j.p_GM;
    let x = R_JG.apply(d);
    // the rate that an observer on J measures
    let rate = R_JG.apply(i.v_GM - j.v_GM - j.w_GM.cross(d));
    let w = R_JG.apply(i.w_GM - j.w_GM);
    (
        [x.0[0], x.0[1], x.0[2], angles[0], angles[1], angles[2]],
        [rate.0[0], rate.0[1], rate.0[2], w.0[0], w.0[1], w.0[2]],
    )
}

/// Returns the action on I of six components given in J axes.
pub fn in_axes_of<S: Scalar>(j: &MarkerState<S>, f: [S; 6]) -> Action<S> {
    Action {
        force: j.R_GM.apply(Vec3([f[0], f[1], f[2]])),
        torque: j.R_GM.apply(Vec3([f[3], f[4], f[5]])),
    }
}

impl Law for Bushing {
    fn angles(&self) -> &'static [Measure] {
        &ALL_ANGLES
    }

    fn action<S: Scalar>(
        &self,
        i: &MarkerState<S>,
        j: &MarkerState<S>,
        angle: impl Fn(Measure) -> S,
    ) -> Action<S> {
        let (x, rate) = deformation(i, j, ALL_ANGLES.map(angle));
        let f = std::array::from_fn(|k| {
            S::constant(self.preload[k])
                - x[k].scale(self.stiffness[k])
                - rate[k].scale(self.damping[k])
        });
        in_axes_of(j, f)
    }
}
