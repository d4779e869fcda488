//! The front door of the language: one expression, from its text to its value.

use super::ast::{Ast, Callee, Constant, Dialect, Node, NodeIx};
use super::calls::Calls;
use super::compile::Compiler;
use super::functions::Function;
use super::interpolation::Bindings;
use super::names::{Meaning, Names};
use super::parse::{parse, parse_named};
use super::program::{Input, Program, too_few};
use super::symbols::Profile;
use super::walk::{self, Host};
use crate::diagnostic::{Cause, Diagnostic, Error, Span, counted};
use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;
use std::sync::Arc;

/// An expression of the function language, checked.
///
/// ```
/// use cognate::expr::Expr;
/// let f = Expr::parse("STEP5(TIME, 0, 0, 1, 10) * SIN(2*PI*TIME)")?;
/// let y = f.eval(&[("TIME", 0.25)])?;
/// assert_eq!(y, 1.03515625);
/// assert_eq!(f.to_string(), "STEP5(TIME, 0, 0, 1, 10)*SIN(2*PI*TIME)");
/// # Ok::<(), cognate::Error>(())
/// ```
///
/// Inputs from a model are given by name:
///
/// ```
/// # use cognate::expr::Expr;
/// let spring = Expr::parse("-25*(DM(10,20) - 10) - 2*VR(10,20)")?;
/// let names: Vec<String> = spring.inputs().iter().map(|i| i.to_string()).collect();
/// assert_eq!(names, ["DM(10, 20)", "VR(10, 20)"]);
/// assert_eq!(spring.eval(&[("DM(10, 20)", 12.0), ("VR(10, 20)", 0.5)])?, -51.0);
/// # Ok::<(), cognate::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    text: String,
    ast: Arc<Ast>,
}

impl Expr {
    /// Reads a direct-entry function.
    ///
    /// # Errors
    /// The first mistake in the text; or an operation that has no value for any inputs, as in
    /// `1/0`.
    ///
    /// ```
    /// # use cognate::expr::Expr;
    /// let error = Expr::parse("2*SQRT(TIME").unwrap_err();
    /// assert_eq!((error.code(), error.first().column), ("unexpected_end", 12));
    /// ```
    pub fn parse(text: &str) -> Result<Self, Error> {
        Self::parse_dialect(text, Dialect::Function)
    }

    /// Reads a text of either language.
    ///
    /// # Errors
    /// Those of [`Expr::parse`].
    ///
    /// ```
    /// # use cognate::expr::{Expr, ast::Dialect};
    /// let motion = Expr::parse_dialect("180*sin(360*t)", Dialect::Expression)?;
    /// assert!((motion.eval(&[("t", 0.25)])? - 180.0).abs() < 1e-12);
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn parse_dialect(text: &str, dialect: Dialect) -> Result<Self, Error> {
        Self::parse_profile(text, dialect, Profile::Adams)
    }

    /// Reads a text under the profile of a program: its limits and its additional names.
    ///
    /// # Errors
    /// Those of [`Expr::parse`], and exceeding a limit.
    ///
    /// ```
    /// # use cognate::expr::{Expr, Profile, ast::Dialect};
    /// let deep = "(((((((((((1)))))))))))";
    /// assert!(Expr::parse(deep).is_ok());
    /// let error = Expr::parse_profile(deep, Dialect::Function, Profile::Ideas).unwrap_err();
    /// assert_eq!((error.code(), error.first().column), ("limit_nesting", 11));
    /// ```
    pub fn parse_profile(text: &str, dialect: Dialect, profile: Profile) -> Result<Self, Error> {
        Ok(Self::from_ast(
            text,
            Arc::new(parse(text, dialect, profile)?),
        )?)
    }

    /// Reads a text with names of the caller's own, in the language that they are for.
    ///
    /// # Errors
    /// All mistakes in the names; else those of [`Expr::parse`].
    ///
    /// ```
    /// # use cognate::expr::{Expr, Names};
    /// let names = Names::new().variables(["speed"]).define("power(f)", "f*TIME");
    /// let f = Expr::parse_with("power(3) + speed", &names)?;
    /// assert_eq!(f.eval(&[("speed", 1.0), ("TIME", 2.0)])?, 7.0);
    /// let error = Expr::parse_with("power(3) + sped", &names).unwrap_err();
    /// assert_eq!(error.first().help, ["did you mean speed?"]);
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn parse_with(text: &str, names: &Names) -> Result<Self, Error> {
        names.check()?;
        let names = Arc::new(names.clone());
        let ast = parse_named(text, names.dialect(), Profile::Adams, &names)?;
        names.check_size(&ast)?;
        Ok(Self::from_ast(text, Arc::new(ast))?)
    }

    /// Takes a tree that was made of a text.
    ///
    /// # Errors
    /// A constant part without a value.
    pub(crate) fn from_ast(text: &str, ast: Arc<Ast>) -> Result<Self, Diagnostic> {
        walk::check_constants(&ast).map_err(|trouble| trouble.diagnostic(text))?;
        Ok(Self::from_sound_ast(text, ast))
    }

