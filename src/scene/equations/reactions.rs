//! Forces and torques that elements exert, as measures: reactions of constraints, actions of
//! forces, sums between two markers.

use super::{Equations, Lack};
use crate::expr::measures::{Family, Measure};
use crate::expr::signature;
use crate::model::{ElementId, ElementKind};
use crate::physics::action::Action;
use crate::scalar::Scalar;
use crate::scene::asker::Asker;
use crate::scene::loops::Key;
use crate::scene::sweep::Wrench;
use crate::scene::{ConstraintElement, Source};
use crate::space::{Mat3, Vec3};

impl<S: Scalar> Equations<'_, S> {
    /// Action of a force element on its I marker.
    pub(super) fn force_action(&self, f: usize) -> Action<S> {
        // within a function: the function may be a load, which the accelerations wait for
        let within = self.scratch.open.borrow().any();
        if self.scratch.solving.get() || self.discovering || within {
            self.scene.forces[f].action(self)
        } else {
            self.solved().actions[f]
        }
    }

    /// Action of an element on its I marker, with the points of I and J; `None` when there is no
    /// such element.
    pub(super) fn element(&self, id: ElementId) -> Option<(Action<S>, Vec3<S>, Vec3<S>)> {
        let scene = self.scene;
        let mut total: Option<(Action<S>, Vec3<S>, Vec3<S>)> = None;
        // an element of several pairs or markers is given about the first
        for (f, force) in scene.forces.iter().enumerate() {
            if force.id != id {
                continue;
            }
            let action = self.force_action(f);
            let p = self.marker(force.i).p_GM;
            total = Some(match total {
                None => (action, p, force.j.map_or(p, |j| self.marker(j).p_GM)),
                Some((sum, p_I, p_J)) => (sum.plus(&action.about(p, p_I)), p_I, p_J),
            });
        }
        if total.is_some() {
            return total;
        }
        let c = scene.constraints.iter().position(|c| c.id == id)?;
        let about = scene.constraints[c].about?;
        let j = scene.constraints[c].markers.map_or(about, |(_, j)| j);
        let action = if self.discovering {
            Action::zero()
        } else {
            self.reaction(c)
        };
        let point = |m: usize| self.marker(m).p_GM;
        if let Some(cam) = self.cam_of(&scene.constraints[c]) {
            let place = self.cam_place(cam);
            return Some((action, place, place));
        }
        Some((action, point(about), point(j)))
    }

    /// The reaction of a constraint on its I marker (of a contact of curves about where it
    /// touches): where rows depend on each other, its part of the least set.
    pub fn reaction(&self, c: usize) -> Action<S> {
        match self.least().get(c) {
            Some(Some(action)) => *action,
            _ => self.reaction_to(c, &self.solved().lambda, self.carried()),
        }
    }

    /// Returns what a constraint exerts on its I marker when rows have these multipliers and links
    /// are carried by these wrenches.
    pub(super) fn reaction_to(&self, c: usize, lambda: &[S], carried: &[Wrench<S>]) -> Action<S> {
        let scene = self.scene;
        let element = &scene.constraints[c];
        let mut sum = Action::zero();
        let Some(p_I) = self.given_about(element) else {
            return sum;
        };
        for r in element.rows.clone() {
            let l = lambda[r];
            if !l.is_known_zero() {
                sum = sum.plus(&self.exerted(element, &self.row(r).actions, l));
            }
        }
        let drive = |coordinate: usize| {
            let f = &scene.freedoms[coordinate];
            self.driving(coordinate, f.component(&carried[f.link]), p_I)
        };
        if let Some(coordinate) = element.coordinate {
            return drive(coordinate);
        }
        if let Some((link, backward)) = element.carries {
            let mut on_carried = self.on_link(link, &carried[link], p_I);
            // the part along a driven coordinate belongs to its MOTION
            for (k, coordinate) in scene.coordinates.iter().enumerate() {
                if coordinate.joint.map(|j| ElementKind::Joint.id(j)) == Some(element.id)
                    && matches!(coordinate.source, Source::Driven(_))
                {
                    let drive = drive(k);
                    on_carried = on_carried.plus(&if backward { drive } else { negative(&drive) });
                }
            }
            sum = sum.plus(&if backward {
                negative(&on_carried)
            } else {
                on_carried
            });
        }
        sum
    }

    /// Where the reaction of a constraint is given about; `None`: it has none that can be asked
    /// for.
    fn given_about(&self, element: &ConstraintElement) -> Option<Vec3<S>> {
        let about = element.about?;
        Some(match self.cam_of(element) {
            Some(cam) => self.cam_place(cam),
            None => self.marker(about).p_GM,
        })
    }

    /// Returns what a constraint exerts on its I marker with `l` times these actions on markers.
    pub(super) fn exerted(
        &self,
        element: &ConstraintElement,
        actions: &[(usize, Action<S>)],
        l: S,
    ) -> Action<S> {
        let mut sum = Action::zero();
        let Some(p_I) = self.given_about(element) else {
            return sum;
        };
        let is_at_i = |m: usize| element.about == Some(m) && self.cam_of(element).is_none();
        for (m, a) in actions.iter().filter(|(m, _)| element.acts_on.contains(m)) {
            let force = a.force.times(l);
            let torque = if is_at_i(*m) {
                a.torque.times(l)
            } else {
                a.torque.times(l) + (self.marker(*m).p_GM - p_I).cross(force)
            };
            sum = sum.plus(&Action { force, torque });
        }
        sum
    }

    /// Returns a wrench on a link as an action about a point.
    pub(super) fn on_link(&self, link: usize, w: &Wrench<S>, about: Vec3<S>) -> Action<S> {
        let X = &self.links()[link].X_GL;
        let force = X.rotation.apply(w.force);
        Action {
            force,
            torque: X.rotation.apply(w.torque) + (X.position - about).cross(force),
        }
    }

    /// Returns what the drive of a coordinate exerts on the I marker of its joint, about a point.
    pub(super) fn driving(&self, coordinate: usize, magnitude: S, about: Vec3<S>) -> Action<S> {
        let f = &self.scene.freedoms[coordinate];
        let mut w = Wrench::zero();
        let part = if f.turn { &mut w.torque } else { &mut w.force };
        part.0[f.axis] = magnitude.scale(f.sign);
        let on_carried = self.on_link(f.link, &w, about);
        if f.sign < 0.0 {
            negative(&on_carried)
        } else {
            on_carried
        }
    }

    /// NFORCE(id, at, comp, rm): the action on one of its markers, I or J.
    fn nodal_force(&self, [id, at, comp, rm]: [u32; 4], asked_by: &Asker) -> S {
        let scene = self.scene;
        let element = ElementKind::Nforce.id(id);
        let number = |m: usize| scene.markers[m].id;
        let mut found = None;
        let nodes = scene.forces.iter().enumerate();
        for (f, force) in nodes.filter(|(_, f)| f.id == element) {
            let mut add = |action: Action<S>| {
                found = Some(found.map_or(action, |sum: Action<S>| sum.plus(&action)));
            };
            if number(force.i) == at {
                add(self.force_action(f));
            }
            if let Some(j) = force.j.filter(|&j| number(j) == at) {
                let (p_I, p_J) = (self.marker(force.i).p_GM, self.marker(j).p_GM);
                add(self.force_action(f).reaction(p_I, p_J));
            }
        }
        match found {
            Some(action) => self.component(&action, comp, rm, asked_by),
            None => self.complain(asked_by, Lack::NodalForce { id, marker: at }),
        }
    }

    /// FRICTION(id, index), in the axes of the joint's J marker.
    fn friction(&self, id: u32, index: u32, asked_by: &Asker) -> S {
        let scene = self.scene;
        let element = ElementKind::Friction.id(id);
        let found = scene.forces.iter().find(|f| f.id == element);
        let Some((slip, j)) = found.and_then(|f| Some((f.slip(self)?, f.j?))) else {
            return self.complain(asked_by, Lack::ActiveElement(element));
        };
        let axes = self.marker(j).R_GM;
        let k = index as usize;
        match index {
            1..=3 => axes.column(k - 1).dot(slip.action.force),
            4..=6 => axes.column(k - 4).dot(slip.action.torque),
            14..=16 => axes.column(k - 14).dot(slip.velocity),
            17..=19 => axes.column(k - 17).dot(slip.spin),
            _ => self.complain(asked_by, Lack::FrictionComponent(index)),
        }
    }

    pub(super) fn element_force(
        &self,
        measure: Measure,
        [id, jflag, comp, rm]: [u32; 4],
        asked_by: &Asker,
    ) -> S {
        // what is switched off exerts nothing
        let element = element_of(measure, id);
        if element.is_some_and(|e| self.scene.inactive.contains(&e)) {
            return S::zero();
        }
        if measure == Measure::Nforce {
            return self.nodal_force([id, jflag, comp, rm], asked_by);
        }
        if measure == Measure::Friction {
            return self.friction(id, jflag, asked_by);
        }
        let Some(element) = element else {
            return self.complain(asked_by, Lack::Measure(measure));
        };
        if self.scratch.solving.get() && self.scene.constraints.iter().any(|c| c.id == element) {
            let key = Key::Measure(measure, [id, jflag, comp, rm]);
            return self.too_early(key, asked_by, Lack::OwnReaction(measure));
        }
        let Some((action, p_I, p_J)) = self.element(element) else {
            return self.complain(asked_by, Lack::ActiveElement(element));
        };
        let mut forces = self.scene.forces.iter().filter(|f| f.id == element);
        let action = if jflag != 1 {
            action
        } else if forces.any(|f| f.reaction.is_none()) {
            // nothing feels the reaction of an action-only force
            Action::zero()
        } else {
            action.reaction(p_I, p_J)
        };
        self.component(&action, comp, rm, asked_by)
    }

    /// Component 1–8 of an action, resolved in marker `rm`.
    pub(super) fn component(&self, action: &Action<S>, comp: u32, rm: u32, asked_by: &Asker) -> S {
        let axes = if rm == 0 {
            Mat3::identity()
        } else {
            match self.marker_by_id(rm, false) {
                Some(m) => m.R_GM,
                None => return self.complain(asked_by, Lack::Element(ElementKind::Marker.id(rm))),
            }
        };
        let length = |v: Vec3<S>| {
            let n2 = v.norm2();
            let zero = n2.le(S::zero());
            S::select(zero, S::zero(), S::select(zero, S::one(), n2).sqrt())
        };
        match comp {
            1 => length(action.force),
            2..=4 => axes.column(comp as usize - 2).dot(action.force),
            5 => length(action.torque),
            6..=8 => axes.column(comp as usize - 6).dot(action.torque),
            _ => self.complain(asked_by, Lack::Component(comp)),
        }
    }

    /// FM … TZ: all that acts between two markers.
    pub(super) fn generic_force(&self, measure: Measure, ids: [u32; 4], asked_by: &Asker) -> S {
        let [i, j, k, _] = ids;
        if self.scratch.solving.get() && self.carries_reaction(i, j) {
            let key = Key::Measure(measure, ids);
            return self.too_early(key, asked_by, Lack::OwnReaction(measure));
        }
        let total = self.between(i, j);
        self.component(&total, generic_component(measure), k, asked_by)
    }

    /// Returns true if a constraint acts between two markers, given by their numbers.
    pub(super) fn carries_reaction(&self, i: u32, j: u32) -> bool {
        let mut all = self.scene.constraints.iter();
        all.any(|c| (self.named(c)).is_some_and(|m| m == (i, j) || m == (j, i)))
    }

    /// Returns what loads that read reactions, as unknowns of the loops, would read of these
    /// actions of constraints on their I markers: index of the constraint, the value, and whether
    /// it is a torque.   (actions: n_constraints)
    pub fn read_in_loops(&self, actions: &[Action<S>]) -> Vec<(usize, S, bool)> {
        let scene = self.scene;
        let mut read = Vec::new();
        for unknown in &scene.loops {
            let Key::Measure(measure, ids) = unknown.key else {
                continue;
            };
            let element = element_of(measure, ids[0]);
            let is_generic = measure.row().family == Family::GenericForce;
            for (c, constraint) in scene.constraints.iter().enumerate() {
                let named = self.named(constraint).filter(|_| is_generic);
                let between = named.filter(|m| [*m, (m.1, m.0)].contains(&(ids[0], ids[1])));
                let (comp, rm, on_j) = match between {
                    Some(markers) => {
                        let on_j = markers != (ids[0], ids[1]);
                        (generic_component(measure), ids[2], on_j)
                    }
                    None if element == Some(constraint.id) => (ids[2], ids[3], ids[1] == 1),
                    None => continue,
                };
                let point = |m: usize| self.marker(m).p_GM;
                let action = match constraint.markers.filter(|_| on_j) {
                    Some((i, j)) => actions[c].reaction(point(i), point(j)),
                    None => actions[c],
                };
                let value = self.component(&action, comp, rm, &unknown.asker);
                read.push((c, value, comp > 4));
            }
        }
        read
    }

    /// Numbers of the markers between which a constraint acts: floating ones where contacts of
    /// curves have them.
    fn named(&self, element: &ConstraintElement) -> Option<(u32, u32)> {
        let id = |m: usize| self.scene.markers[m].id;
        match self.cam_of(element) {
            Some(cam) => Some(self.scene.cams[cam].between),
            None => element.markers.map(|(a, b)| (id(a), id(b))),
        }
    }

    /// Sum of what acts on marker `i` from elements between `i` and `j`; `j` = 0: from action-only
    /// forces.
    pub(super) fn between(&self, i: u32, j: u32) -> Action<S> {
        let scene = self.scene;
        let mut sum = Action::zero();
        let id = |m: usize| scene.markers[m].id;
        let mut add = |markers: (u32, u32), action: Action<S>, p_I: Vec3<S>, p_J: Vec3<S>| {
            if markers == (i, j) {
                sum = sum.plus(&action);
            } else if markers == (j, i) {
                sum = sum.plus(&action.reaction(p_I, p_J));
            }
        };
        for (f, force) in scene.forces.iter().enumerate() {
            let other = match (force.reaction, force.j) {
                (None, _) => 0,
                (Some(_), Some(m)) => id(m),
                (Some(_), None) => force.floating,
            };
            let markers = (id(force.i), other);
            if markers != (i, j) && markers != (j, i) {
                continue;
            }
            let action = self.force_action(f);
            let p_I = self.marker(force.i).p_GM;
            let p_J = force.j.map_or(p_I, |m| self.marker(m).p_GM);
            add(markers, action, p_I, p_J);
        }
        for (c, element) in scene.constraints.iter().enumerate() {
            let (Some((a, b)), Some(markers)) = (element.markers, self.named(element)) else {
                continue;
            };
            if markers != (i, j) && markers != (j, i) {
                continue;
            }
            if self.discovering {
                continue;
            }
            let place = self.cam_of(element).map(|cam| self.cam_place(cam));
            let point = |m: usize| place.unwrap_or_else(|| self.marker(m).p_GM);
            add(markers, self.reaction(c), point(a), point(b));
        }
        sum
    }
}

fn negative<S: Scalar>(a: &Action<S>) -> Action<S> {
    Action {
        force: -a.force,
        torque: -a.torque,
    }
}

/// Returns the component of all that acts between two markers which a measure returns.
fn generic_component(measure: Measure) -> u32 {
    use Measure as M;
    match measure {
        M::Fm => 1,
        M::Fx => 2,
        M::Fy => 3,
        M::Fz => 4,
        M::Tm => 5,
        M::Tx => 6,
        M::Ty => 7,
        _ => 8,
    }
}

/// Returns the element whose force a measure returns; `None` for measures of other families.
pub(in crate::scene) fn element_of(measure: Measure, number: u32) -> Option<ElementId> {
    let row = measure.row();
    if row.family != Family::ElementForce {
        return None;
    }
    match row.arguments.first()?.kind {
        signature::Kind::Identifier { element, .. } => Some(ElementKind::from(element).id(number)),
        signature::Kind::Number | signature::Kind::Selector(_) => None,
    }
}
