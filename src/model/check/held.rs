//! Parts that nothing holds, and joints that seem to be forgotten: where two markers of different
//! parts lie on each other, or a torque turns two parts about no axis.

use super::*;
use crate::arrange::Arrange;
use crate::model::geometry::marker_frame;
use crate::space::{Frame, Vec3};
use std::cell::LazyCell;
use std::collections::BTreeSet;

/// Distance of markers on each other, at most, relative to that of the farthest marker from the
/// origin of ground.
const TOUCHING: f64 = 1e-6;

/// Markers that nothing names, at most, in a model that leaves none lying about; a tenth of many.
const MOST_UNNAMED: usize = 4;

/// Bodies in groups that are tied together, by constraints, forces or contacts.
struct Groups(BTreeMap<ElementId, ElementId>);

impl Groups {
    /// The representative of the group of a body; the way to it is halved for the next time.
    fn of(&mut self, mut body: ElementId) -> ElementId {
        while let Some(&next) = self.0.get(&body).filter(|&&next| next != body) {
            let beyond = self.0.get(&next).copied().unwrap_or(next);
            self.0.insert(body, beyond);
            body = beyond;
        }
        body
    }

    fn tie(&mut self, bodies: &[ElementId]) {
        for pair in bodies.windows(2) {
            let (a, b) = (self.of(pair[0]), self.of(pair[1]));
            // ground, of which most groups are, stays the representative
            self.0.insert(a.max(b), a.min(b));
        }
    }
}

/// The bodies between which an element acts: those of all the markers that it names, directly, by
/// joints and shapes, or in its functions.
fn bodies_of(model: &Model, element: &dyn Element) -> Vec<ElementId> {
    let formulas = element.formulas().into_iter();
    let in_functions = formulas.flat_map(|f| markers_in(f.1)).collect();
    bodies_named(model, element.references(), in_functions)
}

/// The same, of what an element names by its numbers, and of the markers in its functions.
fn bodies_named(model: &Model, references: Vec<Named>, in_functions: Vec<u32>) -> Vec<ElementId> {
    let mut markers = in_functions;
    for (_, target) in references {
        match target.kind {
            ElementKind::Marker => markers.push(target.number),
            _ => {
                let named = model.element(target).map(|e| e.references());
                let named = named.into_iter().flatten();
                markers.extend(
                    (named.filter(|n| n.1.kind == ElementKind::Marker)).map(|n| n.1.number),
                );
            }
        }
    }
    let mut bodies: Vec<ElementId> = markers
        .into_iter()
        .filter_map(|m| model.body_of(m))
        .collect();
    bodies.arrange();
    bodies.dedup();
    bodies
}

/// The markers that an expression names.
fn markers_in(formula: &Formula) -> Vec<u32> {
    let Formula::Expression { text, .. } = formula else {
        return Vec::new();
    };
    let Ok(ast) = text.sound_ast() else {
        return Vec::new();
    };
    let named = super::references::named(ast).into_iter();
    let markers = named.filter(|(_, id)| id.kind == ElementKind::Marker);
    markers.map(|(_, id)| id.number).collect()
}

/// Returns whether all elements that could hold a part are known, and none is kept as text.
fn is_fully_known(model: &Model) -> bool {
    !model.others.keys().any(|id| id.kind.is_unsolved())
}

