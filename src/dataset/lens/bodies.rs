//! Parts and markers: orientations as points and angles, inertia, coordinates to keep, owners.

use super::*;

/// REULER.
pub struct Euler;

impl Lens<Orientation> for Euler {
    const KIND: Kind = Kind::Reals {
        min: 3,
        max: 3,
        angle: true,
    };
    fn put(field: &mut Orientation, value: Value) -> Done {
        *field = Orientation::Euler(triple(value)?);
        Ok(())
    }
    fn get(field: &Orientation) -> Option<Value> {
        match field {
            Orientation::Euler(a) => Some(angles(a)),
            _ => None,
        }
    }
}

/// The points of an orientation, to be set.
fn points(field: &mut Orientation) -> (&mut Option<[f64; 3]>, &mut Option<[f64; 3]>, &mut bool) {
    if !matches!(field, Orientation::Points { .. }) {
        *field = Orientation::Points {
            z: None,
            x: None,
            use_x: false,
        };
    }
    match field {
        Orientation::Points { z, x, use_x } => (z, x, use_x),
        _ => unreachable!("made so above"),
    }
}

pub(super) const POINT: Kind = Kind::Reals {
    min: 3,
    max: 3,
    angle: false,
};

/// ZP, ZG.
pub struct PointOnZ;

impl Lens<Orientation> for PointOnZ {
    const KIND: Kind = POINT;
    fn put(field: &mut Orientation, value: Value) -> Done {
        *points(field).0 = Some(triple(value)?);
        Ok(())
    }
    fn get(field: &Orientation) -> Option<Value> {
        match field {
            Orientation::Points { z: Some(p), .. } => Some(p.always()),
            _ => None,
        }
    }
}

/// XP, XG.
pub struct PointOnX;

impl Lens<Orientation> for PointOnX {
    const KIND: Kind = POINT;
    fn put(field: &mut Orientation, value: Value) -> Done {
        *points(field).1 = Some(triple(value)?);
        Ok(())
    }
    fn get(field: &Orientation) -> Option<Value> {
        match field {
            Orientation::Points { x: Some(p), .. } => Some(p.always()),
            _ => None,
        }
    }
}

/// USEXP.
pub struct UseX;

impl Lens<Orientation> for UseX {
    const KIND: Kind = Kind::Flag;
    fn put(field: &mut Orientation, _: Value) -> Done {
        *points(field).2 = true;
        Ok(())
    }
    fn get(field: &Orientation) -> Option<Value> {
        matches!(field, Orientation::Points { use_x: true, .. }).then_some(Value::Flag)
    }
}

/// IP: three moments, and the products where they are given.
pub struct Inertia;

impl Lens<[f64; 6]> for Inertia {
    const KIND: Kind = Kind::Reals {
        min: 3,
        max: 6,
        angle: false,
    };
    fn put(field: &mut [f64; 6], value: Value) -> Done {
        field.put(value)
    }
    fn get(field: &[f64; 6]) -> Option<Value> {
        let used = if field[3..] == [0.0; 3] {
            &field[..3]
        } else {
            &field[..]
        };
        field.iter().any(|&x| x != 0.0).then(|| numbers(used))
    }
}

const COORDINATES: &[&str] = &["X", "Y", "Z", "PSI", "THETA", "PHI"];

/// EXACT=X:Y:PSI.
pub struct Exact;

impl Lens<[bool; 6]> for Exact {
    const KIND: Kind = Kind::Words(COORDINATES);
    fn put(field: &mut [bool; 6], value: Value) -> Done {
        let Value::Words(words) = value else {
            return Err(MISFIT.into());
        };
        *field = [false; 6];
        for word in words {
            if let Some(k) = COORDINATES.iter().position(|&c| c == word) {
                field[k] = true;
            }
        }
        Ok(())
    }
    fn get(field: &[bool; 6]) -> Option<Value> {
        let named = COORDINATES.iter().zip(field).filter(|(_, on)| **on);
        let named: Vec<String> = named.map(|(c, _)| (*c).to_owned()).collect();
        words(&named)
    }
}

/// Fastens a marker to an element that is not solved.
pub fn put_other_owner(marker: &mut Marker, kind: ElementKind, value: Value) -> Done {
    id(value, |n| marker.owner = MarkerOwner::Other(kind.id(n)))
}

/// See [`put_other_owner`].
pub fn other_owner(marker: &Marker, kind: ElementKind) -> Option<Value> {
    match marker.owner {
        MarkerOwner::Other(owner) if owner.kind == kind => Some(Value::Id(owner.number)),
        MarkerOwner::Other(_) | MarkerOwner::Part(_) | MarkerOwner::PointMass(_) => None,
    }
}
