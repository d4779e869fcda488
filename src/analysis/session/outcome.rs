//! Outcomes of simulations, as a run tells them: rows of results, facts of the record, how it ended
//! and which element is to blame.

use super::Session;
use super::growth;
use super::stop_reason::{Cause, StopReason};
use crate::analysis::start::assemble::{Assembly, Redundant};
use crate::analysis::start::{alignment, open_reactions};
use crate::analysis::system::System;
use crate::analysis::time::{ranks, valueless};
use crate::analysis::trajectory::{Ended, EnergyFlow, Limited, Trajectory};
use crate::analysis::verify::culprit;
use crate::analysis::warning::{RunWarning, Warning};
use crate::arrange::Arrange;
use crate::diagnostic::Subject;
use crate::model::Model;
use crate::numeric::{Reason, Stop};
use crate::results::{self, Counts, Event, RowChange, Status};
use crate::scene::equations::row_name;

impl Session {
    /// Adds a simulation that has ended to the record; how it ended. `stopped`: why it ended early.
    pub(super) fn close(
        &mut self,
        mut simulation: results::Simulation,
        stopped: Option<StopReason>,
    ) -> Status {
        if let Some(why) = stopped {
            simulation.status = why.status();
            simulation.stop_code = why.code();
            simulation.stop_reason = why.to_string();
            simulation.worst = why.worst();
        }
        let record = &mut self.run.record;
        record.counts += simulation.counts;
        record.seconds.solve += simulation.solve_seconds;
        record.solve_processor_seconds += simulation.solve_processor_seconds;
        record.method.clone_from(&simulation.method);
        record.status = simulation.status;
        record.stop_code = simulation.stop_code;
        record.stop_reason.clone_from(&simulation.stop_reason);
        record.simulations.push(simulation);
        record.status
    }

    /// Tells when and where the rank of the rows changed.
    pub(super) fn rank_changes(
        &mut self,
        system: &System,
        chosen: Vec<bool>,
        trajectory: &Trajectory,
    ) {
        let names = |active: &[bool]| -> Vec<String> {
            let rows = system.scene.rows.iter().zip(active);
            rows.filter(|r| *r.1).map(|r| row_name(r.0)).collect()
        };
        let mut told = Vec::new();
        let scene = &system.scene;
        let mut configuration = system.configuration.clone();
        configuration.active = chosen;
        let found = ranks::passes(scene.within(&configuration), system, &trajectory.weak);
        for pass in found.iter().chain(&trajectory.passes) {
            told.push(results::RankChange {
                time: pass.t,
                change: RowChange::Passes,
                rows: pass.rows.clone(),
                place: pass.place.clone(),
            });
        }
        for (_, t, active) in &trajectory.selections {
            let before = names(&configuration.active);
            let rows = names(active)
                .into_iter()
                .filter(|r| !before.contains(r))
                .collect();
            configuration.active.clone_from(active);
            told.push(results::RankChange {
                time: *t,
                change: RowChange::Exchanged,
                rows,
                place: Vec::new(),
            });
        }
        for &(t, row) in &trajectory.restored {
            told.push(results::RankChange {
                time: t,
                change: RowChange::Restored,
                rows: vec![row_name(&scene.rows[row])],
                place: Vec::new(),
            });
        }
        for &(at, row, off) in &trajectory.beyond {
            self.warn(RunWarning::BeyondTolerance {
                at,
                element: scene.rows[row].element,
                equation: scene.rows[row].equation.clone(),
                off,
                is_length: alignment::is_length(scene, row),
                unit: scene.length_unit.clone(),
            });
        }
        told.arrange_by(|a, b| a.time.total_cmp(&b.time));
        for change in told.iter().take(20) {
            self.warn(RunWarning::Rank(change.clone()));
        }
        self.run.record.rank_changes.extend(told);
    }

    /// Adds a warning to the record and the log, unless it has been given before.
    pub(in crate::analysis) fn warn(&mut self, what: impl Into<Warning>) {
        let warning = what.into().record(&self.model);
        if !self.run.record.warnings.contains(&warning) {
            self.run.log.push(Event::Warning(warning.sentence()));
            self.run.record.warnings.push(warning);
        }
    }

