//! The full systems of Radau's iteration, with rates that are no more than other unknowns
//! eliminated first.
//!
//! ```text
//! S   unknowns whose rates depend on few others, none of them in S (q̇ = v)
//! R   all others
//! (γ − J_RR − J_RS J_SR/γ) x_R = b_R + J_RS b_S/γ                               (1)
//! x_S = (b_S + J_SR x_R)/γ                                                      (2)
//! ```
//!
//! A mechanism has as many positions as velocities: then (1) has half as many unknowns and takes an
//! eighth of the work to factor. The complex system is eliminated in the same way.
//!
//! *Stiffness*: pivots of the unknowns in S are γ, whatever stands below them. Where stiffness over
//! mass is κ γ², x_S of (2) is a small difference, exact to ε κ of it, which is what a correction
//! leaves to the next one. Up to κ = 10¹⁴ that is below the rate of convergence from which on a
//! Jacobian is evaluated anew; beyond, the iteration converges more slowly and steps do not grow.
//!
//! Source: Hairer & Wanner, Solving ODEs II, IV.8, "special structure of the problem".

use crate::numeric::dense::{ComplexLu, Lu};
use crate::numeric::sparse::DENSE_LIMIT;

/// Entries of a row of the Jacobian whose unknown may be eliminated first, at most.
pub(super) const MOST_ENTRIES: usize = 4;

/// Both systems of the iteration, for a full Jacobian.
#[derive(Clone, Debug)]
pub(super) struct Full {
    n: usize,
    /// the unknowns in S, ascending
    eliminated: Vec<usize>,
    /// those in R, ascending
    kept: Vec<usize>,
    /// entries of J_SR: place in S, place in R, value
    links: Vec<(usize, usize, f64)>,
    /// J_RS, by columns   (R × S)
    beside: Vec<f64>,
    /// J_RS J_SR, by columns   (R × R)
    product: Vec<f64>,
    /// factors of the real matrix of (1)
    real: Lu,
    /// factors of the complex one
    complex: ComplexLu,
    /// 1/γ
    inverse: f64,
    /// 1/(α + iβ), real and imaginary part
    complex_inverse: (f64, f64),
    /// right-hand sides of (1), real and imaginary part   (R each)
    right: [Vec<f64>; 2],
}

impl Full {
    /// Creates systems of `n` unknowns.
    pub fn new(n: usize) -> Self {
        Self {
            n,
            eliminated: Vec::new(),
            kept: Vec::new(),
            links: Vec::new(),
            beside: Vec::new(),
            product: Vec::new(),
            real: Lu::new(0),
            complex: ComplexLu::new(0),
            inverse: 0.0,
            complex_inverse: (0.0, 0.0),
            right: [Vec::new(), Vec::new()],
        }
    }

    /// Takes note of a new Jacobian, by columns   (n × n)
    pub fn see(&mut self, jacobian: &[f64]) {
        let n = self.n;
        let begins = self.kept.is_empty();
        if begins || !self.link(jacobian) {
            // entries that were zero before are here now
            let eliminated = match begins {
                true => first_choice(jacobian, n),
                false => eliminable(jacobian, n, &mut self.eliminated.iter().copied()),
            };
            self.choose(eliminated);
            self.link(jacobian);
        }
        self.multiply(jacobian);
    }

    /// Becomes what systems of this Jacobian are that were left, factors included, if systems that
    /// begin with it would be the same; returns whether it did.
    pub fn take(&mut self, left: &Self, jacobian: &[f64]) -> bool {
        if left.kept.is_empty() || first_choice(jacobian, self.n) != left.eliminated {
            return false;
        }
        // whose room says how many there may be
        let mut links = Vec::with_capacity(left.links.capacity());
        links.extend_from_slice(&left.links);
        *self = Self {
            links,
            ..left.clone()
        };
        true
    }

    /// Chooses the unknowns that are eliminated first.
    fn choose(&mut self, eliminated: Vec<usize>) {
        let kept = (0..self.n).filter(|i| eliminated.binary_search(i).is_err());
        self.kept = kept.collect();
        let m = self.kept.len();
        self.links = Vec::with_capacity(MOST_ENTRIES * eliminated.len());
        self.beside = vec![0.0; m * eliminated.len()];
        self.product = vec![0.0; if eliminated.is_empty() { 0 } else { m * m }];
        (self.real, self.complex) = (Lu::new(m), ComplexLu::new(m));
        self.right = [vec![0.0; m], vec![0.0; m]];
        self.eliminated = eliminated;
    }

