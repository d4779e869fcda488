//! `USER(…)` as Python callables.

use crate::watch::Raised;
use cognate::analysis::session::Session;
use cognate::internals::system::closures::Call;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyFloat;

/// A callable under the name of what it computes.
#[derive(Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub struct Routine {
    /// an element ("SFORCE/3"), the text of ROUTINE, or the first number of `USER(…)`
    name: String,
    /// expressions whose values it is given
    inputs: Vec<String>,
    /// called with time, the numbers of USER and the values; returns a number or several
    law: Py<PyAny>,
}

impl Routine {
    /// Registers the callable with a session. What it raises ends the simulation.
    pub fn register(self, session: &mut Session, raised: &Raised) {
        let (name, inputs, law) = self.law(raised);
        let inputs: Vec<&str> = inputs.iter().map(String::as_str).collect();
        session.register(&name, &inputs, law);
    }

    /// Returns its name, its inputs and its law, which keeps what the callable raises.
    pub fn law(
        self,
        raised: &Raised,
    ) -> (String, Vec<String>, impl Fn(&Call<'_>, &mut [f64]) + use<>) {
        let Routine { name, inputs, law } = self;
        let raised = raised.clone();
        let law = move |call: &Call<'_>, results: &mut [f64]| {
            // after an exception the simulation ends at its next step
            if raised.is_set() {
                return;
            }
            let called = Python::attach(|py| ask(py, &law, call, results));
            if let Err(e) = called {
                raised.keep(e);
            }
        };
        (name, inputs, law)
    }
}

/// Calls a routine and puts what it returns into the results.
fn ask(py: Python<'_>, law: &Py<PyAny>, call: &Call<'_>, results: &mut [f64]) -> PyResult<()> {
    let constants = PyArray1::from_slice(py, call.constants);
    let values = PyArray1::from_slice(py, call.values);
    let found = law.call1(py, (call.time, constants, values))?;
    let found = found.bind(py);
    let numbers: Vec<f64> = match found.cast::<PyFloat>() {
        Ok(number) => vec![number.value()],
        Err(_) => match found.extract::<f64>() {
            Ok(number) => vec![number],
            Err(_) => found
                .try_iter()?
                .map(|x| x?.extract())
                .collect::<PyResult<_>>()?,
        },
    };
    if numbers.len() > results.len() || numbers.is_empty() {
        let (n, most, element) = (numbers.len(), results.len(), call.element);
        return Err(PyValueError::new_err(format!(
            "the routine of {element} has returned {}; it computes at most {most}",
            cognate::diagnostic::counted(n, "number")
        )));
    }
    if let Some(x) = numbers.iter().find(|x| !x.is_finite()) {
        let element = call.element;
        return Err(PyValueError::new_err(format!(
            "the routine of {element} has returned {x} at time {}",
            call.time
        )));
    }
    results[..numbers.len()].copy_from_slice(&numbers);
    Ok(())
}
