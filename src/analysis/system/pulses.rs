//! Smooth pulses of functions of time, which a long step would not notice.
//!
//! A step says nothing of what lies between the places where it evaluates. A force that is zero but
//! for a hundredth of a second leaves long steps no reason to become shorter. Where such a pulse
//! begins with a break, [`TimeEvents`] knows it. A smooth one, such as a bell curve, is looked for
//! before the first step: functions that read TIME alone are evaluated at [`SAMPLES`] times. A
//! function has a pulse if it is at rest, or bends as it does nearly everywhere, then moves for a
//! short while, and then is at rest again.
//!
//! Steps end just before a pulse and at the samples within it; there error control sees it.
//! Functions that go on moving are seen without help and left alone.

use crate::analysis::system::complaints;
use crate::analysis::system::time_events::TimeEvents;
use crate::diagnostic::Diagnostic;
use crate::expr::measures::Measure;
use crate::expr::program::{Builder, Folding, Input, Program, Work};
use crate::model::ElementKind;
use crate::scene::configuration::Configured;
use crate::scene::layout::Layout;
use crate::scene::programs::record;
use crate::scene::{Entry, Scene};
use std::collections::BTreeSet;

/// Times at which functions are evaluated in search of pulses.
const SAMPLES: usize = 4096;
/// Duration of the simulation over that of the longest pulse.
const RUN_PER_PULSE: usize = 20;
/// Ends of steps within one pulse, at most.
const MAX_LANDINGS_PER_PULSE: usize = 24;
/// Ends of steps of a simulation, at most.
const MAX_LANDINGS: usize = 20_000;
/// Second difference of a function at rest, at most, as a part of the range of its values.
const REST_BEND: f64 = 1e-6;
/// Second difference within a pulse, at least, in units of the usual one.
const PULSE_BEND: f64 = 100.0;

/// Functions of a model that read TIME and nothing else.
#[derive(Clone, Debug, Default)]
pub struct Pulses {
    /// reads the time alone
    program: Option<Program>,
}

impl Pulses {
    /// Records the functions of a mechanism that read TIME alone.
    ///
    /// # Errors
    /// Functions that cannot be recorded.
    pub fn new(scene: Configured<'_>) -> Result<Self, Vec<Diagnostic>> {
        Self::of(scene, false)
    }

    /// Records the functions of the states downstream of a mechanism that read TIME alone.
    ///
    /// # Errors
    /// Functions that cannot be recorded.
    pub fn downstream(scene: Configured<'_>) -> Result<Self, Vec<Diagnostic>> {
        Self::of(scene, true)
    }

    fn of(scene: Configured<'_>, downstream: bool) -> Result<Self, Vec<Diagnostic>> {
        let of_time = timed(&scene);
        let is_read = read(&scene);
        let is_there = |f: usize| *scene.read_downstream.get(f).unwrap_or(&false) == downstream;
        let timed: Vec<usize> = (0..scene.formulas.len())
            .filter(|&f| of_time[f] && is_read[f] && is_there(f) && acts(&scene, f))
            .collect();
        if timed.is_empty() {
            return Ok(Self::default());
        }
        let all = &timed;
        let values = record(scene, |at| all.iter().map(|&f| at.formula(f)).collect());
        let values = values.map_err(complaints)?;
        let time = Input::Slot(Layout::TIME as u32);
        let mut builder = Builder::new(Folding::Strict);
        let mut watched = values.record(&mut builder);
        let mut of_time = builder.read_alone(time, &watched).into_iter();
        watched.retain(|_| of_time.next() == Some(true));
        let program = builder.finish_with_inputs(&watched, &[time]);
        Ok(Self {
            program: (!watched.is_empty()).then_some(program),
        })
    }

    /// Returns the times between two others at which a step has to end, ascending.
    pub fn landings(&self, time_events: &mut TimeEvents, start: f64, end: f64) -> Vec<f64> {
        let Some(program) = &self.program else {
            return Vec::new();
        };
        if !(end > start && (end - start).is_finite()) {
            return Vec::new();
        }
        let time = |k: usize| start + (end - start) * k as f64 / SAMPLES as f64;
        let n = program.n_outputs();
        let mut seen = vec![0.0; n * (SAMPLES + 1)];
        let mut work = Work::default();
        for (k, look) in seen.chunks_mut(n).enumerate() {
            program.run(&[time(k)], &mut work, look);
        }
        let mut found = BTreeSet::new();
        let mut values = vec![0.0; SAMPLES + 1];
        for k in 0..n {
            for (value, look) in values.iter_mut().zip(seen.chunks(n)) {
                *value = look[k];
            }
            for (from, to) in bends(&values) {
                // a step ends where something breaks, and the next one begins anew and sees the
                // pulse
                if found.len() > MAX_LANDINGS || time_events.next(time(from), time(to)) < time(to) {
                    continue;
                }
                let stride = (to - from).div_ceil(MAX_LANDINGS_PER_PULSE).max(1);
                found.extend((from..to).step_by(stride));
                found.insert(to);
            }
        }
        let inner = found.into_iter().filter(|k| (1..SAMPLES).contains(k));
        inner.map(time).collect()
    }
}

