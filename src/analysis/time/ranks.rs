//! Rank while a mechanism moves: where rows become dependent in passing, which rows to keep when others say it better, why a drive can go no further.
//!
//! Three things can happen to rows that were independent at the start. They may become dependent at one position and be independent again beyond it
//! (a folded parallelogram): the solver passes, and the position is found and told afterwards. Rows that were left out may say better what some of the rest
//! say (the two coordinates of a pin that turns): the choice is made anew. And a drive may ask for what no position near satisfies: the mechanism is locked.

use crate::analysis::start::assemble::{self, DEPENDENT, Mover};
use crate::expr::program::{Program, Work};
use crate::scene::configuration::Configured;
use crate::scene::equations::row_name;
use crate::scene::layout::Layout;
use crate::scene::programs::{record, weights};
use crate::scene::{Scene, Source};
use nalgebra::DMatrix;
use std::cell::RefCell;

/// A position at which rows become dependent while the mechanism passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// when
    pub t: f64,
    /// rows that depend on others there and not nearby
    pub rows: Vec<String>,
    /// coordinates there: (name, value), those of the loops concerned first
    pub place: Vec<(String, f64)>,
}

/// Smallest part of a row outside the others, relative to its length, at a located position that still counts as dependent: positions are located to
/// the square root of rounding.
const PASSED: f64 = 1e-6;
/// A minimum between neighbours is looked at more closely when it is below this.
const SUSPECT: f64 = 0.7;
/// How little a combination of rows moves where a mechanism counts as locked, against the longest row: near a reach it falls with the square root of the way left.
const NEARLY: f64 = 0.02;
/// A minimum found without closing states onto the rows is none when it is larger than this.
const ROUGH: f64 = 0.01;
/// Angles may change by this much, in rad, from one state that is looked at to the next.
const TURN: f64 = 0.3;
/// States kept to find such positions, at most, in any mechanism.
const MOST_STATES: f64 = 2000.0;
/// States kept, at least.
const LEAST_STATES: f64 = 60.0;

/// Returns how many states are kept to find positions at which rows become dependent: looking at one
/// costs the cube of the number of velocities.
pub fn states_kept(n_v: usize) -> f64 {
    (1e8 / (n_v as f64).powi(3)).clamp(LEAST_STATES, MOST_STATES)
}

/// Rows that take part.
fn active(scene: Configured<'_>) -> Vec<usize> {
    scene.configuration.active_rows().collect()
}

/// Gradients of the rows of a scene, recorded once and evaluated often.
struct Gradients {
    program: Program,
    /// row and velocity of each value
    places: Vec<(usize, usize)>,
    work: RefCell<Work>,
    /// scales of the columns, and what counts as one for each row
    columns: Vec<f64>,
    rows: Vec<f64>,
}

impl Gradients {
    fn of(scene: Configured<'_>) -> Option<Self> {
        let mut places = Vec::new();
        let program = record(scene, |at| {
            let mut values = Vec::new();
            for r in 0..scene.rows.len() {
                for (v, x) in at.row(r).gradient {
                    places.push((r, v));
                    values.push(x);
                }
            }
            values
        });
        Some(Self {
            program: program.ok()?,
            places,
            work: RefCell::default(),
            columns: weights(&scene).iter().map(|w| w.sqrt()).collect(),
            rows: (0..scene.rows.len())
                .map(|r| assemble::natural(&scene, r))
                .collect(),
        })
    }

    /// All rows, columns scaled, each row against what counts as one for it.
    fn at(&self, numbers: &[f64]) -> Vec<Vec<f64>> {
        let mut values = vec![0.0; self.places.len()];
        self.program
            .run(numbers, &mut self.work.borrow_mut(), &mut values);
        let mut all = vec![vec![0.0; self.columns.len()]; self.rows.len()];
        for (&(r, v), x) in self.places.iter().zip(values) {
            all[r][v] += x * self.columns[v] / self.rows[r];
        }
        all
    }
}

