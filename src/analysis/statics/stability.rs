//! The stability of an equilibrium: directions in which a small push is answered, and how.

use super::Settler;
use super::point::Point;
use crate::numeric::rank::{Rank, TOLERANCE};
use nalgebra::linalg::Schur;
use nalgebra::{Cholesky, DMatrix, DVector};

/// Sweeps per eigenvalue of a matrix that is not symmetric: two to four are usual; an iteration
/// that takes many more may not end.
const MAX_SWEEPS: usize = 30;

/// The answers of an equilibrium to a small push.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stability {
    /// directions in which it is pushed back
    pub stable: usize,
    /// directions in which nothing happens
    pub neutral: usize,
    /// directions in which it leaves
    pub unstable: usize,
}

impl Stability {
    /// Writes them: "stable, indifferent in 2 directions".
    pub fn words(&self) -> String {
        let directions = |n: usize| if n == 1 { "direction" } else { "directions" };
        match (self.unstable, self.neutral) {
            (0, 0) => "stable".into(),
            (0, n) => format!("stable, indifferent in {n} {}", directions(n)),
            (n, _) => format!("unstable in {n} {}", directions(n)),
        }
    }
}

impl Settler<'_> {
    /// Returns the derivatives of the loads along coordinates, where states follow at once:
    ///
    /// ```text
    /// K − K_x e_x⁻¹ e_q
    /// ```
    fn slopes_with_states(&self, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
        let (n, d) = (self.n_v(), self.states.len());
        let mut k = jacobian.view((0, 0), (n, n)).into_owned();
        if d > 0 {
            let own = jacobian.view((n, n), (d, d)).into_owned();
            let mut moved = jacobian.view((n, 0), (d, n)).into_owned();
            let inverse = own.clone().try_inverse().or_else(|| {
                // integrals of velocities follow these, in a motion as slow as may be:
                // λ x = e_x x + (e_q + λ e_v) q
                let slow = 1e-6 * own.amax().max(1.0);
                moved += self.drift.as_ref()? * slow;
                (own - DMatrix::identity(d, d) * slow).try_inverse()
            });
            if let Some(inverse) = inverse {
                let follow = inverse * moved;
                k -= jacobian.view((0, n), (n, d)) * follow;
            }
        }
        k
    }

    /// Finds the answers to a push, and the direction in which the model leaves fastest.
    pub(super) fn stability(
        &mut self,
        p: &Point,
        jacobian: &DMatrix<f64>,
    ) -> (Stability, Option<DVector<f64>>) {
        let (n, d) = (self.n_v(), self.states.len());
        let k = self.slopes_with_states(jacobian);
        let gradient = p.rows.gradient.transpose();
        let columns = gradient.column_iter().map(|c| c.iter().copied().collect());
        let columns: Vec<Vec<f64>> = columns.collect();
        let free = Rank::of(columns.iter().map(Vec::as_slice), n, TOLERANCE).free_directions();
        let f = free.len();
        let nothing = (Stability::default(), None);
        if f == 0 || self.asked.stops() {
            return nothing;
        }
        let z = DMatrix::from_fn(n, f, |i, j| free[j][i]);
        let stiffness = -(z.transpose() * k * &z);
        let mut metric = DMatrix::zeros(n, n);
        p.metric.add_to(&mut metric.as_view_mut(), 1.0);
        if self.asked.stops() {
            return nothing;
        }
        let inertia = z.transpose() * metric * &z;
        let Some(factor) = Cholesky::new(inertia) else {
            return nothing;
        };
        // L⁻¹ K L⁻ᵀ
        let lower = factor.l();
        let half = lower.solve_lower_triangular(&stiffness);
        let reduced = half.and_then(|h| lower.solve_lower_triangular(&h.transpose()));
        let Some(reduced) = reduced.map(|r| r.transpose()) else {
            return nothing;
        };
        if self.asked.stops() {
            return nothing;
        }
        let symmetric = (&reduced + reduced.transpose()) * 0.5;
        let eigen = symmetric.symmetric_eigen();
        let values: Vec<f64> = if asymmetry(&reduced) < 1e-6 {
            eigen.eigenvalues.iter().copied().collect()
        } else {
            // the iteration need not end: then the symmetric part tells the work of a push
            match Schur::try_new(reduced, f64::EPSILON, MAX_SWEEPS * f.max(10)) {
                Some(schur) => schur.complex_eigenvalues().iter().map(|c| c.re).collect(),
                None => eigen.eigenvalues.iter().copied().collect(),
            }
        };
        let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut found = Stability::default();
        for x in &values {
            if x.abs() <= 1e-9 * largest || largest == 0.0 {
                found.neutral += 1;
            } else if *x > 0.0 {
                found.stable += 1;
            } else {
                found.unstable += 1;
            }
        }
        let lowest = eigen.eigenvalues.imin();
        let direction = eigen.eigenvectors.column(lowest).into_owned();
        let direction = lower.tr_solve_lower_triangular(&direction).map(|c| z * c);
        let unit = direction.map(|x| {
            let size = self.excess(&x) * self.settings.angle;
            let mut x = if size > 0.0 { x / size } else { x };
            x = x.insert_rows(n, d, 0.0);
            x
        });
        (found, unit)
    }
}

/// Returns the size of the part that is not symmetric, relative to the whole.
pub(super) fn asymmetry(a: &DMatrix<f64>) -> f64 {
    let size = a.amax();
    if size == 0.0 {
        return 0.0;
    }
    (a - a.transpose()).amax() / size
}
