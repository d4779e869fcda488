//! Eigenvalues of a small real matrix, without its eigenvectors.
//!
//! ```text
//! A → H = N⁻¹ A N                      zero below the first subdiagonal, by eliminations     (1)
//! H → Qᵀ H Q,  Q from (H − a)(H − b)   a, b: eigenvalues of the last two rows of a window     (2)
//! ```
//!
//! (2) is repeated until the window falls apart into blocks of one or two. Only the window is
//! transformed, as nothing beside it changes an eigenvalue.
//!
//! Source: Golub and Van Loan, *Matrix Computations*, chapter 7 (Francis' double step).

/// Sweeps per eigenvalue, at most.
const MOST_SWEEPS: usize = 60;
/// Sweeps after which shifts of another size are tried, in case those at hand go round in circles;
/// and what is left on the subdiagonal is compared with the matrix, as equal eigenvalues let it get
/// no smaller than that.
const SWEEPS_PER_ODD_SHIFT: usize = 10;

/// A square matrix, by rows.
struct Matrix<'a> {
    values: &'a mut [f64],
    n: usize,
}

/// Finds the eigenvalues of a square matrix of `n` rows, one behind the other, which is lost: (real
/// part, imaginary part) in no particular order. `None`: they were not found, as where an entry is
/// not finite. Small ones of a balanced matrix keep their digits beside large ones.
pub fn eigenvalues(values: &mut [f64], n: usize) -> Option<Vec<(f64, f64)>> {
    let mut a = Matrix { values, n };
    a.eliminate_below();
    let largest = a.values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let rounding = n as f64 * f64::EPSILON * largest;
    let mut found = Vec::with_capacity(n);
    let (mut high, mut sweeps) = (n, 0);
    while high > 0 {
        let rounding = if sweeps < SWEEPS_PER_ODD_SHIFT {
            0.0
        } else {
            rounding
        };
        let low = a.window_of(high, rounding);
        match high - low {
            1 => found.push((a.at(low, low), 0.0)),
            2 => found.extend(a.pair(low)),
            _ if sweeps == MOST_SWEEPS => return None,
            _ => {
                sweeps += 1;
                a.sweep([low, high], sweeps % SWEEPS_PER_ODD_SHIFT == 0);
                continue;
            }
        }
        (high, sweeps) = (low, 0);
    }
    let is_finite = |z: &(f64, f64)| z.0.is_finite() && z.1.is_finite();
    found.iter().all(is_finite).then_some(found)
}

