//! The pattern of a Jacobian, and the columns of it that can be differentiated together:
//! [`Pattern`].
//!
//! ```text
//! columns that share no row form a group: one derivative along their sum yields all their entries
//! ```
//!
//! Groups are made greedily, columns with many entries first. A band of width b takes b groups,
//! however long it is; a full row as many as it has entries.
//!
//! Source: Curtis, Powell & Reid, J. Inst. Math. Appl. 13 (1974).

use crate::arrange::Arrange;

/// The places of the entries of a matrix, by columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pattern {
    /// beginning of each column among the entries   (columns + 1)
    start: Vec<usize>,
    /// row of each entry, ascending within a column   (entries)
    row: Vec<usize>,
    /// groups of columns that share no row
    groups: Vec<Vec<usize>>,
}

impl Pattern {
    /// Builds the pattern of a matrix whose row `i` has entries in the columns `rows[i]`.
    pub fn of_rows(n_columns: usize, rows: &[Vec<u32>]) -> Self {
        let mut columns = vec![Vec::new(); n_columns];
        for (i, row) in rows.iter().enumerate() {
            for &j in row {
                columns[j as usize].push(i);
            }
        }
        Self::of_columns(rows.len(), columns)
    }

    /// Builds the pattern of a matrix of `n_rows` rows whose column `j` has entries in the rows
    /// `columns[j]`.
    pub fn of_columns(n_rows: usize, mut columns: Vec<Vec<usize>>) -> Self {
        let mut by_row = vec![Vec::new(); n_rows];
        for (j, column) in columns.iter_mut().enumerate() {
            column.sort_unstable();
            column.dedup();
            for &i in column.iter() {
                by_row[i].push(j);
            }
        }
        let mut order: Vec<usize> = (0..columns.len()).collect();
        order.arrange_by_key(|&j| std::cmp::Reverse(columns[j].len()));
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let mut group_of = vec![usize::MAX; columns.len()];
        // for each group, the last column that found it taken
        let mut taken: Vec<usize> = Vec::new();
        for j in order {
            // once all are taken, as by a full row, nothing further can be
            let mut n_free = taken.len();
            let mut others = columns[j].iter().flat_map(|&i| &by_row[i]);
            while n_free > 0
                && let Some(&other) = others.next()
            {
                if let Some(taken) = taken.get_mut(group_of[other]).filter(|t| **t != j) {
                    *taken = j;
                    n_free -= 1;
                }
            }
            let free = taken.iter().position(|&t| t != j).unwrap_or(taken.len());
            if free == taken.len() {
                taken.push(usize::MAX);
                groups.push(Vec::new());
            }
            groups[free].push(j);
            group_of[j] = free;
        }
        let mut start = vec![0];
        let mut row = Vec::new();
        for column in columns {
            row.extend(column);
            start.push(row.len());
        }
        Self { start, row, groups }
    }

    /// Returns the number of columns.
    pub fn n_columns(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// Returns the number of entries.
    pub fn n_entries(&self) -> usize {
        self.row.len()
    }

    /// Returns the groups of columns that share no row; together they are all columns.
    pub fn groups(&self) -> &[Vec<usize>] {
        &self.groups
    }

    /// Iterates over the entries of a column: index among all entries, and row.
    pub fn column(&self, j: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        (self.start[j]..self.start[j + 1]).map(|e| (e, self.row[e]))
    }

    /// Iterates over row and column of every entry, in order.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..self.n_columns()).flat_map(|j| self.column(j).map(move |(_, i)| (i, j)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_band_takes_as_many_groups_as_it_is_wide() {
        let rows: Vec<Vec<u32>> = (0..100u32)
            .map(|i| (i.saturating_sub(2)..(i + 3).min(100)).collect())
            .collect();
        let pattern = Pattern::of_rows(100, &rows);
        assert_eq!(pattern.groups().len(), 5);
        assert_eq!(pattern.n_entries(), 494);
    }

    proptest! {
        /// Every column is in one group, and columns of a group share no row.
        #[test]
        fn columns_found_together_share_no_row(
            places in proptest::collection::vec((0usize..20, 0u32..30), 0..200),
        ) {
            let mut rows = vec![Vec::new(); 20];
            for (i, j) in &places {
                rows[*i].push(*j);
            }
            let pattern = Pattern::of_rows(30, &rows);
            let mut seen = [0; 30];
            for group in pattern.groups() {
                let mut rows = [0; 20];
                for &j in group {
                    seen[j] += 1;
                    pattern.column(j).for_each(|(_, i)| rows[i] += 1);
                }
                prop_assert!(rows.iter().all(|&k| k <= 1));
            }
            prop_assert!(seen.iter().all(|&k| k == 1));
            for (i, j) in places {
                prop_assert!(pattern.entries().any(|e| e == (i, j as usize)));
            }
        }
    }
}
