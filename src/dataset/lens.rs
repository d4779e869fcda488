//! How arguments sit in fields whose types alone do not say it: orientations, inertia, driven freedoms, requests.
//!
//! Helpers of the rows in `statement.rs`; each pair puts a value and takes it out again. `get` returns `None` where
//! nothing need be written.

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

// ---------------------------------------------------------------------------------------------------------- settings

/// Puts a value under its keyword: numbers among the numbers, everything else as text among the words.
pub fn put_setting(settings: &mut Settings, name: &str, value: Value) -> Done {
    let key = canonical(name);
    match value {
        Value::Real(x) => {
            settings.numbers.insert(key, x.value());
        }
        Value::Flag => {
            settings.words.insert(key, String::new());
        }
        other => {
            settings.words.insert(key, other.to_string());
        }
    }
    Ok(())
}

/// The value under a keyword.
pub fn setting(settings: &Settings, name: &str, kind: Kind) -> Option<Value> {
    let key = canonical(name);
    if let Some(&x) = settings.numbers.get(&key) {
        let angle = kind == Kind::Real { angle: true };
        return Some(Value::Real(if angle {
            Number::angle(x)
        } else {
            Number::plain(x)
        }));
    }
    settings.words.get(&key).map(|word| match kind {
        Kind::Flag => Value::Flag,
        _ => Value::Raw(word.clone()),
    })
}

// ------------------------------------------------------------------------------------------------------------- units

/// Sets one of the four units.
pub fn put_unit(
    units: &mut Option<Units>,
    value: Value,
    of: fn(&mut Units) -> &mut String,
) -> Done {
    let Value::Word(word) = value else {
        return Err(MISFIT.into());
    };
    *of(units.get_or_insert_with(|| Units::new("", "", "", ""))) = word;
    Ok(())
}

/// One of the four units.
pub fn unit(units: &Option<Units>, of: fn(&Units) -> &String) -> Option<Value> {
    let word = of(units.as_ref()?);
    (!word.is_empty()).then(|| Value::Word(word.clone()))
}

/// Sets all units by the name of a system.
pub fn put_unit_system(units: &mut Option<Units>, value: Value) -> Done {
    let Value::Word(word) = value else {
        return Err(MISFIT.into());
    };
    let [f, m, l, t] = units::system(&word).unwrap_or([""; 4]);
    *units = Some(Units::new(f, m, l, t));
    Ok(())
}

/// SYSTEM=NONE where nothing else is said.
pub fn no_units(units: &Option<Units>) -> Option<Value> {
    let u = units.as_ref()?;
    let named = [&u.force, &u.mass, &u.length, &u.time];
    let nothing = named.iter().all(|w| w.is_empty()) && stated_ucf(units).is_none();
    nothing.then(|| Value::Word("NONE".to_owned()))
}

/// Sets the factor itself; without named units.
pub fn put_ucf(units: &mut Option<Units>, value: Value) -> Done {
    let ucf = real(value)?;
    if ucf.is_nan() || ucf <= 0.0 {
        return Err("UCF must be positive".into());
    }
    units.get_or_insert_with(|| Units::new("", "", "", "")).ucf = ucf;
    Ok(())
}

/// The factor where the units do not say it themselves.
pub fn stated_ucf(units: &Option<Units>) -> Option<Value> {
    let u = units.as_ref()?;
    let said = units::consistency(&u.force, &u.mass, &u.length, &u.time);
    (u.ucf != said).then(|| Value::Real(Number::plain(u.ucf)))
}

/// All four units or none; the factor follows from them.
pub fn consistent_units(units: &mut Option<Units>) -> Done {
    let Some(u) = units else {
        return Ok(());
    };
    let four = [
        ("FORCE", &u.force),
        ("MASS", &u.mass),
        ("LENGTH", &u.length),
        ("TIME", &u.time),
    ];
    let missing: Vec<&str> = four
        .iter()
        .filter(|(_, w)| w.is_empty())
        .map(|(k, _)| *k)
        .collect();
    match missing.len() {
        0 => {
            u.ucf = units::consistency(&u.force, &u.mass, &u.length, &u.time);
            Ok(())
        }
        4 => Ok(()),
        _ => Err(format!(
            "UNITS needs FORCE, MASS, LENGTH and TIME together; {} not given",
            missing.join(", ")
        )),
    }
}

// ------------------------------------------------------------------------------------------------ parts and markers

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

