//! The error norm, and the rules that turn an error into the next step.
//!
//! An error is measured per unknown, relative to the magnitude of that unknown, and the worst one
//! counts:
//!
//! ```text
//! Mᵢ = max(|yᵢ| at all steps so far, |yᵢ| at the end of this one, ρ typicalᵢ / E, σᵢ maxⱼ Mⱼ)
//! ‖e‖ = maxᵢ |eᵢ| / (E Mᵢ)                                   a step is good when ‖e‖ ≤ 1
//! ```
//!
//! with the requested tolerance E, ρ = 50 roundings, and j over the unknowns of the same group as i
//! ([`Relation`]). A coordinate that is large only because of where the origin is
//! ([`Relation::from_beginning`]) counts as |yᵢ − yᵢ(0)|, so that moving a whole model changes
//! nothing, and as ρ |yᵢ(0)| / E at least. A rate ([`Relation::is_rate`]) has the roundings of
//! what it changes over the mean step h so far, ρ typicalᵢ / (E h). So nothing is permitted
//! absolutely but rounding: a motion of a nanometre is as exact as one of a metre, and no request
//! is finer than digits are. (A floor of a thousandth of the typical magnitude took one per cent
//! fewer evaluations on the references, and lost what moves by less than that times the request.)
//!
//! Results are judged column by column against the largest value of the column, so the largest
//! magnitude so far is the right measure: an oscillation through zero costs nothing there. A
//! transient is forgotten, since no output may show it: when a hundred times its duration has
//! passed, `Mᵢ` is as large as what came after. (A bushing of 10 kHz jerks at 130 m/s for 0.1 ms
//! and then moves at 1 m/s for seconds: 10 m/s of error were permitted at a request of 0.1.) The
//! worst unknown counts rather than a mean, since a chain of a thousand links at rest must not hide
//! the one that moves. A number that is not finite makes the norm not finite.

use super::{Failure, Options, Reason, Relation, Stats, Step, Stop};
use crate::scalar::Scalar;

/// Smallest relative error that double precision can control.
const SMALLEST_TOLERANCE: f64 = 1e-14;

/// Magnitudes of the unknowns, and the error norm that they define.
#[derive(Clone, Debug)]
pub struct Weights {
    /// E
    tolerance: f64,
    /// whether a smaller one was asked for
    raised: bool,
    /// ρ/E
    least: f64,
    /// typical magnitudes that the problem gave   (n)
    typical: Vec<f64>,
    /// Mᵢ   (n)
    magnitude: Vec<f64>,
    /// dependences between the magnitudes   (n)
    relations: Vec<Relation>,
    /// upper bounds of the magnitudes   (n)
    most: Vec<f64>,
    /// values from which sizes are measured   (n)
    origin: Vec<f64>,
    /// whether the unknown is measured from where it began   (n)
    from_beginning: Vec<bool>,
    /// whether rounding makes a magnitude larger than the motion does
    coarse: bool,
    /// largest magnitude of each group   (groups)
    largest: Vec<f64>,
    /// the courses by which transients are known   (n)
    courses: Vec<Course>,
    /// times of the first solution and of the last one seen, in s
    seen: [f64; 2],
    /// steps between them
    steps: usize,
}

/// Roundings of what is typical of an unknown that its permitted error is at least.
const ROUNDINGS: f64 = 50.0;
/// Levels of size that are told apart, from a magnitude down.
const LEVELS: usize = 8;
/// Size of one level as a part of that of the level above.
const LEVEL: f64 = 0.25;
/// Sizes below which an unknown is on each level but the first, as parts of its magnitude.
const BOUNDS: [f64; LEVELS] = {
    let mut bounds = [LEVEL; LEVELS];
    let mut k = 1;
    while k < LEVELS {
        bounds[k] = LEVEL * bounds[k - 1];
        k += 1;
    }
    bounds
};
/// Time after which a transient is forgotten, over the time during which it was large.
const FORGETTING: f64 = 100.0;

/// The course of the size of an unknown: how long it was on which level below its magnitude.
#[derive(Clone, Copy, Debug, Default)]
struct Course {
    /// time spent on each level, in s
    spent: [f64; LEVELS],
    /// time when it was on each level last, in s
    last: [f64; LEVELS],
    /// level when seen last
    level: usize,
}

