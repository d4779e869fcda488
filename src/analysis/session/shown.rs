//! The quantities that columns of results show, their units, and their values at an instant.
//!
//! Forces and torques act on I, about its origin, in ground axes; places are of the origin of a
//! frame in ground. What several columns share (an element's action, the touches of a contact, the
//! energies) is evaluated once for all of them.

use crate::expr::measures::Measure;
use crate::model::{ElementId, ElementKind};
use crate::physics::action::Action;
use crate::physics::kinematic;
use crate::results::Units;
use crate::scalar::{Mask, Scalar};
use crate::scene::equations::Equations;
use crate::scene::{RowKind, Scene};
use crate::space::{MarkerState, Mat3, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// The quantity that a column shows.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum What {
    /// an expression: index among the extra formulas of the scene
    Text(usize),
    /// a component of a part's motion: 0–2 position, 3–5 ψ θ φ, 6–8 velocity, 9–11 angular
    /// velocity, 12–14 acceleration, 15–17 angular acceleration; of the part frame, ground axes
    Part { id: ElementId, quantity: usize },
    /// a component of the motion of a body's centre of mass, ground axes; per level (displacement
    /// from where it began, velocity, acceleration): 0–2 translation, 3 its size, 4–6 rotation, 7
    /// its size
    Body {
        id: ElementId,
        /// marker at the centre of mass; `None`: the origin of the part's frame
        centre: Option<u32>,
        level: usize,
        component: usize,
    },
    /// a component of a REQUEST that a closure computes, from 0
    Request { id: u32, component: usize },
    /// a variable of a joint, angles in degrees
    JointVariable { joint: u32, variable: &'static str },
    /// the angle between axis 0 x, 1 y, 2 z of two markers, in degrees
    BetweenAxes { i: u32, j: u32, axis: usize },
    /// a component of the action of an element on its I marker, ground axes: 0–2 force, 3–5 torque
    Action { id: ElementId, component: usize },
    /// the displacement that a MOTION prescribes, or its first or second derivative
    Prescribed { motion: u32, derivative: usize },
    /// the force or torque of a COUPLER on the displacement of one of its joints
    Transmitted { coupler: u32, term: usize },
    /// the multiplier of the row of a GCON
    Multiplier(u32),
    /// of the touches of a CONTACT: 0–2 place, 3 depth of the deepest, 4 their number
    Touch { contact: u32, component: usize },
    /// the slip that a FRICTION resists, along the axes of the joint's I marker: 0–2 velocity, 3–5
    /// angular velocity
    Slip { friction: u32, component: usize },
    /// 0–2 the place in ground where a PTCV or CVCV touches, 3 and 4 the parameters of its curves
    CurveContact { id: ElementId, component: usize },
    /// of the whole model: see [`ENERGIES`]
    Energy(usize),
}

impl What {
    /// Returns the element without which there is no such quantity; `None`: others exert nothing
    /// where they are switched off.
    pub(super) fn exists_by(&self) -> Option<ElementId> {
        match self {
            What::Prescribed { motion, .. } => Some(ElementKind::Motion.id(*motion)),
            What::CurveContact { id, .. } => Some(*id),
            What::Text(_)
            | What::Part { .. }
            | What::Body { .. }
            | What::Request { .. }
            | What::JointVariable { .. }
            | What::BetweenAxes { .. }
            | What::Action { .. }
            | What::Transmitted { .. }
            | What::Multiplier(_)
            | What::Touch { .. }
            | What::Slip { .. }
            | What::Energy(_) => None,
        }
    }
}

/// Names and units of the energies of a model, and of the powers that change them.
pub(super) const ENERGIES: [(&str, Unit); 5] = [
    ("KINETIC", Unit::Energy),
    ("POTENTIAL", Unit::Energy),
    ("STORING", Unit::Power),
    ("DISSIPATING", Unit::Power),
    ("BY_FUNCTIONS", Unit::Power),
];

/// The unit of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    /// a pure number, or one whose unit only the user knows
    Number,
    /// a length, over time to a power
    Length(u8),
    /// an angle as results have it, over time to a power
    Angle(u8),
    /// an angle that the user reads in degrees
    Degree,
    /// a force
    Force,
    /// a torque
    Torque,
    /// a force times a length
    Energy,
    /// energy per time
    Power,
}