    /// Takes a tree that was made of a text, and whose constant parts have values.
    pub(crate) fn from_sound_ast(text: &str, ast: Arc<Ast>) -> Self {
        let text = text.to_string();
        Self { text, ast }
    }

    /// Returns the text it was read from.
    pub fn text(&self) -> &str {
        &self.text
    }
    /// Returns the tree.
    pub fn ast(&self) -> &Ast {
        &self.ast
    }

    /// Evaluates for inputs given by name: `TIME` (or `t`), `MODE`, and measures as they are
    /// written.
    ///
    /// # Errors
    /// A name that is no input, an input without a value, or an operation on the taken path that
    /// has no value: the message names it and the numbers it was given.
    ///
    /// ```
    /// # use cognate::expr::Expr;
    /// let f = Expr::parse("IF(TIME-1: 0, 0, LOG(2-TIME))")?;
    /// assert_eq!(f.eval(&[("TIME", 0.5)])?, 0.0);
    /// let error = f.eval(&[("TIME", 2.5)]).unwrap_err();
    /// assert_eq!(error.first().column, 18);
    /// let message = "LOG of -0.5 has no value at TIME = 2.5: LOG takes positive numbers";
    /// assert_eq!(error.first().message, message);
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn eval(&self, inputs: &[(&str, f64)]) -> Result<f64, Error> {
        let mut known = BTreeMap::new();
        for &(name, value) in inputs {
            known.insert(self.input_named(name)?, value);
        }
        self.eval_with(&|input| known.get(&input).copied())
    }

    /// Evaluates for the inputs and curves of a host.
    ///
    /// # Errors
    /// Those of [`Expr::eval`].
    pub fn eval_with(&self, host: &dyn Host) -> Result<f64, Error> {
        walk::value(&self.ast, host).map_err(|trouble| trouble.diagnostic(&self.text).into())
    }

    /// Returns the input of this name: a variable of its own, or an input of the language.
    ///
    /// # Errors
    /// Those of [`input_named`].
    pub fn input_named(&self, name: &str) -> Result<Input, Diagnostic> {
        let variable = (0..).zip(self.ast.names.variable_names());
        let mut variable = variable.filter(|(_, known)| known.eq_ignore_ascii_case(name));
        match variable.next() {
            Some((k, _)) => Ok(Input::Slot(k)),
            None => input_named(name, self.ast.dialect),
        }
    }

    /// Returns the name of an input as the expression writes it.
    pub fn input_name(&self, input: Input) -> String {
        let variable = match input {
            Input::Slot(k) => self.ast.names.variable_names().nth(k as usize),
            _ => None,
        };
        variable.map_or_else(|| input.to_string(), String::from)
    }

    /// Returns the names of inputs as the expression writes them.
    pub(super) fn names_of(&self, inputs: &[Input]) -> Vec<String> {
        inputs.iter().map(|&i| self.input_name(i)).collect()
    }

    /// Checks the columns of `n` points of an expression with names of the caller's own; a program
    /// checks those of the language.
    pub(super) fn check_columns(
        &self,
        inputs: &[Input],
        columns: &[&[f64]],
        n: usize,
    ) -> Result<(), Error> {
        if self.ast.names.entries().is_empty() {
            return Ok(());
        }
        if columns.len() < inputs.len() {
            return Err(too_few(columns.len(), &self.names_of(inputs)).into());
        }
        match inputs.iter().zip(columns).find(|(_, c)| c.len() < n) {
            None => Ok(()),
            Some((&input, column)) => {
                let (name, had) = (self.input_name(input), column.len());
                let what = format!(
                    "the column of {name} has {} for {}",
                    counted(had, "value"),
                    counted(n, "point")
                );
                Err(Diagnostic::error(Cause::MissingValue, what).into())
            }
        }
    }

    /// Returns its inputs, each once, in the order of the text, behind variables of its own.
    /// Delayed values are left out; the program numbers them.
    pub fn inputs(&self) -> Vec<Input> {
        let variables = self.ast.names.variable_names();
        let mut found: Vec<Input> = (0..).zip(variables).map(|(k, _)| Input::Slot(k)).collect();
        for ix in 0..self.ast.nodes.len() {
            if let Some(input) = self.ast.input(ix as NodeIx).filter(|i| !found.contains(i)) {
                found.push(input);
            }
        }
        found
    }

    /// Returns the input whose text stands at a place.
    pub fn input_at(&self, span: Span) -> Option<Input> {
        let at = |(ix, place): (usize, &Span)| {
            let input = self.ast.input(ix as NodeIx);
            input.filter(|_| *place == span)
        };
        self.ast.spans.iter().enumerate().find_map(at)
    }

