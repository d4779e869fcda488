//! Inputs that the functions of constraints may read: a MOTION time alone, a GCON time, places and
//! velocities.
//!
//! A constraint holds together with its rates up to accelerations. Those of a function of time come
//! from the function itself, those of a function of places and velocities from how markers move; a
//! function that reads accelerations, forces or states has no such rates and is refused, with the
//! name of what it reads and through which VARIABLE.

use super::{Entry, Scene};
use crate::expr::measures::{Family, Measure};
use crate::expr::program::Input;
use crate::model::{ElementKind, Model};
use std::fmt;

/// Inputs that a function may read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Allowed {
    /// TIME, MODE, numbers of an ARRAY, VARIABLEs of these
    Time,
    /// displacements, angles and velocities of markers as well
    Motion,
}

/// Something that a function reads although it may not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Offence {
    /// what is read
    input: Input,
    /// user's number of the VARIABLE that reads it, where it is not the function itself
    variable: Option<u32>,
    /// why it may not be read
    why: Refusal,
}

/// Why a function may not read an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Refusal {
    /// a VARIABLE that depends on itself
    VariableLoop,
    /// a VARIABLE that does not exist
    NoVariable,
    /// an equation without a rate
    NoRate,
    /// an entry of an ARRAY that depends on itself
    Loop,
    /// an entry of an ARRAY that is no number
    NoNumber,
    /// a delayed value, which has no rates
    Delayed,
    /// a place that no function of the model is
    NoFunction,
    /// the place of a floating marker
    FloatingMarker,
    /// a place
    Place,
    /// a velocity
    Velocity,
    /// an acceleration
    Acceleration,
    /// a force
    Force,
    /// a state
    State,
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Refusal::VariableLoop => "its VARIABLE depends on itself",
            Refusal::NoVariable => "there is no such VARIABLE",
            Refusal::NoRate => "its equation does not tell its rate",
            Refusal::Loop => "it depends on itself",
            Refusal::NoNumber => "it is no number of an ARRAY with NUMBERS",
            Refusal::Delayed => "a delayed value has no rates",
            Refusal::NoFunction => "it is no function of the model",
            Refusal::FloatingMarker => {
                "it depends on a floating marker, whose place other constraints find"
            }
            Refusal::Place => "it depends on where the parts are",
            Refusal::Velocity => "it depends on how the parts move",
            Refusal::Acceleration => "it depends on accelerations",
            Refusal::Force => "it depends on forces",
            Refusal::State => "it is a state with equations of its own",
        })
    }
}

impl Offence {
    /// Returns the sentence after the element: "its function reads DX(1,2) (in VARIABLE/7): it
    /// depends on where the parts are".
    pub(super) fn rest(&self, model: &Model) -> String {
        let within = self
            .variable
            .map(|id| model.called(ElementKind::Variable.id(id)));
        let within = within.map_or_else(String::new, |variable| format!(" (in {variable})"));
        let read = input_name(self.input);
        format!("its function reads {read}{within}: {}", self.why)
    }
}

/// The first thing that a formula reads although it may not.
pub(super) fn offence(scene: &Scene, formula: usize, allowed: Allowed) -> Option<Offence> {
    let mut visits = vec![Visit::Untouched; scene.formulas.len()];
    *visits.get_mut(formula)? = Visit::Open;
    // formula, the input that is looked at next, the innermost VARIABLE around it
    let mut path = vec![(formula, 0, None)];
    while let Some((formula, next, variable)) = path.last_mut() {
        let (here, around) = (*formula, *variable);
        let inputs = scene.formulas[here].program.inputs();
        let Some(&input) = inputs.get(*next) else {
            visits[here] = Visit::Done;
            path.pop();
            continue;
        };
        *next += 1;
        let (read, variable, circular) = match step(scene, input, allowed) {
            Step::Refused(why) => {
                let variable = around;
                return Some(Offence {
                    input,
                    variable,
                    why,
                });
            }
            Step::Permitted => continue,
            Step::Variable(id, v) => (v, Some(id), Some(Refusal::VariableLoop)),
            Step::Entry(f) => (f, around, Some(Refusal::Loop)),
            // a rate may depend on the state itself
            Step::Rate(f) => (f, around, None),
        };
        match (visits[read], circular) {
            (Visit::Untouched, _) => {
                visits[read] = Visit::Open;
                path.push((read, 0, variable));
            }
            (Visit::Open, Some(why)) => {
                let variable = around;
                return Some(Offence {
                    input,
                    variable,
                    why,
                });
            }
            (Visit::Open, None) | (Visit::Done, _) => {}
        }
    }
    None
}