/// All rows at one place, as [`Gradients::at`] gives them.
fn gradients(scene: Configured<'_>, numbers: &[f64]) -> Vec<Vec<f64>> {
    let l = scene.layout;
    let (_, gradient, _) = assemble::rows_at(
        scene,
        numbers[Layout::TIME],
        &numbers[l.q()],
        &numbers[l.x()],
    );
    let mut all = assemble::scaled_rows(&gradient, &weights(&scene));
    for (r, row) in all.iter_mut().enumerate() {
        let one = assemble::natural(&scene, r);
        row.iter_mut().for_each(|x| *x /= one);
    }
    all
}

/// Rows chosen one after the other by what they say beyond those before, the preferred ones unless another says three times as much; and the least that any
/// of them said. Unlike in `numeric::rank` a short row says little.
fn select(
    mut rows: Vec<Vec<f64>>,
    preferred: impl Fn(usize) -> bool,
    most: usize,
) -> (Vec<usize>, f64) {
    let (mut chosen, mut least) = (Vec::new(), f64::INFINITY);
    let mut open: Vec<usize> = (0..rows.len()).collect();
    while chosen.len() < most {
        let size = |r: usize| norm(&rows[r]);
        let larger = |a: &&usize, b: &&usize| size(**a).total_cmp(&size(**b));
        let Some(&largest) = open.iter().max_by(larger) else {
            break;
        };
        let best = open.iter().filter(|r| preferred(**r)).max_by(larger);
        let pivot = match best {
            Some(&r) if size(r) > size(largest) / 3.0 => r,
            _ => largest,
        };
        let length = size(pivot);
        if length.is_nan() || length < DEPENDENT {
            break;
        }
        least = least.min(length);
        open.retain(|r| *r != pivot);
        let unit: Vec<f64> = rows[pivot].iter().map(|x| x / length).collect();
        for &r in &open {
            // twice, so that nothing is left of it but rounding
            for _ in 0..2 {
                let along: f64 = rows[r].iter().zip(&unit).map(|(a, b)| a * b).sum();
                rows[r]
                    .iter_mut()
                    .zip(&unit)
                    .for_each(|(a, b)| *a -= along * b);
            }
        }
        chosen.push(pivot);
    }
    chosen.sort_unstable();
    (chosen, least)
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The least that any of the rows says beyond the others: zero where they are dependent. `usual`: what a row's length is elsewhere.
fn margin(all: &[Vec<f64>], rows: &[usize], usual: &[f64]) -> f64 {
    let scaled = rows
        .iter()
        .map(|&r| all[r].iter().map(|x| x / usual[r]).collect())
        .collect();
    let (chosen, least) = select(scaled, |_| false, rows.len());
    if chosen.len() < rows.len() {
        0.0
    } else {
        least
    }
}

/// The rows to keep from here on, when those kept so far have become dependent though the mechanism has not, or a row that was left out no longer
/// follows from them; `None`: they may stay.
pub fn better_rows(scene: Configured<'_>, numbers: &[f64]) -> Option<Vec<bool>> {
    let kept = active(scene);
    let all = gradients(scene, numbers);
    let own = kept.iter().map(|&r| all[r].clone()).collect();
    let (stay, least) = select(own, |_| true, kept.len());
    let (better, most) = select(all, |r| kept.contains(&r), usize::MAX);
    if better == kept || better.len() < kept.len() {
        return None;
    }
    let gains = better.len() > kept.len() || stay.len() < kept.len() || least < 0.3 * most;
    gains.then(|| (0..scene.rows.len()).map(|r| better.contains(&r)).collect())
}

/// Moves a state onto all rows, also those that were left out, where that is possible with a small change.
pub fn repair(scene: Configured<'_>, numbers: &mut [f64]) -> bool {
    let l = scene.layout;
    let t = numbers[Layout::TIME];
    let x = numbers[l.x()].to_vec();
    let mut q = numbers[l.q()].to_vec();
    let mut own = scene.configuration.clone();
    let closed = assemble::close(&scene, &mut own, t, &mut q, &x, |_, _| false);
    if closed.size.is_nan() || closed.size > assemble::CLOSED {
        return false;
    }
    let v = assemble::nearest_velocities(scene, t, &q, &x, &numbers[l.v()]);
    numbers[l.q()].copy_from_slice(&q);
    numbers[l.v()].copy_from_slice(&v);
    true
}

/// Positions between accepted states at which rows become dependent. `states`: numbers of states in order; `None` separates what does not follow on.
pub fn passes(scene: Configured<'_>, states: &[Option<Vec<f64>>]) -> Vec<Pass> {
    let rows = active(scene);
    let mut found = Vec::new();
    let Some(gradients) = Gradients::of(scene).filter(|_| !rows.is_empty()) else {
        return found;
    };
    let most = match scene.layout.n_v {
        0..13 => 64,
        13..31 => 16,
        _ => 3,
    };
    let mut times = states.iter().flatten().map(|n| n[Layout::TIME]);
    let first = times.next().unwrap_or(0.0);
    let duration = times.next_back().unwrap_or(first) - first;
    // the longest that each row is on the way
    let mut usual = vec![0.0_f64; scene.rows.len()];
    for n in states.iter().flatten() {
        for (u, row) in usual.iter_mut().zip(gradients.at(n)) {
            *u = u.max(norm(&row));
        }
    }
    usual
        .iter_mut()
        .filter(|u| **u == 0.0)
        .for_each(|u| *u = 1.0);
    for run in states.split(Option::is_none) {
        let run: Vec<&Vec<f64>> = run.iter().flatten().collect();
        let run = refined(scene, &run, &rows);
        let sizes: Vec<f64> = run
            .iter()
            .map(|n| margin(&gradients.at(n), &rows, &usual))
            .collect();
        for k in 0..run.len() {
            let (before, after) = (k.saturating_sub(1), (k + 1).min(run.len() - 1));
            let least = sizes[k] <= sizes[before] && sizes[k] <= sizes[after];
            // of equal neighbours the first
            if !least || sizes[k] > SUSPECT || (k > 0 && sizes[k] == sizes[before]) {
                continue;
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
            if sizes[k] > 1.25 * fall && !steep(before, k) && !steep(k, after) {
                continue;
            }
            let sides = [(before, k), (k, after)];
            let best = sides
                .into_iter()
                .filter(|(a, b)| a != b)
                .map(|(a, b)| least_between(scene, &gradients, (&run[a], &run[b]), &rows, &usual))
                .min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((at, size)) = best else { continue };
            let new = found
                .last()
                .is_none_or(|p: &Pass| (p.t - at[Layout::TIME]).abs() > 1e-4 * duration);
            if size < PASSED && new {
                found.push(pass(scene, &at, &rows, &usual));
            }
            if found.len() >= most {
                return found;
            }
        }
    }
    found
}

/// The state at a part `s` of the way between two others: positions cubic in time, closed onto `rows`.
fn between(
    scene: Configured<'_>,
    a: &[f64],
    b: &[f64],
    s: f64,
    rows: Option<&[usize]>,
) -> Vec<f64> {
    let l = scene.layout;
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
    if let Some(rows) = rows {
        let x = n[l.x()].to_vec();
        let mut own = scene.configuration.clone();
        assemble::close(&scene, &mut own, n[Layout::TIME], &mut q, &x, |_, r| {
            !rows.contains(&r)
        });
    }
    n[l.q()].copy_from_slice(&q);
    n
}

/// States so close to each other that no angle changes much between them.
fn refined(scene: Configured<'_>, run: &[&Vec<f64>], rows: &[usize]) -> Vec<Vec<f64>> {
    let l = scene.layout;
    let turning: Vec<usize> = (scene.coordinates.iter().zip(&scene.freedoms))
        .filter(|(c, _)| c.angular)
        .filter_map(|(_, f)| f.v)
        .collect();
    let mut all = Vec::new();
    for pair in run.windows(2) {
        let h = pair[1][Layout::TIME] - pair[0][Layout::TIME];
        let speed = |n: &[f64]| {
            turning
                .iter()
                .fold(0.0, |m: f64, &v| m.max(n[l.v()][v].abs()))
        };
        let turn = h * speed(pair[0]).max(speed(pair[1]));
        let pieces = (turn / TURN).ceil().clamp(1.0, 64.0) as usize;
        all.push(pair[0].clone());
        for k in 1..pieces {
            let s = k as f64 / pieces as f64;
            all.push(between(scene, pair[0], pair[1], s, Some(rows)));
        }
    }
    all.extend(run.last().map(|n| (*n).clone()));
    all
}

/// The state between two others with the smallest margin, by golden sections.
fn least_between(
    scene: Configured<'_>,
    gradients: &Gradients,
    (a, b): (&[f64], &[f64]),
    rows: &[usize],
    usual: &[f64],
) -> (Vec<f64>, f64) {
    let look = |s: f64, closed: bool| -> (Vec<f64>, f64) {
        let n = between(scene, a, b, s, closed.then_some(rows));
        let size = margin(&gradients.at(&n), rows, usual);
        (n, size)
    };
    // first without closing, which is cheap and near enough to see whether it is worth while
    let (low, high, rough) = golden(|s| look(s, false).1, (0.0, 1.0), 1e-3);
    let mut best = (a.to_vec(), rough);
    if rough > ROUGH {
        return best;
    }
    let wide = (high - low).max(0.02);
    golden(
        |s| {
            let (n, size) = look(s, true);
            if size < best.1 || best.1 == rough {
                best = (n, size);
            }
            size
        },
        ((low - wide).max(0.0), (high + wide).min(1.0)),
        0.01 * PASSED,
    );
    best
}

/// The bracket and the value of a minimum; ends when the value or the bracket is small.
fn golden(
    mut f: impl FnMut(f64) -> f64,
    (mut low, mut high): (f64, f64),
    enough: f64,
) -> (f64, f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let (mut s1, mut s2) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut f1, mut f2) = (f(s1), f(s2));
    while high - low > 1e-12 && f1.min(f2) > enough {
        if f1 < f2 {
            (high, s2, f2) = (s2, s1, f1);
            s1 = high - GOLDEN * (high - low);
            f1 = f(s1);
        } else {
            (low, s1, f1) = (s1, s2, f2);
            s2 = low + GOLDEN * (high - low);
            f2 = f(s2);
        }
        if enough > PASSED && high - low < 1e-3 {
            break;
        }
    }
    (low, high, f1.min(f2))
}

/// What a position at which rows are dependent is.
fn pass(scene: Configured<'_>, numbers: &[f64], rows: &[usize], usual: &[f64]) -> Pass {
    let all = gradients(scene, numbers);
    let (unit, touched) = weakest(&scene, &all, rows, usual).map_or_else(
        || (Vec::new(), vec![true; scene.layout.n_v]),
        |w| (w.unit, w.touched),
    );
    let most = unit.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
    // the row that comes last in the combination is the one that would be left out
    let last = (0..unit.len()).rev().find(|&k| unit[k].abs() > 0.1 * most);
    Pass {
        t: numbers[Layout::TIME],
        rows: last
            .map(|k| row_name(&scene.rows[rows[k]]))
            .into_iter()
            .collect(),
        place: place(&scene, numbers, &touched),
    }
}

/// The combination of rows that moves least.
struct Weakest {
    /// factors of the rows, each against its usual length
    unit: Vec<f64>,
    /// how much it moves
    size: f64,
    /// coordinates that its rows read
    touched: Vec<bool>,
}

fn weakest(scene: &Scene, all: &[Vec<f64>], rows: &[usize], usual: &[f64]) -> Option<Weakest> {
    let (m, n) = (rows.len(), scene.layout.n_v);
    let a = DMatrix::from_fn(m, n, |i, j| all[rows[i]][j] / usual[rows[i]]);
    let eigen = nalgebra::SymmetricEigen::try_new(&a * a.transpose(), 1e-15, 10_000)?;
    let least = (0..m).min_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]))?;
    let unit: Vec<f64> = eigen.eigenvectors.column(least).iter().copied().collect();
    let mut touched = vec![false; n];
    for i in (0..m).filter(|&i| unit[i].abs() > 1e-3) {
        for (t, x) in touched.iter_mut().zip(&all[rows[i]]) {
            *t |= x.abs() > DEPENDENT;
        }
    }
    Some(Weakest {
        unit,
        size: eigen.eigenvalues[least].max(0.0).sqrt(),
        touched,
    })
}

