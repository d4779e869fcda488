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
//! delay shrinks to nothing. A step is kept in as many pieces as its polynomials need: where the
//! last coefficients of one in Chebyshev form are not small, the step is halved.
//!
//! ```text
//! e(t) = Σ aₖ Tₖ(2 (t − t₀)/(t₁ − t₀) − 1)      resolved:  |a₆| + |a₇| ≤ E max |e|
//! ```
//!
//! In a model without unknowns an expression of time alone is evaluated at t* itself. One that
//! reads more (another value of the past, a closure, SENVAL, an algebraic loop) is known at t* only
//! from the past.

use super::System;
use crate::expr::program::{Program, Work};
use crate::numeric::{Failure, Method, Step};
use crate::scalar::Scalar;
use crate::scene::configuration::Configured;
use crate::scene::equations::{STATIC, Unsupported};
use crate::scene::external_inputs::ExternalInput;
use crate::scene::history::DelayId;
use crate::scene::layout::Layout;
use crate::scene::programs::record;
use std::collections::BTreeMap;

/// Points of a step at which the past is kept: those of Chebyshev and Lobatto.
const NODES: usize = 8;
/// Most halvings of a step until its pieces are resolved.
const MAX_HALVINGS: usize = 6;

/// One accepted step of a remembered value.
#[derive(Clone, Debug)]
struct Piece {
    t0: f64,
    t1: f64,
    values: [f64; NODES],
}

/// Returns the place of node `k` within a step, 0 to 1.
fn node(k: usize) -> f64 {
    0.5 * (1.0 - Scalar::cos(std::f64::consts::PI * k as f64 / (NODES - 1) as f64))
}

impl Piece {
    /// Returns the largest absolute value at the nodes.
    fn largest(&self) -> f64 {
        self.values.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
    }

    /// Returns whether the last two coefficients in Chebyshev form are at most `permitted`; values
    /// that are not finite cannot be resolved better.
    fn is_resolved(&self, permitted: f64) -> bool {
        let n = (NODES - 1) as f64;
        let coefficient = |order: usize| {
            let terms = self.values.iter().enumerate().map(|(k, value)| {
                let end = k == 0 || k == NODES - 1;
                let weight = if end { 0.5 } else { 1.0 };
                weight * value * Scalar::cos(std::f64::consts::PI * (k * order) as f64 / n)
            });
            2.0 / n * terms.sum::<f64>()
        };
        let last = 0.5 * coefficient(NODES - 1).abs() + coefficient(NODES - 2).abs();
        last.is_nan() || last <= permitted
    }

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
    /// the largest absolute value at a node
    largest: f64,
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
        let pieces: Vec<Piece> = pieces.iter().map(piece).collect::<Option<_>>()?;
        Some(Self {
            start: start.first().copied(),
            largest: pieces.iter().fold(0.0, |m, p| p.largest().max(m)),
            pieces,
        })
    }
}

/// A delayed value.
#[derive(Clone, Debug)]
struct Delay {
    id: DelayId,
    /// its place in the row of numbers
    place: usize,
    expression: Program,
    delay: Program,
    history: Program,
    /// the expression is one of time alone, and nothing else moves: it can be evaluated at any time
    of_time: bool,
    past: Past,
}

/// The delayed values of a system.
#[derive(Clone, Debug, Default)]
pub struct Delays {
    all: Vec<Delay>,
    work: Work,
}

impl Delays {
    /// Records the delayed values of a scene; at rest there is no past.
    ///
    /// # Errors
    /// Whatever the equations cannot supply.
    pub fn new(scene: Configured<'_>) -> Result<Self, Vec<Unsupported>> {
        let mut this = Self::default();
        if scene.mode == STATIC {
            return Ok(this);
        }
        for (place, supplied) in scene.external_inputs.iter().enumerate() {
            if let ExternalInput::Delay(k) = *supplied {
                let d = &scene.delays[k];
                let expression = record(scene, |at| vec![at.formula(d.expression)])?;
                this.all.push(Delay {
                    id: d.id.clone(),
                    place: scene.layout.external_at(place),
                    of_time: (0..scene.layout.len())
                        .all(|place| place == Layout::TIME || !expression.reads(place)),
                    expression,
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
                _ if delayed.of_time => {
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

    /// Returns the shortest positive delay at a row of numbers, of values that are known from the
    /// past alone.
    pub fn shortest_delay(&mut self, numbers: &[f64]) -> f64 {
        let mut out = [0.0];
        let mut shortest = f64::INFINITY;
        for delayed in self.all.iter().filter(|d| !d.of_time) {
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

/// Keeps the values of an accepted step for the past, in pieces that are resolved.
///
/// # Errors
/// Where the interpolant has no value.
pub fn remember(
    system: &mut System,
    method: &mut dyn Method<System>,
    step: &Step,
) -> Result<(), Failure> {
    let mut parts = vec![(step.t0, step.t1, 0)];
    while let Some((t0, t1, halvings)) = parts.pop() {
        let pieces = pieces(system, method, step, [t0, t1])?;
        let middle = 0.5 * (t0 + t1);
        let permitted = system.precision;
        let all = &mut system.recorded.external.delays.all;
        let mut pairs = all.iter_mut().zip(&pieces);
        let resolved = pairs.all(|(delayed, piece)| {
            delayed.past.largest = delayed.past.largest.max(piece.largest());
            piece.is_resolved(permitted * delayed.past.largest)
        });
        if !resolved && halvings < MAX_HALVINGS && t0 < middle && middle < t1 {
            parts.extend([(middle, t1, halvings + 1), (t0, middle, halvings + 1)]);
            continue;
        }
        for (delayed, piece) in all.iter_mut().zip(pieces) {
            delayed.past.pieces.push(piece);
        }
    }
    Ok(())
}

/// Returns the polynomials of all delayed values over a part of a step.
///
/// # Errors
/// Where the interpolant has no value.
fn pieces(
    system: &mut System,
    method: &mut dyn Method<System>,
    step: &Step,
    [t0, t1]: [f64; 2],
) -> Result<Vec<Piece>, Failure> {
    let n = system.recorded.external.delays.all.len();
    let values = [0.0; NODES];
    let mut pieces = vec![Piece { t0, t1, values }; n];
    let mut state = method.y().to_vec();
    let mut out = [0.0];
    for k in 0..NODES {
        let t = if k == NODES - 1 {
            t1
        } else {
            t0 + node(k) * (t1 - t0)
        };
        if t == step.t1 {
            state.copy_from_slice(method.y());
        } else {
            method.interpolate(system, t, &mut state)?;
        }
        system.set(t, &state);
        let delays = &mut system.recorded.external.delays;
        for (delayed, piece) in delays.all.iter().zip(&mut pieces) {
            let work = &mut delays.work;
            delayed.expression.run(&system.numbers, work, &mut out);
            piece.values[k] = out[0];
        }
    }
    Ok(pieces)
}
