//! A test whether a large symmetric matrix with many zeros is positive definite: [`is_positive`].
//!
//! ```text
//! P A Pᵀ = L Lᵀ       row i of L begins where row i of P A Pᵀ does: no fill outside the envelope
//! ```
//!
//! P numbers neighbours close to each other (reverse Cuthill–McKee), so that chains of parts have a
//! narrow envelope; a full matrix takes as long as its full factorization.
//!
//! Source: George & Liu, Computer Solution of Large Sparse Positive Definite Systems, 4.

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

/// Returns the other rows in which each row has an entry.
fn neighbours(a: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let mut neighbours = vec![Vec::new(); a.nrows()];
    for j in 0..a.ncols() {
        for (i, x) in a.column(j).iter().enumerate().skip(j + 1) {
            if *x != 0.0 {
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
        next.sort_by_key(|&j| neighbours[j].len());
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
    }
}
