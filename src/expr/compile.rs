//! The compiler from trees to straight-line code: names resolved, constants folded, equal parts
//! shared across all expressions.
//!
//! A [`Compiler`] takes one [`Ast`] after the other; common parts are computed once. Nothing is
//! rearranged: the program yields the same bits as the walker. Functions with a body longer than
//! one operation stay one operation, so that the machine can run them with their constants
//! prepared; the others expand into operations.

use super::ast::{Ast, BinaryOp as Written, Callee, Constant, Node, NodeIx};
use super::finite;
use super::functions::{Family, Function};
use super::interpolation::Bindings;
use super::names::{Meaning, Numeric};
use super::program::{BinaryOp, Builder, Folding, Input, Program, Sym, UnaryOp, Value};
use crate::diagnostic::{Cause, Diagnostic, Span};
use std::cell::RefCell;
use std::f64::consts::PI;

/// Times the smallest number above zero, a number whose reciprocal is finite: 2⁶⁴.
const LARGE: f64 = 18_446_744_073_709_551_616.0;

/// A value of the past that a program reads as [`Input::Delayed`]:
/// `DELAY(expression, delay, history, options)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Delay {
    /// the delayed expression
    pub expression: Value,
    /// the delay, in time units; less than 0 counts as 0
    pub delay: Value,
    /// the value before the start
    pub history: Value,
    /// identifier of the array of options, 0 for none
    pub options: u32,
}

/// A compiler of expressions that share their parts.
///
/// ```ignore
/// let mut compiler = Compiler::new(&bindings);
/// let outputs = asts.iter().map(|ast| compiler.add(ast)).collect::<Result<Vec<_>, _>>()?;
/// let program = compiler.finish(&outputs);
/// ```
#[derive(Debug)]
pub struct Compiler<'a> {
    bindings: &'a Bindings,
    /// operations recorded so far
    builder: RefCell<Builder>,
    delays: Vec<Delay>,
    calls: Vec<NamedCall>,
    /// slots of the variables; those of the calls follow
    n_variables: usize,
}

/// A call of a function of the caller's own that is known by its numbers only. A program reads its
/// value as the slot behind the variables and the calls before it.
#[derive(Clone, Debug)]
pub(super) struct NamedCall {
    pub name: String,
    pub function: Numeric,
    pub args: Vec<Value>,
    /// the input that stands for its value
    pub input: Input,
}

/// Compiles some expressions into a program with one output each.
///
/// # Errors
///
/// Those of [`Compiler::add`].
pub fn compile(asts: &[&Ast], bindings: &Bindings) -> Result<Program, Diagnostic> {
    let mut compiler = Compiler::new(bindings);
    let outputs = asts
        .iter()
        .map(|ast| compiler.add(ast))
        .collect::<Result<Vec<_>, _>>()?;
    Ok(compiler.finish(&outputs))
}

/// Returns the value of a literal; the suffix D makes it degrees.
pub fn literal_value(literal: f64, degrees: bool) -> f64 {
    if degrees {
        literal * PI / 180.0
    } else {
        literal
    }
}

/// Returns the value of a named number, or `None` if it is the host's.
pub fn constant_value(constant: Constant) -> Option<f64> {
    match constant {
        Constant::Pi => Some(PI),
        Constant::Dtor => Some(PI / 180.0),
        Constant::Rtod => Some(180.0 / PI),
        Constant::Time | Constant::Mode => None,
    }
}

impl<'a> Compiler<'a> {
    /// Creates a compiler that finds splines and curves in `bindings`.
    pub fn new(bindings: &'a Bindings) -> Self {
        Self {
            bindings,
            builder: RefCell::new(Builder::new(Folding::Strict)),
            delays: Vec::new(),
            calls: Vec::new(),
            n_variables: 0,
        }
    }

