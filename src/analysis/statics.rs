//! Equilibrium: where loads and reactions balance at rest.
//!
//! A damped fall from the present configuration, taken in ever longer implicit steps until it is Newton's iteration:
//!
//! ```text
//! D q̇ = f(q, x) + Gᵀλ,   ẋ = e(q, x),   g(q) = 0                          D: mass matrix, a little added where there is none
//! ⎡ D/h − K   −Gᵀ ⎤ ⎡Δ ⎤   ⎡ f + Gᵀλ ⎤
//! ⎣    G       0  ⎦ ⎣Δλ⎦ = ⎣   −g    ⎦     K = ∂(f + Gᵀλ)/∂q,  λ balances f as well as rows can
//! ```
//!
//! Short steps follow the fall, which loses energy and therefore ends at a stable place or nowhere; long ones converge
//! quadratically. A step is kept when the loads found at its end are those that its linear model foretold, and when the matrix
//! is positive on the motions that the rows leave: then it cannot jump to the top of a hill. A singular stiffness, as of a
//! body that touches nothing yet, needs no special treatment.
//!
//! An equilibrium that turns out to be a saddle is left along its steepest descent, unless the model stood there from the start.

use super::dynamics::Watch;
use super::slopes::{Direction, along};
use super::system::System;
use super::unknowns::WIDTH;
use crate::expr::program::{Program, Work};
use crate::model;
use crate::numeric::dense::Lu;
use crate::numeric::rank::{Rank, TOLERANCE};
use crate::numeric::{Ode, Stats};
use crate::scalar::Dual;
use crate::scene::equations::Equations;
use crate::scene::programs::record_more;
use crate::scene::{Scene, Source};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Part of the loads below which what is left of them is rounding.
const ROUNDING: f64 = 1e-13;
/// Part of the loads below which an iteration that no longer improves has arrived.
const STAGNANT: f64 = 1e-8;
/// Steps of the fall at most, whatever MAXIT says of Newton.
const MAX_STEPS: usize = 3000;
/// Steps at the limit of their length without any change of the loads, after which it falls forever.
const FALLING: usize = 300;
/// Iterations of one implicit step.
const CORRECTIONS: usize = 8;
/// Saddles that are left before one is accepted.
const MAX_SADDLES: usize = 8;

/// EQUILIBRIUM.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// ERROR: largest change of a coordinate in the last iteration
    pub error: f64,
    /// TLIMIT: largest translation in one iteration
    pub translation: f64,
    /// ALIMIT: largest rotation in one iteration   (rad)
    pub angle: f64,
    /// MAXIT
    pub iterations: usize,
    /// IMBALANCE: largest force or torque that may remain
    pub imbalance: f64,
    /// STABILITY: least part of the mass matrix that is added to the stiffness
    pub stability: f64,
}

impl Settings {
    /// Of a model, defaults where it says nothing.
    pub fn of(settings: &model::Settings) -> Self {
        let number = |name: &str, default: f64| {
            let given = settings.numbers.get(name).copied();
            given
                .filter(|x| x.is_finite() && *x > 0.0)
                .unwrap_or(default)
        };
        Self {
            error: number("ERROR", 1e-4),
            translation: number("TLIMIT", 20.0),
            angle: number("ALIMIT", 10f64.to_radians()),
            iterations: number("MAXIT", 25.0) as usize,
            imbalance: number("IMBALANCE", 1e-4),
            stability: number("STABILITY", 1e-5),
        }
    }
}

/// How an equilibrium answers a small push.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stability {
    /// directions in which it is pushed back
    pub stable: usize,
    /// directions in which nothing happens
    pub neutral: usize,
    /// directions in which it leaves
    pub unstable: usize,
}

impl Stability {
    /// In words.
    pub fn words(&self) -> String {
        let directions = |n: usize| if n == 1 { "direction" } else { "directions" };
        match (self.unstable, self.neutral) {
            (0, 0) => "stable".into(),
            (0, n) => format!("stable, indifferent in {n} {}", directions(n)),
            (n, _) => format!("unstable in {n} {}", directions(n)),
        }
    }
}

