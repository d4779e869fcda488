//! The account of energy along an integration.
//!
//! ```text
//! T + V  =  T₀ + V₀ + Σ ∫ P dt          up to the error of the balance
//! ```
//!
//! The integrals are taken step by step at the nodes of the method ([`Method::quadrature`]), so
//! that the balance is as good as the solution: what it lacks is an error of the solution. Where
//! time turns within a step, which moves what no unknown follows, they are taken from turn to
//! turn; where motions leave more open than fifteen nodes of Kronrod's rule, by these. Where
//! motions say where a mechanism is, they are taken along the steps of its path, and the balance is
//! what motions do. Nothing is integrated where gravity alone acts.

use crate::analysis::system::System;
use crate::analysis::time::continuation::Continuation;
use crate::analysis::time::counting::Counting;
use crate::analysis::trajectory::{EnergyFlow, Powers, TOLD_ENERGY};
use crate::numeric::quadrature::{GAUSS_KRONROD_15, Node, over_interpolant};
use crate::numeric::{Failure, Method, Step};

/// Looks at the balance during a simulation, at most about.
const LOOKS: f64 = 64.0;
/// Turn of a driven mechanism, rad, and part of the duration, in which works are integrated at
/// once.
const PIECE: [f64; 2] = [1.0, 1.0 / 32.0];
/// Pieces of a step, at most.
const MAX_PIECES: f64 = 1e5;
/// Difference of two rules for a work, as a part of the work, that is the error permitted.
const WORK_TOLERANCE: f64 = 1e-9;
/// Halvings of an interval, at most: a force may jump within it.
const MAX_HALVED: usize = 10;

/// Begins the account at a state, unless it has begun.
pub(super) fn begin(flow: &mut EnergyFlow, system: &mut System, t: f64, y: &[f64]) {
    if flow.start.is_none() {
        flow.start = system.energy(t, y);
        flow.end = flow.start.unwrap_or_default();
    }
}

/// The account of a mechanism whose motions say where it is: works of forces along the steps of its
/// path, those of motions from the balance. Outputs change nothing; the error is that of the
/// quadrature.
#[derive(Debug, Default)]
pub(super) struct DrivenAccount {
    /// up to where works have been taken, and how fast the mechanism moves there, rad per time
    t: f64,
    pace: f64,
    /// largest piece in which works are integrated at once
    longest: f64,
    flow: EnergyFlow,
    /// the angles that are counted, at the beginning of the last step
    counting: Counting,
    turns: Vec<f64>,
}

impl DrivenAccount {
    /// Begins at the present state of a path, of which all ends at `end`.
    pub fn begin(&mut self, system: &mut System, path: &Continuation, end: f64) {
        let now = path.now();
        (self.t, self.pace) = (now.t, system.pace(now.t, &now.y));
        self.longest = PIECE[1] * (end - now.t);
        begin(&mut self.flow, system, now.t, &now.y);
    }

    /// Takes note of the angles that are counted, where a step of the path begins.
    pub fn begin_step(&mut self, system: &System, counting: &Counting) {
        if system.counts_turns() && !system.scene.forces.is_empty() {
            self.counting.clone_from(counting);
            self.turns.clear();
            (self.turns).extend_from_slice(&system.numbers[system.scene.layout.turns()]);
        }
    }

    /// Takes the works up to a time within the last step of a path.
    pub fn follow(&mut self, system: &mut System, path: &Continuation, to: f64) {
        let from = self.t;
        self.t = to.max(from);
        if to <= from || self.flow.start.is_none() || system.scene.forces.is_empty() {
            return;
        }
        let kept = system.numbers.clone();
        let counts = system.counts_turns();
        if counts {
            let turns = system.scene.layout.turns();
            system.numbers[turns].copy_from_slice(&self.turns);
        }
        let pace = system.pace(to, &path.now().y);
        let fastest = pace.max(std::mem::replace(&mut self.pace, pace));
        let pieces = ((to - from) * (fastest / PIECE[0]).max(1.0 / self.longest)).ceil();
        let n = pieces.clamp(1.0, MAX_PIECES) as u32;
        for k in 0..n {
            let ends = [k, k + 1].map(|k| from + (to - from) * f64::from(k) / f64::from(n));
            if counts {
                (self.counting).count(system, ends[0], &mut path.states());
            }
            let mut power = |t: f64| {
                let state = path.within(system, t).ok();
                let powers = state.and_then(|y| system.powers_of_forces(t, &y));
                powers.unwrap_or([f64::NAN; 3])
            };
            let known: f64 = self.flow.works.iter().map(|w| w.abs()).sum();
            let piece = adaptive(&mut power, ends, known);
            for (work, more) in self.flow.works.iter_mut().zip(piece.works) {
                *work += more;
            }
            self.flow.imbalance += piece.error;
        }
        system.numbers.copy_from_slice(&kept);
    }

