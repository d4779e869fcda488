//! Signs of large matrices with many zeros: whether a symmetric one is positive definite
//! ([`is_positive`]), and whether a determinant is negative ([`has_negative_determinant`]).
//!
//! ```text
//! P A Pᵀ = L Lᵀ       row i of L begins where row i of P A Pᵀ does: no fill outside the envelope
//! ```
//!
//! P numbers neighbours close to each other (reverse Cuthill–McKee), so that chains of parts have a
//! narrow envelope; a full matrix takes as long as its full factorization. An unsymmetric matrix is
//! eliminated within the band of its rows in that order, with the largest pivot of each column.
//!
//! Source: George & Liu, Computer Solution of Large Sparse Positive Definite Systems, 4.

use crate::arrange::Arrange;
use nalgebra::DMatrix;
use std::collections::VecDeque;

/// Returns whether a symmetric matrix is positive definite; its lower triangle is read.
pub fn is_positive(a: &DMatrix<f64>) -> bool {
    let n = a.nrows();
    if (0..n).any(|i| a[(i, i)] <= 0.0 || a[(i, i)].is_nan()) {
        return false;
    }
    let neighbours = neighbours(a);
    let order = order(&neighbours);
    let mut place = vec![0; n];
    for (k, &i) in order.iter().enumerate() {
        place[i] = k;
    }
    // rows of L, from their first entry to the diagonal
    let mut first = vec![0; n];
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(n);
    for (k, &i) in order.iter().enumerate() {
        let begin = neighbours[i].iter().map(|&j| place[j]).min();
        let begin = begin.unwrap_or(k).min(k);
        let mut row = vec![0.0; k + 1 - begin];
        row[k - begin] = a[(i, i)];
        for &j in &neighbours[i] {
            if place[j] < k {
                row[place[j] - begin] = a[(i.max(j), i.min(j))];
            }
        }
        for c in begin..k {
            let from = begin.max(first[c]);
            let sum: f64 = (row[from - begin..c - begin].iter())
                .zip(&rows[c][from - first[c]..])
                .map(|(x, y)| x * y)
                .sum();
            row[c - begin] = (row[c - begin] - sum) / rows[c][c - first[c]];
        }
        let squares: f64 = row[..k - begin].iter().map(|x| x * x).sum();
        let pivot = row[k - begin] - squares;
        // a pivot that is zero, negative or NaN
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        row[k - begin] = pivot.sqrt();
        first[k] = begin;
        rows.push(row);
    }
    true
}

/// Returns whether the determinant of a square matrix is negative; false where it has an entry that
/// is not finite, or is zero.
pub fn has_negative_determinant(a: &DMatrix<f64>) -> bool {
    let n = a.nrows();
    let order = order(&neighbours(a));
    // entries from the first to the last that is not zero, rows and columns in the same order
    let mut rows: Vec<Vec<f64>> = (order.iter())
        .map(|&i| order.iter().map(|&j| a[(i, j)]).collect())
        .collect();
    let last = |row: &[f64]| row.iter().rposition(|x| *x != 0.0).map_or(0, |j| j + 1);
    let mut end: Vec<usize> = rows.iter().map(|row| last(row)).collect();
    let first = |row: &[f64]| row.iter().position(|x| *x != 0.0).unwrap_or(n);
    let mut begin: Vec<usize> = rows.iter().map(|row| first(row)).collect();
    let mut negative = false;
    for k in 0..n {
        // rows that begin at this column; those beyond the band begin later
        let here: Vec<usize> = (k..n).filter(|&i| begin[i] == k).collect();
        let largest = |i: &usize, j: &usize| rows[*i][k].abs().total_cmp(&rows[*j][k].abs());
        let Some(pivot) = here.iter().copied().max_by(largest) else {
            return false;
        };
        if !rows[pivot][k].is_finite() || rows[pivot][k] == 0.0 {
            return false;
        }
        negative ^= (rows[pivot][k] < 0.0) ^ (pivot != k);
        rows.swap(k, pivot);
        end.swap(k, pivot);
        begin.swap(k, pivot);
        let (done, rest) = rows.split_at_mut(k + 1);
        for i in (k + 1..n).filter(|&i| begin[i] == k).collect::<Vec<_>>() {
            let row = &mut rest[i - k - 1];
            let factor = row[k] / done[k][k];
            end[i] = end[i].max(end[k]);
            for j in k..end[k] {
                row[j] -= factor * done[k][j];
            }
            let next = row[k + 1..end[i]].iter().position(|x| *x != 0.0);
            begin[i] = next.map_or(n, |j| k + 1 + j);
        }
    }
    negative
}

