//! What is said where no equilibrium is found.

use super::point::Point;
use super::{NoEquilibrium, Settler};
use crate::scene::Scene;
use crate::scene::equations::Equations;

impl Settler<'_> {
    /// Names what is not balanced: the coordinate that would be accelerated most.
    pub(super) fn unbalanced(&self, p: &Point) -> NoEquilibrium {
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