impl Unit {
    /// Returns the unit as result files spell it.
    pub(super) fn spelt(self, u: &Units) -> String {
        let rate = |of: &str, power: u8| match power {
            0 => of.to_owned(),
            1 => format!("{of}/{}", u.time),
            power => format!("{of}/{}**{power}", u.time),
        };
        match self {
            Unit::Number => String::new(),
            Unit::Length(power) => rate(&u.length, power),
            Unit::Angle(power) => rate(&u.angle, power),
            Unit::Degree => "deg".into(),
            Unit::Force => u.force.clone(),
            Unit::Torque | Unit::Energy => format!("{}-{}", u.force, u.length),
            Unit::Power => format!("{}-{}/{}", u.force, u.length, u.time),
        }
    }
}

/// The frame of a body's centre of mass when its run began.
#[derive(Clone, Copy, Debug)]
pub(super) struct Origin {
    place: Vec3<f64>,
    axes: Mat3<f64>,
}

/// Values of columns at an instant, and what several columns share.
pub(super) struct Values<'a, 's, S: Scalar> {
    scene: &'a Scene,
    at: &'a Equations<'s, S>,
    origins: &'a BTreeMap<ElementId, Origin>,
    parts: BTreeMap<ElementId, usize>,
    joint_variables: BTreeMap<(u32, &'static str), usize>,
    /// states of parts, without and with accelerations
    states: BTreeMap<(ElementId, bool), MarkerState<S>>,
    /// motions of centres of mass, by levels
    bodies: BTreeMap<(ElementId, Option<u32>, usize), [S; 8]>,
    actions: BTreeMap<ElementId, Option<Action<S>>>,
    touches: BTreeMap<u32, [S; 5]>,
    energies: Option<[S; 5]>,
}

/// Returns the length of a vector; its derivative is 0 where it vanishes.
fn size<S: Scalar>(v: Vec3<S>) -> S {
    let n2 = v.norm2();
    let zero = n2.le(S::zero());
    S::select(zero, S::zero(), S::select(zero, S::one(), n2).sqrt())
}

/// Returns the vector along the axis of a rotation whose length is its angle, at most π.
fn rotation_vector<S: Scalar>(R: Mat3<S>) -> Vec3<S> {
    let entry = |a: usize, b: usize| R.0[a][b] - R.0[b][a];
    let sine = Vec3([entry(2, 1), entry(0, 2), entry(1, 0)]).times(S::constant(0.5));
    let cosine = (R.0[0][0] + R.0[1][1] + R.0[2][2] - S::one()).scale(0.5);
    let s = size(sine);
    let angle = s.atan2(cosine);
    // where the sine fades before half a turn the symmetric part knows the axis: (1 − cos) n nᵀ
    let fades = cosine.lt(S::constant(-0.9));
    let symmetric = |a: usize, b: usize| {
        let half = (R.0[a][b] + R.0[b][a]).scale(0.5);
        if a == b { half - cosine } else { half }
    };
    let columns = [0, 1, 2].map(|k| Vec3([0, 1, 2].map(|a| symmetric(a, k))));
    let pick = |mask: S::Mask, yes: Vec3<S>, no: Vec3<S>| {
        Vec3([0, 1, 2].map(|k| S::select(mask, yes.0[k], no.0[k])))
    };
    let diagonal = [0, 1, 2].map(|k| columns[k].0[k]);
    let y_over_x = diagonal[0].lt(diagonal[1]);
    let best = pick(y_over_x, columns[1], columns[0]);
    let best_diagonal = S::select(y_over_x, diagonal[1], diagonal[0]);
    let best = pick(best_diagonal.lt(diagonal[2]), columns[2], best);
    let backward = best.dot(sine).lt(S::zero());
    let best = pick(backward, -best, best);
    let length = |v: Vec3<S>| {
        let n = size(v);
        S::select(n.le(S::zero()), S::one(), n)
    };
    let near_half_turn = best.times(angle / length(best));
    let small = s.le(S::constant(1e-8));
    let elsewhere = sine.times(S::select(small, S::one(), angle / length(sine)));
    pick(fades, near_half_turn, elsewhere)
}

impl<'a, 's, S: Scalar> Values<'a, 's, S> {
    /// Prepares the values of a scene's columns at an instant.
    pub(super) fn new(
        scene: &'a Scene,
        at: &'a Equations<'s, S>,
        origins: &'a BTreeMap<ElementId, Origin>,
    ) -> Self {
        let parts = scene.parts.iter().enumerate();
        let variables = scene.joint_variables.iter().enumerate();
        Self {
            scene,
            at,
            origins,
            parts: parts.map(|(k, part)| (part.id, k)).collect(),
            joint_variables: variables.map(|(k, v)| ((v.joint, v.name), k)).collect(),
            states: BTreeMap::new(),
            bodies: BTreeMap::new(),
            actions: BTreeMap::new(),
            touches: BTreeMap::new(),
            energies: None,
        }
    }

