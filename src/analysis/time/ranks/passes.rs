//! Passes: positions at which rows become dependent while the mechanism goes through.
//!
//! Between accepted states positions are cubic in time. What the rows determine beyond each other
//! falls and rises on both sides of a pass like the distance from it, so that a pass is located as
//! a root is, and a minimum that is none is seen to be well above zero after a few looks.

use super::{Gradients, active, gradients, margin, norm, place, weakest};
use crate::analysis::start::assemble;
use crate::analysis::system::System;
use crate::scene::configuration::Configured;
use crate::scene::equations::row_name;
use crate::scene::layout::Layout;
use crate::scene::mover::Mover;

/// Smallest part of a row outside the others, relative to its length, at a located position that
/// still counts as dependent: positions are located to the square root of rounding.
pub(super) const DEPENDENT_THERE: f64 = 1e-6;
/// The same at a state, below which a minimum is located.
const LARGEST_MINIMUM: f64 = 0.7;
/// The same at a state that is not closed onto the rows, above which no minimum is located.
const FAR_FROM_DEPENDENT: f64 = 0.8;
/// The same at a minimum found without closing states onto the rows, above which it is none.
const LARGEST_ROUGH_MINIMUM: f64 = 0.01;
/// Change of an angle from one state that is looked at to the next, at most, rad.
const MAX_TURN: f64 = 0.3;
/// Pieces into which a step is divided, at most.
const MAX_PIECES: f64 = 64.0;
/// Time between two passes, at least, as a part of the duration.
const LEAST_DISTANCE: f64 = 1e-4;

/// A position at which rows become dependent while the mechanism passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// time
    pub t: f64,
    /// rows that depend on others there and not nearby
    pub rows: Vec<String>,
    /// coordinates there: (name, value), those of the loops concerned first
    pub place: Vec<(String, f64)>,
}

