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
//! logarithm of how near a touch is. Where that is not shown, the switch comes to zero no sooner
//! than the steepest line does, g(a)/|ṙ|: so much of the stretch is free. Stretches are looked at
//! for one switch after the other, and for each only before what those before it do.
//!
//! A switch that divides by bounds which hold zero has none itself, however short the stretch: it
//! is asked for no more. Where stretches did not decide, twice as many steps go by before the next
//! is looked at.

use crate::analysis::system::System;
use crate::analysis::system::bounds::{Bounds, What};
use crate::numeric::bernstein::{Courses, hull};
use crate::numeric::event::{MOST_NAMED, sign};
use crate::numeric::subdivision::{self, Found, Search, Shown};
use crate::numeric::{Failure, Method, Step};
use crate::scalar::{Interval, Scalar};

/// Shortest stretch that is bounded, as a part of the step: a touch that is shorter changes nothing
/// that the step could tell.
const SHORTEST: f64 = 1e-9;
/// Room kept on both sides of what states do in a step, in as many of its lengths.
const ROOM: f64 = 2.0;
/// Bound of the way of a switch within a step, over what its values and slopes at the ends say that
/// it passes, up to which these and the middle tell what it does: a wave has as much.
const RESOLVED: f64 = 3.0;
/// Part of a step that is short: the step ends where so much of it has been shown, a stretch at
/// whose end a switch has changed its side is divided no further where its rate has no bound, and
/// where a short step does not find what a long one saw, the next one is no longer than it is short
/// of.
pub(super) const SHORT: f64 = 0.01;

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
    what: What,
    /// which   (m)
    which: Vec<usize>,
    /// unknowns that they read, those of loops after those of the method   (u), and how many the
    /// method has
    unknowns: Vec<usize>,
    n_y: usize,
    /// values and rates of the unknowns of all loops at the end of the step   (loops each)
    loops: [Vec<f64>; 2],
    /// values and rates of the unknowns at the beginning of the step   (u)
    begin: Vec<[f64; 2]>,
    courses: Courses,
    /// bounds of all switches and of their rates   (n)
    bounds: Vec<Bounds>,
    /// the places in `unknowns` of what each reads, once it was asked   (n)
    reads: Vec<Option<Vec<usize>>>,
    /// times at which all switches were evaluated for one of them, and their values   (n each)
    times: Vec<f64>,
    values: Vec<Vec<f64>>,
    /// those that have not been shown to be free in the step under way
    open: Vec<usize>,
    /// the room: bounds of the time, and of the unknowns and their rates   (u); bounds of all
    /// switches in it   (n)
    time: Interval,
    room: Vec<[Interval; 2]>,
    in_room: Vec<Bounds>,
    /// steps in a row that were shown to be free as a whole, and how many of them it takes to be
    /// worth the bounds of a room: twice as many after one that was left at once
    calm: usize,
    calm_enough: usize,
    state: Vec<f64>,
    /// values of all switches where only the unknowns of loops are wanted   (n)
    scratch: Vec<f64>,
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
    /// what stands for zero; empty: zero does   (n)
    pub levels: &'a [f64],
    pub values: [&'a [f64]; 2],
    /// `None`: the ends and the middle of a step are not to be trusted
    pub slopes: Option<[&'a [f64]; 2]>,
}

impl Asked<'_> {
    /// Returns the level of one of them.
    fn level(&self, k: usize) -> f64 {
        self.levels.get(k).copied().unwrap_or(0.0)
    }

    /// Returns the distances of one of them from its level at both ends.
    fn ends(&self, k: usize) -> [f64; 2] {
        self.values.map(|g| g[k] - self.level(k))
    }
}

impl BoundedSwitches {
    /// Finds them in a system of `n` switches.
    pub fn new(system: &mut System, what: What, n: usize) -> Self {
        let (which, unknowns) = system.watched(what).0.bounded();
        let u = unknowns.len();
        Self {
            what,
            which,
            unknowns,
            n_y: system.scene.layout.n_y(),
            loops: Default::default(),
            begin: vec![[0.0; 2]; u],
            courses: Courses::default(),
            bounds: vec![Bounds::constant(0.0); n],
            reads: vec![None; n],
            times: Vec::new(),
            values: Vec::new(),
            open: Vec::new(),
            time: NO_TIME,
            room: vec![[Interval::ANY; 2]; u],
            in_room: vec![Bounds::constant(0.0); n],
            calm: 0,
            calm_enough: 1,
            state: Vec::new(),
            scratch: vec![0.0; n],
            waits: 0,
            undecided: 0,
        }
    }

