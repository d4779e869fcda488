//! Passes: positions at which rows become dependent while the mechanism goes through.
//!
//! Between accepted states positions are cubic in time. What the rows determine beyond each other
//! falls and rises on both sides of a pass like the distance from it, so that a pass is located as
//! a root is, and a minimum that is none is seen to be well above zero after a few looks. A state
//! between two others is put onto the rows only where that may decide anything: what it would
//! change is bounded by how far off it is.

use super::sides::GAP;
use super::valley::Valley;
use super::{Gradients, Rows, active, gradients, margin, norm, place, weakest};
use crate::analysis::start::assemble;
use crate::analysis::system::System;
use crate::analysis::trajectory::Pass;
use crate::expr::program::{Program, Work};
use crate::numeric::control::worst;
use crate::scene::configuration::Configured;
use crate::scene::equations::row_name;
use crate::scene::layout::Layout;
use crate::scene::mover::Mover;
use std::cell::{OnceCell, RefCell};

/// Smallest part of a row outside the others, relative to its length, at a located position that
/// still counts as dependent: positions are located to the square root of rounding.
pub(super) const DEPENDENT_THERE: f64 = 1e-6;
/// The same at a state, below which a minimum is located.
const LARGEST_MINIMUM: f64 = 0.7;
/// The same at a state that is not closed onto the rows, above which no minimum is located.
const FAR_FROM_DEPENDENT: f64 = 0.8;
/// The same at a minimum found without closing states onto the rows, above which it is none.
const LARGEST_ROUGH_MINIMUM: f64 = 0.01;
/// Change of a margin by closing a state, over the violation of its rows beside the margin, at
/// most: the derivatives of rows are about one.
const CHANGE_BY_CLOSING: f64 = 100.0;
/// Change of an angle from one state that is looked at to the next, at most, rad.
const MAX_TURN: f64 = 0.3;
/// Pieces into which a step is divided, at most.
const MAX_PIECES: f64 = 64.0;
/// Time between two passes, at least, as a part of the duration.
const LEAST_DISTANCE: f64 = 1e-4;

/// Cubes of the velocities, summed over states, up to which passes are looked for: some seconds.
const MOST_WORK: f64 = 1e9;

/// Finds the positions between accepted states of a system at which rows become dependent, those
/// that take part in the configuration of `scene`. `states`: numbers of states in order; `None`
/// separates states that do not follow on. Where so many states of so large a system would take too
/// long, none is looked for.
pub fn passes(scene: Configured<'_>, system: &System, states: &[Option<Vec<f64>>]) -> Vec<Pass> {
    let work = (scene.layout.n_v as f64).powi(3) * states.len() as f64;
    if states.is_empty() || work > MOST_WORK {
        return Vec::new();
    }
    let Some((search, mut measured)) = Search::new(scene, system, states) else {
        return Vec::new();
    };
    let most = match scene.layout.n_v {
        0..13 => 64,
        13..31 => 16,
        _ => 3,
    };
    let mut times = states.iter().flatten().map(|n| n[Layout::TIME]);
    let first = times.next().unwrap_or(0.0);
    let duration = times.next_back().unwrap_or(first) - first;
    let mut found: Vec<Pass> = Vec::new();
    for run in states.split(Option::is_none) {
        let run: Vec<&Vec<f64>> = run.iter().flatten().collect();
        let mut looks = search.refined(&run, measured.by_ref().take(run.len()));
        for k in 0..looks.len() {
            if !search.is_suspect(&mut looks, k) {
                continue;
            }
            let (before, after) = neighbours(k, looks.len());
            let best = [(before, k), (k, after)]
                .into_iter()
                .filter(|(a, b)| a != b)
                .map(|(a, b)| search.least_between([&looks[a], &looks[b]]))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((at, size)) = best else { continue };
            let last = found.last();
            let new =
                last.is_none_or(|p| (p.t - at[Layout::TIME]).abs() > LEAST_DISTANCE * duration);
            if size < DEPENDENT_THERE && new {
                found.push(search.pass(&at));
            }
            if found.len() >= most {
                return found;
            }
        }
    }
    found
}

fn neighbours(k: usize, n: usize) -> (usize, usize) {
    (k.saturating_sub(1), (k + 1).min(n - 1))
}