    /// Returns the recorded operations, so that derivatives or other operations can be added.
    pub fn builder(&self) -> &RefCell<Builder> {
        &self.builder
    }
    /// Returns the delayed values that were read so far; the `k`-th is [`Input::Delayed`]`(k)`.
    pub fn delays(&self) -> &[Delay] {
        &self.delays
    }
    /// Returns the calls of functions that are known by their numbers only, each behind those that
    /// its arguments read.
    pub(super) fn calls(&self) -> &[NamedCall] {
        &self.calls
    }
    /// Returns the program of these values. Variables of the caller's own are inputs of it, also
    /// where it does not read them.
    pub fn finish(&self, outputs: &[Value]) -> Program {
        let builder = self.builder.borrow();
        match self.n_variables + self.calls.len() {
            0 => builder.finish(outputs),
            _ => builder.finish_with_inputs(outputs, builder.inputs()),
        }
    }

    /// Records an expression, sharing equal parts with earlier ones.
    ///
    /// # Errors
    ///
    /// `unknown_element` for a spline or curve that is not bound, `domain` where a part outside
    /// every IF has no value for any inputs. The span is that of the operator or function name.
    pub fn add(&mut self, ast: &Ast) -> Result<Value, Diagnostic> {
        // variables come first among the inputs, in the order of the caller
        self.n_variables = ast.names.variable_names().count();
        let variables: Vec<Value> = (0..self.n_variables as u32)
            .map(|k| self.builder.get_mut().input(Input::Slot(k)))
            .collect();
        self.record(ast, &variables, Reach::Always)
    }

    /// Records an expression for these values of its variables, under this condition.
    fn record(
        &mut self,
        ast: &Ast,
        variables: &[Value],
        reach: Reach,
    ) -> Result<Value, Diagnostic> {
        let conditional = conditional(ast, reach);
        let risks = finite::risks(ast);
        let mut values: Vec<Option<Value>> = Vec::with_capacity(ast.nodes.len());
        for (k, node) in ast.nodes.iter().enumerate() {
            let span = ast.spans.get(k).copied().unwrap_or_default();
            let value = match conditional[k] {
                Reach::Never => None,
                reach => {
                    let always = reach == Reach::Always;
                    let recorded = match *node {
                        Node::Named { entry, ref args } => {
                            self.named(ast, entry, args, variables, &values, reach)
                        }
                        _ => self.node(node, &values, always),
                    };
                    let mut value = recorded.map_err(|d| place(d, span))?;
                    let is_same = |a: NodeIx, b: NodeIx| values[a as usize] == values[b as usize];
                    finite::watched(ast, node, &risks, is_same, |operand| {
                        if let Some(&Some(x)) = values.get(operand as usize) {
                            value = self.builder.get_mut().binary(BinaryOp::Kept, value, x);
                        }
                    });
                    match self.builder.get_mut().constant_of(value) {
                        Some(c) if always && !c.is_finite() => {
                            return Err(place(not_finite(node, c), span));
                        }
                        _ => Some(value),
                    }
                }
            };
            values.push(value);
        }
        match values.get(ast.root as usize) {
            Some(&Some(value)) => Ok(value),
            _ => Err(Diagnostic::error(
                Cause::UnexpectedEnd,
                "the expression is empty",
            )),
        }
    }

