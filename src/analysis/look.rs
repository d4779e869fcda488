//! A look on the way: long phases of setting up ask between their pieces whether to go on.

use crate::diagnostic::Diagnostic;

/// Asked whether to go on; the answer to a caller who does not want that is an error.
pub(in crate::analysis) type Look<'a> = &'a mut dyn FnMut() -> Result<(), Vec<Diagnostic>>;
