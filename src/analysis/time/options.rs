//! Options of an integration, and the choice of its method.

use crate::analysis::system::System;
use crate::numeric::{self, Method, Ode};
use crate::scene::layout::Layout;

/// Shortest step, as a part of the duration of the run: what needs a shorter one comes no further.
/// A transient of 1 ns at the beginning of 30 years, followed to 1e-9, begins with one of 1e-27.
const SHORTEST_STEP: f64 = 1e-30;

/// Options of an integration.
#[derive(Clone, Debug)]
pub struct Options {
    /// E, permitted local error
    pub error: f64,
    /// name of a method of [`numeric::METHODS`], or "AUTO"
    pub method: String,
    /// the method that AUTO begins with: see [`first_method`]
    pub first: String,
    /// whether it begins with an implicit one because the simulation before was stiff at its end:
    /// then the explicit one tries again when branches change
    pub goes_on_stiff: bool,
    /// first step
    pub h_initial: Option<f64>,
    /// longest step
    pub h_max: f64,
    /// shortest step
    pub h_min: f64,
    /// highest order
    pub max_order: Option<usize>,
    /// Newton iterations
    pub max_newton: Option<usize>,
    /// attempted steps, by all methods together
    pub max_steps: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            error: 1e-6,
            method: "AUTO".into(),
            first: "DOP853".into(),
            goes_on_stiff: false,
            h_initial: None,
            h_max: f64::INFINITY,
            h_min: 0.0,
            max_order: None,
            max_newton: None,
            max_steps: usize::MAX,
        }
    }
}

impl Options {
    /// Returns whether the program may choose the method.
    pub(in crate::analysis) fn is_auto(&self) -> bool {
        self.method.eq_ignore_ascii_case("AUTO")
    }

    /// Returns the name of the method to begin with.
    pub(super) fn first_name(&self) -> String {
        if self.is_auto() {
            self.first.clone()
        } else {
            self.method.to_ascii_uppercase()
        }
    }

    /// Returns what a method is asked for in a run of some duration, which may attempt `max_steps`
    /// steps.
    pub(super) fn settings(&self, duration: f64, max_steps: usize) -> numeric::Options {
        numeric::Options {
            tolerance: self.error,
            h_initial: self.h_initial,
            h_max: self.h_max,
            h_min: self.h_min.max(SHORTEST_STEP * duration),
            max_order: self.max_order.unwrap_or(5),
            max_newton: self.max_newton.unwrap_or(10),
            max_steps,
            ..numeric::Options::default()
        }
    }

    /// Returns the method of that name for a run of a system of some duration, which may attempt
    /// `max_steps` steps, or `None` if there is none.
    pub(super) fn new_method(
        &self,
        name: &str,
        system: &System,
        (duration, max_steps): (f64, usize),
    ) -> Option<Box<dyn Method<System>>> {
        let settings = self.settings(duration, max_steps);
        numeric::ode_method::<System>(name, Ode::size(system), &settings)
            .or_else(|| numeric::dae_method::<System>(name, system.implicit_size(), &settings))
    }
}

/// Returns the name of the method that does what an INTEGRATOR name of Adams asks for; names of
/// our own stay as they are.
///
/// GSTIFF, WSTIFF and their kin are backward differentiation of low order. They are taken for
/// stiff systems with modest requests, which RADAU5 solves with fewer steps and without their
/// damping (BDF is there by its own name). ABAM and RKF45 are explicit.
pub fn method_named(name: &str) -> String {
    match name.to_ascii_uppercase().as_str() {
        "GSTIFF" | "WSTIFF" | "HASTIFF" | "CONSTANT_BDF" => "RADAU5".into(),
        "ABAM" | "RKF45" => "DOP853".into(),
        other => other.to_string(),
    }
}

/// Steps of an explicit method that stability may force before an implicit one is taken at once.
const MAX_STABILITY_STEPS: f64 = 2000.0;
/// Size of the largest system whose eigenvalues are computed for the choice of a method.
pub(super) const MAX_EIGENVALUES: usize = 120;
/// Smallest damping ratio of a mode that counts as damped.
const LEAST_DAMPING_RATIO: f64 = 0.03;

/// Returns the method to begin with when the choice is ours: an implicit one where damped modes at
/// the start are so fast that stability, not accuracy, would set the steps of an explicit one.
///
/// Only modes that decay count: an undamped oscillation has to be followed anyway.
pub fn first_method(system: &mut System, duration: f64) -> &'static str {
    let n = Ode::size(system);
    if n == 0 || n > MAX_EIGENVALUES {
        return "DOP853";
    }
    let t = system.numbers[Layout::TIME];
    let y = system.numbers[system.scene.layout.y()].to_vec();
    let (mut jacobian, mut dfdt) = (vec![0.0; n * n], vec![0.0; n]);
    system.set(t, &y);
    if (system.jacobian_once(&mut jacobian, &mut dfdt)).is_err() {
        return "DOP853";
    }
    match is_stiff(n, jacobian, duration) {
        true => "RADAU5",
        false => "DOP853",
    }
}

/// Returns whether damped modes of a Jacobian (n × n, by columns) are so fast that stability would
/// set the steps of an explicit method.
pub(super) fn is_stiff(n: usize, jacobian: Vec<f64>, duration: f64) -> bool {
    let matrix = nalgebra::DMatrix::from_vec(n, n, jacobian);
    let Some(schur) = nalgebra::linalg::Schur::try_new(matrix, f64::EPSILON, 1000) else {
        return false;
    };
    let fastest = schur
        .complex_eigenvalues()
        .iter()
        .filter(|l| -l.re > LEAST_DAMPING_RATIO * l.norm())
        .fold(0.0, |m: f64, l| m.max(l.norm()));
    fastest * duration > 5.0 * MAX_STABILITY_STEPS
}
