//! The rank of the rows while a mechanism moves.
//!
//! Three things can happen to rows that were independent at the start. They may become dependent at
//! one position and be independent again beyond it (a folded parallelogram): the solver passes, and
//! the position is found afterwards, in `passes`. Rows that were left out may determine the
//! motion better than some of the rest (the two coordinates of a pin that turns): the choice is
//! made anew, by [`better_rows`]. And a drive may ask for a position that no rows permit: the
//! mechanism is locked, see `locked`.

mod known;
mod locked;
mod passes;
mod selection;
mod sides;
mod turning;
mod valley;

use crate::arrange::Arrange;
pub use locked::{Lock, locked};
pub use passes::passes;
use selection::{Rows, margin, norm, select};
use sides::Loop;
pub use sides::{Side, Sides};

use crate::analysis::start::assemble::{self, DEPENDENT};
use crate::analysis::start::velocities;
use crate::analysis::system::{RowGradients, System};
use crate::expr::program::{Program, Work};
use crate::scene::configuration::Configured;
use crate::scene::layout::Layout;
use crate::scene::programs::weights;
use crate::scene::recorder::{self, Recorder};
use crate::scene::{Scene, Source};
use nalgebra::DMatrix;
use std::cell::RefCell;

/// States kept to find positions at which rows become dependent, at most, in any mechanism.
const MOST_STATES: f64 = 2000.0;
/// States kept, at least.
const LEAST_STATES: f64 = 60.0;
/// Factor by which a row must determine more than a preferred one to be chosen in its place.
const PREFERENCE: f64 = 3.0;
/// Least of what rows determine beyond each other, as a part of the least among better ones, below
/// which they are exchanged.
const WORTH_EXCHANGING: f64 = 0.3;

/// Returns how many states are kept to find positions at which rows become dependent: the cost of
/// one grows with the cube of the number of velocities.
pub fn states_kept(n_v: usize) -> f64 {
    (1e8 / (n_v as f64).powi(3)).clamp(LEAST_STATES, MOST_STATES)
}

fn active(scene: Configured<'_>) -> Vec<usize> {
    scene.configuration.active_rows().collect()
}

/// Gradients of the rows that take part, by loops.
struct Gradients {
    program: Program,
    work: RefCell<Work>,
    /// rows that share coordinates
    loops: Vec<Loop>,
    /// loop, row and column of each value, and its factor: columns are scaled, each row counts
    /// against its scale
    places: Vec<(usize, usize, usize, f64)>,
}

impl Gradients {
    /// Takes the gradients of a system, or records them where other rows took part; `None` where
    /// no row does.
    fn of(scene: Configured<'_>, system: &System) -> Option<Self> {
        let rows = active(scene);
        let RowGradients { entries, program } =
            match scene.configuration.active == system.configuration.active {
                true => system.row_gradients().clone(),
                false => RowGradients::new(&Recorder::new(scene, &recorder::builder())).ok()?,
            };
        let loops = sides::loops(&rows, &entries, scene.layout.n_v);
        let mut place_of_row = vec![(0, 0); scene.rows.len()];
        let mut column = vec![0; scene.layout.n_v];
        for (k, l) in loops.iter().enumerate() {
            (l.rows.iter().enumerate()).for_each(|(i, &r)| place_of_row[r] = (k, i));
            (l.coordinates.iter().enumerate()).for_each(|(j, &v)| column[v] = j);
        }
        let w = weights(&scene);
        let place = |&(r, v): &(usize, usize)| {
            let (k, i) = place_of_row[r];
            (k, i, column[v], w[v].sqrt() / scene.row_scale(r))
        };
        let places = entries.iter().map(place).collect();
        (!loops.is_empty()).then(|| Self {
            program,
            work: RefCell::default(),
            loops,
            places,
        })
    }

    /// Evaluates the rows, by loops.
    fn at(&self, numbers: &[f64]) -> Vec<Rows> {
        let mut values = vec![0.0; self.places.len()];
        self.program
            .run(numbers, &mut self.work.borrow_mut(), &mut values);
        let zeros = |l: &Loop| Rows::zeros(l.rows.len(), l.coordinates.len());
        let mut all: Vec<_> = self.loops.iter().map(zeros).collect();
        for (&(k, i, j, factor), x) in self.places.iter().zip(values) {
            all[k].row_mut(i)[j] += factor * x;
        }
        all
    }
}

