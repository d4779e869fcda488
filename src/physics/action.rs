//! The action of an element on its I marker, and the laws of two markers that need nothing but
//! their states.
//!
//! Every element acts on the part of I at the origin of I; the part of J gets the opposite force
//! *at the same point* and the opposite torque. About J's own origin that is
//! `T_J = −T_I − (p_I − p_J) × F_I`: the transfer moment of bushings and beams, and no moment at
//! all for a force along the line I–J.

use crate::expr::measures::Measure;
use crate::scalar::Scalar;
use crate::space::{MarkerState, Vec3};

/// A force and a torque on I about I's origin, in ground axes.
#[derive(Clone, Copy, Debug)]
pub struct Action<S> {
    /// force, in ground axes
    pub force: Vec3<S>,
    /// torque about the origin of I, in ground axes
    pub torque: Vec3<S>,
}

impl<S: Scalar> Action<S> {
    /// Returns no force and no torque.
    pub fn zero() -> Self {
        Self {
            force: Vec3::zero(),
            torque: Vec3::zero(),
        }
    }
    /// Returns the action multiplied by `factor`.
    pub fn times(&self, factor: S) -> Self {
        Self {
            force: self.force.times(factor),
            torque: self.torque.times(factor),
        }
    }
    /// Returns the reaction, about J's origin.
    pub fn reaction(&self, p_GI: Vec3<S>, p_GJ: Vec3<S>) -> Self {
        Self {
            force: -self.force,
            torque: -self.torque - (p_GI - p_GJ).cross(self.force),
        }
    }
    /// Returns the same action about `b` instead of `a`, both in ground.
    pub fn about(&self, a: Vec3<S>, b: Vec3<S>) -> Self {
        Self {
            force: self.force,
            torque: self.torque + (a - b).cross(self.force),
        }
    }
    /// Returns the sum with another action on the same marker.
    pub fn plus(&self, b: &Self) -> Self {
        Self {
            force: self.force + b.force,
            torque: self.torque + b.torque,
        }
    }
}

/// A law between two markers that needs nothing but its own numbers, their states and the angles
/// between them.
pub trait Law {
    /// Returns the angles of I in J that it reads.
    fn angles(&self) -> &'static [Measure];

    /// Returns the action on I. `angle`: one of these angles, in rad, turns counted.
    fn action<S: Scalar>(
        &self,
        i: &MarkerState<S>,
        j: &MarkerState<S>,
        angle: impl Fn(Measure) -> S,
    ) -> Action<S>;
}

/// The three angles of I in J.
pub const ALL_ANGLES: [Measure; 3] = [Measure::Ax, Measure::Ay, Measure::Az];

/// Returns the unit vector from J to I and the distance; the vector and its derivative are zero
/// where they coincide.
pub fn line_of_sight<S: Scalar>(i: &MarkerState<S>, j: &MarkerState<S>) -> (Vec3<S>, S) {
    let d = i.p_GM - j.p_GM;
    let n2 = d.norm2();
    let zero = n2.le(S::zero());
    let length = S::select(zero, S::one(), n2).sqrt();
    let factor = S::select(zero, S::zero(), S::one() / length);
    (d.times(factor), S::select(zero, S::zero(), length))
}

/// Returns the action of a SFORCE: `magnitude` along the line of sight (TRANSLATION), along z_J
/// (ACTIONONLY), or as a torque about z_J (ROTATION).
pub fn single_force<S: Scalar>(
    rotational: bool,
    action_only: bool,
    i: &MarkerState<S>,
    j: &MarkerState<S>,
    magnitude: S,
) -> Action<S> {
    let z_J = j.R_GM.column(2);
    match (rotational, action_only) {
        (true, _) => Action {
            force: Vec3::zero(),
            torque: z_J.times(magnitude),
        },
        (false, true) => Action {
            force: z_J.times(magnitude),
            torque: Vec3::zero(),
        },
        (false, false) => Action {
            force: line_of_sight(i, j).0.times(magnitude),
            torque: Vec3::zero(),
        },
    }
}

/// Returns the action of a VFORCE, VTORQUE or GFORCE: components along the axes of RM.
pub fn vector_force<S: Scalar>(rm: &MarkerState<S>, force: [S; 3], torque: [S; 3]) -> Action<S> {
    Action {
        force: rm.R_GM.apply(Vec3(force)),
        torque: rm.R_GM.apply(Vec3(torque)),
    }
}
