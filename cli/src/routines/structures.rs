//! Facts of elements that routines are told: as structures of C, in the layout that
//! `slv_c_utils.h` of Adams gives them and `include/cognate_routines.h` writes down, and by name.

use serde_json::{Map, Value, json};
use std::ffi::{CStr, CString, c_char, c_int, c_void};

/// Facts of an element that a structure of C tells, beside its number and the numbers of USER.
#[derive(Clone, Debug)]
pub enum Structure {
    /// SFORCE: I, J, whether it has no reaction, its type
    Single([c_int; 3], &'static CStr),
    /// VFORCE and VTORQUE: I, JFLOAT, RM
    Vector([c_int; 3]),
    /// GFORCE: I, RM, JFLOAT
    General([c_int; 3]),
    /// VARIABLE: IC
    Variable(f64),
    /// DIFF: STATIC_HOLD and IMPLICIT; IC
    Differential([c_int; 2], [f64; 2]),
    /// MOTION: the numbers of its joint and its markers
    Motion {
        joint: c_int,
        kind: &'static CStr,
        markers: [c_int; 2],
        which: [u8; 2],
        level: &'static CStr,
    },
    /// REQUEST: COMMENT and TITLE
    Request(CString, [CString; 8]),
    /// SENSOR: VALUE and ERROR; the letters of its comparison
    Sensor([f64; 2], [u8; 2]),
    /// GSE: NI, NO, U, Y, NS, X, IC, STATIC_HOLD, IMPLICIT, STATICS_ONLY, ND, XD, ICD
    System([c_int; 13]),
    /// COUPLER: how many joints, their numbers, and T or R for each
    Coupler(c_int, [c_int; 3], [u8; 3]),
    /// CURVE: CLOSED and ORDER; MINPAR and MAXPAR
    Curve([c_int; 2], [f64; 2]),
    /// CONTACT: GRAPHICS of I and J, whether each of them is turned inside out
    Contact([Vec<c_int>; 2], [Vec<c_int>; 2]),
}

/// The head of nearly every structure.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Head {
    pub id: c_int,
    pub npar: c_int,
    pub par: *const f64,
}

/// A structure that is a head and a rest.
#[repr(C)]
struct With<T>(Head, T);

#[repr(C)]
struct SingleRest([c_int; 3], *const c_char);

/// Two whole numbers and two others: DIFF and CURVE.
#[repr(C)]
struct PairsRest([c_int; 2], [f64; 2]);

#[repr(C)]
struct MotionRest {
    joint: c_int,
    kind: *const c_char,
    markers: [c_int; 2],
    which: [u8; 2],
    level: *const c_char,
}

#[repr(C)]
struct RequestRest(*const c_char, [*const c_char; 8]);

#[repr(C)]
struct SensorRest([f64; 2], [u8; 2]);

#[repr(C)]
struct SystemRest([c_int; 13], f64);

#[repr(C)]
struct CouplerRest(c_int, [c_int; 3], [u8; 3]);

/// A contact, and the numbers of USER behind it.
#[repr(C)]
struct ContactWhole {
    id: c_int,
    counts: [c_int; 2],
    geometry: [*const c_int; 2],
    flips: [*const c_int; 2],
    npar: c_int,
    par: *const f64,
}

/// Members of the structure of a GSE, as C and Python have them.
const SYSTEM: [&str; 13] = [
    "NI",
    "NO",
    "U",
    "Y",
    "NS",
    "X",
    "IC",
    "STATIC_HOLD",
    "IMPLICIT",
    "STATICS_ONLY",
    "ND",
    "XD",
    "ICD",
];

