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
use crate::scene::programs::weights;
use crate::scene::solve::{gram, solve_symmetric};
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
                sweep::apply(&mut wrenches, &self.links, link, point, force, torque);
            }
        }
        sweep::gather(scene, &self.links, &mut wrenches);
        (0..scene.constraints.len())
            .map(|c| self.reaction_to(c, lambda, &wrenches))
            .collect()
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
        let active: Vec<usize> = (0..n).filter(|&r| self.is_active(r)).collect();
        let w: Vec<S> = weights(scene).into_iter().map(S::constant).collect();
        let rows: Vec<Vec<(usize, S)>> = active.iter().map(|&r| self.row(r).gradient).collect();
        let products = gram(&rows, &w);
        let solved = self.solved();
        let base: Vec<Action<S>> = (0..scene.constraints.len())
            .map(|c| self.reaction_to(c, &solved.lambda, &solved.carried))
            .collect();
        let mut shares: Vec<Share<S>> = left_out
            .into_iter()
            .map(|row| {
                let gradient = self.row(row).gradient;
                let right = rows.iter().map(|g| weighted(g, &gradient, &w)).collect();
                let factors = solve_symmetric(products.clone(), right, &[]).x;
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
        let product = |a: &[Action<S>], b: &[Action<S>]| self.product(a, b);
        let a = (0..shares.len())
            .map(|k| {
                (0..=k)
                    .map(|l| product(&shares[k].stress, &shares[l].stress))
                    .collect()
            })
            .collect();
        let b = shares.iter().map(|s| -product(&s.stress, &base)).collect();
        let factors = solve_symmetric(a, b, &[]).x;
        for (share, factor) in shares.iter_mut().zip(factors) {
            share.factor = factor;
        }
        shares
    }

    /// Scalar product of two sets of reactions.
    fn product(&self, a: &[Action<S>], b: &[Action<S>]) -> S {
        let per_length = 1.0 / self.scene.span;
        let mut sum = S::zero();
        for (c, element) in self.scene.constraints.iter().enumerate() {
            let arm = match (element.about, element.markers) {
                // given about where it touches
                _ if self.cam_of(element).is_some() => Vec3::zero(),
                (Some(about), Some((i, j))) if about == i => {
                    let (p_I, p_J) = (self.marker(i).p_GM, self.marker(j).p_GM);
                    (p_I - p_J).times(S::constant(0.5))
                }
                _ => Vec3::zero(),
            };
            let torque =
                |x: &Action<S>| (x.torque + arm.cross(x.force)).times(S::constant(per_length));
            sum += a[c].force.dot(b[c].force) + torque(&a[c]).dot(torque(&b[c]));
        }
        sum
    }
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
