//! Dependence among the rows of a matrix: rank, independent rows, combinations, free directions,
//! least-norm solutions.
//!
//! ```text
//! rows      aᵢ = dᵢ âᵢ,  |âᵢ| = 1                                        (1)
//! pivots    Householder reflections on the rows, one row per pivot:
//!           Â = L Qᵀ,  L m × r lower trapezoidal                          (2)
//! chosen    the first row, in the order given, whose part outside the rows chosen so far is at
//!           least a tenth of the largest such part
//! stop      when that largest part is below the tolerance: the rank is the number of rows chosen
//! row       aₖ = Σ cⱼ aⱼ over independent j:   L₁ᵀ ĉ = ℓₖ                 (3)
//! solution  x = Q z,  z = argmin |L z − b̂|                                (4)
//! ```
//!
//! *Preference for the order given*: of two equivalent rows the first counts as independent, so
//! that later rows are reported as redundant.
//!
//! *Tolerance*: where a mechanism satisfies its constraints to 1e-10 … 1e-12, a dependent row
//! differs from the combination of others by errors of that size, however many bodies lie between;
//! rows that differ because a user typed six or seven digits differ by 1e-7 and more. [`TOLERANCE`]
//! lies between. [`Rank::margin`] tells how clear the decision was, for a caller that wants to
//! warn. Rows are compared by direction, so their units do not matter; columns of different units
//! should be scaled alike by the caller (a length of the mechanism).
//!
//! *Zeros*: a reflection touches the columns where its vector is not zero, and only rows that have
//! something there; the parts of all other rows stay as they were measured. Rows are found by the
//! first column in which they have anything, the next one to choose by a tree of the largest parts.
//! So rows that share columns with few others, as in a long chain of loops, take about as long as
//! their entries.

use std::convert::Infallible;
use std::ops::Range;

/// Part of a row outside the others, relative to its length, below which it depends on them.
pub const TOLERANCE: f64 = 1e-8;
/// Length of a row, as a part of the longest, below which it is empty.
const EMPTY_ROW: f64 = 1e-13;
/// Part of the largest remainder that an earlier row needs to be chosen before it.
const PREFERENCE_FOR_EARLIER: f64 = 0.1;

/// A row that depends on others.
#[derive(Clone, Debug, PartialEq)]
pub struct Dependence {
    /// the dependent row
    pub row: usize,
    /// independent rows and their factors: `a[row] = Σ factor · a[independent row]`; empty for an
    /// empty row
    pub combination: Vec<(usize, f64)>,
    /// length of what the combination leaves over, relative to the length of the row
    pub remainder: f64,
}

/// Householder vector: its places, ascending, and its values there.
type Reflection = Vec<(usize, f64)>;

/// The rank decision over an `m × n` matrix.
#[derive(Clone, Debug)]
pub struct Rank {
    n: usize,
    /// number of independent rows
    rank: usize,
    /// rows in the order of choice, then the dependent ones in the order given   (m)
    order: Vec<usize>,
    /// lengths dᵢ of (1), by row   (m)
    length: Vec<f64>,
    /// rows of L, by row; beyond the rank, the remainder of the row   (m × n)
    l: Vec<Vec<f64>>,
    /// Householder vectors v, I − v vᵀ with |v|² = 2, without their zeros   (rank)
    reflections: Vec<Reflection>,
    /// smallest part of a row that was kept, and largest part that was dropped
    margin: (f64, f64),
}

/// Pivots that are chosen between two looks whether to go on.
const PIVOTS_BETWEEN_LOOKS: usize = 64;

/// The look of a caller who does not want to end early.
fn goes_on() -> Result<(), Infallible> {
    Ok(())
}

