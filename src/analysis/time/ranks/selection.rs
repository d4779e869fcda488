//! The choice of rows, one after the other, by what each determines beyond those chosen before.
//!
//! ```text
//! few columns    row ← row − (row·u) u                u: the unit of the chosen row       (1)
//! many columns   row ← (I − v vᵀ) row, less column c   v turns the chosen row into c       (2)
//! ```
//!
//! By (1) what is left of a row reaches as far as all rows that it hangs together with: in a long
//! chain of loops to the end of the chain, and the time grows with the cube of the length. Under
//! (2) a column goes with each chosen row, and what is left of the others falls off quickly along
//! the chain: [`NEGLIGIBLE`] of it is dropped. The lengths are the same, but for that.

use super::PREFERENCE;
use crate::analysis::start::assemble::DEPENDENT;

/// Number of columns from which on reflections of sparse rows are faster.
const MANY_COLUMNS: usize = 150;
/// Number of columns up to which the least that rows determine is found row by row in place.
const FEW_COLUMNS: usize = 12;
/// Entry of a row, whose length is near one, that is dropped: far below [`DEPENDENT`].
const NEGLIGIBLE: f64 = 1e-14;

/// Rows of numbers, one behind the other.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    values: Vec<f64>,
    n_columns: usize,
}

impl Rows {
    pub fn zeros(n_rows: usize, n_columns: usize) -> Self {
        Self {
            values: vec![0.0; n_rows * n_columns],
            n_columns,
        }
    }

    pub fn n_columns(&self) -> usize {
        self.n_columns
    }

    pub fn row(&self, r: usize) -> &[f64] {
        &self.values[r * self.n_columns..][..self.n_columns]
    }

    pub fn row_mut(&mut self, r: usize) -> &mut [f64] {
        &mut self.values[r * self.n_columns..][..self.n_columns]
    }

    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        // rows without columns are none
        self.values.chunks_exact(self.n_columns.max(1))
    }

    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut [f64]> {
        self.values.chunks_exact_mut(self.n_columns.max(1))
    }
}

/// Returns the least that any of some rows determines beyond the others: zero where they are
/// dependent.
pub(super) fn margin(mut rows: Rows) -> f64 {
    let n = rows.iter().len();
    if rows.n_columns <= FEW_COLUMNS {
        return margin_of_few(&mut rows);
    }
    let (chosen, least) = select(rows, |_| false, n);
    if chosen.len() < n { 0.0 } else { least }
}

/// The same for few columns: chosen rows are put before the others, and zeros are not looked for.
fn margin_of_few(rows: &mut Rows) -> f64 {
    let n = rows.n_columns;
    let mut unit = [0.0; FEW_COLUMNS];
    let unit = &mut unit[..n];
    let mut open: &mut [f64] = &mut rows.values;
    let mut least = f64::INFINITY;
    while !open.is_empty() {
        // of rows as long as each other the last
        let (mut pivot, mut length) = (0, f64::NEG_INFINITY);
        for (k, row) in open.chunks_exact(n).enumerate() {
            let size = norm(row);
            if size.is_nan() {
                return 0.0;
            }
            if size >= length {
                (pivot, length) = (k, size);
            }
        }
        if length < DEPENDENT {
            return 0.0;
        }
        least = least.min(length);
        let chosen = open[pivot * n..][..n].iter();
        (unit.iter_mut().zip(chosen)).for_each(|(u, x)| *u = x / length);
        open.copy_within(..pivot * n, n);
        open = &mut open[n..];
        for row in open.chunks_exact_mut(n) {
            take_away_along(row, unit);
        }
    }
    least
}

