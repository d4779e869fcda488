//! The error norm, and the rules that turn an error into the next step.
//!
//! An error is measured per unknown, relative to the magnitude of that unknown, and the worst one counts:
//!
//! ```text
//! Mᵢ = max(|yᵢ| at all steps so far, |yᵢ| at the end of this one, φ typicalᵢ, σᵢ maxⱼ Mⱼ of its group)        φ: Options::floor
//! ‖e‖ = maxᵢ |eᵢ| / (E Mᵢ)                                                           a step is good when ‖e‖ ≤ 1
//! ```
//!
//! Results are judged column by column against the largest value of the column, so the largest magnitude so far is the right measure:
//! an oscillation through zero costs nothing there. The worst unknown counts rather than a mean, since a chain of
//! a thousand links at rest must not hide the one that moves. A number that is not finite makes the norm not finite.

use super::{Options, Relation};

/// Least relative error that double precision can control.
const FINEST: f64 = 1e-14;

/// Magnitudes of the unknowns and the norm they define.
#[derive(Clone, Debug)]
pub struct Weights {
    tolerance: f64,
    floor: f64,
    /// as the problem gave it   (n)
    typical: Vec<f64>,
    /// Mᵢ   (n)
    magnitude: Vec<f64>,
    relations: Vec<Relation>,
    /// no magnitude is more than this   (n)
    most: Vec<f64>,
    /// largest magnitude in each group
    largest: Vec<f64>,
}

impl Weights {
    /// Weights for `n` unknowns, all of typical magnitude one until [`Weights::reset`].
    pub fn new(n: usize, options: &Options) -> Self {
        let tolerance = options.tolerance.max(FINEST);
        Weights {
            tolerance,
            floor: options.floor,
            typical: vec![1.0; n],
            magnitude: vec![options.floor; n],
            relations: vec![Relation::default(); n],
            most: vec![f64::INFINITY; n],
            largest: Vec::new(),
        }
    }

    /// Asks which unknowns are measured with others.
    pub fn relate(&mut self, fill: impl FnOnce(&mut [Relation])) {
        self.relations.fill(Relation::default());
        fill(&mut self.relations);
        for (most, r) in self.most.iter_mut().zip(&self.relations) {
            *most = r.most;
        }
        let groups = self.relations.iter().filter_map(|r| r.group);
        self.largest = vec![0.0; groups.max().map_or(0, |g| usize::from(g) + 1)];
    }

    /// Forgets what was seen and asks for the typical magnitudes.
    pub fn reset(&mut self, fill: impl FnOnce(&mut [f64])) {
        fill(&mut self.typical);
        for (m, typical) in self.magnitude.iter_mut().zip(&mut self.typical) {
            *typical = if typical.is_finite() {
                typical.abs().max(1e-200)
            } else {
                1.0
            };
            *m = *typical * self.floor;
        }
    }

    /// Takes note of the magnitudes of `y`.
    pub fn see(&mut self, y: &[f64]) {
        for (m, y) in self.magnitude.iter_mut().zip(y) {
            *m = if y.abs() > *m { y.abs() } else { *m };
        }
        if self.largest.is_empty() {
            return;
        }
        for (m, r) in self.magnitude.iter_mut().zip(&self.relations) {
            *m = m.min(r.most);
            if let Some(g) = r.group {
                let largest = &mut self.largest[usize::from(g)];
                *largest = largest.max(*m);
            }
        }
        for (m, r) in self.magnitude.iter_mut().zip(&self.relations) {
            if let Some(g) = r.group {
                *m = m.max(r.share * self.largest[usize::from(g)]);
            }
        }
    }

    /// Typical magnitudes   (n)
    pub fn typical(&self) -> &[f64] {
        &self.typical
    }

    /// Unknowns that are rates of others, with these.
    pub fn rates(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let all = self.relations.iter().enumerate();
        all.filter_map(|(i, r)| Some((i, r.rate_of?)))
    }

    /// `Mᵢ`   (n)
    pub fn magnitude(&self) -> &[f64] {
        &self.magnitude
    }

    /// What no magnitude is more than   (n)
    pub fn most(&self) -> &[f64] {
        &self.most
    }

    /// E as used: not below what double precision can control.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// `‖e‖` of a step that ends at `y`.
    pub fn norm(&self, e: &[f64], y: &[f64]) -> f64 {
        worst(self.relative(e, y)) / self.tolerance
    }

    /// `eᵢ / Mᵢ` of a step that ends at `y`.
    pub fn relative<'a>(&'a self, e: &'a [f64], y: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let magnitudes = self.magnitude.iter().zip(&self.most);
        e.iter()
            .zip(y)
            .zip(magnitudes)
            .map(|((e, y), (m, most))| e / y.abs().min(*most).max(*m))
    }
}

