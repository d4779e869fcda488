//! Programs that are run over bounds of what they read: of the time, of the unknowns and of their
//! rates.

use crate::expr::program::{Program, Share};
use crate::scalar::{Dual, Interval, Scalar};
use crate::scene::layout::{Layout, LongRow};
use std::collections::BTreeMap;

/// Bounds of a value and of its rate.
pub(in crate::analysis) type Bounds = Dual<1, Interval>;

/// The functions of a system that are watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::analysis) enum What {
    /// those that change sign where a force or a differential equation changes branch
    Switches,
    /// logarithms of narrow factors
    Peaks,
}

/// Functions of a system that can be watched along a step by their bounds.
///
/// Unknowns are numbered: those of the method, then those of loops.
pub(in crate::analysis) trait Watched {
    /// Returns which functions can be bounded, and the unknowns that these read.
    fn bounded(&self) -> (Vec<usize>, Vec<usize>);
    /// Evaluates all functions at the numbers of a state   (n)
    fn values(&mut self, numbers: &[f64], values: &mut [f64]);
    /// Returns the unknowns of loops where the functions were evaluated last.
    fn loop_unknowns(&self) -> &[f64];
    /// Takes bounds of the time, and of unknowns with their rates.
    fn take_bounds(
        &mut self,
        numbers: &[f64],
        time: Interval,
        unknowns: &mut dyn Iterator<Item = (usize, [Interval; 2])>,
    );
    /// Bounds all functions over what bounds were taken last   (n)
    fn bound(&mut self, bounds: &mut [Bounds]);
    /// Bounds one of them.
    fn bound_one(&mut self, k: usize) -> Bounds;
    /// Returns the unknowns that one of them reads.
    fn unknowns_of(&mut self, k: usize) -> Vec<usize>;
}

/// The bounds over which a program is run, and what is known of it over them.
#[derive(Clone, Debug, Default)]
pub(super) struct Bounded {
    /// what it reads, with bounds of what moves and of its rates
    row: Vec<Bounds>,
    /// all of the program, and what single outputs need of it, once they were asked for
    all: Option<Share<Bounds>>,
    shares: BTreeMap<usize, Share<Bounds>>,
}

impl Bounded {
    /// Returns which outputs of a program over a row can be bounded, and the unknowns that these
    /// read: nothing bounds values of the past or closures.
    pub fn of(program: &Program, row: LongRow) -> (Vec<usize>, Vec<usize>) {
        let layout = row.numbers;
        let unbound: Vec<usize> = (layout.downstream())
            .chain(layout.loops())
            .chain(layout.external())
            .collect();
        let unbound = program.outputs_reading(&unbound);
        let bounded: Vec<usize> = (0..unbound.len()).filter(|&k| !unbound[k]).collect();
        let read = |&k: &usize| !bounded.is_empty() && program.reads(unknown_at(row, k));
        let unknowns = (0..layout.n_y() + row.n_more).filter(read).collect();
        (bounded, unknowns)
    }

    /// Takes bounds of the time and of unknowns with their rates; all else that is read are turns
    /// of angles and the sides of switches.
    pub fn take(
        &mut self,
        row: LongRow,
        (numbers, sides): (&[f64], &[f64]),
        time: Interval,
        unknowns: &mut dyn Iterator<Item = (usize, [Interval; 2])>,
    ) {
        let all = &mut self.row;
        all.resize(row.len(), Dual::constant(f64::NAN));
        all[Layout::TIME] = Dual::variable(time, 0);
        for (k, [re, rate]) in unknowns {
            all[unknown_at(row, k)] = Dual { re, eps: [rate] };
        }
        for k in row.numbers.turns() {
            all[k] = Dual::constant(numbers[k]);
        }
        for (place, &side) in all[row.sides()].iter_mut().zip(sides) {
            *place = Dual::constant(side);
        }
    }

    /// Bounds all outputs over what was taken last.
    pub fn all(&mut self, program: &Program, bounds: &mut [Bounds]) {
        let outputs = || (0..program.n_outputs()).collect::<Vec<_>>();
        let all = (self.all).get_or_insert_with(|| Share::of(program, &outputs()));
        all.run(program, &self.row, bounds);
    }

    /// Bounds one of them.
    pub fn one(&mut self, program: &Program, k: usize) -> Bounds {
        let mut bounds = [Bounds::constant(f64::NAN)];
        let share = share_of(&mut self.shares, program, k);
        share.run(program, &self.row, &mut bounds);
        bounds[0]
    }

    /// Returns the unknowns that one of them reads.
    pub fn unknowns_of(&mut self, program: &Program, row: LongRow, k: usize) -> Vec<usize> {
        let (y, more) = (row.numbers.y(), row.more());
        let places = share_of(&mut self.shares, program, k).places();
        let unknown = |place: usize| match place {
            _ if y.contains(&place) => Some(place - y.start),
            _ if more.contains(&place) => Some(y.len() + place - more.start),
            _ => None,
        };
        places.filter_map(unknown).collect()
    }
}

/// Returns the place in the row of an unknown of the method, or of a loop.
fn unknown_at(row: LongRow, k: usize) -> usize {
    match k.checked_sub(row.numbers.n_y()) {
        Some(k) => row.more().start + k,
        None => row.numbers.y_at(k),
    }
}

/// Returns what one output needs of a program.
fn share_of<'s>(
    shares: &'s mut BTreeMap<usize, Share<Bounds>>,
    program: &Program,
    k: usize,
) -> &'s mut Share<Bounds> {
    let share = shares.entry(k);
    share.or_insert_with(|| Share::of(program, &[k]))
}
