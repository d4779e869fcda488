//! The descent: steps that grow until they are Newton's, and what ends it.

use super::metric::total_mass;
use super::point::Point;
use super::step::Pace;
use super::{NoEquilibrium, Settler};
use crate::scene::equations::Equations;
use nalgebra::{DMatrix, DVector};

/// Part of the loads below which what is left of them is rounding, as a shorter way is than this,
/// in rad or in sizes of the mechanism.
const ROUNDING: f64 = 1e-13;
/// Part of the loads below which an iteration that no longer improves has arrived.
pub(super) const STAGNANT: f64 = 1e-8;
/// Factor by which steps may become longer while something soft between what is stiff still goes:
/// then the matrix keeps a digit.
const SOFT_FACTOR: f64 = 1e3;
/// Samples of what rounding could do.
const NOISE_SAMPLES: usize = 4;
/// Steps of the descent at most, whatever MAXIT says of Newton.
const MAX_STEPS: usize = 3000;
/// Steps within the tolerances of EQUILIBRIUM that may still make it better: Newton's take a few,
/// what rattles between kinks or rounding takes for ever.
const MAX_POLISHING: usize = 25;
/// Of these, steps in a row that need not make it half as bad, where the tolerances were asked for.
const MAX_IDLE: usize = 5;
/// Steps at the limit of their length without any change of the loads, after which the mechanism
/// falls for ever.
const MAX_FALLING: usize = 300;

/// The course of a descent from step to step.
struct Course {
    /// largest loads and states so far: what is left is measured against them
    scales: [f64; 2],
    /// length of the next step; `None`: the first
    length: Option<f64>,
    /// steps in a row at the limit of their length that changed no load
    falling: usize,
    /// steps in a row within the tolerances; of these, steps that did not halve what was left
    polishing: usize,
    idle: usize,
    /// the least that was left within the tolerances
    best: f64,
    /// size of the last step before it was shortened, where it was as long as it may be
    wanted: f64,
    /// whether the last step was shortened because of TLIMIT or ALIMIT
    limited: bool,
}

impl Course {
    fn new() -> Self {
        Self {
            scales: [0.0; 2],
            length: None,
            falling: 0,
            polishing: 0,
            idle: 0,
            best: f64::INFINITY,
            wanted: f64::INFINITY,
            limited: false,
        }
    }

    /// Counts a configuration that is as good as was asked for, or not; whether it is time to end.
    fn is_polished(&mut self, enough: bool, left: f64, asked: bool) -> bool {
        self.polishing = if enough { self.polishing + 1 } else { 0 };
        self.idle = if enough && left > 0.5 * self.best {
            self.idle + 1
        } else {
            0
        };
        if enough && self.idle == 0 {
            self.best = left;
        }
        self.polishing > MAX_POLISHING || asked && self.idle > MAX_IDLE
    }

    /// Takes a step into account; whether what is stiff has arrived while what is soft still goes,
    /// so that neither gets better.
    fn advance(&mut self, p: &Point, step: &Taken, small: bool, longest: f64) -> bool {
        let (next, full) = (&step.point, step.length >= longest);
        let same = (next.left[0] - p.left[0]).abs() <= 1e-6 * p.left[0];
        self.falling = if step.shortened && same {
            self.falling + 1
        } else {
            0
        };
        let arrived =
            small && full && next.left[0] > 0.5 * p.left[0] && step.wanted > 0.5 * self.wanted;
        self.wanted = if full { step.wanted } else { f64::INFINITY };
        self.limited = step.shortened;
        let growth = if step.shortened {
            1.0
        } else if step.quality < 0.1 {
            10.0
        } else {
            2.0
        };
        self.length = Some(step.length * growth);
        arrived
    }
}

/// A step that was taken.
struct Taken {
    point: Point,
    /// how far the loads at its end are from those that were foretold
    quality: f64,
    /// whether it was made shorter because of TLIMIT or ALIMIT
    shortened: bool,
    length: f64,
    /// its size before that, in units of the limits
    wanted: f64,
}