    /// Returns the value of a column; NaN where the scene has nothing to show.
    pub(super) fn value(&mut self, what: &What) -> S {
        let at = self.at;
        let nothing = S::constant(f64::NAN);
        match what {
            What::Text(k) => at.formula(self.scene.extra[*k]),
            What::Part { id, quantity } => self.part(*id, *quantity).unwrap_or(nothing),
            What::Body {
                id,
                centre,
                level,
                component,
            } => (self.body(*id, *centre, *level)).map_or(nothing, |all| all[*component]),
            What::Request { id, component } => (self.scene.requests.get(id))
                .map_or(nothing, |formulas| at.formula(formulas[*component])),
            What::JointVariable { joint, variable } => {
                let found = self.joint_variables.get(&(*joint, *variable));
                found.map_or_else(S::zero, |&k| {
                    let gauge = self.scene.joint_variables[k].displacement.gauge;
                    let value = at.joint_variable(k);
                    let is_angle = gauge.is_angle();
                    if is_angle { degrees(value) } else { value }
                })
            }
            What::BetweenAxes { i, j, axis } => self.between_axes(*i, *j, *axis).unwrap_or(nothing),
            What::Action { id, component } => {
                let action = *(self.actions.entry(*id)).or_insert_with(|| at.action_of(*id));
                match action {
                    Some(a) if *component < 3 => a.force.0[*component],
                    Some(a) => a.torque.0[component - 3],
                    None => S::zero(),
                }
            }
            What::Prescribed { motion, derivative } => {
                let found = self.scene.motions.iter().position(|m| m.id == *motion);
                let jet = found.map(|m| at.prescribed(m));
                jet.map_or(nothing, |j| [j.value, j.first, j.second][*derivative])
            }
            What::Transmitted { coupler, term } => self.transmitted(*coupler, *term),
            What::Multiplier(gcon) => {
                let id = ElementKind::Gcon.id(*gcon);
                let row = self.scene.rows.iter().position(|r| r.element == id);
                row.map_or_else(S::zero, |r| at.solved().lambda[r])
            }
            What::Touch { contact, component } => {
                let scene = self.scene;
                let touched = || touched(scene, at, *contact);
                self.touches.entry(*contact).or_insert_with(touched)[*component]
            }
            What::Slip {
                friction,
                component,
            } => self.slip(*friction, *component),
            What::CurveContact { id, component } => {
                let found = self.scene.cams.iter().position(|c| c.id == *id);
                found.map_or(nothing, |c| match component {
                    0..=2 => at.cam_place(c).0[*component],
                    side => at.cam_parameters(c)[side - 3],
                })
            }
            What::Energy(k) => {
                let evaluated = || {
                    let [kinetic, potential] = at.energy();
                    let p = at.powers();
                    [kinetic, potential, -p.stored, -p.dissipated, p.functions]
                };
                self.energies.get_or_insert_with(evaluated)[*k]
            }
        }
    }

