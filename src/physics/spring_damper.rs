//! SPRINGDAMPER: a linear spring and damper along a line or about an axis.
//!
//! | parameter | symbol | keyword | unit | default |
//! |---|---|---|---|---|
//! | stiffness | k | K, KT | force/length, torque/rad | 0 |
//! | damping | c | C, CT | force·time/length, torque·time/rad | 0 |
//! | free length or angle | l₀ | LENGTH, ANGLE | length, rad | 0 |
//! | preload | f₀ | FORCE, TORQUE | force, torque | 0 |
//!
//! ```text
//! translation   F = −c ḋ − k (d − l₀) + f₀    on I along the unit vector from J to I; d: distance
//! rotation      T = −c θ̇ − k (θ − l₀) + f₀   on I about z_J; θ: its angle, turns counted
//! ```
//!
//! Singular where I and J coincide in translation: the direction, and with it the force, is zero
//! there.

use super::action::{Action, Law, line_of_sight};
use crate::expr::measures::Measure;
use crate::scalar::Scalar;
use crate::space::{MarkerState, Vec3};

/// The parameters of a spring–damper.
#[derive(Clone, Copy, Debug)]
pub struct SpringDamper {
    /// whether it acts about z_J rather than along the line
    pub rotational: bool,
    /// k
    pub stiffness: f64,
    /// c
    pub damping: f64,
    /// l₀
    pub free: f64,
    /// f₀
    pub preload: f64,
}

impl SpringDamper {
    /// Returns whether it never acts.
    fn is_idle(&self) -> bool {
        self.stiffness == 0.0 && self.damping == 0.0 && self.preload == 0.0
    }

    fn magnitude<S: Scalar>(&self, x: S, rate: S) -> S {
        S::constant(self.preload)
            - rate.scale(self.damping)
            - (x - S::constant(self.free)).scale(self.stiffness)
    }
}

impl Law for SpringDamper {
    fn angles(&self) -> &'static [Measure] {
        if self.rotational { &[Measure::Az] } else { &[] }
    }

    fn action<S: Scalar>(
        &self,
        i: &MarkerState<S>,
        j: &MarkerState<S>,
        angle: impl Fn(Measure) -> S,
    ) -> Action<S> {
        if self.is_idle() {
            return Action::zero();
        }
        if self.rotational {
            let z_J = j.R_GM.column(2);
            let rate = (i.w_GM - j.w_GM).dot(z_J);
            return Action {
                force: Vec3::zero(),
                torque: z_J.times(self.magnitude(angle(Measure::Az), rate)),
            };
        }
        let (u, length) = line_of_sight(i, j);
        let rate = (i.v_GM - j.v_GM).dot(u);
        Action {
            force: u.times(self.magnitude(length, rate)),
            torque: Vec3::zero(),
        }
    }
}
