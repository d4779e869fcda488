//! The least set of reactions, where rows depend on each other and leave them open.
//!
//! ```text
//! Σ |F_e|² + |T_e|²/L²  least over all constraint elements e,   T_e about the middle of the two markers, L the distance over which constraints are spread
//! ```
//!
//! It does not depend on the order of elements, on ground, on which marker is called I, nor on what
//! carries what. It is the set that elastic elements would exert: links yield by small twists μ,
//! and each reaction x that an element may exert is the force of a spring.
//!
//! ```text
//! Σ eₖ xₖ = Σ eₖ aₖ   on each link all reactions together do what any set a of them does         (1)
//! cₖ xₖ = eₖᵀ μ       cₖ: what a unit of reaction k costs; those of one element are orthogonal   (2)
//! K μ = Σ eₖ aₖ       K = Σ eₖ eₖᵀ/cₖ, where cₖ > 0                                              (3)
//! ```
//!
//! K couples only links that an element joins. It is singular in the motions that all rows permit,
//! which no reaction resists. Two kinds of reactions stand beside K, as unknowns x: those that
//! cost nothing, as of an expression without a marker I, and those of rows that depend on others
//! but for a misalignment, which would resist motions that the mechanism has.
//!
//! ```text
//! free of cost        eᵀ μ = 0, and e eᵀ/|e|² is added to K, which then changes nothing
//! misaligned          eᵀ μ − c x = 0, and nothing is added to K
//! ```
//!
//! Only elements around loops that share links with a dependent row take part, and of their
//! reactions those that hang together with it: in a flat mechanism, forces and torques out of the
//! plane. All others are determined.

use super::Equations;
use super::rows::twist;
use crate::arrange::Arrange;
use crate::numeric::connected::{SparseRow, connected};
use crate::physics::action::Action;
use crate::physics::row::Law;
use crate::scalar::Scalar;
use crate::scene::elimination::fewest_neighbours_first;
use crate::scene::solve::{RANK_TOLERANCE, SymmetricFactor, gram};
use crate::scene::{ConstraintElement, RowKind};
use crate::space::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// Actions on markers.
type Actions<S> = Vec<(usize, Action<S>)>;

/// Forces and torques on links that yield, about their origins, in ground axes, torques as parts of
/// L: 6 · link + component → amount.
type Pull<S> = BTreeMap<usize, S>;

/// A reaction that an element may exert.
struct Reaction<S> {
    /// the element: index in [`Scene::constraints`](crate::scene::Scene::constraints)
    element: usize,
    /// e
    pull: Pull<S>,
    /// what it is on the I marker
    action: Action<S>,
    /// the same as it is weighed
    weighed: [Vec3<S>; 2],
    /// c
    cost: S,
    /// 1/c, or 1/|e|² where it is free of cost; 0 where it follows from others of its element
    stiffness: S,
    /// a: how much of it there is with the multipliers of the rows that take part
    given: S,
    /// how it stands in the equations
    kind: Kind,
    /// it is that of a row that does not take part
    is_left_out: bool,
}

/// Place of a reaction in the equations.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// as a spring in K
    Spring,
    /// beside K, free of cost
    Free,
    /// beside K, of a misaligned row
    Loose,
}

impl<S: Scalar> Reaction<S> {
    /// Takes away as much of another reaction of the same element as the two have in common.
    fn make_orthogonal_to(&mut self, other: &Self) {
        let common = product(&self.weighed, &other.weighed) * other.stiffness;
        if common.is_known_zero() {
            return;
        }
        for (&place, &x) in &other.pull {
            *self.pull.entry(place).or_insert_with(S::zero) -= x * common;
        }
        self.action = self.action.plus(&other.action.times(-common));
        for (own, x) in self.weighed.iter_mut().zip(other.weighed) {
            *own -= x.times(common);
        }
    }
}

/// Links and elements whose reactions are open.
struct Open {
    /// links around the loops   (n_links)
    links: Vec<bool>,
    /// of these, links that cannot turn whatever acts on them: point masses   (n_links)
    unturned: Vec<bool>,
    /// elements   (ascending)
    elements: Vec<usize>,
}

