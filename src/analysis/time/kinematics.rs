//! Motion of a mechanism without freedom: at each output time the positions that its drives and
//! rows leave, then velocities; accelerations and reactions follow from the equations when somebody
//! asks.
//!
//! A step that does not converge is halved. When halving no longer helps, the mechanism is locked:
//! it cannot be driven further, and the row that stands in the way is named.

use crate::analysis::system::System;
use crate::analysis::time::ranks;
use crate::analysis::time::trajectory::{Ended, Trajectory};
use crate::analysis::watch::Watch;
use crate::numeric::{Failure, Ode, Reason, Stop};
use crate::scene::layout::Layout;

/// Halvings of a step before the mechanism counts as locked.
const MAX_HALVINGS: u32 = 24;
/// Correction of a predicted position, in units of the step, beyond which it is on another branch.
const LARGEST_CORRECTION: f64 = 2.0;
/// Correction below which it never is, rad or units of length.
const SMALL_CORRECTION: f64 = 0.5;
/// Violation of a row that is left out, relative to what counts as one, up to which it follows from
/// the others.
const FOLLOWS_TOLERANCE: f64 = 1e-8;

/// Moves through all `outputs` (ascending, after the state's time), in steps no longer than
/// `h_max`.
pub fn trace(
    system: &mut System,
    outputs: &[f64],
    h_max: f64,
    watch: &mut dyn Watch,
) -> Trajectory {
    let l = system.scene.layout;
    let t = system.numbers[Layout::TIME];
    let y = system.numbers[l.y()].to_vec();
    let mut out = Trajectory::default();
    out.begin_method(t, "KINEMATIC");
    system.begin_sensing();
    if !system.scene.rows.is_empty() {
        out.weak.push(Some(system.numbers.clone()));
    }
    let mut tracer = Tracer {
        started: t,
        t,
        trial: y.clone(),
        y,
        dq: vec![0.0; l.n_v],
        system,
        out,
    };
    let ended = outputs
        .iter()
        .try_for_each(|&target| tracer.reach(target, h_max, watch));
    tracer.out.ended = ended.err();
    tracer.out
}

/// A mechanism on its way.
struct Tracer<'a> {
    system: &'a mut System,
    /// time and state reached
    t: f64,
    y: Vec<f64>,
    started: f64,
    /// the state that is tried, and a displacement   (n; n_v)
    trial: Vec<f64>,
    dq: Vec<f64>,
    out: Trajectory,
}

impl Tracer<'_> {
    /// Moves to an output time and puts it out.
    fn reach(&mut self, target: f64, h_max: f64, watch: &mut dyn Watch) -> Result<(), Ended> {
        let mut h = (target - self.t).min(h_max);
        let mut halvings = 0;
        while self.t < target {
            if watch.interrupted() {
                return Err(Ended::Interrupted);
            }
            let arrives = self.t + h >= target - 1e-12 * target.abs();
            let next = if arrives { target } else { self.t + h };
            self.predict(next);
            match self.correct(next) {
                Ok(()) => {
                    self.accept(next);
                    if halvings > 0 {
                        h *= 2.0;
                        halvings -= 1;
                    }
                    self.system.count_turns(self.t, &self.y);
                    watch.progress(self.t, h, &self.out.stats);
                }
                Err(failure) => {
                    self.out.stats.rejected += 1;
                    h *= 0.5;
                    halvings += 1;
                    if halvings > MAX_HALVINGS {
                        return Err(self.locked(failure, h));
                    }
                }
            }
        }
        let row = self.system.row(target, &self.y);
        self.out.push(target, row);
        self.sense(target)
    }

    /// Goes on with the velocities of the last position.
    fn predict(&mut self, next: f64) {
        let l = self.system.scene.layout;
        self.trial.copy_from_slice(&self.y);
        for (d, v) in self.dq.iter_mut().zip(l.state(&self.y).v) {
            *d = v * (next - self.t);
        }
        (self.system.mover()).displace(l.state_mut(&mut self.trial).q, &self.dq);
    }

    /// Brings the predicted state onto the rows; refuses one that jumped to another branch.
    fn correct(&mut self, t: f64) -> Result<(), Failure> {
        self.out.stats.evaluations += 1;
        let (system, trial) = (&mut *self.system, &mut self.trial);
        let predicted = trial.clone();
        system.project(t, trial)?;
        if let Some((what, off)) = system.worst_left_out(t, trial)
            && (off.is_nan() || off > FOLLOWS_TOLERANCE)
        {
            // the rows that take part leave two ways here; all rows together one
            let mut numbers = system.numbers_at(t, trial);
            if !ranks::repair(system.configured(), &mut numbers) {
                let recoverable = true;
                return Err(Failure { what, recoverable });
            }
            trial.copy_from_slice(&numbers[system.scene.layout.y()]);
        }
        let l = system.scene.layout;
        let moved = |a: &[f64], b: &[f64]| {
            let both = l.state(a).q.iter().zip(l.state(b).q);
            both.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
        };
        // the correction should be small against the step itself, once the velocities are known
        let (step, correction) = (moved(&predicted, &self.y), moved(trial, &predicted));
        if step > 0.0 && correction > LARGEST_CORRECTION * step && correction > SMALL_CORRECTION {
            return Err(Failure {
                what: 0,
                recoverable: true,
            });
        }
        Ok(())
    }

    /// Takes a corrected state over, with the rows that are the better ones there.
    fn accept(&mut self, next: f64) {
        let (system, out) = (&mut *self.system, &mut self.out);
        self.y.copy_from_slice(&self.trial);
        self.t = next;
        let numbers = system.numbers_at(next, &self.y);
        if system.watches_rows()
            && let Some(active) = ranks::better_rows(system.configured(), &numbers)
        {
            let chosen = (out.rows.len(), next, active.clone());
            system.numbers.copy_from_slice(&numbers);
            if system.reselect(active).is_ok() {
                out.selections.push(chosen);
            }
        }
        let most = ranks::states_kept(system.scene.layout.n_v);
        if (out.weak.len() as f64) < most && !system.scene.rows.is_empty() {
            out.weak.push(Some(numbers));
        }
        out.stats.steps += 1;
    }

    /// Ends where the mechanism can be driven no further; the last configuration is kept.
    fn locked(&mut self, failure: Failure, h: f64) -> Ended {
        let t = self.t;
        if self.out.ends_before(t) && t > self.started {
            let row = self.system.row(t, &self.y);
            self.out.push(t, row);
        }
        let reason = Reason::Projection(failure);
        Ended::Stop(Stop { reason, t, h })
    }

    /// Looks at the sensors: positions are found from output to output, so sensors are, too.
    fn sense(&mut self, t: f64) -> Result<(), Ended> {
        for k in self.system.sense(t, &self.y, true) {
            self.out.triggered.push((t, k));
            let sensor = &self.system.scene.sensors[k];
            if sensor.halt || sensor.end_simulation {
                return Err(Ended::Sensor(k));
            }
        }
        Ok(())
    }
}
