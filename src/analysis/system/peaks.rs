//! Narrow peaks of forces, which a long step would not notice, wherever they are: in time, on a
//! way, in a turn.
//!
//! A step says nothing of what lies between the places where it evaluates. A force such as
//! `EXP(-((DX(1,2)-0.4)/1E-6)**2)` is zero but for a micrometre, and a body that passes within one
//! step would not feel it. The functions of a model say themselves where they are large: at the
//! maxima of the logarithms of their factors (`expr/program/peaks.rs`). These are looked at at the
//! end of each step:
//!
//! ```text
//! it rose at the beginning and falls at the end         there is a maximum between
//! where the two slopes meet is higher by SUSPECTED      it is located: higher by RESOLVED, it may
//!                                                       be too narrow to be seen
//! ```
//!
//! Then the step is undone and ends before the peak; across it steps are no longer than the way on
//! which the logarithm changes by about one. There error control sees it.

use crate::analysis::system::complaints;
use crate::diagnostic::Diagnostic;
use crate::expr::program::{Builder, Folding, Input, Program, Work};
use crate::model::ElementKind;
use crate::scene::Scene;
use crate::scene::configuration::Configured;
use crate::scene::programs::record;

/// Height of a peak above the ends of a step, as a logarithm, up to which a step sees it.
const RESOLVED: f64 = 6.0;
/// The same of the place where the slopes at the ends meet, from which on a peak is located.
const SUSPECTED: f64 = 1.0;
/// Angle by which an angle that makes peaks may turn within a step: a third of a turn, in which
/// there is one peak.
const MAX_TURN_PER_STEP: f64 = 2.0;

/// The logarithms of narrow factors of the functions of a model, at the ends of a step.
#[derive(Clone, Debug, Default)]
pub struct Peaks {
    /// logarithms, then angles; `None`: there are no logarithms
    program: Option<Program>,
    n_logarithms: usize,
    work: Work,
    /// values and slopes at the beginning of the step   (logarithms, then angles)
    before: Course,
    /// the same at its end
    after: Course,
    values: Vec<f64>,
}

#[derive(Clone, Debug, Default)]
struct Course {
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Peaks {
    /// Records the narrow factors of the functions that act on a scene.
    ///
    /// # Errors
    /// Functions that cannot be recorded.
    pub fn new(scene: Configured<'_>) -> Result<Self, Vec<Diagnostic>> {
        let narrow: Vec<usize> = (0..scene.formulas.len())
            .filter(|&f| acts(&scene, f) && is_narrow(&scene.formulas[f].program))
            .collect();
        if narrow.is_empty() {
            return Ok(Self::default());
        }
        let all = &narrow;
        let values = record(scene, |at| all.iter().map(|&f| at.formula(f)).collect());
        let values = values.map_err(complaints)?;
        let mut builder = Builder::new(Folding::Strict);
        let outputs = values.record(&mut builder);
        let peaks = builder.peaks(&outputs);
        let n_logarithms = peaks.logarithms.len();
        let watched: Vec<_> = peaks.logarithms.into_iter().chain(peaks.angles).collect();
        let inputs: Vec<Input> = values.inputs().to_vec();
        let program = builder.finish_with_inputs(&watched, &inputs);
        let course = || Course {
            values: vec![0.0; watched.len()],
            slopes: vec![0.0; watched.len()],
        };
        Ok(Self {
            program: (n_logarithms > 0).then_some(program),
            n_logarithms,
            work: Work::default(),
            before: course(),
            after: course(),
            values: vec![0.0; watched.len()],
        })
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.program.is_none()
    }

    /// Evaluates logarithms and angles.
    pub fn eval(&mut self, numbers: &[f64]) -> &[f64] {
        if let Some(program) = &self.program {
            program.run(numbers, &mut self.work, &mut self.values);
        }
        &self.values
    }

    /// Takes the numbers a little later than the end of a step.
    pub fn see_later(&mut self, numbers: &[f64]) {
        self.eval(numbers);
        self.after.slopes.copy_from_slice(&self.values);
    }

    /// Takes the numbers at the end of a step, a time `delta` before those of
    /// [`see_later`](Self::see_later).
    pub fn see_end(&mut self, numbers: &[f64], delta: f64) {
        self.eval(numbers);
        self.after.values.copy_from_slice(&self.values);
        for (slope, here) in self.after.slopes.iter_mut().zip(&self.values) {
            *slope = (*slope - here) / delta;
        }
    }

    /// Makes the end of a step the beginning of the next.
    pub fn keep(&mut self) {
        std::mem::swap(&mut self.before, &mut self.after);
    }

    /// Returns the logarithms that may have a narrow maximum within a step of length `h`.
    pub fn hidden(&self, h: f64) -> Vec<usize> {
        let narrow = |&k: &usize| {
            let (a, b) = (self.before.values[k], self.after.values[k]);
            let (up, down) = (self.before.slopes[k], -self.after.slopes[k]);
            // a + up τ = b + down (h − τ); outside of the step where the peak is a spike
            let met_at = (b - a + down * h) / (up + down);
            let is_spike = !(met_at > 0.0 && met_at < h);
            up > 0.0 && down > 0.0 && (is_spike || a + up * met_at > a.max(b) + SUSPECTED)
        };
        (0..self.n_logarithms).filter(narrow).collect()
    }

    /// Returns whether a peak is higher than both ends of the step by more than a step sees.
    pub fn stands_out(&self, k: usize, height: f64) -> bool {
        height > self.before.values[k].max(self.after.values[k]) + RESOLVED
    }

    /// Returns how long a step from its beginning may be so that no angle turns too far.
    pub fn longest_turn(&self) -> f64 {
        let speeds = self.before.slopes.iter().skip(self.n_logarithms);
        let fastest = speeds.fold(0.0, |m: f64, s| m.max(s.abs()));
        MAX_TURN_PER_STEP / fastest
    }
}

/// Returns whether a formula acts on the mechanism.
fn acts(scene: &Scene, f: usize) -> bool {
    let asks = [ElementKind::Request, ElementKind::Sensor];
    let element = scene.formulas[f].owner.owner();
    element.is_some_and(|e| !asks.contains(&e.kind))
}

/// Returns whether an expression has narrow factors of its own.
fn is_narrow(program: &Program) -> bool {
    if !program.may_peak() {
        return false;
    }
    let mut builder = Builder::new(Folding::Strict);
    let outputs = program.record(&mut builder);
    !builder.peaks(&outputs).logarithms.is_empty()
}
