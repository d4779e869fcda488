//! Connected parts of a sparse matrix: rows that share columns, and the columns that they share;
//! and strong parts of a square one, whose unknowns depend on each other round and round.
//!
//! ```text
//! A = P diag(A₁ … A_k) Q       each block dense, all other entries zero
//! A = Pᵀ T P                   T zero above its strong parts, which have the eigenvalues of A
//! ```
//!
//! Work that grows with the cube of a matrix's size shrinks to the sum of the cubes of its blocks.
//!
//! Source: Tarjan, SIAM J. Comput. 1 (1972), for strong parts.

use super::pattern::Pattern;

/// A row of a sparse matrix: columns and values; a column may stand there twice, the values add.
pub type SparseRow = Vec<(usize, f64)>;

/// A connected part of a sparse matrix.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Block {
    /// its rows, ascending
    pub rows: Vec<usize>,
    /// its columns, ascending; none for a row without entries
    pub columns: Vec<usize>,
}

impl Block {
    /// Returns row `r` on the columns of the block.
    pub fn dense(&self, row: &[(usize, f64)]) -> Vec<f64> {
        let mut dense = vec![0.0; self.columns.len()];
        for &(column, x) in row {
            if let Ok(k) = self.columns.binary_search(&column) {
                dense[k] += x;
            }
        }
        dense
    }
}

/// Finds the connected parts of the matrix with `n` columns and the given rows, by their first
/// rows. A stored zero connects as any other value does; columns in no row are in no part.
pub fn connected(rows: &[SparseRow], n: usize) -> Vec<Block> {
    let mut parent: Vec<usize> = (0..n).collect();
    for row in rows {
        for pair in row.windows(2) {
            let (a, b) = (root(&mut parent, pair[0].0), root(&mut parent, pair[1].0));
            parent[a.max(b)] = a.min(b);
        }
    }
    let mut block_of: Vec<Option<usize>> = vec![None; n];
    let mut blocks: Vec<Block> = Vec::new();
    for (r, row) in rows.iter().enumerate() {
        let Some(&(column, _)) = row.first() else {
            blocks.push(Block {
                rows: vec![r],
                columns: Vec::new(),
            });
            continue;
        };
        let root = root(&mut parent, column);
        let k = *block_of[root].get_or_insert_with(|| {
            blocks.push(Block::default());
            blocks.len() - 1
        });
        blocks[k].rows.push(r);
    }
    for column in 0..n {
        let root = root(&mut parent, column);
        if let Some(k) = block_of[root] {
            blocks[k].columns.push(column);
        }
    }
    blocks
}

/// Finds the strong parts of a square matrix: unknowns, ascending, of which each depends on every
/// other, if only through others.
pub fn strong(pattern: &Pattern) -> Vec<Vec<usize>> {
    const NEW: usize = usize::MAX;
    let n = pattern.n_columns();
    // when each was met, and the first that is reached from it and belongs to no part yet
    let (mut met, mut first) = (vec![NEW; n], vec![NEW; n]);
    let (mut waiting, mut waits) = (Vec::new(), vec![false; n]);
    let (mut parts, mut count) = (Vec::new(), 0);
    for begin in 0..n {
        if met[begin] != NEW {
            continue;
        }
        // the way down, and the entries of each column on it that are still to be followed
        let mut way = vec![(begin, pattern.column(begin))];
        while let Some((j, entries)) = way.last_mut() {
            let j = *j;
            if met[j] == NEW {
                (met[j], first[j]) = (count, count);
                count += 1;
                waiting.push(j);
                waits[j] = true;
            }
            match entries.next() {
                Some((_, i)) if met[i] == NEW => way.push((i, pattern.column(i))),
                Some((_, i)) if waits[i] => first[j] = first[j].min(met[i]),
                Some(_) => {}
                None => {
                    way.pop();
                    if let Some((above, _)) = way.last() {
                        first[*above] = first[*above].min(first[j]);
                    }
                    if first[j] == met[j] {
                        let at = waiting.iter().rposition(|&k| k == j).unwrap_or(0);
                        let mut part = waiting.split_off(at);
                        part.iter().for_each(|&k| waits[k] = false);
                        part.sort_unstable();
                        parts.push(part);
                    }
                }
            }
        }
    }
    parts
}

/// Returns the representative of a set, and shortens the way there.
fn root(parent: &mut [usize], mut k: usize) -> usize {
    while parent[k] != k {
        parent[k] = parent[parent[k]];
        k = parent[k];
    }
    k
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_share_columns_are_one_part() {
        let rows = vec![
            vec![(4, 1.0)],
            vec![(0, 1.0), (2, 1.0)],
            vec![],
            vec![(2, 1.0), (5, 0.0)],
            vec![(4, 1.0), (4, 2.0)],
        ];
        let found = connected(&rows, 7);
        let of = |rows: &[usize], columns: &[usize]| Block {
            rows: rows.to_vec(),
            columns: columns.to_vec(),
        };
        assert_eq!(
            found,
            [of(&[0, 4], &[4]), of(&[1, 3], &[0, 2, 5]), of(&[2], &[])]
        );
        assert_eq!(found[0].dense(&rows[4]), [3.0]);
        assert_eq!(found[1].dense(&rows[3]), [0.0, 1.0, 0.0]);
    }

    #[test]
    fn unknowns_in_a_ring_are_one_strong_part() {
        // 0 → 1 → 2 → 0, which drives 3; 4 and 5 drive each other, and 6 itself
        let columns = vec![
            vec![1],
            vec![2],
            vec![0, 3],
            vec![],
            vec![5],
            vec![4],
            vec![6],
        ];
        let mut found = strong(&Pattern::of_columns(7, columns));
        found.sort();
        assert_eq!(found, [vec![0, 1, 2], vec![3], vec![4, 5], vec![6]]);
    }

    #[test]
    fn a_long_chain_is_one_part() {
        let rows: Vec<SparseRow> = (0..10_000)
            .rev()
            .map(|k| vec![(k, 1.0), (k + 1, 1.0)])
            .collect();
        let found = connected(&rows, 10_001);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].columns.len(), 10_001);
        let ring = (0..10_000).map(|k| vec![(k + 1) % 10_000]).collect();
        assert_eq!(strong(&Pattern::of_columns(10_000, ring)).len(), 1);
    }
}
