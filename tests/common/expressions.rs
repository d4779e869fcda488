//! Random expressions: trees made of bytes, for property tests and for fuzzing alike.
//!
//! The same bytes give the same tree, and fewer bytes a smaller one, so that whoever finds a failing tree can shrink it. Most
//! arguments are such that functions have a value; some are not. The laws that every text and every tree keeps stand at the end.

use cognate::diagnostic::Span;
use cognate::expr::ast::{Ast, BinaryOp, Callee, Constant, Dialect, Node, NodeIx};
use cognate::expr::functions::Function;
use cognate::expr::interpolation::{Bindings, Interpolation, Spline};
use cognate::expr::measures::Measure;
use cognate::expr::program::{Engine, Input, Program, Work};
use cognate::expr::signature::{Choice, Kind};
use cognate::expr::spline::{Ends, Extrapolation};
use cognate::expr::walk::{self, Host};
use cognate::expr::{Profile, compile::compile, lint, parse};
use cognate::scalar::Lanes;
use std::sync::Arc;

/// What a tree may contain.
#[derive(Clone, Copy, Debug)]
pub struct Contents {
    pub dialect: Dialect,
    pub measures: bool,
    /// AKISPL, CUBSPL and INTERP of splines 1 and 2, which [`bindings`] has
    pub curves: bool,
    /// DELAY, which only a host with history can evaluate
    pub delays: bool,
}

impl Contents {
    /// Everything that has a value without a history.
    pub fn all(dialect: Dialect) -> Self {
        let model = dialect == Dialect::Function;
        Self {
            dialect,
            measures: model,
            curves: model,
            delays: false,
        }
    }
}

/// The tree that these bytes stand for.
pub fn tree(bytes: &[u8], contents: Contents) -> Ast {
    let mut maker = Maker {
        bytes,
        contents,
        nodes: Vec::new(),
    };
    let root = maker.expression(0);
    let spans = vec![Span::default(); maker.nodes.len()];
    Ast {
        dialect: contents.dialect,
        nodes: maker.nodes,
        spans,
        root,
        names: Arc::default(),
    }
}

/// A call with constant parameters, which is prepared for them, of a variable argument.
pub fn prepared_call(bytes: &[u8]) -> Ast {
    let mut maker = Maker {
        bytes,
        contents: Contents::all(Dialect::Function),
        nodes: Vec::new(),
    };
    let (function, variables) = PREPARED[maker.pick(PREPARED.len())];
    let root = maker.prepared(function, variables, |maker, _| {
        let (time, offset) = (maker.push(Node::Constant(Constant::Time)), maker.number());
        maker.push(Node::Binary(BinaryOp::Add, time, offset))
    });
    Ast {
        dialect: Dialect::Function,
        spans: vec![Span::default(); maker.nodes.len()],
        nodes: maker.nodes,
        root,
        names: Arc::default(),
    }
}

/// Functions that are prepared where all arguments after the first ones are constant, and how many come first.
pub const PREPARED: [(Function, usize); 9] = [
    (Function::Step, 1),
    (Function::Step5, 1),
    (Function::Havsin, 1),
    (Function::Poly, 1),
    (Function::Cheby, 1),
    (Function::Forcos, 1),
    (Function::Forsin, 1),
    (Function::Impact, 2),
    (Function::Bistop, 2),
];

const OPERATORS: [BinaryOp; 5] = [
    BinaryOp::Add,
    BinaryOp::Sub,
    BinaryOp::Mul,
    BinaryOp::Div,
    BinaryOp::Pow,
];

/// Numbers at the ends of what numbers there are, and between: with a reciprocal that is a number and without, with a square
/// and without.
pub const EXTREMES: [f64; 12] = [
    0.0,
    5e-324,
    8.854e-321,
    5.5e-309,
    f64::MIN_POSITIVE,
    1e-160,
    0.75,
    2.0,
    1e17,
    1e160,
    1e308,
    f64::MAX,
];

/// A call or an operation whose operands are extreme numbers of either sign, or the time.
pub fn extreme(bytes: &[u8], dialect: Dialect) -> Ast {
    let mut maker = Maker {
        bytes,
        contents: Contents::all(dialect),
        nodes: Vec::new(),
    };
    let root = maker.extreme();
    Ast {
        dialect,
        spans: vec![Span::default(); maker.nodes.len()],
        nodes: maker.nodes,
        root,
        names: Arc::default(),
    }
}