impl Course {
    /// Takes note of a size at a time, `dt` after the one before, where the magnitude was `m`;
    /// returns the new one.
    #[inline]
    fn see(&mut self, size: f64, mut m: f64, (t, dt): (f64, f64)) -> f64 {
        if size > m {
            let mut risen = m / LEVEL;
            while risen < size && risen.is_finite() {
                self.rise(t);
                risen /= LEVEL;
            }
            m = size;
        }
        // most are on the first level, or at rest
        let is_above = |bound: &f64| size > bound * m || size.is_nan();
        let level = match size == 0.0 {
            true => LEVELS,
            false => BOUNDS.iter().position(is_above).unwrap_or(LEVELS),
        };
        let reached = level.min(self.level);
        self.level = level;
        if reached < LEVELS {
            self.spent[reached] += dt;
            self.last[reached] = t;
        }
        while self.level > 0 && t - self.last[0] > FORGETTING * self.spent[0] {
            self.forget();
            m *= LEVEL;
        }
        m
    }

    /// Makes the magnitude larger by a level.
    fn rise(&mut self, t: f64) {
        self.spent.copy_within(..LEVELS - 1, 1);
        self.last.copy_within(..LEVELS - 1, 1);
        (self.spent[0], self.last[0]) = (0.0, t);
        self.level = (self.level + 1).min(LEVELS);
    }

    /// Makes the magnitude smaller by a level.
    fn forget(&mut self) {
        let (spent, last) = (self.spent[0], self.last[0]);
        self.spent.copy_within(1.., 0);
        self.last.copy_within(1.., 0);
        self.spent[0] += spent;
        self.last[0] = self.last[0].max(last);
        self.spent[LEVELS - 1] = 0.0;
        self.level -= 1;
    }
}

impl Weights {
    /// Creates weights for `n` unknowns, all of typical magnitude one until [`Weights::reset`].
    pub fn new(n: usize, options: &Options) -> Self {
        let tolerance = options.tolerance.max(SMALLEST_TOLERANCE);
        let least = ROUNDINGS * f64::EPSILON / tolerance;
        Weights {
            tolerance,
            raised: options.tolerance < SMALLEST_TOLERANCE,
            least,
            typical: vec![1.0; n],
            magnitude: vec![least; n],
            relations: vec![Relation::default(); n],
            most: vec![f64::INFINITY; n],
            origin: vec![0.0; n],
            from_beginning: vec![false; n],
            coarse: false,
            largest: Vec::new(),
            courses: vec![Course::default(); n],
            seen: [f64::INFINITY; 2],
            steps: 0,
        }
    }

    /// Asks the problem, through `fill`, how magnitudes of unknowns depend on each other.
    pub fn relate(&mut self, fill: impl FnOnce(&mut [Relation])) {
        self.relations.fill(Relation::default());
        fill(&mut self.relations);
        for (most, r) in self.most.iter_mut().zip(&self.relations) {
            *most = r.most;
        }
        let from = self.from_beginning.iter_mut().zip(&self.relations);
        from.for_each(|(from, r)| *from = r.from_beginning);
        let numbers = self.relations.iter();
        let n_groups = numbers.map(|r| r.group.map_or(0, |g| g as usize + 1));
        self.largest = vec![0.0; n_groups.max().unwrap_or(0)];
    }

    /// Forgets the magnitudes seen so far and asks for the typical ones through `fill`.
    pub fn reset(&mut self, fill: impl FnOnce(&mut [f64])) {
        fill(&mut self.typical);
        for (m, typical) in self.magnitude.iter_mut().zip(&mut self.typical) {
            *typical = if typical.is_finite() {
                typical.abs().max(1e-200)
            } else {
                1.0
            };
            *m = *typical * self.least;
        }
        self.courses.fill(Course::default());
        self.seen = [f64::INFINITY; 2];
    }