impl Rank {
    /// Decides the rank of the matrix with the given `rows`, each of length `n`.
    pub fn of<'a>(rows: impl IntoIterator<Item = &'a [f64]>, n: usize, tolerance: f64) -> Self {
        let Ok(rank) = Self::of_while(rows, n, tolerance, &mut goes_on);
        rank
    }

    /// The same, asking `look` after every few pivots whether to go on.
    ///
    /// # Errors
    /// The answer of `look`.
    pub fn of_while<'a, E>(
        rows: impl IntoIterator<Item = &'a [f64]>,
        n: usize,
        tolerance: f64,
        look: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Self, E> {
        Self::of_rows_while(
            rows.into_iter().map(<[f64]>::to_vec).collect(),
            n,
            tolerance,
            look,
        )
    }

    /// Decides the rank as [`Rank::of`] does, of rows that nobody else needs.
    pub(crate) fn of_rows(rows: Vec<Vec<f64>>, n: usize, tolerance: f64) -> Self {
        let Ok(rank) = Self::of_rows_while(rows, n, tolerance, &mut goes_on);
        rank
    }

    /// The same, asking `look` as [`Rank::of_while`] does.
    ///
    /// # Errors
    /// The answer of `look`.
    pub(crate) fn of_rows_while<E>(
        rows: Vec<Vec<f64>>,
        n: usize,
        tolerance: f64,
        look: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Self, E> {
        let mut l = rows;
        let of_row = |row: &Vec<f64>| norm(&row[span_from(row, 0, n)]);
        let mut length: Vec<f64> = l.iter().map(of_row).collect();
        let longest = length
            .iter()
            .copied()
            .filter(|d| d.is_finite())
            .fold(0.0, f64::max);
        for (row, d) in l.iter_mut().zip(&mut length) {
            if *d > EMPTY_ROW * longest && d.is_finite() {
                row.iter_mut().for_each(|a| *a /= *d);
            } else {
                row.fill(0.0);
                *d = 1.0;
            }
        }
        let leading = l.len();
        Self::decide(l, length, leading, (n, tolerance), look)
    }

    /// Decides the rank of rows that have been scaled by what counts as one in each, so that a
    /// short row determines little: parts of rows and `tolerance` are absolute. Only the first
    /// `leading` rows may be chosen; the others are told as dependent, with their remainders.
    pub fn scaled(rows: Vec<Vec<f64>>, leading: usize, n: usize, tolerance: f64) -> Self {
        let length = vec![1.0; rows.len()];
        let Ok(rank) = Self::decide(rows, length, leading, (n, tolerance), &mut goes_on);
        rank
    }

    /// Chooses rows, one per pivot, among the first `leading`.
    fn decide<E>(
        mut l: Vec<Vec<f64>>,
        length: Vec<f64>,
        leading: usize,
        (n, tolerance): (usize, f64),
        look: &mut dyn FnMut() -> Result<(), E>,
    ) -> Result<Self, E> {
        let (mut chosen, mut reflections) = (Vec::new(), Vec::new());
        let (mut kept, mut dropped) = (1.0f64, 0.0f64);
        // the columns that each row lies between, and its part outside the rows chosen so far
        let mut spans = Spans::new(l.iter().map(|row| span_from(row, 0, n)).collect(), n);
        let open = l[..leading].iter().zip(&spans.of_row);
        let mut parts = Parts::new(open.map(|(row, span)| norm(&row[span.clone()])));
        let mut met = Vec::new();
        while chosen.len() < l.len() {
            let k = chosen.len();
            let largest = parts.largest();
            if k == n || largest <= tolerance {
                dropped = largest;
                break;
            }
            if k % PIVOTS_BETWEEN_LOOKS == PIVOTS_BETWEEN_LOOKS - 1 {
                look()?;
            }
            let pivot = parts.first_from(PREFERENCE_FOR_EARLIER * largest);
            kept = kept.min(parts.of(pivot));
            parts.take(pivot);
            spans.close(pivot);
            let end = spans.of_row[pivot].end;
            let v = reflection(&l[pivot], k, end);
            reflect(&v, &mut l[pivot]);
            let others = v.get(1).map_or(n, |e| e.0)..v.last().map_or(0, |e| e.0 + 1);
            spans.take_met(k, &others, &mut met);
            for i in met.drain(..) {
                let row = &mut l[i];
                if reflect(&v, row) || row[k] != 0.0 {
                    let end = spans.of_row[i].end.max(others.end);
                    spans.of_row[i] = span_from(row, k + 1, end);
                    if i < leading {
                        parts.set(i, norm(&row[spans.of_row[i].clone()]));
                    }
                }
                spans.put_back(i);
            }
            l[pivot][k + 1..end.max(k + 1)].fill(0.0);
            reflections.push(v);
            chosen.push(pivot);
        }
        let rank = chosen.len();
        chosen.extend((0..l.len()).filter(|&i| spans.is_open[i]));
        Ok(Rank {
            n,
            rank,
            order: chosen,
            length,
            l,
            reflections,
            margin: (kept, dropped),
        })
    }

    /// Returns the number of independent rows.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Returns the independent rows, ascending.
    pub fn independent(&self) -> Vec<usize> {
        let mut rows = self.order[..self.rank].to_vec();
        rows.sort_unstable();
        rows
    }

    /// Returns the smallest part of a row that was taken for independent, and the largest that was
    /// taken for dependent, relative to the lengths of the rows.
    pub fn margin(&self) -> (f64, f64) {
        self.margin
    }

    /// Returns the dependent rows, ascending, each with its combination of independent ones (3).
    pub fn dependent(&self) -> Vec<Dependence> {
        let r = self.rank;
        let mut found = Vec::new();
        // entries of the rows of L₁ before the last
        let entries = |j: usize| {
            let row = self.l[self.order[j]][..j].iter().copied().enumerate();
            row.filter(|e| e.1 != 0.0).collect()
        };
        let before: Vec<Vec<(usize, f64)>> = match r < self.order.len() {
            true => (0..r).map(entries).collect(),
            false => Vec::new(),
        };
        for row in &self.order[r..] {
            let target = &self.l[*row];
            // back substitution with L₁ᵀ
            let mut c = target[..r].to_vec();
            for j in (0..r).rev() {
                if c[j] == 0.0 {
                    continue;
                }
                c[j] /= self.l[self.order[j]][j];
                for &(i, x) in &before[j] {
                    c[i] -= x * c[j];
                }
            }
            let mut combination: Vec<(usize, f64)> = (0..r)
                .filter(|j| c[*j].abs() > TOLERANCE)
                .map(|j| {
                    (
                        self.order[j],
                        c[j] * self.length[*row] / self.length[self.order[j]],
                    )
                })
                .collect();
            combination.sort_unstable_by_key(|(row, _)| *row);
            found.push(Dependence {
                row: *row,
                combination,
                remainder: norm(&target[r..]),
            });
        }
        found.sort_unstable_by_key(|d| d.row);
        found
    }

    /// Returns directions `x` with `A x = 0`, one per unknown that the rows leave free: orthonormal
    /// ((n − rank) × n)
    pub fn free_directions(&self) -> Vec<Vec<f64>> {
        (self.rank..self.n)
            .map(|k| {
                let mut x = vec![0.0; self.n];
                x[k] = 1.0;
                self.leave_basis(&mut x);
                x
            })
            .collect()
    }

    /// Returns the same directions, combined so that each has a one at an unknown of its own and
    /// zeros at those of the others, beside these unknowns.
    pub fn free_motions(&self) -> Vec<(usize, Vec<f64>)> {
        let mut motions = self.free_directions();
        let mut own = Vec::new();
        for i in 0..motions.len() {
            let rest = motions[i].iter().enumerate();
            let largest = rest.fold((0, 0.0), |best: (usize, f64), (j, x)| {
                if x.abs() > best.1 * (1.0 + 1e-9) {
                    (j, x.abs())
                } else {
                    best
                }
            });
            let j = largest.0;
            let scale = motions[i][j];
            motions[i].iter_mut().for_each(|x| *x /= scale);
            let pivot = motions[i].clone();
            for (k, other) in motions.iter_mut().enumerate() {
                if k != i {
                    let factor = other[j];
                    other
                        .iter_mut()
                        .zip(&pivot)
                        .for_each(|(x, p)| *x -= factor * p);
                    other[j] = 0.0;
                }
            }
            own.push(j);
        }
        for x in motions.iter_mut().flatten() {
            if x.abs() < 1e-13 {
                *x = 0.0;
            }
        }
        let mut motions: Vec<_> = own.into_iter().zip(motions).collect();
        motions.sort_unstable_by_key(|(j, _)| *j);
        motions
    }

    /// Finds the shortest `x` that satisfies `A x = b` best (4), each row counting by its
    /// direction.
    ///
    /// Returns the row with the largest distance left and that distance `|aᵢ x − bᵢ|`: zero up to
    /// rounding when the rows do not contradict each other.
    pub fn least_norm(&self, b: &[f64], x: &mut [f64]) -> (usize, f64) {
        self.solve(|_| 1.0, b, x)
    }

    /// Finds the shortest `x` with the least `|A x − b|`, each row counting with its length;
    /// returns as [`Rank::least_norm`] does.
    pub fn least_squares(&self, b: &[f64], x: &mut [f64]) -> (usize, f64) {
        self.solve(|i| self.length[i], b, x)
    }

    /// Minimizes `Σ weight² (âᵢ x − b̂ᵢ)²`.
    fn solve(&self, weight: impl Fn(usize) -> f64, b: &[f64], x: &mut [f64]) -> (usize, f64) {
        let (m, r) = (self.order.len(), self.rank);
        // argmin |L z − b̂| by reflections on the columns of L, rows in the order of choice
        let column = |j: usize| {
            let entry = |i: &usize| weight(*i) * self.l[*i][j];
            self.order.iter().map(entry).collect()
        };
        let mut columns: Vec<Vec<f64>> = (0..r).map(column).collect();
        let right = |i: &usize| weight(*i) * b[*i] / self.length[*i];
        let mut rest: Vec<f64> = self.order.iter().map(right).collect();
        for k in 0..r {
            let v = reflection(&columns[k], k, m);
            for column in &mut columns[k..] {
                reflect(&v, column);
            }
            reflect(&v, &mut rest);
        }
        x.fill(0.0);
        for k in (0..r).rev() {
            let known: f64 = (k + 1..r).map(|j| columns[j][k] * x[j]).sum();
            x[k] = (rest[k] - known) / columns[k][k];
        }
        let z = x[..r].to_vec();
        self.leave_basis(x);
        let distance = |i: usize| {
            let row = &self.l[i];
            (row[..r].iter().zip(&z).map(|(l, z)| l * z).sum::<f64>() * self.length[i] - b[i]).abs()
        };
        (0..m).map(|i| (i, distance(i))).fold(
            (0, 0.0),
            |worst, (i, d)| if d > worst.1 { (i, d) } else { worst },
        )
    }

    /// Multiplies `x ← Q x`.
    fn leave_basis(&self, x: &mut [f64]) {
        for v in self.reflections.iter().rev() {
            reflect(v, x);
        }
    }
}