const POINT: Kind = Kind::Reals {
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

// ------------------------------------------------------------------------------------------------------- constraints

/// IC means the angle of a REVOLUTE, the distance of all others.
pub fn put_joint_ic(joint: &mut Joint, value: Value) -> Done {
    match joint.kind.displacements() {
        Displacements::Rotation => joint.ic_rotation.put(value),
        Displacements::Translation | Displacements::Both | Displacements::None => {
            joint.ic_translation.put(value)
        }
    }
}

/// See [`put_joint_ic`].
pub fn joint_ic(joint: &Joint) -> Option<Value> {
    match joint.kind.displacements() {
        Displacements::Rotation => <Angle as Lens<_>>::get(&joint.ic_rotation),
        Displacements::Translation => joint.ic_translation.written(),
        Displacements::Both | Displacements::None => None,
    }
}

/// The marker component has not been said yet.
const UNSAID: usize = usize::MAX;

/// JOINT= of a MOTION.
pub fn put_motion_joint(motion: &mut Motion, value: Value) -> Done {
    if let Driven::Markers { component, .. } = motion.driven {
        let word = ["X", "Y", "Z", "B1", "B2", "B3"]
            .get(component)
            .unwrap_or(&"I");
        return Err(format!("{word} goes with I and J, not with JOINT"));
    }
    id(value, |n| {
        motion.driven = match motion.driven {
            Driven::JointTranslation(_) => Driven::JointTranslation(n),
            Driven::JointRotation(_) => Driven::JointRotation(n),
            _ => Driven::Joint(n),
        }
    })
}

/// See [`put_motion_joint`].
pub fn motion_joint(motion: &Motion) -> Option<Value> {
    match motion.driven {
        Driven::Joint(n) | Driven::JointTranslation(n) | Driven::JointRotation(n) => n.written(),
        Driven::Markers { .. } => None,
    }
}

/// TRANSLATIONAL or ROTATIONAL: which freedom of the joint.
pub fn motion_along(motion: &mut Motion, rotation: bool) {
    let joint = match motion.driven {
        Driven::Joint(n) | Driven::JointTranslation(n) | Driven::JointRotation(n) => n,
        Driven::Markers { .. } => 0,
    };
    motion.driven = match rotation {
        true => Driven::JointRotation(joint),
        false => Driven::JointTranslation(joint),
    };
}

/// I= (or J=) of a MOTION.
pub fn put_motion_marker(motion: &mut Motion, value: Value, second: bool) -> Done {
    let (mut i, mut j, component) = match motion.driven {
        Driven::Markers { i, j, component } => (i, j, component),
        Driven::Joint(0) => (0, 0, UNSAID),
        Driven::JointTranslation(_) | Driven::JointRotation(_) => {
            return Err("TRANSLATIONAL and ROTATIONAL go with JOINT; I and J take one of X, Y, Z, B1, B2, B3".into());
        }
        Driven::Joint(_) => return Err("JOINT and I, J exclude each other".into()),
    };
    id(value, |n| if second { j = n } else { i = n })?;
    motion.driven = Driven::Markers { i, j, component };
    Ok(())
}

/// See [`put_motion_marker`].
pub fn motion_marker(motion: &Motion, second: bool) -> Option<Value> {
    match motion.driven {
        Driven::Markers { i, j, .. } => if second { j } else { i }.written(),
        _ => None,
    }
}

/// X, Y, Z, B1, B2, B3.
pub fn put_component(motion: &mut Motion, component: usize) -> Done {
    let (i, j) = match motion.driven {
        Driven::Markers { i, j, .. } => (i, j),
        _ => (0, 0),
    };
    motion.driven = Driven::Markers { i, j, component };
    Ok(())
}

/// See [`put_component`].
pub fn component(motion: &Motion, component: usize) -> Option<Value> {
    matches!(motion.driven, Driven::Markers { component: c, .. } if c == component)
        .then_some(Value::Flag)
}

/// A MOTION drives a joint, or one component between two markers.
pub fn motion_form(motion: &mut Motion) -> Done {
    match motion.driven {
        Driven::Joint(0) => {
            Err("a MOTION needs JOINT, or I and J with one of X, Y, Z, B1, B2, B3".into())
        }
        Driven::JointRotation(0) | Driven::JointTranslation(0) => {
            Err("TRANSLATIONAL and ROTATIONAL need JOINT".into())
        }
        Driven::Markers {
            component: UNSAID, ..
        } => Err("a MOTION between markers needs one of X, Y, Z, B1, B2, B3".into()),
        Driven::Markers { i, j, .. } if i == 0 || j == 0 => {
            Err("a MOTION between markers needs both I and J".into())
        }
        _ => Ok(()),
    }
}

/// TYPE=T:R.
pub struct CouplerTypes;

impl Lens<Vec<Option<bool>>> for CouplerTypes {
    const KIND: Kind = Kind::Words(&["T", "R"]);
    fn put(field: &mut Vec<Option<bool>>, value: Value) -> Done {
        let Value::Words(words) = value else {
            return Err(MISFIT.into());
        };
        *field = words.iter().map(|w| Some(w == "R")).collect();
        Ok(())
    }
    fn get(field: &Vec<Option<bool>>) -> Option<Value> {
        let letter = |r: &Option<bool>| r.map(|r| if r { "R" } else { "T" }.to_owned());
        let letters: Option<Vec<String>> = field.iter().map(letter).collect();
        letters.and_then(|l| words(&l))
    }
}

/// Two or three joints, as many types; scales may leave out the first, which then is 1.
pub fn coupler_form(coupler: &mut Coupler) -> Done {
    let n = coupler.joints.len();
    if !(2..=3).contains(&n) {
        return Err(format!("a COUPLER joins two or three joints, not {n}"));
    }
    if coupler.rotational.is_empty() {
        coupler.rotational = vec![None; n];
    }
    if coupler.rotational.len() != n {
        return Err(format!(
            "TYPE names {} kinds for {n} joints",
            coupler.rotational.len()
        ));
    }
    if coupler.scales.len() + 1 == n {
        coupler.scales.insert(0, 1.0);
    }
    if coupler.scales.len() != n && coupler.user.is_none() {
        return Err(match coupler.scales.len() {
            0 => "a COUPLER needs SCALES".to_owned(),
            s => format!("SCALES holds {s} numbers for {n} joints"),
        });
    }
    Ok(())
}

// ------------------------------------------------------------------------------------------------------------ forces

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

// ----------------------------------------------------------------------------------------------------- data elements

/// A row of a SPLINE: the values, preceded by z in a surface.
pub fn put_spline_row(spline: &mut SplineData, value: Value) -> Done {
    spline.y.push(list(value)?);
    Ok(())
}

/// See [`put_spline_row`].
pub fn spline_rows(spline: &SplineData) -> Vec<Value> {
    let row = |(k, y): (usize, &Vec<f64>)| {
        let z = spline.z.get(k).into_iter();
        Value::Reals(z.chain(y).copied().map(Number::plain).collect())
    };
    spline.y.iter().enumerate().map(row).collect()
}

/// Several rows, each one longer than X, are a surface: their first numbers are z.
pub fn spline_surface(spline: &mut SplineData) -> Done {
    let n = spline.x.len();
    if spline.z.is_empty() && spline.y.len() > 1 && spline.y.iter().all(|y| y.len() == n + 1) {
        spline.z = spline.y.iter_mut().map(|y| y.remove(0)).collect();
    }
    Ok(())
}

/// FULL=RORDER or CORDER.
pub fn put_matrix_order(matrix: &mut Matrix, value: Value) -> Done {
    matrix.layout = match value == Value::Word("CORDER".into()) {
        true => MatrixLayout::ByColumns,
        false => MatrixLayout::ByRows,
    };
    Ok(())
}

/// See [`put_matrix_order`].
pub fn matrix_order(matrix: &Matrix) -> Option<Value> {
    let word = match matrix.layout {
        MatrixLayout::ByRows => "RORDER",
        MatrixLayout::ByColumns => "CORDER",
        MatrixLayout::Sparse { .. } => return None,
    };
    let told = matrix.file.is_none() || matrix.layout == MatrixLayout::ByColumns;
    told.then(|| Value::Word(word.into()))
}

// ------------------------------------------------------------------------------------------------ requests, graphics

/// The markers I, J, RM of a request for a quantity.
fn request_slots(kind: &mut RequestKind) -> Option<(&mut u32, &mut Option<u32>, &mut Option<u32>)> {
    match kind {
        RequestKind::Displacement { i, j, rm }
        | RequestKind::Velocity { i, j, rm }
        | RequestKind::Acceleration { i, j, rm }
        | RequestKind::Force { i, j, rm } => Some((i, j, rm)),
        RequestKind::Functions(_) | RequestKind::User(_) => None,
    }
}

/// DISPLACEMENT, VELOCITY, ACCELERATION, FORCE; the markers stay.
pub fn ask(request: &mut Request, quantity: Quantity) -> Done {
    let (i, j, rm) = match request_slots(&mut request.kind) {
        Some((i, j, rm)) => (*i, *j, *rm),
        None => (0, None, None),
    };
    request.kind = match quantity {
        Quantity::Displacement => RequestKind::Displacement { i, j, rm },
        Quantity::Velocity => RequestKind::Velocity { i, j, rm },
        Quantity::Acceleration => RequestKind::Acceleration { i, j, rm },
        Quantity::Force => RequestKind::Force { i, j, rm },
    };
    Ok(())
}

/// See [`ask`].
pub fn asked(request: &Request, quantity: Quantity) -> Option<Value> {
    let is = match request.kind {
        RequestKind::Displacement { .. } => quantity == Quantity::Displacement,
        RequestKind::Velocity { .. } => quantity == Quantity::Velocity,
        RequestKind::Acceleration { .. } => quantity == Quantity::Acceleration,
        RequestKind::Force { .. } => quantity == Quantity::Force,
        RequestKind::Functions(_) | RequestKind::User(_) => false,
    };
    is.then_some(Value::Flag)
}

/// I, J, RM.
pub fn put_request_marker(request: &mut Request, which: usize, value: Value) -> Done {
    let Some((i, j, rm)) = request_slots(&mut request.kind) else {
        return Err("I, J and RM go with DISPLACEMENT, VELOCITY, ACCELERATION or FORCE".into());
    };
    id(value, |n| match which {
        0 => *i = n,
        1 => *j = Some(n),
        _ => *rm = Some(n),
    })
}

/// See [`put_request_marker`].
pub fn request_marker(request: &Request, which: usize) -> Option<Value> {
    let mut kind = request.kind.clone();
    let (i, j, rm) = request_slots(&mut kind)?;
    match which {
        0 => i.written(),
        1 => j.written(),
        _ => rm.written(),
    }
}

/// F1 … F8.
pub fn put_request_function(request: &mut Request, k: usize, value: Value) -> Done {
    match &mut request.kind {
        RequestKind::Functions(f) => f[k].put(value),
        _ => Err(
            "F1 to F8 do not go with DISPLACEMENT, VELOCITY, ACCELERATION, FORCE or FUNCTION"
                .into(),
        ),
    }
}

/// See [`put_request_function`].
pub fn request_function(request: &Request, k: usize) -> Option<Value> {
    match &request.kind {
        RequestKind::Functions(f) => f[k].written(),
        _ => None,
    }
}

/// FUNCTION=USER(…), ROUTINE.
pub fn request_user(request: &mut Request) -> &mut Formula {
    if !matches!(request.kind, RequestKind::User(_)) {
        request.kind = RequestKind::User(Formula::default());
    }
    match &mut request.kind {
        RequestKind::User(f) => f,
        _ => unreachable!("made so above"),
    }
}

/// CM: one marker, or for an OUTLINE several.
pub fn put_graphics_cm(graphics: &mut Graphics, value: Value) -> Done {
    let text = value.to_string();
    let Value::Ids(ids) = value else {
        return Err(MISFIT.into());
    };
    match (&mut graphics.shape, ids.as_slice()) {
        (
            Shape::Cylinder { cm, .. }
            | Shape::Frustum { cm, .. }
            | Shape::Ellipsoid { cm, .. }
            | Shape::Torus { cm, .. }
            | Shape::Circle { cm, .. }
            | Shape::Arc { cm, .. },
            [one],
        ) => *cm = *one,
        (Shape::Other(_), _) => graphics.keep("CM", text),
        _ => return Err("this shape does not take these markers".into()),
    }
    Ok(())
}

/// See [`put_graphics_cm`].
pub fn graphics_cm(graphics: &Graphics) -> Option<Value> {
    match &graphics.shape {
        Shape::Cylinder { cm, .. }
        | Shape::Frustum { cm, .. }
        | Shape::Ellipsoid { cm, .. }
        | Shape::Torus { cm, .. }
        | Shape::Circle { cm, .. }
        | Shape::Arc { cm, .. } => Some(Value::Ids(vec![*cm])),
        _ => None,
    }
}

/// RANGLE: how far an ARC goes from the x axis of its marker; of other shapes it is only kept.
pub fn put_arc_angle(graphics: &mut Graphics, value: Value) -> Done {
    if let Shape::Arc { angle, .. } = &mut graphics.shape {
        *angle = real(value)?;
    } else {
        graphics.keep("RANGLE", value.to_string());
    }
    Ok(())
}

/// See [`put_arc_angle`].
pub fn arc_angle(graphics: &Graphics) -> Option<Value> {
    match &graphics.shape {
        Shape::Arc { angle, .. } => angle.written(),
        _ => None,
    }
}

/// XMIN, XMAX, YMIN, YMAX of a PLANE.
pub fn put_bound(graphics: &mut Graphics, along_y: bool, upper: usize, value: Value) -> Done {
    let Shape::Plane { x, y, .. } = &mut graphics.shape else {
        return Err("this goes with PLANE".into());
    };
    let bounds = if along_y { y } else { x };
    bounds[upper] = Some(real(value)?);
    Ok(())
}

/// See [`put_bound`].
pub fn bound(graphics: &Graphics, along_y: bool, upper: usize) -> Option<Value> {
    match &graphics.shape {
        Shape::Plane { y, .. } if along_y => y[upper].written(),
        Shape::Plane { x, .. } => x[upper].written(),
        _ => None,
    }
}
