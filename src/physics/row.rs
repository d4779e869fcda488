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
//! BodyAngle      sin(β_k − f_k) times a factor, R_JI = Rx(β₁) Ry(β₂) Rz(β₃): body-fixed 1-2-3
//! ```
//!
//! A body angle is read off R in different ways, none of which is singular where the angles are
//! not:
//!
//! ```text
//! driven     factor   sin β_k, cos β_k, each times the factor
//! β₁         cos β₂   −R₁₂, R₂₂
//! β₂         1        R₀₂, ±√(R₁₂² + R₂₂²)                               (1)
//! β₃         cos β₂   −R₀₁, R₀₀
//! β₁ and β₃  1        β₁: y″·z_J, y″·y_J with y″ = sin f₃ x_I + cos f₃ y_I
//! β₂ and β₁  1        β₂: R₀₂, cos f₁ R₂₂ − sin f₁ R₁₂
//! β₂ and β₃  1        β₂: R₀₂, cos f₃ R₀₀ − sin f₃ R₀₁
//! all        1        β₃: x_I·y′, y_I·y′ with y′ = (0, cos f₁, sin f₁) in J
//! ```
//!
//! Every rotation has two triples of body angles, (β₁, β₂, β₃) and (β₁ + 180°, 180° − β₂,
//! β₃ + 180°). The sign in (1) is that of cos f₂. Within a thousandth of ±90°, where that passes
//! through zero and a mechanism goes on smoothly, it is the sign of cos(β₁ − b) cos β₂, where b is
//! β₁ as it was assembled.
//!
//! A row that is a sine or a cosine holds at the opposite angle too, and does not change with the
//! angle a quarter turn away. Assembly chooses the right one (`analysis/start/branch.rs`); from
//! there on rows are followed.

use crate::scalar::Scalar;
use crate::scalar::hypot;
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
    /// a body 1-2-3 angle of I in J equals `drive`
    BodyAngle {
        /// 0, 1, 2
        angle: usize,
        /// another angle between the same markers, driven too, with which it is read off
        beside: Option<usize>,
    },
}

/// The prescribed values that a driven law reads.
#[derive(Clone, Copy, Debug)]
pub struct Drive<S> {
    /// what its own MOTION prescribes   [rad, length]
    pub value: S,
    /// what the MOTION of the angle beside it prescribes; zero where there is none   \[rad\]
    pub beside: S,
    /// β₁ as it was assembled, on the side of the driven β₂   \[rad\]
    pub reference: f64,
}

impl<S: Scalar> Drive<S> {
    /// Returns the drive of a law that reads its own value only.
    pub fn of(value: S) -> Self {
        Self {
            value,
            beside: S::zero(),
            reference: 0.0,
        }
    }

    /// Returns the drive over another scalar.
    pub fn map<T>(self, lift: impl Fn(S) -> T) -> Drive<T> {
        Drive {
            value: lift(self.value),
            beside: lift(self.beside),
            reference: self.reference,
        }
    }
}

/// Cosine of a driven β₂ below which its sign is that of the configuration.
const NEAR_GIMBAL: f64 = 1e-3;
/// Square of cos β₂ below which β₁ is taken as it was assembled: nothing is left to read it off.
const AT_GIMBAL: f64 = 1e-14;

impl Law {
    /// Evaluates the equation; it holds at zero. `drive`: the value of a MOTION, which is
    /// subtracted from a length and is the angle of the others.
    pub fn value<S: Scalar>(self, i: &Frame<S>, j: &Frame<S>, drive: Option<Drive<S>>) -> S {
        let length = |x: S| drive.map_or(x, |f| x - f.value);
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
                let (s, c) = drive.map_or_else(S::zero, |f| f.value).sin_cos();
                across * c - along * s
            }
            Law::BodyAngle { angle, beside } => {
                let drive = drive.unwrap_or_else(|| Drive::of(S::zero()));
                let (s, c) = drive.value.sin_cos();
                let (y, x) = body_angle((angle, beside), i, j, &drive, Some(c));
                y * c - x * s
            }
        }
    }

    /// Returns the value of `drive` at which a driven law holds; an angle as its principal value,
    /// on the side of the drive's reference.
    pub fn shown<S: Scalar>(self, i: &Frame<S>, j: &Frame<S>, drive: Drive<S>) -> S {
        if let Law::BodyAngle { angle, beside } = self {
            let (y, x) = body_angle((angle, beside), i, j, &drive, None);
            return y.atan2(x);
        }
        let at = |drive: f64| self.value(i, j, Some(Drive::of(S::constant(drive))));
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
            Law::BodyAngle { angle, .. } => format!("B{}", angle + 1),
        }
    }

    /// Returns whether the value is a length (or else a pure number).
    pub fn is_length(self) -> bool {
        matches!(self, Law::Offset(_) | Law::Along(_))
    }
}