/// The columns between which rows have anything, and the rows by the first of these: what a
/// reflection touches is found among few.
struct Spans {
    /// by row
    of_row: Vec<Range<usize>>,
    /// whether a row has not been chosen, by row
    is_open: Vec<bool>,
    /// open rows whose span begins at a column, where there are many   (n + 1)
    starting_at: Vec<Vec<usize>>,
}

/// Number of rows up to which all of them are looked at for each pivot.
const FEW_ROWS: usize = 16;

impl Spans {
    fn new(of_row: Vec<Range<usize>>, n: usize) -> Self {
        let mut starting_at = Vec::new();
        if of_row.len() > FEW_ROWS {
            starting_at.resize_with(n + 1, Vec::new);
            for (i, span) in of_row.iter().enumerate() {
                starting_at[span.start].push(i);
            }
        }
        Self {
            is_open: vec![true; of_row.len()],
            of_row,
            starting_at,
        }
    }

    /// Takes a row out for good.
    fn close(&mut self, row: usize) {
        self.is_open[row] = false;
        if let Some(starting) = self.starting_at.get_mut(self.of_row[row].start) {
            starting.retain(|&i| i != row);
        }
    }

    /// Takes out the open rows that begin at column `k`, before which none has anything, or have
    /// something between `others`: into `met`.
    fn take_met(&mut self, k: usize, others: &Range<usize>, met: &mut Vec<usize>) {
        let meets = |span: &Range<usize>| {
            span.start == k || span.start < others.end && others.start < span.end
        };
        if self.starting_at.is_empty() {
            let is_met = |&i: &usize| self.is_open[i] && meets(&self.of_row[i]);
            met.extend((0..self.of_row.len()).filter(is_met));
            return;
        }
        for column in k..others.end.max(k + 1) {
            let is_met = |i: &mut usize| meets(&self.of_row[*i]);
            met.extend(self.starting_at[column].extract_if(.., is_met));
        }
    }