/// Returns true if a formula reads time itself and acts on the mechanism.
fn acts(scene: &Scene, f: usize) -> bool {
    let asks = [ElementKind::Request, ElementKind::Sensor];
    let element = scene.formulas[f].owner.owner();
    let acts = element.is_some_and(|e| !asks.contains(&e.kind));
    acts && scene.formulas[f].program.inputs().contains(&Input::Time)
}

/// Returns which formulas the motion or a sensor reads: all but those of requests and of VARIABLEs
/// that only requests read   (n_formulas)
fn read(scene: &Scene) -> Vec<bool> {
    let reads_for_others = [ElementKind::Request, ElementKind::Variable];
    let of = |f: usize| scene.formulas[f].owner.owner();
    let is_root = |&f: &usize| of(f).is_none_or(|e| !reads_for_others.contains(&e.kind));
    let listed = scene
        .arrays
        .values()
        .flatten()
        .filter_map(|entry| match entry {
            Entry::Formula(f) => Some(*f),
            Entry::Number(_) | Entry::State(_) => None,
        });
    let mut open: Vec<usize> = (0..scene.formulas.len())
        .filter(is_root)
        .chain(listed)
        .collect();
    let mut read = vec![false; scene.formulas.len()];
    while let Some(f) = open.pop() {
        if std::mem::replace(&mut read[f], true) {
            continue;
        }
        for input in scene.formulas[f].program.inputs() {
            if let Input::Measure(Measure::Varval, [id, ..]) = input {
                open.extend(scene.variables.get(id));
            }
        }
    }
    read
}

/// Returns which formulas depend on time alone, if need be through VARIABLEs   (n_formulas)
fn timed(scene: &Scene) -> Vec<bool> {
    let n = scene.formulas.len();
    // how many VARIABLEs a formula still waits for; none that reads anything else ever ends to
    let (mut waits, mut readers) = (vec![0; n], vec![Vec::new(); n]);
    for (f, formula) in scene.formulas.iter().enumerate() {
        for input in formula.program.inputs() {
            let read = match input {
                Input::Time | Input::Mode => continue,
                Input::Measure(Measure::Varval, [id, ..]) => scene.variables.get(id),
                Input::Measure(..) | Input::Delayed(_) | Input::Slot(_) => None,
            };
            waits[f] += 1;
            if let Some(&v) = read {
                readers[v].push(f);
            }
        }
    }
    let mut timed = vec![false; n];
    let mut ready: Vec<usize> = (0..n).filter(|&f| waits[f] == 0).collect();
    while let Some(f) = ready.pop() {
        timed[f] = true;
        for &reader in &readers[f] {
            waits[reader] -= 1;
            if waits[reader] == 0 {
                ready.push(reader);
            }
        }
    }
    timed
}

/// Finds the pulses of a function: from the sample just before to the one just after each.
fn bends(values: &[f64]) -> Vec<(usize, usize)> {
    let finite = values.iter().filter(|x| x.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| {
        (l.min(x), h.max(x))
    });
    if low >= high {
        return Vec::new();
    }
    let bend: Vec<f64> = values
        .windows(3)
        .map(|w| (w[0] - 2.0 * w[1] + w[2]).abs())
        .collect();
    let mut sorted: Vec<f64> = bend.iter().copied().filter(|b| b.is_finite()).collect();
    let middle = sorted.len() / 2;
    if sorted.is_empty() {
        return Vec::new();
    }
    let usual = *sorted.select_nth_unstable_by(middle, f64::total_cmp).1;
    let threshold = (PULSE_BEND * usual).max(REST_BEND * (high - low));
    let mut out: Vec<(usize, usize)> = Vec::new();
    // bend k is that at look k + 1
    for k in (0..bend.len()).filter(|&k| bend[k] > threshold) {
        match out.last_mut() {
            // what pauses for a few looks is one pulse
            Some(last) if k <= last.1 + 4 => last.1 = k + 2,
            _ => out.push((k, k + 2)),
        }
    }
    // a single corner is no pulse: what comes after it is seen from there on
    out.retain(|(from, to)| {
        to - from <= values.len() / RUN_PER_PULSE && (to - from > 3 || values[*from] == values[*to])
    });
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(n: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..=n).map(|k| f(k as f64 / n as f64)).collect()
    }

    #[test]
    fn a_short_hump_is_a_pulse_on_any_ground() {
        let hump = |t: f64| (-((t - 0.5) / 0.003).powi(2)).exp();
        for ground in [
            |_: f64| 0.0,
            |t: f64| 3.0 * t - 1.0,
            |t: f64| (5.0 * t).sin(),
        ] {
            let found = bends(&over(4096, |t| hump(t) + ground(t)));
            assert_eq!(found.len(), 1, "{found:?}");
            let (from, to) = found[0];
            assert!(from < 2048 && 2048 < to && to - from < 100);
        }
        for smooth in [
            |t: f64| (300.0 * t).sin(),
            |t: f64| t * t,
            |_: f64| 2.0,
            |t: f64| (t - 0.5).max(0.0),
        ] {
            assert!(bends(&over(4096, smooth)).is_empty());
        }
    }
}
