//! Warnings of simulations: of motions that jump, of columns without values, of ranks, of methods.

use super::{Names, Rate, Unrest};
use crate::analysis::quantity::{amount, place, short};
use crate::diagnostic::{Diagnostic, Subject, counted};
use crate::model::{ElementId, ElementKind};
use crate::results::{ChannelAccuracy, Quantity, RankChange, RowChange, Units, digits_of_six};
use crate::scene::equations::Unsupported;

/// One in so many steps that ask for too much is no matter of the request.
const FEW_STEPS: usize = 20;

/// Something that a simulation met.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
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
        /// the element of the row
        element: ElementId,
        /// the row of it: `Zi.Xj`
        equation: String,
        /// how far, in rad or as a length
        off: f64,
        /// whether that is a length
        is_length: bool,
        /// unit of lengths
        unit: String,
    },
    /// a run has stopped in which constraints lock the mechanism, whatever its motions prescribe
    LockedWithoutMotions(Diagnostic),
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
    /// a motion gives a rate, and no time passes between equilibria
    RateAtRest {
        /// user's number of the MOTION
        motion: u32,
    },
    /// an equilibrium would be left after a small push
    Unstable {
        /// when
        at: f64,
        /// number of directions in which it leaves
        directions: usize,
    },
    /// a small push off an equilibrium grows, though stiffness pushes back
    PushGrows {
        /// when
        at: f64,
        /// how fast, per time, and in how many cycles per time
        growth: [f64; 2],
        /// name of the unit of time
        unit: String,
    },
    /// small motions are taken about a state that moves or is no equilibrium
    Unrest {
        /// when
        at: f64,
        /// the element that is farthest from rest
        unrest: Unrest,
        /// whether it is a state that statics have found
        is_settled: bool,
        /// units of the model
        units: Units,
    },
    /// a law takes angles for rotations about the axes of a marker, where they are none
    LargeAngles {
        /// the BUSHING, FIELD or BEAM
        element: ElementId,
        /// the first time
        since: f64,
        /// angle by which every axis tilts at least, the largest over time, in rad
        tilt: f64,
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
    /// rounding of the rates adds up to more than the error that is asked for
    RoundingAddsUp {
        /// the error
        error: f64,
        /// what rounding adds up to, relative to the largest values
        reached: f64,
    },
    /// the motion grows without bound
    EnergyGrows {
        /// energy in the end over that before
        factor: f64,
        /// how long before
        within: Within,
        /// the force that feeds it
        fed_by: Option<ElementId>,
    },
    /// the balance of energy does not close
    EnergyUnsure {
        /// what it lacks, over all energy
        share: f64,
    },
    /// errors have added up to many times the request, as a further integration has measured
    ErrorsAddUp {
        /// the column that is farthest off
        channel: ChannelAccuracy,
        /// how far, over its size and the request
        requests: f64,
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

/// The time in which an energy has grown beyond all bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Within {
    /// from each quarter of the run to the next
    Quarters,
    /// just before the run had to stop
    Moments,
}

impl RunWarning {
    /// Returns its stable short name.
    pub(super) fn code(&self) -> &'static str {
        match self {
            RunWarning::NoFreedom | RunWarning::Held => "freedom",
            RunWarning::BeyondTolerance { .. } => "redundant",
            RunWarning::LockedWithoutMotions(d) => d.code,
            RunWarning::ContactsWithoutFreedom(_) | RunWarning::RateAtRest { .. } => "no_effect",
            RunWarning::NothingToSimulate { .. } => "nothing_to_simulate",
            RunWarning::MotionJumps { .. } => "motion_jumps",
            RunWarning::EmptyColumn(_) => "unavailable",
            RunWarning::Gap { .. } => "no_finite_value",
            RunWarning::Rank(_) => "rank_change",
            RunWarning::Unstable { .. } | RunWarning::PushGrows { .. } => "unstable_equilibrium",
            RunWarning::Unrest { .. } => "not_at_rest",
            RunWarning::LargeAngles { .. } => "large_angles",
            RunWarning::OutsideData { .. } => "outside_data",
            RunWarning::BelowRounding { .. } | RunWarning::RoundingAddsUp { .. } => {
                "below_rounding"
            }
            RunWarning::StabilityLimited { .. } => "stiff",
            RunWarning::EnergyGrows { .. } => "energy_grows",
            RunWarning::EnergyUnsure { .. } => "energy_unsure",
            RunWarning::ErrorsAddUp { .. } => "errors_add_up",
            RunWarning::CompanionEnded { .. } => "accuracy_unknown",
        }
    }

    /// Returns the element or column that its sentence begins with.
    pub(super) fn subject(&self) -> Option<Subject> {
        match self {
            RunWarning::MotionJumps { motion, .. } | RunWarning::RateAtRest { motion } => {
                Some(ElementKind::Motion.id(*motion).into())
            }
            RunWarning::LockedWithoutMotions(d) => d.subject(),
            RunWarning::ContactsWithoutFreedom(contacts) => contacts.first().map(|&id| id.into()),
            RunWarning::EmptyColumn(unsupported) => Some((&unsupported.asked_by).into()),
            RunWarning::Gap { column, .. } => Some(column.as_str().into()),
            RunWarning::EnergyGrows { fed_by, .. } => fed_by.map(Subject::from),
            RunWarning::Unrest { unrest, .. } => Some(unrest.subject.clone()),
            RunWarning::OutsideData { element, .. } | RunWarning::LargeAngles { element, .. } => {
                Some((*element).into())
            }
            RunWarning::BeyondTolerance {
                element, equation, ..
            } => Some(Subject::part_of(*element, equation)),
            RunWarning::NoFreedom
            | RunWarning::Held
            | RunWarning::NothingToSimulate { .. }
            | RunWarning::Rank(_)
            | RunWarning::Unstable { .. }
            | RunWarning::PushGrows { .. }
            | RunWarning::BelowRounding { .. }
            | RunWarning::RoundingAddsUp { .. }
            | RunWarning::EnergyUnsure { .. }
            | RunWarning::ErrorsAddUp { .. }
            | RunWarning::StabilityLimited { .. }
            | RunWarning::CompanionEnded { .. } => None,
        }
    }

    /// Returns the sentence after the subject; all of it where there is none.
    pub(super) fn rest(&self, names: &Names) -> String {
        match self {
            RunWarning::NoFreedom => {
                "the mechanism has no freedom: it is moved by its motions alone".into()
            }
            RunWarning::ContactsWithoutFreedom(contacts) => idle_contacts(contacts, names),
            RunWarning::Held => {
                "no part can move: the constraints hold all of them where they are".into()
            }
            RunWarning::BeyondTolerance {
                at,
                off,
                is_length,
                unit,
                ..
            } => beyond_tolerance(*at, &amount(*off, *is_length, unit)),
            RunWarning::LockedWithoutMotions(d) => {
                format!(": {}; no motion can change that", d.message)
            }
            RunWarning::NothingToSimulate { command, now } => {
                format!("{command}: the clock shows {now} already, there is nothing to simulate")
            }
            RunWarning::MotionJumps {
                quantity,
                jumps: all,
                ..
            } => format!(": {}; {}", jumps(*quantity, all), after_jump(*quantity)),
            RunWarning::EmptyColumn(unsupported) => format!(": {}", unsupported.lack),
            RunWarning::Gap { at, .. } => format!(" has no finite value at time {at}"),
            RunWarning::Rank(change) => of_rank(change),
            RunWarning::RateAtRest { .. } => RATE_AT_REST.into(),
            RunWarning::Unstable { at, directions } => unstable(*at, *directions),
            RunWarning::PushGrows { at, growth, unit } => push_grows(*at, *growth, unit),
            RunWarning::LargeAngles { since, tilt, .. } => large_angles(*since, *tilt),
            RunWarning::Unrest {
                at,
                unrest,
                is_settled,
                units,
            } => not_at_rest(*at, (unrest, units), *is_settled),
            RunWarning::OutsideData {
                spline,
                range,
                value,
                since,
                ..
            } => {
                let spline = names.of(ElementKind::Spline.id(*spline));
                outside_data(&spline, *range, *value, *since)
            }
            RunWarning::BelowRounding {
                error,
                below,
                steps,
            } => in_vain(*error, *below, *steps),
            RunWarning::RoundingAddsUp { error, reached } => rounding_adds_up(*error, *reached),
            RunWarning::CompanionEnded { request } => companion_ended(*request),
            RunWarning::EnergyGrows {
                factor,
                within,
                fed_by,
            } => growth(*factor, *within, fed_by.is_some()),
            RunWarning::EnergyUnsure { share } => energy(*share),
            RunWarning::ErrorsAddUp { channel, requests } => errors_add_up(channel, *requests),
            RunWarning::StabilityLimited { limited, steps } => stiff(*limited, *steps),
        }
    }
}