    fn part(&mut self, id: ElementId, quantity: usize) -> Option<S> {
        let (at, part, accelerated) = (self.at, *self.parts.get(&id)?, quantity >= 12);
        let state = self.states.entry((id, accelerated));
        let state = *state.or_insert_with(|| at.part(part, accelerated));
        let angle = |m: Measure| {
            let ground = MarkerState::ground();
            kinematic::kinematic(m, &state, &ground, &ground, &ground).unwrap_or_else(S::zero)
        };
        Some(match quantity {
            0..=2 => state.p_GM.0[quantity],
            3 => angle(Measure::Psi),
            4 => angle(Measure::Theta),
            5 => angle(Measure::Phi),
            6..=8 => state.v_GM.0[quantity - 6],
            9..=11 => state.w_GM.0[quantity - 9],
            12..=14 => state.a_GM.0[quantity - 12],
            _ => state.alpha_GM.0[quantity - 15],
        })
    }

    /// Returns the eight components of a body's motion at a level.
    fn body(&mut self, id: ElementId, centre: Option<u32>, level: usize) -> Option<[S; 8]> {
        if let Some(known) = self.bodies.get(&(id, centre, level)) {
            return Some(*known);
        }
        let state = frame_of(self.scene, self.at, &self.parts, id, centre, level == 2)?;
        let (translation, rotation) = match level {
            0 => {
                let origin = self.origins.get(&id)?;
                let turned = state.R_GM * Mat3::constant(origin.axes).transpose();
                let moved = state.p_GM - Vec3::constant(origin.place);
                (moved, rotation_vector(turned))
            }
            1 => (state.v_GM, state.w_GM),
            _ => (state.a_GM, state.alpha_GM),
        };
        let ([x, y, z], [rx, ry, rz]) = (translation.0, rotation.0);
        let all = [x, y, z, size(translation), rx, ry, rz, size(rotation)];
        self.bodies.insert((id, centre, level), all);
        Some(all)
    }

    fn slip(&self, friction: u32, component: usize) -> S {
        let id = ElementKind::Friction.id(friction);
        let found = self.scene.forces.iter().find(|force| force.id == id);
        let slip = found.and_then(|f| Some((f.slip(self.at)?, self.at.marker(f.i).R_GM)));
        slip.map_or_else(S::zero, |(slip, axes)| {
            let vector = if component < 3 {
                slip.velocity
            } else {
                slip.spin
            };
            axes.column(component % 3).dot(vector)
        })
    }

    fn between_axes(&self, i: u32, j: u32, axis: usize) -> Option<S> {
        let axis_of = |marker: u32| {
            let marker = *self.scene.marker_of.get(&marker)?;
            Some(self.at.marker(marker).R_GM.column(axis))
        };
        let (a, b) = (axis_of(i)?, axis_of(j)?);
        Some(degrees(size(a.cross(b)).atan2(a.dot(b))))
    }