    /// Records a node whose operands are recorded. `always`: it is evaluated for all inputs.
    fn node(
        &mut self,
        node: &Node,
        values: &[Option<Value>],
        always: bool,
    ) -> Result<Value, Diagnostic> {
        let of = |ix: NodeIx| operand(values, ix);
        Ok(match *node {
            Node::Number { literal, degrees } => self
                .builder
                .get_mut()
                .constant(literal_value(literal, degrees)),
            Node::Constant(constant) => match (constant_value(constant), constant) {
                (Some(c), _) => self.builder.get_mut().constant(c),
                (None, Constant::Mode) => self.builder.get_mut().input(Input::Mode),
                (None, _) => self.builder.get_mut().input(Input::Time),
            },
            Node::Negate(x) => self.builder.get_mut().unary(UnaryOp::Neg, of(x)?),
            Node::Plus(x) => of(x)?,
            Node::Binary(op, a, b) => {
                let (a, b) = (of(a)?, of(b)?);
                let builder = self.builder.get_mut();
                if always && op == Written::Div && builder.constant_of(b) == Some(0.0) {
                    return Err(domain("division by zero"));
                }
                let value = builder.binary(operation(op), a, b);
                match op {
                    // recorded equations take 0/x for 0 and x/x for 1, at x = 0 too; x is made
                    // large, as 1/x alone is infinite for the smallest numbers as well
                    Written::Div if a == b || builder.constant_of(a) == Some(0.0) => {
                        let (one, large) = (builder.constant(1.0), builder.constant(LARGE));
                        let enlarged = builder.binary(BinaryOp::Mul, b, large);
                        let reciprocal = builder.binary(BinaryOp::Div, one, enlarged);
                        builder.binary(BinaryOp::Kept, value, reciprocal)
                    }
                    _ => value,
                }
            }
            Node::If {
                selector,
                negative,
                zero,
                positive,
            } => {
                let [selector, negative, zero, positive] =
                    [of(selector)?, of(negative)?, of(zero)?, of(positive)?];
                self.builder
                    .get_mut()
                    .arithmetic_if(selector, negative, zero, positive)
            }
            Node::Call { callee, ref args } => {
                let args = args.iter().map(|&a| of(a)).collect::<Result<Vec<_>, _>>()?;
                self.call(callee, &args, always)?
            }
            Node::Named { .. } => unreachable!("names of a caller are recorded with their tree"),
        })
    }

    /// Records a variable, a constant or a call of the caller's own.
    fn named(
        &mut self,
        ast: &Ast,
        entry: u32,
        args: &[NodeIx],
        variables: &[Value],
        values: &[Option<Value>],
        reach: Reach,
    ) -> Result<Value, Diagnostic> {
        let args = args.iter().map(|&a| operand(values, a));
        let args = args.collect::<Result<Vec<_>, _>>()?;
        let of = ast.names.entry(entry);
        match &of.meaning {
            Meaning::Constant(c) => Ok(self.builder.get_mut().constant(*c)),
            Meaning::Variable(k) => Ok(variables[*k as usize]),
            Meaning::Law(law) => Ok(self.expand(&args, |args| law(args))),
            Meaning::Formula(formula) => {
                self.record(&formula.body, &args, reach).map_err(|said| {
                    let message = format!("in {}: {}", of.name, said.message);
                    // the place is that of the call
                    let span = None;
                    Diagnostic {
                        message,
                        span,
                        ..said
                    }
                })
            }
            Meaning::Numeric(function) => {
                let input = self.numeric(&of.name, function, args);
                Ok(self.builder.get_mut().input(input))
            }
        }
    }

    /// Returns the input that stands for a function of which only numbers are known; equal calls
    /// share one.
    fn numeric(&mut self, name: &str, function: &Numeric, args: Vec<Value>) -> Input {
        let is_it = |c: &&NamedCall| c.function.is(function) && c.args == args;
        if let Some(call) = self.calls.iter().find(is_it) {
            return call.input;
        }
        let input = Input::Slot((self.n_variables + self.calls.len()) as u32);
        self.calls.push(NamedCall {
            name: name.to_string(),
            function: function.clone(),
            args,
            input,
        });
        input
    }

