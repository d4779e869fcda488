//! Bars of error: how far a number of the results may be from the exact one.
//!
//! The run is made again at a smaller request (the *companion*). With errors in proportion to
//! requests E and E/ρ, the difference of the two runs is the error of the first, less a ρ-th part:
//!
//! ```text
//! dₖ = |yₖ − y'ₖ|        eₖ = max over l of dₗ 2^(−|k − l|/H)        barₖ = s (eₖ + ε-floor)
//! ```
//!
//! An error swings through zero as the motion does, so that the difference at one output says
//! little: eₖ is an envelope along time, which falls to half over H outputs. It grows where errors
//! grow and falls where they die out. The factor s stands in the table of methods
//! ([`METHODS`]); `benches/accuracy` measures it on the reference solutions.
//!
//! Times are rounded numbers, too: a bar is at least the change of its channel within the last
//! digit of the time.
//!
//! *Events* have an error in time. Where the two runs have an event at t and t', the outputs within
//! s |t − t'| of it may lie on the wrong side: their difference is at least that to the outputs
//! beside them.
//!
//! *Lost phase*: once a bar is as large as all that the channel does, the number says nothing. The
//! time from which that holds for most outputs until the end is told.

mod matching;

use crate::numeric::METHODS;
use crate::scalar::Scalar;
pub use matching::{Shift, partners, shifts};

/// ρ: the request over that of the companion, where no method worked.
const TIGHTENING: f64 = 4.0;
/// Request below which rounding decides, so that the companion has a larger one instead.
const LEAST_REQUEST: f64 = 4e-13;
/// Longest steps of the companion over those of the run, where something else than the request
/// sets them.
pub const SHORTER_STEPS: f64 = 0.7;
/// Tolerances of equilibria of the companion over those of the run.
pub const TIGHTER_REST: f64 = 1e-3;
/// Share of the outputs over which the envelope of differences falls to half.
const HALVING: f64 = 0.03;
/// Rounding of a channel, over ε times its largest value: what the references need.
const ROUNDING_OF_CHANNEL: f64 = 64.0;
/// Rounding of a channel, over ε times the largest value of all channels of its unit.
const ROUNDING_OF_UNIT: f64 = 4.0;
/// Factors of kinematics and statics. Their errors are rounding, which the companion samples as it
/// comes to the same places by other steps; no rate carries the same rounding through all outputs.
/// Of a slider-crank 99.8 % hold, and bars are 21 times the error.
const SAFETY_OF_PLACES: Safety = Safety {
    differences: 8.0,
    rounding: 0.25,
};
/// Largest bar, over the range of values that both runs have.
const LARGEST_BAR: f64 = 2.0;

/// Outputs from which on their range says how large a channel is.
pub const FEWEST_OUTPUTS: usize = 8;
/// Range of a channel that moves, over the largest value of all channels of its unit.
const LEAST_MOTION: f64 = 0.01;
/// Least size of a channel for its relative bar, over the largest value of all of its unit: what
/// is zero but for rounding has no digits to count.
pub const LEAST_SIZE: f64 = 1e-3;

/// Returns the request of the companion of a run by a method, or by several, at some request.
///
/// Where few steps lie between two events (`has_many_events`), their number hardly follows the
/// request: it is made so small that the method takes √2 times as many where they do.
pub fn companion_request(error: f64, methods: &[String], has_many_events: bool) -> f64 {
    let worked = |name: &str| methods.iter().any(|n| n == name);
    let rows = || METHODS.iter().filter(|m| worked(m.name));
    let order = rows().map(|m| m.order).min().unwrap_or(usize::MAX);
    // of the method of the least order, which needs most steps for it
    let slowest = rows().filter(|m| m.order == order).map(|m| m.tightening);
    let usual = slowest.reduce(f64::max).unwrap_or(TIGHTENING);
    let by_order = match has_many_events && order < usize::MAX {
        true => Scalar::powf(2.0, 0.5 * order as f64),
        false => 1.0,
    };
    let tightening = usual.max(by_order);
    if error < LEAST_REQUEST {
        error * tightening
    } else {
        error / tightening
    }
}

/// Largest request of an integration that tells the error of a better one: with few steps a swing
/// errors follow requests no longer, they may even change their sign.
const LARGEST_REQUEST: f64 = 1e-3;

/// Returns the request of an integration that takes 2^(−¾) = 0.6 of the steps of a run by a
/// method, or by several; `None` where that would be too large.
pub fn looser_request(error: f64, methods: &[String]) -> Option<f64> {
    let worked = |name: &str| methods.iter().any(|n| n == name);
    let rows = METHODS.iter().filter(|m| worked(m.name));
    let order = rows.map(|m| m.order).min().unwrap_or(1);
    let larger = error * Scalar::powf(2.0, 0.75 * order as f64);
    Some(larger.min(LARGEST_REQUEST)).filter(|larger| *larger > error)
}

