//! Sensors: expressions that are watched while time passes, until they reach their values.
//!
//! ```text
//! EQ: e = VALUE        GE: e ≥ VALUE        LE: e ≤ VALUE              e − VALUE (ANGULAR: modulo 2π) is a switching function
//! ```
//!
//! The instant at which e passes VALUE is located like every switch, so it does not depend on steps
//! or on ERROR. Where a switch is located, the branches on which the motion goes on decide what e
//! does from there on: it may jump there, or be short of VALUE by rounding. Within ERROR of VALUE
//! an expression counts as there (one that turns back just before it, too). A sensor that holds at
//! the start of a simulation evaluates its EVALUATE there, and acts only after it has not held
//! once. One that has been triggered in the simulation before holds within ERROR, too: what it
//! watches may be short of VALUE by rounding, and would pass it again at once.

use super::recording::Recording;
use crate::model::Comparison;
use crate::scene::configuration::Configured;
use crate::scene::equations::Unsupported;
use crate::scene::external_inputs::{ExternalInput, SceneSensor};
use crate::scene::programs::record;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// The sensors of a system.
#[derive(Clone, Debug, Default)]
pub struct Sensors {
    /// expressions that are watched, then those that are evaluated (zero where there is none)
    /// (2 n)
    recording: Option<Recording>,
    /// whether each did not hold when last looked at, or never was   (n)
    armed: Vec<bool>,
    /// places of SENVAL in the row of numbers   (n)
    places: Vec<usize>,
    /// sensors that held where the simulation before ended, by their numbers, and the values that
    /// they saw
    held_before: BTreeMap<u32, f64>,
    /// whether each expression was beyond its value (0, 1) on the branches on which a method began
    /// last   (n, empty: not known)
    beyond: Vec<f64>,
}

/// Returns by how much an expression is beyond the value of a sensor.
fn beyond_value(s: &SceneSensor, e: f64) -> f64 {
    let beyond = e - s.value;
    if s.angular {
        (beyond + PI).rem_euclid(TAU) - PI
    } else {
        beyond
    }
}

/// Returns whether a sensor holds; `near`: a value within ERROR counts.
fn holds(s: &SceneSensor, e: f64, near: bool) -> bool {
    let beyond = beyond_value(s, e);
    let slack = if near { s.error } else { 0.0 };
    match s.comparison {
        Comparison::Equal => beyond.abs() <= s.error,
        Comparison::GreaterOrEqual => beyond >= -slack,
        Comparison::LessOrEqual => beyond <= slack,
    }
}