    /// Records a call.
    fn call(&mut self, callee: Callee, args: &[Value], always: bool) -> Result<Value, Diagnostic> {
        let builder = self.builder.get_mut();
        let known: Vec<f64> = args
            .iter()
            .map(|&a| builder.constant_of(a).unwrap_or(f64::NAN))
            .collect();
        match callee {
            Callee::Function(Function::Delay) => Ok(self.delay(args, &known)),
            Callee::Function(function) => {
                if let (true, Some(reason)) = (always, function.violation(&known)) {
                    return Err(domain(reason));
                }
                Ok(self.function(function, args))
            }
            Callee::Measure(measure) => {
                let mut ids = [0; 4];
                for (id, &x) in ids.iter_mut().zip(&known) {
                    // the parser has checked the literal; `as` saturates
                    *id = x as u32;
                }
                Ok(builder.input(Input::Measure(measure, ids)))
            }
            Callee::Interpolation(interpolation) => {
                let bound = self.bindings.bind(interpolation, &known)?;
                Ok(self.expand(args, |args| bound.eval(args)))
            }
        }
    }

    /// Records a function as one operation where that pays, else as the operations of its body.
    fn function(&mut self, function: Function, args: &[Value]) -> Value {
        let builder = self.builder.get_mut();
        match function {
            // MAX(a, b, c) is MAX(MAX(a, b), c)
            Function::Max | Function::Min if args.len() > 2 => {
                let first = builder.call(function, &args[..2]);
                args[2..]
                    .iter()
                    .fold(first, |m, &x| builder.call(function, &[m, x]))
            }
            Function::Max | Function::Min | Function::Atan2 | Function::Dim | Function::Sign => {
                builder.call(function, args)
            }
            Function::Shf => self.expand(args, |args| function.eval(args)),
            _ if function.row().family == Family::Utility => builder.call(function, args),
            _ => self.expand(args, |args| function.eval(args)),
        }
    }

    /// Records the operations of a formula on these values.
    fn expand(&mut self, args: &[Value], formula: impl for<'b> Fn(&[Sym<'b>]) -> Sym<'b>) -> Value {
        let result = {
            let args: Vec<Sym> = args.iter().map(|&a| Sym::of(a, &self.builder)).collect();
            match formula(&args) {
                Sym::Recorded(value, _) => Ok(value),
                Sym::Constant(c) => Err(c),
            }
        };
        result.unwrap_or_else(|c| self.builder.get_mut().constant(c))
    }

    /// Records a call of DELAY as an input of the past.
    fn delay(&mut self, args: &[Value], known: &[f64]) -> Value {
        let &[expression, delay, history, ..] = args else {
            return self.builder.get_mut().constant(f64::NAN);
        };
        let options = known.get(3).map_or(0, |&x| x as u32);
        let wanted = Delay {
            expression,
            delay,
            history,
            options,
        };
        let k = self
            .delays
            .iter()
            .position(|d| *d == wanted)
            .unwrap_or_else(|| {
                self.delays.push(wanted);
                self.delays.len() - 1
            });
        self.builder.get_mut().input(Input::Delayed(k as u32))
    }
}

/// The conditions under which a node is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Reach {
    /// never: it does not belong to the expression
    Never,
    /// sometimes: it stands in a branch of an IF
    Sometimes,
    Always,
}

/// Returns for each node when it is evaluated, in an expression that is evaluated so as a `whole`.
fn conditional(ast: &Ast, whole: Reach) -> Vec<Reach> {
    let mut reach = vec![Reach::Never; ast.nodes.len()];
    if let Some(root) = reach.get_mut(ast.root as usize) {
        *root = whole;
    }
    for k in (0..ast.nodes.len()).rev() {
        let here = reach[k];
        if here == Reach::Never {
            continue;
        }
        let mut mark = |ix: NodeIx, when: Reach| {
            if let Some(r) = reach.get_mut(ix as usize) {
                *r = (*r).max(when);
            }
        };
        match &ast.nodes[k] {
            Node::Number { .. } | Node::Constant(_) => {}
            Node::Negate(x) | Node::Plus(x) => mark(*x, here),
            Node::Binary(_, a, b) => {
                mark(*a, here);
                mark(*b, here);
            }
            Node::If {
                selector,
                negative,
                zero,
                positive,
            } => {
                mark(*selector, here);
                for branch in [negative, zero, positive] {
                    mark(*branch, Reach::Sometimes);
                }
            }
            Node::Call { args, .. } | Node::Named { args, .. } => {
                args.iter().for_each(|&a| mark(a, here));
            }
        }
    }
    reach
}

