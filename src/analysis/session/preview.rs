//! Reasons that keep a simulation from beginning, and its warnings: all that can be found before
//! its first step.

use super::{Analysis, Session};
use crate::analysis::system::Purpose;
use crate::analysis::time::valueless::{self, Loss};
use crate::analysis::verify::driving::driving;
use crate::analysis::warning::{AssemblyWarning, Warning};
use crate::analysis::watch::Unwatched;
use crate::diagnostic::{Cause, Diagnostic};
use crate::model::{ElementId, Family};

/// Misalignment of a joint as drawn, relative to the mechanism or in rad, that numbers typed with
/// four digits make.
const TYPED_DIGITS: f64 = 1e-3;

/// Returns whether a warning is about markers that are off by the rounding of typed numbers.
fn is_rounding(warning: &Warning, mechanism: f64) -> bool {
    match warning {
        Warning::Assembly(AssemblyWarning::Misaligned { offset, turn, .. }) => {
            let [offset, turn] = [offset, turn].map(|off| off.as_ref().map_or(0.0, |(by, _)| *by));
            offset < TYPED_DIGITS * mechanism && turn < TYPED_DIGITS
        }
        Warning::Assembly(_)
        | Warning::Scene(_)
        | Warning::Condition(_)
        | Warning::Run(_)
        | Warning::Verification(_) => false,
    }
}

impl Session {
    /// Brings the model into its first state and returns what is wrong with it, and what is
    /// doubtful; motions are looked at until `end`. Nothing is to move afterwards.
    pub fn preview(mut self, analysis: Analysis, end: f64) -> Vec<Diagnostic> {
        self.purpose = Purpose::Preview;
        let mut found = match self.previewed(analysis, end) {
            Ok(found) | Err(found) => found,
        };
        let warned = self.run.record.warnings.iter().map(Diagnostic::from);
        found.extend(warned);
        found
    }

    fn previewed(
        &mut self,
        analysis: Analysis,
        end: f64,
    ) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
        self.check_method()?;
        self.check_settings()?;
        let (system, assembly, analysis) = self.begin(analysis, &mut Unwatched)?;
        let (told, length) = (assembly.warnings.iter(), system.scene.size);
        for warning in told.filter(|w| !is_rounding(w, length)) {
            self.warn(warning.clone());
        }
        for warning in &system.scene.warnings {
            self.warn(Warning::Scene(warning.clone()));
        }
        let mut found = Vec::new();
        for outcome in [
            self.check_masses(&system, analysis),
            self.check_drives(&system, analysis, end),
        ] {
            found.extend(outcome.err().into_iter().flatten());
        }
        let of_model = |element: Option<ElementId>| {
            element.is_some_and(|id| id.kind.family() != Family::Output)
        };
        let lost = valueless::there(system.configured(), &system.numbers, of_model);
        found.extend(lost.map(|lost| {
            let what = match lost.loss {
                Loss::Domain(why) => why,
                Loss::NotFinite | Loss::Pole { .. } => "it has no finite value at the start".into(),
            };
            Diagnostic::error(Cause::Domain, what).element(&lost.function)
        }));
        self.warn_of_splines(self.readings_ahead(&system, end));
        found.extend(driving(&system.scene, &self.model));
        Ok(found)
    }
}
