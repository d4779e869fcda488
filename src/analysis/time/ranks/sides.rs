//! The sides of singular positions: between two states the rows may have become dependent and
//! independent again, which a smooth motion does only where two branches meet.
//!
//! ```text
//! B = G₁ A G₀ᵀ (G₀ A G₀ᵀ)⁻¹      rows G₀ at one state, G₁ at a later one; one where they are the same
//! ```
//!
//! While the rows stay independent no eigenvalue of B vanishes; where a combination of rows
//! vanishes in passing, one goes through zero and is negative afterwards. So two states on branches
//! that only come near each other are told from two on one branch, however long the step was. Each
//! loop (rows that share coordinates) has a B of its own, judged in `turning.rs`.

use super::known::Meetings;
use super::passes::DEPENDENT_THERE;
use super::selection::{self, Rows, norm};
use super::turning::Beginning;
use super::valley::Valley;
use crate::analysis::system::{RowGradients, System};
use crate::analysis::time::states::{Cubic, Node};
use crate::expr::program::{Program, Work};
use crate::scene::programs::weights;
use std::collections::BTreeMap;

/// Violation of a row, relative to what counts as one, beyond which there is no state.
pub(super) const GAP: f64 = 1e-12;
/// Failures to find a state after which there is none: one very near the position may be hard to
/// find, but within a gap between branches all are.
const MAX_FAILURES: u32 = 3;
/// Least of what rows determine beyond each other, over their usual length, below which a state
/// between the ends of a step is put onto the rows: errors of interpolants are smaller.
const NEAR_BOTH: f64 = 0.1;
/// States looked at in search of the position at which branches meet, at most.
const MAX_LOOKS: usize = 60;
/// Looks after which one is in the middle, however near one end dependence seems: another position
/// may be there.
const LOOKS_TO_MIDDLE: usize = 3;
/// Positions in a row at which branches meet between two states, at most: as many loops as turn
/// there.
const MAX_MEETINGS: usize = 100;
/// Part of the way behind a position at which branches meet, from which the next is looked for.
const BEHIND: f64 = 0.01;
/// Width of the interval in which a hidden meeting is left, over that in which it is looked for.
const NEXT_TO_EACH_OTHER: f64 = 1e-12;
/// Least of what rows determine beyond each other there, at most: beside the meeting of many loops
/// states are known to the square root of [`GAP`] each, if they are found at all.
const HARDLY_KNOWN: f64 = 10.0 * DEPENDENT_THERE;
/// Width of the interval that is left of the search, over the one in which branches that meet
/// would be as far from dependence as its ends, below which they pass each other.
const PASSED_BY: f64 = 0.05;

/// Rows of a loop: those that share coordinates.
#[derive(Clone, Debug, Default)]
pub(super) struct Loop {
    /// indices of its rows
    pub rows: Vec<usize>,
    /// places in v of its coordinates
    pub coordinates: Vec<usize>,
}

/// The gradients of the rows at one state, by loops: rows against what counts as one, columns in
/// the metric of projections.
#[derive(Clone, Debug, Default)]
pub struct Side(Vec<Rows>);

/// Watch that finds out on which side of singular positions states are.
#[derive(Debug)]
pub struct Sides {
    loops: Vec<Loop>,
    /// gradients of the rows that take part
    program: Program,
    work: Work,
    values: Vec<f64>,
    /// loop, row and column of each value, and its factor
    places: Vec<(usize, usize, usize, f64)>,
    /// the longest that each row has been, by loops
    usual: Vec<Vec<f64>>,
    /// where branches of each loop have met
    known: Vec<Meetings>,
    /// values of all rows, and scratch for them   (n_rows)
    rows: (Program, Work, Vec<f64>),
}

