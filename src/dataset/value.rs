//! Values of arguments: their kinds, and how each kind sits in a field of the Model.
//!
//! A [`Value`] is the one form between text and Model: the reader makes it from tokens, the table
//! puts it into a field ([`Field::put`]), takes it out again ([`Field::written`]), and the writer
//! prints it.

use crate::model::{Formula, Level};
use std::fmt::Write;

/// A number as written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// the number before the suffix
    pub literal: f64,
    /// whether the suffix D followed
    pub degrees: bool,
}

impl Number {
    /// A number without suffix.
    pub fn plain(literal: f64) -> Self {
        Self {
            literal,
            degrees: false,
        }
    }

    /// An angle given in radians: with the suffix D where that says the same in fewer characters.
    pub fn angle(radians: f64) -> Self {
        let literal = (radians.to_degrees() * 1e9).round() / 1e9;
        let degrees = Self {
            literal,
            degrees: true,
        };
        let shorter = degrees.to_string().len() <= Self::plain(radians).to_string().len();
        if radians != 0.0 && degrees.value() == radians && shorter {
            degrees
        } else {
            Self::plain(radians)
        }
    }

    /// Its value, radians for degrees.
    pub fn value(self) -> f64 {
        if self.degrees {
            self.literal * (std::f64::consts::PI / 180.0)
        } else {
            self.literal
        }
    }

    /// Reads `-1.5E-3`, `90D`; `None` when the text is not a number.
    pub fn parse(text: &str) -> Option<Self> {
        let bytes = text.as_bytes();
        let (digits, degrees) = match bytes {
            [rest @ .., b'D' | b'd'] => (rest, true),
            _ => (bytes, false),
        };
        let last = digits.last()?;
        let numeric = |b: &u8| b.is_ascii_digit() || matches!(b, b'.' | b'+' | b'-' | b'e' | b'E');
        if !digits.iter().all(numeric) || !(last.is_ascii_digit() || *last == b'.') {
            return None;
        }
        let literal: f64 = std::str::from_utf8(digits).ok()?.parse().ok()?;
        literal.is_finite().then_some(Self { literal, degrees })
    }
}

/// The shortest text that reads back to the same number.
impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let x = self.literal;
        let mut plain = format!("{x}");
        if x != 0.0 && !(1e-4..1e15).contains(&x.abs()) {
            let scientific = format!("{x:E}");
            if scientific.len() < plain.len() {
                plain = scientific;
            }
        }
        f.write_str(&plain)?;
        if self.degrees {
            f.write_char('D')
        } else {
            Ok(())
        }
    }
}

/// A value read from a file, or to be written to one.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// the bare keyword
    Flag,
    /// a number of an element, or a count
    Id(u32),
    /// several
    Ids(Vec<u32>),
    /// a real number
    Real(Number),
    /// several
    Reals(Vec<Number>),
    /// one of a few words, in full
    Word(String),
    /// several, between colons
    Words(Vec<String>),
    /// free text
    Text(String),
    /// several texts in double quotes (written without them here)
    Texts(Vec<String>),
    /// a FUNCTION
    Formula(Formula),
    /// whatever was written, for arguments that are only kept
    Raw(String),
}

/// The value on one line, as it stands after `=`; empty for a bare keyword.
impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        fn joined<T: ToString>(all: &[T], by: &str) -> String {
            all.iter().map(T::to_string).collect::<Vec<_>>().join(by)
        }
        match self {
            Value::Flag => Ok(()),
            Value::Id(n) => write!(f, "{n}"),
            Value::Ids(all) => f.write_str(&joined(all, ", ")),
            Value::Real(x) => write!(f, "{x}"),
            Value::Reals(all) => f.write_str(&joined(all, ", ")),
            Value::Word(word) => f.write_str(word),
            Value::Words(all) => f.write_str(&all.join(":")),
            Value::Text(text) | Value::Raw(text) => f.write_str(text),
            Value::Texts(all) => {
                let quoted: Vec<String> = all.iter().map(|t| format!("\"{t}\"")).collect();
                f.write_str(&quoted.join(", "))
            }
            Value::Formula(Formula::Expression { text, .. }) => f.write_str(text),
            Value::Formula(Formula::User { constants, .. }) => {
                let all: Vec<Number> = constants.iter().copied().map(Number::plain).collect();
                write!(f, "USER({})", joined(&all, ", "))
            }
        }
    }
}

