//! Commands one after another: what a command file does to a session.

use crate::analysis::linear::Wanted;
use crate::analysis::session::state::{self, Saved};
use crate::analysis::session::{Analysis, Session};
use crate::analysis::time::output::Output;
use crate::analysis::warning::RunWarning;
use crate::analysis::watch::Watch;
use crate::dataset::command::{Command, Linear, Simulate, SimulationKind, Step};
use crate::diagnostic::{Cause, Diagnostic, Error};
use crate::disk;
use crate::model::ElementKind;
use crate::results::{Event, Status};
use std::collections::BTreeMap;

/// Output steps where a command gives neither STEPS nor DTOUT.
pub const DEFAULT_STEPS: usize = 50;

impl Simulate {
    /// Returns whether time passes in it.
    fn is_over_time(&self) -> bool {
        !matches!(
            self.kind,
            SimulationKind::Static | SimulationKind::InitialConditions
        )
    }

    /// Returns true if its END is the time that the clock shows: a command after one that was to
    /// end there at the latest.
    fn is_over(&self, now: f64) -> bool {
        self.is_over_time() && self.end == Some(now)
    }

    /// Kind, end and output steps, when the clock shows `now`.
    ///
    /// # Errors
    /// When a simulation over time has no end, or no time to go.
    pub fn resolved(&self, now: f64) -> Result<(Analysis, f64, Output), Error> {
        let analysis = match self.kind {
            SimulationKind::Kinematic => Analysis::Kinematic,
            SimulationKind::Dynamic => Analysis::Dynamic,
            SimulationKind::Static => Analysis::Static,
            SimulationKind::Transient => Analysis::Transient,
            SimulationKind::InitialConditions => Analysis::InitialConditions,
        };
        let end = self.end.or(self.duration.map(|d| now + d));
        let over_time = !matches!(analysis, Analysis::Static | Analysis::InitialConditions);
        let Some(end) = end else {
            if over_time {
                let d = Diagnostic::error("no_end", "the simulation has no end");
                return Err(d
                    .help("give END, the time at which it ends, or DURATION")
                    .into());
            }
            return Ok((analysis, now, Output::Steps(1)));
        };
        let goes_back = end < now && analysis == Analysis::Static;
        if goes_back || over_time && (end <= now || !end.is_finite()) {
            let message = format!("the simulation should end at {end}, but the clock shows {now}");
            return Err(Diagnostic::error("no_end", message)
                .help("END is absolute time; DURATION counts from here")
                .into());
        }
        let output = match (self.steps, self.dtout) {
            (Some(steps), _) => Output::Steps(steps.max(1) as usize),
            (None, Some(dt)) if dt > 0.0 => Output::Every(dt),
            _ => Output::Steps(DEFAULT_STEPS),
        };
        Ok((analysis, end, output))
    }
}

/// The bytes of a state: of one saved in this run, else of the first file of that name.
fn found(session: &Session, name: &str) -> Result<Vec<u8>, Diagnostic> {
    let file = state::file_name(name);
    if let Some(text) = session.saved.get(&file) {
        return Ok(text.clone().into_bytes());
    }
    let given = std::path::PathBuf::from(name.trim().trim_matches('"'));
    let here = std::path::PathBuf::from(".");
    let folders = session.folders.iter().chain(std::iter::once(&here));
    let mut files = folders.flat_map(|folder| [folder.join(&file), folder.join(&given)]);
    let bytes = files.find_map(|f| disk::read(&f).ok());
    bytes.ok_or_else(|| {
        Diagnostic::error("cannot_open", format!("there is no file {file}"))
            .help("SAVE/SYSTEM=file writes one, beside the results")
    })
}

/// Checks that states which are saved under several names have files of their own: of a name only
/// the last part counts.
fn states_are_apart(steps: &[Step]) -> Result<(), Error> {
    let mut names: BTreeMap<String, &str> = BTreeMap::new();
    for step in steps {
        let Command::Save(Some(name)) = &step.command else {
            continue;
        };
        let file = state::file_name(name);
        let what = format!("{file} is to hold two states");
        match names.insert(file, name) {
            Some(other) if other != name => {
                let d = Diagnostic::error("unfit_value", what).help(format!(
                    "states are kept beside the results, {other} and {name} in one file"
                ));
                return Err(located(d, step).into());
            }
            _ => {}
        }
    }
    Ok(())
}

/// Returns whether a command changes the model.
fn changes(command: &Command) -> bool {
    matches!(command, Command::Change(_) | Command::Activate { .. })
}