/// Finds the positions between accepted states of a system at which rows become dependent, those
/// that take part in the configuration of `scene`. `states`: numbers of states in order; `None`
/// separates states that do not follow on.
pub fn passes(scene: Configured<'_>, system: &System, states: &[Option<Vec<f64>>]) -> Vec<Pass> {
    if states.is_empty() {
        return Vec::new();
    }
    let Some(search) = Search::new(scene, system, states) else {
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
        let (run, sizes): (Vec<_>, Vec<_>) = search.refined(&run).into_iter().unzip();
        for k in (0..run.len()).filter(|&k| is_suspect(&run, &sizes, k)) {
            let (before, after) = neighbours(k, run.len());
            let best = [(before, k), (k, after)]
                .into_iter()
                .filter(|(a, b)| a != b)
                .map(|(a, b)| search.least_between(&run[a], &run[b], [sizes[a], sizes[b]]))
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

/// Returns whether the margin may vanish near state `k`: a minimum that is not smooth and well
/// above zero.
fn is_suspect(run: &[Vec<f64>], sizes: &[f64], k: usize) -> bool {
    let (before, after) = neighbours(k, run.len());
    let least = sizes[k] <= sizes[before] && sizes[k] <= sizes[after];
    // of equal neighbours the first
    if !least || sizes[k] > LARGEST_MINIMUM || (k > 0 && sizes[k] == sizes[before]) {
        return false;
    }
    // a smooth minimum, well above what a fall to zero beside it would show
    let fall = (sizes[before] - sizes[k]).max(sizes[after] - sizes[k]);
    // straight on from outside, the two sides would meet at zero between these states
    let slope = |a: usize, b: usize| {
        let h = run[b][Layout::TIME] - run[a][Layout::TIME];
        ((sizes[b] - sizes[a]) / h.max(f64::MIN_POSITIVE)).abs()
    };
    let steep = |a: usize, b: usize| {
        let outer = slope(a.saturating_sub(1), a).max(slope(b, (b + 1).min(run.len() - 1)));
        sizes[a] + sizes[b] <= 1.5 * outer * (run[b][Layout::TIME] - run[a][Layout::TIME])
    };
    sizes[k] <= 1.25 * fall || steep(before, k) || steep(k, after)
}

/// The search for passes of a scene.
struct Search<'s> {
    scene: Configured<'s>,
    gradients: Gradients,
    /// rows that take part
    rows: Vec<usize>,
    /// the longest that each row is on the way   (n_rows)
    usual: Vec<f64>,
}

impl<'s> Search<'s> {
    /// Measures the rows at the states; `None` where no row takes part.
    fn new(scene: Configured<'s>, system: &System, states: &[Option<Vec<f64>>]) -> Option<Self> {
        let gradients = Gradients::of(scene, system)?;
        let mut usual = vec![0.0_f64; scene.rows.len()];
        for n in states.iter().flatten() {
            for (l, rows) in gradients.loops.iter().zip(gradients.at(n)) {
                for (&r, row) in l.rows.iter().zip(rows) {
                    usual[r] = usual[r].max(norm(&row));
                }
            }
        }
        for u in usual.iter_mut().filter(|u| **u == 0.0) {
            *u = 1.0;
        }
        Some(Self {
            scene,
            gradients,
            rows: active(scene),
            usual,
        })
    }

    fn margin(&self, numbers: &[f64]) -> f64 {
        let loops = self.gradients.loops.iter();
        let all = loops.zip(self.gradients.at(numbers));
        all.map(|(l, rows)| margin(rows, l.rows.iter().map(|&r| self.usual[r])))
            .fold(f64::INFINITY, f64::min)
    }

    /// Returns the state at a part `s` of the way between two others: positions cubic in time,
    /// closed onto the rows or not.
    fn between(&self, a: &[f64], b: &[f64], s: f64, closed: bool) -> Vec<f64> {
        let (scene, l) = (self.scene, self.scene.layout);
        let mover = Mover::new(&scene);
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
        if closed {
            let x = n[l.x()].to_vec();
            let mut own = scene.configuration.clone();
            let ignored = |_: Configured<'_>, r: usize| !self.rows.contains(&r);
            assemble::close(&scene, &mut own, n[Layout::TIME], &mut q, &x, ignored);
        }
        n[l.q()].copy_from_slice(&q);
        n
    }

    /// Returns states so close to each other that no angle changes much between them, each with
    /// its margin; closed onto the rows where these are anything like dependent.
    fn refined(&self, run: &[&Vec<f64>]) -> Vec<(Vec<f64>, f64)> {
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
        let with_margin = |n: Vec<f64>| {
            let margin = self.margin(&n);
            (n, margin)
        };
        for pair in run.windows(2) {
            let h = pair[1][Layout::TIME] - pair[0][Layout::TIME];
            let turn = h * speed(pair[0]).max(speed(pair[1]));
            let pieces = (turn / MAX_TURN).ceil().clamp(1.0, MAX_PIECES) as usize;
            all.push(with_margin(pair[0].clone()));
            for k in 1..pieces {
                let s = k as f64 / pieces as f64;
                let mut piece = with_margin(self.between(pair[0], pair[1], s, false));
                if piece.1 < FAR_FROM_DEPENDENT {
                    piece = with_margin(self.between(pair[0], pair[1], s, true));
                }
                all.push(piece);
            }
        }
        all.extend(run.last().map(|n| with_margin((*n).clone())));
        all
    }

    /// Finds the state between two others with the smallest margin, as near as it takes to tell a
    /// pass; `sizes`: the margins of the two.
    fn least_between(&self, a: &[f64], b: &[f64], sizes: [f64; 2]) -> (Vec<f64>, f64) {
        let look = |s: f64, closed: bool| -> (Vec<f64>, f64) {
            let n = self.between(a, b, s, closed);
            let size = self.margin(&n);
            (n, size)
        };
        // first without closing, which is cheap and near enough to see whether it is worth while
        let ends = [(0.0, sizes[0]), (1.0, sizes[1])];
        let rough = Valley::between(ends, |s| look(s, false).1);
        let rough = rough.descended(1e-3, 1e-3, LARGEST_ROUGH_MINIMUM, |s| look(s, false).1);
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
        valley.descended(0.01 * DEPENDENT_THERE, 1e-12, DEPENDENT_THERE, closed);
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

/// Looks at a margin in search of its least value, at most.
const MOST_LOOKS: usize = 60;

/// Slope of a margin between places that have been looked at, over the steepest between these, at
/// most.
const STEEPER: f64 = 6.0;

/// Three places on a way, and the values there of a function that is nowhere negative. Once a
/// minimum is enclosed the function is least at the middle one.
#[derive(Clone, Copy)]
pub(super) struct Valley {
    points: [(f64, f64); 3],
    /// the steepest that the function has been between two places
    steepest: f64,
}

impl Valley {
    /// Holds three places with their values, in order.
    pub fn of(points: [(f64, f64); 3]) -> Self {
        let mut valley = Self {
            points,
            steepest: 0.0,
        };
        valley.note_slopes();
        valley
    }

    /// Lays a place between two others.
    fn between([low, high]: [(f64, f64); 2], mut f: impl FnMut(f64) -> f64) -> Self {
        let middle = 0.5 * (low.0 + high.0);
        Self::of([low, (middle, f(middle)), high])
    }

    /// Returns the place where the function is least, and its value there.
    pub fn lowest(&self) -> (f64, f64) {
        let [a, m, b] = self.points;
        let lower = |x: (f64, f64), y: (f64, f64)| if y.1 < x.1 { y } else { x };
        lower(lower(m, a), b)
    }

    fn place(&self) -> f64 {
        self.lowest().0
    }

    fn least(&self) -> f64 {
        self.lowest().1
    }

    /// Returns how far from its least place the function may vanish, about.
    fn reach(&self) -> f64 {
        2.0 * self.least() / self.steepest.max(f64::MIN_POSITIVE)
    }

    fn note_slopes(&mut self) {
        for pair in self.points.windows(2) {
            let slope = (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
            self.steepest = self.steepest.max(slope.abs());
        }
    }

    /// Returns the least that the function may be between the outer places, at slopes up to
    /// [`STEEPER`] times the steepest that has been seen.
    fn bound(&self) -> f64 {
        let of = |pair: &[(f64, f64)]| {
            let fall = STEEPER * self.steepest * (pair[1].0 - pair[0].0);
            0.5 * (pair[0].1 + pair[1].1 - fall)
        };
        self.points.windows(2).map(of).fold(f64::INFINITY, f64::min)
    }

    /// Looks at further places until the function is no more than `enough`, the outer places are
    /// `near` each other, or nothing between them can be as small as `hopeless`.
    pub fn descended(
        mut self,
        enough: f64,
        near: f64,
        hopeless: f64,
        mut f: impl FnMut(f64) -> f64,
    ) -> Self {
        let width = |points: &[(f64, f64); 3]| points[2].0 - points[0].0;
        let mut by_halves = false;
        for _ in 0..MOST_LOOKS {
            let is_open = width(&self.points) > near && self.least() > enough;
            if !is_open || self.bound().is_nan() || self.bound() > hopeless {
                break;
            }
            let before = width(&self.points);
            let next = self.root().filter(|_| !by_halves);
            let next = next.unwrap_or_else(|| self.aside());
            self.take((next, f(next)));
            // a root that leaves most of the way on one side is followed by a place on that side
            by_halves = !by_halves && width(&self.points) > 0.5 * before;
        }
        self
    }

    /// Returns where a function that changes its sign where this one vanishes would be zero: by the
    /// inverse parabola, the sign of the middle place being the one that makes it straighter.
    fn root(&self) -> Option<f64> {
        let [(a, fa), (m, fm), (b, fb)] = self.points;
        if fa < fm || fb < fm {
            return None;
        }
        let slopes = |fm: f64| [(fm - fa) / (m - a), (-fb - fm) / (b - m)];
        let bend = |fm: f64| {
            let [left, right] = slopes(fm);
            (left - right).abs()
        };
        let (g, low, high) = match bend(fm) <= bend(-fm) {
            true => (fm, m, b),
            false => (-fm, a, m),
        };
        let term = |x: f64, g: f64, [h, k]: [f64; 2]| x * (h / (g - h)) * (k / (g - k));
        let root = term(a, fa, [g, -fb]) + term(m, g, [fa, -fb]) + term(b, -fb, [fa, g]);
        let margin = 1e-3 * (high - low).min(self.reach());
        (root > low + margin && root < high - margin).then_some(root)
    }

    /// Returns a place on the side of the lower end, or of a minimum on its wider side: as far from
    /// it as makes sure that it is enclosed.
    fn aside(&self) -> f64 {
        const GOLDEN: f64 = 0.381_966_011_250_105;
        let [(a, fa), (m, fm), (b, fb)] = self.points;
        let is_enclosed = fm <= fa && fm <= fb;
        let is_right = if is_enclosed { b - m > m - a } else { fb < fa };
        let side = if is_right { b - m } else { a - m };
        let part = match is_enclosed {
            true => (2.0 * self.reach() / side.abs()).min(GOLDEN),
            false => 1.0 - GOLDEN,
        };
        m + part * side
    }

    /// Takes up a place between the outer ones.
    fn take(&mut self, new: (f64, f64)) {
        let [a, m, b] = self.points;
        let is_right = new.0 > m.0;
        // an end that is lower than the middle stays
        let has_lower_end = if is_right { b.1 < m.1 } else { a.1 < m.1 };
        self.points = match (is_right, new.1 < m.1 || has_lower_end) {
            (true, true) => [m, new, b],
            (true, false) => [a, m, new],
            (false, true) => [a, new, m],
            (false, false) => [new, m, b],
        };
        self.note_slopes();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the least value found of a function between 0 and 1, and the number of looks.
    fn least(f: impl Fn(f64) -> f64) -> (f64, usize) {
        let mut looks = 0;
        let mut f = |s: f64| {
            looks += 1;
            f(s)
        };
        let ends = [0.0, 1.0].map(|s| (s, f(s)));
        let valley = Valley::between(ends, &mut f);
        let valley = valley.descended(1e-8, 1e-12, 1e-6, &mut f);
        (valley.least(), looks)
    }

    #[test]
    fn a_pass_is_found_wherever_it_is_and_a_near_miss_is_told_soon() {
        for k in 1..200 {
            let at = f64::from(k) / 200.0 + 1e-4;
            let bent = |s: f64| {
                let x = s - at;
                x.abs() * (1.0 + 0.5 * (2.0 * x).sin())
            };
            let (size, looks) = least(bent);
            assert!(size <= 1e-8 && looks < 30, "{at}: {size:e} after {looks}");
            let missed = |s: f64| bent(s).hypot(1e-3);
            let (size, looks) = least(missed);
            assert!(size > 9e-4 && looks < 30, "{at}: {size:e} after {looks}");
        }
    }

    #[test]
    fn a_function_that_is_nowhere_small_or_has_no_value_ends_the_search() {
        assert!(least(|_| 1.0).1 < 60);
        assert!(least(|s| s).1 < 60);
        assert!(least(|_| f64::NAN).1 < 60);
        assert!(least(|_| 0.0).1 < 60);
    }
}
