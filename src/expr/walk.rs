//! The walker: the reference evaluator, which evaluates a tree one node at a time.
//!
//! Programs are tested against it, and it explains: where there is no value it names the operation
//! on the taken path that has none, with its numbers. Only the selected branch of an IF is
//! evaluated. Division by zero, overflow and arguments outside a domain are errors here, never
//! infinities that propagate.
//!
//! The same walk with every input unknown finds the mistakes that can be known before any value is.

use super::ast::{Ast, BinaryOp, Callee, Constant, Node, NodeIx};
use super::compile::{constant_value, literal_value};
use super::functions::Function;
use super::interpolation::{Bindings, Interpolation};
use super::names::{Formula, Meaning};
use super::print::Digits;
use super::program::{Input, Sym};
use crate::diagnostic::{Cause, Diagnostic, Span};
use crate::scalar::Scalar;

/// The source of the numbers and data that an expression reads.
pub trait Host {
    /// Returns the value of an input, or `None` when it has none here.
    fn input(&self, input: Input) -> Option<f64>;
    /// Returns the splines and curves that may be named, if there are any.
    fn bindings(&self) -> Option<&Bindings> {
        None
    }
}

/// A closure that gives inputs is a host without curves.
impl<F: Fn(Input) -> Option<f64>> Host for F {
    fn input(&self, input: Input) -> Option<f64> {
        self(input)
    }
}

/// The host of a formula: its arguments are its variables.
struct Inside<'a> {
    args: &'a [f64],
    host: &'a dyn Host,
}

impl Host for Inside<'_> {
    fn input(&self, input: Input) -> Option<f64> {
        match input {
            Input::Slot(k) => self.args.get(k as usize).copied(),
            _ => self.host.input(input),
        }
    }
    fn bindings(&self) -> Option<&Bindings> {
        self.host.bindings()
    }
}

/// The reason why an expression has no value.
#[derive(Clone, Debug, PartialEq)]
pub struct Trouble {
    /// `domain`, `missing_value`, `needs_history`, `unknown_element` or `out_of_range`
    pub code: &'static str,
    /// the node that has no value
    pub node: NodeIx,
    /// its place in the text
    pub span: Span,
    /// sentence that names the cause, with the numbers
    pub message: String,
    /// advice
    pub help: Vec<String>,
}

impl Trouble {
    /// Converts to a diagnostic about the text of the tree.
    pub fn diagnostic(&self, text: &str) -> Diagnostic {
        let mut said = super::advice::at(text, self.code, self.message.clone(), self.span);
        said.help = self.help.clone();
        said
    }
}

/// Evaluates an expression.
///
/// # Errors
/// The first operation on the taken path that has no value.
pub fn value(ast: &Ast, host: &dyn Host) -> Result<f64, Trouble> {
    Walk::new(ast, Some(host)).run(|_, _| ())
}

/// Returns the value of every node on the taken path, and `None` for the others; that of the root
/// belongs to the whole expression.
///
/// # Errors
/// The first operation on the taken path that has no value.
pub fn values(ast: &Ast, host: &dyn Host) -> Result<Vec<Option<f64>>, Trouble> {
    let mut values = vec![None; ast.nodes.len()];
    Walk::new(ast, Some(host)).run(|ix, value| values[ix as usize] = Some(value))?;
    Ok(values)
}

/// Looks for operations that have no value for any inputs, on paths that are certainly taken.
///
/// # Errors
/// The first such operation.
pub fn check_constants(ast: &Ast) -> Result<(), Trouble> {
    Walk::new(ast, None).run(|_, _| ()).map(|_| ())
}

/// A task that remains to be done.
enum Task {
    Evaluate(NodeIx),
    /// the operands are on the stack of values
    Apply(NodeIx),
    /// the selector is on the stack of values
    Choose(NodeIx),
    /// the value of the branch is on the stack of values
    Chosen(NodeIx),
}