/// Chooses rows, the preferred ones unless another determines three times as much; the chosen ones,
/// and the least that any of them determined. Unlike in `numeric::rank` a short row determines
/// little.
pub(super) fn select(
    rows: Rows,
    preferred: impl Fn(usize) -> bool,
    most: usize,
) -> (Vec<usize>, f64) {
    let sizes = rows.iter().map(norm).collect();
    if rows.n_columns < MANY_COLUMNS {
        let mut unit = Unit::with_capacity(rows.n_columns);
        let mut rows = rows;
        let take = |pivot: usize, open: &[usize], sizes: &mut [f64]| {
            take_away((&mut rows, &mut unit), pivot, open, sizes);
        };
        return choose(sizes, preferred, most, take);
    }
    let mut rows = Reflected::new(&rows);
    let take = |pivot: usize, _: &[usize], sizes: &mut [f64]| rows.take_away(pivot, sizes);
    choose(sizes, preferred, most, take)
}

/// Chooses rows by what is left of each; `take_away` takes a chosen row from the open ones, and
/// measures these again.
fn choose(
    mut sizes: Vec<f64>,
    preferred: impl Fn(usize) -> bool,
    most: usize,
    mut take_away: impl FnMut(usize, &[usize], &mut [f64]),
) -> (Vec<usize>, f64) {
    let mut chosen = Vec::with_capacity(most.min(sizes.len()));
    let mut least = f64::INFINITY;
    let mut open: Vec<usize> = (0..sizes.len()).collect();
    while chosen.len() < most {
        let larger = |a: &&usize, b: &&usize| sizes[**a].total_cmp(&sizes[**b]);
        let Some(&largest) = open.iter().max_by(larger) else {
            break;
        };
        let best = open.iter().filter(|r| preferred(**r)).max_by(larger);
        let pivot = match best {
            Some(&r) if sizes[r] > sizes[largest] / PREFERENCE => r,
            _ => largest,
        };
        let length = sizes[pivot];
        if length.is_nan() || length < DEPENDENT {
            break;
        }
        least = least.min(length);
        open.retain(|r| *r != pivot);
        take_away(pivot, &open, &mut sizes);
        chosen.push(pivot);
    }
    chosen.sort_unstable();
    (chosen, least)
}

/// The unit of a chosen row.
struct Unit {
    /// places and values of what is not zero
    entries: Vec<(usize, f64)>,
    /// all of it   (n_columns)
    all: Vec<f64>,
}

impl Unit {
    /// Makes a place for units of so many columns.
    fn with_capacity(n_columns: usize) -> Self {
        Self {
            entries: Vec::with_capacity(n_columns / 2),
            all: Vec::with_capacity(n_columns),
        }
    }
}

/// Takes what a chosen row determines from the open ones (1). `unit`: a place for its unit.
fn take_away(
    (rows, unit): (&mut Rows, &mut Unit),
    pivot: usize,
    open: &[usize],
    sizes: &mut [f64],
) {
    let length = sizes[pivot];
    let Unit { entries, all } = unit;
    // rows that have nothing where the chosen one has something stay as they are
    let chosen = rows.row(pivot).iter().map(|x| x / length);
    all.clear();
    all.extend(chosen);
    entries.clear();
    let is_dense = 2 * all.iter().filter(|x| **x != 0.0).count() > all.len();
    if !is_dense {
        entries.extend(all.iter().copied().enumerate().filter(|e| e.1 != 0.0));
    }
    for &r in open {
        let row = rows.row_mut(r);
        let changed = match is_dense {
            true => take_away_along(row, all),
            false => take_away_sparse(row, entries),
        };
        if changed {
            sizes[r] = norm(row);
        }
    }
}

/// Takes what lies along a unit away; twice, so that nothing is left of it but rounding. Returns
/// whether anything was.
fn take_away_along(row: &mut [f64], unit: &[f64]) -> bool {
    for pass in 0..2 {
        let along = row.iter().zip(unit).fold(0.0, |sum, (x, u)| sum + x * u);
        if along == 0.0 {
            return pass > 0;
        }
        row.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
    }
    true
}

