//! The turn of rows: whether a combination of them has gone through zero between two states.
//!
//! ```text
//! B = G₁ A G₀ᵀ (G₀ A G₀ᵀ)⁻¹      rows G₀ at one state, G₁ at a later one; one where they are the same
//! ```
//!
//! It has where an eigenvalue of B is negative (`sides.rs`). Most often it is seen sooner that none
//! is: B is similar to L⁻¹ G₁ A G₀ᵀ L⁻ᵀ, whose eigenvalues lie in its field of values.

use super::selection::Rows;
use crate::numeric::eigenvalues::eigenvalues;
use crate::numeric::envelope;
use nalgebra::DMatrix;
use std::cell::OnceCell;

/// Rows of the largest loop whose eigenvalues are found; of a larger one signs of determinants must
/// do.
const MAX_EIGENVALUES: usize = 60;
/// Parts s of the way from G₀ A G₀ᵀ to G₁ A G₀ᵀ at which the signs of determinants are found: an
/// eigenvalue μ < 0 of B changes the sign at 1/(1 − μ), so that two are told apart.
const PARTS_OF_WAY: [f64; 8] = [0.35, 0.5, 0.65, 0.75, 0.84, 0.91, 0.96, 1.0];
/// Imaginary part of an eigenvalue that counts as real, over its real part: a turn of the rows by
/// 150° is not the passage of a singular position.
const NEARLY_REAL: f64 = 0.5;
/// Columns up to which zeros are not looked for.
const FEW_COLUMNS: usize = 12;

/// A square matrix by rows, one behind the other.
type Square = Vec<f64>;

/// The rows of a loop at the state from which others are judged.
pub(super) struct Beginning<'a> {
    rows: &'a Rows,
    /// G₀ A G₀ᵀ
    square: OnceCell<Square>,
    /// its factor, where it is positive definite
    factor: OnceCell<Option<Square>>,
}

impl<'a> Beginning<'a> {
    pub fn at(rows: &'a Rows) -> Self {
        Self {
            rows,
            square: OnceCell::new(),
            factor: OnceCell::new(),
        }
    }

    /// Returns whether a combination of the rows has gone through zero from here to another state.
    pub fn has_turned(&self, to: &Rows) -> bool {
        let n = self.rows.iter().len();
        // G₀ A G₁ᵀ, whose transpose is meant
        let mixed = products(self.rows, to);
        let mut twice = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                twice[i * n + j] = mixed[i * n + j] + mixed[j * n + i];
            }
        }
        let square = || self.square.get_or_init(|| products(self.rows, self.rows));
        if n > MAX_EIGENVALUES {
            let [square, mixed, twice] =
                [square(), &mixed, &twice].map(|a| DMatrix::from_row_slice(n, n, a));
            return envelope::is_positive(&square)
                && !envelope::is_positive(&twice)
                && changes_sign(&square, &mixed);
        }
        if factored(&mut twice, n) {
            return false;
        }
        let factor = self.factor.get_or_init(|| {
            let mut factor = square().clone();
            factored(&mut factor, n).then_some(factor)
        });
        let Some(factor) = factor else {
            return false;
        };
        let mut b = mixed.clone();
        solve(factor, &mut b, n);
        if b.iter().any(|x| !x.is_finite()) {
            return false;
        }
        has_negative(&mut b, n).unwrap_or_else(|| {
            let [square, mixed] = [square(), &mixed].map(|a| DMatrix::from_row_slice(n, n, a));
            changes_sign(&square, &mixed)
        })
    }
}

/// Returns whether the determinant is negative somewhere on the way from a matrix whose own is
/// positive to another.
fn changes_sign(from: &DMatrix<f64>, to: &DMatrix<f64>) -> bool {
    let there = |s: &f64| from.scale(1.0 - s) + to.scale(*s);
    let mut parts = PARTS_OF_WAY.iter();
    parts.any(|s| envelope::has_negative_determinant(&there(s)))
}

/// Returns whether a matrix, which is lost, has an eigenvalue that is negative and nearly real;
/// `None`: they could not be found.
fn has_negative(b: &mut [f64], n: usize) -> Option<bool> {
    if let [a, b, c, d] = *b {
        let mean = 0.5 * (a + d);
        let spread = mean * mean - (a * d - b * c);
        let root = spread.abs().sqrt();
        return Some(match spread < 0.0 {
            true => mean < 0.0 && root <= NEARLY_REAL * mean.abs(),
            false => mean - root < 0.0,
        });
    }
    let is_negative = |&(re, im): &(f64, f64)| re < 0.0 && im.abs() <= NEARLY_REAL * re.abs();
    eigenvalues(b, n).map(|all| all.iter().any(is_negative))
}

/// Returns `A Bᵀ`.
fn products(a: &Rows, b: &Rows) -> Square {
    if a.n_columns() > FEW_COLUMNS {
        return sparse_products(a, b);
    }
    let n = b.iter().len();
    let mut out = Vec::with_capacity(a.iter().len() * n);
    for row in a.iter() {
        for other in b.iter() {
            out.push(row.iter().zip(other).fold(0.0, |sum, (x, y)| sum + x * y));
        }
    }
    out
}

