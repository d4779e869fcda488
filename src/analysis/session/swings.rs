//! Swings of a motion that nothing slows down, and whether their phase is still known in the end.
//!
//! Each swing is a little longer or shorter than the true one: by the energy that the solution has
//! lost or won, and by the method's own steps. What it is short of adds up.
//!
//! ```text
//! Δφ = 2π n ( ½ s ΔE/E + (2π n/N)² / 12 )    n swings in N steps, rad
//! s² = Σ Var aⱼ / Σ ⟨aⱼ²⟩                aⱼ: slopes ∂v̇/∂qⱼ and ω ∂v̇/∂vⱼ along it
//! ```
//!
//! Where the slopes stay the same, the time of a swing does not depend on its width, nor on its
//! energy. The second part is that of methods of second order; of the others the energy tells.
//! Damping forgets such errors: nothing is said where more energy was lost to it than there ever
//! was at once, nor where the acceleration falls with the velocity for so long that a push dies
//! away, ∫ ∂v̇/∂v dt < −2, whoever wrote the damping into a function.
//!
//! Unless the swings go on to the end and no force knows the time: such swings excite themselves,
//! as those of van der Pol's equation or of a mass on a belt do. They come back to their width
//! after a push, and keep what it did to their phase:
//!
//! ```text
//! Δφ = ΔE/E + c n R         E: largest kinetic energy, R: request, c: of the method
//! ```
//!
//! Errors that are far from a part of a swing add up, too: in proportion to the request and to the
//! number of swings, nearly alike for trusses, chains and beams.
//!
//! ```text
//! Δ = c n R min(1, f/6)   f freedoms; of methods of second order 2π n c (2π n/N)² / 12
//! n / max(1, δ)           in the place of n where a swing dies away by exp −δ
//! ```
//!
//! No energy tells what a step of BDF, HHT or NEWMARK does to the phase alone (c = 0 for others).
//! Permitted errors of methods are chosen so that errors are in proportion to requests, and so is
//! the error that a swing adds. Where a mass sticks to a belt and slips by a steep law, c is larger
//! for every method: a push that is a part of the permitted error grows while it breaks away, and
//! so decides when it does.

use crate::analysis::system::{Recording, System};
use crate::analysis::trajectory::EnergyFlow;
use crate::numeric::{self, Form};
use crate::scene::layout::Layout;
use std::f64::consts::TAU;
use std::ops::Range;

/// Way back of a velocity, over all of its range so far, that is a reversal.
const REVERSAL: f64 = 0.3;
/// Range of a velocity over the largest range of any below which it is rounding.
const NOISE: f64 = 1e-6;
/// Logarithm of a push over what is left of it that counts as forgotten.
const FORGOTTEN: f64 = 2.0;
/// Standard errors by which a mean slope differs from zero for sure.
const SURE: f64 = 3.0;
/// States at which slopes are evaluated, at most; and to see whether one is steep.
const SAMPLES: usize = 256;
const SAMPLES_OF_STEEP: usize = 20;
/// c: what a swing that excites itself adds to the error of its phase, over the request, rad: of
/// methods of order 2, and of BDF. Measured on van der Pol's equation.
const LATE_OF_ORDER_2: f64 = 2.5;
const LATE_OF_MANY_STEPS: f64 = 1.0;
/// The same of a swing with a steep force, by any method: 0.1 to 100 on 100 masses on belts.
const LATE_OF_STEEP: f64 = 50.0;
/// Slope of an acceleration over its velocity, over the pace of the swings and over its own least,
/// that is steep. Measured: it is 100 in the relaxation oscillations of van der Pol's equation, 10⁴
/// and more on belts; that of a stiff damper is always the same.
const STEEP: f64 = 1e3;
/// Swings since the last reversal up to which a motion still swings.
const STILL_SWINGING: f64 = 2.0;
/// Error that an undamped swing adds to the results, over the request: of methods of many steps,
/// and of one step. Measured on trusses, chains and beams of six freedoms and more: 0.04 to
/// 0.6, and 0.002 to 0.08; with fewer of them it is about as many sixths of that.
const ADDED_BY_MANY_STEPS: f64 = 0.25;
const ADDED_BY_ONE_STEP: f64 = 0.025;
const MANY_FREEDOMS: f64 = 6.0;
/// Error by a method of second order where modes are faster than the swings that are counted, over
/// that of these.
const ADDED_BY_FASTER: f64 = 1.5;
/// Sum of such errors, over the request, from which on it is told.
const TOLD_REQUESTS: f64 = 50.0;
/// Range of a coordinate over its size, and over what is typical of it, in which it stands still:
/// as rounding and the permitted error of a method move it where forces balance.
const STILL_OF_SIZE: f64 = 1e-9;
const STILL_OF_TYPICAL: f64 = 1e-12;
/// Error of the phase from which on it is told, rad.
const TOLD: f64 = 0.5;
/// The same of swings with a steep force: few of them lose hundreds of requests.
const TOLD_OF_STEEP: f64 = 0.05;