/// Deepest tree; the reader takes 256 levels of parentheses, and a level here needs one or two of them.
const DEEPEST: usize = 40;

struct Maker<'a> {
    bytes: &'a [u8],
    contents: Contents,
    nodes: Vec<Node>,
}

impl Maker<'_> {
    /// A number below `n`; 0 when the bytes are used up.
    fn pick(&mut self, n: usize) -> usize {
        let Some((&first, rest)) = self.bytes.split_first() else {
            return 0;
        };
        self.bytes = rest;
        usize::from(first) % n.max(1)
    }

    fn push(&mut self, node: Node) -> NodeIx {
        self.nodes.push(node);
        (self.nodes.len() - 1) as NodeIx
    }

    fn literal(&mut self, literal: f64) -> NodeIx {
        self.push(Node::Number {
            literal,
            degrees: false,
        })
    }

    fn expression(&mut self, depth: usize) -> NodeIx {
        if self.bytes.is_empty() || depth > DEEPEST {
            return self.constant();
        }
        match self.pick(16) {
            0..=2 => self.number(),
            3 | 4 => self.constant(),
            5..=9 => {
                let a = self.expression(depth + 1);
                let b = self.expression(depth + 1);
                let op = OPERATORS[self.pick(5)];
                self.push(Node::Binary(op, a, b))
            }
            10 => {
                let x = self.expression(depth + 1);
                let plus = self.pick(4) == 0;
                self.push(if plus { Node::Plus(x) } else { Node::Negate(x) })
            }
            11 if self.contents.dialect == Dialect::Function => {
                let [selector, negative, zero, positive] =
                    [(); 4].map(|()| self.expression(depth + 1));
                self.push(Node::If {
                    selector,
                    negative,
                    zero,
                    positive,
                })
            }
            12 if self.contents.measures => self.measure(),
            13 if self.contents.curves => self.curve(depth),
            _ => self.call(depth),
        }
    }

    fn constant(&mut self) -> NodeIx {
        let constant = match (self.contents.dialect, self.pick(8)) {
            (Dialect::Function, 5) => Constant::Pi,
            (Dialect::Function, 6) => Constant::Dtor,
            (Dialect::Function, 7) => Constant::Rtod,
            _ => Constant::Time,
        };
        self.push(Node::Constant(constant))
    }

    fn number(&mut self) -> NodeIx {
        const NICE: [f64; 12] = [
            0.0, 1.0, 2.0, 3.0, 0.5, 1.5, 2.5, 10.0, 0.1, 360.0, 1e-7, 1e20,
        ];
        let literal = match self.pick(16) {
            k @ 0..12 => NICE[k],
            12 | 13 => self.pick(256) as f64 / 16.0,
            14 => EXTREMES[self.pick(EXTREMES.len())],
            _ => {
                let bits = [(); 8].map(|()| self.pick(256) as u8);
                let x = f64::from_bits(u64::from_le_bytes(bits)).abs();
                if x.is_finite() { x } else { 7.0 }
            }
        };
        let degrees =
            self.contents.dialect == Dialect::Function && self.pick(8) == 7 && literal < 1e307;
        self.push(Node::Number { literal, degrees })
    }

    fn extreme(&mut self) -> NodeIx {
        let known: Vec<Function> = Function::ALL
            .iter()
            .copied()
            .filter(|&f| f.row().dialect == self.contents.dialect && f != Function::Delay)
            .collect();
        let what = self.pick(5 + known.len());
        let Some(&function) = what.checked_sub(5).and_then(|k| known.get(k)) else {
            let (a, b) = (self.extreme_operand(), self.extreme_operand());
            return self.push(Node::Binary(OPERATORS[what % 5], a, b));
        };
        let (least, most) = Callee::Function(function).arity();
        let count = least + self.pick((most - least).min(4) + 1);
        let args = (0..count)
            .map(|k| match Callee::Function(function).argument(k) {
                Kind::Number => self.extreme_operand(),
                kind => self.identifier(kind),
            })
            .collect();
        self.push(Node::Call {
            callee: Callee::Function(function),
            args,
        })
    }

    fn extreme_operand(&mut self) -> NodeIx {
        match self.pick(4) {
            0 => self.push(Node::Constant(Constant::Time)),
            1 => {
                let literal = EXTREMES[self.pick(EXTREMES.len())];
                let size = self.literal(literal);
                self.push(Node::Negate(size))
            }
            _ => {
                let literal = EXTREMES[self.pick(EXTREMES.len())];
                self.literal(literal)
            }
        }
    }

    fn measure(&mut self) -> NodeIx {
        let measure = Measure::ALL[self.pick(Measure::ALL.len())];
        let (least, most) = Callee::Measure(measure).arity();
        let count = least + self.pick(most - least + 1);
        let args = (0..count)
            .map(|k| self.identifier(Callee::Measure(measure).argument(k)))
            .collect();
        self.push(Node::Call {
            callee: Callee::Measure(measure),
            args,
        })
    }

    fn identifier(&mut self, kind: Kind) -> NodeIx {
        let n = match kind {
            Kind::Identifier { zero: true, .. } => self.pick(4),
            Kind::Selector(Choice::Range(first, last)) => {
                first as usize + self.pick((last - first + 1) as usize)
            }
            Kind::Selector(Choice::OneOf(list)) => list[self.pick(list.len())] as usize,
            Kind::Identifier { .. } | Kind::Selector(Choice::Positive) | Kind::Number => {
                1 + self.pick(3)
            }
        };
        self.literal(n as f64)
    }

    fn curve(&mut self, depth: usize) -> NodeIx {
        let function = [
            Interpolation::Akispl,
            Interpolation::Cubspl,
            Interpolation::Interp,
        ][self.pick(3)];
        let x = self.expression(depth + 1);
        let (second, id) = match function {
            Interpolation::Interp => (self.identifier(function_argument(function, 1)), 1.0),
            _ => (self.expression(depth + 1), 1.0 + self.pick(2) as f64),
        };
        let mut args = vec![x, second, self.literal(id)];
        if id == 1.0 && self.pick(2) == 0 {
            let order = self.pick(3) as f64;
            args.push(self.literal(order));
        }
        self.push(Node::Call {
            callee: Callee::Interpolation(function),
            args,
        })
    }

    fn call(&mut self, depth: usize) -> NodeIx {
        let known: Vec<Function> = Function::ALL
            .iter()
            .copied()
            .filter(|&f| {
                f.row().dialect == self.contents.dialect
                    && (f != Function::Delay || self.contents.delays)
            })
            .collect();
        let function = known[self.pick(known.len())];
        let prepared = PREPARED.iter().find(|p| p.0 == function);
        if let Some(&(_, variables)) = prepared.filter(|_| self.pick(4) > 0) {
            return self.prepared(function, variables, |maker, k| {
                maker.argument(function, k, depth + 1)
            });
        }
        let (least, most) = Callee::Function(function).arity();
        let count = least + self.pick((most - least).min(4) + 1);
        let args = (0..count)
            .map(|k| self.argument(function, k, depth + 1))
            .collect();
        self.push(Node::Call {
            callee: Callee::Function(function),
            args,
        })
    }

    /// A call whose arguments after the first ones are constant.
    fn prepared(
        &mut self,
        function: Function,
        variables: usize,
        mut variable: impl FnMut(&mut Self, usize) -> NodeIx,
    ) -> NodeIx {
        let (least, most) = Callee::Function(function).arity();
        let count = least + self.pick((most - least).min(4) + 1);
        let args = (0..count)
            .map(|k| match k < variables {
                true => variable(self, k),
                false => self.parameter(function, k),
            })
            .collect();
        self.push(Node::Call {
            callee: Callee::Function(function),
            args,
        })
    }

    /// A constant parameter, mostly one that the function has a value for.
    fn parameter(&mut self, function: Function, k: usize) -> NodeIx {
        let literal = match fitting(Callee::Function(function).argument_name(k)) {
            [] => (self.pick(256) as f64 - 128.0) / 16.0,
            some => some[self.pick(some.len())],
        };
        if literal >= 0.0 {
            return self.literal(literal);
        }
        let size = self.literal(-literal);
        self.push(Node::Negate(size))
    }

    /// An argument that the function has a value for, mostly.
    fn argument(&mut self, function: Function, k: usize, depth: usize) -> NodeIx {
        let callee = Callee::Function(function);
        if callee.argument(k) != Kind::Number {
            return self.identifier(callee.argument(k));
        }
        let fitting = fitting(callee.argument_name(k));
        match fitting.len() {
            0 => self.expression(depth),
            n if self.pick(8) > 0 => {
                let literal = fitting[self.pick(n)];
                self.literal(literal)
            }
            _ => self.expression(depth),
        }
    }
}

