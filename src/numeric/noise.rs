//! How much of a rate is rounding: below that no shorter step makes an error estimate smaller than in proportion to its length.
//!
//! ```text
//! δ = min over probes of ‖f(t, y + ε r ⊙ s) − f(t, y)‖          ε: the last place, s: signs by chance, ‖·‖: relative to magnitudes    (1)
//! error estimate ≈ C h δ                                         whatever the method                                              (2)
//! ```
//!
//! r is |y|, and of an angle no less than a part of a turn: its sine and cosine are rounded as parts of one. The arguments of stages are rounded as y is in (1), and a rate that is computed stably is off by about what such a rounding makes of it; so (1) measures both.
//! In long chains of links accelerations magnify roundings a hundred thousand times. An estimate of a size that (2) explains says nothing of the step: a
//! shorter one would be no better, only more expensive.
//!
//! What a rate loses by itself, between large numbers that are not unknowns, is not seen.
//!
//! The least of three probes counts: where a state lies on a jump of the rates, to the last place, a probe across it measures the jump; that all three of them
//! do is unlikely, and [`MOST`] bounds what may come of it.
//!
//! Source: Moré & Wild, Estimating Computational Noise, SIAM J. Sci. Comput. 33 (2011), for the probes.

use super::control::{Weights, worst};
use super::{Ode, Stats};

/// C of (2): the root of the squares of the weights in an error estimate is about 2, and three chances are few to meet the largest of a sample.
const SPREAD: f64 = 3.0;
/// Part of the most that an unknown is measured against (half a turn) that it is rounded as.
const OF_A_TURN: f64 = 0.25;
/// Relative error that is never taken for rounding.
pub const MOST: f64 = 5e-9;
/// Probes of (1).
const PROBES: u64 = 3;

/// What is known of the rounding of a rate.
#[derive(Clone, Copy, Debug, Default)]
pub struct Noise {
    /// where it has been measured, and δ of (1)
    known: Option<(f64, f64)>,
}

impl Noise {
    /// Forgets what was measured.
    pub fn forget(&mut self) {
        self.known = None;
    }

    /// The relative error estimate of a step of length `h` from `(t, y)` that rounding explains (2); measured once for each `t`. `f`: the rate there;
    /// `probe` and `rate` are room   (n each)
    #[allow(clippy::too_many_arguments)] // a state, its rate, its measure, and room
    pub fn of_step<P: Ode + ?Sized>(
        &mut self,
        problem: &mut P,
        (t, h): (f64, f64),
        y: &[f64],
        f: &[f64],
        weights: &Weights,
        [probe, rate]: [&mut [f64]; 2],
        stats: &mut Stats,
    ) -> f64 {
        let size = match self.known {
            Some((at, size)) if at == t => size,
            _ => {
                let mut least = f64::INFINITY;
                for k in 0..PROBES {
                    for (i, ((p, &y), most)) in
                        probe.iter_mut().zip(y).zip(weights.most()).enumerate()
                    {
                        let part = if most.is_finite() {
                            OF_A_TURN * most
                        } else {
                            0.0
                        };
                        *p = y + f64::EPSILON * sign(i as u64, k) * y.abs().max(part);
                    }
                    stats.evaluations += 1;
                    let changed = match problem.rate(t, probe, rate) {
                        Ok(()) => {
                            let off = rate.iter().zip(f).zip(weights.magnitude());
                            worst(off.map(|((a, b), m)| (a - b) / m))
                        }
                        Err(_) => 0.0,
                    };
                    // what is no number explains nothing
                    least = if changed < least { changed } else { least };
                }
                let size = if least.is_finite() { least } else { 0.0 };
                self.known = Some((t, size));
                size
            }
        };
        (SPREAD * h * size).min(MOST)
    }
}

/// One or minus one, by chance but always the same (splitmix64).
fn sign(i: u64, k: u64) -> f64 {
    let mut z = i
        .wrapping_mul(PROBES)
        .wrapping_add(k + 1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    if (z ^ (z >> 31)) & 1 == 0 { 1.0 } else { -1.0 }
}
