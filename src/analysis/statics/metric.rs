//! The measure of forces during a descent: the accelerations that they would cause.

use crate::scene::solve::MassFactor;
use crate::scene::{Scene, Source};
use nalgebra::{Cholesky, DMatrix, DMatrixViewMut, DVector, Dyn};

/// Part of the whole mass that is added in every direction.
const ADDED_MASS: f64 = 1e-6;

/// D: the mass matrix, and a millionth of the whole mass in every direction, so that none is
/// without mass.
pub(super) struct Metric {
    /// rows of the lower triangle, own entry first   (n_v)
    rows: Vec<Vec<(usize, f64)>>,
    factor: MassFactor<f64>,
    /// the mass matrix' own diagonal   (n_v)
    pub mass: Vec<f64>,
}

impl Metric {
    /// Factors the mass matrix, given by its rows; `None` where it is not positive.
    pub fn new(scene: &Scene, mut rows: Vec<Vec<(usize, f64)>>) -> Option<Self> {
        let mass = rows.iter().map(|row| row[0].1).collect();
        let own = ADDED_MASS * total_mass(scene);
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let (Source::Free { v, .. }, true) = (c.source, f.v.is_some()) {
                rows[v][0].1 += if c.angular {
                    own * scene.length * scene.length
                } else {
                    own
                };
            }
        }
        let factor = MassFactor::new(rows.clone());
        let positive = |d: &f64| d.is_finite() && *d > 0.0;
        (factor.inverse_d.iter().all(positive)).then_some(Self { rows, factor, mass })
    }

    /// Returns D x.
    pub fn times(&self, x: &[f64]) -> DVector<f64> {
        let mut y = DVector::zeros(self.rows.len());
        for (i, row) in self.rows.iter().enumerate() {
            for &(j, d) in row {
                y[i] += d * x[j];
                if i != j {
                    y[j] += d * x[i];
                }
            }
        }
        y
    }

    /// Returns D⁻¹ f.
    pub fn solve(&self, f: &DVector<f64>) -> DVector<f64> {
        let mut x = f.clone();
        self.factor.half(x.as_mut_slice());
        self.factor.finish(x.as_mut_slice());
        x
    }

    /// Returns `√(fᵀ D⁻¹ f)`.
    pub fn size(&self, f: &DVector<f64>) -> f64 {
        let mut x = f.clone();
        self.factor.half(x.as_mut_slice());
        let squares = x.iter().zip(&self.factor.inverse_d).map(|(x, d)| x * x * d);
        squares.sum::<f64>().sqrt()
    }

    /// Adds `factor` D to the first rows and columns of a matrix.
    pub fn add_to(&self, a: &mut DMatrixViewMut<'_, f64>, factor: f64) {
        for (i, row) in self.rows.iter().enumerate() {
            for &(j, d) in row {
                a[(i, j)] += factor * d;
                if i != j {
                    a[(j, i)] += factor * d;
                }
            }
        }
    }
}

/// The gradients of the rows, with the matrix that finds multipliers.
pub(super) struct Rows {
    /// G   (m × n_v)
    pub gradient: DMatrix<f64>,
    /// D⁻¹ Gᵀ   (n_v × m)
    moved: DMatrix<f64>,
    /// G D⁻¹ Gᵀ, and its factors where the rows are independent
    gram: DMatrix<f64>,
    factor: Option<Cholesky<f64, Dyn>>,
}

impl Rows {
    /// Prepares the search for multipliers from G.
    pub fn new(gradient: DMatrix<f64>, metric: &Metric) -> Self {
        let (m, n) = gradient.shape();
        let mut moved = DMatrix::zeros(n, m);
        for r in 0..m {
            moved.set_column(r, &metric.solve(&gradient.row(r).transpose()));
        }
        let gram = &gradient * &moved;
        let factor = Cholesky::new(gram.clone());
        Self {
            gradient,
            moved,
            gram,
            factor,
        }
    }

    /// Returns λ that makes `f + Gᵀλ` smallest in the metric, and that sum.
    pub fn balanced(&self, f: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
        let m = self.gradient.nrows();
        if m == 0 {
            return (DVector::zeros(0), f.clone());
        }
        let rhs = -self.moved.tr_mul(f);
        let lambda = match &self.factor {
            Some(factor) => {
                // once more, as the matrix may be badly scaled
                let mut lambda = factor.solve(&rhs);
                lambda += factor.solve(&(rhs - &self.gram * &lambda));
                lambda
            }
            None => {
                let svd = self.gram.clone().svd(true, true);
                svd.solve(&rhs, 1e-12 * self.gram.amax())
                    .unwrap_or_else(|_| DVector::zeros(m))
            }
        };
        let force = f + self.gradient.tr_mul(&lambda);
        (lambda, force)
    }
}

/// Returns the mass of all parts, or one where there is none.
pub(super) fn total_mass(scene: &Scene) -> f64 {
    let mass: f64 = scene.links.iter().map(|l| l.mass).sum();
    if mass > 0.0 { mass } else { 1.0 }
}