/// Factors that make bars of what is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Safety {
    /// s
    pub differences: f64,
    /// factor of the rounding of a channel
    pub rounding: f64,
}

/// Returns the factors for the methods that worked.
pub fn safety(methods: &[String]) -> Safety {
    let rows = METHODS
        .iter()
        .filter(|m| methods.iter().any(|n| n == m.name));
    let largest = rows.map(|m| m.safety).fold(0.0, f64::max);
    if largest > 0.0 {
        Safety {
            differences: largest,
            rounding: largest,
        }
    } else {
        SAFETY_OF_PLACES
    }
}

/// A run beside its companion, over the outputs of one simulation.
#[derive(Clone, Debug)]
pub struct Comparison<'a> {
    /// factors
    pub safety: Safety,
    /// times of the outputs, in s
    pub times: &'a [f64],
    /// the output of the companion that belongs to each
    pub partners: &'a [Option<usize>],
    /// events of both runs
    pub shifts: &'a [Shift],
}

/// The bars of a channel over the outputs of one simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// absolute, in the unit of the channel; NaN where the companion has no value
    pub bars: Vec<f64>,
    /// the time from which on bars are as large as the range of the values, in s
    pub lost_from: Option<f64>,
}

impl Comparison<'_> {
    /// Returns the bars of a channel from its values, those of the companion, and the largest value
    /// of all channels of its unit.
    pub fn bars(&self, values: &[f64], others: &[f64], largest_of_unit: f64) -> Bars {
        let finite = values.iter().chain(others).filter(|x| x.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| {
            (l.min(x), h.max(x))
        });
        let floor = f64::EPSILON
            * (ROUNDING_OF_CHANNEL * low.abs().max(high.abs()).min(f64::MAX)
                + ROUNDING_OF_UNIT * largest_of_unit);
        let mut differences = self.differences(values, others);
        let unknown: Vec<bool> = differences.iter().map(|d| d.is_nan()).collect();
        envelope(&mut differences);
        self.blur_at_events(values, &mut differences);
        // of a few outputs, or of what hardly moves, the range says nothing
        let range = (high - low).max(0.0);
        let moves = values.len() >= FEWEST_OUTPUTS && range > LEAST_MOTION * largest_of_unit;
        let most = if moves { LARGEST_BAR * range } else { f64::MAX };
        let mut bars: Vec<f64> = (0..values.len())
            .map(|k| match unknown[k] {
                true => f64::NAN,
                false => {
                    let rounding = self.safety.rounding * floor + self.rounding_of_time(values, k);
                    (self.safety.differences * differences[k]).min(most) + rounding
                }
            })
            .collect();
        let is_lost = |bar: &f64| bar.is_nan() || *bar >= range;
        let lost: Vec<bool> = bars.iter().map(is_lost).collect();
        let lost_from = first_lost(&lost).and_then(|k| self.times.get(k).copied());
        // a value that is none has no bar
        for (bar, value) in bars.iter_mut().zip(values) {
            if !value.is_finite() {
                *bar = f64::NAN;
            }
        }
        Bars {
            bars,
            lost_from: lost_from.filter(|_| moves),
        }
    }

    /// Returns the change of a value within the rounding of its time, which both runs have alike.
    fn rounding_of_time(&self, values: &[f64], k: usize) -> f64 {
        let beside = [k.checked_sub(1), Some(k + 1)].into_iter().flatten();
        let slopes = beside.filter_map(|l| {
            let slope = (values[k] - values.get(l)?) / (self.times[k] - self.times.get(l)?);
            Some(slope.abs()).filter(|slope| slope.is_finite())
        });
        f64::EPSILON * self.times[k].abs() * slopes.fold(0.0, f64::max)
    }

    /// Returns the differences to the companion; NaN where it has no value.
    fn differences(&self, values: &[f64], others: &[f64]) -> Vec<f64> {
        let of = |(value, partner): (&f64, &Option<usize>)| {
            let other = partner.and_then(|k| others.get(k)).copied();
            other.map_or(f64::NAN, |other| (value - other).abs())
        };
        values.iter().zip(self.partners).map(of).collect()
    }

    /// Raises differences at outputs that may lie on the other side of an event.
    fn blur_at_events(&self, values: &[f64], differences: &mut [f64]) {
        for event in self.shifts {
            let reach = self.safety.differences * event.shift;
            let from = self.times.partition_point(|&t| t < event.t - reach);
            let to = self.times.partition_point(|&t| t <= event.t + reach);
            for k in from..to {
                let beside = [k.checked_sub(1), Some(k + 1)].into_iter().flatten();
                let jumps = beside.filter_map(|l| Some((values[k] - values.get(l)?).abs()));
                let jump = jumps.fold(0.0, f64::max);
                differences[k] = differences[k].max(jump / self.safety.differences);
            }
        }
    }
}

