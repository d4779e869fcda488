//! Switches: which branch of each force and differential equation holds, and where in a step it
//! ends.
//!
//! ```text
//! branches held → step → near a switch? → scan the interpolant → undo, step up to the switch → branches change, begin anew
//! ```
//!
//! While branches are held the rates are smooth, also where a step leads beyond the end of a
//! branch: no step is rejected because of a switch inside it, and the interpolant on which the
//! switch is located is as exact as the method. Whether one comes to zero within a step is told by
//! bounds of its value and rate (`bounded_switches.rs`). What has no bounds (closures, delays,
//! unknowns of loops) is seen from values and slopes at both ends of a step:
//!
//! ```text
//! |g| > h max |ġ|   at both ends        so that g cannot have come to zero
//! ```
//!
//! Of others many are seen to stay on their side by what the method knows of the middle of the
//! step: where the cubic through both ends leads through the value there, it stands for g, and its
//! control points say on which side it is. Outlines of contacts that may meet within the step are
//! looked for on the interpolant anyway: from afar their gap has no value.
//!
//! Where both branches of a function lead back to where it changes (dry friction by SIGN, at rest),
//! the motion stays there: the switch *slides*, see `system/sliding.rs`. While it does, its value
//! is how far the mean of the branches is from either of them; the motion goes on along one when
//! that comes to zero.
//!
//! Some switch for ever all the same (a relay that reads a position). After a burst of forty
//! switches the branches are let go for twenty steps, and error control finds its way. The same is
//! done where no step is possible while they are held. Where that leads nowhere, the run ends:
//! [`Switches::endless`]. So it does where switches come ever faster and never would end,
//! [`never_end`], and where one chatters (`chatter.rs`).

use crate::analysis::system::System;
use crate::analysis::system::bounds::What;
use crate::analysis::time::bounded_switches::{Asked, BoundedSwitches, SHORT, Seen, Whole};
use crate::analysis::time::chatter::Chatter;
use crate::numeric::event::{Locator, sign};
use crate::numeric::subdivision::Shown;
use crate::numeric::{Failure, Method, Step};
use crate::scalar::Scalar;

/// Switches in a row, each within [`BURST_DURATION`] of the one before, after which branches are
/// let go.
const BURST_SWITCHES: usize = 40;
/// Time between the switches of a burst, at most, as a part of the duration of the run.
const BURST_DURATION: f64 = 1e-7;
/// Steps during which branches are let go.
const REST_STEPS: usize = 20;
/// Time from one burst to the next, at most, if they are to count as in a row; a part of the
/// duration of the run, in which twenty steps should come further.
const REST_DURATION: f64 = 1e-3;
/// Bursts in a row after which the run ends.
const MAX_BURSTS: usize = 50;
/// Distance from zero where a switch was to be, as a part of the way within the step, that is more
/// than rounding and error.
const LANDING_TOLERANCE: f64 = 0.1;
/// Distance from zero after the shortest step, as a part of the change within the longer step that
/// found the switch, that is none.
const NO_DISTANCE: f64 = 1e-6;
/// Length below which no step is shortened because of a switch or a peak, as a part of the duration
/// of the run: at time 0 there is always a shorter one, and a function whose branches are noise
/// would lead there.
pub(super) const SHORTEST_STEP: f64 = 1e-13;
/// Distance of a value in the middle of a step from the cubic through its ends, as a part of the
/// span of the control points of that, up to which the cubic stands for the values between.
const CUBIC_TOLERANCE: f64 = 0.05;
/// Distance from zero of the control points behind the beginning, over the same distance: three
/// times what a course of order four could need.
const CLEAR_OF_ZERO: f64 = 4.0;
/// Distance from zero at the beginning of a step, as a part of the largest control point, or where
/// a switch was to be, as a part of the way within the step, that is rounding.
const AT_ZERO: f64 = 1e-9;
/// Steps that are repeated because of one switch, at most.
const MAX_REDONE: usize = 30;
/// Halvings of one step because its interpolant has no value, at most.
const MAX_HALVED: usize = 4;
/// Rounds in which the branches are made to fit each other, at most.
const MAX_SETTLING: usize = 10;

