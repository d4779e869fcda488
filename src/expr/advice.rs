//! From a mistake in an expression to what is said about it.

use super::ast::Dialect;
use super::token::Fault;
use crate::diagnostic::{Diagnostic, Span};

/// The diagnostic for the first mistake of a text.
pub(crate) fn explain(text: &str, _dialect: Dialect, fault: &Fault) -> Diagnostic {
    at(text, fault.code, "", fault.span)
}

/// An error at a place of an expression, whose columns count all characters of the text.
pub(crate) fn at(
    text: &str,
    code: &'static str,
    message: impl Into<String>,
    span: Span,
) -> Diagnostic {
    let mut said = Diagnostic::error(code, message).at(text, span);
    let before = text.get(..span.start).unwrap_or(text);
    said.line = 1;
    said.column = before.chars().count() + 1;
    said
}