/// The kind of value that an argument accepts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// nothing: the keyword stands alone
    Flag,
    /// the number of an element, or a count
    Id,
    /// several
    Ids {
        /// at least so many
        min: usize,
        /// at most
        max: usize,
    },
    /// a real number
    Real {
        /// it is an angle, for which the suffix D is meant
        angle: bool,
    },
    /// several
    Reals {
        /// at least so many
        min: usize,
        /// at most
        max: usize,
        /// they are angles
        angle: bool,
    },
    /// one of these; any word when empty
    Word(&'static [&'static str]),
    /// several, between colons; any words when empty
    Words(&'static [&'static str]),
    /// free text up to the next argument
    Text,
    /// several texts in double quotes
    Texts,
    /// an expression, or USER
    Formula,
    /// whatever is written, for arguments that are only kept
    Raw,
}

impl Kind {
    /// Returns its name in the manual as data.
    pub fn name(&self) -> &'static str {
        match self {
            Kind::Flag => "flag",
            Kind::Id => "integer",
            Kind::Ids { .. } => "integers",
            Kind::Real { angle: false } => "real",
            Kind::Real { angle: true } => "angle",
            Kind::Reals { angle: false, .. } => "reals",
            Kind::Reals { angle: true, .. } => "angles",
            Kind::Word(_) => "word",
            Kind::Words(_) => "words",
            Kind::Text | Kind::Raw => "text",
            Kind::Texts => "texts",
            Kind::Formula => "expression",
        }
    }

    /// Returns its name in messages.
    pub fn describe(&self) -> String {
        let count = |min: usize, max: usize, what: &str| match (min, max) {
            (a, b) if a == b => format!("{a} {what}"),
            (0 | 1, usize::MAX) => format!("a list of {what}"),
            (a, usize::MAX) => format!("at least {a} {what}"),
            (a, b) => format!("{a} to {b} {what}"),
        };
        match self {
            Kind::Flag => "nothing".into(),
            Kind::Id => "a whole number".into(),
            Kind::Ids { min, max } => count(*min, *max, "whole numbers"),
            Kind::Real { angle: false } => "a number".into(),
            Kind::Real { angle: true } => "an angle (radians, or degrees with the suffix D)".into(),
            Kind::Reals { min, max, .. } => count(*min, *max, "numbers"),
            Kind::Word(words) if !words.is_empty() => format!("one of {}", words.join(", ")),
            Kind::Words(words) if !words.is_empty() => {
                format!("words between colons, of {}", words.join(", "))
            }
            Kind::Word(_) => "a word".into(),
            Kind::Words(_) => "words between colons".into(),
            Kind::Text | Kind::Raw => "a text".into(),
            Kind::Texts => "texts in double quotes".into(),
            Kind::Formula => "an expression".into(),
        }
    }
}

/// A field of the Model that an argument can fill.
///
/// `written` is `None` where nothing need be written: absent, or the documented default.
pub trait Field {
    /// what the argument accepts
    const KIND: Kind;
    /// fills the field; an error is a sentence
    fn put(&mut self, value: Value) -> Result<(), String>;
    /// the value to write
    fn written(&self) -> Option<Value>;
}

/// A value of another kind than the table asked for: cannot come from the reader.
fn mismatch() -> Result<(), String> {
    Err("the value has another form than this argument takes".into())
}

/// Fills the first places with the numbers of a value.
fn fill<T>(places: &mut [T], value: Value, made: fn(f64) -> T) -> Result<(), String> {
    let Value::Reals(xs) = value else {
        return mismatch();
    };
    for (place, x) in places.iter_mut().zip(xs) {
        *place = made(x.value());
    }
    Ok(())
}