/// An equilibrium, in the numbers of the system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equilibrium {
    /// steps it took
    pub iterations: usize,
    /// largest force or torque that is left
    pub imbalance: f64,
    /// what a push does
    pub stability: Stability,
}

/// Why there is none.
#[derive(Clone, Debug, PartialEq)]
pub enum NoEquilibrium {
    /// what is not balanced, in a sentence, and the name of the coordinate
    Unbalanced(String, String),
    /// the caller asked to stop
    Interrupted,
}

/// A configuration with what acts in it.
struct Point {
    numbers: Vec<f64>,
    /// f + Gᵀλ   (n_v)
    force: DVector<f64>,
    /// e of the differential equations that are not held   (n_d)
    state: DVector<f64>,
    /// balances f as well as may be   (m)
    lambda: DVector<f64>,
    /// (m × n_v)
    gradient: DMatrix<f64>,
    metric: Cholesky<f64, Dyn>,
    mass: DMatrix<f64>,
    /// size of what is left of forces (in the metric) and of states
    left: [f64; 2],
}

struct Settler<'a> {
    system: &'a mut System,
    settings: &'a Settings,
    /// loads with multipliers | row values | e
    program: Program,
    work: Work,
    dual_work: Work<Dual<WIDTH>>,
    /// places in x of the states that are sought
    states: Vec<usize>,
    /// indices of the active rows
    rows: Vec<usize>,
    evaluations: usize,
    factorizations: usize,
}

/// Brings a system to rest from where it is; its numbers end at the equilibrium, or where the search ended.
///
/// # Errors
/// When there is none to be found: what is not balanced.
pub fn settle(
    system: &mut System,
    settings: &Settings,
    watch: &mut dyn Watch,
    stats: &mut Stats,
) -> Result<Equilibrium, NoEquilibrium> {
    let mut settler = Settler::new(system, settings)?;
    let found = settler.run(watch);
    stats.evaluations += settler.evaluations;
    stats.factorizations += settler.factorizations;
    if let Ok(e) = &found {
        stats.steps += e.iterations;
    }
    found
}

impl<'a> Settler<'a> {
    fn new(system: &'a mut System, settings: &'a Settings) -> Result<Self, NoEquilibrium> {
        let scene = &system.scene;
        let rows: Vec<usize> = (0..scene.rows.len())
            .filter(|&r| scene.active.get(r).copied().unwrap_or(true))
            .collect();
        let states: Vec<usize> = (scene.differentials.iter())
            .filter(|d| !d.static_hold)
            .filter_map(|d| d.state)
            .collect();
        let (program, complaints) = record_more(scene, rows.len(), |at, multipliers| {
            let mut out = at.balance(multipliers);
            out.extend(rows.iter().map(|&r| at.row(r).value));
            let rates = at.state_rates();
            out.extend(states.iter().map(|&x| rates[x]));
            out
        });
        if let Some(first) = complaints.first() {
            return Err(NoEquilibrium::Unbalanced(first.clone(), String::new()));
        }
        Ok(Self {
            program,
            work: Work::default(),
            dual_work: Work::default(),
            states,
            rows,
            evaluations: 0,
            factorizations: 0,
            system,
            settings,
        })
    }

    fn n_v(&self) -> usize {
        self.system.scene.layout.n_v
    }

    /// What acts in a configuration; `None` when it has no value there.
    fn point(&mut self, numbers: &[f64]) -> Option<Point> {
        self.evaluations += 1;
        let (n, m) = (self.n_v(), self.rows.len());
        let mut input = numbers.to_vec();
        input.resize(numbers.len() + m, 0.0);
        let mut out = vec![0.0; self.program.n_outputs()];
        self.program.run(&input, &mut self.work, &mut out);
        if out.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let scene = &self.system.scene;
        let at = Equations::new(scene, numbers);
        let mut gradient = DMatrix::zeros(m, n);
        for (k, &r) in self.rows.iter().enumerate() {
            for (v, g) in at.row(r).gradient {
                gradient[(k, v)] += g;
            }
        }
        let mass = mass(scene, &at);
        let metric = Cholesky::new(metric(scene, &mass))?;
        let f = DVector::from_column_slice(&out[..n]);
        let state = DVector::from_column_slice(&out[n + m..]);
        let lambda = least_multipliers(&metric, &gradient, &f);
        let force = &f + gradient.tr_mul(&lambda);
        let left = [in_metric(&metric, &force), state.norm()];
        Some(Point {
            numbers: numbers.to_vec(),
            force,
            state,
            lambda,
            gradient,
            metric,
            mass,
            left,
        })
    }

