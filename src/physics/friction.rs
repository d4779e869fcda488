//! FRICTION in a joint: the reaction of the joint presses surfaces together, and these resist the
//! motion that the joint leaves free.
//!
//! | parameter | symbol | keyword | unit | default |
//! |---|---|---|---|---|
//! | coefficients | µ_s, µ_d | MU_STATIC, MU_DYNAMIC | 1 | 0 |
//! | stiction velocity | v_s | STICTION_TRANSITION_VELOCITY | length/time | 0.1 |
//! | stiction deformation | Δ | MAX_STICTION_DEFORMATION | length | 0.01 |
//! | pin or ball radius | R_p | PIN_RADIUS, BALL_RADIUS | length | 1 |
//! | friction arm | R_n | FRICTION_ARM | length | 1 |
//! | bending and torsion arms | R_b, R_t | BENDING_REACTION_ARM, REACTION_ARM | length | 1 |
//! | overlap | s | INITIAL_OVERLAP, OVERLAP_DELTA | length | 1000 |
//! | preloads | F₀, T₀ | FRICTION_FORCE_PRELOAD, FRICTION_TORQUE_PRELOAD | force, torque | 0 |
//!
//! With the reaction of the joint on I, in the axes of J: F_a along the joint's axis, F_r across
//! it, M_b its moment across the axis, M_t about it; v the velocity at which surfaces slip, c their
//! creep, µ the vector of the coefficient ([`Grip`]):
//!
//! ```text
//! revolute        T = −µ (R_n |F_a| + R_p F_r + R_p M_b/R_b) − T₀            v = R_p ω
//! translational   F = −µ (F_r + M_b/s + |M_t|/R_t) − F₀                      v = ż
//! cylindrical     both, along (ż, R_p ω), pressed by N = F_r + M_b/s         v = (ż, R_p ω)
//! spherical       T = −µ R_p |F| − T₀                                        v = R_p ω, along x, y, z of J
//! universal       about each pin as in a revolute joint, with the force across and along that pin
//! ```
//!
//! Preloads are multiplied by µ with both coefficients one. In statics, where nothing has crept,
//! there is no friction. The moment of a universal joint's reaction, which is about its third axis,
//! bends neither pin.

use super::action::Action;
use crate::expr::functions::step::{quintic, step};
use crate::scalar::Scalar;
use crate::space::{MarkerState, Vec3};
use std::ops::Range;

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
    /// µ
    pub grip: Grip,
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

/// Coefficient of friction of surfaces that slip with velocity v and have crept by c.
///
/// ```text
/// µ = [(1 − β) µ_s S(|c|/Δ) ĉ + β µ_s v̂]      β = S(|v|/v_s)                     |v| ≤ v_s      (1)
///     STEP5(|v|, v_s, µ_s, 1.5 v_s, µ_d) v̂                                       |v| > v_s
/// ċ = v − P ⟨v·ĉ⟩ ĉ                            P = STEP5(|c|, 0.9 Δ, 0, Δ, 1)     |v| ≤ v_s      (2)
/// ċ = −c v_s/Δ                                                                   |v| ≥ 1.5 v_s
/// S(u) = STEP5(u, −1, −1, 1, 1) = (15 u − 10 u³ + 3 u⁵)/8      ⟨x⟩ = max(x, 0)
/// ```
///
/// (1) is the law of Adams: it gives the coefficients, β and the creep in the results of a robot
/// with twelve FRICTIONs to all six digits. Its creep c is the way since the surfaces began to
/// stick, at most Δ. Here it is a state with a continuous rate: (2) holds it within Δ, forgets it
/// while the surfaces slide, and goes from one to the other as quintic steps do between v_s and
/// 1.5 v_s. Up to 0.9 Δ, where 99.8 % of the static limit are reached, surfaces deform elastically:
/// a load below that, however it vibrates, moves them by no more than Δ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// µ_s
    pub mu_static: f64,
    /// µ_d
    pub mu_dynamic: f64,
    /// v_s
    pub stiction_velocity: f64,
    /// Δ; `None`: nothing creeps, and friction vanishes with the velocity
    pub deformation: Option<f64>,
}

