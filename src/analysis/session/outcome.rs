//! What a run tells about its simulations: rows of results, facts of the record, how it ended and which element is to blame.

use super::Session;
use crate::analysis::session::columns;
use crate::analysis::start::assemble::Assembly;
use crate::analysis::system::System;
use crate::analysis::time::trajectory::{Ended, Trajectory};
use crate::analysis::time::{ranks, valueless};
use crate::model::Model;
use crate::numeric::{Reason, Stop};
use crate::results::{self, Counts, Event, Kind, Status};
use crate::scene::build::unknown_names;
use crate::scene::equations::row_name;

impl Session {
    /// Adds a simulation that has ended to the record; how it ended.
    pub(super) fn close(&mut self, simulation: results::Simulation) -> Status {
        let record = &mut self.run.record;
        record.counts += simulation.counts;
        record.solve_seconds += simulation.solve_seconds;
        record.method.clone_from(&simulation.method);
        record.status = simulation.status;
        record.stop_reason.clone_from(&simulation.stop_reason);
        record.simulations.push(simulation);
        record.status
    }

    pub(super) fn rows(
        &mut self,
        kind: Kind,
        program: &crate::expr::program::Program,
        rows: &[Vec<f64>],
    ) {
        self.run.begin(kind);
        columns::append(&mut self.run, program, rows);
        self.run.end();
        self.told_of_gaps(rows.len());
    }

    /// Names the columns that have values, but not in all of the last rows.
    fn told_of_gaps(&mut self, n: usize) {
        let from = self.run.rows().saturating_sub(n);
        let time = &self.run.columns[0].values;
        let gap = |column: &results::Column| -> Option<String> {
            let gap = column.values[from..].iter().position(|x| !x.is_finite())?;
            let some = column.values.iter().any(|x| x.is_finite());
            some.then(|| {
                format!(
                    "{} has no finite value at time {}",
                    column.name,
                    time[from + gap]
                )
            })
        };
        let known = |what: &String| {
            let name = what.split(" has no").next().unwrap_or_default();
            let told = format!("{name} has no finite value");
            self.run
                .record
                .warnings
                .iter()
                .any(|w| w.starts_with(&told))
        };
        let gaps: Vec<String> = self
            .run
            .columns
            .iter()
            .filter_map(gap)
            .filter(|w| !known(w))
            .collect();
        for what in gaps {
            self.warn(&what);
        }
    }

    /// The rows of a simulation, each with the columns of the rows that took part there.
    pub(super) fn selected_rows(
        &mut self,
        kind: Kind,
        program: &crate::expr::program::Program,
        system: &System,
        trajectory: &Trajectory,
    ) {
        self.run.begin(kind);
        let mut from = 0;
        let mut program = program.clone();
        for (until, _, active) in &trajectory.selections {
            columns::append(&mut self.run, &program, &trajectory.rows[from..*until]);
            let mut scene = system.scene.clone();
            scene.active.clone_from(active);
            (program, from) = (self.columns.program(&scene).0, *until);
        }
        columns::append(&mut self.run, &program, &trajectory.rows[from..]);
        self.run.end();
        self.told_of_gaps(trajectory.rows.len());
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
        let mut scene = system.scene.clone();
        scene.active = chosen;
        let n = scene.layout.n_v as f64;
        // looking costs n³ per state
        if n.powi(3) * trajectory.weak.len() as f64 <= 1e9 {
            for pass in ranks::passes(&scene, &trajectory.weak) {
                told.push(results::RankChange {
                    time: pass.t,
                    what: "passes",
                    rows: pass.rows,
                    place: pass.place,
                });
            }
        }
        for (_, t, active) in &trajectory.selections {
            let before = names(&scene.active);
            let rows = names(active)
                .into_iter()
                .filter(|r| !before.contains(r))
                .collect();
            scene.active.clone_from(active);
            told.push(results::RankChange {
                time: *t,
                what: "other rows",
                rows,
                place: Vec::new(),
            });
        }
        for &(t, row) in &trajectory.restored {
            told.push(results::RankChange {
                time: t,
                what: "restored",
                rows: vec![row_name(&scene.rows[row])],
                place: Vec::new(),
            });
        }
        told.sort_by(|a, b| a.time.total_cmp(&b.time));
        for change in told.iter().take(20) {
            let rows = change.rows.join(", ");
            let time = change.time;
            self.warn(&match change.what {
                "passes" => format!(
                    "at time {time:.9} the rank of the constraints falls in passing: {rows} depends on others where {}",
                    ranks::words(&change.place)
                ),
                "restored" => format!("at time {time:.9} {rows} no longer follows from the others; it is kept from there"),
                _ => format!("at time {time:.9} other rows are kept: {rows} in place of what they make superfluous"),
            });
        }
        self.run.record.rank_changes.extend(told);
    }