impl Sides {
    /// Takes the gradients of the rows that take part; `None` where none does.
    pub fn new(system: &System) -> Option<Self> {
        let scene = system.configured();
        let rows: Vec<usize> = scene.configuration.active_rows().collect();
        let RowGradients { entries, program } = system.row_gradients();
        let loops = loops(&rows, entries, scene.layout.n_v);
        let w = weights(&scene);
        let mut loop_of = vec![None; scene.rows.len()];
        for (k, l) in loops.iter().enumerate() {
            l.rows.iter().for_each(|&r| loop_of[r] = Some(k));
        }
        let place = |&(r, v): &(usize, usize)| {
            let k = loop_of[r]?;
            let i = loops[k].rows.binary_search(&r).ok()?;
            let j = loops[k].coordinates.binary_search(&v).ok()?;
            Some((k, i, j, w[v].sqrt() / scene.row_scale(r)))
        };
        let places: Vec<_> = entries.iter().filter_map(place).collect();
        (!loops.is_empty() && places.len() == entries.len()).then(|| Self {
            usual: loops.iter().map(|l| vec![0.0; l.rows.len()]).collect(),
            known: loops.iter().map(|l| Meetings::of(&scene, l)).collect(),
            rows: (
                system.row_values().clone(),
                Work::default(),
                vec![0.0; scene.rows.len()],
            ),
            loops,
            values: vec![0.0; program.n_outputs()],
            program: program.clone(),
            work: Work::default(),
            places,
        })
    }

    /// Returns the places in v of the coordinates of each loop.
    pub fn coordinates(&self) -> impl Iterator<Item = &[usize]> {
        self.loops.iter().map(|l| &l.coordinates[..])
    }

    /// Evaluates the gradients at all numbers of a state.
    pub fn look(&mut self, numbers: &[f64]) -> Side {
        self.program.run(numbers, &mut self.work, &mut self.values);
        let size = |l: &Loop| Rows::zeros(l.rows.len(), l.coordinates.len());
        let mut side: Vec<Rows> = self.loops.iter().map(size).collect();
        for (&(k, i, j, factor), x) in self.places.iter().zip(&self.values) {
            side[k].row_mut(i)[j] += factor * x;
        }
        for (usual, block) in self.usual.iter_mut().zip(&side) {
            for (usual, row) in usual.iter_mut().zip(block.iter()) {
                *usual = usual.max(norm(row));
            }
        }
        Side(side)
    }

    /// Returns the loops of which a combination of rows has gone through zero between two states.
    pub fn turned(from: &Side, to: &Side) -> Vec<usize> {
        let turned = |&k: &usize| Beginning::at(&from.0[k]).has_turned(&to.0[k]);
        (0..from.0.len()).filter(turned).collect()
    }

    /// Returns whether rows are so near dependence that a state off the rows may be beside either
    /// branch.
    pub fn are_near(&self, side: &Side) -> bool {
        (0..self.loops.len()).any(|k| self.margin(&[k], side) < NEAR_BOTH)
    }

    /// Returns whether a motion through two states comes to stand at a position where rows are
    /// dependent: where it goes from there is up to rounding. `moments`: when it is at the two;
    /// `patience`: a time that is short.
    pub fn stands(&self, [from, to]: [&Side; 2], moments: [f64; 2], patience: f64) -> bool {
        (0..self.loops.len()).any(|k| {
            let after = self.margin(&[k], to);
            after < DEPENDENT_THERE && {
                let before = self.margin(&[k], from);
                let falls = (before - after) / (moments[1] - moments[0]);
                before > after && after < falls * patience
            }
        })
    }

    /// Returns the least that any row of some loops determines beyond the others of its loop, over
    /// its usual length: zero where rows are dependent.
    fn margin(&self, loops: &[usize], side: &Side) -> f64 {
        let of = |&k: &usize| {
            let mut rows = side.0[k].clone();
            for (row, usual) in rows.iter_mut().zip(&self.usual[k]) {
                let usual = usual.max(f64::MIN_POSITIVE);
                row.iter_mut().for_each(|x| *x /= usual);
            }
            selection::margin(rows)
        };
        loops.iter().map(of).fold(f64::INFINITY, f64::min)
    }

    /// Finds out whether two states between which loops have turned are on branches that meet:
    /// whether rows are dependent wherever a combination of them turns between the two, whose rows
    /// are known.
    pub fn meet(
        &mut self,
        system: &mut System,
        loops: &[usize],
        [(a, from), (b, to)]: [(&Node, &Side); 2],
    ) -> bool {
        let is_new = |k: &usize| !self.passes_known(system, *k, [(a, from), (b, to)]);
        let loops: Vec<usize> = loops.iter().copied().filter(is_new).collect();
        if loops.is_empty() {
            return true;
        }
        let (first, mut a, mut from) = (from, a.clone(), from.clone());
        for meetings in 0..MAX_MEETINGS {
            let ends = [(&a, &from), (b, to)];
            let Some((meeting, nearest)) = self.first_meeting(system, &loops, ends) else {
                return false;
            };
            // another one behind it?
            let t = meeting.t + BEHIND * (b.t - meeting.t);
            let Some((node, side)) = self.state_between(system, [&meeting, b], t) else {
                return true;
            };
            let turned = |&k: &usize| Beginning::at(&side.0[k]).has_turned(&to.0[k]);
            if t <= a.t || !loops.iter().any(turned) {
                if meetings == 0 {
                    self.learn(system, &loops, (&nearest, [first, to]));
                }
                return true;
            }
            (a, from) = (node, side);
        }
        true
    }

