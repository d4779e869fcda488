//! Position and motion in space: vectors, rotations, frames.
//!
//! All generic over [`Scalar`]. Names follow the monogram notation: `p_JI_K` is the position of I
//! from J expressed in K, `R_GP` turns vectors of P into vectors of G, `w_GP` is the angular
//! velocity of P in G. Lengths are in model units, angles in rad.

pub mod rotation;
mod vector;

pub use vector::{Frame, Mat3, Vec3};

use crate::scalar::{Jet, Scalar};

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
    /// Returns the pose with its first two rates in time.
    ///
    /// ```text
    /// Ṙ = ω × R        R̈ = α × R + ω × Ṙ        column by column
    /// ```
    pub fn in_time(&self) -> Frame<Jet<S>> {
        let mut rotation = Mat3::<Jet<S>>::zero();
        for column in 0..3 {
            let axis = self.R_GM.column(column);
            let first = self.w_GM.cross(axis);
            let second = self.alpha_GM.cross(axis) + self.w_GM.cross(first);
            for row in 0..3 {
                rotation.0[row][column] = Jet::new(axis.0[row], first.0[row], second.0[row]);
            }
        }
        let position = Vec3(std::array::from_fn(|k| {
            Jet::new(self.p_GM.0[k], self.v_GM.0[k], self.a_GM.0[k])
        }));
        Frame { rotation, position }
    }

    /// Returns the pose and the velocities with their rates in time: of first order, as those of
    /// accelerations are not known.
    pub fn moving_in_time(&self) -> MarkerState<Jet<S>> {
        let with_rate = |x: Vec3<S>, rate: Vec3<S>| {
            Vec3(std::array::from_fn(|k| {
                Jet::new(x.0[k], rate.0[k], S::zero())
            }))
        };
        MarkerState {
            w_GM: with_rate(self.w_GM, self.alpha_GM),
            v_GM: with_rate(self.v_GM, self.a_GM),
            ..MarkerState::at_rest(self.in_time())
        }
    }

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