/// A state on the way, and its margin.
struct Look<'r> {
    numbers: Vec<f64>,
    /// bounds of the margin: one number where it is known
    margin: [f64; 2],
    /// of a state that is not closed onto the rows: those between which it lies, and where
    open: Option<([&'r [f64]; 2], f64)>,
}

impl Look<'_> {
    /// Returns the margin of a closed state.
    fn size(&self) -> f64 {
        self.margin[0]
    }
}

/// Returns whether the margin may vanish near state `k`: a minimum that is not smooth and well
/// above zero.
fn may_vanish(looks: &[Look<'_>], k: usize) -> bool {
    let (before, after) = neighbours(k, looks.len());
    let [low, high] = [0, 1].map(|side| move |k: usize| looks[k].margin[side]);
    let least = low(k) <= high(before) && low(k) <= high(after);
    // of equal neighbours the first
    let is_second = k > 0 && low(k) == high(before) && high(k) == low(before);
    if !least || low(k) > LARGEST_MINIMUM || is_second {
        return false;
    }
    // a smooth minimum, well above what a fall to zero beside it would show
    let fall = (high(before) - low(k)).max(high(after) - low(k));
    // straight on from outside, the two sides would meet at zero between these states
    let time = |k: usize| looks[k].numbers[Layout::TIME];
    let slope = |a: usize, b: usize| {
        let change = (high(b) - low(a)).abs().max((low(b) - high(a)).abs());
        change / (time(b) - time(a)).max(f64::MIN_POSITIVE)
    };
    let steep = |a: usize, b: usize| {
        let outer = slope(a.saturating_sub(1), a).max(slope(b, (b + 1).min(looks.len() - 1)));
        low(a) + low(b) <= 1.5 * outer * (time(b) - time(a))
    };
    low(k) <= 1.25 * fall || steep(before, k) || steep(k, after)
}

/// The search for passes of a scene.
struct Search<'s> {
    scene: Configured<'s>,
    gradients: Gradients,
    mover: Mover,
    /// rows that take part
    rows: Vec<usize>,
    /// the longest that each row is on the way   (n_rows)
    usual: Vec<f64>,
    /// values of all rows   (n_rows)
    values: &'s Program,
    work: RefCell<Work>,
    /// whose recorded projections go onto these rows and change positions alone, if they do
    projects: Option<&'s System>,
    /// a copy of it to work with, made where a state is to be closed
    copy: OnceCell<RefCell<System>>,
}

impl<'s> Search<'s> {
    /// Prepares the search, with the rows at each state, by loops; `None` where no row takes part.
    fn new(
        scene: Configured<'s>,
        system: &'s System,
        states: &[Option<Vec<f64>>],
    ) -> Option<(Self, std::vec::IntoIter<Vec<Rows>>)> {
        let gradients = Gradients::of(scene, system)?;
        let mut usual = vec![0.0_f64; scene.rows.len()];
        let states = states.iter().flatten();
        let measured: Vec<Vec<Rows>> = states.map(|n| gradients.at(n)).collect();
        for (l, rows) in measured
            .iter()
            .flat_map(|all| gradients.loops.iter().zip(all))
        {
            for (&r, row) in l.rows.iter().zip(rows.iter()) {
                usual[r] = usual[r].max(norm(row));
            }
        }
        for u in usual.iter_mut().filter(|u| **u == 0.0) {
            *u = 1.0;
        }
        let search = Self {
            scene,
            gradients,
            mover: Mover::new(&scene),
            rows: active(scene),
            usual,
            values: system.row_values(),
            work: RefCell::default(),
            projects: (scene.configuration.active == system.configuration.active
                && system.projects_positions_alone())
            .then_some(system),
            copy: OnceCell::new(),
        };
        Some((search, measured.into_iter()))
    }

    /// Returns bounds of the margin of a state that is not closed, once it is: from the violation
    /// of its rows, against their usual length.
    fn margin_if_closed(&self, numbers: &[f64], margin: f64) -> [f64; 2] {
        let mut values = vec![0.0; self.scene.rows.len()];
        (self.values).run(numbers, &mut self.work.borrow_mut(), &mut values);
        let one = |r: usize| self.scene.row_scale(r) * self.usual[r];
        let violation = worst(self.rows.iter().map(|&r| (values[r] / one(r)).abs()));
        let change = CHANGE_BY_CLOSING * violation / margin;
        match change.is_finite() && self.scene.cams.is_empty() {
            true => [margin - change, margin + change],
            false => [0.0, f64::INFINITY],
        }
    }

