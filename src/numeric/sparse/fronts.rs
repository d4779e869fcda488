//! Factors of a sparse matrix by fronts: dense blocks of the unknowns that are eliminated together.
//!
//! ```text
//! node      consecutive pivots whose columns of L have the same rows below them: w pivots, r rows
//! front     ⎡A₁₁ A₁₂⎤   all that its pivots read and write, (w + r) × (w + r): entries of A, and
//!           ⎣A₂₁ A₂₂⎦   what its children have left in A₂₂ of their own
//! factor    A₁₁ = P L₁₁ U₁₁   L₂₁ = A₂₁ U₁₁⁻¹   U₁₂ = L₁₁⁻¹ Pᵀ A₁₂                             (1)
//! leave     A₂₂ − L₂₁ U₁₂ to the node of the first of the rows below                            (2)
//! ```
//!
//! Rows and columns come in the order of their pivots, and the pattern is made symmetric in it, so
//! that a node has as many rows as columns. Rows of one front change places (`P`) where a larger
//! pivot is found there. Children precede their parents, so what they leave lies on a stack.
//!
//! *Complex*: an entry is `P` numbers, one or two, its parts. A column of a block, and a row of
//! U₁₂, has all first parts, then all second ones, and (2) is one product of real matrices for both
//! kinds of numbers:
//!
//! ```text
//! C − L U = C − [L  iL] ⎡re U⎤          columns of C, L, iL: real parts above imaginary ones    (3)
//!                       ⎣im U⎦
//! ```
//!
//! Nothing allocates after construction. Terms are added in a fixed order.
//!
//! Source: Duff & Reid, ACM TOMS 9 (1983); Liu, SIAM Review 34 (1992).
#![allow(clippy::needless_range_loop)] // several arrays at one index read best that way

use super::{LARGEST_GROWTH, Order, reciprocal, size, times};

/// Pivots of a node, at most: those of more would spend their time within (1), not in (2).
///
/// Chosen on grids of bodies on bushings among 6, 8, 12, 16 and 24.
const MOST_PIVOTS: usize = 16;

/// Pivots that are eliminated together.
#[derive(Clone, Debug, Default)]
struct Node {
    /// place of its first pivot
    begin: usize,
    /// number of its pivots, w
    width: usize,
    /// beginning of its rows below the pivots among all such   (r)
    rows: usize,
    /// number of those, r
    n_rows: usize,
    /// beginning of its block among the factors: `[A₁₁; A₂₁]` by columns, then `A₁₂` by rows
    block: usize,
    /// beginning of its entries of A
    entries: usize,
    /// beginning of its runs
    runs: usize,
    /// number of those
    n_runs: usize,
    /// nodes that leave something to it: so many, the last on the stack
    n_children: usize,
}

/// Rows after each other that a node leaves to rows after each other of its parent, pivots or not.
#[derive(Clone, Copy, Debug)]
struct Run {
    /// first row of the node below its pivots
    from: usize,
    /// first row in the front of the parent
    to: usize,
    /// number of rows
    n: usize,
}

/// The place of an entry of A in the factors.
#[derive(Clone, Copy, Debug)]
struct Entry {
    /// index among the values
    value: u32,
    /// original row
    row: u32,
    /// place of its first part
    place: u32,
    /// distance of its second part from there
    stride: u32,
}

/// The factors, and the order of their pivots.
#[derive(Clone, Debug)]
pub(super) struct Fronts<const P: usize> {
    order: Order,
    nodes: Vec<Node>,
    /// places of the rows below the pivots of each node, ascending
    rows: Vec<u32>,
    /// places of what a node leaves within the front of its parent
    runs: Vec<Run>,
    entries: Vec<Entry>,
    /// blocks of all nodes
    factors: Vec<f64>,
    /// 1/pivot   (n)
    inverse: Vec<[f64; P]>,
    /// place whose row each pivot's row has changed places with   (n)
    exchanged: Vec<u32>,
    /// what nodes have left to their parents, and which nodes
    stack: Vec<f64>,
    left: Vec<u32>,
    /// A₂₂ of the node in work, and `[L₂₁ iL₂₁]`
    front: Vec<f64>,
    beside: Vec<f64>,
    /// right-hand side in order of pivots, and what a node adds to it: parts after each other
    x: Vec<f64>,
    change: Vec<f64>,
}

