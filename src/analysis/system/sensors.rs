//! Sensors: what is watched while time passes, and what happens when it reaches its value.
//!
//! ```text
//! EQ: e = VALUE        GE: e ≥ VALUE        LE: e ≤ VALUE              e − VALUE (ANGULAR: modulo 2π) is a switching function
//! ```
//!
//! The instant at which e passes VALUE is located like every switch, so it does not depend on steps or on ERROR; within ERROR of
//! VALUE an expression counts as there (one that turns back just before it, too). A sensor that holds at the start of a simulation
//! evaluates its EVALUATE there, and acts only after it has not held once.

use crate::analysis::system::System;
use crate::expr::program::{Program, Work};
use crate::model::Comparison;
use crate::scene::configuration::Configured;
use crate::scene::equations::Unsupported;
use crate::scene::external_inputs::{ExternalInput, SceneSensor};
use crate::scene::programs::record;
use std::f64::consts::{PI, TAU};

/// The sensors of a system.
#[derive(Debug, Default)]
pub struct Sensors {
    /// what is watched, then what is evaluated (zero where nothing is)   (2 n)
    program: Option<Program>,
    work: Work,
    values: Vec<f64>,
    /// did not hold when last looked at   (n)
    armed: Vec<bool>,
    /// place of SENVAL in the row of numbers   (n)
    places: Vec<usize>,
}

/// Whether a sensor holds; `near`: what is within ERROR counts.
fn holds(s: &SceneSensor, e: f64, near: bool) -> bool {
    let mut beyond = e - s.value;
    if s.angular {
        beyond = (beyond + PI).rem_euclid(TAU) - PI;
    }
    let slack = if near { s.error } else { 0.0 };
    match s.comparison {
        Comparison::Equal => beyond.abs() <= s.error,
        Comparison::GreaterOrEqual => beyond >= -slack,
        Comparison::LessOrEqual => beyond <= slack,
    }
}

impl Sensors {
    /// Of a scene.
    ///
    /// # Errors
    /// What the equations cannot supply.
    pub fn new(scene: Configured<'_>) -> Result<Self, Vec<Unsupported>> {
        let n = scene.sensors.len();
        if n == 0 {
            return Ok(Self::default());
        }
        let program = record(scene, |at| {
            let watched = scene.sensors.iter().map(|s| at.formula(s.formula));
            let zero = crate::expr::program::Sym::Constant(0.0);
            let evaluated =
                (scene.sensors.iter()).map(|s| s.evaluate.map_or(zero, |f| at.formula(f)));
            watched.chain(evaluated).collect()
        })?;
        let place = |k: usize| {
            let own = scene
                .external_inputs
                .iter()
                .position(|s| *s == ExternalInput::Sensor(k));
            scene.layout.external_at(own.unwrap_or(0))
        };
        Ok(Self {
            program: Some(program),
            work: Work::default(),
            values: vec![0.0; 2 * n],
            armed: vec![false; n],
            places: (0..n).map(place).collect(),
        })
    }

    fn look(&mut self, numbers: &[f64]) {
        if let Some(program) = &self.program {
            program.run(numbers, &mut self.work, &mut self.values);
        }
    }
}

impl System {
    /// Takes the sensors as they stand at the start of a simulation.
    pub fn begin_sensing(&mut self) {
        self.sensors.look(&self.numbers);
        let n = self.sensors.armed.len();
        for (k, sensor) in self.scene.sensors.iter().enumerate() {
            let here = holds(sensor, self.sensors.values[k], false);
            self.sensors.armed[k] = !here;
            if here && sensor.evaluate.is_some() {
                self.numbers[self.sensors.places[k]] = self.sensors.values[n + k];
            }
        }
    }

    /// The sensors that are triggered at an accepted state, by their places in [`Scene::sensors`]; what SENVAL yields is then
    /// new. `switched`: the state is one at which a switch was located.
    pub fn sense(&mut self, t: f64, y: &[f64], switched: bool) -> Vec<usize> {
        let n = self.sensors.armed.len();
        if n == 0 {
            return Vec::new();
        }
        self.set(t, y);
        self.sensors.look(&self.numbers);
        let mut triggered = Vec::new();
        for (k, sensor) in self.scene.sensors.iter().enumerate() {
            if holds(sensor, self.sensors.values[k], switched) {
                if std::mem::replace(&mut self.sensors.armed[k], false) {
                    triggered.push(k);
                }
            } else {
                self.sensors.armed[k] = true;
            }
        }
        for &k in &triggered {
            if self.scene.sensors[k].evaluate.is_some() {
                self.numbers[self.sensors.places[k]] = self.sensors.values[n + k];
            }
        }
        triggered
    }
}
