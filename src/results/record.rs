//! The record of a run: how it ended, what it cost, and what the user should know.

use super::run::catch_up;
use super::{Column, Kind, Seconds, digits_of_six};
use crate::diagnostic::{Diagnostic, Subject};
use crate::scalar::Scalar;
use std::collections::BTreeMap;

/// The way in which a run, or one simulation of it, ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Status {
    /// everything that was asked for was done
    #[default]
    Completed,
    /// the model has no consistent configuration, or contradicts itself
    Model,
    /// no equilibrium was found
    NoEquilibrium,
    /// the integration could not go on
    Stopped,
    /// a limit of time, memory or steps was reached
    Limit,
    /// the user asked to stop
    Interrupted,
}

impl Status {
    /// Every status.
    pub const ALL: [Self; 6] = [
        Status::Completed,
        Status::Model,
        Status::NoEquilibrium,
        Status::Stopped,
        Status::Limit,
        Status::Interrupted,
    ];

    /// Returns its word in the run record.
    pub fn word(self) -> &'static str {
        match self {
            Status::Completed => "completed",
            Status::Model => "model_error",
            Status::NoEquilibrium => "no_equilibrium",
            Status::Stopped => "stopped",
            Status::Limit => "limit",
            Status::Interrupted => "interrupted",
        }
    }
    /// Returns the exit code of a program that ends this way.
    pub fn exit_code(self) -> u8 {
        match self {
            Status::Completed => 0,
            Status::Model => 4,
            Status::NoEquilibrium => 5,
            Status::Stopped => 6,
            Status::Limit => 7,
            Status::Interrupted => 130,
        }
    }
}

/// The work that a method did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// accepted steps
    pub steps: u64,
    /// rejected steps
    pub rejected_steps: u64,
    /// evaluations of rates or residuals
    pub evaluations: u64,
    /// evaluations of the Jacobian
    pub jacobians: u64,
    /// factorizations of a matrix
    pub factorizations: u64,
    /// accepted steps that stability held short
    pub stability_limited: u64,
    /// accepted steps that ended at an event
    pub event_limited: u64,
    /// accepted steps that ended at an output time
    pub output_limited: u64,
}

impl std::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.steps += other.steps;
        self.rejected_steps += other.rejected_steps;
        self.evaluations += other.evaluations;
        self.jacobians += other.jacobians;
        self.factorizations += other.factorizations;
        self.stability_limited += other.stability_limited;
        self.event_limited += other.event_limited;
        self.output_limited += other.output_limited;
    }
}

/// The account of energy over all simulations that move something, in the model's units.
///
/// ```text
/// ΔT + ΔV + stored = by_motions + by_functions − dissipated          up to the error
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// kinetic energy at the start and at the end
    pub kinetic: [f64; 2],
    /// potential energy in gravity at the start and at the end; zero at the origin of ground
    pub potential: [f64; 2],
    /// stored since the start in springs, fields and contacts
    pub stored: f64,
    /// put in by motions
    pub by_motions: f64,
    /// put in by forces that functions give
    pub by_functions: f64,
    /// lost in dampers, friction and contacts
    pub dissipated: f64,
    /// largest kinetic energy, change of potential energy, or work
    pub scale: f64,
    /// largest error of the balance
    pub imbalance: f64,
}

impl Energy {
    /// Returns the error of the balance, relative to the largest part of the account; zero where
    /// nothing moved.
    pub fn error(&self) -> f64 {
        if self.scale == 0.0 {
            0.0
        } else {
            self.imbalance / self.scale
        }
    }
}

/// Share of the outputs at which the usual bar of a channel holds.
pub(crate) const USUAL_SHARE: f64 = 0.95;

/// The bars of error of a run, in short.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Accuracy {
    /// requests of the further runs that bars come from, one per simulation that integrates
    pub companions: Vec<f64>,
    /// one per column that tables show, in order
    pub channels: Vec<ChannelAccuracy>,
}

