//! The sparse systems of Radau's iteration, with positions eliminated first.
//!
//! ```text
//! S   blocks of few unknowns whose rates depend on them and on few others, of which none is in S
//!     (q̇ = v; the four coordinates of a rotation, whose rates depend on them and on ω)
//! R   all others
//! D = (γ − J_SS)⁻¹, block by block                        γ real, or complex: α + iβ
//! (γ − J_RR − J_RS D J_SR) x_R = b_R + J_RS D b_S                               (1)
//! x_S = D (b_S + J_SR x_R)                                                      (2)
//! ```
//!
//! The terms that (1) adds to J_RR couple no bodies that forces do not couple: it has as many
//! unknowns as there are velocities, and no more fill than damping would make.
//!
//! *Stiffness*: as in `full.rs`.
//!
//! Source: Hairer & Wanner, Solving ODEs II, IV.8, "special structure of the problem".
#![allow(clippy::needless_range_loop)] // several arrays at one index read best that way

use super::full::MOST_ENTRIES;
use crate::arrange::Arrange;
use crate::numeric::pattern::Pattern;
use crate::numeric::sparse::{Factors, reciprocal, size, times};
use std::sync::Arc;

/// Both systems of the iteration, for a Jacobian of known pattern.
#[derive(Clone, Debug)]
pub(super) struct Sparse {
    pub pattern: Arc<Pattern>,
    elimination: Elimination,
    real: System<1>,
    complex: System<2>,
}

impl Sparse {
    /// Prepares both systems for a Jacobian of the given pattern.
    pub fn new(pattern: Arc<Pattern>) -> Self {
        let elimination = Elimination::new(&pattern, &blocks(&pattern));
        Self {
            real: System::new(&elimination),
            complex: System::new(&elimination),
            elimination,
            pattern,
        }
    }

    /// Returns how many unknowns are left when positions are eliminated.
    pub fn n_kept(&self) -> usize {
        self.elimination.kept.len()
    }

    /// Returns the number of entries of the factors of one matrix.
    pub fn fill(&self) -> usize {
        self.real.factors.fill()
    }

    /// Factors both matrices.
    ///
    /// # Errors
    /// The unknown that nothing determines.
    pub fn factor(&mut self, jacobian: &[f64], gamma: f64, complex: [f64; 2]) -> Result<(), usize> {
        self.elimination.see(jacobian);
        self.real.reduce(&self.elimination, jacobian, [gamma])?;
        self.real.factor(&self.elimination)?;
        self.complex.reduce(&self.elimination, jacobian, complex)?;
        self.complex.factor(&self.elimination)
    }

    /// `x ← (γ − J)⁻¹ x`
    pub fn solve(&mut self, x: &mut [f64]) {
        self.real.solve(&self.elimination, [x]);
    }

    /// `re + i im ← (α + iβ − J)⁻¹ (re + i im)`
    pub fn solve_complex(&mut self, re: &mut [f64], im: &mut [f64]) {
        self.complex.solve(&self.elimination, [re, im]);
    }
}

/// Finds the blocks of S: unknowns whose rates depend on the same ones, themselves among these.
fn blocks(pattern: &Pattern) -> Vec<Vec<usize>> {
    let n = pattern.n_columns();
    // unknowns that each rate depends on, and itself, ascending
    let mut reads: Vec<Vec<usize>> = vec![Vec::new(); n];
    for (i, j) in pattern.entries() {
        reads[i].push(j);
    }
    for (i, reads) in reads.iter_mut().enumerate() {
        if let Err(at) = reads.binary_search(&i) {
            reads.insert(at, i);
        }
    }
    let (mut is_chosen, mut is_read) = (vec![false; n], vec![false; n]);
    let mut blocks = Vec::new();
    for i in 0..n {
        if is_chosen[i] || reads[i].len() > 2 * MOST_ENTRIES {
            continue;
        }
        let is_alike = |j: &usize| reads[*j] == reads[i];
        let (block, others): (Vec<usize>, Vec<usize>) = reads[i].iter().partition(|j| is_alike(j));
        let is_small = block.len() <= MOST_ENTRIES && others.len() <= MOST_ENTRIES;
        let is_free = block.iter().all(|&j| !is_read[j]) && others.iter().all(|&j| !is_chosen[j]);
        if is_small && is_free {
            block.iter().for_each(|&j| is_chosen[j] = true);
            others.iter().for_each(|&j| is_read[j] = true);
            blocks.push(block);
        }
    }
    blocks
}

