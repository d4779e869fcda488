//! Position and motion in space: vectors, rotations, frames.
//!
//! All generic over [`Scalar`]. Names follow the monogram notation: `p_JI_K` is the position of I
//! from J expressed in K, `R_GP` turns vectors of P into vectors of G, `w_GP` is the angular
//! velocity of P in G. Lengths are in model units, angles in rad.

pub mod rotation;
mod vector;

pub use vector::{Frame, Mat3, Vec3};

use crate::scalar::Scalar;

/// The state of a marker: pose, velocity and acceleration, all in ground and in ground axes.
#[derive(Clone, Copy, Debug)]
#[allow(non_snake_case)]
pub struct MarkerState<S> {
    /// orientation; the columns are the marker's axes in ground
    pub R_GM: Mat3<S>,
    /// position of the origin
    pub p_GM: Vec3<S>,
    /// angular velocity
    pub w_GM: Vec3<S>,
    /// velocity of the origin
    pub v_GM: Vec3<S>,
    /// angular acceleration
    pub alpha_GM: Vec3<S>,
    /// acceleration of the origin
    pub a_GM: Vec3<S>,
}

impl<S: Scalar> MarkerState<S> {
    /// Returns the state of ground itself: at the origin, aligned, at rest.
    pub fn ground() -> Self {
        Self {
            R_GM: Mat3::identity(),
            p_GM: Vec3::zero(),
            w_GM: Vec3::zero(),
            v_GM: Vec3::zero(),
            alpha_GM: Vec3::zero(),
            a_GM: Vec3::zero(),
        }
    }

    /// Returns the same pose without velocities and accelerations.
    pub fn stopped(&self) -> Self {
        Self {
            R_GM: self.R_GM,
            p_GM: self.p_GM,
            ..Self::ground()
        }
    }

    /// Returns the state of a marker at a frame that does not move.
    pub fn at_rest(X_GM: Frame<S>) -> Self {
        Self {
            R_GM: X_GM.rotation,
            p_GM: X_GM.position,
            ..Self::ground()
        }
    }
}
