//! One step of the descent: its linear system, the configuration at its end, and the test whether
//! the loads found there are those that were foretold.

use super::Settler;
use super::point::Point;
use super::stability::asymmetry;
use crate::numeric::Ode;
use crate::numeric::dense::Lu;
use crate::numeric::envelope;
use crate::numeric::sparse::inverse_power;
use crate::scene::equations::Equations;
use crate::scene::layout::Layout;
use crate::scene::tunnelling::ThicknessBound;
use nalgebra::{DMatrix, DMatrixViewMut, DVector};

/// Iterations of one implicit step.
const MAX_CORRECTIONS: usize = 8;
/// Largest translation in a step where TLIMIT says nothing, in sizes of the mechanism: what 20 m,
/// which is usual, are to one of a metre.
const USUAL_TRANSLATION: f64 = 20.0;
/// Part of its own rate by which a state that follows lags behind.
const STATE_LAG: f64 = 1e-6;

/// The length of a step.
pub(super) struct Pace {
    /// in the descent's own time
    pub length: f64,
    /// 1/length for each state: those that come to rest by themselves follow at once, as otherwise
    /// a force that they make would come too late
    states: Vec<f64>,
}

impl Pace {
    /// Takes a length at a place with these derivatives, `n_v` of whose rows are of coordinates.
    pub fn new(length: f64, jacobian: &DMatrix<f64>, n_v: usize) -> Self {
        let own = (n_v..jacobian.nrows()).map(|k| jacobian[(k, k)]);
        let follow = |e: f64| {
            if e < 0.0 {
                STATE_LAG * -e
            } else {
                f64::INFINITY
            }
        };
        Self {
            length,
            states: own.map(|e| follow(e).min(1.0 / length)).collect(),
        }
    }
}

/// Powers of two that rid the matrix of a step of all units: coordinates in rad or sizes of the
/// mechanism, loads in those of the stiffness, states and their equations of size one.
struct Scales {
    /// (n_v + n_d)
    rows: Vec<f64>,
    /// (n_v + n_d)
    columns: Vec<f64>,
}

impl Scales {
    /// Takes them from a matrix whose first rows are loads along coordinates with these units, and
    /// whose next `d` are equations of states.
    fn of(a: &DMatrixViewMut<'_, f64>, units: &[f64], d: usize) -> Self {
        let n = units.len();
        let mut columns: Vec<f64> = units.iter().map(|&u| 1.0 / inverse_power(u)).collect();
        let stiffness = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let stiffness = stiffness.map(|(i, j)| (a[(i, j)] * columns[i] * columns[j]).abs());
        let loads = inverse_power(stiffness.fold(0.0, f64::max));
        let mut rows: Vec<f64> = columns.iter().map(|unit| unit * loads).collect();
        for k in n..n + d {
            let of_loads = rows[..n].iter().enumerate();
            let largest = of_loads.map(|(i, row)| (a[(i, k)] * row).abs());
            columns.push(inverse_power(largest.fold(0.0, f64::max)));
        }
        for k in n..n + d {
            let entries = columns.iter().enumerate();
            let largest = entries.map(|(j, column)| (a[(k, j)] * column).abs());
            rows.push(inverse_power(largest.fold(0.0, f64::max)));
        }
        Self { rows, columns }
    }

    fn apply(&self, a: &mut DMatrixViewMut<'_, f64>) {
        for (j, column) in self.columns.iter().enumerate() {
            for (i, row) in self.rows.iter().enumerate() {
                a[(i, j)] *= row * column;
            }
        }
    }
}

