//! Dense LU factorizations in place, real and complex, for the small systems of implicit methods.
//!
//! ```text
//! P A = L U        by columns, partial pivoting; column j is finished before column j + 1 is
//!                  touched (left-looking)
//! ```
//!
//! While column `j` is updated it stays in the nearest cache, and four earlier columns are applied
//! to it at a time, so each of its entries is loaded once per eight operations. A complex matrix is
//! two real ones, its real and imaginary parts, so that the same loops run in vector registers.
//! Nothing allocates after construction (nalgebra's factorization, as fast at these sizes,
//! allocates its pivots each time).
//!
//! *Zeros*: each column of L knows the place of its last nonzero, each column of U that of its
//! first, and products with zero are skipped. Parts that are free and tied to their neighbours by
//! forces (the beams of a blade) have matrices like bands, whose factors then cost what the band
//! costs; a full matrix takes no longer than without this.
//!
//! *Singular*: a pivot that is zero or not finite; the error is the index of its column, the
//! unknown that nothing determines.
#![allow(clippy::needless_range_loop)] // several columns at one row index

/// Columns that are factored between two looks whether to go on.
const COLUMNS_BETWEEN_LOOKS: usize = 16;

/// Factors of a real matrix.
#[derive(Clone, Debug)]
pub struct Lu {
    n: usize,
    /// the matrix, then L below and U on and above the diagonal, by columns   (n × n)
    a: Vec<f64>,
    /// row exchanged with row j at step j   (n)
    pivots: Vec<usize>,
    /// row from which on each column of L is zero   (n)
    low: Vec<usize>,
    /// row before which each column of U is zero   (n)
    top: Vec<usize>,
}

impl Lu {
    /// Creates room for an `n × n` matrix.
    pub fn new(n: usize) -> Self {
        Lu {
            n,
            a: vec![0.0; n * n],
            pivots: vec![0; n],
            low: vec![n; n],
            top: vec![0; n],
        }
    }

    /// Returns the number of rows.
    pub fn size(&self) -> usize {
        self.n
    }

    /// Returns the place for the matrix before [`Lu::factor`]: `[i + n·j]`   (n × n)
    pub fn matrix_mut(&mut self) -> &mut [f64] {
        &mut self.a
    }

    /// Factors the matrix in place. A column counts as zero when its pivot is below `tiny` times
    /// the largest entry it began with.
    ///
    /// # Errors
    /// The column without a pivot.
    pub fn factor(&mut self, tiny: f64) -> Result<(), usize> {
        self.factor_while(tiny, &mut || true)
    }