/// Obeys commands until one of them ends the run; how the last simulation ended.
///
/// `before` is called before each simulation with its start and its end.
///
/// # Errors
/// Mistakes in a command, or in the model as the commands have left it.
pub fn obey(
    session: &mut Session,
    steps: &[Step],
    mut before: impl FnMut(f64, f64),
    watch: &mut dyn Watch,
) -> Result<Status, Error> {
    let mut status = Status::Completed;
    states_are_apart(steps)?;
    let changed = steps.iter().filter_map(|s| match &s.command {
        Command::Change(record) if record.row.kind() == Some(ElementKind::Variable) => record.id,
        _ => None,
    });
    session.will_change(changed);
    session.run.has_phases |= has_phases(steps);
    session.records_again = record_again(steps);
    session.rows_to_come = steps.iter().map(rows).fold(0, usize::saturating_add);
    for (k, step) in steps.iter().enumerate() {
        session.rows_to_come = session.rows_to_come.saturating_sub(rows(step));
        session.run.log.push(Event::Command(step.text.clone()));
        let located = |d: Diagnostic| located(d, step);
        match &step.command {
            Command::Simulate(simulate) => {
                let ends = |step: &Step| matches!(step.command, Command::Stop);
                session.is_last = session.ends_with_commands && steps[k + 1..].iter().all(ends);
                let simulated =
                    session.obey_simulate(simulate, &steps[..=k], &mut before, watch)?;
                status = simulated.unwrap_or(status);
                if simulated.is_some() && (status != Status::Completed || session.halted()) {
                    return Ok(status);
                }
            }
            Command::Change(_) | Command::Activate { .. } => {
                let applied = session.model.apply(&step.command);
                // once for all changes up to the next command that reads the model
                let goes_on = steps.get(k + 1).is_some_and(|next| changes(&next.command));
                if applied.is_err() || !goes_on {
                    session.model_changed();
                }
                applied.map_err(|e| e.map(located))?;
            }
            Command::Stop => break,
            Command::Show(_) => {}
            Command::Linear(command) => {
                let done = session.obey_linear(command);
                done.map_err(|e| e.map(|d| blamed(d, &steps[..k])))?;
            }
            Command::Save(Some(name)) => {
                let file = state::file_name(name);
                session.saved.insert(file, session.save());
            }
            Command::Reload(Some(name)) => {
                let saved = found(session, name)
                    .map_err(Error::from)
                    .and_then(|bytes| Saved::read(&bytes))
                    .and_then(|saved| session.reload(saved));
                saved.map_err(|e| e.map(located))?;
            }
            Command::Save(None) | Command::Reload(None) => {
                let d = Diagnostic::error("missing_argument", "SYSTEM = file is needed");
                return Err(located(d).into());
            }
            Command::File { .. } => return Err(located(second_file()).into()),
        }
    }
    Ok(status)
}

/// Returns the output steps of a command, as far as it says how many there are.
fn rows(step: &Step) -> usize {
    match &step.command {
        Command::Simulate(simulate) => simulate.steps.map_or(1, |steps| steps.max(1) as usize),
        _ => 0,
    }
}

/// Returns whether simulations will have equations recorded that are much like those of before: of
/// another kind, or with elements switched on or off between them.
fn record_again(steps: &[Step]) -> bool {
    let mut before: Option<SimulationKind> = None;
    let mut is_switched = false;
    steps.iter().any(|step| match &step.command {
        Command::Simulate(simulate) => {
            let last = before.replace(simulate.kind);
            last.is_some_and(|last| is_switched || last != simulate.kind)
        }
        Command::Activate { .. } => {
            is_switched = before.is_some();
            false
        }
        _ => false,
    })
}

/// Returns whether some simulations look for rest and others do not: their rows may share a time.
fn has_phases(steps: &[Step]) -> bool {
    let kinds = steps.iter().filter_map(|step| match &step.command {
        Command::Simulate(simulate) => Some(simulate.kind == SimulationKind::Static),
        _ => None,
    });
    let kinds: Vec<bool> = kinds.collect();
    kinds.contains(&true) && kinds.contains(&false)
}

/// Gives a diagnostic the place of its command, unless it has a better one.
fn located(mut d: Diagnostic, step: &Step) -> Diagnostic {
    d.element.get_or_insert_with(|| step.text.clone());
    if d.file.is_none() && d.line == 0 {
        (d.line, d.column) = (step.line, usize::from(step.line > 0));
    }
    d
}

/// Gives a mistake in a model that commands have changed the place of the last one that has changed
/// its element, else none: a line of the dataset is none of theirs.
fn blamed(d: Diagnostic, before: &[Step]) -> Diagnostic {
    if d.file.is_some() || !before.iter().any(|s| changes(&s.command)) {
        return d;
    }
    let makes = |s: &&Step| match &s.command {
        Command::Change(record) => {
            (d.element.as_deref()).is_some_and(|e| e.eq_ignore_ascii_case(&record.element()))
        }
        _ => false,
    };
    let line = before.iter().rev().find(makes).map_or(0, |s| s.line);
    let column = usize::from(line > 0);
    Diagnostic {
        line,
        column,
        span: None,
        ..d
    }
}

