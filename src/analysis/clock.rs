//! What happens at known times and is over soon: pulses of functions of time, which a long step would not notice.
//!
//! A step says nothing of what lies between the places where it evaluates. A force that is zero but for a hundredth of a second leaves long
//! steps no reason to become shorter, neither by its value nor by a branch that ends and begins again within one step. Functions that read TIME alone
//! can be looked at before the first step, at [`LOOKS`] times:
//!
//! ```text
//! a switch         is on the other side for a short while, and comes back
//! a function       is at rest, or bends as it does nearly everywhere, moves for a short while, and does so again
//! ```
//!
//! Steps end just before such a while and at the looks within it; there error control and the search for switches see what is going on.
//! Switches that come once, and functions that go on moving, are seen without help and left alone.

use super::system::complaints;
use crate::diagnostic::Diagnostic;
use crate::expr::measures::Measure;
use crate::expr::program::{Builder, Folding, Input, Program, Work};
use crate::scene::Scene;
use crate::scene::layout::Layout;
use crate::scene::programs::record;
use std::collections::BTreeSet;

/// Times at which functions are looked at.
const LOOKS: usize = 4096;
/// How many times closer they are where a switch changes [`OFTEN`]: pulses that come again and again may be shorter still.
const CLOSER: usize = 16;
/// Changes of a switch that are many.
const OFTEN: usize = 8;
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

/// Functions and switches of a model that read TIME and nothing else.
#[derive(Debug, Default)]
pub struct Clock {
    /// switches first; reads the time alone
    program: Option<Program>,
    switches: usize,
}

impl Clock {
    /// Of a scene, and the values whose signs say which branches hold.
    ///
    /// # Errors
    /// Functions that cannot be written down.
    pub fn new(scene: &Scene, switches: Option<&Program>) -> Result<Self, Vec<Diagnostic>> {
        let timed: Vec<usize> = (0..scene.formulas.len())
            .filter(|&f| acts(scene, f))
            .collect();
        let functions = if timed.is_empty() {
            None
        } else {
            let all = &timed;
            let values = record(scene, |at| all.iter().map(|&f| at.formula(f)).collect());
            Some(values.map_err(complaints)?)
        };
        let time = Input::Slot(Layout::TIME as u32);
        let mut builder = Builder::new(Folding::Strict);
        let mut of_time = |program: Option<&Program>| -> Vec<_> {
            let values = program.map_or_else(Vec::new, |p| p.record(&mut builder));
            let own = |v: &_| builder.inputs_of(&[*v]) == [time];
            values.into_iter().filter(own).collect()
        };
        let mut watched = of_time(switches);
        let n = watched.len();
        watched.extend(of_time(functions.as_ref()));
        let program = builder.finish_with_inputs(&watched, &[time]);
        Ok(Self {
            program: (!watched.is_empty()).then_some(program),
            switches: n,
        })
    }

    /// Times between two others at which a step has to end, ascending.
    pub fn landings(&self, start: f64, end: f64) -> Vec<f64> {
        match &self.program {
            Some(program) if end > start && (end - start).is_finite() => {
                self.pulses(program, [start, end], LOOKS)
            }
            _ => Vec::new(),
        }
    }

    fn pulses(&self, program: &Program, [start, end]: [f64; 2], looks: usize) -> Vec<f64> {
        let time = |k: usize| start + (end - start) * k as f64 / looks as f64;
        let n = program.n_outputs();
        let mut seen = vec![0.0; n * (looks + 1)];
        let mut work = Work::default();
        for (k, look) in seen.chunks_mut(n).enumerate() {
            program.run(&[time(k)], &mut work, look);
        }
        let (mut found, mut switched) = (BTreeSet::new(), BTreeSet::new());
        let mut values = vec![0.0; looks + 1];
        for k in 0..n {
            for (value, look) in values.iter_mut().zip(seen.chunks(n)) {
                *value = look[k];
            }
            let pulses = if k < self.switches {
                let (once, pulses) = crossings(&values);
                if looks == LOOKS && once.len() + 2 * pulses.len() > OFTEN {
                    return self.pulses(program, [start, end], CLOSER * looks);
                }
                switched.extend(once);
                pulses
            } else {
                // a step that ends at a switch begins anew there, and sees what follows
                let unseen = |p: &(usize, usize)| !(p.0..=p.0 + 2).any(|k| switched.contains(&k));
                bends(&values).into_iter().filter(unseen).collect()
            };
            for (from, to) in pulses {
                if found.len() > MOST {
                    break;
                }
                let stride = (to - from).div_ceil(WITHIN).max(1);
                found.extend((from..to).step_by(stride));
                found.insert(to);
            }
        }
        let inner = found.into_iter().filter(|k| (1..looks).contains(k));
        inner.map(time).collect()
    }
}

/// Whether a formula acts on what moves, and reads time alone.
fn acts(scene: &Scene, f: usize) -> bool {
    const ASK: [&str; 2] = ["REQUEST/", "SENSOR/"];
    let name = &scene.formulas[f].name;
    let element = name.split(' ').next().unwrap_or_default();
    let acts = element.contains('/') && !ASK.iter().any(|ask| element.starts_with(ask));
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

/// Looks after which a switch has come to the other side for good, and looks from just before to just after a short while there.
fn crossings(values: &[f64]) -> (Vec<usize>, Vec<(usize, usize)>) {
    let side = |x: f64| x >= 0.0;
    let changes: Vec<usize> = (1..values.len())
        .filter(|&k| side(values[k]) != side(values[k - 1]))
        .collect();
    let soon = |a: usize, b: usize| b - a <= values.len() / SHORT;
    let pairs = changes.windows(2).filter(|w| soon(w[0], w[1]));
    let pulses = pairs.map(|w| (w[0] - 1, w[1])).collect();
    let alone = |k: usize| {
        let before = k > 0 && soon(changes[k - 1], changes[k]);
        let after = k + 1 < changes.len() && soon(changes[k], changes[k + 1]);
        !before && !after
    };
    let once = (0..changes.len())
        .filter(|&k| alone(k))
        .map(|k| changes[k])
        .collect();
    (once, pulses)
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
    fn a_switch_that_comes_back_soon_is_a_pulse_and_one_that_stays_is_none() {
        let (once, pulses) = crossings(&over(1000, |t| t - 0.5));
        assert_eq!((once, pulses.len()), (vec![500], 0));
        let (once, pulses) = crossings(&over(1000, |t| 1.5e-4 - (t - 0.5).powi(2)));
        assert_eq!((once.len(), pulses), (0, vec![(487, 513)]));
        // half of the time on either side
        let (_, pulses) = crossings(&over(1000, |t| (20.0 * t + 0.1).sin()));
        assert!(pulses.is_empty());
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