    /// Derivatives of loads (n_v rows) and e (n_d rows) along coordinates and states, multipliers kept.
    fn jacobian(&mut self, p: &Point) -> DMatrix<f64> {
        let (n, m, d) = (self.n_v(), self.rows.len(), self.states.len());
        let l = self.system.scene.layout;
        let mut directions = vec![Direction::new(); n];
        for (v, place, slope) in self.system.mover().tangents(&p.numbers[l.q()]) {
            directions[v].push((l.q().start + place, slope));
        }
        directions.extend(self.states.iter().map(|&x| vec![(l.x().start + x, 1.0)]));
        let all = p.numbers.iter().chain(p.lambda.iter()).copied();
        let follow = |numbers: &mut [_], first| self.system.follow_along(numbers, first);
        let slopes = along(&self.program, &mut self.dual_work, all, &directions, follow)
            // a loop that nothing determines stops the search elsewhere: here nothing is known
            .unwrap_or_else(|_| DMatrix::zeros(n + m + d, n + d));
        slopes.remove_rows(n, m)
    }

    /// The step of length `h` in the fall's own time: changes of coordinates and states; `None` where it would not go down.
    fn step(&mut self, p: &Point, jacobian: &DMatrix<f64>, h: f64) -> Option<DVector<f64>> {
        let rhs = p.force.iter().chain(p.state.iter()).copied().collect();
        self.solved(p, jacobian, h, rhs, true)
    }

