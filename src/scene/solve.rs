//! From mass matrix, rows and loads to accelerations and multipliers.
//!
//! ```text
//! M v̇ = f + Gᵀ λ        M = Lᵀ D L, without fill on a forest (eliminating from the leaves)
//! G v̇ = γ               S λ = γ − G M⁻¹ f,   S = G M⁻¹ Gᵀ = Σ u uᵀ / D,   u = L⁻ᵀ Gᵀ
//! ```
//!
//! Written for known zeros: a term that is known to be zero is not computed. A pivot of S that has
//! lost twelve digits counts as zero and its multiplier too, so that rows which become dependent in
//! passing do no harm.
//!
//! Source: Featherstone, chapters 6.5 and 8.

use super::articulated::ArticulatedFactor;
use super::configuration::Elimination;
use crate::scalar::Scalar;
use std::collections::{BTreeMap, BTreeSet};

/// `M = Lᵀ D L` of a forest.
pub struct MassFactor<S> {
    /// per freedom: (carrying freedom, L)
    pub l: Vec<Vec<(usize, S)>>,
    /// 1/D per freedom
    pub inverse_d: Vec<S>,
}

/// A factored mass matrix, one way or the other.
pub enum Factor<'s, S> {
    /// from its entries
    Matrix(MassFactor<S>),
    /// without forming it
    Articulated(ArticulatedFactor<'s, S>),
}

impl<S: Scalar> Factor<'_, S> {
    /// `x ← L⁻ᵀ x`
    pub fn half(&self, x: &mut [S]) {
        match self {
            Factor::Matrix(m) => m.half(x),
            Factor::Articulated(m) => m.half(x),
        }
    }
    /// `x ← L⁻¹ D⁻¹ x`
    pub fn finish(&self, x: &mut [S]) {
        match self {
            Factor::Matrix(m) => m.finish(x),
            Factor::Articulated(m) => m.finish(x),
        }
    }
    /// `L⁻ᵀ g` of a sparse row of G, by ascending places. Only freedoms that carry those of the row
    /// are visited.
    pub fn half_row(&self, row: &[(usize, S)]) -> Vec<(usize, S)> {
        match self {
            Factor::Matrix(m) => m.half_sparse(summed(row)),
            Factor::Articulated(m) => m.half_sparse(summed(row)),
        }
    }
    /// The same for sums of squares, but for what is far below rounding in a deep forest.
    pub(super) fn half_row_near(&self, row: &[(usize, S)], depth: usize) -> Vec<(usize, S)> {
        match self {
            Factor::Articulated(m) if depth > DEEP => m.half_near(summed(row)),
            _ => self.half_row(row),
        }
    }
    /// 1/D
    pub fn inverse_d(&self) -> Vec<S> {
        match self {
            Factor::Matrix(m) => m.inverse_d.clone(),
            Factor::Articulated(m) => m.inverse(),
        }
    }
}

/// Depth of a forest from which on links far from those of a row are left out of its square.
const DEEP: usize = 64;

/// Returns what stands in a row for each place.
fn summed<S: Scalar>(row: &[(usize, S)]) -> BTreeMap<usize, S> {
    let mut x: BTreeMap<usize, S> = BTreeMap::new();
    for &(k, value) in row {
        *x.entry(k).or_insert_with(S::zero) += value;
    }
    x
}

/// Pivots of S smaller than this times the diagonal they started from count as zero.
pub const RANK_TOLERANCE: f64 = 1e-12;

impl<S: Scalar> MassFactor<S> {
    /// Factors the mass matrix given by rows of (carrying freedom, entry), own entry first, nearest
    /// carrier next.
    pub fn new(mut rows: Vec<Vec<(usize, S)>>) -> Self {
        let n = rows.len();
        let mut inverse_d = vec![S::zero(); n];
        for k in (0..n).rev() {
            let row = std::mem::take(&mut rows[k]);
            let d = row[0].1;
            inverse_d[k] = S::one() / d;
            let mut scaled = Vec::with_capacity(row.len() - 1);
            for (at, &(i, m_ki)) in row.iter().enumerate().skip(1) {
                if m_ki.is_known_zero() {
                    continue;
                }
                let a = m_ki * inverse_d[k];
                with_carriers(&mut rows[i], &row[at..], |entry, m_kj| *entry -= a * m_kj);
                scaled.push((i, a));
            }
            rows[k] = scaled;
        }
        Self { l: rows, inverse_d }
    }

