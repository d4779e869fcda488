//! From a mistake in an expression to what is said about it.

use super::ast::Dialect;
use super::token::Fault;
use crate::diagnostic::Diagnostic;

/// The diagnostic for the first mistake of a text.
pub(crate) fn explain(text: &str, _dialect: Dialect, fault: &Fault) -> Diagnostic {
    let mut said = Diagnostic::error(fault.code, "").at(text, fault.span);
    said.line = 1;
    said.column = text[..fault.span.start].chars().count() + 1;
    said
}