struct Walk<'a> {
    ast: &'a Ast,
    /// absent when all inputs are unknown; an unknown number is NaN
    host: Option<&'a dyn Host>,
    /// tasks that remain, last first
    tasks: Vec<Task>,
    /// values of finished operands
    values: Vec<f64>,
}

impl<'a> Walk<'a> {
    fn new(ast: &'a Ast, host: Option<&'a dyn Host>) -> Self {
        Self {
            ast,
            host,
            tasks: vec![Task::Evaluate(ast.root)],
            values: Vec::new(),
        }
    }

    /// Walks the tree; calls `found` with the value of every node on the taken path.
    fn run(mut self, mut found: impl FnMut(NodeIx, f64)) -> Result<f64, Trouble> {
        while let Some(task) = self.tasks.pop() {
            let (ix, value) = match task {
                Task::Evaluate(ix) => match self.begin(ix)? {
                    Some(value) => (ix, value),
                    None => continue,
                },
                Task::Choose(ix) => {
                    self.choose(ix);
                    continue;
                }
                Task::Apply(ix) => (ix, self.apply(ix)?),
                Task::Chosen(ix) => (ix, self.values.pop().unwrap_or(f64::NAN)),
            };
            found(ix, value);
            self.values.push(value);
        }
        Ok(self.values.pop().unwrap_or(f64::NAN))
    }

    /// Pushes the value of a leaf, or the tasks of a node.
    fn begin(&mut self, ix: NodeIx) -> Result<Option<f64>, Trouble> {
        match *self.ast.node(ix) {
            Node::Number { literal, degrees } => {
                let value = literal_value(literal, degrees);
                return if value.is_finite() {
                    Ok(Some(value))
                } else {
                    Err(self.out_of_domain(ix, &[value]))
                };
            }
            Node::Constant(c) => return self.constant(ix, c).map(Some),
            Node::Negate(x) | Node::Plus(x) => {
                self.tasks.extend([Task::Apply(ix), Task::Evaluate(x)])
            }
            Node::Binary(_, a, b) => {
                self.tasks
                    .extend([Task::Apply(ix), Task::Evaluate(b), Task::Evaluate(a)])
            }
            Node::If { selector, .. } => self
                .tasks
                .extend([Task::Choose(ix), Task::Evaluate(selector)]),
            Node::Call {
                callee: Callee::Measure(m),
                ..
            } => {
                let input = self.ast.input(ix).unwrap_or(Input::Measure(m, [0; 4]));
                return self.input(ix, input).map(Some);
            }
            Node::Call {
                callee: Callee::Function(Function::Delay),
                ..
            } => return self.delayed(ix).map(Some),
            Node::Named { ref args, .. } if args.is_empty() => {
                return self.named(ix).map(Some);
            }
            Node::Call { ref args, .. } | Node::Named { ref args, .. } => {
                self.tasks.push(Task::Apply(ix));
                self.tasks
                    .extend(args.iter().rev().map(|&arg| Task::Evaluate(arg)));
            }
        }
        Ok(None)
    }

    fn constant(&self, ix: NodeIx, c: Constant) -> Result<f64, Trouble> {
        match (constant_value(c), c) {
            (Some(value), _) => Ok(value),
            (None, Constant::Mode) => self.input(ix, Input::Mode),
            (None, _) => self.input(ix, Input::Time),
        }
    }

    /// Reads an input from the host.
    fn input(&self, ix: NodeIx, input: Input) -> Result<f64, Trouble> {
        let Some(host) = self.host else {
            return Ok(f64::NAN);
        };
        match host.input(input) {
            Some(value) if value.is_finite() => Ok(value),
            Some(value) => Err(self.trouble(
                Cause::Domain.code(),
                ix,
                format!("{} is {value}", self.ast.written(ix)),
            )),
            None => Err(self.trouble(
                Cause::MissingValue.code(),
                ix,
                format!("{} has no value here", self.ast.written(ix)),
            )),
        }
    }