/// Most components that slip together: those of a ball.
const MAX_SLIPS: usize = 3;
/// Velocity beyond which friction is dynamic, over the stiction velocity.
const DYNAMIC_SPEED_RATIO: f64 = 1.5;
/// Part of the deformation up to which surfaces creep elastically.
const ELASTIC_PART: f64 = 0.9;

/// Returns the root of what is never negative; its derivative is 0 where that vanishes.
fn root<S: Scalar>(x: S) -> S {
    let zero = x.le(S::zero());
    S::select(zero, S::zero(), S::select(zero, S::one(), x).sqrt())
}

/// Returns the length of a vector; its derivative is 0 where it vanishes.
fn size<S: Scalar>(v: Vec3<S>) -> S {
    root(v.norm2())
}

/// Returns S(u)/u of u².
fn saturation<S: Scalar>(u2: S) -> S {
    (S::constant(15.0) + u2 * (u2.scale(3.0) - S::constant(10.0))).scale(0.125)
}

fn square_sum<S: Scalar>(x: &[S]) -> S {
    x.iter().fold(S::zero(), |sum, &x| sum + x.square())
}

impl Grip {
    /// Returns the same with both coefficients one.
    fn whole(&self) -> Self {
        Self {
            mu_static: 1.0,
            mu_dynamic: 1.0,
            ..*self
        }
    }

    /// Returns µ along each of the components in which surfaces slip; `creep` is c/Δ.
    fn coefficients<S: Scalar>(&self, v: &[S], creep: &[S]) -> [S; MAX_SLIPS] {
        let c = S::constant;
        let (mu_s, vs) = (self.mu_static, self.stiction_velocity);
        let speed2 = square_sum(v).scale(1.0 / (vs * vs));
        let sticks = speed2.le(S::one());
        // each side with numbers that it has on its own, so that no branch matters on the other
        let inside = S::select(sticks, speed2, S::zero());
        let outside = S::select(sticks, S::one(), speed2).sqrt();
        let mu = step(
            outside,
            c(1.0),
            c(mu_s),
            c(DYNAMIC_SPEED_RATIO),
            c(self.mu_dynamic),
            quintic,
        );
        let by_speed = S::select(sticks, saturation(inside).scale(mu_s), mu / outside);
        let mut along: [S; MAX_SLIPS] = std::array::from_fn(|k| match v.get(k) {
            Some(&v) => by_speed * v.scale(1.0 / vs),
            None => S::zero(),
        });
        if self.deformation.is_some() {
            let beta = root(inside) * saturation(inside);
            let crept = square_sum(creep);
            let within = crept.le(S::one());
            let reached = S::select(within, S::one(), crept).sqrt();
            let by_creep = saturation(S::select(within, crept, S::one())) / reached;
            let weight = S::select(sticks, (S::one() - beta).scale(mu_s), S::zero());
            for (along, &q) in along.iter_mut().zip(creep) {
                *along += weight * by_creep * q;
            }
        }
        along
    }