    /// Changes of coordinates and states that `rhs` asks for, with the matrix of a step of length `h`; `None` where that matrix is singular, or,
    /// `downhill`, where it would lead up.
    fn solved(
        &mut self,
        p: &Point,
        jacobian: &DMatrix<f64>,
        h: f64,
        mut rhs: Vec<f64>,
        downhill: bool,
    ) -> Option<DVector<f64>> {
        self.factorizations += 1;
        let (n, m, d) = (self.n_v(), self.rows.len(), self.states.len());
        let size = n + d + m;
        let damping = metric(&self.system.scene, &p.mass) / h;
        let mut a = DMatrix::zeros(size, size);
        a.view_mut((0, 0), (n + d, n + d)).copy_from(&(-jacobian));
        let mut own = a.view_mut((0, 0), (n, n));
        own += &damping;
        for k in 0..d {
            a[(n + k, n + k)] += 1.0 / h;
        }
        a.view_mut((0, n + d), (n, m))
            .copy_from(&(-p.gradient.transpose()));
        a.view_mut((n + d, 0), (m, n)).copy_from(&p.gradient);
        let stiffness = a.view((0, 0), (n, n)).into_owned();
        rhs.resize(size, 0.0);
        let mut lu = Lu::new(size);
        lu.matrix_mut().copy_from_slice(a.as_slice());
        let upright = !downhill || goes_down(&stiffness, &p.gradient);
        lu.factor(1e-15).ok()?;
        if !upright && (d == 0 && asymmetry(&stiffness) < 1e-3 || !lu.positive()) {
            return None;
        }
        lu.solve(&mut rhs);
        rhs.truncate(n + d);
        let step = DVector::from_vec(rhs);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    /// How far a step exceeds the limits of its length; at most 1 is permitted.
    fn excess(&self, step: &DVector<f64>) -> f64 {
        let scene = &self.system.scene;
        let translation = self.settings.translation.max(scene.length);
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

    /// The configuration after a step, on the rows.
    fn moved(&mut self, p: &Point, step: &DVector<f64>) -> Option<Vec<f64>> {
        let l = self.system.scene.layout;
        let mut numbers = p.numbers.clone();
        let dq: Vec<f64> = step.iter().take(l.n_v).copied().collect();
        self.system.mover().displace(&mut numbers[l.q()], &dq);
        for (k, &x) in self.states.iter().enumerate() {
            numbers[l.x().start + x] += step[l.n_v + k];
        }
        let mut y = numbers[l.y()].to_vec();
        self.system.project(numbers[0], &mut y).ok()?;
        y[l.n_q..l.n_q + l.n_v].fill(0.0);
        numbers[l.y()].copy_from_slice(&y);
        self.system.numbers.copy_from_slice(&numbers);
        self.system.resolve().ok()?;
        numbers.copy_from_slice(&self.system.numbers);
        Some(numbers)
    }

    fn run(&mut self, watch: &mut dyn Watch) -> Result<Equilibrium, NoEquilibrium> {
        let l = self.system.scene.layout;
        let mut start = self.system.numbers.clone();
        start[l.v()].fill(0.0);
        let nothing = || {
            NoEquilibrium::Unbalanced(
                "the loads have no finite value in the configuration to start from".into(),
                String::new(),
            )
        };
        let mut p = self.point(&start).ok_or_else(nothing)?;
        let mut saddles = 0;
        let mut iterations = 0;
        loop {
            let stood = iterations == 0;
            let (outcome, jacobian) = self.fall(&mut p, &mut iterations, watch);
            self.keep(&p);
            outcome?;
            let stood = stood && iterations == 0;
            let (stability, descent) = self.stability(&p, &jacobian);
            let leave = stability.unstable > 0 && !stood && saddles < MAX_SADDLES;
            match descent {
                Some(descent) if leave => {
                    saddles += 1;
                    let push = descent * (0.01 * self.settings.angle.min(1.0));
                    match self.moved(&p, &push).and_then(|n| self.point(&n)) {
                        Some(pushed) => p = pushed,
                        None => return Ok(self.equilibrium(&p, iterations, stability)),
                    }
                }
                _ => return Ok(self.equilibrium(&p, iterations, stability)),
            }
        }
    }

    fn equilibrium(&self, p: &Point, iterations: usize, stability: Stability) -> Equilibrium {
        Equilibrium {
            iterations,
            imbalance: p.force.amax(),
            stability,
        }
    }

    /// Takes a configuration over into the system.
    fn keep(&mut self, p: &Point) {
        let y = p.numbers[self.system.scene.layout.y()].to_vec();
        self.system.numbers.copy_from_slice(&p.numbers);
        self.system.count_turns(p.numbers[0], &y);
    }

    /// Falls from `p` until nothing pulls any more; the derivatives at the end.
    fn fall(
        &mut self,
        p: &mut Point,
        iterations: &mut usize,
        watch: &mut dyn Watch,
    ) -> (Result<(), NoEquilibrium>, DMatrix<f64>) {
        let n = self.n_v();
        let mut scales = [0.0_f64; 2];
        let mut h: Option<f64> = None;
        let mut falling = 0;
        let mut jacobian = self.jacobian(p);
        let budget = MAX_STEPS.max(self.settings.iterations) + *iterations;
        loop {
            scales[0] = scales[0].max(self.load_scale(p)).max(p.left[0]);
            scales[1] = scales[1].max(p.left[1]).max(self.state_scale(p));
            if p.left[0] <= ROUNDING * scales[0] && p.left[1] <= ROUNDING * scales[1] {
                return (Ok(()), jacobian);
            }
            let small = p.left[0] <= STAGNANT * scales[0] && p.left[1] <= STAGNANT * scales[1];
            if watch.interrupted() {
                return (Err(NoEquilibrium::Interrupted), jacobian);
            }
            if *iterations >= budget || falling > FALLING {
                if self.is_rounding(p, &jacobian) {
                    return (Ok(()), jacobian);
                }
                return (Err(self.unbalanced(p)), jacobian);
            }
            if small && p.left[1] <= ROUNDING * scales[1] && self.is_rounding(p, &jacobian) {
                // stiff contacts make more of the last digits than any step could take away
                return (Ok(()), jacobian);
            }
            let longest = self.longest(p, &jacobian);
            let mut length = h.unwrap_or_else(|| self.first(p)).min(longest);
            // shorter and shorter until the end is what was foretold
            let accepted = loop {
                let trial = self.step(p, &jacobian, length);
                let found = trial.and_then(|step| {
                    (self.attempt(p, &jacobian, step.clone()))
                        .or_else(|| self.corrected(p, step, length))
                });
                if found.is_some() {
                    break found;
                }
                if small && length >= longest {
                    // Newton's steps no longer improve: what is left is rounding
                    return (Ok(()), jacobian);
                }
                length *= 0.25;
                if length < 1e-14 * longest.min(1e6) {
                    break None;
                }
            };
            let Some((next, quality, shortened)) = accepted else {
                if small || self.converged(p) || self.is_rounding(p, &jacobian) {
                    return (Ok(()), jacobian);
                }
                return (Err(self.unbalanced(p)), jacobian);
            };
            let same = (next.left[0] - p.left[0]).abs() <= 1e-6 * p.left[0];
            falling = if shortened && same { falling + 1 } else { 0 };
            let arrived = small && next.left[0] > 0.5 * p.left[0] && length >= longest;
            *p = next;
            *iterations += 1;
            jacobian = self.jacobian(p);
            if arrived {
                return (Ok(()), jacobian);
            }
            let growth = if shortened {
                1.0
            } else if quality < 0.1 {
                10.0
            } else {
                2.0
            };
            h = Some(length * growth);
            debug_assert_eq!(jacobian.nrows(), n + self.states.len());
        }
    }

    /// Tries a step: the point at its end, how far that is from what was foretold (relative to the limit), and whether its
    /// length had to be limited.
    fn attempt(
        &mut self,
        p: &Point,
        jacobian: &DMatrix<f64>,
        mut step: DVector<f64>,
    ) -> Option<(Point, f64, bool)> {
        let n = self.n_v();
        let excess = self.excess(&step);
        let shortened = excess > 1.0;
        if shortened {
            step /= excess;
        }
        let numbers = self.moved(p, &step)?;
        let next = self.point(&numbers)?;
        let change = jacobian * &step;
        let foretold = DVector::from_iterator(n, (0..n).map(|i| p.force[i] + change[i]));
        let lambda = least_multipliers(&p.metric, &p.gradient, &foretold);
        let foretold = foretold + p.gradient.tr_mul(&lambda);
        let off = [
            in_metric(&p.metric, &(&next.force - &foretold)),
            (0..self.states.len())
                .map(|k| (next.state[k] - p.state[k] - change[n + k]).powi(2))
                .sum::<f64>()
                .sqrt(),
        ];
        let expected = [
            p.left[0] + in_metric(&p.metric, &(&foretold - &p.force)),
            p.left[1] + change.rows(n, self.states.len()).norm(),
        ];
        let quality = (0..2)
            .filter(|&k| off[k] > 0.0)
            .map(|k| off[k] / (0.3 * expected[k]))
            .fold(0.0, f64::max);
        (quality <= 1.0).then_some((next, quality, shortened))
    }

    /// Tries a step again whose end is not what was foretold: as an implicit step in earnest, iterated until the loads at its end are
    /// those that move it there.
    ///
    /// ```text
    /// D Δ/h = f(q + Δ) + Gᵀλ
    /// ```
    ///
    /// Where stiff parts turn with soft ones (blades with a rotor that swings down) their forces grow with the square of a step
    /// that never leaves the valley; the iteration leads it back to the bottom.
    fn corrected(&mut self, p: &Point, step: DVector<f64>, h: f64) -> Option<(Point, f64, bool)> {
        let (n, d) = (self.n_v(), self.states.len());
        let metric = metric(&self.system.scene, &p.mass);
        let mut step = step;
        let mut before = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            if self.excess(&step) > 1.0 {
                return None;
            }
            let numbers = self.moved(p, &step)?;
            let next = self.point(&numbers)?;
            let moving = &metric * step.rows(0, n) / h;
            let lambda = least_multipliers(&p.metric, &p.gradient, &moving);
            let foretold = &moving + p.gradient.tr_mul(&lambda);
            let off = [
                in_metric(&p.metric, &(&next.force - &foretold)),
                (&next.state - step.rows(n, d) / h).norm(),
            ];
            let expected = [
                p.left[0] + in_metric(&p.metric, &(&foretold - &p.force)),
                p.left[1] + (step.rows(n, d) / h - &p.state).norm(),
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
            let mut rhs: Vec<f64> = (0..n).map(|i| next.force[i] - moving[i]).collect();
            rhs.extend((0..d).map(|k| next.state[k] - step[n + k] / h));
            // stiff directions have turned on the way: the derivatives have to be those of the end
            let jacobian = self.jacobian(&next);
            step += self.solved(&next, &jacobian, h, rhs, false)?;
        }
        None
    }

    /// How large forces are, in the metric, whatever cancels.
    fn load_scale(&self, p: &Point) -> f64 {
        let scene = &self.system.scene;
        let at = Equations::new(scene, &p.numbers);
        let scale = at.load_scale();
        let scale = if scale.is_finite() { scale } else { 0.0 };
        scale / total_mass(scene).sqrt()
    }

    /// Whether what is left, in every coordinate, is what the last digits of the positions make of stiff forces.
    fn is_rounding(&self, p: &Point, jacobian: &DMatrix<f64>) -> bool {
        let scene = &self.system.scene;
        let mut unit = vec![1.0; self.n_v()];
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let (Some(v), false) = (f.v, c.angular) {
                unit[v] = scene.length;
            }
        }
        (0..self.n_v()).all(|i| {
            let stiffness = (0..self.n_v()).map(|v| jacobian[(i, v)].abs() * unit[v]);
            p.force[i].abs() <= 16.0 * f64::EPSILON * stiffness.sum::<f64>()
        }) && p.state.amax() <= self.settings.error
    }

    /// How large the terms of the differential equations are.
    fn state_scale(&self, p: &Point) -> f64 {
        let first = self.system.scene.layout.x().start;
        let states = self.states.iter().map(|x| p.numbers[first + x].abs());
        states.fold(0.0, f64::max)
    }

    /// Length of the first step: a hundredth of the mechanism's size, or of a radian.
    fn first(&self, p: &Point) -> f64 {
        let scene = &self.system.scene;
        let rate = p.metric.solve(&p.force);
        let mut fastest = p.state.amax();
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let Some(v) = f.v {
                let unit = if c.angular { 1.0 } else { scene.length };
                fastest = fastest.max(rate[v].abs() / unit);
            }
        }
        if fastest > 0.0 { 0.01 / fastest } else { 1.0 }
    }

