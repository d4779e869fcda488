//! Methods for differential equations, and the linear algebra they need.
//!
//! This floor knows numbers, residuals and rates, and nothing of bodies. A method offers steps and
//! an interpolant; output times, events and files belong to the analysis that drives it.
//!
//! ```text
//! method = ode_method("DOP853", n, &options)          one row of the table of methods
//! method.start(problem, t, y)
//! while method.t() < end:
//!     step = method.step(problem, end)                an accepted step, or the reason for none
//!     method.interpolate(problem, t, out)             any time inside it
//!     method.undo()  or  method.reinitialize(…)       when an event lies inside it
//! ```
//!
//! The requested tolerance is the permitted local error of each unknown relative to the largest
//! magnitude it has had so far (see `numeric/control.rs`).

pub(crate) mod bernstein;
pub(crate) mod connected;
pub(crate) mod control;
pub(crate) mod dense;
pub(crate) mod eigenvalues;
pub(crate) mod envelope;
pub(crate) mod event;
pub(crate) mod noise;
pub(crate) mod pattern;
pub(crate) mod quadrature;
pub(crate) mod radau;
pub(crate) mod rank;
pub(crate) mod runge_kutta;
pub(crate) mod sparse;
pub(crate) mod subdivision;

pub use control::Weights;
pub use noise::Noise;
pub use radau::Radau;
pub use runge_kutta::Dop853;

use quadrature::Node;

/// The failure of an evaluation: a small code that the problem chooses and the analysis translates
/// into words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Failure {
    /// meaning chosen by the problem: usually the index of a row, or of an output that is not
    /// finite
    pub what: usize,
    /// whether a smaller step may help (a stage left the domain) or not (a mistake of the user's)
    pub recoverable: bool,
}

/// Most changes of the length of one step that [`Ode::place_step`] asks for.
const MOST_PLACINGS: usize = 4;

/// An explicit system `ẏ = f(t, y)`, possibly with invariants `g(t, y) = 0` that exact solutions
/// keep.
pub trait Ode {
    /// Returns the number of unknowns.
    fn size(&self) -> usize;
    /// Evaluates `ydot = f(t, y)`.
    ///
    /// # Errors
    /// When `f` has no finite value there.
    fn rate(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure>;
    /// Moves `y` back onto the invariants; returns whether it changed.
    ///
    /// # Errors
    /// When they cannot be reached from here.
    fn project(&mut self, _t: f64, _y: &mut [f64]) -> Result<bool, Failure> {
        Ok(false)
    }
    /// Removes from error estimates of a step that ends at `(t, y)` the parts that projection will
    /// remove; returns false if there is nothing to remove. Called only before a step is rejected.
    ///
    /// Where invariants become dependent, rates normal to them are full of magnified rounding that
    /// never reaches the solution.
    fn filter_errors(&mut self, _t: f64, _y: &[f64], _errors: [&mut [f64]; 2]) -> bool {
        false
    }
    /// Returns a better length, in s, for a step that was attempted from `t` with length `h`, or
    /// `None`. `gap`: the part of a step within which the method does not evaluate; `failed`: an
    /// iteration for the step did not converge.
    ///
    /// Where `f` is a quotient of numbers that vanish together at an instant, evaluations should
    /// keep away from that instant.
    fn place_step(&mut self, _t: f64, _h: f64, _gap: [f64; 2], _failed: bool) -> Option<f64> {
        None
    }
    /// Returns whether rates evaluated in the present step are noisy because invariants are nearly
    /// dependent: an iteration cannot converge further than they permit.
    fn is_noisy(&self) -> bool {
        false
    }
    /// Evaluates `jacobian[i + n·j] = ∂fᵢ/∂yⱼ` (by columns) and `dfdt[i] = ∂fᵢ/∂t`. Explicit
    /// methods never call it.
    ///
    /// # Errors
    /// When it has no finite value there.
    fn jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        jacobian: &mut [f64],
        dfdt: &mut [f64],
    ) -> Result<(), Failure>;
    /// Returns the pattern of `∂f/∂y` if most of it is empty; then [`Ode::jacobian_entries`] is
    /// called instead of [`Ode::jacobian`].
    ///
    /// Called at the start and at every restart; the same pattern is returned as the same `Arc`.
    fn pattern(&mut self) -> Option<std::sync::Arc<pattern::Pattern>> {
        None
    }
    /// Evaluates `∂f/∂y` at the entries of the pattern.
    ///
    /// # Errors
    /// When it has no finite value there.
    fn jacobian_entries(
        &mut self,
        _t: f64,
        _y: &[f64],
        _entries: &mut [f64],
    ) -> Result<(), Failure> {
        unreachable!("a problem that tells the pattern of its Jacobian tells its entries")
    }
    /// Sets the typical magnitude of each unknown, of which it has the roundings   (n)
    fn typical(&self, typical: &mut [f64]);
    /// Sets how the magnitude of each unknown depends on others   (n)
    fn relations(&self, _relations: &mut [Relation]) {}
}

