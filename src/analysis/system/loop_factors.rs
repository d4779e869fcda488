//! Factors of ∂ρ/∂z, the derivatives of algebraic loops along their unknowns: loops that share no
//! unknown are factored and solved apart, however many there are.

use crate::numeric::connected::{Block, SparseRow, connected};
use crate::numeric::dense::Lu;
use crate::numeric::pattern::Pattern;

/// A pivot below this times the largest entry of its column counts as zero.
const SMALLEST_PIVOT: f64 = 1e-14;

/// The matrix of a set of loops, and its factors.
#[derive(Clone, Debug)]
pub(super) struct LoopFactors {
    /// entries, in the order of their pattern
    pub(super) entries: Vec<f64>,
    parts: Vec<Part>,
}

/// Loops that share unknowns with each other and with no other.
#[derive(Clone, Debug)]
struct Part {
    /// rows and columns, as many of each
    block: Block,
    /// entries of the pattern: index, row and column within the block
    entries: Vec<(usize, usize, usize)>,
    lu: Lu,
    /// scratch of a solution
    x: Vec<f64>,
}

impl LoopFactors {
    /// Makes room for the matrix whose row `i` has entries in the columns `rows[i]`; `pattern` is
    /// that of these rows.
    pub(super) fn new(rows: &[Vec<u32>], pattern: &Pattern) -> Self {
        let n = rows.len();
        let sparse = |row: &Vec<u32>| row.iter().map(|&k| (k as usize, 1.0)).collect();
        let sparse: Vec<SparseRow> = rows.iter().map(sparse).collect();
        let mut blocks = connected(&sparse, n);
        // a part with more equations than unknowns is singular, as the whole is
        if blocks.iter().any(|b| b.rows.len() != b.columns.len()) {
            let all: Vec<usize> = (0..n).collect();
            blocks = vec![Block {
                rows: all.clone(),
                columns: all,
            }];
        }
        let parts = blocks.into_iter().map(|block| Part::new(block, pattern));
        Self {
            parts: parts.collect(),
            entries: vec![0.0; pattern.n_entries()],
        }
    }

    /// Iterates over the parts: their rows and their columns.
    pub(super) fn parts(&self) -> impl Iterator<Item = &Block> {
        self.parts.iter().map(|part| &part.block)
    }

    /// Factors the matrix as its entries stand.
    ///
    /// # Errors
    /// The column without a pivot.
    pub(super) fn factor(&mut self) -> Result<(), usize> {
        for part in &mut self.parts {
            let n = part.block.columns.len();
            let matrix = part.lu.matrix_mut();
            matrix.fill(0.0);
            for &(entry, i, k) in &part.entries {
                matrix[i + n * k] = self.entries[entry];
            }
            (part.lu.factor(SMALLEST_PIVOT)).map_err(|k| part.block.columns[k])?;
        }
        Ok(())
    }

    /// Solves `∂ρ/∂z z = x` in place.
    pub(super) fn solve(&mut self, x: &mut [f64]) {
        for part in &mut self.parts {
            for (own, &i) in part.x.iter_mut().zip(&part.block.rows) {
                *own = x[i];
            }
            part.lu.solve(&mut part.x);
        }
        for part in &self.parts {
            for (own, &k) in part.x.iter().zip(&part.block.columns) {
                x[k] = *own;
            }
        }
    }
}

impl Part {
    fn new(block: Block, pattern: &Pattern) -> Self {
        let n = block.columns.len();
        let mut entries = Vec::new();
        for (k, &column) in block.columns.iter().enumerate() {
            let own = pattern.column(column);
            entries.extend(own.filter_map(|(entry, row)| {
                let i = block.rows.binary_search(&row).ok()?;
                Some((entry, i, k))
            }));
        }
        Self {
            block,
            entries,
            lu: Lu::new(n),
            x: vec![0.0; n],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_apart_are_solved_apart_and_together_alike() {
        // rows 0 and 2 share unknowns 1 and 2; row 1 has unknown 0 alone
        let rows = [vec![1, 2], vec![0], vec![1, 2]];
        let pattern = Pattern::of_rows(3, &rows);
        let mut factors = LoopFactors::new(&rows, &pattern);
        assert_eq!(factors.parts().count(), 2);
        let matrix = [[0.0, 2.0, 1.0], [4.0, 0.0, 0.0], [0.0, 1.0, 3.0]];
        for (entry, (i, k)) in factors.entries.iter_mut().zip(pattern.entries()) {
            *entry = matrix[i][k];
        }
        assert_eq!(factors.factor(), Ok(()));
        let mut x = [4.0, 8.0, 7.0];
        factors.solve(&mut x);
        assert_eq!(x, [2.0, 1.0, 2.0]);
    }

    #[test]
    fn an_unknown_that_nothing_determines_is_named() {
        let rows = [vec![0], vec![0]];
        let mut factors = LoopFactors::new(&rows, &Pattern::of_rows(2, &rows));
        factors.entries.fill(1.0);
        assert_eq!(factors.factor(), Err(1));
    }
}
