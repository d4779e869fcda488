//! The text of an expression, parsed and compiled once: copies of a model share the syntax tree and
//! the program.

use crate::diagnostic::Diagnostic;
use crate::expr::ast::{Ast, Dialect};
use crate::expr::compile::Compiler;
use crate::expr::interpolation::Bindings;
use crate::expr::program::Program;
use crate::expr::{Expr, Profile, parse, walk};
use std::fmt;
use std::ops::Deref;
use std::sync::{Arc, LazyLock, OnceLock};

/// Text of an expression of the function language, with its syntax tree, which is made when it is
/// first asked for. A text is compared and written as what it says.
#[derive(Clone)]
pub struct Text(Arc<Parsed>);

#[derive(Default)]
struct Parsed {
    text: String,
    ast: OnceLock<Result<Arc<Ast>, Diagnostic>>,
    /// whether its constant parts have values
    constants: OnceLock<Result<(), Diagnostic>>,
    program: OnceLock<Option<Program>>,
}

impl Text {
    /// Returns the syntax tree.
    ///
    /// # Errors
    /// The first mistake in the text; columns count from its beginning.
    pub fn ast(&self) -> Result<&Arc<Ast>, Diagnostic> {
        let Parsed { text, ast, .. } = &*self.0;
        let parsed =
            ast.get_or_init(|| parse(text, Dialect::Function, Profile::default()).map(Arc::new));
        parsed.as_ref().map_err(Clone::clone)
    }

    /// Returns its program, which is compiled once, where nothing of a model is part of it; `None`:
    /// it names splines or curves, reads the past, or has a mistake.
    pub(crate) fn program(&self) -> Option<&Program> {
        let compiled = || {
            let bindings = Bindings::default();
            let mut compiler = Compiler::new(&bindings);
            let value = compiler.add(self.ast().ok()?).ok()?;
            let has_past = !compiler.delays().is_empty();
            (!has_past).then(|| compiler.finish(&[value]))
        };
        self.0.program.get_or_init(compiled).as_ref()
    }

    /// Returns the expression, whose constant parts have been evaluated once.
    ///
    /// # Errors
    /// The first mistake in the text, or a constant part without a value.
    pub fn expression(&self) -> Result<Expr, Diagnostic> {
        let ast = self.sound_ast()?;
        Ok(Expr::from_sound_ast(self, Arc::clone(ast)))
    }

    /// Returns the syntax tree of an expression whose constant parts have values.
    ///
    /// # Errors
    /// As [`Text::expression`].
    pub(crate) fn sound_ast(&self) -> Result<&Arc<Ast>, Diagnostic> {
        let ast = self.ast()?;
        let check = || walk::check_constants(ast).map_err(|trouble| trouble.diagnostic(self));
        let checked = self.0.constants.get_or_init(check);
        checked.as_ref().map_err(Clone::clone)?;
        Ok(ast)
    }
}

/// The text of all that have none.
static EMPTY: LazyLock<Text> = LazyLock::new(|| Text::from(String::new()));

impl Default for Text {
    fn default() -> Self {
        EMPTY.clone()
    }
}

impl From<String> for Text {
    fn from(text: String) -> Self {
        Self(Arc::new(Parsed {
            text,
            ..Parsed::default()
        }))
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
        Arc::ptr_eq(&self.0, &other.0) || self.0.text == other.0.text
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

    #[test]
    fn a_formula_is_a_number_where_its_value_reads_nothing() {
        let constant = |text: &str| crate::model::Formula::text(text).constant();
        for (text, number) in [
            ("2*3", Some(6.0)),
            ("IF(-1: 2, TIME, DX(1,2))", Some(2.0)),
            ("IF(1: 2, 0, TIME)", None),
            ("0*TIME", None),
            ("SIN(DX(1,2))", None),
            ("1/0", None),
        ] {
            assert_eq!(constant(text), number, "{text}");
        }
    }
}
