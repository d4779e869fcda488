//! Signatures: the arguments of a function with their kinds, ranges and defaults.
//!
//! The tables of measures and interpolations are written in these terms. The parser checks calls
//! against them; the help prints them.

use std::fmt;

/// The kind of element that an identifier names. Identifiers are counted and looked up per kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Element {
    /// MARKER
    Marker,
    /// BEAM
    Beam,
    /// BUSHING
    Bushing,
    /// FIELD
    Field,
    /// SPRINGDAMPER
    SpringDamper,
    /// SFORCE
    Sforce,
    /// GFORCE
    Gforce,
    /// VFORCE
    Vforce,
    /// VTORQUE
    Vtorque,
    /// PTCV
    Ptcv,
    /// CVCV
    Cvcv,
    /// JOINT
    Joint,
    /// JPRIM
    Jprim,
    /// MOTION
    Motion,
    /// CONTACT
    Contact,
    /// NFORCE
    Nforce,
    /// FRICTION
    Friction,
    /// VARIABLE
    Variable,
    /// ARRAY
    Array,
    /// DIFF
    Diff,
    /// PINPUT
    Pinput,
    /// POUTPUT
    Poutput,
    /// SENSOR
    Sensor,
    /// SPLINE
    Spline,
    /// CURVE
    Curve,
}

/// The kind of an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// any expression
    Number,
    /// the identifier of an element: an unsigned integer literal from 1; from 0 where 0 stands for
    /// ground
    Identifier {
        /// kind of the element
        element: Element,
        /// whether 0 is allowed
        zero: bool,
    },
    /// an unsigned integer literal from this set
    Selector(Choice),
}

/// The integers that a selector may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// from the first to the last, both included
    Range(u32, u32),
    /// one of these
    OneOf(&'static [u32]),
    /// one or more
    Positive,
}

/// The largest identifier; I-DEAS asks for integers below 2³¹ − 1.
pub const LARGEST_IDENTIFIER: u32 = (1 << 31) - 2;

impl Choice {
    /// Returns whether this integer is one of them.
    pub fn allows(self, n: u32) -> bool {
        match self {
            Choice::Range(first, last) => (first..=last).contains(&n),
            Choice::OneOf(list) => list.contains(&n),
            Choice::Positive => (1..=LARGEST_IDENTIFIER).contains(&n),
        }
    }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Choice::Range(first, last) => write!(f, "{first} to {last}"),
            Choice::OneOf(list) => {
                let words: Vec<String> = list.iter().map(u32::to_string).collect();
                match &words[..] {
                    [first @ .., before, last] => {
                        first.iter().try_for_each(|word| write!(f, "{word}, "))?;
                        write!(f, "{before} or {last}")
                    }
                    _ => f.write_str(&words.concat()),
                }
            }
            Choice::Positive => f.write_str("1 or more"),
        }
    }
}

/// An argument of a signature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Argument {
    /// name in help and messages
    pub name: &'static str,
    /// kind of the argument
    pub kind: Kind,
    /// default in words, if it may be left out
    pub default: Option<&'static str>,
    /// its part in the value, for a reader
    pub meaning: &'static str,
}

impl Argument {
    /// Describes an expression.
    pub const fn number(name: &'static str) -> Self {
        Self {
            name,
            kind: Kind::Number,
            default: None,
            meaning: "",
        }
    }
    /// Describes an identifier from 1.
    pub const fn identifier(name: &'static str, element: Element) -> Self {
        Self {
            name,
            kind: Kind::Identifier {
                element,
                zero: false,
            },
            default: None,
            meaning: "",
        }
    }
    /// Describes an identifier from 0.
    pub const fn identifier_or_zero(name: &'static str, element: Element) -> Self {
        Self {
            name,
            kind: Kind::Identifier {
                element,
                zero: true,
            },
            default: None,
            meaning: "",
        }
    }
    /// Describes an integer from a set.
    pub const fn selector(name: &'static str, choice: Choice) -> Self {
        Self {
            name,
            kind: Kind::Selector(choice),
            default: None,
            meaning: "",
        }
    }
    /// Sets the argument's part in the value, for a reader.
    pub const fn meaning(self, meaning: &'static str) -> Self {
        Self { meaning, ..self }
    }
    /// Makes the argument optional, with a default in words.
    pub const fn or(self, default: &'static str) -> Self {
        Self {
            default: Some(default),
            ..self
        }
    }
}

/// Returns the fewest and the most arguments of a signature.
pub fn arity(arguments: &[Argument]) -> (usize, usize) {
    (
        arguments.iter().filter(|a| a.default.is_none()).count(),
        arguments.len(),
    )
}

/// Prints the signature: `NAME(i[, j][, k])`.
pub fn signature(name: &str, arguments: &[Argument]) -> String {
    let mut text = format!("{name}(");
    for (k, a) in arguments.iter().enumerate() {
        let comma = if k == 0 { "" } else { ", " };
        match a.default {
            None => text.extend([comma, a.name]),
            Some(_) => text.extend(["[", comma, a.name, "]"]),
        }
    }
    text.push(')');
    text
}