/// Values of coordinates, those that are `touched` first.
fn place(scene: &Scene, numbers: &[f64], touched: &[bool]) -> Vec<(String, f64)> {
    let q = &numbers[scene.layout.q()];
    let mut all: Vec<(bool, String, f64)> = (scene.coordinates.iter().zip(&scene.freedoms))
        .filter(|(_, f)| !f.in_ball)
        .filter_map(|(c, _)| match c.source {
            Source::Free { q: place, v } => Some((!touched[v], c.name.clone(), q[place])),
            Source::Driven(_) => None,
        })
        .collect();
    all.sort_by_key(|c| c.0);
    all.into_iter().map(|(_, name, x)| (name, x)).collect()
}

/// Why the rows can be kept no longer near a state, with the row that is worst.
#[derive(Clone, Debug, PartialEq)]
pub struct Lock {
    /// "JOINT/4 D.Xg"
    pub row: String,
    /// user's number of the MOTION that drives against the rows, where one does
    pub motion: Option<u32>,
    /// coordinates there
    pub place: Vec<(String, f64)>,
}

/// Whether a mechanism is (nearly) locked at a state: rows are nearly dependent there, and what drives asks for what they forbid.
pub fn locked(scene: Configured<'_>, numbers: &[f64]) -> Option<Lock> {
    let l = scene.layout;
    let rows = active(scene);
    let (t, q, x) = (numbers[Layout::TIME], &numbers[l.q()], &numbers[l.x()]);
    let all = gradients(scene, numbers);
    let m = rows.len();
    // rows that have become short here are compared with the longest
    let longest = rows.iter().map(|&r| norm(&all[r])).fold(0.0, f64::max);
    if m == 0 || longest == 0.0 {
        return None;
    }
    let usual = vec![longest; scene.rows.len()];
    let weakest = weakest(&scene, &all, &rows, &usual)?;
    if weakest.size > NEARLY {
        return None;
    }
    let u = &weakest.unit;
    let worst = (0..m).max_by(|&i, &j| u[i].abs().total_cmp(&u[j].abs()))?;
    // how much each motion pushes along that combination
    let at = crate::scene::equations::Equations::new(scene, numbers);
    let values: Vec<f64> = (0..scene.motions.len())
        .map(|k| at.prescribed(k).value)
        .collect();
    let along = |g: &nalgebra::DVector<f64>| -> f64 {
        (0..m)
            .map(|i| u[i] * g[rows[i]] / assemble::natural(&scene, rows[i]))
            .sum()
    };
    let at_motions = |displacements: &[f64]| {
        let there = scene.configuration.with_motions_at(displacements);
        assemble::rows_at(scene.within(&there), t, q, x)
    };
    let (still, _, _) = at_motions(&values);
    let push = |k: usize| {
        let mut other = values.clone();
        other[k] += 1e-6;
        let (g, _, _) = at_motions(&other);
        ((along(&g) - along(&still)) / 1e-6 * at.prescribed(k).first).abs()
    };
    let pushes: Vec<f64> = (0..values.len()).map(push).collect();
    let motion = (0..values.len())
        .max_by(|&i, &j| pushes[i].total_cmp(&pushes[j]))
        .filter(|&k| pushes[k] > 1e-9)
        .map(|k| scene.motions[k].id);
    Some(Lock {
        row: row_name(&scene.rows[rows[worst]]),
        motion,
        place: place(&scene, numbers, &weakest.touched),
    })
}

/// A place in words: "JOINT/1 angle = 1.571, JOINT/2 angle = 0"
pub fn words(place: &[(String, f64)]) -> String {
    let some = place.iter().take(4);
    let some: Vec<String> = some
        .map(|(name, x)| {
            let x = if x.abs() < 1e-12 { 0.0 } else { *x };
            format!("{name} = {}", crate::analysis::start::quantity::short(x))
        })
        .collect();
    let more = if place.len() > 4 { ", …" } else { "" };
    format!("{}{more}", some.join(", "))
}

/// Largest residual of rows that were left out, relative to what counts as one, and which row it is.
pub fn worst_left_out(scene: &Scene, rows: &[usize], values: &[f64]) -> Option<(usize, f64)> {
    rows.iter()
        .zip(values)
        .map(|(&r, &value)| (r, (value / assemble::natural(scene, r)).abs()))
        .max_by(|a, b| a.1.total_cmp(&b.1))
}