/// The pattern of the factors, by nodes.
struct Analysis {
    /// the pivots anew: children before their parents, those of one node after each other
    order: Vec<u32>,
    /// first pivot of each node   (nodes + 1)
    begins: Vec<usize>,
    /// rows below the pivots of each node
    rows: Vec<Vec<u32>>,
}

impl Analysis {
    /// Finds the nodes of a matrix with entries at the given places, in order of elimination.
    fn new(n: usize, places: impl Iterator<Item = (u32, u32)>) -> Self {
        // rows below each pivot, and the pivot that they are handed to
        let mut below = vec![Vec::new(); n];
        for (i, j) in places.filter(|(i, j)| i != j) {
            below[i.min(j) as usize].push(i.max(j));
        }
        let mut children = vec![Vec::new(); n + 1];
        for k in 0..n {
            let mut own = std::mem::take(&mut below[k]);
            for &c in &children[k] {
                let handed: &Vec<u32> = &below[c as usize];
                own.extend(handed.iter().filter(|&&i| i as usize != k));
            }
            own.sort_unstable();
            own.dedup();
            children[own.first().map_or(n, |&p| p as usize)].push(k as u32);
            below[k] = own;
        }
        // children before their parents, the one with most rows last
        let (mut order, mut stack) = (Vec::with_capacity(n), vec![(n, 0)]);
        for some in &mut children {
            some.sort_by_key(|&c| below[c as usize].len());
        }
        while let Some((k, done)) = stack.pop() {
            if let Some(&c) = children[k].get(done) {
                stack.push((k, done + 1));
                stack.push((c as usize, 0));
            } else if k < n {
                order.push(k as u32);
            }
        }
        let mut place = vec![0; n];
        for (p, &k) in order.iter().enumerate() {
            place[k as usize] = p as u32;
        }
        let rows = order.iter().map(|&k| {
            let renumbered = below[k as usize].iter().map(|&i| place[i as usize]);
            let mut rows: Vec<u32> = renumbered.collect();
            rows.sort_unstable();
            rows
        });
        let (begins, rows) = merged(rows.collect());
        Self {
            order,
            begins,
            rows,
        }
    }
}

/// Joins pivots, each with the rows below it, to nodes: returns the first pivot of each node and
/// one behind the last, and the rows below each node.
fn merged(below: Vec<Vec<u32>>) -> (Vec<usize>, Vec<Vec<u32>>) {
    let n = below.len();
    let mut begins: Vec<usize> = Vec::new();
    let mut rows: Vec<Vec<u32>> = Vec::new();
    for (k, below) in below.into_iter().enumerate() {
        match (begins.last(), rows.last_mut()) {
            // the rows below the last pivot are this one and those below it
            (Some(begin), Some(last))
                if last.first() == Some(&(k as u32))
                    && last.len() == below.len() + 1
                    && k - begin < MOST_PIVOTS =>
            {
                *last = below;
            }
            _ => {
                begins.push(k);
                rows.push(below);
            }
        }
    }
    begins.push(n);
    (begins, rows)
}

impl<const P: usize> Fronts<P> {
    /// Prepares for matrices of the given pattern, eliminated in the given order.
    pub fn new(order: &Order, pattern: &[(u32, u32)]) -> Self {
        let n = order.row.len();
        let (row_at, column_at) = order.places();
        let places = pattern.iter();
        let places = places.map(|(i, j)| (row_at[*i as usize], column_at[*j as usize]));
        let analysis = Analysis::new(n, places);
        let pick = |all: &[u32]| analysis.order.iter().map(|&k| all[k as usize]).collect();
        let order = Order {
            row: pick(&order.row),
            column: pick(&order.column),
        };
        let mut fronts = Self {
            nodes: Vec::new(),
            rows: Vec::new(),
            runs: Vec::new(),
            entries: Vec::new(),
            factors: Vec::new(),
            inverse: vec![[0.0; P]; n],
            exchanged: vec![0; n],
            stack: Vec::new(),
            left: Vec::new(),
            front: Vec::new(),
            beside: Vec::new(),
            x: vec![0.0; P * n],
            change: Vec::new(),
            order,
        };
        fronts.lay_out(&analysis, n);
        fronts.place_entries(pattern);
        fronts
    }

