//! A model and a run of it, for pictures: solved now, or read from files of results.

use super::arguments::{KindName, SpanArgs, UnsolvedArgs};
use super::routines::RoutineArgs;
use super::run::{self, Single};
use super::setup::Asked;
use super::{Failure, complain_in_files, interrupt, piped, recorded, remark};
use cognate::analysis::session::script::obey;
use cognate::analysis::session::{Analysis, Options, Session};
use cognate::diagnostic::Diagnostic;
use cognate::disk;
use cognate::internals::dataset::surface::Surfaces;
use cognate::internals::report::mechanism::{Dimension, Pair, Pictured};
use cognate::model::{ElementKind, Family, Model};
use cognate::results::{Run, Status};
use std::path::{Path, PathBuf};

/// A model or a run, as the user names it.
#[derive(clap::Args)]
pub struct Source {
    /// Command file (.acf), dataset (.adm), or results (.res, .parquet, .json, .gra) of a run with
    /// all its parts; - reads a dataset from standard input
    #[arg(value_parser = piped::model())]
    pub file: PathBuf,
    /// Dataset of the results [default: the one of their name beside them, else that of their
    /// record]
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
    #[command(flatten)]
    pub span: SpanArgs,
    #[command(flatten)]
    pub unsolved: UnsolvedArgs,
    #[command(flatten)]
    routines: RoutineArgs,
}

/// Distances that a picture shows.
#[derive(clap::Args)]
pub struct Dimensions {
    /// Show the distance of two markers as a dimension, as 20,10 or slider.cm,10; its value changes
    /// with the mechanism (repeatable) [default: none]
    #[arg(long = "dimension", value_name = "I,J")]
    pairs: Vec<String>,
}

impl Dimensions {
    /// Adds the dimensions to a picture of a model.
    ///
    /// # Errors
    /// When a marker does not exist, or floats.
    pub fn added_to(&self, model: &Model, mut pictured: Pictured) -> Result<Pictured, Failure> {
        for text in &self.pairs {
            let told = |d| Failure::at_argument("--dimension", text, d);
            let pair = Pair::of(model, text).map_err(told)?;
            let dimension = Dimension::new(&pictured.bodies, pair).map_err(told)?;
            pictured.dimensions.push(dimension);
        }
        Ok(pictured)
    }
}

/// A model and a run of it.
pub struct Moved {
    /// the model
    pub model: Model,
    /// its run
    pub run: Run,
    /// folders in which the files of its shells are looked for
    pub folders: Vec<PathBuf>,
}

/// Makes the picture of a model and one of its runs; says which shells in files are not drawn.
///
/// # Errors
/// When the run does not say where the bodies of the model are.
pub fn pictured(model: &Model, run: &Run, folders: &[PathBuf]) -> Result<Pictured, Diagnostic> {
    let surfaces = Surfaces::read(model, folders);
    for (graphics, why) in &surfaces.unread {
        remark(format!("{graphics} is not drawn: {why}"));
    }
    Pictured::new(model, run, &surfaces)
}

/// Output steps of a dataset when nobody says.
const STEPS: usize = 200;

