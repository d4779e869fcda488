//! The companion of a session: the same simulations at another request, and the bars of error that
//! the difference of the two gives.

use super::kept::Starts;
use super::simulate::Span;
use super::sizes::Sizes;
use super::{Accuracy, Session};
use crate::analysis::accuracy::{
    Bars, Comparison, LEAST_SIZE, SHORTER_STEPS, TIGHTER_REST, companion_request, partners, safety,
    shifts,
};
use crate::analysis::trajectory::{SETS_STEPS, Trajectory};
use crate::analysis::warning::RunWarning;
use crate::diagnostic::Error;
use crate::results::{ChannelAccuracy, Kind, Run, Status};
use std::ops::Range;

/// Events over steps from which on few steps lie between two of them, and their number hardly
/// follows the request.
const EVENTS_OVER_STEPS: f64 = 0.03;

/// The pace of a companion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    /// factor of steps that are given
    pub steps: f64,
    /// longest step, in s
    longest: f64,
    /// factor of the tolerances of equilibria
    pub rest: f64,
    /// whether nothing but the columns is asked for: no account of energy, no drift of rows
    pub columns_alone: bool,
}

impl Default for Pace {
    fn default() -> Self {
        Pace {
            steps: 1.0,
            longest: f64::INFINITY,
            rest: 1.0,
            columns_alone: false,
        }
    }
}

impl Pace {
    /// Returns that of an integration beside another, for its columns alone.
    pub(super) fn beside() -> Self {
        Self {
            columns_alone: true,
            ..Self::default()
        }
    }

    /// Returns the same with shorter steps where something else than the request sets them.
    pub(super) fn shorter(last: &Integrated) -> Self {
        Self {
            steps: SHORTER_STEPS,
            longest: (last.unasked_step).map_or(f64::INFINITY, |h| SHORTER_STEPS * h),
            rest: TIGHTER_REST,
            ..Self::beside()
        }
    }

    /// Returns the same with steps that are shorter than some step.
    pub(super) fn at_most(self, step: f64) -> Self {
        Self {
            longest: self.longest.min(SHORTER_STEPS * step),
            ..self
        }
    }

    /// Returns the longest step where that of the model is given.
    pub(super) fn longest_step(&self, given: f64) -> f64 {
        (given * self.steps).min(self.longest)
    }
}

/// The facts about a simulation over time that its companion is compared with.
#[derive(Clone, Debug, Default)]
pub(super) struct Integrated {
    /// names of the methods that worked
    methods: Vec<String>,
    /// request
    error: Option<f64>,
    /// times of events, in s
    events: Vec<f64>,
    /// whether few steps lie between two events
    has_many_events: bool,
    /// mean step, in s, where events or the way of a drive set the steps, and not the request
    unasked_step: Option<f64>,
    /// the length of the scene
    length: f64,
}

impl Integrated {
    /// Takes them from a trajectory.
    pub(super) fn of(
        kind: Kind,
        trajectory: &Trajectory,
        (error, length): (f64, f64),
        span: Span,
    ) -> Self {
        let steps = trajectory.stats.steps as f64;
        let duration = trajectory.t.last().map_or(0.0, |t| t - span.start);
        let at_events = trajectory.limited.events as f64 > SETS_STEPS * steps;
        let is_driven = kind == Kind::Kinematic;
        Integrated {
            methods: trajectory.methods.iter().map(|m| m.1.clone()).collect(),
            error: Some(error),
            events: trajectory.event_times.clone(),
            has_many_events: trajectory.event_times.len() as f64 > EVENTS_OVER_STEPS * steps,
            unasked_step: ((at_events || is_driven) && steps > 0.0).then(|| duration / steps),
            length,
        }
    }
}

impl Integrated {
    /// Returns the request, of what a method has integrated.
    pub(super) fn error(&self) -> Option<f64> {
        self.error
    }

    /// Returns the length of the scene.
    pub(super) fn length(&self) -> f64 {
        self.length
    }

    /// Returns the names of the methods that worked.
    pub(super) fn methods(&self) -> &[String] {
        &self.methods
    }

    /// Returns whether few steps lie between two events.
    pub(super) fn has_many_events(&self) -> bool {
        self.has_many_events
    }

    /// Returns whether something else than the request sets the steps.
    pub(super) fn has_steps_unasked(&self) -> bool {
        self.unasked_step.is_some()
    }
}

/// Numbers of sequences of both runs before a simulation.
pub(super) struct Begun {
    own: usize,
    companion: usize,
}

impl Session {
    /// Returns a companion that begins where the session is.
    fn new_companion(&self) -> Box<Session> {
        let mut options = self.options.clone();
        (options.accuracy, options.repeat) = (Accuracy::Unknown, 1);
        let mut companion = Session::new(self.model.clone(), &self.run.name, options);
        companion.hooks.clone_from(&self.hooks);
        companion.carried.clone_from(&self.carried);
        if let Some(carried) = &mut companion.carried {
            // at another request
            carried.left = None;
        }
        companion.folders.clone_from(&self.folders);
        companion.limit = self.limit;
        if !companion.hooks.is_empty() && companion.carried.is_none() {
            companion.choose_columns();
        }
        Box::new(companion)
    }

    /// Brings the companion to where the session is, before both simulate.
    pub(super) fn begin_companion(&mut self) -> Begun {
        let own = self.run.sequences.len();
        if self.strayed {
            return Begun { own, companion: 0 };
        }
        let mut companion = (self.companion.take()).unwrap_or_else(|| self.new_companion());
        companion.model.clone_from(&self.model);
        companion.changing.clone_from(&self.changing);
        let companion_begun = companion.run.sequences.len();
        self.companion = Some(companion);
        Begun {
            own,
            companion: companion_begun,
        }
    }