    /// Length of a step that is Newton's but for the part of the mass that STABILITY asks for, small against all stiffness.
    fn longest(&self, p: &Point, jacobian: &DMatrix<f64>) -> f64 {
        let n = self.n_v();
        let mut least = f64::INFINITY;
        for v in 0..n {
            let stiffness = (0..n).map(|i| jacobian[(i, v)].abs()).fold(0.0, f64::max);
            if stiffness > 0.0 {
                least = least.min(stiffness / p.mass[(v, v)].max(1e-300));
            }
        }
        let scale = if least.is_finite() { least } else { 1.0 };
        1.0 / (scale * self.settings.stability.min(1e-2) * 1e-7)
    }

    /// Whether what is left satisfies the tolerances of EQUILIBRIUM.
    fn converged(&self, p: &Point) -> bool {
        p.force.amax() <= self.settings.imbalance && p.state.amax() <= self.settings.error
    }

    /// Names what is not balanced: the coordinate that would be accelerated most.
    fn unbalanced(&self, p: &Point) -> NoEquilibrium {
        let scene = &self.system.scene;
        let rate = p.metric.solve(&p.force);
        let unit = |angular: bool| if angular { 1.0 } else { scene.length };
        let worst = scene
            .coordinates
            .iter()
            .zip(&scene.freedoms)
            .filter_map(|(c, f)| {
                let v = f.v?;
                Some((rate[v].abs() / unit(c.angular), c, f, p.force[v]))
            })
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let state = (0..self.states.len()).max_by(|&a, &b| {
            let size = |k: usize| p.state[k].abs();
            size(a).total_cmp(&size(b))
        });
        if let (Some(k), true) = (state, worst.as_ref().is_none_or(|w| w.0 < 1e-9)) {
            let place = self.states[k];
            let found = scene.differentials.iter().find(|d| d.state == Some(place));
            let name = found.map_or_else(String::new, |d| d.name.clone());
            let sentence = format!("no equilibrium: {name} keeps the rate {:.6e}", p.state[k]);
            return NoEquilibrium::Unbalanced(sentence, name);
        }
        let Some((_, c, f, force)) = worst else {
            return NoEquilibrium::Unbalanced("no equilibrium".into(), String::new());
        };
        let at = Equations::new(scene, &p.numbers);
        let axis = at.freedom_axis(f);
        let way = axis.times(f64::signum(force));
        let part = (scene.parts.iter())
            .find(|part| part.link.is_some_and(|l| carries(scene, f.link, l)))
            .map_or_else(String::new, |part| {
                crate::scene::compile::part_name(part.point_mass, part.id)
            });
        let what = if f.turn { "torque" } else { "force" };
        let round = |x: f64| if x.abs() < 5e-7 { 0.0 } else { x };
        let [x, y, z] = way.0.map(round);
        let sentence = format!(
            "no equilibrium: a {what} of {:.6e} on {part} remains along ({x:.6}, {y:.6}, {z:.6}), {}",
            force.abs(),
            c.name
        );
        NoEquilibrium::Unbalanced(sentence, c.name.clone())
    }

