//! Rounding of rates: the part of an error estimate that no shorter step makes smaller than in
//! proportion to its length.
//!
//! ```text
//! δ = min over probes of ‖f(t, y + ε r ⊙ s) − f(t, y)‖      ε: unit roundoff, s: random signs  (1)
//! error estimate ≈ C h δ                                     whatever the method               (2)
//! δ = min over j of |Δ³ f(t + j τ, y + j τ f)| / √20         τ = h/64                          (3)
//! ```
//!
//! with ‖·‖ relative to magnitudes, and r = |y|, or for an angle no less than a part of a turn: its
//! sine and cosine are rounded as parts of one. The arguments of stages are rounded as y is in (1),
//! and a rate that is computed stably is off by about as much as such a rounding changes it; so (1)
//! measures both.
//!
//! In long chains of links accelerations magnify roundings a hundred thousand times. An estimate of
//! a size that (2) explains says nothing of the step: a shorter one would be no better, only more
//! expensive.
//!
//! A rate may lose digits by itself, between large numbers that are not unknowns (a heavy body on a
//! light one, masses 1e9 : 1), and repeat the same roundings wherever (1) probes. Third differences
//! along the motion (3) show it. They cost four evaluations, and contain a small part of an error
//! of truncation whose two estimates are alike, as those of rounding are; only there they count.
//! Since roundings come in patches, the largest of the last measurements counts.
//!
//! Third differences of a curve through data do not repeat either, but fall with τ, where those of
//! rounding keep their size. So after many steps that were asked for in vain both are measured, and
//! rounding that is proven so may be far larger than the request: no step is shortened for it.
//!
//! The smallest of three probes counts: where a state lies within rounding of a jump of the rates,
//! a probe across it measures the jump. That all three cross it is unlikely, and [`Noise::largest`]
//! bounds the harm.
//!
//! Source: Moré & Wild, Estimating Computational Noise, SIAM J. Sci. Comput. 33 (2011), for the
//! probes.

use super::control::{Weights, worst};
use super::{Ode, Options, Stats};
use crate::random::{Random, sign};

/// C of (2): the weights of the stages in an error estimate have a root sum of squares of about 2,
/// and the smallest of three probes underestimates the largest rounding in a sample.
const ESTIMATE_PER_ROUNDING: f64 = 3.0;
/// C of (2) for (3): the smaller of two differences underestimates, and roundings come in patches.
const ESTIMATE_PER_DIFFERENCE: f64 = 20.0;
/// Factor of an earlier measurement of (3) with each further one.
const FADING: f64 = 0.9;
/// Part of the upper bound of a magnitude (half a turn, for an angle) that is taken for r of (1).
const ROUNDED_SHARE_OF_BOUND: f64 = 0.25;
/// Relative error above which nothing is taken for rounding that is not proven.
const LARGEST_NOISE: f64 = 1e-6;
/// Relative error above which nothing is taken for rounding.
const LARGEST_PROVEN: f64 = 1e-4;
/// Steps asked for in vain after which a proof is tried; twice as many each time it fails.
const STEPS_BEFORE_PROOF: usize = 500;
/// Measurements of (3) at two distances that a proof takes.
const MEASUREMENTS_OF_PROOF: usize = 32;
/// τ of (3) where rounding is proven, as a part of the step: what truncation adds to differences
/// falls with its cube.
const PROVEN_STRIDE: f64 = 1.0 / 4096.0;
/// τ of the second measurement of a proof, over that of the first.
const FINER: f64 = 1.0 / 8.0;
/// Sum of the second measurements over that of the first from which on they are rounding: where the
/// slope of the rate jumps it is an eighth, where a higher derivative does less.
const KEPT_BY_ROUNDING: f64 = 0.3;
/// The same over the permitted error: what does not repeat may also be a curve through data, whose
/// third derivative jumps at each point, and that must not cost more than a digit and a half.
const NOISE_PER_TOLERANCE: f64 = 30.0;
/// The same where only (1) has been measured.
const LARGEST_PROBED: f64 = 5e-9;
/// τ of (3), as a part of the step.
const STRIDE: f64 = 1.0 / 64.0;
/// Weights of the rates in the two third differences of (3), over √20: they keep the size of
/// independent roundings.
const DIFFERENCES: [[f64; 2]; 5] = {
    const UNIT: f64 = 0.22360679774997896;
    [
        [-UNIT, 0.0],
        [3.0 * UNIT, -UNIT],
        [-3.0 * UNIT, 3.0 * UNIT],
        [UNIT, -3.0 * UNIT],
        [0.0, UNIT],
    ]
};
/// Fewest and most states of a motion at which the rounding of its rates is measured.
const FEWEST_STATES: usize = 5;
const MOST_STATES: usize = 24;
/// Probes of (1) per measurement.
const PROBES: u64 = 3;

