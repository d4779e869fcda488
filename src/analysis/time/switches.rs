//! Watching switches: which branch of each force and differential equation holds, and where in a step it ends.
//!
//! ```text
//! branches held → step → near a switch? → scan the interpolant → undo, step up to the switch → branches change, begin anew
//! ```
//!
//! While branches are held the rates are smooth, also where a step leads beyond the end of a branch: no step is rejected
//! because of a switch inside it, and the interpolant on which the switch is located is as exact as the method.
//! Most steps are far from all switches; that is seen from values and slopes at both of their ends, without the interpolant:
//!
//! ```text
//! |g| > h max |ġ|   at both ends        so that g cannot have come to zero
//! ```
//!
//! Where both branches of a function lead back to where it changes (dry friction by SIGN, at rest), the motion stays there: the switch *slides*, see
//! `system/sliding.rs`. While it does, its value is how far the mean of the branches is from either of them; it goes on along one when that comes to zero.
//!
//! What switches for ever all the same (a relay that reads a position): after forty switches in hardly any time the branches are let go for twenty steps,
//! and error control finds its way. The same is done where no step is possible while they are held. Where that leads nowhere, [`Switches::endless`].

use crate::analysis::system::System;
use crate::numeric::event::{Locator, sign};
use crate::numeric::{Failure, Method, Step};

/// Switches in hardly any time that are too many.
const BURST: usize = 40;
/// Part of the duration that is hardly any time.
const HARDLY: f64 = 1e-7;
/// Distance from zero where a switch was to be, as a part of the way within the step, that is no longer rounding and error.
const LANDED: f64 = 0.1;
/// Part of the duration that no step is shorter than because of a switch: at time 0 there is always a shorter one, and a function whose
/// branches are noise would lead there.
const SHORTEST: f64 = 1e-13;
/// Steps without watching after a burst.
const REST: usize = 20;
/// Bursts in a row, each beginning hardly any time after the one before, that lead nowhere.
const ENDLESS: usize = 50;
/// Part of the duration that is hardly any time for twenty steps.
const HARDLY_FURTHER: f64 = 1e-3;

/// What a step means for the switches.
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
    /// a state nearby   (size of the system)
    probe: Vec<f64>,
    /// where the step under way is to end
    landing: Option<f64>,
    redone: usize,
    burst: usize,
    last: f64,
    /// bursts in a row, and when the last one was
    bursts: usize,
    last_burst: f64,
    worst: usize,
    rest: usize,
    duration: f64,
}

impl Switches {
    /// For a run of some duration.
    pub fn new(system: &System, size: usize, duration: f64) -> Self {
        let n = system.n_switches();
        Self {
            locator: Locator::new(n),
            sides: vec![0; n],
            next: vec![0; n],
            slides: vec![false; n],
            g0: vec![0.0; n],
            slope0: vec![0.0; n],
            g1: vec![0.0; n],
            slope1: vec![0.0; n],
            probe: vec![0.0; size],
            landing: None,
            redone: 0,
            burst: 0,
            last: f64::NEG_INFINITY,
            bursts: 0,
            last_burst: f64::NEG_INFINITY,
            worst: 0,
            rest: 0,
            duration,
        }
    }

