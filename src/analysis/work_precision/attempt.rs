//! One run of a study: its table, how it ended, and its cost in processor time.

use super::distance::Table;
use super::profile::{self, Profile};
use super::{Cost, Question};
use crate::analysis::session::script::obey;
use crate::analysis::session::{Options, Session};
use crate::analysis::watch::Watch;
use crate::analysis::work_limit::ProcessorClock;
use crate::diagnostic::Error;
use crate::numeric::METHODS;
use crate::results::{Counts, Kind, Record, Run, Simulation, Status, csv};

/// Solving is repeated until it has used about this much processor time, in s: some systems count
/// it by ticks of some milliseconds, and short runs differ from each other.
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
    let (mut session, all) = once(question, options(1), watch)?;
    let record = session.run.record.clone();
    let mut solve = record.solve_processor_seconds;
    let mut set_up = (all - solve).max(0.0);
    if record.status == Status::Completed {
        // no thread uses more than passes: the first guess is too small rather than too large
        let mut repeats = (TIMED / record.seconds.solve.max(1e-9)).ceil();
        repeats = repeats.clamp(1.0, MOST_REPEATS);
        while repeats > 1.0 && whole.seconds() < 0.1 * limit {
            let (again, all) = once(question, options(1 + repeats as usize), watch)?;
            let again = &again.run.record;
            if again.status != Status::Completed {
                break;
            }
            solve = again.solve_processor_seconds;
            set_up = (all - f64::from(again.repeats) * solve).max(0.0);
            if repeats * solve > 0.5 * TIMED || repeats == MOST_REPEATS {
                break;
            }
            repeats = (4.0 * repeats).min(MOST_REPEATS);
        }
    }
    let mut cost = Cost {
        counts: record.counts,
        solve,
        set_up,
        write: writing(&session.run),
        profile: None,
    };
    if record.status == Status::Completed {
        cost.profile = profile_of(&mut session, &record, solve);
    }
    Ok(Attempt {
        table: Table::of(&session.run),
        status: record.status,
        is_integrated: record.simulations.iter().any(is_integrated),
        reason: record.stop_reason,
        worked: record.method,
        cost,
        spent: whole.seconds(),
    })
}

/// Returns whether a method integrated a simulation: also one that is kinematic may have states of
/// differential equations.
fn is_integrated(simulation: &Simulation) -> bool {
    let is_method = || {
        METHODS
            .iter()
            .any(|m| simulation.method.starts_with(m.name))
    };
    match simulation.kind {
        Kind::Dynamic => true,
        Kind::Kinematic => is_method(),
        Kind::Input | Kind::InitialConditions | Kind::Static | Kind::QuasiStatic => false,
    }
}

/// Returns the processor time of making the text of a table, the shorter of two, in s.
fn writing(run: &Run) -> f64 {
    let seconds = [(); 2].map(|()| {
        let clock = ProcessorClock::start();
        std::hint::black_box(csv::write(run, true));
        clock.seconds()
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

/// Runs the commands of a question once; returns the processor time of it all, in s.
///
/// # Errors
/// Mistakes in the model or a command.
fn once(
    question: &Question<'_>,
    options: Options,
    watch: &mut dyn Watch,
) -> Result<(Session, f64), Error> {
    let clock = ProcessorClock::start();
    let mut session = Session::new(question.model.clone(), &question.name, options);
    session.folders.clone_from(&question.folders);
    obey(&mut session, question.steps, |_, _| (), watch)?;
    Ok((session, clock.seconds()))
}