    /// Raises the magnitudes to those of the solution `y` at `t`, and forgets transients.
    pub fn see(&mut self, t: f64, y: &[f64]) {
        let [begun, before] = &mut self.seen;
        if *before == f64::INFINITY {
            let origins = self.origin.iter_mut().zip(y).zip(&self.from_beginning);
            origins.for_each(|((origin, y), from)| *origin = if *from { *y } else { 0.0 });
            (*begun, self.steps) = (t, 0);
        } else {
            self.steps += 1;
        }
        let dt = (t - *before).max(0.0);
        *before = t;
        // a guess where no step has been taken
        let mean_step = match t > *begun {
            true => (t - *begun) / self.steps as f64,
            false => 1.0,
        };
        self.coarse = false;
        let all = self.magnitude.iter_mut().zip(y).zip(&mut self.courses);
        let places = self.typical.iter().zip(&self.origin).zip(&self.relations);
        for (((m, y), course), ((typical, origin), relation)) in all.zip(places) {
            let way = course.see((y - origin).abs(), *m, (t, dt));
            let rounded = self.least * origin.abs();
            let over = if relation.is_rate { mean_step } else { 1.0 };
            let least = typical * self.least / over;
            *m = way.max(least).max(rounded);
            self.coarse |= rounded > typical.max(way);
        }
        self.share();
    }

    /// Makes magnitudes no smaller than their shares of the largest in their groups.
    fn share(&mut self) {
        if self.largest.is_empty() {
            return;
        }
        self.largest.fill(0.0);
        for (m, r) in self.magnitude.iter_mut().zip(&self.relations) {
            *m = m.min(r.most);
            if let Some(g) = r.group {
                let largest = &mut self.largest[g as usize];
                *largest = largest.max(*m);
            }
        }
        for (m, r) in self.magnitude.iter_mut().zip(&self.relations) {
            if let Some(g) = r.group {
                *m = m.max(r.share * self.largest[g as usize]);
            }
        }
    }

    /// Returns the typical magnitudes   (n)
    pub fn typical(&self) -> &[f64] {
        &self.typical
    }

    /// Iterates over the unknowns that are rates of others: the rate, and the unknown it belongs
    /// to.
    pub fn rates(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let all = self.relations.iter().enumerate();
        all.filter_map(|(i, r)| Some((i, r.rate_of?)))
    }

    /// Returns `Mᵢ`   (n)
    pub fn magnitude(&self) -> &[f64] {
        &self.magnitude
    }

    /// Returns the upper bounds of the magnitudes   (n)
    pub fn most(&self) -> &[f64] {
        &self.most
    }

    /// Returns the values from which sizes are measured   (n)
    pub fn origin(&self) -> &[f64] {
        &self.origin
    }

    /// Returns E, raised to what double precision can control.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Returns whether a smaller error was asked for than double precision can control.
    pub fn is_raised(&self) -> bool {
        self.raised || self.coarse
    }
}

/// Returns the largest absolute value, or NaN when one of the values is not finite.
pub fn worst(values: impl Iterator<Item = f64>) -> f64 {
    let (mut largest, mut sum) = (0.0, 0.0);
    for x in values {
        let size = x.abs();
        sum += size;
        largest = if size > largest { size } else { largest };
    }
    if sum.is_finite() { largest } else { f64::NAN }
}

/// Returns the index of the first value that is not finite, or else of the largest absolute value.
pub fn worst_index(values: impl Iterator<Item = f64>) -> usize {
    let (mut at, mut largest) = (0, -1.0);
    for (i, x) in values.enumerate() {
        if !x.is_finite() {
            return i;
        }
        if x.abs() > largest {
            (at, largest) = (i, x.abs());
        }
    }
    at
}

/// Logarithm of the least ‖e‖ that a step has for the next one, 10⁻⁴.
const LN_LEAST_PREVIOUS: f64 = -4.0 * std::f64::consts::LN_10;

/// Proportional-integral step control for one-step methods.
///
/// ```text
/// h_new = h · clamp(safety · ‖e‖^(−α) · ‖e_previous‖^β)        α = 1/k − 0.75 β
/// ```
///
/// Source: Gustafsson, ACM TOMS 17 (1991); Hairer & Wanner, Solving ODEs II, IV.2.
#[derive(Clone, Copy, Debug)]
pub struct Pi {
    /// α
    alpha: f64,
    /// β
    beta: f64,
    /// factor that keeps the predicted error below the permitted one
    safety: f64,
    /// smallest factor of a step
    shrink: f64,
    /// largest factor of a step
    grow: f64,
    /// logarithm of ‖e‖ of the last accepted step
    previous: f64,
}

