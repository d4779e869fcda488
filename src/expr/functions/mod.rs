//! Functions of numbers: STEP, IMPACT, POLY, SIN … The properties of a row of their table.
//!
//! The rows themselves stand in `table.rs`; longer formulas in a file per kind (`step.rs`,
//! `contact.rs`, `series.rs`). Adding a function is adding one row: parsing, arity, help,
//! compilation, derivatives and batches follow from it.

pub(crate) mod contact;
pub(crate) mod prepared;
mod series;
pub(crate) mod step;
mod table;

pub use table::Function;

use super::ast::Dialect;
use super::signature::{self, Argument};
use std::ops::RangeInclusive;

/// The group of a function, in help and documentation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// the FORTRAN 77 intrinsics of direct-entry functions
    Intrinsic,
    /// the general utility functions of direct-entry functions
    Utility,
    /// the functions of the I-DEAS expression language (degrees)
    Expression,
}

impl Family {
    /// Returns the heading for help.
    pub fn title(self) -> &'static str {
        match self {
            Family::Intrinsic => "FORTRAN 77 intrinsics",
            Family::Utility => "General utility functions",
            Family::Expression => "Expression functions (degrees)",
        }
    }
}

/// The smoothness of a function where it is defined; the worse is the smaller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Continuity {
    /// the value may jump
    Jump,
    /// the value is continuous, the slope may jump
    C0,
    /// the slope is continuous, the curvature may jump
    C1,
    /// the curvature is continuous, a higher derivative may jump
    C2,
    /// all derivatives are continuous
    Smooth,
}

impl Continuity {
    /// Describes the class in words: `C1: the slope is continuous, the curvature is not`.
    pub fn describe(self) -> &'static str {
        match self {
            Continuity::Jump => "none: the value jumps",
            Continuity::C0 => "C0: the value is continuous, the slope is not",
            Continuity::C1 => "C1: the slope is continuous, the curvature is not",
            Continuity::C2 => "C2: the curvature is continuous, a higher derivative is not",
            Continuity::Smooth => "smooth: all derivatives are continuous",
        }
    }
}

/// An example of a row: a source text without variables, and its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Example {
    /// the expression
    pub source: &'static str,
    /// its value
    pub value: f64,
}

/// Arguments behind those with names of their own, as many as there are coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Further {
    /// common name: `a` for a0, a1 …
    pub name: &'static str,
    /// their part in the value, for a reader
    pub meaning: &'static str,
    /// fewest
    pub least: usize,
    /// most
    pub most: usize,
}

/// A row of the table: everything about one function apart from its body.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// the function itself
    pub function: Function,
    /// name as users write it
    pub name: &'static str,
    /// language it belongs to
    pub dialect: Dialect,
    /// group in help
    pub family: Family,
    /// parameters that have a name
    pub parameters: &'static [Argument],
    /// further arguments of the last kind
    pub further: Option<Further>,
    /// smoothness of the function in its arguments
    pub continuity: Continuity,
    /// one sentence that describes it, then remarks
    pub doc: &'static str,
    /// equation, in plain text
    pub equation: &'static str,
    /// examples; each is a test
    pub examples: &'static [Example],
}

impl Row {
    /// Returns the fewest and the most arguments.
    pub fn arity(&self) -> RangeInclusive<usize> {
        let (required, named) = signature::arity(self.parameters);
        let (least, most) = self
            .further
            .map_or((0, 0), |further| (further.least, further.most));
        required + least..=named + most
    }

    /// Prints the signature as help shows it: `STEP(x, x0, h0, x1, h1)`, `MAX(a, b[, …])`.
    pub fn signature(&self) -> String {
        let mut text = format!("{}(", self.name);
        for (k, parameter) in self.parameters.iter().enumerate() {
            let comma = if k == 0 { "" } else { ", " };
            if parameter.default.is_some() {
                text += &format!("[{comma}{}]", parameter.name);
            } else {
                text += &format!("{comma}{}", parameter.name);
            }
        }
        match self.further {
            Some(Further { least: 0, .. }) => text += "[, …]",
            Some(Further { name, most, .. }) => {
                text += &format!(", {name}0[, {name}1, …, {name}{}]", most - 1)
            }
            None => {}
        }
        text + ")"
    }
}

impl Function {
    /// Finds the function of this name in this language; upper and lower case are the same.
    pub fn from_name(name: &str, dialect: Dialect) -> Option<Function> {
        Self::ALL
            .iter()
            .copied()
            .find(|f| f.row().dialect == dialect && f.name().eq_ignore_ascii_case(name))
    }
    /// Returns the name as users write it.
    pub fn name(self) -> &'static str {
        self.row().name
    }
    /// Returns the fewest and the most arguments.
    pub fn arity(self) -> RangeInclusive<usize> {
        self.row().arity()
    }
    /// Prints the signature as help shows it.
    pub fn signature(self) -> String {
        self.row().signature()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_within_a_dialect() {
        for &f in Function::ALL {
            assert_eq!(
                Function::from_name(f.name(), f.row().dialect),
                Some(f),
                "{}",
                f.name()
            );
            assert_eq!(
                Function::from_name(&f.name().to_lowercase(), f.row().dialect),
                Some(f)
            );
        }
        assert_eq!(Function::from_name("LN", Dialect::Function), None);
        assert_eq!(Function::from_name("STEP", Dialect::Expression), None);
    }

    #[test]
    fn signatures_say_what_may_be_left_out() {
        assert_eq!(Function::Step.signature(), "STEP(x, x0, h0, x1, h1)");
        assert_eq!(Function::Step.arity(), 5..=5);
        assert_eq!(Function::Max.arity(), 2..=usize::MAX);
        assert_eq!(Function::Max.signature(), "MAX(a, b[, …])");
        assert_eq!(Function::Poly.arity(), 3..=33);
        assert_eq!(Function::Poly.signature(), "POLY(x, x0, a0[, a1, …, a30])");
        assert_eq!(Function::Forcos.arity(), 4..=34);
        assert_eq!(Function::Delay.arity(), 3..=4);
    }

    #[test]
    fn rows_reject_a_wrong_number_of_arguments() {
        for &f in Function::ALL {
            assert!(f.eval::<f64>(&[]).is_nan(), "{}", f.name());
        }
    }

    #[test]
    fn forbidden_arguments_give_no_number() {
        assert!(Function::Step.eval(&[0.0, 1.0, 0.0, 1.0, 1.0]).is_nan());
        assert_eq!(
            Function::Step.violation(&[f64::NAN, 1.0, 0.0, 1.0, 1.0]),
            Some("x0 must be less than x1")
        );
        assert_eq!(
            Function::Step.violation(&[0.0, f64::NAN, 0.0, 1.0, 1.0]),
            None
        );
        assert!(
            Function::Impact
                .eval(&[0.5, 0.0, 1.0, -100.0, 1.5, 25.0, 0.1])
                .is_nan()
        );
        assert!(Function::Atan2.eval(&[0.0, -0.0]).is_nan());
        assert_eq!(Function::Atan2.eval(&[-0.0, -1.0]), std::f64::consts::PI);
    }
}