/// The same for a unit with few entries: place and value of each.
fn take_away_sparse(row: &mut [f64], unit: &[(usize, f64)]) -> bool {
    for pass in 0..2 {
        let along = unit.iter().fold(0.0, |sum, &(k, x)| sum + row[k] * x);
        if along == 0.0 {
            return pass > 0;
        }
        unit.iter().for_each(|&(k, x)| row[k] -= along * x);
    }
    true
}

pub(super) fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Remainders of sparse rows, in columns that are turned with each row that is taken away.
struct Reflected {
    /// columns, ascending, and values, by row
    rows: Vec<Vec<(usize, f64)>>,
    /// rows that may have something in a column
    in_column: Vec<Vec<usize>>,
    /// rows that have not been taken away
    is_open: Vec<bool>,
    /// the row by which each row was met last
    met_by: Vec<usize>,
}

impl Reflected {
    fn new(rows: &Rows) -> Self {
        let n_columns = rows.n_columns;
        let sparse = |row: &[f64]| -> Vec<(usize, f64)> {
            let entries = row.iter().copied().enumerate();
            entries.filter(|e| e.1 != 0.0).collect()
        };
        let rows: Vec<Vec<(usize, f64)>> = rows.iter().map(sparse).collect();
        let mut in_column = vec![Vec::new(); n_columns];
        for (r, row) in rows.iter().enumerate() {
            row.iter().for_each(|e| in_column[e.0].push(r));
        }
        Self {
            is_open: vec![true; rows.len()],
            met_by: vec![usize::MAX; rows.len()],
            rows,
            in_column,
        }
    }

    /// Takes what a chosen row determines from the open ones (2), and measures these again.
    fn take_away(&mut self, pivot: usize, sizes: &mut [f64]) {
        self.is_open[pivot] = false;
        let mut v = std::mem::take(&mut self.rows[pivot]);
        // where the row lies most along a column, others change least
        let larger = |a: &&(usize, f64), b: &&(usize, f64)| a.1.abs().total_cmp(&b.1.abs());
        let Some(&(c, first)) = v.iter().max_by(larger) else {
            return;
        };
        let length = first.signum() * sizes[pivot];
        for (_, x) in v.iter_mut().filter(|e| e.0 == c) {
            *x += length;
        }
        let scale = (length * (length + first)).sqrt().recip();
        v.iter_mut().for_each(|e| e.1 *= scale);
        let mut touched = Vec::new();
        for &(column, _) in &v {
            for &r in &self.in_column[column] {
                if self.is_open[r] && self.met_by[r] != pivot {
                    self.met_by[r] = pivot;
                    touched.push(r);
                }
            }
        }
        for &r in &touched {
            self.reflect(r, &v, c);
            sizes[r] = self.rows[r].iter().map(|e| e.1 * e.1).sum::<f64>().sqrt();
        }
        for &(column, _) in &v {
            self.in_column[column].clone_from(&touched);
        }
    }