    /// Returns whether the margin may vanish near look `k`; the looks that tell are closed onto the
    /// rows.
    fn is_suspect(&self, looks: &mut [Look<'_>], k: usize) -> bool {
        while may_vanish(looks, k) {
            let beside = k.saturating_sub(2)..(k + 3).min(looks.len());
            let Some(open) = beside.into_iter().find(|&k| looks[k].open.is_some()) else {
                return true;
            };
            let look = &mut looks[open];
            if let Some(([a, b], s)) = look.open.take() {
                look.numbers = self.between(a, b, s, true);
                look.margin = [self.margin(&look.numbers); 2];
            }
        }
        false
    }

    /// Returns the least that any row of a loop determines beyond the others at a state, over its
    /// usual length: zero where they are dependent.
    fn margin(&self, numbers: &[f64]) -> f64 {
        self.margin_of(self.gradients.at(numbers))
    }

    /// Returns the margin of rows, by loops.
    fn margin_of(&self, rows: Vec<Rows>) -> f64 {
        let all = self.gradients.loops.iter().zip(rows);
        all.map(|(l, mut rows)| {
            for (row, &r) in rows.iter_mut().zip(&l.rows) {
                row.iter_mut().for_each(|x| *x /= self.usual[r]);
            }
            margin(rows)
        })
        .fold(f64::INFINITY, f64::min)
    }

    /// Returns the state at a part `s` of the way between two others: positions cubic in time,
    /// closed onto the rows or not.
    fn between(&self, a: &[f64], b: &[f64], s: f64, closed: bool) -> Vec<f64> {
        let l = self.scene.layout;
        let mover = &self.mover;
        let h = b[Layout::TIME] - a[Layout::TIME];
        let rate = |n: &[f64]| {
            let mut rate = vec![0.0; l.n_q];
            mover.untangent(&n[l.q()], &n[l.v()], &mut rate);
            rate
        };
        let (rate_a, rate_b) = (rate(a), rate(b));
        let mut n: Vec<f64> = a.iter().zip(b).map(|(a, b)| a + s * (b - a)).collect();
        n[Layout::TIME] = a[Layout::TIME] + s * h;
        let mut q: Vec<f64> = l
            .q()
            .enumerate()
            .map(|(k, place)| {
                let (p, d) = (a[place], b[place] - a[place]);
                let (m0, m1) = (h * rate_a[k], h * rate_b[k]);
                p + s * (m0 + s * (3.0 * d - 2.0 * m0 - m1 + s * (m0 + m1 - 2.0 * d)))
            })
            .collect();
        mover.normalize(&mut q);
        n[l.q()].copy_from_slice(&q);
        if closed {
            self.close(&mut n);
        }
        n
    }

    /// Puts the positions of a state onto the rows: by the projections of the steps, and where
    /// these find none as assembly does.
    fn close(&self, numbers: &mut [f64]) {
        let (scene, l) = (self.scene, self.scene.layout);
        let t = numbers[Layout::TIME];
        if let Some(original) = self.projects {
            let copy = self.copy.get_or_init(|| RefCell::new(original.clone()));
            let mut system = copy.borrow_mut();
            let mut y = numbers[l.y()].to_vec();
            system.project_anew();
            if system.put_on_rows(t, &mut y).is_ok() {
                let there = system.numbers_at(t, &y);
                if system.worst_gap(&there) <= GAP {
                    numbers[l.q()].copy_from_slice(l.state(&y).q);
                    return;
                }
            }
        }
        let (mut q, x) = (numbers[l.q()].to_vec(), numbers[l.x()].to_vec());
        let mut own = scene.configuration.clone();
        let ignored = |_: Configured<'_>, r: usize| !self.rows.contains(&r);
        assemble::close(&scene, &mut own, t, &mut q, &x, ignored);
        numbers[l.q()].copy_from_slice(&q);
    }

    /// Returns states so close to each other that no angle changes much between them, each with
    /// its margin. Those between two others are still to be closed onto the rows where these are
    /// anything like dependent. `measured`: the rows at the states of the run.
    fn refined<'r>(
        &self,
        run: &[&'r Vec<f64>],
        measured: impl Iterator<Item = Vec<Rows>>,
    ) -> Vec<Look<'r>> {
        let (scene, l) = (self.scene, self.scene.layout);
        let turning: Vec<usize> = (scene.coordinates.iter().zip(&scene.freedoms))
            .filter(|(c, _)| c.angular)
            .filter_map(|(_, f)| f.v)
            .collect();
        let speed = |n: &[f64]| {
            let speeds = turning.iter().map(|&v| n[l.v()][v].abs());
            speeds.fold(0.0, f64::max)
        };
        let mut all = Vec::new();
        let mut closed = run.iter().zip(measured).map(|(n, rows)| Look {
            numbers: n.to_vec(),
            margin: [self.margin_of(rows); 2],
            open: None,
        });
        for pair in run.windows(2) {
            let (a, b): (&'r [f64], &'r [f64]) = (pair[0], pair[1]);
            let h = b[Layout::TIME] - a[Layout::TIME];
            let turn = h * speed(a).max(speed(b));
            let pieces = (turn / MAX_TURN).ceil().clamp(1.0, MAX_PIECES) as usize;
            all.extend(closed.next());
            for k in 1..pieces {
                let s = k as f64 / pieces as f64;
                let numbers = self.between(a, b, s, false);
                let margin = self.margin(&numbers);
                let is_open = margin < FAR_FROM_DEPENDENT;
                all.push(Look {
                    margin: match is_open {
                        true => self.margin_if_closed(&numbers, margin),
                        false => [margin; 2],
                    },
                    numbers,
                    open: is_open.then_some(([a, b], s)),
                });
            }
        }
        all.extend(closed);
        all
    }

