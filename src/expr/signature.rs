//! What a function takes: the arguments of a call with their kinds, ranges and defaults.
//!
//! The rows of the measures and of the interpolations are written in these terms. The parser checks calls against them; the
//! help prints them.

use std::fmt;

/// What kind of element an identifier names. Identifiers are counted and looked up per kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)]
#[rustfmt::skip]
pub enum Element {
    Marker, Beam, Bushing, Field, SpringDamper, Sforce, Gforce, Vforce, Vtorque, Ptcv, Cvcv, Joint, Jprim, Motion, Contact,
    Nforce, Friction, Variable, Array, Diff, Pinput, Poutput, Sensor, Spline, Curve,
}

/// What may stand as an argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// any expression
    Number,
    /// the identifier of an element: an unsigned integer literal from 1; from 0 where 0 stands for ground
    Identifier {
        /// what it identifies
        element: Element,
        /// whether 0 is allowed
        zero: bool,
    },
    /// an unsigned integer literal from this set
    Selector(Choice),
}

/// The integers a selector may have.
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
    /// Whether this integer may stand here.
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
                f.write_str(&words.join(" or "))
            }
            Choice::Positive => f.write_str("1 or more"),
        }
    }
}

/// One argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Argument {
    /// as it is called in help and messages
    pub name: &'static str,
    /// what may stand there
    pub kind: Kind,
    /// whether it may be left out; what it then is, for a reader
    pub default: Option<&'static str>,
}

impl Argument {
    /// An expression.
    pub const fn number(name: &'static str) -> Self {
        Self {
            name,
            kind: Kind::Number,
            default: None,
        }
    }
    /// An identifier from 1.
    pub const fn identifier(name: &'static str, element: Element) -> Self {
        Self {
            name,
            kind: Kind::Identifier {
                element,
                zero: false,
            },
            default: None,
        }
    }
    /// An identifier from 0.
    pub const fn identifier_or_zero(name: &'static str, element: Element) -> Self {
        Self {
            name,
            kind: Kind::Identifier {
                element,
                zero: true,
            },
            default: None,
        }
    }
    /// An integer from a set.
    pub const fn selector(name: &'static str, choice: Choice) -> Self {
        Self {
            name,
            kind: Kind::Selector(choice),
            default: None,
        }
    }
    /// The same, but it may be left out.
    pub const fn or(self, default: &'static str) -> Self {
        Self {
            default: Some(default),
            ..self
        }
    }
}

/// Fewest and most arguments of a signature.
pub fn arity(arguments: &[Argument]) -> (usize, usize) {
    (
        arguments.iter().filter(|a| a.default.is_none()).count(),
        arguments.len(),
    )
}

/// `NAME(i[, j][, k])`
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
