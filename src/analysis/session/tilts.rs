//! Laws that take the angles between two markers for rotations about the axes of J, as BUSHING,
//! FIELD and BEAM do, where the markers are turned about more than one axis.
//!
//! ```text
//! tilt = min_k ∠(z_k of I, z_k of J) = acos max_k (R_JI)_kk
//! ```
//!
//! Where the markers turn about one axis of J alone, as far as they may, that axis does not tilt.

use super::Session;
use crate::analysis::system::System;
use crate::analysis::warning::RunWarning;
use crate::expr::program::{Program, Work};
use crate::model::ElementId;
use crate::scalar::Scalar;
use crate::scene::forces::{ForceElement, ForceLaw};
use crate::scene::layout::Layout;
use crate::scene::programs::record_with_complaints;
use crate::space::MarkerState;

/// Tilt beyond which angles are no rotations any more. Adams asks that two of the three are below
/// 10°; three of them make 14°.
const TOO_LARGE: f64 = 15.0;

/// Elements between tilted markers over the rows of a simulation.
#[derive(Default)]
pub(super) struct Tilts {
    elements: Vec<ElementId>,
    /// the diagonal of `R_JI` of each; `None`: there is no such element
    program: Option<Program>,
    /// of each: when it was first tilted too far, and cos of the largest tilt
    seen: Vec<Option<(f64, f64)>>,
    work: Work,
    values: Vec<f64>,
}

impl Tilts {
    /// Prepares to watch the elements of a system.
    pub fn of(system: &System) -> Self {
        let is_watched = |f: &&ForceElement| f.j.is_some() && reads_angles(&f.law);
        let forces = system.scene.forces.iter().filter(is_watched);
        let watched: Vec<&ForceElement> = forces.collect();
        if watched.is_empty() {
            return Self::default();
        }
        let (program, _) = record_with_complaints(system.configured(), |at| {
            let mut out = Vec::with_capacity(3 * watched.len());
            for force in &watched {
                let i = at.marker(force.i).R_GM;
                let j = force.j.map_or_else(MarkerState::ground, |j| at.marker(j));
                let R_JI = j.R_GM.transpose() * i;
                out.extend([0, 1, 2].map(|k| R_JI.0[k][k]));
            }
            out
        });
        Self {
            values: vec![0.0; program.n_outputs()],
            program: Some(program),
            seen: vec![None; watched.len()],
            elements: watched.iter().map(|f| f.id).collect(),
            work: Work::default(),
        }
    }

    /// Looks at rows of all numbers.
    pub fn see(&mut self, rows: &[Vec<f64>]) {
        let Some(program) = &self.program else {
            return;
        };
        let least = Scalar::cos(TOO_LARGE.to_radians());
        for row in rows {
            program.run(row, &mut self.work, &mut self.values);
            for (diagonal, seen) in self.values.chunks_exact(3).zip(&mut self.seen) {
                let along = diagonal.iter().copied().fold(-1.0, f64::max);
                if along < least {
                    let (since, worst) = seen.unwrap_or((row[Layout::TIME], along));
                    *seen = Some((since, worst.min(along)));
                }
            }
        }
    }
}

/// Returns whether the stiffness of a law reads angles.
fn reads_angles(law: &ForceLaw) -> bool {
    let any = |some: &[f64]| some.iter().any(|k| *k != 0.0);
    match law {
        ForceLaw::Bushing(law) => any(&law.stiffness[3..]),
        ForceLaw::Field(law) => law.stiffness.iter().any(|row| any(&row[3..])),
        ForceLaw::SpringDamper(_)
        | ForceLaw::Nodal { .. }
        | ForceLaw::Single { .. }
        | ForceLaw::Vector { .. }
        | ForceLaw::Contact(_)
        | ForceLaw::Friction { .. } => false,
    }
}

impl Session {
    /// Warns of elements whose markers were tilted too far.
    pub(super) fn warn_of_tilts(&mut self, tilts: Tilts) {
        for (element, seen) in tilts.elements.into_iter().zip(tilts.seen) {
            if let Some((since, cosine)) = seen {
                self.warn(RunWarning::LargeAngles {
                    element,
                    since,
                    tilt: Scalar::acos(cosine.clamp(-1.0, 1.0)),
                });
            }
        }
    }
}