    /// Returns whether a loop turns between two states where its branches are known to meet.
    fn passes_known(
        &mut self,
        system: &mut System,
        k: usize,
        [(a, from), (b, to)]: [(&Node, &Side); 2],
    ) -> bool {
        // as after a search
        system.project_anew();
        let known = std::mem::take(&mut self.known);
        let mut passed = known[k].passed((system.mover(), system.scene.layout), [a, b]);
        let found = passed.any(|(node, meeting)| {
            let numbers = system.numbers_at(node.t, &node.y);
            let is_there = self.is_on_rows(system, k, &numbers) && {
                let side = self.look(&numbers);
                self.margin(&[k], &side) < DEPENDENT_THERE
            };
            is_there && meeting.is_all_between(&from.0[k], &to.0[k])
        });
        drop(passed);
        self.known = known;
        found
    }

    /// Returns whether a state is on the rows of a loop.
    fn is_on_rows(&mut self, system: &System, k: usize, numbers: &[f64]) -> bool {
        let (program, work, values) = &mut self.rows;
        program.run(numbers, work, values);
        let off = |&r: &usize| (values[r] / system.scene.row_scale(r)).abs();
        self.loops[k].rows.iter().all(|r| off(r) <= GAP)
    }

    /// Takes up the only meeting of some loops between two states whose rows are known.
    fn learn(&mut self, system: &System, loops: &[usize], (meeting, ends): (&Node, [&Side; 2])) {
        if !loops.iter().any(|&k| self.known[k].may_learn()) {
            return;
        }
        let side = self.look(&system.numbers_at(meeting.t, &meeting.y));
        let q = system.scene.layout.state(&meeting.y[..]).q;
        for &k in loops {
            if self.known[k].may_learn() && self.margin(&[k], &side) < DEPENDENT_THERE {
                self.known[k].learn(q, ends.map(|side| &side.0[k]));
            }
        }
    }

    /// Finds a state on the rows, and the rows there, at a time between two others; `None`: there
    /// is none near the cubic through the two.
    fn state_between(
        &mut self,
        system: &mut System,
        ends: [&Node; 2],
        t: f64,
    ) -> Option<(Node, Side)> {
        let (l, mover) = (system.scene.layout, system.mover());
        let mut y = ends[0].y.clone();
        Cubic::new(mover, l, ends).at(mover, t, &mut y);
        system.project_anew();
        let found = system.put_on_rows(t, &mut y).is_ok();
        let numbers = system.numbers_at(t, &y);
        // where rows are dependent the least change may be none, within a gap too
        (found && system.worst_gap(&numbers) <= GAP).then(|| (Node { t, y }, self.look(&numbers)))
    }