    /// Returns the names of its inputs that depend on the past: DELAY, and angles that count turns.
    pub fn needs_history(&self) -> Vec<&'static str> {
        let mut found = Vec::new();
        for node in &self.ast.nodes {
            if let Node::Call { callee, .. } = node
                && callee.needs_history()
                && !found.contains(&callee.name())
            {
                found.push(callee.name());
            }
        }
        found
    }

    /// Returns warnings about what is legal but probably not meant: degrees for radians, operators
    /// that bind otherwise than they look.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        super::lint::lint(&self.ast, &self.text)
    }

    /// Compiles the program that yields the same value, fast.
    ///
    /// # Errors
    /// A spline or curve that is not bound; a function of the caller's own that is known by its
    /// numbers only, which an [`Evaluator`](super::Evaluator) calls.
    pub fn compile(&self, bindings: &Bindings) -> Result<Program, Error> {
        match self.compile_with_calls(bindings)? {
            (program, None) => Ok(program),
            (_, Some(calls)) => {
                let what = format!("{} is a closure, no part of a program", calls.first_name());
                let said = Diagnostic::error("unfit_value", what);
                Err(said.help("make an Evaluator of the expression").into())
            }
        }
    }

    /// Compiles like [`compile`](Self::compile); with the calls of functions of the caller's own
    /// that the program reads, if there are any.
    pub(super) fn compile_with_calls(
        &self,
        bindings: &Bindings,
    ) -> Result<(Program, Option<Calls>), Error> {
        let mut compiler = Compiler::new(bindings);
        let value = compiler.add(&self.ast).map_err(|mut said| {
            if let Some(span) = said.span {
                let placed = super::advice::at(&self.text, said.code, "", span);
                (said.line, said.column) = (placed.line, placed.column);
            }
            Error::from(said)
        })?;
        let calls = Calls::new(&compiler, value);
        Ok((compiler.finish(&[value]), calls))
    }
}

impl FromStr for Expr {
    type Err = Error;
    fn from_str(text: &str) -> Result<Self, Error> {
        Self::parse(text)
    }
}

/// Prints the source: as few parentheses as possible, shortest digits. Reading that gives the same
/// tree.
impl fmt::Display for Expr {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.ast.fmt(f)
    }
}

/// Returns the input of this name: `TIME`, `DX(1, 2)`.
///
/// # Errors
/// A mistake in the name, or an expression that is more than one input.
pub fn input_named(name: &str, dialect: Dialect) -> Result<Input, Diagnostic> {
    let ast = parse(name, dialect, Profile::Adams)?;
    ast.input(ast.root).ok_or_else(|| {
        let said = Diagnostic::error(
            Cause::MissingValue,
            format!("`{name}` is not the name of an input"),
        );
        said.help(
            "inputs are TIME (t in expression functions), MODE, and measures such as DX(1, 2)",
        )
    })
}

impl Ast {
    /// Returns the input that a node reads, if it is one.
    pub fn input(&self, ix: NodeIx) -> Option<Input> {
        match self.node(ix) {
            Node::Constant(Constant::Time) => Some(Input::Time),
            Node::Constant(Constant::Mode) => Some(Input::Mode),
            Node::Named { entry, .. } => match self.names.entry(*entry).meaning {
                Meaning::Variable(k) => Some(Input::Slot(k)),
                _ => None,
            },
            Node::Call {
                callee: Callee::Measure(m),
                args,
            } => {
                let mut identifiers = [0; 4];
                for (identifier, &arg) in identifiers.iter_mut().zip(args) {
                    if let Node::Number { literal, .. } = *self.node(arg) {
                        // the check has found an integer in its range
                        *identifier = literal as u32;
                    }
                }
                Some(Input::Measure(*m, identifiers))
            }
            _ => None,
        }
    }

    /// Returns the calls of DELAY with the numbers of their delayed values: identical calls share
    /// one.
    pub fn delays(&self) -> Vec<(NodeIx, u32)> {
        let mut different: Vec<String> = Vec::new();
        let mut found = Vec::new();
        for (ix, node) in (0..).zip(&self.nodes) {
            if matches!(
                node,
                Node::Call {
                    callee: Callee::Function(Function::Delay),
                    ..
                }
            ) {
                let written = self.written(ix);
                let known = different.iter().position(|w| *w == written);
                let number = known.unwrap_or_else(|| {
                    different.push(written);
                    different.len() - 1
                });
                found.push((ix, number as u32));
            }
        }
        found
    }
}

/// Prints the input as a user would write it; trailing arguments that are ground are left out.
impl fmt::Display for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Input::Time => f.write_str("TIME"),
            Input::Mode => f.write_str("MODE"),
            Input::Measure(measure, identifiers) => {
                let (least, most) = Callee::Measure(measure).arity();
                let written = identifiers[..most.min(4)]
                    .iter()
                    .rposition(|&id| id != 0)
                    .map_or(0, |k| k + 1);
                let list: Vec<String> = identifiers[..written.max(least)]
                    .iter()
                    .map(u32::to_string)
                    .collect();
                write!(f, "{}({})", measure.name(), list.join(", "))
            }
            Input::Delayed(k) => write!(f, "delayed value {}", k + 1),
            Input::Slot(k) => write!(f, "slot {k}"),
        }
    }
}