    /// Finds the state between two others with the smallest margin, as near as it takes to tell a
    /// pass.
    fn least_between(&self, ends: [&Look<'_>; 2]) -> (Vec<f64>, f64) {
        let ([a, b], sizes) = (ends.map(|e| &e.numbers[..]), ends.map(Look::size));
        let look = |s: f64, closed: bool| -> (Vec<f64>, f64) {
            let n = self.between(a, b, s, closed);
            let size = self.margin(&n);
            (n, size)
        };
        // first without closing, which is cheap and near enough to see whether it is worth while
        let ends = [(0.0, sizes[0]), (1.0, sizes[1])];
        let rough = Valley::between(ends, |s| look(s, false).1);
        let look_again = |s: f64| Some(look(s, false).1);
        let rough = rough.descended(1e-3, 1e-3, LARGEST_ROUGH_MINIMUM, look_again);
        let mut best = (a.to_vec(), rough.least());
        if rough.least() > LARGEST_ROUGH_MINIMUM {
            return best;
        }
        let wide = rough.reach().max(0.02);
        let ends = [
            (rough.place() - wide).max(0.0),
            (rough.place() + wide).min(1.0),
        ];
        best.1 = f64::INFINITY;
        let mut closed = |s: f64| {
            let (n, size) = look(s, true);
            if size < best.1 {
                best = (n, size);
            }
            size
        };
        let valley = Valley::between(ends.map(|s| (s, closed(s))), &mut closed);
        valley.descended(0.01 * DEPENDENT_THERE, 1e-12, DEPENDENT_THERE, |s| {
            Some(closed(s))
        });
        best
    }

    /// Describes a position at which rows are dependent.
    fn pass(&self, numbers: &[f64]) -> Pass {
        let scene = self.scene;
        let all = gradients(scene, numbers);
        let weakest = weakest(&scene, &all, &self.rows, &self.usual);
        let (unit, touched) = weakest.map_or_else(
            || (Vec::new(), vec![true; scene.layout.n_v]),
            |w| (w.unit, w.touched),
        );
        let most = unit.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
        // the row that comes last in the combination is the one that would be left out
        let last = (0..unit.len()).rev().find(|&k| unit[k].abs() > 0.1 * most);
        let name = |k: usize| row_name(&scene.rows[self.rows[k]]);
        Pass {
            t: numbers[Layout::TIME],
            rows: last.map(name).into_iter().collect(),
            place: place(&scene, numbers, &touched),
        }
    }
}
