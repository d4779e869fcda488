//! All that is wrong with a model, whoever made it: a file holds finite numbers and arguments that
//! fit, a program may put in anything.

use super::row::{canonical, element_name};
use super::statement::STATEMENTS;
use super::value::{Number, Value};
use crate::diagnostic::{Diagnostic, Error};
use crate::model::{Formula, Model};

impl Model {
    /// Returns everything that does not fit together, in the order of the elements' lines: errors,
    /// and warnings about what cannot be meant. Where numbers are not finite, these alone, for the
    /// rest may follow from them.
    ///
    /// Simulations check their models by themselves.
    ///
    /// # Examples
    /// ```
    /// use cognate::model::{Joint, Model};
    /// let mut model = Model::default();
    /// model.joints.insert(3, Joint { i: 12, j: 21, ..Joint::default() });
    /// let found = model.check();
    /// assert!(found.iter().any(|d| d.message == "I = 12: MARKER/12 does not exist"));
    ///
    /// model.parts.entry(2).or_default().mass = f64::NAN;
    /// assert_eq!(model.check()[0].to_string(), "PART/2: error[unfit_value]: MASS is NaN");
    /// ```
    pub fn check(&self) -> Vec<Diagnostic> {
        let found = not_finite(self);
        if found.is_empty() {
            self.contradictions()
        } else {
            found
        }
    }

    /// Checks that a model can be used.
    ///
    /// # Errors
    /// The errors among what [`Model::check`] finds.
    pub fn checked(&self) -> Result<(), Error> {
        let mut wrong = not_finite(self);
        if wrong.is_empty() {
            wrong = self.errors();
        }
        if wrong.is_empty() {
            return Ok(());
        }
        for d in &mut wrong {
            let name = d.subject().and_then(|s| self.name_of(&s));
            d.name = name.map(str::to_owned);
        }
        Err(wrong.into())
    }
}

/// Returns the numbers of a model that are not finite.
fn not_finite(model: &Model) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for row in STATEMENTS {
        row.visit_values(model, &mut |id, argument, value| {
            if let Some(x) = not_finite_in(value) {
                let keyword = row.argument(argument).map(|a| a.keyword());
                let what = format!("{} is {x}", keyword.unwrap_or_default());
                let element = element_name(&canonical(row.keyword()), id);
                found.push(Diagnostic::error("unfit_value", what).element(element));
            }
        });
    }
    found
}

/// Returns the first number of a value that is not finite.
fn not_finite_in(value: &Value) -> Option<f64> {
    let first = |all: &[Number]| all.iter().map(|n| n.literal).find(|x| !x.is_finite());
    match value {
        Value::Real(x) => first(std::slice::from_ref(x)),
        Value::Reals(all) => first(all),
        Value::Formula(Formula::User { constants, .. }) => {
            constants.iter().copied().find(|x| !x.is_finite())
        }
        Value::Formula(Formula::Expression { .. })
        | Value::Flag
        | Value::Id(_)
        | Value::Ids(_)
        | Value::Word(_)
        | Value::Words(_)
        | Value::Text(_)
        | Value::Texts(_)
        | Value::Raw(_) => None,
    }
}