/// The dependence of the magnitude of an unknown, against which its errors are measured, on other
/// unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relation {
    /// upper bound of the magnitude: an angle is as exact as its fraction of a turn, however many
    /// turns it has made
    pub most: f64,
    /// number of the group of unknowns of one kind that it belongs to
    pub group: Option<u32>,
    /// least magnitude, as a part of the largest in its group: where one angle of many hardly
    /// moves, the motion of the others decides
    pub share: f64,
    /// the unknown whose rate it is, if its error may be judged by the change it makes to that one
    /// within a step
    pub rate_of: Option<usize>,
    /// whether it is a rate whose typical magnitude is that of what it changes: it has the
    /// roundings of that over a mean step
    pub is_rate: bool,
    /// whether its magnitude is that of its way from where it began: a coordinate that a choice of
    /// origin makes large
    pub from_beginning: bool,
}

impl Default for Relation {
    fn default() -> Self {
        Relation {
            most: f64::INFINITY,
            group: None,
            share: 0.0,
            rate_of: None,
            is_rate: false,
            from_beginning: false,
        }
    }
}

/// The request to a method: accuracy and limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// E: permitted local error of each unknown, relative to its magnitude
    pub tolerance: f64,
    /// first step, in s; estimated from the problem when absent
    pub h_initial: Option<f64>,
    /// longest step, in s
    pub h_max: f64,
    /// a step shorter than this ends the integration, in s
    pub h_min: f64,
    /// Newton iterations permitted per step
    pub max_newton: usize,
    /// attempted steps permitted in all, rejected ones included
    pub max_steps: usize,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            tolerance: 1e-6,
            h_initial: None,
            h_max: f64::INFINITY,
            h_min: 0.0,
            max_newton: 10,
            max_steps: usize::MAX,
        }
    }
}

/// An accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// beginning, in s
    pub t0: f64,
    /// end, in s
    pub t1: f64,
    /// length, in s
    pub h: f64,
    /// order of the method in this step
    pub order: usize,
    /// attempts rejected before it
    pub rejected: usize,
}

/// The end of an integration that could not go on: its cause and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// the cause
    pub reason: Reason,
    /// end of the last accepted step, in s
    pub t: f64,
    /// length of the last attempt, in s
    pub h: f64,
}

/// The cause of a [`Stop`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// the problem reported that it has no value, however short the step
    Evaluation(Failure),
    /// the rate or residual with this index was not a number, however short the step
    NotFinite(usize),
    /// the invariants could not be reached, however short the step
    Projection(Failure),
    /// the error of this unknown stayed above its tolerance, however short the step
    ErrorTest(usize),
    /// Newton's iteration did not converge, however short the step; this row was worst
    Newton(usize),
    /// the Newton matrix is singular: nothing determines this unknown
    Singular(usize),
    /// as many steps as permitted
    TooManySteps,
    /// branches keep changing while time hardly advances; this unknown changes most
    Endless(usize),
    /// thousands of steps hardly advanced time; this unknown changes fastest
    Stalled(usize),
}

