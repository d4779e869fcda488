//! The order of elimination of a sparse matrix, found with its values: [`Markowitz`].
//!
//! ```text
//! of the columns and rows with fewest entries left, take the entry a(i,j) of least (rᵢ−1)(cⱼ−1)
//! that is at least a tenth of the largest in its column
//! ```
//!
//! Source: Duff, Erisman & Reid, Direct Methods for Sparse Matrices, 7.2 and 10.

use super::{Order, SINGULAR_COLUMN, reciprocal, size, times};
use crate::arrange::Arrange;
use std::collections::BTreeSet;

/// Part of the largest entry of its column that a pivot must have.
const PIVOT_THRESHOLD: f64 = 0.1;
/// Candidate columns, and candidate rows, examined per pivot.
const CANDIDATES: usize = 4;

/// An elimination in progress.
pub(super) struct Markowitz<const P: usize> {
    n: usize,
    /// entries left in each column: row and value
    columns: Vec<Vec<(u32, [f64; P])>>,
    /// columns left in each row
    rows: Vec<Vec<u32>>,
    /// largest entry that each column began with   (n)
    size: Vec<f64>,
    /// columns left, by number of entries
    by_column: BTreeSet<(usize, u32)>,
    /// rows left, by number of entries
    by_row: BTreeSet<(usize, u32)>,
    /// pivots in order
    pivots: Order,
    /// place of a row in the column in work, plus one   (n)
    place: Vec<u32>,
}

impl<const P: usize> Markowitz<P> {
    /// Gathers the entries by columns and rows, scaled; entries at the same place add up.
    pub fn new(n: usize, pattern: &[(u32, u32)], values: &[[f64; P]], scale: &[f64]) -> Self {
        let mut columns: Vec<Vec<(u32, [f64; P])>> = vec![Vec::new(); n];
        let mut rows = vec![Vec::new(); n];
        let mut sorted: Vec<(u32, u32, [f64; P])> = pattern
            .iter()
            .zip(values)
            .map(|((i, j), v)| (*j, *i, v.map(|v| v * scale[*i as usize])))
            .collect();
        sorted.arrange_by_key(|(j, i, _)| (*j, *i));
        for (j, i, v) in sorted {
            match columns[j as usize].last_mut() {
                Some((last, sum)) if *last == i => {
                    sum.iter_mut().zip(v).for_each(|(sum, v)| *sum += v);
                }
                _ => {
                    columns[j as usize].push((i, v));
                    rows[i as usize].push(j);
                }
            }
        }
        let largest =
            |column: &Vec<(u32, [f64; P])>| column.iter().fold(0.0f64, |m, (_, v)| m.max(size(*v)));
        Markowitz {
            n,
            size: columns.iter().map(largest).collect(),
            by_column: columns
                .iter()
                .enumerate()
                .map(|(j, c)| (c.len(), j as u32))
                .collect(),
            by_row: rows
                .iter()
                .enumerate()
                .map(|(i, r)| (r.len(), i as u32))
                .collect(),
            columns,
            rows,
            pivots: Order::default(),
            place: vec![0; n],
        }
    }

    /// Eliminates until every column has its pivot; returns their order.
    ///
    /// # Errors
    /// The column that has none.
    pub fn eliminate(mut self) -> Result<Order, usize> {
        while self.pivots.row.len() < self.n {
            let (i, j) = self.choose()?;
            self.pivot(i, j);
        }
        Ok(self.pivots)
    }