const RATE_AT_REST: &str = ": what it drives stays where it stands, as no time passes between \
                            equilibria; a displacement would move it";

/// Returns what is told of a row that was left out and does not hold.
fn beyond_tolerance(at: f64, off: &str) -> String {
    format!(
        " was left out as redundant, but is off by {off} at time {at:.9}: more than IC/ERROR permits"
    )
}

/// Returns what rounding of the accelerations adds up to.
fn rounding_adds_up(error: f64, reached: f64) -> String {
    format!(
        "an error of {error} cannot be reached: rounding of the accelerations alone adds up to about \
         {reached:.0e} of the largest velocities"
    )
}

/// Returns how far bars of error hold where the run at another request ended otherwise.
fn companion_ended(request: f64) -> String {
    format!(
        "the comparison run, at an error of {request:.1e}, ends otherwise than this one: there are bars \
         of error only as far as both go"
    )
}

/// Returns that an equilibrium would be left after a small push.
fn unstable(at: f64, directions: usize) -> String {
    let directions = counted(directions, "direction");
    format!("the equilibrium at time {at} is unstable in {directions}")
}

/// Returns that a small push off an equilibrium grows, and how fast.
fn push_grows(at: f64, [rate, frequency]: [f64; 2], unit: &str) -> String {
    let time = if unit.is_empty() {
        "units of time"
    } else {
        unit
    };
    let within = digits_of_six(1.0 / rate);
    let swings = match frequency > 0.0 {
        true => format!(", {} swings in each", digits_of_six(frequency / rate)),
        false => String::new(),
    };
    format!(
        "the equilibrium at time {at} is stable in stiffness, but a small push grows by e in \
         {within} {time}{swings}: a load that follows the motion, negative damping or a state \
         feeds it"
    )
}

