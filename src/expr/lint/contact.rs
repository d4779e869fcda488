//! Warnings about laws of contact: an exponent below one, a rate that is not that of the distance.

use super::{Doubt, number, place};
use crate::expr::ast::{Ast, Callee, Node, NodeIx};
use crate::expr::functions::Function;
use crate::expr::measures::Measure;
use crate::expr::program::Input;

/// Distances and angles, and the measure of the rate of each.
const RATES: [(Measure, Measure); 7] = [
    (Measure::Dm, Measure::Vr),
    (Measure::Dx, Measure::Vx),
    (Measure::Dy, Measure::Vy),
    (Measure::Dz, Measure::Vz),
    (Measure::Ax, Measure::Wx),
    (Measure::Ay, Measure::Wy),
    (Measure::Az, Measure::Wz),
];

/// Returns the doubts about one node.
pub(super) fn of_node(ast: &Ast, ix: NodeIx) -> Vec<Doubt> {
    let Node::Call {
        callee: Callee::Function(function @ (Function::Impact | Function::Bistop)),
        ref args,
    } = *ast.node(ix)
    else {
        return Vec::new();
    };
    let doubts = [exponent(ast, function, args), rate(ast, function, args)];
    doubts.into_iter().flatten().collect()
}

/// Doubts a rate that is written with other markers, or along another axis, than the distance,
/// where each is written with one measure.
fn rate(ast: &Ast, function: Function, args: &[NodeIx]) -> Option<Doubt> {
    let &[x, x_dot, ..] = args else { return None };
    let distance = only_measure(ast, x)?;
    let rate = only_measure(ast, x_dot)?;
    let (_, of_distance) = RATES.iter().find(|(of, _)| *of == distance.0)?;
    RATES.iter().find(|(_, of)| *of == rate.0)?;
    // seen from the other marker the sign alone differs
    let pair = |[i, j, ..]: [u32; 4]| [i.min(j), i.max(j)];
    if rate.0 == *of_distance && pair(rate.1) == pair(distance.1) {
        return None;
    }
    let written =
        |(measure, [i, j, ..]): (Measure, [u32; 4])| format!("{}({i},{j})", measure.name());
    let message = format!(
        "the rate of {} is {}, not {}",
        written(distance),
        written((*of_distance, distance.1)),
        written(rate)
    );
    let help = format!(
        "the second argument of {} is the rate of the first: it damps",
        function.name()
    );
    Some(Doubt::new(
        place(ast, x_dot),
        "rate_of_another",
        message,
        help,
    ))
}

/// Returns the measure that a part of an expression reads, if it reads one alone, with its markers.
fn only_measure(ast: &Ast, ix: NodeIx) -> Option<(Measure, [u32; 4])> {
    let mut found = None;
    let mut open = vec![ix];
    while let Some(ix) = open.pop() {
        if let Some(Input::Measure(measure, markers)) = ast.input(ix) {
            if found.replace((measure, markers)).is_some() {
                return None;
            }
            continue;
        }
        match ast.node(ix) {
            Node::Number { .. } | Node::Constant(_) => {}
            Node::Negate(x) | Node::Plus(x) => open.push(*x),
            Node::Binary(_, a, b) => open.extend([*a, *b]),
            Node::If { .. } | Node::Named { .. } => return None,
            Node::Call { args, .. } => open.extend(args),
        }
    }
    found
}

/// Doubts an exponent below one.
fn exponent(ast: &Ast, function: Function, args: &[NodeIx]) -> Option<Doubt> {
    let exponent = match (function, args) {
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
