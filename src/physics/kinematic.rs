//! The kinematic measures (DM … WDTZ, AX … PITCH, INCANG, ORIENT) as formulas of marker states.
//!
//! One arm per measure, generic over the scalar: the same lines give the value at a prompt, the
//! derivatives of a Jacobian, a batch of samples, and the nodes of a recorded program. Therefore
//! nothing here inspects a number: where a formula has a singular point it selects the *arguments*
//! of the singular operation, so that no infinite derivative is ever formed, not even in a branch
//! that is dropped.
//!
//! Conventions at singular points: a length has derivative 0 at 0; VR is 0 where the origins
//! coincide; the zero first argument of an arc tangent counts as +0, so that a half turn is +π;
//! where 3-1-3 angles are singular the whole turn is PSI, where 3-2-1 angles are singular it is
//! YAW. AX, AY, AZ and INCANG are principal values here; counting turns needs the history of a run.

#![allow(non_snake_case)]

use crate::expr::measures::{Family, Measure};
use crate::scalar::{Mask, Scalar};
use crate::space::{MarkerState, Vec3};
use std::f64::consts::{PI, TAU};

/// Value below which sin θ of 3-1-3 angles and cos of PITCH count as zero.
const SINGULAR_SINE: f64 = 1e-12;

/// Returns the value of a kinematic measure of the markers `i`, `j`, `k`, `l`, given in the order
/// of its arguments.
///
/// An argument that was not written is ground. VM, VR, ACCM and WDTM take (i, j, l): their L is the
/// third marker. `None`: the measure is not a function of marker states alone (forces, elements,
/// ORIENT with its selectors).
pub fn kinematic<S: Scalar>(
    measure: Measure,
    i: &MarkerState<S>,
    j: &MarkerState<S>,
    k: &MarkerState<S>,
    l: &MarkerState<S>,
) -> Option<S> {
    use Measure as M;
    // R_JI[row, column]: axis `column` of I along axis `row` of J
    let r = |row: usize, column: usize| j.R_GM.column(row).dot(i.R_GM.column(column));
    let p_JI = || i.p_GM - j.p_GM;
    let w_JI = || i.w_GM - j.w_GM;
    let along = |v: Vec3<S>, axis: usize| v.dot(k.R_GM.column(axis));
    #[rustfmt::skip]
    let value = match measure {
        M::Dm => length(p_JI()),
        M::Dx => along(p_JI(), 0),
        M::Dy => along(p_JI(), 1),
        M::Dz => along(p_JI(), 2),

        M::Ax => angle(-r(1, 2), r(2, 2)),
        M::Ay => angle(r(0, 2), r(2, 2)),
        M::Az => angle(r(1, 0), r(0, 0)),

        M::Psi => body_angle([2, 0, 2], 0, r),
        M::Theta => body_angle([2, 0, 2], 1, r),
        M::Phi => body_angle([2, 0, 2], 2, r),
        M::Yaw => body_angle([2, 1, 0], 0, r),
        M::Pitch => -body_angle([2, 1, 0], 1, r),
        M::Roll => body_angle([2, 1, 0], 2, r),

        M::Incang => {
            let (to_i, to_k) = (p_JI(), k.p_GM - j.p_GM);
            angle(length(to_i.cross(to_k)), to_i.dot(to_k))
        }

        M::Vm => length(velocity(i, j, k)),
        M::Vr => {
            let p = p_JI();
            let apart = p.norm2();
            let together = apart.same(S::zero());
            let distance = S::select(together, S::one(), apart).sqrt();
            S::select(together, S::zero(), (i.v_GM - j.v_GM).dot(p) / distance)
        }
        M::Vx => along(velocity(i, j, l), 0),
        M::Vy => along(velocity(i, j, l), 1),
        M::Vz => along(velocity(i, j, l), 2),

        M::Wm => length(w_JI()),
        M::Wx => along(w_JI(), 0),
        M::Wy => along(w_JI(), 1),
        M::Wz => along(w_JI(), 2),

        M::Accm => length(acceleration(i, j, k)),
        M::Accx => along(acceleration(i, j, l), 0),
        M::Accy => along(acceleration(i, j, l), 1),
        M::Accz => along(acceleration(i, j, l), 2),

        M::Wdtm => length(angular_acceleration(i, j, k)),
        M::Wdtx => along(angular_acceleration(i, j, l), 0),
        M::Wdty => along(angular_acceleration(i, j, l), 1),
        M::Wdtz => along(angular_acceleration(i, j, l), 2),

        M::Orient
        | M::Fm | M::Fx | M::Fy | M::Fz | M::Tm | M::Tx | M::Ty | M::Tz
        | M::Beam | M::Bush | M::Field | M::Spdp | M::Sforce | M::Gforce | M::Vforce | M::Vtorq | M::Ptcv | M::Cvcv
        | M::Joint | M::Jprim | M::Motion | M::Contact | M::Nforce | M::Friction
        | M::Varval | M::Aryval | M::Dif | M::Dif1 | M::Pinval | M::Pouval | M::Senval => return None,
    };
    Some(value)
}