    /// Gathers J_SR; returns whether the unknowns in S may still be eliminated.
    fn link(&mut self, jacobian: &[f64]) -> bool {
        let n = self.n;
        self.links.clear();
        let among = |&j: &usize| self.eliminated.iter().any(|i| jacobian[i + n * j] != 0.0);
        if self.eliminated.iter().any(among) {
            return false;
        }
        for (place, &j) in self.kept.iter().enumerate() {
            for (s, i) in self.eliminated.iter().enumerate() {
                let value = jacobian[i + n * j];
                if value == 0.0 {
                    continue;
                }
                if self.links.len() == self.links.capacity() {
                    return false;
                }
                self.links.push((s, place, value));
            }
        }
        true
    }

    /// Gathers J_RS and multiplies it by J_SR.
    fn multiply(&mut self, jacobian: &[f64]) {
        let (n, m) = (self.n, self.kept.len());
        for (column, j) in self.beside.chunks_exact_mut(m).zip(&self.eliminated) {
            for (entry, i) in column.iter_mut().zip(&self.kept) {
                *entry = jacobian[i + n * j];
            }
        }
        self.product.fill(0.0);
        for &(s, place, value) in &self.links {
            let column = &mut self.product[m * place..m * (place + 1)];
            add(column, &self.beside[m * s..m * (s + 1)], value);
        }
    }

    /// Returns how many unknowns are left when positions are eliminated.
    pub fn n_kept(&self) -> usize {
        self.kept.len()
    }

    /// Factors both matrices.
    ///
    /// # Errors
    /// The unknown that nothing determines.
    pub fn factor(
        &mut self,
        jacobian: &[f64],
        gamma: f64,
        alpha: f64,
        beta: f64,
    ) -> Result<(), usize> {
        let (n, m) = (self.n, self.kept.len());
        let size = alpha * alpha + beta * beta;
        self.inverse = 1.0 / gamma;
        self.complex_inverse = (alpha / size, -beta / size);
        let (of_real, (of_re, of_im)) = (self.inverse, self.complex_inverse);
        let a = self.real.matrix_mut();
        let (re, im) = self.complex.matrix_mut();
        for (c, j) in self.kept.iter().enumerate() {
            for (r, i) in self.kept.iter().enumerate() {
                let entry = jacobian[i + n * j];
                let e = r + m * c;
                (a[e], re[e], im[e]) = (-entry, -entry, 0.0);
            }
        }
        for (e, p) in self.product.iter().enumerate() {
            a[e] -= of_real * p;
            re[e] -= of_re * p;
            im[e] = -of_im * p;
        }
        for i in 0..m {
            a[i + m * i] += gamma;
            re[i + m * i] += alpha;
            im[i + m * i] += beta;
        }
        let named = |place: usize| self.kept[place];
        self.real.factor(0.0).map_err(named)?;
        self.complex.factor().map_err(named)
    }

    /// `x ← (γ − J)⁻¹ x`
    pub fn solve(&mut self, x: &mut [f64]) {
        let m = self.kept.len();
        if self.eliminated.is_empty() {
            return self.real.solve(x);
        }
        let [right, _] = &mut self.right;
        // (1)
        for (r, &i) in right.iter_mut().zip(&self.kept) {
            *r = x[i];
        }
        for (column, &i) in self.beside.chunks_exact(m).zip(&self.eliminated) {
            x[i] *= self.inverse;
            add(right, column, x[i]);
        }
        self.real.solve(right);
        // (2)
        for &(s, place, value) in &self.links {
            x[self.eliminated[s]] += self.inverse * value * right[place];
        }
        for (r, &i) in right.iter().zip(&self.kept) {
            x[i] = *r;
        }
    }