    /// Takes the state at the beginning of a step, at which the unknowns of loops have been taken.
    pub fn begin(&mut self, y: &[f64], ydot: &[f64]) {
        let mut begin = std::mem::take(&mut self.begin);
        for (begin, &k) in begin.iter_mut().zip(&self.unknowns) {
            *begin = self.at_end(k, y, ydot);
        }
        self.begin = begin;
    }

    /// Takes the unknowns of loops at the state at which the switches were evaluated last.
    pub fn take_loops(&mut self, system: &mut System) {
        self.loops[0].clear();
        self.loops[0].extend_from_slice(system.watched(self.what).0.loop_unknowns());
    }

    /// Takes their rates, `delta` after they were taken.
    pub fn take_rates_of_loops(&mut self, system: &mut System, delta: f64) {
        let [values, rates] = &mut self.loops;
        let all = system
            .watched(self.what)
            .0
            .loop_unknowns()
            .iter()
            .zip(values);
        rates.clear();
        rates.extend(all.map(|(later, now)| (later - *now) / delta));
    }

    /// Returns value and rate of an unknown where the step ends.
    fn at_end(&self, k: usize, y: &[f64], ydot: &[f64]) -> [f64; 2] {
        match k.checked_sub(self.n_y) {
            Some(k) => [0, 1].map(|of| self.loops[of][k]),
            None => [y[k], ydot[k]],
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
        let stays = !self.which.is_empty() && self.stays_in_room(system, method, asked.step);
        open.extend(self.which.iter().filter(|&&k| {
            let free = |k: usize| {
                let bounds = self.in_room[k];
                let values = asked.ends(k);
                of_one(k, bounds, asked, values, asked.step.h, true) == Shown::Free
            };
            asked.sides[k] != 0 && !(stays && free(k))
        }));
        self.open = open;
        self.open.is_empty()
    }

    /// Returns whether a step stays in the room, of which another is made where it leads out of the
    /// last.
    fn stays_in_room(
        &mut self,
        system: &mut System,
        method: &dyn Method<System>,
        step: &Step,
    ) -> bool {
        let (y, ydot) = (method.y(), method.ydot());
        let inside = |x: &Interval, room: &Interval| room.lo <= x.lo && x.hi <= room.hi;
        let all = self.unknowns.iter().zip(&self.begin).zip(&self.room);
        let mut stays = all.map(|((&k, &begin), room)| {
            let [value, rate] = hulls(begin, self.at_end(k, y, ydot), step.h);
            inside(&value, &room[0]) && inside(&rate, &room[1])
        });
        let time = Interval::between(step.t0, step.t1);
        if inside(&time, &self.time) && stays.all(|stays| stays) {
            self.calm_enough = 1;
            return true;
        }
        self.time = NO_TIME;
        if self.calm < self.calm_enough {
            return false;
        }
        (self.calm, self.calm_enough) = (0, 2 * self.calm_enough);
        self.time = Interval::between(step.t0, step.t1 + ROOM * step.h);
        for (i, &k) in self.unknowns.iter().enumerate() {
            let of_step = hulls(self.begin[i], self.at_end(k, y, ydot), step.h);
            self.room[i] = of_step.map(|x| widened(x, ROOM));
        }
        let mut unknowns = self.unknowns.iter().copied().zip(self.room.iter().copied());
        let (watched, numbers) = system.watched(self.what);
        watched.take_bounds(numbers, self.time, &mut unknowns);
        watched.bound(&mut self.in_room);
        true
    }

    /// Looks at a step by bounds of the interpolant over stretches of it, at those that are open,
    /// one after the other: at each only before what the others do.
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
        let Step { t0, t1, h, .. } = *asked.step;
        self.follow(system, method, asked.step)?;
        let (mut end, mut event, mut unbounded) = (t1, None, None);
        let open = std::mem::take(&mut self.open);
        for &k in &open {
            let found = self.first_of_one(system, method, asked, (k, end));
            if let Some([a, b]) = found.event {
                end = self.narrowed(system, method, asked, (k, [a, b]));
                event = Some(vec![a, end]);
            } else if found.free_to < end {
                (end, event) = (found.free_to, None);
                unbounded = (!is_finite(self.bounds[k].re)).then_some(k);
            }
        }
        self.open = open;
        let seen = match event {
            Some(times) => Seen::Look(times),
            None if end >= t1 => Seen::Nothing,
            None if end > t0 + SHORT * h => Seen::Short(end),
            None => Seen::Look(Vec::new()),
        };
        let is_decided = seen != Seen::Look(Vec::new());
        self.undecided = match is_decided {
            true => 0,
            false => 2 * self.undecided + 1,
        };
        self.waits = self.undecided;
        if !is_decided {
            self.which.retain(|&k| Some(k) != unbounded);
        }
        Ok(seen)
    }

