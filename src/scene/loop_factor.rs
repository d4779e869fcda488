//! Rows eliminated where their loops close: accelerations and multipliers of chains of loops in a
//! time that grows with their number.
//!
//! Freedoms are eliminated link by link, from the leaves, as for articulated inertia. A row stays
//! open while some of its freedoms are left; where the last branch that it touches has been merged,
//! its multiplier is eliminated too. So the fill is bounded by the number of loops that pass
//! through one link, while `G M⁻¹ Gᵀ` couples all loops on one tree.
//!
//! ```text
//! shown     V = ½ aᵀ I a + μᵀ (J a + e) − ½ μᵀ Σ μ + pᵀ a                        (1)
//! freedom   D = hᵀ I h,  u = I h,  g = J h + G,  w = hᵀ p − f                    (2)
//!           v̇ = −(w + uᵀ a + gᵀ μ)/D
//!           I −= u uᵀ/D   J −= g uᵀ/D   Σ += g gᵀ/D   p −= u w/D   e −= g w/D
//! row r     d = Σᵣᵣ,  μᵣ = (Jᵣ a + eᵣ − Σᵣₛ μₛ)/d                                (3)
//!           I += Jᵣᵀ Jᵣ/d   Jₛ −= Σₛᵣ Jᵣ/d   Σₛₜ −= Σₛᵣ Σᵣₜ/d
//!           p += Jᵣᵀ eᵣ/d   eₛ −= Σₛᵣ eᵣ/d
//! ```
//!
//! V is what a link with acceleration a shows its carrier, μ = −λ the multipliers of open rows. It
//! is made stationary: least in accelerations (Gauss), greatest in multipliers.
//!
//! Source: derived here; Featherstone, chapter 7, is the case without rows.

use super::Scene;
use super::articulated::{Inertia, Motion, free_of_links};
use super::solve::RANK_TOLERANCE;
use super::sweep::{LinkState, Wrench, to_parent};
use crate::scalar::Scalar;
use std::collections::BTreeMap;

/// Factors of `M v̇ = f + Gᵀ λ`, `G v̇ = γ`.
pub struct LoopFactor<'s, S: Scalar> {
    scene: &'s Scene,
    states: &'s [LinkState<S>],
    /// free coordinates of each link, in order
    of_link: Vec<Vec<usize>>,
    /// rows that close at each link, in the order of their elimination; last: at ground
    closing: Vec<Vec<usize>>,
    /// per freedom: (2)
    freedoms: Vec<FreedomStep<S>>,
    /// per row: (3)
    rows: Vec<RowStep<S>>,
    /// as that of [`Solution`](super::solve::Solution)
    pub strength: S,
}

/// The elimination of a freedom.
struct FreedomStep<S> {
    /// u
    u: Wrench<S>,
    /// 1/D
    inverse: S,
    /// g of the open rows that feel it
    felt: Vec<(usize, S)>,
}

/// The elimination of a row.
struct RowStep<S: Scalar> {
    /// Jᵣ
    along: Wrench<S>,
    /// Σᵣₛ of the rows that are open beside it
    others: Vec<(usize, S)>,
    /// 1/d; 0 where the row depends on others
    inverse: S,
    /// the row depends on others
    dependent: S::Mask,
}

/// Inertia and rows that a link shows, as far as freedoms and rows have been eliminated.
struct Shown<S> {
    /// I
    inertia: Inertia<S>,
    /// J, by open rows
    along: BTreeMap<usize, Wrench<S>>,
    /// Σ: (later row, earlier row)
    coupling: BTreeMap<(usize, usize), S>,
}

impl<S: Scalar> Shown<S> {
    fn add(&mut self, r: usize, s: usize, x: S) {
        if !x.is_known_zero() {
            *self
                .coupling
                .entry((r.max(s), r.min(s)))
                .or_insert_with(S::zero) += x;
        }
    }

    fn reduce_row(&mut self, r: usize, w: &Wrench<S>, s: S) {
        let along = self.along.entry(r).or_insert_with(Wrench::zero);
        along.force -= w.force.times(s);
        along.torque -= w.torque.times(s);
    }

    /// Takes the link `carried`, which stands at `state`, up into its carrier.
    fn merge(&mut self, state: &LinkState<S>, carried: Shown<S>) {
        self.inertia.add_carried(&state.X_PL, &carried.inertia);
        for (r, along) in carried.along {
            let up = to_parent(&state.X_PL, along);
            let sum = self.along.entry(r).or_insert_with(Wrench::zero);
            sum.force += up.force;
            sum.torque += up.torque;
        }
        for ((r, s), x) in carried.coupling {
            self.add(r, s, x);
        }
    }
}

