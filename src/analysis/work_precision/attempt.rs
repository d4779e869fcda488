//! One run of a study: its table, how it ended, and its cost in processor time.

use super::distance::Table;
use super::profile::{self, Profile};
use super::{Cost, Question};
use crate::analysis::session::script::obey;
use crate::analysis::session::{Options, Session};
use crate::analysis::watch::Watch;
use crate::analysis::work_limit::ProcessorClock;
use crate::clock::Moment;
use crate::diagnostic::Error;
use crate::results::{Counts, Kind, Record, Run, Status, csv};

/// Solving is repeated until it has taken about this long, in s: the clock of the processor has a
/// resolution of some milliseconds.
const TIMED: f64 = 0.05;
/// Repeats, at most.
const MOST_REPEATS: f64 = 2000.0;

/// A run and what it has left.
pub(super) struct Attempt {
    pub table: Table,
    pub status: Status,
    /// why it ended early
    pub reason: String,
    /// the methods that worked in fact
    pub worked: String,
    pub cost: Cost,
    /// whether a method integrated
    pub is_integrated: bool,
    /// processor time of it all, repeats included, in s
    pub spent: f64,
}

/// Runs the model of a question at a request by a method, within `limit` s of processor time. It is
/// solved again for its time where that is short.
///
/// # Errors
/// The model, or the model by this method, cannot be run.
pub(super) fn attempt(
    question: &Question<'_>,
    (method, request): (&str, f64),
    limit: f64,
    watch: &mut dyn Watch,
) -> Result<Attempt, Error> {
    let options = |repeat| Options {
        error: Some(request),
        method: Some(method.to_string()),
        limit: Some(limit),
        repeat,
        ..question.options.clone()
    };
    let whole = ProcessorClock::start();
    let (mut session, seconds) = once(question, options(1), watch)?;
    let record = session.run.record.clone();
    let solve_once = seconds.solving;
    let mut cost = Cost {
        counts: record.counts,
        solve: solve_once,
        set_up: (seconds.all - solve_once).max(0.0),
        ..Cost::default()
    };
    cost.write = writing(&session.run);
    if record.status == Status::Completed {
        let repeats = (TIMED / record.seconds.solve.max(1e-9)).ceil();
        let mut repeats = repeats.clamp(1.0, MOST_REPEATS);
        while repeats > 1.0 && seconds.all < 0.1 * limit {
            let (_, again) = once(question, options(1 + repeats as usize), watch)?;
            cost.solve = again.solving;
            cost.set_up = (seconds.all - cost.solve).max(0.0);
            // where others work on this machine, time passes in which little is solved
            if repeats * again.solving > 0.5 * TIMED || repeats == MOST_REPEATS {
                break;
            }
            repeats = (4.0 * repeats).min(MOST_REPEATS);
        }
        cost.profile = profile_of(&mut session, &record, cost.solve);
    }
    Ok(Attempt {
        table: Table::of(&session.run),
        status: record.status,
        is_integrated: record.simulations.iter().any(|s| s.kind == Kind::Dynamic),
        reason: record.stop_reason,
        worked: record.method,
        cost,
        spent: whole.seconds(),
    })
}

/// Returns the time of making the text of a table, the shorter of two, in s.
fn writing(run: &Run) -> f64 {
    let seconds = [(); 2].map(|()| {
        let clock = Moment::now();
        std::hint::black_box(csv::write(run, true));
        clock.elapsed().as_secs_f64()
    });
    seconds[0].min(seconds[1])
}

/// Returns where solving spent its time in the simulations that integrated, as the system of the
/// last one tells it.
fn profile_of(session: &mut Session, record: &Record, solve: f64) -> Option<Profile> {
    let all = record.simulations.iter();
    let integrated = || all.clone().filter(|s| s.kind == Kind::Dynamic);
    let mut counts = Counts::default();
    integrated().for_each(|s| counts += s.counts);
    let seconds: f64 = integrated().map(|s| s.solve_seconds).sum();
    let share = seconds / record.seconds.solve.max(f64::MIN_POSITIVE);
    let system = session.kept_system()?;
    Some(profile::of(system, &counts, share * solve))
}

/// Processor time of a run, in s.
struct Seconds {
    all: f64,
    solving: f64,
}

/// Runs the commands of a question once.
///
/// # Errors
/// Mistakes in the model or a command.
fn once(
    question: &Question<'_>,
    options: Options,
    watch: &mut dyn Watch,
) -> Result<(Session, Seconds), Error> {
    let (clock, passing) = (ProcessorClock::start(), Moment::now());
    let mut session = Session::new(question.model.clone(), &question.name, options);
    session.folders.clone_from(&question.folders);
    obey(&mut session, question.steps, |_, _| (), watch)?;
    let record = &session.run.record;
    // where others work on this machine, time passes that was not used
    let (used, passed) = (clock.seconds(), passing.elapsed().as_secs_f64());
    let used_part = if passed > 0.0 { used / passed } else { 1.0 };
    let all = used;
    let passing = record.seconds.solve * used_part;
    let solving = record.repeated_seconds.unwrap_or(passing);
    Ok((session, Seconds { all, solving }))
}
