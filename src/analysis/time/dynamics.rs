//! Integration over time: one method after another, each as far as it is the right one.
//!
//! `Leg` is the loop over the steps of one method. Here it is decided with which method, and
//! with which rows, the next leg begins.

use crate::analysis::system::System;
use crate::analysis::time::leg::{Finished, Leg, Limits};
use crate::analysis::time::options::Options;
use crate::analysis::time::trajectory::{Ended, Trajectory};
use crate::analysis::watch::Watch;
use crate::numeric::{self, Method, Ode, Reason, Stop};
use crate::scene::layout::Layout;
use std::collections::BTreeMap;

/// Restarts with other rows before something is wrong.
const MAX_ROW_RESTARTS: usize = 10_000;

/// Integrates from the state in `system.numbers` through all `outputs` (ascending, after the
/// state's time).
pub fn integrate(
    system: &mut System,
    outputs: &[f64],
    options: &Options,
    watch: &mut dyn Watch,
) -> Trajectory {
    let mut out = Trajectory::default();
    let Some(&end) = outputs.last() else {
        return out;
    };
    let n = Ode::size(system);
    let t0 = system.numbers[Layout::TIME];
    let mut y = system.numbers[system.scene.layout.y()].to_vec();
    system.precision = options.error;
    system.external.begin(t0, &BTreeMap::new());
    system.restart_sampling();
    system.begin_sensing();
    if n == 0 {
        timeless(system, outputs, options.max_steps, &mut out);
        return out;
    }
    let mut outputs = outputs.to_vec();
    let landings = system.landings(t0, end);
    let mut name = options.first_name();
    let mut t = t0;
    let mut restarts = 0;
    loop {
        // the method, and its state: that of an implicit one has multipliers, found anew
        let attempted = out.stats.steps + out.stats.rejected;
        let max_steps = options.max_steps.saturating_sub(attempted);
        let Some(mut method) = options.new_method(&name, system, max_steps) else {
            out.ended = Some(gave_up(t));
            return out;
        };
        out.begin_method(t, &name);
        let implicit = numeric::is_implicit(&name);
        y.resize(n.max(system.implicit_size()), 0.0);
        let state = if implicit { &y[..] } else { &y[..n] };
        // steps, as far as it goes
        let limits = Limits {
            start: t,
            end,
            landings: &landings,
            max_steps,
            may_change: options.is_auto() && name == "DOP853",
            may_slide: !implicit,
        };
        let mut leg = Leg::new(system, watch, limits, (&mut out, &mut outputs), state.len());
        let finished = leg.run(method.as_mut(), state);
        out.add_cost(method.stats());
        system.branches_mut().release();
        // another method, or other rows
        y.truncate(n);
        match finished {
            Ok(()) => return out,
            Err(Finished::Ended(why)) => {
                end_there(system, method.as_ref(), why, t0, &mut out);
                return out;
            }
            Err(Finished::Rows(state)) => {
                restarts += 1;
                if restarts > MAX_ROW_RESTARTS {
                    out.ended = Some(gave_up(method.t()));
                    return out;
                }
                y.copy_from_slice(&state[..n]);
            }
            Err(Finished::Stiff | Finished::Slides) => {
                y.copy_from_slice(&method.y()[..n]);
                name = "RADAU5".into();
            }
        }
        t = method.t();
    }
}

fn gave_up(t: f64) -> Ended {
    let (reason, h) = (Reason::TooManySteps, 0.0);
    Ended::Stop(Stop { reason, t, h })
}

/// Ends a trajectory; the place where a method could not go on is part of the results.
fn end_there(
    system: &mut System,
    method: &dyn Method<System>,
    why: Ended,
    t0: f64,
    out: &mut Trajectory,
) {
    let t = method.t();
    if matches!(why, Ended::Stop(_)) && out.ends_before(t) && t > t0 {
        let row = system.row(t, method.y());
        out.push(t, row);
    }
    out.ended = Some(why);
}

/// Lets time pass in a model without unknowns, in which only samples change.
fn timeless(system: &mut System, outputs: &[f64], max_steps: usize, out: &mut Trajectory) {
    for &t in outputs {
        loop {
            let due = system.samples.due();
            if due > t {
                break;
            }
            out.stats.steps += 1;
            if out.stats.steps > max_steps {
                out.ended = Some(gave_up(due));
                return;
            }
            system.sample(due, &[]);
        }
        let row = system.row(t, &[]);
        out.push(t, row);
    }
}
