//! Rows on their way from an analysis into the results: their columns are evaluated, everything
//! that is told about all rows sees them, and then nobody needs their states.
//!
//! Where the rows of results are received while a simulation goes on ([`Session::receive`]), this
//! happens some rows at a time. The groups change nothing: each row is seen once, in order, by sums
//! and maxima that do not know where a group ends.

use super::growth::Looks;
use super::measured::Sampled;
use super::phase::Phase;
use super::ranges::Ranges;
use super::spline_range::Readings;
use super::tilts::Tilts;
use super::{Accuracy, Session, columns};
use crate::analysis::system::System;
use crate::analysis::trajectory::Trajectory;
use crate::analysis::warning::RunWarning;
use crate::analysis::watch::Watch;
use crate::clock::Wait;
use crate::expr::program::{Program, Work};
use crate::numeric::Stats;
use crate::results::{Kind, Run};
use std::collections::BTreeSet;
use std::time::Duration;

/// States that are held, at least, before they become rows of results.
const ROWS_AT_ONCE: usize = 1024;
/// Time after which they do so however few they are.
const LONGEST_WAIT: Duration = Duration::from_secs(1);

/// Takes the rows of a run as they come, and may release them.
pub type Receiver = Box<dyn FnMut(&mut Run) + Send>;

/// Everything that has seen the rows of a simulation over time so far.
pub(super) struct Seen {
    /// the program of the columns for the next rows
    program: Program,
    /// rows of constraints that took part at the beginning
    active: Vec<bool>,
    /// choices of rows that it has followed
    selections: usize,
    /// rows seen
    rows: usize,
    pub balance: Balance,
    pub looks: Looks,
    pub ranges: Ranges,
    pub readings: Readings,
    pub tilts: Tilts,
    /// what another integration is to be compared with
    pub sampled: Option<Sampled>,
    /// time that seeing took, without that of translation, in s
    pub seconds: f64,
}

/// Sums and maxima over the rows of a simulation.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Balance {
    /// largest residual of a constraint row
    worst: f64,
}

/// Columns that lack values in some rows.
#[derive(Debug, Default)]
pub(super) struct Gaps {
    /// whether a column has had a value
    has_value: Vec<bool>,
    /// when it first had none in the present simulation
    first: Vec<Option<f64>>,
    /// whether any has had none there
    is_any: bool,
    /// columns that have been told
    told: BTreeSet<String>,
}

impl Gaps {
    /// Looks at the last rows of a run, all of which it holds.
    fn look(&mut self, run: &Run, n: usize) {
        self.has_value.resize(run.columns.len(), false);
        self.first.resize(run.columns.len(), None);
        let from = run.held().len().saturating_sub(n);
        let seen = self.has_value.iter_mut().zip(&mut self.first);
        for (column, (has_value, first)) in run.columns.iter().zip(seen) {
            let new = column.values.get(from..).unwrap_or_default();
            // without a way out of the loop, so that it takes several numbers at once
            let has_gap = new.iter().fold(false, |any, x| any | !x.is_finite());
            if has_gap {
                self.is_any = true;
                let gap = new.iter().position(|x| !x.is_finite());
                *first = first.or(gap.map(|gap| run.value(0, from + gap)));
            }
            *has_value |= new.iter().any(|x| x.is_finite());
        }
    }

    /// Returns the columns that have gaps in the present simulation, and ends it. `is_off` tells
    /// which columns belong to something that is switched off.
    fn take(&mut self, run: &Run, is_off: impl Fn(usize) -> bool) -> Vec<(String, f64)> {
        if !std::mem::take(&mut self.is_any) {
            return Vec::new();
        }
        let seen = self.has_value.iter().zip(&mut self.first);
        let gaps = run.columns.iter().enumerate().zip(seen);
        let gaps = gaps.filter_map(|((k, column), (has_value, first))| {
            let at = first.take().filter(|_| *has_value && !is_off(k))?;
            Some((column.name.clone(), at))
        });
        let gaps: Vec<_> = gaps.collect();
        (gaps.into_iter())
            .filter(|(column, _)| self.told.insert(column.clone()))
            .collect()
    }
}

impl Session {
    /// Hands the rows of results to a receiver while simulations go on.
    pub fn receive(&mut self, receiver: Receiver) {
        self.receiver = Some(receiver);
    }

    /// Ends the sequence after the last `n` rows, which are new, and hands them on.
    fn hand_over(&mut self, n: usize) {
        self.run.end();
        self.gaps.look(&self.run, n);
        // bars of error are found when all rows are there
        let has_bars = self.options.accuracy == Accuracy::Bars;
        if let Some(receiver) = self.receiver.as_mut().filter(|_| !has_bars) {
            receiver(&mut self.run);
        }
    }

    /// Adds a sequence of rows.
    pub(super) fn rows(&mut self, kind: Kind, program: &Program, rows: &[Vec<f64>]) {
        self.run.begin(kind);
        self.more_rows(program, rows);
        self.warn_of_gaps();
    }

    /// Adds rows to the last sequence.
    pub(super) fn more_rows(&mut self, program: &Program, rows: &[Vec<f64>]) {
        let columns = (program, &mut self.scratch);
        columns::append_with(&mut self.run, columns, (rows, 0), |_| None);
        self.hand_over(rows.len());
    }

    /// Warns, once for each, of columns that have values, but not in all rows of a simulation.
    pub(super) fn warn_of_gaps(&mut self) {
        let (columns, model) = (&self.columns, &self.model);
        let is_off = |column: usize| columns.are_off(column, model);
        for (column, at) in self.gaps.take(&self.run, is_off) {
            self.warn(RunWarning::Gap { column, at });
        }
    }