impl Pi {
    /// Creates the control for an error estimate that behaves like `h^k`; a step is multiplied by
    /// `shrink` at least and by `grow` at most.
    pub fn new(k: f64, beta: f64, safety: f64, shrink: f64, grow: f64) -> Self {
        Pi {
            alpha: 1.0 / k - 0.75 * beta,
            beta,
            safety,
            shrink,
            grow,
            previous: 0.0,
        }
    }

    /// Forgets the previous error.
    pub fn reset(&mut self) {
        self.previous = 0.0;
    }

    /// Returns the factor for the next step after one with `‖e‖ ≤ 1`.
    ///
    /// `calm` forbids growth (right after a rejection); `guessed` allows more of it (the step was
    /// only a guess).
    pub fn accepted(&mut self, error: f64, calm: bool, guessed: bool) -> f64 {
        let error = Scalar::ln(error.max(1e-10));
        let factor = self.safety * Scalar::exp(self.beta * self.previous - self.alpha * error);
        self.previous = error.max(LN_LEAST_PREVIOUS);
        let grow = if calm { 1.0 } else { self.grow };
        factor.clamp(self.shrink, if guessed { 5.0 * grow } else { grow })
    }

    /// Returns the factor for another attempt after one with `‖e‖ > 1`, or with an error that is no
    /// number.
    pub fn rejected(&self, error: f64) -> f64 {
        let factor = self.safety * Scalar::powf(error, -self.alpha);
        if factor.is_finite() {
            factor.clamp(self.shrink, 0.9)
        } else {
            self.shrink
        }
    }
}

/// The guess of the first step of a one-step method, from the time scale of the solution.
pub struct Starter<'a> {
    /// order of the method
    pub order: usize,
    /// requested tolerance and limits of the step
    pub options: &'a Options,
    /// magnitudes; the typical ones count in full here, since little of the solution is known
    pub weights: &'a Weights,
}

impl Starter<'_> {
    /// Guesses the first step from `(t, y)`, where the rate is `f`:
    ///
    /// ```text
    /// 1/τ = max(‖f‖, √‖Δf/Δt‖)  relative to magnitudes,        h = τ (E/100)^(1/k)
    /// ```
    ///
    /// The second derivative comes from one explicit Euler step of τ/100; when `rate` fails there
    /// the guess rests on `f` alone. `y_probe` and `f_probe` are scratch   (n each)
    pub fn first_step(
        &self,
        t: f64,
        y: &[f64],
        f: &[f64],
        y_probe: &mut [f64],
        f_probe: &mut [f64],
        mut rate: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    ) -> f64 {
        if let Some(h) = self.options.h_initial {
            return first_length(t, h, self.options);
        }
        let typical = self.weights.typical();
        let origin = self.weights.origin();
        let scale = |i: usize| (y[i] - origin[i]).abs().max(typical[i]);
        let speed = worst((0..y.len()).map(|i| f[i] / scale(i)));
        let mut probe = if speed > 1e-8 {
            0.01 / speed
        } else {
            1e-6 * t.abs().max(1.0)
        }
        .min(self.options.h_max);
        loop {
            for i in 0..y.len() {
                y_probe[i] = y[i] + probe * f[i];
            }
            let bend = match rate(t + probe, y_probe, f_probe) {
                Ok(()) => worst((0..y.len()).map(|i| (f_probe[i] - f[i]) / scale(i))) / probe,
                Err(_) => 0.0,
            };
            let haste = if bend.is_finite() {
                speed.max(bend.sqrt())
            } else {
                speed
            };
            let h = if haste > 1e-8 {
                Scalar::powf(0.01 * self.weights.tolerance(), 1.0 / self.order as f64) / haste
            } else {
                1e3 * probe
            };
            // a rate that is quite another so far away says nothing about a step so short
            if h < 1e-5 * probe && probe > 1e-12 * t.abs().max(1e-6) {
                probe *= 1e-2;
                continue;
            }
            return first_length(t, h, self.options);
        }
    }
}

/// Names the unknown that changes fastest, as the reason to stop where the first proposal after an
/// accepted step is shorter than the shortest step: it grows without bound.
pub fn too_fast(rate: &[f64], weights: &Weights) -> Reason {
    let speeds = rate.iter().zip(weights.magnitude()).map(|(f, m)| f / m);
    Reason::ErrorTest(worst_index(speeds))
}