    pub(in crate::analysis) fn warn(&mut self, what: &str) {
        if !self.run.record.warnings.iter().any(|w| w == what) {
            self.run.record.warnings.push(what.to_string());
            self.run.log.push(Event::Warning(what.to_string()));
        }
    }

    /// Freedom and redundancy, told once and whenever they change.
    pub(super) fn first_facts(&mut self, system: &System, assembly: &Assembly) {
        let names: Vec<String> = assembly.redundant.iter().map(|r| r.name.clone()).collect();
        if self.run.record.redundant != names && !names.is_empty() {
            let rows = &system.scene.rows;
            let equations = assembly
                .redundant
                .iter()
                .map(|r| (rows[r.row].equation.clone(), rows[r.row].element.clone()))
                .collect();
            self.run.log.push(Event::Redundant {
                time: self.time(),
                equations,
            });
        }
        self.run.record.redundant = names;
        self.run.record.freedom = assembly.freedom as i64;
    }

    /// Status, a sentence, and the names of what was worst.
    pub(super) fn outcome(
        &self,
        system: &System,
        trajectory: &Trajectory,
    ) -> (Status, String, Vec<String>) {
        match &trajectory.ended {
            None => (Status::Completed, String::new(), Vec::new()),
            Some(Ended::Interrupted) => (
                Status::Interrupted,
                "interrupted; the results so far are kept".into(),
                Vec::new(),
            ),
            Some(Ended::Sensor(k)) => {
                let name = format!("SENSOR/{}", system.scene.sensors[*k].id);
                let at = trajectory.t.last().copied().unwrap_or(self.time());
                let reason = format!("{name} ended the simulation at time {at}");
                (Status::Completed, reason, Vec::new())
            }
            Some(Ended::Broken { t, broken }) => (
                Status::Stopped,
                format!(
                    "stopped at time {t}: {}; {}",
                    broken.sentence, broken.advice
                ),
                vec![broken.element.clone()],
            ),
            Some(Ended::Stop(stop)) => {
                let (status, mut sentence, mut worst) = explain(system, stop);
                let stands = trajectory.rows.last().unwrap_or(&system.numbers);
                let lost = !matches!(stop.reason, Reason::TooManySteps | Reason::Projection(_));
                if let Some(why) = lost
                    .then(|| valueless::named(&system.scene, stands))
                    .flatten()
                {
                    sentence = format!("stopped at time {}: {why}", stop.t);
                    worst = why.split(':').next().unwrap_or_default().to_string();
                    return (status, sentence, vec![worst]);
                }
                let rows = !matches!(stop.reason, Reason::TooManySteps | Reason::Singular(_));
                if let (true, Some(lock)) = (rows, ranks::locked(&system.scene, stands)) {
                    let why = match &lock.motion {
                        Some(motion) => format!(
                            "the mechanism is locked: {motion} drives it past its reach, {} cannot follow",
                            lock.row
                        ),
                        None => format!(
                            "the constraints can be kept no longer: {} has become dependent on others",
                            lock.row
                        ),
                    };
                    sentence = format!(
                        "stopped at time {}: {why}, where {}",
                        stop.t,
                        ranks::words(&lock.place)
                    );
                    worst = lock.row;
                }
                (status, sentence, vec![worst])
            }
        }
    }