/// Values that suit an argument of this name, if it is one that not every number suits.
fn fitting(name: &str) -> &'static [f64] {
    match name {
        "x0" => &[0.0, 0.5, 1.0],
        "x1" => &[1.5, 2.0, 3.25],
        "x2" => &[4.0, 5.5],
        "k" | "e" | "cmax" | "d" | "dx" => &[1.0, 1.5, 2.0, 0.25, 100.0],
        _ => &[],
    }
}

fn function_argument(function: Interpolation, k: usize) -> Kind {
    Callee::Interpolation(function).argument(k)
}

/// Splines 1, a single curve, and 2, a family of three.
pub fn bindings() -> Bindings {
    let x = vec![-2.0, 0.0, 0.5, 1.0, 3.0];
    let curves = [
        vec![1.0, 0.0, 2.0, 2.0, -1.0],
        vec![0.0, 1.0, 1.5, 3.0, 2.0],
        vec![5.0, 4.0, 4.5, 4.0, 9.0],
    ];
    let single = Spline::new(
        x.clone(),
        vec![],
        curves[..1].to_vec(),
        Ends::Natural,
        Extrapolation::Parabolic,
    );
    let family = Spline::new(
        x,
        vec![0.0, 1.0, 4.0],
        curves.to_vec(),
        Ends::NotAKnot,
        Extrapolation::Linear,
    );
    let mut bindings = Bindings::default();
    for (id, spline) in [(1, single), (2, family)] {
        bindings
            .splines
            .insert(id, Arc::new(spline.expect("the data above are increasing")));
    }
    bindings
}

