//! Problems with known solutions, on which the integrators are tried.
//!
//! A problem is one formula over [`Scalar`]; its Jacobian is the same formula over dual numbers.
#![allow(dead_code)] // each test binary uses its own part

use cognate::numeric::{Failure, Method, Ode, Stop};
use cognate::scalar::{Dual, Scalar};

/// `ẏ = f(t, y)`, once for every kind of number.
pub trait Field {
    /// Number of unknowns.
    fn size(&self) -> usize;
    /// `ydot = f(t, y)`
    fn rate<S: Scalar>(&self, t: S, y: &[S], ydot: &mut [S]);
    /// Typical magnitudes; ones unless the problem says otherwise.
    fn typical(&self, typical: &mut [f64]) {
        typical.fill(1.0);
    }
    /// Back onto the invariants.
    fn project(&self, _t: f64, _y: &mut [f64]) -> bool {
        false
    }
}

/// A [`Field`] as the methods want it.
pub struct System<F> {
    pub field: F,
    y: Vec<Dual<1>>,
    ydot: Vec<Dual<1>>,
}

impl<F: Field> System<F> {
    pub fn new(field: F) -> Self {
        let zeros = vec![Dual::constant(0.0); field.size()];
        System {
            y: zeros.clone(),
            ydot: zeros,
            field,
        }
    }
}

impl<F: Field> Ode for System<F> {
    fn size(&self) -> usize {
        self.field.size()
    }
    fn rate(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.field.rate(t, y, ydot);
        Ok(())
    }
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<bool, Failure> {
        Ok(self.field.project(t, y))
    }
    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        jacobian: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<(), Failure> {
        let n = y.len();
        for j in 0..=n {
            for (i, y) in y.iter().enumerate() {
                self.y[i] = if i == j {
                    Dual::variable(*y, 0)
                } else {
                    Dual::constant(*y)
                };
            }
            let t = if j == n {
                Dual::variable(t, 0)
            } else {
                Dual::constant(t)
            };
            self.field.rate(t, &self.y, &mut self.ydot);
            let column = if j == n {
                &mut *dfdt
            } else {
                &mut jacobian[j * n..(j + 1) * n]
            };
            for (entry, d) in column.iter_mut().zip(&self.ydot) {
                *entry = d.eps[0];
            }
        }
        Ok(())
    }
    fn typical(&self, typical: &mut [f64]) {
        self.field.typical(typical);
    }
}

/// Runs from `t` to `end` and calls `see(t, y)` at `samples` equal intervals, by interpolation.
pub fn run<P: ?Sized>(
    method: &mut dyn Method<P>,
    problem: &mut P,
    (t, end): (f64, f64),
    y: &[f64],
    samples: usize,
    mut see: impl FnMut(f64, &[f64]),
) -> Result<(), Stop> {
    method.start(problem, t, y)?;
    let mut out = y.to_vec();
    let mut next = 1;
    while method.t() < end {
        let step = method.step(problem, end)?;
        while next <= samples {
            let at = if next == samples {
                end
            } else {
                t + (end - t) * next as f64 / samples as f64
            };
            if at > step.t1 {
                break;
            }
            method
                .interpolate(problem, at, &mut out)
                .expect("the problem has a value everywhere in the step");
            see(at, &out);
            next += 1;
        }
    }
    assert_eq!(next, samples + 1);
    Ok(())
}

/// Largest error over samples and columns, each column relative to its largest magnitude.
pub struct Judge {
    worst: Vec<f64>,
    scale: Vec<f64>,
}

impl Judge {
    pub fn new(n: usize) -> Self {
        Judge {
            worst: vec![0.0; n],
            scale: vec![0.0; n],
        }
    }
    pub fn see(&mut self, y: &[f64], exact: &[f64]) {
        for i in 0..exact.len() {
            self.worst[i] = self.worst[i].max((y[i] - exact[i]).abs());
            self.scale[i] = self.scale[i].max(exact[i].abs());
        }
    }
    pub fn verdict(&self) -> f64 {
        self.worst
            .iter()
            .zip(&self.scale)
            .map(|(w, s)| w / s)
            .fold(0.0, f64::max)
    }
}

