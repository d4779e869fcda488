//! Warnings about laws of contact: an exponent below one.

use super::{Doubt, number, place};
use crate::expr::ast::{Ast, Callee, Node, NodeIx};
use crate::expr::functions::Function;

/// Returns the doubt about one node, if there is one.
pub(super) fn of_node(ast: &Ast, ix: NodeIx) -> Option<Doubt> {
    let Node::Call {
        callee: Callee::Function(function),
        ref args,
    } = *ast.node(ix)
    else {
        return None;
    };
    let exponent = match (function, args.as_slice()) {
        (Function::Impact, &[_, _, _, _, e, ..]) | (Function::Bistop, &[_, _, _, _, _, e, ..]) => e,
        _ => return None,
    };
    let value = number(ast, exponent).filter(|e| is_infinitely_stiff(*e))?;
    Some(Doubt::new(
        place(ast, exponent),
        "unlikely_magnitude",
        infinitely_stiff(value),
        ADVICE,
    ))
}

/// Returns whether the force of a contact with this exponent has no finite slope at the touch.
pub fn is_infinitely_stiff(exponent: f64) -> bool {
    exponent > 0.0 && exponent < 1.0
}

/// Returns what an exponent below one means.
pub fn infinitely_stiff(exponent: f64) -> String {
    format!(
        "an exponent of {exponent} makes the contact infinitely stiff at the touch: its slope is \
         that of a depth to the power of {}",
        (exponent * 1e9 - 1e9).round() / 1e9
    )
}

/// Exponents that are written instead of one below one.
pub const ADVICE: &str = "1 is a linear spring, 1.5 a sphere after Hertz, 2.2 usual for steel";