    /// Puts a row back that was taken out.
    fn put_back(&mut self, row: usize) {
        if let Some(starting) = self.starting_at.get_mut(self.of_row[row].start) {
            starting.push(row);
        }
    }
}

/// The parts of rows outside those chosen so far, as a tree of the largest below: the largest and
/// the first large one are found without looking at all.
struct Parts {
    /// node j has the children 2j and 2j + 1; the leaves are the rows
    tree: Vec<f64>,
    n_leaves: usize,
}

impl Parts {
    fn new(parts: impl ExactSizeIterator<Item = f64>) -> Self {
        let n_leaves = parts.len().next_power_of_two();
        let mut tree = Vec::with_capacity(2 * n_leaves);
        tree.resize(n_leaves, f64::NEG_INFINITY);
        tree.extend(parts);
        tree.resize(2 * n_leaves, f64::NEG_INFINITY);
        for j in (1..n_leaves).rev() {
            tree[j] = tree[2 * j].max(tree[2 * j + 1]);
        }
        Self { tree, n_leaves }
    }

    fn of(&self, row: usize) -> f64 {
        self.tree[self.n_leaves + row]
    }

    /// Returns the largest part; 0 where no row is left.
    fn largest(&self) -> f64 {
        self.tree[1].max(0.0)
    }