    /// Returns the rates of c/Δ where surfaces slip with velocity v.
    fn creep_rates<S: Scalar>(&self, v: &[S], creep: &[S]) -> [S; MAX_SLIPS] {
        let Some(deformation) = self.deformation else {
            return [S::zero(); MAX_SLIPS];
        };
        let c = S::constant;
        let (vs, per_deformation) = (self.stiction_velocity, 1.0 / deformation);
        let speed2 = square_sum(v).scale(1.0 / (vs * vs));
        let sticks = speed2.le(S::one());
        let speed = S::select(sticks, S::one(), speed2).sqrt();
        let slides = step(
            speed,
            c(1.0),
            S::zero(),
            c(DYNAMIC_SPEED_RATIO),
            S::one(),
            quintic,
        );
        let crept = square_sum(creep);
        let elastic = crept.le(c(ELASTIC_PART * ELASTIC_PART));
        let reached = S::select(
            elastic,
            c(ELASTIC_PART),
            S::select(elastic, S::one(), crept).sqrt(),
        );
        let yields = step(
            reached,
            c(ELASTIC_PART),
            S::zero(),
            S::one(),
            S::one(),
            quintic,
        );
        // ⟨v·c⟩ without a branch of its own
        let dot = (v.iter().zip(creep)).fold(S::zero(), |sum, (&v, &q)| sum + v * q);
        let dot = S::select(elastic, S::zero(), dot);
        let outward = (dot + root(dot.square())).scale(0.5);
        let flow = yields * outward / S::select(elastic, S::one(), crept);
        std::array::from_fn(|k| match (v.get(k), creep.get(k)) {
            (Some(&v), Some(&q)) => {
                let sticking = (v - flow * q).scale(per_deformation);
                let sliding = q.scale(-vs * per_deformation);
                sticking + slides * (sliding - sticking)
            }
            _ => S::zero(),
        })
    }
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

    /// Returns the number of components in which surfaces creep.
    pub fn n_creeps(&self) -> usize {
        match (self.grip.deformation, self.kind) {
            (None, _) => 0,
            (_, Kind::Revolute | Kind::Translational) => 1,
            (_, Kind::Cylindrical | Kind::Pins { .. }) => 2,
            (_, Kind::Spherical) => 3,
        }
    }

    /// Returns the velocities at which surfaces slip; the two pins of a cross slip each for itself.
    fn slips<S: Scalar>(&self, i: &MarkerState<S>, j: &MarkerState<S>) -> [S; MAX_SLIPS] {
        let z = j.R_GM.column(2);
        let w = i.w_GM - j.w_GM;
        let sliding = || (i.v_GM - j.v_GM - j.w_GM.cross(i.p_GM - j.p_GM)).dot(z);
        let (r, zero) = (self.radius, S::zero());
        match self.kind {
            Kind::Revolute => [w.dot(z).scale(r), zero, zero],
            Kind::Translational => [sliding(), zero, zero],
            Kind::Cylindrical => [sliding(), w.dot(z).scale(r), zero],
            Kind::Spherical => [0, 1, 2].map(|k| w.dot(j.R_GM.column(k)).scale(r)),
            Kind::Pins { i: on_i, j: on_j } => {
                let pins = [i.R_GM.column(on_i), j.R_GM.column(on_j)];
                [w.dot(pins[0]).scale(r), w.dot(pins[1]).scale(r), zero]
            }
        }
    }

    /// Returns the components that slip together, surface by surface.
    fn surfaces(&self) -> impl Iterator<Item = Range<usize>> + use<> {
        let (n_surfaces, n_slips) = match self.kind {
            Kind::Revolute | Kind::Translational => (1, 1),
            Kind::Cylindrical => (1, 2),
            Kind::Spherical => (1, 3),
            Kind::Pins { .. } => (2, 1),
        };
        (0..n_surfaces).map(move |k| k * n_slips..(k + 1) * n_slips)
    }

    /// Returns µ along each component, and the same with coefficients of one.
    fn coefficients<S: Scalar>(&self, v: &[S], creep: &[S]) -> [[S; MAX_SLIPS]; 2] {
        let mut found = [[S::zero(); MAX_SLIPS]; 2];
        for surface in self.surfaces() {
            let crept = creep.get(surface.clone()).unwrap_or_default();
            for (found, grip) in found.iter_mut().zip([self.grip, self.grip.whole()]) {
                let mu = grip.coefficients(&v[surface.clone()], crept);
                found[surface.clone()].copy_from_slice(&mu[..surface.len()]);
            }
        }
        found
    }

