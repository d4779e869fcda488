//! The error of an integration, measured by a second one at another request.
//!
//! The second one begins at the same state of the same system, at a larger request, so that it
//! takes six tenths of the steps. Errors follow requests:
//!
//! ```text
//! L = 2^(¾ p)                   request of the second one over that of the first, p: order
//! e = s |y − y'| / L^0.85
//! ```
//!
//! (in proportion it would be L − 1; measured on the references, with the factor s of bars of
//! error, 99 of 100 channels hold.)
//! That holds as long as both are near the same solution. Where they are not (an orbit whose phase
//! is lost, a body that has bounced elsewhere), and where something else than the request sets the
//! steps (HMAX, events), the second one has shorter steps instead, as that of `--accuracy` has.
//!
//! Both are compared at outputs, [`MOST`] at most. What the second one was off by at the end of a
//! simulation stays with it in the next one: errors of a run add up over its simulations.

use super::companion::Pace;
use super::phase::Phase;
use super::simulate::Span;
use super::sizes::{Sizes, largest};
use super::{Accuracy, Session};
use crate::analysis::accuracy::{
    Comparison, FEWEST_OUTPUTS, LEAST_SIZE, Safety, companion_request, looser_request, safety,
};
use crate::analysis::system::System;
use crate::analysis::time::options::Options;
use crate::analysis::trajectory::{Ended, SETS_STEPS, Trajectory};
use crate::analysis::warning::RunWarning;
use crate::analysis::watch::Watch;
use crate::expr::program::Program;
use crate::numeric::Stats;
use crate::results::{ChannelAccuracy, Column, Kind, Run, USUAL_SHARE};
use crate::scalar::Scalar;
use crate::scene::layout::State;
use crate::scene::unknown::UnknownId;
use std::collections::BTreeMap;

/// Outputs at which two integrations are compared, at most.
const MOST: usize = 512;
/// Power of the request that errors follow at least.
const FOLLOWS: f64 = 0.85;
/// Difference of two integrations over the range of a channel up to which it tells the error of the
/// better one.
const NEAR: f64 = 0.1;
/// Change of the number of steps up to which two integrations have the same steps.
const ALIKE: f64 = 0.1;
/// Steps of a further integration over those of the run, at most.
const MOST_STEPS: usize = 4;
/// Error over the request from which on it is told that errors have added up.
const TOLD_REQUESTS: f64 = 50.0;
/// The same over the largest value of a channel: less is not seen in a curve.
const TOLD_OF_SIZE: f64 = 1e-3;

/// The values that tables show at some outputs.
#[derive(Clone, Debug, Default)]
pub(super) struct Sampled {
    /// the outputs that are wanted, in s, and how many of them have passed
    wanted: Vec<f64>,
    passed: usize,
    /// those that are there
    times: Vec<f64>,
    /// the columns that tables show
    columns: Vec<usize>,
    /// their values, one list for each
    values: Vec<Vec<f64>>,
}

impl Sampled {
    /// Wants some of the outputs of a run, among them the last.
    pub fn of(run: &Run, outputs: &[f64]) -> Self {
        let every = outputs.len().div_ceil(MOST).max(1);
        let mut wanted: Vec<f64> = (outputs.iter().rev().step_by(every)).copied().collect();
        wanted.reverse();
        let columns = run.table_columns().into_iter().filter(|&k| k > 0);
        let columns: Vec<usize> = columns.collect();
        Self {
            wanted,
            passed: 0,
            times: Vec::new(),
            values: vec![Vec::new(); columns.len()],
            columns,
        }
    }

    /// Returns how large each column is by its unit; `length`: that of the scene.
    fn sizes(&self, run: &Run, length: f64) -> Vec<f64> {
        let units = self.columns.iter().map(|&k| run.columns[k].unit.as_str());
        let values = self.values.iter().map(Vec::as_slice);
        let sizes = Sizes::of(units.clone().zip(values), &run.units, length);
        units.map(|unit| sizes.get(unit)).collect()
    }

    /// Takes what it wants of the last `n` rows that a run holds.
    pub fn take(&mut self, run: &Run, n: usize) {
        let n_held = run.held().len();
        for place in n_held.saturating_sub(n)..n_held {
            let t = run.value(0, place);
            while self.wanted.get(self.passed).is_some_and(|w| *w < t) {
                self.passed += 1;
            }
            if self.wanted.get(self.passed) != Some(&t) {
                continue;
            }
            self.passed += 1;
            self.times.push(t);
            for (values, &column) in self.values.iter_mut().zip(&self.columns) {
                values.push(run.value(column, place));
            }
        }
    }
}