/// Returns the value of a kinematic measure for the arguments of an input: identifiers, and the
/// selectors of ORIENT.
///
/// `marker` gives the state of an identifier other than 0, which is ground. `None`: a marker is
/// missing, or the measure is not a function of marker states alone.
pub fn kinematic_of<S: Scalar>(
    measure: Measure,
    arguments: [u32; 4],
    mut marker: impl FnMut(u32) -> Option<MarkerState<S>>,
) -> Option<S> {
    let mut state = |id: u32| {
        if id == 0 {
            Some(MarkerState::ground())
        } else {
            marker(id)
        }
    };
    let [a, b, c, d] = arguments;
    if measure == Measure::Orient {
        return orientation(a, b, &state(c)?, &state(d)?);
    }
    if matches!(
        measure.row().family,
        Family::GenericForce | Family::ElementForce | Family::System
    ) {
        return None;
    }
    kinematic(measure, &state(a)?, &state(b)?, &state(c)?, &state(d)?)
}

/// Returns ORIENT: a component, from 1, of the orientation of `i` in `j`.
///
/// Systems 1 to 12 are angles of body-fixed sequences, 13 to 24 those of the same sequences about
/// the fixed axes of j, 27 the Euler parameters, 28 the Rodrigues parameters (u tan ½φ), 29 the
/// direction cosines, the axes of i one after another (the order in which the routine RCNVRT is
/// documented to list them). `None` for other systems and components.
pub fn orientation<S: Scalar>(
    system: u32,
    component: u32,
    i: &MarkerState<S>,
    j: &MarkerState<S>,
) -> Option<S> {
    let r = |row: usize, column: usize| j.R_GM.column(row).dot(i.R_GM.column(column));
    let component = (component as usize).checked_sub(1)?;
    match system {
        1..=12 if component < 3 => Some(body_angle(SEQUENCES[system as usize - 1], component, r)),
        // turns about fixed axes a, b, c are turns about moving axes c, b, a
        13..=24 if component < 3 => {
            let [a, b, c] = SEQUENCES[system as usize - 13];
            Some(body_angle([c, b, a], 2 - component, r))
        }
        27 => euler_parameters(r).get(component).copied(),
        28 if component < 3 => {
            let e = euler_parameters(r);
            Some(e[component + 1] / e[0])
        }
        29 if component < 9 => Some(r(component % 3, component / 3)),
        _ => None,
    }
}

/// The axes of the sequences of ORIENT, systems 1 and 13 first.
const SEQUENCES: [[usize; 3]; 12] = [
    [0, 1, 2],
    [1, 2, 0],
    [2, 0, 1],
    [0, 2, 1],
    [1, 0, 2],
    [2, 1, 0],
    [0, 1, 0],
    [0, 2, 0],
    [1, 0, 1],
    [1, 2, 1],
    [2, 0, 2],
    [2, 1, 2],
];

