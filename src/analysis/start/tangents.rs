//! Velocities at a position where branches meet: along one of them.
//!
//! Where rows depend on each other, rows of first order permit more velocities than any motion
//! can have. Those of a motion satisfy the combinations that are zero in first order in the second,
//! too:
//!
//! ```text
//! λᵀ G = 0   ⇒   λᵀ g̈ = −λᵀ γ(v) = 0          γ: quadratic in v                             (1)
//! v ← v + S z,   z the shortest with   ∂(λᵀ γ)/∂z z = −λᵀ γ                                  (2)
//! ∂γ/∂s = (γ(v + s) − γ(v − s))/2             exact, as γ is quadratic                       (3)
//! ```
//!
//! A parallelogram that lies flat may go on as one or as its crossed twin: each is a root of (1).
//! Of the roots that (2) finds the one counts that is nearest to what the dataset gives.

use super::assemble::{numbers, rank_of};
use crate::numeric::connected::SparseRow;
use crate::scene::configuration::Configured;
use crate::scene::equations::Equations;
use crate::scene::programs::weights;
use nalgebra::{DMatrix, DVector};

/// Part of the sizes of its terms by which a combination (1) may be off: factors of combinations
/// are known to 1e-8.
const MET: f64 = 1e-6;
/// The same where (2) ends.
const CONVERGED: f64 = 1e-13;
/// Most steps (2) from one beginning.
const MOST_STEPS: usize = 40;
/// Most directions along which (2) is begun anew.
const MOST_BEGINNINGS: usize = 6;

/// The combinations of rows that are zero in first order, at a position.
pub(super) struct Tangents<'s> {
    scene: Configured<'s>,
    /// time, coordinates and further states of the position
    at: (f64, &'s [f64], &'s [f64]),
    /// λ of (1), by rows
    combinations: Vec<SparseRow>,
    /// metric of the velocities   (n_v)
    w: Vec<f64>,
}

impl<'s> Tangents<'s> {
    /// Looks at combinations of rows of `scene` that are zero in first order.
    pub fn new(
        scene: Configured<'s>,
        at: (f64, &'s [f64], &'s [f64]),
        combinations: Vec<SparseRow>,
    ) -> Self {
        Self {
            scene,
            at,
            combinations,
            w: weights(&scene),
        }
    }

    /// Evaluates λᵀ γ of (1) at velocities, and the sizes of its terms, which are no less than
    /// those of a part that turns as fast as any   (combinations each)
    fn lack(&self, v: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let (t, q, x) = self.at;
        let at = Equations::new(self.scene, &numbers(self.scene, t, q, v.as_slice(), x));
        let pace = v.iter().zip(&self.w).map(|(v, w)| v.abs() / w.sqrt());
        let pace = pace.fold(0.0, f64::max);
        let n = self.combinations.len();
        let (mut lack, mut sizes) = (DVector::zeros(n), DVector::zeros(n));
        for (k, combination) in self.combinations.iter().enumerate() {
            for &(r, factor) in combination {
                let term = factor * at.row(r).gamma;
                lack[k] += term;
                sizes[k] += term.abs() + factor.abs() * pace * pace * self.scene.row_scale(r);
            }
        }
        (lack, sizes)
    }

    /// Returns whether velocities satisfy (1) to a part of the sizes of its terms.
    fn is_met(&self, v: &DVector<f64>, part: f64) -> bool {
        let (lack, sizes) = self.lack(v);
        lack.iter().zip(&sizes).all(|(l, s)| l.abs() <= part * s)
    }

    /// Returns velocities along a branch in place of `v`, which may change along `free`
    /// directions (n_v each); `off` tells how far velocities are from the given ones. `None`: `v`
    /// is along one, or none was found.
    pub fn nearest(
        &self,
        v: &DVector<f64>,
        free: &[DVector<f64>],
        off: impl Fn(&DVector<f64>) -> f64,
    ) -> Option<DVector<f64>> {
        let size = v.amax();
        if self.combinations.is_empty() || free.is_empty() || size == 0.0 || self.is_met(v, MET) {
            return None;
        }
        let aside = (free.iter().take(MOST_BEGINNINGS)).flat_map(|s| [v + s * size, v - s * size]);
        let mut best: Option<(f64, DVector<f64>)> = None;
        for begin in std::iter::once(v.clone()).chain(aside) {
            let Some(found) = self.converge(begin, free, size) else {
                continue;
            };
            let off = off(&found);
            // what was found first stands but where another is clearly nearer
            if best.as_ref().is_none_or(|b| off < b.0 * (1.0 - MET)) {
                best = Some((off, found));
            }
        }
        best.map(|b| b.1)
    }

    /// Repeats (2) with directions of a length; `None`: it does not converge.
    fn converge(
        &self,
        mut v: DVector<f64>,
        free: &[DVector<f64>],
        size: f64,
    ) -> Option<DVector<f64>> {
        for _ in 0..MOST_STEPS {
            if self.is_met(&v, CONVERGED) {
                return Some(v);
            }
            let slopes = free.iter().map(|s| {
                let [up, down] = [1.0, -1.0].map(|sign| self.lack(&(&v + s * (sign * size))).0);
                (up - down) * 0.5
            });
            let slopes: Vec<DVector<f64>> = slopes.collect();
            let (lack, _) = self.lack(&v);
            let rank = rank_of(&DMatrix::from_columns(&slopes));
            let mut z = vec![0.0; free.len()];
            rank.least_norm((-lack).as_slice(), &mut z);
            if z.iter().all(|z| *z == 0.0) {
                break;
            }
            for (s, z) in free.iter().zip(z) {
                v += s * (z * size);
            }
        }
        self.is_met(&v, MET).then_some(v)
    }
}