    /// Begins the rows of a simulation over time, to an `end`.
    pub(super) fn begin_rows(
        &mut self,
        kind: Kind,
        program: &Program,
        (system, end): (&System, f64),
    ) -> Seen {
        self.run.begin(kind);
        let mut seen = Seen {
            program: program.clone(),
            active: system.configuration.active.clone(),
            selections: 0,
            rows: 0,
            balance: Balance::default(),
            looks: Looks::begin(system, end),
            ranges: match kind {
                Kind::Dynamic => Ranges::begin(&system.scene.layout, &system.numbers),
                _ => Ranges::default(),
            },
            readings: self.readings(system),
            tilts: Tilts::of(system),
            sampled: None,
            seconds: 0.0,
        };
        let first = std::slice::from_ref(&system.numbers);
        self.weigh(&mut seen.balance, system, first);
        seen
    }

    /// Makes rows of results of the states up to an index, and drops those that nobody needs: all
    /// but the last.
    pub(super) fn see(
        &mut self,
        seen: &mut Seen,
        system: &System,
        trajectory: &mut Trajectory,
        until: usize,
    ) {
        while seen.rows < until {
            // each with the columns of the rows that took part there
            let change = trajectory.selections.get(seen.selections);
            if let Some((at, _, active)) = change.filter(|c| c.0 <= seen.rows) {
                debug_assert!(*at == seen.rows, "choices follow each other");
                let mut configuration = system.configuration.clone();
                configuration.active.clone_from(active);
                let there = system.scene.within(&configuration);
                seen.program = self.columns.program(there).0;
                seen.selections += 1;
                continue;
            }
            let end = change.map_or(until, |c| c.0.min(until));
            let (from, released) = (seen.rows, trajectory.released);
            let rows = &trajectory.rows[from - released..end - released];
            let means = |k: usize| trajectory.means.get(&(from + k));
            let (columns, more) = ((&seen.program, &mut self.scratch), self.rows_to_come);
            columns::append_with(&mut self.run, columns, (rows, more), means);
            let chosen = trajectory.selections.get(..seen.selections);
            let chosen = chosen.and_then(|c| c.last()).map(|c| &c.2[..]);
            let active = chosen.unwrap_or(&seen.active);
            self.remember((system, active), rows, means);
            self.weigh(&mut seen.balance, system, rows);
            rows.iter().for_each(|row| seen.readings.see(row));
            seen.tilts.see(rows);
            seen.rows = end;
            if let Some(sampled) = &mut seen.sampled {
                sampled.take(&self.run, rows.len());
            }
            self.hand_over(rows.len());
        }
        trajectory.release(until);
    }

    /// Watches constraint rows over states.
    fn weigh(&mut self, balance: &mut Balance, system: &System, rows: &[Vec<f64>]) {
        let n_rows = system.scene.rows.len();
        if n_rows == 0 || self.pace.columns_alone {
            return;
        }
        let program = system.row_values();
        let mut work = Work::default();
        let mut out = vec![0.0; program.n_outputs()];
        program.expect_runs(rows.len());
        for row in rows {
            program.run(row, &mut work, &mut out);
            balance.worst = out.iter().fold(balance.worst, |m, g| m.max(g.abs()));
        }
    }

    /// Notes the constraint drift of a simulation.
    pub(super) fn note_drift(&mut self, system: &System, balance: &Balance) {
        if system.scene.rows.is_empty() || self.pace.columns_alone {
            return;
        }
        let record = &mut self.run.record;
        let worst = record.constraint_drift.unwrap_or(0.0).max(balance.worst);
        record.constraint_drift = Some(worst);
    }
}

/// A caller's hooks, and the session that makes rows of results while an integration goes on.
pub(super) struct Follower<'a> {
    session: &'a mut Session,
    seen: &'a mut Seen,
    watch: &'a mut dyn Watch,
    /// whether these rows are the results, and not those of a repetition
    is_kept: bool,
    /// all numbers at the end of the last step, where somebody reads them
    visited: Vec<f64>,
    /// for how long rows are held back
    wait: Wait,
}

impl<'a> Follower<'a> {
    /// Follows an integration. `is_kept`: its rows are the results.
    pub fn new(
        session: &'a mut Session,
        seen: &'a mut Seen,
        watch: &'a mut dyn Watch,
        is_kept: bool,
    ) -> Self {
        Self {
            session,
            seen,
            watch,
            is_kept,
            visited: Vec::new(),
            wait: Wait::begin(LONGEST_WAIT),
        }
    }
}

impl Watch for Follower<'_> {
    fn interrupted(&mut self) -> bool {
        self.watch.interrupted()
    }
    fn progress(&mut self, t: f64, h: f64, stats: &Stats) {
        self.watch.progress(t, h, stats);
    }
    fn visit(&mut self, system: &System, t: f64, y: &[f64]) {
        if self.is_kept {
            self.visited.clone_from(&system.numbers);
            (system.scene.layout).set_state(&mut self.visited, t, y);
            self.seen.readings.see(&self.visited);
            self.seen.looks.see(&self.visited);
            self.seen.ranges.see(&self.visited);
        }
    }
    fn collect(&mut self, system: &System, trajectory: &mut Trajectory) {
        let n = trajectory.rows.len();
        let wait = self.session.receiver.is_none()
            || self.session.options.accuracy == Accuracy::Bars
            || n < ROWS_AT_ONCE && (n < 2 || !self.wait.is_over());
        if wait {
            return;
        }
        // the last state may still change
        let until = trajectory.t.len() - 1;
        if self.is_kept {
            let phase = Phase::begin();
            self.session.see(self.seen, system, trajectory, until);
            self.seen.seconds += phase.elapsed().0;
        } else {
            trajectory.release(until);
        }
        self.wait = Wait::begin(LONGEST_WAIT);
    }
}
