//! What the functions of constraints may read: a MOTION time alone, a GCON time and places.
//!
//! A constraint holds together with its first two rates. Those of a function of time come from the function itself, those of a
//! function of places from how markers move; a function that reads velocities, forces or states has no such rates
//! and is refused, with the name of what it reads and through which VARIABLE.

use super::{Entry, Scene};
use crate::expr::measures::{Family, Measure};
use crate::expr::program::Input;

/// What a function may read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Allowed {
    /// TIME, MODE, numbers of an ARRAY, VARIABLEs of these
    Time,
    /// displacements and angles of markers as well
    Places,
}

/// What a function reads that it may not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Offence {
    /// "DX(1,2)", or "DX(1,2) (in VARIABLE/7)"
    pub what: String,
    /// why that is none of what is allowed
    pub why: &'static str,
}

/// The first thing that a formula reads although it may not.
pub(super) fn offence(scene: &Scene, formula: usize, allowed: Allowed) -> Option<Offence> {
    search(scene, formula, allowed, &mut Vec::new())
}

fn search(
    scene: &Scene,
    formula: usize,
    allowed: Allowed,
    open: &mut Vec<usize>,
) -> Option<Offence> {
    let f = scene.formulas.get(formula)?;
    open.push(formula);
    let found = f.program.inputs().iter().find_map(|input| {
        if let Input::Measure(Measure::Varval, [id, ..]) = input {
            let name = input_name(*input);
            return match scene.variables.get(id) {
                Some(&v) if open.contains(&v) => Some(Offence {
                    what: name,
                    why: "its VARIABLE depends on itself",
                }),
                Some(&v) => search(scene, v, allowed, open).map(|o| within(o, *id)),
                None => Some(Offence {
                    what: name,
                    why: "there is no such VARIABLE",
                }),
            };
        }
        if let (Some(equation), Allowed::Time) = (state(scene, *input), allowed) {
            let d = &scene.differentials[equation];
            if d.implicit || d.state.is_none() {
                return Some(Offence {
                    what: input_name(*input),
                    why: "its equation does not tell its rate",
                });
            }
            // a rate may depend on the state itself
            if open.contains(&d.formula) {
                return None;
            }
            return search(scene, d.formula, allowed, open);
        }
        if let Some(Entry::Formula(f)) = entry(scene, *input) {
            return if open.contains(&f) {
                Some(Offence {
                    what: input_name(*input),
                    why: "it depends on itself",
                })
            } else {
                search(scene, f, allowed, open)
            };
        }
        let why = refused(scene, *input, allowed)?;
        Some(Offence {
            what: input_name(*input),
            why,
        })
    });
    open.pop();
    found
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
        (_, Input::Measure(Measure::Dif, [id, ..])) => {
            scene.differentials.iter().position(|d| d.id == id)
        }
        _ => None,
    }
}

fn within(offence: Offence, variable: u32) -> Offence {
    if offence.what.ends_with(')') && offence.what.contains("(in VARIABLE") {
        return offence;
    }
    Offence {
        what: format!("{} (in VARIABLE/{variable})", offence.what),
        ..offence
    }
}

/// Why an input may not be read; `None`: it may.
fn refused(scene: &Scene, input: Input, allowed: Allowed) -> Option<&'static str> {
    let measure = match input {
        Input::Time | Input::Mode => return None,
        Input::Measure(measure, _) => {
            if measure == Measure::Aryval {
                let known = matches!(entry(scene, input), Some(Entry::Number(_)));
                return (!known).then_some("it is no number of an ARRAY with NUMBERS");
            }
            measure
        }
        Input::Delayed(_) => return Some("a delayed value has no rates"),
        Input::Slot(_) => return Some("it is no function of the model"),
    };
    if let (Input::Measure(m, ids), Allowed::Places) = (input, allowed) {
        let first = if m == Measure::Orient { 2 } else { 0 };
        if ids[first..]
            .iter()
            .any(|id| scene.floating.contains_key(id))
        {
            return Some("it depends on a floating marker, whose place other constraints find");
        }
    }
    Some(match (measure.row().family, allowed) {
        (Family::Displacement, Allowed::Places) => return None,
        (Family::Displacement, Allowed::Time) => "it depends on where the parts are",
        (Family::Velocity, _) => "it depends on how the parts move",
        (Family::Acceleration, _) => "it depends on accelerations",
        (Family::GenericForce | Family::ElementForce, _) => "it depends on forces",
        (Family::System, _) => "it is a state with equations of its own",
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
