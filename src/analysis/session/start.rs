//! What a simulation starts from: the model compiled as it is now, and the state that the last one left or that is assembled.

use super::shells;
use super::{DYNAMIC, INITIAL_CONDITIONS, KINEMATIC, LINEAR, STATIC, Session};
use crate::analysis::start::assemble::{self, Assembly};
use crate::analysis::start::{coincident, initial_conditions, misalignment, placement};
use crate::analysis::system::{System, complaints};
use crate::analysis::system::{external_inputs, samples};
use crate::diagnostic::Diagnostic;
use crate::expr::measures::Measure;
use crate::model::{ElementId, ElementKind, Formula, Model, Orientation, Place};
use crate::physics::kinematic::kinematic;
use crate::scene::Scene;
use crate::scene::build::{self, unknown_names};
use crate::scene::compile::orientation;
use crate::scene::configuration::{Configuration, Configured};
use crate::scene::contacts::Shell;
use crate::scene::equations::Equations;
use crate::scene::external_inputs::ExternalInput;
use crate::scene::layout::Layout;
use crate::space::{MarkerState, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// State carried from one simulation to the next, by the names of the unknowns.
#[derive(Clone, Debug)]
pub(super) struct Carried {
    pub(super) t: f64,
    /// numbers of the last row
    pub(super) numbers: Vec<f64>,
    pub(super) names: Vec<String>,
    /// it came to rest: velocities are those of the dataset again, not zero
    pub(super) at_rest: bool,
    /// place and motion of every part (point masses: true), for when the unknowns are others
    pub(super) parts: Vec<(ElementId, MarkerState<f64>)>,
    /// turns that angles have counted
    pub(super) turns: Vec<f64>,
    /// what sensors evaluated last, by their numbers
    pub(super) sensors: BTreeMap<u32, f64>,
    /// where sampled systems stand, by the numbers of their GSE
    pub(super) samples: BTreeMap<u32, samples::Held>,
    /// what was before
    pub(super) past: Vec<external_inputs::Past>,
}

/// A system that has done its simulation, and the model it was made of.
#[derive(Debug)]
pub(super) struct Kept {
    model: Model,
    mode: u32,
    system: System,
    assembly: Assembly,
}

impl Kept {
    pub(super) fn new(model: &Model, mode: u32, system: System, assembly: Assembly) -> Self {
        let model = without_constants(model, &system.scene);
        Self {
            model,
            mode,
            system,
            assembly,
        }
    }
}

/// A model without the numbers that its scene is supplied with.
fn without_constants(model: &Model, scene: &Scene) -> Model {
    let mut model = model.clone();
    for what in &scene.external_inputs {
        if let ExternalInput::Constant(id) = what
            && let Some(variable) = model.variables.get_mut(id)
            && variable.function.constant().is_some()
        {
            (variable.function, variable.place) = (Formula::default(), Place::default());
        }
    }
    model
}

impl Session {
    /// The system of the simulation before, at the state that it left, where nothing is different but constants that commands change. No constraint
    /// reads these: it still holds.
    fn again(&mut self, mode: u32, inputs: &[u32]) -> Option<(System, Assembly)> {
        let kept = *self.kept.take()?;
        let carried = self.carried.as_ref()?;
        let mut system = kept.system;
        let same = kept.mode == mode
            && inputs.is_empty()
            && self.hooks.is_empty()
            && system.scene.samplers.is_empty()
            && !carried.at_rest
            && carried.numbers.len() == system.numbers.len()
            && without_constants(&self.model, &system.scene) == kept.model;
        if !same {
            return None;
        }
        system.numbers.copy_from_slice(&carried.numbers);
        self.set_constants(&system.scene, &mut system.numbers);
        system.external.begin(carried.t, &carried.past);
        system.resolve().ok()?;
        system.begin_sensing();
        Some((system, kept.assembly))
    }

    /// Compiles the model for a MODE, with VARIABLEs that are inputs, and brings it into its state.
    pub(super) fn prepare(
        &mut self,
        mode: u32,
        inputs: &[u32],
    ) -> Result<(System, Assembly), Vec<Diagnostic>> {
        if let Some(again) = self.again(mode, inputs) {
            return Ok(again);
        }
        (self.columns_program, self.account) = (None, None);
        let mut options = build::Options {
            mode,
            extra: self.columns.extra.clone(),
            variables: self.options.full,
            skip: self.options.skip.clone(),
            hooks: self
                .hooks
                .iter()
                .map(external_inputs::Hook::as_name)
                .collect(),
            zero_user: self.options.zero_user,
            plant_inputs: inputs.to_vec(),
            changing: self.changing.clone(),
            shells: self.shells(),
            ..build::Options::default()
        };
        let compiled = match Scene::compile(&self.model, &options) {
            // a motion may read a number, but nothing from outside
            Err(_) if !options.changing.is_empty() => {
                options.changing.clear();
                Scene::compile(&self.model, &options)?
            }
            outcome => outcome?,
        };
        // Commands may have changed what carries a part: then its place is no unknown of before, and is told by the part.
        let moved = (self.carried.as_ref())
            .filter(|carried| has_new_unknowns(&compiled, carried))
            .map(|carried| moved(&self.model, carried));
        let scene = match &moved {
            Some(moved) => Scene::compile(moved, &options)?,
            None => compiled,
        };
        let mut configuration = Configuration::new(&scene);
        let first = self.carried.is_none();
        let joints = mode == DYNAMIC || mode == INITIAL_CONDITIONS;
        let exchanged = if first && joints {
            self.exchange(&scene)
        } else {
            Vec::new()
        };
        let l = scene.layout;
        let t = self.time();
        let names = unknown_names(&scene);
        let mut x = vec![0.0; l.n_x];
        for d in &scene.differentials {
            if let Some(state) = d.state {
                x[state] = d.initial[0];
            }
        }
        let mut q = scene.initial_q.clone();
        let mut v = None;
        if let Some(carried) = &self.carried {
            let values: BTreeMap<&str, f64> = carried
                .names
                .iter()
                .map(String::as_str)
                .zip(carried.numbers.iter().skip(Layout::STATE).copied())
                .collect();
            let mut speeds = vec![0.0; l.n_v];
            let names = l.state(&names);
            // every position and velocity is told; states may be new
            let mut complete = take_over(&values, names.q, &mut q);
            complete &= take_over(&values, names.v, &mut speeds);
            take_over(&values, names.x, &mut x);
            for (cam, contact) in scene.cams.iter().zip(&mut configuration.contacts) {
                let name = &names.x[cam.state];
                contact.begun = values.contains_key(name.as_str());
            }
            if complete && !carried.at_rest {
                v = Some(speeds);
            }
            if carried.turns.len() == l.n_turns {
                configuration.turns.copy_from_slice(&carried.turns);
            }
        } else {
            if mode != KINEMATIC && mode != STATIC {
                placement::initial_joints(&scene, &self.model, &mut q);
            }
            for (m, motion) in scene.motions.iter().enumerate() {
                self.initial_motion(&scene, m, motion.state, &q, &mut x);
            }
        }
        configuration.external = self.external(scene.within(&configuration), t, &q, &x)?;
        let misaligned = if first {
            misalignment::misaligned(&scene, &self.model)
        } else {
            Vec::new()
        };
        let undecided = scene.within(&configuration);
        let placed = first && placement::settle(undecided, &self.model, t, &mut q, &x, joints);
        // only what moves by itself has initial conditions
        let wishes = if first && mode != KINEMATIC && mode != STATIC {
            initial_conditions::collect(&scene, &self.model)
        } else {
            Vec::new()
        };
        // where parts are too many to be weighed, or on curves, coordinates move as little as may be
        let starts = if first && !(placed && joints) {
            initial_conditions::approach(&scene, &mut configuration, &wishes, t, &mut q, &x)
        } else {
            Vec::new()
        };
        let mut assembly = assemble::positions(&scene, &mut configuration, t, &mut q, &x)?;
        let here = scene.within(&configuration);
        let unmet = initial_conditions::unmet(here, &wishes, &starts, t, &q, &x);
        assembly.warnings.extend(unmet);
        assembly.warnings.splice(0..0, misaligned);
        assembly.warnings.extend(exchanged);
        if first {
            let numbers = assemble::numbers(here, t, &q, &vec![0.0; l.n_v], &x);
            let turned = misalignment::turned(here, &self.model, &numbers);
            assembly.warnings.extend(turned);
            assembly.warnings.extend(coincident::lines(here, &numbers)?);
        }
        configuration.begin_states(&scene, &mut x);
        let v = match v {
            _ if mode == STATIC || mode == LINEAR && self.is_at_rest() => vec![0.0; l.n_v],
            Some(v) => v,
            None => {
                let at_rest = self.carried.as_ref().is_some_and(|c| c.at_rest);
                let given = moved.as_ref().filter(|_| !at_rest).unwrap_or(&self.model);
                assemble::velocities(scene.within(&configuration), given, t, &q, &x)?
            }
        };
        let turns = configuration.turns.clone();
        let mut system = System::with_hooks(scene, configuration, &self.hooks)?;
        let past = self.carried.as_ref().map_or(&[][..], |c| &c.past);
        system.external.begin(t, past);
        let mut y = q;
        y.extend(v);
        y.extend(x);
        system.numbers[l.turns()].copy_from_slice(&turns);
        system.numbers[Layout::TIME] = t;
        system.numbers[l.y()].copy_from_slice(&y);
        if let Err(k) = system.resolve() {
            let name = system.scene.loops[k].name.clone();
            return Err(vec![
                Diagnostic::error("loop", "it depends on itself, and no value solves that")
                    .element(name)
                    .help("give an IC near the solution, where it has one"),
            ]);
        }
        let row = system.row(t, &y);
        system.numbers.copy_from_slice(&row);
        let y = row[l.y()].to_vec();
        system.count_turns(t, &y);
        let none = BTreeMap::new();
        let held = self.carried.as_ref().map_or(&none, |c| &c.samples);
        system.begin_sampling(held).map_err(|d| vec![d])?;
        if mode != STATIC {
            system.begin_sensing();
        }
        Ok((system, assembly))
    }

    /// Exchanges the numbers of initial conditions that are to be read the other way round; what is told of these and of doubtful ones.
    fn exchange(&mut self, scene: &Scene) -> Vec<String> {
        let found = misalignment::exchanged(scene, &self.model);
        for e in found.iter().filter(|e| e.believed) {
            if let Some(joint) = self.model.joints.get_mut(&e.joint) {
                let given = if e.turns {
                    &mut joint.ic_rotation
                } else {
                    &mut joint.ic_translation
                };
                given.reverse();
            }
        }
        found.into_iter().map(|e| e.told).collect()
    }

    /// The shells of contacts, read when they are first asked for.
    fn shells(&mut self) -> Arc<BTreeMap<u32, Result<Shell, String>>> {
        let load = || Arc::new(shells::load(&self.model, &self.folders));
        self.shells.get_or_insert_with(load).clone()
    }

    /// Numbers from outside where assembly begins: what sensors evaluated before, and what closures say of the configuration.
    pub(super) fn external(
        &self,
        scene: Configured<'_>,
        t: f64,
        q: &[f64],
        x: &[f64],
    ) -> Result<Vec<f64>, Vec<Diagnostic>> {
        let l = scene.layout;
        let mut numbers = vec![0.0; l.len()];
        let carried = self.carried.as_ref();
        let none = BTreeMap::new();
        let held = carried.map_or(&none, |c| &c.samples);
        for (place, input) in scene.external_inputs.iter().enumerate() {
            let sensor = scene.sensor_of(*input);
            let seen = sensor.and_then(|id| carried?.sensors.get(&id).copied());
            let value = seen.or_else(|| samples::before(&scene, *input, held));
            numbers[l.external_at(place)] = value.unwrap_or(0.0);
        }
        self.set_constants(&scene, &mut numbers);
        if !scene.hooks.is_empty() {
            numbers[Layout::TIME] = t;
            numbers[l.q()].copy_from_slice(q);
            numbers[l.x()].copy_from_slice(x);
            numbers[l.turns()].copy_from_slice(&scene.configuration.turns);
            let mut outside =
                external_inputs::ExternalInputs::new(scene, &self.hooks).map_err(complaints)?;
            outside.evaluate(&mut numbers, true);
        }
        Ok(numbers[l.external()].to_vec())
    }

    /// Puts the constants that commands change into their places.
    fn set_constants(&self, scene: &Scene, numbers: &mut [f64]) {
        for (place, what) in scene.layout.external().zip(&scene.external_inputs) {
            if let ExternalInput::Constant(id) = what {
                let variable = self.model.variables.get(id);
                let value = variable.and_then(|v| v.function.constant());
                numbers[place] = value.unwrap_or(f64::NAN);
            }
        }
    }

    pub(super) fn is_at_rest(&self) -> bool {
        self.carried.as_ref().is_some_and(|c| c.at_rest)
    }

    /// Start of motions given by their rate: ICDISP and ICVEL, else what the dataset's configuration and the joint's IC show; rows begin
    /// where the assembled configuration is.
    pub(super) fn initial_motion(
        &self,
        scene: &Scene,
        m: usize,
        state: Option<usize>,
        _q: &[f64],
        x: &mut [f64],
    ) {
        let Some(state) = state else { return };
        let motion = &scene.motions[m];
        let Some(data) = self.model.motions.get(&motion.id) else {
            return;
        };
        let begins_there = scene.initial_displacement(m);
        x[state] = data.ic_displacement.or(begins_there).unwrap_or(0.0);
        if motion.level == crate::model::Level::Acceleration {
            let rate = scene.motions[m].coordinate.and_then(|c| {
                let coordinate = &scene.coordinates[c];
                let joint = self.model.joints.get(&coordinate.joint?)?;
                if coordinate.angular {
                    joint.ic_rotation[1]
                } else {
                    joint.ic_translation[1]
                }
            });
            x[state + 1] = data.ic_velocity.or(rate).unwrap_or(0.0);
        }
    }

    pub(super) fn keep(&mut self, system: &System, numbers: Vec<f64>) {
        let at = Equations::new(system.configured(), &numbers);
        let parts = system.scene.parts.iter().enumerate();
        let parts = parts.map(|(k, p)| (p.id, at.part(k, false))).collect();
        self.carried = Some(Carried {
            t: numbers[Layout::TIME],
            turns: numbers[system.scene.layout.turns()].to_vec(),
            sensors: sensed(&system.scene, &numbers),
            samples: system.samples.held(&numbers),
            past: system.external.past(),
            names: unknown_names(&system.scene),
            at_rest: false,
            parts,
            numbers,
        });
    }
}

/// Takes over the values that are known by these names; returns whether all are.
fn take_over(known: &BTreeMap<&str, f64>, names: &[String], values: &mut [f64]) -> bool {
    let mut complete = true;
    for (name, value) in names.iter().zip(values) {
        match known.get(name.as_str()) {
            Some(&found) => *value = found,
            None => complete = false,
        }
    }
    complete
}

/// What SENVAL yields of each sensor.
fn sensed(scene: &Scene, numbers: &[f64]) -> BTreeMap<u32, f64> {
    let l = scene.layout;
    let all = scene.external_inputs.iter().enumerate();
    all.filter_map(|(place, s)| Some((scene.sensor_of(*s)?, numbers[l.external_at(place)])))
        .collect()
}

/// Whether a scene has positions or velocities among its unknowns that the last state does not tell by name.
pub(super) fn has_new_unknowns(scene: &Scene, carried: &Carried) -> bool {
    let known: BTreeSet<&str> = carried.names.iter().map(String::as_str).collect();
    let l = scene.layout;
    let names = unknown_names(scene);
    let state = l.state(&names);
    (state.q.iter().chain(state.v)).any(|name| !known.contains(name.as_str()))
}

/// The model with its parts where they are, and moving as they do.
pub(super) fn moved(model: &Model, carried: &Carried) -> Model {
    let mut model = model.clone();
    for joint in model.joints.values_mut() {
        (joint.ic_translation, joint.ic_rotation) = ([None; 2], [None; 2]);
    }
    let ground = MarkerState::ground();
    for (id, state) in &carried.parts {
        let angle = |m| kinematic(m, state, &ground, &ground, &ground).unwrap_or(0.0);
        let parts = if id.kind == ElementKind::PointMass {
            &mut model.point_masses
        } else {
            &mut model.parts
        };
        let Some(part) = parts.get_mut(&id.number) else {
            continue;
        };
        part.qg = state.p_GM.0;
        part.orientation =
            Orientation::Euler([Measure::Psi, Measure::Theta, Measure::Phi].map(angle));
        let cm = part.cm.and_then(|cm| model.markers.get(&cm));
        let cm_place = cm.map_or(Vec3::zero(), |cm| Vec3(cm.qp));
        let cm_axes = cm.and_then(|cm| orientation(&cm.orientation, cm.qp).ok());
        // The dataset tells the velocity of CM along ground axes, the angular velocity along those of CM.
        let v_cm = state.v_GM + state.w_GM.cross(state.R_GM.apply(cm_place));
        let w_part = state.R_GM.apply_transposed(state.w_GM);
        let w_cm = cm_axes.map_or(w_part, |axes| axes.apply_transposed(w_part));
        (part.vm, part.wm) = (None, None);
        (part.velocity, part.angular_velocity) = (v_cm.0.map(Some), w_cm.0.map(Some));
    }
    model
}
