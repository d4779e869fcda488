//! The state that one simulation leaves to the next, and the model moved to it.

use super::Session;
use crate::analysis::system::{System, past, samples};
use crate::analysis::trajectory::Left;
use crate::expr::measures::Measure;
use crate::model::geometry::orientation;
use crate::model::{ElementId, ElementKind, Model, Orientation, Part};
use crate::physics::kinematic::kinematic;
use crate::scene::Scene;
use crate::scene::equations::Equations;
use crate::scene::history::{AngleId, DelayId};
use crate::scene::layout::{Layout, State};
use crate::scene::loops::Key;
use crate::scene::unknown::{CoordinateId, UnknownId};
use crate::space::{MarkerState, Vec3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// State carried from one simulation to the next, by the identities of the unknowns.
#[derive(Clone, Debug)]
pub(super) struct Carried {
    /// time
    pub(super) t: f64,
    /// numbers of the last row
    pub(super) numbers: Vec<f64>,
    /// identities of the unknowns among them, in their order
    pub(super) unknowns: Vec<UnknownId>,
    /// whether it came to rest: velocities are those of the dataset again, not zero
    pub(super) at_rest: bool,
    /// place and motion of every part (point masses: true), for when the unknowns are others
    pub(super) parts: Vec<(ElementId, MarkerState<f64>)>,
    /// value and rate of every coordinate of the forest but those of balls
    pub(super) coordinates: BTreeMap<CoordinateId, [f64; 2]>,
    /// angles with the turns that they have counted   [rad]
    pub(super) turns: BTreeMap<AngleId, f64>,
    /// values of EVALUATE of sensors, by their numbers
    pub(super) sensors: BTreeMap<u32, f64>,
    /// sensors that held when last looked at, by their numbers, and the values that they saw
    pub(super) held: BTreeMap<u32, f64>,
    /// states of sampled systems, by the numbers of their GSE
    pub(super) samples: BTreeMap<u32, samples::Held>,
    /// the past of delayed values
    pub(super) past: BTreeMap<DelayId, past::Past>,
    /// values of VARIABLEs that read themselves, by their numbers: where Newton's iteration begins
    pub(super) guesses: BTreeMap<u32, f64>,
    /// what the method leaves that led here, and the model of its system without the constants that
    /// are external inputs
    pub(super) left: Option<(Arc<Model>, Left)>,
}

impl Carried {
    /// Returns the values of the unknowns.
    pub(super) fn values(&self) -> BTreeMap<UnknownId, f64> {
        let numbers = self.numbers.iter().skip(Layout::STATE).copied();
        self.unknowns.iter().copied().zip(numbers).collect()
    }
}

/// A state by the elements that it is of.
pub(super) struct ByElement {
    unknowns: BTreeMap<ElementId, Vec<(UnknownId, f64)>>,
    parts: BTreeMap<ElementId, MarkerState<f64>>,
    /// all that belongs to no such element
    rest: Carried,
}

impl ByElement {
    pub(super) fn new(mut carried: Carried) -> Self {
        let mut unknowns: BTreeMap<ElementId, Vec<(UnknownId, f64)>> = BTreeMap::new();
        for (id, value) in carried.values() {
            unknowns.entry(id.element()).or_default().push((id, value));
        }
        carried.unknowns.clear();
        carried.numbers.truncate(Layout::STATE);
        carried.coordinates.clear();
        let parts = std::mem::take(&mut carried.parts).into_iter().collect();
        let rest = carried;
        Self {
            unknowns,
            parts,
            rest,
        }
    }

    /// Returns the state of the elements of a model.
    pub(super) fn of(&self, model: &Model) -> Carried {
        let mut carried = self.rest.clone();
        for (id, _) in model.elements() {
            for &(unknown, value) in self.unknowns.get(&id).into_iter().flatten() {
                carried.unknowns.push(unknown);
                carried.numbers.push(value);
            }
            let part = self.parts.get(&id).map(|state| (id, *state));
            carried.parts.extend(part);
        }
        carried
    }
}

impl Session {
    /// Keeps the state of a system for the next simulation.
    pub(super) fn keep(&mut self, system: &System, numbers: Vec<f64>) {
        self.carried = Some(Carried::of(system, numbers));
    }
}

impl Carried {
    /// Takes the state of a system, of which all numbers are given.
    pub(super) fn of(system: &System, numbers: Vec<f64>) -> Self {
        let at = Equations::new(system.configured(), &numbers);
        let parts = system.scene.parts.iter().enumerate();
        let parts = parts.map(|(k, p)| (p.id, at.part(k, false))).collect();
        let coordinates = system.scene.coordinates.iter().enumerate();
        let coordinates = coordinates
            .filter(|(_, c)| c.initial.is_some())
            .map(|(k, c)| {
                let jet = at.coordinate(k);
                (c.id, [jet.value, jet.first])
            });
        let coordinates = coordinates.collect();
        let counted = system.scene.counted.iter();
        let turns = counted.map(|c| (c.id, at.counted(c.id))).collect();
        let unknowns = &system.scene.unknowns;
        Carried {
            t: numbers[Layout::TIME],
            coordinates,
            turns,
            sensors: sensed(&system.scene, &numbers),
            held: system.held_sensors(),
            samples: system.recorded.samples.held(&numbers),
            past: system.recorded.external.delays.past(),
            guesses: guesses(&system.scene, &numbers),
            unknowns: [&unknowns.q[..], &unknowns.v, &unknowns.x].concat(),
            at_rest: false,
            left: None,
            parts,
            numbers,
        }
    }
}

/// Returns the values of VARIABLEs that have places among the unknowns of loops.
fn guesses(scene: &Scene, numbers: &[f64]) -> BTreeMap<u32, f64> {
    let loops = scene.loops.iter().zip(&numbers[scene.layout.loops()]);
    let known: BTreeMap<Key, f64> = loops.map(|(u, &value)| (u.key, value)).collect();
    let value = |formula: &usize| known.get(&Key::Formula(*formula)).copied();
    let variables = scene.variables.iter();
    variables
        .filter_map(|(&id, formula)| Some((id, value(formula)?)))
        .collect()
}

/// Returns SENVAL of each sensor.
fn sensed(scene: &Scene, numbers: &[f64]) -> BTreeMap<u32, f64> {
    let l = scene.layout;
    let all = scene.external_inputs.iter().enumerate();
    all.filter_map(|(place, s)| Some((scene.sensor_of(*s)?, numbers[l.external_at(place)])))
        .collect()
}

/// Returns whether a scene has positions or velocities among its unknowns that the last state does
/// not tell.
pub(super) fn has_new_unknowns(scene: &Scene, carried: &Carried) -> bool {
    let known = carried.values();
    let State { q, v, .. } = &scene.unknowns;
    q.iter()
        .chain(v)
        .any(|unknown| !known.contains_key(unknown))
}

/// Returns the model with its parts where they are, and moving as they do.
pub(super) fn moved(model: &Model, carried: &Carried) -> Model {
    let mut model = placed(model, &carried.parts);
    for joint in model.joints.values_mut() {
        (joint.ic_translation, joint.ic_rotation) = ([None; 2], [None; 2]);
    }
    model.beginnings.clear();
    for (id, state) in &carried.parts {
        let Some(part) = part_of(&mut model, *id) else {
            continue;
        };
        // the dataset tells the velocity of CM along ground axes, the angular velocity along its
        // own
        let (cm, w_part) = (part.cm, state.R_GM.apply_transposed(state.w_GM));
        let cm = cm.and_then(|cm| model.markers.get(&cm));
        let cm_place = cm.map_or(Vec3::zero(), |cm| Vec3(cm.qp));
        let cm_axes = cm.and_then(|cm| orientation(&cm.orientation, cm.qp).ok());
        let v_cm = state.v_GM + state.w_GM.cross(state.R_GM.apply(cm_place));
        let w_cm = cm_axes.map_or(w_part, |axes| axes.apply_transposed(w_part));
        if let Some(part) = part_of(&mut model, *id) {
            (part.vm, part.wm) = (None, None);
            (part.velocity, part.angular_velocity) = (v_cm.0.map(Some), w_cm.0.map(Some));
        }
    }
    model
}

/// Returns the model with its parts at the given places.
pub(super) fn placed(model: &Model, parts: &[(ElementId, MarkerState<f64>)]) -> Model {
    let mut model = model.clone();
    let ground = MarkerState::ground();
    for (id, state) in parts {
        let angle = |m| kinematic(m, state, &ground, &ground, &ground).unwrap_or(0.0);
        if let Some(part) = part_of(&mut model, *id) {
            part.qg = state.p_GM.0;
            part.orientation =
                Orientation::Euler([Measure::Psi, Measure::Theta, Measure::Phi].map(angle));
        }
    }
    model
}

/// Returns the part or point mass of a number.
fn part_of(model: &mut Model, id: ElementId) -> Option<&mut Part> {
    let parts = if id.kind == ElementKind::PointMass {
        &mut model.point_masses
    } else {
        &mut model.parts
    };
    parts.get_mut(&id.number)
}