/// Where a further integration is at the end of a simulation, beside the run.
#[derive(Clone, Debug)]
pub(super) struct Beside {
    /// all numbers of the run there
    of: Vec<f64>,
    /// the differences of its states
    differences: BTreeMap<UnknownId, f64>,
}

impl Beside {
    /// Notes what the states at the end of two integrations differ by.
    fn between(system: &System, own: &[f64], other: &[f64]) -> Self {
        let State { q, v, x } = &system.scene.unknowns;
        let ids = q.iter().chain(v).chain(x).copied();
        let places = system.scene.layout.states();
        let differences = places.map(|k| other[k] - own[k]);
        Self {
            differences: ids.zip(differences).collect(),
            of: own.to_vec(),
        }
    }

    /// Moves the state of a system by these differences.
    fn apply(&self, system: &mut System) {
        let places = system.scene.layout.states();
        let State { q, v, x } = &system.scene.unknowns;
        let ids = q.iter().chain(v).chain(x);
        for (number, id) in system.numbers[places].iter_mut().zip(ids) {
            *number += self.differences.get(id).copied().unwrap_or(0.0);
        }
    }
}

/// A simulation over time of which the error is measured.
pub(super) struct Measured<'a> {
    pub kind: Kind,
    pub span: Span,
    /// program of the columns at the beginning
    pub program: &'a Program,
    pub settings: &'a Options,
    pub sampled: &'a Sampled,
    pub trajectory: &'a Trajectory,
    /// where the further integration begins, beside the run
    pub before: Option<&'a Beside>,
}

/// A further integration.
struct Other {
    request: f64,
    steps: usize,
    sampled: Sampled,
    beside: Option<Beside>,
}

/// Asks whether to stop, and tells that it measures.
struct Quiet<'a>(&'a mut dyn Watch);
impl Watch for Quiet<'_> {
    fn interrupted(&mut self) -> bool {
        self.0.interrupted()
    }
    fn progress(&mut self, t: f64, _h: f64, stats: &Stats) {
        self.0.measures(t, stats);
    }
}

impl Session {
    /// Returns whether the error of a simulation over time is to be measured: what motions alone
    /// move is integrated by nothing.
    pub(super) fn measures(&self, kind: Kind) -> bool {
        self.options.accuracy == Accuracy::Digits && kind == Kind::Dynamic
    }

    /// Takes what the last simulation was off by, if the next one begins where it has ended.
    pub(super) fn beside_now(&mut self) -> Option<Beside> {
        let carried = self.carried.as_ref();
        let goes_on = |beside: &Beside| carried.is_some_and(|c| c.numbers == beside.of);
        self.beside.take().filter(goes_on)
    }

    /// Measures how far off a simulation is whose results are there, and notes it in the record;
    /// returns the error of the column that is farthest off, over its size, if it is known.
    /// `start`: the system as it was at the beginning.
    pub(super) fn measure(
        &mut self,
        start: &System,
        measured: &Measured<'_>,
        watch: &mut dyn Watch,
    ) -> Option<f64> {
        let phase = Phase::begin();
        let mut off = None;
        let asked = measured.settings.error;
        let mut found = None;
        let length = self.last.length();
        let sizes = measured.sampled.sizes(&self.run, length);
        for (request, pace) in self.paces_beside(measured) {
            let mut system = start.clone();
            if let Some(before) = measured.before {
                before.apply(&mut system);
            }
            let other = self.integrate_beside(system, measured, (request, pace), watch);
            if watch.interrupted() {
                break;
            }
            let near =
                |o: &Other| o.request < asked || are_near(measured.sampled, &o.sampled, &sizes);
            let other = other.filter(near);
            let differs = (other.as_ref()).is_some_and(|o| differ(measured.trajectory, o));
            found = other.or(found);
            if differs {
                break;
            }
        }
        match found {
            Some(other) => {
                self.note_measured(measured, &other);
                off = self.warn_of_errors();
                self.beside = other.beside;
            }
            None if watch.interrupted() => {}
            None => {
                let (methods, many) = (self.last.methods(), self.last.has_many_events());
                let request = companion_request(asked, methods, many);
                self.warn(RunWarning::CompanionEnded { request });
            }
        }
        let (own, translation) = phase.elapsed();
        self.run.record.seconds.accuracy += own + translation;
        off
    }