/// Events from which on it is looked whether they come ever faster.
const MANY_EVENTS: usize = 1024;
/// Time in which the number of events doubles, over that in which it doubled before, below which
/// it grows exponentially: with the fifth power of the time the quotient is 1.15.
const DOUBLES_AS_FAST: f64 = 1.15;
/// Events of a run that are not waited for.
const TOO_MANY_EVENTS: f64 = 1e8;

/// Returns whether events come ever faster, so that a run to its `end` would never get there: a
/// damped motion about a displacement at which a force changes its sign swings ever more quickly.
///
/// ```text
/// n events at t, half of them at t½, a quarter at t¼
/// t − t½ < 1.15 (t½ − t¼)         their number grows exponentially, and
/// n 2^((end − t)/(t − t½)) > 10⁸
/// ```
pub fn never_end(events: &[f64], end: f64) -> bool {
    let n = events.len();
    if n < MANY_EVENTS || !n.is_power_of_two() {
        return false;
    }
    let [quarter, half, now] = [n / 4, n / 2, n].map(|k| events[k - 1]);
    let doubling = now - half;
    let expected = n as f64 * Scalar::powf(2.0, (end - now) / doubling);
    doubling < DOUBLES_AS_FAST * (half - quarter) && expected > TOO_MANY_EVENTS
}

/// The verdict on a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// no branch ended in it
    Keep,
    /// a branch ended in it, then: undo it, and step up to there
    Redo(f64),
    /// a branch ends at its end: begin anew there, with [`Switches::change`]
    Switched,
}

/// The switches of a system along a run.
#[derive(Debug)]
pub struct Switches {
    locator: Locator,
    /// sides now held, or to be held from the switch on   (n)
    sides: Vec<i8>,
    next: Vec<i8>,
    /// which of them slide; these are on the positive side of how far they do   (n)
    slides: Vec<bool>,
    /// values and slopes at the beginning and at the end of a step   (n each)
    g0: Vec<f64>,
    slope0: Vec<f64>,
    g1: Vec<f64>,
    slope1: Vec<f64>,
    /// values in the middle of a step   (n)
    middle: Vec<f64>,
    /// a state nearby   (size of the system)
    probe: Vec<f64>,
    /// where the step under way is to end
    landing: Option<f64>,
    /// longest step whose interpolant is to be trusted, in s
    trusted: f64,
    /// change of each value within the longer step that said so   (n)
    swings: Vec<f64>,
    redone: usize,
    burst: usize,
    last: f64,
    /// bursts in a row, and the time of the last one
    bursts: usize,
    last_burst: f64,
    worst: usize,
    rest: usize,
    chatter: Chatter,
    /// those that can be bounded
    bounded: BoundedSwitches,
    /// the side of each that is asked for in the step under way, else 0   (n)
    asked: Vec<i8>,
    /// which of them bounds have shown to stay on their sides in the step under way   (n)
    shown: Vec<bool>,
    duration: f64,
}

impl Switches {
    /// Prepares the switches of a system whose state has `size` numbers, for a run of some
    /// duration.
    pub fn new(system: &mut System, size: usize, duration: f64) -> Self {
        let n = system.branches().len();
        Self {
            locator: Locator::new(n),
            sides: vec![0; n],
            next: vec![0; n],
            slides: vec![false; n],
            g0: vec![0.0; n],
            slope0: vec![0.0; n],
            g1: vec![0.0; n],
            slope1: vec![0.0; n],
            middle: vec![0.0; n],
            probe: vec![0.0; size],
            landing: None,
            trusted: f64::INFINITY,
            swings: vec![0.0; n],
            redone: 0,
            burst: 0,
            last: f64::NEG_INFINITY,
            bursts: 0,
            last_burst: f64::NEG_INFINITY,
            worst: 0,
            rest: 0,
            chatter: Chatter::default(),
            bounded: BoundedSwitches::new(system, What::Switches, n),
            asked: Vec::with_capacity(n),
            shown: vec![false; n],
            duration,
        }
    }

    /// Returns whether there is nothing to watch.
    pub fn none(&self) -> bool {
        self.sides.is_empty()
    }