    /// The same for as long as `goes_on` says so, which is asked after every few columns.
    ///
    /// # Errors
    /// The column without a pivot, or where it ended.
    pub fn factor_while(
        &mut self,
        tiny: f64,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<(), usize> {
        let n = self.n;
        for j in 0..n {
            if j % COLUMNS_BETWEEN_LOOKS == COLUMNS_BETWEEN_LOOKS - 1 && !goes_on() {
                return Err(j);
            }
            let (done, rest) = self.a.split_at_mut(j * n);
            let column = &mut rest[..n];
            let size = if tiny > 0.0 {
                column.iter().fold(0.0f64, |m, x| m.max(x.abs()))
            } else {
                0.0
            };
            for k in 0..j {
                column.swap(k, self.pivots[k]);
            }
            subtract_columns(column, done, &self.low[..j]);

            // choose the pivot
            let mut pivot = j;
            for i in j + 1..n {
                if column[i].abs() > column[pivot].abs() {
                    pivot = i;
                }
            }
            let inverse = 1.0 / column[pivot];
            if column[pivot].abs() <= tiny * size
                || !column[pivot].is_finite()
                || !inverse.is_finite()
            {
                return Err(j);
            }

            // exchange rows
            self.pivots[j] = pivot;
            if pivot != j {
                column.swap(j, pivot);
                for k in 0..j {
                    done.swap(k * n + j, k * n + pivot);
                    if pivot >= self.low[k] && done[k * n + pivot] != 0.0 {
                        self.low[k] = pivot + 1;
                    }
                }
            }

            // divide by the pivot
            let mut sum = 0.0;
            self.low[j] = j + 1;
            for i in j + 1..n {
                column[i] *= inverse;
                sum += column[i];
                if column[i] != 0.0 {
                    self.low[j] = i + 1;
                }
            }
            if sum.is_nan() {
                return Err(j);
            }
            let first = column[..j].iter().position(|u| *u != 0.0);
            self.top[j] = first.unwrap_or(j);
        }
        Ok(())
    }

    /// Returns whether the determinant is positive.
    pub fn positive(&self) -> bool {
        let n = self.n;
        let sign = |k: usize| (self.pivots[k] != k) != (self.a[k * n + k] < 0.0);
        !(0..n).fold(false, |negative, k| negative != sign(k))
    }

    /// Solves `x ← A⁻¹ x`.
    pub fn solve(&self, x: &mut [f64]) {
        let n = self.n;
        let x = &mut x[..n];
        for k in 0..n {
            x.swap(k, self.pivots[k]);
        }
        for k in 0..n {
            let xk = x[k];
            if xk == 0.0 {
                continue;
            }
            let low = self.low[k];
            for (x, l) in x[k + 1..low]
                .iter_mut()
                .zip(&self.a[k * n + k + 1..k * n + low])
            {
                *x -= l * xk;
            }
        }
        for k in (0..n).rev() {
            let column = &self.a[k * n..(k + 1) * n];
            let xk = x[k] / column[k];
            x[k] = xk;
            if xk == 0.0 {
                continue;
            }
            let top = self.top[k];
            for (x, u) in x[top..k].iter_mut().zip(&column[top..k]) {
                *x -= u * xk;
            }
        }
    }
}

/// Subtracts from `column` the columns of L in `done`, as many as `low` has, times its entries of
/// U.
///
/// `low[k]`: the row from which on column `k` of L is zero.
#[inline]
fn subtract_columns(column: &mut [f64], done: &[f64], low: &[usize]) {
    let (n, j) = (column.len(), low.len());
    // four columns at a time: their rows of U first, then one sweep below
    let mut k = 0;
    while k + 4 <= j {
        if column[k..k + 4].iter().all(|u| *u == 0.0) {
            k += 4;
            continue;
        }
        let (l0, l1) = (&done[k * n..(k + 1) * n], &done[(k + 1) * n..(k + 2) * n]);
        let (l2, l3) = (
            &done[(k + 2) * n..(k + 3) * n],
            &done[(k + 3) * n..(k + 4) * n],
        );
        let u0 = column[k];
        let u1 = column[k + 1] - l0[k + 1] * u0;
        let u2 = column[k + 2] - l0[k + 2] * u0 - l1[k + 2] * u1;
        let u3 = column[k + 3] - l0[k + 3] * u0 - l1[k + 3] * u1 - l2[k + 3] * u2;
        column[k + 1..k + 4].copy_from_slice(&[u1, u2, u3]);
        let end = low[k..k + 4].iter().fold(k + 4, |m, l| m.max(*l));
        let below = &mut column[k + 4..end];
        let m = below.len();
        let (l0, l1, l2, l3) = (
            &l0[k + 4..][..m],
            &l1[k + 4..][..m],
            &l2[k + 4..][..m],
            &l3[k + 4..][..m],
        );
        for i in 0..m {
            below[i] -= (l0[i] * u0 + l1[i] * u1) + (l2[i] * u2 + l3[i] * u3);
        }
        k += 4;
    }
    // the remaining ones
    for k in k..j {
        let u = column[k];
        if u == 0.0 {
            continue;
        }
        let below = &mut column[k + 1..low[k]];
        for (c, l) in below.iter_mut().zip(&done[k * n + k + 1..(k + 1) * n]) {
            *c -= l * u;
        }
    }
}

/// Factors of a complex matrix.
#[derive(Clone, Debug)]
pub struct ComplexLu {
    n: usize,
    /// real part, by columns   (n × n)
    re: Vec<f64>,
    /// imaginary part, by columns   (n × n)
    im: Vec<f64>,
    /// row exchanged with row j at step j   (n)
    pivots: Vec<usize>,
    /// row from which on each column of L is zero   (n)
    low: Vec<usize>,
    /// row before which each column of U is zero   (n)
    top: Vec<usize>,
}

impl ComplexLu {
    /// Creates room for an `n × n` matrix.
    pub fn new(n: usize) -> Self {
        ComplexLu {
            n,
            re: vec![0.0; n * n],
            im: vec![0.0; n * n],
            pivots: vec![0; n],
            low: vec![n; n],
            top: vec![0; n],
        }
    }

