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

use super::sweep::{Freedom, LinkState, Wrench, to_parent};
use super::{Link, Scene};
use crate::scalar::Scalar;
use crate::space::{Frame, Mat3, Vec3};
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

/// Inertia of a link about its origin, in its axes, in the blocks of the head of this file.
#[derive(Clone, Copy)]
pub(super) struct Inertia<S> {
    a: Mat3<S>,
    b: Mat3<S>,
    c: Mat3<S>,
}

/// `x yᵀ s`
fn outer<S: Scalar>(x: Vec3<S>, y: Vec3<S>, s: S) -> Mat3<S> {
    let scaled = y.times(s);
    Mat3(x.0.map(|x| scaled.0.map(|y| x * y)))
}

impl<S: Scalar> Inertia<S> {
    /// Returns the inertia of each link alone.
    pub fn of_links(scene: &Scene) -> Vec<Self> {
        let of_link = |l: &Link| {
            let m = S::constant(l.mass);
            Inertia {
                a: Mat3::diagonal(m, m, m),
                b: Mat3::cross_matrix(Vec3::constant(l.moment)),
                c: Mat3::constant(l.inertia),
            }
        };
        scene.links.iter().map(of_link).collect()
    }

    /// Returns the inertia of nothing.
    pub fn none() -> Self {
        Inertia {
            a: Mat3::zero(),
            b: Mat3::zero(),
            c: Mat3::zero(),
        }
    }

    /// Returns the inertia times the direction of a freedom: a column of the blocks.
    pub fn along(&self, f: &Freedom) -> Wrench<S> {
        let sign = S::constant(f.sign);
        if f.turn {
            Wrench {
                force: self.b.row(f.axis).times(sign),
                torque: self.c.column(f.axis).times(sign),
            }
        } else {
            Wrench {
                force: self.a.column(f.axis).times(sign),
                torque: self.b.column(f.axis).times(sign),
            }
        }
    }

    /// Takes away `w wᵀ r`.
    pub fn reduce(&mut self, w: &Wrench<S>, r: S) {
        self.a = self.a - outer(w.force, w.force, r);
        self.b = self.b - outer(w.torque, w.force, r);
        self.c = self.c - outer(w.torque, w.torque, r);
    }

    /// Adds the inertia that a link at `X` shows.
    pub fn add_carried(&mut self, X: &Frame<S>, link: &Self) {
        let R = X.rotation;
        let turned = |m: &Mat3<S>| R * *m * R.transpose();
        let (a, b, c) = (turned(&link.a), turned(&link.b), turned(&link.c));
        let P = Mat3::cross_matrix(X.position);
        self.a = self.a + a;
        self.b = self.b + b + P * a;
        self.c = self.c + c - b * P + P * b.transpose() - P * a * P;
    }
}

/// Acceleration of a link from free coordinates alone: of its origin and of its rotation, in its
/// axes.
#[derive(Clone, Copy)]
pub(super) struct Motion<S> {
    alpha: Vec3<S>,
    a: Vec3<S>,
}

impl<S: Scalar> Motion<S> {
    /// Returns no motion.
    pub fn zero() -> Self {
        Self {
            alpha: Vec3::zero(),
            a: Vec3::zero(),
        }
    }

    /// Returns the motion of what this link carries at `X`, before its own freedoms.
    pub fn carried(&self, X: &Frame<S>) -> Self {
        let a = self.a + self.alpha.cross(X.position);
        Self {
            alpha: X.rotation.apply_transposed(self.alpha),
            a: X.rotation.apply_transposed(a),
        }
    }

    /// Returns the product with a wrench.
    pub fn power(&self, w: &Wrench<S>) -> S {
        w.force.dot(self.a) + w.torque.dot(self.alpha)
    }

    /// Adds the acceleration `x` of a freedom.
    pub fn add_along(&mut self, f: &Freedom, x: S) {
        let along = x.scale(f.sign);
        if f.turn {
            self.alpha.0[f.axis] += along;
        } else {
            self.a.0[f.axis] += along;
        }
    }
}

/// Returns the free coordinates of each link, in order.
pub(super) fn free_of_links(scene: &Scene) -> Vec<Vec<usize>> {
    let mut of_link = vec![Vec::new(); scene.links.len()];
    for (k, f) in scene.freedoms.iter().enumerate() {
        if f.v.is_some() {
            of_link[f.link].push(k);
        }
    }
    of_link
}

impl<'s, S: Scalar> ArticulatedFactor<'s, S> {
    /// Eliminates all free coordinates from the leaves.
    pub fn new(scene: &'s Scene, states: &'s [LinkState<S>]) -> Self {
        let mut inertia = Inertia::of_links(scene);
        let of_link = free_of_links(scene);
        let is_free = |k: &usize| scene.freedoms[*k].v.is_some();
        let free = (0..scene.freedoms.len()).filter(is_free).collect();
        let mut u = vec![Wrench::zero(); scene.freedoms.len()];
        let mut inverse_d = vec![S::one(); scene.freedoms.len()];
        for l in (0..scene.links.len()).rev() {
            for &k in of_link[l].iter().rev() {
                let f = &scene.freedoms[k];
                let w = inertia[l].along(f);
                let r = S::one() / f.component(&w);
                inertia[l].reduce(&w, r);
                u[k] = w;
                inverse_d[k] = r;
            }
            if let Some(parent) = scene.links[l].parent {
                let shown = inertia[l];
                inertia[parent].add_carried(&states[l].X_PL, &shown);
            }
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
        let mut motion: Vec<Motion<S>> = Vec::with_capacity(scene.links.len());
        for l in 0..scene.links.len() {
            let mut here = match scene.links[l].parent {
                Some(p) => motion[p].carried(&self.states[l].X_PL),
                None => Motion::zero(),
            };
            for &k in &self.of_link[l] {
                let f = &scene.freedoms[k];
                let Some(v) = f.v else { continue };
                x[v] = (x[v] - here.power(&self.u[k])) * self.inverse_d[k];
                here.add_along(f, x[v]);
            }
            motion.push(here);
        }
    }
}