    /// Makes the nodes, and room for their blocks.
    fn lay_out(&mut self, analysis: &Analysis, n: usize) {
        let mut node_of = vec![0; n];
        for (s, ends) in analysis.begins.windows(2).enumerate() {
            node_of[ends[0]..ends[1]].fill(s);
        }
        let n_nodes = analysis.rows.len();
        let mut n_children = vec![0; n_nodes];
        let parent = |rows: &[u32]| rows.first().map(|&p| node_of[p as usize]);
        for rows in &analysis.rows {
            if let Some(parent) = parent(rows) {
                n_children[parent] += 1;
            }
        }
        let (mut block, mut most, mut most_beside) = (0, 0, 0);
        let (mut stack, mut most_stack, mut left) = (0, 0, Vec::new());
        for (s, rows) in analysis.rows.iter().enumerate() {
            let (begin, r) = (analysis.begins[s], rows.len());
            let w = analysis.begins[s + 1] - begin;
            self.nodes.push(Node {
                begin,
                width: w,
                rows: self.rows.len(),
                n_rows: r,
                block,
                entries: 0,
                runs: self.runs.len(),
                n_runs: 0,
                n_children: n_children[s],
            });
            self.rows.extend(rows);
            if let Some(parent) = parent(rows) {
                let (begin, end) = (analysis.begins[parent], analysis.begins[parent + 1]);
                let others = &analysis.rows[parent];
                let first = self.runs.len();
                for (from, &i) in rows.iter().enumerate() {
                    let to = match (i as usize) < end {
                        true => i as usize - begin,
                        false => end - begin + others.partition_point(|&o| o < i),
                    };
                    match self.runs[first..].last_mut() {
                        Some(run) if run.to + run.n == to && to != end - begin => run.n += 1,
                        _ => self.runs.push(Run { from, to, n: 1 }),
                    }
                }
                self.nodes[s].n_runs = self.runs.len() - first;
            }
            block += P * w * (w + 2 * r);
            (most, most_beside) = (most.max(P * r * r), most_beside.max(P * P * r * w));
            for _ in 0..n_children[s] {
                stack -= left.pop().unwrap_or(0);
            }
            if r > 0 {
                left.push(P * r * r);
                stack += P * r * r;
                most_stack = most_stack.max(stack);
            }
        }
        self.factors = vec![0.0; block];
        self.front = vec![0.0; most];
        self.beside = vec![0.0; most_beside];
        self.stack = Vec::with_capacity(most_stack);
        self.left = Vec::with_capacity(n_nodes);
        let most_rows = analysis.rows.iter().map(Vec::len).max();
        self.change = vec![0.0; P * most_rows.unwrap_or(0)];
    }

    /// Finds where the entries of the pattern stand in the blocks.
    fn place_entries(&mut self, pattern: &[(u32, u32)]) {
        let (row_at, column_at) = self.order.places();
        let mut lists = vec![Vec::new(); self.nodes.len()];
        for (e, (row, column)) in pattern.iter().enumerate() {
            let (i, j) = (row_at[*row as usize], column_at[*column as usize]);
            let (first, other) = (i.min(j) as usize, i.max(j));
            let s = self.nodes.partition_point(|node| node.begin <= first) - 1;
            let node = &self.nodes[s];
            let (w, r, m) = (node.width, node.n_rows, node.width + node.n_rows);
            let below = &self.rows[node.rows..node.rows + node.n_rows];
            let within = |k: u32| match (k as usize) < node.begin + w {
                true => k as usize - node.begin,
                false => w + below.partition_point(|&o| o < k),
            };
            debug_assert!(within(other) < m);
            let (i, j) = (within(i), within(j));
            let (place, stride) = match j < w {
                true => (P * m * j + i, m),
                false => (P * (m * w + r * i) + j - w, r),
            };
            lists[s].push(Entry {
                value: e as u32,
                row: *row,
                place: (node.block + place) as u32,
                stride: stride as u32,
            });
        }
        for (node, list) in self.nodes.iter_mut().zip(lists) {
            node.entries = self.entries.len();
            self.entries.extend(list);
        }
    }

    /// Returns the number of entries of the factors.
    pub fn fill(&self) -> usize {
        self.factors.len() / P
    }