    /// What a push does, and the direction in which it leaves fastest.
    fn stability(&self, p: &Point, jacobian: &DMatrix<f64>) -> (Stability, Option<DVector<f64>>) {
        let (n, d) = (self.n_v(), self.states.len());
        // states follow: K − K_x e_x⁻¹ e_q
        let mut k = jacobian.view((0, 0), (n, n)).into_owned();
        if d > 0 {
            let own = jacobian.view((n, n), (d, d)).into_owned();
            if let Some(inverse) = own.try_inverse() {
                let follow = inverse * jacobian.view((n, 0), (d, n));
                k -= jacobian.view((0, n), (n, d)) * follow;
            }
        }
        let gradient = p.gradient.transpose();
        let columns = gradient.column_iter().map(|c| c.iter().copied().collect());
        let columns: Vec<Vec<f64>> = columns.collect();
        let free = Rank::of(columns.iter().map(Vec::as_slice), n, TOLERANCE).free_directions();
        let f = free.len();
        if f == 0 {
            return (Stability::default(), None);
        }
        let z = DMatrix::from_fn(n, f, |i, j| free[j][i]);
        let stiffness = -(z.transpose() * k * &z);
        let inertia = z.transpose() * metric(&self.system.scene, &p.mass) * &z;
        let Some(factor) = Cholesky::new(inertia) else {
            return (Stability::default(), None);
        };
        // L⁻¹ K L⁻ᵀ
        let lower = factor.l();
        let half = lower.solve_lower_triangular(&stiffness);
        let reduced = half.and_then(|h| lower.solve_lower_triangular(&h.transpose()));
        let Some(reduced) = reduced.map(|r| r.transpose()) else {
            return (Stability::default(), None);
        };
        let symmetric = (&reduced + reduced.transpose()) * 0.5;
        let eigen = symmetric.symmetric_eigen();
        let values: Vec<f64> = if asymmetry(&reduced) < 1e-6 {
            eigen.eigenvalues.iter().copied().collect()
        } else {
            reduced.complex_eigenvalues().iter().map(|c| c.re).collect()
        };
        let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut found = Stability::default();
        for x in &values {
            if x.abs() <= 1e-9 * largest || largest == 0.0 {
                found.neutral += 1;
            } else if *x > 0.0 {
                found.stable += 1;
            } else {
                found.unstable += 1;
            }
        }
        let lowest = eigen.eigenvalues.imin();
        let direction = eigen.eigenvectors.column(lowest).into_owned();
        let direction = lower.tr_solve_lower_triangular(&direction).map(|c| z * c);
        let unit = direction.map(|x| {
            let size = self.excess(&x) * self.settings.angle;
            let mut x = if size > 0.0 { x / size } else { x };
            x = x.insert_rows(n, d, 0.0);
            x
        });
        (found, unit)
    }
}