    /// `x ← L⁻ᵀ x`
    pub fn half(&self, x: &mut [S]) {
        for i in (0..x.len()).rev() {
            if x[i].is_known_zero() {
                continue;
            }
            for &(j, l) in &self.l[i] {
                let t = l * x[i];
                x[j] -= t;
            }
        }
    }

    /// Returns `L⁻ᵀ x` where it is not known to be zero, by ascending places.
    fn half_sparse(&self, mut x: BTreeMap<usize, S>) -> Vec<(usize, S)> {
        let mut half = Vec::with_capacity(x.len());
        while let Some((i, x_i)) = x.pop_last() {
            if x_i.is_known_zero() {
                continue;
            }
            for &(j, l) in &self.l[i] {
                let t = l * x_i;
                *x.entry(j).or_insert_with(S::zero) -= t;
            }
            half.push((i, x_i));
        }
        half.reverse();
        half
    }

    /// `x ← L⁻¹ D⁻¹ x`
    pub fn finish(&self, x: &mut [S]) {
        for i in 0..x.len() {
            let mut s = x[i] * self.inverse_d[i];
            for &(j, l) in &self.l[i] {
                s -= l * x[j];
            }
            x[i] = s;
        }
    }
}

/// Visits the entries of a carrier's row with those of a row that it carries, from the carrier on:
/// both name the carrier's own carriers, nearest first.
fn with_carriers<S: Copy>(
    row: &mut [(usize, S)],
    carried: &[(usize, S)],
    mut visit: impl FnMut(&mut S, S),
) {
    for (at, &(j, m)) in carried.iter().enumerate() {
        let here = row.get(at).is_some_and(|e| e.0 == j);
        let place = if here {
            Some(at)
        } else {
            row.iter().position(|e| e.0 == j)
        };
        if let Some(place) = place {
            visit(&mut row[place].1, m);
        }
    }
}

/// Solves for accelerations and multipliers: `M v̇ = f + Gᵀ λ` with `G v̇ = γ`.
///
/// `g[r]` is the sparse row r of G, `gamma[r]` its right side; `f` holds the loads and receives v̇.
/// Returns λ and how well the rows determine it, measured against the usual pivots of `way`.
///
/// Where freedoms have no inertia although rows determine their motion (a coupler without mass),
/// the factored matrix has the lent inertia of `way` on its diagonal beyond M. It is taken back by
/// iteration, E = diag(lent inertia):
///
/// ```text
/// (M + E) v̇ₖ₊₁ = f + E v̇ₖ + Gᵀ λₖ₊₁        G v̇ₖ₊₁ = γ
/// ```
///
/// whose error shrinks by |E|/|M| over the directions that the rows leave free, each time by the
/// factor [`LENT_INERTIA`] or less.
pub fn accelerations<S: Scalar>(
    m: &Factor<'_, S>,
    g: &[Vec<(usize, S)>],
    gamma: &[S],
    f: &mut [S],
    way: &Elimination,
) -> Solution<S> {
    let loads = f.to_vec();
    let mut solution = accelerations_once(m, g, gamma, f, &way.usual_pivots);
    if way.lent_inertia.iter().any(|&lent| lent > 0.0) {
        for _ in 0..INERTIA_ITERATIONS {
            let next = loads.iter().zip(&way.lent_inertia).zip(f.iter());
            let mut next: Vec<S> = next.map(|((&l, &lent), &v)| l + v.scale(lent)).collect();
            solution = accelerations_once(m, g, gamma, &mut next, &way.usual_pivots);
            f.copy_from_slice(&next);
        }
    }
    solution
}

/// Inertia lent to a freedom that has none, over the least inertia of the others.
pub const LENT_INERTIA: f64 = 1e-4;

/// Iterations that take lent inertia back: after these only [`LENT_INERTIA`]⁴, which is rounding,
/// is left.
const INERTIA_ITERATIONS: usize = 3;

