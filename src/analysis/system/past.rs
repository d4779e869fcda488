//! The past of delayed values (DELAY), kept step by step as polynomials through the interpolant of
//! each accepted step.
//!
//! ```text
//! e(t*) with t* = t − delay:   before the start        history(t*)
//!                              up to the last step     the polynomial there
//!                              later                   a line to e(t)
//! ```
//!
//! Steps are kept no longer than the shortest delay, so that the last case is met only where a
//! delay shrinks to nothing.

use super::System;
use crate::expr::program::{Program, Work};
use crate::numeric::{Failure, Method, Step};
use crate::scene::configuration::Configured;
use crate::scene::equations::{STATIC, Unsupported};
use crate::scene::external_inputs::ExternalInput;
use crate::scene::history::DelayId;
use crate::scene::layout::Layout;
use crate::scene::programs::record;
use std::collections::BTreeMap;

/// Points of a step at which the past is kept: those of Chebyshev and Lobatto.
const NODES: usize = 8;

/// One accepted step of a remembered value.
#[derive(Clone, Debug)]
struct Piece {
    t0: f64,
    t1: f64,
    values: [f64; NODES],
}

/// Returns the place of node `k` within a step, 0 to 1.
fn node(k: usize) -> f64 {
    0.5 * (1.0 - (std::f64::consts::PI * k as f64 / (NODES - 1) as f64).cos())
}

impl Piece {
    /// Evaluates the polynomial through the nodes, by the barycentric formula.
    fn at(&self, t: f64) -> f64 {
        let u = (t - self.t0) / (self.t1 - self.t0);
        let (mut above, mut below) = (0.0, 0.0);
        for (k, value) in self.values.iter().enumerate() {
            let distance = u - node(k);
            if distance == 0.0 {
                return *value;
            }
            let end = k == 0 || k == NODES - 1;
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            let weight = sign * if end { 0.5 } else { 1.0 } / distance;
            above += weight * value;
            below += weight;
        }
        above / below
    }
}

/// The past of a delayed value.
#[derive(Clone, Debug, Default)]
pub struct Past {
    /// where it begins
    start: Option<f64>,
    pieces: Vec<Piece>,
}

impl Past {
    /// Returns lists of numbers: the start, then each piece with its two ends.
    pub(in crate::analysis) fn numbers(&self) -> Vec<Vec<f64>> {
        let piece = |p: &Piece| [&[p.t0, p.t1][..], &p.values[..]].concat();
        let start = self.start.into_iter().collect();
        std::iter::once(start)
            .chain(self.pieces.iter().map(piece))
            .collect()
    }

    /// Reads such lists; `None` where they are none.
    pub(in crate::analysis) fn of_numbers(lists: &[Vec<f64>]) -> Option<Self> {
        let (start, pieces) = lists.split_first()?;
        let piece = |p: &Vec<f64>| {
            let (ends, values) = p.split_first_chunk::<2>()?;
            let values = values.try_into().ok()?;
            Some(Piece {
                t0: ends[0],
                t1: ends[1],
                values,
            })
        };
        Some(Self {
            start: start.first().copied(),
            pieces: pieces.iter().map(piece).collect::<Option<_>>()?,
        })
    }
}

/// A delayed value.
#[derive(Debug)]
struct Delay {
    id: DelayId,
    /// its place in the row of numbers
    place: usize,
    expression: Program,
    delay: Program,
    history: Program,
    past: Past,
}

/// The delayed values of a system.
#[derive(Debug, Default)]
pub struct Delays {
    /// nothing moves but time, so that the past need not be kept
    still: bool,
    all: Vec<Delay>,
    work: Work,
}