    /// Finds the first position between two states at which rows of loops are dependent and behind
    /// which a combination of them has turned: the state behind it, and the one nearest to it.
    /// `None`: they turn without, on branches that only come near each other.
    fn first_meeting(
        &mut self,
        system: &mut System,
        loops: &[usize],
        [(a, from), (b, to)]: [(&Node, &Side); 2],
    ) -> Option<(Node, Node)> {
        let (mut a, mut b) = (a.clone(), b.clone());
        let mut margins = [from, to].map(|side| self.margin(loops, side));
        // σ falls and rises in proportion to time, no faster than the rows change
        let seen = margins[0] + margins[1];
        let mut slope = seen.max(self.change(loops, [from, to])) / (b.t - a.t);
        let beginnings: Vec<Beginning> =
            (loops.iter().map(|&k| Beginning::at(&from.0[k]))).collect();
        let mut last = from.clone();
        let mut failed = 0;
        let ends = [a.clone(), b.clone()];
        let mut before = vec![(a.t, margins[0])];
        for look in 1..=MAX_LOOKS {
            if margins[0].min(margins[1]) < DEPENDENT_THERE {
                let nearest = if margins[0] < margins[1] {
                    a
                } else {
                    b.clone()
                };
                return Some((b, nearest));
            }
            let width = b.t - a.t;
            if slope * width < PASSED_BY * (margins[0] + margins[1]) {
                let ends = [&ends[0], &ends[1]];
                let hidden = self.hidden_meeting(system, loops, ends, &before)?;
                return Some((hidden.clone(), hidden));
            }
            let part = match look.is_multiple_of(LOOKS_TO_MIDDLE) {
                true => 0.5,
                false => margins[0] / (margins[0] + margins[1]),
            };
            // aside of where there was no state
            let aside = 0.1 * f64::from(failed);
            let t = a.t + (part * (1.0 - aside)).clamp(0.02, 0.98) * width;
            let Some((node, side)) = self.state_between(system, [&a, &b], t) else {
                failed += 1;
                if failed > MAX_FAILURES {
                    return None;
                }
                continue;
            };
            let margin = self.margin(loops, &side);
            let mut ways = beginnings.iter().zip(loops);
            if ways.any(|(beginning, &k)| beginning.has_turned(&side.0[k])) {
                (b, margins[1]) = (node, margin);
            } else {
                slope = slope.max(self.change(loops, [&last, &side]) / (node.t - a.t));
                before.push((node.t, margin));
                (a, margins[0], last) = (node, margin, side);
            }
        }
        None
    }

    /// Finds a position at which rows are dependent before the one where they are seen to turn:
    /// when equal loops turn at once their eigenvalues are known by a root of rounding only, and
    /// signs of small ones are not. `before`: times and margins of states before it, in order.
    fn hidden_meeting(
        &mut self,
        system: &mut System,
        loops: &[usize],
        ends: [&Node; 2],
        before: &[(f64, f64)],
    ) -> Option<Node> {
        let of = |w: &[(f64, f64)]| <[(f64, f64); 3]>::try_from(w).ok();
        let falls_and_rises = |[a, m, b]: &[(f64, f64); 3]| m.1 < a.1.min(b.1);
        let points = before.windows(3).filter_map(of).find(falls_and_rises)?;
        let valley = Valley::of(points);
        let near = NEXT_TO_EACH_OTHER * (points[2].0 - points[0].0);
        let valley = valley.descended(DEPENDENT_THERE, near, NEAR_BOTH, |t| {
            let (_, side) = self.state_between(system, ends, t)?;
            Some(self.margin(loops, &side))
        });
        let (t, least) = valley.lowest();
        let (node, _) = self.state_between(system, ends, t)?;
        (least <= HARDLY_KNOWN).then_some(node)
    }

    /// Returns how far the rows of some loops are from one state to another, each row over its
    /// usual length.
    fn change(&self, loops: &[usize], [from, to]: [&Side; 2]) -> f64 {
        let of = |&k: &usize| {
            let rows = (from.0[k].iter().zip(to.0[k].iter())).zip(&self.usual[k]);
            let squares = rows.map(|((a, b), usual)| {
                let square: f64 = a.iter().zip(b).map(|(a, b)| (b - a) * (b - a)).sum();
                square / usual.max(f64::MIN_POSITIVE).powi(2)
            });
            squares.sum::<f64>().sqrt()
        };
        loops.iter().map(of).fold(0.0, f64::max)
    }
}

/// Sorts rows into loops: those that share coordinates.
pub(super) fn loops(rows: &[usize], entries: &[(usize, usize)], n_v: usize) -> Vec<Loop> {
    // the loop of each coordinate, by its first row
    let mut parent: Vec<usize> = (0..n_v).collect();
    fn root(parent: &[usize], mut k: usize) -> usize {
        while parent[k] != k {
            k = parent[k];
        }
        k
    }
    let mut first = BTreeMap::new();
    for &(r, v) in entries {
        let other = *first.entry(r).or_insert(v);
        let (a, b) = (root(&parent, v), root(&parent, other));
        parent[a.max(b)] = a.min(b);
    }
    let mut loops: BTreeMap<usize, Loop> = BTreeMap::new();
    for &r in rows {
        if let Some(&v) = first.get(&r) {
            loops.entry(root(&parent, v)).or_default().rows.push(r);
        }
    }
    for v in 0..n_v {
        if let Some(l) = loops.get_mut(&root(&parent, v)) {
            l.coordinates.push(v);
        }
    }
    loops.into_values().collect()
}