    /// Ends the account at a time within the last step of a path.
    pub fn end(&mut self, system: &mut System, path: &Continuation, at: f64) -> EnergyFlow {
        self.follow(system, path, at);
        let there = path.within(system, self.t).ok();
        let energy = there.and_then(|y| system.energy(self.t, &y));
        let flow = &mut self.flow;
        let (Some(start), Some(energy)) = (flow.start, energy) else {
            return *flow;
        };
        flow.end = energy;
        let change: f64 = (0..2).map(|k| energy[k] - start[k]).sum();
        flow.works[3] = change - flow.works[..3].iter().sum::<f64>();
        let sizes = [start[0], energy[0], energy[1] - start[1]];
        let sizes = sizes.iter().chain(&flow.works);
        flow.scale = sizes.fold(0.0, |m, x| m.max(x.abs()));
        *flow
    }
}

/// Works of forces over an interval, and how far they may be off.
struct Piece {
    works: [f64; 3],
    error: f64,
}

/// Integrates powers by the rules of Gauss and Kronrod over ever shorter intervals, until the two
/// differ little beside the work there and what is `known` of all before.
fn adaptive(power: &mut impl FnMut(f64) -> [f64; 3], ends: [f64; 2], known: f64) -> Piece {
    let mut sum = Piece {
        works: [0.0; 3],
        error: 0.0,
    };
    // intervals that are left, and how often each was halved
    let mut left = vec![(ends, 0)];
    while let Some(([a, b], halved)) = left.pop() {
        let Piece { works, error } = by_rules(power, [a, b]);
        let size: f64 = works.iter().map(|w| w.abs()).sum();
        if error > WORK_TOLERANCE * (size + known) && halved < MAX_HALVED {
            let middle = 0.5 * (a + b);
            left.extend([[a, middle], [middle, b]].map(|ends| (ends, halved + 1)));
            continue;
        }
        sum.works.iter_mut().zip(works).for_each(|(s, w)| *s += w);
        sum.error += error;
    }
    sum
}

/// Integrates powers over an interval by Kronrod's rule; the error is how far Gauss' is off it.
fn by_rules(power: &mut impl FnMut(f64) -> [f64; 3], [a, b]: [f64; 2]) -> Piece {
    let (middle, length) = (0.5 * (a + b), b - a);
    let [mut works, mut fewer] = [[0.0; 3]; 2];
    for (half, kronrod, gauss) in GAUSS_KRONROD_15 {
        let mut powers = power(middle - half * length);
        if half > 0.0 {
            let other = power(middle + half * length);
            powers.iter_mut().zip(other).for_each(|(p, o)| *p += o);
        }
        for ((work, less), power) in works.iter_mut().zip(&mut fewer).zip(powers) {
            *work += kronrod * length * power;
            *less += gauss * length * power;
        }
    }
    let error = works.iter().zip(fewer).map(|(w, f)| (w - f).abs()).sum();
    Piece { works, error }
}

/// Parts of a step, and in how many of them a clock may turn for its nodes to see that.
const PARTS: usize = 4;
const FEW_TURNS: usize = 2;
/// Turns within a step from turn to turn of which works are taken, at most: beyond, nothing is said
/// of the balance.
const MOST_TURNS: usize = 256;
/// Works are not known.
const NOT_KNOWN: Failure = Failure {
    what: 0,
    recoverable: false,
};

/// The turns of clocks within a step.
enum Turns {
    /// as few as the nodes of a method see
    Few,
    /// where they are, then the end
    Many(Vec<f64>),
    /// too many
    Unknown,
}

fn turns_within(system: &mut System, [t0, t1]: [f64; 2]) -> Turns {
    let clocks = &mut system.recorded.clocks;
    // what forces do with time, error control has seen
    if system.scene.motions.is_empty() || clocks.are_steady(t0, t1) {
        return Turns::Few;
    }
    let place = |k: usize| t0 + (t1 - t0) * k as f64 / PARTS as f64;
    let mut turn = |&k: &usize| !clocks.are_steady(place(k), place(k + 1));
    if (0..PARTS).filter(&mut turn).count() <= FEW_TURNS {
        return Turns::Few;
    }
    let turns = clocks.turns(t0, t1, MOST_TURNS + 1);
    match turns.last() == Some(&t1) {
        true => Turns::Many(turns),
        false => Turns::Unknown,
    }
}

