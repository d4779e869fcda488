//! `:explain`: what the machine sees in an expression: its tree with values, what it reads, and what was left to compute.

use crate::cli::data::Data;
use crate::cli::formula::{Formula, TimedData};
use crate::expr::ast::{Ast, Node, NodeIx};
use crate::expr::walk;
use crate::results::digits;

/// Deepest level of a tree that is shown, and most lines.
const DEEPEST: usize = 40;
const MOST_LINES: usize = 200;

/// The explanation as text.
pub fn explain(formula: &Formula, time: Option<f64>, data: &Data) -> String {
    let ast = formula.expr.ast();
    let values = walk::values(ast, &TimedData { data, time }).unwrap_or_default();
    let mut text = format!("{}\n\n", formula.expr);
    text += &tree(ast, &values);
    let inputs: Vec<String> = formula
        .expr
        .inputs()
        .iter()
        .map(|i| i.to_string())
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
    text += &match formula.program.constant_outputs().as_deref() {
        Some([value]) => format!("program    folded to the constant {}\n", digits(*value)),
        _ => format!(
            "program    {} operations, {} registers\n",
            formula.program.n_operations(),
            formula.program.work_size()
        ),
    };
    text
}

/// The tree, a node a line, with the values on the taken path.
fn tree(ast: &Ast, values: &[Option<f64>]) -> String {
    let mut lines: Vec<(String, String)> = Vec::new();
    // An own stack: trees may be deeper than ours.
    let mut rest: Vec<(NodeIx, usize, &str)> = vec![(ast.root, 0, "")];
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

/// What a node is called, and what is below it with its role there.
fn node(ast: &Ast, ix: NodeIx) -> (String, Vec<(NodeIx, &'static str)>) {
    match ast.node(ix) {
        Node::Number { .. } | Node::Constant(_) => (ast.written(ix), Vec::new()),
        Node::Negate(x) => ("-".into(), vec![(*x, "")]),
        Node::Plus(x) => ("+".into(), vec![(*x, "")]),
        Node::Binary(op, a, b) => (op.symbol().into(), vec![(*a, ""), (*b, "")]),
        Node::If {
            selector,
            negative,
            zero,
            positive,
        } => (
            "IF".into(),
            vec![
                (*selector, "selector: "),
                (*negative, "< 0: "),
                (*zero, "= 0: "),
                (*positive, "> 0: "),
            ],
        ),
        Node::Call { .. } if ast.input(ix).is_some() => (ast.written(ix), Vec::new()),
        Node::Call { callee, args } => (
            callee.name().into(),
            args.iter().map(|&a| (a, "")).collect(),
        ),
    }
}