    /// Returns the requests at which to integrate once more, and how: the first that tells the
    /// error is enough.
    fn paces_beside(&self, measured: &Measured<'_>) -> Vec<(f64, Pace)> {
        let (asked, methods) = (measured.settings.error, self.last.methods());
        let follows = measured.settings.h_max.is_infinite() && !self.last.has_steps_unasked();
        let smaller = companion_request(asked, methods, self.last.has_many_events());
        let mut all = Vec::new();
        if let Some(larger) = looser_request(asked, methods).filter(|_| follows) {
            all.push((larger, Pace::beside()));
        }
        let shorter = Pace::shorter(&self.last);
        let duration = measured
            .trajectory
            .t
            .last()
            .map_or(0.0, |t| t - measured.span.start);
        let mean = duration / measured.trajectory.stats.steps.max(1) as f64;
        all.extend([(smaller, shorter), (smaller, shorter.at_most(mean))]);
        all
    }

    /// Integrates once more, at another request; `None`: it came to another end.
    fn integrate_beside(
        &mut self,
        mut system: System,
        measured: &Measured<'_>,
        (request, pace): (f64, Pace),
        watch: &mut dyn Watch,
    ) -> Option<Other> {
        let trajectory = measured.trajectory;
        // some hundred steps more are nothing in a short run
        let attempted = trajectory.stats.steps + trajectory.stats.rejected;
        let settings = &Options {
            error: request,
            h_initial: measured.settings.h_initial.map(|h| h * pace.steps),
            h_max: pace.longest_step(measured.settings.h_max),
            left: None,
            max_steps: (measured.settings.max_steps).min(MOST_STEPS * attempted.max(MOST)),
            ..measured.settings.clone()
        };
        // the results are left alone
        let own = (
            std::mem::take(&mut self.run),
            std::mem::replace(&mut self.pace, pace),
            std::mem::take(&mut self.gaps),
            self.receiver.take(),
            self.options.error.replace(request),
        );
        self.run.columns = own.0.columns.iter().map(Column::empty).collect();
        self.run.table.clone_from(&own.0.table);
        let span = measured.span;
        let mut seen = self.begin_rows(measured.kind, measured.program, (&system, span.end));
        // beside a run that has failed as far as that came
        let is_sensor = |ended: &Option<Ended>| matches!(ended, Some(Ended::Sensor(_)));
        let failed = trajectory.ended.is_some() && !is_sensor(&trajectory.ended);
        let outputs = match failed {
            true => &measured.sampled.times,
            false => &measured.sampled.wanted,
        };
        let outputs = &with_places_between(outputs, span.start);
        let mut sampled = Sampled::of(&self.run, outputs);
        let (mut other, _) = self.integrated(
            (&mut system, None),
            (span.start, outputs),
            settings,
            (&mut seen, &mut Quiet(watch), false),
        );
        let until = other.t.len();
        self.see(&mut seen, &system, &mut other, until);
        sampled.take(&self.run, until);
        (
            self.run,
            self.pace,
            self.gaps,
            self.receiver,
            self.options.error,
        ) = own;
        let alike = is_sensor(&other.ended) == is_sensor(&measured.trajectory.ended);
        if !failed && !(alike && (other.ended.is_none() || is_sensor(&other.ended))) {
            return None;
        }
        let ends = measured.trajectory.rows.last().zip(other.rows.last());
        Some(Other {
            request,
            beside: ends.map(|(own, other)| Beside::between(&system, own, other)),
            steps: other.stats.steps,
            sampled,
        })
    }

    /// Notes in the record what the difference to a further integration says.
    fn note_measured(&mut self, measured: &Measured<'_>, other: &Other) {
        let asked = measured.settings.error;
        let of_method = safety(self.last.methods());
        // the further integration is off by so many times the error of the run
        let differs = Scalar::powf((other.request / asked).max(1.0), FOLLOWS);
        let pairs = pairs(&measured.sampled.times, &other.sampled.times);
        let times: Vec<f64> = pairs
            .iter()
            .map(|[k, _]| measured.sampled.times[*k])
            .collect();
        let partners: Vec<Option<usize>> = (0..times.len()).map(Some).collect();
        let comparison = Comparison {
            safety: Safety {
                differences: of_method.differences / differs,
                ..of_method
            },
            times: &times,
            partners: &partners,
            // an output between an event of the one and that of the other differs by itself
            shifts: &[],
        };
        let (sampled, length) = (measured.sampled, self.last.length());
        let sizes = sampled.sizes(&self.run, length).into_iter();
        let sizes = sizes.zip(other.sampled.sizes(&self.run, length));
        let accuracy = self.run.record.accuracy.get_or_insert_default();
        accuracy.companions.push(other.request);
        let columns = sampled.columns.iter().map(|&k| &self.run.columns[k]);
        let places = accuracy.places(columns);
        let both = sampled.values.iter().zip(&other.sampled.values);
        for ((place, (own, others)), (of_unit, of_others)) in
            places.into_iter().zip(both).zip(sizes)
        {
            let (of_unit, of_all) = (of_unit.max(of_others), largest(own).max(largest(others)));
            let own: Vec<f64> = pairs.iter().map(|[k, _]| own[*k]).collect();
            let others: Vec<f64> = pairs.iter().map(|[_, k]| others[*k]).collect();
            let found = comparison.bars(&own, &others, of_unit);
            let channel = &mut accuracy.channels[place];
            let size = of_all.max(LEAST_SIZE * of_unit);
            channel.see(&found.bars, size, found.lost_from);
        }
    }

