//! The anatomy of an expression: its tree with values, its inputs, its switching functions and
//! smoothness, and the compiled operations. `:explain` and `eval --explain` show it.

use crate::data::Data;
use crate::formula::{Formula, TimedData};
use cognate::diagnostic::counted;
use cognate::expr::ast::{Ast, Constant, Node, NodeIx};
use cognate::expr::program::Input;
use cognate::expr::smoothness::smoothness;
use cognate::expr::walk;
use cognate::results::digits;
use std::ops::RangeInclusive;

/// Deepest level of a tree that is shown.
const DEEPEST: usize = 40;
/// Most lines of a tree that are shown.
const MOST_LINES: usize = 200;

/// Most breakpoints, and most switching functions, that are shown.
const MOST_BREAKS: usize = 12;

/// Interval in which breakpoints are sought by default.
pub const BREAKPOINT_INTERVAL: RangeInclusive<f64> = -100.0..=100.0;

/// Explains an expression as text; breakpoints are sought in the interval.
pub fn explain(
    formula: &Formula,
    time: Option<f64>,
    interval: RangeInclusive<f64>,
    data: &Data,
) -> String {
    let ast = formula.expr.ast();
    let values = walk::values(ast, &TimedData { data, time }).unwrap_or_default();
    let mut text = format!("{}\n\n", formula.expr);
    text += &tree(ast, &values);
    let inputs: Vec<String> = formula
        .expr
        .inputs()
        .iter()
        .map(|i| match i {
            Input::Time => Constant::Time.name(ast.dialect).to_owned(),
            i => i.to_string(),
        })
        .collect();
    text += &format!(
        "\nreads      {}\n",
        if inputs.is_empty() {
            "nothing".into()
        } else {
            inputs.join("  ")
        }
    );
    let history = formula.expr.needs_history();
    if !history.is_empty() {
        text += &format!(
            "history    {}: the value depends on what was before\n",
            history.join("  ")
        );
    }
    text += &breaks(formula, interval);
    text += &match formula.program.constant_outputs().as_deref() {
        Some([value]) => format!("program    folded to the constant {}\n", digits(*value)),
        _ => format!(
            "program    {}, {}\n",
            counted(formula.program.n_operations(), "operation"),
            counted(formula.program.work_size(), "register")
        ),
    };
    text
}

/// Lists switching functions, class and breakpoints, one a line.
fn breaks(formula: &Formula, interval: RangeInclusive<f64>) -> String {
    let found = smoothness(&formula.program, 0, Input::Time, interval.clone());
    let time = Constant::Time.name(formula.expr.ast().dialect);
    let mut text = block("switches", found.switches.into_iter());
    text += &format!("class      {}\n", found.class.describe());
    let points = found
        .breakpoints
        .iter()
        .map(|b| format!("{time} = {}: {b}", digits(b.at)));
    let surfaces = found.surfaces.iter().map(|s| s.to_string());
    text += &block("breaks", points.chain(surfaces));
    if !found.complete {
        text += &format!(
            "           and more between {} and {}\n",
            digits(*interval.start()),
            digits(*interval.end())
        );
    }
    text.replace("TIME", time)
}

/// Sets lines beside a name; empty if there are none.
fn block(name: &str, lines: impl Iterator<Item = String>) -> String {
    let lines: Vec<String> = lines.collect();
    let shown = lines.iter().take(MOST_BREAKS).enumerate();
    let mut text: String = shown
        .map(|(k, line)| format!("{:9}  {line}\n", if k == 0 { name } else { "" }))
        .collect();
    if lines.len() > MOST_BREAKS {
        text += &format!("           … {} more\n", lines.len() - MOST_BREAKS);
    }
    text
}

/// Prints the tree, one node a line, with the values on the taken path.
fn tree(ast: &Ast, values: &[Option<f64>]) -> String {
    let mut lines: Vec<(String, String)> = Vec::new();
    // a stack of its own: trees may be deeper than the program's
    let mut rest: Vec<(NodeIx, usize, String)> = vec![(ast.root, 0, String::new())];
    while let Some((ix, depth, role)) = rest.pop() {
        if lines.len() >= MOST_LINES || depth > DEEPEST {
            lines.push((
                format!("{:w$}…", "", w = 2 * depth.min(DEEPEST)),
                String::new(),
            ));
            break;
        }
        let value = values.get(ix as usize).copied().flatten();
        let shown = match (values.is_empty(), value) {
            (true, _) => String::new(),
            (false, Some(v)) => digits(v),
            (false, None) => "not taken".into(),
        };
        let (name, below) = node(ast, ix);
        let leaf_number = matches!(ast.node(ix), Node::Number { degrees: false, .. });
        lines.push((
            format!("{:w$}{role}{name}", "", w = 2 * depth),
            if leaf_number { String::new() } else { shown },
        ));
        rest.extend(
            below
                .into_iter()
                .rev()
                .map(|(child, role)| (child, depth + 1, role)),
        );
    }
    let width = lines
        .iter()
        .map(|l| l.0.chars().count())
        .max()
        .unwrap_or(0)
        .min(60);
    lines
        .into_iter()
        .map(|(left, right)| format!("{left:width$}  {right}").trim_end().to_owned() + "\n")
        .collect()
}

/// Returns the name of a node, and its children with their roles.
fn node(ast: &Ast, ix: NodeIx) -> (String, Vec<(NodeIx, String)>) {
    let plain = |ix: NodeIx| (ix, String::new());
    match ast.node(ix) {
        Node::Number { .. } | Node::Constant(_) => (ast.written(ix), Vec::new()),
        Node::Negate(x) => ("-".into(), vec![plain(*x)]),
        Node::Plus(x) => ("+".into(), vec![plain(*x)]),
        Node::Binary(op, a, b) => (op.symbol().into(), vec![plain(*a), plain(*b)]),
        Node::If {
            selector,
            negative,
            zero,
            positive,
        } => (
            "IF".into(),
            vec![
                (*selector, "selector: ".into()),
                (*negative, "< 0: ".into()),
                (*zero, "= 0: ".into()),
                (*positive, "> 0: ".into()),
            ],
        ),
        Node::Call { .. } if ast.input(ix).is_some() => (ast.written(ix), Vec::new()),
        Node::Named { entry, args } => (
            ast.names.name(*entry).unwrap_or_default().into(),
            args.iter().map(|&a| plain(a)).collect(),
        ),
        Node::Call { callee, args } => (
            callee.name().into(),
            args.iter()
                .enumerate()
                .map(|(k, &a)| match callee.role(k, args.len()) {
                    role if role.is_empty() => plain(a),
                    role => (a, role + ": "),
                })
                .collect(),
        ),
    }
}