/// Returns the value of an operand, which stands before its operator.
fn operand(values: &[Option<Value>], ix: NodeIx) -> Result<Value, Diagnostic> {
    let value = values.get(ix as usize).copied().flatten();
    value.ok_or_else(|| {
        Diagnostic::error("unexpected_token", "an operand stands after its operator")
    })
}

/// Returns the operation of an operator.
fn operation(op: Written) -> BinaryOp {
    match op {
        Written::Add => BinaryOp::Add,
        Written::Sub => BinaryOp::Sub,
        Written::Mul => BinaryOp::Mul,
        Written::Div => BinaryOp::Div,
        Written::Pow => BinaryOp::Pow,
    }
}

fn domain(reason: &str) -> Diagnostic {
    Diagnostic::error(Cause::Domain, reason)
}

/// Returns the mistake of an operation on constants that has no finite value.
fn not_finite(node: &Node, c: f64) -> Diagnostic {
    let what = match node {
        Node::Call {
            callee: Callee::Function(f),
            ..
        } => f.name(),
        Node::Binary(Written::Pow, ..) => "this power",
        Node::Binary(Written::Div, ..) => "this quotient",
        Node::Number { .. } => "this number",
        _ => "this",
    };
    domain(&if c.is_nan() {
        format!("{what} has no value")
    } else {
        format!("{what} is not finite")
    })
}

