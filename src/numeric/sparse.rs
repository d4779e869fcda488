//! Linear equations with a fixed pattern, solved again and again with other values: [`Factors`].
//!
//! ```text
//! small     up to DENSE_LIMIT unknowns, at least half full: dense LU
//! analyse   once: Markowitz elimination. Of the columns and rows with fewest entries left, take
//!           the entry a(i,j) of least (rᵢ−1)(cⱼ−1) that is at least a tenth of the largest in its
//!           column; it yields pivot order and pattern of L and U                              (1)
//! refactor  often: same order, same pattern, column by column (left-looking): scatter the column,
//!           subtract earlier columns of L, divide by the pivot. No search, no allocation       (2)
//! watch     an entry of L above 1e5, a pivot lost against its column: analyse again with the
//!           present values                                                                     (3)
//!           the first solution after each factorization: a residual |b − A x| above 1e-10 is
//!           refined once; above 1e-6 the next factorization is analysed again                  (4)
//! ```
//!
//! Markowitz' choice orders and pivots in one go, so rows without a diagonal entry (constraints)
//! need no special treatment, and entries that happen to be zero during the analysis stay in the
//! pattern. Rows are scaled by powers of two first, so that a unit does not decide a pivot.
//!
//! *Singular*: a column whose remaining entries are all below 1e-14 of the largest it began with;
//! the error is the unknown of that column, which nothing determines.
//!
//! Source: Duff, Erisman & Reid, Direct Methods for Sparse Matrices, 7.2 and 10; Davis & Palamadai,
//! ACM TOMS 37 (2010) for the refactorization.
//!
//! Tried and not kept: a list of multiply–subtract operations instead of (2) is slower (index
//! traffic), generated code no faster.
#![allow(clippy::needless_range_loop)] // several arrays at one index read best that way

use super::dense::Lu;
use crate::arrange::Arrange;
use std::collections::BTreeSet;

/// Number of unknowns up to which dense factors are faster, unless half of the matrix is empty.
pub const DENSE_LIMIT: usize = 35;
/// Part of the largest entry of its column that a pivot must have.
const PIVOT_THRESHOLD: f64 = 0.1;
/// Largest entry of L above which the pivots are chosen again.
const LARGEST_GROWTH: f64 = 1e5;
/// Part of the largest entry a column began with below which the column counts as zero.
const SINGULAR_COLUMN: f64 = 1e-14;
/// Relative residual above which a solution is refined.
const REFINED_RESIDUAL: f64 = 1e-10;
/// Relative residual after refinement above which the next factorization is analysed again.
const REJECTED_RESIDUAL: f64 = 1e-6;
/// Candidate columns, and candidate rows, examined per pivot.
const CANDIDATES: usize = 4;

/// A square matrix of fixed pattern, factored.
#[derive(Clone, Debug)]
pub struct Factors {
    n: usize,
    /// row and column of each entry; entries at the same place add up   (entries)
    pattern: Vec<(u32, u32)>,
    /// values last factored   (entries)
    values: Vec<f64>,
    /// powers of two that bring the rows to size one   (n)
    scale: Vec<f64>,
    kind: Kind,
    /// right-hand side of the solution being checked   (n)
    b: Vec<f64>,
    /// residual of that solution   (n)
    r: Vec<f64>,
    /// whether the next solution is the first with these factors
    unchecked: bool,
    /// whether the last residual asks for another analysis
    distrusted: bool,
    /// analyses made so far
    analyses: usize,
}

#[derive(Clone, Debug)]
enum Kind {
    Dense(Lu),
    /// not yet analysed
    Empty,
    Sparse(Box<Sparse>),
}

impl Factors {
    /// Prepares for matrices of `n` unknowns with entries at the given rows and columns.
    pub fn new(n: usize, pattern: &[(usize, usize)]) -> Self {
        let full = 2 * pattern.len() >= n * n;
        Self::with_dense_limit(n, pattern, if full { DENSE_LIMIT } else { 0 })
    }

