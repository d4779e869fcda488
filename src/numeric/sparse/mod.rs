//! Linear equations with a fixed pattern, real or complex, solved again and again with other
//! values: [`Factors`].
//!
//! ```text
//! small     up to DENSE_LIMIT real unknowns, at least half full: dense LU
//! analyse   once: Markowitz elimination (`markowitz.rs`) yields the order of the pivots       (1)
//! refactor  often: same order, by dense blocks (`fronts.rs`). No search for an order, no
//!           allocation; pivots change places within a block                                   (2)
//! watch     an entry of L above 1e5, a pivot lost: analyse again with the present values      (3)
//!           the first solution after each factorization: a residual |b − A x| above 1e-10 is
//!           refined once; above 1e-6 the next factorization is analysed again                 (4)
//! ```
//!
//! Markowitz' choice orders and pivots in one go, so rows without a diagonal entry (constraints)
//! need no special treatment, and entries that happen to be zero during the analysis stay in the
//! pattern. Rows are scaled by powers of two first, so that a unit does not decide a pivot.
//!
//! *Singular*: a column whose remaining entries are all below 1e-14 of the largest it began with;
//! the error is the unknown of that column, which nothing determines.
//!
//! Source: Duff, Erisman & Reid, Direct Methods for Sparse Matrices, 7.2 and 10.
//!
//! Tried and not kept: column by column without blocks, four times as slow on grids of bodies; a
//! complex matrix as a real one of twice the size, twice as slow again.

mod fronts;
mod markowitz;

use super::dense::{self, Lu};
use fronts::Fronts;
use markowitz::Markowitz;

/// Number of unknowns up to which dense factors are faster, unless half of the matrix is empty.
pub const DENSE_LIMIT: usize = 35;
/// Largest entry of L above which the pivots are chosen again.
const LARGEST_GROWTH: f64 = 1e5;
/// Part of the largest entry a column began with below which the column counts as zero.
const SINGULAR_COLUMN: f64 = 1e-14;
/// Relative residual above which a solution is refined.
const REFINED_RESIDUAL: f64 = 1e-10;
/// Relative residual after refinement above which the next factorization is analysed again.
const REJECTED_RESIDUAL: f64 = 1e-6;

/// A square matrix of fixed pattern, factored; its entries are of `P` parts: one, or a real and an
/// imaginary one.
#[derive(Clone, Debug)]
pub struct Factors<const P: usize> {
    n: usize,
    /// row and column of each entry; entries at the same place add up   (entries)
    pattern: Vec<(u32, u32)>,
    /// values last factored   (entries)
    values: Vec<[f64; P]>,
    /// powers of two that bring the rows to size one   (n)
    scale: Vec<f64>,
    kind: Kind<P>,
    /// right-hand side of the solution being checked   (n)
    b: [Vec<f64>; P],
    /// residual of that solution   (n)
    r: [Vec<f64>; P],
    /// whether the next solution is the first with these factors
    unchecked: bool,
    /// whether the last residual asks for another analysis
    distrusted: bool,
    /// analyses made so far
    #[cfg(test)]
    analyses: usize,
}

#[derive(Clone, Debug)]
enum Kind<const P: usize> {
    Dense(Lu),
    /// not yet analysed
    Empty,
    Sparse(Box<Fronts<P>>),
}

/// The order of elimination: original row and column of each pivot   (n each)
#[derive(Clone, Debug, Default)]
struct Order {
    row: Vec<u32>,
    column: Vec<u32>,
}

impl Order {
    /// Returns the place of each original row, and of each column.
    fn places(&self) -> (Vec<u32>, Vec<u32>) {
        let (mut row_at, mut column_at) = (self.row.clone(), self.column.clone());
        for (k, (&row, &column)) in self.row.iter().zip(&self.column).enumerate() {
            row_at[row as usize] = k as u32;
            column_at[column as usize] = k as u32;
        }
        (row_at, column_at)
    }
}

impl<const P: usize> Factors<P> {
    /// Prepares for matrices of `n` unknowns with entries at the given rows and columns.
    pub fn new(n: usize, pattern: &[(usize, usize)]) -> Self {
        let is_full = P == 1 && 2 * pattern.len() >= n * n;
        Self::with_dense_limit(n, pattern, if is_full { DENSE_LIMIT } else { 0 })
    }

    /// Prepares like [`Factors::new`], dense up to `limit` unknowns.
    fn with_dense_limit(n: usize, pattern: &[(usize, usize)], limit: usize) -> Self {
        debug_assert!(pattern.iter().all(|(i, j)| *i < n && *j < n));
        let zeros = || std::array::from_fn(|_| vec![0.0; n]);
        Factors {
            n,
            pattern: pattern
                .iter()
                .map(|(i, j)| (*i as u32, *j as u32))
                .collect(),
            values: vec![[0.0; P]; pattern.len()],
            scale: vec![1.0; n],
            kind: if n <= limit {
                Kind::Dense(Lu::new(n))
            } else {
                Kind::Empty
            },
            b: zeros(),
            r: zeros(),
            unchecked: false,
            distrusted: false,
            #[cfg(test)]
            analyses: 0,
        }
    }

