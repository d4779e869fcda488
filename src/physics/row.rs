//! The few scalar constraint equations that all constraints are made of.
//!
//! Each is a formula of the frames of two markers I and J, generic over the number. Its gradient (the wrench of a unit
//! multiplier) comes from evaluating it over duals along the twists of the two markers, its rate and the term γ of
//! `G v̇ = γ` from evaluating it over jets in time. With `d = p_I − p_J`:
//!
//! ```text
//! Offset(k)      d · e_k                     e_k: ground axis
//! Along(k)       d · axis_k(J)
//! Dot(a, b)      axis_a(I) · axis_b(J)
//! EqualDots      x_I · y_J − y_I · x_J
//! Angle          x_I · (cos f y_J − sin f x_J) = sin(θ − f),  θ the angle about z_J, f a given function
//! ```

use crate::scalar::Scalar;
use crate::space::Frame;

/// A scalar equation between two marker frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// origins agree along a ground axis
    Offset(usize),
    /// I's origin has no offset along an axis of J
    Along(usize),
    /// an axis of I is perpendicular to an axis of J
    Dot(usize, usize),
    /// constant velocity
    EqualDots,
    /// the angle of I about z of J is what `drive` says
    Angle,
}

impl Law {
    /// What must vanish. `drive` is the prescribed value of a MOTION: subtracted from a length, the angle of [`Law::Angle`].
    pub fn value<S: Scalar>(self, i: &Frame<S>, j: &Frame<S>, drive: Option<S>) -> S {
        let length = |x: S| drive.map_or(x, |f| x - f);
        match self {
            Law::Offset(k) => length(i.position.0[k] - j.position.0[k]),
            Law::Along(k) => length((i.position - j.position).dot(j.rotation.column(k))),
            Law::Dot(a, b) => i.rotation.column(a).dot(j.rotation.column(b)),
            Law::EqualDots => {
                let (x_i, y_i) = (i.rotation.column(0), i.rotation.column(1));
                let (x_j, y_j) = (j.rotation.column(0), j.rotation.column(1));
                x_i.dot(y_j) - y_i.dot(x_j)
            }
            Law::Angle => {
                let x_i = i.rotation.column(0);
                let along = x_i.dot(j.rotation.column(0));
                let across = x_i.dot(j.rotation.column(1));
                let (s, c) = drive.unwrap_or_else(S::zero).sin_cos();
                across * c - along * s
            }
        }
    }

    /// The name Adams gives such an equation, for example `Zi.Xj`.
    pub fn name(self) -> String {
        let axis = |k: usize| ["X", "Y", "Z"][k];
        match self {
            Law::Offset(k) => format!("D.{}g", axis(k)),
            Law::Along(k) => format!("D.{}j", axis(k)),
            Law::Dot(a, b) => format!("{}i.{}j", axis(a), axis(b)),
            Law::EqualDots => "Xi.Yj-Yi.Xj".into(),
            Law::Angle => "Angle".into(),
        }
    }

    /// Whether the value is a length (or else a pure number).
    pub fn is_length(self) -> bool {
        matches!(self, Law::Offset(_) | Law::Along(_))
    }
}