    /// Prepares like [`Factors::new`], dense up to `limit` unknowns.
    pub fn with_dense_limit(n: usize, pattern: &[(usize, usize)], limit: usize) -> Self {
        debug_assert!(pattern.iter().all(|(i, j)| *i < n && *j < n));
        Factors {
            n,
            pattern: pattern
                .iter()
                .map(|(i, j)| (*i as u32, *j as u32))
                .collect(),
            values: vec![0.0; pattern.len()],
            scale: vec![1.0; n],
            kind: if n <= limit {
                Kind::Dense(Lu::new(n))
            } else {
                Kind::Empty
            },
            b: vec![0.0; n],
            r: vec![0.0; n],
            unchecked: false,
            distrusted: false,
            analyses: 0,
        }
    }

    /// Returns how often pivots were chosen.
    pub fn analyses(&self) -> usize {
        self.analyses
    }

    /// Returns the number of entries of L and U together (n² for dense factors).
    pub fn fill(&self) -> usize {
        match &self.kind {
            Kind::Dense(_) => self.n * self.n,
            Kind::Empty => 0,
            Kind::Sparse(s) => s.l_value.len() + s.u_value.len() + self.n,
        }
    }

    /// Factors the matrix with these values, one per entry of the pattern.
    ///
    /// # Errors
    /// The unknown that nothing determines.
    pub fn factor(&mut self, values: &[f64]) -> Result<(), usize> {
        self.values.copy_from_slice(values);
        self.unchecked = true;
        if let Kind::Sparse(sparse) = &mut self.kind
            && !self.distrusted
            && sparse.refactor(&self.values, &self.scale)
        {
            return Ok(());
        }
        self.distrusted = false;
        self.scale_rows();
        if let Kind::Dense(lu) = &mut self.kind {
            let matrix = lu.matrix_mut();
            matrix.fill(0.0);
            for ((i, j), v) in self.pattern.iter().zip(&self.values) {
                matrix[*i as usize + self.n * *j as usize] += v * self.scale[*i as usize];
            }
            return lu.factor(SINGULAR_COLUMN);
        }
        self.analyses += 1;
        self.kind = Kind::Empty;
        let mut sparse = Markowitz::new(self.n, &self.pattern, &self.values, &self.scale)
            .eliminate(&self.pattern)?;
        // the same numbers through the same loops as later ones; the pivots were just found good
        sparse.refactor(&self.values, &self.scale);
        self.kind = Kind::Sparse(Box::new(sparse));
        Ok(())
    }

    /// Sets the scale that brings the largest entry of each row to between 1 and 2.
    fn scale_rows(&mut self) {
        self.scale.fill(0.0);
        for ((i, _), v) in self.pattern.iter().zip(&self.values) {
            let s = &mut self.scale[*i as usize];
            *s = if v.abs() > *s { v.abs() } else { *s };
        }
        for s in &mut self.scale {
            *s = inverse_power(*s);
        }
    }

    /// Solves `x ← A⁻¹ x`.
    pub fn solve(&mut self, x: &mut [f64]) {
        if !self.unchecked {
            return self.back_substitute(x);
        }
        self.unchecked = false;
        self.b.copy_from_slice(x);
        self.back_substitute(x);
        if self.residual(x) > REFINED_RESIDUAL {
            let mut r = std::mem::take(&mut self.r);
            self.back_substitute(&mut r);
            x.iter_mut().zip(&r).for_each(|(x, r)| *x += r);
            self.r = r;
            self.distrusted = self.residual(x) > REJECTED_RESIDUAL;
        }
    }

    /// Computes `r = b − A x`; returns its largest entry relative to the terms of its sum, by
    /// scaled rows.
    fn residual(&mut self, x: &[f64]) -> f64 {
        self.r.copy_from_slice(&self.b);
        let mut size = self
            .b
            .iter()
            .zip(&self.scale)
            .fold(0.0f64, |m, (b, s)| m.max((b * s).abs()));
        for ((i, j), v) in self.pattern.iter().zip(&self.values) {
            let term = v * x[*j as usize];
            self.r[*i as usize] -= term;
            size = size.max((term * self.scale[*i as usize]).abs());
        }
        let rest = self
            .r
            .iter()
            .zip(&self.scale)
            .fold(0.0f64, |m, (r, s)| m.max((r * s).abs()));
        if rest == 0.0 { 0.0 } else { rest / size }
    }