/// `ẏ = λ (y − sin t) + cos t`: the sine, approached at the rate λ.
pub struct Prothero(pub f64);

impl Field for Prothero {
    fn size(&self) -> usize {
        1
    }
    fn rate<S: Scalar>(&self, t: S, y: &[S], ydot: &mut [S]) {
        let (sin, cos) = t.sin_cos();
        ydot[0] = (y[0] - sin).scale(self.0) + cos;
    }
}

/// Harmonic oscillator of frequency one: (sin t, cos t) from (0, 1).
pub struct Oscillator;

impl Field for Oscillator {
    fn size(&self) -> usize {
        2
    }
    fn rate<S: Scalar>(&self, _t: S, y: &[S], ydot: &mut [S]) {
        ydot[0] = y[1];
        ydot[1] = -y[0];
    }
}

/// Plane pendulum of length 1 m; angle from the downward vertical, and its rate.
pub struct Pendulum;

impl Field for Pendulum {
    fn size(&self) -> usize {
        2
    }
    fn rate<S: Scalar>(&self, _t: S, y: &[S], ydot: &mut [S]) {
        ydot[0] = y[1];
        ydot[1] = y[0].sin().scale(-9.81);
    }
}

impl Pendulum {
    /// Horizontal and at rest.
    pub const START: [f64; 2] = [-std::f64::consts::FRAC_PI_2, 0.0];

    /// Position of the mass (x to the right, y upward) and its velocity from `START` after 10 s: elliptic functions in 30 digits.
    pub const AFTER_10: [f64; 4] = [
        -0.2750874625761169,
        -0.9614192050991252,
        4.175598100951729,
        -1.1947490545604753,
    ];

    /// Position and velocity of the mass.
    pub fn point(y: &[f64]) -> [f64; 4] {
        let (s, c) = y[0].sin_cos();
        [s, -c, c * y[1], s * y[1]]
    }
}

/// The same pendulum in Cartesian coordinates (x, y, ẋ, ẏ): accelerations from the differentiated constraint, two invariants.
pub struct CartesianPendulum;

impl Field for CartesianPendulum {
    fn size(&self) -> usize {
        4
    }
    fn rate<S: Scalar>(&self, _t: S, u: &[S], udot: &mut [S]) {
        let [x, y, vx, vy] = [u[0], u[1], u[2], u[3]];
        let lambda = (vx.square() + vy.square() - y.scale(9.81)) / (x.square() + y.square());
        udot[0] = vx;
        udot[1] = vy;
        udot[2] = -(lambda * x);
        udot[3] = -(lambda * y) - S::constant(9.81);
    }
    fn project(&self, _t: f64, u: &mut [f64]) -> bool {
        let r = u[0].hypot(u[1]);
        (u[0], u[1]) = (u[0] / r, u[1] / r);
        let along = u[0] * u[2] + u[1] * u[3];
        u[2] -= along * u[0];
        u[3] -= along * u[1];
        true
    }
}

/// Two uniform rods of 1 kg and 1 m in a row under gravity; angles from the x axis and their rates.
pub struct DoublePendulum;

impl DoublePendulum {
    /// Both along x, at rest.
    pub const START: [f64; 4] = [0.0; 4];
    /// Joint point, tip, rates after 5 s: two formulations in extended precision agree to 5e-16.
    pub const AFTER_5: [f64; 6] = [
        0.9080244304330555,
        -0.41891721585144376,
        1.8552219377580892,
        -0.7395679325467959,
        4.910950024004455,
        -5.424710593158876,
    ];

    /// Joint point, tip, rates.
    pub fn points(y: &[f64]) -> [f64; 6] {
        let ((s1, c1), (s2, c2)) = (y[0].sin_cos(), y[1].sin_cos());
        [c1, s1, c1 + c2, s1 + s2, y[2], y[3]]
    }
}