    /// Reads a delayed value from the host, which alone keeps the past.
    fn delayed(&self, ix: NodeIx) -> Result<f64, Trouble> {
        let Some(host) = self.host else {
            return Ok(f64::NAN);
        };
        let delays = self.ast.delays();
        let number = delays.iter().find(|d| d.0 == ix).map_or(0, |d| d.1);
        match host.input(Input::Delayed(number)) {
            Some(value) if value.is_finite() => Ok(value),
            Some(value) => Err(self.trouble(
                Cause::Domain.code(),
                ix,
                format!("{} is {value}", self.ast.written(ix)),
            )),
            None => {
                let past = "DELAY needs the values of the past".to_string();
                let mut trouble = self.trouble("needs_history", ix, past);
                let help = "a simulation keeps them; a single evaluation has none";
                trouble.help.push(help.to_string());
                Err(trouble)
            }
        }
    }

    /// Selects the branch of an IF; when the selector is unknown no branch is taken, and the value
    /// is unknown.
    fn choose(&mut self, ix: NodeIx) {
        let Node::If {
            negative,
            zero,
            positive,
            ..
        } = *self.ast.node(ix)
        else {
            return;
        };
        let selector = self.values.pop().unwrap_or(f64::NAN);
        if selector.is_nan() {
            self.values.push(f64::NAN);
            self.tasks.push(Task::Chosen(ix));
            return;
        }
        let branch = if selector < 0.0 {
            negative
        } else if selector > 0.0 {
            positive
        } else {
            zero
        };
        self.tasks
            .extend([Task::Chosen(ix), Task::Evaluate(branch)]);
    }

    /// Evaluates an operation on the numbers at the end of the stack.
    fn apply(&mut self, ix: NodeIx) -> Result<f64, Trouble> {
        let count = match self.ast.node(ix) {
            Node::Call { args, .. } | Node::Named { args, .. } => args.len(),
            Node::Binary(..) => 2,
            _ => 1,
        };
        let first = self.values.len().saturating_sub(count);
        let value = self.operation(ix, &self.values[first..])?;
        self.values.truncate(first);
        Ok(value)
    }

    /// Evaluates a node that is not an IF on its operands.
    fn operation(&self, ix: NodeIx, operands: &[f64]) -> Result<f64, Trouble> {
        let value = match (self.ast.node(ix), operands) {
            (Node::Negate(_), &[x]) => -x,
            (Node::Plus(_), &[x]) => x,
            (Node::Binary(BinaryOp::Div, ..), &[_, 0.0]) => {
                return Err(self.out_of_domain(ix, operands));
            }
            (Node::Binary(op, ..), &[a, b]) => op.apply(a, b),
            (
                Node::Call {
                    callee: Callee::Function(f),
                    ..
                },
                args,
            ) => match f.violation(args) {
                Some(_) => return Err(self.out_of_domain(ix, operands)),
                None => f.eval(args),
            },
            (
                &Node::Call {
                    callee: Callee::Interpolation(f),
                    ..
                },
                args,
            ) => match self.host {
                Some(host) => self.interpolated(ix, f, args, host)?,
                None => return Ok(f64::NAN),
            },
            (&Node::Named { entry, .. }, args) => self.called(ix, entry, args)?,
            _ => f64::NAN,
        };
        if operands.iter().any(|x| x.is_nan()) {
            return Ok(f64::NAN);
        }
        let is_closure = matches!(self.ast.node(ix), Node::Named { .. });
        if value.is_finite() || (is_closure && self.host.is_none()) {
            Ok(value)
        } else {
            Err(self.out_of_domain(ix, operands))
        }
    }

    /// Evaluates a variable or a constant of the caller's own.
    fn named(&self, ix: NodeIx) -> Result<f64, Trouble> {
        match (self.ast.input(ix), self.ast.node(ix)) {
            (Some(input), _) => self.input(ix, input),
            (None, Node::Named { entry, .. }) => match self.ast.names.entry(*entry).meaning {
                Meaning::Constant(c) => Ok(c),
                _ => Ok(f64::NAN),
            },
            _ => Ok(f64::NAN),
        }
    }