/// Whether link `l` is `base` or carried by it.
fn carries(scene: &Scene, base: usize, l: usize) -> bool {
    let mut at = Some(l);
    while let Some(k) = at {
        if k == base {
            return true;
        }
        at = scene.links[k].parent;
    }
    false
}

fn total_mass(scene: &Scene) -> f64 {
    let mass: f64 = scene.links.iter().map(|l| l.mass).sum();
    if mass > 0.0 { mass } else { 1.0 }
}

/// The mass matrix over free coordinates.
fn mass(scene: &Scene, at: &Equations<'_, f64>) -> DMatrix<f64> {
    let n = scene.layout.n_v;
    let mut mass = DMatrix::zeros(n, n);
    for (i, row) in at.mass_rows().into_iter().enumerate() {
        for (j, m) in row {
            mass[(i, j)] = m;
            mass[(j, i)] = m;
        }
    }
    mass
}

/// D: the mass matrix and a millionth of the whole mass in every direction, so that nothing is without any.
fn metric(scene: &Scene, mass: &DMatrix<f64>) -> DMatrix<f64> {
    let own = 1e-6 * total_mass(scene);
    let mut metric = mass.clone();
    for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
        if let (Source::Free { v, .. }, true) = (c.source, f.v.is_some()) {
            metric[(v, v)] += if c.angular {
                own * scene.length * scene.length
            } else {
                own
            };
        }
    }
    metric
}

