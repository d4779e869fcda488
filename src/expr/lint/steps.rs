//! Warnings about steps whose arguments stand in another order than they are read.

use super::{Doubt, number, place};
use crate::expr::ast::{Ast, Callee, Node, NodeIx};
use crate::expr::functions::Function;
use crate::expr::program::Input;

/// Doubts a step that runs over a number while its places or heights change with TIME.
pub(super) fn of_node(ast: &Ast, ix: NodeIx) -> Option<Doubt> {
    let Node::Call {
        callee: Callee::Function(function @ (Function::Step | Function::Step5 | Function::Havsin)),
        ref args,
    } = *ast.node(ix)
    else {
        return None;
    };
    let (&x, others) = args.split_first()?;
    let runs = number(ast, x)?;
    let is_time = |ix: &NodeIx| matches!(ast.input(*ix), Some(Input::Time));
    others.iter().any(is_time).then(|| {
        let name = function.name();
        let message = format!("{name} runs over its first argument, which is {runs} for ever here");
        let written = function.signature();
        let help = format!("it is written {written}, often with TIME as the first");
        Doubt::new(place(ast, x), "constant_step", message, help)
    })
}
