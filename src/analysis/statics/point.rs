//! A configuration with the loads that act in it, and their derivatives.

use super::Settler;
use super::metric::{Metric, Rows};
use crate::numeric::pattern::Pattern;
use crate::scene::equations::Equations;
use crate::scene::slopes::{Direction, along};
use nalgebra::{DMatrix, DVector};

/// A configuration with the loads that act in it.
pub(super) struct Point {
    pub numbers: Vec<f64>,
    /// f + Gᵀλ   (n_v)
    pub force: DVector<f64>,
    /// e of the differential equations that are not held   (n_d)
    pub state: DVector<f64>,
    /// balances f as well as may be   (m)
    pub lambda: DVector<f64>,
    pub rows: Rows,
    pub metric: Metric,
    /// size of what is left of forces (in the metric) and of states
    pub left: [f64; 2],
}

impl Settler<'_> {
    /// Evaluates the loads in a configuration; `None` when they have no value there.
    pub(super) fn point(&mut self, numbers: &[f64]) -> Option<Point> {
        self.evaluations += 1;
        let (n, m) = (self.n_v(), self.rows.len());
        let mut input = numbers.to_vec();
        input.resize(numbers.len() + m, 0.0);
        let mut out = vec![0.0; self.program.n_outputs()];
        self.program.run(&input, &mut self.work, &mut out);
        self.asked.go_on()?;
        if out.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let scene = self.system.configured();
        let at = Equations::new(scene, numbers);
        let mut gradient = DMatrix::zeros(m, n);
        for (k, &r) in self.rows.iter().enumerate() {
            for &(v, g) in &at.row(r).gradient {
                gradient[(k, v)] += g;
            }
        }
        let metric = Metric::new(&scene, at.mass_rows())?;
        self.asked.go_on()?;
        let rows = Rows::new(gradient, &metric);
        let f = DVector::from_column_slice(&out[..n]);
        let state = DVector::from_column_slice(&out[n + m..]);
        let (lambda, force) = rows.balanced(&f);
        let left = [metric.size(&force), state.norm()];
        Some(Point {
            numbers: numbers.to_vec(),
            force,
            state,
            lambda,
            rows,
            metric,
            left,
        })
    }

    /// Returns the derivatives of loads (n_v rows) and e (n_d rows) along coordinates and states,
    /// multipliers kept.
    pub(super) fn jacobian(&mut self, p: &Point) -> DMatrix<f64> {
        let (n, m, d) = (self.n_v(), self.rows.len(), self.states.len());
        let l = self.system.scene.layout;
        let mut directions = vec![Direction::new(); n];
        for (v, place, slope) in self.system.mover().tangents(&p.numbers[l.q()]) {
            directions[v].push((l.q_at(place), slope));
        }
        directions.extend(self.states.iter().map(|&x| vec![(l.x_at(x), 1.0)]));
        let pattern = match self.pattern.take() {
            Some(pattern) => pattern,
            None => {
                let mut changed = vec![Vec::new(); l.len()];
                for (d, direction) in directions.iter().enumerate() {
                    (direction.iter()).for_each(|&(place, _)| changed[place].push(d as u32));
                }
                self.system.depend_along(&mut changed);
                Pattern::of_rows(n + d, &self.program.dependence(&changed))
            }
        };
        let all = p.numbers.iter().chain(p.lambda.iter()).copied();
        let follow = |numbers: &mut [_], first| self.system.follow_along(numbers, first);
        let slopes = along(
            &self.program,
            &mut self.dual_work,
            all,
            &directions,
            Some(&pattern),
            follow,
        )
        // a loop that nothing determines stops the search elsewhere: here nothing is known
        .unwrap_or_else(|_| DMatrix::zeros(n + m + d, n + d));
        self.pattern = Some(pattern);
        self.drift = self.drift(p);
        slopes.remove_rows(n, m)
    }

    /// Returns the derivatives of e along velocities   (n_d × n_v).
    fn drift(&mut self, p: &Point) -> Option<DMatrix<f64>> {
        let moving = self.moving.as_ref()?;
        let places = self.system.scene.layout.v();
        let speeds: Vec<Direction> = places.map(|place| vec![(place, 1.0)]).collect();
        let all = p.numbers.iter().copied();
        let follow = |numbers: &mut [_], first| self.system.follow_along(numbers, first);
        along(moving, &mut self.dual_work, all, &speeds, None, follow).ok()
    }
}