/// The reason why no step is taken, however short.
enum NoStep {
    /// Newton's steps no longer improve: what is left is rounding
    Arrived,
    /// the loads at the end of each are not those that were foretold
    Unforeseen,
}

/// The size of what is left, against what rounding does.
struct Left {
    /// what rounding does in each coordinate, and its size in the metric
    noise: DVector<f64>,
    floor: f64,
    /// what it does in the equations of the states
    states: f64,
    /// hardly more than that is left of loads, and of states
    rests: [bool; 2],
    /// of both
    small: bool,
}

impl Settler<'_> {
    /// Descends from `p` until nothing pulls any more; the derivatives at the end.
    pub(super) fn descend(
        &mut self,
        p: &mut Point,
        iterations: &mut usize,
    ) -> (Result<(), NoEquilibrium>, DMatrix<f64>) {
        let mut jacobian = self.jacobian(p);
        let outcome = self.steps(p, &mut jacobian, iterations);
        (outcome, jacobian)
    }

    fn steps(
        &mut self,
        p: &mut Point,
        jacobian: &mut DMatrix<f64>,
        iterations: &mut usize,
    ) -> Result<(), NoEquilibrium> {
        let budget = MAX_STEPS.max(self.settings.iterations) + *iterations;
        let mut course = Course::new();
        loop {
            // what is left
            let [loads, states] = &mut course.scales;
            *loads = loads.max(self.load_scale(p)).max(p.left[0]);
            *states = states.max(p.left[1]).max(self.state_scale(p));
            let scales = course.scales;
            if p.left[0] <= ROUNDING * scales[0] && p.left[1] <= ROUNDING * scales[1] {
                return Ok(());
            }
            let left = self.left(p, jacobian, scales);
            if self.asked.stops() {
                return Err(NoEquilibrium::Interrupted);
            }
            // as good as was asked for: go on only as long as that soon ends
            let asked = self.settings.asked();
            let enough = self.converged(p, &left) && (left.small || asked);
            if course.is_polished(enough, p.left[0], asked) {
                return Ok(());
            }
            if *iterations >= budget || course.falling > MAX_FALLING {
                return self.unless_rounding(p, jacobian, &left, course.limited);
            }
            // a step
            let Some(longest) = self.permitted(p, jacobian, &left, scales) else {
                return Ok(());
            };
            let length = course.length.unwrap_or_else(|| self.first(p)).min(longest);
            let step = match self.search(p, jacobian, &left, (length, longest)) {
                Ok(step) => step,
                Err(NoStep::Arrived) => return Ok(()),
                Err(NoStep::Unforeseen) if left.small || self.converged(p, &left) => return Ok(()),
                Err(NoStep::Unforeseen) => {
                    return self.unless_rounding(p, jacobian, &left, false);
                }
            };
            // take it
            let arrived = course.advance(p, &step, left.small, longest);
            *p = step.point;
            *iterations += 1;
            *jacobian = self.jacobian(p);
            if arrived {
                return Ok(());
            }
        }
    }

    /// Measures what is left against what rounding does.
    fn left(&self, p: &Point, jacobian: &DMatrix<f64>, scales: [f64; 2]) -> Left {
        let noise = self.noise(jacobian);
        let floor = p.metric.size(&noise);
        let rests = [
            p.left[0] <= (STAGNANT * scales[0]).max(floor),
            p.left[1] <= STAGNANT * scales[1],
        ];
        Left {
            noise,
            floor,
            states: self.state_noise(p, jacobian),
            rests,
            small: rests == [true; 2],
        }
    }

    /// Ends the descent where it leads no further; `limited`: because of TLIMIT or ALIMIT.
    fn unless_rounding(
        &mut self,
        p: &Point,
        jacobian: &DMatrix<f64>,
        left: &Left,
        limited: bool,
    ) -> Result<(), NoEquilibrium> {
        if self.is_rounding(p, jacobian, left) {
            return Ok(());
        }
        Err(self.unbalanced(p, limited))
    }

    /// Returns how long a step may be; `None`: no step can make it better.
    fn permitted(
        &mut self,
        p: &Point,
        jacobian: &DMatrix<f64>,
        left: &Left,
        scales: [f64; 2],
    ) -> Option<f64> {
        let longest = self.longest(p, jacobian);
        if !left.small {
            return Some(longest);
        }
        if !self.is_rounding(p, jacobian, left) {
            // something soft between what is stiff still goes
            return Some(longest * SOFT_FACTOR);
        }
        // stiff contacts make more of the last digits than any step could take away
        (p.left[1] > ROUNDING * scales[1]).then_some(longest)
    }

    /// Tries shorter and shorter steps until the loads at the end are those that were foretold.
    fn search(
        &mut self,
        p: &Point,
        jacobian: &DMatrix<f64>,
        left: &Left,
        (mut length, longest): (f64, f64),
    ) -> Result<Taken, NoStep> {
        let mut wanted = 0.0;
        let fastest = self.fastest(p);
        loop {
            let pace = Pace::new(length, jacobian, self.n_v());
            let floor = [left.floor, left.states];
            let found = self.step(p, jacobian, &pace).and_then(|step| {
                wanted = self.excess(&step);
                (self.attempt(p, jacobian, floor, step.clone()))
                    .or_else(|| self.corrected(p, jacobian, floor, step, &pace))
            });
            if let Some((point, quality, shortened)) = found {
                return Ok(Taken {
                    point,
                    quality,
                    shortened,
                    length,
                    wanted,
                });
            }
            if left.small && length >= longest {
                return Err(NoStep::Arrived);
            }
            if self.asked.stops() {
                return Err(NoStep::Unforeseen);
            }
            length *= 0.25;
            if length * fastest < ROUNDING {
                return Err(NoStep::Unforeseen);
            }
        }
    }

    /// Returns how large forces are, in the metric, whatever cancels.
    pub(super) fn load_scale(&self, p: &Point) -> f64 {
        let scene = self.system.configured();
        let at = Equations::new(scene, &p.numbers);
        let scale = at.load_scale();
        let scale = if scale.is_finite() { scale } else { 0.0 };
        scale / total_mass(&scene).sqrt()
    }

    /// Returns what the last digits of the positions make of stiff forces, in each coordinate, as
    /// it is met:
    ///
    /// ```text
    /// n_i = ε √Σ (∂f_i/∂q_v u_v)²      u: a radian, or the size of the mechanism
    /// ```
    fn noise(&self, jacobian: &DMatrix<f64>) -> DVector<f64> {
        let unit = self.units();
        DVector::from_fn(self.n_v(), |i, _| {
            let terms = (unit.iter().enumerate()).map(|(v, u)| (jacobian[(i, v)] * u).powi(2));
            f64::EPSILON * terms.sum::<f64>().sqrt()
        })
    }

    /// Returns what the last digits of positions and states make of the equations of the states: in
    /// balance these are differences of larger terms.
    fn state_noise(&self, p: &Point, jacobian: &DMatrix<f64>) -> f64 {
        let (n, l) = (self.n_v(), self.system.scene.layout);
        let mut unit = self.units();
        unit.extend(self.states.iter().map(|&x| p.numbers[l.x_at(x)]));
        let terms = (unit.iter().enumerate()).map(|(v, u)| {
            let column = jacobian.view((n, v), (self.states.len(), 1));
            column.norm_squared() * u * u
        });
        16.0 * f64::EPSILON * terms.sum::<f64>().sqrt()
    }

    /// Returns a radian, or the size of the mechanism, for each coordinate.
    pub(super) fn units(&self) -> Vec<f64> {
        let scene = &self.system.scene;
        let mut unit = vec![1.0; self.n_v()];
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let (Some(v), false) = (f.v, c.angular) {
                unit[v] = scene.length;
            }
        }
        unit
    }

    /// Returns whether what is left is what the last digits of the positions make of stiff forces:
    /// in every coordinate by its size, and in soft directions, where stiff forces cancel, by what
    /// Newton's step would still do about it.
    fn is_rounding(&mut self, p: &Point, jacobian: &DMatrix<f64>, left: &Left) -> bool {
        let unit = self.units();
        let within = (0..self.n_v()).all(|i| {
            let stiffness = (0..self.n_v()).map(|v| jacobian[(i, v)].abs() * unit[v]);
            p.force[i].abs() <= 16.0 * f64::EPSILON * stiffness.sum::<f64>()
        }) && self.at_rest(p, left);
        if !within {
            return false;
        }
        let pace = Pace::new(
            SOFT_FACTOR * self.longest(p, jacobian),
            jacobian,
            self.n_v(),
        );
        let Some(step) = self.newton(p, jacobian, &pace, &p.force) else {
            return true;
        };
        // noise of any sign; a few samples tell how far it goes
        let mut signs = 0x9e37_79b9_7f4a_7c15_u64;
        let reach = (0..NOISE_SAMPLES).filter_map(|_| {
            let any = left.noise.map(|n| {
                signs = signs.rotate_left(7).wrapping_mul(0xd128_2a95_8b1c_9e6d);
                if signs >> 63 == 0 { n } else { -n }
            });
            let step = self.newton(p, jacobian, &pace, &any)?;
            Some(self.excess(&step))
        });
        let reach = reach.fold(0.0, f64::max);
        self.excess(&step) <= reach
    }

    /// Returns how large the terms of the differential equations are.
    fn state_scale(&self, p: &Point) -> f64 {
        let l = self.system.scene.layout;
        let states = self.states.iter().map(|&x| p.numbers[l.x_at(x)].abs());
        states.fold(0.0, f64::max)
    }

    /// Returns how fast the descent begins, in rad or in sizes of the mechanism over its own time.
    fn fastest(&self, p: &Point) -> f64 {
        let rate = p.metric.solve(&p.force);
        let rates = rate.iter().zip(self.units());
        rates.fold(p.state.amax(), |most, (x, unit)| most.max(x.abs() / unit))
    }

    /// Returns the length of the first step: a hundredth of the mechanism's size, or of a radian.
    fn first(&self, p: &Point) -> f64 {
        let fastest = self.fastest(p);
        self.settings.pace * if fastest > 0.0 { 0.01 / fastest } else { 1.0 }
    }

    /// Returns the length of a step that is Newton's but for the part of the mass that STABILITY
    /// asks for, small against all stiffness.
    pub(super) fn longest(&self, p: &Point, jacobian: &DMatrix<f64>) -> f64 {
        let unit = self.units();
        let mut least = f64::INFINITY;
        for (v, own) in unit.iter().enumerate() {
            let loads = unit.iter().enumerate();
            let stiffness = loads.fold(0.0, |most: f64, (i, unit)| {
                most.max(jacobian[(i, v)].abs() * unit)
            });
            if stiffness > 0.0 {
                least = least.min(stiffness / (own * p.metric.mass[v]).max(f64::MIN_POSITIVE));
            }
        }
        let scale = match (least.is_finite(), self.fastest(p)) {
            (true, _) => least,
            // nothing is stiff: it falls
            (false, fastest) if fastest > 0.0 => fastest,
            (false, _) => 1.0,
        };
        1.0 / (scale * self.settings.stability.min(1e-2) * 1e-7)
    }

    /// Returns whether what is left satisfies the tolerances of EQUILIBRIUM, and where it has none
    /// is hardly more than rounding.
    fn converged(&self, p: &Point, left: &Left) -> bool {
        let limit = self.settings.imbalance;
        limit.map_or(left.rests[0], |limit| p.force.amax() <= limit) && self.at_rest(p, left)
    }

    /// The same of the states.
    fn at_rest(&self, p: &Point, left: &Left) -> bool {
        let limit = self.settings.error;
        limit.map_or(left.rests[1], |limit| p.state.amax() <= limit)
    }
}