fn place(diagnostic: Diagnostic, span: Span) -> Diagnostic {
    Diagnostic {
        span: diagnostic.span.or(Some(span)),
        ..diagnostic
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::ast::Dialect;
    use crate::expr::interpolation::Interpolation;
    use crate::expr::measures::Measure;
    use crate::expr::program::Work;
    use std::sync::Arc;

    /// A tree written node by node.
    struct Tree(Vec<Node>);

    impl Tree {
        fn push(&mut self, node: Node) -> NodeIx {
            self.0.push(node);
            self.0.len() as u32 - 1
        }
        fn number(&mut self, literal: f64) -> NodeIx {
            self.push(Node::Number {
                literal,
                degrees: false,
            })
        }
        fn time(&mut self) -> NodeIx {
            self.push(Node::Constant(Constant::Time))
        }
        fn call(&mut self, callee: Callee, args: &[NodeIx]) -> NodeIx {
            self.push(Node::Call {
                callee,
                args: args.to_vec(),
            })
        }
        fn ast(self) -> Ast {
            let spans = (0..self.0.len()).map(|k| Span::new(k, k + 1)).collect();
            let root = self.0.len() as u32 - 1;
            Ast {
                dialect: Dialect::Function,
                nodes: self.0,
                spans,
                root,
                names: Arc::default(),
            }
        }
    }

    fn at(program: &Program, time: f64) -> f64 {
        let mut out = [0.0];
        program.run(&[time], &mut Work::default(), &mut out);
        out[0]
    }

    #[test]
    fn equal_parts_of_several_expressions_are_shared() {
        // DX(1,2) + sin t and DX(1,2)·sin t
        let make = |op: Written| {
            let mut t = Tree(Vec::new());
            let (one, two) = (t.number(1.0), t.number(2.0));
            let dx = t.call(Callee::Measure(Measure::Dx), &[one, two]);
            let time = t.time();
            let sine = t.call(Callee::Function(Function::Sin), &[time]);
            t.push(Node::Binary(op, dx, sine));
            t.ast()
        };
        let (sum, product) = (make(Written::Add), make(Written::Mul));
        let program = compile(&[&sum, &product], &Bindings::default()).unwrap();
        assert_eq!(
            program.inputs(),
            [Input::Measure(Measure::Dx, [1, 2, 0, 0]), Input::Time]
        );
        assert_eq!(program.n_operations(), 3);
        let mut out = [0.0; 2];
        program.run(&[3.0, 0.5], &mut Work::default(), &mut out);
        let s = crate::scalar::Scalar::sin(0.5f64);
        assert_eq!(out, [3.0 + s, 3.0 * s]);
    }

    #[test]
    fn what_has_no_value_is_an_error_unless_a_branch_hides_it() {
        let root_of_minus_one = |t: &mut Tree| {
            let minus = t.number(-1.0);
            t.call(Callee::Function(Function::Sqrt), &[minus])
        };
        let mut t = Tree(Vec::new());
        root_of_minus_one(&mut t);
        let error = compile(&[&t.ast()], &Bindings::default()).unwrap_err();
        assert_eq!((error.code, error.span), ("domain", Some(Span::new(1, 2))));

        let mut t = Tree(Vec::new());
        let negative = root_of_minus_one(&mut t);
        let (selector, zero) = (t.time(), t.number(7.0));
        t.push(Node::If {
            selector,
            negative,
            zero,
            positive: selector,
        });
        let program = compile(&[&t.ast()], &Bindings::default()).unwrap();
        assert!(at(&program, -1.0).is_nan());
        assert_eq!((at(&program, 0.0), at(&program, 2.5)), (7.0, 2.5));
        assert!(at(&program, f64::NAN).is_nan());

        let mut t = Tree(Vec::new());
        let (time, zero) = (t.time(), t.number(0.0));
        t.push(Node::Binary(Written::Div, time, zero));
        assert_eq!(
            compile(&[&t.ast()], &Bindings::default())
                .unwrap_err()
                .message,
            "division by zero"
        );

        // STEP with its ends exchanged has no value, whatever x is
        let mut t = Tree(Vec::new());
        let (x, one, two) = (t.time(), t.number(1.0), t.number(2.0));
        t.call(Callee::Function(Function::Step), &[x, two, one, one, two]);
        assert_eq!(
            compile(&[&t.ast()], &Bindings::default()).unwrap_err().code,
            "domain"
        );
    }

    #[test]
    fn delays_are_inputs_that_say_what_they_need() {
        let mut t = Tree(Vec::new());
        let (x, delay, history) = (t.time(), t.number(0.5), t.number(0.0));
        let a = t.call(Callee::Function(Function::Delay), &[x, delay, history]);
        let b = t.call(Callee::Function(Function::Delay), &[x, delay, history]);
        t.push(Node::Binary(Written::Add, a, b));
        let bindings = Bindings::default();
        let mut compiler = Compiler::new(&bindings);
        let value = compiler.add(&t.ast()).unwrap();
        assert_eq!(compiler.delays().len(), 1);
        assert_eq!(compiler.finish(&[value]).inputs(), [Input::Delayed(0)]);
    }

    #[test]
    fn unbound_data_are_named() {
        let mut t = Tree(Vec::new());
        let (x, z, id) = (t.time(), t.number(0.0), t.number(12.0));
        t.call(Callee::Interpolation(Interpolation::Akispl), &[x, z, id]);
        let error = compile(&[&t.ast()], &Bindings::default()).unwrap_err();
        assert_eq!(error.message, "there is no spline 12");
    }

    #[test]
    fn many_arguments_of_max_are_pairs() {
        let mut t = Tree(Vec::new());
        let args: Vec<NodeIx> = (0..100)
            .map(|k| {
                if k == 50 {
                    t.time()
                } else {
                    t.number(f64::from(k % 7))
                }
            })
            .collect();
        t.call(Callee::Function(Function::Max), &args);
        let program = compile(&[&t.ast()], &Bindings::default()).unwrap();
        assert_eq!((at(&program, 3.0), at(&program, 9.0)), (6.0, 9.0));
        assert!(at(&program, f64::NAN).is_nan());
    }
}
