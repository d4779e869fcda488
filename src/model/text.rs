//! The text of an expression, parsed once: copies of a model share the syntax tree.

use crate::diagnostic::Diagnostic;
use crate::expr::ast::{Ast, Dialect};
use crate::expr::{Expr, Profile, parse};
use std::fmt;
use std::ops::Deref;
use std::sync::{Arc, OnceLock};

/// Text of an expression of the function language, with its syntax tree, which is made when it is
/// first asked for. A text is compared and written as what it says.
#[derive(Clone, Default)]
pub struct Text(Arc<Parsed>);

#[derive(Default)]
struct Parsed {
    text: String,
    ast: OnceLock<Result<Arc<Ast>, Diagnostic>>,
}

impl Text {
    /// Returns the syntax tree.
    ///
    /// # Errors
    /// The first mistake in the text; columns count from its beginning.
    pub fn ast(&self) -> Result<&Arc<Ast>, Diagnostic> {
        let Parsed { text, ast } = &*self.0;
        let parsed =
            ast.get_or_init(|| parse(text, Dialect::Function, Profile::default()).map(Arc::new));
        parsed.as_ref().map_err(Clone::clone)
    }

    /// Returns the expression, whose constant parts have been evaluated once.
    ///
    /// # Errors
    /// The first mistake in the text, or a constant part without a value.
    pub fn expression(&self) -> Result<Expr, Diagnostic> {
        Expr::from_ast(self, Arc::clone(self.ast()?))
    }
}

impl From<String> for Text {
    fn from(text: String) -> Self {
        let ast = OnceLock::new();
        Self(Arc::new(Parsed { text, ast }))
    }
}

impl From<&str> for Text {
    fn from(text: &str) -> Self {
        Self::from(text.to_string())
    }
}

impl Deref for Text {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0.text
    }
}

impl PartialEq for Text {
    fn eq(&self, other: &Self) -> bool {
        self.0.text == other.0.text
    }
}

impl fmt::Debug for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.0.text, f)
    }
}

impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_share_what_has_been_parsed() {
        let text = Text::from("2*TIME");
        let copy = text.clone();
        let tree = Arc::clone(text.ast().unwrap());
        assert!(Arc::ptr_eq(&tree, copy.ast().unwrap()));
        assert_eq!(text, Text::from("2*TIME"));
        assert_eq!(copy.expression().unwrap().eval(&[("TIME", 3.0)]), Ok(6.0));
    }
}