    /// Freedom and redundancy, told once and whenever they change.
    pub(super) fn first_facts(&mut self, system: &System, assembly: &Assembly) {
        let name = |r: &Redundant| {
            let row = &system.scene.rows[r.row];
            let element = self.model.element(row.element);
            let name = element.and_then(|e| e.place().name.as_deref());
            Subject::part_of(row.element, row.equation.as_str()).named(name)
        };
        let names: Vec<String> = assembly.redundant.iter().map(name).collect();
        if self.run.record.redundant != names && !names.is_empty() {
            let rows = &system.scene.rows;
            let equations = assembly
                .redundant
                .iter()
                .map(|r| {
                    (
                        rows[r.row].equation.clone(),
                        rows[r.row].element.to_string(),
                    )
                })
                .collect();
            self.run.log.push(Event::Redundant {
                time: self.time(),
                equations,
            });
        }
        let (here, numbers) = (system.configured(), &system.numbers);
        for warning in open_reactions::read_by_loads(here, numbers, &assembly.redundant) {
            self.warn(warning);
        }
        self.run.record.redundant = names;
        self.run.record.freedom = assembly.freedom as i64;
    }

    /// Tells which constraints lock the mechanism whatever its motions prescribe, if any do.
    pub(super) fn warn_of_locks(&mut self) {
        let locks = culprit::locked_without_motions(&self.model).unwrap_or_default();
        for lock in locks {
            self.warn(RunWarning::LockedWithoutMotions(lock));
        }
    }

    /// Why a simulation over time ended early; `None`: all was done.
    pub(super) fn stop_reason(
        &self,
        system: &mut System,
        trajectory: &Trajectory,
        end: f64,
    ) -> Option<StopReason> {
        Some(match trajectory.ended.as_ref()? {
            Ended::Interrupted => self.ended_on_the_way(system, trajectory, end),
            Ended::Sensor(k) => StopReason::Sensor {
                id: system.scene.sensors[*k].id,
                at: trajectory.t.last().copied().unwrap_or(self.time()),
            },
            Ended::Broken { t, broken } => StopReason::Contact {
                at: *t,
                broken: broken.clone(),
            },
            Ended::RunsAway(away) => StopReason::RunsAway {
                away: *away,
                fed_by: growth::fed_by(system, trajectory.rows.last().unwrap_or(&system.numbers)),
            },
            Ended::Downstream {
                stop,
                stands,
                rates,
            } => downstream(system, stop, (stands, rates)),
            Ended::Stop(stop) => {
                let stands = trajectory.rows.last().unwrap_or(&system.numbers);
                explained(system, stop, stands)
            }
        })
    }

    /// Adds the energies and works of a simulation to the account of the run. Where nothing `moved`
    /// the balance is one of rounding, and has no error.
    pub(super) fn account(&mut self, flow: &EnergyFlow, moved: bool) {
        let Some(start) = flow.start else {
            return;
        };
        let moves = |s: &results::Simulation| {
            matches!(s.kind, results::Kind::Dynamic | results::Kind::Kinematic)
        };
        let first = !self.run.record.simulations.iter().any(moves);
        let energy = &mut self.run.record.energy;
        if first {
            (energy.kinetic[0], energy.potential[0]) = (start[0], start[1]);
        }
        (energy.kinetic[1], energy.potential[1]) = (flow.end[0], flow.end[1]);
        let [given_back, of_damping, of_functions, of_motions] = flow.works;
        energy.stored -= given_back;
        energy.dissipated -= of_damping;
        energy.by_functions += of_functions;
        energy.by_motions += of_motions;
        if moved {
            energy.scale = energy.scale.max(flow.scale);
            energy.imbalance = energy.imbalance.max(flow.imbalance);
        }
    }
}

pub(super) fn counts(stats: &crate::numeric::Stats, limited: Limited) -> Counts {
    Counts {
        steps: stats.steps as u64,
        rejected_steps: stats.rejected as u64,
        evaluations: stats.evaluations as u64,
        jacobians: stats.jacobians as u64,
        factorizations: stats.factorizations as u64,
        stability_limited: stats.stability_limited as u64,
        event_limited: limited.events as u64,
        output_limited: limited.outputs as u64,
    }
}