/// Returns angle `which` of the body-fixed sequence `a b c` or `a b a`:
/// `R = R_a(θ₁) R_b(θ₂) R_c(θ₃)`.
///
/// With σ = ±1 as (a, b, c), the three different axes, are a cyclic order or not, the entries of R
/// are
///
/// ```text
/// a b c:  R[a,c] = σ sin θ₂      R[b,c] = −σ sin θ₁ cos θ₂    R[c,c] = cos θ₁ cos θ₂
///                                R[a,b] = −σ cos θ₂ sin θ₃    R[a,a] = cos θ₂ cos θ₃
/// a b a:  R[a,a] = cos θ₂        R[b,a] = sin θ₁ sin θ₂       R[c,a] = −σ cos θ₁ sin θ₂
///                                R[a,b] = sin θ₂ sin θ₃       R[a,c] = σ sin θ₂ cos θ₃
/// ```
///
/// Where the common factor is 0 only θ₁ ± θ₃ is determined; then θ₃ = 0, and column b, which the
/// second rotation does not change, gives θ₁: R[b,b] = cos θ₁, R[c,b] = σ sin θ₁.
fn body_angle<S: Scalar>(sequence: [usize; 3], which: usize, r: impl Fn(usize, usize) -> S) -> S {
    let [a, b, last] = sequence;
    let c = 3 - a - b;
    let sigma = |x: S| if (a + 1) % 3 == b { x } else { -x };
    let proper = last == a;
    let leg = if proper {
        length2(r(b, a), r(c, a))
    } else {
        length2(r(b, c), r(c, c))
    };
    let singular = leg.lt(S::constant(SINGULAR_SINE));
    let (y, x) = match (which, proper) {
        (0, true) => (r(b, a), -sigma(r(c, a))),
        (0, false) => (-sigma(r(b, c)), r(c, c)),
        (1, true) => return angle(leg, r(a, a)),
        (1, false) => return angle(sigma(r(a, c)), leg),
        (_, true) => (r(a, b), sigma(r(a, c))),
        (_, false) => (-sigma(r(a, b)), r(a, a)),
    };
    let (y0, x0) = if which == 0 {
        (sigma(r(c, b)), r(b, b))
    } else {
        (S::zero(), S::one())
    };
    angle(S::select(singular, y0, y), S::select(singular, x0, x))
}

/// Returns the Euler parameters (cos ½φ, u sin ½φ), the first not negative (a simulation follows
/// their sign continuously).
///
/// Each of the four numbers 4 eₖ² is a sum of diagonal entries; the largest is well away from 0 and
/// gives its parameter by a root, the others follow from sums and differences of off-diagonal
/// entries.
fn euler_parameters<S: Scalar>(r: impl Fn(usize, usize) -> S) -> [S; 4] {
    let (one, zero) = (S::one(), S::zero());
    let d = [r(0, 0), r(1, 1), r(2, 2)];
    let squares = [
        one + d[0] + d[1] + d[2],
        one + d[0] - d[1] - d[2],
        one - d[0] + d[1] - d[2],
        one - d[0] - d[1] + d[2],
    ];
    let turn = [r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)];
    let sum = |i: usize, j: usize| r(i, j) + r(j, i);
    // row k: 4 eₖ times each parameter
    let products = [
        [squares[0], turn[0], turn[1], turn[2]],
        [turn[0], squares[1], sum(0, 1), sum(0, 2)],
        [turn[1], sum(0, 1), squares[2], sum(1, 2)],
        [turn[2], sum(0, 2), sum(1, 2), squares[3]],
    ];
    let (mut largest, mut row) = (squares[0], products[0]);
    for k in 1..4 {
        let larger = largest.lt(squares[k]);
        largest = S::select(larger, squares[k], largest);
        row = std::array::from_fn(|m| S::select(larger, products[k][m], row[m]));
    }
    let scale = S::constant(0.5) / largest.sqrt();
    let scale = S::select(row[0].lt(zero), -scale, scale);
    row.map(|x| x * scale)
}

/// Returns the rate of `p_JI` as an observer on L measures it: `v − ω_L × p`.
fn velocity<S: Scalar>(i: &MarkerState<S>, j: &MarkerState<S>, l: &MarkerState<S>) -> Vec3<S> {
    let v = i.v_GM - j.v_GM;
    if at_rest(l.w_GM) {
        v
    } else {
        v - l.w_GM.cross(i.p_GM - j.p_GM)
    }
}