    /// Whether there is nothing to watch.
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
        system.hold(&self.sides);
        self.next.fill(0);
        self.slides.fill(false);
        self.settle(system, t, y);
    }

    /// Whether something slides.
    pub fn slide(&self) -> bool {
        self.slides.contains(&true)
    }

    /// Where branches change without end and without getting any further, the unknown that they change most.
    pub fn endless(&self) -> Option<usize> {
        (self.bursts > ENDLESS).then_some(self.worst)
    }

    /// Takes over the branches from a switch on; to be called before the method begins anew there. Where the motion stays, the state is put there.
    pub fn change(&mut self, system: &mut System, t: f64, y: &mut [f64]) {
        self.landing = None;
        self.redone = 0;
        if t - self.last < HARDLY * self.duration {
            self.burst += 1;
        } else {
            self.burst = 0;
        }
        self.last = t;
        if self.burst > BURST {
            let further = t - self.last_burst > HARDLY_FURTHER * self.duration;
            self.bursts = if further { 1 } else { self.bursts + 1 };
            self.last_burst = t;
            self.burst = 0;
            self.rest = REST;
            self.slides.fill(false);
            if let Some(k) = self.next.iter().position(|&side| side != 0) {
                self.worst = system.changed_most_by(t, y, k);
            }
            system.release();
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
    fn hold(&self, system: &mut System) {
        system.hold(&self.sides);
        system.slide((0..self.slides.len()).filter(|&k| self.slides[k]));
    }

    /// Lets the branches go for a while where no step is possible while they are held: beyond its end a branch may grow without
    /// bound (a ramp much shorter than any step). False: they were not held.
    pub fn let_go(&mut self, system: &mut System) -> bool {
        if self.none() || self.rest > 0 || !system.can_hold() {
            return false;
        }
        self.landing = None;
        self.redone = 0;
        self.rest = REST;
        self.slides.fill(false);
        system.release();
        true
    }

    /// Holds the branches that fit the state: `next` where it says a side, else the sign there.
    fn settle(&mut self, system: &mut System, t: f64, y: &[f64]) {
        self.sides.copy_from_slice(&self.next);
        for _ in 0..10 {
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

    /// Values on no side take the one they leave to; slopes at the state. True: a side was taken, the rate is another.
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
        }
        self.locator.begin_on(&self.g0, &self.sides);
        changed
    }

    /// Values at the state into `g1`, slopes into `slope1`.
    fn slopes(&mut self, system: &mut System, t: f64, y: &[f64], ydot: &[f64], delta: f64) {
        for ((p, y), f) in self.probe.iter_mut().zip(y).zip(ydot) {
            *p = y + delta * f;
        }
        system.switches(t, y, &mut self.g1);
        system.switches(t + delta, &self.probe, &mut self.slope1);
        for (slope, g) in self.slope1.iter_mut().zip(&self.g1) {
            *slope = (*slope - g) / delta;
        }
    }

    /// What the step just taken means.
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
            self.rest -= 1;
            if self.rest == 0 {
                self.next.fill(0);
                self.last = step.t1;
                return Verdict::Switched;
            }
            return Verdict::Keep;
        }
        let landed = self.landing.take() == Some(step.t1);
        let (y, ydot) = (method.y(), method.ydot());
        self.slopes(system, step.t1, y, ydot, 1e-4 * step.h);
        let landed = landed && self.has_landed(step.h);
        let near = (0..self.sides.len()).any(|k| {
            if landed && self.next[k] != 0 {
                return false;
            }
            let steepest = self.slope0[k].abs().max(self.slope1[k].abs());
            let least = self.g0[k].abs().min(self.g1[k].abs());
            let far = sign(self.g1[k]) == self.sides[k] && least > step.h * steepest;
            // a value that stays zero is on no side
            !(far || self.sides[k] == 0 && self.g1[k] == 0.0 && self.slope1[k] == 0.0)
        });
        if !near {
            if landed {
                return Verdict::Switched;
            }
            self.keep();
            return Verdict::Keep;
        }
        let mut state = std::mem::take(&mut self.probe);
        let event = self.locator.scan(step.t0, step.t1, |t, values| {
            if t == step.t1 {
                state.copy_from_slice(method.y());
            } else {
                method.interpolate(system, t, &mut state)?;
            }
            system.switches(t, &state, values);
            Ok::<(), Failure>(())
        });
        self.probe = state;
        let at = match event {
            Ok(Some(at)) => at,
            Ok(None) if landed => return Verdict::Switched,
            Ok(None) => {
                self.sides.copy_from_slice(self.locator.sides());
                self.keep();
                return Verdict::Keep;
            }
            // the interpolant has no value somewhere: begin anew at the end
            Err(_) => {
                self.next.fill(0);
                return Verdict::Switched;
            }
        };
        let at = at.max(step.t0 + SHORTEST * self.duration).min(step.t1);
        let at_end = step.t1 - at <= 1e-14 * step.t1.abs() + 1e-9 * step.h;
        if !(landed && at_end) {
            self.next.fill(0);
        }
        for &k in self.locator.crossed() {
            self.next[k] = self.locator.sides()[k];
        }
        if at_end || self.redone >= 30 {
            return Verdict::Switched;
        }
        self.redone += 1;
        self.landing = Some(at);
        self.locator.begin_on(&self.g0, &self.sides);
        Verdict::Redo(at)
    }

    /// Whether what was to switch at the end of a step is there at zero, as far as the steps that said so were right: one of them may have been much
    /// longer than its method could see, and its interpolant wrong.
    fn has_landed(&mut self, h: f64) -> bool {
        for k in 0..self.next.len() {
            let steepest = self.slope0[k].abs().max(self.slope1[k].abs());
            if sign(self.g1[k]) == -self.next[k] && self.g1[k].abs() > LANDED * h * steepest {
                self.next[k] = 0;
            }
        }
        self.next.iter().any(|&side| side != 0)
    }

    /// The end of a step becomes the beginning of the next.
    fn keep(&mut self) {
        self.redone = 0;
        self.next.fill(0);
        self.locator.skip(&self.g1);
        std::mem::swap(&mut self.g0, &mut self.g1);
        std::mem::swap(&mut self.slope0, &mut self.slope1);
    }
}