/// Returns the other rows that each row shares an entry with.
fn neighbours(a: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let mut neighbours = vec![Vec::new(); a.nrows()];
    for j in 0..a.ncols() {
        for i in j + 1..a.nrows() {
            if a[(i, j)] != 0.0 || a[(j, i)] != 0.0 {
                neighbours[i].push(j);
                neighbours[j].push(i);
            }
        }
    }
    neighbours
}

/// Orders the rows so that neighbours are close: breadth first from a peripheral row, fewest
/// neighbours first, then reversed.
fn order(neighbours: &[Vec<usize>]) -> Vec<usize> {
    let n = neighbours.len();
    let mut order = Vec::with_capacity(n);
    let mut seen = vec![false; n];
    for start in 0..n {
        if seen[start] {
            continue;
        }
        // the row farthest from any row is peripheral
        let far = *spread(start, neighbours, &mut seen.clone())
            .last()
            .unwrap_or(&start);
        order.extend(spread(far, neighbours, &mut seen));
    }
    order.reverse();
    order
}

/// Returns the rows connected with `start`, breadth first.
fn spread(start: usize, neighbours: &[Vec<usize>], seen: &mut [bool]) -> Vec<usize> {
    let mut all = Vec::new();
    let mut queue = VecDeque::from([start]);
    seen[start] = true;
    while let Some(i) = queue.pop_front() {
        all.push(i);
        let mut next: Vec<usize> = (neighbours[i].iter().copied())
            .filter(|&j| !std::mem::replace(&mut seen[j], true))
            .collect();
        next.arrange_by_key(|&j| neighbours[j].len());
        queue.extend(next);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// As a full Cholesky factorization says it, whatever is zero.
        #[test]
        fn what_is_positive_is_seen_through_any_envelope(
            n in 1usize..25,
            places in proptest::collection::vec((0usize..25, 0usize..25, -1.0..1.0), 0..60),
            shift in -1.0..4.0,
        ) {
            let mut a = DMatrix::<f64>::from_diagonal_element(n, n, shift);
            for (i, j, x) in places {
                a[(i % n, j % n)] += x;
                a[(j % n, i % n)] += x;
            }
            let least = a.clone().symmetric_eigen().eigenvalues.min();
            prop_assume!(least.abs() > 1e-9);
            prop_assert_eq!(is_positive(&a), least > 0.0);
        }

        /// As a full factorization says it, whatever is zero.
        #[test]
        fn the_sign_of_a_determinant_is_seen_through_any_band(
            n in 1usize..25,
            places in proptest::collection::vec((0usize..25, 0usize..25, -1.0..1.0), 0..90),
            shift in -1.0..1.0,
        ) {
            let mut a = DMatrix::<f64>::from_diagonal_element(n, n, shift);
            for (i, j, x) in places {
                a[(i % n, j % n)] += x;
            }
            let determinant = a.determinant();
            let size: f64 = a.row_iter().map(|row| row.norm()).product();
            prop_assume!(determinant.abs() > 1e-9 * size);
            prop_assert_eq!(has_negative_determinant(&a), determinant < 0.0);
        }
    }
}
