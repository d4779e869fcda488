//! Sensors of a mechanism without freedom: they are watched along its path, and the instant at
//! which one is triggered is located there, whatever the steps and the outputs are.

use super::counting::Counting;
use crate::analysis::system::System;
use crate::analysis::time::continuation::Continuation;
use crate::analysis::trajectory::{Ended, Trajectory};

/// Part of a step of the path between looks at the sensors.
const LOOKS_IN_STEP: f64 = 8.0;
/// Way of the drives between looks at the sensors, rad.
const WAY_BETWEEN_LOOKS: f64 = 0.25;
/// Most looks at the sensors within a step.
const MAX_LOOKS: f64 = 1e6;

/// The path of a mechanism, with what is followed along it.
#[derive(Debug, Default)]
pub(super) struct Followed {
    pub counting: Counting,
    /// up to where sensors have been looked at
    t: f64,
    /// by how much they were beyond their values there, and where they are looked at next
    /// (n_sensors)
    before: Vec<f64>,
    after: Vec<f64>,
    /// how fast the mechanism moved at the end of the last step, rad per time
    pace: f64,
    /// distance of looks at them
    distance: f64,
    /// the time from which a sensor asks for other outputs, and their distance
    pub every: Option<(f64, f64)>,
    /// the length of the next step that a sensor asks for
    pub stepsize: Option<f64>,
}

impl Followed {
    /// Begins at the state of a system.
    pub fn begin(&mut self, system: &mut System, path: &Continuation) {
        let now = path.now();
        self.t = now.t;
        if system.counts_turns() {
            self.counting.begin(system, now.t, &now.y);
        }
        if !system.recorded.sensors.is_empty() {
            system.beyond_sensors(now.t, &now.y, &mut self.before);
            self.pace = system.pace(now.t, &now.y);
        }
    }

    /// Prepares for the step that the path has taken from time `t0`.
    pub fn begin_step(&mut self, system: &mut System, path: &Continuation, t0: f64) {
        let now = path.now();
        let (h, n) = (now.t - t0, now.y.len());
        if system.counts_turns() {
            let ends = (t0, now.t);
            let mut state_at = path.states();
            let turn = (self.counting).turn_within(system, ends, (n, 0.0), &mut state_at);
            self.counting.divide(turn);
        }
        if !system.recorded.sensors.is_empty() {
            let pace = system.pace(now.t, &now.y);
            let way = h * pace.max(std::mem::replace(&mut self.pace, pace));
            let looks = (way / WAY_BETWEEN_LOOKS).clamp(LOOKS_IN_STEP, MAX_LOOKS);
            self.distance = h / looks.ceil();
        }
    }

    /// Follows the path up to a time in its last step, or up to where a sensor asks for other
    /// outputs.
    ///
    /// # Errors
    /// A sensor ends the simulation on the way.
    pub fn follow(
        &mut self,
        system: &mut System,
        path: &Continuation,
        to: f64,
        out: &mut Trajectory,
    ) -> Result<(), Ended> {
        if !system.recorded.sensors.is_empty() {
            while self.t < to {
                let next = self.t + self.distance;
                let next = if next < to && next > self.t { next } else { to };
                // between turns of what time drives, a look at the ends sees each passage
                let turn = system.recorded.clocks.turns(self.t, next, 1);
                let next = turn
                    .first()
                    .copied()
                    .filter(|&t| t > self.t)
                    .unwrap_or(next);
                self.watch(system, path, next, out)?;
                if self.every.is_some() {
                    return Ok(());
                }
            }
        }
        self.count(system, path, to);
        Ok(())
    }

    /// Does what the sensors ask for that are triggered at a state.
    ///
    /// # Errors
    /// One of them ends the simulation.
    pub fn trigger(
        &mut self,
        system: &mut System,
        at: (f64, &[f64]),
        out: &mut Trajectory,
    ) -> Result<(), Ended> {
        self.trigger_with(system, at, (false, Vec::new()), out)
    }

    /// Does the same for sensors that have passed their values there as well.
    fn trigger_with(
        &mut self,
        system: &mut System,
        at: (f64, &[f64]),
        (near, passed): (bool, Vec<usize>),
        out: &mut Trajectory,
    ) -> Result<(), Ended> {
        let asked = trigger(system, at, (near, passed), out)?;
        self.every = asked.dt.map(|dt| (at.0, dt)).or(self.every);
        self.stepsize = asked.stepsize.or(self.stepsize);
        Ok(())
    }

    fn count(&mut self, system: &mut System, path: &Continuation, to: f64) {
        if system.counts_turns() {
            (self.counting).count(system, to, &mut path.states());
        }
    }

    /// Looks at the sensors at a time; locates where one passes its value before it.
    fn watch(
        &mut self,
        system: &mut System,
        path: &Continuation,
        to: f64,
        out: &mut Trajectory,
    ) -> Result<(), Ended> {
        self.count(system, path, to);
        let Ok(y) = path.within(system, to) else {
            self.t = to;
            return Ok(());
        };
        system.beyond_sensors(to, &y, &mut self.after);
        let (mut at, mut there) = (to, y);
        let located = system.passes_sensor(&self.before, &self.after);
        if located {
            // bisect down to rounding
            let mut whole = self.t;
            while at - whole > 4.0 * f64::EPSILON * at.abs() {
                let middle = 0.5 * (whole + at);
                let Ok(y) = path.within(system, middle) else {
                    break;
                };
                if middle <= whole || middle >= at {
                    break;
                }
                system.beyond_sensors(middle, &y, &mut self.after);
                if system.passes_sensor(&self.before, &self.after) {
                    (at, there) = (middle, y);
                } else {
                    whole = middle;
                }
            }
            system.beyond_sensors(at, &there, &mut self.after);
        }
        // an expression may jump over its value, or be off it by rounding
        let passed = match located {
            true => system.sense_passed(at, &there, &self.before, &self.after),
            false => Vec::new(),
        };
        std::mem::swap(&mut self.before, &mut self.after);
        self.t = at;
        self.trigger_with(system, (at, &there), (located, passed), out)
    }
}

/// Distances that triggered sensors ask for.
#[derive(Default)]
struct Asked {
    /// of outputs from now on
    dt: Option<f64>,
    /// of the end of the next step
    stepsize: Option<f64>,
}

/// Does what the sensors ask for that are triggered at a state; returns the distances that they ask
/// for. `near`: a value within ERROR counts; `passed`: those that are known to be.
///
/// # Errors
/// One of them ends the simulation.
fn trigger(
    system: &mut System,
    (t, y): (f64, &[f64]),
    (near, passed): (bool, Vec<usize>),
    out: &mut Trajectory,
) -> Result<Asked, Ended> {
    let mut asked = Asked::default();
    let mut triggered = passed;
    triggered.extend(system.sense(t, y, near));
    triggered.sort_unstable();
    for k in triggered {
        let sensor = &system.scene.sensors[k];
        let ends = sensor.halt || sensor.end_simulation;
        asked.dt = sensor.dt.or(asked.dt);
        let both = asked.stepsize.into_iter().chain(sensor.stepsize);
        asked.stepsize = both.reduce(f64::min);
        if (ends || sensor.print) && out.ends_before(t) {
            let row = system.row_of(t, y);
            out.push(t, row);
        }
        out.triggered.push((t, k));
        if ends {
            return Err(Ended::Sensor(k));
        }
    }
    Ok(asked)
}