/// Returns from when on angles are no rotations, and how far from that they are.
fn large_angles(since: f64, tilt: f64) -> String {
    format!(
        ": its law takes AX, AY and AZ for rotations about the axes of J, which holds while two of \
         them are small; from time {} on no two are: the axis that tilts least tilts by up to {} deg",
        short(since),
        short(tilt.to_degrees())
    )
}

/// Returns what is not at rest in the state that a system was linearized about.
fn not_at_rest(at: f64, (unrest, units): (&Unrest, &Units), is_settled: bool) -> String {
    let advice = match unrest.rate {
        Rate::Acceleration | Rate::AngularAcceleration if !is_settled => {
            "; SIMULATE/STATIC, or --static, finds an equilibrium"
        }
        _ => "",
    };
    format!(
        " {} at time {}, about which the model is linearized: eigenvalues are those of the equations \
         as they stand at that instant{advice}",
        unrest.words(units),
        short(at)
    )
}

/// Returns in how many of all steps stability kept an explicit method short.
fn stiff(limited: usize, steps: usize) -> String {
    format!(
        "the model is stiff: in {limited} of {steps} steps stability, not the requested error, kept \
         the steps of an explicit method short; RADAU5 or AUTO takes longer ones"
    )
}

/// Returns which share of all energy its balance lacks.
fn energy(share: f64) -> String {
    format!(
        "the balance of energy is off by {:.0} % of all energy: the integrator took it from the \
         motion, or added it; a smaller ERROR makes it less",
        100.0 * share
    )
}