/// The bars of error of one column, in short.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChannelAccuracy {
    /// name of the column
    pub channel: String,
    /// its unit
    pub unit: String,
    /// largest bar, in that unit
    pub largest_bar: f64,
    /// the same over the largest value of the column
    pub relative: f64,
    /// bar that 19 of 20 outputs do not exceed, in that unit: an output within an impact does
    pub usual_bar: f64,
    /// the same over the largest value of the column
    pub usual: f64,
    /// the time from which on bars are as large as the range of the values until the end
    pub lost_from: Option<f64>,
}

impl ChannelAccuracy {
    /// Returns how many digits of the largest value can be believed at 19 of 20 outputs.
    pub fn digits(&self) -> f64 {
        (-Scalar::log10(self.usual.max(f64::EPSILON))).max(0.0)
    }

    /// Returns how many digits of the largest value can be believed at all outputs.
    pub fn least_digits(&self) -> f64 {
        (-Scalar::log10(self.relative.max(f64::EPSILON))).max(0.0)
    }
}

impl ChannelAccuracy {
    /// Takes further bars, of values up to `size`: the largest so far of each kind counts, and the
    /// first time from which on the phase is lost.
    pub(crate) fn see(&mut self, bars: &[f64], size: f64, lost_from: Option<f64>) {
        let mut bars: Vec<f64> = bars.iter().copied().filter(|b| b.is_finite()).collect();
        bars.sort_by(f64::total_cmp);
        let usual = (USUAL_SHARE * bars.len() as f64).ceil() as usize;
        let usual = bars.get(usual.saturating_sub(1)).copied().unwrap_or(0.0);
        let largest = bars.last().copied().unwrap_or(0.0);
        let relative = |bar: f64| if size > 0.0 { bar / size } else { 0.0 };
        self.largest_bar = self.largest_bar.max(largest);
        self.usual_bar = self.usual_bar.max(usual);
        self.relative = self.relative.max(relative(largest));
        self.usual = self.usual.max(relative(usual));
        self.lost_from = self.lost_from.or(lost_from);
    }
}

impl Accuracy {
    /// Returns the places of the entries of some columns, new ones where there are none.
    pub(crate) fn places<'a>(&mut self, columns: impl Iterator<Item = &'a Column>) -> Vec<usize> {
        let names = self.channels.iter().map(|c| c.channel.clone());
        let known: BTreeMap<String, usize> = names.zip(0..).collect();
        let mut place = |column: &Column| {
            known.get(&column.name).copied().unwrap_or_else(|| {
                self.channels.push(ChannelAccuracy {
                    channel: column.name.clone(),
                    unit: column.unit.clone(),
                    ..ChannelAccuracy::default()
                });
                self.channels.len() - 1
            })
        };
        columns.map(&mut place).collect()
    }

    /// Says how many digits to believe, and of which channel the fewest; empty where nothing is
    /// known.
    pub fn sentence(&self) -> String {
        let Some(worst) = self.worst() else {
            return String::new();
        };
        let [usual, least] = [worst.digits(), worst.least_digits()].map(|d| format!("{d:.1}"));
        let digits = match (usual.as_str(), usual == least) {
            ("0.0", _) => "no digit".to_owned(),
            (_, true) => format!("{usual} digits"),
            (_, false) => format!("{usual} digits ({least} where it is least known)"),
        };
        let size = match worst.usual > 0.0 {
            true => {
                let size = format!("{:.2e}", worst.usual_bar / worst.usual);
                format!(" of {}", digits_of_six(size.parse().unwrap_or(f64::NAN)))
            }
            false => String::new(),
        };
        let bar = format!("±{:.1e}{size} {}", worst.usual_bar, worst.unit);
        let mut text = format!(
            "believe {digits}: {} is the worst, {}",
            worst.channel,
            bar.trim_end()
        );
        let lost = self.channels.iter();
        let lost = lost.filter_map(|c| Some((c.lost_from?, &c.channel)));
        if let Some((t, channel)) = lost.min_by(|a, b| a.0.total_cmp(&b.0)) {
            text += &format!(
                "; the phase is lost from time {} on: {channel} may be anything it reaches",
                digits_of_six(t)
            );
        }
        text
    }

    /// Returns the channel with the largest usual bar, relative to its values.
    pub fn worst(&self) -> Option<&ChannelAccuracy> {
        let known = self.channels.iter().filter(|c| !c.usual.is_nan());
        known.max_by(|a, b| a.usual.total_cmp(&b.usual))
    }
}