/// Part of the inertia of all that a freedom moves above which what remains of it, after what it
/// carries has been eliminated, is no rounding.
const CLEAR_PIVOT: f64 = 1e-9;

/// Returns whether each freedom clearly has an inertia of its own: `rows` is the mass matrix as for
/// [`MassFactor::new`], `inverse_d` the inverses of its pivots, however they were found   (n_v).
pub fn have_inertia(rows: &[Vec<(usize, f64)>], inverse_d: &[f64]) -> bool {
    let largest = rows.iter().fold(0.0, |m: f64, row| m.max(row[0].1));
    let clear = |(row, &r): (&Vec<(usize, f64)>, &f64)| {
        r > 0.0 && 1.0 / r > CLEAR_PIVOT * row[0].1.max(CLEAR_PIVOT * largest)
    };
    rows.iter().zip(inverse_d).all(clear)
}

/// Returns the inertia to lend to each freedom that has none; nothing where all have some   (n_v or
/// 0).
///
/// `rows` is the mass matrix as for [`MassFactor::new`]; `length` makes turns and slides
/// comparable.
pub fn lent_inertia(mut rows: Vec<Vec<(usize, f64)>>, turns: &[bool], length: f64) -> Vec<f64> {
    let n = rows.len();
    let unit = |k: usize| if turns[k] { length * length } else { 1.0 };
    let own: Vec<f64> = (0..n).map(|k| rows[k][0].1 / unit(k)).collect();
    let largest = own.iter().copied().fold(0.0, f64::max);
    let mut pivots = vec![0.0; n];
    for k in (0..n).rev() {
        let row = std::mem::take(&mut rows[k]);
        // what remains of an entry when all of it is taken away is its rounding
        let nothing = 1e-13 * own[k] + f64::EPSILON * f64::EPSILON * largest;
        if row[0].1 / unit(k) <= nothing {
            continue;
        }
        pivots[k] = row[0].1 / unit(k);
        for (at, &(i, m_ki)) in row.iter().enumerate().skip(1) {
            with_carriers(&mut rows[i], &row[at..], |entry, m_kj| {
                *entry -= m_ki * m_kj / row[0].1;
            });
        }
    }
    if pivots.iter().all(|&d| d > 0.0) {
        return Vec::new();
    }
    let some = pivots.iter().copied().filter(|&d| d > 0.0);
    let least = some.fold(f64::INFINITY, f64::min);
    let lent = |k: usize| match pivots[k] > 0.0 || least.is_infinite() {
        true => 0.0,
        false => LENT_INERTIA * least * unit(k),
    };
    (0..n).map(lent).collect()
}

fn accelerations_once<S: Scalar>(
    m: &Factor<'_, S>,
    g: &[Vec<(usize, S)>],
    gamma: &[S],
    f: &mut [S],
    usual: &[f64],
) -> Solution<S> {
    let inverse_d = m.inverse_d();
    m.half(f);
    let u: Vec<Vec<(usize, S)>> = g.iter().map(|row| m.half_row(row)).collect();
    let s = gram(&u, &inverse_d);
    let rhs: Vec<S> = u
        .iter()
        .zip(gamma)
        .map(|(row, &gamma)| {
            row.iter()
                .fold(gamma, |s, &(k, x)| s - x * inverse_d[k] * f[k])
        })
        .collect();
    let lambda = SymmetricFactor::new(s, usual).solution(rhs);
    for (row, &l) in u.iter().zip(&lambda.x) {
        for &(k, x) in row {
            f[k] += x * l;
        }
    }
    m.finish(f);
    lambda
}

/// Lower triangle of a symmetric matrix by rows: places that are not known to be zero, ascending,
/// the diagonal last.
pub type LowerRows<S> = Vec<Vec<(usize, S)>>;

/// `U D⁻¹ Uᵀ`
pub fn gram<S: Scalar>(u: &[Vec<(usize, S)>], inverse_d: &[S]) -> LowerRows<S> {
    let scaled: Vec<Vec<(usize, S)>> = u
        .iter()
        .map(|row| row.iter().map(|&(k, x)| (k, x * inverse_d[k])).collect())
        .collect();
    let places = |r: usize| u[r].iter().map(|e| e.0);
    products(u.len(), places, |r, c| sparse_dot(&u[r], &scaled[c]))
}