impl Field for DoublePendulum {
    fn size(&self) -> usize {
        4
    }
    fn rate<S: Scalar>(&self, _t: S, y: &[S], ydot: &mut [S]) {
        let (s, c) = (y[0] - y[1]).sin_cos();
        let g = 9.81;
        // M (α₁, α₂) = f, moments about the pivot and about the joint
        let (m11, m22, m12) = (4.0 / 3.0, 1.0 / 3.0, c.scale(0.5));
        let f1 = -(s * y[3].square()).scale(0.5) - y[0].cos().scale(1.5 * g);
        let f2 = (s * y[2].square()).scale(0.5) - y[1].cos().scale(0.5 * g);
        let det = S::constant(m11 * m22) - m12.square();
        ydot[0] = y[2];
        ydot[1] = y[3];
        ydot[2] = (f1.scale(m22) - m12 * f2) / det;
        ydot[3] = (f2.scale(m11) - m12 * f1) / det;
    }
}

/// Kepler's problem: an orbit of eccentricity 0.6 and period 2π, from its pericentre.
pub struct Kepler;

impl Kepler {
    const E: f64 = 0.6;
    /// Position and velocity at the pericentre.
    pub fn start() -> [f64; 4] {
        Self::exact(0.0)
    }
    /// Position and velocity at `t`, by Kepler's equation.
    pub fn exact(t: f64) -> [f64; 4] {
        let e = Self::E;
        let mut a = t;
        for _ in 0..60 {
            a -= (a - e * a.sin() - t) / (1.0 - e * a.cos());
        }
        let ((s, c), b) = (a.sin_cos(), (1.0 - e * e).sqrt());
        let rate = 1.0 / (1.0 - e * c);
        [c - e, b * s, -s * rate, b * c * rate]
    }
}

impl Field for Kepler {
    fn size(&self) -> usize {
        4
    }
    fn rate<S: Scalar>(&self, _t: S, y: &[S], ydot: &mut [S]) {
        let r2 = y[0].square() + y[1].square();
        let f = -(r2 * r2.sqrt()).recip();
        ydot[0] = y[2];
        ydot[1] = y[3];
        ydot[2] = y[0] * f;
        ydot[3] = y[1] * f;
    }
}

/// Euler's free top with principal inertias 1, 2, 3, turning about the middle axis; it flips over and over.
pub struct EulerTop;

impl EulerTop {
    pub const START: [f64; 3] = [0.01, 5.0, 0.01];
    /// Body rates after 10 s, extended precision.
    pub const AFTER_10: [f64; 3] = [
        0.012714870629462085,
        4.999993833202685,
        0.010979798649094277,
    ];
}

impl Field for EulerTop {
    fn size(&self) -> usize {
        3
    }
    fn rate<S: Scalar>(&self, _t: S, w: &[S], wdot: &mut [S]) {
        wdot[0] = -(w[1] * w[2]);
        wdot[1] = w[2] * w[0];
        wdot[2] = (w[0] * w[1]).scale(-1.0 / 3.0);
    }
}

/// Van der Pol's oscillator with ε = 1e-6: slow branches, sudden jumps.
pub struct VanDerPol;

impl VanDerPol {
    pub const START: [f64; 2] = [2.0, 0.0];
    /// After 2 s; test set for IVP solvers (Mazzia & Magherini 2008).
    pub const AFTER_2: [f64; 2] = [1.706167732170483, -0.8928097010247975];
}

impl Field for VanDerPol {
    fn size(&self) -> usize {
        2
    }
    fn rate<S: Scalar>(&self, _t: S, y: &[S], ydot: &mut [S]) {
        ydot[0] = y[1];
        ydot[1] = ((S::one() - y[0].square()) * y[1] - y[0]).scale(1e6);
    }
}

/// Robertson's reaction: rates from 0.04 to 3e7.
pub struct Robertson;

impl Robertson {
    pub const START: [f64; 3] = [1.0, 0.0, 0.0];
    /// After 40 s (Hairer & Wanner, Solving ODEs II, IV.10, to more digits by this crate's own methods, which agree).
    pub const AFTER_40: [f64; 3] = [
        0.715_827_068_719_394,
        0.9185534764557338e-5,
        0.2841637457458413,
    ];
}

impl Field for Robertson {
    fn size(&self) -> usize {
        3
    }
    fn rate<S: Scalar>(&self, _t: S, y: &[S], ydot: &mut [S]) {
        let (slow, fast, pair) = (
            y[0].scale(0.04),
            (y[1] * y[2]).scale(1e4),
            y[1].square().scale(3e7),
        );
        ydot[0] = fast - slow;
        ydot[1] = slow - fast - pair;
        ydot[2] = pair;
    }
    fn typical(&self, typical: &mut [f64]) {
        typical.copy_from_slice(&[1.0, 1e-4, 1.0]);
    }
}