/// The blocks of S, and the entries of J by S and R.
#[derive(Clone, Debug)]
struct Elimination {
    blocks: Vec<Block>,
    /// the unknowns in S, by blocks
    eliminated: Vec<usize>,
    /// those in R, ascending
    kept: Vec<usize>,
    /// places in R of columns of J_SR and of rows of J_RS, by blocks
    places: Vec<usize>,
    /// entries of the Jacobian that are in J_SS, J_SR or J_RS, and their places in `values`
    entries: Vec<(usize, usize)>,
    /// J_SS, J_SR and J_RS of each block, by columns
    values: Vec<f64>,
    /// entries of the Jacobian that are in J_RR, and their places in the matrix of (1)
    inner: Vec<(usize, usize)>,
    /// places in the matrix of (1) of what elimination adds, by blocks and columns of J_SR
    targets: Vec<usize>,
    /// row and column of each entry of the matrix of (1), the diagonal first
    reduced: Vec<(usize, usize)>,
}

/// A block of S.
#[derive(Clone, Debug)]
struct Block {
    /// first of its unknowns among those in S
    begin: usize,
    /// number of its unknowns
    n: usize,
    /// beginning of its columns of J_SR, then its rows of J_RS, in `places`
    places: usize,
    n_columns: usize,
    n_rows: usize,
    /// beginning of its values
    values: usize,
    /// beginning of its columns of D J_SR among those of all blocks
    through: usize,
    /// beginning of its D
    inverse: usize,
}

impl Elimination {
    /// Sorts a pattern by the blocks of S and the rest.
    fn new(pattern: &Pattern, blocks: &[Vec<usize>]) -> Self {
        let n = pattern.n_columns();
        let eliminated: Vec<usize> = blocks.iter().flatten().copied().collect();
        // block and place in it of unknowns in S, place of those in R
        let mut in_block = vec![None; n];
        for (b, block) in blocks.iter().enumerate() {
            block
                .iter()
                .enumerate()
                .for_each(|(k, &i)| in_block[i] = Some((b, k)));
        }
        let kept: Vec<usize> = (0..n).filter(|&i| in_block[i].is_none()).collect();
        let mut place = vec![0; n];
        kept.iter().enumerate().for_each(|(k, &i)| place[i] = k);
        // entries of each block: number, row and column
        let mut columns = vec![Vec::new(); blocks.len()];
        let mut rows = vec![Vec::new(); blocks.len()];
        for (i, j) in pattern.entries() {
            match (in_block[i], in_block[j]) {
                (Some((b, _)), None) => columns[b].push(place[j]),
                (None, Some((b, _))) => rows[b].push(place[i]),
                _ => {}
            }
        }
        let mut own = Self {
            blocks: Vec::new(),
            eliminated,
            kept,
            places: Vec::new(),
            entries: Vec::new(),
            values: Vec::new(),
            inner: Vec::new(),
            targets: Vec::new(),
            reduced: Vec::new(),
        };
        let (mut begin, mut n_values, mut through, mut inverse) = (0, 0, 0, 0);
        for (block, (columns, rows)) in blocks.iter().zip(columns.iter_mut().zip(&mut rows)) {
            for list in [&mut *columns, &mut *rows] {
                list.sort_unstable();
                list.dedup();
            }
            let (k, c, r) = (block.len(), columns.len(), rows.len());
            own.blocks.push(Block {
                begin,
                n: k,
                places: own.places.len(),
                n_columns: c,
                n_rows: r,
                values: n_values,
                through,
                inverse,
            });
            own.places.extend(columns.iter().chain(rows.iter()));
            begin += k;
            n_values += k * (k + c + r);
            through += k * c;
            inverse += k * k;
        }
        own.values = vec![0.0; n_values];
        own.sort_entries(pattern, &in_block, &place);
        own
    }