/// Returns the second rate of `p_JI` as an observer on L measures it:
/// `a − α_L × p − 2 ω_L × v + ω_L × (ω_L × p)`.
fn acceleration<S: Scalar>(i: &MarkerState<S>, j: &MarkerState<S>, l: &MarkerState<S>) -> Vec3<S> {
    let a = i.a_GM - j.a_GM;
    if at_rest(l.w_GM) && at_rest(l.alpha_GM) {
        return a;
    }
    let (p, v) = (i.p_GM - j.p_GM, i.v_GM - j.v_GM);
    let coriolis = l.w_GM.cross(v).times(S::constant(2.0));
    a - l.alpha_GM.cross(p) - coriolis + l.w_GM.cross(l.w_GM.cross(p))
}

/// Returns the rate of `w_JI` as an observer on L measures it: `α − ω_L × ω`.
fn angular_acceleration<S: Scalar>(
    i: &MarkerState<S>,
    j: &MarkerState<S>,
    l: &MarkerState<S>,
) -> Vec3<S> {
    let alpha = i.alpha_GM - j.alpha_GM;
    if at_rest(l.w_GM) {
        alpha
    } else {
        alpha - l.w_GM.cross(i.w_GM - j.w_GM)
    }
}

/// Returns whether this rate is known to be zero, as that of ground is: then its products are left
/// out.
fn at_rest<S: Scalar>(rate: Vec3<S>) -> bool {
    rate.0.iter().all(Scalar::is_known_zero)
}

/// Returns the length, with derivative 0 at 0.
fn length<S: Scalar>(v: Vec3<S>) -> S {
    root(v.norm2())
}

/// Returns `√(a² + b²)`, with derivative 0 at 0.
fn length2<S: Scalar>(a: S, b: S) -> S {
    root(a * a + b * b)
}

/// Returns the square root of a sum of squares, with derivative 0 at 0.
fn root<S: Scalar>(square: S) -> S {
    let none = square.same(S::zero());
    S::select(none, S::zero(), S::select(none, S::one(), square).sqrt())
}

