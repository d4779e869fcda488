//! `--limit`: durations as people type them, and the guard that ends a run whose limit has been
//! reached where nothing looks at it.
//!
//! A session looks at its limit after each step and each phase of setting up. One phase of a large
//! model may take longer than all that is permitted: then the guard writes what earlier simulations
//! have left, and ends the process.

use super::output::Tables;
use super::{Exit, complain, remark, summary};
use crate::analysis::session::{Activity, Session};
use crate::analysis::work_limit::ProcessClock;
use crate::results::{Event, Run, Status};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Time between two looks at the clock of the processor.
const LOOK: Duration = Duration::from_millis(100);
/// Code of the reason, which `cognate explain` knows.
const WORK_LIMIT: &str = "work_limit";
/// Processor time beyond the limit in which a session can end by itself: seconds, and a part of the
/// limit.
const GRACE: [f64; 2] = [1.0, 0.1];

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

/// The state that the guard shares with the run.
struct Shared {
    /// results of the simulations that have ended
    run: Option<Run>,
    /// the activity of the session
    activity: Option<Activity>,
    /// the files of the run; `None`: the model is being read
    tables: Option<Tables>,
    /// the run writes its results: the guard has nothing left to do
    is_done: bool,
}

/// A thread that ends the process when a limit has been exceeded and nobody has seen it.
#[derive(Clone)]
pub struct Guard(Arc<Mutex<Shared>>);

impl Guard {
    /// Sets a guard over a run, permitting so many seconds of processor time.
    pub fn set(limit: f64) -> Self {
        let guard = Self(Arc::new(Mutex::new(Shared {
            run: None,
            activity: None,
            tables: None,
            is_done: false,
        })));
        let watched = guard.clone();
        std::thread::spawn(move || watched.watch(limit));
        guard
    }

    fn with<T>(&self, f: impl FnOnce(&mut Shared) -> T) -> T {
        f(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Tells what a session is doing, for the guard to say, and where its results go.
    pub fn follow(&self, session: &Session, tables: &Tables) {
        self.with(|shared| {
            shared.run = Some(session.run.clone());
            shared.activity = Some(session.activity());
            shared.tables = Some(tables.clone());
        });
    }

    /// Keeps the results so far.
    pub fn keep(&self, run: &Run) {
        self.with(|shared| shared.run = Some(run.clone()));
    }

    /// Ends the guard: the run ends by itself.
    pub fn done(&self) {
        self.with(|shared| shared.is_done = true);
    }

    /// Waits until the limit is exceeded or the run is done.
    fn watch(&self, limit: f64) {
        let [seconds, part] = GRACE;
        let permitted = limit + seconds.max(part * limit);
        let clock = ProcessClock::start();
        loop {
            std::thread::sleep(LOOK);
            let over = clock.seconds() > permitted;
            self.with(|shared| {
                if over && !shared.is_done {
                    // held until the process has ended: nobody else writes
                    end(shared, limit);
                }
            });
            if self.with(|shared| shared.is_done) {
                return;
            }
        }
    }
}

/// Writes the results of the simulations that have ended, and ends the process.
fn end(shared: &mut Shared, limit: f64) -> ! {
    let activity = shared.activity.as_ref().map(ToString::to_string);
    let activity = activity.unwrap_or_else(|| "the model was being read".into());
    let reason = format!(
        "the limit of {limit} s of processor time was exceeded: {activity}; results of earlier simulations are kept"
    );
    let (Some(mut run), Some(tables)) = (shared.run.take(), &shared.tables) else {
        remark(reason);
        std::process::exit(Exit::Limit.code().into())
    };
    run.record.status = Status::Limit;
    run.record.stop_code = WORK_LIMIT;
    run.record.stop_reason.clone_from(&reason);
    run.log.push(Event::Error(reason));
    let exit = match tables.complete_early(&mut run) {
        Ok(files) => {
            remark(summary::facts(&run, &files).trim_end());
            Exit::Limit
        }
        Err(d) => {
            complain(&[d], &super::render::Sources::default());
            Exit::Unwritable
        }
    };
    std::process::exit(exit.code().into())
}

#[cfg(test)]
mod tests {
    use super::*;

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