/// Returns Kronrod's rule of fifteen nodes over [0, 1].
fn kronrod() -> Vec<(f64, f64)> {
    let sides = |&(half, weight, _): &(f64, f64, f64)| {
        let both = [(0.5 - half, weight), (0.5 + half, weight)];
        both.into_iter().skip(usize::from(half == 0.0))
    };
    GAUSS_KRONROD_15.iter().flat_map(sides).collect()
}

/// The account of a leg: scratch, and when the balance is looked at next.
#[derive(Debug, Default)]
pub(super) struct Accountant {
    work: [Vec<f64>; 2],
    due: f64,
    /// the energy at the end of the last step, where motions move something
    last: Option<(f64, [f64; 2])>,
    /// the works of the last step without their signs: what went there and back
    moved: f64,
}

impl Accountant {
    /// Adds an accepted step to the account; returns the energy at its end where that was looked
    /// at.
    pub(super) fn account(
        &mut self,
        flow: &mut EnergyFlow,
        system: &mut System,
        method: &mut dyn Method<System>,
        step: &Step,
        (start, end): (f64, f64),
    ) -> Option<[f64; 2]> {
        flow.start?;
        if system.does_work() {
            let of_step = self.works(flow, system, method, (step, start));
            (flow.works.iter_mut().zip(of_step)).for_each(|(work, more)| *work += more);
            // what forces hold between two looks, or within a step, is part of all energy, too
            let works = flow.works.iter().fold(self.moved, |m, w| m.max(w.abs()));
            flow.scale = flow.scale.max(works);
        }
        if step.t1 < self.due && step.t1 < end {
            return None;
        }
        self.due = step.t1 + (end - start) / LOOKS;
        let energy = match self.last {
            Some((t, energy)) if t == step.t1 => energy,
            _ => system.energy(step.t1, method.y())?,
        };
        flow.look(energy);
        Some(energy)
    }

    /// Returns the works of a step of a leg that began at `start`; not numbers: they are not known.
    fn works(
        &mut self,
        flow: &EnergyFlow,
        system: &mut System,
        method: &mut dyn Method<System>,
        (step, start): (&Step, f64),
    ) -> Powers {
        let ends = [step.t0, step.t1];
        let turns = turns_within(system, ends);
        let few = matches!(turns, Turns::Few);
        let mut of_step = [0.0; 4];
        self.moved = 0.0;
        let visited = match turns {
            Turns::Few => {
                let visit = &mut weigher(&mut of_step, &mut self.moved);
                method.quadrature(system, ends, &mut self.work, visit)
            }
            Turns::Many(times) => self.by_kronrod(system, method, (ends[0], &times), &mut of_step),
            Turns::Unknown => Err(NOT_KNOWN),
        };
        if visited.is_err() {
            return [f64::NAN; 4];
        }
        if !few || system.scene.motions.is_empty() {
            return of_step;
        }
        // no error control has seen what motions do
        let energy = system.energy(step.t1, method.y());
        let last = (self.last).or(flow.start.map(|energy| (start, energy)));
        self.last = energy.map(|energy| (step.t1, energy));
        let (Some((t, before)), Some(energy)) = (last, energy) else {
            return of_step;
        };
        if t != step.t0 {
            return of_step;
        }
        let change = energy[0] - before[0] + energy[1] - before[1];
        let off = |works: &Powers| (change - works.iter().sum::<f64>()).abs();
        if off(&of_step) > TOLD_ENERGY / LOOKS * flow.scale {
            let mut closer = [0.0; 4];
            self.moved = 0.0;
            let visited = self.by_kronrod(system, method, (ends[0], &[ends[1]]), &mut closer);
            if visited.is_ok() && off(&closer) < off(&of_step) {
                return closer;
            }
        }
        of_step
    }

    /// Adds the works of a step by Kronrod's rule from each of some times to the next.
    fn by_kronrod(
        &mut self,
        system: &mut System,
        method: &mut dyn Method<System>,
        (mut from, times): (f64, &[f64]),
        works: &mut Powers,
    ) -> Result<(), Failure> {
        let rule = kronrod();
        times.iter().try_for_each(|&to| {
            let piece = [std::mem::replace(&mut from, to), to];
            let visit = &mut weigher(works, &mut self.moved);
            over_interpolant(method, system, piece, &rule, &mut self.work, visit)
        })
    }
}

/// Returns what adds the powers at a node within a step to works, and without their signs to what
/// has moved.
fn weigher(works: &mut Powers, moved: &mut f64) -> impl FnMut(&mut System, Node<'_>) {
    move |system, node| {
        let powers = system.powers(node).unwrap_or([f64::NAN; 4]);
        for (work, power) in works.iter_mut().zip(powers) {
            *work += node.weight * power;
            *moved += node.weight * power.abs();
        }
    }
}
