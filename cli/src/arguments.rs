//! Options that several commands take, each written once: how long a run is, how it is integrated,
//! what is not solved, and what ends it early.

use super::{Failure, limit};
use clap::builder::{PossibleValue, PossibleValuesParser};
use cognate::analysis::session::Options;
use cognate::dataset::command::SimulationKind;
use cognate::disk;
use cognate::internals::time::options::METHODS_OF_ADAMS;
use cognate::model::ElementKind;
use cognate::numeric::METHODS;
use std::path::Path;

/// The kind of a simulation, on the command line and in a set-up.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum KindName {
    Dynamic,
    Kinematic,
    Static,
    Transient,
    InitialConditions,
}

impl From<KindName> for SimulationKind {
    fn from(name: KindName) -> Self {
        match name {
            KindName::Dynamic => SimulationKind::Dynamic,
            KindName::Kinematic => SimulationKind::Kinematic,
            KindName::Static => SimulationKind::Static,
            KindName::Transient => SimulationKind::Transient,
            KindName::InitialConditions => SimulationKind::InitialConditions,
        }
    }
}

/// The one simulation of a dataset without command file.
#[derive(clap::Args, Clone, Copy, Debug, Default)]
pub struct SpanArgs {
    /// End of the simulation, for a dataset without command file [default: that of MODEL.toml,
    /// needed without it]
    #[arg(long, value_name = "TIME")]
    pub end: Option<f64>,
    /// Output steps, for a dataset without command file [default: those of MODEL.toml, else 50]
    #[arg(long, value_name = "N", value_parser = whole_from_one)]
    pub steps: Option<usize>,
    /// Kind of simulation, for a dataset without command file [default: that of MODEL.toml, else
    /// transient: kinematic where all is driven, else dynamic]
    #[arg(long = "type", value_name = "KIND", value_enum)]
    pub kind: Option<KindName>,
}

/// Error and method of the integration.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct IntegrationArgs {
    /// Permitted local error of the integration, relative to the magnitude of each unknown
    /// [default: that of INTEGRATOR, else 1e-6]
    #[arg(long, value_name = "E")]
    pub error: Option<f64>,
    /// Method of integration [default: that of INTEGRATOR, else AUTO]
    #[arg(long, value_name = "NAME", value_parser = methods(), ignore_case = true)]
    pub method: Option<String>,
}

/// The treatment of what is not solved.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct UnsolvedArgs {
    /// Leave out elements of this kind where they are not solved (repeatable) [default: none]
    #[arg(long = "skip-unsupported", value_name = "KEYWORD")]
    pub skip: Vec<ElementKind>,
    /// Take what USER(…) would compute as zero
    #[arg(long = "zero-user")]
    pub zero_user: bool,
}

/// Ways of a run through jumps, and limits of its work.
#[derive(clap::Args, Clone, Debug, Default)]
pub struct LimitArgs {
    /// Run motions whose displacement or velocity jumps, piece by piece
    #[arg(long)]
    pub piecewise: bool,
    /// Steps that a simulation may try before it ends early, with exit code 7 [default: any number]
    #[arg(long, value_name = "N")]
    pub max_steps: Option<usize>,
    /// Processor time after which a run ends with its results so far, and exit code 7: 60s, 2min
    /// [default: any time]
    #[arg(long, value_name = "TIME", value_parser = limit::seconds)]
    pub limit: Option<f64>,
}

/// Reads the name of a method: ours, or one of Adams that a dataset may name.
pub fn methods() -> PossibleValuesParser {
    let ours = METHODS
        .iter()
        .map(|m| PossibleValue::new(m.name).help(m.summary));
    let chosen = PossibleValue::new("AUTO").help("the one that fits, and another on the way");
    let adams = METHODS_OF_ADAMS.iter().flat_map(|(_, names)| *names);
    let adams = adams.map(|name| PossibleValue::new(*name).hide(true));
    [chosen]
        .into_iter()
        .chain(ours)
        .chain(adams)
        .collect::<Vec<_>>()
        .into()
}

/// Reads a whole number from 1 on.
pub fn whole_from_one(text: &str) -> Result<usize, String> {
    let found = text.parse().ok().filter(|n| *n > 0);
    found.ok_or_else(|| "it is a whole number from 1 on".to_owned())
}

impl SpanArgs {
    /// Refuses these options beside a file that says itself what is simulated: they would change
    /// nothing.
    ///
    /// # Errors
    /// One of them is given.
    pub fn refuse_beside(&self, file: &Path) -> Result<(), Failure> {
        let given = [
            (self.end.is_some(), "--end"),
            (self.steps.is_some(), "--steps"),
            (self.kind.is_some(), "--type"),
        ];
        let Some((_, name)) = given.into_iter().find(|(is_given, _)| *is_given) else {
            return Ok(());
        };
        Err(Failure::usage(format!(
            "{name} is for a dataset without command file; {} says itself what is simulated",
            disk::text(&file)
        )))
    }
}

/// Returns how many threads to work on: those asked for, else one for each processor.
pub fn threads(asked: Option<usize>) -> usize {
    asked.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
}

impl IntegrationArgs {
    /// Returns options with this error and method.
    pub fn given_to(&self, options: Options) -> Options {
        Options {
            error: self.error,
            method: self.method.clone(),
            ..options
        }
    }
}

impl UnsolvedArgs {
    /// Returns options with this treatment.
    pub fn given_to(&self, options: Options) -> Options {
        Options {
            skip: self.skip.iter().copied().collect(),
            zero_user: self.zero_user,
            ..options
        }
    }
}

impl LimitArgs {
    /// Returns options with these limits.
    pub fn given_to(&self, options: Options) -> Options {
        Options {
            piecewise: self.piecewise,
            max_steps: self.max_steps,
            limit: self.limit,
            ..options
        }
    }
}