/// Why a method stopped: the function that lost its value, the row that locks, or else what the
/// method met.
fn explained(system: &System, stop: &Stop, stands: &[f64]) -> StopReason {
    let (scene, at) = (system.configured(), stop.t);
    let may_lack_a_value = !matches!(stop.reason, Reason::TooManySteps | Reason::Projection(_));
    if may_lack_a_value && let Some(lost) = valueless::find(scene, stands, &[]) {
        return StopReason::Function { at, lost };
    }
    let may_be_locked = !matches!(stop.reason, Reason::TooManySteps | Reason::Singular(_));
    if may_be_locked && let Some(lock) = ranks::locked(scene, stands) {
        return StopReason::Locked { at, lock };
    }
    let (cause, worst) = cause(system, stop.reason);
    StopReason::Method {
        at,
        step: stop.h,
        cause,
        worst,
    }
}

/// Why states downstream of the mechanism could not go on where all numbers and their own rates are
/// these.
fn downstream(system: &System, stop: &Stop, (stands, rates): (&[f64], &[f64])) -> StopReason {
    let scene = system.configured();
    let may_lack_a_value = !matches!(stop.reason, Reason::TooManySteps);
    if may_lack_a_value && let Some(lost) = valueless::find(scene, stands, rates) {
        return StopReason::Function { at: stop.t, lost };
    }
    let names = scene.downstream().iter().map(ToString::to_string);
    let (cause, worst) = cause_among(system, stop.reason, names.collect());
    StopReason::Method {
        at: stop.t,
        step: stop.h,
        cause,
        worst,
    }
}

/// Returns the obstacle that a method met, and the name of the worst unknown or row.
fn cause(system: &System, reason: Reason) -> (Cause, String) {
    let scene = &system.scene;
    cause_among(system, reason, scene.unknown_names())
}

/// Returns the obstacle that a method met, and the worst of the unknowns of these names.
fn cause_among(system: &System, reason: Reason, names: Vec<String>) -> (Cause, String) {
    let scene = &system.scene;
    let unknown = |k: usize| match (names.get(k), k.checked_sub(names.len())) {
        (Some(name), _) => name.clone(),
        (None, loops) => loops
            .and_then(|k| scene.loops.get(k))
            .map_or_else(|| format!("unknown {k}"), |u| u.asker.to_string()),
    };
    match reason {
        Reason::Evaluation(f) if f.what >= names.len() => (Cause::Loop, unknown(f.what)),
        Reason::Evaluation(f) => (Cause::Equations, unknown(f.what)),
        Reason::NotFinite(k) => (Cause::Rate, unknown(k)),
        Reason::Projection(f) => {
            let row = scene.rows.get(f.what);
            let name = row.map_or_else(|| "the constraints".into(), row_name);
            (Cause::Projection, name)
        }
        Reason::ErrorTest(k) => (Cause::ErrorTest, unknown(k)),
        Reason::Newton(k) => (Cause::Newton, unknown(k)),
        Reason::Singular(k) => (Cause::Singular, unknown(k)),
        Reason::Endless(k) => (Cause::Endless, unknown(k)),
        Reason::Stalled(k) => (Cause::Stalled, unknown(k)),
        Reason::TooManySteps => (Cause::TooManySteps, String::new()),
    }
}

/// Units of a model as result files spell them.
pub(super) fn units(model: &Model) -> results::Units {
    let mut units = results::Units::default();
    if let Some(u) = &model.units {
        let spell = |name: &str| {
            match name {
                "MILLIMETER" => "mm",
                "CENTIMETER" => "cm",
                "KILOGRAM" => "kg",
                "SECOND" => "sec",
                other => return other.to_ascii_lowercase(),
            }
            .to_string()
        };
        units.length = spell(&u.length);
        units.mass = spell(&u.mass);
        units.time = spell(&u.time);
        units.force = spell(&u.force);
    }
    units
}