impl Structure {
    /// Calls a function with the address of the structure as C has it.
    pub fn lend(&self, head: Head, call: impl FnOnce(*const c_void)) {
        fn lent<T>(structure: &T) -> *const c_void {
            std::ptr::from_ref(structure).cast()
        }
        match self {
            Structure::Single(numbers, kind) => {
                call(lent(&With(head, SingleRest(*numbers, kind.as_ptr()))));
            }
            Structure::Vector(numbers) | Structure::General(numbers) => {
                call(lent(&With(head, *numbers)));
            }
            Structure::Variable(ic) => call(lent(&With(head, *ic))),
            Structure::Differential(flags, numbers) | Structure::Curve(flags, numbers) => {
                call(lent(&With(head, PairsRest(*flags, *numbers))));
            }
            Structure::Motion {
                joint,
                kind,
                markers,
                which,
                level,
            } => {
                let rest = MotionRest {
                    joint: *joint,
                    kind: kind.as_ptr(),
                    markers: *markers,
                    which: *which,
                    level: level.as_ptr(),
                };
                call(lent(&With(head, rest)));
            }
            Structure::Request(comment, title) => {
                let title = std::array::from_fn(|k| title[k].as_ptr());
                call(lent(&With(head, RequestRest(comment.as_ptr(), title))));
            }
            Structure::Sensor(numbers, logic) => {
                call(lent(&With(head, SensorRest(*numbers, *logic))));
            }
            Structure::System(numbers) => call(lent(&With(head, SystemRest(*numbers, 0.0)))),
            Structure::Coupler(n, joints, types) => {
                call(lent(&With(head, CouplerRest(*n, *joints, *types))));
            }
            Structure::Contact(geometry, flips) => {
                let whole = ContactWhole {
                    id: head.id,
                    counts: [0, 1].map(|k| geometry[k].len() as c_int),
                    geometry: [0, 1].map(|k| geometry[k].as_ptr()),
                    flips: [0, 1].map(|k| flips[k].as_ptr()),
                    npar: head.npar,
                    par: head.par,
                };
                call(lent(&whole));
            }
        }
    }

    /// Returns the members beside ID and PAR by the names that C has for them.
    pub fn members(&self) -> Map<String, Value> {
        let text = |s: &CStr| s.to_string_lossy().into_owned();
        let letters = |s: &[u8]| {
            let all = s.iter().take_while(|c| **c != 0);
            all.map(|c| char::from(*c)).collect::<String>()
        };
        let members = match self {
            Structure::Single([i, j, alone], kind) => {
                json!({"I": i, "J": j, "ACTION_ONLY": alone, "Type": text(kind)})
            }
            Structure::Vector([i, jfloat, rm]) | Structure::General([i, rm, jfloat]) => {
                json!({"I": i, "JFLOAT": jfloat, "RM": rm})
            }
            Structure::Variable(ic) => json!({ "IC": ic }),
            Structure::Differential([hold, implicit], [value, rate]) => {
                json!({"STATIC_HOLD": hold, "IMPLICIT": implicit, "IC_R1": value, "IC_R2": rate})
            }
            Structure::Motion {
                joint,
                kind,
                markers: [i, j],
                which,
                level,
            } => {
                json!({"JOINT": joint, "Type": text(kind), "I": i, "J": j, "Which": letters(which), "DVA": text(level)})
            }
            Structure::Request(comment, title) => {
                let title: Vec<String> = title.iter().map(|t| text(t)).collect();
                json!({"COMMENT": text(comment), "TITLE": title})
            }
            Structure::Sensor([value, error], logic) => {
                json!({"VALUE": value, "Error": error, "Logic": letters(logic)})
            }
            Structure::System(numbers) => {
                let all = SYSTEM.iter().zip(numbers);
                all.map(|(name, n)| ((*name).to_owned(), json!(n)))
                    .collect()
            }
            Structure::Coupler(n, joints, types) => {
                let joints = joints.iter().take(*n as usize).collect::<Vec<_>>();
                json!({"NJOINT": n, "JOINTS": joints, "TYPE": letters(types)})
            }
            Structure::Curve([closed, order], [low, high]) => {
                json!({"CLOSED": closed, "ORDER": order, "MINPAR": low, "MAXPAR": high})
            }
            Structure::Contact(geometry, flips) => {
                json!({"IGEOM": geometry[0], "JGEOM": geometry[1], "IFLIP_GEOM": flips[0], "JFLIP_GEOM": flips[1]})
            }
        };
        match members {
            Value::Object(members) => members,
            _ => Map::new(),
        }
    }
}
