//! Velocities from which motions given by their acceleration begin, where no ICVEL says them: those
//! of the mechanism without these motions.

use super::Session;
use super::carried::{Carried, moved, placed};
use super::state_at_start::Start;
use crate::analysis::look::Look;
use crate::analysis::start::velocities::{self, moving};
use crate::analysis::start::{assemble, initial_conditions};
use crate::diagnostic::Diagnostic;
use crate::model::{Driven, ElementKind, Joint, Level, Model};
use crate::physics::joint::Displacements;
use crate::physics::row::{Drive, Law, body_angles};
use crate::scalar::{Jet, Scalar};
use crate::scene::equations::Equations;
use crate::scene::{Scene, build};
use crate::space::{Frame, MarkerState};

/// A motion whose velocity at the start nobody gives.
struct Waiting {
    /// its number in the scene
    motion: usize,
    /// place in x of its velocity
    place: usize,
    law: Law,
    /// markers I and J
    markers: (u32, u32),
}

impl Session {
    /// Lets motions given by their acceleration, without ICVEL, begin with the velocity that the
    /// mechanism would have without them.
    ///
    /// # Errors
    /// Velocities that contradict each other without these motions, and what `look` answers.
    pub(super) fn begin_rates(
        &self,
        start: &mut Start,
        look: Look<'_>,
    ) -> Result<(), Vec<Diagnostic>> {
        let waiting = self.waiting(&start.scene, self.carried.as_ref());
        if waiting.is_empty() {
            return Ok(());
        }
        let mut free = match self.carried.as_ref().filter(|carried| !carried.at_rest) {
            Some(carried) => moved(&self.model, carried),
            None => self.model_at(start),
        };
        for w in &waiting {
            let id = start.scene.motions[w.motion].id;
            free.inactive.insert(ElementKind::Motion.id(id));
        }
        let Some((there, v)) = self.moving_start(&free, start, look)? else {
            return Ok(());
        };
        let (here, q, x) = (there.here(), &there.q, &there.x);
        let numbers = assemble::numbers(here, there.t, q, &v, x);
        let at = Equations::new(here, &numbers);
        for w in waiting {
            let place = |m: u32| there.scene.marker_of.get(&m).copied();
            let (Some(i), Some(j)) = (place(w.markers.0), place(w.markers.1)) else {
                continue;
            };
            let reference = start.configuration.motions[w.motion].reference;
            start.x[w.place] = rate(w.law, reference, &at.marker(i), &at.marker(j));
        }
        Ok(())
    }

    /// Returns the motions of a scene whose velocity at the start nobody gives, neither ICVEL nor
    /// the IC of their joint nor the simulation before.
    fn waiting(&self, scene: &Scene, carried: Option<&Carried>) -> Vec<Waiting> {
        let goes_on = |place: usize| {
            let unknown = &scene.unknowns.x[place];
            carried.is_some_and(|c| c.unknowns.contains(unknown))
        };
        let mut found = Vec::new();
        for (motion, m) in scene.motions.iter().enumerate() {
            let (Level::Acceleration, Some(state)) = (m.level, m.state) else {
                continue;
            };
            let Some(data) = self.model.motions.get(&m.id) else {
                continue;
            };
            let place = state + 1;
            if data.ic_velocity.is_some() || goes_on(place) {
                continue;
            }
            let driven = self.driven_law(data.driven);
            found.extend(driven.map(|(law, markers)| Waiting {
                motion,
                place,
                law,
                markers,
            }));
        }
        found
    }

    /// Returns how a motion's displacement is read off its markers; `None`: the IC of its joint
    /// says its velocity, or there is no such joint.
    fn driven_law(&self, driven: Driven) -> Option<(Law, (u32, u32))> {
        let of_joint = |joint: &Joint, turns: bool| {
            let condition = if turns {
                joint.ic_rotation
            } else {
                joint.ic_translation
            };
            let law = if turns { Law::Angle } else { Law::Along(2) };
            (condition[1].is_none()).then_some((law, (joint.i, joint.j)))
        };
        let joint = |id: u32| self.model.joints.get(&id);
        match driven {
            Driven::JointTranslation(id) => of_joint(joint(id)?, false),
            Driven::JointRotation(id) => of_joint(joint(id)?, true),
            Driven::Joint(id) => {
                let joint = joint(id)?;
                let turns = joint.kind.displacements() == Displacements::Rotation;
                of_joint(joint, turns)
            }
            Driven::Markers { i, j, component } => {
                let law = match component {
                    0..=2 => Law::Along(component),
                    _ => Law::BodyAngle {
                        angle: component - 3,
                        beside: None,
                    },
                };
                Some((law, (i, j)))
            }
        }
    }

    /// Returns the model with its parts where a start has them.
    fn model_at(&self, start: &Start) -> Model {
        let here = start.here();
        let still = vec![0.0; here.layout.n_v];
        let numbers = assemble::numbers(here, start.t, &start.q, &still, &start.x);
        let at = Equations::new(here, &numbers);
        let parts = here.parts.iter().enumerate();
        let parts: Vec<_> = parts.map(|(k, p)| (p.id, at.part(k, false))).collect();
        placed(&self.model, &parts)
    }

    /// Assembles a model for the mode of a start; returns it with its velocities, or `None` where
    /// it cannot be assembled: what is wrong is told of the whole model.
    fn moving_start(
        &self,
        model: &Model,
        of: &Start,
        look: Look<'_>,
    ) -> Result<Option<(Start, Vec<f64>)>, Vec<Diagnostic>> {
        let options = build::Options {
            mode: of.mode,
            skip: self.options.skip.clone(),
            hooks: self.hooks.clone(),
            zero_user: self.options.zero_user,
            shells: self.shells.clone().unwrap_or_default(),
            ..build::Options::default()
        };
        let Ok(scene) = Scene::compile(model, &options) else {
            return Ok(None);
        };
        let mut start = Start::new(scene, of.mode, of.t);
        initial_conditions::initial_joints(&start.scene, model, &mut start.q);
        for m in 0..start.scene.motions.len() {
            self.initial_motion(&start.scene, m, &mut start.x);
        }
        start.configuration.external = self.external(start.here(), start.t, &start.q, &start.x)?;
        let conditions = initial_conditions::collect(&start.scene, model);
        let mut stopped = None;
        let mut seen = || look().inspect_err(|said| stopped = Some(said.clone()));
        if start.assemble(model, &conditions, &mut seen).is_err() {
            return stopped.map_or(Ok(None), Err);
        }
        (start.configuration).begin_states(&start.scene, &mut start.x);
        let at = (start.t, &start.q[..], &start.x[..]);
        let v = velocities::velocities_while(start.here(), model, at, &mut seen);
        if let Some(said) = stopped {
            return Err(said);
        }
        Ok(v.ok().map(|begun| (start, begun.v)))
    }
}

/// Returns the rate of the displacement that a law reads off two markers.
fn rate(law: Law, reference: f64, i: &MarkerState<f64>, j: &MarkerState<f64>) -> f64 {
    let frame = |m: &MarkerState<f64>| Frame {
        rotation: m.R_GM,
        position: m.p_GM,
    };
    // β₂ is read on the side of β₁
    let reference = match law {
        Law::BodyAngle { .. } if reference == 0.0 => body_angles(&frame(i), &frame(j))[0],
        _ => reference,
    };
    let drive = Drive {
        value: Jet::zero(),
        beside: Jet::zero(),
        reference,
    };
    law.shown(&moving(i), &moving(j), drive).first
}
