//! Numbers that closures compute beside the programs: the user's (USER), and places where solids
//! touch that no formula finds.
//!
//! Closures see numbers and return numbers; how these change with what they were given is found by
//! differences.

use crate::expr::program::{Program, Work};
use crate::model::ElementId;
use crate::physics::contact::Question;
use crate::physics::contact::curves::Curves;
use crate::scalar::Dual;
use crate::scene::configuration::Configured;
use crate::scene::equations::{Lack, Unsupported};
pub use crate::scene::external_inputs::{Call, Hook, Law};
use crate::scene::external_inputs::{ExternalInput, HookKind, SceneHook};
use crate::scene::layout::Layout;
use crate::scene::programs::record;
use crate::scene::slopes::WIDTH;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

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
        HookKind::Touched(touched) => Ok(Callable(hooks[touched.closure].law.clone())),
        HookKind::Coupled(coupled) => {
            let coupled = coupled.clone();
            let ask = move |call: &Call<'_>, out: &mut [f64]| coupled.expand(call.values, out);
            Ok(Callable(Arc::new(ask)))
        }
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

/// A closure with its places in the row of numbers and what it is given.
#[derive(Clone, Debug)]
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

impl Bound {
    fn new(
        scene: Configured<'_>,
        hook: &SceneHook,
        hooks: &[Hook],
    ) -> Result<Self, Vec<Unsupported>> {
        let inputs = record(scene, |at| match &hook.kind {
            HookKind::User { inputs, .. } => inputs.iter().map(|&f| at.formula(f)).collect(),
            HookKind::Touched(touched) => touched.numbers(at),
            HookKind::Coupled(coupled) => {
                let all = coupled.displacements.iter();
                all.map(|d| at.displacement(d).value)
                    .chain([at.time()])
                    .collect()
            }
            HookKind::Touches { markers, .. } => {
                let [i, j] = markers.map(|m| at.marker(m));
                let place = j.R_GM.apply_transposed(i.p_GM - j.p_GM);
                let axes = [0, 1, 2].map(|k| j.R_GM.apply_transposed(i.R_GM.column(k)));
                let all = [place, axes[0], axes[1], axes[2]];
                all.iter().flat_map(|v| v.0).collect()
            }
        })?;
        let places = scene.layout.externals_at(hook.place, hook.n);
        if places.clone().any(|place| inputs.reads(place)) {
            return Err(vec![Unsupported::new(hook.element, Lack::OwnResult)]);
        }
        let reads = match &hook.kind {
            HookKind::User { .. } | HookKind::Coupled(_) | HookKind::Touched(_) => {
                vec![true; inputs.n_outputs()]
            }
            HookKind::Touches { question, .. } => {
                (0..inputs.n_outputs()).map(|k| question.reads(k)).collect()
            }
        };
        Ok(Self {
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
        })
    }

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

/// The closures of a system.
#[derive(Clone, Debug, Default)]
pub struct Closures {
    all: Vec<Bound>,
    work: Work,
    dual_work: Work<Dual<WIDTH>>,
}

impl Closures {
    /// Records what the closures of a scene are given; its hooks refer to `hooks`.
    ///
    /// # Errors
    /// Whatever the equations cannot supply; closures that would read what depends on them.
    pub fn new(scene: Configured<'_>, hooks: &[Hook]) -> Result<Self, Vec<Unsupported>> {
        let mut this = Self::default();
        for supplied in &scene.external_inputs {
            if let ExternalInput::Hook(k, 0) = *supplied {
                this.all.push(Bound::new(scene, &scene.hooks[k], hooks)?);
            }
        }
        Ok(this)
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Fills the results of closures into a row of numbers; `output`: also those that only results
    /// show.
    pub fn evaluate(&mut self, numbers: &mut [f64], output: bool) {
        for hook in &mut self.all {
            if hook.output_only && !output {
                continue;
            }
            hook.inputs.run(numbers, &mut self.work, &mut hook.values);
            hook.call(numbers[Layout::TIME]);
            numbers[hook.places.clone()].copy_from_slice(&hook.results);
        }
    }

    /// Puts the derivatives of the closures' results along the directions of a row of numbers into
    /// their places; `first`: at new numbers.
    pub fn follow(&mut self, numbers: &mut [Dual<WIDTH>], first: bool) {
        let mut out = Vec::new();
        for hook in self.all.iter_mut().filter(|h| !h.output_only) {
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
        for hook in self.all.iter().filter(|h| !h.output_only) {
            let mut all: Vec<u32> = hook.inputs.dependence(along).concat();
            all.sort_unstable();
            all.dedup();
            along[hook.places.clone()].fill(all);
        }
    }

    /// Takes the derivatives of the results away again.
    pub fn forget(&self, numbers: &mut [Dual<WIDTH>]) {
        for hook in &self.all {
            for x in &mut numbers[hook.places.clone()] {
                x.eps = [0.0; WIDTH];
            }
        }
    }
}
