//! Why a simulation ended before all was done that was asked for: as data, and as the code, the
//! status and the sentence of its record.

use super::limit::Reached;
use crate::analysis::quantity::place;
use crate::analysis::runaway::RunsAway;
use crate::analysis::statics::Imbalance;
use crate::analysis::time::ranks::Lock;
use crate::analysis::time::valueless::Valueless;
use crate::model::{ElementId, ElementKind};
use crate::results::Status;
use crate::scene::broken::Broken;
use std::fmt;

/// Why a simulation ended early.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum StopReason {
    /// the user asked to stop
    Interrupted,
    /// the permitted processor time had been used
    WorkLimit {
        /// permitted, in s
        seconds: f64,
        /// where it was
        reached: Reached,
    },
    /// a SENSOR asked to stop
    Sensor {
        /// user's number
        id: u32,
        /// when
        at: f64,
    },
    /// a contact of curves ended
    Contact {
        /// when
        at: f64,
        /// which, why, and what to do
        broken: Broken,
    },
    /// a function lost its value
    Function {
        /// when
        at: f64,
        /// which, and how
        lost: Valueless,
    },
    /// the motion grows without bound, in ever shorter steps
    RunsAway {
        /// when, and how
        away: RunsAway,
        /// the force with the largest power there
        fed_by: Option<ElementId>,
    },
    /// the rows can be kept no longer
    Locked {
        /// when
        at: f64,
        /// the row, what drives against it, and the position
        lock: Lock,
    },
    /// the method could not go on
    Method {
        /// when
        at: f64,
        /// length of the step that was tried
        step: f64,
        /// what it met
        cause: Cause,
        /// name of the unknown or row that was worst
        worst: String,
    },
    /// no equilibrium was found
    NoEquilibrium {
        /// when
        at: f64,
        /// what is not balanced
        imbalance: Imbalance,
    },
}

/// The obstacle at which a method could not go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cause {
    /// no solution of an algebraic loop
    Loop,
    /// equations without a finite value
    Equations,
    /// a rate that is not a number
    Rate,
    /// rows that cannot be reached
    Projection,
    /// an error that no step makes small enough
    ErrorTest,
    /// an iteration that no step makes converge
    Newton,
    /// an unknown that no equation determines
    Singular,
    /// branches that change without end
    Endless,
    /// thousands of steps in hardly any time
    Stalled,
    /// the largest permitted number of steps
    TooManySteps,
}

impl Cause {
    /// Stable short name, explained by `cognate explain`.
    fn code(self) -> &'static str {
        match self {
            Cause::Loop => "loop",
            Cause::Equations | Cause::Rate => "no_finite_value",
            Cause::Projection => "locked",
            Cause::ErrorTest => "error_test",
            Cause::Newton => "no_convergence",
            Cause::Singular => "singular",
            Cause::Endless => "endless_switching",
            Cause::Stalled => "stalled",
            Cause::TooManySteps => "too_many_steps",
        }
    }

    /// Returns the reason alone, without time and place.
    fn sentence(self) -> &'static str {
        match self {
            Cause::Loop => "a function that depends on itself has no solution near",
            Cause::Equations => "the equations have no finite value",
            Cause::Rate => "a rate is not a number",
            Cause::Projection => "the constraints cannot be kept: the mechanism is locked or folds",
            Cause::ErrorTest => "the error stays above its tolerance however short the step",
            Cause::Newton => "Newton's iteration does not converge however short the step",
            Cause::Singular => "nothing determines an unknown",
            Cause::Endless => {
                "a function changes its branch without end; let it change over a short way, as STEP does"
            }
            Cause::Stalled => {
                "thousands of steps got hardly any further; something is too stiff or changes too fast for this method"
            }
            Cause::TooManySteps => "as many steps were tried as are permitted",
        }
    }
}

