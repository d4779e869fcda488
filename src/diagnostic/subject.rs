//! The thing that a message is about: an element of a model, or a row, a function, a state of it.

use std::fmt;

/// An element and, where a message is about less than all of it, the part of it.
///
/// Printed as `JOINT/7 Zi.Xj`; with the name that its file gives it as `JOINT/7 'hinge' Zi.Xj`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Subject {
    /// the element as messages name it: `JOINT/7`; a statement without a number, `INTEGRATOR`; or
    /// the text of a column
    pub element: String,
    /// the row, function or state of it: `Zi.Xj`, `FUNCTION`, `state 2`
    pub part: Option<String>,
}

impl Subject {
    /// Creates the subject that is `part` of `element`.
    pub fn part_of(element: impl Into<String>, part: impl Into<String>) -> Self {
        Self {
            element: element.into(),
            part: Some(part.into()),
        }
    }

    /// Returns it with the name that its file gives the element.
    pub fn named(&self, name: Option<&str>) -> String {
        let Self { element, part } = self;
        let name = name.map_or_else(String::new, |name| format!(" '{name}'"));
        let part = part.as_ref().map_or_else(String::new, |p| format!(" {p}"));
        format!("{element}{name}{part}")
    }
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.named(None))
    }
}

impl From<String> for Subject {
    fn from(element: String) -> Self {
        Self {
            element,
            part: None,
        }
    }
}

impl From<&str> for Subject {
    fn from(element: &str) -> Self {
        element.to_owned().into()
    }
}