    /// Runs the companion after the session, and compares.
    pub(super) fn follow(
        &mut self,
        begun: Begun,
        mut simulate: impl FnMut(&mut Session) -> Result<Status, Error>,
    ) {
        let Some(mut companion) = self.companion.take() else {
            return;
        };
        let asked = self.last.error.unwrap_or_else(|| self.integration().error);
        let mut request = companion_request(asked, &self.last.methods, self.last.has_many_events);
        let is_first = companion.carried.is_none();
        self.set_pace(&mut companion, request);
        let mut follows = simulate(&mut companion) == Ok(self.run.record.status);
        if !follows && is_first && self.last.error.is_some() {
            // it stopped where the run came through: one at a larger request, whose difference is
            // larger than the error
            let mut other = self.new_companion();
            other.carried = None;
            other.changing.clone_from(&self.changing);
            other.starts = std::mem::take(&mut companion.starts);
            let larger = asked * (asked / request);
            self.set_pace(&mut other, larger);
            if simulate(&mut other) == Ok(self.run.record.status) {
                (companion, request, follows) = (other, larger, true);
            }
        }
        companion.starts = Starts::default();
        if !follows {
            self.warn(RunWarning::CompanionEnded { request });
        }
        if self.run.record.accuracy.is_none() {
            self.run.add_bars();
        }
        let accuracy = self.run.record.accuracy.get_or_insert_default();
        if self.last.error.is_some() {
            accuracy.companions.push(request);
        }
        let run = &self.run;
        let columns = run.columns.iter().skip(1).filter(|c| c.bar_of.is_none());
        let columns = columns.map(|c| (c.unit.as_str(), c.values.as_slice()));
        let sizes = Sizes::of(columns, &run.units, self.last.length);
        let own = begun.own..self.run.sequences.len();
        for (own, other) in own.zip(begun.companion..) {
            let rows = self.run.sequences[own].rows.clone();
            let others = companion.run.sequences.get(other);
            let others = others.map_or(0..0, |s| s.rows.clone());
            self.compare(&companion, rows, others, &sizes);
        }
        self.warn_of_errors();
        // one that ended otherwise would begin the next simulation elsewhere, and another one that
        // begins where this session is would know nothing of the errors so far
        self.strayed = !follows;
        self.companion = follows.then_some(companion);
    }

    /// Sets how a companion differs from the session.
    fn set_pace(&self, companion: &mut Session, request: f64) {
        companion.options.error = Some(request);
        companion.pace = Pace::shorter(&self.last);
        if companion.carried.is_none() {
            // both begin in the same configuration
            companion.columns_program.clone_from(&self.columns_program);
        }
    }

    /// Fills in the bars of the rows of a sequence.
    fn compare(
        &mut self,
        companion: &Session,
        rows: Range<usize>,
        others: Range<usize>,
        sizes: &Sizes,
    ) {
        let values = |run: &Run, column: usize, rows: &Range<usize>| -> Vec<f64> {
            let column = run.columns.get(column).map(|c| c.values.get(rows.clone()));
            column.flatten().unwrap_or_default().to_vec()
        };
        let times = values(&self.run, 0, &rows);
        let partners = partners(&times, &values(&companion.run, 0, &others));
        let shifts = shifts(&self.last.events, &companion.last.events);
        let comparison = Comparison {
            safety: safety(&self.last.methods),
            times: &times,
            partners: &partners,
            shifts: &shifts,
        };
        for bar in 0..self.run.columns.len() {
            let Some(of) = self.run.columns[bar].bar_of else {
                continue;
            };
            let own = values(&self.run, of, &rows);
            let other = values(&companion.run, of, &others);
            let of_unit = sizes.get(&self.run.columns[of].unit);
            let found = comparison.bars(&own, &other, of_unit);
            let least = LEAST_SIZE * of_unit;
            let column = &mut self.run.columns[bar];
            if let Some(place) = column.values.get_mut(rows.clone()) {
                place.copy_from_slice(&found.bars);
            }
            self.note_channel([of, bar], least, found);
        }
    }

    /// Notes the largest and the usual bar of a channel, and when it is lost, if tables show it;
    /// relative to the largest value of the channel, or to `least` if that is more.
    fn note_channel(&mut self, [of, bar]: [usize; 2], least: f64, found: Bars) {
        let Bars { bars, lost_from } = found;
        let record = &mut self.run.record;
        if !self.run.table.contains(&of) || bars.iter().all(|b| b.is_nan()) {
            return;
        }
        let accuracy = record.accuracy.get_or_insert_default();
        let column = &self.run.columns[of];
        // over all simulations so far
        let bars = &self.run.columns[bar].values;
        let largest = column.values.iter().fold(least, |m, x| m.max(x.abs()));
        let known = (accuracy.channels.iter()).position(|c| c.channel == column.name);
        let mut channel = ChannelAccuracy {
            channel: column.name.clone(),
            unit: column.unit.clone(),
            lost_from: known.and_then(|k| accuracy.channels[k].lost_from),
            ..ChannelAccuracy::default()
        };
        channel.see(bars, largest, lost_from);
        match known {
            Some(k) => accuracy.channels[k] = channel,
            None => accuracy.channels.push(channel),
        }
    }
}