/// The largest absolute value; not finite when one of them is not.
pub fn worst(values: impl Iterator<Item = f64>) -> f64 {
    let (mut largest, mut sum) = (0.0, 0.0);
    for x in values {
        let size = x.abs();
        sum += size;
        largest = if size > largest { size } else { largest };
    }
    if sum.is_finite() { largest } else { f64::NAN }
}

/// Where the largest absolute value stands; the first number that is not finite when there is one.
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

/// Proportional-integral step control for one-step methods.
///
/// ```text
/// h_new = h · clamp(safety · ‖e‖^(−α) · ‖e_previous‖^β)        α = 1/k − 0.75 β
/// ```
///
/// Source: Gustafsson, ACM TOMS 17 (1991); Hairer & Wanner, Solving ODEs II, IV.2.
#[derive(Clone, Copy, Debug)]
pub struct Pi {
    alpha: f64,
    beta: f64,
    safety: f64,
    shrink: f64,
    grow: f64,
    previous: f64,
}

impl Pi {
    /// Control for an error estimate that behaves like `h^k`.
    pub fn new(k: f64, beta: f64, safety: f64, shrink: f64, grow: f64) -> Self {
        Pi {
            alpha: 1.0 / k - 0.75 * beta,
            beta,
            safety,
            shrink,
            grow,
            previous: 1.0,
        }
    }

    /// Forgets the previous error.
    pub fn reset(&mut self) {
        self.previous = 1.0;
    }

    /// Factor for the next step after one with `‖e‖ ≤ 1`. `calm` forbids growth (right after a rejection);
    /// `guessed` allows more of it (the step was no more than a guess).
    pub fn accepted(&mut self, error: f64, calm: bool, guessed: bool) -> f64 {
        let error = error.max(1e-10);
        let factor = self.safety * error.powf(-self.alpha) * self.previous.powf(self.beta);
        self.previous = error.max(1e-4);
        let grow = if calm { 1.0 } else { self.grow };
        factor.clamp(self.shrink, if guessed { 5.0 * grow } else { grow })
    }

    /// Factor for another attempt after one with `‖e‖ > 1`, or with an error that is no number.
    pub fn rejected(&self, error: f64) -> f64 {
        let factor = self.safety * error.powf(-self.alpha);
        if factor.is_finite() {
            factor.clamp(self.shrink, 0.9)
        } else {
            self.shrink
        }
    }
}

/// Guesses the first step of a one-step method from the time scale of the solution.
pub struct Starter<'a> {
    /// order of the method
    pub order: usize,
    /// the request
    pub options: &'a Options,
    /// magnitudes; here the typical ones count in full, since little has been seen
    pub weights: &'a Weights,
}

impl Starter<'_> {
    /// ```text
    /// 1/τ = max(‖f‖, √‖Δf/Δt‖)  relative to magnitudes,        h = τ (E/100)^(1/k)
    /// ```
    ///
    /// The second derivative comes from one explicit Euler step of τ/100; when `rate` fails there the guess rests on `f` alone.
    pub fn first_step(
        &self,
        t: f64,
        y: &[f64],
        f: &[f64],
        y_probe: &mut [f64],
        f_probe: &mut [f64],
        mut rate: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), super::Failure>,
    ) -> f64 {
        if let Some(h) = self.options.h_initial {
            return h.min(self.options.h_max);
        }
        let typical = self.weights.typical();
        let scale = |i: usize| y[i].abs().max(typical[i]);
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
                (0.01 * self.weights.tolerance()).powf(1.0 / self.order as f64) / haste
            } else {
                1e3 * probe
            };
            // a rate that is quite another so far away says nothing about a step so short
            if h < 1e-5 * probe && probe > 1e-12 * t.abs().max(1e-6) {
                probe *= 1e-2;
                continue;
            }
            return h.min(self.options.h_max);
        }
    }
}

/// Why there is no step where one that is shorter than the shortest is proposed at once: the unknown that changes fastest grows without bound.
pub fn too_fast(rate: &[f64], weights: &Weights) -> super::Reason {
    let speeds = rate.iter().zip(weights.magnitude()).map(|(f, m)| f / m);
    super::Reason::ErrorTest(worst_index(speeds))
}

/// The shortest sensible step at `t`: time must visibly pass.
pub fn shortest(t: f64, options: &Options) -> f64 {
    options.h_min.max(16.0 * f64::EPSILON * t.abs()).max(1e-200)
}

/// Fits a step to the limit: never beyond, and never leaving a remnant that is much shorter than the step.
///
/// Returns the length and whether the step ends exactly at the limit.
pub fn fit(t: f64, h: f64, t_limit: f64) -> (f64, bool) {
    let rest = t_limit - t;
    if h * 1.01 >= rest {
        (rest, true)
    } else if h * 2.0 > rest {
        (rest / 2.0, false)
    } else {
        (h, false)
    }
}