    /// Energy and constraint drift over the rows of a simulation.
    pub(super) fn drift(&mut self, system: &System, first: &[f64], rows: &[Vec<f64>]) {
        let scene = &system.scene;
        let n_rows = scene.rows.len();
        if self.account.is_none() {
            let program = crate::scene::programs::record(scene, |at| {
                let [kinetic, potential] = at.energy();
                let mut out = vec![kinetic, potential];
                out.extend((0..n_rows).map(|r| at.row(r).value));
                out
            });
            self.account = program.ok();
        }
        let Some(program) = self.account.clone() else {
            return;
        };
        let mut work = crate::expr::program::Work::default();
        let mut out = vec![0.0; 2 + n_rows];
        let (mut worst, mut scale, mut change, mut start) = (0.0_f64, 0.0_f64, 0.0_f64, None);
        for row in std::iter::once(first).chain(rows.iter().map(Vec::as_slice)) {
            program.run(row, &mut work, &mut out);
            let energy = out[0] + out[1];
            let begin = *start.get_or_insert(energy);
            change = change.max((energy - begin).abs());
            scale = scale.max(out[0].abs()).max(out[1].abs());
            worst = out[2..].iter().fold(worst, |m, g| m.max(g.abs()));
        }
        let conservative = scene.forces.is_empty() && scene.motions.is_empty();
        let record = &mut self.run.record;
        if conservative && scale > 0.0 {
            record.energy_drift = Some(record.energy_drift.unwrap_or(0.0).max(change / scale));
        }
        if n_rows > 0 {
            record.constraint_drift = Some(record.constraint_drift.unwrap_or(0.0).max(worst));
        }
    }
}

pub(super) fn counts(stats: &crate::numeric::Stats) -> Counts {
    Counts {
        steps: stats.steps as u64,
        rejected_steps: stats.rejected as u64,
        evaluations: stats.evaluations as u64,
        jacobians: stats.jacobians as u64,
        factorizations: stats.factorizations as u64,
    }
}

/// A stop in words: status, sentence, and the name of the worst unknown or row.
pub(super) fn explain(system: &System, stop: &Stop) -> (Status, String, String) {
    let scene = &system.scene;
    let mut names = unknown_names(scene);
    // what a method for implicit equations sees after the unknowns
    let multipliers = system.implicit_size().saturating_sub(names.len());
    let rows = (0..scene.rows.len()).filter(|&r| scene.active.get(r).copied().unwrap_or(true));
    let rows: Vec<String> = rows
        .map(|r| format!("multiplier of {}", row_name(&scene.rows[r])))
        .collect();
    names.extend(rows.iter().cycle().take(multipliers).cloned());
    let unknown = |k: usize| match (names.get(k), k.checked_sub(names.len())) {
        (Some(name), _) => name.clone(),
        (None, loops) => loops
            .and_then(|k| scene.loops.get(k))
            .map_or_else(|| format!("unknown {k}"), |u| u.name.clone()),
    };
    let n = names.len();
    let (status, what, worst) = match stop.reason {
        Reason::Evaluation(f) if f.what >= n => (
            Status::Stopped,
            "a function that depends on itself has no solution near",
            unknown(f.what),
        ),
        Reason::Evaluation(f) => (
            Status::Stopped,
            "the equations have no finite value",
            unknown(f.what),
        ),
        Reason::NotFinite(k) => (Status::Stopped, "a rate is not a number", unknown(k)),
        Reason::Projection(f) => {
            let name = scene
                .rows
                .get(f.what)
                .map_or_else(|| "the constraints".into(), row_name);
            (
                Status::Stopped,
                "the constraints cannot be kept: the mechanism is locked or folds",
                name,
            )
        }
        Reason::ErrorTest(k) => (
            Status::Stopped,
            "the error stays above its tolerance however short the step",
            unknown(k),
        ),
        Reason::Newton(k) => (
            Status::Stopped,
            "Newton's iteration does not converge however short the step",
            unknown(k),
        ),
        Reason::Singular(k) => (Status::Stopped, "nothing determines an unknown", unknown(k)),
        Reason::Endless(k) => (
            Status::Stopped,
            "a function changes its branch without end; let it change over a short way, as STEP does",
            unknown(k),
        ),
        Reason::Stalled(k) => (
            Status::Stopped,
            "thousands of steps got hardly any further; something is too stiff or changes too fast for this method",
            unknown(k),
        ),
        Reason::TooManySteps => (Status::Limit, "as many steps as permitted", String::new()),
    };
    let sentence = format!(
        "stopped at time {} with step {:.3e}: {what} ({worst})",
        stop.t, stop.h
    );
    (status, sentence, worst)
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
