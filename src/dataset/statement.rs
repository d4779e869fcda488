//! The table of statements: keyword, arguments, where each argument sits in the Model.
//!
//! Reading, abbreviations, writing, respecification by commands and the texts of errors all come
//! from these rows; a new statement or argument is a row here and a field in the Model. A line
//! reads *how* "Name" (field), where *how* is
//!
//! ```text
//! field   "MASS" (mass)                   the field's type says what it takes
//! angle   "ANGLE" (free)                  numbers that are angles
//! lens    "REULER" (Euler, orientation)   a part of a field, or a field in another form
//! choice  "REVOLUTE" (kind = …)           a bare keyword that stands for a value
//! variant "SPARSE" (layout, pattern => …) a bare keyword that stands for a variant with data
//! own     "FILE" (kind, put, get)         anything else
//! keep    "MATERIAL" (kind)               kept as text, carries no mechanics
//! set     "ERROR" (kind)                  a number or word among Settings
//! ```
//!
//! and capitals at the beginning of a name are the abbreviation that wins when several names begin
//! alike.

use super::lens::*;
use super::row::{
    Angle, Argument, Binding, Element, Lens, Meaning, Numbered, Opaque, Plain, Routine, Single,
    Statement, canonical, meaning_among,
};
use super::value::{Always, Field, Kind, Number, Value};
use crate::model::*;
use crate::physics::joint::Displacements;
use std::sync::LazyLock;

/// Returns the meaning of a word among the statements of a dataset; at least three letters.
pub fn find(word: &str) -> Meaning {
    if word.len() < 3 && !word.eq_ignore_ascii_case("IC") {
        return Meaning::Unknown;
    }
    let first = word.as_bytes()[0].to_ascii_uppercase();
    let places = BY_LETTER.get(usize::from(first)).into_iter().flatten();
    meaning_among(word, places.map(|&k| (k, STATEMENTS[k].keyword())))
}

/// By letter the places of the statements with a spelling that begins with it.
static BY_LETTER: LazyLock<[Vec<usize>; 128]> = LazyLock::new(|| {
    let mut all = [const { Vec::new() }; 128];
    for (k, statement) in STATEMENTS.iter().enumerate() {
        for spelling in statement.keyword().split('|') {
            let first = spelling.bytes().next().unwrap_or(0).to_ascii_uppercase();
            let of = &mut all[usize::from(first & 127)];
            if of.last() != Some(&k) {
                of.push(k);
            }
        }
    }
    all
});

const REAL: Kind = Kind::Real { angle: false };
const ANGLE: Kind = Kind::Real { angle: true };
const REALS: Kind = <Vec<f64> as Field>::KIND;
const IDS: Kind = <Vec<u32> as Field>::KIND;
const WORD: Kind = Kind::Word(&[]);
const WORDS: Kind = Kind::Words(&[]);
const ON_OFF: Kind = Kind::Word(&["ON", "OFF"]);

macro_rules! lens {
    ($t:ty, $name:literal, $lens:ty, $($field:tt)+) => {
        Binding::<$t> {
            argument: Argument::new($name, kind_of::<$lens, _, _>(|e: &mut $t| &mut e.$($field)+)),
            put: |e, _, v| <$lens as Lens<_>>::put(&mut e.$($field)+, v),
            get: |e, _| <$lens as Lens<_>>::get(&e.$($field)+).into_iter().collect(),
        }
    };
}
macro_rules! field {
    ($t:ty, $name:literal, $($field:tt)+) => { lens!($t, $name, Plain, $($field)+) };
}
macro_rules! angle {
    ($t:ty, $name:literal, $($field:tt)+) => { lens!($t, $name, Angle, $($field)+) };
}
macro_rules! choice {
    ($t:ty, $name:literal, $field:ident = $value:expr) => {
        Binding::<$t> {
            argument: Argument::new($name, Kind::Flag),
            put: |e, _, _| {
                e.$field = $value;
                Ok(())
            },
            get: |e, _| {
                if e.$field == $value {
                    vec![Value::Flag]
                } else {
                    Vec::new()
                }
            },
        }
    };
}
macro_rules! variant {
    ($t:ty, $name:literal, $field:ident, $pattern:pat => $start:expr) => {
        Binding::<$t> {
            argument: Argument::new($name, Kind::Flag),
            put: |e, _, _| {
                if !matches!(&e.$field, $pattern) {
                    e.$field = $start;
                }
                Ok(())
            },
            get: |e, _| {
                if matches!(&e.$field, $pattern) {
                    vec![Value::Flag]
                } else {
                    Vec::new()
                }
            },
        }
    };
}
macro_rules! own {
    ($t:ty, $name:literal, $kind:expr, $put:expr, $get:expr) => {
        Binding::<$t> {
            argument: Argument::new($name, $kind),
            put: |e, _, v| {
                let put: fn(&mut $t, Value) -> Result<(), String> = $put;
                put(e, v)
            },
            get: |e, _| {
                let get: fn(&$t) -> Option<Value> = $get;
                get(e).into_iter().collect()
            },
        }
    };
}
macro_rules! many {
    ($t:ty, $name:literal, $kind:expr, $put:expr, $get:expr) => {
        Binding::<$t> {
            argument: Argument::new($name, $kind),
            put: |e, _, v| $put(e, v),
            get: |e, _| $get(e),
        }
    };
}
macro_rules! keep {
    ($t:ty, $name:literal, $kind:expr) => {
        Binding::<$t> {
            argument: Argument::new($name, $kind),
            put: |e, name, v| {
                e.keep(&canonical(name), v.to_string());
                Ok(())
            },
            get: |_, _| Vec::new(),
        }
    };
}
macro_rules! set {
    ($t:ty, $name:literal, $kind:expr) => {
        set!($t, $name, $kind, |e| e, |e| e)
    };
    ($t:ty, $name:literal, $kind:expr, $of_mut:expr, $of:expr) => {
        Binding::<$t> {
            argument: Argument::new($name, $kind),
            put: |e, name, v| {
                let of: fn(&mut $t) -> &mut Settings = $of_mut;
                put_setting(of(e), name, v)
            },
            get: |e, name| {
                let of: fn(&$t) -> &Settings = $of;
                setting(of(e), name, $kind).into_iter().collect()
            },
        }
    };
}
/// A bare keyword whose own name is the value of a field.
macro_rules! named {
    ($t:ty, $name:literal, $field:ident) => {
        Binding::<$t> {
            argument: Argument::new($name, Kind::Flag),
            put: |e, name, _| {
                e.$field = Some(canonical(name));
                Ok(())
            },
            get: |e, name| {
                if e.$field.as_deref() == Some(&canonical(name)) {
                    vec![Value::Flag]
                } else {
                    Vec::new()
                }
            },
        }
    };
}
/// A GRAPHICS argument that belongs to some shapes; with others it is kept as text.
macro_rules! shape {
    ($t:ty, $name:literal, $pattern:pat => $slot:expr) => {
        Binding::<$t> {
            argument: Argument::new(
                $name,
                kind_of_slot(|s| match s {
                    $pattern => Some($slot),
                    _ => None,
                }),
            ),
            put: |e, name, v| match &mut e.shape {
                $pattern => Field::put($slot, v),
                _ => {
                    e.keep(&canonical(name), v.to_string());
                    Ok(())
                }
            },
            get: |e, _| match &e.shape {
                $pattern => vec![Always::always($slot)],
                _ => Vec::new(),
            },
        }
    };
}
/// A shape that is only kept.
macro_rules! kept_shape {
    ($t:ty, $name:literal,) => {
        Binding::<$t> {
            argument: Argument::new($name, Kind::Flag),
            put: |e, name, _| {
                e.shape = Shape::Other(canonical(name));
                Ok(())
            },
            get: |e, name| match &e.shape {
                Shape::Other(word) if *word == canonical(name) => vec![Value::Flag],
                _ => Vec::new(),
            },
        }
    };
}

