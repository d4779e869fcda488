//! Warnings about steps whose arguments stand in another order than they are read.

use super::{Doubt, number, place};
use crate::expr::ast::{Ast, Callee, Node, NodeIx};
use crate::expr::functions::Function;
use crate::expr::program::Input;

/// Doubts a step that runs over a number while its places or heights change with TIME, and one that
/// runs over TIME to a place in degrees.
pub(super) fn of_node(ast: &Ast, ix: NodeIx) -> Option<Doubt> {
    let Node::Call {
        callee: Callee::Function(function @ (Function::Step | Function::Step5 | Function::Havsin)),
        ref args,
    } = *ast.node(ix)
    else {
        return None;
    };
    let (&x, others) = args.split_first()?;
    let is_time = |ix: &NodeIx| matches!(ast.input(*ix), Some(Input::Time));
    if is_time(&x) {
        return place_in_degrees(ast, function, args);
    }
    let runs = number(ast, x)?;
    others.iter().any(is_time).then(|| {
        let name = function.name();
        let message = format!("{name} runs over its first argument, which is {runs} for ever here");
        let written = function.signature();
        let help = format!("it is written {written}, often with TIME as the first");
        Doubt::new(place(ast, x), "constant_step", message, help)
    })
}

/// Doubts a step over TIME whose second place is in degrees and whose first height is not: they
/// stand in the order begin, end, initial, final.
fn place_in_degrees(ast: &Ast, function: Function, args: &[NodeIx]) -> Option<Doubt> {
    let &[x, x0, h0, x1, h1] = args else {
        return None;
    };
    number(ast, h0).filter(|_| is_in_degrees(ast, x1))?;
    let at = place(ast, x1);
    let [x, x0, h0, x1, h1] = [x, x0, h0, x1, h1].map(|arg| ast.written(arg));
    let name = function.name();
    let message = format!("{x1} is the TIME at which this {name} ends");
    let help = format!(
        "it is read {}: what begins at {x0} and ends at {h0} is written {name}({x}, {x0}, {x1}, {h0}, {h1})",
        function.signature()
    );
    Some(Doubt::new(at, "step_order", message, help))
}

/// Returns whether a node is a literal in degrees.
fn is_in_degrees(ast: &Ast, ix: NodeIx) -> bool {
    match *ast.node(ix) {
        Node::Number { degrees, .. } => degrees,
        Node::Negate(x) => matches!(*ast.node(x), Node::Number { degrees: true, .. }),
        _ => false,
    }
}