    /// Finds where each entry of the Jacobian stands.
    fn sort_entries(
        &mut self,
        pattern: &Pattern,
        in_block: &[Option<(usize, usize)>],
        place: &[usize],
    ) {
        // wanted places of the matrix of (1): row, column, and where its number goes
        let mut wanted: Vec<(usize, usize, usize)> = Vec::new();
        let m = self.kept.len();
        for (e, (i, j)) in pattern.entries().enumerate() {
            let find = |list: &[usize], k: usize| list.partition_point(|&o| o < k);
            match (in_block[i], in_block[j]) {
                (Some((b, row)), other) => {
                    let block = &self.blocks[b];
                    let columns = &self.places[block.places..][..block.n_columns];
                    let column = match other {
                        Some((_, column)) => column,
                        None => block.n + find(columns, place[j]),
                    };
                    self.entries
                        .push((e, block.values + row + block.n * column));
                }
                (None, Some((b, column))) => {
                    let block = &self.blocks[b];
                    let (c, r) = (block.n_columns, block.n_rows);
                    let row = find(&self.places[block.places + c..][..r], place[i]);
                    let begin = block.values + block.n * (block.n + c);
                    self.entries.push((e, begin + row + r * column));
                }
                (None, None) => {
                    wanted.push((place[j], place[i], self.inner.len()));
                    self.inner.push((e, 0));
                }
            }
        }
        let n_inner = self.inner.len();
        for block in &self.blocks {
            let (columns, rows) = self.places[block.places..].split_at(block.n_columns);
            for &j in columns {
                for &i in &rows[..block.n_rows] {
                    wanted.push((j, i, n_inner + self.targets.len()));
                    self.targets.push(0);
                }
            }
        }
        self.reduced = (0..m).map(|i| (i, i)).collect();
        wanted.arrange();
        let mut last = None;
        for (j, i, to) in wanted {
            if i != j && last != Some((i, j)) {
                self.reduced.push((i, j));
                last = Some((i, j));
            }
            let at = if i == j { i } else { self.reduced.len() - 1 };
            match to.checked_sub(n_inner) {
                None => self.inner[to].1 = at,
                Some(target) => self.targets[target] = at,
            }
        }
    }

    /// Takes note of a new Jacobian.
    fn see(&mut self, jacobian: &[f64]) {
        for &(e, place) in &self.entries {
            self.values[place] = jacobian[e];
        }
    }

    /// Returns J_SS, J_SR and J_RS of a block, and the places in R of columns and rows.
    fn parts(&self, block: &Block) -> ([&[f64]; 3], [&[usize]; 2]) {
        let (k, c, r) = (block.n, block.n_columns, block.n_rows);
        let (inner, rest) = self.values[block.values..].split_at(k * k);
        let (links, rest) = rest.split_at(k * c);
        let (columns, rows) = self.places[block.places..].split_at(c);
        ([inner, links, &rest[..k * r]], [columns, &rows[..r]])
    }
}

/// One of the two systems; its numbers have `P` parts.
#[derive(Clone, Debug)]
struct System<const P: usize> {
    /// factors of the matrix of (1)
    factors: Factors<P>,
    /// entries of that matrix
    values: Vec<[f64; P]>,
    /// D of each block, by columns
    inverse: Vec<[f64; P]>,
    /// D J_SR of each block, by columns
    through: Vec<[f64; P]>,
    /// right-hand side of (1), parts apart   (R each)
    right: [Vec<f64>; P],
}