    /// `re + i im ← (α + iβ − J)⁻¹ (re + i im)`
    pub fn solve_complex(&mut self, re: &mut [f64], im: &mut [f64]) {
        let m = self.kept.len();
        if self.eliminated.is_empty() {
            return self.complex.solve(re, im);
        }
        let [right_re, right_im] = &mut self.right;
        let (cr, ci) = self.complex_inverse;
        // (1)
        for (place, &i) in self.kept.iter().enumerate() {
            (right_re[place], right_im[place]) = (re[i], im[i]);
        }
        for (column, &i) in self.beside.chunks_exact(m).zip(&self.eliminated) {
            (re[i], im[i]) = (cr * re[i] - ci * im[i], cr * im[i] + ci * re[i]);
            let (x, y) = (re[i], im[i]);
            for ((r, s), j) in right_re.iter_mut().zip(right_im.iter_mut()).zip(column) {
                *r += j * x;
                *s += j * y;
            }
        }
        self.complex.solve(right_re, right_im);
        // (2)
        for &(s, place, value) in &self.links {
            let (x, y) = (value * right_re[place], value * right_im[place]);
            let i = self.eliminated[s];
            re[i] += cr * x - ci * y;
            im[i] += cr * y + ci * x;
        }
        for (place, &i) in self.kept.iter().enumerate() {
            (re[i], im[i]) = (right_re[place], right_im[place]);
        }
    }
}

/// `sum ← sum + factor · column`
fn add(sum: &mut [f64], column: &[f64], factor: f64) {
    for (s, c) in sum.iter_mut().zip(column) {
        *s += factor * c;
    }
}

/// Returns the unknowns that are eliminated first where systems begin with a Jacobian.
fn first_choice(jacobian: &[f64], n: usize) -> Vec<usize> {
    match n > DENSE_LIMIT {
        true => eliminable(jacobian, n, &mut (0..n)),
        false => Vec::new(),
    }
}

