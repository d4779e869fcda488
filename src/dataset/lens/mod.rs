//! Lenses: arguments in fields whose types alone do not say how they sit there: orientations,
//! inertia, driven freedoms, requests.
//!
//! Helpers of the rows in `statement.rs`; each pair puts a value and takes it out again. `get`
//! returns `None` where nothing need be written.

mod bodies;
mod constraints;
mod data;
mod forces;
mod output;
mod settings;

pub use bodies::*;
pub use constraints::*;
pub use data::*;
pub use forces::*;
pub use output::*;
pub use settings::*;

use super::row::Element as _;
use super::row::{Angle, Lens, canonical};
use super::value::{Always, Field, Kind, Number, Value, angles, numbers};
use crate::model::*;
use crate::physics::joint::Displacements;

/// A sentence about what does not fit.
type Done = Result<(), String>;

const MISFIT: &str = "the value has another form than this argument takes";

/// Nothing concerns several arguments at once.
pub fn nothing<T>(_: &mut T) -> Done {
    Ok(())
}

/// Hands over the number of an element.
pub fn id(value: Value, put: impl FnOnce(u32)) -> Done {
    match value {
        Value::Id(n) => {
            put(n);
            Ok(())
        }
        _ => Err(MISFIT.into()),
    }
}

fn real(value: Value) -> Result<f64, String> {
    match value {
        Value::Real(x) => Ok(x.value()),
        _ => Err(MISFIT.into()),
    }
}

fn list(value: Value) -> Result<Vec<f64>, String> {
    match value {
        Value::Reals(xs) => Ok(xs.into_iter().map(Number::value).collect()),
        _ => Err(MISFIT.into()),
    }
}

fn triple(value: Value) -> Result<[f64; 3], String> {
    list(value)?.try_into().map_err(|_| MISFIT.to_owned())
}

/// A list of words between colons.
pub fn words(of: &[String]) -> Option<Value> {
    (!of.is_empty()).then(|| Value::Words(of.to_vec()))
}

/// One word, kept as text.
pub struct Word;

impl Lens<Option<String>> for Word {
    const KIND: Kind = Kind::Word(&[]);
    fn put(field: &mut Option<String>, value: Value) -> Done {
        let Value::Word(word) = value else {
            return Err(MISFIT.into());
        };
        *field = Some(word.to_ascii_uppercase());
        Ok(())
    }
    fn get(field: &Option<String>) -> Option<Value> {
        field.clone().map(Value::Word)
    }
}

/// ON or OFF.
pub struct OnOff;

impl Lens<bool> for OnOff {
    const KIND: Kind = Kind::Word(&["ON", "OFF"]);
    fn put(field: &mut bool, value: Value) -> Done {
        *field = value == Value::Word("ON".into());
        Ok(())
    }
    fn get(field: &bool) -> Option<Value> {
        field.then(|| Value::Word("ON".into()))
    }
}