    /// Returns the rates of the creep, over the largest that is possible   (n_creeps)
    pub fn creep_rates<S: Scalar>(
        &self,
        i: &MarkerState<S>,
        j: &MarkerState<S>,
        creep: &[S],
    ) -> Vec<S> {
        let v = self.slips(i, j);
        let rates = self.surfaces().filter_map(|surface| {
            let crept = creep.get(surface.clone())?;
            let rates = self.grip.creep_rates(&v[surface.clone()], crept);
            Some(rates.into_iter().take(surface.len()))
        });
        rates.flatten().collect()
    }

    /// Returns how a pin is pressed, as a torque, by the reaction's force and moment along and
    /// across its axis.
    fn pressed_on_pin<S: Scalar>(&self, axis: Vec3<S>, force: Vec3<S>, moment: Vec3<S>) -> S {
        let along = force.dot(axis);
        let across = size(force - axis.times(along));
        let bending = size(moment - axis.times(moment.dot(axis)));
        let r = self.radius;
        along.abs().scale(self.friction_arm) + across.scale(r) + bending.scale(r / self.bending_arm)
    }

    /// Returns friction and slip, from the joint's reaction on I about its origin, in ground axes,
    /// and the creep over the largest that is possible (n_creeps).
    pub fn slip<S: Scalar>(
        &self,
        i: &MarkerState<S>,
        j: &MarkerState<S>,
        reaction: &Action<S>,
        creep: &[S],
    ) -> Slip<S> {
        let taken = |k: usize, v: Vec3<S>| if self.takes[k] { v } else { Vec3::zero() };
        let z = j.R_GM.column(2);
        let force = taken(0, reaction.force);
        let torsion = z.times(reaction.torque.dot(z));
        let bending = taken(1, reaction.torque - torsion);
        let torsion = taken(2, torsion);
        let d = i.p_GM - j.p_GM;
        let w = i.w_GM - j.w_GM;
        let slips = self.slips(i, j);
        let [mu, whole] = self.coefficients(&slips, creep);
        let slide = |k: usize, pressed: S| -(mu[k] * pressed + whole[k].scale(self.force_preload));
        let turn = |k: usize, pressed: S| -(mu[k] * pressed + whole[k].scale(self.torque_preload));
        let none = Vec3::zero();
        let (force, torque, velocity, spin) = match self.kind {
            Kind::Revolute => {
                let torque = turn(0, self.pressed_on_pin(z, force, bending));
                (none, z.times(torque), none, z.times(w.dot(z)))
            }
            Kind::Translational => {
                let across = size(force - z.times(force.dot(z)));
                let pressed = across
                    + size(bending) / self.overlapping(d.dot(z))
                    + size(torsion).scale(1.0 / self.reaction_arm);
                (z.times(slide(0, pressed)), none, z.times(slips[0]), none)
            }
            Kind::Cylindrical => {
                let across = size(force - z.times(force.dot(z)));
                let pressed = across + size(bending) / self.overlapping(d.dot(z));
                let (f, t) = (slide(0, pressed), turn(1, pressed.scale(self.radius)));
                let (velocity, spin) = (z.times(slips[0]), z.times(w.dot(z)));
                (z.times(f), z.times(t), velocity, spin)
            }
            Kind::Spherical => {
                let pressed = size(force).scale(self.radius);
                let about = |k: usize| j.R_GM.column(k).times(turn(k, pressed));
                (none, about(0) + about(1) + about(2), none, w)
            }
            Kind::Pins { i: on_i, j: on_j } => {
                let mut torque = Vec3::zero();
                let pins = [i.R_GM.column(on_i), j.R_GM.column(on_j)];
                for (k, axis) in pins.into_iter().enumerate() {
                    torque += axis.times(turn(k, self.pressed_on_pin(axis, force, Vec3::zero())));
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
