//! The mass matrix of a forest without forming it: articulated inertia, linear in the number of
//! links.
//!
//! `M = Lᵀ D L` where L and D come from eliminating one freedom after the other from the inertia
//! that a link shows to its carrier. The 6×6 inertia of a link, about its origin in its axes,
//! stands in three blocks:
//!
//! ```text
//! f = A a + Bᵀ α        n = B a + C α
//! ```
//!
//! Source: Featherstone, chapter 7, with several freedoms of a link eliminated one by one.

use super::Scene;
use super::sweep::{LinkState, Wrench, to_parent};
use crate::scalar::Scalar;
use crate::space::{Mat3, Vec3};
use std::collections::BTreeMap;

/// The factors.
pub struct ArticulatedFactor<'s, S> {
    scene: &'s Scene,
    states: &'s [LinkState<S>],
    /// per freedom: inertia times its direction, after what it carries has been eliminated
    u: Vec<Wrench<S>>,
    /// 1/D per freedom   (1 for driven ones, unused)
    pub inverse_d: Vec<S>,
    /// freedoms of each link, in order
    of_link: Vec<Vec<usize>>,
    /// place in v → freedom
    free: Vec<usize>,
}

#[derive(Clone, Copy)]
struct Inertia<S> {
    a: Mat3<S>,
    b: Mat3<S>,
    c: Mat3<S>,
}

/// `x yᵀ s`
fn outer<S: Scalar>(x: Vec3<S>, y: Vec3<S>, s: S) -> Mat3<S> {
    let scaled = y.times(s);
    Mat3(x.0.map(|x| scaled.0.map(|y| x * y)))
}

impl<'s, S: Scalar> ArticulatedFactor<'s, S> {
    /// Eliminates all free coordinates from the leaves.
    pub fn new(scene: &'s Scene, states: &'s [LinkState<S>]) -> Self {
        let mut inertia: Vec<Inertia<S>> = scene
            .links
            .iter()
            .map(|l| {
                let m = S::constant(l.mass);
                Inertia {
                    a: Mat3::diagonal(m, m, m),
                    b: Mat3::cross_matrix(Vec3::constant(l.moment)),
                    c: Mat3::constant(l.inertia),
                }
            })
            .collect();
        let mut of_link = vec![Vec::new(); scene.links.len()];
        let mut free = Vec::new();
        for (k, f) in scene.freedoms.iter().enumerate() {
            if f.v.is_some() {
                of_link[f.link].push(k);
                free.push(k);
            }
        }
        let mut u = vec![Wrench::zero(); scene.freedoms.len()];
        let mut inverse_d = vec![S::one(); scene.freedoms.len()];
        for l in (0..scene.links.len()).rev() {
            for &k in of_link[l].iter().rev() {
                let f = &scene.freedoms[k];
                let i = &mut inertia[l];
                let sign = S::constant(f.sign);
                // a column of the blocks: the inertia times the freedom's direction
                let w = if f.turn {
                    Wrench {
                        force: i.b.row(f.axis).times(sign),
                        torque: i.c.column(f.axis).times(sign),
                    }
                } else {
                    Wrench {
                        force: i.a.column(f.axis).times(sign),
                        torque: i.b.column(f.axis).times(sign),
                    }
                };
                let r = S::one() / f.component(&w);
                i.a = i.a - outer(w.force, w.force, r);
                i.b = i.b - outer(w.torque, w.force, r);
                i.c = i.c - outer(w.torque, w.torque, r);
                u[k] = w;
                inverse_d[k] = r;
            }
            let Some(parent) = scene.links[l].parent else {
                continue;
            };
            let X = &states[l].X_PL;
            let R = X.rotation;
            let turned = |m: &Mat3<S>| R * *m * R.transpose();
            let (a, b, c) = (
                turned(&inertia[l].a),
                turned(&inertia[l].b),
                turned(&inertia[l].c),
            );
            let P = Mat3::cross_matrix(X.position);
            let up = &mut inertia[parent];
            up.a = up.a + a;
            up.b = up.b + b + P * a;
            up.c = up.c + c - b * P + P * b.transpose() - P * a * P;
        }
        Self {
            scene,
            states,
            u,
            inverse_d,
            of_link,
            free,
        }
    }