/// Counts of the work of an integration so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// accepted steps
    pub steps: usize,
    /// rejected attempts
    pub rejected: usize,
    /// evaluations of the rate or the residual
    pub evaluations: usize,
    /// evaluations of the Jacobian
    pub jacobians: usize,
    /// factorizations of the Newton matrix
    pub factorizations: usize,
    /// Newton iterations
    pub newton_iterations: usize,
    /// operations of factorizations and solutions, about
    pub algebra: usize,
    /// accepted steps with an error estimate above the permitted one that rounding explains (see
    /// `numeric/noise.rs`)
    pub below_rounding: usize,
    /// accepted steps that stability, not accuracy, held short
    pub stability_limited: usize,
    /// accepted steps of an explicit method at the edge of its stability region or beyond it, be
    /// they few in a row
    pub at_edge: usize,
}

/// The memory of a method that has ended, for one of its kind that goes on from there with the same
/// problem, constants of which may have changed.
#[derive(Clone, Debug)]
pub struct Memory {
    /// length of the step that would have followed, in s
    step: f64,
    /// derivatives of RADAU5
    radau: Option<radau::Derivatives>,
}

impl Memory {
    /// Returns all numbers of it: what is made of them again goes on with the same bits.
    pub fn numbers(&self) -> Vec<Vec<f64>> {
        let more = self.radau.iter().flat_map(radau::Derivatives::numbers);
        std::iter::once(vec![self.step]).chain(more).collect()
    }

    /// Makes it of its numbers; `None`: they are no such numbers.
    pub fn of_numbers(mut numbers: Vec<Vec<f64>>) -> Option<Self> {
        let more = numbers.split_off(numbers.len().min(1));
        let [step] = numbers.first()?[..] else {
            return None;
        };
        let radau = match more.is_empty() {
            true => None,
            false => Some(radau::Derivatives::of_numbers(more.try_into().ok()?)?),
        };
        (step.is_finite() && step > 0.0).then_some(Self { step, radau })
    }
}