    /// Factors the matrix with these values and factors of its rows; returns false when a pivot
    /// is lost, or small against what stands below it.
    pub fn factor(&mut self, values: &[[f64; P]], scale: &[f64]) -> bool {
        #[cfg(all(feature = "native", target_arch = "x86_64"))]
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the machine has these instructions
            #[allow(unsafe_code)]
            return unsafe { self.factor_avx2(values, scale) };
        }
        self.factor_here(values, scale)
    }

    /// The same by wider vectors: the same operations in the same order, so the same bits.
    #[cfg(all(feature = "native", target_arch = "x86_64"))]
    #[target_feature(enable = "avx2")]
    fn factor_avx2(&mut self, values: &[[f64; P]], scale: &[f64]) -> bool {
        self.factor_here(values, scale)
    }

    /// The same by the vectors of any machine.
    #[inline(always)]
    fn factor_here(&mut self, values: &[[f64; P]], scale: &[f64]) -> bool {
        self.stack.clear();
        self.left.clear();
        self.factors.fill(0.0);
        let mut growth = 0.0;
        for s in 0..self.nodes.len() {
            let end = self
                .nodes
                .get(s + 1)
                .map_or(self.entries.len(), |n| n.entries);
            for e in &self.entries[self.nodes[s].entries..end] {
                let scale = scale[e.row as usize];
                for (part, value) in values[e.value as usize].iter().enumerate() {
                    self.factors[e.place as usize + part * e.stride as usize] += value * scale;
                }
            }
            let (w, r) = (self.nodes[s].width, self.nodes[s].n_rows);
            self.front[..P * r * r].fill(0.0);
            for _ in 0..self.nodes[s].n_children {
                self.assemble(s);
            }
            growth = f64::max(growth, self.eliminate(s));
            if growth >= LARGEST_GROWTH {
                return false;
            }
            let node = &self.nodes[s];
            let block = &self.factors[node.block..][..P * w * (w + 2 * r)];
            let (panel, upper) = block.split_at(P * w * (w + r));
            let (front, m) = (&mut self.front[..P * r * r], w + r);
            let beside = &mut self.beside[..P * P * r * w];
            gather::<P>(beside, panel, (m, r));
            subtract_product(front, beside, upper, (P * r, r));
            if r > 0 {
                self.stack.extend_from_slice(front);
                self.left.push(s as u32);
            }
        }
        true
    }

    /// Adds to the front of node `s` what the last of its children on the stack has left.
    #[inline(always)]
    fn assemble(&mut self, s: usize) {
        let Some(child) = self.left.pop() else {
            unreachable!("each child has left something");
        };
        let (node, own) = (&self.nodes[s], &self.nodes[child as usize]);
        let (w, r, m) = (node.width, node.n_rows, node.width + node.n_rows);
        let runs = &self.runs[own.runs..own.runs + own.n_runs];
        let begin = self.stack.len() - P * own.n_rows * own.n_rows;
        let block = &mut self.factors[node.block..][..P * w * (w + 2 * r)];
        let (panel, upper) = block.split_at_mut(P * w * m);
        let columns = runs
            .iter()
            .flat_map(|run| (0..run.n).map(|k| (run.from + k, run.to + k)));
        for (from, j) in columns {
            let column = &self.stack[begin + P * own.n_rows * from..][..P * own.n_rows];
            for (part, column) in column.chunks_exact(own.n_rows).enumerate() {
                for run in runs {
                    let column = &column[run.from..][..run.n];
                    let to = match (j < w, run.to < w) {
                        (true, _) => &mut panel[(P * j + part) * m + run.to..][..run.n],
                        (_, false) => {
                            &mut self.front[(P * (j - w) + part) * r + run.to - w..][..run.n]
                        }
                        (_, true) => {
                            for (k, value) in column.iter().enumerate() {
                                upper[(P * (run.to + k) + part) * r + j - w] += value;
                            }
                            continue;
                        }
                    };
                    to.iter_mut()
                        .zip(column)
                        .for_each(|(to, value)| *to += value);
                }
            }
        }
        self.stack.truncate(begin);
    }

    /// Factors the front of node `s` (1); returns the largest entry of L, infinite where a pivot
    /// is lost.
    #[inline(always)]
    fn eliminate(&mut self, s: usize) -> f64 {
        let node = &self.nodes[s];
        let (w, r, m) = (node.width, node.n_rows, node.width + node.n_rows);
        let block = &mut self.factors[node.block..][..P * w * (w + 2 * r)];
        let (panel, upper) = block.split_at_mut(P * w * m);
        let entry = |panel: &[f64], i: usize, j: usize| -> [f64; P] {
            std::array::from_fn(|part| panel[(P * j + part) * m + i])
        };
        let mut growth = 0.0;
        for k in 0..w {
            let (mut pivot, mut largest) = (k, size(entry(panel, k, k)));
            for i in k + 1..w {
                let here = size(entry(panel, i, k));
                if here > largest {
                    (pivot, largest) = (i, here);
                }
            }
            let inverse = reciprocal(entry(panel, pivot, k));
            if !inverse.iter().all(|x| x.is_finite()) || largest == 0.0 {
                return f64::INFINITY;
            }
            self.inverse[node.begin + k] = inverse;
            self.exchanged[node.begin + k] = pivot as u32;
            if pivot != k {
                panel.chunks_exact_mut(m).for_each(|c| c.swap(k, pivot));
            }
            let (done, rest) = panel.split_at_mut(P * m * (k + 1));
            let own = &mut done[P * m * k..];
            for i in k + 1..m {
                let l = times(entry(own, i, 0), inverse);
                let here = size(l);
                growth = if here <= growth { growth } else { here };
                (0..P).for_each(|part| own[part * m + i] = l[part]);
            }
            for column in rest.chunks_exact_mut(P * m) {
                let u = entry(column, k, 0);
                if u != [0.0; P] {
                    subtract::<P>(column, own, (k + 1..m, m, m), u);
                }
            }
            if r == 0 {
                continue;
            }
            // rows of U are columns here
            if pivot != k {
                let (before, from) = upper.split_at_mut(P * r * pivot);
                before[P * r * k..][..P * r].swap_with_slice(&mut from[..P * r]);
            }
            let (done, rest) = upper.split_at_mut(P * r * (k + 1));
            let row = &done[P * r * k..];
            for (i, other) in rest.chunks_exact_mut(P * r).enumerate() {
                let l = entry(own, k + 1 + i, 0);
                if l != [0.0; P] {
                    subtract::<P>(other, row, (0..r, r, r), l);
                }
            }
        }
        if growth.is_nan() {
            f64::INFINITY
        } else {
            growth
        }
    }

    /// Solves `b ← A⁻¹ b`, parts apart; `scale` are the factors of the rows.
    pub fn solve(&mut self, b: &mut [&mut [f64]; P], scale: &[f64]) {
        #[cfg(all(feature = "native", target_arch = "x86_64"))]
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the machine has these instructions
            #[allow(unsafe_code)]
            return unsafe { self.solve_avx2(b, scale) };
        }
        self.solve_here(b, scale);
    }

    /// The same by wider vectors, as [`Self::factor_avx2`].
    #[cfg(all(feature = "native", target_arch = "x86_64"))]
    #[target_feature(enable = "avx2")]
    fn solve_avx2(&mut self, b: &mut [&mut [f64]; P], scale: &[f64]) {
        self.solve_here(b, scale);
    }

    /// The same by the vectors of any machine.
    #[inline(always)]
    fn solve_here(&mut self, b: &mut [&mut [f64]; P], scale: &[f64]) {
        let n = self.order.row.len();
        for (x, b) in self.x.chunks_exact_mut(n.max(1)).zip(&*b) {
            for (x, &row) in x.iter_mut().zip(&self.order.row) {
                *x = b[row as usize] * scale[row as usize];
            }
        }
        for node in &self.nodes {
            let (begin, w, r) = (node.begin, node.width, node.n_rows);
            let m = w + r;
            let panel = &self.factors[node.block..][..P * w * m];
            let change = &mut self.change[..P * r];
            change.fill(0.0);
            for k in 0..w {
                let other = begin + self.exchanged[begin + k] as usize;
                (0..P).for_each(|part| self.x.swap(part * n + begin + k, part * n + other));
            }
            for (k, column) in panel.chunks_exact(P * m).enumerate() {
                let x = &mut self.x;
                let u = std::array::from_fn(|part| x[part * n + begin + k]);
                subtract::<P>(&mut x[begin..], column, (k + 1..w, n, m), u);
                subtract::<P>(change, &column[w..], (0..r, r, m), u);
            }
            let rows = &self.rows[node.rows..][..r];
            for (x, change) in self
                .x
                .chunks_exact_mut(n)
                .zip(change.chunks_exact(r.max(1)))
            {
                for (change, &i) in change.iter().zip(rows) {
                    x[i as usize] += change;
                }
            }
        }
        for node in self.nodes.iter().rev() {
            let (begin, w, r) = (node.begin, node.width, node.n_rows);
            let m = w + r;
            let block = &self.factors[node.block..][..P * w * (m + r)];
            let (panel, upper) = block.split_at(P * w * m);
            let rows = &self.rows[node.rows..][..r];
            let known = &mut self.change[..P * r];
            for (known, x) in known.chunks_exact_mut(r.max(1)).zip(self.x.chunks_exact(n)) {
                for (known, &i) in known.iter_mut().zip(rows) {
                    *known = x[i as usize];
                }
            }
            for (k, row) in upper.chunks_exact((P * r).max(1)).enumerate() {
                let sum = dot::<P>(row, known);
                (0..P).for_each(|part| self.x[part * n + begin + k] -= sum[part]);
            }
            for (k, column) in panel.chunks_exact(P * m).enumerate().rev() {
                let here = std::array::from_fn(|part| self.x[part * n + begin + k]);
                let u = times(here, self.inverse[begin + k]);
                (0..P).for_each(|part| self.x[part * n + begin + k] = u[part]);
                subtract::<P>(&mut self.x[begin..], column, (0..k, n, m), u);
            }
        }
        for (x, b) in self.x.chunks_exact(n.max(1)).zip(b) {
            for (x, &column) in x.iter().zip(&self.order.column) {
                b[column as usize] = *x;
            }
        }
    }
}