    /// Evaluates a function of the caller's own. Where inputs are unknown it is not called.
    fn called(&self, ix: NodeIx, entry: u32, args: &[f64]) -> Result<f64, Trouble> {
        let Some(host) = self.host.filter(|_| !args.iter().any(|x| x.is_nan())) else {
            return Ok(f64::NAN);
        };
        let entry = self.ast.names.entry(entry);
        match &entry.meaning {
            Meaning::Variable(_) | Meaning::Constant(_) => Ok(f64::NAN),
            Meaning::Numeric(function) => Ok((function.closure)(args, &mut [])),
            Meaning::Law(law) => {
                let args: Vec<Sym> = args.iter().map(|&x| Sym::Constant(x)).collect();
                match law(&args) {
                    Sym::Constant(value) => Ok(value),
                    Sym::Recorded(..) => unreachable!("a law of numbers records nothing"),
                }
            }
            Meaning::Formula(Formula { body, .. }) => {
                value(body, &Inside { args, host }).map_err(|trouble| {
                    let message = format!("in {}: {}", entry.name, trouble.message);
                    let mut here = self.trouble(trouble.code, ix, message);
                    here.help = trouble.help;
                    here
                })
            }
        }
    }

    /// Evaluates a call over data.
    fn interpolated(
        &self,
        ix: NodeIx,
        function: Interpolation,
        args: &[f64],
        host: &dyn Host,
    ) -> Result<f64, Trouble> {
        let empty = Bindings::default();
        match host.bindings().unwrap_or(&empty).bind(function, args) {
            Ok(bound) => Ok(bound.eval(args)),
            Err(said) => {
                let culprit = self.culprit(ix, said.is(Cause::UnknownElement));
                let mut trouble = self.trouble(said.code, culprit, said.message);
                trouble.help = said.help;
                Err(trouble)
            }
        }
    }

    /// Returns the argument of a call over data that a mistake is about: the identifier, or the
    /// order.
    fn culprit(&self, ix: NodeIx, is_unknown: bool) -> NodeIx {
        let Node::Call {
            callee: Callee::Interpolation(f),
            ref args,
        } = *self.ast.node(ix)
        else {
            return ix;
        };
        let place = match (f, is_unknown) {
            (Interpolation::Curve, true) => 3,
            (Interpolation::Invpsd, true) => 1,
            (_, true) => 2,
            (Interpolation::Akispl | Interpolation::Cubspl | Interpolation::Interp, _) => 3,
            _ => return ix,
        };
        args.get(place).copied().unwrap_or(ix)
    }

    /// Creates the trouble of a node.
    fn trouble(&self, code: &'static str, node: NodeIx, message: String) -> Trouble {
        let span = self
            .ast
            .spans
            .get(node as usize)
            .copied()
            .unwrap_or_default();
        Trouble {
            code,
            node,
            span,
            message,
            help: Vec::new(),
        }
    }

    /// Composes the sentence of a mistake: the operation with its numbers, the reason, and the
    /// time.
    fn out_of_domain(&self, ix: NodeIx, operands: &[f64]) -> Trouble {
        let shown = |x: &f64| {
            if x.is_nan() {
                "…".to_string()
            } else {
                Digits(*x).to_string()
            }
        };
        let list = || operands.iter().map(shown).collect::<Vec<_>>().join(", ");
        let (what, why) = match (self.ast.node(ix), operands) {
            (Node::Binary(op, ..), [a, b]) => {
                let why = match op {
                    BinaryOp::Div if *b == 0.0 => "division by zero",
                    BinaryOp::Pow if *a == 0.0 => "zero has no power with a negative exponent",
                    BinaryOp::Pow if *a < 0.0 && b.fract() != 0.0 => {
                        "a negative number has whole powers only"
                    }
                    _ => "too large for a number",
                };
                (format!("{} {} {}", shown(a), op.symbol(), shown(b)), why)
            }
            (
                Node::Call {
                    callee: Callee::Function(f),
                    ..
                },
                args,
            ) => {
                let what = match args {
                    [x] => format!("{} of {}", f.name(), shown(x)),
                    _ => format!("{}({})", f.name(), list()),
                };
                (what, f.violation(args).unwrap_or("too large for a number"))
            }
            (Node::Call { callee, .. }, _) => (
                format!("{}({})", callee.name(), list()),
                "outside the curve",
            ),
            (&Node::Named { entry, .. }, _) => (
                format!("{}({})", self.ast.names.entry(entry).name, list()),
                "it gives no finite number",
            ),
            _ => (list(), "not a number"),
        };
        let when = match self.host.and_then(|host| host.input(Input::Time)) {
            Some(time) => format!(
                " at {} = {}",
                Constant::Time.name(self.ast.dialect),
                Digits(time)
            ),
            None => String::new(),
        };
        let mut trouble = self.trouble(
            Cause::Domain.code(),
            ix,
            format!("{what} has no value{when}: {why}"),
        );
        trouble.help.extend(self.step_in_order(ix, operands));
        trouble.help.extend(self.stops_in_order(ix, operands));
        trouble
    }

