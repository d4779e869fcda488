//! States of stress without load: what rows that depend on each other may exert while nothing moves
//! and nothing pulls.
//!
//! A row r that depends on others, `g_r = Σ c_k g_k`, permits the multipliers `λ_r = 1, λ_k = −c_k`
//! with no effect on any coordinate. Joints of the forest that lie in the loop carry what these
//! rows exert, so the elements that share a direction show as those that are stressed, whether they
//! are rows or carry parts. Reactions are determined up to such states; which of them is reported
//! says [`least_reactions`](super::least_reactions).

use super::Equations;
use crate::physics::action::Action;
use crate::scalar::Scalar;
use crate::scene::RowKind;
use crate::scene::sweep::{self, Wrench};

impl<S: Scalar> Equations<'_, S> {
    /// Returns what each constraint element exerts on its I marker when rows have these multipliers
    /// and nothing else acts   (n_constraints)
    pub fn stress(&self, lambda: &[S]) -> Vec<Action<S>> {
        let scene = self.scene;
        let mut wrenches = vec![Wrench::zero(); scene.links.len()];
        for (r, &l) in lambda.iter().enumerate() {
            if l.is_known_zero() {
                continue;
            }
            for (m, action) in &self.row(r).actions {
                let (point, link) = (self.marker(*m).p_GM, scene.markers[*m].link);
                // carriers bear the opposite
                let opposite = action.times(-l);
                let (force, torque) = (opposite.force, opposite.torque);
                sweep::apply(&mut wrenches, self.links(), link, point, force, torque);
            }
        }
        self.gather_stress(lambda, &mut wrenches);
        (0..scene.constraints.len())
            .map(|c| self.reaction_to(c, lambda, &wrenches))
            .collect()
    }

    /// Adds to the wrench of each link those of all that it carries, as far as rows with these
    /// multipliers reach: what carries all links of a row feels nothing of it.
    fn gather_stress(&self, lambda: &[S], wrenches: &mut [Wrench<S>]) {
        let scene = self.scene;
        let mut loaded = vec![false; scene.links.len()];
        for (r, l) in lambda.iter().enumerate() {
            if l.is_known_zero() {
                continue;
            }
            for l in self.links_around(r, &self.row(r).actions) {
                loaded[l] = true;
            }
        }
        for l in (0..scene.links.len()).rev() {
            if !loaded[l] {
                wrenches[l] = Wrench::zero();
            } else if let Some(p) = scene.links[l].parent {
                let up = sweep::to_parent(&self.links()[l].X_PL, wrenches[l]);
                wrenches[p].force += up.force;
                wrenches[p].torque += up.torque;
            }
        }
    }

    /// Returns the links of the loop that a row with these actions closes: those on which it acts
    /// and what carries them, up to what carries all of them.
    pub(super) fn links_around(&self, r: usize, actions: &[(usize, Action<S>)]) -> Vec<usize> {
        let scene = self.scene;
        let links = actions.iter().map(|(m, _)| scene.markers[*m].link);
        let common = match scene.rows[r].kind {
            // its expression may read where something stands in ground
            RowKind::Formula { .. } => None,
            RowKind::Markers { .. } | RowKind::Displacements(_) | RowKind::Cam { .. } => links
                .clone()
                .reduce(|a, b| scene.common_link([a, b]))
                .flatten(),
        };
        let mut around = Vec::new();
        for mut next in links {
            while let Some(l) = next.filter(|_| next != common) {
                around.push(l);
                next = scene.links[l].parent;
            }
        }
        around
    }
}