macro_rules! bindings {
    ($t:ty: $($how:ident $name:literal ($($rest:tt)*) $(. $modifier:ident ($($arg:expr)?))* ;)*) => {
        &[$( $how!($t, $name, $($rest)*) $(. $modifier($($arg)?))* ),*]
    };
}
macro_rules! numbered {
    ($kind:ident, $list:ident: $t:ty, $finish:expr, $types:ident, { $($rows:tt)* }) => {
        &Numbered::<$t> {
            kind: ElementKind::$kind,
            list: |m| &m.$list,
            list_mut: |m| &mut m.$list,
            bindings: {
                const REST: &[Binding<$t>] = bindings!($t: $($rows)*);
                const ALL: [Binding<$t>; $types.len() + REST.len()] = joined(&$types, REST);
                &ALL
            },
            finish: $finish,
        }
    };
    ($kind:ident, $list:ident: $t:ty, $finish:expr, { $($rows:tt)* }) => {
        &Numbered::<$t> {
            kind: ElementKind::$kind,
            list: |m| &m.$list,
            list_mut: |m| &mut m.$list,
            bindings: bindings!($t: $($rows)*),
            finish: $finish,
        }
    };
}
macro_rules! single {
    ($keyword:literal, $field:ident: $t:ty, { $($rows:tt)* }) => {
        &Single::<$t> {
            keyword: $keyword,
            value: |m| (m.$field != <$t>::default()).then(|| m.$field.clone()),
            value_mut: |m| &mut m.$field,
            bindings: bindings!($t: $($rows)*),
            settings: None,
            finish: nothing,
        }
    };
}
/// Statements whose arguments are looked up by keyword; they keep what is not listed.
macro_rules! settings {
    ($statement:ident, { $($rows:tt)* }) => {
        &Single::<Settings> {
            keyword: SettingsStatement::$statement.keyword(),
            value: |m| m.settings.get(&SettingsStatement::$statement).cloned(),
            value_mut: |m| m.settings.entry(SettingsStatement::$statement).or_default(),
            bindings: bindings!(Settings: $($rows)*),
            settings: Some(SettingsStatement::$statement),
            finish: nothing,
        }
    };
}

/// The bare keywords of the types of joints, from their table.
const JOINT_TYPES: [Binding<Joint>; JointKind::ALL.len()] = {
    let mut all = [joint_type(JointKind::ALL[0]); JointKind::ALL.len()];
    let mut k = 1;
    while k < all.len() {
        all[k] = joint_type(JointKind::ALL[k]);
        k += 1;
    }
    all
};

const fn joint_type(kind: JointKind) -> Binding<Joint> {
    let binding = Binding::<Joint> {
        argument: Argument::new(kind.row().word, Kind::Flag),
        put: |joint, word, _| {
            let kind = JointKind::ALL.into_iter().find(|k| k.row().word == word);
            joint.kind = kind.unwrap_or(joint.kind);
            Ok(())
        },
        get: |joint, word| {
            let is = joint.kind.row().word == word;
            is.then_some(Value::Flag).into_iter().collect()
        },
    };
    binding.required().group("type")
}

/// The bare keywords of the types of primitives, from their table.
const PRIMITIVE_TYPES: [Binding<Primitive>; PrimitiveKind::ALL.len()] = {
    let mut all = [primitive_type(PrimitiveKind::ALL[0]); PrimitiveKind::ALL.len()];
    let mut k = 1;
    while k < all.len() {
        all[k] = primitive_type(PrimitiveKind::ALL[k]);
        k += 1;
    }
    all
};

const fn primitive_type(kind: PrimitiveKind) -> Binding<Primitive> {
    let binding = Binding::<Primitive> {
        argument: Argument::new(kind.row().word, Kind::Flag),
        put: |primitive, word, _| {
            let kind = PrimitiveKind::ALL
                .into_iter()
                .find(|k| k.row().word == word);
            primitive.kind = kind.unwrap_or(primitive.kind);
            Ok(())
        },
        get: |primitive, word| {
            let is = primitive.kind.row().word == word;
            is.then_some(Value::Flag).into_iter().collect()
        },
    };
    binding.required().group("type")
}

/// Joins two lists of bindings; `N` is the sum of their lengths.
const fn joined<T, const N: usize>(first: &[Binding<T>], rest: &[Binding<T>]) -> [Binding<T>; N] {
    let mut all = [first[0]; N];
    let mut k = 1;
    while k < N {
        all[k] = if k < first.len() {
            first[k]
        } else {
            rest[k - first.len()]
        };
        k += 1;
    }
    all
}

const fn kind_of<L: Lens<F>, T, F>(_: fn(&mut T) -> &mut F) -> Kind {
    L::KIND
}

const fn kind_of_slot<F: Field>(_: fn(&mut Shape) -> Option<&mut F>) -> Kind {
    F::KIND
}