    /// Returns the places for real and imaginary parts before [`ComplexLu::factor`]: `[i + n·j]`
    /// (n × n each)
    pub fn matrix_mut(&mut self) -> (&mut [f64], &mut [f64]) {
        (&mut self.re, &mut self.im)
    }

    /// Factors the matrix in place.
    ///
    /// # Errors
    /// The column without a pivot.
    pub fn factor(&mut self) -> Result<(), usize> {
        let n = self.n;
        for j in 0..n {
            let (done_re, rest_re) = self.re.split_at_mut(j * n);
            let (done_im, rest_im) = self.im.split_at_mut(j * n);
            let (re, im) = (&mut rest_re[..n], &mut rest_im[..n]);
            for k in 0..j {
                re.swap(k, self.pivots[k]);
                im.swap(k, self.pivots[k]);
            }
            for k in 0..j {
                let (ur, ui) = (re[k], im[k]);
                if ur == 0.0 && ui == 0.0 {
                    continue;
                }
                let low = self.low[k];
                let (below_re, below_im) = (&mut re[k + 1..low], &mut im[k + 1..low]);
                let m = below_re.len();
                let below_im = &mut below_im[..m];
                let (lr, li) = (
                    &done_re[k * n + k + 1..][..m],
                    &done_im[k * n + k + 1..][..m],
                );
                for i in 0..m {
                    below_re[i] -= lr[i] * ur - li[i] * ui;
                    below_im[i] -= lr[i] * ui + li[i] * ur;
                }
            }
            let size = |i: usize| re[i].abs() + im[i].abs();
            let mut pivot = j;
            for i in j + 1..n {
                if size(i) > size(pivot) {
                    pivot = i;
                }
            }
            let (pr, pi) = (re[pivot], im[pivot]);
            let (ir, ii) = reciprocal(pr, pi);
            if !(ir.is_finite() && ii.is_finite()) || (ir == 0.0 && ii == 0.0) {
                return Err(j);
            }
            self.pivots[j] = pivot;
            if pivot != j {
                re.swap(j, pivot);
                im.swap(j, pivot);
                for k in 0..j {
                    done_re.swap(k * n + j, k * n + pivot);
                    done_im.swap(k * n + j, k * n + pivot);
                    let moved = done_re[k * n + pivot] != 0.0 || done_im[k * n + pivot] != 0.0;
                    if pivot >= self.low[k] && moved {
                        self.low[k] = pivot + 1;
                    }
                }
            }
            let mut sum = 0.0;
            self.low[j] = j + 1;
            for i in j + 1..n {
                (re[i], im[i]) = (re[i] * ir - im[i] * ii, re[i] * ii + im[i] * ir);
                sum += re[i] + im[i];
                if re[i] != 0.0 || im[i] != 0.0 {
                    self.low[j] = i + 1;
                }
            }
            if sum.is_nan() {
                return Err(j);
            }
            let first = (0..j).find(|&i| re[i] != 0.0 || im[i] != 0.0);
            self.top[j] = first.unwrap_or(j);
        }
        Ok(())
    }