/// A velocity: its extremes, the present extreme, and how often it has turned back.
#[derive(Clone, Copy, Debug)]
struct Velocity {
    low: f64,
    high: f64,
    extreme: f64,
    rises: bool,
    reversals: usize,
    /// time of the last reversal, in s
    turned: f64,
}

impl Velocity {
    fn begin(v: f64) -> Self {
        Self {
            low: v,
            high: v,
            extreme: v,
            rises: true,
            reversals: 0,
            turned: f64::NEG_INFINITY,
        }
    }

    fn range(&self) -> f64 {
        self.high - self.low
    }

    fn see(&mut self, t: f64, v: f64) {
        (self.low, self.high) = (self.low.min(v), self.high.max(v));
        let onward = if self.rises {
            v - self.extreme
        } else {
            self.extreme - v
        };
        if onward > 0.0 {
            self.extreme = v;
        } else if -onward > REVERSAL * self.range() {
            (self.extreme, self.rises, self.turned) = (v, !self.rises, t);
            self.reversals += 1;
        }
    }
}

/// The velocities of a simulation, and the ranges of its coordinates, seen at the ends of steps:
/// outputs change nothing.
#[derive(Debug, Default)]
pub(super) struct Swings {
    place: Range<usize>,
    velocities: Vec<Velocity>,
    coordinates: Range<usize>,
    /// least and largest value of each coordinate so far
    ranges: Vec<[f64; 2]>,
    /// time at the beginning and at the last look, in s
    span: [f64; 2],
}

impl Swings {
    /// Begins at a state.
    pub fn begin(layout: &Layout, numbers: &[f64]) -> Self {
        let place = layout.v();
        let first = numbers.get(place.clone()).unwrap_or_default();
        let velocities = first.iter().map(|&v| Velocity::begin(v)).collect();
        let begin = numbers.get(Layout::TIME).copied().unwrap_or_default();
        let coordinates = layout.q();
        let stands = numbers.get(coordinates.clone()).unwrap_or_default();
        Self {
            place,
            velocities,
            ranges: stands.iter().map(|&q| [q; 2]).collect(),
            coordinates,
            span: [begin; 2],
        }
    }

    /// Looks at all numbers of a state.
    pub fn see(&mut self, numbers: &[f64]) {
        let now = numbers.get(self.place.clone()).unwrap_or_default();
        let t = numbers.get(Layout::TIME).copied().unwrap_or_default();
        for (velocity, &v) in self.velocities.iter_mut().zip(now) {
            velocity.see(t, v);
        }
        let stands = numbers.get(self.coordinates.clone()).unwrap_or_default();
        for ([low, high], &q) in self.ranges.iter_mut().zip(stands) {
            (*low, *high) = (low.min(q), high.max(q));
        }
        self.span[1] = t;
    }

    /// Returns whether coordinates have been seen and none has moved by more than rounding and
    /// permitted errors move what is at rest; `typical`: magnitudes of the coordinates.
    pub fn stood_still(&self, typical: &[f64]) -> bool {
        let stands = |([low, high], typical): (&[f64; 2], &f64)| {
            let size = STILL_OF_SIZE * low.abs().max(high.abs());
            high - low <= size.max(STILL_OF_TYPICAL * typical)
        };
        !self.ranges.is_empty() && self.ranges.iter().zip(typical).all(stands)
    }

