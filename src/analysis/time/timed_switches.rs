//! Switches that read the time beside the state: whether one comes to zero within a step, shown by
//! bounds.
//!
//! The ends of a step say nothing of a wall that shakes faster than the body moves which it may
//! meet. Where a clock ([`Clocks`]) turns within a step, its switches are bounded over stretches of
//! it, from bounds of the time and of the states there:
//!
//! ```text
//! 1  the whole step    control points of the cubic through both ends, twice as far apart: no proof,
//!                      but what the error of the step lets expect
//! 2  stretches         bounds of the interpolant itself ([`Courses`]), divided ([`subdivision`])
//!                      until each is shown to be free, or is the first that is not
//! ```
//!
//! A switch that divides by bounds which hold zero has none itself, however short the stretch: it
//! is asked for no more. Where stretches did not decide, twice as many steps go by before the next
//! is looked at.
//!
//! [`Clocks`]: crate::analysis::system::System

use crate::analysis::system::System;
use crate::numeric::bernstein::{Courses, NODES};
use crate::numeric::event::{MOST_NAMED, sign};
use crate::numeric::subdivision::{self, Search};
use crate::numeric::{Failure, Method, Step};
use crate::scalar::Interval;

/// Shortest stretch that is bounded, as a part of the step: a touch that is shorter changes nothing
/// that the step could tell.
const SHORTEST: f64 = 1e-9;
/// Part of a step that must have been shown for it to end there.
const WORTH_ENDING: f64 = 0.01;

/// The course of the switches that read the time within a step.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Seen {
    /// no clock turns, and what is seen from the ends of the step holds for them too; or their
    /// bounds show that none comes to zero
    Nothing,
    /// one may come to zero: times to look at
    Look(Vec<f64>),
    /// nothing happens before this time, up to which the step was looked at
    Short(f64),
}

/// The switches of a system that read the time beside the state.
#[derive(Debug)]
pub(super) struct TimedSwitches {
    /// which   (m)
    which: Vec<usize>,
    /// unknowns that they read   (u)
    unknowns: Vec<usize>,
    /// values and rates of these at the beginning of the step   (u)
    begin: Vec<[f64; 2]>,
    courses: Courses,
    /// values of the unknowns at the nodes of a step   (u each)
    samples: [Vec<f64>; NODES],
    /// bounds of all switches   (n)
    bounds: Vec<Interval>,
    /// steps that go by before one is looked at, and as many after the last that stretches did not
    /// decide
    waits: usize,
    undecided: usize,
}

impl TimedSwitches {
    /// Finds them in a system of `n` switches.
    pub fn new(system: &System, n: usize) -> Self {
        let (which, unknowns) = match system.recorded.clocks.is_empty() {
            true => Default::default(),
            false => system.timed_switches(),
        };
        let u = unknowns.len();
        Self {
            which,
            unknowns,
            begin: vec![[0.0; 2]; u],
            courses: Courses::default(),
            samples: std::array::from_fn(|_| vec![0.0; u]),
            bounds: vec![Interval { lo: 0.0, hi: 0.0 }; n],
            waits: 0,
            undecided: 0,
        }
    }

    /// Takes the state at the beginning of a step.
    pub fn begin(&mut self, y: &[f64], ydot: &[f64]) {
        for (begin, &k) in self.begin.iter_mut().zip(&self.unknowns) {
            *begin = [y[k], ydot[k]];
        }
    }

    /// Returns whether a clock turns within a step, so that its ends do not say what these do.
    pub fn are_asked_for(&mut self, system: &mut System, step: &Step, slides: bool) -> bool {
        let nothing = self.which.is_empty() && !slides;
        if nothing || system.recorded.clocks.are_steady(step.t0, step.t1) {
            return false;
        }
        let waits = self.waits > 0 && !slides;
        self.waits = self.waits.saturating_sub(1);
        !waits
    }

