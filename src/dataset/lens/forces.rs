//! Forces: the form of a contact, springs, components three by three, matrices.

use super::*;

/// A routine computes the law of a contact only where FUNCTION says so.
pub fn contact_form(contact: &mut Contact) -> Done {
    if contact.law != ContactLaw::User && contact.function.is_some() {
        return Err("ROUTINE needs FUNCTION = USER(...)".to_owned());
    }
    Ok(())
}

/// K, C, FORCE, LENGTH belong to TRANSLATIONAL, KT, CT, TORQUE, ANGLE to ROTATIONAL.
pub fn put_spring(
    spring: &mut SpringDamper,
    rotational: bool,
    value: Value,
    of: fn(&mut SpringDamper) -> &mut f64,
) -> Done {
    if spring.rotational != rotational {
        return Err(match rotational {
            true => {
                "this belongs to ROTATIONAL; a TRANSLATIONAL one has K, C, FORCE, LENGTH".into()
            }
            false => {
                "this belongs to TRANSLATIONAL; a ROTATIONAL one has KT, CT, TORQUE, ANGLE".into()
            }
        });
    }
    *of(spring) = real(value)?;
    Ok(())
}

/// See [`put_spring`].
pub fn spring(spring: &SpringDamper, rotational: bool, x: f64) -> Option<Value> {
    if spring.rotational == rotational {
        x.written()
    } else {
        None
    }
}

/// The translational half of six numbers.
pub struct FirstThree;

impl Lens<[f64; 6]> for FirstThree {
    const KIND: Kind = POINT;
    fn put(field: &mut [f64; 6], value: Value) -> Done {
        field[..3].copy_from_slice(&triple(value)?);
        Ok(())
    }
    fn get(field: &[f64; 6]) -> Option<Value> {
        [field[0], field[1], field[2]].written()
    }
}

/// The rotational half of six numbers.
pub struct LastThree;

impl Lens<[f64; 6]> for LastThree {
    const KIND: Kind = POINT;
    fn put(field: &mut [f64; 6], value: Value) -> Done {
        field[3..].copy_from_slice(&triple(value)?);
        Ok(())
    }
    fn get(field: &[f64; 6]) -> Option<Value> {
        [field[3], field[4], field[5]].written()
    }
}

/// Three lengths and three angles.
pub struct SixDisplacements;

impl Lens<[f64; 6]> for SixDisplacements {
    const KIND: Kind = Kind::Reals {
        min: 6,
        max: 6,
        angle: true,
    };
    fn put(field: &mut [f64; 6], value: Value) -> Done {
        field.put(value)
    }
    fn get(field: &[f64; 6]) -> Option<Value> {
        field.written()?;
        let lengths = field[..3].iter().copied().map(Number::plain);
        Some(Value::Reals(
            lengths
                .chain(field[3..].iter().copied().map(Number::angle))
                .collect(),
        ))
    }
}

/// Exactly N numbers.
pub struct Many<const N: usize>;

impl<const N: usize> Lens<Vec<f64>> for Many<N> {
    const KIND: Kind = Kind::Reals {
        min: N,
        max: N,
        angle: false,
    };
    fn put(field: &mut Vec<f64>, value: Value) -> Done {
        field.put(value)
    }
    fn get(field: &Vec<f64>) -> Option<Value> {
        field.written()
    }
}
