//! Sensors and samples at accepted states.

use super::System;
use super::samples::Held;
use crate::diagnostic::Diagnostic;
use std::collections::BTreeMap;

impl System {
    /// Takes the sensors as they stand at the start of a simulation.
    pub fn begin_sensing(&mut self) {
        self.recorded
            .sensors
            .begin(&self.scene.sensors, &mut self.numbers);
    }

    /// Takes the sensors that held where the simulation before ended, as
    /// [`held_sensors`](Self::held_sensors) told them there.
    pub fn follow_sensors(&mut self, held: &BTreeMap<u32, f64>) {
        self.recorded.sensors.follow(held);
    }

    /// Returns the sensors that held when last looked at, by their numbers, and the values that
    /// they saw.
    pub fn held_sensors(&self) -> BTreeMap<u32, f64> {
        self.recorded.sensors.held(&self.scene.sensors)
    }

    /// Returns the sensors that are triggered at an accepted state, by their places in
    /// `Scene::sensors`; SENVAL is new then. `switched`: a switch was located at this state.
    pub fn sense(&mut self, t: f64, y: &[f64], switched: bool) -> Vec<usize> {
        if self.recorded.sensors.is_empty() {
            return Vec::new();
        }
        self.set(t, y);
        let sensors = &self.scene.sensors;
        self.recorded
            .sensors
            .sense(sensors, &mut self.numbers, switched)
    }

    /// Returns the sensors that are triggered where a method begins, by the branches that hold from
    /// there on; SENVAL is new then.
    pub fn sense_beginning(&mut self, t: f64, y: &[f64]) -> Vec<usize> {
        if self.recorded.sensors.is_empty() {
            return Vec::new();
        }
        self.set(t, y);
        let mut beyond = Vec::new();
        if !(self.recorded.branches).beyond_sensors(&self.numbers, &mut beyond) {
            return Vec::new();
        }
        let sensors = &self.scene.sensors;
        (self.recorded.sensors).pass(sensors, &mut self.numbers, beyond)
    }

    /// Evaluates by how much the expressions of sensors are beyond their values   (n_sensors)
    pub fn beyond_sensors(&mut self, t: f64, y: &[f64], values: &mut Vec<f64>) {
        self.set(t, y);
        let sensors = &self.scene.sensors;
        self.recorded.sensors.beyond(sensors, &self.numbers, values);
    }

    /// Returns whether a sensor that waits for its value passes it between two such evaluations.
    pub fn passes_sensor(&self, before: &[f64], after: &[f64]) -> bool {
        let sensors = &self.recorded.sensors;
        let mut passed = sensors.passed(&self.scene.sensors, before, after);
        passed.next().is_some()
    }

    /// Returns the sensors that have passed their values at a state, by such evaluations before it
    /// and there; SENVAL is new then.
    pub fn sense_passed(&mut self, t: f64, y: &[f64], before: &[f64], there: &[f64]) -> Vec<usize> {
        self.set(t, y);
        let all = &self.scene.sensors;
        let passed: Vec<usize> = self.recorded.sensors.passed(all, before, there).collect();
        (self.recorded.sensors).take(all, &mut self.numbers, &passed);
        passed
    }

    /// Goes on as the last simulation left the samples, or takes the first ones here.
    ///
    /// # Errors
    /// A period that is not positive.
    pub fn begin_sampling(&mut self, held: &BTreeMap<u32, Held>) -> Result<(), Diagnostic> {
        self.recorded.samples.begin(&mut self.numbers, held)
    }

    /// Sets the samples back to where the simulation begins.
    pub fn restart_sampling(&mut self) {
        self.recorded.samples.restart(&mut self.numbers);
    }

    /// Takes the samples that are due at an accepted state; returns whether a state has changed.
    pub fn sample(&mut self, t: f64, y: &[f64]) -> bool {
        let due = self.recorded.samples.due_at(t);
        let changed = self.recorded.samples.take(&due, &mut self.numbers);
        self.set(t, y);
        self.recorded.samples.prepare_next(&due, &self.numbers);
        changed
    }
}