/// Returns the products of `n` sparse rows with each other. Rows that share no place are not
/// visited: their product is zero.
pub fn products<S: Scalar, P: Iterator<Item = usize>>(
    n: usize,
    places: impl Fn(usize) -> P,
    product: impl Fn(usize, usize) -> S,
) -> LowerRows<S> {
    let mut rows_at: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut seen = vec![usize::MAX; n];
    let mut lower = Vec::with_capacity(n);
    for r in 0..n {
        let mut near = Vec::new();
        for place in places(r) {
            let there = rows_at.entry(place).or_default();
            for &c in there.iter() {
                if seen[c] != r {
                    seen[c] = r;
                    near.push(c);
                }
            }
            if there.last() != Some(&r) {
                there.push(r);
            }
        }
        // the row itself may be among them, where a place stands in it twice
        near.retain(|&c| c != r);
        near.sort_unstable();
        let before = near.into_iter().map(|c| (c, product(r, c)));
        let mut row: Vec<(usize, S)> = before.filter(|e| !e.1.is_known_zero()).collect();
        row.push((r, product(r, r)));
        lower.push(row);
    }
    lower
}

/// The diagonal of `U D⁻¹ Uᵀ`
pub fn gram_diagonal<S: Scalar>(u: &[Vec<(usize, S)>], inverse_d: &[S]) -> Vec<S> {
    let square = |sum: S, &(k, x): &(usize, S)| sum + x * (x * inverse_d[k]);
    u.iter()
        .map(|row| row.iter().fold(S::zero(), square))
        .collect()
}

/// Product of two rows given by ascending indices.
fn sparse_dot<S: Scalar>(a: &[(usize, S)], b: &[(usize, S)]) -> S {
    let (mut i, mut j, mut sum) = (0, 0, S::zero());
    while i < a.len() && j < b.len() {
        match a[i].0.cmp(&b[j].0) {
            std::cmp::Ordering::Less => i += 1,
            std::cmp::Ordering::Greater => j += 1,
            std::cmp::Ordering::Equal => {
                sum += a[i].1 * b[j].1;
                i += 1;
                j += 1;
            }
        }
    }
    sum
}

/// A solution, and how weak the weakest pivot was: errors are magnified by as much as it has lost.
pub struct Solution<S> {
    /// x
    pub x: Vec<S>,
    /// least pivot as a part of what it usually is; 1: none is smaller   (the square of the
    /// distance from dependence)
    pub strength: S,
}

/// Pivots smaller than this times their usual size count as nearly singular.
pub const NEAR_SINGULAR_PIVOT: f64 = 0.03;

/// `A = L D Lᵀ` of a symmetric positive semidefinite matrix, in the given order. Only places that
/// are not known to be zero are visited and kept.
pub struct SymmetricFactor<S: Scalar> {
    /// L before the diagonal, by rows
    l: Vec<Vec<(usize, S)>>,
    /// the same by columns
    l_transposed: Vec<Vec<(usize, S)>>,
    /// 1/D; 0 where a row depends on earlier ones
    inverse: Vec<S>,
    /// rows that depend on earlier ones
    dependent: Vec<S::Mask>,
    /// as that of [`Solution`]
    strength: S,
}

impl<S: Scalar> SymmetricFactor<S> {
    /// Factors A. `reference`: what each pivot is compared with; empty: its own diagonal.
    pub fn new(a: LowerRows<S>, reference: &[f64]) -> Self {
        let n = a.len();
        let mut factor = Self {
            l: Vec::with_capacity(n),
            l_transposed: vec![Vec::new(); n],
            inverse: Vec::with_capacity(n),
            dependent: Vec::with_capacity(n),
            strength: S::one(),
        };
        // L_ik D_k of the row i at hand; zero elsewhere
        let mut work = vec![S::zero(); n];
        for (i, row) in a.into_iter().enumerate() {
            let mut start = S::zero();
            let mut open = BTreeSet::new();
            for (k, x) in row {
                if k == i {
                    start = x;
                } else if !x.is_known_zero() {
                    work[k] = x;
                    open.insert(k);
                }
            }
            let filled = factor.eliminate(&mut work, open);
            let mut d = start;
            let mut l_row = Vec::with_capacity(filled.len());
            for k in filled {
                let l = work[k] * factor.inverse[k];
                d -= l * work[k];
                work[k] = S::zero();
                if !l.is_known_zero() {
                    l_row.push((k, l));
                    factor.l_transposed[k].push((i, l));
                }
            }
            factor.l.push(l_row);
            factor.finish_row(start, d, reference.get(i).copied());
        }
        factor
    }