impl Field for bool {
    const KIND: Kind = Kind::Flag;
    fn put(&mut self, _: Value) -> Result<(), String> {
        *self = true;
        Ok(())
    }
    fn written(&self) -> Option<Value> {
        self.then_some(Value::Flag)
    }
}

impl Field for u32 {
    const KIND: Kind = Kind::Id;
    fn put(&mut self, value: Value) -> Result<(), String> {
        let Value::Id(id) = value else {
            return mismatch();
        };
        *self = id;
        Ok(())
    }
    fn written(&self) -> Option<Value> {
        (*self != 0).then_some(Value::Id(*self))
    }
}

impl Field for usize {
    const KIND: Kind = Kind::Id;
    fn put(&mut self, value: Value) -> Result<(), String> {
        let Value::Id(id) = value else {
            return mismatch();
        };
        *self = id as usize;
        Ok(())
    }
    fn written(&self) -> Option<Value> {
        u32::try_from(*self).ok().filter(|&n| n != 0).map(Value::Id)
    }
}

impl Field for f64 {
    const KIND: Kind = Kind::Real { angle: false };
    fn put(&mut self, value: Value) -> Result<(), String> {
        let Value::Real(x) = value else {
            return mismatch();
        };
        *self = x.value();
        Ok(())
    }
    fn written(&self) -> Option<Value> {
        (self.to_bits() != 0).then(|| Value::Real(Number::plain(*self)))
    }
}

impl<const N: usize> Field for [f64; N] {
    const KIND: Kind = Kind::Reals {
        min: N,
        max: N,
        angle: false,
    };
    fn put(&mut self, value: Value) -> Result<(), String> {
        *self = [0.0; N];
        fill(self, value, |x| x)
    }
    fn written(&self) -> Option<Value> {
        self.iter().any(|x| x.to_bits() != 0).then(|| numbers(self))
    }
}

impl Field for [Option<f64>; 2] {
    const KIND: Kind = Kind::Reals {
        min: 1,
        max: 2,
        angle: false,
    };
    fn put(&mut self, value: Value) -> Result<(), String> {
        *self = [None; 2];
        fill(self, value, Some)
    }
    fn written(&self) -> Option<Value> {
        let second = self[1].map(Number::plain);
        let first = self[0].or(second.map(|_| 0.0)).map(Number::plain)?;
        Some(Value::Reals(
            [Some(first), second].into_iter().flatten().collect(),
        ))
    }
}

impl Field for Vec<f64> {
    const KIND: Kind = Kind::Reals {
        min: 1,
        max: usize::MAX,
        angle: false,
    };
    fn put(&mut self, value: Value) -> Result<(), String> {
        let Value::Reals(xs) = value else {
            return mismatch();
        };
        *self = xs.into_iter().map(Number::value).collect();
        Ok(())
    }
    fn written(&self) -> Option<Value> {
        (!self.is_empty()).then(|| numbers(self))
    }
}

impl Field for Vec<u32> {
    const KIND: Kind = Kind::Ids {
        min: 1,
        max: usize::MAX,
    };
    fn put(&mut self, value: Value) -> Result<(), String> {
        let Value::Ids(ids) = value else {
            return mismatch();
        };
        *self = ids;
        Ok(())
    }
    fn written(&self) -> Option<Value> {
        (!self.is_empty()).then(|| Value::Ids(self.clone()))
    }
}

impl Field for [u32; 2] {
    const KIND: Kind = Kind::Ids { min: 2, max: 2 };
    fn put(&mut self, value: Value) -> Result<(), String> {
        let Value::Ids(ids) = value else {
            return mismatch();
        };
        *self = ids
            .try_into()
            .map_err(|_| "two numbers are needed".to_owned())?;
        Ok(())
    }
    fn written(&self) -> Option<Value> {
        Some(Value::Ids(self.to_vec()))
    }
}

impl Field for String {
    const KIND: Kind = Kind::Text;
    fn put(&mut self, value: Value) -> Result<(), String> {
        *self = match value {
            Value::Text(t) | Value::Word(t) | Value::Raw(t) => t,
            Value::Words(w) => w.join(":"),
            Value::Texts(t) => t.join(", "),
            _ => return mismatch(),
        };
        Ok(())
    }
    fn written(&self) -> Option<Value> {
        (!self.is_empty()).then(|| Value::Text(self.clone()))
    }
}