    /// Returns the number of entries of L and U together (n² for dense factors); before the first,
    /// of the matrix.
    pub fn fill(&self) -> usize {
        match &self.kind {
            Kind::Dense(_) => self.n * self.n,
            Kind::Empty => self.pattern.len(),
            Kind::Sparse(fronts) => fronts.fill(),
        }
    }

    /// Factors the matrix with these values, one per entry of the pattern.
    ///
    /// # Errors
    /// The unknown that nothing determines.
    pub fn factor(&mut self, values: &[[f64; P]]) -> Result<(), usize> {
        self.values.copy_from_slice(values);
        self.unchecked = true;
        if let Kind::Sparse(fronts) = &mut self.kind
            && !self.distrusted
            && fronts.factor(&self.values, &self.scale)
        {
            return Ok(());
        }
        self.distrusted = false;
        self.scale_rows();
        if let Kind::Dense(lu) = &mut self.kind {
            let matrix = lu.matrix_mut();
            matrix.fill(0.0);
            for ((i, j), v) in self.pattern.iter().zip(&self.values) {
                matrix[*i as usize + self.n * *j as usize] += v[0] * self.scale[*i as usize];
            }
            return lu.factor(SINGULAR_COLUMN);
        }
        #[cfg(test)]
        {
            self.analyses += 1;
        }
        self.kind = Kind::Empty;
        let order = Markowitz::new(self.n, &self.pattern, &self.values, &self.scale).eliminate()?;
        let mut fronts = Fronts::new(&order, &self.pattern);
        // the same numbers through the same loops as later ones; the pivots were just found good
        fronts.factor(&self.values, &self.scale);
        self.kind = Kind::Sparse(Box::new(fronts));
        Ok(())
    }

    /// Sets the scale that brings the largest entry of each row to between 1 and 2.
    fn scale_rows(&mut self) {
        self.scale.fill(0.0);
        for ((i, _), v) in self.pattern.iter().zip(&self.values) {
            let s = &mut self.scale[*i as usize];
            *s = if size(*v) > *s { size(*v) } else { *s };
        }
        for s in &mut self.scale {
            *s = inverse_power(*s);
        }
    }

    /// Solves `x ← A⁻¹ x`, parts apart.
    pub fn solve(&mut self, mut x: [&mut [f64]; P]) {
        if !self.unchecked {
            return self.back_substitute(&mut x);
        }
        self.unchecked = false;
        for (b, x) in self.b.iter_mut().zip(&x) {
            b.copy_from_slice(x);
        }
        self.back_substitute(&mut x);
        if self.residual(&x) > REFINED_RESIDUAL {
            let mut r = std::mem::replace(&mut self.r, std::array::from_fn(|_| Vec::new()));
            self.back_substitute(&mut r.each_mut().map(Vec::as_mut_slice));
            for (x, r) in x.iter_mut().zip(&r) {
                x.iter_mut().zip(r).for_each(|(x, r)| *x += r);
            }
            self.r = r;
            self.distrusted = self.residual(&x) > REJECTED_RESIDUAL;
        }
    }

    /// Computes `r = b − A x`; returns its largest entry relative to the terms of its sum, by
    /// scaled rows.
    fn residual(&mut self, x: &[&mut [f64]; P]) -> f64 {
        let largest = |parts: &[Vec<f64>; P], scale: &[f64]| {
            let sizes = parts.iter().flat_map(|part| part.iter().zip(scale));
            sizes.fold(0.0f64, |m, (b, s)| m.max((b * s).abs()))
        };
        for (r, b) in self.r.iter_mut().zip(&self.b) {
            r.copy_from_slice(b);
        }
        let mut most = largest(&self.b, &self.scale);
        for ((i, j), v) in self.pattern.iter().zip(&self.values) {
            let (i, j) = (*i as usize, *j as usize);
            let term = times(*v, std::array::from_fn(|part| x[part][j]));
            for (r, term) in self.r.iter_mut().zip(term) {
                r[i] -= term;
                most = most.max((term * self.scale[i]).abs());
            }
        }
        let rest = largest(&self.r, &self.scale);
        if rest == 0.0 { 0.0 } else { rest / most }
    }

