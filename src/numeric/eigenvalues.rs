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
/// Sweeps after which shifts of another size are tried, in case those at hand go round in circles.
const SWEEPS_PER_ODD_SHIFT: usize = 10;

/// A part of a matrix in Hessenberg form, by rows.
struct Window<'a> {
    h: &'a mut [Vec<f64>],
    /// its first row, and the one behind its last
    low: usize,
    high: usize,
}

/// Finds the eigenvalues of a square matrix, given by rows: (real part, imaginary part) in no
/// particular order. `None`: they were not found, as where an entry is not finite.
pub fn eigenvalues(mut a: Vec<Vec<f64>>) -> Option<Vec<(f64, f64)>> {
    let n = a.len();
    to_hessenberg(&mut a);
    // entries below are rounding, as equal eigenvalues let them grow no smaller than that
    let largest = a.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let rounding = n as f64 * f64::EPSILON * largest;
    let mut found = Vec::with_capacity(n);
    let (mut high, mut sweeps) = (n, 0);
    while high > 0 {
        let low = window_of(&a, high, rounding);
        match high - low {
            1 => found.push((a[low][low], 0.0)),
            2 => found.extend(pair(&a, low)),
            _ if sweeps == MOST_SWEEPS => return None,
            _ => {
                sweeps += 1;
                let h = a.as_mut_slice();
                Window { h, low, high }.sweep(sweeps % SWEEPS_PER_ODD_SHIFT == 0);
                continue;
            }
        }
        (high, sweeps) = (low, 0);
    }
    let is_finite = |z: &(f64, f64)| z.0.is_finite() && z.1.is_finite();
    found.iter().all(is_finite).then_some(found)
}

/// Eliminates what stands below the first subdiagonal (1).
fn to_hessenberg(a: &mut [Vec<f64>]) {
    let n = a.len();
    for m in 1..n.saturating_sub(1) {
        let size = |&i: &usize| a[i][m - 1].abs();
        let largest = (m..n).max_by(|i, j| size(i).total_cmp(&size(j)));
        let pivot = largest.unwrap_or(m);
        if a[pivot][m - 1] == 0.0 {
            continue;
        }
        a.swap(pivot, m);
        a.iter_mut().for_each(|row| row.swap(pivot, m));
        // rows below less multiples of the pivot's row, and its column more the same of theirs
        let (above, below) = a.split_at_mut(m + 1);
        let pivot_row = &above[m];
        let mut factors = Vec::with_capacity(n - m - 1);
        for row in below {
            let factor = row[m - 1] / pivot_row[m - 1];
            let entries = row.iter_mut().zip(pivot_row).skip(m);
            entries.for_each(|(x, p)| *x -= factor * p);
            row[m - 1] = 0.0;
            factors.push(factor);
        }
        for row in a.iter_mut() {
            let others = row[m + 1..].iter().zip(&factors);
            row[m] += others.map(|(x, factor)| factor * x).sum::<f64>();
        }
    }
}

/// Returns the first row of the window that ends before the row `high`: the entry beside it on the
/// subdiagonal is no more than `rounding`.
fn window_of(h: &[Vec<f64>], high: usize, rounding: f64) -> usize {
    let mut low = high - 1;
    while low > 0 {
        if h[low][low - 1].abs() <= rounding {
            break;
        }
        low -= 1;
    }
    low
}

/// Returns the eigenvalues of two rows and columns.
fn pair(h: &[Vec<f64>], k: usize) -> [(f64, f64); 2] {
    let (a, b, c, d) = (h[k][k], h[k][k + 1], h[k + 1][k], h[k + 1][k + 1]);
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

impl Window<'_> {
    /// Goes once through the window with two shifts (2).
    fn sweep(&mut self, has_odd_shift: bool) {
        let (low, high, h) = (self.low, self.high, &*self.h);
        let last = high - 1;
        let (mut sum, mut product) = (
            h[last - 1][last - 1] + h[last][last],
            h[last - 1][last - 1] * h[last][last] - h[last - 1][last] * h[last][last - 1],
        );
        if has_odd_shift {
            let size = h[last][last - 1].abs() + h[last - 1][last - 2].abs();
            (sum, product) = (1.5 * size, size * size);
        }
        // the first column of (H − a)(H − b)
        let (first, second) = (h[low][low], h[low + 1][low]);
        let mut x = [
            first * (first - sum) + h[low][low + 1] * second + product,
            second * (first + h[low + 1][low + 1] - sum),
            second * h[low + 2][low + 1],
        ];
        for k in low..last {
            self.reflect(k, x);
            let below = |i: usize| if i < high { self.h[i][k] } else { 0.0 };
            x = [below(k + 1), below(k + 2), below(k + 3)];
        }
    }

    /// Reflects rows and columns from `k` on, three or as many as are left, so that `x` gets the
    /// direction of the first.
    fn reflect(&mut self, k: usize, x: [f64; 3]) {
        let n = 3.min(self.high - k);
        let length = x[..n].iter().fold(0.0, |l: f64, x| l.hypot(*x));
        let mut v = x;
        v[0] += if x[0] < 0.0 { -length } else { length };
        let square: f64 = v[..n].iter().map(|v| v * v).sum();
        if square == 0.0 {
            return;
        }
        let scale = 2.0 / square;
        for j in k.saturating_sub(1).max(self.low)..self.high {
            let along: f64 = (0..n).map(|i| v[i] * self.h[k + i][j]).sum();
            (0..n).for_each(|i| self.h[k + i][j] -= scale * along * v[i]);
        }
        for row in &mut self.h[self.low..self.high.min(k + 4)] {
            let row = &mut row[k..k + n];
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

    fn sorted(mut all: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        all
    }

    #[test]
    fn simple_matrices_have_the_eigenvalues_that_they_are_known_for() {
        assert_eq!(eigenvalues(Vec::new()), Some(Vec::new()));
        assert_eq!(eigenvalues(vec![vec![-3.0]]), Some(vec![(-3.0, 0.0)]));
        // a cyclic permutation: the roots of one, which unshifted sweeps would never leave
        let n = 8;
        let row = |i: usize| {
            (0..n)
                .map(|j| f64::from(u8::from((i + 1) % n == j)))
                .collect()
        };
        let found = eigenvalues((0..n).map(row).collect()).unwrap();
        assert_eq!(found.len(), n);
        for (re, im) in found {
            let turns = im.atan2(re) / std::f64::consts::TAU * n as f64;
            assert!((re.hypot(im) - 1.0).abs() < 1e-13 && (turns - turns.round()).abs() < 1e-12);
        }
        assert_eq!(eigenvalues(vec![vec![f64::NAN; 3]; 3]), None);
        assert_eq!(
            eigenvalues(vec![vec![0.0; 4]; 4]),
            Some(vec![(0.0, 0.0); 4])
        );
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
            let found = eigenvalues(a).unwrap();
            for (expected, sign) in [(-0.25, -1.0), (1.0, 1.0)] {
                let all = found.iter().filter(|z| z.0 * sign > 0.0);
                assert_eq!(all.clone().count(), n / 2);
                assert!(all.clone().all(|z| (z.0 - expected).hypot(z.1) < 1e-6));
            }
        }
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
            let found = eigenvalues(a).unwrap();
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
