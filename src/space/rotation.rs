//! Rotations from angles and quaternions. The only file that knows Euler sequences and quaternions.
//!
//! 3-1-3 angles (PSI, THETA, PHI) are body-fixed: `R = Rz(ψ) Rx(θ) Rz(φ)`. Angles are radians.

use super::{Mat3, Vec3};
use crate::scalar::Scalar;

/// Returns the rotation by `angle` about axis `k` (0 x, 1 y, 2 z), right-handed.
#[inline(always)]
pub fn about_axis<S: Scalar>(k: usize, angle: S) -> Mat3<S> {
    let (s, c) = angle.sin_cos();
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let mut m = Mat3::zero();
    m.0[k][k] = S::one();
    m.0[i][i] = c;
    m.0[j][j] = c;
    m.0[i][j] = -s;
    m.0[j][i] = s;
    m
}

/// Returns `R = Rz(ψ) Rx(θ) Rz(φ)`.
pub fn from_313<S: Scalar>(psi: S, theta: S, phi: S) -> Mat3<S> {
    about_axis(2, psi) * about_axis(0, theta) * about_axis(2, phi)
}

/// Returns the body-fixed 3-1-3 angles of a rotation, θ from 0 to π; where z and z' are one line
/// within rounding, φ is 0.
///
/// ```text
/// cos φ = eᵩ · x'    −sin φ = eᵩ · y'    with eᵩ = (cos ψ, sin ψ, 0), the line of nodes
/// ```
///
/// φ follows from ψ, so that the three give the rotation back to rounding even where θ is so near
/// to 0 or π that ψ and φ are hardly known apart.
pub fn to_313(R: &Mat3<f64>) -> [f64; 3] {
    let m = &R.0;
    let sine = (m[0][2] * m[0][2] + m[1][2] * m[1][2]).sqrt();
    let theta = Scalar::atan2(sine, m[2][2]);
    if sine < 4.0 * f64::EPSILON {
        return [Scalar::atan2(m[1][0], m[0][0]), theta, 0.0];
    }
    let psi = Scalar::atan2(m[0][2], -m[1][2]);
    let (s, c) = Scalar::sin_cos(psi);
    let [x, y] = [0, 1].map(|k| c * m[0][k] + s * m[1][k]);
    [psi, theta, Scalar::atan2(-y, x)]
}

/// Returns the rotation with these angles between each axis and what it becomes, 0 … π, about that
/// of the possible axes which is nearest to `near`; `None` where there is none.
///
/// ```text
/// cos αₖ = c + (1 − c) uₖ²,   c = cos of the angle of the rotation, u its axis
/// ```
pub fn with_angles_between_axes(angles: [f64; 3], near: Vec3<f64>) -> Option<Mat3<f64>> {
    /// Share of the axis below zero that six digits of the angles leave.
    const ROUNDING: f64 = 1e-4;
    let cosines = angles.map(Scalar::cos);
    let c = 0.5 * (cosines.iter().sum::<f64>() - 1.0);
    let left = 1.0 - c;
    if left < ROUNDING * ROUNDING {
        return Some(Mat3::identity());
    }
    let shares = cosines.map(|cosine| (cosine - c) / left);
    if shares
        .iter()
        .any(|share| share.is_nan() || *share < -ROUNDING)
    {
        return None;
    }
    let axis = [0, 1, 2].map(|k| shares[k].max(0.0).sqrt().copysign(near.0[k] + 0.0));
    let half = 0.5 * Scalar::acos(c.clamp(-1.0, 1.0));
    let (sine, cosine) = Scalar::sin_cos(half);
    let [x, y, z] = axis.map(|x| x * sine);
    Some(from_quaternion([cosine, x, y, z]))
}

/// Returns the frame with z along `z` and x in the half plane of `x`, or `None` when they are
/// parallel or zero.
pub fn from_z_and_x(z: Vec3<f64>, x: Vec3<f64>) -> Option<Mat3<f64>> {
    let unit = |v: Vec3<f64>| {
        let n = v.norm();
        (n > 0.0 && n.is_finite()).then(|| v.times(1.0 / n))
    };
    let z = unit(z)?;
    let y = z.cross(unit(x)?);
    if y.norm() < 1e-12 {
        return None;
    }
    let y = unit(y)?;
    Some(Mat3::from_columns(y.cross(z), y, z))
}

