//! Energy of a scene, and the powers that change it.
//!
//! ```text
//! d(T + V)/dt = P_stored + P_dissipated + P_functions + P_motions
//! ```
//!
//! T is kinetic energy, V potential energy in gravity. The action of a spring–damper, bushing,
//! field, contact or nodal force is split: its action on markers that stand still is what stores
//! energy, the rest dissipates it. FRICTION dissipates all of its power. Forces given by functions
//! put in what they do. Rows and joints do no work, except those that a motion drives: theirs
//! is what remains of the change of kinetic energy.

use super::Equations;
use super::sweep;
use crate::physics::action::Action;
use crate::scalar::Scalar;
use crate::scene::MarkerOnLink;
use crate::scene::forces::ForceElement;
use crate::space::{Frame, Mat3, Vec3};

/// Powers of what acts on the parts   [energy/time]
#[derive(Clone, Copy, Debug)]
pub struct Powers<S> {
    /// of springs, fields and contacts as they would act at rest: what they give back
    pub stored: S,
    /// of damping and friction; negative where energy is lost
    pub dissipated: S,
    /// of forces that functions give
    pub functions: S,
}

impl<S: Scalar> Equations<'_, S> {
    /// Kinetic energy, and potential energy in gravity.
    pub fn energy(&self) -> [S; 2] {
        let (mut kinetic, mut potential) = (S::zero(), S::zero());
        for (link, s) in self.scene.links.iter().zip(self.links()) {
            if link.mass == 0.0 && link.inertia == Mat3::zero() {
                continue;
            }
            let mc = Vec3::constant(link.moment);
            let momentum = s.v.times(S::constant(link.mass)) + s.w.cross(mc);
            let spin = Mat3::constant(link.inertia).apply(s.w) + mc.cross(s.v);
            kinetic += (momentum.dot(s.v) + spin.dot(s.w)).scale(0.5);
            let weight = s.X_GL.position.times(S::constant(link.mass)) + s.X_GL.rotation.apply(mc);
            potential -= self.gravity().dot(weight);
        }
        [kinetic, potential]
    }

    /// Returns the powers of all forces.
    pub fn powers(&self) -> Powers<S> {
        let mut all = Powers {
            stored: S::zero(),
            dissipated: S::zero(),
            functions: S::zero(),
        };
        for force in &self.scene.forces {
            let power = self.power(force, &force.action(self));
            if let Some(at_rest) = force.action_at_rest(self) {
                let stored = self.power(force, &at_rest);
                all.stored += stored;
                all.dissipated += power - stored;
            } else if force.is_friction() {
                all.dissipated += power;
            } else {
                all.functions += power;
            }
        }
        all
    }

    /// Returns the power of an action on I and of its reaction, which acts at the origin of I.
    fn power(&self, force: &ForceElement, action: &Action<S>) -> S {
        let i = self.marker(force.i);
        let (mut v, mut w) = (i.v_GM, i.w_GM);
        if let Some(link) = force.reaction {
            let origin = MarkerOnLink {
                id: 0,
                link,
                frame: Frame::identity(),
                part: None,
            };
            let reacting = sweep::marker_state(&origin, self.links());
            let arm = i.p_GM - reacting.p_GM;
            v = v - reacting.v_GM - reacting.w_GM.cross(arm);
            w -= reacting.w_GM;
        }
        action.force.dot(v) + action.torque.dot(w)
    }

    /// Returns the rate of kinetic energy, less the power of gravity, at accelerations of the free
    /// coordinates   (n_v).
    pub fn energy_rate(&self, vdot: &[S]) -> S {
        let mut rate = S::zero();
        let links = sweep::outward(self.scene, &self.coordinates(vdot));
        for (link, s) in self.scene.links.iter().zip(&links) {
            if link.mass == 0.0 && link.inertia == Mat3::zero() {
                continue;
            }
            let (mc, mass) = (Vec3::constant(link.moment), S::constant(link.mass));
            let inertia = Mat3::constant(link.inertia);
            let weight = s.X_GL.rotation.apply_transposed(self.gravity());
            let a = s.a - weight;
            let force = a.times(mass) + s.alpha.cross(mc) + s.w.cross(s.w.cross(mc));
            let spin = inertia.apply(s.alpha) + s.w.cross(inertia.apply(s.w)) + mc.cross(a);
            rate += force.dot(s.v) + spin.dot(s.w);
        }
        rate
    }
}