impl StopReason {
    /// Stable short name, explained by `cognate explain`.
    pub(super) fn code(&self) -> &'static str {
        match self {
            StopReason::Interrupted => "interrupted",
            StopReason::WorkLimit { .. } => "work_limit",
            StopReason::Sensor { .. } => "sensor",
            StopReason::Contact { broken, .. } => broken.code(),
            StopReason::Function { .. } => "no_finite_value",
            StopReason::RunsAway { .. } => "energy_grows",
            StopReason::Locked { .. } => "locked",
            StopReason::Method { cause, .. } => cause.code(),
            StopReason::NoEquilibrium { .. } => "no_equilibrium",
        }
    }

    /// Returns whether constraints cannot be kept.
    pub(super) fn is_lock(&self) -> bool {
        match self {
            StopReason::Locked { .. } => true,
            StopReason::Method { cause, .. } => *cause == Cause::Projection,
            StopReason::Interrupted
            | StopReason::WorkLimit { .. }
            | StopReason::Sensor { .. }
            | StopReason::Contact { .. }
            | StopReason::Function { .. }
            | StopReason::RunsAway { .. }
            | StopReason::NoEquilibrium { .. } => false,
        }
    }

    /// Returns the status of the run.
    pub(super) fn status(&self) -> Status {
        match self {
            StopReason::Interrupted => Status::Interrupted,
            StopReason::WorkLimit { .. } => Status::Limit,
            // the model asked for it
            StopReason::Sensor { .. } => Status::Completed,
            StopReason::Contact { .. }
            | StopReason::Function { .. }
            | StopReason::RunsAway { .. }
            | StopReason::Locked { .. } => Status::Stopped,
            StopReason::Method { cause, .. } => match cause {
                Cause::TooManySteps => Status::Limit,
                Cause::Loop
                | Cause::Equations
                | Cause::Rate
                | Cause::Projection
                | Cause::ErrorTest
                | Cause::Newton
                | Cause::Singular
                | Cause::Endless
                | Cause::Stalled => Status::Stopped,
            },
            StopReason::NoEquilibrium { .. } => Status::NoEquilibrium,
        }
    }

    /// Names of the elements, rows or unknowns to blame.
    pub(super) fn worst(&self) -> Vec<String> {
        let name = match self {
            StopReason::Interrupted | StopReason::Sensor { .. } => "",
            StopReason::WorkLimit { reached, .. } => match reached {
                Reached::SetUp(_) | Reached::Rest { .. } => "",
                Reached::Motion { fastest, .. } => fastest,
            },
            StopReason::Contact { broken, .. } => return vec![broken.element.to_string()],
            StopReason::Function { lost, .. } => return vec![lost.function.to_string()],
            StopReason::RunsAway { fed_by, .. } => {
                return fed_by.iter().map(ToString::to_string).collect();
            }
            StopReason::Locked { lock, .. } => &lock.row,
            StopReason::Method { worst, .. } => worst,
            StopReason::NoEquilibrium { imbalance, .. } => imbalance.name(),
        };
        let named = (!name.is_empty()).then(|| name.to_string());
        named.into_iter().collect()
    }
}

impl fmt::Display for StopReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StopReason::Interrupted => f.write_str("interrupted; the results so far are kept"),
            StopReason::WorkLimit { seconds, reached } => write!(
                f,
                "the limit of {seconds} s of processor time was reached {reached}; the results so far are kept"
            ),
            StopReason::Sensor { id, at } => {
                let sensor = ElementKind::Sensor.id(*id);
                write!(f, "{sensor} ended the simulation at time {at}")
            }
            StopReason::Contact { at, broken } => {
                let (what, advice) = (&broken.reason, broken.advice());
                write!(f, "stopped at time {at}: {what}; {advice}")
            }
            StopReason::Function { at, lost } => write!(f, "stopped at time {at}: {lost}"),
            StopReason::RunsAway { away, fed_by } => {
                let RunsAway {
                    t,
                    within,
                    steps_left,
                } = away;
                write!(
                    f,
                    "stopped at time {t}: the motion grows without bound, its kinetic energy a thousand times within {within:.3}; \
                     the end would be {steps_left:.0e} ever shorter steps away"
                )?;
                match fed_by {
                    Some(id) => write!(f, "; {id} feeds it: is its sign what you mean?"),
                    None => Ok(()),
                }
            }
            StopReason::Locked { at, lock } => {
                write!(f, "stopped at time {at}: ")?;
                let row = &lock.row;
                match lock.motion {
                    Some(id) => write!(
                        f,
                        "the mechanism is locked: {} drives it past its reach, {row} cannot follow",
                        ElementKind::Motion.id(id)
                    )?,
                    None => write!(
                        f,
                        "the constraints can be kept no longer: {row} has become dependent on others"
                    )?,
                }
                write!(f, ", where {}", place(&lock.place))
            }
            StopReason::Method {
                at,
                step,
                cause,
                worst,
            } => {
                let what = cause.sentence();
                write!(f, "stopped at time {at} with step {step:.3e}: {what}")?;
                match worst.as_str() {
                    "" => Ok(()),
                    name => write!(f, " ({name})"),
                }
            }
            StopReason::NoEquilibrium { at, imbalance } => write!(f, "at time {at} {imbalance}"),
        }
    }
}