/// The contract of a method for problems of type `P`.
///
/// A new method provides: its state at the end of the last accepted step (`t`, `y`, `ydot`); a step
/// that never passes `t_limit`, that shortens itself when the problem fails, and that gives up with
/// a reason; an interpolant over that step whose order befits the method; one level of undo; a
/// restart that keeps the magnitudes seen so far; and counts. After `start` nothing allocates.
pub trait Method<P: ?Sized> {
    /// Begins at `(t, y)` with nothing known about the past.
    ///
    /// # Errors
    /// When the problem cannot be evaluated there.
    fn start(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop>;
    /// Begins anew at `(t, y)` after an event; magnitudes and counts are kept.
    ///
    /// # Errors
    /// When the problem cannot be evaluated there.
    fn reinitialize(&mut self, problem: &mut P, t: f64, y: &[f64]) -> Result<(), Stop>;
    /// Takes one accepted step, not beyond `t_limit`, which must lie after `t`.
    ///
    /// # Errors
    /// When no step can be taken; the state is that of the last accepted step.
    fn step(&mut self, problem: &mut P, t_limit: f64) -> Result<Step, Stop>;
    /// Goes back to the beginning of the last accepted step; the next step ends no later than its
    /// own `t_limit`. Only the last step can be undone.
    fn undo(&mut self);
    /// Interpolates the solution at `t` inside the last accepted step.
    ///
    /// # Errors
    /// When a further evaluation that the interpolant needs fails.
    fn interpolate(&mut self, problem: &mut P, t: f64, y: &mut [f64]) -> Result<(), Failure>;
    /// Finds the state in the middle of the last accepted step from what is known of it, without an
    /// evaluation: less exact than interpolated. False: it is not known.
    fn middle(&self, _y: &mut [f64]) -> bool {
        false
    }
    /// Differentiates the interpolant at `t` inside the last accepted step.
    ///
    /// # Errors
    /// When a further evaluation that the interpolant needs fails.
    fn interpolate_rate(
        &mut self,
        problem: &mut P,
        t: f64,
        ydot: &mut [f64],
    ) -> Result<(), Failure>;
    /// Visits the nodes of a quadrature over the last accepted step: of about the order of the
    /// method, so that an integral along the motion is as good as if it were an unknown. `ends`: of
    /// the step; `work`: scratch.
    ///
    /// # Errors
    /// When a further evaluation that the interpolant needs fails.
    fn quadrature(
        &mut self,
        problem: &mut P,
        ends: [f64; 2],
        work: &mut [Vec<f64>; 2],
        visit: &mut dyn FnMut(&mut P, Node<'_>),
    ) -> Result<(), Failure>;
    /// Leaves, at the end of an integration, what a method of its kind may go on with; nothing is
    /// left of it. `None`: one of several steps begins anew.
    fn leave(&mut self) -> Option<Memory> {
        None
    }
    /// Goes on, after its start, with what a method of its kind has left where it ended.
    fn go_on(&mut self, _memory: &Memory) {}
    /// Returns the errors that the unknowns are permitted.
    fn weights(&self) -> &Weights;
    /// Permits, after its start, the errors that another method has permitted so far.
    fn take_weights(&mut self, weights: Weights);
    /// Returns what is known of the rounding of errors, where that is measured.
    fn noise(&self) -> Option<&Noise> {
        None
    }
    /// Takes, after its start, what a method of its kind has known of rounding.
    fn take_noise(&mut self, _noise: Noise) {}
    /// Proposes the length of the next step, in s.
    fn propose(&mut self, h: f64);
    /// Returns the end of the last accepted step, in s.
    fn t(&self) -> f64;
    /// Returns the solution there   (n)
    fn y(&self) -> &[f64];
    /// Returns its rate there   (n)
    fn ydot(&self) -> &[f64];
    /// Returns the counts of the work so far.
    fn stats(&self) -> &Stats;
    /// Returns whether stability rather than accuracy limits the steps, so that an implicit method
    /// would do better.
    fn stiff(&self) -> bool {
        false
    }
}

/// One row of the table of methods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MethodRow {
    /// name, as it is written in models and commands
    pub name: &'static str,
    /// description in a few words
    pub summary: &'static str,
    /// whether it solves no equations, so that it cannot treat stiff problems
    pub explicit: bool,
    /// order of the method
    pub order: usize,
    /// factor from the difference between a run and one at a smaller request to a bar of error
    /// that holds for 99 % of outputs, with something to spare; measured by
    /// `benches/accuracy`
    pub safety: f64,
    /// ρ: a request over that of the run whose difference tells the error
    pub tightening: f64,
}

/// The table of all methods.
pub const METHODS: &[MethodRow] = &[
    MethodRow {
        name: "DOP853",
        summary: "explicit Runge–Kutta of Dormand and Prince, 8(5,3), projected onto invariants",
        explicit: true,
        order: 8,
        safety: 8.0,
        tightening: 4.0,
    },
    MethodRow {
        name: "RADAU5",
        summary: "Radau IIA of three stages for stiff problems, projected onto invariants",
        explicit: false,
        order: 5,
        safety: 10.0,
        tightening: 4.0,
    },
];

/// Creates the method of that name for problems of `n` unknowns, if it is in the table.
pub fn ode_method<P: Ode + ?Sized>(
    name: &str,
    n: usize,
    options: &Options,
) -> Option<Box<dyn Method<P>>> {
    match name {
        "DOP853" => Some(Box::new(Dop853::new(n, options))),
        "RADAU5" => Some(Box::new(Radau::new(n, options))),
        _ => None,
    }
}

#[cfg(test)]
mod random;