    /// Finds the branches at the start of a run and holds them.
    pub fn start(&mut self, system: &mut System, t: f64, y: &[f64]) {
        if self.none() {
            return;
        }
        self.rest = 0;
        self.landing = None;
        system.branches_mut().hold(&self.sides);
        self.next.fill(0);
        self.slides.fill(false);
        self.settle(system, t, y);
    }

    /// Returns whether something slides.
    pub fn slide(&self) -> bool {
        self.slides.contains(&true)
    }

    /// Returns the unknown that branches change most where they change without end and the run
    /// comes no further, or one chatters and would until the `end`.
    pub fn endless(&self, t: f64, end: f64) -> Option<usize> {
        let endless = self.bursts > MAX_BURSTS || self.chatter.is_endless(t, end);
        endless.then_some(self.worst)
    }

    /// Takes note of the switch at the state, if it is one alone.
    fn see_chatter(&mut self, system: &mut System, t: f64, y: &[f64]) {
        let mut switched = (0..self.next.len()).filter(|&k| self.next[k] != 0);
        if let (Some(k), None) = (switched.next(), switched.next()) {
            self.chatter.see(system, (t, y), k, self.next[k]);
            if self.chatter.is_long() {
                self.worst = system.changed_most_by(t, y, k);
            }
        }
    }

    /// Returns the unknown that changes most by the switch at the state; `None`: there is none.
    pub fn changes_most(&self, system: &mut System, t: f64, y: &[f64]) -> Option<usize> {
        let k = self.next.iter().position(|&side| side != 0)?;
        Some(system.changed_most_by(t, y, k))
    }

    /// Takes over the branches from a switch on, before the method begins anew there. Where the
    /// motion stays, the state is put there.
    pub fn change(&mut self, system: &mut System, t: f64, y: &mut [f64]) {
        self.landing = None;
        self.redone = 0;
        self.see_chatter(system, t, y);
        if t - self.last < BURST_DURATION * self.duration {
            self.burst += 1;
        } else {
            self.burst = 0;
        }
        self.last = t;
        if self.burst > BURST_SWITCHES {
            let further = t - self.last_burst > REST_DURATION * self.duration;
            self.bursts = if further { 1 } else { self.bursts + 1 };
            self.last_burst = t;
            self.burst = 0;
            self.rest = REST_STEPS;
            self.slides.fill(false);
            self.worst = self.changes_most(system, t, y).unwrap_or(self.worst);
            system.branches_mut().release();
            return;
        }
        for k in 0..self.sides.len() {
            if self.next[k] == 0 {
                continue;
            }
            if self.slides[k] {
                self.next[k] = system.side_left_to(t, y, k);
                self.slides[k] = false;
            } else if system.attracts(t, y, k) {
                self.slides[k] = true;
            }
            self.hold(system);
            if self.slides[k] {
                system.stay(t, y);
            }
        }
        self.settle(system, t, y);
    }

    /// Holds the branches on their sides, except where they slide.
    fn hold(&mut self, system: &mut System) {
        self.bounded.forget();
        system.branches_mut().hold(&self.sides);
        system
            .branches_mut()
            .slide((0..self.slides.len()).filter(|&k| self.slides[k]));
    }

    /// Lets the branches go for a while where no step is possible while they are held: beyond its
    /// end a branch may grow without bound (a ramp much shorter than any step). False: they were
    /// not held.
    pub fn let_go(&mut self, system: &mut System) -> bool {
        if self.none() || self.rest > 0 || !system.branches().can_hold() {
            return false;
        }
        self.landing = None;
        self.redone = 0;
        self.rest = REST_STEPS;
        self.slides.fill(false);
        system.branches_mut().release();
        true
    }

    /// Holds the branches that fit the state: `next` where it says a side, else the sign there.
    fn settle(&mut self, system: &mut System, t: f64, y: &[f64]) {
        self.sides.copy_from_slice(&self.next);
        for _ in 0..MAX_SETTLING {
            self.hold(system);
            system.switches(t, y, &mut self.g0);
            let mut changed = false;
            for k in 0..self.sides.len() {
                let side = if self.slides[k] {
                    1
                } else if self.next[k] == 0 {
                    sign(self.g0[k])
                } else {
                    self.next[k]
                };
                changed |= side != self.sides[k];
                self.sides[k] = side;
            }
            if !changed {
                break;
            }
        }
        self.hold(system);
    }