impl Matrix<'_> {
    fn at(&self, i: usize, j: usize) -> f64 {
        self.values[i * self.n + j]
    }

    /// Eliminates what stands below the first subdiagonal (1).
    fn eliminate_below(&mut self) {
        let n = self.n;
        for m in 1..n.saturating_sub(1) {
            let size = |&i: &usize| self.at(i, m - 1).abs();
            let largest = (m..n).max_by(|i, j| size(i).total_cmp(&size(j)));
            let pivot = largest.unwrap_or(m);
            if self.at(pivot, m - 1) == 0.0 {
                continue;
            }
            if pivot != m {
                for k in 0..n {
                    self.values.swap(pivot * n + k, m * n + k);
                }
                for row in self.values.chunks_exact_mut(n) {
                    row.swap(pivot, m);
                }
            }
            // a row below less a multiple of the pivot's row, and its column more the same of that
            let first = self.at(m, m - 1);
            for i in m + 1..n {
                let factor = self.at(i, m - 1) / first;
                if factor == 0.0 {
                    continue;
                }
                let (above, below) = self.values.split_at_mut(i * n);
                let (pivot_row, row) = (&above[m * n..][..n], &mut below[..n]);
                for (x, p) in row[m..].iter_mut().zip(&pivot_row[m..]) {
                    *x -= factor * p;
                }
                row[m - 1] = 0.0;
                for row in self.values.chunks_exact_mut(n) {
                    row[m] += factor * row[i];
                }
            }
        }
    }

    /// Returns the first row of the window that ends before the row `high`: the entry beside it on
    /// the subdiagonal is rounding of the two eigenvalues that it parts, or no more than
    /// `rounding`.
    fn window_of(&self, high: usize, rounding: f64) -> usize {
        let is_apart = |&low: &usize| {
            low == 0 || {
                let beside = self.at(low - 1, low - 1).abs() + self.at(low, low).abs();
                self.at(low, low - 1).abs() <= rounding.max(f64::EPSILON * beside)
            }
        };
        (0..high).rev().find(is_apart).unwrap_or(0)
    }

    /// Returns the eigenvalues of two rows and columns.
    fn pair(&self, k: usize) -> [(f64, f64); 2] {
        let (a, b) = (self.at(k, k), self.at(k, k + 1));
        let (c, d) = (self.at(k + 1, k), self.at(k + 1, k + 1));
        let (mean, half) = (0.5 * (a + d), 0.5 * (a - d));
        let spread = half * half + b * c;
        let root = spread.abs().sqrt();
        if spread < 0.0 {
            return [(mean, root), (mean, -root)];
        }
        // the larger without cancellation, the other by what the product is
        let large = mean + if mean < 0.0 { -root } else { root };
        let small = if large == 0.0 {
            0.0
        } else {
            (a * d - b * c) / large
        };
        [(large, 0.0), (small, 0.0)]
    }

    /// Goes once through a window, from its first row to the one behind its last, with two shifts
    /// (2).
    fn sweep(&mut self, [low, high]: [usize; 2], has_odd_shift: bool) {
        let last = high - 1;
        let (a, b) = (self.at(last - 1, last - 1), self.at(last - 1, last));
        let (c, d) = (self.at(last, last - 1), self.at(last, last));
        let (mut sum, mut product) = (a + d, a * d - b * c);
        if has_odd_shift {
            let size = c.abs() + self.at(last - 1, last - 2).abs();
            (sum, product) = (1.5 * size, size * size);
        }
        // the first column of (H − a)(H − b)
        let (first, second) = (self.at(low, low), self.at(low + 1, low));
        let mut x = [
            first * (first - sum) + self.at(low, low + 1) * second + product,
            second * (first + self.at(low + 1, low + 1) - sum),
            second * self.at(low + 2, low + 1),
        ];
        for k in low..last - 1 {
            self.reflect([low, high], k, x);
            let below = |i: usize| if i < high { self.at(i, k) } else { 0.0 };
            x = [below(k + 1), below(k + 2), below(k + 3)];
        }
        self.reflect([low, high], last - 1, [x[0], x[1]]);
    }

    /// Reflects `N` rows and columns from `k` on, within a window, so that `x` gets the direction
    /// of the first.
    fn reflect<const N: usize>(&mut self, [low, high]: [usize; 2], k: usize, x: [f64; N]) {
        let largest = x.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if largest == 0.0 {
            return;
        }
        // of no size that overflows
        let mut v = x.map(|x| x / largest);
        let length = v.iter().map(|v| v * v).sum::<f64>().sqrt();
        v[0] += if x[0] < 0.0 { -length } else { length };
        let scale = 2.0 / v.iter().map(|v| v * v).sum::<f64>();
        let n = self.n;
        for j in k.saturating_sub(1).max(low)..high {
            let along: f64 = (0..N).map(|i| v[i] * self.values[(k + i) * n + j]).sum();
            (0..N).for_each(|i| self.values[(k + i) * n + j] -= scale * along * v[i]);
        }
        for row in self.values[low * n..high.min(k + 4) * n].chunks_exact_mut(n) {
            let row = &mut row[k..k + N];
            let along: f64 = row.iter().zip(&v).map(|(x, v)| x * v).sum();
            row.iter_mut()
                .zip(&v)
                .for_each(|(x, v)| *x -= scale * along * v);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::between_ones;
    use proptest::prelude::*;

    /// The eigenvalues of a matrix by rows.
    fn of(a: Vec<Vec<f64>>) -> Option<Vec<(f64, f64)>> {
        let n = a.len();
        eigenvalues(&mut a.concat(), n)
    }

    fn sorted(mut all: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        all
    }

    #[test]
    fn simple_matrices_have_the_eigenvalues_that_they_are_known_for() {
        assert_eq!(of(Vec::new()), Some(Vec::new()));
        assert_eq!(of(vec![vec![-3.0]]), Some(vec![(-3.0, 0.0)]));
        // a cyclic permutation: the roots of one, which unshifted sweeps would never leave
        let n = 8;
        let row = |i: usize| {
            (0..n)
                .map(|j| f64::from(u8::from((i + 1) % n == j)))
                .collect()
        };
        let found = of((0..n).map(row).collect()).unwrap();
        assert_eq!(found.len(), n);
        for (re, im) in found {
            let turns = im.atan2(re) / std::f64::consts::TAU * n as f64;
            assert!((re.hypot(im) - 1.0).abs() < 1e-13 && (turns - turns.round()).abs() < 1e-12);
        }
        assert_eq!(of(vec![vec![f64::NAN; 3]; 3]), None);
        assert_eq!(of(vec![vec![0.0; 4]; 4]), Some(vec![(0.0, 0.0); 4]));
    }

    #[test]
    fn eigenvalues_that_are_equal_but_for_rounding_are_all_found() {
        // a chain of parallelograms between two states: the same two eigenvalues for each
        for n in [2, 6, 10, 20, 40] {
            let mut draw = between_ones(1);
            let mut noise = || (0..n).map(|_| 1e-15 * draw()).collect();
            let mut a: Vec<Vec<f64>> = (0..n).map(|_| noise()).collect();
            for k in (0..n).step_by(2) {
                a[k][k] -= 0.25;
                a[k][k + 1] += 2.75;
                a[k + 1][k + 1] += 1.0;
            }
            let found = of(a).unwrap();
            for (expected, sign) in [(-0.25, -1.0), (1.0, 1.0)] {
                let all = found.iter().filter(|z| z.0 * sign > 0.0);
                assert_eq!(all.clone().count(), n / 2);
                assert!(all.clone().all(|z| (z.0 - expected).hypot(z.1) < 1e-6));
            }
        }
    }

    proptest! {
        /// Small motions of what spins, `ẍ = G ẋ + K x` with a skew G and a symmetric K, have
        /// eigenvalues at which `A − λ` is singular, slow ones beside fast ones as well.
        #[test]
        fn what_spins_has_eigenvalues(
            n in 1usize..5, spin in -3.0f64..3.0, numbers in proptest::collection::vec(-1.0f64..1.0, 32),
        ) {
            let at = |i: usize, j: usize| numbers[at_pair(i, j)];
            let sign = |i: usize, j: usize| f64::from(u8::from(i < j)) - f64::from(u8::from(i > j));
            let speed = 10f64.powf(spin);
            let entry = |i: usize, j: usize| match (i < n, j < n) {
                (true, _) => f64::from(u8::from(j == i + n)),
                (false, true) => at(i - n, j),
                (false, false) => speed * sign(i - n, j - n) * numbers[16 + at_pair(i - n, j - n)],
            };
            let a = nalgebra::DMatrix::from_fn(2 * n, 2 * n, entry);
            let rows = (0..2 * n).map(|i| a.row(i).iter().copied().collect()).collect();
            let found = of(rows).unwrap();
            prop_assert_eq!(found.len(), 2 * n);
            for (re, im) in found {
                let mut shifted = a.map(|x| nalgebra::Complex::new(x, 0.0));
                (0..2 * n).for_each(|k| shifted[(k, k)] -= nalgebra::Complex::new(re, im));
                let sizes = shifted.singular_values();
                prop_assert!(sizes.min() < 1e-12 * a.norm().max(1.0), "{re} {im} {}", sizes.min());
            }
        }
    }

    /// The place of a pair in a list, whatever its order.
    fn at_pair(i: usize, j: usize) -> usize {
        4 * i.min(j) + i.max(j)
    }

    proptest! {
        /// The eigenvalues of a matrix are those that another algorithm finds, and their sum is its
        /// trace.
        #[test]
        fn eigenvalues_are_those_of_another_algorithm(
            n in 1usize..14, numbers in proptest::collection::vec(-1.0f64..1.0, 200),
        ) {
            let a: Vec<Vec<f64>> = numbers.chunks(n).take(n).map(<[f64]>::to_vec).collect();
            let matrix = nalgebra::DMatrix::from_fn(n, n, |i, j| a[i][j]);
            let found = of(a).unwrap();
            let sum: f64 = found.iter().map(|z| z.0).sum();
            prop_assert!((sum - matrix.trace()).abs() < 1e-11);
            let schur = nalgebra::linalg::Schur::try_new(matrix, f64::EPSILON, 1000).unwrap();
            let other = schur.complex_eigenvalues().iter().map(|z| (z.re, z.im)).collect();
            let (found, other): (Vec<_>, Vec<_>) = (sorted(found), sorted(other));
            for z in &found {
                let near = |w: &(f64, f64)| (z.0 - w.0).hypot(z.1 - w.1);
                let nearest = other.iter().map(near).fold(f64::INFINITY, f64::min);
                prop_assert!(nearest < 1e-6, "{z:?}: {nearest:e}");
            }
        }
    }
}