impl Delays {
    /// Records the delayed values of a scene; at rest there is no past.
    ///
    /// # Errors
    /// Whatever the equations cannot supply.
    pub fn new(scene: Configured<'_>) -> Result<Self, Vec<Unsupported>> {
        let mut this = Self {
            still: scene.layout.y().is_empty(),
            ..Self::default()
        };
        if scene.mode == STATIC {
            return Ok(this);
        }
        for (place, supplied) in scene.external_inputs.iter().enumerate() {
            if let ExternalInput::Delay(k) = *supplied {
                let d = &scene.delays[k];
                this.all.push(Delay {
                    id: d.id.clone(),
                    place: scene.layout.external_at(place),
                    expression: record(scene, |at| vec![at.formula(d.expression)])?,
                    delay: record(scene, |at| vec![at.formula(d.delay)])?,
                    history: record(scene, |at| vec![at.formula(d.history)])?,
                    past: Past::default(),
                });
            }
        }
        Ok(this)
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Fills the delayed values into a row of numbers.
    pub fn evaluate(&mut self, numbers: &mut [f64]) {
        let mut out = [0.0];
        let t = numbers[Layout::TIME];
        for delayed in &self.all {
            let mut run = |program: &Program, numbers: &[f64]| {
                program.run(numbers, &mut self.work, &mut out);
                out[0]
            };
            let delay = run(&delayed.delay, numbers);
            let then = t - delay.max(0.0);
            let past = &delayed.past;
            let value = match (past.start, past.pieces.last()) {
                _ if then >= t => run(&delayed.expression, numbers),
                (start, _) if start.is_none_or(|start| then < start) => {
                    numbers[Layout::TIME] = then;
                    let value = run(&delayed.history, numbers);
                    numbers[Layout::TIME] = t;
                    value
                }
                _ if self.still => {
                    numbers[Layout::TIME] = then;
                    let value = run(&delayed.expression, numbers);
                    numbers[Layout::TIME] = t;
                    value
                }
                (_, Some(last)) if then <= last.t1 => {
                    let k = past.pieces.partition_point(|p| p.t1 < then);
                    past.pieces[k].at(then)
                }
                (start, last) => {
                    let now = run(&delayed.expression, numbers);
                    let begin = last.map_or(start.unwrap_or(t), |p| p.t1);
                    let known = last.map_or(now, |p| p.values[NODES - 1]);
                    let part = if t > begin {
                        (then - begin) / (t - begin)
                    } else {
                        1.0
                    };
                    known + (now - known) * part
                }
            };
            numbers[delayed.place] = value;
        }
    }

    /// Returns the shortest positive delay at a row of numbers.
    pub fn shortest_delay(&mut self, numbers: &[f64]) -> f64 {
        let mut out = [0.0];
        let mut shortest = f64::INFINITY;
        for delayed in &self.all {
            delayed.delay.run(numbers, &mut self.work, &mut out);
            if out[0] > 0.0 {
                shortest = shortest.min(out[0]);
            }
        }
        shortest
    }

    /// Returns the past of all delayed values, for the next simulation.
    pub fn past(&self) -> BTreeMap<DelayId, Past> {
        let all = self.all.iter();
        all.map(|d| (d.id.clone(), d.past.clone())).collect()
    }

    /// Goes on from a past as far as it is known, or begins at time `t`.
    pub fn begin(&mut self, t: f64, past: &BTreeMap<DelayId, Past>) {
        for delayed in &mut self.all {
            if let Some(past) = past.get(&delayed.id) {
                delayed.past.clone_from(past);
            }
            // steps beyond the beginning, of an earlier attempt, are no past
            delayed.past.pieces.retain(|p| p.t0 < t);
            delayed.past.start.get_or_insert(t);
        }
    }

    /// Goes on with the past of the same delayed values, recorded for other rows.
    pub(super) fn carry_on(&mut self, before: &mut Self) {
        for (delayed, before) in self.all.iter_mut().zip(&mut before.all) {
            delayed.past = std::mem::take(&mut before.past);
        }
    }
}

/// Keeps the values of an accepted step for the past.
///
/// # Errors
/// Where the interpolant has no value.
pub fn remember(
    system: &mut System,
    method: &mut dyn Method<System>,
    step: &Step,
) -> Result<(), Failure> {
    let n = system.recorded.external.delays.all.len();
    let mut pieces = vec![
        Piece {
            t0: step.t0,
            t1: step.t1,
            values: [0.0; NODES],
        };
        n
    ];
    let mut state = method.y().to_vec();
    let mut out = [0.0];
    for k in 0..NODES {
        let t = if k == NODES - 1 {
            state.copy_from_slice(method.y());
            step.t1
        } else {
            let t = step.t0 + node(k) * (step.t1 - step.t0);
            method.interpolate(system, t, &mut state)?;
            t
        };
        // methods for implicit equations have multipliers behind it
        system.set(t, &state);
        let delays = &mut system.recorded.external.delays;
        for (delayed, piece) in delays.all.iter().zip(&mut pieces) {
            let work = &mut delays.work;
            delayed.expression.run(&system.numbers, work, &mut out);
            piece.values[k] = out[0];
        }
    }
    let delays = &mut system.recorded.external.delays;
    for (delayed, piece) in delays.all.iter_mut().zip(pieces) {
        delayed.past.pieces.push(piece);
    }
    Ok(())
}
