//! A state as values by their names: to be looked at, changed, and gone on from.

use super::Session;
use super::state::Saved;
use crate::diagnostic::{Diagnostic, Error, near_names};
use crate::model::{ElementId, ElementKind};
use crate::scene::layout::Layout;
use crate::space::MarkerState;

impl Session {
    /// Returns where the session stands: its model, and the state that the last simulation left.
    ///
    /// [`save`](Self::save) writes the same as a text.
    ///
    /// ```
    /// use cognate::{Analysis, Model, Options, Session};
    /// let model = Model::read("examples/slider_crank.adm")?;
    /// let mut session = Session::new(model, "crank", Options::default());
    /// session.run_to(Analysis::Dynamic, 0.5, 10)?;
    /// let there = session.state();
    /// session.run_to(Analysis::Dynamic, 1.0, 10)?;
    /// session.set_state(&there)?;
    /// assert_eq!(session.time(), 0.5);
    /// assert!(there.values().any(|(name, _)| name.contains("JOINT")));
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn state(&self) -> Saved {
        Saved {
            model: self.model.clone(),
            carried: self.carried.clone(),
        }
    }

    /// Goes on from a state, with its model; the rows so far stay.
    ///
    /// # Errors
    /// Those of [`reload`](Self::reload).
    pub fn set_state(&mut self, state: &Saved) -> Result<(), Error> {
        self.reload(state.clone())
    }
}

impl Saved {
    /// Returns its time; 0 before the first simulation.
    pub fn time(&self) -> f64 {
        self.carried.as_ref().map_or(0.0, |c| c.t)
    }

    /// Returns the unknowns of the equations by their names, with their values: positions,
    /// velocities and further states in the units of the model, angles in radians. Nothing before
    /// the first simulation.
    pub fn values(&self) -> impl Iterator<Item = (String, f64)> {
        let known = self.carried.iter().flat_map(|c| {
            let numbers = c.numbers.iter().skip(Layout::STATE);
            c.unknowns.iter().zip(numbers)
        });
        known.map(|(unknown, &x)| (unknown.to_string(), x))
    }

    /// Returns the value of an unknown.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.values()
            .find(|(known, _)| known == name)
            .map(|(_, x)| x)
    }

    /// Gives an unknown another value. The next simulation puts positions onto the constraints
    /// again, and velocities with them.
    ///
    /// # Errors
    /// A name that is none of [`values`](Self::values), and a number that is not finite.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), Error> {
        if !value.is_finite() {
            let what = format!("{name} is {value}");
            return Err(Diagnostic::error("unfit_value", what).into());
        }
        let place = self.values().position(|(known, _)| known == name);
        let known: Vec<String> = self.values().map(|(name, _)| name).collect();
        match (place, &mut self.carried) {
            (Some(k), Some(carried)) => {
                carried.numbers[Layout::STATE + k] = value;
                carried.left = None;
                Ok(())
            }
            _ => {
                let what = format!("the state has no unknown `{name}`");
                let said = Diagnostic::error("unknown_name", what);
                let near = near_names(name, known.iter().map(String::as_str));
                Err(match near.is_empty() {
                    true => said.into(),
                    false => said
                        .help(format!("did you mean {}?", near.join(" or ")))
                        .into(),
                })
            }
        }
    }

    /// Returns place, orientation, velocities and accelerations of a part in ground, by its number;
    /// accelerations are zero where they were not computed.
    pub fn part(&self, number: u32) -> Option<MarkerState<f64>> {
        self.body(ElementKind::Part.id(number))
    }

    /// Returns the same of a part or point mass.
    pub fn body(&self, id: ElementId) -> Option<MarkerState<f64>> {
        let parts = &self.carried.as_ref()?.parts;
        parts
            .iter()
            .find(|(part, _)| *part == id)
            .map(|(_, state)| *state)
    }
}