/// The progress of the search with a formula.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Visit {
    Untouched,
    Open,
    Done,
}

/// Where an input of a formula leads.
enum Step {
    /// nowhere: it may be read
    Permitted,
    /// nowhere: it may not be read
    Refused(Refusal),
    /// to the formula of a VARIABLE; its number
    Variable(u32, usize),
    /// to the formula of an entry of an ARRAY
    Entry(usize),
    /// to the formula of the rate of a state
    Rate(usize),
}

fn step(scene: &Scene, input: Input, allowed: Allowed) -> Step {
    if let Input::Measure(Measure::Varval, [id, ..]) = input {
        return match scene.variables.get(&id) {
            Some(&v) => Step::Variable(id, v),
            None => Step::Refused(Refusal::NoVariable),
        };
    }
    if let (Some(equation), Allowed::Time) = (state(scene, input), allowed) {
        let d = &scene.differentials[equation];
        if d.implicit || d.state.is_none() {
            return Step::Refused(Refusal::NoRate);
        }
        return Step::Rate(d.formula);
    }
    if let Some(Entry::Formula(f)) = entry(scene, input) {
        return Step::Entry(f);
    }
    refused(scene, input, allowed).map_or(Step::Permitted, Step::Refused)
}

/// The entry of an ARRAY that an input is.
fn entry(scene: &Scene, input: Input) -> Option<Entry> {
    let Input::Measure(Measure::Aryval, [id, k, ..]) = input else {
        return None;
    };
    let entries = scene.arrays.get(&id)?;
    entries.get((k as usize).checked_sub(1)?).copied()
}

/// The differential equation whose state an input is.
fn state(scene: &Scene, input: Input) -> Option<usize> {
    match (entry(scene, input), input) {
        (Some(Entry::State(d)), _) => Some(d),
        (_, Input::Measure(Measure::Dif, [id, ..])) => scene.differential(id),
        _ => None,
    }
}

/// Why an input may not be read; `None`: it may.
fn refused(scene: &Scene, input: Input, allowed: Allowed) -> Option<Refusal> {
    let measure = match input {
        Input::Time | Input::Mode => return None,
        Input::Measure(measure, _) => {
            if measure == Measure::Aryval {
                let known = matches!(entry(scene, input), Some(Entry::Number(_)));
                return (!known).then_some(Refusal::NoNumber);
            }
            measure
        }
        Input::Delayed(_) => return Some(Refusal::Delayed),
        Input::Slot(_) => return Some(Refusal::NoFunction),
    };
    if let (Input::Measure(m, ids), Allowed::Motion) = (input, allowed) {
        let first = if m == Measure::Orient { 2 } else { 0 };
        if ids[first..]
            .iter()
            .any(|id| scene.floating.contains_key(id))
        {
            return Some(Refusal::FloatingMarker);
        }
    }
    Some(match (measure.row().family, allowed) {
        (Family::Displacement | Family::Velocity, Allowed::Motion) => return None,
        (Family::Displacement, Allowed::Time) => Refusal::Place,
        (Family::Velocity, Allowed::Time) => Refusal::Velocity,
        (Family::Acceleration, _) => Refusal::Acceleration,
        (Family::GenericForce | Family::ElementForce, _) => Refusal::Force,
        (Family::System, _) => Refusal::State,
    })
}

/// An input as it is written: "DX(1,2)".
pub(super) fn input_name(input: Input) -> String {
    match input {
        Input::Time => "TIME".into(),
        Input::Mode => "MODE".into(),
        Input::Delayed(_) => "DELAY".into(),
        Input::Slot(k) => format!("input {k}"),
        Input::Measure(m, ids) => {
            let last = ids.iter().rposition(|&i| i != 0).unwrap_or(0);
            let ids: Vec<String> = ids[..=last].iter().map(u32::to_string).collect();
            format!("{}({})", m.name(), ids.join(","))
        }
    }
}
