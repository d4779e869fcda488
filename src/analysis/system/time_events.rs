//! Time events: the next time at which a function of time alone breaks.
//!
//! A pulse of a force over time is invisible to a step whose evaluations all fall beside it,
//! however small an error is asked for. A function of time alone can be bounded without the system,
//! and over a whole stretch of time at once: bounds of its values there ([`Interval`]) prove that
//! it stays between two of its levels.
//!
//! Stretches are divided ([`subdivision`]) down to a part of the run that no pulse is shorter than;
//! then the ends are compared, and a break between them is closed in to the last place.
//!
//! A step ends just before a break, and integration begins anew at the first number behind it: no
//! evaluation of the one step is on the other's side, and no switch is looked for.

use crate::expr::program::{Levels, Program, Work};
use crate::numeric::subdivision::{self, Search};
use crate::scalar::Interval;
use crate::scene::Scene;
use crate::scene::layout::{Layout, LongRow};

/// Steps that go over the rest of the run, at least, where a search took too many evaluations.
const STEPS_UNSEARCHED: f64 = 100.0;
/// Distance kept from a break, as a part of the time.
const DISTANCE: f64 = 4.0 * f64::EPSILON;
/// Shortest stretch that is bounded, as a part of the run.
const SHORTEST_STRETCH: f64 = 1e-10;

/// The functions of time alone, with the next time at which one breaks.
#[derive(Clone, Debug, Default)]
pub struct TimeEvents {
    /// `None`: there are no functions of time alone, or none breaks
    program: Option<Program>,
    levels: Vec<Levels>,
    work: Work<Interval>,
    /// the row of numbers, of which the time is read
    inputs: Vec<Interval>,
    values: Vec<Interval>,
    point: Point,
    /// the last answer, and from where it was asked for
    known: Option<(f64, TimeEvent)>,
}

/// The time up to which nothing breaks, and the first one behind a break there.
#[derive(Clone, Copy, Debug)]
struct TimeEvent {
    before: f64,
    behind: Option<f64>,
}

/// The values at one time.
#[derive(Clone, Debug, Default)]
struct Point {
    work: Work,
    numbers: Vec<f64>,
    values: Vec<f64>,
}

impl TimeEvents {
    /// Takes the functions of time alone of a scene, and the levels at which each breaks.
    pub fn new(scene: &Scene, values: Program, levels: Vec<Levels>) -> Self {
        if levels.is_empty() {
            return Self::default();
        }
        let row = LongRow {
            numbers: scene.layout,
            n_more: scene.loops.len(),
            n_sides: 0,
        };
        let n = row.len();
        Self {
            inputs: vec![Interval { lo: 0.0, hi: 0.0 }; n],
            values: vec![Interval { lo: 0.0, hi: 0.0 }; levels.len()],
            point: Point {
                work: Work::default(),
                numbers: vec![0.0; n],
                values: vec![0.0; levels.len()],
            },
            program: Some(values),
            levels,
            work: Work::default(),
            known: None,
        }
    }

    /// Goes on from the same functions, recorded for other rows.
    pub fn carry_on(&mut self, before: &Self) {
        self.known = before.known;
    }

    /// Returns a time after `t` just before a break, or up to which nothing breaks; no later than
    /// `end`.
    pub fn next(&mut self, t: f64, end: f64) -> f64 {
        if self.program.is_none() || t >= end {
            return end;
        }
        let known = self.known.filter(|(from, m)| *from <= t && t < m.before);
        let (from, event) = known.unwrap_or_else(|| (t, self.search(t, end)));
        self.known = Some((from, event));
        event.before.min(end)
    }

    /// Returns the first time behind the break just after `t`, when one has been found.
    pub fn behind(&self, t: f64) -> Option<f64> {
        let (_, event) = self.known.filter(|(_, m)| m.before == t)?;
        event.behind
    }

    fn search(&mut self, t: f64, end: f64) -> TimeEvent {
        let distance = DISTANCE * t.abs().max(end.abs());
        let shortest = (SHORTEST_STRETCH * (end - t)).max(4.0 * distance);
        // a break just here has been seen
        let from = t + (0.01 * shortest).max(2.0 * distance);
        let search = Search {
            first: end - from,
            shortest,
        };
        let found =
            subdivision::first(self, (from, end), search, Self::is_clear, |events, a, b| {
                events.crossing(a, b, b >= end)
            });
        match found.event {
            // evaluations at the end of a step may miss it by a rounding
            Some((before, behind)) => TimeEvent {
                before: before - distance,
                behind: Some(behind),
            },
            None => TimeEvent {
                before: found
                    .free_to
                    .max((t + (end - t) / STEPS_UNSEARCHED).min(end)),
                behind: None,
            },
        }
    }

    /// Returns whether all values surely stay between the same levels from one time to another.
    fn is_clear(&mut self, from: f64, to: f64) -> bool {
        let Some(program) = &self.program else {
            return true;
        };
        self.inputs[Layout::TIME] = Interval { lo: from, hi: to };
        program.eval(&self.inputs, &mut self.work, &mut self.values);
        let mut all = self.values.iter().zip(&self.levels);
        all.all(|(v, levels)| {
            let (lo, hi) = (levels.place(v.lo), levels.place(v.hi));
            lo == hi || lo.is_nan() && hi.is_nan()
        })
    }

    /// Returns the last time before the first break between two times and the first one behind it,
    /// if their ends lie on different sides of one; a value on a level counts where nothing comes
    /// after it.
    fn crossing(&mut self, from: f64, to: f64, last: bool) -> Option<(f64, f64)> {
        let places =
            |point: &mut Point, program: &Program, levels: &[Levels], t: f64| -> Vec<f64> {
                point.numbers[Layout::TIME] = t;
                program.run(&point.numbers, &mut point.work, &mut point.values);
                let values = point.values.iter().zip(levels);
                values.map(|(&v, levels)| levels.place(v)).collect()
            };
        let program = self.program.as_ref()?;
        let before = places(&mut self.point, program, &self.levels, from);
        // not just on a level, that is with an odd number, and between others than before
        let mut crossed = |t: f64| {
            let here = places(&mut self.point, program, &self.levels, t);
            let mut both = here.iter().zip(&before);
            both.any(|(here, before)| {
                (last || here % 2.0 != 0.0) && here != before && !here.is_nan()
            })
        };
        if !crossed(to) {
            return None;
        }
        let (mut a, mut b) = (from, to);
        loop {
            let middle = a + 0.5 * (b - a);
            if middle <= a || middle >= b {
                return Some((a, b));
            }
            if crossed(middle) {
                b = middle;
            } else {
                a = middle;
            }
        }
    }
}