    /// Puts values on no side onto the one they leave to, and finds the slopes at the state. True:
    /// a side was taken, the rate is another.
    pub fn look_ahead(&mut self, system: &mut System, t: f64, y: &[f64], ydot: &[f64]) -> bool {
        if self.none() || self.rest > 0 {
            return false;
        }
        let delta = 1e-9 * self.duration;
        self.slopes(system, t, y, ydot, delta);
        self.slope0.copy_from_slice(&self.slope1);
        system.switches(t, y, &mut self.g0);
        let mut changed = false;
        for k in 0..self.sides.len() {
            if self.sides[k] != 0 || self.slope0[k] == 0.0 {
                continue;
            }
            changed = true;
            if system.attracts(t, y, k) {
                self.slides[k] = true;
                self.sides[k] = 1;
            } else {
                self.sides[k] = sign(self.slope0[k]);
            }
            self.hold(system);
        }
        if changed {
            system.switches(t, y, &mut self.g0);
            self.bounded.take_loops(system);
        }
        self.bounded.begin(y, ydot);
        self.locator.begin_on(&self.g0, &self.sides);
        changed
    }

    /// Evaluates values at the state into `g1`, slopes into `slope1`.
    fn slopes(&mut self, system: &mut System, t: f64, y: &[f64], ydot: &[f64], delta: f64) {
        for ((p, y), f) in self.probe.iter_mut().zip(y).zip(ydot) {
            *p = y + delta * f;
        }
        system.switches(t, y, &mut self.g1);
        self.bounded.take_loops(system);
        system.switches(t + delta, &self.probe, &mut self.slope1);
        self.bounded.take_rates_of_loops(system, delta);
        for (slope, g) in self.slope1.iter_mut().zip(&self.g1) {
            *slope = (*slope - g) / delta;
        }
    }

    /// Returns how long the next step may be.
    pub fn longest_step(&self) -> f64 {
        self.trusted
    }

    /// Judges the step just taken: whether a branch ended in it.
    pub fn judge(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
    ) -> Verdict {
        if self.none() {
            return Verdict::Keep;
        }
        if self.rest > 0 {
            return self.judge_at_rest(step);
        }
        // far from all switches, or at one that was to be met
        let was_to_land = self.landing.take() == Some(step.t1);
        let (y, ydot) = (method.y(), method.ydot());
        self.slopes(system, step.t1, y, ydot, 1e-4 * step.h);
        let landed = was_to_land && self.has_landed(step);
        // the longer step saw what is not there: the next ones grow from this one
        self.trusted = match was_to_land && !landed {
            true => step.h / SHORT,
            false => self.trusted / SHORT,
        };
        let named = match self.look_at_bounded(system, method, step, landed) {
            Seen::Nothing | Seen::Unknown => None,
            Seen::Look(named) => Some(named),
            Seen::Short(to) => {
                self.next.fill(0);
                return Verdict::Redo(to);
            }
        };
        let seen_from_ends = named.is_none() && !system.is_surprised(step.h);
        if seen_from_ends
            && (!self.is_near(step.h, landed) || self.is_clear(system, method, step, landed))
        {
            if landed {
                return Verdict::Switched;
            }
            self.keep(method);
            return Verdict::Keep;
        }
        // the first switch on the interpolant
        let at = match self.scan(system, method, step, named.as_deref().unwrap_or_default()) {
            Ok(Some(at)) => at,
            Ok(None) if landed => return Verdict::Switched,
            Ok(None) => {
                self.sides.copy_from_slice(self.locator.sides());
                self.keep(method);
                return Verdict::Keep;
            }
            // the interpolant has no value somewhere: that of a shorter step may, or begin anew at
            // the end
            Err(_) if self.redone < MAX_HALVED => {
                self.redone += 1;
                self.next.fill(0);
                return Verdict::Redo(0.5 * (step.t0 + step.t1));
            }
            Err(_) => {
                self.next.fill(0);
                return Verdict::Switched;
            }
        };
        self.judge_crossing(at, step, landed)
    }