/// `to ← to − of · u` for a range of rows; parts of `to` and of `of` stand so far apart.
#[inline(always)]
fn subtract<const P: usize>(
    to: &mut [f64],
    of: &[f64],
    (rows, apart, of_apart): (std::ops::Range<usize>, usize, usize),
    u: [f64; P],
) {
    let n = rows.len();
    if n == 0 {
        return;
    }
    let begin = rows.start;
    if P == 1 {
        let (to, of) = (&mut to[begin..][..n], &of[begin..][..n]);
        for i in 0..n {
            to[i] -= of[i] * u[0];
        }
    } else {
        let (re, im) = to.split_at_mut(apart);
        let (re, im) = (&mut re[begin..][..n], &mut im[begin..][..n]);
        let (of_re, of_im) = (&of[begin..][..n], &of[of_apart + begin..][..n]);
        for i in 0..n {
            re[i] -= of_re[i] * u[0] - of_im[i] * u[P - 1];
            im[i] -= of_re[i] * u[P - 1] + of_im[i] * u[0];
        }
    }
}

/// Returns the sum of products of two rows of numbers, parts apart.
#[inline(always)]
fn dot<const P: usize>(row: &[f64], x: &[f64]) -> [f64; P] {
    let n = row.len() / P;
    let sum = |a: &[f64], b: &[f64]| {
        // four sums, so that they are made at the same time
        let mut sums = [0.0; 4];
        let (a, a_rest) = a.as_chunks::<4>();
        let (b, b_rest) = b.as_chunks::<4>();
        for (a, b) in a.iter().zip(b) {
            for k in 0..4 {
                sums[k] += a[k] * b[k];
            }
        }
        let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
        (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
    };
    let (re, x_re) = (&row[..n], &x[..n]);
    if P == 1 {
        return [sum(re, x_re); P];
    }
    let (im, x_im) = (&row[n..], &x[n..]);
    let mut product = [sum(re, x_re) - sum(im, x_im); P];
    product[P - 1] = sum(re, x_im) + sum(im, x_re);
    product
}

/// Gathers `[L iL]` of (3), each column of iL behind that of L, from the last `r` of the `m` rows
/// of a panel.
#[inline(always)]
fn gather<const P: usize>(beside: &mut [f64], panel: &[f64], (m, r): (usize, usize)) {
    if r == 0 {
        return;
    }
    let columns = panel
        .chunks_exact(P * m)
        .zip(beside.chunks_exact_mut(P * P * r));
    for (column, to) in columns {
        for (part, to) in column.chunks_exact(m).zip(to.chunks_exact_mut(r)) {
            to.copy_from_slice(&part[m - r..]);
        }
        if P == 2 {
            let ((re, im), (to_re, to_im)) = (column.split_at(m), to[P * r..].split_at_mut(r));
            let im = im[m - r..].iter();
            to_re.iter_mut().zip(im).for_each(|(to, im)| *to = -im);
            to_im.copy_from_slice(&re[m - r..]);
        }
    }
}

/// `c ← c − a b`, by columns of `c` and `a`, by rows of `b`; `m` rows of `a`, `n` columns of `b`.
#[inline(always)]
fn subtract_product(c: &mut [f64], a: &[f64], b: &[f64], (m, n): (usize, usize)) {
    if m == 0 {
        return;
    }
    let mut j = 0;
    while j + 4 <= n {
        rows::<4>(c, a, b, (m, n, j));
        j += 4;
    }
    while j < n {
        rows::<1>(c, a, b, (m, n, j));
        j += 1;
    }
}

/// The same for a few columns.
#[inline(always)]
fn rows<const C: usize>(c: &mut [f64], a: &[f64], b: &[f64], at: (usize, usize, usize)) {
    let (m, mut i) = (at.0, 0);
    while i + 8 <= m {
        tile::<8, C>(c, a, b, at, i);
        i += 8;
    }
    while i < m {
        tile::<1, C>(c, a, b, at, i);
        i += 1;
    }
}

/// The same for a few rows of them, whose sums stay in registers.
#[inline(always)]
fn tile<const R: usize, const C: usize>(
    c: &mut [f64],
    a: &[f64],
    b: &[f64],
    (m, n, j): (usize, usize, usize),
    i: usize,
) {
    let mut sums = [[0.0; R]; C];
    for (a, b) in a.chunks_exact(m).zip(b.chunks_exact(n)) {
        let (a, b) = (&a[i..i + R], &b[j..j + C]);
        for (sums, b) in sums.iter_mut().zip(b) {
            for (sum, a) in sums.iter_mut().zip(a) {
                *sum += a * b;
            }
        }
    }
    for (k, sums) in sums.iter().enumerate() {
        for (c, sum) in c[(j + k) * m + i..][..R].iter_mut().zip(sums) {
            *c -= sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::between_ones;

    /// Solutions, in bits, by factors that `by` makes of a grid of blocks of six unknowns.
    fn bits<const P: usize>(by: impl Fn(&mut Fronts<P>, &[[f64; P]], &[f64]) -> bool) -> Vec<u64> {
        let (n, mut draw) = (5usize, between_ones(9));
        let m = 6 * n * n;
        let is_near = |a: usize, b: usize| (a / n).abs_diff(b / n) + (a % n).abs_diff(b % n) < 2;
        let places = (0..m).flat_map(|i| (0..m).map(move |j| (i, j)));
        let places = places.filter(|(i, j)| is_near(i / 6, j / 6));
        let pattern: Vec<(u32, u32)> = places.map(|(i, j)| (i as u32, j as u32)).collect();
        let diagonal = |i: u32, j: u32| if i == j { 20.0 } else { 0.0 };
        let values = pattern.iter().map(|&(i, j)| {
            let mut value = [0.0; P];
            value.iter_mut().for_each(|v| *v = draw());
            value[0] += diagonal(i, j);
            value
        });
        let values: Vec<[f64; P]> = values.collect();
        let order: Vec<u32> = (0..m as u32).collect();
        let order = Order {
            row: order.clone(),
            column: order,
        };
        let (mut fronts, scale) = (Fronts::<P>::new(&order, &pattern), vec![1.0; m]);
        assert!(by(&mut fronts, &values, &scale));
        let mut x: [Vec<f64>; P] = std::array::from_fn(|_| vec![1.0; m]);
        fronts.solve(&mut x.each_mut().map(Vec::as_mut_slice), &scale);
        x.concat().into_iter().map(f64::to_bits).collect()
    }

    #[test]
    fn wider_vectors_change_no_bit() {
        assert_eq!(
            bits::<1>(|f, values, scale| f.factor(values, scale)),
            bits::<1>(|f, values, scale| f.factor_here(values, scale))
        );
        assert_eq!(
            bits::<2>(|f, values, scale| f.factor(values, scale)),
            bits::<2>(|f, values, scale| f.factor_here(values, scale))
        );
    }
}