    /// Returns the largest way of a coordinate, or velocity, over what is typical of it; `typical`:
    /// magnitudes of the coordinates and of the velocities.
    pub fn reach(&self, typical: [&[f64]; 2]) -> f64 {
        let ways = self.ranges.iter().map(|[low, high]| high - low);
        let speeds = self.velocities.iter();
        let speeds = speeds.map(|v| v.low.abs().max(v.high.abs()));
        let of_ways = ways.zip(typical[0]);
        let all = of_ways.chain(speeds.zip(typical[1]));
        all.fold(0.0, |most, (x, typical)| most.max(x / typical))
    }

    /// Returns whether velocity `k`, which has swung so often, swings to the end.
    fn goes_on(&self, (k, swings): (usize, f64)) -> bool {
        let [begin, end] = self.span;
        let period = (end - begin) / swings.max(1.0);
        (self.velocities.get(k)).is_some_and(|v| end - v.turned <= STILL_SWINGING * period)
    }

    /// Iterates over the velocities that are more than rounding, and their places.
    fn moving(&self) -> impl Iterator<Item = (usize, &Velocity)> {
        let widest = self.velocities.iter().map(Velocity::range);
        let least = NOISE * widest.fold(0.0, f64::max);
        let all = self.velocities.iter().enumerate();
        all.filter(move |(_, v)| v.range() > least)
    }

    /// Returns the number of freedoms that move, over many; at most 1.
    fn share_of_many(&self) -> f64 {
        (self.moving().count() as f64 / MANY_FREEDOMS).min(1.0)
    }

    /// Returns which velocity turns back most often, and its number of swings.
    fn most(&self) -> Option<(usize, f64)> {
        let most = self
            .moving()
            .max_by_key(|(k, v)| (v.reversals, std::cmp::Reverse(*k)));
        most.map(|(k, v)| (k, v.reversals as f64 / 2.0))
    }

    /// Returns whether anything moves by more than some error: below it nothing can be told.
    pub fn exceed(&self, error: f64) -> bool {
        self.velocities.iter().any(|v| v.range() > error)
    }

    /// Returns the swings whose phase is not sure after so many steps of a method, and by how much,
    /// rad; `looked` are states of the simulation.
    pub fn unsure(
        &self,
        flow: &EnergyFlow,
        (method, steps, request): (&str, usize, f64),
        (system, looked): (&mut System, &[Vec<f64>]),
    ) -> Option<Unsure> {
        flow.start?;
        let (k, swings) = self.most().filter(|(_, swings)| *swings >= 1.0)?;
        let row = numeric::METHODS.iter().find(|m| m.name == method);
        let per_step = match row {
            Some(row) if row.order == 2 => (TAU * swings / steps.max(1) as f64).powi(2) / 12.0,
            _ => 0.0,
        };
        let of_swing = match row {
            Some(row) if row.order == 2 => LATE_OF_ORDER_2,
            Some(row) if row.form == Form::Dae => LATE_OF_MANY_STEPS,
            // what its steps do shows in the balance of energy
            _ => 0.0,
        };
        let by_energy = 0.5 * flow.imbalance / flow.scale;
        let kept = |of_swing: f64| of_swing * swings * request + flow.imbalance / flow.kinetic;
        let may_be_steep = !system.scene.forces.is_empty() && kept(LATE_OF_STEEP) > TOLD_OF_STEEP;
        let is_off = TAU * swings * (by_energy + per_step) > TOLD || kept(of_swing) > TOLD;
        if !is_off && !may_be_steep {
            return None;
        }
        let every = |samples: usize| looked.len().div_ceil(samples).max(1);
        let (all, few) = (every(SAMPLES), every(SAMPLES_OF_STEEP));
        if !is_off && !Force::along(system, (k, swings), (looked, few)).is_steep {
            return None;
        }
        let force = Force::along(system, (k, swings), (looked, all));
        if -flow.works[1] > flow.kinetic || force.is_damped {
            // what comes back to its width all the same excites itself
            let is_free = force.is_free_of_time && self.goes_on((k, swings));
            let (told, off) = match force.is_steep {
                true => (TOLD_OF_STEEP, kept(LATE_OF_STEEP)),
                false => (TOLD, kept(of_swing)),
            };
            return (off > told && is_free).then_some(Unsure { swings, off });
        }
        let off = TAU * swings * (force.bend * by_energy + per_step);
        (off > TOLD).then_some(Unsure { swings, off })
    }
}

