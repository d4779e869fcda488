//! The fall: steps that grow until they are Newton's, and what ends it.

use super::metric::total_mass;
use super::point::Point;
use super::step::Pace;
use super::{NoEquilibrium, Settler};
use crate::analysis::watch::Watch;
use crate::scene::equations::Equations;
use nalgebra::{DMatrix, DVector};

/// Part of the loads below which what is left of them is rounding.
const ROUNDING: f64 = 1e-13;
/// Part of the loads below which an iteration that no longer improves has arrived.
const STAGNANT: f64 = 1e-8;
/// How much longer steps may become while something soft between what is stiff still goes: then the matrix keeps a digit.
const SOFT: f64 = 1e3;
/// Samples of what rounding could do.
const SAMPLES: usize = 4;
/// Steps of the fall at most, whatever MAXIT says of Newton.
const MAX_STEPS: usize = 3000;
/// Steps within the tolerances of EQUILIBRIUM that may still make it better: Newton's take a few, what rattles between kinks or rounding takes for ever.
const POLISH: usize = 25;
/// Of these, steps in a row that need not make it half as bad, where the tolerances were asked for.
const IDLE: usize = 5;
/// Steps at the limit of their length without any change of the loads, after which it falls forever.
const FALLING: usize = 300;

impl Settler<'_> {
    /// Falls from `p` until nothing pulls any more; the derivatives at the end.
    pub(super) fn fall(
        &mut self,
        p: &mut Point,
        iterations: &mut usize,
        watch: &mut dyn Watch,
    ) -> (Result<(), NoEquilibrium>, DMatrix<f64>) {
        let n = self.n_v();
        let mut scales = [0.0_f64; 2];
        let mut h: Option<f64> = None;
        let (mut falling, mut polish) = (0, 0);
        // the least that was left within the tolerances, and for how many steps it has not been halved
        let (mut best, mut idle) = (f64::INFINITY, 0);
        // how large the last step wanted to be
        let mut before = f64::INFINITY;
        let mut jacobian = self.jacobian(p);
        let budget = MAX_STEPS.max(self.settings.iterations) + *iterations;
        loop {
            scales[0] = scales[0].max(self.load_scale(p)).max(p.left[0]);
            scales[1] = scales[1].max(p.left[1]).max(self.state_scale(p));
            if p.left[0] <= ROUNDING * scales[0] && p.left[1] <= ROUNDING * scales[1] {
                return (Ok(()), jacobian);
            }
            let noise = self.noise(&jacobian);
            let floor = p.metric.size(&noise);
            let small =
                p.left[0] <= (STAGNANT * scales[0]).max(floor) && p.left[1] <= STAGNANT * scales[1];
            if watch.interrupted() {
                return (Err(NoEquilibrium::Interrupted), jacobian);
            }
            // as good as was asked for: go on only as long as that soon ends
            let enough = self.converged(p) && (small || self.settings.asked);
            polish = if enough { polish + 1 } else { 0 };
            idle = if enough && p.left[0] > 0.5 * best {
                idle + 1
            } else {
                0
            };
            if enough && idle == 0 {
                best = p.left[0];
            }
            if polish > POLISH || self.settings.asked && idle > IDLE {
                return (Ok(()), jacobian);
            }
            if *iterations >= budget || falling > FALLING {
                if self.is_rounding(p, &jacobian, &noise) {
                    return (Ok(()), jacobian);
                }
                return (Err(self.unbalanced(p)), jacobian);
            }
            let mut longest = self.longest(p, &jacobian);
            if small {
                if self.is_rounding(p, &jacobian, &noise) {
                    // stiff contacts make more of the last digits than any step could take away
                    if p.left[1] <= ROUNDING * scales[1] {
                        return (Ok(()), jacobian);
                    }
                } else {
                    // something soft between what is stiff still goes
                    longest *= SOFT;
                }
            }
            let mut length = h.unwrap_or_else(|| self.first(p)).min(longest);
            let mut wanted = 0.0;
            // shorter and shorter until the end is what was foretold
            let accepted = loop {
                let pace = Pace::new(length, &jacobian, n);
                let trial = self.step(p, &jacobian, &pace);
                let found = trial.and_then(|step| {
                    wanted = self.excess(&step);
                    (self.attempt(p, &jacobian, floor, step.clone()))
                        .or_else(|| self.corrected(p, floor, step, &pace))
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
                if small || self.converged(p) || self.is_rounding(p, &jacobian, &noise) {
                    return (Ok(()), jacobian);
                }
                return (Err(self.unbalanced(p)), jacobian);
            };
            let same = (next.left[0] - p.left[0]).abs() <= 1e-6 * p.left[0];
            falling = if shortened && same { falling + 1 } else { 0 };
            // what is stiff may have arrived while what is soft still goes: neither gets better
            let arrived = small
                && length >= longest
                && next.left[0] > 0.5 * p.left[0]
                && wanted > 0.5 * before;
            before = if length >= longest {
                wanted
            } else {
                f64::INFINITY
            };
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

    /// How large forces are, in the metric, whatever cancels.
    fn load_scale(&self, p: &Point) -> f64 {
        let scene = &self.system.scene;
        let at = Equations::new(scene, &p.numbers);
        let scale = at.load_scale();
        let scale = if scale.is_finite() { scale } else { 0.0 };
        scale / total_mass(scene).sqrt()
    }

    /// What the last digits of the positions make of stiff forces, in each coordinate, as it is met:
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

    /// A radian, or the size of the mechanism, for each coordinate.
    fn units(&self) -> Vec<f64> {
        let scene = &self.system.scene;
        let mut unit = vec![1.0; self.n_v()];
        for (c, f) in scene.coordinates.iter().zip(&scene.freedoms) {
            if let (Some(v), false) = (f.v, c.angular) {
                unit[v] = scene.length;
            }
        }
        unit
    }

    /// Whether what is left is what the last digits of the positions make of stiff forces: in every coordinate by its size, and in soft directions, where
    /// stiff forces cancel, by what Newton's step would still do about it.
    fn is_rounding(&mut self, p: &Point, jacobian: &DMatrix<f64>, noise: &DVector<f64>) -> bool {
        let unit = self.units();
        let within = (0..self.n_v()).all(|i| {
            let stiffness = (0..self.n_v()).map(|v| jacobian[(i, v)].abs() * unit[v]);
            p.force[i].abs() <= 16.0 * f64::EPSILON * stiffness.sum::<f64>()
        }) && p.state.amax() <= self.settings.error;
        if !within {
            return false;
        }
        let pace = Pace::new(SOFT * self.longest(p, jacobian), jacobian, self.n_v());
        let Some(step) = self.newton(p, jacobian, &pace, &p.force) else {
            return true;
        };
        // noise of any sign; a few samples tell how far it goes
        let mut signs = 0x9e37_79b9_7f4a_7c15_u64;
        let reach = (0..SAMPLES).filter_map(|_| {
            let any = noise.map(|n| {
                signs = signs.rotate_left(7).wrapping_mul(0xd128_2a95_8b1c_9e6d);
                if signs >> 63 == 0 { n } else { -n }
            });
            let step = self.newton(p, jacobian, &pace, &any)?;
            Some(self.excess(&step))
        });
        let reach = reach.fold(0.0, f64::max);
        self.excess(&step) <= reach
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
    pub(super) fn longest(&self, p: &Point, jacobian: &DMatrix<f64>) -> f64 {
        let n = self.n_v();
        let mut least = f64::INFINITY;
        for v in 0..n {
            let stiffness = (0..n).map(|i| jacobian[(i, v)].abs()).fold(0.0, f64::max);
            if stiffness > 0.0 {
                least = least.min(stiffness / p.metric.mass[v].max(1e-300));
            }
        }
        let scale = if least.is_finite() { least } else { 1.0 };
        1.0 / (scale * self.settings.stability.min(1e-2) * 1e-7)
    }

    /// Whether what is left satisfies the tolerances of EQUILIBRIUM.
    fn converged(&self, p: &Point) -> bool {
        p.force.amax() <= self.settings.imbalance && p.state.amax() <= self.settings.error
    }
}