    /// Forgets the values within the step before.
    pub fn forget_values(&mut self) {
        self.times.clear();
    }

    /// Finds the first stretch, before `end`, in which one of them comes to zero.
    pub fn first_of_one(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        asked: Asked<'_>,
        (k, end): (usize, f64),
    ) -> Found<[f64; 2]> {
        let Step { t0, t1, h, .. } = *asked.step;
        self.forget_values();
        let search = Search {
            // the whole step has been looked at
            first: if end < t1 { end - t0 } else { 0.5 * h },
            shortest: shortest(asked.step),
        };
        let mut course = (self, system, method);
        subdivision::first(
            &mut course,
            (t0, end),
            search,
            |(switches, system, method), a, b| {
                switches.of_stretch(system, *method, asked, (k, [a, b]))
            },
            |(switches, system, method), a, b| {
                let at_end = switches.value(system, *method, asked, (k, b));
                let crossed = at_end.is_some_and(|g| sign(g) == -asked.sides[k] && g != 0.0);
                crossed.then_some([a, b])
            },
        )
    }

    /// Returns a time at which one has crossed zero that is not far behind where it does: others
    /// need not be looked at behind it.
    fn narrowed(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        asked: Asked<'_>,
        (k, [mut a, mut b]): (usize, [f64; 2]),
    ) -> f64 {
        while b - a > (SHORT * (b - asked.step.t0)).max(shortest(asked.step)) {
            let middle = 0.5 * (a + b);
            let Some(value) = self.value(system, method, asked, (k, middle)) else {
                break;
            };
            match sign(value) == -asked.sides[k] {
                true => b = middle,
                false => a = middle,
            }
        }
        b
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
        let mut unknowns = ends.map(|(&k, &begin)| {
            let of_step = hulls(begin, self.at_end(k, y, ydot), h);
            (k, of_step.map(|x| widened(x, 0.5)))
        });
        let (watched, numbers) = system.watched(self.what);
        watched.take_bounds(numbers, Interval::between(t0, t1), &mut unknowns);
        let mut whole = Whole::Free;
        let mut open = std::mem::take(&mut self.open);
        open.retain(|&k| {
            let bounds = watched.bound_one(k);
            let values = asked.ends(k);
            let of_one = match of_one(k, bounds, asked, values, h, true) {
                Shown::Free => return false,
                Shown::Event => Whole::Event,
                Shown::Until(_) | Shown::Nothing => {
                    let most = asked.slopes.map_or(0.0, |slopes| {
                        let [g0, g1] = values;
                        let [slope0, slope1] = slopes.map(|slope| slope[k]);
                        let span = hulls([g0, slope0], [g1, slope1], h)[0];
                        RESOLVED * (span.hi - span.lo) / h
                    });
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
        self.calm = match whole {
            Whole::Free => self.calm + 1,
            _ => 0,
        };
        whole
    }

    /// Takes the interpolant of a step.
    ///
    /// # Errors
    /// It has no value somewhere.
    pub fn follow(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
    ) -> Result<(), Failure> {
        self.state.resize(method.y().len(), 0.0);
        self.courses.begin((step.t0, step.h), self.unknowns.len());
        for (i, x) in Courses::nodes().into_iter().enumerate() {
            let t = match x {
                x if x >= 1.0 => step.t1,
                x => step.t0 + x * step.h,
            };
            if t == step.t1 {
                self.state.copy_from_slice(method.y());
            } else {
                method.interpolate(system, t, &mut self.state)?;
            }
            if self.unknowns.last().is_some_and(|&k| k >= self.n_y) {
                system.watch(self.what, (t, &self.state), &mut self.scratch);
            }
            let loops = system.watched(self.what).0.loop_unknowns();
            let values = self.courses.values_at(i).iter_mut();
            for (value, &k) in values.zip(&self.unknowns) {
                *value = match k.checked_sub(self.n_y) {
                    Some(k) => loops[k],
                    None => self.state[k],
                };
            }
        }
        Ok(())
    }

    /// Returns what a stretch of a step shows of one of them.
    fn of_stretch(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        asked: Asked<'_>,
        (k, [from, to]): (usize, [f64; 2]),
    ) -> Shown {
        let (watched, numbers) = system.watched(self.what);
        let reads = self.reads[k].get_or_insert_with(|| {
            let unknowns = watched.unknowns_of(k).into_iter();
            unknowns
                .filter_map(|y| self.unknowns.binary_search(&y).ok())
                .collect()
        });
        let (unknowns, courses) = (&self.unknowns, &mut self.courses);
        let bounded = |&j: &usize| (unknowns[j], courses.bound(j, from, to));
        let mut of_reads = reads.iter().map(bounded);
        watched.take_bounds(numbers, Interval::between(from, to), &mut of_reads);
        let bounds = watched.bound_one(k);
        self.bounds[k] = bounds;
        let side = f64::from(asked.sides[k]);
        if ordered(bounds.re - Interval::constant(asked.level(k)), side).0 >= 0.0 {
            return Shown::Free;
        }
        let ends = [from, to].map(|t| self.value(system, method, asked, (k, t)));
        let [Some(a), Some(b)] = ends else {
            return Shown::Nothing;
        };
        let begins = from <= asked.step.t0;
        match of_one(k, bounds, asked, [a, b], to - from, begins) {
            Shown::Nothing => {
                // it comes to zero no sooner than its steepest line
                let slowest = ordered(bounds.eps[0], side).0;
                match side * a > 0.0 && slowest < 0.0 {
                    true => Shown::Until(from + (1.0 - SHORT) * (side * a / -slowest)),
                    false => Shown::Nothing,
                }
            }
            shown => shown,
        }
    }

    /// Returns how far one of them is from its level at a time of the step; `None`: it has no
    /// value.
    pub fn value(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        asked: Asked<'_>,
        (k, t): (usize, f64),
    ) -> Option<f64> {
        if t <= asked.step.t0 {
            return Some(asked.ends(k)[0]);
        }
        if t >= asked.step.t1 {
            return Some(asked.ends(k)[1]);
        }
        if let Some(i) = self.times.iter().position(|&known| known == t) {
            return Some(self.values[i][k] - asked.level(k));
        }
        method.interpolate(system, t, &mut self.state).ok()?;
        let i = self.times.len();
        if self.values.len() <= i {
            self.values.push(vec![0.0; self.bounds.len()]);
        }
        self.times.push(t);
        system.watch(self.what, (t, &self.state), &mut self.values[i]);
        Some(self.values[i][k] - asked.level(k))
    }
}

/// Returns what bounds of one of them and its values at both ends of a stretch of length `h` show;
/// `begins`: whether it is put there onto the side on which it is held.
fn of_one(
    k: usize,
    Bounds { re, eps }: Bounds,
    asked: Asked<'_>,
    values: [f64; 2],
    h: f64,
    begins: bool,
) -> Shown {
    let side = f64::from(asked.sides[k]);
    let [mut a, b] = values.map(|g| side * g);
    if begins {
        a = a.max(0.0);
    }
    let (re, rate) = (re - Interval::constant(asked.level(k)), eps[0]);
    match course(ordered(re, side).0, ordered(rate, side), [a, b], h) {
        // division would end at the shortest stretch only
        Shown::Nothing if b < 0.0 && h < SHORT * asked.step.h && !is_finite(rate) => Shown::Event,
        shown => shown,
    }
}

/// Returns the length of the shortest stretch of a step that is divided no further, in s.
pub(super) fn shortest(step: &Step) -> f64 {
    (SHORTEST * step.h).max(8.0 * f64::EPSILON * step.t1.abs())
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
