//! The few scalar constraint equations that all constraints are made of.
//!
//! Each is a formula of the frames of two markers I and J, generic over the scalar. Its gradient
//! (the wrench of a unit multiplier) comes from evaluating it over duals along the twists of the
//! two markers, its rate and the term γ of `G v̇ = γ` from evaluating it over jets in time. With
//! `d = p_I − p_J`:
//!
//! ```text
//! Offset(k)      d · e_k                     e_k: ground axis
//! Along(k)       d · axis_k(J)
//! Dot(a, b)      axis_a(I) · axis_b(J)
//! EqualDots      x_I · y_J − y_I · x_J
//! Angle          x_I · (cos f y_J − sin f x_J) = sin(θ − f),  θ the angle about z_J, f given
//! BodyAngle(k)   β_k − f for k = 0, 1, 2: body-fixed 1-2-3 angles, R_JI = Rx(β₁) Ry(β₂) Rz(β₃)
//! ```
//!
//! `BodyAngle` is written as sin(β − f) too, with the common factor cos β₂ left in for β₁ and β₃,
//! so that nothing is singular but the angles themselves (β₂ = ±90°).

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
    /// rotations about two axes are equal: the constant-velocity joint
    EqualDots,
    /// the angle of I about z of J equals `drive`
    Angle,
    /// a body 1-2-3 angle of I in J (0, 1, 2) equals `drive`
    BodyAngle(usize),
}

impl Law {
    /// Evaluates the equation; it holds at zero. `drive` is the prescribed value of a MOTION:
    /// subtracted from a length, the angle of [`Law::Angle`].
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
            Law::BodyAngle(k) => {
                // R_JI: R[0][2] = sin β₂, R[1][2] = −sin β₁ cos β₂, R[2][2] = cos β₁ cos β₂,
                //       R[0][1] = −cos β₂ sin β₃, R[0][0] = cos β₂ cos β₃
                let r = |row: usize, column: usize| {
                    j.rotation.column(row).dot(i.rotation.column(column))
                };
                let (y, x) = match k {
                    0 => (-r(1, 2), r(2, 2)),
                    1 => (r(0, 2), (r(0, 0).square() + r(0, 1).square()).sqrt()),
                    _ => (-r(0, 1), r(0, 0)),
                };
                let (s, c) = drive.unwrap_or_else(S::zero).sin_cos();
                y * c - x * s
            }
        }
    }

    /// Returns the value of `drive` at which a driven law holds; an angle as its principal value.
    pub fn shown(self, i: &Frame<f64>, j: &Frame<f64>) -> f64 {
        let at = |drive: f64| self.value(i, j, Some(drive));
        if self.is_length() {
            at(0.0)
        } else {
            // sin(θ − f) at f = 0 and at f = −90°
            at(0.0).atan2(at(-std::f64::consts::FRAC_PI_2))
        }
    }

    /// Returns the name that Adams gives the equation, for example `Zi.Xj`.
    pub fn name(self) -> String {
        let axis = |k: usize| ["X", "Y", "Z"][k];
        match self {
            Law::Offset(k) => format!("D.{}g", axis(k)),
            Law::Along(k) => format!("D.{}j", axis(k)),
            Law::Dot(a, b) => format!("{}i.{}j", axis(a), axis(b)),
            Law::EqualDots => "Xi.Yj-Yi.Xj".into(),
            Law::Angle => "Angle".into(),
            Law::BodyAngle(k) => format!("B{}", k + 1),
        }
    }

    /// Returns whether the value is a length (or else a pure number).
    pub fn is_length(self) -> bool {
        matches!(self, Law::Offset(_) | Law::Along(_))
    }
}