    /// Looks at the switches that can be bounded, but for those at which the step `landed`.
    fn look_at_bounded(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
        landed: bool,
    ) -> Seen {
        self.shown.fill(false);
        if self.slide() {
            return self.bounded.look_at_clocks(system, step);
        }
        let all = self.sides.iter().zip(&self.next);
        let asked = |(&side, &next)| if landed && next != 0 { 0 } else { side };
        self.asked.clear();
        self.asked.extend(all.map(asked));
        let seen = self.look_at_asked(system, method, step);
        if seen == Seen::Nothing {
            for (k, shown) in self.shown.iter_mut().enumerate() {
                *shown = self.asked[k] != 0 && self.bounded.has(k);
            }
        }
        seen
    }

    /// Looks at the switches that are asked for by bounds, from afar and more closely.
    fn look_at_asked(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
    ) -> Seen {
        let asked = Asked {
            step,
            sides: &self.asked,
            levels: &[],
            values: [&self.g0, &self.g1],
            slopes: Some([&self.slope0, &self.slope1]),
        };
        if self.bounded.are_far(system, method, asked) {
            return Seen::Nothing;
        }
        let whole = self.bounded.look_at_whole(system, method, asked);
        let shown = match whole {
            Whole::Free => Shown::Free,
            Whole::Event => Shown::Event,
            // error control has made the states smooth, not what time does
            Whole::Resolved if system.recorded.clocks.are_steady(step.t0, step.t1) => {
                self.middle_tells(system, method, step)
            }
            Whole::Resolved | Whole::Open => Shown::Nothing,
        };
        match shown {
            Shown::Free => Seen::Nothing,
            Shown::Event => Seen::Look(vec![step.t1]),
            Shown::Until(_) | Shown::Nothing => {
                let asked = Asked {
                    step,
                    sides: &self.asked,
                    levels: &[],
                    values: [&self.g0, &self.g1],
                    slopes: Some([&self.slope0, &self.slope1]),
                };
                let seen = self.bounded.look_at_stretches(system, method, asked);
                // where the interpolant has no value, the scan says so, too
                seen.unwrap_or(Seen::Look(Vec::new()))
            }
        }
    }

    /// Returns what the middle of a step tells of the switches that are open.
    fn middle_tells(
        &mut self,
        system: &mut System,
        method: &dyn Method<System>,
        step: &Step,
    ) -> Shown {
        if !method.middle(&mut self.probe) {
            return Shown::Nothing;
        }
        let middle = 0.5 * (step.t0 + step.t1);
        system.switches(middle, &self.probe, &mut self.middle);
        let mut all = Shown::Free;
        for &k in self.bounded.open() {
            match self.cubic_tells(k, step.h) {
                Shown::Free => {}
                Shown::Event => all = Shown::Event,
                Shown::Until(_) | Shown::Nothing => return Shown::Nothing,
            }
        }
        all
    }

    /// Returns what the cubic of a switch tells, by its values at the ends of a step and in its
    /// middle.
    fn cubic_tells(&self, k: usize, h: f64) -> Shown {
        let side = f64::from(self.sides[k]);
        let values = [&self.g0, &self.middle, &self.g1].map(|g| side * g[k]);
        let slopes = [&self.slope0, &self.slope1].map(|slope| side * slope[k]);
        course(values, slopes.map(|slope| h * slope))
    }

    /// Counts a step during which branches are let go; after the last one they are found anew.
    fn judge_at_rest(&mut self, step: &Step) -> Verdict {
        self.rest -= 1;
        if self.rest > 0 {
            return Verdict::Keep;
        }
        self.next.fill(0);
        self.last = step.t1;
        Verdict::Switched
    }

    /// Returns whether a switch may have come to zero within a step; those at which it `landed`
    /// have.
    fn is_near(&self, h: f64, landed: bool) -> bool {
        (0..self.sides.len()).any(|k| !self.is_far(k, h, landed))
    }

    /// Returns whether a switch cannot have come to zero within a step, or has where it `landed`.
    fn is_far(&self, k: usize, h: f64, landed: bool) -> bool {
        if self.shown[k] || landed && self.next[k] != 0 {
            return true;
        }
        let steepest = self.steepest(k);
        let least = self.g0[k].abs().min(self.g1[k].abs());
        let far = sign(self.g1[k]) == self.sides[k] && least > h * steepest;
        // a value that stays zero is on no side
        far || self.sides[k] == 0 && self.g1[k] == 0.0 && self.slope1[k] == 0.0
    }

