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