/// Returns how far errors have added up.
fn errors_add_up(channel: &ChannelAccuracy, requests: f64) -> String {
    let (name, bar) = (
        &channel.channel,
        amount_of(channel.usual_bar, &channel.unit),
    );
    match channel.lost_from {
        Some(t) => format!(
            "{name} is known no longer from time {} on: errors of the run have grown to all that it \
             does; a smaller ERROR makes them less",
            short(t)
        ),
        None => format!(
            "errors have added up in {name}: it may be off by ±{bar}, some {requests:.0} times the \
             requested error; a smaller ERROR makes it less"
        ),
    }
}

/// Returns a number of two digits with its unit.
fn amount_of(x: f64, unit: &str) -> String {
    format!("{x:.1e} {unit}").trim_end().to_string()
}

/// Returns the way in which a run goes on after what a motion prescribes has jumped.
fn after_jump(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Displacement | Quantity::Velocity => "it runs piecewise",
        Quantity::Acceleration => "forces jump there",
    }
}

/// Returns in how many of all steps an error was asked for in vain.
fn in_vain(error: f64, below: usize, steps: usize) -> String {
    if below * FEW_STEPS < steps {
        return format!(
            "an error of {error} was not reached in {below} of {steps} steps: shorter steps were no \
             better, because the rates are rounded there or jump"
        );
    }
    format!(
        "an error of {error} is below rounding and was not reached in {below} of {steps} steps, \
         which are as exact as rounding permits"
    )
}

/// Returns by how much the energy of a motion grows; `fed`: the force before it feeds the motion.
fn growth(factor: f64, within: Within, fed: bool) -> String {
    let before = match within {
        Within::Quarters => "that of the first quarter of the run",
        Within::Moments => "all that there was moments before",
    };
    let energy = format!("its energy is {factor:.1e} times {before}");
    if fed {
        format!(
            " feeds a motion that grows without bound: {energy}; are the signs of its stiffness and its damping right?"
        )
    } else {
        format!("the motion grows without bound: {energy}")
    }
}

/// Most times that a sentence names.
const MOST_TIMES: usize = 5;

/// Writes what a motion prescribes that jumps, and when.
pub fn jumps(quantity: Quantity, all: &[(f64, f64)]) -> String {
    let shown = all.iter().take(MOST_TIMES);
    let time = |(at, by): &(f64, f64)| match by.is_nan() {
        true => format!("{at} (it has no value there)"),
        false => format!("{at} (by {by:.6})"),
    };
    let mut times: Vec<String> = shown.map(time).collect();
    if all.len() > MOST_TIMES {
        times.push(counted(all.len() - MOST_TIMES, "more time"));
    }
    let (what, times) = (quantity.word(), times.join(", "));
    format!("the {what} it prescribes jumps at time {times}")
}

/// Returns which spline a function reads outside its data: at which value, since when.
fn outside_data(spline: &str, [first, last]: [f64; 2], value: f64, since: f64) -> String {
    format!(
        " reads {spline} at {} from time {} on, but its data reach from {first} to {last}: \
         beyond them it is extrapolated",
        short(value),
        short(since)
    )
}

/// Returns which contacts beside the first push in a run in which nothing can give way.
fn idle_contacts(contacts: &[ElementId], names: &Names) -> String {
    let others = contacts.iter().skip(1);
    let others: String = others.map(|&id| format!(", {}", names.of(id))).collect();
    format!(
        "{others}: in a kinematic run contacts stop nothing: parts follow their motions, through \
         whatever is in their way"
    )
}

/// Returns when and where the rank of the constraints changes.
fn of_rank(change: &RankChange) -> String {
    let (time, rows) = (change.time, change.rows.join(", "));
    match change.change {
        RowChange::Passes => format!(
            "at time {time:.9} the constraints are dependent for a moment: {rows} follows from \
             others where {}",
            place(&change.place)
        ),
        RowChange::Restored => format!(
            "from time {time:.9} on {rows} no longer follows from other constraints, and is used again"
        ),
        RowChange::Exchanged => format!(
            "from time {time:.9} on {rows} is used, in place of constraints that it makes redundant"
        ),
    }
}