/// Evaluates all rows at one place, columns scaled, each row against its scale.
fn gradients(scene: Configured<'_>, numbers: &[f64]) -> Vec<Vec<f64>> {
    let l = scene.layout;
    let (t, q, x) = (numbers[Layout::TIME], &numbers[l.q()], &numbers[l.x()]);
    let gradient = match scene.has_rows_of_velocities() {
        true => assemble::rows_at(scene, t, (q, &numbers[l.v()], x)).1,
        false => assemble::rows_at_rest(scene, t, q, x).1,
    };
    let mut all = assemble::scaled_rows(&gradient, &weights(&scene));
    for (r, row) in all.iter_mut().enumerate() {
        let one = scene.row_scale(r);
        row.iter_mut().for_each(|x| *x /= one);
    }
    all
}

/// A judgement of the rows that take part.
#[derive(Clone, Debug, PartialEq)]
pub enum Judgement {
    /// they may stay; the least that any of them determines beyond the others
    Right(f64),
    /// the rows that are to take part instead
    Better(Vec<bool>),
}

/// Judges the rows kept so far: others are better when these have become dependent though the
/// mechanism has not, or a row that was left out no longer follows from them.
pub fn better_rows(scene: Configured<'_>, numbers: &[f64]) -> Judgement {
    let kept = active(scene);
    let all = gradients(scene, numbers);
    let rows_of = |chosen: &[usize]| {
        let mut rows = Rows::zeros(chosen.len(), scene.layout.n_v);
        let places = rows.iter_mut().zip(chosen);
        places.for_each(|(row, &r)| row.copy_from_slice(&all[r]));
        rows
    };
    let is_kept = |r: usize| scene.configuration.active[r];
    // an equation of velocities never takes the place of a row that holds positions
    let may_be = |r: &usize| is_kept(*r) || !scene.rows[*r].is_of_velocities();
    let every: Vec<usize> = (0..all.len()).filter(may_be).collect();
    let (better, most) = select(rows_of(&every), |k| is_kept(every[k]), usize::MAX);
    let better: Vec<usize> = better.into_iter().map(|k| every[k]).collect();
    if better == kept {
        return Judgement::Right(most);
    }
    let (stay, least) = select(rows_of(&kept), |_| true, kept.len());
    let gains =
        better.len() > kept.len() || stay.len() < kept.len() || least < WORTH_EXCHANGING * most;
    match gains && better.len() >= kept.len() {
        true => Judgement::Better((0..scene.rows.len()).map(|r| better.contains(&r)).collect()),
        false if stay.len() < kept.len() => Judgement::Right(0.0),
        false => Judgement::Right(least),
    }
}

/// Moves a state onto all rows, also those that were left out, where that is possible with a small
/// change; whether it was.
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
    let v = velocities::nearest_velocities(scene, t, &q, &x, &numbers[l.v()]);
    numbers[l.q()].copy_from_slice(&q);
    numbers[l.v()].copy_from_slice(&v);
    true
}

/// The combination of rows that moves least.
struct Weakest {
    /// factors of the rows, each against its usual length
    unit: Vec<f64>,
    /// its length: zero where the rows are dependent
    size: f64,
    /// coordinates that its rows read
    touched: Vec<bool>,
}

/// Finds the combination of rows that moves least; `None` where the iteration does not converge.
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

/// Returns the values of coordinates, those that are `touched` first.
fn place(scene: &Scene, numbers: &[f64], touched: &[bool]) -> Vec<(String, f64)> {
    let q = &numbers[scene.layout.q()];
    let mut all: Vec<(bool, String, f64)> = (scene.coordinates.iter().zip(&scene.freedoms))
        .filter(|(_, f)| !f.in_ball)
        .filter_map(|(c, _)| match c.source {
            Source::Free { q: place, v } => Some((!touched[v], c.id.to_string(), q[place])),
            Source::Driven(_) => None,
        })
        .collect();
    all.arrange_by_key(|c| c.0);
    all.into_iter().map(|(_, name, x)| (name, x)).collect()
}
