//! The reason why no equilibrium is found: the load that nothing carries.

use super::descent::STAGNANT;
use super::point::Point;
use super::step::Pace;
use super::{NoEquilibrium, Settler};
use crate::analysis::quantity::short;
use crate::scene::Scene;
use crate::scene::equations::{Equations, Unsupported};
use crate::space::Vec3;
use nalgebra::DVector;
use std::fmt;

/// The load that is not balanced where no equilibrium is found.
#[derive(Clone, Debug, PartialEq)]
pub enum Imbalance {
    /// the loads cannot be written down; why
    Unsupported(Unsupported),
    /// the loads have no finite value to start from
    NoValue,
    /// a differential equation does not come to rest
    Rate {
        /// its name
        name: String,
        /// the rate that is left
        rate: f64,
    },
    /// a load on a freedom is left
    Load {
        /// a torque, else a force
        torque: bool,
        /// its size
        size: f64,
        /// the part that it acts on
        part: String,
        /// unit vector in ground axes
        way: Vec3<f64>,
        /// the coordinate of the freedom
        coordinate: String,
        /// it stays however far anything gives way
        uncarried: bool,
        /// TLIMIT or ALIMIT have kept the search from going farther
        limited: bool,
    },
    /// the search ended for no reason that could be found
    Unknown,
}

impl Imbalance {
    /// Returns whether it is a load that stays however far anything gives way.
    pub(in crate::analysis) fn is_uncarried(&self) -> bool {
        matches!(
            self,
            Imbalance::Load {
                uncarried: true,
                ..
            }
        )
    }

    /// Name of the coordinate or equation that is not at rest; empty: none is to blame.
    pub fn name(&self) -> &str {
        match self {
            Imbalance::Unsupported(_) | Imbalance::NoValue | Imbalance::Unknown => "",
            Imbalance::Rate { name, .. } => name,
            Imbalance::Load { coordinate, .. } => coordinate,
        }
    }
}

impl fmt::Display for Imbalance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Imbalance::Unsupported(why) => write!(f, "{why}"),
            Imbalance::NoValue => {
                f.write_str("the loads have no finite value in the configuration to start from")
            }
            Imbalance::Rate { name, rate } => {
                write!(f, "no equilibrium: {name} keeps the rate {rate:.6e}")
            }
            Imbalance::Load {
                torque,
                size,
                part,
                way,
                coordinate,
                uncarried,
                limited,
            } => {
                let what = if *torque { "torque" } else { "force" };
                let round = |x: f64| if x.abs() < 5e-7 { 0.0 } else { x };
                let [x, y, z] = way.0.map(round);
                let why = match (uncarried, limited) {
                    (true, _) => "; nothing carries it",
                    (false, true) => {
                        "; the last step was still as long as TLIMIT and ALIMIT of EQUILIBRIUM \
                         permit: larger ones lead farther"
                    }
                    (false, false) => "",
                };
                write!(
                    f,
                    "no equilibrium: a {what} of {} on {part} remains along ({x:.6}, {y:.6}, {z:.6}), {coordinate}{why}",
                    short(*size)
                )
            }
            Imbalance::Unknown => f.write_str("no equilibrium"),
        }
    }
}

/// Number of times that a step is made shorter until its matrix is regular.
const MAX_SHORTENINGS: usize = 8;

impl Settler<'_> {
    /// Returns the loads that keep accelerating the model when all that gives way has given way as
    /// far as it can; `None` where that is not known.
    ///
    /// ```text
    /// D Δ/h = f + K Δ + Gᵀλ,  h → ∞
    /// ```
    fn carried_by_nothing(&mut self, p: &Point) -> Option<DVector<f64>> {
        let jacobian = self.jacobian(p);
        let n = self.n_v();
        // as long as the matrix bears it, with a few digits left
        let mut length = 100.0 * self.longest(p, &jacobian);
        let step = (0..MAX_SHORTENINGS).find_map(|_| {
            length *= 0.01;
            let pace = Pace::new(length, &jacobian, n);
            self.newton(p, &jacobian, &pace, &p.force)?;
            let pace = Pace::new(0.01 * length, &jacobian, n);
            self.newton(p, &jacobian, &pace, &p.force)
        })?;
        let load = p.metric.times(&step.as_slice()[..n]) / (0.01 * length);
        (p.metric.size(&load) > 1e-3 * p.left[0]).then_some(load)
    }

    /// Names what is not balanced: the largest of the loads that nothing carries, else the
    /// coordinate that would be accelerated most; `limited`: by TLIMIT or ALIMIT.
    pub(super) fn unbalanced(&mut self, p: &Point, limited: bool) -> NoEquilibrium {
        let uncarried = self.carried_by_nothing(p);
        let scene = &self.system.scene;
        let rate = p.metric.solve(&p.force);
        let unit = |angular: bool| if angular { 1.0 } else { scene.length };
        let worst = scene
            .coordinates
            .iter()
            .zip(&scene.freedoms)
            .filter_map(|(c, f)| {
                let v = f.v?;
                Some(match &uncarried {
                    Some(load) => {
                        let lever = if c.angular { scene.length } else { 1.0 };
                        (load[v].abs() / lever, c, f, load[v])
                    }
                    None => (rate[v].abs() / unit(c.angular), c, f, p.force[v]),
                })
            })
            .max_by(|a, b| a.0.total_cmp(&b.0));
        let state = (0..self.states.len()).max_by(|&a, &b| {
            let size = |k: usize| p.state[k].abs();
            size(a).total_cmp(&size(b))
        });
        let balanced = p.left[0] <= STAGNANT * self.load_scale(p);
        if let (Some(k), true) = (state, balanced || worst.is_none()) {
            let place = self.states[k];
            return NoEquilibrium::Unbalanced(Imbalance::Rate {
                name: scene.unknowns.x[place].to_string(),
                rate: p.state[k],
            });
        }
        let Some((_, c, f, force)) = worst else {
            return NoEquilibrium::Unbalanced(Imbalance::Unknown);
        };
        let at = Equations::new(self.system.configured(), &p.numbers);
        let axis = at.freedom_axis(f);
        let way = axis.times(f64::signum(force));
        let part = (scene.parts.iter())
            .find(|part| part.link.is_some_and(|l| carries(scene, f.link, l)))
            .map_or_else(String::new, |part| part.id.to_string());
        NoEquilibrium::Unbalanced(Imbalance::Load {
            torque: f.turn,
            size: force.abs(),
            part,
            way,
            coordinate: c.id.to_string(),
            uncarried: uncarried.is_some(),
            limited,
        })
    }
}

/// Returns whether link `l` is `base` or carried by it.
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
