//! Warnings about powers: signs, quotients and further powers that bind otherwise than they look.

use super::{Doubt, number, place, rounded};
use crate::expr::ast::{Ast, BinaryOp, Node, NodeIx};
use crate::scalar::Scalar;

const CODE: &str = "doubtful_precedence";

/// Returns the doubt about one node, if there is one.
pub(super) fn of_node(ast: &Ast, ix: NodeIx, text: &str) -> Option<Doubt> {
    match *ast.node(ix) {
        Node::Binary(BinaryOp::Div, a, b) => power_over_number(ast, ix, a, b, text),
        Node::Binary(BinaryOp::Pow, a, b) => {
            signed_exponent(ast, ix, a, b, text).or_else(|| tower(ast, ix, a, b, text))
        }
        Node::Negate(x) => negated_power(ast, ix, x, text),
        _ => None,
    }
}

/// Warns of `x**1/2`, which is `(x**1)/2`.
fn power_over_number(ast: &Ast, ix: NodeIx, a: NodeIx, b: NodeIx, text: &str) -> Option<Doubt> {
    let n = number(ast, b).filter(|n| [2.0, 3.0, 4.0].contains(n))?;
    let Node::Binary(BinaryOp::Pow, _, e) = *ast.node(a) else {
        return None;
    };
    if number(ast, e) != Some(1.0) || parenthesis_between(ast, text, a, ix) {
        return None;
    }
    let message = format!("** binds tighter than /: this is a first power divided by {n}");
    let help = format!("the root is written **(1/{n})");
    Some(Doubt::new(place(ast, ix), CODE, message, help))
}

/// Warns of `-2**2`, which is `-(2**2)`.
fn negated_power(ast: &Ast, sign: NodeIx, x: NodeIx, text: &str) -> Option<Doubt> {
    let Node::Binary(BinaryOp::Pow, base, exponent) = *ast.node(x) else {
        return None;
    };
    let (b, e) = (number(ast, base)?, number(ast, exponent)?);
    if e % 2.0 != 0.0 || parenthesis_between(ast, text, sign, base) {
        return None;
    }
    let message = format!(
        "** binds tighter than the sign: -{b}**{e} is -({b}**{e}) = {}",
        rounded(-Scalar::powf(b, e))
    );
    let help = format!(
        "a negative base stands in parentheses: (-{b})**{e} is {}",
        rounded(Scalar::powf(-b, e))
    );
    Some(Doubt::new(place(ast, sign), CODE, message, help))
}

/// Warns of `2**-1`, two operators side by side.
fn signed_exponent(ast: &Ast, ix: NodeIx, a: NodeIx, b: NodeIx, text: &str) -> Option<Doubt> {
    if !matches!(ast.node(b), Node::Negate(_) | Node::Plus(_)) {
        return None;
    }
    let operator = place(ast, ix);
    let between = text.get(operator.end..place(ast, b).start)?;
    if !between.trim().is_empty() {
        return None;
    }
    let (base, exponent) = (ast.written(a), ast.written(b));
    let value = match (number(ast, a), number(ast, b)) {
        (Some(a), Some(b)) => format!(" = {}", rounded(Scalar::powf(a, b))),
        _ => String::new(),
    };
    let message = format!(
        "a sign follows an operator: this is read {base}**({exponent}){value}; FORTRAN 77 refuses it"
    );
    let help = format!("parentheses make it plain: {base}**({exponent})");
    Some(Doubt::new(operator, CODE, message, help))
}

/// Warns of `2**3**2`, which is `2**(3**2)`.
fn tower(ast: &Ast, ix: NodeIx, a: NodeIx, b: NodeIx, text: &str) -> Option<Doubt> {
    let Node::Binary(BinaryOp::Pow, b1, b2) = *ast.node(b) else {
        return None;
    };
    let (outer, inner) = (place(ast, ix), place(ast, b));
    if is_nested(text.get(outer.end..inner.start)?) {
        return None;
    }
    let [x, y, z] = [a, b1, b2].map(|ix| ast.written(ix));
    let values = match [a, b1, b2].map(|ix| number(ast, ix)) {
        [Some(a), Some(b), Some(c)] => {
            let power = |a: f64, b: f64| Scalar::powf(a, b);
            (
                format!(" = {}", rounded(power(a, power(b, c)))),
                format!(" = {}", rounded(power(power(a, b), c))),
            )
        }
        _ => Default::default(),
    };
    let message = format!(
        "powers are taken from the right: this is {x}**({y}**{z}){}",
        values.0
    );
    let help = format!("from the left it is written ({x}**{y})**{z}{}", values.1);
    Some(Doubt::new(outer, CODE, message, help))
}

/// Returns whether the end of a text lies within parentheses that it opens.
fn is_nested(text: &str) -> bool {
    let mut depth = 0_i32;
    for c in text.chars() {
        depth += match c {
            '(' => 1,
            ')' => -1,
            _ => 0,
        };
    }
    depth > 0
}

/// Returns whether there is a parenthesis between the places of two nodes: then their order was
/// written, not left to precedence.
fn parenthesis_between(ast: &Ast, text: &str, first: NodeIx, second: NodeIx) -> bool {
    text.get(place(ast, first).start..place(ast, second).start)
        .is_some_and(|between| between.contains(['(', ')']))
}