impl<S: Scalar> Equations<'_, S> {
    /// Returns the reactions of the least set; `None` where they are determined   (n_constraints,
    /// or 0 where all are).
    pub(super) fn least(&self) -> &[Option<Action<S>>] {
        self.scratch.least.get_or_init(|| self.least_set())
    }

    fn least_set(&self) -> Vec<Option<Action<S>>> {
        let Some(open) = self.open_reactions() else {
            return Vec::new();
        };
        let mut least = vec![None; self.scene.constraints.len()];
        let mut reactions = Vec::new();
        for &c in &open.elements {
            let base = self.reaction_to(c, &self.solved().lambda, self.carried());
            reactions.extend(self.reactions_of(c, &base, &open));
            least[c] = Some(base);
        }
        let reactions = around_left_out(reactions);
        for (reaction, x) in reactions.iter().zip(amounts(&reactions)) {
            if let Some(sum) = &mut least[reaction.element] {
                *sum = sum.plus(&reaction.action.times(x - reaction.given));
            }
        }
        least
    }

    /// Finds what redundant rows leave open; `None`: nothing.
    fn open_reactions(&self) -> Option<Open> {
        let scene = self.scene;
        let left_out = |e: &ConstraintElement| e.rows.clone().any(|r| !self.is_active(r));
        if !scene.constraints.iter().any(left_out) {
            return None;
        }
        let around = |e: &ConstraintElement| -> SparseRow {
            let links = e.rows.clone();
            let links = links.flat_map(|r| self.links_around(r, &self.actions_of(r)));
            links.map(|l| (l, 1.0)).collect()
        };
        let loops: Vec<SparseRow> = scene.constraints.iter().map(around).collect();
        let mut links = vec![false; scene.links.len()];
        for block in connected(&loops, scene.links.len()) {
            if (block.rows.iter()).any(|&c| left_out(&scene.constraints[c])) {
                block.columns.iter().for_each(|&l| links[l] = true);
            }
        }
        let mut unturned = vec![false; scene.links.len()];
        for part in scene.parts.iter().filter(|p| p.is_point_mass()) {
            part.link.into_iter().for_each(|l| unturned[l] = true);
        }
        let is_open = |&c: &usize| {
            let element = &scene.constraints[c];
            let coordinate = element.coordinate.map(|k| scene.coordinates[k].link);
            let carried = element.carries.map(|(link, _)| link).or(coordinate);
            carried
                .or(loops[c].first().map(|l| l.0))
                .is_some_and(|l| links[l])
        };
        let elements: Vec<usize> = (0..loops.len()).filter(is_open).collect();
        Some(Open {
            links,
            unturned,
            elements,
        })
    }

    /// Returns what a unit multiplier of a row exerts.
    fn actions_of(&self, r: usize) -> Actions<S> {
        let known = self.scratch.rows.borrow()[r].clone();
        match (known, &self.scene.rows[r].kind) {
            (Some(row), _) => row.actions.clone(),
            (None, &RowKind::Markers { law, i, j, motion }) => {
                let drive = motion.map(|m| self.row_drive(m));
                let seeded = self.along_twists(law, (i, j), drive);
                vec![(i, twist(&seeded, 0)), (j, twist(&seeded, 6))]
            }
            (None, _) => self.row(r).actions.clone(),
        }
    }

    /// Returns the reactions that an element may exert, orthogonal in cost. `base`: what it exerts
    /// with the multipliers of the rows that take part.
    fn reactions_of(&self, c: usize, base: &Action<S>, open: &Open) -> Vec<Reaction<S>> {
        let element = &self.scene.constraints[c];
        let base = self.weighed(element, base);
        let mut own: Vec<Reaction<S>> = Vec::new();
        for (row, actions) in self.units(element) {
            let mut next = self.reaction_by(c, &actions, open);
            next.is_left_out = row.is_some_and(|r| !self.is_active(r));
            let cost = product(&next.weighed, &next.weighed);
            if cost.is_known_zero() {
                let size = next.pull.values().fold(S::zero(), |s, &x| s + x * x);
                (next.kind, next.stiffness) = (Kind::Free, inverse(size, S::zero()));
                next.given = row.map_or_else(S::zero, |r| self.solved().lambda[r]);
            } else {
                own.iter().for_each(|other| next.make_orthogonal_to(other));
                if row.is_some_and(|r| self.configuration.is_loose(r)) {
                    next.kind = Kind::Loose;
                }
                next.cost = product(&next.weighed, &next.weighed);
                next.stiffness = inverse(next.cost, cost.scale(RANK_TOLERANCE));
                next.given = product(&next.weighed, &base) * next.stiffness;
            }
            next.pull.retain(|_, x| !x.is_known_zero());
            own.push(next);
        }
        own
    }

    /// Returns what an element may exert, by units, and the row whose unit it is: those of
    /// misaligned rows last.
    fn units(&self, element: &ConstraintElement) -> Vec<(Option<usize>, Actions<S>)> {
        let mut units = Vec::new();
        if let (Some((i, j)), Some(coordinate)) = (element.markers, element.coordinate) {
            let (p_I, p_J) = (self.marker(i).p_GM, self.marker(j).p_GM);
            let on_i = self.driving(coordinate, S::one(), p_I);
            units.push((None, vec![(i, on_i), (j, on_i.reaction(p_I, p_J))]));
        }
        if let (Some((i, j)), Some(_)) = (element.markers, element.carries) {
            for &law in element.laws {
                let seeded = self.along_twists(law, (i, j), None);
                let actions = vec![(i, twist(&seeded, 0)), (j, twist(&seeded, 6))];
                units.push((None, actions));
            }
        }
        units.extend(element.rows.clone().map(|r| (Some(r), self.actions_of(r))));
        units.arrange_by_key(|unit| unit.0.is_some_and(|r| self.configuration.is_loose(r)));
        units
    }

    /// Returns the reaction of an element that is these actions, whatever it costs.
    fn reaction_by(&self, c: usize, actions: &Actions<S>, open: &Open) -> Reaction<S> {
        let element = &self.scene.constraints[c];
        let action = self.exerted(element, actions, S::one());
        Reaction {
            element: c,
            pull: self.pull(actions, open),
            action,
            weighed: self.weighed(element, &action),
            cost: S::zero(),
            stiffness: S::zero(),
            given: S::zero(),
            kind: Kind::Spring,
            is_left_out: false,
        }
    }

    /// Returns what acts on the links that yield.
    fn pull(&self, actions: &Actions<S>, open: &Open) -> Pull<S> {
        let mut pull = Pull::new();
        let per_length = S::constant(1.0 / self.scene.span);
        for (m, action) in actions {
            let Some(l) = self.scene.markers[*m].link.filter(|&l| open.links[l]) else {
                continue;
            };
            let arm = self.marker(*m).p_GM - self.links()[l].X_GL.position;
            let torque = (action.torque + arm.cross(action.force)).times(per_length);
            let n = if open.unturned[l] { 3 } else { 6 };
            for (k, &x) in action.force.0.iter().chain(&torque.0).enumerate().take(n) {
                if !x.is_known_zero() {
                    *pull.entry(6 * l + k).or_insert_with(S::zero) += x;
                }
            }
        }
        pull
    }

    /// Returns the reaction of an element as it is weighed: its force, and its torque as it is
    /// compared with forces.
    fn weighed(&self, element: &ConstraintElement, x: &Action<S>) -> [Vec3<S>; 2] {
        let arm = match (element.about, element.markers) {
            // given about where it touches, or holds the markers together
            _ if self.cam_of(element).is_some() => Vec3::zero(),
            _ if element.laws.contains(&Law::Offset(0)) => Vec3::zero(),
            (Some(about), Some((i, j))) if about == i => {
                let (p_I, p_J) = (self.marker(i).p_GM, self.marker(j).p_GM);
                (p_I - p_J).times(S::constant(0.5))
            }
            _ => Vec3::zero(),
        };
        let per_length = S::constant(1.0 / self.scene.span);
        [x.force, (x.torque + arm.cross(x.force)).times(per_length)]
    }
}

