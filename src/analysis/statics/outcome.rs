//! What is said where no equilibrium is found.

use super::point::Point;
use super::step::Pace;
use super::{NoEquilibrium, Settler};
use crate::scene::Scene;
use crate::scene::equations::Equations;
use nalgebra::DVector;

/// How often a step is made shorter until its matrix is regular.
const MAX_SHORTER: usize = 8;

impl Settler<'_> {
    /// The loads that keep accelerating the model when whatever gives way has given way as far as it can; `None` where that is not known.
    ///
    /// ```text
    /// D Δ/h = f + K Δ + Gᵀλ,  h → ∞
    /// ```
    fn carried_by_nothing(&mut self, p: &Point) -> Option<DVector<f64>> {
        let jacobian = self.jacobian(p);
        let n = self.n_v();
        // as long as the matrix bears it, with a few digits left
        let mut length = 100.0 * self.longest(p, &jacobian);
        let step = (0..MAX_SHORTER).find_map(|_| {
            length *= 0.01;
            let pace = Pace::new(length, &jacobian, n);
            self.newton(p, &jacobian, &pace, &p.force)?;
            let pace = Pace::new(0.01 * length, &jacobian, n);
            self.newton(p, &jacobian, &pace, &p.force)
        })?;
        let load = p.metric.times(&step.as_slice()[..n]) / (0.01 * length);
        (p.metric.size(&load) > 1e-3 * p.left[0]).then_some(load)
    }

    /// Names what is not balanced: the largest of the loads that nothing carries, else what would be accelerated most.
    pub(super) fn unbalanced(&mut self, p: &Point) -> NoEquilibrium {
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
        let nothing = if uncarried.is_some() {
            "; nothing carries it"
        } else {
            ""
        };
        let sentence = format!(
            "no equilibrium: a {what} of {:.6e} on {part} remains along ({x:.6}, {y:.6}, {z:.6}), {}{nothing}",
            force.abs(),
            c.name
        );
        NoEquilibrium::Unbalanced(sentence, c.name.clone())
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
