//! Fields and how an argument fills them: as their type says, as angles, as the routine of a
//! function.

use crate::dataset::value::{self, Field, Kind, Value};
use crate::model::Formula;

/// The place of one kind of argument in a field whose type alone does not say it.
pub trait Lens<F> {
    /// what the argument accepts
    const KIND: Kind;
    /// fills the field
    fn put(field: &mut F, value: Value) -> Result<(), String>;
    /// the value to write
    fn get(field: &F) -> Option<Value>;
}

/// The field as its type says.
pub struct Plain;

impl<F: Field> Lens<F> for Plain {
    const KIND: Kind = F::KIND;
    fn put(field: &mut F, value: Value) -> Result<(), String> {
        field.put(value)
    }
    fn get(field: &F) -> Option<Value> {
        field.written()
    }
}

/// The same numbers, as angles.
pub struct Angle;

impl<F: Field> Lens<F> for Angle {
    const KIND: Kind = match F::KIND {
        Kind::Reals { min, max, .. } => Kind::Reals {
            min,
            max,
            angle: true,
        },
        Kind::Real { .. } => Kind::Real { angle: true },
        other => other,
    };
    fn put(field: &mut F, value: Value) -> Result<(), String> {
        field.put(value)
    }
    fn get(field: &F) -> Option<Value> {
        Some(match field.written()? {
            Value::Real(x) => Value::Real(value::Number::angle(x.literal)),
            Value::Reals(xs) => value::angles(&xs.iter().map(|x| x.literal).collect::<Vec<_>>()),
            other => other,
        })
    }
}

/// ROUTINE of a FUNCTION=USER(…).
pub struct Routine;

impl Lens<Formula> for Routine {
    const KIND: Kind = Kind::Text;
    fn put(field: &mut Formula, value: Value) -> Result<(), String> {
        let Value::Text(name) = value else {
            return Err("ROUTINE takes library::entry".into());
        };
        match field {
            Formula::User { routine, .. } => *routine = Some(name),
            Formula::Expression { text, .. } if text.is_empty() => {
                *field = Formula::User {
                    constants: Vec::new(),
                    routine: Some(name),
                }
            }
            Formula::Expression { .. } => return Err("ROUTINE goes with FUNCTION=USER(…)".into()),
        }
        Ok(())
    }
    fn get(field: &Formula) -> Option<Value> {
        match field {
            Formula::User { routine, .. } => routine.clone().map(Value::Text),
            Formula::Expression { .. } => None,
        }
    }
}

impl Lens<Option<Formula>> for Routine {
    const KIND: Kind = Kind::Text;
    fn put(field: &mut Option<Formula>, value: Value) -> Result<(), String> {
        <Routine as Lens<Formula>>::put(field.get_or_insert_default(), value)
    }
    fn get(field: &Option<Formula>) -> Option<Value> {
        field.as_ref().and_then(<Routine as Lens<Formula>>::get)
    }
}