/// Returns those reactions that hang together with one of a row that does not take part.
fn around_left_out<S: Scalar>(reactions: Vec<Reaction<S>>) -> Vec<Reaction<S>> {
    let on_links = |r: &Reaction<S>| r.pull.keys().map(|&p| (p, 1.0)).collect();
    let rows: Vec<SparseRow> = reactions.iter().map(on_links).collect();
    let n = rows.iter().flatten().map(|e| e.0 + 1).max().unwrap_or(0);
    let mut hangs = vec![false; reactions.len()];
    for block in connected(&rows, n) {
        if block.rows.iter().any(|&k| reactions[k].is_left_out) {
            block.rows.into_iter().for_each(|k| hangs[k] = true);
        }
    }
    let both = reactions.into_iter().zip(hangs);
    both.filter(|b| b.1).map(|b| b.0).collect()
}

/// Returns how much of each reaction belongs to the least set that does what the given amounts do.
fn amounts<S: Scalar>(reactions: &[Reaction<S>]) -> Vec<S> {
    let place = places(reactions);
    let row = |r: &Reaction<S>| -> Vec<(usize, S)> {
        r.pull.iter().map(|(p, &x)| (place[p], x)).collect()
    };
    let e: Vec<_> = reactions.iter().map(row).collect();
    let along = |k: usize, twists: &[S]| {
        let sum = |s: S, &(p, x): &(usize, S)| s + x * twists[p];
        e[k].iter().fold(S::zero(), sum)
    };
    let mut at_place: Vec<Vec<(usize, S)>> = vec![Vec::new(); place.len()];
    for (k, row) in e.iter().enumerate() {
        row.iter().for_each(|&(p, x)| at_place[p].push((k, x)));
    }
    let of_spring = |r: &Reaction<S>| match r.kind {
        Kind::Spring | Kind::Free => r.stiffness,
        Kind::Loose => S::zero(),
    };
    let stiffness: Vec<S> = reactions.iter().map(of_spring).collect();
    let factor = SymmetricFactor::new(gram(&at_place, &stiffness), &[]);
    let mut load = vec![S::zero(); place.len()];
    for (row, reaction) in e.iter().zip(reactions) {
        row.iter().for_each(|&(p, x)| load[p] += x * reaction.given);
    }
    let mut twists = factor.solve(load);
    let is_beside = |k: &usize| reactions[*k].kind != Kind::Spring;
    let beside: Vec<usize> = (0..reactions.len()).filter(is_beside).collect();
    // (Eᵀ K⁻¹ E + C) x = Eᵀ K⁻¹ b
    let under_one = |&k: &usize| {
        let mut load = vec![S::zero(); place.len()];
        e[k].iter().for_each(|&(p, x)| load[p] = x);
        factor.solve(load)
    };
    let yielding: Vec<Vec<S>> = beside.iter().map(under_one).collect();
    let compliance = (beside.iter().enumerate())
        .map(|(r, &k)| {
            let mut row: Vec<_> = (0..=r).map(|c| (c, along(k, &yielding[c]))).collect();
            row[r].1 += reactions[k].cost;
            row
        })
        .collect();
    let given = beside.iter().map(|&k| along(k, &twists)).collect();
    let unknown = SymmetricFactor::new(compliance, &[]).solve(given);
    for (own, &x) in yielding.iter().zip(&unknown) {
        for (twist, &y) in twists.iter_mut().zip(own) {
            *twist -= y * x;
        }
    }
    let mut x: Vec<S> = (stiffness.iter().enumerate())
        .map(|(k, &s)| along(k, &twists) * s)
        .collect();
    for (&k, amount) in beside.iter().zip(unknown) {
        x[k] = amount;
    }
    x
}