pub(super) fn parts_are_held(model: &Model, out: &mut Out) {
    if model.gravity == [0.0; 3] || !is_fully_known(model) {
        return;
    }
    let Some(ground) = model.bodies().find(|b| b.1.ground).map(|b| b.0) else {
        return;
    };
    let mut groups = Groups(model.bodies().map(|(id, _)| (id, id)).collect());
    for (id, element) in model.elements() {
        let acts = matches!(id.kind.family(), Family::Constraint | Family::Force);
        if !acts || !model.is_active(id) {
            continue;
        }
        let mut bodies = bodies_of(model, element);
        // a force without reaction comes from outside
        let from_outside = match id.kind {
            ElementKind::Sforce => model.sforces.get(&id.number).is_some_and(|s| s.action_only),
            _ => bodies.len() == 1,
        };
        bodies.extend(from_outside.then_some(ground));
        groups.tie(&bodies);
    }
    let held = groups.of(ground);
    let may_fall = |(id, part): &(ElementId, &Part)| {
        let thrown = part.velocity.iter().flatten().any(|&v| v != 0.0);
        !part.ground && model.is_active(*id) && !thrown
    };
    let mut told = BTreeMap::new();
    for (id, part) in model.bodies().filter(may_fall) {
        let group = groups.of(id);
        if group != held && *told.entry(group).or_insert(id) == id {
            let message = "nothing holds it: no joint, force or contact ties it to ground, and it falls for ever";
            warn(out, "nothing_holds", (id, &part.place), message.into());
            advise(
                out,
                "a joint ties it to a part; a velocity in VX, VY or VZ says that it is thrown",
            );
        }
    }
}

/// A torque about z of J between two parts, by SFORCE or SPRINGDAMPER, turns them about the axis of
/// a joint between the two.
pub(super) fn torques_have_an_axis(model: &Model, out: &mut Out) {
    if !is_fully_known(model) {
        return;
    }
    let torques = model.active(ElementKind::Sforce, &model.sforces);
    let torques = torques.filter(|(_, s)| s.rotational && !s.action_only);
    let torques = torques.map(|(id, s)| (ElementKind::Sforce.id(id), &s.place, [s.i, s.j]));
    let springs = model.active(ElementKind::SpringDamper, &model.spring_dampers);
    let springs = springs.filter(|(_, s)| s.rotational);
    let springs = springs.map(|(id, s)| (ElementKind::SpringDamper.id(id), &s.place, [s.i, s.j]));
    let torques: Vec<_> = torques.chain(springs).collect();
    if torques.is_empty() {
        return;
    }
    let (mut tied, mut turnless) = (BTreeSet::new(), BTreeMap::new());
    for (id, joint) in model.active(ElementKind::Joint, &model.joints) {
        let holds = matches!(joint.kind, JointKind::Fixed | JointKind::Translational);
        let ends = [model.body_of(joint.i), model.body_of(joint.j)];
        if let ([Some(a), Some(b)], true) = (ends, holds) {
            turnless.insert([a.min(b), a.max(b)], id);
        }
    }
    for (id, element) in model.elements() {
        if id.kind.family() == Family::Constraint && model.is_active(id) {
            let bodies = bodies_of(model, element);
            for (k, &a) in bodies.iter().enumerate() {
                tied.extend(bodies[k + 1..].iter().map(|&b| [a, b]));
            }
        }
    }
    for (id, place, [i, j]) in torques {
        let (Some(a), Some(b)) = (model.body_of(i), model.body_of(j)) else {
            continue;
        };
        let pair = [a.min(b), a.max(b)];
        if let Some(joint) = turnless.get(&pair) {
            let joint = model.called(ElementKind::Joint.id(*joint));
            let [a, b] = [a, b].map(|body| model.called(body));
            let message = format!(
                "it turns nothing: {joint} keeps {a} and {b} from turning against each other"
            );
            warn(out, "no_effect", (id, place), message);
            continue;
        }
        // along a drive train, torques go from part to part beside the bearings
        let grounded = pair
            .iter()
            .any(|&b| model.body(b).is_some_and(|b| b.ground));
        if a == b || tied.contains(&pair) || !grounded {
            continue;
        }
        let message = format!(
            "it turns {} against {} about z of {}, but no joint between the two has such an axis: one may be missing",
            model.called(a),
            model.called(b),
            model.called(ElementKind::Marker.id(j))
        );
        warn(out, "forgotten_joint", (id, place), message);
    }
}