/// Returns sine and cosine of a body 1-2-3 angle, both with the same factor (the table above).
/// `cosine`: that of the driven β₂, whose sign the angle takes; `None`: it takes that of the
/// reference.
fn body_angle<S: Scalar>(
    (angle, beside): (usize, Option<usize>),
    i: &Frame<S>,
    j: &Frame<S>,
    drive: &Drive<S>,
    cosine: Option<S>,
) -> (S, S) {
    // R_JI: R[0][2] = sin β₂, R[1][2] = −sin β₁ cos β₂, R[2][2] = cos β₁ cos β₂,
    //       R[0][1] = −cos β₂ sin β₃, R[0][0] = cos β₂ cos β₃
    let r = |row: usize, column: usize| j.rotation.column(row).dot(i.rotation.column(column));
    let (s, c) = drive.beside.sin_cos();
    match (angle, beside) {
        (0, None) => (-r(1, 2), r(2, 2)),
        (0, Some(_)) => (
            s * r(2, 0) + c * r(2, 1), // y″ along z_J
            s * r(1, 0) + c * r(1, 1), // y″ along y_J
        ),
        (1, None) => (r(0, 2), signed_cosine(-r(1, 2), r(2, 2), drive, cosine)),
        (1, Some(0)) => (r(0, 2), c * r(2, 2) - s * r(1, 2)),
        (1, Some(_)) => (r(0, 2), c * r(0, 0) - s * r(0, 1)),
        (_, None) => (-r(0, 1), r(0, 0)),
        (_, Some(_)) => (
            c * r(1, 0) + s * r(2, 0), // x_I along y′
            c * r(1, 1) + s * r(2, 1), // y_I along y′
        ),
    }
}

/// Returns cos β₂ of `y = sin β₁ cos β₂` and `x = cos β₁ cos β₂`, with its sign (1).
fn signed_cosine<S: Scalar>(y: S, x: S, drive: &Drive<S>, cosine: Option<S>) -> S {
    let (s, c) = Scalar::sin_cos(drive.reference);
    let along = x.scale(c) + y.scale(s);
    let zero = S::zero();
    let sign = match cosine {
        Some(f) => S::select(f.abs().lt(S::constant(NEAR_GIMBAL)), along, f),
        None => along,
    };
    let square = x.square() + y.square();
    let lost = square.lt(S::constant(AT_GIMBAL));
    let size = S::select(lost, S::one(), square).sqrt();
    let signed = S::select(sign.lt(zero), -size, size);
    S::select(lost, along, signed)
}

/// Turn about the first and the last axis together below which I counts as turned against J about
/// the middle one, in rad.
const ABOUT_THE_MIDDLE: f64 = std::f64::consts::FRAC_PI_4;

/// Returns the body 1-2-3 angles of I in J: the principal triple (cos β₂ ≥ 0), but beyond ±90° the
/// other one where I is turned about the middle axis and hardly about others.
pub fn body_angles(i: &Frame<f64>, j: &Frame<f64>) -> [f64; 3] {
    about_the_middle(i, j).unwrap_or_else(|| both_triples(i, j)[0])
}

/// Returns the triple of body angles that turns I against J about the middle axis and hardly about
/// others; `None`: neither does.
pub fn about_the_middle(i: &Frame<f64>, j: &Frame<f64>) -> Option<[f64; 3]> {
    let hardly = |b: &[f64; 3]| b[0].abs() + b[2].abs() < ABOUT_THE_MIDDLE;
    both_triples(i, j).into_iter().find(hardly)
}

/// Returns both triples of body 1-2-3 angles of I in J, the principal one first.
fn both_triples(i: &Frame<f64>, j: &Frame<f64>) -> [[f64; 3]; 2] {
    let r = |row: usize, column: usize| j.rotation.column(row).dot(i.rotation.column(column));
    let cosine = hypot(r(1, 2), r(2, 2));
    let first = [
        Scalar::atan2(-r(1, 2), r(2, 2)),
        Scalar::atan2(r(0, 2), cosine),
        Scalar::atan2(-r(0, 1), r(0, 0)),
    ];
    let second = [
        Scalar::atan2(r(1, 2), -r(2, 2)),
        Scalar::atan2(r(0, 2), -cosine),
        Scalar::atan2(r(0, 1), -r(0, 0)),
    ];
    [first, second]
}
