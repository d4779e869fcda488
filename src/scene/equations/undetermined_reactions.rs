//! States of stress without load: what rows that depend on each other may exert while nothing moves
//! and nothing pulls.
//!
//! A row r that depends on others, `g_r = Σ c_k g_k`, permits the multipliers `λ_r = 1, λ_k = −c_k`
//! with no effect on any coordinate. Joints of the forest that lie in the loop carry what these
//! rows exert, so the elements that share a direction show as those that are stressed, whether they
//! are rows or carry parts. Reactions are determined up to such states; what is reported is the set
//! with
//!
//! ```text
//! Σ |F_e|² + |T_e|²/L²  least over all constraint elements e,   T_e about the middle of the two markers, L the distance over which constraints are spread
//! ```
//!
//! which does not depend on the order of elements, on ground, on which marker is called I, nor on
//! what carries what.

use super::Equations;
use crate::physics::action::Action;
use crate::scalar::Scalar;
use crate::scene::RowKind;
use crate::scene::programs::weights;
use crate::scene::solve::{SymmetricFactor, gram, products};
use crate::scene::sweep::{self, Wrench};
use crate::space::Vec3;

/// A state of stress and how much of it belongs to the smallest set of reactions.
pub struct Share<S> {
    /// the dependent row that permits it
    pub row: usize,
    /// how much of it
    pub factor: S,
    /// what each constraint element exerts on its I marker   (n_constraints)
    pub stress: Vec<Action<S>>,
}

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
            let row = self.row(r);
            let links = row.actions.iter().map(|(m, _)| scene.markers[*m].link);
            let common = match scene.rows[r].kind {
                // its expression may read where something stands in ground
                RowKind::Formula { .. } => None,
                RowKind::Markers { .. } | RowKind::Displacements(_) | RowKind::Cam { .. } => links
                    .clone()
                    .reduce(|a, b| scene.common_link([a, b]))
                    .flatten(),
            };
            for mut next in links {
                while let Some(l) = next.filter(|_| next != common) {
                    loaded[l] = true;
                    next = scene.links[l].parent;
                }
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

    /// States of stress of all rows that do not take part, with their shares in the smallest set of
    /// reactions.
    pub(super) fn shares(&self) -> &[Share<S>] {
        self.scratch.shares.get_or_init(|| self.smallest())
    }

    fn smallest(&self) -> Vec<Share<S>> {
        let scene = self.scene;
        let n = scene.rows.len();
        let left_out: Vec<usize> = (0..n).filter(|&r| !self.is_active(r)).collect();
        if left_out.is_empty() {
            return Vec::new();
        }
        let active = self.rows_in_order();
        let w: Vec<S> = weights(scene).into_iter().map(S::constant).collect();
        let gradient = |&r: &usize| self.row(r).gradient.clone();
        let rows: Vec<Vec<(usize, S)>> = active.iter().map(gradient).collect();
        let factor = SymmetricFactor::new(gram(&rows, &w), &[]);
        let solved = self.solved();
        let base: Vec<Action<S>> = (0..scene.constraints.len())
            .map(|c| self.reaction_to(c, &solved.lambda, self.carried()))
            .collect();
        let mut shares: Vec<Share<S>> = left_out
            .into_iter()
            .map(|row| {
                let gradient = &self.row(row).gradient;
                let right = rows.iter().map(|g| weighted(g, gradient, &w)).collect();
                let factors = factor.solve(right);
                let mut lambda = vec![S::zero(); n];
                lambda[row] = S::one();
                for (&r, f) in active.iter().zip(factors) {
                    lambda[r] = -f;
                }
                Share {
                    row,
                    factor: S::zero(),
                    stress: self.stress(&lambda),
                }
            })
            .collect();
        // least squares over the shares: A z = −b
        let base = self.weighted_actions(&base);
        let all: Vec<_> = (shares.iter())
            .map(|share| self.weighted_actions(&share.stress))
            .collect();
        let places = |k: usize| all[k].iter().map(|a| a.0);
        let a = products(all.len(), places, |k, l| product(&all[k], &all[l]));
        let b = all.iter().map(|stress| -product(stress, &base)).collect();
        let factors = SymmetricFactor::new(a, &[]).solve(b);
        for (share, factor) in shares.iter_mut().zip(factors) {
            share.factor = factor;
        }
        shares
    }

    /// Returns the reactions that are not known to be zero, by constraint elements: the force, and
    /// the torque as it is weighed against forces.
    fn weighted_actions(&self, actions: &[Action<S>]) -> Vec<(usize, [Vec3<S>; 2])> {
        let per_length = S::constant(1.0 / self.scene.span);
        let mut out = Vec::new();
        for (c, (element, x)) in self.scene.constraints.iter().zip(actions).enumerate() {
            let arm = match (element.about, element.markers) {
                // given about where it touches
                _ if self.cam_of(element).is_some() => Vec3::zero(),
                (Some(about), Some((i, j))) if about == i => {
                    let (p_I, p_J) = (self.marker(i).p_GM, self.marker(j).p_GM);
                    (p_I - p_J).times(S::constant(0.5))
                }
                _ => Vec3::zero(),
            };
            let pair = [x.force, (x.torque + arm.cross(x.force)).times(per_length)];
            if !pair.iter().flat_map(|x| &x.0).all(Scalar::is_known_zero) {
                out.push((c, pair));
            }
        }
        out
    }
}

/// Scalar product of two sets of weighted reactions, by ascending elements.
fn product<S: Scalar>(a: &[(usize, [Vec3<S>; 2])], b: &[(usize, [Vec3<S>; 2])]) -> S {
    let mut sum = S::zero();
    let mut others = b.iter().peekable();
    for (c, x) in a {
        while others.next_if(|other| other.0 < *c).is_some() {}
        if let Some((_, y)) = others.next_if(|other| other.0 == *c) {
            sum += x[0].dot(y[0]) + x[1].dot(y[1]);
        }
    }
    sum
}

/// `Σ aᵢ wᵢ bᵢ` of two sparse rows.
fn weighted<S: Scalar>(a: &[(usize, S)], b: &[(usize, S)], w: &[S]) -> S {
    let mut sum = S::zero();
    for &(i, x) in a {
        if let Some(&(_, y)) = b.iter().find(|e| e.0 == i) {
            sum += x * y * w[i];
        }
    }
    sum
}