/// A host with a value for everything but delayed values, the same for the same input.
pub struct Anything {
    pub time: f64,
    pub bindings: Bindings,
}

impl Host for Anything {
    fn input(&self, input: Input) -> Option<f64> {
        match input {
            Input::Time => Some(self.time),
            Input::Mode => Some(4.0),
            Input::Measure(m, ids) => {
                let seed = ids
                    .iter()
                    .fold(m as u32, |s, id| s.wrapping_mul(31).wrapping_add(*id));
                Some((f64::from(seed % 1000) - 400.0) / 128.0 + self.time)
            }
            _ => None,
        }
    }
    fn bindings(&self) -> Option<&Bindings> {
        Some(&self.bindings)
    }
}

/// What a program gives for the values of this host.
pub fn run(program: &Program, host: &dyn Host) -> f64 {
    let inputs: Vec<f64> = program
        .inputs()
        .iter()
        .map(|&i| host.input(i).unwrap_or(f64::NAN))
        .collect();
    let mut out = [0.0];
    program.run(&inputs, &mut Work::default(), &mut out);
    out[0]
}

/// Any text is refused with a place inside it, or read; and then it prints to a text that reads as the same tree.
pub fn laws_of_texts(text: &str) {
    for dialect in [Dialect::Function, Dialect::Expression] {
        for profile in [Profile::Adams, Profile::Ideas] {
            match parse(text, dialect, profile) {
                Err(e) => assert!(
                    (1..=text.chars().count() + 1).contains(&e.column),
                    "{text:?}: {e}"
                ),
                Ok(ast) => {
                    let printed = ast.to_string();
                    let again = parse(&printed, dialect, Profile::Adams)
                        .unwrap_or_else(|e| panic!("{printed}: {e}"));
                    assert_eq!(again, ast, "{text:?}, printed {printed}");
                    let _ = (walk::check_constants(&ast), lint(&ast, text));
                }
            }
        }
    }
}

/// A tree prints to a text that reads as the same tree. Where the walker finds a value, the program gives it to the bit, over
/// numbers and in every lane; what is a mistake whatever the inputs are is one for these.
pub fn laws_of_trees(bytes: &[u8], dialect: Dialect, time: f64) {
    let model = dialect == Dialect::Function;
    let printable = tree(
        bytes,
        Contents {
            delays: model,
            ..Contents::all(dialect)
        },
    );
    laws_of_texts(&printable.to_string());
    let read = parse(&printable.to_string(), dialect, Profile::Adams);
    assert_eq!(
        read.as_ref().map_err(ToString::to_string),
        Ok(&printable),
        "{printable}"
    );

    program_is_the_walker(&tree(bytes, Contents::all(dialect)), time);
}

