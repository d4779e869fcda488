//! A model and a run of it, for pictures: solved now, or read from files of results.

use super::arguments::{KindName, SpanArgs, UnsolvedArgs};
use super::run::{self, Single};
use super::setup::Asked;
use super::{Failure, complain_in_files, interrupt, remark};
use crate::analysis::session::script::obey;
use crate::analysis::session::{Analysis, Options, Session};
use crate::dataset::surface::Surfaces;
use crate::diagnostic::Diagnostic;
use crate::model::Model;
use crate::report::mechanism::{Dimension, Pair, Pictured};
use crate::results::{self, Run, Status};
use std::path::{Path, PathBuf};

/// A model or a run, as the user names it.
#[derive(clap::Args)]
pub struct Source {
    /// Command file (.acf), dataset (.adm), or results (.res, .parquet, .json, .gra) of a run with
    /// all its parts
    pub file: PathBuf,
    /// Dataset of the results; without it the one of their name beside them
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
    #[command(flatten)]
    pub span: SpanArgs,
    #[command(flatten)]
    pub unsolved: UnsolvedArgs,
}

/// Distances that a picture shows.
#[derive(clap::Args)]
pub struct Dimensions {
    /// Show the distance of two markers as a dimension, as 20,10; its value changes with the
    /// mechanism (repeatable)
    #[arg(long = "dimension", value_name = "I,J")]
    pairs: Vec<Pair>,
}

impl Dimensions {
    /// Adds the dimensions to a picture.
    ///
    /// # Errors
    /// When a marker does not exist, or floats.
    pub fn added_to(&self, mut pictured: Pictured) -> Result<Pictured, Diagnostic> {
        for &pair in &self.pairs {
            let dimension = Dimension::new(&pictured.bodies, pair)?;
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
        let is_dataset = has_ending(&self.file, "adm");
        if !is_dataset && !run::has_commands(&self.file) {
            let run = results::read(&self.file)?;
            let dataset = self.dataset(&run)?;
            let model = run::read_with(&dataset, Asked::All)?.model;
            let folders = [dataset.parent(), self.file.parent()];
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
        let options = self.unsolved.given_to(Options {
            full: true,
            ..Options::default()
        });
        let mut session = Session::new(job.reading.model, &job.base, options);
        session.folders = self
            .file
            .parent()
            .map(Path::to_path_buf)
            .into_iter()
            .collect();
        session.run.record.model = self.file.display().to_string();
        let dataset = job.reading.dataset;
        let status = obey(
            &mut session,
            &job.steps,
            |_, _| (),
            &mut interrupt::Listener,
        )
        .map_err(|errors| Failure::in_model(&dataset, errors))?;
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

    /// Returns the dataset of a run that was read: the one that is named, the one of the same name
    /// beside it, or the one that its record names.
    ///
    /// # Errors
    /// When there is none.
    fn dataset(&self, run: &Run) -> Result<PathBuf, Diagnostic> {
        if let Some(model) = &self.model {
            return Ok(model.clone());
        }
        let recorded = Path::new(&run.record.model);
        let beside = self.file.with_extension("adm");
        let all = [beside, recorded.with_extension("adm")];
        let found = all.into_iter().find(|p| p.is_file());
        found.ok_or_else(|| {
            let what = format!(
                "{}: results say where bodies are, not what they are",
                self.file.display()
            );
            Diagnostic::error("no_model", what).help("name the dataset: --model FILE.adm")
        })
    }
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

/// Returns whether a file has an ending, in any case.
pub fn has_ending(file: &Path, ending: &str) -> bool {
    file.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case(ending))
}