/// HIRES: eight reactants of a plant under red light.
pub struct Hires;

impl Hires {
    pub const START: [f64; 8] = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0057];
    pub const END: f64 = 321.8122;
    /// At the end; test set for IVP solvers (Mazzia & Magherini 2008).
    pub const AT_END: [f64; 8] = [
        0.7371312573325668e-3,
        0.1442485726316185e-3,
        0.5888729740967575e-4,
        0.1175651343283149e-2,
        0.2386356198831331e-2,
        0.6238968252742796e-2,
        0.2849998395185769e-2,
        0.2850001604814231e-2,
    ];
}

impl Field for Hires {
    fn size(&self) -> usize {
        8
    }
    fn rate<S: Scalar>(&self, _t: S, y: &[S], ydot: &mut [S]) {
        let bound = (y[5] * y[7]).scale(280.0);
        ydot[0] = y[0].scale(-1.71) + y[1].scale(0.43) + y[2].scale(8.32) + S::constant(0.0007);
        ydot[1] = y[0].scale(1.71) - y[1].scale(8.75);
        ydot[2] = y[2].scale(-10.03) + y[3].scale(0.43) + y[4].scale(0.035);
        ydot[3] = y[1].scale(8.32) + y[2].scale(1.71) - y[3].scale(1.12);
        ydot[4] = y[4].scale(-1.745) + y[5].scale(0.43) + y[6].scale(0.43);
        ydot[5] =
            -bound + y[3].scale(0.69) + y[4].scale(1.71) - y[5].scale(0.43) + y[6].scale(0.69);
        ydot[6] = bound - y[6].scale(1.81);
        ydot[7] = y[6].scale(1.81) - bound;
    }
    fn typical(&self, typical: &mut [f64]) {
        typical.fill(1e-2);
    }
}

/// A plane body of 1 kg and 0.04 kg m² on a bushing of 1 Hz along x and 10 kHz along y, off its centre; x, y, θ and rates.
pub struct StiffBushing;

impl StiffBushing {
    pub const START: [f64; 6] = [0.1, 1e-4, 0.05, 0.0, 0.0, 0.0];
    /// x, y, θ, θ̇ after 0.02 s, when the fast mode has died out.
    pub const AFTER_20_MS: [f64; 4] = [
        0.09922538086212267,
        -0.0029974755259330714,
        0.06110741578263483,
        0.5433511962846356,
    ];
    /// x, y, θ, θ̇ after 2 s; two formulations in extended precision.
    pub const AFTER_2: [f64; 4] = [
        0.08843145747066948,
        0.0006124080759720904,
        -0.012203783773218954,
        0.8919704835419481,
    ];
}

impl Field for StiffBushing {
    fn size(&self) -> usize {
        6
    }
    fn rate<S: Scalar>(&self, _t: S, y: &[S], ydot: &mut [S]) {
        let (sin, cos) = y[2].sin_cos();
        let (px, py) = (
            cos.scale(0.05) - sin.scale(0.03),
            sin.scale(0.05) + cos.scale(0.03),
        );
        let tau = 2.0 * std::f64::consts::PI;
        let law = |k: f64, c: f64, d: S, v: S| -(d.scale(k) + v.scale(c));
        let fx = law(
            tau.powi(2),
            0.02 * tau,
            y[0] + px - S::constant(0.05),
            y[3] - py * y[5],
        );
        let fy = law(
            (1e4 * tau).powi(2),
            2000.0 * tau,
            y[1] + py - S::constant(0.03),
            y[4] + px * y[5],
        );
        let torque = law(0.36 * tau.powi(2), 0.005, y[2], y[5]);
        (ydot[0], ydot[1], ydot[2]) = (y[3], y[4], y[5]);
        (ydot[3], ydot[4]) = (fx, fy);
        ydot[5] = (torque + px * fy - py * fx).scale(1.0 / 0.04);
    }
}