impl Swings {
    /// Returns how far errors of undamped swings have added up after so many steps of a method, if
    /// that is many times the request; `looked` are states of the simulation.
    pub fn added_up(
        &self,
        flow: &EnergyFlow,
        (method, steps, request): (&str, usize, f64),
        (system, looked): (&mut System, &[Vec<f64>]),
    ) -> Option<AddedUp> {
        flow.start?;
        let (k, swings) = self.most().filter(|(_, swings)| *swings >= 1.0)?;
        let row = numeric::METHODS.iter().find(|m| m.name == method)?;
        let requests = match row.form {
            _ if row.order == 2 => {
                let turn = TAU * swings / steps.max(1) as f64;
                ADDED_BY_FASTER * TAU * swings * turn * turn / 12.0 / request
            }
            Form::Dae => ADDED_BY_MANY_STEPS * swings * self.share_of_many(),
            _ => ADDED_BY_ONE_STEP * swings * self.share_of_many(),
        };
        if requests.is_nan() || requests < TOLD_REQUESTS {
            return None;
        }
        let every = looked.len().div_ceil(SAMPLES).max(1);
        let decay = Force::along(system, (k, swings), (looked, every)).decay;
        if decay == 0.0 && -flow.works[1] > flow.kinetic {
            return None;
        }
        // of what was added early damping has left nothing
        let requests = requests / (0.5 * decay).max(1.0);
        (requests >= TOLD_REQUESTS).then_some(AddedUp { swings, requests })
    }
}

/// Undamped swings whose errors have added up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AddedUp {
    /// their number
    pub swings: f64,
    /// about how far off they may be, over their width and the request
    pub requests: f64,
}

/// Swings whose phase is not sure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unsure {
    /// their number
    pub swings: f64,
    /// error of the phase that may have added up, rad
    pub off: f64,
}

/// The acceleration of a velocity along a motion.
struct Force {
    /// part of its slopes over the positions that changes along the motion, 0 … 1
    bend: f64,
    /// logarithm of a push of a velocity over what is left of it in the end; 0: it is not damped
    decay: f64,
    /// whether a push dies away within the time of the motion
    is_damped: bool,
    /// whether it is steep over its velocity at times
    is_steep: bool,
    /// whether no acceleration depends on time in the second half of the motion
    is_free_of_time: bool,
}

impl Force {
    /// Evaluates the acceleration of velocity `k`, which swings so often, at every so manieth of
    /// some states.
    fn along(
        system: &mut System,
        (k, swings): (usize, f64),
        (looked, every): (&[Vec<f64>], usize),
    ) -> Self {
        let layout = system.scene.layout;
        let n = layout.n_y();
        let (mut row_of_rate, mut dfdt) = (vec![0.0; n], vec![0.0; n]);
        let mut recorded = system.slopes_of_rate(layout.v_in_y(k));
        let kept = system.numbers.clone();
        let mut slopes = vec![Sample::default(); n];
        let time = |row: Option<&Vec<f64>>| row.map_or(0.0, |row| row[Layout::TIME]);
        let (begin, end) = (time(looked.first()), time(looked.last()));
        let (mut is_free_of_time, mut own) = (true, [f64::INFINITY, 0.0_f64]);
        for row in looked.iter().step_by(every) {
            system.numbers.copy_from_slice(row);
            if slopes_at(
                system,
                recorded.as_mut(),
                layout.v_in_y(k),
                (&mut row_of_rate, &mut dfdt),
            ) {
                let by_unknowns = slopes.iter_mut().zip(&row_of_rate);
                by_unknowns.for_each(|(s, &a)| s.add(a));
                if let Some(slope) = layout.state(&row_of_rate).v.get(k) {
                    own = [own[0].min(slope.abs()), own[1].max(slope.abs())];
                }
                let in_time = layout.state(&dfdt).v.iter().any(|slope| *slope != 0.0);
                is_free_of_time &= !in_time || row[Layout::TIME] < 0.5 * (begin + end);
            }
        }
        system.numbers.copy_from_slice(&kept);
        let duration = end - begin;
        // a slope over velocities counts as that over positions does at the pace of the swings
        let pace = if duration > 0.0 {
            TAU * swings / duration
        } else {
            0.0
        };
        let slopes = layout.state(&slopes);
        let (mut all, mut varies) = (0.0, 0.0);
        for (block, weight) in [(slopes.q, 1.0), (slopes.v, pace * pace)] {
            for slope in block {
                all += weight * slope.mean_square();
                varies += weight * slope.variance();
            }
        }
        let damping = slopes.v.get(k).copied().unwrap_or_default();
        let is_sure = damping.mean() < -SURE * damping.standard_error();
        let decay = if is_sure {
            -damping.mean() * duration
        } else {
            0.0
        };
        Self {
            bend: if all > 0.0 {
                (varies / all).sqrt()
            } else {
                0.0
            },
            decay,
            is_damped: decay > FORGOTTEN,
            is_steep: pace > 0.0 && own[1] > STEEP * pace.max(own[0]),
            is_free_of_time,
        }
    }
}