fn second_file() -> Diagnostic {
    let what = "a run has one dataset and one table of results";
    Diagnostic::error(Cause::Unsupported, what).help(
        "FILE belongs at the beginning; another dataset needs a command file of its own, a saved state RELOAD/SYSTEM=file",
    )
}

impl Session {
    /// Runs one simulation as a command asks for it.
    ///
    /// With [`Session::at_rest_first`], as the set-up beside a model may ask, a first simulation
    /// over time begins at a static equilibrium, which is looked for before.
    ///
    /// # Errors
    /// Those of [`Session::simulate`] and [`Simulate::resolved`].
    pub fn simulate_as(
        &mut self,
        simulate: &Simulate,
        watch: &mut dyn Watch,
    ) -> Result<Status, Error> {
        let (analysis, end, output) = simulate.resolved(self.time())?;
        let is_first = std::mem::take(&mut self.at_rest_first) && self.run.rows() == 0;
        if is_first && simulate.is_over_time() {
            self.run.has_phases = true;
            let now = self.time();
            let status = self.simulate_with(Analysis::Static, now, Output::Steps(1), watch)?;
            if status != Status::Completed || self.halted() {
                return Ok(status);
            }
        }
        self.simulate_with(analysis, end, output, watch)
    }

    /// Obeys SIMULATE, the last of these commands; `None`: there was nothing to simulate.
    fn obey_simulate(
        &mut self,
        simulate: &Simulate,
        steps: &[Step],
        before: &mut impl FnMut(f64, f64),
        watch: &mut dyn Watch,
    ) -> Result<Option<Status>, Error> {
        let [earlier @ .., step] = steps else {
            return Ok(None);
        };
        let now = self.time();
        if simulate.is_over(now) {
            self.warn(RunWarning::NothingToSimulate {
                command: step.text.clone(),
                now,
            });
            return Ok(None);
        }
        let resolved = simulate.resolved(now);
        let (analysis, end, output) = resolved.map_err(|e| e.map(|d| located(d, step)))?;
        before(now, end);
        // what only the kind of simulation makes a mistake stands in the command
        let placed = |d: Diagnostic| match d.is(Cause::Freedom) {
            true => located(d, step),
            false => blamed(d, earlier),
        };
        let status = self.simulate_with(analysis, end, output, watch);
        status.map(Some).map_err(|e| e.map(placed))
    }

    /// Obeys LINEAR.
    fn obey_linear(&mut self, command: &Linear) -> Result<(), Error> {
        let shapes = match command.coords[..] {
            [] => None,
            [only] => Some([only as usize; 2]),
            [first, last, ..] => Some([first as usize, last as usize]),
        };
        let wanted = Wanted {
            inputs: command.pinput,
            outputs: command.poutput,
            no_damping: command.no_damping,
            shapes,
        };
        let found = self.linearize(&wanted)?;
        let matrices = command.state_matrices || !command.eigensolution;
        self.linear.push((command.file.clone(), matrices, found));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::session::Options;
    use crate::analysis::watch::Unwatched;
    use crate::dataset::command::Script;
    use crate::dataset::manual;
    use crate::model::Model;

    #[test]
    fn simulations_that_are_known_beforehand_have_the_bits_of_others() {
        let commands = "FILE/MODEL=m\nSIMULATE/INITIAL_CONDITIONS\n\
            SIMULATE/TRANSIENT, END=0.004, STEPS=2\nSIMULATE/TRANSIENT, END=0.03, STEPS=70\n";
        let steps = Script::from_text(commands).expect("commands").steps;
        assert!(record_again(&steps) && !record_again(&steps[1..]));
        let mut n_compared = 0;
        for example in manual::examples() {
            let Ok(model) = Model::from_text(example.dataset) else {
                continue;
            };
            let run = |parts: &[&[Step]]| {
                let mut session = Session::new(model.clone(), "m", Options::default());
                let mut obey =
                    |steps: &&[Step]| obey(&mut session, steps, |_, _| (), &mut Unwatched).is_ok();
                let obeyed = parts.iter().all(&mut obey);
                let values = session.run.columns.iter().flat_map(|c| &c.values);
                // numbers that are none have no sign
                let plain = |x: &f64| if x.is_nan() { f64::NAN } else { *x };
                let bits = values.map(|x| plain(x).to_bits());
                (obeyed, bits.collect::<Vec<u64>>())
            };
            let (together, one_by_one) =
                (run(&[&steps]), run(&steps.chunks(1).collect::<Vec<_>>()));
            assert_eq!(together, one_by_one, "{}", example.name);
            n_compared += together.1.len();
        }
        assert!(n_compared > 4000, "{n_compared}");
    }
}