/// Returns the rotation matrix of the quaternion (w, x, y, z), scaled to unit length:
/// `R = R(q/|q|)`.
pub fn from_quaternion<S: Scalar>(q: [S; 4]) -> Mat3<S> {
    let [w, x, y, z] = q;
    let n = w * w + x * x + y * y + z * z;
    let f = S::constant(2.0) / n;
    let one = S::one();
    Mat3([
        [
            one - f * (y * y + z * z),
            f * (x * y - w * z),
            f * (x * z + w * y),
        ],
        [
            f * (x * y + w * z),
            one - f * (x * x + z * z),
            f * (y * z - w * x),
        ],
        [
            f * (x * z - w * y),
            f * (y * z + w * x),
            one - f * (x * x + y * y),
        ],
    ])
}

/// Returns the rate of a quaternion for the angular velocity `w_B` in body axes:
/// `q̇ = ½ q ∘ (0, ω)`.
pub fn quaternion_rate<S: Scalar>(q: [S; 4], w: Vec3<S>) -> [S; 4] {
    let [a, x, y, z] = q;
    let [p, r, s] = w.0;
    [
        (-(x * p + y * r + z * s)).scale(0.5),
        (a * p + y * s - z * r).scale(0.5),
        (a * r + z * p - x * s).scale(0.5),
        (a * s + x * r - y * p).scale(0.5),
    ]
}

/// Returns the unit quaternion (w, x, y, z) of a rotation matrix, w ≥ 0 (Shepperd's choice of the
/// largest pivot).
pub fn to_quaternion(r: &Mat3<f64>) -> [f64; 4] {
    let m = &r.0;
    let trace = m[0][0] + m[1][1] + m[2][2];
    let candidates = [trace, m[0][0], m[1][1], m[2][2]];
    let largest = (0..4).fold(0, |best, k| {
        if candidates[k] > candidates[best] {
            k
        } else {
            best
        }
    });
    let mut q = [0.0; 4];
    if largest == 0 {
        let s = 2.0 * (1.0 + trace).sqrt();
        q = [
            s / 4.0,
            (m[2][1] - m[1][2]) / s,
            (m[0][2] - m[2][0]) / s,
            (m[1][0] - m[0][1]) / s,
        ];
    } else {
        let (i, j, k) = (largest - 1, largest % 3, (largest + 1) % 3);
        let s = 2.0 * (1.0 + m[i][i] - m[j][j] - m[k][k]).sqrt();
        q[0] = (m[k][j] - m[j][k]) / s;
        q[i + 1] = s / 4.0;
        q[j + 1] = (m[j][i] + m[i][j]) / s;
        q[k + 1] = (m[k][i] + m[i][k]) / s;
    }
    let n = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let sign = if q[0] < 0.0 { -1.0 } else { 1.0 };
    q.map(|x| sign * x / n)
}

/// Returns the rotation vector of a rotation: axis times angle.
pub fn vector(R: &Mat3<f64>) -> Vec3<f64> {
    let [w, x, y, z] = to_quaternion(R);
    let (sine, sign) = (
        (x * x + y * y + z * z).sqrt(),
        if w < 0.0 { -1.0 } else { 1.0 },
    );
    if sine == 0.0 {
        return Vec3::zero();
    }
    let angle = 2.0 * Scalar::atan2(sine, w.abs());
    Vec3([x, y, z]).times(sign * angle / sine)
}

/// Rounds the entries that differ from 0, 1 or −1 by rounding only.
///
/// `90D` in a dataset gives a cosine of 6e-17; a zero there lets whole products be left out of a
/// scene. The change is of the size of one rounding error.
pub fn snapped(r: &Mat3<f64>) -> Mat3<f64> {
    Mat3(r.0.map(|row| {
        row.map(|x| {
            let whole = if x.abs() < 0.5 { 0.0_f64 } else { 1.0 }.copysign(x);
            if (x - whole).abs() < 4.0 * f64::EPSILON {
                whole
            } else {
                x
            }
        })
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Also where θ is near 0 or π, where the two other angles are hardly known apart.
        #[test]
        fn angles_of_a_rotation_give_it_back(
            psi in -4.0..4.0, phi in -4.0..4.0, theta in 0.0..std::f64::consts::PI,
            near in prop::sample::select(vec![1.0, 1e-5, 1e-8, 1e-12, 0.0]), at_pi in any::<bool>(),
        ) {
            let theta = theta * near;
            let theta = if at_pi { std::f64::consts::PI - theta } else { theta };
            let R = from_313(psi, theta, phi);
            let [a, b, c] = to_313(&R);
            let back = from_313(a, b, c);
            for row in 0..3 {
                for column in 0..3 {
                    let off = (back.0[row][column] - R.0[row][column]).abs();
                    prop_assert!(off < 1e-14, "{off:e} at {theta:e}");
                }
            }
        }
    }
}