    /// Solves with the factors as they are, without a check.
    fn back_substitute(&mut self, x: &mut [f64]) {
        match &mut self.kind {
            Kind::Dense(lu) => {
                x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
                lu.solve(x);
            }
            Kind::Sparse(sparse) => sparse.solve(x, &self.scale),
            Kind::Empty => debug_assert!(false, "solve before factor"),
        }
    }
}

/// Returns the power of two that brings `x` between 1 and 2, or one where there is none.
pub(crate) fn inverse_power(x: f64) -> f64 {
    let exponent = (x.to_bits() >> 52) & 0x7ff;
    if (64..1982).contains(&exponent) {
        f64::from_bits((2046 - exponent) << 52)
    } else {
        1.0
    }
}

/// The factors `P S A Q = L U` by columns; rows and columns are numbered in the order of
/// elimination.
#[derive(Clone, Debug)]
struct Sparse {
    n: usize,
    /// original row and column of each pivot   (n)
    row: Vec<u32>,
    /// original column of each pivot   (n)
    column: Vec<u32>,
    /// beginnings of the columns of A among their entries   (n + 1)
    a_start: Vec<u32>,
    /// entries of A by column: index among the values, row position, original row   (entries)
    a_entry: Vec<(u32, u32, u32)>,
    /// beginnings of the columns of L below the diagonal   (n + 1)
    l_start: Vec<u32>,
    /// rows of the entries of L   (fill)
    l_row: Vec<u32>,
    /// entries of L   (fill)
    l_value: Vec<f64>,
    /// beginnings of the columns of U above the diagonal, rows ascending   (n + 1)
    u_start: Vec<u32>,
    /// rows of the entries of U   (fill)
    u_row: Vec<u32>,
    /// entries of U   (fill)
    u_value: Vec<f64>,
    /// 1/pivot   (n)
    inverse: Vec<f64>,
    /// the column in work, all zero between columns   (n)
    x: Vec<f64>,
}

impl Sparse {
    /// Refactors with new values (2); returns false when a pivot has become bad (3).
    fn refactor(&mut self, values: &[f64], scale: &[f64]) -> bool {
        let x = &mut self.x[..];
        let mut worst = 0.0;
        for k in 0..self.n {
            for (e, at, row) in
                &self.a_entry[self.a_start[k] as usize..self.a_start[k + 1] as usize]
            {
                x[*at as usize] += values[*e as usize] * scale[*row as usize];
            }
            let u = self.u_start[k] as usize..self.u_start[k + 1] as usize;
            for (i, value) in self.u_row[u.clone()].iter().zip(&mut self.u_value[u]) {
                let i = *i as usize;
                let u = x[i];
                *value = u;
                x[i] = 0.0;
                let l = self.l_start[i] as usize..self.l_start[i + 1] as usize;
                for (r, l) in self.l_row[l.clone()].iter().zip(&self.l_value[l]) {
                    x[*r as usize] -= l * u;
                }
            }
            let inverse = 1.0 / x[k];
            x[k] = 0.0;
            self.inverse[k] = inverse;
            let l = self.l_start[k] as usize..self.l_start[k + 1] as usize;
            for (r, value) in self.l_row[l.clone()].iter().zip(&mut self.l_value[l]) {
                let l = x[*r as usize] * inverse;
                x[*r as usize] = 0.0;
                *value = l;
                worst = if l.abs() <= worst { worst } else { l.abs() };
            }
            // a zero or lost pivot may have no entries below it
            worst = if inverse.is_finite() {
                worst
            } else {
                f64::INFINITY
            };
        }
        worst < LARGEST_GROWTH
    }

