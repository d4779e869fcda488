//! Numbers that the programs read but do not compute: values of the past (DELAY), results of the
//! user's closures (USER), places where solids touch that no formula finds.
//!
//! The past is kept step by step, as polynomials through the interpolant of each accepted step:
//!
//! ```text
//! e(t*) with t* = t − delay:   before the start        history(t*)
//!                              up to the last step     the polynomial there
//!                              later                   a line to e(t)
//! ```
//!
//! Steps are kept no longer than the shortest delay, so that the last case is met only where a
//! delay shrinks to nothing. Closures see numbers and return numbers; how these change with what
//! they were given is found by differences.

use crate::analysis::system::System;
use crate::expr::program::{Program, Work};
use crate::model::ElementId;
use crate::numeric::{Failure, Method, Step};
use crate::physics::contact::Question;
use crate::physics::contact::curves::Curves;
use crate::scalar::Dual;
use crate::scene::configuration::Configured;
use crate::scene::equations::{Lack, Unsupported};
use crate::scene::external_inputs::{ExternalInput, HookKind, HookName};
use crate::scene::history::DelayId;
use crate::scene::layout::Layout;
use crate::scene::programs::record;
use crate::scene::slopes::WIDTH;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// The arguments of a closure.
#[derive(Clone, Copy, Debug)]
pub struct Call<'a> {
    /// TIME
    pub time: f64,
    /// the element that asks
    pub element: ElementId,
    /// the numbers of `USER(…)`
    pub constants: &'a [f64],
    /// values of the expressions that the closure was registered with; for a GSE followed by its
    /// states, inputs and discrete states
    pub values: &'a [f64],
}

/// A closure: fills in the results, which are zero when it is called.
///
/// One number for SFORCE, VARIABLE, DIFF or SENSOR; FX, FY, FZ, TX, TY, TZ for GFORCE, three for
/// VFORCE and VTORQUE; the value and its first two derivatives in time for MOTION; eight components
/// for REQUEST; rates of the states, then outputs, then what the discrete states are from the next
/// sample on, for GSE.
pub type Law = dyn Fn(&Call<'_>, &mut [f64]) + Send + Sync;

/// A closure under its name.
#[derive(Clone)]
pub struct Hook {
    /// an element ("SFORCE/3"), the text of ROUTINE, or the first number of USER
    pub name: String,
    /// expressions whose values it is given
    pub inputs: Vec<String>,
    /// the closure
    pub law: Arc<Law>,
}

impl Hook {
    /// Returns the part of it that the scene knows.
    pub fn as_name(&self) -> HookName {
        HookName {
            name: self.name.clone(),
            inputs: self.inputs.clone(),
        }
    }
}

impl fmt::Debug for Hook {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Hook({} of {:?})", self.name, self.inputs)
    }
}

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

#[derive(Debug)]
struct Track {
    id: DelayId,
    place: usize,
    expression: Program,
    delay: Program,
    history: Program,
    past: Past,
}

/// A closure that can be printed.
#[derive(Clone)]
struct Callable(Arc<Law>);

impl fmt::Debug for Callable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Law")
    }
}

/// Returns the closure that computes the numbers of a hook.
fn law(kind: &HookKind, element: ElementId, hooks: &[Hook]) -> Result<Callable, Vec<Unsupported>> {
    match kind {
        HookKind::User { closure, .. } => Ok(Callable(hooks[*closure].law.clone())),
        HookKind::Touches { question, .. } => match question {
            Question::Outlines([i, j]) => {
                let curves = Curves::new(i.clone(), j.clone());
                let curves =
                    curves.ok_or_else(|| vec![Unsupported::new(element, Lack::Outlines)])?;
                Ok(Callable(Arc::new(
                    move |call: &Call<'_>, out: &mut [f64]| curves.ask(call.values, out),
                )))
            }
            Question::Wire(wire) => {
                let wire = wire.clone();
                Ok(Callable(Arc::new(
                    move |call: &Call<'_>, out: &mut [f64]| wire.ask(call.values, out),
                )))
            }
            #[cfg(feature = "geometry")]
            Question::Solids(solids) => {
                let query = crate::physics::contact::query::Query::new(&solids[0], &solids[1]);
                let query = query.ok_or_else(|| vec![Unsupported::new(element, Lack::Hull)])?;
                Ok(Callable(Arc::new(
                    move |call: &Call<'_>, out: &mut [f64]| query.ask(call.values, out),
                )))
            }
            #[cfg(not(feature = "geometry"))]
            Question::Solids(_) => Err(vec![Unsupported::new(element, Lack::Geometry)]),
        },
    }
}

#[derive(Debug)]
struct Bound {
    law: Callable,
    element: ElementId,
    constants: Vec<f64>,
    places: Range<usize>,
    inputs: Program,
    output_only: bool,
    /// its values are the pose of one solid in the frame of another
    is_pose: bool,
    /// whether its results depend on each of its values
    reads: Vec<bool>,
    values: Vec<f64>,
    results: Vec<f64>,
    /// ∂ result / ∂ value, result after result
    slopes: Vec<f64>,
}