/// The rounding of a rate, as measured last.
#[derive(Clone, Debug)]
pub struct Noise {
    /// time of the measurement, in s, and δ of (1) there
    known: Option<(f64, f64)>,
    /// time of the last measurement of (3), in s
    differenced: Option<f64>,
    /// δ of (3): the largest of the last measurements
    largest: f64,
    /// the two third differences of (3)   (n each)
    differences: [Vec<f64>; 2],
    proof: Proof,
}

/// The proof that differences of rates are rounding.
#[derive(Clone, Debug)]
struct Proof {
    /// steps asked for in vain before the next attempt
    left: usize,
    /// steps asked for in vain between the last two attempts
    patience: usize,
    /// measurements so far of the present attempt
    measured: usize,
    /// their sums, at τ and at τ times [`FINER`]
    sums: [f64; 2],
    is_given: bool,
}

impl Proof {
    fn new() -> Self {
        Proof {
            left: STEPS_BEFORE_PROOF,
            patience: STEPS_BEFORE_PROOF,
            measured: 0,
            sums: [0.0; 2],
            is_given: false,
        }
    }

    /// Returns whether rates are to be measured at two distances.
    fn is_tried(&self) -> bool {
        !self.is_given && self.left == 0
    }

    /// Takes note of a measurement at each distance.
    fn see(&mut self, sizes: [f64; 2]) {
        self.measured += 1;
        self.sums = [self.sums[0] + sizes[0], self.sums[1] + sizes[1]];
        if self.measured < MEASUREMENTS_OF_PROOF {
            return;
        }
        self.is_given = self.sums[1] >= KEPT_BY_ROUNDING * self.sums[0];
        self.patience *= 2;
        (self.left, self.measured, self.sums) = (self.patience, 0, [0.0; 2]);
    }
}

/// A state at which the rounding of the rate is measured.
#[derive(Clone, Copy)]
pub struct Probed<'a> {
    /// time, in s
    pub t: f64,
    /// solution   (n)
    pub y: &'a [f64],
    /// its rate   (n)
    pub f: &'a [f64],
    /// magnitudes of the unknowns
    pub weights: &'a Weights,
}

impl Noise {
    /// Creates room for `n` unknowns; nothing is measured.
    pub fn new(n: usize) -> Self {
        Noise {
            known: None,
            differenced: None,
            largest: 0.0,
            differences: [vec![0.0; n], vec![0.0; n]],
            proof: Proof::new(),
        }
    }

    /// Returns the relative error above which nothing is taken for rounding; `alike`: the two
    /// estimates of the step are, `tolerance`: the relative error that is permitted.
    pub fn largest(&self, alike: bool, tolerance: f64) -> f64 {
        match (alike, self.proof.is_given) {
            (true, true) => LARGEST_PROVEN,
            (true, false) => (NOISE_PER_TOLERANCE * tolerance).clamp(LARGEST_PROBED, LARGEST_NOISE),
            (false, _) => LARGEST_PROBED,
        }
    }

    /// Returns whether differences of rates have been proven to be rounding.
    pub fn is_proven(&self) -> bool {
        self.proof.is_given
    }

    /// Takes note of an accepted step whose request was in vain.
    pub fn in_vain(&mut self) {
        self.proof.left = self.proof.left.saturating_sub(1);
    }

    /// Forgets the last measurements.
    pub fn forget(&mut self) {
        (self.known, self.differenced, self.largest) = (None, None, 0.0);
    }