impl<const P: usize> System<P> {
    /// Prepares a system of the given elimination.
    fn new(elimination: &Elimination) -> Self {
        let m = elimination.kept.len();
        let sum = |n: fn(&Block) -> usize| elimination.blocks.iter().map(n).sum();
        Self {
            factors: Factors::new(m, &elimination.reduced),
            values: vec![[0.0; P]; elimination.reduced.len()],
            inverse: vec![[0.0; P]; sum(|b| b.n * b.n)],
            through: vec![[0.0; P]; sum(|b| b.n * b.n_columns)],
            right: std::array::from_fn(|_| vec![0.0; m]),
        }
    }

    /// Finds the matrix of (1) for a shift γ.
    ///
    /// # Errors
    /// The unknown that nothing determines.
    fn reduce(
        &mut self,
        elimination: &Elimination,
        jacobian: &[f64],
        shift: [f64; P],
    ) -> Result<(), usize> {
        self.values.fill([0.0; P]);
        for &(e, at) in &elimination.inner {
            self.values[at][0] -= jacobian[e];
        }
        for diagonal in &mut self.values[..elimination.kept.len()] {
            diagonal.iter_mut().zip(shift).for_each(|(d, s)| *d += s);
        }
        let mut targets = elimination.targets.iter();
        for block in &elimination.blocks {
            let ([inner, links, beside], _) = elimination.parts(block);
            let (k, c, r) = (block.n, block.n_columns, block.n_rows);
            let inverse = &mut self.inverse[block.inverse..][..k * k];
            invert(inverse, inner, shift)
                .map_err(|place| elimination.eliminated[block.begin + place])?;
            let through = &mut self.through[block.through..][..k * c];
            for (through, links) in through.chunks_exact_mut(k).zip(links.chunks_exact(k)) {
                through.fill([0.0; P]);
                for (column, link) in inverse.chunks_exact(k).zip(links) {
                    add_multiple(through, column, *link);
                }
                for row in 0..r {
                    let mut sum = [0.0; P];
                    for (s, through) in through.iter().enumerate() {
                        let value = beside[row + r * s];
                        sum.iter_mut()
                            .zip(through)
                            .for_each(|(sum, t)| *sum += value * t);
                    }
                    let at = targets.next().map_or(0, |at| *at);
                    self.values[at]
                        .iter_mut()
                        .zip(sum)
                        .for_each(|(v, s)| *v -= s);
                }
            }
        }
        Ok(())
    }

    /// Factors that matrix.
    ///
    /// # Errors
    /// The unknown that nothing determines.
    fn factor(&mut self, elimination: &Elimination) -> Result<(), usize> {
        let outcome = self.factors.factor(&self.values);
        outcome.map_err(|place| elimination.kept[place])
    }

    /// Solves for `x`, parts apart.
    fn solve(&mut self, elimination: &Elimination, mut x: [&mut [f64]; P]) {
        for (right, x) in self.right.iter_mut().zip(&x) {
            for (right, &i) in right.iter_mut().zip(&elimination.kept) {
                *right = x[i];
            }
        }
        for block in &elimination.blocks {
            let ([_, _, beside], [_, rows]) = elimination.parts(block);
            let (k, r) = (block.n, block.n_rows);
            let inverse = &self.inverse[block.inverse..][..k * k];
            let own = &elimination.eliminated[block.begin..][..k];
            let mut sums = [[0.0; P]; MOST_ENTRIES];
            for (column, &i) in inverse.chunks_exact(k).zip(own) {
                let b = std::array::from_fn(|part| x[part][i]);
                for (sum, d) in sums.iter_mut().zip(column) {
                    sum.iter_mut()
                        .zip(times(*d, b))
                        .for_each(|(sum, t)| *sum += t);
                }
            }
            for ((&i, sum), beside) in own.iter().zip(sums).zip(beside.chunks_exact(r.max(1))) {
                for (part, sum) in sum.into_iter().enumerate() {
                    x[part][i] = sum;
                    let right = &mut self.right[part];
                    rows.iter()
                        .zip(beside)
                        .for_each(|(&row, j)| right[row] += j * sum);
                }
            }
            if r == 0 {
                for (&i, sum) in own.iter().zip(sums) {
                    (0..P).for_each(|part| x[part][i] = sum[part]);
                }
            }
        }
        self.factors
            .solve(self.right.each_mut().map(Vec::as_mut_slice));
        for block in &elimination.blocks {
            let (_, [columns, _]) = elimination.parts(block);
            let (k, c) = (block.n, block.n_columns);
            let through = &self.through[block.through..][..k * c];
            let own = &elimination.eliminated[block.begin..][..k];
            for (through, &place) in through.chunks_exact(k).zip(columns) {
                let known = std::array::from_fn(|part| self.right[part][place]);
                for (d, &i) in through.iter().zip(own) {
                    let change = times(*d, known);
                    (0..P).for_each(|part| x[part][i] += change[part]);
                }
            }
        }
        for (right, x) in self.right.iter().zip(x) {
            for (right, &i) in right.iter().zip(&elimination.kept) {
                x[i] = *right;
            }
        }
    }
}