/// Returns `A Bᵀ` of rows with many zeros.
fn sparse_products(a: &Rows, b: &Rows) -> Square {
    // the columns from the first to the last in which a row has anything
    let span = |row: &[f64]| {
        let first = row.iter().position(|x| *x != 0.0).unwrap_or(row.len());
        let last = row.iter().rposition(|x| *x != 0.0).map_or(0, |k| k + 1);
        (first, last)
    };
    let spans: Vec<_> = b.iter().map(span).collect();
    let n = spans.len();
    let mut out = Vec::with_capacity(a.iter().len() * n);
    let mut entries: Vec<(usize, f64)> = Vec::new();
    for row in a.iter() {
        entries.clear();
        entries.extend(row.iter().copied().enumerate().filter(|e| e.1 != 0.0));
        let (first, last) = span(row);
        for (&(begin, end), other) in spans.iter().zip(b.iter()) {
            let sum = match first < end && begin < last {
                true => entries.iter().map(|&(k, x)| x * other[k]).sum(),
                false => 0.0,
            };
            out.push(sum);
        }
    }
    out
}

/// Replaces the lower triangle of a symmetric matrix by its factor L of L Lᵀ; returns whether it is
/// positive definite.
fn factored(a: &mut [f64], n: usize) -> bool {
    for i in 0..n {
        let (above, row) = a.split_at_mut(i * n);
        for j in 0..i {
            let other = &above[j * n..][..n];
            let sum: f64 = row[..j].iter().zip(other).map(|(x, y)| x * y).sum();
            row[j] = (row[j] - sum) / other[j];
        }
        let pivot = row[i] - row[..i].iter().map(|x| x * x).sum::<f64>();
        // a pivot that is zero, negative or NaN
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        row[i] = pivot.sqrt();
    }
    true
}

/// Solves `L Lᵀ X = B` for all columns of B at once.
fn solve(factor: &[f64], b: &mut [f64], n: usize) {
    let less = |b: &mut [f64], (i, k): (usize, usize), factor: f64| {
        let (low, high) = b.split_at_mut(i.max(k) * n);
        let (first, last) = (&mut low[i.min(k) * n..][..n], &mut high[..n]);
        let (row, other) = if i < k { (first, last) } else { (last, first) };
        (row.iter_mut().zip(other)).for_each(|(x, y)| *x -= factor * *y);
    };
    for i in 0..n {
        (0..i).for_each(|k| less(b, (i, k), factor[i * n + k]));
        b[i * n..][..n]
            .iter_mut()
            .for_each(|x| *x /= factor[i * n + i]);
    }
    for i in (0..n).rev() {
        (i + 1..n).for_each(|k| less(b, (i, k), factor[k * n + i]));
        b[i * n..][..n]
            .iter_mut()
            .for_each(|x| *x /= factor[i * n + i]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_turn_right_round_have_gone_through_zero_and_others_have_not() {
        let turn = |degrees: f64| {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            DMatrix::from_row_slice(2, 2, &[cosine, -sine, sine, cosine])
        };
        let has_negative = |a: DMatrix<f64>| {
            let mut by_rows = a.transpose().as_slice().to_vec();
            super::has_negative(&mut by_rows, a.nrows())
        };
        let turns = [0.0, 60.0, 100.0, 149.0, 160.0, 180.0].map(|d| has_negative(turn(d)));
        assert_eq!(turns, [false, false, false, false, true, true].map(Some));
        let scaled = |x: f64| DMatrix::from_row_slice(2, 2, &[1.0, 5.0, 0.0, x]);
        assert_eq!(
            [-0.1, 0.1].map(|x| has_negative(scaled(x))),
            [Some(true), Some(false)]
        );
        let one = DMatrix::identity(2, 2);
        assert_eq!(
            [-0.1, 0.1].map(|x| changes_sign(&one, &scaled(x))),
            [true, false]
        );
        // the same beside a third row
        let beside = |b: DMatrix<f64>| b.insert_row(2, 0.0).insert_column(2, 0.0);
        for degrees in [60.0, 100.0, 160.0] {
            let mut b = beside(turn(degrees));
            b[(2, 2)] = 1.0;
            assert_eq!(has_negative(b), has_negative(turn(degrees)), "{degrees}°");
        }
    }
    #[test]
    fn a_factor_solves_what_its_square_multiplies_and_other_matrices_have_none() {
        for n in 1..9 {
            let numbers: Vec<f64> = (0..2 * n * (n + 2))
                .map(|k| (1.3 * (k * k) as f64).sin())
                .collect();
            let rows = |from: usize| {
                let mut rows = Rows::zeros(n, n + 2);
                let all = rows.iter_mut().zip(numbers[from..].chunks(n + 2));
                all.for_each(|(row, numbers)| row.copy_from_slice(numbers));
                rows
            };
            let (g, h) = (rows(0), rows(n * (n + 2)));
            let [square, mixed] = [&g, &h].map(|other| products(&g, other));
            let (mut factor, mut x) = (square.clone(), mixed.clone());
            assert!(factored(&mut factor, n));
            solve(&factor, &mut x, n);
            let [square, mixed, x] = [square, mixed, x].map(|a| DMatrix::from_row_slice(n, n, &a));
            let scale = x.amax().max(1.0);
            assert!((&square * x - &mixed).amax() < 1e-9 * scale, "{n}");
            let less = square - DMatrix::identity(n, n) * 20.0 * n as f64;
            assert!(!factored(&mut less.as_slice().to_vec(), n), "{n}");
        }
    }
}
