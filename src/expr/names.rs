//! Names of a caller's own: variables, constants and functions that expressions may use beside
//! those of the language.
//!
//! A function is a formula in the language, a law over any scalar, or a closure over plain numbers.
//! The first two are recorded into the program of an expression like its own operations, so that
//! derivatives, rates and batches follow; of a closure only its values are known, and the
//! derivatives that it gives.

use super::ast::{Ast, Dialect, Node};
use super::check::{DEEPEST_NESTING, MOST_CHARACTERS};
use super::parse::parse_named;
use super::program::Sym;
use super::symbols::{Profile, symbol};
use crate::diagnostic::{Diagnostic, Error, counted};
use std::fmt;
use std::sync::Arc;

/// Most arguments of a function.
const MOST_ARGUMENTS: usize = 64;

/// A law over any scalar.
pub(crate) type Law = Arc<dyn for<'b> Fn(&[Sym<'b>]) -> Sym<'b> + Send + Sync>;
/// A closure over plain numbers; it puts its partial derivatives into the slice, unless that is
/// empty.
pub(crate) type Closure = Arc<dyn Fn(&[f64], &mut [f64]) -> f64 + Send + Sync>;

/// The names that a caller gives to an expression.
///
/// Upper and lower case are one, as in the language. Mistakes (a name that cannot be written, that
/// hides one of the language, or that is there already) are told by [`Expr::parse_with`], all at
/// once.
///
/// ```
/// use cognate::expr::{Evaluator, Expr, Names};
/// use cognate::scalar::Scalar;
/// let names = Names::new()
///     .variables(["x", "v"])
///     .constant("g", 9.81)
///     .define("hertz(x, k)", "k*MAX(x, 0)**1.5")
///     .law("drag", |[v]| v * Scalar::abs(v));
/// let force = Expr::parse_with("hertz(x, 2e5) - 0.3*drag(v) + g", &names)?;
/// let mut force = Evaluator::new(force, &Default::default())?;
/// assert_eq!(force.eval(&[0.01, 2.0])?, 200.0 - 1.2 + 9.81);
/// assert_eq!(force.gradient(&[0.01, 2.0])?, [30_000.0, -1.2]);
/// # Ok::<(), cognate::Error>(())
/// ```
///
/// [`Expr::parse_with`]: super::Expr::parse_with
#[derive(Clone, Debug)]
pub struct Names {
    dialect: Dialect,
    entries: Vec<Entry>,
    mistakes: Vec<Diagnostic>,
}

/// A registered name.
#[derive(Clone, Debug)]
pub(crate) struct Entry {
    /// as it was registered
    pub name: String,
    /// names of the arguments; empty: it stands alone
    pub arguments: Vec<String>,
    pub meaning: Meaning,
}

/// The meaning of a registered name.
#[derive(Clone)]
pub(crate) enum Meaning {
    /// the `k`-th variable, which the caller gives
    Variable(u32),
    Constant(f64),
    Formula(Formula),
    Law(Law),
    Numeric(Numeric),
}

/// A function of which numbers are known only.
#[derive(Clone)]
pub(crate) struct Numeric {
    pub closure: Closure,
    pub has_slopes: bool,
}

impl Numeric {
    /// Returns true if both are the same closure.
    pub fn is(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.closure, &other.closure)
    }
}

impl fmt::Debug for Numeric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("closure")
    }
}

/// A function written in the language; its arguments are the variables of its tree.
#[derive(Clone)]
pub(crate) struct Formula {
    pub body: Arc<Ast>,
    /// nodes of the body and of the formulas that it calls, each as often as it is called
    size: usize,
    /// formulas that call one another, this one counted
    depth: usize,
}

impl fmt::Debug for Meaning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Variable(k) => write!(f, "variable {k}"),
            Self::Constant(c) => write!(f, "constant {c}"),
            Self::Formula(formula) => write!(f, "formula {}", formula.body),
            Self::Law(_) => f.write_str("law"),
            Self::Numeric(closure) => closure.fmt(f),
        }
    }
}

impl Default for Names {
    fn default() -> Self {
        Self::new()
    }
}

impl Names {
    /// Begins without names, for the language of direct entry.
    pub fn new() -> Self {
        Self::of(Dialect::Function)
    }