    /// Solves `x ← A⁻¹ x`, real and imaginary parts apart.
    pub fn solve(&self, re: &mut [f64], im: &mut [f64]) {
        let n = self.n;
        let (re, im) = (&mut re[..n], &mut im[..n]);
        for k in 0..n {
            re.swap(k, self.pivots[k]);
            im.swap(k, self.pivots[k]);
        }
        for k in 0..n {
            let (xr, xi) = (re[k], im[k]);
            if xr == 0.0 && xi == 0.0 {
                continue;
            }
            let (lr, li) = (&self.re[k * n..(k + 1) * n], &self.im[k * n..(k + 1) * n]);
            let rows = k + 1..self.low[k];
            let (lr, li) = (&lr[rows.clone()], &li[rows.clone()]);
            subtract_product((&mut re[rows.clone()], &mut im[rows]), (lr, li), (xr, xi));
        }
        for k in (0..n).rev() {
            let (ur, ui) = (&self.re[k * n..(k + 1) * n], &self.im[k * n..(k + 1) * n]);
            let (ir, ii) = reciprocal(ur[k], ui[k]);
            let (xr, xi) = (re[k] * ir - im[k] * ii, re[k] * ii + im[k] * ir);
            (re[k], im[k]) = (xr, xi);
            if xr == 0.0 && xi == 0.0 {
                continue;
            }
            let rows = self.top[k]..k;
            let (ur, ui) = (&ur[rows.clone()], &ui[rows.clone()]);
            subtract_product((&mut re[rows.clone()], &mut im[rows]), (ur, ui), (xr, xi));
        }
    }
}

/// `z ← z − column · x`, real and imaginary parts apart; all of one length.
#[inline]
fn subtract_product((re, im): (&mut [f64], &mut [f64]), (cr, ci): (&[f64], &[f64]), x: (f64, f64)) {
    let m = re.len();
    let (im, cr, ci) = (&mut im[..m], &cr[..m], &ci[..m]);
    for i in 0..m {
        re[i] -= cr[i] * x.0 - ci[i] * x.1;
        im[i] -= cr[i] * x.1 + ci[i] * x.0;
    }
}

/// Returns `1/(re + i im)`, without overflow on the way.
pub(super) fn reciprocal(re: f64, im: f64) -> (f64, f64) {
    if re.abs() >= im.abs() {
        let q = im / re;
        let d = re + im * q;
        (1.0 / d, -q / d)
    } else {
        let q = re / im;
        let d = re * q + im;
        (q / d, -1.0 / d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn real_factors_solve(n in 1usize..24, entries in proptest::collection::vec(-1.0f64..1.0, 600)) {
            let mut lu = Lu::new(n);
            let a = entries[..n * n].to_vec();
            let x: Vec<f64> = entries[n * n..n * n + n].to_vec();
            let mut b: Vec<f64> = (0..n).map(|i| (0..n).map(|j| a[i + n * j] * x[j]).sum()).collect();
            lu.matrix_mut().copy_from_slice(&a);
            prop_assume!(lu.factor(0.0).is_ok());
            lu.solve(&mut b);
            let oracle = nalgebra::DMatrix::from_column_slice(n, n, &a);
            let condition = oracle.clone().try_inverse().map_or(1e20, |i| i.norm() * oracle.norm());
            for (b, x) in b.iter().zip(&x) {
                prop_assert!((b - x).abs() < 1e-14 * condition);
            }
        }

        #[test]
        fn complex_factors_solve(n in 1usize..16, entries in proptest::collection::vec(-1.0f64..1.0, 600)) {
            let mut lu = ComplexLu::new(n);
            let (a, b) = (&entries[..n * n], &entries[n * n..2 * n * n]);
            let (xr, xi) = (&entries[550..550 + n], &entries[570..570 + n]);
            let product = |f: &dyn Fn(usize, usize) -> f64| (0..n).map(|i| (0..n).map(|j| f(i + n * j, j)).sum()).collect::<Vec<f64>>();
            let mut re = product(&|e, j| a[e] * xr[j] - b[e] * xi[j]);
            let mut im = product(&|e, j| a[e] * xi[j] + b[e] * xr[j]);
            let (mr, mi) = lu.matrix_mut();
            mr.copy_from_slice(a);
            mi.copy_from_slice(b);
            prop_assume!(lu.factor().is_ok());
            lu.solve(&mut re, &mut im);
            for i in 0..n {
                prop_assert!((re[i] - xr[i]).abs() + (im[i] - xi[i]).abs() < 1e-7);
            }
        }
    }

    /// A band with a corner far off, its rows in another order.
    fn banded(n: usize, shift: usize, entries: &[f64]) -> Vec<f64> {
        let mut a = vec![0.0; n * n];
        for j in 0..n {
            for i in j.saturating_sub(2)..(j + 3).min(n) {
                a[(i + shift) % n + n * j] = entries[(5 * j + i) % entries.len()];
            }
        }
        a[shift % n + n * (n - 1)] = 0.5;
        a
    }

    proptest! {
        #[test]
        fn zeros_make_no_difference(n in 3usize..40, shift in 0usize..40, entries in proptest::collection::vec(-1.0f64..1.0, 211)) {
            let a = banded(n, shift, &entries);
            let b = banded(n, shift, &entries[1..]);
            let x: Vec<f64> = entries[..n].to_vec();
            let product = |a: &[f64]| (0..n).map(|i| (0..n).map(|j| a[i + n * j] * x[j]).sum()).collect::<Vec<f64>>();
            let oracle = nalgebra::DMatrix::from_column_slice(n, n, &a);
            let condition = oracle.clone().try_inverse().map_or(1e20, |i| i.norm() * oracle.norm());
            let mut lu = Lu::new(n);
            lu.matrix_mut().copy_from_slice(&a);
            if lu.factor(0.0).is_ok() {
                let mut found = product(&a);
                lu.solve(&mut found);
                for (b, x) in found.iter().zip(&x) {
                    prop_assert!((b - x).abs() < 1e-14 * condition);
                }
            }
            // (a + i b) x with real x
            let mut lu = ComplexLu::new(n);
            let (re, im) = lu.matrix_mut();
            re.copy_from_slice(&a);
            im.copy_from_slice(&b);
            let whole = nalgebra::DMatrix::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
                (true, true) => a[i + n * j],
                (true, false) => -b[i + n * (j - n)],
                (false, true) => b[i - n + n * j],
                (false, false) => a[i - n + n * (j - n)],
            });
            let condition = whole.clone().try_inverse().map_or(1e20, |i| i.norm() * whole.norm());
            if lu.factor().is_ok() {
                let (mut re, mut im) = (product(&a), product(&b));
                lu.solve(&mut re, &mut im);
                for i in 0..n {
                    prop_assert!((re[i] - x[i]).abs() + im[i].abs() < 1e-13 * condition);
                }
            }
        }
    }

    #[test]
    fn a_singular_matrix_names_its_column() {
        let mut lu = Lu::new(3);
        lu.matrix_mut()
            .copy_from_slice(&[1.0, 0.0, 1.0, 2.0, 0.0, 2.0, 0.0, 1.0, 0.0]);
        assert_eq!(lu.factor(0.0), Err(1));
        let mut lu = Lu::new(2);
        lu.matrix_mut().copy_from_slice(&[1.0, f64::NAN, 0.0, 1.0]);
        assert!(lu.factor(0.0).is_err());
        let mut lu = ComplexLu::new(2);
        assert_eq!(lu.factor(), Err(0));
    }
}