    /// Returns the larger of the slopes of a switch at both ends of a step.
    fn steepest(&self, k: usize) -> f64 {
        self.slope0[k].abs().max(self.slope1[k].abs())
    }

    /// Returns whether all switches that may have come to zero within a step stay on their sides,
    /// as far as their values in its middle tell.
    fn is_clear(
        &mut self,
        system: &mut System,
        method: &dyn Method<System>,
        step: &Step,
        landed: bool,
    ) -> bool {
        // where one has changed its side, or came to zero elsewhere, there is no need to ask
        let crossed = |k: usize| match landed && self.next[k] != 0 {
            true => self.g1[k].abs() > AT_ZERO * step.h * self.steepest(k),
            false => sign(self.g1[k]) != self.sides[k] && !self.is_far(k, step.h, landed),
        };
        if self.slide() || (0..self.sides.len()).any(crossed) || !method.middle(&mut self.probe) {
            return false;
        }
        let middle = 0.5 * (step.t0 + step.t1);
        system.switches(middle, &self.probe, &mut self.middle);
        let stays = |k: usize| self.cubic_tells(k, step.h) == Shown::Free;
        (0..self.sides.len()).all(|k| self.is_far(k, step.h, landed) || stays(k))
    }

    /// Finds the first switch within a step on its interpolant; `named`: times to look at, between
    /// which those that can be bounded do not come to zero and go back.
    fn scan(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
        named: &[f64],
    ) -> Result<Option<f64>, Failure> {
        // what is on no side may leave it anywhere
        let is_known = |(k, &asked): (usize, &i8)| match asked {
            0 => self.next[k] != 0,
            _ => self.bounded.has(k),
        };
        let all_known =
            !self.slide() && !named.is_empty() && self.asked.iter().enumerate().all(is_known);
        let state = &mut self.probe;
        let ends = (step.t0, step.t1);
        let values = |t: f64, values: &mut [f64]| {
            if t == step.t1 {
                state.copy_from_slice(method.y());
            } else {
                method.interpolate(system, t, state)?;
            }
            system.switches(t, state, values);
            Ok::<(), Failure>(())
        };
        match all_known {
            true => self.locator.scan_named(ends, named, values),
            false => self.locator.scan(ends, named, values),
        }
    }

    /// Decides about a step in which switches were crossed: it stays when they were at its end.
    fn judge_crossing(&mut self, at: f64, step: &Step, landed: bool) -> Verdict {
        let shortest = step.t0 + SHORTEST_STEP * self.duration;
        let at = at.max(shortest).min(step.t1);
        let at_end = step.t1 - at <= 1e-14 * step.t1.abs() + 1e-9 * step.h;
        if !(landed && at_end) {
            self.next.fill(0);
        }
        for &k in self.locator.crossed() {
            self.next[k] = self.locator.sides()[k];
        }
        if at_end || self.redone >= MAX_REDONE {
            return Verdict::Switched;
        }
        self.redone += 1;
        self.landing = Some(at);
        let ends = self.g1.iter().zip(&self.g0);
        (self.swings.iter_mut().zip(ends)).for_each(|(swing, (a, b))| *swing = (a - b).abs());
        self.locator.begin_on(&self.g0, &self.sides);
        Verdict::Redo(at)
    }

    /// Returns whether what was to switch at the end of a step is there at zero. The steps that
    /// said so may have been much longer than their method could see, and their interpolants wrong.
    /// After the shortest step a value counts as zero that is nothing beside its change in the
    /// longer one: there its distance from zero and its slope are rounding.
    fn has_landed(&mut self, step: &Step) -> bool {
        let is_shortest = step.h <= 2.0 * SHORTEST_STEP * self.duration;
        for k in 0..self.next.len() {
            let steepest = self.steepest(k);
            let on_the_way = LANDING_TOLERANCE * step.h * steepest;
            let zero = match is_shortest {
                true => on_the_way.max(NO_DISTANCE * self.swings[k]),
                false => on_the_way,
            };
            if sign(self.g1[k]) == -self.next[k] && self.g1[k].abs() > zero {
                self.next[k] = 0;
            }
        }
        self.next.iter().any(|&side| side != 0)
    }

