//! Arguments of a caller that a simulation cannot keep: refused before anything is computed, each
//! by its name.

use super::{Analysis, Session};
use crate::analysis::system::closures::Hook;
use crate::analysis::time::output::{self, Output};
use crate::diagnostic::{Cause, Diagnostic, near_names};
use crate::model::{Formula, Model};

impl Session {
    /// Checks the times that a simulation is asked for.
    ///
    /// # Errors
    /// An end that is no time or has passed, distances of output times that are not positive, more
    /// output times than a run may have, and a limit of work that is no time.
    pub(super) fn check_times(
        &self,
        analysis: Analysis,
        end: f64,
        output: Output,
    ) -> Result<(), Vec<Diagnostic>> {
        let now = self.time();
        let mut wrong = Vec::new();
        let has_end = analysis != Analysis::InitialConditions;
        if has_end && !(end.is_finite() && end >= now) {
            let what = format!("the simulation should end at {end}, but the clock shows {now}");
            let advice = "the end is absolute time, in the unit of the model";
            wrong.push(Diagnostic::error("no_end", what).help(advice));
        }
        if let Output::Every(distance) = output
            && !(distance.is_finite() && distance > 0.0)
        {
            let what = format!("output times {distance} apart");
            let advice = "the distance of output times is positive and finite";
            wrong.push(Diagnostic::error("unfit_value", what).help(advice));
        } else if wrong.is_empty() && output.count(now, end) > output::MOST {
            let what = format!("{} output steps are too many", output.count(now, end));
            let advice = format!("a simulation has {} at most", output::MOST);
            wrong.push(Diagnostic::error("unfit_value", what).help(advice));
        }
        if let Some(limit) = self.options.limit.filter(|limit| limit.is_nan()) {
            let what = format!("the limit of processor time is {limit}");
            wrong.push(Diagnostic::error("unfit_value", what));
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }

    /// Checks that every closure computes something.
    ///
    /// # Errors
    /// Closures under names that no `USER(…)` of the model has.
    pub(super) fn check_closures(&self) -> Result<(), Vec<Diagnostic>> {
        let unused = self
            .hooks
            .iter()
            .filter(|hook| !self.computes_something(hook));
        let wrong: Vec<Diagnostic> = unused
            .map(|hook| computes_nothing(&self.model, &hook.name))
            .collect();
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }

    /// Returns whether a closure stands for a `USER(…)` of the model.
    pub(super) fn computes_something(&self, hook: &Hook) -> bool {
        let all = self.model.formulas();
        (all.iter()).any(|owned| hook.stands_for(owned.element, owned.argument, owned.formula))
    }

    /// Checks that the model has the elements that alone are to be recorded, before there are rows.
    ///
    /// # Errors
    /// Those that it does not have, or that have no results of their own.
    pub(super) fn check_choice(&self) -> Result<(), Vec<Diagnostic>> {
        if self.run.rows() > 0 {
            return Ok(());
        }
        let chosen = self.options.only.iter();
        let wrong = chosen.filter_map(|chosen| chosen.in_model(&self.model).err());
        let wrong: Vec<Diagnostic> = wrong.collect();
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }
}

/// Says that a closure computes nothing, and which names would.
fn computes_nothing(model: &Model, name: &str) -> Diagnostic {
    let what = format!("no USER(…) of the model is computed by the closure `{name}`");
    let said = Diagnostic::error(Cause::UserRoutine, what);
    let mut known = Vec::new();
    for owned in model.formulas() {
        let element = owned.element.to_string();
        let Formula::User { constants, routine } = owned.formula else {
            if element.eq_ignore_ascii_case(name) {
                let advice = format!("{element} has an expression; give it FUNCTION=USER()");
                return said.help(advice);
            }
            continue;
        };
        known.extend(routine.clone());
        known.extend(constants.first().map(ToString::to_string));
        known.push(element);
    }
    let near = near_names(name, known.iter().map(String::as_str));
    if !near.is_empty() {
        return said.help(format!("did you mean {}?", near.join(" or ")));
    }
    match known.is_empty() {
        true => said.help("the model has no FUNCTION=USER(…)"),
        false => said.help(format!(
            "there are closures to give for {}",
            known.join(", ")
        )),
    }
}
