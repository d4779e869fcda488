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

/// Load on a link over the largest on the way to it, below which it is dropped where only sums of
/// squares are wanted.
const NEGLIGIBLE: f64 = 1e-16;

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
        let (of_link, idle) = (free_of_links(scene), scene.idle_links());
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
            if let Some(parent) = scene.links[l].parent.filter(|_| !idle[l]) {
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
    pub fn half_sparse(&self, x: BTreeMap<usize, S>) -> Vec<(usize, S)> {
        let scene = self.scene;
        let mut loads: BTreeMap<usize, Wrench<S>> = BTreeMap::new();
        for &v in x.keys() {
            let mut next = Some(scene.freedoms[self.free[v]].link);
            while let Some(l) = next.filter(|l| !loads.contains_key(l)) {
                loads.insert(l, Wrench::zero());
                next = scene.links[l].parent;
            }
        }
        self.carried_inward(x, loads, |_| true)
    }

    /// Returns the same but for what is far below rounding. Loads fall off from link to link where
    /// links stand at angles to each other, so that the time does not grow with the depth; a pull
    /// along a straight chain is carried all the way.
    pub(super) fn half_near(&self, x: BTreeMap<usize, S>) -> Vec<(usize, S)> {
        let links = x.keys().map(|&v| self.scene.freedoms[self.free[v]].link);
        let loads = links.map(|l| (l, Wrench::zero())).collect();
        let mut largest = 0.0_f64;
        self.carried_inward(x, loads, |load| {
            let size = load.force.norm2() + load.torque.norm2();
            let size = size.known().unwrap_or(f64::INFINITY);
            largest = largest.max(size);
            // in squares; what is not a number is carried on
            size.is_nan() || size > NEGLIGIBLE * NEGLIGIBLE * largest
        })
    }

    /// Carries x inward from the links of `loads`, as long as a load matters.
    fn carried_inward(
        &self,
        mut x: BTreeMap<usize, S>,
        mut loads: BTreeMap<usize, Wrench<S>>,
        mut matters: impl FnMut(&Wrench<S>) -> bool,
    ) -> Vec<(usize, S)> {
        let scene = self.scene;
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
            if let Some(parent) = scene.links[l].parent.filter(|_| matters(&load)) {
                let up = to_parent(&self.states[l].X_PL, load);
                let on_parent = loads.entry(parent).or_insert_with(Wrench::zero);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::scene::build::Options;
    use crate::scene::configuration::Configuration;
    use crate::scene::equations::Equations;
    use crate::scene::solve::gram_diagonal;
    use std::fmt::Write;

    /// A chain of links from one corner of a zigzag to the next, on balls.
    fn chain(n: usize) -> Model {
        let mut text = String::from("chain\nPART/1, GROUND\nMARKER/1, PART=1\n");
        for k in 0..n {
            let (part, mass) = (k + 2, 1.0 + 0.3 * (k as f64).sin());
            let (i, j, cm) = (10 * part, 10 * part + 1, 10 * part + 2);
            let below = if k == 0 { 1 } else { 10 * (part - 1) + 1 };
            let (x, y, up) = match k % 2 {
                0 => (0.8 * k as f64, 0.0, 0.6),
                _ => (0.8 * k as f64, 0.6, -0.6),
            };
            let _ = write!(
                text,
                "PART/{part}, MASS={mass}, CM={cm}, IP=0.1,0.2,0.15, QG={x:.1},{y:.1},0\n\
                 MARKER/{i}, PART={part}\nMARKER/{cm}, PART={part}, QP=0.4,{:.1},0.1\n\
                 MARKER/{j}, PART={part}, QP=0.8,{up:.1},0\n\
                 JOINT/{part}, SPHERICAL, I={i}, J={below}\n",
                0.5 * up
            );
        }
        text.push_str("END\n");
        Model::from_text(&text).expect("a model")
    }

    /// The most numbers that a row of a chain has, where what is negligible is left out.
    fn longest(links: usize) -> usize {
        let model = chain(links);
        let scene = Scene::compile(&model, &Options::default()).expect("a scene");
        let configuration = Configuration::new(&scene);
        let mut numbers = vec![0.0; scene.layout.len()];
        numbers[scene.layout.q()].copy_from_slice(&scene.initial_q);
        let at = Equations::new(scene.within(&configuration), &numbers);
        let factor = ArticulatedFactor::new(&scene, at.links());
        let inverse_d = factor.inverse();
        let n = scene.layout.n_v;
        let mut longest = 0;
        for v in (0..n).step_by(7) {
            let row: BTreeMap<usize, f64> = [(v, 1.0), ((v + 4).min(n - 1), -0.7)].into();
            let (all, near) = (factor.half_sparse(row.clone()), factor.half_near(row));
            assert!(near.len() <= all.len());
            longest = longest.max(near.len());
            let squares = [all, near].map(|u| gram_diagonal(&[u], &inverse_d)[0]);
            let off = (squares[0] - squares[1]).abs();
            assert!(off <= 4.0 * f64::EPSILON * squares[0], "{v}: {squares:?}");
        }
        longest
    }

    #[test]
    fn what_is_left_out_of_squares_is_far_below_rounding_and_rows_do_not_grow_with_a_zigzag() {
        let (short, long) = (longest(200), longest(400));
        // three freedoms a link
        assert!(
            short < 3 * 200 && long as f64 <= 1.1 * short as f64,
            "{short} {long}"
        );
    }
}