/// Every statement a dataset may hold. The order decides between equal abbreviations and is the
/// order of writing.
#[rustfmt::skip]
pub static STATEMENTS: &[&dyn Statement] = &[
    &Single::<Option<Units>> {
        keyword: "UNITS",
        value: |m| m.units.clone().map(Some),
        value_mut: |m| &mut m.units,
        bindings: bindings!(Option<Units>:
            own "FORCE" (Kind::Word(units::FORCES), |u, v| put_unit(u, v, |u| &mut u.force), |u| unit(u, |u| &u.force));
            own "MASS" (Kind::Word(units::MASSES), |u, v| put_unit(u, v, |u| &mut u.mass), |u| unit(u, |u| &u.mass));
            own "LENGTH" (Kind::Word(units::LENGTHS), |u, v| put_unit(u, v, |u| &mut u.length), |u| unit(u, |u| &u.length));
            own "TIME" (Kind::Word(units::TIMES), |u, v| put_unit(u, v, |u| &mut u.time), |u| unit(u, |u| &u.time));
            own "SYSTEM" (Kind::Word(units::SYSTEMS), put_unit_system, no_units);
            own "UCF" (REAL, put_ucf, stated_ucf);
        ),
        settings: None,
        finish: consistent_units,
    },
    numbered!(Part, parts: Part, nothing, {
        field "GROUND" (ground);
        field "QG" (qg);
        lens "REULER" (Euler, orientation);
        lens "ZG" (PointOnZ, orientation);
        lens "XG" (PointOnX, orientation);
        field "Mass" (mass);
        field "CM" (cm);
        field "IM" (im);
        lens "IP" (Inertia, ip);
        keep "MATERIAL" (Kind::Text).idle();
        field "VX" (velocity[0]); field "VY" (velocity[1]); field "VZ" (velocity[2]);
        angle "WX" (angular_velocity[0]); angle "WY" (angular_velocity[1]); angle "WZ" (angular_velocity[2]);
        field "VM" (vm);
        field "WM" (wm);
        lens "EXACT" (Exact, exact);
    }),
    numbered!(PointMass, point_masses: Part, nothing, {
        field "QG" (qg);
        lens "REULER" (Euler, orientation);
        lens "ZG" (PointOnZ, orientation);
        lens "XG" (PointOnX, orientation);
        field "MASS" (mass);
        field "CM" (cm);
        keep "MATERIAL" (Kind::Text).idle();
        field "VX" (velocity[0]); field "VY" (velocity[1]); field "VZ" (velocity[2]);
        field "VM" (vm);
        lens "EXACT" (Exact, exact);
    }),
    numbered!(Marker, markers: Marker, nothing, {
        own "PART" (Kind::Id, |m, v| id(v, |n| m.owner = MarkerOwner::Part(n)),
            |m| match m.owner { MarkerOwner::Part(n) => Some(Value::Id(n)), _ => None });
        own "POINT_MASS" (Kind::Id, |m, v| id(v, |n| m.owner = MarkerOwner::PointMass(n)),
            |m| match m.owner { MarkerOwner::PointMass(n) => Some(Value::Id(n)), _ => None });
        own "FLEX_BODY" (Kind::Id, |m, v| put_other_owner(m, ElementKind::FlexBody, v), |m| other_owner(m, ElementKind::FlexBody));
        own "FE_PART" (Kind::Id, |m, v| put_other_owner(m, ElementKind::FePart, v), |m| other_owner(m, ElementKind::FePart));
        own "CURVE" (Kind::Id, |m, v| put_other_owner(m, ElementKind::Curve, v), |m| other_owner(m, ElementKind::Curve));
        keep "NODE_LABEL" (Kind::Id);
        keep "NODE_ID" (IDS);
        keep "VALUE" (REAL);
        field "FLOATING" (floating);
        field "QP" (qp);
        lens "ZP" (PointOnZ, orientation);
        lens "XP" (PointOnX, orientation);
        lens "USEXP" (UseX, orientation);
        lens "REULER" (Euler, orientation);
    }),
    numbered!(Graphics, graphics: Graphics, nothing, {
        variant "BOX" (shape, Shape::Box { .. } => Shape::Box { corner: 0, size: [0.0; 3] }).required().group("shape");
        variant "CYlinder" (shape, Shape::Cylinder { .. } => Shape::Cylinder { cm: 0, length: 0.0, radius: 0.0 }).required().group("shape");
        variant "FRustum" (shape, Shape::Frustum { .. } => Shape::Frustum { cm: 0, length: 0.0, top: 0.0, bottom: 0.0 }).required().group("shape");
        variant "ELLipsoid" (shape, Shape::Ellipsoid { .. } => Shape::Ellipsoid { cm: 0, diameters: [0.0; 3] }).required().group("shape");
        variant "TORus" (shape, Shape::Torus { .. } => Shape::Torus { cm: 0, ring: 0.0, tube: 0.0 }).required().group("shape");
        variant "PLane" (shape, Shape::Plane { .. } => Shape::Plane { rm: 0, x: [None; 2], y: [None; 2] }).required().group("shape");
        variant "CIrcle" (shape, Shape::Circle { .. } => Shape::Circle { cm: 0, radius: 0.0 }).required().group("shape");
        variant "POint" (shape, Shape::Point { .. } => Shape::Point { rm: 0 }).required().group("shape");
        variant "CUrve" (shape, Shape::Curve { .. } => Shape::Curve { curve: 0, rm: 0 }).required().group("shape");
        variant "EXTERNAL" (shape, Shape::External { .. } => Shape::External { rm: 0, file: String::new(), element: None }).required().group("shape");
        variant "ARC" (shape, Shape::Arc { .. } => Shape::Arc { cm: 0, radius: 0.0, angle: std::f64::consts::TAU }).required().group("shape");
        own "OUTline" (IDS, |g, v| { g.shape = Shape::Other("OUTLINE".into()); g.keep("OUTLINE", v.to_string()); Ok(()) }, |_| None)
            .required().group("shape");
        kept_shape "SPdp" ().required().group("shape");
        kept_shape "FOrce" ().required().group("shape");
        variant "SHELL" (shape, Shape::Shell { .. } => Shape::Shell { rm: 0, file: String::new() }).required().group("shape");
        kept_shape "EXTRUSION" ().required().group("shape");
        kept_shape "REVOLUTION" ().required().group("shape");
        kept_shape "GRID" ().required().group("shape");
        shape "CORner" (Shape::Box { corner, .. } => corner);
        own "CM" (IDS, put_graphics_cm, graphics_cm);
        shape "RM" (Shape::Plane { rm, .. } | Shape::Point { rm } | Shape::External { rm, .. } | Shape::Shell { rm, .. } => rm);
        shape "CID" (Shape::Curve { curve, .. } => curve);
        shape "CRM" (Shape::Curve { rm, .. } => rm);
        shape "X" (Shape::Box { size: [x, _, _], .. } => x);
        shape "Y" (Shape::Box { size: [_, y, _], .. } => y);
        shape "Z" (Shape::Box { size: [_, _, z], .. } => z);
        shape "XScale" (Shape::Ellipsoid { diameters: [x, _, _], .. } => x);
        shape "YScale" (Shape::Ellipsoid { diameters: [_, y, _], .. } => y);
        shape "ZScale" (Shape::Ellipsoid { diameters: [_, _, z], .. } => z);
        shape "LENGTH" (Shape::Cylinder { length, .. } | Shape::Frustum { length, .. } => length);
        shape "TOP" (Shape::Frustum { top, .. } => top);
        shape "BOTTOM" (Shape::Frustum { bottom, .. } => bottom);
        shape "RADIUS" (Shape::Cylinder { radius, .. } | Shape::Circle { radius, .. } | Shape::Arc { radius, .. } => radius);
        shape "MAJOR_RADIUS" (Shape::Torus { ring, .. } => ring);
        shape "MINOR_RADIUS" (Shape::Torus { tube, .. } => tube);
        own "XMIN" (REAL, |g, v| put_bound(g, false, 0, v), |g| bound(g, false, 0));
        own "XMAX" (REAL, |g, v| put_bound(g, false, 1, v), |g| bound(g, false, 1));
        own "YMIN" (REAL, |g, v| put_bound(g, true, 0, v), |g| bound(g, true, 0));
        own "YMAX" (REAL, |g, v| put_bound(g, true, 1, v), |g| bound(g, true, 1));
        shape "FILE" (Shape::External { file, .. } | Shape::Shell { file, .. } => file);
        own "ELEMENT" (Kind::Text,
            |g, v| match &mut g.shape { Shape::External { element, .. } => element.put(v), _ => Err("ELEMENT goes with EXTERNAL".into()) },
            |g| match &g.shape { Shape::External { element, .. } => element.written(), _ => None });
        keep "FACETING_TOLERANCE" (REAL);
        keep "SEG|SEGMENTS" (Kind::Id);
        keep "SIDES" (Kind::Id);
        own "RANGLE" (ANGLE, put_arc_angle, arc_angle);
        keep "I" (Kind::Id);
        keep "J" (Kind::Id);
        keep "COILS" (Kind::Id);
        keep "DA" (REAL); keep "DB" (REAL); keep "DC" (REAL);
        keep "LA" (REAL); keep "LB" (REAL); keep "LC" (REAL); keep "LD" (REAL);
        keep "ETYPE" (WORD);
        keep "EID" (Kind::Id);
        keep "EMARKER" (Kind::Id);
        keep "BITMAP" (Kind::Text);
        keep "MATRIX" (Kind::Id);
    }),
    numbered!(Joint, joints: Joint, nothing, JOINT_TYPES, {
        field "I" (i).required();
        field "J" (j).required();
        own "IC" (Kind::Reals { min: 1, max: 2, angle: true }, put_joint_ic, joint_ic);
        own "ICTran" (Kind::Reals { min: 1, max: 2, angle: false }, put_ic_translation,
            |j| if j.kind.displacements() == Displacements::Translation { None } else { ic_translation(j) });
        own "ICRot" (Kind::Reals { min: 1, max: 2, angle: true }, put_ic_rotation,
            |j| if j.kind.displacements() == Displacements::Rotation { None } else { ic_rotation(j) });
        field "PITCH" (pitch);
        field "PD" (pd);
        lens "FRICTION" (Word, friction);
        keep "DELTA_V" (REAL).idle();
        keep "MAXIMUM_DEFORMATION" (REAL).idle();
        keep "MU_DYN_ROT" (REAL);
        keep "MU_STAT_ROT" (REAL);
        keep "MU_DYN_TRANS" (REAL);
        keep "MU_STAT_TRANS" (REAL);
        keep "MAX_FRIC_ROT" (REAL);
        keep "MAX_FRIC_TRANS" (REAL);
        keep "PRELOAD_RADIAL" (REAL).idle();
        keep "PRELOAD_AXIAL" (REAL).idle();
        keep "PRELOAD_X" (REAL).idle();
        keep "PRELOAD_Y" (REAL).idle();
        keep "INNER_RADIUS" (REAL).idle();
        keep "OUTER_RADIUS" (REAL).idle();
        keep "HEIGHT" (REAL).idle();
        keep "WIDTH" (REAL).idle();
    }),
    numbered!(Jprim, primitives: Primitive, nothing, PRIMITIVE_TYPES, {
        field "I" (i).required();
        field "J" (j).required();
    }),
    numbered!(Motion, motions: Motion, motion_form, {
        own "JOINT" (Kind::Id, put_motion_joint, motion_joint);
        own "I" (Kind::Id, |m, v| put_motion_marker(m, v, false), |m| motion_marker(m, false));
        own "J" (Kind::Id, |m, v| put_motion_marker(m, v, true), |m| motion_marker(m, true));
        own "TRANSLATIONAL" (Kind::Flag, |m, _| { motion_along(m, false); Ok(()) },
            |m| matches!(m.driven, Driven::JointTranslation(_)).then_some(Value::Flag)).group("direction");
        own "ROTATIONAL" (Kind::Flag, |m, _| { motion_along(m, true); Ok(()) },
            |m| matches!(m.driven, Driven::JointRotation(_)).then_some(Value::Flag)).group("direction");
        own "X" (Kind::Flag, |m, _| put_component(m, 0), |m| component(m, 0)).group("direction");
        own "Y" (Kind::Flag, |m, _| put_component(m, 1), |m| component(m, 1)).group("direction");
        own "Z" (Kind::Flag, |m, _| put_component(m, 2), |m| component(m, 2)).group("direction");
        own "B1" (Kind::Flag, |m, _| put_component(m, 3), |m| component(m, 3)).group("direction");
        own "B2" (Kind::Flag, |m, _| put_component(m, 4), |m| component(m, 4)).group("direction");
        own "B3" (Kind::Flag, |m, _| put_component(m, 5), |m| component(m, 5)).group("direction");
        own "Displacement" (Kind::Flag, |m, _| { m.level = Level::Displacement; Ok(()) }, |_| None).group("level");
        choice "Velocity" (level = Level::Velocity).group("level");
        choice "Acceleration" (level = Level::Acceleration).group("level");
        angle "ICDisp" (ic_displacement);
        angle "ICVel" (ic_velocity);
        field "FUNCTION" (function).required();
        lens "ROUTINE" (Routine, function);
    }),
    numbered!(Coupler, couplers: Coupler, coupler_form, {
        field "JOINTS" (joints).required();
        lens "TYPE" (CouplerTypes, rotational);
        field "SCALES" (scales);
        field "FUNCTION" (user);
        lens "ROUTINE" (Routine, user);
    }),
    numbered!(Gear, gears: Gear, nothing, {
        field "JOINTS" (joints).required();
        field "CV" (cv).required();
    }),
    numbered!(Gcon, general_constraints: GeneralConstraint, nothing, {
        field "I" (i);
        field "FUNCTION" (function).required();
        lens "ROUTINE" (Routine, function);
    }),
    numbered!(Curve, curves: Curve, nothing, {
        choice "OPEN" (closed = false).group("ends");
        choice "CLOSED" (closed = true).group("ends");
        field "ORDER" (order);
        field "MATRIX" (matrix);
        choice "CURVE_POINTS" (through_points = Some(true)).group("points");
        choice "CONTROL_POINTS" (through_points = Some(false)).group("points");
        field "MINPAR" (minpar);
        field "MAXPAR" (maxpar);
        field "FUNCTION" (function);
        lens "ROUTINE" (Routine, function);
    }),
    numbered!(Ptcv, points_on_curves: PointOnCurve, nothing, {
        field "I" (i).required();
        field "JFLOAT" (jfloat);
        field "RM" (rm).required();
        field "CURVE" (curve).required();
        field "DISP" (start);
        field "VEL" (velocity);
        field "ICM" (start_marker);
    }),
    numbered!(Cvcv, curves_on_curves: CurveOnCurve, nothing, {
        field "ICURVE" (i.curve).required();
        field "IRM" (i.rm).required();
        field "IFLOAT" (i.float);
        field "JCURVE" (j.curve).required();
        field "JRM" (j.rm).required();
        field "JFLOAT" (j.float);
        field "IDISP" (i.start);
        field "IICM" (i.start_marker);
        field "IVEL" (i.velocity);
        field "JDISP" (j.start);
        field "JICM" (j.start_marker);
        field "JVEL" (j.velocity);
    }),
    numbered!(Sforce, sforces: SingleForce, nothing, {
        choice "TRANSLATIONAL" (rotational = false).required().group("kind");
        choice "ROTATIONAL" (rotational = true).required().group("kind");
        field "I" (i).required();
        field "J" (j).required();
        choice "ACTIONONLY" (action_only = true);
        field "FUNCTION" (function).required();
        lens "ROUTINE" (Routine, function);
    }),
    numbered!(Vforce, vforces: VectorForce, nothing, {
        field "I" (i).required();
        field "JFLOAT" (jfloat);
        field "RM" (rm);
        field "FX" (force[0]); field "FY" (force[1]); field "FZ" (force[2]);
        field "FUNCTION" (user);
        lens "ROUTINE" (Routine, user);
    }),
    numbered!(Vtorque, vtorques: VectorForce, nothing, {
        field "I" (i).required();
        field "JFLOAT" (jfloat);
        field "RM" (rm);
        field "TX" (torque[0]); field "TY" (torque[1]); field "TZ" (torque[2]);
        field "FUNCTION" (user);
        lens "ROUTINE" (Routine, user);
    }),
    numbered!(Gforce, gforces: VectorForce, nothing, {
        field "I" (i).required();
        field "JFLOAT" (jfloat);
        field "RM" (rm);
        field "FX" (force[0]); field "FY" (force[1]); field "FZ" (force[2]);
        field "TX" (torque[0]); field "TY" (torque[1]); field "TZ" (torque[2]);
        field "FUNCTION" (user);
        lens "ROUTINE" (Routine, user);
    }),
    numbered!(SpringDamper, spring_dampers: SpringDamper, nothing, {
        choice "TRANSLATIONAL" (rotational = false).required().group("kind");
        choice "ROTATIONAL" (rotational = true).required().group("kind");
        field "I" (i).required();
        field "J" (j).required();
        own "C" (REAL, |s, v| put_spring(s, false, v, |s| &mut s.damping), |s| spring(s, false, s.damping));
        own "K" (REAL, |s, v| put_spring(s, false, v, |s| &mut s.stiffness), |s| spring(s, false, s.stiffness));
        own "FORCE" (REAL, |s, v| put_spring(s, false, v, |s| &mut s.preload), |s| spring(s, false, s.preload));
        own "LENGTH" (REAL, |s, v| put_spring(s, false, v, |s| &mut s.free), |s| spring(s, false, s.free));
        own "CT" (REAL, |s, v| put_spring(s, true, v, |s| &mut s.damping), |s| spring(s, true, s.damping));
        own "KT" (REAL, |s, v| put_spring(s, true, v, |s| &mut s.stiffness), |s| spring(s, true, s.stiffness));
        own "TORQUE" (REAL, |s, v| put_spring(s, true, v, |s| &mut s.preload), |s| spring(s, true, s.preload));
        own "ANGLE" (ANGLE, |s, v| put_spring(s, true, v, |s| &mut s.free),
            |s| spring(s, true, s.free).map(|_| Value::Real(Number::angle(s.free))));
    }),
    numbered!(Bushing, bushings: Bushing, nothing, {
        field "I" (i).required();
        field "J" (j).required();
        lens "C" (FirstThree, damping);
        lens "K" (FirstThree, stiffness);
        lens "FORCE" (FirstThree, preload);
        lens "CT" (LastThree, damping);
        lens "KT" (LastThree, stiffness);
        lens "TORQUE" (LastThree, preload);
    }),
    numbered!(Field, fields: crate::model::Field, nothing, {
        field "I" (i).required();
        field "J" (j).required();
        lens "CMATRIX" (Many<36>, damping);
        field "CRATIO" (damping_ratio);
        lens "KMATRIX" (Many<36>, stiffness);
        field "FORCE" (preload);
        lens "LENGTH" (SixDisplacements, free);
        field "FUNCTION" (function);
        lens "ROUTINE" (Routine, function);
    }),
    numbered!(Beam, beams: Beam, nothing, {
        field "I" (i).required();
        field "J" (j).required();
        field "LENGTH" (length).required();
        field "IXX" (second_moments[0]); field "IYY" (second_moments[1]); field "IZZ" (second_moments[2]);
        field "AREA" (area);
        field "ASY" (shear[0]); field "ASZ" (shear[1]);
        field "EMODULUS" (youngs_modulus);
        field "GMODULUS" (shear_modulus);
        field "CRATIO" (damping_ratio);
        lens "CMATRIX" (Many<21>, damping);
        field "FORMULATION" (formulation);
    }),
    numbered!(Nforce, nodal_forces: NodalForce, nothing, {
        field "IMARKERS" (i).required();
        field "J" (j).required();
        field "KMATRIX" (stiffness).required();
        field "LENGTH" (free);
        field "FORCE" (preload);
        field "CMATRIX" (damping);
        field "CRATIO" (damping_ratio);
    }),
    numbered!(Contact, contacts: Contact, contact_form, {
        lens "TYPE" (Word, kind);
        field "IGEOM" (i_geometry).required();
        field "JGEOM" (j_geometry).required();
        choice "IMPACT" (law = ContactLaw::Impact).group("law");
        choice "POISSON" (law = ContactLaw::Poisson).group("law");
        field "STIFFNESS" (stiffness);
        field "DAMPING" (damping);
        field "DMAX" (dmax);
        field "EXPONENT" (exponent);
        field "PENALTY" (penalty);
        field "RESTITUTION_COEFFICIENT" (restitution);
        field "COULOMB_FRICTION" (friction);
        field "MU_STATIC" (mu_static);
        field "MU_DYNAMIC" (mu_dynamic);
        field "STICTION_TRANSITION_VELOCITY" (stiction_transition_velocity);
        field "FRICTION_TRANSITION_VELOCITY" (friction_transition_velocity);
        lens "STICTION" (OnOff, stiction);
        field "MAX_STICTION_DEFORMATION" (max_stiction_deformation);
        field "IFLIP" (flip[0]);
        field "JFLIP" (flip[1]);
        field "AUGMENTED_LAGRANGIAN_FORMULATION" (augmented_lagrangian);
        own "FUNCTION|NORMAL_FUNCTION" (Kind::Formula, |c, v| { c.law = ContactLaw::User; c.function.put(v) }, |c| c.function.written()).group("law");
        lens "ROUTINE|NORMAL_ROUTINE" (Routine, function);
        field "FRICTION_FUNCTION" (friction_function);
        lens "FRICTION_ROUTINE" (Routine, friction_function);
    }),
    numbered!(Friction, frictions: Friction, nothing, {
        field "JOINT" (joint).required();
        field "MU_STATIC" (mu_static);
        field "MU_DYNAMIC" (mu_dynamic);
        field "STICTION_TRANSITION_VELOCITY" (stiction_transition_velocity);
        field "MAX_STICTION_DEFORMATION" (max_stiction_deformation);
        own "EFFECT" (Kind::Word(&["ALL", "STICTION", "SLIDING"]), |f, v| Word::put(&mut f.effect, v), |f| Word::get(&f.effect));
        own "INPUTS" (Kind::Words(&["ALL", "NONE", "PRELOAD", "REACTION_FORCE", "BENDING_MOMENT", "TORSIONAL_MOMENT"]),
            |f, v| f.inputs.put(v), |f| words(&f.inputs));
        field "FRICTION_FORCE_PRELOAD" (force_preload);
        field "FRICTION_TORQUE_PRELOAD" (torque_preload);
        field "FRICTION_ARM" (friction_arm);
        field "BENDING_REACTION_ARM" (bending_reaction_arm);
        field "PIN_RADIUS" (pin_radius);
        field "BALL_RADIUS" (ball_radius);
        field "INITIAL_OVERLAP" (initial_overlap);
        field "REACTION_ARM" (reaction_arm);
        own "OVERLAP_DELTA" (Kind::Word(&["CONSTANT", "INCREASE", "DECREASE"]),
            |f, v| Word::put(&mut f.overlap_delta, v), |f| Word::get(&f.overlap_delta));
        own "INACTIVE|INACTIVE_DURING" (Kind::Word(&["STATIC", "NEVER"]),
            |f, v| { f.inactive_in_statics = v == Value::Word("STATIC".into()); Ok(()) },
            |f| f.inactive_in_statics.then(|| Value::Word("STATIC".into())));
        own "FORMULATION" (Kind::Word(&["ORIGINAL", "LUGRE"]),
            |f, v| { f.lugre = v == Value::Word("LUGRE".into()); Ok(()) },
            |f| f.lugre.then(|| Value::Word("LUGRE".into())));
    }),
    numbered!(Variable, variables: Variable, nothing, {
        field "IC" (ic);
        field "FUNCTION" (function).required();
        lens "ROUTINE" (Routine, function);
    }),
    numbered!(Diff, differentials: Differential, nothing, {
        field "IC" (ic);
        field "STATIC_HOLD" (static_hold);
        field "IMPLICIT" (implicit);
        field "FUNCTION" (function).required();
        lens "ROUTINE" (Routine, function);
    }),
    numbered!(Array, arrays: Array, nothing, {
        variant "IC" (kind, ArrayKind::Ic(_) => ArrayKind::Ic(Vec::new())).required().group("kind");
        variant "X" (kind, ArrayKind::States => ArrayKind::States).required().group("kind");
        variant "Y" (kind, ArrayKind::Outputs => ArrayKind::Outputs).required().group("kind");
        variant "U" (kind, ArrayKind::Inputs(_) => ArrayKind::Inputs(Vec::new())).required().group("kind");
        field "SIZE" (size);
        own "NUMBERS" (REALS, |a, v| match &mut a.kind { ArrayKind::Ic(x) => x.put(v), _ => Err("NUMBERS go with IC".into()) },
            |a| match &a.kind { ArrayKind::Ic(x) => x.written(), _ => None });
        own "VARIABLES" (IDS, |a, v| match &mut a.kind { ArrayKind::Inputs(x) => x.put(v), _ => Err("VARIABLES go with U".into()) },
            |a| match &a.kind { ArrayKind::Inputs(x) => x.written(), _ => None });
    }),
    numbered!(Spline, splines: SplineData, spline_surface, {
        own "X" (REALS, |s, v| { s.y.clear(); s.z.clear(); s.x.put(v) }, |s| s.x.written());
        many "Y" (REALS, put_spline_row, spline_rows).repeated();
        field "FILE" (file);
        keep "BLOCK" (Kind::Text);
        keep "CHANNEL" (Kind::Text);
        field "LINEAR_EXTRAPOLATE" (linear_extrapolate);
    }),
    numbered!(String, strings: StringData, nothing, {
        own "STRING" (Kind::Text, |s, v| s.text.put(v), |s| Some(s.text.always())).required();
    }),
    numbered!(Matrix, matrices: Matrix, nothing, {
        own "FULL" (Kind::Word(&["RORDER", "CORDER"]), put_matrix_order, matrix_order);
        variant "SPARSE" (layout, MatrixLayout::Sparse { .. } => MatrixLayout::Sparse { rows: Vec::new(), columns: Vec::new() });
        field "ROWS" (rows);
        field "COLUMNS" (columns);
        own "I" (IDS, |m, v| match &mut m.layout { MatrixLayout::Sparse { rows, .. } => rows.put(v), _ => Err("I goes with SPARSE".into()) },
            |m| match &m.layout { MatrixLayout::Sparse { rows, .. } => rows.written(), _ => None });
        own "J" (IDS, |m, v| match &mut m.layout { MatrixLayout::Sparse { columns, .. } => columns.put(v), _ => Err("J goes with SPARSE".into()) },
            |m| match &m.layout { MatrixLayout::Sparse { columns, .. } => columns.written(), _ => None });
        field "VALUES" (values);
        field "FILE" (file);
        keep "NAME" (Kind::Text);
    }),
    numbered!(Lse, linear_systems: LinearSystem, nothing, {
        field "X" (x).required();
        field "IC" (ic);
        field "U" (u);
        field "Y" (y);
        field "A" (a).required();
        field "B" (b);
        field "C" (c);
        field "D" (d);
        field "STATIC_HOLD" (static_hold);
    }),
    numbered!(Gse, general_systems: GeneralSystem, nothing, {
        field "NS" (ns);
        field "NO" (no);
        field "X" (x);
        keep "XXFLAG" (WORD).idle();
        field "U" (u);
        field "Y" (y);
        keep "XUFLAG" (WORD).idle();
        keep "YUFLAG" (WORD).idle();
        keep "YXFLAG" (WORD).idle();
        field "IC" (ic);
        field "XD" (xd);
        field "ND" (nd);
        field "ICD" (icd);
        field "SAMPLE_PERIOD" (sample_period);
        keep "SAMPLE_OFFSET" (REAL).idle();
        field "STATIC_HOLD" (static_hold);
        keep "IMPLICIT" (Kind::Flag).idle();
        field "FUNCTION" (function);
        lens "ROUTINE" (Routine, function);
        keep "INTERFACE" (Kind::Text).idle();
    }),
    numbered!(Tfsiso, transfer_functions: TransferFunction, nothing, {
        field "X" (x).required();
        field "U" (u).required();
        field "Y" (y).required();
        field "NUMERATOR" (numerator).required();
        field "DENOMINATOR" (denominator).required();
        field "STATIC_HOLD" (static_hold);
    }),
    numbered!(Pinput, plant_inputs: Plant, nothing, {
        field "VARIABLES" (variables).required();
    }),
    numbered!(Poutput, plant_outputs: Plant, nothing, {
        field "VARIABLES" (variables).required();
    }),
    numbered!(Sensor, sensors: Sensor, nothing, {
        own "VALUE" (ANGLE, |s, v| s.value.put(v), |s| Some(s.value.always())).required();
        choice "EQ" (comparison = Comparison::Equal).group("comparison");
        choice "GE" (comparison = Comparison::GreaterOrEqual).group("comparison");
        choice "LE" (comparison = Comparison::LessOrEqual).group("comparison");
        angle "ERRor" (error).from_zero();
        field "ANGULAR" (angular);
        field "BISECTION" (bisection).idle();
        field "HALT" (halt);
        field "RETURN" (end_simulation);
        field "PRINT" (print);
        field "DT" (dt).positive();
        field "STEPSIZE" (stepsize).positive();
        field "RESTART" (restart);
        field "CODGEN" (codgen).idle();
        field "YYDUMP" (yydump).idle();
        field "FUNCTION" (function).required();
        lens "ROUTINE" (Routine, function);
        field "EVALUATE" (evaluate);
    }),
    numbered!(Request, requests: Request, nothing, {
        own "Displacement" (Kind::Flag, |r, _| ask(r, Quantity::Displacement), |r| asked(r, Quantity::Displacement)).group("quantity");
        own "Velocity" (Kind::Flag, |r, _| ask(r, Quantity::Velocity), |r| asked(r, Quantity::Velocity)).group("quantity");
        own "Acceleration" (Kind::Flag, |r, _| ask(r, Quantity::Acceleration), |r| asked(r, Quantity::Acceleration)).group("quantity");
        own "Force" (Kind::Flag, |r, _| ask(r, Quantity::Force), |r| asked(r, Quantity::Force)).group("quantity");
        own "I" (Kind::Id, |r, v| put_request_marker(r, 0, v), |r| request_marker(r, 0));
        own "J" (Kind::Id, |r, v| put_request_marker(r, 1, v), |r| request_marker(r, 1));
        own "RM" (Kind::Id, |r, v| put_request_marker(r, 2, v), |r| request_marker(r, 2));
        field "Comment" (comment);
        own "TITLE" (WORDS, |r, v| r.title.put(v), |r| words(&r.title));
        field "CUNITS" (cunits);
        field "CNAMES" (cnames);
        field "CLABELS" (clabels);
        field "RESULTS_NAME" (results_name);
        own "F1" (Kind::Formula, |r, v| put_request_function(r, 0, v), |r| request_function(r, 0));
        own "F2" (Kind::Formula, |r, v| put_request_function(r, 1, v), |r| request_function(r, 1));
        own "F3" (Kind::Formula, |r, v| put_request_function(r, 2, v), |r| request_function(r, 2));
        own "F4" (Kind::Formula, |r, v| put_request_function(r, 3, v), |r| request_function(r, 3));
        own "F5" (Kind::Formula, |r, v| put_request_function(r, 4, v), |r| request_function(r, 4));
        own "F6" (Kind::Formula, |r, v| put_request_function(r, 5, v), |r| request_function(r, 5));
        own "F7" (Kind::Formula, |r, v| put_request_function(r, 6, v), |r| request_function(r, 6));
        own "F8" (Kind::Formula, |r, v| put_request_function(r, 7, v), |r| request_function(r, 7));
        own "FUNCTION" (Kind::Formula, |r, v| request_user(r).put(v), |r| match &r.kind { RequestKind::User(f) => Some(f.always()), _ => None });
        own "ROUTINE" (Kind::Text, |r, v| <Routine as Lens<Formula>>::put(request_user(r), v),
            |r| match &r.kind { RequestKind::User(f) => <Routine as Lens<Formula>>::get(f), _ => None });
    }),
    numbered!(Mrequest, many_requests: ManyRequests, nothing, {
        choice "Displacement" (quantity = Quantity::Displacement).required().group("quantity");
        choice "Velocity" (quantity = Quantity::Velocity).required().group("quantity");
        choice "Acceleration" (quantity = Quantity::Acceleration).required().group("quantity");
        choice "Force" (quantity = Quantity::Force).required().group("quantity");
        own "PARTS" (WORDS, |r, v| r.parts.put(v), |r| words(&r.parts));
        own "JOINTS" (WORDS, |r, v| r.joints.put(v), |r| words(&r.joints));
        own "JPRIMS" (WORDS, |r, v| r.primitives.put(v), |r| words(&r.primitives));
        own "APPFORS" (WORDS, |r, v| r.forces.put(v), |r| words(&r.forces));
        field "RM" (rm);
        field "Comment" (comment);
    }),
    single!("ACCGRAV", gravity: [f64; 3], {
        own "IGRAV" (REAL, |g, v| g[0].put(v), |g| g[0].written());
        own "JGRAV" (REAL, |g, v| g[1].put(v), |g| g[1].written());
        own "KGRAV" (REAL, |g, v| g[2].put(v), |g| g[2].written());
    }),
    single!("INTEGRATOR", integrator: IntegratorSettings, {
        named "GSTIFF" (method).group("method");
        named "WSTIFF" (method).group("method");
        named "HASTIFF" (method).group("method");
        named "HHT" (method).group("method");
        named "NEWMARK" (method).group("method");
        named "ABAM" (method).group("method");
        named "RKF45" (method).group("method");
        named "DSTIFF" (method).group("method");
        named "CONSTANT_BDF" (method).group("method");
        named "I3" (formulation).group("formulation");
        named "SI2" (formulation).group("formulation");
        named "SI1" (formulation).group("formulation");
        field "ERRor" (error).positive();
        field "HMAx" (hmax).positive();
        field "HMIn" (hmin).from_zero();
        field "HINit" (hinit).positive();
        field "KMAX" (kmax).positive();
        field "MAXIT" (maxit).positive();
        field "ALPHA" (alpha).idle();
        field "BETA" (beta).idle();
        field "GAMMA" (gamma).idle();
        set "PATTERN" (WORDS, |e| &mut e.rest, |e| &e.rest).idle();
        set "CORRECTOR" (Kind::Word(&["ORIGINAL", "MODIFIED"]), |e| &mut e.rest, |e| &e.rest).idle();
        set "INTERPOLATE" (ON_OFF, |e| &mut e.rest, |e| &e.rest).idle();
        set "ADAPTIVITY" (REAL, |e| &mut e.rest, |e| &e.rest).idle();
        set "SCALE" (REALS, |e| &mut e.rest, |e| &e.rest).idle();
        set "FIXIT" (REAL, |e| &mut e.rest, |e| &e.rest).idle();
        set "HRATIO" (REAL, |e| &mut e.rest, |e| &e.rest).idle();
        set "MAXERR" (REAL, |e| &mut e.rest, |e| &e.rest).idle();
        set "REPEAT" (Kind::Flag, |e| &mut e.rest, |e| &e.rest).idle();
        set "LIST" (Kind::Flag, |e| &mut e.rest, |e| &e.rest).idle();
    }),
    single!("EQUILIBRIUM", equilibrium: EquilibriumSettings, {
        set "STATICS" (Kind::Flag, |e| &mut e.rest, |e| &e.rest).group("kind");
        set "DYNAMICS" (Kind::Flag, |e| &mut e.rest, |e| &e.rest).group("kind").idle();
        angle "ALimit" (alimit).positive();
        field "TLimit" (tlimit).positive();
        field "ERRor" (error).positive();
        field "IMBALANCE" (imbalance).positive();
        field "MAXIT" (maxit).positive();
        field "STABILITY" (stability).from_zero();
        set "PATTERN" (WORDS, |e| &mut e.rest, |e| &e.rest).idle();
        set "ACCELERATION_ERROR|AERROR" (REAL, |e| &mut e.rest, |e| &e.rest).idle();
        set "KINETIC_ENERGY_ERROR" (REAL, |e| &mut e.rest, |e| &e.rest).idle();
        set "GLOBAL_DAMPING" (REAL, |e| &mut e.rest, |e| &e.rest).idle();
        set "SETTLING_TIME" (REAL, |e| &mut e.rest, |e| &e.rest).idle();
        set "DEFAULT" (Kind::Flag, |e| &mut e.rest, |e| &e.rest);
        set "LIST" (Kind::Flag, |e| &mut e.rest, |e| &e.rest).idle();
    }),
    single!("KINEMATICS", kinematics: Settings, {
        set "ERRor" (REAL).idle();
        set "HMAX" (REAL).positive();
        set "ALimit" (ANGLE).idle();
        set "TLimit" (REAL).idle();
        set "MAXIT" (REAL).idle();
        set "PATTERN" (WORDS).idle();
        set "AERROR" (REAL).idle();
        set "AMAXIT" (REAL).idle();
        set "APATTERN" (WORDS).idle();
        set "VERROR" (REAL).idle();
        set "LIST" (Kind::Flag).idle();
    }),
    single!("IC", initial_conditions: Settings, {
        set "ERRor" (REAL).positive();
        set "MAXIT" (REAL).idle();
        set "PATTERN" (WORDS).idle();
        set "TLimit" (REAL).idle();
        set "ALimit" (ANGLE).idle();
        set "AMAXIT" (REAL).idle();
        set "APATTERN" (WORDS).idle();
        set "VERROR" (REAL).idle();
        set "AERROR" (REAL).idle();
        set "LIST" (Kind::Flag).idle();
    }),
    settings!(Preferences, {
        set "SOLVER" (WORD);
        set "SIMERR" (WORD);
        set "LIBPATH" (Kind::Text);
        set "NTHREADS" (REAL);
        set "CONTACT_FACETING_TOLERANCE" (REAL);
        set "CONTACT_GEOMETRY_LIBRARY" (WORD);
        set "STATUSMSG" (WORD);
        set "THREAD_COUNT" (REAL);
        set "LIST" (Kind::Flag);
    }),
    settings!(Debug, {
        set "EPRINT" (Kind::Flag);
        set "VERBOSE" (Kind::Flag);
    }),
    settings!(Lsolver, {}),
    settings!(Environment, {
        set "NAME" (Kind::Text);
        set "VALUE" (Kind::Text);
    }),
    settings!(Output, {
        set "REQSAVE" (Kind::Flag);
        set "GRSAVE" (Kind::Flag);
        set "NOPRINT" (Kind::Flag).idle();
        set "NOSEPARATOR" (Kind::Flag).idle();
        set "YPR" (Kind::Flag);
        set "TELETYPE" (Kind::Flag).idle();
        set "FIXED" (Kind::Flag).idle();
        set "OSFORMAT" (Kind::Flag).idle();
        set "GR521SAV" (Kind::Flag).idle();
        set "CHART" (REAL).idle();
        set "DSCALE" (REALS).idle(); set "VSCALE" (REALS).idle(); set "ASCALE" (REALS).idle(); set "FSCALE" (REALS).idle();
        set "DZERO" (REALS).idle(); set "VZERO" (REALS).idle(); set "AZERO" (REALS).idle(); set "FZERO" (REALS).idle();
    }),
    settings!(Results, {
        set "XRF" (Kind::Flag);
        set "FORMATTED" (Kind::Flag);
        set "Comment" (Kind::Text).idle();
        set "DECIMAL_PLACES" (REAL).idle();
        set "NODISPLACEMENTS" (Kind::Flag);
        set "NOVELOCITIES" (Kind::Flag);
        set "NOACCELERATIONS" (Kind::Flag);
        set "NOREACTIONFORCES" (Kind::Flag);
        set "NOAPPLIEDFORCES" (Kind::Flag);
        set "NODATASTRUCTURES" (Kind::Flag).idle();
        set "NOSYSTEMELEMENTS" (Kind::Flag);
        set "NOLINEAR" (Kind::Flag).idle();
        set "NOFLOATINGMARKERS" (Kind::Flag);
        set "NOTIRES" (Kind::Flag).idle();
        set "NOREQUESTS" (Kind::Flag);
        set "NOCONTACTS" (Kind::Flag);
    }),
    settings!(List, {}),
    settings!(Nolist, {}),
    &Opaque { kind: ElementKind::Material },
    &Opaque { kind: ElementKind::Section },
    &Opaque { kind: ElementKind::FePart },
    &Opaque { kind: ElementKind::FeNode },
    &Opaque { kind: ElementKind::FeLoad },
    &Opaque { kind: ElementKind::FlexBody },
    &Opaque { kind: ElementKind::Femdata },
    &Opaque { kind: ElementKind::Mforce },
    &Opaque { kind: ElementKind::Ucon },
    &Opaque { kind: ElementKind::Tire },
    &Opaque { kind: ElementKind::Wheel },
    &Opaque { kind: ElementKind::Surface },
    &Opaque { kind: ElementKind::Cvsf },
    &Opaque { kind: ElementKind::Ptsf },
    &Opaque { kind: ElementKind::Sfsf },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::row::meaning;

    #[test]
    fn no_two_names_of_a_row_share_a_spelling() {
        let unique = |names: Vec<&str>, of: &str| {
            let spellings = names.iter().flat_map(|name| name.split('|'));
            let mut all: Vec<String> = spellings.map(str::to_ascii_uppercase).collect();
            let n = all.len();
            all.sort();
            all.dedup();
            assert_eq!(all.len(), n, "{of}");
            for (k, name) in names.iter().enumerate() {
                for spelling in name.split('|') {
                    let word = spelling.to_lowercase();
                    let meant = meaning(&word, names.iter().copied());
                    assert_eq!(meant, Meaning::One(k), "{of} {word}");
                }
                let written = format!("{name}|");
                assert_eq!(meaning(&written, names.iter().copied()), Meaning::Unknown);
                if name.contains('|') {
                    assert_eq!(meaning(name, names.iter().copied()), Meaning::Unknown);
                }
            }
        };
        unique(
            STATEMENTS.iter().map(|s| s.keyword()).collect(),
            "statements",
        );
        for row in STATEMENTS {
            let arguments = row.arguments();
            unique(arguments.iter().map(|a| a.name).collect(), row.keyword());
            for argument in arguments {
                if let Kind::Word(words) | Kind::Words(words) = argument.kind {
                    unique(words.to_vec(), argument.name);
                }
            }
        }
    }

    #[test]
    fn a_word_is_found_among_the_names_that_begin_as_it_does_as_among_all() {
        let spellings = STATEMENTS.iter().flat_map(|s| s.keyword().split('|'));
        for spelling in spellings.chain(["NOTHING", "éa", "1/2", "|ab"]) {
            for (end, _) in spelling
                .char_indices()
                .skip(3)
                .chain([(spelling.len(), ' ')])
            {
                for word in [spelling[..end].to_string(), spelling[..end].to_lowercase()] {
                    let among_all = meaning(&word, STATEMENTS.iter().map(|s| s.keyword()));
                    if word.len() >= 3 {
                        assert_eq!(find(&word), among_all, "{word}");
                    }
                }
            }
        }
    }
}