/// The loads that were chosen for a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Loads {
    /// names of load cases and loads, as they were chosen
    pub chosen: Vec<String>,
    /// the loads that act
    pub acting: Vec<String>,
    /// the loads of the model that do not
    pub left_out: Vec<String>,
}

/// The table that gave a run the inputs of its plants.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct InputTable {
    /// its file, as the user named it
    pub file: String,
    /// whether its samples were held, each until the next
    pub held: bool,
}

/// The facts about a run, as its JSON record holds them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// why it ended
    pub status: Status,
    /// why it ended early, as a code that `cognate explain` knows; empty: everything was done
    pub stop_code: &'static str,
    /// the same in a sentence
    pub stop_reason: String,
    /// the file that was run, as the user named it
    pub model: String,
    /// a text that tells whether a model has the markers of the run
    pub markers: String,
    /// the loads that were chosen; `None`: all loads of the model act
    pub loads: Option<Loads>,
    /// the table of the inputs of plants; `None`: they are those of the model
    pub inputs: Option<InputTable>,
    /// the method that integrated, and why, when the program chose
    pub method: String,
    /// requested error
    pub error: Option<f64>,
    /// where the time went
    pub seconds: Seconds,
    /// processor time of solving, by the thread that solves, in s; the mean where it is repeated
    pub solve_processor_seconds: f64,
    /// how often it was solved to time it
    pub repeats: u32,
    /// totals of all simulations
    pub counts: Counts,
    /// degrees of freedom
    pub freedom: i64,
    /// rows left out because others imply them, by name
    pub redundant: Vec<String>,
    /// when and where the rank of the rows changed
    pub rank_changes: Vec<RankChange>,
    /// where energy came from and where it went
    pub energy: Energy,
    /// bars of error, where they were asked for
    pub accuracy: Option<Accuracy>,
    /// largest residual of a constraint row over the run; `None`: there are no rows
    pub constraint_drift: Option<f64>,
    /// what the user should know although the run went on
    pub warnings: Vec<Warning>,
    /// what is doubted in the files that were read, with places
    pub doubts: Vec<Diagnostic>,
    /// jumps of what motions prescribe that were run all the same
    pub piecewise: Vec<Jump>,
    /// one per SIMULATE command
    pub simulations: Vec<Simulation>,
}

impl Record {
    /// Becomes a later state of the record of the same run; only simulations since are copied.
    pub(super) fn catch_up(&mut self, later: &Self) {
        let Self {
            status,
            stop_code,
            stop_reason,
            model,
            markers,
            loads,
            inputs,
            method,
            error,
            seconds,
            solve_processor_seconds,
            repeats,
            counts,
            freedom,
            redundant,
            rank_changes,
            energy,
            accuracy,
            constraint_drift,
            warnings,
            doubts,
            piecewise,
            simulations,
        } = later;
        self.status.clone_from(status);
        self.stop_code.clone_from(stop_code);
        self.stop_reason.clone_from(stop_reason);
        self.model.clone_from(model);
        self.markers.clone_from(markers);
        self.loads.clone_from(loads);
        self.inputs.clone_from(inputs);
        self.method.clone_from(method);
        self.error.clone_from(error);
        self.seconds.clone_from(seconds);
        self.solve_processor_seconds
            .clone_from(solve_processor_seconds);
        self.repeats.clone_from(repeats);
        self.counts.clone_from(counts);
        self.freedom.clone_from(freedom);
        self.redundant.clone_from(redundant);
        self.rank_changes.clone_from(rank_changes);
        self.energy.clone_from(energy);
        self.accuracy.clone_from(accuracy);
        self.constraint_drift.clone_from(constraint_drift);
        self.warnings.clone_from(warnings);
        self.doubts.clone_from(doubts);
        self.piecewise.clone_from(piecewise);
        self.simulations.pop();
        catch_up(&mut self.simulations, simulations);
    }

