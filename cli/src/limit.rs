//! `--limit`: durations as people type them, and the guard that ends a run whose limit has been
//! reached, or whose user has asked to stop, where nothing looks at it.
//!
//! A session looks at its limit, and at Ctrl-C, after each step and each phase of setting up. One
//! phase of a large model may take longer than all that is permitted: then the guard writes what
//! earlier simulations have left, and ends the process.

use super::output::Tables;
use super::{Exit, complain, interrupt, piped, remark, summary};
use cognate::analysis::session::{Activity, Session};
use cognate::analysis::work_limit::ProcessClock;
use cognate::dataset::command::{Command, Step};
use cognate::results::{Event, Run, Status};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time between two looks at the clock of the processor.
const LOOK: Duration = Duration::from_millis(100);
/// Code of the reason, which `cognate explain` knows.
const WORK_LIMIT: &str = "work_limit";
/// The same for a user who asked to stop.
const INTERRUPTED: &str = "interrupted";
/// Processor time beyond the limit in which a session can end by itself: seconds, and a part of the
/// limit.
const GRACE: [f64; 2] = [1.0, 0.1];
/// Part of the time of a run that copies of its results may take where there is no limit.
const COPYING_SHARE: f64 = 0.05;

/// Reads a duration, in s: `60`, `60s`, `500ms`, `2min`, `1h`.
///
/// # Errors
/// The forms that there are.
pub fn seconds(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let units = [("ms", 1e-3), ("min", 60.0), ("s", 1.0), ("h", 3600.0)];
    let unit = units.iter().find_map(|(unit, one)| {
        let number = text.strip_suffix(unit)?;
        Some((number.trim(), *one))
    });
    let (number, one) = unit.unwrap_or((text, 1.0));
    match number.parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok(number * one),
        Ok(_) | Err(_) => {
            Err("a duration is a positive number of seconds, or as 500ms, 60s, 2min, 1h".into())
        }
    }
}

/// Returns the number of commands that simulate, if only writing is left after the last of them;
/// `None`: other commands come then, whose work has results to lose.
pub fn simulations_to_the_end(steps: &[Step]) -> Option<usize> {
    let simulates = |step: &&Step| matches!(step.command, Command::Simulate(_));
    let last = steps.iter().rfind(|s| !matches!(s.command, Command::Stop));
    last.filter(simulates)?;
    Some(steps.iter().filter(simulates).count())
}

/// The state that the guard shares with the run.
struct Shared {
    /// results of the simulations that have ended
    run: Option<Run>,
    /// the activity of the session
    activity: Option<Activity>,
    /// the files of the run; `None`: the model is being read
    tables: Option<Tables>,
    /// whether simulations have ended since, of which there is no copy
    is_stale: bool,
    /// time that copies have taken
    copying: Duration,
    /// the run writes its results: the guard has nothing left to do
    is_done: bool,
}

/// A thread that ends the process when a limit has been exceeded, or the user asked to stop, and
/// nobody has seen it.
#[derive(Clone)]
pub struct Guard {
    shared: Arc<Mutex<Shared>>,
    /// whether a simulation takes steps, and looks by itself
    moves: Arc<AtomicBool>,
    limit: Option<f64>,
    clock: ProcessClock,
}

/// A reason to end the process.
#[derive(Clone, Copy, Debug)]
enum Ending {
    /// the limit is exceeded, in s
    Limit(f64),
    /// the user asked to stop
    Asked,
}

impl Guard {
    /// Sets a guard over a run, which may use so many seconds of processor time by its clock.
    pub fn set(limit: Option<f64>, clock: ProcessClock) -> Self {
        let shared = Shared {
            run: None,
            activity: None,
            tables: None,
            is_stale: false,
            copying: Duration::ZERO,
            is_done: false,
        };
        let guard = Self {
            shared: Arc::new(Mutex::new(shared)),
            moves: Arc::default(),
            limit,
            clock,
        };
        let watched = guard.clone();
        let watch = move || watched.watch();
        if std::thread::Builder::new().spawn(watch).is_err() {
            remark(
                "no thread can be had here: nothing watches the run, which ends early between its steps alone",
            );
        }
        guard
    }