    /// Solves `b ← A⁻¹ b`; `scale` are the factors of the rows.
    fn solve(&mut self, b: &mut [f64], scale: &[f64]) {
        let x = &mut self.x[..];
        for (x, row) in x.iter_mut().zip(&self.row) {
            *x = b[*row as usize] * scale[*row as usize];
        }
        // equations of one unknown each
        if self.l_row.is_empty() && self.u_row.is_empty() {
            for ((x, inverse), column) in x.iter_mut().zip(&self.inverse).zip(&self.column) {
                b[*column as usize] = std::mem::take(x) * inverse;
            }
            return;
        }
        for k in 0..self.n {
            let xk = x[k];
            let l = self.l_start[k] as usize..self.l_start[k + 1] as usize;
            for (r, l) in self.l_row[l.clone()].iter().zip(&self.l_value[l]) {
                x[*r as usize] -= l * xk;
            }
        }
        for k in (0..self.n).rev() {
            let xk = x[k] * self.inverse[k];
            x[k] = 0.0;
            b[self.column[k] as usize] = xk;
            let u = self.u_start[k] as usize..self.u_start[k + 1] as usize;
            for (i, u) in self.u_row[u.clone()].iter().zip(&self.u_value[u]) {
                x[*i as usize] -= u * xk;
            }
        }
    }
}

/// The elimination (1) in progress.
struct Markowitz {
    n: usize,
    /// entries left in each column: row and value
    columns: Vec<Vec<(u32, f64)>>,
    /// columns left in each row
    rows: Vec<Vec<u32>>,
    /// largest entry that each column began with   (n)
    size: Vec<f64>,
    /// columns left, by number of entries
    by_column: BTreeSet<(usize, u32)>,
    /// rows left, by number of entries
    by_row: BTreeSet<(usize, u32)>,
    /// pivots in order, each with its column of L and row of U (original numbers)
    pivots: Vec<Pivot>,
    /// place of a row in the column in work, plus one   (n)
    place: Vec<u32>,
}

struct Pivot {
    /// original row of the pivot
    row: u32,
    /// original column of the pivot
    column: u32,
    /// original rows below it
    l: Vec<u32>,
    /// original columns beside it
    u: Vec<u32>,
}

impl Markowitz {
    /// Gathers the entries by columns and rows, scaled; entries at the same place add up.
    fn new(n: usize, pattern: &[(u32, u32)], values: &[f64], scale: &[f64]) -> Self {
        let mut columns = vec![Vec::new(); n];
        let mut rows = vec![Vec::new(); n];
        let mut sorted: Vec<(u32, u32, f64)> = pattern
            .iter()
            .zip(values)
            .map(|((i, j), v)| (*j, *i, v * scale[*i as usize]))
            .collect();
        sorted.arrange_by_key(|(j, i, _)| (*j, *i));
        for (j, i, v) in sorted {
            match columns[j as usize].last_mut() {
                Some((last, sum)) if *last == i => *sum += v,
                _ => {
                    columns[j as usize].push((i, v));
                    rows[i as usize].push(j);
                }
            }
        }
        let largest =
            |column: &Vec<(u32, f64)>| column.iter().fold(0.0f64, |m, (_, v)| m.max(v.abs()));
        Markowitz {
            n,
            size: columns.iter().map(largest).collect(),
            by_column: columns
                .iter()
                .enumerate()
                .map(|(j, c)| (c.len(), j as u32))
                .collect(),
            by_row: rows
                .iter()
                .enumerate()
                .map(|(i, r)| (r.len(), i as u32))
                .collect(),
            columns,
            rows,
            pivots: Vec::with_capacity(n),
            place: vec![0; n],
        }
    }

    /// Eliminates until every column has its pivot; returns the patterns of the factors.
    fn eliminate(mut self, pattern: &[(u32, u32)]) -> Result<Sparse, usize> {
        while self.pivots.len() < self.n {
            let (i, j) = self.choose()?;
            self.pivot(i, j);
        }
        Ok(self.assemble(pattern))
    }