impl Field for Vec<String> {
    const KIND: Kind = Kind::Texts;
    fn put(&mut self, value: Value) -> Result<(), String> {
        *self = match value {
            Value::Texts(t) | Value::Words(t) => t,
            _ => return mismatch(),
        };
        Ok(())
    }
    fn written(&self) -> Option<Value> {
        (!self.is_empty()).then(|| Value::Texts(self.clone()))
    }
}

impl Field for Formula {
    const KIND: Kind = Kind::Formula;
    fn put(&mut self, value: Value) -> Result<(), String> {
        let Value::Formula(mut formula) = value else {
            return mismatch();
        };
        // ROUTINE may come before FUNCTION.
        if let (Formula::User { routine, .. }, Formula::User { routine: old, .. }) =
            (&mut formula, &*self)
        {
            *routine = routine.take().or_else(|| old.clone());
        }
        *self = formula;
        Ok(())
    }
    fn written(&self) -> Option<Value> {
        match self {
            Formula::Expression { text, .. } if text.is_empty() => None,
            f => Some(Value::Formula(f.clone())),
        }
    }
}

/// A field that may be absent takes what the field itself takes, and is written whenever it is
/// there.
impl<F: Field + Default + Always> Field for Option<F> {
    const KIND: Kind = F::KIND;
    fn put(&mut self, value: Value) -> Result<(), String> {
        let mut field = self.take().unwrap_or_default();
        let done = field.put(value);
        *self = Some(field);
        done
    }
    fn written(&self) -> Option<Value> {
        self.as_ref().map(Always::always)
    }
}

/// The value of a field that is there, default or not.
pub trait Always {
    /// the value
    fn always(&self) -> Value;
}

impl Always for f64 {
    fn always(&self) -> Value {
        Value::Real(Number::plain(*self))
    }
}

impl Always for u32 {
    fn always(&self) -> Value {
        Value::Id(*self)
    }
}

impl Always for usize {
    fn always(&self) -> Value {
        Value::Id(u32::try_from(*self).unwrap_or(u32::MAX))
    }
}

impl Always for [f64; 3] {
    fn always(&self) -> Value {
        Value::Reals(self.iter().copied().map(Number::plain).collect())
    }
}

impl Always for String {
    fn always(&self) -> Value {
        Value::Text(self.clone())
    }
}

impl Always for Formula {
    fn always(&self) -> Value {
        Value::Formula(self.clone())
    }
}

/// The numbers as a value.
pub fn numbers(xs: &[f64]) -> Value {
    Value::Reals(xs.iter().copied().map(Number::plain).collect())
}

/// The angles as a value, in degrees where that is shorter.
pub fn angles(xs: &[f64]) -> Value {
    Value::Reals(xs.iter().copied().map(Number::angle).collect())
}

/// Fields that are one of a few words.
macro_rules! words {
    ($type:ty { $($variant:ident = $word:literal),+ $(,)? }) => {
        impl Field for $type {
            const KIND: Kind = Kind::Word(&[$($word),+]);
            fn put(&mut self, value: Value) -> Result<(), String> {
                let Value::Word(word) = value else {
                    return mismatch();
                };
                *self = match word.as_str() {
                    $($word => <$type>::$variant,)+
                    _ => return mismatch(),
                };
                Ok(())
            }
            fn written(&self) -> Option<Value> {
                let word = match self {
                    $(<$type>::$variant => $word,)+
                };
                (*self != <$type>::default()).then(|| Value::Word(word.into()))
            }
        }
    };
}

use crate::model::{BeamFormulation, CoulombFriction};
words!(BeamFormulation { Linear = "LINEAR", String = "STRING", Nonlinear = "NONLINEAR" });
words!(CoulombFriction { Off = "OFF", On = "ON", DynamicsOnly = "DYNAMICS_ONLY" });
words!(Level { Displacement = "DISPLACEMENT", Velocity = "VELOCITY", Acceleration = "ACCELERATION" });