pub(super) fn joints_are_not_forgotten(model: &Model, out: &mut Out) {
    if !is_fully_known(model) {
        return;
    }
    let uses = Uses::of(model);
    // a model that leaves many markers unused leaves them on each other
    let unnamed = model.markers.keys().filter(|m| !contains(&uses.named, m));
    if unnamed.count() > MOST_UNNAMED.max(model.markers.len() / 10) {
        return;
    }
    let both = uses.pairs(model, |a, b| a && b);
    let one = || uses.pairs(model, |a, b| a || b);
    let pairs = if both.is_empty() { one() } else { both };
    let [(here, there)] = pairs[..] else { return };
    let Some((id, part)) = uses.part_of(model, here) else {
        return;
    };
    let Some(other) = model.body_of(there) else {
        return;
    };
    let message = format!(
        "{} of it lies on {} of {other}, where no joint ties the two: one may be missing",
        model.called(ElementKind::Marker.id(here)),
        model.called(ElementKind::Marker.id(there))
    );
    warn(out, "forgotten_joint", (id, &part.place), message);
    advise(
        out,
        format!("a JOINT with I = {here}, J = {there} would tie them"),
    );
}

/// A marker that no constraint or force names, its body, and where it stands.
type Idle = (u32, ElementId, Frame<f64>);

/// Most markers with turned axes of which those on one axis are looked for: all pairs are compared.
const MOST_AXES: usize = 400;

/// Finds the pairs of markers on each other or on the same z axis, the first before the second, as
/// long as `go_on` says so.
fn meetings(idle: &[Idle], near: f64, mut go_on: impl FnMut(&Idle, &Idle) -> bool) {
    let places: Vec<Vec3<f64>> = idle.iter().map(|m| m.2.position).collect();
    let sorted = Sorted::of(&places);
    for (k, a) in idle.iter().enumerate() {
        for m in sorted.near(a.2.position, near).filter(|&m| m > k) {
            if !go_on(a, &idle[m]) {
                return;
            }
        }
    }
    // axes along that of ground are those of what is drawn in its plane
    let z = |m: &Idle| m.2.rotation.column(2);
    let turned = idle.iter().filter(|m| z(m).0[2].abs() < 1.0 - TOUCHING);
    let turned: Vec<&Idle> = turned.collect();
    if turned.len() > MOST_AXES {
        return;
    }
    for (k, a) in turned.iter().enumerate() {
        for b in &turned[k + 1..] {
            let between = a.2.position - b.2.position;
            let is_one_axis =
                z(a).cross(z(b)).norm() < TOUCHING && z(a).cross(between).norm() <= near;
            if is_one_axis && between.norm() > near && !go_on(a, b) {
                return;
            }
        }
    }
}

/// Places in the order of one coordinate, that along which they reach farthest.
struct Sorted<'a> {
    places: &'a [Vec3<f64>],
    axis: usize,
    /// coordinate and index of each
    order: Vec<(f64, usize)>,
}

impl<'a> Sorted<'a> {
    fn of(places: &'a [Vec3<f64>]) -> Self {
        let extent = |axis: usize| {
            let along = places.iter().map(|p| p.0[axis]);
            let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(x), high.max(x))
            });
            high - low
        };
        let axis = (0..3)
            .max_by(|&a, &b| extent(a).total_cmp(&extent(b)))
            .unwrap_or(0);
        let along = places.iter().enumerate().map(|(k, p)| (p.0[axis], k));
        let mut order: Vec<(f64, usize)> = along.collect();
        order.arrange_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        Self {
            places,
            axis,
            order,
        }
    }

    /// The indices of the places that are so near another.
    fn near(&self, place: Vec3<f64>, near: f64) -> impl Iterator<Item = usize> {
        let x = place.0[self.axis];
        let first = self.order.partition_point(|o| o.0 < x - near);
        let along = self.order[first..]
            .iter()
            .take_while(move |o| o.0 <= x + near);
        let all = along.map(|o| o.1);
        all.filter(move |&k| (self.places[k] - place).norm() <= near)
    }
}

/// Returns whether one of ascending values is this.
fn contains<T: Ord>(ascending: &[T], value: &T) -> bool {
    ascending.binary_search(value).is_ok()
}

/// The markers and bodies that elements other than outputs use.
struct Uses {
    /// markers that anything names, ascending
    named: Vec<u32>,
    /// markers that constraints or forces name as their ends, ascending
    ends: Vec<u32>,
    /// markers that constraints name
    joints: Vec<u32>,
    /// pairs of bodies between which something acts, ascending
    tied: Vec<[ElementId; 2]>,
}

