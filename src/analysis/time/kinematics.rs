//! Motion of a mechanism without freedom: at each output time the positions that its drives and rows leave, then velocities;
//! accelerations and reactions follow from the equations when somebody asks.
//!
//! A step that does not converge is halved; when halving no longer helps the mechanism is locked: it cannot be driven
//! further, and what stands in the way is named.

use crate::analysis::system::System;
use crate::analysis::time::dynamics::{Ended, Trajectory, Watch};
use crate::analysis::time::ranks;
use crate::numeric::{Failure, Ode, Reason, Stop};

/// Halvings of a step before the mechanism counts as locked.
const HALVINGS: u32 = 24;

/// States kept to find positions where rows become dependent.
const MOST_KEPT: f64 = 2000.0;

/// All numbers at a state.
fn numbers_at(system: &System, t: f64, y: &[f64]) -> Vec<f64> {
    let mut numbers = system.numbers.clone();
    numbers[0] = t;
    numbers[system.scene.layout.y()].copy_from_slice(y);
    numbers
}

/// Moves through all `outputs` (ascending, after the state's time).
pub fn trace(
    system: &mut System,
    outputs: &[f64],
    h_max: f64,
    watch: &mut dyn Watch,
) -> Trajectory {
    let mut out = Trajectory::default();
    out.methods.push((system.numbers[0], "KINEMATIC".into()));
    let l = system.scene.layout;
    let mut t = system.numbers[0];
    let mut y = system.numbers[l.y()].to_vec();
    let mut trial = y.clone();
    let mut dq = vec![0.0; l.n_v];
    system.begin_sensing();
    let started = t;
    let most_kept = (1e8 / (l.n_v as f64).powi(3)).clamp(60.0, MOST_KEPT);
    if !system.scene.rows.is_empty() {
        out.weak.push(Some(system.numbers.clone()));
    }
    for &target in outputs {
        let mut h = (target - t).min(h_max);
        let mut halvings = 0;
        while t < target {
            if watch.interrupted() {
                out.ended = Some(Ended::Interrupted);
                return out;
            }
            let next = if t + h >= target - 1e-12 * target.abs() {
                target
            } else {
                t + h
            };
            // predicted with the velocities of the last position
            trial.copy_from_slice(&y);
            for (d, v) in dq.iter_mut().zip(&y[l.n_q..l.n_q + l.n_v]) {
                *d = v * (next - t);
            }
            system.mover().displace(&mut trial[..l.n_q], &dq);
            out.stats.evaluations += 1;
            match converged(system, next, &y, &mut trial) {
                Ok(()) => {
                    y.copy_from_slice(&trial);
                    t = next;
                    let numbers = numbers_at(system, t, &y);
                    if system.watches_rows()
                        && let Some(active) = ranks::better_rows(&system.scene, &numbers)
                    {
                        let chosen = (out.rows.len(), t, active.clone());
                        system.numbers.copy_from_slice(&numbers);
                        if system.reselect(active).is_ok() {
                            out.selections.push(chosen);
                        }
                    }
                    if (out.weak.len() as f64) < most_kept && !system.scene.rows.is_empty() {
                        out.weak.push(Some(numbers));
                    }
                    out.stats.steps += 1;
                    if halvings > 0 {
                        h *= 2.0;
                        halvings -= 1;
                    }
                    system.count_turns(t, &y);
                    watch.progress(t, h, &out.stats);
                }
                Err(failure) => {
                    out.stats.rejected += 1;
                    h *= 0.5;
                    halvings += 1;
                    if halvings > HALVINGS {
                        let reason = Reason::Projection(failure);
                        // the last configuration is kept
                        if out.t.last().is_none_or(|&last| last < t) && t > started {
                            out.t.push(t);
                            out.rows.push(system.row(t, &y));
                        }
                        out.ended = Some(Ended::Stop(Stop { reason, t, h }));
                        return out;
                    }
                }
            }
        }
        out.t.push(target);
        out.rows.push(system.row(target, &y));
        // positions are found from output to output: so are sensors
        for k in system.sense(target, &y, true) {
            out.triggered.push((target, k));
            let sensor = &system.scene.sensors[k];
            if sensor.halt || sensor.end_simulation {
                out.ended = Some(Ended::Sensor(k));
                return out;
            }
        }
    }
    out
}

/// Brings a predicted state onto the rows; refuses one that jumped to another branch.
fn converged(
    system: &mut System,
    t: f64,
    before: &[f64],
    trial: &mut [f64],
) -> Result<(), Failure> {
    let predicted = trial.to_vec();
    system.project(t, trial)?;
    if let Some((what, off)) = system.worst_left_out(t, trial)
        && (off.is_nan() || off > 1e-8)
    {
        // the rows that take part leave two ways here; all rows together one
        let mut numbers = numbers_at(system, t, trial);
        if !ranks::repair(&system.scene, &mut numbers) {
            let recoverable = true;
            return Err(Failure { what, recoverable });
        }
        trial.copy_from_slice(&numbers[system.scene.layout.y()]);
    }
    let n_q = system.scene.layout.n_q;
    let moved = |a: &[f64], b: &[f64]| {
        a.iter()
            .zip(b)
            .take(n_q)
            .map(|(x, y)| (x - y).abs())
            .fold(0.0, f64::max)
    };
    // the correction should be small against the step itself, once the velocities are known
    let (step, correction) = (moved(&predicted, before), moved(trial, &predicted));
    if step > 0.0 && correction > 2.0 * step && correction > 0.5 {
        return Err(Failure {
            what: 0,
            recoverable: true,
        });
    }
    Ok(())
}