    /// Turns the row in `work`, not zero at `open`, into `L_ik D_k`; returns the places k where it
    /// is not zero.
    fn eliminate(&self, work: &mut [S], mut open: BTreeSet<usize>) -> Vec<usize> {
        let mut filled = Vec::with_capacity(open.len());
        while let Some(k) = open.pop_first() {
            let mut s = work[k];
            for &(j, l) in &self.l[k] {
                if !work[j].is_known_zero() {
                    s -= work[j] * l;
                }
            }
            work[k] = s;
            if !s.is_known_zero() {
                open.extend(self.l_transposed[k].iter().map(|e| e.0));
                filled.push(k);
            }
        }
        filled
    }

    /// Takes the pivot `d` of a row whose diagonal was `start`.
    fn finish_row(&mut self, start: S, d: S, usual: Option<f64>) {
        let tiny = d.le(start.scale(RANK_TOLERANCE));
        let part = match usual {
            Some(usual) => d.scale(1.0 / usual),
            None => d / start,
        };
        self.strength = S::select(part.lt(self.strength), part, self.strength);
        self.inverse.push(S::choose(tiny, S::zero, || S::one() / d));
        self.dependent.push(tiny);
    }

    /// Solves `A x = b`; what depends on earlier rows gets the value zero.
    pub fn solve(&self, mut b: Vec<S>) -> Vec<S> {
        for (i, row) in self.l.iter().enumerate() {
            for &(k, l) in row {
                b[i] = b[i] - l * b[k];
            }
        }
        for i in (0..b.len()).rev() {
            let mut x = b[i] * self.inverse[i];
            for &(k, l) in &self.l_transposed[i] {
                x -= l * b[k];
            }
            b[i] = S::choose(self.dependent[i], S::zero, || x);
        }
        b
    }

    /// Solves `A x = b`, and tells how weak the pivots were.
    pub fn solution(self, b: Vec<S>) -> Solution<S> {
        Solution {
            x: self.solve(b),
            strength: self.strength,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dependent_rows_get_zero_and_the_rest_is_solved() {
        // rows 0 and 1 are the same equation
        let a = vec![
            vec![(0, 2.0)],
            vec![(0, 2.0), (1, 2.0)],
            vec![(0, 0.5), (1, 0.5), (2, 3.0)],
        ];
        let x = SymmetricFactor::new(a, &[]).solve(vec![1.0, 1.0, 2.0]);
        assert_eq!(x[1], 0.0);
        approx::assert_relative_eq!(2.0 * x[0] + 0.5 * x[2], 1.0, max_relative = 1e-14);
        approx::assert_relative_eq!(0.5 * x[0] + 3.0 * x[2], 2.0, max_relative = 1e-14);
    }

    #[test]
    fn a_forest_factors_without_fill() {
        // freedom 0 carries 1 and 2
        let rows = vec![
            vec![(0, 5.0)],
            vec![(1, 2.0), (0, 1.0)],
            vec![(2, 3.0), (0, -1.0)],
        ];
        let m = Factor::Matrix(MassFactor::new(rows));
        let mut x = vec![1.0, 2.0, 3.0];
        accelerations(&m, &[], &[], &mut x, &Elimination::default());
        approx::assert_relative_eq!(5.0 * x[0] + x[1] - x[2], 1.0, max_relative = 1e-14);
        approx::assert_relative_eq!(x[0] + 2.0 * x[1], 2.0, max_relative = 1e-14);
        approx::assert_relative_eq!(-x[0] + 3.0 * x[2], 3.0, max_relative = 1e-14);
    }
}