    /// Warns where errors have added up, as has been measured; returns the error of the column that
    /// is farthest off, over its size, if anything has been integrated.
    pub(super) fn warn_of_errors(&mut self) -> Option<f64> {
        let asked = self.last.error()?;
        let of_method = safety(self.last.methods()).differences;
        let channels = &self.run.record.accuracy.as_ref()?.channels;
        let told = |c: &&ChannelAccuracy| {
            let off = c.usual / of_method;
            c.lost_from.is_some() || off > TOLD_OF_SIZE.max(TOLD_REQUESTS * asked)
        };
        let by_size = |a: &&ChannelAccuracy, b: &&ChannelAccuracy| a.usual.total_cmp(&b.usual);
        let worst = channels.iter().max_by(by_size)?.usual / of_method;
        if let Some(channel) = channels.iter().filter(told).max_by(by_size).cloned() {
            self.warn(RunWarning::ErrorsAddUp {
                requests: channel.usual / of_method / asked,
                channel,
            });
        }
        Some(worst)
    }
}

/// Returns outputs, and places between them where they are few: else nobody knows how large that is
/// which is small at each of them.
fn with_places_between(outputs: &[f64], start: f64) -> Vec<f64> {
    let mut all = outputs.to_vec();
    if let Some(&end) = outputs.last()
        && outputs.len() < FEWEST_OUTPUTS
    {
        let place = |k: usize| start + (end - start) * k as f64 / FEWEST_OUTPUTS as f64;
        all.extend((1..FEWEST_OUTPUTS).map(place));
        all.sort_unstable_by(f64::total_cmp);
        all.dedup();
    }
    all
}

/// Returns whether the steps of two integrations differ, so that their difference tells an error:
/// where both make them as long as they can, both are off alike. An explicit method whose steps
/// stability limits is better than its request, and below rounding no step is.
fn differ(own: &Trajectory, other: &Other) -> bool {
    let limited = own.stats.stability_limited + own.stats.below_rounding;
    let limited = limited as f64 > SETS_STEPS * own.stats.steps as f64;
    let ratio = other.steps as f64 / own.stats.steps.max(1) as f64;
    limited || (ratio - 1.0).abs() > ALIKE
}

/// Returns whether two integrations are near the same solution: in most outputs of each column they
/// differ by a small part of its range; `sizes`: of all columns of its unit.
fn are_near(own: &Sampled, other: &Sampled, sizes: &[f64]) -> bool {
    let pairs = pairs(&own.times, &other.times);
    let near = |((own, other), size): ((&Vec<f64>, &Vec<f64>), &f64)| {
        let finite = own.iter().chain(other.iter()).filter(|x| x.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(*x), high.max(*x))
        });
        let least = NEAR * (high - low).max(LEAST_SIZE * size);
        let is_far = |[k, l]: &&[usize; 2]| (own[*k] - other[*l]).abs() > least;
        let far = pairs.iter().filter(is_far).count();
        far as f64 <= (1.0 - USUAL_SHARE) * pairs.len() as f64
    };
    let both = own.values.iter().zip(&other.values);
    both.zip(sizes).all(near)
}

/// Returns the places in two ascending lists of the times that both have.
fn pairs(times: &[f64], others: &[f64]) -> Vec<[usize; 2]> {
    let place = |t: &f64| others.binary_search_by(|other| other.total_cmp(t)).ok();
    let all = times.iter().enumerate();
    all.filter_map(|(k, t)| Some([k, place(t)?])).collect()
}
