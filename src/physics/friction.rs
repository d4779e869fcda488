//! FRICTION in a joint: the reaction of the joint presses surfaces together, and these resist the
//! motion that the joint leaves free.
//!
//! | parameter | symbol | keyword | unit | default |
//! |---|---|---|---|---|
//! | coefficients | µ_s, µ_d | MU_STATIC, MU_DYNAMIC | 1 | 0 |
//! | stiction velocity | v_s | STICTION_TRANSITION_VELOCITY | length/time | 0.1 |
//! | pin or ball radius | R_p | PIN_RADIUS, BALL_RADIUS | length | 1 |
//! | friction arm | R_n | FRICTION_ARM | length | 1 |
//! | bending and torsion arms | R_b, R_t | BENDING_REACTION_ARM, REACTION_ARM | length | 1 |
//! | overlap | s | INITIAL_OVERLAP, OVERLAP_DELTA | length | 1000 |
//! | preloads | F₀, T₀ | FRICTION_FORCE_PRELOAD, FRICTION_TORQUE_PRELOAD | force, torque | 0 |
//!
//! With the reaction of the joint on I, in the axes of J: F_a along the joint's axis, F_r across
//! it, M_b its moment across the axis, M_t about it; v the speed at which surfaces slip:
//!
//! ```text
//! revolute        T = −µ(v) (R_n |F_a| + R_p F_r + R_p M_b/R_b) − T₀            v = R_p ω
//! translational   F = −µ(v) (F_r + M_b/s + |M_t|/R_t) − F₀                      v = ż
//! cylindrical     both, along the slip (ż, R_p ω), pressed by N = F_r + M_b/s   v = |(ż, R_p ω)|
//! spherical       T = −µ(v) R_p |F| − T₀                                        v = R_p |ω|
//! universal       about each pin as in a revolute joint, with the force across and along that pin
//! ```
//!
//! Approximations: µ(v) is smooth, µ_s STEP(v, −v_s, −1, v_s, 1) up to v_s, then a step to µ_d at
//! 1.5 v_s. Within v_s Adams lets the surfaces creep like a spring up to MAX_STICTION_DEFORMATION;
//! here they creep like a damper, so that nothing sticks for ever, and at rest (in statics) there
//! is no friction. Preloads resist with their full size beyond v_s. The moment of a universal
//! joint's reaction, which is about its third axis, bends neither pin.

use super::action::Action;
use super::contact::law::Coulomb;
use crate::scalar::Scalar;
use crate::space::{MarkerState, Vec3};

/// The kind of joint, as friction distinguishes them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// turns about z of J
    Revolute,
    /// slides along z of J
    Translational,
    /// slides along z of J and turns about it
    Cylindrical,
    /// turns about any axis
    Spherical,
    /// turns about axis `i` of I and axis `j` of J
    Pins {
        /// 0 x, 1 y, 2 z
        i: usize,
        /// 0 x, 1 y, 2 z
        j: usize,
    },
}

/// The change of the overlap of a sliding joint with its displacement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlap {
    /// it stays the same
    Constant,
    /// it grows with the displacement
    Increases,
    /// it shrinks with the displacement
    Decreases,
}

/// The parameters of a friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// kind of joint
    pub kind: Kind,
    /// µ(v)
    pub law: Coulomb,
    /// parts of the reaction that count: forces, bending moments, torsional moments
    pub takes: [bool; 3],
    /// F₀
    pub force_preload: f64,
    /// T₀
    pub torque_preload: f64,
    /// R_n
    pub friction_arm: f64,
    /// R_b
    pub bending_arm: f64,
    /// R_p
    pub radius: f64,
    /// R_t
    pub reaction_arm: f64,
    /// s at displacement 0, in length units
    pub overlap: f64,
    /// change of s with the displacement
    pub overlap_change: Overlap,
}

/// The friction of a joint and the slip it resists; the measure FRICTION reads both.
#[derive(Clone, Copy, Debug)]
pub struct Slip<S> {
    /// action on I
    pub action: Action<S>,
    /// velocity at which I slides against J, ground axes
    pub velocity: Vec3<S>,
    /// angular velocity of I against J, ground axes
    pub spin: Vec3<S>,
}

/// Returns the length of a vector; its derivative is 0 where it vanishes.
fn size<S: Scalar>(v: Vec3<S>) -> S {
    let n2 = v.norm2();
    let zero = n2.le(S::zero());
    S::select(zero, S::zero(), S::select(zero, S::one(), n2).sqrt())
}

