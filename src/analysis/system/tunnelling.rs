//! Bounds of a step by thickness: bodies of contacts must not pass through each other unseen.

use super::recording::Recording;
use crate::numeric::event::SAMPLES;
use crate::scene::Scene;
use crate::scene::configuration::Configured;
use crate::scene::equations::Unsupported;
use crate::scene::programs::record;

/// The motions of all pairs of bodies, recorded.
#[derive(Clone, Debug, Default)]
pub struct ThicknessBounds {
    /// three numbers per pair; `None`: there are no pairs
    motions: Option<Recording>,
    /// rates of the state, for accelerations
    pub(in crate::analysis) rates: Vec<f64>,
    /// how long a step from the last numbers may be before a touch can begin of which nothing told
    /// at its beginning
    pub(super) surprise: f64,
}

impl ThicknessBounds {
    /// Records the motions of the pairs of a scene, whose state has `n` numbers.
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
            motions: Some(Recording::new(program)),
            rates: vec![0.0; n],
            surprise: 0.0,
        })
    }

    /// Returns whether no two bodies can pass through each other.
    pub fn is_empty(&self) -> bool {
        self.motions.is_none()
    }

    /// Returns how long a step may be from these numbers: at one of the samples within it the
    /// bodies still overlap.
    pub fn time(&mut self, scene: &Scene, numbers: &[f64]) -> f64 {
        let Some(motions) = &mut self.motions else {
            return f64::INFINITY;
        };
        let motions = motions.run(numbers);
        let pairs = scene
            .thickness_bounds
            .iter()
            .zip(motions.as_chunks::<3>().0);
        let least = |times: &mut dyn Iterator<Item = f64>| {
            times.filter(|h| !h.is_nan()).fold(f64::INFINITY, f64::min)
        };
        self.surprise = least(&mut (pairs.clone()).map(|(reach, &motion)| reach.surprise(motion)));
        least(&mut pairs.map(|(reach, &motion)| reach.time(motion, (SAMPLES + 1) as f64)))
    }
}
