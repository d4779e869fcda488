//! Narrow peaks of forces, which a long step would not notice, wherever they are: in time, on a
//! way, in a turn.
//!
//! A step says nothing of what lies between the places where it evaluates. A force such as
//! `EXP(-((DX(1,2)-0.4)/1E-6)**2)` is zero but for a micrometre, and a body that passes within one
//! step would not feel it. The functions of a model say themselves where they are large: at the
//! maxima of the logarithms of their factors (`expr/program/peaks.rs`). These are watched along a
//! step (`time/leg_peaks.rs`).

use super::bounds::{Bounded, Bounds, Watched};
use crate::analysis::system::complaints;
use crate::diagnostic::Diagnostic;
use crate::expr::program::{Builder, Folding, Input, Program, Work};
use crate::model::ElementKind;
use crate::scalar::{Interval, Scalar};
use crate::scene::Scene;
use crate::scene::configuration::Configured;
use crate::scene::layout::LongRow;
use crate::scene::programs::record;

/// The logarithms of narrow factors of the functions of a model.
#[derive(Clone, Debug)]
pub struct Peaks {
    /// reads the numbers; `None`: there are none
    program: Option<Program>,
    work: Work,
    bounds: Bounded,
    row: LongRow,
}

impl Peaks {
    /// Records the narrow factors of the functions that act on a scene.
    ///
    /// # Errors
    /// Functions that cannot be recorded.
    pub fn new(scene: Configured<'_>) -> Result<Self, Vec<Diagnostic>> {
        let mut peaks = Self {
            program: None,
            work: Work::default(),
            bounds: Bounded::default(),
            row: LongRow {
                numbers: scene.layout,
                n_more: 0,
                n_sides: 0,
            },
        };
        let narrow: Vec<usize> = (0..scene.formulas.len())
            .filter(|&f| acts(&scene, f) && is_narrow(&scene.formulas[f].program))
            .collect();
        if narrow.is_empty() {
            return Ok(peaks);
        }
        let all = &narrow;
        let values = record(scene, |at| all.iter().map(|&f| at.formula(f)).collect());
        let values = values.map_err(complaints)?;
        let mut builder = Builder::new(Folding::Strict);
        let outputs = values.record(&mut builder);
        let logarithms = builder.peaks(&outputs);
        let inputs: Vec<Input> = values.inputs().to_vec();
        peaks.program =
            (!logarithms.is_empty()).then(|| builder.finish_with_inputs(&logarithms, &inputs));
        Ok(peaks)
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.program.is_none()
    }

    /// Returns how many there are.
    pub fn len(&self) -> usize {
        self.program.as_ref().map_or(0, Program::n_outputs)
    }
}

impl Watched for Peaks {
    fn bounded(&self) -> (Vec<usize>, Vec<usize>) {
        let program = self.program.as_ref();
        program.map_or_else(Default::default, |p| Bounded::of(p, self.row))
    }

    fn values(&mut self, numbers: &[f64], values: &mut [f64]) {
        if let Some(program) = &self.program {
            program.run(numbers, &mut self.work, values);
        }
    }

    fn loop_unknowns(&self) -> &[f64] {
        &[]
    }

    fn take_bounds(
        &mut self,
        numbers: &[f64],
        time: Interval,
        unknowns: &mut dyn Iterator<Item = (usize, [Interval; 2])>,
    ) {
        self.bounds.take(self.row, (numbers, &[]), time, unknowns);
    }

    fn bound(&mut self, bounds: &mut [Bounds]) {
        if let Some(program) = &self.program {
            self.bounds.all(program, bounds);
        }
    }

    fn bound_one(&mut self, k: usize) -> Bounds {
        match &self.program {
            Some(program) => self.bounds.one(program, k),
            None => Bounds::constant(f64::NAN),
        }
    }

    fn unknowns_of(&mut self, k: usize) -> Vec<usize> {
        match &self.program {
            Some(program) => self.bounds.unknowns_of(program, self.row, k),
            None => Vec::new(),
        }
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
    !builder.peaks(&outputs).is_empty()
}