/// Returns the unknowns among some that can be eliminated first, ascending.
fn eliminable(jacobian: &[f64], n: usize, some: &mut dyn Iterator<Item = usize>) -> Vec<usize> {
    // in S already, or an entry of a row in S stands in the column
    let (mut chosen, mut read) = (vec![false; n], vec![false; n]);
    let mut count = 0;
    for i in some {
        let columns = || (0..n).filter(|j| jacobian[i + n * j] != 0.0);
        let is_short = columns().nth(MOST_ENTRIES).is_none();
        // one at least is kept
        let may = is_short && count + 1 < n;
        if may && !read[i] && columns().all(|j| j != i && !chosen[j]) {
            (chosen[i], count) = (true, count + 1);
            columns().for_each(|j| read[j] = true);
        }
    }
    (0..n).filter(|&i| chosen[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::between_ones;

    /// The Jacobian of q̇ = v, v̇ = K q + C v with some rows of q̇ reading two velocities, and with
    /// stiffnesses up to `stiffness`.
    fn second_order(half: usize, stiffness: f64, draw: &mut impl FnMut() -> f64) -> Vec<f64> {
        let n = 2 * half;
        let mut jacobian = vec![0.0; n * n];
        for i in 0..half {
            jacobian[i + n * (half + i)] = 1.0;
            if i % 3 == 0 {
                jacobian[i + n * (half + (i + 1) % half)] = draw();
            }
            for j in 0..half {
                jacobian[half + i + n * j] = stiffness * draw();
                jacobian[half + i + n * (half + j)] = draw();
            }
        }
        jacobian
    }

    /// Returns the largest entry of `b − (γ + iδ − J) (x + iy)`, real part, over the largest of
    /// its terms.
    fn residual(j: &[f64], (x, y): (&[f64], &[f64]), (g, d): (f64, f64), b: &[f64]) -> f64 {
        let n = b.len();
        let mut worst = 0.0_f64;
        for i in 0..n {
            let terms = (0..n).map(|k| j[i + n * k] * x[k]);
            let size = terms.clone().chain([g * x[i], d * y[i], b[i]]);
            let size = size.fold(0.0_f64, |m, t| m.max(t.abs()));
            let sum = b[i] - g * x[i] + d * y[i] + terms.sum::<f64>();
            worst = worst.max(sum.abs() / size);
        }
        worst
    }

    #[test]
    fn positions_are_eliminated_and_solutions_are_those_of_the_whole_system() {
        for (half, stiffness) in [(30, 1.0), (30, 1e8), (41, 1e-4)] {
            let mut draw = between_ones(half as u64);
            let n = 2 * half;
            let mut full = Full::new(n);
            for step in [1e-7, 1e-3, 1.0] {
                let jacobian = second_order(half, stiffness, &mut draw);
                full.see(&jacobian);
                let (gamma, alpha, beta) = (3.6 / step, 2.7 / step, 3.0 / step);
                full.factor(&jacobian, gamma, alpha, beta)
                    .expect("a regular matrix");
                assert_eq!(full.eliminated, (0..half).collect::<Vec<_>>());
                let most = 1e-11 + 1e-15 * stiffness * step * step;
                let b: Vec<f64> = (0..n).map(|_| draw()).collect();
                let none = vec![0.0; n];
                let mut x = b.clone();
                full.solve(&mut x);
                assert!(residual(&jacobian, (&x, &none), (gamma, 0.0), &b) < most);
                let (mut re, mut im) = (b.clone(), none.clone());
                full.solve_complex(&mut re, &mut im);
                let real = residual(&jacobian, (&re, &im), (alpha, beta), &b);
                let imaginary = residual(&jacobian, (&im, &re), (alpha, -beta), &none);
                assert!(real < most && imaginary < most, "{real} {imaginary}");
            }
        }
    }

    #[test]
    fn entries_that_appear_later_are_not_overlooked() {
        let (half, mut draw) = (20, between_ones(3));
        let n = 2 * half;
        let mut jacobian = second_order(half, 1.0, &mut draw);
        let mut full = Full::new(n);
        full.see(&jacobian);
        assert_eq!(full.eliminated.len(), half);
        // a position that changes with itself, one with another, and one with all velocities
        jacobian[2 + n * 2] = 0.5;
        jacobian[5 + n * 7] = -1.0;
        for j in 0..half {
            jacobian[9 + n * (half + j)] = draw();
        }
        full.see(&jacobian);
        assert!(full.eliminated.len() >= half - 4, "{:?}", full.eliminated);
        full.factor(&jacobian, 5.0, 4.0, 3.0)
            .expect("a regular matrix");
        let b: Vec<f64> = (0..n).map(|_| draw()).collect();
        let mut x = b.clone();
        full.solve(&mut x);
        assert!(residual(&jacobian, (&x, &vec![0.0; n]), (5.0, 0.0), &b) < 1e-12);
    }

    #[test]
    fn factors_that_are_taken_are_those_that_would_be_made() {
        let (half, mut draw) = (20, between_ones(7));
        let n = 2 * half;
        let bits = |full: &mut Full| {
            let (mut x, mut re, mut im) = (vec![1.0; n], vec![0.5; n], vec![-2.0; n]);
            full.solve(&mut x);
            full.solve_complex(&mut re, &mut im);
            let all = [x, re, im].concat();
            all.iter().map(|x| x.to_bits()).collect::<Vec<u64>>()
        };
        let mut jacobian = second_order(half, 1.0, &mut draw);
        let mut first = Full::new(n);
        first.see(&jacobian);
        first.factor(&jacobian, 5.0, 4.0, 3.0).expect("regular");
        let mut taken = Full::new(n);
        assert!(taken.take(&first, &jacobian));
        assert_eq!(bits(&mut taken), bits(&mut first));
        // an entry more: both go on alike, but systems that begin here choose otherwise
        jacobian[2 + n * 2] = 0.5;
        for full in [&mut first, &mut taken] {
            full.see(&jacobian);
            full.factor(&jacobian, 5.0, 4.0, 3.0).expect("regular");
        }
        assert_eq!(taken.eliminated, first.eliminated);
        assert_eq!(bits(&mut taken), bits(&mut first));
        jacobian[2 + n * 2] = 0.0;
        first.see(&jacobian);
        assert!(!Full::new(n).take(&first, &jacobian));
        // nothing was left
        assert!(!Full::new(n).take(&Full::new(n), &jacobian));
    }

    #[test]
    fn a_jacobian_without_entries_is_solved() {
        let mut full = Full::new(50);
        let jacobian = vec![0.0; 2500];
        full.see(&jacobian);
        full.factor(&jacobian, 2.0, 1.0, 1.0)
            .expect("a regular matrix");
        let mut x = vec![3.0; 50];
        full.solve(&mut x);
        assert_eq!(x, [1.5; 50]);
    }

    #[test]
    fn small_systems_are_solved_whole() {
        let jacobian = second_order(4, 1.0, &mut between_ones(1));
        let mut full = Full::new(8);
        full.see(&jacobian);
        assert!(full.eliminated.is_empty());
    }
}