/// Returns the place among the unknowns of each component of the twist of each link that yields.
/// Links that few elements join to others come first.
fn places<S>(reactions: &[Reaction<S>]) -> BTreeMap<usize, usize> {
    // by elements: links
    let mut joined: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for reaction in reactions {
        let links = joined.entry(reaction.element).or_default();
        links.extend(reaction.pull.keys().map(|p| p / 6));
    }
    let links: BTreeSet<usize> = joined.values().flatten().copied().collect();
    let links: Vec<usize> = links.into_iter().collect();
    let index: BTreeMap<usize, usize> = links.iter().enumerate().map(|(k, &l)| (l, k)).collect();
    let mut neighbours = vec![BTreeSet::new(); links.len()];
    for together in joined.values() {
        for l in together {
            let others = together.iter().filter(|&o| o != l);
            neighbours[index[l]].extend(others.map(|o| index[o]));
        }
    }
    let used: BTreeSet<usize> = (reactions.iter())
        .flat_map(|r| r.pull.keys().copied())
        .collect();
    let order = fewest_neighbours_first(neighbours);
    let all = order.into_iter().flat_map(|k| {
        let l = links[k];
        used.range(6 * l..6 * l + 6).copied()
    });
    all.enumerate().map(|(k, p)| (p, k)).collect()
}

fn product<S: Scalar>(a: &[Vec3<S>; 2], b: &[Vec3<S>; 2]) -> S {
    a[0].dot(b[0]) + a[1].dot(b[1])
}

/// Returns 1/x, and zero where x is none.
fn inverse<S: Scalar>(x: S, none: S) -> S {
    S::choose(x.le(none), S::zero, || S::one() / x)
}
