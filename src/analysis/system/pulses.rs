//! Smooth pulses of functions of time, which a long step would not notice.
//!
//! A step says nothing of what lies between the places where it evaluates. A force that is zero but for a hundredth of a second leaves long
//! steps no reason to become shorter. Where such a pulse begins with a break, [`TimeEvents`] knows it. Where it is smooth, as a bell curve is, it is
//! looked for before the first step: functions that read TIME alone are looked at at [`LOOKS`] times, and one that is at rest, or bends as it does
//! nearly everywhere, moves for a short while, and does so again, has a pulse.
//!
//! Steps end just before such a while and at the looks within it; there error control sees what is going on. Functions that go on moving are seen
//! without help and left alone.

use crate::analysis::system::complaints;
use crate::analysis::system::time_events::TimeEvents;
use crate::diagnostic::Diagnostic;
use crate::expr::measures::Measure;
use crate::expr::program::{Builder, Folding, Input, Program, Work};
use crate::model::ElementKind;
use crate::scene::Scene;
use crate::scene::configuration::Configured;
use crate::scene::layout::Layout;
use crate::scene::programs::record;
use std::collections::BTreeSet;

/// Times at which functions are looked at.
const LOOKS: usize = 4096;
/// What lasts longer than the simulation divided by this is no pulse.
const SHORT: usize = 20;
/// Most ends of steps within one pulse.
const WITHIN: usize = 24;
/// Most ends of steps of a simulation.
const MOST: usize = 20_000;
/// Bends of a function smaller than this part of its range are rest.
const REST: f64 = 1e-6;
/// A function bends unusually by more than this many times its usual bend.
const UNUSUAL: f64 = 100.0;

/// Functions of a model that read TIME and nothing else.
#[derive(Debug, Default)]
pub struct Pulses {
    /// reads the time alone
    program: Option<Program>,
}

impl Pulses {
    /// Of a scene.
    ///
    /// # Errors
    /// Functions that cannot be written down.
    pub fn new(scene: Configured<'_>) -> Result<Self, Vec<Diagnostic>> {
        let timed: Vec<usize> = (0..scene.formulas.len())
            .filter(|&f| acts(&scene, f))
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
        watched.retain(|v| builder.inputs_of(&[*v]) == [time]);
        let program = builder.finish_with_inputs(&watched, &[time]);
        Ok(Self {
            program: (!watched.is_empty()).then_some(program),
        })
    }

    /// Times between two others at which a step has to end, ascending.
    pub fn landings(&self, time_events: &mut TimeEvents, start: f64, end: f64) -> Vec<f64> {
        let Some(program) = &self.program else {
            return Vec::new();
        };
        if !(end > start && (end - start).is_finite()) {
            return Vec::new();
        }
        let time = |k: usize| start + (end - start) * k as f64 / LOOKS as f64;
        let n = program.n_outputs();
        let mut seen = vec![0.0; n * (LOOKS + 1)];
        let mut work = Work::default();
        for (k, look) in seen.chunks_mut(n).enumerate() {
            program.run(&[time(k)], &mut work, look);
        }
        let mut found = BTreeSet::new();
        let mut values = vec![0.0; LOOKS + 1];
        for k in 0..n {
            for (value, look) in values.iter_mut().zip(seen.chunks(n)) {
                *value = look[k];
            }
            for (from, to) in bends(&values) {
                // where something breaks a step ends and the next one begins anew, and sees what follows
                if found.len() > MOST || time_events.next(time(from), time(to)) < time(to) {
                    continue;
                }
                let stride = (to - from).div_ceil(WITHIN).max(1);
                found.extend((from..to).step_by(stride));
                found.insert(to);
            }
        }
        let inner = found.into_iter().filter(|k| (1..LOOKS).contains(k));
        inner.map(time).collect()
    }
}

/// Whether a formula acts on what moves, and reads time alone.
fn acts(scene: &Scene, f: usize) -> bool {
    let asks = [ElementKind::Request, ElementKind::Sensor];
    let element = scene.formulas[f].element;
    let acts = element.is_some_and(|e| !asks.contains(&e.kind));
    let mut open = Vec::new();
    acts && scene.formulas[f].program.inputs().contains(&Input::Time) && timed(scene, f, &mut open)
}

fn timed(scene: &Scene, f: usize, open: &mut Vec<usize>) -> bool {
    if open.contains(&f) {
        return false;
    }
    open.push(f);
    let own = scene.formulas[f]
        .program
        .inputs()
        .iter()
        .all(|input| match input {
            Input::Time | Input::Mode => true,
            Input::Measure(Measure::Varval, [id, ..]) => {
                (scene.variables.get(id)).is_some_and(|&v| timed(scene, v, open))
            }
            Input::Measure(..) | Input::Delayed(_) | Input::Slot(_) => false,
        });
    open.pop();
    own
}

/// Looks from just before to just after a short while in which a function bends unusually.
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
    let threshold = (UNUSUAL * usual).max(REST * (high - low));
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
        to - from <= values.len() / SHORT && (to - from > 3 || values[*from] == values[*to])
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