    /// Returns the part of a relative error estimate that rounding explains (2), for a step of
    /// length `h`; measured once for each time. `alike`: its two estimates are.
    ///
    /// `room`: for an argument and its rate   (n each)
    pub fn of_step<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        at: Probed,
        (h, alike): (f64, bool),
        [probe, rate]: [&mut [f64]; 2],
        stats: &mut Stats,
    ) -> f64 {
        let size = match self.known {
            Some((t, size)) if t == at.t => size,
            _ => {
                let size = measure(problem, at, [probe, rate], stats);
                self.known = Some((at.t, size));
                size
            }
        };
        let probed = (ESTIMATE_PER_ROUNDING * h * size).min(LARGEST_PROBED);
        if !alike {
            return probed;
        }
        let tolerance = at.weights.tolerance();
        if self.differenced != Some(at.t) {
            let tau = h * if self.proof.is_given {
                PROVEN_STRIDE
            } else {
                STRIDE
            };
            let size = self.difference(problem, at, tau, [&mut *probe, &mut *rate], stats);
            if self.proof.is_tried() {
                let finer = self.difference(problem, at, FINER * tau, [probe, rate], stats);
                self.proof.see([size, finer]);
            }
            self.largest = size.max(FADING * self.largest);
            self.differenced = Some(at.t);
        }
        (ESTIMATE_PER_DIFFERENCE * h * self.largest)
            .min(self.largest(alike, tolerance))
            .max(probed)
    }

    /// Measures δ of (3) at distances of `tau`, in s; 0 where a rate has no value.
    fn difference<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        at: Probed,
        tau: f64,
        [argument, rate]: [&mut [f64]; 2],
        stats: &mut Stats,
    ) -> f64 {
        let [one, other] = &mut self.differences;
        for (j, [a, b]) in DIFFERENCES.into_iter().enumerate() {
            let rate: &[f64] = if j == 0 {
                one.fill(0.0);
                other.fill(0.0);
                at.f
            } else {
                let s = j as f64 * tau;
                for ((x, y), f) in argument.iter_mut().zip(at.y).zip(at.f) {
                    *x = y + s * f;
                }
                stats.evaluations += 1;
                if problem.rate(at.t + s, argument, rate).is_err() {
                    return 0.0;
                }
                rate
            };
            for ((one, other), f) in one.iter_mut().zip(other.iter_mut()).zip(rate) {
                *one += a * f;
                *other += b * f;
            }
        }
        let both = one.iter().zip(other.iter()).zip(at.weights.magnitude());
        let size = worst(both.map(|((a, b), m)| a.abs().min(b.abs()) / m));
        if size.is_finite() { size } else { 0.0 }
    }
}

/// Returns what rounding of the rates adds up to along a motion in so many steps of any method, as
/// a part of the magnitudes: δ of (3) at some of its states, times and solutions, in the median. It
/// walks at random,
///
/// ```text
/// e = δ T/√N                              N steps in the time T
/// ```
///
/// `None`: there are too few states. Jumps of a rate, which differences show as well, are rare
/// among the states; slopes hardly change over a part [`PROVEN_STRIDE`] of a step.
pub(crate) fn along<P: Ode + ?Sized>(
    problem: &mut P,
    states: &[(f64, &[f64])],
    (tolerance, steps): (f64, usize),
) -> Option<f64> {
    let (&(begin, y), &(end, _)) = (states.first()?, states.last()?);
    if states.len() < FEWEST_STATES || steps == 0 || end <= begin {
        return None;
    }
    let options = Options {
        tolerance,
        ..Options::default()
    };
    let mut weights = Weights::new(y.len(), &options);
    weights.reset(|typical| problem.typical(typical));
    weights.relate(|relations| {
        problem.relations(relations);
        // these states are no steps
        relations.iter_mut().for_each(|r| r.is_rate = false);
    });
    states.iter().for_each(|(t, y)| weights.see(*t, y));
    let mut noise = Noise::new(y.len());
    let (mut f, mut argument, mut rate) = (y.to_vec(), y.to_vec(), y.to_vec());
    let tau = (end - begin) / steps as f64 * PROVEN_STRIDE;
    let mut sizes = Vec::new();
    for &(t, y) in states.iter().step_by(states.len().div_ceil(MOST_STATES)) {
        if problem.rate(t, y, &mut f).is_err() {
            continue;
        }
        let at = Probed {
            t,
            y,
            f: &f,
            weights: &weights,
        };
        let room = [&mut argument[..], &mut rate[..]];
        sizes.push(noise.difference(problem, at, tau, room, &mut Stats::default()));
    }
    sizes.sort_unstable_by(f64::total_cmp);
    let median = sizes
        .get(sizes.len() / 2)
        .filter(|_| sizes.len() >= FEWEST_STATES)?;
    Some(median * (end - begin) / (steps as f64).sqrt())
}

/// Measures δ of (1); 0 where no probe has a rate.
fn measure<P: Ode + ?Sized>(
    problem: &mut P,
    at: Probed,
    [probe, rate]: [&mut [f64]; 2],
    stats: &mut Stats,
) -> f64 {
    let mut least = f64::INFINITY;
    for k in 0..PROBES {
        let unknowns = probe.iter_mut().zip(at.y).zip(at.weights.most());
        for (i, ((probe, &y), most)) in unknowns.enumerate() {
            let part = if most.is_finite() {
                ROUNDED_SHARE_OF_BOUND * most
            } else {
                0.0
            };
            *probe =
                y + f64::EPSILON * sign(Random::bits_at(i as u64 * PROBES + k)) * y.abs().max(part);
        }
        stats.evaluations += 1;
        let changed = match problem.rate(at.t, probe, rate) {
            Ok(()) => {
                let off = rate.iter().zip(at.f).zip(at.weights.magnitude());
                worst(off.map(|((a, b), m)| (a - b) / m))
            }
            Err(_) => 0.0,
        };
        // a change that is NaN explains nothing
        least = if changed < least { changed } else { least };
    }
    if least.is_finite() { least } else { 0.0 }
}