/// `√(fᵀ D⁻¹ f)`
fn in_metric(metric: &Cholesky<f64, Dyn>, f: &DVector<f64>) -> f64 {
    f.dot(&metric.solve(f)).max(0.0).sqrt()
}

/// λ that makes `f + Gᵀλ` smallest in the metric.
fn least_multipliers(
    metric: &Cholesky<f64, Dyn>,
    gradient: &DMatrix<f64>,
    f: &DVector<f64>,
) -> DVector<f64> {
    let m = gradient.nrows();
    if m == 0 {
        return DVector::zeros(0);
    }
    let moved = metric.solve(&gradient.transpose());
    let gram = gradient * &moved;
    let rhs = -moved.tr_mul(f);
    match Cholesky::new(gram.clone()) {
        Some(factor) => {
            // once more, as the matrix may be badly scaled
            let mut lambda = factor.solve(&rhs);
            lambda += factor.solve(&(rhs - gram * &lambda));
            lambda
        }
        None => {
            let largest = gram.amax();
            let svd = gram.svd(true, true);
            svd.solve(&rhs, 1e-12 * largest)
                .unwrap_or_else(|_| DVector::zeros(m))
        }
    }
}

/// Whether the symmetric part of a matrix is positive on what the rows leave free.
fn goes_down(a: &DMatrix<f64>, gradient: &DMatrix<f64>) -> bool {
    let mut s = (a + a.transpose()) * 0.5;
    if gradient.nrows() > 0 {
        // a large stiffness against leaving the rows, in each row alike
        let size = s.amax();
        for row in gradient.row_iter() {
            let n2 = row.norm_squared();
            if n2 > 0.0 {
                s += row.transpose() * row * (1e6 * size / n2);
            }
        }
    }
    Cholesky::new(s).is_some()
}

/// Size of the part that is not symmetric, relative to the whole.
fn asymmetry(a: &DMatrix<f64>) -> f64 {
    let size = a.amax();
    if size == 0.0 {
        return 0.0;
    }
    (a - a.transpose()).amax() / size
}