    /// Chooses the next pivot: least (r−1)(c−1) among a few sparsest columns and rows, the larger
    /// one on a tie.
    fn choose(&self) -> Result<(u32, u32), usize> {
        let mut best: Option<(usize, f64, u32, u32)> = None;
        let mut consider = |i: u32, j: u32, ratio: f64| {
            let cost = (self.rows[i as usize].len() - 1) * (self.columns[j as usize].len() - 1);
            if best.is_none_or(|(c, r, ..)| cost < c || (cost == c && ratio > r)) {
                best = Some((cost, ratio, i, j));
            }
        };
        let mut seen = 0;
        for (_, j) in &self.by_column {
            let largest = self.largest(*j)?;
            for (i, v) in &self.columns[*j as usize] {
                if v.abs() >= PIVOT_THRESHOLD * largest {
                    consider(*i, *j, v.abs() / largest);
                }
            }
            seen += 1;
            if seen == CANDIDATES {
                break;
            }
        }
        for (_, i) in self.by_row.iter().take(CANDIDATES) {
            for j in &self.rows[*i as usize] {
                let largest = self.largest(*j)?;
                let here = self.columns[*j as usize].iter().find(|(row, _)| row == i);
                if let Some((_, v)) = here.filter(|(_, v)| v.abs() >= PIVOT_THRESHOLD * largest) {
                    consider(*i, *j, v.abs() / largest);
                }
            }
        }
        // there is a column left, and its largest entry passed the threshold
        best.map(|(_, _, i, j)| (i, j)).ok_or(0)
    }

    /// Returns the largest entry left in column `j`.
    fn largest(&self, j: u32) -> Result<f64, usize> {
        let column = &self.columns[j as usize];
        let mut largest = 0.0;
        for (_, v) in column {
            if !v.is_finite() {
                return Err(j as usize);
            }
            largest = f64::max(largest, v.abs());
        }
        if largest > SINGULAR_COLUMN * self.size[j as usize] {
            Ok(largest)
        } else {
            Err(j as usize)
        }
    }

    /// Eliminates with the entry (i, j).
    fn pivot(&mut self, i: u32, j: u32) {
        let column = std::mem::take(&mut self.columns[j as usize]);
        let row = std::mem::take(&mut self.rows[i as usize]);
        self.by_column.remove(&(column.len(), j));
        self.by_row.remove(&(row.len(), i));
        let pivot = column
            .iter()
            .find(|(r, _)| *r == i)
            .map_or(1.0, |(_, v)| *v);
        let below: Vec<(u32, f64)> = column
            .into_iter()
            .filter(|(r, _)| *r != i)
            .map(|(r, v)| (r, v / pivot))
            .collect();
        for (r, _) in &below {
            let others = &mut self.rows[*r as usize];
            self.by_row.remove(&(others.len(), *r));
            others.retain(|c| *c != j);
        }
        for c in row.iter().filter(|c| **c != j) {
            let other = &mut self.columns[*c as usize];
            self.by_column.remove(&(other.len(), *c));
            let at = other.iter().position(|(r, _)| *r == i);
            let u = at.map_or(0.0, |at| other.swap_remove(at).1);
            for (p, (r, _)) in other.iter().enumerate() {
                self.place[*r as usize] = p as u32 + 1;
            }
            for (r, l) in &below {
                match self.place[*r as usize] {
                    0 => {
                        other.push((*r, -l * u));
                        self.rows[*r as usize].push(*c);
                    }
                    p => other[p as usize - 1].1 -= l * u,
                }
            }
            for (r, _) in other.iter() {
                self.place[*r as usize] = 0;
            }
            self.by_column.insert((other.len(), *c));
        }
        for (r, _) in &below {
            self.by_row.insert((self.rows[*r as usize].len(), *r));
        }
        let l = below.into_iter().map(|(r, _)| r).collect();
        let u = row.into_iter().filter(|c| *c != j).collect();
        self.pivots.push(Pivot {
            row: i,
            column: j,
            l,
            u,
        });
    }

