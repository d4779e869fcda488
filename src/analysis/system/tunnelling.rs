//! Where bodies of contacts could pass through each other within a step: how long the next one may be.

use crate::expr::program::{Program, Work};
use crate::numeric::event::SAMPLES;
use crate::scene::Scene;
use crate::scene::configuration::Configured;
use crate::scene::equations::Unsupported;
use crate::scene::programs::record;

/// The motions of all pairs of bodies, recorded.
#[derive(Debug, Default)]
pub struct ThicknessBounds {
    /// three numbers per pair; `None`: there are no pairs
    program: Option<Program>,
    work: Work,
    motions: Vec<f64>,
    /// rates of the state, for accelerations
    pub(in crate::analysis) rates: Vec<f64>,
}

impl ThicknessBounds {
    /// Of a scene, whose state has `n` numbers.
    ///
    /// # Errors
    /// Accelerations that depend on themselves and cannot be recorded.
    pub fn new(scene: Configured<'_>, n: usize) -> Result<Self, Vec<Unsupported>> {
        if scene.thickness_bounds.is_empty() {
            return Ok(Self::default());
        }
        let program = record(scene, |at| {
            scene
                .thickness_bounds
                .iter()
                .flat_map(|r| r.motion(at))
                .collect()
        })?;
        Ok(Self {
            motions: vec![0.0; program.n_outputs()],
            program: Some(program),
            work: Work::default(),
            rates: vec![0.0; n],
        })
    }

    /// Whether no two bodies can pass through each other.
    pub fn is_empty(&self) -> bool {
        self.program.is_none()
    }

    /// How long a step may be from these numbers: at one of the samples within it the bodies still overlap.
    pub fn time(&mut self, scene: &Scene, numbers: &[f64]) -> f64 {
        let Some(program) = &self.program else {
            return f64::INFINITY;
        };
        program.run(numbers, &mut self.work, &mut self.motions);
        let pairs = scene
            .thickness_bounds
            .iter()
            .zip(self.motions.as_chunks::<3>().0);
        pairs
            .map(|(reach, &motion)| reach.time(motion, (SAMPLES + 1) as f64))
            .filter(|h| !h.is_nan())
            .fold(f64::INFINITY, f64::min)
    }
}
