//! The one way in which commands write files: never over what this program has not written, but
//! with `--overwrite`, and never over an input.

use super::{Exit, Failure, remark};
use cognate::diagnostic::Diagnostic;
use cognate::disk;
use cognate::results::format::Style;
use cognate::results::{Run, Writing};
use std::path::{Path, PathBuf};

/// The wishes of a user about files that are there already.
#[derive(clap::Args, Clone, Copy, Debug, Default)]
pub struct WritingArgs {
    /// Replace files that this program has not written or that were changed since; they are kept
    /// with a ~ behind their names. Inputs of the command are never replaced
    #[arg(long)]
    overwrite: bool,
}

impl WritingArgs {
    /// Returns the leave to write.
    pub fn leave(self) -> Writing {
        Writing::new(self.overwrite)
    }

    /// Refuses places where nothing may be written, before the work begins.
    ///
    /// # Errors
    /// All of them: files of somebody else, inputs, folders.
    pub fn check<'p>(self, places: impl IntoIterator<Item = &'p PathBuf>) -> Result<(), Failure> {
        let places = places.into_iter();
        let refused = places.filter_map(|place| self.leave().check(place).err());
        let diagnostics: Vec<Diagnostic> = refused.collect();
        match diagnostics.first() {
            None => Ok(()),
            Some(first) => Err(Failure {
                exit: Exit::of(first),
                ..Failure::in_files(Exit::Usage, diagnostics)
            }),
        }
    }

    /// Refuses the same of a command that reads a file first.
    ///
    /// # Errors
    /// As [`WritingArgs::check`].
    pub fn check_beside<'p>(
        self,
        input: &Path,
        places: impl IntoIterator<Item = &'p PathBuf>,
    ) -> Result<(), Failure> {
        disk::note_input(input);
        self.check(places)
    }

    /// Writes bytes to a file.
    ///
    /// # Errors
    /// When it may not be written, or cannot be.
    pub fn bytes(self, place: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
        told(place, self.leave().bytes(place, bytes)?);
        Ok(())
    }

    /// Writes a text to a file.
    ///
    /// # Errors
    /// When it may not be written, or cannot be.
    pub fn text(self, place: &Path, text: &str) -> Result<(), Diagnostic> {
        self.bytes(place, text.as_bytes())
    }

    /// Writes a run to a file, whose name tells the format.
    ///
    /// # Errors
    /// When it may not be written, or cannot be.
    pub fn run(self, run: &Run, place: &Path, style: Style) -> Result<(), Diagnostic> {
        told(place, self.leave().run(run, place, style)?);
        Ok(())
    }
}

/// Says where a file of somebody else is now.
fn told(place: &Path, kept: Option<PathBuf>) {
    if let Some(kept) = kept {
        remark_on_kept(place, &kept);
    }
}

/// Says where a file of somebody else is now.
pub fn remark_on_kept(was: &Path, is: &Path) {
    remark(format!(
        "{} was not written by this program or has been changed: kept as {}",
        disk::text(&was),
        disk::text(&is)
    ));
}
