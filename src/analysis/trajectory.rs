//! The result of an analysis over time: states at output times, events, and why it ended.

use super::runaway::{Runaway, RunsAway};
use crate::numeric::{Memory, Stats, Stop};
use crate::scene::broken::Broken;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The reason why an analysis ended before the last output time.
#[derive(Clone, Debug, PartialEq)]
pub enum Ended {
    /// the caller asked
    Interrupted,
    /// the method could not go on
    Stop(Stop),
    /// states downstream of the mechanism could not go on
    Downstream {
        /// why
        stop: Stop,
        /// all numbers where they stand
        stands: Vec<f64>,
        /// their rates there   (n_downstream)
        rates: Vec<f64>,
    },
    /// a sensor asked: its place in [`Scene::sensors`](crate::scene::Scene::sensors)
    Sensor(usize),
    /// a contact of curves ends
    Broken {
        /// when
        t: f64,
        /// which, and what to do
        broken: Broken,
    },
    /// the motion grows without bound, in ever shorter steps
    RunsAway(RunsAway),
}

/// The reason why a method works from some time on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takeover {
    /// it is the first one
    Begins,
    /// stability, not accuracy, set the steps of the one before
    Stiff,
    /// branches changed where it was stiff
    Eased,
    /// its steps cost less
    Cheaper,
}

/// A position at which rows become dependent while the mechanism passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// time
    pub t: f64,
    /// rows that depend on others there and not nearby
    pub rows: Vec<String>,
    /// coordinates there: (name, value), those of the loops concerned first
    pub place: Vec<(String, f64)>,
}

/// The name of a method, and what it leaves to one of its kind that goes on.
pub type Left = (String, Arc<Memory>);
/// Kinetic energy, and potential energy in gravity.
pub type Energy = [f64; 2];
/// Powers or works: given back by what stores energy, of damping and friction, of functions, of
/// motions.
pub type Powers = [f64; 4];

/// Energies and works since an integration began.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyFlow {
    /// kinetic and potential energy at the beginning; `None`: not watched
    pub start: Option<Energy>,
    /// the same at the last look
    pub end: Energy,
    /// works: given back by what stores energy, of damping and friction, of functions, of motions
    pub works: Powers,
    /// largest kinetic energy at a look
    pub kinetic: f64,
    /// largest kinetic energy, change of potential energy, or work
    pub scale: f64,
    /// largest error of the balance
    pub imbalance: f64,
}

/// Error of the balance of energy, over all energy, from which on it is told.
pub(in crate::analysis) const TOLD_ENERGY: f64 = 0.2;
/// Roundings of potential energies that a balance may be off by.
const ROUNDINGS: f64 = 4.0;

impl EnergyFlow {
    /// Returns the account of this stretch and one that follows it.
    #[must_use]
    pub(in crate::analysis) fn followed_by(&self, later: &Self) -> Self {
        let mut works = self.works;
        (works.iter_mut().zip(later.works)).for_each(|(work, more)| *work += more);
        let of_works = works.iter().fold(0.0, |m: f64, work| m.max(work.abs()));
        Self {
            start: self.start.or(later.start),
            end: later.end,
            works,
            kinetic: self.kinetic.max(later.kinetic),
            scale: self.scale.max(later.scale).max(of_works),
            imbalance: self.imbalance + later.imbalance,
        }
    }

    /// Returns the account of two systems over the same time.
    #[must_use]
    pub(in crate::analysis) fn beside(&self, other: &Self) -> Self {
        let sum = |[a, b]: Energy, [c, d]: Energy| [a + c, b + d];
        let mut works = self.works;
        (works.iter_mut().zip(other.works)).for_each(|(work, more)| *work += more);
        Self {
            start: self.start.zip(other.start).map(|(a, b)| sum(a, b)),
            end: sum(self.end, other.end),
            works,
            kinetic: self.kinetic + other.kinetic,
            scale: self.scale + other.scale,
            imbalance: self.imbalance + other.imbalance,
        }
    }

    /// Compares the energy with what was put in so far.
    pub(super) fn look(&mut self, energy: Energy) {
        let Some(start) = self.start else {
            return;
        };
        self.end = energy;
        self.kinetic = self.kinetic.max(start[0]).max(energy[0]);
        let put_in: f64 = self.works.iter().sum();
        let change = energy[0] - start[0] + energy[1] - start[1];
        let sizes = [energy[0], start[0], energy[1] - start[1]];
        let sizes = sizes.iter().chain(&self.works);
        self.scale = sizes.fold(self.scale, |m, x| m.max(x.abs()));
        // potential energies far from the origin are known to their rounding only
        let rounding = ROUNDINGS * f64::EPSILON * (start[1].abs() + energy[1].abs());
        let imbalance = match (change - put_in).abs() {
            off if off <= rounding => 0.0,
            off => off,
        };
        if imbalance > self.imbalance || imbalance.is_nan() {
            self.imbalance = imbalance;
        }
    }
}