    /// Begins without names, for one of the two languages.
    pub fn of(dialect: Dialect) -> Self {
        Self {
            dialect,
            entries: Vec::new(),
            mistakes: Vec::new(),
        }
    }

    /// Adds variables. Their values are the first inputs of an evaluator, in this order, also of
    /// those that an expression does not read.
    pub fn variables<'n>(mut self, names: impl IntoIterator<Item = &'n str>) -> Self {
        for name in names {
            let k = self.variable_names().count() as u32;
            self.add(name, Vec::new(), Meaning::Variable(k));
        }
        self
    }

    /// Adds a named number.
    pub fn constant(mut self, name: &str, value: f64) -> Self {
        if !value.is_finite() {
            self.refuse(format!("the constant {name} is {value}"), None);
        }
        self.add(name, Vec::new(), Meaning::Constant(value));
        self
    }

    /// Adds a function that is written in the language: `define("hertz(x, k)", "k*x**1.5")`. It may
    /// use the constants and functions that were added before it, and inputs of a model.
    pub fn define(mut self, head: &str, formula: &str) -> Self {
        match self.defined(head, formula) {
            Ok((name, arguments, meaning)) => self.add(&name, arguments, meaning),
            Err(said) => self.mistakes.push(said),
        }
        self
    }

    /// Adds a function as a law over any scalar, of as many arguments as its array has. It is
    /// recorded once: what it does with its numbers becomes a part of the program, with
    /// derivatives by the same rules. Constants in it are `Scalar::constant(2.0)`.
    pub fn law<const N: usize>(
        mut self,
        name: &str,
        law: impl for<'b> Fn([Sym<'b>; N]) -> Sym<'b> + Send + Sync + 'static,
    ) -> Self {
        let spread: Law = Arc::new(move |given: &[Sym<'_>]| {
            law(std::array::from_fn(|k| {
                given.get(k).copied().unwrap_or(Sym::Constant(f64::NAN))
            }))
        });
        self.add(name, numbered(N), Meaning::Law(spread));
        self
    }

    /// Adds a function of which only values are known. An expression that reads it has no
    /// derivatives along what its arguments depend on: asking for them is an error that names it.
    pub fn function<const N: usize>(
        self,
        name: &str,
        value: impl Fn([f64; N]) -> f64 + Send + Sync + 'static,
    ) -> Self {
        self.function_of_slice(name, N, move |given| value(spread(given)))
    }

    /// Adds a function like [`function`](Self::function), for a number of arguments that is known
    /// when the program runs; the slice has as many.
    pub fn function_of_slice(
        mut self,
        name: &str,
        n_arguments: usize,
        value: impl Fn(&[f64]) -> f64 + Send + Sync + 'static,
    ) -> Self {
        let closure: Closure = Arc::new(move |given: &[f64], _: &mut [f64]| value(given));
        let has_slopes = false;
        let meaning = Meaning::Numeric(Numeric {
            closure,
            has_slopes,
        });
        self.add(name, numbered(n_arguments), meaning);
        self
    }

    /// Adds a function like [`function_with_slopes`](Self::function_with_slopes), for a number of
    /// arguments that is known when the program runs. It puts its partial derivatives into the
    /// second slice, which is empty where only the value is asked for.
    pub fn function_of_slice_with_slopes(
        mut self,
        name: &str,
        n_arguments: usize,
        value: impl Fn(&[f64], &mut [f64]) -> f64 + Send + Sync + 'static,
    ) -> Self {
        let meaning = Meaning::Numeric(Numeric {
            closure: Arc::new(value),
            has_slopes: true,
        });
        self.add(name, numbered(n_arguments), meaning);
        self
    }

    /// Adds a function that gives its value and its partial derivatives.
    ///
    /// ```
    /// use cognate::expr::{Evaluator, Expr, Names};
    /// let names = Names::new()
    ///     .variables(["x"])
    ///     .function_with_slopes("cube", |[x]| (x * x * x, [3.0 * x * x]));
    /// let f = Expr::parse_with("cube(2*x)", &names)?;
    /// let mut f = Evaluator::new(f, &Default::default())?;
    /// assert_eq!(f.eval(&[1.0])?, 8.0);
    /// assert_eq!(f.gradient(&[1.0])?, [24.0]);
    /// # Ok::<(), cognate::Error>(())
    /// ```
    pub fn function_with_slopes<const N: usize>(
        self,
        name: &str,
        value: impl Fn([f64; N]) -> (f64, [f64; N]) + Send + Sync + 'static,
    ) -> Self {
        self.function_of_slice_with_slopes(name, N, move |given, out| {
            let (value, slopes) = value(spread(given));
            for (to, slope) in out.iter_mut().zip(slopes) {
                *to = slope;
            }
            value
        })
    }

    /// Returns the language that the names are for.
    pub fn dialect(&self) -> Dialect {
        self.dialect
    }

    /// Iterates over the names of the variables, in the order of their values.
    pub fn variable_names(&self) -> impl Iterator<Item = &str> {
        let is_variable = |entry: &&Entry| matches!(entry.meaning, Meaning::Variable(_));
        let variables = self.entries.iter().filter(is_variable);
        variables.map(|entry| entry.name.as_str())
    }

    /// Returns all mistakes in the names, if there is one.
    pub(crate) fn check(&self) -> Result<(), Error> {
        match self.mistakes.is_empty() {
            true => Ok(()),
            false => Err(self.mistakes.clone().into()),
        }
    }

    pub(crate) fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Returns the index of the entry of this name, in upper or lower case.
    pub(crate) fn find(&self, name: &str) -> Option<u32> {
        let mut entries = self.entries.iter();
        let place = entries.position(|entry| entry.name.eq_ignore_ascii_case(name));
        place.map(|k| k as u32)
    }

    /// Returns an entry that a tree names.
    pub(crate) fn entry(&self, k: u32) -> &Entry {
        &self.entries[k as usize]
    }

    /// Returns the name that a [`Node::Named`](super::ast::Node::Named) of a tree calls by its
    /// number; none for a number of another tree.
    pub fn name(&self, entry: u32) -> Option<&str> {
        let entry = self.entries.get(entry as usize);
        entry.map(|entry| entry.name.as_str())
    }

    /// Refuses a tree that is too large with all formulas that it calls written out.
    pub(crate) fn check_size(&self, ast: &Ast) -> Result<(), Diagnostic> {
        match self.written_out(ast) {
            (size, depth) if size <= MOST_CHARACTERS && depth <= DEEPEST_NESTING => Ok(()),
            _ => {
                let what = "the formulas that it calls make it too long";
                let advice = "functions that call others often are better given as closures";
                Err(Diagnostic::error("limit_length", what).help(advice))
            }
        }
    }

    /// Returns the nodes of a tree and of the formulas that it calls, and how deep those call one
    /// another.
    fn written_out(&self, ast: &Ast) -> (usize, usize) {
        let (mut size, mut depth) = (ast.nodes.len(), 0);
        for node in &ast.nodes {
            if let Node::Named { entry, .. } = node
                && let Meaning::Formula(formula) = &self.entry(*entry).meaning
            {
                size = size.saturating_add(formula.size);
                depth = depth.max(formula.depth);
            }
        }
        (size, depth)
    }

    /// Reads the head and the formula of a function.
    fn defined(
        &self,
        head: &str,
        formula: &str,
    ) -> Result<(String, Vec<String>, Meaning), Diagnostic> {
        let form = || {
            let what = format!("`{head}` is not the head of a function");
            Diagnostic::error("bad_registration", what).help("a head is written f(x, y)")
        };
        let (name, rest) = head.split_once('(').ok_or_else(form)?;
        let list = rest.trim_end().strip_suffix(')').ok_or_else(form)?;
        let arguments: Vec<String> = list.split(',').map(|a| a.trim().to_string()).collect();
        let mut inner = Self::of(self.dialect).variables(arguments.iter().map(String::as_str));
        let outer = self.entries.iter();
        let others = outer.filter(|e| {
            // an argument hides a name from outside
            !matches!(e.meaning, Meaning::Variable(_)) && inner.find(&e.name).is_none()
        });
        let others: Vec<Entry> = others.cloned().collect();
        inner.entries.extend(others);
        inner.check().map_err(Error::into_first)?;
        let name = name.trim().to_string();
        let inner = Arc::new(inner);
        let body = parse_named(formula, self.dialect, Profile::Adams, &inner).map_err(|said| {
            let message = format!("in the formula of {name}: {}", said.message);
            Diagnostic { message, ..said }
        })?;
        inner.check_size(&body)?;
        let (size, depth) = inner.written_out(&body);
        let formula = Formula {
            body: Arc::new(body),
            size,
            depth: depth + 1,
        };
        Ok((name, arguments, Meaning::Formula(formula)))
    }

    /// Adds a name, or tells why it cannot be one.
    fn add(&mut self, name: &str, arguments: Vec<String>, meaning: Meaning) {
        let mut rest = name.bytes();
        let begins = rest.next().is_some_and(|b| b.is_ascii_alphabetic());
        let is_function = !matches!(meaning, Meaning::Variable(_) | Meaning::Constant(_));
        let advice = "take another name";
        if !begins || !rest.all(|b| b.is_ascii_alphanumeric() || b == b'_') {
            let form = "a name is a letter, then letters, digits and underscores";
            self.refuse(format!("`{name}` cannot be a name"), Some(form));
        } else if symbol(name, self.dialect, Profile::Adams).is_some() {
            let what = format!("{name} would hide a name of the language");
            self.refuse(what, Some(advice));
        } else if self.find(name).is_some() {
            self.refuse(format!("{name} is registered twice"), Some(advice));
        } else if is_function && !(1..=MOST_ARGUMENTS).contains(&arguments.len()) {
            let n = arguments.len();
            let what = format!(
                "{name} takes {}; a function takes 1 to {MOST_ARGUMENTS}",
                counted(n, "argument")
            );
            self.refuse(what, None);
        } else {
            self.entries.push(Entry {
                name: name.to_string(),
                arguments,
                meaning,
            });
        }
    }

    fn refuse(&mut self, what: String, advice: Option<&str>) {
        let said = Diagnostic::error("bad_registration", what);
        self.mistakes.push(match advice {
            Some(advice) => said.help(advice),
            None => said,
        });
    }
}