    /// Returns the first row whose part is no less than `least`, which one is.
    fn first_from(&self, least: f64) -> usize {
        let mut j = 1;
        while j < self.n_leaves {
            j = 2 * j + usize::from(self.tree[2 * j] < least || self.tree[2 * j].is_nan());
        }
        j - self.n_leaves
    }

    fn set(&mut self, row: usize, part: f64) {
        let mut j = self.n_leaves + row;
        self.tree[j] = part;
        while j > 1 {
            j /= 2;
            self.tree[j] = self.tree[2 * j].max(self.tree[2 * j + 1]);
        }
    }

    /// Takes a row out for good.
    fn take(&mut self, row: usize) {
        self.set(row, f64::NEG_INFINITY);
    }
}

/// Returns the length of a vector, without overflow on the way.
fn norm(x: &[f64]) -> f64 {
    let largest = x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    largest
        * x.iter()
            .map(|x| (x / largest) * (x / largest))
            .sum::<f64>()
            .sqrt()
}

/// Returns the columns between `from` and `end` outside which a row has nothing there; an empty
/// range at `end` where it has nothing at all.
fn span_from(row: &[f64], from: usize, end: usize) -> Range<usize> {
    let entries = &row[from..end];
    let Some(first) = entries.iter().position(|x| *x != 0.0) else {
        return end..end;
    };
    let last = entries.iter().rposition(|x| *x != 0.0).unwrap_or(first);
    from + first..from + last + 1
}

/// Returns the Householder vector that turns `x[k..]`, which has nothing from `end` on, into its
/// first component.
fn reflection(x: &[f64], k: usize, end: usize) -> Reflection {
    let x = &x[..end.max(k + 1)];
    let length = norm(&x[k..]);
    let first = x[k] + if x[k] < 0.0 { -length } else { length };
    let others = x.iter().copied().enumerate().skip(k + 1);
    let mut v = vec![(k, first)];
    v.extend(others.filter(|e| e.1 != 0.0));
    let values: Vec<f64> = v.iter().map(|e| e.1).collect();
    let size = norm(&values);
    if size > 0.0 {
        v.iter_mut()
            .for_each(|e| e.1 *= std::f64::consts::SQRT_2 / size);
    }
    v
}

