//! Loads, mass and rows in, accelerations and multipliers out; rates of everything that moves.

use super::{Equations, KINEMATIC, RowValue, STATIC};
use crate::model::Level;
use crate::physics::action::Action;
use crate::scalar::{Jet, Scalar};
use crate::scene::articulated::ArticulatedFactor;
use crate::scene::configuration::Way;
use crate::scene::layout::{replace, several};
use crate::scene::loop_factor::LoopFactor;
use crate::scene::solve::{
    Factor, MassFactor, Solution, SymmetricFactor, accelerations, gram, gram_diagonal,
};
use crate::scene::sweep::{self, LinkState, Wrench};
use crate::scene::{LinkMotion, Source, programs};
use crate::space::Vec3;
use std::rc::Rc;

/// `G W x`
fn times<S: Scalar>(g: &[Vec<(usize, S)>], w: &[S], x: &[S]) -> Vec<S> {
    let product = |row: &Vec<(usize, S)>| {
        row.iter()
            .fold(S::zero(), |sum, &(v, y)| sum + y * w[v] * x[v])
    };
    g.iter().map(product).collect()
}

impl<S: Scalar> Equations<'_, S> {
    /// Returns true if a row takes part (it does not where it depends on earlier ones).
    pub fn is_active(&self, r: usize) -> bool {
        self.configuration.active[r]
    }

    /// Returns the rows that take part, in the order of their elimination.
    pub fn rows_in_order(&self) -> Vec<usize> {
        self.configuration.rows_in_order()
    }

    /// Accelerations, multipliers and reactions.
    pub fn solved(&self) -> &Solved<S> {
        let solve = || self.scratch.while_solving(|| self.solve());
        self.scratch.solved.get_or_init(solve)
    }

    pub(super) fn loads(&self) -> (Vec<Wrench<S>>, Vec<Action<S>>) {
        let mut wrenches = vec![Wrench::zero(); self.scene.links.len()];
        let mut actions = Vec::with_capacity(self.scene.forces.len());
        for force in &self.scene.forces {
            let action = force.action(self);
            let i = &self.scene.markers[force.i];
            let point = self.marker(force.i).p_GM;
            sweep::apply(
                &mut wrenches,
                self.links(),
                i.link,
                point,
                action.force,
                action.torque,
            );
            if let Some(link) = force.reaction {
                sweep::apply(
                    &mut wrenches,
                    self.links(),
                    link,
                    point,
                    -action.force,
                    -action.torque,
                );
            }
            actions.push(action);
        }
        (wrenches, actions)
    }

    pub(super) fn gravity(&self) -> Vec3<S> {
        Vec3::constant(self.scene.gravity)
    }

    /// The mass matrix over free coordinates, as rows for [`MassFactor`].
    pub fn mass_rows(&self) -> Vec<Vec<(usize, S)>> {
        let place = |f: usize| self.scene.freedoms[f].v;
        sweep::mass_matrix(self.scene, self.links())
            .into_iter()
            .enumerate()
            .filter(|(f, _)| place(*f).is_some())
            .map(|(_, row)| {
                row.into_iter()
                    .filter_map(|(f, m)| place(f).map(|v| (v, m)))
                    .collect()
            })
            .collect()
    }

    pub(super) fn solve(&self) -> Solved<S> {
        let scene = self.scene;
        let (wrenches, actions) = self.loads();
        let bias = sweep::inward(scene, self.links(), self.gravity(), &wrenches);
        let mut f: Vec<S> = scene
            .freedoms
            .iter()
            .filter(|f| f.v.is_some())
            .map(|f| -f.component(&bias[f.link]))
            .collect();
        let rows: Vec<(usize, Rc<RowValue<S>>)> = (self.rows_in_order())
            .into_iter()
            .map(|r| (r, self.row(r)))
            .collect();
        let g: Vec<Vec<(usize, S)>> = rows.iter().map(|(_, row)| row.gradient.clone()).collect();
        let gamma: Vec<S> = rows.iter().map(|(_, row)| row.gamma).collect();
        let way = &self.configuration.elimination;
        let multipliers = if scene.mode == STATIC {
            self.supporting(&g, &mut f)
        } else if let Some(factor) = self.loop_factor(&g, &way.usual_pivots) {
            Solution {
                x: factor.solve(&mut f, &gamma),
                strength: factor.strength,
            }
        } else {
            match self.mass_factor() {
                Some(factor) => accelerations(&factor, &g, &gamma, &mut f, way),
                None => self.determined(&wrenches, &g, &gamma, &mut f),
            }
        };
        let mut lambda = vec![S::zero(); scene.rows.len()];
        for ((r, _), &l) in rows.iter().zip(&multipliers.x) {
            lambda[*r] = l;
        }
        Solved {
            vdot: f,
            lambda,
            strength: multipliers.strength,
            actions,
            rows,
            loads: wrenches,
        }
    }

    /// Links with all accelerations   (n_links)
    pub fn accelerated_links(&self) -> &[LinkState<S>] {
        let vdot = &self.solved().vdot;
        let links = || sweep::outward(self.scene, &self.coordinates(vdot));
        self.scratch.accelerated.get_or_init(links)
    }

    /// Returns what the carrier exerts on each link, in its axes about its origin   (n_links)
    pub(super) fn carried(&self) -> &[Wrench<S>] {
        let carried = || {
            let solved = self.solved();
            let mut wrenches = solved.loads.clone();
            for (r, row) in &solved.rows {
                let l = solved.lambda[*r];
                for (m, action) in &row.actions {
                    let point = self.marker(*m).p_GM;
                    let link = self.scene.markers[*m].link;
                    let (force, torque) = (action.force.times(l), action.torque.times(l));
                    sweep::apply(&mut wrenches, self.links(), link, point, force, torque);
                }
            }
            let links = self.accelerated_links();
            sweep::inward(self.scene, links, self.gravity(), &wrenches)
        };
        self.scratch.carried.get_or_init(carried)
    }

    /// The factored mass matrix; `None` in kinematics, where masses may be zero and do not matter.
    pub fn mass_factor(&self) -> Option<Factor<'_, S>> {
        if self.scene.mode == KINEMATIC || self.scene.mode == STATIC {
            return None;
        }
        let way = &self.configuration.elimination;
        Some(
            if way.way != Way::MassMatrix && way.lent_inertia.is_empty() {
                Factor::Articulated(ArticulatedFactor::new(self.scene, self.links()))
            } else {
                let mut rows = self.mass_rows();
                for (row, &lent) in rows.iter_mut().zip(&way.lent_inertia) {
                    row[0].1 += S::constant(lent);
                }
                Factor::Matrix(MassFactor::new(rows))
            },
        )
    }

    /// The factors of masses and rows `g` where rows are eliminated as their loops close; `None`:
    /// they are not.
    pub fn loop_factor(
        &self,
        g: &[Vec<(usize, S)>],
        usual_pivots: &[f64],
    ) -> Option<LoopFactor<'_, S>> {
        let massless = self.scene.mode == KINEMATIC || self.scene.mode == STATIC;
        let way = &self.configuration.elimination;
        let here = way.way == Way::RowsWhereLoopsClose && way.lent_inertia.is_empty();
        (here && !massless).then(|| LoopFactor::new(self.scene, self.links(), g, usual_pivots))
    }

    /// The diagonal of `G M⁻¹ Gᵀ` over the rows that take part, in their order: their pivots before
    /// any is eliminated. In kinematics and statics the inverse of M holds the weights of
    /// projections.
    pub fn pivots(&self) -> Vec<S> {
        let rows = self.rows_in_order();
        let g: Vec<Vec<(usize, S)>> = rows
            .into_iter()
            .map(|r| self.row(r).gradient.clone())
            .collect();
        match self.mass_factor() {
            Some(factor) => {
                let depth = self.scene.depth();
                let u = g.iter().map(|row| factor.half_row_near(row, depth));
                let u: Vec<_> = u.collect();
                gram_diagonal(&u, &factor.inverse_d())
            }
            None => gram_diagonal(&g, &self.weights()),
        }
    }

    /// The weights of projections, in place of inverse masses   (n_v)
    fn weights(&self) -> Vec<S> {
        let weights = programs::weights(self.scene).into_iter();
        weights.map(S::constant).collect()
    }

    /// Accelerations (into `f`) and multipliers where the rows leave no freedom, so that masses may
    /// be zero.
    ///
    /// ```text
    /// v̇ = W Gᵀ (G W Gᵀ)⁻¹ γ        λ = (G W Gᵀ)⁻¹ G W (M v̇ − f)
    /// ```
    ///
    /// with the weights W of projections, as turns and slides have different units.
    pub(super) fn determined(
        &self,
        wrenches: &[Wrench<S>],
        g: &[Vec<(usize, S)>],
        gamma: &[S],
        f: &mut [S],
    ) -> Solution<S> {
        let w = self.weights();
        let usual_pivots = &self.configuration.elimination.usual_pivots;
        let gram = SymmetricFactor::new(gram(g, &w), usual_pivots);
        let z = gram.solve(gamma.to_vec());
        f.fill(S::zero());
        for (row, &z) in g.iter().zip(&z) {
            for &(v, x) in row {
                f[v] += x * w[v] * z;
            }
        }
        let links = sweep::outward(self.scene, &self.coordinates(f));
        let carried = sweep::inward(self.scene, &links, self.gravity(), wrenches);
        let missing: Vec<S> = self
            .scene
            .freedoms
            .iter()
            .filter(|f| f.v.is_some())
            .map(|f| f.component(&carried[f.link]))
            .collect();
        gram.solution(times(g, &w, &missing))
    }

    /// Multipliers that balance the loads `f` as well as rows can; accelerations (into `f`) are
    /// zero.
    ///
    /// ```text
    /// λ = −(G W Gᵀ)⁻¹ G W f
    /// ```
    pub(super) fn supporting(&self, g: &[Vec<(usize, S)>], f: &mut [S]) -> Solution<S> {
        let w = self.weights();
        let missing: Vec<S> = f.iter().map(|&f| -f).collect();
        f.fill(S::zero());
        SymmetricFactor::new(gram(g, &w), &[]).solution(times(g, &w, &missing))
    }

    /// Loads along the free coordinates, gravity included, with the forces of the active rows at
    /// the given multipliers: all zero in equilibrium   (n_v)
    pub fn balance(&self, multipliers: &[S]) -> Vec<S> {
        let (wrenches, _) = self.scratch.while_solving(|| self.loads());
        let carried = sweep::inward(self.scene, self.links(), self.gravity(), &wrenches);
        let free = self.scene.freedoms.iter().filter(|f| f.v.is_some());
        let mut f: Vec<S> = free.map(|f| -f.component(&carried[f.link])).collect();
        let active = (0..self.scene.rows.len()).filter(|&r| self.is_active(r));
        for (r, &l) in active.zip(multipliers) {
            for &(v, g) in &self.row(r).gradient {
                f[v] += g * l;
            }
        }
        f
    }

    /// Returns what is missing for these accelerations and multipliers to be those of the
    /// mechanism, along each free coordinate.
    ///
    /// ```text
    /// M v̇ + h(q, v) − f(t, q, v, x) − Gᵀλ        (n_v)
    /// ```
    pub fn imbalance(&self, vdot: &[S], multipliers: &[S]) -> Vec<S> {
        let (mut wrenches, _) = self.scratch.while_solving(|| self.loads());
        let active = (0..self.scene.rows.len()).filter(|&r| self.is_active(r));
        for (r, &l) in active.zip(multipliers) {
            for (m, action) in &self.row(r).actions {
                let point = self.marker(*m).p_GM;
                let link = self.scene.markers[*m].link;
                let (force, torque) = (action.force.times(l), action.torque.times(l));
                sweep::apply(&mut wrenches, self.links(), link, point, force, torque);
            }
        }
        let links = sweep::outward(self.scene, &self.coordinates(vdot));
        let carried = sweep::inward(self.scene, &links, self.gravity(), &wrenches);
        let free = self.scene.freedoms.iter().filter(|f| f.v.is_some());
        free.map(|f| f.component(&carried[f.link])).collect()
    }

    /// The axis of a freedom, ground axes.
    pub fn freedom_axis(&self, f: &sweep::Freedom) -> Vec3<S> {
        let rotation = &self.links()[f.link].X_GL.rotation;
        rotation.column(f.axis).times(S::constant(f.sign))
    }

    /// Returns how large the loads are, whatever cancels: Σ |force| + Σ |torque| / length + weight.
    /// Loads that follow from reactions, as those of friction, are left out: they are no larger.
    pub fn load_scale(&self) -> S {
        let (_, actions) = self.scratch.while_solving(|| self.loads());
        let mass: f64 = self.scene.links.iter().map(|l| l.mass).sum();
        let weight = S::constant(mass * self.scene.gravity.norm());
        actions.iter().fold(weight, |sum, a| {
            let torque = a.torque.norm2().sqrt().scale(1.0 / self.scene.length);
            let size = a.force.norm2().sqrt() + torque;
            sum + S::select(size.same(size), size, S::zero())
        })
    }

    /// `q̇, v̇, ẋ`
    pub fn rates(&self) -> Vec<S> {
        let mut out = self.position_rates();
        out.extend(&self.solved().vdot);
        out.extend(self.state_rates());
        out
    }

    /// `q̇`
    pub fn position_rates(&self) -> Vec<S> {
        self.position_rates_at(&self.now.v)
    }

    /// `q̇` at other velocities of the free coordinates.
    pub fn position_rates_at(&self, v: &[S]) -> Vec<S> {
        let mut out = vec![S::zero(); self.now.q.len()];
        for link in &self.scene.links {
            if let LinkMotion::Ball {
                coordinate,
                quaternion,
            } = link.motion
            {
                let speed = |k: usize| match self.scene.coordinates[coordinate + k].source {
                    Source::Free { v: place, .. } => v[place],
                    Source::Driven(_) => unreachable!("no motion drives a ball"),
                };
                let w = Vec3([0, 1, 2].map(speed));
                let q: [S; 4] = several(&self.now.q, quaternion);
                let rate = crate::space::rotation::quaternion_rate(q, w);
                replace(&mut out, quaternion, rate);
            }
        }
        for (c, f) in self.scene.coordinates.iter().zip(&self.scene.freedoms) {
            if let (Source::Free { q, v: place }, false) = (c.source, f.in_ball) {
                out[q] = v[place];
            }
        }
        out
    }

    /// Returns a coordinate of the forest, which is no ball's, with its rate.
    pub fn coordinate(&self, c: usize) -> Jet<S> {
        self.coordinates(&[]).of(self.scene.coordinates[c].source)
    }

    /// Returns `ẋ` of the states that are unknowns of the integrator.
    pub fn state_rates(&self) -> Vec<S> {
        let mut out = vec![S::zero(); self.scene.layout.n_upstream()];
        for (m, motion) in self.scene.motions.iter().enumerate() {
            if let Some(s) = motion.state {
                out[s] = self.driven[m].first;
                if motion.level == Level::Acceleration {
                    out[s + 1] = self.driven[m].second;
                }
            }
        }
        if self.scene.mode != STATIC {
            for (c, cam) in self.scene.cams.iter().enumerate() {
                let jets = self.cam_jets(c);
                for (k, jet) in jets.iter().enumerate().take(cam.contact.n_parameters()) {
                    out[cam.state + k] = jet.first;
                }
            }
        }
        for (k, d) in self.scene.differentials.iter().enumerate() {
            let Some(state) = d.state.filter(|&state| state < out.len()) else {
                continue;
            };
            // at rest the residual of an implicit equation stands for its rate
            out[state] = if d.implicit && self.scene.mode == STATIC {
                self.formula(d.formula)
            } else {
                self.rate_of(k)
            };
        }
        for force in &self.scene.forces {
            let (places, rates) = force.state_rates(self);
            out[places].copy_from_slice(&rates);
        }
        out
    }

    /// Returns `ẋ` of the states downstream of the mechanism.
    pub fn downstream_rates(&self) -> Vec<S> {
        let layout = &self.scene.layout;
        let mut out = vec![S::zero(); layout.n_downstream];
        for (k, d) in self.scene.differentials.iter().enumerate() {
            let place = d.state.and_then(|s| s.checked_sub(layout.n_upstream()));
            if let Some(place) = place {
                out[place] = self.rate_of(k);
            }
        }
        out
    }
}

/// Accelerations and multipliers, and what they were found from.
pub struct Solved<S> {
    /// accelerations   (n_v)
    pub vdot: Vec<S>,
    /// multipliers of the rows; 0 for rows that do not take part   (n_rows)
    pub lambda: Vec<S>,
    /// least pivot of the rows as a part of what it usually is: small near a position where rows
    /// become dependent
    pub strength: S,
    /// actions of the force elements on their I markers
    pub actions: Vec<Action<S>>,
    /// the rows that take part
    rows: Vec<(usize, Rc<RowValue<S>>)>,
    /// what force elements exert on each link   (n_links)
    loads: Vec<Wrench<S>>,
}