/// Returns the angle of the point (x, y), −π < angle ≤ π; 0 with derivative 0 at the origin.
fn angle<S: Scalar>(y: S, x: S) -> S {
    let zero = S::zero();
    let origin = y.same(zero).and(x.same(zero));
    let angle = S::select(origin, zero, y).atan2(S::select(origin, S::one(), x));
    // −0 as first argument gave −π; compared for equality, since a comparison with zero would count
    // as a change of branch
    let below = y.same(zero).and(angle.same(S::constant(-PI)));
    S::select(below, angle + S::constant(TAU), angle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::{Dual, Jet, Lanes};
    use crate::space::Mat3;
    use crate::space::rotation::{about_axis, from_313};

    /// A marker on a curved path, turning about three axes at rates that change.
    fn moving<S: Scalar>(seed: f64, t: S) -> MarkerState<S> {
        let path = |t: Jet<S>| {
            let c = |k: f64| Jet::constant((seed * k).sin() * 2.0);
            Vec3::new(
                c(1.0) + (t * c(2.0)).sin(),
                c(3.0) + t * t * c(4.0),
                c(5.0) + (t * c(6.0)).cos(),
            )
        };
        let p = path(Jet::variable(t));
        let spin = spin(seed, Jet::variable(t));
        MarkerState {
            R_GM: attitude(seed, t).0,
            p_GM: Vec3(p.0.map(|x| x.value)),
            v_GM: Vec3(p.0.map(|x| x.first)),
            a_GM: Vec3(p.0.map(|x| x.second)),
            w_GM: Vec3(spin.0.map(|x| x.value)),
            alpha_GM: Vec3(spin.0.map(|x| x.first)),
        }
    }
    fn attitude<S: Scalar>(seed: f64, t: S) -> (Mat3<S>, [S; 3]) {
        let angles = [1.0, 2.0, 3.0]
            .map(|k| S::constant(seed * k) + t * S::constant((seed + k).cos()) + t * t);
        (from_313(angles[0], angles[1], angles[2]), angles)
    }
    /// ω from the rates of the 3-1-3 angles.
    fn spin<S: Scalar>(seed: f64, t: S) -> Vec3<S> {
        let (_, angles) = attitude(seed, t);
        let (_, rates) = attitude(seed, Jet::variable(t));
        let first = about_axis(2, angles[0]);
        let second = first * about_axis(0, angles[1]);
        Vec3::axis(2).times(rates_of(rates[0]))
            + first.apply(Vec3::axis(0)).times(rates_of(rates[1]))
            + second.apply(Vec3::axis(2)).times(rates_of(rates[2]))
    }
    fn rates_of<S: Scalar>(x: Jet<S>) -> S {
        x.first
    }

    /// Measure of (1, 2, `third`, `fourth`), 0 for ground, with its rate.
    fn value_and_rate(m: Measure, third: u32, fourth: u32, t: f64) -> (f64, f64) {
        let t = Dual::<1>::variable(t, 0);
        let state = |id: u32| {
            if id == 0 {
                MarkerState::ground()
            } else {
                moving(0.3 + 0.7 * f64::from(id), t)
            }
        };
        let x = kinematic(m, &state(1), &state(2), &state(third), &state(fourth)).unwrap();
        (x.re, x.eps[0])
    }

    fn assert_close(got: f64, expected: f64) {
        assert!(
            (got - expected).abs() <= 1e-12 * expected.abs().max(1.0),
            "{got} is not {expected}"
        );
    }

    #[test]
    fn rate_of_a_displacement_is_the_velocity_seen_from_its_axes() {
        for t in [0.0, 0.4, 1.7] {
            for (d, v) in [
                (Measure::Dx, Measure::Vx),
                (Measure::Dy, Measure::Vy),
                (Measure::Dz, Measure::Vz),
            ] {
                for k in 0..4 {
                    assert_close(value_and_rate(d, k, 0, t).1, value_and_rate(v, k, k, t).0);
                }
            }
            assert_close(
                value_and_rate(Measure::Dm, 0, 0, t).1,
                value_and_rate(Measure::Vr, 0, 0, t).0,
            );
        }
    }

    #[test]
    fn rate_of_a_velocity_is_the_acceleration_seen_from_its_axes() {
        use Measure::*;
        for t in [0.0, 0.4, 1.7] {
            for (v, a) in [(Vx, Accx), (Vy, Accy), (Vz, Accz)] {
                for k in 0..4 {
                    assert_close(value_and_rate(v, k, k, t).1, value_and_rate(a, k, k, t).0);
                }
            }
            for (w, a) in [(Wx, Wdtx), (Wy, Wdty), (Wz, Wdtz)] {
                for k in 0..4 {
                    assert_close(value_and_rate(w, k, 0, t).1, value_and_rate(a, k, k, t).0);
                }
            }
        }
    }

    #[test]
    fn magnitudes_are_lengths_of_their_components() {
        use Measure::*;
        for (m, parts) in [
            (Vm, [Vx, Vy, Vz]),
            (Accm, [Accx, Accy, Accz]),
            (Wdtm, [Wdtx, Wdty, Wdtz]),
        ] {
            for l in 0..4 {
                let sum: f64 = parts
                    .map(|p| value_and_rate(p, 3, l, 0.6).0.powi(2))
                    .iter()
                    .sum();
                assert_close(value_and_rate(m, l, 0, 0.6).0, sum.sqrt());
            }
        }
    }

    fn turned(r: Mat3<f64>) -> MarkerState<f64> {
        MarkerState {
            R_GM: r,
            ..MarkerState::ground()
        }
    }
    fn of(m: Measure, i: &MarkerState<f64>) -> f64 {
        let g = MarkerState::ground();
        kinematic(m, i, &g, &g, &g).unwrap()
    }

    #[test]
    fn angles_are_those_the_attitude_was_built_from() {
        for t in [-2.9, -1.0, 0.3, 2.2] {
            for (k, m) in [Measure::Ax, Measure::Ay, Measure::Az]
                .into_iter()
                .enumerate()
            {
                assert_close(of(m, &turned(about_axis(k, t))), t);
            }
            let i = turned(from_313(t, 0.7, 0.4 - t / 2.0));
            assert_close(of(Measure::Psi, &i), t);
            assert_close(of(Measure::Theta, &i), 0.7);
            assert_close(of(Measure::Phi, &i), 0.4 - t / 2.0);
            let i = turned(about_axis(2, t) * about_axis(1, -0.3) * about_axis(0, 0.2 + t / 3.0));
            assert_close(of(Measure::Yaw, &i), t);
            assert_close(of(Measure::Pitch, &i), 0.3);
            assert_close(of(Measure::Roll, &i), 0.2 + t / 3.0);
        }
    }

    #[test]
    fn orientation_gives_back_what_the_attitude_was_built_from() {
        let angles = [0.7, 0.4, -1.9];
        for (k, sequence) in SEQUENCES.into_iter().enumerate() {
            let rotations = [0, 1, 2].map(|n| about_axis(sequence[n], angles[n]));
            let i = turned(rotations[0] * rotations[1] * rotations[2]);
            for (n, angle) in (1..).zip(angles) {
                assert_close(
                    orientation(k as u32 + 1, n, &i, &MarkerState::ground()).unwrap(),
                    angle,
                );
            }
        }
        for q in [
            [0.8, 0.1, -0.5, 0.3],
            [0.0, 1.0, 0.0, 0.0],
            [0.1, 0.2, 0.9, -0.4],
            [0.05, 0.1, 0.3, 0.9],
        ] {
            let n = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            let i = turned(crate::space::rotation::from_quaternion(q));
            for (k, x) in (1..).zip(q) {
                assert_close(
                    orientation(27, k, &i, &MarkerState::ground()).unwrap(),
                    x / n,
                );
            }
        }
    }

    #[test]
    fn half_turns_are_positive_and_singular_attitudes_have_one_angle() {
        use std::f64::consts::{FRAC_PI_2, PI};
        let flip = |x: f64, y: f64, z: f64| turned(Mat3::diagonal(x, y, z));
        // −0.0 off the diagonal must not turn +π into −π
        let mut about_z = flip(-1.0, -1.0, 1.0);
        about_z.R_GM.0[1][0] = -0.0;
        assert_eq!(of(Measure::Az, &about_z), PI);
        assert_eq!(of(Measure::Ax, &flip(1.0, -1.0, -1.0)), PI);
        let i = turned(about_axis(2, 1.2));
        assert_close(of(Measure::Psi, &i), 1.2);
        assert_eq!((of(Measure::Theta, &i), of(Measure::Phi, &i)), (0.0, 0.0));
        let i = turned(about_axis(2, 0.4) * about_axis(1, FRAC_PI_2));
        assert_close(of(Measure::Pitch, &i), -FRAC_PI_2);
        assert_close(of(Measure::Yaw, &i), 0.4);
        assert_eq!(of(Measure::Roll, &i), 0.0);
    }

    #[test]
    fn singular_points_have_finite_values_and_derivatives() {
        // all markers in one place, all moving along the same direction of differentiation
        type D = Dual<2>;
        let mut here = MarkerState::<D>::ground();
        here.p_GM = Vec3::new(D::variable(0.0, 0), D::variable(0.0, 1), D::zero());
        let g = MarkerState::ground();
        for &m in Measure::ALL {
            if let Some(x) = kinematic(m, &here, &g, &g, &g) {
                assert!(
                    x.re.is_finite() && x.eps.iter().all(|e| e.is_finite()),
                    "{m:?}: {x:?}"
                );
            }
        }
    }

    #[test]
    fn lanes_compute_what_single_numbers_compute() {
        let times = [0.0, 0.5, 1.0, 2.5];
        let wide = |id: u32| moving(f64::from(id), Lanes(times));
        for &m in Measure::ALL {
            let Some(x) = kinematic(m, &wide(1), &wide(2), &wide(3), &wide(4)) else {
                continue;
            };
            for (lane, &t) in times.iter().enumerate() {
                let one = |id: u32| moving(f64::from(id), t);
                assert_eq!(
                    x.0[lane].to_bits(),
                    kinematic(m, &one(1), &one(2), &one(3), &one(4))
                        .unwrap()
                        .to_bits()
                );
            }
        }
    }
}
