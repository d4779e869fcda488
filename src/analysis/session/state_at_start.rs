//! A state on its way to be consistent: from the dataset, or from the last simulation, onto the
//! rows.

use super::beginning::ROUNDING_OF_A_TURN;
use super::carried::Carried;
use crate::analysis::look::Look;
use crate::analysis::start::assemble::{self, Assembly};
use crate::analysis::start::dataset::{self, Dataset};
use crate::analysis::start::initial_conditions::InitialCondition;
use crate::diagnostic::Diagnostic;
use crate::model::Model;
use crate::scene::cams;
use crate::scene::configuration::{Configuration, Configured};
use crate::scene::equations::Equations;
use crate::scene::unknown::UnknownId;
use crate::scene::{CountedAngle, Scene};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A state on its way to be consistent.
pub(super) struct Start {
    pub mode: u32,
    pub t: f64,
    pub scene: Arc<Scene>,
    pub configuration: Configuration,
    /// positions   (n_q)
    pub q: Vec<f64>,
    /// velocities that are taken over; `None`: they are assembled   (n_v)
    pub v: Option<Vec<f64>>,
    /// states   (n_x)
    pub x: Vec<f64>,
}

impl Start {
    /// Begins with the configuration of the dataset.
    pub fn new(scene: Arc<Scene>, mode: u32, t: f64) -> Self {
        let mut x = vec![0.0; scene.layout.n_x];
        for d in &scene.differentials {
            if let Some(state) = d.state {
                x[state] = d.initial[0];
            }
        }
        Self {
            mode,
            t,
            configuration: Configuration::new(&scene),
            q: scene.initial_q.clone(),
            v: None,
            x,
            scene,
        }
    }

    /// Returns the scene in its present configuration.
    pub fn here(&self) -> Configured<'_> {
        self.scene.within(&self.configuration)
    }

    /// Takes over the state of the last simulation, by the identities of the unknowns.
    pub fn take_over(&mut self, carried: &Carried) {
        let l = self.scene.layout;
        let (values, unknowns) = (carried.values(), &self.scene.unknowns);
        let mut v = vec![0.0; l.n_v];
        // every position and velocity is told; states may be new
        let mut complete = take_over(&values, &unknowns.q, &mut self.q);
        complete &= take_over(&values, &unknowns.v, &mut v);
        take_over(&values, &unknowns.x, &mut self.x);
        for (cam, contact) in self.scene.cams.iter().zip(&mut self.configuration.contacts) {
            contact.begun = values.contains_key(&unknowns.x[cam.state]);
        }
        if complete && !carried.at_rest {
            self.v = Some(v);
        }
        for (angle, start) in self.scene.counted.iter().zip(&mut self.configuration.turns) {
            if let Some(&carried) = carried.turns.get(&angle.id) {
                start.angle = carried;
            }
        }
    }

    /// Lets angles that coordinates know begin where the last simulation left them, else within
    /// half a turn of zero.
    pub fn begin_turns(&mut self, carried: Option<&Carried>) {
        let still = vec![0.0; self.scene.layout.n_v];
        let numbers = assemble::numbers(self.here(), self.t, &self.q, &still, &self.x);
        let at = Equations::new(self.scene.within(&self.configuration), &numbers);
        let offset = |angle: &CountedAngle| {
            let sum = at.sum_of_coordinates(angle.coordinates.as_ref()?);
            let turns = match carried.and_then(|c| c.turns.get(&angle.id)) {
                Some(before) => ((before - sum) / TAU).round(),
                // half a turn is positive
                None => -((sum - PI) / TAU - ROUNDING_OF_A_TURN).ceil(),
            };
            Some(turns * TAU)
        };
        let offsets: Vec<Option<f64>> = self.scene.counted.iter().map(offset).collect();
        for (start, offset) in self.configuration.turns.iter_mut().zip(offsets) {
            start.offset = offset;
        }
    }

    /// Assembles the dataset; returns where contacts on curves were asked to begin, too.
    ///
    /// # Errors
    /// Rows that contradict each other, and what `look` answers.
    pub fn assemble(
        &mut self,
        model: &Model,
        conditions: &[InitialCondition],
        look: Look<'_>,
    ) -> Result<(Assembly, Vec<cams::Start>), Vec<Diagnostic>> {
        let drawn = Dataset {
            scene: &self.scene,
            model,
            t: self.t,
            x: &self.x,
            conditions: conditions.to_vec(),
        };
        drawn.assemble_while(&mut self.configuration, &mut self.q, look)
    }

    /// Puts positions that a simulation left onto the rows, and chooses those that take part.
    ///
    /// # Errors
    /// Rows that contradict each other, and what `look` answers.
    pub fn positions(&mut self, look: Look<'_>) -> Result<Assembly, Vec<Diagnostic>> {
        let (scene, configuration) = (&self.scene, &mut self.configuration);
        dataset::go_on(scene, configuration, self.t, &mut self.q, &self.x, look)
    }
}

/// Takes over the values of the unknowns that are known; returns whether all are.
fn take_over(known: &BTreeMap<UnknownId, f64>, unknowns: &[UnknownId], values: &mut [f64]) -> bool {
    let mut complete = true;
    for (unknown, value) in unknowns.iter().zip(values) {
        match known.get(unknown) {
            Some(&found) => *value = found,
            None => complete = false,
        }
    }
    complete
}