    /// Looks at a step within which a clock turns. `sides`: of all switches, 0 for those that are
    /// not asked for; `slides`: whether one slides, whose value is no program.
    ///
    /// # Errors
    /// The interpolant has no value within the step.
    pub fn look(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
        sides: &[i8],
        slides: bool,
    ) -> Result<Seen, Failure> {
        let (t0, t1) = (step.t0, step.t1);
        if slides {
            let turns = system.recorded.clocks.turns(t0, t1, MOST_NAMED);
            return Ok(match turns.last() {
                Some(&last) if last < t1 => Seen::Short(last),
                _ => Seen::Look(turns),
            });
        }
        let which: Vec<usize> = (self.which.iter().copied())
            .filter(|&k| sides[k] != 0)
            .collect();
        system.set(t1, method.y());
        if which.is_empty() || self.is_far(system, method, step, (&which, sides)) {
            return Ok(Seen::Nothing);
        }
        self.follow(system, method, step)?;
        let search = Search {
            first: t1 - t0,
            shortest: SHORTEST * (t1 - t0),
        };
        let mut course = (&mut *self, &mut *system, &mut *method);
        let found = subdivision::first(
            &mut course,
            (t0, t1),
            search,
            |(switches, system, _), a, b| switches.are_free(system, (&which, sides), a, b),
            |(switches, system, method), a, b| {
                let crosses = switches.cross(system, *method, (&which, sides), b);
                crosses.then_some([a, b])
            },
        );
        let seen = match found.event {
            Some([a, b]) => Seen::Look(vec![a, b]),
            None if found.free_to >= t1 => Seen::Nothing,
            None if found.free_to > t0 + WORTH_ENDING * (t1 - t0) => Seen::Short(found.free_to),
            None => Seen::Look(Vec::new()),
        };
        let is_decided = seen != Seen::Look(Vec::new());
        self.undecided = if is_decided {
            0
        } else {
            2 * self.undecided + 1
        };
        self.waits = self.undecided;
        if !is_decided {
            let bounds = &self.bounds;
            (self.which).retain(|&k| bounds[k].lo.is_finite() && bounds[k].hi.is_finite());
        }
        Ok(seen)
    }

    /// Returns whether the whole step shows that none comes to zero.
    fn is_far(
        &mut self,
        system: &mut System,
        method: &dyn Method<System>,
        step: &Step,
        (which, sides): (&[usize], &[i8]),
    ) -> bool {
        let (y, ydot, third) = (method.y(), method.ydot(), step.h / 3.0);
        let ends = self.unknowns.iter().zip(&self.begin);
        let unknowns = ends.map(|(&k, &[y0, rate])| {
            let points = [y0, y0 + third * rate, y[k] - third * ydot[k], y[k]];
            let least = points.iter().fold(f64::INFINITY, |m, &x| m.min(x));
            let most = points.iter().fold(f64::NEG_INFINITY, |m, &x| m.max(x));
            let room = 0.5 * (most - least);
            (k, Interval::between(least - room, most + room))
        });
        let time = Interval::between(step.t0, step.t1);
        system.bound_switches(time, unknowns, &mut self.bounds);
        keep_sides(&self.bounds, which, sides)
    }

    /// Takes the interpolant of a step.
    fn follow(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
    ) -> Result<(), Failure> {
        let mut state = method.y().to_vec();
        for (node, samples) in Courses::nodes().iter().zip(&mut self.samples) {
            let t = match *node {
                x if x >= 1.0 => step.t1,
                x => step.t0 + x * step.h,
            };
            if t == step.t1 {
                state.copy_from_slice(method.y());
            } else {
                method.interpolate(system, t, &mut state)?;
            }
            for (sample, &k) in samples.iter_mut().zip(&self.unknowns) {
                *sample = state[k];
            }
        }
        let n = self.unknowns.len();
        (self.courses).lead_through((step.t0, step.h), &self.samples, n);
        Ok(())
    }

    /// Returns whether bounds show that none comes to zero between two times of the step.
    fn are_free(
        &mut self,
        system: &mut System,
        (which, sides): (&[usize], &[i8]),
        from: f64,
        to: f64,
    ) -> bool {
        let courses = &self.courses;
        let all = self.unknowns.iter().enumerate();
        let unknowns = all.map(|(j, &k)| (k, courses.bound(j, from, to)));
        system.bound_switches(Interval::between(from, to), unknowns, &mut self.bounds);
        keep_sides(&self.bounds, which, sides)
    }

    /// Returns whether one is on its other side at a time of the step.
    fn cross(
        &self,
        system: &mut System,
        method: &mut dyn Method<System>,
        (which, sides): (&[usize], &[i8]),
        t: f64,
    ) -> bool {
        let mut state = method.y().to_vec();
        if method.interpolate(system, t, &mut state).is_err() {
            return false;
        }
        let mut values = vec![0.0; sides.len()];
        system.switches(t, &state, &mut values);
        which.iter().any(|&k| sign(values[k]) == -sides[k])
    }
}

/// Returns whether bounds lie on the sides of zero that are held; what touches zero does not cross
/// it, and what stays there is on either side.
fn keep_sides(bounds: &[Interval], which: &[usize], sides: &[i8]) -> bool {
    which.iter().all(|&k| match sides[k] {
        1.. => bounds[k].lo >= 0.0,
        _ => bounds[k].hi <= 0.0,
    })
}
