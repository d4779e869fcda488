//! Rounding of rates: the part of an error estimate that no shorter step makes smaller than in
//! proportion to its length.
//!
//! ```text
//! δ = min over probes of ‖f(t, y + ε r ⊙ s) − f(t, y)‖      ε: unit roundoff, s: random signs  (1)
//! error estimate ≈ C h δ                                     whatever the method               (2)
//! ```
//!
//! with ‖·‖ relative to magnitudes, and r = |y|, or for an angle no less than a part of a turn: its
//! sine and cosine are rounded as parts of one. The arguments of stages are rounded as y is in (1),
//! and a rate that is computed stably is off by about as much as such a rounding changes it; so (1)
//! measures both.
//!
//! In long chains of links accelerations magnify roundings a hundred thousand times. An estimate of
//! a size that (2) explains says nothing of the step: a shorter one would be no better, only more
//! expensive. A rate that loses digits by itself, between large numbers that are not unknowns, is
//! not recognized.
//!
//! The smallest of three probes counts: where a state lies within rounding of a jump of the rates,
//! a probe across it measures the jump. That all three cross it is unlikely, and [`LARGEST_NOISE`]
//! bounds the harm.
//!
//! Source: Moré & Wild, Estimating Computational Noise, SIAM J. Sci. Comput. 33 (2011), for the
//! probes.

use super::control::{Weights, worst};
use super::{Ode, Stats};

/// C of (2): the weights of the stages in an error estimate have a root sum of squares of about 2,
/// and the smallest of three probes underestimates the largest rounding in a sample.
const ESTIMATE_PER_ROUNDING: f64 = 3.0;
/// Part of the upper bound of a magnitude (half a turn, for an angle) that is taken for r of (1).
const ROUNDED_SHARE_OF_BOUND: f64 = 0.25;
/// Relative error above which nothing is taken for rounding.
pub const LARGEST_NOISE: f64 = 5e-9;
/// Probes of (1) per measurement.
const PROBES: u64 = 3;

/// The rounding of a rate, as measured last.
#[derive(Clone, Copy, Debug, Default)]
pub struct Noise {
    /// time of the measurement, in s, and δ of (1) there
    known: Option<(f64, f64)>,
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
    /// Forgets the last measurement.
    pub fn forget(&mut self) {
        self.known = None;
    }

    /// Returns the part of a relative error estimate that rounding explains (2), for a step of
    /// length `h`; measured once for each time.
    ///
    /// `room`: for an argument and its rate   (n each)
    pub fn of_step<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        at: Probed,
        h: f64,
        room: [&mut [f64]; 2],
        stats: &mut Stats,
    ) -> f64 {
        let size = match self.known {
            Some((t, size)) if t == at.t => size,
            _ => {
                let size = measure(problem, at, room, stats);
                self.known = Some((at.t, size));
                size
            }
        };
        (ESTIMATE_PER_ROUNDING * h * size).min(LARGEST_NOISE)
    }
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
            *probe = y + f64::EPSILON * sign(i as u64, k) * y.abs().max(part);
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

/// Returns a random sign for unknown `i` in probe `k`, the same in every run (splitmix64).
fn sign(i: u64, k: u64) -> f64 {
    let mut z = i
        .wrapping_mul(PROBES)
        .wrapping_add(k + 1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    if (z ^ (z >> 31)) & 1 == 0 { 1.0 } else { -1.0 }
}