    /// Chooses the next pivot: least (r−1)(c−1) among a few sparsest columns and rows, the larger
    /// one on a tie.
    fn choose(&self) -> Result<(u32, u32), usize> {
        let mut best: Option<(usize, f64, u32, u32)> = None;
        let cost = |i: u32, j: u32| {
            (self.rows[i as usize].len() - 1) * (self.columns[j as usize].len() - 1)
        };
        let mut consider = |i: u32, j: u32, ratio: f64| {
            let cost = cost(i, j);
            if best.is_none_or(|(c, r, ..)| cost < c || (cost == c && ratio > r)) {
                best = Some((cost, ratio, i, j));
            }
            best.map_or(0, |(c, ..)| c)
        };
        let mut least = usize::MAX;
        let mut seen = 0;
        for (_, j) in &self.by_column {
            let largest = self.largest(*j)?;
            for (i, v) in &self.columns[*j as usize] {
                if size(*v) >= PIVOT_THRESHOLD * largest {
                    least = consider(*i, *j, size(*v) / largest);
                }
            }
            seen += 1;
            if seen == CANDIDATES {
                break;
            }
        }
        for (_, i) in self.by_row.iter().take(CANDIDATES) {
            for j in &self.rows[*i as usize] {
                if cost(*i, *j) > least {
                    continue;
                }
                let largest = self.largest(*j)?;
                let here = self.columns[*j as usize].iter().find(|(row, _)| row == i);
                let is_large = |(_, v): &&(u32, [f64; P])| size(*v) >= PIVOT_THRESHOLD * largest;
                if let Some((_, v)) = here.filter(is_large) {
                    least = consider(*i, *j, size(*v) / largest);
                }
            }
        }
        // there is a column left, and its largest entry passed the threshold
        best.map(|(_, _, i, j)| (i, j)).ok_or(0)
    }

    /// Returns the largest entry left in column `j`.
    fn largest(&self, j: u32) -> Result<f64, usize> {
        let column = &self.columns[j as usize];
        let mut largest = 0.0;
        for (_, v) in column {
            if !size(*v).is_finite() {
                return Err(j as usize);
            }
            largest = f64::max(largest, size(*v));
        }
        if largest > SINGULAR_COLUMN * self.size[j as usize] {
            Ok(largest)
        } else {
            Err(j as usize)
        }
    }

    /// Eliminates with the entry (i, j).
    fn pivot(&mut self, i: u32, j: u32) {
        let column = std::mem::take(&mut self.columns[j as usize]);
        let row = std::mem::take(&mut self.rows[i as usize]);
        self.by_column.remove(&(column.len(), j));
        self.by_row.remove(&(row.len(), i));
        let pivot = column
            .iter()
            .find(|(r, _)| *r == i)
            .map_or([1.0; P], |(_, v)| reciprocal(*v));
        let below: Vec<(u32, [f64; P])> = column
            .into_iter()
            .filter(|(r, _)| *r != i)
            .map(|(r, v)| (r, times(v, pivot)))
            .collect();
        for (r, _) in &below {
            let others = &mut self.rows[*r as usize];
            self.by_row.remove(&(others.len(), *r));
            others.retain(|c| *c != j);
        }
        for c in row.iter().filter(|c| **c != j) {
            let other = &mut self.columns[*c as usize];
            self.by_column.remove(&(other.len(), *c));
            let at = other.iter().position(|(r, _)| *r == i);
            let u = at.map_or([0.0; P], |at| other.swap_remove(at).1);
            for (p, (r, _)) in other.iter().enumerate() {
                self.place[*r as usize] = p as u32 + 1;
            }
            for (r, l) in &below {
                let change = times(*l, u).map(|x| -x);
                match self.place[*r as usize] {
                    0 => {
                        other.push((*r, change));
                        self.rows[*r as usize].push(*c);
                    }
                    p => {
                        let sum = &mut other[p as usize - 1].1;
                        sum.iter_mut().zip(change).for_each(|(sum, v)| *sum += v);
                    }
                }
            }
            for (r, _) in other.iter() {
                self.place[*r as usize] = 0;
            }
            self.by_column.insert((other.len(), *c));
        }
        for (r, _) in &below {
            self.by_row.insert((self.rows[*r as usize].len(), *r));
        }
        self.pivots.row.push(i);
        self.pivots.column.push(j);
    }
}
