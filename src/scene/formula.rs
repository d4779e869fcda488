//! Expressions of the model as programs.

use crate::diagnostic::Diagnostic;
use crate::expr::program::Program;
use crate::model::Model;

/// Compiles the text of an expression.
pub(super) fn compile(text: &str, _model: &Model) -> Result<Program, Vec<Diagnostic>> {
    Err(vec![Diagnostic::error("not_ready", format!("expression {text}"))])
}
