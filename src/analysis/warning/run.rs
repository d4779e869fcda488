//! Warnings of simulations: of motions that jump, of columns without values, of ranks, of methods.

use crate::analysis::quantity::{amount, place, short};
use crate::diagnostic::Diagnostic;
use crate::model::{ElementId, ElementKind};
use crate::results::{Quantity, RankChange, RowChange};
use crate::scene::equations::Unsupported;
use std::fmt;

/// Something that a simulation met.
#[derive(Clone, Debug, PartialEq)]
pub enum RunWarning {
    /// a dynamic simulation of a mechanism that motions move alone
    NoFreedom,
    /// contacts push in a run in which nothing can give way
    ContactsWithoutFreedom(Vec<ElementId>),
    /// a dynamic simulation of parts that nothing moves: their constraints hold them
    Held,
    /// a row that was left out as redundant within tolerance went beyond it
    BeyondTolerance {
        /// when it was farthest off
        at: f64,
        /// "JOINT/4 Zi.Xj"
        row: String,
        /// how far, in rad or as a length
        off: f64,
        /// whether that is a length
        is_length: bool,
        /// unit of lengths
        unit: String,
    },
    /// a simulation would end before it begins
    NothingToSimulate {
        /// text of the command
        command: String,
        /// the clock
        now: f64,
    },
    /// what a motion prescribes jumps
    MotionJumps {
        /// user's number of the MOTION
        motion: u32,
        /// the lowest derivative that jumps
        quantity: Quantity,
        /// times, and by how much
        jumps: Vec<(f64, f64)>,
    },
    /// a method cannot take the model, for this reason; RADAU5 takes its place
    MethodReplaced(Diagnostic),
    /// a column has no value at any time
    EmptyColumn(Unsupported),
    /// a column has no value at some time
    Gap {
        /// its name
        column: String,
        /// the first such time
        at: f64,
    },
    /// the rank of the constraints changes
    Rank(RankChange),
    /// an equilibrium would be left after a small push
    Unstable {
        /// when
        at: f64,
        /// number of directions in which it leaves
        directions: usize,
    },
    /// a spline is read where it has no data
    OutsideData {
        /// whose function reads it
        element: ElementId,
        /// user's number of the SPLINE
        spline: u32,
        /// first and last X of its data
        range: [f64; 2],
        /// X farthest from the data
        value: f64,
        /// the first time outside
        since: f64,
    },
    /// a smaller error is asked for than rounding permits
    BelowRounding {
        /// the error
        error: f64,
        /// number of steps that it was asked for in vain
        below: usize,
        /// number of all steps
        steps: usize,
    },
    /// the motion grows without bound
    EnergyGrows {
        /// energy in the end over that of the first quarter
        factor: f64,
        /// the force with the largest power
        fed_by: Option<ElementId>,
    },
    /// stability, not accuracy, sets the steps of an explicit method
    StabilityLimited {
        /// number of such steps
        limited: usize,
        /// number of all steps
        steps: usize,
    },
    /// the run that bars of error come from ended otherwise than the run itself
    CompanionEnded {
        /// its request
        request: f64,
    },
}

impl RunWarning {
    /// Returns its stable short name.
    pub(super) fn code(&self) -> &'static str {
        match self {
            RunWarning::NoFreedom | RunWarning::Held => "freedom",
            RunWarning::BeyondTolerance { .. } => "redundant",
            RunWarning::ContactsWithoutFreedom(_) => "no_effect",
            RunWarning::NothingToSimulate { .. } => "nothing_to_simulate",
            RunWarning::MotionJumps { .. } => "motion_jumps",
            RunWarning::MethodReplaced(_) => "method",
            RunWarning::EmptyColumn(_) => "unavailable",
            RunWarning::Gap { .. } => "no_finite_value",
            RunWarning::Rank(_) => "rank_change",
            RunWarning::Unstable { .. } => "unstable_equilibrium",
            RunWarning::OutsideData { .. } => "outside_data",
            RunWarning::BelowRounding { .. } => "below_rounding",
            RunWarning::StabilityLimited { .. } => "stiff",
            RunWarning::EnergyGrows { .. } => "energy_grows",
            RunWarning::CompanionEnded { .. } => "accuracy_unknown",
        }
    }

    /// Returns the element or column that it is about.
    pub(super) fn element(&self) -> Option<String> {
        match self {
            RunWarning::MotionJumps { motion, .. } => {
                Some(ElementKind::Motion.id(*motion).to_string())
            }
            RunWarning::MethodReplaced(d) => d.element.clone(),
            RunWarning::ContactsWithoutFreedom(contacts) => {
                contacts.first().map(ToString::to_string)
            }
            RunWarning::EmptyColumn(unsupported) => Some(unsupported.asked_by.to_string()),
            RunWarning::Gap { column, .. } => Some(column.clone()),
            RunWarning::EnergyGrows { fed_by, .. } => fed_by.map(|id| id.to_string()),
            RunWarning::OutsideData { element, .. } => Some(element.to_string()),
            RunWarning::BeyondTolerance { row, .. } => Some(row.clone()),
            RunWarning::NoFreedom
            | RunWarning::Held
            | RunWarning::NothingToSimulate { .. }
            | RunWarning::Rank(_)
            | RunWarning::Unstable { .. }
            | RunWarning::BelowRounding { .. }
            | RunWarning::StabilityLimited { .. }
            | RunWarning::CompanionEnded { .. } => None,
        }
    }
}