    /// Solves with the factors as they are, without a check.
    fn back_substitute(&mut self, x: &mut [&mut [f64]; P]) {
        match &mut self.kind {
            Kind::Dense(lu) => {
                let x = &mut x[0];
                x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
                lu.solve(x);
            }
            Kind::Sparse(fronts) => fronts.solve(x, &self.scale),
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

/// Returns the sum of the sizes of the parts of a number.
#[inline(always)]
pub(super) fn size<const P: usize>(x: [f64; P]) -> f64 {
    x.iter().map(|x| x.abs()).sum()
}

/// Returns the product of two numbers.
#[inline(always)]
pub(super) fn times<const P: usize>(x: [f64; P], y: [f64; P]) -> [f64; P] {
    let mut product = [x[0] * y[0]; P];
    if P == 2 {
        product[0] -= x[P - 1] * y[P - 1];
        product[P - 1] = x[0] * y[P - 1] + x[P - 1] * y[0];
    }
    product
}

/// Returns 1/x.
#[inline(always)]
pub(super) fn reciprocal<const P: usize>(x: [f64; P]) -> [f64; P] {
    let mut inverse = [1.0 / x[0]; P];
    if P == 2 {
        (inverse[0], inverse[P - 1]) = dense::reciprocal(x[0], x[P - 1]);
    }
    inverse
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

    /// The values as numbers of one part.
    fn real(values: &[f64]) -> Vec<[f64; 1]> {
        values.iter().map(|&v| [v]).collect()
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
                factors.factor(&real(&values)).unwrap();
                let b: Vec<f64> = (0..n).map(|_| draw()).collect();
                let mut x = b.clone();
                factors.solve([&mut x]);
                assert!(residual(&pattern, &values, &x, &b) < 1e-9);
            }
            assert!(factors.analyses <= 2, "{} analyses", factors.analyses);
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
            factors.factor(&real(values)).unwrap();
            let b = vec![1.0; n];
            let mut x = b.clone();
            factors.solve([&mut x]);
            assert!(residual(&pattern, values, &x, &b) < 1e-12, "matrix {k}");
        }
        assert_eq!(factors.analyses, 2);
    }

    #[test]
    fn what_nothing_determines_is_named() {
        for limit in [0, 100] {
            // unknown 2 does not occur
            let pattern = [(0, 0), (1, 1), (2, 0), (2, 1)];
            let mut factors = Factors::with_dense_limit(3, &pattern, limit);
            assert_eq!(factors.factor(&real(&[1.0, 2.0, 3.0, 4.0])), Err(2));
            // unknowns 0 and 1 occur only together
            let pattern = [(0, 0), (0, 1), (1, 0), (1, 1)];
            let mut factors = Factors::with_dense_limit(2, &pattern, limit);
            assert!(matches!(
                factors.factor(&real(&[1.0, 2.0, 3.0, 6.0])),
                Err(0 | 1)
            ));
            assert!(factors.factor(&real(&[1.0, f64::NAN, 3.0, 6.0])).is_err());
            assert!(factors.factor(&real(&[1.0, 2.0, 3.0, 4.0])).is_ok());
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
            let mut factors = Factors::<1>::with_dense_limit(n, &pattern, 0);
            let outcome = factors.factor(&real(&values));
            if condition < 1e8 {
                prop_assert!(outcome.is_ok(), "condition {}", condition);
                let b: Vec<f64> = (0..n).map(|_| draw()).collect();
                let exact = dense.lu().solve(&nalgebra::DVector::from_vec(b.clone()));
                let mut x = b;
                factors.solve([&mut x]);
                if let Some(exact) = exact {
                    for i in 0..n {
                        prop_assert!((x[i] - exact[i]).abs() < 1e-12 * condition * exact.norm());
                    }
                }
            }
        }

        /// Complex factors are those of the real matrix of twice the size, refactored too.
        #[test]
        fn complex_factors_agree_with_dense(
            n in 1usize..40,
            places in proptest::collection::vec((0usize..1000, 0usize..1000), 1..200),
            seed in 0u64..1000,
        ) {
            let mut draw = between_ones(seed);
            let mut pattern: Vec<(usize, usize)> = places.iter().map(|(i, j)| (i % n, j % n)).collect();
            pattern.extend((0..n).map(|i| (i, (i * 7 + 3) % n)));
            let mut factors = Factors::<2>::new(n, &pattern);
            for _ in 0..3 {
                let values: Vec<[f64; 2]> = pattern.iter().map(|_| [draw(), draw()]).collect();
                let mut dense = nalgebra::DMatrix::zeros(2 * n, 2 * n);
                for ((i, j), [re, im]) in pattern.iter().zip(&values) {
                    dense[(*i, *j)] += re;
                    dense[(n + i, n + j)] += re;
                    dense[(*i, n + j)] -= im;
                    dense[(n + i, *j)] += im;
                }
                let singular_values = dense.singular_values();
                let condition = singular_values[0] / singular_values[2 * n - 1];
                if condition > 1e8 {
                    continue;
                }
                prop_assert!(factors.factor(&values).is_ok(), "condition {}", condition);
                let mut x: Vec<f64> = (0..2 * n).map(|_| draw()).collect();
                let exact = dense.lu().solve(&nalgebra::DVector::from_vec(x.clone()));
                let (re, im) = x.split_at_mut(n);
                factors.solve([re, im]);
                if let Some(exact) = exact {
                    for (x, exact_x) in x.iter().zip(&exact) {
                        prop_assert!((x - exact_x).abs() < 1e-12 * condition * exact.norm());
                    }
                }
            }
        }
    }
}