/// Returns the output from which on most outputs are lost: two runs whose phases differ by a turn
/// agree for a moment, and at an impact a bar is large for a moment.
fn first_lost(lost: &[bool]) -> Option<usize> {
    let (mut later, mut first) = (0, None);
    for (k, &is_lost) in lost.iter().enumerate().rev() {
        later += usize::from(is_lost);
        if is_lost && later > 1 && 2 * later >= lost.len() - k {
            first = Some(k);
        }
    }
    first
}

/// Replaces differences by their envelope along time; what is not known counts as nothing.
fn envelope(differences: &mut [f64]) {
    let outputs = differences.len() as f64;
    let fall = Scalar::powf(0.5_f64, 1.0 / (HALVING * outputs).max(1.0));
    let mut last = 0.0;
    let mut spread = |d: &mut f64| {
        *d = d.max(last * fall);
        last = *d;
    };
    differences.iter_mut().for_each(&mut spread);
    last = 0.0;
    let mut spread = |d: &mut f64| {
        *d = d.max(last * fall);
        last = *d;
    };
    differences.iter_mut().rev().for_each(&mut spread);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compared(values: &[f64], others: &[f64], shifts: &[Shift]) -> Bars {
        let times: Vec<f64> = (0..values.len()).map(|k| k as f64).collect();
        let partners: Vec<Option<usize>> = (0..values.len())
            .map(|k| (k < others.len()).then_some(k))
            .collect();
        let comparison = Comparison {
            safety: Safety {
                differences: 4.0,
                rounding: 4.0,
            },
            times: &times,
            partners: &partners,
            shifts,
        };
        comparison.bars(values, others, 1.0)
    }

    #[test]
    fn the_companion_takes_half_as_many_steps_again_at_most() {
        for method in METHODS {
            for has_many_events in [false, true] {
                let request = companion_request(1e-6, &[method.name.into()], has_many_events);
                let steps = (1e-6 / request).powf(1.0 / method.order as f64);
                assert!((1.15..1.75).contains(&steps), "{}: {steps}", method.name);
            }
        }
    }

    #[test]
    fn a_bar_does_not_vanish_where_two_runs_cross() {
        let main: Vec<f64> = (0..200).map(|k| f64::from(k).sin()).collect();
        let off = |k: usize| 1e-6 * (0.3 * k as f64).cos();
        let other: Vec<f64> = main.iter().enumerate().map(|(k, y)| y + off(k)).collect();
        let bars = compared(&main, &other, &[]).bars;
        assert!(bars.iter().all(|b| (1e-6..1e-5).contains(b)), "{bars:?}");
    }

    #[test]
    fn bars_fall_where_errors_die_out_and_never_to_zero() {
        let main: Vec<f64> = (0..400).map(|k| (-0.1 * f64::from(k)).exp()).collect();
        let other: Vec<f64> = main.iter().map(|y| y * 1.001).collect();
        let bars = compared(&main, &other, &[]).bars;
        assert!(
            bars[399] < 1e-6 * bars[0] && bars[399] > 0.0,
            "{}",
            bars[399]
        );
        assert!(compared(&main, &main, &[]).bars.iter().all(|&b| b > 1e-15));
    }

    #[test]
    fn an_output_beside_an_uncertain_event_may_lie_on_its_other_side() {
        let main: Vec<f64> = (0..100).map(|k| if k < 50 { 1.0 } else { -1.0 }).collect();
        let shift = Shift {
            t: 49.5,
            shift: 0.2,
        };
        let bars = compared(&main, &main, &[shift]).bars;
        assert!(bars[49] > 1.9 && bars[50] > 1.9, "{:?}", &bars[45..55]);
        assert!(bars[20] < 0.1);
    }

    #[test]
    fn a_lost_phase_is_told_with_its_time() {
        let phase = |k: f64| k * (1.0 + 1e-4 * k);
        let main: Vec<f64> = (0..300).map(|k| f64::from(k).sin()).collect();
        let other: Vec<f64> = (0..300).map(|k| phase(f64::from(k)).sin()).collect();
        let lost = compared(&main, &other, &[]).lost_from;
        assert!(lost.is_some_and(|t| (20.0..150.0).contains(&t)), "{lost:?}");
        assert_eq!(compared(&main, &main, &[]).lost_from, None);
    }

    #[test]
    fn outputs_that_the_companion_did_not_reach_have_no_bar() {
        let main: Vec<f64> = (0..9).map(f64::from).collect();
        let bars = compared(&main, &main[..6], &[]);
        assert!(bars.bars[5] > 0.0 && bars.bars[6].is_nan());
        assert_eq!(bars.lost_from, Some(6.0));
    }
}