    fn with<T>(&self, f: impl FnOnce(&mut Shared) -> T) -> T {
        f(&mut self.shared.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Tells what a session is doing, for the guard to say, and where its results go.
    pub fn follow(&self, session: &Session, tables: &Tables) {
        self.with(|shared| {
            shared.run = self.limit.map(|_| session.run.clone());
            shared.activity = Some(session.activity());
            shared.tables = Some(tables.clone());
        });
    }

    /// Notes that a simulation takes steps.
    pub fn moves(&self) {
        self.moves.store(true, Ordering::Relaxed);
    }

    /// Keeps the results so far; where there is no limit and copies take long beside the run, only
    /// that they are there. Such a run looks for itself often enough.
    pub fn keep(&self, run: &Run) {
        self.moves.store(false, Ordering::Relaxed);
        self.with(|shared| {
            let permitted = self.clock.elapsed().mul_f64(COPYING_SHARE);
            if self.limit.is_none() && shared.copying > permitted {
                shared.is_stale = true;
                return;
            }
            let clock = Instant::now();
            match &mut shared.run {
                Some(kept) => kept.catch_up(run),
                None => shared.run = Some(run.clone()),
            }
            shared.copying += clock.elapsed();
            shared.is_stale = false;
        });
    }

    /// Ends the guard: the run ends by itself.
    pub fn done(&self) {
        self.with(|shared| shared.is_done = true);
    }

    /// Waits until there is a reason to end the process, or the run is done.
    fn watch(&self) {
        let mut asked: Option<Instant> = None;
        loop {
            std::thread::sleep(LOOK);
            asked = asked.or_else(|| interrupt::is_unseen().then(Instant::now));
            let ending = self.ending(asked);
            self.with(|shared| {
                let is_kept = shared.run.is_some() && !shared.is_stale;
                let ending = ending.filter(|e| matches!(e, Ending::Limit(_)) || is_kept);
                if let Some(ending) = ending.filter(|_| !shared.is_done) {
                    // held until the process has ended: nobody else writes
                    end(shared, ending);
                }
            });
            if self.with(|shared| shared.is_done) {
                return;
            }
        }
    }

    /// Returns a reason to end the process. `asked`: when it was seen that the user asked to stop.
    fn ending(&self, asked: Option<Instant>) -> Option<Ending> {
        let is_over = self.limit.filter(|limit| {
            let [seconds, part] = GRACE;
            self.clock.seconds() > limit + seconds.max(part * limit)
        });
        let waited = asked.is_some_and(|asked| asked.elapsed() >= interrupt::PATIENCE);
        let is_blind = waited && interrupt::is_unseen() && !self.moves.load(Ordering::Relaxed);
        is_over
            .map(Ending::Limit)
            .or(is_blind.then_some(Ending::Asked))
    }
}

/// Writes the results of the simulations that have ended, and ends the process.
fn end(shared: &mut Shared, ending: Ending) -> ! {
    let activity = shared.activity.as_ref().map(ToString::to_string);
    let activity = activity.unwrap_or_else(|| "the model was being read".into());
    let (status, code, exit, reason) = match ending {
        Ending::Limit(limit) => (
            Status::Limit,
            WORK_LIMIT,
            Exit::Limit,
            format!("the limit of {limit} s of processor time was exceeded"),
        ),
        Ending::Asked => (
            Status::Interrupted,
            INTERRUPTED,
            Exit::Interrupted,
            "interrupted while a simulation was set up".into(),
        ),
    };
    let reason = format!("{reason}: {activity}; results of earlier simulations are kept");
    let (Some(mut run), Some(tables)) = (shared.run.take(), &shared.tables) else {
        remark(reason);
        std::process::exit(exit.code().into())
    };
    run.record.status = status;
    run.record.stop_code = code;
    run.record.stop_reason.clone_from(&reason);
    run.log.push(Event::Error(reason));
    let exit = match tables.complete_early(&mut run) {
        Ok(files) => {
            remark(summary::facts(&run, &files).trim_end());
            exit
        }
        Err(d) => {
            complain(&[d], &super::render::Sources::default());
            Exit::Unwritable
        }
    };
    piped::end();
    std::process::exit(exit.code().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_guarded_until_the_last_simulation_has_ended() {
        use cognate::dataset::command::Script;
        let simulate = "SIMULATE/DYNAMIC, END=1, STEPS=2\n";
        let longer = "SIMULATE/DYNAMIC, END=2, STEPS=2\n";
        for (commands, expected) in [
            (vec![], None),
            (vec!["STOP\n"], None),
            (vec![simulate], Some(1)),
            (vec![simulate, "STOP\n"], Some(1)),
            (vec![simulate, longer], Some(2)),
            (
                vec![simulate, "DEACTIVATE/SFORCE, ID=1\n", longer, "STOP\n"],
                Some(2),
            ),
            // what comes then may take long
            (vec![simulate, "LINEAR/EIGENSOL\n", "STOP\n"], None),
            (vec![simulate, "SAVE/SYSTEM=s\n"], None),
        ] {
            let script = Script::from_text(&format!("FILE/MODEL=m\n{}", commands.concat()));
            let steps = script.expect("commands").steps;
            assert_eq!(simulations_to_the_end(&steps), expected, "{commands:?}");
        }
    }

    #[test]
    fn durations_are_read_as_people_type_them() {
        for (text, expected) in [
            ("60", 60.0),
            ("60s", 60.0),
            ("500 ms", 0.5),
            ("2min", 120.0),
            ("1.5h", 5400.0),
        ] {
            assert_eq!(seconds(text), Ok(expected), "{text}");
        }
        for text in ["", "s", "0", "-1s", "inf", "nan", "2 years", "1e400"] {
            assert!(seconds(text).is_err(), "{text}");
        }
    }
}