    /// Renumbers the patterns of L and U in the order of elimination.
    fn assemble(self, pattern: &[(u32, u32)]) -> Sparse {
        let n = self.n;
        let (mut row_at, mut column_at) = (vec![0u32; n], vec![0u32; n]);
        for (k, p) in self.pivots.iter().enumerate() {
            row_at[p.row as usize] = k as u32;
            column_at[p.column as usize] = k as u32;
        }
        let l: Vec<Vec<u32>> = self
            .pivots
            .iter()
            .map(|p| p.l.iter().map(|r| row_at[*r as usize]).collect())
            .collect();
        let mut u = vec![Vec::new(); n];
        for (k, p) in self.pivots.iter().enumerate() {
            for c in &p.u {
                u[column_at[*c as usize] as usize].push(k as u32);
            }
        }
        let mut a = vec![Vec::new(); n];
        for (e, (i, j)) in pattern.iter().enumerate() {
            a[column_at[*j as usize] as usize].push((e as u32, row_at[*i as usize], *i));
        }
        let (l_start, l_row) = concatenate(l, true);
        let (u_start, u_row) = concatenate(u, true);
        let (a_start, a_entry) = concatenate(a, false);
        Sparse {
            n,
            row: self.pivots.iter().map(|p| p.row).collect(),
            column: self.pivots.iter().map(|p| p.column).collect(),
            a_start,
            a_entry,
            l_value: vec![0.0; l_row.len()],
            l_start,
            l_row,
            u_value: vec![0.0; u_row.len()],
            u_start,
            u_row,
            inverse: vec![0.0; n],
            x: vec![0.0; n],
        }
    }
}