impl fmt::Display for RunWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RunWarning::NoFreedom => {
                f.write_str("the mechanism has no freedom: it is moved by its motions alone")
            }
            RunWarning::ContactsWithoutFreedom(contacts) => idle_contacts(contacts, f),
            RunWarning::Held => {
                f.write_str("no part can move: the constraints hold all of them where they are")
            }
            RunWarning::BeyondTolerance {
                at,
                row,
                off,
                is_length,
                unit,
            } => write!(
                f,
                "{row} was left out as redundant, but is off by {} at time {at:.9}: \
                 more than IC/ERROR permits",
                amount(*off, *is_length, unit)
            ),
            RunWarning::NothingToSimulate { command, now } => write!(
                f,
                "{command}: the clock shows {now} already, there is nothing to simulate"
            ),
            RunWarning::MotionJumps {
                motion,
                quantity,
                jumps: all,
            } => {
                let then = match quantity {
                    Quantity::Displacement | Quantity::Velocity => "it runs piecewise",
                    Quantity::Acceleration => "forces jump there",
                };
                let motion = ElementKind::Motion.id(*motion);
                write!(f, "{motion}: {}; {then}", jumps(*quantity, all))
            }
            RunWarning::MethodReplaced(d) => write!(f, "{}: RADAU5 takes its place", d.message),
            RunWarning::EmptyColumn(unsupported) => unsupported.fmt(f),
            RunWarning::Gap { column, at } => {
                write!(f, "{column} has no finite value at time {at}")
            }
            RunWarning::Rank(change) => of_rank(change, f),
            RunWarning::Unstable { at, directions } => {
                let plural = if *directions == 1 { "" } else { "s" };
                write!(
                    f,
                    "the equilibrium at time {at} is unstable in {directions} direction{plural}"
                )
            }
            RunWarning::OutsideData {
                element,
                spline,
                range,
                value,
                since,
            } => outside_data((*element, *spline), *range, (*value, *since), f),
            RunWarning::BelowRounding {
                error,
                below,
                steps,
            } => write!(
                f,
                "an error of {error} is below rounding: it was asked for in vain in {below} of {steps} \
                 steps, which are as exact as rounding permits"
            ),
            RunWarning::CompanionEnded { request } => write!(
                f,
                "a run at an error of {request:.1e} ends otherwise than this one: bars of error hold as \
                 far as both go"
            ),
            RunWarning::EnergyGrows { factor, fed_by } => growth(*factor, *fed_by, f),
            RunWarning::StabilityLimited { limited, steps } => write!(
                f,
                "the model is stiff: in {limited} of {steps} steps stability, not the error asked \
                 for, kept an explicit method short; RADAU5 or AUTO takes longer ones"
            ),
        }
    }
}

/// Most times that a sentence names.
const MOST_TIMES: usize = 5;

/// Writes what a motion prescribes that jumps, and when.
pub fn jumps(quantity: Quantity, all: &[(f64, f64)]) -> String {
    let shown = all.iter().take(MOST_TIMES);
    let mut times: Vec<String> = shown.map(|(at, by)| format!("{at} (by {by:.6})")).collect();
    if all.len() > MOST_TIMES {
        times.push(format!("{} more times", all.len() - MOST_TIMES));
    }
    let (what, times) = (quantity.word(), times.join(", "));
    format!("the {what} it prescribes jumps at time {times}")
}

/// Writes which function reads which spline outside its data: at which value, since when.
fn outside_data(
    (element, spline): (ElementId, u32),
    [first, last]: [f64; 2],
    (value, since): (f64, f64),
    f: &mut fmt::Formatter<'_>,
) -> fmt::Result {
    write!(
        f,
        "{element} reads {} at {} from time {} on, but its data reach from {first} to {last}: \
         beyond them it is extrapolated",
        ElementKind::Spline.id(spline),
        short(value),
        short(since)
    )
}

/// Writes which contacts push in a run in which nothing can give way.
fn idle_contacts(contacts: &[ElementId], f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let names: Vec<String> = contacts.iter().map(ToString::to_string).collect();
    write!(
        f,
        "{}: in a kinematic run a contact pushes and moves nothing; motions go on through what is in their way",
        names.join(", ")
    )
}

/// Writes by how much the energy of a motion grows, and what feeds it.
fn growth(factor: f64, fed_by: Option<ElementId>, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    write!(
        f,
        "the motion grows without bound: its energy is {factor:.1e} times that of the first quarter \
         of the run"
    )?;
    match fed_by {
        Some(id) => write!(f, "; {id} feeds it: is the sign of its damping right?"),
        None => Ok(()),
    }
}

/// Writes when and where the rank of the constraints changes.
fn of_rank(change: &RankChange, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    let (time, rows) = (change.time, change.rows.join(", "));
    match change.change {
        RowChange::Passes => write!(
            f,
            "at time {time:.9} the rank of the constraints falls in passing: \
             {rows} depends on others where {}",
            place(&change.place)
        ),
        RowChange::Restored => write!(
            f,
            "at time {time:.9} {rows} no longer follows from the others; it is kept from there"
        ),
        RowChange::Exchanged => write!(
            f,
            "at time {time:.9} other rows are kept: {rows} in place of what they make superfluous"
        ),
    }
}