    /// Returns the sentences of its warnings.
    pub fn warned(&self) -> Vec<String> {
        self.warnings.iter().map(Warning::sentence).collect()
    }
}

/// A warning: its kind, the element, and the rest of the sentence.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// stable short name of its kind, which `cognate explain` explains
    pub code: &'static str,
    /// the element or column that its sentence begins with
    pub subject: Option<Subject>,
    /// the name that the dataset gives that element
    pub name: Option<String>,
    /// the sentence after the subject, from the separator on; all of it where there is no subject
    pub rest: String,
}

impl Warning {
    /// Returns the sentence, with the name of the element where the dataset gives one: "JOINT/47
    /// 'hinge': …".
    pub fn sentence(&self) -> String {
        let name = self.name.as_deref();
        let subject = self.subject.as_ref().map(|s| s.named(name));
        subject.unwrap_or_default() + &self.rest
    }
    /// Returns what is said of the subject, without the separator before it.
    pub fn message(&self) -> &str {
        self.rest.trim_start_matches([':', ' '])
    }
}

impl From<&Warning> for Diagnostic {
    fn from(w: &Warning) -> Self {
        let mut d = Diagnostic::warning(w.code, w.message());
        d.name.clone_from(&w.name);
        match &w.subject {
            Some(subject) => d.element(subject.clone()),
            None => d,
        }
    }
}

/// A jump of what a MOTION prescribes.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// user's number of the MOTION
    pub motion: u32,
    /// when
    pub at: f64,
    /// the quantity that jumps
    pub of: Quantity,
    /// by how much
    pub by: f64,
}

/// A quantity that a MOTION prescribes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// a length or an angle
    Displacement,
    /// its rate
    Velocity,
    /// the rate of that
    Acceleration,
}

impl Quantity {
    /// Returns its word in sentences and in the run record.
    pub fn word(self) -> &'static str {
        match self {
            Quantity::Displacement => "displacement",
            Quantity::Velocity => "velocity",
            Quantity::Acceleration => "acceleration",
        }
    }
}

/// A change of the rank of the rows during a simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct RankChange {
    /// when
    pub time: f64,
    /// what happened to the rows
    pub change: RowChange,
    /// the rows concerned
    pub rows: Vec<String>,
    /// coordinates there: names and values
    pub place: Vec<(String, f64)>,
}

/// An event in the dependence of rows on each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowChange {
    /// the rows depend on others at that position alone
    Passes,
    /// the rows are kept from there in place of others
    Exchanged,
    /// the rows followed from others and no longer do
    Restored,
}

impl RowChange {
    /// Returns its word in the run record.
    pub fn word(self) -> &'static str {
        match self {
            RowChange::Passes => "passes",
            RowChange::Exchanged => "other rows",
            RowChange::Restored => "restored",
        }
    }
}

/// The facts about one simulation.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// what it was
    pub kind: Kind,
    /// clock at its start
    pub start: f64,
    /// clock at its end
    pub end: f64,
    /// rows it wrote
    pub outputs: usize,
    /// the method
    pub method: String,
    /// why it ended
    pub status: Status,
    /// why it ended early, as a code that `cognate explain` knows; empty: everything was done
    pub stop_code: &'static str,
    /// the same in a sentence
    pub stop_reason: String,
    /// solving alone, in s; the median where it is repeated
    pub solve_seconds: f64,
    /// processor time of it, in s; the mean where it is repeated
    pub solve_processor_seconds: f64,
    /// what the method did
    pub counts: Counts,
    /// names of the worst rows or elements where it stopped
    pub worst: Vec<String>,
}

impl Simulation {
    /// Makes a simulation that has not done anything yet.
    pub fn new(kind: Kind, start: f64) -> Self {
        Self {
            kind,
            start,
            end: start,
            outputs: 0,
            method: String::new(),
            status: Status::Completed,
            stop_code: "",
            stop_reason: String::new(),
            solve_seconds: 0.0,
            solve_processor_seconds: 0.0,
            counts: Counts::default(),
            worst: Vec::new(),
        }
    }
}