/// Joins the lists into one; returns the beginning of each, and the entries.
fn concatenate<T: Ord + Copy>(lists: Vec<Vec<T>>, sort: bool) -> (Vec<u32>, Vec<T>) {
    let mut start = Vec::with_capacity(lists.len() + 1);
    let mut all = Vec::with_capacity(lists.iter().map(Vec::len).sum());
    start.push(0);
    for mut list in lists {
        if sort {
            list.sort_unstable();
        }
        all.append(&mut list);
        start.push(all.len() as u32);
    }
    (start, all)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::between_ones;
    use proptest::prelude::*;

    /// The Newton matrix of a chain of bodies: 6 × 6 blocks and 5 × 6 constraint blocks to both
    /// neighbours, 11 unknowns a body.
    fn chain(
        bodies: usize,
        mut draw: impl FnMut() -> f64,
    ) -> (usize, Vec<(usize, usize)>, Vec<f64>) {
        let (mut pattern, mut values) = (vec![], vec![]);
        let mut put = |i: usize, j: usize, v: f64| {
            pattern.push((i, j));
            values.push(v);
        };
        for b in 0..bodies {
            for i in 0..6 {
                for j in 0..6 {
                    put(
                        11 * b + i,
                        11 * b + j,
                        draw() + if i == j { 4.0 } else { 0.0 },
                    );
                    if b > 0 {
                        put(11 * b + i, 11 * (b - 1) + j, 0.1 * draw());
                        put(11 * (b - 1) + i, 11 * b + j, 0.1 * draw());
                    }
                }
                for c in 0..5 {
                    let g = draw();
                    put(11 * b + 6 + c, 11 * b + i, g);
                    put(11 * b + i, 11 * b + 6 + c, g);
                    if b > 0 {
                        let g = draw();
                        put(11 * b + 6 + c, 11 * (b - 1) + i, g);
                        put(11 * (b - 1) + i, 11 * b + 6 + c, g);
                    }
                }
            }
        }
        (11 * bodies, pattern, values)
    }

    fn residual(pattern: &[(usize, usize)], values: &[f64], x: &[f64], b: &[f64]) -> f64 {
        let mut r = b.to_vec();
        for ((i, j), v) in pattern.iter().zip(values) {
            r[*i] -= v * x[*j];
        }
        r.iter().fold(0.0, |m, r| m.max(r.abs()))
    }

    #[test]
    fn chains_keep_their_pivots_and_little_fill() {
        for bodies in [4, 9, 40] {
            let (n, pattern, values) = chain(bodies, between_ones(bodies as u64));
            let mut factors = Factors::new(n, &pattern);
            let mut draw = between_ones(7);
            for round in 0..6 {
                let values: Vec<f64> = values
                    .iter()
                    .map(|v| v * (1.0 + 0.2 * draw() * f64::from(round)))
                    .collect();
                factors.factor(&values).unwrap();
                let b: Vec<f64> = (0..n).map(|_| draw()).collect();
                let mut x = b.clone();
                factors.solve(&mut x);
                assert!(residual(&pattern, &values, &x, &b) < 1e-9);
            }
            assert!(factors.analyses() <= 2, "{} analyses", factors.analyses());
            assert!(
                factors.fill() < 3 * pattern.len(),
                "{} of {}",
                factors.fill(),
                pattern.len()
            );
        }
    }

    #[test]
    fn a_bad_pivot_is_noticed_and_chosen_anew() {
        // the pivots chosen for the first values are zero in the second
        let n = 40;
        let pattern: Vec<(usize, usize)> =
            (0..n).flat_map(|i| [(i, i), (i, (i + 1) % n)]).collect();
        let values = |diagonal: f64, other: f64| {
            (0..2 * n)
                .map(|e| if e % 2 == 0 { diagonal } else { other })
                .collect::<Vec<_>>()
        };
        let mut factors = Factors::new(n, &pattern);
        for (k, values) in [values(1.0, 1e-3), values(0.0, 1.0), values(1e-9, 2.0)]
            .iter()
            .enumerate()
        {
            factors.factor(values).unwrap();
            let b = vec![1.0; n];
            let mut x = b.clone();
            factors.solve(&mut x);
            assert!(residual(&pattern, values, &x, &b) < 1e-12, "matrix {k}");
        }
        assert_eq!(factors.analyses(), 2);
    }

    #[test]
    fn what_nothing_determines_is_named() {
        for limit in [0, 100] {
            // unknown 2 does not occur
            let pattern = [(0, 0), (1, 1), (2, 0), (2, 1)];
            let mut factors = Factors::with_dense_limit(3, &pattern, limit);
            assert_eq!(factors.factor(&[1.0, 2.0, 3.0, 4.0]), Err(2));
            // unknowns 0 and 1 occur only together
            let pattern = [(0, 0), (0, 1), (1, 0), (1, 1)];
            let mut factors = Factors::with_dense_limit(2, &pattern, limit);
            assert!(matches!(factors.factor(&[1.0, 2.0, 3.0, 6.0]), Err(0 | 1)));
            assert!(factors.factor(&[1.0, f64::NAN, 3.0, 6.0]).is_err());
            assert!(factors.factor(&[1.0, 2.0, 3.0, 4.0]).is_ok());
        }
    }

    proptest! {
        /// Random patterns: the sparse solution is the dense one, and both agree on what is
        /// singular.
        #[test]
        fn sparse_agrees_with_dense(
            n in 1usize..30,
            places in proptest::collection::vec((0usize..1000, 0usize..1000), 1..160),
            seed in 0u64..1000,
        ) {
            let mut draw = between_ones(seed);
            let mut pattern: Vec<(usize, usize)> = places.iter().map(|(i, j)| (i % n, j % n)).collect();
            pattern.extend((0..n).map(|i| (i, (i * 7 + 3) % n)));
            let values: Vec<f64> = pattern.iter().map(|_| draw() * 10f64.powf(3.0 * draw())).collect();
            let mut dense = nalgebra::DMatrix::zeros(n, n);
            for ((i, j), v) in pattern.iter().zip(&values) {
                dense[(*i, *j)] += v;
            }
            let singular_values = dense.singular_values();
            let condition = singular_values[0] / singular_values[n - 1];
            let mut factors = Factors::with_dense_limit(n, &pattern, 0);
            let outcome = factors.factor(&values);
            if condition < 1e8 {
                prop_assert!(outcome.is_ok(), "condition {}", condition);
                let b: Vec<f64> = (0..n).map(|_| draw()).collect();
                let exact = dense.lu().solve(&nalgebra::DVector::from_vec(b.clone()));
                let mut x = b;
                factors.solve(&mut x);
                if let Some(exact) = exact {
                    for i in 0..n {
                        prop_assert!((x[i] - exact[i]).abs() < 1e-12 * condition * exact.norm());
                    }
                }
            }
        }
    }
}