impl Settler<'_> {
    /// Returns the changes of coordinates and states in a step; `None` where it would not go down.
    pub(super) fn step(
        &mut self,
        p: &Point,
        jacobian: &DMatrix<f64>,
        pace: &Pace,
    ) -> Option<DVector<f64>> {
        let rhs = p.force.iter().chain(p.state.iter()).copied().collect();
        self.solved(p, jacobian, pace, rhs, true)
    }

    /// Returns Newton's step against some loads, whichever way it leads.
    pub(super) fn newton(
        &mut self,
        p: &Point,
        jacobian: &DMatrix<f64>,
        pace: &Pace,
        force: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        let mut rhs = force.as_slice().to_vec();
        rhs.resize(jacobian.nrows(), 0.0);
        self.solved(p, jacobian, pace, rhs, false)
    }

    /// Solves for the changes of coordinates and states that `rhs` asks for, with the matrix of a
    /// step; `None` where that matrix is singular, or, `downhill`, where the step would lead up.
    fn solved(
        &mut self,
        p: &Point,
        jacobian: &DMatrix<f64>,
        pace: &Pace,
        mut rhs: Vec<f64>,
        downhill: bool,
    ) -> Option<DVector<f64>> {
        self.asked.go_on()?;
        self.factorizations += 1;
        let (n, m, d) = (self.n_v(), self.rows.len(), self.states.len());
        let size = n + d + m;
        if self.lu.size() != size {
            self.lu = Lu::new(size);
        }
        let units = self.units();
        // large matrices stand where those of the step before did
        let mut a = DMatrixViewMut::from_slice(self.lu.matrix_mut(), size, size);
        a.fill(0.0);
        for (mut to, from) in a.column_iter_mut().zip(jacobian.column_iter()) {
            let entries = to.iter_mut().zip(from.iter());
            entries.for_each(|(to, from)| *to = -from);
        }
        p.metric.add_to(&mut a, 1.0 / pace.length);
        for (k, rate) in pace.states.iter().enumerate() {
            a[(n + k, n + k)] += rate;
        }
        if let Some(drift) = &self.drift {
            let mut follow = a.view_mut((n, 0), (d, n));
            follow -= drift / pace.length;
        }
        let scales = Scales::of(&a, &units, d);
        scales.apply(&mut a);
        let mut gradient = p.rows.gradient.clone();
        for (i, mut row) in gradient.row_iter_mut().enumerate() {
            for (j, g) in row.iter_mut().enumerate() {
                *g *= scales.columns[j];
            }
            row *= inverse_power(row.amax());
            for (j, g) in row.iter().enumerate() {
                a[(j, n + d + i)] = -g;
                a[(n + d + i, j)] = *g;
            }
        }
        self.asked.go_on()?;
        for (x, factor) in rhs.iter_mut().zip(&scales.rows) {
            *x *= factor;
        }
        rhs.resize(size, 0.0);
        let mut upright = true;
        let mut is_symmetric = false;
        if downhill {
            let stiffness = a.view((0, 0), (n, n)).into_owned();
            upright = goes_down(&stiffness, &gradient);
            self.asked.go_on()?;
            is_symmetric = !upright && d == 0 && asymmetry(&stiffness) < 1e-3;
        }
        let (lu, asked) = (&mut self.lu, &mut self.asked);
        lu.factor_while(1e-15, &mut || !asked.stops()).ok()?;
        if !upright && (is_symmetric || !lu.positive()) {
            return None;
        }
        lu.solve(&mut rhs);
        rhs.truncate(n + d);
        for (x, factor) in rhs.iter_mut().zip(&scales.columns) {
            *x *= factor;
        }
        let step = DVector::from_vec(rhs);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    /// Returns the size of a step in units of TLIMIT and ALIMIT; at most 1 is permitted.
    pub(super) fn excess(&self, step: &DVector<f64>) -> f64 {
        let scene = &self.system.scene;
        let translation = self.settings.translation;
        let translation = translation.unwrap_or(USUAL_TRANSLATION * scene.length);
        let mut most = 0.0_f64;
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let Some(v) = f.v {
                let limit = if c.angular {
                    self.settings.angle
                } else {
                    translation
                };
                most = most.max(step[v].abs() / limit);
            }
        }
        most
    }

    /// Returns the length of the way to other numbers in units of what bodies of a contact may go
    /// at once without coming through each other; at most 1 is permitted.
    fn through(&self, p: &Point, numbers: &[f64]) -> f64 {
        let scene = self.system.configured();
        if scene.thickness_bounds.is_empty() {
            return 0.0;
        }
        let (from, to) = (
            Equations::new(scene, &p.numbers),
            Equations::new(scene, numbers),
        );
        let excess = |r: &ThicknessBound| r.excess(r.apart(&from), r.apart(&to));
        scene
            .thickness_bounds
            .iter()
            .map(excess)
            .fold(0.0, f64::max)
    }

    /// Returns the numbers after a step, on the rows; `None` where the rows cannot be kept.
    pub(super) fn moved(&mut self, p: &Point, step: &DVector<f64>) -> Option<Vec<f64>> {
        let l = self.system.scene.layout;
        let mut numbers = p.numbers.clone();
        // a change of positions by a tangent, then of states
        let (dq, dx) = step.as_slice().split_at(l.n_v);
        self.system.mover().displace(&mut numbers[l.q()], dq);
        for (&x, d) in self.states.iter().zip(dx) {
            numbers[l.x_at(x)] += d;
        }
        let mut y = numbers[l.y()].to_vec();
        self.system.project(numbers[Layout::TIME], &mut y).ok()?;
        l.state_mut(&mut y).v.fill(0.0);
        numbers[l.y()].copy_from_slice(&y);
        self.system.numbers.copy_from_slice(&numbers);
        self.system.resolve().ok()?;
        numbers.copy_from_slice(&self.system.numbers);
        Some(numbers)
    }

    /// Tries a step: the point at its end, how far that is from what was foretold (relative to the
    /// limit, beyond the `floor` that rounding makes of loads and of states), and whether its
    /// length had to be limited.
    pub(super) fn attempt(
        &mut self,
        p: &Point,
        jacobian: &DMatrix<f64>,
        floor: [f64; 2],
        mut step: DVector<f64>,
    ) -> Option<(Point, f64, bool)> {
        let n = self.n_v();
        let excess = self.excess(&step);
        let mut shortened = excess > 1.0;
        if shortened {
            step /= excess;
        }
        let mut numbers = self.moved(p, &step)?;
        let through = self.through(p, &numbers);
        if through > 1.0 {
            shortened = true;
            step /= through;
            numbers = self.moved(p, &step)?;
        }
        let next = self.point(&numbers)?;
        self.asked.go_on()?;
        let change = jacobian * &step;
        let foretold = DVector::from_iterator(n, (0..n).map(|i| p.force[i] + change[i]));
        let (_, foretold) = p.rows.balanced(&foretold);
        let off = [
            (p.metric.size(&(&next.force - &foretold)) - floor[0]).max(0.0),
            ((0..self.states.len())
                .map(|k| (next.state[k] - p.state[k] - change[n + k]).powi(2))
                .sum::<f64>()
                .sqrt()
                - floor[1])
                .max(0.0),
        ];
        let expected = [
            p.left[0] + p.metric.size(&(&foretold - &p.force)),
            p.left[1] + self.stirred(jacobian, &step),
        ];
        let quality = (0..2)
            .filter(|&k| off[k] > 0.0)
            .map(|k| off[k] / (0.3 * expected[k]))
            .fold(0.0, f64::max);
        (quality <= 1.0).then_some((next, quality, shortened))
    }

    /// Returns how far a step moves the equations of the states: by coordinates and by the states
    /// that follow them, whose shares cancel where the states are in balance.
    fn stirred(&self, jacobian: &DMatrix<f64>, step: &DVector<f64>) -> f64 {
        let (n, d) = (self.n_v(), self.states.len());
        let share = |from, count| {
            let part = jacobian.view((n, from), (d, count)) * step.rows(from, count);
            part.norm()
        };
        share(0, n) + share(n, d)
    }

    /// Tries a step again whose end is not what was foretold: as an implicit step, iterated until
    /// the loads at its end are those that move it there.
    ///
    /// ```text
    /// D Δ/h = f(q + Δ) + Gᵀλ
    /// ```
    ///
    /// Where stiff parts turn with soft ones (blades with a rotor that swings down) their forces
    /// grow with the square of a step that never leaves the valley; the iteration leads it back to
    /// the bottom.
    pub(super) fn corrected(
        &mut self,
        p: &Point,
        jacobian: &DMatrix<f64>,
        floor: [f64; 2],
        step: DVector<f64>,
        pace: &Pace,
    ) -> Option<(Point, f64, bool)> {
        let (n, d) = (self.n_v(), self.states.len());
        let mut step = step;
        let h = pace.length;
        let drift = self.drift.clone();
        let advance = |step: &DVector<f64>| {
            let own = DVector::from_iterator(d, (0..d).map(|k| step[n + k] * pace.states[k]));
            match &drift {
                Some(drift) => own - drift * step.rows(0, n) / h,
                None => own,
            }
        };
        let mut before = f64::INFINITY;
        if self.excess(&step) > 1.0 {
            return None;
        }
        let mut numbers = self.moved(p, &step)?;
        if self.through(p, &numbers) > 1.0 {
            return None;
        }
        for _ in 0..MAX_CORRECTIONS {
            let next = self.point(&numbers)?;
            let moving = p.metric.times(&step.as_slice()[..n]) / h;
            let (_, foretold) = p.rows.balanced(&moving);
            // the rows have turned as well: what they take is taken there
            let (_, rest) = next.rows.balanced(&(&next.force - &moving));
            let off = [
                (next.metric.size(&rest) - floor[0]).max(0.0),
                ((&next.state - advance(&step)).norm() - floor[1]).max(0.0),
            ];
            let expected = [
                p.left[0] + p.metric.size(&(foretold - &p.force)),
                p.left[1] + (advance(&step) - &p.state).norm() + self.stirred(jacobian, &step),
            ];
            let quality = (0..2)
                .filter(|&k| off[k] > 0.0)
                .map(|k| off[k] / (0.3 * expected[k]))
                .fold(0.0, f64::max);
            // a corrected step is as good as a direct one when what is left to correct is a tenth
            if quality <= 0.1 {
                return Some((next, 0.5, false));
            }
            if quality > before || quality.is_nan() {
                return None;
            }
            before = 0.5 * quality;
            let mut rhs = rest.as_slice().to_vec();
            rhs.extend((&next.state - advance(&step)).iter());
            // stiff directions have turned on the way: the derivatives have to be those of the end
            let there = self.jacobian(&next);
            let delta = self.solved(&next, &there, pace, rhs, false)?;
            // go on in the directions of the end: those that are soft at the beginning are stiff
            // there
            step += &delta;
            if self.excess(&step) > 1.0 {
                return None;
            }
            numbers = self.moved(&next, &delta)?;
        }
        None
    }
}

/// Returns whether the symmetric part of a matrix is positive on what the rows leave free.
fn goes_down(a: &DMatrix<f64>, gradient: &DMatrix<f64>) -> bool {
    let n = a.nrows();
    let mut s = DMatrix::from_fn(n, n, |i, j| (a[(i, j)] + a[(j, i)]) * 0.5);
    if gradient.nrows() > 0 {
        // a large stiffness against leaving the rows, in each row alike
        let size = s.amax();
        for row in gradient.row_iter() {
            let n2 = row.norm_squared();
            if n2 > 0.0 {
                let entries: Vec<_> = (row.iter().copied().enumerate())
                    .filter(|(_, g)| *g != 0.0)
                    .collect();
                for (&(i, a), &(j, b)) in entries
                    .iter()
                    .flat_map(|e| entries.iter().map(move |f| (e, f)))
                {
                    s[(i, j)] += a * b * (1e6 * size / n2);
                }
            }
        }
    }
    envelope::is_positive(&s)
}