/// Evaluates the slopes of rate `i` over all unknowns at the present numbers of a system, and those
/// of all rates over time; false where one has no value. `recorded`: the program of the former.
fn slopes_at(
    system: &mut System,
    recorded: Option<&mut Recording>,
    i: usize,
    (slopes, dfdt): (&mut [f64], &mut [f64]),
) -> bool {
    let Some(recorded) = recorded else {
        let n = slopes.len();
        let mut jacobian = vec![0.0; n * n];
        let found = system.jacobian_once(&mut jacobian, dfdt).is_ok();
        let row = jacobian.iter().skip(i).step_by(n);
        slopes
            .iter_mut()
            .zip(row)
            .for_each(|(slope, &a)| *slope = a);
        return found;
    };
    slopes.copy_from_slice(recorded.run(&system.numbers));
    let finite = |all: &[f64]| all.iter().all(|x| x.is_finite());
    system.rates_by_time(dfdt).is_ok() && finite(slopes) && finite(dfdt)
}

/// Sums over a sample of numbers.
#[derive(Clone, Copy, Debug, Default)]
struct Sample {
    n: f64,
    sum: f64,
    squares: f64,
}

impl Sample {
    fn add(&mut self, x: f64) {
        (self.n, self.sum, self.squares) = (self.n + 1.0, self.sum + x, self.squares + x * x);
    }

    fn mean(&self) -> f64 {
        self.sum / self.n.max(1.0)
    }

    fn mean_square(&self) -> f64 {
        self.squares / self.n.max(1.0)
    }

    fn variance(&self) -> f64 {
        (self.mean_square() - self.mean().powi(2)).max(0.0)
    }

    fn standard_error(&self) -> f64 {
        (self.variance() / (self.n - 1.0).max(1.0)).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn swung(v: impl Fn(f64) -> f64, end: f64) -> Swings {
        let layout = Layout {
            n_v: 1,
            ..Layout::default()
        };
        let row = |t: f64| [t, v(t)];
        let mut swings = Swings::begin(&layout, &row(0.0));
        (1..=(end / 0.1) as usize).for_each(|k| swings.see(&row(0.1 * k as f64)));
        swings
    }

    #[test]
    fn as_many_swings_are_counted_as_there_are() {
        for n in [1.0, 10.0, 100.0] {
            assert!((swung(f64::sin, n * TAU).most().unwrap().1 - n).abs() <= 1.0);
            // of a body that goes round and round, too
            assert!((swung(|t| 5.0 + t.sin(), n * TAU).most().unwrap().1 - n).abs() <= 1.0);
        }
    }

    #[test]
    fn swings_that_died_away_are_not_counted() {
        let n = swung(|t| (-0.1 * t).exp() * t.sin(), 1e4).most().unwrap().1;
        assert!(n < 5.0, "{n}");
        assert_eq!(swung(|t| t, 1e4).most().unwrap().1, 0.0);
    }
}
