//! Switches that are bounded: whether one comes to zero within a step, shown by bounds of its value
//! and of its rate.
//!
//! The ends of a step say little of what lies between them: a force that acts on the last
//! millionth of the way to a turn, a gate that is passed in less than a step, a wall that shakes
//! faster than the body moves which it may meet. The program of the switches is run over bounds of
//! the time, of the states and of their rates instead ([`Dual`] of [`Interval`]):
//!
//! ```text
//! 1  a room            in which the states are expected for some steps: its bounds are kept as
//!                      long as steps stay in it
//! 2  the whole step    control points of the cubics of the states, twice as far apart: no proof, but
//!                      what the error of the step lets expect
//! 3  the middle        where a switch goes no further ways within the step than its ends say, the
//!                      cubic through these and the middle (`switches.rs`)
//! 4  stretches         bounds of the interpolant itself ([`Courses`]), divided ([`subdivision`])
//!                      until each is shown to be free, or is the first that is not
//! ```
//!
//! A stretch [a, b] in which ġ lies between ṙ and Ṙ is free, for a switch on the positive side, if
//!
//! ```text
//! g > 0 by its bounds, or g(a) and g(b) > 0 and
//! max(g(a) + ṙ τ, g(b) − Ṙ (b − a − τ)) > 0     for all τ: where both lines meet
//! ```
//!
//! and has one crossing if ġ keeps its sign and g changes it. (Branches are held: what is still
//! selected within a program bends there, and does not jump, so that its rates are between both.)
//! So what begins at zero and leaves it needs no short stretches, and the work grows with the
//! logarithm of how near a touch is.
//!
//! A switch that divides by bounds which hold zero has none itself, however short the stretch: it
//! is asked for no more. Where stretches did not decide, twice as many steps go by before the next
//! is looked at.

use crate::analysis::system::System;
use crate::numeric::bernstein::{Courses, NODES, hull};
use crate::numeric::event::{MOST_NAMED, sign};
use crate::numeric::subdivision::{self, Search, Shown};
use crate::numeric::{Failure, Method, Step};
use crate::scalar::{Dual, Interval, Scalar};

/// Shortest stretch that is bounded, as a part of the step: a touch that is shorter changes nothing
/// that the step could tell.
const SHORTEST: f64 = 1e-9;
/// Room kept on both sides of what states do in a step, in as many of its lengths.
const ROOM: f64 = 2.0;
/// Bound of the way of a switch within a step, over what its values and slopes at the ends say that
/// it passes, up to which these and the middle tell what it does: a wave has as much.
const RESOLVED: f64 = 3.0;
/// Part of a step that is short: the step ends where so much of it has been shown, and a stretch at
/// whose end a switch has changed its side is divided no further where its rate has no bound.
const SHORT: f64 = 0.01;

/// The time of a room in which no step lies.
const NO_TIME: Interval = Interval { lo: 0.0, hi: -1.0 };

/// The course of the bounded switches within a step.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Seen {
    /// none comes to zero
    Nothing,
    /// one may come to zero: times to look at
    Look(Vec<f64>),
    /// nothing happens before this time, up to which the step was looked at
    Short(f64),
    /// they were not looked at
    Unknown,
}

/// The knowledge of a step that its bounds give.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Whole {
    /// none comes to zero
    Free,
    /// one does, once, and the others do not or do as well
    Event,
    /// some may, and go no further ways than the ends of the step say
    Resolved,
    /// some may
    Open,
}

/// The switches of a system that can be bounded.
#[derive(Debug)]
pub(super) struct BoundedSwitches {
    /// which   (m)
    which: Vec<usize>,
    /// unknowns that they read   (u)
    unknowns: Vec<usize>,
    /// values and rates of these at the beginning of the step   (u)
    begin: Vec<[f64; 2]>,
    courses: Courses,
    /// values of the unknowns at the nodes of a step   (u each)
    samples: [Vec<f64>; NODES],
    /// bounds of all switches and of their rates   (n)
    bounds: Vec<Dual<1, Interval>>,
    /// the stretch that was looked at last, and the values of all switches at its ends   (n each)
    stretch: [f64; 2],
    ends: [Vec<f64>; 2],
    /// those that have not been shown to be free in the step under way
    open: Vec<usize>,
    /// the room: bounds of the time, and of the unknowns and their rates   (u); bounds of all
    /// switches in it   (n)
    time: Interval,
    room: Vec<[Interval; 2]>,
    in_room: Vec<Dual<1, Interval>>,
    state: Vec<f64>,
    /// steps that go by before one is looked at, and as many after the last that stretches did not
    /// decide
    waits: usize,
    undecided: usize,
}