/// Where the walker finds a value of a tree, the program gives it to the bit, over numbers and in every lane; what is a mistake
/// whatever the inputs are is one for these.
pub fn program_is_the_walker(ast: &Ast, time: f64) {
    let host = |time| Anything {
        time,
        bindings: bindings(),
    };
    let times = [time, 0.0, -time, 1.0 + time];
    let walked = walk::value(ast, &host(time));
    if walk::check_constants(ast).is_err() {
        assert!(
            walked.is_err(),
            "{ast}: a constant mistake, and yet {walked:?}"
        );
    }
    let program = match compile(&[ast], &bindings()) {
        Ok(program) => program,
        Err(e) => return assert!(walked.is_err(), "{ast}: {walked:?}, and yet {e}"),
    };
    if let Ok(walked) = walked {
        let ran = run(&program, &host(time));
        assert_eq!(
            ran.to_bits(),
            walked.to_bits(),
            "{ast}: program {ran:?}, walker {walked:?}"
        );
    }
    let hosts = times.map(host);
    let lanes = |input| {
        Lanes(std::array::from_fn(|k| {
            hosts[k].input(input).unwrap_or(f64::NAN)
        }))
    };
    let inputs: Vec<Lanes<4>> = program.inputs().iter().map(|&i| lanes(i)).collect();
    let mut out = [Lanes([0.0; 4])];
    program.eval(&inputs, &mut Work::default(), &mut out);
    for (lane, host) in out[0].0.into_iter().zip(&hosts) {
        let single = run(&program, host);
        assert!(
            lane == single || lane.is_nan() && single.is_nan(),
            "{ast}: lane {lane:?}, single {single:?}"
        );
    }
}

/// All engines over plain numbers.
pub const ENGINES: [Engine; 2] = [Engine::Interpreter, Engine::Native];

/// Whatever engines there are here give the same bits from a tree that compiles and from its gradient, at several times.
pub fn engines_agree(ast: &Ast, time: f64) {
    let Ok(program) = compile(&[ast], &bindings()) else {
        return;
    };
    let gradient = program.with_gradient(program.inputs());
    for program in [program, gradient] {
        let mut results: Vec<(Engine, Vec<f64>)> = Vec::new();
        for engine in ENGINES {
            let Some(program) = program.with_engine(engine) else {
                continue;
            };
            let (mut work, mut all) = (Work::default(), Vec::new());
            for time in [time, 0.0, -time, 1.0 + time] {
                let host = Anything {
                    time,
                    bindings: bindings(),
                };
                let number = |&input| host.input(input).unwrap_or(f64::NAN);
                let inputs: Vec<f64> = program.inputs().iter().map(number).collect();
                let mut out = vec![0.0; program.n_outputs()];
                program.run(&inputs, &mut work, &mut out);
                out.push(program.value(&inputs, &mut work));
                all.extend(out);
            }
            results.push((engine, all));
        }
        for (engine, got) in &results[1..] {
            for (a, b) in got.iter().zip(&results[0].1) {
                assert!(
                    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan(),
                    "{ast}: {engine:?} {a:?}, {:?} {b:?}",
                    results[0].0
                );
            }
        }
    }
}

/// A claim about any bytes.
pub type Law = fn(&[u8]);

/// What fuzzing calls, by the name of the target.
pub const TARGETS: [(&str, Law); 4] = [
    ("parse", fuzz_parse),
    ("evaluate", fuzz_evaluate),
    ("expression", fuzz_expression),
    ("engines", fuzz_engines),
];

/// Bytes as text.
pub fn fuzz_parse(bytes: &[u8]) {
    if let Ok(text) = std::str::from_utf8(bytes) {
        laws_of_texts(text);
    }
}

/// Bytes as a time and a tree of direct-entry functions.
pub fn fuzz_evaluate(bytes: &[u8]) {
    if let Some((&time, rest)) = bytes.split_first() {
        laws_of_trees(rest, Dialect::Function, f64::from(time) / 64.0 - 2.0);
    }
}

/// Bytes as a time and a tree of expression functions.
pub fn fuzz_expression(bytes: &[u8]) {
    if let Some((&time, rest)) = bytes.split_first() {
        laws_of_trees(rest, Dialect::Expression, f64::from(time) / 64.0 - 2.0);
    }
}

/// Bytes as a time and a tree of either language.
pub fn fuzz_engines(bytes: &[u8]) {
    if let Some((&time, rest)) = bytes.split_first() {
        let dialect = match time % 2 {
            0 => Dialect::Function,
            _ => Dialect::Expression,
        };
        let ast = tree(rest, Contents::all(dialect));
        engines_agree(&ast, f64::from(time) / 64.0 - 2.0);
    }
}