/// The external inputs of a system.
#[derive(Debug, Default)]
pub struct ExternalInputs {
    /// nothing moves but time, so that the past need not be kept
    still: bool,
    tracks: Vec<Track>,
    hooks: Vec<Bound>,
    work: Work,
    dual_work: Work<Dual<WIDTH>>,
}

impl Bound {
    fn call(&mut self, time: f64) {
        self.results.fill(0.0);
        let call = Call {
            time,
            element: self.element,
            constants: &self.constants,
            values: &self.values,
        };
        (self.law.0)(&call, &mut self.results);
    }

    /// Finds the slopes of the results along each value, by differences.
    fn differentiate(&mut self, time: f64) {
        let (n, m) = (self.values.len(), self.results.len());
        self.slopes.resize(n * m, 0.0);
        let largest = |m: f64, x: &f64| m.max(x.abs());
        let distance = self.values.iter().take(3).fold(1e-3, largest);
        for k in 0..n {
            if !self.reads[k] {
                (0..m).for_each(|i| self.slopes[i * n + k] = 0.0);
                continue;
            }
            let x = self.values[k];
            // numbers of a pose are measured by its distance and by 1, whichever of them happen to
            // be zero
            let unit = match (self.is_pose, k) {
                (true, 0..3) => distance,
                (true, _) => 1.0,
                (false, _) => 1e-3,
            };
            let h = 6e-6 * x.abs().max(unit);
            let mut ends = [Vec::new(), Vec::new()];
            for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
                self.values[k] = x + sign * h;
                self.call(time);
                end.clone_from(&self.results);
            }
            self.values[k] = x;
            for (i, (up, down)) in ends[0].iter().zip(&ends[1]).enumerate() {
                self.slopes[i * n + k] = (up - down) / (2.0 * h);
            }
        }
        self.call(time);
    }
}

impl ExternalInputs {
    /// Records the external inputs of a scene, with the closures that its hooks refer to.
    ///
    /// # Errors
    /// Whatever the equations cannot supply; closures that would read what depends on them.
    pub fn new(scene: Configured<'_>, hooks: &[Hook]) -> Result<Self, Vec<Unsupported>> {
        let l = scene.layout;
        let mut this = Self {
            still: scene.layout.y().is_empty(),
            ..Self::default()
        };
        let at_rest = scene.mode == crate::scene::equations::STATIC;
        for (place, supplied) in scene.external_inputs.iter().enumerate() {
            match *supplied {
                ExternalInput::Delay(k) if !at_rest => {
                    let d = &scene.delays[k];
                    this.tracks.push(Track {
                        id: d.id.clone(),
                        place: l.external_at(place),
                        expression: record(scene, |at| vec![at.formula(d.expression)])?,
                        delay: record(scene, |at| vec![at.formula(d.delay)])?,
                        history: record(scene, |at| vec![at.formula(d.history)])?,
                        past: Past::default(),
                    });
                }
                ExternalInput::Hook(k, 0) => {
                    let hook = &scene.hooks[k];
                    let inputs = record(scene, |at| match &hook.kind {
                        HookKind::User { inputs, .. } => {
                            inputs.iter().map(|&f| at.formula(f)).collect()
                        }
                        HookKind::Touches { markers, .. } => {
                            let [i, j] = markers.map(|m| at.marker(m));
                            let place = j.R_GM.apply_transposed(i.p_GM - j.p_GM);
                            let axes = [0, 1, 2].map(|k| j.R_GM.apply_transposed(i.R_GM.column(k)));
                            let all = [place, axes[0], axes[1], axes[2]];
                            all.iter().flat_map(|v| v.0).collect()
                        }
                    })?;
                    let places = l.externals_at(hook.place, hook.n);
                    if places.clone().any(|place| inputs.reads(place)) {
                        return Err(vec![Unsupported::new(hook.element, Lack::OwnResult)]);
                    }
                    let reads = match &hook.kind {
                        HookKind::User { .. } => vec![true; inputs.n_outputs()],
                        HookKind::Touches { question, .. } => {
                            (0..inputs.n_outputs()).map(|k| question.reads(k)).collect()
                        }
                    };
                    this.hooks.push(Bound {
                        law: law(&hook.kind, hook.element, hooks)?,
                        element: hook.element,
                        constants: hook.constants.clone(),
                        values: vec![0.0; inputs.n_outputs()],
                        results: vec![0.0; hook.n],
                        slopes: Vec::new(),
                        places,
                        inputs,
                        output_only: hook.output_only,
                        is_pose: matches!(hook.kind, HookKind::Touches { .. }),
                        reads,
                    });
                }
                _ => {}
            }
        }
        Ok(this)
    }

    /// Returns whether there is nothing to be computed.
    pub fn is_empty(&self) -> bool {
        self.tracks.is_empty() && self.hooks.is_empty()
    }