impl Friction {
    /// Returns whether forces, and whether moments, of the reaction are read.
    pub fn reads(&self) -> [bool; 2] {
        let [forces, bending, torsion] = self.takes;
        let bends = matches!(
            self.kind,
            Kind::Revolute | Kind::Translational | Kind::Cylindrical
        );
        let twists = self.kind == Kind::Translational;
        [forces, bending && bends || torsion && twists]
    }

    /// Returns µ(v)/v, and the same with a coefficient of 1 on both sides of the step.
    fn per_speed<S: Scalar>(&self, speed2: S) -> [S; 2] {
        let whole = Coulomb {
            mu_static: 1.0,
            mu_dynamic: 1.0,
            ..self.law
        };
        [self.law.per_speed(speed2), whole.per_speed(speed2)]
    }

    /// Returns the torque about a pin at the angular rate ω, from the reaction's force and moment
    /// along and across the axis.
    fn about_pin<S: Scalar>(&self, axis: Vec3<S>, rate: S, force: Vec3<S>, moment: Vec3<S>) -> S {
        let along = force.dot(axis);
        let across = size(force - axis.times(along));
        let bending = size(moment - axis.times(moment.dot(axis)));
        let r = self.radius;
        let pressed = along.abs().scale(self.friction_arm)
            + across.scale(r)
            + bending.scale(r / self.bending_arm);
        let [mu, whole] = self.per_speed(rate.scale(r).square());
        // µ(v) = (µ/v) R_p ω
        -(mu * pressed + whole.scale(self.torque_preload)) * rate.scale(r)
    }

    /// Returns friction and slip, from the joint's reaction on I about its origin, in ground axes.
    pub fn slip<S: Scalar>(
        &self,
        i: &MarkerState<S>,
        j: &MarkerState<S>,
        reaction: &Action<S>,
    ) -> Slip<S> {
        let taken = |k: usize, v: Vec3<S>| if self.takes[k] { v } else { Vec3::zero() };
        let z = j.R_GM.column(2);
        let force = taken(0, reaction.force);
        let torsion = z.times(reaction.torque.dot(z));
        let bending = taken(1, reaction.torque - torsion);
        let torsion = taken(2, torsion);
        let d = i.p_GM - j.p_GM;
        let w = i.w_GM - j.w_GM;
        let sliding = (i.v_GM - j.v_GM - j.w_GM.cross(d)).dot(z);
        let none = Vec3::zero();
        let (force, torque, velocity, spin) = match self.kind {
            Kind::Revolute => {
                let rate = w.dot(z);
                let torque = self.about_pin(z, rate, force, bending);
                (none, z.times(torque), none, z.times(rate))
            }
            Kind::Translational => {
                let across = size(force - z.times(force.dot(z)));
                let pressed = across
                    + size(bending) / self.overlapping(d.dot(z))
                    + size(torsion).scale(1.0 / self.reaction_arm);
                let [mu, whole] = self.per_speed(sliding.square());
                let f = -(mu * pressed + whole.scale(self.force_preload)) * sliding;
                (z.times(f), none, z.times(sliding), none)
            }
            Kind::Cylindrical => {
                let rate = w.dot(z);
                let r = self.radius;
                let across = size(force - z.times(force.dot(z)));
                let pressed = across + size(bending) / self.overlapping(d.dot(z));
                let [mu, whole] = self.per_speed(sliding.square() + rate.scale(r).square());
                let f = -(mu * pressed + whole.scale(self.force_preload)) * sliding;
                let t = -(mu * pressed.scale(r) + whole.scale(self.torque_preload)) * rate.scale(r);
                (z.times(f), z.times(t), z.times(sliding), z.times(rate))
            }
            Kind::Spherical => {
                let r = self.radius;
                let [mu, whole] = self.per_speed(w.norm2().scale(r * r));
                let t = -(mu * size(force).scale(r) + whole.scale(self.torque_preload)).scale(r);
                (none, w.times(t), none, w)
            }
            Kind::Pins { i: on_i, j: on_j } => {
                let mut torque = Vec3::zero();
                for axis in [i.R_GM.column(on_i), j.R_GM.column(on_j)] {
                    let t = self.about_pin(axis, w.dot(axis), force, Vec3::zero());
                    torque += axis.times(t);
                }
                (none, torque, none, w)
            }
        };
        Slip {
            action: Action { force, torque },
            velocity,
            spin,
        }
    }

    /// Returns s at a displacement; never less than a thousandth of its initial value.
    fn overlapping<S: Scalar>(&self, displacement: S) -> S {
        let s = S::constant(self.overlap);
        let s = match self.overlap_change {
            Overlap::Constant => return s,
            Overlap::Increases => s + displacement,
            Overlap::Decreases => s - displacement,
        };
        s.max(S::constant(1e-3 * self.overlap))
    }
}