    /// 1/D of the free coordinates   (n_v)
    pub fn inverse(&self) -> Vec<S> {
        self.free.iter().map(|&k| self.inverse_d[k]).collect()
    }

    /// `x ← L⁻ᵀ x`   (n_v)
    pub fn half(&self, x: &mut [S]) {
        let scene = self.scene;
        let mut load = vec![Wrench::zero(); scene.links.len()];
        for l in (0..scene.links.len()).rev() {
            for &k in self.of_link[l].iter().rev() {
                let f = &scene.freedoms[k];
                let Some(v) = f.v else { continue };
                x[v] -= f.component(&load[l]);
                if x[v].is_known_zero() {
                    continue;
                }
                let s = x[v] * self.inverse_d[k];
                load[l].force += self.u[k].force.times(s);
                load[l].torque += self.u[k].torque.times(s);
            }
            if let Some(p) = scene.links[l].parent {
                let up = to_parent(&self.states[l].X_PL, load[l]);
                load[p].force += up.force;
                load[p].torque += up.torque;
            }
        }
    }

    /// Returns `L⁻ᵀ x` where it is not known to be zero, by ascending places: only links from those
    /// that x moves inward are visited.
    pub fn half_sparse(&self, mut x: BTreeMap<usize, S>) -> Vec<(usize, S)> {
        let scene = self.scene;
        let mut loads: BTreeMap<usize, Wrench<S>> = BTreeMap::new();
        for &v in x.keys() {
            let mut next = Some(scene.freedoms[self.free[v]].link);
            while let Some(l) = next.filter(|l| !loads.contains_key(l)) {
                loads.insert(l, Wrench::zero());
                next = scene.links[l].parent;
            }
        }
        while let Some((l, mut load)) = loads.pop_last() {
            for &k in self.of_link[l].iter().rev() {
                let f = &scene.freedoms[k];
                let Some(v) = f.v else { continue };
                let x_v = x.entry(v).or_insert_with(S::zero);
                *x_v -= f.component(&load);
                if x_v.is_known_zero() {
                    continue;
                }
                let s = *x_v * self.inverse_d[k];
                load.force += self.u[k].force.times(s);
                load.torque += self.u[k].torque.times(s);
            }
            if let Some(on_parent) = scene.links[l].parent.and_then(|p| loads.get_mut(&p)) {
                let up = to_parent(&self.states[l].X_PL, load);
                on_parent.force += up.force;
                on_parent.torque += up.torque;
            }
        }
        x.into_iter().filter(|e| !e.1.is_known_zero()).collect()
    }

    /// `x ← L⁻¹ D⁻¹ x`   (n_v)
    pub fn finish(&self, x: &mut [S]) {
        let scene = self.scene;
        let mut motion: Vec<(Vec3<S>, Vec3<S>)> = Vec::with_capacity(scene.links.len());
        for l in 0..scene.links.len() {
            let (mut alpha, mut a) = match scene.links[l].parent {
                Some(p) => {
                    let (alpha, a) = motion[p];
                    let X = &self.states[l].X_PL;
                    let carried = a + alpha.cross(X.position);
                    (
                        X.rotation.apply_transposed(alpha),
                        X.rotation.apply_transposed(carried),
                    )
                }
                None => (Vec3::zero(), Vec3::zero()),
            };
            for &k in &self.of_link[l] {
                let f = &scene.freedoms[k];
                let Some(v) = f.v else { continue };
                let pull = self.u[k].force.dot(a) + self.u[k].torque.dot(alpha);
                x[v] = (x[v] - pull) * self.inverse_d[k];
                let along = x[v].scale(f.sign);
                if f.turn {
                    alpha.0[f.axis] += along;
                } else {
                    a.0[f.axis] += along;
                }
            }
            motion.push((alpha, a));
        }
    }
}