/// A step under way: its ends, and for all switches the side on which each is held, 0 where it is
/// not asked for, and the values and slopes at both ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked<'a> {
    pub step: &'a Step,
    pub sides: &'a [i8],
    pub values: [&'a [f64]; 2],
    pub slopes: [&'a [f64]; 2],
}

impl BoundedSwitches {
    /// Finds them in a system of `n` switches.
    pub fn new(system: &System, n: usize) -> Self {
        let (which, unknowns) = system.bounded_switches();
        let u = unknowns.len();
        Self {
            which,
            unknowns,
            begin: vec![[0.0; 2]; u],
            courses: Courses::default(),
            samples: std::array::from_fn(|_| vec![0.0; u]),
            bounds: vec![Dual::constant(0.0); n],
            stretch: [f64::NAN; 2],
            ends: [vec![0.0; n], vec![0.0; n]],
            open: Vec::new(),
            time: NO_TIME,
            room: vec![[Interval::ANY; 2]; u],
            in_room: vec![Dual::constant(0.0); n],
            state: Vec::new(),
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

    /// Forgets the room: other branches are held from now on.
    pub fn forget(&mut self) {
        self.time = NO_TIME;
    }

    /// Returns whether a switch is one of these.
    pub fn has(&self, k: usize) -> bool {
        self.which.binary_search(&k).is_ok()
    }

    /// Looks at a step in which something slides: its value is no program, so that the step is
    /// looked at where clocks turn.
    pub fn look_at_clocks(&self, system: &mut System, step: &Step) -> Seen {
        let (t0, t1) = (step.t0, step.t1);
        if system.recorded.clocks.are_steady(t0, t1) {
            return Seen::Unknown;
        }
        let turns = system.recorded.clocks.turns(t0, t1, MOST_NAMED);
        match turns.last() {
            Some(&last) if last < t1 => Seen::Short(last),
            _ => Seen::Look(turns),
        }
    }

    /// Returns those that have not been shown to be free in the step under way.
    pub fn open(&self) -> &[usize] {
        &self.open
    }

    /// Looks at a step by the bounds of the room in which it stays: returns whether all are free.
    pub fn are_far(
        &mut self,
        system: &mut System,
        method: &dyn Method<System>,
        asked: Asked<'_>,
    ) -> bool {
        let mut open = std::mem::take(&mut self.open);
        open.clear();
        if !self.which.is_empty() {
            self.stay_in_room(system, method, asked.step);
        }
        open.extend(self.which.iter().filter(|&&k| {
            let free = |k: usize| {
                let bounds = self.in_room[k];
                self.of_one(k, bounds, asked, asked.values, asked.step.h, true) == Shown::Free
            };
            asked.sides[k] != 0 && !free(k)
        }));
        self.open = open;
        self.open.is_empty()
    }

    /// Bounds the switches in another room where a step leads out of the last one.
    fn stay_in_room(&mut self, system: &mut System, method: &dyn Method<System>, step: &Step) {
        let (y, ydot) = (method.y(), method.ydot());
        let inside = |x: &Interval, room: &Interval| room.lo <= x.lo && x.hi <= room.hi;
        let all = self.unknowns.iter().zip(&self.begin).zip(&self.room);
        let mut stays = all.map(|((&k, &begin), room)| {
            let [value, rate] = hulls(begin, [y[k], ydot[k]], step.h);
            inside(&value, &room[0]) && inside(&rate, &room[1])
        });
        let time = Interval::between(step.t0, step.t1);
        if inside(&time, &self.time) && stays.all(|stays| stays) {
            return;
        }
        self.time = Interval::between(step.t0, step.t1 + ROOM * step.h);
        let all = self.unknowns.iter().zip(&self.begin).zip(&mut self.room);
        for ((&k, &begin), room) in all {
            *room = hulls(begin, [y[k], ydot[k]], step.h).map(|x| widened(x, ROOM));
        }
        let unknowns = self.unknowns.iter().copied().zip(self.room.iter().copied());
        system.take_bounds(self.time, unknowns);
        system.bound_switches(&mut self.in_room);
    }

    /// Looks at a step by bounds of the interpolant over stretches of it, at those that are open.
    ///
    /// # Errors
    /// The interpolant has no value within the step.
    pub fn look_at_stretches(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        asked: Asked<'_>,
    ) -> Result<Seen, Failure> {
        if self.waits > 0 {
            self.waits -= 1;
            return Ok(Seen::Unknown);
        }
        let Step { t0, t1, .. } = *asked.step;
        self.follow(system, method, asked.step)?;
        let search = Search {
            first: 0.5 * (t1 - t0),
            shortest: (SHORTEST * (t1 - t0)).max(8.0 * f64::EPSILON * t1.abs()),
        };
        self.stretch = [f64::NAN, t0];
        self.ends[1].copy_from_slice(asked.values[0]);
        let mut course = (&mut *self, &mut *system, &mut *method);
        let found = subdivision::first(
            &mut course,
            (t0, t1),
            search,
            |(switches, system, method), a, b| switches.of_stretch(system, *method, asked, [a, b]),
            |(switches, ..), a, b| {
                let at_end = &switches.ends[1];
                let crossed = |&k: &usize| sign(at_end[k]) == -asked.sides[k] && at_end[k] != 0.0;
                let crossed = switches.open.iter().any(crossed);
                crossed.then_some([a, b])
            },
        );
        let seen = match found.event {
            Some([a, b]) => Seen::Look(vec![a, b]),
            None if found.free_to >= t1 => Seen::Nothing,
            None if found.free_to > t0 + SHORT * (t1 - t0) => Seen::Short(found.free_to),
            None => Seen::Look(Vec::new()),
        };
        let is_decided = seen != Seen::Look(Vec::new());
        self.undecided = match is_decided {
            true => 0,
            false => 2 * self.undecided + 1,
        };
        self.waits = self.undecided;
        if !is_decided {
            let bounds = &self.bounds;
            (self.which).retain(|&k| is_finite(bounds[k].re));
        }
        Ok(seen)
    }

    /// Looks at a step by bounds of the whole of it, at those that are open.
    pub fn look_at_whole(
        &mut self,
        system: &mut System,
        method: &dyn Method<System>,
        asked: Asked<'_>,
    ) -> Whole {
        let Step { t0, t1, h, .. } = *asked.step;
        let (y, ydot) = (method.y(), method.ydot());
        let ends = self.unknowns.iter().zip(&self.begin);
        let unknowns = ends.map(|(&k, &begin)| {
            let of_step = hulls(begin, [y[k], ydot[k]], h);
            (k, of_step.map(|x| widened(x, 0.5)))
        });
        system.take_bounds(Interval::between(t0, t1), unknowns);
        let mut whole = Whole::Free;
        let mut open = std::mem::take(&mut self.open);
        open.retain(|&k| {
            system.bound_switch(k, &mut self.bounds[k]);
            let bounds = self.bounds[k];
            let of_one = match self.of_one(k, bounds, asked, asked.values, h, true) {
                Shown::Free => return false,
                Shown::Event => Whole::Event,
                Shown::Nothing => {
                    let [g0, g1] = asked.values.map(|g| g[k]);
                    let [slope0, slope1] = asked.slopes.map(|slope| slope[k]);
                    let span = hulls([g0, slope0], [g1, slope1], h)[0];
                    let most = RESOLVED * (span.hi - span.lo) / h;
                    let rate = bounds.eps[0];
                    match rate.lo >= -most && rate.hi <= most {
                        true => Whole::Resolved,
                        false => Whole::Open,
                    }
                }
            };
            whole = whole.max(of_one);
            true
        });
        self.open = open;
        whole
    }

    /// Takes the interpolant of a step.
    fn follow(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
    ) -> Result<(), Failure> {
        self.state.resize(method.y().len(), 0.0);
        for (node, samples) in Courses::nodes().iter().zip(&mut self.samples) {
            let t = match *node {
                x if x >= 1.0 => step.t1,
                x => step.t0 + x * step.h,
            };
            if t == step.t1 {
                self.state.copy_from_slice(method.y());
            } else {
                method.interpolate(system, t, &mut self.state)?;
            }
            for (sample, &k) in samples.iter_mut().zip(&self.unknowns) {
                *sample = self.state[k];
            }
        }
        let n = self.unknowns.len();
        (self.courses).lead_through((step.t0, step.h), &self.samples, n);
        Ok(())
    }

    /// Returns what a stretch of a step shows; the values at its ends are `ends` afterwards.
    fn of_stretch(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        asked: Asked<'_>,
        [from, to]: [f64; 2],
    ) -> Shown {
        if self.stretch[1] == from {
            self.ends.swap(0, 1);
        }
        self.stretch = [from, to];
        if to >= asked.step.t1 {
            self.ends[1].copy_from_slice(asked.values[1]);
        } else if method.interpolate(system, to, &mut self.state).is_ok() {
            system.switches(to, &self.state, &mut self.ends[1]);
        } else {
            return Shown::Nothing;
        }
        let courses = &self.courses;
        let all = self.unknowns.iter().enumerate();
        let unknowns = all.map(|(j, &k)| (k, courses.bound(j, from, to)));
        system.take_bounds(Interval::between(from, to), unknowns);
        let [at_from, at_to] = &self.ends;
        let begins = from <= asked.step.t0;
        let mut shown = Shown::Free;
        for &k in &self.open {
            system.bound_switch(k, &mut self.bounds[k]);
            let bounds = self.bounds[k];
            match self.of_one(k, bounds, asked, [at_from, at_to], to - from, begins) {
                Shown::Free => {}
                Shown::Event => shown = Shown::Event,
                Shown::Nothing => return Shown::Nothing,
            }
        }
        shown
    }

    /// Returns what bounds and the values at both ends of a stretch of length `h` show of one of
    /// them; `begins`: whether it is put there onto the side on which it is held.
    fn of_one(
        &self,
        k: usize,
        Dual { re, eps }: Dual<1, Interval>,
        asked: Asked<'_>,
        values: [&[f64]; 2],
        h: f64,
        begins: bool,
    ) -> Shown {
        let side = f64::from(asked.sides[k]);
        let [mut a, b] = values.map(|g| side * g[k]);
        if begins {
            a = a.max(0.0);
        }
        let rate = eps[0];
        match course(ordered(re, side).0, ordered(rate, side), [a, b], h) {
            // division would end at the shortest stretch only
            Shown::Nothing if b < 0.0 && h < SHORT * asked.step.h && !is_finite(rate) => {
                Shown::Event
            }
            shown => shown,
        }
    }
}

/// Returns whether both bounds are numbers.
fn is_finite(bounds: Interval) -> bool {
    bounds.lo.is_finite() && bounds.hi.is_finite()
}

/// Returns the bounds of what is multiplied by a sign.
fn ordered(bounds: Interval, side: f64) -> (f64, f64) {
    match side > 0.0 {
        true => (bounds.lo, bounds.hi),
        false => (-bounds.hi, -bounds.lo),
    }
}

/// Returns bounds of the cubic through both ends of a step of length `h`, and of its rate, by
/// value and rate at both.
fn hulls([y0, rate0]: [f64; 2], [y1, rate1]: [f64; 2], h: f64) -> [Interval; 2] {
    let third = h / 3.0;
    let [a, b] = [y0 + third * rate0, y1 - third * rate1];
    [
        hull(&[y0, a, b, y1]),
        hull(&[rate0, (b - a) / third, rate1]),
    ]
}

/// Returns bounds of which both are further away by a part of what lies between them.
fn widened(bounds: Interval, part: f64) -> Interval {
    let room = part * (bounds.hi - bounds.lo);
    Interval::between(bounds.lo - room, bounds.hi + room)
}

/// Returns what is shown of a function that is to stay positive over a stretch of length `h`, by
/// its least value, bounds of its rate and its values at both ends. What touches zero does not
/// cross it.
fn course(least: f64, (slowest, fastest): (f64, f64), [a, b]: [f64; 2], h: f64) -> Shown {
    if least >= 0.0 {
        return Shown::Free;
    }
    let keeps_sign = slowest >= 0.0 || fastest <= 0.0;
    if a >= 0.0 && b < 0.0 && keeps_sign {
        return Shown::Event;
    }
    if !(a >= 0.0 && b >= 0.0) {
        return Shown::Nothing;
    }
    if keeps_sign {
        return Shown::Free;
    }
    // where the steepest lines through both ends meet
    let at = (b - a - fastest * h) / (slowest - fastest);
    (a + slowest * at >= 0.0).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_course_is_free_above_the_steepest_lines_through_its_ends() {
        // from 1 to 1 in one second, with slopes between −s and s
        let shown = |s: f64| course(-9.0, (-s, s), [1.0, 1.0], 1.0);
        assert_eq!(shown(1.9), Shown::Free);
        assert_eq!(shown(2.1), Shown::Nothing);
        // from zero on, and through zero
        assert_eq!(course(-1.0, (0.5, 2.0), [0.0, 1.0], 1.0), Shown::Free);
        assert_eq!(course(-1.0, (-2.0, -0.5), [0.5, -0.5], 1.0), Shown::Event);
        assert_eq!(course(-1.0, (-2.0, 0.5), [0.5, -0.5], 1.0), Shown::Nothing);
        // no bounds, no values
        let any = (f64::NEG_INFINITY, f64::INFINITY);
        assert_eq!(
            course(f64::NEG_INFINITY, any, [1.0, 1.0], 1.0),
            Shown::Nothing
        );
        assert_eq!(
            course(f64::NAN, (f64::NAN, f64::NAN), [1.0, 1.0], 1.0),
            Shown::Nothing
        );
    }
}