    /// Reflects a row, and drops its column `c` and what is negligible.
    fn reflect(&mut self, r: usize, v: &[(usize, f64)], c: usize) {
        let row = std::mem::take(&mut self.rows[r]);
        let mut at = 0;
        let mut along = 0.0;
        for &(column, x) in &row {
            at += v[at..].iter().take_while(|e| e.0 < column).count();
            along += v.get(at).filter(|e| e.0 == column).map_or(0.0, |e| x * e.1);
        }
        let mut left = Vec::with_capacity(row.len() + v.len());
        let (mut own, mut other) = (row.into_iter().peekable(), v.iter().peekable());
        loop {
            let (column, x) = match (own.peek(), other.peek()) {
                (Some(&(a, x)), Some(&&(b, y))) if a == b => {
                    own.next();
                    other.next();
                    (a, x - along * y)
                }
                (Some(&(a, x)), Some(&&(b, _))) if a < b => {
                    own.next();
                    (a, x)
                }
                (_, Some(&&(b, y))) => {
                    other.next();
                    (b, -along * y)
                }
                (Some(&(a, x)), None) => {
                    own.next();
                    (a, x)
                }
                (None, None) => break,
            };
            if column != c && x.abs() > NEGLIGIBLE {
                left.push((column, x));
            }
        }
        self.rows[r] = left;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a chain of loops: each reads three columns; a tenth follow from others.
    fn chain(n: usize) -> Rows {
        let row = |k: usize| {
            let mut row = vec![0.0; n + 2];
            for j in 0..3 {
                row[k + j] = (1.0 + 0.7 * (3 * k + j) as f64).sin();
            }
            row[k + 1] += 2.0;
            row
        };
        let rows: Vec<Vec<f64>> = (0..n).map(row).collect();
        let of_two = |k: usize| {
            let pairs = rows[k].iter().zip(&rows[k - 2]);
            pairs.map(|(a, b)| 0.7 * a - 0.5 * b).collect()
        };
        let sums: Vec<Vec<f64>> = (9..n).step_by(10).map(of_two).collect();
        let all: Vec<Vec<f64>> = rows.iter().cloned().chain(sums).collect();
        Rows {
            values: all.concat(),
            n_columns: n + 2,
        }
    }

    #[test]
    fn reflections_choose_the_rows_that_differences_choose() {
        for n in [20, 60, 200] {
            let rows = chain(n);
            let sizes: Vec<f64> = rows.iter().map(norm).collect();
            for preference in [1, 2, 3] {
                let preferred = |r: usize| r.is_multiple_of(preference);
                let (mut dense, mut unit) = (rows.clone(), Unit::with_capacity(rows.n_columns));
                let by_differences = choose(sizes.clone(), preferred, usize::MAX, |p, o, s| {
                    take_away((&mut dense, &mut unit), p, o, s);
                });
                let mut sparse = Reflected::new(&rows);
                let by_reflections = choose(sizes.clone(), preferred, usize::MAX, |p, _, s| {
                    sparse.take_away(p, s);
                });
                assert_eq!(by_differences.0.len(), n);
                assert_eq!(by_differences.0, by_reflections.0, "{n}");
                let (a, b) = (by_differences.1, by_reflections.1);
                assert!((a - b).abs() < 1e-11 * a, "{n}: {a} {b}");
            }
        }
    }

    #[test]
    fn the_margin_of_few_columns_is_that_of_the_choice() {
        for n in 0..=FEW_COLUMNS {
            for n_rows in 0..=n + 1 {
                let mut rows = Rows::zeros(n_rows, n);
                let numbers = (0..).map(|k: u32| f64::from(k * k).sin());
                // every other row with zeros, two alike
                let zeroed = numbers.map(|x| if x.abs() < 0.3 { 0.0 } else { x });
                (rows.values.iter_mut().zip(zeroed)).for_each(|(x, new)| *x = new);
                if n_rows > 2 && n > 0 {
                    let first = rows.row(0).to_vec();
                    rows.row_mut(2).copy_from_slice(&first);
                    rows.row_mut(2)[n - 1] *= 0.5;
                }
                let (chosen, least) = select(rows.clone(), |_| false, n_rows);
                let n_rows = rows.iter().len();
                let expected = if chosen.len() < n_rows { 0.0 } else { least };
                assert_eq!(margin(rows).to_bits(), expected.to_bits(), "{n} {n_rows}");
            }
        }
    }

    #[test]
    fn what_is_left_of_a_row_falls_off_along_a_chain() {
        let n = 400;
        let rows = chain(n);
        let mut left = Reflected::new(&rows);
        let sizes: Vec<f64> = rows.iter().map(norm).collect();
        let mut longest = 0;
        let take = |pivot: usize, _: &[usize], sizes: &mut [f64]| {
            left.take_away(pivot, sizes);
            longest = longest.max(left.rows.iter().map(Vec::len).max().unwrap_or(0));
        };
        let (chosen, _) = choose(sizes, |_| false, usize::MAX, take);
        assert_eq!(chosen.len(), n);
        assert!(longest < 50, "{longest}");
    }
}