impl Uses {
    fn of(model: &Model) -> Self {
        let (mut named, mut ends, mut joints) = (Vec::new(), Vec::new(), Vec::new());
        let mut tied = Vec::new();
        for (id, element) in model.elements() {
            if id.kind.family() == Family::Output && id.kind != ElementKind::Graphics {
                continue;
            }
            let references = element.references();
            let own = references.iter().map(|r| r.1);
            let own = own.filter(|t| t.kind == ElementKind::Marker);
            let first = named.len();
            named.extend(own.map(|t| t.number));
            let formulas = element.formulas();
            let in_functions: Vec<u32> = formulas.iter().flat_map(|f| markers_in(f.1)).collect();
            named.extend(&in_functions);
            if id.kind.family() == Family::Constraint {
                joints.extend(&named[first..]);
            }
            if matches!(id.kind.family(), Family::Constraint | Family::Force) {
                ends.extend(&named[first..]);
                let bodies = bodies_named(model, references, in_functions);
                for (k, &a) in bodies.iter().enumerate() {
                    tied.extend(bodies[k + 1..].iter().map(|&b| [a, b]));
                }
            }
        }
        for markers in [&mut named, &mut ends] {
            markers.sort_unstable();
            markers.dedup();
        }
        tied.sort_unstable();
        tied.dedup();
        Self {
            named,
            ends,
            joints,
            tied,
        }
    }

    /// Pairs of markers on each other, or on the same z axis, that no constraint or force names, of
    /// two bodies that nothing ties to each other, where no joint stands; the marker on ground
    /// second. Two at most: more are no single joint that was forgotten. `chosen`: by whether
    /// nothing at all names the first and the second of a pair.
    fn pairs(&self, model: &Model, chosen: impl Fn(bool, bool) -> bool) -> Vec<(u32, u32)> {
        let idle = model.markers.keys().filter(|m| !contains(&self.ends, m));
        let idle: Vec<Idle> = idle
            .filter_map(|&m| Some((m, model.body_of(m)?, marker_frame(model, m)?)))
            .collect();
        let far = idle
            .iter()
            .fold(0.0, |far: f64, m| far.max(m.2.position.norm()));
        if far == 0.0 {
            return Vec::new();
        }
        let near = TOUCHING * far;
        let place = |&m: &u32| Some(marker_frame(model, m)?.position);
        let places = LazyCell::new(|| -> Vec<_> { self.joints.iter().filter_map(place).collect() });
        let joints = LazyCell::new(|| Sorted::of(&places));
        let moves = |id: ElementId| model.body(id).is_some_and(|b| !b.ground);
        let mut neighbours: BTreeMap<ElementId, usize> = BTreeMap::new();
        for body in self.tied.iter().flatten() {
            *neighbours.entry(*body).or_default() += 1;
        }
        let neighbours = |id: ElementId| neighbours.get(&id).copied().unwrap_or(0);
        let joined = |id: ElementId| !moves(id) || neighbours(id) > 0;
        // what is tied to several others has its place; markers there may be for measuring
        let hangs = |id: ElementId| moves(id) && neighbours(id) == 1;
        let unnamed = |m: u32| !contains(&self.named, &m);
        let is_one = |a: &Idle, b: &Idle| {
            let mut bodies = [a.1, b.1];
            bodies.arrange();
            bodies[0] != bodies[1]
                && chosen(unnamed(a.0), unnamed(b.0))
                && bodies.iter().all(|&b| joined(b))
                && bodies.iter().any(|&b| hangs(b))
                && !contains(&self.tied, &bodies)
                && joints.near(a.2.position, near).next().is_none()
        };
        let mut found = Vec::new();
        meetings(&idle, near, |a, b| {
            if is_one(a, b) {
                found.push(if moves(a.1) { (a.0, b.0) } else { (b.0, a.0) });
            }
            found.len() < 2
        });
        found
    }

    /// The body of a marker.
    fn part_of<'m>(&self, model: &'m Model, marker: u32) -> Option<(ElementId, &'m Part)> {
        let id = model.body_of(marker)?;
        Some((id, model.body(id)?))
    }
}