/// `sum ← sum + column · factor`
fn add_multiple<const P: usize>(sum: &mut [[f64; P]], column: &[[f64; P]], factor: f64) {
    for (sum, column) in sum.iter_mut().zip(column) {
        sum.iter_mut()
            .zip(column)
            .for_each(|(sum, c)| *sum += factor * c);
    }
}

/// Inverts `shift − inner`, by columns, with pivots of rows.
///
/// # Errors
/// The column without a pivot.
fn invert<const P: usize>(
    inverse: &mut [[f64; P]],
    inner: &[f64],
    shift: [f64; P],
) -> Result<(), usize> {
    let k = inverse.len().isqrt();
    let mut matrix = [[[0.0; P]; MOST_ENTRIES]; MOST_ENTRIES];
    let mut other = [[[0.0; P]; MOST_ENTRIES]; MOST_ENTRIES];
    for i in 0..k {
        for j in 0..k {
            matrix[i][j][0] = -inner[i + k * j];
        }
        matrix[i][i]
            .iter_mut()
            .zip(shift)
            .for_each(|(m, s)| *m += s);
        other[i][i][0] = 1.0;
    }
    for j in 0..k {
        let larger = |a: usize, b: usize| match size(matrix[b][j]) > size(matrix[a][j]) {
            true => b,
            false => a,
        };
        let pivot = (j + 1..k).fold(j, larger);
        matrix.swap(j, pivot);
        other.swap(j, pivot);
        let over = reciprocal(matrix[j][j]);
        if !over.iter().all(|x| x.is_finite()) {
            return Err(j);
        }
        for rows in [&mut matrix, &mut other] {
            rows[j].iter_mut().for_each(|x| *x = times(*x, over));
        }
        for i in (0..k).filter(|&i| i != j) {
            let factor = matrix[i][j];
            for rows in [&mut matrix, &mut other] {
                let row = rows[j];
                for (x, y) in rows[i].iter_mut().zip(row) {
                    let change = times(factor, y);
                    x.iter_mut().zip(change).for_each(|(x, c)| *x -= c);
                }
            }
        }
    }
    for (e, inverse) in inverse.iter_mut().enumerate() {
        *inverse = other[e % k][e / k];
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::between_ones;

    /// The pattern of a chain of free bodies, each tied to its neighbours: three coordinates whose
    /// rates are velocities, four that depend on each other and on three velocities.
    fn chain(bodies: usize) -> Pattern {
        let n_q = 7 * bodies;
        let mut rows = Vec::new();
        for b in 0..bodies {
            let v = |k: usize| (n_q + 6 * b + k) as u32;
            rows.extend((0..3).map(|k| vec![v(k)]));
            let own = |k: usize| (7 * b + 3 + k) as u32;
            for k in 0..4 {
                let others = (0..4).filter(|&o| o != k).map(own);
                rows.push(others.chain((3..6).map(v)).collect());
            }
        }
        for b in 0..bodies {
            let near = b.saturating_sub(1)..(b + 2).min(bodies);
            let reads = near.flat_map(|o| {
                let q = 7 * o..7 * (o + 1);
                q.chain(n_q + 6 * o..n_q + 6 * (o + 1))
            });
            let reads: Vec<u32> = reads.map(|j| j as u32).collect();
            rows.extend((0..6).map(|_| reads.clone()));
        }
        Pattern::of_rows(rows.len(), &rows)
    }

    /// Returns the largest entry of `b − (γ + iδ − J) (x + iy)`, real part, over the largest of
    /// its terms.
    fn residual(
        (pattern, j): (&Pattern, &[f64]),
        (x, y): (&[f64], &[f64]),
        (g, d): (f64, f64),
        b: &[f64],
    ) -> f64 {
        let mut sums: Vec<f64> = (0..b.len()).map(|i| b[i] - g * x[i] + d * y[i]).collect();
        let mut sizes: Vec<f64> = (0..b.len())
            .map(|i| {
                [b[i], g * x[i], d * y[i]]
                    .iter()
                    .fold(0.0, |m, t| t.abs().max(m))
            })
            .collect();
        for ((i, k), j) in pattern.entries().zip(j) {
            sums[i] += j * x[k];
            sizes[i] = sizes[i].max((j * x[k]).abs());
        }
        let parts = sums.iter().zip(&sizes).map(|(sum, size)| sum.abs() / size);
        parts.fold(0.0, f64::max)
    }

    #[test]
    fn positions_and_rotations_are_eliminated_first() {
        let found = blocks(&chain(5));
        let n_each = |n: usize| found.iter().filter(|b| b.len() == n).count();
        assert_eq!((n_each(1), n_each(4), found.len()), (15, 5, 20));
    }

    #[test]
    fn solutions_are_those_of_the_whole_systems() {
        let pattern = Arc::new(chain(9));
        let n = pattern.n_columns();
        let mut draw = between_ones(5);
        for stiffness in [1.0, 1e8] {
            let mut sparse = Sparse::new(pattern.clone());
            for step in [1e-5, 1e-2] {
                let entries = pattern.entries();
                let entries = entries.map(|(i, j)| match i >= 7 * 9 && j < 7 * 9 {
                    true => stiffness * draw(),
                    false => draw(),
                });
                let jacobian: Vec<f64> = entries.collect();
                let (gamma, alpha, beta) = (3.6 / step, 2.7 / step, 3.0 / step);
                sparse
                    .factor(&jacobian, gamma, [alpha, beta])
                    .expect("a regular matrix");
                let b: Vec<f64> = (0..n).map(|_| draw()).collect();
                let none = vec![0.0; n];
                let all = (&*pattern, &jacobian[..]);
                let most = 1e-11;
                let mut x = b.clone();
                sparse.solve(&mut x);
                assert!(residual(all, (&x, &none), (gamma, 0.0), &b) < most);
                let (mut re, mut im) = (b.clone(), none.clone());
                sparse.solve_complex(&mut re, &mut im);
                let real = residual(all, (&re, &im), (alpha, beta), &b);
                let imaginary = residual(all, (&im, &re), (alpha, -beta), &none);
                assert!(real < most && imaginary < most, "{real} {imaginary}");
            }
        }
    }

    #[test]
    fn the_unknown_that_nothing_determines_is_named() {
        // 0 is eliminated; the rates of 1 and 2 cancel their shift
        let rows = [vec![1], vec![0, 1, 2], vec![2, 1]];
        let pattern = Arc::new(Pattern::of_rows(3, &rows));
        let mut sparse = Sparse::new(pattern.clone());
        let entries = pattern.entries().map(|(i, j)| match (i, j) {
            (1, 1) | (2, 2) => 2.0,
            _ => 0.0,
        });
        let jacobian: Vec<f64> = entries.collect();
        assert!(matches!(
            sparse.factor(&jacobian, 2.0, [2.0, 0.0]),
            Err(1 | 2)
        ));
        assert_eq!(sparse.factor(&jacobian, 3.0, [3.0, 1.0]), Ok(()));
    }
}