impl Sensors {
    /// Records the expressions of the sensors of a scene.
    ///
    /// # Errors
    /// Functions that the equations cannot supply.
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
        let mut places = vec![scene.layout.external_at(0); n];
        for (place, input) in scene.external_inputs.iter().enumerate() {
            if let ExternalInput::Sensor(k) = *input {
                places[k] = scene.layout.external_at(place);
            }
        }
        Ok(Self {
            recording: Some(Recording::new(program)),
            armed: vec![true; n],
            places,
            held_before: BTreeMap::new(),
            beyond: Vec::new(),
        })
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.armed.is_empty()
    }

    /// Takes the sensors as they stand at the start of a simulation; one that holds there yields
    /// its SENVAL.
    pub(super) fn begin(&mut self, sensors: &[SceneSensor], numbers: &mut [f64]) {
        self.look(numbers);
        self.beyond.clear();
        for (k, sensor) in sensors.iter().enumerate() {
            let e = self.values()[k];
            let still = |&then: &f64| e == then || holds(sensor, e, true);
            let here =
                holds(sensor, e, false) || self.held_before.get(&sensor.id).is_some_and(still);
            self.armed[k] = !here;
            if here {
                self.yield_value(k, sensor, numbers);
            }
        }
    }

    /// Takes what [`held`](Self::held) told at the end of the simulation before.
    pub(super) fn follow(&mut self, held: &BTreeMap<u32, f64>) {
        self.held_before.clone_from(held);
    }

    /// Returns the sensors that held when last looked at, by their numbers, and the values that
    /// they saw.
    pub(super) fn held(&self, sensors: &[SceneSensor]) -> BTreeMap<u32, f64> {
        let all = sensors.iter().zip(&self.armed).zip(self.values());
        all.filter(|((_, armed), _)| !**armed)
            .map(|((sensor, _), &e)| (sensor.id, e))
            .collect()
    }

    /// Goes on from the same sensors, recorded for other rows.
    pub(super) fn carry_on(&mut self, before: &Self) {
        self.armed.clone_from(&before.armed);
    }

    /// Returns the sensors that are triggered at an accepted state; SENVAL is new then. `switched`:
    /// a switch was located at this state.
    pub(super) fn sense(
        &mut self,
        sensors: &[SceneSensor],
        numbers: &mut [f64],
        switched: bool,
    ) -> Vec<usize> {
        self.look(numbers);
        let mut triggered = Vec::new();
        for (k, sensor) in sensors.iter().enumerate() {
            if holds(sensor, self.values()[k], switched) {
                if std::mem::replace(&mut self.armed[k], false) {
                    triggered.push(k);
                }
            } else {
                self.armed[k] = true;
            }
        }
        for &k in &triggered {
            self.yield_value(k, &sensors[k], numbers);
        }
        triggered
    }

    /// Returns the sensors that are triggered where a method begins, as what they watch goes on
    /// `beyond` its value (0, 1; on the branches that hold from there on) or no more; SENVAL is new
    /// then. There the expression may have its value itself, be short of it by rounding, or jump.
    pub(super) fn pass(
        &mut self,
        sensors: &[SceneSensor],
        numbers: &mut [f64],
        beyond: Vec<f64>,
    ) -> Vec<usize> {
        self.look(numbers);
        let before = std::mem::replace(&mut self.beyond, beyond);
        let mut triggered = Vec::new();
        for (k, sensor) in sensors.iter().enumerate() {
            let is_beyond = self.beyond[k] > 0.0;
            let passes = match sensor.comparison {
                Comparison::GreaterOrEqual => is_beyond,
                Comparison::LessOrEqual => !is_beyond,
                // the sine of an angle changes its sign at half a turn, too
                Comparison::Equal => {
                    let was_beyond = before.get(k).map(|&b| b > 0.0);
                    let is_half_a_turn = || beyond_value(sensor, self.values()[k]).abs() > PI / 2.0;
                    was_beyond == Some(!is_beyond) && !(sensor.angular && is_half_a_turn())
                }
            };
            let has_value = self.values()[k].is_finite();
            if passes && has_value && std::mem::replace(&mut self.armed[k], false) {
                triggered.push(k);
            }
        }
        for &k in &triggered {
            self.yield_value(k, &sensors[k], numbers);
        }
        triggered
    }

    /// Evaluates by how much the expressions are beyond the values of the sensors   (n)
    pub(super) fn beyond(
        &mut self,
        sensors: &[SceneSensor],
        numbers: &[f64],
        values: &mut Vec<f64>,
    ) {
        self.look(numbers);
        values.clear();
        let expressions = sensors.iter().zip(self.values());
        values.extend(expressions.map(|(sensor, &e)| beyond_value(sensor, e)));
    }

    /// Returns the sensors that wait for their values and pass them between two evaluations of
    /// [`beyond`](Self::beyond).
    pub(super) fn passed(
        &self,
        sensors: &[SceneSensor],
        before: &[f64],
        after: &[f64],
    ) -> impl Iterator<Item = usize> {
        let ends = before.iter().zip(after);
        let all = sensors.iter().zip(&self.armed).zip(ends).enumerate();
        all.filter_map(|(k, ((s, &armed), (&a, &b)))| {
            // an angle passes half a turn without passing its value
            let around = s.angular && (a - b).abs() > PI;
            let passes = match s.comparison {
                Comparison::Equal => a < 0.0 && b >= 0.0 || a > 0.0 && b <= 0.0,
                Comparison::GreaterOrEqual => a < 0.0 && b >= 0.0,
                Comparison::LessOrEqual => a > 0.0 && b <= 0.0,
            };
            (armed && passes && !around).then_some(k)
        })
    }

    /// Takes these sensors as triggered at a state; SENVAL is new then.
    pub(super) fn take(&mut self, sensors: &[SceneSensor], numbers: &mut [f64], which: &[usize]) {
        self.look(numbers);
        for &k in which {
            self.armed[k] = false;
            self.yield_value(k, &sensors[k], numbers);
        }
    }

    fn look(&mut self, numbers: &[f64]) {
        if let Some(recording) = &mut self.recording {
            recording.run(numbers);
        }
    }

    fn values(&self) -> &[f64] {
        self.recording.as_ref().map_or(&[], |r| &r.values)
    }

    /// Puts the value of EVALUATE in place of the last one.
    fn yield_value(&self, k: usize, sensor: &SceneSensor, numbers: &mut [f64]) {
        if sensor.evaluate.is_some() {
            numbers[self.places[k]] = self.values()[self.armed.len() + k];
        }
    }
}