/// Returns the shortest sensible step at `t`, in s: time must change in double precision.
fn shortest(t: f64, options: &Options) -> f64 {
    options.h_min.max(16.0 * f64::EPSILON * t.abs()).max(1e-200)
}

/// Returns the length of a first step whose guess is `guess`, in s: no longer than permitted, and
/// no shorter than the shortest step. A guess is no proof that nothing longer succeeds.
pub(super) fn first_length(t: f64, guess: f64, options: &Options) -> f64 {
    guess.max(shortest(t, options)).min(options.h_max)
}

/// Fits a step to the limit: never beyond, and never leaving a remnant that is much shorter than
/// the step.
///
/// Returns the length, and whether the step ends exactly at the limit.
fn fit(t: f64, h: f64, t_limit: f64) -> (f64, bool) {
    let rest = t_limit - t;
    if h * 1.01 >= rest {
        (rest, true)
    } else if h * 2.0 > rest {
        (rest / 2.0, false)
    } else {
        (h, false)
    }
}

/// The rejection of an attempted step.
#[derive(Clone, Copy, Debug)]
pub struct Rejection {
    /// the cause, for a [`Stop`]
    pub reason: Reason,
    /// whether a shorter step may help
    pub recoverable: bool,
    /// factor for the length of the next attempt
    pub factor: f64,
}

/// The attempts at one step.
#[derive(Clone, Copy, Debug)]
pub struct Attempts {
    /// beginning of the step, in s
    t0: f64,
    /// time that the step must not pass, in s
    t_limit: f64,
    /// shortest sensible step, in s
    shortest: f64,
    /// attempts rejected so far
    rejected: usize,
    /// the cause of the last rejection
    cause: Option<Reason>,
}

impl Attempts {
    /// Prepares the attempts at a step from `t0` that must not pass `t_limit`.
    pub fn new(t0: f64, t_limit: f64, options: &Options) -> Self {
        Attempts {
            t0,
            t_limit,
            shortest: shortest(t0, options),
            rejected: 0,
            cause: None,
        }
    }

    /// Returns the number of attempts rejected so far.
    pub fn rejected(&self) -> usize {
        self.rejected
    }

    /// Fits the next attempt of about the `proposed` length; returns its length and its end, in s.
    ///
    /// # Errors
    /// When as many steps as permitted have been attempted, or when the step is shorter than the
    /// shortest: for the cause of the last rejection, or for `too_fast` when there was none.
    pub fn next(
        &self,
        proposed: f64,
        options: &Options,
        stats: &Stats,
        too_fast: impl FnOnce() -> Reason,
    ) -> Result<(f64, f64), Stop> {
        let (h, at_limit) = fit(self.t0, proposed, self.t_limit);
        if stats.steps + stats.rejected >= options.max_steps {
            return Err(self.stop(Reason::TooManySteps, h));
        }
        if h < self.shortest && (self.rejected > 0 || !at_limit) {
            return Err(self.stop(self.cause.unwrap_or_else(too_fast), h));
        }
        Ok((h, if at_limit { self.t_limit } else { self.t0 + h }))
    }

    /// Notes a rejected attempt of length `h`.
    ///
    /// # Errors
    /// When a shorter step would not help.
    pub fn reject(&mut self, why: Rejection, h: f64, stats: &mut Stats) -> Result<(), Stop> {
        self.cause = Some(why.reason);
        if !why.recoverable {
            return Err(self.stop(why.reason, h));
        }
        self.repeat(stats);
        Ok(())
    }

    /// Notes an attempt that is repeated with another length.
    pub fn repeat(&mut self, stats: &mut Stats) {
        self.rejected += 1;
        stats.rejected += 1;
    }

    /// Notes the accepted attempt of length `h` that ends at `t1`; returns the step.
    pub fn accepted(&self, h: f64, t1: f64, order: usize, stats: &mut Stats) -> Step {
        stats.steps += 1;
        Step {
            t0: self.t0,
            t1,
            h,
            order,
            rejected: self.rejected,
        }
    }

    /// Ends the integration in an attempt of length `h`.
    pub fn stop(&self, reason: Reason, h: f64) -> Stop {
        Stop {
            reason,
            t: self.t0,
            h,
        }
    }
}
