//! Options of an integration, and the choice of its method.

use crate::analysis::system::System;
use crate::analysis::trajectory::Left;
use crate::numeric::connected::strong;
use crate::numeric::eigenvalues::eigenvalues;
use crate::numeric::pattern::Pattern;
use crate::numeric::{self, Method, Ode};
use crate::scalar::hypot;
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
    /// what the method of the simulation before has left, if this one goes on with its system: its
    /// step counts before `h_initial` where this one begins with the same method
    pub left: Option<Left>,
    /// longest step
    pub h_max: f64,
    /// shortest step
    pub h_min: f64,
    /// Newton iterations
    pub max_newton: Option<usize>,
    /// attempted steps, by all methods together
    pub max_steps: usize,
    /// whether mechanisms that nothing couples may be taken apart on the way: see
    /// `Trajectory::parted`
    pub may_part: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            error: 1e-6,
            method: "AUTO".into(),
            first: "DOP853".into(),
            goes_on_stiff: false,
            h_initial: None,
            left: None,
            h_max: f64::INFINITY,
            h_min: 0.0,
            max_newton: None,
            max_steps: usize::MAX,
            may_part: false,
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
            max_newton: self.max_newton.unwrap_or(10),
            max_steps,
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
    }
}

/// Returns the name of the method that does what an INTEGRATOR name of Adams asks for; names of
/// our own stay as they are.
///
/// GSTIFF, WSTIFF and their kin are backward differentiation of low order, HHT and NEWMARK of order
/// two. They are taken for stiff systems with modest requests, which RADAU5 solves with fewer
/// steps, and without taking energy from what moves slowly. ABAM and RKF45 are explicit.
pub fn method_named(name: &str) -> String {
    let name = name.to_ascii_uppercase();
    let ours = METHODS_OF_ADAMS
        .iter()
        .find(|(_, names)| names.contains(&name.as_str()));
    ours.map_or(name, |(ours, _)| (*ours).to_owned())
}

/// Methods of ours, and the names of Adams that they do the work of.
pub const METHODS_OF_ADAMS: [(&str, &[&str]); 2] = [
    (
        "RADAU5",
        &[
            "GSTIFF",
            "WSTIFF",
            "HASTIFF",
            "CONSTANT_BDF",
            "HHT",
            "NEWMARK",
            "BDF",
        ],
    ),
    ("DOP853", &["ABAM", "RKF45"]),
];

/// Steps of an explicit method that stability may force before an implicit one is taken at once.
const MAX_STABILITY_STEPS: f64 = 2000.0;
/// Size of the largest system whose eigenvalues are computed for the choice of a method.
const MAX_EIGENVALUES: usize = 120;
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
fn is_stiff(n: usize, jacobian: Vec<f64>, duration: f64) -> bool {
    fastest_damped(n, jacobian) * duration > 5.0 * MAX_STABILITY_STEPS
}

/// Returns the same of a Jacobian with a pattern, whose strong parts have its eigenvalues: those of
/// parts that are too large count as slow.
pub(super) fn is_stiff_in_parts(pattern: &Pattern, entries: &[f64], duration: f64) -> bool {
    let parts = strong(pattern).into_iter();
    let fastest = parts
        .filter(|part| part.len() <= MAX_EIGENVALUES)
        .map(|part| {
            let n = part.len();
            let mut jacobian = vec![0.0; n * n];
            for (b, &j) in part.iter().enumerate() {
                for (e, i) in pattern.column(j) {
                    if let Ok(a) = part.binary_search(&i) {
                        jacobian[a + n * b] = entries[e];
                    }
                }
            }
            fastest_damped(n, jacobian)
        });
    fastest.fold(0.0, f64::max) * duration > 5.0 * MAX_STABILITY_STEPS
}

/// Returns the size of the largest eigenvalue of a damped mode; 0 where there is none, or none was
/// found.
fn fastest_damped(n: usize, mut jacobian: Vec<f64>) -> f64 {
    if let [alone] = jacobian[..] {
        return (-alone).max(0.0);
    }
    let all = eigenvalues(&mut jacobian, n).unwrap_or_default();
    let sizes = all.iter().map(|&(re, im)| (re, hypot(re, im)));
    let damped = sizes.filter(|(re, size)| -re > LEAST_DAMPING_RATIO * size);
    damped.fold(0.0, |m: f64, (_, size)| m.max(size))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Pairs that decay by `a` and turn by `b`, each driven by the pairs before it, in any
        /// order of the unknowns: the fastest one decides, however many there are.
        #[test]
        fn the_fastest_strong_part_decides(
            pairs in proptest::collection::vec((1.0f64..1e6, 0.0f64..1.0, -1e3..1e3), 1..90),
            turn in 0usize..180,
            longer: bool,
        ) {
            let n = 2 * pairs.len();
            let place = |k: usize| (k + turn) % n;
            let mut columns = vec![Vec::new(); n];
            for (k, &(a, share, driven)) in pairs.iter().enumerate() {
                let (p, q, b) = (2 * k, 2 * k + 1, share * a);
                columns[place(p)].extend([(place(p), -a), (place(q), b)]);
                columns[place(q)].extend([(place(p), -b), (place(q), -a)]);
                if q + 1 < n {
                    columns[place(p)].push((place(q + 1), driven));
                }
            }
            columns.iter_mut().for_each(|c| c.sort_by_key(|e| e.0));
            let places = columns.iter().map(|c| c.iter().map(|e| e.0).collect());
            let pattern = Pattern::of_columns(n, places.collect());
            let entries: Vec<f64> = columns.iter().flatten().map(|e| e.1).collect();
            let fastest = pairs.iter().fold(0.0, |m: f64, &(a, share, _)| m.max(a.hypot(share * a)));
            let at_limit = 5.0 * MAX_STABILITY_STEPS / fastest;
            let duration = at_limit * if longer { 1.0 + 1e-9 } else { 1.0 - 1e-9 };
            prop_assert_eq!(is_stiff_in_parts(&pattern, &entries, duration), longer);
        }
    }
}