impl Entry {
    /// Prints the name with its arguments: `hertz(x, k)`.
    pub fn signature(&self) -> String {
        match self.arguments.is_empty() {
            true => self.name.clone(),
            false => format!("{}({})", self.name, self.arguments.join(", ")),
        }
    }
}

/// Two lists are equal when they have the same names; their meanings cannot be compared. The
/// language is that of the tree.
impl PartialEq for Names {
    fn eq(&self, other: &Self) -> bool {
        let names = |of: &Self| of.entries.iter().map(Entry::signature).collect::<Vec<_>>();
        names(self) == names(other)
    }
}

/// Returns the numbers of a slice as an array; NaN for those that are missing.
fn spread<const N: usize>(given: &[f64]) -> [f64; N] {
    std::array::from_fn(|k| given.get(k).copied().unwrap_or(f64::NAN))
}

/// Returns names of arguments that have none: x1, x2 …
fn numbered(n: usize) -> Vec<String> {
    (1..=n).map(|k| format!("x{k}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{Evaluator, Expr, SharedEvaluator};
    use crate::scalar::Scalar;

    fn evaluator(text: &str, names: &Names) -> Evaluator {
        Evaluator::new(Expr::parse_with(text, names).unwrap(), &Default::default()).unwrap()
    }

    /// One function in the language, as a law, and as a closure with slopes.
    fn all_ways() -> Names {
        Names::new()
            .variables(["x", "y"])
            .constant("k", 3.0)
            .define("formula(a, b)", "k*a**2*SIN(b) + TIME")
            .law("law", |[a, b, t]| a * a * b.sin() * Sym::constant(3.0) + t)
            .function_with_slopes("closure", |[a, b, t]: [f64; 3]| {
                let value = 3.0 * a * a * Scalar::sin(b) + t;
                let slopes = [6.0 * a * b.sin(), 3.0 * a * a * b.cos(), 1.0];
                (value, slopes)
            })
    }

    #[test]
    fn functions_are_the_same_however_they_are_given() {
        let names = all_ways();
        let plain = "3*(2*x)**2*SIN(x - y) + TIME";
        let others = [
            "formula(2*x, x - y)",
            "law(2*x, x - y, TIME)",
            "closure(2*x, x - y, TIME)",
            "closure(2*x, x - y, formula(0, 0))",
            "closure(2*x, x - y, closure(0, y, TIME))",
        ];
        let at = [0.7, -0.4, 1.5];
        let mut reference = evaluator(plain, &names);
        let (value, slopes) = (
            reference.eval(&at).unwrap(),
            reference.gradient(&at).unwrap(),
        );
        let jets = [[0.7, 1.0, 0.2], [-0.4, 0.5, 0.0], [1.5, 1.0, 0.0]];
        let rates = reference.rates(&jets).unwrap();
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-14 * (1.0 + b.abs());
        for text in others {
            let mut f = evaluator(text, &names);
            assert_eq!(f.inputs(), reference.inputs(), "{text}");
            assert!(near(f.eval(&at).unwrap(), value), "{text}");
            let own = f.gradient(&at).unwrap();
            assert!(
                own.iter().zip(&slopes).all(|(a, b)| near(*a, *b)),
                "{text}: {own:?}"
            );
            let columns: Vec<Vec<f64>> = at.iter().map(|x| vec![*x, 2.0 * x]).collect();
            let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
            let batch = f.batch(&columns).unwrap();
            assert!(
                near(batch[0], value) && batch[1] == f.value(&[1.4, -0.8, 3.0]),
                "{text}"
            );
            assert_eq!(
                f.expr().eval(&[("x", 0.7), ("Y", -0.4), ("TIME", 1.5)]),
                f.eval(&at)
            );
            match text.starts_with("closure") {
                true => assert_eq!(f.rates(&jets).unwrap_err().code(), "no_derivative"),
                false => {
                    let own = f.rates(&jets).unwrap();
                    assert!(own.iter().zip(rates).all(|(a, b)| near(*a, b)), "{text}");
                }
            }
            let shared = SharedEvaluator::parse_with(text, &names).unwrap();
            let mut out = [0.0; 4];
            shared.run_slopes(&at, &mut out);
            assert!(
                near(out[0], value) && near(out[3], slopes[2]),
                "{text}: {out:?}"
            );
            let read = Expr::parse_with(&f.expr().to_string(), &names).unwrap();
            assert_eq!(&read, &Expr::parse_with(text, &names).unwrap());
        }
    }

    #[test]
    fn variables_are_given_in_the_order_of_the_caller() {
        let names = Names::new().variables(["first", "second", "third"]);
        let mut f = evaluator("third - TIME + first", &names);
        let given = ["first", "second", "third", "TIME"];
        assert_eq!(f.expr().names_of(f.inputs()), given);
        assert_eq!(f.eval(&[1.0, f64::MAX, 10.0, 100.0]), Ok(-89.0));
        let said = f.eval(&[1.0]).unwrap_err().into_first().message;
        assert_eq!(
            said,
            "1 value was given for 4 inputs: first, second, third, TIME"
        );
        let said = f.batch(&[&[1.0, 2.0], &[1.0]]).unwrap_err();
        assert_eq!(said.code(), "missing_value");
        let said = f.expr().eval(&[("first", 1.0)]).unwrap_err();
        assert_eq!(said.first().message, "third has no value here");
    }

    #[test]
    fn values_only_have_no_derivative_but_where_they_do_not_enter() {
        let names = Names::new()
            .variables(["x", "y"])
            .function("f", |[x]: [f64; 1]| x * x);
        let mut f = evaluator("f(2) + x*y", &names);
        assert_eq!(f.gradient(&[3.0, 4.0]), Ok(vec![4.0, 3.0]));
        let mut f = evaluator("f(x) + y", &names);
        assert_eq!(f.eval(&[3.0, 4.0]), Ok(13.0));
        let said = f.gradient(&[3.0, 4.0]).unwrap_err();
        assert_eq!(said.first().message, "the derivatives of f are not known");
        assert_eq!(
            f.expr().compile(&Default::default()).unwrap_err().code(),
            "unfit_value"
        );
        let shared = SharedEvaluator::parse_with("f(x) + y", &names).unwrap();
        assert_eq!(shared.complaint(&[3.0, 4.0]).code, "no_derivative");
    }

    #[test]
    fn what_has_no_value_is_explained_by_the_name_of_the_function() {
        let names = Names::new()
            .variables(["x"])
            .define("root(a)", "SQRT(a)")
            .define("lost(a)", "IF(1: 0, 0, 5)*1 + 0*a")
            .function("f", |[x]: [f64; 1]| x.ln())
            .law("g", |[x]| x.ln());
        for (text, x, said) in [
            ("root(x)", -1.0, "in root: SQRT of -1 has no value"),
            (
                "f(x)",
                -2.0,
                "f(-2) has no value: it gives no finite number",
            ),
            (
                "1/g(x)",
                -2.0,
                "g(-2) has no value: it gives no finite number",
            ),
            // a value that is lost in a function has to be there all the same
            ("lost(SQRT(x))", -1.0, "SQRT of -1 has no value"),
        ] {
            let mut f = evaluator(text, &names);
            let found = f.eval(&[x]).unwrap_err().into_first();
            assert!(found.message.starts_with(said), "{text}: {}", found.message);
        }
        let error =
            Expr::parse_with("2 + root(-1)", &names).map(|e| e.compile(&Default::default()));
        let said = error.unwrap().unwrap_err();
        assert_eq!((said.code(), said.first().column), ("domain", 5), "{said}");
    }

    #[test]
    fn mistakes_in_names_are_told_at_once_and_with_near_names() {
        let names = Names::new()
            .variables(["x", "time", "2x", "x"])
            .constant("c", f64::NAN)
            .define("f", "x")
            .define("g(x)", "SIN(x")
            .function("h", |[]: [f64; 0]| 1.0);
        let error = Expr::parse_with("x", &names).unwrap_err();
        let said: Vec<&str> = error
            .diagnostics()
            .iter()
            .map(|d| d.message.as_str())
            .collect();
        let expected = [
            "time would hide a name of the language",
            "`2x` cannot be a name",
            "x is registered twice",
            "the constant c is NaN",
            "`f` is not the head of a function",
            "in the formula of g: the text ends inside SIN",
            "h takes 0 arguments; a function takes 1 to 64",
        ];
        assert_eq!(said, expected);

        let names = Names::new()
            .variables(["speed"])
            .define("hertz(x, k)", "k*x**1.5");
        for (text, message, help) in [
            (
                "hurtz(speed, 1)",
                "there is no function `hurtz`",
                "did you mean hertz?",
            ),
            (
                "hertz(speed)",
                "hertz takes 2 arguments, not 1",
                "it is written hertz(x, k)",
            ),
            (
                "hertz",
                "HERTZ needs its arguments in parentheses",
                "it is written hertz(x, k)",
            ),
            (
                "hertz(1, 2",
                "the text ends inside hertz",
                "it is written hertz(x, k)",
            ),
            (
                "speed(1)",
                "speed is a number, not a function",
                "multiplication is written speed*",
            ),
        ] {
            let error = Expr::parse_with(text, &names).unwrap_err();
            assert_eq!(error.first().message, message, "{text}");
            assert!(
                error.first().help[0].starts_with(help),
                "{text}: {:?}",
                error.first().help
            );
        }
    }

    #[test]
    fn formulas_that_call_each_other_without_end_are_refused() {
        let mut names = Names::new().variables(["x"]).define("f0(a)", "a + 1");
        for k in 1..40 {
            let (head, body) = (format!("f{k}(a)"), format!("f{}(f{}(a))", k - 1, k - 1));
            names = names.define(&head, &body);
        }
        let error = Expr::parse_with("f10(x)", &names).unwrap_err();
        assert_eq!(error.code(), "limit_length");
    }

    #[test]
    fn names_work_in_the_language_of_degrees() {
        let names = Names::of(Dialect::Expression)
            .variables(["x"])
            .define("f(a)", "sin(a) + t");
        let f = Expr::parse_with("f(x)", &names).unwrap();
        assert_eq!(f.eval(&[("x", 90.0), ("t", 1.0)]), Ok(2.0));
    }
}
