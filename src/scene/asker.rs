//! Whoever asks the equations for a value: functions of the model, columns, elements.

use super::reads::input_name;
use super::unknown::DifferentialId;
use crate::diagnostic::Subject;
use crate::expr::measures::Measure;
use crate::expr::program::Input;
use crate::model::ElementId;
use std::fmt;
use std::sync::Arc;

/// Whoever asks for a value. Prints as users know it: `SFORCE/3 FUNCTION`, `LSE/1 state 2`.
#[derive(Clone, Debug, PartialEq)]
pub enum Asker {
    /// a function of an element
    Function(ElementId, Part),
    /// an element
    Element(ElementId),
    /// an expression asked for beside those of the model, by its text
    Column(Arc<str>),
    /// the equations themselves, for a measure
    Measure(Measure),
    /// an algebraic loop through an input
    Input(Input),
    /// an algebraic loop through an implicit equation
    Equation(DifferentialId),
    /// DIF1 of the DIFF with this number
    Rate(u32),
}

/// The function of an element that asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// that of an argument
    Argument(&'static str),
    /// the rate of a state, from 1
    State(usize),
    /// an output, from 1
    Output(usize),
    /// the only output
    OnlyOutput,
    /// the next value of a discrete state, from 1
    DiscreteState(usize),
}

impl Asker {
    /// Creates the name of the function of an argument.
    pub fn argument(element: ElementId, argument: &'static str) -> Self {
        Self::Function(element, Part::Argument(argument))
    }

    /// Returns the element that asks, itself or by a function; `None` for others.
    pub fn element(&self) -> Option<ElementId> {
        match self {
            Self::Element(element) | Self::Function(element, _) => Some(*element),
            Self::Column(_)
            | Self::Measure(_)
            | Self::Input(_)
            | Self::Equation(_)
            | Self::Rate(_) => None,
        }
    }

    /// Returns the element whose function asks; `None` for others.
    pub fn owner(&self) -> Option<ElementId> {
        match self {
            Self::Function(element, _) => Some(*element),
            Self::Element(_)
            | Self::Column(_)
            | Self::Measure(_)
            | Self::Input(_)
            | Self::Equation(_)
            | Self::Rate(_) => None,
        }
    }
}

impl From<ElementId> for Asker {
    fn from(element: ElementId) -> Self {
        Self::Element(element)
    }
}

impl fmt::Display for Asker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Subject::from(self).fmt(f)
    }
}

impl From<&Asker> for Subject {
    fn from(asker: &Asker) -> Self {
        match asker {
            Asker::Function(element, part) => Self::part_of(*element, part.to_string()),
            Asker::Element(element) => (*element).into(),
            Asker::Column(text) => (**text).into(),
            Asker::Measure(measure) => measure.name().into(),
            Asker::Input(input) => input_name(*input).into(),
            Asker::Equation(id) => (*id).into(),
            Asker::Rate(number) => format!("DIF1({number})").into(),
        }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Argument(argument) => f.write_str(argument),
            Self::State(number) => write!(f, "state {number}"),
            Self::Output(number) => write!(f, "output {number}"),
            Self::OnlyOutput => f.write_str("output"),
            Self::DiscreteState(number) => write!(f, "discrete state {number}"),
        }
    }
}