    /// Writes a BISTOP anew whose upper stop stands before its lower one.
    fn stops_in_order(&self, ix: NodeIx, operands: &[f64]) -> Option<String> {
        let Node::Call {
            callee: Callee::Function(Function::Bistop),
            ref args,
        } = *self.ast.node(ix)
        else {
            return None;
        };
        let (&[x, rate, x1, x2, ref law @ ..], &[_, _, from, to, ..]) = (args.as_slice(), operands)
        else {
            return None;
        };
        let written = [x, rate, x2, x1].into_iter().chain(law.iter().copied());
        let written: Vec<String> = written.map(|arg| self.ast.written(arg)).collect();
        if from > to {
            let call = written.join(", ");
            Some(format!("the lower stop stands first: BISTOP({call})"))
        } else if from == to {
            Some("two stops at one place leave no way between them: a JOINT or a spring holds it there".into())
        } else {
            None
        }
    }

    /// Writes a step anew whose second place stands before its first; a HAVSIN in the order of its
    /// dialog, too: begin, end, initial, final.
    fn step_in_order(&self, ix: NodeIx, operands: &[f64]) -> Option<String> {
        let Node::Call {
            callee: Callee::Function(f @ (Function::Step | Function::Step5 | Function::Havsin)),
            ref args,
        } = *self.ast.node(ix)
        else {
            return None;
        };
        let (&[x, x0, h0, x1, h1], &[_, from, height, to, _]) = (args.as_slice(), operands) else {
            return None;
        };
        let [x, x0, h0, x1, h1] = [x, x0, h0, x1, h1].map(|arg| self.ast.written(arg));
        let name = f.name();
        if f == Function::Havsin && from >= to && from < height {
            Some(format!(
                "it is read {}: what begins at {x0} and ends at {h0} is written {name}({x}, {x0}, {x1}, {h0}, {h1})",
                f.signature()
            ))
        } else if from > to {
            Some(format!(
                "the earlier place stands first: {name}({x}, {x1}, {h1}, {x0}, {h0})"
            ))
        } else if from == to {
            Some(format!(
                "a jump is written IF({x} - {x0}: {h0}, {h1}, {h1})"
            ))
        } else {
            None
        }
    }
}

impl BinaryOp {
    /// Evaluates the operator for two numbers.
    fn apply(self, a: f64, b: f64) -> f64 {
        match self {
            BinaryOp::Add => a + b,
            BinaryOp::Sub => a - b,
            BinaryOp::Mul => a * b,
            BinaryOp::Div => a / b,
            BinaryOp::Pow => Scalar::powf(a, b),
        }
    }
}

