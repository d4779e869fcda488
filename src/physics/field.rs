//! FIELD: a linear law by full matrices between the six displacements of two markers and six
//! forces, in the axes of J.
//!
//! | parameter | symbol | keyword | unit | default |
//! |---|---|---|---|---|
//! | stiffness | K (6 × 6) | KMATRIX | force/length … torque/rad | – |
//! | damping | C (6 × 6) | CMATRIX, or CRATIO · K | force·time/length … torque·time/rad | 0 |
//! | free displacement | x₀ | LENGTH | length, rad | 0 |
//! | preload | F₀ | FORCE | force, torque | 0 |
//!
//! ```text
//! (F, T) = −K (x − x₀) − C (ẋ, ω) + F₀      x: x, y, z, a, b, c of I from J, as in a bushing
//! ```
//!
//! The action is on I; J's part feels the opposite at the same point, so that about J's own origin
//! a moment `−d × F` is added. BEAM is a FIELD whose matrix comes from a slender beam. The law
//! conserves energy where K is symmetric and the rotations are small or about one axis: only then
//! are the components of ω the rates of a, b, c.

use super::action::{ALL_ANGLES, Action, Law};
use super::bushing::{deformation, in_axes_of};
use crate::expr::measures::Measure;
use crate::scalar::Scalar;
use crate::space::MarkerState;

/// The parameters of a field.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// K by rows
    pub stiffness: [[f64; 6]; 6],
    /// C by rows
    pub damping: [[f64; 6]; 6],
    /// x₀
    pub free: [f64; 6],
    /// F₀
    pub preload: [f64; 6],
}

/// Builds a 6 × 6 matrix from 36 numbers by columns.
pub fn by_columns(numbers: &[f64]) -> Option<[[f64; 6]; 6]> {
    (numbers.len() == 36)
        .then(|| std::array::from_fn(|r| std::array::from_fn(|c| numbers[6 * c + r])))
}

/// Builds a symmetric 6 × 6 matrix from the 21 numbers of its lower triangle by rows.
pub fn by_lower_triangle(numbers: &[f64]) -> Option<[[f64; 6]; 6]> {
    let at = |r: usize, c: usize| {
        let (r, c) = (r.max(c), r.min(c));
        numbers[r * (r + 1) / 2 + c]
    };
    (numbers.len() == 21).then(|| std::array::from_fn(|r| std::array::from_fn(|c| at(r, c))))
}

/// Multiplies a matrix by a number.
pub fn scaled(matrix: &[[f64; 6]; 6], factor: f64) -> [[f64; 6]; 6] {
    matrix.map(|row| row.map(|x| x * factor))
}

/// Returns `−Σ row · x`, without the entries that are zero.
pub fn resisting<S: Scalar>(row: &[f64], x: &[S]) -> S {
    let entries = row.iter().zip(x).filter(|(k, _)| **k != 0.0);
    entries.fold(S::zero(), |sum, (&k, &x)| sum - x.scale(k))
}

impl Law for Field {
    fn angles(&self) -> &'static [Measure] {
        &ALL_ANGLES
    }

    fn action<S: Scalar>(
        &self,
        i: &MarkerState<S>,
        j: &MarkerState<S>,
        angle: impl Fn(Measure) -> S,
    ) -> Action<S> {
        let (x, rate) = deformation(i, j, ALL_ANGLES.map(angle));
        let stretch: [S; 6] = std::array::from_fn(|k| x[k] - S::constant(self.free[k]));
        let f = std::array::from_fn(|k| {
            S::constant(self.preload[k])
                + resisting(&self.stiffness[k], &stretch)
                + resisting(&self.damping[k], &rate)
        });
        in_axes_of(j, f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrices_are_read_by_columns_and_by_triangle() {
        let numbers: Vec<f64> = (0..36).map(f64::from).collect();
        let k = by_columns(&numbers).unwrap();
        assert_eq!((k[0][1], k[1][0], k[5][5]), (6.0, 1.0, 35.0));
        assert_eq!(by_columns(&numbers[1..]), None);
        let c = by_lower_triangle(&numbers[..21]).unwrap();
        assert_eq!(
            (c[0][0], c[1][0], c[0][1], c[2][1], c[5][5]),
            (0.0, 1.0, 1.0, 4.0, 20.0)
        );
    }
}