    fn transmitted(&self, coupler: u32, term: usize) -> S {
        let id = ElementKind::Coupler.id(coupler);
        let mut rows = self.scene.rows.iter().enumerate();
        let found = rows.find_map(|(r, row)| match &row.kind {
            RowKind::Displacements(sum) if row.element == id => {
                let factor = sum.terms.get(term)?.0;
                Some((
                    r,
                    match &sum.coupled {
                        Some(coupled) => self.at.coupled_slope(coupled, term),
                        None => S::constant(factor),
                    },
                ))
            }
            _ => None,
        });
        found.map_or_else(S::zero, |(r, factor)| self.at.solved().lambda[r] * factor)
    }
}

fn degrees<S: Scalar>(radians: S) -> S {
    radians.scale(180.0 / PI)
}

/// Returns the state of a body's centre of mass, with accelerations when asked for.
fn frame_of<S: Scalar>(
    scene: &Scene,
    at: &Equations<'_, S>,
    parts: &BTreeMap<ElementId, usize>,
    id: ElementId,
    centre: Option<u32>,
    accelerated: bool,
) -> Option<MarkerState<S>> {
    let part = at.part(*parts.get(&id)?, accelerated);
    let Some(&marker) = centre.and_then(|marker| scene.marker_of.get(&marker)) else {
        return Some(part);
    };
    // the axes of the marker stay at an angle to those of the part
    Some(match accelerated {
        true => at.accelerated_marker(marker),
        false => at.marker(marker),
    })
}

/// Returns where bodies are when a run begins.
pub(super) fn origins(
    scene: &Scene,
    at: &Equations<'_, f64>,
    bodies: impl Iterator<Item = (ElementId, Option<u32>)>,
) -> BTreeMap<ElementId, Origin> {
    let parts: BTreeMap<_, _> = (scene.parts.iter().enumerate())
        .map(|(k, part)| (part.id, k))
        .collect();
    let origin = |(id, centre): (ElementId, Option<u32>)| {
        let state = frame_of(scene, at, &parts, id, centre, false)?;
        let (place, axes) = (state.p_GM, state.R_GM);
        Some((id, Origin { place, axes }))
    };
    bodies.filter_map(origin).collect()
}

/// Returns where the solids of a CONTACT touch (the mean of the touches by their depths), how deep
/// the deepest touch is, and how many there are; zeros where nothing touches.
fn touched<S: Scalar>(scene: &Scene, at: &Equations<'_, S>, contact: u32) -> [S; 5] {
    let id = ElementKind::Contact.id(contact);
    let zero = S::zero();
    let (mut weighted, mut weights) = (Vec3::zero(), zero);
    let (mut deepest, mut count) = (zero, zero);
    for force in scene.forces.iter().filter(|f| f.id == id) {
        for touch in force.touches(at) {
            let is_there = zero.lt(touch.depth).and(zero.lt(touch.share));
            let depth = S::select(is_there, touch.depth, zero);
            let weight = depth * touch.share;
            weighted += touch.point.times(weight);
            weights += weight;
            deepest = deepest.max(depth);
            count += S::select(is_there, S::one(), zero);
        }
    }
    let apart = weights.le(zero);
    let over = S::select(apart, zero, S::select(apart, S::one(), weights).recip());
    let [x, y, z] = weighted.times(over).0;
    [x, y, z, deepest, count]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::rotation;

    #[test]
    fn the_rotation_vector_gives_back_axis_and_angle_up_to_half_a_turn() {
        let axes = [[0.0, 0.0, 1.0], [0.6, 0.0, -0.8], [0.48, 0.64, 0.6]];
        for axis in axes.map(Vec3) {
            for angle in [0.0, 1e-10, 1e-3, 1.0, 2.5, 3.0, PI - 1e-9, PI] {
                let (s, c) = f64::sin_cos(angle / 2.0);
                let q = [c, s * axis.0[0], s * axis.0[1], s * axis.0[2]];
                let v = rotation_vector(rotation::from_quaternion(q));
                assert!((v.norm() - angle).abs() < 1e-12, "{angle}: {v:?}");
                let along = v.dot(axis);
                // half a turn one way is half a turn the other way
                let along = if angle > PI - 1e-6 {
                    along.abs()
                } else {
                    along
                };
                assert!((along - angle).abs() < 1e-7, "{axis:?} {angle}: {v:?}");
            }
        }
    }
}