impl<'s, S: Scalar> LoopFactor<'s, S> {
    /// Eliminates the free coordinates and the rows `g` (sparse, by places in v). `usual`: the
    /// usual pivots of the rows; empty: each is compared with what it began from.
    pub fn new(
        scene: &'s Scene,
        states: &'s [LinkState<S>],
        g: &[Vec<(usize, S)>],
        usual: &[f64],
    ) -> Self {
        let places: Vec<Vec<usize>> = (g.iter())
            .map(|row| row.iter().map(|e| e.0).collect())
            .collect();
        let step = |_| FreedomStep {
            u: Wrench::zero(),
            inverse: S::one(),
            felt: Vec::new(),
        };
        let mut factor = Self {
            scene,
            states,
            of_link: free_of_links(scene),
            closing: closing(scene, &places),
            freedoms: scene.freedoms.iter().map(step).collect(),
            rows: Vec::with_capacity(g.len()),
            strength: S::one(),
        };
        let mut rows_at: Vec<Vec<(usize, S)>> = vec![Vec::new(); scene.layout.n_v];
        for (r, row) in g.iter().enumerate() {
            row.iter().for_each(|&(v, x)| rows_at[v].push((r, x)));
        }
        factor.eliminate(g.len(), &rows_at, usual);
        factor
    }

    fn eliminate(&mut self, n_rows: usize, rows_at: &[Vec<(usize, S)>], usual: &[f64]) {
        let scene = self.scene;
        let alone = |inertia| Shown {
            inertia,
            along: BTreeMap::new(),
            coupling: BTreeMap::new(),
        };
        let mut shown: Vec<Shown<S>> = Inertia::of_links(scene).into_iter().map(alone).collect();
        let mut ground = alone(Inertia::none());
        // sums of all that has been added to the diagonal of Σ
        let mut start = vec![S::zero(); n_rows];
        let mut rows: Vec<Option<RowStep<S>>> = (0..n_rows).map(|_| None).collect();
        while let Some(mut here) = shown.pop() {
            let l = shown.len();
            for &r in &self.closing[l] {
                let step = close(&mut here, r, start[r]);
                self.strength = weaker(self.strength, &step, usual.get(r).copied(), start[r]);
                rows[r] = Some(step.1);
            }
            for &k in self.of_link[l].iter().rev() {
                let Some(v) = scene.freedoms[k].v else {
                    continue;
                };
                self.freedoms[k] = free(&mut here, scene, k, &rows_at[v], &mut start);
            }
            match scene.links[l].parent {
                Some(parent) => shown[parent].merge(&self.states[l], here),
                None => here
                    .coupling
                    .into_iter()
                    .for_each(|((r, s), x)| ground.add(r, s, x)),
            }
        }
        for &r in &self.closing[scene.links.len()] {
            let step = close(&mut ground, r, start[r]);
            self.strength = weaker(self.strength, &step, usual.get(r).copied(), start[r]);
            rows[r] = Some(step.1);
        }
        // each row closes somewhere
        self.rows = rows.into_iter().flatten().collect();
    }

    /// Solves for accelerations (into `f`, which holds the loads) and returns the multipliers λ.
    pub fn solve(&self, f: &mut [S], gamma: &[S]) -> Vec<S> {
        let scene = self.scene;
        let mut e: Vec<S> = gamma.iter().map(|&gamma| -gamma).collect();
        let mut load = vec![Wrench::zero(); scene.links.len()];
        // forward: p, e and w of (2) and (3)
        for l in (0..scene.links.len()).rev() {
            for &r in &self.closing[l] {
                let s = self.close_load(r, &mut e);
                load[l].force += self.rows[r].along.force.times(s);
                load[l].torque += self.rows[r].along.torque.times(s);
            }
            for &k in self.of_link[l].iter().rev() {
                let (freedom, step) = (&scene.freedoms[k], &self.freedoms[k]);
                let Some(v) = freedom.v else { continue };
                f[v] = freedom.component(&load[l]) - f[v];
                let s = f[v] * step.inverse;
                load[l].force -= step.u.force.times(s);
                load[l].torque -= step.u.torque.times(s);
                step.felt.iter().for_each(|&(r, g)| e[r] -= g * s);
            }
            if let Some(p) = scene.links[l].parent {
                let up = to_parent(&self.states[l].X_PL, load[l]);
                load[p].force += up.force;
                load[p].torque += up.torque;
            }
        }
        for &r in &self.closing[scene.links.len()] {
            self.close_load(r, &mut e);
        }
        self.outward(f, &e)
    }

    /// Eliminates a row from the right sides; returns `eᵣ/d`.
    fn close_load(&self, r: usize, e: &mut [S]) -> S {
        let s = e[r] * self.rows[r].inverse;
        for &(other, x) in &self.rows[r].others {
            e[other] -= x * s;
        }
        s
    }