    /// Makes the end of a step the beginning of the next.
    fn keep(&mut self, method: &dyn Method<System>) {
        self.bounded.begin(method.y(), method.ydot());
        self.redone = 0;
        self.next.fill(0);
        self.locator.skip(&self.g1);
        std::mem::swap(&mut self.g0, &mut self.g1);
        std::mem::swap(&mut self.slope0, &mut self.slope1);
    }
}

/// Returns what is shown of a function that is to stay positive within a step, by its values where
/// that begins, in its middle and where it ends, and its slopes, per step, at both ends, if the
/// cubic through these leads through the middle.
///
/// ```text
/// g = Σ (3 over i) bᵢ xⁱ (1 − x)³⁻ⁱ + 16 d x² (1 − x)²        d: the distance in the middle
/// ```
///
/// Clear of zero, control points are on the side of the function; where they change their sign
/// once, so does it.
fn course([b0, middle, b3]: [f64; 3], slopes: [f64; 2]) -> Shown {
    let (b1, b2) = (b0 + slopes[0] / 3.0, b3 - slopes[1] / 3.0);
    let all = [b0, b1, b2, b3];
    let least = all.into_iter().fold(f64::INFINITY, f64::min);
    let largest = all.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let off = (middle - 0.125 * (b0 + 3.0 * (b1 + b2) + b3)).abs();
    let follows = off <= CUBIC_TOLERANCE * (largest - least);
    let room = CLEAR_OF_ZERO * off;
    if !follows || b0 < -AT_ZERO * largest {
        Shown::Nothing
    } else if b1.min(b2).min(b3) > room {
        Shown::Free
    } else if b3 < -room && b0.max(b1) > room && (b1 >= 0.0 || b2 <= 0.0) {
        Shown::Event
    } else {
        Shown::Nothing
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_to_stay_positive_does_and_what_crosses_crosses_once() {
        // courses of a step: a line, bent, with up to a whole swing
        let spread = |k: i32, of: f64| (f64::from(k) * of.sqrt()).fract() * 2.0 - 1.0;
        let mut told = [0; 2];
        for k in 0..20_000 {
            let [a, b, c, d, w, phase] = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0].map(|of| spread(k, of));
            let w = std::f64::consts::PI * (1.0 + w);
            let begins = f64::from(k % 3) * a.abs();
            let course = |x: f64| b * x + c * x * x + d * (w * x + 4.0 * phase).sin();
            let slope = |x: f64| b + 2.0 * c * x + d * w * (w * x + 4.0 * phase).cos();
            // every third begins at zero
            let g = |x: f64| begins + course(x) - course(0.0);
            let shown = super::course([0.0, 0.5, 1.0].map(g), [0.0, 1.0].map(slope));
            if shown == Shown::Nothing {
                continue;
            }
            told[usize::from(shown == Shown::Event)] += 1;
            let sides = (1..=1000).map(|i| g(f64::from(i) * 1e-3) > 0.0);
            let sides: Vec<bool> = sides.collect();
            let changes = sides.windows(2).filter(|pair| pair[0] != pair[1]).count();
            let expected = usize::from(shown == Shown::Event);
            assert_eq!(changes, expected, "{begins} {b} {c} {d} {w} {phase}");
            assert!(sides[0]);
        }
        assert!(told.iter().all(|&n| n > 1000), "{told:?}");
    }

    /// Returns whether a run has no end in which event n is at `time(n)`.
    fn without_end(time: impl Fn(f64) -> f64, n: u32, end: f64) -> bool {
        let events: Vec<f64> = (1..=n).map(|k| time(f64::from(k))).collect();
        never_end(&events, end)
    }

    #[test]
    fn events_that_come_exponentially_faster_have_no_end_and_others_do() {
        assert!(without_end(|n| 0.1 * n.ln(), 1024, 5.0));
        // 785 in 20 s
        assert!(!without_end(|n| 3.0 * n.ln(), 1024, 20.0));
        assert!(!without_end(|n| 1e-3 * n, 1024, 1e9));
        // ever faster, as the square of the time
        assert!(!without_end(|n| n.sqrt(), 4096, 1e9));
        assert!(!without_end(|n| 0.1 * n.ln(), 1023, 5.0));
    }
}