impl Source {
    /// Solves the model, or reads the run.
    ///
    /// # Errors
    /// When a file has mistakes, or the model cannot work.
    pub fn get(&self) -> Result<Moved, Failure> {
        let is_dataset = is_dataset(&self.file);
        if !is_dataset {
            self.span.refuse_beside(&self.file)?;
        }
        if !is_dataset && !run::has_commands(&self.file) {
            let run = recorded::read(&self.file)?;
            let (file, model) = self.model_of(&run)?;
            let folders = [file.parent(), self.file.parent()];
            let folders = folders.into_iter().flatten().map(Path::to_path_buf);
            return Ok(Moved {
                model,
                run,
                folders: folders.collect(),
            });
        }
        let job = if is_dataset {
            let initial = KindName::InitialConditions;
            let SpanArgs { end, steps, kind } = self.span;
            let kind = kind.or(end.is_none().then_some(initial));
            run::alone(&Single {
                variables: &[],
                model: &self.file,
                dataset: None,
                span: SpanArgs {
                    kind,
                    end,
                    steps: steps.or(Some(STEPS)),
                },
            })?
        } else {
            run::script(&self.file, self.model.as_deref())?
        };
        let mut options = self.unsolved.given_to(Options {
            full: true,
            ..Options::default()
        });
        if is_dataset && self.span.end.is_none() {
            options.skip.extend(without_effect_at_rest());
        }
        let mut session = Session::new(job.reading.model, &job.base, options);
        session.folders = self
            .file
            .parent()
            .map(Path::to_path_buf)
            .into_iter()
            .collect();
        session.run.record.model = disk::text(&self.file);
        let dataset = job.reading.dataset;
        let zero_user = self.unsolved.zero_user;
        let mistake = (self.routines).compute(&mut session, &dataset, zero_user)?;
        let listener = &mut interrupt::Listener;
        let outcome = obey(&mut session, &job.steps, |_, _| (), listener);
        let status = (mistake.before(outcome)).map_err(|e| Failure::in_model(&dataset, e))?;
        if status != Status::Completed {
            remark(&session.run.record.stop_reason);
            complain_in_files(&session.model.doubts());
        }
        Ok(Moved {
            model: session.model,
            run: session.run,
            folders: session.folders,
        })
    }

    /// Returns the model of a run that was read, with its file: the one that is named, the dataset
    /// of the same name beside it, or the one that its record names.
    ///
    /// # Errors
    /// When there is none.
    fn model_of(&self, run: &Run) -> Result<(PathBuf, Model), Failure> {
        let named = Path::new(&run.record.model);
        let itself = || (is_dataset(named) && named.is_file()).then(|| named.to_owned());
        let found = model_beside(&self.file).or_else(itself);
        let found = found.or_else(|| model_beside(named));
        if let Some(dataset) = self.model.clone().or(found) {
            let model = run::read_with(&dataset, Asked::All)?.model;
            return Ok((dataset, model));
        }
        let file = recorded::model_file(&self.file, None)?;
        Ok((file, recorded::model_of(&self.file, None)?))
    }
}

/// Returns the kinds of elements that have no effect on where assembled parts stand: forces, those
/// that are not solved among them.
fn without_effect_at_rest() -> impl Iterator<Item = ElementKind> {
    ElementKind::of(Family::Force)
}

/// Assembles a model, without moving it.
///
/// # Errors
/// Mistakes in the model.
pub fn assembled(
    model: Model,
    name: &str,
    folders: Vec<PathBuf>,
) -> Result<Moved, Vec<Diagnostic>> {
    let options = Options {
        full: true,
        skip: without_effect_at_rest().collect(),
        ..Options::default()
    };
    let mut session = Session::new(model, name, options);
    session.simulate(
        Analysis::InitialConditions,
        0.0,
        1,
        &mut interrupt::Listener,
    )?;
    Ok(Moved {
        model: session.model,
        run: session.run,
        folders,
    })
}

/// Endings of files that are models: datasets, command files of Adams View, datasets of RecurDyn.
const MODELS: [&str; 3] = ["adm", "cmd", "rmd"];

/// Returns whether a file is a model without commands of the solver, by its name.
pub fn is_dataset(file: &Path) -> bool {
    MODELS.iter().any(|ending| has_ending(file, ending))
}

/// Returns the model that has the name of another file, if there is one.
pub fn model_beside(file: &Path) -> Option<PathBuf> {
    let all = MODELS.iter().map(|ending| file.with_extension(ending));
    all.into_iter().find(|model| model.is_file())
}

/// Returns whether a file has an ending, in any case.
pub fn has_ending(file: &Path, ending: &str) -> bool {
    file.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case(ending))
}
