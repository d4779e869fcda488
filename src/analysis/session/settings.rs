//! INTEGRATOR, overruled by the options of a session.

use super::Session;
use crate::analysis::time::options::{self, Options};
use crate::diagnostic::{Diagnostic, counted};
use crate::numeric;

/// Permitted local error when nobody says.
const DEFAULT_ERROR: f64 = 1e-6;

impl Session {
    /// Checks that the method that is asked for exists.
    ///
    /// # Errors
    /// The methods that there are.
    pub(super) fn check_method(&self) -> Result<(), Vec<Diagnostic>> {
        let method = self.integration().method;
        let known = numeric::METHODS.iter().map(|m| m.name);
        if method == "AUTO" || known.clone().any(|name| name == method) {
            return Ok(());
        }
        let names: Vec<&str> = known.chain(["AUTO"]).collect();
        Err(vec![
            Diagnostic::error("method", format!("there is no method `{method}`"))
                .help(format!("the methods are {}", names.join(", "))),
        ])
    }

    /// Returns whether the results so far are those that the session has made: rows follow rows of
    /// the same columns.
    ///
    /// # Errors
    /// A caller has taken away columns, or values of one.
    pub(super) fn check_rows(&self) -> Result<(), Vec<Diagnostic>> {
        let run = &self.run;
        let n = run.held().len();
        let refuse = |what: String| {
            let d = Diagnostic::error("unfit_value", what);
            let help = "copy the results before changing them: session.run.clone()";
            Err(vec![d.help(help)])
        };
        if run.columns.is_empty() {
            return refuse("the results of the session have lost their columns".into());
        }
        match run.columns.iter().find(|c| c.values.len() != n) {
            None => Ok(()),
            Some(c) => refuse(format!(
                "the column {:?} of the results has {} for {}",
                c.name,
                counted(c.values.len(), "value"),
                counted(n, "row")
            )),
        }
    }

    /// Checks that INTEGRATOR and the options have numbers that an integration can keep.
    ///
    /// # Errors
    /// Each number that it cannot.
    pub(super) fn check_settings(&self) -> Result<(), Vec<Diagnostic>> {
        let i = &self.model.integrator;
        let positive = |x: f64| x > 0.0 && !x.is_nan();
        let whole = |k: Option<u32>| k.map(f64::from);
        let initial = &self.model.initial_conditions.numbers;
        let given = [
            (
                "IC",
                "ERROR",
                initial.get("ERROR").copied().filter(|e| !positive(*e)),
            ),
            (
                "--error",
                "the permitted error",
                self.options
                    .error
                    .filter(|e| !(positive(*e) && e.is_finite())),
            ),
            (
                "INTEGRATOR",
                "ERROR",
                i.error.filter(|e| !(positive(*e) && e.is_finite())),
            ),
            ("INTEGRATOR", "HMAX", i.hmax.filter(|h| !positive(*h))),
            ("INTEGRATOR", "HINIT", i.hinit.filter(|h| !positive(*h))),
            (
                "INTEGRATOR",
                "KMAX",
                whole(i.kmax).filter(|k| !positive(*k)),
            ),
            (
                "INTEGRATOR",
                "MAXIT",
                whole(i.maxit).filter(|k| !positive(*k)),
            ),
            (
                "KINEMATICS",
                "HMAX",
                self.kinematic_hmax().filter(|h| !positive(*h)),
            ),
            (
                "INTEGRATOR",
                "HMIN",
                i.hmin.filter(|h| h.is_nan() || *h < 0.0),
            ),
        ];
        let wrong = given.into_iter().filter_map(|(element, name, value)| {
            let what = format!("{name} must be positive, not {}", value?);
            Some(Diagnostic::error("unfit_value", what).element(element))
        });
        let mut wrong: Vec<Diagnostic> = wrong.collect();
        if let (Some(least), Some(most)) = (i.hmin, i.hmax)
            && least > most
        {
            let what = format!("HMIN = {least} is larger than HMAX = {most}");
            wrong.push(Diagnostic::error("unfit_value", what).element("INTEGRATOR"));
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }

    /// Returns the longest step of KINEMATICS.
    pub(super) fn kinematic_hmax(&self) -> Option<f64> {
        self.model.kinematics.numbers.get("HMAX").copied()
    }

    /// Returns the options of an integration: INTEGRATOR, overruled by those of the session.
    pub(super) fn integration(&self) -> Options {
        let i = &self.model.integrator;
        let asked = self
            .options
            .method
            .as_deref()
            .or(i.method.as_deref())
            .unwrap_or("AUTO");
        Options {
            error: self.options.error.or(i.error).unwrap_or(DEFAULT_ERROR),
            method: options::method_named(asked),
            h_initial: i.hinit.map(|h| h * self.pace.steps),
            h_max: self.pace.longest_step(i.hmax.unwrap_or(f64::INFINITY)),
            h_min: i.hmin.unwrap_or(0.0),
            max_newton: i.maxit.map(|k| k as usize),
            max_steps: self.options.max_steps.unwrap_or(usize::MAX),
            ..Options::default()
        }
    }
}