/// Reflects `x ← (I − v vᵀ) x`; returns whether that changes x.
fn reflect(v: &[(usize, f64)], x: &mut [f64]) -> bool {
    let along: f64 = v.iter().map(|&(i, v)| v * x[i]).sum();
    if along == 0.0 {
        return false;
    }
    v.iter().for_each(|&(i, v)| x[i] -= along * v);
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn of(rows: &[&[f64]], n: usize) -> Rank {
        Rank::of(rows.iter().copied(), n, TOLERANCE)
    }

    #[test]
    fn later_rows_are_the_superfluous_ones() {
        let rank = of(
            &[
                &[1.0, 0.0, 0.0],
                &[0.0, 2.0, 0.0],
                &[3.0, 4.0, 0.0],
                &[0.0, 0.0, 0.0],
                &[0.0, 0.0, 1e-3],
            ],
            3,
        );
        assert_eq!((rank.rank(), rank.independent()), (3, vec![0, 1, 4]));
        let dependent = rank.dependent();
        assert_eq!((dependent[0].row, dependent[1].row), (2, 3));
        assert_eq!(dependent[0].combination.len(), 2);
        for ((row, factor), expected) in dependent[0].combination.iter().zip([(0, 3.0), (1, 2.0)]) {
            assert_eq!(*row, expected.0);
            assert!((factor - expected.1).abs() < 1e-14);
        }
        assert!(dependent[1].combination.is_empty());
    }

    #[test]
    fn a_free_motion_has_a_one_of_its_own() {
        let rank = of(&[&[1.0, 1.0, 0.0, 0.0], &[0.0, 0.0, 1.0, -2.0]], 4);
        let motions = rank.free_motions();
        assert_eq!(motions.len(), 2);
        for (j, motion) in &motions {
            assert!((motion[*j] - 1.0).abs() < 1e-14);
            assert!(
                (motion[0] + motion[1]).abs() < 1e-14
                    && (motion[2] - 2.0 * motion[3]).abs() < 1e-14
            );
            assert_eq!(motion.iter().filter(|x| **x != 0.0).count(), 2);
        }
    }

    #[test]
    fn contradiction_is_measured() {
        let rank = of(&[&[1.0, 1.0], &[2.0, 2.0]], 2);
        let mut x = [0.0; 2];
        let (_, distance) = rank.least_norm(&[2.0, 4.0], &mut x);
        assert!(distance < 1e-14 && (x[0] - 1.0).abs() < 1e-14 && (x[1] - 1.0).abs() < 1e-14);
        let (row, distance) = rank.least_norm(&[2.0, 6.0], &mut x);
        assert_eq!(row, 1);
        assert!((distance - 1.0).abs() < 1e-14, "{distance}");
    }

    #[test]
    fn a_rank_is_left_after_a_few_pivots_where_the_caller_wants_that() {
        let n = 5 * PIVOTS_BETWEEN_LOOKS;
        // dense and well conditioned
        let entry =
            |i: usize, j: usize| ((i * 7 + j * 3) % 11) as f64 + if i == j { 1e3 } else { 0.0 };
        let rows: Vec<Vec<f64>> = (0..n)
            .map(|i| (0..n).map(|j| entry(i, j)).collect())
            .collect();
        let decided = |most: usize| {
            let mut looks = 0;
            let mut look = || {
                looks += 1;
                if looks < most { Ok(()) } else { Err(looks) }
            };
            Rank::of_while(rows.iter().map(Vec::as_slice), n, TOLERANCE, &mut look)
                .map(|r| r.rank())
        };
        assert_eq!(decided(usize::MAX), Ok(n));
        for most in 1..=5 {
            assert_eq!(decided(most), Err(most));
        }
    }

    #[test]
    fn empty_and_odd_shapes_are_fine() {
        assert_eq!(of(&[], 3).rank(), 0);
        assert_eq!(of(&[], 3).free_directions().len(), 3);
        assert_eq!(of(&[&[], &[]], 0).rank(), 0);
        assert_eq!(of(&[&[0.0, 0.0]], 2).dependent().len(), 1);
        assert_eq!(of(&[&[f64::NAN, 0.0], &[1.0, 0.0]], 2).independent(), [1]);
    }

    /// The rows that are chosen where all open rows are looked at for each pivot, and their parts.
    fn chosen_plainly(mut rows: Vec<Vec<f64>>, leading: usize, n: usize) -> (Vec<usize>, Vec<f64>) {
        let (mut chosen, mut kept): (Vec<usize>, Vec<f64>) = (Vec::new(), Vec::new());
        while chosen.len() < n {
            let k = chosen.len();
            let open: Vec<usize> = (0..leading).filter(|i| !chosen.contains(i)).collect();
            let part = |i: usize| norm(&rows[i][k..]);
            let largest = open.iter().map(|&i| part(i)).fold(0.0, f64::max);
            let large = |i: &&usize| part(**i) >= PREFERENCE_FOR_EARLIER * largest;
            let Some(&pivot) = open.iter().find(large).filter(|_| largest > TOLERANCE) else {
                break;
            };
            kept.push(part(pivot));
            let v = reflection(&rows[pivot], k, n);
            for (i, row) in rows.iter_mut().enumerate() {
                if !chosen.contains(&i) {
                    reflect(&v, row);
                }
            }
            chosen.push(pivot);
        }
        (chosen, kept)
    }

    proptest! {
        /// The rows that are found by their spans and by the tree of parts are those that looking
        /// at all of them finds.
        #[test]
        fn rows_are_those_that_looking_at_all_chooses(
            m in 1usize..14, n in 1usize..12, leading in 0usize..14,
            numbers in proptest::collection::vec(-1.0f64..1.0, 200),
            gaps in proptest::collection::vec(0usize..5, 200),
        ) {
            let leading = leading.min(m);
            // half of the entries are zero, and so are some rows
            let entry = |k: usize| if gaps[k % 200] > 1 { 0.0 } else { numbers[k % 200] };
            let row = |i: usize| (0..n).map(|j| entry(i * 13 + j)).collect();
            let rows: Vec<Vec<f64>> = (0..m).map(row).collect();
            let rank = Rank::scaled(rows.clone(), leading, n, TOLERANCE);
            let (chosen, kept) = chosen_plainly(rows, leading, n);
            prop_assert_eq!(&rank.order[..rank.rank], &chosen[..]);
            let least = kept.into_iter().fold(1.0, f64::min);
            prop_assert!((rank.margin().0 - least).abs() < 1e-12);
        }

        /// A product of random factors has the rank of the thinner one, and everything that is
        /// claimed of it holds.
        #[test]
        fn random_products_have_the_rank_they_were_given(
            m in 1usize..9, n in 1usize..9, r in 0usize..6,
            numbers in proptest::collection::vec(-1.0f64..1.0, 200),
        ) {
            let r = r.min(m).min(n);
            let mut draw = numbers.iter().cycle().copied();
            let left: Vec<Vec<f64>> = (0..m).map(|_| draw.by_ref().take(r).collect()).collect();
            let right: Vec<Vec<f64>> = (0..r).map(|_| draw.by_ref().take(n).collect()).collect();
            let rows: Vec<Vec<f64>> = left
                .iter()
                .map(|l| (0..n).map(|j| l.iter().zip(&right).map(|(a, b)| a * b[j]).sum()).collect())
                .collect();
            let rank = Rank::of(rows.iter().map(Vec::as_slice), n, TOLERANCE);
            prop_assume!(rank.margin().0 > 1e-4);
            prop_assert!(rank.rank() <= r);
            prop_assert_eq!(rank.rank() + rank.dependent().len(), m);
            for d in rank.dependent() {
                for (j, a) in rows[d.row].iter().enumerate() {
                    let sum: f64 = d.combination.iter().map(|(k, c)| c * rows[*k][j]).sum();
                    prop_assert!((sum - a).abs() < 1e-7);
                }
            }
            for x in rank.free_directions() {
                for row in &rows {
                    prop_assert!(row.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>().abs() < 1e-12);
                }
            }
            // least norm: solves consistent equations, orthogonal to the free directions
            let b: Vec<f64> = rows.iter().map(|row| row.iter().enumerate().map(|(j, a)| a * (j as f64 - 1.5)).sum()).collect();
            let mut x = vec![0.0; n];
            let (_, distance) = rank.least_norm(&b, &mut x);
            prop_assert!(distance < 1e-9, "{}", distance);
            // least squares: what is left of any right side is square to the columns
            let odd: Vec<f64> = (0..m).map(|i| numbers[i] - numbers[i + 7]).collect();
            rank.least_squares(&odd, &mut x);
            let left: Vec<f64> = rows.iter().zip(&odd).map(|(row, b)| row.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>() - b).collect();
            for j in 0..n {
                prop_assert!(rows.iter().zip(&left).map(|(row, d)| row[j] * d).sum::<f64>().abs() < 1e-9);
            }
            rank.least_norm(&b, &mut x);
            for free in rank.free_directions() {
                prop_assert!(free.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>().abs() < 1e-9);
            }
        }
    }
}