/// Share of the steps from which on what ended or shortened them is what sets their number, and not
/// the request.
pub(in crate::analysis) const SETS_STEPS: f64 = 0.25;

/// Accepted steps that ended where they did for another reason than the permitted error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Limited {
    /// at a change of a branch, a sample, a time event, or short of what might be passed unseen
    pub events: usize,
    /// at an output time at which the method had no value otherwise
    pub outputs: usize,
}

/// States at the output times that were reached.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// output times reached
    pub t: Vec<f64>,
    /// all numbers (t | q | v | x | turns) at each but the first [`Self::released`]
    pub rows: Vec<Vec<f64>>,
    /// states at the beginning that have become results and are no longer held
    pub released: usize,
    /// rows at which the motion stays where functions change branch: the numbers on each of the
    /// branches, and its part in the mean
    pub means: BTreeMap<usize, Vec<(f64, Vec<f64>)>>,
    /// what it cost
    pub stats: Stats,
    /// the same in operations, about
    pub operations: f64,
    /// the method that worked last for the states downstream of the mechanism, and how many steps
    /// they took; `None`: there are none
    pub downstream: Option<(&'static str, usize)>,
    /// the methods that worked, in order, with the time at which each took over, and why; trials in
    /// vain are not among them
    pub methods: Vec<(f64, String, Takeover)>,
    /// number of switches that were located
    pub events: usize,
    /// times at which the method began anew, in s
    pub event_times: Vec<f64>,
    /// sensors that were triggered: when, and their places in the scene
    pub triggered: Vec<(f64, usize)>,
    /// states (all numbers) about positions where rows are nearly dependent; `None` separates what
    /// does not follow on
    pub weak: Vec<Option<Vec<f64>>>,
    /// positions at which rows become dependent that were found apart from these
    pub passes: Vec<Pass>,
    /// choices of rows after the first: the row of results from which each holds, when it was made,
    /// and which rows take part
    pub selections: Vec<(usize, f64, Vec<bool>)>,
    /// rows that were left out and no longer followed from the others: when each was restored, and
    /// its index
    pub restored: Vec<(f64, usize)>,
    /// rows left out within tolerance that went beyond it: when each was farthest off, its index,
    /// and its value
    pub beyond: Vec<(f64, usize, f64)>,
    /// end and length of the last step that was kept
    pub last_step: Option<(f64, f64)>,
    /// the method that worked at the end, and what it leaves to one of its kind
    pub left: Option<Left>,
    /// where energy came from and where it went
    pub energy: EnergyFlow,
    /// how it grows
    pub(in crate::analysis) runaway: Runaway,
    /// steps that something else than the permitted error ended
    pub limited: Limited,
    /// `None`: all output times were reached, or mechanisms are to go on apart
    pub ended: Option<Ended>,
    /// all numbers where mechanisms that nothing couples are to go on each by itself
    pub parted: Option<Vec<f64>>,
}

impl Trajectory {
    /// Adds a state.
    pub(in crate::analysis) fn push(&mut self, t: f64, row: Vec<f64>) {
        self.t.push(t);
        self.rows.push(row);
    }

    /// Drops the states up to an index, but never the last.
    pub fn release(&mut self, until: usize) {
        let until = until.min(self.t.len().saturating_sub(1));
        self.rows.drain(..until.saturating_sub(self.released));
        self.released = self.released.max(until);
        self.means = self.means.split_off(&until);
    }

    /// Notes that a row left out within tolerance is off by more.
    pub(in crate::analysis) fn note_beyond(&mut self, t: f64, (row, value): (usize, f64)) {
        match self.beyond.iter_mut().find(|b| b.1 == row) {
            Some(known) if known.2.abs() < value.abs() => (known.0, known.2) = (t, value),
            Some(_) => {}
            None => self.beyond.push((t, row, value)),
        }
    }

    /// Returns whether the last state is earlier than `t`, or there is none.
    pub(in crate::analysis) fn ends_before(&self, t: f64) -> bool {
        self.t.last().is_none_or(|&last| last < t)
    }

    /// Forgets that the last method worked: it was tried in vain.
    pub(in crate::analysis) fn forget_method(&mut self) {
        self.methods.pop();
    }

    /// Notes that a method works from `t` on, unless it did so far.
    pub(in crate::analysis) fn begin_method(&mut self, t: f64, name: &str, why: Takeover) {
        if self.methods.last().is_none_or(|m| m.1 != name) {
            self.methods.push((t, name.to_string(), why));
        }
    }

    /// Adds the cost of a method.
    pub(in crate::analysis) fn add_cost(&mut self, more: &Stats) {
        let sum = &mut self.stats;
        sum.steps += more.steps;
        sum.rejected += more.rejected;
        sum.evaluations += more.evaluations;
        sum.jacobians += more.jacobians;
        sum.factorizations += more.factorizations;
        sum.newton_iterations += more.newton_iterations;
        sum.algebra += more.algebra;
        sum.below_rounding += more.below_rounding;
        sum.at_edge += more.at_edge;
        sum.stability_limited += more.stability_limited;
    }
}