impl Ast {
    /// Prints a node as it would be written.
    pub fn written(&self, ix: NodeIx) -> String {
        super::print::Written { ast: self, ix }.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::super::ast::Dialect;
    use super::super::{Profile, parse};
    use super::*;

    fn tree(text: &str) -> Ast {
        parse(text, Dialect::Function, Profile::Adams).unwrap_or_else(|e| panic!("{text}: {e}"))
    }
    fn at(text: &str, time: f64) -> Result<f64, Trouble> {
        value(&tree(text), &|input| (input == Input::Time).then_some(time))
    }

    #[test]
    fn only_the_selected_branch_is_looked_at() {
        let text = "IF(TIME-1: SQRT(1-TIME), 1/0*0, SQRT(TIME-1))";
        assert_eq!(at(text, 0.75), Ok(0.5));
        assert_eq!(at(text, 1.25), Ok(0.5));
        assert_eq!(
            at(text, 1.0).unwrap_err().message,
            "1 / 0 has no value at TIME = 1: division by zero"
        );
        assert_eq!(at("IF(-0.0: 1, 2, 3)", 0.0), Ok(2.0));
    }

    #[test]
    fn what_has_no_value_is_named_with_its_numbers() {
        for (text, message) in [
            (
                "2*LOG(TIME-1.5)",
                "LOG of -0.5 has no value at TIME = 1: LOG takes positive numbers",
            ),
            (
                "ATAN2(TIME-1,0)",
                "ATAN2(0, 0) has no value at TIME = 1: the point (0, 0) has no angle",
            ),
            (
                "(TIME-2)**0.5",
                "-1 ** 0.5 has no value at TIME = 1: a negative number has whole powers only",
            ),
            (
                "EXP(1000*TIME)",
                "EXP of 1000 has no value at TIME = 1: too large for a number",
            ),
            (
                "1E300*(TIME*1E10)",
                "1E300 * 10000000000 has no value at TIME = 1: too large for a number",
            ),
        ] {
            let said = at(text, 1.0).unwrap_err();
            assert_eq!(said.code, "domain");
            assert!(
                said.message.starts_with(message),
                "{text}: {}",
                said.message
            );
        }
    }

    #[test]
    fn infinities_do_not_travel_on() {
        assert_eq!(at("ATAN(1/(TIME-1))", 1.0).unwrap_err().code, "domain");
        assert_eq!(at("1/EXP(1000*TIME)", 1.0).unwrap_err().code, "domain");
    }

    #[test]
    fn mistakes_of_constants_are_found_where_they_are_certain() {
        for (text, column) in [
            ("TIME/0", 5),
            ("STEP(TIME,1,0,1,1)", 1),
            ("IF(1/0: 1, 2, 3)", 5),
            ("IF(1: 2, 3, 4/0)", 14),
            ("MOD(TIME,0)", 1),
        ] {
            let found = check_constants(&tree(text)).unwrap_err();
            assert_eq!(
                (found.code, found.span.start + 1),
                ("domain", column),
                "{text}"
            );
        }
        for text in [
            "IF(TIME: 1/0, 2, 3)",
            "IF(1: 2/0, 3/0, 4)",
            "STEP(TIME,TIME,0,1,1)",
            "SQRT(DX(1)-5)",
            "AKISPL(1,0,1)",
        ] {
            assert_eq!(check_constants(&tree(text)), Ok(()), "{text}");
        }
    }

    #[test]
    fn what_a_host_lacks_is_named() {
        let said = at("TIME+DX(1, 02, 0)", 1.0).unwrap_err();
        assert_eq!((said.code, said.span.start), ("missing_value", 5));
        assert_eq!(said.message, "DX(1, 2, 0) has no value here");
        assert_eq!(
            at("DELAY(TIME,0.5,0)", 1.0).unwrap_err().code,
            "needs_history"
        );
        let said = at("2*AKISPL(TIME,0,7)", 1.0).unwrap_err();
        assert_eq!((said.code, said.span.start), ("unknown_element", 16));
    }

    #[test]
    fn values_are_told_for_what_was_looked_at() {
        let ast = tree("IF(TIME: 1, 2, 3)+4");
        let found = values(&ast, &|_| Some(1.0)).unwrap();
        let shown: Vec<Option<f64>> = (0..)
            .zip(found)
            .filter(|(ix, _)| ast.written(*ix).len() == 1)
            .map(|(_, v)| v)
            .collect();
        assert_eq!(shown, [None, None, Some(3.0), Some(4.0)]);
    }
}