    /// Finds accelerations (into `f`, which holds w) and multipliers, from ground outward.
    fn outward(&self, f: &mut [S], e: &[S]) -> Vec<S> {
        let scene = self.scene;
        let mut mu = vec![S::zero(); e.len()];
        let multiplier = |r: usize, motion: &Motion<S>, mu: &[S]| {
            let row = &self.rows[r];
            let known = e[r] + motion.power(&row.along);
            let rest = row.others.iter().fold(known, |s, &(o, x)| s - x * mu[o]);
            S::choose(row.dependent, S::zero, || rest * row.inverse)
        };
        for &r in self.closing[scene.links.len()].iter().rev() {
            mu[r] = multiplier(r, &Motion::zero(), &mu);
        }
        let mut motion: Vec<Motion<S>> = Vec::with_capacity(scene.links.len());
        for l in 0..scene.links.len() {
            let mut here = match scene.links[l].parent {
                Some(p) => motion[p].carried(&self.states[l].X_PL),
                None => Motion::zero(),
            };
            for &k in &self.of_link[l] {
                let (freedom, step) = (&scene.freedoms[k], &self.freedoms[k]);
                let Some(v) = freedom.v else { continue };
                let pull = f[v] + here.power(&step.u);
                let pull = step.felt.iter().fold(pull, |s, &(r, g)| s + g * mu[r]);
                f[v] = -(pull * step.inverse);
                here.add_along(freedom, f[v]);
            }
            for &r in self.closing[l].iter().rev() {
                mu[r] = multiplier(r, &here, &mu);
            }
            motion.push(here);
        }
        mu.into_iter().map(|mu| -mu).collect()
    }
}

/// Returns the rows that close at each link, and last at ground, each list ascending. `places`: the
/// places in v of each row.
pub fn closing(scene: &Scene, places: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let n = scene.links.len();
    let mut carrier_of = vec![None; scene.layout.n_v];
    for f in &scene.freedoms {
        if let Some(v) = f.v {
            carrier_of[v] = scene.links[f.link].parent;
        }
    }
    let mut closing = vec![Vec::new(); n + 1];
    for (r, places) in places.iter().enumerate() {
        let carriers = places.iter().map(|&v| carrier_of[v]);
        let both = carriers.reduce(|a, b| scene.common_link([a, b]));
        closing[both.flatten().unwrap_or(n)].push(r);
    }
    closing
}

/// Eliminates freedom k of the link that is shown; `rows`: G of the rows there. Adds to `start` all
/// that goes onto the diagonal of Σ.
fn free<S: Scalar>(
    here: &mut Shown<S>,
    scene: &Scene,
    k: usize,
    rows: &[(usize, S)],
    start: &mut [S],
) -> FreedomStep<S> {
    let f = &scene.freedoms[k];
    let u = here.inertia.along(f);
    let inverse = S::one() / f.component(&u);
    let open = here.along.iter();
    let mut felt: BTreeMap<usize, S> = open.map(|(&r, j)| (r, f.component(j))).collect();
    for &(r, g) in rows {
        *felt.entry(r).or_insert_with(S::zero) += g;
    }
    let felt: Vec<(usize, S)> = felt.into_iter().filter(|e| !e.1.is_known_zero()).collect();
    here.inertia.reduce(&u, inverse);
    for (at, &(r, g)) in felt.iter().enumerate() {
        let scaled = g * inverse;
        here.reduce_row(r, &u, scaled);
        for &(s, other) in &felt[..at] {
            here.add(r, s, scaled * other);
        }
        let square = scaled * g;
        start[r] += square;
        here.add(r, r, square);
    }
    FreedomStep { u, inverse, felt }
}

/// Eliminates row r of the link that is shown; `start`: all that has been added to its pivot.
/// Returns the pivot as well.
fn close<S: Scalar>(here: &mut Shown<S>, r: usize, start: S) -> (S, RowStep<S>) {
    let along = here.along.remove(&r).unwrap_or_else(Wrench::zero);
    let d = here.coupling.remove(&(r, r)).unwrap_or_else(S::zero);
    let dependent = d.le(start.scale(RANK_TOLERANCE));
    let inverse = S::choose(dependent, S::zero, || S::one() / d);
    let beside = |&(a, b): &(usize, usize)| a == r || b == r;
    let others: Vec<(usize, S)> = (here.coupling.iter())
        .filter(|e| beside(e.0))
        .map(|(&(a, b), &x)| (a + b - r, x))
        .collect();
    here.coupling.retain(|pair, _| !beside(pair));
    here.inertia.reduce(&along, -inverse);
    for (at, &(s, x)) in others.iter().enumerate() {
        let scaled = x * inverse;
        here.reduce_row(s, &along, scaled);
        for &(t, other) in &others[..=at] {
            here.add(s, t, -(scaled * other));
        }
    }
    let step = RowStep {
        along,
        others,
        inverse,
        dependent,
    };
    (d, step)
}

/// Returns the lesser of a strength and that of a pivot, as a part of its usual size.
fn weaker<S: Scalar>(strength: S, step: &(S, RowStep<S>), usual: Option<f64>, start: S) -> S {
    let part = match usual {
        Some(usual) => step.0.scale(1.0 / usual),
        None => step.0 / start,
    };
    S::select(part.lt(strength), part, strength)
}