    /// Fills in the external inputs of a row of numbers; `output`: also those that only results
    /// show.
    pub fn evaluate(&mut self, numbers: &mut [f64], output: bool) {
        let mut out = [0.0];
        let t = numbers[Layout::TIME];
        for track in &self.tracks {
            let mut run = |program: &Program, numbers: &[f64]| {
                program.run(numbers, &mut self.work, &mut out);
                out[0]
            };
            let delay = run(&track.delay, numbers);
            let then = t - delay.max(0.0);
            let past = &track.past;
            let value = match (past.start, past.pieces.last()) {
                _ if then >= t => run(&track.expression, numbers),
                (start, _) if start.is_none_or(|start| then < start) => {
                    numbers[Layout::TIME] = then;
                    let value = run(&track.history, numbers);
                    numbers[Layout::TIME] = t;
                    value
                }
                _ if self.still => {
                    numbers[Layout::TIME] = then;
                    let value = run(&track.expression, numbers);
                    numbers[Layout::TIME] = t;
                    value
                }
                (_, Some(last)) if then <= last.t1 => {
                    let k = past.pieces.partition_point(|p| p.t1 < then);
                    past.pieces[k].at(then)
                }
                (start, last) => {
                    let now = run(&track.expression, numbers);
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
            numbers[track.place] = value;
        }
        for hook in &mut self.hooks {
            if hook.output_only && !output {
                continue;
            }
            hook.inputs.run(numbers, &mut self.work, &mut hook.values);
            hook.call(t);
            numbers[hook.places.clone()].copy_from_slice(&hook.results);
        }
    }

    /// Puts the derivatives of the closures' results along the directions of a row of numbers into
    /// their places; `first`: at new numbers.
    pub fn follow(&mut self, numbers: &mut [Dual<WIDTH>], first: bool) {
        let mut out = Vec::new();
        for hook in self.hooks.iter_mut().filter(|h| !h.output_only) {
            let zero = Dual {
                re: 0.0,
                eps: [0.0; WIDTH],
            };
            out.clear();
            out.resize(hook.values.len(), zero);
            hook.inputs.eval(numbers, &mut self.dual_work, &mut out);
            if first {
                let plain = out.iter().map(|x| x.re);
                hook.values.clear();
                hook.values.extend(plain);
                hook.differentiate(numbers[Layout::TIME].re);
            }
            let n = hook.values.len();
            for (i, place) in hook.places.clone().enumerate() {
                for direction in 0..WIDTH {
                    let along = (0..n).map(|k| hook.slopes[i * n + k] * out[k].eps[direction]);
                    numbers[place].eps[direction] = along.sum();
                }
            }
        }
    }

    /// Puts in along which directions the results change: those along which their values do.
    pub fn depend(&self, along: &mut [Vec<u32>]) {
        for hook in self.hooks.iter().filter(|h| !h.output_only) {
            let mut all: Vec<u32> = hook.inputs.dependence(along).concat();
            all.sort_unstable();
            all.dedup();
            along[hook.places.clone()].fill(all);
        }
    }

    /// Takes the derivatives of the results away again.
    pub fn forget(&self, numbers: &mut [Dual<WIDTH>]) {
        for hook in &self.hooks {
            for x in &mut numbers[hook.places.clone()] {
                x.eps = [0.0; WIDTH];
            }
        }
    }

    /// Returns whether the past is asked for.
    pub fn remembers(&self) -> bool {
        !self.tracks.is_empty()
    }

    /// Returns the shortest positive delay at a row of numbers.
    pub fn shortest_delay(&mut self, numbers: &[f64]) -> f64 {
        let mut out = [0.0];
        let mut shortest = f64::INFINITY;
        for track in &self.tracks {
            track.delay.run(numbers, &mut self.work, &mut out);
            if out[0] > 0.0 {
                shortest = shortest.min(out[0]);
            }
        }
        shortest
    }

    /// Returns the past of all delayed values, for the next simulation.
    pub fn past(&self) -> BTreeMap<DelayId, Past> {
        let tracks = self.tracks.iter();
        tracks.map(|t| (t.id.clone(), t.past.clone())).collect()
    }

    /// Goes on from a past as far as it is known, or begins at time `t`.
    pub fn begin(&mut self, t: f64, past: &BTreeMap<DelayId, Past>) {
        for track in &mut self.tracks {
            if let Some(past) = past.get(&track.id) {
                track.past.clone_from(past);
            }
            // steps beyond the beginning, of an earlier attempt, are no past
            track.past.pieces.retain(|p| p.t0 < t);
            track.past.start.get_or_insert(t);
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
    let n = system.external.tracks.len();
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
        for (track, piece) in system.external.tracks.iter().zip(&mut pieces) {
            track
                .expression
                .run(&system.numbers, &mut system.external.work, &mut out);
            piece.values[k] = out[0];
        }
    }
    for (track, piece) in system.external.tracks.iter_mut().zip(pieces) {
        track.past.pieces.push(piece);
    }
    Ok(())
}
