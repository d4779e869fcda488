//! The error of the library: everything that is wrong with what a caller gave, at once.

use super::{Cause, Diagnostic};
use std::fmt;
use std::sync::Arc;

/// Everything that was wrong with what a caller gave: one [`Diagnostic`] or more.
///
/// All doors of the library fail with this type, and [`Diagnostic`]s become it, so that `?` works
/// throughout. It prints every mistake on lines of its own, with place, element, reason and advice;
/// `{:?}` prints the same, for programs whose `main` returns it. A failure of the operating system
/// that was met on the way is its [source](std::error::Error::source).
///
/// ```
/// # #[cfg(feature = "solver")] {
/// use cognate::Model;
/// let error = Model::from_text("t\nPART/1, GROUND\nJOINT/3, FIXED, I=12, J=11\nEND\n").unwrap_err();
/// let found: Vec<_> = error.diagnostics().iter().map(|d| (d.code, d.line, d.column)).collect();
/// assert_eq!(found, [("unknown_element", 3, 17), ("unknown_element", 3, 23)]);
/// assert_eq!(error.first().element.as_deref(), Some("JOINT/3"));
/// # }
/// ```
#[derive(Clone)]
pub struct Error(Box<Inner>);

#[derive(Clone)]
struct Inner {
    /// at least one
    diagnostics: Vec<Diagnostic>,
    source: Option<Arc<std::io::Error>>,
}

impl Error {
    /// Returns all mistakes, in the order in which they were found; there is at least one.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.0.diagnostics
    }

    /// Returns the first mistake.
    pub fn first(&self) -> &Diagnostic {
        &self.0.diagnostics[0]
    }

    /// Returns the code of the first mistake, which `cognate explain CODE` explains.
    pub fn code(&self) -> &'static str {
        self.first().code
    }

    /// Returns whether some mistake has this cause.
    pub fn is(&self, cause: Cause) -> bool {
        self.diagnostics().iter().any(|d| d.is(cause))
    }

    /// Takes all mistakes out.
    pub fn into_diagnostics(self) -> Vec<Diagnostic> {
        self.0.diagnostics
    }

    /// Takes the first mistake out.
    pub fn into_first(mut self) -> Diagnostic {
        self.0.diagnostics.swap_remove(0)
    }

    /// Adds the failure of the operating system that it was made of.
    pub fn with_source(mut self, source: std::io::Error) -> Self {
        self.0.source = Some(Arc::new(source));
        self
    }

    /// Changes every mistake, to add a place or advice.
    pub fn map(mut self, change: impl FnMut(Diagnostic) -> Diagnostic) -> Self {
        let all = std::mem::take(&mut self.0.diagnostics);
        self.0.diagnostics = all.into_iter().map(change).collect();
        self
    }
}

impl From<Diagnostic> for Error {
    fn from(d: Diagnostic) -> Self {
        Self::from(vec![d])
    }
}

impl From<Vec<Diagnostic>> for Error {
    /// Takes all mistakes; none at all is our mistake, and becomes one that says so.
    fn from(mut diagnostics: Vec<Diagnostic>) -> Self {
        if diagnostics.is_empty() {
            let what = "something was refused, and no reason was given";
            diagnostics.push(Diagnostic::error("bug", what));
        }
        Self(Box::new(Inner {
            diagnostics,
            source: None,
        }))
    }
}

impl From<Error> for Vec<Diagnostic> {
    fn from(error: Error) -> Self {
        error.into_diagnostics()
    }
}

impl IntoIterator for Error {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.into_diagnostics().into_iter()
    }
}

/// Errors are equal that say the same.
impl PartialEq for Error {
    fn eq(&self, other: &Self) -> bool {
        self.diagnostics() == other.diagnostics()
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, d) in self.diagnostics().iter().enumerate() {
            if k > 0 {
                writeln!(f)?;
            }
            write!(f, "{d}")?;
        }
        Ok(())
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        let source = self.0.source.as_deref()?;
        Some(source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_prints_all_its_mistakes_and_says_what_the_system_said() {
        let two = ["one", "two"].map(|what| Diagnostic::error("domain", what));
        let error = Error::from(two.to_vec());
        let text = "error[domain]: one\nerror[domain]: two";
        assert_eq!(
            (error.to_string(), format!("{error:?}")),
            (text.into(), text.into())
        );
        assert!(std::error::Error::source(&error).is_none());
        let system = std::io::Error::other("no disk");
        let error: Box<dyn std::error::Error> = Box::new(error.with_source(system));
        assert_eq!(
            error.source().map(ToString::to_string).as_deref(),
            Some("no disk")
        );
    }

    #[test]
    fn an_error_always_has_a_mistake() {
        assert_eq!(Error::from(Vec::new()).code(), "bug");
    }
}
